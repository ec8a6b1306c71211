/* The table of kernels: what the Makefile built (FACET_ARCH_name, FACET_TIER_name). */
#include "internal.h"

#define FACET_ARCH(id, name, word, needs, lanes) kernel facet_f32_##name##_fast, facet_f32_##name##_strict;
#include "arches.def"

#define IF_BUILT(name, tier)                                                                                          \
    FACET_BUILT(FACET_ARCH_##name) && FACET_BUILT(FACET_TIER_##tier) ? facet_f32_##name##_##tier : 0

static kernel *const kernels[ARCH_COUNT][TIER_COUNT] = {
#define FACET_ARCH(id, name, word, needs, lanes) [FACET_ARCH_##id] = { IF_BUILT(name, fast), IF_BUILT(name, strict) },
#include "arches.def"
};

kernel *facet_kernel(facet_arch arch, facet_tier tier)
{
    return kernels[arch][tier];
}
