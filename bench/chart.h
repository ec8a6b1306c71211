/* The charts: each draws itself into an SVG, wide or narrow, below what is there. */
#ifndef CHART_H
#define CHART_H

#include "axis.h"
#include "chart_data.h"
#include "labels.h"
#include "svg.h"

#define COUNT(array) ((int)(sizeof array / sizeof array[0]))

/* A chart has a name, the file's; `draw` returns false where the data has nothing to show. */
typedef struct chart {
    const char *name;
    bool (*draw)(svg *s, const chart_data *d);
} chart;

bool draw_rounding(svg *s, const chart_data *d);     /* one workload on every architecture, and its baselines */
bool draw_kernels(svg *s, const chart_data *d);      /* every kernel */
bool draw_models(svg *s, const chart_data *d);       /* models against richer ones */
bool draw_arches(svg *s, const chart_data *d);       /* every workload by architecture */
bool draw_failures(svg *s, const chart_data *d);     /* where a textbook's forms fail */

/* ---- What charts have in common (chart_parts.c) ---------------------------------------------------------------- */

#define FASTER        "samples a second, one core \342\206\222 faster"
#define MORE_ACCURATE "\342\206\221 more accurate: worst relative error"
#define THE_FRONT     "Dotted: the front, which nothing beats in both."

/* The title, which is the message, and what is shown. */
void chart_head(svg *s, const char *title, const char *shown);

/* What the shapes mean, in a line. */
typedef struct key {
    svg_shape shape;
    const char *class, *text;
} key;
void chart_keys(svg *s, const key *keys, int count);

/* The colours of the architectures that the machines have. */
void chart_arch_keys(svg *s, const chart_data *d);

/* Where the speeds are from: a line a machine. */
void chart_source(svg *s, const chart_data *d);

/* A heading above a part of the chart, with what it says in ordinary weight; moves s->height below. */
void chart_part(svg *s, double x, double width, const char *name, const char *more);

/* The name of one machine of several, as such a heading. */
void chart_machine(svg *s, const chart_data *d, const machine *m);

/* Left of what is drawn, right of it. */
double chart_left(const svg *s);
double chart_right(const svg *s);

/* The class of svg_style that has an architecture's colour; the tier's shape. */
const char *arch_class(const kernel_row *r);
svg_shape tier_shape(const kernel_row *r);

/* "avx512 fast"; a baseline's name in words. */
const char *target_name(const kernel_row *r, char *text, size_t size);

/* All numbers of a row, in lines; "CASE TIER ARCH". */
const char *row_tip(const machine *m, const kernel_row *r, char *text, size_t size);
const char *row_id(const kernel_row *r, char *text, size_t size);

/* ---- Speed against accuracy (chart_scatter.c) ------------------------------------------------------------------ */

typedef struct mark {
    const machine *machine;
    const kernel_row *row;
    double x, y;                 /* y: an error; may be 0, infinite, NaN */
    double whisker;              /* of y, to here; NaN: none */
    double radius;
    bool faint;
    char label[128], more[128];  /* empty: none */
    char note[128];              /* what its tip says first; empty: nothing */
    int rank;                    /* of the label */
    bool one_line;               /* the label is */
    bool on_front;
} mark;

typedef struct scatter {
    mark *marks;
    int count;
    const char *x_title, *y_title;
    number_format *y_format;
    range x, y;                  /* what the axes hold beside the marks */
    bool spans;                  /* a bar above the plot for every architecture, from its slowest mark to its fastest */
    double height;               /* of the plot */
    double room;                 /* right of the fastest, for names */
    bool stacked;                /* names stand above, in a stack */
} scatter;

mark *scatter_add(scatter *p, const machine *m, const kernel_row *r, double y);

/* Marks those that no other mark beats in both. */
void scatter_front(scatter *p);

/* Draws it from x to x + width below s->height, which it moves. */
void scatter_draw(svg *s, scatter *p, double x, double width);
void scatter_free(scatter *p);

/* ---- The page -------------------------------------------------------------------------------------------------- */

/* One drawing, twice. */
typedef struct drawing {
    const char *name;
    svg wide, narrow;
} drawing;

/* A page that needs no other file. */
void page_write(FILE *to, const drawing *drawings, int count, const chart_data *d);

#endif
