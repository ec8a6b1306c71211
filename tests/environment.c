/* The caller's floating-point environment: whatever it is, results are the same bytes, nothing traps, and it is as
 * before when the call returns. */
#include "cases.h"
#include "golden.h"
#include "guarded.h"
#include "harness.h"
#include "samples.h"
#include "targets.h"

#include <float.h>
#include <inttypes.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* ---- The machine's control and status register ------------------------------------------------------------------- */

/* A setting replaces the bits of `field`. FLAGS: the sticky exception flags. */
typedef struct { const char *name; uint64_t field, value; } setting;

#if defined(__x86_64__) || defined(__SSE__)
#define FLAGS 0x3f
static const setting settings[] = {
    { "downward", 0x6000, 0x2000 },
    { "upward", 0x6000, 0x4000 },
    { "toward zero", 0x6000, 0x6000 },
    { "FTZ", 0x8000, 0x8000 },
    { "DAZ", 0x0040, 0x0040 },
    { "all traps", 0x1f80, 0 },
    { "FTZ, DAZ, upward", 0xe040, 0xc040 },
    { "all traps, FTZ, DAZ, toward zero", 0xffc0, 0xe040 },
};
static uint64_t read_register(void)
{
    uint32_t r;
    __asm__ volatile("stmxcsr %0" : "=m"(r) : : "memory");
    return r;
}
static void write_register(uint64_t value)
{
    const uint32_t r = (uint32_t)value;
    __asm__ volatile("ldmxcsr %0" : : "m"(r) : "memory");
}
#elif defined(__aarch64__)
/* FPCR below, FPSR above. */
#define FLAGS (UINT64_C(0x9f) << 32)
static const setting settings[] = {
    { "upward", 0xc00000, 0x400000 },
    { "downward", 0xc00000, 0x800000 },
    { "toward zero", 0xc00000, 0xc00000 },
    { "FZ", 0x1000000, 0x1000000 },
    { "default NaN", 0x2000000, 0x2000000 },
    { "inputs flushed (FIZ)", 0x1, 0x1 },
    { "alternate handling (AH)", 0x2, 0x2 },
    { "all traps", 0x9f00, 0x9f00 },
    { "FZ, default NaN, upward", 0x3c00000, 0x3400000 },
    { "all traps, FZ, toward zero", 0x1c09f00, 0x1c09f00 },
};
static uint64_t read_register(void)
{
    uint64_t control, status;
    __asm__ volatile("mrs %0, fpcr" : "=r"(control) : : "memory");
    __asm__ volatile("mrs %0, fpsr" : "=r"(status) : : "memory");
    return control | status << 32;
}
static void write_register(uint64_t value)
{
    __asm__ volatile("msr fpcr, %0" : : "r"(value & 0xffffffffu) : "memory");
    __asm__ volatile("msr fpsr, %0" : : "r"(value >> 32) : "memory");
}
#elif defined(__arm__) && defined(__ARM_FP)
#define FLAGS 0x9f
static const setting settings[] = {
    { "upward", 0xc00000, 0x400000 },
    { "downward", 0xc00000, 0x800000 },
    { "toward zero", 0xc00000, 0xc00000 },
    { "FZ", 0x1000000, 0x1000000 },
    { "default NaN", 0x2000000, 0x2000000 },
    { "all traps", 0x9f00, 0x9f00 },
    { "FZ, default NaN, upward", 0x3c00000, 0x3400000 },
    { "all traps, FZ, toward zero", 0x1c09f00, 0x1c09f00 },
};
static uint64_t read_register(void)
{
    uint32_t r;
    __asm__ volatile("vmrs %0, fpscr" : "=r"(r) : : "memory");
    return r;
}
static void write_register(uint64_t value)
{
    __asm__ volatile("vmsr fpscr, %0" : : "r"((uint32_t)value) : "memory");
}
#elif defined(__s390x__)
#define FLAGS 0xf80000
static const setting settings[] = {
    { "toward zero", 0x7, 0x1 },
    { "upward", 0x7, 0x2 },
    { "downward", 0x7, 0x3 },
    { "all traps", 0xf8000000, 0xf8000000 },
    { "all traps, upward", 0xf8000007, 0xf8000002 },
};
static uint64_t read_register(void)
{
    uint32_t r;
    __asm__ volatile("efpc %0" : "=d"(r) : : "memory");
    return r;
}
static void write_register(uint64_t value)
{
    __asm__ volatile("sfpc %0" : : "d"((uint32_t)value) : "memory");
}
#elif defined(__riscv) && defined(__riscv_flen)
#define FLAGS 0x1f
static const setting settings[] = {
    { "toward zero", 0xe0, 0x20 },
    { "downward", 0xe0, 0x40 },
    { "upward", 0xe0, 0x60 },
    { "to nearest, halves away from zero", 0xe0, 0x80 },
};
static uint64_t read_register(void)
{
    unsigned long r;
    __asm__ volatile("frcsr %0" : "=r"(r) : : "memory");
    return r;
}
static void write_register(uint64_t value)
{
    __asm__ volatile("fscsr %0" : : "r"((unsigned long)value) : "memory");
}
#else
#define FLAGS 0
static const setting settings[1];
static uint64_t read_register(void) { return 0; }
static void write_register(uint64_t value) { (void)value; }
#endif

