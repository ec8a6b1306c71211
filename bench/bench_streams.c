#include "bench_streams.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

const char *const layout_words[LAYOUTS] = { "staggered", "aligned" };
const size_t sizes[SIZES] = { 16, 256, 4096, (size_t)4 << 20 };
const char *const size_words[SIZES] = { "16", "256", "4096", "4M" };

enum { PAGE = 4096, STAGGER = 256, PATTERN = 4096 };

/* Components in the order of streams.def, then radiance, then packed words: of normals, colours and roughness, f0 and
 * sigma. */
enum {
#define FACET_STREAM(id, field, components, ...) AT_##id, AT_##id##_LAST = AT_##id + components - 1,
#include "streams.def"
    AT_RADIANCE, AT_NORMAL_PACKED = AT_RADIANCE + 3, AT_ALBEDO_ROUGHNESS, AT_F0_SIGMA,
    COMPONENTS = AT_NORMAL_PACKED + STREAMS_PACKED
};

static float *buffers[SIZES][LAYOUTS][COMPONENTS];

/* Rays within 45 degrees of -z. */
static const facet_camera camera = {
    .corner = { -0.7f, 0.7f, -1.0f }, .across = { 1.4f / 2048, 0, 0 }, .down = { 0, -1.4f / 2048, 0 }, .width = 2048,
};

/* ---- What is in them --------------------------------------------------------------------------------------------- */

static float pattern[COMPONENTS][PATTERN];

static double random_unit(void)
{
    static uint64_t state = 1;
    state = state * 6364136223846793005u + 1442695040888963407u;
    return (double)(state >> 11) * 0x1p-53;
}

static float between(double least, double most) { return (float)(least + (most - least) * random_unit()); }

static void put(int at, int i, double x, double y, double z)
{
    pattern[at][i] = (float)x, pattern[at + 1][i] = (float)y, pattern[at + 2][i] = (float)z;
}

/* A unit vector within 45 degrees of z, where all lights are. */
static void fill_direction(int at, int i)
{
    const double cosine = between(0.7, 1.0), phi = between(0.0, 6.283185307179586), sine = sqrt(1 - cosine * cosine);
    put(at, i, sine * cos(phi), sine * sin(phi), cosine);
}

/* Across the normal. */
static void fill_tangent(int i)
{
    const double x = pattern[AT_NORMAL][i], z = pattern[AT_NORMAL + 2][i], length = hypot(x, z);
    put(AT_TANGENT, i, z / length, 0, -x / length);
}

/* Above the plane z = 0 nothing is folded. */
static void pack_normal(int i)
{
    double n[3], sum = 0;
    int16_t word[2];
    for (int c = 0; c < 3; c++) sum += fabs(n[c] = pattern[AT_NORMAL + c][i]);
    for (int c = 0; c < 2; c++) word[c] = (int16_t)lrint(32767 * n[c] / sum);
    memcpy(&pattern[AT_NORMAL_PACKED][i], word, sizeof word);
}

/* Three components and a number, all in [0, 1]. */
static void pack_bytes(int at, int i, int colour, double fourth)
{
    uint8_t byte[4] = { [3] = (uint8_t)lrint(255 * fourth) };
    for (int c = 0; c < 3; c++) byte[c] = (uint8_t)lrintf(255 * pattern[colour + c][i]);
    memcpy(&pattern[at][i], byte, sizeof byte);
}

static void fill_pattern(void)
{
    const double sigma_max = 1.5707963267948966;
    for (int i = 0; i < PATTERN; i++) {
        for (int at = 0; at < AT_NORMAL_PACKED; at++) pattern[at][i] = between(0.02, 0.98);
        fill_direction(AT_NORMAL, i);
        fill_direction(AT_VIEW, i);
        fill_tangent(i);
        pattern[AT_EXPONENT][i] = expf(between(0, log(FACET_EXPONENT_MAX)));
        for (int c = 0; c < 3; c++) {
            pattern[AT_ETA + c][i] = between(0.2, 3);
            pattern[AT_K + c][i] = between(0, 4);
        }
        pack_normal(i);
        pack_bytes(AT_ALBEDO_ROUGHNESS, i, AT_ALBEDO, sqrt(pattern[AT_ALPHA][i]));
        pack_bytes(AT_F0_SIGMA, i, AT_F0, pattern[AT_SIGMA][i] / sigma_max);
    }
}

