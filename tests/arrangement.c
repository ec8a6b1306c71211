#include "arrangement.h"

#include "bits.h"
#include "samples.h"
#include "targets.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

const stream_source all_per_sample[INPUTS] = { 0 };

static const struct {
    const char *name;
    uint32_t bit;
    int components, sources;
    stream_source source[3];
} inputs[INPUTS] = {
    [NORMAL] = { "normal", FACET_STREAM_NORMAL, 3, 2, { PER_SAMPLE, UNIFORM } },
    [VIEW] = { "view", FACET_STREAM_VIEW, 3, 3, { PER_SAMPLE, UNIFORM, ELSEWHERE } },
    [ALBEDO] = { "albedo", FACET_STREAM_ALBEDO, 3, 3, { PER_SAMPLE, UNIFORM, ELSEWHERE } },
    [SIGMA] = { "sigma", FACET_STREAM_SIGMA, 1, 3, { PER_SAMPLE, UNIFORM, ELSEWHERE } },
    [ALPHA] = { "alpha", FACET_STREAM_ALPHA, 1, 3, { PER_SAMPLE, UNIFORM, ELSEWHERE } },
    [F0] = { "f0", FACET_STREAM_F0, 3, 3, { PER_SAMPLE, UNIFORM, ELSEWHERE } },
    [DIRECTION] = { "direction", 0, 3, 2, { PER_SAMPLE, ELSEWHERE } },
    [IRRADIANCE] = { "irradiance", 0, 3, 2, { PER_SAMPLE, ELSEWHERE } },
    [VISIBILITY] = { "visibility", 0, 1, 2, { PER_SAMPLE, ELSEWHERE } },
};

static const int light_counts[] = { 0, 1, 2, 5 };

/* Around every multiple of a vector, of a group of vectors, of a block of 64. */
static const unsigned char counts[] = {
    0,  1,  2,  3,  4,  5,  6,  7,  8,  9,  10, 11, 12, 13, 14, 15, 16, 17, 18, 19, 20, 21, 22, 23, 24, 25, 26, 27, 28,
    29, 30, 31, 32, 33, 34, 35, 36, 37, 38, 39, 40, 41, 42, 43, 44, 45, 46, 47, 48, 49, 61, 62, 63, 64, 65, 66, 67, 96,
    127, 128, 129, 131,
};
static const unsigned char counts_for_slow_machines[] = {
    0, 1, 2, 3, 4, 5, 7, 8, 9, 13, 15, 16, 17, 31, 32, 33, 49, 63, 64, 67, 128, 131,
};

enum { COVER_POINTER_NULL, COVER_ALL, COVER_NONE, COVER_RANDOM, COVER_ONE, COVERAGES };

enum { ADD_NOTHING, ADD_EMISSION, ADD_AMBIENT, ADDED };

/* How many samples in 64 have an edge value. */
static const unsigned edges_in_64[] = { 0, 1, 16 };

/* Places of a stream: so many floats beyond a vector's alignment; at the first page's start; at the last page's end. */
enum { PLACE_LOW = 16, PLACE_HIGH, PLACES };
enum { COVERAGE_LOW, COVERAGE_INSIDE, COVERAGE_HIGH, COVERAGE_PLACES };

/* ---- The factors and what excludes what -------------------------------------------------------------------------- */

static int tested_count(int level)
{
    return test_slow_machine ? counts_for_slow_machines[level] : counts[level];
}

/* The kernels that read a stream of the material; that need no view. */
static uint64_t cases_with(uint32_t stream)
{
    uint64_t mask = 0;
    for (int i = 0; i < case_count(); i++)
        if (case_at(i)->streams & stream) mask |= (uint64_t)1 << i;
    return mask;
}

static uint64_t cases_without_view(void)
{
    uint64_t mask = 0;
    for (int i = 0; i < case_count(); i++)
        if (!case_at(i)->view) mask |= (uint64_t)1 << i;
    return mask;
}

/* The levels of a stream's source that stand for it. */
static uint64_t levels_from(int stream, bool uniform)
{
    uint64_t mask = 0;
    for (int i = 0; i < inputs[stream].sources; i++) {
        const stream_source source = inputs[stream].source[i];
        if (source == PER_SAMPLE || (uniform && source == UNIFORM)) mask |= (uint64_t)1 << i;
    }
    return mask;
}

