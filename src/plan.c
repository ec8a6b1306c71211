/* material + target -> plan: validation, and what can be computed once. */
#include "cpu.h"

/* The constants come from the kernels' own functions, so that in the strict tier a number of the material and a stream
 * of that number give the same bytes. */
#define FACET_STRICT 1
#include "../arch/environment.h"
#include "../arch/scalar.h"
#include "models.tmpl.h"

_Static_assert(sizeof(plan_fields) <= sizeof(facet_plan), "a plan fits into facet_plan");

static const struct { float sigma_max; int properties; } diffuse_rows[] = {
#define FACET_DIFFUSE(id, name, word, sigma_max, properties, title) [FACET_DIFFUSE_##id] = { sigma_max, properties },
#include "models.def"
};
static const int distribution_properties[] = {
#define FACET_DISTRIBUTION(id, name, word, properties, title) [FACET_DISTRIBUTION_##id] = properties,
#include "models.def"
};
static const int fresnel_properties[] = {
#define FACET_FRESNEL(id, name, word, properties, title) [FACET_FRESNEL_##id] = properties,
#include "models.def"
};

static enum visibility find_visibility(int masking, int distribution)
{
#define FACET_VISIBILITY(masking_, distribution_, properties)                                                         \
    if (masking == MASKING_##masking_ && distribution == DISTRIBUTION_##distribution_)                                \
        return VISIBILITY_##masking_##_##distribution_;
#include "models.def"
    return VISIBILITY_NONE;
}

static facet_status check_row(facet_kind kind, int value, const char *field, facet_error *error)
{
    if (!facet_word(kind, value)) return refuse(error, FACET_ERROR_ENUM, field, -1);
    if (!facet_has(kind, value)) return refuse(error, FACET_ERROR_MODEL, field, -1);
    return FACET_OK;
}

static facet_status check_models(const facet_material *m, facet_error *error)
{
    facet_status status = check_row(FACET_KIND_DIFFUSE, (int)m->diffuse.model, "diffuse.model", error);
    if (!status) status = check_row(FACET_KIND_DISTRIBUTION, (int)m->specular.model, "specular.model", error);
    if (status || m->specular.model == FACET_DISTRIBUTION_NONE) return status;
    status = check_row(FACET_KIND_MASKING, (int)m->specular.masking, "specular.masking", error);
    if (!status) status = check_row(FACET_KIND_FRESNEL, (int)m->fresnel.model, "fresnel.model", error);
    if (!status && find_visibility((int)m->specular.masking, (int)m->specular.model) == VISIBILITY_NONE)
        status = refuse(error, FACET_ERROR_MODEL, "specular.masking", -1);
    return status;
}

/* Numbers must lie in [least, most]; NaN lies nowhere. */
static facet_status check_numbers(const float *a, int count, float least, float most, const char *field,
                                  facet_error *error)
{
    for (int c = 0; c < count; c++)
        if (!(a[c] >= least && a[c] <= most)) return refuse(error, FACET_ERROR_VALUE, field, count > 1 ? c : -1);
    return FACET_OK;
}

static bool gives_eta(const facet_material *m)
{
    return m->fresnel.eta[0] != 0.0f || m->fresnel.eta[1] != 0.0f || m->fresnel.eta[2] != 0.0f;
}

static facet_status check_material(const facet_material *m, facet_error *error)
{
    const float sigma_max = diffuse_rows[m->diffuse.model].sigma_max;
    const struct { const float *a; int count; float least, most; const char *field; uint32_t stream; } rules[] = {
        { m->diffuse.albedo, 3, -FLT_MAX, FLT_MAX, "diffuse.albedo", FACET_STREAM_ALBEDO },
        { &m->diffuse.sigma, 1, 0.0f, sigma_max > 0.0f ? sigma_max : FLT_MAX, "diffuse.sigma", FACET_STREAM_SIGMA },
        { &m->specular.alpha, 1, 0.0f, FLT_MAX, "specular.alpha", FACET_STREAM_ALPHA },
        { m->fresnel.f0, 3, -FLT_MAX, FLT_MAX, "fresnel.f0", FACET_STREAM_F0 },
        { &m->fresnel.f90, 1, -FLT_MAX, FLT_MAX, "fresnel.f90", 0 },
        { m->fresnel.eta, 3, 0.0f, FLT_MAX, "fresnel.eta", 0 },
        { m->fresnel.k, 3, 0.0f, FLT_MAX, "fresnel.k", 0 },
        { &m->fresnel.eta_outside, 1, 0.0f, FLT_MAX, "fresnel.eta_outside", 0 },
        { m->emission, 3, -FLT_MAX, FLT_MAX, "emission", 0 },
    };
    for (size_t i = 0; i < sizeof rules / sizeof rules[0]; i++) {
        if (m->streams & rules[i].stream) continue;
        facet_status status =
            check_numbers(rules[i].a, rules[i].count, rules[i].least, rules[i].most, rules[i].field, error);
        if (status) return status;
    }
    for (int c = 0; c < 3; c++)
        if (gives_eta(m) && m->fresnel.eta[c] == 0.0f) return refuse(error, FACET_ERROR_VALUE, "fresnel.eta", c);

    const uint32_t known = 0
#define FACET_STREAM_GEOMETRY(id)
#define FACET_STREAM_MATERIAL(id) | FACET_STREAM_##id
#define FACET_STREAM(id, field, components, owner, ...) FACET_STREAM_##owner(id)
#include "streams.def"
        ;
    return m->streams & ~known ? refuse(error, FACET_ERROR_ENUM, "streams", -1) : FACET_OK;
}

static facet_status resolve_target(facet_target *target, facet_error *error)
{
    facet_status status = check_row(FACET_KIND_TIER, (int)target->tier, "target.tier", error);
    if (status == FACET_ERROR_MODEL) return refuse(error, FACET_ERROR_ARCH, "target.tier", -1);
    if (status) return status;
    if (!facet_word(FACET_KIND_ARCH, (int)target->arch)) return refuse(error, FACET_ERROR_ENUM, "target.arch", -1);
    if (target->arch == FACET_ARCH_BEST) target->arch = facet_arch_best();
    else if (!facet_arch_runs(target->arch)) return refuse(error, FACET_ERROR_ARCH, "target.arch", -1);
    return FACET_OK;
}

/* ((eta - eta_outside)2 + k2)/((eta + eta_outside)2 + k2), without overflow. */
static float f0_of(float eta, float k, float eta_outside)
{
    float half = 0.5f * eta + 0.5f * eta_outside, r = (0.5f * eta - 0.5f * eta_outside) / half;
    float x = vf_min(0.5f * k / half, 1e18f);
    return (r * r + x * x) / (1.0f + x * x);
}

static void store3(float *to, vf3 a) { to[0] = a.x, to[1] = a.y, to[2] = a.z; }

static void compile_diffuse(plan_fields *p, const facet_material *m)
{
    const int properties = diffuse_rows[m->diffuse.model].properties;
    p->diffuse = (uint8_t)m->diffuse.model;
    if (m->diffuse.model == FACET_DIFFUSE_NONE) return;

    if (properties & VIEW) p->needs_view = 1;
    p->needed |= FACET_STREAM_ALBEDO;
    if (!(p->promised & FACET_STREAM_ALBEDO)) store3(p->albedo, not_negative3(splat3(m->diffuse.albedo)));
    if (!(properties & TERMS)) return;

    p->needed |= FACET_STREAM_SIGMA;
    p->sigma_max = diffuse_rows[m->diffuse.model].sigma_max;
    if (p->promised & FACET_STREAM_SIGMA) return;
    terms t = terms_none(0.0f);
    switch (m->diffuse.model) {
#define FACET_DIFFUSE(id, name, word, sigma_max, properties_, title)                                                  \
    case FACET_DIFFUSE_##id:                                                                                         \
        if ((properties_) & TERMS) t = terms_##name(m->diffuse.sigma);                                               \
        break;
#include "models.def"
    }
    p->sigma = m->diffuse.sigma;
    p->terms[0] = t.A;
    p->terms[1] = t.B;
}

static void compile_specular(plan_fields *p, const facet_material *m)
{
    p->distribution = (uint8_t)m->specular.model;
    p->visibility = VISIBILITY_NONE;
    if (m->specular.model == FACET_DISTRIBUTION_NONE) return;

    p->masking = (uint8_t)m->specular.masking;
    p->visibility = (uint8_t)find_visibility((int)m->specular.masking, (int)m->specular.model);
    p->fresnel = (uint8_t)m->fresnel.model;
    p->coupled = m->coupled;
    if (distribution_properties[m->specular.model] & VIEW) p->needs_view = 1;
    p->needed |= FACET_STREAM_ALPHA;
    if (!(p->promised & FACET_STREAM_ALPHA)) {
        p->alpha = clamp(m->specular.alpha, FACET_ALPHA_FLOOR, 1.0f);
        p->clamped_alpha = p->alpha != m->specular.alpha;
    }
    if (!(fresnel_properties[m->fresnel.model] & F0)) return;

    p->needs_f90 = fresnel_properties[m->fresnel.model] & F90 ? 1 : 0;
    p->needed |= FACET_STREAM_F0;
    p->f90 = m->fresnel.f90 == 0.0f ? 1.0f : clamp(m->fresnel.f90, 0.0f, 1.0f);
    if (p->promised & FACET_STREAM_F0) return;
    const float *f0 = m->fresnel.f0, *eta = m->fresnel.eta, *k = m->fresnel.k;
    const float outside = m->fresnel.eta_outside > 0.0f ? m->fresnel.eta_outside : 1.0f;
    p->derived_f0 = gives_eta(m) && f0[0] == 0.0f && f0[1] == 0.0f && f0[2] == 0.0f;
    for (int c = 0; c < 3; c++) p->f0[c] = p->derived_f0 ? f0_of(eta[c], k[c], outside) : clamp(f0[c], 0.0f, 1.0f);
}

/* Not inlined: its arithmetic stays between environment_enter and environment_leave. */
static __attribute__((noinline)) facet_status compile(facet_plan *out, const facet_material *m, facet_target target,
                                                      facet_error *error)
{
    facet_status status = resolve_target(&target, error);
    if (!status) status = check_models(m, error);
    if (!status) status = check_material(m, error);
    if (status) return status;

    for (size_t i = 0; i < sizeof out->opaque / sizeof out->opaque[0]; i++) out->opaque[i] = 0;
    plan_fields *p = (plan_fields *)out;
    p->magic = PLAN_MAGIC;
    p->arch = (uint8_t)target.arch;
    p->tier = (uint8_t)target.tier;
    p->promised = m->streams;
    compile_diffuse(p, m);
    compile_specular(p, m);
    store3(p->emission, not_negative3(splat3(m->emission)));
    return FACET_OK;
}

facet_status facet_plan_init_sized(facet_plan *plan, size_t plan_size, const facet_material *material,
                                   size_t material_size, facet_target target, facet_error *error)
{
    facet_material own;
    refuse(error, FACET_OK, 0, -1);
    if (!plan) return refuse(error, FACET_ERROR_NULL, "plan", -1);
    if (plan_size < sizeof *plan) return refuse(error, FACET_ERROR_SIZE, "plan", -1);
    if (!material) return refuse(error, FACET_ERROR_NULL, "material", -1);
    if (material_size != sizeof own) {
        if (!adopt(&own, sizeof own, material, material_size)) return refuse(error, FACET_ERROR_SIZE, "material", -1);
        material = &own;
    }
    environment callers = environment_enter();
    facet_status status = compile(plan, material, target, error);
    environment_leave(callers);
    return status;
}

facet_target facet_plan_target(const facet_plan *opaque)
{
    const plan_fields *p = (const plan_fields *)opaque;
    if (!p || !plan_valid(p)) return (facet_target){ FACET_ARCH_BEST, FACET_TIER_FAST };
    return (facet_target){ (facet_arch)p->arch, (facet_tier)p->tier };
}
