/* Batches at random of which some streams are packed, some floats, some one value, some the material's numbers. Strict
 * bytes are those of the scalar kernel over unpacked floats; in every tier a sample's are those that it has alone.
 * Nothing beside is read or written. */
#include "packed.h"

#include "bits.h"
#include "guarded.h"
#include "half.h"
#include "harness.h"
#include "inputs.h"
#include "targets.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { NORMALS, ALBEDO_ROUGHNESS, F0_SIGMA, PACKED };
enum { MOST = 1500, MOST_PACKED_LIGHTS = 3 };

#define ALBEDO_ROUGHNESS_STREAMS                                                                                      \
    ((uint32_t)(FACET_STREAM_ALBEDO | FACET_STREAM_BASE | FACET_STREAM_ALPHA | FACET_STREAM_ROUGHNESS                 \
                | FACET_STREAM_GLOSSINESS))
#define F0_SIGMA_STREAMS ((uint32_t)(FACET_STREAM_F0 | FACET_STREAM_SIGMA))

/* ---- What is drawn ----------------------------------------------------------------------------------------------- */

/* Models, and the streams that they read of the material. */
typedef struct { facet_material models; uint32_t reads; float sigma_max; } model_set;

#define OREN_NAYAR      { .model = FACET_DIFFUSE_OREN_NAYAR }
#define GGX             { .model = FACET_DISTRIBUTION_GGX }
#define DIRECT_STREAMS                                                                                                \
    (FACET_STREAM_ALBEDO | FACET_STREAM_SIGMA | FACET_STREAM_ALPHA | FACET_STREAM_F0)
#define HALF_PI         0x1.921fb6p0f

static const model_set sets[] = {
    { { .diffuse = OREN_NAYAR, .specular = GGX }, DIRECT_STREAMS, HALF_PI },
    { { .diffuse = OREN_NAYAR, .specular = GGX, .coupled = true }, DIRECT_STREAMS, HALF_PI },
    { { .diffuse = { .model = FACET_DIFFUSE_LAMBERT } }, FACET_STREAM_ALBEDO, 0 },
    { { .diffuse = OREN_NAYAR, .specular = GGX, .convention = { .model = FACET_CONVENTION_METALLIC_ROUGHNESS } },
      FACET_STREAM_BASE | FACET_STREAM_METALLIC | FACET_STREAM_ROUGHNESS | FACET_STREAM_SPECULAR_LEVEL
      | FACET_STREAM_SIGMA, HALF_PI },
    { { .diffuse = OREN_NAYAR, .specular = GGX, .convention = { .model = FACET_CONVENTION_SPECULAR_GLOSSINESS } },
      FACET_STREAM_ALBEDO | FACET_STREAM_F0 | FACET_STREAM_GLOSSINESS | FACET_STREAM_SIGMA, HALF_PI },
    { { .diffuse = { .model = FACET_DIFFUSE_FUJII }, .specular = GGX }, DIRECT_STREAMS, 1 },
    { { .diffuse = OREN_NAYAR, .specular = GGX, .fresnel = { .model = FACET_FRESNEL_DIELECTRIC } }, DIRECT_STREAMS,
      HALF_PI },
    { { .diffuse = OREN_NAYAR, .specular = { .model = FACET_DISTRIBUTION_GGX_ANISOTROPIC } },
      DIRECT_STREAMS | FACET_STREAM_ALPHA_Y, HALF_PI },
};
enum { SETS = sizeof sets / sizeof sets[0] };

typedef struct {
    facet_target target;
    const model_set *set;
    size_t count;
    uint32_t promised, packed, uniform;          /* FACET_STREAM_*; what is neither packed nor uniform is per sample */
    bool has_view, halves, pixels, over_input, counted;
    facet_camera camera;
    facet_light lights[MOST_PACKED_LIGHTS];
    facet_batch common;                          /* lights, ambient, sh, flags, exposure */
    float values[LIGHT_AT][MOST], visibility[MOST];       /* what each sample has */
    uint8_t words[PACKED][4 * MOST], coverage[MOST / 8 + 1];
    bool covered_by_bits;
} mix;

