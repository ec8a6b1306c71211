/* A batch in one arrangement of everything that must not matter: where its streams stand, where its parameters come
 * from, what is covered, what aliases what. */
#ifndef ARRANGEMENT_H
#define ARRANGEMENT_H

#include "cases.h"
#include "guarded.h"
#include "pairwise.h"

/* The streams of a batch, and those of every light. */
enum { NORMAL, VIEW, ALBEDO, SIGMA, ALPHA, F0, DIRECTION, IRRADIANCE, VISIBILITY, INPUTS };

/* Where a stream's values come from: a value a sample; one in the batch; the material or the light, or nowhere. */
typedef enum { PER_SAMPLE, UNIFORM, ELSEWHERE } stream_source;
extern const stream_source all_per_sample[INPUTS];

enum {
    FACTOR_CASE, FACTOR_LIGHTS, FACTOR_TWO_SIDED, FACTOR_IN_PLACE, FACTOR_COVERAGE,
    FACTOR_SOURCE,                                   /* of stream s: + s */
    FACTOR_PLACE = FACTOR_SOURCE + INPUTS,           /* + s; + INPUTS: radiance */
    FACTOR_COVERAGE_PLACE = FACTOR_PLACE + INPUTS + 1,
    FACTOR_TARGET, FACTOR_COUNT, FACTOR_ACCUMULATE, FACTOR_ADDED, FACTOR_EDGES, FACTOR_COUNTED, FACTORS
};

/* The components of all streams, five times those of the lights, then radiance. */
enum { MOST_LIGHTS = 5, LIGHT_AT = 14, RADIANCE_AT = LIGHT_AT + 7 * MOST_LIGHTS, COMPONENTS = RADIANCE_AT + 3 };
enum { MOST_COUNT = 131 };

typedef struct {
    const kernel_case *kernel;
    facet_target target;
    size_t count;
    int lights;
    uint32_t flags;
    bool has_view, has_visibility;
    bool counted;                                /* the batch counts invalid samples */
    stream_source sources[INPUTS];
    float values[COMPONENTS][MOST_COUNT];        /* what each sample has; radiance: what stood there before */
    bool ordinary[MOST_COUNT];                   /* no edge value among them */
    float emission[3], ambient[3];
    float *place[COMPONENTS];                    /* between pages that fault; NULL where the values are elsewhere */
    uint8_t *coverage;
    char words[400];                             /* the levels, for messages */
} arrangement;

int component_of(int stream, int light);
bool is_covered(const arrangement *, size_t i);

facet_material material_of(const arrangement *, const stream_source *sources);

/* A batch and its lights over streams that start at `at`. Count, coverage and invalid are left to the caller. */
facet_batch point_batch(const arrangement *, float *const *at, facet_light *lights, const stream_source *sources);

factor_space arrangement_space(void);

/* The everyday batch, which a kernel may have a short way for: many covered samples, one light without streams, nothing
 * added; drawn are the parameters' sources, the places, edge values, and whether invalid samples are counted. */
design plain_design(int target, int kernel, uint64_t seed);

/* There is one arrangement at a time, between open_ and close_arrangements; `number` seeds its values. */
void open_arrangements(void);
const arrangement *arrange(const design *, int number);
void clear_arrangement(void);
void close_arrangements(void);

/* NULL, or what was written that should not have been: an input, or a place beside the radiance. */
const char *find_damage(const arrangement *);

#endif
