/* The published formulas, in double. A model that has no formula here is NaN, which no comparison passes. */
#include "reference.h"

#include <float.h>
#include <math.h>

#define PI 3.14159265358979323846
#define STEP 0x1p-21             /* of an argument: 8 units of rounding */

/* A value and its magnitude: see reference_terms. */
typedef struct { double value, magnitude; } term;

/* The vectors of a sample, and what follows from them; w = v + l. */
typedef struct {
    double n[3], v[3], l[3], w[3];
    double x[3], y[3];           /* the tangent and n x tangent */
    double hh, nw, sine2;        /* w.w, n.w, |n x w|^2 */
    cosines c;
    term light;                  /* what arrives of the irradiance */
} geometry;

static double dot(const double *a, const double *b)
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static void cross(const double *a, const double *b, double *to)
{
    for (int c = 0; c < 3; c++) to[c] = a[(c + 1) % 3] * b[(c + 2) % 3] - a[(c + 2) % 3] * b[(c + 1) % 3];
}

static double clamp(double x, double least, double most)
{
    return fmin(fmax(x, least), most);
}

static double square(double x) { return x * x; }

/* What a magnitude has where f(x) is `at`, and f of x's neighbours `before` and `behind`. */
static double turn(double at, double before, double behind)
{
    return fmax(fabs(before - at), fabs(behind - at)) / STEP;
}

static term exponential(double factor, double x)
{
    const double value = factor * exp(x);
    return (term){ value, fmax((1 + fabs(x)) * value, 0x1p-100) };
}

static term times(double factor, term t) { return (term){ factor * t.value, factor * t.magnitude }; }

/* ---- Light ------------------------------------------------------------------------------------------------------- */

/* clamp(1 - (r/range)^4, 0, 1)^2. */
static double window(double r, double range)
{
    return range == 0 ? 1 : square(clamp(1 - pow(r / range, 4), 0, 1));
}

static term window_term(double r, double range)
{
    const double at = window(r, range);
    return (term){ at, at + turn(at, window(r * (1 - STEP), range), window(r * (1 + STEP), range)) };
}

/* Smoothstep of a cosine from the outer to the inner cone. */
static double cone(const facet_light *light, double cosine)
{
    const double outer = light->cos_outer, inner = light->cos_inner;
    if (outer == inner) return cosine >= outer;
    const double t = clamp((cosine - outer) / (inner - outer), 0, 1);
    return t * t * (3 - 2 * t);
}

static term cone_term(const facet_light *light, const double *l)
{
    if (light->kind != FACET_LIGHT_SPOT) return (term){ 1, 1 };
    const double axis[] = { light->axis[0], light->axis[1], light->axis[2] }, cosine = -dot(l, axis);
    const double at = cone(light, cosine);
    return (term){ at, at + turn(at, cone(light, cosine - STEP), cone(light, cosine + STEP)) };
}

/* Sets l; the part of the irradiance that arrives. */
static term arriving(const sample *s, double l[3])
{
    double d[3];
    for (int c = 0; c < 3; c++) l[c] = s->l[c];
    if (!s->light) return (term){ 1, 1 };
    for (int c = 0; c < 3; c++) d[c] = (double)s->light->position[c] - s->position[c];
    const double r2 = dot(d, d), r = sqrt(r2);
    const bool normal = r2 >= FLT_MIN && r2 <= FLT_MAX;
    for (int c = 0; c < 3; c++) l[c] = normal ? d[c] / r : 0;
    if (!normal) return (term){ 0, 0 };
    const term end = window_term(r, s->light->range), beam = cone_term(s->light, l);
    return (term){ end.value * beam.value / r2, end.magnitude * beam.magnitude / r2 };
}

void reference_direction(const sample *s, double l[3])
{
    arriving(s, l);
}

/* ---- Geometry ---------------------------------------------------------------------------------------------------- */

