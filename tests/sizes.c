/* What a caller of an older or a newer header passes: structs that are shorter or longer than the library's. */
#include "api.h"

#include "errors.h"
#include "harness.h"

#include <string.h>

/* A struct of `size` bytes: cut off, or with a tail of zeros. */
static void resize(void *to, size_t size, const void *from, size_t whole)
{
    memset(to, 0, size);
    memcpy(to, from, size < whole ? size : whole);
}

enum { TAIL = 40 };

static void test_material_sizes(void)
{
    struct { facet_material m; unsigned char tail[TAIL]; } given;
    const facet_material whole = rich_material();
    test("a material cut short counts as filled with zeros; a longer one may end in zeros alone");
    for (size_t size = 0; size <= sizeof whole + TAIL; size++) {
        facet_plan plan = { { 0 } }, want = { { 0 } };
        facet_material filled;
        facet_error error, want_error;
        resize(&filled, sizeof filled, &whole, size < sizeof whole ? size : sizeof whole);
        memset(&given, 0xa5, sizeof given);
        resize(&given, size, &whole, sizeof whole);
        facet_plan_init(&want, &filled, strict_scalar, &want_error);
        facet_plan_init_sized(&plan, sizeof plan, &given.m, size, &strict_scalar, sizeof strict_scalar, &error);
        expect(error.code == want_error.code && !memcmp(&plan, &want, sizeof plan), "%zu bytes: status %d, not %d",
               size, (int)error.code, (int)want_error.code);
    }
    for (size_t at = sizeof whole; at < sizeof whole + TAIL; at++) {
        facet_plan plan = { { 7 } };
        facet_error error;
        resize(&given, sizeof given, &whole, sizeof whole);
        given.tail[at - sizeof whole] = 1;
        facet_plan_init_sized(&plan, sizeof plan, &given.m, sizeof whole + TAIL, &strict_scalar, sizeof strict_scalar,
                              &error);
        expect(is_error(&error, FACET_ERROR_SIZE, "material", -1) && plan.opaque[0] == 7,
               "byte %zu is taken", at);
    }
}

static void test_plan_sizes(void)
{
    struct { facet_plan plan; unsigned char beyond[TAIL]; } given;
    const facet_material m = rich_material();
    const facet_plan want = make_plan(&m, strict_scalar);
    facet_error error;
    test("a plan that is too small is refused; of a larger one the rest is untouched");
    memset(&given, 0xa5, sizeof given);
    for (size_t size = 0; size < sizeof want; size++) {
        facet_plan_init_sized(&given.plan, size, &m, sizeof m, &strict_scalar, sizeof strict_scalar, &error);
        expect(is_error(&error, FACET_ERROR_SIZE, "plan", -1), "%zu bytes: status %d", size,
               (int)error.code);
    }
    for (size_t i = 0; i < sizeof given; i++) expect(((unsigned char *)&given)[i] == 0xa5, "written on refusal");
    facet_plan_init_sized(&given.plan, sizeof given, &m, sizeof m, &strict_scalar, sizeof strict_scalar, &error);
    expect(error.code == FACET_OK && !memcmp(&given.plan, &want, sizeof want), "a larger plan differs");
    for (int i = 0; i < TAIL; i++) expect(given.beyond[i] == 0xa5, "byte %d behind the plan is written", i);
}

static void test_target_sizes(void)
{
    struct { facet_target target; unsigned char tail[TAIL]; } given;
    const facet_target whole = { FACET_ARCH_SCALAR, FACET_TIER_STRICT, 1u << FACET_ARCH_SCALAR };
    const facet_material m = rich_material();
    test("a target cut short or made longer, alike; NULL is refused");
    for (size_t size = 0; size <= sizeof whole + TAIL; size += sizeof(uint32_t)) {
        facet_plan plan = { { 0 } }, want = { { 0 } };
        facet_target filled;
        facet_error error, want_error;
        resize(&filled, sizeof filled, &whole, size < sizeof whole ? size : sizeof whole);
        memset(&given, 0xa5, sizeof given);
        resize(&given, size, &whole, sizeof whole);
        facet_plan_init(&want, &m, filled, &want_error);
        facet_plan_init_sized(&plan, sizeof plan, &m, sizeof m, &given.target, size, &error);
        expect(error.code == want_error.code && !memcmp(&plan, &want, sizeof plan), "%zu bytes: status %d, not %d",
               size, (int)error.code, (int)want_error.code);
    }
    for (size_t at = 0; at < TAIL; at++) {
        facet_plan plan = { { 7 } };
        facet_error error;
        resize(&given, sizeof given, &whole, sizeof whole);
        given.tail[at] = 1;
        facet_plan_init_sized(&plan, sizeof plan, &m, sizeof m, &given.target, sizeof whole + TAIL, &error);
        expect(is_error(&error, FACET_ERROR_SIZE, "target", -1) && plan.opaque[0] == 7,
               "byte %zu is taken", at);
    }
    facet_plan plan;
    facet_error error;
    facet_plan_init_sized(&plan, sizeof plan, &m, sizeof m, NULL, sizeof whole, &error);
    expect(is_error(&error, FACET_ERROR_NULL, "target", -1), "NULL: status %d", (int)error.code);
}

