/* Where shading methods fail, and what facet returns there: a test for each trap, on every architecture and tier, with
 * every kernel. The traps of geometry, small parameters and range are here, those of odd values in bad_values.c. */
#include "bad_values.h"

#include <float.h>
#include <math.h>
#include <string.h>

static const float up[] = { 0, 0, 1 }, slanted[] = { 0.6f, 0, 0.8f };

/* ---- Geometry ---------------------------------------------------------------------------------------------------- */

static void facing_away(const subject *u)
{
    static const extras constant = { .emission = { 1, 2, 3 }, .ambient = { 4, 5, 6 } };
    sample s[3 * 16], dark[3 * 16];
    rgb radiance[3 * 16], unlit[3 * 16];
    ordinary(u, s, 3 * 16);
    memcpy(dark, s, sizeof dark);
    for (int i = 0; i < 16; i++) {
        negate(s[i].l);
        negate(s[16 + i].v);
        negate(s[32 + i].n);
    }
    for (int i = 0; i < 3 * 16; i++) memset(dark[i].irradiance, 0, sizeof dark[i].irradiance);
    expect(shade(u, NULL, s, 3 * 16, radiance) == 0, "%s: counted as invalid", u->kernel->name);
    expect_all(u, radiance, 3 * 16, 0);
    shade(u, &constant, s, 3 * 16, radiance);
    shade(u, &constant, dark, 3 * 16, unlit);
    expect_same(u, radiance, unlit, 3 * 16, "ambient and emission");
    for (int i = 0; i < 3 * 16; i++) expect(radiance[i][0] >= 1, "%s: no emission", u->kernel->name);
}

static void at_right_angles(const subject *u)
{
    static const float x[] = { 1, 0, 0 }, y[] = { 0, 1, 0 };
    const sample s[] = { with_vectors(up, up, x), with_vectors(up, x, up), with_vectors(up, x, y),
                         with_vectors(up, x, x) };
    rgb radiance[4];
    shade(u, NULL, s, 4, radiance);
    expect_all(u, radiance, 4, 0);
}

/* Cosines from 1 down through the subnormals; the dot products are exact. */
static const float small[] = { 0x1p-4f, 0x1p-10f, 0x1p-21f, 0x1p-22f, 0x1p-23f, 1e-8f, 1e-10f, 1e-20f, 1e-30f, 1e-37f,
                               0x1p-126f, 0x1p-127f, 0x1p-140f, 0x1p-148f, 0x1p-149f };
enum { SMALL = sizeof small / sizeof small[0] };

static void small_nl(const subject *u)
{
    sample s[SMALL];
    for (int i = 0; i < SMALL; i++) s[i] = with_vectors(up, slanted, (float[]){ -1, 0, small[i] });
    expect_reference(u, s, SMALL, true);
    for (int i = 0; i < SMALL; i++) s[i].alpha = 1e-4f;
    expect_reference(u, s, SMALL, true);
}

static void small_nv(const subject *u)
{
    sample s[SMALL];
    for (int i = 0; i < SMALL; i++) s[i] = with_vectors(up, (float[]){ -1, 0, small[i] }, slanted);
    expect_reference(u, s, SMALL, true);
}

/* Subnormal, either may be taken for FLT_MIN. */
static void small_nl_and_nv(const subject *u)
{
    sample s[SMALL];
    rgb radiance[SMALL];
    int normal = 0;
    for (int i = 0; i < SMALL; i++) {
        s[i] = with_vectors(up, (float[]){ -1, 0, small[i] }, (float[]){ 0, 1, small[i] });
        normal += small[i] >= FLT_MIN;
    }
    expect_reference(u, s, normal, true);
    shade(u, NULL, s, SMALL, radiance);
}

static void along_the_normal(const subject *u)
{
    sample s[48];
    ordinary(u, s, 48);
    for (int i = 0; i < 16; i++) {
        memcpy(s[i].v, s[i].n, sizeof s[i].v);
        memcpy(s[16 + i].l, s[16 + i].n, sizeof s[i].l);
        memcpy(s[32 + i].v, s[32 + i].n, sizeof s[i].v);
        memcpy(s[32 + i].l, s[32 + i].n, sizeof s[i].l);
    }
    expect_reference(u, s, 48, false);
    s[0] = with_vectors(up, up, up);
    expect_reference(u, s, 1, true);
}

