/* A baseline: the shader of the lecture slides, transcribed step by step: every vector normalised, every angle taken
 * with acosf, and what follows from the angles with sinf, tanf and powf. Compiled at -O2, as its readers would. */
#include "tile.h"

#include <math.h>

typedef struct { float x, y, z; } vec3;

static const float pi = 3.14159265f;

static vec3 vec(float x, float y, float z) { return (vec3){ x, y, z }; }
static vec3 add(vec3 a, vec3 b) { return vec(a.x + b.x, a.y + b.y, a.z + b.z); }
static vec3 sub(vec3 a, vec3 b) { return vec(a.x - b.x, a.y - b.y, a.z - b.z); }
static vec3 mul(vec3 a, float s) { return vec(a.x * s, a.y * s, a.z * s); }
static float dot(vec3 a, vec3 b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
static vec3 normalize(vec3 a) { return mul(a, 1.0f / sqrtf(dot(a, a))); }
static float clamp01(float a) { return fminf(fmaxf(a, 0.0f), 1.0f); }

static float oren_nayar(vec3 n, vec3 v, vec3 l, float sigma)
{
    float theta_r = acosf(clamp01(dot(n, v))), theta_i = acosf(clamp01(dot(n, l)));
    float a = fmaxf(theta_i, theta_r), b = fminf(theta_i, theta_r);
    vec3 v_plane = normalize(sub(v, mul(n, dot(v, n)))), l_plane = normalize(sub(l, mul(n, dot(l, n))));
    float cos_phi = dot(v_plane, l_plane);
    float s2 = powf(sigma, 2.0f);
    float A = 1.0f - 0.5f * s2 / (s2 + 0.33f), B = 0.45f * s2 / (s2 + 0.09f);
    return (A + B * fmaxf(0.0f, cos_phi) * sinf(a) * tanf(b)) / pi;
}

static float lambda(float cosine, float alpha)
{
    float tangent = tanf(acosf(clamp01(cosine)));
    return (-1.0f + sqrtf(1.0f + powf(alpha * tangent, 2.0f))) / 2.0f;
}

/* D G/(4 nl nv); D in the well-conditioned form, so that it is the function that the others compute. */
static float ggx(vec3 n, vec3 v, vec3 l, vec3 h, float alpha)
{
    float nl = dot(n, l), nv = dot(n, v), nh = dot(n, h);
    vec3 c = vec(n.y * h.z - n.z * h.y, n.z * h.x - n.x * h.z, n.x * h.y - n.y * h.x);
    float D = powf(alpha, 2.0f) / (pi * powf(dot(c, c) + powf(alpha * nh, 2.0f), 2.0f));
    float G = 1.0f / (1.0f + lambda(nl, alpha) + lambda(nv, alpha));
    return D * G / (4.0f * nl * nv);
}

void tile_textbook(const tile *t)
{
    for (size_t i = 0; i < t->count; i++) {
        vec3 n = normalize(vec(t->normal[0][i], t->normal[1][i], t->normal[2][i]));
        vec3 v = normalize(vec(t->view[0][i], t->view[1][i], t->view[2][i]));
        vec3 l = normalize(vec(t->light[0], t->light[1], t->light[2]));
        vec3 h = normalize(add(v, l));
        float nl = dot(n, l), diffuse = 0.0f, specular = 0.0f;
        if (nl > 0.0f && dot(n, v) > 0.0f) {
            diffuse = oren_nayar(n, v, l, t->sigma[i]);
            specular = ggx(n, v, l, h, t->alpha[i]);
        }
        for (int c = 0; c < 3; c++) {
            float F = t->f0[c][i] + (1.0f - t->f0[c][i]) * powf(1.0f - clamp01(dot(v, h)), 5.0f);
            t->radiance[c][i] = (t->albedo[c][i] * diffuse + specular * F) * t->irradiance[c] * fmaxf(nl, 0.0f);
        }
    }
}
