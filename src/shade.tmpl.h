/* The batch kernel, once for every architecture and tier. A group of K vectors goes through the stages side by side, so
 * that one vector's arithmetic fills the other's latencies; every switch is uniform and stands outside the lanes.
 * Included after arch/NAME.h, with KERNEL defined as the function's name. */
#include "models.tmpl.h"

/* Vectors in a group: what measured fastest, set by the vector layer for each tier. */
#define K     VF_INTERLEAVE
#define GROUP (K * VF_LANES)
#define EACH(k) _Pragma("GCC unroll 4") for (int k = 0; k < K; k++)

_Static_assert(GROUP <= 32, "coverage of a group is a uint32_t");

enum {
    SPECULAR_BUILT = 0
#define FACET_DISTRIBUTION(id, name, ...) || (FACET_DISTRIBUTION_##id != FACET_DISTRIBUTION_NONE && FACET_HAS(name))
#include "models.def"
};

/* ---- Loads: each also multiplies the values into `is_finite`, which so stays 0 or becomes NaN ---------------------- */

OP void take(vf *is_finite, vf a) { *is_finite = *is_finite * a; }

OP void take3(vf *is_finite, vf3 a)
{
    take(is_finite, a.x);
    take(is_finite, a.y);
    take(is_finite, a.z);
}

/* A group of a stream of the batch, or the stream's one value in every lane. */
OP void load(const job *j, const float *const *stream, int id, uint32_t bit, size_t at, vf *a, vf *is_finite)
{
    if (j->uniform & bit)
        EACH(k) a[k] = splat(*stream[id]);
    else
        EACH(k) a[k] = vf_load(stream[id] + at + k * VF_LANES);
    EACH(k) take(&is_finite[k], a[k]);
}

OP void load3(const job *j, const float *const *stream, int id, uint32_t bit, size_t at, vf3 *a, vf *is_finite)
{
    vf x[K], y[K], z[K];
    load(j, stream, id, bit, at, x, is_finite);
    load(j, stream, id + 1, bit, at, y, is_finite);
    load(j, stream, id + 2, bit, at, z, is_finite);
    EACH(k) a[k] = (vf3){ x[k], y[k], z[k] };
}

/* The same of a light's own stream, whose end the padding of a batch's tail does not reach. */
OP void load_light(const job *j, const float *stream, size_t i, vf *a, vf *is_finite)
{
    size_t left = j->count - i;
    if (left >= GROUP) {
        EACH(k) a[k] = vf_load(stream + i + k * VF_LANES);
    } else {
        float padded[GROUP];
        for (size_t lane = 0; lane < GROUP; lane++) padded[lane] = lane < left ? stream[i + lane] : 0.0f;
        EACH(k) a[k] = vf_load(padded + k * VF_LANES);
    }
    EACH(k) take(&is_finite[k], a[k]);
}

OP void load_light3(const job *j, const float *const *stream, size_t i, vf3 *a, vf *is_finite)
{
    vf x[K], y[K], z[K];
    load_light(j, stream[0], i, x, is_finite);
    load_light(j, stream[1], i, y, is_finite);
    load_light(j, stream[2], i, z, is_finite);
    EACH(k) a[k] = (vf3){ x[k], y[k], z[k] };
}

/* ---- A group: what its samples bring ---------------------------------------------------------------------------- */

typedef struct {
    vf3 n[K], v[K];
    vf flip[K];                  /* two-sided: nv as it came, whose sign nl takes over; else 1 */
    vm faces[K];                 /* nv > 0 */
    surface s[K];
    vf is_finite[K];             /* 0, or NaN where a value was not finite */
    vf3 sum[K];                  /* over the lights */
} group;

OP void load_view(group *g, const job *j, const float *const *stream, size_t at)
{
    if (!(j->streams & FACET_STREAM_VIEW)) {
        EACH(k) {
            g->v[k] = g->n[k];
            g->s[k].nv = g->flip[k] = splat(1.0f);
            g->faces[k] = vf_lt(splat(0.0f), splat(1.0f));
        }
        return;
    }
    load3(j, stream, STREAM_VIEW, FACET_STREAM_VIEW, at, g->v, g->is_finite);
    vf nv[K];
    EACH(k) nv[k] = dot(g->n[k], g->v[k]);
    if (j->flags & FACET_TWO_SIDED)
        EACH(k) {
            g->flip[k] = nv[k];
            nv[k] = vf_abs(nv[k]);
        }
    else
        EACH(k) g->flip[k] = splat(1.0f);
    EACH(k) {
        g->faces[k] = vf_lt(splat(0.0f), nv[k]);
        g->s[k].nv = vf_max(nv[k], splat(TINY));
    }
}

