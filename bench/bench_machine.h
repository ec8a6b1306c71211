/* What the machine does at best, measured in the same run as the kernels, and the bound that follows for a workload. */
#ifndef BENCH_MACHINE_H
#define BENCH_MACHINE_H

#include "bench_streams.h"
#include "bench_work.h"

/* What bounds: the multipliers or the adders; the divider, by divisions or by square roots; loads; stores; the copy
 * from and to the memory that holds the streams. */
typedef enum { BY_FMA, BY_DIVIDE, BY_SQRT, BY_LOAD, BY_STORE, BY_MEMORY, BOUNDS } bound_by;
extern const char *const bound_words[BOUNDS];

/* Multiplications that save the divider a quotient, over a common denominator, or a root, by an estimate and one Newton
 * step. */
enum { BOUND_QUOTIENT = 2, BOUND_ROOT = 5 };

/* Decides how long a measurement takes; `memory` for copies that no cache holds. False where memory ends. */
bool machine_start(bool memory);

/* Measures all but the copies that no cache holds, or these alone. */
void machine_measure(void);
void machine_measure_memory(void);

/* The clock alone, cycles a nanosecond. */
double machine_clock(void);

/* Nanoseconds that a sample of the workload takes at least on the vectors of `arch`, by what was last measured; NAN
 * where that is unknown. */
double machine_bound(const work *w, facet_arch arch, int size, bound_by *by);

/* The last architecture of this CPU with vectors of that many bits, or FACET_ARCH_BEST. */
facet_arch machine_arch(int bits);

/* What was measured, one by one, as the median of all rounds. False past the last. */
typedef struct {
    char name[32];               /* "fma_avx512", "copy_l2", "clock" */
    double value;
    const char *unit;            /* "lanes/s", "bytes/s", "cycles/s" */
} machine_peak;
bool machine_peak_at(int index, machine_peak *peak);

/* One of them by its name; NAN where it was not measured. */
double machine_peak_of(const char *name);

#endif
