/* Where shading methods fail, and what facet returns there: a test for each trap, on every architecture and tier, with
 * every kernel. The traps of geometry, small parameters, media and range are here, those of lights in lights.c, of odd
 * values in bad_values.c. */
#include "bad_values.h"
#include "lights.h"
#include "targets.h"

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
                s[k].tangent[c] *= scales[(k + i) % 7];
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

/* A tangent along the normal leaves no direction across it. */
static void tangent_along_the_normal(const subject *u)
{
    sample s[MOST];
    rgb radiance[MOST];
    ordinary(u, s, MOST);
    for (int i = 0; i < MOST; i++)
        for (int c = 0; c < 3; c++) s[i].tangent[c] = i % 2 ? s[i].n[c] : -0.5f * s[i].n[c];
    expect(shade(u, NULL, s, MOST, radiance) == 0, "%s: counted as invalid", u->kernel->name);
}

/* Opposite azimuths at grazing: the sum of the 1994 paper's terms is negative. */
static void negative_sum(const subject *u)
{
    const facet_diffuse model = u->kernel->material.diffuse.model;
    sample s[4];
    if (has_specular(u) || (model != FACET_DIFFUSE_OREN_NAYAR_FULL && model != FACET_DIFFUSE_OREN_NAYAR_DIRECT)) return;
    for (int i = 0; i < 4; i++) {
        const float t = ldexpf(1, -7 - 4 * i);
        s[i] = with_vectors(up, (float[]){ -1, 0, t }, (float[]){ 1, 0, 2 * t });
        s[i].sigma = 1;
        for (int c = 0; c < 3; c++) s[i].albedo[c] = 0.05f;
    }
    expect_dark(u, s, 4);
}

/* The half vector at a right angle to n, but for 2^-8 and less: e^(-tan^2/alpha^2) is 0, its factor 1/nh^4 is not. */
static void beckmann_far_from_the_peak(const subject *u)
{
    const facet_distribution model = u->kernel->material.specular.model;
    sample s[SMALL];
    if (has_diffuse(u)
        || (model != FACET_DISTRIBUTION_BECKMANN && model != FACET_DISTRIBUTION_BECKMANN_ANISOTROPIC)) return;
    for (int i = 0; i < SMALL; i++) {
        const float t = fminf(small[i], 0x1p-8f);
        s[i] = with_vectors(up, (float[]){ 1, 0, t }, (float[]){ 0, 1, t });
    }
    expect_dark(u, s, SMALL);
}

/* A Phong lobe ends where r.v <= 0; the dot products are exact. */
static void behind_the_lobe(const subject *u)
{
    const facet_distribution model = u->kernel->material.specular.model;
    const float right[] = { 1, 0, 1 }, lower[] = { 2, 0, 1 }, far[] = { 4, 0, 0.25f };
    sample s[] = { with_vectors(up, right, right), with_vectors(up, lower, right), with_vectors(up, right, far),
                   with_vectors(up, far, far) };
    if (has_diffuse(u) || (model != FACET_DISTRIBUTION_PHONG && model != FACET_DISTRIBUTION_PHONG_MODIFIED)) return;
    for (int e = 0; e < 3; e++) {
        for (int i = 0; i < 4; i++) s[i].exponent = (float[]){ FACET_EXPONENT_MIN, 30, FACET_EXPONENT_MAX }[e];
        expect_dark(u, s, 4);
    }
}

/* ---- Small parameters -------------------------------------------------------------------------------------------- */

