/* A z-buffer rasterizer in two steps: draw finds the nearest triangle at every sample of the picture, and tile fills a
 * tile's G-buffer from what was found, as a backend hands it to facet_shade. */
#ifndef RASTER_H
#define RASTER_H

#include "mesh.h"

/* 512 samples: a tile's G-buffer and its radiance fit an L1 cache of 32 KiB. */
enum { TILE_WIDTH = 32, TILE_HEIGHT = 16, TILE_SAMPLES = TILE_WIDTH * TILE_HEIGHT };

/* Streams as facet_batch takes them: sample x, y of the tile is at y TILE_WIDTH + x. Unit normals, unit vectors to the
 * eye, positions, unit tangents perpendicular to the normals, and the part of the mesh. What is not covered is zero. */
typedef struct gbuffer {
    float normal[3][TILE_SAMPLES], view[3][TILE_SAMPLES], position[3][TILE_SAMPLES], tangent[3][TILE_SAMPLES];
    uint8_t part[TILE_SAMPLES], coverage[TILE_SAMPLES / 8];
    size_t covered;
} gbuffer;

/* The eye is at the origin and looks along -z, y up. */
typedef struct raster {
    size_t width, height;      /* samples */
    double focal;              /* the picture plane's distance, in samples */
    float *depth;              /* 1/distance along the view axis; 0: nothing */
    uint32_t *triangle;        /* which, where depth is not 0 */
} raster;

/* fov: the vertical angle of view, degrees. False where memory ends. */
bool raster_init(raster *r, size_t width, size_t height, double fov);
void raster_free(raster *r);

/* Draws `count` of the mesh's triangles from `first` on, both of their sides. */
void raster_draw(raster *r, const mesh *m, size_t first, size_t count);

/* How many tiles the picture has, and of these in a row. */
size_t raster_tiles(const raster *r, size_t *columns);

/* Fills the G-buffer of the tile in the given column and row; positions and tangents where `streams`, FACET_STREAM_*,
 * has them. */
void raster_tile(const raster *r, const mesh *m, size_t column, size_t row, uint32_t streams, gbuffer *g);

/* Fills the coverage of one part alone; returns how many samples it has. */
size_t raster_part(const gbuffer *g, size_t part, uint8_t coverage[TILE_SAMPLES / 8]);

#endif
