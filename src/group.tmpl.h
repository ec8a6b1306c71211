/* A group of samples under any number of lights, once for every architecture and tier. A few vectors go through the
 * stages side by side, so that one's arithmetic fills the other's latencies; every switch is uniform, outside the
 * lanes. */
#ifndef FACET_GROUP_TMPL_H
#define FACET_GROUP_TMPL_H

#include "models.tmpl.h"

/* Vectors in a group: what measured fastest, set by the vector layer for each tier. */
#define VECTORS VF_INTERLEAVE
#define GROUP   (VECTORS * VF_LANES)
#define EACH(k) _Pragma("GCC unroll 4") for (int k = 0; k < VECTORS; k++)

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
    uint32_t streams;        /* FACET_STREAM_*: what is read, or made by the kernel and read */
    bool coupled, scaled, two_sided;
    bool common;             /* the models' rows are COMMON and the lights directional */
    bool plain;              /* one light without streams, nothing else added, and nobody counts what is invalid */
} features;

/* ---- A group ----------------------------------------------------------------------------------------------------
 * Streams are read where they are needed, again for each light: a load is cheaper than a register held. */

typedef struct {
    const float *const *component;       /* of the block's streams */
    size_t at;                           /* the group's first sample in the block */
    bool mended;
    vf nv[VECTORS];                      /* as it comes, of any sign */
    terms terms[VECTORS];
    vf is_finite[VECTORS];               /* 0, or NaN where a light's or the destination's value was not finite */
    vf3 sum[VECTORS];                    /* over the lights */
} group;

#define LOAD(g, id, k)  load(g, COMPONENT_##id, k)
#define LOAD3(g, id, k) load3(g, COMPONENT_##id, k)

OP vf load(const group *g, int component, int k)
{
    return vf_load(g->component[component] + g->at + k * VF_LANES);
}

OP vf3 load3(const group *g, int component, int k)
{
    return (vf3){ load(g, component, k), load(g, component + 1, k), load(g, component + 2, k) };
}

/* What a model uses of it is loaded where it uses it; the rest is dead code. */
OP surface surface_at(const group *g, const plan_fields *p, int k)
{
    surface s;
    s.n = LOAD3(g, NORMAL, k);
    s.v = LOAD3(g, VIEW, k);
    s.tangent = LOAD3(g, TANGENT, k);
    s.terms = g->terms[k];
    s.albedo = LOAD3(g, ALBEDO, k);
    s.alpha = LOAD(g, ALPHA, k);
    s.alpha2 = square(s.alpha);
    s.alpha_y = LOAD(g, ALPHA_Y, k);
    s.exponent = LOAD(g, EXPONENT, k);
    s.f0 = LOAD3(g, F0, k);
    s.f90 = splat(p->f90);
    s.f82 = splat3(p->f82);
    s.eta = LOAD3(g, ETA, k);
    s.k = LOAD3(g, K, k);
    s.eta_outside = splat(p->eta_outside);
    s.parallel = splat(0.5f + 0.5f * p->polarisation);
    return s;
}

/* Whether a row is to be had; what a model sees of the group's vector k. */
#define BUILT(name, properties) (FACET_HAS(name) && (!x.common || (properties) & COMMON))
#define AT(k) surface_at(g, p, k), t[k]

/* nv and what follows from sigma. */
OP void prepare(group *g, features x, const job *j)
{
    const plan_fields *p = j->plan;
    EACH(k) {
        g->is_finite[k] = splat(0.0f);
        g->sum[k] = ZERO3;
        g->nv[k] = splat(1.0f);
    }
    if (x.streams & FACET_STREAM_VIEW) EACH(k) g->nv[k] = dot(LOAD3(g, NORMAL, k), LOAD3(g, VIEW, k));
    if (!(j->given & FACET_STREAM_SIGMA)) {
        const float *t = p->terms;
        EACH(k) g->terms[k] = (terms){ splat(t[0]), splat(t[1]), splat(t[2]), splat(t[3]) };
        return;
    }
    EACH(k) g->terms[k] = terms_none(splat(0.0f));
    switch (x.diffuse) {
#define FACET_DIFFUSE(id, name, word, reads, properties, ...)                                                         \
    case FACET_DIFFUSE_##id:                                                                                          \
        if (BUILT(name, properties) && ((reads) & FACET_STREAM_SIGMA))                                                \
            EACH(k) g->terms[k] = terms_##name(LOAD(g, SIGMA, k));                                                    \
        break;
#include "models.def"
    }
}

