#include "bench_rounds.h"
#include "bench_machine.h"
#include "console.h"

#include <math.h>

/* Visits are so short that about ROUNDS_AIMED_AT fit, and there are no more than MOST_ROUNDS. What comes from memory
 * takes long, a call each, and gets that share of the time beside what does not. */
enum { LEAST_ROUNDS = 25, LEAST_FROM_MEMORY = 3, ROUNDS_AIMED_AT = 600, MOST_ROUNDS = 4000 };
static const double share = 0.3, least_visit = 1e-5, most_visit = 2e-4;

/* How long all may take. */
typedef struct { double start, seconds; } budget;

/* Either what comes from memory or what does not. */
typedef struct {
    contenders *all;
    bool memory;
    int count, rounds;           /* contenders; rounds of all of them */
    double spent;                /* seconds */
} league;

static bool belongs(const league *l, int i) { return (l->all->all[i].size == SIZE_MEMORY) == l->memory; }

static league league_of(contenders *c, bool memory)
{
    league l = { .all = c, .memory = memory };
    for (int i = 0; i < c->count; i++) l.count += belongs(&l, i);
    return l;
}

/* As many calls as take that long; none of a frame. */
static void choose_calls(contender *c, double seconds)
{
    double took = 0;
    c->calls = 1;
    while (c->size != SIZE_MEMORY && (took = contender_visit(c)) < seconds / 2) c->calls *= 2;
    if (took > 0) c->calls = (long)fmax(1, (double)c->calls * seconds / took);
}

/* What it shades has been elsewhere in the meantime: the first call brings it back, and does not count. */
static void take_turn(contender *c, double clock)
{
    const long calls = c->calls;
    c->calls = 1;
    if (c->size != SIZE_MEMORY) contender_visit(c);
    c->calls = calls;
    const double ns = 1e9 * contender_visit(c) / ((double)calls * (double)c->batch.count);
    const facet_arch arch = c->baseline ? machine_arch(c->baseline->bits) : c->target.arch;
    bound_by by;
    series_add(&c->ns, ns);
    series_add(&c->cycles, ns * clock);
    series_add(&c->fraction, machine_bound(c->work, arch, c->size, &by) / ns);
}

/* Each begins with another of its contenders every time. */
static void run_group(contender *first, int count, int round)
{
    const double clock = machine_clock();
    for (int i = 0; i < count; i++) take_turn(&first[(i + round) % count], clock);
}

static double elapsed(budget b) { return console_seconds() - b.start; }

static void show_progress(budget b)
{
    const double done = fmin(elapsed(b), b.seconds);
    console_progress("timing", (size_t)(1000 * done), (size_t)fmax(1, 1000 * b.seconds));
}

static void run_round(league *l, budget b)
{
    const double start = console_seconds();
    machine_measure();
    if (l->memory) machine_measure_memory();
    for (int i = 0, count; i < l->all->count; i += count) {
        count = contenders_group(l->all, i);
        if (!belongs(l, i)) continue;
        run_group(&l->all->all[i], count, l->rounds);
        show_progress(b);
    }
    l->rounds++;
    l->spent += console_seconds() - start;
}

static bool has_time(const league *l, budget b)
{
    if (!l->count || l->rounds == MOST_ROUNDS) return false;
    const double next = l->rounds ? l->spent / l->rounds : 0;
    return l->rounds < (l->memory ? LEAST_FROM_MEMORY : LEAST_ROUNDS) || elapsed(b) + next < b.seconds;
}

bool rounds_run(contenders *c, double seconds)
{
    const budget b = { console_seconds(), seconds };
    league cached = league_of(c, false), memory = league_of(c, true);
    if (!machine_start(memory.count)) return console_error("not enough memory for the copy");
    const double visits = (double)ROUNDS_AIMED_AT * cached.count + 1;
    const double visit = fmin(fmax(seconds / visits, least_visit), most_visit);
    for (int i = 0; i < c->count; i++) choose_calls(&c->all[i], visit);
    for (;;) {
        const bool cached_can = has_time(&cached, b), memory_can = has_time(&memory, b);
        if (!cached_can && !memory_can) return true;
        const bool turn = memory.spent <= share * (memory.spent + cached.spent);
        run_round(memory_can && (turn || !cached_can) ? &memory : &cached, b);
    }
}
