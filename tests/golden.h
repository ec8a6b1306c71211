/* Samples that are the same on every machine. */
#ifndef GOLDEN_H
#define GOLDEN_H

#include "harness.h"
#include "reference.h"

/* Made by integer arithmetic alone: directions of unit length within rounding, around each other in every way; alpha
 * over many powers of two; and with `edges` now and then a value that is 0, subnormal, negative, large or not
 * finite. */
sample golden_sample(test_random *, bool edges);

#endif
