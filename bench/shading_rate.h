/* How fast each architecture shades the frame's own tiles. */
#ifndef SHADING_RATE_H
#define SHADING_RATE_H

#include "demo_options.h"
#include "raster.h"

/* The batch of a tile: its G-buffer, the lights, and where the radiance goes. */
facet_batch tile_batch(const options *o, gbuffer *g, float radiance[3][TILE_SAMPLES]);

/* Prints the samples shaded a second for every arch of this CPU and both tiers. Says what is wrong. */
bool shading_rate(const options *o, const facet_material *material, const mesh *m, const raster *r);

#endif
