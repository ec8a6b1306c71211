/* Where tests look: random samples, directions in the lobe, and the lattice of edge values. */
#ifndef SAMPLES_H
#define SAMPLES_H

#include "cases.h"
#include "harness.h"
#include "reference.h"

enum { SAMPLES_UNIFORM, SAMPLES_LOBE, SAMPLES_GRAZING, SAMPLES_OPPOSED, SAMPLES_KINDS };

/* A random sample with nl, nv > 0 and float vectors as near to unit length, the tangent as near to perpendicular, as
 * rounding leaves them; n is any direction. UNIFORM: v, l uniform on the hemisphere. LOBE: l around the mirror
 * direction, as narrow as alpha. GRAZING: nl or nv log-uniform down to 2^-22. OPPOSED: v + l near 0. alpha and alpha_y
 * are log-uniform in [alpha_min, 1], the exponent in its domain; eta is a dielectric's, a metal's or near 1, k 0 or a
 * metal's; the rest is uniform in its domain (sigma in [0, sigma_max]), with the domain's ends drawn now and then. From
 * the position, the origin is seen along l, at a log-uniform distance. */
sample random_sample(test_random *, int kind, float alpha_min, float sigma_max);

/* The same for a kernel: of its sigma, its light, and with LOBE as narrow as its distribution. */
sample random_sample_of(const kernel_case *, test_random *, int kind, float alpha_min);

/* Puts the sample under a point or spot light, at that distance and nearly along l, which then follows from position;
 * sets l to what follows. */
void light_sample(sample *s, const facet_light *light, double distance);
void aim_sample(sample *s);

/* Edge values: 0, subnormals, 1 +- ulps, powers of ten and two … */
extern const float edge_values[];
extern const int edge_count;

/* Structure of arrays: allocates streams for `count` samples and fills them; the batch points into them. Its one light
 * is a copy of `light` beside them: the first point or spot light that a sample has, or a directional one. Radiance is
 * left as it comes. */
typedef struct { int count; float *memory; facet_batch batch; facet_light light; } sample_batch;
sample_batch batch_of(const sample *samples, int count);     /* light's direction_of and irradiance_of: the samples' */
void free_batch(sample_batch *);

#endif
