/* Each goal has slots; the worst random samples fill them, and then each climbs on its own: of a slot's mutants, the
 * worst replaces it. */
#include "search.h"

#include "samples.h"

#include <math.h>
#include <string.h>

#define PI 3.14159265358979323846

enum { BATCH = MOST_MEASURED, SLOTS = 16, MUTANTS = BATCH / (GOALS * SLOTS) };

typedef struct {
    const kernel_case *kernel;
    const error_bound *bound;
    kernel_set set;
    test_random random;
    witness slots[GOALS][SLOTS];
} search;

/* ---- Measuring --------------------------------------------------------------------------------------------------- */

kernel_set kernels_of(const kernel_case *kernel, facet_tier tier, bool best_alone)
{
    kernel_set set = { .material = kernel->material };
    set.material.streams = kernel->promised;
    for (int arch = FACET_ARCH_BEST + 1; facet_word(FACET_KIND_ARCH, arch); arch++) {
        if (!facet_has(FACET_KIND_ARCH, arch) || (best_alone && arch != (int)facet_arch_best())) continue;
        const facet_target target = { .arch = (facet_arch)arch, .tier = tier };
        facet_error error;
        const bool made = facet_plan_init(&set.plans[set.count], &set.material, target, &error) == FACET_OK;
        if (expect(made, "no plan: %s", error.field)) set.arches[set.count++] = target.arch;
    }
    return set;
}

void measure(const kernel_set *set, const sample *samples, int count, measurement *results)
{
    double want[MOST_MEASURED][3], magnitude[MOST_MEASURED][3];
    sample_batch b = batch_of(samples, count);
    for (int i = 0; i < count; i++) {
        results[i] = (measurement){ .error = -1 };
        reference_terms(&set->material, &samples[i], want[i], magnitude[i]);
    }
    for (int k = 0; k < set->count; k++) {
        facet_shade(&set->plans[k], &b.batch, NULL);
        for (int i = 0; i < count; i++)
            for (int c = 0; c < 3; c++) {
                const float got = b.batch.radiance[c][i];
                const double error = error_over_magnitude(got, want[i][c], magnitude[i][c], samples[i].irradiance[c]);
                if (error > results[i].error) results[i] = (measurement){ error, want[i][c], got, set->arches[k], c };
            }
    }
    free_batch(&b);
}

/* ---- Slots ------------------------------------------------------------------------------------------------------- */

/* The channel that was worst, in all three. */
static witness witness_of(const sample *s, const measurement *m, double reached)
{
    witness w = { *s, m->arch, m->got, m->want, reached };
    make_grey(&w.s, m->channel);
    return w;
}

static void offer(witness *slot, const sample *s, const measurement *m, double reached)
{
    if (reached > slot->reached) *slot = witness_of(s, m, reached);
}

static witness *least_of(witness *slots)
{
    witness *least = slots;
    for (int i = 1; i < SLOTS; i++)
        if (slots[i].reached < least->reached) least = &slots[i];
    return least;
}

/* Measures samples and offers each to the slots of its goals: to those of number `own[i]`, or where `own` is NULL to
 * the least of them. */
static void try_samples(search *h, const sample *samples, int count, const int *own)
{
    measurement results[BATCH];
    measure(&h->set, samples, count, results);
    for (int i = 0; i < count; i++) {
        const cosines c = reference_cosines(&samples[i]);
        if (!in_domain(&samples[i], c)) continue;
        int goal;
        const double bound = bound_at(h->bound, &samples[i], c, &goal), plain = h->bound->limit[GOAL_PLAIN];
        witness *slots = h->slots[goal];
        offer(own ? &slots[own[i]] : least_of(slots), &samples[i], &results[i], results[i].error / bound);
        slots = h->slots[GOAL_PLAIN];
        if (in_plain_domain(h->bound, &samples[i], c))
            offer(own ? &slots[own[i]] : least_of(slots), &samples[i], &results[i], results[i].error / plain);
    }
}

/* ---- Mutants ----------------------------------------------------------------------------------------------------- */

static double signed_log(test_random *r, double least, double most)
{
    const double size = exp(log(least) + (log(most) - log(least)) * random_unit(r));
    return random_u64(r) & 1 ? size : -size;
}

