/* The models, once for every architecture and tier: what follows is the mathematics of facet.h's enumerators, over the
 * vector layer that was included before (arch/NAME.h). Each function's formula stands above it, as its source prints
 * it, then as it is evaluated. Names are those of facet.h. What the functions return is the BRDF times nl and times pi,
 * which lights' irradiance is divided by: D, too, is pi times the printed one.
 * Diffuse terms, D and fits divide by vf_div, which on NEON keeps them from the divider. Masking, which comes last,
 * divides by `/`, as do terms that no loop of special.def has. */
#ifndef FACET_MODELS_TMPL_H
#define FACET_MODELS_TMPL_H

#include "fit.tmpl.h"

typedef struct { vf x, y, z; } vf3;

#define PI   3.14159265f
#define TINY FLT_MIN                 /* the least denominator */

OP vf3 splat3(const float *a) { return (vf3){ vf_splat(a[0]), vf_splat(a[1]), vf_splat(a[2]) }; }
OP vf3 add3(vf3 a, vf3 b) { return (vf3){ a.x + b.x, a.y + b.y, a.z + b.z }; }
OP vf3 sub3(vf3 a, vf3 b) { return (vf3){ a.x - b.x, a.y - b.y, a.z - b.z }; }
OP vf3 mul3(vf3 a, vf3 b) { return (vf3){ a.x * b.x, a.y * b.y, a.z * b.z }; }
OP vf3 scale3(vf3 a, vf s) { return (vf3){ a.x * s, a.y * s, a.z * s }; }
OP vf3 mad3(vf3 a, vf3 b, vf3 c)
{
    return (vf3){ vf_mad(a.x, b.x, c.x), vf_mad(a.y, b.y, c.y), vf_mad(a.z, b.z, c.z) };
}
OP vf3 same3(vf a) { return (vf3){ a, a, a }; }
OP vf3 one_minus3(vf3 a) { return (vf3){ 1.0f - a.x, 1.0f - a.y, 1.0f - a.z }; }
#define ZERO3 same3(splat(0.0f))

OP vf dot(vf3 a, vf3 b) { return vf_mad(a.z, b.z, vf_mad(a.y, b.y, a.x * b.x)); }

OP vf3 cross(vf3 a, vf3 b)
{
    return (vf3){ vf_nmad(a.z, b.y, a.y * b.z), vf_nmad(a.x, b.z, a.z * b.x), vf_nmad(a.y, b.x, a.x * b.y) };
}

OP vf pow5(vf a) { vf a2 = a * a; return a2 * a2 * a; }

OP vf at_least_0(vf a) { return vf_at_least(a, splat(0.0f)); }   /* of NaN a NaN */
OP vf3 not_negative3(vf3 a) { return (vf3){ vf_not_negative(a.x), vf_not_negative(a.y), vf_not_negative(a.z) }; }
OP vf clamp(vf a, float low, float high) { return vf_min(vf_max(a, splat(low)), splat(high)); }
OP vf3 clamp3(vf3 a, float low, float high)
{
    return (vf3){ clamp(a.x, low, high), clamp(a.y, low, high), clamp(a.z, low, high) };
}

/* The same, but a NaN stays one. */
OP vf within(vf a, float low, float high) { return vf_at_most(vf_at_least(a, splat(low)), splat(high)); }

/* What follows from sigma alone; a model gives each its meaning. */
typedef struct { vf A, B, C, D; } terms;

/* What a sample brings, whatever the light; in its domain. */
typedef struct {
    vf3 n, v, tangent;
    terms terms;
    vf3 albedo;
    vf alpha, alpha2, alpha_y;
    vf exponent;
    vf3 f0, f82, eta, k;
    vf f90, eta_outside, parallel;   /* parallel: the part of the light that is polarised in the plane of incidence */
} surface;

/* One light at one sample; w = v + l. */
typedef struct {
    vf3 l;
    vf nl, nv, vl;           /* nl: 0 where the light is not seen; nv: > 0 */
    vf hh;                   /* |w|^2 */
    vf nw, nxw2;             /* n.w, of any sign, and |n x w|^2: cos and sin^2 of the half vector, times |w|, hh */
} incidence;

