/* What facet_plan_init and facet_shade refuse, by status, field and index, and that nothing is written then. */
#include "refusals.h"

#include "harness.h"

#include "facet.h"
#include "models.def"                /* the properties of its rows */

#include <float.h>
#include <math.h>
#include <string.h>

enum { CANARY = 0xa5, COUNT = 5, LIGHTS = 6 };

#define PI_2 0x1.921fb6p0f       /* the float nearest to pi/2 */

/* All streams, and those that a material may promise. */
enum {
#define FACET_STREAM(id, ...) | FACET_STREAM_##id
    ALL_STREAMS = 0
#include "streams.def"
#define OF_GEOMETRY(id)
#define OF_MATERIAL(id) | FACET_STREAM_##id
#define OF_SOURCE(id)   | FACET_STREAM_##id
#define FACET_STREAM(id, field, components, owner, ...) OF_##owner(id)
    , MATERIAL_STREAMS = 0
#include "streams.def"
};

/* The rows of models.def by name. */
enum {
#define FACET_DISTRIBUTION(id, name, ...) DISTRIBUTION_##name = FACET_DISTRIBUTION_##id,
#define FACET_MASKING(id, name, ...) MASKING_##name = FACET_MASKING_##id,
#include "models.def"
};

static const facet_target scalar = { .arch = FACET_ARCH_SCALAR, .tier = FACET_TIER_STRICT };

static bool is_error(const facet_error *e, facet_status code, const char *field, int index)
{
    return e->code == code && e->field && !strcmp(e->field, field) && e->index == index;
}

/* ---- Plans ------------------------------------------------------------------------------------------------------- */

/* Every number has a value that is neither its default nor at an end of its domain. */
static facet_material good_material(void)
{
    return (facet_material){
        .diffuse = { FACET_DIFFUSE_OREN_NAYAR, { 0.5f, 0.5f, 0.5f }, 0.5f },
        .specular = { FACET_DISTRIBUTION_GGX, FACET_MASKING_SMITH_CORRELATED, 0.25f, 0.5f, 20.0f, 0.5f },
        .fresnel = { FACET_FRESNEL_SCHLICK, { 0.04f, 0.04f, 0.04f }, 0.9f, { 0.9f, 0.9f, 0.9f }, { 1.5f, 1.5f, 1.5f },
                     { 0.1f, 0.1f, 0.1f }, 1.1f, 0.1f },
        .convention = { FACET_CONVENTION_DIRECT, { 0.5f, 0.5f, 0.5f }, 0.5f, 0.5f, 0.5f, 0.5f },
        .emission = { 0.1f, 0.1f, 0.1f },
    };
}

static void refuses_plan(const char *change, const facet_material *m, facet_target target, facet_status code,
                         const char *field, int index)
{
    facet_plan plan, untouched;
    facet_error error = { FACET_OK, NULL, 0 };
    memset(&plan, CANARY, sizeof plan);
    untouched = plan;
    const facet_status status = facet_plan_init(&plan, m, target, &error);
    expect(status == code && is_error(&error, code, field, index), "%s: status %d, %s[%d]", change, (int)status,
           error.field ? error.field : "NULL", error.index);
    expect(facet_plan_init(&plan, m, target, NULL) == code, "%s: another status without an error", change);
    expect(!memcmp(&plan, &untouched, sizeof plan), "%s: the plan was written", change);
}

static void accepts_plan(const char *change, const facet_material *m, facet_target target)
{
    facet_plan plan;
    facet_error error = { FACET_ERROR_NULL, "stale", 7 };
    const facet_status status = facet_plan_init(&plan, m, target, &error);
    expect(status == FACET_OK && error.code == FACET_OK && !error.field && error.index == -1,
           "%s: status %d, %s[%d]", change, (int)error.code, error.field ? error.field : "NULL", error.index);
}

