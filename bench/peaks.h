/* What an architecture's vectors reach at best, one operation at a time. */
#ifndef PEAKS_H
#define PEAKS_H

#include <stdbool.h>
#include <stddef.h>

/* Of a lane: a * b + c where the architecture has it in one, else a * b; additions; divisions and square roots, as
 * instructions; loads and stores in L1. And a clock: additions that wait for each other, one a cycle. */
enum { PEAK_FMA, PEAK_ADD, PEAK_DIVIDE, PEAK_SQRT, PEAK_LOAD, PEAK_STORE, PEAK_CLOCK, PEAK_COUNT };

enum { PEAK_VECTORS = 96, PEAK_OPERATIONS = 384 };       /* vectors of a buffer; operations of a pass */

/* bench/peaks_arch.c, compiled for each architecture. */
typedef struct {
    const char *arch;
    int lanes;
    bool fused;
    void (*run[PEAK_COUNT])(long passes);
    void (*copy)(void *to, const void *from, size_t bytes);      /* whole vectors */
} peak_table;

#endif