/* The microfacet's own cosine. */
OP vf vh(incidence i) { return vf_min(0.5f * vf_sqrt(i.hh), splat(1.0f)); }

/* ---- Diffuse: added to what comes along -------------------------------------------------------------------------- */

#define NO_TERMS ((terms){ splat(0.0f), splat(0.0f), splat(0.0f), splat(0.0f) })
OP terms terms_none(vf sigma) { (void)sigma; return NO_TERMS; }
#define terms_lambert terms_none

OP vf3 diffuse_none(surface s, incidence i, vf3 plus) { (void)s, (void)i; return plus; }

/* f = albedo/pi. */
OP vf3 diffuse_lambert(surface s, incidence i, vf3 plus) { return mad3(s.albedo, same3(i.nl), plus); }

/* Oren and Nayar 1994, qualitative: f = albedo/pi (A + B max(0, cos(phi_i - phi_r)) sin a tan b), a and b the larger
 * and the smaller of the angles of l and v to n.
 * With s0 = vl - nl nv: cos(phi_i - phi_r) sin a tan b = s0/max(nl, nv), exactly. No angle, no azimuth of a vertical
 * vector, no tangent at grazing; nl s0/max(nl, nv) <= 1. */
OP vf3 oren_nayar(surface s, incidence i, vf3 plus)
{
    vf s0 = vf_nmad(i.nl, i.nv, i.vl);
    vf sin_tan = vf_div(vf_not_negative(s0), vf_max(i.nl, i.nv));
    return mad3(s.albedo, same3(i.nl * vf_mad(s.terms.B, sin_tan, s.terms.A)), plus);
}

/* A = 1 - 0.5 s2/(s2 + fold), B = 0.45 s2/(s2 + 0.09), s = sigma. */
OP terms oren_nayar_terms(vf sigma, float fold)
{
    vf s2 = square(sigma);
    terms t = NO_TERMS;
    t.A = 1.0f - vf_div(s2, s2 + s2 + 2.0f * fold);
    t.B = vf_div(0.45f * s2, s2 + 0.09f);
    return t;
}
OP terms terms_oren_nayar(vf sigma) { return oren_nayar_terms(sigma, 0.33f); }
OP terms terms_oren_nayar_57(vf sigma) { return oren_nayar_terms(sigma, 0.57f); }
#define diffuse_oren_nayar oren_nayar
#define diffuse_oren_nayar_57 oren_nayar

/* Oren and Nayar 1994, eq. 30: L1 = albedo/pi (C1 + cos(phi) C2 tan b + (1 - |cos(phi)|) C3 tan((a + b)/2)),
 *     C1 = A, C2 = B (sin a - (cos(phi) < 0 ? (2b/pi)^3 : 0)), C3 = 0.125/0.45 B (4ab/pi^2)^2;
 * eq. 31: L2 = 0.17 albedo^2/pi s2/(s2 + 0.13) (1 - cos(phi) (2b/pi)^2).
 * cos(phi) sin a tan b = s0/cos b as above; tan b = sin b/cos b and tan((a + b)/2) = (sin a + sin b)/(nl + nv) are
 * multiplied by nl before they can overflow. Where b = 0 there is no azimuth, and nothing left for it to multiply. The
 * sum is negative at grazing, with opposite azimuths: 0. */
