/* What facet_plan_init refuses, by status, field and index, and that nothing is written then. */
#include "api.h"

#include "errors.h"
#include "harness.h"

#include "models.def"                /* the properties of its rows */

#include <float.h>
#include <math.h>
#include <string.h>

#define PI_2 0x1.921fb6p0f       /* the float nearest to pi/2 */

/* The rows of models.def by name. */
enum {
#define FACET_DISTRIBUTION(id, name, ...) DISTRIBUTION_##name = FACET_DISTRIBUTION_##id,
#define FACET_MASKING(id, name, ...) MASKING_##name = FACET_MASKING_##id,
#include "models.def"
};

static void refuses_plan(const char *change, const facet_material *m, facet_target target, facet_status code,
                         const char *field, int index)
{
    facet_plan plan, untouched;
    facet_error error = { FACET_OK, NULL, 0 };
    memset(&plan, 0xa5, sizeof plan);
    untouched = plan;
    const facet_status status = facet_plan_init(&plan, m, target, &error);
    expect_refused(change, status, &error, code, field, index);
    expect(facet_plan_init(&plan, m, target, NULL) == code, "%s: another status without an error", change);
    expect(!memcmp(&plan, &untouched, sizeof plan), "%s: the plan was written", change);
}

static void accepts_plan(const char *change, const facet_material *m, facet_target target)
{
    facet_plan plan;
    facet_error error = { FACET_ERROR_NULL, "stale", 7 };
    expect_accepted(change, facet_plan_init(&plan, m, target, &error), &error);
}

#define PLAN_REFUSES(change, code, field, index)                                                                      \
    do {                                                                                                              \
        facet_material m = rich_material();                                                                           \
        facet_target t = strict_scalar;                                                                               \
        change;                                                                                                       \
        refuses_plan(#change, &m, t, code, field, index);                                                             \
    } while (0)
#define PLAN_ACCEPTS(change)                                                                                          \
    do {                                                                                                              \
        facet_material m = rich_material();                                                                           \
        facet_target t = strict_scalar;                                                                               \
        change;                                                                                                       \
        accepts_plan(#change, &m, t);                                                                                 \
    } while (0)

/* The models that read a number. */
typedef enum { BY_ANY, BY_ANISOTROPIC, BY_PHONG, BY_F82, BY_METALLIC, BY_GLOSSY } reader;

static facet_material read_by(reader r)
{
    facet_material m = rich_material();
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
                refuses_plan(field, &m, strict_scalar, FACET_ERROR_VALUE, field, numbers[i].components > 1 ? c : -1);
                m.streams = numbers[i].stream;
                if (m.streams) accepts_plan(field, &m, strict_scalar);
            }
            facet_material lowest = with_number(&good, numbers[i].at, c, least);
            facet_material highest = with_number(&good, numbers[i].at, c, most);
            accepts_plan(field, &lowest, strict_scalar);
            accepts_plan(field, &highest, strict_scalar);
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
            facet_material m = rich_material();
            m.specular.model = (facet_distribution)d;
            m.specular.masking = (facet_masking)k;
            if (takes_masking(d, k)) accepts_plan(facet_word(FACET_KIND_MASKING, k), &m, strict_scalar);
            else refuses_plan(facet_word(FACET_KIND_MASKING, k), &m, strict_scalar, FACET_ERROR_MODEL,
                              "specular.masking", -1);
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
    const facet_material m = rich_material();
    test("no plan, no material");
    const facet_status status = facet_plan_init(NULL, &m, strict_scalar, &error);
    expect(status == FACET_ERROR_NULL && is_error(&error, status, "plan", -1), "plan NULL: status %d", (int)status);
    expect(facet_plan_init(NULL, &m, strict_scalar, NULL) == FACET_ERROR_NULL, "plan and error NULL");
    refuses_plan("material NULL", NULL, strict_scalar, FACET_ERROR_NULL, "material", -1);
}

void test_refused_plans(void)
{
    test_plan_pointers();
    test_numbers();
    test_models();
    test_maskings();
    test_indices();
    test_unread_numbers();
    test_targets();
}
