#include "chart.h"
#include "tsv.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* ---- Marks ----------------------------------------------------------------------------------------------------- */

mark *scatter_add(scatter *p, const machine *m, const kernel_row *r, double y)
{
    p->marks = grow(p->marks, p->count, sizeof *p->marks);
    mark *a = &p->marks[p->count++];
    *a = (mark){ .machine = m, .row = r, .x = row_speed(r), .y = y, .whisker = NAN, .radius = 5 };
    return a;
}

void scatter_free(scatter *p)
{
    free(p->marks);
    p->marks = NULL;
    p->count = 0;
}

static bool beats(const mark *a, const mark *b)
{
    return a->x >= b->x && a->y <= b->y && (a->x > b->x || a->y < b->y);
}

void scatter_front(scatter *p)
{
    for (int i = 0; i < p->count; i++) {
        p->marks[i].on_front = isfinite(p->marks[i].y);
        for (int k = 0; k < p->count; k++)
            if (beats(&p->marks[k], &p->marks[i]))
                p->marks[i].on_front = false;
    }
}

/* ---- Rows for what is not on the axis: 0 above it, infinite and unknown below ---------------------------------- */

typedef enum band { ON_AXIS, ZERO, INFINITE, UNKNOWN, BANDS } band;

static band band_of(double y)
{
    return isnan(y) ? UNKNOWN : isinf(y) ? INFINITE : y == 0 ? ZERO : ON_AXIS;
}

/* Where everything is. */
typedef struct layout {
    axis x, y;
    double fastest;                      /* where x's numbers end */
    double left, right, top, bottom;     /* of the plot, bands and all */
    double band[BANDS];                  /* their middle; NaN: there is none */
} layout;

/* What names above the marks take; together with the marks' own size. */
static double stack_height(const svg *s, const scatter *p)
{
    int names = 0;
    for (int i = 0; i < p->count && p->stacked; i++)
        names += *p->marks[i].label != 0;
    return names ? names * (1.2 * s->size + 2) + 1.2 * s->size : 0;
}

static layout lay_out(const svg *s, const scatter *p, double x, double width)
{
    const double high = 2.2 * s->size;
    layout l = { .left = x + 4.2 * s->size, .right = x + width, .top = s->height, .bottom = s->height + p->height };
    range xs = p->x, ys = p->y;
    bool has[BANDS] = { false };
    for (int i = 0; i < p->count; i++) {
        range_add(&xs, p->marks[i].x);
        range_add(&ys, p->marks[i].y);
        range_add(&ys, p->marks[i].whisker);
        has[band_of(p->marks[i].y)] = true;
    }
    double top = l.top + stack_height(s, p), bottom = l.bottom;
    for (int b = 0; b < BANDS; b++)
        l.band[b] = NAN;
    if (has[ZERO]) {
        l.band[ZERO] = top + high / 2;
        top += 1.5 * high;
    }
    for (int b = UNKNOWN; b >= INFINITE; b--)
        if (has[b]) {
            l.band[b] = bottom - high / 2;
            bottom -= high;
        }
    /* What is fastest wants room for its name. */
    l.x = axis_over(xs, l.left, l.right - p->room);
    l.fastest = l.x.most;
    l.x.most *= pow(l.x.most / l.x.least, (l.right - l.x.to) / (l.x.to - l.x.from));
    l.x.to = l.right;
    l.y = axis_over(ys, top, bottom);
    return l;
}

static double height_of(const layout *l, double y)
{
    const band b = band_of(y);
    return b == ON_AXIS ? axis_at(&l->y, y) : l->band[b];
}

/* ---- Axes ------------------------------------------------------------------------------------------------------ */

