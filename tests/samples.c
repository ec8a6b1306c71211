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

/* The mirror direction of v about a normal that GGX's distribution draws, of these widths along x and across. */
static vec mirrored(test_random *r, vec n, vec x, vec v, double alpha_x, double alpha_y)
{
    const double u = random_unit(r), tangent = sqrt(u / (1 - u)), azimuth = between(r, 0, 2 * PI);
    const vec y = { n.y * x.z - n.z * x.y, n.z * x.x - n.x * x.z, n.x * x.y - n.y * x.x };
    const double a = alpha_x * tangent * cos(azimuth), b = alpha_y * tangent * sin(azimuth);
    const vec h = { n.x + a * x.x + b * y.x, n.y + a * x.y + b * y.y, n.z + a * x.z + b * y.z };
    const double twice = 2 * dot(v, h) / dot(h, h);
    return (vec){ twice * h.x - v.x, twice * h.y - v.y, twice * h.z - v.z };
}

/* What LOBE is as narrow as. */
typedef struct { double alpha_x, alpha_y; } width;

static width width_of(const kernel_case *kernel, const sample *s)
{
    const double lobe = sqrt(2 / (s->exponent + 2.0));
    if (kernel && kernel->lobe) return (width){ lobe, lobe };
    return (width){ s->alpha, kernel && kernel->streams & FACET_STREAM_ALPHA_Y ? s->alpha_y : s->alpha };
}

static void random_directions(test_random *r, int kind, width w, sample *s)
{
    const vec z = { 0, 0, 1 };
    const double longitude = between(r, 0, 2 * PI), height = between(r, -1, 1);
    store(s->n, direction(z, height, longitude));
    const vec n = vec_of(s->n);
    store(s->tangent, direction(n, 0, between(r, 0, 2 * PI)));
    const double azimuth = between(r, 0, 2 * PI);
    double nl = between(r, 0, 1), nv = between(r, 0, 1), turn = between(r, 0, 2 * PI);
    if (kind == SAMPLES_GRAZING) grazing_cosines(r, &nl, &nv);
    if (kind == SAMPLES_OPPOSED) {
        nl = log_between(r, 0x1p-22, 1);
        nv = log_between(r, 0x1p-22, 1);
        turn = PI + log_between(r, 1e-8, 1);
    }
    store(s->v, direction(n, nv, azimuth));
    if (kind == SAMPLES_LOBE) store(s->l, mirrored(r, n, vec_of(s->tangent), vec_of(s->v), w.alpha_x, w.alpha_y));
    else store(s->l, direction(n, nl, azimuth + turn));
}

/* Of dielectrics, of metals, and of what hardly differs from the medium around it. */
static float random_eta(test_random *r)
{
    const uint64_t which = random_u64(r) & 3;
    const double step = log_between(r, 1e-6, 0.1);
    if (which == 0) return (float)(random_u64(r) & 1 ? 1 + step : 1 - step);
    return with_ends(r, 0.5, 1, which == 1 ? between(r, 0.05, 7) : between(r, 0.5, 3));
}

static void random_parameters(test_random *r, float alpha_min, float sigma_max, sample *s)
{
    s->alpha = with_ends(r, alpha_min, 1, log_between(r, alpha_min, 1));
    s->alpha_y = with_ends(r, alpha_min, 1, log_between(r, alpha_min, 1));
    s->exponent = with_ends(r, FACET_EXPONENT_MIN, FACET_EXPONENT_MAX,
                            log_between(r, FACET_EXPONENT_MIN, FACET_EXPONENT_MAX));
    s->sigma = uniform(r, 0, sigma_max);
    for (int c = 0; c < 3; c++) {
        s->albedo[c] = uniform(r, 0, 1);
        s->f0[c] = uniform(r, 0, 1);
        s->eta[c] = random_eta(r);
        s->k[c] = random_u64(r) & 3 ? uniform(r, 0, 8) : 0.0f;
        s->irradiance[c] = uniform(r, 0, 4);
    }
}

/* Puts the sample where it sees a light of that place along l. */
static void place(sample *s, const float *light, double distance)
{
    for (int c = 0; c < 3; c++) s->position[c] = (float)(light[c] - distance * s->l[c]);
}

