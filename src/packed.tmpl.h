/* Packed streams, once for every architecture and tier: facet_packed's formulas, a vector at a time. They become floats
 * a block at a time (block.tmpl.h): where a kernel unpacked them itself it gained 7 %. Words are 32 bits of anything in
 * a vf's lanes. */
#ifndef FACET_PACKED_TMPL_H
#define FACET_PACKED_TMPL_H

#include "models.tmpl.h"

/* How far left in a word the part of so many bits stands that is the index-th in memory. */
#define BIG_END_FIRST (__BYTE_ORDER__ == __ORDER_BIG_ENDIAN__)
#define PLACE(index, bits) (BIG_END_FIRST ? 32 - (bits) * ((index) + 1) : (bits) * (index))

/* ---- In ---------------------------------------------------------------------------------------------------------- */

/* That part of a word, with zeros behind it. */
OP vf part(vf words, int index, int bits) { return vf_shift_left(words, 32 - bits - PLACE(index, bits)); }

/* 2^23 + a, where a's bits are an integer below 2^23. */
OP vf with_2_23(vf a) { return vf_or(a, splat(0x1p23f)); }

/* unorm8: a byte over 255, within one unit in the last place; 255 is 1. */
OP vf unorm8(vf words, int index)
{
    return (with_2_23(vf_shift_right(part(words, index, 8), 24)) - 0x1p23f) * (1.0f / 255.0f);
}
OP vf3 unorm8_3(vf words) { return (vf3){ unorm8(words, 0), unorm8(words, 1), unorm8(words, 2) }; }

/* snorm16 times 32767: its integer, but -32767 for -32768. */
OP vf snorm16_32767(vf words, int index)
{
    vf from_least = vf_shift_right(vf_bits_minus(part(words, index, 16), splat(-0.0f)), 16);
    return vf_max(with_2_23(from_least) - (0x1p23f + 32768.0f), splat(-32767.0f));
}

/* Cigolle et al. 2014: x and y of the octahedron |x| + |y| + |z| = 1, whose lower half is folded outwards over the
 * upper one's edges: z = 1 - |x| - |y|, and where it is below 0, |x| and |y| lose as much. Times 32767 all is integers;
 * the normalisation leaves at most 3.5 units of 2^-24 in each component, relative: strict, of every pair the worst is
 * (3158, 23375). Nearly all of it is length: what turns the normal is less than one unit. */
OP vf3 octahedral(vf words)
{
    vf x = snorm16_32767(words, 0), y = snorm16_32767(words, 1), z = 32767.0f - vf_abs(x) - vf_abs(y);
    vf folded = vf_not_negative(-z);
    vf3 n = { x - vf_flip(folded, x), y - vf_flip(folded, y), z };
    return scale3(n, 1.0f / vf_sqrt(dot(n, n)));
}

/* Where the samples of a vector begin in a batch's rows. */
typedef struct { size_t column, row; } camera_pixel;

OP size_t row_length(const facet_camera *camera) { return camera->width ? camera->width : PIXELS; }

OP camera_pixel pixel_of(const facet_camera *camera, size_t sample)
{
    const size_t width = row_length(camera);
    return (camera_pixel){ sample % width, sample / width };
}

OP camera_pixel next_pixel(const facet_camera *camera, camera_pixel at)
{
    const size_t width = row_length(camera);
    at.column += VF_LANES;
    for (; at.column >= width; at.column -= width) at.row++;
    return at;
}

/* Towards the eye from the pixels of a vector. A lane's row is the integer next to (x + 1/2)/width - 1/2, exactly: what
 * is rounded away of that is less than half of 1/width, as width <= PIXELS. */
OP vf3 view_of_pixels(const facet_camera *camera, camera_pixel at)
{
    static const float lanes[16] = { 0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15 };
    const size_t width = row_length(camera);
    const float inverse = 1.0f / (float)width;
    vf x = splat((float)at.column) + vf_load(lanes);
    vf rows = vf_mad(x, splat(inverse), splat(0.5f * inverse - 0.5f)) + 0x1.8p23f - 0x1.8p23f;
    x = vf_nmad(rows, splat((float)width), x) + splat((float)camera->x);
    vf y = rows + splat((float)(camera->y + at.row));
    vf3 ray = mad3(splat3(camera->across), same3(x), mad3(splat3(camera->down), same3(y), splat3(camera->corner)));
    return scale3(ray, -1.0f / vf_sqrt(dot(ray, ray)));
}

OP vf load_words(const void *stream, size_t i) { return vf_load((const float *)stream + i); }

