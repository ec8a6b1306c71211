/* What must hold whatever the arithmetic: reciprocity, energy, and values from the literature; measured through the
 * library. */
#include "bounds.h"
#include "samples.h"
#include "search.h"

#include <math.h>
#include <string.h>

#define PI 3.14159265358979323846

static const char *tier_word(int tier) { return facet_word(FACET_KIND_TIER, tier); }

/* A kernel on the best architecture. */
static kernel_set best(const kernel_case *kernel, int tier)
{
    return kernels_of(kernel, (facet_tier)tier, 0, true);
}

/* One channel is enough. */
static void shade_red(const kernel_set *set, const sample *s, int count, double *red)
{
    sample_batch b = batch_of(s, count);
    facet_error error = { .field = "no plan" };
    const facet_status status = set->count ? facet_shade(&set->plans[0], &b.batch, &error) : FACET_ERROR_NULL;
    expect(!status, "refused: %s", error.field);
    for (int i = 0; i < count; i++) red[i] = b.batch.radiance[0][i];
    free_batch(&b);
}

/* ---- Reciprocity ------------------------------------------------------------------------------------------------- */

/* f(l, v) = f(v, l): radiance over nl is that of the exchanged directions over nl there. */
static void check_reciprocity(const kernel_case *kernel, int tier)
{
    enum { COUNT = MOST_MEASURED };
    const accuracy_row *row = find_accuracy(kernel->name, (facet_tier)tier);
    test("reciprocity of %s, %s", kernel->name, tier_word(tier));
    if (!expect(row, "accuracy.tsv has no row")) return;
    const kernel_set set = best(kernel, tier);
    test_random random = { 21 };
    for (int round = 0; round < (test_slow_machine ? 4 : 40); round++) {
        sample there[COUNT], back[COUNT];
        double f[COUNT], exchanged[COUNT];
        for (int i = 0; i < COUNT; i++) {
            there[i] = back[i] = random_sample(&random, i % SAMPLES_KINDS, FACET_ALPHA_FLOOR, kernel->sigma_max);
            memcpy(back[i].l, there[i].v, sizeof back[i].l);
            memcpy(back[i].v, there[i].l, sizeof back[i].v);
        }
        shade_red(&set, there, COUNT, f);
        shade_red(&set, back, COUNT, exchanged);
        for (int i = 0; i < COUNT; i++) {
            const cosines c = reference_cosines(&there[i]), d = reference_cosines(&back[i]);
            double want[3], magnitude[3];
            if (!in_domain(&there[i], c)) continue;
            reference_terms(&set.material, &there[i], want, magnitude);
            const double difference = fabs(f[i] / c.nl - exchanged[i] / d.nl), scale = magnitude[0] / c.nl;
            const double bound = bound_at(&row->bound, &there[i], c, NULL) + bound_at(&row->bound, &back[i], d, NULL);
            expect(difference <= bound * scale + 1e-30 / fmin(c.nl, d.nl), "%a and %a, nl %g, nv %g, alpha %g",
                   f[i] / c.nl, exchanged[i] / d.nl, c.nl, c.nv, (double)there[i].alpha);
        }
    }
}

/* ---- Energy: the albedo by direction ----------------------------------------------------------------------------- */

/* The integral of f nl over the hemisphere, from the library's radiance at STEPS * STEPS directions that are drawn
 * uniformly, or mirrored about GGX's normals. */
#define STEPS 64

typedef struct { double l[3], density; } scattered;

static scattered uniformly(double x, double azimuth)
{
    const double sine = sqrt(1 - x * x);
    return (scattered){ { sine * cos(azimuth), sine * sin(azimuth), x }, 1 / (2 * PI) };
}

static scattered mirrored(const double *v, double alpha, double x, double azimuth)
{
    const double tan2 = alpha * alpha * x / (1 - x), nh = 1 / sqrt(1 + tan2), sine = sqrt(1 - nh * nh);
    const double h[] = { sine * cos(azimuth), sine * sin(azimuth), nh };
    const double vh = v[0] * h[0] + v[2] * h[2], q = alpha / (1 + (alpha * alpha - 1) * nh * nh);
    scattered s = { .density = q * q / PI * nh / (4 * fabs(vh)) };
    for (int c = 0; c < 3; c++) s.l[c] = 2 * vh * h[c] - v[c];
    if (vh <= 0) s.l[2] = -1;
    return s;
}

