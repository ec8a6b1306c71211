/* Conversions: each against its formula in double, over its domain and beyond it; the two conventions of artists' tools
 * there and back; the same bytes everywhere. */
#include "bits.h"
#include "harness.h"
#include "samples.h"

#include "facet.h"

#include <float.h>
#include <inttypes.h>
#include <math.h>
#include <string.h>

static double clamped(double x, double least, double most) { return fmin(fmax(x, least), most); }

/* ---- Functions of one number ------------------------------------------------------------------------------------- */

static double eta_from_f0(double f0) { return fmin((1 + sqrt(f0)) * (1 + sqrt(f0)) / (1 - f0), FACET_ETA_CAP); }
static double alpha_from_roughness(double roughness) { return roughness * roughness; }
static double roughness_from_alpha(double alpha) { return sqrt(alpha); }
static double exponent_from_alpha(double alpha)
{
    return clamped(2 / (alpha * alpha) - 2, FACET_EXPONENT_MIN, FACET_EXPONENT_MAX);
}
static double alpha_from_exponent(double exponent) { return sqrt(2 / (exponent + 2)); }

/* `bound`, in units of 2^-24, holds for every float; `worst` is the one that comes nearest to it. */
typedef struct {
    const char *name;
    float (*function)(float);
    double (*formula)(double);
    float least, most;           /* the domain */
    double bound;
    float worst;
} curve;

static const curve curves[] = {
    { "facet_eta_from_f0", facet_eta_from_f0, eta_from_f0, 0, 1, 4, 0x1.002004p-24f },
    { "facet_alpha_from_roughness", facet_alpha_from_roughness, alpha_from_roughness, 0, 1, 1, 0x1.6a11aap-1f },
    { "facet_roughness_from_alpha", facet_roughness_from_alpha, roughness_from_alpha, 0, 1, 1, 0x1.000002p-2f },
    { "facet_exponent_from_alpha", facet_exponent_from_alpha, exponent_from_alpha, FACET_ALPHA_FLOOR, 1, 3,
      0x1.692abep-1f },
    { "facet_alpha_from_exponent", facet_alpha_from_exponent, alpha_from_exponent, FACET_EXPONENT_MIN,
      FACET_EXPONENT_MAX, 1.6, 0x1.fe5042p+1f },
};
enum { CURVES = sizeof curves / sizeof curves[0] };

/* In units of 2^-24, less what underflow costs. */
static double relative_error(float got, double want)
{
    return fmax(0, fabs(got - want) - 0x1p-150) / want * 0x1p24;
}

static void check_curve(const curve *c)
{
    const uint32_t least = to_bits(c->least), most = to_bits(c->most), step = test_slow_machine ? 100003 : 997;
    test("%s within %g 2^-24, at every %uth float", c->name, c->bound, step);
    for (uint32_t bits = most; bits - least <= most - least; bits -= step) {
        const float x = from_bits(bits), got = c->function(x);
        const double want = c->formula(x);
        if (want == 0) expect(got == 0, "%a is %a, not 0", (double)x, (double)got);
        else expect(relative_error(got, want) <= c->bound, "%a is %a, not %a", (double)x, (double)got, want);
    }
    const double reached = relative_error(c->function(c->worst), c->formula(c->worst)) / c->bound;
    expect(reached <= 1 && reached >= 0.9, "%a reaches %.3f of it", (double)c->worst, reached);
}

/* What is outside the domain gives what its nearest end gives, NaN what the lower end does. */
static void check_beyond(const curve *c)
{
    static const uint32_t nans[] = { 0x7fc00000, 0xffc00000, 0x7f800001, 0xffbfffff };
    const float at_least = c->function(c->least), at_most = c->function(c->most);
    test("%s beyond its domain", c->name);
    for (int i = 0; i < 4; i++)
        expect(to_bits(c->function(from_bits(nans[i]))) == to_bits(at_least), "NaN %" PRIx32 " is not as %a", nans[i],
               (double)c->least);
    for (int i = -2; i < edge_count; i++) {
        const float x = i < 0 ? (i < -1 ? INFINITY : -INFINITY) : edge_values[i], got = c->function(x);
        if (x <= c->least) expect(to_bits(got) == to_bits(at_least), "%a is %a", (double)x, (double)got);
        if (x >= c->most) expect(to_bits(got) == to_bits(at_most), "%a is %a", (double)x, (double)got);
    }
}

