/* A group of samples under any number of lights, once for every architecture and tier. A few vectors go through the
 * stages side by side, so that one's arithmetic fills the other's latencies; every switch is uniform, outside the
 * lanes. */
#ifndef FACET_GROUP_TMPL_H
#define FACET_GROUP_TMPL_H

#include "models.tmpl.h"

/* Vectors side by side, features.vectors, a constant: one, or as many as the vector layer says, for the kernel that has
 * all models, whose group is what is mended, and for rows of special.def that are wide at so many lanes. VECTORS: the
 * most. */
#define GROUP   (VF_INTERLEAVE * VF_LANES)
#define VECTORS (VF_INTERLEAVE > VF_INTERLEAVE_WIDE ? VF_INTERLEAVE : VF_INTERLEAVE_WIDE)
#define EACH(k) UNROLLED for (int k = 0; k < x.vectors; k++)

/* A bit for each of n <= 32 lanes. */
#define LANES(n) ((uint32_t)((1ull << (n)) - 1))

_Static_assert(GROUP <= 32, "a bit a sample of a group fits into a uint32_t");

enum {
    SPECULAR_BUILT = 0
#define FACET_DISTRIBUTION(id, name, ...) || (FACET_DISTRIBUTION_##id != FACET_DISTRIBUTION_NONE && FACET_HAS(name))
#include "models.def"
};

/* What the switches look at: a plan's and a batch's, or constants in a specialised row. */
typedef struct {
    facet_diffuse diffuse;
    facet_distribution distribution;
    enum visibility visibility;
    facet_fresnel fresnel;
    int fits;                /* FITS_* */
    int vectors;
    uint32_t streams;        /* FACET_STREAM_*: what is read, or made by the kernel and read */
    bool coupled, scaled, two_sided;
    bool sigma_given;        /* per sample */
    bool dense;              /* the batch is, and the group was not mended */
    bool plain;              /* directional lights without streams, one-sided, F90 1, nobody counts what is invalid */
    bool shows;              /* of a plain batch: it has lights and nothing else, so that a NaN shows in the result */
} features;

/* ---- A group ----------------------------------------------------------------------------------------------------
 * Streams are read where they are needed, again for each light: a load is cheaper than a register held. */

typedef struct {
    const plan_fields *plan;
    const float *const *component;       /* of the streams, and the masks of their indices */
    const size_t *mask;
    size_t at;                           /* the group's first sample in the batch */
    bool mended, streams;                /* streams: radiance goes past the caches */
    vf nv[VECTORS];                      /* as it comes, of any sign */
    terms terms[VECTORS];
    vf is_finite[VECTORS];               /* 0, or NaN where a light's or the destination's value was not finite */
    vf3 sum[VECTORS];                    /* over the lights */
} group;

OP vf load(const group *g, bool dense, int component, int k)
{
    const size_t at = dense ? g->at : g->at & g->mask[component];
    return vf_load(g->component[component] + at + k * VF_LANES);
}

/* A value in its domain; a NaN stays one, and infinity where there is no upper end. BOUNDED(high): whether there is
 * one, a constant at every level of optimisation. */
OP vf in_domain(vf a, float low, float high, bool bounded)
{
    if (low > -FLT_MAX) a = vf_at_least(a, splat(low));
    if (bounded) a = vf_at_most(a, splat(high));
    return a;
}
#define BOUNDED(high) (!(__builtin_constant_p(high) && (high) == FLT_MAX))

