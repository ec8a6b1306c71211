#include "chart_data.h"
#include "console.h"
#include "tsv.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

/* ---- Speeds ---------------------------------------------------------------------------------------------------- */

/* Rows are compared with each other. */
enum { MOST_ROWS = 10000 };

static const double any = INFINITY;

/* "# key<TAB>value"; keys that are not known are left alone. */
static bool read_metadata(tsv *t, machine *m, bool *known)
{
    const char *key = t->fields[0] + 1 + strspn(t->fields[0] + 1, " ");
    const struct { const char *key, **value; } keys[] = {
        { "date", &m->date }, { "cpu", &m->cpu }, { "compiler", &m->compiler }, { "command", &m->command },
    };
    if (t->count < 2)
        return true;
    if (!strcmp(key, "facet-bench")) {
        *known = !strcmp(t->fields[1], "1");
        return *known || tsv_refuse(t, "format %.20s; this program reads format 1", t->fields[1]);
    }
    for (size_t i = 0; i < sizeof keys / sizeof keys[0]; i++)
        if (!strcmp(key, keys[i].key))
            *keys[i].value = t->fields[1];
    return true;
}

static bool read_peak(tsv *t, machine *m)
{
    peak p = { .name = t->fields[1], .unit = t->fields[3] };
    if (!tsv_number(t, 2, "the peak", 0, any, &p.value))
        return false;
    m->peaks = grow(m->peaks, m->peak_count, sizeof p);
    m->peaks[m->peak_count++] = p;
    return true;
}

static bool read_kernel(tsv *t, machine *m)
{
    char *const *f = t->fields;
    kernel_row r = { .kernel = f[1], .tier = f[2], .arch = f[3], .size = f[4], .layout = f[5], .bound_by = f[14] };
    const double fastest = 1e-6, slowest = 1e12;
    double size;
    for (int i = 1; i <= 5; i++)
        if (!*f[i])
            return tsv_refuse(t, "field %d is empty", i + 1);
    if (strcmp(r.tier, "fast") && strcmp(r.tier, "strict") && strcmp(r.tier, "baseline"))
        return tsv_refuse(t, "the tier is '%.40s', which is none of fast, strict and baseline", r.tier);
    if (!tsv_number(t, 4, "the size", 1, 1e18, &size) || !tsv_number(t, 6, "ns", fastest, slowest, &r.ns)
        || !tsv_number(t, 7, "the spread", 0, any, &r.spread) || !tsv_number(t, 8, "cycles", 0, any, &r.cycles)
        || !tsv_number(t, 9, "bytes", 0, any, &r.bytes) || !tsv_number(t, 10, "x_literal", 0, any, &r.x_literal)
        || !tsv_number(t, 11, "x_256", 0, any, &r.x_256) || !tsv_number(t, 12, "x_512", 0, any, &r.x_512)
        || !tsv_number(t, 13, "the fraction", 0, any, &r.fraction)
        || !tsv_number(t, 15, "the error", 0, any, &r.error) || !tsv_number(t, 16, "p99.9", 0, any, &r.p999))
        return false;
    if (isnan(r.ns))
        return tsv_refuse(t, "no time");
    if (m->count == MOST_ROWS)
        return tsv_refuse(t, "more than %d kernels", MOST_ROWS);
    m->rows = grow(m->rows, m->count, sizeof r);
    m->rows[m->count++] = r;
    return true;
}

static bool has_fields(const tsv *t, int count)
{
    return t->count == count
        || tsv_refuse(t, "%d fields, not %d, in a line that starts with %s", t->count, count, t->fields[0]);
}

static bool read_bench_line(tsv *t, machine *m, bool *known)
{
    const char *what = t->fields[0];
    if (*what == '#')
        return read_metadata(t, m, known);
    if (!*known)
        return tsv_refuse(t, "not what facet-bench --tsv writes: no line \"# facet-bench<tab>1\" before");
    if (!strcmp(what, "peak"))
        return has_fields(t, 4) && read_peak(t, m);
    if (!strcmp(what, "kernel"))
        return has_fields(t, 17) && read_kernel(t, m);
    return tsv_refuse(t, "'%.40s' is neither kernel nor peak", what);
}

