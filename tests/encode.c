/* facet_encode: every step of the sRGB curve at its exact float, opacity, layout, refusals. */
#include "bits.h"
#include "guarded.h"
#include "errors.h"
#include "harness.h"

#include "facet.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* ---- The curve --------------------------------------------------------------------------------------------------- */

/* thresholds[c]: the least float whose byte is c: of at least the light that IEC 61966-2-1 encodes as (c - 1/2)/255. */
static float thresholds[256];

static long double inverse_curve(long double encoded)
{
    return encoded <= 0.04045L ? encoded / 12.92L : powl((encoded + 0.055L) / 1.055L, 2.4L);
}

/* False where a float is so near to the step that the arithmetic here cannot tell on which side it is. */
static bool derive_thresholds(void)
{
    bool decided = true;
    for (int c = 1; c < 256; c++) {
        const long double step = inverse_curve((c - 0.5L) / 255);
        float x = (float)step;
        if ((long double)x < step) x = nextafterf(x, INFINITY);
        thresholds[c] = x;
        const long double gap = fminl(x - step, step - nextafterf(x, 0));
        decided = decided && gap > 1e-14L * step;
    }
    return decided;
}

static int byte_of(float x)
{
    int c = 0;
    while (c < 255 && x >= thresholds[c + 1]) c++;
    return c;
}

static int encode_scaled(float x, float exposure)
{
    uint8_t pixel[4] = { 0 };
    const float grey = x;
    const facet_image image = { .width = 1, .height = 1, .radiance = { &grey, &grey, &grey }, .exposure = exposure,
                                .pixels = pixel };
    expect(facet_encode(&image, NULL) == FACET_OK && pixel[0] == pixel[1] && pixel[1] == pixel[2] && pixel[3] == 255,
           "a grey pixel of %a is %d %d %d %d", (double)x, pixel[0], pixel[1], pixel[2], pixel[3]);
    return pixel[0];
}

static int encode_one(float x) { return encode_scaled(x, 0); }

static void check_thresholds(void)
{
    test("255 steps, each between two neighbouring floats");
    expect(derive_thresholds(), "a step is too near to a float for this machine's long double");
    for (int c = 1; c < 256; c++) {
        const float x = thresholds[c], below = nextafterf(x, 0);
        expect(encode_one(x) == c, "%a is %d, not %d", (double)x, encode_one(x), c);
        expect(encode_one(below) == c - 1, "%a is %d, not %d", (double)below, encode_one(below), c - 1);
    }
}

/* Rises through the floats from 0 to beyond 1, three channels apart. */
static void check_sweep(void)
{
    enum { WIDTH = 4096 };
    static float light[3][WIDTH];
    static uint8_t pixels[4 * WIDTH];
    const uint32_t last = 0x40000000, step = test_slow_machine ? 12289 : 379;
    const facet_image image = { .width = WIDTH, .height = 1, .radiance = { light[0], light[1], light[2] },
                                .pixels = pixels };
    int before[3] = { 0, 0, 0 };

    test("every %uth float from 0 to 2", step / 3);
    for (uint32_t bits = 0; bits < last; bits += WIDTH * step) {
        for (uint32_t i = 0; i < WIDTH; i++)
            for (uint32_t c = 0; c < 3; c++) light[c][i] = from_bits(bits + i * step + c * step / 3);
        if (!expect(facet_encode(&image, NULL) == FACET_OK, "refused")) return;
        for (int i = 0; i < WIDTH; i++)
            for (int c = 0; c < 3; c++) {
                int want = before[c];
                while (want < 255 && light[c][i] >= thresholds[want + 1]) want++;
                before[c] = want;
                expect(pixels[4 * i + c] == want, "%a is %d, not %d", (double)light[c][i], pixels[4 * i + c], want);
            }
    }
}

