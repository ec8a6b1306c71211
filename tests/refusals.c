/* What facet_plan_init and facet_shade refuse, by status, field and index, and that nothing is written then. */
#include "refusals.h"

#include "harness.h"

#include "facet.h"

#include <float.h>
#include <math.h>
#include <string.h>

enum { CANARY = 0xa5, COUNT = 5 };

#define PI_2 0x1.921fb6p0f       /* the float nearest to pi/2 */

static const facet_target scalar = { FACET_ARCH_SCALAR, FACET_TIER_STRICT };

static bool is_error(const facet_error *e, facet_status code, const char *field, int index)
{
    return e->code == code && e->field && !strcmp(e->field, field) && e->index == index;
}

/* ---- Plans ------------------------------------------------------------------------------------------------------- */

static facet_material good_material(void)
{
    return (facet_material){
        .diffuse = { FACET_DIFFUSE_OREN_NAYAR, { 0.5f, 0.5f, 0.5f }, 0.5f },
        .specular = { FACET_DISTRIBUTION_GGX, FACET_MASKING_SMITH_CORRELATED, 0.25f },
        .fresnel = { FACET_FRESNEL_SCHLICK, { 0.04f, 0.04f, 0.04f }, 1.0f, { 1.5f, 1.5f, 1.5f }, { 0, 0, 0 }, 1.0f },
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
        facet_material m = good_material();                                                                          \
        facet_target t = scalar;                                                                                     \
        change;                                                                                                      \
        refuses_plan(#change, &m, t, code, field, index);                                                            \
    } while (0)
#define PLAN_ACCEPTS(change)                                                                                          \
    do {                                                                                                              \
        facet_material m = good_material();                                                                          \
        facet_target t = scalar;                                                                                     \
        change;                                                                                                      \
        accepts_plan(#change, &m, t);                                                                                \
    } while (0)

/* Every number of a material: its domain, and the stream that makes it ignored. */
static const struct { const char *field; size_t at; int components; float least, most; uint32_t stream; } numbers[] = {
#define NUMBER(name, components, ...) { #name, offsetof(facet_material, name), components, __VA_ARGS__ }
    NUMBER(diffuse.albedo, 3, -FLT_MAX, FLT_MAX, FACET_STREAM_ALBEDO),
    NUMBER(diffuse.sigma, 1, 0, PI_2, FACET_STREAM_SIGMA),
    NUMBER(specular.alpha, 1, 0, FLT_MAX, FACET_STREAM_ALPHA),
    NUMBER(fresnel.f0, 3, -FLT_MAX, FLT_MAX, FACET_STREAM_F0),
    NUMBER(fresnel.f90, 1, -FLT_MAX, FLT_MAX, 0),
    NUMBER(fresnel.eta, 3, FLT_TRUE_MIN, FLT_MAX, 0),
    NUMBER(fresnel.k, 3, 0, FLT_MAX, 0),
    NUMBER(fresnel.eta_outside, 1, 0, FLT_MAX, 0),
    NUMBER(emission, 3, -FLT_MAX, FLT_MAX, 0),
};

static facet_material with_number(size_t at, int component, float x)
{
    facet_material m = good_material();
    memcpy((char *)&m + at + (size_t)component * sizeof x, &x, sizeof x);
    return m;
}

static void test_numbers(void)
{
    test("every number of a material: NaN, infinite, at and beyond its domain's ends");
    for (size_t i = 0; i < sizeof numbers / sizeof numbers[0]; i++)
        for (int c = 0; c < numbers[i].components; c++) {
            const float least = numbers[i].least, most = numbers[i].most;
            const float refused[] = { NAN, -NAN, INFINITY, -INFINITY, nextafterf(least, -INFINITY),
                                      nextafterf(most, INFINITY) };
            const char *field = numbers[i].field;
            for (size_t k = 0; k < sizeof refused / sizeof refused[0]; k++) {
                facet_material m = with_number(numbers[i].at, c, refused[k]);
                refuses_plan(field, &m, scalar, FACET_ERROR_VALUE, field, numbers[i].components > 1 ? c : -1);
                m.streams = numbers[i].stream;
                if (m.streams) accepts_plan(field, &m, scalar);
            }
            facet_material lowest = with_number(numbers[i].at, c, least), highest = with_number(numbers[i].at, c, most);
            accepts_plan(field, &lowest, scalar);
            accepts_plan(field, &highest, scalar);
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
    PLAN_REFUSES(m.streams = 1u << 31, FACET_ERROR_ENUM, "streams", -1);
    PLAN_REFUSES(m.streams = FACET_STREAM_F0 << 1, FACET_ERROR_ENUM, "streams", -1);
    PLAN_REFUSES(m.streams = FACET_STREAM_NORMAL, FACET_ERROR_ENUM, "streams", -1);
    PLAN_REFUSES(m.streams = FACET_STREAM_VIEW, FACET_ERROR_ENUM, "streams", -1);

    test("eta in some channels alone; sigma's domain by model; models that are not built");
    for (int c = 0; c < 3; c++) PLAN_REFUSES(m.fresnel.eta[c] = 0, FACET_ERROR_VALUE, "fresnel.eta", c);
    PLAN_ACCEPTS(m.fresnel.eta[0] = m.fresnel.eta[1] = m.fresnel.eta[2] = 0);
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

static void test_targets(void)
{
    test("unknown and absent architectures and tiers");
    PLAN_REFUSES(t.arch = (facet_arch)99, FACET_ERROR_ENUM, "target.arch", -1);
    PLAN_REFUSES(t.arch = (facet_arch)-1, FACET_ERROR_ENUM, "target.arch", -1);
    PLAN_REFUSES(t.tier = (facet_tier)99, FACET_ERROR_ENUM, "target.tier", -1);
    PLAN_REFUSES(t.tier = (facet_tier)-1, FACET_ERROR_ENUM, "target.tier", -1);
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
    return (facet_batch){
        .count = COUNT, .normal = { stream, stream, stream }, .view = { stream, stream, stream },
        .albedo = { stream, stream, stream }, .sigma = stream, .alpha = stream, .f0 = { stream, stream, stream },
        .lights = lights, .light_count = 3, .radiance = { radiance[0], radiance[1], radiance[2] }, .invalid = &invalid,
    };
}

static void good_lights(facet_light *lights)
{
    for (int i = 0; i < 3; i++)
        lights[i] = (facet_light){ .direction = { 0, 0, 1 }, .irradiance = { 1, 1, 1 } };
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
    facet_light lights[3];                                                                                           \
    good_lights(lights);                                                                                             \
    facet_batch b = good_batch(lights);                                                                              \
    call
#define BATCH_REFUSES(plan, change, code, field, index)                                                               \
    do {                                                                                                              \
        CHANGED_BATCH(change);                                                                                       \
        refuses_batch(#change, plan, &b, code, field, index);                                                        \
    } while (0)
#define BATCH_ACCEPTS(plan, change)                                                                                   \
    do {                                                                                                              \
        CHANGED_BATCH(change);                                                                                       \
        accepts_batch(#change, plan, &b);                                                                            \
    } while (0)

static void test_streams(void)
{
    const facet_plan uniform = plan_with_streams(0), lambert = plan_lambert();
    const uint32_t all = FACET_STREAM_ALBEDO | FACET_STREAM_SIGMA | FACET_STREAM_ALPHA | FACET_STREAM_F0;
    const facet_plan streams = plan_with_streams(all);

    test("streams that are needed and not there");
    for (int c = 0; c < 3; c++) {
        BATCH_REFUSES(&uniform, b.normal[c] = NULL, FACET_ERROR_NULL, "normal", -1);
        BATCH_REFUSES(&uniform, b.view[c] = NULL, FACET_ERROR_NULL, "view", -1);
        BATCH_REFUSES(&streams, b.albedo[c] = NULL, FACET_ERROR_NULL, "albedo", -1);
        BATCH_REFUSES(&streams, b.f0[c] = NULL, FACET_ERROR_NULL, "f0", -1);
        BATCH_REFUSES(&uniform, b.radiance[c] = NULL, FACET_ERROR_NULL, "radiance", c);
    }
    BATCH_REFUSES(&streams, b.sigma = NULL, FACET_ERROR_NULL, "sigma", -1);
    BATCH_REFUSES(&streams, b.alpha = NULL, FACET_ERROR_NULL, "alpha", -1);

    test("a plan asks for what it was promised, and for nothing else");
    const struct { uint32_t stream; const char *field; } promises[] = {
        { FACET_STREAM_ALBEDO, "albedo" }, { FACET_STREAM_SIGMA, "sigma" },
        { FACET_STREAM_ALPHA, "alpha" }, { FACET_STREAM_F0, "f0" },
    };
    for (size_t i = 0; i < sizeof promises / sizeof promises[0]; i++) {
        const facet_plan plan = plan_with_streams(promises[i].stream);
        CHANGED_BATCH(b.sigma = b.alpha = b.albedo[0] = b.albedo[1] = b.albedo[2] = b.f0[0] = b.f0[1] = b.f0[2] = NULL);
        refuses_batch(promises[i].field, &plan, &b, FACET_ERROR_NULL, promises[i].field, -1);
        accepts_batch("a plan without streams", &uniform, &b);
    }

    test("view is needed by what depends on it");
    BATCH_ACCEPTS(&lambert, b.view[0] = b.view[1] = b.view[2] = NULL);
    BATCH_REFUSES(&lambert, (b.view[0] = b.view[1] = b.view[2] = NULL, b.flags = FACET_TWO_SIDED), FACET_ERROR_NULL,
                  "view", -1);
    BATCH_REFUSES(&uniform, b.view[0] = b.view[1] = b.view[2] = NULL, FACET_ERROR_NULL, "view", -1);
    for (int c = 0; c < 3; c++) BATCH_REFUSES(&lambert, b.view[c] = NULL, FACET_ERROR_NULL, "view", -1);
}

static void test_lights(void)
{
    const facet_plan plan = plan_with_streams(0);
    test("every malformed light, by its number");
    BATCH_REFUSES(&plan, b.lights = NULL, FACET_ERROR_NULL, "lights", -1);
    BATCH_ACCEPTS(&plan, (b.lights = NULL, b.light_count = 0));
    for (int i = 0; i < 3; i++) {
        BATCH_REFUSES(&plan, lights[i].kind = (facet_light_kind)9, FACET_ERROR_ENUM, "light.kind", i);
        BATCH_REFUSES(&plan, lights[i].direction[2] = 0, FACET_ERROR_VALUE, "light.direction", i);
        BATCH_REFUSES(&plan, lights[i].direction[2] = -0.0f, FACET_ERROR_VALUE, "light.direction", i);
        BATCH_REFUSES(&plan, memset(lights[i].irradiance, 0, sizeof lights[i].irradiance), FACET_ERROR_VALUE,
                      "light.irradiance", i);
        for (int c = 0; c < 3; c++) {
            BATCH_REFUSES(&plan, lights[i].direction[c] = NAN, FACET_ERROR_VALUE, "light.direction", i);
            BATCH_REFUSES(&plan, lights[i].direction[c] = -INFINITY, FACET_ERROR_VALUE, "light.direction", i);
            BATCH_REFUSES(&plan, lights[i].irradiance[c] = NAN, FACET_ERROR_VALUE, "light.irradiance", i);
            BATCH_REFUSES(&plan, lights[i].irradiance[c] = INFINITY, FACET_ERROR_VALUE, "light.irradiance", i);
            BATCH_REFUSES(&plan, lights[i].direction_of[c] = stream, FACET_ERROR_NULL, "light.direction_of", i);
            BATCH_REFUSES(&plan, lights[i].irradiance_of[c] = stream, FACET_ERROR_NULL, "light.irradiance_of", i);
        }
        BATCH_ACCEPTS(&plan, lights[i].irradiance[0] = -1);
        BATCH_ACCEPTS(&plan, (lights[i].irradiance[0] = FLT_TRUE_MIN, lights[i].direction[0] = 5));
    }

    test("a light's numbers are ignored where its streams stand");
    BATCH_ACCEPTS(&plan, (lights[1].direction_of[0] = lights[1].direction_of[1] = lights[1].direction_of[2] = stream,
                          lights[1].direction[0] = NAN));
    BATCH_ACCEPTS(&plan, (lights[1].irradiance_of[0] = lights[1].irradiance_of[1] = lights[1].irradiance_of[2] = stream,
                          lights[1].irradiance[0] = NAN));
}

static void test_batches(void)
{
    const facet_plan plan = plan_with_streams(0);
    test("no plan, no batch, unknown flag bits, ambient that is not finite");
    BATCH_REFUSES(NULL, (void)0, FACET_ERROR_NULL, "plan", -1);
    refuses_batch("batch NULL", &plan, NULL, FACET_ERROR_NULL, "batch", -1);
    BATCH_REFUSES(&plan, b.flags = 4, FACET_ERROR_ENUM, "flags", -1);
    BATCH_REFUSES(&plan, b.flags = 1u << 31 | FACET_ACCUMULATE, FACET_ERROR_ENUM, "flags", -1);
    BATCH_REFUSES(&plan, b.uniform = FACET_STREAM_F0 << 1, FACET_ERROR_ENUM, "uniform", -1);
    BATCH_REFUSES(&plan, b.uniform = 1u << 31, FACET_ERROR_ENUM, "uniform", -1);
    BATCH_ACCEPTS(&plan, b.uniform = 2 * FACET_STREAM_F0 - 1);
    BATCH_ACCEPTS(&plan, b.ambient[1] = -FLT_MAX);
    for (int c = 0; c < 3; c++) {
        BATCH_REFUSES(&plan, b.ambient[c] = NAN, FACET_ERROR_VALUE, "ambient", -1);
        BATCH_REFUSES(&plan, b.ambient[c] = -INFINITY, FACET_ERROR_VALUE, "ambient", -1);
    }
}

void test_refusals(void)
{
    stream[0] = 1;
    test_plan_pointers();
    test_numbers();
    test_models();
    test_targets();
    test_streams();
    test_lights();
    test_batches();
}
