/* facet-bench: times the library's kernels and the baselines on one tile, interleaved in one process. */
#include "facet.h"
#include "tile.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

enum { COUNT = 256, STREAMS = 17, ROUNDS = 200, MAX_CONTENDERS = 32 };

typedef struct {
    char name[32];
    tile_shader *baseline;       /* NULL: the library's plan */
    facet_plan plan;
    double seconds[ROUNDS];      /* a call, by round */
    double error;                /* worst relative, against the textbook's function in double */
} contender;

static _Alignas(64) float streams[STREAMS][COUNT + 64];
static contender contenders[MAX_CONTENDERS];
static int contender_count;

static double now(void)
{
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

static double random_unit(void)
{
    static uint64_t state = 1;
    state = state * 6364136223846793005u + 1442695040888963407u;
    return (double)(state >> 11) * 0x1p-53;
}

/* A unit vector within the cone around z whose least cosine is given. */
static void random_direction(double least_cosine, float *x, float *y, float *z)
{
    double cosine = least_cosine + (1.0 - least_cosine) * random_unit(), phi = 6.283185307179586 * random_unit();
    double sine = sqrt(1.0 - cosine * cosine);
    *x = (float)(sine * cos(phi)), *y = (float)(sine * sin(phi)), *z = (float)cosine;
}

static tile make_tile(void)
{
    float (*s)[COUNT + 64] = streams;
    tile t = { .count = COUNT, .normal = { s[0], s[1], s[2] }, .view = { s[3], s[4], s[5] },
               .albedo = { s[6], s[7], s[8] }, .sigma = s[9], .alpha = s[10], .f0 = { s[11], s[12], s[13] },
               .radiance = { s[14], s[15], s[16] },
               .light = { 0.36f, 0.48f, 0.8f }, .irradiance = { 3.0f, 2.5f, 2.0f } };
    for (int i = 0; i < COUNT; i++) {
        random_direction(0.7, &s[0][i], &s[1][i], &s[2][i]);
        random_direction(0.7, &s[3][i], &s[4][i], &s[5][i]);
        for (int k = 6; k < 14; k++) s[k][i] = (float)(0.02 + 0.96 * random_unit());
    }
    return t;
}

static void add_baseline(const char *name, tile_shader *shader)
{
    contender *c = &contenders[contender_count++];
    snprintf(c->name, sizeof c->name, "%s", name);
    c->baseline = shader;
}

static void add_library(void)
{
    const facet_material material = {
        .diffuse = { .model = FACET_DIFFUSE_OREN_NAYAR }, .specular = { .model = FACET_DISTRIBUTION_GGX },
        .streams = FACET_STREAM_ALBEDO | FACET_STREAM_SIGMA | FACET_STREAM_ALPHA | FACET_STREAM_F0
    };
    for (int tier = 0; facet_word(FACET_KIND_TIER, tier); tier++)
        for (int arch = 1; facet_word(FACET_KIND_ARCH, arch); arch++) {
            contender *c = &contenders[contender_count];
            const facet_target target = { .arch = (facet_arch)arch, .tier = (facet_tier)tier };
            if (facet_plan_init(&c->plan, &material, target, NULL)) continue;
            snprintf(c->name, sizeof c->name, "facet %s %s", facet_word(FACET_KIND_ARCH, arch),
                     facet_word(FACET_KIND_TIER, tier));
            contender_count++;
        }
}

static void shade(const contender *c, const tile *t)
{
    if (c->baseline) {
        c->baseline(t);
        return;
    }
    facet_light light = { .direction = { t->light[0], t->light[1], t->light[2] },
                          .irradiance = { t->irradiance[0], t->irradiance[1], t->irradiance[2] } };
    facet_batch batch = { .count = t->count, .sigma = t->sigma, .alpha = t->alpha, .lights = &light, .light_count = 1 };
    for (int k = 0; k < 3; k++) {
        batch.normal[k] = t->normal[k], batch.view[k] = t->view[k];
        batch.albedo[k] = t->albedo[k], batch.f0[k] = t->f0[k], batch.radiance[k] = t->radiance[k];
    }
    facet_shade(&c->plan, &batch, NULL);
}

/* Every contender computes the same function: how far is each from the first, the textbook? */
static void compare(const tile *t)
{
    float want[3][COUNT];
    for (int i = 0; i < contender_count; i++) {
        shade(&contenders[i], t);
        for (int c = 0; c < 3; c++)
            for (size_t k = 0; k < t->count; k++) {
                if (i == 0) want[c][k] = t->radiance[c][k];
                double error = fabs((double)t->radiance[c][k] - (double)want[c][k]) / (double)want[c][k];
                if (!(error <= contenders[i].error)) contenders[i].error = error;
            }
    }
}

static void measure(const tile *t, double seconds_a_visit)
{
    for (int round = 0; round < ROUNDS; round++)
        for (int i = 0; i < contender_count; i++) {
            double start = now(), end;
            long calls = 0;
            do {
                for (int k = 0; k < 16; k++) shade(&contenders[i], t);
                calls += 16;
                end = now();
            } while (end - start < seconds_a_visit);
            contenders[i].seconds[round] = (end - start) / (double)calls;
        }
}

static int by_value(const void *a, const void *b)
{
    double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

/* The median over the rounds of how many times as fast `a` is as `b`. */
static double ratio(const contender *a, const contender *b)
{
    double r[ROUNDS];
    for (int i = 0; i < ROUNDS; i++) r[i] = b->seconds[i] / a->seconds[i];
    qsort(r, ROUNDS, sizeof r[0], by_value);
    return r[ROUNDS / 2];
}

static double median_seconds(const contender *c)
{
    double s[ROUNDS];
    memcpy(s, c->seconds, sizeof s);
    qsort(s, ROUNDS, sizeof s[0], by_value);
    return s[ROUNDS / 2];
}

int main(void)
{
    tile t = make_tile();
    add_baseline("textbook -O2", tile_textbook);
#ifdef BASELINE_CLANG
    add_baseline("clang fast-math 256", tile_clang_256);
    add_baseline("clang fast-math 512", tile_clang_512);
#endif
#ifdef BASELINE_GCC
    add_baseline("gcc fast-math 256", tile_gcc_256);
    add_baseline("gcc fast-math 512", tile_gcc_512);
#endif
    const int baselines = contender_count;
    add_library();
    compare(&t);
    measure(&t, 1e-4);

    printf("%-22s %9s %9s", "", "ns/sample", "deviation");
    for (int b = 0; b < baselines; b++) printf("  x %s", contenders[b].name);
    printf("\n");
    for (int i = 0; i < contender_count; i++) {
        const contender *c = &contenders[i];
        printf("%-22s %9.3f %9.1e", c->name, median_seconds(c) * 1e9 / (double)COUNT, c->error);
        for (int b = 0; b < baselines; b++)
            printf("  %*.2f", (int)strlen(contenders[b].name) + 2, ratio(c, &contenders[b]));
        printf("\n");
    }
    return 0;
}