static geometry geometry_of(const sample *s)
{
    geometry g;
    double nxw[3];
    g.light = arriving(s, g.l);
    for (int c = 0; c < 3; c++) {
        g.n[c] = s->n[c];
        g.v[c] = s->v[c];
        g.x[c] = s->tangent[c];
        g.w[c] = g.v[c] + g.l[c];
    }
    cross(g.n, g.x, g.y);
    cross(g.n, g.w, nxw);
    g.hh = dot(g.w, g.w);
    g.nw = dot(g.n, g.w);
    g.sine2 = dot(nxw, nxw);
    g.c = (cosines){ dot(g.n, g.l), dot(g.n, g.v), dot(g.v, g.l), g.hh > 0 ? g.nw / sqrt(g.hh) : 0, sqrt(g.hh) / 2 };
    return g;
}

cosines reference_cosines(const sample *s)
{
    return geometry_of(s).c;
}

static double sine_of(double cosine) { return sqrt(fmax(0, 1 - cosine * cosine)); }

/* ---- Diffuse: f -------------------------------------------------------------------------------------------------- */

/* Oren and Nayar 1994: rho/pi (A + B max(0, cos(phi_i - phi_r)) sin a tan b), a the larger angle, b the smaller. The
 * sines of both are in it: sin a tan b = sin_i sin_r/max(nl, nv), and cos(phi_i - phi_r) sin_i sin_r = vl - nl nv. */
static term oren_nayar(cosines c, double rho, double sigma, double fold)
{
    const double s2 = square(clamp(sigma, 0, PI / 2));
    const double A = 1 - 0.5 * s2 / (s2 + fold), B = 0.45 * s2 / (s2 + 0.09);
    const double f = rho / PI * (A + B * fmax(0, c.vl - c.nl * c.nv) / fmax(c.nl, c.nv));
    return (term){ f, f };
}

/* The same, eq. 30 and 31: L1 = rho/pi (C1 + C2 cos(dphi) tan b + C3 (1 - |cos(dphi)|) tan((a + b)/2)), interreflection
 * L2 = 0.17 rho^2/pi s2/(s2 + 0.13) (1 - cos(dphi) (2b/pi)^2). tan((a + b)/2) = (sin a + sin b)/(cos a + cos b). Near
 * the normal there is hardly an azimuth, and hardly anything for it to multiply but cos(dphi) sin a tan b: which is
 * (vl - nl nv)/max(nl, nv) as above. */
static term oren_nayar_full(cosines c, double rho, double sigma, double interreflection)
{
    const double s2 = square(clamp(sigma, 0, PI / 2)), cos_a = fmin(fmin(c.nl, c.nv), 1);
    const double cos_b = fmin(fmax(c.nl, c.nv), 1), sin_a = sine_of(cos_a), sin_b = sine_of(cos_b);
    const double a = acos(cos_a), b = acos(cos_b), s0 = c.vl - c.nl * c.nv;
    const double cos_dphi = sin_a * sin_b > 0 ? clamp(s0 / (sin_a * sin_b), -1, 1) : 0;
    const double C1 = 1 - 0.5 * s2 / (s2 + 0.33), C3 = 0.125 * s2 / (s2 + 0.09) * square(4 * a * b / (PI * PI));
    const double aligned = s0 / fmax(c.nl, c.nv), opposed = fmin(cos_dphi, 0) * pow(2 * b / PI, 3) * sin_b / cos_b;
    const double C2 = 0.45 * s2 / (s2 + 0.09), third = (1 - fabs(cos_dphi)) * C3 * (sin_a + sin_b) / (cos_a + cos_b);
    const double twice = interreflection * rho * s2 / (s2 + 0.13), turned = cos_dphi * square(2 * b / PI);
    const double f = C1 + C2 * (aligned - opposed) + third + twice * (1 - turned);
    const double sum = C1 + C2 * (fabs(aligned) + fabs(opposed)) + third + twice * (1 + fabs(turned));
    return (term){ rho / PI * fmax(0, f), rho / PI * sum };
}