static void check_specials(void)
{
    static const struct { float x; int want; } specials[] = {
        { 0.0f, 0 }, { -0.0f, 0 }, { FLT_TRUE_MIN, 0 }, { -FLT_TRUE_MIN, 0 }, { -1.0f, 0 }, { -FLT_MAX, 0 },
        { -INFINITY, 0 }, { NAN, 0 }, { -NAN, 0 }, { 1.0f, 255 }, { 0x1.fffffep-1f, 255 }, { 0x1.000002p0f, 255 },
        { 1000.0f, 255 }, { FLT_MAX, 255 }, { INFINITY, 255 },
    };
    test("NaN, negative, infinite");
    for (size_t i = 0; i < sizeof specials / sizeof specials[0]; i++)
        expect(encode_one(specials[i].x) == specials[i].want, "%a is %d", (double)specials[i].x,
               encode_one(specials[i].x));
    expect(encode_one(from_bits(0x7f800001)) == 0, "a signalling NaN is not 0");
    expect(encode_one(from_bits(0xffbfffff)) == 0, "a negative signalling NaN is not 0");
}

static void check_exposure(void)
{
    static const float exposures[] = { 0.0f, -0.0f, 1.0f, 0.5f, 3.0f, 0x1.4p-20f, 1e-30f, 1e30f, FLT_TRUE_MIN,
                                       FLT_MAX };
    test_random r = { 2 };
    test("exposure multiplies before the curve; 0 is 1");
    for (size_t i = 0; i < sizeof exposures / sizeof exposures[0]; i++) {
        const float exposure = exposures[i], factor = exposure > 0 ? exposure : 1;
        expect(encode_scaled(NAN, exposure) == 0, "NaN is not 0 at %a", (double)exposure);
        expect(encode_scaled(-1, exposure) == 0, "-1 is not 0 at %a", (double)exposure);
        expect(encode_scaled(INFINITY, exposure) == 255, "infinity is not 255 at %a", (double)exposure);
        for (int k = 0; k < 2000; k++) {
            const float x = (float)random_unit(&r) / (k & 1 ? factor : 1), product = x * factor;
            const int got = encode_scaled(x, exposure), want = byte_of(product);
            expect(got == want, "%a times %a is %d, not %d", (double)x, (double)exposure, got, want);
        }
    }
}

/* ---- Opacity ----------------------------------------------------------------------------------------------------- */

/* Nearest to 255 a, halves up, exactly: a float times 255 fits a double. */
static int opacity_byte(float a)
{
    return !(a > 0) ? 0 : a >= 1 ? 255 : (int)floor((double)a * 255 + 0.5);
}

static int encode_opacity(float a)
{
    uint8_t pixel[4] = { 0 };
    const float black = 0;
    const facet_image image = { .width = 1, .height = 1, .radiance = { &black, &black, &black }, .pixels = pixel,
                                .opacity_from = FACET_OPACITY_STREAM, .opacity = &a };
    expect(facet_encode(&image, NULL) == FACET_OK, "refused");
    return pixel[3];
}

static void check_opacity_of(float a)
{
    const int got = encode_opacity(a), want = opacity_byte(a);
    expect(got == want, "%a is %d, not %d", (double)a, got, want);
}

static void check_opacity(void)
{
    static const float specials[] = { 0.0f, -0.0f, -1.0f, -INFINITY, NAN, FLT_TRUE_MIN, 1.0f, 0x1.fffffep-1f, 2.0f,
                                      INFINITY };
    test_random r = { 3 };
    test("opacity is rounded to nearest at every step");
    for (int c = 0; c < 255; c++) {
        float a = (float)((c + 0.5) / 255);
        for (int k = 0; k < 4; k++) a = nextafterf(a, 0);
        for (int k = 0; k < 8; k++, a = nextafterf(a, 1)) check_opacity_of(a);
    }
    for (size_t i = 0; i < sizeof specials / sizeof specials[0]; i++) check_opacity_of(specials[i]);
    for (int i = 0; i < 10000; i++) check_opacity_of((float)random_unit(&r));
}

/* ---- Layout ------------------------------------------------------------------------------------------------------ */

enum { MOST = 12, CANARY = 0xa5 };

/* Streams that end at a page which faults; pixels between canaries. */
typedef struct { guarded light[3], opacity, coverage, pixels; } places;

typedef struct { facet_image image; uint8_t *pixels_first; size_t pixels_length; } layout;

