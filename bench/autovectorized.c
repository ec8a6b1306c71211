/* A baseline: the same functions as the library's, branch-free in plain C over arrays, for a compiler's vectoriser at
 * -O3 -ffast-math -march=native, without looking for NaNs or mending anything. The Makefile compiles it by each
 * compiler at each vector width: BASELINE is the symbol's name, BASELINE_NAME the word, BASELINE_BITS the width.
 *
 * exp and acos are written out. gcc vectorises libm's with libmvec, but these are faster, plastic 1.5 times and full 1.2
 * times; clang, told of libmvec, has expf at up to 256 bits, plastic 2.3 times, and calls acosf lane by lane. */
#include "baseline.h"

#include <math.h>

#define INV_PI 0.318309886f
#define INLINE static inline __attribute__((always_inline))

typedef struct { float x, y, z; } vec3;
typedef struct { vec3 l, E; } light_numbers;

/* restrict counts on parameters alone: clang drops it on local pointers, and then does not vectorise. */
#define IN(a) const float *restrict a
#define IN3(a) IN(a##_x), IN(a##_y), IN(a##_z)
#define OUT3(a) float *restrict a##_x, float *restrict a##_y, float *restrict a##_z
#define AT(a, i) (vec3){ a##_x[i], a##_y[i], a##_z[i] }
#define PUT(a, i, value) do { vec3 put = value; a##_x[i] = put.x; a##_y[i] = put.y; a##_z[i] = put.z; } while (0)
#define SPREAD(a) a[0], a[1], a[2]

