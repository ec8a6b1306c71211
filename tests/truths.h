/* What the truths share: vectors in double, and what they shade. */
#ifndef TRUTHS_H
#define TRUTHS_H

#include "harness.h"
#include "reference.h"

#include <math.h>

#define PI 3.14159265358979323846

typedef struct { double x, y, z; } vec;

static inline double dot(vec a, vec b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
static inline vec plus(vec a, vec b) { return (vec){ a.x + b.x, a.y + b.y, a.z + b.z }; }
static inline vec scaled(vec a, double s) { return (vec){ a.x * s, a.y * s, a.z * s }; }
static inline vec unit(vec a) { return scaled(a, 1 / sqrt(dot(a, a))); }
static inline vec unit_of(const float *a) { return unit((vec){ a[0], a[1], a[2] }); }
static inline vec across(vec a, vec b)
{
    return (vec){ a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x };
}

static inline void store(float *to, vec a) { to[0] = (float)a.x, to[1] = (float)a.y, to[2] = (float)a.z; }

/* Fresnel one. */
static inline facet_material specular_material(facet_distribution distribution, facet_masking masking)
{
    return (facet_material){ .specular = { .model = distribution, .masking = masking },
                             .fresnel.model = FACET_FRESNEL_ONE };
}

/* White, lit by 1, the normal along z and the tangent along x. */
static inline sample white(void)
{
    return (sample){ .n = { 0, 0, 1 }, .tangent = { 1, 0, 0 }, .albedo = { 1, 1, 1 }, .irradiance = { 1, 1, 1 } };
}

/* Of so many tries. */
static inline int some_of(int count) { return test_slow_machine ? (count + 15) / 16 : count; }

/* The second half of the suite: Fresnel's equations and light, of the reference and of the library. */
void check_media_and_light(void);

#endif
