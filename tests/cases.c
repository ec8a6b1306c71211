/* src/models.def and src/special.def, expanded into the kernels that are tested by name. */
#include "cases.h"
#include "models.def"            /* the properties */

#include <stdio.h>
#include <string.h>

typedef struct { int id; const char *word; uint32_t reads; int properties; float sigma_max; } row;

static const row diffuse_rows[] = {
#define FACET_DIFFUSE(id, name, word, reads, properties, sigma_max, title)                                            \
    { FACET_DIFFUSE_##id, word, reads, properties, sigma_max },
#include "models.def"
};
static const row distribution_rows[] = {
#define FACET_DISTRIBUTION(id, name, word, reads, properties, title)                                                  \
    { FACET_DISTRIBUTION_##id, word, reads, properties, 0.0f },
#include "models.def"
};
static const row fresnel_rows[] = {
#define FACET_FRESNEL(id, name, word, reads, properties, title) { FACET_FRESNEL_##id, word, reads, properties, 0.0f },
#include "models.def"
};

/* The rows of models.def by name. */
enum {
#define FACET_DIFFUSE(id, name, ...) DIFFUSE_##name = FACET_DIFFUSE_##id,
#define FACET_DISTRIBUTION(id, name, ...) DISTRIBUTION_##name = FACET_DISTRIBUTION_##id,
#define FACET_MASKING(id, name, ...) MASKING_##name = FACET_MASKING_##id,
#define FACET_FRESNEL(id, name, ...) FRESNEL_##name = FACET_FRESNEL_##id,
#include "models.def"
    MASKING_none = 0, FRESNEL_none = 0, FRESNEL_fitted_dielectric = FACET_FRESNEL_DIELECTRIC,
    FRESNEL_fitted_conductor = FACET_FRESNEL_CONDUCTOR
};

/* A masking under a distribution. */
typedef struct { int masking, distribution, properties; } pair;

static const pair pairs[] = {
#define FACET_VISIBILITY(masking, distribution, properties)                                                           \
    { MASKING_##masking, DISTRIBUTION_##distribution, properties },
#include "models.def"
};

/* The rows of special.def, which the library has kernels of their own for. */
static const struct { int diffuse, distribution, masking, fresnel; bool coupled; } specials[] = {
#define FACET_SPECIAL(name, diffuse, distribution, masking, fresnel, coupled, ...)                                    \
    { DIFFUSE_##diffuse, DISTRIBUTION_##distribution, MASKING_##masking, FRESNEL_##fresnel, coupled },
#include "special.def"
};

/* What a material in water and polarised light has; an F82. */
#define OUTSIDE      1.33f
#define POLARISATION 0.5f
static const float f82s[] = { 0.6f, 0.6f, 0.6f };

/* Where a point and a spot light stand. */
static const struct { const char *word; facet_light light; } lights[] = {
    { "", { .kind = FACET_LIGHT_DIRECTIONAL } },
    { "@point", { .kind = FACET_LIGHT_POINT, .position = { 0.5f, -1.5f, 3.0f }, .range = 8.0f } },
    { "@spot", { .kind = FACET_LIGHT_SPOT, .position = { -2.0f, 1.0f, 2.5f }, .axis = { 0.48f, -0.64f, 0.6f },
                 .cos_inner = 0.9f, .cos_outer = 0.6f } },
};

#define COUNT(rows) ((int)(sizeof rows / sizeof rows[0]))
enum {
    MOST_CASES = 2 * COUNT(diffuse_rows) + COUNT(pairs) + COUNT(distribution_rows) + 2 * COUNT(fresnel_rows)
        + COUNT(specials) + 2 * COUNT(lights)
};

static kernel_case cases[MOST_CASES];
static int cases_found;

static const row *find_row(const row *rows, int count, int id)
{
    for (int i = 0; i < count; i++)
        if (rows[i].id == id) return &rows[i];
    return NULL;
}

static const pair *find_pair(int masking, int distribution)
{
    for (int i = 0; i < COUNT(pairs); i++)
        if (pairs[i].masking == masking && pairs[i].distribution == distribution) return &pairs[i];
    return NULL;
}

/* A case in the making: its rows; `lobe` in place of `specular`, or neither. */
typedef struct {
    const row *diffuse, *lobe, *fresnel;
    const pair *specular;
    bool coupled, outside;
    int light;
} recipe;

static bool is_glossy(const recipe *r) { return r->specular || r->lobe; }

static void add_diffuse(kernel_case *c, const row *diffuse)
{
    c->material.diffuse.model = (facet_diffuse)diffuse->id;
    c->streams |= diffuse->reads;
    c->sigma_max = diffuse->sigma_max;
    c->view = diffuse->properties & VIEWED;
    c->reciprocal = c->reciprocal && diffuse->properties & RECIPROCAL;
    c->conserves = diffuse->properties & CONSERVES;
}

static void add_specular(kernel_case *c, const recipe *r)
{
    const row *distribution =
        r->lobe ? r->lobe : find_row(distribution_rows, COUNT(distribution_rows), r->specular->distribution);
    const int properties = r->lobe ? r->lobe->properties : r->specular->properties;
    c->material.specular.model = (facet_distribution)distribution->id;
    if (!r->lobe) c->material.specular.masking = (facet_masking)r->specular->masking;
    c->material.fresnel.model = (facet_fresnel)r->fresnel->id;
    if (r->fresnel->properties & F82) memcpy(c->material.fresnel.f82, f82s, sizeof f82s);
    if (r->outside) c->material.fresnel.eta_outside = OUTSIDE;
    if (r->outside) c->material.fresnel.polarisation = POLARISATION;
    c->streams |= distribution->reads | r->fresnel->reads;
    c->view = true;
    c->lobe = r->lobe;
    c->reciprocal = c->reciprocal && properties & r->fresnel->properties & RECIPROCAL;
    c->conserves = properties & CONSERVES;
}

static bool built(const kernel_case *c)
{
    const facet_material *m = &c->material;
    return facet_has(FACET_KIND_DIFFUSE, (int)m->diffuse.model)
        && facet_has(FACET_KIND_DISTRIBUTION, (int)m->specular.model)
        && (m->specular.model == FACET_DISTRIBUTION_NONE
            || ((c->lobe || facet_has(FACET_KIND_MASKING, (int)m->specular.masking))
                && facet_has(FACET_KIND_FRESNEL, (int)m->fresnel.model)));
}

static void name_case(kernel_case *c, const recipe *r)
{
    const facet_material *m = &c->material;
    const bool both = r->diffuse && is_glossy(r), names_fresnel = is_glossy(r) && m->fresnel.model != FACET_FRESNEL_ONE;
    snprintf(c->name, sizeof c->name, "%s%s%s%s%s%s%s%s%s%s", r->diffuse ? r->diffuse->word : "", both ? "+" : "",
             is_glossy(r) ? facet_word(FACET_KIND_DISTRIBUTION, (int)m->specular.model) : "", r->specular ? "/" : "",
             r->specular ? facet_word(FACET_KIND_MASKING, (int)m->specular.masking) : "", names_fresnel ? "/" : "",
             names_fresnel ? r->fresnel->word : "", r->outside ? "/outside" : "",
             both && !r->coupled ? "/uncoupled" : "", lights[r->light].word);
}

/* Keeps the case, where the build holds its models and no case has the name. */
static void add_case(recipe r)
{
    kernel_case c = { .light = lights[r.light].light, .reciprocal = true };
    c.material.coupled = r.coupled;
    if (r.diffuse) add_diffuse(&c, r.diffuse);
    if (is_glossy(&r)) add_specular(&c, &r);
    c.conserves = c.conserves && !(r.diffuse && is_glossy(&r));
    c.promised = c.streams & ~(FACET_STREAM_ALBEDO - 1u);
    if (!built(&c)) return;
    name_case(&c, &r);
    for (int i = 0; i < cases_found; i++)
        if (!strcmp(cases[i].name, c.name)) return;
    cases[cases_found++] = c;
}

static const row *fresnel_row(int id) { return find_row(fresnel_rows, COUNT(fresnel_rows), id); }
static const row *diffuse_row(int id) { return find_row(diffuse_rows, COUNT(diffuse_rows), id); }

static void add_special(int i)
{
    const bool has_diffuse = specials[i].diffuse != FACET_DIFFUSE_NONE;
    add_case((recipe){ .diffuse = has_diffuse ? diffuse_row(specials[i].diffuse) : NULL,
                       .specular = find_pair(specials[i].masking, specials[i].distribution),   /* NULL: none */
                       .fresnel = fresnel_row(specials[i].fresnel), .coupled = specials[i].coupled });
}

static void find_cases(void)
{
    const pair *first = &pairs[0];
    const row *one = fresnel_row(FACET_FRESNEL_ONE), *schlick = fresnel_row(FACET_FRESNEL_SCHLICK);

    for (int i = 0; i < COUNT(diffuse_rows); i++)
        if (diffuse_rows[i].id != FACET_DIFFUSE_NONE) add_case((recipe){ .diffuse = &diffuse_rows[i] });
    for (int k = 0; k < COUNT(fresnel_rows); k++) {
        add_case((recipe){ .specular = first, .fresnel = &fresnel_rows[k] });
        if (fresnel_rows[k].properties & MEDIA)
            add_case((recipe){ .specular = first, .fresnel = &fresnel_rows[k], .outside = true });
    }
    for (int i = 1; i < COUNT(pairs); i++) add_case((recipe){ .specular = &pairs[i], .fresnel = one });
    for (int i = 0; i < COUNT(distribution_rows); i++)
        if (distribution_rows[i].properties & LOBE) add_case((recipe){ .lobe = &distribution_rows[i], .fresnel = one });
    for (int i = 0; i < COUNT(diffuse_rows); i++)
        if (diffuse_rows[i].id != FACET_DIFFUSE_NONE)
            add_case((recipe){ .diffuse = &diffuse_rows[i], .specular = first, .fresnel = schlick, .coupled = true });
    for (int i = 0; i < COUNT(specials); i++) add_special(i);
    for (int light = 1; light < COUNT(lights); light++) {
        add_case((recipe){ .diffuse = diffuse_row(FACET_DIFFUSE_LAMBERT), .light = light });
        add_case((recipe){ .specular = first, .fresnel = one, .light = light });
    }
}

int case_count(void)
{
    if (!cases_found) find_cases();
    return cases_found;
}

const kernel_case *case_at(int index)
{
    return index >= 0 && index < case_count() ? &cases[index] : NULL;
}

const kernel_case *find_case(const char *name)
{
    for (int i = 0; i < case_count(); i++)
        if (!strcmp(cases[i].name, name)) return &cases[i];
    return NULL;
}
