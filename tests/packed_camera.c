/* A camera's view: rows wrap where they should, and v is that of its pixel. */
#include "packed.h"

#include "bits.h"
#include "harness.h"
#include "targets.h"

#include <math.h>
#include <stdlib.h>

#define PI 3.14159265358979323846

enum { PIXELS = 1 << 20, MOST = PIXELS + 50 };

/* GGX with alpha and F of 1 reflects F/(2 pi (nl + nv)): with l = n, nv can be read off the radiance. */
static facet_plan mirror(facet_target target)
{
    const facet_material m = { .specular = { .model = FACET_DISTRIBUTION_GGX, .alpha = 1 },
                               .fresnel = { .f0 = { 1, 1, 1 } } };
    facet_plan plan;
    facet_error error;
    facet_plan_init(&plan, &m, target, &error);
    expect(!error.code, "%s is refused", error.field);
    return plan;
}

typedef struct { float *view[3], *radiance, *want; } memory;

static void shade_along(const facet_plan *plan, const facet_camera *camera, const memory *m, size_t count, int axis,
                        float *radiance)
{
    static const float one = 1, none = 0;
    facet_light light = { .irradiance = { 2, 2, 2 } };
    facet_batch b = { .count = count, .normal = { &none, &none, &none }, .uniform = FACET_STREAM_NORMAL,
                      .lights = &light, .light_count = 1, .radiance = { radiance, radiance, radiance },
                      .packed = { .camera = camera } };
    light.direction[axis] = 1;
    b.normal[axis] = &one;
    for (int c = 0; c < 3 && !camera; c++) b.view[c] = m->view[c];
    expect(facet_shade(plan, &b, NULL) == FACET_OK, "refused");
}

/* Strict bytes are those of float views; v is within 40 units of 2^-24, of which the kernel's bound are 32. */
static void check_camera(const facet_plan *plan, const facet_camera *camera, const memory *m, size_t count, bool strict)
{
    for (size_t i = 0; i < count; i++) {
        float v[3];
        unpack_view(camera, i, v);
        for (int c = 0; c < 3; c++) m->view[c][i] = v[c];
    }
    for (int axis = 0; axis < 3; axis++) {
        shade_along(plan, camera, m, count, axis, m->radiance);
        if (strict) shade_along(plan, NULL, m, count, axis, m->want);
        for (size_t i = 0; i < count; i++) {
            double v[3];
            exact_view(camera, i, v);
            const double nv = 1 / (PI * (double)m->radiance[i]) - 1;
            expect(fabs(nv - v[axis]) < 40 * 0x1p-24, "width %u from (%u, %u): v[%d] of sample %zu is %.9g, not %.9g",
                   camera->width, camera->x, camera->y, axis, i, nv, v[axis]);
            expect(!strict || to_bits(m->radiance[i]) == to_bits(m->want[i]),
                   "width %u from (%u, %u): sample %zu is %a, with a float view %a", camera->width, camera->x,
                   camera->y, i, (double)m->radiance[i], (double)m->want[i]);
        }
    }
}

/* v in the first octant. */
static facet_camera camera_of(uint32_t x, uint32_t y, uint32_t width)
{
    return (facet_camera){ .corner = { -1, -1.25f, -0.75f }, .across = { 3e-7f, -2e-7f, 1e-7f },
                           .down = { -1e-7f, 2.5e-7f, 4e-7f }, .x = x, .y = y, .width = width };
}

static void check_widths(const facet_plan *plan, const memory *m, bool strict)
{
    static const uint32_t widths[] = { 0, 1, 2, 3, 7, 15, 16, 17, 63, 64, 65, 1000, PIXELS - 1, PIXELS };
    for (size_t k = 0; k < sizeof widths / sizeof widths[0]; k++) {
        const uint32_t width = widths[k], row = width ? width : 3000;
        const size_t count = row > 1000 ? 3000 : 2 * row + row / 2 + 130;
        const uint32_t columns = (uint32_t)(row < count ? row : count), rows = (uint32_t)((count - 1) / row + 1);
        const uint32_t right = PIXELS - columns, bottom = PIXELS - rows;
        const facet_camera cameras[] = { camera_of(0, 0, width), camera_of(right / 3, 77, width),
                                         camera_of(right, bottom, width) };
        for (int c = 0; c < 3; c++) check_camera(plan, &cameras[c], m, count, strict);
    }
}

static void check_zero_ray(facet_target target)
{
    const facet_material material = { .diffuse = { .model = FACET_DIFFUSE_LAMBERT, .albedo = { 1, 1, 1 } } };
    const facet_camera camera = { .corner = { -5, -9, 0 }, .across = { 1, 0, 0 }, .down = { 0, 1, 0 }, .x = 3, .y = 8,
                                  .width = 7 };
    const float z = 1, zero = 0;
    float radiance[3][50];
    facet_plan plan;
    size_t invalid = 5;
    const facet_batch b = { .count = 50, .normal = { &zero, &zero, &z }, .uniform = FACET_STREAM_NORMAL,
                            .ambient = { 1, 1, 1 }, .radiance = { radiance[0], radiance[1], radiance[2] },
                            .packed = { .camera = &camera }, .invalid = &invalid };
    facet_plan_init(&plan, &material, target, NULL);
    expect(facet_shade(&plan, &b, NULL) == FACET_OK, "refused");
    expect(invalid == 6, "counted %zu", invalid - 5);
    for (size_t i = 0; i < 50; i++)
        for (int c = 0; c < 3; c++)
            expect((i == 9) == (to_bits(radiance[c][i]) == 0), "sample %zu is %a", i, (double)radiance[c][i]);
}

void test_packed_camera(void)
{
    float *all = malloc(5 * (size_t)MOST * sizeof *all);
    if (!all) abort();
    const memory m = { { all, all + MOST, all + 2 * MOST }, all + 3 * MOST, all + 4 * MOST };
    for (int i = 0; i < target_count(); i++) {
        const facet_target target = target_at(i);
        const bool strict = target.tier == FACET_TIER_STRICT;
        test("%s: cameras of any width and corner", target_words(target));
        const facet_plan plan = mirror(target);
        check_widths(&plan, &m, strict);

        test("%s: a camera's widest row and the next", target_words(target));
        const facet_camera wide = camera_of(0, 5, PIXELS);
        if (test_slow_machine) skip("a million pixels");
        else check_camera(&plan, &wide, &m, MOST, strict);

        test("%s: a ray of 0 is no view", target_words(target));
        check_zero_ray(target);
    }
    free(all);
}
