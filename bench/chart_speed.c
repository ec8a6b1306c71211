/* Rounding error against speed: of one workload beside its baselines, and of every kernel. */
#include "chart.h"

#include <math.h>
#include <string.h>

/* Whether a row stands in the chart of one workload, or of every kernel (NULL). */
static bool belongs(const kernel_row *r, const char *workload)
{
    return r->charted && (workload ? !strcmp(r->kernel, workload) : !is_baseline(r));
}

/* What the axes hold: all machines, so that they are the same. */
static void find_ranges(const chart_data *d, const char *workload, range *x, range *y)
{
    *x = *y = (range){ 0, 0 };
    for (int i = 0; i < d->machine_count; i++)
        for (int k = 0; k < d->machines[i].count; k++) {
            const kernel_row *r = &d->machines[i].rows[k];
            if (!belongs(r, workload))
                continue;
            range_add(x, row_speed(r));
            range_add(y, r->error);
            if (workload)
                range_add(y, r->p999);
        }
}

/* A plot for every machine; `name` gives the marks their names. */
static void draw_plots(svg *s, const chart_data *d, const char *workload, const scatter *empty,
                       void (*name)(scatter *p, bool narrow))
{
    for (int i = 0; i < d->machine_count; i++) {
        const machine *m = &d->machines[i];
        scatter p = *empty;
        for (int k = 0; k < m->count; k++)
            if (belongs(&m->rows[k], workload))
                scatter_add(&p, m, &m->rows[k], m->rows[k].error);
        if (p.count) {
            scatter_front(&p);
            name(&p, s->narrow);
            chart_machine(s, d, m);
            scatter_draw(s, &p, chart_left(s), chart_right(s) - chart_left(s));
        }
        scatter_free(&p);
    }
}

/* ---- One workload ---------------------------------------------------------------------------------------------- */

/* The tile, or what else has a baseline, or anything. */
static const char *chosen_workload(const chart_data *d)
{
    const char *chosen = NULL;
    for (int i = 0; i < d->machine_count; i++)
        for (int k = 0; k < d->machines[i].count; k++) {
            const kernel_row *r = &d->machines[i].rows[k];
            if (!strcmp(r->kernel, "tile"))
                return r->kernel;
            if (!chosen && is_baseline(r))
                chosen = r->kernel;
        }
    return chosen ? chosen : d->machines[0].rows[0].kernel;
}

/* What is said of two errors. */
static void compare_errors(double ours, double theirs, char *text, size_t size)
{
    const double ratio = theirs / ours;
    *text = 0;
    if (isinf(theirs) && isfinite(ours))
        snprintf(text, size, ", and never NaN or infinite");
    else if (ratio >= 1.5)
        snprintf(text, size, ", and %s times as accurate", format_times(ratio));
    else if (ratio >= 1 / 1.5)
        snprintf(text, size, ", and as accurate");
    else if (ratio > 0)
        snprintf(text, size, ", with %s times its rounding error", format_times(1 / ratio));
}

static void title_of_one(const machine *m, const char *kernel, char *title, size_t size)
{
    const kernel_row *best = fastest_row(m, kernel, NULL), *literal = find_row(m, kernel, "baseline", "literal");
    char target[256], errors[128] = "";
    if (!best) {
        snprintf(title, size, "Speed and rounding error of \342\200\234%s\342\200\235", kernel);
        return;
    }
    target_name(best, target, sizeof target);
    if (literal)
        compare_errors(best->error, literal->error, errors, sizeof errors);
    if (isnan(times_textbook(m, kernel)))
        snprintf(title, size, "facet %s: %s samples a second, worst error %s", target,
                 format_rate_in_words(row_speed(best)), format_error(best->error));
    else
        snprintf(title, size, "facet %s: %s times as fast as the textbook\342\200\231s shader%s", target,
                 format_times(times_textbook(m, kernel)), errors);
}

static void title_of_many(const chart_data *d, const char *kernel, char *title, size_t size)
{
    range gains = { 0, 0 };
    for (int i = 0; i < d->machine_count; i++)
        range_add(&gains, times_textbook(&d->machines[i], kernel));
    if (gains.most > 0)
        snprintf(title, size, "facet: %s to %s times as fast as the textbook\342\200\231s shader, on %d machines",
                 format_times(gains.least), format_times(gains.most), d->machine_count);
    else
        snprintf(title, size, "Speed and rounding error of \342\200\234%s\342\200\235 on %d machines", kernel,
                 d->machine_count);
}

/* Names what is on the front with its numbers, the textbook, and where there is room other baselines with their speed
 * and each architecture once. */
