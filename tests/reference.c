/* The published formulas, in double. A model that has no formula here is NaN, which no comparison passes. */
#include "reference.h"

#include <math.h>

#define PI 3.14159265358979323846

/* A value, and what it would be if none of its terms were subtracted. */
typedef struct { double value, magnitude; } term;

static double dot(const float *a, const float *b)
{
    return (double)a[0] * b[0] + (double)a[1] * b[1] + (double)a[2] * b[2];
}

static double clamp(double x, double least, double most)
{
    return fmin(fmax(x, least), most);
}

/* w = v + l. */
static void half_vector(const sample *s, double w[3])
{
    for (int c = 0; c < 3; c++) w[c] = (double)s->v[c] + s->l[c];
}

cosines reference_cosines(const sample *s)
{
    double w[3];
    half_vector(s, w);
    const double length = sqrt(w[0] * w[0] + w[1] * w[1] + w[2] * w[2]);
    const double nw = s->n[0] * w[0] + s->n[1] * w[1] + s->n[2] * w[2];
    return (cosines){ dot(s->n, s->l), dot(s->n, s->v), dot(s->v, s->l), length > 0 ? nw / length : 0, length / 2 };
}

/* sin^2 of the angle between n and w. */
static double half_sine2(const sample *s)
{
    double w[3], sum = 0;
    half_vector(s, w);
    for (int c = 0; c < 3; c++) {
        const int y = (c + 1) % 3, z = (c + 2) % 3;
        const double cross = s->n[y] * w[z] - s->n[z] * w[y];
        sum += cross * cross;
    }
    return sum / (w[0] * w[0] + w[1] * w[1] + w[2] * w[2]);
}

static double tan2(double cosine)
{
    return fmax(0, 1 - cosine * cosine) / (cosine * cosine);
}

/* ---- Diffuse: f without the albedo ------------------------------------------------------------------------------- */

/* Oren and Nayar 1994: 1/pi (A + B max(0, cos(phi_i - phi_r)) sin a tan b), a the larger angle, b the smaller. The
 * sines of both are in it: sin a tan b = sin_i sin_r/max(nl, nv), and cos(phi_i - phi_r) sin_i sin_r = vl - nl nv. */
static term oren_nayar(cosines c, double sigma, double fold)
{
    const double s2 = clamp(sigma, 0, PI / 2) * clamp(sigma, 0, PI / 2);
    const double A = 1 - 0.5 * s2 / (s2 + fold), B = 0.45 * s2 / (s2 + 0.09);
    const double f = (A + B * fmax(0, c.vl - c.nl * c.nv) / fmax(c.nl, c.nv)) / PI;
    return (term){ f, f };
}

/* Fujii: A + B s/t, s = v.l - nl nv, t = max(nl, nv) where s > 0, else 1. */
static term fujii(cosines c, double sigma)
{
    const double r = clamp(sigma, 0, 1), A = 1 / (PI + (PI / 2 - 2.0 / 3) * r), B = r * A;
    const double s = c.vl - c.nl * c.nv, t = s > 0 ? fmax(c.nl, c.nv) : 1;
    return (term){ fmax(0, A + B * s / t), A + B * fabs(s) / t };
}

static term diffuse(facet_diffuse model, cosines c, double sigma)
{
    switch (model) {
    case FACET_DIFFUSE_NONE: return (term){ 0, 0 };
    case FACET_DIFFUSE_LAMBERT: return (term){ 1 / PI, 1 / PI };
    case FACET_DIFFUSE_OREN_NAYAR: return oren_nayar(c, sigma, 0.33);
    case FACET_DIFFUSE_OREN_NAYAR_57: return oren_nayar(c, sigma, 0.57);
    case FACET_DIFFUSE_FUJII: return fujii(c, sigma);
    }
    return (term){ NAN, NAN };
}

/* ---- Specular: D G/(4 nl nv), and F ------------------------------------------------------------------------------ */

/* Walter et al. 2007, eq. 33, with nh^2 (alpha^2 - 1) + 1 = alpha^2 cos^2 + sin^2. */
static double distribution(facet_distribution model, const sample *s, double nh, double alpha)
{
    switch (model) {
    case FACET_DISTRIBUTION_NONE: return 0;
    case FACET_DISTRIBUTION_GGX: {
        const double a2 = alpha * alpha, slope = a2 * nh * nh + half_sine2(s);
        return a2 / (PI * slope * slope);
    }
    }
    return NAN;
}

static double lambda(facet_distribution model, double cosine, double alpha)
{
    switch (model) {
    case FACET_DISTRIBUTION_NONE: return 0;
    case FACET_DISTRIBUTION_GGX: return (sqrt(1 + alpha * alpha * tan2(cosine)) - 1) / 2;
    }
    return NAN;
}

static double masking(facet_masking model, double lambda_l, double lambda_v)
{
    switch (model) {
    case FACET_MASKING_SMITH_CORRELATED: return 1 / (1 + lambda_l + lambda_v);
    case FACET_MASKING_SMITH: return 1 / (1 + lambda_l) * 1 / (1 + lambda_v);
    }
    return NAN;
}

static double specular(const facet_material *m, const sample *s, cosines c)
{
    const facet_distribution model = m->specular.model;
    const double alpha = clamp(s->alpha, FACET_ALPHA_FLOOR, 1);
    if (model == FACET_DISTRIBUTION_NONE || c.vh == 0) return 0;
    const double G = masking(m->specular.masking, lambda(model, c.nl, alpha), lambda(model, c.nv, alpha));
    return distribution(model, s, c.nh, alpha) * G / (4 * c.nl * c.nv);
}

/* Schlick's error is that of 1 - vh, five times over: its magnitude has one of the five factors as 1. */
static term fresnel(const facet_material *m, double f0, double vh)
{
    const double f90 = m->fresnel.f90 == 0 ? 1 : clamp(m->fresnel.f90, 0, 1), dark = 1 - fmin(vh, 1);
    f0 = clamp(f0, 0, 1);
    switch (m->fresnel.model) {
    case FACET_FRESNEL_SCHLICK: return (term){ f0 + (f90 - f0) * pow(dark, 5), f0 + fabs(f90 - f0) * pow(dark, 4) };
    case FACET_FRESNEL_CONSTANT: return (term){ f0, f0 };
    case FACET_FRESNEL_ONE: return (term){ 1, 1 };
    }
    return (term){ NAN, NAN };
}

/* ---- Radiance ---------------------------------------------------------------------------------------------------- */

void reference_terms(const facet_material *m, const sample *s, double radiance[3], double magnitude[3])
{
    const cosines c = reference_cosines(s);
    const bool lit = c.nl > 0 && c.nv > 0;
    const term f_d = lit ? diffuse(m->diffuse.model, c, s->sigma) : (term){ 0, 0 };
    const double f_s = lit ? specular(m, s, c) : 0;
    for (int i = 0; i < 3; i++) {
        const double E = fmax(s->irradiance[i], 0), albedo = fmax(s->albedo[i], 0);
        const term F = m->specular.model == FACET_DISTRIBUTION_NONE ? (term){ 0, 0 } : fresnel(m, s->f0[i], c.vh);
        const double transmitted = m->coupled ? 1 - F.value : 1;
        radiance[i] = lit ? (transmitted * albedo * f_d.value + F.value * f_s) * c.nl * E : 0;
        magnitude[i] = lit ? (albedo * f_d.magnitude + F.magnitude * f_s) * c.nl * E : 0;
    }
}

void reference_radiance(const facet_material *m, const sample *s, double radiance[3])
{
    double magnitude[3];
    reference_terms(m, s, radiance, magnitude);
}
