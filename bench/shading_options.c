#include "shading_options.h"
#include "console.h"
#include "model_words.h"
#include "vector.h"

#include <ctype.h>
#include <stdio.h>
#include <string.h>

#define PI 3.14159265358979323846

/* ---- Readers of a material ------------------------------------------------------------------------------------- */

static bool read_numbers(shading *to, const model *m, const char *numbers, const setting *s, const char *whole)
{
    uint32_t streams = model_streams(m->kind);
    bool metal = model_takes_metal(m) && isalpha((unsigned char)*numbers);
    model_forget(m->kind, &to->material);
    to->given = (to->given & ~streams) | (m->reads & streams) | (metal ? FACET_STREAM_ETA | FACET_STREAM_K : 0u);
    return model_read(m, numbers, &to->material, s, whole);
}

/* WORD keeps what numbers there are; WORD:NUMBERS sets those of the model and forgets the others. `built`: whether this
 * build must have the model. */
static bool set_model(shading *to, const setting *s, const char *text, bool built)
{
    char allowed[512], word[64] = "";
    size_t length = strcspn(text, ":");
    memcpy(word, text, length < sizeof word ? length : 0);
    int value = built ? parse_word(s->kind, text, length) : facet_value(s->kind, word);
    list_words(allowed, sizeof allowed, s->kind);
    if (value < 0)
        return setting_refuse(s, text, allowed);
    memcpy((char *)to + s->offset, &value, sizeof value);
    to->given &= s->kind == FACET_KIND_CONVENTION ? ~convention_replaces((facet_convention)value) : ~0u;
    model m = model_of(s->kind, value);
    return !text[length] || read_numbers(to, &m, text + length + 1, s, text);
}

static bool read_model(void *options, const setting *s, const char *text)
{
    return set_model(options, s, text, true);
}

static bool read_albedo(void *options, const setting *s, const char *text)
{
    ((shading *)options)->given |= FACET_STREAM_ALBEDO;
    return read_colour(options, s, text);
}

static bool read_scale(void *options, const setting *s, const char *text)
{
    bool pi = !strcmp(text, "pi"), printed = !strcmp(text, "1981");
    float scale = pi ? FACET_SCALE_PI : FACET_SCALE_1981;
    const char *end = pi || printed ? "" : parse_numbers(text, 1, &scale);
    if (!end || *end || !within(&scale, 1, s->limits))
        return setting_refuse(s, text, "pi (4/pi), 1981 (4), or a number from 1e-06 to 1e+06");
    ((shading *)options)->material.specular.scale = scale;
    return true;
}

/* ---- Readers of light ------------------------------------------------------------------------------------------ */

bool light_has_position(const facet_light *light)
{
    return light->kind != FACET_LIGHT_DIRECTIONAL;
}

/* False where it is 0. */
static bool unit(const float from[3], float to[3])
{
    double v[3];
    vector_widen(v, from);
    vector_normalise(v);
    vector_narrow(to, v);
    return vector_dot(v, v) > 0;
}

/* False where its numbers make no light. */
static bool make_light(facet_light_kind kind, const light_numbers *n, facet_light *light)
{
    bool aimed = true;
    *light = (facet_light){.kind = kind, .range = n->range,
                           .cos_inner = (float)cos((double)n->cone[0] * (PI / 180)),
                           .cos_outer = (float)cos((double)n->cone[1] * (PI / 180))};
    memcpy(light->irradiance, n->irradiance, sizeof light->irradiance);
    if (light_has_position(light))
        memcpy(light->position, n->place, sizeof light->position);
    else
        aimed = unit(n->place, light->direction);
    if (kind == FACET_LIGHT_SPOT)
        aimed = unit(n->axis, light->axis) && n->cone[0] <= n->cone[1];
    return aimed && n->irradiance[0] + n->irradiance[1] + n->irradiance[2] > 0;
}

/* Without a word, a directional light's numbers. */
static bool read_light(void *options, const setting *s, const char *text)
{
    shading *to = options;
    const float pi = (float)PI;
    light_numbers numbers = {.irradiance = {pi, pi, pi}};
    size_t length = isalpha((unsigned char)*text) ? strcspn(text, ":") : 0;
    int kind = length ? parse_word(FACET_KIND_LIGHT, text, length) : FACET_LIGHT_DIRECTIONAL;
    char allowed[120];
    list_words(allowed, sizeof allowed, FACET_KIND_LIGHT);
    if (kind < 0)
        return setting_refuse(s, text, allowed);
    model m = model_of(FACET_KIND_LIGHT, kind);
    if (!model_read(&m, !length ? text : text[length] ? text + length + 1 : NULL, &numbers, s, text))
        return false;
    if (to->light_count == LIGHT_LIMIT)
        return console_error("%s: at most %d lights are allowed", s->name, LIGHT_LIMIT);
    return make_light((facet_light_kind)kind, &numbers, &to->lights[to->light_count++]) ||
           setting_refuse(s, text, "a direction, axis and irradiance that are not zero, an INNER of at most OUTER");
}

