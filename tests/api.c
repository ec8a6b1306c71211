/* The public functions beside shading itself: words, plans as bytes, descriptions, threads, passes of lights. */
#include "api.h"

#include "cases.h"
#include "errors.h"
#include "guarded.h"
#include "harness.h"
#include "targets.h"

#include <limits.h>
#include <math.h>
#include <pthread.h>
#include <stdio.h>
#include <string.h>
#include <time.h>

_Static_assert(sizeof(facet_plan) == 512, "what callers keep in flash and in files");

/* ---- Words ------------------------------------------------------------------------------------------------------- */

static void test_words(void)
{
    static const struct { facet_kind kind; int last; const char *word; } lasts[] = {
        { FACET_KIND_DIFFUSE, FACET_DIFFUSE_EON, "eon" },
        { FACET_KIND_DISTRIBUTION, FACET_DISTRIBUTION_BLINN_PHONG_NORMALISED, "blinn-phong-normalised" },
        { FACET_KIND_MASKING, FACET_MASKING_HAMMON, "hammon" },
        { FACET_KIND_FRESNEL, FACET_FRESNEL_CONDUCTOR, "conductor" },
        { FACET_KIND_CONVENTION, FACET_CONVENTION_SPECULAR_GLOSSINESS, "specular-glossiness" },
        { FACET_KIND_LIGHT, FACET_LIGHT_SPOT, "spot" },
        { FACET_KIND_METAL, FACET_METAL_TUNGSTEN, "tungsten" },
        { FACET_KIND_ARCH, FACET_ARCH_NEON, "neon" },
        { FACET_KIND_TIER, FACET_TIER_STRICT, "strict" },
        { FACET_KIND_STATUS, FACET_ERROR_SIZE, "a struct of a newer header uses what this library does not know" },
    };
    test("every enumerator has a word, and every word its enumerator");
    for (size_t i = 0; i < sizeof lasts / sizeof lasts[0]; i++) {
        const facet_kind kind = lasts[i].kind;
        int value = 0;
        for (const char *word; (word = facet_word(kind, value)); value++)
            expect(facet_value(kind, word) == value, "'%s' is %d, not %d", word, facet_value(kind, word), value);
        expect(value == lasts[i].last + 1, "kind %d has %d words", (int)kind, value);
        const char *last = facet_word(kind, lasts[i].last);
        expect(last && !strcmp(last, lasts[i].word), "%d of kind %d is '%s'", lasts[i].last, (int)kind,
               last ? last : "NULL");
        expect(!facet_word(kind, -1) && !facet_word(kind, INT_MAX) && !facet_word(kind, INT_MIN), "a word for nothing");
        expect(!facet_has(kind, value) && !facet_has(kind, -1) && !facet_has(kind, INT_MIN), "has what has no word");
        expect(facet_value(kind, "no-such-word") == -1 && facet_value(kind, "") == -1 && facet_value(kind, NULL) == -1,
               "kind %d: a value for no word", (int)kind);
    }
    test("unknown kinds have no words");
    for (int kind = FACET_KIND_STATUS + 1; kind < FACET_KIND_STATUS + 300; kind++)
        expect(!facet_word((facet_kind)kind, 0) && !facet_has((facet_kind)kind, 0)
               && facet_value((facet_kind)kind, "none") == -1, "kind %d", kind);
    expect(!facet_word((facet_kind)-1, 0) && !facet_has((facet_kind)-1, 0), "kind -1");
}

static void test_build(void)
{
    char version[32];
    snprintf(version, sizeof version, "%d.%d.%d", FACET_VERSION_MAJOR, FACET_VERSION_MINOR, FACET_VERSION_PATCH);
    test("version, best architecture, lanes");
    expect(!strcmp(facet_version(), version), "facet_version is %s, the header's is %s", facet_version(), version);
    const facet_arch best = facet_arch_best();
    expect(best != FACET_ARCH_BEST && facet_has(FACET_KIND_ARCH, (int)best), "the best architecture is not there");
    expect(facet_has(FACET_KIND_ARCH, FACET_ARCH_BEST) && facet_has(FACET_KIND_ARCH, FACET_ARCH_SCALAR), "no scalar");
    for (int arch = FACET_ARCH_SCALAR; facet_word(FACET_KIND_ARCH, arch); arch++) {
        const int lanes = facet_arch_lanes((facet_arch)arch);
        expect(lanes == 0 || lanes == 1 || lanes == 4 || lanes == 8 || lanes == 16, "%d lanes", lanes);
        expect(lanes > 0 || !facet_has(FACET_KIND_ARCH, arch), "'%s' without lanes", facet_word(FACET_KIND_ARCH, arch));
        expect(lanes <= facet_arch_lanes(best) || !facet_has(FACET_KIND_ARCH, arch), "wider than the best");
    }
    expect(facet_arch_lanes((facet_arch)99) == 0 && facet_arch_lanes((facet_arch)-1) == 0, "lanes of no architecture");
}