#define PLAN_REFUSES(change, code, field, index)                                                                      \
    do {                                                                                                              \
        facet_material m = good_material();                                                                           \
        facet_target t = scalar;                                                                                      \
        change;                                                                                                       \
        refuses_plan(#change, &m, t, code, field, index);                                                             \
    } while (0)
#define PLAN_ACCEPTS(change)                                                                                          \
    do {                                                                                                              \
        facet_material m = good_material();                                                                           \
        facet_target t = scalar;                                                                                      \
        change;                                                                                                       \
        accepts_plan(#change, &m, t);                                                                                 \
    } while (0)

/* The models that read a number. */
typedef enum { BY_ANY, BY_ANISOTROPIC, BY_PHONG, BY_F82, BY_METALLIC, BY_GLOSSY } reader;

static facet_material read_by(reader r)
{
    facet_material m = good_material();
    if (r == BY_ANISOTROPIC) m.specular.model = FACET_DISTRIBUTION_GGX_ANISOTROPIC;
    if (r == BY_PHONG) m.specular.model = FACET_DISTRIBUTION_PHONG;
    if (r == BY_F82) m.fresnel.model = FACET_FRESNEL_SCHLICK_F82;
    if (r == BY_METALLIC) m.convention.model = FACET_CONVENTION_METALLIC_ROUGHNESS;
    if (r == BY_GLOSSY) m.convention.model = FACET_CONVENTION_SPECULAR_GLOSSINESS;
    return m;
}

/* Every number of a material: its domain, the stream that makes it ignored, and who reads it. */
static const struct {
    const char *field;
    size_t at;
    int components;
    float least, most;
    uint32_t stream;
    reader reader;
} numbers[] = {
#define NUMBER(name, components, ...) { #name, offsetof(facet_material, name), components, __VA_ARGS__ }
    NUMBER(diffuse.albedo, 3, -FLT_MAX, FLT_MAX, FACET_STREAM_ALBEDO, BY_ANY),
    NUMBER(diffuse.sigma, 1, 0, PI_2, FACET_STREAM_SIGMA, BY_ANY),
    NUMBER(specular.alpha, 1, 0, FLT_MAX, FACET_STREAM_ALPHA, BY_ANY),
    NUMBER(specular.alpha_y, 1, 0, FLT_MAX, FACET_STREAM_ALPHA_Y, BY_ANISOTROPIC),
    NUMBER(specular.exponent, 1, FACET_EXPONENT_MIN, FACET_EXPONENT_MAX, FACET_STREAM_EXPONENT, BY_PHONG),
    NUMBER(specular.scale, 1, 0, FLT_MAX, 0, BY_ANY),
    NUMBER(fresnel.f0, 3, -FLT_MAX, FLT_MAX, FACET_STREAM_F0, BY_ANY),
    NUMBER(fresnel.f90, 1, -FLT_MAX, FLT_MAX, 0, BY_ANY),
    NUMBER(fresnel.f82, 3, -FLT_MAX, FLT_MAX, 0, BY_F82),
    NUMBER(fresnel.eta, 3, FLT_TRUE_MIN, FLT_MAX, FACET_STREAM_ETA, BY_ANY),
    NUMBER(fresnel.k, 3, 0, FLT_MAX, FACET_STREAM_K, BY_ANY),
    NUMBER(fresnel.eta_outside, 1, 0, FLT_MAX, 0, BY_ANY),
    NUMBER(fresnel.polarisation, 1, -1, 1, 0, BY_ANY),
    NUMBER(convention.base, 3, -FLT_MAX, FLT_MAX, FACET_STREAM_BASE, BY_METALLIC),
    NUMBER(convention.metallic, 1, -FLT_MAX, FLT_MAX, FACET_STREAM_METALLIC, BY_METALLIC),
    NUMBER(convention.roughness, 1, -FLT_MAX, FLT_MAX, FACET_STREAM_ROUGHNESS, BY_METALLIC),
    NUMBER(convention.specular_level, 1, -FLT_MAX, FLT_MAX, FACET_STREAM_SPECULAR_LEVEL, BY_METALLIC),
    NUMBER(convention.glossiness, 1, -FLT_MAX, FLT_MAX, FACET_STREAM_GLOSSINESS, BY_GLOSSY),
    NUMBER(emission, 3, -FLT_MAX, FLT_MAX, 0, BY_ANY),
};

static facet_material with_number(const facet_material *good, size_t at, int component, float x)
{
    facet_material m = *good;
    memcpy((char *)&m + at + (size_t)component * sizeof x, &x, sizeof x);
    return m;
}

static void test_numbers(void)
{
    test("every number of a material: NaN, infinite, at and beyond its domain's ends");
    for (size_t i = 0; i < sizeof numbers / sizeof numbers[0]; i++) {
        const facet_material good = read_by(numbers[i].reader);
        for (int c = 0; c < numbers[i].components; c++) {
            const float least = numbers[i].least, most = numbers[i].most;
            const float refused[] = { NAN, -NAN, INFINITY, -INFINITY, nextafterf(least, -INFINITY),
                                      nextafterf(most, INFINITY) };
            const char *field = numbers[i].field;
            for (size_t k = 0; k < sizeof refused / sizeof refused[0]; k++) {
                facet_material m = with_number(&good, numbers[i].at, c, refused[k]);
                refuses_plan(field, &m, scalar, FACET_ERROR_VALUE, field, numbers[i].components > 1 ? c : -1);
                m.streams = numbers[i].stream;
                if (m.streams) accepts_plan(field, &m, scalar);
            }
            facet_material lowest = with_number(&good, numbers[i].at, c, least);
            facet_material highest = with_number(&good, numbers[i].at, c, most);
            accepts_plan(field, &lowest, scalar);
            accepts_plan(field, &highest, scalar);
        }
    }
}

static void test_models(void)
{
    test("unknown enumerators and flag bits of a material");
    PLAN_REFUSES(m.diffuse.model = (facet_diffuse)99, FACET_ERROR_ENUM, "diffuse.model", -1);
    PLAN_REFUSES(m.diffuse.model = (facet_diffuse)-1, FACET_ERROR_ENUM, "diffuse.model", -1);
    PLAN_REFUSES(m.specular.model = (facet_distribution)99, FACET_ERROR_ENUM, "specular.model", -1);
    PLAN_REFUSES(m.specular.model = (facet_distribution)-1, FACET_ERROR_ENUM, "specular.model", -1);
    PLAN_REFUSES(m.specular.masking = (facet_masking)99, FACET_ERROR_ENUM, "specular.masking", -1);
    PLAN_REFUSES(m.specular.masking = (facet_masking)-1, FACET_ERROR_ENUM, "specular.masking", -1);
    PLAN_REFUSES(m.fresnel.model = (facet_fresnel)99, FACET_ERROR_ENUM, "fresnel.model", -1);
    PLAN_REFUSES(m.fresnel.model = (facet_fresnel)-1, FACET_ERROR_ENUM, "fresnel.model", -1);
    const facet_distribution nothing = FACET_DISTRIBUTION_NONE;
    PLAN_REFUSES((m.specular.model = nothing, m.fresnel.model = (facet_fresnel)(1 << 12)), FACET_ERROR_ENUM,
                 "fresnel.model", -1);
    PLAN_REFUSES((m.specular.model = nothing, m.specular.masking = (facet_masking)99), FACET_ERROR_ENUM,
                 "specular.masking", -1);
    PLAN_REFUSES((m.specular.model = FACET_DISTRIBUTION_PHONG, m.specular.masking = (facet_masking)99),
                 FACET_ERROR_ENUM, "specular.masking", -1);
    PLAN_REFUSES(m.convention.model = (facet_convention)99, FACET_ERROR_ENUM, "convention.model", -1);
    PLAN_REFUSES(m.convention.model = (facet_convention)-1, FACET_ERROR_ENUM, "convention.model", -1);
    for (uint32_t bit = 1; bit; bit <<= 1) {
        if (bit & MATERIAL_STREAMS) PLAN_ACCEPTS(m.streams = bit);
        else PLAN_REFUSES(m.streams = bit | FACET_STREAM_ALBEDO, FACET_ERROR_ENUM, "streams", -1);
    }

    test("sigma's domain by model; models that are not built");
    for (int model = 0; facet_word(FACET_KIND_DIFFUSE, model); model++) {
        if (!facet_has(FACET_KIND_DIFFUSE, model))
            PLAN_REFUSES(m.diffuse.model = (facet_diffuse)model, FACET_ERROR_MODEL, "diffuse.model", -1);
        else
            PLAN_ACCEPTS((m.diffuse.model = (facet_diffuse)model, m.diffuse.sigma = 1.0f));
    }
    if (facet_has(FACET_KIND_DIFFUSE, FACET_DIFFUSE_FUJII))
        PLAN_REFUSES((m.diffuse.model = FACET_DIFFUSE_FUJII, m.diffuse.sigma = 0x1.000002p0f), FACET_ERROR_VALUE,
                     "diffuse.sigma", -1);
}

/* The maskings that models.def has for a distribution; a lobe takes any, and ignores it. */
static const struct { int masking, distribution; } pairs[] = {
#define FACET_VISIBILITY(masking, distribution, properties) { MASKING_##masking, DISTRIBUTION_##distribution },
#include "models.def"
};

static bool takes_masking(int distribution, int masking)
{
    switch (distribution) {
#define FACET_DISTRIBUTION(id, name, word, reads, properties, title)                                                  \
    case FACET_DISTRIBUTION_##id:                                                                                     \
        if (!(reads) || (properties) & LOBE) return true;                                                             \
        break;
#include "models.def"
    }
    for (size_t i = 0; i < sizeof pairs / sizeof pairs[0]; i++)
        if (pairs[i].masking == masking && pairs[i].distribution == distribution) return true;
    return false;
}

static void test_maskings(void)
{
    test("maskings that do not go with a distribution");
    for (int d = 0; facet_word(FACET_KIND_DISTRIBUTION, d); d++)
        for (int k = 0; facet_word(FACET_KIND_MASKING, k); k++) {
            facet_material m = good_material();
            m.specular.model = (facet_distribution)d;
            m.specular.masking = (facet_masking)k;
            if (takes_masking(d, k)) accepts_plan(facet_word(FACET_KIND_MASKING, k), &m, scalar);
            else refuses_plan(facet_word(FACET_KIND_MASKING, k), &m, scalar, FACET_ERROR_MODEL, "specular.masking", -1);
        }
}

#define ZERO(a) memset(a, 0, sizeof(a))

static void test_indices(void)
{
    test("eta in some channels alone; models that have nothing to derive a number from");
    for (int c = 0; c < 3; c++) PLAN_REFUSES(m.fresnel.eta[c] = 0, FACET_ERROR_VALUE, "fresnel.eta", c);
    PLAN_ACCEPTS(ZERO(m.fresnel.eta));

    PLAN_REFUSES((m.fresnel.model = FACET_FRESNEL_CONDUCTOR, ZERO(m.fresnel.eta)), FACET_ERROR_VALUE, "fresnel.eta",
                 -1);
    PLAN_ACCEPTS(m.fresnel.model = FACET_FRESNEL_CONDUCTOR);
    PLAN_ACCEPTS((m.fresnel.model = FACET_FRESNEL_CONDUCTOR, ZERO(m.fresnel.k)));
    PLAN_ACCEPTS((m.fresnel.model = FACET_FRESNEL_CONDUCTOR, ZERO(m.fresnel.eta), m.streams = FACET_STREAM_ETA));

    PLAN_REFUSES((m.fresnel.model = FACET_FRESNEL_DIELECTRIC, ZERO(m.fresnel.eta), ZERO(m.fresnel.f0)),
                 FACET_ERROR_VALUE, "fresnel.eta", -1);
    PLAN_ACCEPTS((m.fresnel.model = FACET_FRESNEL_DIELECTRIC, ZERO(m.fresnel.f0)));
    PLAN_ACCEPTS((m.fresnel.model = FACET_FRESNEL_DIELECTRIC, ZERO(m.fresnel.eta)));
    for (uint32_t stream = FACET_STREAM_F0; stream <= FACET_STREAM_ETA; stream <<= 1)
        PLAN_ACCEPTS((m.fresnel.model = FACET_FRESNEL_DIELECTRIC, ZERO(m.fresnel.eta), ZERO(m.fresnel.f0),
                      m.streams = stream));
    PLAN_ACCEPTS((m.fresnel.model = FACET_FRESNEL_DIELECTRIC, ZERO(m.fresnel.eta), ZERO(m.fresnel.f0),
                  m.convention.model = FACET_CONVENTION_METALLIC_ROUGHNESS));

    PLAN_REFUSES((m.fresnel.model = FACET_FRESNEL_SCHLICK_F82, ZERO(m.fresnel.eta), ZERO(m.fresnel.f82)),
                 FACET_ERROR_VALUE, "fresnel.f82", -1);
    PLAN_ACCEPTS((m.fresnel.model = FACET_FRESNEL_SCHLICK_F82, ZERO(m.fresnel.f82)));
    PLAN_ACCEPTS((m.fresnel.model = FACET_FRESNEL_SCHLICK_F82, ZERO(m.fresnel.eta)));
    PLAN_ACCEPTS((m.fresnel.model = FACET_FRESNEL_SCHLICK, ZERO(m.fresnel.eta), ZERO(m.fresnel.f0)));
}

/* What no model reads may lie outside its domain, and 0 is its default. */
static void test_unread_numbers(void)
{
    test("an exponent that no lobe reads; numbers that are 0");
    PLAN_ACCEPTS(m.specular.exponent = 0);
    PLAN_ACCEPTS(m.specular.exponent = -5);
    PLAN_REFUSES((m.specular.model = FACET_DISTRIBUTION_PHONG, m.specular.exponent = 0), FACET_ERROR_VALUE,
                 "specular.exponent", -1);
    PLAN_ACCEPTS((m.specular.model = FACET_DISTRIBUTION_GGX_ANISOTROPIC, m.specular.alpha_y = 0));
    PLAN_ACCEPTS((m.specular.scale = 0, m.fresnel.eta_outside = 0, m.fresnel.polarisation = 0, m.fresnel.f90 = 0));
    PLAN_ACCEPTS((m.convention.model = FACET_CONVENTION_METALLIC_ROUGHNESS, ZERO(m.convention.base),
                  m.convention.metallic = m.convention.roughness = m.convention.specular_level = 0));
    PLAN_ACCEPTS((m.convention.model = FACET_CONVENTION_SPECULAR_GLOSSINESS, m.convention.glossiness = 0));
}

static void test_targets(void)
{
    test("unknown and absent architectures and tiers");
    PLAN_REFUSES(t.arch = (facet_arch)99, FACET_ERROR_ENUM, "target.arch", -1);
    PLAN_REFUSES(t.arch = (facet_arch)-1, FACET_ERROR_ENUM, "target.arch", -1);
    PLAN_REFUSES(t.tier = (facet_tier)99, FACET_ERROR_ENUM, "target.tier", -1);
    PLAN_REFUSES(t.tier = (facet_tier)-1, FACET_ERROR_ENUM, "target.tier", -1);
    PLAN_REFUSES(t.arches = 1u << FACET_ARCH_BEST, FACET_ERROR_ENUM, "target.arches", -1);
    PLAN_REFUSES(t.arches = 3u << FACET_ARCH_BEST, FACET_ERROR_ENUM, "target.arches", -1);
    PLAN_REFUSES(t.arches = 1u << (FACET_ARCH_NEON + 1), FACET_ERROR_ENUM, "target.arches", -1);
    PLAN_REFUSES(t.arches = ~0u, FACET_ERROR_ENUM, "target.arches", -1);
    PLAN_ACCEPTS(t.arch = FACET_ARCH_BEST);
    int refused = 0;
    for (int arch = FACET_ARCH_BEST + 1; facet_word(FACET_KIND_ARCH, arch); arch++) {
        if (facet_has(FACET_KIND_ARCH, arch)) {
            PLAN_ACCEPTS(t.arch = (facet_arch)arch);
        } else {
            PLAN_REFUSES(t.arch = (facet_arch)arch, FACET_ERROR_ARCH, "target.arch", -1);
            refused++;
        }
    }
    expect(refused > 0, "NEON and SSE2 on one machine");
    for (int tier = 0; facet_word(FACET_KIND_TIER, tier); tier++)
        if (!facet_has(FACET_KIND_TIER, tier))
            PLAN_REFUSES(t.tier = (facet_tier)tier, FACET_ERROR_ARCH, "target.tier", -1);
}

static void test_plan_pointers(void)
{
    facet_error error;
    const facet_material m = good_material();
    test("no plan, no material");
    const facet_status status = facet_plan_init(NULL, &m, scalar, &error);
    expect(status == FACET_ERROR_NULL && is_error(&error, status, "plan", -1), "plan NULL: status %d", (int)status);
    expect(facet_plan_init(NULL, &m, scalar, NULL) == FACET_ERROR_NULL, "plan and error NULL");
    refuses_plan("material NULL", NULL, scalar, FACET_ERROR_NULL, "material", -1);
}

/* ---- Batches ----------------------------------------------------------------------------------------------------- */

static float stream[COUNT], radiance[3][COUNT];
static size_t invalid;

static facet_batch good_batch(const facet_light *lights)
{
    facet_batch b = { .count = COUNT, .lights = lights, .light_count = LIGHTS,
                      .radiance = { radiance[0], radiance[1], radiance[2] }, .invalid = &invalid };
#define COMPONENTS_1(field) &b.field
#define COMPONENTS_3(field) b.field
#define FACET_STREAM(id, field, components, ...)                                                                      \
    for (int c = 0; c < components; c++) (COMPONENTS_##components(field))[c] = stream;
#include "streams.def"
    return b;
}

/* Two of every kind. */
static void good_lights(facet_light *lights)
{
    for (int i = 0; i < LIGHTS; i++)
        lights[i] = (facet_light){ .kind = (facet_light_kind)(i % 3), .direction = { 0, 0, 1 },
                                   .irradiance = { 1, 1, 1 }, .position = { 0, 0, 2 }, .range = 10,
                                   .axis = { 0, 0, -1 }, .cos_inner = 0.75f, .cos_outer = 0.5f };
}

static facet_plan plan_of(const facet_material *m)
{
    facet_plan plan;
    expect(facet_plan_init(&plan, m, scalar, NULL) == FACET_OK, "a good material is refused");
    return plan;
}

static facet_plan plan_with_streams(uint32_t streams)
{
    facet_material m = good_material();
    m.streams = streams;
    return plan_of(&m);
}

static facet_plan plan_lambert(void)
{
    facet_material m = good_material();
    m.diffuse.model = FACET_DIFFUSE_LAMBERT;
    m.specular.model = FACET_DISTRIBUTION_NONE;
    return plan_of(&m);
}

static facet_plan plan_anisotropic(void)
{
    facet_material m = good_material();
    m.specular.model = FACET_DISTRIBUTION_GGX_ANISOTROPIC;
    return plan_of(&m);
}

static void refuses_batch(const char *change, const facet_plan *plan, const facet_batch *b, facet_status code,
                          const char *field, int index)
{
    facet_error error = { FACET_OK, NULL, 0 };
    float untouched[3][COUNT];
    memset(radiance, CANARY, sizeof radiance);
    memset(untouched, CANARY, sizeof untouched);
    invalid = 1234;
    const facet_status status = facet_shade(plan, b, &error);
    expect(status == code && is_error(&error, code, field, index), "%s: status %d, %s[%d]", change, (int)status,
           error.field ? error.field : "NULL", error.index);
    expect(facet_shade(plan, b, NULL) == code, "%s: another status without an error", change);
    expect(!memcmp(radiance, untouched, sizeof radiance) && invalid == 1234, "%s: something was written", change);
}

static void accepts_batch(const char *change, const facet_plan *plan, const facet_batch *b)
{
    facet_error error = { FACET_ERROR_NULL, "stale", 7 };
    expect(facet_shade(plan, b, &error) == FACET_OK && error.code == FACET_OK && !error.field && error.index == -1,
           "%s: status %d, %s[%d]", change, (int)error.code, error.field ? error.field : "NULL", error.index);
}

#define CHANGED_BATCH(call)                                                                                           \
    facet_light lights[LIGHTS];                                                                                       \
    good_lights(lights);                                                                                              \
    facet_batch b = good_batch(lights);                                                                               \
    call
#define BATCH_REFUSES(plan, change, code, field, index)                                                               \
    do {                                                                                                              \
        CHANGED_BATCH(change);                                                                                        \
        refuses_batch(#change, plan, &b, code, field, index);                                                         \
    } while (0)
#define BATCH_ACCEPTS(plan, change)                                                                                   \
    do {                                                                                                              \
        CHANGED_BATCH(change);                                                                                        \
        accepts_batch(#change, plan, &b);                                                                             \
    } while (0)

/* Each component of each stream in turn: a plan that promises it refuses a batch without it, one that does not takes
 * it. */
static void test_promises(void)
{
    const facet_plan none = plan_with_streams(0), all = plan_with_streams(MATERIAL_STREAMS);
    test("a plan asks for what it was promised, and for nothing else");
#define MISSING_GEOMETRY(id, field, component)
#define MISSING_SOURCE(id, field, component) MISSING_MATERIAL(id, field, component)
#define MISSING_MATERIAL(id, field, component)                                                                        \
    do {                                                                                                              \
        const facet_plan one = plan_with_streams(FACET_STREAM_##id);                                                  \
        BATCH_REFUSES(&all, component = NULL, FACET_ERROR_NULL, #field, -1);                                          \
        BATCH_REFUSES(&one, component = NULL, FACET_ERROR_NULL, #field, -1);                                          \
        BATCH_ACCEPTS(&none, component = NULL);                                                                       \
    } while (0);
#define FACET_STREAM(id, field, components, owner, ...)                                                               \
    for (int c = 0; c < components; c++) { MISSING_##owner(id, field, (COMPONENTS_##components(field))[c]) }
#include "streams.def"
}

static void test_streams(void)
{
    const facet_plan uniform = plan_with_streams(0), lambert = plan_lambert(), brushed = plan_anisotropic();
    test("geometry that is needed and not there");
    for (int c = 0; c < 3; c++) {
        BATCH_REFUSES(&uniform, b.normal[c] = NULL, FACET_ERROR_NULL, "normal", -1);
        BATCH_REFUSES(&uniform, b.view[c] = NULL, FACET_ERROR_NULL, "view", -1);
        BATCH_REFUSES(&uniform, b.position[c] = NULL, FACET_ERROR_NULL, "position", -1);
        BATCH_REFUSES(&uniform, b.radiance[c] = NULL, FACET_ERROR_NULL, "radiance", c);
        BATCH_REFUSES(&brushed, b.tangent[c] = NULL, FACET_ERROR_NULL, "tangent", -1);
        BATCH_ACCEPTS(&uniform, b.tangent[c] = NULL);
        BATCH_ACCEPTS(&uniform, (b.position[c] = NULL, b.light_count = 1));
    }
    BATCH_ACCEPTS(&uniform, b.occlusion = NULL);

    test("view is needed by what depends on it");
    BATCH_ACCEPTS(&lambert, b.view[0] = b.view[1] = b.view[2] = NULL);
    BATCH_REFUSES(&lambert, (b.view[0] = b.view[1] = b.view[2] = NULL, b.flags = FACET_TWO_SIDED), FACET_ERROR_NULL,
                  "view", -1);
    BATCH_REFUSES(&uniform, b.view[0] = b.view[1] = b.view[2] = NULL, FACET_ERROR_NULL, "view", -1);
    for (int c = 0; c < 3; c++) BATCH_REFUSES(&lambert, b.view[c] = NULL, FACET_ERROR_NULL, "view", -1);
}

/* A vector of a light: its numbers in turn not finite. */
#define VECTOR_REFUSES(plan, i, field)                                                                                \
    for (int c = 0; c < 3; c++) {                                                                                     \
        BATCH_REFUSES(plan, lights[i].field[c] = NAN, FACET_ERROR_VALUE, "light." #field, i);                         \
        BATCH_REFUSES(plan, lights[i].field[c] = INFINITY, FACET_ERROR_VALUE, "light." #field, i);                    \
        BATCH_REFUSES(plan, lights[i].field[c] = -INFINITY, FACET_ERROR_VALUE, "light." #field, i);                   \
    }

static void test_directional(const facet_plan *plan, int i)
{
    BATCH_REFUSES(plan, lights[i].direction[2] = 0, FACET_ERROR_VALUE, "light.direction", i);
    BATCH_REFUSES(plan, lights[i].direction[2] = -0.0f, FACET_ERROR_VALUE, "light.direction", i);
    VECTOR_REFUSES(plan, i, direction)
    for (int c = 0; c < 3; c++)
        BATCH_REFUSES(plan, lights[i].direction_of[c] = stream, FACET_ERROR_NULL, "light.direction_of", i);
    BATCH_ACCEPTS(plan, lights[i].direction[0] = 5);
    BATCH_ACCEPTS(plan, (lights[i].position[0] = lights[i].range = lights[i].axis[0] = NAN,
                         lights[i].cos_inner = lights[i].cos_outer = NAN));
}

static void test_point(const facet_plan *plan, int i)
{
    VECTOR_REFUSES(plan, i, position)
    BATCH_REFUSES(plan, lights[i].range = NAN, FACET_ERROR_VALUE, "light.range", i);
    BATCH_REFUSES(plan, lights[i].range = INFINITY, FACET_ERROR_VALUE, "light.range", i);
    BATCH_REFUSES(plan, lights[i].range = -FLT_TRUE_MIN, FACET_ERROR_VALUE, "light.range", i);
    BATCH_ACCEPTS(plan, lights[i].range = -0.0f);
    BATCH_ACCEPTS(plan, lights[i].range = FLT_TRUE_MIN);
    BATCH_ACCEPTS(plan, memset(lights[i].position, 0, sizeof lights[i].position));
    BATCH_ACCEPTS(plan, (lights[i].position[1] = FLT_MAX, lights[i].range = FLT_MAX));
    BATCH_ACCEPTS(plan, (lights[i].direction[0] = NAN, lights[i].direction_of[1] = stream));
}

static void test_spot(const facet_plan *plan, int i)
{
    test_point(plan, i);
    VECTOR_REFUSES(plan, i, axis)
    BATCH_REFUSES(plan, lights[i].axis[2] = 0, FACET_ERROR_VALUE, "light.axis", i);
    BATCH_REFUSES(plan, lights[i].cos_inner = NAN, FACET_ERROR_VALUE, "light.cos_inner", i);
    BATCH_REFUSES(plan, lights[i].cos_inner = 0x1.000002p0f, FACET_ERROR_VALUE, "light.cos_inner", i);
    BATCH_REFUSES(plan, lights[i].cos_inner = 0x1.fffffep-2f, FACET_ERROR_VALUE, "light.cos_inner", i);
    BATCH_REFUSES(plan, lights[i].cos_outer = NAN, FACET_ERROR_VALUE, "light.cos_outer", i);
    BATCH_REFUSES(plan, lights[i].cos_outer = -0x1.000002p0f, FACET_ERROR_VALUE, "light.cos_outer", i);
    BATCH_REFUSES(plan, lights[i].cos_outer = -INFINITY, FACET_ERROR_VALUE, "light.cos_outer", i);
    BATCH_ACCEPTS(plan, lights[i].cos_inner = lights[i].cos_outer);
    BATCH_ACCEPTS(plan, (lights[i].cos_inner = 1, lights[i].cos_outer = -1));
    BATCH_ACCEPTS(plan, lights[i].cos_inner = lights[i].cos_outer = 1);
    BATCH_ACCEPTS(plan, lights[i].cos_inner = lights[i].cos_outer = -1);
    BATCH_ACCEPTS(plan, lights[i].axis[0] = -5);
}

static void test_lights(void)
{
    static void (*const test_kind[])(const facet_plan *, int) = {
        [FACET_LIGHT_DIRECTIONAL] = test_directional, [FACET_LIGHT_POINT] = test_point, [FACET_LIGHT_SPOT] = test_spot,
    };
    const facet_plan plan = plan_with_streams(0);
    test("every malformed light, by its number");
    BATCH_REFUSES(&plan, b.lights = NULL, FACET_ERROR_NULL, "lights", -1);
    BATCH_ACCEPTS(&plan, (b.lights = NULL, b.light_count = 0));
    for (int i = 0; i < LIGHTS; i++) {
        BATCH_REFUSES(&plan, lights[i].kind = (facet_light_kind)9, FACET_ERROR_ENUM, "light.kind", i);
        BATCH_REFUSES(&plan, lights[i].kind = (facet_light_kind)-1, FACET_ERROR_ENUM, "light.kind", i);
        BATCH_REFUSES(&plan, memset(lights[i].irradiance, 0, sizeof lights[i].irradiance), FACET_ERROR_VALUE,
                      "light.irradiance", i);
        VECTOR_REFUSES(&plan, i, irradiance)
        for (int c = 0; c < 3; c++)
            BATCH_REFUSES(&plan, lights[i].irradiance_of[c] = stream, FACET_ERROR_NULL, "light.irradiance_of", i);
        BATCH_ACCEPTS(&plan, lights[i].irradiance[0] = -1);
        BATCH_ACCEPTS(&plan, lights[i].irradiance[0] = FLT_TRUE_MIN);
        test_kind[i % 3](&plan, i);
    }

    test("a light's numbers are ignored where its streams stand");
    for (int i = 0; i < LIGHTS; i++) {
        BATCH_ACCEPTS(&plan, (lights[i].irradiance_of[0] = lights[i].irradiance_of[1] = lights[i].irradiance_of[2]
                              = stream, lights[i].irradiance[0] = NAN));
        if (i % 3 == FACET_LIGHT_DIRECTIONAL)
            BATCH_ACCEPTS(&plan, (lights[i].direction_of[0] = lights[i].direction_of[1] = lights[i].direction_of[2]
                                  = stream, lights[i].direction[0] = NAN));
    }
}

static void test_batches(void)
{
    const facet_plan plan = plan_with_streams(0);
    test("no plan, no batch, unknown flag bits, ambient that is not finite");
    BATCH_REFUSES(NULL, (void)0, FACET_ERROR_NULL, "plan", -1);
    refuses_batch("batch NULL", &plan, NULL, FACET_ERROR_NULL, "batch", -1);
    BATCH_REFUSES(&plan, b.flags = 4, FACET_ERROR_ENUM, "flags", -1);
    BATCH_REFUSES(&plan, b.flags = 1u << 31 | FACET_ACCUMULATE, FACET_ERROR_ENUM, "flags", -1);
    for (uint32_t bit = 1; bit; bit <<= 1) {
        if (bit & ALL_STREAMS) BATCH_ACCEPTS(&plan, b.uniform = bit);
        else BATCH_REFUSES(&plan, b.uniform = bit | FACET_STREAM_NORMAL, FACET_ERROR_ENUM, "uniform", -1);
    }
    BATCH_ACCEPTS(&plan, b.uniform = ALL_STREAMS);
    BATCH_ACCEPTS(&plan, b.ambient[1] = -FLT_MAX);
    for (int c = 0; c < 3; c++) {
        BATCH_REFUSES(&plan, b.ambient[c] = NAN, FACET_ERROR_VALUE, "ambient", -1);
        BATCH_REFUSES(&plan, b.ambient[c] = -INFINITY, FACET_ERROR_VALUE, "ambient", -1);
        for (int i = 0; i < 4; i++) {
            BATCH_REFUSES(&plan, b.sh[i][c] = NAN, FACET_ERROR_VALUE, "sh", i);
            BATCH_REFUSES(&plan, b.sh[i][c] = INFINITY, FACET_ERROR_VALUE, "sh", i);
            BATCH_ACCEPTS(&plan, b.sh[i][c] = -FLT_MAX);
        }
    }
}

/* ---- Packed streams ---------------------------------------------------------------------------------------------- */

static const facet_camera good_camera = { .corner = { 0, 0, -1 }, .across = { 1, 0, 0 }, .down = { 0, 1, 0 } };

/* A batch that has all of its streams packed, and goes to halves and pixels. */
typedef struct { uint32_t words[COUNT]; uint16_t half[3][COUNT]; } packed_memory;
static packed_memory room;

static void pack(facet_batch *b, facet_camera *camera)
{
    *camera = good_camera;
    camera->width = 2;
    b->packed = (facet_packed){ .normal = (int16_t *)room.words, .albedo_roughness = (uint8_t *)room.words,
                                .f0_sigma = (uint8_t *)room.words, .camera = camera, .pixels = (uint8_t *)room.words,
                                .half = { room.half[0], room.half[1], room.half[2] } };
    for (int c = 0; c < 3; c++) b->normal[c] = b->view[c] = b->albedo[c] = b->f0[c] = b->radiance[c] = NULL;
    b->alpha = b->sigma = NULL;
}

#define PACKED_REFUSES(plan, change, code, field, index)                                                              \
    do {                                                                                                              \
        packed_memory untouched;                                                                                      \
        facet_camera camera;                                                                                          \
        memset(&room, CANARY, sizeof room);                                                                           \
        untouched = room;                                                                                             \
        BATCH_REFUSES(plan, (pack(&b, &camera), change), code, field, index);                                         \
        expect(!memcmp(&room, &untouched, sizeof room), "%s: a packed stream was written", #change);                  \
    } while (0)
#define PACKED_ACCEPTS(plan, change)                                                                                  \
    do {                                                                                                              \
        facet_camera camera;                                                                                          \
        BATCH_ACCEPTS(plan, (pack(&b, &camera), change));                                                             \
    } while (0)

/* A place that no float could have. */
#define OFF(pointer, bytes) ((void *)((char *)(pointer) + (bytes)))

static void test_packed_addresses(const facet_plan *plan)
{
    test("packed streams that are not where they may be, or not there");
    PACKED_ACCEPTS(plan, (void)0);
    for (int k = 1; k < 4; k++) {
        PACKED_REFUSES(plan, b.packed.normal = OFF(room.words, k), FACET_ERROR_VALUE, "packed.normal", -1);
        PACKED_REFUSES(plan, b.packed.albedo_roughness = OFF(room.words, k), FACET_ERROR_VALUE,
                       "packed.albedo_roughness", -1);
        PACKED_REFUSES(plan, b.packed.f0_sigma = OFF(room.words, k), FACET_ERROR_VALUE, "packed.f0_sigma", -1);
        PACKED_REFUSES(plan, b.packed.pixels = OFF(room.words, k), FACET_ERROR_VALUE, "packed.pixels", -1);
    }
    for (int c = 0; c < 3; c++) {
        PACKED_REFUSES(plan, b.packed.half[c] = NULL, FACET_ERROR_NULL, "packed.half", c);
        PACKED_REFUSES(plan, (b.packed.half[0] = b.packed.half[1] = b.packed.half[2] = NULL, b.packed.pixels = NULL,
                              b.radiance[(c + 1) % 3] = b.radiance[(c + 2) % 3] = radiance[0]), FACET_ERROR_NULL,
                       "radiance", c);
    }
    PACKED_REFUSES(plan, b.packed.normal = NULL, FACET_ERROR_NULL, "normal", -1);
    PACKED_REFUSES(plan, b.packed.camera = NULL, FACET_ERROR_NULL, "view", -1);
    PACKED_REFUSES(plan, b.packed.albedo_roughness = NULL, FACET_ERROR_NULL, "albedo", -1);
    PACKED_REFUSES(plan, b.packed.f0_sigma = NULL, FACET_ERROR_NULL, "sigma", -1);
    PACKED_ACCEPTS(plan, b.packed.pixels = NULL);
    PACKED_ACCEPTS(plan, b.packed.half[0] = b.packed.half[1] = b.packed.half[2] = NULL);
    PACKED_ACCEPTS(plan, b.uniform = ALL_STREAMS);
}

static void test_packed_numbers(const facet_plan *plan)
{
    test("an exposure and cameras out of their domain; packed radiance does not accumulate");
    PACKED_REFUSES(plan, b.flags = FACET_ACCUMULATE, FACET_ERROR_ENUM, "flags", -1);
    PACKED_REFUSES(plan, (b.flags = FACET_ACCUMULATE, b.packed.pixels = NULL), FACET_ERROR_ENUM, "flags", -1);
    PACKED_REFUSES(plan, b.packed.exposure = NAN, FACET_ERROR_VALUE, "packed.exposure", -1);
    PACKED_REFUSES(plan, b.packed.exposure = INFINITY, FACET_ERROR_VALUE, "packed.exposure", -1);
    PACKED_REFUSES(plan, b.packed.exposure = -FLT_TRUE_MIN, FACET_ERROR_VALUE, "packed.exposure", -1);
    PACKED_ACCEPTS(plan, b.packed.exposure = -0.0f);
    PACKED_ACCEPTS(plan, b.packed.exposure = FLT_MAX);
    for (int c = 0; c < 3; c++) {
        PACKED_REFUSES(plan, camera.corner[c] = NAN, FACET_ERROR_VALUE, "packed.camera.corner", -1);
        PACKED_REFUSES(plan, camera.across[c] = INFINITY, FACET_ERROR_VALUE, "packed.camera.across", -1);
        PACKED_REFUSES(plan, camera.down[c] = -INFINITY, FACET_ERROR_VALUE, "packed.camera.down", -1);
        PACKED_ACCEPTS(plan, camera.down[c] = -FLT_MAX);
    }
}

/* COUNT is 5. */
static void test_packed_pixels(const facet_plan *plan)
{
    enum { PIXELS = 1 << 20 };
    test("cameras' columns and rows end below 2^20");
    PACKED_ACCEPTS(plan, (camera.width = 0, camera.x = PIXELS - COUNT, camera.y = PIXELS - 1));
    PACKED_REFUSES(plan, (camera.width = 0, camera.x = PIXELS - COUNT + 1), FACET_ERROR_VALUE, "packed.camera.x", -1);
    PACKED_REFUSES(plan, (camera.width = 0, camera.y = PIXELS), FACET_ERROR_VALUE, "packed.camera.y", -1);
    PACKED_ACCEPTS(plan, (camera.width = 2, camera.x = PIXELS - 2, camera.y = PIXELS - 3));
    PACKED_REFUSES(plan, (camera.width = 2, camera.x = PIXELS - 1), FACET_ERROR_VALUE, "packed.camera.x", -1);
    PACKED_REFUSES(plan, (camera.width = 2, camera.y = PIXELS - 2), FACET_ERROR_VALUE, "packed.camera.y", -1);
    PACKED_ACCEPTS(plan, (camera.width = PIXELS, camera.x = PIXELS - COUNT));
    PACKED_REFUSES(plan, (camera.width = PIXELS, camera.x = PIXELS - COUNT + 1), FACET_ERROR_VALUE, "packed.camera.x",
                   -1);
    PACKED_REFUSES(plan, camera.width = PIXELS + 1, FACET_ERROR_VALUE, "packed.camera.width", -1);
    PACKED_REFUSES(plan, camera.width = UINT32_MAX, FACET_ERROR_VALUE, "packed.camera.width", -1);
    PACKED_REFUSES(plan, camera.x = UINT32_MAX, FACET_ERROR_VALUE, "packed.camera.x", -1);
    PACKED_REFUSES(plan, camera.y = UINT32_MAX, FACET_ERROR_VALUE, "packed.camera.y", -1);
    PACKED_ACCEPTS(plan, (camera.width = 1, camera.y = PIXELS - COUNT));
    PACKED_REFUSES(plan, (camera.width = 1, camera.y = PIXELS - COUNT + 1), FACET_ERROR_VALUE, "packed.camera.y", -1);
    PACKED_ACCEPTS(plan, (b.count = 0, camera.x = PIXELS, camera.y = PIXELS, camera.width = 0));
    PACKED_REFUSES(plan, (b.count = 0, camera.x = PIXELS + 1), FACET_ERROR_VALUE, "packed.camera.x", -1);
}

static void test_packed(void)
{
    const facet_plan plan = plan_with_streams(FACET_STREAM_ALBEDO | FACET_STREAM_SIGMA | FACET_STREAM_ALPHA
                                              | FACET_STREAM_F0);
    const facet_plan unpromised = plan_with_streams(0);
    test_packed_addresses(&plan);
    test_packed_numbers(&plan);
    test_packed_pixels(&plan);

    test("packed parameters that nothing promised are ignored");
    PACKED_ACCEPTS(&unpromised, (void)0);
    PACKED_ACCEPTS(&unpromised, b.packed.albedo_roughness = b.packed.f0_sigma = NULL);
}

void test_refusals(void)
{
    stream[0] = 1;
    test_plan_pointers();
    test_numbers();
    test_models();
    test_maskings();
    test_indices();
    test_unread_numbers();
    test_targets();
    test_streams();
    test_promises();
    test_lights();
    test_batches();
    test_packed();
}