/* s/t, s = v.l - nl nv, t = max(nl, nv) where s > 0, else 1. */
static double fujii_ratio(cosines c)
{
    const double s = c.vl - c.nl * c.nv;
    return s / (s > 0 ? fmax(c.nl, c.nv) : 1);
}

/* Fujii: rho (A + B s/t). */
static term fujii(cosines c, double rho, double sigma)
{
    const double r = clamp(sigma, 0, 1), A = 1 / (PI + (PI / 2 - 2.0 / 3) * r), B = r * A, ratio = fujii_ratio(c);
    return (term){ rho * fmax(0, A + B * ratio), rho * (A + B * fabs(ratio)) };
}

/* Portsmouth, Kutz and Hill's (1 - E(mu))/(A_F r): c1 - G(mu)/pi, with their polynomial for G. */
static double eon_loss(double mu, double c1)
{
    const double x = fmax(0, 1 - mu);
    return fmax(0, c1 - x * (0.0571085289 + x * (0.491881867 + x * (-0.332181442 + x * 0.0714429953))));
}

/* Portsmouth, Kutz and Hill 2024: Fujii's form with A_F, and what scatters more than once, rho_ms/pi (1 - E(nv))
 * (1 - E(nl))/(1 - Eavg), where 1 - E(mu) = A_F r loss(mu), 1 - Eavg = A_F r (c1 - c2). */
static term eon(cosines c, double rho, double sigma)
{
    const double r = clamp(sigma, 0, 1), c1 = 0.5 - 2 / (3 * PI), c2 = 2.0 / 3 - 28 / (15 * PI);
    const double AF = 1 / (1 + c1 * r), average = AF * (1 + c2 * r), ratio = fujii_ratio(c);
    const double white = fmin(rho, 1), rho_ms = white * white * average / (1 - white * (1 - average));
    const double multiple = rho_ms / PI * AF * r * eon_loss(c.nv, c1) * eon_loss(c.nl, c1) / (c1 - c2);
    const double once = rho / PI * AF;
    return (term){ once * fmax(0, 1 + r * ratio) + multiple, once * (1 + r * fabs(ratio)) + multiple };
}

static term diffuse(facet_diffuse model, cosines c, double rho, double sigma)
{
    switch (model) {
    case FACET_DIFFUSE_NONE: return (term){ 0, 0 };
    case FACET_DIFFUSE_LAMBERT: return (term){ rho / PI, rho / PI };
    case FACET_DIFFUSE_OREN_NAYAR: return oren_nayar(c, rho, sigma, 0.33);
    case FACET_DIFFUSE_OREN_NAYAR_57: return oren_nayar(c, rho, sigma, 0.57);
    case FACET_DIFFUSE_OREN_NAYAR_FULL: return oren_nayar_full(c, rho, sigma, 0.17);
    case FACET_DIFFUSE_OREN_NAYAR_DIRECT: return oren_nayar_full(c, rho, sigma, 0);
    case FACET_DIFFUSE_FUJII: return fujii(c, rho, sigma);
    case FACET_DIFFUSE_EON: return eon(c, rho, sigma);
    }
    return (term){ NAN, NAN };
}

/* ---- Specular: D ------------------------------------------------------------------------------------------------- */

/* What a distribution has of the sample. */
typedef struct { double alpha, alpha_y, exponent; } shape;

static shape shape_of(facet_distribution model, const sample *s)
{
    const bool two = model == FACET_DISTRIBUTION_GGX_ANISOTROPIC || model == FACET_DISTRIBUTION_BECKMANN_ANISOTROPIC;
    const double alpha = clamp(s->alpha, FACET_ALPHA_FLOOR, 1);
    return (shape){ alpha, two ? clamp(s->alpha_y, FACET_ALPHA_FLOOR, 1) : alpha,
                    clamp(s->exponent, FACET_EXPONENT_MIN, FACET_EXPONENT_MAX) };
}

