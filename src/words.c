/* Enumerators by word: facet_word, facet_value, facet_has, and what else the public header asks about the build. */
#include "cpu.h"

typedef struct { const char *word; bool built; } row;

static const row diffuse_rows[] = {
#define FACET_DIFFUSE(id, name, word, ...) [FACET_DIFFUSE_##id] = { word, FACET_HAS(name) },
#include "models.def"
};
static const row distribution_rows[] = {
#define FACET_DISTRIBUTION(id, name, word, ...) [FACET_DISTRIBUTION_##id] = { word, FACET_HAS(name) },
#include "models.def"
};
static const row masking_rows[] = {
#define FACET_MASKING(id, name, word, ...) [FACET_MASKING_##id] = { word, FACET_HAS(name) },
#include "models.def"
};
static const row fresnel_rows[] = {
#define FACET_FRESNEL(id, name, word, ...) [FACET_FRESNEL_##id] = { word, FACET_HAS(name) },
#include "models.def"
};
static const row convention_rows[] = {
    [FACET_CONVENTION_DIRECT] = { "direct", true },
    [FACET_CONVENTION_METALLIC_ROUGHNESS] = { "metallic-roughness", true },
    [FACET_CONVENTION_SPECULAR_GLOSSINESS] = { "specular-glossiness", true },
};
static const row light_rows[] = {
    [FACET_LIGHT_DIRECTIONAL] = { "directional", true },
    [FACET_LIGHT_POINT] = { "point", true },
    [FACET_LIGHT_SPOT] = { "spot", true },
};
static const row metal_rows[] = {
#define FACET_METAL(id, name, word, ...) [FACET_METAL_##id] = { word, true },
#include "metals.def"
};
static const row arch_rows[] = {
    [FACET_ARCH_BEST] = { "best", true },
#define FACET_ARCH(id, name, word, needs, lanes) [FACET_ARCH_##id] = { word, FACET_BUILT(FACET_ARCH_##name) },
#include "arches.def"
};
static const row tier_rows[] = {
    [FACET_TIER_FAST] = { "fast", FACET_BUILT(FACET_TIER_fast) },
    [FACET_TIER_STRICT] = { "strict", FACET_BUILT(FACET_TIER_strict) },
};
static const row status_rows[] = {
    [FACET_OK] = { "no error", true },
    [FACET_ERROR_NULL] = { "a pointer that is needed is NULL", true },
    [FACET_ERROR_VALUE] = { "a number is NaN, infinite or outside its domain", true },
    [FACET_ERROR_ENUM] = { "no such enumerator, or an unknown flag bit", true },
    [FACET_ERROR_MODEL] = { "this build lacks the model, or the models do not go together", true },
    [FACET_ERROR_ARCH] = { "the architecture or tier is not in this build or not on this CPU", true },
    [FACET_ERROR_PLAN] = { "not a plan of this version of the library", true },
    [FACET_ERROR_SIZE] = { "a struct of a newer header uses what this library does not know", true },
};

/* Every enumerator has a row: the highest index is their number less one. (-Wswitch finds one missing at the end.) */
#define COUNT(rows) (sizeof rows / sizeof rows[0])
_Static_assert(COUNT(diffuse_rows) == DIFFUSE_ROWS && COUNT(distribution_rows) == DISTRIBUTION_ROWS
               && COUNT(masking_rows) == MASKING_ROWS && COUNT(fresnel_rows) == FRESNEL_ROWS, "models.def lacks a row");

static const struct { const row *rows; int count; } kinds[] = {
#define KIND(id, rows) [FACET_KIND_##id] = { rows, (int)COUNT(rows) }
    KIND(DIFFUSE, diffuse_rows), KIND(DISTRIBUTION, distribution_rows), KIND(MASKING, masking_rows),
    KIND(FRESNEL, fresnel_rows), KIND(CONVENTION, convention_rows), KIND(LIGHT, light_rows), KIND(METAL, metal_rows),
    KIND(ARCH, arch_rows), KIND(TIER, tier_rows), KIND(STATUS, status_rows),
};

static const row *find(facet_kind kind, int value)
{
    if ((unsigned)kind >= COUNT(kinds) || value < 0 || value >= kinds[kind].count) return 0;
    return &kinds[kind].rows[value];
}

const char *facet_word(facet_kind kind, int value)
{
    const row *r = find(kind, value);
    return r ? r->word : 0;
}

static bool same(const char *a, const char *b)
{
    while (*a && *a == *b) a++, b++;
    return *a == *b;
}

int facet_value(facet_kind kind, const char *word)
{
    const row *r;
    for (int value = 0; word && (r = find(kind, value)); value++)
        if (same(r->word, word)) return value;
    return -1;
}

bool facet_has(facet_kind kind, int value)
{
    const row *r = find(kind, value);
    return r && r->built && (kind != FACET_KIND_ARCH || value == FACET_ARCH_BEST || facet_arches_among(1u << value));
}

int facet_arch_lanes(facet_arch arch)
{
    static const int arch_lanes[ARCH_COUNT] = {
#define FACET_ARCH(id, name, word, needs, lanes) [FACET_ARCH_##id] = lanes,
#include "arches.def"
    };
    const row *r = find(FACET_KIND_ARCH, (int)arch);
    return r && r->built ? arch_lanes[arch] : 0;
}

#define STRING(x) STRING_OF(x)
#define STRING_OF(x) #x

const char *facet_version(void)
{
    return STRING(FACET_VERSION_MAJOR) "." STRING(FACET_VERSION_MINOR) "." STRING(FACET_VERSION_PATCH);
}