/* ---- One light -------------------------------------------------------------------------------------------------- */

/* The end of a stream, with zeros behind it. Rare: out of the way. */
static __attribute__((noinline, cold)) void pad(const float *from, size_t left, float *padded)
{
    for (size_t lane = 0; lane < GROUP; lane++) padded[lane] = lane < left ? from[lane] : 0.0f;
}

/* A group of a light's own stream, whose end the padding of a batch's tail does not reach. */
OP void load_light(const job *j, const float *stream, size_t i, vf *a, vf *is_finite)
{
    const float *from = stream + i;
    float padded[GROUP];
    if (j->count - i < GROUP) {
        pad(from, j->count - i, padded);
        from = padded;
    }
    EACH(k) {
        a[k] = vf_load(from + k * VF_LANES);
        is_finite[k] = is_finite[k] + (a[k] - a[k]);
    }
}

OP void load_light3(const job *j, const float *const *stream, size_t i, vf3 *a, vf *is_finite)
{
    vf x[VECTORS], y[VECTORS], z[VECTORS];
    load_light(j, stream[0], i, x, is_finite);
    load_light(j, stream[1], i, y, is_finite);
    load_light(j, stream[2], i, z, is_finite);
    EACH(k) a[k] = (vf3){ x[k], y[k], z[k] };
}

/* What of a point light arrives at a distance of r from it, r^2 in the range of normal floats: 1/r^2, with
 * clamp(1 - (r/range)^4, 0, 1)^2. */
OP vf reach(const facet_light *light, vf r2, vf inverse)
{
    vf arrives = square(inverse);
    if (!(light->range > 0.0f)) return arrives;
    vf q2 = square(r2 * inverse / splat(light->range));
    return arrives * square(not_negative(1.0f - square(q2)));
}

/* Smoothstep of the angle's cosine between the cones. */
OP vf cone(const facet_light *light, vf3 l)
{
    vf c = -dot(l, splat3(light->axis)), width = vf_max(splat(TINY), splat(light->cos_inner) - splat(light->cos_outer));
    vf t = clamp((c - splat(light->cos_outer)) / width, 0.0f, 1.0f);
    t = vf_select(vf_lt(c, splat(light->cos_inner)), t, splat(1.0f));
    return square(t) * (3.0f - 2.0f * t);
}

/* Towards a light with a position: l and what part of its irradiance arrives; both 0 where its distance is 0, or its
 * square no normal float. */
OP void aim(const group *g, const facet_light *light, int k, vf3 *l, vf *arrives)
{
    vf3 d = sub3(splat3(light->position), LOAD3(g, POSITION, k));
    vf r2 = dot(d, d), inverse = 1.0f / vf_sqrt(r2);
    vm near = vf_lt(r2, splat(TINY)), far = vf_lt(r2, splat(__builtin_inff()));
    inverse = vf_select(near, splat(0.0f), vf_where(far, inverse));
    *l = (vf3){ vf_where(far, d.x * inverse), vf_where(far, d.y * inverse), vf_where(far, d.z * inverse) };
    *arrives = vf_where(far, reach(light, r2, inverse));
    if (light->kind == FACET_LIGHT_SPOT) *arrives = *arrives * cone(light, *l);
}

/* l, and of a light with a position what part of the irradiance arrives. */
OP void load_direction(group *g, features x, const job *j, const facet_light *light, size_t i, vf3 *l, vf *arrives)
{
    if (!x.plain && !x.common && light->kind != FACET_LIGHT_DIRECTIONAL)
        EACH(k) aim(g, light, k, &l[k], &arrives[k]);
    else if (!x.plain && light->direction_of[0])
        load_light3(j, light->direction_of, i, l, g->is_finite);
    else
        EACH(k) l[k] = splat3(light->direction);
}