static uint64_t below(test_random *r, uint64_t n) { return random_u64(r) % n; }
static bool one_in(test_random *r, uint64_t n) { return below(r, n) == 0; }

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

static bool is_per_sample(const mix *m, int stream)
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
    m->common.light_count = one_in(r, 3) ? below(r, 1 + MOST_PACKED_LIGHTS) : 1;
    if (one_in(r, 2)) return;
    for (int c = 0; c < 3; c++) {
        m->common.ambient[c] = (float)random_unit(r);
        for (int k = 0; k < 4; k++) m->common.sh[k][c] = one_in(r, 2) ? (float)random_unit(r) - 0.5f : 0;
    }
}

static void draw_mix(test_random *r, mix *m, facet_target target)
{
    const uint64_t size = below(r, 16);
    m->target = target;
    do m->set = &sets[below(r, SETS)];
    while (!facet_has(FACET_KIND_DIFFUSE, (int)m->set->models.diffuse.model)
           || !facet_has(FACET_KIND_DISTRIBUTION, (int)m->set->models.specular.model)
           || !facet_has(FACET_KIND_FRESNEL, (int)m->set->models.fresnel.model));
    m->count = size == 0 ? below(r, MOST + 1) : below(r, 201);
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

/* ---- Batches over it --------------------------------------------------------------------------------------------- */

/* Where everything stands; NULL: nowhere. */
typedef struct {
    const float *values[LIGHT_AT], *visibility;
    const uint8_t *words[PACKED], *coverage;
    facet_camera camera;
    float *radiance[3];
    uint16_t *half[3];
    uint8_t *pixels;
    facet_light lights[MOST_PACKED_LIGHTS];
    size_t count, *invalid;
} places;

/* Materials whose promises are those of the batch over packed streams; or that have all per sample. */
static facet_material material_of(const mix *m, uint32_t promised)
{
    facet_material material = m->set->models;
    material.streams = promised;
    for (int s = 0; s < BATCH_STREAMS; s++)
        if (m->set->reads & ~promised & inputs[s].bit)
            for (int c = 0; c < inputs[s].components; c++)
                memcpy((char *)&material + inputs[s].number + (size_t)c * sizeof(float),
                       &m->values[inputs[s].first + c][0], sizeof(float));
    return material;
}

/* In floats, every parameter per sample; what a batch need not have is left out. */
static facet_batch float_batch(const mix *m, places *p)
{
    facet_batch b = m->common;
    b.packed = (facet_packed){ .normal = NULL };
    b.count = p->count;
    for (int s = 0; s < BATCH_STREAMS; s++) {
        if (s == STREAM_VIEW && !m->has_view) continue;
        for (int c = 0; c < inputs[s].components; c++)
            memcpy((char *)&b + inputs[s].batch + (size_t)c * sizeof(float *), &p->values[inputs[s].first + c],
                   sizeof(float *));
    }
    memcpy(p->lights, m->lights, sizeof p->lights);
    p->lights[1].visibility = p->visibility;
    b.lights = p->lights;
    b.coverage = p->coverage;
    b.invalid = p->invalid;
    for (int c = 0; c < 3; c++) b.radiance[c] = p->radiance[c];
    return b;
}

static facet_batch packed_batch(const mix *m, places *p)
{
    facet_batch b = float_batch(m, p);
    b.uniform = m->uniform;
    for (int s = 0; s < BATCH_STREAMS; s++)
        for (int c = 0; c < inputs[s].components && m->packed & inputs[s].bit; c++)
            memset((char *)&b + inputs[s].batch + (size_t)c * sizeof(float *), 0, sizeof(float *));
    if (m->packed & FACET_STREAM_NORMAL) b.packed.normal = (const int16_t *)(const void *)p->words[NORMALS];
    if (m->packed & FACET_STREAM_VIEW) b.packed.camera = &p->camera;
    if (m->packed & ALBEDO_ROUGHNESS_STREAMS) b.packed.albedo_roughness = p->words[ALBEDO_ROUGHNESS];
    if (m->packed & F0_SIGMA_STREAMS) b.packed.f0_sigma = p->words[F0_SIGMA];
    for (int c = 0; c < 3; c++) b.packed.half[c] = p->half[c];
    b.packed.pixels = p->pixels;
    b.packed.exposure = m->common.packed.exposure;
    return b;
}

typedef struct { const facet_plan *plan; facet_batch batch; facet_error error; } call;

static void shade(void *argument)
{
    call *c = argument;
    facet_shade(c->plan, &c->batch, &c->error);
}

/* ---- What it should be ------------------------------------------------------------------------------------------- */

typedef struct { float radiance[3][MOST]; size_t invalid; } outcome;

static bool is_covered(const mix *m, size_t i) { return !m->covered_by_bits || m->coverage[i / 8] >> i % 8 & 1; }

/* By the scalar strict kernel from floats. */
static void shade_floats(const mix *m, outcome *o)
{
    facet_plan plan;
    facet_error error;
    places p = { .visibility = m->visibility, .coverage = m->covered_by_bits ? m->coverage : NULL, .count = m->count,
                 .invalid = m->counted ? &o->invalid : NULL };
    const facet_material material = material_of(m, m->set->reads);
    const facet_target target = { .arch = FACET_ARCH_SCALAR, .tier = FACET_TIER_STRICT };
    for (int c = 0; c < LIGHT_AT; c++) p.values[c] = m->values[c];
    for (int c = 0; c < 3; c++) p.radiance[c] = o->radiance[c];
    o->invalid = 0;
    facet_plan_init(&plan, &material, target, &error);
    const facet_batch b = float_batch(m, &p);
    if (!error.code) facet_shade(&plan, &b, &error);
    expect(!error.code, "floats: %s is refused", error.field);
}

static void encode(const mix *m, const float *const radiance[3], size_t i, uint8_t pixel[4])
{
    const facet_image image = { .width = 1, .height = 1, .exposure = m->common.packed.exposure, .pixels = pixel,
                                .radiance = { radiance[0] + i, radiance[1] + i, radiance[2] + i } };
    expect(facet_encode(&image, NULL) == FACET_OK, "facet_encode refuses");
}

/* ---- Memory ------------------------------------------------------------------------------------------------------ */

/* One piece for each stream, with a copy of what should be there. */
enum { AT_WORDS = LIGHT_AT, AT_VISIBILITY = AT_WORDS + PACKED, AT_COVERAGE, AT_HALF, AT_PIXELS = AT_HALF + 3,
       AT_OUT, PIECES = AT_OUT + 3 };
static struct { guarded memory; uint8_t *right; } pieces[PIECES];

static size_t length_of(int piece) { return (size_t)(pieces[piece].memory.end - pieces[piece].memory.first); }

/* `bytes` of a piece, at its start or its end. */
static uint8_t *take(test_random *r, int piece, const void *from, size_t bytes)
{
    const guarded *g = &pieces[piece].memory;
    uint8_t *at = one_in(r, 2) ? g->first : g->end - bytes;
    memset(g->first, 0xa5, length_of(piece));
    if (from) memcpy(at, from, bytes);
    return at;
}

static void *right_at(int piece, const void *at)
{
    return pieces[piece].right + ((const uint8_t *)at - pieces[piece].memory.first);
}

/* `out_piece`: where pixels or red go: a piece of their own or a packed input's. */
typedef struct { places p; int out_piece; size_t invalid; } layout;

static void lay_out_outputs(test_random *r, const mix *m, layout *l)
{
    const size_t n = m->count;
    const bool floats = !m->halves && !m->pixels;
    const int words_piece = AT_WORDS + (int)below(r, PACKED);
    for (int c = 0; c < 3 && m->halves; c++) l->p.half[c] = (void *)take(r, AT_HALF + c, NULL, 2 * n);
    for (int c = 0; c < 3 && floats; c++) l->p.radiance[c] = (void *)take(r, AT_OUT + c, NULL, n * sizeof(float));
    if (m->pixels) l->p.pixels = take(r, AT_PIXELS, NULL, 4 * n);
    l->out_piece = floats ? AT_OUT : AT_PIXELS;
    if (!m->over_input) return;
    l->out_piece = words_piece;
    const guarded *g = &pieces[words_piece].memory;
    uint8_t *words = g->first + (l->p.words[words_piece - AT_WORDS] - g->first);
    if (m->pixels) l->p.pixels = words;
    if (floats) l->p.radiance[0] = (void *)words;
}

static void lay_out(test_random *r, const mix *m, layout *l)
{
    const size_t n = m->count;
    *l = (layout){ .p = { .camera = m->camera, .count = n, .invalid = m->counted ? &l->invalid : NULL } };
    for (int s = 0; s < BATCH_STREAMS; s++)
        for (int c = inputs[s].first; c < inputs[s].first + inputs[s].components; c++)
            l->p.values[c] = (void *)take(r, c, m->values[c], (is_per_sample(m, s) ? n : 1) * sizeof(float));
    for (int k = 0; k < PACKED; k++) l->p.words[k] = take(r, AT_WORDS + k, m->words[k], 4 * n);
    l->p.visibility = (void *)take(r, AT_VISIBILITY, m->visibility, n * sizeof(float));
    if (m->covered_by_bits) l->p.coverage = take(r, AT_COVERAGE, m->coverage, (n + 7) / 8);
    lay_out_outputs(r, m, l);
    for (int k = 0; k < PIECES; k++) memcpy(pieces[k].right, pieces[k].memory.first, length_of(k));
}

/* Puts a sample's radiance where it should be. */
static void set_right(const mix *m, const layout *l, const float *const radiance[3], size_t i)
{
    for (int c = 0; c < 3; c++) {
        const uint16_t half = nearest_half(radiance[c][i]);
        if (m->halves) memcpy(right_at(AT_HALF + c, l->p.half[c] + i), &half, sizeof half);
        if (!m->halves && !m->pixels)
            memcpy(right_at(c ? AT_OUT + c : l->out_piece, l->p.radiance[c] + i), &radiance[c][i], sizeof(float));
    }
    if (m->pixels) encode(m, radiance, i, right_at(l->out_piece, l->p.pixels + 4 * i));
}

static const char *words_of(const mix *m, size_t i)
{
    static char words[200];
    snprintf(words, sizeof words,
             "sample %zu of %zu, models %d, packed %05x, promised %05x, uniform %05x, %s%s%zu lights, width %u",
             i, m->count, (int)(m->set - sets), (unsigned)m->packed, (unsigned)m->promised, (unsigned)m->uniform,
             m->halves ? "halves, " : "", m->pixels ? "pixels, " : "", m->common.light_count,
             (unsigned)m->camera.width);
    return words;
}

/* ---- Tests ------------------------------------------------------------------------------------------------------- */

/* A sample alone, from the mix's own memory, in floats. Whether it counts as invalid. */
static size_t shade_alone(const mix *m, const facet_plan *plan, size_t i, float radiance[3][1])
{
    size_t invalid = 0;
    places p = { .visibility = m->visibility + i, .camera = m->camera, .count = 1, .invalid = &invalid };
    const size_t row = m->camera.width ? i / m->camera.width : 0;
    p.camera.x += (uint32_t)(i - row * m->camera.width);
    p.camera.y += (uint32_t)row;
    for (int c = 0; c < LIGHT_AT; c++) p.values[c] = m->values[c] + i;
    for (int k = 0; k < PACKED; k++) p.words[k] = m->words[k] + 4 * i;
    for (int c = 0; c < 3; c++) p.radiance[c] = radiance[c];
    call c = { plan, packed_batch(m, &p), { FACET_OK, NULL, -1 } };
    shade(&c);
    expect(!c.error.code, "alone, %s is refused", c.error.field);
    return invalid;
}

/* The samples' radiance, one by one, and how many were counted. */
static void shade_each(const mix *m, const facet_plan *plan, outcome *o)
{
    o->invalid = 0;
    for (size_t i = 0; i < m->count; i++) {
        float radiance[3][1];
        if (!is_covered(m, i)) continue;
        const size_t invalid = shade_alone(m, plan, i, radiance);
        if (m->counted) o->invalid += invalid;
        for (int c = 0; c < 3; c++) o->radiance[c][i] = radiance[c][0];
    }
}

static void check_memory(const mix *m)
{
    for (int k = 0; k < PIECES; k++) {
        const uint8_t *got = pieces[k].memory.first;
        size_t at = 0;
        if (!memcmp(got, pieces[k].right, length_of(k))) continue;
        while (got[at] == pieces[k].right[at]) at++;
        expect(false, "piece %d, byte %zu of %zu is %02x, not %02x; %s", k, at, length_of(k), got[at],
               pieces[k].right[at], words_of(m, 0));
    }
}

static void check_mix(test_random *r, const mix *m)
{
    static outcome want, alone;
    layout l;
    const bool strict = m->target.tier == FACET_TIER_STRICT;
    const float *const radiance[3] = { want.radiance[0], want.radiance[1], want.radiance[2] };
    facet_plan plan;
    const facet_material material = material_of(m, m->promised);
    facet_error error;
    facet_plan_init(&plan, &material, m->target, &error);
    if (!expect(!error.code, "%s is refused; %s", error.field, words_of(m, 0))) return;
    if (strict) shade_floats(m, &want);
    shade_each(m, &plan, strict ? &alone : &want);

    lay_out(r, m, &l);
    for (size_t i = 0; i < m->count; i++) {
        if (!is_covered(m, i)) continue;
        set_right(m, &l, radiance, i);
        for (int c = 0; c < 3 && strict; c++)
            expect(to_bits(alone.radiance[c][i]) == to_bits(want.radiance[c][i]), "alone %a, from floats %a; %s",
                   (double)alone.radiance[c][i], (double)want.radiance[c][i], words_of(m, i));
    }
    call c = { &plan, packed_batch(m, &l.p), { FACET_OK, NULL, -1 } };
    const char *fault = fault_of(shade, &c);
    expect(!fault, "%s; %s", fault, words_of(m, 0));
    expect(!c.error.code, "%s is refused; %s", c.error.field, words_of(m, 0));
    expect(l.invalid == want.invalid && (!strict || alone.invalid == want.invalid), "%zu invalid, not %zu; %s",
           l.invalid, want.invalid, words_of(m, 0));
    check_memory(m);
}

void test_packed_mixes(void)
{
    static mix m;
    const int rounds = test_slow_machine ? 60 : 1500;
    for (int k = 0; k < PIECES; k++) {
        pieces[k].memory = guarded_allocate(MOST * sizeof(float));
        pieces[k].right = malloc(length_of(k));
        if (!pieces[k].right) abort();
    }
    for (int i = 0; i < target_count(); i++) {
        test_random r = { 1 };
        test("%s: %d mixes of packed and other streams", target_words(target_at(i)), rounds);
        for (int k = 0; k < rounds; k++) {
            draw_mix(&r, &m, target_at(i));
            check_mix(&r, &m);
        }
    }
    for (int k = 0; k < PIECES; k++) {
        guarded_free(&pieces[k].memory);
        free(pieces[k].right);
    }
    skip_absent_targets();
}