static void label_target(mark *m, bool narrow)
{
    const char *rate = format_rate(m->x);
    char target[128];
    target_name(m->row, target, sizeof target);
    const bool baseline = is_baseline(m->row) && (!narrow || !strcmp(m->row->arch, "literal"));
    if (m->on_front || baseline) {
        snprintf(m->label, sizeof m->label, "%s", target);
        if (m->on_front || !narrow)
            snprintf(m->more, sizeof m->more, m->on_front ? "%s/s, %s" : "%s/s", rate, format_error(m->y));
        m->rank = m->on_front ? 0 : 1;
    } else if (!narrow && !strcmp(m->row->tier, "fast")) {
        snprintf(m->label, sizeof m->label, "%s", m->row->arch);
        m->rank = 2;
    }
}

static void name_targets(scatter *p, bool narrow)
{
    for (int i = 0; i < p->count; i++) {
        mark *m = &p->marks[i];
        m->whisker = m->row->p999;
        m->radius = narrow ? 5 : 6;
        label_target(m, narrow);
    }
}

bool draw_rounding(svg *s, const chart_data *d)
{
    const char *workload = chosen_workload(d);
    const bool many = d->machine_count > 1;
    char title[400], shown[400];
    scatter empty = { .x_title = FASTER, .y_title = MORE_ACCURATE, .y_format = format_error, .room = 70,
                      .height = many ? 260 : s->narrow ? 330 : 380 };
    find_ranges(d, workload, &empty.x, &empty.y);
    if (many)
        title_of_many(d, workload, title, sizeof title);
    else
        title_of_one(&d->machines[0], workload, title, sizeof title);
    snprintf(shown, sizeof shown, "The workload \342\200\234%s\342\200\235: the same formula from everybody. A mark is "
             "the worst error against double precision that was found; its line reaches to what 99.9 %% of samples "
             "keep. " THE_FRONT, workload);
    chart_head(s, title, shown);
    chart_keys(s, (key[]){ { SVG_DISC, "other", "facet, fast" },
                           { SVG_SQUARE, "other", "facet, strict: the same bytes everywhere" },
                           { SVG_DIAMOND, "baseline", "without facet" } }, 3);
    if (s->narrow)
        chart_arch_keys(s, d);
    draw_plots(s, d, workload, &empty, name_targets);
    chart_source(s, d);
    return true;
}

/* ---- Every kernel ---------------------------------------------------------------------------------------------- */

/* Whether the kernel has its name at a mark that is faster. */
static bool is_named(const scatter *p, const mark *m)
{
    for (int i = 0; i < p->count; i++) {
        const mark *a = &p->marks[i];
        if (a->on_front && a->x > m->x && !strcmp(a->row->kernel, m->row->kernel))
            return true;
    }
    return false;
}

static void name_kernels(scatter *p, bool narrow)
{
    for (int i = 0; i < p->count; i++) {
        mark *m = &p->marks[i];
        m->faint = !m->on_front;
        m->radius = m->on_front ? 5 : 3.5;
        m->one_line = true;
        if (!m->on_front || is_named(p, m))
            continue;
        snprintf(m->label, sizeof m->label, "%s", m->row->kernel);
        if (!narrow)
            snprintf(m->more, sizeof m->more, "%s/s, %s", format_rate(m->x), format_error(m->y));
    }
}

/* How many kernels there are, by name, on the machine that has the most. */
static int count_kernels(const chart_data *d)
{
    int most = 0;
    for (int i = 0; i < d->machine_count; i++) {
        const machine *m = &d->machines[i];
        int count = 0;
        for (int k = 0; k < m->count; k++) {
            bool seen = is_baseline(&m->rows[k]);
            for (int j = 0; j < k && !seen; j++)
                seen = !is_baseline(&m->rows[j]) && !strcmp(m->rows[j].kernel, m->rows[k].kernel);
            count += !seen;
        }
        most = count > most ? count : most;
    }
    return most;
}

bool draw_kernels(svg *s, const chart_data *d)
{
    char title[400];
    scatter empty = { .x_title = FASTER, .y_title = MORE_ACCURATE, .y_format = format_error, .spans = true,
                      .stacked = true, .height = d->machine_count > 1 ? 340 : 460 };
    find_ranges(d, NULL, &empty.x, &empty.y);
    if (empty.y.most == 0)
        return false;
    snprintf(title, sizeof title, "%d kernels, up to %s samples a second; none is off by more than %s",
             count_kernels(d), format_rate_in_words(empty.x.most), format_percent(empty.y.most));
    chart_head(s, title, "A mark for every kernel, tier and architecture: the worst error against double precision "
               "that was found, relative to the result. Bars: from an architecture\342\200\231s slowest kernel to its "
               "fastest. " THE_FRONT);
    chart_keys(s, (key[]){ { SVG_DISC, "other", "fast" }, { SVG_SQUARE, "other", "strict" } }, 2);
    draw_plots(s, d, NULL, &empty, name_kernels);
    chart_source(s, d);
    return true;
}
