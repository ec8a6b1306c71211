/* What is true of the models whatever form they are written in: the formulas as their papers print them, with angles;
 * integrals; complex arithmetic; published values. It shares no formula with reference.c, and holds the reference to
 * them, in places the library itself. */
#include "truths.h"

#include "samples.h"

#include <string.h>

static vec polar(double theta, double phi)
{
    return (vec){ sin(theta) * cos(phi), sin(theta) * sin(phi), cos(theta) };
}

/* ---- Angles ------------------------------------------------------------------------------------------------------ */

/* A sample's angles to the normal, and azimuths about it, of unit vectors; those of h too. */
typedef struct { double theta_i, phi_i, theta_r, phi_r, theta_h, phi_h; } angles;

static double angle_between(vec a, vec b) { return acos(fmin(fmax(dot(a, b), -1), 1)); }

static angles angles_of(const sample *s)
{
    const vec n = unit_of(s->n), l = unit_of(s->l), v = unit_of(s->v), h = unit(plus(l, v));
    const vec t = unit_of(s->tangent), x = unit(plus(t, scaled(n, -dot(n, t)))), y = across(n, x);
    return (angles){ angle_between(n, l), atan2(dot(l, y), dot(l, x)), angle_between(n, v),
                     atan2(dot(v, y), dot(v, x)), angle_between(n, h), atan2(dot(h, y), dot(h, x)) };
}

/* ---- Diffuse, as printed: f -------------------------------------------------------------------------------------- */

/* Oren and Nayar 1994, the simplified model, with 0.33 or as its note has it 0.57. */
static double printed_qualitative(angles g, double rho, double sigma, double fold)
{
    const double alpha = fmax(g.theta_i, g.theta_r), beta = fmin(g.theta_i, g.theta_r);
    const double A = 1 - 0.5 * pow(sigma, 2) / (pow(sigma, 2) + fold);
    const double B = 0.45 * pow(sigma, 2) / (pow(sigma, 2) + 0.09);
    return rho / PI * (A + B * fmax(0, cos(g.phi_r - g.phi_i)) * sin(alpha) * tan(beta));
}

static double printed_33(angles g, double rho, double s) { return printed_qualitative(g, rho, s, 0.33); }
static double printed_57(angles g, double rho, double s) { return printed_qualitative(g, rho, s, 0.57); }

/* Oren and Nayar 1994, eq. 30. */
static double printed_L1(angles g, double rho, double sigma)
{
    const double alpha = fmax(g.theta_i, g.theta_r), beta = fmin(g.theta_i, g.theta_r), s2 = sigma * sigma;
    const double cos_phi = cos(g.phi_r - g.phi_i), C1 = 1 - 0.5 * s2 / (s2 + 0.33);
    double C2 = 0.45 * s2 / (s2 + 0.09);
    if (cos_phi >= 0) C2 *= sin(alpha);
    else C2 *= sin(alpha) - pow(2 * beta / PI, 3);
    const double C3 = 0.125 * (s2 / (s2 + 0.09)) * pow(4 * alpha * beta / (PI * PI), 2);
    return rho / PI * (C1 + cos_phi * C2 * tan(beta) + (1 - fabs(cos_phi)) * C3 * tan((alpha + beta) / 2));
}

/* Eq. 31. */
static double printed_L2(angles g, double rho, double sigma)
{
    const double beta = fmin(g.theta_i, g.theta_r), s2 = sigma * sigma;
    return 0.17 * rho * rho / PI * s2 / (s2 + 0.13) * (1 - cos(g.phi_r - g.phi_i) * pow(2 * beta / PI, 2));
}

static double printed_full(angles g, double rho, double s)
{
    return fmax(0, printed_L1(g, rho, s) + printed_L2(g, rho, s));
}

static double printed_direct(angles g, double rho, double s) { return fmax(0, printed_L1(g, rho, s)); }

/* Fujii: s = v.l - nl nv, which is the product of the projections on the surface. */
static double s_over_t(angles g)
{
    const double s = sin(g.theta_i) * sin(g.theta_r) * cos(g.phi_r - g.phi_i);
    return s > 0 ? s / fmax(cos(g.theta_i), cos(g.theta_r)) : s;
}

