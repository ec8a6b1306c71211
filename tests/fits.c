/* Fitted Fresnel terms: whether a fit is within its stated bound of the reference at far more cosines than it was
 * measured at, on every architecture; whether there is one where there should be, and none where there must not. */
#include "fits.h"

#include "bits.h"
#include "harness.h"
#include "reference.h"
#include "targets.h"

#include <float.h>
#include <math.h>
#include <string.h>

/* The functions that this build links, by arch and tier. */
#define FACET_ARCH(id, name, ...)                                                                                     \
    extern fits_function fits_##name##_fast __attribute__((weak)), fits_##name##_strict __attribute__((weak));
#include "arches.def"

static fits_function *const functions[][2] = {
#define FACET_ARCH(id, name, ...) [FACET_ARCH_##id] = { fits_##name##_fast, fits_##name##_strict },
#include "arches.def"
};

typedef struct { float eta, k, outside, polarisation; } medium;

static const float polarisations[] = { 0, -1, 1, -0.3f };
enum { POLARISATIONS = sizeof polarisations / sizeof polarisations[0] };

static const char *const metals[] = {
#define FACET_METAL(id, name, word, ...) word,
#include "metals.def"
};
enum { METALS = sizeof metals / sizeof metals[0] };

/* ---- A fit against the reference --------------------------------------------------------------------------------- */

/* v = l = (0, 0, c) has vh = c, exactly. */
static double exact(const medium *m, float c)
{
    const facet_material material = {
        .fresnel = { .model = FACET_FRESNEL_CONDUCTOR, .eta_outside = m->outside, .polarisation = m->polarisation },
    };
    const sample s = { .v = { 0, 0, c }, .l = { 0, 0, c }, .eta = { m->eta }, .k = { m->k } };
    return reference_fresnel(&material, &s, 0);
}

/* Cosines: the ends; powers of two; the others lie at random, as dense at the ends as Chebyshev's points. */
enum { MOST_COSINES = 1 << 13 };
static float cosines_to_check[MOST_COSINES];

static void place_cosines(void)
{
    test_random r = { 1 };
    float *c = cosines_to_check;
    for (int i = 0; i < MOST_COSINES; i++) {
        const double t = random_unit(&r);
        c[i] = (float)(t * t * (3 - 2 * t));
    }
    c[0] = 0, c[1] = 1, c[2] = 1 - FLT_EPSILON / 2, c[3] = FLT_TRUE_MIN;
    for (int i = 0; i < 60; i++) c[4 + i] = (float)ldexp(1 + random_unit(&r), -1 - 2 * i);
}

typedef struct { double error; float c, got; double want; facet_target target; } finding;

/* The worst relative error of a fit; infinite where it is above 1, or not 1 at grazing. */
static finding worst_of(const medium *m, const fresnel_fit *fit, int count)
{
    static double want[MOST_COSINES];
    static float got[MOST_COSINES];
    finding worst = { .error = -1 };
    for (int i = 0; i < count; i++) want[i] = exact(m, cosines_to_check[i]);
    for (int t = 0; t < target_count(); t++) {
        const facet_target target = target_at(t);
        functions[target.arch][target.tier](fit, cosines_to_check, got, (size_t)count);
        for (int i = 0; i < count; i++) {
            const float c = cosines_to_check[i];
            double error = fabs((double)got[i] - want[i]) / want[i];
            if (!(got[i] > 0 && got[i] <= 1) || (c == 0 && got[i] < 1)) error = INFINITY;
            if (error > worst.error) worst = (finding){ error, c, got[i], want[i], target };
        }
    }
    return worst;
}

/* Fits, and checks the bound where it is accepted. The error found, over the bound; 0: no fit. */
static double check_bound(medium m, int count)
{
    fresnel_fit fit;
    const float bound = facet_fit_fresnel(&fit, m.eta, m.k, m.outside, m.polarisation);
    if (isinf(bound)) return 0;
    const finding worst = worst_of(&m, &fit, count);
    expect(worst.error <= (double)bound,
           "eta %a, k %a in %a, polarisation %g: %s has error %.3g, bound %.3g, at %a: %a, not %a", (double)m.eta,
           (double)m.k, (double)m.outside, (double)m.polarisation, target_words(worst.target), worst.error,
           (double)bound, (double)worst.c, (double)worst.got, worst.want);
    return worst.error / (double)bound;
}

