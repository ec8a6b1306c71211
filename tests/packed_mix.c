/* Drawing what packed_mixes.c shades. */
#include "packed_mix.h"

#include "packed.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define OREN_NAYAR      { .model = FACET_DIFFUSE_OREN_NAYAR }
#define GGX             { .model = FACET_DISTRIBUTION_GGX }
#define DIRECT_STREAMS                                                                                                \
    (FACET_STREAM_ALBEDO | FACET_STREAM_SIGMA | FACET_STREAM_ALPHA | FACET_STREAM_F0)
#define HALF_PI         0x1.921fb6p0f

static const model_set sets[] = {
    { "plain", { .diffuse = OREN_NAYAR, .specular = GGX }, DIRECT_STREAMS, HALF_PI },
    { "coupled", { .diffuse = OREN_NAYAR, .specular = GGX, .coupled = true }, DIRECT_STREAMS, HALF_PI },
    { "lambert", { .diffuse = { .model = FACET_DIFFUSE_LAMBERT } }, FACET_STREAM_ALBEDO, 0 },
    { "metallic",
      { .diffuse = OREN_NAYAR, .specular = GGX, .convention = { .model = FACET_CONVENTION_METALLIC_ROUGHNESS } },
      FACET_STREAM_BASE | FACET_STREAM_METALLIC | FACET_STREAM_ROUGHNESS | FACET_STREAM_SPECULAR_LEVEL
      | FACET_STREAM_SIGMA, HALF_PI },
    { "glossy",
      { .diffuse = OREN_NAYAR, .specular = GGX, .convention = { .model = FACET_CONVENTION_SPECULAR_GLOSSINESS } },
      FACET_STREAM_ALBEDO | FACET_STREAM_F0 | FACET_STREAM_GLOSSINESS | FACET_STREAM_SIGMA, HALF_PI },
    { "fujii", { .diffuse = { .model = FACET_DIFFUSE_FUJII }, .specular = GGX }, DIRECT_STREAMS, 1 },
    { "dielectric", { .diffuse = OREN_NAYAR, .specular = GGX, .fresnel = { .model = FACET_FRESNEL_DIELECTRIC } },
      DIRECT_STREAMS, HALF_PI },
    { "anisotropic", { .diffuse = OREN_NAYAR, .specular = { .model = FACET_DISTRIBUTION_GGX_ANISOTROPIC } },
      DIRECT_STREAMS | FACET_STREAM_ALPHA_Y, HALF_PI },
};
enum { SETS = sizeof sets / sizeof sets[0] };

uint64_t below(test_random *r, uint64_t n) { return random_u64(r) % n; }
bool one_in(test_random *r, uint64_t n) { return below(r, n) == 0; }

static int16_t random_snorm(test_random *r)
{
    static const int16_t edges[] = { 0, 1, -1, 32767, -32767, -32768, 16383, 16384, -16383, -16384 };
    return one_in(r, 3) ? edges[below(r, sizeof edges / sizeof edges[0])] : (int16_t)random_u64(r);
}

static uint8_t random_byte(test_random *r)
{
    return one_in(r, 6) ? 0 : one_in(r, 6) ? 255 : (uint8_t)random_u64(r);
}

static void draw_words(test_random *r, mix *m)
{
    for (size_t i = 0; i < m->count; i++) {
        int16_t normal[2] = { random_snorm(r), random_snorm(r) };
        if (one_in(r, 6)) normal[1] = (int16_t)(32767 - abs(normal[0] % 32767));          /* on the fold */
        memcpy(&m->words[NORMALS][4 * i], normal, sizeof normal);
        for (size_t c = 0; c < 4; c++)
            for (int k = ALBEDO_ROUGHNESS; k <= F0_SIGMA; k++) m->words[k][4 * i + c] = random_byte(r);
    }
    m->words[F0_SIGMA][0] |= 1;          /* as a number, an f0 of 0 would not stand for itself */
}

/* Now and then far too large or too small, or with a ray of 0. */
static void draw_camera(test_random *r, mix *m)
{
    const double scale = one_in(r, 4) ? pow(10, (double)below(r, 60) - 30) : 1;
    facet_camera *c = &m->camera;
    *c = (facet_camera){ .x = (uint32_t)below(r, 2000), .y = (uint32_t)below(r, 2000) };
    if (!one_in(r, 4)) c->width = 1 + (uint32_t)below(r, one_in(r, 2) ? 20 : 2 * MOST);
    for (int k = 0; k < 3; k++) {
        c->across[k] = (float)((random_unit(r) - 0.5) * 1e-3 * scale);
        c->down[k] = (float)((random_unit(r) - 0.5) * 1e-3 * scale);
        c->corner[k] = (float)((random_unit(r) - 0.5) * scale);
    }
    if (!one_in(r, 8)) return;
    *c = (facet_camera){ .corner = { -(float)c->x - 1, -(float)c->y, 0 }, .across = { 1, 0, 0 }, .down = { 0, 1, 0 },
                         .x = c->x, .y = c->y, .width = c->width };
}

