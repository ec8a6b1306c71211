/* The function of src/fit.tmpl.h over arrays: what fits_arch.c exports and fits.c measures. */
#ifndef FITS_H
#define FITS_H

#include "fit.h"

#include <stddef.h>

/* Of `count` cosines, a multiple of the lanes. */
typedef void fits_function(const fresnel_fit *fit, const float *c, float *out, size_t count);

#endif