static double printed_fujii(angles g, double rho, double r)
{
    const double A = 1 / (PI + (PI / 2 - 2 / 3.) * r), B = r / (PI + (PI / 2 - 2 / 3.) * r);
    return rho * (A + B * s_over_t(g));
}

/* Portsmouth, Kutz and Hill 2024, with their polynomial for G(mu)/pi. */
static double printed_E(double mu, double r)
{
    static const double g[] = { 0.0571085289, 0.491881867, -0.332181442, 0.0714429953 };
    double G_over_pi = 0;
    for (int i = 0; i < 4; i++) G_over_pi += g[i] * pow(1 - mu, i + 1);
    return (1 + r * G_over_pi) / (1 + (0.5 - 2 / (3 * PI)) * r);
}

static double printed_eon(angles g, double rho, double r)
{
    const double AF = 1 / (1 + (0.5 - 2 / (3 * PI)) * r), average = AF * (1 + (2 / 3. - 28 / (15 * PI)) * r);
    const double single = rho / PI * AF * (1 + r * s_over_t(g));
    const double rho_ms = rho * rho * average / (1 - rho * (1 - average));
    const double lost_i = 1 - printed_E(cos(g.theta_i), r), lost_r = 1 - printed_E(cos(g.theta_r), r);
    return single + rho_ms / PI * fmax(1e-7, lost_i) * fmax(1e-7, lost_r) / fmax(1e-7, 1 - average);
}

typedef double printed_form(angles, double rho, double sigma);

static const struct { facet_diffuse model; printed_form *form; double sigma_max; } diffuse_forms[] = {
    { FACET_DIFFUSE_OREN_NAYAR, printed_33, PI / 2 },
    { FACET_DIFFUSE_OREN_NAYAR_57, printed_57, PI / 2 },
    { FACET_DIFFUSE_OREN_NAYAR_FULL, printed_full, PI / 2 },
    { FACET_DIFFUSE_OREN_NAYAR_DIRECT, printed_direct, PI / 2 },
    { FACET_DIFFUSE_FUJII, printed_fujii, 1 },
    { FACET_DIFFUSE_EON, printed_eon, 1 },
};

/* The vectors' roundings move both forms: the reference's are taken as they are, the printed one's are unit. */
static void expect_diffuse(int form, const sample *s)
{
    const facet_material m = { .diffuse.model = diffuse_forms[form].model };
    const angles g = angles_of(s);
    double got[3], magnitude[3];
    reference_terms(&m, s, got, magnitude);
    const double want = diffuse_forms[form].form(g, s->albedo[0], s->sigma) * cos(g.theta_i) * s->irradiance[0];
    const double room = 2e-6 * magnitude[0] * (1 + 1e-2 / cos(g.theta_i) + 1e-2 / cos(g.theta_r));
    expect(fabs(got[0] - want) <= room, "%.9g, printed %.9g, theta_i %g theta_r %g dphi %g sigma %g rho %g", got[0],
           want, g.theta_i, g.theta_r, g.phi_r - g.phi_i, (double)s->sigma, (double)s->albedo[0]);
}

/* Directions at multiples of 3 degrees, but for the pole, where there is no azimuth, and the horizon. */
static void check_diffuse_lattice(int form)
{
    sample s = { .n = { 0, 0, 1 }, .tangent = { 1, 0, 0 }, .irradiance = { 1, 1, 1 } };
    for (int i = 1; i < 30; i++)
        for (int r = 1; r < 30; r++)
            for (int turn = 0; turn < some_of(120); turn += 7) {
                store(s.l, polar(i * PI / 60, 0.1));
                store(s.v, polar(r * PI / 60, 0.1 + turn * PI / 60));
                s.sigma = (float)(diffuse_forms[form].sigma_max * ((i + r + turn) % 9) / 8);
                s.albedo[0] = (float)((i * r + turn) % 5) / 4;
                expect_diffuse(form, &s);
            }
}

