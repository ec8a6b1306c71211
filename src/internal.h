/* What the library's files share: the plan's fields, the kernels' table, and which rows this build holds. */
#ifndef FACET_INTERNAL_H
#define FACET_INTERNAL_H

#include "facet.h"
#include "fit.h"

#include <float.h>

#if FLT_EVAL_METHOD != 0
#error "facet needs float arithmetic in float: on i386, -msse2 -mfpmath=sse; elsewhere, -std=gnu11"
#endif

#define INV_PI 0.318309886f

/* 32 bits of anything; two of them. */
typedef uint32_t __attribute__((may_alias)) bits32;
typedef uint64_t __attribute__((may_alias, aligned(4))) bits64;

/* FACET_HAS(name): 1 for a row of models.def that this build holds. FACET_BUILT(x): 1 where x is defined as 1. */
#define FACET_BUILT_COMMA_1 0,
#define FACET_BUILT_SECOND(a, b, ...) b
#define FACET_BUILT_2(junk_or_comma) FACET_BUILT_SECOND(junk_or_comma 1, 0, 0)
#define FACET_BUILT_1(value) FACET_BUILT_2(FACET_BUILT_COMMA_##value)
#define FACET_BUILT(macro) FACET_BUILT_1(macro)
#define FACET_WITH_fitted_dielectric FACET_WITH_dielectric
#define FACET_WITH_fitted_conductor FACET_WITH_conductor
#ifdef FACET_FILTERED
#define FACET_HAS(name) FACET_BUILT(FACET_WITH_##name)
#else
#define FACET_HAS(name) 1
#endif

#include "models.def"    /* the properties of models */

/* The rows of models.def by name. */
enum {
#define FACET_DIFFUSE(id, name, word, reads, properties, ...)                                                         \
    DIFFUSE_##name = FACET_DIFFUSE_##id, DIFFUSE_READS_##name = reads, VIEWED_##name = (properties) & VIEWED,
#define FACET_DISTRIBUTION(id, name, word, reads, ...)                                                                \
    DISTRIBUTION_##name = FACET_DISTRIBUTION_##id, DISTRIBUTION_READS_##name = reads,
#define FACET_MASKING(id, name, ...) MASKING_##name = FACET_MASKING_##id,
#define FACET_FRESNEL(id, name, word, reads, ...)                                                                     \
    FRESNEL_##name = FACET_FRESNEL_##id, FRESNEL_READS_##name = reads,
#include "models.def"
};

/* The streams that this build's kernels may read: a constant, so that one of few models holds no code for others. */
enum {
    READABLE = FACET_STREAM_NORMAL | FACET_STREAM_VIEW | FACET_STREAM_POSITION | FACET_STREAM_OCCLUSION
#define READABLE_ROW(name, reads) | (FACET_HAS(name) ? reads : 0)
#define FACET_DIFFUSE(id, name, word, reads, ...) READABLE_ROW(name, (reads))
#define FACET_DISTRIBUTION FACET_DIFFUSE
#define FACET_FRESNEL      FACET_DIFFUSE
#include "models.def"
};

/* How many rows there are. */
enum {
#define FACET_DIFFUSE(...) + 1
    DIFFUSE_ROWS = 0
#include "models.def"
#define FACET_DISTRIBUTION(...) + 1
    , DISTRIBUTION_ROWS = 0
#include "models.def"
#define FACET_MASKING(...) + 1
    , MASKING_ROWS = 0
#include "models.def"
#define FACET_FRESNEL(...) + 1
    , FRESNEL_ROWS = 0
#include "models.def"
};

/* A masking under a distribution, by its row in models.def; a lobe has none. */
enum visibility {
#define FACET_VISIBILITY(masking, distribution, properties) VISIBILITY_##masking##_##distribution,
#include "models.def"
    VISIBILITY_NONE
};

/* Which of a plan's fits a Fresnel term takes: none, one for all channels, three. */
enum {
#define FACET_FRESNEL(id, name, ...) FITS_##name = 0,
#include "models.def"
    FITS_none = 0, FITS_fitted_dielectric = 1, FITS_fitted_conductor = 3
};

