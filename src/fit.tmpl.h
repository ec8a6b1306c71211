/* Fitted Fresnel terms, once for every architecture and tier, over the vector layer that was included before. */
#ifndef FACET_FIT_TMPL_H
#define FACET_FIT_TMPL_H

#include "elementary.tmpl.h"
#include "fit.h"

/* 1 + a0 c + a1 c^2 + a2 c^3 + a3 c^4. The bound of fit.c counts two roundings in each vf_mad. */
OP vf fit_polynomial(const float *a, vf c)
{
    vf s = vf_mad(splat(a[3]), c, splat(a[2]));
    s = vf_mad(s, c, splat(a[1]));
    s = vf_mad(s, c, splat(a[0]));
    return vf_mad(s, c, splat(1.0f));
}

/* F at c = vh. At most 1 without a clamp: the denominator is no less than the numerator, rounding included. */
OP vf fitted(const fresnel_fit *fit, vf c) { return vf_div(fit_polynomial(fit->p, c), fit_polynomial(fit->q, c)); }

#endif
