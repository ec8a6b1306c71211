/* Every kernel against its error bound, from both sides: no error exceeds it, and the worst found comes near it. */
#include "samples.h"
#include "search.h"

#include <errno.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

static const double tight = 0.5;             /* the worst found reaches at least this part of the bound */
static const double margin = 1.25;           /* of a new bound over the worst found */

/* No bound may be larger, whatever the search finds: a wrong constant is a mistake, not a rounding error. */
static const double ceilings[GOALS] = { [GOAL_REL] = 64, [GOAL_GRAZING] = 6, [GOAL_PEAK] = 12, [GOAL_PLAIN] = 5e-4 };

static search_effort effort(void)
{
    return test_slow_machine ? (search_effort){ 1, 4, 4, 37 } : (search_effort){ 2, 200, 400, 1 };
}

static bool has_tier(facet_tier tier) { return facet_has(FACET_KIND_TIER, (int)tier); }
static const char *tier_word(facet_tier tier) { return facet_word(FACET_KIND_TIER, (int)tier); }
static const char *arch_word(facet_arch arch) { return facet_word(FACET_KIND_ARCH, (int)arch); }

/* ---- The worst found --------------------------------------------------------------------------------------------- */

static void expect_within(int goal, const witness *w)
{
    const sample *s = &w->s;
    expect(w->reached <= 1,
           "%s: %.3g of the bound on %s: got %a, want %a: n %a %a %a v %a %a %a l %a %a %a tangent %a %a %a position "
           "%a %a %a albedo %a sigma %a alpha %a %a exponent %a f0 %a eta %a k %a irradiance %a", goal_words[goal],
           w->reached, arch_word(w->arch), (double)w->got, w->want, (double)s->n[0], (double)s->n[1], (double)s->n[2],
           (double)s->v[0], (double)s->v[1], (double)s->v[2], (double)s->l[0], (double)s->l[1], (double)s->l[2],
           (double)s->tangent[0], (double)s->tangent[1], (double)s->tangent[2], (double)s->position[0],
           (double)s->position[1], (double)s->position[2], (double)s->albedo[0], (double)s->sigma, (double)s->alpha,
           (double)s->alpha_y, (double)s->exponent, (double)s->f0[0], (double)s->eta[0], (double)s->k[0],
           (double)s->irradiance[0]);
}

static bool expect_small(const accuracy_row *row)
{
    bool small = true;
    for (int goal = 0; goal < GOALS; goal++)
        if (!expect(row->bound.limit[goal] <= ceilings[goal], "%s, %s: a bound of %g is no rounding error", row->name,
                    goal_words[goal], row->bound.limit[goal]))
            small = false;
    return small;
}

/* The witness of these inputs; `set` is of its tier. */
static witness measure_witness(const kernel_set *set, const error_bound *b, const sample *s, int goal)
{
    measurement m;
    measure(set, s, 1, &m);
    const double bound = goal == GOAL_PLAIN ? b->limit[goal] : bound_at(b, s, reference_cosines(s), NULL);
    return (witness){ *s, m.arch, m.got, m.want, m.error / bound };
}

/* The committed witness: the reference still says `want`, and every architecture of the tier says `got` or, in the fast
 * tier, something within the bound. */
static void replay(const kernel_set *set, const accuracy_row *row, int goal)
{
    const witness *w = &row->worst[goal];
    for (int k = 0; k < set->count; k++) {
        const kernel_set one = { .material = set->material, .plans = { set->plans[k] }, .arches = { set->arches[k] },
                                 .count = 1 };
        const witness again = measure_witness(&one, &row->bound, &w->s, goal);
        expect_within(goal, &again);
        expect(fabs(again.want - w->want) <= 1e-12 * w->want, "%s: the reference says %a, the table %a",
               goal_words[goal], again.want, w->want);
        if (row->tier != FACET_TIER_STRICT) continue;
        expect(again.got == w->got, "%s: %s says %a, the table %a", goal_words[goal], arch_word(again.arch),
               (double)again.got, (double)w->got);
        expect(fabs(again.reached - w->reached) <= 2e-3, "%s: the witness reaches %.3f, in the table %.3f",
               goal_words[goal], again.reached, w->reached);
    }
}

