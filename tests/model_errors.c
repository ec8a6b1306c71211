/* model-errors: prints what the charts need beside speeds, as tab-separated lines:
 *     ladder  NAME TITLE TRUTH STATED          models that stand for one truth, and on what they are compared
 *     model   LADDER CASE TIER LABEL WORST MEAN
 *                                              |model - truth|/truth over the directions stated, both in double but for
 *                                              what is fitted, which facet evaluates; timed as CASE in TIER, "-": any
 *     panel   NAME TITLE X STATED              where a textbook's form fails in float
 *     point   PANEL X TEXTBOOK LOST FACET      worst |got - want|/want of a textbook's form and of facet's strict
 *                                              kernel, want in double; LOST: the share of samples where the textbook's
 *                                              is NaN or infinite, which TEXTBOOK leaves out; "-" where that is all
 * The same lines everywhere, as far as libm's float functions are the same. */
#include "harness.h"
#include "reference.h"

#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

#define PI 3.14159265358979323846
#define DEGREE (PI / 180)

/* What facet returns of a sample, one light of irradiance 1. */
static void shade(const facet_plan *plan, const sample *s, float radiance[3])
{
    const facet_light light = { .direction = { s->l[0], s->l[1], s->l[2] }, .irradiance = { 1, 1, 1 } };
    const facet_batch batch = {
        .count = 1, .normal = { &s->n[0], &s->n[1], &s->n[2] }, .view = { &s->v[0], &s->v[1], &s->v[2] },
        .albedo = { &s->albedo[0], &s->albedo[1], &s->albedo[2] }, .sigma = &s->sigma, .alpha = &s->alpha,
        .eta = { &s->eta[0], &s->eta[1], &s->eta[2] }, .lights = &light, .light_count = 1,
        .radiance = { &radiance[0], &radiance[1], &radiance[2] }
    };
    facet_shade(plan, &batch, NULL);
}

/* ---- Models against models --------------------------------------------------------------------------------------- */

typedef struct { double worst, mean, weight; } difference;

static void differ(difference *d, double got, double want, double weight)
{
    const double relative = fabs(got - want) / want;
    d->worst = fmax(d->worst, relative);
    d->mean += weight * relative;
    d->weight += weight;
}

static void print_model(const char *ladder, const char *kernel, const char *tier, const char *label, difference d)
{
    printf("model\t%s\t%s\t%s\t%s\t%.4g\t%.4g\n", ladder, kernel, tier, label, d.worst, d.mean / d.weight);
}

enum { STEEPEST = 75 };

/* n is z. */
static sample clay_at(int degrees_l, int degrees_v, int azimuth)
{
    const double l = degrees_l * DEGREE, v = degrees_v * DEGREE, phi = azimuth * DEGREE;
    return (sample){ .n = { 0, 0, 1 }, .v = { (float)sin(v), 0, (float)cos(v) },
                     .l = { (float)(sin(l) * cos(phi)), (float)(sin(l) * sin(phi)), (float)cos(l) },
                     .albedo = { 0.6f, 0.6f, 0.6f }, .sigma = 0.4f, .irradiance = { 1, 1, 1 } };
}

static double diffuse_radiance(facet_diffuse model, const sample *s)
{
    const facet_material m = { .diffuse = { .model = model } };
    double radiance[3];
    reference_radiance(&m, s, radiance);
    return radiance[0];
}

/* Over all l and v that far from n at most, by solid angle. */
static difference diffuse_difference(facet_diffuse model)
{
    difference d = { 0 };
    for (int l = 0; l <= STEEPEST; l++)
        for (int v = 0; v <= STEEPEST; v++)
            for (int azimuth = 0; azimuth <= 180; azimuth += 2) {
                const sample s = clay_at(l, v, azimuth);
                differ(&d, diffuse_radiance(model, &s), diffuse_radiance(FACET_DIFFUSE_OREN_NAYAR_FULL, &s),
                       sin(l * DEGREE) * sin(v * DEGREE));
            }
    return d;
}

