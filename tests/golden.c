/* The bytes of strict results, one hash per kernel, against those committed in golden.txt: the same on every
 * machine. */
#include "golden.h"

#include "bits.h"
#include "cases.h"
#include "samples.h"
#include "targets.h"

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* ---- Samples by integer arithmetic ------------------------------------------------------------------------------- */

/* Components in units of 2^-23. */
typedef struct { int64_t c[3]; } fixed;
enum { UNIT = 1 << 23 };

static int64_t dot(fixed a, fixed b) { return a.c[0] * b.c[0] + a.c[1] * b.c[1] + a.c[2] * b.c[2]; }

static int64_t square_root(int64_t x)
{
    int64_t root = 0;
    for (int64_t bit = (int64_t)1 << 30; bit; bit >>= 1)
        if ((root + bit) * (root + bit) <= x) root += bit;
    return root;
}

static fixed unit(fixed a)
{
    const int64_t length = square_root(dot(a, a));
    if (!length) return (fixed){ { 0, 0, UNIT } };
    for (int c = 0; c < 3; c++) a.c[c] = a.c[c] * UNIT / length;
    return a;
}

static int64_t between(test_random *r, int64_t least, int64_t most)
{
    return least + (int64_t)(random_u64(r) % (uint64_t)(most - least + 1));
}

static fixed any_direction(test_random *r)
{
    fixed a;
    for (int c = 0; c < 3; c++) a.c[c] = between(r, -UNIT, UNIT);
    return unit(a);
}

/* a, or its mirror image where it is below the plane of n. */
static fixed above(fixed n, fixed a)
{
    const int64_t nearness = dot(n, a), twice = nearness / (UNIT / 2);
    if (nearness < 0)
        for (int c = 0; c < 3; c++) a.c[c] -= twice * n.c[c] / UNIT;
    return a;
}

/* a, turned by up to 2^-23 .. 1. */
static fixed jitter(test_random *r, fixed a)
{
    const int64_t span = UNIT >> between(r, 0, 23);
    for (int c = 0; c < 3; c++) a.c[c] += between(r, -span, span);
    return unit(a);
}

static fixed light_direction(test_random *r, fixed n, fixed v)
{
    const int64_t nv = dot(n, v) / UNIT;
    fixed l = any_direction(r);
    const int kind = (int)between(r, 0, 7);
    for (int c = 0; c < 3; c++) {
        if (kind < 3) l.c[c] = 2 * nv * n.c[c] / UNIT - v.c[c];    /* the mirror direction */
        else if (kind == 3) l.c[c] = v.c[c];
        else if (kind == 4) l.c[c] = -v.c[c];
    }
    if (kind < 5) l = jitter(r, l);
    return kind == 7 ? l : above(n, l);
}

static void store(float *to, fixed a)
{
    for (int c = 0; c < 3; c++) to[c] = (float)a.c[c] * 0x1p-23f;
}

/* m 2^-e, exactly. */
static float scaled(int64_t m, int64_t e)
{
    float x = (float)m;
    for (; e > 0; e--) x *= 0.5f;
    return x;
}

static void edge(test_random *r, float *x)
{
    static const uint32_t bits[] = {
        0x00000000, 0x80000000, 0x00000001, 0x80000001, 0x007fffff, 0x00800000, 0x0f800000, 0x2f800000, 0x33800000,
        0x3effffff, 0x3f7fffff, 0x3f800000, 0x3f800001, 0x40000000, 0x4f800000, 0x5f800000, 0x7f7fffff, 0xff7fffff,
        0xbf800000, 0x7f800000, 0xff800000, 0x7fc00000, 0xffc01234,
    };
    *x = from_bits(bits[random_u64(r) % (sizeof bits / sizeof bits[0])]);
}

sample golden_sample(test_random *r, bool edges)
{
    sample s;
    const fixed n = any_direction(r), v = above(n, any_direction(r)), l = light_direction(r, n, v);
    const int64_t binade = between(r, 0, 14);
    store(s.n, n);
    store(s.v, between(r, 0, 15) ? v : any_direction(r));
    store(s.l, l);
    s.sigma = scaled(between(r, 0, 0xc90fdb), 23);               /* up to pi/2 */
    s.alpha = scaled(between(r, UNIT / 2, UNIT), 23 + binade);
    for (int c = 0; c < 3; c++) {
        s.albedo[c] = scaled(between(r, 0, UNIT), 23);
        s.f0[c] = scaled(between(r, 0, UNIT), 23);
        s.irradiance[c] = scaled(between(r, 0, UNIT), 20);
    }
    enum { FLOATS = sizeof s / sizeof(float) };
    if (edges && between(r, 0, 3) == 0) edge(r, (float *)&s + random_u64(r) % FLOATS);
    return s;
}

