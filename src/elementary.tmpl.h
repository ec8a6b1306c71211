/* Elementary functions over the vector layer that was included before (arch/NAME.h): no libm, and in the strict tier
 * the same bytes everywhere. tests/elementary.sollya derives the coefficients and certifies what polynomials lose; that
 * and all errors are in units of 2^-24 of the exact result, where nothing else is said.
 * NAME_WORST, above each function: its bound, and an input that comes within 2 % of it: { where vf_mad rounds once },
 * { where it rounds twice }. tests/elementary.c measures them, at every float where there is one variable. */
#ifndef FACET_ELEMENTARY_TMPL_H
#define FACET_ELEMENTARY_TMPL_H

OP vf splat(float a) { return vf_splat(a); }
OP vf square(vf a) { return a * a; }

/* exp(-x), x >= 0, infinity too; 0 where that is below 2^-126, and for a NaN.
 * = 2^-k P(q), k = round(x/ln 2), q = x - k ln 2 in two parts, the first of them exact. A sum with 1.5 2^23 is an
 * integer; with 127 more, its last bits are 127 - k: the exponent of 2^-k.
 * P(q) = 1 - (q - q^2 p(q)) is within 0.064 of exp(-q); what rounds before the last subtraction is small beside 1. */
#define EXP_MINUS_WORST { { 1.40, { 0x1.b60b98p4f } }, { 1.35, { 0x1.4cb544p2f } } }
OP vf exp_minus(vf x)
{
    const float to_integer = 0x1.8000fep23f;
    vf sum = vf_nmad(x, splat(0x1.715476p0f), splat(to_integer)), minus_k = sum - to_integer;
    vf q = vf_mad(minus_k, splat(0x1.7f7d1cp-20f), vf_mad(minus_k, splat(0x1.62e4p-1f), x));
    vf p = splat(0x1.686a4ep-10f);
    p = vf_mad(p, q, splat(-0x1.123cf8p-7f));
    p = vf_mad(p, q, splat(0x1.555b82p-5f));
    p = vf_mad(p, q, splat(-0x1.55548cp-3f));
    p = vf_mad(p, q, splat(0x1.fffff8p-2f));
    p = 1.0f - vf_nmad(p, square(q), q);
    return vf_where(vf_lt(x, splat(0x1.5d58ap6f)), p * vf_shift_left(sum, 23));
}

/* ln(1 + s/c), s >= 0, c >= FLT_MIN, s + c <= 2^126, however small or large s/c.
 * = e ln 2 + 2 atanh(z), z = (s - (2^e c - c))/(s + (2^e c + c)): no sum with 1 that loses s, and where e = 0 the
 * numerator is s itself. e, an integer, is found on the bits, such that (c + s)/(2^e c) is in [0.72, 1.63].
 * atanh(z) = z + z^3 P(z^2), within 0.65. For results below FLT_MIN units are 2^-24 FLT_MIN. The worst is that of 10^10
 * pairs, not of all. */
#define LOG1P_RATIO_WORST { { 3.25, { 0x1.00b84p-1f, 0x1.c09476p0f } }, { 3.25, { 0x1.004c6p-1f, 0x1.c01e9ep0f } } }
OP vf log1p_ratio(vf s, vf c)
{
    const float to_float = 0x1p23f, below = 0x1.8p-128f;   /* 3/8 of an octave in bits: at 5/8, e is rounded up */
    vf e = vf_shift_right(vf_bits_minus(s + c, vf_bits_minus(c, splat(below))), 23);
    vf c2e = vf_bits_minus(c, vf_bits_minus(splat(0.0f), vf_shift_left(e, 23)));
    vf z = (s - (c2e - c)) / (s + (c2e + c));
    vf z2 = square(z), twice = z + z;
    vf p = splat(0x1.39119cp-3f);
    p = vf_mad(p, z2, splat(0x1.99279cp-3f));
    p = vf_mad(p, z2, splat(0x1.555584p-2f));
    p = vf_mad(p, z2 * twice, twice);
    return vf_mad(vf_or(e, splat(to_float)) - to_float, splat(0x1.62e43p-1f), p);
}

/* acos(x), x in [0, 1]; what is beyond counts as the nearer end. Exactly 0 at 1.
 * = sqrt(y) P(y), y = 1 - x; P is within 0.29. */
#define ARCCOS_WORST { { 3.06, { 0x1.ed7186p-2f } }, { 3.11, { 0x1.f709d6p-2f } } }
OP vf arccos(vf x)
{
    vf y = vf_min(vf_not_negative(1.0f - x), splat(1.0f));
    vf p = splat(0x1.49abbcp-10f);
    p = vf_mad(p, y, splat(-0x1.19f194p-9f));
    p = vf_mad(p, y, splat(0x1.d280dp-9f));
    p = vf_mad(p, y, splat(0x1.5c1a68p-10f));
    p = vf_mad(p, y, splat(0x1.0efdcap-7f));
    p = vf_mad(p, y, splat(0x1.b19c02p-6f));
    p = vf_mad(p, y, splat(0x1.e2baa2p-4f));
    p = vf_mad(p, y, splat(0x1.6a09e6p0f));
    return vf_sqrt(y) * p;
}

/* g(a) = exp(-a^2)/(2 sqrt(pi)) - a erfc(a)/2, a >= 0, infinity too: half the first repeated integral of erfc. This
 * is where the error function lives: a (1 + erf(a))/2 + exp(-a^2)/(2 sqrt(pi)) = a + g(a), where nothing cancels.
 * = g(0) + a P(a - 7/4), within 1.04, up to a = 7/2; from there on g(7/2), which is below 0.24. Never negative. P is
 * centred: its coefficients are small then. Units are 2^-24 (a + g(a)). */
#define IERFC_HALF_WORST { { 1.90, { 0x1.5620b8p-7f } }, { 1.96, { 0x1.ea9594p-2f } } }
OP vf ierfc_half(vf a)
{
    a = vf_min(a, splat(3.5f));
    vf v = a - 1.75f, p = splat(0x1.961a4cp-21f);
    p = vf_mad(p, v, splat(-0x1.08a562p-18f));
    p = vf_mad(p, v, splat(-0x1.ff5d62p-19f));
    p = vf_mad(p, v, splat(0x1.e284bp-15f));
    p = vf_mad(p, v, splat(-0x1.62a668p-14f));
    p = vf_mad(p, v, splat(-0x1.fab17ep-13f));
    p = vf_mad(p, v, splat(0x1.1fa5bap-10f));
    p = vf_mad(p, v, splat(-0x1.637722p-10f));
    p = vf_mad(p, v, splat(-0x1.42ad12p-9f));
    p = vf_mad(p, v, splat(0x1.fe375ep-7f));
    p = vf_mad(p, v, splat(-0x1.5d40e4p-5f));
    p = vf_mad(p, v, splat(0x1.67a53ap-4f));
    p = vf_mad(p, v, splat(-0x1.4856ep-3f));
    return vf_not_negative(vf_mad(p, a, splat(0x1.20dd76p-2f)));
}

#endif
