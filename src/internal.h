/* What the library's files share: the plan's fields, the kernels' table, and which rows this build holds. */
#ifndef FACET_INTERNAL_H
#define FACET_INTERNAL_H

#include "facet.h"

#include <float.h>

#if FLT_EVAL_METHOD != 0
#error "facet needs float arithmetic in float: on i386, -msse2 -mfpmath=sse; elsewhere, -std=gnu11"
#endif

#define INV_PI     0.318309886f
#define FACET_PI_2 1.57079633f       /* the float nearest to pi/2: above it by 4.4e-8 */

/* FACET_HAS(name): 1 for a row of models.def that this build holds. FACET_BUILT(x): 1 where x is defined as 1. */
#define FACET_BUILT_COMMA_1 0,
#define FACET_BUILT_SECOND(a, b, ...) b
#define FACET_BUILT_2(junk_or_comma) FACET_BUILT_SECOND(junk_or_comma 1, 0, 0)
#define FACET_BUILT_1(value) FACET_BUILT_2(FACET_BUILT_COMMA_##value)
#define FACET_BUILT(macro) FACET_BUILT_1(macro)
#ifdef FACET_FILTERED
#define FACET_HAS(name) FACET_BUILT(FACET_WITH_##name)
#else
#define FACET_HAS(name) 1
#endif

/* Properties of a model (models.def). */
enum { VIEW = 1, TERMS = 2, F0 = 4, F90 = 8, RECIPROCAL = 16, CONSERVES = 32 };

/* The rows of models.def by name. */
enum {
#define FACET_DIFFUSE(id, name, word, sigma_max, properties, title)                                                   \
    DIFFUSE_##name = FACET_DIFFUSE_##id, DIFFUSE_PROPERTIES_##name = properties,
#define FACET_DISTRIBUTION(id, name, ...) DISTRIBUTION_##name = FACET_DISTRIBUTION_##id,
#define FACET_MASKING(id, name, ...) MASKING_##name = FACET_MASKING_##id,
#define FACET_FRESNEL(id, name, word, properties, title)                                                              \
    FRESNEL_##name = FACET_FRESNEL_##id, FRESNEL_PROPERTIES_##name = properties,
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

/* A masking under a distribution, by its row in models.def. */
enum visibility {
#define FACET_VISIBILITY(masking, distribution, properties) VISIBILITY_##masking##_##distribution,
#include "models.def"
    VISIBILITY_NONE
};

/* Architectures with FACET_ARCH_BEST, and tiers. */
enum {
    ARCH_COUNT = 1
#define FACET_ARCH(...) + 1
#include "arches.def"
    , TIER_COUNT = FACET_TIER_STRICT + 1
};

/* The components of the streams of streams.def: COMPONENT_NORMAL is the place of the normal's x. */
enum {
#define FACET_STREAM(id, field, components, ...)                                                                      \
    COMPONENT_##id, COMPONENT_##id##_LAST = COMPONENT_##id + components - 1,
#include "streams.def"
    COMPONENT_COUNT
};

/* What a facet_plan holds. Every number is as the kernels want it: clamped, derived, ready to be splatted. */
typedef struct __attribute__((may_alias)) plan_fields {
    uint32_t magic;                      /* PLAN_MAGIC; tells foreign bytes and byte order */
    uint8_t arch, tier;                  /* the kernel's id */
    uint8_t diffuse, distribution, masking, visibility, fresnel;
    uint8_t coupled, clamped_alpha, derived_f0;
    uint8_t needs_view, needs_f90;
    uint32_t promised, needed;           /* FACET_STREAM_*: of the material's; read by the kernel */
    float albedo[3], sigma, sigma_max, terms[2];   /* terms: A and B over pi */
    float alpha;
    float f0[3], f90;
    float emission[3];
} plan_fields;

#define PLAN_MAGIC (0xface0000u | FACET_VERSION_MAJOR << 8 | FACET_VERSION_MINOR)

/* One call of a kernel. */
typedef struct job {
    const plan_fields *plan;
    const float *component[COMPONENT_COUNT];   /* of a stream, or its one value; NULL: not read */
    uint32_t streams;                    /* FACET_STREAM_*: come from the batch */
    uint32_t uniform;                    /* FACET_STREAM_*: have one value */
    size_t count;
    const facet_light *lights;
    size_t light_count;
    float ambient[3];                    /* irradiance over pi */
    bool constant_radiance;              /* ambient or emission is not 0 */
    bool check_lights;                   /* a light has a stream, or an irradiance below 0 */
    const uint8_t *coverage;
    float *radiance[3];
    uint32_t flags;
    size_t *invalid;
} job;

typedef void kernel(const job *);

/* The kernel of an architecture and tier; NULL where the build lacks it. */
kernel *facet_kernel(facet_arch arch, facet_tier tier);

/* Whether these bytes can be a plan of this library: what the kernels index and switch by is in range. */
static inline bool plan_valid(const plan_fields *p)
{
    return p->magic == PLAN_MAGIC && p->arch < ARCH_COUNT && p->tier < TIER_COUNT && p->diffuse < DIFFUSE_ROWS
        && p->distribution < DISTRIBUTION_ROWS && p->masking < MASKING_ROWS && p->visibility <= VISIBILITY_NONE
        && p->fresnel < FRESNEL_ROWS && facet_kernel((facet_arch)p->arch, (facet_tier)p->tier);
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

/* Not isfinite: that is a library call on some compilers. */
static inline bool finite(float x) { return x - x == 0.0f; }

#endif