/* v = -l: there is no half vector, and no finite sample is invalid for it. */
static void opposed(const subject *u)
{
    const float left[] = { -1, 0, 0 }, right[] = { 1, 0, 0 }, slant_down[] = { -0.6f, 0, -0.8f };
    const sample s[] = { with_vectors(up, left, right), with_vectors(up, slanted, slant_down),
                         with_vectors(up, slant_down, slanted) };
    static const extras plain = { .emission = { 1, 1, 1 } };
    static const extras two_sided = { .emission = { 1, 1, 1 }, .flags = FACET_TWO_SIDED };
    rgb radiance[3];
    expect(shade(u, &plain, s, 3, radiance) == 0, "%s: counted as invalid", u->kernel->name);
    expect_all(u, radiance, 3, 1);
    expect(shade(u, &two_sided, s, 3, radiance) == 0, "%s: counted as invalid", u->kernel->name);
    expect_all(u, radiance, 3, 1);
}

/* Near v = -l the specular part is not 0: with height-correlated masking f nl tends to F/(4 pi alpha^3). */
static void nearly_opposed(const subject *u)
{
    sample s[30];
    for (int i = 0; i < 30; i++) {
        const float t = ldexpf(1, -10 - i);
        s[i] = with_vectors(up, (float[]){ -1, 0, t }, (float[]){ 1, 0, t });
    }
    expect_reference(u, s, 30, true);
}

static void beyond_one(const subject *u)
{
    sample s[27];
    const float lengths[] = { 0x1.fffffcp-1f, 1, 0x1.000004p0f };
    for (int i = 0; i < 27; i++)
        s[i] = with_vectors((float[]){ 0, lengths[i % 3], 0 }, (float[]){ 0, lengths[i / 3 % 3], 0 },
                            (float[]){ 0, lengths[i / 9], 0 });
    expect_reference(u, s, 27, false);
    for (int i = 0; i < 27; i++) negate(s[i].l);
    rgb radiance[27];
    shade(u, NULL, s, 27, radiance);
    expect_all(u, radiance, 27, 0);
}

static void zero_normal(const subject *u)
{
    static const extras constant = { .emission = { 1, 1, 1 }, .ambient = { 1, 1, 1 } };
    sample s[9];
    rgb radiance[9], before[9];
    ordinary(u, s, 9);
    shade(u, &constant, s, 9, before);
    memset(s[2].n, 0, sizeof s[2].n);
    memcpy(s[7].n, (float[]){ -0.0f, 0, -0.0f }, sizeof s[7].n);
    expect(shade(u, &constant, s, 9, radiance) == 2, "%s: not two invalid samples", u->kernel->name);
    expect_all(u, &radiance[2], 1, 0);
    expect_all(u, &radiance[7], 1, 0);
    memcpy(before[2], radiance[2], sizeof before[2]);
    memcpy(before[7], radiance[7], sizeof before[7]);
    expect_same(u, radiance, before, 9, "a neighbour of a zero normal");
}

static void far_from_unit(const subject *u)
{
    static const float scales[] = { 1e-30f, 1e-20f, 1e-10f, 1, 1e10f, 1e20f, 1e30f };
    sample s[49];
    rgb radiance[49];
    for (int i = 0; i < 7; i++) {
        ordinary(u, s, 49);
        for (int k = 0; k < 49; k++)
            for (int c = 0; c < 3; c++) {
                s[k].n[c] *= scales[i];
                s[k].v[c] *= scales[k % 7];
                s[k].l[c] *= scales[k / 7];
            }
        shade(u, NULL, s, 49, radiance);
    }
}

static void two_sided(const subject *u)
{
    static const extras flip = { .flags = FACET_TWO_SIDED };
    sample s[MOST];
    rgb front[MOST], back[MOST];
    ordinary(u, s, MOST);
    shade(u, NULL, s, MOST, front);
    shade(u, &flip, s, MOST, back);
    expect_same(u, back, front, MOST, "from the front");
    for (int i = 0; i < MOST; i++) negate(s[i].n);
    shade(u, &flip, s, MOST, back);
    expect_same(u, back, front, MOST, "from behind");
    for (int i = 0; i < MOST; i++) negate(s[i].l);
    shade(u, &flip, s, MOST, back);
    expect_all(u, back, MOST, 0);
}

/* ---- Small parameters -------------------------------------------------------------------------------------------- */

/* Around the mirror direction, where D turns on 1 - nh^2. */
static void small_alpha(const subject *u)
{
    static const float alphas[] = { 1e-4f, 2e-4f, 1e-3f, 2e-3f, 1e-2f };
    test_random random = { 11 };
    for (int k = 0; k < (test_slow_machine ? 5 : 100); k++) {
        sample s[MOST];
        int count = 0;
        while (count < MOST) {
            s[count] = random_sample(&random, SAMPLES_LOBE, alphas[k % 5], u->kernel->sigma_max);
            if (s[count].alpha > 2 * alphas[k % 5]) s[count].alpha = alphas[k % 5];
            if (in_domain(&s[count], reference_cosines(&s[count]))) count++;
        }
        expect_reference(u, s, MOST, false);
    }
}