/* ---- Hashes ------------------------------------------------------------------------------------------------------ */

enum { COUNT = 1021, MATERIALS = 300, MATERIAL_SAMPLES = 5 };

#define HASH_START UINT64_C(0xcbf29ce484222325)

/* FNV-1a, 64 bits. */
static uint64_t hash_byte(uint64_t hash, unsigned byte)
{
    return (hash ^ byte) * UINT64_C(0x100000001b3);
}

/* Most significant byte first, whatever the machine. */
static uint64_t hash_floats(uint64_t hash, const float *a, size_t count)
{
    for (size_t i = 0; i < count; i++) {
        const uint32_t bits = to_bits(a[i]);
        for (int shift = 24; shift >= 0; shift -= 8) hash = hash_byte(hash, bits >> shift & 0xff);
    }
    return hash;
}

static uint64_t hash_radiance(uint64_t hash, const facet_batch *b)
{
    for (int c = 0; c < 3; c++) hash = hash_floats(hash, b->radiance[c], b->count);
    return hash;
}

static sample_batch golden_batch(uint64_t seed, int count, bool edges)
{
    test_random r = { seed };
    sample *samples = malloc((size_t)count * sizeof *samples);
    if (!samples) abort();
    for (int i = 0; i < count; i++) samples[i] = golden_sample(&r, edges);
    sample_batch b = batch_of(samples, count);
    free(samples);
    return b;
}

static void shade(const facet_material *m, facet_arch arch, const facet_batch *b)
{
    facet_plan plan;
    facet_error error;
    facet_plan_init(&plan, m, (facet_target){ arch, FACET_TIER_STRICT }, &error);
    if (!error.code) facet_shade(&plan, b, &error);
    expect(!error.code, "%s is refused", error.field);
}

/* One light for all samples, nothing added, no edge values: what a kernel may have a short way for. */
static uint64_t hash_plain(uint64_t hash, const facet_material *m, facet_arch arch)
{
    sample_batch b = golden_batch(6, COUNT, false);
    const facet_light light = { .direction = { 0.6f, -0.48f, 0.64f }, .irradiance = { 0.5f, 1, 2 } };
    b.batch.lights = &light;
    shade(m, arch, &b.batch);
    hash = hash_radiance(hash, &b.batch);
    free_batch(&b);
    return hash;
}

/* Three lights, everything added and edge values; then two-sided, added to that. */
static uint64_t hash_rich(uint64_t hash, facet_material m, facet_arch arch)
{
    sample_batch b = golden_batch(1, COUNT, true);
    facet_light lights[3] = { b.batch.lights[0], b.batch.lights[0], { .direction = { 0.6f, -0.48f, 0.64f } } };
    lights[0].visibility = b.batch.alpha;
    for (int c = 0; c < 3; c++) {
        lights[1].direction_of[c] = b.batch.normal[c];
        lights[2].irradiance[c] = 0.7f;
        m.emission[c] = 0.01f;
        b.batch.ambient[c] = 0.1f;
    }
    b.batch.lights = lights;
    b.batch.light_count = 3;
    shade(&m, arch, &b.batch);
    hash = hash_radiance(hash, &b.batch);
    b.batch.flags = FACET_ACCUMULATE | FACET_TWO_SIDED;
    b.batch.light_count = 2;
    shade(&m, arch, &b.batch);
    hash = hash_radiance(hash, &b.batch);
    free_batch(&b);
    return hash;
}

/* Every parameter per sample. */
static uint64_t hash_case(const kernel_case *k, facet_arch arch)
{
    facet_material m = k->material;
    m.streams = k->streams;
    return hash_rich(hash_plain(HASH_START, &m, arch), m, arch);
}

/* Many materials of numbers: what facet_plan_init computes, as it shows in the radiance of a few samples. */
static uint64_t hash_plans(facet_arch arch)
{
    uint64_t hash = HASH_START;
    test_random r = { 2 };
    sample_batch b = golden_batch(3, MATERIAL_SAMPLES, false);
    for (int i = 0; i < MATERIALS; i++) {
        const kernel_case *k = case_at(i % case_count());
        const sample s = golden_sample(&r, false), t = golden_sample(&r, false);
        facet_material m = k->material;
        m.diffuse.sigma = s.sigma > k->sigma_max ? k->sigma_max : s.sigma;
        m.specular.alpha = s.alpha;
        m.fresnel.f90 = t.albedo[0];
        m.fresnel.eta_outside = 1 + t.albedo[1];
        for (int c = 0; c < 3; c++) {
            m.diffuse.albedo[c] = s.albedo[c];
            m.fresnel.f0[c] = i & 16 ? s.f0[c] : 0;
            m.fresnel.eta[c] = 0.5f + t.irradiance[c];
            m.fresnel.k[c] = t.f0[c];
            m.emission[c] = t.albedo[c];
        }
        shade(&m, arch, &b.batch);
        hash = hash_radiance(hash, &b.batch);
    }
    free_batch(&b);
    return hash;
}

