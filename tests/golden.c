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

static fixed cross(fixed a, fixed b)
{
    fixed x;
    for (int c = 0; c < 3; c++)
        x.c[c] = (a.c[(c + 1) % 3] * b.c[(c + 2) % 3] - a.c[(c + 2) % 3] * b.c[(c + 1) % 3]) / UNIT;
    return x;
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

/* m 2^-e, exactly; m of at most 24 bits. */
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

/* In [1/2, 1], halved or doubled up to so often. */
static float in_binades(test_random *r, int64_t halvings, int64_t doublings)
{
    const int64_t binade = between(r, -doublings, halvings);
    return scaled(between(r, UNIT / 2, UNIT), 23 + binade);
}

/* Up to 7; one in four near 1. */
static float any_eta(test_random *r)
{
    const int64_t span = UNIT >> between(r, 8, 23);
    if (between(r, 0, 3) == 0) return scaled(UNIT + between(r, -span, span), 23);
    return scaled(between(r, 1 << 16, 7 << 20), 20);
}

sample golden_sample(test_random *r, bool edges)
{
    sample s = { .light = NULL };
    const fixed n = any_direction(r), v = above(n, any_direction(r)), l = light_direction(r, n, v);
    store(s.n, n);
    store(s.v, between(r, 0, 15) ? v : any_direction(r));
    store(s.l, l);
    store(s.tangent, unit(cross(n, any_direction(r))));
    s.sigma = scaled(between(r, 0, 0xc90fdb), 23);               /* up to pi/2 */
    s.alpha = in_binades(r, 14, 0);
    s.alpha_y = in_binades(r, 14, 0);
    s.exponent = in_binades(r, -1, 13);
    for (int c = 0; c < 3; c++) {
        s.position[c] = scaled(between(r, -(4 << 20), 4 << 20), 20);
        s.albedo[c] = scaled(between(r, 0, UNIT), 23);
        s.f0[c] = scaled(between(r, 0, UNIT), 23);
        s.eta[c] = any_eta(r);
        s.k[c] = between(r, 0, 3) ? scaled(between(r, 0, 8 << 20), 20) : 0;
        s.irradiance[c] = scaled(between(r, 0, UNIT), 20);
    }
    enum { FLOATS = (offsetof(sample, irradiance) + sizeof s.irradiance) / sizeof(float) };
    if (edges && between(r, 0, 3) == 0) edge(r, (float *)&s + random_u64(r) % FLOATS);
    return s;
}

/* ---- Hashes ------------------------------------------------------------------------------------------------------ */

/* MATERIALS: of every kernel. */
enum { COUNT = 1021, MATERIALS = 20, MATERIAL_SAMPLES = 5 };

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
    for (int c = 0; c < 3; c++) b.batch.base[c] = b.batch.albedo[c];
    b.batch.metallic = b.batch.f0[0];
    b.batch.specular_level = b.batch.f0[1];
    b.batch.roughness = b.batch.glossiness = b.batch.alpha;
    free(samples);
    return b;
}

static void shade(const facet_material *m, facet_arch arch, const facet_batch *b)
{
    facet_plan plan;
    facet_error error;
    facet_plan_init(&plan, m, (facet_target){ .arch = arch, .tier = FACET_TIER_STRICT }, &error);
    if (!error.code) facet_shade(&plan, b, &error);
    expect(!error.code, "%s is refused", error.field);
}

/* One light for all samples, nothing added, no edge values: what a kernel may have a short way for. */
static uint64_t hash_plain(uint64_t hash, const kernel_case *k, const facet_material *m, facet_arch arch)
{
    sample_batch b = golden_batch(6, COUNT, false);
    facet_light light = { .direction = { 0.6f, -0.48f, 0.64f } };
    if (k->light.kind != FACET_LIGHT_DIRECTIONAL) light = k->light;
    for (int c = 0; c < 3; c++) light.irradiance[c] = 0.5f * (float)(1 << c);
    b.batch.lights = &light;
    shade(m, arch, &b.batch);
    hash = hash_radiance(hash, &b.batch);
    free_batch(&b);
    return hash;
}

