/* Shading for the stability tests. */
#include "subject.h"

#include <math.h>
#include <string.h>

static void expect_radiance(const subject *u, const rgb radiance, int index)
{
    for (int c = 0; c < 3; c++)
        expect(isfinite(radiance[c]) && !signbit(radiance[c]), "%s: sample %d is %a", u->kernel->name, index,
               (double)radiance[c]);
}

static bool is_covered(const extras *x, int index)
{
    return !x->coverage || x->coverage[index / 8] >> index % 8 & 1;
}

/* What the streams of another convention are made of. */
static void alias_sources(facet_batch *b)
{
    for (int c = 0; c < 3; c++) b->base[c] = b->albedo[c];
    b->metallic = b->f0[0];
    b->specular_level = b->f0[1];
    b->roughness = b->glossiness = b->alpha;
}

/* Shades `s` as it stands. `out` is the destination that FACET_ACCUMULATE reads, and takes the result. */
static size_t shade_batch(const subject *u, const facet_plan *plan, const extras *x, const sample *s, int count,
                          rgb *out)
{
    size_t invalid = 0;
    facet_error error;
    sample_batch b = batch_of(s, count);
    const facet_light sun = { .direction = { 0.48f, 0.6f, 0.64f }, .irradiance = { 1, 2, 3 } };
    facet_light light = x->sun ? sun : b.batch.lights[0];
    light.visibility = x->visibility;
    b.batch.lights = &light;
    alias_sources(&b.batch);
    memcpy(b.batch.ambient, x->ambient, sizeof x->ambient);
    memcpy(b.batch.sh, x->sh, sizeof x->sh);
    b.batch.occlusion = x->occlusion;
    b.batch.coverage = x->coverage;
    b.batch.flags = x->flags;
    b.batch.invalid = x->uncounted ? NULL : &invalid;
    for (int i = 0; i < count; i++)
        for (int c = 0; c < 3; c++) b.batch.radiance[c][i] = out[i][c];
    const facet_status status = facet_shade(plan, &b.batch, &error);
    expect(!status, "%s: refused: %s", u->kernel->name, error.field);
    for (int i = 0; i < count; i++)
        for (int c = 0; c < 3; c++) out[i][c] = b.batch.radiance[c][i];
    free_batch(&b);
    return invalid;
}

/* The same with other samples before and behind, so many that a kernel sees nothing of the batch's ends. */
enum { BEFORE = MOST, ALL = 3 * MOST };

static const sample *other_samples(void)
{
    static sample all[ALL];
    test_random random = { 8 };
    for (int i = 0; i < ALL && all[ALL - 1].alpha == 0; i++) all[i] = random_sample(&random, SAMPLES_UNIFORM, 0.05f, 1);
    return all;
}

static size_t shade_amidst(const subject *u, const facet_plan *plan, const extras *x, const sample *s, int count,
                           rgb *out)
{
    sample all[ALL];
    rgb radiance[ALL] = { { 0 } };
    float visibility[ALL], occlusion[ALL];
    uint8_t coverage[ALL / 8];
    extras amidst = *x;
    memcpy(all, other_samples(), sizeof all);
    memcpy(all + BEFORE, s, (size_t)count * sizeof *s);
    memcpy(radiance + BEFORE, out, (size_t)count * sizeof *out);
    for (int i = 0; i < ALL; i++) visibility[i] = occlusion[i] = 1;
    if (x->visibility) memcpy(visibility + BEFORE, x->visibility, (size_t)count * sizeof *visibility);
    if (x->occlusion) memcpy(occlusion + BEFORE, x->occlusion, (size_t)count * sizeof *occlusion);
    memset(coverage, 0xff, sizeof coverage);
    if (x->coverage) memcpy(coverage + BEFORE / 8, x->coverage, ((size_t)count + 7) / 8);
    if (x->visibility) amidst.visibility = visibility;
    if (x->occlusion) amidst.occlusion = occlusion;
    if (x->coverage) amidst.coverage = coverage;
    const size_t invalid = shade_batch(u, plan, &amidst, all, ALL, radiance);
    memcpy(out, radiance + BEFORE, (size_t)count * sizeof *out);
    return invalid;
}

/* Under one light for all, where nobody counts, kernels take what shows in the result for granted: the same bytes. */
static void expect_same_uncounted(const subject *u, const facet_plan *plan, const extras *x, const sample *s, int count,
                                  const rgb *destination)
{
    extras counted = *x, uncounted;
    rgb want[MOST], got[MOST];
    memcpy(want, destination, (size_t)count * sizeof *want);
    memcpy(got, destination, (size_t)count * sizeof *got);
    counted.sun = true;
    uncounted = counted;
    uncounted.uncounted = true;
    shade_amidst(u, plan, &counted, s, count, want);
    shade_amidst(u, plan, &uncounted, s, count, got);
    expect_same(u, got, want, count, "uncounted");
}

