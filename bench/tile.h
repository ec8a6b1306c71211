/* The workload that the library and the baselines are timed on: Oren-Nayar (A, B) + GGX + height-correlated Smith +
 * Schlick, everything per sample, one directional light. */
#ifndef TILE_H
#define TILE_H

#include <stddef.h>

typedef struct {
    size_t count;
    const float *normal[3], *view[3];    /* unit */
    const float *albedo[3], *sigma, *alpha, *f0[3];
    float light[3], irradiance[3];
    float *radiance[3];
} tile;

typedef void tile_shader(const tile *);

/* textbook.c: the shader as it stands in lecture slides. */
tile_shader tile_textbook;

/* autovectorized.c: branch-free plain C for a compiler's vectoriser, by each compiler that was there. */
tile_shader tile_clang_256, tile_clang_512, tile_gcc_256, tile_gcc_512;

#endif
