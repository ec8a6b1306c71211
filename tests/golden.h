/* Samples that are the same on every machine. */
#ifndef GOLDEN_H
#define GOLDEN_H

#include "harness.h"
#include "reference.h"

/* Made by integer arithmetic alone: directions of unit length within rounding, around each other in every way, the
 * tangent across n; alpha, alpha_y and the exponent over many powers of two; eta often near 1, k often 0; and with
 * `edges` now and then a value that is 0, subnormal, negative, large or not finite. Under no light of its own. */
sample golden_sample(test_random *, bool edges);

#endif