static void require_stream(int stream, uint64_t *allowed)
{
    if (stream >= DIRECTION) allowed[FACTOR_LIGHTS] &= ~UINT64_C(1);
    else if (stream >= ALBEDO) allowed[FACTOR_CASE] &= cases_with(inputs[stream].bit);
}

static void require(int factor, int level, uint64_t *allowed)
{
    if (factor >= FACTOR_SOURCE && factor < FACTOR_SOURCE + INPUTS) {
        const int stream = factor - FACTOR_SOURCE;
        const stream_source source = inputs[stream].source[level];
        require_stream(stream, allowed);
        if (source != PER_SAMPLE) allowed[FACTOR_IN_PLACE] &= ~(UINT64_C(2) << stream);
        if (source != ELSEWHERE || stream != VIEW) return;
        allowed[FACTOR_CASE] &= cases_without_view();
        allowed[FACTOR_TWO_SIDED] &= 1;
    } else if (factor >= FACTOR_PLACE && factor < FACTOR_PLACE + INPUTS) {
        require_stream(factor - FACTOR_PLACE, allowed);
        allowed[FACTOR_SOURCE + factor - FACTOR_PLACE] &= levels_from(factor - FACTOR_PLACE, true);
    } else if (factor == FACTOR_PLACE + INPUTS) {
        allowed[FACTOR_IN_PLACE] &= 1;
    } else if (factor == FACTOR_IN_PLACE && level > 0) {
        require_stream(level - 1, allowed);
        allowed[FACTOR_SOURCE + level - 1] &= levels_from(level - 1, false);
    } else if (factor == FACTOR_COVERAGE_PLACE) {
        allowed[FACTOR_COVERAGE] &= ~(UINT64_C(1) << COVER_POINTER_NULL);
    } else if (factor == FACTOR_TWO_SIDED && level) {
        allowed[FACTOR_SOURCE + VIEW] &= levels_from(VIEW, true);
    }
}

factor_space arrangement_space(void)
{
    factor_space space = { .factors = FACTORS, .require = require };
    int *levels = space.levels;
    levels[FACTOR_CASE] = case_count();
    levels[FACTOR_LIGHTS] = sizeof light_counts / sizeof light_counts[0];
    levels[FACTOR_TWO_SIDED] = levels[FACTOR_ACCUMULATE] = levels[FACTOR_COUNTED] = 2;
    levels[FACTOR_ADDED] = ADDED;
    levels[FACTOR_EDGES] = sizeof edges_in_64 / sizeof edges_in_64[0];
    levels[FACTOR_IN_PLACE] = 1 + INPUTS;
    levels[FACTOR_COVERAGE] = COVERAGES;
    for (int s = 0; s < INPUTS; s++) levels[FACTOR_SOURCE + s] = inputs[s].sources;
    for (int s = 0; s <= INPUTS; s++) levels[FACTOR_PLACE + s] = PLACES;
    levels[FACTOR_COVERAGE_PLACE] = COVERAGE_PLACES;
    levels[FACTOR_TARGET] = target_count();
    levels[FACTOR_COUNT] = test_slow_machine ? sizeof counts_for_slow_machines : sizeof counts;
    for (int f = 0; f < FACTORS; f++) expect(levels[f] <= MOST_LEVELS, "factor %d has %d levels", f, levels[f]);
    return space;
}

/* ---- Values ------------------------------------------------------------------------------------------------------ */

static guarded memory[COMPONENTS], coverage_memory;
static arrangement now;

#define CANARY 0x7fe5a5a5u       /* a NaN */

int component_of(int stream, int light)
{
    static const int first[INPUTS] = { [NORMAL] = 0, [VIEW] = 3, [ALBEDO] = 6, [SIGMA] = 9, [ALPHA] = 10, [F0] = 11,
                                       [DIRECTION] = 14, [IRRADIANCE] = 17, [VISIBILITY] = 20 };
    return first[stream] + (stream >= DIRECTION ? 7 * light : 0);
}

bool is_covered(const arrangement *a, size_t i)
{
    return !a->coverage || a->coverage[i / 8] >> i % 8 & 1;
}

static void put(int stream, int light, size_t i, const float *a)
{
    for (int c = 0; c < inputs[stream].components; c++) now.values[component_of(stream, light) + c][i] = a[c];
}