static float nudge(test_random *r, float x)
{
    const int steps = 1 + (int)(random_u64(r) & 3);
    const float towards = random_u64(r) & 1 ? INFINITY : -INFINITY;
    for (int i = 0; i < steps; i++) x = nextafterf(x, towards);
    return x;
}

static void store_unit(float *to, const double *a)
{
    const double scale = 1 / sqrt(a[0] * a[0] + a[1] * a[1] + a[2] * a[2]);
    for (int c = 0; c < 3; c++) to[c] = (float)(a[c] * scale);
}

static void move_vector(test_random *r, float *vector)
{
    double moved[3];
    const double step = signed_log(r, 1e-8, 0.3);
    for (int c = 0; c < 3; c++) moved[c] = vector[c] + step * (2 * random_unit(r) - 1);
    store_unit(vector, moved);
}

/* Takes from the tangent what it has along the normal. */
static void lay_tangent(sample *s)
{
    double laid[3], along = 0;
    for (int c = 0; c < 3; c++) along += (double)s->n[c] * s->tangent[c];
    for (int c = 0; c < 3; c++) laid[c] = s->tangent[c] - along * s->n[c];
    store_unit(s->tangent, laid);
}

/* To another distance, or by a step. */
static void move_position(test_random *r, sample *s)
{
    const float *light = s->light->position;
    const double scale = exp(signed_log(r, 1e-7, 1)), step = random_u64(r) & 1 ? signed_log(r, 1e-8, 0.3) : 0;
    for (int c = 0; c < 3; c++)
        s->position[c] = (float)(light[c] + (s->position[c] - light[c]) * scale + step * (2 * random_unit(r) - 1));
}

static void turn(double angle, int x, const double *from, double *to)
{
    const int y = (x + 1) % 3, z = (x + 2) % 3;
    to[x] = cos(angle) * from[x] - sin(angle) * from[y];
    to[y] = sin(angle) * from[x] + cos(angle) * from[y];
    to[z] = from[z];
}

/* The same geometry in another frame: other roundings. */
static void turn_all(test_random *r, sample *s)
{
    const double angle = signed_log(r, 1e-7, PI);
    const int x = (int)(random_u64(r) % 3);
    float *const vectors[] = { s->n, s->v, s->tangent, s->l };
    double turned[3];
    for (int i = 0; i < 4; i++) {
        turn(angle, x, (double[]){ vectors[i][0], vectors[i][1], vectors[i][2] }, turned);
        store_unit(vectors[i], turned);
    }
    if (!s->light) return;
    double from[3];
    for (int c = 0; c < 3; c++) from[c] = (double)s->position[c] - s->light->position[c];
    turn(angle, x, from, turned);
    for (int c = 0; c < 3; c++) s->position[c] = (float)(s->light->position[c] + turned[c]);
}

static float mutate_number(test_random *r, float x, float least, float most)
{
    const float mutant = random_u64(r) & 1 ? nudge(r, x) : (float)(x * exp(signed_log(r, 1e-7, 1)));
    return fminf(fmaxf(mutant, least), most);
}

/* Also to where it is special: the medium's own, no extinction. */
static void mutate_index(test_random *r, sample *s)
{
    for (int c = 0; c < 3; c++) {
        s->eta[c] = mutate_number(r, s->eta[c], FACET_ETA_FLOOR, FACET_ETA_CAP);
        s->k[c] = mutate_number(r, s->k[c], 0, FACET_ETA_CAP);
        if (random_u64(r) % 16 == 0) s->k[c] = (float)random_unit(r);
        if (random_u64(r) % 16 == 0) s->k[c] = 0;
        if (random_u64(r) % 16 == 0) s->eta[c] = (float)(1 + signed_log(r, 1e-7, 0.5));
    }
}

static void mutate_colours(test_random *r, sample *s)
{
    for (int c = 0; c < 3; c++) {
        s->albedo[c] = mutate_number(r, s->albedo[c], 0, 1);
        s->f0[c] = mutate_number(r, s->f0[c], 0, 1);
        s->irradiance[c] = mutate_number(r, s->irradiance[c], 0, 1e6f);
    }
}

