/* What was measured round by round. */
#ifndef BENCH_SERIES_H
#define BENCH_SERIES_H

typedef struct {
    float *values;
    int count, room;
} series;

/* Ends the program where memory ends. */
void series_add(series *s, double value);

/* The quantile, q in [0, 1], of what is finite; NAN where nothing is. */
double series_quantile(const series *s, double q);
double series_median(const series *s);

/* Half the distance between the quartiles, over the median. */
double series_spread(const series *s);

/* The median of a/b, round by round. */
double series_ratio(const series *a, const series *b);

#endif