static void draw_sample(test_random *r, size_t i)
{
    const float sigma_max = now.kernel->sigma_max;
    for (int light = 0; light < MOST_LIGHTS; light++) {
        const sample s = random_sample(r, (int)(random_u64(r) % SAMPLES_KINDS), 0.001f, sigma_max);
        const float visibility = (float)random_unit(r);
        put(DIRECTION, light, i, s.l);
        put(IRRADIANCE, light, i, s.irradiance);
        put(VISIBILITY, light, i, &visibility);
        if (light > 0) continue;
        put(NORMAL, 0, i, s.n);
        put(VIEW, 0, i, s.v);
        put(ALBEDO, 0, i, s.albedo);
        put(SIGMA, 0, i, &s.sigma);
        put(ALPHA, 0, i, &s.alpha);
        put(F0, 0, i, s.f0);
    }
}

/* Turns the vector at `a` around where it is not on the side of `b`. */
static void turn(int a, int b, size_t i)
{
    float sum = 0;
    for (int c = 0; c < 3; c++) sum += now.values[a + c][i] * now.values[b + c][i];
    for (int c = 0; c < 3 && sum < 0; c++) now.values[a + c][i] = -now.values[a + c][i];
}

/* Uniform values are the first sample's. Vectors that are not uniform turn to where something is to be seen, mostly. */
static void share_values(test_random *r)
{
    for (int s = 0; s < INPUTS; s++)
        for (int light = 0; light < (s >= DIRECTION ? MOST_LIGHTS : 1) && now.sources[s] != PER_SAMPLE; light++)
            for (int c = 0; c < inputs[s].components; c++)
                for (size_t i = 1; i < MOST_COUNT; i++)
                    now.values[component_of(s, light) + c][i] = now.values[component_of(s, light) + c][0];
    for (size_t i = 0; i < MOST_COUNT; i++) {
        if (random_u64(r) % 8 == 0) continue;
        if (now.sources[VIEW] == PER_SAMPLE) turn(component_of(VIEW, 0), component_of(NORMAL, 0), i);
        else if (now.sources[NORMAL] == PER_SAMPLE) turn(component_of(NORMAL, 0), component_of(VIEW, 0), i);
        for (int light = 0; light < MOST_LIGHTS && now.sources[DIRECTION] == PER_SAMPLE; light++)
            turn(component_of(DIRECTION, light), component_of(NORMAL, 0), i);
    }
}

static float draw_edge(test_random *r, bool finite)
{
    static const float not_finite[] = { NAN, INFINITY, -INFINITY };
    const uint64_t kind = random_u64(r) % 4, pick = random_u64(r);
    return kind || finite ? edge_values[pick % (uint64_t)edge_count] : not_finite[pick % 3];
}

/* Here and there an edge value, NaN or infinity, in what is read per sample. */
static void draw_edges(test_random *r, unsigned in_64)
{
    for (size_t i = 0; i < MOST_COUNT; i++) {
        const int s = (int)(random_u64(r) % INPUTS), light = (int)(random_u64(r) % MOST_LIGHTS);
        const int component = component_of(s, light) + (int)(random_u64(r) % (uint64_t)inputs[s].components);
        const float edge = draw_edge(r, false);
        now.ordinary[i] = random_u64(r) % 64 >= in_64 || now.sources[s] != PER_SAMPLE;
        if (!now.ordinary[i]) now.values[component][i] = edge;
    }
}

/* Now and then an edge value for all samples: in the batch, or as a light's red irradiance, which must be finite. */
static void draw_uniform_edges(test_random *r)
{
    for (int s = 0; s < INPUTS; s++) {
        const bool light = s == IRRADIANCE && now.sources[s] == ELSEWHERE;
        const float edge = draw_edge(r, light);
        if (random_u64(r) % 8 || !(light || now.sources[s] == UNIFORM)) continue;
        if (light && !(now.values[component_of(s, 0) + 1][0] > 0)) continue;      /* it may not be all 0 */
        for (size_t i = 0; i < MOST_COUNT; i++) {
            now.values[component_of(s, 0)][i] = edge;
            now.ordinary[i] = false;
        }
    }
}

/* What stands in the destination: a radiance to add to, or a NaN that must not be read. */
static void draw_destination(test_random *r)
{
    for (int c = 0; c < 3; c++)
        for (size_t i = 0; i < MOST_COUNT; i++)
            now.values[RADIANCE_AT + c][i] =
                now.flags & FACET_ACCUMULATE ? (float)random_unit(r) * 2 - 0.25f : from_bits(CANARY);
}