static void diffuse_ladder(void)
{
    static const struct { facet_diffuse model; const char *label; } rows[] = {
        { FACET_DIFFUSE_LAMBERT, "Lambert" },
        { FACET_DIFFUSE_OREN_NAYAR, "A and B" },
        { FACET_DIFFUSE_OREN_NAYAR_57, "A and B, 0.57" },
        { FACET_DIFFUSE_OREN_NAYAR_DIRECT, "full, direct alone" },
        { FACET_DIFFUSE_OREN_NAYAR_FULL, "full 1994" },
    };
    printf("ladder\tdiffuse\tOren-Nayar: clay\tthe full model of 1994\t"
           "sigma 0.4, albedo 0.6, light and eye up to %d\302\260 from the normal\n", STEEPEST);
    for (size_t i = 0; i < sizeof rows / sizeof rows[0]; i++)
        print_model("diffuse", facet_word(FACET_KIND_DIFFUSE, (int)rows[i].model), "-", rows[i].label,
                    diffuse_difference(rows[i].model));
}

/* v and l that far from n, which is then the half vector. */
static sample metal_at(double angle, const float eta[3], const float k[3])
{
    const float x = (float)sin(angle), z = (float)cos(angle);
    sample s = { .n = { 0, 0, 1 }, .v = { x, 0, z }, .l = { -x, 0, z }, .alpha = 1 };
    for (int c = 0; c < 3; c++) {
        s.eta[c] = eta[c];
        s.k[c] = k[c];
        s.f0[c] = facet_f0_from_eta(eta[c], k[c], 1);
    }
    return s;
}

/* Tenths of a degree. */
enum { METAL = FACET_METAL_IRON, ANGLES = 900 };

static facet_material metal_of(facet_fresnel model)
{
    facet_material m = { .specular = { .model = FACET_DISTRIBUTION_GGX, .alpha = 1 }, .fresnel = { .model = model } };
    facet_index_of_metal((facet_metal)METAL, m.fresnel.eta, m.fresnel.k);
    return m;
}

/* Over every angle and channel. */
static difference fresnel_difference(facet_fresnel model)
{
    facet_material m = metal_of(model);
    difference d = { 0 };
    for (int i = 0; i < ANGLES; i++)
        for (int c = 0; c < 3; c++) {
            const sample s = metal_at(0.1 * i * DEGREE, m.fresnel.eta, m.fresnel.k);
            m.fresnel.model = FACET_FRESNEL_CONDUCTOR;
            const double want = reference_fresnel(&m, &s, c);
            m.fresnel.model = model;
            differ(&d, reference_fresnel(&m, &s, c), want, 1);
        }
    return d;
}

/* Whether a plan of exact Fresnel terms evaluates a fit to them. */
static bool is_fitted(const facet_plan *plan)
{
    char text[4096];
    facet_plan_describe(plan, text, sizeof text);
    return strstr(text, "Fresnel: a rational function");
}

/* The fast tier's fit to the exact term of numbers: its radiance against that of the exact term, rounding and all. */
static void fitted_model(void)
{
    const facet_material m = metal_of(FACET_FRESNEL_CONDUCTOR);
    facet_plan plan;
    difference d = { 0 };
    if (facet_plan_init(&plan, &m, (facet_target){ .arch = FACET_ARCH_SCALAR }, NULL) || !is_fitted(&plan))
        return;
    for (int i = 0; i < ANGLES; i++) {
        sample s = metal_at(0.1 * i * DEGREE, m.fresnel.eta, m.fresnel.k);
        double want[3];
        float got[3];
        for (int c = 0; c < 3; c++) s.irradiance[c] = 1;
        reference_radiance(&m, &s, want);
        shade(&plan, &s, got);
        for (int c = 0; c < 3; c++) differ(&d, got[c], want[c], 1);
    }
    print_model("fresnel", "metal", "fast", "fitted to numbers", d);
}

static void fresnel_ladder(void)
{
    static const struct { facet_fresnel model; const char *label; } rows[] = {
        { FACET_FRESNEL_SCHLICK, "Schlick" },
        { FACET_FRESNEL_SCHLICK_F82, "Schlick with F82" },
        { FACET_FRESNEL_CONDUCTOR, "exact" },
    };
    printf("ladder\tfresnel\tFresnel: iron\tthe exact equations\t"
           "measured index and extinction, every angle; timed with GGX and correlated Smith\n");
    for (size_t i = 0; i < sizeof rows / sizeof rows[0]; i++) {
        char kernel[64];
        snprintf(kernel, sizeof kernel, "ggx/smith-correlated/%s", facet_word(FACET_KIND_FRESNEL, (int)rows[i].model));
        print_model("fresnel", kernel, "-", rows[i].label, fresnel_difference(rows[i].model));
    }
    fitted_model();
}