/* A stream that comes packed in words: a vector from the i-th on. */
OP vf unpacked_1(uint32_t stream, const plan_fields *plan, const facet_packed *p, size_t i)
{
    switch (stream) {
    case FACET_STREAM_ALPHA: return alpha_of_roughness(unorm8(load_words(p->albedo_roughness, i), 3));
    case FACET_STREAM_ROUGHNESS: return unorm8(load_words(p->albedo_roughness, i), 3);
    case FACET_STREAM_GLOSSINESS: return 1.0f - unorm8(load_words(p->albedo_roughness, i), 3);
    case FACET_STREAM_SIGMA: return unorm8(load_words(p->f0_sigma, i), 3) * splat(plan->sigma_max);
    }
    return splat(0.0f);
}
OP vf3 unpacked_3(uint32_t stream, const plan_fields *plan, const facet_packed *p, size_t i)
{
    (void)plan;
    switch (stream) {
    case FACET_STREAM_NORMAL: return octahedral(load_words(p->normal, i));
    case FACET_STREAM_ALBEDO:
    case FACET_STREAM_BASE: return unorm8_3(load_words(p->albedo_roughness, i));
    case FACET_STREAM_F0: return unorm8_3(load_words(p->f0_sigma, i));
    }
    return ZERO3;
}

/* ---- Out --------------------------------------------------------------------------------------------------------- */

/* 255 times the curve of IEC 61966-2-1 for a in [0, 1], within PIXEL_ERROR. Above the linear part, of the root s, 255
 * (1.055 s^(5/6) - 0.055) as a rational function. Of all floats the worst is 2^-12.29 at 0x1.b4502cp-1 where it fuses,
 * else 2^-12.32 at 0x1.aeec5ep-1. */
#define PIXEL_ERROR 0x1p-12f
OP vf srgb_255(vf a)
{
    vf s = vf_sqrt(a), p = splat(3387.47251f), q = splat(20.2490061f);
    p = vf_mad(p, s, splat(16089.9882f));
    p = vf_mad(p, s, splat(7200.09581f));
    p = vf_mad(p, s, splat(223.745367f));
    p = vf_mad(p, s, splat(-12.8197939f));
    q = vf_mad(q, s, splat(62.129726f));
    q = vf_mad(q, s, splat(22.0662398f));
    q = vf_mad(q, s, splat(1.0f));
    return vf_select(vf_lt(a, splat(0.0031308f)), a * (12.92f * 255.0f), p / q);
}

/* The byte of a radiance in the low bits, 0 of a NaN; `doubtful` gets a sign where rounding may have gone wrong. */
OP vf pixel_byte(vf radiance, vf exposure, vf *doubtful)
{
    vf exact = srgb_255(clamp(radiance * exposure, 0.0f, 1.0f)), byte = exact + 0x1p23f;
    vf distance = vf_abs(exact - (byte - 0x1p23f));
    *doubtful = vf_or(*doubtful, vf_bits_minus(splat(0.5f - PIXEL_ERROR), distance));
    return vf_bits_minus(byte, splat(0x1p23f));
}

/* R, G, B and 255 in memory. */
OP vf pixel_words(vf3 bytes)
{
    vf opaque = splat(BIG_END_FIRST ? 0x1.fep-142f : -0x1p127f);
    vf rg = vf_or(vf_shift_left(bytes.x, PLACE(0, 8)), vf_shift_left(bytes.y, PLACE(1, 8)));
    return vf_or(vf_or(rg, vf_shift_left(bytes.z, PLACE(2, 8))), opaque);
}

/* Those pixels of a vector that are in doubt, exactly. */
static __attribute__((noinline, cold)) void correct_pixels(float (*radiance)[VF_LANES], float exposure,
                                                           uint32_t doubtful, uint8_t *pixels)
{
    for (; doubtful; doubtful &= doubtful - 1) {
        const int lane = __builtin_ctz(doubtful);
        for (int c = 0; c < 3; c++) pixels[4 * lane + c] = facet_srgb_byte(radiance[c][lane] * exposure);
    }
}

/* A vector of radiance as pixels. */
OP void store_pixels(uint8_t *pixels, vf3 radiance, float exposure)
{
    vf doubtful = splat(0.0f), e = splat(exposure);
    vf3 bytes = { pixel_byte(radiance.x, e, &doubtful), pixel_byte(radiance.y, e, &doubtful),
                  pixel_byte(radiance.z, e, &doubtful) };
    vf_store((float *)(void *)pixels, pixel_words(bytes));
    const uint32_t lanes = vf_signs(doubtful);
    if (__builtin_expect(!lanes, 1)) return;
    float memory[3][VF_LANES];
    vf_store(memory[0], radiance.x);
    vf_store(memory[1], radiance.y);
    vf_store(memory[2], radiance.z);
    correct_pixels(memory, exposure, lanes, pixels);
}

/* A vector of radiance, as halves and as pixels, to sample i. */
OP void store_packed(const facet_packed *p, size_t i, vf3 radiance)
{
    if (p->half[0]) {
        vf most = splat(65504.0f);
        vf_store_half(p->half[0] + i, vf_min(radiance.x, most));
        vf_store_half(p->half[1] + i, vf_min(radiance.y, most));
        vf_store_half(p->half[2] + i, vf_min(radiance.z, most));
    }
    if (p->pixels) store_pixels(p->pixels + 4 * i, radiance, p->exposure > 0.0f ? p->exposure : 1.0f);
}

#endif
