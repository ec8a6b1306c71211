/* Every operation of every vector layer in this build against plain C (ops.def): exactly, but for NEAR and LOOSE
 * rows. */
#include "bits.h"
#include "half.h"
#include "harness.h"
#include "ops.h"
#include "targets.h"

#include <inttypes.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* ---- What each operation means ----------------------------------------------------------------------------------- */

#define OPERATION(name, shape, meaning)                                                                               \
    static float mean_##name(float a, float b, float c)                                                              \
    {                                                                                                                \
        (void)a, (void)b, (void)c;                                                                                   \
        return meaning;                                                                                              \
    }
#include "ops.def"
#define OPERATION(...)
#define MOVE(...)
#define OPERATOR(...)
#define NEAR(...)
#define LOOSE(...)
#define FUSABLE(name, shape, meaning, fused)                                                                          \
    static float fused_##name(float a, float b, float c) { return fused; }
#include "ops.def"

/* What scalar.h says of vf_div. */
static bool near_quotient(float got, float a, float b, float c)
{
    (void)c;
    if (isnan(a) || isnan(b)) return isnan(got);
    const double q = (double)a / (double)b, size = fabs(q);
    if (!isnormal(b) || !(size < 0x1p127)) return true;
    if (a == 0.0f || (a == 1.0f && b == 1.0f)) return got == a;
    const double place = ldexp(1.0, size < 0x1p-126 ? -149 : ilogb(size) - 23);
    return fabs((double)got - q) <= 0.51 * place + 0x1p-149 / fabs((double)b) && (size > 1.0 || fabsf(got) <= 1.0f);
}

/* What scalar.h says of vf_at_least and vf_at_most. */
static bool is_limited(float got, float a, float b, float want)
{
    return isnan(b) || (isnan(a) ? isnan(got) : got == want);
}
static bool is_larger(float got, float a, float b, float c) { (void)c; return is_limited(got, a, b, a > b ? a : b); }
static bool is_smaller(float got, float a, float b, float c) { (void)c; return is_limited(got, a, b, a < b ? a : b); }

/* Of vf_not_negative. */
static bool is_not_negative(float got, float a, float b, float c)
{
    (void)b, (void)c;
    const bool signalling = isnan(a) && !(to_bits(a) & 0x400000);
    return to_bits(got) == to_bits(a > 0 ? a : 0) || (signalling && isnan(got));
}

typedef float meaning(float a, float b, float c);
typedef bool closeness(float got, float a, float b, float c);

static const struct { const char *name; meaning *plain, *fused; closeness *near, *loose; bool exact; } rows[] = {
#define OPERATION(name, ...) { #name, mean_##name, NULL, NULL, NULL, false },
#define MOVE(name, ...) { #name, mean_##name, NULL, NULL, NULL, true },
#define FUSABLE(name, ...) { #name, mean_##name, fused_##name, NULL, NULL, false },
#define NEAR(name, shape, meaning, near) { #name, mean_##name, NULL, near, NULL, false },
#define LOOSE(name, shape, meaning, near) { #name, mean_##name, NULL, NULL, near, false },
#include "ops.def"
};

/* The tables that this build links, by arch and tier. */
#define FACET_ARCH(id, name, ...)                                                                                     \
    extern const ops_table ops_##name##_fast __attribute__((weak)), ops_##name##_strict __attribute__((weak));
#include "arches.def"

static const ops_table *const tables[][2] = {
#define FACET_ARCH(id, name, ...) [FACET_ARCH_##id] = { &ops_##name##_fast, &ops_##name##_strict },
#include "arches.def"
};

/* ---- Operands ---------------------------------------------------------------------------------------------------- */

static const uint32_t lattice[] = {
    0x00000000, 0x80000000, 0x00000001, 0x80000001, 0x00400000, 0x007fffff, 0x807fffff, 0x00800000, 0x80800000,
    0x00800001, 0x01000000, 0x0d800000, 0x1f800000, 0x33800000, 0x33800001, 0xb3800000, 0x3effffff, 0x3f000000,
    0x3f7ffffe, 0x3f7fffff, 0x3f800000, 0x3f800001, 0x3f800002, 0xbf7fffff, 0xbf800000, 0xbf800001, 0x3fb504f3,
    0x40000000, 0x40400000, 0xc0400000, 0x4b800000, 0x4b800001, 0x5f800000, 0x7f000000, 0x7f7fffff, 0xff7fffff,
    0x7f800000, 0xff800000, 0x7fc00000, 0xffc00000, 0x7f800001, 0xffbfffff, 0x7fedcba9,
};
enum { LATTICE = sizeof lattice / sizeof lattice[0], MARGIN = 64 };

typedef struct { size_t count; float *a, *b, *c, *out; } operands;

/* A normal float around 1: its products and sums neither overflow nor vanish. */
static float around_one(test_random *r)
{
    const uint32_t bits = (uint32_t)random_u64(r);
    return from_bits((bits & 0x807fffff) | (120 + (bits >> 23) % 16) << 23);
}

/* All triples of the lattice; random bit patterns; and c within some ulps of -a b or a b, where one rounding and two
 * differ. */
