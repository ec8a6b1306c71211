/* IEEE 754 binary16. */
#ifndef HALF_H
#define HALF_H

#include <stdint.h>

/* The bits of the one nearest to x >= 0, ties to even; at most 65504. */
uint16_t nearest_half(float x);

#endif