OP void load_diffuse(group *g, const job *j, const float *const *stream, size_t at)
{
    const plan_fields *p = j->plan;
    if (j->streams & FACET_STREAM_ALBEDO) {
        vf3 albedo[K];
        load3(j, stream, STREAM_ALBEDO, FACET_STREAM_ALBEDO, at, albedo, g->is_finite);
        EACH(k) g->s[k].albedo = not_negative3(albedo[k]);
    } else {
        EACH(k) g->s[k].albedo = splat3(p->albedo);
    }
    EACH(k) g->s[k].terms = (terms){ splat(p->terms[0]), splat(p->terms[1]) };
    if (!(j->streams & FACET_STREAM_SIGMA)) return;

    vf sigma[K];
    load(j, stream, STREAM_SIGMA, FACET_STREAM_SIGMA, at, sigma, g->is_finite);
    switch ((facet_diffuse)p->diffuse) {
#define FACET_DIFFUSE(id, name, word, sigma_max, properties, title)                                                  \
    case FACET_DIFFUSE_##id:                                                                                         \
        if (FACET_HAS(name) && ((properties) & TERMS))                                                               \
            EACH(k) g->s[k].terms = terms_##name(vf_min(not_negative(sigma[k]), splat(sigma_max)));                  \
        break;
#include "models.def"
    }
}

OP void load_specular(group *g, const job *j, bool specular, const float *const *stream, size_t at)
{
    const plan_fields *p = j->plan;
    EACH(k) {
        g->s[k].alpha = g->s[k].alpha2 = g->s[k].f90 = splat(0.0f);
        g->s[k].f0 = ZERO3;
    }
    if (!specular) return;
    if (j->streams & FACET_STREAM_ALPHA) {
        vf alpha[K];
        load(j, stream, STREAM_ALPHA, FACET_STREAM_ALPHA, at, alpha, g->is_finite);
        EACH(k) g->s[k].alpha = alpha_domain(alpha[k]);
    } else {
        EACH(k) g->s[k].alpha = splat(p->alpha);
    }
    if (j->streams & FACET_STREAM_F0) {
        vf3 f0[K];
        load3(j, stream, STREAM_F0, FACET_STREAM_F0, at, f0, g->is_finite);
        EACH(k) g->s[k].f0 = unit_interval3(f0[k]);
    } else {
        EACH(k) g->s[k].f0 = splat3(p->f0);
    }
    EACH(k) {
        g->s[k].alpha2 = square(g->s[k].alpha);
        g->s[k].f90 = splat(p->f90);
    }
}

/* ---- A group: one light ------------------------------------------------------------------------------------------ */

OP void load_directional(group *g, const job *j, const facet_light *light, size_t i, vf3 *l, vf3 *irradiance)
{
    if (light->direction_of[0])
        load_light3(j, light->direction_of, i, l, g->is_finite);
    else
        EACH(k) l[k] = splat3(light->direction);

    if (light->irradiance_of[0])
        load_light3(j, light->irradiance_of, i, irradiance, g->is_finite);
    else
        EACH(k) irradiance[k] = splat3(light->irradiance);
    EACH(k) irradiance[k] = not_negative3(irradiance[k]);

    if (light->visibility) {
        vf visibility[K];
        load_light(j, light->visibility, i, visibility, g->is_finite);
        EACH(k) irradiance[k] = scale3(irradiance[k], unit_interval(visibility[k]));
    }
}

OP void diffuse(const plan_fields *p, const surface *s, const incidence *t, vf3 *f)
{
    switch ((facet_diffuse)p->diffuse) {
#define FACET_DIFFUSE(id, name, ...)                                                                                  \
    case FACET_DIFFUSE_##id:                                                                                         \
        if (FACET_HAS(name)) EACH(k) f[k] = diffuse_##name(s[k], t[k]);                                              \
        break;
#include "models.def"
    }
}

