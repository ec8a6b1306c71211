#include "bench_work.h"
#include "../tests/cases.h"

#include <string.h>

static const facet_light directional[SHADE_MOST_LIGHTS] = {
    { .direction = { 0.36f, 0.48f, 0.8f }, .irradiance = { 3.0f, 2.5f, 2.0f } },
    { .direction = { -0.48f, 0.36f, 0.8f }, .irradiance = { 0.5f, 0.75f, 1.0f } },
    { .direction = { 0.0f, -0.6f, 0.8f }, .irradiance = { 1.0f, 0.5f, 0.25f } },
    { .direction = { 0.28f, 0.0f, 0.96f }, .irradiance = { 0.25f, 0.25f, 0.5f } },
};

#define DIFFUSE FACET_STREAM_ALBEDO | FACET_STREAM_SIGMA
#define VECTORS FACET_STREAM_NORMAL | FACET_STREAM_VIEW
#define TILE_MATERIAL                                                                                                 \
    .material = { .diffuse = { .model = FACET_DIFFUSE_OREN_NAYAR }, .specular = { .model = FACET_DISTRIBUTION_GGX },  \
                  .streams = DIFFUSE | FACET_STREAM_ALPHA | FACET_STREAM_F0 }
#define TILE                                                                                                          \
    .kernel = "oren-nayar+ggx/smith-correlated/schlick/uncoupled", TILE_MATERIAL,                                     \
    .streams = VECTORS | DIFFUSE | FACET_STREAM_ALPHA | FACET_STREAM_F0

/* Operations are counted by hand, of the cheapest branch-free way to float's precision that we know: what a sample has
 * once + what it has for each light. Neither clamps nor checks count, nor do shifts; from and to integers and halves
 * counts as an addition. Multiplications, those with an addition, additions, divisions, square roots:
 *     n.v, n.l, v.l                  1 2 0 0 0 each
 *     A and B of sigma               2 1 2 2 0
 *     A + B max(0, s0)/max(nl, nv)   0 2 2 1 0
 *     v + l, n.w, |w|^2, |n x w|^2   5 7 4 0 0     w = v + l, n.w = nl + nv
 *     GGX's D                        4 1 0 1 0     one of them once: alpha^2
 *     its masking                    5 3 1 1 2     once: 1 1 1 0 1, of nv
 *     Beckmann's D                   8 8 3 2 0     once: 1 0 0 1 0; the exponential: a polynomial of degree 6
 *     its masking                   14 6 10 3 2    once: 6 3 4 1 1, of nv
 *     Schlick's F                    3 4 1 0 1
 *     exact F of numbers             1 8 0 1 1     a rational function of vh, 4/4, and vh; another channel: 0 8 0 1 0
 *     1994's A, B, C of sigma        3 1 3 3 0
 *     its sines and angles           2 16 2 0 4    arccosines: a polynomial of degree 7
 *     the rest of it                21 6 13 3 0    the radiance too
 *     radiance                       7 3 0 0 0     diffuse alone: 7 0, specular alone: 6 0; coupled: 7 3 1
 *     an octahedral normal           4 2 6 1 1     folded, and its length
 *     a camera's view                4 5 1 1 1     of a row of pixels: corner + y down is known
 *     eight unorm8                   9 0 8 0 0     alpha is the square of one
 *     three halves                   0 0 3 0 0
 *     three bytes of sRGB            3 21 3 3 3    of the root, a rational function, 4/3; the line */
