/* A baseline: the same function as the library's, branch-free in plain C over arrays, for a compiler's vectoriser at
 * -O3 -ffast-math -march=native. The Makefile compiles it by each compiler at each vector width; TILE_SHADER is the
 * function's name. */
#include "tile.h"

#include <math.h>

static inline float larger(float a, float b) { return a > b ? a : b; }
static inline float smaller(float a, float b) { return a < b ? a : b; }
static inline float slope(float alpha2, float mu) { return sqrtf(mu * mu + alpha2 * (1.0f - mu * mu)); }

/* restrict counts on parameters alone: clang drops it on local pointers, and then does not vectorise. */
static void shade(size_t count, const float *restrict nx, const float *restrict ny, const float *restrict nz,
                  const float *restrict vx, const float *restrict vy, const float *restrict vz,
                  const float *restrict albedo_r, const float *restrict albedo_g, const float *restrict albedo_b,
                  const float *restrict sigma, const float *restrict alpha_of,
                  const float *restrict f0_r, const float *restrict f0_g, const float *restrict f0_b,
                  float lx, float ly, float lz, float er, float eg, float eb,
                  float *restrict out_r, float *restrict out_g, float *restrict out_b)
{
    for (size_t i = 0; i < count; i++) {
        float nl = nx[i] * lx + ny[i] * ly + nz[i] * lz;
        float nv = nx[i] * vx[i] + ny[i] * vy[i] + nz[i] * vz[i];
        float vl = vx[i] * lx + vy[i] * ly + vz[i] * lz;
        float lit = nl > 0.0f && nv > 0.0f ? 1.0f : 0.0f;
        nl = larger(nl, 1e-30f);
        nv = larger(nv, 1e-30f);

        float s2 = sigma[i] * sigma[i];
        float A = 1.0f - 0.5f * s2 / (s2 + 0.33f), B = 0.45f * s2 / (s2 + 0.09f);
        float diffuse = 0.318309886f * (A + B * larger(0.0f, vl - nl * nv) / larger(nl, nv));

        float wx = vx[i] + lx, wy = vy[i] + ly, wz = vz[i] + lz;
        float hh = wx * wx + wy * wy + wz * wz, nw = nx[i] * wx + ny[i] * wy + nz[i] * wz;
        float cx = ny[i] * wz - nz[i] * wy, cy = nz[i] * wx - nx[i] * wz, cz = nx[i] * wy - ny[i] * wx;
        float alpha = larger(smaller(alpha_of[i], 1.0f), 1e-4f), alpha2 = alpha * alpha;
        float q = alpha * hh / (cx * cx + cy * cy + cz * cz + alpha2 * nw * nw);
        float D = 0.318309886f * q * q;
        float V = 0.5f / (nl * slope(alpha2, nv) + nv * slope(alpha2, nl));
        float c = larger(1.0f - 0.5f * sqrtf(hh), 0.0f), c2 = c * c, c5 = c2 * c2 * c;
        float specular = D * V, scale = lit * nl;

        out_r[i] = (albedo_r[i] * diffuse + specular * (f0_r[i] + (1.0f - f0_r[i]) * c5)) * scale * er;
        out_g[i] = (albedo_g[i] * diffuse + specular * (f0_g[i] + (1.0f - f0_g[i]) * c5)) * scale * eg;
        out_b[i] = (albedo_b[i] * diffuse + specular * (f0_b[i] + (1.0f - f0_b[i]) * c5)) * scale * eb;
    }
}

void TILE_SHADER(const tile *t)
{
    shade(t->count, t->normal[0], t->normal[1], t->normal[2], t->view[0], t->view[1], t->view[2],
          t->albedo[0], t->albedo[1], t->albedo[2], t->sigma, t->alpha, t->f0[0], t->f0[1], t->f0[2],
          t->light[0], t->light[1], t->light[2], t->irradiance[0], t->irradiance[1], t->irradiance[2],
          t->radiance[0], t->radiance[1], t->radiance[2]);
}
