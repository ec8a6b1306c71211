/* Every architecture, tier, kernel, convention, count, alignment, coverage, source of a stream, number and kind of
 * lights, flag and aliasing, pairwise: strict results are the scalar kernel's bytes, fast ones within their bound, and
 * a sample's bytes do not depend on its place. Nothing beside the batch is read or written. */
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

/* A sample alone, at the start of aligned streams, nothing covered: what an arrangement must not differ from. */
typedef struct {
    _Alignas(64) float one[COMPONENTS][16];
    facet_light lights[MOST_LIGHTS];
    float *at[COMPONENTS];
    stream_source sources[INPUTS];
    facet_plan plan;
    facet_batch batch;
    size_t invalid;
} solitude;

/* A parameter's number and a stream of that number give the same bytes; but in the fast tier, for those that follow from
 * others, as what computes them may fuse where the plan does not, and for an index, whose Fresnel term may be fitted. */
static void set_sources(solitude *alone, const arrangement *a)
{
    const bool as_numbers = a->target.tier == FACET_TIER_FAST
                            && (is_derived(a->recipe) || a->reads & FACET_STREAM_ETA);
    for (int s = 0; s < INPUTS; s++) {
        const bool absent = a->sources[s] == ELSEWHERE && is_optional(s);
        const bool kept = a->sources[s] == ELSEWHERE && as_numbers && s < BATCH_STREAMS;
        alone->sources[s] = absent || kept ? ELSEWHERE : PER_SAMPLE;
    }
}

/* False where the material is refused. */
static bool isolate(solitude *alone, const arrangement *a)
{
    const bool strict = a->target.tier == FACET_TIER_STRICT;
    const facet_target target = { strict ? FACET_ARCH_SCALAR : a->target.arch, a->target.tier, a->target.arches };
    set_sources(alone, a);
    for (int c = 0; c < COMPONENTS; c++) alone->at[c] = alone->one[c];
    const facet_material material = material_of(a, alone->sources);
    alone->batch = point_batch(a, alone->at, alone->lights, alone->sources);
    alone->batch.count = 1;
    alone->batch.invalid = &alone->invalid;
    return !facet_plan_init(&alone->plan, &material, target, NULL);
}

static outcome shade_alone(solitude *alone, const arrangement *a, size_t i)
{
    const int light_end = LIGHT_AT + LIGHT_COMPONENTS * a->light_count;
    outcome o;
    for (int c = 0; c < light_end; c++) memcpy(alone->one[c], &a->values[c][i], sizeof(float));
    for (int c = RADIANCE_AT; c < COMPONENTS; c++) memcpy(alone->one[c], &a->values[c][i], sizeof(float));
    alone->invalid = 0;
    expect(facet_shade(&alone->plan, &alone->batch, NULL) == FACET_OK, "a sample alone is refused; %s", a->words);
    for (int c = 0; c < 3; c++) memcpy(&o.radiance[c], alone->one[RADIANCE_AT + c], sizeof(float));
    o.invalid = alone->invalid;
    return o;
}

/* ---- The bound --------------------------------------------------------------------------------------------------- */

#define PI 3.14159265358979323846
#define U  0x1p-24

static int bounded;              /* samples that were held against the reference */

static double at(const arrangement *a, int component, size_t i) { return (double)a->values[component][i]; }

/* A parameter that follows from others has rounding errors of its own, relative to it. */
typedef struct { double value, error; } parameter;

static double in_unit(double x) { return fmin(fmax(x, 0), 1); }

static parameter metallic_f0(const arrangement *a, int c, size_t i)
{
    const double base = at(a, AT_BASE + c, i), metallic = at(a, AT_METALLIC, i), level = at(a, AT_SPECULAR_LEVEL, i);
    return (parameter){ in_unit(0.08 * level * (1 - metallic) + base * metallic), 6 * U };
}

static parameter f0_of_index(const arrangement *a, const facet_material *m, int c, size_t i)
{
    const double eta = at(a, AT_ETA + c, i), k = at(a, AT_K + c, i);
    const double outside = m->fresnel.eta_outside == 0 ? 1 : (double)m->fresnel.eta_outside;
    return (parameter){ ((eta - outside) * (eta - outside) + k * k) / ((eta + outside) * (eta + outside) + k * k),
                        8 * U };
}

