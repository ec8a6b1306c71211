/* What a run found, and tables of it. */
#ifndef BENCH_RESULTS_H
#define BENCH_RESULTS_H

#include "bench_contenders.h"

/* Vectors of that many bits have a column; where there are no others, the first is of 128. */
enum { FASTER_LITERAL, FASTER_256, FASTER_512, FASTER };

/* A row. What is not known is NAN or "-". */
typedef struct {
    char name[64], tier[16], arch[16], layout[16], bound_by[16];
    size_t size;
    double ns, spread, cycles, bytes;    /* of a sample */
    double faster[FASTER];               /* times as fast as that baseline */
    double faster_beside;                /* as the workload beside it; not in tables */
    double fraction, error, p999;
} result;

typedef struct {
    result *rows;
    int count;
} results;

/* A row for each contender, in their order. Ends the program where memory ends. */
results results_of(const contenders *c);

/* The baseline that a column compares with: of a group, the fastest of that width; or NULL. */
const contender *results_rival(const contender *first, int count, int column);

/* Writes all as a table, with what was measured of the machine; `command` is the command line. Reads the rows. Tells
 * whether a file can be written, and leaves what is in it. All say what is wrong. */
bool results_writable(const char *path);
bool results_write(const results *r, const char *path, const char *command);
bool results_read(results *r, const char *path);

/* Prints what is faster or slower in `fresh` by more than the rounds of both spread. */
void results_compare(const results *old, const results *fresh);

/* What the machine calls itself, and what built the library. */
void results_cpu(char *text, size_t size);
extern const char results_compiler[];

#endif
