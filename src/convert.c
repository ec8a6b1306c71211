/* A material's numbers, one stated by another. */
#include "internal.h"

/* The formulas that shading has too are the kernels' own: in the strict tier a number converted here and one that a
 * plan or a kernel derives have the same bytes. */
#define FACET_STRICT 1
#include "../arch/environment.h"
#include "../arch/scalar.h"
#include "models.tmpl.h"

/* Arithmetic from `given` to `result` stays between environment_enter and environment_leave, as the compiler must take
 * both for changed there. (A function that only computes it may move, inlined or not.) */
#define BEGIN(given)                                                                                                  \
    environment callers = environment_enter();                                                                        \
    __asm__ volatile("" : "+m"(given))
#define END(result)                                                                                                   \
    __asm__ volatile("" : "+m"(result));                                                                              \
    environment_leave(callers)

static float clamp01(float x) { return clamp(x, 0.0f, 1.0f); }       /* NaN: 0 */
static void store3(float *to, vf3 a) { to[0] = a.x, to[1] = a.y, to[2] = a.z; }

/* ---- Single numbers: bounds are of the relative error ----------------------------------------------------------- */

/* 9 2^-24, and 2e-40 of what a tiny k underflows to. Worst found: 7.96 2^-24, at eta = 0x1.03f68p+7, k = 0x1.8810fap+2,
 * eta_outside = 0x1.de718p+0: 0x1.e37184p-1 for 0x1.e3719308a839fp-1. */
float facet_f0_from_eta(float eta, float k, float eta_outside)
{
    struct { float eta, k, outside; } given = { eta, k, eta_outside };
    BEGIN(given);
    const float outside = given.outside == 0.0f ? 1.0f : clamp(given.outside, FACET_ETA_FLOOR, FACET_ETA_CAP);
    const float inside = clamp(given.eta, FACET_ETA_FLOOR, FACET_ETA_CAP);
    float f0 = f0_of_index(inside, clamp(given.k, 0.0f, FACET_ETA_CAP), outside);
    END(f0);
    return f0;
}

/* 4 2^-24 in every float; the worst is 0x1.002004p-24: 0x1.002008p+0 for 0x1.00200400900dp+0. */
float facet_eta_from_f0(float f0)
{
    BEGIN(f0);
    float eta = eta_of_f0(clamp01(f0));
    END(eta);
    return eta;
}

/* Correctly rounded, and so the next. */
float facet_alpha_from_roughness(float roughness)
{
    BEGIN(roughness);
    float alpha = square(clamp01(roughness));
    END(alpha);
    return alpha;
}

float facet_roughness_from_alpha(float alpha)
{
    BEGIN(alpha);
    float roughness = vf_sqrt(clamp01(alpha));
    END(roughness);
    return roughness;
}

/* 2/alpha^2 - 2 = 2 (1 - alpha)(1 + alpha)/alpha^2: 3 2^-24 in every float; the worst is 0x1.692abep-1: 0x1.02797cp+1
 * for 0x1.027978ffdb6fap+1. */
float facet_exponent_from_alpha(float alpha)
{
    BEGIN(alpha);
    const float a = clamp(alpha, FACET_ALPHA_FLOOR, 1.0f);
    float exponent = clamp(2.0f * (1.0f - a) * (1.0f + a) / square(a), FACET_EXPONENT_MIN, FACET_EXPONENT_MAX);
    END(exponent);
    return exponent;
}

/* 1.6 2^-24 in every float; the worst is 0x1.fe5042p+1: 0x1.27edbp-1 for 0x1.27edae2ec779fp-1. */
float facet_alpha_from_exponent(float exponent)
{
    BEGIN(exponent);
    float alpha = vf_sqrt(2.0f / (clamp(exponent, FACET_EXPONENT_MIN, FACET_EXPONENT_MAX) + 2.0f));
    END(alpha);
    return alpha;
}

/* ---- Metallic-roughness and specular-glossiness ---------------------------------------------------------------- */

#define LEVEL_1 0.08f            /* a dielectric's f0 at specular_level 1 */
#define EXACT   0x1p-40f         /* the square of a distance that rounding may leave */

/* What follows returns its structs field by field: for a struct as a whole some compilers call memcpy. */

static void specular_from_metallic(const facet_metallic_roughness *from, facet_specular_glossiness *to)
{
    const float metallic = clamp01(from->metallic);
    const vf3 base = clamp3(splat3(from->base), 0.0f, 1.0f);
    store3(to->diffuse, albedo_of_base(base, metallic));
    store3(to->specular, f0_of_base(base, metallic, clamp01(from->specular_level)));
    to->glossiness = 1.0f - clamp01(from->roughness);
}

facet_specular_glossiness facet_to_specular_glossiness(facet_metallic_roughness from)
{
    facet_specular_glossiness to;
    BEGIN(from);
    specular_from_metallic(&from, &to);
    END(to);
    return (facet_specular_glossiness){ { to.diffuse[0], to.diffuse[1], to.diffuse[2] },
                                        { to.specular[0], to.specular[1], to.specular[2] }, to.glossiness };
}

