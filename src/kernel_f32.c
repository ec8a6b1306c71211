/* One architecture's float kernel in one tier. The Makefile compiles this file once for each, with
 * FACET_ARCH_HEADER: the vector layer; FACET_STRICT: 1 or 0, which the vector layer's vf_mad obeys;
 * FACET_KERNEL: the function's name. */
#define KERNEL FACET_KERNEL
#include FACET_ARCH_HEADER

#include "internal.h"

kernel KERNEL;

#include "shade.tmpl.h"