/* Negative in one case out of four, which is as 0. */
static void draw_constants(test_random *r, int added)
{
    for (int c = 0; c < 3; c++) {
        const float emission = (float)random_unit(r) - 0.25f, ambient = (float)random_unit(r) - 0.25f;
        now.emission[c] = added == ADD_EMISSION ? emission : 0;
        now.ambient[c] = added == ADD_AMBIENT ? ambient : 0;
    }
}

static void draw_values(test_random *r, const design *d)
{
    for (size_t i = 0; i < MOST_COUNT; i++) draw_sample(r, i);
    share_values(r);
    draw_edges(r, edges_in_64[d->level[FACTOR_EDGES]]);
    if (d->level[FACTOR_EDGES] > 0) draw_uniform_edges(r);
    draw_destination(r);
    draw_constants(r, d->level[FACTOR_ADDED]);
}

/* ---- Places ------------------------------------------------------------------------------------------------------ */

static float *place_at(int component, int level, size_t length)
{
    float *first = (float *)(void *)memory[component].first, *end = (float *)(void *)memory[component].end;
    if (level == PLACE_LOW) return first;
    if (level == PLACE_HIGH) return end - length;
    return first + 256 + (level + 5 * component) % 16;
}

static void place_stream(int stream, int level)
{
    const size_t length = now.sources[stream] == PER_SAMPLE ? now.count : 1;
    for (int light = 0; light < (stream >= DIRECTION ? MOST_LIGHTS : 1); light++)
        for (int c = 0; c < inputs[stream].components; c++) {
            const int component = component_of(stream, light) + c;
            now.place[component] = now.sources[stream] == ELSEWHERE ? NULL : place_at(component, level, length);
            if (now.place[component]) memcpy(now.place[component], now.values[component], length * sizeof(float));
        }
}

/* Radiance on an input (its components turned round, or its one component as green), or on its own. */
static void place_radiance(int in_place, int level)
{
    for (int c = 0; c < 3; c++) {
        const int stream = in_place - 1, to = RADIANCE_AT + c;
        if (in_place && (inputs[stream].components == 3 || c == 1)) {
            const int from = component_of(stream, 0) + (inputs[stream].components == 3 ? (c + 1) % 3 : 0);
            now.place[to] = now.place[from];
            memcpy(now.values[to], now.values[from], sizeof now.values[to]);
        } else {
            now.place[to] = place_at(to, level, now.count);
            memcpy(now.place[to], now.values[to], now.count * sizeof(float));
        }
    }
}

static void place_coverage(test_random *r, int kind, int level)
{
    const size_t bytes = (now.count + 7) / 8, one = now.count ? (size_t)(random_u64(r) % now.count) : 0;
    now.coverage = NULL;
    if (kind == COVER_POINTER_NULL) return;
    now.coverage = level == COVERAGE_LOW ? coverage_memory.first
        : level == COVERAGE_INSIDE ? coverage_memory.first + 101 : coverage_memory.end - bytes;
    for (size_t i = 0; i < 8 * bytes; i++) {
        const bool random = random_u64(r) & 1, beyond = i >= now.count;
        const bool bit = beyond || kind == COVER_RANDOM ? random : kind == COVER_ALL || (kind == COVER_ONE && i == one);
        now.coverage[i / 8] = (uint8_t)((now.coverage[i / 8] & ~(1u << i % 8)) | (unsigned)bit << i % 8);
    }
}

/* ---- Materials and batches --------------------------------------------------------------------------------------- */

facet_material material_of(const arrangement *a, const stream_source *sources)
{
    facet_material m = a->kernel->material;
    for (int s = ALBEDO; s <= F0; s++)
        if (sources[s] != ELSEWHERE) m.streams |= inputs[s].bit & a->kernel->streams;
    m.diffuse.sigma = m.streams & FACET_STREAM_SIGMA ? NAN : a->values[component_of(SIGMA, 0)][0];
    m.specular.alpha = m.streams & FACET_STREAM_ALPHA ? NAN : a->values[component_of(ALPHA, 0)][0];
    for (int c = 0; c < 3; c++) {
        m.diffuse.albedo[c] = m.streams & FACET_STREAM_ALBEDO ? NAN : a->values[component_of(ALBEDO, 0) + c][0];
        m.fresnel.f0[c] = m.streams & FACET_STREAM_F0 ? NAN : a->values[component_of(F0, 0) + c][0];
        m.emission[c] = a->emission[c];
    }
    return m;
}

