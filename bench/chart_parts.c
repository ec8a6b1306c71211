#include "chart.h"

#include <math.h>
#include <stdarg.h>
#include <string.h>

/* Those that have a colour in svg_style. */
static const char *const arches[] = { "scalar", "sse2", "sse41", "avx2", "avx512", "neon" };
enum { ARCHES = sizeof arches / sizeof arches[0] };

double chart_left(const svg *s) { return s->narrow ? 12 : 24; }
double chart_right(const svg *s) { return s->width - chart_left(s); }

void chart_head(svg *s, const char *title, const char *shown)
{
    const double left = chart_left(s), width = chart_right(s) - left, large = s->narrow ? 17 : 22;
    snprintf(s->title, sizeof s->title, "%s", title);
    s->height = svg_paragraph(s, left, (s->narrow ? 14 : 20) + large, width, "strong", large, title) + 1.75 * s->size;
    s->height = svg_paragraph(s, left, s->height, width, "muted", s->size, shown) + s->size;
}

void chart_keys(svg *s, const key *keys, int count)
{
    const double left = chart_left(s), radius = 0.36 * s->size;
    double x = left;
    s->height += 0.7 * s->size;
    for (int i = 0; i < count; i++) {
        const double width = 2 * radius + 6 + text_width(keys[i].text, s->size, false);
        if (x > left && x + width > chart_right(s)) {
            x = left;
            s->height += 1.4 * s->size;
        }
        svg_mark(s, keys[i].shape, keys[i].class, x + radius, s->height - 0.34 * s->size, radius, NULL, NULL);
        svg_text(s, x + 2 * radius + 6, s->height, "muted", s->size, "start", keys[i].text);
        x += width + 16;
    }
    s->height += 0.9 * s->size;
}

/* A row of the architecture, or NULL. */
static const kernel_row *row_of_arch(const chart_data *d, const char *arch)
{
    for (int i = 0; i < d->machine_count; i++)
        for (int k = 0; k < d->machines[i].count; k++)
            if (!is_baseline(&d->machines[i].rows[k]) && !strcmp(d->machines[i].rows[k].arch, arch))
                return &d->machines[i].rows[k];
    return NULL;
}

void chart_arch_keys(svg *s, const chart_data *d)
{
    key keys[ARCHES];
    int count = 0;
    for (int i = 0; i < ARCHES; i++)
        if (row_of_arch(d, arches[i]))
            keys[count++] = (key){ SVG_DISC, arches[i], arches[i] };
    chart_keys(s, keys, count);
}

void chart_source(svg *s, const chart_data *d)
{
    const double left = chart_left(s), small = 0.88 * s->size;
    s->height += small;
    for (int i = 0; i < d->machine_count; i++) {
        const machine *m = &d->machines[i];
        char line[1024];
        snprintf(line, sizeof line, "%s \302\267 %s \302\267 %s \302\267 %s", m->date, m->cpu, m->compiler, m->command);
        s->height = svg_paragraph(s, left, s->height, chart_right(s) - left, "muted", small, line) + 1.4 * small;
    }
    s->height += 0.2 * small;
}

void chart_part(svg *s, double x, double width, const char *name, const char *more)
{
    s->height = svg_paragraph(s, x, s->height + 1.6 * s->size, width, "strong", 1.1 * s->size, name);
    if (more && *more)
        s->height = svg_paragraph(s, x, s->height + 1.35 * s->size, width, "muted", s->size, more);
    s->height += 0.6 * s->size;
}

void chart_machine(svg *s, const chart_data *d, const machine *m)
{
    if (d->machine_count > 1)
        chart_part(s, chart_left(s), chart_right(s) - chart_left(s), m->name, NULL);
}

/* ---- Rows ------------------------------------------------------------------------------------------------------ */

const char *arch_class(const kernel_row *r)
{
    if (is_baseline(r))
        return "baseline";
    for (int i = 0; i < ARCHES; i++)
        if (!strcmp(r->arch, arches[i]))
            return arches[i];
    return "other";
}

svg_shape tier_shape(const kernel_row *r)
{
    return is_baseline(r) ? SVG_DIAMOND : strcmp(r->tier, "fast") ? SVG_SQUARE : SVG_DISC;
}

const char *target_name(const kernel_row *r, char *text, size_t size)
{
    if (!is_baseline(r))
        snprintf(text, size, "%s %s", r->arch, r->tier);
    else
        snprintf(text, size, "%s", strcmp(r->arch, "literal") ? r->arch : "textbook");
    return text;
}

const char *row_id(const kernel_row *r, char *text, size_t size)
{
    snprintf(text, size, "%s %s %s", r->kernel, r->tier, r->arch);
    return text;
}

static void append(char *text, size_t size, const char *format, ...) __attribute__((format(printf, 3, 4)));
static void append(char *text, size_t size, const char *format, ...)
{
    const size_t used = strlen(text);
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(text + used, size - used, format, arguments);
    va_end(arguments);
}

const char *row_tip(const machine *m, const kernel_row *r, char *text, size_t size)
{
    char target[256];
    snprintf(text, size, "%s, %s\n%ssamples/s, %.4g ns a sample", r->kernel, target_name(r, target, sizeof target),
             format_rate(row_speed(r)), r->ns);
    if (!isnan(r->spread))
        append(text, size, " \302\261 %.1f %%", 100 * r->spread);
    if (!isnan(r->cycles))
        append(text, size, ", %.3g cycles", r->cycles);
    if (!isnan(r->x_literal))
        append(text, size, "\n%s times as fast as the textbook", format_times(r->x_literal));
    append(text, size, "\nworst rounding error %s", format_error(r->error));
    if (!isnan(r->p999))
        append(text, size, ", 99.9 %% below %s", format_error(r->p999));
    if (!isnan(r->fraction))
        append(text, size, "\n%.0f %% of what %s allows", 100 * r->fraction, r->bound_by);
    append(text, size, "\n%s samples a call, %s\n%s", r->size, r->layout, m->name);
    return text;
}
