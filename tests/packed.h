/* What facet_packed's formulas make of packed numbers. */
#ifndef PACKED_H
#define PACKED_H

#include "facet.h"

/* In float, in the kernels' order of operations, without fused ones: strict results of these floats are those of the
 * packed numbers. */
void unpack_normal(const int16_t packed[2], float n[3]);
void unpack_view(const facet_camera *, size_t i, float v[3]);
float unpack_unorm8(uint8_t byte);

/* In double. */
void exact_normal(const int16_t packed[2], double n[3]);
void exact_view(const facet_camera *, size_t i, double v[3]);

/* The packed suite's parts. */
void test_packed_mixes(void);        /* packed_mixes.c */
void test_packed_camera(void);       /* packed_camera.c */
void test_packed_bound(void);        /* packed_bound.c */
void test_packed_radiance(void);     /* packed_radiance.c */
void test_past_caches(void);         /* past_caches.c */

#endif
