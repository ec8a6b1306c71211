/* EXR files as planes of floats, one plane a channel. */
#ifndef EXR_H
#define EXR_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

enum {
    EXR_PIXELS_MAX = 1 << 25,      /* of a data window; 7680 x 4320 is below it */
    EXR_LAYERS_MAX = 4,
    EXR_WHY = 512
};

/* Where an image lies. Windows are the first and the last pixel: x, y, x, y. */
typedef struct exr_frame {
    int32_t data[4], display[4];
    float pixel_aspect;
    size_t width, height;          /* of the data window, which is what planes hold, row by row */
} exr_frame;

/* Three channels that end in NAME.C, or C where the name is empty, after the same prefix; C is each of `components`. */
typedef struct exr_layer {
    const char *name, *components;
    float *plane[3];               /* from exr_load; exr_free releases them */
} exr_layer;

/* Loads `layers` from the first part of the file that has them all: under the first prefix, in the order of channels,
 * that they share; failing that, from where each of them is the only one of its name. Scanlines and tiles (the first
 * level), any compression of OpenEXRCore, half, float and uint. At most EXR_LAYERS_MAX. On failure no plane is left and
 * `why` is filled. */
bool exr_load(const char *path, exr_frame *frame, exr_layer *layers, int count, char why[EXR_WHY]);

void exr_free(exr_layer *layers, int count);

/* Writes float channels R, G, B, zip-compressed. A regular file is replaced when the new one is complete, and not
 * touched on failure; a device is written to as it is. */
bool exr_save(const char *path, const exr_frame *frame, float *const rgb[3], char why[EXR_WHY]);

#endif
