/* The elementary functions of src/elementary.tmpl.h, on every architecture and tier, against libm's in double: what
 * those lose, an ulp or so, is below 2^-27 of the unit that counts here, 2^-24. A function of one variable is measured
 * at every float of its domain. */
#include "elementary.h"

#include "bits.h"
#include "harness.h"
#include "targets.h"

#include <float.h>
#include <inttypes.h>
#include <math.h>
#include <pthread.h>
#include <string.h>
#include <unistd.h>

/* How near to its bound the input beside it must come. */
#define TIGHT 0.98

/* The tables that this build links, by arch and tier. */
#define FACET_ARCH(id, name, ...)                                                                                     \
    extern const elementary_table elementary_##name##_fast __attribute__((weak)),                                     \
        elementary_##name##_strict __attribute__((weak));
#include "arches.def"

static const elementary_table *const tables[][2] = {
#define FACET_ARCH(id, name, ...) [FACET_ARCH_##id] = { &elementary_##name##_fast, &elementary_##name##_strict },
#include "arches.def"
};

static const elementary_table *table_of(facet_target target)
{
    return tables[target.arch][target.tier];
}

/* ---- What each function means ------------------------------------------------------------------------------------ */

/* Most floats are small: below this a series is as exact as libm, and faster. */
#define SMALL 0x1p-20
#define G_0   (M_2_SQRTPI / 4)

static inline double small_exp_minus(double x) { return 1 - x + x * x / 2; }
static inline double small_log1p(double r) { return r * (1 - r * (0.5 - r / 3)); }
static inline double small_arccos(double x) { return M_PI_2 - x; }
static inline double small_ierfc_half(double a) { return G_0 * (1 + a * a) - a / 2; }

static inline double large_exp_minus(double x) { return exp(-x); }
static inline double large_ierfc_half(double a) { return G_0 * exp(-a * a) - a * erfc(a) / 2; }

/* A value, and what its errors are counted in, times 2^24. */
typedef struct { double want, unit; } exact;

static inline exact exact_exp_minus(double x, double unused)
{
    (void)unused;
    const double want = x < SMALL ? small_exp_minus(x) : large_exp_minus(x);
    return want < (double)FLT_MIN ? (exact){ 0, 0 } : (exact){ want, want };
}

static inline exact exact_log1p_ratio(double s, double c)
{
    const double r = s / c, want = r < SMALL ? small_log1p(r) : log1p(r);
    return (exact){ want, want < (double)FLT_MIN ? (double)FLT_MIN : want };
}

static inline exact exact_arccos(double x, double unused)
{
    (void)unused;
    const double want = x < SMALL ? small_arccos(x) : acos(x);
    return (exact){ want, want };
}

static inline exact exact_ierfc_half(double a, double unused)
{
    (void)unused;
    const double want = a < SMALL ? small_ierfc_half(a) : large_ierfc_half(a);
    return (exact){ want, a + want };
}

/* Blocks of inputs. */
enum { BLOCK = 1024 };

#define FILL(name, worst)                                                                                             \
    static void exact_block_##name(const float *a, const float *b, double *want, double *unit)                       \
    {                                                                                                                \
        for (int i = 0; i < BLOCK; i++) {                                                                            \
            const exact e = exact_##name((double)a[i], (double)b[i]);                                                \
            want[i] = e.want, unit[i] = e.unit;                                                                      \
        }                                                                                                            \
    }
ELEMENTARY_FUNCTIONS(FILL, FILL)

static const struct {
    const char *name;
    void (*exact_block)(const float *a, const float *b, double *want, double *unit);
} rows[] = {
#define ROW(name, worst) { #name, exact_block_##name },
    ELEMENTARY_FUNCTIONS(ROW, ROW)
};

static void check_meanings(void)
{
    test("where the series end libm takes over");
    const double x = SMALL;
    const double pairs[][2] = { { small_exp_minus(x), large_exp_minus(x) }, { small_log1p(x), log1p(x) },
                                { small_arccos(x), acos(x) }, { small_ierfc_half(x), large_ierfc_half(x) } };
    for (int i = 0; i < 4; i++)
        expect(fabs(pairs[i][0] / pairs[i][1] - 1) <= 0x1p-50, "%a, not %a", pairs[i][0], pairs[i][1]);
}

/* ---- Measuring --------------------------------------------------------------------------------------------------- */

enum { MOST_THREADS = 16, MOST_TARGETS = 64 };

/* Inputs to measure at, a block of them by its first one's place. */
typedef struct sweep {
    int function;
    void (*fill)(const struct sweep *, uint64_t place, float *a, float *b);
    uint64_t count;
    uint32_t first, stride;                  /* bits of floats */
    float fixed;                             /* the other variable */
    facet_arch arch;                         /* on this alone; FACET_ARCH_BEST: on all */
} sweep;