/* A light of every kind and source, everything added and edge values; then two-sided, added to that. */
static uint64_t hash_rich(uint64_t hash, facet_material m, facet_arch arch)
{
    static const facet_light spot = { .kind = FACET_LIGHT_SPOT, .position = { 0.5f, 3, -2 }, .axis = { 0, -0.8f, 0.6f },
                                      .cos_inner = 0.875f, .cos_outer = -0.25f };
    static const facet_light point = { .kind = FACET_LIGHT_POINT, .irradiance = { 5, 3, 2 }, .position = { -1, 0, 2 },
                                       .range = 4.5f };
    static const float sh[4][3] = { { 1, 0.5f, 0.25f }, { 1, -1, 0.5f }, { -0.5f, 1, 1 }, { 0.25f, -0.75f, -1 } };
    sample_batch b = golden_batch(1, COUNT, true);
    const facet_light samples = b.batch.lights[0];
    facet_light lights[5] = { samples, spot, samples, { .direction = { 0.6f, -0.48f, 0.64f } }, point };
    lights[0].visibility = lights[4].visibility = b.batch.alpha;
    for (int c = 0; c < 3; c++) {
        lights[1].irradiance_of[c] = samples.irradiance_of[c];
        lights[2].direction_of[c] = b.batch.normal[c];
        lights[3].irradiance[c] = 0.7f;
        m.emission[c] = 0.01f;
        b.batch.ambient[c] = 0.1f;
    }
    memcpy(b.batch.sh, sh, sizeof sh);
    b.batch.occlusion = b.batch.f0[2];
    b.batch.lights = lights;
    b.batch.light_count = 5;
    shade(&m, arch, &b.batch);
    hash = hash_radiance(hash, &b.batch);
    b.batch.flags = FACET_ACCUMULATE | FACET_TWO_SIDED;
    b.batch.light_count = 2;
    shade(&m, arch, &b.batch);
    hash = hash_radiance(hash, &b.batch);
    free_batch(&b);
    return hash;
}

/* Parameters that follow from others, per sample: from another convention's, eta from f0, f0 from eta and k, alpha_y
 * from alpha. */
static uint64_t hash_derived(uint64_t hash, facet_material m, facet_arch arch)
{
    const uint32_t promised = m.streams, index = FACET_STREAM_ETA | FACET_STREAM_K;
    const bool dielectric = m.fresnel.model == FACET_FRESNEL_DIELECTRIC;
    sample_batch b = golden_batch(7, COUNT, true);
    m.convention.model = FACET_CONVENTION_METALLIC_ROUGHNESS;
    m.streams |= FACET_STREAM_BASE | FACET_STREAM_METALLIC | FACET_STREAM_ROUGHNESS | FACET_STREAM_SPECULAR_LEVEL;
    if (dielectric) m.streams &= ~index;
    shade(&m, arch, &b.batch);
    hash = hash_radiance(hash, &b.batch);
    m.convention.model = FACET_CONVENTION_SPECULAR_GLOSSINESS;
    m.streams = (promised & ~(uint32_t)FACET_STREAM_ALPHA_Y) | FACET_STREAM_GLOSSINESS;
    if (promised & FACET_STREAM_F0) m.streams ^= FACET_STREAM_F0 | index;
    if (dielectric) m.streams ^= FACET_STREAM_F0 | FACET_STREAM_ETA;
    shade(&m, arch, &b.batch);
    hash = hash_radiance(hash, &b.batch);
    free_batch(&b);
    return hash;
}

/* Every parameter per sample. */
static uint64_t hash_case(const kernel_case *k, facet_arch arch)
{
    facet_material m = k->material;
    m.streams = k->promised;
    uint64_t hash = hash_plain(HASH_START, k, &m, arch);
    hash = hash_rich(hash, m, arch);
    return hash_derived(hash, m, arch);
}

