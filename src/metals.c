/* Metals' indices of refraction; and any measured spectrum's, as three bands. */
#include "internal.h"

#include "../arch/environment.h"

static const struct { float eta[3], k[3]; } metals[] = {
#define FACET_METAL(id, name, word, eta_r, eta_g, eta_b, k_r, k_g, k_b, source)                                       \
    [FACET_METAL_##id] = { { eta_r, eta_g, eta_b }, { k_r, k_g, k_b } },
#include "metals.def"
};

enum {
    METAL_ROWS = 0
#define FACET_METAL(...) + 1
#include "metals.def"
};
_Static_assert(sizeof metals / sizeof metals[0] == METAL_ROWS && FACET_METAL_TUNGSTEN + 1 == METAL_ROWS,
               "metals.def lacks a row");

facet_status facet_index_of_metal(facet_metal metal, float eta[3], float k[3])
{
    if ((unsigned)metal >= METAL_ROWS) return FACET_ERROR_ENUM;
    if (!eta || !k) return FACET_ERROR_NULL;
    for (int c = 0; c < 3; c++) {
        eta[c] = metals[metal].eta[c];
        k[c] = metals[metal].k[c];
    }
    return FACET_OK;
}

/* ---- Spectra --------------------------------------------------------------------------------------------------- */

/* In nm: red, green, blue. */
static const struct { double low, high; } bands[3] = { { 620.0, 740.0 }, { 495.0, 570.0 }, { 450.0, 495.0 } };

/* Gauss and Legendre's rule of eight points on [-1, 1]: these and their mirror images. */
static const struct { double at, weight; } gauss[4] = {
    { 0.18343464249564980494, 0.3626837833783619829652 },
    { 0.52553240991632898582, 0.3137066458778872873380 },
    { 0.79666647741362673959, 0.2223810344533744705444 },
    { 0.96028985649753623168, 0.1012285362903762591525 },
};

/* exp(-x^2) for |x| <= 1/2: its series up to x^28, within 2^-52. */
static double bell(double x)
{
    double sum = 1.0;
    for (int i = 14; i > 0; i--) sum = 1.0 - x * x / i * sum;
    return sum;
}

/* The means over a band: integrals of p n and p k over that of p. Terms are positive and n between two rows is linear:
 * the rule's own error is below 1e-14, and the rounded means do not depend on it. */
static void integrate(const float *wavelength, const float *n, const float *k, size_t count, double low, double high,
                      float *eta, float *extinction)
{
    double sum_p = 0.0, sum_n = 0.0, sum_k = 0.0;
    for (size_t i = 1; i < count; i++) {
        const double first = wavelength[i - 1], last = wavelength[i];
        const double from = first > low ? first : low, to = last < high ? last : high;
        for (int j = 0; j < 8 && from < to; j++) {
            const double node = j & 1 ? -gauss[j / 2].at : gauss[j / 2].at;
            const double at = 0.5 * (from + to) + 0.5 * (to - from) * node;
            const double p = (to - from) * gauss[j / 2].weight * bell((at - low) / (high - low) - 0.5);
            const double part = (at - first) / (last - first), rest = (last - at) / (last - first);
            sum_p += p;
            sum_n += p * (rest * n[i - 1] + part * n[i]);
            sum_k += p * (rest * k[i - 1] + part * k[i]);
        }
    }
    *eta = (float)(sum_n / sum_p);
    *extinction = (float)(sum_k / sum_p);
}

/* A row's number fits an int: there are fewer positive floats than that. */
static facet_status check(const float *wavelength, const float *n, const float *k, size_t count, facet_error *error)
{
    if (count < 2) return refuse(error, FACET_ERROR_VALUE, "count", -1);
    for (size_t i = 0; i < count; i++) {
        const float least = i ? wavelength[i - 1] : 0.0f;
        if (!(wavelength[i] > least && finite(wavelength[i])))
            return refuse(error, FACET_ERROR_VALUE, "wavelength", (int)i);
        if (!(n[i] >= 0.0f && finite(n[i]))) return refuse(error, FACET_ERROR_VALUE, "n", (int)i);
        if (!(k[i] >= 0.0f && finite(k[i]))) return refuse(error, FACET_ERROR_VALUE, "k", (int)i);
    }
    if (wavelength[0] > bands[2].low) return refuse(error, FACET_ERROR_VALUE, "wavelength", 0);
    if (wavelength[count - 1] < bands[0].high) return refuse(error, FACET_ERROR_VALUE, "wavelength", (int)count - 1);
    return FACET_OK;
}

/* Not inlined: its arithmetic stays between environment_enter and environment_leave. */
static __attribute__((noinline)) facet_status index_of_spectrum(const float *wavelength, const float *n, const float *k,
                                                                size_t count, float eta[3], float extinction[3],
                                                                facet_error *error)
{
    facet_status status = check(wavelength, n, k, count, error);
    for (int c = 0; c < 3 && !status; c++)
        integrate(wavelength, n, k, count, bands[c].low, bands[c].high, &eta[c], &extinction[c]);
    return status;
}

facet_status facet_index_of_spectrum(const float *wavelength, const float *n, const float *k, size_t count,
                                     float eta[3], float extinction[3], facet_error *error)
{
    refuse(error, FACET_OK, 0, -1);
    if (!wavelength) return refuse(error, FACET_ERROR_NULL, "wavelength", -1);
    if (!n) return refuse(error, FACET_ERROR_NULL, "n", -1);
    if (!k) return refuse(error, FACET_ERROR_NULL, "k", -1);
    if (!eta) return refuse(error, FACET_ERROR_NULL, "eta", -1);
    if (!extinction) return refuse(error, FACET_ERROR_NULL, "extinction", -1);

    environment callers = environment_enter();
    facet_status status = index_of_spectrum(wavelength, n, k, count, eta, extinction, error);
    environment_leave(callers);
    return status;
}