/* load_ID: vector k of a stream; what is not read is 0. */
#define VALUE_1 vf
#define VALUE_3 vf3
#define NOTHING_1 splat(0.0f)
#define NOTHING_3 ZERO3
#define COMPONENT(which, low, high) in_domain(load(g, x.dense, which, k), low, high, BOUNDED(high))
#define LOADED_1(id, low, high) COMPONENT(COMPONENT_##id, low, high)
#define LOADED_3(id, low, high)                                                                                       \
    (vf3){ COMPONENT(COMPONENT_##id, low, high), COMPONENT(COMPONENT_##id + 1, low, high),                            \
           COMPONENT(COMPONENT_##id + 2, low, high) }
#define FACET_STREAM(id, field, components, owner, low, high, title)                                                  \
    OP VALUE_##components load_##id(const group *g, features x, int k)                                                \
    {                                                                                                                 \
        const plan_fields *p = g->plan;                                                                               \
        (void)p;                                                                                                      \
        if (x.dense && !(x.streams & FACET_STREAM_##id)) return NOTHING_##components;                                 \
        return LOADED_##components(id, low, high);                                                                    \
    }
#include "streams.def"

/* What a model uses of it is loaded where it uses it; the rest is dead code. */
OP surface surface_at(const group *g, features x, int k)
{
    const plan_fields *p = g->plan;
    surface s;
    s.n = load_NORMAL(g, x, k);
    s.v = load_VIEW(g, x, k);
    s.tangent = load_TANGENT(g, x, k);
    s.terms = g->terms[k];
    s.albedo = load_ALBEDO(g, x, k);
    s.alpha = load_ALPHA(g, x, k);
    s.alpha2 = square(s.alpha);
    s.alpha_y = load_ALPHA_Y(g, x, k);
    s.exponent = load_EXPONENT(g, x, k);
    s.f0 = load_F0(g, x, k);
    s.f90 = x.plain ? splat(1.0f) : splat(p->f90);
    s.f82 = splat3(p->f82);
    s.eta = load_ETA(g, x, k);
    s.k = load_K(g, x, k);
    s.eta_outside = splat(p->eta_outside);
    s.parallel = splat(0.5f + 0.5f * p->polarisation);
    return s;
}

/* What a model sees of the group's vector k. */
#define AT(k) surface_at(g, x, k), t[k]

/* The cosine of the eye's angle; 1 where nothing looks at it. */
OP void look(group *g, features x)
{
    EACH(k) g->nv[k] = x.streams & FACET_STREAM_VIEW ? dot(load_NORMAL(g, x, k), load_VIEW(g, x, k)) : splat(1.0f);
}

/* What follows from sigma. */
OP void prepare(group *g, features x)
{
    if (!x.sigma_given) {
        const float *t = g->plan->terms;
        EACH(k) g->terms[k] = (terms){ splat(t[0]), splat(t[1]), splat(t[2]), splat(t[3]) };
        return;
    }
    EACH(k) g->terms[k] = terms_none(splat(0.0f));
    switch (x.diffuse) {
#define FACET_DIFFUSE(id, name, word, reads, properties, ...)                                                         \
    case FACET_DIFFUSE_##id:                                                                                          \
        if (FACET_HAS(name) && ((reads) & FACET_STREAM_SIGMA))                                                        \
            EACH(k) g->terms[k] = terms_##name(load_SIGMA(g, x, k));                                                  \
        break;
#include "models.def"
    }
}

/* ---- One light -------------------------------------------------------------------------------------------------- */

/* The end of a stream of words, from the i-th on, with zeros behind it. Rare: out of the way. */
static __attribute__((noinline, cold)) void pad(const void *stream, size_t i, size_t left, float *padded)
{
    const bits32 *from = (const bits32 *)stream + i;
    for (size_t lane = 0; lane < GROUP; lane++) ((bits32 *)padded)[lane] = lane < left ? from[lane] : 0;
}

/* A group of a light's own stream, whose end the padding of a batch's tail does not reach. */
OP void load_light(features x, const job *j, const float *stream, size_t i, vf *a, vf *is_finite)
{
    const float *from = stream + i;
    float padded[GROUP];
    if (j->count - i < (size_t)x.vectors * VF_LANES) {
        pad(stream, i, j->count - i, padded);
        from = padded;
    }
    EACH(k) {
        a[k] = vf_load(from + k * VF_LANES);
        is_finite[k] = is_finite[k] + (a[k] - a[k]);
    }
}

OP void load_light3(features x, const job *j, const float *const *stream, size_t i, vf3 *a, vf *is_finite)
{
    vf r[VECTORS], g[VECTORS], b[VECTORS];
    load_light(x, j, stream[0], i, r, is_finite);
    load_light(x, j, stream[1], i, g, is_finite);
    load_light(x, j, stream[2], i, b, is_finite);
    EACH(k) a[k] = (vf3){ r[k], g[k], b[k] };
}

/* What of a point light arrives at a distance of r from it, r^2 in the range of normal floats: 1/r^2, with
 * clamp(1 - (r/range)^4, 0, 1)^2. */
OP vf reach(const facet_light *light, vf r2, vf inverse)
{
    vf arrives = square(inverse);
    if (!(light->range > 0.0f)) return arrives;
    vf q2 = square(r2 * inverse / splat(light->range));
    return arrives * square(vf_not_negative(1.0f - square(q2)));
}

/* Smoothstep of the angle's cosine between the cones. */
OP vf cone(const facet_light *light, vf3 l)
{
    vf c = -dot(l, splat3(light->axis));
    vf width = vf_at_least(splat(light->cos_inner) - splat(light->cos_outer), splat(TINY));
    vf t = clamp((c - splat(light->cos_outer)) / width, 0.0f, 1.0f);
    t = vf_select(vf_lt(c, splat(light->cos_inner)), t, splat(1.0f));
    return square(t) * (3.0f - 2.0f * t);
}

/* Towards a light with a position: l and what part of its irradiance arrives; both 0 where its distance is 0, or its
 * square no normal float. */
OP void aim(const group *g, features x, const facet_light *light, int k, vf3 *l, vf *arrives)
{
    vf3 d = sub3(splat3(light->position), load_POSITION(g, x, k));
    vf r2 = dot(d, d), inverse = 1.0f / vf_sqrt(r2);
    vm near = vf_lt(r2, splat(TINY)), far = vf_lt(r2, splat(__builtin_inff()));
    inverse = vf_select(near, splat(0.0f), vf_where(far, inverse));
    *l = (vf3){ vf_where(far, d.x * inverse), vf_where(far, d.y * inverse), vf_where(far, d.z * inverse) };
    *arrives = vf_where(far, reach(light, r2, inverse));
    if (light->kind == FACET_LIGHT_SPOT) *arrives = *arrives * cone(light, *l);
}

/* l, and of a light with a position what part of the irradiance arrives. */
OP void load_direction(group *g, features x, const job *j, const facet_light *light, vf3 *l, vf *arrives)
{
    if (!x.plain && light->kind != FACET_LIGHT_DIRECTIONAL)
        EACH(k) aim(g, x, light, k, &l[k], &arrives[k]);
    else if (!x.plain && light->direction_of[0])
        load_light3(x, j, light->direction_of, g->at, l, g->is_finite);
    else
        EACH(k) l[k] = splat3(light->direction);
}

/* Irradiance over pi times visibility, at most FLT_MAX. */
OP void load_irradiance(group *g, features x, const job *j, const facet_light *light, const vf *arrives, vf3 *E)
{
    if (!x.plain && light->irradiance_of[0])
        load_light3(x, j, light->irradiance_of, g->at, E, g->is_finite);
    else
        EACH(k) E[k] = splat3(light->irradiance);
    EACH(k) E[k] = scale3(E[k], splat(INV_PI));
    if (x.plain) return;
    if (j->check_lights) EACH(k) E[k] = not_negative3(E[k]);

    if (light->visibility) {
        vf seen[VECTORS];
        load_light(x, j, light->visibility, g->at, seen, g->is_finite);
        EACH(k) E[k] = scale3(E[k], clamp(seen[k], 0.0f, 1.0f));
    }
    if (light->kind != FACET_LIGHT_DIRECTIONAL)
        EACH(k) E[k] = clamp3(scale3(E[k], arrives[k]), 0.0f, FLT_MAX);
}

/* nl and nv, where the light and the eye are on the normal's side; nl = 0 elsewhere, NaN where either is not finite. */
OP void face(const group *g, features x, incidence *t)
{
    if (x.two_sided) EACH(k) t[k].nl = vf_flip(t[k].nl, g->nv[k]);
    EACH(k) {
        vf nv = x.two_sided ? vf_abs(g->nv[k]) : g->nv[k];
        t[k].nl = vf_where(vf_lt(splat(0.0f), nv), vf_at_least(t[k].nl, splat(0.0f))) + (nv - nv);
        t[k].nv = vf_at_least(nv, splat(TINY));
    }
}

/* How a light meets the samples. n x w is as long as what of w lies across n, w - (n.w) n; n.w is taken of w, whose
 * small components nl + nv has lost. */
OP void meet(const group *g, features x, const vf3 *l, incidence *t)
{
    EACH(k) {
        t[k].l = l[k];
        t[k].nl = dot(load_NORMAL(g, x, k), l[k]);
        t[k].vl = t[k].hh = t[k].nw = t[k].nxw2 = splat(0.0f);
    }
    if (x.streams & FACET_STREAM_VIEW)
        EACH(k) {
            vf3 n = load_NORMAL(g, x, k), v = load_VIEW(g, x, k), w = add3(v, l[k]);
            vf nw = dot(n, w);
            vf3 p = { vf_nmad(nw, n.x, w.x), vf_nmad(nw, n.y, w.y), vf_nmad(nw, n.z, w.z) };
            t[k].vl = dot(v, l[k]);
            t[k].nw = nw;
            t[k].nxw2 = dot(p, p);
            t[k].hh = square(nw) + t[k].nxw2;
        }
    face(g, x, t);
}

OP void diffuse(const group *g, features x, const incidence *t, const vf3 *plus, vf3 *f)
{
    switch (x.diffuse) {
#define FACET_DIFFUSE(id, name, ...)                                                                                  \
    case FACET_DIFFUSE_##id:                                                                                          \
        if (FACET_HAS(name)) EACH(k) f[k] = diffuse_##name(AT(k), plus[k]);                                           \
        break;
#include "models.def"
    }
}

OP void distribution(const group *g, features x, const incidence *t, vf *D)
{
    switch (x.distribution) {
#define FACET_DISTRIBUTION(id, name, ...)                                                                             \
    case FACET_DISTRIBUTION_##id:                                                                                     \
        if (FACET_HAS(name)) EACH(k) D[k] = distribution_##name(AT(k));                                               \
        break;
#include "models.def"
    }
}

OP void visibility(const group *g, features x, const incidence *t, vf *V)
{
    switch (x.visibility) {
#define FACET_VISIBILITY(masking, distribution, properties)                                                           \
    case VISIBILITY_##masking##_##distribution:                                                                       \
        if (FACET_HAS(masking) && FACET_HAS(distribution))                                                            \
            EACH(k) V[k] = visibility_##masking##_##distribution(AT(k));                                              \
        break;
#include "models.def"
    case VISIBILITY_NONE:
        EACH(k) V[k] = t[k].nl;
        break;
    }
}

OP void fresnel(const group *g, features x, const incidence *t, const vf *weight, vf3 *F)
{
    const fresnel_fit *fit = g->plan->fit;
    if (x.fits) {
        EACH(k) {
            vf c = vh(t[k]);
            F[k] = same3(fitted(&fit[0], c) * weight[k]);
            if (x.fits > 1) F[k].y = fitted(&fit[1], c) * weight[k], F[k].z = fitted(&fit[2], c) * weight[k];
        }
        return;
    }
    switch (x.fresnel) {
#define FACET_FRESNEL(id, name, ...)                                                                                  \
    case FACET_FRESNEL_##id:                                                                                          \
        if (FACET_HAS(name)) EACH(k) F[k] = fresnel_##name(AT(k), weight[k]);                                         \
        break;
#include "models.def"
    }
}

/* In a group that was mended nothing infinite or undefined gets from one light into the sum, or from one part of its
 * light into the other: 0 for NaN, FLT_MAX for infinity. What is finite is left as it is. */
OP vf finite_part(vf a) { return clamp(a, 0.0f, FLT_MAX); }
OP vf3 finite_part3(vf3 a) { return clamp3(a, 0.0f, FLT_MAX); }
OP vf finite_or(vf a, vf instead) { return vf_select(vf_eq(a - a, splat(0.0f)), a, instead); }
OP vf add_finite(vf f, vf E, vf sum) { return finite_or(vf_mad(f, E, sum), finite_part(sum + finite_part(f * E))); }

/* Adds the diffuse part to the specular one. */
OP void add_diffuse(const group *g, features x, const incidence *t, bool mended, vf3 *f)
{
    vf3 alone[VECTORS], specular[VECTORS], zero[VECTORS];
    EACH(k) specular[k] = f[k];
    diffuse(g, x, t, specular, f);
    if (!mended) return;
    EACH(k) alone[k] = zero[k] = ZERO3;
    diffuse(g, x, t, zero, alone);
    EACH(k) {
        vf3 instead = finite_part3(add3(finite_part3(alone[k]), specular[k]));
        f[k] = (vf3){ finite_or(f[k].x, instead.x), finite_or(f[k].y, instead.y), finite_or(f[k].z, instead.z) };
    }
}

/* The same where the diffuse part is what F leaves: f = diffuse (1 - F) + F D V. */
OP void add_coupled(const group *g, features x, const incidence *t, bool mended, const vf *DV, vf3 *f)
{
    vf one[VECTORS];
    vf3 F[VECTORS], zero[VECTORS];
    EACH(k) {
        one[k] = splat(1.0f);
        F[k] = f[k] = zero[k] = ZERO3;
    }
    fresnel(g, x, t, one, F);
    diffuse(g, x, t, zero, f);
    if (mended) EACH(k) f[k] = finite_part3(f[k]);
    EACH(k) f[k] = mad3(F[k], same3(DV[k]), mul3(f[k], one_minus3(F[k])));
}

/* pi times the BRDF times nl. */
OP void reflect(const group *g, features x, const incidence *t, vf3 *f)
{
    const bool mended = !x.plain && g->mended;
    EACH(k) f[k] = ZERO3;
    if (SPECULAR_BUILT && x.distribution != FACET_DISTRIBUTION_NONE) {
        vf D[VECTORS], V[VECTORS];
        EACH(k) D[k] = V[k] = splat(0.0f);
        distribution(g, x, t, D);
        visibility(g, x, t, V);
        if (x.scaled) EACH(k) V[k] = V[k] * splat(g->plan->scale);
        EACH(k) D[k] = D[k] * V[k];
        if (mended) EACH(k) D[k] = finite_part(D[k]);
        if (x.coupled) {
            add_coupled(g, x, t, mended, D, f);
            return;
        }
        fresnel(g, x, t, D, f);
    }
    add_diffuse(g, x, t, mended, f);
}

OP void add_light(group *g, features x, const job *j, const facet_light *light)
{
    const bool mended = !x.plain && g->mended;
    vf3 l[VECTORS], f[VECTORS], E[VECTORS];
    vf arrives[VECTORS];
    incidence t[VECTORS];

    EACH(k) arrives[k] = splat(1.0f);
    load_direction(g, x, j, light, l, arrives);
    meet(g, x, l, t);
    reflect(g, x, t, f);
    load_irradiance(g, x, j, light, arrives, E);
    if (!mended) {
        EACH(k) g->sum[k] = mad3(f[k], E[k], g->sum[k]);
        return;
    }
    EACH(k) {
        vf3 a = finite_part3(f[k]), sum = g->sum[k];
        g->sum[k].x = add_finite(a.x, E[k].x, sum.x);
        g->sum[k].y = add_finite(a.y, E[k].y, sum.y);
        g->sum[k].z = add_finite(a.z, E[k].z, sum.z);
    }
}

/* ---- The end of a group ----------------------------------------------------------------------------------------- */

/* The component whose bits are the largest: one that is negative, infinite or NaN, if there is one. */
OP vf largest(vf3 a) { return vf_bits_max(vf_bits_max(a.x, a.y), a.z); }

/* A sign where a is above the limit, negative or NaN; where a >= 0 is below it. */
OP vf above(vf a, float limit) { return vf_or(a, vf_bits_minus(splat(limit), a)); }
OP vf below(vf a, float limit) { return vf_bits_minus(a, splat(limit)); }

/* Irradiance over pi from everywhere: ambient, and the spherical harmonics at the normal; what of it is not
 * occluded. */
OP vf3 ambient(const group *g, features x, const job *j, int k)
{
    vf3 E = splat3(j->ambient);
    if (j->has_sh) {
        vf3 n = load_NORMAL(g, x, k), sh = splat3(j->sh[0]);
        if (x.two_sided) n = (vf3){ vf_flip(n.x, g->nv[k]), vf_flip(n.y, g->nv[k]), vf_flip(n.z, g->nv[k]) };
        sh = mad3(splat3(j->sh[1]), same3(n.y), sh);
        sh = mad3(splat3(j->sh[2]), same3(n.z), sh);
        sh = mad3(splat3(j->sh[3]), same3(n.x), sh);
        E = add3(E, not_negative3(sh));
    }
    if (g->mended) E = finite_part3(E);
    return x.streams & FACET_STREAM_OCCLUSION ? scale3(E, load_OCCLUSION(g, x, k)) : E;
}

/* Adds what is there without a light. Returns a bit for each sample that a light's or the destination's value made
 * invalid, and is 0. */
OP uint32_t add_constants(group *g, features x, const job *j, float *const *radiance, size_t at)
{
    uint32_t invalid = 0;
    if (j->has_ambient) EACH(k) g->sum[k] = mad3(load_ALBEDO(g, x, k), ambient(g, x, j, k), g->sum[k]);
    if (j->plan->emits) EACH(k) g->sum[k] = add3(g->sum[k], splat3(j->plan->emission));
    if (j->flags & FACET_ACCUMULATE)
        EACH(k) {
            const size_t i = at + (size_t)k * VF_LANES;
            vf3 before = { vf_load(radiance[0] + i), vf_load(radiance[1] + i), vf_load(radiance[2] + i) };
            g->is_finite[k] = g->is_finite[k] + (before.x - before.x) + (before.y - before.y) + (before.z - before.z);
            g->sum[k] = add3(g->sum[k], not_negative3(before));
        }
    if (j->check_lights || j->flags & FACET_ACCUMULATE)
        EACH(k) {
            vm valid = vf_eq(g->is_finite[k], splat(0.0f));
            vf3 sum = g->sum[k];
            g->sum[k] = (vf3){ vf_where(valid, sum.x), vf_where(valid, sum.y), vf_where(valid, sum.z) };
            invalid |= (~vm_bits(valid) & LANES(VF_LANES)) << k * VF_LANES;
        }
    return invalid;
}

/* Writes the group, clamped to what radiance may be. */
OP void store(const group *g, features x, bool clamped, float *const *radiance, size_t at)
{
    EACH(k) {
        vf3 out = g->sum[k];
        if (clamped)
            out = (vf3){ clamp(out.x, 0.0f, FLT_MAX), clamp(out.y, 0.0f, FLT_MAX), clamp(out.z, 0.0f, FLT_MAX) };
        const size_t i = at + (size_t)k * VF_LANES;
        if (VF_STREAMS && g->streams) {
            vf_stream(radiance[0] + i, out.x);
            vf_stream(radiance[1] + i, out.y);
            vf_stream(radiance[2] + i, out.z);
            continue;
        }
        vf_store(radiance[0] + i, out.x);
        vf_store(radiance[1] + i, out.y);
        vf_store(radiance[2] + i, out.z);
    }
}

#endif