size_t shade_material(const subject *u, const facet_material *m, const extras *x, const sample *s, int count, rgb *out)
{
    static const extras none;
    facet_plan plan;
    facet_error error;
    facet_material material = *m;
    rgb amidst[MOST];
    if (!x) x = &none;
    memcpy(material.emission, x->emission, sizeof x->emission);
    const facet_status status = facet_plan_init(&plan, &material, u->target, &error);
    if (!expect(!status, "%s: no plan: %s", u->kernel->name, error.field)) return 0;

    if (!(x->flags & FACET_ACCUMULATE) && !x->coverage) memset(out, 0, (size_t)count * sizeof *out);
    memcpy(amidst, out, (size_t)count * sizeof *out);
    if (!s->light) expect_same_uncounted(u, &plan, x, s, count, out);
    const size_t invalid = shade_batch(u, &plan, x, s, count, out);
    const size_t invalid_amidst = shade_amidst(u, &plan, x, s, count, amidst);
    expect(invalid_amidst == invalid, "%s: %zu invalid samples, but %zu amidst others", u->kernel->name, invalid,
           invalid_amidst);
    expect_same(u, amidst, out, count, "amidst others");
    for (int i = 0; i < count; i++)
        if (is_covered(x, i)) expect_radiance(u, out[i], i);
    return invalid;
}

facet_material streaming_material(const subject *u)
{
    facet_material material = u->kernel->material;
    material.streams = u->kernel->promised;
    return material;
}

bool has_specular(const subject *u) { return u->kernel->material.specular.model != FACET_DISTRIBUTION_NONE; }
bool has_diffuse(const subject *u) { return u->kernel->material.diffuse.model != FACET_DIFFUSE_NONE; }

size_t shade(const subject *u, const extras *x, const sample *s, int count, rgb *out)
{
    const facet_material material = streaming_material(u);
    return shade_material(u, &material, x, s, count, out);
}

void ordinary(const subject *u, sample *s, int count)
{
    test_random random = { 7 };
    for (int i = 0; i < count; i++) s[i] = random_sample(&random, SAMPLES_UNIFORM, 0.05f, u->kernel->sigma_max);
}

/* y x n or, where n is near y, z x n: exact where n is an axis. */
static void set_tangent(sample *s)
{
    const float *n = s->n;
    const bool along_y = fabsf(n[1]) > 0.9f;
    const float x = along_y ? -n[1] : n[2], y = along_y ? n[0] : 0, z = along_y ? 0 : -n[0];
    const float length = sqrtf(x * x + y * y + z * z);
    s->tangent[0] = x / length, s->tangent[1] = y / length, s->tangent[2] = z / length;
}

sample with_vectors(const float *n, const float *v, const float *l)
{
    sample s = { .albedo = { 0.8f, 0.5f, 0.2f }, .sigma = 0.4f, .alpha = 0.25f, .alpha_y = 0.375f, .exponent = 30,
                 .f0 = { 0.04f, 0.3f, 0.9f }, .eta = { 1.5f, 0.3f, 1.2f }, .k = { 0, 3, 0.5f },
                 .irradiance = { 3, 2, 1 } };
    memcpy(s.n, n, sizeof s.n);
    memcpy(s.v, v, sizeof s.v);
    memcpy(s.l, l, sizeof s.l);
    set_tangent(&s);
    return s;
}

void negate(float *vector)
{
    for (int c = 0; c < 3; c++) vector[c] = -vector[c];
}

void expect_same(const subject *u, const rgb *a, const rgb *b, int count, const char *what)
{
    for (int i = 0; i < count; i++)
        expect(!memcmp(a[i], b[i], sizeof(rgb)), "%s: %s: sample %d is %a %a %a, not %a %a %a", u->kernel->name, what,
               i, (double)a[i][0], (double)a[i][1], (double)a[i][2], (double)b[i][0], (double)b[i][1], (double)b[i][2]);
}

void expect_all(const subject *u, const rgb *radiance, int count, float value)
{
    expect_within(u, radiance, count, value, value);
}

void expect_within(const subject *u, const rgb *radiance, int count, float least, float most)
{
    for (int i = 0; i < count; i++)
        for (int c = 0; c < 3; c++)
            expect(radiance[i][c] >= least && radiance[i][c] <= most, "%s: sample %d is %a", u->kernel->name, i,
                   (double)radiance[i][c]);
}

void expect_dark(const subject *u, const sample *s, int count)
{
    static const extras glow = { .emission = { 1, 1, 1 } };
    rgb radiance[MOST];
    expect(shade(u, &glow, s, count, radiance) == 0, "%s: counted as invalid", u->kernel->name);
    expect_all(u, radiance, count, 1);
}

void expect_reference(const subject *u, const sample *s, int count, bool exact)
{
    const facet_material material = streaming_material(u);
    rgb radiance[MOST];
    shade(u, NULL, s, count, radiance);
    for (int i = 0; i < count; i++) {
        double want[3], magnitude[3];
        cosines cosine = reference_cosines(&s[i]);
        reference_terms(&material, &s[i], want, magnitude);
        if (exact) cosine.nl = 1;
        const double bound = bound_at(u->bound, &s[i], cosine, NULL);
        for (int c = 0; c < 3; c++) {
            const double error = error_over_magnitude(radiance[i][c], want[c], magnitude[c], s[i].irradiance[c]);
            expect(error <= bound, "%s: sample %d is %a, not %a: %.3g times the bound", u->kernel->name, i,
                   (double)radiance[i][c], want[c], error / bound);
        }
    }
}