/* Irradiance times visibility, at most FLT_MAX. */
OP void load_irradiance(group *g, features x, const job *j, const facet_light *light, size_t i, const vf *arrives,
                        vf3 *E)
{
    if (!x.plain && light->irradiance_of[0])
        load_light3(j, light->irradiance_of, i, E, g->is_finite);
    else
        EACH(k) E[k] = splat3(light->irradiance);
    if (x.plain) return;
    if (j->check_lights) EACH(k) E[k] = not_negative3(E[k]);

    if (light->visibility) {
        vf seen[VECTORS];
        load_light(j, light->visibility, i, seen, g->is_finite);
        EACH(k) E[k] = scale3(E[k], clamp(seen[k], 0.0f, 1.0f));
    }
    if (!x.common && light->kind != FACET_LIGHT_DIRECTIONAL)
        EACH(k) E[k] = clamp3(scale3(E[k], arrives[k]), 0.0f, FLT_MAX);
}

/* nl and nv, where the light and the eye are on the normal's side; nl = 0 elsewhere, NaN where either is not finite. */
OP void face(const group *g, features x, vf *nl, incidence *t)
{
    if (x.two_sided) EACH(k) nl[k] = vf_flip(nl[k], g->nv[k]);
    EACH(k) {
        vf nv = x.two_sided ? vf_abs(g->nv[k]) : g->nv[k];
        t[k].nl = vf_where(vf_lt(splat(0.0f), nv), vf_max(splat(0.0f), nl[k])) + (nv - nv);
        t[k].nv = vf_max(splat(TINY), nv);
    }
}

OP void diffuse(const group *g, features x, const plan_fields *p, const incidence *t, vf3 *f)
{
    switch (x.diffuse) {
#define FACET_DIFFUSE(id, name, word, reads, properties, ...)                                                         \
    case FACET_DIFFUSE_##id:                                                                                          \
        if (BUILT(name, properties)) EACH(k) f[k] = diffuse_##name(AT(k));                                            \
        break;
#include "models.def"
    }
}

OP void distribution(const group *g, features x, const plan_fields *p, const incidence *t, vf *D)
{
    switch (x.distribution) {
#define FACET_DISTRIBUTION(id, name, word, reads, properties, ...)                                                    \
    case FACET_DISTRIBUTION_##id:                                                                                     \
        if (BUILT(name, properties)) EACH(k) D[k] = distribution_##name(AT(k));                                       \
        break;
#include "models.def"
    }
}

OP void visibility(const group *g, features x, const plan_fields *p, const incidence *t, vf *V)
{
    switch (x.visibility) {
#define FACET_VISIBILITY(masking, distribution, properties)                                                           \
    case VISIBILITY_##masking##_##distribution:                                                                       \
        if (BUILT(masking, properties) && FACET_HAS(distribution))                                                    \
            EACH(k) V[k] = visibility_##masking##_##distribution(AT(k));                                              \
        break;
#include "models.def"
    case VISIBILITY_NONE:
        EACH(k) V[k] = t[k].nl;
        break;
    }
}

OP void fresnel(const group *g, features x, const plan_fields *p, const incidence *t, vf3 *F)
{
    switch (x.fresnel) {
#define FACET_FRESNEL(id, name, word, reads, properties, ...)                                                         \
    case FACET_FRESNEL_##id:                                                                                          \
        if (BUILT(name, properties)) EACH(k) F[k] = fresnel_##name(AT(k));                                            \
        break;
#include "models.def"
    }
}

/* In a group that was mended nothing infinite or undefined gets from one light into the sum, or from one part of its
 * light into the other: 0 for NaN, FLT_MAX for infinity. What is finite is left as it is. */
OP vf finite_part(vf a) { return clamp(a, 0.0f, FLT_MAX); }
OP vf3 finite_part3(vf3 a) { return clamp3(a, 0.0f, FLT_MAX); }

OP vf add_finite(vf f, vf E, vf sum)
{
    vf next = vf_mad(f, E, sum);
    return vf_select(vf_eq(next - next, splat(0.0f)), next, finite_part(sum + finite_part(f * E)));
}