/* What the packed numbers are in floats; the rest at random. */
static void draw_values(test_random *r, mix *m)
{
    for (int c = 0; c < LIGHT_AT; c++)
        for (size_t i = 0; i < m->count; i++) m->values[c][i] = (float)(0.1 + 0.8 * random_unit(r));
    for (size_t i = 0; i < m->count; i++) {
        float n[3], v[3];
        int16_t word[2];
        memcpy(word, &m->words[NORMALS][4 * i], sizeof word);
        unpack_normal(word, n);
        unpack_view(&m->camera, i, v);
        const uint8_t *a = &m->words[ALBEDO_ROUGHNESS][4 * i], *f = &m->words[F0_SIGMA][4 * i];
        const float roughness = unpack_unorm8(a[3]);
        for (int c = 0; c < 3; c++) {
            m->values[AT_NORMAL + c][i] = n[c];
            m->values[AT_VIEW + c][i] = v[c];
            m->values[AT_ALBEDO + c][i] = m->values[AT_BASE + c][i] = unpack_unorm8(a[c]);
            m->values[AT_F0 + c][i] = unpack_unorm8(f[c]);
        }
        m->values[AT_ALPHA][i] = roughness * roughness;
        m->values[AT_ROUGHNESS][i] = roughness;
        m->values[AT_GLOSSINESS][i] = 1 - roughness;
        m->values[AT_SIGMA][i] = unpack_unorm8(f[3]) * m->set->sigma_max;
        m->visibility[i] = (float)random_unit(r);
    }
}

bool is_per_sample(const mix *m, int stream)
{
    const uint32_t bit = inputs[stream].bit;
    return !(m->uniform & ~m->packed & bit) && (!is_parameter(stream) || m->promised & bit);
}

/* What is not per sample has one value; now and then a value of a stream of floats is no number, or 0. */
static void bend_values(test_random *r, mix *m)
{
    static const float odd[] = { NAN, INFINITY, -INFINITY, 0, -0.0f, -1, 1e30f };
    for (int s = 0; s < BATCH_STREAMS; s++)
        for (int c = inputs[s].first; c < inputs[s].first + inputs[s].components; c++)
            for (size_t i = 0; i < m->count; i++) {
                if (!is_per_sample(m, s)) m->values[c][i] = m->values[c][0];
                else if (!(m->packed & inputs[s].bit) && one_in(r, 300)) m->values[c][i] = odd[below(r, 7)];
            }
}

static void draw_lights(test_random *r, mix *m)
{
    static const facet_light kinds[MOST_PACKED_LIGHTS] = {
        { .direction = { 0.48f, 0.6f, 0.64f }, .irradiance = { 3, 2, 1 } },
        { .kind = FACET_LIGHT_POINT, .position = { 1, 2, -1.5f }, .irradiance = { 5, 6, 7 }, .range = 9 },
        { .direction = { -0.8f, 0, 0.6f }, .irradiance = { 1, 40, 900 } },
    };
    memcpy(m->lights, kinds, sizeof kinds);
    m->common.light_count = one_in(r, 3) ? (size_t)below(r, 1 + MOST_PACKED_LIGHTS) : 1;
    if (one_in(r, 2)) return;
    for (int c = 0; c < 3; c++) {
        m->common.ambient[c] = (float)random_unit(r);
        for (int k = 0; k < 4; k++) m->common.sh[k][c] = one_in(r, 2) ? (float)random_unit(r) - 0.5f : 0;
    }
}

void draw_mix(test_random *r, mix *m, facet_target target)
{
    const uint64_t size = below(r, 16);
    m->target = target;
    do m->set = &sets[below(r, SETS)];
    while (!facet_has(FACET_KIND_DIFFUSE, (int)m->set->models.diffuse.model)
           || !facet_has(FACET_KIND_DISTRIBUTION, (int)m->set->models.specular.model)
           || !facet_has(FACET_KIND_FRESNEL, (int)m->set->models.fresnel.model));
    m->count = size == 0 ? (size_t)below(r, MOST + 1) : (size_t)below(r, 201);
    m->promised = m->set->reads & (one_in(r, 3) ? ~0u : (uint32_t)random_u64(r));
    m->packed = one_in(r, 3) ? ~0u : 0;
    if (one_in(r, 2)) m->packed ^= FACET_STREAM_NORMAL;
    if (one_in(r, 2)) m->packed ^= FACET_STREAM_VIEW;
    if (one_in(r, 2)) m->packed ^= ALBEDO_ROUGHNESS_STREAMS;
    if (one_in(r, 2)) m->packed ^= F0_SIGMA_STREAMS;
    m->packed &= FACET_STREAM_NORMAL | FACET_STREAM_VIEW
               | (m->promised & (ALBEDO_ROUGHNESS_STREAMS | F0_SIGMA_STREAMS));
    m->uniform = one_in(r, 2) ? 0 : (uint32_t)random_u64(r) & ((1u << BATCH_STREAMS) - 1);
    m->has_view = m->packed & FACET_STREAM_VIEW || m->set->sigma_max > 0 || one_in(r, 2);
    m->halves = one_in(r, 2), m->pixels = one_in(r, 2), m->over_input = one_in(r, 3), m->counted = one_in(r, 2);
    m->covered_by_bits = one_in(r, 3);
    for (size_t i = 0; i < sizeof m->coverage; i++) m->coverage[i] = one_in(r, 2) ? 0xff : (uint8_t)random_u64(r);
    m->common = (facet_batch){ .flags = m->has_view && one_in(r, 4) ? FACET_TWO_SIDED : 0 };
    m->common.packed.exposure = one_in(r, 2) ? 0 : (float)(4 * random_unit(r));
    draw_words(r, m);
    draw_camera(r, m);
    draw_values(r, m);
    bend_values(r, m);
    draw_lights(r, m);
}
