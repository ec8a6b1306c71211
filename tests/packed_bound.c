/* The committed bound over packed input, and what unpacking adds to it, against formulas in double of the exactly
 * unpacked numbers. */
#include "packed.h"

#include "bounds.h"
#include "harness.h"
#include "packed_samples.h"
#include "targets.h"

#include <math.h>

#define CASE "oren-nayar+ggx/smith-correlated/schlick/uncoupled"

static void check_formulas(void)
{
    const kernel_case *kernel = find_case(CASE);
    test_random r = { 3 };
    test("bound: the formulas in double are the reference's");
    for (int i = 0; i < 10000; i++) {
        const sample s = random_sample(&r, i % SAMPLES_KINDS, FACET_ALPHA_FLOOR, kernel->sigma_max);
        const exact_sample e = widened_sample(&s);
        double want[3], got[3];
        reference_radiance(&kernel->material, &s, want);
        exact_radiance(&e, got);
        for (int c = 0; c < 3; c++)
            expect(fabs(got[c] - want[c]) <= 1e-7 * want[c], "%.17g, not %.17g", got[c], want[c]);
    }
}

/* ---- The bound --------------------------------------------------------------------------------------------------- */

/* What rounding n and v costs beside the case's bound, in units of 2^-24 over alpha and vh: v + l turns by v's error
 * over |v + l| = 2 vh, and D by twice that over alpha. 1.25 times the worst of 3072000 samples on each target, 2.392,
 * where unpacking, which turns little else, costs 161783 units: nl 0.0284067, nv 0.0290624, vh 0.0287346, alpha
 * 0.000553633. Nearly all of it is v's. */
#define UNPACKING 2.99

static void check_sample(const facet_material *m, const error_bound *bound, const packed_samples *p, int i)
{
    const sample s = rounded_sample(&p->exact[i]);
    const cosines cosine = reference_cosines(&s);
    double want[3], radiance[3], magnitude[3];
    if (!in_domain(&s, cosine) || cosine.vh < 0x1p-6) return;
    reference_terms(m, &s, radiance, magnitude);
    exact_radiance(&p->exact[i], want);
    const double most = bound_at(bound, &s, cosine, NULL) + 0x1p-24 * UNPACKING / ((double)s.alpha * cosine.vh);
    for (int c = 0; c < 3; c++) {
        const double error = error_over_magnitude(p->radiance[c][i], want[c], magnitude[c], s.irradiance[c]);
        expect(error <= most, "%a, not %a: %.3g units of %.3g; nl %g, nv %g, vh %g, alpha %g",
               (double)p->radiance[c][i], want[c], error * 0x1p24, most * 0x1p24, cosine.nl, cosine.nv, cosine.vh,
               (double)s.alpha);
    }
}

void test_packed_bound(void)
{
    static packed_samples p;
    const int batches = test_slow_machine ? 4 : 300;
    const kernel_case *kernel = find_case(CASE);
    if (!kernel) {
        test("bound");
        skip("this build lacks the case");
        return;
    }
    check_formulas();
    facet_material material = kernel->material;
    material.streams = kernel->promised;
    for (int i = 0; i < target_count(); i++) {
        const facet_target target = target_at(i);
        const accuracy_row *row = find_accuracy(CASE, target.tier);
        test_random r = { 9 };
        facet_plan plan;
        test("%s: %d packed samples within the bound", target_words(target), batches * PACKED_SAMPLES);
        if (!expect(row && !facet_plan_init(&plan, &material, target, NULL), "no bound, or no plan")) continue;
        for (int k = 0; k < batches; k++) {
            draw_packed_samples(&r, &p);
            expect(!shade_packed_samples(&plan, &p), "refused");
            for (int n = 0; n < PACKED_SAMPLES; n++) check_sample(&material, &row->bound, &p, n);
        }
    }
}