/* tan^2 of the half vector, of both alphas. */
static double stretched(const geometry *g, shape a)
{
    return (square(dot(g->x, g->w) / a.alpha) + square(dot(g->y, g->w) / a.alpha_y)) / square(g->nw);
}

/* Walter et al. 2007, eq. 33, with nh^2 (alpha^2 - 1) + 1 = alpha^2 cos^2 + sin^2. */
static double ggx(const geometry *g, double alpha)
{
    return square(alpha * g->hh / (g->sine2 + square(alpha * g->nw))) / PI;
}

/* Heitz 2014, eq. 84. */
static double ggx_anisotropic(const geometry *g, shape a)
{
    return square(g->hh / (square(g->nw) * (1 + stretched(g, a)))) / (PI * a.alpha * a.alpha_y);
}

/* e^-x/(pi alpha_x alpha_y nh^4), nh from its tangent. */
static term beckmann(double x, double tan2, shape a)
{
    return times(1 / (PI * a.alpha * a.alpha_y), exponential(square(1 + tan2), -x));
}

static term beckmann_isotropic(const geometry *g, shape a)
{
    const double tan2 = g->sine2 / square(g->nw);
    return beckmann(tan2 / square(a.alpha), tan2, a);
}

static term beckmann_anisotropic(const geometry *g, shape a)
{
    return beckmann(stretched(g, a), stretched(g, (shape){ 1, 1, 0 }), a);
}

/* (r.v)^exponent, r = 2 nl n - l. */
static double phong_of(double angle, double exponent)
{
    return cos(angle) > 0 ? pow(cos(angle), exponent) : 0;
}

static term phong(const geometry *g, double exponent)
{
    double r[3], rxv[3];
    for (int c = 0; c < 3; c++) r[c] = 2 * g->c.nl * g->n[c] - g->l[c];
    cross(r, g->v, rxv);
    const double rv = dot(r, g->v), angle = atan2(sqrt(dot(rxv, rxv)), rv), at = phong_of(angle, exponent);
    const double steep = turn(at, phong_of(angle - STEP, exponent), phong_of(angle + STEP, exponent));
    if (rv <= 0) return (term){ 0, steep };
    const term power = exponential(1, -exponent / 2 * log1p(dot(rxv, rxv) / (rv * rv)));
    return (term){ power.value, power.magnitude + steep };
}

/* nh^exponent. */
static term blinn_phong(const geometry *g, double exponent)
{
    return exponential(1, -exponent / 2 * log1p(g->sine2 / square(g->nw)));
}

static term distribution(facet_distribution model, const geometry *g, shape a)
{
    const double m = a.exponent;
    switch (model) {
    case FACET_DISTRIBUTION_NONE: return (term){ 0, 0 };
    case FACET_DISTRIBUTION_GGX: return (term){ ggx(g, a.alpha), ggx(g, a.alpha) };
    case FACET_DISTRIBUTION_GGX_ANISOTROPIC: return (term){ ggx_anisotropic(g, a), ggx_anisotropic(g, a) };
    case FACET_DISTRIBUTION_BECKMANN: return beckmann_isotropic(g, a);
    case FACET_DISTRIBUTION_BECKMANN_ANISOTROPIC: return beckmann_anisotropic(g, a);
    case FACET_DISTRIBUTION_PHONG: return phong(g, m);
    case FACET_DISTRIBUTION_PHONG_MODIFIED: return times((m + 2) / (2 * PI), phong(g, m));
    case FACET_DISTRIBUTION_BLINN_PHONG: return blinn_phong(g, m);
    case FACET_DISTRIBUTION_BLINN_PHONG_NORMALISED:
        return times((m + 2) * (m + 4) / (8 * PI * (pow(2, -m / 2) + m)), blinn_phong(g, m));
    }
    return (term){ NAN, NAN };
}

/* ---- Specular: G ------------------------------------------------------------------------------------------------- */