static void check_published(void)
{
    static const struct { float eta, f0; } dielectrics[] = { { 1.333f, 0.02f }, { 1.5f, 0.04f }, { 2.42f, 0.17f } };
    test("water reflects 0.02, glass 0.04, diamond 0.17");
    for (int i = 0; i < 3; i++) {
        const float f0 = facet_f0_from_eta(dielectrics[i].eta, 0, 0);
        expect(fabsf(f0 - dielectrics[i].f0) < 0.005f, "%g reflects %g", (double)dielectrics[i].eta, (double)f0);
        expect(fabsf(facet_eta_from_f0(f0) - dielectrics[i].eta) < 1e-6f, "and %g is of %g", (double)f0,
               (double)facet_eta_from_f0(f0));
    }
    test("values that are exact");
    expect(facet_eta_from_f0(0.25f) == 3 && facet_eta_from_f0(0) == 1 && facet_eta_from_f0(1) == FACET_ETA_CAP,
           "eta of 0, 1/4 or 1");
    expect(facet_f0_from_eta(3, 0, 1) == 0.25f && facet_f0_from_eta(1, 2, 0) == 0.5f, "f0 of 3 or of 1 + 2i");
    expect(facet_alpha_from_roughness(0.5f) == 0.25f && facet_roughness_from_alpha(0.25f) == 0.5f, "roughness of 1/4");
    expect(facet_exponent_from_alpha(0.5f) == 6 && facet_alpha_from_exponent(6) == 0.5f, "exponent of 1/2");
    expect(facet_exponent_from_alpha(1) == FACET_EXPONENT_MIN && facet_exponent_from_alpha(0) == FACET_EXPONENT_MAX,
           "exponents beyond their range");
}

/* The worst relative error of `back` after `there`, between these floats. */
static double worst_round_trip(const curve *there, const curve *back, float least, float most)
{
    double worst = 0;
    for (uint32_t bits = to_bits(least); bits <= to_bits(most); bits += test_slow_machine ? 100003 : 997) {
        const float x = from_bits(bits);
        worst = fmax(worst, fabs(back->function(there->function(x)) - (double)x) / x);
    }
    return worst * 0x1p24;
}

static void check_round_trips(void)
{
    const curve *alpha_of_roughness = &curves[1], *roughness_of_alpha = &curves[2];
    const curve *exponent_of_alpha = &curves[3], *alpha_of_exponent = &curves[4];
    test("round trips");
    double worst = worst_round_trip(alpha_of_roughness, roughness_of_alpha, 1e-18f, 1);
    expect(worst == 0, "roughness by alpha: %g 2^-24", worst);
    worst = worst_round_trip(roughness_of_alpha, alpha_of_roughness, FLT_MIN, 1);
    expect(worst <= 2, "alpha by roughness: %g 2^-24", worst);
    worst = worst_round_trip(exponent_of_alpha, alpha_of_exponent, 0.01415f, 0.8164f);
    expect(worst <= 2.5, "alpha by exponent: %g 2^-24", worst);
    worst = worst_round_trip(alpha_of_exponent, exponent_of_alpha, FACET_EXPONENT_MIN, FACET_EXPONENT_MAX);
    expect(worst <= 10, "exponent by alpha: %g 2^-24", worst);
    for (float f0 = 0; f0 < 0.995f; f0 += 0x1p-12f) {
        const float back = facet_f0_from_eta(facet_eta_from_f0(f0), 0, 0);
        expect(fabsf(back - f0) < 3e-7f, "f0 by eta: %a is %a", (double)f0, (double)back);
    }
}

/* ---- facet_f0_from_eta ------------------------------------------------------------------------------------------- */

static double f0_from_eta(double eta, double k, double outside)
{
    eta = clamped(eta, FACET_ETA_FLOOR, FACET_ETA_CAP);
    k = clamped(k, 0, FACET_ETA_CAP);
    outside = outside == 0 ? 1 : clamped(outside, FACET_ETA_FLOOR, FACET_ETA_CAP);
    return ((eta - outside) * (eta - outside) + k * k) / ((eta + outside) * (eta + outside) + k * k);
}

/* In units of 9 2^-24; infinite where it is no reflectance. */
static double f0_error(const float *in)
{
    const double want = f0_from_eta(in[0], in[1], in[2]), tiny = 2e-40;
    const float got = facet_f0_from_eta(in[0], in[1], in[2]);
    if (!(got >= 0 && got <= 1)) return INFINITY;
    return fmax(0, fabs(got - want) - tiny) / fmax(want, tiny) / (9 * 0x1p-24);
}

