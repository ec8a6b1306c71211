/* The models, once for every architecture and tier: what follows is the mathematics of facet.h's enumerators, over the
 * vector layer that was included before (arch/NAME.h). Each function's formula stands above it, as its source prints
 * it, then as it is evaluated. Names are those of facet.h; `f` is always the BRDF times nl. */
#ifndef FACET_MODELS_TMPL_H
#define FACET_MODELS_TMPL_H

#include "internal.h"

typedef struct { vf x, y, z; } vf3;

#define TINY    FLT_MIN              /* the least denominator */

OP vf splat(float a) { return vf_splat(a); }
OP vf3 splat3(const float *a) { return (vf3){ vf_splat(a[0]), vf_splat(a[1]), vf_splat(a[2]) }; }
OP vf3 add3(vf3 a, vf3 b) { return (vf3){ a.x + b.x, a.y + b.y, a.z + b.z }; }
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

OP vf square(vf a) { return a * a; }
OP vf pow5(vf a) { vf a2 = a * a; return a2 * a2 * a; }

OP vf not_negative(vf a) { return vf_max(a, splat(0.0f)); }
OP vf3 not_negative3(vf3 a) { return (vf3){ not_negative(a.x), not_negative(a.y), not_negative(a.z) }; }
OP vf clamp(vf a, float low, float high) { return vf_min(vf_max(a, splat(low)), splat(high)); }

/* What follows from sigma alone: A and B of the Oren-Nayar family, over pi. */
typedef struct { vf A, B; } terms;

/* What a sample brings, whatever the light; in its domain. */
typedef struct {
    terms terms;
    vf3 albedo;
    vf alpha, alpha2;
    vf3 f0;
    vf f90;
} surface;

/* One light at one sample; w = v + l. */
typedef struct {
    vf nl, nv, vl;           /* nl: 0 where the light is not seen; nv: > 0 */
    vf hh;                   /* |w|^2 */
    vf nw2, nxw2;            /* (n.w)^2, |n x w|^2: cos^2 and sin^2 of the half vector, times hh */
} incidence;

/* ---- Diffuse --------------------------------------------------------------------------------------------------- */

OP terms terms_none(vf sigma) { (void)sigma; return (terms){ splat(0.0f), splat(0.0f) }; }
#define terms_lambert terms_none

OP vf3 diffuse_none(surface s, incidence i) { (void)s, (void)i; return ZERO3; }

/* f = albedo/pi. */
OP vf3 diffuse_lambert(surface s, incidence i) { return scale3(s.albedo, i.nl * INV_PI); }

/* Oren and Nayar 1994, qualitative: f = albedo/pi (A + B max(0, cos(phi_i - phi_r)) sin a tan b), a and b the larger
 * and the smaller of the angles of l and v to n.
 * With s0 = vl - nl nv: cos(phi_i - phi_r) sin a tan b = s0/max(nl, nv), exactly. No angle, no azimuth of a vertical
 * vector, no tangent at grazing; nl s0/max(nl, nv) <= 1. */
OP vf3 oren_nayar(surface s, incidence i)
{
    vf s0 = vf_nmad(i.nl, i.nv, i.vl);
    vf sin_tan = not_negative(s0) / vf_max(i.nl, i.nv);
    return scale3(s.albedo, i.nl * vf_mad(s.terms.B, sin_tan, s.terms.A));
}

/* A = 1 - 0.5 s2/(s2 + fold), B = 0.45 s2/(s2 + 0.09), s = sigma; both over pi. */
OP terms oren_nayar_terms(vf sigma, float fold)
{
    vf s2 = square(sigma);
    return (terms){ INV_PI - (0.5f * INV_PI) * s2 / (s2 + fold), (0.45f * INV_PI) * s2 / (s2 + 0.09f) };
}
OP terms terms_oren_nayar(vf sigma) { return oren_nayar_terms(sigma, 0.33f); }
OP terms terms_oren_nayar_57(vf sigma) { return oren_nayar_terms(sigma, 0.57f); }
#define diffuse_oren_nayar oren_nayar
#define diffuse_oren_nayar_57 oren_nayar