static bool is_lobe(facet_distribution model)
{
    return model == FACET_DISTRIBUTION_PHONG || model == FACET_DISTRIBUTION_PHONG_MODIFIED
        || model == FACET_DISTRIBUTION_BLINN_PHONG || model == FACET_DISTRIBUTION_BLINN_PHONG_NORMALISED;
}

/* alpha tan of the angle of a direction: Heitz 2014, eq. 80 where there are two alphas. */
static double slope(facet_distribution model, const geometry *g, const double *direction, double mu, shape a)
{
    if (model == FACET_DISTRIBUTION_GGX || model == FACET_DISTRIBUTION_BECKMANN) return a.alpha * sine_of(mu) / mu;
    return sqrt(square(a.alpha * dot(g->x, direction)) + square(a.alpha_y * dot(g->y, direction))) / mu;
}

/* Smith's Lambda: GGX's; Beckmann's by the fit of Walter et al. 2007, as (1 - G1)/G1, or with the error function. */
static double lambda(facet_distribution model, bool exact, double alpha_tan)
{
    if (model == FACET_DISTRIBUTION_GGX || model == FACET_DISTRIBUTION_GGX_ANISOTROPIC)
        return (sqrt(1 + square(alpha_tan)) - 1) / 2;
    if (alpha_tan == 0) return 0;
    const double a = 1 / alpha_tan;
    if (exact) return (exp(-a * a) / (a * sqrt(PI)) - erfc(a)) / 2;
    return a < 1.6 ? fmax(0, (1 - 1.259 * a + 0.396 * a * a) / (3.535 * a + 2.181 * a * a)) : 0;
}

static double smith(facet_distribution model, facet_masking masking, const geometry *g, shape a)
{
    const bool exact = masking == FACET_MASKING_SMITH_EXACT || masking == FACET_MASKING_SMITH_EXACT_CORRELATED;
    const double lambda_l = lambda(model, exact, slope(model, g, g->l, g->c.nl, a));
    const double lambda_v = lambda(model, exact, slope(model, g, g->v, g->c.nv, a));
    if (masking == FACET_MASKING_SMITH || masking == FACET_MASKING_SMITH_EXACT)
        return 1 / ((1 + lambda_l) * (1 + lambda_v));
    return 1 / (1 + lambda_l + lambda_v);
}

/* Torrance and Sparrow: min(1, 2 nh nv/vh, 2 nh nl/vh), nh = n.w/|w|, vh = |w|/2. */
static double v_cavity(const geometry *g)
{
    return fmin(1, 4 * g->nw * fmin(g->c.nl, g->c.nv) / g->hh);
}

static double schlick_ggx(cosines c, double k)
{
    return c.nl / (c.nl * (1 - k) + k) * c.nv / (c.nv * (1 - k) + k);
}

static double hammon(cosines c, double alpha)
{
    const double twice = 2 * c.nl * c.nv;
    return twice / (twice * (1 - alpha) + (c.nl + c.nv) * alpha);
}

static double masking(const facet_material *m, const geometry *g, shape a)
{
    if (is_lobe(m->specular.model)) return 4 * g->c.nl * g->c.nv;
    switch (m->specular.masking) {
    case FACET_MASKING_SMITH_CORRELATED:
    case FACET_MASKING_SMITH:
    case FACET_MASKING_SMITH_EXACT_CORRELATED:
    case FACET_MASKING_SMITH_EXACT: return smith(m->specular.model, m->specular.masking, g, a);
    case FACET_MASKING_V_CAVITY: return v_cavity(g);
    case FACET_MASKING_SCHLICK_GGX: return schlick_ggx(g->c, a.alpha / 2);
    case FACET_MASKING_SCHLICK_GGX_ANALYTIC: return schlick_ggx(g->c, square(sqrt(a.alpha) + 1) / 8);
    case FACET_MASKING_HAMMON: return hammon(g->c, a.alpha);
    }
    return NAN;
}