enum { SETTINGS = sizeof settings / sizeof settings[0] };

/* ---- Calls under a setting --------------------------------------------------------------------------------------- */

typedef struct {
    const setting *under;
    uint64_t flags;              /* sticky flags that are set already */
    void (*call)(void *);
    void *argument;
    uint64_t before, after;
} excursion;

/* Between the writes no arithmetic but the call's. */
static __attribute__((noinline)) void run_under(void *argument)
{
    excursion *e = argument;
    const uint64_t own = read_register();
    write_register((own & ~(e->under->field | FLAGS)) | e->under->value | e->flags);
    e->before = read_register();
    e->call(e->argument);
    e->after = read_register();
    write_register(own);
}

/* NULL, or the fault. */
static const char *make_excursion(excursion *e)
{
    const uint64_t own = read_register();
    const char *fault = fault_of(run_under, e);
    write_register(own);
    return fault;
}

/* Sums, products and quotients that the settings change: rounded each way, halves, subnormal, from subnormals, a
 * NaN. */
typedef struct { float a, b; char operator; } arithmetic;

static const arithmetic probes[] = {
    { 1.0f, 0x1.8p-24f, '+' }, { -1.0f, -0x1.8p-24f, '+' }, { 1.0f, 0x1p-24f, '+' }, { FLT_MIN, 0.75f, '*' },
    { 0x5p-149f, 0x1p100f, '*' }, { __builtin_nanf("4660"), 1.0f, '+' }, { 1.0f, 0.0f, '/' }, { FLT_MAX, FLT_MAX, '*' },
};
enum { PROBES = sizeof probes / sizeof probes[0] };

static void run_probes(void *argument)
{
    float *out = argument;
    for (int i = 0; i < PROBES; i++) {
        const volatile float a = probes[i].a, b = probes[i].b;
        out[i] = probes[i].operator == '+' ? a + b : probes[i].operator == '*' ? a * b : a / b;
    }
}

static bool machine_obeys(const setting *s)
{
    float usual[PROBES] = { 0 }, here[PROBES] = { 0 };
    if (!s->field) return true;
    run_probes(usual);
    excursion e = { .under = s, .call = run_probes, .argument = here };
    return make_excursion(&e) || memcmp(usual, here, sizeof usual);
}

/* ---- What is called ---------------------------------------------------------------------------------------------- */

enum { COUNT = 83, TEXT = 1024 };