/* The worst of a target; error in units. */
typedef struct { double error, want; float a, b, got; } finding;

/* Where two strict targets differ. */
typedef struct { bool found; int target; float a, b, got, other; } difference;

/* Every step-th block of a sweep. */
typedef struct {
    const sweep *sweep;
    uint64_t first, step;
    finding worst[MOST_TARGETS];
    difference difference;
} worker;

static double error_of(int function, float got, double want, double unit)
{
    const double off = fabs((double)got - want), error = off == 0 ? 0 : off / unit * 0x1p24;
    const bool subnormal = got > 0 && got < FLT_MIN && function != ELEMENTARY_log1p_ratio;
    return got < 0 || subnormal || isnan(error) ? INFINITY : error;
}

static bool runs(const sweep *s, facet_target target)
{
    return s->arch == FACET_ARCH_BEST || s->arch == target.arch;
}

/* Whether all results of a block are normal floats > 0, and within an error: by sign bits, in loops that compilers turn
 * into vectors. */
static bool all_within(const float *got, const double *want, const double *unit, double error)
{
    double left[BLOCK];
    uint64_t beyond = 0, bits;
    uint32_t odd = 0;
    for (int i = 0; i < BLOCK; i++) left[i] = error * unit[i] - fabs((double)got[i] - want[i]) * 0x1p24;
    for (int i = 0; i < BLOCK; i++) {
        memcpy(&bits, &left[i], sizeof bits);
        beyond |= bits;
    }
    for (int i = 0; i < BLOCK; i++) {
        const uint32_t u = to_bits(got[i]);
        odd |= u | (u - to_bits(FLT_MIN)) | (to_bits(FLT_MAX) - u);
    }
    return !(beyond >> 63) && !(odd >> 31);
}

static void measure(worker *w, int target, const float *a, const float *b, const float *got, const double *want,
                    const double *unit)
{
    finding *worst = &w->worst[target];
    if (all_within(got, want, unit, worst->error)) return;
    for (int i = 0; i < BLOCK; i++) {
        const double error = error_of(w->sweep->function, got[i], want[i], unit[i]);
        if (error > worst->error) *worst = (finding){ error, want[i], a[i], b[i], got[i] };
    }
}

static void compare(worker *w, int target, const float *a, const float *b, const float *got, const float *other)
{
    if (w->difference.found || !memcmp(got, other, BLOCK * sizeof *got)) return;
    int i = 0;
    while (to_bits(got[i]) == to_bits(other[i])) i++;
    w->difference = (difference){ true, target, a[i], b[i], got[i], other[i] };
}

static void *work(void *argument)
{
    worker *w = argument;
    const sweep *s = w->sweep;
    float a[BLOCK], b[BLOCK], got[BLOCK], strict[BLOCK];
    double want[BLOCK], unit[BLOCK];
    for (uint64_t block = w->first; block * BLOCK < s->count; block += w->step) {
        s->fill(s, block * BLOCK, a, b);
        rows[s->function].exact_block(a, b, want, unit);
        bool compared = false;
        for (int t = 0; t < target_count(); t++) {
            const facet_target target = target_at(t);
            if (!runs(s, target)) continue;
            table_of(target)->functions[s->function](a, b, got, BLOCK);
            measure(w, t, a, b, got, want, unit);
            if (target.tier != FACET_TIER_STRICT) continue;
            if (compared) compare(w, t, a, b, got, strict);
            else memcpy(strict, got, sizeof strict);
            compared = true;
        }
    }
    return NULL;
}

/* All of a sweep, by as many threads as there are processors; `all` takes what they find. */
static void run_sweep(const sweep *s, worker *all)
{
    static worker workers[MOST_THREADS];
    const long processors = sysconf(_SC_NPROCESSORS_ONLN);
    const int count = processors < 1 ? 1 : processors > MOST_THREADS ? MOST_THREADS : (int)processors;
    pthread_t threads[MOST_THREADS];
    bool started[MOST_THREADS];
    memset(workers, 0, sizeof workers);
    for (int i = 0; i < count; i++) {
        workers[i].sweep = s, workers[i].first = (uint64_t)i, workers[i].step = (uint64_t)count;
        started[i] = !pthread_create(&threads[i], NULL, work, &workers[i]);
        if (!started[i]) work(&workers[i]);
    }
    for (int i = 0; i < count; i++) {
        if (started[i]) pthread_join(threads[i], NULL);
        for (int t = 0; t < MOST_TARGETS; t++)
            if (workers[i].worst[t].error > all->worst[t].error) all->worst[t] = workers[i].worst[t];
        if (workers[i].difference.found) all->difference = workers[i].difference;
    }
}

