/* baseline-errors [DIR]: how far the bench's baselines are from the reference, and, where both are tried alike, the
 * library's kernels. Prints a table, which facet-bench reads. DIR: where accuracy.tsv is; tests. */
#include "../bench/bench_work.h"
#include "bounds.h"
#include "packed_samples.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define SIGMA_MAX 1.57079633f

#define BASELINE(name) extern const baseline baseline_##name;
#include "built.def"

static const baseline *const baselines[] = {
#define BASELINE(name) &baseline_##name,
#include "built.def"
};

/* A compiler's vectors take the body of a loop that is several of them long: so many copies of a sample stand there. */
enum { BASELINES = sizeof baselines / sizeof baselines[0], COPIES = 64, LANES = 16, COMPONENTS = 17 };

/* Random samples, and the witnesses of accuracy.tsv, which are bad for kernels; from so many of the worst of all a
 * search climbs, so many steps each. */
enum { SAMPLES = 20000, WITNESSES = 1000, CLIMBERS = 16, STEPS = 1000 };

const char *test_data = "tests";

static float values[COMPONENTS][COPIES];

/* ---- A sample ---------------------------------------------------------------------------------------------------- */

typedef struct {
    sample s;
    facet_light lights[SHADE_MOST_LIGHTS];
    double want[3], magnitude[3];
} question;

/* l turned around n by k quarters: under the same angle. */
static void turn(const sample *s, size_t k, float to[3])
{
    static const double quarters[] = { 1, 0, -1, 0 }, sines[] = { 0, 1, 0, -1 };
    double along = 0;
    for (int c = 0; c < 3; c++) along += (double)s->n[c] * s->l[c];
    for (int c = 0; c < 3; c++) {
        const int x = (c + 1) % 3, y = (c + 2) % 3;
        const double across = (double)s->n[x] * s->l[y] - (double)s->n[y] * s->l[x];
        to[c] = (float)(along * s->n[c] * (1 - quarters[k]) + s->l[c] * quarters[k] + across * sines[k]);
    }
}

static bool is_plain(const sample *s)
{
    const error_bound isotropic = { .distribution = FACET_DISTRIBUTION_GGX };
    return in_plain_domain(&isotropic, s, reference_cosines(s));
}

static sample draw(test_random *random, int index)
{
    sample s;
    do s = random_sample(random, index & 1 ? SAMPLES_LOBE : SAMPLES_UNIFORM, 0.01f, SIGMA_MAX);
    while (!is_plain(&s));
    return s;
}

/* A vector or a number, by a little. */
static sample mutate(test_random *random, sample s)
{
    float *const vectors[] = { s.n, s.v, s.l }, *const numbers[] = { &s.sigma, &s.alpha };
    const double step = exp(-18 * random_unit(random));
    const uint64_t which = random_u64(random) % 4;
    if (which == 3) {
        float *number = numbers[random_u64(random) % 2];
        *number = (float)(*number * (1 + step * (2 * random_unit(random) - 1)));
        s.sigma = fminf(s.sigma, SIGMA_MAX);
        s.alpha = fminf(s.alpha, 1);
        return s;
    }
    double moved[3], square = 0;
    for (int c = 0; c < 3; c++) {
        moved[c] = vectors[which][c] + step * (2 * random_unit(random) - 1);
        square += moved[c] * moved[c];
    }
    for (int c = 0; c < 3; c++) vectors[which][c] = (float)(moved[c] / sqrt(square));
    return s;
}

/* What the workload makes of a sample. */
static question ask(const work *w, const sample *s)
{
    question q = { .s = *s };
    for (int c = 0; c < 3; c++) {
        q.s.eta[c] = w->material.fresnel.eta[c];
        q.s.k[c] = w->material.fresnel.k[c];
    }
    for (size_t k = 0; k < w->light_count; k++) {
        double radiance[3], magnitude[3];
        q.lights[k] = w->lights[k];
        turn(s, k, q.lights[k].direction);
        memcpy(q.s.l, q.lights[k].direction, sizeof q.s.l);
        memcpy(q.s.irradiance, q.lights[k].irradiance, sizeof q.s.irradiance);
        reference_terms(&w->material, &q.s, radiance, magnitude);
        for (int c = 0; c < 3; c++) q.want[c] += radiance[c], q.magnitude[c] += magnitude[c];
    }
    return q;
}

