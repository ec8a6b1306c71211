/* Texts beside the points that they name, so that none covers another. */
#ifndef LABELS_H
#define LABELS_H

#include "svg.h"

typedef struct box {
    double x, y, width, height;  /* x, y: the upper left corner */
} box;

enum { LABEL_LINES = 4 };

typedef struct label {
    double x, y, radius;         /* the point, and how far from it the text starts */
    const char *name, *more;     /* bold, or NULL; ordinary, or NULL */
    bool one_line;               /* more stands behind the name, not below it */
    double size, widest;         /* lines break at this width */
    int rank;                    /* those of a lower rank choose first */
    bool placed;
    box at;
} label;

/* Places what has room within `bounds`: clear of all other labels, and of `marks` as far as may be. Returns how
 * many. */
int labels_place(label *labels, int count, const box *marks, int mark_count, box bounds);

/* Places all in one row at y, each as near above its point as the others let it; sorts them. */
void labels_spread(label *labels, int count, double y, box bounds);

/* Places all in a stack that ends above y, a row each: that of the rightmost point at the top, so that a line down from
 * the end of each crosses none. Sorts them; returns the height. */
double labels_stack(label *labels, int count, double y, box bounds);

/* Draws what was placed, with a line to a point that is far away. */
void labels_draw(svg *s, const label *labels, int count);

#endif