/* The sweeps of a function, up to one without a count: a test for each target, and one between them. */
static void check_function(int function, const sweep *sweeps)
{
    static worker all;
    memset(&all, 0, sizeof all);
    for (const sweep *s = sweeps; s->count; s++) run_sweep(s, &all);
    for (int t = 0; t < target_count(); t++) {
        const finding *worst = &all.worst[t];
        const facet_target target = target_at(t);
        const elementary_table *table = table_of(target);
        const double bound = table->worst[function][table->roundings() - 1].bound;
        uint64_t inputs = 0;
        for (const sweep *s = sweeps; s->count; s++) inputs += runs(s, target) ? s->count : 0;
        test("%s: %s at %" PRIu64 " inputs", target_words(target), rows[function].name, inputs);
        expect(worst->error <= bound, "error %.4f at %a, %a: %a, not %a", worst->error, (double)worst->a,
               (double)worst->b, (double)worst->got, worst->want);
    }
    test("%s: strict is the same on every architecture", rows[function].name);
    const difference d = all.difference;
    expect(!d.found, "%s at %a, %a: %a, elsewhere %a", target_words(target_at(d.target)), (double)d.a, (double)d.b,
           (double)d.got, (double)d.other);
}

/* ---- Inputs ------------------------------------------------------------------------------------------------------ */

/* Floats from place to place, up to the last. */
static void fill_floats(const sweep *s, uint64_t place, float *floats)
{
    const int32_t last = (int32_t)(s->count - 1), from = (int32_t)place;
    for (int32_t i = 0; i < BLOCK; i++) {
        const int32_t at = i < last - from ? from + i : last;
        floats[i] = from_bits(s->first + (uint32_t)at * s->stride);
    }
}

static void fill_fixed(const sweep *s, float *floats)
{
    for (int i = 0; i < BLOCK; i++) floats[i] = s->fixed;
}

static void fill_first(const sweep *s, uint64_t place, float *a, float *b)
{
    fill_floats(s, place, a);
    fill_fixed(s, b);
}

static void fill_second(const sweep *s, uint64_t place, float *a, float *b)
{
    fill_fixed(s, a);
    fill_floats(s, place, b);
}

/* s of any magnitude up to 4, or within three octaves of c; c below 2. */
static void fill_pairs(const sweep *s, uint64_t place, float *a, float *b)
{
    test_random r = { place };
    (void)s;
    for (int i = 0; i < BLOCK; i++) {
        const uint64_t bits = random_u64(&r), more = random_u64(&r);
        const uint32_t octave = 1u << 23, c = (uint32_t)(4 * octave + bits % (124 * octave));
        const uint32_t any = (uint32_t)(more % to_bits(4)), near = (uint32_t)(c - 3 * octave + more % (6 * octave));
        b[i] = from_bits(c);
        a[i] = from_bits(bits >> 63 ? any : near < to_bits(4) ? near : to_bits(4));
    }
}

/* All floats from `first` to `last`, on the best architecture, or every stride-th, on all. */
static sweep floats(int function, float first, float last, uint32_t stride)
{
    const uint32_t from = to_bits(first);
    return (sweep){ .function = function, .fill = fill_first, .count = (to_bits(last) - from) / stride + 1,
                    .first = from, .stride = stride, .arch = stride == 1 ? facet_arch_best() : FACET_ARCH_BEST };
}

/* From 0 to `last`. */
static void check_one_variable(int function, float last)
{
    const sweep some = floats(function, 0, last, test_slow_machine ? 20011 : 211), every = floats(function, 0, last, 1);
    check_function(function, (sweep[]){ some, test_slow_machine ? (sweep){ 0 } : every, { 0 } });
}

/* s and c, each over its domain with some of the other, and both at random. */
static void check_log1p_ratio(void)
{
    static const float others[] = { FLT_MIN, 0x1.d458cep-104f, 0x1.fffffep-21f, 0x1.e1d66ap-2f, 0x1.fffffep-1f, 4 };
    enum { OTHERS = sizeof others / sizeof others[0] };
    const int f = ELEMENTARY_log1p_ratio;
    const uint32_t stride = test_slow_machine ? 100003 : 4001;
    sweep sweeps[2 * OTHERS + 3] = { { 0 } };
    for (int i = 0; i < OTHERS; i++) {
        sweep *s = &sweeps[2 * i];
        s[0] = floats(f, 0, 4, stride), s[1] = floats(f, FLT_MIN, 4, stride);
        s[0].fixed = s[1].fixed = others[i];
        s[1].fill = fill_second;
    }
    sweep *s = &sweeps[2 * OTHERS];
    s[0] = (sweep){ .function = f, .fill = fill_pairs, .count = test_slow_machine ? 1 << 16 : 1 << 22 };
    if (!test_slow_machine) s[1] = floats(f, 0, 4, 1), s[1].fixed = 1;
    check_function(f, sweeps);
}