static bool same_kernel(const kernel_row *a, const kernel_row *b)
{
    return !strcmp(a->kernel, b->kernel) && !strcmp(a->tier, b->tier) && !strcmp(a->arch, b->arch);
}

/* Tiles of 256 samples whose streams stand apart are what renderers are told to use. */
static int rank_of_call(const kernel_row *r)
{
    return 2 * !strcmp(r->size, "256") + !strcmp(r->layout, "staggered");
}

/* Of rows that differ in size and layout alone, charts show the one of the highest rank, the first of several. */
static void choose_charted(machine *m)
{
    for (int i = 0; i < m->count; i++) {
        kernel_row *r = &m->rows[i];
        r->charted = true;
        for (int k = 0; k < i && r->charted; k++) {
            kernel_row *other = &m->rows[k];
            if (!other->charted || !same_kernel(other, r))
                continue;
            r->charted = rank_of_call(r) > rank_of_call(other);
            other->charted = !r->charted;
        }
    }
}

bool chart_read_bench(chart_data *d, const char *path)
{
    tsv t;
    machine m = { .path = path, .date = "date unknown", .cpu = "CPU unknown", .compiler = "compiler unknown",
                  .command = "command unknown" };
    bool known = false;
    int count;
    if (!tsv_open(&t, path))
        return false;
    while ((count = tsv_next(&t)) > 0)
        if (!read_bench_line(&t, &m, &known))
            return false;
    if (count < 0)
        return false;
    if (!m.count)
        return console_error("%s: no kernel in it", path);
    choose_charted(&m);
    d->machines = grow(d->machines, d->machine_count, sizeof m);
    d->machines[d->machine_count++] = m;
    return true;
}

/* The CPU; where another has the same the compiler too; where that is the same as well the file. */
void chart_name_machines(chart_data *d)
{
    for (int i = 0; i < d->machine_count; i++) {
        machine *m = &d->machines[i];
        bool same_cpu = false, same_compiler = false;
        for (int k = 0; k < d->machine_count; k++) {
            const machine *other = &d->machines[k];
            const bool same = k != i && !strcmp(other->cpu, m->cpu);
            same_cpu |= same;
            same_compiler |= same && !strcmp(other->compiler, m->compiler);
        }
        snprintf(m->name, sizeof m->name, "%s%s%s%s%s", m->cpu, same_cpu ? ", " : "", same_cpu ? m->compiler : "",
                 same_compiler ? ", " : "", same_compiler ? m->path : "");
    }
}

/* ---- Errors ---------------------------------------------------------------------------------------------------- */

static bool read_ladder(tsv *t, chart_data *d)
{
    char *const *f = t->fields;
    d->ladders = grow(d->ladders, d->ladder_count, sizeof *d->ladders);
    d->ladders[d->ladder_count++] = (ladder){ .name = f[1], .title = f[2], .truth = f[3], .stated = f[4] };
    return true;
}

static bool read_model(tsv *t, chart_data *d)
{
    ladder *l = d->ladder_count ? &d->ladders[d->ladder_count - 1] : NULL;
    char *const *f = t->fields;
    model m = { .kernel = f[2], .tier = strcmp(f[3], "-") ? f[3] : NULL, .label = f[4] };
    if (!l || strcmp(l->name, t->fields[1]))
        return tsv_refuse(t, "a model of '%.40s', but no such ladder is before it", t->fields[1]);
    if (!tsv_number(t, 5, "the worst", 0, any, &m.worst) || !tsv_number(t, 6, "the mean", 0, any, &m.mean))
        return false;
    l->models = grow(l->models, l->count, sizeof m);
    l->models[l->count++] = m;
    return true;
}

