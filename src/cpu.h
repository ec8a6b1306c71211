/* Which architectures this build has and this CPU runs. */
#ifndef FACET_CPU_H
#define FACET_CPU_H

#include "internal.h"

/* In this build, in either tier. */
static inline bool arch_built(facet_arch arch)
{
    return facet_kernel(arch, FACET_TIER_FAST) || facet_kernel(arch, FACET_TIER_STRICT);
}

/* In this build and on this CPU. */
bool facet_arch_runs(facet_arch arch);

#endif