static void check_diffuse(int form)
{
    test_random random = { 51 };
    test("%s as printed", facet_word(FACET_KIND_DIFFUSE, (int)diffuse_forms[form].model));
    for (int i = 0; i < some_of(20000); i++) {
        const sample s = random_sample(&random, i & 1 ? SAMPLES_UNIFORM : SAMPLES_GRAZING, 0.1f,
                                       (float)diffuse_forms[form].sigma_max);
        const cosines c = reference_cosines(&s);
        if (c.nl > 1e-3 && c.nv > 1e-3 && c.nl < 0.9999 && c.nv < 0.9999) expect_diffuse(form, &s);
    }
    check_diffuse_lattice(form);
}

/* ---- Specular, as printed ---------------------------------------------------------------------------------------- */

/* Walter et al. 2007, eq. 33 and 25; Heitz 2014, eq. 84 and 82: with cos^2/ax^2 + sin^2/ay^2 of the azimuth. */
static double printed_D(facet_distribution model, angles g, double ax, double ay)
{
    const double theta = g.theta_h, stretched = pow(cos(g.phi_h) / ax, 2) + pow(sin(g.phi_h) / ay, 2);
    switch (model) {
    case FACET_DISTRIBUTION_GGX:
        return ax * ax / (PI * pow(cos(theta), 4) * pow(ax * ax + pow(tan(theta), 2), 2));
    case FACET_DISTRIBUTION_GGX_ANISOTROPIC:
        return 1 / (PI * ax * ay * pow(cos(theta), 4) * pow(1 + pow(tan(theta), 2) * stretched, 2));
    case FACET_DISTRIBUTION_BECKMANN:
        return exp(-pow(tan(theta) / ax, 2)) / (PI * ax * ax * pow(cos(theta), 4));
    default:
        return exp(-pow(tan(theta), 2) * stretched) / (PI * ax * ay * pow(cos(theta), 4));
    }
}

/* Phong 1975, Lafortune and Willems 1994: the angle between v and the mirror image of l. */
static double printed_phong(const sample *s, double m)
{
    const vec n = unit_of(s->n), l = unit_of(s->l), mirror = plus(scaled(n, 2 * dot(n, l)), scaled(l, -1));
    return pow(fmax(0, cos(angle_between(unit_of(s->v), mirror))), m);
}

static double printed_lobe(facet_distribution model, const sample *s, double m)
{
    const double blinn = pow(cos(angles_of(s).theta_h), m);
    switch (model) {
    case FACET_DISTRIBUTION_PHONG: return printed_phong(s, m);
    case FACET_DISTRIBUTION_PHONG_MODIFIED: return printed_phong(s, m) * (m + 2) / (2 * PI);
    case FACET_DISTRIBUTION_BLINN_PHONG: return blinn;
    default: return blinn * (m + 2) * (m + 4) / (8 * PI * (pow(2, -m / 2) + m));
    }
}

/* Torrance and Sparrow 1967; Schlick 1994 as Karis 2013 has it; Hammon 2017. */
static double printed_G(facet_masking masking, const sample *s, double alpha)
{
    const vec n = unit_of(s->n), l = unit_of(s->l), v = unit_of(s->v), h = unit(plus(l, v));
    const double nl = dot(n, l), nv = dot(n, v), nh = dot(n, h), vh = dot(v, h);
    double k = alpha / 2;
    switch (masking) {
    case FACET_MASKING_V_CAVITY: return fmin(1, fmin(2 * nh * nv / vh, 2 * nh * nl / vh));
    case FACET_MASKING_HAMMON: return 2 * nl * nv / ((1 - alpha) * 2 * nl * nv + alpha * (nl + nv));
    case FACET_MASKING_SCHLICK_GGX_ANALYTIC: k = pow(sqrt(alpha) + 1, 2) / 8; break;
    default: break;
    }
    return nl / (nl * (1 - k) + k) * (nv / (nv * (1 - k) + k));
}

