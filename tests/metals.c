/* Metals' constants, made anew from the measured tables and held against what others print of the same tables; spectra
 * whose means are known. */
#include "bits.h"
#include "errors.h"
#include "harness.h"
#include "spectra.h"

#include "facet.h"

#include <complex.h>
#include <float.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

typedef struct { float eta[3], k[3]; } index_of_metal;

static const struct { facet_metal metal; const char *name, *word, *source; } rows[] = {
#define FACET_METAL(id, name, word, eta_r, eta_g, eta_b, k_r, k_g, k_b, source)                                       \
    { FACET_METAL_##id, #name, word, source },
#include "../src/metals.def"
};
enum { ROWS = sizeof rows / sizeof rows[0] };

static const struct { const char *name; double low, high; } bands[3] = {
    { "red", 620, 740 }, { "green", 495, 570 }, { "blue", 450, 495 },
};

static bool read_table(const char *name, spectrum *s)
{
    char path[4096];
    snprintf(path, sizeof path, "%s/data/metals/%s.csv", test_data, name);
    return expect(read_spectrum(path, s) && s->count > 2, "%s cannot be read", path);
}

static index_of_metal mean_of(const spectrum *s)
{
    index_of_metal m = { { -1, -1, -1 }, { -1, -1, -1 } };
    facet_error error = { .field = "nothing" };
    expect(!facet_index_of_spectrum(s->wavelength, s->n, s->k, s->count, m.eta, m.k, &error), "%s[%d] refused",
           error.field, error.index);
    return m;
}

/* ---- The committed constants ------------------------------------------------------------------------------------- */

static void check_row(int i)
{
    spectrum s;
    index_of_metal committed;
    test("%s is the mean of its table", rows[i].word);
    if (!expect(!facet_index_of_metal(rows[i].metal, committed.eta, committed.k), "refused")) return;
    if (!read_table(rows[i].name, &s)) return;
    const index_of_metal m = mean_of(&s);
    for (int c = 0; c < 3; c++)
        expect(to_bits(m.eta[c]) == to_bits(committed.eta[c]) && to_bits(m.k[c]) == to_bits(committed.k[c]),
               "%s: eta %.9g for %.9g, k %.9g for %.9g; `make metals` writes src/metals.def anew", bands[c].name,
               (double)committed.eta[c], (double)m.eta[c], (double)committed.k[c], (double)m.k[c]);
}

/* "Weaver et al. 1975" is what the table's file calls "J. H. Weaver, ... (1975)". */
static void check_source(int i)
{
    spectrum s;
    char name[64], year[16];
    const char *source = rows[i].source;
    const size_t length = strlen(source);
    test("%s is from %s", rows[i].word, source);
    if (!read_table(rows[i].name, &s) || !expect(length > 4, "no year")) return;
    snprintf(name, sizeof name, "%.*s", (int)strcspn(source, " "), source);
    snprintf(year, sizeof year, "(%s)", source + length - 4);
    expect(strstr(s.source, name) && strstr(s.source, year), "the file says: %s", s.source);
}

static void check_words(void)
{
    test("every metal by its word");
    for (int i = 0; i < ROWS; i++) {
        const char *word = facet_word(FACET_KIND_METAL, (int)rows[i].metal);
        expect((int)rows[i].metal == i, "row %d is enumerator %d", i, (int)rows[i].metal);
        expect(word && !strcmp(word, rows[i].word), "%d is %s, not %s", i, word ? word : "NULL", rows[i].word);
        expect(facet_value(FACET_KIND_METAL, rows[i].word) == i, "%s is %d", rows[i].word,
               facet_value(FACET_KIND_METAL, rows[i].word));
    }
    expect(!facet_word(FACET_KIND_METAL, ROWS), "one more than in metals.def");
}

static void check_no_metal(void)
{
    index_of_metal m, before;
    memset(&m, 0x5a, sizeof m);
    before = m;
    test("no such metal");
    expect(facet_index_of_metal((facet_metal)ROWS, m.eta, m.k) == FACET_ERROR_ENUM, "the one after the last");
    expect(facet_index_of_metal((facet_metal)-1, m.eta, m.k) == FACET_ERROR_ENUM, "-1");
    expect(facet_index_of_metal(FACET_METAL_GOLD, NULL, m.k) == FACET_ERROR_NULL, "eta NULL");
    expect(facet_index_of_metal(FACET_METAL_GOLD, m.eta, NULL) == FACET_ERROR_NULL, "k NULL");
    expect(!memcmp(&m, &before, sizeof m), "something was written");
}

/* ---- The mean, by Simpson's rule --------------------------------------------------------------------------------- */

static double weight(double wavelength, int band)
{
    const double u = (wavelength - bands[band].low) / (bands[band].high - bands[band].low);
    return exp(-pow(u - 0.5, 2));
}

static double between(const float *x, const float *y, size_t i, double at)
{
    return y[i - 1] + ((double)y[i] - y[i - 1]) * (at - x[i - 1]) / ((double)x[i] - x[i - 1]);
}

static double mean(const spectrum *s, const float *y, int band)
{
    const int steps = 64;
    double sum = 0, weights = 0;
    for (size_t i = 1; i < s->count; i++) {
        const double from = fmax(s->wavelength[i - 1], bands[band].low), to = fmin(s->wavelength[i], bands[band].high);
        for (int k = 0; k <= steps && from < to; k++) {
            const double at = from + (to - from) * k / steps, simpson = k == 0 || k == steps ? 1 : k % 2 ? 4 : 2;
            const double w = (to - from) * simpson * weight(at, band);
            weights += w;
            sum += w * between(s->wavelength, y, i, at);
        }
    }
    return sum / weights;
}

static void check_simpson(void)
{
    test("every constant is the float nearest to Simpson's");
    for (int i = 0; i < ROWS; i++) {
        spectrum s;
        if (!read_table(rows[i].name, &s)) return;
        const index_of_metal m = mean_of(&s);
        for (int c = 0; c < 3; c++) {
            const double n = mean(&s, s.n, c), k = mean(&s, s.k, c);
            expect(m.eta[c] == (float)n && m.k[c] == (float)k, "%s, %s: eta %.9g for %.12g, k %.9g for %.12g",
                   rows[i].word, bands[c].name, (double)m.eta[c], n, (double)m.k[c], k);
        }
    }
}

/* ---- What others print ------------------------------------------------------------------------------------------- */

/* Unpolarised, from the amplitudes: Born and Wolf, sec. 1.5 with the complex index of sec. 14.2. */
static double conductor(double eta, double k, double cosine)
{
    const double complex m2 = (eta + k * I) * (eta + k * I), w = csqrt(m2 - (1 - cosine * cosine));
    const double rs = cabs((cosine - w) / (cosine + w)), rp = cabs((m2 * cosine - w) / (m2 * cosine + w));
    return (rs * rs + rp * rp) / 2;
}

typedef struct { double schlick, f82; } errors;

/* Over all angles, of Schlick's form, and of the same with what makes it exact where the cosine is 1/7. */
static errors worst_errors(double eta, double k)
{
    const int steps = 4000;
    const double f0 = conductor(eta, k, 1), seventh = 1.0 / 7, schlick = f0 + (1 - f0) * pow(1 - seventh, 5);
    const double b = (schlick - conductor(eta, k, seventh)) / (seventh * pow(1 - seventh, 6));
    errors worst = { 0, 0 };
    for (int i = 1; i <= steps; i++) {
        const double c = (double)i / steps, exact = conductor(eta, k, c), plain = f0 + (1 - f0) * pow(1 - c, 5);
        const double corrected = fmin(fmax(plain - b * c * pow(1 - c, 6), 0), 1);
        worst.schlick = fmax(worst.schlick, fabs(plain - exact));
        worst.f82 = fmax(worst.f82, fabs(corrected - exact));
    }
    return worst;
}

static bool rounds_to(double x, double printed) { return fabs(round(x * 1e4) / 1e4 - printed) <= 0.0005 + 1e-9; }

/* The same tables and the same weighting, by another program, rounded to four digits and then to three; -1: it has no
 * number. */
static void check_schlick(void)
{
    static const struct { facet_metal metal; double schlick[3], f82[3]; } printed[] = {
        { FACET_METAL_ALUMINIUM, { 0.125, 0.076, 0.059 }, { 0.016, 0.006, 0.007 } },
        { FACET_METAL_GOLD, { 0.016, 0.004, 0.020 }, { 0.004, 0.002, 0.020 } },
        { FACET_METAL_COPPER, { 0.025, 0.044, 0.046 }, { 0.006, 0.006, 0.002 } },
        { FACET_METAL_SILVER, { 0.006, 0.006, 0.004 }, { 0.001, 0.002, 0.002 } },
        { FACET_METAL_IRON, { 0.178, 0.172, 0.156 }, { 0.018, 0.017, 0.014 } },
        { FACET_METAL_CHROMIUM, { 0.194, 0.189, 0.160 }, { 0.022, 0.020, 0.011 } },
        { FACET_METAL_COBALT, { 0.171, 0.144, 0.124 }, { 0.013, 0.012, 0.012 } },
        { FACET_METAL_NICKEL, { 0.158, 0.131, 0.111 }, { 0.013, 0.012, 0.009 } },
        { FACET_METAL_TITANIUM, { 0.190, 0.160, 0.144 }, { 0.018, 0.010, 0.009 } },
        { FACET_METAL_PLATINUM, { 0.181, 0.143, 0.124 }, { -1, -1, -1 } },
        { FACET_METAL_TUNGSTEN, { 0.220, 0.201, 0.191 }, { -1, -1, -1 } },
    };
    test("how far Schlick's Fresnel is from the exact one");
    for (size_t i = 0; i < sizeof printed / sizeof printed[0]; i++) {
        index_of_metal m;
        facet_index_of_metal(printed[i].metal, m.eta, m.k);
        for (int c = 0; c < 3; c++) {
            const errors e = worst_errors(m.eta[c], m.k[c]);
            const double schlick = printed[i].schlick[c], f82 = printed[i].f82[c];
            expect(rounds_to(e.schlick, schlick), "%s, %s: %.4f, not %.3f", rows[printed[i].metal].word, bands[c].name,
                   e.schlick, schlick);
            expect(f82 < 0 || rounds_to(e.f82, f82), "%s, %s, F82: %.4f, not %.3f", rows[printed[i].metal].word,
                   bands[c].name, e.f82, f82);
        }
    }
}

/* Reflectances at normal incidence, from the manual of Unity's Shader Graph, "Metal Reflectance Node". They are sRGB
 * colours, weighted by the eye rather than by bands: nearer where a metal has little colour. */
static void check_colours(void)
{
    static const struct { facet_metal metal; double f0[3], tolerance; } printed[] = {
        { FACET_METAL_GOLD, { 1.000, 0.766, 0.336 }, 0.08 },
        { FACET_METAL_COPPER, { 0.955, 0.637, 0.538 }, 0.03 },
        { FACET_METAL_ALUMINIUM, { 0.913, 0.921, 0.925 }, 0.02 },
        { FACET_METAL_CHROMIUM, { 0.550, 0.556, 0.554 }, 0.01 },
        { FACET_METAL_PLATINUM, { 0.672, 0.637, 0.585 }, 0.02 },
    };
    test("colours of gold, copper and three others at normal incidence");
    for (size_t i = 0; i < sizeof printed / sizeof printed[0]; i++) {
        index_of_metal m;
        facet_index_of_metal(printed[i].metal, m.eta, m.k);
        for (int c = 0; c < 3; c++) {
            const double f0 = facet_f0_from_eta(m.eta[c], m.k[c], 1);
            expect(fabs(f0 - printed[i].f0[c]) <= printed[i].tolerance, "%s, %s: %.3f, not %.3f",
                   rows[printed[i].metal].word, bands[c].name, f0, printed[i].f0[c]);
        }
    }
}

/* Gold's constants at 650, 550 and 450 nm as renderers carry them, from the same measurement. */
static void check_gold(void)
{
    static const struct { double wavelength, n, k; } printed[] = {
        { 650, 0.15557, 3.6024 }, { 550, 0.42415, 2.4721 }, { 450, 1.3831, 1.9155 },
    };
    spectrum s;
    test("gold's table at 650, 550 and 450 nm");
    if (!read_table("Au", &s)) return;
    for (int p = 0; p < 3; p++) {
        const double at = printed[p].wavelength;
        size_t i = 1;
        while (i + 1 < s.count && s.wavelength[i] < at) i++;
        const double n = between(s.wavelength, s.n, i, at), k = between(s.wavelength, s.k, i, at);
        expect(fabs(n - printed[p].n) <= 6e-5 && fabs(k - printed[p].k) <= 6e-5, "%g nm: %.5f and %.4f", at, n, k);
    }
}

/* ---- Spectra whose means are known ------------------------------------------------------------------------------- */

typedef struct { facet_status status; index_of_metal mean; } outcome;

static outcome mean_with(const float *wavelength, const float *n, const float *k, size_t count)
{
    outcome o = { .status = FACET_OK };
    o.status = facet_index_of_spectrum(wavelength, n, k, count, o.mean.eta, o.mean.k, NULL);
    return o;
}

static void check_constant(void)
{
    static const float values[] = { 0, FLT_TRUE_MIN, FLT_MIN, 0.1f, 1, 1.5f, 0x1.fffffep+0f, 1000, FLT_MAX };
    test("the mean of a constant is that constant");
    for (size_t v = 0; v < sizeof values / sizeof values[0]; v++)
        for (size_t count = 2; count <= 5; count++) {
            float wavelength[5], n[5], k[5];
            for (size_t i = 0; i < count; i++) {
                wavelength[i] = 450 + 290 * (float)i / (float)(count - 1);
                n[i] = values[v];
                k[i] = 2;
            }
            const outcome o = mean_with(wavelength, n, k, count);
            for (int c = 0; c < 3; c++)
                expect(!o.status && o.mean.eta[c] == values[v] && o.mean.k[c] == 2, "%s of %a: %a, %a", bands[c].name,
                       (double)values[v], (double)o.mean.eta[c], (double)o.mean.k[c]);
        }
}

/* The weight is the same on both sides of a band's middle. */
static void check_linear(void)
{
    static const float wavelength[] = { 400, 500, 600, 800 }, falling[] = { 800, 600, 400, 0 };
    const outcome o = mean_with(wavelength, wavelength, falling, 4);
    test("the mean of a line is its value in the band's middle");
    for (int c = 0; c < 3; c++) {
        const double middle = (bands[c].low + bands[c].high) / 2;
        expect(o.mean.eta[c] == middle && o.mean.k[c] == 1600 - 2 * middle, "%s: %.9g, %.9g", bands[c].name,
               (double)o.mean.eta[c], (double)o.mean.k[c]);
    }
}

/* One float's wavelength stands out: the mean is p there over p's integral, sqrt pi erf(1/2) per band. */
static void check_spike(void)
{
    test("the mean of a spike one float wide");
    for (int c = 0; c < 3; c++)
        for (int part = 1; part < 8; part++) {
            const double width = bands[c].high - bands[c].low;
            const float at = (float)(bands[c].low + width * part / 8), before = nextafterf(at, 0);
            const float wavelength[] = { 450, before, at, nextafterf(at, 1000), 740 }, n[] = { 0, 0, 1, 0, 0 };
            const float k[] = { 0, 0, 0x1p100f, 0, 0 };
            const outcome o = mean_with(wavelength, n, k, 5);
            const double area = ((double)wavelength[3] - before) / 2 / width;
            const double want = area * weight(at, c) / (sqrt(3.14159265358979323846) * erf(0.5));
            for (int band = 0; band < 3; band++)
                expect(band == c ? fabs(o.mean.eta[c] - want) <= 1e-6 * want : o.mean.eta[band] == 0,
                       "%s at %.9g: %a, not %a", bands[band].name, (double)at, (double)o.mean.eta[band], want);
            expect(o.mean.k[c] == o.mean.eta[c] * 0x1p100f, "2^100 times it is %a", (double)o.mean.k[c]);
        }
}

static void check_ends(void)
{
    static const float near[] = { 450, 600, 740 }, far[] = { 0x1p-149f, 449.5f, 450, 600, 740, 741, FLT_MAX };
    static const float n[] = { 1, 3, 2 }, k[] = { 4, 2, 5 };
    static const float far_n[] = { FLT_MAX, FLT_MAX, 1, 3, 2, FLT_MAX, 0 }, far_k[] = { 0, 9, 4, 2, 5, 1e9f, FLT_MAX };
    const outcome a = mean_with(near, n, k, 3), b = mean_with(far, far_n, far_k, 7);
    test("what is measured outside of the bands changes nothing");
    expect(!a.status && !b.status && !memcmp(&a.mean, &b.mean, sizeof a.mean), "it does");
}

/* Rows put between others on their lines: what the rule integrates over changes, what it integrates does not. */
static void check_refinement(void)
{
    enum { COARSE = 38 };
    test_random r = { 41 };
    test("rows between two rows, on their line, change nothing");
    for (int round = 0; round < 200; round++) {
        float wavelength[3][4 * COARSE], n[3][4 * COARSE], k[3][4 * COARSE];
        size_t count[3] = { COARSE, 2 * COARSE - 1, 4 * COARSE - 3 };
        for (int i = 0; i < COARSE; i++) {
            wavelength[0][i] = (float)(448 + 8 * i);
            n[0][i] = (float)(random_u64(&r) % 4096);
            k[0][i] = (float)(random_u64(&r) % 4096);
        }
        for (int level = 1; level < 3; level++)
            for (size_t i = 0; i < count[level]; i++) {
                const size_t a = i / 2, b = (i + 1) / 2;
                wavelength[level][i] = (wavelength[level - 1][a] + wavelength[level - 1][b]) / 2;
                n[level][i] = (n[level - 1][a] + n[level - 1][b]) / 2;
                k[level][i] = (k[level - 1][a] + k[level - 1][b]) / 2;
            }
        const outcome coarse = mean_with(wavelength[0], n[0], k[0], count[0]);
        for (int level = 1; level < 3; level++) {
            const outcome fine = mean_with(wavelength[level], n[level], k[level], count[level]);
            expect(!coarse.status && !memcmp(&coarse, &fine, sizeof fine), "%a with %zu rows, %a with %zu",
                   (double)coarse.mean.eta[0], count[0], (double)fine.mean.eta[0], count[level]);
        }
    }
}

/* ---- Refusals ---------------------------------------------------------------------------------------------------- */

typedef struct { const float *wavelength, *n, *k; size_t count; float *eta, *extinction; } call;

static void refuses(const char *change, call c, facet_status code, const char *field, int index)
{
    facet_error error = { FACET_OK, NULL, 0 };
    const facet_status status =
        facet_index_of_spectrum(c.wavelength, c.n, c.k, c.count, c.eta, c.extinction, &error);
    expect_refused(change, status, &error, code, field, index);
    expect(facet_index_of_spectrum(c.wavelength, c.n, c.k, c.count, c.eta, c.extinction, NULL) == code,
           "%s: another status without an error", change);
}

static void check_refusals(void)
{
    enum { COUNT = 4 };
    index_of_metal m, before;
    memset(&m, 0x5a, sizeof m);
    before = m;
    test("refusals by status, field and index; nothing written");
#define REFUSES(change, code, field, index)                                                                           \
    do {                                                                                                              \
        float wavelength[COUNT] = { 400, 500, 600, 800 }, n[COUNT] = { 1, 1, 1, 1 }, k[COUNT] = { 2, 2, 2, 2 };       \
        call c = { wavelength, n, k, COUNT, m.eta, m.k };                                                             \
        change;                                                                                                       \
        refuses(#change, c, code, field, index);                                                                      \
    } while (0)
    REFUSES(c.wavelength = NULL, FACET_ERROR_NULL, "wavelength", -1);
    REFUSES(c.n = NULL, FACET_ERROR_NULL, "n", -1);
    REFUSES(c.k = NULL, FACET_ERROR_NULL, "k", -1);
    REFUSES(c.eta = NULL, FACET_ERROR_NULL, "eta", -1);
    REFUSES(c.extinction = NULL, FACET_ERROR_NULL, "extinction", -1);
    REFUSES(c.count = 0, FACET_ERROR_VALUE, "count", -1);
    REFUSES(c.count = 1, FACET_ERROR_VALUE, "count", -1);
    for (int i = 0; i < COUNT; i++) {
        REFUSES(wavelength[i] = NAN, FACET_ERROR_VALUE, "wavelength", i);
        REFUSES(wavelength[i] = INFINITY, FACET_ERROR_VALUE, "wavelength", i);
        REFUSES(wavelength[i] = -1, FACET_ERROR_VALUE, "wavelength", i);
        REFUSES(n[i] = NAN, FACET_ERROR_VALUE, "n", i);
        REFUSES(n[i] = INFINITY, FACET_ERROR_VALUE, "n", i);
        REFUSES(n[i] = -FLT_TRUE_MIN, FACET_ERROR_VALUE, "n", i);
        REFUSES(k[i] = NAN, FACET_ERROR_VALUE, "k", i);
        REFUSES(k[i] = INFINITY, FACET_ERROR_VALUE, "k", i);
        REFUSES(k[i] = -FLT_TRUE_MIN, FACET_ERROR_VALUE, "k", i);
    }
    REFUSES(wavelength[0] = 0, FACET_ERROR_VALUE, "wavelength", 0);
    REFUSES(wavelength[2] = wavelength[1], FACET_ERROR_VALUE, "wavelength", 2);
    REFUSES(wavelength[1] = 700, FACET_ERROR_VALUE, "wavelength", 2);
    REFUSES(wavelength[0] = nextafterf(450, 500), FACET_ERROR_VALUE, "wavelength", 0);
    REFUSES(wavelength[3] = nextafterf(740, 700), FACET_ERROR_VALUE, "wavelength", 3);
    REFUSES(c.count = 3, FACET_ERROR_VALUE, "wavelength", 2);
#undef REFUSES
    expect(!memcmp(&m, &before, sizeof m), "something was written");

    facet_error error = { FACET_ERROR_NULL, "stale", 5 };
    static const float wavelength[] = { 450, 740 }, n[] = { 1, 1 };
    expect_accepted("two rows", facet_index_of_spectrum(wavelength, n, n, 2, m.eta, m.k, &error), &error);
}

void suite_metals(void)
{
    for (int i = 0; i < ROWS; i++) check_row(i);
    for (int i = 0; i < ROWS; i++) check_source(i);
    check_words();
    check_no_metal();
    check_simpson();
    check_schlick();
    check_colours();
    check_gold();
    check_constant();
    check_linear();
    check_spike();
    check_ends();
    check_refinement();
    check_refusals();
}
