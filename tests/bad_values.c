/* Values that are not finite or outside their domains, in every stream. */
#include "bad_values.h"
#include "recipes.h"

#include <float.h>
#include <math.h>
#include <string.h>

/* ---- Values that are not finite ---------------------------------------------------------------------------------- */

/* A float of a sample, and the stream that it goes into; 0: one that every kernel reads. */
typedef struct { const char *name; size_t at; uint32_t stream; } component;

#define COMPONENT_1(field, stream) { #field, offsetof(sample, field), stream }
#define COMPONENT_3(field, stream)                                                                                    \
    { #field " x", offsetof(sample, field), stream },                                                                 \
    { #field " y", offsetof(sample, field) + sizeof(float), stream },                                                 \
    { #field " z", offsetof(sample, field) + 2 * sizeof(float), stream }
#define OF_GEOMETRY(id, field, components)
#define OF_SOURCE(id, field, components)
#define OF_MATERIAL(id, field, components) COMPONENT_##components(field, FACET_STREAM_##id),

static const component components[] = {
#define FACET_STREAM(id, field, components, owner, ...) OF_##owner(id, field, components)
#include "streams.def"
    COMPONENT_3(n, 0), COMPONENT_3(v, 0), COMPONENT_3(l, 0), COMPONENT_3(irradiance, 0),
    COMPONENT_3(tangent, FACET_STREAM_TANGENT), COMPONENT_3(position, FACET_STREAM_POSITION),
};
enum { COMPONENTS = sizeof components / sizeof components[0] };

static float *component_of(sample *s, const component *k)
{
    return (float *)((char *)s + k->at);
}

static bool is_direction(const component *k)
{
    return k->at >= offsetof(sample, l) && k->at < offsetof(sample, l) + sizeof ((sample *)0)->l;
}

/* A light's place takes the place of its direction. */
static bool is_read(const subject *u, const sample *s, const component *k)
{
    if (k->stream == FACET_STREAM_POSITION) return s->light;
    return k->stream ? u->kernel->streams & k->stream : !(s->light && is_direction(k));
}

/* The ends of a stream's domain, for this kernel. */
static void domain_of(const subject *u, uint32_t stream, float *lowest, float *highest)
{
    const struct { float sigma_max; } at = { u->kernel->sigma_max }, *p = &at;
    switch (stream) {
#define FACET_STREAM(id, field, components, owner, low, high, title)                                                  \
    case FACET_STREAM_##id:                                                                                           \
        *lowest = low;                                                                                                \
        *highest = high;                                                                                              \
        break;
#include "streams.def"
    }
}

static const float odd[] = { NAN, INFINITY, -INFINITY };

/* Whether a value makes its sample invalid: an infinity beyond an end of its stream's domain is clamped to it. What is
 * a light's own has no stream. */
static bool is_invalid(const subject *u, uint32_t stream, float value)
{
    float low = -FLT_MAX, high = FLT_MAX;
    if (stream) domain_of(u, stream, &low, &high);
    return isnan(value) || (value == INFINITY && high == FLT_MAX) || (value == -INFINITY && low == -FLT_MAX);
}
static const extras all_of_1 = { .emission = { 1, 1, 1 }, .ambient = { 1, 1, 1 } };

enum { AMIDST = 37 };

/* Each of these components in turn is not finite at three places of the samples: 0 there and counted, where it is
 * read. */
static void expect_invalid(const subject *u, const sample *clean, bool parameters)
{
    static const int places[] = { 0, 9, 36 };
    rgb expected[AMIDST];
    shade(u, &all_of_1, clean, AMIDST, expected);
    for (int k = 0; k < COMPONENTS; k++)
        for (int i = 0; i < 3; i += test_slow_machine ? 2 : 1) {
            if (!parameters && components[k].stream >= FACET_STREAM_ALBEDO) break;
            sample s[AMIDST];
            rgb radiance[AMIDST], want[AMIDST];
            const int place = places[i];
            const bool read = is_read(u, clean, &components[k]);
            memcpy(s, clean, sizeof s);
            memcpy(want, expected, sizeof want);
            const float value = odd[(i + k) % 3];
            *component_of(&s[place], &components[k]) = is_invalid(u, components[k].stream, value) ? value : NAN;
            if (read) memset(want[place], 0, sizeof want[place]);
            expect(shade(u, &all_of_1, s, AMIDST, radiance) == read, "%s: %s of %d not counted right", u->kernel->name,
                   components[k].name, place);
            expect_same(u, radiance, want, AMIDST, components[k].name);
        }
}

static void not_finite(const subject *u)
{
    sample s[AMIDST];
    ordinary(u, s, AMIDST);
    expect_invalid(u, s, true);
}

static void not_finite_under_a_spot(const subject *u)
{
    static const facet_light spot = { .kind = FACET_LIGHT_SPOT, .position = { 0.25f, 2, -1 }, .range = 9,
                                      .axis = { 0, -0.6f, 0.8f }, .cos_inner = 0.5f, .cos_outer = -0.5f };
    sample s[AMIDST];
    ordinary(u, s, AMIDST);
    for (int i = 0; i < AMIDST; i++) light_sample(&s[i], &spot, 3);
    expect_invalid(u, s, false);
}

static void zero_tangent(const subject *u)
{
    const bool read = u->kernel->streams & FACET_STREAM_TANGENT;
    sample s[9];
    rgb radiance[9], before[9];
    ordinary(u, s, 9);
    shade(u, &all_of_1, s, 9, before);
    memset(s[2].tangent, 0, sizeof s[2].tangent);
    memcpy(s[7].tangent, (float[]){ -0.0f, 0, -0.0f }, sizeof s[7].tangent);
    expect(shade(u, &all_of_1, s, 9, radiance) == (read ? 2 : 0), "%s: not counted right", u->kernel->name);
    if (read) memset(before[2], 0, sizeof before[2]);
    if (read) memset(before[7], 0, sizeof before[7]);
    expect_same(u, radiance, before, 9, "a zero tangent, or its neighbour");
}

static void not_finite_visibility(const subject *u)
{
    float visibility[9] = { 1, 0.5f, 0, 1, 2, -1, 1, 1, 1 };
    const extras x = { .visibility = visibility };
    sample s[9];
    rgb before[9], radiance[9];
    ordinary(u, s, 9);
    shade(u, &x, s, 9, before);
    for (int i = 0; i < 3; i++) {
        visibility[6] = odd[i];
        expect(shade(u, &x, s, 9, radiance) == 1, "%s: not one invalid sample", u->kernel->name);
        memset(before[6], 0, sizeof before[6]);
        expect_same(u, radiance, before, 9, "visibility");
    }
}

/* Occlusion is read where there is ambient light to be occluded. */
static void not_finite_occlusion(const subject *u)
{
    float occlusion[9] = { 1, 0.5f, 0, 1, 2, -1, 1, 1, 1 };
    const extras x = { .ambient = { 1, 2, 3 }, .occlusion = occlusion };
    sample s[9];
    rgb before[9], radiance[9];
    if (!has_diffuse(u)) return;
    ordinary(u, s, 9);
    shade(u, &x, s, 9, before);
    occlusion[6] = NAN;
    expect(shade(u, &x, s, 9, radiance) == 1, "%s: not one invalid sample", u->kernel->name);
    memset(before[6], 0, sizeof before[6]);
    expect_same(u, radiance, before, 9, "occlusion");
}

static void not_finite_destination(const subject *u)
{
    static const extras accumulate = { .flags = FACET_ACCUMULATE };
    sample s[9];
    rgb before[9], radiance[9];
    ordinary(u, s, 9);
    for (int i = 0; i < 3; i++)
        for (int c = 0; c < 3; c++) {
            memset(before, 0, sizeof before);
            memset(radiance, 0, sizeof radiance);
            radiance[4][c] = odd[i];
            shade(u, &accumulate, s, 9, before);
            memset(before[4], 0, sizeof before[4]);
            expect(shade(u, &accumulate, s, 9, radiance) == 1, "%s: not one invalid sample", u->kernel->name);
            expect_same(u, radiance, before, 9, "destination");
        }
}

static void not_covered(const subject *u)
{
    static const uint8_t coverage[] = { 0x55, 0x0f, 0xfe };
    static const extras x = { .coverage = coverage };
    enum { COUNT = 21 };
    sample s[COUNT];
    rgb expected[COUNT], covered[COUNT];
    ordinary(u, s, COUNT);
    shade(u, NULL, s, COUNT, expected);
    for (int i = 0; i < COUNT; i++) {
        covered[i][0] = covered[i][1] = covered[i][2] = 42;
        if (coverage[i / 8] >> i % 8 & 1) continue;
        float *const bad[] = { s[i].n, s[i].l, s[i].irradiance };
        bad[i % 3][2] = NAN;
        memcpy(expected[i], covered[i], sizeof expected[i]);
    }
    expect(shade(u, &x, s, COUNT, covered) == 0, "%s: counts what is not covered", u->kernel->name);
    expect_same(u, covered, expected, COUNT, "covered or 42");
}

/* ---- Parameters outside their domains ---------------------------------------------------------------------------- */

/* Setting a float of the samples to each of `outside` gives the bytes of setting it to `inside`; also beside other
 * light, where a negative part would not end as 0. */
static void expect_clamped(const subject *u, const facet_material *m, const component *k, const float *outside,
                           int count, float inside)
{
    static const extras cases[] = { { .flags = 0 }, { .emission = { 1, 1, 1 }, .ambient = { 1, 1, 1 } } };
    for (int e = test_slow_machine; e < 2; e++) {
        sample s[16];
        rgb clamped[16], radiance[16];
        ordinary(u, s, 16);
        for (int i = 0; i < 16; i++) *component_of(&s[i], k) = inside;
        expect(shade_material(u, m, &cases[e], s, 16, clamped) == 0, "%s: counted as invalid", u->kernel->name);
        for (int o = 0; o < count; o++) {
            for (int i = 0; i < 16; i++) *component_of(&s[i], k) = outside[o];
            expect(shade_material(u, m, &cases[e], s, 16, radiance) == 0, "%s: %s %a: counted as invalid",
                   u->kernel->name, k->name, (double)outside[o]);
            expect_same(u, radiance, clamped, 16, k->name);
        }
    }
}

static const float negative[] = { -0.0f, -0x1p-149f, -1e-20f, -0.5f, -1, -1e20f, -FLT_MAX, -INFINITY };
enum { NEGATIVE = sizeof negative / sizeof negative[0] - 1 };      /* finite ones */

static void expect_clamped_to_domain(const subject *u, const facet_material *m, const component *k)
{
    float low = 0, high = 0;
    domain_of(u, k->stream, &low, &high);
    const float below[] = { 0, 0x1p-149f, 1e-20f, nextafterf(low, 0) };
    const float above[] = { nextafterf(high, INFINITY), 2 * high, 1e20f, FLT_MAX, INFINITY };
    expect_clamped(u, m, k, negative, NEGATIVE + 1, low);
    if (low > 0) expect_clamped(u, m, k, below, 4, low);
    if (high < FLT_MAX) expect_clamped(u, m, k, above, 5, high);
}

static void parameters_outside(const subject *u)
{
    const facet_material material = streaming_material(u);
    for (int k = 0; k < COMPONENTS; k++)
        if (u->kernel->promised & components[k].stream) expect_clamped_to_domain(u, &material, &components[k]);
}

static void negative_irradiance(const subject *u)
{
    const facet_material material = streaming_material(u);
    for (int k = 0; k < COMPONENTS; k++)
        if (components[k].at >= offsetof(sample, irradiance) && !components[k].stream)
            expect_clamped(u, &material, &components[k], negative, NEGATIVE, 0);
}

static void visibility_outside(const subject *u)
{
    static const float outside[] = { -0.0f, -0x1p-149f, -1, -FLT_MAX, 0x1.000002p0f, 2, 1e20f, FLT_MAX };
    static const float inside[] = { 0, 0, 0, 0, 1, 1, 1, 1 };
    const extras x = { .emission = { 1, 1, 1 }, .visibility = outside };
    const extras y = { .emission = { 1, 1, 1 }, .visibility = inside };
    sample s[8];
    rgb radiance[8], clamped[8];
    ordinary(u, s, 8);
    expect(shade(u, &x, s, 8, radiance) == 0, "%s: counted as invalid", u->kernel->name);
    shade(u, &y, s, 8, clamped);
    expect_same(u, radiance, clamped, 8, "visibility");
}

static void negative_constants(const subject *u)
{
    static const extras less = { .emission = { -1, -FLT_MAX, -0.0f }, .ambient = { -FLT_MAX, -1, -0x1p-149f } };
    facet_material material = streaming_material(u);
    sample s[9];
    rgb zero[9], radiance[9];
    ordinary(u, s, 9);
    shade(u, NULL, s, 9, zero);
    shade(u, &less, s, 9, radiance);
    expect_same(u, radiance, zero, 9, "emission and ambient");

    material.streams &= ~(uint32_t)(FACET_STREAM_ALBEDO | FACET_STREAM_F0);
    shade_material(u, &material, NULL, s, 9, zero);
    for (int c = 0; c < 3; c++) material.diffuse.albedo[c] = material.fresnel.f0[c] = -FLT_MAX;
    shade_material(u, &material, NULL, s, 9, radiance);
    expect_same(u, radiance, zero, 9, "albedo and f0 of the material");
}

static void negative_destination(const subject *u)
{
    static const extras accumulate = { .flags = FACET_ACCUMULATE };
    sample s[9];
    rgb zero[9] = { { 0 } }, radiance[9];
    ordinary(u, s, 9);
    shade(u, &accumulate, s, 9, zero);
    for (int i = 0; i < 9; i++)
        for (int c = 0; c < 3; c++) radiance[i][c] = negative[(i + c) % NEGATIVE];
    shade(u, &accumulate, s, 9, radiance);
    expect_same(u, radiance, zero, 9, "destination");
}

static void occlusion_outside(const subject *u)
{
    static const float outside[] = { -0.0f, -0x1p-149f, -1, -INFINITY, 0x1.000002p0f, 2, FLT_MAX, INFINITY };
    static const float inside[] = { 0, 0, 0, 0, 1, 1, 1, 1 };
    const extras x = { .ambient = { 1, 2, 3 }, .sh = { { 1, 1, 1 } }, .occlusion = outside };
    const extras y = { .ambient = { 1, 2, 3 }, .sh = { { 1, 1, 1 } }, .occlusion = inside };
    sample s[8];
    rgb radiance[8], clamped[8];
    ordinary(u, s, 8);
    expect(shade(u, &x, s, 8, radiance) == 0, "%s: counted as invalid", u->kernel->name);
    shade(u, &y, s, 8, clamped);
    expect_same(u, radiance, clamped, 8, "occlusion");
}

/* ---- Parameters that follow from others -------------------------------------------------------------------------- */

/* Where shade takes the streams of other conventions from. */
static const component sources[] = {
    { "base", offsetof(sample, albedo[1]), FACET_STREAM_BASE },
    { "metallic", offsetof(sample, f0[0]), FACET_STREAM_METALLIC },
    { "specular_level", offsetof(sample, f0[1]), FACET_STREAM_SPECULAR_LEVEL },
    { "roughness", offsetof(sample, alpha), FACET_STREAM_ROUGHNESS },
    { "glossiness", offsetof(sample, alpha), FACET_STREAM_GLOSSINESS },
};
enum { SOURCES = sizeof sources / sizeof sources[0] };

/* Runs the test with each stream that a recipe of the kernel reads, all of them per sample. */
static void with_recipes(const subject *u, void (*run)(const subject *, const facet_material *, const component *))
{
    for (int i = 0; i < recipe_count(); i++) {
        const recipe *r = recipe_at(i);
        facet_material m = u->kernel->material;
        if (r->kernel != u->kernel || !is_derived(r)) continue;
        m.convention.model = r->convention;
        m.streams = r->reads & ~(FACET_STREAM_ALBEDO - 1u);
        for (int k = 0; k < COMPONENTS; k++)
            if (m.streams & components[k].stream) run(u, &m, &components[k]);
        for (int k = 0; k < SOURCES; k++)
            if (m.streams & sources[k].stream) run(u, &m, &sources[k]);
    }
}

static void expect_invalid_source(const subject *u, const facet_material *m, const component *k)
{
    sample clean[AMIDST];
    rgb expected[AMIDST];
    ordinary(u, clean, AMIDST);
    expect(shade_material(u, m, &all_of_1, clean, AMIDST, expected) == 0, "%s: invalid", u->kernel->name);
    for (int i = 0; i < 3; i++) {
        sample s[AMIDST];
        rgb radiance[AMIDST], want[AMIDST];
        const int place = 18 * i;
        if (!is_invalid(u, k->stream, odd[i])) continue;
        memcpy(s, clean, sizeof s);
        memcpy(want, expected, sizeof want);
        *component_of(&s[place], k) = odd[i];
        memset(want[place], 0, sizeof want[place]);
        expect(shade_material(u, m, &all_of_1, s, AMIDST, radiance) == 1, "%s: %s of %g not counted", u->kernel->name,
               k->name, (double)odd[i]);
        expect_same(u, radiance, want, AMIDST, k->name);
    }
}

static void sources_not_finite(const subject *u) { with_recipes(u, expect_invalid_source); }
static void sources_outside(const subject *u) { with_recipes(u, expect_clamped_to_domain); }

/* ---- Anything ---------------------------------------------------------------------------------------------------- */

static float any_float(test_random *r, bool finite)
{
    const uint64_t bits = random_u64(r);
    if (!finite && bits % 64 == 0) return odd[(bits >> 8) % 3];
    if (bits % 3 == 0) return edge_values[(bits >> 8) % (unsigned)edge_count];
    return ldexpf((float)(2 * random_unit(r) - 1), (int)((bits >> 8) % 300) - 170);
}

static double largest_of(const float *a)
{
    return fmax(fmax(fabs(a[0]), fabs(a[1])), fabs(a[2]));
}

static void anything(const subject *u)
{
    static const extras constant = { .emission = { 0, 1e-30f, 1e30f }, .ambient = { 1e30f, 0, 1 },
                                     .sh = { { 1, -1e30f, 1e30f }, { 1e38f, -1, 0 }, { -1e38f, 1, 1 }, { 1 } },
                                     .flags = FACET_TWO_SIDED };
    static const facet_light lights[] = {
        { .kind = FACET_LIGHT_POINT, .position = { 1, -1e-20f, 0 }, .range = 1e20f },
        { .kind = FACET_LIGHT_SPOT, .position = { 1e20f, 1, 0 }, .axis = { 1e-30f, 1e30f, 1 }, .cos_inner = 1 },
    };
    test_random random = { 13 };
    for (int round = 0; round < (test_slow_machine ? 4 : 100); round++) {
        sample s[MOST];
        rgb radiance[MOST];
        size_t bad = 0, perhaps = 0;
        for (int i = 0; i < MOST; i++) {
            bool invalid = false;
            s[i].light = round % 8 < 4 ? NULL : &lights[round % 2];
            for (int k = 0; k < COMPONENTS; k++) {
                float *x = component_of(&s[i], &components[k]);
                *x = any_float(&random, round % 2);
                if (is_read(u, &s[i], &components[k]) && is_invalid(u, components[k].stream, *x)) invalid = true;
            }
            const bool tangent = u->kernel->streams & FACET_STREAM_TANGENT;
            const double least = fmin(largest_of(s[i].n), tangent ? largest_of(s[i].tangent) : 1);
            bad += invalid || least == 0;
            perhaps += !invalid && least > 0 && least < 1e-18;
        }
        const size_t counted = shade(u, round % 4 < 2 ? &constant : NULL, s, MOST, radiance);
        expect(counted >= bad && counted <= bad + perhaps, "%s: %zu counted as invalid, not %zu to %zu",
               u->kernel->name, counted, bad, bad + perhaps);
    }
}

/* ---- The traps --------------------------------------------------------------------------------------------------- */

const trap bad_values[] = {
    { "NaN or infinite: 0 and counted, neighbours as ever", not_finite },
    { "NaN or infinite under a spot light", not_finite_under_a_spot },
    { "NaN or infinite visibility", not_finite_visibility },
    { "NaN in occlusion", not_finite_occlusion },
    { "NaN or infinite in what parameters follow from", sources_not_finite },
    { "NaN or infinite destination", not_finite_destination },
    { "what is not covered is not counted", not_covered },
    { "a zero tangent: 0 and counted where it is read", zero_tangent },
    { "parameters outside their domains are clamped", parameters_outside },
    { "what parameters follow from is clamped to its own domain", sources_outside },
    { "visibility outside [0, 1] is clamped", visibility_outside },
    { "occlusion outside [0, 1] is clamped", occlusion_outside },
    { "negative irradiance counts as 0", negative_irradiance },
    { "negative constants count as 0", negative_constants },
    { "a negative destination counts as 0", negative_destination },
    { "any floats at all", anything },
};
const int bad_value_count = (int)(sizeof bad_values / sizeof bad_values[0]);