static void point_light(const arrangement *a, float *const *at, int number, facet_light *light,
                        const stream_source *sources)
{
    *light = (facet_light){ .kind = FACET_LIGHT_DIRECTIONAL };
    for (int c = 0; c < 3; c++) {
        const int direction = component_of(DIRECTION, number) + c, irradiance = component_of(IRRADIANCE, number) + c;
        light->direction[c] = sources[DIRECTION] == PER_SAMPLE ? NAN : a->values[direction][0];
        light->irradiance[c] = sources[IRRADIANCE] == PER_SAMPLE ? NAN : a->values[irradiance][0];
        if (sources[DIRECTION] == PER_SAMPLE) light->direction_of[c] = at[direction];
        if (sources[IRRADIANCE] == PER_SAMPLE) light->irradiance_of[c] = at[irradiance];
    }
    if (a->has_visibility) light->visibility = at[component_of(VISIBILITY, number)];
}

facet_batch point_batch(const arrangement *a, float *const *at, facet_light *lights, const stream_source *sources)
{
    facet_batch b = { .lights = lights, .light_count = (size_t)a->lights, .flags = a->flags,
                      .sigma = at[component_of(SIGMA, 0)], .alpha = at[component_of(ALPHA, 0)] };
    for (int c = 0; c < 3; c++) {
        b.normal[c] = at[component_of(NORMAL, 0) + c];
        b.view[c] = a->has_view ? at[component_of(VIEW, 0) + c] : NULL;
        b.albedo[c] = at[component_of(ALBEDO, 0) + c];
        b.f0[c] = at[component_of(F0, 0) + c];
        b.radiance[c] = at[RADIANCE_AT + c];
        b.ambient[c] = a->ambient[c];
    }
    for (int s = NORMAL; s <= F0; s++)
        if (sources[s] == UNIFORM) b.uniform |= inputs[s].bit;
    for (int i = 0; i < a->lights; i++) point_light(a, at, i, &lights[i], sources);
    return b;
}

/* ---- An arrangement ---------------------------------------------------------------------------------------------- */

static void describe(const design *d)
{
    const int *level = d->level;
    int length = snprintf(now.words, sizeof now.words, "%s, %zu samples, %d lights, flags %u, coverage %d, in place %d, ",
                          now.kernel->name, now.count, now.lights, (unsigned)now.flags, level[FACTOR_COVERAGE],
                          level[FACTOR_IN_PLACE]);
    size_t end = (size_t)length;
    length = snprintf(now.words + end, sizeof now.words - end, "added %d, edges %d%s;", level[FACTOR_ADDED],
                      level[FACTOR_EDGES], now.counted ? ", counted" : "");
    end += (size_t)length;
    for (int s = 0; s < INPUTS && end < sizeof now.words; s++)
        if (level[FACTOR_SOURCE + s] >= 0)
            end += (size_t)snprintf(now.words + end, sizeof now.words - end, " %s %d@%d", inputs[s].name,
                                    (int)now.sources[s], level[FACTOR_PLACE + s]);
}

design plain_design(int target, int kernel, uint64_t seed)
{
    const factor_space space = arrangement_space();
    test_random r = { seed };
    design d;
    for (int f = 0; f < FACTORS; f++) d.level[f] = 0;
    for (int s = ALBEDO; s <= F0; s++) {
        const bool read = case_at(kernel)->streams & inputs[s].bit, per_sample = random_u64(&r) & 1;
        d.level[FACTOR_SOURCE + s] = !read ? -1 : per_sample ? 0 : (int)(random_u64(&r) % (uint64_t)inputs[s].sources);
    }
    for (int s = DIRECTION; s <= VISIBILITY; s++) d.level[FACTOR_SOURCE + s] = 1;
    for (int f = FACTOR_PLACE; f <= FACTOR_PLACE + INPUTS; f++) d.level[f] = (int)(random_u64(&r) % PLACES);
    d.level[FACTOR_EDGES] = (int)(random_u64(&r) % (uint64_t)space.levels[FACTOR_EDGES]);
    d.level[FACTOR_COUNTED] = random_u64(&r) % 4 == 0;
    d.level[FACTOR_TARGET] = target;
    d.level[FACTOR_CASE] = kernel;
    d.level[FACTOR_LIGHTS] = 1;
    d.level[FACTOR_COUNT] = space.levels[FACTOR_COUNT] - 1 - (int)(random_u64(&r) % 4);
    return d;
}