static void draw_bands(svg *s, const layout *l)
{
    const char *const symbols[] = { "", "0", "\342\210\236", "?" };
    const char *const names[] = { NULL, NULL, "NaN or infinite", "error not known" };
    for (int b = ZERO; b < BANDS; b++) {
        if (isnan(l->band[b]))
            continue;
        const double edge = b == ZERO ? l->band[b] : l->band[b] - 1.1 * s->size;
        svg_line(s, b == ZERO ? "grid" : "axis", l->left, edge, l->right, edge);
        svg_text(s, l->left - 8, l->band[b] + 0.35 * s->size, "muted", s->size, "end", symbols[b]);
        if (names[b])
            svg_text(s, l->left + 6, l->band[b] + 0.35 * s->size, "muted", 0.9 * s->size, "start", names[b]);
    }
}

static void draw_axes(svg *s, const scatter *p, const layout *l)
{
    double ticks[MOST_TICKS];
    int count = axis_ticks(&l->y, 1.7 * s->size, ticks);
    for (int i = 0; i < count; i++) {
        const double y = axis_at(&l->y, ticks[i]);
        svg_line(s, "grid", l->left, y, l->right, y);
        svg_text(s, l->left - 8, y + 0.35 * s->size, "muted", s->size, "end", p->y_format(ticks[i]));
    }
    count = axis_ticks(&l->x, 3.3 * s->size, ticks);
    for (int i = 0; i < count; i++) {
        const double x = axis_at(&l->x, ticks[i]);
        if (ticks[i] > l->fastest)
            break;
        svg_line(s, "grid", x, l->top, x, l->bottom);
        if (x + text_width(format_rate(ticks[i]), s->size, false) / 2 < s->width)
            svg_text(s, x, l->bottom + 1.4 * s->size, "muted", s->size, "middle", format_rate(ticks[i]));
    }
    svg_line(s, "axis", l->left, l->bottom, l->right, l->bottom);
    draw_bands(s, l);
}

/* ---- Bars of architectures ------------------------------------------------------------------------------------- */

/* The first mark of an architecture, of i; or NULL. */
static const mark *first_of_arch(const scatter *p, int i)
{
    for (int k = 0; k < i; k++)
        if (!strcmp(p->marks[k].row->arch, p->marks[i].row->arch))
            return NULL;
    return &p->marks[i];
}

static double spans_height(const svg *s, const scatter *p)
{
    int arches = 0;
    for (int i = 0; i < p->count && p->spans; i++)
        arches += first_of_arch(p, i) != NULL;
    return (arches ? arches + 0.5 : 0) * 1.35 * s->size;
}

static void draw_spans(svg *s, const scatter *p, const axis *x, double y)
{
    for (int i = 0; i < p->count && p->spans; i++) {
        const mark *m = first_of_arch(p, i);
        range reach = { 0, 0 };
        char class[64];
        if (!m)
            continue;
        for (int k = 0; k < p->count; k++)
            if (!strcmp(p->marks[k].row->arch, m->row->arch))
                range_add(&reach, p->marks[k].x);
        const double from = axis_at(x, reach.least), to = axis_at(x, reach.most);
        const bool left = from - x->from > text_width(m->row->arch, s->size, true) + 12;
        snprintf(class, sizeof class, "curve %s", arch_class(m->row));
        svg_line(s, class, from, y, to, y);
        svg_text(s, left ? from - 6 : to + 6, y + 0.35 * s->size, "strong halo", s->size, left ? "end" : "start",
                 m->row->arch);
        y += 1.35 * s->size;
    }
}

/* ---- The front ------------------------------------------------------------------------------------------------- */

static int by_speed(const void *a, const void *b)
{
    const double x = (*(const mark *const *)a)->x, y = (*(const mark *const *)b)->x;
    return (x > y) - (x < y);
}

/* A staircase from one to the next: what is below and left of it is beaten. */
static void draw_front(svg *s, const scatter *p, const layout *l)
{
    const mark **front = calloc((size_t)p->count + 1, sizeof *front);
    int count = 0;
    for (int i = 0; front && i < p->count; i++)
        if (p->marks[i].on_front)
            front[count++] = &p->marks[i];
    if (count) {
        qsort(front, (size_t)count, sizeof *front, by_speed);
        fprintf(s->out, "<path class=\"front\" d=\"M%.1f %.1f", axis_at(&l->x, front[0]->x), height_of(l, front[0]->y));
        for (int i = 1; i < count; i++)
            fprintf(s->out, "V%.1fH%.1f", height_of(l, front[i]->y), axis_at(&l->x, front[i]->x));
        fprintf(s->out, "\"/>\n");
    }
    free(front);
}

