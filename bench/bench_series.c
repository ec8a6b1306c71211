#include "bench_series.h"
#include "console.h"

#include <math.h>
#include <stdlib.h>

void series_add(series *s, double value)
{
    if (s->count == s->room) {
        const int room = s->room ? 2 * s->room : 64;
        float *values = realloc(s->values, (size_t)room * sizeof *values);
        if (!values) {
            console_error("not enough memory for what was measured");
            exit(EXIT_FAILURE);
        }
        s->values = values;
        s->room = room;
    }
    s->values[s->count++] = (float)value;
}

static int by_value(const void *a, const void *b)
{
    const float x = *(const float *)a, y = *(const float *)b;
    return (x > y) - (x < y);
}

double series_quantile(const series *s, double q)
{
    series finite = { 0 };
    for (int i = 0; i < s->count; i++)
        if (isfinite(s->values[i])) series_add(&finite, (double)s->values[i]);
    double result = NAN;
    if (finite.count) {
        qsort(finite.values, (size_t)finite.count, sizeof finite.values[0], by_value);
        const double at = q * (finite.count - 1);
        const int below = (int)at, above = below + 1 < finite.count ? below + 1 : below;
        const double part = at - below;
        result = (1 - part) * (double)finite.values[below] + part * (double)finite.values[above];
    }
    free(finite.values);
    return result;
}

double series_median(const series *s) { return series_quantile(s, 0.5); }

double series_spread(const series *s)
{
    return (series_quantile(s, 0.75) - series_quantile(s, 0.25)) / 2 / series_median(s);
}

double series_ratio(const series *a, const series *b)
{
    series ratios = { 0 };
    for (int i = 0; i < a->count && i < b->count; i++)
        series_add(&ratios, (double)a->values[i] / (double)b->values[i]);
    const double result = series_median(&ratios);
    free(ratios.values);
    return result;
}
