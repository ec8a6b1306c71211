/* Which architectures this build has and this CPU runs, as bits: 1u << FACET_ARCH_*. */
#ifndef FACET_CPU_H
#define FACET_CPU_H

#include "internal.h"

/* In this build. */
enum {
    ARCHES_BUILT = 0
#define FACET_ARCH(id, name, word, needs, lanes) | FACET_BUILT(FACET_ARCH_##name) << FACET_ARCH_##id
#include "arches.def"
};

/* Those of `among` that are in this build and run on this CPU, which is asked for no more than these need. */
uint32_t facet_arches_among(uint32_t among);

/* The best of these; FACET_ARCH_BEST of none. */
facet_arch facet_arch_best_of(uint32_t arches);

#endif
