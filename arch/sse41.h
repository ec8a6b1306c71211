/* The vector layer, four lanes: SSE4.1, which is SSE2's with a blend and a maximum of integers. */
#ifndef FACET_ARCH_SSE41_H
#define FACET_ARCH_SSE41_H

#include "sse2.h"

#endif