static int by_size(const void *a, const void *b)
{
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

/* Half uniform, half in the lobe: the error over magnitude that 999 of 1000 samples stay within. */
static double measure_p999(const kernel_case *kernel, facet_tier tier)
{
    enum { COUNT = 200 * MOST_MEASURED };
    static double errors[COUNT];
    const int count = test_slow_machine ? COUNT / 4 : COUNT;
    const kernel_set set = kernels_of(kernel, tier, tier == FACET_TIER_STRICT);
    test_random random = { 2 };
    for (int at = 0; at < count; at += MOST_MEASURED) {
        sample samples[MOST_MEASURED];
        measurement results[MOST_MEASURED];
        for (int i = 0; i < MOST_MEASURED; i++)
            samples[i] = random_sample_of(kernel, &random, i & 1 ? SAMPLES_LOBE : SAMPLES_UNIFORM, 0.01f);
        measure(&set, samples, MOST_MEASURED, results);
        for (int i = 0; i < MOST_MEASURED; i++) errors[at + i] = results[i].error;
    }
    qsort(errors, (size_t)count, sizeof errors[0], by_size);
    return errors[count - count / 1000];
}

/* ---- The tests of a kernel --------------------------------------------------------------------------------------- */

static void check_exceeding(const kernel_case *kernel, const accuracy_row *row, witness found[GOALS])
{
    test("%s, %s", kernel->name, tier_word(row->tier));
    expect_small(row);
    const kernel_set set = kernels_of(kernel, row->tier, false);
    for (int goal = 0; goal < GOALS; goal++)
        if (row->worst[goal].reached > 0) replay(&set, row, goal);
    search_worst(kernel, row->tier, &row->bound, effort(), found);
    for (int goal = 0; goal < GOALS; goal++) expect_within(goal, &found[goal]);
}

/* The fast tier's bound is for architectures that fuse and for those that do not: its worst shows where both are. */
static bool shows_the_worst(facet_tier tier)
{
    const bool both = facet_has(FACET_KIND_ARCH, FACET_ARCH_SSE2) && facet_has(FACET_KIND_ARCH, FACET_ARCH_AVX2);
    return tier == FACET_TIER_STRICT || (both && !test_slow_machine);
}

static void check_tight(const kernel_case *kernel, const accuracy_row *row, const witness found[GOALS])
{
    test("%s, %s, is tight", kernel->name, tier_word(row->tier));
    for (int goal = 0; goal < GOALS; goal++) {
        if (row->bound.limit[goal] == 0 || found[goal].reached >= tight) continue;
        if (shows_the_worst(row->tier))
            expect(false, "%s: the worst found is %.3f of the bound", goal_words[goal], found[goal].reached);
        else
            skip("%s: the worst found here is %.3f of the bound", goal_words[goal], found[goal].reached);
    }
}

static void check_p999(const kernel_case *kernel, const accuracy_row *row)
{
    test("%s, %s, p99.9", kernel->name, tier_word(row->tier));
    const double p999 = measure_p999(kernel, row->tier), limit = row->bound.p999;
    expect(p999 <= limit, "%.3g, in the table %.3g", p999, limit);
    if (p999 >= tight * limit) return;
    if (shows_the_worst(row->tier)) expect(false, "%.3g, in the table %.3g", p999, limit);
    else skip("%.3g here, in the table %.3g", p999, limit);
}

/* ---- Numbers of the material's that no stream brings ------------------------------------------------------------- */

enum { VARIANTS = 6 };

/* Fills what the Fresnel term takes of them. False where it takes none. */
static bool vary(facet_material *m, int variant)
{
    static const float f90s[VARIANTS] = { 1e-6f, 0.02f, 0.5f, 0.9f, 0.1f, 0.999999f };
    static const float f82s[VARIANTS][3] = { { 1e-6f, 0, 0 }, { 1, 1, 1 }, { 0.02f, 0.2f, 0.5f }, { 0.7f, 0.8f, 0.9f },
                                             { 0.95f, 0.99f, 0.4f }, { 0.3f, 0.6f, 0.1f } };
    static const float media[VARIANTS] = { 0, 1.33f, 1.5f, 0.7f, 2.4f, 1.0001f };
    static const float polarisations[VARIANTS] = { 1, -1, 0, 1, -0.3f, 0.9f };
    switch (m->fresnel.model) {
    case FACET_FRESNEL_SCHLICK: m->fresnel.f90 = f90s[variant]; return true;
    case FACET_FRESNEL_SCHLICK_F82: memcpy(m->fresnel.f82, f82s[variant], sizeof m->fresnel.f82); return true;
    case FACET_FRESNEL_DIELECTRIC:
    case FACET_FRESNEL_CONDUCTOR:
        m->fresnel.eta_outside = media[variant];
        m->fresnel.polarisation = polarisations[variant];
        return true;
    default: return false;
    }
}

/* The bound holds whatever they are; of exact Fresnel terms that of the case that has them not zero. */
static void check_variants(const kernel_case *kernel, const accuracy_row *row)
{
    kernel_case varied = *kernel;
    if (kernel->material.specular.model == FACET_DISTRIBUTION_NONE || !vary(&varied.material, 0)) return;
    if (kernel->streams & FACET_STREAM_ETA && kernel->material.fresnel.eta_outside == 0) return;
    test("%s, %s, other numbers of Fresnel's", kernel->name, tier_word(row->tier));
    test_random random = { 3 };
    for (int k = 0; k < (test_slow_machine ? 3 : 60); k++) {
        sample samples[MOST_MEASURED];
        measurement results[MOST_MEASURED];
        vary(&varied.material, k % VARIANTS);
        const kernel_set set = kernels_of(&varied, row->tier, false);
        for (int i = 0; i < MOST_MEASURED; i++)
            samples[i] = random_sample_of(kernel, &random, i % SAMPLES_KINDS, FACET_ALPHA_FLOOR);
        measure(&set, samples, MOST_MEASURED, results);
        for (int i = 0; i < MOST_MEASURED; i++) {
            const cosines c = reference_cosines(&samples[i]);
            if (!in_domain(&samples[i], c)) continue;
            int goal;
            const double bound = bound_at(&row->bound, &samples[i], c, &goal);
            const measurement *m = &results[i];
            witness w = { samples[i], m->arch, m->got, m->want, m->error / bound };
            make_grey(&w.s, m->channel);
            expect_within(goal, &w);
        }
    }
}

/* ---- All tests of a kernel --------------------------------------------------------------------------------------- */

static void check_kernel(const kernel_case *kernel, facet_tier tier)
{
    const accuracy_row *row = find_accuracy(kernel->name, tier);
    if (!row) {
        test("%s, %s", kernel->name, tier_word(tier));
        expect(false, "accuracy.tsv has no row");
        return;
    }
    witness found[GOALS];
    check_exceeding(kernel, row, found);
    check_tight(kernel, row, found);
    check_p999(kernel, row);
    check_variants(kernel, row);
}

/* ---- The table --------------------------------------------------------------------------------------------------- */

static bool is_complete_build(void)
{
    for (int kind = FACET_KIND_DIFFUSE; kind <= FACET_KIND_TIER; kind++) {
        if (kind == FACET_KIND_ARCH) continue;
        for (int value = 0; facet_word((facet_kind)kind, value); value++)
            if (!facet_has((facet_kind)kind, value)) return false;
    }
    return true;
}

static bool is_case(const char *name)
{
    for (int i = 0; i < case_count(); i++)
        if (!strcmp(case_at(i)->name, name)) return true;
    return false;
}

static void check_rows(void)
{
    test("every row is of a kernel");
    expect(accuracy_at(0), "accuracy.tsv has no rows");
    if (!is_complete_build()) skip("this build has fewer models");
    for (int i = 0; is_complete_build() && accuracy_at(i); i++)
        expect(is_case(accuracy_at(i)->name), "accuracy.tsv: no kernel %s", accuracy_at(i)->name);
}

/* Rounded up to three digits. */
static double round_up(double x)
{
    if (x <= 0) return 0;
    const double unit = pow(10, floor(log10(x)) - 2);
    return ceil(x / unit) * unit;
}

/* The terms in such proportions that the worst of each comes equally near to the bound: each is scaled by what its own
 * samples reach. */
static void balance(const kernel_case *kernel, accuracy_row *row)
{
    const search_effort rough = { 1, 60, 120, 1 };
    error_bound *b = &row->bound;
    *b = (error_bound){ .limit = { 8, 1, kernel->material.specular.model ? 2 : 0, 1 },
                        .distribution = kernel->material.specular.model };
    for (int round = 0; round < 6; round++) {
        search_worst(kernel, row->tier, b, rough, row->worst);
        for (int goal = 0; goal < GOALS; goal++) b->limit[goal] *= row->worst[goal].reached;
    }
}

/* Leaves out what is nowhere the largest term. True where there was one. */
static bool drop_terms(accuracy_row *row)
{
    bool dropped = false;
    for (int goal = GOAL_REL; goal <= GOAL_PEAK; goal++) {
        if (row->bound.limit[goal] == 0 || row->worst[goal].reached > 0) continue;
        row->bound.limit[goal] = 0;
        dropped = true;
    }
    return dropped;
}

static double worst_term(const accuracy_row *row)
{
    double worst = 0;
    for (int goal = GOAL_REL; goal <= GOAL_PEAK; goal++) worst = fmax(worst, row->worst[goal].reached);
    return worst;
}

/* Lowers what is slack beside the others. True where there was such a term. */
static bool lower_terms(accuracy_row *row)
{
    const double enough = 0.75 * worst_term(row);
    bool lowered = false;
    for (int goal = GOAL_REL; goal <= GOAL_PEAK; goal++) {
        const double reached = row->worst[goal].reached;
        if (row->bound.limit[goal] == 0 || reached >= enough) continue;
        row->bound.limit[goal] *= 0.5 * (1 + reached / enough);
        lowered = true;
    }
    return lowered;
}

/* Then all alike: so that the worst of all is the margin below the bound. */
static void scale(const kernel_case *kernel, search_effort how, accuracy_row *row)
{
    error_bound *b = &row->bound;
    int rounds = 0;
    do search_worst(kernel, row->tier, b, how, row->worst);
    while (drop_terms(row) || (rounds++ < 8 && lower_terms(row)));
    for (int goal = 0; goal < GOALS; goal++) {
        const double reached = goal == GOAL_PLAIN ? row->worst[goal].reached : worst_term(row);
        b->limit[goal] = round_up(margin * b->limit[goal] * reached);
    }
    const kernel_set set = kernels_of(kernel, row->tier, false);
    for (int goal = 0; goal < GOALS; goal++)
        if (row->worst[goal].reached > 0) row->worst[goal] = measure_witness(&set, b, &row->worst[goal].s, goal);
}

/* Every row; then every row again, as what is bad for one kernel may be bad for others. */
static void measure_rows(void)
{
    for (int pass = 0; pass < 2; pass++)
        for (int i = 0; i < case_count(); i++)
            for (int tier = 0; tier_word((facet_tier)tier); tier++) {
                accuracy_row row = { .tier = (facet_tier)tier };
                strcpy(row.name, case_at(i)->name);
                if (pass > 0) row = *find_accuracy(row.name, row.tier);
                if (pass == 0) balance(case_at(i), &row);
                scale(case_at(i), pass > 0 ? effort() : (search_effort){ 6, 300, 1000, 1 }, &row);
                row.bound.p999 = round_up(margin * measure_p999(case_at(i), row.tier));
                keep_accuracy(&row);
            }
}

/* Every row, to the file. False where a bound is too large to be committed. */
static bool write_rows(FILE *file)
{
    bool small = true;
    write_accuracy_head(file);
    for (int i = 0; i < case_count(); i++)
        for (int tier = 0; tier_word((facet_tier)tier); tier++) {
            const accuracy_row *row = find_accuracy(case_at(i)->name, (facet_tier)tier);
            small = expect_small(row) && small;
            write_accuracy(file, row);
        }
    return small;
}

static void update_table(void)
{
    char path[4096], fresh[4096 + 8];
    test("the table is written anew");
    if (!expect(is_complete_build(), "this build has fewer models")) return;
    snprintf(path, sizeof path, "%s/accuracy.tsv", test_data);
    snprintf(fresh, sizeof fresh, "%s.fresh", path);
    FILE *file = fopen(fresh, "w");
    if (!expect(file, "%s: %s", fresh, strerror(errno))) return;
    measure_rows();
    const bool small = write_rows(file), written = !ferror(file);
    expect(!fclose(file) && written, "%s: %s", fresh, strerror(errno));
    if (small && written) expect(!rename(fresh, path), "%s: %s", path, strerror(errno));
    else remove(fresh);
}

void suite_accuracy(void)
{
    if (test_update) {
        update_table();
        return;
    }
    check_rows();
    for (int i = 0; i < case_count(); i++)
        for (int tier = 0; tier_word((facet_tier)tier); tier++)
            if (has_tier((facet_tier)tier)) check_kernel(case_at(i), (facet_tier)tier);
}