/* ---- Single inputs ----------------------------------------------------------------------------------------------- */

typedef struct { float got; double error; } value;

static value value_at(facet_target target, int function, float a, float b)
{
    float as[BLOCK], bs[BLOCK], got[BLOCK];
    double want[BLOCK], unit[BLOCK];
    for (int i = 0; i < BLOCK; i++) as[i] = a, bs[i] = b;
    table_of(target)->functions[function](as, bs, got, BLOCK);
    rows[function].exact_block(as, bs, want, unit);
    return (value){ got[0], error_of(function, got[0], want[0], unit[0]) };
}

/* The inputs that stand beside the bounds; true where the target rounds once. */
static bool check_worst(facet_target target)
{
    const elementary_table *table = table_of(target);
    const int roundings = table->roundings();
    test("%s: the inputs beside the bounds", target_words(target));
    expect(roundings == 2 || target.tier != FACET_TIER_STRICT, "strict, and vf_mad rounds once");
    for (int f = 0; f < ELEMENTARY_COUNT; f++) {
        const elementary_worst w = table->worst[f][roundings - 1];
        const double error = value_at(target, f, w.at[0], w.at[1]).error;
        expect(error <= w.bound && error >= TIGHT * w.bound, "%s at %a, %a: %.4f, bound %.4f", rows[f].name,
               (double)w.at[0], (double)w.at[1], error, w.bound);
    }
    return roundings == 1;
}

/* Where the domain ends, and beyond. */
static void check_ends(facet_target target)
{
    const float pi_2 = value_at(target, ELEMENTARY_arccos, 0, 0).got;
    const float far = value_at(target, ELEMENTARY_ierfc_half, 3.5f, 0).got;
    const struct { int function; float a, b, want; } ends[] = {
        { ELEMENTARY_exp_minus, 0, 0, 1 },
        { ELEMENTARY_exp_minus, -0.0f, 0, 1 },
        { ELEMENTARY_exp_minus, 0x1.5d58ap6f, 0, 0 },
        { ELEMENTARY_exp_minus, 105, 0, 0 },
        { ELEMENTARY_exp_minus, 1e10f, 0, 0 },
        { ELEMENTARY_exp_minus, FLT_MAX, 0, 0 },
        { ELEMENTARY_exp_minus, INFINITY, 0, 0 },
        { ELEMENTARY_exp_minus, NAN, 0, 0 },
        { ELEMENTARY_log1p_ratio, 0, FLT_MIN, 0 },
        { ELEMENTARY_log1p_ratio, 0, 1, 0 },
        { ELEMENTARY_log1p_ratio, 0, 0x1p126f, 0 },
        { ELEMENTARY_arccos, 1, 0, 0 },
        { ELEMENTARY_arccos, 1 + FLT_EPSILON, 0, 0 },
        { ELEMENTARY_arccos, 2, 0, 0 },
        { ELEMENTARY_arccos, INFINITY, 0, 0 },
        { ELEMENTARY_arccos, -0.0f, 0, pi_2 },
        { ELEMENTARY_arccos, -1e-7f, 0, pi_2 },
        { ELEMENTARY_arccos, -1, 0, pi_2 },
        { ELEMENTARY_arccos, -INFINITY, 0, pi_2 },
        { ELEMENTARY_ierfc_half, 0, 0, (float)G_0 },
        { ELEMENTARY_ierfc_half, 5, 0, far },
        { ELEMENTARY_ierfc_half, FLT_MAX, 0, far },
        { ELEMENTARY_ierfc_half, INFINITY, 0, far },
    };
    test("%s: ends of the domains", target_words(target));
    for (size_t i = 0; i < sizeof ends / sizeof ends[0]; i++) {
        const float got = value_at(target, ends[i].function, ends[i].a, ends[i].b).got;
        expect(to_bits(got) == to_bits(ends[i].want), "%s at %a, %a: %a, not %a", rows[ends[i].function].name,
               (double)ends[i].a, (double)ends[i].b, (double)got, (double)ends[i].want);
    }
    for (int f = 0; f < ELEMENTARY_COUNT; f++)
        expect(f == ELEMENTARY_log1p_ratio || isfinite(value_at(target, f, NAN, 0).got), "%s of a NaN", rows[f].name);
}

void suite_elementary(void)
{
    bool fused = false;
    for (int t = 0; t < target_count(); t++) {
        fused = check_worst(target_at(t)) || fused;
        check_ends(target_at(t));
    }
    if (!fused) {
        test("bounds where vf_mad rounds once");
        skip("it rounds twice in all targets of this build");
    }
    check_meanings();
    check_one_variable(ELEMENTARY_exp_minus, 104);
    check_log1p_ratio();
    check_one_variable(ELEMENTARY_arccos, 1);
    check_one_variable(ELEMENTARY_ierfc_half, 4);
}
