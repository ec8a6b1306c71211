#include "bench_results.h"
#include "bench_errors.h"
#include "bench_machine.h"
#include "console.h"

#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/utsname.h>
#include <time.h>

#if defined(__clang__)
const char results_compiler[] = "clang " __clang_version__ " " BENCH_CFLAGS;
#else
const char results_compiler[] = "gcc " __VERSION__ " " BENCH_CFLAGS;
#endif

/* ---- Rows -------------------------------------------------------------------------------------------------------- */

static result *add_row(results *r)
{
    result *grown = realloc(r->rows, (size_t)(r->count + 1) * sizeof *grown);
    if (!grown) {
        console_error("not enough memory for the table");
        exit(EXIT_FAILURE);
    }
    r->rows = grown;
    return &r->rows[r->count++];
}

static bool is_in_column(const baseline *b, int column)
{
    if (!b) return false;
    if (column == FASTER_LITERAL) return b->kind == TEXTBOOK;
    if (b->kind != AUTOVECTORIZED) return false;
    return column == FASTER_512 ? b->bits == 512 : b->bits == 256 || b->bits == 128;
}

const contender *results_rival(const contender *first, int count, int column)
{
    const contender *fastest = NULL;
    for (const contender *c = first; c < first + count; c++)
        if (is_in_column(c->baseline, column) && (!fastest || series_median(&c->ns) < series_median(&fastest->ns)))
            fastest = c;
    return fastest;
}

static const char *tier_of(const contender *c)
{
    return c->baseline ? "baseline" : facet_word(FACET_KIND_TIER, (int)c->target.tier);
}

static const char *arch_of(const contender *c)
{
    return c->baseline ? c->baseline->name : facet_word(FACET_KIND_ARCH, (int)c->target.arch);
}

/* The same target on the workload that it is compared with, or NULL. */
static const contender *beside(const contenders *all, const contender *c)
{
    for (const contender *other = all->all; c->work->beside && other < all->all + all->count; other++)
        if (!strcmp(other->work->name, c->work->beside) && other->size == c->size && other->layout == c->layout
            && !other->baseline && other->target.arch == c->target.arch && other->target.tier == c->target.tier)
            return other;
    return NULL;
}

static void fill_row(result *r, const contender *c, const contender *const rivals[FASTER], const contender *other)
{
    const facet_arch arch = c->baseline ? machine_arch(c->baseline->bits) : c->target.arch;
    const found_error e = c->baseline ? errors_of(c->work, c->baseline->name, "")
                                      : errors_of(c->work, tier_of(c), arch_of(c));
    bound_by by;
    *r = (result){ .size = sizes[c->size], .ns = series_median(&c->ns), .spread = series_spread(&c->ns),
                   .cycles = series_median(&c->cycles), .fraction = series_median(&c->fraction),
                   .bytes = work_reads(c->work) + work_writes(c->work), .error = e.worst, .p999 = e.p999,
                   .faster_beside = other ? series_ratio(&other->ns, &c->ns) : NAN };
    snprintf(r->name, sizeof r->name, "%s", c->work->name);
    snprintf(r->tier, sizeof r->tier, "%s", tier_of(c));
    snprintf(r->arch, sizeof r->arch, "%s", arch_of(c));
    snprintf(r->layout, sizeof r->layout, "%s", layout_words[c->layout]);
    snprintf(r->bound_by, sizeof r->bound_by, "%s",
             isnan(machine_bound(c->work, arch, c->size, &by)) ? "-" : bound_words[by]);
    for (int i = 0; i < FASTER; i++) r->faster[i] = rivals[i] ? series_ratio(&rivals[i]->ns, &c->ns) : NAN;
}

results results_of(const contenders *c)
{
    results r = { 0 };
    for (int i = 0, count; i < c->count; i += count) {
        const contender *rivals[FASTER];
        count = contenders_group(c, i);
        for (int column = 0; column < FASTER; column++)
            rivals[column] = results_rival(&c->all[i], count, column);
        for (const contender *one = &c->all[i]; one < &c->all[i + count]; one++)
            fill_row(add_row(&r), one, rivals, beside(c, one));
    }
    return r;
}

