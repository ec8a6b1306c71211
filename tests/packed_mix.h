/* Batches at random: what packed_mixes.c shades. */
#ifndef PACKED_MIX_H
#define PACKED_MIX_H

#include "harness.h"
#include "inputs.h"

enum { NORMALS, ALBEDO_ROUGHNESS, F0_SIGMA, PACKED };
enum { MOST = 1500, MOST_PACKED_LIGHTS = 3 };

#define ALBEDO_ROUGHNESS_STREAMS                                                                                      \
    ((uint32_t)(FACET_STREAM_ALBEDO | FACET_STREAM_BASE | FACET_STREAM_ALPHA | FACET_STREAM_ROUGHNESS                 \
                | FACET_STREAM_GLOSSINESS))
#define F0_SIGMA_STREAMS ((uint32_t)(FACET_STREAM_F0 | FACET_STREAM_SIGMA))

/* Models, and the streams that they read of the material. */
typedef struct { const char *name; facet_material models; uint32_t reads; float sigma_max; } model_set;

typedef struct {
    facet_target target;
    const model_set *set;
    size_t count;
    uint32_t promised, packed, uniform;          /* FACET_STREAM_*; what is neither packed nor uniform is per sample */
    bool has_view, halves, pixels, over_input, counted;
    facet_camera camera;
    facet_light lights[MOST_PACKED_LIGHTS];
    facet_batch common;                          /* lights, ambient, sh, flags, exposure */
    float values[LIGHT_AT][MOST], visibility[MOST];       /* what each sample has */
    uint8_t words[PACKED][4 * MOST], coverage[MOST / 8 + 1];
    bool covered_by_bits;
} mix;

void draw_mix(test_random *, mix *, facet_target);

/* Whether the batch has a float a sample of it. */
bool is_per_sample(const mix *, int stream);

uint64_t below(test_random *, uint64_t n);
bool one_in(test_random *, uint64_t n);

#endif
