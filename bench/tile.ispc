/* A baseline: tile in ISPC, the formula of autovectorized.c. */
#define INV_PI 0.318309886f

static inline float slope(float alpha2, float mu) { return sqrt(mu * mu + alpha2 * (1.0f - mu * mu)); }

export void tile_ispc(uniform int count, uniform const float light[], uniform const float irradiance[],
                      uniform const float n_x[], uniform const float n_y[], uniform const float n_z[],
                      uniform const float v_x[], uniform const float v_y[], uniform const float v_z[],
                      uniform const float albedo_r[], uniform const float albedo_g[], uniform const float albedo_b[],
                      uniform const float sigma[], uniform const float alpha[],
                      uniform const float f0_r[], uniform const float f0_g[], uniform const float f0_b[],
                      uniform float out_r[], uniform float out_g[], uniform float out_b[])
{
    const uniform float lx = light[0], ly = light[1], lz = light[2];
    const uniform float er = irradiance[0], eg = irradiance[1], eb = irradiance[2];
    foreach (i = 0 ... count) {
        const float nx = n_x[i], ny = n_y[i], nz = n_z[i], vx = v_x[i], vy = v_y[i], vz = v_z[i];
        const float true_nl = nx * lx + ny * ly + nz * lz, true_nv = nx * vx + ny * vy + nz * vz;
        const float vl = vx * lx + vy * ly + vz * lz;
        const float lit = true_nl > 0.0f && true_nv > 0.0f ? true_nl : 0.0f;
        const float nl = max(true_nl, 1e-30f), nv = max(true_nv, 1e-30f);

        const float s2 = sigma[i] * sigma[i];
        const float A = INV_PI - 0.5f * INV_PI * s2 / (s2 + 0.33f), B = 0.45f * INV_PI * s2 / (s2 + 0.09f);
        const float diffuse = A + B * max(0.0f, vl - nl * nv) / max(nl, nv);

        const float wx = vx + lx, wy = vy + ly, wz = vz + lz;
        const float hh = wx * wx + wy * wy + wz * wz, nw = true_nl + true_nv;
        const float cx = ny * wz - nz * wy, cy = nz * wx - nx * wz, cz = nx * wy - ny * wx;
        const float a = clamp(alpha[i], 1e-4f, 1.0f), a2 = a * a;
        const float q = a * hh / (cx * cx + cy * cy + cz * cz + a2 * nw * nw);
        const float V = 0.5f / (nl * slope(a2, nv) + nv * slope(a2, nl)), specular = INV_PI * q * q * V;
        const float d = 1.0f - min(0.5f * sqrt(hh), 1.0f), d2 = d * d, d5 = d2 * d2 * d;

        out_r[i] = (albedo_r[i] * diffuse + specular * (f0_r[i] + (1.0f - f0_r[i]) * d5)) * er * lit;
        out_g[i] = (albedo_g[i] * diffuse + specular * (f0_g[i] + (1.0f - f0_g[i]) * d5)) * eg * lit;
        out_b[i] = (albedo_b[i] * diffuse + specular * (f0_b[i] + (1.0f - f0_b[i]) * d5)) * eb * lit;
    }
}