/* l of a point or spot light is rounded, and may cancel in w = v + l: (|v| + |l|)/|w| is 1/vh. */
static term specular(const facet_material *m, const sample *s, const geometry *g)
{
    const facet_distribution model = m->specular.model;
    const shape a = shape_of(model, s);
    if (model == FACET_DISTRIBUTION_NONE || g->hh == 0) return (term){ 0, 0 };
    const double scale = m->specular.scale == 0 ? 1 : m->specular.scale;
    term f = times(scale * masking(m, g, a) / (4 * g->c.nl * g->c.nv), distribution(model, g, a));
    if (s->light) f.magnitude /= fmin(g->c.vh, 1);
    return f;
}

/* ---- Fresnel ----------------------------------------------------------------------------------------------------- */

/* Reflectances of light whose electric field is perpendicular (s) and parallel (p) to the plane of incidence. */
typedef struct { double s, p; } reflectances;

/* Born and Wolf, ch. 14.2, with the index and extinction relative to the medium around it: a + ib = sqrt(eta^2 - k^2 -
 * sin^2 + 2i eta k), Rs = |(c - a - ib)/(c + a + ib)|^2. Without differences of nearly equal numbers: ab = eta k,
 * a - c = (eta^2 - 1 - k^2 + b^2)/(a + c). A dielectric is that of k = 0. */
static reflectances fresnel_equations(double eta, double k, double outside, double c)
{
    if (eta == outside && k == 0) return (reflectances){ 0, 0 };
    if (c == 0) return (reflectances){ 1, 1 };
    const double relative = (eta - outside) * (eta + outside) / (outside * outside) - square(k / outside);
    const double nk = eta * k / (outside * outside), sin2 = fmax(0, 1 - c * c), t = relative + c * c;
    const double larger = sqrt((hypot(t, 2 * nk) + fabs(t)) / 2), smaller = larger > 0 ? nk / larger : 0;
    const double a = t >= 0 ? larger : smaller, b = t >= 0 ? smaller : larger;
    const double Rs = (square((relative + b * b) / (a + c)) + b * b) / (square(a + c) + b * b);
    return (reflectances){ Rs, Rs * (square(a * c - sin2) + square(b * c)) / (square(a * c + sin2) + square(b * c)) };
}

/* In the material's medium. */
static reflectances exact_fresnel(const facet_material *m, double eta, double k, double vh)
{
    const double outside = m->fresnel.eta_outside == 0 ? 1 : m->fresnel.eta_outside;
    return fresnel_equations(clamp(eta, FACET_ETA_FLOOR, FACET_ETA_CAP), clamp(k, 0, FACET_ETA_CAP),
                             clamp(outside, FACET_ETA_FLOOR, FACET_ETA_CAP), fmin(vh, 1));
}

/* Of the light's polarisation. */
static double mixture(const facet_material *m, double s, double p)
{
    const double parallel = (1 + (double)m->fresnel.polarisation) / 2;
    return (1 - parallel) * s + parallel * p;
}

static term exact_term(const facet_material *m, double eta, double k, double vh)
{
    const reflectances at = exact_fresnel(m, eta, k, vh), before = exact_fresnel(m, eta, k, fmin(vh, 1) * (1 - STEP));
    const reflectances behind = exact_fresnel(m, eta, k, fmin(vh, 1) * (1 + STEP));
    const double turns = mixture(m, turn(at.s, before.s, behind.s), turn(at.p, before.p, behind.p));
    return (term){ mixture(m, at.s, at.p), at.s + turns };
}

/* Schlick's error is that of 1 - vh, five times over: its magnitude has one of the five factors as 1. */
static term schlick(double f0, double f90, double vh)
{
    const double dark = 1 - fmin(vh, 1);
    return (term){ f0 + (f90 - f0) * pow(dark, 5), f0 + fabs(f90 - f0) * pow(dark, 4) };
}