OP vf3 oren_nayar_1994(surface s, incidence i, vf3 plus, bool interreflection)
{
    vf cos_a = vf_min(i.nl, i.nv), cos_b = vf_max(i.nl, i.nv);
    vf sin_a = vf_sqrt(vf_not_negative(1.0f - square(cos_a))), sin_b = vf_sqrt(vf_not_negative(1.0f - square(cos_b)));
    vf a = arccos(cos_a) * (2.0f * INV_PI), b = arccos(cos_b) * (2.0f * INV_PI), b2 = square(b);
    vf s0 = vf_nmad(i.nl, i.nv, i.vl);
    vf cos_phi = clamp(vf_div(s0, vf_at_least(sin_a * sin_b, splat(TINY))), -1.0f, 1.0f);

    vf opposed = vf_min(cos_phi, splat(0.0f)) * (b * b2) * sin_b;
    vf C2 = (s0 - opposed) * vf_div(i.nl, cos_b);
    vf C3 = (0.125f / 0.45f) * square(a * b) * (1.0f - vf_abs(cos_phi)) * vf_div(i.nl * (sin_a + sin_b), i.nl + i.nv);
    vf L1 = vf_mad(s.terms.B, C2 + C3, s.terms.A * i.nl);
    vf L2 = s.terms.C * i.nl * vf_nmad(cos_phi, b2, splat(1.0f));
    if (!interreflection) L2 = splat(0.0f);
    vf3 sum = mul3(s.albedo, mad3(s.albedo, same3(L2), same3(L1)));
    return add3(plus, (vf3){ at_least_0(sum.x), at_least_0(sum.y), at_least_0(sum.z) });
}
OP vf3 diffuse_oren_nayar_full(surface s, incidence i, vf3 plus) { return oren_nayar_1994(s, i, plus, true); }
OP vf3 diffuse_oren_nayar_direct(surface s, incidence i, vf3 plus) { return oren_nayar_1994(s, i, plus, false); }

OP terms terms_oren_nayar_full(vf sigma)
{
    vf s2 = square(sigma);
    terms t = terms_oren_nayar(sigma);
    t.C = vf_div(0.17f * s2, s2 + 0.13f);
    return t;
}
#define terms_oren_nayar_direct terms_oren_nayar_full

/* Fujii: f = albedo (A + B s0/t), A = 1/(pi + (pi/2 - 2/3) r), B = r A, t = max(nl, nv) where s0 > 0, else 1. Here
 * times pi: A = 1/(1 + c1 r), c1 = 1/2 - 2/(3 pi). */
OP terms terms_fujii(vf r)
{
    terms t = NO_TERMS;
    t.A = vf_div(splat(1.0f), 1.0f + 0.287793409f * r);
    t.B = r * t.A;
    return t;
}

OP vf fujii(surface s, incidence i)
{
    vf s0 = vf_nmad(i.nl, i.nv, i.vl);
    vf t = vf_select(vf_lt(splat(0.0f), s0), vf_max(i.nl, i.nv), splat(1.0f));
    return i.nl * vf_not_negative(vf_mad(s.terms.B, vf_div(s0, t), s.terms.A));
}
OP vf3 diffuse_fujii(surface s, incidence i, vf3 plus) { return mad3(s.albedo, same3(fujii(s, i)), plus); }

/* Portsmouth, Kutz, Hill 2024. Single scattering is Fujii's; what scatters more than once adds
 *     albedo_ms/pi (1 - E(nv)) (1 - E(nl))/(1 - Eavg), albedo_ms = albedo^2 Eavg/(1 - albedo (1 - Eavg)),
 *     E(mu) = A (1 + r G(mu)/pi), Eavg = A (1 + c2 r), A = 1/(1 + c1 r), c1 = 1/2 - 2/(3 pi), c2 = 2/3 - 28/(15 pi).
 * 1 - E(mu) = A r (c1 - G(mu)/pi) and 1 - Eavg = A r (c1 - c2): one r cancels, and r = 0 is Lambert. The fit of G
 * passes c1 for mu < 0.00138, where E would exceed 1: p = max(0, c1 - G/pi). An albedo above 1 is 1 in albedo_ms. */
OP vf eon_missing(vf mu)
{
    vf x = 1.0f - mu;
    vf G = x * vf_mad(x, vf_mad(x, vf_mad(x, splat(0.0714429953f), splat(-0.332181442f)), splat(0.491881867f)),
                      splat(0.0571085289f));
    return vf_not_negative(0.287793409f - G);
}

OP vf3 diffuse_eon(surface s, incidence i, vf3 plus)
{
    vf3 once = diffuse_fujii(s, i, plus), white = clamp3(s.albedo, 0.0f, 1.0f);
    vf more = s.terms.C * i.nl * eon_missing(i.nl) * eon_missing(i.nv);
    vf3 a2 = mul3(white, white);
    return (vf3){ vf_mad(a2.x, vf_div(more, vf_nmad(white.x, s.terms.D, splat(1.0f))), once.x),
                  vf_mad(a2.y, vf_div(more, vf_nmad(white.y, s.terms.D, splat(1.0f))), once.y),
                  vf_mad(a2.z, vf_div(more, vf_nmad(white.z, s.terms.D, splat(1.0f))), once.z) };
}

