#include "arrangement.h"

#include "bits.h"
#include "samples.h"
#include "targets.h"

#include <float.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* ---- Values ------------------------------------------------------------------------------------------------------ */

static guarded memory[COMPONENTS], coverage_memory;
static arrangement now;
static size_t drawn;             /* samples whose values are drawn: the count's, or one */

#define CANARY 0x7fe5a5a5u       /* a NaN */
enum { DRAWN_LIGHTS = 5 };       /* the others are these, sample by sample moved on */

bool is_read(const arrangement *a, int stream)
{
    return inputs[stream].owner == OF_LIGHT || a->reads & inputs[stream].bit;
}

bool is_covered(const arrangement *a, size_t i)
{
    return !a->coverage || a->coverage[i / 8] >> i % 8 & 1;
}

static int lights_of(int stream) { return stream >= DIRECTION ? now.light_count : 1; }

/* The highest of a stream's domain. */
static float highest(int stream)
{
    const struct { float sigma_max; } at = { now.recipe->kernel->sigma_max }, *p = &at;
    switch (stream) {
#define FACET_STREAM(id, field, components, owner, low, high, title) case STREAM_##id: return high;
#include "streams.def"
    }
    return 1;
}

/* The stream's value of the sample, or one between 0 and 1. */
static void put(test_random *r, const sample *s, int stream, int light, size_t i)
{
    const float *from = (const float *)(const void *)((const char *)s + inputs[stream].sample);
    for (int c = 0; c < inputs[stream].components; c++)
        now.values[component_of(stream, light) + c][i] =
            inputs[stream].sample == NOT_OF_SAMPLE ? (float)random_unit(r) * fminf(highest(stream), 1) : from[c];
}

static void draw_sample(test_random *r, size_t i)
{
    for (int light = 0; light < now.light_count || light == 0; light++) {
        if (light >= DRAWN_LIGHTS) break;
        const int kind = (int)(random_u64(r) % SAMPLES_KINDS);
        const sample s = random_sample(r, kind, 0.001f, now.recipe->kernel->sigma_max);
        for (int stream = DIRECTION; stream < INPUTS && light < now.light_count; stream++) put(r, &s, stream, light, i);
        for (int stream = 0; stream < BATCH_STREAMS && light == 0; stream++)
            if (now.reads & inputs[stream].bit) put(r, &s, stream, 0, i);
    }
}

static void copy_lights(void)
{
    for (int light = DRAWN_LIGHTS; light < now.light_count; light++)
        for (int c = 0; c < LIGHT_COMPONENTS; c++) {
            const int to = LIGHT_AT + LIGHT_COMPONENTS * light + c;
            const int from = LIGHT_AT + LIGHT_COMPONENTS * (light % DRAWN_LIGHTS) + c;
            for (size_t i = 0; i < drawn; i++) now.values[to][i] = now.values[from][(i + (size_t)light) % drawn];
        }
}

static float dot(int a, int b, size_t i)
{
    float sum = 0;
    for (int c = 0; c < 3; c++) sum += now.values[a + c][i] * now.values[b + c][i];
    return sum;
}

/* Turns the vector at `a` around where it is not on the side of `b`. */
static void turn(int a, int b, size_t i)
{
    const bool away = dot(a, b, i) < 0;
    for (int c = 0; c < 3 && away; c++) now.values[a + c][i] = -now.values[a + c][i];
}

/* A tangent of its own goes across the normal. */
static void straighten_tangent(size_t i)
{
    double t[3], length2 = 0;
    const double along = (double)dot(AT_TANGENT, AT_NORMAL, i);
    for (int c = 0; c < 3; c++) {
        t[c] = (double)now.values[AT_TANGENT + c][i] - along * (double)now.values[AT_NORMAL + c][i];
        length2 += t[c] * t[c];
    }
    for (int c = 0; c < 3; c++) now.values[AT_TANGENT + c][i] = (float)(t[c] / sqrt(length2));
}