static const float *at_end(const guarded *g, size_t count) { return (const float *)(const void *)g->end - count; }

static void fill_random(test_random *r, places *p)
{
    guarded *streams[] = { &p->light[0], &p->light[1], &p->light[2], &p->opacity };
    for (int s = 0; s < 4; s++) {
        float *end = (float *)(void *)streams[s]->end;
        for (int i = 1; i <= MOST * MOST; i++) end[-i] = (float)random_unit(r) * 1.1f - 0.05f;
    }
    for (int i = 1; i <= MOST * MOST; i++) p->coverage.end[-i] = (uint8_t)random_u64(r);
    memset(p->pixels.first, CANARY, (size_t)(p->pixels.end - p->pixels.first));
}

static size_t below(test_random *r, size_t count) { return (size_t)(random_u64(r) % count); }

static layout random_layout(test_random *r, const places *p)
{
    const size_t width = below(r, 8), height = below(r, 6), stride = below(r, 2) ? 0 : width + below(r, MOST - 8);
    const size_t row = 4 * width, pitch = below(r, 2) ? row : row + below(r, 9);
    const size_t floats = height && width ? (height - 1) * (stride ? stride : width) + width : 0;
    const bool upside_down = below(r, 2), packed = pitch == row && !upside_down && below(r, 2);
    const size_t length = height ? (height - 1) * pitch + row : 0;

    layout l = { .pixels_first = p->pixels.end - length, .pixels_length = length };
    l.image = (facet_image){
        .width = width, .height = height, .stride = stride,
        .radiance = { at_end(&p->light[0], floats), at_end(&p->light[1], floats), at_end(&p->light[2], floats) },
        .opacity_from = (facet_opacity)below(r, 3), .opacity = at_end(&p->opacity, floats),
        .coverage = p->coverage.end - (floats + 7) / 8, .pixels = l.pixels_first,
        .pitch = packed ? 0 : upside_down ? -(ptrdiff_t)pitch : (ptrdiff_t)pitch,
    };
    if (upside_down && height) l.image.pixels += (height - 1) * pitch;
    return l;
}

static int want_opacity(const facet_image *i, size_t at)
{
    switch (i->opacity_from) {
    case FACET_OPACITY_FULL: break;
    case FACET_OPACITY_STREAM: return opacity_byte(i->opacity[at]);
    case FACET_OPACITY_COVERAGE: return i->coverage[at / 8] >> at % 8 & 1 ? 255 : 0;
    }
    return 255;
}

static void want_pixels(const facet_image *i, uint8_t *pixels)
{
    const ptrdiff_t pitch = i->pitch ? i->pitch : (ptrdiff_t)(4 * i->width);
    const size_t stride = i->stride ? i->stride : i->width;
    for (size_t y = 0; y < i->height; y++)
        for (size_t x = 0; x < i->width; x++) {
            uint8_t *pixel = pixels + (ptrdiff_t)y * pitch + 4 * (ptrdiff_t)x;
            for (int c = 0; c < 3; c++) pixel[c] = (uint8_t)byte_of(i->radiance[c][y * stride + x]);
            pixel[3] = (uint8_t)want_opacity(i, y * stride + x);
        }
}

static void encode_layout(void *argument)
{
    const layout *l = argument;
    expect(facet_encode(&l->image, NULL) == FACET_OK, "refused");
}