static parameter eta_of_f0(const facet_material *m, parameter f0)
{
    const double outside = m->fresnel.eta_outside == 0 ? 1 : (double)m->fresnel.eta_outside, s = sqrt(f0.value);
    const double eta = s < 1 ? outside * fmin((1 + s) / (1 - s), FACET_ETA_CAP) : FACET_ETA_CAP;
    const double steep = fmin(s / ((1 - s) * (1 + s)), FACET_ETA_CAP);      /* d eta/eta = 2 steep ds/s */
    return (parameter){ fmin(eta, FACET_ETA_CAP), 4 * U + steep * (f0.error + 3 * U) };
}

/* What a recipe makes of a sample's streams; `reads` has what is as it is. */
typedef struct { parameter albedo[3], f0[3], eta[3], alpha, alpha_y; } parameters;

static parameters follow(const arrangement *a, const facet_material *m, size_t i)
{
    const facet_convention convention = a->recipe->convention;
    const bool metallic = convention == FACET_CONVENTION_METALLIC_ROUGHNESS;
    parameters p = { .alpha = { at(a, AT_ALPHA, i), 0 }, .alpha_y = { at(a, AT_ALPHA_Y, i), 0 } };
    if (metallic) p.alpha = (parameter){ pow(at(a, AT_ROUGHNESS, i), 2), 2 * U };
    if (convention == FACET_CONVENTION_SPECULAR_GLOSSINESS)
        p.alpha = (parameter){ pow(1 - at(a, AT_GLOSSINESS, i), 2), 4 * U };
    if (!(a->recipe->reads & FACET_STREAM_ALPHA_Y)) p.alpha_y = p.alpha;
    for (int c = 0; c < 3; c++) {
        p.albedo[c] = (parameter){ at(a, AT_ALBEDO + c, i), 0 };
        p.f0[c] = (parameter){ at(a, AT_F0 + c, i), 0 };
        p.eta[c] = (parameter){ at(a, AT_ETA + c, i), 0 };
        if (metallic)
            p.albedo[c] = (parameter){ at(a, AT_BASE + c, i) * (1 - at(a, AT_METALLIC, i)), 4 * U };
        if (metallic) p.f0[c] = metallic_f0(a, c, i);
        else if (a->recipe->reads & FACET_STREAM_ETA) p.f0[c] = f0_of_index(a, m, c, i);
        if (!(a->recipe->reads & FACET_STREAM_ETA)) p.eta[c] = eta_of_f0(m, p.f0[c]);
    }
    return p;
}

/* The floats of a sample that follow from others, and by how much they may be off. */
enum { FOLLOWING = 5 };
static const struct { size_t place; int count; uint32_t stream; } following[FOLLOWING] = {
#define FOLLOWS(field, count, stream) { offsetof(sample, field), count, FACET_STREAM_##stream }
    FOLLOWS(albedo, 3, ALBEDO), FOLLOWS(f0, 3, F0), FOLLOWS(eta, 3, ETA), FOLLOWS(alpha, 1, ALPHA),
    FOLLOWS(alpha_y, 1, ALPHA_Y),
};

static const parameter *parameter_of(const parameters *p, int which)
{
    const parameter *const all[FOLLOWING] = { p->albedo, p->f0, p->eta, &p->alpha, &p->alpha_y };
    return all[which];
}

/* Sets them, all as they are but one that is off by `sign` times its error. */
static void set_parameters(sample *s, const parameters *p, int off, int sign)
{
    for (int k = 0; k < FOLLOWING; k++) {
        float *to = (float *)(void *)((char *)s + following[k].place);
        const parameter *from = parameter_of(p, k);
        for (int c = 0; c < following[k].count; c++)
            to[c] = (float)(from[c].value * (1 + (k == off ? sign * (from[c].error + U) : 0)));
    }
}

static sample sample_of(const arrangement *a, const parameters *p, int light, size_t i)
{
    const bool two_sided = a->flags & FACET_TWO_SIDED, sees = a->reads & FACET_STREAM_VIEW;
    sample s = { .sigma = a->values[AT_SIGMA][i], .exponent = a->values[AT_EXPONENT][i] };
    set_parameters(&s, p, -1, 0);
    for (int c = 0; c < 3; c++) {
        s.n[c] = a->values[AT_NORMAL + c][i];
        s.v[c] = sees ? a->values[AT_VIEW + c][i] : s.n[c];
        s.l[c] = a->values[component_of(DIRECTION, light) + c][i];
        if (a->reads & FACET_STREAM_TANGENT) s.tangent[c] = a->values[AT_TANGENT + c][i];
        if (a->reads & FACET_STREAM_POSITION) s.position[c] = a->values[AT_POSITION + c][i];
        s.k[c] = a->values[AT_K + c][i];
        s.irradiance[c] = a->values[component_of(IRRADIANCE, light) + c][i];
        if (a->sources[VISIBILITY] == PER_SAMPLE) s.irradiance[c] *= a->values[component_of(VISIBILITY, light)][i];
    }
    if (a->lights[light].kind != FACET_LIGHT_DIRECTIONAL) s.light = &a->lights[light];
    if (two_sided && reference_cosines(&s).nv < 0)
        for (int c = 0; c < 3; c++) s.n[c] = -s.n[c];
    return s;
}