OP void distribution(const plan_fields *p, const surface *s, const incidence *t, vf *D)
{
    switch ((facet_distribution)p->distribution) {
#define FACET_DISTRIBUTION(id, name, ...)                                                                             \
    case FACET_DISTRIBUTION_##id:                                                                                    \
        if (FACET_HAS(name)) EACH(k) D[k] = distribution_##name(s[k], t[k]);                                         \
        break;
#include "models.def"
    }
}

OP void visibility(const plan_fields *p, const surface *s, const incidence *t, vf *V)
{
    switch ((enum visibility)p->visibility) {
#define FACET_VISIBILITY(masking, distribution, properties)                                                           \
    case VISIBILITY_##masking##_##distribution:                                                                      \
        if (FACET_HAS(masking) && FACET_HAS(distribution))                                                           \
            EACH(k) V[k] = visibility_##masking##_##distribution(s[k], t[k]);                                        \
        break;
#include "models.def"
    case VISIBILITY_NONE:
        break;
    }
}

OP void fresnel(const plan_fields *p, const surface *s, const incidence *t, vf3 *F)
{
    switch ((facet_fresnel)p->fresnel) {
#define FACET_FRESNEL(id, name, ...)                                                                                  \
    case FACET_FRESNEL_##id:                                                                                         \
        if (FACET_HAS(name)) EACH(k) F[k] = fresnel_##name(s[k], t[k]);                                              \
        break;
#include "models.def"
    }
}

OP void add_light(group *g, const job *j, bool specular, const facet_light *light, size_t i)
{
    const plan_fields *p = j->plan;
    vf3 l[K], irradiance[K], f[K];
    incidence t[K];

    load_directional(g, j, light, i, l, irradiance);
    EACH(k) {
        vf nl = vf_flip(dot(g->n[k], l[k]), g->flip[k]);
        t[k].nl = vf_where(vm_and(g->faces[k], vf_lt(splat(0.0f), nl)), nl);
        t[k].vl = dot(g->v[k], l[k]);
        f[k] = ZERO3;
    }
    diffuse(p, g->s, t, f);
    if (specular) {
        vf D[K], V[K];
        vf3 F[K];
        EACH(k) {
            vf3 w = add3(g->v[k], l[k]), nxw = cross(g->n[k], w);
            t[k].hh = dot(w, w);
            t[k].nw2 = square(dot(g->n[k], w));
            t[k].nxw2 = dot(nxw, nxw);
            D[k] = V[k] = splat(0.0f);
            F[k] = ZERO3;
        }
        distribution(p, g->s, t, D);
        visibility(p, g->s, t, V);
        fresnel(p, g->s, t, F);
        if (p->coupled) EACH(k) f[k] = mul3(f[k], one_minus3(F[k]));
        EACH(k) f[k] = mad3(F[k], same3(D[k] * V[k]), f[k]);
    }
    EACH(k) g->sum[k] = mad3(f[k], irradiance[k], g->sum[k]);
}

/* ---- A group ----------------------------------------------------------------------------------------------------- */

/* Adds what is there without a light, writes the group, and returns a bit for each sample that was invalid. */
OP uint32_t finish(group *g, const job *j, float *const *radiance)
{
    const uint32_t lanes = (uint32_t)((1ull << VF_LANES) - 1);
    uint32_t invalid = 0;
    EACH(k) {
        const int at = k * VF_LANES;
        vf3 out = add3(mad3(g->s[k].albedo, splat3(j->ambient), g->sum[k]), splat3(j->plan->emission));
        if (j->flags & FACET_ACCUMULATE) {
            vf3 before = { vf_load(radiance[0] + at), vf_load(radiance[1] + at), vf_load(radiance[2] + at) };
            take3(&g->is_finite[k], before);
            out = add3(out, not_negative3(before));
        }
        vm valid = vm_and(vf_lt(splat(0.0f), dot(g->n[k], g->n[k])), vf_eq(g->is_finite[k], splat(0.0f)));
        vf_store(radiance[0] + at, vf_where(valid, vf_min(not_negative(out.x), splat(FLT_MAX))));
        vf_store(radiance[1] + at, vf_where(valid, vf_min(not_negative(out.y), splat(FLT_MAX))));
        vf_store(radiance[2] + at, vf_where(valid, vf_min(not_negative(out.z), splat(FLT_MAX))));
        invalid |= (~vm_bits(valid) & lanes) << at;
    }
    return invalid;
}