static void check_layouts(void)
{
    const int rounds = test_slow_machine ? 500 : 5000;
    test_random r = { 4 };
    places p = { .pixels = guarded_allocate(4 * MOST * MOST), .coverage = guarded_allocate(MOST * MOST),
                 .opacity = guarded_allocate(MOST * MOST * sizeof(float)) };
    for (int c = 0; c < 3; c++) p.light[c] = guarded_allocate(MOST * MOST * sizeof(float));
    const size_t length = (size_t)(p.pixels.end - p.pixels.first);
    uint8_t *want = malloc(length);
    if (!want) abort();

    test("%d images: stride, pitch of either sign, opacity, empty rows; nothing beside", rounds);
    for (int round = 0; round < rounds; round++) {
        fill_random(&r, &p);
        layout l = random_layout(&r, &p);
        memset(want, CANARY, length);
        want_pixels(&l.image, want + (l.image.pixels - p.pixels.first));
        const facet_image *i = &l.image;
        const char *fault = fault_of(encode_layout, &l);
        expect(!fault, "%s: %zu by %zu, stride %zu, pitch %td", fault, i->width, i->height, i->stride, i->pitch);
        expect(!memcmp(want, p.pixels.first, length), "%zu by %zu, stride %zu, pitch %td, opacity %d: other pixels",
               i->width, i->height, i->stride, i->pitch, (int)i->opacity_from);
    }
    free(want);
    guarded *all[] = { &p.light[0], &p.light[1], &p.light[2], &p.opacity, &p.coverage, &p.pixels };
    for (size_t i = 0; i < sizeof all / sizeof all[0]; i++) guarded_free(all[i]);
}

/* ---- Refusals ---------------------------------------------------------------------------------------------------- */

static void refuses(const char *change, const facet_image *image, facet_status code, const char *field, int index)
{
    facet_error error = { FACET_OK, NULL, 0 };
    const facet_status status = facet_encode(image, &error);
    expect_refused(change, status, &error, code, field, index);
    expect(facet_encode(image, NULL) == code, "%s: another status without an error", change);
}

static void check_refusals(void)
{
    static const float light[8];
    static const uint8_t coverage[1];
    uint8_t pixels[32], untouched[32];
    const facet_image good = { .width = 4, .height = 2, .radiance = { light, light, light }, .opacity = light,
                               .coverage = coverage, .pixels = pixels };
    memset(pixels, CANARY, sizeof pixels);
    memset(untouched, CANARY, sizeof untouched);

    test("refusals by status, field and index; nothing written");
    refuses("image NULL", NULL, FACET_ERROR_NULL, "image", -1);
#define REFUSES(change, code, field, index)                                                                           \
    do {                                                                                                              \
        facet_image i = good;                                                                                        \
        change;                                                                                                      \
        refuses(#change, &i, code, field, index);                                                                    \
    } while (0)
    for (int c = 0; c < 3; c++) REFUSES(i.radiance[c] = NULL, FACET_ERROR_NULL, "radiance", c);
    REFUSES(i.pixels = NULL, FACET_ERROR_NULL, "pixels", -1);
    REFUSES(i.exposure = NAN, FACET_ERROR_VALUE, "exposure", -1);
    REFUSES(i.exposure = INFINITY, FACET_ERROR_VALUE, "exposure", -1);
    REFUSES(i.exposure = -FLT_TRUE_MIN, FACET_ERROR_VALUE, "exposure", -1);
    REFUSES(i.opacity_from = (facet_opacity)3, FACET_ERROR_ENUM, "opacity_from", -1);
    REFUSES(i.opacity_from = (facet_opacity)-1, FACET_ERROR_ENUM, "opacity_from", -1);
    REFUSES((i.opacity_from = FACET_OPACITY_STREAM, i.opacity = NULL), FACET_ERROR_NULL, "opacity", -1);
    REFUSES((i.opacity_from = FACET_OPACITY_COVERAGE, i.coverage = NULL), FACET_ERROR_NULL, "coverage", -1);
    REFUSES(i.stride = 3, FACET_ERROR_VALUE, "stride", -1);
    REFUSES(i.pitch = 15, FACET_ERROR_VALUE, "pitch", -1);
    REFUSES(i.pitch = -15, FACET_ERROR_VALUE, "pitch", -1);
    REFUSES(i.width = SIZE_MAX / 2, FACET_ERROR_VALUE, "width", -1);
#undef REFUSES
    expect(!memcmp(pixels, untouched, sizeof pixels), "pixels were written");

    facet_error error = { FACET_ERROR_NULL, "stale", 5 };
    expect_accepted("a good image", facet_encode(&good, &error), &error);
}

void suite_encode(void)
{
    check_thresholds();
    check_sweep();
    check_specials();
    check_exposure();
    check_opacity();
    check_layouts();
    check_refusals();
}