const arrangement *arrange(const design *d, int number)
{
    const int *level = d->level;
    test_random r = { (uint64_t)number };
    now.kernel = case_at(level[FACTOR_CASE]);
    now.target = target_at(level[FACTOR_TARGET]);
    now.count = (size_t)tested_count(level[FACTOR_COUNT]);
    now.lights = light_counts[level[FACTOR_LIGHTS]];
    now.flags = (level[FACTOR_ACCUMULATE] ? FACET_ACCUMULATE : 0u) | (level[FACTOR_TWO_SIDED] ? FACET_TWO_SIDED : 0u);
    for (int s = 0; s < INPUTS; s++) {
        const int source = level[FACTOR_SOURCE + s];
        now.sources[s] = source < 0 ? ELSEWHERE : inputs[s].source[source];
    }
    now.counted = level[FACTOR_COUNTED];
    now.has_view = now.sources[VIEW] != ELSEWHERE;
    now.has_visibility = now.sources[VISIBILITY] != ELSEWHERE;
    describe(d);
    draw_values(&r, d);
    for (int s = 0; s < INPUTS; s++) place_stream(s, level[FACTOR_PLACE + s]);
    place_radiance(level[FACTOR_IN_PLACE], level[FACTOR_PLACE + INPUTS]);
    place_coverage(&r, level[FACTOR_COVERAGE], level[FACTOR_COVERAGE_PLACE]);
    return &now;
}

/* ---- Memory ------------------------------------------------------------------------------------------------------ */

static void fill_with_canaries(float *a, size_t count)
{
    for (size_t i = 0; i < count; i++) a[i] = from_bits(CANARY);
}

static size_t length_of(int component)
{
    for (int s = 0; s < INPUTS; s++)
        for (int light = 0; light < (s >= DIRECTION ? MOST_LIGHTS : 1); light++) {
            const int first = component_of(s, light);
            if (component >= first && component < first + inputs[s].components)
                return now.sources[s] == PER_SAMPLE ? now.count : 1;
        }
    return now.count;
}

/* The memory that a place is in. */
static const guarded *memory_of(const float *place)
{
    const unsigned char *byte = (const unsigned char *)place;
    for (int i = 0; i < COMPONENTS; i++)
        if (byte >= memory[i].first && byte <= memory[i].end) return &memory[i];
    return NULL;
}

static bool is_radiance(const arrangement *a, const float *place)
{
    return place == a->place[RADIANCE_AT] || place == a->place[RADIANCE_AT + 1] || place == a->place[RADIANCE_AT + 2];
}

static bool canaries_live(const float *from, const float *to)
{
    for (; from < to; from++)
        if (to_bits(*from) != CANARY) return false;
    return true;
}

const char *find_damage(const arrangement *a)
{
    for (int i = 0; i < RADIANCE_AT; i++) {
        if (!a->place[i] || is_radiance(a, a->place[i])) continue;
        if (memcmp(a->place[i], a->values[i], length_of(i) * sizeof(float))) return "an input was written";
    }
    for (int c = 0; c < 3; c++) {
        const float *radiance = a->place[RADIANCE_AT + c];
        const guarded *m = memory_of(radiance);
        const float *first = (const float *)(const void *)m->first, *end = (const float *)(const void *)m->end;
        if (!canaries_live(first, radiance)) return "something before the radiance was written";
        if (!canaries_live(radiance + a->count, end)) return "something behind the radiance was written";
    }
    return NULL;
}

void clear_arrangement(void)
{
    for (int i = 0; i < COMPONENTS; i++)
        if (now.place[i]) fill_with_canaries(now.place[i], length_of(i));
}

void open_arrangements(void)
{
    for (int i = 0; i < COMPONENTS; i++) {
        memory[i] = guarded_allocate(512 * sizeof(float));
        fill_with_canaries((float *)(void *)memory[i].first, (size_t)(memory[i].end - memory[i].first) / sizeof(float));
    }
    coverage_memory = guarded_allocate(256);
}

void close_arrangements(void)
{
    for (int i = 0; i < COMPONENTS; i++) guarded_free(&memory[i]);
    guarded_free(&coverage_memory);
}