/* But where the vectors' roundings turn h by much, or the lobe is narrower than acos is good. */
static void check_specular(void)
{
    test("D and the lobes as printed");
    test_random random = { 52 };
    for (int i = 0; i < some_of(60000); i++) {
        const int model = FACET_DISTRIBUTION_GGX + i % 8;
        const sample s = random_sample(&random, i % SAMPLES_KINDS, 0.05f, 1);
        const facet_material m = specular_material((facet_distribution)model, FACET_MASKING_SMITH);
        const angles g = angles_of(&s);
        const double exponent = s.exponent, got = reference_distribution(&m, &s);
        const double want = model >= FACET_DISTRIBUTION_PHONG ? printed_lobe((facet_distribution)model, &s, exponent)
                            : printed_D((facet_distribution)model, g, s.alpha, s.alpha_y);
        const double room = 1e-4 * want * (1 + fabs(log(want + 1e-300))) + 1e-20;
        if (reference_cosines(&s).vh < 0.1 || (g.theta_h < 1e-2 && exponent > 100)) continue;
        expect(fabs(got - want) <= room, "%s: %.9g, printed %.9g, angle %g alpha %g exponent %g",
               facet_word(FACET_KIND_DISTRIBUTION, model), got, want, g.theta_h, (double)s.alpha, exponent);
    }
}

static void check_masking(void)
{
    static const facet_masking maskings[] = { FACET_MASKING_V_CAVITY, FACET_MASKING_SCHLICK_GGX,
                                              FACET_MASKING_SCHLICK_GGX_ANALYTIC, FACET_MASKING_HAMMON };
    test("V-cavities, Schlick's and Hammon's masking as printed");
    test_random random = { 53 };
    for (int i = 0; i < some_of(20000); i++) {
        const sample s = random_sample(&random, i % 2, 0.001f, 1);
        const facet_masking masking = maskings[i / 2 % 4];
        const facet_material m = specular_material(FACET_DISTRIBUTION_GGX, masking);
        const cosines c = reference_cosines(&s);
        const double got = reference_masking(&m, &s);
        const double want = printed_G(masking, &s, s.alpha);
        expect(fabs(got - want) <= 1e-6 * want * (1 + 1 / fmin(c.nl, c.nv)), "%s: %.9g, printed %.9g",
               facet_word(FACET_KIND_MASKING, (int)masking), got, want);
    }
}

/* ---- Integrals of D and G ---------------------------------------------------------------------------------------- */

static const struct { double x, y; } widths[] = {
    { 0.02, 0.02 }, { 0.1, 0.1 }, { 0.5, 0.5 }, { 1, 1 }, { 0.1, 0.4 }, { 0.7, 0.05 }, { 1, 0.2 },
};
enum { WIDTHS = sizeof widths / sizeof widths[0] };

static const facet_distribution distributions[] = {
    FACET_DISTRIBUTION_GGX, FACET_DISTRIBUTION_GGX_ANISOTROPIC,
    FACET_DISTRIBUTION_BECKMANN, FACET_DISTRIBUTION_BECKMANN_ANISOTROPIC,
};

static bool is_anisotropic(facet_distribution model)
{
    return model == FACET_DISTRIBUTION_GGX_ANISOTROPIC || model == FACET_DISTRIBUTION_BECKMANN_ANISOTROPIC;
}

static bool fits(facet_distribution model, int width)
{
    return is_anisotropic(model) || widths[width].x == widths[width].y;
}

/* A sample with n along z and the tangent along x, all directions this one. */
static sample facing(vec direction, int width)
{
    sample s = white();
    s.alpha = (float)widths[width].x;
    s.alpha_y = (float)widths[width].y;
    store(s.v, direction);
    store(s.l, direction);
    return s;
}

/* D at samples whose directions are all one: the reference's, or where there is a plan the library's, whose masking is
 * the V-cavities': of a light of 1 the radiance is D G/(4 nh), G = min(1, 2 nh^2). */
typedef struct { const facet_material *material; const facet_plan *plan; } facets;

enum { MOST_STEPS = 256 };

static void densities(const facets *f, const sample *s, int count, double *D)
{
    for (int i = 0; i < count; i++) D[i] = f->plan ? 0 : reference_distribution(f->material, &s[i]);
    if (!f->plan) return;
    sample_batch b = batch_of(s, count);
    expect(!facet_shade(f->plan, &b.batch, NULL), "refused");
    for (int i = 0; i < count; i++) {
        const double nh = s[i].v[2];
        D[i] = 4 * nh * (double)b.batch.radiance[0][i] / fmin(1, 2 * nh * nh);
    }
    free_batch(&b);
}

/* The integral of D g over the hemisphere of h, g a function of h, in slopes (ax t cos phi, ay t sin phi) with t^2 =
 * 1/(1 - x)^2 - 1: of dw = nh^3 dslopes. */
