/* PNG and PFM files. Both functions say what is wrong. */
#ifndef IMAGE_H
#define IMAGE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* 8-bit sRGB pixels R, G, B, A; opaque pictures are written without A. */
bool image_write_png(const char *path, const uint8_t *rgba, size_t width, size_t height, bool opaque);

/* Linear radiance, three floats a pixel, the top row first (PFM itself has the bottom row first). */
bool image_write_pfm(const char *path, const float *rgb, size_t width, size_t height);

#endif
