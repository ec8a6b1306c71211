/* Lights with a position, and ambient light. */
#include "lights.h"

#include <float.h>
#include <math.h>
#include <string.h>

static const float up[] = { 0, 0, 1 }, slanted[] = { 0.6f, 0, 0.8f };

/* ---- Lights with a position -------------------------------------------------------------------------------------- */

static facet_light point_light(void)
{
    return (facet_light){ .kind = FACET_LIGHT_POINT };
}

static facet_light spot_light(float cos_inner, float cos_outer)
{
    return (facet_light){ .kind = FACET_LIGHT_SPOT, .axis = { 0, 0, -1 }, .cos_inner = cos_inner,
                          .cos_outer = cos_outer };
}

/* Puts every sample straight below the light and facing up, and the eye too; the distance is exact. */
static void below(sample *s, int count, const facet_light *light, float distance)
{
    for (int i = 0; i < count; i++) {
        s[i] = with_vectors(up, slanted, up);
        memcpy(s[i].position, light->position, sizeof s[i].position);
        s[i].position[2] -= distance;
        s[i].light = light;
    }
}

static void at_the_light(const subject *u)
{
    static const float distances[] = { 0, 0x1p-149f, 1e-30f, 0x1p-64f, 1e20f, 1e30f, FLT_MAX };
    const facet_light lights[] = { point_light(), spot_light(0.5f, 0) };
    sample s[4];
    for (int k = 0; k < 2; k++)
        for (int i = 0; i < 7; i++) {
            below(s, 4, &lights[k], distances[i]);
            expect_dark(u, s, 4);
        }
}

/* The difference of the positions overflows. */
static void beyond_the_floats(const subject *u)
{
    facet_light far = point_light();
    sample s[4];
    far.position[2] = FLT_MAX;
    below(s, 4, &far, 0);
    for (int i = 0; i < 4; i++) s[i].position[2] = -FLT_MAX;
    expect_dark(u, s, 4);
}

/* At distances whose squares are the normal floats' ends something arrives, or it overflows; not where the surface or
 * the eye is turned away. */
static void near_and_far(const subject *u)
{
    const facet_light light = point_light();
    sample s[4];
    rgb radiance[4];
    below(s, 4, &light, 0x1p-63f);
    for (int i = 0; i < 4; i++)
        for (int c = 0; c < 3; c++) s[i].irradiance[c] = 1e30f;
    shade(u, NULL, s, 4, radiance);
    if (has_diffuse(u)) expect_within(u, radiance, 4, 1e36f, FLT_MAX);
    for (int i = 0; i < 4; i++) negate(i % 2 ? s[i].n : s[i].v);
    expect_dark(u, s, 4);
    below(s, 4, &light, 0x1p63f);
    for (int i = 0; i < 4; i++)
        for (int c = 0; c < 3; c++) s[i].irradiance[c] = FLT_MAX;
    shade(u, NULL, s, 4, radiance);
    if (has_diffuse(u)) expect_within(u, radiance, 4, FLT_MIN, FLT_MAX);
}

static void beyond_the_range(const subject *u)
{
    facet_light light = point_light();
    sample s[4];
    rgb radiance[4], endless[4];
    for (int i = 0; i < 5; i++) {
        light.range = (float[]){ 2, 1.5f, 1e-10f, FLT_MIN, 0x1p-149f }[i];
        below(s, 4, &light, 2);
        expect_dark(u, s, 4);
    }
    light.range = FLT_MAX;
    below(s, 4, &light, 2);
    shade(u, NULL, s, 4, radiance);
    light.range = 0;
    shade(u, NULL, s, 4, endless);
    expect_same(u, radiance, endless, 4, "a range of FLT_MAX");
}

/* The light's axis is at cosines of 1, 0.8, 0.6, 0 and -1 to what it shines upon. */
static void cones(const subject *u)
{
    static const struct { float inner, outer, lit[5]; } cases[] = {
        { 0.8f, 0.8f, { 1, 1, 0, 0, 0 } }, { 1, 1, { 1, 0, 0, 0, 0 } }, { -1, -1, { 1, 1, 1, 1, 1 } },
        { 0, 0, { 1, 1, 1, 1, 0 } },       { 1, 0.6f, { 1, 0.5f, 0, 0, 0 } },
        { 1, -1, { 1, 0.972f, 0.896f, 0.5f, 0 } },
    };
    static const float axes[5][3] = { { 0, 0, -1 }, { 0.6f, 0, -0.8f }, { 0, 0.8f, -0.6f }, { 0, 1, 0 }, { 0, 0, 1 } };
    const facet_light point = point_light();
    sample s[1];
    rgb whole[1], radiance[1];
    below(s, 1, &point, 1);
    shade(u, NULL, s, 1, whole);
    for (size_t k = 0; k < sizeof cases / sizeof cases[0]; k++)
        for (int i = 0; i < 5; i++) {
            facet_light light = spot_light(cases[k].inner, cases[k].outer);
            memcpy(light.axis, axes[i], sizeof light.axis);
            s[0].light = &light;
            shade(u, NULL, s, 1, radiance);
            for (int c = 0; c < 3; c++) {
                const float want = cases[k].lit[i] * whole[0][c];
                const bool whole_or_none = cases[k].lit[i] == 0 || cases[k].lit[i] == 1;
                expect(fabsf(radiance[0][c] - want) <= (whole_or_none ? 0 : 1e-5f * want), "%s: %g to %g, axis %d: %a",
                       u->kernel->name, (double)cases[k].inner, (double)cases[k].outer, i, (double)radiance[0][c]);
            }
        }
}

