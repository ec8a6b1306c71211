/* Truths of media and of light: Fresnel's equations in complex arithmetic, published reflectances, flux and irradiance
 * by their integrals. */
#include "truths.h"

#include "samples.h"

#include <complex.h>
#include <string.h>

/* ---- Fresnel's equations in complex arithmetic ------------------------------------------------------------------- */

typedef struct { double s, p; } reflectances;

/* From a medium of index `outside` into one of eta + ik. The transmitted wave fades where Im(index cos_t) > 0. */
static reflectances fresnel(double eta, double k, double outside, double cos_i)
{
    const double complex index = eta + I * k, sin_t = outside / index * sqrt(fmax(0, 1 - cos_i * cos_i));
    double complex cos_t = csqrt(1 - sin_t * sin_t);
    if (cimag(index * cos_t) < 0) cos_t = -cos_t;
    const double complex s = (outside * cos_i - index * cos_t) / (outside * cos_i + index * cos_t);
    const double complex p = (index * cos_i - outside * cos_t) / (index * cos_i + outside * cos_t);
    return (reflectances){ pow(cabs(s), 2), pow(cabs(p), 2) };
}

static double polarised(reflectances r, double polarisation)
{
    return r.s * (1 - polarisation) / 2 + r.p * (1 + polarisation) / 2;
}

/* v and l at that angle to their half vector, which is the normal. */
static sample at_angle(double vh)
{
    const double sine = sqrt(1 - vh * vh);
    sample s = white();
    store(s.v, (vec){ sine, 0, vh });
    store(s.l, (vec){ -sine, 0, vh });
    s.alpha = 0.5f;
    return s;
}

/* Near a critical angle the cosine's rounding counts for much: there they are compared on its either side. */
static void check_exact_fresnel(facet_fresnel model)
{
    test("%s is Fresnel's equations", facet_word(FACET_KIND_FRESNEL, (int)model));
    test_random random = { 55 };
    for (int i = 0; i < some_of(100000); i++) {
        facet_material m = specular_material(FACET_DISTRIBUTION_GGX, FACET_MASKING_SMITH);
        const sample drawn = random_sample(&random, SAMPLES_UNIFORM, 0.1f, 1);
        sample s = at_angle(random_unit(&random));
        memcpy(s.eta, drawn.eta, sizeof s.eta);
        memcpy(s.k, drawn.k, sizeof s.k);
        m.fresnel.model = model;
        m.fresnel.eta_outside = i & 1 ? drawn.eta[1] : 0;
        m.fresnel.polarisation = i & 2 ? (float)(2 * random_unit(&random) - 1) : (float)(i >> 2 & 1);
        const double outside = i & 1 ? drawn.eta[1] : 1, k = model == FACET_FRESNEL_CONDUCTOR ? s.k[0] : 0;
        const double vh = fmin(reference_cosines(&s).vh, 1), got = reference_fresnel(&m, &s, 0);
        const double want = polarised(fresnel(s.eta[0], k, outside, vh), m.fresnel.polarisation);
        const double before = polarised(fresnel(s.eta[0], k, outside, vh * (1 - 1e-13)), m.fresnel.polarisation);
        expect(fabs(got - want) <= 1e-9 * want + 1e-15 + fabs(before - want),
               "%.12g, not %.12g: eta %g k %g outside %g polarisation %g vh %g", got, want, (double)s.eta[0], k,
               outside, (double)m.fresnel.polarisation, vh);
    }
}

/* At a cosine of 1/2 the fifth power is 1/32. */
static void check_schlick(void)
{
    test("Schlick's fifth power");
    facet_material m = specular_material(FACET_DISTRIBUTION_GGX, FACET_MASKING_SMITH);
    m.fresnel.model = FACET_FRESNEL_SCHLICK;
    sample s = at_angle(0.5);
    s.f0[0] = 0.04f;
    const double white_edge = reference_fresnel(&m, &s, 0);
    m.fresnel.f90 = 0.5f;
    const double grey_edge = reference_fresnel(&m, &s, 0);
    expect(fabs(white_edge - (0.04 + 0.96 / 32)) <= 1e-7, "%.9g", white_edge);
    expect(fabs(grey_edge - (0.04 + 0.46 / 32)) <= 1e-7, "%.9g", grey_edge);
}

