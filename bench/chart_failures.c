/* Where textbooks' forms fail in float, and facet's do not: errors along an angle or a parameter. */
#include "chart.h"

#include <math.h>
#include <string.h>

/* Below this, errors are rounding of the result, and all the same. */
static const double least_error = 1e-7, most_error = 100;

typedef struct plot {
    axis x, y;
    double top, lost, bottom;    /* lost: the middle of the row of what is NaN or infinite */
} plot;

static double clamp(double value, double least, double most)
{
    return fmin(fmax(value, least), most);
}

static double height_of(const plot *p, double error)
{
    return axis_at(&p->y, clamp(error, least_error, most_error));
}

static void draw_axes(svg *s, const plot *p, const failure_panel *f)
{
    double ticks[MOST_TICKS];
    int count = axis_ticks(&p->y, 1.7 * s->size, ticks);
    for (int i = 0; i < count; i++) {
        const double y = axis_at(&p->y, ticks[i]);
        svg_line(s, "grid", p->x.from, y, p->x.to, y);
        svg_text(s, p->x.from - 8, y + 0.35 * s->size, "muted", s->size, "end", format_error(ticks[i]));
    }
    count = axis_ticks(&p->x, 3.2 * s->size, ticks);
    for (int i = 0; i < count; i++) {
        const double x = axis_at(&p->x, ticks[i]);
        svg_line(s, "grid", x, p->top, x, p->bottom);
        svg_text(s, x, p->bottom + 1.4 * s->size, "muted", s->size, "middle", format_plain(ticks[i]));
    }
    svg_line(s, "axis", p->x.from, p->bottom, p->x.to, p->bottom);
    svg_text(s, p->x.from - 8, p->lost + 0.35 * s->size, "muted", s->size, "end", "NaN");
    svg_text(s, p->x.to, p->bottom + 2.8 * s->size, "muted", s->size, "end", f->x);
}

static double textbook_of(const failure_point *at) { return at->textbook; }
static double facet_of(const failure_point *at) { return at->facet; }

static void draw_curve(svg *s, const plot *p, const failure_panel *f, const char *class,
                       double (*error)(const failure_point *))
{
    fprintf(s->out, "<path class=\"curve %s\" d=\"", class);
    bool started = false;
    for (int i = 0; i < f->count; i++) {
        const double value = error(&f->points[i]);
        if (!isnan(value))
            fprintf(s->out, "%c%.1f %.1f", started ? 'L' : 'M', axis_at(&p->x, f->points[i].x), height_of(p, value));
        started |= !isnan(value);
    }
    fprintf(s->out, "\"/>\n");
}

/* Points to be pointed at, and crosses where something is lost. */
static void draw_points(svg *s, const plot *p, const failure_panel *f)
{
    for (int i = 0; i < f->count; i++) {
        const failure_point *at = &f->points[i];
        const double x = axis_at(&p->x, at->x);
        char tip[400], id[128];
        snprintf(tip, sizeof tip, "%s %s\ntextbook: worst error %s\nfacet: worst error %s", f->x, format_plain(at->x),
                 format_error(at->textbook), format_error(at->facet));
        if (at->lost > 0)
            snprintf(tip + strlen(tip), sizeof tip - strlen(tip), "\nNaN or infinite in %s of samples, facet in none",
                     format_percent(at->lost));
        snprintf(id, sizeof id, "%s %g", f->name, at->x);
        if (at->lost > 0)
            svg_mark(s, SVG_CROSS, "sse41", x, p->lost, 4, id, tip);
        if (!isnan(at->textbook))
            svg_mark(s, SVG_DISC, "sse41", x, height_of(p, at->textbook), 1.6, id, tip);
        if (!isnan(at->facet))
            svg_mark(s, SVG_DISC, "avx512", x, height_of(p, at->facet), 1.6, id, tip);
    }
}

/* The point where the curves are the farthest apart: where their names stand. NULL where no point has both. */
static const failure_point *widest(const failure_panel *f)
{
    const failure_point *best = NULL;
    for (int i = 0; i < f->count; i++) {
        const failure_point *at = &f->points[i];
        if (at->textbook > 0 && at->facet > 0 && (!best || at->textbook / at->facet > best->textbook / best->facet))
            best = at;
    }
    return best;
}

