/* Random samples by kind, edge values, and batches of samples. */
#include "samples.h"

#include <float.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#define PI 3.14159265358979323846

const float edge_values[] = {
    0.0f, -0.0f, 0x1p-149f, 0x1p-140f, 0x1p-126f, 1e-38f, 1e-30f, 1e-20f, 1e-10f, 1e-8f, 0x1p-24f, 1e-7f, 0x1p-22f,
    1e-6f, 1e-5f, 1e-4f, 0x1p-12f, 1e-3f, 1e-2f, 0.1f, 0x1p-3f, 0.25f, 0x1.fffffep-2f, 0.5f, 0x1.6a09e6p-1f,
    0x1.fffffcp-1f, 0x1.fffffep-1f, 1.0f, 0x1.000002p0f, 0x1.000004p0f, 2.0f, 4.0f, 10.0f, 100.0f, 1e3f, 1e6f, 1e10f,
    1e20f, 1e30f, FLT_MAX,
    -0x1p-149f, -0x1p-126f, -1e-10f, -0.5f, -1.0f, -0x1.000002p0f, -2.0f, -1e10f, -FLT_MAX,
};
const int edge_count = (int)(sizeof edge_values / sizeof edge_values[0]);

/* ---- Random samples ---------------------------------------------------------------------------------------------- */

typedef struct { double x, y, z; } vec;

static double dot(vec a, vec b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
static vec vec_of(const float *a) { return (vec){ a[0], a[1], a[2] }; }

static void store(float *to, vec a)
{
    const double scale = 1 / sqrt(dot(a, a));
    to[0] = (float)(a.x * scale), to[1] = (float)(a.y * scale), to[2] = (float)(a.z * scale);
}

/* a x + b y + c n for an orthonormal x, y, n. */
static vec in_frame(vec n, double a, double b, double c)
{
    const double sign = n.z < 0 ? -1 : 1, p = -1 / (sign + n.z), q = n.x * n.y * p;
    const vec x = { 1 + sign * n.x * n.x * p, sign * q, -sign * n.x }, y = { q, sign + n.y * n.y * p, -n.y };
    return (vec){ a * x.x + b * y.x + c * n.x, a * x.y + b * y.y + c * n.y, a * x.z + b * y.z + c * n.z };
}

/* The direction with that cosine to n and that azimuth. */
static vec direction(vec n, double cosine, double azimuth)
{
    const double sine = sqrt(fmax(0, 1 - cosine * cosine));
    return in_frame(n, sine * cos(azimuth), sine * sin(azimuth), cosine);
}

static double between(test_random *r, double least, double most)
{
    return least + (most - least) * random_unit(r);
}

static double log_between(test_random *r, double least, double most)
{
    return exp(between(r, log(least), log(most)));
}

/* A number from [least, most], one of the ends with a chance of 1/32 each. */
static float with_ends(test_random *r, double least, double most, double inside)
{
    const uint64_t die = random_u64(r) & 31;
    return (float)(die == 0 ? least : die == 1 ? most : inside);
}

static float uniform(test_random *r, double least, double most)
{
    return with_ends(r, least, most, between(r, least, most));
}

/* Cosines down to 2^-22: of l, of v or of both. */
static void grazing_cosines(test_random *r, double *nl, double *nv)
{
    const uint64_t which = random_u64(r) % 3;
    *nl = which == 0 ? between(r, 0, 1) : log_between(r, 0x1p-22, 1);
    *nv = which == 1 ? between(r, 0, 1) : log_between(r, 0x1p-22, 1);
}

/* The mirror direction of v about a normal that GGX's distribution of alpha draws. */
static vec mirrored(test_random *r, vec n, vec v, double alpha)
{
    const double u = random_unit(r), tangent = alpha * sqrt(u / (1 - u));
    const vec h = direction(n, 1 / sqrt(1 + tangent * tangent), between(r, 0, 2 * PI));
    const double twice = 2 * dot(v, h);
    return (vec){ twice * h.x - v.x, twice * h.y - v.y, twice * h.z - v.z };
}

static void random_directions(test_random *r, int kind, sample *s)
{
    const vec z = { 0, 0, 1 };
    const double longitude = between(r, 0, 2 * PI), height = between(r, -1, 1);
    store(s->n, direction(z, height, longitude));
    const vec n = vec_of(s->n);
    const double azimuth = between(r, 0, 2 * PI);
    double nl = between(r, 0, 1), nv = between(r, 0, 1), turn = between(r, 0, 2 * PI);
    if (kind == SAMPLES_GRAZING) grazing_cosines(r, &nl, &nv);
    if (kind == SAMPLES_OPPOSED) {
        nl = log_between(r, 0x1p-22, 1);
        nv = log_between(r, 0x1p-22, 1);
        turn = PI + log_between(r, 1e-8, 1);
    }
    store(s->v, direction(n, nv, azimuth));
    store(s->l, kind == SAMPLES_LOBE ? mirrored(r, n, vec_of(s->v), s->alpha) : direction(n, nl, azimuth + turn));
}

sample random_sample(test_random *r, int kind, float alpha_min, float sigma_max)
{
    sample s;
    s.alpha = with_ends(r, alpha_min, 1, log_between(r, alpha_min, 1));
    s.sigma = uniform(r, 0, sigma_max);
    for (int c = 0; c < 3; c++) {
        s.albedo[c] = uniform(r, 0, 1);
        s.f0[c] = uniform(r, 0, 1);
        s.irradiance[c] = uniform(r, 0, 4);
    }
    cosines c;
    do {
        random_directions(r, kind, &s);
        c = reference_cosines(&s);
    } while (!(c.nl > 0 && c.nv > 0));
    return s;
}

/* ---- Batches ----------------------------------------------------------------------------------------------------- */

static void fill(float *stream, const sample *samples, int count, size_t field)
{
    for (int i = 0; i < count; i++) stream[i] = *(const float *)((const char *)&samples[i] + field);
}

sample_batch batch_of(const sample *samples, int count)
{
    enum { STREAMS = 23 };
    const size_t n = count > 0 ? (size_t)count : 1;
    facet_light *light = malloc(sizeof *light + STREAMS * n * sizeof(float));
    if (!light) {
        fprintf(stderr, "facet-check: out of memory\n");
        exit(2);
    }
    sample_batch b = { .count = count, .memory = (float *)light };
    float *free_floats = (float *)(light + 1);
#define STREAM(to, field)                                                                                             \
    do {                                                                                                              \
        fill(free_floats, samples, count, offsetof(sample, field));                                                  \
        to = free_floats;                                                                                            \
        free_floats += n;                                                                                            \
    } while (0)
    for (size_t c = 0; c < 3; c++) {
        STREAM(b.batch.normal[c], n[c]);
        STREAM(b.batch.view[c], v[c]);
        STREAM(b.batch.albedo[c], albedo[c]);
        STREAM(b.batch.f0[c], f0[c]);
        STREAM(b.light.direction_of[c], l[c]);
        STREAM(b.light.irradiance_of[c], irradiance[c]);
        b.batch.radiance[c] = free_floats;
        free_floats += n;
    }
    STREAM(b.batch.sigma, sigma);
    STREAM(b.batch.alpha, alpha);
#undef STREAM
    *light = b.light;
    b.batch.count = (size_t)count;
    b.batch.lights = light;
    b.batch.light_count = 1;
    return b;
}

void free_batch(sample_batch *b)
{
    free(b->memory);
    b->memory = NULL;
}