static void check_f0_bound(void)
{
    static const float worst[] = { 0x1.03f68p+7f, 0x1.8810fap+2f, 0x1.de718p+0f };
    const int count = test_slow_machine ? 20000 : 1000000;
    test_random r = { 31 };
    test("facet_f0_from_eta within 9 2^-24, at %d random indices", count);
    for (int i = 0; i < count; i++) {
        float in[3];
        for (int c = 0; c < 3; c++) in[c] = (float)pow(10, 6 * random_unit(&r) - 3);
        if (i % 4 == 1) in[0] = in[2] * (float)(1 + pow(10, -7 * random_unit(&r)));
        if (i % 4 == 2) in[1] = fabsf(in[0] - in[2]) * (float)random_unit(&r);
        if (i % 8 < 2) in[1] = (float)pow(10, -45 * random_unit(&r));
        expect(f0_error(in) <= 1, "%a, %a, %a: %.3f of it", (double)in[0], (double)in[1], (double)in[2], f0_error(in));
    }
    const double reached = f0_error(worst);
    expect(reached <= 1 && reached >= 0.85, "the worst found reaches %.3f of it", reached);
}

static void check_f0_edges(void)
{
    const float one = facet_f0_from_eta(1.5f, 0.1f, 1);
    test("facet_f0_from_eta at edges, equal media and defaults");
    for (int i = 0; i < edge_count; i++)
        for (int j = 0; j < edge_count; j++)
            for (int k = 0; k < edge_count; k++) {
                const float in[] = { edge_values[i], edge_values[j], edge_values[k] };
                expect(f0_error(in) <= 1, "%a, %a, %a is %a", (double)in[0], (double)in[1], (double)in[2],
                       (double)facet_f0_from_eta(in[0], in[1], in[2]));
            }
    expect(facet_f0_from_eta(1.5f, 0.1f, 0) == one && facet_f0_from_eta(1.5f, 0.1f, -0.0f) == one,
           "an eta_outside of 0 is not 1");
    expect(facet_f0_from_eta(1.3f, 0, 1.3f) == 0, "equal media reflect");
    expect(facet_f0_from_eta(1.5f, 0, 1.2f) == facet_f0_from_eta(1.2f, 0, 1.5f), "from within is not as from without");
    expect(facet_f0_from_eta(NAN, 0.5f, 1) == facet_f0_from_eta(FACET_ETA_FLOOR, 0.5f, 1)
           && facet_f0_from_eta(1.5f, NAN, 1) == facet_f0_from_eta(1.5f, 0, 1)
           && facet_f0_from_eta(1.5f, 1, NAN) == facet_f0_from_eta(1.5f, 1, FACET_ETA_FLOOR),
           "NaN is not the lower end");
}

/* ---- The two conventions ----------------------------------------------------------------------------------------- */

static float random_float(test_random *r) { return (float)random_unit(r); }

/* Near 0, near 1, or between. */
static float random_part(test_random *r)
{
    const float near = (float)pow(10, -7 * random_unit(r));
    switch (random_u64(r) % 4) {
    case 0: return near;
    case 1: return 1 - near;
    default: return random_float(r);
    }
}

static facet_metallic_roughness random_metallic(test_random *r)
{
    facet_metallic_roughness m = { .metallic = random_part(r), .roughness = random_part(r),
                                   .specular_level = random_part(r) };
    const bool grey = random_u64(r) % 4 == 0;
    for (int c = 0; c < 3; c++) m.base[c] = grey && c ? m.base[0] : random_part(r);
    return m;
}

static bool in_range(float x) { return x >= 0 && x <= 1; }

static bool metallic_in_range(const facet_metallic_roughness *m)
{
    return in_range(m->base[0]) && in_range(m->base[1]) && in_range(m->base[2]) && in_range(m->metallic)
        && in_range(m->roughness) && in_range(m->specular_level);
}

static bool specular_in_range(const facet_specular_glossiness *s)
{
    return in_range(s->diffuse[0]) && in_range(s->diffuse[1]) && in_range(s->diffuse[2]) && in_range(s->specular[0])
        && in_range(s->specular[1]) && in_range(s->specular[2]) && in_range(s->glossiness);
}

static double error_of_part(float got, double want)
{
    return want > 0 ? relative_error(got, want) : got == 0 ? 0 : INFINITY;
}