/* ---- Drawing --------------------------------------------------------------------------------------------------- */

static void draw_mark(svg *s, const mark *m, const layout *l)
{
    char id[512], tip[1024], said[1280], class[64];
    const double x = axis_at(&l->x, m->x), y = height_of(l, m->y);
    snprintf(class, sizeof class, "%s whisker", arch_class(m->row));
    if (isfinite(m->whisker) && band_of(m->whisker) == ON_AXIS && band_of(m->y) == ON_AXIS)
        svg_line(s, class, x, y, x, axis_at(&l->y, m->whisker));
    snprintf(class, sizeof class, "%s%s", arch_class(m->row), m->faint ? " faint" : "");
    const bool square = tier_shape(m->row) == SVG_SQUARE;
    snprintf(said, sizeof said, "%s%s%s", m->note, *m->note ? "\n" : "", row_tip(m->machine, m->row, tip, sizeof tip));
    svg_mark(s, tier_shape(m->row), class, x, y, m->radius * (square ? 1.15 : 1), row_id(m->row, id, sizeof id), said);
}

/* The boxes of a mark and its whisker. */
static int add_boxes(box *boxes, int count, const mark *m, const layout *l)
{
    const double x = axis_at(&l->x, m->x), y = height_of(l, m->y), r = m->radius;
    boxes[count++] = (box){ x - r, y - r, 2 * r, 2 * r };
    if (isfinite(m->whisker) && band_of(m->y) == ON_AXIS)
        boxes[count++] = (box){ x - 1, fmin(y, axis_at(&l->y, m->whisker)), 2, fabs(y - axis_at(&l->y, m->whisker)) };
    return count;
}

static void draw_labels(svg *s, const scatter *p, const layout *l)
{
    label *labels = calloc((size_t)p->count + 1, sizeof *labels);
    box *boxes = calloc((size_t)p->count * 2 + 1, sizeof *boxes);
    /* A little beyond the plot. */
    const box bounds = { l->left + 2, l->top, l->right + 0.7 * s->size - l->left, l->bottom - l->top };
    int count = 0, box_count = 0;
    for (int i = 0; labels && boxes && i < p->count; i++) {
        const mark *m = &p->marks[i];
        box_count = add_boxes(boxes, box_count, m, l);
        if (*m->label || *m->more)
            labels[count++] = (label){ .x = axis_at(&l->x, m->x), .y = height_of(l, m->y), .radius = m->radius + 2,
                                       .name = m->label, .more = m->more, .one_line = m->one_line, .size = s->size,
                                       .widest = fmin(0.75 * (l->right - l->left), 340), .rank = m->rank };
    }
    if (p->stacked)
        labels_stack(labels, count, l->y.from - 1.2 * s->size, bounds);
    else
        labels_place(labels, count, boxes, box_count, bounds);
    labels_draw(s, labels, count);
    free(labels);
    free(boxes);
}

void scatter_draw(svg *s, scatter *p, double x, double width)
{
    svg_text(s, x, s->height + s->size, "muted", s->size, "start", p->y_title);
    s->height += 1.9 * s->size;
    const double spans = s->height + 0.6 * s->size;
    s->height += spans_height(s, p);
    const layout l = lay_out(s, p, x, width);
    draw_spans(s, p, &l.x, spans);
    draw_axes(s, p, &l);
    draw_front(s, p, &l);
    for (int i = 0; i < p->count; i++)
        draw_mark(s, &p->marks[i], &l);
    draw_labels(s, p, &l);
    s->height = l.bottom + 1.4 * s->size;
    svg_text(s, l.right, s->height + 1.35 * s->size, "muted", s->size, "end", p->x_title);
    s->height += 1.9 * s->size;
}
