/* What must hold whatever the arithmetic: reciprocity, energy, and known albedos; measured through the library. */
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
    return kernels_of(kernel, (facet_tier)tier, true);
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
            there[i] = back[i] = random_sample_of(kernel, &random, i % SAMPLES_KINDS, FACET_ALPHA_FLOOR);
            memcpy(back[i].l, there[i].v, sizeof back[i].l);
            memcpy(back[i].v, there[i].l, sizeof back[i].v);
        }
        shade_red(&set, there, COUNT, f);
        shade_red(&set, back, COUNT, exchanged);
        for (int i = 0; i < COUNT; i++) {
            const cosines c = reference_cosines(&there[i]), d = reference_cosines(&back[i]);
            double want[3], magnitude[3], magnitude_back[3];
            if (!in_domain(&there[i], c)) continue;
            reference_terms(&set.material, &there[i], want, magnitude);
            reference_terms(&set.material, &back[i], want, magnitude_back);
            const double difference = fabs(f[i] / c.nl - exchanged[i] / d.nl);
            const double bound = bound_at(&row->bound, &there[i], c, NULL) * magnitude[0] / c.nl
                               + bound_at(&row->bound, &back[i], d, NULL) * magnitude_back[0] / d.nl;
            expect(difference <= bound + 1e-30 / fmin(c.nl, d.nl), "%a and %a, nl %g, nv %g, alpha %g",
                   f[i] / c.nl, exchanged[i] / d.nl, c.nl, c.nv, (double)there[i].alpha);
        }
    }
}

/* ---- Energy: the albedo by direction ----------------------------------------------------------------------------- */

/* The integral of f nl over the hemisphere, from the library's radiance at STEPS * STEPS directions: drawn uniformly,
 * or mirrored about normals whose slopes are GGX's. */
#define STEPS 64

typedef struct { double l[3], area; } scattered;

static scattered uniformly(double x, double azimuth)
{
    const double sine = sqrt(1 - x * x);
    return (scattered){ { sine * cos(azimuth), sine * sin(azimuth), x }, 2 * PI };
}

/* Slopes of a radius of sqrt(1/(1 - x)^2 - 1), stretched; dw of h is nh^3 dslopes, dw of l 4 vh times that. */
static scattered mirrored(const double *v, double alpha_x, double alpha_y, double x, double azimuth)
{
    const double radius = sqrt(1 / ((1 - x) * (1 - x)) - 1);
    const double a = alpha_x * radius * cos(azimuth), b = alpha_y * radius * sin(azimuth);
    const double nh = 1 / sqrt(1 + a * a + b * b), h[] = { a * nh, b * nh, nh };
    const double vh = v[0] * h[0] + v[1] * h[1] + v[2] * h[2], slopes = 2 * PI * alpha_x * alpha_y / pow(1 - x, 3);
    scattered s = { .area = 4 * fmax(vh, 0) * pow(nh, 3) * slopes };
    for (int c = 0; c < 3; c++) s.l[c] = vh > 0 ? 2 * vh * h[c] - v[c] : -v[c];
    return s;
}

/* White, its roughness, and what lobes are narrow by. */
typedef struct { double sigma, alpha, alpha_y, exponent, across; } roughness;

