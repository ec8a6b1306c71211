/* What facet_packed's formulas make of packed numbers. */
#include "packed.h"

#include <math.h>
#include <stdlib.h>

static int snorm16(int16_t x) { return x < -32767 ? -32767 : x; }

/* The octahedron's components times 32767. */
static void unfold(const int16_t packed[2], int c[3])
{
    const int x = snorm16(packed[0]), y = snorm16(packed[1]);
    c[0] = x, c[1] = y, c[2] = 32767 - abs(x) - abs(y);
    if (c[2] >= 0) return;
    c[0] = x < 0 ? x - c[2] : x + c[2];
    c[1] = y < 0 ? y - c[2] : y + c[2];
}

void unpack_normal(const int16_t packed[2], float n[3])
{
    int c[3];
    unfold(packed, c);
    const float x = (float)c[0], y = (float)c[1], z = (float)c[2], inverse = 1 / sqrtf(z * z + (y * y + x * x));
    n[0] = x * inverse, n[1] = y * inverse, n[2] = z * inverse;
}

void exact_normal(const int16_t packed[2], double n[3])
{
    int c[3];
    unfold(packed, c);
    const double x = c[0], y = c[1], z = c[2], length = sqrt(x * x + y * y + z * z);
    n[0] = x / length, n[1] = y / length, n[2] = z / length;
}

typedef struct { size_t column, row; } pixel;

static pixel pixel_of(const facet_camera *camera, size_t i)
{
    const size_t row = camera->width ? i / camera->width : 0;
    return (pixel){ camera->x + (i - row * camera->width), camera->y + row };
}

void unpack_view(const facet_camera *camera, size_t i, float v[3])
{
    const pixel p = pixel_of(camera, i);
    for (int c = 0; c < 3; c++)
        v[c] = camera->across[c] * (float)p.column + (camera->down[c] * (float)p.row + camera->corner[c]);
    const float inverse = -1 / sqrtf(v[2] * v[2] + (v[1] * v[1] + v[0] * v[0]));
    for (int c = 0; c < 3; c++) v[c] *= inverse;
}

void exact_view(const facet_camera *camera, size_t i, double v[3])
{
    const pixel p = pixel_of(camera, i);
    for (int c = 0; c < 3; c++)
        v[c] = (double)camera->corner[c] + (double)camera->across[c] * (double)p.column
             + (double)camera->down[c] * (double)p.row;
    const double length = sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
    for (int c = 0; c < 3; c++) v[c] = -v[c] / length;
}

float unpack_unorm8(uint8_t byte) { return (float)byte * (1.0f / 255); }
