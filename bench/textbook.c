/* A baseline: the shader of textbooks and lecture slides, transcribed step by step: every vector normalised, every
 * angle taken with acosf, and what follows from the angles with sinf, tanf and powf. Compiled at -O2, as its readers
 * would. D takes sines from n x h, where the textbooks have 1 - nh^2: so it is the function that the others compute. */
#include "baseline.h"

#include <math.h>

typedef struct { float x, y, z; } vec3;

/* A sample's vectors. */
typedef struct { vec3 n, v, l, h; } directions;

static const float pi = 3.14159265f;

static vec3 vec(float x, float y, float z) { return (vec3){ x, y, z }; }
static vec3 add(vec3 a, vec3 b) { return vec(a.x + b.x, a.y + b.y, a.z + b.z); }
static vec3 sub(vec3 a, vec3 b) { return vec(a.x - b.x, a.y - b.y, a.z - b.z); }
static vec3 mul(vec3 a, float s) { return vec(a.x * s, a.y * s, a.z * s); }
static float dot(vec3 a, vec3 b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
static vec3 cross(vec3 a, vec3 b) { return vec(a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x); }
static vec3 normalize(vec3 a) { return mul(a, 1.0f / sqrtf(dot(a, a))); }
static float clamp01(float a) { return fminf(fmaxf(a, 0.0f), 1.0f); }

static vec3 vec_at(const float *const stream[3], size_t i) { return vec(stream[0][i], stream[1][i], stream[2][i]); }

static directions directions_at(const facet_batch *b, const facet_light *light, size_t i)
{
    directions d = { .n = normalize(vec_at(b->normal, i)), .v = normalize(vec_at(b->view, i)) };
    d.l = normalize(vec(light->direction[0], light->direction[1], light->direction[2]));
    d.h = normalize(add(d.v, d.l));
    return d;
}

/* ---- Diffuse --------------------------------------------------------------------------------------------------- */

/* The cosine of the azimuth between v and l. */
static float cos_azimuth(directions d)
{
    vec3 v_plane = normalize(sub(d.v, mul(d.n, dot(d.v, d.n)))), l_plane = normalize(sub(d.l, mul(d.n, dot(d.l, d.n))));
    return dot(v_plane, l_plane);
}

/* 1994, qualitative. */
static float oren_nayar(directions d, float sigma)
{
    float theta_r = acosf(clamp01(dot(d.n, d.v))), theta_i = acosf(clamp01(dot(d.n, d.l)));
    float alpha = fmaxf(theta_i, theta_r), beta = fminf(theta_i, theta_r), s2 = powf(sigma, 2.0f);
    float A = 1.0f - 0.5f * s2 / (s2 + 0.33f), B = 0.45f * s2 / (s2 + 0.09f);
    return (A + B * fmaxf(0.0f, cos_azimuth(d)) * sinf(alpha) * tanf(beta)) / pi;
}

/* 1994, eq. 30 and 31: f = albedo/pi once + albedo^2/pi twice. */
typedef struct { float once, twice; } scattered;

static scattered oren_nayar_full(directions d, float sigma)
{
    float theta_r = acosf(clamp01(dot(d.n, d.v))), theta_i = acosf(clamp01(dot(d.n, d.l)));
    float alpha = fmaxf(theta_i, theta_r), beta = fminf(theta_i, theta_r), s2 = powf(sigma, 2.0f);
    float cos_phi = cos_azimuth(d);
    float C1 = 1.0f - 0.5f * s2 / (s2 + 0.33f);
    float C2 = 0.45f * s2 / (s2 + 0.09f) * (sinf(alpha) - (cos_phi < 0.0f ? powf(2.0f * beta / pi, 3.0f) : 0.0f));
    float C3 = 0.125f * s2 / (s2 + 0.09f) * powf(4.0f * alpha * beta / (pi * pi), 2.0f);
    float once = C1 + cos_phi * C2 * tanf(beta) + (1.0f - fabsf(cos_phi)) * C3 * tanf((alpha + beta) / 2.0f);
    float twice = 0.17f * s2 / (s2 + 0.13f) * (1.0f - cos_phi * powf(2.0f * beta / pi, 2.0f));
    return (scattered){ once, twice };
}

/* ---- Specular -------------------------------------------------------------------------------------------------- */

static float tan_of(float cosine) { return tanf(acosf(clamp01(cosine))); }

static float lambda_ggx(float cosine, float alpha)
{
    return (-1.0f + sqrtf(1.0f + powf(alpha * tan_of(cosine), 2.0f))) / 2.0f;
}

/* Walter et al. 2007. */
static float lambda_beckmann(float cosine, float alpha)
{
    float a = 1.0f / (alpha * tan_of(cosine));
    return a < 1.6f ? fmaxf((1.0f - 1.259f * a + 0.396f * a * a) / (3.535f * a + 2.181f * a * a), 0.0f) : 0.0f;
}

/* D G/(4 nl nv). */
static float ggx(directions d, float alpha)
{
    float nl = dot(d.n, d.l), nv = dot(d.n, d.v), nh = dot(d.n, d.h);
    vec3 c = cross(d.n, d.h);
    float D = powf(alpha, 2.0f) / (pi * powf(dot(c, c) + powf(alpha * nh, 2.0f), 2.0f));
    float G = 1.0f / (1.0f + lambda_ggx(nl, alpha) + lambda_ggx(nv, alpha));
    return D * G / (4.0f * nl * nv);
}

static float beckmann(directions d, float alpha)
{
    float nl = dot(d.n, d.l), nv = dot(d.n, d.v), nh = dot(d.n, d.h);
    vec3 c = cross(d.n, d.h);
    float tan2 = dot(c, c) / powf(nh, 2.0f);
    float D = expf(-tan2 / powf(alpha, 2.0f)) / (pi * powf(alpha, 2.0f) * powf(nh, 4.0f));
    float G = 1.0f / (1.0f + lambda_beckmann(nl, alpha) + lambda_beckmann(nv, alpha));
    return D * G / (4.0f * nl * nv);
}

static float schlick(float f0, float cosine) { return f0 + (1.0f - f0) * powf(1.0f - cosine, 5.0f); }

/* Cook and Torrance 1981. */
static float dielectric(float eta, float c)
{
    float g = sqrtf(powf(eta, 2.0f) - 1.0f + powf(c, 2.0f));
    return 0.5f * powf(g - c, 2.0f) / powf(g + c, 2.0f)
        * (1.0f + powf(c * (g + c) - 1.0f, 2.0f) / powf(c * (g - c) + 1.0f, 2.0f));
}

/* Born and Wolf, ch. 14. */
static float conductor(float eta, float k, float cosine)
{
    float theta = acosf(cosine), sine = sinf(theta), tangent = tanf(theta);
    float t = powf(eta, 2.0f) - powf(k, 2.0f) - powf(sine, 2.0f);
    float root = sqrtf(powf(t, 2.0f) + 4.0f * powf(eta, 2.0f) * powf(k, 2.0f));
    float a2 = 0.5f * (root + t), b2 = 0.5f * (root - t), a = sqrtf(a2);
    float Rs = (a2 + b2 - 2.0f * a * cosine + powf(cosine, 2.0f)) / (a2 + b2 + 2.0f * a * cosine + powf(cosine, 2.0f));
    float Rp = Rs * (a2 + b2 - 2.0f * a * sine * tangent + powf(sine, 2.0f) * powf(tangent, 2.0f))
        / (a2 + b2 + 2.0f * a * sine * tangent + powf(sine, 2.0f) * powf(tangent, 2.0f));
    return 0.5f * (Rs + Rp);
}

/* ---- Shaders: the radiance of one light at one sample ------------------------------------------------------------ */

typedef void sample_shader(const facet_material *m, const facet_batch *b, size_t i, directions d, float f[3]);

static void tile_sample(const facet_material *m, const facet_batch *b, size_t i, directions d, float f[3])
{
    float diffuse = oren_nayar(d, b->sigma[i]), specular = ggx(d, b->alpha[i]);
    (void)m;
    for (int c = 0; c < 3; c++)
        f[c] = b->albedo[c][i] * diffuse + specular * schlick(b->f0[c][i], clamp01(dot(d.v, d.h)));
}

static void diffuse_sample(const facet_material *m, const facet_batch *b, size_t i, directions d, float f[3])
{
    float diffuse = oren_nayar(d, b->sigma[i]);
    (void)m;
    for (int c = 0; c < 3; c++) f[c] = b->albedo[c][i] * diffuse;
}

static void metal_sample(const facet_material *m, const facet_batch *b, size_t i, directions d, float f[3])
{
    float specular = ggx(d, b->alpha[i]);
    for (int c = 0; c < 3; c++)
        f[c] = specular * conductor(m->fresnel.eta[c], m->fresnel.k[c], clamp01(dot(d.v, d.h)));
}

static void plastic_sample(const facet_material *m, const facet_batch *b, size_t i, directions d, float f[3])
{
    float diffuse = oren_nayar(d, b->sigma[i]), specular = beckmann(d, b->alpha[i]);
    float F = dielectric(m->fresnel.eta[0], clamp01(dot(d.v, d.h)));
    for (int c = 0; c < 3; c++) f[c] = b->albedo[c][i] * diffuse * (1.0f - F) + specular * F;
}

static void full_sample(const facet_material *m, const facet_batch *b, size_t i, directions d, float f[3])
{
    scattered s = oren_nayar_full(d, b->sigma[i]);
    (void)m;
    for (int c = 0; c < 3; c++)
        f[c] = fmaxf(b->albedo[c][i] / pi * s.once + powf(b->albedo[c][i], 2.0f) / pi * s.twice, 0.0f);
}

static void shade(const facet_material *m, const facet_batch *b, sample_shader *shade_sample)
{
    for (size_t i = 0; i < b->count; i++) {
        float radiance[3] = { 0.0f, 0.0f, 0.0f };
        for (size_t k = 0; k < b->light_count; k++) {
            directions d = directions_at(b, &b->lights[k], i);
            float f[3], nl = dot(d.n, d.l);
            if (nl <= 0.0f || dot(d.n, d.v) <= 0.0f) continue;
            shade_sample(m, b, i, d, f);
            for (int c = 0; c < 3; c++) radiance[c] += f[c] * b->lights[k].irradiance[c] * nl;
        }
        for (int c = 0; c < 3; c++) b->radiance[c][i] = radiance[c];
    }
}

static void tile(const facet_material *m, const facet_batch *b) { shade(m, b, tile_sample); }
static void diffuse(const facet_material *m, const facet_batch *b) { shade(m, b, diffuse_sample); }
static void metal(const facet_material *m, const facet_batch *b) { shade(m, b, metal_sample); }
static void plastic(const facet_material *m, const facet_batch *b) { shade(m, b, plastic_sample); }
static void full(const facet_material *m, const facet_batch *b) { shade(m, b, full_sample); }

extern const baseline baseline_literal;
const baseline baseline_literal = {
    "literal", TEXTBOOK, 0,
    { [SHADE_TILE] = tile, [SHADE_DIFFUSE] = diffuse, [SHADE_METAL] = metal, [SHADE_PLASTIC] = plastic,
      [SHADE_LIGHTS] = tile, [SHADE_FULL] = full },
};
