#include "half.h"

#include <math.h>

uint16_t nearest_half(float x)
{
    const double a = x;
    if (a >= 65504) return 0x7bff;
    const int exponent = a < 0x1p-14 ? -14 : ilogb(a);
    const double units = ldexp(a, 10 - exponent), rest = units - floor(units);
    uint32_t bits = (uint32_t)units + ((uint32_t)(exponent + 14) << 10);
    if (rest > 0.5 || (rest == 0.5 && bits & 1)) bits++;
    return (uint16_t)bits;
}
