/* Exact Fresnel terms as rational functions of the cosine: made once for a plan, evaluated in fit.tmpl.h. */
#ifndef FACET_FIT_H
#define FACET_FIT_H

/* F(c) = (1 + p0 c + p1 c^2 + p2 c^3 + p3 c^4)/(1 + q0 c + q1 c^2 + q2 c^3 + q3 c^4), c = vh in [0, 1]. */
enum { FIT_DEGREE = 4 };
typedef struct fresnel_fit { float p[FIT_DEGREE], q[FIT_DEGREE]; } fresnel_fit;

/* The relative error that a fit may have; else the exact term is evaluated. */
#define FIT_LIMIT 3e-6f

/* Fits the reflectance of index `eta` and extinction `k` in a medium of index `outside` (none is 0, k may be); all in
 * facet.h's domains. Returns a bound of the relative error of what fit.tmpl.h evaluates, at every float c in [0, 1],
 * rounding included; its value there never exceeds 1. Where the bound would be above FIT_LIMIT it is infinite, and
 * `*fit` means nothing. The same bytes everywhere. */
float facet_fit_fresnel(fresnel_fit *fit, float eta, float k, float outside, float polarisation);

#endif