/* ---- An answer --------------------------------------------------------------------------------------------------- */

static float *copies(int at, float value)
{
    for (int i = 0; i < COPIES; i++) values[at][i] = value;
    return values[at];
}

/* The sample, COPIES times. */
static facet_batch batch_of_copies(const work *w, const question *q)
{
    const sample *s = &q->s;
    int at = 2;
    facet_batch b = { .lights = q->lights, .light_count = w->light_count, .sigma = copies(0, s->sigma),
                      .alpha = copies(1, s->alpha) };
    for (int c = 0; c < 3; c++) {
        b.normal[c] = copies(at++, s->n[c]);
        b.view[c] = copies(at++, s->v[c]);
        b.albedo[c] = copies(at++, s->albedo[c]);
        b.f0[c] = copies(at++, s->f0[c]);
        b.radiance[c] = copies(at++, NAN);
    }
    return b;
}

/* Over the magnitude, of the worst channel. */
static double error_of(const facet_batch *b, const question *q)
{
    double worst = 0;
    for (int c = 0; c < 3; c++)
        for (size_t i = 0; i < b->count; i++)
            worst = fmax(worst, error_over_magnitude(b->radiance[c][i], q->want[c], q->magnitude[c],
                                                     q->s.irradiance[c]));
    return worst;
}

/* Who answers: a baseline, or the library. */
typedef struct {
    const baseline *baseline;
    facet_plan plan;
} who;

static double answer_error(const who *one, const work *w, const sample *s)
{
    const question q = ask(w, s);
    facet_batch b = batch_of_copies(w, &q);
    b.count = !one->baseline ? LANES : one->baseline->kind == TEXTBOOK ? 1 : COPIES;
    if (one->baseline) one->baseline->shade[w->shade](&w->material, &b);
    else if (facet_shade(&one->plan, &b, NULL)) return INFINITY;
    return error_of(&b, &q);
}

/* ---- The table --------------------------------------------------------------------------------------------------- */

typedef struct { sample s; double error; } found;

static int by_error(const void *a, const void *b)
{
    const double x = ((const found *)a)->error, y = ((const found *)b)->error;
    return (x > y) - (x < y);
}