/* Everything of a material, a batch and its pixels. */
typedef struct {
    facet_material material;
    facet_target target;
    facet_plan plan;
    sample_batch samples;
    facet_light lights[4];
    size_t invalid;
    uint8_t pixels[4 * COUNT];
    char text[TEXT];
    facet_status plan_status, shade_status, encode_status;
} picture;

/* Where a material's parameters come from. */
enum { FROM_NUMBERS, FROM_STREAMS, FROM_SOURCES, ORIGINS };

static void call_plan(void *argument)
{
    picture *p = argument;
    p->plan_status = facet_plan_init(&p->plan, &p->material, p->target, NULL);
}

static void call_shade(void *argument)
{
    picture *p = argument;
    p->shade_status = facet_shade(&p->plan, &p->samples.batch, NULL);
}

static void call_encode(void *argument)
{
    picture *p = argument;
    const facet_image image = {
        .width = COUNT, .height = 1, .exposure = 0.3f, .pixels = p->pixels,
        .radiance = { p->samples.batch.radiance[0], p->samples.batch.radiance[1], p->samples.batch.radiance[2] },
        .opacity_from = FACET_OPACITY_STREAM, .opacity = p->samples.batch.albedo[0],
    };
    p->encode_status = facet_encode(&image, NULL);
}

static void call_describe(void *argument)
{
    picture *p = argument;
    facet_plan_describe(&p->plan, p->text, sizeof p->text);
}

static const struct { const char *name; void (*call)(void *); } calls[] = {
    { "facet_plan_init", call_plan },
    { "facet_shade", call_shade },
    { "facet_encode", call_encode },
};
enum { CALLS = sizeof calls / sizeof calls[0] };

static facet_material material_from(const kernel_case *k, int origin)
{
    facet_material m = k->material;
    m.streams = origin == FROM_STREAMS ? k->promised : 0;
    m.diffuse.sigma = k->sigma_max / 3;
    m.specular.alpha = 0.1f;
    m.specular.alpha_y = 0.3f;
    m.specular.exponent = 12.5f;
    m.fresnel.eta_outside = 1.1f;
    for (int c = 0; c < 3; c++) {
        m.diffuse.albedo[c] = c == 1 ? 0x1.1p-127f : 0.7f;
        m.fresnel.eta[c] = 1.5f + 0.1f * (float)c;
        m.fresnel.k[c] = 0.3f;
        m.emission[c] = c == 2 ? 0x1p-149f : 0;
    }
    if (origin != FROM_SOURCES) return m;
    m.convention.model = FACET_CONVENTION_METALLIC_ROUGHNESS;
    m.streams = k->promised | FACET_STREAM_BASE | FACET_STREAM_METALLIC | FACET_STREAM_ROUGHNESS
        | FACET_STREAM_SPECULAR_LEVEL;
    return m;
}

/* Subnormal, huge and ordinary numbers. */
static picture open_picture(const kernel_case *k, facet_target target, int origin)
{
    picture p = { .material = material_from(k, origin), .target = target };
    sample samples[COUNT];
    test_random r = { 11 };
    for (int i = 0; i < COUNT; i++) {
        samples[i] = golden_sample(&r, i % 2);
        if (i % 8 == 0) samples[i].irradiance[i / 8 % 3] = 0x1.5p-130f;
        if (i % 8 == 4) samples[i].albedo[i / 8 % 3] = 0x1.7p-128f;
    }
    p.samples = batch_of(samples, COUNT);
    facet_batch *b = &p.samples.batch;
    for (int c = 0; c < 3; c++) {
        b->ambient[c] = 0x1.3p-126f;
        b->sh[0][c] = 0.3f;
        b->sh[1 + c][c] = c ? -0.4f : 0x1.1p-140f;
        b->base[c] = b->albedo[c];
    }
    b->occlusion = b->metallic = b->f0[0];
    b->specular_level = b->f0[1];
    b->roughness = b->alpha;
    p.lights[0] = b->lights[0];
    p.lights[1] = (facet_light){ .direction = { 0.6f, -0.48f, 0.64f }, .irradiance = { 0.7f, 0x1p-140f, 3.1f } };
    p.lights[2] = (facet_light){ .kind = FACET_LIGHT_POINT, .irradiance = { 0x1p-140f, 1e30f, 2.5f },
                                 .position = { 0.3f, 1.7f, -0.9f }, .range = 3.3f };
    p.lights[3] = (facet_light){ .kind = FACET_LIGHT_SPOT, .irradiance = { 5, 0.1f, 0.2f },
                                 .position = { -0.3f, 0, 0x1p-130f }, .axis = { 0.48f, 0.6f, 0.64f },
                                 .cos_inner = 0.9f, .cos_outer = 0.1f };
    return p;
}