static double albedo_of(const kernel_set *set, double nv, double sigma, double alpha)
{
    const double v[] = { sqrt(1 - nv * nv), 0, nv };
    double sum = 0;
    for (int i = 0; i < STEPS; i++) {
        sample s[STEPS];
        double density[STEPS], red[STEPS];
        for (int k = 0; k < STEPS; k++) {
            const double x = (i + 0.5) / STEPS, azimuth = 2 * PI * (k + 0.5) / STEPS;
            const scattered to = set->material.specular.model ? mirrored(v, alpha, x, azimuth) : uniformly(x, azimuth);
            s[k] = (sample){ .n = { 0, 0, 1 }, .sigma = (float)sigma, .alpha = (float)alpha };
            for (int c = 0; c < 3; c++) {
                s[k].v[c] = (float)v[c];
                s[k].l[c] = (float)to.l[c];
                s[k].albedo[c] = s[k].f0[c] = s[k].irradiance[c] = 1;
            }
            density[k] = to.density;
        }
        shade_red(set, s, STEPS, red);
        for (int k = 0; k < STEPS; k++) sum += red[k] / density[k];
    }
    return sum / (STEPS * STEPS);
}

static bool is_specular(const kernel_case *kernel)
{
    return kernel->material.specular.model != FACET_DISTRIBUTION_NONE;
}

static bool has_one_part(const kernel_case *kernel)
{
    return is_specular(kernel) == (kernel->material.diffuse.model == FACET_DIFFUSE_NONE);
}

/* A row of models.def that conserves energy says so, and no other: white reflects at most all, from every direction.
 * And a perfect mirror, or Lambert, reflects all. */
static void check_energy(const kernel_case *kernel, int tier)
{
    static const double cosines_of_view[] = { 1, 0.5, 0.2, 0.05, 0.01, 0.001 };
    static const double parts_of_sigma[] = { 0, 0.0625, 0.125, 0.1875, 0.25, 0.5, 1 };
    static const double alphas[] = { 0.02, 0.1, 0.3, 0.6, 1 };
    const kernel_set set = best(kernel, tier);
    double most = 0;
    test("%s %s energy, %s", kernel->name, kernel->conserves ? "conserves" : "does not conserve", tier_word(tier));
    for (int i = 0; i < 6; i += test_slow_machine ? 5 : 1)
        for (int k = 0; k < (is_specular(kernel) ? 5 : kernel->sigma_max > 0 ? 7 : 1); k++) {
            const double nv = cosines_of_view[i], sigma = parts_of_sigma[k] * (double)kernel->sigma_max;
            const double alpha = is_specular(kernel) ? alphas[k] : 1, albedo = albedo_of(&set, nv, sigma, alpha);
            most = fmax(most, albedo);
            const double least = k > 0 || (is_specular(kernel) && nv < 0.5) ? 0.25 : 0.995;
            expect(albedo >= least, "only %.4f of the light at nv %g, sigma %g, alpha %g", albedo, nv, sigma, alpha);
        }
    expect((most <= 1 + 2e-3) == kernel->conserves, "up to %.4f of the light", most);
}

/* ---- Known values ------------------------------------------------------------------------------------------------ */

static const kernel_case *find_case(const char *name)
{
    for (int i = 0; i < case_count(); i++)
        if (!strcmp(case_at(i)->name, name)) return case_at(i);
    return NULL;
}

/* The albedo of white by direction. */
static void check_known_albedo(const char *name, double sigma, double nv, double albedo)
{
    const kernel_case *kernel = find_case(name);
    for (int tier = 0; tier_word(tier); tier++) {
        test("albedo of %s, sigma %g, nv %g, %s", name, sigma, nv, tier_word(tier));
        if (!kernel || !facet_has(FACET_KIND_TIER, tier)) {
            skip("not in this build");
            continue;
        }
        const kernel_set set = best(kernel, tier);
        const double found = albedo_of(&set, nv, sigma, 1);
        expect(fabs(found - albedo) <= 0.005, "%.4f, not %g", found, albedo);
    }
}

/* A white Lambertian, lit head on by pi, has a radiance of 1: exactly. */
static void check_unit(int tier)
{
    const kernel_case *kernel = find_case("lambert");
    test("white, lit head on by pi, is 1, %s", tier_word(tier));
    if (!kernel) {
        skip("not in this build");
        return;
    }
    sample s = { .n = { 0, 0, 1 }, .v = { 0, 0, 1 }, .l = { 0, 0, 1 }, .albedo = { 1, 1, 1 },
                 .irradiance = { (float)PI, (float)PI, (float)PI } };
    const kernel_set set = best(kernel, tier);
    double red;
    shade_red(&set, &s, 1, &red);
    expect(red == 1, "%a", red);
}

