/* The benchmark's command line. */
#ifndef BENCH_OPTIONS_H
#define BENCH_OPTIONS_H

#include "bench_streams.h"

typedef struct {
    const char *filter, *tsv, *old, *fresh;      /* old: a table to compare with; fresh: what is compared, or NULL */
    const char *errors;                          /* tables of errors, with commas */
    int arch;                                    /* facet_arch, or -1: all */
    unsigned sizes;                              /* a bit for each of SIZE_*; 0: the default */
    float seconds;
    bool all, help;
} bench_options;

/* Fills *o from the defaults and the command line. Says what is wrong. */
bool bench_options_read(bench_options *o, int count, char **arguments);

void bench_options_help(void);

#endif
