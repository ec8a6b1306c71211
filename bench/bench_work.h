/* What is timed: the workloads by name, which the baselines have too, and every kernel of tests/cases.c. */
#ifndef BENCH_WORK_H
#define BENCH_WORK_H

#include "baseline.h"
#include "bench_streams.h"

/* Operations of a sample: multiplications alone and with an addition, additions alone, divisions, square roots. */
typedef struct {
    int multiply, multiply_add, add, divide, sqrt;
} operations;

typedef struct work {
    const char *name, *title;    /* no title: a kernel of tests/cases.c */
    const char *kernel;          /* the one there whose errors are these where none were measured, or NULL */
    facet_material material;
    const facet_light *lights;
    size_t light_count;
    uint32_t streams;            /* FACET_STREAM_*: what comes per sample, in floats */
    stream_format format;        /* or comes packed, and how radiance goes */
    bool frame;                  /* of SIZE_MEMORY alone, where it is tile */
    int shade;                   /* SHADE_* of the baselines, or -1 */
    const char *beside;          /* what it is compared with instead of baselines: a workload, on the same target */
    operations operations;       /* of a workload */
} work;

/* The workloads, then the kernels that this build holds. */
int work_count(void);
const work *work_at(int index);

/* Bytes that a sample reads and writes. */
int work_reads(const work *w);
int work_writes(const work *w);

#endif