typedef double facet_function(vec h, const void *data);

static double integrate(const facets *f, int width, int steps, facet_function *g, const void *data)
{
    const double ax = widths[width].x, ay = widths[width].y;
    double sum = 0;
    for (int i = 0; i < steps; i++) {
        const double x = (i + 0.5) / steps, t = sqrt(1 / pow(1 - x, 2) - 1);
        const double area = ax * ay / pow(1 - x, 3) * 2 * PI / (steps * steps);
        sample s[MOST_STEPS];
        vec h[MOST_STEPS];
        double D[MOST_STEPS];
        for (int k = 0; k < steps; k++) {
            const double phi = 2 * PI * (k + 0.5) / steps;
            h[k] = unit((vec){ ax * t * cos(phi), ay * t * sin(phi), 1 });
            s[k] = facing(h[k], width);
        }
        densities(f, s, steps, D);
        for (int k = 0; k < steps; k++) sum += D[k] * g(h[k], data) * pow(h[k].z, 3) * area;
    }
    return sum;
}

static double cosine_of_facet(vec h, const void *none) { (void)none; return h.z; }

static void expect_normalised(const facets *f)
{
    for (int width = 0; width < WIDTHS; width++) {
        if (!fits(f->material->specular.model, width)) continue;
        const double area = integrate(f, width, 128, cosine_of_facet, NULL);
        expect(fabs(area - 1) <= 2e-4, "%.6f at alpha %g, %g", area, widths[width].x, widths[width].y);
    }
}

static void check_normalisation(facet_distribution model)
{
    facet_material m = specular_material(model, FACET_MASKING_V_CAVITY);
    const char *word = facet_word(FACET_KIND_DISTRIBUTION, (int)model);
    test("facets of %s cover the surface once", word);
    expect_normalised(&(facets){ &m, NULL });
    m.streams = FACET_STREAM_ALPHA | (is_anisotropic(model) ? FACET_STREAM_ALPHA_Y : 0u);
    for (int tier = 0; facet_word(FACET_KIND_TIER, tier); tier++) {
        facet_plan plan;
        test("facets of %s cover the surface once, %s", word, facet_word(FACET_KIND_TIER, tier));
        if (facet_plan_init(&plan, &m, (facet_target){ .tier = (facet_tier)tier }, NULL))
            skip("not in this build");
        else expect_normalised(&(facets){ &m, &plan });
    }
}

static double facing_area(vec h, const void *v) { return fmax(0, dot(*(const vec *)v, h)); }

/* Heitz 2014: seen from v, the facets that are visible cover what the surface covers. G1 of v alone is G where
 * the light stands at the normal. Exact but for Walter's rational one. */
static void check_visible_area(facet_distribution model, facet_masking masking, double tolerance)
{
    const facet_material m = specular_material(model, masking);
    test("%s, %s: visible facets cover the surface", facet_word(FACET_KIND_DISTRIBUTION, (int)model),
         facet_word(FACET_KIND_MASKING, (int)masking));
    for (int width = 0; width < WIDTHS; width++)
        for (int k = 0; fits(model, width) && k < some_of(8); k++) {
            const vec v = polar((k % 4 + 0.5) / 4 * 1.53, 0.3 + k / 4);
            sample s = facing(v, width);
            store(s.l, (vec){ 0, 0, 1 });
            const double facing_v = integrate(&(facets){ &m, NULL }, width, 256, facing_area, &v);
            const double area = reference_masking(&m, &s) * facing_v;
            expect(fabs(area - v.z) <= tolerance * v.z, "%.6f of %.6f at alpha %g, %g", area, v.z, widths[width].x,
                   widths[width].y);
        }
}

/* Of V-cavities each facet hides by itself: G1(v, h) = min(1, 2 nh nv/vh). */
static double visible_in_cavity(vec h, const void *data)
{
    const vec *v = data;
    const double vh = dot(*v, h);
    return vh > 0 ? vh * fmin(1, 2 * h.z * v->z / vh) : 0;
}