/* Fujii: f = albedo (A + B s0/t), A = 1/(pi + (pi/2 - 2/3) r), B = r A, t = max(nl, nv) where s0 > 0, else 1. */
OP terms terms_fujii(vf r)
{
    vf A = 1.0f / (3.14159265f + 0.904129660f * r);
    return (terms){ A, r * A };
}

OP vf3 diffuse_fujii(surface s, incidence i)
{
    vf s0 = vf_nmad(i.nl, i.nv, i.vl);
    vf t = vf_select(vf_lt(splat(0.0f), s0), vf_max(i.nl, i.nv), splat(1.0f));
    return scale3(s.albedo, i.nl * not_negative(vf_mad(s.terms.B, s0 / t, s.terms.A)));
}

/* ---- Specular: f = D V F, V = G nl/(4 nl nv) ------------------------------------------------------------------- */

OP vf distribution_none(surface s, incidence i) { (void)s, (void)i; return splat(0.0f); }

/* Trowbridge and Reitz; Walter et al. 2007, eq. 33: D = alpha^2/(pi (nh^2 (alpha^2 - 1) + 1)^2).
 * From the vectors, without 1 - nh^2: q = alpha hh/(|n x w|^2 + alpha^2 (n.w)^2), D = q^2/pi. Where w = 0, D = 0. */
OP vf distribution_ggx(surface s, incidence i)
{
    vf q = s.alpha * i.hh / vf_max(splat(TINY), vf_mad(s.alpha2, i.nw2, i.nxw2));
    return square(q) * INV_PI;
}

/* sqrt(alpha^2 + (1 - alpha^2) mu^2) = mu sqrt(1 + alpha^2 tan^2). */
OP vf ggx_slope(surface s, vf mu)
{
    vf mu2 = square(mu);
    return vf_sqrt(vf_mad(s.alpha2, 1.0f - mu2, mu2));
}

/* Heitz 2014, eq. 99: G = 1/(1 + Lambda(nl) + Lambda(nv)), Lambda(mu) = (-1 + sqrt(1 + alpha^2 tan^2))/2.
 * V = 0.5 nl/(nl sqrt(nv^2 (1 - alpha^2) + alpha^2) + nv sqrt(nl^2 (1 - alpha^2) + alpha^2)) <= 1/(2 alpha). */
OP vf visibility_smith_correlated_ggx(surface s, incidence i)
{
    return 0.5f * i.nl / vf_mad(i.nl, ggx_slope(s, i.nv), i.nv * ggx_slope(s, i.nl));
}

/* Walter et al. 2007, eq. 23 and 34: G = G1(nl) G1(nv), G1(mu) = 2/(1 + sqrt(1 + alpha^2 tan^2)). */
OP vf visibility_smith_ggx(surface s, incidence i)
{
    return i.nl / ((i.nl + ggx_slope(s, i.nl)) * (i.nv + ggx_slope(s, i.nv)));
}

/* ---- Fresnel: at vh, the microfacet's own cosine --------------------------------------------------------------- */

OP vf3 fresnel_one(surface s, incidence i) { (void)s, (void)i; return same3(splat(1.0f)); }

OP vf3 fresnel_constant(surface s, incidence i) { (void)i; return s.f0; }

/* Schlick 1994: F = f0 + (f90 - f0)(1 - vh)^5. */
OP vf3 fresnel_schlick(surface s, incidence i)
{
    vf c = vf_abs(vf_nmad(splat(0.5f), vf_sqrt(i.hh), splat(1.0f)));      /* 1 - vh, below 0 by rounding alone */
    vf c5 = pow5(c), a = 1.0f - c5, b = s.f90 * c5;
    return (vf3){ vf_mad(s.f0.x, a, b), vf_mad(s.f0.y, a, b), vf_mad(s.f0.z, a, b) };
}

#endif