static const work workloads[] = {
    { "tile", "Oren-Nayar (A, B) + GGX + correlated Smith + Schlick, everything per sample", TILE,
      .lights = directional, .light_count = 1, .shade = SHADE_TILE,
      .operations = { 5 + 24, 4 + 23, 3 + 7, 2 + 3, 1 + 2 } },
    { "diffuse", "Oren-Nayar (A, B), albedo and sigma per sample", .kernel = "oren-nayar",
      .material = { .diffuse = { .model = FACET_DIFFUSE_OREN_NAYAR }, .streams = DIFFUSE },
      .streams = VECTORS | DIFFUSE, .lights = directional, .light_count = 1, .shade = SHADE_DIFFUSE,
      .operations = { 3 + 9, 3 + 6, 2 + 2, 2 + 1, 0 } },
    { "metal", "GGX + correlated Smith + exact conductor of gold, alpha per sample",
      .material = { .specular = { .model = FACET_DISTRIBUTION_GGX },
                    .fresnel = { .model = FACET_FRESNEL_CONDUCTOR, .eta = { 0.14599282f, 0.5892624f, 1.2609187f },
                                 .k = { 3.8739426f, 2.2488651f, 1.8605043f } },
                    .streams = FACET_STREAM_ALPHA },
      .streams = VECTORS | FACET_STREAM_ALPHA, .lights = directional, .light_count = 1, .shade = SHADE_METAL,
      .operations = { 3 + 20, 3 + 36, 1 + 4, 0 + 5, 1 + 2 } },
    { "plastic", "Oren-Nayar (A, B) under Beckmann + correlated Smith + exact dielectric, coupled, of eta 1.5",
      .material = { .diffuse = { .model = FACET_DIFFUSE_OREN_NAYAR },
                    .specular = { .model = FACET_DISTRIBUTION_BECKMANN },
                    .fresnel = { .model = FACET_FRESNEL_DIELECTRIC, .eta = { 1.5f, 1.5f, 1.5f } }, .coupled = true,
                    .streams = DIFFUSE | FACET_STREAM_ALPHA },
      .streams = VECTORS | DIFFUSE | FACET_STREAM_ALPHA, .lights = directional, .light_count = 1,
      .shade = SHADE_PLASTIC, .operations = { 10 + 30, 6 + 35, 6 + 16, 4 + 5, 1 + 2 } },
    { "lights", "tile under four directional lights in one pass", TILE,
      .lights = directional, .light_count = SHADE_MOST_LIGHTS, .shade = SHADE_LIGHTS,
      .operations = { 5 + 4 * 24 - 9, 4 + 4 * 23 + 9, 3 + 4 * 7, 2 + 4 * 3, 1 + 4 * 2 } },
    { "full", "Oren-Nayar 1994 in full, with interreflection, albedo and sigma per sample",
      .kernel = "oren-nayar-full",
      .material = { .diffuse = { .model = FACET_DIFFUSE_OREN_NAYAR_FULL }, .streams = DIFFUSE },
      .streams = VECTORS | DIFFUSE, .lights = directional, .light_count = 1, .shade = SHADE_FULL,
      .operations = { 4 + 25, 3 + 26, 3 + 15, 3 + 3, 0 + 4 } },
    { "frame", "tile of four million samples from memory", TILE,
      .frame = true, .lights = directional, .light_count = 1, .shade = SHADE_TILE,
      .operations = { 5 + 24, 4 + 23, 3 + 7, 2 + 3, 1 + 2 } },
    { "packed", "frame, of packed streams and a camera, into halves", TILE_MATERIAL,
      .format = HALVES, .frame = true, .lights = directional, .light_count = 1, .shade = -1, .beside = "frame",
      .operations = { 5 + 24 + 17, 4 + 23 + 7, 3 + 7 + 15 + 3, 2 + 3 + 2, 1 + 2 + 2 } },
    { "packed-pixels", "the same into sRGB pixels", TILE_MATERIAL,
      .format = PIXELS, .frame = true, .lights = directional, .light_count = 1, .shade = -1, .beside = "frame",
      .operations = { 5 + 24 + 17 + 3, 4 + 23 + 7 + 21, 3 + 7 + 15 + 3, 2 + 3 + 2 + 3, 1 + 2 + 2 + 3 } },
};

enum { WORKLOADS = sizeof workloads / sizeof workloads[0], MOST_KERNELS = 128 };

/* ---- Kernels ----------------------------------------------------------------------------------------------------- */

static work kernels[MOST_KERNELS];
static facet_light lights[MOST_KERNELS];
static int kernels_found;

/* Its parameters per sample; what depends on no view takes none. */
static void add_kernel(const kernel_case *c)
{
    work *w = &kernels[kernels_found];
    facet_light *light = &lights[kernels_found++];
    *light = c->light;
    memcpy(light->irradiance, directional[0].irradiance, sizeof light->irradiance);
    if (light->kind == FACET_LIGHT_DIRECTIONAL)
        memcpy(light->direction, directional[0].direction, sizeof light->direction);
    *w = (work){ .name = c->name, .kernel = c->name, .material = c->material, .lights = light, .light_count = 1,
                 .streams = c->streams | FACET_STREAM_NORMAL, .shade = -1 };
    w->material.streams = c->promised;
    if (c->view) w->streams |= FACET_STREAM_VIEW;
    if (light->kind != FACET_LIGHT_DIRECTIONAL) w->streams |= FACET_STREAM_POSITION;
}

static int kernel_count(void)
{
    const int count = case_count() < MOST_KERNELS ? case_count() : MOST_KERNELS;
    while (kernels_found < count) add_kernel(case_at(kernels_found));
    return count;
}

int work_count(void) { return WORKLOADS + kernel_count(); }

const work *work_at(int index)
{
    if (index < 0 || index >= work_count()) return NULL;
    return index < WORKLOADS ? &workloads[index] : &kernels[index - WORKLOADS];
}

int work_reads(const work *w)
{
    int count = w->format == FLOATS ? 0 : STREAMS_PACKED;
#define FACET_STREAM(id, field, components, ...) if (w->streams & FACET_STREAM_##id) count += components;
#include "streams.def"
    return count * (int)sizeof(float);
}

int work_writes(const work *w)
{
    static const int bytes[] = { [FLOATS] = 3 * sizeof(float), [HALVES] = 3 * sizeof(uint16_t), [PIXELS] = 4 };
    return bytes[w->format];
}
