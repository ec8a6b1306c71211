/* Where tests look: random samples, directions in the lobe, and the lattice of edge values. */
#ifndef SAMPLES_H
#define SAMPLES_H

#include "harness.h"
#include "reference.h"

enum { SAMPLES_UNIFORM, SAMPLES_LOBE, SAMPLES_GRAZING, SAMPLES_OPPOSED, SAMPLES_KINDS };

/* A random sample with nl, nv > 0 and float vectors as near to unit length as rounding leaves them; n is any direction.
 * UNIFORM: v, l uniform on the hemisphere. LOBE: l around the mirror direction, as narrow as alpha. GRAZING: nl or nv
 * log-uniform down to 2^-22. OPPOSED: v + l near 0. alpha is log-uniform in [alpha_min, 1]; the rest uniform in its
 * domain (sigma in [0, sigma_max]), with the domain's ends drawn now and then. */
sample random_sample(test_random *, int kind, float alpha_min, float sigma_max);

/* Edge values: 0, subnormals, 1 +- ulps, powers of ten and two … */
extern const float edge_values[];
extern const int edge_count;

/* Structure of arrays: allocates streams for `count` samples and fills them; the batch points into them, and its one
 * light is a copy of `light` beside them. Radiance is left as it comes. */
typedef struct { int count; float *memory; facet_batch batch; facet_light light; } sample_batch;
sample_batch batch_of(const sample *samples, int count);     /* light's direction_of and irradiance_of: the samples' */
void free_batch(sample_batch *);

#endif
