#include "axis.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

void range_add(range *r, double value)
{
    if (!(value > 0 && value < INFINITY))
        return;
    r->least = r->most > 0 ? fmin(r->least, value) : value;
    r->most = fmax(r->most, value);
}

axis axis_over(range r, double from, double to)
{
    if (r.most == 0)
        r = (range){ 1, 1 };
    const double length = log10(r.most / r.least), wanted = fmax(1.12 * length, log10(4));
    const double around = pow(10, (wanted - length) / 2);
    return (axis){ r.least / around, r.most * around, from, to };
}

double axis_at(const axis *a, double value)
{
    return a->from + (a->to - a->from) * log(value / a->least) / log(a->most / a->least);
}

static int collect(const axis *a, int decades, const double *digits, int count, double ticks[MOST_TICKS])
{
    int found = 0;
    const int first = (int)floor(log10(a->least)), last = (int)ceil(log10(a->most));
    for (int e = first; e <= last; e++)
        for (int i = 0; i < count; i++) {
            const double value = digits[i] * pow(10, e);
            if (e % decades == 0 && value >= a->least && value <= a->most && found < MOST_TICKS)
                ticks[found++] = value;
        }
    return found;
}

int axis_ticks(const axis *a, double apart, double ticks[MOST_TICKS])
{
    static const double digits[] = { 1, 2, 5 }, few[] = { 1, 3 }, fine[] = { 1, 1.5, 2, 3, 4, 5, 7 };
    const double decade = fabs(a->to - a->from) / log10(a->most / a->least);
    int decades = 1;
    while (decades * decade < apart)
        decades++;
    if (0.47 * decade < apart)
        return collect(a, decades, digits, 1, ticks);
    if (0.3 * decade < apart)
        return collect(a, 1, few, 2, ticks);
    const int found = collect(a, 1, digits, 3, ticks);
    /* Less than three tell little. */
    return found < 3 && 0.12 * decade >= apart ? collect(a, 1, fine, 7, ticks) : found;
}

/* ---- Numbers --------------------------------------------------------------------------------------------------- */

enum { SLOTS = 8, LONG = 48 };

static char *slot(void)
{
    static char slots[SLOTS][LONG];
    static int next;
    return slots[next++ % SLOTS];
}

/* Without zeros behind the point. */
static const char *shortest(double value, const char *unit)
{
    char *text = slot();
    snprintf(text, LONG, "%.3g%s", value, unit);
    return text;
}

const char *format_rate(double value)
{
    static const struct { double scale; const char *unit; } units[] = { { 1e9, " G" }, { 1e6, " M" }, { 1e3, " k" } };
    for (size_t i = 0; i < sizeof units / sizeof units[0]; i++)
        if (value >= 0.9995 * units[i].scale)
            return shortest(value / units[i].scale, units[i].unit);
    return shortest(value, "");
}

const char *format_rate_in_words(double value)
{
    char *text = slot();
    snprintf(text, LONG, "%.3g %s", value / (value >= 1e9 ? 1e9 : 1e6), value >= 1e9 ? "billion" : "million");
    return text;
}

const char *format_error(double value)
{
    if (isnan(value))
        return "not known";
    if (isinf(value))
        return "NaN or infinite";
    if (value == 0)
        return "0";
    if (value >= 0.0995)
        return shortest(value, "");
    char *text = slot(), *exponent;
    snprintf(text, LONG, "%.1e", value);
    exponent = strchr(text, 'e') + 1;
    char *mantissa_end = exponent - 1;
    const int power = atoi(exponent);
    if (mantissa_end[-1] == '0')
        mantissa_end -= 2;
    snprintf(mantissa_end, 16, "e%d", power);
    return text;
}

const char *format_percent(double value)
{
    if (isnan(value))
        return "not known";
    /* No one reads 0.00005 %. */
    if (value < 0.995e-4)
        return format_error(value);
    char *text = slot();
    snprintf(text, LONG, value < 0.995 ? "%.2g %%" : "%.0f %%", 100 * value);
    return text;
}

const char *format_times(double value)
{
    /* Two digits, but no exponent for three. */
    char *text = slot();
    snprintf(text, LONG, value >= 99.5 && value < 1e6 ? "%.0f" : "%.2g", value);
    return text;
}

const char *format_plain(double value)
{
    return value >= 1e-4 && value < 1e5 ? shortest(value, "") : format_error(value);
}
