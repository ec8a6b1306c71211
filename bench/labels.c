#include "labels.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { DIRECTIONS = 16, DISTANCES = 12 };

static const double leading = 1.2, gap = 5;

static double clamp(double value, double least, double most)
{
    return fmin(fmax(value, least), most);
}

/* ---- What a label says, in lines ------------------------------------------------------------------------------- */

typedef struct text_line {
    const char *text;
    size_t length;
    bool bold;
} text_line;

static int break_text(const label *l, const char *text, bool bold, text_line *lines, int count)
{
    while (text && *text && count < LABEL_LINES) {
        const size_t length = l->one_line ? strlen(text) : text_break(text, l->size, bold, l->widest);
        lines[count++] = (text_line){ text, length, bold };
        text += length;
    }
    return count;
}

static int lines_of(const label *l, text_line lines[LABEL_LINES])
{
    return break_text(l, l->more, false, lines, break_text(l, l->name, true, lines, 0));
}

static double line_text(const label *l, const text_line *line, char *to, size_t size)
{
    snprintf(to, size, "%.*s", (int)line->length, line->text);
    return 1.03 * text_width(to, l->size, line->bold);
}

static void measure(label *l)
{
    text_line lines[LABEL_LINES];
    const int count = lines_of(l, lines);
    l->at.width = 0;
    l->at.height = leading * l->size * (l->one_line ? 1 : count);
    for (int i = 0; i < count; i++) {
        char text[256];
        const double width = line_text(l, &lines[i], text, sizeof text);
        l->at.width = l->one_line ? l->at.width + width + (i ? 0.3 * l->size : 0) : fmax(l->at.width, width);
    }
}

/* ---- Where it goes --------------------------------------------------------------------------------------------- */

static double overlap(box a, box b, double margin)
{
    const double across = fmin(a.x + a.width, b.x + b.width) - fmax(a.x, b.x) + margin;
    const double down = fmin(a.y + a.height, b.y + b.height) - fmax(a.y, b.y) + margin;
    return across > 0 && down > 0 ? across * down : 0;
}

static bool inside(box a, box b)
{
    return a.x >= b.x && a.y >= b.y && a.x + a.width <= b.x + b.width && a.y + a.height <= b.y + b.height;
}

/* Along a square around the point. */
static box beside(const label *l, double angle, double distance)
{
    box b = l->at;
    b.x = l->x + clamp(1.42 * cos(angle), -1, 1) * (distance + b.width / 2) - b.width / 2;
    b.y = l->y + clamp(1.42 * sin(angle), -1, 1) * (distance + b.height / 2) - b.height / 2;
    return b;
}

static int by_x(const void *a, const void *b)
{
    const double x = ((const label *)a)->x, y = ((const label *)b)->x;
    return (x > y) - (x < y);
}

/* What stands around a label: others, as far as they are placed, and marks. */
typedef struct crowd {
    const label *labels;
    int count;
    const box *marks;
    int mark_count;
    box bounds;
} crowd;

static bool covers_label(box b, const crowd *c)
{
    for (int i = 0; i < c->count; i++)
        if (c->labels[i].placed && overlap(b, c->labels[i].at, gap) > 0)
            return true;
    return false;
}

/* From a point to the nearest of a box. */
static double distance_to(box b, double x, double y)
{
    return hypot(x - clamp(x, b.x, b.x + b.width), y - clamp(y, b.y, b.y + b.height));
}

/* Whether the line from the label's point to its text comes over a box, other than where it starts. */
static bool crosses(const label *l, box text, box b)
{
    const double x = clamp(l->x, text.x, text.x + text.width), y = clamp(l->y, text.y, text.y + text.height);
    for (double t = 0.05; t < 1; t += 0.05)
        if (distance_to(b, x + t * (l->x - x), y + t * (l->y - y)) == 0 && distance_to(b, l->x, l->y) > 0)
            return true;
    return false;
}

/* Of being far from its point, of labels that its line crosses, and of marks: that it covers, by area, that it seems to
 * name, that its line crosses. Sides are better than corners. */
static double cost(const label *l, box b, const crowd *c, int direction)
{
    const double own = distance_to(b, l->x, l->y);
    double sum = own + (direction % (DIRECTIONS / 4) ? 3 : 0);
    for (int i = 0; i < c->count; i++)
        if (c->labels[i].placed && crosses(l, b, c->labels[i].at))
            sum += 60;
    for (int i = 0; i < c->mark_count; i++) {
        const double x = c->marks[i].x + c->marks[i].width / 2, y = c->marks[i].y + c->marks[i].height / 2;
        const bool other = hypot(x - l->x, y - l->y) > 1;
        const bool thin = fmin(c->marks[i].width, c->marks[i].height) < 4;
        sum += (thin ? 0.3 : 2) * overlap(b, c->marks[i], 1);
        if (other && !thin && distance_to(b, x, y) < own + 4)
            sum += 40;
        if (other && crosses(l, b, c->marks[i]))
            sum += thin ? 5 : 40;
    }
    return sum;
}