/* What special.def names beside the rows of models.def: the lack of a specular part, fitted terms. */
enum {
    MASKING_none = 0, VISIBILITY_none_none = VISIBILITY_NONE, FRESNEL_none = 0, FRESNEL_READS_none = 0,
    FRESNEL_fitted_dielectric = FACET_FRESNEL_DIELECTRIC, FRESNEL_READS_fitted_dielectric = 0,
    FRESNEL_fitted_conductor = FACET_FRESNEL_CONDUCTOR, FRESNEL_READS_fitted_conductor = 0
};

enum {
    SPECIAL_NONE,
#define FACET_SPECIAL(name, ...) SPECIAL_##name,
#include "special.def"
};

/* Architectures with FACET_ARCH_BEST, and tiers. */
enum {
    ARCH_COUNT = 1
#define FACET_ARCH(...) + 1
#include "arches.def"
    , TIER_COUNT = FACET_TIER_STRICT + 1
};

/* The streams of streams.def: their number, and the places of their components: COMPONENT_NORMAL is the normal's x. */
enum {
#define FACET_STREAM(id, ...) STREAM_##id,
#include "streams.def"
    STREAM_COUNT
};
enum {
#define FACET_STREAM(id, field, components, ...)                                                                      \
    COMPONENT_##id, COMPONENT_##id##_LAST = COMPONENT_##id + components - 1,
#include "streams.def"
    COMPONENT_COUNT
};

/* The place of every stream's components. */
static const struct { uint8_t first, components; } places[STREAM_COUNT] __attribute__((unused)) = {
#define FACET_STREAM(id, field, components, ...) { COMPONENT_##id, components },
#include "streams.def"
};

/* The streams that most batches have; their NaNs and infinities show in the result (features.shows). */
#define COMMON_STREAMS                                                                                                \
    ((uint32_t)(FACET_STREAM_NORMAL | FACET_STREAM_VIEW | FACET_STREAM_ALBEDO | FACET_STREAM_SIGMA                    \
                | FACET_STREAM_ALPHA | FACET_STREAM_F0))

/* Numbers of the material that came from others. */
enum { F0_FROM_ETA = 1, ETA_FROM_F0 = 2, F82_FROM_ETA = 4 };

/* What a facet_plan holds. Every number is as the kernels want it: clamped, derived, ready to be splatted. The numbers
 * of streams are under the streams' names. */
typedef struct __attribute__((may_alias)) plan_fields {
    uint32_t sum;                        /* plan_sum: tells foreign bytes, another version, another byte order */
    union {
        uint32_t rows[4];
        struct {
            uint8_t arch, tier;          /* the kernel's id */
            uint8_t diffuse, distribution, masking, visibility, fresnel, convention;
            uint8_t coupled, clamped_alpha, number_from;   /* *_FROM_* */
            uint8_t fresnel_properties;
            uint8_t fits;                /* 0: the exact term is evaluated; 1: the three of `fit` are equal; 3 */
            uint8_t special;             /* SPECIAL_NAME: the row of special.def */
            uint8_t unscaled;            /* scale and f90 are 1, as that row has them for plain batches */
            uint8_t emits;
        };
    };
    uint32_t promised;                   /* FACET_STREAM_*: by the material */
    uint32_t needed;                     /* read by the models */
    uint32_t derived;                    /* of these, made by the kernel from ... */
    uint32_t sources;                    /* ... these */
    float albedo[3], sigma, alpha, alpha_y, exponent, f0[3], eta[3], k[3];
    float base[3], metallic, roughness, specular_level, glossiness;
    float sigma_max, terms[4];           /* terms: what models.tmpl.h makes of sigma */
    float scale, f90, f82[3], eta_outside, polarisation;
    float emission[3];
    fresnel_fit fit[3];
    float fit_error;                     /* the largest of their bounds; relative */
} plan_fields;

/* Whether index or extinction are the batch's, or made by the kernel. */
static inline bool index_per_sample(const plan_fields *p)
{
    return (p->promised | p->derived) & p->needed & (FACET_STREAM_ETA | FACET_STREAM_K);
}