static void check_to_specular(void)
{
    test_random r = { 32 };
    double worst_diffuse = 0, worst_specular = 0;
    test("facet_to_specular_glossiness: diffuse within 2 2^-24, specular within 4.5 2^-24");
    for (int i = 0; i < 200000; i++) {
        const facet_metallic_roughness m = random_metallic(&r);
        const facet_specular_glossiness s = facet_to_specular_glossiness(m);
        const double level = 0.08 * m.specular_level, metallic = m.metallic;
        expect(s.glossiness == 1 - m.roughness && specular_in_range(&s), "glossiness, or range");
        for (int c = 0; c < 3; c++) {
            const double diffuse = m.base[c] * (1 - metallic);
            const double specular = level + (m.base[c] - level) * metallic;
            worst_diffuse = fmax(worst_diffuse, error_of_part(s.diffuse[c], diffuse));
            worst_specular = fmax(worst_specular, error_of_part(s.specular[c], specular));
        }
    }
    expect(worst_diffuse <= 2 && worst_diffuse >= 1.6, "diffuse %g", worst_diffuse);
    expect(worst_specular <= 4.5 && worst_specular >= 3, "specular %g", worst_specular);
}

/* The largest difference of two specular-glossinesses. */
static double difference(const facet_specular_glossiness *a, const facet_specular_glossiness *b)
{
    double most = fabs((double)a->glossiness - b->glossiness);
    for (int c = 0; c < 3; c++)
        most = fmax(most, fmax(fabs((double)a->diffuse[c] - b->diffuse[c]),
                               fabs((double)a->specular[c] - b->specular[c])));
    return most;
}

/* How far the fit is from what this metallic-roughness stands for; infinite where it is out of range. */
static double fit_error(facet_metallic_roughness m)
{
    const facet_specular_glossiness want = facet_to_specular_glossiness(m);
    const facet_metallic_roughness fit = facet_to_metallic_roughness(want);
    const facet_specular_glossiness got = facet_to_specular_glossiness(fit);
    return metallic_in_range(&fit) ? difference(&got, &want) : INFINITY;
}

static void check_exact_fits(void)
{
    static const facet_metallic_roughness worst[] = {
        { { 0x1.3fa3c6p-4f, 0x1.3f7a7ap-4f, 0x1.3fa596p-4f }, 0x1.fd54b6p-2f, 0, 0x1.fffff2p-1f },
        { { 0x1.4afcbap-5f, 0x1.4b3936p-5f, 0x1.4b3936p-5f }, 0x1.28e474p-12f, 0, 0x1.fffffep-1f },
    };
    const int count = test_slow_machine ? 20000 : 500000;
    test_random r = { 33 };
    test("%d that have an exact metallic-roughness: the fit is within 1e-5; the worst found, 6e-6", count);
    for (int i = 0; i < count; i++) {
        const facet_metallic_roughness m = random_metallic(&r);
        expect(fit_error(m) <= 1e-5, "off by %g: base %a %a %a, metallic %a, level %a", fit_error(m), (double)m.base[0],
               (double)m.base[1], (double)m.base[2], (double)m.metallic, (double)m.specular_level);
    }
    for (int i = 0; i < 2; i++) expect(fit_error(worst[i]) <= 6e-6, "number %d: %g", i, fit_error(worst[i]));
    expect(fit_error(worst[0]) >= 5e-6, "the worst is off by %g alone", fit_error(worst[0]));
}

/* Where the channels differ clearly, there is one only. */
static void check_coloured_fits(void)
{
    test_random r = { 34 };
    test("of a coloured diffuse the fit is what it came from");
    for (int i = 0; i < 50000; i++) {
        facet_metallic_roughness m = { .metallic = 0.9f * random_float(&r), .specular_level = random_float(&r) };
        m.base[0] = random_float(&r);
        m.base[1] = m.base[0] < 0.5f ? m.base[0] + 0.4f : m.base[0] - 0.4f;
        m.base[2] = random_float(&r);
        const facet_metallic_roughness fit = facet_to_metallic_roughness(facet_to_specular_glossiness(m));
        expect(fabsf(fit.metallic - m.metallic) <= 1e-5f, "metallic %a for %a", (double)fit.metallic,
               (double)m.metallic);
        expect(fabsf(fit.specular_level - m.specular_level) <= 1e-3f, "level %a for %a", (double)fit.specular_level,
               (double)m.specular_level);
        for (int c = 0; c < 3; c++)
            expect(fabsf(fit.base[c] - m.base[c]) <= 1e-4f, "base %a for %a", (double)fit.base[c], (double)m.base[c]);
    }
}

