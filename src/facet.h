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
    FACET_DIFFUSE_FUJII             /* Fujii's improved Oren-Nayar; sigma is its r in [0, 1], not an angle */
} facet_diffuse;

typedef enum facet_distribution {
    FACET_DISTRIBUTION_NONE = 0,
    FACET_DISTRIBUTION_GGX          /* Trowbridge and Reitz 1975; Walter et al. 2007 */
} facet_distribution;

typedef enum facet_masking {
    FACET_MASKING_SMITH_CORRELATED = 0,   /* 1/(1 + Lambda(nl) + Lambda(nv)): height-correlated; Heitz 2014, eq. 99 */
    FACET_MASKING_SMITH                   /* G1(nl) G1(nv): separable; Walter et al. 2007, eq. 23 */
} facet_masking;

typedef enum facet_fresnel {
    FACET_FRESNEL_SCHLICK = 0,   /* f0 + (f90 - f0)(1 - vh)^5; Schlick 1994 */
    FACET_FRESNEL_CONSTANT,      /* f0 at every angle */
    FACET_FRESNEL_ONE            /* 1 */
} facet_fresnel;

typedef enum facet_arch {
    FACET_ARCH_BEST = 0,         /* the best that this build has and this CPU runs */
    FACET_ARCH_SCALAR,
    FACET_ARCH_SSE2,
    FACET_ARCH_SSE41,
    FACET_ARCH_AVX2,             /* AVX2 and FMA */
    FACET_ARCH_AVX512,           /* AVX-512 F, VL, DQ, BW */
    FACET_ARCH_NEON              /* aarch64 */
} facet_arch;

typedef enum facet_tier {
    FACET_TIER_FAST = 0,         /* within the kernel's bound; bytes may differ from arch to arch */
    FACET_TIER_STRICT            /* the same bytes on every arch, compiler and CPU */
} facet_tier;

typedef struct facet_target {
    facet_arch arch;
    facet_tier tier;
} facet_target;

typedef enum facet_kind {
    FACET_KIND_DIFFUSE = 0, FACET_KIND_DISTRIBUTION, FACET_KIND_MASKING, FACET_KIND_FRESNEL,
    FACET_KIND_ARCH, FACET_KIND_TIER, FACET_KIND_STATUS
} facet_kind;

/* The word of an enumerator ("oren-nayar", "avx2"); NULL past the last, so that counting up from 0 lists a kind.
 * A constant string. For FACET_KIND_STATUS the word is a phrase. */
FACET_API const char *facet_word(facet_kind kind, int value);

/* The enumerator of a word, or -1. `word` may be NULL. */
FACET_API int facet_value(facet_kind kind, const char *word);

/* Whether this build holds the enumerator; for FACET_KIND_ARCH also whether this CPU runs it. */
FACET_API bool facet_has(facet_kind kind, int value);

/* What FACET_ARCH_BEST stands for on this CPU. */
FACET_API facet_arch facet_arch_best(void);

/* Lanes of an architecture's vectors: 1, 4, 8 or 16; 0 where the build lacks it. */
FACET_API int facet_arch_lanes(facet_arch arch);

/* "0.1.0": the library's, which may be newer than the header's. */
FACET_API const char *facet_version(void);

/* ---- Plans ----------------------------------------------------------------------------------------------------- */

/* Streams by name: what a material leaves to its batches (facet_material.streams) and what a batch gives as one value
 * for all its samples (facet_batch.uniform). */
enum {
    FACET_STREAM_NORMAL = 1 << 0,
    FACET_STREAM_VIEW   = 1 << 1,
    FACET_STREAM_ALBEDO = 1 << 2,
    FACET_STREAM_SIGMA  = 1 << 3,
    FACET_STREAM_ALPHA  = 1 << 4,
    FACET_STREAM_F0     = 1 << 5
};

/* A material: models and their parameters. Numbers must be finite; "negative is 0" and clamps hold alike for a number
 * here and for a stream's value.
 *   diffuse.albedo       [0, 1] per channel, negative is 0; above 1 is used as it is.
 *   diffuse.sigma        Oren-Nayar: standard deviation of the facets' slope angle, radians, [0, pi/2]. Fujii: r,
 *                        [0, 1]. Outside is refused here, clamped in a stream. At 0 these are Lambert, exactly.
 *   specular.alpha       roughness as it stands in D and G: (0, 1], clamped to [FACET_ALPHA_FLOOR, 1]; negative is
 *                        refused here. It is not the perceptual roughness, whose square it is.
 *   fresnel.f0           reflectance at normal incidence, clamped to [0, 1]. Where all three are 0 and eta is given,
 *                        ((eta - eta_outside)2 + k2)/((eta + eta_outside)2 + k2).
 *   fresnel.f90          Schlick's reflectance at grazing, clamped to [0, 1]; 0: 1.
 *   fresnel.eta, .k      index of refraction, > 0 in every channel once one is given, and extinction, >= 0.
 *   fresnel.eta_outside  index of the medium around it, > 0; 0: 1.
 *   coupled              the diffuse part is multiplied by 1 - F, per channel and light (not under ambient light).
 *   emission             radiance, negative is 0.
 *   streams              FACET_STREAM_ALBEDO, _SIGMA, _ALPHA, _F0: every batch brings these per sample, and the numbers
 *                        here are ignored. */
typedef struct facet_material {
    struct { facet_diffuse model; float albedo[3], sigma; } diffuse;
    struct { facet_distribution model; facet_masking masking; float alpha; } specular;
    struct { facet_fresnel model; float f0[3], f90, eta[3], k[3], eta_outside; } fresnel;
    bool coupled;
    float emission[3];
    uint32_t streams;
} facet_material;

