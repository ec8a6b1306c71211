/* material + target -> plan: validation, and what can be computed once. */
#include "cpu.h"

/* The constants come from the kernels' own functions, so that in the strict tier a number of the material and a stream
 * of that number give the same bytes. */
#define FACET_STRICT 1
#include "../arch/environment.h"
#include "../arch/scalar.h"
#include "models.tmpl.h"

_Static_assert(sizeof(plan_fields) <= sizeof(facet_plan), "a plan fits into facet_plan");

static const struct { uint32_t reads; int properties; float sigma_max; } diffuse_rows[] = {
#define FACET_DIFFUSE(id, name, word, reads, properties, sigma_max, title)                                            \
    [FACET_DIFFUSE_##id] = { reads, properties, sigma_max },
#include "models.def"
};
typedef struct { uint32_t reads; int properties; } row;
static const row distribution_rows[] = {
#define FACET_DISTRIBUTION(id, name, word, reads, properties, title) [FACET_DISTRIBUTION_##id] = { reads, properties },
#include "models.def"
};
static const row fresnel_rows[] = {
#define FACET_FRESNEL(id, name, word, reads, properties, title) [FACET_FRESNEL_##id] = { reads, properties },
#include "models.def"
};

static const struct { int masking, distribution, properties; } visibility_rows[] = {
#define FACET_VISIBILITY(masking, distribution, properties)                                                           \
    [VISIBILITY_##masking##_##distribution] = { MASKING_##masking, DISTRIBUTION_##distribution, properties },
#include "models.def"
    [VISIBILITY_NONE] = { -1, -1, 0 },
};

static enum visibility find_visibility(int masking, int distribution)
{
    int i = 0;
    while (i < VISIBILITY_NONE
           && (visibility_rows[i].masking != masking || visibility_rows[i].distribution != distribution)) i++;
    return (enum visibility)i;
}

static facet_status check_enumerator(facet_kind kind, int value, const char *field, facet_error *error)
{
    return facet_word(kind, value) ? FACET_OK : refuse(error, FACET_ERROR_ENUM, field, -1);
}

static facet_status check_row(facet_kind kind, int value, const char *field, facet_error *error)
{
    facet_status status = check_enumerator(kind, value, field, error);
    return status || facet_has(kind, value) ? status : refuse(error, FACET_ERROR_MODEL, field, -1);
}

static bool is_lobe(const facet_material *m)
{
    return distribution_rows[m->specular.model].properties & LOBE;
}

static facet_status check_models(const facet_material *m, facet_error *error)
{
    facet_status status = check_row(FACET_KIND_DIFFUSE, (int)m->diffuse.model, "diffuse.model", error);
    if (!status) status = check_row(FACET_KIND_DISTRIBUTION, (int)m->specular.model, "specular.model", error);
    if (!status) status = check_row(FACET_KIND_CONVENTION, (int)m->convention.model, "convention.model", error);
    if (!status) status = check_enumerator(FACET_KIND_FRESNEL, (int)m->fresnel.model, "fresnel.model", error);
    if (!status) status = check_enumerator(FACET_KIND_MASKING, (int)m->specular.masking, "specular.masking", error);
    if (status || m->specular.model == FACET_DISTRIBUTION_NONE) return status;
    status = check_row(FACET_KIND_FRESNEL, (int)m->fresnel.model, "fresnel.model", error);
    if (status || is_lobe(m)) return status;
    status = check_row(FACET_KIND_MASKING, (int)m->specular.masking, "specular.masking", error);
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

static bool any(const float *a) { return a[0] != 0.0f || a[1] != 0.0f || a[2] != 0.0f; }

/* The domains of facet.h; what the material's streams bring is not looked at. */
static facet_status check_values(const facet_material *m, uint32_t needed, facet_error *error)
{
    const float sigma_max = diffuse_rows[m->diffuse.model].sigma_max;
    const bool has_exponent = needed & FACET_STREAM_EXPONENT;
    const struct { const float *a; int count; float least, most; const char *field; uint32_t stream; } rules[] = {
        { m->diffuse.albedo, 3, -FLT_MAX, FLT_MAX, "diffuse.albedo", FACET_STREAM_ALBEDO },
        { &m->diffuse.sigma, 1, 0.0f, sigma_max > 0.0f ? sigma_max : FLT_MAX, "diffuse.sigma", FACET_STREAM_SIGMA },
        { &m->specular.alpha, 1, 0.0f, FLT_MAX, "specular.alpha", FACET_STREAM_ALPHA },
        { &m->specular.alpha_y, 1, 0.0f, FLT_MAX, "specular.alpha_y", FACET_STREAM_ALPHA_Y },
        { &m->specular.exponent, 1, has_exponent ? FACET_EXPONENT_MIN : -FLT_MAX,
          has_exponent ? FACET_EXPONENT_MAX : FLT_MAX, "specular.exponent", FACET_STREAM_EXPONENT },
        { &m->specular.scale, 1, 0.0f, FLT_MAX, "specular.scale", 0 },
        { m->fresnel.f0, 3, -FLT_MAX, FLT_MAX, "fresnel.f0", FACET_STREAM_F0 },
        { &m->fresnel.f90, 1, -FLT_MAX, FLT_MAX, "fresnel.f90", 0 },
        { m->fresnel.f82, 3, -FLT_MAX, FLT_MAX, "fresnel.f82", 0 },
        { m->fresnel.eta, 3, 0.0f, FLT_MAX, "fresnel.eta", FACET_STREAM_ETA },
        { m->fresnel.k, 3, 0.0f, FLT_MAX, "fresnel.k", FACET_STREAM_K },
        { &m->fresnel.eta_outside, 1, 0.0f, FLT_MAX, "fresnel.eta_outside", 0 },
        { &m->fresnel.polarisation, 1, -1.0f, 1.0f, "fresnel.polarisation", 0 },
        { m->convention.base, 3, -FLT_MAX, FLT_MAX, "convention.base", FACET_STREAM_BASE },
        { &m->convention.metallic, 1, -FLT_MAX, FLT_MAX, "convention.metallic", FACET_STREAM_METALLIC },
        { &m->convention.roughness, 1, -FLT_MAX, FLT_MAX, "convention.roughness", FACET_STREAM_ROUGHNESS },
        { &m->convention.specular_level, 1, -FLT_MAX, FLT_MAX, "convention.specular_level",
          FACET_STREAM_SPECULAR_LEVEL },
        { &m->convention.glossiness, 1, -FLT_MAX, FLT_MAX, "convention.glossiness", FACET_STREAM_GLOSSINESS },
        { m->emission, 3, -FLT_MAX, FLT_MAX, "emission", 0 },
    };
    for (size_t i = 0; i < sizeof rules / sizeof rules[0]; i++) {
        if (m->streams & rules[i].stream) continue;
        facet_status status =
            check_numbers(rules[i].a, rules[i].count, rules[i].least, rules[i].most, rules[i].field, error);
        if (status) return status;
    }
    return FACET_OK;
}

/* Whether the material says an index, a reflectance at normal incidence, in whatever way. */
static bool gives_eta(const facet_material *m) { return any(m->fresnel.eta) || m->streams & FACET_STREAM_ETA; }
static bool gives_f0(const facet_material *m)
{
    return any(m->fresnel.f0) || m->streams & FACET_STREAM_F0
        || m->convention.model == FACET_CONVENTION_METALLIC_ROUGHNESS;
}

/* Whether there is an index, or what one can be made from. */
static facet_status check_index(const facet_material *m, facet_error *error)
{
    const uint32_t reads = fresnel_rows[m->fresnel.model].reads;
    const bool numbers = any(m->fresnel.eta), streams = m->streams & FACET_STREAM_ETA;
    for (int c = 0; c < 3; c++)
        if (numbers && !streams && m->fresnel.eta[c] == 0.0f) return refuse(error, FACET_ERROR_VALUE, "fresnel.eta", c);
    if (m->specular.model == FACET_DISTRIBUTION_NONE) return FACET_OK;
    if (reads & FACET_STREAM_ETA && !gives_eta(m) && (reads & FACET_STREAM_K || !gives_f0(m)))
        return refuse(error, FACET_ERROR_VALUE, "fresnel.eta", -1);
    if (fresnel_rows[m->fresnel.model].properties & F82 && !any(m->fresnel.f82)
        && (!numbers || m->streams & (FACET_STREAM_ETA | FACET_STREAM_K)))
        return refuse(error, FACET_ERROR_VALUE, "fresnel.f82", -1);
    return FACET_OK;
}

static facet_status check_material(const facet_material *m, uint32_t needed, facet_error *error)
{
    const uint32_t known = 0
#define FACET_STREAM_GEOMETRY(id)
#define FACET_STREAM_MATERIAL(id) | FACET_STREAM_##id
#define FACET_STREAM_SOURCE(id) | FACET_STREAM_##id
#define FACET_STREAM(id, field, components, owner, ...) FACET_STREAM_##owner(id)
#include "streams.def"
        ;
    facet_status status = check_values(m, needed, error);
    if (!status) status = check_index(m, error);
    if (status) return status;
    return m->streams & ~known ? refuse(error, FACET_ERROR_ENUM, "streams", -1) : FACET_OK;
}

/* What the models read. */
static uint32_t needed_streams(const facet_material *m)
{
    uint32_t needed = diffuse_rows[m->diffuse.model].reads;
    if (diffuse_rows[m->diffuse.model].properties & VIEWED) needed |= FACET_STREAM_VIEW;
    if (m->specular.model != FACET_DISTRIBUTION_NONE)
        needed |= FACET_STREAM_VIEW | distribution_rows[m->specular.model].reads | fresnel_rows[m->fresnel.model].reads;
    return needed;
}

static facet_status resolve_target(facet_target *target, facet_error *error)
{
    facet_status status = check_row(FACET_KIND_TIER, (int)target->tier, "target.tier", error);
    if (status == FACET_ERROR_MODEL) return refuse(error, FACET_ERROR_ARCH, "target.tier", -1);
    if (status) return status;
    if (!facet_word(FACET_KIND_ARCH, (int)target->arch)) return refuse(error, FACET_ERROR_ENUM, "target.arch", -1);
    if (target->arches >> ARCH_COUNT || target->arches & 1u << FACET_ARCH_BEST)
        return refuse(error, FACET_ERROR_ENUM, "target.arches", -1);
    const uint32_t among = target->arch == FACET_ARCH_BEST ? ARCHES_BUILT : ARCHES_BUILT & 1u << target->arch;
    target->arch = facet_arch_best_of(target->arches ? target->arches & among : facet_arches_among(among));
    return target->arch == FACET_ARCH_BEST ? refuse(error, FACET_ERROR_ARCH, "target.arch", -1) : FACET_OK;
}

static void store3(float *to, vf3 a) { to[0] = a.x, to[1] = a.y, to[2] = a.z; }

/* The numbers of streams as the kernels see them: in their domains, defaults in place of zeros. */
static void take_numbers(plan_fields *p, const facet_material *m)
{
    const float level = m->convention.specular_level;
    store3(p->albedo, not_negative3(splat3(m->diffuse.albedo)));
    p->sigma = m->diffuse.sigma;
    p->alpha = clamp(m->specular.alpha, FACET_ALPHA_FLOOR, 1.0f);
    p->alpha_y = clamp(m->specular.alpha_y, FACET_ALPHA_FLOOR, 1.0f);
    p->exponent = m->specular.exponent;
    store3(p->f0, clamp3(splat3(m->fresnel.f0), 0.0f, 1.0f));
    store3(p->eta, clamp3(splat3(m->fresnel.eta), FACET_ETA_FLOOR, FACET_ETA_CAP));
    store3(p->k, clamp3(splat3(m->fresnel.k), 0.0f, FACET_ETA_CAP));
    store3(p->base, not_negative3(splat3(m->convention.base)));
    p->metallic = clamp(m->convention.metallic, 0.0f, 1.0f);
    p->roughness = clamp(m->convention.roughness, 0.0f, 1.0f);
    p->specular_level = level == 0.0f ? 0.5f : clamp(level, 0.0f, 1.0f);
    p->glossiness = clamp(m->convention.glossiness, 0.0f, 1.0f);
}

/* Forgets the numbers that no kernel sees, so that materials that differ in them alone have equal plans. */
static void forget_numbers(plan_fields *p)
{
    const uint32_t seen = ((p->needed & ~p->derived) | p->sources) & ~p->promised;
#define NUMBERS_1(field) &p->field
#define NUMBERS_3(field) p->field
#define FORGET_GEOMETRY(id, field, components)
#define FORGET_MATERIAL(id, field, components)                                                                        \
    for (int c = 0; c < components && !(seen & FACET_STREAM_##id); c++) (NUMBERS_##components(field))[c] = 0.0f;
#define FORGET_SOURCE FORGET_MATERIAL
#define FACET_STREAM(id, field, components, owner, ...) FORGET_##owner(id, field, components)
#include "streams.def"
}

/* Says that `stream`, if it is wanted, follows from others. True where these are all numbers, and it can be made here
 * and now; else the kernel makes it. */
static bool derive(plan_fields *p, uint32_t wanted, uint32_t stream, uint32_t from)
{
    if (!(wanted & stream)) return false;
    p->promised &= ~stream;
    if (!((p->promised | p->derived) & from)) return true;
    p->derived |= stream;
    p->sources |= from;
    return false;
}

static void derive_by_convention(plan_fields *p, uint32_t wanted)
{
    const uint32_t of_base = FACET_STREAM_BASE | FACET_STREAM_METALLIC;
    switch ((facet_convention)p->convention) {
    case FACET_CONVENTION_DIRECT:
        return;
    case FACET_CONVENTION_METALLIC_ROUGHNESS:
        if (derive(p, wanted, FACET_STREAM_ALBEDO, of_base))
            store3(p->albedo, albedo_of_base(splat3(p->base), p->metallic));
        if (derive(p, wanted, FACET_STREAM_F0, of_base | FACET_STREAM_SPECULAR_LEVEL))
            store3(p->f0, f0_of_base(splat3(p->base), p->metallic, p->specular_level));
        if (derive(p, wanted, FACET_STREAM_ALPHA, FACET_STREAM_ROUGHNESS))
            p->alpha = alpha_of_roughness(p->roughness);
        return;
    case FACET_CONVENTION_SPECULAR_GLOSSINESS:
        if (derive(p, wanted, FACET_STREAM_ALPHA, FACET_STREAM_GLOSSINESS))
            p->alpha = alpha_of_roughness(1.0f - p->glossiness);
    }
}

/* Parameters of which the models read one and the material says another. */
static void derive_parameters(plan_fields *p, const facet_material *m)
{
    const bool no_alpha_y = m->specular.alpha_y == 0.0f && !(m->streams & FACET_STREAM_ALPHA_Y);
    uint32_t wanted = p->needed;
    if (wanted & FACET_STREAM_F0 && gives_eta(m) && !gives_f0(m)) p->number_from |= F0_FROM_ETA;
    if (wanted & FACET_STREAM_ETA && !gives_eta(m)) {
        p->number_from |= ETA_FROM_F0;
        wanted |= FACET_STREAM_F0;
    }
    derive_by_convention(p, wanted);
    if (no_alpha_y && derive(p, wanted, FACET_STREAM_ALPHA_Y, FACET_STREAM_ALPHA)) p->alpha_y = p->alpha;
    if (p->number_from & F0_FROM_ETA && derive(p, wanted, FACET_STREAM_F0, FACET_STREAM_ETA | FACET_STREAM_K))
        for (int c = 0; c < 3; c++) p->f0[c] = f0_of_index(p->eta[c], p->k[c], p->eta_outside);
    if (p->number_from & ETA_FROM_F0 && derive(p, wanted, FACET_STREAM_ETA, FACET_STREAM_F0))
        for (int c = 0; c < 3; c++) p->eta[c] = eta_in(p->f0[c], p->eta_outside);
}

static terms terms_of(facet_diffuse model, float sigma)
{
    switch (model) {
#define FACET_DIFFUSE(id, name, ...)                                                                                  \
    case FACET_DIFFUSE_##id: return FACET_HAS(name) ? terms_##name(sigma) : terms_none(sigma);
#include "models.def"
    }
    return terms_none(0.0f);
}

static void compile_diffuse(plan_fields *p, const facet_material *m)
{
    p->diffuse = (uint8_t)m->diffuse.model;
    if (!(p->needed & FACET_STREAM_SIGMA)) return;
    p->sigma_max = diffuse_rows[m->diffuse.model].sigma_max;
    if (p->promised & FACET_STREAM_SIGMA) return;
    const terms t = terms_of(m->diffuse.model, m->diffuse.sigma);
    p->terms[0] = t.A, p->terms[1] = t.B, p->terms[2] = t.C, p->terms[3] = t.D;
}

static void compile_fresnel(plan_fields *p, const facet_material *m)
{
    const int properties = fresnel_rows[m->fresnel.model].properties;
    const float outside = m->fresnel.eta_outside;
    p->fresnel = (uint8_t)m->fresnel.model;
    p->fresnel_properties = (uint8_t)properties;
    p->eta_outside = outside == 0.0f ? 1.0f : clamp(outside, FACET_ETA_FLOOR, FACET_ETA_CAP);
    p->polarisation = m->fresnel.polarisation;
    if (properties & F90) p->f90 = m->fresnel.f90 == 0.0f ? 1.0f : clamp(m->fresnel.f90, 0.0f, 1.0f);
    if (!(FACET_HAS(schlick_f82) && properties & F82)) return;
    store3(p->f82, clamp3(splat3(m->fresnel.f82), 0.0f, 1.0f));
    if (any(m->fresnel.f82)) return;
    p->number_from |= F82_FROM_ETA;
    for (int c = 0; c < 3; c++)
        p->f82[c] = conductor(p->eta[c], p->k[c], p->eta_outside, 1.0f / 7.0f, 0.5f + 0.5f * p->polarisation);
}

static void compile_specular(plan_fields *p, const facet_material *m)
{
    p->distribution = (uint8_t)m->specular.model;
    p->visibility = VISIBILITY_NONE;
    p->scale = 1.0f;
    if (m->specular.model == FACET_DISTRIBUTION_NONE) return;
    p->coupled = m->coupled;
    if (m->specular.scale != 0.0f) p->scale = m->specular.scale;
    compile_fresnel(p, m);
    if (is_lobe(m)) return;
    p->masking = (uint8_t)m->specular.masking;
    p->visibility = (uint8_t)find_visibility((int)m->specular.masking, (int)m->specular.model);
}

/* In the fast tier numbers of an exact Fresnel term become a rational function of the cosine a channel, if all can. */
static void fit_fresnel(plan_fields *p)
{
    if (p->tier != FACET_TIER_FAST || !(p->fresnel_properties & MEDIA) || index_per_sample(p)) return;
    fresnel_fit fit[3];
    int fits = 1;
    for (int c = 1; c < 3; c++)
        if (p->eta[c] != p->eta[0] || p->k[c] != p->k[0]) fits = 3;
    float worst = 0.0f;
    for (int c = 0; c < fits; c++) {
        const float error = facet_fit_fresnel(&fit[c], p->eta[c], p->k[c], p->eta_outside, p->polarisation);
        if (!finite(error)) return;
        worst = vf_max(worst, error);
    }
    for (int c = 0; c < 3; c++) p->fit[c] = fit[fits == 1 ? 0 : c];
    p->needed &= ~(uint32_t)(FACET_STREAM_ETA | FACET_STREAM_K);
    p->fits = (uint8_t)fits;
    p->fit_error = worst;
}

/* The row of special.def that the models are. */
static uint8_t find_special(const plan_fields *p)
{
#define FACET_SPECIAL(name, diffuse_, distribution_, masking, fresnel_, coupled_, ...)                                \
    if (p->diffuse == DIFFUSE_##diffuse_ && p->distribution == DISTRIBUTION_##distribution_                           \
        && p->visibility == VISIBILITY_##masking##_##distribution_ && p->fresnel == FRESNEL_##fresnel_                \
        && p->fits == FITS_##fresnel_ && p->coupled == coupled_) return SPECIAL_##name;
#include "special.def"
    return SPECIAL_NONE;
}

/* Not inlined: its arithmetic stays between environment_enter and environment_leave. */
static __attribute__((noinline)) facet_status compile(facet_plan *out, const facet_material *m, facet_target target,
                                                      facet_error *error)
{
    facet_status status = resolve_target(&target, error);
    if (!status) status = check_models(m, error);
    if (status) return status;
    const uint32_t needed = needed_streams(m);
    status = check_material(m, needed, error);
    if (status) return status;

    for (size_t i = 0; i < sizeof out->opaque / sizeof out->opaque[0]; i++) out->opaque[i] = 0;
    plan_fields *p = (plan_fields *)out;
    p->arch = (uint8_t)target.arch;
    p->tier = (uint8_t)target.tier;
    p->convention = (uint8_t)m->convention.model;
    p->promised = m->streams;
    p->needed = needed;
    take_numbers(p, m);
    compile_diffuse(p, m);
    compile_specular(p, m);
    derive_parameters(p, m);
    if (!(p->fresnel_properties & MEDIA)) p->polarisation = 0.0f;
    if (!(p->fresnel_properties & MEDIA || (p->derived & FACET_STREAM_F0 && p->number_from & F0_FROM_ETA)))
        p->eta_outside = 0.0f;
    forget_numbers(p);
    fit_fresnel(p);
    p->special = find_special(p);
    p->unscaled = p->scale == 1.0f && !(p->fresnel_properties & F90 && p->f90 != 1.0f);
    p->clamped_alpha = p->convention == FACET_CONVENTION_DIRECT && p->alpha != 0.0f && p->alpha != m->specular.alpha;
    store3(p->emission, not_negative3(splat3(m->emission)));
    p->emits = p->emission[0] > 0.0f || p->emission[1] > 0.0f || p->emission[2] > 0.0f;
    p->sum = plan_sum(p);
    return FACET_OK;
}

facet_status facet_plan_init_sized(facet_plan *plan, size_t plan_size, const facet_material *material,
                                   size_t material_size, const facet_target *target, size_t target_size,
                                   facet_error *error)
{
    facet_material own;
    facet_target own_target;
    refuse(error, FACET_OK, 0, -1);
    if (!plan) return refuse(error, FACET_ERROR_NULL, "plan", -1);
    if (plan_size < sizeof *plan) return refuse(error, FACET_ERROR_SIZE, "plan", -1);
    if (!material) return refuse(error, FACET_ERROR_NULL, "material", -1);
    if (material_size != sizeof own) {
        if (!adopt(&own, sizeof own, material, material_size)) return refuse(error, FACET_ERROR_SIZE, "material", -1);
        material = &own;
    }
    if (!target) return refuse(error, FACET_ERROR_NULL, "target", -1);
    if (!adopt(&own_target, sizeof own_target, target, target_size))
        return refuse(error, FACET_ERROR_SIZE, "target", -1);
    environment callers = environment_enter();
    facet_status status = compile(plan, material, own_target, error);
    environment_leave(callers);
    return status;
}

facet_target facet_plan_target(const facet_plan *opaque)
{
    const plan_fields *p = (const plan_fields *)opaque;
    if (!p || !plan_kernel(p)) return (facet_target){ 0 };
    return (facet_target){ .arch = (facet_arch)p->arch, .tier = (facet_tier)p->tier };
}
