/* Errors that the tests have found: tests/accuracy.tsv, and what build/baseline-errors writes. */
#ifndef BENCH_ERRORS_H
#define BENCH_ERRORS_H

#include "bench_work.h"

/* Relative, where nl, nv > 5e-4 and alpha >= 0.01: the worst found; what 99.9 % of samples stay within. NAN where it is
 * not known. */
typedef struct { double worst, p999; } found_error;

/* Reads tables, given with commas. A file that is not there is left out, and said. False where one is malformed. */
bool errors_read(const char *files);

/* Of the library's tier on an architecture, or of a baseline by its name, `arch` being empty. */
found_error errors_of(const work *w, const char *who, const char *arch);

#endif