/* ---- The machine ------------------------------------------------------------------------------------------------- */

void results_cpu(char *text, size_t size)
{
    char line[256], name[200];
    struct utsname system;
    snprintf(text, size, "%s", uname(&system) ? "unknown" : system.machine);
    FILE *file = fopen("/proc/cpuinfo", "r");
    if (!file) return;
    while (fgets(line, sizeof line, file))
        if (sscanf(line, "model name : %199[^\n]", name) == 1) {
            snprintf(text, size, "%s", name);
            break;
        }
    fclose(file);
}

/* ---- Tables ------------------------------------------------------------------------------------------------------ */

static void write_number(FILE *file, const char *format, double value)
{
    putc('\t', file);
    if (isnan(value)) putc('-', file);
    else fprintf(file, format, value);
}

static void write_row(FILE *file, const result *r)
{
    fprintf(file, "kernel\t%s\t%s\t%s\t%zu\t%s", r->name, r->tier, r->arch, r->size, r->layout);
    write_number(file, "%.5g", r->ns);
    write_number(file, "%.4f", r->spread);
    write_number(file, "%.5g", r->cycles);
    write_number(file, "%g", r->bytes);
    for (int i = 0; i < FASTER; i++) write_number(file, "%.4g", r->faster[i]);
    write_number(file, "%.4f", r->fraction);
    fprintf(file, "\t%s", r->bound_by);
    write_number(file, "%.3g", r->error);
    write_number(file, "%.3g", r->p999);
    putc('\n', file);
}

static void write_head(FILE *file, const char *command)
{
    char cpu[256], date[32];
    const time_t now = time(NULL);
    results_cpu(cpu, sizeof cpu);
    strftime(date, sizeof date, "%Y-%m-%d", localtime(&now));
    fprintf(file, "# facet-bench\t1\n# date\t%s\n# cpu\t%s\n# compiler\t%s\n# command\t%s\n", date, cpu,
            results_compiler, command);
    if (*contenders_skipped()) fprintf(file, "# skipped\t%s\n", contenders_skipped());
    fputs("# columns\tpeak NAME VALUE UNIT\n# columns\tkernel CASE TIER ARCH SIZE LAYOUT NS SPREAD CYCLES BYTES "
          "X_LITERAL X_256 X_512 FRACTION BOUND_BY ERROR P999\n", file);
    machine_peak p;
    for (int i = 0; machine_peak_at(i, &p); i++) fprintf(file, "peak\t%s\t%.4g\t%s\n", p.name, p.value, p.unit);
}

bool results_writable(const char *path)
{
    FILE *file = fopen(path, "a");
    return (file && !fclose(file)) || console_error("%s: %s", path, strerror(errno));
}

bool results_write(const results *r, const char *path, const char *command)
{
    FILE *file = fopen(path, "w");
    if (!file) return console_error("%s: %s", path, strerror(errno));
    write_head(file, command);
    for (int i = 0; i < r->count; i++) write_row(file, &r->rows[i]);
    const bool written = !ferror(file);
    return (!fclose(file) && written) || console_error("%s: %s", path, strerror(errno));
}

enum { FIELDS = 17 };

static bool copy_field(char *to, size_t size, const char *from)
{
    return *from && (size_t)snprintf(to, size, "%s", from) < size;
}

static bool read_value(const char *text, double *value)
{
    char *end;
    *value = NAN;
    if (!strcmp(text, "-")) return true;
    *value = strtod(text, &end);
    return end != text && !*end && isfinite(*value);
}

