#include "model_words.h"

#include <ctype.h>
#include <stdio.h>
#include <string.h>

/* Its properties, before its rows. */
#include "models.def"

/* ---- Models ---------------------------------------------------------------------------------------------------- */

static const model models[] = {
#define FACET_DIFFUSE(id, name, word, reads, properties, sigma_max, title)                                            \
    {FACET_KIND_DIFFUSE, FACET_DIFFUSE_##id, reads, properties, sigma_max, title},
#define FACET_DISTRIBUTION(id, name, word, reads, properties, title)                                                  \
    {FACET_KIND_DISTRIBUTION, FACET_DISTRIBUTION_##id, reads, properties, 0, title},
#define FACET_MASKING(id, name, word, title) {FACET_KIND_MASKING, FACET_MASKING_##id, 0, 0, 0, title},
#define FACET_FRESNEL(id, name, word, reads, properties, title)                                                       \
    {FACET_KIND_FRESNEL, FACET_FRESNEL_##id, reads, properties, 0, title},
#include "models.def"
    {FACET_KIND_CONVENTION, FACET_CONVENTION_DIRECT, 0, 0, 0, "albedo, alpha and F0 as they are"},
    {FACET_KIND_CONVENTION, FACET_CONVENTION_METALLIC_ROUGHNESS,
     FACET_STREAM_BASE | FACET_STREAM_METALLIC | FACET_STREAM_ROUGHNESS | FACET_STREAM_SPECULAR_LEVEL, 0, 0,
     "in place of albedo, alpha and F0"},
    {FACET_KIND_CONVENTION, FACET_CONVENTION_SPECULAR_GLOSSINESS, FACET_STREAM_GLOSSINESS, 0, 0,
     "in place of alpha"},
};

/* The kind of a light stands in `reads` as a bit of its own. */
#define LIGHT(kind) (1u << FACET_LIGHT_##kind)

model model_of(facet_kind kind, int value)
{
    if (kind == FACET_KIND_LIGHT)
        return (model){.kind = kind, .value = value, .reads = 1u << value, .title = ""};
    for (size_t i = 0; i < sizeof models / sizeof *models; i++)
        if (models[i].kind == kind && models[i].value == value)
            return models[i];
    return (model){.kind = kind, .value = value, .title = ""};
}

uint32_t convention_replaces(facet_convention convention)
{
    switch (convention) {
    case FACET_CONVENTION_METALLIC_ROUGHNESS: return FACET_STREAM_ALBEDO | FACET_STREAM_ALPHA | FACET_STREAM_F0;
    case FACET_CONVENTION_SPECULAR_GLOSSINESS: return FACET_STREAM_ALPHA;
    default: return 0;
    }
}

/* ---- Quantities ------------------------------------------------------------------------------------------------ */

/* Belongs to the models of `kind` that read all of `reads`, nothing of `but`, and have the property if it names one. */
typedef struct quantity {
    facet_kind kind;
    uint32_t reads, but;
    int property;
    const char *name;
    int parts;
    enum { NEEDED, OPTIONAL, VECTOR } use;   /* VECTOR: needed, and one number does not stand for all parts */
    limits limits;                 /* 0, 0: those of the model's sigma */
    size_t offset;                 /* in facet_material or light_numbers */
} quantity;

#define OF(kind, reads, but, property) FACET_KIND_##kind, reads, but, property
#define TO(field) offsetof(facet_material, field)
#define TO_LIGHT(field) offsetof(light_numbers, field)
#define INDEX {FACET_ETA_FLOOR, FACET_ETA_CAP}

/* In the order in which they stand behind a word. */
static const quantity quantities[] = {
    {OF(DIFFUSE, FACET_STREAM_SIGMA, 0, 0), "SIGMA", 1, NEEDED, {0, 0}, TO(diffuse.sigma)},
    {OF(DISTRIBUTION, FACET_STREAM_ALPHA, FACET_STREAM_ALPHA_Y, 0), "ALPHA", 1, NEEDED, {FACET_ALPHA_FLOOR, 1},
     TO(specular.alpha)},
    {OF(DISTRIBUTION, FACET_STREAM_ALPHA | FACET_STREAM_ALPHA_Y, 0, 0), "ALPHA,ALPHA_Y", 2, NEEDED,
     {FACET_ALPHA_FLOOR, 1}, TO(specular.alpha)},
    {OF(DISTRIBUTION, FACET_STREAM_EXPONENT, 0, 0), "EXPONENT", 1, NEEDED, {FACET_EXPONENT_MIN, FACET_EXPONENT_MAX},
     TO(specular.exponent)},
    {OF(FRESNEL, FACET_STREAM_F0, 0, 0), "F0", 3, NEEDED, {0, 1}, TO(fresnel.f0)},
    {OF(FRESNEL, 0, 0, F82), "F82", 3, NEEDED, {0, 1}, TO(fresnel.f82)},
    {OF(FRESNEL, FACET_STREAM_ETA, 0, 0), "ETA", 3, NEEDED, INDEX, TO(fresnel.eta)},
    {OF(FRESNEL, FACET_STREAM_K, 0, 0), "K", 3, NEEDED, {0, FACET_ETA_CAP}, TO(fresnel.k)},
    {OF(FRESNEL, 0, 0, F90), "F90", 1, OPTIONAL, {0, 1}, TO(fresnel.f90)},
    {OF(FRESNEL, 0, 0, MEDIA), "OUTSIDE", 1, OPTIONAL, INDEX, TO(fresnel.eta_outside)},
    {OF(CONVENTION, FACET_STREAM_BASE, 0, 0), "BASE", 3, NEEDED, {0, 1}, TO(convention.base)},
    {OF(CONVENTION, FACET_STREAM_METALLIC, 0, 0), "METALLIC", 1, NEEDED, {0, 1}, TO(convention.metallic)},
    {OF(CONVENTION, FACET_STREAM_ROUGHNESS, 0, 0), "ROUGHNESS", 1, NEEDED, {0, 1}, TO(convention.roughness)},
    {OF(CONVENTION, FACET_STREAM_SPECULAR_LEVEL, 0, 0), "LEVEL", 1, OPTIONAL, {0, 1}, TO(convention.specular_level)},
    {OF(CONVENTION, FACET_STREAM_GLOSSINESS, 0, 0), "GLOSSINESS", 1, NEEDED, {0, 1}, TO(convention.glossiness)},
    {OF(LIGHT, 0, 0, 0), "X,Y,Z", 3, VECTOR, {-1e6f, 1e6f}, TO_LIGHT(place)},
    {OF(LIGHT, LIGHT(SPOT), 0, 0), "AXIS", 3, VECTOR, {-1e6f, 1e6f}, TO_LIGHT(axis)},
    {OF(LIGHT, LIGHT(SPOT), 0, 0), "INNER,OUTER", 2, VECTOR, {0, 180}, TO_LIGHT(cone)},
    {OF(LIGHT, 0, 0, 0), "E", 3, OPTIONAL, {0, 1e12f}, TO_LIGHT(irradiance)},
    {OF(LIGHT, 0, LIGHT(DIRECTIONAL), 0), "RANGE", 1, OPTIONAL, {1e-6f, 1e6f}, TO_LIGHT(range)},
};

_Static_assert(TO(specular.alpha_y) == TO(specular.alpha) + sizeof(float), "ALPHA,ALPHA_Y are read as one vector");

enum { QUANTITIES = sizeof quantities / sizeof *quantities };

/* Where 0 stands for a default, a negative number is 0. */
static bool zero_is_default(const quantity *q)
{
    return q->property == F90 || q->reads == FACET_STREAM_SPECULAR_LEVEL;
}

static bool has(const model *m, const quantity *q)
{
    return q->kind == m->kind && (m->reads & q->reads) == q->reads && !(m->reads & q->but) &&
           (!q->property || m->properties & q->property);
}

/* The first quantity of a model from `q` on, or NULL. */
static const quantity *from(const model *m, const quantity *q)
{
    while (q < quantities + QUANTITIES && !has(m, q))
        q++;
    return q < quantities + QUANTITIES ? q : NULL;
}

static limits limits_of(const model *m, const quantity *q)
{
    return q->limits.most > 0 ? q->limits : (limits){0, m->sigma_max};
}

uint32_t model_streams(facet_kind kind)
{
    uint32_t streams = 0;
    for (const quantity *q = quantities; q < quantities + QUANTITIES; q++)
        streams |= q->kind == kind ? q->reads : 0;
    return streams;
}

void model_forget(facet_kind kind, facet_material *material)
{
    for (const quantity *q = quantities; q < quantities + QUANTITIES; q++)
        if (q->kind == kind && kind != FACET_KIND_LIGHT)
            memset((char *)material + q->offset, 0, (size_t)q->parts * sizeof(float));
}

bool model_takes_f82(const model *m)
{
    return m->properties & F82;
}

bool model_takes_metal(const model *m)
{
    return m->kind == FACET_KIND_FRESNEL && m->reads & (FACET_STREAM_F0 | FACET_STREAM_K);
}

void model_set_metal(facet_material *material, facet_metal metal)
{
    memset(material->fresnel.f0, 0, sizeof material->fresnel.f0);
    memset(material->fresnel.f82, 0, sizeof material->fresnel.f82);
    facet_index_of_metal(metal, material->fresnel.eta, material->fresnel.k);
}

/* ---- Reading --------------------------------------------------------------------------------------------------- */

void model_form(const model *m, bool metal, char *text, size_t size)
{
    const char *separator = metal ? "/" : ":";
    size_t used = (size_t)snprintf(text, size, "%s%s", facet_word(m->kind, m->value), metal ? ":METAL" : "");
    int open = 0;
    for (const quantity *q = from(m, quantities); q && used < size; q = from(m, q + 1), separator = "/") {
        bool optional = q->use == OPTIONAL;
        if (metal && !optional)
            continue;
        used += (size_t)snprintf(text + used, size - used, "%s%s%s", optional ? "[" : "", separator, q->name);
        open += optional;
    }
    for (; open && used < size; open--)
        used += (size_t)snprintf(text + used, size - used, "]");
}

/* Says which form the numbers have, and the limits of what is wrong, or the metals. */
static bool refuse(const model *m, const quantity *wrong, const setting *s, const char *whole)
{
    char allowed[480], metal[120], names[240];
    model_form(m, false, allowed, sizeof allowed);
    size_t used = strlen(allowed);
    if (wrong)
        used += (size_t)snprintf(allowed + used, sizeof allowed - used, ", %s from %.7g to %.7g", wrong->name,
                                 (double)limits_of(m, wrong).least, (double)limits_of(m, wrong).most);
    if (model_takes_metal(m)) {
        model_form(m, true, metal, sizeof metal);
        list_words(names, sizeof names, FACET_KIND_METAL);
        snprintf(allowed + used, sizeof allowed - used, "; or %s: %s", metal, names);
    }
    return setting_refuse(s, whole, allowed);
}

/* Reads the numbers of one quantity. Returns what follows them, or NULL. */
static const char *read_quantity(const model *m, const quantity *q, const char *text, void *into)
{
    float value[3];
    const char *end = (q->use == VECTOR ? parse_numbers : parse_parts)(text, q->parts, value);
    if (!end || (*end && *end != '/') || !within(value, q->parts, limits_of(m, q)))
        return NULL;
    if (value[0] == 0 && zero_is_default(q))
        value[0] = -1;
    memcpy((char *)into + q->offset, value, (size_t)q->parts * sizeof *value);
    return end;
}

/* The quantities from `q` on: those that are needed come first. */
static bool read_quantities(const model *m, const quantity *q, const char *text, void *into, const setting *s,
                            const char *whole)
{
    for (; q && (text || q->use != OPTIONAL); q = from(m, q + 1)) {
        const char *end = text ? read_quantity(m, q, text, into) : NULL;
        if (!end)
            return refuse(m, text ? q : NULL, s, whole);
        text = *end ? end + 1 : NULL;
    }
    return !text || refuse(m, NULL, s, whole);
}

/* METAL, or METAL and what is optional. */
static bool read_metal(const model *m, const char *text, facet_material *into, const setting *s, const char *whole)
{
    size_t length = strcspn(text, "/");
    int metal = parse_word(FACET_KIND_METAL, text, length);
    const quantity *q = from(m, quantities);
    if (metal < 0)
        return refuse(m, NULL, s, whole);
    model_set_metal(into, (facet_metal)metal);
    while (q && q->use != OPTIONAL)
        q = from(m, q + 1);
    return read_quantities(m, q, text[length] ? text + length + 1 : NULL, into, s, whole);
}

bool model_read(const model *m, const char *text, void *into, const setting *s, const char *whole)
{
    if (text && isalpha((unsigned char)*text) && model_takes_metal(m))
        return read_metal(m, text, into, s, whole);
    return read_quantities(m, from(m, quantities), text, into, s, whole);
}