/* ---- Random samples ---------------------------------------------------------------------------------------------- */

static test_random randomness;

static double random_between(double least, double most)
{
    return least + (most - least) * random_unit(&randomness);
}

static double dot(const double *a, const double *b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

/* The direction that far from n, at any azimuth. */
static void around(const double n[3], double angle, double to[3])
{
    const double sign = n[2] < 0 ? -1 : 1, p = -1 / (sign + n[2]), q = n[0] * n[1] * p;
    const double x[] = { 1 + sign * n[0] * n[0] * p, sign * q, -sign * n[0] };
    const double y[] = { q, sign + n[1] * n[1] * p, -n[1] };
    const double azimuth = random_between(0, 2 * PI), a = sin(angle) * cos(azimuth), b = sin(angle) * sin(azimuth);
    for (int c = 0; c < 3; c++) to[c] = a * x[c] + b * y[c] + cos(angle) * n[c];
}

/* The nearest floats, after scaling to unit length. */
static void store(float to[3], const double from[3])
{
    const double scale = 1 / sqrt(dot(from, from));
    for (int c = 0; c < 3; c++) to[c] = (float)(scale * from[c]);
}

/* n is any direction, v and l that far from it. */
static sample sample_between(double angle_v, double angle_l)
{
    const double z[] = { 0, 0, 1 };
    double n[3], v[3], l[3];
    sample s = { .irradiance = { 1, 1, 1 } };
    around(z, acos(random_between(-1, 1)), n);
    around(n, angle_v, v);
    around(n, angle_l, l);
    store(s.n, n);
    store(s.v, v);
    store(s.l, l);
    return s;
}

/* Nine tenths of the highlight: l is v's mirror image about normals that GGX's distribution draws, if that is above the
 * surface. */
static sample in_highlight(double alpha)
{
    for (;;) {
        sample s = sample_between(random_between(0, 1.2), 0);
        const double n[] = { s.n[0], s.n[1], s.n[2] }, v[] = { s.v[0], s.v[1], s.v[2] }, u = random_between(0, 0.9);
        double h[3], l[3];
        around(n, atan(alpha * sqrt(u / (1 - u))), h);
        for (int c = 0; c < 3; c++) l[c] = 2 * dot(v, h) * h[c] - v[c];
        store(s.l, l);
        s.alpha = (float)alpha;
        if (dot(n, l) > 0.1) return s;
    }
}

static sample of_index(double above_1)
{
    sample s = sample_between(random_between(0, 1.4), random_between(0, 1.4));
    s.alpha = 1;
    for (int c = 0; c < 3; c++) s.eta[c] = (float)(1 + above_1);
    return s;
}

/* The half vector in the lobe, where there is something to see. */
static sample seen_at_grazing(double degrees)
{
    for (;;) {
        sample s = sample_between(PI / 2 - degrees * DEGREE, random_between(0, 1.4));
        const double nh = reference_cosines(&s).nh;
        s.alpha = 0.5f;
        if (1 / (nh * nh) - 1 < 2 * 0.25) return s;
    }
}

static sample seen_along_the_normal(double degrees)
{
    sample s = sample_between(degrees * DEGREE, random_between(0, 1.4));
    s.sigma = 0.4f;
    for (int c = 0; c < 3; c++) s.albedo[c] = 0.6f;
    return s;
}

/* ---- Textbooks' forms in float, as they are printed -------------------------------------------------------------- */

typedef struct { float x, y, z; } vec3;

static const float pi = 3.14159265f;

static vec3 vec(const float *a) { return (vec3){ a[0], a[1], a[2] }; }
static vec3 mul(vec3 a, float s) { return (vec3){ a.x * s, a.y * s, a.z * s }; }
static vec3 add(vec3 a, vec3 b) { return (vec3){ a.x + b.x, a.y + b.y, a.z + b.z }; }
static float dotf(vec3 a, vec3 b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
static vec3 normalize(vec3 a) { return mul(a, 1.0f / sqrtf(dotf(a, a))); }

typedef struct { vec3 n, v, l, h; float nl, nv, nh, vh; } vectors;

static vectors vectors_of(const sample *s)
{
    vectors a = { .n = vec(s->n), .v = vec(s->v), .l = vec(s->l) };
    a.h = normalize(add(a.v, a.l));
    a.nl = dotf(a.n, a.l), a.nv = dotf(a.n, a.v), a.nh = dotf(a.n, a.h), a.vh = dotf(a.v, a.h);
    return a;
}

/* The angle of a cosine that rounding may have put above 1. */
static float angle_of(float cosine) { return acosf(fminf(cosine, 1.0f)); }

static float lambda(float cosine, float alpha)
{
    const float tan2 = (1.0f - cosine * cosine) / (cosine * cosine);
    return (-1.0f + sqrtf(1.0f + alpha * alpha * tan2)) / 2.0f;
}

/* Walter et al. 2007, eq. 33; Heitz 2014, eq. 99. */
static float textbook_ggx(const sample *s)
{
    const vectors a = vectors_of(s);
    const float alpha2 = s->alpha * s->alpha, d = a.nh * a.nh * (alpha2 - 1.0f) + 1.0f;
    const float D = alpha2 / (pi * d * d), G = 1.0f / (1.0f + lambda(a.nl, s->alpha) + lambda(a.nv, s->alpha));
    return D * G / (4.0f * a.nl * a.nv) * a.nl;
}

/* Cook and Torrance 1981, eq. 16. */
static float textbook_dielectric(const sample *s)
{
    const float c = vectors_of(s).vh, eta = s->eta[0], g = sqrtf(eta * eta - 1.0f + c * c);
    const float once = (g - c) / (g + c), second = (c * (g + c) - 1.0f) / (c * (g - c) + 1.0f);
    return textbook_ggx(s) * (0.5f * once * once * (1.0f + second * second));
}

/* Walter et al. 2007, eq. 27. */
static float g1_of_beckmann(float cosine, float alpha)
{
    const float a = 1.0f / (alpha * tanf(angle_of(cosine)));
    return a < 1.6f ? (3.535f * a + 2.181f * a * a) / (1.0f + 2.276f * a + 2.577f * a * a) : 1.0f;
}

/* The same, eq. 25. */
static float textbook_beckmann(const sample *s)
{
    const vectors a = vectors_of(s);
    const float theta = angle_of(a.nh), alpha2 = s->alpha * s->alpha;
    const float D = expf(-powf(tanf(theta), 2.0f) / alpha2) / (pi * alpha2 * powf(cosf(theta), 4.0f));
    const float G = g1_of_beckmann(a.nl, s->alpha) * g1_of_beckmann(a.nv, s->alpha);
    return D * G / (4.0f * a.nl * a.nv) * a.nl;
}

/* The part of a that is perpendicular to n, scaled to unit length. */
static vec3 azimuth_of(vec3 a, vec3 n) { return normalize(add(a, mul(n, -dotf(a, n)))); }

/* Oren and Nayar 1994, with A and B. */
static float textbook_oren_nayar(const sample *s)
{
    const vectors a = vectors_of(s);
    const float theta_r = angle_of(a.nv), theta_i = angle_of(a.nl), s2 = s->sigma * s->sigma;
    const float A = 1.0f - 0.5f * s2 / (s2 + 0.33f), B = 0.45f * s2 / (s2 + 0.09f);
    const float cos_phi = dotf(azimuth_of(a.v, a.n), azimuth_of(a.l, a.n));
    const float seen = cos_phi < 0.0f ? 0.0f : cos_phi;
    return s->albedo[0] / pi * (A + B * seen * sinf(fmaxf(theta_i, theta_r)) * tanf(fminf(theta_i, theta_r))) * a.nl;
}

/* ---- Where they fail --------------------------------------------------------------------------------------------- */

typedef struct {
    const char *name, *title, *x, *stated;
    double least, most;          /* of x, by powers of ten */
    sample (*draw)(double x);
    float (*textbook)(const sample *);
    facet_material material;     /* what facet shades it with */
} panel;

static const panel panels[] = {
    { "ggx", "GGX in a small highlight", "alpha", "D from n\302\267h, over nine tenths of the highlight",
      -4, 0, in_highlight, textbook_ggx,
      { .specular = { .model = FACET_DISTRIBUTION_GGX }, .fresnel = { .model = FACET_FRESNEL_ONE } } },
    { "dielectric", "Fresnel where the index is nearly 1", "index of refraction minus 1",
      "g and c of Cook and Torrance, light and eye up to 80\302\260 from the normal",
      -7, 0, of_index, textbook_dielectric,
      { .specular = { .model = FACET_DISTRIBUTION_GGX }, .fresnel = { .model = FACET_FRESNEL_DIELECTRIC } } },
    { "beckmann", "Beckmann at grazing angles", "degrees of the eye above the surface",
      "acos and tan, alpha 0.5, the half vector in the lobe", -4, 1, seen_at_grazing, textbook_beckmann,
      { .specular = { .model = FACET_DISTRIBUTION_BECKMANN, .masking = FACET_MASKING_SMITH },
        .fresnel = { .model = FACET_FRESNEL_ONE } } },
    { "oren-nayar", "Oren-Nayar seen along the normal", "degrees between eye and normal",
      "the azimuth of a vertical vector is 0/0, sigma 0.4", -6, 1, seen_along_the_normal, textbook_oren_nayar,
      { .diffuse = { .model = FACET_DIFFUSE_OREN_NAYAR } } },
};

static facet_material promised(const panel *p)
{
    facet_material m = p->material;
    const bool diffuse = m.diffuse.model != FACET_DIFFUSE_NONE;
    m.streams = diffuse ? FACET_STREAM_ALBEDO | FACET_STREAM_SIGMA : FACET_STREAM_ALPHA;
    if (m.fresnel.model == FACET_FRESNEL_DIELECTRIC) m.streams |= FACET_STREAM_ETA;
    return m;
}

static void print_point(const panel *p, const facet_material *m, const facet_plan *plan, double x)
{
    enum { SAMPLES = 2000 };
    double textbook = 0, facet = 0;
    int lost = 0;
    for (int i = 0; i < SAMPLES; i++) {
        const sample s = p->draw(x);
        double want[3];
        float got[3], printed = p->textbook(&s);
        reference_radiance(m, &s, want);
        shade(plan, &s, got);
        facet = fmax(facet, fabs(got[0] - want[0]) / want[0]);
        if (isfinite(printed)) textbook = fmax(textbook, fabs(printed - want[0]) / want[0]);
        else lost++;
    }
    char known[32] = "-";
    if (lost < SAMPLES) snprintf(known, sizeof known, "%.4g", textbook);
    printf("point\t%s\t%.4g\t%s\t%.4g\t%.4g\n", p->name, x, known, (double)lost / (double)SAMPLES, facet);
}

static bool print_panel(const panel *p)
{
    enum { A_DECADE = 8 };
    const facet_material m = promised(p);
    facet_plan plan;
    /* Strict, on one lane: the same bytes as on any other. */
    const facet_target target = { .arch = FACET_ARCH_SCALAR, .tier = FACET_TIER_STRICT };
    if (facet_plan_init(&plan, &m, target, NULL)) return false;
    printf("panel\t%s\t%s\t%s\t%s\n", p->name, p->title, p->x, p->stated);
    randomness.state = 1;
    for (int i = (int)p->least * A_DECADE; i <= (int)p->most * A_DECADE; i++)
        print_point(p, &m, &plan, pow(10, (double)i / (double)A_DECADE));
    return true;
}

int main(void)
{
    printf("# model-errors\t1\n");
    diffuse_ladder();
    fresnel_ladder();
    for (size_t i = 0; i < sizeof panels / sizeof panels[0]; i++)
        if (!print_panel(&panels[i])) {
            fprintf(stderr, "model-errors: this build has no strict scalar kernel of %s\n", panels[i].name);
            return 1;
        }
    return fflush(stdout) != 0;
}