static void place(label *l, const crowd *c)
{
    const double pi = 3.14159265358979323846;
    double least = INFINITY;
    box best = l->at;
    for (int d = 0; d < DISTANCES; d++)
        for (int direction = 0; direction < DIRECTIONS; direction++) {
            const double distance = l->radius + 4 + d * d;
            const box b = beside(l, 2 * pi * direction / (double)DIRECTIONS, distance);
            if (!inside(b, c->bounds) || covers_label(b, c))
                continue;
            const double price = cost(l, b, c, direction);
            if (price < least) {
                least = price;
                best = b;
            }
        }
    l->placed = least < INFINITY;
    l->at = best;
}

void labels_spread(label *labels, int count, double y, box bounds)
{
    qsort(labels, (size_t)count, sizeof *labels, by_x);
    /* Each as far to the right as those before it ask for, */
    double free_from = bounds.x;
    for (int i = 0; i < count; i++) {
        label *l = &labels[i];
        measure(l);
        l->placed = true;
        l->at.y = y;
        l->at.x = fmax(l->x - l->at.width / 2, free_from);
        free_from = l->at.x + l->at.width + gap;
    }
    /* and to the left as those behind it: half-way between these two, none covers another either. */
    double free_to = bounds.x + bounds.width, inside_to = free_to;
    for (int i = count - 1; i >= 0; i--) {
        label *l = &labels[i];
        const double leftmost = fmin(l->x - l->at.width / 2, free_to - l->at.width);
        free_to = leftmost - gap;
        l->at.x = fmin((l->at.x + leftmost) / 2, inside_to - l->at.width);
        inside_to = l->at.x - gap;
    }
}

double labels_stack(label *labels, int count, double y, box bounds)
{
    qsort(labels, (size_t)count, sizeof *labels, by_x);
    for (int i = 0; i < count; i++) {
        label *l = &labels[i];
        measure(l);
        y -= l->at.height + 2;
        l->at.x = clamp(l->x - l->at.width, bounds.x, bounds.x + bounds.width - l->at.width);
        l->at.y = y;
        l->placed = true;
    }
    double height = 0;
    for (int i = 0; i < count; i++)
        height += labels[i].at.height + 2;
    return height;
}

int labels_place(label *labels, int count, const box *marks, int mark_count, box bounds)
{
    const crowd c = { labels, count, marks, mark_count, bounds };
    int placed = 0, highest = 0;
    for (int i = 0; i < count; i++) {
        labels[i].placed = false;
        measure(&labels[i]);
        highest = labels[i].rank > highest ? labels[i].rank : highest;
    }
    for (int rank = 0; rank <= highest; rank++)
        for (int i = 0; i < count; i++)
            if (labels[i].rank == rank) {
                place(&labels[i], &c);
                placed += labels[i].placed;
            }
    return placed;
}

/* ---- Drawing --------------------------------------------------------------------------------------------------- */

/* From the edge of the text to the edge of the mark. */
static void draw_leader(svg *s, const label *l)
{
    const double x = clamp(l->x, l->at.x, l->at.x + l->at.width), y = clamp(l->y, l->at.y, l->at.y + l->at.height);
    const double dx = x - l->x, dy = y - l->y, length = hypot(dx, dy);
    if (length > l->radius + 5)
        svg_line(s, "leader", x, y, l->x + dx * l->radius / length, l->y + dy * l->radius / length);
}

/* Flush with the side where the point is. */
static void draw_label(svg *s, const label *l)
{
    text_line lines[LABEL_LINES];
    const int count = lines_of(l, lines);
    const bool right = l->at.x + l->at.width / 2 < l->x - l->at.width / 4, left = l->at.x > l->x - l->at.width / 4;
    const double x = right ? l->at.x + l->at.width : left ? l->at.x : l->at.x + l->at.width / 2;
    const char *anchor = right ? "end" : left ? "start" : "middle";
    if (l->one_line) {
        svg_named_text(s, x, l->at.y + 0.93 * l->size, "label halo", l->size, anchor, l->name, l->more);
        return;
    }
    for (int i = 0; i < count; i++) {
        char text[256];
        line_text(l, &lines[i], text, sizeof text);
        svg_text(s, x, l->at.y + (leading * i + 0.93) * l->size, lines[i].bold ? "label halo strong" : "label halo",
                 l->size, anchor, text);
    }
}

void labels_draw(svg *s, const label *labels, int count)
{
    for (int i = 0; i < count; i++)
        if (labels[i].placed)
            draw_leader(s, &labels[i]);
    for (int i = 0; i < count; i++)
        if (labels[i].placed)
            draw_label(s, &labels[i]);
}