/* The least alpha that the kernels see. */
#define FACET_ALPHA_FLOOR 1e-4f

/* A material compiled for a target. Plain bytes without pointers: copy it, compare it with memcmp, keep it in flash.
 * It belongs to the library version that made it and runs only on CPUs that have facet_plan_target's architecture. */
typedef struct facet_plan {
    uint64_t opaque[32];
} facet_plan;

/* Compiles `material` for `target`. Validates everything; on refusal `*plan` is untouched and `*error` (may be NULL)
 * names the field. Takes about a microsecond, and some more with FACET_ARCH_BEST, which asks the CPU. */
static inline facet_status facet_plan_init(facet_plan *plan, const facet_material *material, facet_target target,
                                           facet_error *error);

/* Writes what the plan does and why, a fact a line, as snprintf does: at most `size` bytes with the final 0, returns
 * the length without it. `text` may be NULL where `size` is 0. Returns 0 for what is not a plan. */
FACET_API size_t facet_plan_describe(const facet_plan *plan, char *text, size_t size);

/* What the plan was compiled for, with FACET_ARCH_BEST resolved; FACET_ARCH_BEST itself for what is not a plan. */
FACET_API facet_target facet_plan_target(const facet_plan *plan);

/* ---- Shading --------------------------------------------------------------------------------------------------- */

typedef enum facet_light_kind {
    FACET_LIGHT_DIRECTIONAL = 0
} facet_light_kind;

/* A light. The uniform numbers must be finite; where a stream stands, they are ignored.
 *   direction      unit, from the surface to the light; all zero is refused.
 *   irradiance     W/m2 on a plane that faces the light, negative is 0; all zero is refused: leave the light out.
 *   direction_of, irradiance_of: the same per sample (all three pointers or none).
 *   visibility     per sample, clamped to [0, 1], multiplies the irradiance; NULL: 1. */
typedef struct facet_light {
    facet_light_kind kind;
    float direction[3], irradiance[3];
    const float *direction_of[3], *irradiance_of[3], *visibility;
} facet_light;

enum {
    FACET_ACCUMULATE = 1 << 0,   /* add to radiance instead of overwriting it */
    FACET_TWO_SIDED  = 1 << 1    /* a normal that faces away from the eye is turned around; needs view */
};

/* n samples as streams. Pointers have a float's alignment, nothing more; streams hold `count` floats, or one where
 * `uniform` says so.
 *   normal         needed.
 *   view           needed but by diffuse none and Lambert without specular: where it is NULL nothing faces away.
 *   albedo, sigma, alpha, f0: needed where the plan's material promises them, else ignored.
 *   uniform        FACET_STREAM_*: those of the streams above that hold one value for the whole batch.
 *   lights         added in array order, starting from zero; then ambient, emission, and with FACET_ACCUMULATE the
 *                  destination. Two lights in one call and two calls differ by rounding alone.
 *   ambient        irradiance from everywhere, W/m2, negative is 0; every diffuse model reflects albedo/pi of it.
 *   coverage       a bit a sample, least significant first, (count + 7)/8 bytes; NULL: all. Samples not covered are
 *                  neither counted nor written.
 *   radiance       may be one of the inputs, exactly; never a partial overlap.
 *   invalid        NULL, or raised by the number of covered samples that were not finite or had no normal. Counting
 *                  takes the generic kernel where a specialised one would do (README, Speed). */
typedef struct facet_batch {
    size_t count;
    const float *normal[3], *view[3];
    const float *albedo[3], *sigma, *alpha, *f0[3];
    uint32_t uniform;
    const facet_light *lights;
    size_t light_count;
    float ambient[3];
    const uint8_t *coverage;
    float *radiance[3];
    uint32_t flags;
    size_t *invalid;
} facet_batch;

/* Shades `batch` by `plan`: radiance = sum over lights of f nl E, + albedo/pi ambient + emission.
 *
 * Refuses malformed arguments alone, before anything is written, by status (NULL, VALUE, ENUM, PLAN, SIZE) and field in
 * `*error` (may be NULL); data never fails. A sample's bytes depend on nothing
 * but its own values: not on its place, the count, the alignment or its neighbours. Results for special samples, where
 * the first row that applies holds:
 *   NaN or infinity in a value that is read, or n = 0      0, and counted in `invalid`
 *   nl <= 0 or nv <= 0                                     that light adds exactly 0
 *   v + l = 0                                              specular 0
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

/* ---- What the inline functions above call: sizes travel with the call, so that structs can grow ------------------
 * A smaller struct, of an older header, reads as if it went on with zeros; a larger one is refused where what this
 * library does not know is not zero. Lights stand in an array, and must have this library's size. */

FACET_API facet_status facet_plan_init_sized(facet_plan *plan, size_t plan_size, const facet_material *material,
                                             size_t material_size, facet_target target, facet_error *error);
FACET_API facet_status facet_shade_sized(const facet_plan *plan, const facet_batch *batch, size_t batch_size,
                                         size_t light_size, facet_error *error);
FACET_API facet_status facet_encode_sized(const facet_image *image, size_t image_size, facet_error *error);

static inline facet_status facet_plan_init(facet_plan *plan, const facet_material *material, facet_target target,
                                           facet_error *error)
{
    return facet_plan_init_sized(plan, sizeof *plan, material, sizeof *material, target, error);
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
