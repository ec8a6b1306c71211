/* The batch kernel, once for every architecture and tier: walks a batch group by group, and sees to what is special.
 * Included after arch/NAME.h, with KERNEL defined as the function's name. */
#include "group.tmpl.h"

/* Samples in a block: pointers and coverage are set up a block at a time. A uniform value fills a block of its own. */
#define BLOCK (VF_LANES > 1 ? 64 : 16)

_Static_assert(BLOCK % GROUP == 0 && BLOCK % 8 == 0 && BLOCK <= 64, "a bit a sample of a block fits into a uint64_t");

/* ---- A block: groups in a row ------------------------------------------------------------------------------------ */

/* A bit for each of 1 <= n <= 64 samples. */
#define ALL_SAMPLES(n) (~(uint64_t)0 >> (64 - (n)))

/* Up to BLOCK samples of a batch, or one group that was mended. */
typedef struct {
    const float *component[COMPONENT_COUNT];
    float *radiance[3];
    size_t i, count;                     /* its first sample in the batch; its samples */
    uint64_t covered;                    /* a bit a sample */
    bool mended;
} block;

/* The bits of a vector's three components, together. */
OP vf any_bits(vf3 a) { return vf_or(vf_or(a.x, a.y), a.z); }

/* Leaves a sign where a sample of the group may need mending; errs on the side of yes: several components' bits
 * together can look like an infinity, but not while all are of magnitude below 2. A plain batch's vectors need no look:
 * what is not finite shows in the result, and a zero normal's result is 0. */
OP vf odd_values(const group *g, features x, const plan_fields *p, int k)
{
    vf odd = splat(0.0f), unit = splat(0.0f);
    if (!x.plain) {
        vf n = vf_abs(any_bits(LOAD3(g, NORMAL, k))), v = x.view ? vf_abs(any_bits(LOAD3(g, VIEW, k))) : n;
        odd = vf_or(below(n, FLT_TRUE_MIN), above(vf_or(n, v), FLT_MAX));
    }
    if (x.needed & FACET_STREAM_ALBEDO) {
        vf albedo = any_bits(LOAD3(g, ALBEDO, k));
        odd = vf_or(odd, x.plain ? albedo : above(albedo, FLT_MAX));
    }
    if (x.needed & FACET_STREAM_SIGMA) odd = vf_or(odd, above(LOAD(g, SIGMA, k), p->sigma_max));
    if (x.needed & FACET_STREAM_F0) unit = largest(LOAD3(g, F0, k));
    if (x.needed & FACET_STREAM_ALPHA) {
        vf alpha = LOAD(g, ALPHA, k);
        unit = vf_bits_max(unit, alpha);
        odd = vf_or(odd, below(alpha, FACET_ALPHA_FLOOR));
    }
    return vf_or(odd, above(unit, 1.0f));
}

/* Where the samples from `at` on cease to be covered. */
OP size_t covered_end(const block *b, size_t at)
{
    if (b->covered == ALL_SAMPLES(b->count)) return b->count;
    while (at < b->count && b->covered >> at & 1) at++;
    return at;
}

/* Shades the block's groups from `at` on, as long as they are whole, covered and in no need of mending. Returns where
 * it stopped; sets in *invalid the bits of the samples that a light or the destination made invalid. */
OP size_t shade_block(const job *j, features x, const block *b, size_t at, uint64_t *invalid)
{
    const size_t end = covered_end(b, at);
    for (; at + GROUP <= end; at += GROUP) {
        vf odd[K];
        group g;
        g.component = b->component;
        g.at = at;
        EACH(k) odd[k] = odd_values(&g, x, j->plan, k);
        prepare(&g, x, j);
        const size_t lights = x.plain ? 1 : j->light_count;
        for (size_t light = 0; light < lights; light++) add_light(&g, x, j, &j->lights[light], b->i + at);
        const uint64_t bad = x.plain ? 0 : add_constants(&g, j, b->radiance);

        uint32_t mend = 0;
        EACH(k) mend |= vf_signs(vf_or(odd[k], above(largest(g.sum[k]), FLT_MAX)));
        if (__builtin_expect(mend && !b->mended, 0)) break;
        *invalid |= bad << at;
        store(&g, b->mended, b->radiance);
    }
    return at;
}

typedef size_t block_shader(const job *, const block *, size_t at, uint64_t *invalid);

