/* facet: shades batches of surface samples.
 *
 *     material + target --facet_plan_init--> plan --+
 *                                                   +--facet_shade--> radiance --facet_encode--> pixels
 *     streams + lights ----------------- batch -----+
 *
 * Vocabulary. sample: one shading point. stream: one float per sample, in sample order, or one for the whole batch
 * (uniform). Three pointers make a stream of vectors or colours: [0] x or red, [1] y or green, [2] z or blue.
 *
 * Symbols. n: unit normal. v: unit, surface to eye. l: unit, surface to light. nl = n.l, nv = n.v, vl = v.l,
 * w = v + l, vh = |w|/2: the cosine between v and the half vector w/|w|. Vectors are taken as given: nothing is
 * normalised, and every model is a function of the floats that it is handed.
 *
 * Units. Irradiance is W/m2 on a plane that faces the light; radiance is W/(m2 sr); a BRDF f is 1/sr; angles are
 * radians. A white Lambertian surface lit head on by an irradiance of pi has a radiance of 1.
 *
 * Everywhere: a field that is zero has its default. No function allocates, locks, or touches a global; each may run
 * on any number of threads at once, on the same plan too. The caller's floating-point environment (rounding mode,
 * flush-to-zero, trap masks, sticky flags) neither changes a result nor is changed. No data makes a call fail:
 * every output is finite and >= 0 for every input (see facet_shade).
 */
#ifndef FACET_H
#define FACET_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#define FACET_VERSION_MAJOR 0
#define FACET_VERSION_MINOR 1
#define FACET_VERSION_PATCH 0

#if defined(__GNUC__)
#define FACET_API __attribute__((visibility("default")))
#else
#define FACET_API
#endif

