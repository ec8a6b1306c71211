/* A material, its plans and batches, for what depends on every number. */
#include "api.h"

#include "harness.h"

#include <stdlib.h>
#include <string.h>

facet_material rich_material(void)
{
    return (facet_material){
        .diffuse = { FACET_DIFFUSE_OREN_NAYAR, { 0.8f, 0.5f, 0.25f }, 0.5f },
        .specular = { FACET_DISTRIBUTION_GGX, FACET_MASKING_SMITH_CORRELATED, 0.25f, 0.5f, 30.5f, 0.75f },
        .fresnel = { FACET_FRESNEL_SCHLICK, { 0.04f, 0.05f, 0.06f }, 0.9f, { 0.7f, 0.8f, 0.9f }, { 1.5f, 1.6f, 1.7f },
                     { 0.5f, 0.4f, 0.3f }, 1.25f, -0.3f },
        .convention = { FACET_CONVENTION_DIRECT, { 0.9f, 0.6f, 0.3f }, 0.4f, 0.6f, 0.7f, 0.55f },
        .coupled = true,
        .emission = { 0.1f, 0.2f, 0.3f },
    };
}

facet_plan make_plan(const facet_material *m, facet_target target)
{
    facet_plan plan;
    expect(facet_plan_init(&plan, m, target, NULL) == FACET_OK, "a good material is refused");
    return plan;
}

sample_batch random_batch(int count, uint64_t seed)
{
    test_random r = { seed };
    sample *samples = calloc((size_t)count, sizeof *samples);
    if (!samples) abort();
    for (int i = 0; i < count; i++) samples[i] = random_sample(&r, i % SAMPLES_KINDS, 0.01f, 1.5f);
    sample_batch b = batch_of(samples, count);
    for (int c = 0; c < 3; c++) {
        memset(b.batch.radiance[c], 0, (size_t)count * sizeof(float));
        b.batch.base[c] = b.batch.albedo[c];
    }
    b.batch.metallic = b.batch.f0[0];
    b.batch.roughness = b.batch.glossiness = b.batch.alpha;
    b.batch.specular_level = b.batch.f0[1];
    b.batch.occlusion = b.batch.f0[2];
    free(samples);
    return b;
}

bool same_radiance(const facet_batch *a, const facet_batch *b)
{
    bool same = true;
    for (int c = 0; c < 3; c++) same = same && !memcmp(a->radiance[c], b->radiance[c], a->count * sizeof(float));
    return same;
}