/* ---- Plans ------------------------------------------------------------------------------------------------------- */

/* The rich material's numbers with a kernel's models. */
static facet_material rich_material_of(const kernel_case *k)
{
    facet_material m = rich_material();
    m.diffuse.model = k->material.diffuse.model;
    m.diffuse.sigma = k->sigma_max / 2;
    m.specular.model = k->material.specular.model;
    m.specular.masking = k->material.specular.masking;
    m.fresnel.model = k->material.fresnel.model;
    m.coupled = k->material.coupled;
    return m;
}

static void test_plan_bytes(void)
{
    test("plans of the same material are the same bytes, wherever they stand");
    sample_batch a = random_batch(100, 1), b = random_batch(100, 1);
    for (int i = 0; i < case_count(); i++) {
        facet_plan plans[2], moved[3];
        facet_material m = rich_material_of(case_at(i));
        memset(&plans[0], 0x5a, sizeof plans[0]);
        memset(&plans[1], 0xa5, sizeof plans[1]);
        for (int k = 0; k < 2; k++) expect(facet_plan_init(&plans[k], &m, strict_scalar, NULL) == FACET_OK, "refused");
        expect(!memcmp(&plans[0], &plans[1], sizeof plans[0]), "%s: plans differ", case_at(i)->name);
        memcpy(&moved[1], &plans[0], sizeof plans[0]);
        memset(&plans[0], 0, sizeof plans[0]);
        facet_shade(&plans[1], &a.batch, NULL);
        expect(facet_shade(&moved[1], &b.batch, NULL) == FACET_OK && same_radiance(&a.batch, &b.batch),
               "%s: a copy shades otherwise", case_at(i)->name);
    }
    free_batch(&a);
    free_batch(&b);

    test("a plan tells its target");
    const facet_material m = rich_material();
    for (int arch = FACET_ARCH_BEST; facet_word(FACET_KIND_ARCH, arch); arch++)
        for (int tier = 0; facet_word(FACET_KIND_TIER, tier); tier++) {
            facet_plan plan;
            const facet_target asked = { .arch = (facet_arch)arch, .tier = (facet_tier)tier };
            if (facet_plan_init(&plan, &m, asked, NULL)) continue;
            const facet_target target = facet_plan_target(&plan);
            const facet_arch want = arch == FACET_ARCH_BEST ? facet_arch_best() : (facet_arch)arch;
            expect(target.arch == want && target.tier == (facet_tier)tier, "%d %d is %d %d", arch, tier,
                   (int)target.arch, (int)target.tier);
        }
}

/* The one of these bits that is later in the list of architectures: they are listed slowest first. */
static facet_arch last_of(uint32_t arches)
{
    int last = FACET_ARCH_BEST;
    for (int arch = FACET_ARCH_SCALAR; facet_word(FACET_KIND_ARCH, arch); arch++)
        if (arches >> arch & 1) last = arch;
    return (facet_arch)last;
}

/* Plans for the architectures of `arches`, one by one and the best, as the bits say. */
static void check_arches(const facet_material *m, uint32_t arches)
{
    for (int arch = FACET_ARCH_BEST; facet_word(FACET_KIND_ARCH, arch); arch++) {
        const facet_arch want = arch == FACET_ARCH_BEST ? last_of(arches) : (facet_arch)arch;
        const bool held = want != FACET_ARCH_BEST && facet_arch_lanes(want) && arches >> want & 1;
        facet_plan plan;
        facet_error error;
        facet_plan_init(&plan, m, (facet_target){ .arch = (facet_arch)arch, .arches = arches }, &error);
        expect(held ? !error.code : is_error(&error, FACET_ERROR_ARCH, "target.arch", -1),
               "%d of %x: status %d", arch, (unsigned)arches, (int)error.code);
        expect(!held || facet_plan_target(&plan).arch == want, "%d of %x is %d", arch, (unsigned)arches,
               (int)facet_plan_target(&plan).arch);
    }
}

