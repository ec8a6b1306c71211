/* What a caller of an older or a newer header passes: structs that are shorter or longer than the library's. */
#include "api.h"

#include "errors.h"
#include "harness.h"

#include <stdlib.h>
#include <string.h>

enum { UNTOUCHED = 0xa5, COUNT = 10, TAIL = 40 };

/* What a call that took a struct said, and what it wrote: a plan, radiance or pixels. */
typedef struct {
    facet_error error;
    union { facet_plan plan; float radiance[3][COUNT]; uint8_t pixels[16]; } made;
} outcome;
typedef void call(const void *given, size_t size, outcome *);

static outcome outcome_of(call *take, const void *given, size_t size)
{
    outcome o;
    memset(&o, UNTOUCHED, sizeof o);
    take(given, size, &o);
    return o;
}

static bool same_made(const outcome *a, const outcome *b) { return !memcmp(&a->made, &b->made, sizeof a->made); }

/* The first `size` bytes of a struct of `whole`, and zeros behind its end, with nothing behind theirs. */
static void *resized(const void *from, size_t whole, size_t size)
{
    void *to = calloc(1, size ? size : 1);
    if (!to) abort();
    memcpy(to, from, size < whole ? size : whole);
    return to;
}

/* A struct cut short is one filled with zeros; a longer one may end in zeros alone. Sizes are multiples of `step`. */
static void check_sizes(const char *field, const void *from, size_t whole, size_t step, call *take)
{
    for (size_t size = 0; size <= whole + TAIL; size += step) {
        void *given = resized(from, whole, size), *filled = resized(given, size, whole);
        const outcome got = outcome_of(take, given, size), want = outcome_of(take, filled, whole);
        expect(got.error.code == want.error.code && same_made(&got, &want), "%zu bytes: status %d, not %d", size,
               (int)got.error.code, (int)want.error.code);
        free(given);
        free(filled);
    }
    outcome untouched;
    memset(&untouched, UNTOUCHED, sizeof untouched);
    for (size_t at = whole; at < whole + TAIL; at++) {
        unsigned char *given = resized(from, whole, whole + TAIL);
        given[at] = 1;
        const outcome got = outcome_of(take, given, whole + TAIL);
        expect(is_error(&got.error, FACET_ERROR_SIZE, field, -1) && same_made(&got, &untouched), "byte %zu is taken",
               at);
        free(given);
    }
}

/* ---- What is taken ----------------------------------------------------------------------------------------------- */

static void take_material(const void *given, size_t size, outcome *o)
{
    facet_plan_init_sized(&o->made.plan, sizeof o->made.plan, given, size, &strict_scalar, sizeof strict_scalar,
                          &o->error);
}

static void take_target(const void *given, size_t size, outcome *o)
{
    const facet_material m = rich_material();
    facet_plan_init_sized(&o->made.plan, sizeof o->made.plan, &m, sizeof m, given, size, &o->error);
}

static facet_plan plan;
static sample_batch samples;

static void take_batch(const void *given, size_t size, outcome *o)
{
    for (int c = 0; c < 3; c++) memcpy(samples.batch.radiance[c], o->made.radiance[c], sizeof o->made.radiance[c]);
    facet_shade_sized(&plan, given, size, sizeof(facet_light), &o->error);
    for (int c = 0; c < 3; c++) memcpy(o->made.radiance[c], samples.batch.radiance[c], sizeof o->made.radiance[c]);
}

static uint8_t pixels[16];

static void take_image(const void *given, size_t size, outcome *o)
{
    memcpy(pixels, o->made.pixels, sizeof pixels);
    facet_encode_sized(given, size, &o->error);
    memcpy(o->made.pixels, pixels, sizeof pixels);
}

/* ---- Tests ------------------------------------------------------------------------------------------------------- */

static void test_material_sizes(void)
{
    const facet_material m = rich_material();
    test("a material cut short counts as filled with zeros; a longer one may end in zeros alone");
    check_sizes("material", &m, sizeof m, 1, take_material);
}

static void test_plan_sizes(void)
{
    struct { facet_plan plan; unsigned char beyond[TAIL]; } given;
    const facet_material m = rich_material();
    const facet_plan want = make_plan(&m, strict_scalar);
    facet_error error;
    test("a plan that is too small is refused; of a larger one the rest is untouched");
    memset(&given, UNTOUCHED, sizeof given);
    for (size_t size = 0; size < sizeof want; size++) {
        facet_plan_init_sized(&given.plan, size, &m, sizeof m, &strict_scalar, sizeof strict_scalar, &error);
        expect(is_error(&error, FACET_ERROR_SIZE, "plan", -1), "%zu bytes: status %d", size, (int)error.code);
    }
    for (size_t i = 0; i < sizeof given; i++)
        expect(((unsigned char *)&given)[i] == UNTOUCHED, "written on refusal");
    facet_plan_init_sized(&given.plan, sizeof given, &m, sizeof m, &strict_scalar, sizeof strict_scalar, &error);
    expect(error.code == FACET_OK && !memcmp(&given.plan, &want, sizeof want), "a larger plan differs");
    for (int i = 0; i < TAIL; i++) expect(given.beyond[i] == UNTOUCHED, "byte %d behind the plan is written", i);
}

static void test_target_sizes(void)
{
    const facet_target target = { FACET_ARCH_SCALAR, FACET_TIER_STRICT, 1u << FACET_ARCH_SCALAR };
    test("a target cut short or made longer, alike; NULL is refused");
    check_sizes("target", &target, sizeof target, sizeof(uint32_t), take_target);
    const outcome null = outcome_of(take_target, NULL, sizeof target);
    expect(is_error(&null.error, FACET_ERROR_NULL, "target", -1), "NULL: status %d", (int)null.error.code);
}

static void test_batch_sizes(void)
{
    facet_material m = rich_material();
    m.streams = MATERIAL_STREAMS;
    plan = make_plan(&m, strict_scalar);
    samples = random_batch(COUNT, 3);
    test("a batch cut short or made longer, alike; lights of another size are not misread");
    check_sizes("batch", &samples.batch, sizeof samples.batch, sizeof(void *), take_batch);
    const size_t light_sizes[] = { 0, 4, sizeof(facet_light) - sizeof(void *), sizeof(facet_light) + sizeof(void *),
                                   SIZE_MAX };
    for (size_t i = 0; i < sizeof light_sizes / sizeof light_sizes[0]; i++) {
        facet_error error;
        facet_shade_sized(&plan, &samples.batch, sizeof samples.batch, light_sizes[i], &error);
        expect(is_error(&error, FACET_ERROR_SIZE, "lights", -1), "lights of %zu bytes: status %d", light_sizes[i],
               (int)error.code);
    }
    free_batch(&samples);
}

static void test_image_sizes(void)
{
    static const float light[4] = { 0.1f, 0.2f, 0.3f, 0.4f };
    const facet_image image = { .width = 2, .height = 2, .radiance = { light, light, light }, .exposure = 2,
                                .pixels = pixels };
    test("an image cut short or made longer, alike");
    check_sizes("image", &image, sizeof image, sizeof(void *), take_image);
}

void test_sizes(void)
{
    test_material_sizes();
    test_plan_sizes();
    test_target_sizes();
    test_batch_sizes();
    test_image_sizes();
}