/* ---- What is fitted ---------------------------------------------------------------------------------------------- */

static void check_metal(int metal)
{
    static const float outside[] = { 1, 1.33f };
    float eta[3], k[3];
    test("%s, in air and water, polarised or not", metals[metal]);
    facet_index_of_metal((facet_metal)metal, eta, k);
    for (int i = 0; i < POLARISATIONS * 2 * 3; i++) {
        const int c = i % 3;
        const medium m = { eta[c], k[c], outside[i / 3 % 2], polarisations[i / 6] };
        expect(check_bound(m, MOST_COSINES) > 0, "no fit: channel %d in %g, polarisation %g", c, (double)m.outside,
               (double)m.polarisation);
    }
}

static void check_dielectrics(void)
{
    double tightest = 0;
    test("dielectrics of a relative index from 1.28 to 10");
    for (float eta = 1.28f; eta < 10; eta *= 1.03f)
        for (int i = 0; i < 2; i++) {
            const float outside = i ? 1.33f : 1;
            const double tight = check_bound((medium){ eta * outside, 0, outside, 0 }, MOST_COSINES);
            expect(tight > 0, "no fit: %g in %g", (double)(eta * outside), (double)outside);
            tightest = fmax(tightest, tight);
        }
    test("a bound is no more than 1.5 times what is found");
    expect(tightest >= 1 / 1.5, "%.2f times", 1 / tightest);
}

static double between(test_random *r, double low, double high) { return low + (high - low) * random_unit(r); }
static double any_magnitude(test_random *r, double low, double high) { return exp(between(r, log(low), log(high))); }

static void check_random(int polarisation, double enough)
{
    const int count = test_slow_machine ? 100 : 1000;
    int fitted = 0;
    test_random r = { 2 };
    test("eta in [0.05, 10], k in [0, 20], polarisation %g", (double)polarisations[polarisation]);
    for (int i = 0; i < count; i++) {
        const medium m = { (float)between(&r, 0.05, 10), (float)between(&r, 0, 20), 1, polarisations[polarisation] };
        fitted += check_bound(m, 512) > 0;
    }
    expect(fitted >= enough * count, "%d of %d have a fit", fitted, count);
}

/* Nothing is asked of how many have a fit. */
static void check_domain(void)
{
    test_random r = { 3 };
    test("eta, k, eta outside and polarisation anywhere in their domains");
    for (int i = 0; i < (test_slow_machine ? 100 : 2000); i++) {
        const float k = i % 4 ? (float)any_magnitude(&r, 1e-6, FACET_ETA_CAP) : 0;
        const float outside = i % 2 ? 1 : (float)any_magnitude(&r, FACET_ETA_FLOOR, FACET_ETA_CAP);
        check_bound((medium){ (float)any_magnitude(&r, FACET_ETA_FLOOR, FACET_ETA_CAP), k, outside,
                              (float)between(&r, -1, 1) }, 512);
    }
}

/* ---- What is not ------------------------------------------------------------------------------------------------- */

static void check_refused(void)
{
    static const struct { const char *what; medium m; } rows[] = {
        { "no boundary", { 1, 0, 1, 0 } },
        { "hardly a boundary", { 1 + FLT_EPSILON, 0, 1, 0 } },
        { "a small step", { 1.05f, 0, 1, 0 } },
        { "another", { 1.2f, 0, 1, 0 } },
        { "glass in water", { 1.5f, 0, 1.33f, 0 } },
        { "total reflection", { 0.75f, 0, 1, 0 } },
        { "total reflection, absorbed a little", { 0.75f, 1e-3f, 1, 0 } },
        { "a zero at Brewster's angle", { 1.5f, 0, 1, 1 } },
        { "almost a zero", { 1.5f, 1e-3f, 1, 1 } },
        { "the least index", { FACET_ETA_FLOOR, 0, 1, 0 } },
        { "the least in the largest", { FACET_ETA_FLOOR, 0, FACET_ETA_CAP, 0 } },
    };
    for (size_t i = 0; i < sizeof rows / sizeof rows[0]; i++) {
        const medium m = rows[i].m;
        fresnel_fit fit;
        test("refused: %s", rows[i].what);
        const float bound = facet_fit_fresnel(&fit, m.eta, m.k, m.outside, m.polarisation);
        expect(isinf(bound), "fitted within %g", (double)bound);
    }
}