/* Of greys, and where a colour is missing: what facet.h says. */
static void check_fits_by_kind(void)
{
#define ALL(x) { x, x, x }
    static const struct { const char *what; facet_specular_glossiness given; facet_metallic_roughness want; } rows[] = {
        { "nothing", { ALL(0), ALL(0), 1 }, { ALL(0), 0, 0, 0 } },
        { "plastic", { ALL(0.5f), ALL(0.04f), 0.25f }, { ALL(0.5f), 0, 0.75f, 0.5f } },
        { "red plastic", { { 0.5f, 0.1f, 0 }, ALL(0.04f), 0 }, { { 0.5f, 0.1f, 0 }, 0, 1, 0.5f } },
        { "red ruby", { { 0.5f, 0.1f, 0 }, ALL(0.08f), 0 }, { { 0.5f, 0.1f, 0 }, 0, 1, 1 } },
        { "white", { ALL(1), ALL(0.04f), 0 }, { ALL(1), 0, 1, 0.5f } },
        { "without specular", { ALL(0.25f), ALL(0), 0 }, { ALL(0.25f), 0, 1, 0 } },
        { "below half", { ALL(0.25f), ALL(0.02f), 0 }, { ALL(0.25f), 0, 1, 0.25f } },
        { "black, water", { ALL(0), ALL(0.02f), 0 }, { ALL(0), 0, 1, 0.25f } },
        { "black, sapphire", { ALL(0), ALL(0.08f), 0 }, { ALL(0), 0, 1, 1 } },
        { "black, above", { ALL(0), ALL(0.5f), 0 }, { ALL(0.5f), 1, 1, 0.5f } },
        { "gold", { ALL(0), { 1, 0.75f, 0.375f }, 0 }, { { 1, 0.75f, 0.375f }, 1, 1, 0.5f } },
        { "dark, coloured", { ALL(0), { 0.0625f, 0.03125f, 0 }, 0 }, { { 0.0625f, 0.03125f, 0 }, 1, 1, 0.5f } },
        { "mirror", { ALL(0), ALL(1), 1 }, { ALL(1), 1, 0, 0.5f } },
        { "out of range", { { NAN, -1, 2 }, { -INFINITY, NAN, -NAN }, NAN }, { { 0, 0, 1 }, 0, 1, 0 } },
    };
#undef ALL
    test("fits of a grey, of black, of a metal");
    for (size_t i = 0; i < sizeof rows / sizeof rows[0]; i++) {
        const facet_metallic_roughness got = facet_to_metallic_roughness(rows[i].given), want = rows[i].want;
        expect(!memcmp(&got, &want, sizeof got), "%s: base %a %a %a, metallic %a, roughness %a, level %a", rows[i].what,
               (double)got.base[0], (double)got.base[1], (double)got.base[2], (double)got.metallic,
               (double)got.roughness, (double)got.specular_level);
    }
}

static void check_grey_fits(void)
{
    test_random r = { 35 };
    test("of a grey diffuse the fit is that of specular_level 0.5, or the least above it that has a base");
    for (int i = 0; i < 100000; i++) {
        facet_specular_glossiness s = { .glossiness = 0.5f };
        const float diffuse = 0.05f + 0.9f * random_float(&r), specular = 0.041f + (0.95f - diffuse) * random_float(&r);
        for (int c = 0; c < 3; c++) s.diffuse[c] = diffuse, s.specular[c] = specular;
        const facet_metallic_roughness fit = facet_to_metallic_roughness(s);
        const facet_specular_glossiness back = facet_to_specular_glossiness(fit);
        expect(difference(&s, &back) <= 1e-6, "diffuse %a, specular %a: off by %g", (double)diffuse, (double)specular,
               difference(&s, &back));
        expect(fit.specular_level == 0.5f || (fit.specular_level > 0.5f && fit.base[0] > 0.999999f),
               "diffuse %a, specular %a: level %a with base %a", (double)diffuse, (double)specular,
               (double)fit.specular_level, (double)fit.base[0]);
    }
}