/* C = A r Eavg/(c1 - c2), D = 1 - Eavg. */
OP terms terms_eon(vf r)
{
    terms t = terms_fujii(r);
    t.C = (1.0f / 0.215305197f) * t.A * t.B * (1.0f + 0.0724882125f * r);
    t.D = 0.215305197f * t.B;
    return t;
}

/* ---- Specular: f = D V F, V = G nl/(4 nl nv) ------------------------------------------------------------------- */

OP vf distribution_none(surface s, incidence i) { (void)s, (void)i; return splat(0.0f); }

/* Trowbridge and Reitz; Walter et al. 2007, eq. 33: D = alpha^2/(pi (nh^2 (alpha^2 - 1) + 1)^2).
 * From the vectors, without 1 - nh^2: q = alpha hh/(|n x w|^2 + alpha^2 (n.w)^2), D = q^2/pi. */
OP vf distribution_ggx(surface s, incidence i)
{
    vf q = vf_div(s.alpha * i.hh, vf_at_least(vf_mad(s.alpha2, square(i.nw), i.nxw2), splat(TINY)));
    return square(q);
}

/* The tangent frame's components of a vector: along the tangent x, along y = n x tangent. */
typedef struct { vf x, y; } across;
OP across across_of(surface s, vf3 a) { return (across){ dot(s.tangent, a), dot(cross(s.n, s.tangent), a) }; }

/* Heitz 2014, eq. 84: D = 1/(pi ax ay ((x.h)^2/ax^2 + (y.h)^2/ay^2 + (n.h)^2)^2).
 * q = ax ay hh/((ay x.w)^2 + (ax y.w)^2 + (ax ay n.w)^2), D = ax ay q^2/pi. */
OP vf distribution_ggx_anisotropic(surface s, incidence i)
{
    across w = across_of(s, add3(s.v, i.l));
    vf area = s.alpha * s.alpha_y;
    vf slope = vf_mad(s.alpha_y * w.x, s.alpha_y * w.x, square(s.alpha * w.y));
    vf q = vf_div(area * i.hh, vf_at_least(vf_mad(area * i.nw, area * i.nw, slope), splat(TINY)));
    return area * square(q);
}

/* exp(-slope)/(pi area nh^4), 1/nh^2 = 1 + tan^2. Where tan^2 > 1e18, or has overflowed to infinity or, by vf_div, to
 * NaN, the exponential is 0 anyway. */
OP vf beckmann(vf tan2, vf slope, vf area)
{
    return vf_div(exp_minus(slope) * square(1.0f + vf_min(tan2, splat(1e18f))), area);
}

/* Beckmann 1963; Cook and Torrance 1981: D = exp(-tan^2/alpha^2)/(pi alpha^2 nh^4), tan^2 = |n x w|^2/(n.w)^2. */
OP vf distribution_beckmann(surface s, incidence i)
{
    vf tan2 = vf_div(i.nxw2, vf_at_least(square(i.nw), splat(TINY)));
    return beckmann(tan2, vf_div(tan2, s.alpha2), s.alpha2);
}

/* Heitz 2014, eq. 82: ((x.h)^2/ax^2 + (y.h)^2/ay^2)/(n.h)^2 in place of tan^2/alpha^2. */
OP vf distribution_beckmann_anisotropic(surface s, incidence i)
{
    across w = across_of(s, add3(s.v, i.l));
    vf nw2 = vf_at_least(square(i.nw), splat(TINY));
    vf slope = square(vf_div(w.x, s.alpha)) + square(vf_div(w.y, s.alpha_y));
    return beckmann(vf_div(vf_mad(w.x, w.x, square(w.y)), nw2), vf_div(slope, nw2), s.alpha * s.alpha_y);
}

/* cos^exponent, of tan^2 = sin2/cos2: cos near 1 has lost what exponent ln(cos) needs, tan^2 has not. */
OP vf lobe(surface s, vf sin2, vf cos2)
{
    return exp_minus(0.5f * s.exponent * log1p_ratio(sin2, vf_at_least(cos2, splat(TINY))));
}