static void check_cavity_area(facet_distribution model)
{
    const facet_material m = specular_material(model, FACET_MASKING_V_CAVITY);
    test("%s, v-cavity: visible facets cover the surface", facet_word(FACET_KIND_DISTRIBUTION, (int)model));
    for (int width = 0; width < WIDTHS; width++)
        for (int k = 0; fits(model, width) && k < some_of(4); k++) {
            const vec v = polar((k + 0.5) / 4 * 1.53, 0.7);
            const double area = integrate(&(facets){ &m, NULL }, width, 256, visible_in_cavity, &v);
            expect(fabs(area - v.z) <= 1e-3 * v.z, "%.6f of %.6f at alpha %g, %g", area, v.z, widths[width].x,
                   widths[width].y);
        }
}

/* Height-correlated: 1/G = 1/G1(l) + 1/G1(v) - 1, G1 from the separable one. */
static void check_correlation(facet_distribution model, facet_masking separable, facet_masking correlated)
{
    const facet_material apart = specular_material(model, separable), joint = specular_material(model, correlated);
    test_random random = { 54 };
    test("%s, %s from G1 of l and of v", facet_word(FACET_KIND_DISTRIBUTION, (int)model),
         facet_word(FACET_KIND_MASKING, (int)correlated));
    for (int i = 0; i < 2000; i++) {
        const sample s = random_sample(&random, i % SAMPLES_KINDS, 0.01f, 1);
        sample of_l = s, of_v = s;
        memcpy(of_l.v, s.n, sizeof s.n);
        memcpy(of_v.l, s.n, sizeof s.n);
        const double G1_l = reference_masking(&apart, &of_l), G1_v = reference_masking(&apart, &of_v);
        const double got = reference_masking(&joint, &s), want = 1 / (1 / G1_l + 1 / G1_v - 1);
        const double product = reference_masking(&apart, &s);
        expect(fabs(got - want) <= 1e-6 * want, "%.9g, not %.9g", got, want);
        expect(fabs(product - G1_l * G1_v) <= 1e-6 * product, "separable: %.9g, not %.9g", product, G1_l * G1_v);
    }
}

/* Beckmann's Lambda is the mean of what the slopes p beyond a take away, (p - a)/a: Smith 1967. */
static double integral_of_slopes(double a)
{
    enum { STEPS = 20000 };
    double sum = 0;
    for (int i = 0; i < STEPS; i++) {
        const double p = a + 8.0 * (i + 0.5) / (double)STEPS;
        sum += (p - a) / a * exp(-p * p) / sqrt(PI) * 8 / (double)STEPS;
    }
    return sum;
}

static void check_error_function(void)
{
    test("Beckmann's exact masking by the error function and by its integral; Walter's within 0.32 %%");
    for (int i = 0; i <= 60; i++) {
        const double alpha = 0.5, tan_v = pow(10, i / 20.0 - 1) / alpha, a = 1 / (alpha * tan_v);
        const vec v = unit((vec){ tan_v, 0, 1 });
        sample s = { .n = { 0, 0, 1 }, .l = { 0, 0, 1 }, .alpha = (float)alpha };
        store(s.v, v);
        const facet_material exact = specular_material(FACET_DISTRIBUTION_BECKMANN, FACET_MASKING_SMITH_EXACT);
        const facet_material walter = specular_material(FACET_DISTRIBUTION_BECKMANN, FACET_MASKING_SMITH);
        const double G1 = reference_masking(&exact, &s), rational = reference_masking(&walter, &s);
        const double printed = 2 / (1 + erf(a) + exp(-a * a) / (a * sqrt(PI)));
        const double slopes = 1 / (1 + integral_of_slopes(a));
        expect(fabs(G1 - printed) <= 1e-6 * printed, "a %g: %.9g, with erf %.9g", a, G1, printed);
        expect(fabs(G1 - slopes) <= 1e-5 * slopes, "a %g: %.9g, by slopes %.9g", a, G1, slopes);
        const double fit = (3.535 * a + 2.181 * a * a) / (1 + 2.276 * a + 2.577 * a * a);
        const double want = a < 1.6 ? fmin(1, fit) : 1;
        expect(fabs(rational - G1) <= 0.0032 * G1, "a %g: %.9g, exactly %.9g", a, rational, G1);
        expect(fabs(rational - want) <= 1e-6 * want, "a %g: %.9g, Walter's is %.9g", a, rational, want);
    }
}