/* The pointers into the picture itself, which was returned by value. */
static void connect(picture *p)
{
    p->samples.batch.lights = p->lights;
    p->samples.batch.light_count = sizeof p->lights / sizeof p->lights[0];
    p->samples.batch.invalid = &p->invalid;
}

static bool same_results(const picture *a, const picture *b)
{
    bool same = a->plan_status == b->plan_status && a->shade_status == b->shade_status
        && a->encode_status == b->encode_status && a->invalid == b->invalid
        && !memcmp(&a->plan, &b->plan, sizeof a->plan) && !memcmp(a->pixels, b->pixels, sizeof a->pixels);
    for (int c = 0; c < 3; c++)
        same = same && !memcmp(a->samples.batch.radiance[c], b->samples.batch.radiance[c], COUNT * sizeof(float));
    return same;
}

/* ---- Tests ------------------------------------------------------------------------------------------------------- */

/* A call under a setting, with sticky flags set or none. */
static void check_call(const char *name, void (*call)(void *), void *argument, const setting *s, uint64_t flags)
{
    excursion e = { .under = s, .flags = flags, .call = call, .argument = argument };
    const char *fault = make_excursion(&e);
    expect(!fault, "%s: %s", name, fault);
    expect(fault || e.before == e.after, "%s leaves %08" PRIx64 " where it found %08" PRIx64, name, e.after, e.before);
}

static const uint64_t stickies[] = { 0, FLAGS };
enum { STICKIES = sizeof stickies / sizeof stickies[0] };

static void check_picture(const kernel_case *k, facet_target target, int origin, const setting *s)
{
    picture usual = open_picture(k, target, origin);
    connect(&usual);
    for (int i = 0; i < CALLS; i++) calls[i].call(&usual);
    expect(!usual.plan_status && !usual.shade_status && !usual.encode_status, "%s: refused", k->name);

    for (int f = 0; f < STICKIES; f++) {
        picture here = open_picture(k, target, origin);
        connect(&here);
        for (int i = 0; i < CALLS; i++) check_call(calls[i].name, calls[i].call, &here, s, stickies[f]);
        expect(same_results(&usual, &here), "%s: other bytes", k->name);
        free_batch(&here.samples);
    }
    free_batch(&usual.samples);
}

/* One that formats numbers. */
static void check_description(const setting *s)
{
    const kernel_case *k = case_at(case_count() - 1);
    picture p = open_picture(k, target_at(0), FROM_NUMBERS);
    char usual[TEXT];
    test("%s: facet_plan_describe", s->name);
    call_plan(&p);
    call_describe(&p);
    memcpy(usual, p.text, sizeof usual);
    for (int f = 0; f < STICKIES; f++) {
        memset(p.text, 0, sizeof p.text);
        check_call("facet_plan_describe", call_describe, &p, s, stickies[f]);
        expect(!strcmp(usual, p.text), "other text: %.60s", p.text);
    }
    free_batch(&p.samples);
}

/* Conversions and indices, of numbers that the settings round otherwise, flush, or trap at. */
typedef struct {
    float a, b, c;
    float single[6], index[12];
    facet_specular_glossiness glossy;
    facet_metallic_roughness rough;
} conversion;

