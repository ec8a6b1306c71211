/* How fast each architecture shades the frame's own tiles. */
#ifndef SHADING_RATE_H
#define SHADING_RATE_H

#include "demo_options.h"
#include "raster.h"

/* The batch of a tile: its G-buffer, with positions and tangents where `streams`, FACET_STREAM_*, has them; the light,
 * and where the radiance goes. */
facet_batch tile_batch(const options *o, uint32_t streams, gbuffer *g, float radiance[3][TILE_SAMPLES]);

/* Prints the samples shaded a second on one thread, for every arch of this CPU and both tiers, and those shaded and
 * encoded on all threads, for the target of the options. Says what is wrong. */
bool shading_rate(const options *o, const facet_material *material, uint32_t streams, const mesh *m, const raster *r);

#endif