static bool read_row(result *r, char *const field[FIELDS])
{
    double size;
    double *const values[] = { &r->ns, &r->spread, &r->cycles, &r->bytes, &r->faster[0], &r->faster[1], &r->faster[2],
                               &r->fraction };
    bool good = copy_field(r->name, sizeof r->name, field[1]) && copy_field(r->tier, sizeof r->tier, field[2])
        && copy_field(r->arch, sizeof r->arch, field[3]) && copy_field(r->layout, sizeof r->layout, field[5])
        && copy_field(r->bound_by, sizeof r->bound_by, field[14]) && read_value(field[4], &size) && size > 0;
    for (int i = 0; good && i < 8; i++) good = read_value(field[6 + i], values[i]);
    r->size = good ? (size_t)size : 0;
    return good && r->ns > 0 && read_value(field[15], &r->error) && read_value(field[16], &r->p999);
}

/* A line that is no row of a kernel is passed over where it is another of a table's. */
static bool read_line(results *r, char *line)
{
    char *field[FIELDS], *at = line;
    int count = 0;
    line[strcspn(line, "\n")] = 0;
    if (line[0] == '#' || !strncmp(line, "peak\t", 5)) return true;
    while (at && count < FIELDS) field[count++] = strsep(&at, "\t");
    return !strcmp(field[0], "kernel") && count == FIELDS && !at && read_row(add_row(r), field);
}

bool results_read(results *r, const char *path)
{
    char line[1024];
    *r = (results){ 0 };
    FILE *file = fopen(path, "r");
    if (!file) return console_error("%s: %s", path, strerror(errno));
    bool good = true;
    for (int number = 1; good && fgets(line, sizeof line, file); number++)
        good = read_line(r, line) || console_error("%s:%d: not a row of a table that --tsv wrote", path, number);
    fclose(file);
    return good && (r->count || console_error("%s: no rows", path));
}

/* ---- Comparison -------------------------------------------------------------------------------------------------- */

static const result *find(const results *r, const result *like)
{
    for (const result *row = r->rows; row < r->rows + r->count; row++)
        if (!strcmp(row->name, like->name) && !strcmp(row->tier, like->tier) && !strcmp(row->arch, like->arch)
            && !strcmp(row->layout, like->layout) && row->size == like->size)
            return row;
    return NULL;
}

/* The baselines' code is the same in both: how many times as fast the machine was in the second run. 1 without any. */
static double machine_change(const results *old, const results *fresh)
{
    series changes = { 0 };
    for (int i = 0; i < fresh->count; i++) {
        const result *now = &fresh->rows[i], *before = find(old, now);
        if (before && !strcmp(now->tier, "baseline")) series_add(&changes, before->ns / now->ns);
    }
    const double change = series_median(&changes);
    free(changes.values);
    return isnan(change) ? 1 : change;
}

static bool print_change(const result *before, const result *now, double machine)
{
    const double faster = before->ns / now->ns / machine, noise = fmax(0.03, before->spread + now->spread);
    if (fabs(log(faster)) <= noise) return false;
    printf("  %-8s %-9s %-48s %7zu %-9s %9.3f -> %8.3f ns  %.3f times as %s\n", now->arch, now->tier, now->name,
           now->size, now->layout, before->ns, now->ns, fmax(faster, 1 / faster), faster > 1 ? "fast" : "slow");
    return true;
}

void results_compare(const results *old, const results *fresh)
{
    const double machine = machine_change(old, fresh);
    int compared = 0, changed = 0;
    if (machine != 1) printf("by the baselines the machine was %.3f times as fast, which is taken out\n", machine);
    for (int i = 0; i < fresh->count; i++) {
        const result *now = &fresh->rows[i], *before = find(old, now);
        if (!before) continue;
        compared++;
        changed += print_change(before, now, machine);
    }
    if (!changed && compared) printf("no change in %d rows\n", compared);
    if (changed)
        printf("%d of %d rows changed by more than their rounds spread, and by 3 %% at least\n", changed, compared);
    if (compared < fresh->count) printf("%d rows are new\n", fresh->count - compared);
    if (compared < old->count) printf("%d rows of the old table have no counterpart\n", old->count - compared);
}
