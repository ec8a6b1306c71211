/* What facet_shade refuses, by status, field and index, and that nothing is written then. */
#include "api.h"

#include "errors.h"
#include "harness.h"

#include <float.h>
#include <math.h>
#include <string.h>

enum { CANARY = 0xa5, COUNT = 5, LIGHTS = 6 };

enum {
#define FACET_STREAM(id, ...) | FACET_STREAM_##id
    ALL_STREAMS = 0
#include "streams.def"
};

static float stream[COUNT], radiance[3][COUNT];
static size_t invalid;

static facet_batch good_batch(const facet_light *lights)
{
    facet_batch b = { .count = COUNT, .lights = lights, .light_count = LIGHTS,
                      .radiance = { radiance[0], radiance[1], radiance[2] }, .invalid = &invalid };
#define COMPONENTS_1(field) &b.field
#define COMPONENTS_3(field) b.field
#define FACET_STREAM(id, field, components, ...)                                                                      \
    for (int c = 0; c < components; c++) (COMPONENTS_##components(field))[c] = stream;
#include "streams.def"
    return b;
}

/* Two of every kind. */
static void good_lights(facet_light *lights)
{
    for (int i = 0; i < LIGHTS; i++)
        lights[i] = (facet_light){ .kind = (facet_light_kind)(i % 3), .direction = { 0, 0, 1 },
                                   .irradiance = { 1, 1, 1 }, .position = { 0, 0, 2 }, .range = 10,
                                   .axis = { 0, 0, -1 }, .cos_inner = 0.75f, .cos_outer = 0.5f };
}

static facet_plan plan_with_streams(uint32_t streams)
{
    facet_material m = rich_material();
    m.streams = streams;
    return make_plan(&m, strict_scalar);
}

static facet_plan plan_lambert(void)
{
    facet_material m = rich_material();
    m.diffuse.model = FACET_DIFFUSE_LAMBERT;
    m.specular.model = FACET_DISTRIBUTION_NONE;
    return make_plan(&m, strict_scalar);
}

static facet_plan plan_anisotropic(void)
{
    facet_material m = rich_material();
    m.specular.model = FACET_DISTRIBUTION_GGX_ANISOTROPIC;
    return make_plan(&m, strict_scalar);
}

static void refuses_batch(const char *change, const facet_plan *plan, const facet_batch *b, facet_status code,
                          const char *field, int index)
{
    facet_error error = { FACET_OK, NULL, 0 };
    float untouched[3][COUNT];
    memset(radiance, CANARY, sizeof radiance);
    memset(untouched, CANARY, sizeof untouched);
    invalid = 1234;
    const facet_status status = facet_shade(plan, b, &error);
    expect_refused(change, status, &error, code, field, index);
    expect(facet_shade(plan, b, NULL) == code, "%s: another status without an error", change);
    expect(!memcmp(radiance, untouched, sizeof radiance) && invalid == 1234, "%s: something was written", change);
}

static void accepts_batch(const char *change, const facet_plan *plan, const facet_batch *b)
{
    facet_error error = { FACET_ERROR_NULL, "stale", 7 };
    expect_accepted(change, facet_shade(plan, b, &error), &error);
}

#define CHANGED_BATCH(call)                                                                                           \
    facet_light lights[LIGHTS];                                                                                       \
    good_lights(lights);                                                                                              \
    facet_batch b = good_batch(lights);                                                                               \
    call
#define BATCH_REFUSES(plan, change, code, field, index)                                                               \
    do {                                                                                                              \
        CHANGED_BATCH(change);                                                                                        \
        refuses_batch(#change, plan, &b, code, field, index);                                                         \
    } while (0)
#define BATCH_ACCEPTS(plan, change)                                                                                   \
    do {                                                                                                              \
        CHANGED_BATCH(change);                                                                                        \
        accepts_batch(#change, plan, &b);                                                                             \
    } while (0)

/* Each component of each stream in turn: a plan that promises it refuses a batch without it, one that does not takes
 * it. */
static void test_promises(void)
{
    const facet_plan none = plan_with_streams(0), all = plan_with_streams(MATERIAL_STREAMS);
    test("a plan asks for what it was promised, and for nothing else");
#define MISSING_GEOMETRY(id, field, component)
#define MISSING_SOURCE(id, field, component) MISSING_MATERIAL(id, field, component)
#define MISSING_MATERIAL(id, field, component)                                                                        \
    do {                                                                                                              \
        const facet_plan one = plan_with_streams(FACET_STREAM_##id);                                                  \
        BATCH_REFUSES(&all, component = NULL, FACET_ERROR_NULL, #field, -1);                                          \
        BATCH_REFUSES(&one, component = NULL, FACET_ERROR_NULL, #field, -1);                                          \
        BATCH_ACCEPTS(&none, component = NULL);                                                                       \
    } while (0);
#define FACET_STREAM(id, field, components, owner, ...)                                                               \
    for (int c = 0; c < components; c++) { MISSING_##owner(id, field, (COMPONENTS_##components(field))[c]) }
#include "streams.def"
}

static void test_streams(void)
{
    const facet_plan uniform = plan_with_streams(0), lambert = plan_lambert(), brushed = plan_anisotropic();
    test("geometry that is needed and not there");
    for (int c = 0; c < 3; c++) {
        BATCH_REFUSES(&uniform, b.normal[c] = NULL, FACET_ERROR_NULL, "normal", -1);
        BATCH_REFUSES(&uniform, b.view[c] = NULL, FACET_ERROR_NULL, "view", -1);
        BATCH_REFUSES(&uniform, b.position[c] = NULL, FACET_ERROR_NULL, "position", -1);
        BATCH_REFUSES(&uniform, b.radiance[c] = NULL, FACET_ERROR_NULL, "radiance", c);
        BATCH_REFUSES(&brushed, b.tangent[c] = NULL, FACET_ERROR_NULL, "tangent", -1);
        BATCH_ACCEPTS(&uniform, b.tangent[c] = NULL);
        BATCH_ACCEPTS(&uniform, (b.position[c] = NULL, b.light_count = 1));
    }
    BATCH_ACCEPTS(&uniform, b.occlusion = NULL);

    test("view is needed by what depends on it");
    BATCH_ACCEPTS(&lambert, b.view[0] = b.view[1] = b.view[2] = NULL);
    BATCH_REFUSES(&lambert, (b.view[0] = b.view[1] = b.view[2] = NULL, b.flags = FACET_TWO_SIDED), FACET_ERROR_NULL,
                  "view", -1);
    BATCH_REFUSES(&uniform, b.view[0] = b.view[1] = b.view[2] = NULL, FACET_ERROR_NULL, "view", -1);
    for (int c = 0; c < 3; c++) BATCH_REFUSES(&lambert, b.view[c] = NULL, FACET_ERROR_NULL, "view", -1);
}

/* A vector of a light: its numbers in turn not finite. */
#define VECTOR_REFUSES(plan, i, field)                                                                                \
    for (int c = 0; c < 3; c++) {                                                                                     \
        BATCH_REFUSES(plan, lights[i].field[c] = NAN, FACET_ERROR_VALUE, "light." #field, i);                         \
        BATCH_REFUSES(plan, lights[i].field[c] = INFINITY, FACET_ERROR_VALUE, "light." #field, i);                    \
        BATCH_REFUSES(plan, lights[i].field[c] = -INFINITY, FACET_ERROR_VALUE, "light." #field, i);                   \
    }

static void test_directional(const facet_plan *plan, int i)
{
    BATCH_REFUSES(plan, lights[i].direction[2] = 0, FACET_ERROR_VALUE, "light.direction", i);
    BATCH_REFUSES(plan, lights[i].direction[2] = -0.0f, FACET_ERROR_VALUE, "light.direction", i);
    VECTOR_REFUSES(plan, i, direction)
    for (int c = 0; c < 3; c++)
        BATCH_REFUSES(plan, lights[i].direction_of[c] = stream, FACET_ERROR_NULL, "light.direction_of", i);
    BATCH_ACCEPTS(plan, lights[i].direction[0] = 5);
    BATCH_ACCEPTS(plan, (lights[i].position[0] = lights[i].range = lights[i].axis[0] = NAN,
                         lights[i].cos_inner = lights[i].cos_outer = NAN));
}

static void test_point(const facet_plan *plan, int i)
{
    VECTOR_REFUSES(plan, i, position)
    BATCH_REFUSES(plan, lights[i].range = NAN, FACET_ERROR_VALUE, "light.range", i);
    BATCH_REFUSES(plan, lights[i].range = INFINITY, FACET_ERROR_VALUE, "light.range", i);
    BATCH_REFUSES(plan, lights[i].range = -FLT_TRUE_MIN, FACET_ERROR_VALUE, "light.range", i);
    BATCH_ACCEPTS(plan, lights[i].range = -0.0f);
    BATCH_ACCEPTS(plan, lights[i].range = FLT_TRUE_MIN);
    BATCH_ACCEPTS(plan, memset(lights[i].position, 0, sizeof lights[i].position));
    BATCH_ACCEPTS(plan, (lights[i].position[1] = FLT_MAX, lights[i].range = FLT_MAX));
    BATCH_ACCEPTS(plan, (lights[i].direction[0] = NAN, lights[i].direction_of[1] = stream));
}

static void test_spot(const facet_plan *plan, int i)
{
    test_point(plan, i);
    VECTOR_REFUSES(plan, i, axis)
    BATCH_REFUSES(plan, lights[i].axis[2] = 0, FACET_ERROR_VALUE, "light.axis", i);
    BATCH_REFUSES(plan, lights[i].cos_inner = NAN, FACET_ERROR_VALUE, "light.cos_inner", i);
    BATCH_REFUSES(plan, lights[i].cos_inner = 0x1.000002p0f, FACET_ERROR_VALUE, "light.cos_inner", i);
    BATCH_REFUSES(plan, lights[i].cos_inner = 0x1.fffffep-2f, FACET_ERROR_VALUE, "light.cos_inner", i);
    BATCH_REFUSES(plan, lights[i].cos_outer = NAN, FACET_ERROR_VALUE, "light.cos_outer", i);
    BATCH_REFUSES(plan, lights[i].cos_outer = -0x1.000002p0f, FACET_ERROR_VALUE, "light.cos_outer", i);
    BATCH_REFUSES(plan, lights[i].cos_outer = -INFINITY, FACET_ERROR_VALUE, "light.cos_outer", i);
    BATCH_ACCEPTS(plan, lights[i].cos_inner = lights[i].cos_outer);
    BATCH_ACCEPTS(plan, (lights[i].cos_inner = 1, lights[i].cos_outer = -1));
    BATCH_ACCEPTS(plan, lights[i].cos_inner = lights[i].cos_outer = 1);
    BATCH_ACCEPTS(plan, lights[i].cos_inner = lights[i].cos_outer = -1);
    BATCH_ACCEPTS(plan, lights[i].axis[0] = -5);
}

static void test_lights(void)
{
    static void (*const test_kind[])(const facet_plan *, int) = {
        [FACET_LIGHT_DIRECTIONAL] = test_directional, [FACET_LIGHT_POINT] = test_point, [FACET_LIGHT_SPOT] = test_spot,
    };
    const facet_plan plan = plan_with_streams(0);
    test("every malformed light, by its number");
    BATCH_REFUSES(&plan, b.lights = NULL, FACET_ERROR_NULL, "lights", -1);
    BATCH_ACCEPTS(&plan, (b.lights = NULL, b.light_count = 0));
    for (int i = 0; i < LIGHTS; i++) {
        BATCH_REFUSES(&plan, lights[i].kind = (facet_light_kind)9, FACET_ERROR_ENUM, "light.kind", i);
        BATCH_REFUSES(&plan, lights[i].kind = (facet_light_kind)-1, FACET_ERROR_ENUM, "light.kind", i);
        BATCH_REFUSES(&plan, memset(lights[i].irradiance, 0, sizeof lights[i].irradiance), FACET_ERROR_VALUE,
                      "light.irradiance", i);
        VECTOR_REFUSES(&plan, i, irradiance)
        for (int c = 0; c < 3; c++)
            BATCH_REFUSES(&plan, lights[i].irradiance_of[c] = stream, FACET_ERROR_NULL, "light.irradiance_of", i);
        BATCH_ACCEPTS(&plan, lights[i].irradiance[0] = -1);
        BATCH_ACCEPTS(&plan, lights[i].irradiance[0] = FLT_TRUE_MIN);
        test_kind[i % 3](&plan, i);
    }

    test("a light's numbers are ignored where its streams stand");
    for (int i = 0; i < LIGHTS; i++) {
        BATCH_ACCEPTS(&plan, (lights[i].irradiance_of[0] = lights[i].irradiance_of[1] = lights[i].irradiance_of[2]
                              = stream, lights[i].irradiance[0] = NAN));
        if (i % 3 == FACET_LIGHT_DIRECTIONAL)
            BATCH_ACCEPTS(&plan, (lights[i].direction_of[0] = lights[i].direction_of[1] = lights[i].direction_of[2]
                                  = stream, lights[i].direction[0] = NAN));
    }
}

static void test_batches(void)
{
    const facet_plan plan = plan_with_streams(0);
    test("no plan, no batch, unknown flag bits, ambient that is not finite");
    BATCH_REFUSES(NULL, (void)0, FACET_ERROR_NULL, "plan", -1);
    refuses_batch("batch NULL", &plan, NULL, FACET_ERROR_NULL, "batch", -1);
    BATCH_REFUSES(&plan, b.flags = 4, FACET_ERROR_ENUM, "flags", -1);
    BATCH_REFUSES(&plan, b.flags = 1u << 31 | FACET_ACCUMULATE, FACET_ERROR_ENUM, "flags", -1);
    for (uint32_t bit = 1; bit; bit <<= 1) {
        if (bit & ALL_STREAMS) BATCH_ACCEPTS(&plan, b.uniform = bit);
        else BATCH_REFUSES(&plan, b.uniform = bit | FACET_STREAM_NORMAL, FACET_ERROR_ENUM, "uniform", -1);
    }
    BATCH_ACCEPTS(&plan, b.uniform = ALL_STREAMS);
    BATCH_ACCEPTS(&plan, b.ambient[1] = -FLT_MAX);
    for (int c = 0; c < 3; c++) {
        BATCH_REFUSES(&plan, b.ambient[c] = NAN, FACET_ERROR_VALUE, "ambient", -1);
        BATCH_REFUSES(&plan, b.ambient[c] = -INFINITY, FACET_ERROR_VALUE, "ambient", -1);
        for (int i = 0; i < 4; i++) {
            BATCH_REFUSES(&plan, b.sh[i][c] = NAN, FACET_ERROR_VALUE, "sh", i);
            BATCH_REFUSES(&plan, b.sh[i][c] = INFINITY, FACET_ERROR_VALUE, "sh", i);
            BATCH_ACCEPTS(&plan, b.sh[i][c] = -FLT_MAX);
        }
    }
}

/* ---- Packed streams ---------------------------------------------------------------------------------------------- */

static const facet_camera good_camera = { .corner = { 0, 0, -1 }, .across = { 1, 0, 0 }, .down = { 0, 1, 0 } };

/* A batch that has all of its streams packed, and goes to halves and pixels. */
typedef struct { uint32_t words[COUNT]; uint16_t half[3][COUNT]; } packed_memory;
static packed_memory room;

static void pack(facet_batch *b, facet_camera *camera)
{
    *camera = good_camera;
    camera->width = 2;
    b->packed = (facet_packed){ .normal = (int16_t *)room.words, .albedo_roughness = (uint8_t *)room.words,
                                .f0_sigma = (uint8_t *)room.words, .camera = camera, .pixels = (uint8_t *)room.words,
                                .half = { room.half[0], room.half[1], room.half[2] } };
    for (int c = 0; c < 3; c++) b->normal[c] = b->view[c] = b->albedo[c] = b->f0[c] = b->radiance[c] = NULL;
    b->alpha = b->sigma = NULL;
}

#define PACKED_REFUSES(plan, change, code, field, index)                                                              \
    do {                                                                                                              \
        packed_memory untouched;                                                                                      \
        facet_camera camera;                                                                                          \
        memset(&room, CANARY, sizeof room);                                                                           \
        untouched = room;                                                                                             \
        BATCH_REFUSES(plan, (pack(&b, &camera), change), code, field, index);                                         \
        expect(!memcmp(&room, &untouched, sizeof room), "%s: a packed stream was written", #change);                  \
    } while (0)
#define PACKED_ACCEPTS(plan, change)                                                                                  \
    do {                                                                                                              \
        facet_camera camera;                                                                                          \
        BATCH_ACCEPTS(plan, (pack(&b, &camera), change));                                                             \
    } while (0)

/* A place that no float could have. */
#define OFF(pointer, bytes) ((void *)((char *)(pointer) + (bytes)))

static void test_packed_addresses(const facet_plan *plan)
{
    test("packed streams that are not where they may be, or not there");
    PACKED_ACCEPTS(plan, (void)0);
    for (int k = 1; k < 4; k++) {
        PACKED_REFUSES(plan, b.packed.normal = OFF(room.words, k), FACET_ERROR_VALUE, "packed.normal", -1);
        PACKED_REFUSES(plan, b.packed.albedo_roughness = OFF(room.words, k), FACET_ERROR_VALUE,
                       "packed.albedo_roughness", -1);
        PACKED_REFUSES(plan, b.packed.f0_sigma = OFF(room.words, k), FACET_ERROR_VALUE, "packed.f0_sigma", -1);
        PACKED_REFUSES(plan, b.packed.pixels = OFF(room.words, k), FACET_ERROR_VALUE, "packed.pixels", -1);
    }
    for (int c = 0; c < 3; c++) {
        PACKED_REFUSES(plan, b.packed.half[c] = NULL, FACET_ERROR_NULL, "packed.half", c);
        PACKED_REFUSES(plan, (b.packed.half[0] = b.packed.half[1] = b.packed.half[2] = NULL, b.packed.pixels = NULL,
                              b.radiance[(c + 1) % 3] = b.radiance[(c + 2) % 3] = radiance[0]), FACET_ERROR_NULL,
                       "radiance", c);
    }
    PACKED_REFUSES(plan, b.packed.normal = NULL, FACET_ERROR_NULL, "normal", -1);
    PACKED_REFUSES(plan, b.packed.camera = NULL, FACET_ERROR_NULL, "view", -1);
    PACKED_REFUSES(plan, b.packed.albedo_roughness = NULL, FACET_ERROR_NULL, "albedo", -1);
    PACKED_REFUSES(plan, b.packed.f0_sigma = NULL, FACET_ERROR_NULL, "sigma", -1);
    PACKED_ACCEPTS(plan, b.packed.pixels = NULL);
    PACKED_ACCEPTS(plan, b.packed.half[0] = b.packed.half[1] = b.packed.half[2] = NULL);
    PACKED_ACCEPTS(plan, b.uniform = ALL_STREAMS);
}

static void test_packed_numbers(const facet_plan *plan)
{
    test("an exposure and cameras out of their domain; packed radiance does not accumulate");
    PACKED_REFUSES(plan, b.flags = FACET_ACCUMULATE, FACET_ERROR_ENUM, "flags", -1);
    PACKED_REFUSES(plan, (b.flags = FACET_ACCUMULATE, b.packed.pixels = NULL), FACET_ERROR_ENUM, "flags", -1);
    PACKED_REFUSES(plan, b.packed.exposure = NAN, FACET_ERROR_VALUE, "packed.exposure", -1);
    PACKED_REFUSES(plan, b.packed.exposure = INFINITY, FACET_ERROR_VALUE, "packed.exposure", -1);
    PACKED_REFUSES(plan, b.packed.exposure = -FLT_TRUE_MIN, FACET_ERROR_VALUE, "packed.exposure", -1);
    PACKED_ACCEPTS(plan, b.packed.exposure = -0.0f);
    PACKED_ACCEPTS(plan, b.packed.exposure = FLT_MAX);
    for (int c = 0; c < 3; c++) {
        PACKED_REFUSES(plan, camera.corner[c] = NAN, FACET_ERROR_VALUE, "packed.camera.corner", -1);
        PACKED_REFUSES(plan, camera.across[c] = INFINITY, FACET_ERROR_VALUE, "packed.camera.across", -1);
        PACKED_REFUSES(plan, camera.down[c] = -INFINITY, FACET_ERROR_VALUE, "packed.camera.down", -1);
        PACKED_ACCEPTS(plan, camera.down[c] = -FLT_MAX);
    }
}

/* COUNT is 5. */
static void test_packed_pixels(const facet_plan *plan)
{
    enum { PIXELS = 1 << 20 };
    test("cameras' columns and rows end below 2^20");
    PACKED_ACCEPTS(plan, (camera.width = 0, camera.x = PIXELS - COUNT, camera.y = PIXELS - 1));
    PACKED_REFUSES(plan, (camera.width = 0, camera.x = PIXELS - COUNT + 1), FACET_ERROR_VALUE, "packed.camera.x", -1);
    PACKED_REFUSES(plan, (camera.width = 0, camera.y = PIXELS), FACET_ERROR_VALUE, "packed.camera.y", -1);
    PACKED_ACCEPTS(plan, (camera.width = 2, camera.x = PIXELS - 2, camera.y = PIXELS - 3));
    PACKED_REFUSES(plan, (camera.width = 2, camera.x = PIXELS - 1), FACET_ERROR_VALUE, "packed.camera.x", -1);
    PACKED_REFUSES(plan, (camera.width = 2, camera.y = PIXELS - 2), FACET_ERROR_VALUE, "packed.camera.y", -1);
    PACKED_ACCEPTS(plan, (camera.width = PIXELS, camera.x = PIXELS - COUNT));
    PACKED_REFUSES(plan, (camera.width = PIXELS, camera.x = PIXELS - COUNT + 1), FACET_ERROR_VALUE, "packed.camera.x",
                   -1);
    PACKED_REFUSES(plan, camera.width = PIXELS + 1, FACET_ERROR_VALUE, "packed.camera.width", -1);
    PACKED_REFUSES(plan, camera.width = UINT32_MAX, FACET_ERROR_VALUE, "packed.camera.width", -1);
    PACKED_REFUSES(plan, camera.x = UINT32_MAX, FACET_ERROR_VALUE, "packed.camera.x", -1);
    PACKED_REFUSES(plan, camera.y = UINT32_MAX, FACET_ERROR_VALUE, "packed.camera.y", -1);
    PACKED_ACCEPTS(plan, (camera.width = 1, camera.y = PIXELS - COUNT));
    PACKED_REFUSES(plan, (camera.width = 1, camera.y = PIXELS - COUNT + 1), FACET_ERROR_VALUE, "packed.camera.y", -1);
    PACKED_ACCEPTS(plan, (b.count = 0, camera.x = PIXELS, camera.y = PIXELS, camera.width = 0));
    PACKED_REFUSES(plan, (b.count = 0, camera.x = PIXELS + 1), FACET_ERROR_VALUE, "packed.camera.x", -1);
}

static void test_packed(void)
{
    const facet_plan plan = plan_with_streams(FACET_STREAM_ALBEDO | FACET_STREAM_SIGMA | FACET_STREAM_ALPHA
                                              | FACET_STREAM_F0);
    const facet_plan unpromised = plan_with_streams(0);
    test_packed_addresses(&plan);
    test_packed_numbers(&plan);
    test_packed_pixels(&plan);

    test("packed parameters that nothing promised are ignored");
    PACKED_ACCEPTS(&unpromised, (void)0);
    PACKED_ACCEPTS(&unpromised, b.packed.albedo_roughness = b.packed.f0_sigma = NULL);
}

void test_refused_batches(void)
{
    stream[0] = 1;
    test_streams();
    test_promises();
    test_lights();
    test_batches();
    test_packed();
}