/* Lights with a position alone have no direction but what follows from it. */
static bool has_direction(void)
{
    return now.light_count > 0 && now.lights[0].kind == FACET_LIGHT_DIRECTIONAL;
}

/* Uniform values are the first sample's; of a light's irradiance not all three are 0. */
static void share_values(void)
{
    for (int s = 0; s < INPUTS; s++) {
        if (now.sources[s] == PER_SAMPLE || !is_read(&now, s) || (s == DIRECTION && !has_direction())) continue;
        for (int light = 0; light < lights_of(s); light++) {
            float (*a)[MOST_COUNT] = &now.values[component_of(s, light)];
            if (s == IRRADIANCE && a[0][0] + a[1][0] + a[2][0] == 0) a[1][0] = 1;
            for (int c = 0; c < inputs[s].components; c++)
                for (size_t i = 1; i < drawn; i++) a[c][i] = a[c][0];
        }
    }
}

/* Vectors that are not uniform turn to where something is to be seen, mostly. */
static void turn_vectors(test_random *r)
{
    for (size_t i = 0; i < drawn; i++) {
        if (now.reads & FACET_STREAM_TANGENT && now.sources[STREAM_TANGENT] == PER_SAMPLE) straighten_tangent(i);
        if (random_u64(r) % 8 == 0) continue;
        if (now.reads & FACET_STREAM_VIEW) {
            if (now.sources[STREAM_VIEW] == PER_SAMPLE) turn(AT_VIEW, AT_NORMAL, i);
            else if (now.sources[STREAM_NORMAL] == PER_SAMPLE) turn(AT_NORMAL, AT_VIEW, i);
        }
        if (now.sources[DIRECTION] != PER_SAMPLE && has_direction()) continue;
        for (int light = 0; light < now.light_count; light++) turn(component_of(DIRECTION, light), AT_NORMAL, i);
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
    int streams[INPUTS], count = 0;
    for (int s = 0; s < INPUTS; s++)
        if (is_read(&now, s) && lights_of(s) > 0 && now.sources[s] == PER_SAMPLE) streams[count++] = s;
    for (size_t i = 0; i < drawn; i++) {
        now.ordinary[i] = count == 0 || random_u64(r) % 64 >= in_64;
        if (now.ordinary[i]) continue;
        const int s = streams[random_u64(r) % (uint64_t)count];
        const int light = (int)(random_u64(r) % (uint64_t)lights_of(s));
        const int component = component_of(s, light) + (int)(random_u64(r) % (uint64_t)inputs[s].components);
        now.values[component][i] = draw_edge(r, false);
    }
}

/* Now and then an edge value for all samples: in the batch, or as a light's red irradiance, which must be finite. */
static void draw_uniform_edges(test_random *r)
{
    for (int s = 0; s < INPUTS; s++) {
        const bool light = s == IRRADIANCE && now.sources[s] == ELSEWHERE && now.light_count > 0;
        const bool uniform = is_read(&now, s) && now.sources[s] == UNIFORM;
        const float edge = draw_edge(r, light);
        if (random_u64(r) % 8 || !(light || uniform)) continue;
        if (light && !(now.values[component_of(s, 0) + 1][0] > 0)) continue;      /* it may not be all 0 */
        for (size_t i = 0; i < drawn; i++) {
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
        now.numbers.emission[c] = added == ADD_EMISSION || added == ADD_ALL ? emission : 0;
        now.ambient[c] = added == ADD_AMBIENT || added == ADD_ALL ? ambient : 0;
        for (int i = 0; i < 4; i++) {
            const float harmonic = 2 * (float)random_unit(r) - (i ? 1 : 0.5f);
            now.sh[i][c] = added == ADD_HARMONICS || added == ADD_ALL ? harmonic : 0;
        }
    }
}

static void draw_numbers(test_random *r, int numbers)
{
    facet_material *m = &now.numbers;
    *m = now.recipe->kernel->material;
    m->convention.model = now.recipe->convention;
    if (numbers == NUMBERS_OF_KERNEL) return;
    m->specular.scale = 0.5f + (float)random_unit(r);
    m->fresnel.f90 = (float)random_unit(r);
    m->fresnel.eta_outside = 1 + 0.5f * (float)random_unit(r);
    m->fresnel.polarisation = 2 * (float)random_unit(r) - 1;
    for (int c = 0; c < 3 && m->fresnel.model == FACET_FRESNEL_SCHLICK_F82; c++) {
        m->fresnel.f82[c] = numbers == NUMBERS_DERIVED ? 0 : (float)random_unit(r);
        if (numbers != NUMBERS_DERIVED) continue;
        m->fresnel.eta[c] = 0.1f + 3 * (float)random_unit(r);
        m->fresnel.k[c] = 4 * (float)random_unit(r);
    }
}

/* ---- Lights with a position -------------------------------------------------------------------------------------- */

static facet_light_kind kind_of(int kinds, int light)
{
    return (facet_light_kind)(kinds == KINDS_IN_TURN ? light % KINDS_IN_TURN : kinds);
}

/* Where they see the origin along the direction of their first light; uniform: where the first sample does. */
static void draw_positions(test_random *r, const float *origin)
{
    for (size_t i = 0; i < drawn; i++) {
        const float distance = 0.25f + 2 * (float)random_unit(r);
        for (int c = 0; c < 3; c++) {
            float *a = now.values[AT_POSITION + c];
            a[i] = origin[c] - distance * now.values[component_of(DIRECTION, 0) + c][i];
            if (now.sources[STREAM_POSITION] == UNIFORM) a[i] = a[0];
        }
    }
}

/* Points a spot light at the first sample, more or less; one in four has cones that are equal. */
static void aim(test_random *r, facet_light *light)
{
    double axis[3], length2 = 0;
    for (int c = 0; c < 3; c++) {
        axis[c] = (double)now.values[AT_POSITION + c][0] - (double)light->position[c] + random_unit(r) - 0.5;
        length2 += axis[c] * axis[c];
    }
    for (int c = 0; c < 3; c++) light->axis[c] = (float)(axis[c] / sqrt(length2));
    light->cos_outer = (float)random_unit(r) - 0.5f;
    light->cos_inner = random_u64(r) % 4 ? light->cos_outer + 0.25f + 0.25f * (float)random_unit(r) : light->cos_outer;
}

static void draw_lights(test_random *r, int kinds)
{
    for (int i = 0; i < now.light_count; i++) {
        facet_light *light = &now.lights[i];
        *light = (facet_light){ .kind = kind_of(kinds, i) };
        if (light->kind == FACET_LIGHT_DIRECTIONAL) continue;
        for (int c = 0; c < 3; c++) light->position[c] = 4 * (float)random_unit(r) - 2;
        light->range = random_u64(r) & 1 ? 2 + 4 * (float)random_unit(r) : 0;
    }
}

/* Samples around the first light that has a position, and spot lights at samples. */
static void place_samples(test_random *r)
{
    if (!(now.reads & FACET_STREAM_POSITION)) return;
    draw_positions(r, now.lights[has_direction()].position);
    for (int i = 0; i < now.light_count; i++)
        if (now.lights[i].kind == FACET_LIGHT_SPOT) aim(r, &now.lights[i]);
}

static void draw_values(test_random *r, const design *d)
{
    drawn = now.count > 0 ? now.count : 1;
    draw_numbers(r, d->level[FACTOR_NUMBERS]);
    for (size_t i = 0; i < drawn; i++) draw_sample(r, i);
    copy_lights();
    draw_lights(r, d->level[FACTOR_LIGHT_KIND]);
    share_values();
    turn_vectors(r);
    place_samples(r);
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
    return first + 256 + (offsets[level] + 5 * component) % 16;
}

static size_t length_of(int stream) { return now.sources[stream] == PER_SAMPLE ? now.count : 1; }

/* Whether it has a place of its own. */
static bool is_placed(int stream) { return is_read(&now, stream) && now.sources[stream] != ELSEWHERE; }

static void place_stream(int stream, int level)
{
    for (int light = 0; light < lights_of(stream) && is_placed(stream); light++)
        for (int c = 0; c < inputs[stream].components; c++) {
            const int component = component_of(stream, light) + c;
            now.place[component] = place_at(component, level, length_of(stream));
            memcpy(now.place[component], now.values[component], length_of(stream) * sizeof(float));
        }
}

/* Radiance on an input (its components turned round, or its one component as green, the others anywhere), or on its
 * own. */
static void place_radiance(int in_place, int level)
{
    for (int c = 0; c < 3; c++) {
        const int stream = in_place - 1, to = RADIANCE_AT + c;
        if (in_place && (inputs[stream].components == 3 || c == 1)) {
            const int from = component_of(stream, 0) + (inputs[stream].components == 3 ? (c + 1) % 3 : 0);
            now.place[to] = now.place[from];
            memcpy(now.values[to], now.values[from], sizeof now.values[to]);
        } else {
            now.place[to] = place_at(to, level < 0 ? 0 : level, now.count);
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
    facet_material m = a->numbers;
    for (int s = 0; s < BATCH_STREAMS; s++) {
        float *number = (float *)(void *)((char *)&m + inputs[s].number);
        if (!is_parameter(s) || !is_read(a, s)) continue;
        if (sources[s] != ELSEWHERE) m.streams |= inputs[s].bit;
        for (int c = 0; c < inputs[s].components; c++)
            number[c] = sources[s] == ELSEWHERE ? a->values[component_of(s, 0) + c][0] : NAN;
    }
    return m;
}

static void point_light(const arrangement *a, float *const *at, int number, facet_light *light,
                        const stream_source *sources)
{
    *light = a->lights[number];
    const bool from_streams = light->kind == FACET_LIGHT_DIRECTIONAL && sources[DIRECTION] == PER_SAMPLE;
    for (int c = 0; c < 3; c++) {
        const int direction = component_of(DIRECTION, number) + c, irradiance = component_of(IRRADIANCE, number) + c;
        const bool has_number = light->kind == FACET_LIGHT_DIRECTIONAL && !from_streams;
        light->direction[c] = has_number ? a->values[direction][0] : NAN;
        light->irradiance[c] = sources[IRRADIANCE] == PER_SAMPLE ? NAN : a->values[irradiance][0];
        if (from_streams) light->direction_of[c] = at[direction];
        if (sources[IRRADIANCE] == PER_SAMPLE) light->irradiance_of[c] = at[irradiance];
    }
    if (sources[VISIBILITY] == PER_SAMPLE) light->visibility = at[component_of(VISIBILITY, number)];
}

facet_batch point_batch(const arrangement *a, float *const *at, facet_light *lights, const stream_source *sources)
{
    facet_batch b = { .lights = lights, .light_count = (size_t)a->light_count, .flags = a->flags };
    for (int s = 0; s < BATCH_STREAMS; s++) {
        const float **stream = (const float **)(void *)((char *)&b + inputs[s].batch);
        if (!is_read(a, s) || sources[s] == ELSEWHERE) continue;
        for (int c = 0; c < inputs[s].components; c++) stream[c] = at[component_of(s, 0) + c];
        if (sources[s] == UNIFORM) b.uniform |= inputs[s].bit;
    }
    for (int c = 0; c < 3; c++) b.radiance[c] = at[RADIANCE_AT + c];
    memcpy(b.ambient, a->ambient, sizeof b.ambient);
    memcpy(b.sh, a->sh, sizeof b.sh);
    for (int i = 0; i < a->light_count; i++) point_light(a, at, i, &lights[i], sources);
    return b;
}

/* ---- An arrangement ---------------------------------------------------------------------------------------------- */

static void describe(const design *d)
{
    const int *level = d->level;
    size_t end = (size_t)snprintf(now.words, sizeof now.words,
                                  "%s, convention %d%s, %zu samples, %d lights of kind %d, flags %u, ",
                                  now.recipe->kernel->name, (int)now.recipe->convention,
                                  now.recipe->from_others ? " from others" : "", now.count, now.light_count,
                                  level[FACTOR_LIGHT_KIND], (unsigned)now.flags);
    end += (size_t)snprintf(now.words + end, sizeof now.words - end,
                            "coverage %d, in place %d, numbers %d, added %d, edges %d%s;", level[FACTOR_COVERAGE],
                            level[FACTOR_IN_PLACE], level[FACTOR_NUMBERS], level[FACTOR_ADDED], level[FACTOR_EDGES],
                            now.counted ? ", counted" : "");
    for (int s = 0; s < INPUTS && end < sizeof now.words; s++)
        if (level[FACTOR_SOURCE + s] >= 0)
            end += (size_t)snprintf(now.words + end, sizeof now.words - end, " %s %d@%d", inputs[s].name,
                                    (int)now.sources[s], level[FACTOR_PLACE + s]);
}

/* What of the batch is read, wherever it is. */
static uint32_t streams_read(const int *level)
{
    uint32_t reads = now.recipe->reads | FACET_STREAM_NORMAL;
    if (now.sources[STREAM_VIEW] != ELSEWHERE) reads |= FACET_STREAM_VIEW;
    if (now.sources[STREAM_OCCLUSION] != ELSEWHERE) reads |= FACET_STREAM_OCCLUSION;
    if (now.light_count > 0 && level[FACTOR_LIGHT_KIND] != FACET_LIGHT_DIRECTIONAL) reads |= FACET_STREAM_POSITION;
    return reads;
}

const arrangement *arrange(const design *d, int number)
{
    const int *level = d->level;
    test_random r = { (uint64_t)number };
    now.recipe = recipe_at(level[FACTOR_RECIPE]);
    now.target = target_at(level[FACTOR_TARGET]);
    now.count = (size_t)tested_count(level[FACTOR_COUNT]);
    now.light_count = light_counts[level[FACTOR_LIGHTS]];
    now.flags = (level[FACTOR_ACCUMULATE] ? FACET_ACCUMULATE : 0u) | (level[FACTOR_TWO_SIDED] ? FACET_TWO_SIDED : 0u);
    for (int s = 0; s < INPUTS; s++) {
        const int source = level[FACTOR_SOURCE + s];
        now.sources[s] = source < 0 ? ELSEWHERE : source_at(s, source);
    }
    now.reads = streams_read(level);
    now.counted = level[FACTOR_COUNTED];
    memset(now.place, 0, sizeof now.place);
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

static bool is_as_it_was(const arrangement *a, int stream)
{
    for (int light = 0; light < lights_of(stream) && is_placed(stream); light++)
        for (int c = 0; c < inputs[stream].components; c++) {
            const int i = component_of(stream, light) + c;
            if (!is_radiance(a, a->place[i]) && memcmp(a->place[i], a->values[i], length_of(stream) * sizeof(float)))
                return false;
        }
    return true;
}

const char *find_damage(const arrangement *a)
{
    for (int s = 0; s < INPUTS; s++)
        if (!is_as_it_was(a, s)) return "an input was written";
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
    for (int s = 0; s < INPUTS; s++)
        for (int light = 0; light < lights_of(s) && is_placed(s); light++)
            for (int c = 0; c < inputs[s].components; c++)
                fill_with_canaries(now.place[component_of(s, light) + c], length_of(s));
    for (int c = 0; c < 3; c++) fill_with_canaries(now.place[RADIANCE_AT + c], now.count);
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