/* Any block of any batch. */
static __attribute__((noinline)) size_t shade_any(const job *j, const block *b, size_t at, uint64_t *invalid)
{
    const plan_fields *p = j->plan;
    const features x = {
        .diffuse = (facet_diffuse)p->diffuse,
        .distribution = (facet_distribution)p->distribution,
        .visibility = (enum visibility)p->visibility,
        .fresnel = (facet_fresnel)p->fresnel,
        .needed = p->needed,
        .coupled = p->coupled,
        .view = j->streams & FACET_STREAM_VIEW,
        .two_sided = j->flags & FACET_TWO_SIDED,
    };
    return shade_block(j, x, b, at, invalid);
}

/* The rows of special.def: the same body with constants, for plain batches of one-sided samples. */
#define FACET_SPECIAL(diffuse_, distribution_, masking, fresnel_, coupled_)                                           \
    static __attribute__((noinline)) size_t shade_##diffuse_##_##distribution_##_##masking##_##fresnel_##_##coupled_( \
        const job *j, const block *b, size_t at, uint64_t *invalid)                                                  \
    {                                                                                                                \
        const features x = { .diffuse = (facet_diffuse)DIFFUSE_##diffuse_,                                           \
                             .distribution = (facet_distribution)DISTRIBUTION_##distribution_,                       \
                             .visibility = VISIBILITY_##masking##_##distribution_,                                   \
                             .fresnel = (facet_fresnel)FRESNEL_##fresnel_,                                           \
                             .needed = FACET_STREAM_ALBEDO | FACET_STREAM_ALPHA |                                    \
                                       (DIFFUSE_PROPERTIES_##diffuse_ & TERMS ? FACET_STREAM_SIGMA : 0) |            \
                                       (FRESNEL_PROPERTIES_##fresnel_ & F0 ? FACET_STREAM_F0 : 0),                   \
                             .coupled = coupled_, .view = true, .plain = true };                                     \
        return shade_block(j, x, b, at, invalid);                                                                    \
    }
#include "special.def"

static block_shader *choose_shader(const job *j)
{
    const plan_fields *p = j->plan;
    const bool plain = j->light_count == 1 && !j->check_lights && !j->constant_radiance && !j->invalid
                       && j->streams & FACET_STREAM_VIEW && !(j->flags & (FACET_ACCUMULATE | FACET_TWO_SIDED));
    if (!plain) return shade_any;
#define FACET_SPECIAL(diffuse_, distribution_, masking, fresnel_, coupled_)                                           \
    if (FACET_HAS(diffuse_) && FACET_HAS(distribution_) && FACET_HAS(masking) && FACET_HAS(fresnel_)                  \
        && p->diffuse == DIFFUSE_##diffuse_ && p->visibility == VISIBILITY_##masking##_##distribution_                \
        && p->fresnel == FRESNEL_##fresnel_ && p->coupled == coupled_)                                                \
        return shade_##diffuse_##_##distribution_##_##masking##_##fresnel_##_##coupled_;
#include "special.def"
    return shade_any;
}

/* ---- What keeps the mathematics above free of special cases --------------------------------------------------------
 * Nearly every group is whole and covered, has normals and finite values, and parameters in their domains. One that has
 * not is copied, mended, shaded like any other, and written sample by sample. */

/* Fills `values` from b's samples at `at`, with zeros behind the end, clamps what is outside its domain. Returns a bit
 * for each sample that is invalid: without a normal, or not finite. */
OP uint32_t mend(const job *j, const block *b, size_t at, float (*values)[GROUP])
{
    const plan_fields *p = j->plan;
    const size_t count = b->count - at < GROUP ? b->count - at : GROUP;
    uint32_t invalid = 0;
    vf is_finite[K];
    EACH(k) is_finite[k] = splat(0.0f);

#define CLAMP_GEOMETRY(a, low, high) (a)
#define CLAMP_MATERIAL(a, low, high) clamp(a, low, high)
#define FACET_STREAM(id, field, components, owner, low, high, title)                                                  \
    for (int c = COMPONENT_##id; c <= COMPONENT_##id##_LAST; c++) {                                                  \
        if (!b->component[c]) continue;                                                                              \
        for (size_t lane = 0; lane < GROUP; lane++)                                                                  \
            values[c][lane] = lane < count ? b->component[c][at + lane] : 0.0f;                                      \
        EACH(k) {                                                                                                    \
            vf a = vf_load(values[c] + k * VF_LANES);                                                                \
            if (j->streams & FACET_STREAM_##id) is_finite[k] = is_finite[k] + (a - a);                               \
            vf_store(values[c] + k * VF_LANES, CLAMP_##owner(a, low, high));                                         \
        }                                                                                                            \
    }
#include "streams.def"
    EACH(k) {
        const float *n = values[COMPONENT_NORMAL] + k * VF_LANES;
        vm no_normal = vf_eq(any_bits((vf3){ vf_load(n), vf_load(n + GROUP), vf_load(n + 2 * GROUP) }), splat(0.0f));
        uint32_t bits = vm_bits(no_normal) | ~vm_bits(vf_eq(is_finite[k], splat(0.0f)));
        invalid |= (bits & LANES(VF_LANES)) << k * VF_LANES;
    }
    return invalid;
}

/* One group, with care. Returns a bit for each sample that is covered and invalid. */
static __attribute__((noinline)) uint32_t shade_mended(const job *j, const block *b, size_t at, block_shader *shader)
{
    const uint32_t covered = (uint32_t)(b->covered >> at) & LANES(GROUP);
    if (!covered) return 0;

    float values[COMPONENT_COUNT][GROUP], result[3][GROUP];
    uint64_t invalid = mend(j, b, at, values);
    block m;
    m.i = b->i + at;
    m.count = GROUP;
    m.covered = LANES(GROUP);
    m.mended = true;
    for (int c = 0; c < COMPONENT_COUNT; c++) m.component[c] = values[c];
    for (int c = 0; c < 3; c++) {
        m.radiance[c] = result[c];
        for (size_t lane = 0; lane < GROUP; lane++)
            result[c][lane] = j->flags & FACET_ACCUMULATE && covered >> lane & 1 ? b->radiance[c][at + lane] : 0.0f;
    }
    shader(j, &m, 0, &invalid);
    for (int c = 0; c < 3; c++)
        for (size_t lane = 0; lane < GROUP; lane++)
            if (covered >> lane & 1) b->radiance[c][at + lane] = invalid >> lane & 1 ? 0.0f : result[c][lane];
    return (uint32_t)invalid & covered;
}

/* ---- A batch ---------------------------------------------------------------------------------------------------- */

/* A block's coverage; reads no byte past the batch's. */
OP uint64_t covered_samples(const job *j, size_t i, size_t count)
{
    if (!j->coverage) return ALL_SAMPLES(count);
    uint64_t bits = 0;
    for (size_t k = 0; k < count; k += 8) bits |= (uint64_t)j->coverage[(i + k) >> 3] << k;
    return bits & ALL_SAMPLES(count);
}

typedef float block_values[COMPONENT_COUNT][BLOCK];

/* Fills blocks with what is uniform, the material's numbers too. */
OP void open_uniform(const job *j, block_values values)
{
    const size_t count = j->count < BLOCK ? j->count : BLOCK;
#define FACET_STREAM(id, ...)                                                                                         \
    if (j->uniform & FACET_STREAM_##id)                                                                              \
        for (int c = COMPONENT_##id; c <= COMPONENT_##id##_LAST; c++)                                                \
            for (size_t k = 0; k < count; k += VF_LANES) vf_store(values[c] + k, splat(*j->component[c]));
#include "streams.def"
}

void KERNEL(const job *j)
{
    block_shader *shader = choose_shader(j);
    block_values uniform;
    size_t invalid = 0;
    open_uniform(j, uniform);

    for (size_t i = 0; i < j->count; i += BLOCK) {
        block b;
        b.i = i;
        b.count = j->count - i < BLOCK ? j->count - i : BLOCK;
        b.covered = covered_samples(j, i, b.count);
        b.mended = false;
        for (int c = 0; c < 3; c++) b.radiance[c] = j->radiance[c] + i;
#define FACET_STREAM(id, ...)                                                                                         \
        for (int c = COMPONENT_##id; c <= COMPONENT_##id##_LAST; c++)                                                \
            b.component[c] = j->uniform & FACET_STREAM_##id ? uniform[c] : j->component[c] ? j->component[c] + i : 0;
#include "streams.def"
        uint64_t bad = 0;
        for (size_t at = 0; at < b.count;) {
            at = shader(j, &b, at, &bad);
            if (at >= b.count) break;
            bad |= (uint64_t)shade_mended(j, &b, at, shader) << at;
            at += GROUP;
        }
        for (; bad; bad &= bad - 1) invalid++;
    }
    if (j->invalid) *j->invalid += invalid;
}