INLINE vec3 add(vec3 a, vec3 b) { return (vec3){ a.x + b.x, a.y + b.y, a.z + b.z }; }
INLINE vec3 mul(vec3 a, vec3 b) { return (vec3){ a.x * b.x, a.y * b.y, a.z * b.z }; }
INLINE vec3 scale(vec3 a, float s) { return (vec3){ a.x * s, a.y * s, a.z * s }; }
INLINE float dot(vec3 a, vec3 b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
INLINE vec3 cross(vec3 a, vec3 b)
{
    return (vec3){ a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x };
}
INLINE float larger(float a, float b) { return a > b ? a : b; }
INLINE float smaller(float a, float b) { return a < b ? a : b; }
INLINE float square(float a) { return a * a; }

/* One light at one sample; w = v + l. `lit` is 0 or nl, and the cosines are > 0. */
typedef struct { float nl, nv, vl, lit, hh, nw, nxw2; } incidence;

INLINE incidence look(vec3 n, vec3 v, vec3 l)
{
    vec3 w = add(v, l), nxw = cross(n, w);
    float nl = dot(n, l), nv = dot(n, v);
    return (incidence){ .nl = larger(nl, 1e-30f), .nv = larger(nv, 1e-30f), .vl = dot(v, l),
                        .lit = nl > 0.0f && nv > 0.0f ? nl : 0.0f, .hh = dot(w, w), .nw = nl + nv,
                        .nxw2 = dot(nxw, nxw) };
}

/* ---- Models ------------------------------------------------------------------------------------------------------ */

typedef struct { float A, B; } terms;

INLINE terms oren_nayar_terms(float sigma)
{
    float s2 = sigma * sigma;
    return (terms){ INV_PI - 0.5f * INV_PI * s2 / (s2 + 0.33f), 0.45f * INV_PI * s2 / (s2 + 0.09f) };
}

INLINE float oren_nayar(incidence i, terms t)
{
    return t.A + t.B * larger(0.0f, i.vl - i.nl * i.nv) / larger(i.nl, i.nv);
}

/* Abramowitz and Stegun, 4.4.46: within 2e-8, for x in [0, 1]. */
INLINE float arccos(float x)
{
    float p = -0.0012624911f;
    p = p * x + 0.0066700901f;
    p = p * x - 0.0170881256f;
    p = p * x + 0.0308918810f;
    p = p * x - 0.0501743046f;
    p = p * x + 0.0889789874f;
    p = p * x - 0.2145988016f;
    return sqrtf(1.0f - x) * (p * x + 1.5707963050f);
}

/* The factors of albedo and of its square. */
typedef struct { float once, twice; } scattered;

INLINE scattered oren_nayar_full(incidence i, float sigma)
{
    terms t = oren_nayar_terms(sigma);
    float s2 = sigma * sigma, C = 0.17f * INV_PI * s2 / (s2 + 0.13f);
    float cos_a = smaller(i.nl, i.nv), cos_b = smaller(larger(i.nl, i.nv), 1.0f);
    float sin_a = sqrtf(1.0f - cos_a * cos_a), sin_b = sqrtf(1.0f - cos_b * cos_b);
    float a = arccos(cos_a) * (2.0f * INV_PI), b = arccos(cos_b) * (2.0f * INV_PI);
    float s0 = i.vl - i.nl * i.nv;
    float cos_phi = larger(smaller(s0 / larger(1e-30f, sin_a * sin_b), 1.0f), -1.0f);
    float C2 = (s0 - smaller(cos_phi, 0.0f) * b * b * b * sin_b) / cos_b;
    float C3 = 0.125f / 0.45f * square(a * b) * (1.0f - fabsf(cos_phi)) * (sin_a + sin_b) / (cos_a + cos_b);
    return (scattered){ t.A + t.B * (C2 + C3), C * (1.0f - cos_phi * b * b) };
}

INLINE float slope(float alpha2, float mu) { return sqrtf(mu * mu + alpha2 * (1.0f - mu * mu)); }

/* D G/(4 nl nv). */
INLINE float ggx(incidence i, float alpha)
{
    float alpha2 = alpha * alpha, q = alpha * i.hh / (i.nxw2 + alpha2 * i.nw * i.nw);
    float V = 0.5f / (i.nl * slope(alpha2, i.nv) + i.nv * slope(alpha2, i.nl));
    return INV_PI * q * q * V;
}

/* Walter et al. 2007; a = mu/y. */
INLINE float lambda(float alpha, float mu)
{
    float y = alpha * sqrtf(larger(1.0f - mu * mu, 1e-12f));
    float some = (y * y - 1.259f * mu * y + 0.396f * mu * mu) / (mu * (3.535f * y + 2.181f * mu));
    return mu < 1.6f * y ? larger(some, 0.0f) : 0.0f;
}

/* e^-x for x in [0, 87]: 2^-k times a polynomial of what is left of x. */
INLINE float exp_minus(float x)
{
    float k = rintf(x * 1.44269504f), q = x - k * 0x1.62e4p-1f + k * 0x1.7f7d1cp-20f;
    float p = 0x1.686a4ep-10f;
    p = p * q - 0x1.123cf8p-7f;
    p = p * q + 0x1.555b82p-5f;
    p = p * q - 0x1.55548cp-3f;
    p = p * q + 0x1.fffff8p-2f;
    union { int32_t bits; float power; } two = { (127 - (int32_t)k) * (1 << 23) };
    return (1.0f - (q - q * q * p)) * two.power;
}

INLINE float beckmann(incidence i, float alpha)
{
    float over = 1.0f / (alpha * alpha), tan2 = i.nxw2 / (i.nw * i.nw);
    float D = INV_PI * over * exp_minus(smaller(tan2 * over, 87.0f)) * square(1.0f + tan2);
    return D * 0.25f / (i.nl * i.nv * (1.0f + lambda(alpha, i.nl) + lambda(alpha, i.nv)));
}

INLINE float cosine(incidence i) { return smaller(0.5f * sqrtf(i.hh), 1.0f); }

INLINE vec3 schlick(vec3 f0, float c)
{
    float d = 1.0f - c, d2 = d * d, d5 = d2 * d2 * d;
    return (vec3){ f0.x + (1.0f - f0.x) * d5, f0.y + (1.0f - f0.y) * d5, f0.z + (1.0f - f0.z) * d5 };
}

/* Cook and Torrance 1981, for eta > 1. */
INLINE float dielectric(float eta, float c)
{
    float m = (eta - 1.0f) * (eta + 1.0f), sum = sqrtf(m + c * c) + c, over = 1.0f / sum, difference = m * over;
    return 0.5f * square(difference * over) * (1.0f + square((c * sum - 1.0f) / (c * difference + 1.0f)));
}

/* Born and Wolf, ch. 14. */
INLINE float conductor(float eta, float k, float c)
{
    float c2 = c * c, sin2 = 1.0f - c2, t = eta * eta - k * k - sin2;
    float u = sqrtf(t * t + 4.0f * eta * eta * k * k), a = sqrtf(0.5f * (u + t));
    float Rs = (u + c2 - 2.0f * a * c) / (u + c2 + 2.0f * a * c);
    float across = c2 * u + sin2 * sin2, along = 2.0f * a * c * sin2;
    return 0.5f * Rs * (1.0f + (across - along) / (across + along));
}

/* ---- Workloads --------------------------------------------------------------------------------------------------- */

INLINE vec3 tile_sample(vec3 n, vec3 v, vec3 albedo, vec3 f0, terms t, float alpha, light_numbers light)
{
    incidence i = look(n, v, light.l);
    vec3 f = add(scale(albedo, oren_nayar(i, t)), scale(schlick(f0, cosine(i)), ggx(i, alpha)));
    return scale(mul(f, light.E), i.lit);
}

INLINE float clamp_alpha(float alpha) { return larger(smaller(alpha, 1.0f), FACET_ALPHA_FLOOR); }

static void shade_tile(size_t count, light_numbers light, IN3(n), IN3(v), IN3(albedo), IN(sigma), IN(alpha), IN3(f0),
                       OUT3(out))
{
    for (size_t i = 0; i < count; i++)
        PUT(out, i, tile_sample(AT(n, i), AT(v, i), AT(albedo, i), AT(f0, i), oren_nayar_terms(sigma[i]),
                                clamp_alpha(alpha[i]), light));
}

/* Written out: a loop over the lights keeps the compilers from vectorising that over the samples. */
static void shade_lights(size_t count, light_numbers a, light_numbers b, light_numbers c, light_numbers d, IN3(n),
                         IN3(v), IN3(albedo), IN(sigma), IN(alpha), IN3(f0), OUT3(out))
{
    for (size_t i = 0; i < count; i++) {
        vec3 n = AT(n, i), v = AT(v, i), albedo = AT(albedo, i), f0 = AT(f0, i);
        terms t = oren_nayar_terms(sigma[i]);
        float clamped = clamp_alpha(alpha[i]);
        vec3 ab = add(tile_sample(n, v, albedo, f0, t, clamped, a), tile_sample(n, v, albedo, f0, t, clamped, b));
        vec3 cd = add(tile_sample(n, v, albedo, f0, t, clamped, c), tile_sample(n, v, albedo, f0, t, clamped, d));
        PUT(out, i, add(ab, cd));
    }
}

static void shade_diffuse(size_t count, light_numbers light, IN3(n), IN3(v), IN3(albedo), IN(sigma), OUT3(out))
{
    for (size_t i = 0; i < count; i++) {
        incidence at = look(AT(n, i), AT(v, i), light.l);
        float f = oren_nayar(at, oren_nayar_terms(sigma[i]));
        PUT(out, i, scale(mul(AT(albedo, i), light.E), f * at.lit));
    }
}

static void shade_full(size_t count, light_numbers light, IN3(n), IN3(v), IN3(albedo), IN(sigma), OUT3(out))
{
    for (size_t i = 0; i < count; i++) {
        incidence at = look(AT(n, i), AT(v, i), light.l);
        scattered s = oren_nayar_full(at, sigma[i]);
        vec3 rho = AT(albedo, i), f = add(scale(rho, s.once), scale(mul(rho, rho), s.twice));
        vec3 kept = { larger(f.x, 0.0f), larger(f.y, 0.0f), larger(f.z, 0.0f) };
        PUT(out, i, scale(mul(kept, light.E), at.lit));
    }
}

static void shade_metal(size_t count, light_numbers light, vec3 eta, vec3 k, IN3(n), IN3(v), IN(alpha), OUT3(out))
{
    for (size_t i = 0; i < count; i++) {
        incidence at = look(AT(n, i), AT(v, i), light.l);
        float c = cosine(at), f = ggx(at, clamp_alpha(alpha[i]));
        vec3 F = { conductor(eta.x, k.x, c), conductor(eta.y, k.y, c), conductor(eta.z, k.z, c) };
        PUT(out, i, scale(mul(F, light.E), f * at.lit));
    }
}

static void shade_plastic(size_t count, light_numbers light, float eta, IN3(n), IN3(v), IN3(albedo), IN(sigma),
                          IN(alpha), OUT3(out))
{
    for (size_t i = 0; i < count; i++) {
        incidence at = look(AT(n, i), AT(v, i), light.l);
        float F = dielectric(eta, cosine(at));
        float under = (1.0f - F) * oren_nayar(at, oren_nayar_terms(sigma[i]));
        float specular = F * beckmann(at, clamp_alpha(alpha[i]));
        vec3 rho = AT(albedo, i), f = { rho.x * under + specular, rho.y * under + specular, rho.z * under + specular };
        PUT(out, i, scale(mul(f, light.E), at.lit));
    }
}

/* ---- Batches ----------------------------------------------------------------------------------------------------- */

static light_numbers light_of(const facet_batch *b, size_t k)
{
    const facet_light *light = &b->lights[k];
    return (light_numbers){ { SPREAD(light->direction) }, { SPREAD(light->irradiance) } };
}

static void tile(const facet_material *m, const facet_batch *b)
{
    (void)m;
    shade_tile(b->count, light_of(b, 0), SPREAD(b->normal), SPREAD(b->view), SPREAD(b->albedo), b->sigma, b->alpha,
               SPREAD(b->f0), SPREAD(b->radiance));
}

static void lights(const facet_material *m, const facet_batch *b)
{
    (void)m;
    shade_lights(b->count, light_of(b, 0), light_of(b, 1), light_of(b, 2), light_of(b, 3), SPREAD(b->normal),
                 SPREAD(b->view), SPREAD(b->albedo), b->sigma, b->alpha, SPREAD(b->f0), SPREAD(b->radiance));
}

static void diffuse(const facet_material *m, const facet_batch *b)
{
    (void)m;
    shade_diffuse(b->count, light_of(b, 0), SPREAD(b->normal), SPREAD(b->view), SPREAD(b->albedo), b->sigma,
                  SPREAD(b->radiance));
}

static void full(const facet_material *m, const facet_batch *b)
{
    (void)m;
    shade_full(b->count, light_of(b, 0), SPREAD(b->normal), SPREAD(b->view), SPREAD(b->albedo), b->sigma,
               SPREAD(b->radiance));
}

static void metal(const facet_material *m, const facet_batch *b)
{
    shade_metal(b->count, light_of(b, 0), (vec3){ SPREAD(m->fresnel.eta) }, (vec3){ SPREAD(m->fresnel.k) },
                SPREAD(b->normal), SPREAD(b->view), b->alpha, SPREAD(b->radiance));
}

static void plastic(const facet_material *m, const facet_batch *b)
{
    shade_plastic(b->count, light_of(b, 0), m->fresnel.eta[0], SPREAD(b->normal), SPREAD(b->view), SPREAD(b->albedo),
                  b->sigma, b->alpha, SPREAD(b->radiance));
}

extern const baseline BASELINE;
const baseline BASELINE = {
    BASELINE_NAME, AUTOVECTORIZED, BASELINE_BITS,
    { [SHADE_TILE] = tile, [SHADE_DIFFUSE] = diffuse, [SHADE_METAL] = metal, [SHADE_PLASTIC] = plastic,
      [SHADE_LIGHTS] = lights, [SHADE_FULL] = full },
};