/* What a mutation changes, and which kernels it concerns: those that read the stream, or all. */
enum { NUDGED, MOVED, TURNED, COLOURED, WIDER, WIDER_ACROSS, SHARPER, ROUGHER, OF_INDEX, TWISTED, MUTATIONS };

static const uint32_t reads[MUTATIONS] = {
    [WIDER] = FACET_STREAM_ALPHA, [WIDER_ACROSS] = FACET_STREAM_ALPHA_Y, [SHARPER] = FACET_STREAM_EXPONENT,
    [ROUGHER] = FACET_STREAM_SIGMA, [OF_INDEX] = FACET_STREAM_ETA, [TWISTED] = FACET_STREAM_TANGENT,
};

static int any_mutation(test_random *r, const kernel_case *kernel)
{
    for (;;) {
        const uint64_t die = random_u64(r) % (MUTATIONS + 4);
        const int mutation = die < MUTATIONS ? (int)die : die < MUTATIONS + 2 ? NUDGED : die & 1 ? MOVED : TURNED;
        if (!reads[mutation] || kernel->streams & reads[mutation]) return mutation;
    }
}

static sample mutate(test_random *r, const kernel_case *kernel, sample s)
{
    float *const vectors[] = { s.n, s.v, s.light ? s.position : s.l };
    const uint64_t which = random_u64(r) % 3, component = random_u64(r) % 3;
    switch (any_mutation(r, kernel)) {
    case NUDGED: vectors[which][component] = nudge(r, vectors[which][component]); break;
    case MOVED:
        if (which == 2 && s.light) move_position(r, &s);
        else move_vector(r, vectors[which]);
        if (which == 0) lay_tangent(&s);
        break;
    case TURNED: turn_all(r, &s); break;
    case COLOURED: mutate_colours(r, &s); break;
    case WIDER: s.alpha = mutate_number(r, s.alpha, FACET_ALPHA_FLOOR, 1); break;
    case WIDER_ACROSS: s.alpha_y = mutate_number(r, s.alpha_y, FACET_ALPHA_FLOOR, 1); break;
    case SHARPER: s.exponent = mutate_number(r, s.exponent, FACET_EXPONENT_MIN, FACET_EXPONENT_MAX); break;
    case ROUGHER: s.sigma = mutate_number(r, s.sigma, 0, kernel->sigma_max); break;
    case OF_INDEX: mutate_index(r, &s); break;
    case TWISTED:
        if (random_u64(r) & 1) move_vector(r, s.tangent);
        else s.tangent[component] = nudge(r, s.tangent[component]);
        lay_tangent(&s);
    }
    if (s.light) aim_sample(&s);
    return s;
}

static void climb(search *h)
{
    sample mutants[BATCH];
    int own[BATCH], count = 0;
    for (int goal = 0; goal < GOALS; goal++)
        for (int slot = 0; slot < SLOTS; slot++)
            for (int i = 0; i < MUTANTS && h->slots[goal][slot].reached > 0; i++) {
                own[count] = slot;
                mutants[count] = mutate(&h->random, h->kernel, h->slots[goal][slot].s);
                if (i & 1) mutants[count] = mutate(&h->random, h->kernel, mutants[count]);
                count++;
            }
    try_samples(h, mutants, count, own);
}

/* ---- Random samples and the lattice ------------------------------------------------------------------------------ */

static void try_random(search *h, int batch)
{
    sample samples[BATCH];
    for (int i = 0; i < BATCH; i++)
        samples[i] = random_sample_of(h->kernel, &h->random, (batch + i) % SAMPLES_KINDS, FACET_ALPHA_FLOOR);
    try_samples(h, samples, BATCH, NULL);
}

static float edge_within(int index, float least, float most)
{
    return fminf(fmaxf(edge_values[index % edge_count], least), most);
}