/* Root of the mean of the squares over both colours, of the best base for this metallic and level. */
static double distance_of(const facet_specular_glossiness *s, double metallic, double level)
{
    const double rest = 1 - metallic, dielectric = 0.08 * level * rest;
    double sum = 0;
    for (int c = 0; c < 3; c++) {
        const double along = s->diffuse[c] * rest + (s->specular[c] - dielectric) * metallic;
        const double base = clamped(along / (rest * rest + metallic * metallic), 0, 1);
        sum += pow(base * rest - s->diffuse[c], 2) + pow(base * metallic + dielectric - s->specular[c], 2);
    }
    return sqrt(sum / 6);
}

static void check_other_fits(void)
{
    const int steps = 32, count = test_slow_machine ? 300 : 10000;
    test_random r = { 36 };
    double worst = 0;
    test("%d of any colours: no metallic and level comes nearer than the fit does by more than 0.05", count);
    for (int i = 0; i < count; i++) {
        facet_specular_glossiness s = { .glossiness = 0 };
        double least = INFINITY;
        for (int c = 0; c < 3; c++) {
            s.diffuse[c] = c && i % 4 == 1 ? s.diffuse[0] : random_float(&r);
            s.specular[c] = c && i % 4 < 2 ? s.specular[0] : random_float(&r);
        }
        for (int m = 0; m <= steps; m++)
            for (int level = 0; level <= 2; level++)
                least = fmin(least, distance_of(&s, (double)m / steps, level / 2.0));
        const facet_metallic_roughness fit = facet_to_metallic_roughness(s);
        expect(metallic_in_range(&fit), "out of range");
        worst = fmax(worst, distance_of(&s, fit.metallic, fit.specular_level) - least);
    }
    expect(worst <= 0.05, "by %g", worst);
}

/* ---- The same bytes ---------------------------------------------------------------------------------------------- */

enum { INPUTS = 4096, RESULTS = CURVES + 1 + 7 + 6 };

typedef struct { float of[INPUTS][RESULTS]; } results;

/* Any bits as a float; half of them in [0, 1]. */
static float any_float(test_random *r)
{
    const uint64_t u = random_u64(r);
    return from_bits(u & 1 ? (uint32_t)(u >> 32) : 0x30000000 + (uint32_t)(u >> 32) % 0x0f800001);
}

static void compute(results *to)
{
    test_random r = { 37 };
    for (int i = 0; i < INPUTS; i++) {
        float in[7], *out = to->of[i];
        for (int k = 0; k < 7; k++) in[k] = any_float(&r);
        for (int k = 0; k < CURVES; k++) *out++ = curves[k].function(in[k]);
        *out++ = facet_f0_from_eta(in[0], in[1], in[2]);
        const facet_metallic_roughness m = { { in[0], in[1], in[2] }, in[3], in[4], in[5] };
        const facet_specular_glossiness s = { { in[0], in[1], in[2] }, { in[3], in[4], in[5] }, in[6] };
        const facet_specular_glossiness to_specular = facet_to_specular_glossiness(m);
        const facet_metallic_roughness to_metallic = facet_to_metallic_roughness(s);
        memcpy(out, &to_specular, sizeof to_specular);
        memcpy(out + 7, &to_metallic, sizeof to_metallic);
    }
}

static uint64_t hash_of(const results *of)
{
    uint64_t hash = 0xcbf29ce484222325u;
    for (int i = 0; i < INPUTS; i++)
        for (int k = 0; k < RESULTS; k++) hash = (hash ^ to_bits(of->of[i][k])) * 0x100000001b3u;
    return hash;
}

static void check_bytes(void)
{
    static results all;
    const uint64_t committed = 0xeb774493a92e7ca3;
    compute(&all);
    test("any floats: finite, the structs in [0, 1], the same bytes everywhere");
    for (int i = 0; i < INPUTS; i++)
        for (int k = 0; k < RESULTS; k++)
            expect(k <= CURVES ? isfinite(all.of[i][k]) : in_range(all.of[i][k]), "result %d is %a", k,
                   (double)all.of[i][k]);
    expect(hash_of(&all) == committed, "their hash is %#" PRIx64, hash_of(&all));
}

void suite_conversions(void)
{
    for (int i = 0; i < CURVES; i++) check_curve(&curves[i]);
    for (int i = 0; i < CURVES; i++) check_beyond(&curves[i]);
    check_published();
    check_round_trips();
    check_f0_bound();
    check_f0_edges();
    check_to_specular();
    check_exact_fits();
    check_coloured_fits();
    check_fits_by_kind();
    check_grey_fits();
    check_other_fits();
    check_bytes();
}
