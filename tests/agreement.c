/* Every architecture, tier, kernel, count, alignment, coverage, source of a parameter, number of lights, flag and
 * aliasing, pairwise: strict results are the scalar kernel's bytes, fast ones within their bound, and a sample's bytes
 * do not depend on its place. Nothing beside the batch is read or written. */
#include "arrangement.h"
#include "bits.h"
#include "bounds.h"
#include "harness.h"
#include "pairwise.h"
#include "targets.h"

#include <inttypes.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* ---- One sample at a time ---------------------------------------------------------------------------------------- */

typedef struct { float radiance[3]; size_t invalid; } outcome;

/* The sample alone, at the start of aligned streams, all its parameters per sample, nothing covered. */
static outcome shade_alone(const arrangement *a, const facet_plan *plan, size_t i)
{
    _Alignas(64) float one[COMPONENTS][16];
    facet_light lights[MOST_LIGHTS];
    float *at[COMPONENTS];
    outcome o = { .invalid = 0 };
    for (int c = 0; c < COMPONENTS; c++) {
        memcpy(one[c], &a->values[c][i], sizeof(float));
        at[c] = one[c];
    }
    facet_batch b = point_batch(a, at, lights, all_per_sample);
    b.count = 1;
    b.invalid = &o.invalid;
    expect(facet_shade(plan, &b, NULL) == FACET_OK, "a sample alone is refused");
    for (int c = 0; c < 3; c++) memcpy(&o.radiance[c], one[RADIANCE_AT + c], sizeof(float));
    return o;
}

#define PI 3.14159265358979323846

/* ---- The bound --------------------------------------------------------------------------------------------------- */

static double at(const arrangement *a, int component, size_t i) { return (double)a->values[component][i]; }

static sample sample_of(const arrangement *a, int light, size_t i)
{
    sample s = { .sigma = a->values[component_of(SIGMA, 0)][i], .alpha = a->values[component_of(ALPHA, 0)][i] };
    for (int c = 0; c < 3; c++) {
        s.n[c] = a->values[component_of(NORMAL, 0) + c][i];
        s.v[c] = a->has_view ? a->values[component_of(VIEW, 0) + c][i] : s.n[c];
        s.l[c] = a->values[component_of(DIRECTION, light) + c][i];
        s.albedo[c] = a->values[component_of(ALBEDO, 0) + c][i];
        s.f0[c] = a->values[component_of(F0, 0) + c][i];
        s.irradiance[c] = a->values[component_of(IRRADIANCE, light) + c][i];
        if (a->has_visibility) s.irradiance[c] *= a->values[component_of(VISIBILITY, light)][i];
    }
    if (a->flags & FACET_TWO_SIDED && reference_cosines(&s).nv < 0)
        for (int c = 0; c < 3; c++) s.n[c] = -s.n[c];
    return s;
}

/* Adds a light's radiance and what its error may be. False where the bound says nothing about it. */
static bool add_light(const arrangement *a, const error_bound *bound, int light, size_t i, double want[3],
                      double room[3])
{
    const double roundings = 8 * 0x1p-24;        /* of visibility, the sum over lights, and what is added to it */
    const sample s = sample_of(a, light, i);
    const cosines c = reference_cosines(&s);
    double radiance[3], magnitude[3];
    if (c.nl < -1e-6 || c.nv < -1e-6) return true;
    if (!in_domain(&s, c)) return false;
    reference_terms(&a->kernel->material, &s, radiance, magnitude);
    for (int k = 0; k < 3; k++) {
        want[k] += radiance[k];
        room[k] += magnitude[k] * (bound_at(bound, &s, c, NULL) + roundings) + 1e-30;
    }
    return true;
}

static void check_bound(const arrangement *a, const error_bound *bound, size_t i, const float got[3])
{
    double want[3], room[3];
    for (int c = 0; c < 3; c++) {
        want[c] = fmax(a->emission[c], 0);
        if (a->kernel->streams & FACET_STREAM_ALBEDO)
            want[c] += at(a, component_of(ALBEDO, 0) + c, i) * fmax(a->ambient[c], 0) / PI;
        if (a->flags & FACET_ACCUMULATE) want[c] += fmax(at(a, RADIANCE_AT + c, i), 0);
        room[c] = want[c] * 0x1p-20;
    }
    for (int light = 0; light < a->lights; light++)
        if (!add_light(a, bound, light, i, want, room)) return;
    for (int c = 0; c < 3; c++)
        expect(fabs((double)got[c] - want[c]) <= room[c],
               "sample %zu: radiance[%d] is %a, reference %a, error %.3g of %.3g; %s", i, c, (double)got[c], want[c],
               fabs((double)got[c] - want[c]), room[c], a->words);
}