/* Kutz et al. 2021: F - b vh (1 - vh)^6, b so that F is f82 where vh = 1/7. */
static term schlick_f82(const facet_material *m, double f0, double vh, int channel)
{
    const float *given = m->fresnel.f82;
    const bool none = given[0] == 0 && given[1] == 0 && given[2] == 0;
    const reflectances exact = exact_fresnel(m, m->fresnel.eta[channel], m->fresnel.k[channel], 1.0 / 7);
    const double f82 = none ? mixture(m, exact.s, exact.p) : clamp(given[channel], 0, 1);
    const double b = (schlick(f0, 1, 1.0 / 7).value - f82) / (1.0 / 7 * pow(6.0 / 7, 6));
    const term F = schlick(f0, 1, vh);
    const double c = fmin(vh, 1), dark = 1 - c;
    return (term){ clamp(F.value - b * c * pow(dark, 6), 0, 1), F.magnitude + fabs(b) * c * pow(dark, 5) };
}

static term fresnel(const facet_material *m, const sample *s, double vh, int channel)
{
    const double f0 = clamp(s->f0[channel], 0, 1);
    const double f90 = m->fresnel.f90 == 0 ? 1 : clamp(m->fresnel.f90, 0, 1);
    switch (m->fresnel.model) {
    case FACET_FRESNEL_SCHLICK: return schlick(f0, f90, vh);
    case FACET_FRESNEL_CONSTANT: return (term){ f0, f0 };
    case FACET_FRESNEL_ONE: return (term){ 1, 1 };
    case FACET_FRESNEL_SCHLICK_F82: return schlick_f82(m, f0, vh, channel);
    case FACET_FRESNEL_DIELECTRIC: return exact_term(m, s->eta[channel], 0, vh);
    case FACET_FRESNEL_CONDUCTOR: return exact_term(m, s->eta[channel], s->k[channel], vh);
    }
    return (term){ NAN, NAN };
}

/* ---- Radiance ---------------------------------------------------------------------------------------------------- */

void reference_terms(const facet_material *m, const sample *s, double radiance[3], double magnitude[3])
{
    const geometry g = geometry_of(s);
    const bool lit = g.c.nl > 0 && g.c.nv > 0;
    const term f_s = lit ? specular(m, s, &g) : (term){ 0, 0 };
    for (int i = 0; i < 3; i++) {
        const double E = fmax(s->irradiance[i], 0);
        const term f_d = lit ? diffuse(m->diffuse.model, g.c, fmax(s->albedo[i], 0), s->sigma) : (term){ 0, 0 };
        const bool glossy = lit && m->specular.model != FACET_DISTRIBUTION_NONE;
        const term F = glossy ? fresnel(m, s, g.c.vh, i) : (term){ 0, 0 };
        const double transmitted = m->coupled ? 1 - F.value : 1;
        const double most = m->coupled ? fmax(1, F.magnitude) : 1;
        const double f = transmitted * f_d.value + F.value * f_s.value;
        const double size = most * f_d.magnitude + F.magnitude * f_s.magnitude;
        radiance[i] = lit ? f * g.c.nl * g.light.value * E : 0;
        magnitude[i] = lit ? size * g.c.nl * g.light.magnitude * E : 0;
    }
}

void reference_radiance(const facet_material *m, const sample *s, double radiance[3])
{
    double magnitude[3];
    reference_terms(m, s, radiance, magnitude);
}

double reference_distribution(const facet_material *m, const sample *s)
{
    const geometry g = geometry_of(s);
    return distribution(m->specular.model, &g, shape_of(m->specular.model, s)).value;
}

double reference_masking(const facet_material *m, const sample *s)
{
    const geometry g = geometry_of(s);
    return masking(m, &g, shape_of(m->specular.model, s));
}

double reference_fresnel(const facet_material *m, const sample *s, int channel)
{
    return fresnel(m, s, reference_cosines(s).vh, channel).value;
}
