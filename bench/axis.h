/* Logarithmic axes and how their numbers are written. */
#ifndef AXIS_H
#define AXIS_H

#include <stdbool.h>
#include <stddef.h>

/* What the axis must hold; starts as zero: nothing. Only finite numbers above 0 count. */
typedef struct range {
    double least, most;
} range;

void range_add(range *r, double value);

/* `least` is drawn at `from`, `most` at `to`. */
typedef struct axis {
    double least, most, from, to;
} axis;

/* With some room at both ends; at least a factor of 4 long. */
axis axis_over(range r, double from, double to);

double axis_at(const axis *a, double value);

/* 1, 2 and 5 of every decade; what keeps that far apart where they are too many, more where they are too few. */
enum { MOST_TICKS = 40 };
int axis_ticks(const axis *a, double apart, double ticks[MOST_TICKS]);

/* How numbers are written, to be shown: a text that lasts until eight more were asked for. */
typedef const char *number_format(double value);
number_format format_rate;       /* "541 M": of samples a second */
number_format format_rate_in_words;      /* "541 million" */
number_format format_error;      /* "2.6e-4" */
number_format format_percent;    /* "62 %", and below 0.01 % as an error */
number_format format_times;      /* "76", "1.3": a factor */
number_format format_plain;      /* "0.001", or "1e-6" where that is shorter */

#endif
