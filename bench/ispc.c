/* A baseline: what ISPC makes of tile.ispc, for the widest vectors that it knows of this CPU. */
#include "baseline.h"

void tile_ispc(int32_t count, const float *light, const float *irradiance, const float *n_x, const float *n_y,
               const float *n_z, const float *v_x, const float *v_y, const float *v_z, const float *albedo_r,
               const float *albedo_g, const float *albedo_b, const float *sigma, const float *alpha,
               const float *f0_r, const float *f0_g, const float *f0_b, float *out_r, float *out_g, float *out_b);

#define SPREAD(a) a[0], a[1], a[2]

static void tile(const facet_material *m, const facet_batch *b)
{
    (void)m;
    tile_ispc((int32_t)b->count, b->lights->direction, b->lights->irradiance, SPREAD(b->normal), SPREAD(b->view),
              SPREAD(b->albedo), b->sigma, b->alpha, SPREAD(b->f0), SPREAD(b->radiance));
}

extern const baseline baseline_ispc;
const baseline baseline_ispc = { "ispc", EXPLICIT, BASELINE_BITS, { [SHADE_TILE] = tile } };
