/* The models in double, from MODELS as published, sharing no code with src: what every kernel is measured against.
 * Plain functions of one sample; no approximation, no clamp but those that facet.h documents. */
#ifndef REFERENCE_H
#define REFERENCE_H

#include "facet.h"

typedef struct {
    float n[3], v[3], l[3];
    float tangent[3], position[3];
    float albedo[3], sigma, alpha, alpha_y, exponent, f0[3], eta[3], k[3];
    float irradiance[3];         /* of point and spot lights at a distance of 1 */
    const facet_light *light;    /* NULL, or a point or spot light: then l follows from position */
} sample;

/* The cosines of a sample, exact functions of its floats. */
typedef struct { double nl, nv, vl, nh, vh; } cosines;
cosines reference_cosines(const sample *s);

/* The direction to the sample's light: l, or what follows from position; 0 where a point or spot light has none. */
void reference_direction(const sample *s, double l[3]);

/* Radiance of one light at one sample: the material's models, with the sample's values in place of the material's but
 * for those that no stream brings: specular.scale, f90, f82, eta_outside, polarisation. */
void reference_radiance(const facet_material *m, const sample *s, double radiance[3]);

/* The same, and its magnitude: what rounding errors are relative to. It is the radiance, but
 *   - terms that cancel count as their absolute values: s0 of Fujii and EON, every term of the full Oren-Nayar, both of
 *     F82; 1 - F of `coupled` counts as 1, or as F where that is more; Rp, whose numerator cancels, as Rs; under point
 *     and spot lights, whose l is rounded, |w| of the specular part as |v| + |l|, which is 1/vh times as much;
 *   - of Schlick's five factors 1 - vh, and F82's six, one counts as 1;
 *   - an exponential or a power, e^-x, counts 1 + x times, and at least 2^-100, as its argument's error is x times as
 *     large and its result may underflow;
 *   - where a small step turns much, f(x) counts as f(x) + max |f(x') - f(x)|/s, x' both neighbours of x at a distance
 *     of s = 2^-21, which is 8 units of rounding: Rs and Rp, each, of vh (s relative), as they have a critical angle;
 *     Phong's lobe of the angle between r and v; a range's window of the distance (s relative); a cone's smoothstep of
 *     the cosine. */
void reference_terms(const facet_material *m, const sample *s, double radiance[3], double magnitude[3]);

/* The specular part's factors, f = scale D G F/(4 nl nv): D, of a lobe all but F; G, of a lobe 4 nl nv; F of a channel.
 * Of samples that are lit. */
double reference_distribution(const facet_material *m, const sample *s);
double reference_masking(const facet_material *m, const sample *s);
double reference_fresnel(const facet_material *m, const sample *s, int channel);

#endif