static bool read_sh(void *options, const setting *s, const char *text)
{
    float sh[4][3];
    const char *at = text;
    for (int i = 0; i < 4; i++) {
        const char *end = parse_parts(at, 3, sh[i]);
        if (!end || *end != (i < 3 ? '/' : 0) || !within(sh[i], 3, s->limits))
            return setting_refuse(s, text, "four colours, each r,g,b or one number: L/Y/Z/X");
        at = end + 1;
    }
    memcpy(((shading *)options)->sh, sh, sizeof sh);
    return true;
}

/* ---- The tables ------------------------------------------------------------------------------------------------ */

#define FIELD(name) .offset = offsetof(shading, name)
#define LIMITS(least, most) .limits = {least, most}

static const setting material_table[] = {
    {"--diffuse", "WORD[:SIGMA]", "diffuse model, and its roughness: sigma in radians; of fujii and eon, r",
     read_model, FIELD(material.diffuse.model), .kind = FACET_KIND_DIFFUSE},
    {"--albedo", "RHO", "diffuse albedo", read_albedo, FIELD(material.diffuse.albedo), LIMITS(0, 1)},
    {"--specular", "WORD[:ALPHA]", "distribution or lobe, and its roughness: alpha as in D and G, the square of the\n"
     "perceptual one; ALPHA,ALPHA_Y along and across the tangent; a lobe's exponent", read_model,
     FIELD(material.specular.model), .kind = FACET_KIND_DISTRIBUTION},
    {"--masking", "WORD", "masking and shadowing (smith-correlated)", read_word, FIELD(material.specular.masking),
     .kind = FACET_KIND_MASKING},
    {"--scale", "pi|1981|X", "multiplies the specular part, to match others' normalisation (1)", read_scale,
     LIMITS(1e-6f, 1e6f)},
    {"--fresnel", "WORD[:NUMBERS]", "Fresnel: schlick:0.04, dielectric:1.5, conductor:ETA/K. A metal's name stands\n"
     "for its numbers: conductor:gold, schlick:gold", read_model, FIELD(material.fresnel.model),
     .kind = FACET_KIND_FRESNEL},
    {"--polarisation", "P", "of the light: -1 across the plane of incidence, 0 none, 1 parallel to it (0)",
     read_number, FIELD(material.fresnel.polarisation), LIMITS(-1, 1)},
    {"--convention", "WORD[:NUMBERS]", "metallic-roughness:BASE/METALLIC/ROUGHNESS[/LEVEL] in place of albedo, alpha\n"
     "and F0; specular-glossiness:GLOSSINESS in place of alpha (direct)", read_model,
     FIELD(material.convention.model), .kind = FACET_KIND_CONVENTION},
    {"--coupled", NULL, "diffuse times 1 - F", read_switch, FIELD(material.coupled)},
    {"--emission", "L", "emitted radiance", read_colour, FIELD(material.emission), LIMITS(0, 1e6f)},
};

static const setting light_table[] = {
    {"--light", "[KIND:]NUMBERS", "a light, up to 64 of them. X,Y,Z[/E]: towards it, and its irradiance (pi);\n"
     "point:X,Y,Z[/E[/RANGE]]: where it is, and its irradiance at a distance of 1;\n"
     "spot:X,Y,Z/AXIS/INNER,OUTER[/E[/RANGE]]: degrees from the axis", .read = read_light},
    {"--ambient", "E", "irradiance from everywhere", read_colour, FIELD(ambient), LIMITS(0, 1e6f)},
    {"--sh", "L/Y/Z/X", "ambient radiance as coefficients of spherical harmonics: constant, y, z, x", read_sh,
     LIMITS(-1e6f, 1e6f)},
};

static const setting target_table[] = {
    {"--arch", "WORD", "instruction set (best)", read_word, FIELD(target.arch), .kind = FACET_KIND_ARCH},
    {"--tier", "WORD", "fast, or strict: the same bytes everywhere (fast)", read_word, FIELD(target.tier),
     .kind = FACET_KIND_TIER},
};