#ifdef __cplusplus
extern "C" {
#endif

/* ---- Refusals -------------------------------------------------------------------------------------------------- */

typedef enum facet_status {
    FACET_OK = 0,
    FACET_ERROR_NULL,    /* a pointer that is needed is NULL */
    FACET_ERROR_VALUE,   /* a number is NaN, infinite or outside its domain */
    FACET_ERROR_ENUM,    /* no such enumerator, or an unknown flag bit */
    FACET_ERROR_MODEL,   /* this build lacks the model, or the models do not go together */
    FACET_ERROR_ARCH,    /* the architecture or tier is not in this build, or not on this CPU */
    FACET_ERROR_PLAN,    /* not a plan, or one of another version of the library */
    FACET_ERROR_SIZE     /* a struct of a newer header uses what this library does not know */
} facet_status;

/* What was refused. `field` is the field's name as it stands in the struct, such as "diffuse.sigma" or
 * "light.irradiance" (a constant string; NULL with FACET_OK); `index` the light's or the component's number, or -1. */
typedef struct facet_error {
    facet_status code;
    const char *field;
    int index;
} facet_error;

/* Writes a line such as "light.irradiance[3]: a number is NaN, infinite or outside its domain" as snprintf does:
 * at most `size` bytes with the final 0, returns the length without it. `text` may be NULL where `size` is 0, `error`
 * where there was none. */
FACET_API size_t facet_error_describe(const facet_error *error, char *text, size_t size);

/* ---- Models and targets ---------------------------------------------------------------------------------------- */

typedef enum facet_diffuse {
    FACET_DIFFUSE_NONE = 0,
    FACET_DIFFUSE_LAMBERT,          /* f = albedo / pi */
    FACET_DIFFUSE_OREN_NAYAR,       /* Oren and Nayar 1994, qualitative form: A = 1 - 0.5 s2/(s2 + 0.33) */
    FACET_DIFFUSE_OREN_NAYAR_57,    /* the same with 0.57 in A: interreflection folded in, by the paper's note */
    FACET_DIFFUSE_OREN_NAYAR_FULL,  /* Oren and Nayar 1994, eq. 30 and 31: C1, C2, C3 and one interreflection */
    FACET_DIFFUSE_OREN_NAYAR_DIRECT,/* the same without interreflection: eq. 30 alone */
    FACET_DIFFUSE_FUJII,            /* Fujii's improved Oren-Nayar; sigma is its r in [0, 1], not an angle */
    FACET_DIFFUSE_EON               /* Portsmouth, Kutz, Hill 2024: Fujii's, with what scatters more than once */
} facet_diffuse;

typedef enum facet_distribution {
    FACET_DISTRIBUTION_NONE = 0,
    FACET_DISTRIBUTION_GGX,         /* Trowbridge and Reitz 1975; Walter et al. 2007 */
    FACET_DISTRIBUTION_GGX_ANISOTROPIC,        /* alpha along the tangent, alpha_y across; Heitz 2014, eq. 84 */
    FACET_DISTRIBUTION_BECKMANN,    /* Beckmann 1963; Cook and Torrance 1981 */
    FACET_DISTRIBUTION_BECKMANN_ANISOTROPIC,   /* the same with two alphas; Heitz 2014, eq. 82 */
    /* Lobes: BRDFs of their own, without facets; masking is ignored. */
    FACET_DISTRIBUTION_PHONG,       /* (r.v)^exponent, r the mirror image of l; 0 where r.v <= 0 */
    FACET_DISTRIBUTION_PHONG_MODIFIED,         /* times (exponent + 2)/(2 pi); Lafortune and Willems 1994 */
    FACET_DISTRIBUTION_BLINN_PHONG,            /* (n.h)^exponent */
    FACET_DISTRIBUTION_BLINN_PHONG_NORMALISED  /* times (m + 2)(m + 4)/(8 pi (2^(-m/2) + m)), m = exponent */
} facet_distribution;

typedef enum facet_masking {
    FACET_MASKING_SMITH_CORRELATED = 0,   /* 1/(1 + Lambda(nl) + Lambda(nv)): height-correlated; Heitz 2014, eq. 99 */
    FACET_MASKING_SMITH,                  /* G1(nl) G1(nv): separable; Walter et al. 2007, eq. 23 */
    /* Those two are exact for GGX; Beckmann's G1 is Walter's rational one (eq. 26), within 0.31 % of the exact: */
    FACET_MASKING_SMITH_EXACT_CORRELATED, /* for Beckmann, with the error function */
    FACET_MASKING_SMITH_EXACT,
    FACET_MASKING_V_CAVITY,               /* min(1, 2 nh nv/vh, 2 nh nl/vh); Torrance and Sparrow 1967 */
    FACET_MASKING_SCHLICK_GGX,            /* mu/(mu (1 - k) + k) for nl and nv, k = alpha/2; Schlick 1994, Karis 2013 */
    FACET_MASKING_SCHLICK_GGX_ANALYTIC,   /* the same with k = (sqrt(alpha) + 1)^2/8, for analytic lights alone */
    FACET_MASKING_HAMMON                  /* 2 nl nv/lerp(2 nl nv, nl + nv, alpha): nearly correlated; Hammon 2017 */
} facet_masking;

typedef enum facet_fresnel {
    FACET_FRESNEL_SCHLICK = 0,   /* f0 + (f90 - f0)(1 - vh)^5; Schlick 1994 */
    FACET_FRESNEL_CONSTANT,      /* f0 at every angle */
    FACET_FRESNEL_ONE,           /* 1 */
    FACET_FRESNEL_SCHLICK_F82,   /* for metals: Schlick, corrected to meet f82 where vh = 1/7; Kutz et al. 2021 */
    FACET_FRESNEL_DIELECTRIC,    /* exact, of eta; Cook and Torrance 1981. Total reflection where eta < eta_outside */
    FACET_FRESNEL_CONDUCTOR      /* exact, of eta and k per channel; Born and Wolf, ch. 14 */
} facet_fresnel;

/* What the material's numbers mean. */
typedef enum facet_convention {
    FACET_CONVENTION_DIRECT = 0,           /* diffuse.albedo, specular.alpha, fresnel.f0 */
    FACET_CONVENTION_METALLIC_ROUGHNESS,   /* base, metallic, roughness, specular_level in their place */
    FACET_CONVENTION_SPECULAR_GLOSSINESS   /* diffuse.albedo, fresnel.f0, and glossiness in place of alpha */
} facet_convention;

typedef enum facet_arch {
    FACET_ARCH_BEST = 0,         /* the best that this build has and this CPU runs */
    FACET_ARCH_SCALAR,
    FACET_ARCH_SSE2,
    FACET_ARCH_SSE41,
    FACET_ARCH_AVX2,             /* AVX2, FMA, F16C */
    FACET_ARCH_AVX512,           /* AVX-512 F, VL, DQ, BW */
    FACET_ARCH_NEON              /* aarch64 */
} facet_arch;

typedef enum facet_tier {
    FACET_TIER_FAST = 0,         /* within the kernel's bound; bytes may differ from arch to arch */
    FACET_TIER_STRICT            /* the same bytes on every arch, compiler and CPU */
} facet_tier;

/* What a plan is compiled for.
 *   arches         facet_arches(), asked once for any number of plans; 0: facet_plan_init asks the CPU. BEST is the
 *                  best of these, and another arch must be one of them. Bits may be left out. A bit that this CPU lacks
 *                  makes plans for another: shading with them here ends in an illegal instruction. */
typedef struct facet_target {
    facet_arch arch;
    facet_tier tier;
    uint32_t arches;
} facet_target;

typedef enum facet_kind {
    FACET_KIND_DIFFUSE = 0, FACET_KIND_DISTRIBUTION, FACET_KIND_MASKING, FACET_KIND_FRESNEL, FACET_KIND_CONVENTION,
    FACET_KIND_LIGHT, FACET_KIND_METAL, FACET_KIND_ARCH, FACET_KIND_TIER, FACET_KIND_STATUS
} facet_kind;

/* The word of an enumerator ("oren-nayar", "avx2"); NULL past the last, so that counting up from 0 lists a kind.
 * A constant string. For FACET_KIND_STATUS the word is a phrase. */
FACET_API const char *facet_word(facet_kind kind, int value);

/* The enumerator of a word, or -1. `word` may be NULL. */
FACET_API int facet_value(facet_kind kind, const char *word);

/* Whether this build holds the enumerator; for FACET_KIND_ARCH also whether this CPU runs it. */
FACET_API bool facet_has(facet_kind kind, int value);

/* The architectures that this build holds and this CPU runs, a bit each: 1u << FACET_ARCH_AVX2. Asks the CPU. */
FACET_API uint32_t facet_arches(void);

/* The best of these: what FACET_ARCH_BEST stands for on this CPU; itself where the build holds nothing that it runs. */
FACET_API facet_arch facet_arch_best(void);

/* Lanes of an architecture's vectors: 1, 4, 8 or 16; 0 where the build lacks it. */
FACET_API int facet_arch_lanes(facet_arch arch);

/* "0.1.0": the library's, which may be newer than the header's. */
FACET_API const char *facet_version(void);

/* ---- Plans ----------------------------------------------------------------------------------------------------- */

/* Streams by name: what a material leaves to its batches (facet_material.streams) and what a batch gives as one value
 * for all its samples (facet_batch.uniform). */
enum {
    FACET_STREAM_NORMAL         = 1 << 0,
    FACET_STREAM_VIEW           = 1 << 1,
    FACET_STREAM_TANGENT        = 1 << 2,
    FACET_STREAM_POSITION       = 1 << 3,
    FACET_STREAM_OCCLUSION      = 1 << 4,
    /* What a material may promise: */
    FACET_STREAM_ALBEDO         = 1 << 5,
    FACET_STREAM_SIGMA          = 1 << 6,
    FACET_STREAM_ALPHA          = 1 << 7,
    FACET_STREAM_ALPHA_Y        = 1 << 8,
    FACET_STREAM_EXPONENT       = 1 << 9,
    FACET_STREAM_F0             = 1 << 10,
    FACET_STREAM_ETA            = 1 << 11,
    FACET_STREAM_K              = 1 << 12,
    FACET_STREAM_BASE           = 1 << 13,
    FACET_STREAM_METALLIC       = 1 << 14,
    FACET_STREAM_ROUGHNESS      = 1 << 15,
    FACET_STREAM_SPECULAR_LEVEL = 1 << 16,
    FACET_STREAM_GLOSSINESS     = 1 << 17
};

/* A material: models and their parameters. Numbers must be finite; "negative is 0" and clamps hold alike for a number
 * here and for a stream's value.
 *   diffuse.albedo       [0, 1] per channel, negative is 0; above 1 is used as it is (EON: as 1 where it scatters more
 *                        than once).
 *   diffuse.sigma        Oren-Nayar: standard deviation of the facets' slope angle, radians, [0, pi/2]. Fujii, EON: r,
 *                        [0, 1]. Outside is refused here, clamped in a stream. At 0 these are Lambert, exactly.
 *   specular.alpha       roughness as it stands in D and G: (0, 1], clamped to [FACET_ALPHA_FLOOR, 1]; negative is
 *                        refused here. It is not the perceptual roughness, whose square it is.
 *   specular.alpha_y     of an anisotropic distribution, across the tangent, as alpha; 0: alpha.
 *   specular.exponent    of a lobe, real, [1, 10000]; outside is refused here, clamped in a stream.
 *   specular.scale       multiplies the specular part, >= 0; 0: 1. FACET_SCALE_* match other normalisations.
 *   fresnel.f0           reflectance at normal incidence, clamped to [0, 1]. Where all three are 0 and eta is given,
 *                        facet_f0_from_eta.
 *   fresnel.f90          Schlick's reflectance at grazing, clamped to [0, 1]; 0: 1.
 *   fresnel.f82          SCHLICK_F82's reflectance where vh = 1/7 (82 degrees), clamped to [0, 1]. Where all three are
 *                        0, the conductor's of eta and k, which must then be given as numbers, with eta_outside and
 *                        polarisation.
 *   fresnel.eta, .k      index of refraction, > 0 in every channel once one is given, and extinction, >= 0, clamped to
 *                        [FACET_ETA_FLOOR, FACET_ETA_CAP] and [0, FACET_ETA_CAP]. DIELECTRIC takes eta_outside times
 *                        facet_eta_from_f0(f0) where no eta is given; CONDUCTOR needs eta.
 *   fresnel.eta_outside  index of the medium around it, clamped as eta; 0: 1.
 *   fresnel.polarisation of the light, as DIELECTRIC and CONDUCTOR see it: -1 perpendicular to the plane of incidence,
 *                        0 none, 1 parallel to it; between them, a mixture.
 *   convention           what base, metallic, roughness, specular_level, glossiness stand in for, each clamped to
 *                        [0, 1], but that a base above 1 is used as it is:
 *                        METALLIC_ROUGHNESS: albedo = base (1 - metallic), f0 = lerp(0.08 specular_level, base,
 *                        metallic), alpha = roughness^2, the rest as it is; a specular_level of 0 here is 0.5, and a
 *                        negative one 0.
 *                        SPECULAR_GLOSSINESS: alpha = (1 - glossiness)^2.
 *   coupled              the diffuse part is multiplied by 1 - F, per channel and light (not under ambient light).
 *   emission             radiance, negative is 0.
 *   streams              FACET_STREAM_ALBEDO and those after it: every batch brings these per sample, and the numbers
 *                        here are ignored. What the convention makes of others need not come, promised or not. Where
 *                        F0 is promised and ETA is not, DIELECTRIC's eta is f0's, per sample; where ETA is promised, f0
 *                        is not and all its numbers are 0, f0 is that of eta and k. */
typedef struct facet_material {
    struct { facet_diffuse model; float albedo[3], sigma; } diffuse;
    struct { facet_distribution model; facet_masking masking; float alpha, alpha_y, exponent, scale; } specular;
    struct { facet_fresnel model; float f0[3], f90, f82[3], eta[3], k[3], eta_outside, polarisation; } fresnel;
    struct { facet_convention model; float base[3], metallic, roughness, specular_level, glossiness; } convention;
    bool coupled;
    float emission[3];
    uint32_t streams;
} facet_material;

/* What other sources multiply D F G/(4 nl nv) by, for matching their pictures; neither conserves energy. */
#define FACET_SCALE_PI   1.27323954f   /* 4/pi: D F G/(pi nl nv), D with its 1/pi */
#define FACET_SCALE_1981 4.0f          /* the same as Cook and Torrance 1981 print it, D without its 1/pi */

/* The least alpha that the kernels see. */
#define FACET_ALPHA_FLOOR 1e-4f

/* The range of indices of refraction that they see. */
#define FACET_ETA_FLOOR 1e-3f
#define FACET_ETA_CAP   1e3f

/* The range of exponents. */
#define FACET_EXPONENT_MIN 1.0f
#define FACET_EXPONENT_MAX 1e4f

/* A material compiled for a target. Plain bytes without pointers: copy it, compare it with memcmp, keep it in flash.
 * It belongs to the library version that made it and runs only on CPUs that have facet_plan_target's architecture. */
typedef struct facet_plan {
    uint64_t opaque[64];
} facet_plan;

/* Compiles `material` for `target`. Validates everything; on refusal `*plan` is untouched and `*error` (may be NULL)
 * names the field. Takes about a microsecond, and up to 0.2 ms more where the fast tier fits an exact Fresnel term
 * (facet_plan_describe says how well). To ask an x86 CPU what it runs takes up to two cpuid instructions, which virtual
 * machines trap: some microseconds there, spared by target.arches. */
static inline facet_status facet_plan_init(facet_plan *plan, const facet_material *material, facet_target target,
                                           facet_error *error);

/* Writes what the plan does and why, a fact a line, as snprintf does: at most `size` bytes with the final 0, returns
 * the length without it. `text` may be NULL where `size` is 0. Returns 0 for what is not a plan. */
FACET_API size_t facet_plan_describe(const facet_plan *plan, char *text, size_t size);

/* What the plan was compiled for, with FACET_ARCH_BEST resolved and `arches` 0; all 0 for what is not a plan. */
FACET_API facet_target facet_plan_target(const facet_plan *plan);

/* ---- Shading --------------------------------------------------------------------------------------------------- */

typedef enum facet_light_kind {
    FACET_LIGHT_DIRECTIONAL = 0,
    FACET_LIGHT_POINT,           /* in every direction from a position */
    FACET_LIGHT_SPOT             /* the same within a cone */
} facet_light_kind;

/* A light. The uniform numbers must be finite; where a stream stands, they are ignored.
 *   direction      of a directional light: unit, from the surface to the light; all zero is refused.
 *   irradiance     W/m2 on a plane that faces the light, negative is 0; all zero is refused: leave the light out. Of
 *                  point and spot lights at a distance of 1, which is their radiant intensity in W/sr: what arrives is
 *                  irradiance/d2.
 *   position       of point and spot lights, in the units of facet_batch.position.
 *   range          a distance beyond which nothing arrives: times clamp(1 - (d/range)^4, 0, 1)^2; 0: no end.
 *   axis           of a spot light: unit, from the light along the cone's middle; all zero is refused.
 *   cos_inner, cos_outer: cosines of the angle to the axis, -1 <= cos_outer <= cos_inner <= 1. Full within the inner
 *                  cone and on it, nothing beyond the outer one, smoothstep of the cosine between them; where they are
 *                  equal, a step.
 *   direction_of, irradiance_of: direction and irradiance per sample (all three pointers or none); point and spot
 *                  lights take irradiance_of alone.
 *   visibility     per sample, clamped to [0, 1], multiplies the irradiance; NULL: 1. */
typedef struct facet_light {
    facet_light_kind kind;
    float direction[3], irradiance[3];
    float position[3], range;
    float axis[3], cos_inner, cos_outer;
    const float *direction_of[3], *irradiance_of[3], *visibility;
} facet_light;

enum {
    FACET_ACCUMULATE = 1 << 0,   /* add to radiance instead of overwriting it */
    FACET_TWO_SIDED  = 1 << 1    /* a normal that faces away from the eye is turned around; needs view */
};

/* A pinhole camera: v of pixel (column, row) is -ray/|ray|, ray = corner + column across + row down.
 *   corner      from the eye to the middle of pixel (0, 0).
 *   across, down: from a pixel's middle to the next one's to the right, and below.
 *   x, y        the pixel of the batch's first sample.
 *   width       pixels in each of the batch's rows: sample i is pixel (x + i % width, y + i/width); 0: all are in one.
 * Numbers must be finite, columns and rows below 2^20. A ray of 0 counts as a view that is not a number, and one
 * shorter than 1e-18 may; one longer than 1e18 sees 0. */
typedef struct facet_camera {
    float corner[3], across[3], down[3];
    uint32_t x, y, width;
} facet_camera;

/* Streams in fewer bytes, in sample order, each in the place of the floats that it stands for, whatever these pointers
 * and facet_batch.uniform say. Addresses are multiples of 4. Others may come as floats in the same batch.
 *   normal            x and y of an octahedral normal as snorm16 (integer/32767, -32768 is -1): normalize(x, y, z) with
 *                     z = 1 - |x| - |y|, where before, if z < 0, |x| and |y| each lose -z; Cigolle et al. 2014.
 *   albedo_roughness  R, G, B of albedo, or of base where the material promises it, and perceptual roughness, alpha =
 *                     roughness^2, as unorm8 (byte/255), linear. Of these what the material promises is taken.
 *   f0_sigma          R, G, B of f0, and sigma in parts of the largest that the model has, as unorm8. Likewise.
 *   camera            makes view; NULL: it is a stream.
 *   half              radiance goes there as IEEE 754 binary16, to nearest, at most 65504; not into `radiance`.
 *   pixels            and there as facet_encode has it: sRGB R, G, B, and 255. Both may be given; neither accumulates.
 *   exposure          multiplies the radiance of `pixels`; 0: 1. Finite, >= 0.
 * A build of some models (make MODELS=...) has packed streams where `packed` is among the words, and else refuses them
 * (MODEL). Streams of as many bytes a sample may be one another exactly, never a partial overlap. The error bounds hold
 * against what these formulas give of the packed numbers, but that rounding n and v to floats adds up to 3
 * 2^-24/(alpha vh) of what is specular, where a ray is not much shorter than the three vectors that it is the sum of;
 * rounding to halves or pixels comes on top. */
typedef struct facet_packed {
    const int16_t *normal;
    const uint8_t *albedo_roughness, *f0_sigma;
    const facet_camera *camera;
    uint16_t *half[3];
    uint8_t *pixels;
    float exposure;
} facet_packed;

/* n samples as streams. Pointers have a float's alignment, nothing more; streams hold `count` floats, or one where
 * `uniform` says so.
 *   normal         needed.
 *   view           needed but by diffuse none and Lambert without specular: where it is NULL nothing faces away.
 *   tangent        unit and perpendicular to the normal; needed by anisotropic distributions, else ignored.
 *   position       needed by point and spot lights, else ignored.
 *   occlusion      multiplies ambient and sh, clamped to [0, 1]; NULL: 1. Read only where they are given and there is
 *                  something diffuse to reflect them.
 *   albedo and those after it: needed where the plan's material promises them, else ignored.
 *   uniform        FACET_STREAM_*: those of the streams above that hold one value for the whole batch.
 *   lights         added in array order, starting from zero; then ambient, emission, and with FACET_ACCUMULATE the
 *                  destination. Two lights in one call and two calls differ by rounding alone.
 *   ambient        irradiance from everywhere, W/m2, negative is 0; every diffuse model reflects albedo/pi of it.
 *   sh             added to ambient: incident radiance, W/(m2 sr), as coefficients of the real spherical harmonics
 *                  Y00 = 0.282095, Y1 = 0.488603 (y, z, x) in this order, RGB each. Its irradiance
 *                  pi Y00 sh[0] + 2 pi/3 (Y1.n of sh[1..3]) counts as 0 where it is negative; Ramamoorthi and Hanrahan
 *                  2001. With FACET_TWO_SIDED, n is the turned normal.
 *   coverage       a bit a sample, least significant first, (count + 7)/8 bytes; NULL: all. Samples not covered are
 *                  neither counted nor written.
 *   radiance       may be one of the inputs, exactly; never a partial overlap. Not needed where `packed` takes it.
 *   packed         streams in fewer bytes.
 *   invalid        NULL, or raised by the number of covered samples that were not finite or had no normal. Counting
 *                  takes a slower kernel (README, Speed). */
typedef struct facet_batch {
    size_t count;
    const float *normal[3], *view[3], *tangent[3], *position[3], *occlusion;
    const float *albedo[3], *sigma, *alpha, *alpha_y, *exponent, *f0[3], *eta[3], *k[3];
    const float *base[3], *metallic, *roughness, *specular_level, *glossiness;
    uint32_t uniform;
    const facet_light *lights;
    size_t light_count;
    float ambient[3], sh[4][3];
    const uint8_t *coverage;
    float *radiance[3];
    uint32_t flags;
    size_t *invalid;
    facet_packed packed;
} facet_batch;

/* Shades `batch` by `plan`: radiance = sum over lights of f nl E, + albedo/pi ambient + emission.
 *
 * Refuses malformed arguments alone, before anything is written, by status (NULL, VALUE, ENUM, PLAN, SIZE) and field in
 * `*error` (may be NULL); data never fails. A sample's bytes depend on nothing
 * but its own values: not on its place, the count, the alignment or its neighbours. Results for special samples, where
 * the first row that applies holds, and what a parameter follows from counts as read:
 *   NaN in a value that is read, or an infinity where
 *   nothing bounds it; n = 0, or a tangent that is read
 *   and 0                                                  0, and counted in `invalid`
 *   nl <= 0 or nv <= 0                                     that light adds exactly 0
 *   v + l = 0                                              specular 0
 *   a point or spot light at distance 0, or whose squared
 *   distance is no normal float; beyond its range or outer
 *   cone, as far as rounding tells                         that light adds exactly 0
 *   r.v <= 0 under Phong, exp(-x) below 2^-126, a full
 *   Oren-Nayar sum below 0                                 that part adds exactly 0
 *   eta = eta_outside and k = 0                            the exact Fresnel terms are exactly 0
 *   beyond the critical angle                              the dielectric's is exactly 1
 *   k = 0 in a conductor                                   the dielectric's, within rounding
 *   a tangent that is not perpendicular to n               finite and >= 0, without a promise of accuracy
 *   a result that would overflow                           FLT_MAX
 *   vectors far from unit length                           finite and >= 0, without a promise of accuracy
 * Results for nl or nv below 2^-22 are finite; error bounds hold above. */
static inline facet_status facet_shade(const facet_plan *plan, const facet_batch *batch, facet_error *error);

/* ---- Encoding -------------------------------------------------------------------------------------------------- */

typedef enum facet_opacity {
    FACET_OPACITY_FULL = 0,      /* 255 */
    FACET_OPACITY_STREAM,        /* facet_image.opacity, clamped to [0, 1], rounded to nearest */
    FACET_OPACITY_COVERAGE       /* 255 where facet_image.coverage has the bit, else 0 */
} facet_opacity;

/* An image in linear radiance and its 8-bit sRGB pixels.
 *   radiance       streams of height rows, `stride` floats apart (0: width).
 *   exposure       multiplies the radiance; 0: 1. Finite, >= 0.
 *   opacity_from   where each pixel's fourth byte comes from.
 *   opacity        a stream laid out as radiance.
 *   coverage       a bit a sample, least significant first; sample x of row y is bit y stride + x.
 *   pixels         rows of width quadruples of bytes R, G, B, A, `pitch` bytes apart (0: 4 width); a negative pitch
 *                  with `pixels` at the last row's place in memory turns the picture upside down. */
typedef struct facet_image {
    size_t width, height;
    const float *radiance[3];
    size_t stride;
    float exposure;
    facet_opacity opacity_from;
    const float *opacity;
    const uint8_t *coverage;
    uint8_t *pixels;
    ptrdiff_t pitch;
} facet_image;

/* Encodes radiance times exposure (white is 1) by IEC 61966-2-1, correctly rounded: every byte is the one nearest to
 * the exact curve. NaN and negative give 0, 1 and above 255. Opacity is not premultiplied. The same bytes everywhere.
 * Refuses malformed arguments (NULL, VALUE, ENUM, SIZE; `error` may be NULL) before anything is written. */
static inline facet_status facet_encode(const facet_image *image, facet_error *error);

/* ---- Conversions ------------------------------------------------------------------------------------------------
 * Of single numbers, in float, within a few units in the last place (bounds: src/convert.c). What is outside a domain
 * is clamped to it, NaN to its lower end; every result is finite. The same bytes everywhere. */

/* Reflectance at normal incidence of a medium of index `eta` and extinction `k` in one of index `eta_outside`:
 * ((eta - eta_outside)^2 + k^2)/((eta + eta_outside)^2 + k^2). Born and Wolf, ch. 14. Domains as facet_material has
 * them; eta_outside 0: 1. */
FACET_API float facet_f0_from_eta(float eta, float k, float eta_outside);

/* The index, relative to the medium around it, of a dielectric that reflects f0 in [0, 1] at normal incidence:
 * (1 + sqrt f0)/(1 - sqrt f0), at most FACET_ETA_CAP. Cook and Torrance 1981. */
FACET_API float facet_eta_from_f0(float f0);

/* Perceptual roughness in [0, 1] and alpha: alpha = roughness^2. Burley 2012. */
FACET_API float facet_alpha_from_roughness(float roughness);
FACET_API float facet_roughness_from_alpha(float alpha);

/* The exponent of a Blinn-Phong lobe as wide as Beckmann's of this alpha, 2/alpha^2 - 2, and back: sqrt(2/(exponent +
 * 2)); Walter et al. 2007. Domains and results: [FACET_ALPHA_FLOOR, 1], and the exponents' range. A Phong lobe, about
 * the mirror direction, is as wide with a quarter of the exponent. */
FACET_API float facet_exponent_from_alpha(float alpha);
FACET_API float facet_alpha_from_exponent(float exponent);

/* Two conventions of artists' tools, all in [0, 1]; nothing has a default: a specular_level of 0 is 0. */
typedef struct facet_metallic_roughness {
    float base[3], metallic, roughness, specular_level;
} facet_metallic_roughness;

typedef struct facet_specular_glossiness {
    float diffuse[3], specular[3], glossiness;     /* albedo, f0, 1 - roughness */
} facet_specular_glossiness;

/* From one to the other. Every metallic-roughness has its specular-glossiness: diffuse = base (1 - metallic), specular
 * = lerp(0.08 specular_level, base, metallic). Back, it is a fit, exact to 1e-5 where there is an exact one. Of two
 * greys there are many: that of metallic 0 where specular is at most 0.04, or at most 0.08 over a diffuse of at most
 * 0.04; else that of specular_level 0.5, or of the next above it whose base is at most 1. Black diffuse has metallic 1
 * where specular has a colour or is above 0.08. */
FACET_API facet_specular_glossiness facet_to_specular_glossiness(facet_metallic_roughness from);
FACET_API facet_metallic_roughness facet_to_metallic_roughness(facet_specular_glossiness from);

/* ---- Metals ---------------------------------------------------------------------------------------------------- */

typedef enum facet_metal {
    FACET_METAL_ALUMINIUM = 0, FACET_METAL_CHROMIUM, FACET_METAL_COBALT, FACET_METAL_COPPER, FACET_METAL_GOLD,
    FACET_METAL_IRON, FACET_METAL_NICKEL, FACET_METAL_PLATINUM, FACET_METAL_SILVER, FACET_METAL_TITANIUM,
    FACET_METAL_TUNGSTEN
} facet_metal;

/* A metal's index and extinction for red, green and blue: facet_index_of_spectrum of what was measured (sources in
 * src/metals.def). ENUM where there is no such metal, NULL; nothing is written then. */
FACET_API facet_status facet_index_of_metal(facet_metal metal, float eta[3], float k[3]);

/* A spectrum as three bands: the mean of n and k, linear between the table's rows, over red 620-740 nm, green 495-570
 * and blue 450-495, weighted by exp(-(u - 1/2)^2), u in [0, 1] the place within the band. `wavelength` is in nm, > 0,
 * rising, and must reach from 450 to 740; n, k >= 0; `count` >= 2 rows. The same bytes everywhere. Refuses (NULL,
 * VALUE, with the row as index; `error` may be NULL) before anything is written. */
FACET_API facet_status facet_index_of_spectrum(const float *wavelength, const float *n, const float *k, size_t count,
                                               float eta[3], float extinction[3], facet_error *error);

/* ---- What the inline functions above call: sizes travel with the call, so that structs can grow ------------------
 * A smaller struct, of an older header, reads as if it went on with zeros; a larger one is refused where what this
 * library does not know is not zero. Lights stand in an array, and must have this library's size. */

FACET_API facet_status facet_plan_init_sized(facet_plan *plan, size_t plan_size, const facet_material *material,
                                             size_t material_size, const facet_target *target, size_t target_size,
                                             facet_error *error);
FACET_API facet_status facet_shade_sized(const facet_plan *plan, const facet_batch *batch, size_t batch_size,
                                         size_t light_size, facet_error *error);
FACET_API facet_status facet_encode_sized(const facet_image *image, size_t image_size, facet_error *error);

static inline facet_status facet_plan_init(facet_plan *plan, const facet_material *material, facet_target target,
                                           facet_error *error)
{
    return facet_plan_init_sized(plan, sizeof *plan, material, sizeof *material, &target, sizeof target, error);
}

static inline facet_status facet_shade(const facet_plan *plan, const facet_batch *batch, facet_error *error)
{
    return facet_shade_sized(plan, batch, sizeof *batch, sizeof(facet_light), error);
}

static inline facet_status facet_encode(const facet_image *image, facet_error *error)
{
    return facet_encode_sized(image, sizeof *image, error);
}

#ifdef __cplusplus
}
#endif

#endif