/* Phong 1975: (r.v)^exponent, r = 2 nl n - l, 0 where r.v <= 0. */
OP vf phong(surface s, incidence i)
{
    vf3 r = sub3(scale3(s.n, 2.0f * dot(s.n, i.l)), i.l), rxv = cross(r, s.v);
    vf rv = dot(r, s.v);
    return vf_where(vf_lt(splat(0.0f), rv), lobe(s, dot(rxv, rxv), square(rv)));
}
OP vf distribution_phong(surface s, incidence i) { return phong(s, i) * PI; }

/* Lafortune and Willems 1994: times (exponent + 2)/(2 pi). */
OP vf distribution_phong_modified(surface s, incidence i)
{
    return phong(s, i) * (0.5f * s.exponent + 1.0f);
}

/* Blinn 1977: nh^exponent. */
OP vf distribution_blinn_phong(surface s, incidence i) { return lobe(s, i.nxw2, square(i.nw)) * PI; }

/* Times (m + 2)(m + 4)/(8 pi (2^(-m/2) + m)), m = exponent: white reflects all of what falls in along the normal. */
OP vf distribution_blinn_phong_normalised(surface s, incidence i)
{
    vf m = s.exponent, power = exp_minus(m * 0.346573590f);
    return lobe(s, i.nxw2, square(i.nw)) * ((m + 2.0f) * (m + 4.0f) * 0.125f / (power + m));
}

/* ---- Masking ---- Smith's G1(mu) = 1/(1 + Lambda), as mu/G1 = mu (1 + Lambda): a function of mu and
 * y^2 = mu^2 alpha^2 tan^2 that neither divides by a small mu nor cancels. ----------------------------------------- */

/* y^2 for l and v. */
typedef struct { vf l, v; } slopes;

OP slopes isotropic(surface s, incidence i)
{
    return (slopes){ s.alpha2 * vf_not_negative(1.0f - square(i.nl)), s.alpha2 * vf_not_negative(1.0f - square(i.nv)) };
}

/* Heitz 2014, eq. 80: alpha tan is that of the direction's azimuth. */
OP vf slope_along(surface s, vf3 a)
{
    across t = across_of(s, a);
    return vf_mad(s.alpha * t.x, s.alpha * t.x, square(s.alpha_y * t.y));
}
OP slopes anisotropic(surface s, incidence i) { return (slopes){ slope_along(s, i.l), slope_along(s, s.v) }; }

/* G = G1(nl) G1(nv); Heitz 2014, eq. 99: G = 1/(1 + Lambda(nl) + Lambda(nv)). l and v: mu/G1 for nl and nv. */
OP vf separable(incidence i, vf l, vf v) { return 0.25f * i.nl / vf_at_least(l * v, splat(TINY)); }
OP vf correlated(incidence i, vf l, vf v)
{
    return 0.25f * i.nl / vf_at_least(vf_mad(l, i.nv, i.nl * (v - i.nv)), splat(TINY));
}

/* GGX: Lambda = (-1 + sqrt(1 + alpha^2 tan^2))/2, mu/G1 = (mu + sqrt(mu^2 + y^2))/2. */
OP vf ggx(vf mu, vf y2) { return 0.5f * (mu + vf_sqrt(vf_mad(mu, mu, y2))); }

/* Walter et al. 2007, eq. 27, for Beckmann, a = mu/y: G1 = (3.535 a + 2.181 a^2)/(1 + 2.276 a + 2.577 a^2) for a < 1.6,
 * at most 1; 1 above. Within 0.31 % of the exact one. */
OP vf walter(vf mu, vf y2)
{
    vf y = vf_sqrt(y2), over = vf_mad(splat(3.535f), y, 2.181f * mu);
    vf h = vf_mad(mu, vf_mad(splat(2.577f), mu, 2.276f * y), y2) / vf_at_least(over, splat(TINY));
    return vf_select(vf_lt(mu, 1.6f * y), vf_max(h, mu), mu);
}

/* Smith 1967 for Beckmann: Lambda = (erf(a) - 1)/2 + exp(-a^2)/(2 a sqrt(pi)), a = mu/y; so
 * mu/G1 = mu (1 + erf(a))/2 + y exp(-a^2)/(2 sqrt(pi)) = mu + y g(a), g = ierfc_half. */