static void test_batch_sizes(void)
{
    struct { facet_batch batch; unsigned char tail[TAIL]; } given;
    sample_batch b = random_batch(10, 3), other = random_batch(10, 3);
    facet_material m = rich_material();
    m.streams = MATERIAL_STREAMS;
    const facet_plan plan = make_plan(&m, strict_scalar);
    test("a batch cut short or made longer, alike; lights of another size are not misread");
    for (size_t size = 0; size <= sizeof b.batch + TAIL; size += sizeof(void *)) {
        facet_batch filled;
        facet_error error, want_error;
        resize(&filled, sizeof filled, &b.batch, size < sizeof filled ? size : sizeof filled);
        memset(&given, 0xa5, sizeof given);
        resize(&given, size, &other.batch, sizeof other.batch);
        facet_shade(&plan, &filled, &want_error);
        facet_shade_sized(&plan, &given.batch, size, sizeof(facet_light), &error);
        expect(error.code == want_error.code && same_radiance(&b.batch, &other.batch), "%zu bytes: status %d, not %d",
               size, (int)error.code, (int)want_error.code);
    }
    for (size_t at = 0; at < TAIL; at++) {
        facet_error error;
        resize(&given, sizeof given, &other.batch, sizeof other.batch);
        given.tail[at] = 1;
        facet_shade_sized(&plan, &given.batch, sizeof other.batch + TAIL, sizeof(facet_light), &error);
        expect(is_error(&error, FACET_ERROR_SIZE, "batch", -1), "byte %zu is taken", at);
    }
    const size_t light_sizes[] = { 0, 4, sizeof(facet_light) - sizeof(void *), sizeof(facet_light) + sizeof(void *),
                                   SIZE_MAX };
    for (size_t i = 0; i < sizeof light_sizes / sizeof light_sizes[0]; i++) {
        facet_error error;
        facet_shade_sized(&plan, &other.batch, sizeof other.batch, light_sizes[i], &error);
        expect(is_error(&error, FACET_ERROR_SIZE, "lights", -1), "lights of %zu bytes: status %d",
               light_sizes[i], (int)error.code);
    }
    free_batch(&b);
    free_batch(&other);
}

static void test_image_sizes(void)
{
    struct { facet_image image; unsigned char tail[TAIL]; } given;
    static const float light[4] = { 0.1f, 0.2f, 0.3f, 0.4f };
    uint8_t pixels[16] = { 0 }, want[16] = { 0 };
    const facet_image whole = { .width = 2, .height = 2, .radiance = { light, light, light }, .exposure = 2,
                                .pixels = pixels };
    test("an image cut short or made longer, alike");
    for (size_t size = 0; size <= sizeof whole + TAIL; size += sizeof(void *)) {
        facet_image filled;
        facet_error error, want_error;
        resize(&filled, sizeof filled, &whole, size < sizeof filled ? size : sizeof filled);
        memset(&given, 0xa5, sizeof given);
        resize(&given, size, &whole, sizeof whole);
        if (filled.pixels) filled.pixels = want;
        facet_encode(&filled, &want_error);
        facet_encode_sized(&given.image, size, &error);
        expect(error.code == want_error.code && !memcmp(pixels, want, sizeof pixels), "%zu bytes: status %d, not %d",
               size, (int)error.code, (int)want_error.code);
    }
    for (size_t at = 0; at < TAIL; at++) {
        facet_error error;
        resize(&given, sizeof given, &whole, sizeof whole);
        given.tail[at] = 1;
        facet_encode_sized(&given.image, sizeof whole + TAIL, &error);
        expect(is_error(&error, FACET_ERROR_SIZE, "image", -1), "byte %zu is taken", at);
    }
}

void test_sizes(void)
{
    test_material_sizes();
    test_plan_sizes();
    test_target_sizes();
    test_batch_sizes();
    test_image_sizes();
}
