/* Batches at random of which some streams are packed, some floats, some one value, some the material's numbers. Strict
 * bytes are those of the scalar kernel over unpacked floats, and fast ones those of the same kernel over them where
 * nothing is unpacked that may fuse; in every tier a sample's are those that it has alone. Nothing beside is read or
 * written. */
#include "packed.h"

#include "bits.h"
#include "guarded.h"
#include "half.h"
#include "harness.h"
#include "packed_mix.h"
#include "targets.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* ---- Batches over a mix ------------------------------------------------------------------------------------------ */

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

/* The fast tier unpacks vectors with fused operations, and the plan derives from its numbers without. */
static bool is_that_of_floats(const mix *m)
{
    const uint32_t vectors = FACET_STREAM_NORMAL | FACET_STREAM_VIEW;
    return m->target.tier == FACET_TIER_STRICT || (!(m->packed & vectors) && m->promised == m->set->reads);
}

/* From floats, strictly by the scalar kernel where there is one, else by the mix's own. */
static void shade_floats(const mix *m, outcome *o)
{
    facet_plan plan;
    facet_error error;
    places p = { .visibility = m->visibility, .coverage = m->covered_by_bits ? m->coverage : NULL, .count = m->count,
                 .invalid = m->counted ? &o->invalid : NULL };
    const facet_material material = material_of(m, m->set->reads);
    facet_target target = m->target;
    if (target.tier == FACET_TIER_STRICT && facet_has(FACET_KIND_ARCH, FACET_ARCH_SCALAR))
        target.arch = FACET_ARCH_SCALAR;
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
             "sample %zu of %zu, models %s, packed %05x, promised %05x, uniform %05x, %s%s%zu lights, width %u",
             i, m->count, m->set->name, (unsigned)m->packed, (unsigned)m->promised, (unsigned)m->uniform,
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
    const bool floats = is_that_of_floats(m);
    const float *const radiance[3] = { want.radiance[0], want.radiance[1], want.radiance[2] };
    facet_plan plan;
    const facet_material material = material_of(m, m->promised);
    facet_error error;
    facet_plan_init(&plan, &material, m->target, &error);
    if (!expect(!error.code, "%s is refused; %s", error.field, words_of(m, 0))) return;
    if (floats) shade_floats(m, &want);
    shade_each(m, &plan, floats ? &alone : &want);

    lay_out(r, m, &l);
    for (size_t i = 0; i < m->count; i++) {
        if (!is_covered(m, i)) continue;
        set_right(m, &l, radiance, i);
        for (int c = 0; c < 3 && floats; c++)
            expect(to_bits(alone.radiance[c][i]) == to_bits(want.radiance[c][i]), "alone %a, from floats %a; %s",
                   (double)alone.radiance[c][i], (double)want.radiance[c][i], words_of(m, i));
    }
    call c = { &plan, packed_batch(m, &l.p), { FACET_OK, NULL, -1 } };
    const char *fault = fault_of(shade, &c);
    expect(!fault, "%s; %s", fault, words_of(m, 0));
    expect(!c.error.code, "%s is refused; %s", c.error.field, words_of(m, 0));
    expect(l.invalid == want.invalid && (!floats || alone.invalid == want.invalid), "%zu invalid, not %zu; %s",
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