/* What the errors of parameters that follow from others make of one light's radiance. */
static void add_parameters_room(const arrangement *a, const facet_material *m, const parameters *p, const sample *s,
                                double room[3])
{
    for (int k = 0; k < FOLLOWING; k++) {
        const parameter *of = parameter_of(p, k);
        double more[3], less[3];
        sample off = *s;
        if (!(a->recipe->kernel->streams & following[k].stream) || of[0].error == 0) continue;
        set_parameters(&off, p, k, 1);
        reference_radiance(m, &off, more);
        set_parameters(&off, p, k, -1);
        reference_radiance(m, &off, less);
        for (int c = 0; c < 3; c++) room[c] += fabs(more[c] - less[c]);
    }
}

/* Adds a light's radiance and what its error may be. False where the bound says nothing about it. */
static bool add_light(const arrangement *a, const facet_material *m, const error_bound *bound, const parameters *p,
                      int light, size_t i, double want[3], double room[3])
{
    const double roundings = 8 * U;      /* of visibility and scale, the sum over lights, and what is added to it */
    /* A direction that follows from a position is off by 4 units: what turns with it, over nl, alpha and |v + l|. */
    const error_bound turned = { .limit = { 16, 4, 16 }, .distribution = bound->distribution };
    const sample s = sample_of(a, p, light, i);
    const cosines c = reference_cosines(&s);
    double radiance[3], magnitude[3];
    if (c.nl < -1e-6 || c.nv < -1e-6) return true;
    if (!in_domain(&s, c) || (s.light && c.vh < 0.05)) return false;
    reference_terms(m, &s, radiance, magnitude);
    const double relative =
        bound_at(bound, &s, c, NULL) + roundings + (s.light ? bound_at(&turned, &s, c, NULL) / c.vh : 0);
    for (int k = 0; k < 3; k++) {
        want[k] += radiance[k];
        room[k] += magnitude[k] * relative + 1e-30;
    }
    if (is_derived(a->recipe)) add_parameters_room(a, m, p, &s, room);
    return true;
}

/* Adds what is there without a light. */
static void add_constants(const arrangement *a, const facet_material *m, const parameters *p, size_t i, double want[3],
                          double room[3])
{
    const double occlusion = a->reads & FACET_STREAM_OCCLUSION ? at(a, AT_OCCLUSION, i) : 1;
    double n[3];
    for (int c = 0; c < 3; c++) n[c] = at(a, AT_NORMAL + c, i);
    if (a->flags & FACET_TWO_SIDED) {
        const sample s = sample_of(a, p, 0, i);
        for (int c = 0; c < 3; c++) n[c] = (double)s.n[c];
    }
    for (int c = 0; c < 3; c++) {
        const double Y1[] = { n[1], n[2], n[0] }, Y00 = PI * 0.5 * sqrt(1 / PI), of_Y1 = 2 * PI / 3 * sqrt(0.75 / PI);
        const double added = fmax((double)m->emission[c], 0)
            + (a->flags & FACET_ACCUMULATE ? fmax(at(a, RADIANCE_AT + c, i), 0) : 0);
        double sh = Y00 * (double)a->sh[0][c], size = fabs(sh);
        for (int k = 0; k < 3; k++) {
            sh += of_Y1 * Y1[k] * (double)a->sh[1 + k][c];
            size += of_Y1 * fabs(Y1[k] * (double)a->sh[1 + k][c]);
        }
        const double albedo = a->recipe->kernel->streams & FACET_STREAM_ALBEDO ? p->albedo[c].value : 0;
        const double ambient = fmax((double)a->ambient[c], 0);
        want[c] = added + albedo / PI * occlusion * (ambient + fmax(sh, 0));
        room[c] = (added + albedo / PI * occlusion * (ambient + size)) * 0x1p-20;
    }
}