/* The most pixels that a camera sees along its axes. */
#define PIXELS ((size_t)1 << 20)

/* What of a batch may come packed. */
enum {
    PACKED_ALBEDO_ROUGHNESS = FACET_STREAM_ALBEDO | FACET_STREAM_BASE | FACET_STREAM_ALPHA | FACET_STREAM_ROUGHNESS
                            | FACET_STREAM_GLOSSINESS,
    PACKED_F0_SIGMA = FACET_STREAM_F0 | FACET_STREAM_SIGMA,
    PACKABLE = FACET_STREAM_NORMAL | FACET_STREAM_VIEW | PACKED_ALBEDO_ROUGHNESS | PACKED_F0_SIGMA
};

#define PLAN_MAGIC (0xface0000u | FACET_VERSION_MAJOR << 8 | FACET_VERSION_MINOR)

/* One call of a kernel. */
typedef struct job {
    const plan_fields *plan;
    const float *const *component;       /* of a stream that is read, or its one value: the batch's, or `own` */
    const float *own[COMPONENT_COUNT];
    size_t mask[COMPONENT_COUNT];        /* sample i stands at i & mask; the kernel's, beside `own` */
    bool dense;                          /* every stream has a value per sample, none is derived or packed */
    uint32_t streams;                    /* FACET_STREAM_*: are read: from the batch or, if uniform, from the plan */
    uint32_t uniform;                    /* of these, have one value */
    uint32_t given;                      /* of these, come from the batch */
    uint32_t unpacked;                   /* of these, come packed */
    const facet_packed *packed;
    size_t count;
    const facet_light *lights;
    size_t light_count;
    float ambient[3], sh[4][3];          /* irradiance over pi: everywhere; 1, y, z, x of the normal */
    bool has_ambient, has_sh;
    bool check_lights;                   /* a light is not directional, has a stream, or an irradiance below 0 */
    const uint8_t *coverage;
    float *const *radiance;
    bool packs;                          /* radiance goes into packed->half, packed->pixels */
    uint32_t flags;
    size_t *invalid;
} job;

typedef void kernel(job *);

/* The kernel of an architecture and tier; NULL where the build lacks it. */
kernel *facet_kernel(facet_arch arch, facet_tier tier);

/* What a plan's first words add up to, each times an odd constant: another byte anywhere is another sum. */
static inline uint32_t plan_sum(const plan_fields *p)
{
    return PLAN_MAGIC + p->rows[0] * 0x9e3779b1u + p->rows[1] * 0x85ebca6bu + p->rows[2] * 0xc2b2ae35u
         + p->rows[3] * 0x2545f491u + p->promised * 0x27d4eb2fu + p->needed * 0x165667b1u + p->derived * 0xd3a2646du
         + p->sources * 0xfd7046c5u;
}

/* The plan's kernel; NULL where these bytes are no plan of this library, as facet_plan_init made it, or its kernel is
 * not here. */
static inline kernel *plan_kernel(const plan_fields *p)
{
    return p->sum == plan_sum(p) ? facet_kernel((facet_arch)p->arch, (facet_tier)p->tier) : 0;
}

static inline facet_status refuse(facet_error *error, facet_status code, const char *field, int index)
{
    if (error) *error = (facet_error){ code, field, index };
    return code;
}

/* A struct of a header that is older or newer than this file: copies what both know, zeroes the rest. False where the
 * newer one uses a field that is not known here. */
static inline bool adopt(void *ours, size_t our_size, const void *theirs, size_t their_size)
{
    unsigned char *to = ours;
    const unsigned char *from = theirs;
    for (size_t i = 0; i < our_size; i++) to[i] = i < their_size ? from[i] : 0;
    for (size_t i = our_size; i < their_size; i++)
        if (from[i]) return false;
    return true;
}

/* A byte of a pixel, which facet_encode makes of radiance times exposure; 0 of NaN. */
uint8_t facet_srgb_byte(float x);

/* Not isfinite: that is a library call on some compilers. */
static inline bool finite(float x) { return x - x == 0.0f; }

#endif