/* n along z; l and v at cosines that are edges, opposite, at right angles or side by side; every number an edge. */
static sample lattice_sample(int index, double nl, double nv, const kernel_case *kernel)
{
    static const float across[][2] = { { 1, 0 }, { -1, 0 }, { 0, 1 } };
    const float *azimuth = across[index % 3];
    const double sin_l = sqrt(fmax(0, 1 - nl * nl)), sin_v = sqrt(fmax(0, 1 - nv * nv));
    sample s = { .n = { 0, 0, 1 }, .v = { (float)sin_v, 0, (float)nv }, .tangent = { 0.6f, 0.8f, 0 } };
    s.l[0] = (float)(sin_l * azimuth[0]), s.l[1] = (float)(sin_l * azimuth[1]), s.l[2] = (float)nl;
    if (index & 1) s.tangent[0] = 1, s.tangent[1] = 0;
    s.alpha = edge_within(index, FACET_ALPHA_FLOOR, 1);
    s.alpha_y = edge_within(index / 7, FACET_ALPHA_FLOOR, 1);
    s.exponent = edge_within(index, FACET_EXPONENT_MIN, FACET_EXPONENT_MAX);
    s.sigma = edge_within(index / 2, 0, kernel->sigma_max);
    for (int c = 0; c < 3; c++) {
        s.albedo[c] = edge_within(index + 5 * c, 0, 1);
        s.f0[c] = edge_within(index / 3 + 7 * c, 0, 1);
        s.eta[c] = edge_within(index / 2 + 13 * c, FACET_ETA_FLOOR, FACET_ETA_CAP);
        s.k[c] = edge_within(index / 3 + 3 * c, 0, FACET_ETA_CAP);
        s.irradiance[c] = edge_within(index / 5 + 11 * c, 0, 1e6f);
    }
    if (kernel->light.kind != FACET_LIGHT_DIRECTIONAL) light_sample(&s, &kernel->light, edge_within(index, 1e-3f, 10));
    return s;
}

static void try_lattice(search *h, int stride)
{
    sample samples[BATCH];
    int count = 0, number = 0;
    for (int i = 0; i < edge_count; i++)
        for (int k = 0; k < edge_count; k++) {
            const float nl = edge_values[i], nv = edge_values[k];
            for (int turn = 0; nl > 0 && nl <= 1 && nv > 0 && nv <= 1 && turn < edge_count; turn++) {
                if (number++ % stride) continue;
                samples[count++] = lattice_sample(edge_count * i + k + turn, nl, nv, h->kernel);
                if (count < BATCH) continue;
                try_samples(h, samples, count, NULL);
                count = 0;
            }
        }
    try_samples(h, samples, count, NULL);
}

/* ---- The search -------------------------------------------------------------------------------------------------- */

static void keep_worst(const search *h, witness found[GOALS])
{
    for (int goal = 0; goal < GOALS; goal++)
        for (int i = 0; i < SLOTS; i++)
            if (h->slots[goal][i].reached > found[goal].reached) found[goal] = h->slots[goal][i];
}

/* Under the kernel's light, where it came from elsewhere. */
static sample relit(const kernel_case *kernel, sample s)
{
    if (kernel->light.kind == FACET_LIGHT_DIRECTIONAL) s.light = NULL;
    else if (!s.light || s.light->kind != kernel->light.kind) light_sample(&s, &kernel->light, 1);
    return s;
}

/* What is known to be bad for any kernel. */
static void try_table(search *h)
{
    sample samples[BATCH];
    const accuracy_row *row;
    int count = 0;
    for (int i = 0; (row = accuracy_at(i)); i++)
        for (int goal = 0; goal < GOALS; goal++) {
            if (row->worst[goal].reached <= 0) continue;
            samples[count++] = relit(h->kernel, row->worst[goal].s);
            if (count < BATCH) continue;
            try_samples(h, samples, count, NULL);
            count = 0;
        }
    try_samples(h, samples, count, NULL);
}

void search_worst(const kernel_case *kernel, facet_tier tier, const error_bound *bound, search_effort effort,
                  witness found[GOALS])
{
    search h = { .kernel = kernel, .bound = bound, .random = { 1 } };
    h.set = kernels_of(kernel, tier, tier == FACET_TIER_STRICT);
    memset(found, 0, GOALS * sizeof found[0]);
    for (int start = 0; start < effort.starts; start++) {
        memset(h.slots, 0, sizeof h.slots);
        if (start == 0) {
            try_table(&h);
            try_lattice(&h, effort.stride);
        }
        for (int i = 0; i < effort.batches; i++) try_random(&h, i);
        for (int i = 0; i < effort.generations; i++) climb(&h);
        keep_worst(&h, found);
    }
}