/* F82 meets f0, f82 and 1: at normal incidence, at a cosine of 1/7 and at grazing; f82 from eta and k is the exact. */
static void check_f82(void)
{
    test("F82 meets its three values");
    facet_material m = specular_material(FACET_DISTRIBUTION_GGX, FACET_MASKING_SMITH);
    m.fresnel.model = FACET_FRESNEL_SCHLICK_F82;
    m.fresnel.f82[0] = 0.4f;
    sample normal = at_angle(1), seventh = at_angle(1.0 / 7), grazing = at_angle(1e-6);
    normal.f0[0] = seventh.f0[0] = grazing.f0[0] = 0.6f;
    const double f0 = reference_fresnel(&m, &normal, 0), f82 = reference_fresnel(&m, &seventh, 0);
    expect(fabs(f0 - 0.6) < 1e-6, "f0 %g", f0);
    expect(fabs(f82 - 0.4) < 1e-6, "f82 %g", f82);
    expect(fabs(reference_fresnel(&m, &grazing, 0) - 1) < 1e-4, "at grazing %g", reference_fresnel(&m, &grazing, 0));

    m.fresnel.f82[0] = 0;
    m.fresnel.eta[0] = 2.9f;
    m.fresnel.k[0] = 3.1f;
    const reflectances iron = fresnel(2.9f, 3.1f, 1, 1.0 / 7);
    const double derived = reference_fresnel(&m, &seventh, 0);
    expect(fabs(derived - polarised(iron, 0)) < 1e-6, "%g of eta and k, not %g", derived, polarised(iron, 0));
}

/* ---- Through the library ----------------------------------------------------------------------------------------- */

/* The radiance of one sample, its values in the material's numbers. False, and the test skipped, where the build lacks
 * a model. */
static bool shade_one(facet_tier tier, const facet_material *m, const sample *s, const facet_batch *extra,
                      float radiance[3])
{
    facet_plan plan;
    facet_error error;
    sample_batch b = batch_of(s, 1);
    const facet_status made = facet_plan_init(&plan, m, (facet_target){ .tier = tier }, &error);
    if (made == FACET_ERROR_MODEL || made == FACET_ERROR_ARCH) skip("not in this build");
    else expect(!made, "no plan: %s", error.field);
    if (extra) {
        memcpy(b.batch.ambient, extra->ambient, sizeof extra->ambient);
        memcpy(b.batch.sh, extra->sh, sizeof extra->sh);
        b.batch.occlusion = extra->occlusion;
    }
    if (!made) expect(!facet_shade(&plan, &b.batch, &error), "refused: %s", error.field);
    for (int c = 0; c < 3; c++) radiance[c] = b.batch.radiance[c][0];
    free_batch(&b);
    return !made;
}

/* F at that angle: the highlight over that of Fresnel one. False where the build lacks a model. */
static bool shade_fresnel(facet_tier tier, facet_material m, double vh, double F[3])
{
    const facet_material one = specular_material(FACET_DISTRIBUTION_GGX, FACET_MASKING_SMITH_CORRELATED);
    const sample s = at_angle(vh);
    float lit[3], all[3];
    m.specular = one.specular;
    m.specular.alpha = s.alpha;
    facet_material full = one;
    full.specular.alpha = s.alpha;
    if (!shade_one(tier, &m, &s, NULL, lit) || !shade_one(tier, &full, &s, NULL, all)) return false;
    for (int c = 0; c < 3; c++) F[c] = (double)lit[c] / all[c];
    return true;
}

static facet_material of_index(facet_fresnel model, double eta, double k)
{
    facet_material m = { .fresnel.model = model };
    for (int c = 0; c < 3; c++) m.fresnel.eta[c] = (float)eta, m.fresnel.k[c] = (float)k;
    return m;
}

static const char *tier_word(facet_tier tier) { return facet_word(FACET_KIND_TIER, (int)tier); }

/* Hoffman, "Background: physics and math of shading", SIGGRAPH 2013, table 1. */
static void check_dielectrics(facet_tier tier)
{
    static const struct { const char *name; double eta, f0; } known[] = {
        { "water", 1.333, 0.02 }, { "glass", 1.5, 0.04 }, { "diamond", 2.417, 0.17 },
    };
    test("water, glass and diamond at normal incidence, %s", tier_word(tier));
    for (int i = 0; i < 3; i++) {
        double F[3];
        if (!shade_fresnel(tier, of_index(FACET_FRESNEL_DIELECTRIC, known[i].eta, 0), 1, F)) return;
        expect(fabs(F[0] - known[i].f0) <= 0.005, "%s: %g, not %g", known[i].name, F[0], known[i].f0);
        expect(fabs(facet_f0_from_eta((float)known[i].eta, 0, 0) - F[0]) <= 1e-6, "facet_f0_from_eta differs");
    }
}

