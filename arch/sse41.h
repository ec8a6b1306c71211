/* The vector layer, four lanes: SSE4.1, which is SSE2's with a blend. */
#ifndef FACET_ARCH_SSE41_H
#define FACET_ARCH_SSE41_H

#include <smmintrin.h>

#include "sse2.h"

/* 1.05 times as fast without in tile and plastic, 1.01 to 1.04 in the others. */
#undef VF_AHEAD
#define VF_AHEAD 0

#endif