static void fill(float *stream, int at, size_t count)
{
    if (pattern[0][0] == 0.0f) fill_pattern();
    for (size_t i = 0; i < count; i += PATTERN)
        memcpy(stream + i, pattern[at], sizeof(float) * (count - i < PATTERN ? count - i : PATTERN));
}

/* ---- Where they are ---------------------------------------------------------------------------------------------- */

static size_t round_up(size_t bytes, size_t to) { return (bytes + to - 1) / to * to; }

/* Room for components that have none yet, one after another as `where` has them. */
static bool make_room(int size, layout where, const bool wanted[COMPONENTS])
{
    const size_t bytes = sizes[size] * sizeof(float);
    const size_t stride = where == ALIGNED ? round_up(bytes, PAGE) : round_up(bytes, 64) + STAGGER;
    float **kept = buffers[size][where];
    size_t count = 0;
    for (int at = 0; at < COMPONENTS; at++) count += wanted[at] && !kept[at];
    if (!count) return true;
    char *memory = aligned_alloc(PAGE, round_up(count * stride, PAGE));
    if (!memory) return false;
    for (int at = 0; at < COMPONENTS; at++) {
        if (!wanted[at] || kept[at]) continue;
        kept[at] = (float *)(void *)memory;
        memory += stride;
        fill(kept[at], at, sizes[size]);
    }
    return true;
}

/* Radiance has its place, in whatever format. */
static facet_packed packed_streams(float *const *at, stream_format format)
{
    facet_packed p = { .normal = (const int16_t *)(void *)at[AT_NORMAL_PACKED], .camera = &camera,
                       .albedo_roughness = (const uint8_t *)at[AT_ALBEDO_ROUGHNESS],
                       .f0_sigma = (const uint8_t *)at[AT_F0_SIGMA] };
    if (format == PIXELS) p.pixels = (uint8_t *)at[AT_RADIANCE];
    for (int c = 0; c < 3 && format == HALVES; c++) p.half[c] = (uint16_t *)(void *)at[AT_RADIANCE + c];
    return p;
}

bool streams_batch(int size, layout where, uint32_t streams, stream_format format, facet_batch *batch)
{
    bool wanted[COMPONENTS] = { [AT_RADIANCE] = true, true, true };
#define FACET_STREAM(id, field, components, ...)                                                                      \
    for (int c = 0; c < components; c++) wanted[AT_##id + c] = streams & FACET_STREAM_##id;
#include "streams.def"
    for (int i = 0; i < STREAMS_PACKED; i++) wanted[AT_NORMAL_PACKED + i] = format != FLOATS;
    /* Small buffers have all from the start, so that they stand in one order for everybody. */
    if (size != SIZE_MEMORY) memset(wanted, 1, sizeof wanted);
    if (!make_room(size, where, wanted)) return false;

    float **at = buffers[size][where];
    *batch = (facet_batch){ .count = sizes[size], .radiance = { at[AT_RADIANCE], at[AT_RADIANCE + 1],
                                                                at[AT_RADIANCE + 2] } };
#define FACET_STREAM(id, field, components, ...)                                                                      \
    for (int c = 0; c < components; c++)                                                                              \
        if (streams & FACET_STREAM_##id) ((const float **)&batch->field)[c] = at[AT_##id + c];
#include "streams.def"
    if (format != FLOATS) batch->packed = packed_streams(at, format);
    return true;
}

void streams_move(facet_batch *batch, size_t samples)
{
#define FACET_STREAM(id, field, components, ...)                                                                      \
    for (int c = 0; c < components; c++)                                                                              \
        if (((const float **)&batch->field)[c]) ((const float **)&batch->field)[c] += samples;
#include "streams.def"
    for (int c = 0; c < 3; c++) batch->radiance[c] += samples;
}