static void check_bound(const arrangement *a, const facet_material *m, const error_bound *bound, size_t i,
                        const float got[3])
{
    const parameters p = follow(a, m, i);
    double want[3], room[3];
    add_constants(a, m, &p, i, want, room);
    for (int light = 0; light < a->light_count; light++)
        if (!add_light(a, m, bound, &p, light, i, want, room)) return;
    bounded++;
    for (int c = 0; c < 3; c++)
        expect(fabs((double)got[c] - want[c]) <= room[c],
               "sample %zu: radiance[%d] is %a, reference %a, error %.3g of %.3g; %s", i, c, (double)got[c], want[c],
               fabs((double)got[c] - want[c]), room[c], a->words);
}

/* ---- One arrangement --------------------------------------------------------------------------------------------- */

typedef struct { const facet_plan *plan; const facet_batch *batch; facet_error error; } call;

static void shade(void *argument)
{
    call *c = argument;
    facet_shade(c->plan, c->batch, &c->error);
}

/* The radiance of every sample against the samples alone; returns how many of the covered ones were invalid. */
static size_t check_samples(const arrangement *a, const facet_material *m, const facet_batch *b, solitude *alone,
                            const error_bound *bound)
{
    const size_t every = a->light_count > 8 ? 16 : is_derived(a->recipe) ? 4 : 1;      /* the reference is slow */
    size_t invalid = 0;
    for (size_t i = 0; i < a->count; i++) {
        outcome want = { .invalid = 0 };
        const bool covered = is_covered(a, i);
        float got[3];
        if (covered) want = shade_alone(alone, a, i);
        invalid += want.invalid;
        for (int c = 0; c < 3; c++) {
            const float *right = covered ? &want.radiance[c] : &a->values[RADIANCE_AT + c][i];
            memcpy(&got[c], &b->radiance[c][i], sizeof(float));
            expect(to_bits(got[c]) == to_bits(*right),
                   "sample %zu: radiance[%d] is %a (%08" PRIx32 "), %s %a (%08" PRIx32 "); %s", i, c, (double)got[c],
                   to_bits(got[c]), covered ? "alone" : "not covered, was", (double)*right, to_bits(*right), a->words);
        }
        if (bound && covered && a->ordinary[i] && !want.invalid && i % every == 0) check_bound(a, m, bound, i, got);
    }
    return invalid;
}

static void check_arrangement(const arrangement *a, const error_bound *bound)
{
    static solitude alone;
    facet_material material = material_of(a, a->sources);
    facet_light lights[MOST_LIGHTS];
    facet_plan plan;
    size_t invalid = 1000;
    const bool planned = !facet_plan_init(&plan, &material, a->target, NULL) && isolate(&alone, a);
    if (!expect(planned, "the material is refused; %s", a->words)) return;

    facet_batch b = point_batch(a, a->place, lights, a->sources);
    b.count = a->count;
    b.coverage = a->coverage;
    b.invalid = a->counted ? &invalid : NULL;
    call c = { .plan = &plan, .batch = &b };
    const char *fault = fault_of(shade, &c);
    expect(!c.error.code, "%s is refused; %s", c.error.field, a->words);
    if (!expect(!fault && !c.error.code, "%s; %s", fault, a->words)) return;

    const size_t alone_invalid = check_samples(a, &material, &b, &alone, bound), want = a->counted ? alone_invalid : 0;
    expect(invalid == 1000 + want, "%zu samples are invalid, alone %zu; %s", invalid - 1000, want, a->words);
    const char *damage = find_damage(a);
    expect(!damage, "%s; %s", damage, a->words);
}

/* ---- All of them ------------------------------------------------------------------------------------------------- */

static void check_design(const design *d, int number)
{
    const arrangement *a = arrange(d, number);
    const char *name = a->recipe->kernel->name;
    const bool fast = a->target.tier == FACET_TIER_FAST;
    const accuracy_row *row = fast ? find_accuracy(name, FACET_TIER_FAST) : NULL;
    expect(row || !fast, "no bound for %s", name);
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
    const int rounds = test_slow_machine ? 1 : 3;
    const char *words = target_words(target_at(target));
    test("%s: %d arrangements", words, count_of(set, target));
    bounded = 0;
    for (int i = 0; i < set->count; i++)
        if (set->designs[i].level[FACTOR_TARGET] == target) check_design(&set->designs[i], i);
    expect(bounded > 100 || target_at(target).tier == FACET_TIER_STRICT, "the bound was asked of %d samples", bounded);

    test("%s: %d plain batches", words, rounds * recipe_count());
    for (int i = 0; i < rounds * recipe_count(); i++) {
        const design d = plain_design(target, i % recipe_count(), (uint64_t)i);
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
