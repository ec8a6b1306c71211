/* The models in double, from MODELS as published, sharing no code with src: what every kernel is measured against.
 * Plain functions of one sample; no approximation, no clamp but those that facet.h documents. */
#ifndef REFERENCE_H
#define REFERENCE_H

#include "facet.h"

typedef struct {
    float n[3], v[3], l[3];
    float albedo[3], sigma, alpha, f0[3];
    float irradiance[3];
} sample;

/* The cosines of a sample, exact functions of its floats. */
typedef struct { double nl, nv, vl, nh, vh; } cosines;
cosines reference_cosines(const sample *s);

/* Radiance of one light at one sample: the material's models, with the sample's albedo, sigma, alpha, f0 in place of
 * the material's, and the material's f90 (0: 1). */
void reference_radiance(const facet_material *m, const sample *s, double radiance[3]);

/* The same, and its magnitude: what rounding errors are relative to. It is the radiance but for terms that cancel:
 * Fujii's s0 counts as |s0|, 1 - F of `coupled` as 1, and of Schlick's five factors 1 - vh one as 1. */
void reference_terms(const facet_material *m, const sample *s, double radiance[3], double magnitude[3]);

#endif
