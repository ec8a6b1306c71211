/* What the charts show: speeds from `facet-bench --tsv`, a file a machine, and errors from tests/model_errors.c. */
#ifndef CHART_DATA_H
#define CHART_DATA_H

#include <stdbool.h>

typedef struct kernel_row {
    const char *kernel, *tier, *arch;    /* tier "baseline": arch is the baseline's name */
    const char *size, *layout, *bound_by;
    double ns, spread, cycles, bytes;
    double x_literal, x_256, x_512;
    double fraction, error, p999;        /* NaN: unknown; error may be infinite */
    bool charted;                        /* the one of its kernel, tier and arch that stands in charts */
} kernel_row;

typedef struct peak {
    const char *name, *unit;
    double value;
} peak;

typedef struct machine {
    const char *path;
    const char *date, *cpu, *compiler, *command;
    char name[256];              /* the CPU's, and what else tells it from the other machines */
    kernel_row *rows;
    int count;
    peak *peaks;
    int peak_count;
} machine;

/* Models of one truth, and how far each is from it. */
typedef struct model {
    const char *kernel, *tier;   /* what it is timed as; tier NULL: any */
    const char *label;
    double worst, mean;
} model;

typedef struct ladder {
    const char *name, *title, *truth, *stated;
    model *models;
    int count;
} ladder;

/* Errors along x of a textbook's form and of facet's. */
typedef struct failure_point {
    double x, textbook, lost, facet;
} failure_point;

typedef struct failure_panel {
    const char *name, *title, *x, *stated;
    failure_point *points;
    int count;
} failure_panel;

typedef struct chart_data {
    machine *machines;
    int machine_count;
    ladder *ladders;
    int ladder_count;
    failure_panel *panels;
    int panel_count;
} chart_data;

/* Each adds a file's content, or says what is wrong with it. */
bool chart_read_bench(chart_data *d, const char *path);
bool chart_read_errors(chart_data *d, const char *path);

/* Gives every machine a name that no other has. */
void chart_name_machines(chart_data *d);

/* Samples a second. */
double row_speed(const kernel_row *r);

bool is_baseline(const kernel_row *r);

/* Whether the row's case is what renderers do as a whole, and not one kernel. */
bool is_workload(const machine *m, const char *kernel);

/* The charted row, or NULL. */
const kernel_row *find_row(const machine *m, const char *kernel, const char *tier, const char *arch);

/* How many times as fast as the textbook the fastest of a workload is; NaN: unknown. */
double times_textbook(const machine *m, const char *kernel);

/* The charted row of facet's with the highest speed, of a tier (NULL: any), or NULL. */
const kernel_row *fastest_row(const machine *m, const char *kernel, const char *tier);

#endif