OP vf smith_exact(vf mu, vf y2)
{
    vf y = vf_sqrt(y2);
    return vf_mad(y, ierfc_half(mu / vf_at_least(y, splat(TINY))), mu);
}

#define SMITH(name, how, shadow, spread)                                                                              \
    OP vf visibility_##name(surface s, incidence i)                                                                   \
    {                                                                                                                 \
        slopes y2 = spread(s, i);                                                                                     \
        return how(i, shadow(i.nl, y2.l), shadow(i.nv, y2.v));                                                        \
    }
SMITH(smith_ggx_anisotropic, separable, ggx, anisotropic)
SMITH(smith_correlated_ggx_anisotropic, correlated, ggx, anisotropic)
SMITH(smith_beckmann, separable, walter, isotropic)
SMITH(smith_correlated_beckmann, correlated, walter, isotropic)
SMITH(smith_exact_beckmann, separable, smith_exact, isotropic)
SMITH(smith_exact_correlated_beckmann, correlated, smith_exact, isotropic)
SMITH(smith_beckmann_anisotropic, separable, walter, anisotropic)
SMITH(smith_correlated_beckmann_anisotropic, correlated, walter, anisotropic)
SMITH(smith_exact_beckmann_anisotropic, separable, smith_exact, anisotropic)
SMITH(smith_exact_correlated_beckmann_anisotropic, correlated, smith_exact, anisotropic)

/* GGX in fewer operations: sqrt(alpha^2 + (1 - alpha^2) mu^2) = mu sqrt(1 + alpha^2 tan^2). */
OP vf ggx_slope(surface s, vf mu)
{
    vf mu2 = square(mu);
    return vf_sqrt(vf_mad(s.alpha2, 1.0f - mu2, mu2));
}

/* V = 0.5 nl/(nl sqrt(nv^2 (1 - alpha^2) + alpha^2) + nv sqrt(nl^2 (1 - alpha^2) + alpha^2)) <= 1/(2 alpha). */
OP vf visibility_smith_correlated_ggx(surface s, incidence i)
{
    vf sum = vf_mad(i.nl, ggx_slope(s, i.nv), i.nv * ggx_slope(s, i.nl));
    return i.nl / (sum + sum);
}

/* Walter et al. 2007, eq. 23 and 34: G1(mu) = 2/(1 + sqrt(1 + alpha^2 tan^2)). */
OP vf visibility_smith_ggx(surface s, incidence i)
{
    return i.nl / ((i.nl + ggx_slope(s, i.nl)) * (i.nv + ggx_slope(s, i.nv)));
}

/* Torrance and Sparrow 1967: G = min(1, 2 nh nv/vh, 2 nh nl/vh), nh/vh = 2 n.w/hh. */
OP vf v_cavity(surface s, incidence i)
{
    (void)s;
    vf inverse = 1.0f / i.nv, near = vf_abs(i.nw) / vf_at_least(i.hh, splat(TINY));
    return vf_min(0.25f * inverse, near * (vf_min(i.nl, i.nv) * inverse));
}
#define visibility_v_cavity_ggx v_cavity
#define visibility_v_cavity_ggx_anisotropic v_cavity
#define visibility_v_cavity_beckmann v_cavity
#define visibility_v_cavity_beckmann_anisotropic v_cavity

/* Schlick 1994: G1(mu) = mu/(mu (1 - k) + k). */
OP vf schlick_masking(incidence i, vf k)
{
    return 0.25f * i.nl / (vf_mad(i.nl, 1.0f - k, k) * vf_mad(i.nv, 1.0f - k, k));
}

/* Karis 2013: k = alpha/2; for analytic lights (roughness + 1)^2/8, roughness^2 = alpha. */
OP vf visibility_schlick_ggx_ggx(surface s, incidence i) { return schlick_masking(i, 0.5f * s.alpha); }
OP vf visibility_schlick_ggx_analytic_ggx(surface s, incidence i)
{
    return schlick_masking(i, 0.125f * square(vf_sqrt(s.alpha) + 1.0f));
}