static void call_single(void *argument)
{
    conversion *k = argument;
    k->single[0] = facet_f0_from_eta(k->a, k->b, k->c);
    k->single[1] = facet_eta_from_f0(k->a);
    k->single[2] = facet_alpha_from_roughness(k->a);
    k->single[3] = facet_roughness_from_alpha(k->a);
    k->single[4] = facet_exponent_from_alpha(k->a);
    k->single[5] = facet_alpha_from_exponent(k->b);
}

static void call_conventions(void *argument)
{
    conversion *k = argument;
    const facet_metallic_roughness rough = { { k->a, k->b, k->c }, k->b, k->a, k->c };
    const facet_specular_glossiness glossy = { { k->c, k->a, k->b }, { k->a, k->b, k->c }, k->a };
    k->glossy = facet_to_specular_glossiness(rough);
    k->rough = facet_to_metallic_roughness(glossy);
}

static void call_indices(void *argument)
{
    static const float wavelength[] = { 400.1f, 480.3f, 555.7f, 660.9f, 750.3f };
    conversion *k = argument;
    const float n[] = { 0.1f, 0x1p-140f, 1.3f, 1e30f, 2.7f }, extinction[] = { 0.3f, 2.9f, 0x1p-149f, 0.7f, 1e-38f };
    facet_index_of_spectrum(wavelength, n, extinction, 5, k->index, k->index + 3, NULL);
    facet_index_of_metal(FACET_METAL_GOLD, k->index + 6, k->index + 9);
}

static void check_conversions(const setting *s)
{
    static const struct { const char *name; void (*call)(void *); } of[] = {
        { "a number", call_single }, { "a convention", call_conventions }, { "an index", call_indices },
    };
    static const conversion values[] = {
        { .a = 0.3f, .b = 0.7f, .c = 0.9f }, { .a = 0x1p-140f, .b = 0.1f, .c = 0x1.3p-126f },
        { .a = 1e30f, .b = NAN, .c = 0.6f }, { .a = 1, .b = 0, .c = INFINITY },
    };
    test("%s: conversions", s->name);
    for (size_t i = 0; i < sizeof values / sizeof values[0]; i++)
        for (size_t k = 0; k < sizeof of / sizeof of[0]; k++)
            for (int f = 0; f < STICKIES; f++) {
                conversion usual = values[i], here = values[i];
                of[k].call(&usual);
                check_call(of[k].name, of[k].call, &here, s, stickies[f]);
                expect(!memcmp(&usual, &here, sizeof usual), "%s: other bytes of %g, %g, %g", of[k].name,
                       (double)values[i].a, (double)values[i].b, (double)values[i].c);
            }
}

static void check_target(facet_target target, const setting *s)
{
    for (int i = 0; i < case_count(); i++)
        for (int origin = 0; origin < ORIGINS; origin++)
            if (!test_slow_machine || origin == i % ORIGINS) check_picture(case_at(i), target, origin, s);
}

/* Where the machine ignores it, one test that may fail but does not pass. */
static void check_setting(const setting *s)
{
    const bool obeyed = machine_obeys(s);
    if (!obeyed) {
        test("%s", s->name);
        skip("this machine computes as usual under it");
    } else {
        check_description(s);
        check_conversions(s);
    }
    for (int i = 0; i < target_count(); i++) {
        if (obeyed) test("%s: %s", s->name, target_words(target_at(i)));
        check_target(target_at(i), s);
    }
}

void suite_environment(void)
{
    static const setting usual = { "the usual environment", 0, 0 };
    if (!settings[0].name) {
        test("rounding modes, flushed subnormals, traps");
        skip("no register of this machine is known here");
        return;
    }
    check_setting(&usual);
    for (int i = 0; i < SETTINGS; i++) check_setting(&settings[i]);
    skip_absent_targets();
}
