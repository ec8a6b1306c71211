/* Random packed samples of the bench's tile, and what they reflect, against which packed streams are held. */
#include "packed_samples.h"

#include "packed.h"

#include <math.h>

#define PI 3.14159265358979323846

/* ---- The case in double, from vectors in double ------------------------------------------------------------------ */

static double dot(const double *a, const double *b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

static double lambda(double mu, double alpha)
{
    return (sqrt(1 + alpha * alpha * (1 - mu * mu) / (mu * mu)) - 1) / 2;
}

void exact_radiance(const exact_sample *s, double radiance[3])
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
sample rounded_sample(const exact_sample *e)
{
    sample s = { .sigma = (float)e->sigma, .alpha = (float)e->alpha };
    for (int c = 0; c < 3; c++) {
        s.n[c] = (float)e->n[c], s.v[c] = (float)e->v[c], s.l[c] = (float)e->l[c];
        s.albedo[c] = (float)e->albedo[c], s.f0[c] = (float)e->f0[c], s.irradiance[c] = (float)e->irradiance[c];
    }
    return s;
}

exact_sample widened_sample(const sample *s)
{
    exact_sample e = { .sigma = (double)s->sigma, .alpha = (double)s->alpha };
    for (int c = 0; c < 3; c++) {
        e.n[c] = s->n[c], e.v[c] = s->v[c], e.l[c] = s->l[c];
        e.albedo[c] = s->albedo[c], e.f0[c] = s->f0[c], e.irradiance[c] = s->irradiance[c];
    }
    return e;
}

/* ---- Packed samples ---------------------------------------------------------------------------------------------- */

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
static void draw_light(test_random *r, const exact_sample *s, uint64_t kind, double l[3])
{
    double h[3], vh;
    switch (kind) {
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
        const uint64_t sideways = random_u64(r) & 1, kind = random_u64(r) & 3;
        double n[3], l[3];
        s->usual = !sideways && (kind == 0 || kind == 2);
        around(r, s->v, sideways ? small(r, 1e-5) : random_unit(r), n);
        pack_normal(n, &p->normal[2 * i]);
        exact_normal(&p->normal[2 * i], s->n);
        draw_light(r, s, kind, l);
        for (int c = 0; c < 3; c++) s->l[c] = p->l[c][i] = (float)l[c];
    } while (dot(s->n, s->v) < 0x1p-22 || dot(s->n, s->l) < 0x1p-22);
    for (int c = 0; c < 3; c++) {
        s->albedo[c] = a[c] / 255., s->f0[c] = f[c] / 255.;
        s->irradiance[c] = p->irradiance[c][i] = (float)between(r, 0, 4);
    }
}

/* A pinhole's, 90 degrees wide and high, turned anyhow; the batch is a part of its picture. */
void draw_packed_samples(test_random *r, packed_samples *p)
{
    enum { SIDE = 2048 };
    const double step = 2 / (double)SIDE;
    double forward[3], right[3], down[3];
    around(r, (double[]){ 0, 0, 1 }, between(r, -1, 1), forward);
    around(r, forward, 0, right);
    for (int c = 0; c < 3; c++)
        down[c] = forward[(c + 1) % 3] * right[(c + 2) % 3] - forward[(c + 2) % 3] * right[(c + 1) % 3];
    p->camera = (facet_camera){ .x = (uint32_t)(random_u64(r) % (SIDE - PACKED_SAMPLES)),
                                .y = (uint32_t)(random_u64(r) % SIDE), .width = PACKED_SAMPLES };
    for (int c = 0; c < 3; c++) {
        p->camera.across[c] = (float)(right[c] * step);
        p->camera.down[c] = (float)(down[c] * step);
        p->camera.corner[c] = (float)(forward[c] + (right[c] + down[c]) * (0.5 * step - 1));
    }
    for (int i = 0; i < PACKED_SAMPLES; i++) draw_sample(r, p, i);
}

facet_status shade_packed_samples(const facet_plan *plan, packed_samples *p)
{
    const facet_light light = { .direction_of = { p->l[0], p->l[1], p->l[2] },
                                .irradiance_of = { p->irradiance[0], p->irradiance[1], p->irradiance[2] } };
    const facet_batch b = { .count = PACKED_SAMPLES, .lights = &light, .light_count = 1,
                            .radiance = { p->radiance[0], p->radiance[1], p->radiance[2] },
                            .packed = { .normal = p->normal, .albedo_roughness = p->albedo_roughness,
                                        .f0_sigma = p->f0_sigma, .camera = &p->camera } };
    return facet_shade(plan, &b, NULL);
}