/* Hammon 2017: G = 2 nl nv/lerp(2 nl nv, nl + nv, alpha). */
OP vf visibility_hammon_ggx(surface s, incidence i)
{
    vf smooth = 2.0f * i.nl * i.nv;
    return 0.5f * i.nl / vf_mad(s.alpha, i.nl + i.nv, smooth * (1.0f - s.alpha));
}

/* ---- Fresnel: at vh, times what it weighs ------------------------------------------------------------------------ */

OP vf3 fresnel_one(surface s, incidence i, vf weight) { (void)s, (void)i; return same3(weight); }

OP vf3 fresnel_constant(surface s, incidence i, vf weight) { (void)i; return scale3(s.f0, weight); }

/* 1 - vh, below 0 by rounding alone, or where vectors are far from unit length. */
OP vf one_minus_vh(incidence i)
{
    return vf_at_most(vf_abs(vf_nmad(splat(0.5f), vf_sqrt(i.hh), splat(1.0f))), splat(1.0f));
}

/* Schlick 1994: F = f0 + (f90 - f0)(1 - vh)^5. */
OP vf3 fresnel_schlick(surface s, incidence i, vf weight)
{
    vf grazing = weight * pow5(one_minus_vh(i)), normal = weight - grazing;
    return mad3(s.f0, same3(normal), same3(s.f90 * grazing));
}

/* Kutz et al. 2021: F = schlick(vh) - b vh (1 - vh)^6, b such that F = f82 where vh = 1/7; within [0, 1]. */
OP vf f82_corrected(vf f0, vf f82, vf c5, vf bump)
{
    vf schlick = vf_mad(f0, 1.0f - c5, c5);
    vf there = vf_mad(f0, splat(1.0f - 0x1.d9c4bp-2f), splat(0x1.d9c4bp-2f));         /* (6/7)^5 */
    return clamp(vf_nmad(there - f82, bump, schlick), 0.0f, 1.0f);
}
OP vf3 fresnel_schlick_f82(surface s, incidence i, vf weight)
{
    vf c = one_minus_vh(i), c5 = pow5(c), bump = vh(i) * c5 * c * 17.6513846f;   /* 7 (7/6)^6 */
    vf3 F = { f82_corrected(s.f0.x, s.f82.x, c5, bump), f82_corrected(s.f0.y, s.f82.y, c5, bump),
              f82_corrected(s.f0.z, s.f82.z, c5, bump) };
    return scale3(F, weight);
}

/* Cook and Torrance 1981, with c = vh, eta relative to the medium outside: g^2 = eta^2 - 1 + c^2,
 *     F = 1/2 ((g - c)/(g + c))^2 (1 + ((c (g + c) - 1)/(c (g - c) + 1))^2), 1 where g^2 < 0.
 * Here times the outer index o: m = (eta - o)(eta + o), g^2 = m + (o c)^2, and g - o c = m/(g + o c), as exact near
 * eta = o as anywhere. The two addends are light polarised across the plane of incidence and in it. */
OP vf dielectric(vf eta, vf o, vf c, vf parallel)
{
    vf oc = o * c, m = (eta - o) * (eta + o), g2 = vf_mad(oc, oc, m);
    vf sum = vf_at_least(vf_sqrt(vf_not_negative(g2)) + oc, splat(TINY)), difference = m / sum;
    vf p = vf_mad(c, sum, -o) / vf_mad(c, difference, o);
    vf F = square(difference / sum) * vf_mad(parallel, square(p), 1.0f - parallel);
    return vf_select(vf_lt(g2, splat(0.0f)), splat(1.0f), vf_at_most(F, splat(1.0f)));
}
OP vf3 fresnel_dielectric(surface s, incidence i, vf weight)
{
    vf c = vh(i);
    vf3 F = { dielectric(s.eta.x, s.eta_outside, c, s.parallel), dielectric(s.eta.y, s.eta_outside, c, s.parallel),
              dielectric(s.eta.z, s.eta_outside, c, s.parallel) };
    return scale3(F, weight);
}

