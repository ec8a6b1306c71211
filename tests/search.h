/* The search for a kernel's worst error: random samples, the lattice of edge values, then climbing from the worst. */
#ifndef SEARCH_H
#define SEARCH_H

#include "bounds.h"

/* A kernel on some architectures. */
typedef struct {
    facet_material material;
    facet_plan plans[8];
    facet_arch arches[8];
    int count;
} kernel_set;

/* The kernel on every architecture that runs here, or on the best one alone. */
kernel_set kernels_of(const kernel_case *kernel, facet_tier tier, bool best_alone);

/* The sample's worst error over magnitude, of all architectures and channels. */
typedef struct {
    double error, want;
    float got;
    facet_arch arch;
    int channel;
} measurement;

/* At most MOST_MEASURED samples, all under the kernel's light. */
enum { MOST_MEASURED = 1024 };
void measure(const kernel_set *set, const sample *samples, int count, measurement *results);

/* How often the search starts, each time with so many batches of random samples and generations of climbing. The first
 * start also has every `stride`th sample of the lattice and the table's witnesses, other kernels' too. */
typedef struct { int starts, batches, generations, stride; } search_effort;

/* The worst found of each goal, in the strict tier on the best architecture, else on all; `reached` is 0 where there is
 * none. */
void search_worst(const kernel_case *kernel, facet_tier tier, const error_bound *bound, search_effort effort,
                  witness found[GOALS]);

#endif
