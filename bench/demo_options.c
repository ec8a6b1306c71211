#include "demo_options.h"
#include "console.h"
#include "vector.h"

#include <ctype.h>
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* ---- Presets --------------------------------------------------------------------------------------------------- */

#define MATTE(diffuse_model, slope, ...) \
    {.diffuse = {.model = FACET_DIFFUSE_##diffuse_model, .albedo = {__VA_ARGS__}, .sigma = slope}}
#define COATED(roughness, ...) \
    {.diffuse = {.model = FACET_DIFFUSE_LAMBERT, .albedo = {__VA_ARGS__}}, \
     .specular = {.model = FACET_DISTRIBUTION_GGX, .alpha = roughness}, \
     .fresnel = {.f0 = {0.04f, 0.04f, 0.04f}}, .coupled = true}
#define METAL(roughness, ...) \
    {.specular = {.model = FACET_DISTRIBUTION_GGX, .alpha = roughness}, .fresnel = {.f0 = {__VA_ARGS__}}}

/* The metals' F0 are of n and k from the refractiveindex.info database (CC0; Johnson and Christy 1972, 1974), averaged
 * over 620-740, 495-570 and 450-495 nm. */
static const struct preset {
    const char *name, *note;
    facet_material material;
} presets[] = {
    {"porcelain", "white, under a clear glaze", COATED(0.1f, 0.82f, 0.81f, 0.78f)},
    {"celadon", "green, under a soft glaze", COATED(0.2f, 0.30f, 0.50f, 0.40f)},
    {"plastic", "red and glossy", COATED(0.15f, 0.62f, 0.04f, 0.03f)},
    {"rubber", "black and dull", COATED(0.5f, 0.03f, 0.03f, 0.035f)},
    {"plaster", "white and matte: Oren-Nayar, sigma 0.5", MATTE(OREN_NAYAR, 0.5f, 0.85f, 0.83f, 0.79f)},
    {"clay", "terracotta: Oren-Nayar, sigma 0.8", MATTE(OREN_NAYAR, 0.8f, 0.62f, 0.27f, 0.15f)},
    {"felt", "blue: Fujii, r 0.9", MATTE(FUJII, 0.9f, 0.10f, 0.17f, 0.42f)},
    {"chalk", "white: Lambert", MATTE(LAMBERT, 0, 0.85f, 0.85f, 0.85f)},
    {"gold", "satin", METAL(0.35f, 0.964f, 0.689f, 0.412f)},
    {"copper", "satin", METAL(0.35f, 0.946f, 0.609f, 0.556f)},
    {"silver", "brushed to a broad shine", METAL(0.4f, 0.992f, 0.983f, 0.980f)},
    {"iron", "cast and rough", METAL(0.5f, 0.538f, 0.511f, 0.502f)},
};

enum { PRESETS = sizeof presets / sizeof *presets };

/* Key, fill, two rims and the floor's glow, in the picture's axes. */
static const facet_light studio[] = {
    {.direction = {-0.62f, 0.66f, 0.42f}, .irradiance = {3.0f, 2.85f, 2.6f}},
    {.direction = {0.78f, 0.22f, 0.59f}, .irradiance = {0.40f, 0.48f, 0.62f}},
    {.direction = {0.66f, 0.46f, -0.59f}, .irradiance = {2.0f, 2.2f, 2.6f}},
    {.direction = {-0.80f, 0.15f, -0.58f}, .irradiance = {1.4f, 1.3f, 1.2f}},
    {.direction = {0.20f, -0.87f, 0.45f}, .irradiance = {0.22f, 0.20f, 0.19f}},
};

enum { STUDIO_LIGHTS = sizeof studio / sizeof *studio };

static const options defaults = {
    .mesh = "teapot", .png = "teapot.png", .width = 1024, .height = 1024, .azimuth = 28, .elevation = 21,
    .distance = 4.5f, .fov = 28, .ambient = {0.25f, 0.27f, 0.31f}, .exposure = 1, .samples = 2, .seconds = 0.1f,
};

/* ---- Values ---------------------------------------------------------------------------------------------------- */

typedef struct setting {
    const char *name, *value, *help;      /* no value: a switch */
    bool (*read)(options *o, const struct setting *s, const char *text);
    size_t offset;                        /* of the field that it sets */
    float least, most;                    /* of a number or of each part of a colour */
    facet_kind kind;                      /* of a word */
} setting;

static void *field(options *o, const setting *s)
{
    return (char *)o + s->offset;
}

static bool refuse(const setting *s, const char *text, const char *allowed)
{
    return console_error("%s %.80s: allowed: %s", s->name, text, allowed);
}

/* A number that ends at `end`, which is a character or the text's end. */
static bool number(const char **text, char end, float *out)
{
    char *after;
    *out = strtof(*text, &after);
    bool whole = after != *text && !isspace((unsigned char)**text) && *after == end && isfinite(*out);
    *text = *after ? after + 1 : after;
    return whole;
}

static bool within(const float *values, int count, float least, float most)
{
    for (int i = 0; i < count; i++)
        if (!(values[i] >= least && values[i] <= most))
            return false;
    return true;
}

static bool triple(const char *text, float out[3])
{
    return number(&text, ':', &out[0]) && number(&text, ':', &out[1]) && number(&text, 0, &out[2]);
}

/* r:g:b or one number for all three. */
static bool colour(const char *text, float out[3])
{
    if (strchr(text, ':'))
        return triple(text, out);
    bool read = number(&text, 0, &out[0]);
    out[1] = out[2] = out[0];
    return read;
}

static bool read_number(options *o, const setting *s, const char *text)
{
    float value;
    const char *at = text;
    char allowed[80];
    snprintf(allowed, sizeof allowed, "a number from %g to %g", (double)s->least, (double)s->most);
    if (!number(&at, 0, &value) || !within(&value, 1, s->least, s->most))
        return refuse(s, text, allowed);
    *(float *)field(o, s) = value;
    return true;
}

static bool read_colour(options *o, const setting *s, const char *text)
{
    float value[3];
    char allowed[80];
    snprintf(allowed, sizeof allowed, "r:g:b or one number, each from %g to %g", (double)s->least,
             (double)s->most);
    if (!colour(text, value) || !within(value, 3, s->least, s->most))
        return refuse(s, text, allowed);
    memcpy(field(o, s), value, sizeof value);
    return true;
}

/* Appends a word to a list. */
static void append(char *list, size_t size, const char *word)
{
    size_t used = strlen(list);
    snprintf(list + used, size - used, "%s%s", used ? ", " : "", word);
}

static bool read_word(options *o, const setting *s, const char *text)
{
    int value = facet_value(s->kind, text);
    char allowed[512] = "";
    for (int i = 0; facet_word(s->kind, i); i++)
        if (facet_has(s->kind, i))
            append(allowed, sizeof allowed, facet_word(s->kind, i));
    if (value < 0 || !facet_has(s->kind, value))
        return refuse(s, text, allowed);
    memcpy(field(o, s), &value, sizeof value);
    return true;
}

static bool read_text(options *o, const setting *s, const char *text)
{
    if (!*text)
        return refuse(s, "''", "a file name");
    *(const char **)field(o, s) = text;
    return true;
}

static bool read_switch(options *o, const setting *s, const char *text)
{
    (void)text;
    *(bool *)field(o, s) = true;
    return true;
}

static bool read_layout(options *o, const setting *s, const char *text)
{
    (void)text;
    o->layout = !strcmp(s->name, "--grid") ? LAYOUT_GRID : LAYOUT_COMPARE;
    return true;
}

static bool read_size(options *o, const setting *s, const char *text)
{
    char *end;
    bool digits = strspn(text, "0123456789x") == strlen(text);
    long width = strtol(text, &end, 10), height = *end == 'x' ? strtol(end + 1, &end, 10) : 0;
    if (!digits || *end || width < 1 || width > 8192 || height < 1 || height > 8192)
        return refuse(s, text, "WxH, each from 1 to 8192");
    o->width = (size_t)width;
    o->height = (size_t)height;
    return true;
}

static bool read_samples(options *o, const setting *s, const char *text)
{
    if (strcmp(text, "1") && strcmp(text, "4"))
        return refuse(s, text, "1 or 4");
    o->samples = *text == '4' ? 2 : 1;
    return true;
}

static bool read_background(options *o, const setting *s, const char *text)
{
    o->backdrop = !strcmp(text, "soft") ? BACKDROP_SOFT : !strcmp(text, "none") ? BACKDROP_NONE : BACKDROP_COLOUR;
    return o->backdrop != BACKDROP_COLOUR ||
           (colour(text, o->backdrop_colour) && within(o->backdrop_colour, 3, 0, 1e6f)) ||
           refuse(s, text, "soft, none (transparent), r:g:b or one number (radiance)");
}

/* X:Y:Z or X:Y:Z,E. */
static bool light(const char *text, facet_light *out)
{
    char direction[80];
    size_t length = strcspn(text, ",");
    if (length >= sizeof direction)
        return false;
    memcpy(direction, text, length);
    direction[length] = 0;
    double unit[3];
    if (!triple(direction, out->direction) || !colour(text[length] ? text + length + 1 : "3.14159265", out->irradiance))
        return false;
    vector_widen(unit, out->direction);
    vector_normalise(unit);
    vector_narrow(out->direction, unit);
    return vector_dot(unit, unit) > 0 && within(out->irradiance, 3, 0, 1e6f);
}

static bool read_light(options *o, const setting *s, const char *text)
{
    facet_light new_light = {.kind = FACET_LIGHT_DIRECTIONAL};
    if (!light(text, &new_light) || (new_light.irradiance[0] + new_light.irradiance[1] + new_light.irradiance[2] <= 0))
        return refuse(s, text, "X:Y:Z or X:Y:Z,IRRADIANCE with a direction and an irradiance that are not zero");
    if (o->light_count == LIGHT_LIMIT)
        return console_error("%s: at most %d lights are allowed", s->name, LIGHT_LIMIT);
    o->lights[o->light_count++] = new_light;
    return true;
}

static bool read_preset(options *o, const setting *s, const char *text)
{
    char allowed[512] = "";
    for (int i = 0; i < PRESETS; i++) {
        append(allowed, sizeof allowed, presets[i].name);
        if (!strcmp(text, presets[i].name)) {
            o->material = presets[i].material;
            return true;
        }
    }
    return refuse(s, text, allowed);
}

/* ---- The table ------------------------------------------------------------------------------------------------- */

#define FIELD(name) .offset = offsetof(options, name)
#define RANGE(low, high) .least = low, .most = high

static const setting table[] = {
    {"--size", "WxH", "pixels of the picture, or of each panel (1024x1024)", .read = read_size},
    {"--samples", "1|4", "samples a pixel (4)", .read = read_samples},
    {"--azimuth", "DEGREES", "where the eye stands around the mesh (28)", read_number, FIELD(azimuth),
     RANGE(-3600, 3600)},
    {"--elevation", "DEGREES", "how far above its middle (21)", read_number, FIELD(elevation), RANGE(-90, 90)},
    {"--distance", "RADII", "in radii of the mesh (4.5)", read_number, FIELD(distance), RANGE(0.01f, 1000)},
    {"--fov", "DEGREES", "vertical angle of view (28)", read_number, FIELD(fov), RANGE(1, 150)},
    {"--light", "X:Y:Z[,E]", "to a light, x right, y up, z to the eye, and its irradiance (pi);\n"
     "repeat for more; in place of key, fill and rim lights", .read = read_light},
    {"--ambient", "E", "irradiance from everywhere", read_colour, FIELD(ambient), RANGE(0, 1e6f)},
    {"--preset", "NAME", "a whole material (porcelain); options after it change it", .read = read_preset},
    {"--diffuse", "WORD", "diffuse model", read_word, FIELD(material.diffuse.model), .kind = FACET_KIND_DIFFUSE},
    {"--albedo", "RHO", "diffuse albedo", read_colour, FIELD(material.diffuse.albedo), RANGE(0, 1)},
    {"--sigma", "S", "radians, to pi/2 (fujii: its r, to 1)", read_number,
     FIELD(material.diffuse.sigma), RANGE(0, 1.5707963f)},
    {"--specular", "WORD", "distribution", read_word, FIELD(material.specular.model),
     .kind = FACET_KIND_DISTRIBUTION},
    {"--masking", "WORD", "masking", read_word, FIELD(material.specular.masking), .kind = FACET_KIND_MASKING},
    {"--alpha", "A", "roughness as in D and G: the square of the perceptual one", read_number,
     FIELD(material.specular.alpha), RANGE(0, 1)},
    {"--fresnel", "WORD", "Fresnel model", read_word, FIELD(material.fresnel.model), .kind = FACET_KIND_FRESNEL},
    {"--f0", "F", "reflectance at normal incidence", read_colour, FIELD(material.fresnel.f0), RANGE(0, 1)},
    {"--f90", "F", "reflectance at grazing; 0 stands for 1", read_number, FIELD(material.fresnel.f90), RANGE(0, 1)},
    {"--coupled", NULL, "diffuse times 1 - F", read_switch, FIELD(material.coupled)},
    {"--emission", "L", "emitted radiance", read_colour, FIELD(material.emission), RANGE(0, 1e6f)},
    {"--arch", "WORD", "instruction set (best)", read_word, FIELD(target.arch), .kind = FACET_KIND_ARCH},
    {"--tier", "WORD", "fast, or strict: the same bytes everywhere", read_word, FIELD(target.tier),
     .kind = FACET_KIND_TIER},
    {"--grid", NULL, "a panel for each of several alpha (to the right) and sigma (downwards)", .read = read_layout},
    {"--compare", NULL, "Lambert on the left, Oren-Nayar on the right", .read = read_layout},
    {"--two-sided", NULL, "light the backs of faces too", read_switch, FIELD(two_sided)},
    {"--flat", NULL, "one normal a triangle, even where the file has others", read_switch, FIELD(flat)},
    {"--background", "L", "soft, none (transparent), or a radiance", .read = read_background},
    {"--exposure", "X", "multiplies the radiance in the PNG (1)", read_number, FIELD(exposure), RANGE(0, 1e6f)},
    {"-o", "FILE", "the picture, as PNG (teapot.png)", read_text, FIELD(png)},
    {"--pfm", "FILE", "the linear radiance too, as PFM", read_text, FIELD(pfm)},
    {"--time", "SECONDS", "how long to time each arch; 0: not (0.1)", read_number, FIELD(seconds), RANGE(0, 60)},
    {"--list", NULL, "list every model, arch, tier and preset", read_switch, FIELD(list)},
    {"--help", NULL, "this", read_switch, FIELD(help)},
};

enum { OPTIONS = sizeof table / sizeof *table };

/* ---- Reading --------------------------------------------------------------------------------------------------- */

static const setting *find(const char *name, size_t length)
{
    for (int i = 0; i < OPTIONS; i++)
        if (strlen(table[i].name) == length && !strncmp(table[i].name, name, length))
            return &table[i];
    return NULL;
}

static bool refuse_option(const char *text)
{
    char allowed[512] = "";
    for (int i = 0; i < OPTIONS; i++)
        append(allowed, sizeof allowed, table[i].name);
    return console_error("%.80s: no such option; allowed: %s", text, allowed);
}

/* Takes one option and its value, `--name value` or `--name=value`, and moves *at behind it. */
static bool read_option(options *o, int count, char **arguments, int *at)
{
    const char *text = arguments[(*at)++];
    size_t length = !strncmp(text, "--", 2) ? strcspn(text, "=") : strlen(text);
    const setting *s = find(text, length);
    if (!s)
        return refuse_option(text);
    if (!s->value && text[length])
        return console_error("%s takes no value", s->name);
    const char *value = text[length] ? text + length + 1 : NULL;
    if (s->value && !value && *at < count)
        value = arguments[(*at)++];
    if (s->value && !value)
        return console_error("%s needs a value: %s", s->name, s->value);
    return s->read(o, s, value);
}

bool options_read(options *o, int count, char **arguments)
{
    const char *mesh = NULL;
    *o = defaults;
    o->material = presets[0].material;
    for (int at = 1; at < count;) {
        if (arguments[at][0] == '-' && arguments[at][1]) {
            if (!read_option(o, count, arguments, &at))
                return false;
        } else if (mesh) {
            return console_error("%.80s: one mesh is allowed, and it is %.80s", arguments[at], mesh);
        } else {
            mesh = arguments[at++];
        }
    }
    o->mesh = mesh ? mesh : o->mesh;
    if (!o->light_count) {
        memcpy(o->lights, studio, sizeof studio);
        o->light_count = STUDIO_LIGHTS;
    }
    return true;
}

/* ---- Help and lists -------------------------------------------------------------------------------------------- */

void options_help(void)
{
    printf("usage: facet-demo [options] [teapot | sphere | FILE.obj]\n\n"
           "Rasterizes a mesh, shades it with facet %s, writes a picture, and prints how fast each arch shades.\n"
           "Where an option takes a colour, it is r:g:b or one number. Radiance and irradiance are linear.\n\n",
           facet_version());
    for (int i = 0; i < OPTIONS; i++) {
        char left[40];
        const char *help = table[i].help, *second = strchr(help, '\n');
        snprintf(left, sizeof left, "%s %s", table[i].name, table[i].value ? table[i].value : "");
        printf("  %-22s %.*s\n", left, second ? (int)(second - help) : (int)strlen(help), help);
        if (second)
            printf("  %-22s %s\n", "", second + 1);
    }
}

static void list_kind(const char *title, facet_kind kind)
{
    for (int i = 0; facet_word(kind, i); i++)
        printf("%-9s %-18s %s\n", title, facet_word(kind, i), facet_has(kind, i) ? "available" : "not in this build");
}

static void list_archs(void)
{
    for (int i = 0; facet_word(FACET_KIND_ARCH, i); i++) {
        const char *word = facet_word(FACET_KIND_ARCH, i);
        int lanes = facet_arch_lanes((facet_arch)i);
        if (i == FACET_ARCH_BEST)
            printf("%-9s %-18s available: %s\n", "arch", word, facet_word(FACET_KIND_ARCH, (int)facet_arch_best()));
        else if (facet_has(FACET_KIND_ARCH, i))
            printf("%-9s %-18s available: %d lane%s\n", "arch", word, lanes, lanes == 1 ? "" : "s");
        else
            printf("%-9s %-18s %s\n", "arch", word, lanes ? "not on this CPU" : "not in this build");
    }
}

void options_list(void)
{
    list_kind("diffuse", FACET_KIND_DIFFUSE);
    list_kind("specular", FACET_KIND_DISTRIBUTION);
    list_kind("masking", FACET_KIND_MASKING);
    list_kind("fresnel", FACET_KIND_FRESNEL);
    list_archs();
    list_kind("tier", FACET_KIND_TIER);
    for (int i = 0; i < PRESETS; i++)
        printf("%-9s %-18s %s\n", "preset", presets[i].name, presets[i].note);
}
