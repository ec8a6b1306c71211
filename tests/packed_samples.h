/* Random packed samples of the bench's tile under a light of each one's own, and what they reflect. */
#ifndef PACKED_SAMPLES_H
#define PACKED_SAMPLES_H

#include "samples.h"

enum { PACKED_SAMPLES = 1024 };

/* What packed numbers stand for. */
typedef struct {
    double n[3], v[3], l[3], albedo[3], sigma, alpha, f0[3], irradiance[3];
    bool usual;                          /* light and normal are uniform or in the lobe, not the worst that there are */
} exact_sample;

typedef struct {
    facet_camera camera;
    int16_t normal[2 * PACKED_SAMPLES];
    uint8_t albedo_roughness[4 * PACKED_SAMPLES], f0_sigma[4 * PACKED_SAMPLES];
    float l[3][PACKED_SAMPLES], irradiance[3][PACKED_SAMPLES], radiance[3][PACKED_SAMPLES];
    exact_sample exact[PACKED_SAMPLES];
} packed_samples;

/* From vectors in double. */
void exact_radiance(const exact_sample *, double radiance[3]);

/* In floats, for the reference; and back. */
sample rounded_sample(const exact_sample *);
exact_sample widened_sample(const sample *);

/* A pinhole's, 90 degrees wide and high, turned anyhow; the batch is a part of its picture. */
void draw_packed_samples(test_random *, packed_samples *);

/* Into floats. */
facet_status shade_packed_samples(const facet_plan *, packed_samples *);

#endif