static void test_arches(void)
{
    const facet_material m = rich_material();
    const uint32_t arches = facet_arches();
    uint32_t built = 0;
    test("facet_arches has a bit for what facet_has");
    for (int arch = FACET_ARCH_BEST; arch < 32; arch++) {
        const bool has = arch != FACET_ARCH_BEST && facet_has(FACET_KIND_ARCH, arch);
        expect((arches >> arch & 1) == has, "bit %d of %x", arch, (unsigned)arches);
        if (facet_arch_lanes((facet_arch)arch)) built |= 1u << arch;
    }
    expect(last_of(arches) == facet_arch_best(), "the best of %x is %d", (unsigned)arches, (int)facet_arch_best());

    test("a plan takes what target.arches says, for another CPU too, instead of asking this one");
    for (uint32_t among = 2; among < 1u << (FACET_ARCH_NEON + 1); among += 2)
        if (!(among & ~built)) check_arches(&m, among);
    check_arches(&m, ~built & ((2u << FACET_ARCH_NEON) - 2));
    const facet_plan asked = make_plan(&m, (facet_target){ 0 });
    const facet_plan told = make_plan(&m, (facet_target){ .arches = arches });
    expect(!memcmp(&asked, &told, sizeof asked), "another plan");
}

static double seconds(void)
{
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

/* The quickest of some plans: a machine with other work disturbs the rest. */
static double plan_seconds(const facet_material *m, facet_target target)
{
    double least = 1;
    for (int i = 0; i < 200; i++) {
        facet_plan plan;
        const double start = seconds();
        facet_plan_init(&plan, m, target, NULL);
        const double taken = seconds() - start;
        least = taken < least ? taken : least;
    }
    return least;
}

/* Whether the fast tier fits the material's Fresnel term. */
static bool is_exact(const facet_material *m)
{
    return m->fresnel.model == FACET_FRESNEL_DIELECTRIC || m->fresnel.model == FACET_FRESNEL_CONDUCTOR;
}

static void test_plan_time(void)
{
    test("a plan takes at most 20 us where the CPU is not asked and nothing is fitted");
    if (test_slow_machine) {
        skip("an emulator or a sanitizer");
        return;
    }
    for (int i = 0; i < target_count(); i++)
        for (int k = 0; k < case_count(); k++) {
            const facet_material m = rich_material_of(case_at(k));
            const facet_target target = target_at(i);
            if (target.tier == FACET_TIER_FAST && is_exact(&m)) continue;
            const double taken = plan_seconds(&m, target);
            expect(taken <= 20e-6, "%s, %s: %.1f us", case_at(k)->name, target_words(target), 1e6 * taken);
        }
}

typedef struct { facet_plan plan; facet_batch *batch; facet_status status; size_t described; char text[1024]; } attempt;

static void attempt_plan(void *argument)
{
    attempt *a = argument;
    a->described = facet_plan_describe(&a->plan, a->text, sizeof a->text);
    a->status = facet_shade(&a->plan, a->batch, NULL);
}

static void test_foreign_plans(void)
{
    test_random r = { 2 };
    sample_batch b = random_batch(20, 2);
    attempt a = { .batch = &b.batch };
    const facet_material m = rich_material();
    const facet_plan good = make_plan(&m, strict_scalar);

    test("zeros, ones and random bytes are no plan");
    for (int i = 0; i < 1000; i++) {
        for (size_t k = 0; k < sizeof a.plan.opaque / sizeof a.plan.opaque[0]; k++)
            a.plan.opaque[k] = i == 0 ? 0 : i == 1 ? UINT64_MAX : random_u64(&r);
        const char *fault = fault_of(attempt_plan, &a);
        expect(!fault, "%s", fault);
        expect(a.status == FACET_ERROR_PLAN && a.described == 0, "status %d, %zu bytes described", (int)a.status,
               a.described);
    }

    test("cut short or with a byte changed, a plan does no harm");
    const char *fault = NULL;
    for (size_t at = 0; at < sizeof good && !fault; at++)
        for (int i = 0; i < 17 && !fault; i++) {
            a.plan = good;
            if (i == 16) memset((char *)&a.plan + at, 0, sizeof good - at);
            else ((unsigned char *)&a.plan)[at] = (unsigned char)(i < 8 ? random_u64(&r) : 1u << (i - 8) | 0x80u);
            const facet_arch arch = facet_plan_target(&a.plan).arch;
            if (facet_arch_lanes(arch) && !facet_has(FACET_KIND_ARCH, (int)arch)) continue;
            fault = fault_of(attempt_plan, &a);
            expect(!fault, "byte %zu: %s", at, fault);
            expect(a.status == FACET_OK || a.status == FACET_ERROR_PLAN || a.status == FACET_ERROR_NULL,
                   "byte %zu: status %d", at, (int)a.status);
        }
    free_batch(&b);
}

/* ---- Descriptions ------------------------------------------------------------------------------------------------ */

typedef size_t describer(const void *what, char *text, size_t size);

static size_t describe_plan(const void *plan, char *text, size_t size) { return facet_plan_describe(plan, text, size); }
static size_t describe_error(const void *e, char *text, size_t size) { return facet_error_describe(e, text, size); }

/* As snprintf: the whole length whatever the size, nothing written beyond it, a final 0 unless there is no room. */
static void check_describe(describer *describe, const void *what, const char *begins)
{
    char whole[1024], part[1024], untouched[1024];
    const size_t length = describe(what, whole, sizeof whole);
    if (!expect(length > 0 && length < sizeof whole && strlen(whole) == length, "%zu bytes", length)) return;
    expect(!strncmp(whole, begins, strlen(begins)), "begins with '%.40s'", whole);
    expect(describe(what, NULL, 0) == length, "another length without room");
    memset(untouched, 0x7f, sizeof untouched);
    for (size_t size = 0; size <= length + 2; size++) {
        const size_t kept = size == 0 ? 0 : size <= length ? size - 1 : length;
        memset(part, 0x7f, sizeof part);
        expect(describe(what, part, size) == length, "another length with room for %zu", size);
        expect(!memcmp(part, whole, kept) && (size == 0 || part[kept] == 0), "other text in %zu bytes", size);
        expect(!memcmp(part + size, untouched, sizeof part - size), "overruns %zu bytes", size);
    }
}

static void check_description(const kernel_case *k, facet_convention convention, uint32_t streams)
{
    facet_material m = rich_material_of(k);
    m.convention.model = convention;
    m.streams = streams;
    if (streams & FACET_STREAM_F0) memset(m.fresnel.f0, 0, sizeof m.fresnel.f0);
    const facet_plan plan = make_plan(&m, strict_scalar);
    check_describe(describe_plan, &plan, "kernel: f32 scalar strict");
}

static void test_descriptions(void)
{
    test("plans in words, at every size");
    for (int i = 0; i < case_count(); i++) {
        const facet_convention convention = (facet_convention)(i % 3);
        check_description(case_at(i), convention, 0);
        check_description(case_at(i), convention, MATERIAL_STREAMS);
        for (uint32_t bit = 1; bit <= MATERIAL_STREAMS; bit <<= 1)
            if (bit & MATERIAL_STREAMS) check_description(case_at(i), convention, bit);
    }
    const facet_plan none = { { 0 } };
    char text[8];
    expect(facet_plan_describe(&none, text, sizeof text) == 0, "a plan of zeros is described");
    expect(facet_plan_describe(NULL, NULL, 0) == 0, "NULL is described");

    test("errors in words, at every size");
    static const struct { facet_error error; const char *words; } errors[] = {
        { { FACET_OK, NULL, -1 }, "no error" },
        { { FACET_ERROR_VALUE, "light.irradiance", 3 },
          "light.irradiance[3]: a number is NaN, infinite or outside its domain" },
        { { FACET_ERROR_NULL, "plan", -1 }, "plan: a pointer that is needed is NULL" },
        { { FACET_ERROR_VALUE, "light.direction", INT_MAX }, "light.direction[2147483647]: a number" },
        { { FACET_ERROR_VALUE, "light.direction", INT_MIN }, "light.direction: a number" },
        { { (facet_status)99, "field", 0 }, "field[0]: " },
    };
    for (size_t i = 0; i < sizeof errors / sizeof errors[0]; i++)
        check_describe(describe_error, &errors[i].error, errors[i].words);
}

/* ---- Passes of lights -------------------------------------------------------------------------------------------- */

enum { LIGHTS = 70, SHADED = 67 };

/* All lights at once against a call for each, adding: in array order, so that strict results are the same bytes. */
static void check_lights(size_t count, facet_target target)
{
    static facet_light lights[LIGHTS];
    sample_batch at_once = random_batch(SHADED, 5), one_by_one = random_batch(SHADED, 5);
    test_random r = { 6 };
    facet_material m = rich_material();
    memset(m.emission, 0, sizeof m.emission);
    const facet_plan plan = make_plan(&m, target);
    for (int c = 0; c < 3; c++) at_once.batch.position[c] = one_by_one.batch.position[c] = at_once.batch.f0[c];
    for (size_t i = 0; i < count; i++) {
        const sample s = random_sample(&r, SAMPLES_UNIFORM, 0.1f, 1);
        lights[i] = (facet_light){ .kind = (facet_light_kind)(i % 3), .direction = { s.l[0], s.l[1], s.l[2] },
                                   .irradiance = { 1, 2, (float)i + 1 },
                                   .position = { 3 * s.n[0], 3 * s.n[1], 3 * s.n[2] }, .range = i % 2 ? 5 : 0,
                                   .axis = { -s.n[0], -s.n[1], -s.n[2] }, .cos_inner = 0.5f, .cos_outer = -0.5f };
    }
    at_once.batch.lights = lights;
    at_once.batch.light_count = count;
    expect(facet_shade(&plan, &at_once.batch, NULL) == FACET_OK, "refused");
    for (size_t i = 0; i < count; i++) {
        one_by_one.batch.lights = &lights[i];
        one_by_one.batch.light_count = 1;
        one_by_one.batch.flags = i > 0 ? FACET_ACCUMULATE : 0;
        expect(facet_shade(&plan, &one_by_one.batch, NULL) == FACET_OK, "refused");
    }
    for (int c = 0; c < 3; c++)
        for (int i = 0; i < SHADED; i++) {
            const double got = (double)at_once.batch.radiance[c][i], want = (double)one_by_one.batch.radiance[c][i];
            const double room = target.tier == FACET_TIER_STRICT ? 0 : 0x1p-24 * (double)(2 * count) * want;
            expect(got - want <= room && want - got <= room, "sample %d: %a, and %a in %zu calls", i, got, want, count);
        }
    free_batch(&at_once);
    free_batch(&one_by_one);
}

static void test_lights_in_passes(void)
{
    for (int i = 0; i < target_count(); i++) {
        test("%s: 2, 3 and %d lights in one call as in a call each", target_words(target_at(i)), LIGHTS);
        check_lights(2, target_at(i));
        check_lights(3, target_at(i));
        check_lights(LIGHTS, target_at(i));
    }
    skip_absent_targets();
}

/* A promised stream that the models do not read: whatever it holds, samples are as they would be without it. */
static void test_unread_streams(void)
{
    enum { COUNT = 67 };
    static const float odd[] = { NAN, -1, 0.5f, INFINITY, 2, 0 };
    float unread[COUNT], one[COUNT], zero[COUNT] = { 0 }, radiance[3][COUNT];
    for (int i = 0; i < COUNT; i++) unread[i] = odd[i % 6], one[i] = 1;
    const facet_material glow = { .emission = { 1, 2, 3 }, .streams = MATERIAL_STREAMS };
    for (int i = 0; i < target_count(); i++) {
        test("streams that no model reads change nothing, %s", target_words(target_at(i)));
        facet_plan plan;
        size_t invalid = 0;
        expect(facet_plan_init(&plan, &glow, target_at(i), NULL) == FACET_OK, "no plan");
        facet_batch b = {
            .count = COUNT, .ambient = { 3, 3, 3 }, .radiance = { radiance[0], radiance[1], radiance[2] },
            .invalid = &invalid,
        };
#define COMPONENTS_1(field) &b.field
#define COMPONENTS_3(field) b.field
#define FACET_STREAM(id, field, components, ...)                                                                      \
        for (int c = 0; c < components; c++) (COMPONENTS_##components(field))[c] = unread;
#include "streams.def"
        b.normal[0] = b.normal[1] = zero, b.normal[2] = b.occlusion = one;
        memset(b.view, 0, sizeof b.view);
        expect(facet_shade(&plan, &b, NULL) == FACET_OK && invalid == 0, "%zu are invalid", invalid);
        for (int k = 0; k < 3 * COUNT; k++)
            expect(radiance[k / COUNT][k % COUNT] == glow.emission[k / COUNT], "sample %d is %a", k % COUNT,
                   (double)radiance[k / COUNT][k % COUNT]);
    }
}

static void test_empty(void)
{
    sample_batch b = random_batch(8, 7);
    const facet_material m = rich_material();
    const facet_plan plan = make_plan(&m, (facet_target){ 0 });
    size_t invalid = 5;
    test("a batch of no samples writes nothing");
    for (int c = 0; c < 3; c++) memset(b.batch.radiance[c], 0xa5, 8 * sizeof(float));
    b.batch.count = 0;
    b.batch.invalid = &invalid;
    expect(facet_shade(&plan, &b.batch, NULL) == FACET_OK && invalid == 5, "refused or counted");
    for (int c = 0; c < 3; c++)
        for (int i = 0; i < 8 * (int)sizeof(float); i++)
            expect(((unsigned char *)b.batch.radiance[c])[i] == 0xa5, "written");
    free_batch(&b);
}

/* ---- Threads ----------------------------------------------------------------------------------------------------- */

enum { THREADS = 8, THREAD_SAMPLES = 301 };

typedef struct {
    const facet_plan *plan;
    const facet_material *material;
    const facet_batch *want;
    facet_batch batch;           /* its own radiance, and shared or its own streams */
    float radiance[3][THREAD_SAMPLES];
    bool same;
} thread_job;

static void *run_thread(void *argument)
{
    thread_job *job = argument;
    job->same = true;
    for (int round = 0; round < 50; round++) {
        facet_plan own;
        memset(job->radiance, 0, sizeof job->radiance);
        const facet_target target = facet_plan_target(job->plan);
        job->same = job->same && facet_plan_init(&own, job->material, target, NULL) == FACET_OK
            && !memcmp(&own, job->plan, sizeof own) && facet_shade(job->plan, &job->batch, NULL) == FACET_OK
            && same_radiance(&job->batch, job->want);
    }
    return NULL;
}

static void check_threads(bool shared)
{
    static thread_job jobs[THREADS];
    pthread_t threads[THREADS];
    sample_batch batches[THREADS];
    facet_material m = rich_material();
    m.streams = MATERIAL_STREAMS;
    const facet_plan plan = make_plan(&m, (facet_target){ 0 });
    for (int i = 0; i < THREADS; i++) {
        batches[i] = random_batch(THREAD_SAMPLES, shared ? 8 : 8 + (uint64_t)i);
        facet_shade(&plan, &batches[i].batch, NULL);
        jobs[i] = (thread_job){ .plan = &plan, .material = &m, .want = &batches[i].batch,
                                .batch = batches[shared ? 0 : i].batch };
        for (int c = 0; c < 3; c++) jobs[i].batch.radiance[c] = jobs[i].radiance[c];
    }
    int started = 0;
    while (started < THREADS && !pthread_create(&threads[started], NULL, run_thread, &jobs[started])) started++;
    expect(started == THREADS, "only %d threads", started);
    for (int i = 0; i < started; i++) {
        pthread_join(threads[i], NULL);
        expect(jobs[i].same, "thread %d: other bytes", i);
    }
    for (int i = 0; i < THREADS; i++) free_batch(&batches[i]);
}

void suite_api(void)
{
    test_words();
    test_build();
    test_refused_plans();
    test_refused_batches();
    test_plan_bytes();
    test_arches();
    test_plan_time();
    test_foreign_plans();
    test_descriptions();
    test_sizes();
    test_lights_in_passes();
    test_unread_streams();
    test_empty();
    test("one plan in %d threads at once, the same batch", THREADS);
    check_threads(true);
    test("one plan in %d threads at once, batches of their own", THREADS);
    check_threads(false);
}