#define COUNT(table) ((int)(sizeof table / sizeof *table))

void shading_settings(shading *s, settings groups[SHADING_GROUPS])
{
    groups[0] = (settings){"Material; colours are r,g,b or one number", material_table, COUNT(material_table), s};
    groups[1] = (settings){"Light", light_table, COUNT(light_table), s};
    groups[2] = (settings){"Target", target_table, COUNT(target_table), s};
}

/* ---- Whole materials ------------------------------------------------------------------------------------------- */

uint32_t shading_reads(const facet_material *m)
{
    uint32_t reads = model_of(FACET_KIND_DIFFUSE, (int)m->diffuse.model).reads |
                     model_of(FACET_KIND_DISTRIBUTION, (int)m->specular.model).reads;
    if (m->specular.model != FACET_DISTRIBUTION_NONE || m->coupled)
        reads |= model_of(FACET_KIND_FRESNEL, (int)m->fresnel.model).reads;
    return reads;
}

static const setting *material_setting(const char *name)
{
    for (const setting *s = material_table; s < material_table + COUNT(material_table); s++)
        if (!strcmp(s->name, name))
            return s;
    return NULL;
}

/* Copies the next word of a list; returns what follows it. */
static const char *next_word(const char *list, char word[80])
{
    list += strspn(list, " ");
    size_t length = strcspn(list, " ");
    snprintf(word, 80, "%.*s", (int)length, list);
    return list + length;
}

bool shading_read_material(shading *to, const char *list)
{
    char word[80];
    to->material = (facet_material){0};
    to->given = 0;
    for (list = next_word(list, word); *word; list = next_word(list, word)) {
        const setting *s = material_setting(word);
        if (!s)
            return console_error("%s: no such option of a material", word);
        if (s->value)
            list = next_word(list, word);
        if (!(s->read == read_model ? set_model(to, s, word, false) : s->read(to, s, word)))
            return false;
    }
    return true;
}

/* Whether this build has a masking under a distribution. */
static bool goes_under(int masking, int distribution)
{
    facet_material m = {.specular = {(facet_distribution)distribution, (facet_masking)masking, .alpha = 0.5f},
                        .fresnel = {.f0 = {1, 1, 1}, .f82 = {1, 1, 1}, .eta = {1, 1, 1}}};
    while (!facet_has(FACET_KIND_FRESNEL, (int)m.fresnel.model) && facet_word(FACET_KIND_FRESNEL, (int)m.fresnel.model))
        m.fresnel.model++;
    return model_of(FACET_KIND_DISTRIBUTION, distribution).reads & FACET_STREAM_ALPHA &&
           !facet_plan_init(&(facet_plan){0}, &m, (facet_target){0}, NULL);
}

/* Whether the masking that was asked for goes under the distribution, where this build has both. */
static bool check_masking(const facet_material *m)
{
    int distribution = (int)m->specular.model, masking = (int)m->specular.masking;
    char allowed[240] = "";
    for (int i = 0; facet_word(FACET_KIND_MASKING, i); i++)
        if (goes_under(i, distribution))
            list_word(allowed, sizeof allowed, facet_word(FACET_KIND_MASKING, i));
    return !*allowed || goes_under(masking, distribution) ||
           console_error("--masking %s: allowed with %s: %s", facet_word(FACET_KIND_MASKING, masking),
                         facet_word(FACET_KIND_DISTRIBUTION, distribution), allowed);
}

/* Which streams lack their number. Reflectances follow from indices, and a dielectric's index from a reflectance. */
static uint32_t lacking(const shading *s, const model *fresnel)
{
    const facet_material *m = &s->material;
    uint32_t have = s->given | convention_replaces(m->convention.model);
    bool f82 = m->fresnel.f82[0] > 0 || m->fresnel.f82[1] > 0 || m->fresnel.f82[2] > 0;
    if (have & FACET_STREAM_ETA)
        have |= FACET_STREAM_F0 | FACET_STREAM_K;
    else if (model_takes_f82(fresnel) && !f82)
        have &= ~(uint32_t)FACET_STREAM_F0;
    else if (have & FACET_STREAM_F0 && !(fresnel->reads & FACET_STREAM_K))
        have |= FACET_STREAM_ETA;
    uint32_t optional = FACET_STREAM_TANGENT | FACET_STREAM_ALPHA_Y | FACET_STREAM_SPECULAR_LEVEL;
    return (shading_reads(m) | model_of(FACET_KIND_CONVENTION, (int)m->convention.model).reads) & ~have & ~optional;
}