/* Shades the group whose samples stand at `at` in `stream`, and at i in the batch (for the lights' streams); `radiance`
 * is where the result goes. */
OP uint32_t shade_group(const job *j, const float *const *stream, size_t at, size_t i, float *const *radiance)
{
    const bool specular = SPECULAR_BUILT && j->plan->distribution;
    group g;
    EACH(k) {
        g.is_finite[k] = splat(0.0f);
        g.sum[k] = ZERO3;
    }
    load3(j, stream, STREAM_NORMAL, FACET_STREAM_NORMAL, at, g.n, g.is_finite);
    load_view(&g, j, stream, at);
    load_diffuse(&g, j, stream, at);
    load_specular(&g, j, specular, stream, at);
    for (size_t light = 0; light < j->light_count; light++) add_light(&g, j, specular, &j->lights[light], i);
    return finish(&g, j, radiance);
}

/* ---- A batch --------------------------------------------------------------------------------------------------- */

/* The group's coverage bits; reads no byte past the batch's. */
OP uint32_t coverage_bits(const uint8_t *coverage, size_t i, size_t left)
{
    uint32_t bits = 0;
    for (size_t k = 0; k < GROUP && k < left; k += 8) bits |= (uint32_t)coverage[(i + k) >> 3] >> ((i + k) & 7) << k;
    return bits;
}

/* Copies the last, incomplete group of every stream that is read, and zeros behind it, to `block`. */
OP void pad(const job *j, size_t i, float (*block)[GROUP], const float **stream)
{
    for (int c = 0; c < STREAM_COUNT; c++) stream[c] = j->stream[c];
#define FACET_STREAM(id, field, components, owner)                                                                    \
    if (j->streams & ~j->uniform & FACET_STREAM_##id)                                                                \
        for (int c = STREAM_##id; c <= STREAM_##id##_LAST; c++) {                                                    \
            for (size_t lane = 0; lane < GROUP; lane++)                                                              \
                block[c][lane] = lane < j->count - i ? j->stream[c][i + lane] : 0.0f;                                \
            stream[c] = block[c];                                                                                    \
        }
#include "streams.def"
}

void KERNEL(const job *j)
{
    const uint32_t all = (uint32_t)((1ull << GROUP) - 1);
    float block[STREAM_COUNT][GROUP], radiance_block[3][GROUP];
    const float *padded[STREAM_COUNT];
    size_t invalid = 0;

    for (size_t i = 0; i < j->count; i += GROUP) {
        size_t left = j->count - i, here = left < GROUP ? left : GROUP;
        uint32_t covered = left < GROUP ? (1u << left) - 1 : all;
        if (j->coverage) covered &= coverage_bits(j->coverage, i, left);
        if (!covered) continue;

        const float *const *stream = j->stream;
        size_t at = i;
        if (left < GROUP) {
            pad(j, i, block, padded);
            stream = padded;
            at = 0;
        }
        float *radiance[3];
        for (int c = 0; c < 3; c++) {
            radiance[c] = covered == all ? j->radiance[c] + i : radiance_block[c];
            if (covered != all)
                for (size_t lane = 0; lane < GROUP; lane++)
                    radiance_block[c][lane] = j->flags & FACET_ACCUMULATE && lane < here ? j->radiance[c][i + lane] : 0.0f;
        }
        uint32_t invalid_bits = shade_group(j, stream, at, i, radiance) & covered;
        if (covered != all)
            for (int c = 0; c < 3; c++)
                for (size_t lane = 0; lane < here; lane++)
                    if (covered >> lane & 1) j->radiance[c][i + lane] = radiance_block[c][lane];
        for (; invalid_bits; invalid_bits &= invalid_bits - 1) invalid++;
    }
    if (j->invalid) *j->invalid += invalid;
}