/* Around the mirror direction, where D turns on 1 - nh^2. */
static void small_alpha(const subject *u)
{
    static const float alphas[] = { 1e-4f, 2e-4f, 1e-3f, 2e-3f, 1e-2f };
    test_random random = { 11 };
    for (int k = 0; k < (test_slow_machine ? 5 : 40) && has_specular(u); k++) {
        sample s[MOST];
        int count = 0;
        while (count < MOST) {
            s[count] = random_sample_of(u->kernel, &random, SAMPLES_LOBE, alphas[k % 5]);
            if (s[count].alpha > 2 * alphas[k % 5]) s[count].alpha = alphas[k % 5];
            if (k % 2) s[count].alpha_y = s[count].alpha;
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

static void exponents(const subject *u)
{
    test_random random = { 12 };
    sample s[MOST];
    if (!(u->kernel->streams & FACET_STREAM_EXPONENT)) return;
    for (int k = 0; k < 8; k++) {
        int count = 0;
        while (count < MOST) {
            s[count] = random_sample_of(u->kernel, &random, k % SAMPLES_KINDS, 0.01f);
            s[count].exponent = k < 4 ? FACET_EXPONENT_MIN : FACET_EXPONENT_MAX;
            if (in_domain(&s[count], reference_cosines(&s[count]))) count++;
        }
        expect_reference(u, s, MOST, false);
    }
}

/* ---- Media ------------------------------------------------------------------------------------------------------- */

static bool is_exact(const subject *u)
{
    const facet_fresnel model = u->kernel->material.fresnel.model;
    return has_specular(u) && (model == FACET_FRESNEL_DIELECTRIC || model == FACET_FRESNEL_CONDUCTOR);
}

static float eta_outside(const subject *u)
{
    const float eta = u->kernel->material.fresnel.eta_outside;
    return eta == 0 ? 1 : eta;
}

static void set_index(sample *s, int count, float eta, float k)
{
    for (int i = 0; i < count; i++)
        for (int c = 0; c < 3; c++) s[i].eta[c] = eta, s[i].k[c] = k;
}

/* The light passes what is like the medium around it, also at grazing. */
static void index_of_outside(const subject *u)
{
    sample s[MOST];
    if (!is_exact(u) || has_diffuse(u)) return;
    ordinary(u, s, MOST);
    for (int i = 0; i < SMALL; i++)
        s[i] = with_vectors(up, (float[]){ -1, 0, small[i] }, (float[]){ 1, 0, small[SMALL - 1 - i] });
    set_index(s, MOST, eta_outside(u), 0);
    expect_dark(u, s, MOST);
}

static void index_near_outside(const subject *u)
{
    sample s[MOST];
    if (!is_exact(u)) return;
    for (int i = 0; i < 16; i++) {
        const float step = ldexpf(eta_outside(u), -23 + i);
        for (int sign = -1; sign <= 1; sign += 2) {
            ordinary(u, s, MOST);
            set_index(s, MOST, eta_outside(u) + (float)sign * step, 0);
            expect_reference(u, s, MOST, false);
        }
    }
}

/* Beyond the critical angle, and not so near that vh's rounding may decide it. */
static void total_reflection(const subject *u)
{
    const float eta = 0.75f * eta_outside(u);
    facet_material mirror = streaming_material(u);
    sample s[MOST];
    rgb radiance[MOST], want[MOST];
    int count = 0;
    if (!is_exact(u) || mirror.fresnel.model != FACET_FRESNEL_DIELECTRIC) return;
    mirror.fresnel.model = FACET_FRESNEL_ONE;
    mirror.streams &= ~(uint32_t)FACET_STREAM_ETA;
    test_random random = { 17 };
    while (count < MOST) {
        s[count] = random_sample(&random, SAMPLES_GRAZING, 0.05f, u->kernel->sigma_max);
        const double vh = reference_cosines(&s[count]).vh;
        if (1 - vh * vh > 0.5626) count++;
    }
    set_index(s, MOST, eta, 0);
    shade(u, NULL, s, MOST, radiance);
    shade_material(u, &mirror, NULL, s, MOST, want);
    expect_same(u, radiance, want, MOST, "beyond the critical angle");
}

/* Held against the dielectric's kernel: each is within its bound of the same reference. */
static void conductor_of_no_extinction(const subject *u)
{
    facet_material dielectric = streaming_material(u);
    sample s[MOST];
    rgb radiance[MOST], want[MOST];
    if (!is_exact(u) || dielectric.fresnel.model != FACET_FRESNEL_CONDUCTOR) return;
    dielectric.fresnel.model = FACET_FRESNEL_DIELECTRIC;
    dielectric.streams &= ~(uint32_t)FACET_STREAM_K;
    ordinary(u, s, MOST);
    for (int i = 0; i < MOST; i++)
        for (int c = 0; c < 3; c++) s[i].k[c] = 0;
    expect_reference(u, s, MOST, false);
    shade(u, NULL, s, MOST, radiance);
    shade_material(u, &dielectric, NULL, s, MOST, want);
    for (int i = 0; i < MOST; i++)
        for (int c = 0; c < 3; c++)
            expect(fabsf(radiance[i][c] - want[i][c]) <= 1e-4f * want[i][c] + 1e-6f, "%s: %a, as a dielectric %a",
                   u->kernel->name, (double)radiance[i][c], (double)want[i][c]);
}

/* An index that follows from f0 is capped where f0 is 1 and more. */
static void index_of_full_reflectance(const subject *u)
{
    facet_material from_f0 = streaming_material(u), from_eta = from_f0;
    sample s[MOST];
    rgb capped[MOST], radiance[MOST];
    if (!is_exact(u) || from_f0.fresnel.model != FACET_FRESNEL_DIELECTRIC) return;
    from_f0.streams ^= FACET_STREAM_ETA | FACET_STREAM_F0;
    ordinary(u, s, MOST);
    set_index(s, MOST, FACET_ETA_CAP * eta_outside(u), 0);
    shade_material(u, &from_eta, NULL, s, MOST, capped);
    for (int i = 0; i < 3; i++) {
        const float f0 = (float[]){ 1, 2, FLT_MAX }[i];
        for (int k = 0; k < MOST; k++) s[k].f0[0] = s[k].f0[1] = s[k].f0[2] = f0;
        shade_material(u, &from_f0, NULL, s, MOST, radiance);
        for (int k = 0; k < MOST; k++)
            for (int c = 0; c < 3; c++)
                expect(fabsf(radiance[k][c] - capped[k][c]) <= 1e-5f * capped[k][c], "%s: f0 of %g: %a, not %a",
                       u->kernel->name, (double)f0, (double)radiance[k][c], (double)capped[k][c]);
    }
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
        s[i].alpha = s[i].alpha_y = FACET_ALPHA_FLOOR;
        for (int c = 0; c < 3; c++) s[i].albedo[c] = FLT_MAX, s[i].irradiance[c] = FLT_MAX;
    }
    shade(u, NULL, s, MOST, radiance);
    expect_within(u, radiance, MOST, u->kernel->lobe ? 0.999f * FLT_MAX : FLT_MAX, FLT_MAX);
    shade(u, &much, s, MOST, radiance);
    expect_all(u, radiance, MOST, FLT_MAX);
    for (int i = 0; i < MOST; i++) negate(s[i].l);
    shade(u, NULL, s, MOST, radiance);
    expect_all(u, radiance, MOST, 0);
}

/* ---- The suite --------------------------------------------------------------------------------------------------- */

/* Infinities of one light, or of one part of its light, take nothing from what else there is: here emission, and with
 * ambient light more than FLT_MAX of it. */
static void infinities_stay_apart(const subject *u)
{
    static const float views[][3] = { { 0, 4.9f, -1 }, { 0, 6, -4 }, { 0, 1e20f, 1e19f }, { 0, 0, 1 },
                                      { 0, 0.6f, 0.8f } };
    static const float lights[][3] = { { 0, 1, 0.01f }, { 0, 1, 0.1f }, { 0, 1e20f, -1e19f }, { 0, 1e20f, 1e19f },
                                       { 0.6f, 0, 0.8f } };
    static const extras plain = { .emission = { 1, 1, 1 } };
    static const extras bright = { .emission = { 1, 1, 1 }, .ambient = { FLT_MAX, FLT_MAX, FLT_MAX } };
    facet_material material = streaming_material(u);
    sample s[25];
    rgb radiance[25];
    material.specular.scale = FLT_MAX;
    for (int i = 0; i < 25; i++) {
        s[i] = with_vectors(up, views[i % 5], lights[i / 5]);
        s[i].alpha = s[i].alpha_y = 0.01f;
        if (i % 2) s[i].albedo[0] = s[i].f0[0] = 0;
        if (i % 3) s[i].irradiance[2] = 0;
    }
    for (int k = 0; k < 2; k++) {
        shade(u, k ? &bright : &plain, s, 25, radiance);
        for (int i = 0; i < 25; i++)
            for (int c = 0; c < 3; c++) expect(radiance[i][c] >= 1, "%s: sample %d lost it", u->kernel->name, i);
        shade_material(u, &material, k ? &bright : &plain, s, 25, radiance);
        for (int i = 0; i < 25; i++)
            for (int c = 0; c < 3; c++) expect(radiance[i][c] >= 1, "%s: scaled %d lost it", u->kernel->name, i);
    }
}

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
    { "tangent along the normal", tangent_along_the_normal },
    { "the full Oren-Nayar's negative sum is 0", negative_sum },
    { "Beckmann far from the peak is 0", beckmann_far_from_the_peak },
    { "a Phong lobe ends where r.v <= 0", behind_the_lobe },
    { "alpha small, near the peak", small_alpha },
    { "sigma = 0 is Lambert", sigma_zero },
    { "exponents of 1 and 10000", exponents },
    { "eta as outside, k = 0: reflects nothing", index_of_outside },
    { "eta nearly as outside", index_near_outside },
    { "eta below outside: reflects all beyond the critical angle", total_reflection },
    { "a conductor of k = 0 is a dielectric", conductor_of_no_extinction },
    { "eta from f0 >= 1 is capped", index_of_full_reflectance },
    { "overflow saturates at FLT_MAX", overflow },
    { "vectors far from unit length", far_from_unit },
    { "infinities of one light take nothing from the rest", infinities_stay_apart },
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
    for (int i = 0; i < target_count(); i++) {
        test("%s, %s", t->name, target_words(target_at(i)));
        run_on_all_kernels(t, target_at(i));
    }
}

void suite_stability(void)
{
    for (size_t i = 0; i < sizeof traps / sizeof traps[0]; i++) run_trap(&traps[i]);
    for (int i = 0; i < light_trap_count; i++) run_trap(&light_traps[i]);
    for (int i = 0; i < bad_value_count; i++) run_trap(&bad_values[i]);
}