/* ---- Everywhere the same ----------------------------------------------------------------------------------------- */

/* FNV-1a. */
static uint32_t hash(uint32_t h, float x)
{
    for (int i = 0; i < 4; i++) h = (h ^ (to_bits(x) >> 8 * i & 0xff)) * 0x01000193u;
    return h;
}

static void check_bytes(void)
{
    const uint32_t committed = 0x5a434479;
    uint32_t h = 0x811c9dc5u;
    test("the metals' fits are the committed bytes");
    for (int metal = 0; metal < METALS; metal++) {
        float eta[3], k[3];
        facet_index_of_metal((facet_metal)metal, eta, k);
        for (int c = 0; c < 3; c++) {
            fresnel_fit fit;
            h = hash(h, facet_fit_fresnel(&fit, eta[c], k[c], 1, 0));
            for (int i = 0; i < FIT_DEGREE; i++) h = hash(hash(h, fit.p[i]), fit.q[i]);
        }
    }
    expect(h == committed, "0x%08x, not 0x%08x", (unsigned)h, (unsigned)committed);
}

/* ---- Plans ------------------------------------------------------------------------------------------------------- */

static void check_plan(const char *what, facet_material m, facet_tier tier, const char *words)
{
    facet_plan plan, again;
    char text[2048];
    test("%s", what);
    m.specular.model = FACET_DISTRIBUTION_GGX;
    m.specular.alpha = 0.2f;
    const facet_target target = { .tier = tier };
    if (!facet_has(FACET_KIND_TIER, (int)tier) || !facet_has(FACET_KIND_FRESNEL, (int)m.fresnel.model)) {
        skip("not in this build");
        return;
    }
    if (!expect(!facet_plan_init(&plan, &m, target, NULL) && !facet_plan_init(&again, &m, target, NULL), "refused"))
        return;
    facet_plan_describe(&plan, text, sizeof text);
    expect(strstr(text, words), "it says %s", text);
    expect(!memcmp(&plan, &again, sizeof plan), "two plans differ");
}

static void check_plans(void)
{
    facet_material gold = { .fresnel = { .model = FACET_FRESNEL_CONDUCTOR } };
    facet_index_of_metal(FACET_METAL_GOLD, gold.fresnel.eta, gold.fresnel.k);
    facet_material measured = gold, mirage = { .fresnel = { .model = FACET_FRESNEL_DIELECTRIC, .f0 = { 1e-4f } } };
    measured.streams = FACET_STREAM_K;
    const facet_material glass = { .fresnel = { .model = FACET_FRESNEL_DIELECTRIC, .eta = { 1.5f, 1.5f, 1.5f } } };
    const facet_material painted = { .fresnel.model = FACET_FRESNEL_DIELECTRIC, .streams = FACET_STREAM_F0 };
    check_plan("gold has a fit per channel", gold, FACET_TIER_FAST, "Fresnel: a rational function of the cosine per");
    check_plan("glass has one fit", glass, FACET_TIER_FAST, "Fresnel: a rational function of the cosine, within");
    check_plan("one channel without a fit leaves the others none", mirage, FACET_TIER_FAST, "Fresnel: exact; no fit");
    check_plan("k per sample has no fit", measured, FACET_TIER_FAST, "Fresnel: exact; what comes per sample");
    check_plan("an index that follows from f0 per sample has none", painted, FACET_TIER_FAST,
               "Fresnel: exact; what comes per sample");
    check_plan("the strict tier has none", gold, FACET_TIER_STRICT, "Fresnel: exact; the strict tier");
}

void suite_fits(void)
{
    place_cosines();
    for (int i = 0; i < METALS; i++) check_metal(i);
    check_dielectrics();
    check_random(0, 0.99);
    check_random(1, 0.99);
    check_random(2, 0.85);
    check_domain();
    check_refused();
    check_bytes();
    check_plans();
}
