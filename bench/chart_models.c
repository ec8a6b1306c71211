/* Model error against speed: what a cheaper model saves, and how far it is from the richer one. */
#include "chart.h"

#include <math.h>
#include <string.h>

static bool is_timing_of(const kernel_row *r, const model *m)
{
    return r->charted && !is_baseline(r) && !strcmp(r->kernel, m->kernel) && (!m->tier || !strcmp(r->tier, m->tier));
}

/* The best one shows its model's name. */
static void name_mark(mark *at, const model *m, bool best)
{
    const char *worst = format_percent(m->worst);
    at->faint = !best;
    at->one_line = true;
    if (m->worst > 0)
        snprintf(at->note, sizeof at->note, "%s: up to %s off, %s on average", m->label, worst,
                 format_percent(m->mean));
    else
        snprintf(at->note, sizeof at->note, "%s: the truth", m->label);
    if (!best)
        return;
    snprintf(at->label, sizeof at->label, "%s", m->label);
    snprintf(at->more, sizeof at->more, "%s%s", m->worst > 0 ? worst : "the truth", m->worst > 0 ? " off" : "");
}

/* What of a ladder a machine was timed on. */
static bool collect_ladder(scatter *p, const machine *m, const ladder *l, range x)
{
    *p = (scatter){ .x_title = FASTER, .y_title = "\342\206\221 nearer to the truth: worst relative difference",
                    .y_format = format_percent, .x = x };
    for (int i = 0; i < l->count; i++) {
        const model *a = &l->models[i];
        const kernel_row *best = fastest_row(m, a->kernel, a->tier);
        for (int k = 0; k < m->count; k++)
            if (is_timing_of(&m->rows[k], a))
                name_mark(scatter_add(p, m, &m->rows[k], a->worst), a, &m->rows[k] == best);
    }
    scatter_front(p);
    return p->count;
}

/* The fastest model of a ladder and the true one, as far as they were timed. */
static void ends_of(const machine *m, const ladder *l, const model **cheapest, const model **truth)
{
    const kernel_row *best = NULL;
    *cheapest = *truth = NULL;
    for (int i = 0; i < l->count; i++) {
        const kernel_row *r = fastest_row(m, l->models[i].kernel, l->models[i].tier);
        if (r && l->models[i].worst == 0)
            *truth = &l->models[i];
        if (r && (!best || r->ns < best->ns)) {
            best = r;
            *cheapest = &l->models[i];
        }
    }
}

static void say_ladder(const machine *m, const ladder *l, char *title, size_t size)
{
    const model *cheapest, *truth;
    const size_t used = strlen(title);
    ends_of(m, l, &cheapest, &truth);
    if (!cheapest || !truth || cheapest == truth)
        return;
    const double slow = fastest_row(m, truth->kernel, truth->tier)->ns;
    const double times = slow / fastest_row(m, cheapest->kernel, cheapest->tier)->ns;
    snprintf(title + used, size - used, "%s%s is %s times as fast as %s, and up to %s off", used ? "; " : "",
             cheapest->label, format_times(times), l->truth, format_percent(cheapest->worst));
}

static bool timed(const machine *m, const ladder *l)
{
    for (int i = 0; i < l->count; i++)
        if (fastest_row(m, l->models[i].kernel, l->models[i].tier))
            return true;
    return false;
}

static range speeds_of(const chart_data *d, const ladder *l)
{
    range x = { 0, 0 };
    for (int i = 0; i < d->machine_count; i++)
        for (int k = 0; k < l->count; k++)
            for (int r = 0; r < d->machines[i].count; r++)
                if (is_timing_of(&d->machines[i].rows[r], &l->models[k]))
                    range_add(&x, row_speed(&d->machines[i].rows[r]));
    return x;
}

/* So that every name fits beside its mark, as far as there is room: x of a mark is a part of what the names leave. */
static double room_of(const svg *s, const scatter *p, double width)
{
    const axis whole = axis_over(p->x, 0, 1);
    double room = 0;
    for (int i = 0; i < p->count; i++) {
        const mark *m = &p->marks[i];
        const double part = axis_at(&whole, m->x);
        const double name = 1.05 * (text_width(m->label, s->size, true) + text_width(m->more, s->size, false));
        if (*m->label && part > 0)
            room = fmax(room, width - (width - name - 1.6 * s->size) / part);
    }
    return fmin(room, 0.45 * width);
}

/* A plot below s->height, which stays. Returns where it ends. */
static double draw_ladder(svg *s, const chart_data *d, const machine *m, const ladder *l, double x, double width)
{
    const double top = s->height;
    scatter p;
    if (collect_ladder(&p, m, l, speeds_of(d, l))) {
        p.height = d->machine_count > 1 ? 260 : 330;
        p.room = room_of(s, &p, width - 4.2 * s->size);
        scatter_draw(s, &p, x, width);
    }
    scatter_free(&p);
    const double end = s->height;
    s->height = top;
    return end;
}

/* A machine's ladders: side by side, or one below the other. */
static void draw_machine(svg *s, const chart_data *d, const machine *m)
{
    const double left = chart_left(s), gap = 3 * s->size, whole = chart_right(s) - left;
    const int columns = s->narrow ? 1 : d->ladder_count;
    const double width = (whole - gap * (columns - 1)) / columns;
    double top = s->height, plots = top, end = top;
    for (int i = 0; i < d->ladder_count && columns > 1; i++) {
        s->height = top;
        chart_part(s, left + i * (width + gap), width, d->ladders[i].title, d->ladders[i].stated);
        plots = fmax(plots, s->height);
    }
    for (int i = 0; i < d->ladder_count; i++) {
        s->height = columns > 1 ? plots : end;
        if (columns == 1)
            chart_part(s, left, width, d->ladders[i].title, d->ladders[i].stated);
        const double bottom = draw_ladder(s, d, m, &d->ladders[i], left + (columns > 1 ? i * (width + gap) : 0), width);
        end = fmax(end, bottom);
    }
    s->height = end;
}

bool draw_models(svg *s, const chart_data *d)
{
    char title[400] = "";
    bool any = false;
    for (int i = 0; i < d->ladder_count; i++)
        say_ladder(&d->machines[0], &d->ladders[i], title, sizeof title);
    for (int i = 0; i < d->machine_count; i++)
        for (int k = 0; k < d->ladder_count; k++)
            any |= timed(&d->machines[i], &d->ladders[k]);
    if (!any)
        return false;
    chart_head(s, *title ? title : "What a cheaper model saves, and what it costs",
               "Models in double precision against the richest of their family. A mark is the worst relative "
               "difference. " THE_FRONT);
    chart_keys(s, (key[]){ { SVG_DISC, "other", "fast" }, { SVG_SQUARE, "other", "strict" } }, 2);
    chart_arch_keys(s, d);
    for (int i = 0; i < d->machine_count; i++) {
        chart_machine(s, d, &d->machines[i]);
        draw_machine(s, d, &d->machines[i]);
    }
    chart_source(s, d);
    return true;
}