static uint64_t hash_pixels(void)
{
    static uint8_t pixels[4 * COUNT];
    uint64_t hash = HASH_START;
    test_random r = { 4 };
    sample_batch b = golden_batch(5, COUNT, true);
    facet_image image = { .width = COUNT, .height = 1, .radiance = { b.batch.albedo[0], b.batch.alpha, b.batch.f0[0] },
                          .opacity_from = FACET_OPACITY_STREAM, .opacity = b.batch.albedo[1], .pixels = pixels };
    for (int i = 0; i < 20; i++) {
        image.exposure = scaled(between(&r, UNIT / 2, UNIT), 20 + i);
        expect(facet_encode(&image, NULL) == FACET_OK, "refused");
        for (size_t k = 0; k < sizeof pixels; k++) hash = hash_byte(hash, pixels[k]);
    }
    free_batch(&b);
    return hash;
}

/* ---- The committed file ------------------------------------------------------------------------------------------ */

typedef struct { char name[64]; uint64_t hash; } golden_row;
enum { MOST_ROWS = 256 };
static golden_row committed[MOST_ROWS];
static int committed_count;

static void golden_path(char *path, size_t size)
{
    snprintf(path, size, "%s/golden.txt", test_data);
}

static bool read_committed(void)
{
    char path[512], line[256];
    golden_path(path, sizeof path);
    FILE *file = fopen(path, "r");
    if (!file) return false;
    committed_count = 0;
    while (committed_count < MOST_ROWS && fgets(line, sizeof line, file)) {
        golden_row *row = &committed[committed_count];
        if (line[0] != '#' && sscanf(line, "%63s %" SCNx64, row->name, &row->hash) == 2) committed_count++;
    }
    fclose(file);
    return committed_count > 0;
}

static bool write_committed(void)
{
    char path[512];
    golden_path(path, sizeof path);
    FILE *file = fopen(path, "w");
    if (!file) return false;
    fprintf(file, "# The bytes of strict results, the same on every machine, from every compiler: FNV-1a hashes.\n"
                  "# Written by `facet-check --update golden`; what it hashes is in tests/golden.c.\n");
    for (int i = 0; i < case_count(); i++)
        fprintf(file, "%-52s %016" PRIx64 "\n", case_at(i)->name, hash_case(case_at(i), FACET_ARCH_SCALAR));
    fprintf(file, "%-52s %016" PRIx64 "\n", "plans", hash_plans(FACET_ARCH_SCALAR));
    fprintf(file, "%-52s %016" PRIx64 "\n", "pixels", hash_pixels());
    return !fclose(file);
}

static void check_hash(const char *name, uint64_t hash)
{
    for (int i = 0; i < committed_count; i++)
        if (!strcmp(committed[i].name, name)) {
            expect(committed[i].hash == hash, "%016" PRIx64 ", not the committed %016" PRIx64, hash, committed[i].hash);
            return;
        }
    expect(false, "golden.txt has no such row; here it is %016" PRIx64, hash);
}

/* ---- Tests ------------------------------------------------------------------------------------------------------- */

static void check_rows(void)
{
    test("every row of golden.txt is of a kernel");
    if (!whole_build()) skip("this build has fewer models");
    else expect(committed_count == case_count() + 2, "%d rows for %d kernels, plans and pixels", committed_count,
                case_count());
}

static void check_arch(facet_arch arch)
{
    const char *word = facet_word(FACET_KIND_ARCH, (int)arch);
    for (int i = 0; i < case_count(); i++) {
        test("%s %s", word, case_at(i)->name);
        check_hash(case_at(i)->name, hash_case(case_at(i), arch));
    }
    test("%s plans", word);
    if (!whole_build()) skip("this build has fewer models");
    else check_hash("plans", hash_plans(arch));
}

void suite_golden(void)
{
    test("golden.txt");
    if (!facet_has(FACET_KIND_TIER, FACET_TIER_STRICT)) {
        skip("this build has no strict tier");
        return;
    }
    if (test_update) expect(write_committed(), "cannot be written in %s", test_data);
    if (!expect(read_committed(), "cannot be read in %s", test_data)) return;
    check_rows();
    for (int i = 0; i < target_count(); i++)
        if (target_at(i).tier == FACET_TIER_STRICT) check_arch(target_at(i).arch);
    skip_absent_targets();
    test("pixels");
    check_hash("pixels", hash_pixels());
}
