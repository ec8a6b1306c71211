/* Speed by architecture: a row a workload. */
#include "chart.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static const char *first_of(const machine *m, int i)
{
    for (int k = 0; k < i; k++)
        if (!strcmp(m->rows[k].kernel, m->rows[i].kernel))
            return NULL;
    return m->rows[i].kernel;
}

/* The machine's workloads, or NULL; the caller frees them. */
static const char **workloads_of(const machine *m, int *count)
{
    const char **found = calloc((size_t)m->count + 1, sizeof *found);
    *count = 0;
    for (int i = 0; found && i < m->count; i++)
        if (first_of(m, i) && is_workload(m, m->rows[i].kernel))
            found[(*count)++] = m->rows[i].kernel;
    return found;
}

static range speeds_of(const chart_data *d)
{
    range x = { 0, 0 };
    for (int i = 0; i < d->machine_count; i++)
        for (int k = 0; k < d->machines[i].count; k++) {
            const kernel_row *r = &d->machines[i].rows[k];
            if (r->charted && is_workload(&d->machines[i], r->kernel))
                range_add(&x, row_speed(r));
        }
    return x;
}

/* ---- The message ----------------------------------------------------------------------------------------------- */

static int by_value(const void *a, const void *b)
{
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

/* The median over the workloads of time over time: of two targets; NaN where no workload has both. */
static double median_ratio(const machine *m, const char *arch, const char *tier, const char *other_arch,
                           const char *other_tier)
{
    int count, ratios = 0;
    const char **workloads = workloads_of(m, &count);
    double *ratio = calloc((size_t)count + 1, sizeof *ratio), median = NAN;
    for (int i = 0; workloads && ratio && i < count; i++) {
        const kernel_row *a = find_row(m, workloads[i], tier, arch);
        const kernel_row *b = find_row(m, workloads[i], other_tier, other_arch);
        if (a && b)
            ratio[ratios++] = b->ns / a->ns;
    }
    if (ratios) {
        qsort(ratio, (size_t)ratios, sizeof *ratio, by_value);
        median = ratio[ratios / 2];
    }
    free(ratio);
    free(workloads);
    return median;
}

/* The architecture that is the fastest on the first workload. */
static const char *best_arch(const machine *m)
{
    for (int i = 0; i < m->count; i++)
        if (is_workload(m, m->rows[i].kernel)) {
            const kernel_row *best = fastest_row(m, m->rows[i].kernel, NULL);
            if (best)
                return best->arch;
        }
    return NULL;
}

/* Of a machine: how many times as fast as scalar its best architecture is, and what strict costs there. */
typedef struct message {
    const char *best;
    double gain, price;
} message;

static message message_of(const machine *m)
{
    message a = { best_arch(m), NAN, NAN };
    if (a.best && strcmp(a.best, "scalar"))
        a.gain = median_ratio(m, a.best, "fast", "scalar", "fast");
    if (a.best)
        a.price = fmax(0, median_ratio(m, a.best, "fast", a.best, "strict") - 1);
    return a;
}

static void say_one(message a, char *text, size_t size)
{
    *text = 0;
    if (!isnan(a.gain))
        snprintf(text, size, "%s is %s times as fast as scalar", a.best, format_times(a.gain));
    const size_t used = strlen(text);
    if (!isnan(a.price))
        snprintf(text + used, size - used, "%sthe same bytes everywhere cost %.0f %% on %s", used ? "; " : "",
                 100 * a.price, a.best);
}

static void say_all(const chart_data *d, char *text, size_t size)
{
    range gains = { 0, 0 };
    double dearest = NAN;
    for (int i = 0; i < d->machine_count; i++) {
        const message a = message_of(&d->machines[i]);
        range_add(&gains, a.gain);
        dearest = fmax(dearest, a.price);
    }
    *text = 0;
    if (gains.most > 0)
        snprintf(text, size, "SIMD is %s to %s times as fast as scalar code on %d machines", format_times(gains.least),
                 format_times(gains.most), d->machine_count);
    const size_t used = strlen(text);
    if (used && !isnan(dearest))
        snprintf(text + used, size - used, "; the same bytes everywhere cost at most %.0f %%", 100 * dearest);
}

/* ---- Rows ------------------------------------------------------------------------------------------------------ */

/* How many times the textbook's speed the best has, beside its mark. */
static void say_gain(const machine *m, const char *workload, char *text, size_t size)
{
    const kernel_row *best = fastest_row(m, workload, NULL);
    const double times = times_textbook(m, workload);
    *text = 0;
    if (best)
        snprintf(text, size, "%s/s", format_rate(row_speed(best)));
    if (!isnan(times))
        snprintf(text + strlen(text), size - strlen(text), ", %s\303\227 textbook", format_times(times));
}

/* Facet's marks stand on the row's line, the baselines' below it. */
static double lane(const svg *s, const kernel_row *r, double y)
{
    return is_baseline(r) ? y + 0.85 * s->size : y;
}

static void draw_row(svg *s, const machine *m, const char *workload, const axis *x, double y)
{
    range reach = { 0, 0 };
    for (int i = 0; i < m->count; i++)
        if (m->rows[i].charted && !is_baseline(&m->rows[i]) && !strcmp(m->rows[i].kernel, workload))
            range_add(&reach, row_speed(&m->rows[i]));
    if (reach.most > 0)
        svg_line(s, "span", axis_at(x, reach.least), y, axis_at(x, reach.most), y);
    for (int i = 0; i < m->count; i++) {
        const kernel_row *r = &m->rows[i];
        char id[512], tip[1024];
        if (!r->charted || strcmp(r->kernel, workload))
            continue;
        svg_mark(s, tier_shape(r), arch_class(r), axis_at(x, row_speed(r)), lane(s, r, y),
                 tier_shape(r) == SVG_SQUARE ? 6.5 : 5.5, row_id(r, id, sizeof id), row_tip(m, r, tip, sizeof tip));
    }
}

/* The names of the architectures above a row's marks, of the baselines below. */
static void draw_names(svg *s, const machine *m, const char *workload, const axis *x, double y, bool baselines)
{
    label *labels = calloc((size_t)m->count + 1, sizeof *labels);
    int count = 0;
    for (int i = 0; labels && i < m->count; i++) {
        const kernel_row *r = &m->rows[i];
        if (!r->charted || strcmp(r->kernel, workload) || is_baseline(r) != baselines || !strcmp(r->tier, "strict"))
            continue;
        const bool literal = baselines && !strcmp(r->arch, "literal");
        labels[count++] = (label){ .x = axis_at(x, row_speed(r)), .y = lane(s, r, y), .radius = 6,
                                   .more = literal ? "textbook" : r->arch, .size = 0.93 * s->size,
                                   .widest = 200 };
    }
    labels_spread(labels, count, baselines ? y + 1.9 * s->size : y - 2.3 * s->size,
                  (box){ chart_left(s), 0, chart_right(s) - chart_left(s), 0 });
    labels_draw(s, labels, count);
    free(labels);
}

static void draw_ticks(svg *s, const axis *x, double top, double bottom)
{
    double ticks[MOST_TICKS];
    const int count = axis_ticks(x, 3.6 * s->size, ticks);
    for (int i = 0; i < count; i++) {
        const double at = axis_at(x, ticks[i]);
        svg_line(s, "grid", at, top, at, bottom);
        svg_text(s, at, bottom + 1.4 * s->size, "muted", s->size, "middle", format_rate(ticks[i]));
    }
}

static void draw_machine(svg *s, const machine *m, range speeds)
{
    int count;
    const char **workloads = workloads_of(m, &count);
    const double left = chart_left(s), right = chart_right(s), high = (s->narrow ? 4.4 : 3.1) * s->size;
    const axis x = axis_over(speeds, left + (s->narrow ? 0 : 80), right - (s->narrow ? 0 : 150));
    const double names = 2.4 * s->size, top = s->height, bottom = top + 2 * names + high * count;
    draw_ticks(s, &x, top, bottom);
    for (int i = 0; workloads && i < count; i++) {
        /* Around the first row there is room for names. */
        const double y = top + names + high * (i + (s->narrow ? 0.6 : 0.35)) + (i ? names : 0);
        const double beside = s->narrow ? y - (i ? 1.1 : 3) * s->size : y + 0.35 * s->size;
        char gain[128];
        say_gain(m, workloads[i], gain, sizeof gain);
        draw_row(s, m, workloads[i], &x, y);
        if (!i) {
            draw_names(s, m, workloads[i], &x, y, false);
            draw_names(s, m, workloads[i], &x, y, true);
        }
        svg_text(s, left, beside, "strong halo", s->size, "start", workloads[i]);
        svg_text(s, right, beside, "muted halo", s->size, "end", gain);
    }
    svg_text(s, right, bottom + 2.9 * s->size, "muted", s->size, "end", FASTER);
    s->height = bottom + 3.6 * s->size;
    free(workloads);
}

bool draw_arches(svg *s, const chart_data *d)
{
    const range speeds = speeds_of(d);
    char title[400];
    if (speeds.most == 0)
        return false;
    if (d->machine_count == 1)
        say_one(message_of(&d->machines[0]), title, sizeof title);
    else
        say_all(d, title, sizeof title);
    chart_head(s, *title ? title : "Speed by architecture",
               "Every workload on every architecture that the CPU has, on one core. On the right the best of facet, "
               "beside the textbook\342\200\231s shader.");
    chart_keys(s, (key[]){ { SVG_DISC, "other", "facet, fast" }, { SVG_SQUARE, "other", "facet, strict" },
                           { SVG_DIAMOND, "baseline", "without facet" } }, 3);
    for (int i = 0; i < d->machine_count; i++) {
        char said[400];
        say_one(message_of(&d->machines[i]), said, sizeof said);
        if (d->machine_count > 1)
            chart_part(s, chart_left(s), chart_right(s) - chart_left(s), d->machines[i].name, said);
        draw_machine(s, &d->machines[i], speeds);
    }
    chart_source(s, d);
    return true;
}