static bool read_panel(tsv *t, chart_data *d)
{
    char *const *f = t->fields;
    d->panels = grow(d->panels, d->panel_count, sizeof *d->panels);
    d->panels[d->panel_count++] = (failure_panel){ .name = f[1], .title = f[2], .x = f[3], .stated = f[4] };
    return true;
}

static bool read_point(tsv *t, chart_data *d)
{
    failure_panel *p = d->panel_count ? &d->panels[d->panel_count - 1] : NULL;
    failure_point at;
    if (!p || strcmp(p->name, t->fields[1]))
        return tsv_refuse(t, "a point of '%.40s', but no such panel is before it", t->fields[1]);
    if (!tsv_number(t, 2, "x", 1e-300, 1e300, &at.x) || !tsv_number(t, 3, "the textbook's error", 0, any, &at.textbook)
        || !tsv_number(t, 4, "the share", 0, 1, &at.lost) || !tsv_number(t, 5, "facet's error", 0, any, &at.facet))
        return false;
    if (isnan(at.x))
        return tsv_refuse(t, "no x");
    p->points = grow(p->points, p->count, sizeof at);
    p->points[p->count++] = at;
    return true;
}

static bool read_error_line(tsv *t, chart_data *d)
{
    static const struct { const char *word; int fields; bool (*read)(tsv *, chart_data *); } kinds[] = {
        { "ladder", 5, read_ladder }, { "model", 7, read_model },
        { "panel", 5, read_panel }, { "point", 6, read_point },
    };
    if (*t->fields[0] == '#')
        return true;
    for (size_t i = 0; i < sizeof kinds / sizeof kinds[0]; i++) {
        if (strcmp(t->fields[0], kinds[i].word))
            continue;
        return has_fields(t, kinds[i].fields) && kinds[i].read(t, d);
    }
    return tsv_refuse(t, "'%.40s' is none of ladder, model, panel and point", t->fields[0]);
}

bool chart_read_errors(chart_data *d, const char *path)
{
    tsv t;
    int count;
    if (!tsv_open(&t, path))
        return false;
    while ((count = tsv_next(&t)) > 0)
        if (!read_error_line(&t, d))
            return false;
    return count == 0;
}

/* ---- Questions ------------------------------------------------------------------------------------------------- */

double row_speed(const kernel_row *r)
{
    return 1e9 / r->ns;
}

bool is_baseline(const kernel_row *r)
{
    return !strcmp(r->tier, "baseline");
}

bool is_workload(const machine *m, const char *kernel)
{
    static const char *const words[] = { "tile", "diffuse", "metal", "plastic", "lights", "full", "frame", "packed",
                                         "packed-pixels" };
    for (size_t i = 0; i < sizeof words / sizeof words[0]; i++)
        if (!strcmp(kernel, words[i]))
            return true;
    for (int i = 0; i < m->count; i++)
        if (is_baseline(&m->rows[i]) && !strcmp(m->rows[i].kernel, kernel))
            return true;
    return false;
}

const kernel_row *find_row(const machine *m, const char *kernel, const char *tier, const char *arch)
{
    for (int i = 0; i < m->count; i++) {
        const kernel_row *r = &m->rows[i];
        if (r->charted && !strcmp(r->kernel, kernel) && !strcmp(r->tier, tier) && !strcmp(r->arch, arch))
            return r;
    }
    return NULL;
}

const kernel_row *fastest_row(const machine *m, const char *kernel, const char *tier)
{
    const kernel_row *best = NULL;
    for (int i = 0; i < m->count; i++) {
        const kernel_row *r = &m->rows[i];
        if (!r->charted || is_baseline(r) || strcmp(r->kernel, kernel) || (tier && strcmp(r->tier, tier)))
            continue;
        if (!best || r->ns < best->ns)
            best = r;
    }
    return best;
}

double times_textbook(const machine *m, const char *kernel)
{
    const kernel_row *best = fastest_row(m, kernel, NULL), *literal = find_row(m, kernel, "baseline", "literal");
    if (best && !isnan(best->x_literal))
        return best->x_literal;
    return best && literal ? literal->ns / best->ns : NAN;
}
