/* What goes with what. */
#include "factors.h"

#include "harness.h"
#include "targets.h"

const int light_counts[LIGHT_COUNTS] = { 0, 1, 2, 5, MOST_LIGHTS };
enum { FIRST_OF_MANY = 3 };

const unsigned edges_in_64[EDGES] = { 0, 1, 16 };

const int offsets[OFFSETS] = { 0, 1, 2, 4, 8, 11, 15 };

/* Around every multiple of a vector, of a group of vectors, of a block of 64. */
static const unsigned char counts[] = {
    0,  1,  2,  3,  4,  5,  6,  7,  8,  9,  10, 11, 12, 13, 15, 16, 17, 19, 20, 21, 23, 24, 25, 28, 31, 32, 33, 36, 39,
    40, 41, 47, 48, 49, 56, 63, 64, 65, 80, 96, 127, 128, 129, 131,
};
static const unsigned char counts_for_slow_machines[] = {
    0, 1, 2, 3, 4, 5, 7, 8, 9, 13, 15, 16, 17, 31, 32, 33, 49, 63, 64, 67, 128, 131,
};

stream_source source_at(int stream, int level)
{
    return stream >= DIRECTION && level == 1 ? ELSEWHERE : (stream_source)level;
}

static int source_levels(int stream)
{
    return stream < DIRECTION && (is_parameter(stream) || is_optional(stream)) ? 3 : 2;
}

int tested_count(int level)
{
    return test_slow_machine ? counts_for_slow_machines[level] : counts[level];
}

static level_set recipes_that(bool (*is)(const recipe *, uint32_t), uint32_t streams)
{
    level_set set = { { 0 } };
    for (int i = 0; i < recipe_count(); i++)
        if (is(recipe_at(i), streams)) add_level(&set, i);
    return set;
}

static bool read_any(const recipe *r, uint32_t streams) { return r->reads & streams; }
static bool read_none(const recipe *r, uint32_t streams) { return !(r->reads & streams); }
static bool need_no_view(const recipe *r, uint32_t streams) { (void)streams; return !r->kernel->view; }

static level_set levels_from(int stream, bool uniform)
{
    level_set set = { { 0 } };
    for (int i = 0; i < source_levels(stream); i++) {
        const stream_source source = source_at(stream, i);
        if (source == PER_SAMPLE || (uniform && source == UNIFORM)) add_level(&set, i);
    }
    return set;
}

static void require_lights(level_set *allowed)
{
    remove_level(&allowed[FACTOR_LIGHTS], 0);
}

/* That the batch has the stream, or the material its number. */
static void require_stream(int stream, level_set *allowed)
{
    if (stream >= DIRECTION || stream == STREAM_POSITION) require_lights(allowed);
    if (stream == STREAM_POSITION) {
        remove_level(&allowed[FACTOR_LIGHT_KIND], FACET_LIGHT_DIRECTIONAL);
    } else if (stream == DIRECTION) {
        remove_level(&allowed[FACTOR_LIGHT_KIND], FACET_LIGHT_POINT);
        remove_level(&allowed[FACTOR_LIGHT_KIND], FACET_LIGHT_SPOT);
    } else if (is_parameter(stream) || stream == STREAM_TANGENT) {
        keep_levels(&allowed[FACTOR_RECIPE], recipes_that(read_any, inputs[stream].bit));
    }
}

static void require_source(int stream, int level, level_set *allowed)
{
    const stream_source source = source_at(stream, level);
    require_stream(stream, allowed);
    if (source != PER_SAMPLE) remove_level(&allowed[FACTOR_IN_PLACE], 1 + stream);
    if (source != ELSEWHERE || stream != STREAM_VIEW) return;
    keep_levels(&allowed[FACTOR_RECIPE], recipes_that(need_no_view, 0));
    remove_level(&allowed[FACTOR_TWO_SIDED], 1);
}

/* That the stream stands somewhere, and is not uniform where it must not be. */
static void require_place(int stream, bool uniform, level_set *allowed)
{
    require_stream(stream, allowed);
    keep_levels(&allowed[FACTOR_SOURCE + stream], levels_from(stream, uniform));
}

static void require_kind(int kind, level_set *allowed)
{
    require_lights(allowed);
    for (int i = 0; i < FIRST_OF_MANY && kind == KINDS_IN_TURN; i++) remove_level(&allowed[FACTOR_LIGHTS], i);
}