static bool refuse_bare(const setting *s, const model *m)
{
    char numbers[120], metal[120];
    model_form(m, false, numbers, sizeof numbers);
    model_form(m, true, metal, sizeof metal);
    bool both = model_takes_metal(m);
    return console_error("%s %s needs its numbers: %s%s%s", s->name, facet_word(m->kind, m->value), numbers,
                         both ? " or " : "", both ? metal : "");
}

bool shading_complete(const shading *s)
{
    const facet_material *m = &s->material;
    const model fresnel = model_of(FACET_KIND_FRESNEL, (int)m->fresnel.model);
    uint32_t lacks = lacking(s, &fresnel), twice = s->given & convention_replaces(m->convention.model);
    for (const setting *t = material_table; t < material_table + COUNT(material_table); t++) {
        bool word = t->read == read_model;
        uint32_t streams = t->read == read_albedo ? FACET_STREAM_ALBEDO : word ? model_streams(t->kind) : 0u;
        if (twice & streams)
            return console_error("%s: --convention %s stands in for its number", t->name,
                                 facet_word(FACET_KIND_CONVENTION, (int)m->convention.model));
        if (!(lacks & streams))
            continue;
        if (!word)
            return console_error("--diffuse %s needs %s", facet_word(FACET_KIND_DIFFUSE, (int)m->diffuse.model),
                                 t->name);
        int value;
        memcpy(&value, (const char *)s + t->offset, sizeof value);
        model bare = model_of(t->kind, value);
        return refuse_bare(t, &bare);
    }
    return check_masking(m);
}

/* ---- Lists ----------------------------------------------------------------------------------------------------- */

static void list_line(const char *title, facet_kind kind, int value, const char *more)
{
    bool here = facet_has(kind, value), other_cpu = kind == FACET_KIND_ARCH && facet_arch_lanes((facet_arch)value);
    printf("%-10s %-23s %s%s%s\n", title, facet_word(kind, value),
           here ? "available" : other_cpu ? "not on this CPU" : "not in this build", here && *more ? ": " : "",
           here ? more : "");
}

/* What one types, where there are numbers, and which model that is. */
static void list_models(const char *title, facet_kind kind)
{
    for (int i = 0; facet_word(kind, i); i++) {
        char form[120], more[240];
        model m = model_of(kind, i);
        model_form(&m, false, form, sizeof form);
        bool numbers = strchr(form, ':');
        snprintf(more, sizeof more, "%s%s%s", numbers ? form : "", numbers && *m.title ? ", " : "", m.title);
        list_line(title, kind, i, more);
    }
}

/* With the distributions that it goes under. */
static void list_maskings(void)
{
    for (int i = 0; facet_word(FACET_KIND_MASKING, i); i++) {
        char more[240], under[160] = "";
        for (int d = 0; facet_word(FACET_KIND_DISTRIBUTION, d); d++)
            if (goes_under(i, d))
                list_word(under, sizeof under, facet_word(FACET_KIND_DISTRIBUTION, d));
        snprintf(more, sizeof more, "%s; with %s", model_of(FACET_KIND_MASKING, i).title, under);
        list_line("masking", FACET_KIND_MASKING, i, more);
    }
}

static void list_words_of(const char *title, facet_kind kind)
{
    for (int i = 0; facet_word(kind, i); i++)
        list_line(title, kind, i, "");
}

static void list_archs(void)
{
    for (int i = 0; facet_word(FACET_KIND_ARCH, i); i++) {
        char lanes[40];
        int count = facet_arch_lanes((facet_arch)i);
        snprintf(lanes, sizeof lanes, "%d lane%s", count, count == 1 ? "" : "s");
        list_line("arch", FACET_KIND_ARCH, i,
                  i == FACET_ARCH_BEST ? facet_word(FACET_KIND_ARCH, (int)facet_arch_best()) : lanes);
    }
}

void shading_list(void)
{
    list_models("diffuse", FACET_KIND_DIFFUSE);
    list_models("specular", FACET_KIND_DISTRIBUTION);
    list_maskings();
    list_models("fresnel", FACET_KIND_FRESNEL);
    list_words_of("metal", FACET_KIND_METAL);
    list_models("convention", FACET_KIND_CONVENTION);
    list_models("light", FACET_KIND_LIGHT);
    list_archs();
    list_words_of("tier", FACET_KIND_TIER);
}
