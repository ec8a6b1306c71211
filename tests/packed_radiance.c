/* Radiance as halves and pixels: over floats of every size, steps and ties among them. A Lambertian sheet under an
 * ambient irradiance of pi has its albedo as radiance: every float. */
#include "packed.h"

#include "bits.h"
#include "half.h"
#include "harness.h"
#include "targets.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { COUNT = 4099 };

typedef struct {
    facet_plan plan;
    float radiance[3][COUNT];
    float exposure;
    bool halves;
} sheet;

static void lay_sheet(sheet *s, facet_target target)
{
    const facet_material m = { .diffuse = { .model = FACET_DIFFUSE_LAMBERT }, .streams = FACET_STREAM_ALBEDO };
    expect(facet_plan_init(&s->plan, &m, target, NULL) == FACET_OK, "refused");
}

static facet_batch batch_of_sheet(const sheet *s)
{
    static const float normal[3] = { 0, 0, 1 };
    return (facet_batch){ .count = COUNT, .normal = { &normal[0], &normal[1], &normal[2] },
                          .uniform = FACET_STREAM_NORMAL, .ambient = { 0x1.921fb6p1f, 0x1.921fb6p1f, 0x1.921fb6p1f },
                          .albedo = { s->radiance[0], s->radiance[1], s->radiance[2] } };
}

/* That the radiance is what was asked for. */
static void check_sheet(const sheet *s)
{
    static float radiance[3][COUNT];
    facet_batch b = batch_of_sheet(s);
    for (int c = 0; c < 3; c++) b.radiance[c] = radiance[c];
    expect(facet_shade(&s->plan, &b, NULL) == FACET_OK, "refused");
    for (int c = 0; c < 3; c++)
        for (int i = 0; i < COUNT; i++)
            expect(to_bits(radiance[c][i]) == to_bits(s->radiance[c][i]), "an albedo of %a gives a radiance of %a",
                   (double)s->radiance[c][i], (double)radiance[c][i]);
}

static void check_pixels(const sheet *s)
{
    static uint8_t want[4 * COUNT], words[4 * COUNT + 4];
    uint8_t *pixels = words + (4 - (uintptr_t)words % 4) % 4;
    const facet_image image = { .width = COUNT, .height = 1, .exposure = s->exposure, .pixels = want,
                                .radiance = { s->radiance[0], s->radiance[1], s->radiance[2] } };
    facet_batch b = batch_of_sheet(s);
    b.packed.pixels = pixels;
    b.packed.exposure = s->exposure;
    expect(facet_shade(&s->plan, &b, NULL) == FACET_OK && facet_encode(&image, NULL) == FACET_OK, "refused");
    for (int i = 0; i < 4 * COUNT; i++)
        expect(pixels[i] == want[i], "byte %d of a pixel of %a, exposure %a, is %d, not %d", i % 4,
               (double)s->radiance[i % 4 % 3][i / 4], (double)s->exposure, pixels[i], want[i]);
}

static void check_halves(const sheet *s)
{
    static uint16_t half[3][COUNT];
    facet_batch b = batch_of_sheet(s);
    for (int c = 0; c < 3; c++) b.packed.half[c] = half[c];
    expect(facet_shade(&s->plan, &b, NULL) == FACET_OK, "refused");
    for (int c = 0; c < 3; c++)
        for (int i = 0; i < COUNT; i++)
            expect(half[c][i] == nearest_half(s->radiance[c][i]), "%a is the half %04x, not %04x",
                   (double)s->radiance[c][i], half[c][i], nearest_half(s->radiance[c][i]));
}

/* A batch of a header that knows of no packed streams ends before them; behind it may stand anything. */
static void check_older_header(const sheet *s)
{
    static float radiance[3][COUNT];
    facet_batch b = batch_of_sheet(s);
    memset(&b.packed, 0xa5, sizeof b.packed);
    for (int c = 0; c < 3; c++) b.radiance[c] = radiance[c];
    const facet_status status =
        facet_shade_sized(&s->plan, &b, offsetof(facet_batch, packed), sizeof(facet_light), NULL);
    expect(status == FACET_OK && !memcmp(radiance, s->radiance, sizeof radiance), "an older batch: status %d",
           (int)status);
}