static void draw_names(svg *s, const plot *p, const failure_panel *f)
{
    const failure_point *at = widest(f);
    if (!at)
        return;
    const double x = axis_at(&p->x, at->x);
    label names[] = {
        { .x = x, .y = height_of(p, at->textbook), .radius = 6, .name = "textbook", .size = s->size, .widest = 200 },
        { .x = x, .y = height_of(p, at->facet), .radius = 6, .name = "facet", .size = s->size, .widest = 200 },
    };
    box points[512];
    int count = 0;
    for (int i = 0; i < f->count && count + 2 <= COUNT(points); i++) {
        const double px = axis_at(&p->x, f->points[i].x);
        points[count++] = (box){ px - 4, height_of(p, f->points[i].textbook) - 4, 8, 8 };
        points[count++] = (box){ px - 4, height_of(p, f->points[i].facet) - 4, 8, 8 };
    }
    const box bounds = { p->x.from, p->top, p->x.to - p->x.from, p->bottom - p->top };
    labels_place(names, COUNT(names), points, count, bounds);
    labels_draw(s, names, COUNT(names));
}

static void draw_panel(svg *s, const failure_panel *f, double left, double width)
{
    range x = { 0, 0 };
    svg_text(s, left, s->height + s->size, "muted", s->size, "start", MORE_ACCURATE);
    s->height += 1.9 * s->size;
    const double band = 2.2 * s->size, top = s->height, bottom = top + (s->narrow ? 230 : 240);
    for (int i = 0; i < f->count; i++)
        range_add(&x, f->points[i].x);
    plot p = { .top = top, .bottom = bottom, .lost = bottom - band / 2 };
    p.x = axis_over(x, left + 4.2 * s->size, left + width);
    p.y = axis_over((range){ least_error, most_error }, top, bottom - band);
    draw_axes(s, &p, f);
    draw_curve(s, &p, f, "sse41", textbook_of);
    draw_curve(s, &p, f, "avx512", facet_of);
    draw_points(s, &p, f);
    draw_names(s, &p, f);
    s->height = bottom + 4.4 * s->size;
}

static void say(const chart_data *d, char *title, size_t size)
{
    double ours = 0, theirs = 0;
    bool lost = false;
    for (int i = 0; i < d->panel_count; i++)
        for (int k = 0; k < d->panels[i].count; k++) {
            const failure_point *at = &d->panels[i].points[k];
            ours = fmax(ours, at->facet);
            theirs = isinf(at->textbook) ? theirs : fmax(theirs, at->textbook);
            lost |= at->lost > 0 || isinf(at->textbook);
        }
    snprintf(title, size, "In float, textbook forms are off by up to %s times the value%s; facet by %s at most",
             format_times(theirs), lost ? ", or NaN" : "", format_percent(ours));
}

bool draw_failures(svg *s, const chart_data *d)
{
    const double left = chart_left(s), gap = 3 * s->size, whole = chart_right(s) - left;
    const int columns = s->narrow ? 1 : 2;
    const double width = (whole - gap * (columns - 1)) / columns;
    char title[400];
    if (!d->panel_count)
        return false;
    say(d, title, sizeof title);
    chart_head(s, title, "The worst relative error against double precision where shaders are known to fail. Textbook: "
               "the formula in float as it is printed. facet: what facet_shade returns, strict.");
    for (int i = 0; i < d->panel_count; i += columns) {
        const double top = s->height;
        double plots = top, end = top;
        for (int c = 0; c < columns && i + c < d->panel_count; c++) {
            s->height = top;
            chart_part(s, left + c * (width + gap), width, d->panels[i + c].title, d->panels[i + c].stated);
            plots = fmax(plots, s->height);
        }
        for (int c = 0; c < columns && i + c < d->panel_count; c++) {
            s->height = plots;
            draw_panel(s, &d->panels[i + c], left + c * (width + gap), width);
            end = fmax(end, s->height);
        }
        s->height = end;
    }
    s->height = svg_paragraph(s, left, s->height + 0.88 * s->size, whole, "muted", 0.88 * s->size,
                              "2000 random samples a point; computed by tests/model_errors.c, on any machine alike")
        + 1.2 * s->size;
    return true;
}