OP void add_light(group *g, features x, const job *j, const facet_light *light, size_t i)
{
    const bool mended = !x.plain && g->mended;
    const plan_fields *p = j->plan;
    vf3 l[VECTORS], f[VECTORS], E[VECTORS];
    vf nl[VECTORS], arrives[VECTORS];
    incidence t[VECTORS];

    EACH(k) arrives[k] = splat(1.0f);
    load_direction(g, x, j, light, i, l, arrives);
    EACH(k) {
        nl[k] = dot(LOAD3(g, NORMAL, k), l[k]);
        t[k].l = l[k];
        t[k].vl = t[k].hh = t[k].nw = t[k].nxw2 = splat(0.0f);
        f[k] = ZERO3;
    }
    if (x.streams & FACET_STREAM_VIEW)
        EACH(k) {
            vf3 n = LOAD3(g, NORMAL, k), v = LOAD3(g, VIEW, k), w = add3(v, l[k]), nxw = cross(n, w);
            t[k].vl = dot(v, l[k]);
            t[k].hh = dot(w, w);
            t[k].nw = dot(n, w);
            t[k].nxw2 = dot(nxw, nxw);
        }
    face(g, x, nl, t);
    diffuse(g, x, p, t, f);
    if (mended) EACH(k) f[k] = finite_part3(f[k]);
    if (SPECULAR_BUILT && x.distribution != FACET_DISTRIBUTION_NONE) {
        vf D[VECTORS], V[VECTORS];
        vf3 F[VECTORS];
        EACH(k) {
            D[k] = V[k] = splat(0.0f);
            F[k] = ZERO3;
        }
        distribution(g, x, p, t, D);
        visibility(g, x, p, t, V);
        fresnel(g, x, p, t, F);
        if (x.coupled) EACH(k) f[k] = mul3(f[k], one_minus3(F[k]));
        if (x.scaled) EACH(k) V[k] = V[k] * splat(p->scale);
        EACH(k) D[k] = D[k] * V[k];
        if (mended) EACH(k) D[k] = finite_part(D[k]);
        EACH(k) f[k] = mad3(F[k], same3(D[k]), f[k]);
    }
    load_irradiance(g, x, j, light, i, arrives, E);
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
        vf3 n = LOAD3(g, NORMAL, k), sh = splat3(j->sh[0]);
        if (x.two_sided) n = (vf3){ vf_flip(n.x, g->nv[k]), vf_flip(n.y, g->nv[k]), vf_flip(n.z, g->nv[k]) };
        sh = mad3(splat3(j->sh[1]), same3(n.y), sh);
        sh = mad3(splat3(j->sh[2]), same3(n.z), sh);
        sh = mad3(splat3(j->sh[3]), same3(n.x), sh);
        E = add3(E, not_negative3(sh));
    }
    if (g->mended) E = finite_part3(E);
    return x.streams & FACET_STREAM_OCCLUSION ? scale3(E, LOAD(g, OCCLUSION, k)) : E;
}

/* Adds what is there without a light. Returns a bit for each sample that a light's or the destination's value made
 * invalid, and is 0. */
OP uint32_t add_constants(group *g, features x, const job *j, float *const *radiance)
{
    uint32_t invalid = 0;
    if (j->has_ambient) EACH(k) g->sum[k] = mad3(LOAD3(g, ALBEDO, k), ambient(g, x, j, k), g->sum[k]);
    if (j->has_emission) EACH(k) g->sum[k] = add3(g->sum[k], splat3(j->plan->emission));
    if (j->flags & FACET_ACCUMULATE)
        EACH(k) {
            const size_t at = g->at + (size_t)k * VF_LANES;
            vf3 before = { vf_load(radiance[0] + at), vf_load(radiance[1] + at), vf_load(radiance[2] + at) };
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
OP void store(const group *g, bool clamped, float *const *radiance)
{
    EACH(k) {
        vf3 out = g->sum[k];
        if (clamped)
            out = (vf3){ clamp(out.x, 0.0f, FLT_MAX), clamp(out.y, 0.0f, FLT_MAX), clamp(out.z, 0.0f, FLT_MAX) };
        const size_t at = g->at + (size_t)k * VF_LANES;
        vf_store(radiance[0] + at, out.x);
        vf_store(radiance[1] + at, out.y);
        vf_store(radiance[2] + at, out.z);
    }
}

#endif