/* ---- Floats ------------------------------------------------------------------------------------------------------ */

/* Floats, three a sample, from a list that goes on; checked whenever a sheet is full. */
typedef struct { sheet *s; int count; } feed;

static void flush(feed *f)
{
    for (; f->count % (3 * COUNT); f->count++) f->s->radiance[f->count % 3][f->count / 3] = 0;
    f->count = 0;
    if (f->s->halves) check_halves(f->s);
    else check_pixels(f->s);
}

static void put(feed *f, float x)
{
    f->s->radiance[f->count % 3][f->count / 3] = x;
    if (++f->count == 3 * COUNT) flush(f);
}

static void put_around(feed *f, float x)
{
    const uint32_t bits = to_bits(x);
    for (uint32_t k = bits < 3 ? 0 : bits - 3; k <= bits + 3; k++)
        if (k < 0x7f800000) put(f, from_bits(k));
}

static void put_sweep(feed *f, uint32_t first, uint32_t last, uint32_t step)
{
    for (uint32_t bits = first; bits <= last; bits += step) put(f, from_bits(bits));
    flush(f);
}

/* The least float whose byte is at least c. */
static float threshold(int c)
{
    uint32_t low = 0, high = to_bits(1.0f);
    while (low < high) {
        const uint32_t middle = low + (high - low) / 2;
        const float x = from_bits(middle);
        uint8_t pixel[4];
        const facet_image image = { .width = 1, .height = 1, .radiance = { &x, &x, &x }, .pixels = pixel };
        expect(facet_encode(&image, NULL) == FACET_OK, "refused");
        if (pixel[0] >= c) high = middle;
        else low = middle + 1;
    }
    return from_bits(low);
}

static void check_all_pixels(sheet *s, const float thresholds[256])
{
    static const float exposures[] = { 0, 1, 0.37f, 3, 0x1.4p-20f, 1e30f, FLT_TRUE_MIN, FLT_MAX };
    feed f = { s, 0 };
    s->halves = false;
    for (size_t k = 0; k < sizeof exposures / sizeof exposures[0]; k++) {
        const float factor = exposures[k] > 0 ? exposures[k] : 1;
        s->exposure = exposures[k];
        for (int c = 1; c < 256; c++) put_around(&f, fminf(thresholds[c] / factor, FLT_MAX));
        put_around(&f, fminf(1 / factor, FLT_MAX));
        put_sweep(&f, 0, 0x7f7fffff, test_slow_machine ? 1228909 : 122891);
    }
    s->exposure = 0;
    put_sweep(&f, 0x38000000, 0x3f800010, test_slow_machine ? 12289 : 379);
}

static void check_all_halves(sheet *s)
{
    feed f = { s, 0 };
    s->halves = true;
    for (uint32_t half = 0; half < 0x7bff; half += test_slow_machine ? 13 : 1) {
        const double unit = half < 0x800 ? 0x1p-24 : ldexp(1, (int)(half >> 10) - 25);
        const double x = (half < 0x400 ? half : 1024 + (half & 1023)) * unit;
        put_around(&f, (float)x);
        put_around(&f, (float)(x + unit / 2));           /* the tie behind it */
    }
    put_around(&f, 65504);
    put_around(&f, 65520);
    put_around(&f, FLT_MAX);
    put_sweep(&f, 0, 0x7f7fffff, test_slow_machine ? 12289 : 1229);
}

void test_packed_radiance(void)
{
    static sheet s;
    float thresholds[256];
    for (int i = 0; i < target_count(); i++) {
        const char *words = target_words(target_at(i));
        test("%s: an albedo is a radiance; from an older header, too", words);
        lay_sheet(&s, target_at(i));
        for (int c = 0; c < 3; c++)
            for (int k = 0; k < COUNT; k++) s.radiance[c][k] = from_bits((uint32_t)(k * 3 + c) * 173731);
        check_sheet(&s);
        check_older_header(&s);

        test("%s: pixels are facet_encode's", words);
        for (int c = 0; c < 256; c++) thresholds[c] = threshold(c);
        check_all_pixels(&s, thresholds);

        test("%s: halves are the nearest", words);
        check_all_halves(&s);
    }
}