/* The same table. Its gold is of a colour space, ours of bands of wavelengths: blue differs. */
static void check_metals(facet_tier tier)
{
    static const struct { facet_metal metal; double f0[3], tolerance; } known[] = {
        { FACET_METAL_GOLD, { 1.00, 0.71, 0.29 }, 0.13 },      { FACET_METAL_COPPER, { 0.95, 0.64, 0.54 }, 0.04 },
        { FACET_METAL_ALUMINIUM, { 0.91, 0.92, 0.92 }, 0.04 },
    };
    test("gold, copper and aluminium at normal incidence, %s", tier_word(tier));
    for (int i = 0; i < 3; i++) {
        facet_material m = { .fresnel.model = FACET_FRESNEL_CONDUCTOR };
        double F[3];
        facet_index_of_metal(known[i].metal, m.fresnel.eta, m.fresnel.k);
        if (!shade_fresnel(tier, m, 1, F)) return;
        for (int c = 0; c < 3; c++)
            expect(fabs(F[c] - known[i].f0[c]) <= known[i].tolerance, "%s: %g, not %g",
                   facet_word(FACET_KIND_METAL, (int)known[i].metal), F[c], known[i].f0[c]);
    }
}

static void expect_reflectance(facet_tier tier, facet_material m, double vh, double want, const char *what)
{
    double F[3];
    if (shade_fresnel(tier, m, vh, F)) expect(fabs(F[0] - want) <= 2e-6, "%s: %g, not %g", what, F[0], want);
}

static void check_dielectric_angles(facet_tier tier)
{
    const double critical = sqrt(1 - 1 / (1.5 * 1.5)), brewster = cos(atan(1.5));
    facet_material inside = of_index(FACET_FRESNEL_DIELECTRIC, 1, 0);
    facet_material glass = of_index(FACET_FRESNEL_DIELECTRIC, 1.5, 0);
    inside.fresnel.eta_outside = 1.5f;
    test("total reflection and Brewster's angle, %s", tier_word(tier));
    expect_reflectance(tier, inside, critical - 1e-3, 1, "beyond the critical angle");
    expect_reflectance(tier, inside, critical / 2, 1, "far beyond the critical angle");
    expect_reflectance(tier, inside, critical + 0.05, polarised(fresnel(1, 0, 1.5, critical + 0.05), 0), "before it");
    expect_reflectance(tier, glass, brewster, polarised(fresnel(1.5, 0, 1, brewster), 0), "unpolarised");
    glass.fresnel.polarisation = 1;
    expect_reflectance(tier, glass, brewster, 0, "parallel at Brewster's angle");
    glass.fresnel.polarisation = -1;
    expect_reflectance(tier, glass, brewster, fresnel(1.5, 0, 1, brewster).s, "perpendicular at Brewster's angle");
    expect_reflectance(tier, of_index(FACET_FRESNEL_DIELECTRIC, 1, 0), 0.01, 0, "nothing to reflect from");
}

/* Every angle: the halves of polarised light sum up, a conductor without extinction is a dielectric, and both are
 * Fresnel's equations, in air and in water. */
static void check_media(facet_tier tier)
{
    test("media at every angle, %s", tier_word(tier));
    for (int i = 1; i < 64; i++) {
        const double vh = i / 64.0;
        facet_material gold = { .fresnel.model = FACET_FRESNEL_CONDUCTOR };
        facet_material glass = of_index(FACET_FRESNEL_DIELECTRIC, 1.5, 0);
        double parallel[3], perpendicular[3], neither[3];
        facet_index_of_metal(FACET_METAL_GOLD, gold.fresnel.eta, gold.fresnel.k);
        gold.fresnel.eta_outside = i & 1 ? 1.333f : 0;
        const double eta = gold.fresnel.eta[0], k = gold.fresnel.k[0];
        const double exact = polarised(fresnel(eta, k, i & 1 ? 1.333f : 1, vh), 0);
        expect_reflectance(tier, gold, vh, exact, i & 1 ? "gold in water" : "gold");
        expect_reflectance(tier, of_index(FACET_FRESNEL_CONDUCTOR, 1.5, 0), vh, polarised(fresnel(1.5, 0, 1, vh), 0),
                           "a conductor without extinction");
        expect_reflectance(tier, glass, vh, polarised(fresnel(1.5, 0, 1, vh), 0), "glass");
        if (!shade_fresnel(tier, glass, vh, neither)) return;
        glass.fresnel.polarisation = 1;
        shade_fresnel(tier, glass, vh, parallel);
        glass.fresnel.polarisation = -1;
        shade_fresnel(tier, glass, vh, perpendicular);
        expect(fabs((parallel[0] + perpendicular[0]) / 2 - neither[0]) <= 1e-6, "polarised %g, %g, neither %g",
               parallel[0], perpendicular[0], neither[0]);
    }
}

