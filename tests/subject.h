/* What a stability test is run on, how it shades there, and what it may expect. Whatever a test is about, each radiance
 * that it sees must be finite and not below +0. */
#ifndef SUBJECT_H
#define SUBJECT_H

#include "bounds.h"
#include "samples.h"

typedef struct {
    facet_target target;
    const kernel_case *kernel;
    const error_bound *bound;
} subject;

/* A test that is run on every subject. */
typedef struct { const char *name; void (*run)(const subject *); } trap;

/* What a call brings beside the samples; zero is the plain case. */
typedef struct {
    float emission[3], ambient[3], sh[4][3];
    const float *visibility, *occlusion;
    const uint8_t *coverage;
    uint32_t flags;
    bool sun;                    /* one light for all in place of the samples' own */
    bool uncounted;              /* nobody asks how many are invalid */
} extras;

typedef float rgb[3];

/* Shades at most MOST samples, with the kernel's models or with a material; `x` may be NULL. Returns how many samples
 * were counted as invalid. With FACET_ACCUMULATE, onto what is in `out`. Does so twice, alone and in the middle of
 * other samples, and expects the same bytes. The light is the one that a sample has, or a directional one. A material
 * of another convention that promises sources has the samples' albedo as base, f0 x as metallic, f0 y as
 * specular_level, alpha as roughness and as glossiness. */
enum { MOST = 64 };
size_t shade(const subject *u, const extras *x, const sample *s, int count, rgb *out);
size_t shade_material(const subject *u, const facet_material *m, const extras *x, const sample *s, int count, rgb *out);

/* The kernel's models, with all that they read in streams. */
facet_material streaming_material(const subject *u);
bool has_specular(const subject *u);
bool has_diffuse(const subject *u);

/* Generic samples, about which nothing is special; a sample with these vectors. */
void ordinary(const subject *u, sample *s, int count);
sample with_vectors(const float *n, const float *v, const float *l);
void negate(float *vector);

/* The same bytes; all channels this value, or one in [least, most]. */
void expect_same(const subject *u, const rgb *a, const rgb *b, int count, const char *what);
void expect_all(const subject *u, const rgb *radiance, int count, float value);
void expect_within(const subject *u, const rgb *radiance, int count, float least, float most);

/* Shades beside an emission of 1, and expects that nothing is added to it: not a light, and not what is no number. */
void expect_dark(const subject *u, const sample *s, int count);

/* Shades, and compares with the reference. `exact`: the cosines are sums without rounding, so that a small nl costs
 * nothing. */
void expect_reference(const subject *u, const sample *s, int count, bool exact);

#endif