void aim_sample(sample *s)
{
    double l[3];
    reference_direction(s, l);
    for (int c = 0; c < 3; c++) s->l[c] = (float)l[c];
}

void light_sample(sample *s, const facet_light *light, double distance)
{
    place(s, light->position, distance);
    s->light = light;
    aim_sample(s);
}

static sample draw(const kernel_case *kernel, test_random *r, int kind, float alpha_min, float sigma_max)
{
    static const float origin[3];
    const bool lit_from_a_place = kernel && kernel->light.kind != FACET_LIGHT_DIRECTIONAL;
    sample s = { .light = NULL };
    random_parameters(r, alpha_min, sigma_max, &s);
    cosines c;
    do {
        s.light = NULL;
        random_directions(r, kind, width_of(kernel, &s), &s);
        const double distance = log_between(r, 0.01, 100);
        if (lit_from_a_place) light_sample(&s, &kernel->light, distance);
        else place(&s, origin, distance);
        c = reference_cosines(&s);
    } while (!(c.nl > 0 && c.nv > 0));
    return s;
}

sample random_sample(test_random *r, int kind, float alpha_min, float sigma_max)
{
    return draw(NULL, r, kind, alpha_min, sigma_max);
}

sample random_sample_of(const kernel_case *kernel, test_random *r, int kind, float alpha_min)
{
    return draw(kernel, r, kind, alpha_min, kernel->sigma_max);
}

/* ---- Batches ----------------------------------------------------------------------------------------------------- */

static void fill(float *stream, const sample *samples, int count, size_t field)
{
    for (int i = 0; i < count; i++) stream[i] = *(const float *)((const char *)&samples[i] + field);
}

/* Every stream of a sample_batch: its place in facet_batch, and its field in a sample. */
#define SAMPLE_STREAMS(STREAM, STREAM3)                                                                               \
    STREAM3(normal, n) STREAM3(view, v) STREAM3(tangent, tangent) STREAM3(position, position)                        \
    STREAM3(albedo, albedo) STREAM3(f0, f0) STREAM3(eta, eta) STREAM3(k, k)                                           \
    STREAM(sigma, sigma) STREAM(alpha, alpha) STREAM(alpha_y, alpha_y) STREAM(exponent, exponent)

static const facet_light *light_of(const sample *samples, int count)
{
    static const facet_light directional = { .kind = FACET_LIGHT_DIRECTIONAL };
    for (int i = 0; i < count; i++)
        if (samples[i].light) return samples[i].light;
    return &directional;
}

sample_batch batch_of(const sample *samples, int count)
{
#define ONE(to, from) + 1
#define THREE(to, from) + 3
    enum { STREAMS = SAMPLE_STREAMS(ONE, THREE) + 3 * 3 };       /* of the light two, and radiance */
    const size_t n = count > 0 ? (size_t)count : 1;
    facet_light *light = malloc(sizeof *light + STREAMS * n * sizeof(float));
    if (!light) {
        fprintf(stderr, "facet-check: out of memory\n");
        exit(2);
    }
    sample_batch b = { .count = count, .memory = (float *)light, .light = *light_of(samples, count) };
    float *free_floats = (float *)(light + 1);
#define FILL(to, field)                                                                                               \
    do {                                                                                                              \
        fill(free_floats, samples, count, offsetof(sample, field));                                                  \
        to = free_floats;                                                                                            \
        free_floats += n;                                                                                            \
    } while (0);
#define FILL_ONE(to, from) FILL(b.batch.to, from)
#define FILL_THREE(to, from) for (size_t c = 0; c < 3; c++) FILL(b.batch.to[c], from[c])
    SAMPLE_STREAMS(FILL_ONE, FILL_THREE)
    for (size_t c = 0; c < 3; c++) {
        if (b.light.kind == FACET_LIGHT_DIRECTIONAL) FILL(b.light.direction_of[c], l[c])
        FILL(b.light.irradiance_of[c], irradiance[c])
        b.batch.radiance[c] = free_floats;
        free_floats += n;
    }
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