static operands make_operands(void)
{
    const size_t triples = (size_t)LATTICE * LATTICE * LATTICE, random = test_slow_machine ? 4096 : 65536;
    const size_t count = (triples + 2 * random + 63) / 64 * 64;
    float *memory = calloc(4 * count + 2 * MARGIN, sizeof(float));
    operands o = { count, memory, memory + count, memory + 2 * count, memory + 3 * count + MARGIN };
    test_random r = { 1 };
    if (!memory) abort();
    for (size_t i = 0; i < triples; i++) {
        o.a[i] = from_bits(lattice[i % LATTICE]);
        o.b[i] = from_bits(lattice[i / LATTICE % LATTICE]);
        o.c[i] = from_bits(lattice[i / LATTICE / LATTICE]);
    }
    for (size_t i = triples; i < triples + random; i++) {
        o.a[i] = from_bits((uint32_t)random_u64(&r));
        o.b[i] = from_bits((uint32_t)random_u64(&r));
        o.c[i] = from_bits((uint32_t)random_u64(&r));
    }
    for (size_t i = triples + random; i < count; i++) {
        o.a[i] = around_one(&r);
        o.b[i] = around_one(&r);
        const uint32_t sign = (uint32_t)random_u64(&r) & 0x80000000u, ulps = (uint32_t)(random_u64(&r) % 5) - 2;
        o.c[i] = from_bits((to_bits(o.a[i] * o.b[i]) ^ sign) + ulps);
    }
    return o;
}

static bool same(float a, float b, bool exact)
{
    return to_bits(a) == to_bits(b) || (!exact && isnan(a) && isnan(b));
}

/* ---- Tests ------------------------------------------------------------------------------------------------------- */

/* The first lane, if any, where the outcome is not the meaning. */
static bool find_difference(const operands *o, meaning *want, bool exact, size_t *at)
{
    for (size_t i = 0; i < o->count; i++)
        if (!same(o->out[i], want(o->a[i], o->b[i], o->c[i]), exact)) {
            *at = i;
            return true;
        }
    return false;
}

/* The first lane, if any, where the outcome is not near. */
static bool find_distant(const operands *o, closeness *near, size_t *at)
{
    for (size_t i = 0; i < o->count; i++)
        if (!near(o->out[i], o->a[i], o->b[i], o->c[i])) {
            *at = i;
            return true;
        }
    return false;
}

static void check_operation(const ops_table *table, int row, bool strict, const operands *o)
{
    size_t i;
    table->operations[row](o->a, o->b, o->c, o->out, o->count);
    if (!find_difference(o, rows[row].plain, rows[row].exact, &i)) return;
    if (!strict && rows[row].fused && !find_difference(o, rows[row].fused, false, &i)) return;
    if (!strict && rows[row].near && !find_distant(o, rows[row].near, &i)) return;
    if (rows[row].loose && !find_distant(o, rows[row].loose, &i)) return;
    expect(false, "%s of %a, %a, %a (%08" PRIx32 " %08" PRIx32 " %08" PRIx32 ") is %a (%08" PRIx32 ")", rows[row].name,
           (double)o->a[i], (double)o->b[i], (double)o->c[i], to_bits(o->a[i]), to_bits(o->b[i]), to_bits(o->c[i]),
           (double)o->out[i], to_bits(o->out[i]));
}

/* Both or neither fuse: dot products and their mirror images round alike. */
static bool fuses(const ops_table *table, int row, const operands *o)
{
    size_t i;
    table->operations[row](o->a, o->b, o->c, o->out, o->count);
    return find_difference(o, rows[row].plain, rows[row].exact, &i);
}

/* Every operation with its operands and its outcome at every offset from a vector's place; nothing beside is
 * written. */
static void check_places(const ops_table *table, const operands *o)
{
    const size_t count = (size_t)table->lanes * 2, operands_at = (size_t)LATTICE * LATTICE;
    const float canary = from_bits(0x7fa5a5a5);
    for (int row = 0; row < OPERATION_COUNT; row++)
        for (size_t from = 0; from <= 16; from++)
            for (size_t to = 0; to <= 16; to++) {
                const size_t at = operands_at + from;
                const float *a = o->a + at, *b = o->b + at, *c = o->c + at;
                float *all = o->out - MARGIN, want[32 * 2];
                const size_t first = MARGIN + to, length = count + 2 * MARGIN;
                for (size_t i = 0; i < length; i++) memcpy(&all[i], &canary, sizeof canary);
                table->operations[row](a, b, c, all + first, count);
                bool kept = true, right = true;
                table->operations[row](a, b, c, want, count);
                for (size_t i = 0; i < length; i++) {
                    const bool inside = i >= first && i < first + count;
                    if (!inside) kept = kept && !memcmp(&all[i], &canary, sizeof canary);
                    else right = right && same(all[i], want[i - first], rows[row].exact);
                }
                expect(kept, "%s at offset %zu writes beside %zu", rows[row].name, from, to);
                expect(right, "%s at offset %zu to %zu differs from itself", rows[row].name, from, to);
            }
}

static void check_target(facet_target target, const operands *o)
{
    const char *words = target_words(target);
    const ops_table *table = tables[target.arch][target.tier];
    test("%s: %d operations over %zu lanes", words, OPERATION_COUNT, o->count);
    if (!expect(table, "not linked")) return;
    expect(table->lanes == facet_arch_lanes(target.arch), "%d lanes, not %d", table->lanes,
           facet_arch_lanes(target.arch));
    for (int row = 0; row < OPERATION_COUNT; row++) check_operation(table, row, target.tier == FACET_TIER_STRICT, o);

    test("%s: both multiply-adds round alike", words);
    expect(fuses(table, OPERATION_vf_mad, o) == fuses(table, OPERATION_vf_nmad, o), "one fuses, the other does not");

    test("%s: at every offset, nothing beside", words);
    check_places(table, o);
}

void suite_ops(void)
{
    operands o = make_operands();
    for (int i = 0; i < target_count(); i++) check_target(target_at(i), &o);
    skip_absent_targets();
    free(o.a);
}
