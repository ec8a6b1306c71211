/* Values that are not finite or outside their domains, in every stream. */
#include "bad_values.h"

#include <float.h>
#include <math.h>
#include <string.h>

/* ---- Values that are not finite ---------------------------------------------------------------------------------- */

/* A float of a sample, and whether the kernel reads it. */
typedef struct { const char *name; size_t at; uint32_t stream; } component;

#define VECTOR(field, stream)                                                                                         \
    { #field " x", offsetof(sample, field), stream },                                                                 \
    { #field " y", offsetof(sample, field) + sizeof(float), stream },                                                 \
    { #field " z", offsetof(sample, field) + 2 * sizeof(float), stream }

static const component components[] = {
    VECTOR(n, 0), VECTOR(v, 0), VECTOR(l, 0), VECTOR(irradiance, 0), VECTOR(albedo, FACET_STREAM_ALBEDO),
    VECTOR(f0, FACET_STREAM_F0), { "sigma", offsetof(sample, sigma), FACET_STREAM_SIGMA },
    { "alpha", offsetof(sample, alpha), FACET_STREAM_ALPHA },
};
enum { COMPONENTS = sizeof components / sizeof components[0] };

static bool is_read(const subject *u, const component *k)
{
    return !k->stream || u->kernel->streams & k->stream;
}

static float *component_of(sample *s, const component *k)
{
    return (float *)((char *)s + k->at);
}

static void not_finite(const subject *u)
{
    static const extras constant = { .emission = { 1, 1, 1 }, .ambient = { 1, 1, 1 } };
    static const int places[] = { 0, 9, 36 };
    const float bad[] = { NAN, INFINITY, -INFINITY };
    enum { COUNT = 37 };
    sample clean[COUNT];
    rgb expected[COUNT];
    ordinary(u, clean, COUNT);
    shade(u, &constant, clean, COUNT, expected);
    for (int k = 0; k < COMPONENTS; k++)
        for (int i = 0; i < 9; i += test_slow_machine ? 4 : 1) {
            sample s[COUNT];
            rgb radiance[COUNT], want[COUNT];
            const int place = places[i / 3];
            const bool read = is_read(u, &components[k]);
            memcpy(s, clean, sizeof s);
            memcpy(want, expected, sizeof want);
            *component_of(&s[place], &components[k]) = bad[i % 3];
            if (read) memset(want[place], 0, sizeof want[place]);
            expect(shade(u, &constant, s, COUNT, radiance) == read, "%s: %s of %d not counted right", u->kernel->name,
                   components[k].name, place);
            expect_same(u, radiance, want, COUNT, components[k].name);
        }
}

static void not_finite_visibility(const subject *u)
{
    const float bad[] = { NAN, INFINITY, -INFINITY };
    float visibility[9] = { 1, 0.5f, 0, 1, 2, -1, 1, 1, 1 };
    const extras x = { .visibility = visibility };
    sample s[9];
    rgb before[9], radiance[9];
    ordinary(u, s, 9);
    shade(u, &x, s, 9, before);
    for (int i = 0; i < 3; i++) {
        visibility[6] = bad[i];
        expect(shade(u, &x, s, 9, radiance) == 1, "%s: not one invalid sample", u->kernel->name);
        memset(before[6], 0, sizeof before[6]);
        expect_same(u, radiance, before, 9, "visibility");
    }
}

static void not_finite_destination(const subject *u)
{
    static const extras accumulate = { .flags = FACET_ACCUMULATE };
    const float bad[] = { NAN, INFINITY, -INFINITY };
    sample s[9];
    rgb before[9], radiance[9];
    ordinary(u, s, 9);
    for (int i = 0; i < 3; i++)
        for (int c = 0; c < 3; c++) {
            memset(before, 0, sizeof before);
            memset(radiance, 0, sizeof radiance);
            radiance[4][c] = bad[i];
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

/* Setting a component to each of `outside` gives the bytes of setting it to `inside`; also beside other light, where a
 * negative part would not end as 0. */
static void expect_clamped(const subject *u, const component *k, const float *outside, int count, float inside)
{
    static const extras cases[] = { { .flags = 0 }, { .emission = { 1, 1, 1 }, .ambient = { 1, 1, 1 } } };
    for (int e = 0; e < 2; e++) {
        sample s[16];
        rgb clamped[16], radiance[16];
        ordinary(u, s, 16);
        for (int i = 0; i < 16; i++) *component_of(&s[i], k) = inside;
        expect(shade(u, &cases[e], s, 16, clamped) == 0, "%s: counted as invalid", u->kernel->name);
        for (int o = 0; o < count; o++) {
            for (int i = 0; i < 16; i++) *component_of(&s[i], k) = outside[o];
            expect(shade(u, &cases[e], s, 16, radiance) == 0, "%s: %s %a: counted as invalid", u->kernel->name, k->name,
                   (double)outside[o]);
            expect_same(u, radiance, clamped, 16, k->name);
        }
    }
}

static const float negative[] = { -0.0f, -0x1p-149f, -1e-20f, -0.5f, -1, -1e20f, -FLT_MAX };
enum { NEGATIVE = sizeof negative / sizeof negative[0] };

static void negative_counts_as_zero(const subject *u)
{
    for (int k = 0; k < COMPONENTS; k++) {
        const size_t at = components[k].at;
        if (at >= offsetof(sample, albedo) && at != offsetof(sample, alpha))
            expect_clamped(u, &components[k], negative, NEGATIVE, 0);
    }
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

static const component *find_component(const char *name)
{
    for (int k = 0; k < COMPONENTS; k++)
        if (!strcmp(components[k].name, name)) return &components[k];
    return NULL;
}

static void alpha_outside(const subject *u)
{
    static const float above[] = { 0x1.000002p0f, 2, 1e20f, FLT_MAX }, below[] = { 0, 0x1p-149f, 1e-20f, 0.9e-4f };
    const component *alpha = find_component("alpha");
    expect_clamped(u, alpha, above, 4, 1);
    expect_clamped(u, alpha, below, 4, FACET_ALPHA_FLOOR);
    expect_clamped(u, alpha, negative, NEGATIVE, FACET_ALPHA_FLOOR);
}

static void sigma_and_f0_above(const subject *u)
{
    static const float above[] = { 0x1.922p0f, 2, 1e20f, FLT_MAX };
    if (u->kernel->sigma_max > 0) expect_clamped(u, find_component("sigma"), above, 4, u->kernel->sigma_max);
    expect_clamped(u, find_component("f0 x"), above, 4, 1);
    expect_clamped(u, find_component("f0 z"), above, 4, 1);
}

/* ---- Anything ---------------------------------------------------------------------------------------------------- */

static float any_float(test_random *r, bool finite)
{
    const uint64_t bits = random_u64(r);
    const float odd[] = { NAN, INFINITY, -INFINITY };
    if (!finite && bits % 64 == 0) return odd[(bits >> 8) % 3];
    if (bits % 3 == 0) return edge_values[(bits >> 8) % (unsigned)edge_count];
    return ldexpf((float)(2 * random_unit(r) - 1), (int)((bits >> 8) % 300) - 170);
}

static void anything(const subject *u)
{
    static const extras constant = { .emission = { 0, 1e-30f, 1e30f }, .ambient = { 1e30f, 0, 1 },
                                     .flags = FACET_TWO_SIDED };
    test_random random = { 13 };
    for (int round = 0; round < (test_slow_machine ? 4 : 100); round++) {
        sample s[MOST];
        rgb radiance[MOST];
        size_t bad = 0, perhaps = 0;
        for (int i = 0; i < MOST; i++) {
            bool invalid = false;
            double largest = 0;
            for (int k = 0; k < COMPONENTS; k++) {
                float *x = component_of(&s[i], &components[k]);
                *x = any_float(&random, round % 2);
                if (is_read(u, &components[k]) && !isfinite(*x)) invalid = true;
            }
            for (int c = 0; c < 3; c++) largest = fmax(largest, fabs(s[i].n[c]));
            bad += invalid || largest == 0;
            perhaps += !invalid && largest > 0 && largest < 1e-18;
        }
        const size_t counted = shade(u, round % 4 < 2 ? &constant : NULL, s, MOST, radiance);
        expect(counted >= bad && counted <= bad + perhaps, "%s: %zu counted as invalid, not %zu to %zu",
               u->kernel->name, counted, bad, bad + perhaps);
    }
}

/* ---- The traps --------------------------------------------------------------------------------------------------- */

const trap bad_values[] = {
    { "NaN or infinite: 0 and counted, neighbours as ever", not_finite },
    { "NaN or infinite visibility", not_finite_visibility },
    { "NaN or infinite destination", not_finite_destination },
    { "what is not covered is not counted", not_covered },
    { "alpha outside [floor, 1] is clamped", alpha_outside },
    { "sigma and f0 above their domains are clamped", sigma_and_f0_above },
    { "visibility outside [0, 1] is clamped", visibility_outside },
    { "negative streams count as 0", negative_counts_as_zero },
    { "negative constants count as 0", negative_constants },
    { "a negative destination counts as 0", negative_destination },
    { "any floats at all", anything },
};
const int bad_value_count = (int)(sizeof bad_values / sizeof bad_values[0]);