/* ---- Albedos ----------------------------------------------------------------------------------------------------- */

/* The integral of f nl over the hemisphere of l, v at theta; drawn about the normal as nl^power. */
static double albedo_of(const facet_material *m, double theta, sample s, double power)
{
    enum { STEPS = 300 };
    double sum = 0;
    store(s.v, polar(theta, 0));
    for (int i = 0; i < STEPS; i++)
        for (int k = 0; k < STEPS; k++) {
            const double cosine = pow((i + 0.5) / (double)STEPS, 1 / (power + 1));
            const double density = (power + 1) / (2 * PI) * pow(cosine, power);
            double radiance[3];
            store(s.l, polar(acos(cosine), 2 * PI * (k + 0.5) / (double)STEPS));
            reference_radiance(m, &s, radiance);
            sum += radiance[0] / density;
        }
    return sum / (STEPS * STEPS);
}

/* Seen along the normal, both reflect all. */
static void check_lobe(facet_distribution model)
{
    static const float exponents[] = { 1, 3, 10, 100, 1000, 10000 };
    const facet_material m = specular_material(model, FACET_MASKING_SMITH);
    test("%s is normalised at normal incidence", facet_word(FACET_KIND_DISTRIBUTION, (int)model));
    for (int i = 0; i < some_of(6); i++) {
        sample s = white();
        s.exponent = exponents[i];
        const double spread = model == FACET_DISTRIBUTION_PHONG_MODIFIED ? exponents[i] : exponents[i] / 4;
        const double albedo = albedo_of(&m, 0, s, spread);
        expect(fabs(albedo - 1) <= 1e-3, "%.5f at exponent %g", albedo, (double)exponents[i]);
    }
}

/* White, sigma = 1: MODELS' measured values, at normal incidence and at a cosine of 0.05. */
static void check_diffuse_albedo(void)
{
    static const struct { facet_diffuse model; double normal, grazing, tolerance; } known[] = {
        { FACET_DIFFUSE_OREN_NAYAR, 0.62, 0.82, 0.005 }, { FACET_DIFFUSE_OREN_NAYAR_FULL, 0.77, 0.91, 0.005 },
        { FACET_DIFFUSE_FUJII, 0.78, 0.99, 0.005 },      { FACET_DIFFUSE_EON, 1, 1, 5e-4 },
    };
    for (int i = 0; i < 4; i++) {
        const facet_material m = { .diffuse.model = known[i].model };
        sample s = white();
        s.sigma = 1;
        const double normal = albedo_of(&m, 0, s, 0), grazing = albedo_of(&m, acos(0.05), s, 0);
        test("albedo of white %s", facet_word(FACET_KIND_DIFFUSE, (int)known[i].model));
        expect(fabs(normal - known[i].normal) <= known[i].tolerance, "%.4f at normal incidence", normal);
        expect(fabs(grazing - known[i].grazing) <= known[i].tolerance, "%.4f at a cosine of 0.05", grazing);
    }
}

/* ---- The suite --------------------------------------------------------------------------------------------------- */

static void check_facets(void)
{
    for (int i = 0; i < 4; i++) {
        const facet_distribution model = distributions[i];
        const bool is_ggx = i < 2;
        check_normalisation(model);
        check_visible_area(model, FACET_MASKING_SMITH, is_ggx ? 1e-3 : 4e-3);
        check_correlation(model, FACET_MASKING_SMITH, FACET_MASKING_SMITH_CORRELATED);
        check_cavity_area(model);
        if (is_ggx) continue;
        check_visible_area(model, FACET_MASKING_SMITH_EXACT, 1e-3);
        check_correlation(model, FACET_MASKING_SMITH_EXACT, FACET_MASKING_SMITH_EXACT_CORRELATED);
    }
}

void suite_truths(void)
{
    for (size_t i = 0; i < sizeof diffuse_forms / sizeof diffuse_forms[0]; i++) check_diffuse((int)i);
    check_diffuse_albedo();
    check_specular();
    check_masking();
    check_facets();
    check_error_function();
    check_lobe(FACET_DISTRIBUTION_PHONG_MODIFIED);
    check_lobe(FACET_DISTRIBUTION_BLINN_PHONG_NORMALISED);
    check_media_and_light();
}
