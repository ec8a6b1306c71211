/* cost: shades a batch of every case, at every target and two sizes, and prints a line for each call:
 *     CASE TIER ARCH SAMPLES
 * tests/cost.sh counts the instructions of the calls, in their order. The input is the same everywhere, the batch as
 * plain as the case can have it: a stream for all that it reads, one light, nothing else. Cases with an index of
 * refraction come a second time, as "CASE/numbers", with that of glass or gold as the material's: the fast tier fits
 * what such numbers give. */
#include "cases.h"

#include <stdio.h>

enum { FEW = 256, MANY = 512 };

typedef float stream[MANY];

static stream zeros, ones, numbers, normal[2], view[2], radiance[3];

/* 2t/(1 + t2), (1 - t2)/(1 + t2): on the unit circle. */
static void turn(stream *sine_cosine, int i, float t)
{
    sine_cosine[0][i] = 2.0f * t / (1.0f + t * t);
    sine_cosine[1][i] = (1.0f - t * t) / (1.0f + t * t);
}

static void fill(void)
{
    for (int i = 0; i < MANY; i++) {
        const float x = (float)(i * 37 % MANY) / (float)MANY, y = (float)(i * 101 % MANY) / (float)MANY;
        ones[i] = 1.0f;
        numbers[i] = 0.25f + 0.5f * x;
        turn(normal, i, 0.5f * y - 0.25f);
        turn(view, i, 1.5f * x - 0.75f);
    }
}

/* Normals in the plane of y and z, the eye in that of x and z. */
static facet_batch batch_of_numbers(void)
{
    facet_batch b = { .count = 0 };
#define POINT_1(field) b.field = numbers;
#define POINT_3(field) for (int c = 0; c < 3; c++) b.field[c] = numbers;
#define FACET_STREAM(id, field, components, ...) POINT_##components(field)
#include "streams.def"
    const float *const n[] = { zeros, normal[0], normal[1] }, *const v[] = { view[0], zeros, view[1] },
                *const t[] = { ones, zeros, zeros };
    for (int c = 0; c < 3; c++) {
        b.normal[c] = n[c];
        b.view[c] = v[c];
        b.tangent[c] = t[c];
        b.position[c] = zeros;
        b.radiance[c] = radiance[c];
    }
    b.occlusion = NULL;
    return b;
}

/* What a case comes as: its streams, or "/numbers". */
static facet_material material_of(const kernel_case *c, bool numbers_of_media)
{
    static const float gold_eta[] = { 0.14f, 0.38f, 1.45f }, gold_k[] = { 3.9f, 2.6f, 1.9f };
    facet_material m = c->material;
    m.streams = c->promised;
    if (!numbers_of_media) return m;
    m.streams &= ~(uint32_t)(FACET_STREAM_ETA | FACET_STREAM_K);
    for (int i = 0; i < 3; i++) {
        const bool metal = m.fresnel.model == FACET_FRESNEL_CONDUCTOR;
        m.fresnel.eta[i] = metal ? gold_eta[i] : 1.5f;
        m.fresnel.k[i] = metal ? gold_k[i] : 0.0f;
    }
    return m;
}

static bool shade(const kernel_case *c, bool numbers_of_media, facet_target target, size_t count)
{
    const char *const suffix = numbers_of_media ? "/numbers" : "";
    const char *const tier = facet_word(FACET_KIND_TIER, (int)target.tier);
    const char *const arch = facet_word(FACET_KIND_ARCH, (int)target.arch);
    const facet_material material = material_of(c, numbers_of_media);
    facet_light light = c->light;
    facet_batch batch = batch_of_numbers();
    facet_plan plan;
    facet_error error;
    light.direction[0] = 0.48f, light.direction[1] = 0.6f, light.direction[2] = 0.64f;
    light.irradiance[0] = light.irradiance[1] = light.irradiance[2] = 3.0f;
    batch.count = count;
    batch.lights = &light;
    batch.light_count = 1;
    if (facet_plan_init(&plan, &material, target, &error) || facet_shade(&plan, &batch, &error)) {
        fprintf(stderr, "facet-cost: %s%s %s %s: refused: %s\n", c->name, suffix, tier, arch, error.field);
        return false;
    }
    printf("%s%s %s %s %zu\n", c->name, suffix, tier, arch, count);
    return true;
}

static bool shade_case(const kernel_case *c, bool numbers_of_media)
{
    for (int tier = 0; facet_word(FACET_KIND_TIER, tier); tier++)
        for (int arch = FACET_ARCH_BEST + 1; facet_word(FACET_KIND_ARCH, arch); arch++) {
            const facet_target target = { .arch = (facet_arch)arch, .tier = (facet_tier)tier };
            if (!facet_has(FACET_KIND_ARCH, arch) || !facet_has(FACET_KIND_TIER, tier)) continue;
            if (!shade(c, numbers_of_media, target, FEW) || !shade(c, numbers_of_media, target, MANY)) return false;
        }
    return true;
}

int main(void)
{
    fill();
    for (int i = 0; i < case_count(); i++) {
        const kernel_case *c = case_at(i);
        if (!shade_case(c, false)) return 1;
        if (c->streams & FACET_STREAM_ETA && !shade_case(c, true)) return 1;
    }
    return 0;
}
