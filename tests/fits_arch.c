/* One architecture's fitted Fresnel terms in one tier. The Makefile compiles this file once for each, with
 * FACET_ARCH_HEADER and FACET_STRICT as for a kernel, and FITS_FUNCTION: the function's name. */
#include FACET_ARCH_HEADER

#include "fit.tmpl.h"
#include "fits.h"

extern fits_function FITS_FUNCTION;

void FITS_FUNCTION(const fresnel_fit *fit, const float *c, float *out, size_t count)
{
    for (size_t i = 0; i < count; i += VF_LANES) vf_store(out + i, fitted(fit, vf_load(c + i)));
}
