/* src/models.def and src/special.def, expanded into the kernels that are tested by name. */
#include "cases.h"

#include <stdio.h>
#include <string.h>

#define FACET_PI_2 0x1.921fb6p0f

enum { VIEW = 1, TERMS = 2, F0 = 4, F90 = 8, RECIPROCAL = 16, CONSERVES = 32 };

typedef struct { int id; const char *word; float sigma_max; int properties; } row;
typedef struct { int masking, distribution, properties; } pair;

static const row diffuse_rows[] = {
#define FACET_DIFFUSE(id, name, word, sigma_max, properties, title) { FACET_DIFFUSE_##id, word, sigma_max, properties },
#include "models.def"
};
static const row fresnel_rows[] = {
#define FACET_FRESNEL(id, name, word, properties, title) { FACET_FRESNEL_##id, word, 0.0f, properties },
#include "models.def"
};

/* The rows of models.def by name. */
enum {
#define FACET_DIFFUSE(id, name, ...) DIFFUSE_##name = FACET_DIFFUSE_##id,
#define FACET_DISTRIBUTION(id, name, ...) DISTRIBUTION_##name = FACET_DISTRIBUTION_##id,
#define FACET_MASKING(id, name, ...) MASKING_##name = FACET_MASKING_##id,
#define FACET_FRESNEL(id, name, ...) FRESNEL_##name = FACET_FRESNEL_##id,
#include "models.def"
};
static const pair pairs[] = {
#define FACET_VISIBILITY(masking, distribution, properties)                                                           \
    { MASKING_##masking, DISTRIBUTION_##distribution, properties },
#include "models.def"
};

/* The rows of special.def, which the library has kernels of their own for. */
static const struct { int diffuse, distribution, masking, fresnel; bool coupled; } specials[] = {
#define FACET_SPECIAL(diffuse, distribution, masking, fresnel, coupled)                                               \
    { DIFFUSE_##diffuse, DISTRIBUTION_##distribution, MASKING_##masking, FRESNEL_##fresnel, coupled },
#include "special.def"
};

#define COUNT(rows) ((int)(sizeof rows / sizeof rows[0]))
enum { MOST_CASES = 2 * COUNT(diffuse_rows) + COUNT(pairs) + COUNT(fresnel_rows) + COUNT(specials) };

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

static void add_diffuse(kernel_case *c, const row *diffuse)
{
    c->material.diffuse.model = (facet_diffuse)diffuse->id;
    c->streams |= FACET_STREAM_ALBEDO | (diffuse->properties & TERMS ? FACET_STREAM_SIGMA : 0u);
    c->sigma_max = diffuse->sigma_max;
    c->reciprocal = c->reciprocal && diffuse->properties & RECIPROCAL;
}

static void add_specular(kernel_case *c, const pair *specular, const row *fresnel)
{
    c->material.specular.model = (facet_distribution)specular->distribution;
    c->material.specular.masking = (facet_masking)specular->masking;
    c->material.fresnel.model = (facet_fresnel)fresnel->id;
    c->streams |= FACET_STREAM_ALPHA | (fresnel->properties & F0 ? FACET_STREAM_F0 : 0u);
    c->reciprocal = c->reciprocal && specular->properties & fresnel->properties & RECIPROCAL;
}

static bool built(const facet_material *m)
{
    return facet_has(FACET_KIND_DIFFUSE, (int)m->diffuse.model)
        && facet_has(FACET_KIND_DISTRIBUTION, (int)m->specular.model)
        && (m->specular.model == FACET_DISTRIBUTION_NONE
            || (facet_has(FACET_KIND_MASKING, (int)m->specular.masking)
                && facet_has(FACET_KIND_FRESNEL, (int)m->fresnel.model)));
}

/* Names the case and keeps it, where the build holds its models and no case has the name. */
static void keep(kernel_case c, const row *diffuse, const pair *specular, const row *fresnel)
{
    if (!built(&c.material)) return;
    const bool named_fresnel = specular && fresnel->id != FACET_FRESNEL_ONE;
    snprintf(c.name, sizeof c.name, "%s%s%s%s%s%s%s%s", diffuse ? diffuse->word : "", diffuse && specular ? "+" : "",
             specular ? facet_word(FACET_KIND_DISTRIBUTION, specular->distribution) : "", specular ? "/" : "",
             specular ? facet_word(FACET_KIND_MASKING, specular->masking) : "", named_fresnel ? "/" : "",
             named_fresnel ? fresnel->word : "", diffuse && specular && !c.material.coupled ? "/uncoupled" : "");
    for (int i = 0; i < cases_found; i++)
        if (!strcmp(cases[i].name, c.name)) return;
    cases[cases_found++] = c;
}

static void add_case(const row *diffuse, const pair *specular, const row *fresnel, bool coupled)
{
    kernel_case c = { .reciprocal = true };
    c.material.coupled = coupled;
    if (diffuse) add_diffuse(&c, diffuse);
    if (specular) add_specular(&c, specular, fresnel);
    c.conserves = !(diffuse && specular) && (diffuse ? diffuse->properties : specular->properties) & CONSERVES;
    c.view = specular || (diffuse && diffuse->properties & VIEW);
    keep(c, diffuse, specular, fresnel);
}

static void find_cases(void)
{
    const row *one = find_row(fresnel_rows, COUNT(fresnel_rows), FACET_FRESNEL_ONE);
    const row *schlick = find_row(fresnel_rows, COUNT(fresnel_rows), FACET_FRESNEL_SCHLICK);

    for (int i = 0; i < COUNT(diffuse_rows); i++)
        if (diffuse_rows[i].id != FACET_DIFFUSE_NONE) add_case(&diffuse_rows[i], NULL, NULL, false);
    for (int k = 0; k < COUNT(fresnel_rows); k++) add_case(NULL, &pairs[0], &fresnel_rows[k], false);
    for (int i = 1; i < COUNT(pairs); i++) add_case(NULL, &pairs[i], one, false);
    for (int i = 0; i < COUNT(diffuse_rows); i++)
        if (diffuse_rows[i].id != FACET_DIFFUSE_NONE) add_case(&diffuse_rows[i], &pairs[0], schlick, true);
    for (int i = 0; i < COUNT(specials); i++) {
        const row *diffuse = find_row(diffuse_rows, COUNT(diffuse_rows), specials[i].diffuse);
        const bool has_diffuse = specials[i].diffuse != FACET_DIFFUSE_NONE;
        add_case(has_diffuse ? diffuse : NULL, find_pair(specials[i].masking, specials[i].distribution),
                 find_row(fresnel_rows, COUNT(fresnel_rows), specials[i].fresnel), specials[i].coupled);
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