/* ---- Light ------------------------------------------------------------------------------------------------------- */

/* A white plane under a light, at rings around its foot whose cosines to the light are evenly spaced. */
enum { RINGS = 2000 };

static double ring_cosine(int i) { return 1 - (i + 0.5) / (double)RINGS; }

static void rings_under(const facet_light *light, sample *s)
{
    for (int i = 0; i < RINGS; i++) {
        const double radius = light->position[2] * sqrt(1 / pow(ring_cosine(i), 2) - 1);
        s[i] = white();
        s[i].position[0] = (float)(light->position[0] + radius);
        s[i].position[1] = light->position[1];
        s[i].v[2] = 1;
        s[i].light = light;
    }
}

/* The flux that falls in: pi L dA over the plane. */
static double flux_of(const facet_light *light, const double *radiance)
{
    double flux = 0;
    for (int i = 0; i < RINGS; i++)
        flux += PI * radiance[i] * 2 * PI * pow(light->position[2], 2) / pow(ring_cosine(i), 3) / (double)RINGS;
    return flux;
}

static double reference_flux(const facet_light *light)
{
    static sample s[RINGS];
    static double red[RINGS];
    rings_under(light, s);
    for (int i = 0; i < RINGS; i++) {
        double radiance[3];
        reference_radiance(&(facet_material){ .diffuse.model = FACET_DIFFUSE_LAMBERT }, &s[i], radiance);
        red[i] = radiance[0];
    }
    return flux_of(light, red);
}

/* NaN where the build lacks a model. */
static double library_flux(facet_tier tier, const facet_light *light)
{
    static sample s[RINGS];
    static double red[RINGS];
    facet_plan plan;
    const facet_material lambert = { .diffuse = { .model = FACET_DIFFUSE_LAMBERT, .albedo = { 1, 1, 1 } } };
    if (facet_plan_init(&plan, &lambert, (facet_target){ .tier = tier }, NULL)) return NAN;
    rings_under(light, s);
    sample_batch b = batch_of(s, RINGS);
    expect(!facet_shade(&plan, &b.batch, NULL), "refused");
    for (int i = 0; i < RINGS; i++) red[i] = b.batch.radiance[0][i];
    free_batch(&b);
    return flux_of(light, red);
}

/* Lights of a radiant intensity of 1 above the plane, and what falls onto it: half of all directions is 2 pi sr; a cone
 * of cosines a to b, smoothstep between, 2 pi (1 - (a + b)/2) sr; with a range R above a height h, of c0 = h/R,
 * 2 pi times the integral of (1 - c0^4/c^4)^2 from c0 to 1. */
enum { FLUXES = 3 };

static double expected_flux(int i, facet_light *light)
{
    static const facet_light lights[FLUXES] = {
        { .kind = FACET_LIGHT_POINT, .position = { 1, 2, 3 } },
        { .kind = FACET_LIGHT_SPOT, .position = { 0, -1, 0.5f }, .axis = { 0, 0, -1 }, .cos_inner = 0.9f,
          .cos_outer = 0.5f },
        { .kind = FACET_LIGHT_POINT, .position = { -1, 0, 2 }, .range = 5 },
    };
    const double c0 = 2.0 / 5, c4 = pow(c0, 4);
    const double steradians[FLUXES] = {
        2 * PI, 2 * PI * (1 - (0.9 + 0.5) / 2),
        2 * PI * (1 - c0 - 2 * c4 / 3 * (pow(c0, -3) - 1) + c4 * c4 / 7 * (pow(c0, -7) - 1)),
    };
    *light = lights[i];
    return steradians[i];
}