/* A material of numbers alone; some are left to their defaults, or to what follows from others. */
static facet_material golden_material(const kernel_case *k, test_random *r)
{
    const sample s = golden_sample(r, false), t = golden_sample(r, false);
    const uint64_t bits = random_u64(r);
    const bool has_eta = k->material.fresnel.model == FACET_FRESNEL_CONDUCTOR || bits & 8;
    facet_material m = k->material;
    m.diffuse.sigma = s.sigma > k->sigma_max ? k->sigma_max : s.sigma;
    m.specular.alpha = s.alpha;
    m.specular.alpha_y = bits & 1 ? s.alpha_y : 0;
    m.specular.exponent = s.exponent;
    m.specular.scale = bits & 2 ? t.irradiance[0] : 0;
    m.fresnel.f90 = t.albedo[0];
    m.fresnel.eta_outside = bits & 4 ? t.eta[0] : 0;
    m.fresnel.polarisation = scaled(between(r, -UNIT, UNIT), 23);
    m.convention.model = (facet_convention)((bits >> 8) % 3);
    m.convention.metallic = t.f0[0];
    m.convention.roughness = t.f0[1];
    m.convention.specular_level = bits & 16 ? t.f0[2] : 0;
    m.convention.glossiness = t.albedo[2];
    for (int c = 0; c < 3; c++) {
        m.diffuse.albedo[c] = s.albedo[c];
        m.fresnel.f0[c] = has_eta && bits & 32 ? 0 : s.f0[c];
        m.fresnel.f82[c] = has_eta && bits & 64 ? 0 : t.f0[c];
        m.fresnel.eta[c] = has_eta ? s.eta[c] : 0;
        m.fresnel.k[c] = s.k[c];
        m.convention.base[c] = t.albedo[c];
        m.emission[c] = t.albedo[c];
    }
    return m;
}

/* What facet_plan_init computes, as it shows in the radiance of a few samples. */
static uint64_t hash_plans(facet_arch arch)
{
    uint64_t hash = HASH_START;
    test_random r = { 2 };
    sample_batch b = golden_batch(3, MATERIAL_SAMPLES, false);
    for (int i = 0; i < MATERIALS * case_count(); i++) {
        const facet_material m = golden_material(case_at(i % case_count()), &r);
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

static void random_bytes(test_random *r, uint8_t *bytes, size_t count)
{
    for (size_t i = 0; i < count; i++) bytes[i] = (uint8_t)random_u64(r);
}

#define PACKED_CASE "oren-nayar+ggx/smith-correlated/schlick/uncoupled"

/* Everything packed, under the sun of hash_plain: halves, then pixels. */
static uint64_t hash_packed(facet_arch arch)
{
    static int16_t normal[2 * COUNT];
    static _Alignas(4) uint8_t albedo_roughness[4 * COUNT], f0_sigma[4 * COUNT], pixels[4 * COUNT];
    static uint16_t half[3][COUNT];
    static const facet_light sun = { .direction = { 0.6f, -0.48f, 0.64f }, .irradiance = { 0.5f, 1, 2 } };
    static const facet_camera camera = { .corner = { -1, 0.75f, -1.5f }, .across = { 0x1p-5f, 0, 0x1p-9f },
                                         .down = { 0x1p-10f, -0x1.8p-5f, 0 }, .x = 3, .y = 2, .width = 61 };
    test_random r = { 8 };
    for (int i = 0; i < 2 * COUNT; i++) normal[i] = (int16_t)(uint16_t)random_u64(&r);
    random_bytes(&r, albedo_roughness, sizeof albedo_roughness);
    random_bytes(&r, f0_sigma, sizeof f0_sigma);
    const kernel_case *k = find_case(PACKED_CASE);
    facet_material m = k->material;
    m.streams = k->promised;
    const facet_batch b = { .count = COUNT, .lights = &sun, .light_count = 1,
                            .packed = { .normal = normal, .albedo_roughness = albedo_roughness, .f0_sigma = f0_sigma,
                                        .camera = &camera, .half = { half[0], half[1], half[2] }, .pixels = pixels,
                                        .exposure = 1.5f } };
    shade(&m, arch, &b);
    uint64_t hash = HASH_START;
    for (int c = 0; c < 3; c++)
        for (int i = 0; i < COUNT; i++) hash = hash_byte(hash_byte(hash, half[c][i] >> 8), half[c][i] & 0xff);
    for (size_t i = 0; i < sizeof pixels; i++) hash = hash_byte(hash, pixels[i]);
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
    fprintf(file, "%-52s %016" PRIx64 "\n", "packed", hash_packed(FACET_ARCH_SCALAR));
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
    else expect(committed_count == case_count() + 3, "%d rows for %d kernels, plans, packed and pixels",
                committed_count, case_count());
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
    test("%s packed", word);
    if (!find_case(PACKED_CASE)) skip("this build lacks " PACKED_CASE);
    else check_hash("packed", hash_packed(arch));
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
