/* A block of a batch: which of its samples are covered, and floats in the place of what is uniform, derived from other
 * streams, or packed. */
#ifndef FACET_BLOCK_TMPL_H
#define FACET_BLOCK_TMPL_H

#include "group.tmpl.h"
#include "packed.tmpl.h"

/* Samples in a block, where parameters are derived from others, or streams are packed; where coverage is looked at, no
 * more than a uint64_t has bits. Packed streams into halves, of 128 in place of 64: 1.07 times as fast with AVX-512,
 * 1.05 AVX2; of 256, whose values do not fit into L1, 0.87. */
#define BLOCK (VF_LANES > 1 ? 128 : 16)

_Static_assert(BLOCK % GROUP == 0 && (BLOCK == 16 || BLOCK % 64 == 0), "a group is within a block");

/* A bit for each of 1 <= n <= 64 samples. */
#define ALL_SAMPLES(n) (~(uint64_t)0 >> (64 - (n)))

/* Up to BLOCK samples of a batch, all of one that needs no blocks, or one group that was mended. */
typedef struct {
    const float *const *component;
    const size_t *mask;
    float *radiance[3];
    size_t i, count;                     /* its first sample in the batch; its samples */
    uint64_t covered;                    /* a bit a sample, where not the whole block is */
    bool whole, mended;
    bool streams;                        /* radiance goes past the caches */
} block;

/* A block's coverage; reads no byte past the batch's. */
OP uint64_t covered_samples(const job *j, size_t i, size_t count)
{
    uint64_t bits = 0;
    for (size_t k = 0; k < count; k += 8) bits |= (uint64_t)j->coverage[(i + k) >> 3] << k;
    return bits & ALL_SAMPLES(count);
}

OP size_t block_size(const job *j) { return j->coverage && BLOCK > 64 ? 64 : BLOCK; }

/* Where the samples from `at` on cease to be covered. */
OP size_t covered_end(const block *b, size_t at)
{
    if (b->whole || b->covered == ALL_SAMPLES(b->count)) return b->count;
    while (at < b->count && b->covered >> at & 1) at++;
    return at;
}

/* ---- Values ------------------------------------------------------------------------------------------------------ */

/* What the models and lights read, from the batch, the plan or what the kernel made. */
OP uint32_t streams_read(const job *j)
{
    return ((j->streams & ~j->plan->sources) | j->plan->needed) & (uint32_t)READABLE;
}

/* What of it the kernel derives from others. */
OP uint32_t streams_derived(const job *j) { return j->plan->derived & (uint32_t)READABLE; }

/* Where the values of component c begin for sample i. */
OP const float *values_at(const job *j, int c, size_t i)
{
    return j->component[c] + (j->dense ? i : i & j->mask[c]);
}

/* What is uniform, and what is derived, of a block. */
typedef float block_values[COMPONENT_COUNT][BLOCK];

OP void store1(block_values values, int component, size_t at, vf a) { vf_store(values[component] + at, a); }

OP void store3(block_values values, int component, size_t at, vf3 a)
{
    vf_store(values[component] + at, a.x);
    vf_store(values[component + 1] + at, a.y);
    vf_store(values[component + 2] + at, a.z);
}

/* Finds a place for what has not a float per sample: in `values` for what is uniform, the material's numbers too, and
 * for what is derived or packed; zeros for what is not read. */
static __attribute__((noinline)) void place_values(job *j, block_values values)
{
    static const float zeros[VECTORS * VF_LANES];
    const uint32_t made = streams_derived(j) | j->unpacked;
    for (int stream = 0; stream < STREAM_COUNT; stream++) {
        const bool derived = made >> stream & 1, uniform = j->uniform >> stream & 1;
        const bool given = !uniform && (j->streams & ~j->unpacked) >> stream & 1;
        for (int c = places[stream].first; c < places[stream].first + places[stream].components; c++) {
            j->mask[c] = given ? ~(size_t)0 : derived ? block_size(j) - 1 : 0;
            const float *from = j->component[c];
            for (int k = 0; k < VECTORS && uniform; k++) vf_store(values[c] + k * VF_LANES, splat(*from));
            j->own[c] = given ? from : uniform || derived ? values[c] : zeros;
        }
    }
    j->component = j->own;
}

