#include "bench_machine.h"
#include "bench_series.h"
#include "console.h"
#include "peaks.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

const char *const bound_words[BOUNDS] = { "fma", "divide", "sqrt", "load", "store", "memory" };
static const char *const peak_words[PEAK_COUNT] = { "fma", "add", "divide", "sqrt", "load", "store", "clock" };

#define PEAKS(arch) extern const peak_table peaks_##arch;
#include "built.def"

static const peak_table *const tables[] = {
#define PEAKS(arch) &peaks_##arch,
#include "built.def"
};

enum { TABLES = sizeof tables / sizeof tables[0] };

/* Operations, or bytes, a second: now, and in every round. */
typedef struct {
    double now;
    series all;
    long passes;                 /* 0: not measured */
} peak;

static peak peaks[TABLES][PEAK_COUNT], copy_l2, copy_memory;

static const double visit = 8e-6;                                                /* seconds */
static const size_t l2_bytes = (size_t)128 << 10, memory_bytes = (size_t)64 << 20;
static char *from, *to;

/* ---- Tables ------------------------------------------------------------------------------------------------------ */

static bool is_here(int table) { return facet_has(FACET_KIND_ARCH, facet_value(FACET_KIND_ARCH, tables[table]->arch)); }

static int table_of(facet_arch arch)
{
    for (int i = 0; i < TABLES; i++)
        if (is_here(i) && facet_value(FACET_KIND_ARCH, tables[i]->arch) == (int)arch) return i;
    return -1;
}

facet_arch machine_arch(int bits)
{
    facet_arch found = FACET_ARCH_BEST;
    for (int arch = FACET_ARCH_BEST + 1; facet_word(FACET_KIND_ARCH, arch); arch++) {
        const int table = table_of((facet_arch)arch);
        if (table >= 0 && 32 * tables[table]->lanes == bits) found = (facet_arch)arch;
    }
    return found;
}

static const peak_table *widest(void)
{
    const peak_table *found = tables[0];
    for (int i = 0; i < TABLES; i++)
        if (is_here(i) && tables[i]->lanes > found->lanes) found = tables[i];
    return found;
}

/* ---- Measuring --------------------------------------------------------------------------------------------------- */

static double seconds_of(int table, int which, long passes)
{
    const double start = console_seconds();
    tables[table]->run[which](passes);
    return console_seconds() - start;
}

static void keep(peak *p, double value)
{
    p->now = value;
    series_add(&p->all, value);
}

/* Operations of a lane; of the clock, cycles. */
static void measure(int table, int which)
{
    peak *p = &peaks[table][which];
    const long lanes = which == PEAK_CLOCK ? 1 : tables[table]->lanes, done = lanes * PEAK_OPERATIONS * p->passes;
    keep(p, (double)done / seconds_of(table, which, p->passes));
}

/* Bytes read and written; by memcpy or by a loop, whichever is faster. */
static void measure_copy(peak *p, size_t bytes)
{
    const peak_table *vectors = widest();
    const double start = console_seconds();
    for (long i = 0; i < p->passes; i++) memcpy(to, from, bytes);
    const double middle = console_seconds();
    for (long i = 0; i < p->passes; i++) vectors->copy(to, from, bytes);
    const double least = fmin(middle - start, console_seconds() - middle);
    keep(p, 2 * (double)bytes * (double)p->passes / least);
}

static void choose_passes(int table, int which)
{
    seconds_of(table, which, 10);
    peaks[table][which].passes = (long)fmax(1, visit / (seconds_of(table, which, 10) / 10));
}

bool machine_start(bool memory)
{
    const size_t bytes = memory ? memory_bytes : l2_bytes;
    from = aligned_alloc(4096, bytes);
    to = aligned_alloc(4096, bytes);
    if (!from || !to) return false;
    memset(from, 1, bytes);
    memset(to, 2, bytes);
    copy_l2.passes = 4;
    copy_memory.passes = memory;
    for (int table = 0; table < TABLES; table++)
        for (int which = 0; is_here(table) && which < PEAK_COUNT; which++) choose_passes(table, which);
    return true;
}