static void require(int factor, int level, level_set *allowed)
{
    if (factor >= FACTOR_SOURCE && factor < FACTOR_SOURCE + INPUTS) {
        require_source(factor - FACTOR_SOURCE, level, allowed);
    } else if (factor >= FACTOR_PLACE && factor < FACTOR_PLACE + INPUTS) {
        require_place(factor - FACTOR_PLACE, true, allowed);
    } else if (factor == FACTOR_PLACE + INPUTS) {
        for (int s = 0; s < INPUTS; s++) remove_level(&allowed[FACTOR_IN_PLACE], 1 + s);
    } else if (factor == FACTOR_IN_PLACE && level > 0) {
        require_place(level - 1, false, allowed);
    } else if (factor == FACTOR_COVERAGE_PLACE) {
        remove_level(&allowed[FACTOR_COVERAGE], COVER_POINTER_NULL);
    } else if (factor == FACTOR_TWO_SIDED && level) {
        keep_levels(&allowed[FACTOR_SOURCE + STREAM_VIEW], levels_from(STREAM_VIEW, true));
    } else if (factor == FACTOR_LIGHT_KIND) {
        require_kind(level, allowed);
    } else if (factor == FACTOR_NUMBERS && level == NUMBERS_DERIVED) {
        keep_levels(&allowed[FACTOR_RECIPE], recipes_that(read_none, FACET_STREAM_ETA | FACET_STREAM_K));
    }
}

factor_space arrangement_space(void)
{
    factor_space space = { .factors = FACTORS, .require = require };
    int *levels = space.levels;
    levels[FACTOR_RECIPE] = recipe_count();
    levels[FACTOR_LIGHTS] = LIGHT_COUNTS;
    levels[FACTOR_LIGHT_KIND] = LIGHT_KINDS;
    levels[FACTOR_TWO_SIDED] = levels[FACTOR_ACCUMULATE] = levels[FACTOR_COUNTED] = 2;
    levels[FACTOR_NUMBERS] = NUMBERS;
    levels[FACTOR_ADDED] = ADDED;
    levels[FACTOR_EDGES] = EDGES;
    levels[FACTOR_IN_PLACE] = 1 + INPUTS;
    levels[FACTOR_COVERAGE] = COVERAGES;
    for (int s = 0; s < INPUTS; s++) levels[FACTOR_SOURCE + s] = source_levels(s);
    for (int s = 0; s <= INPUTS; s++) levels[FACTOR_PLACE + s] = PLACES;
    levels[FACTOR_COVERAGE_PLACE] = COVERAGE_PLACES;
    levels[FACTOR_TARGET] = target_count();
    levels[FACTOR_COUNT] = test_slow_machine ? sizeof counts_for_slow_machines : sizeof counts;
    for (int f = 0; f < FACTORS; f++) expect(levels[f] <= MOST_LEVELS, "factor %d has %d levels", f, levels[f]);
    return space;
}

design plain_design(int target, int number, uint64_t seed)
{
    const factor_space space = arrangement_space();
    test_random r = { seed };
    design d;
    for (int f = 0; f < FACTORS; f++) d.level[f] = 0;
    for (int s = 0; s < INPUTS; s++) {
        const bool read = recipe_at(number)->reads & inputs[s].bit, per_sample = random_u64(&r) & 1;
        const int any = (int)(random_u64(&r) % (uint64_t)space.levels[FACTOR_SOURCE + s]);
        if (is_parameter(s)) d.level[FACTOR_SOURCE + s] = !read ? -1 : per_sample ? 0 : any;
        if (s >= DIRECTION) d.level[FACTOR_SOURCE + s] = 1;
    }
    d.level[FACTOR_SOURCE + STREAM_OCCLUSION] = ELSEWHERE;
    for (int f = FACTOR_PLACE; f <= FACTOR_PLACE + INPUTS; f++) d.level[f] = (int)(random_u64(&r) % PLACES);
    d.level[FACTOR_EDGES] = (int)(random_u64(&r) % (uint64_t)space.levels[FACTOR_EDGES]);
    d.level[FACTOR_COUNTED] = random_u64(&r) % 4 == 0;
    d.level[FACTOR_TARGET] = target;
    d.level[FACTOR_RECIPE] = number;
    d.level[FACTOR_LIGHTS] = 1;
    d.level[FACTOR_COUNT] = space.levels[FACTOR_COUNT] - 1 - (int)(random_u64(&r) % 4);
    return d;
}