static int by_size(const void *a, const void *b)
{
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

static void climb(const who *one, const work *w, test_random *random, found *at)
{
    for (int i = 0; i < STEPS; i++) {
        const sample s = mutate(random, at->s);
        if (!is_plain(&s)) continue;
        const double error = answer_error(one, w, &s);
        if (error > at->error) *at = (found){ s, error };
    }
}

static int try_witnesses(const who *one, const work *w, found *to)
{
    const accuracy_row *row;
    int count = 0;
    for (int i = 0; (row = accuracy_at(i)); i++)
        for (int goal = 0; goal < GOALS; goal++) {
            sample s = row->worst[goal].s;
            s.light = NULL;
            if (row->worst[goal].reached <= 0 || count == WITNESSES || !is_plain(&s)) continue;
            to[count++] = (found){ s, answer_error(one, w, &s) };
        }
    return count;
}

static void measure_one(const char *kind, const char *name, const who *one, const work *w)
{
    static found all[SAMPLES + WITNESSES];
    test_random random = { 2 };
    double worst = 0;
    for (int i = 0; i < SAMPLES; i++) {
        const sample s = draw(&random, i);
        all[i] = (found){ s, answer_error(one, w, &s) };
    }
    qsort(all, SAMPLES, sizeof all[0], by_error);
    const double p999 = all[SAMPLES - 1 - SAMPLES / 1000].error;
    const int count = SAMPLES + try_witnesses(one, w, all + SAMPLES);
    qsort(all, (size_t)count, sizeof all[0], by_error);
    for (int i = count - CLIMBERS; i < count; i++) {
        climb(one, w, &random, &all[i]);
        worst = fmax(worst, all[i].error);
    }
    printf("%s\t%s\t%s\t%.3g\t%.3g\n", kind, w->name, name, worst, p999);
}

/* ---- Packed streams ---------------------------------------------------------------------------------------------- */

/* So many batches of random packed samples, without a search. */
enum { PACKED_BATCHES = 100 };

/* The worst channel's. */
static double packed_error(const facet_material *m, const packed_samples *shaded, int i)
{
    const exact_sample *exact = &shaded->exact[i];
    const sample s = rounded_sample(exact);
    double want[3], radiance[3], magnitude[3], worst = 0;
    reference_terms(m, &s, radiance, magnitude);
    exact_radiance(exact, want);
    for (int c = 0; c < 3; c++)
        worst = fmax(worst, error_over_magnitude(shaded->radiance[c][i], want[c], magnitude[c], s.irradiance[c]));
    return worst;
}

static void measure_packed(const char *name, const who *one, const work *w)
{
    static packed_samples shaded;
    static double usual[PACKED_BATCHES * PACKED_SAMPLES];
    test_random random = { 2 };
    double worst = 0;
    int count = 0;
    for (int batch = 0; batch < PACKED_BATCHES; batch++) {
        draw_packed_samples(&random, &shaded);
        if (shade_packed_samples(&one->plan, &shaded)) worst = INFINITY;
        for (int i = 0; i < PACKED_SAMPLES; i++) {
            const sample s = rounded_sample(&shaded.exact[i]);
            if (!is_plain(&s)) continue;
            const double error = packed_error(&w->material, &shaded, i);
            worst = fmax(worst, error);
            if (shaded.exact[i].usual) usual[count++] = error;
        }
    }
    qsort(usual, (size_t)count, sizeof usual[0], by_size);
    printf("kernel\t%s\t%s\t%.3g\t%.3g\n", w->name, name, worst, usual[count - 1 - count / 1000]);
}

/* Nothing where this CPU does not run it. */
static void measure_kernel(const work *w, facet_target target)
{
    who one = { .baseline = NULL };
    char name[64];
    if (facet_plan_init(&one.plan, &w->material, target, NULL)) return;
    snprintf(name, sizeof name, "%s\t%s", facet_word(FACET_KIND_TIER, (int)target.tier),
             facet_word(FACET_KIND_ARCH, (int)target.arch));
    if (w->format != FLOATS) measure_packed(name, &one, w);
    else measure_one("kernel", name, &one, w);
}

static void measure_all(const work *w)
{
    for (int i = 0; i < BASELINES && w->shade >= 0; i++)
        if (baselines[i]->shade[w->shade])
            measure_one("baseline", baselines[i]->name, &(who){ .baseline = baselines[i] }, w);
    for (int tier = 0; facet_word(FACET_KIND_TIER, tier); tier++)
        for (int arch = FACET_ARCH_BEST + 1; facet_word(FACET_KIND_ARCH, arch); arch++)
            measure_kernel(w, (facet_target){ .arch = (facet_arch)arch, .tier = (facet_tier)tier });
}

int main(int count, char **words)
{
    if (count > 1) test_data = words[1];
    if (!accuracy_at(0)) return EXIT_FAILURE;
    printf("# Errors of the baselines, and of the kernels found alike: written by baseline-errors.\n"
           "# |got - want|/magnitude (tests/reference.h) where nl, nv > 5e-4, alpha >= 0.01: the worst that a search\n"
           "# found, from random samples and the witnesses of accuracy.tsv on, and what 99.9 %% of %d random samples\n"
           "# stay within, half of them uniform, half in the lobe. Packed: of radiance before it is rounded to halves\n"
           "# or pixels, against formulas in double of the packed numbers; of %d random samples, without a search.\n"
           "# baseline\tworkload\tname\tworst\tp99.9\n# kernel\tworkload\ttier\tarch\tworst\tp99.9\n", SAMPLES,
           PACKED_BATCHES * PACKED_SAMPLES);
    for (int i = 0; work_at(i); i++)
        if (work_at(i)->title && (!work_at(i)->frame || work_at(i)->format == HALVES)) measure_all(work_at(i));
    return ferror(stdout) || fflush(stdout) ? EXIT_FAILURE : EXIT_SUCCESS;
}
