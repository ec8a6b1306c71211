#include "harness.h"

uint64_t random_u64(test_random *r)
{
    uint64_t z = r->state += 0x9e3779b97f4a7c15u;
    z = (z ^ z >> 30) * 0xbf58476d1ce4e5b9u;
    z = (z ^ z >> 27) * 0x94d049bb133111ebu;
    return z ^ z >> 31;
}

double random_unit(test_random *r)
{
    return (double)(random_u64(r) >> 11) * 0x1p-53;
}