static void check_reference_flux(void)
{
    test("flux of point and spot lights");
    for (int i = 0; i < FLUXES; i++) {
        facet_light light;
        const double want = expected_flux(i, &light), flux = reference_flux(&light);
        expect(fabs(flux / want - 1) <= 1e-3, "light %d: %g of %g", i, flux, want);
    }
}

static void check_flux(facet_tier tier)
{
    test("flux of point and spot lights, %s", tier_word(tier));
    for (int i = 0; i < FLUXES; i++) {
        facet_light light;
        const double want = expected_flux(i, &light), flux = library_flux(tier, &light);
        if (isnan(flux)) skip("not in this build");
        else expect(fabs(flux / want - 1) <= 1e-3, "light %d: %g of %g", i, flux, want);
    }
}

/* Real spherical harmonics Y00, Y1-1, Y10, Y11. */
static double harmonic(int i, vec d)
{
    const double first = sqrt(1 / (4 * PI)), second = sqrt(3 / (4 * PI));
    return i == 0 ? first : second * (i == 1 ? d.y : i == 2 ? d.z : d.x);
}

/* Radiance from every direction, times its cosine, over the hemisphere of n. */
static double irradiance_of(const float sh[4][3], vec n, int channel)
{
    enum { STEPS = 256 };
    const vec x = unit(across(n, fabs(n.x) < 0.5 ? (vec){ 1, 0, 0 } : (vec){ 0, 1, 0 })), y = across(n, x);
    double sum = 0;
    for (int i = 0; i < STEPS; i++)
        for (int k = 0; k < STEPS; k++) {
            const double cosine = (i + 0.5) / (double)STEPS, sine = sqrt(1 - cosine * cosine);
            const double phi = 2 * PI * k / (double)STEPS;
            const vec d = plus(scaled(n, cosine), plus(scaled(x, sine * cos(phi)), scaled(y, sine * sin(phi))));
            double radiance = 0;
            for (int h = 0; h < 4; h++) radiance += sh[h][channel] * harmonic(h, d);
            sum += radiance * cosine;
        }
    return sum * 2 * PI / (STEPS * STEPS);
}

static void check_harmonics(facet_tier tier)
{
    test("irradiance of spherical harmonics by its integral, %s", tier_word(tier));
    test_random random = { 56 };
    const facet_material lambert = { .diffuse = { .model = FACET_DIFFUSE_LAMBERT, .albedo = { 1, 1, 1 } } };
    int dark = 0;
    for (int i = 0; i < 24; i += test_slow_machine ? 5 : 1) {
        facet_batch extra = { .ambient = { 0.25f, 0, 0.5f } };
        const float occlusion = i & 1 ? (float)random_unit(&random) : 1;
        sample s = random_sample(&random, SAMPLES_UNIFORM, 0.1f, 1);
        float got[3];
        extra.occlusion = &occlusion;
        for (int c = 0; c < 3; c++) s.irradiance[c] = 0;
        for (int h = 0; h < 4; h++)
            for (int c = 0; c < 3; c++) extra.sh[h][c] = (float)(random_unit(&random) * (h ? 4 : 1) - (h ? 2 : 0));
        if (!shade_one(tier, &lambert, &s, &extra, got)) return;
        for (int c = 0; c < 3; c++) {
            const double E = irradiance_of(extra.sh, unit_of(s.n), c);
            const double want = (fmax(E, 0) + extra.ambient[c]) * occlusion / PI;
            dark += E < 0;
            expect(fabs(got[c] - want) <= 2e-5, "%g, not %g (irradiance %g, occlusion %g)", (double)got[c], want, E,
                   (double)occlusion);
        }
    }
    expect(dark > 0, "none was negative");
}

/* ---- All of them ------------------------------------------------------------------------------------------------- */

void check_media_and_light(void)
{
    check_exact_fresnel(FACET_FRESNEL_DIELECTRIC);
    check_exact_fresnel(FACET_FRESNEL_CONDUCTOR);
    check_schlick();
    check_f82();
    check_reference_flux();
    for (int tier = 0; tier_word((facet_tier)tier); tier++) {
        if (!facet_has(FACET_KIND_TIER, tier)) continue;
        check_dielectrics((facet_tier)tier);
        check_metals((facet_tier)tier);
        check_dielectric_angles((facet_tier)tier);
        check_media((facet_tier)tier);
        check_flux((facet_tier)tier);
        check_harmonics((facet_tier)tier);
    }
}
