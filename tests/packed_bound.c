/* The committed bound over packed input, and what unpacking adds to it, against formulas in double of the exactly
 * unpacked numbers. */
#include "packed.h"

#include "bounds.h"
#include "harness.h"
#include "samples.h"
#include "targets.h"

#include <math.h>
#include <string.h>

#define PI 3.14159265358979323846
#define CASE "oren-nayar+ggx/smith-correlated/schlick/uncoupled"
enum { COUNT = 1024 };

/* ---- The case in double, from vectors in double ------------------------------------------------------------------ */

typedef struct { double n[3], v[3], l[3], albedo[3], sigma, alpha, f0[3], irradiance[3]; } exact_sample;

static double dot(const double *a, const double *b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

static double lambda(double mu, double alpha)
{
    return (sqrt(1 + alpha * alpha * (1 - mu * mu) / (mu * mu)) - 1) / 2;
}

static void exact_radiance(const exact_sample *s, double radiance[3])
{
    const double nl = dot(s->n, s->l), nv = dot(s->n, s->v), vl = dot(s->v, s->l), a2 = s->alpha * s->alpha;
    const double s2 = s->sigma * s->sigma, A = 1 - 0.5 * s2 / (s2 + 0.33), B = 0.45 * s2 / (s2 + 0.09);
    const double diffuse = (A + B * fmax(0, vl - nl * nv) / fmax(nl, nv)) / PI;
    const double w[3] = { s->v[0] + s->l[0], s->v[1] + s->l[1], s->v[2] + s->l[2] };
    const double c[3] = { s->n[1] * w[2] - s->n[2] * w[1], s->n[2] * w[0] - s->n[0] * w[2],
                          s->n[0] * w[1] - s->n[1] * w[0] };
    const double hh = dot(w, w), nw = dot(s->n, w), vh = sqrt(hh) / 2;
    const double d = (dot(c, c) + a2 * nw * nw) / hh, D = a2 / (PI * d * d);
    const double G = 1 / (1 + lambda(nl, s->alpha) + lambda(nv, s->alpha));
    for (int i = 0; i < 3; i++) {
        const double F = s->f0[i] + (1 - s->f0[i]) * pow(1 - fmin(vh, 1), 5);
        radiance[i] = (s->albedo[i] * diffuse + D * F * G / (4 * nl * nv)) * nl * s->irradiance[i];
    }
}

/* In floats, for the reference. */
static sample rounded(const exact_sample *e)
{
    sample s = { .sigma = (float)e->sigma, .alpha = (float)e->alpha };
    for (int c = 0; c < 3; c++) {
        s.n[c] = (float)e->n[c], s.v[c] = (float)e->v[c], s.l[c] = (float)e->l[c];
        s.albedo[c] = (float)e->albedo[c], s.f0[c] = (float)e->f0[c], s.irradiance[c] = (float)e->irradiance[c];
    }
    return s;
}

static exact_sample widened(const sample *s)
{
    exact_sample e = { .sigma = (double)s->sigma, .alpha = (double)s->alpha };
    for (int c = 0; c < 3; c++) {
        e.n[c] = s->n[c], e.v[c] = s->v[c], e.l[c] = s->l[c];
        e.albedo[c] = s->albedo[c], e.f0[c] = s->f0[c], e.irradiance[c] = s->irradiance[c];
    }
    return e;
}

static void check_formulas(void)
{
    const kernel_case *kernel = find_case(CASE);
    test_random r = { 3 };
    test("bound: the formulas in double are the reference's");
    for (int i = 0; i < 10000; i++) {
        const sample s = random_sample(&r, i % SAMPLES_KINDS, FACET_ALPHA_FLOOR, kernel->sigma_max);
        const exact_sample e = widened(&s);
        double want[3], got[3];
        reference_radiance(&kernel->material, &s, want);
        exact_radiance(&e, got);
        for (int c = 0; c < 3; c++)
            expect(fabs(got[c] - want[c]) <= 1e-7 * want[c], "%.17g, not %.17g", got[c], want[c]);
    }
}

/* ---- Packed samples ---------------------------------------------------------------------------------------------- */

typedef struct {
    facet_camera camera;
    int16_t normal[2 * COUNT];
    uint8_t albedo_roughness[4 * COUNT], f0_sigma[4 * COUNT];
    float l[3][COUNT], irradiance[3][COUNT], radiance[3][COUNT];
    exact_sample exact[COUNT];
} packed_samples;

static double between(test_random *r, double least, double most) { return least + (most - least) * random_unit(r); }
static double small(test_random *r, double least) { return exp(between(r, log(least), 0)); }

static void normalise(double *a)
{
    const double length = sqrt(dot(a, a));
    for (int c = 0; c < 3; c++) a[c] /= length;
}

/* A unit vector at random, with that cosine to a. */
static void around(test_random *r, const double *a, double cosine, double *to)
{
    double b[3];
    for (int c = 0; c < 3; c++) b[c] = between(r, -1, 1);
    const double along = dot(a, b);
    for (int c = 0; c < 3; c++) b[c] -= along * a[c];
    normalise(b);
    for (int c = 0; c < 3; c++) to[c] = cosine * a[c] + sqrt(1 - cosine * cosine) * b[c];
}

static int16_t nearest_snorm16(double x) { return (int16_t)lrint(x * 32767); }

/* The octahedral numbers next to n. */
static void pack_normal(const double *n, int16_t packed[2])
{
    const double sum = fabs(n[0]) + fabs(n[1]) + fabs(n[2]);
    double x = n[0] / sum, y = n[1] / sum;
    if (n[2] < 0) {
        const double folded = copysign(1 - fabs(y), x);
        y = copysign(1 - fabs(x), y);
        x = folded;
    }
    packed[0] = nearest_snorm16(x), packed[1] = nearest_snorm16(y);
}

/* Any; facing sideways; in the lobe; away from the eye. */
static void draw_light(test_random *r, const exact_sample *s, double l[3])
{
    double h[3], vh;
    switch (random_u64(r) & 3) {
    case 0: around(r, s->n, random_unit(r), l); break;
    case 1: around(r, s->n, small(r, 0x1p-22), l); break;
    case 2:
        around(r, s->n, 1 / sqrt(1 + pow(s->alpha, 2) / (1 / random_unit(r) - 1)), h);
        vh = dot(s->v, h);
        for (int c = 0; c < 3; c++) l[c] = 2 * vh * h[c] - s->v[c];
        break;
    default: around(r, s->v, -1 + pow(small(r, 1e-8), 2) / 2, l);
    }
}

static void draw_sample(test_random *r, packed_samples *p, int i)
{
    exact_sample *s = &p->exact[i];
    uint8_t *a = &p->albedo_roughness[4 * i], *f = &p->f0_sigma[4 * i];
    for (int c = 0; c < 4; c++) a[c] = (uint8_t)random_u64(r), f[c] = (uint8_t)random_u64(r);
    if (random_u64(r) & 1) a[3] = (uint8_t)(255 * small(r, 1. / 255));
    *s = (exact_sample){ .sigma = f[3] / 255. * 0x1.921fb6p0,
                         .alpha = fmax(pow(a[3] / 255., 2), (double)FACET_ALPHA_FLOOR) };
    exact_view(&p->camera, (size_t)i, s->v);
    do {
        double n[3], l[3];
        around(r, s->v, random_u64(r) & 1 ? random_unit(r) : small(r, 1e-5), n);
        pack_normal(n, &p->normal[2 * i]);
        exact_normal(&p->normal[2 * i], s->n);
        draw_light(r, s, l);
        for (int c = 0; c < 3; c++) s->l[c] = p->l[c][i] = (float)l[c];
    } while (dot(s->n, s->v) < 0x1p-22 || dot(s->n, s->l) < 0x1p-22);
    for (int c = 0; c < 3; c++) {
        s->albedo[c] = a[c] / 255., s->f0[c] = f[c] / 255.;
        s->irradiance[c] = p->irradiance[c][i] = (float)between(r, 0, 4);
    }
}

/* A pinhole's, 90 degrees wide and high, turned anyhow; the batch is a part of its picture. */
static void draw_samples(test_random *r, packed_samples *p)
{
    enum { SIDE = 2048 };
    const double step = 2 / (double)SIDE;
    double forward[3], right[3], down[3];
    around(r, (double[]){ 0, 0, 1 }, between(r, -1, 1), forward);
    around(r, forward, 0, right);
    for (int c = 0; c < 3; c++)
        down[c] = forward[(c + 1) % 3] * right[(c + 2) % 3] - forward[(c + 2) % 3] * right[(c + 1) % 3];
    p->camera = (facet_camera){ .x = (uint32_t)(random_u64(r) % (SIDE - COUNT)),
                                .y = (uint32_t)(random_u64(r) % SIDE), .width = COUNT };
    for (int c = 0; c < 3; c++) {
        p->camera.across[c] = (float)(right[c] * step);
        p->camera.down[c] = (float)(down[c] * step);
        p->camera.corner[c] = (float)(forward[c] + (right[c] + down[c]) * (0.5 * step - 1));
    }
    for (int i = 0; i < COUNT; i++) draw_sample(r, p, i);
}

static void shade(const facet_plan *plan, packed_samples *p)
{
    const facet_light light = { .direction_of = { p->l[0], p->l[1], p->l[2] },
                                .irradiance_of = { p->irradiance[0], p->irradiance[1], p->irradiance[2] } };
    const facet_batch b = { .count = COUNT, .lights = &light, .light_count = 1,
                            .radiance = { p->radiance[0], p->radiance[1], p->radiance[2] },
                            .packed = { .normal = p->normal, .albedo_roughness = p->albedo_roughness,
                                        .f0_sigma = p->f0_sigma, .camera = &p->camera } };
    expect(facet_shade(plan, &b, NULL) == FACET_OK, "refused");
}

/* ---- The bound --------------------------------------------------------------------------------------------------- */

/* What rounding n and v costs beside the case's bound, in units of 2^-24 over alpha and vh: v + l turns by v's error
 * over |v + l| = 2 vh, and D by twice that over alpha. 1.25 times the worst of 3072000 samples on each target, 2.392,
 * where unpacking, which turns little else, costs 161783 units: nl 0.0284067, nv 0.0290624, vh 0.0287346, alpha
 * 0.000553633. Nearly all of it is v's. */
#define UNPACKING 2.99

static void check_sample(const facet_material *m, const error_bound *bound, const packed_samples *p, int i)
{
    const sample s = rounded(&p->exact[i]);
    const cosines cosine = reference_cosines(&s);
    double want[3], radiance[3], magnitude[3];
    if (!in_domain(&s, cosine) || cosine.vh < 0x1p-6) return;
    reference_terms(m, &s, radiance, magnitude);
    exact_radiance(&p->exact[i], want);
    const double most = bound_at(bound, &s, cosine, NULL) + 0x1p-24 * UNPACKING / ((double)s.alpha * cosine.vh);
    for (int c = 0; c < 3; c++) {
        const double error = error_over_magnitude(p->radiance[c][i], want[c], magnitude[c], s.irradiance[c]);
        expect(error <= most, "%a, not %a: %.3g units of %.3g; nl %g, nv %g, vh %g, alpha %g",
               (double)p->radiance[c][i], want[c], error * 0x1p24, most * 0x1p24, cosine.nl, cosine.nv, cosine.vh,
               (double)s.alpha);
    }
}

void test_packed_bound(void)
{
    static packed_samples p;
    const int batches = test_slow_machine ? 4 : 300;
    const kernel_case *kernel = find_case(CASE);
    if (!kernel) {
        test("bound");
        skip("this build lacks the case");
        return;
    }
    check_formulas();
    facet_material material = kernel->material;
    material.streams = kernel->promised;
    for (int i = 0; i < target_count(); i++) {
        const facet_target target = target_at(i);
        const accuracy_row *row = find_accuracy(CASE, target.tier);
        test_random r = { 9 };
        facet_plan plan;
        test("%s: %d packed samples within the bound", target_words(target), batches * COUNT);
        if (!expect(row && !facet_plan_init(&plan, &material, target, NULL), "no bound, or no plan")) continue;
        for (int k = 0; k < batches; k++) {
            draw_samples(&r, &p);
            shade(&plan, &p);
            for (int n = 0; n < COUNT; n++) check_sample(&material, &row->bound, &p, n);
        }
    }
}
