/* What an arrangement is made of: the factors of its design, and what their levels stand for. */
#ifndef FACTORS_H
#define FACTORS_H

#include "inputs.h"
#include "pairwise.h"

enum {
    FACTOR_RECIPE, FACTOR_LIGHTS, FACTOR_LIGHT_KIND, FACTOR_TWO_SIDED, FACTOR_IN_PLACE, FACTOR_COVERAGE,
    FACTOR_SOURCE,                                   /* of stream s: + s */
    FACTOR_PLACE = FACTOR_SOURCE + INPUTS,           /* + s; + INPUTS: radiance */
    FACTOR_COVERAGE_PLACE = FACTOR_PLACE + INPUTS + 1,
    FACTOR_TARGET, FACTOR_COUNT, FACTOR_NUMBERS, FACTOR_ACCUMULATE, FACTOR_ADDED, FACTOR_EDGES, FACTOR_COUNTED, FACTORS
};

/* Where a stream's values come from: a value a sample; one in the batch; the material or the light, or nowhere. */
typedef enum { PER_SAMPLE, UNIFORM, ELSEWHERE } stream_source;
stream_source source_at(int stream, int level);

int tested_count(int level);

enum { LIGHT_COUNTS = 5 };
extern const int light_counts[LIGHT_COUNTS];

/* Kinds of lights: all of one, or in turn. */
enum { KINDS_IN_TURN = FACET_LIGHT_SPOT + 1, LIGHT_KINDS };

enum { COVER_POINTER_NULL, COVER_ALL, COVER_NONE, COVER_RANDOM, COVER_ONE, COVERAGES };

enum { ADD_NOTHING, ADD_EMISSION, ADD_AMBIENT, ADD_HARMONICS, ADD_ALL, ADDED };

/* The material's numbers that no stream brings: the kernel's; drawn; drawn, with f82 from eta and k. */
enum { NUMBERS_OF_KERNEL, NUMBERS_DRAWN, NUMBERS_DERIVED, NUMBERS };

/* How many samples in 64 have an edge value. */
enum { EDGES = 3 };
extern const unsigned edges_in_64[EDGES];

/* Places of a stream: so many floats beyond a vector's alignment; at the first page's start; at the last page's end. */
enum { OFFSETS = 7, PLACE_LOW = OFFSETS, PLACE_HIGH, PLACES };
extern const int offsets[OFFSETS];
enum { COVERAGE_LOW, COVERAGE_INSIDE, COVERAGE_HIGH, COVERAGE_PLACES };

factor_space arrangement_space(void);

/* The everyday batch, which a kernel may have a short way for: many covered samples, one light without streams, nothing
 * added; drawn are the parameters' sources, the places, edge values, and whether invalid samples are counted. */
design plain_design(int target, int recipe, uint64_t seed);

#endif
