/* Batches so large that radiance goes past the caches: the bytes are those of small ones, wherever it stands. */
#include "packed.h"

#include "bits.h"
#include "harness.h"
#include "samples.h"
#include "targets.h"

#include <inttypes.h>
#include <stdlib.h>
#include <string.h>

enum { COUNT = (1 << 19) + 37, SMALL = 4096, MARGIN = 16, PERIOD = 1009 };
#define CANARY 0x7fa5a5a5u

/* Aligned; MARGIN floats before and behind the largest offset. */
static float *allocate(void)
{
    float *memory = aligned_alloc(64, (COUNT + 3 * MARGIN + 15) / 16 * 16 * sizeof(float));
    if (!memory) abort();
    return memory;
}

/* The same PERIOD samples again and again; some have no normal, or are lit by what is no number. */
static sample_batch many_samples(void)
{
    test_random r = { 12 };
    sample *all = calloc(COUNT, sizeof *all);
    if (!all) abort();
    for (int i = 0; i < PERIOD; i++) {
        all[i] = random_sample(&r, SAMPLES_UNIFORM, 0.05f, 1);
        if (random_u64(&r) % 64 == 0) memset(all[i].n, 0, sizeof all[i].n);
        if (random_u64(&r) % 64 == 0) all[i].irradiance[1] = from_bits(0x7fc00000);
    }
    for (int i = PERIOD; i < COUNT; i++) all[i] = all[i - PERIOD];
    const sample_batch b = batch_of(all, COUNT);
    free(all);
    return b;
}

/* The streams of a batch, from sample i on. */
static facet_batch part_of(const facet_batch *b, const facet_light *light, facet_light *own, size_t i, size_t count)
{
    facet_batch part = *b;
    *own = *light;
    for (int c = 0; c < 3; c++) {
        part.normal[c] += i, part.view[c] += i, part.albedo[c] += i, part.f0[c] += i, part.radiance[c] += i;
        if (own->direction_of[c]) own->direction_of[c] += i;
        if (own->irradiance_of[c]) own->irradiance_of[c] += i;
    }
    part.alpha += i, part.sigma += i;
    part.count = count;
    part.lights = own;
    return part;
}

static void shade(const facet_plan *plan, const facet_batch *b)
{
    expect(facet_shade(plan, b, NULL) == FACET_OK, "refused");
}

static void shade_in_parts(const facet_plan *plan, const facet_batch *b)
{
    for (size_t i = 0; i < COUNT; i += SMALL) {
        facet_light own;
        const facet_batch part = part_of(b, b->lights, &own, i, COUNT - i < SMALL ? COUNT - i : SMALL);
        shade(plan, &part);
    }
}

/* Radiance this far beyond a vector's alignment. */
static void check_places(const facet_plan *plan, facet_batch b, float *const out[3], const size_t offsets[3],
                         bool in_place)
{
    float *const want[3] = { b.radiance[0], b.radiance[1], b.radiance[2] };
    for (int c = 0; c < 3; c++) {
        const uint32_t canary = CANARY;
        for (size_t i = 0; i < COUNT + 3 * MARGIN; i++) memcpy(&out[c][i], &canary, sizeof canary);
        b.radiance[c] = out[c] + MARGIN + offsets[c];
        if (!in_place) continue;
        memcpy(b.radiance[c], b.normal[c], COUNT * sizeof(float));
        b.normal[c] = b.radiance[c];
    }
    shade(plan, &b);
    for (int c = 0; c < 3; c++) {
        const size_t first = MARGIN + offsets[c];
        bool kept = true;
        for (size_t i = 0; i < first; i++) kept = kept && to_bits(out[c][i]) == CANARY;
        for (size_t i = first + COUNT; i < COUNT + 3 * MARGIN; i++) kept = kept && to_bits(out[c][i]) == CANARY;
        expect(kept, "offset %zu%s: something beside was written", offsets[c], in_place ? " in place" : "");
        for (size_t i = 0; i < COUNT && memcmp(b.radiance[c], want[c], COUNT * sizeof(float)); i++)
            expect(to_bits(b.radiance[c][i]) == to_bits(want[c][i]), "offset %zu%s: sample %zu is %a, not %a",
                   offsets[c], in_place ? " in place" : "", i, (double)b.radiance[c][i], (double)want[c][i]);
    }
}

static void check_batch(const facet_plan *plan, const facet_batch *b, float *const out[3])
{
    static const size_t apart[][3] = { { 0, 0, 1 }, { 1, 2, 3 }, { 4, 0, 8 }, { 15, 15, 14 } };
    shade_in_parts(plan, b);
    for (size_t offset = 0; offset < MARGIN; offset++)
        check_places(plan, *b, out, (size_t[]){ offset, offset, offset }, offset % 2);
    for (size_t k = 0; k < sizeof apart / sizeof apart[0]; k++) check_places(plan, *b, out, apart[k], k % 2);
    check_places(plan, *b, out, (size_t[]){ 0, 0, 0 }, true);
}

void test_past_caches(void)
{
    static const facet_light sun = { .direction = { 0.48f, 0.6f, 0.64f }, .irradiance = { 1, 2, 3 } };
    const facet_material m = { .diffuse = { .model = FACET_DIFFUSE_OREN_NAYAR },
                               .specular = { .model = FACET_DISTRIBUTION_GGX },
                               .streams = FACET_STREAM_ALBEDO | FACET_STREAM_SIGMA | FACET_STREAM_ALPHA
                                        | FACET_STREAM_F0 };
    if (test_slow_machine) {
        test("radiance past the caches");
        skip("half a million samples, many times");
        return;
    }
    sample_batch all = many_samples();
    float *const out[3] = { allocate(), allocate(), allocate() };
    facet_batch plain = all.batch;
    plain.lights = &sun;
    for (int i = 0; i < target_count(); i++) {
        facet_plan plan;
        test("%s: radiance past the caches", target_words(target_at(i)));
        if (!expect(!facet_plan_init(&plan, &m, target_at(i), NULL), "refused")) continue;
        check_batch(&plan, &plain, out);
        check_batch(&plan, &all.batch, out);
    }
    for (int c = 0; c < 3; c++) free(out[c]);
    free_batch(&all);
}
