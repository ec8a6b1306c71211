/* Exact Fresnel terms as rational functions of the cosine, by least squares; and how far off they are.
 *
 * Why degree 4 over 4: sqrt(n^2 - sin^2) changes little over the hemisphere, the less the larger |n|. With n in its
 * place F is exactly such a rational, with the denominator |c + n|^2 |n c + 1|^2. What that leaves, the fit takes. */
#include "internal.h"

/* Cosines where the error is measured, and those of them where it is made small; unknowns are p, then q. */
enum { POINTS = 128, STEP = 4, NODES = POINTS / STEP, UNKNOWNS = 2 * FIT_DEGREE, ROWS = NODES + FIT_DEGREE };

#define ROUNDING 0x1p-24     /* of one float operation, relative */
#define BETWEEN  1.05        /* the error between points over that at them: of accepted fits, 1.011 was found */

/* Within 2^-48: the error of the float root, squared. Some FPUs have no root of a double. */
static double root(double x)
{
    const double r = (double)__builtin_sqrtf((float)x);
    return r > 0.0 ? 0.5 * (r + x / r) : 0.0;
}

static double absolute(double x) { return x < 0.0 ? -x : x; }

/* Born and Wolf, ch. 14: conductor in models.tmpl.h, with n and k relative to the medium outside. a - c may cancel
 * here: where it loses much, n is so near to 1 that there is no fit. */
static double reflectance(double n, double k, double parallel, double c)
{
    const double sin2 = (1.0 - c) * (1.0 + c), t = n * n - k * k - sin2, nk2 = n * n * k * k;
    const double larger = 0.5 * (root(t * t + 4.0 * nk2) + absolute(t)), smaller = larger > 0.0 ? nk2 / larger : 0.0;
    const double a = root(t > 0.0 ? larger : smaller), b2 = t > 0.0 ? smaller : larger, bc2 = b2 * c * c;
    const double Rs = ((a - c) * (a - c) + b2) / ((a + c) * (a + c) + b2), minus = a * c - sin2, plus = a * c + sin2;
    return Rs * (1.0 - parallel + parallel * (minus * minus + bc2) / (plus * plus + bc2));
}

/* F at the points, which go from 0 to 1. They are as dense at both ends as Chebyshev's, and half of them lie below
 * about 1/|n|, where F is least. */
typedef struct { double c[POINTS + 1], F[POINTS + 1]; } curve;

static void sample(double n, double k, double parallel, curve *at)
{
    const double scale = 4.0 / root(n * n + k * k);
    for (int i = 0; i <= POINTS; i++) {
        const double t = (double)i / (double)POINTS, u = t * t * (3.0 - 2.0 * t);
        at->c[i] = scale * u / (1.0 + scale - u);
        at->F[i] = reflectance(n, k, parallel, at->c[i]);
    }
}

/* The denominator of large |n|: q of |c + n|^2 |n c + 1|^2/|n|^2. */
static void limit(double n, double k, double *q)
{
    const double m = n * n + k * k;
    q[0] = q[2] = 2.0 * n * (1.0 + m) / m;
    q[1] = (m * m + 4.0 * n * n + 1.0) / m;
    q[3] = 1.0;
}

static double polynomial(const double *a, double c)
{
    double s = 0.0;
    for (int j = FIT_DEGREE - 1; j >= 0; j--) s = s * c + a[j];
    return 1.0 + s * c;
}

static double product(const double *a, const double *b)
{
    double sum = 0.0;
    for (int i = 0; i < ROWS; i++) sum += a[i] * b[i];
    return sum;
}

/* Least squares by modified Gram and Schmidt: the columns are the unknowns', then the right-hand side. */
static void solve(double (*column)[ROWS], double *x)
{
    double r[UNKNOWNS][UNKNOWNS + 1];
    for (int j = 0; j < UNKNOWNS; j++) {
        r[j][j] = root(product(column[j], column[j]));
        for (int i = 0; i < ROWS; i++) column[j][i] /= r[j][j];
        for (int k = j + 1; k <= UNKNOWNS; k++) {
            r[j][k] = product(column[j], column[k]);
            for (int i = 0; i < ROWS; i++) column[k][i] -= r[j][k] * column[j][i];
        }
    }
    for (int j = UNKNOWNS - 1; j >= 0; j--) {
        x[j] = r[j][UNKNOWNS];
        for (int k = j + 1; k < UNKNOWNS; k++) x[j] -= r[j][k] * x[k];
        x[j] /= r[j][j];
    }
}