/* ---- The published forms ----------------------------------------------------------------------------------------- */

static double angle(const float *a, const float *b)
{
    const double ab = (double)a[0] * b[0] + (double)a[1] * b[1] + (double)a[2] * b[2];
    return acos(fmin(fmax(ab, -1), 1));
}

/* The cosine between the projections of l and v on the surface. */
static double cosine_of_azimuth(const sample *s)
{
    const cosines c = reference_cosines(s);
    double lv = 0, ll = 0, vv = 0;
    for (int i = 0; i < 3; i++) {
        const double l = s->l[i] - c.nl * s->n[i], v = s->v[i] - c.nv * s->n[i];
        lv += l * v;
        ll += l * l;
        vv += v * v;
    }
    return lv / sqrt(ll * vv);
}

/* Oren and Nayar 1994 as printed, with its angles. */
static double oren_nayar(const sample *s)
{
    const double theta_i = angle(s->n, s->l), theta_r = angle(s->n, s->v), s2 = (double)s->sigma * s->sigma;
    const double a = fmax(theta_i, theta_r), b = fmin(theta_i, theta_r);
    const double A = 1 - 0.5 * s2 / (s2 + 0.33), B = 0.45 * s2 / (s2 + 0.09);
    return s->albedo[0] / PI * (A + B * fmax(0, cosine_of_azimuth(s)) * sin(a) * tan(b)) * cos(theta_i);
}

/* Walter et al. 2007 as printed, with the angles of h: D, and G1 of l and of v. */
static double ggx_smith(const sample *s)
{
    const double a2 = (double)s->alpha * s->alpha, theta_i = angle(s->n, s->l), theta_r = angle(s->n, s->v);
    const double tan_h = tan(acos(fmin(reference_cosines(s).nh, 1))), cos_h = 1 / sqrt(1 + tan_h * tan_h);
    const double D = a2 / (PI * pow(cos_h, 4) * pow(a2 + tan_h * tan_h, 2));
    const double G = 2 / (1 + sqrt(1 + a2 * pow(tan(theta_i), 2))) * 2 / (1 + sqrt(1 + a2 * pow(tan(theta_r), 2)));
    return D * G / (4 * cos(theta_r));
}

/* Where no angle is near 0 or pi/2, the library is within 1e-4 of them. */
static void check_published(const char *name, double (*published)(const sample *), int tier)
{
    enum { COUNT = 512 };
    const kernel_case *kernel = find_case(name);
    test("%s as printed, %s", name, tier_word(tier));
    if (!kernel) {
        skip("not in this build");
        return;
    }
    test_random random = { 23 };
    sample s[COUNT];
    double red[COUNT];
    for (int i = 0; i < COUNT;) {
        s[i] = random_sample(&random, SAMPLES_UNIFORM, 0.2f, kernel->sigma_max);
        s[i].irradiance[0] = 1;
        const cosines c = reference_cosines(&s[i]);
        if (c.nl > 0.05 && c.nv > 0.05 && c.nl < 0.99 && c.nv < 0.99 && c.nh < 0.999) i++;
    }
    const kernel_set set = best(kernel, tier);
    shade_red(&set, s, COUNT, red);
    for (int i = 0; i < COUNT; i++) {
        const double want = published(&s[i]);
        expect(fabs(red[i] - want) <= 1e-4 * want, "%a, not %a", red[i], want);
    }
}

/* ---- The suite --------------------------------------------------------------------------------------------------- */

void suite_physics(void)
{
    for (int tier = 0; tier_word(tier); tier++) {
        if (!facet_has(FACET_KIND_TIER, tier)) continue;
        for (int i = 0; i < case_count(); i++) {
            if (case_at(i)->reciprocal) check_reciprocity(case_at(i), tier);
            if (has_one_part(case_at(i))) check_energy(case_at(i), tier);
        }
        check_unit(tier);
        check_published("oren-nayar", oren_nayar, tier);
        check_published("ggx/smith", ggx_smith, tier);
    }
    check_known_albedo("lambert", 0, 0.5, 1);
    check_known_albedo("oren-nayar", 1, 1, 0.62);
    check_known_albedo("oren-nayar", 1, 0.05, 0.82);
    check_known_albedo("oren-nayar", 0.2, 0.001, 1.015);
    check_known_albedo("oren-nayar-57", 0.3, 0.001, 1.044);
    check_known_albedo("fujii", 1, 1, 0.78);
    check_known_albedo("fujii", 1, 0.05, 0.99);
}