static float mean(const float *a) { return (a[0] + a[1] + a[2]) / 3.0f; }

/* Of a grey with this specular_level: base = diffuse/(1 - metallic), put into specular's formula, leaves a quadratic in
 * 1 - metallic. Its larger root in [0, 1]; where it has none, metallic is 0. */
static float metallic_of_grey(float level, float diffuse, float specular)
{
    const float dielectric = LEVEL_1 * level;
    const float root = vf_sqrt(square(diffuse - specular) + 4.0f * diffuse * (specular - dielectric));
    const float sum = diffuse + specular + root;
    return clamp01(1.0f - (sum <= 2.0f * dielectric ? sum / (2.0f * dielectric) : 2.0f * diffuse / sum));
}

/* Of what differs between the channels: in the plane of diffuse and specular they lie on a line of direction
 * (1 - metallic, metallic), the long axis of their scatter. */
static float metallic_of_colour(const facet_specular_glossiness *to, float diffuse, float specular)
{
    float dd = 0.0f, ss = 0.0f, ds = 0.0f;
    for (int c = 0; c < 3; c++) {
        const float d = to->diffuse[c] - diffuse, s = to->specular[c] - specular;
        dd += d * d, ss += s * s, ds += d * s;
    }
    const float along = ss - dd, sideways = 2.0f * ds, root = vf_sqrt(square(along) + square(sideways));
    const float x = along > 0.0f ? sideways : root - along, y = along > 0.0f ? root + along : sideways;
    return clamp01(y / (x + y));
}

/* The specular_level that leaves the channels' means as they are. */
static float level_of(float metallic, float diffuse, float specular)
{
    const float rest = 1.0f - metallic;
    return rest > 0.0f ? clamp01((specular * rest - diffuse * metallic) / (square(rest) * LEVEL_1)) : 0.5f;
}

/* With the base that is nearest to both colours, in the sense of least squares. Returns the square of the distance. */
static float fit_base(const facet_specular_glossiness *want, float metallic, float level, facet_metallic_roughness *fit)
{
    const float rest = 1.0f - metallic, dielectric = rest * (LEVEL_1 * level);
    float distance = 0.0f;
    for (int c = 0; c < 3; c++) {
        const float diffuse = want->diffuse[c], specular = want->specular[c];
        const float base = clamp01((diffuse * rest + (specular - dielectric) * metallic)
                                   / (square(rest) + square(metallic)));
        distance += square(base * rest - diffuse) + square(dielectric + base * metallic - specular);
        fit->base[c] = base;
    }
    fit->metallic = metallic;
    fit->specular_level = level;
    return distance;
}

static void metallic_from_specular(facet_specular_glossiness *from, facet_metallic_roughness *to)
{
    for (int c = 0; c < 3; c++) {
        from->diffuse[c] = clamp01(from->diffuse[c]);
        from->specular[c] = clamp01(from->specular[c]);
    }
    to->roughness = 1.0f - clamp01(from->glossiness);

    const float diffuse = mean(from->diffuse), specular = mean(from->specular), half = 0.5f * LEVEL_1;
    const float white = vf_max(from->diffuse[0], vf_max(from->diffuse[1], from->diffuse[2]));
    const bool dielectric = specular <= half || (specular <= LEVEL_1 && diffuse <= half);
    const float of_grey = dielectric ? 0.0f : metallic_of_grey(0.5f, diffuse, specular);
    const float of_colour = metallic_of_colour(from, diffuse, specular);
    const struct { float metallic, level; } fits[] = {
        { of_grey, dielectric ? level_of(0.0f, diffuse, specular) : 0.5f },
        { of_colour, level_of(of_colour, diffuse, specular) },
        { 1.0f - white, level_of(1.0f - white, diffuse, specular) },       /* the largest base is 1 */
        { metallic_of_grey(0.0f, diffuse, specular), 0.0f },
        { metallic_of_grey(1.0f, diffuse, specular), 1.0f },
    };

    /* The first that is exact but for rounding, or the nearest. */
    int best = 0;
    float least = FLT_MAX;
    for (int i = 0; i < 5 && least > EXACT; i++) {
        const float distance = fit_base(from, fits[i].metallic, fits[i].level, to);
        if (distance < least) best = i, least = distance;
    }
    fit_base(from, fits[best].metallic, fits[best].level, to);
}

facet_metallic_roughness facet_to_metallic_roughness(facet_specular_glossiness from)
{
    facet_metallic_roughness to;
    BEGIN(from);
    metallic_from_specular(&from, &to);
    END(to);
    return (facet_metallic_roughness){ { to.base[0], to.base[1], to.base[2] }, to.metallic, to.roughness,
                                       to.specular_level };
}
