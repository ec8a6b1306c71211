/* What a person reads. */
#ifndef BENCH_REPORT_H
#define BENCH_REPORT_H

#include "bench_results.h"

/* Prints the machine, the workloads one by one, each of them by size and layout, and the kernels of the table. `r` has
 * a row for each of `c`. */
void report_print(const contenders *c, const results *r);

#endif