void machine_measure(void)
{
    for (int table = 0; table < TABLES; table++)
        for (int which = 0; which < PEAK_CLOCK; which++)
            if (peaks[table][which].passes) measure(table, which);
    measure_copy(&copy_l2, l2_bytes);
}

void machine_measure_memory(void) { measure_copy(&copy_memory, memory_bytes); }

double machine_clock(void)
{
    measure(0, PEAK_CLOCK);
    return 1e-9 * peaks[0][PEAK_CLOCK].now;
}

/* ---- What was measured ------------------------------------------------------------------------------------------- */

static bool describe(machine_peak *out, const peak *p, const char *word, const char *arch, const char *unit)
{
    snprintf(out->name, sizeof out->name, "%s%s%s", word, *arch ? "_" : "", arch);
    out->value = series_median(&p->all);
    out->unit = unit;
    return true;
}

/* Those that were not measured are left out. */
bool machine_peak_at(int index, machine_peak *out)
{
    for (int table = 0; table < TABLES; table++)
        for (int which = 0; which < PEAK_CLOCK; which++)
            if (peaks[table][which].all.count && !index--)
                return describe(out, &peaks[table][which],
                                which == PEAK_FMA && !tables[table]->fused ? "multiply" : peak_words[which],
                                tables[table]->arch, "lanes/s");
    if (copy_l2.all.count && !index--) return describe(out, &copy_l2, "copy_l2", "", "bytes/s");
    if (copy_memory.all.count && !index--) return describe(out, &copy_memory, "copy_memory", "", "bytes/s");
    if (peaks[0][PEAK_CLOCK].all.count && !index--)
        return describe(out, &peaks[0][PEAK_CLOCK], "clock", "", "cycles/s");
    return false;
}

double machine_peak_of(const char *name)
{
    machine_peak p;
    for (int i = 0; machine_peak_at(i, &p); i++)
        if (!strcmp(p.name, name)) return p.value;
    return NAN;
}

/* ---- The bound --------------------------------------------------------------------------------------------------- */




/* Seconds of arithmetic. The multipliers and the adders work side by side, and so does the divider; but where that
 * takes longest, the multipliers take over as much of its work as lets both end together. */
static double arithmetic(const operations *o, const peak_table *table, const peak *p, bound_by *by)
{
    const double multiply = 1 / p[PEAK_FMA].now, add = 1 / p[PEAK_ADD].now;
    const int additions = o->add + (table->fused ? 0 : o->multiply_add);
    const double ports = fmax((o->multiply + o->multiply_add) * multiply, additions * add);
    const double quotients = o->divide / p[PEAK_DIVIDE].now, roots = o->sqrt / p[PEAK_SQRT].now;
    const double divider = quotients + roots;
    const double instead = (BOUND_QUOTIENT * o->divide + BOUND_ROOT * o->sqrt) * multiply;
    *by = divider <= ports ? BY_FMA : quotients >= roots ? BY_DIVIDE : BY_SQRT;
    return divider <= ports ? ports : (ports + instead) / (1 + instead / divider);
}

static void raise(double *most, bound_by *by, double seconds, bound_by what)
{
    if (!(seconds > *most)) return;
    *most = seconds;
    *by = what;
}

double machine_bound(const work *w, facet_arch arch, int size, bound_by *by)
{
    const int table = table_of(arch);
    const double bytes = work_reads(w) + work_writes(w);
    const double loads = work_reads(w) / (double)sizeof(float), stores = work_writes(w) / (double)sizeof(float);
    if (table < 0 || !w->operations.multiply) return NAN;
    const peak *p = peaks[table], *copy = size == SIZE_MEMORY ? &copy_memory : &copy_l2;
    double most = arithmetic(&w->operations, tables[table], p, by);
    raise(&most, by, loads / p[PEAK_LOAD].now, BY_LOAD);
    raise(&most, by, stores / p[PEAK_STORE].now, BY_STORE);
    if (size >= SIZE_L2) raise(&most, by, bytes / copy->now, BY_MEMORY);
    return 1e9 * most;
}
