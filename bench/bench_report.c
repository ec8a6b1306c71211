#include "bench_report.h"
#include "bench_machine.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

/* ---- The machine ------------------------------------------------------------------------------------------------- */

/* A cell of that width; what is not known is a dash. */
static void cell(int width, int digits, double value, const char *unit)
{
    if (isnan(value)) printf(" %*s", width, "-");
    else printf(" %*.*f%s", width - (int)strlen(unit), digits, value, unit);
}

/* A ratio, to three digits or so. */
static void times(double value)
{
    cell(9, value < 0.1 ? 4 : value < 10 ? 3 : value < 100 ? 2 : 1, value, "");
}

static void scientific(int width, double value)
{
    if (isnan(value)) printf(" %*s", width, "-");
    else printf(" %*.1e", width, value);
}

static double peak_on(const char *what, const char *arch)
{
    char name[64];
    snprintf(name, sizeof name, "%s_%s", what, arch);
    return machine_peak_of(name);
}

static void print_machine(void)
{
    static const char *const columns[] = { "add", "divide", "sqrt", "load", "store" };
    enum { COLUMNS = sizeof columns / sizeof columns[0] };
    const double clock = machine_peak_of("clock");
    char cpu[256];
    results_cpu(cpu, sizeof cpu);
    printf("%s at %.2f GHz; library by %s\n", cpu, 1e-9 * clock, results_compiler);
    if (*contenders_skipped()) printf("skipped: %s\n", contenders_skipped());
    printf("\nfloats a cycle  multiply");
    for (int i = 0; i < COLUMNS; i++) printf(" %8s", columns[i]);
    printf("\n");
    for (int arch = FACET_ARCH_BEST + 1; facet_word(FACET_KIND_ARCH, arch); arch++) {
        const char *word = facet_word(FACET_KIND_ARCH, arch);
        if (isnan(peak_on("add", word))) continue;
        printf("%-14s  %8.2f", word, fmax(peak_on("fma", word), peak_on("multiply", word)) / clock);
        for (int i = 0; i < COLUMNS; i++) cell(8, 2, peak_on(columns[i], word) / clock, "");
        printf("%s\n", isnan(peak_on("fma", word)) ? "" : "   a multiplication with an addition is one");
    }
    printf("copy: %.1f GB/s in L2", 1e-9 * machine_peak_of("copy_l2"));
    if (!isnan(machine_peak_of("copy_memory"))) printf(", %.1f GB/s in memory", 1e-9 * machine_peak_of("copy_memory"));
    printf(" (bytes read and written)\n");
}

/* ---- Workloads --------------------------------------------------------------------------------------------------- */

static const char *size_word(size_t size)
{
    for (int i = 0; i < SIZES; i++)
        if (sizes[i] == size) return size_words[i];
    return "?";
}

static void print_who(const result *r)
{
    const bool other = !strcmp(r->tier, "baseline");
    printf("  %-9s %-6s", r->arch, other ? "" : r->tier);
}

static void print_row(const result *r, const work *w)
{
    print_who(r);
    cell(9, 3, r->ns, "");
    cell(7, 1, 100 * r->spread, " %");
    cell(8, 2, r->cycles, "");
    cell(8, 1, 1e3 / r->ns, "");
    if (w->beside) times(r->faster_beside);
    for (int i = 0; i < FASTER && !w->beside; i++) times(r->faster[i]);
    cell(6, 0, 100 * r->fraction, " %");
    printf(" %-6s", r->bound_by);
    scientific(8, r->error);
    scientific(8, r->p999);
    printf("\n");
}

/* What a column compares with: "x frame", or "x 512" and the baseline of that width. */
static void label(char *text, size_t size, int column, const contender *rival)
{
    static const int bits[FASTER] = { [FASTER_256] = 256, [FASTER_512] = 512 };
    if (column == FASTER_LITERAL) snprintf(text, size, "x literal");
    else snprintf(text, size, "x %d", rival ? rival->baseline->bits : bits[column]);
}

static void print_heading(const contender *first, int count)
{
    char text[16];
    const char *beside = first->work->beside;
    printf("%18s %9s %7s %8s %8s", "", "ns/sample", "+-", "cycles", "M/s");
    if (beside) printf("   x %5s", beside);
    for (int i = 0; i < FASTER && !beside; i++) {
        label(text, sizeof text, i, results_rival(first, count, i));
        printf(" %9s", text);
    }
    printf(" %6s %-6s %8s %8s\n", "bound", "by", "worst", "p99.9");
}

static void print_rivals(const contender *first, int count)
{
    char text[16];
    for (int i = FASTER_256; i < FASTER; i++) {
        const contender *rival = results_rival(first, count, i);
        label(text, sizeof text, i, rival);
        if (rival) printf("  %s: %s\n", text, rival->baseline->name);
    }
}

static void print_group(const contender *first, const result *rows, int count)
{
    const work *w = first->work;
    printf("\n%s%s%s\n%s samples a call, %s, %g bytes a sample, %d rounds\n", w->name, w->title ? ": " : "",
           w->title ? w->title : "", size_word(rows->size), rows->layout, rows->bytes, first->ns.count);
    print_heading(first, count);
    for (int i = 0; i < count; i++) print_row(&rows[i], w);
    print_rivals(first, count);
}

/* ---- Sizes and layouts ------------------------------------------------------------------------------------------- */

/* The groups of a work, `count` contenders each; they stand together. */
static int groups_of(const contenders *c, int first, int count)
{
    int groups = 0;
    for (int i = first; i < c->count && c->all[i].work == c->all[first].work; i += count) groups++;
    return groups;
}

/* The one that is printed in full: 256 samples, staggered; or the first. */
static int main_group(const contenders *c, int first, int groups, int count)
{
    for (int i = 0; i < groups; i++) {
        const contender *one = &c->all[first + i * count];
        if (one->size == SIZE_L1 && one->layout == STAGGERED) return first + i * count;
    }
    return first;
}

static void print_sizes(const result *rows, int groups, int count)
{
    printf("%18s", "ns/sample");
    for (int i = 0; i < groups; i++) printf(" %9s", size_word(rows[i * count].size));
    printf("  samples a call\n%18s", "");
    for (int i = 0; i < groups; i++) printf(" %9s", rows[i * count].layout);
    printf("\n");
    for (int k = 0; k < count; k++) {
        print_who(&rows[k]);
        for (int i = 0; i < groups; i++) cell(9, 3, rows[i * count + k].ns, "");
        printf("\n");
    }
}

/* All of a work; returns how many contenders it has. */
static int print_work(const contenders *c, const results *r, int first)
{
    const int count = contenders_group(c, first), groups = groups_of(c, first, count);
    const int chosen = main_group(c, first, groups, count);
    print_group(&c->all[chosen], &r->rows[chosen], count);
    if (groups > 1 && c->all[first].work->title) print_sizes(&r->rows[first], groups, count);
    return groups * count;
}

void report_print(const contenders *c, const results *r)
{
    print_machine();
    for (int i = 0; i < c->count;) i += print_work(c, r, i);
}