static double albedo_of(const kernel_case *kernel, const kernel_set *set, double nv, roughness r)
{
    const double width = kernel->lobe ? sqrt(2 / (r.exponent + 2)) : r.alpha, sine = sqrt(1 - nv * nv);
    const double width_y = kernel->streams & FACET_STREAM_ALPHA_Y ? r.alpha_y : width;
    const double v[] = { sine * cos(r.across), sine * sin(r.across), nv };
    double sum = 0;
    for (int i = 0; i < STEPS; i++) {
        sample s[STEPS];
        double area[STEPS], red[STEPS];
        for (int k = 0; k < STEPS; k++) {
            const double x = (i + 0.5) / STEPS, azimuth = 2 * PI * (k + 0.5) / STEPS;
            const scattered to = set->material.specular.model ? mirrored(v, width, width_y, x, azimuth)
                                                              : uniformly(x, azimuth);
            s[k] = (sample){ .n = { 0, 0, 1 }, .tangent = { 1, 0, 0 }, .sigma = (float)r.sigma,
                             .alpha = (float)r.alpha, .alpha_y = (float)r.alpha_y, .exponent = (float)r.exponent };
            for (int c = 0; c < 3; c++) {
                s[k].v[c] = (float)v[c];
                s[k].l[c] = (float)to.l[c];
                s[k].albedo[c] = s[k].f0[c] = s[k].irradiance[c] = 1;
                s[k].eta[c] = 3;
                s[k].k[c] = 8;
            }
            area[k] = to.area;
        }
        shade_red(set, s, STEPS, red);
        for (int k = 0; k < STEPS; k++) sum += red[k] * area[k];
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

enum { ROUGHNESSES = 7 };

static roughness roughness_at(const kernel_case *kernel, int i)
{
    static const double parts_of_sigma[ROUGHNESSES] = { 0, 0.0625, 0.125, 0.1875, 0.25, 0.5, 1 };
    static const double alphas[ROUGHNESSES] = { 0.02, 0.1, 0.2, 0.4, 0.6, 0.8, 1 };
    static const double exponents[ROUGHNESSES] = { 10000, 1000, 100, 20, 5, 2, 1 };
    return (roughness){ parts_of_sigma[i] * (double)kernel->sigma_max, alphas[i], alphas[3 * i % ROUGHNESSES],
                        exponents[i], i * PI / 5 };
}

/* A row of models.def that conserves energy says so, and no other: white reflects at most all, from every direction.
 * And a smooth one, seen along the normal, reflects all, but lobes and what F takes. */
static void check_energy(const kernel_case *kernel, int tier)
{
    static const double cosines_of_view[] = { 1, 0.5, 0.2, 0.05, 0.01, 0.001 };
    const kernel_set set = best(kernel, tier);
    const facet_fresnel F = kernel->material.fresnel.model;
    const bool is_white = !is_specular(kernel) || F == FACET_FRESNEL_ONE || F == FACET_FRESNEL_SCHLICK;
    double most = 0;
    test("%s %s energy, %s", kernel->name, kernel->conserves ? "conserves" : "does not conserve", tier_word(tier));
    for (int i = 0; i < 6; i += test_slow_machine ? 5 : 1)
        for (int k = 0; k < ROUGHNESSES; k++) {
            const roughness r = roughness_at(kernel, k);
            const double nv = cosines_of_view[i], albedo = albedo_of(kernel, &set, nv, r);
            most = fmax(most, albedo);
            const double least = k == 0 && i == 0 && is_white && !kernel->lobe ? 0.995 : 1e-12;
            expect(albedo >= least, "only %.4g of the light at nv %g", albedo, nv);
        }
    expect((most <= 1 + 1.5e-3) == kernel->conserves, "up to %.4f of the light", most);
}

/* ---- Known values ------------------------------------------------------------------------------------------------ */

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
        const double found = albedo_of(kernel, &set, nv, (roughness){ sigma, 1, 1, 1, 0 });
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

/* ---- The suite --------------------------------------------------------------------------------------------------- */

void suite_physics(void)
{
    for (int tier = 0; tier_word(tier); tier++) {
        if (!facet_has(FACET_KIND_TIER, tier)) continue;
        for (int i = 0; i < case_count(); i++) {
            if (case_at(i)->light.kind != FACET_LIGHT_DIRECTIONAL) continue;
            if (case_at(i)->reciprocal) check_reciprocity(case_at(i), tier);
            if (has_one_part(case_at(i))) check_energy(case_at(i), tier);
        }
        check_unit(tier);
    }
    check_known_albedo("lambert", 0, 0.5, 1);
    check_known_albedo("oren-nayar", 1, 1, 0.62);
    check_known_albedo("oren-nayar", 1, 0.05, 0.82);
    check_known_albedo("oren-nayar", 0.2, 0.001, 1.015);
    check_known_albedo("oren-nayar-57", 0.3, 0.001, 1.044);
    check_known_albedo("oren-nayar-full", 1, 1, 0.77);
    check_known_albedo("oren-nayar-full", 1, 0.05, 0.91);
    check_known_albedo("oren-nayar-full", 0.3, 0.001, 1.050);
    check_known_albedo("oren-nayar-direct", 0.1, 0.001, 1.003);
    check_known_albedo("fujii", 1, 1, 0.78);
    check_known_albedo("fujii", 1, 0.05, 0.99);
    check_known_albedo("eon", 1, 1, 1);
    check_known_albedo("eon", 1, 0.05, 1);
}