/* A point light far away along l is a directional one. */
static void point_and_direction(const subject *u)
{
    const facet_light light = point_light();
    sample s[MOST], under[MOST];
    rgb directional[MOST], radiance[MOST];
    ordinary(u, s, MOST);
    for (int i = 0; i < MOST; i++) s[i] = with_vectors(up, s[i].v, (float[]){ 0, 0.6f, 0.8f });
    memcpy(under, s, sizeof under);
    for (int i = 0; i < MOST; i++) {
        light_sample(&under[i], &light, 4);
        for (int c = 0; c < 3; c++) under[i].irradiance[c] *= 16;
    }
    shade(u, NULL, s, MOST, directional);
    shade(u, NULL, under, MOST, radiance);
    for (int i = 0; i < MOST; i++)
        for (int c = 0; c < 3; c++)
            expect(fabsf(radiance[i][c] - directional[i][c]) <= 1e-4f * directional[i][c] + 1e-6f,
                   "%s: %a at a distance of 4, %a without one", u->kernel->name, (double)radiance[i][c],
                   (double)directional[i][c]);
}

/* ---- Ambient light ----------------------------------------------------------------------------------------------- */

/* Of any sign, turning with n. */
static const extras turning = { .sh = { { 1, 0.5f, 0.25f }, { 1, -1, 0.5f }, { -0.5f, 1, 1 }, { 0.25f, -0.75f, -1 } } };

/* albedo/pi of pi Y00 sh[0] + 2 pi/3 (Y1.n of sh[1..3]), where that is not negative. */
static void harmonics(const subject *u)
{
    sample s[MOST];
    rgb lit[MOST], radiance[MOST];
    int negative = 0;
    ordinary(u, s, MOST);
    for (int i = 0; i < MOST; i++) negate(s[i].l);
    shade(u, NULL, s, MOST, lit);
    shade(u, &turning, s, MOST, radiance);
    for (int i = 0; i < MOST; i++)
        for (int c = 0; c < 3; c++) {
            const double y = s[i].n[1], z = s[i].n[2], x = s[i].n[0], pi = 3.14159265358979323846;
            const double Y1 = 0.488603 * (turning.sh[1][c] * y + turning.sh[2][c] * z + turning.sh[3][c] * x);
            const double E = pi * 0.282095 * turning.sh[0][c] + 2 * pi / 3 * Y1;
            const double want = has_diffuse(u) ? s[i].albedo[c] / pi * fmax(E, 0) : 0;
            negative += E < -1e-5;
            expect(fabs(radiance[i][c] - want) <= 1e-5, "%s: sample %d is %a, not %a", u->kernel->name, i,
                   (double)radiance[i][c], want);
            if (E < -1e-5) expect(radiance[i][c] == lit[i][c], "%s: negative light", u->kernel->name);
        }
    expect(negative > 10, "only %d are negative", negative);
}

static void negative_harmonics(const subject *u)
{
    static const extras ambient = { .ambient = { 1, 2, 3 } };
    static const extras both = { .ambient = { 1, 2, 3 }, .sh = { { -3, -1e-30f, -FLT_MAX }, { 0.1f, 0, 1 } } };
    sample s[MOST];
    rgb want[MOST], radiance[MOST];
    ordinary(u, s, MOST);
    shade(u, &ambient, s, MOST, want);
    shade(u, &both, s, MOST, radiance);
    expect_same(u, radiance, want, MOST, "negative harmonics beside ambient light");
}

static void two_sided_harmonics(const subject *u)
{
    extras flip = turning;
    sample s[MOST];
    rgb front[MOST], back[MOST];
    flip.flags = FACET_TWO_SIDED;
    ordinary(u, s, MOST);
    shade(u, &turning, s, MOST, front);
    shade(u, &flip, s, MOST, back);
    expect_same(u, back, front, MOST, "from the front");
    for (int i = 0; i < MOST; i++) negate(s[i].n);
    shade(u, &flip, s, MOST, back);
    expect_same(u, back, front, MOST, "from behind");
}

static void occluded(const subject *u)
{
    static const float occlusion[] = { 0, 0.5f, 1 };
    static const extras ambient = { .ambient = { 1, 2, 3 }, .sh = { { 1, 1, 1 } } };
    extras x = ambient;
    sample s[3];
    rgb whole[3], none[3], radiance[3];
    ordinary(u, s, 3);
    for (int i = 0; i < 3; i++) negate(s[i].l);
    x.occlusion = occlusion;
    shade(u, NULL, s, 3, none);
    shade(u, &ambient, s, 3, whole);
    shade(u, &x, s, 3, radiance);
    expect_same(u, &radiance[0], &none[0], 1, "occlusion of 0");
    expect_same(u, &radiance[2], &whole[2], 1, "occlusion of 1");
    for (int c = 0; c < 3; c++) expect(radiance[1][c] == 0.5f * whole[1][c], "%s: occlusion of 0.5", u->kernel->name);
}

/* ---- The traps --------------------------------------------------------------------------------------------------- */

const trap light_traps[] = {
    { "a light at a distance of 0, or of no normal square, adds 0", at_the_light },
    { "a light so far that the difference overflows adds 0", beyond_the_floats },
    { "a light very near, very far", near_and_far },
    { "a light out of range adds 0", beyond_the_range },
    { "a spot light's cones: steps, none, all around", cones },
    { "a light with a position is as one without", point_and_direction },
    { "harmonics, not below 0", harmonics },
    { "negative harmonics take nothing from ambient light", negative_harmonics },
    { "harmonics are of the turned normal", two_sided_harmonics },
    { "occlusion of 0, 1/2, 1", occluded },
};
const int light_trap_count = (int)(sizeof light_traps / sizeof light_traps[0]);