static void sigma_zero(const subject *u)
{
    if (u->kernel->sigma_max == 0) return;
    facet_material material = streaming_material(u);
    sample s[MOST];
    rgb lambert[MOST], radiance[MOST];
    ordinary(u, s, MOST);
    for (int i = 0; i < MOST; i++) s[i].sigma = 0;
    shade(u, NULL, s, MOST, radiance);
    material.diffuse.model = FACET_DIFFUSE_LAMBERT;
    shade_material(u, &material, NULL, s, MOST, lambert);
    expect_same(u, radiance, lambert, MOST, "sigma = 0 in a stream");

    material.diffuse.model = u->kernel->material.diffuse.model;
    material.streams &= ~(uint32_t)FACET_STREAM_SIGMA;
    shade_material(u, &material, NULL, s, MOST, radiance);
    expect_same(u, radiance, lambert, MOST, "sigma = 0 of the material");
}

/* ---- Range ------------------------------------------------------------------------------------------------------- */

static void overflow(const subject *u)
{
    static const extras much = { .emission = { FLT_MAX, FLT_MAX, FLT_MAX }, .ambient = { FLT_MAX, FLT_MAX, FLT_MAX } };
    sample s[MOST];
    rgb radiance[MOST];
    ordinary(u, s, MOST);
    for (int i = 0; i < MOST; i++) {
        s[i] = with_vectors(s[i].n, s[i].n, s[i].n);
        s[i].alpha = FACET_ALPHA_FLOOR;
        for (int c = 0; c < 3; c++) s[i].albedo[c] = FLT_MAX, s[i].irradiance[c] = FLT_MAX;
    }
    shade(u, NULL, s, MOST, radiance);
    expect_all(u, radiance, MOST, FLT_MAX);
    shade(u, &much, s, MOST, radiance);
    expect_all(u, radiance, MOST, FLT_MAX);
    for (int i = 0; i < MOST; i++) negate(s[i].l);
    shade(u, NULL, s, MOST, radiance);
    expect_all(u, radiance, MOST, 0);
}

/* ---- The suite --------------------------------------------------------------------------------------------------- */

static const trap traps[] = {
    { "nl < 0 or nv < 0: nothing but ambient and emission", facing_away },
    { "nl = 0 or nv = 0", at_right_angles },
    { "nl tiny or subnormal: f nl falls linearly", small_nl },
    { "nv tiny or subnormal: f nl has a limit", small_nv },
    { "nl and nv tiny or subnormal", small_nl_and_nv },
    { "v = n, l = n", along_the_normal },
    { "v + l = 0", opposed },
    { "v + l near 0", nearly_opposed },
    { "cosines beyond 1", beyond_one },
    { "zero normal: 0 and counted", zero_normal },
    { "alpha small, near the peak", small_alpha },
    { "sigma = 0 is Lambert", sigma_zero },
    { "overflow saturates at FLT_MAX", overflow },
    { "vectors far from unit length", far_from_unit },
    { "two-sided turns the normal", two_sided },
};

static void run_on_all_kernels(const trap *t, facet_target target)
{
    for (int i = 0; i < case_count(); i++) {
        const accuracy_row *row = find_accuracy(case_at(i)->name, target.tier);
        if (!expect(row, "accuracy.tsv has no row of %s", case_at(i)->name)) continue;
        t->run(&(subject){ target, case_at(i), &row->bound });
    }
}

static void run_trap(const trap *t)
{
    for (int arch = FACET_ARCH_BEST + 1; facet_word(FACET_KIND_ARCH, arch); arch++)
        for (int tier = 0; facet_word(FACET_KIND_TIER, tier); tier++) {
            if (!facet_has(FACET_KIND_ARCH, arch) || !facet_has(FACET_KIND_TIER, tier)) continue;
            test("%s, %s %s", t->name, facet_word(FACET_KIND_ARCH, arch), facet_word(FACET_KIND_TIER, tier));
            run_on_all_kernels(t, (facet_target){ (facet_arch)arch, (facet_tier)tier });
        }
}

void suite_stability(void)
{
    for (size_t i = 0; i < sizeof traps / sizeof traps[0]; i++) run_trap(&traps[i]);
    for (int i = 0; i < bad_value_count; i++) run_trap(&bad_values[i]);
}