/* ---- One arrangement --------------------------------------------------------------------------------------------- */

typedef struct { const facet_plan *plan; const facet_batch *batch; facet_status status; } call;

static void shade(void *argument)
{
    call *c = argument;
    c->status = facet_shade(c->plan, c->batch, NULL);
}

/* The radiance of every sample against the samples alone; returns how many of the covered ones were invalid. */
static size_t check_samples(const arrangement *a, const facet_batch *b, const facet_plan *alone,
                            const error_bound *bound)
{
    size_t invalid = 0;
    for (size_t i = 0; i < a->count; i++) {
        outcome want = { .invalid = 0 };
        const bool covered = is_covered(a, i);
        float got[3];
        if (covered) want = shade_alone(a, alone, i);
        invalid += want.invalid;
        for (int c = 0; c < 3; c++) {
            const float *right = covered ? &want.radiance[c] : &a->values[RADIANCE_AT + c][i];
            memcpy(&got[c], &b->radiance[c][i], sizeof(float));
            expect(to_bits(got[c]) == to_bits(*right),
                   "sample %zu: radiance[%d] is %a (%08" PRIx32 "), %s %a (%08" PRIx32 "); %s", i, c, (double)got[c],
                   to_bits(got[c]), covered ? "alone" : "not covered, was", (double)*right, to_bits(*right), a->words);
        }
        if (bound && covered && a->ordinary[i] && !want.invalid) check_bound(a, bound, i, got);
    }
    return invalid;
}

static void check_arrangement(const arrangement *a, const error_bound *bound)
{
    const bool strict = a->target.tier == FACET_TIER_STRICT;
    const facet_target alone_on = { strict ? FACET_ARCH_SCALAR : a->target.arch, a->target.tier };
    facet_material material = material_of(a, a->sources), per_sample = material_of(a, all_per_sample);
    facet_light lights[MOST_LIGHTS];
    facet_plan plan, alone;
    size_t invalid = 1000;
    const bool planned = !facet_plan_init(&plan, &material, a->target, NULL)
        && !facet_plan_init(&alone, &per_sample, alone_on, NULL);
    if (!expect(planned, "the material is refused; %s", a->words)) return;

    facet_batch b = point_batch(a, a->place, lights, a->sources);
    b.count = a->count;
    b.coverage = a->coverage;
    b.invalid = a->counted ? &invalid : NULL;
    call c = { &plan, &b, FACET_OK };
    const char *fault = fault_of(shade, &c);
    if (!expect(!fault && !c.status, "%s, status %d; %s", fault ? fault : "refused", (int)c.status, a->words)) return;

    const size_t alone_invalid = check_samples(a, &b, &alone, bound), want = a->counted ? alone_invalid : 0;
    expect(invalid == 1000 + want, "%zu samples are invalid, alone %zu; %s", invalid - 1000, want, a->words);
    const char *damage = find_damage(a);
    expect(!damage, "%s; %s", damage, a->words);
}

/* ---- All of them ------------------------------------------------------------------------------------------------- */

static void check_design(const design *d, int number)
{
    const arrangement *a = arrange(d, number);
    const bool fast = a->target.tier == FACET_TIER_FAST;
    const accuracy_row *row = fast ? find_accuracy(a->kernel->name, FACET_TIER_FAST) : NULL;
    expect(row || !fast, "no bound for %s", a->kernel->name);
    check_arrangement(a, row ? &row->bound : NULL);
    clear_arrangement();
}

static int count_of(const design_set *set, int target)
{
    int count = 0;
    for (int i = 0; i < set->count; i++) count += set->designs[i].level[FACTOR_TARGET] == target;
    return count;
}

static void check_target(const design_set *set, int target)
{
    const int rounds = test_slow_machine ? 3 : 12;
    const char *words = target_words(target_at(target));
    test("%s: %d arrangements", words, count_of(set, target));
    for (int i = 0; i < set->count; i++)
        if (set->designs[i].level[FACTOR_TARGET] == target) check_design(&set->designs[i], i);

    test("%s: %d plain batches", words, rounds * case_count());
    for (int i = 0; i < rounds * case_count(); i++) {
        const design d = plain_design(target, i % case_count(), (uint64_t)i);
        check_design(&d, i);
    }
}

void suite_agreement(void)
{
    const factor_space space = arrangement_space();
    design_set set = design_pairs(&space, 12);
    open_arrangements();
    test("%d pairs of levels of %d factors in %d arrangements; %d exclude each other", set.pairs, space.factors,
         set.count, set.excluded);
    expect(set.pairs > 0, "none");
    for (int target = 0; target < target_count(); target++) check_target(&set, target);
    skip_absent_targets();
    close_arrangements();
    free(set.designs);
}