/* ---- Derived from other streams ---------------------------------------------------------------------------------- */

/* The value of a stream that another is derived from, in its domain; NaN where it is not finite there. Zeros past the
 * end. */
OP vf source(const job *j, const block *b, int component, size_t at, float low, float high)
{
    const float *from = values_at(j, component, b->i + at);
    float padded[GROUP];
    if (b->count - at < VF_LANES) {
        pad(from, 0, b->count - at, padded);
        from = padded;
    }
    vf a = in_domain(vf_load(from), low, high, high < FLT_MAX);
    return a + (a - a);
}

#define SOURCE_1(id, low, high) source(j, b, COMPONENT_##id, at, low, high)
#define SOURCE_3(id, low, high)                                                                                       \
    (vf3){ source(j, b, COMPONENT_##id, at, low, high), source(j, b, COMPONENT_##id + 1, at, low, high),              \
           source(j, b, COMPONENT_##id + 2, at, low, high) }
#define FACET_STREAM(id, field, components, owner, low, high, title)                                                  \
    OP VALUE_##components source_##id(const job *j, const block *b, size_t at)                                        \
    {                                                                                                                 \
        const plan_fields *p = j->plan;                                                                               \
        (void)p;                                                                                                      \
        return SOURCE_##components(id, low, high);                                                                    \
    }
#include "streams.def"

OP vf derived_roughness(const job *j, const block *b, size_t at)
{
    if (j->plan->convention == FACET_CONVENTION_METALLIC_ROUGHNESS) return source_ROUGHNESS(j, b, at);
    return 1.0f - source_GLOSSINESS(j, b, at);
}

OP vf3 derived_f0(const job *j, const block *b, size_t at)
{
    if (j->plan->convention == FACET_CONVENTION_METALLIC_ROUGHNESS)
        return f0_of_base(source_BASE(j, b, at), source_METALLIC(j, b, at), source_SPECULAR_LEVEL(j, b, at));
    vf3 eta = source_ETA(j, b, at), k = source_K(j, b, at);
    vf o = splat(j->plan->eta_outside);
    return (vf3){ f0_of_index(eta.x, k.x, o), f0_of_index(eta.y, k.y, o), f0_of_index(eta.z, k.z, o) };
}

OP vf3 derived_eta(const job *j, const block *b, size_t at)
{
    vf3 f0 = source_F0(j, b, at);
    vf o = splat(j->plan->eta_outside);
    return (vf3){ eta_in(f0.x, o), eta_in(f0.y, o), eta_in(f0.z, o) };
}

/* Parameters that follow from other streams, a block of them. Out of the way of materials that have none. */
static __attribute__((noinline)) void derive(const job *j, const block *b, block_values values)
{
    const uint32_t derived = streams_derived(j);
    for (size_t at = 0; at < b->count; at += VF_LANES) {
        if (derived & FACET_STREAM_ALBEDO)
            store3(values, COMPONENT_ALBEDO, at, albedo_of_base(source_BASE(j, b, at), source_METALLIC(j, b, at)));
        if (derived & FACET_STREAM_ALPHA)
            vf_store(values[COMPONENT_ALPHA] + at, alpha_of_roughness(derived_roughness(j, b, at)));
        if (derived & FACET_STREAM_ALPHA_Y) vf_store(values[COMPONENT_ALPHA_Y] + at, source_ALPHA(j, b, at));
        if (derived & FACET_STREAM_F0) store3(values, COMPONENT_F0, at, derived_f0(j, b, at));
        if (derived & FACET_STREAM_ETA) store3(values, COMPONENT_ETA, at, derived_eta(j, b, at));
    }
}

/* ---- Packed ------------------------------------------------------------------------------------------------------ */

/* The streams that are packed: `count` of a block's samples from `at` on, the batch's from `sample` on, whose words are
 * from the i-th on. Stream by stream, so that one vector's arithmetic fills another's latencies. */
static __attribute__((noinline)) void unpack_some(const job *j, const facet_packed *p, size_t i, size_t sample,
                                                  block_values values, size_t at, size_t count)
{
#define FACET_STREAM(id, field, components, ...)                                                                      \
    if (PACKABLE & ~FACET_STREAM_VIEW & FACET_STREAM_##id && j->unpacked & FACET_STREAM_##id)                         \
        for (size_t k = 0; k < count; k += VF_LANES)                                                                  \
            store##components(values, COMPONENT_##id, at + k,                                                         \
                              unpacked_##components(FACET_STREAM_##id, j->plan, p, i + k));
#include "streams.def"
    if (!(j->unpacked & FACET_STREAM_VIEW)) return;
    camera_pixel eye = pixel_of(p->camera, sample);
    for (size_t k = 0; k < count; k += VF_LANES, eye = next_pixel(p->camera, eye))
        store3(values, COMPONENT_VIEW, at + k, view_of_pixels(p->camera, eye));
}

/* A block of them, with zeros behind its words. */
static void unpack(const job *j, const block *b, block_values values)
{
    const facet_packed *p = j->packed;
    const size_t whole = b->count - b->count % VF_LANES, left = b->count - whole, i = b->i + whole;
    unpack_some(j, p, b->i, b->i, values, 0, whole);
    if (!left) return;

    float words[3][GROUP];
    facet_packed end;
    end.normal = (const int16_t *)(const void *)words[0];
    end.albedo_roughness = (const uint8_t *)words[1];
    end.f0_sigma = (const uint8_t *)words[2];
    end.camera = p->camera;
    if (p->normal) pad(p->normal, i, left, words[0]);
    if (p->albedo_roughness) pad(p->albedo_roughness, i, left, words[1]);
    if (p->f0_sigma) pad(p->f0_sigma, i, left, words[2]);
    unpack_some(j, &end, 0, i, values, whole, VF_LANES);
}

/* Vectors of radiance from its floats at `at` to `end`, as halves and pixels, to samples from i + at on. */
static __attribute__((noinline)) void pack_vectors(const facet_packed *p, size_t i, float *const *radiance, size_t at,
                                                   size_t end)
{
    for (; at < end; at += VF_LANES)
        store_packed(p, i + at,
                     (vf3){ vf_load(radiance[0] + at), vf_load(radiance[1] + at), vf_load(radiance[2] + at) });
}

/* Those samples of a vector at `at` that b covers. */
OP uint32_t covered_lanes(const block *b, size_t at)
{
    const size_t left = b->count - at;
    const uint32_t here = LANES(left < VF_LANES ? left : VF_LANES);
    return b->whole ? here : (uint32_t)(b->covered >> at) & here;
}

/* Some samples of a vector at `at`. */
static void pack_some(const job *j, const block *b, size_t at, uint32_t lanes)
{
    const facet_packed *p = j->packed;
    float memory[3][VF_LANES], words[VF_LANES], *radiance[3];
    uint16_t half[3][VF_LANES];
    facet_packed some;
    for (int c = 0; c < 3; c++) {
        for (size_t lane = 0; lane < VF_LANES; lane++)
            memory[c][lane] = lanes >> lane & 1 ? b->radiance[c][at + lane] : 0.0f;
        radiance[c] = memory[c];
        some.half[c] = p->half[c] ? half[c] : 0;
    }
    some.pixels = p->pixels ? (uint8_t *)words : 0;
    some.exposure = p->exposure;
    pack_vectors(&some, 0, radiance, 0, VF_LANES);
    for (size_t lane = 0, i = b->i + at; lane < VF_LANES; lane++, i++) {
        if (!(lanes >> lane & 1)) continue;
        for (int c = 0; c < 3 && p->half[c]; c++) p->half[c][i] = half[c][lane];
        for (size_t c = 0; c < 4 && p->pixels; c++) p->pixels[4 * i + c] = some.pixels[4 * lane + c];
    }
}

/* What was shaded of a block. */
static void pack(const job *j, const block *b)
{
    const size_t whole = covered_end(b, 0) / VF_LANES * VF_LANES;
    pack_vectors(j->packed, b->i, b->radiance, 0, whole);
    for (size_t at = whole; at < b->count; at += VF_LANES) {
        const uint32_t lanes = covered_lanes(b, at);
        if (lanes) pack_some(j, b, at, lanes);
    }
}

#endif
