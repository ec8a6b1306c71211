/* The batch kernel, once for every architecture and tier: walks a batch group by group, and sees to what is special.
 * Included after arch/NAME.h, with KERNEL defined as the function's name. */
#include "block.tmpl.h"

/* ---- Groups in a row --------------------------------------------------------------------------------------------- */

/* The bits of a vector's three components, together. */
OP vf any_bits(vf3 a) { return vf_or(vf_or(a.x, a.y), a.z); }

/* 0 + 0 a: NaN where a is not finite. */
OP vf not_finite_1(vf a, vf sum) { return vf_mad(a, splat(0.0f), sum); }
OP vf not_finite_3(vf3 a, vf sum) { return not_finite_1(a.x, not_finite_1(a.y, not_finite_1(a.z, sum))); }

/* A sign where a vector is 0. */
OP vf no_vector(vf3 a) { return below(vf_abs(any_bits(a)), FLT_TRUE_MIN); }

/* Leaves a sign where a sample of the group must be mended, but for what shows in its result. */
OP vf odd_values(const group *g, features x, int k)
{
    const uint32_t looked_at = x.shows ? x.streams & ~COMMON_STREAMS : x.streams;
    vf sum = splat(0.0f), odd = sum;
    if (!looked_at) return odd;
#define LOOK_AT(which, id, components)                                                                                \
    if ((which) & FACET_STREAM_##id && looked_at & FACET_STREAM_##id)                                                 \
        sum = not_finite_##components(load_##id(g, x, k), sum);
#define FACET_STREAM(id, field, components, ...) LOOK_AT(COMMON_STREAMS, id, components)
#include "streams.def"
    if (looked_at & ~COMMON_STREAMS) {
#define FACET_STREAM(id, field, components, ...) LOOK_AT(~COMMON_STREAMS, id, components)
#include "streams.def"
        if (x.streams & FACET_STREAM_TANGENT) odd = no_vector(load_TANGENT(g, x, k));
    }
    if (!x.shows) odd = vf_or(odd, no_vector(load_NORMAL(g, x, k)));
    return vf_or(odd, above(sum, FLT_MAX));
}

OP group open_group(const job *j, features x, const block *b, size_t at)
{
    group g;
    g.plan = j->plan;
    g.component = b->component;
    g.mask = b->mask;
    g.at = b->i + at;
    g.mended = b->mended;
    g.streams = b->streams;
    EACH(k) {
        g.is_finite[k] = splat(0.0f);
        g.sum[k] = ZERO3;
    }
    return g;
}

_Static_assert(VECTORS <= 2, "is_odd looks at the first vector and the last");

/* Whether the group must be mended before it can be written. */
OP bool is_odd(const group *g, features x, const vf *odd)
{
    const int last = x.vectors - 1;
    vf most = largest(g->sum[0]), any = odd[0];
    if (last) {
        most = vf_bits_max(most, largest(g->sum[last]));
        any = vf_or(any, odd[last]);
    }
    return __builtin_expect(vf_any_sign(vf_or(any, above(most, FLT_MAX))) && !g->mended, 0);
}

/* Samples that a light or the destination made invalid: how many, and a bit for each of the last group's. */
typedef struct { size_t count; uint32_t last; } invalids;

/* Shades the block's groups from `at` on, as long as they are whole, covered and in no need of mending. Returns where
 * it stopped. */
OP size_t shade_block(const job *j, features x, const block *b, size_t at, invalids *invalid)
{
    const size_t end = covered_end(b, at), step = (size_t)x.vectors * VF_LANES;
    for (; at + step <= end; at += step) {
        vf odd[VECTORS];
        group g = open_group(j, x, b, at);
        EACH(k) odd[k] = odd_values(&g, x, k);
        look(&g, x);
        prepare(&g, x);
        for (size_t i = 0; i < j->light_count; i++) add_light(&g, x, j, &j->lights[i]);
        uint32_t bad = add_constants(&g, x, j, b->radiance, at);
        if (is_odd(&g, x, odd)) break;
        store(&g, x, b->mended, b->radiance, at);
        invalid->last = bad;
        for (; bad; bad &= bad - 1) invalid->count++;
    }
    return at;
}

/* The same for one plain light. How it meets a group is found beside what the group before reflects, so that one's
 * arithmetic fills the other's latencies. A copy of the pointers: what is stored cannot change it, so that they stay in
 * registers or on the stack; two vectors side by side leave too few. It is made stream by stream, in loops so short
 * that they unroll and what nothing reads goes: a fifth of a call's instructions with SSE. */
OP size_t shade_plain(const job *j, features x, const block *b, size_t at)
{
    const size_t end = covered_end(b, at), step = (size_t)x.vectors * VF_LANES;
    const facet_light *light = j->lights;
    vf3 l[VECTORS], E[VECTORS];
    incidence t[VECTORS], next[VECTORS];
    if (at + step > end) return at;

    EACH(k) l[k] = splat3(light->direction);
    EACH(k) E[k] = scale3(splat3(light->irradiance), splat(INV_PI));
    const float *component[COMPONENT_COUNT];
    float *radiance[3];
    for (int c = 0; c < 3; c++) radiance[c] = b->radiance[c];
#define FACET_STREAM(id, field, components, ...)                                                                      \
    for (int c = COMPONENT_##id; c < COMPONENT_##id + components; c++) component[c] = b->component[c];
#include "streams.def"
    group g = open_group(j, x, b, at), h;
    if (x.vectors == 1) g.component = component;
    h = g;
    look(&g, x);
    meet(&g, x, l, t);
    for (; at + step <= end; at += step) {
        vf odd[VECTORS];
        h.at = at + 2 * step <= end ? g.at + step : g.at;
        look(&h, x);
        meet(&h, x, l, next);
        EACH(k) odd[k] = odd_values(&g, x, k);
        prepare(&g, x);
        reflect(&g, x, t, g.sum);
        EACH(k) g.sum[k] = mul3(g.sum[k], E[k]);
        if (is_odd(&g, x, odd)) break;
        store(&g, x, false, x.vectors == 1 ? radiance : b->radiance, at);
        g.at = h.at;
        EACH(k) t[k] = next[k];
    }
    return at;
}

typedef size_t block_shader(const job *, const block *, size_t at, invalids *);

/* Any block of any batch. */
static __attribute__((noinline)) size_t shade_any(const job *j, const block *b, size_t at, invalids *invalid)
{
    const plan_fields *p = j->plan;
    const features x = {
        .diffuse = (facet_diffuse)p->diffuse,
        .distribution = (facet_distribution)p->distribution,
        .visibility = (enum visibility)p->visibility,
        .fresnel = (facet_fresnel)p->fresnel,
        .fits = FACET_STRICT ? 0 : p->fits,
        .streams = streams_read(j),
        .coupled = p->coupled,
        .scaled = p->scale != 1.0f,
        .two_sided = j->flags & FACET_TWO_SIDED,
        .sigma_given = j->given & FACET_STREAM_SIGMA,
        .vectors = VF_INTERLEAVE,
    };
    return shade_block(j, x, b, at, invalid);
}

/* The rows of special.def: the same body with constants, for any batch, for plain ones, and for those of one light and
 * nothing else. */
#define FACET_SPECIAL(name, diffuse_, distribution_, masking, fresnel_, coupled_, any_, wide_)                        \
    enum { NEEDS_VIEW_##name = VIEWED_##diffuse_ != 0 || DISTRIBUTION_##distribution_ != 0 };                         \
    OP features features_##name(bool sigma_given, uint32_t given)                                                     \
    {                                                                                                                 \
        return (features){ .diffuse = (facet_diffuse)DIFFUSE_##diffuse_,                                              \
                           .distribution = (facet_distribution)DISTRIBUTION_##distribution_,                          \
                           .visibility = (enum visibility)VISIBILITY_##masking##_##distribution_,                     \
                           .fresnel = (facet_fresnel)FRESNEL_##fresnel_,                                              \
                           .fits = FITS_##fresnel_,                                                                   \
                           .streams = FACET_STREAM_NORMAL                                                             \
                                    | (NEEDS_VIEW_##name ? (uint32_t)FACET_STREAM_VIEW : given & FACET_STREAM_VIEW)   \
                                    | DIFFUSE_READS_##diffuse_ | DISTRIBUTION_READS_##distribution_                   \
                                    | FRESNEL_READS_##fresnel_,                                                       \
                           .coupled = coupled_, .sigma_given = sigma_given, .vectors = 1 };                           \
    }                                                                                                                 \
    static __attribute__((noinline)) size_t shade_##name(const job *j, const block *b, size_t at, invalids *invalid)  \
    {                                                                                                                 \
        features x = features_##name(j->given & FACET_STREAM_SIGMA, j->given);                                        \
        x.streams |= streams_read(j);                                                                                 \
        x.scaled = j->plan->scale != 1.0f;                                                                            \
        x.two_sided = j->flags & FACET_TWO_SIDED;                                                                     \
        return shade_block(j, x, b, at, invalid);                                                                     \
    }                                                                                                                 \
    static __attribute__((noinline)) size_t lights_##name(const job *j, const block *b, size_t at, invalids *invalid) \
    {                                                                                                                 \
        features x = features_##name(j->given & FACET_STREAM_SIGMA, j->given);                                        \
        x.plain = true;                                                                                               \
        x.shows = !j->has_ambient && !j->plan->emits;                                                                \
        if ((any_) && j->dense) {                                                                                     \
            x.dense = true;                                                                                           \
            return shade_block(j, x, b, at, invalid);                                                                 \
        }                                                                                                             \
        return shade_block(j, x, b, at, invalid);                                                                     \
    }                                                                                                                 \
    OP size_t loop_##name(const job *j, const block *b, size_t at, uint32_t view, int vectors)                        \
    {                                                                                                                 \
        const bool reads_sigma = DIFFUSE_READS_##diffuse_ & FACET_STREAM_SIGMA;                                       \
        features x = features_##name(reads_sigma, view);                                                              \
        x.plain = x.shows = x.dense = true;                                                                           \
        x.vectors = vectors;                                                                                          \
        if (j->dense) return shade_plain(j, x, b, at);                                                                \
        x.dense = false;                                                                                              \
        if (!reads_sigma || j->given & FACET_STREAM_SIGMA) return shade_plain(j, x, b, at);                           \
        x.sigma_given = false;                                                                                        \
        return shade_plain(j, x, b, at);                                                                              \
    }                                                                                                                 \
    static __attribute__((noinline)) size_t plain_##name(const job *j, const block *b, size_t at, invalids *invalid)  \
    {                                                                                                                 \
        (void)invalid;                                                                                                \
        if (!NEEDS_VIEW_##name && !(j->given & FACET_STREAM_VIEW)) return loop_##name(j, b, at, 0, 1);                \
        if ((wide_) & VF_LANES && VF_INTERLEAVE_WIDE > 1)                                                             \
            at = loop_##name(j, b, at, FACET_STREAM_VIEW, VF_INTERLEAVE_WIDE);                                        \
        return loop_##name(j, b, at, FACET_STREAM_VIEW, 1);                                                           \
    }
#include "special.def"

/* Whether this build and tier have a row of special.def: a constant. */
#define SPECIAL_BUILT(diffuse_, distribution_, masking, fresnel_)                                                     \
    (FACET_HAS(diffuse_) && FACET_HAS(distribution_) && FACET_HAS(masking) && FACET_HAS(fresnel_)                     \
     && !(FACET_STRICT && FITS_##fresnel_ != FITS_none))

/* What shades a batch, and whether it is a plain one. */
typedef struct { block_shader *shade; bool plain; } choice;

OP choice choose_shader(const job *j)
{
    const plan_fields *p = j->plan;
    const bool plain_lights = j->light_count && !j->check_lights && !j->invalid
                              && !(j->streams & FACET_STREAM_OCCLUSION)
                              && p->unscaled && !(j->flags & (FACET_ACCUMULATE | FACET_TWO_SIDED));
    const bool plain = plain_lights && j->light_count == 1 && !j->has_ambient && !p->emits;
    switch (p->special) {
#define FACET_SPECIAL(name, diffuse_, distribution_, masking, fresnel_, coupled_, any_, wide_)                        \
    case SPECIAL_##name:                                                                                              \
        if (!(SPECIAL_BUILT(diffuse_, distribution_, masking, fresnel_))) break;                                      \
        return (choice){ plain ? plain_##name : plain_lights ? lights_##name : (any_) ? shade_##name : shade_any,     \
                         plain };
#include "special.def"
    }
    return (choice){ shade_any, false };
}

/* ---- What keeps the mathematics above free of special cases --------------------------------------------------------
 * Nearly every group is whole and covered, has normals and finite values, and parameters in their domains. One that has
 * not is copied, mended, shaded like any other, and written sample by sample. */

#define EVERY(k) UNROLLED for (int k = 0; k < VF_INTERLEAVE; k++)

/* A component of b's samples at `at`, with zeros behind the end, clamped to its domain. */
static __attribute__((noinline)) void mend_component(const job *j, const block *b, int c, size_t at, float low,
                                                     float high, float *values, vf *is_finite)
{
    const float *from = values_at(j, c, b->i + at);
    if (b->count - at < GROUP) {
        pad(from, 0, b->count - at, values);
        from = values;
    }
    EVERY(k) {
        vf a = vf_load(from + k * VF_LANES);
        vf inside = low > -FLT_MAX ? vf_at_least(a, splat(low)) : a;
        if (high < FLT_MAX) inside = vf_at_most(inside, splat(high));
        is_finite[k] = is_finite[k] + (inside - inside);
        vf_store(values + k * VF_LANES, clamp(a, low, high));
    }
}

/* A bit for each sample of which a vector is 0. */
static __attribute__((noinline)) uint32_t zero_vectors(float (*values)[GROUP], int component)
{
    uint32_t zero = 0;
    EVERY(k) {
        const float *a = values[component] + k * VF_LANES;
        vf3 vector = { vf_load(a), vf_load(a + GROUP), vf_load(a + 2 * GROUP) };
        zero |= vm_bits(vf_eq(any_bits(vector), splat(0.0f))) << k * VF_LANES;
    }
    return zero;
}

/* Fills `values` from b's samples at `at`, with zeros behind the end, clamps what is outside its domain. Returns a bit
 * for each sample that is invalid: without a normal or a tangent, or not finite where its domain is. */
static uint32_t mend(const job *j, const block *b, size_t at, float (*values)[GROUP])
{
    const plan_fields *p = j->plan;
    const uint32_t read = streams_read(j);
    vf is_finite[VF_INTERLEAVE];
    EVERY(k) is_finite[k] = splat(0.0f);
#define FACET_STREAM(id, field, components, owner, low, high, title)                                                  \
    for (int c = COMPONENT_##id; c < COMPONENT_##id + components && read & FACET_STREAM_##id; c++)                    \
        mend_component(j, b, c, at, low, high, values[c], is_finite);
#include "streams.def"
    uint32_t invalid = zero_vectors(values, COMPONENT_NORMAL);
    if (read & FACET_STREAM_TANGENT) invalid |= zero_vectors(values, COMPONENT_TANGENT);
    EVERY(k) invalid |= (~vm_bits(vf_eq(is_finite[k], splat(0.0f))) & LANES(VF_LANES)) << k * VF_LANES;
    return invalid;
}

/* One group, with care. Returns how many samples are covered and invalid. */
static __attribute__((noinline)) size_t shade_mended(const job *j, const block *b, size_t at)
{
    static const size_t first[COMPONENT_COUNT];
    const size_t left = b->count - at;
    const uint32_t here = LANES(left < GROUP ? left : GROUP);
    const uint32_t covered = b->whole ? here : (uint32_t)(b->covered >> at) & here;
    if (!covered) return 0;

    float values[COMPONENT_COUNT][GROUP], result[3][GROUP];
    const float *component[COMPONENT_COUNT];
    uint32_t invalid = mend(j, b, at, values);
    invalids more = { 0, 0 };
    block m;
    m.i = b->i + at;
    m.count = GROUP;
    m.whole = m.mended = true;
    m.streams = false;
    for (int c = 0; c < COMPONENT_COUNT; c++) component[c] = values[c];
    m.component = component;
    m.mask = first;
    for (int c = 0; c < 3; c++) m.radiance[c] = result[c];
    if (j->flags & FACET_ACCUMULATE)
        for (size_t lane = 0; lane < GROUP; lane++)
            for (int c = 0; c < 3; c++) result[c][lane] = covered >> lane & 1 ? b->radiance[c][at + lane] : 0.0f;
    shade_any(j, &m, 0, &more);
    invalid |= more.last;
    for (uint32_t lanes = covered; lanes; lanes &= lanes - 1) {
        const int lane = __builtin_ctz(lanes);
        const bool valid = !(invalid >> lane & 1);
        for (int c = 0; c < 3; c++) b->radiance[c][at + (size_t)lane] = valid ? result[c][lane] : 0.0f;
    }
    size_t count = 0;
    for (invalid &= covered; invalid; invalid &= invalid - 1) count++;
    return count;
}

/* ---- A batch ---------------------------------------------------------------------------------------------------- */

/* Batches of so many samples do not fit into the caches that a core has to itself, nor does their radiance: it goes
 * past them, in place of reading it first. From memory 1.3 with AVX-512, 1.2 with AVX2, whose streams, where they stand
 * a multiple of 4096 bytes apart, lose .88. */
#define STREAMED ((size_t)1 << 19)

/* How many samples are left to the next multiple of a vector's size in all three of a large batch's radiance streams;
 * as many as there are where it is small, or they are never aligned together. */
OP size_t samples_to_alignment(const job *j)
{
    if (!VF_STREAMS || j->count < STREAMED) return j->count;
    const uintptr_t size = sizeof(vf), first = (uintptr_t)j->radiance[0] % size;
    const bool together = (uintptr_t)j->radiance[1] % size == first && (uintptr_t)j->radiance[2] % size == first;
    if (!together || first % sizeof(float)) return j->count;
    return (size - first) % size / sizeof(float);
}

/* Shades a block, its floats in place. Returns how many covered samples were invalid. */
OP size_t shade_whole_block(const job *j, const block *b, block_shader *shade)
{
    invalids invalid = { 0, 0 };
    for (size_t at = 0; at < b->count;) {
        at = shade(j, b, at, &invalid);
        if (at >= b->count) break;
        invalid.count += shade_mended(j, b, at);
        at += GROUP;
    }
    return invalid.count;
}

/* Samples of a batch, from the i-th on; their radiance goes to `radiance`, from `at` on. */
OP void take_samples(block *b, size_t i, size_t count, float *const *radiance, size_t at)
{
    b->i = i;
    b->count = count;
    for (int c = 0; c < 3; c++) b->radiance[c] = radiance[c] + at;
}

/* A batch of floats, all of which is covered. */
OP size_t shade_floats(const job *j, block *b, block_shader *shade)
{
    const size_t aligned = samples_to_alignment(j);
    take_samples(b, 0, aligned, j->radiance, 0);
    size_t invalid = shade_whole_block(j, b, shade);
    if (!VF_STREAMS || aligned == j->count) return invalid;
    take_samples(b, aligned, j->count - aligned, j->radiance, aligned);
    b->streams = true;
    invalid += shade_whole_block(j, b, shade);
    vf_streamed();
    return invalid;
}

/* Any batch. */
static __attribute__((noinline)) size_t shade_blocks(const job *j, block *b, block_shader *shade, block_values values)
{
    const bool unpacks = FACET_HAS(packed) && j->unpacked, packs = FACET_HAS(packed) && j->packs;
    float memory[3][BLOCK], *const radiance[3] = { memory[0], memory[1], memory[2] };
    const size_t step = block_size(j);
    size_t invalid = 0;
    for (size_t i = 0; i < j->count; i += step) {
        const size_t count = j->count - i < step ? j->count - i : step;
        take_samples(b, i, count, packs ? radiance : j->radiance, packs ? 0 : i);
        if (!b->whole) b->covered = covered_samples(j, i, count);
        if (unpacks) unpack(j, b, values);
        if (streams_derived(j)) derive(j, b, values);
        invalid += shade_whole_block(j, b, shade);
        if (packs) pack(j, b);
    }
    return invalid;
}

void KERNEL(job *j)
{
    const choice chosen = choose_shader(j);
    const bool in_blocks = streams_derived(j) || j->unpacked || j->packs || j->coverage;
    block_values values;
    block b;
    if (!j->dense || !chosen.plain) place_values(j, values);
    b.component = j->component;
    b.mask = j->mask;
    b.whole = !j->coverage;
    b.mended = b.streams = false;
    size_t invalid = in_blocks ? shade_blocks(j, &b, chosen.shade, values) : shade_floats(j, &b, chosen.shade);
    if (j->invalid) *j->invalid += invalid;
}
