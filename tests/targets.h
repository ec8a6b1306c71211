/* The targets that tests walk: every architecture and tier that this build holds and this CPU runs, asked once. */
#ifndef TARGETS_H
#define TARGETS_H

#include "facet.h"

int target_count(void);
facet_target target_at(int index);

/* "avx2 strict". A constant string until the next call. */
const char *target_words(facet_target target);

/* Whether this build holds every model: a filtered one has fewer kernels. */
bool whole_build(void);

/* A skipped test for every architecture that this build holds and this CPU lacks. */
void skip_absent_targets(void);

#endif