/* Minimises the sum over the nodes of ((P - F Q)/(F Q'))^2, Q' a guess at Q: the relative error squared, but for Q/Q'.
 * Where P and Q nearly have a common factor that is free, `ridge` keeps q near to that of large |n|. */
static void improve(const curve *at, const double *q_large, double ridge, const double *q_guess, double *x)
{
    double column[UNKNOWNS + 1][ROWS];
    for (int i = 0; i < NODES; i++) {
        const double c = at->c[i * STEP + STEP / 2], F = at->F[i * STEP + STEP / 2];
        const double weight = 1.0 / (F * polynomial(q_guess, c));
        column[UNKNOWNS][i] = weight * (F - 1.0);
        for (int j = 0; j < FIT_DEGREE; j++) {
            const double above = j ? column[j - 1][i] : weight;
            column[j][i] = above * c;
            column[FIT_DEGREE + j][i] = -column[j][i] * F;
        }
    }
    for (int j = 0; j < FIT_DEGREE; j++) {
        for (int k = 0; k < UNKNOWNS; k++) column[k][NODES + j] = 0.0;
        column[FIT_DEGREE + j][NODES + j] = ridge / q_large[j];
        column[UNKNOWNS][NODES + j] = ridge;
    }
    solve(column, x);
}

/* What float arithmetic makes of a polynomial, at most `off` from `value`; of a0 + a1 c + ..., and of 1 + c times it.
 * Each multiplication and each addition rounds. */
typedef struct { double value, off; } estimate;

static estimate step(estimate s, double c, double a)
{
    const double product = s.value * c, sum = product + a;
    return (estimate){ sum, s.off * c + ROUNDING * (absolute(product) + absolute(sum)) };
}

static estimate inner(const float *a, double c)
{
    estimate s = { (double)a[FIT_DEGREE - 1], 0.0 };
    for (int j = FIT_DEGREE - 2; j >= 0; j--) s = step(s, c, (double)a[j]);
    return s;
}

/* A bound of the fit's relative error, or infinity: where Q may have a zero, or P may exceed it. Q with two zeros
 * between two points would be so small there that its rounding error counts as more than any limit. */
static double bound(const fresnel_fit *fit, const curve *at)
{
    double worst = 0.0;
    for (int i = 0; i <= POINTS; i++) {
        const double c = at->c[i];
        const estimate p = inner(fit->p, c), q = inner(fit->q, c), P = step(p, c, 1.0), Q = step(q, c, 1.0);
        const double rounding = P.off / P.value + Q.off / Q.value + ROUNDING;
        const double error = BETWEEN * absolute(P.value / (Q.value * at->F[i]) - 1.0) + rounding;
        const bool sound = P.value > 0.0 && Q.value > 0.0 && q.value - p.value >= p.off + q.off;
        if (!(sound && error <= 1.0)) return (double)__builtin_inff();
        if (error > worst) worst = error;
    }
    return worst;
}

float facet_fit_fresnel(fresnel_fit *fit, float eta, float k, float outside, float polarisation)
{
    static const double ridges[] = { 1e-8, 1e-6 };
    const double n = (double)eta / (double)outside, extinction = (double)k / (double)outside;
    const double parallel = 0.5 + 0.5 * (double)polarisation;
    double q[FIT_DEGREE], x[UNKNOWNS], error = 1.0;
    curve at;
    if (!(FACET_HAS(dielectric) || FACET_HAS(conductor))) return __builtin_inff();
    sample(n, extinction, parallel, &at);
    limit(n, extinction, q);
    for (int i = 0; i < 2 && !(error <= (double)FIT_LIMIT); i++) {
        improve(&at, q, ridges[i], q, x);
        improve(&at, q, ridges[i], x + FIT_DEGREE, x);
        for (int j = 0; j < FIT_DEGREE; j++) {
            fit->p[j] = (float)x[j];
            fit->q[j] = (float)x[FIT_DEGREE + j];
        }
        error = bound(fit, &at);
    }
    return error <= (double)FIT_LIMIT ? (float)error : __builtin_inff();
}
