/* Who is timed: each work on each size and layout, shaded by the library's architectures and tiers, and by the
 * baselines. */
#ifndef BENCH_CONTENDERS_H
#define BENCH_CONTENDERS_H

#include "bench_options.h"
#include "bench_series.h"
#include "bench_work.h"

typedef struct {
    const work *work;
    int size;
    layout layout;
    facet_target target;         /* of the library */
    const baseline *baseline;    /* or not the library */
    facet_plan plan;
    facet_batch batch;
    size_t parts, part;          /* a call shades one of these parts of the samples, the next one each time */
    long calls;                  /* a visit */
    series ns, cycles, fraction; /* a sample, by round; of the bound */
} contender;

/* Contenders of the same work, size and layout stand together. */
typedef struct {
    contender *all;
    int count;
} contenders;

/* Says what is wrong. */
bool contenders_list(contenders *c, const bench_options *o);

/* How many stand together from the one at `first` on. */
int contenders_group(const contenders *c, int first);

/* Calls it; the time of one visit, seconds. */
double contender_visit(contender *c);

/* Baselines that were not built, and why; "" where all were. */
const char *contenders_skipped(void);

#endif