/* Born and Wolf, ch. 14, with c = vh, sin^2 = 1 - c^2, times the outer index o:
 *     2 a^2 = sqrt(t^2 + 4 eta^2 k^2) + t, 2 b^2 = the same root - t, t = eta^2 - k^2 - o^2 sin^2 = X + Y,
 *     Rs = ((a - o c)^2 + b^2)/((a + o c)^2 + b^2),
 *     Rp = Rs ((a c - o sin^2)^2 + b^2 c^2)/((a c + o sin^2)^2 + b^2 c^2).
 * The smaller of a^2, b^2 is eta^2 k^2 over the larger. a - o c = (a^2 - X)/(a + o c), where a^2 - X, without the
 * cancellation, is 2 (X Y + eta^2 k^2)/(root + X - Y) for Y < X. */
OP vf conductor(vf eta, vf k, vf o, vf c, vf parallel)
{
    vf oc = o * c, sin2 = (1.0f - c) * (1.0f + c);
    vf X = square(oc), Y = vf_nmad(k, k, (eta - o) * (eta + o)), t = X + Y, ek2 = square(eta * k);
    vf root = vf_sqrt(vf_mad(t, t, 4.0f * ek2)), larger = 0.5f * (root + vf_abs(t));
    vf smaller = ek2 / vf_at_least(larger, splat(TINY));
    vm above = vf_lt(splat(0.0f), t);
    vf a = vf_sqrt(vf_select(above, larger, smaller)), b2 = vf_select(above, smaller, larger);

    vf sum = a + oc, cancelled = 2.0f * vf_mad(X, Y, ek2) / vf_at_least((root + (X - Y)) * sum, splat(TINY));
    vf difference = vf_select(vf_lt(Y, X), cancelled, a - oc);
    vf Rs = vf_mad(difference, difference, b2) / vf_at_least(vf_mad(sum, sum, b2), splat(TINY));

    vf steep = o * sin2, bc2 = b2 * square(c), minus = vf_mad(a, c, -steep), plus = vf_mad(a, c, steep);
    vf ratio = vf_mad(minus, minus, bc2) / vf_at_least(vf_mad(plus, plus, bc2), splat(TINY));
    return vf_at_most(Rs * vf_mad(parallel, ratio, 1.0f - parallel), splat(1.0f));
}
OP vf3 fresnel_conductor(surface s, incidence i, vf weight)
{
    vf c = vh(i);
    vf3 F = { conductor(s.eta.x, s.k.x, s.eta_outside, c, s.parallel),
              conductor(s.eta.y, s.k.y, s.eta_outside, c, s.parallel),
              conductor(s.eta.z, s.k.z, s.eta_outside, c, s.parallel) };
    return scale3(F, weight);
}

/* ---- What one parameter says of another: a NaN, that it is not known -------------------------------------------- */

/* Metallic-roughness: albedo = base (1 - metallic), f0 = lerp(0.08 specular_level, base, metallic). */
OP vf3 albedo_of_base(vf3 base, vf metallic) { return scale3(base, 1.0f - metallic); }
OP vf3 f0_of_base(vf3 base, vf metallic, vf specular_level)
{
    vf part = 0.08f * specular_level * (1.0f - metallic);
    vf3 f0 = mad3(base, same3(metallic), same3(part));
    return (vf3){ within(f0.x, 0.0f, 1.0f), within(f0.y, 0.0f, 1.0f), within(f0.z, 0.0f, 1.0f) };
}

OP vf alpha_of_roughness(vf roughness) { return within(square(roughness), FACET_ALPHA_FLOOR, 1.0f); }

/* Born and Wolf, ch. 14: ((eta - o)^2 + k^2)/((eta + o)^2 + k^2). */
OP vf f0_of_index(vf eta, vf k, vf o)
{
    vf k2 = square(k);
    return vf_mad(eta - o, eta - o, k2) / vf_mad(eta + o, eta + o, k2);
}

/* Cook and Torrance 1981: eta = (1 + sqrt f0)/(1 - sqrt f0), here (1 + sqrt f0)^2/(1 - f0), where nothing cancels; at
 * most FACET_ETA_CAP. */
OP vf eta_of_f0(vf f0) { return within(square(1.0f + vf_sqrt(f0)) / (1.0f - f0), 1.0f, FACET_ETA_CAP); }

/* In a medium of index o. */
OP vf eta_in(vf f0, vf o) { return within(o * eta_of_f0(f0), FACET_ETA_FLOOR, FACET_ETA_CAP); }

#endif
