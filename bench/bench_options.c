#include "bench_options.h"
#include "bench_machine.h"
#include "bench_work.h"
#include "command_line.h"
#include "console.h"

#include <stdio.h>
#include <string.h>

/* ---- Readers ----------------------------------------------------------------------------------------------------- */

static int find_size(const char *text, size_t length)
{
    for (int i = 0; i < SIZES; i++)
        if (strlen(size_words[i]) == length && !strncmp(size_words[i], text, length)) return i;
    return -1;
}

/* One of them, or several with commas. */
static bool read_sizes(void *to, const setting *s, const char *text)
{
    bench_options *o = to;
    const char *at = text;
    o->sizes = 0;
    for (;;) {
        const size_t length = strcspn(at, ",");
        const int size = find_size(at, length);
        if (size < 0) return setting_refuse(s, text, "16, 256, 4096, 4M, or several of them with commas");
        o->sizes |= 1u << size;
        if (!at[length]) return true;
        at += length + 1;
    }
}

static bool read_fresh(void *to, const char *text)
{
    bench_options *o = to;
    if (o->fresh) return console_error("%.80s: one table is allowed, and it is %.80s", text, o->fresh);
    o->fresh = text;
    return true;
}

/* ---- The table --------------------------------------------------------------------------------------------------- */

#define FIELD(name) .offset = offsetof(bench_options, name)

static const setting table[] = {
    { "--filter", "TEXT", "only what has TEXT in its name, kernels of the table too, and what that is compared with",
      read_text, FIELD(filter) },
    { "--all", NULL, "every kernel of the table (models x tier x arch), not the workloads alone", read_switch,
      FIELD(all) },
    { "--arch", "WORD", "of the library this architecture alone", read_word, FIELD(arch), .kind = FACET_KIND_ARCH },
    { "--size", "LIST", "samples a call, of 16, 256 (L1), 4096 (L2) and 4M (memory), with commas\n"
      "(16,256,4096 and, of frame and packed, 4M)", .read = read_sizes },
    { "--seconds", "N", "how long it may take, but for a few rounds (60)", read_number, FIELD(seconds),
      .limits = { 0, 86400 } },
    { "--tsv", "FILE", "write all of it as a table", read_text, FIELD(tsv) },
    { "--compare", "OLD", "say what is faster or slower than in a table that --tsv wrote; with NEW, in that table\n"
      "instead of a new run", read_text, FIELD(old) },
    { "--errors", "FILES", "tables of errors, with commas (tests/accuracy.tsv,build/baselines.tsv)", read_text,
      FIELD(errors) },
    { "--help", NULL, "this", read_switch, FIELD(help) },
};

static settings group_of(bench_options *o)
{
    return (settings){ "Options", table, sizeof table / sizeof table[0], o };
}

bool bench_options_read(bench_options *o, int count, char **arguments)
{
    *o = (bench_options){ .arch = -1, .seconds = 60, .errors = "tests/accuracy.tsv,build/baselines.tsv" };
    const settings group = group_of(o);
    if (!command_line_read(&group, 1, count, arguments, read_fresh, o)) return false;
    if (o->fresh && !o->old) return console_error("%.80s: a table to compare, but nothing to compare with: --compare",
                                                  o->fresh);
    return true;
}

/* ---- Help -------------------------------------------------------------------------------------------------------- */

void bench_options_help(void)
{
    bench_options o;
    const settings group = group_of(&o);
    printf("usage: facet-bench [options] [NEW]\n\n"
           "Times the kernels of facet %s and, in the same rounds, the same functions as one would write them\n"
           "otherwise. Ratios are medians over the rounds of what both took in a round; +- is half the distance\n"
           "between the quartiles.\n\n", facet_version());
    command_line_help(&group, 1);
    printf("\nWorkloads\n");
    for (int i = 0; work_at(i); i++)
        if (work_at(i)->title) printf("  %-13s %s\n", work_at(i)->name, work_at(i)->title);
    printf("\nBaselines\n"
           "  literal    the textbook's shader, step by step: acosf, tanf, powf, normalize; -O2\n"
           "  gcc-256 .. branch-free C over arrays, for that compiler's vectoriser at that many bits: -O3\n"
           "  clang-512  -ffast-math -march=native; x 256 and x 512 compare with whichever compiler's is faster\n"
           "  ispc       the same in ISPC, of tile, where there was an ispc\n"
           "  x frame    of packed and packed-pixels, which no baseline has: how many times as fast as frame, by the\n"
           "             same architecture and tier\n"
           "\n"
           "Bounds\n"
           "  The time that a workload's operations take at the peaks that this run measures, each with a loop that\n"
           "  does one thing on the vectors of that architecture. bench/bench_work.c counts the operations of a\n"
           "  sample, by hand, of the cheapest formula that we know: multiplications (with an addition one, where\n"
           "  the machine has that), additions, divisions, square roots, and the bytes loaded and stored. All units\n"
           "  work side by side, so the slowest counts. Where that is the divider, the multipliers take over as much\n"
           "  of its work as lets both end together: %d multiplications for a quotient (a common denominator), %d for\n"
           "  a root (an estimate and a Newton step). What does not stay in L1 is bound by the copy in the memory\n"
           "  that holds it, too. Clamps and checks count nothing.\n"
           "\n"
           "Errors\n"
           "  Relative (tests/reference.h), where nl and nv are above 5e-4 and alpha is at least 0.01: the worst that\n"
           "  a search has found, and what 99.9 %% of random samples stay within. Of workloads each architecture's,\n"
           "  and each baseline's, from build/baselines.tsv, where the search begins at the worst of\n"
           "  tests/accuracy.tsv; of other kernels from there, the worst of their architectures'. Of packed streams,\n"
           "  before radiance is rounded: of random samples alone.\n",
           BOUND_QUOTIENT, BOUND_ROOT);
}
