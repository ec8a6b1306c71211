#include "demo_options.h"
#include "balls.h"
#include "console.h"
#include "rigs.h"
#include "workers.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* ---- Presets --------------------------------------------------------------------------------------------------- */

#define GLAZE "--fresnel schlick:0.04 --coupled"

/* Materials as the options that make them. */
static const struct preset {
    const char *name, *note, *material;
} presets[] = {
    {"porcelain", "white, under a clear glaze",
     "--diffuse lambert --albedo 0.82,0.81,0.78 --specular ggx:0.1 " GLAZE},
    {"celadon", "green, under a soft glaze", "--diffuse lambert --albedo 0.3,0.5,0.4 --specular ggx:0.2 " GLAZE},
    {"plastic", "red and glossy", "--diffuse lambert --albedo 0.62,0.04,0.03 --specular ggx:0.15 " GLAZE},
    {"rubber", "black and dull", "--diffuse lambert --albedo 0.03,0.03,0.035 --specular ggx:0.5 " GLAZE},
    {"enamel", "blue, under glass",
     "--diffuse eon:0.3 --albedo 0.03,0.09,0.33 --specular ggx:0.08 --fresnel dielectric:1.52 --coupled"},
    {"obsidian", "black glass",
     "--diffuse lambert --albedo 0.012 --specular ggx:0.06 --fresnel dielectric:1.49 --coupled"},
    {"plaster", "white and matte", "--diffuse oren-nayar:0.5 --albedo 0.85,0.83,0.79"},
    {"clay", "terracotta", "--diffuse oren-nayar:0.8 --albedo 0.62,0.27,0.15"},
    {"felt", "blue", "--diffuse fujii:0.9 --albedo 0.10,0.17,0.42"},
    {"chalk", "white", "--diffuse lambert --albedo 0.85"},
    {"gold", "satin", "--specular ggx:0.35 --fresnel conductor:gold"},
    {"copper", "satin", "--specular ggx:0.35 --fresnel conductor:copper"},
    {"silver", "with a broad shine", "--specular ggx:0.4 --fresnel conductor:silver"},
    {"iron", "cast and rough", "--specular ggx:0.5 --fresnel conductor:iron"},
    {"brushed", "iron, turned on a lathe", "--specular ggx-anisotropic:0.15,0.5 --fresnel conductor:iron"},
    {"cook-torrance", "copper, by the models of 1981",
     "--specular beckmann:0.3 --masking v-cavity --fresnel conductor:copper"},
};

enum { PRESETS = sizeof presets / sizeof *presets };

/* ---- Sceneries ------------------------------------------------------------------------------------------------- */

/* What the other options start from: as the switch `name` has it, or the first row. */
static const struct scenery {
    const char *name, *png, *material;
    layout layout;
    rig rig;
    size_t width, height, samples;
    float azimuth, elevation, distance, fov;
    backdrop backdrop;
    float backdrop_colour;
} sceneries[] = {
    {"", "teapot.png", NULL, LAYOUT_ONE, RIG_STUDIO, 1024, 1024, 2, 28, 21, 4.5f, 28, BACKDROP_SOFT, 0},
    {"--metals", "metals.png", "--specular ggx:0.2 --fresnel conductor:gold", LAYOUT_METALS, RIG_BOXES, 1200, 820, 4,
     0, 0, 8, 10, BACKDROP_SOFT, 0},
    {"--grazing", "grazing.png", "--specular ggx:0.35 --fresnel conductor:gold", LAYOUT_GRAZING, RIG_RIM, 1200, 920, 4,
     0, 0, 40, 2.15f, BACKDROP_COLOUR, 0.01f},
};

enum { SCENERIES = sizeof sceneries / sizeof *sceneries };

/* The one that is asked for, wherever that stands among the arguments. */
static const struct scenery *find_scenery(int count, char **arguments)
{
    const struct scenery *found = sceneries;
    for (int i = 1; i < count; i++)
        for (const struct scenery *s = sceneries + 1; s < sceneries + SCENERIES; s++)
            found = strcmp(arguments[i], s->name) ? found : s;
    return found;
}

static bool start_from(options *o, const struct scenery *s)
{
    const float l = s->backdrop_colour;
    *o = (options){
        .shading.ambient = {0.25f, 0.27f, 0.31f}, .png = s->png, .layout = s->layout, .rig = s->rig,
        .width = s->width, .height = s->height, .samples = s->samples, .azimuth = s->azimuth,
        .elevation = s->elevation, .distance = s->distance, .fov = s->fov, .exposure = 1, .backdrop = s->backdrop,
        .backdrop_colour = {l, l, l}, .seconds = 0.1f, .threads = worker_default(),
    };
    return shading_read_material(&o->shading, s->material ? s->material : presets[0].material);
}

/* ---- Readers --------------------------------------------------------------------------------------------------- */

static bool read_layout(void *to, const setting *s, const char *text)
{
    options *o = to;
    (void)text;
    if (ball_count(o->layout))
        return console_error("%s: --metals and --grazing have no panels", s->name);
    o->layout = !strcmp(s->name, "--grid") ? LAYOUT_GRID : LAYOUT_COMPARE;
    return true;
}

/* find_scenery has seen it. */
static bool read_scenery(void *to, const setting *s, const char *text)
{
    (void)to, (void)s, (void)text;
    return true;
}

static bool read_size(void *to, const setting *s, const char *text)
{
    options *o = to;
    char *end;
    bool digits = strspn(text, "0123456789x") == strlen(text);
    long width = strtol(text, &end, 10), height = *end == 'x' ? strtol(end + 1, &end, 10) : 0;
    if (!digits || *end || width < 1 || width > 8192 || height < 1 || height > 8192)
        return setting_refuse(s, text, "WxH, each from 1 to 8192");
    o->width = (size_t)width;
    o->height = (size_t)height;
    return true;
}

static bool read_samples(void *to, const setting *s, const char *text)
{
    options *o = to;
    o->samples = !strcmp(text, "1") ? 1 : !strcmp(text, "4") ? 2 : !strcmp(text, "16") ? 4 : 0;
    return o->samples || setting_refuse(s, text, "1, 4 or 16");
}

static bool read_threads(void *to, const setting *s, const char *text)
{
    char allowed[64];
    bool digits = *text && strspn(text, "0123456789") == strlen(text);
    long threads = digits ? strtol(text, NULL, 10) : 0;
    snprintf(allowed, sizeof allowed, "a whole number from 1 to %d", WORKER_LIMIT);
    if (threads < 1 || threads > WORKER_LIMIT)
        return setting_refuse(s, text, allowed);
    ((options *)to)->threads = (int)threads;
    return true;
}

static bool read_background(void *to, const setting *s, const char *text)
{
    options *o = to;
    o->backdrop = !strcmp(text, "soft") ? BACKDROP_SOFT : !strcmp(text, "none") ? BACKDROP_NONE : BACKDROP_COLOUR;
    if (o->backdrop != BACKDROP_COLOUR)
        return true;
    const char *end = parse_parts(text, 3, o->backdrop_colour);
    return (end && !*end && within(o->backdrop_colour, 3, s->limits)) ||
           setting_refuse(s, text, "soft, none (transparent), r,g,b or one number (radiance)");
}

static bool read_rig(void *to, const setting *s, const char *text)
{
    char allowed[120] = "";
    for (int i = 0; rig_word(i); i++) {
        list_word(allowed, sizeof allowed, rig_word(i));
        if (!strcmp(text, rig_word(i))) {
            ((options *)to)->rig = (rig)i;
            return true;
        }
    }
    return setting_refuse(s, text, allowed);
}

static bool read_preset(void *to, const setting *s, const char *text)
{
    char allowed[512] = "";
    for (int i = 0; i < PRESETS; i++) {
        list_word(allowed, sizeof allowed, presets[i].name);
        if (!strcmp(text, presets[i].name))
            return shading_read_material(&((options *)to)->shading, presets[i].material);
    }
    return setting_refuse(s, text, allowed);
}

/* ---- The table ------------------------------------------------------------------------------------------------- */

#define FIELD(name) .offset = offsetof(options, name)
#define LIMITS(low, high) .limits = {low, high}

static const setting table[] = {
    {"--preset", "NAME", "a whole material (porcelain); options after it change it", .read = read_preset},
    {"--metals", NULL, "a ball of every metal, with soft boxes for lights", .read = read_scenery},
    {"--grazing", NULL, "balls of gold, copper and chromium lit from behind: exact Fresnel on the left, then\n"
     "approximations", .read = read_scenery},
    {"--grid", NULL, "a panel for each of several alpha (to the right) and sigma (downwards)", .read = read_layout},
    {"--compare", NULL, "Lambert on the left, Oren-Nayar on the right", .read = read_layout},
    {"--rig", "WORD", "studio, boxes or rim: the lights where there is no --light (studio)", .read = read_rig},
    {"--size", "WxH", "pixels of the picture, or of each panel (1024x1024)", .read = read_size},
    {"--samples", "1|4|16", "samples a pixel (4)", .read = read_samples},
    {"--azimuth", "DEGREES", "where the eye stands around the mesh (28)", read_number, FIELD(azimuth),
     LIMITS(-3600, 3600)},
    {"--elevation", "DEGREES", "how far above its middle (21)", read_number, FIELD(elevation), LIMITS(-90, 90)},
    {"--distance", "RADII", "in radii of the mesh (4.5)", read_number, FIELD(distance), LIMITS(0.01f, 1000)},
    {"--fov", "DEGREES", "vertical angle of view (28)", read_number, FIELD(fov), LIMITS(1, 150)},
    {"--two-sided", NULL, "light the backs of faces too", read_switch, FIELD(two_sided)},
    {"--flat", NULL, "one normal a triangle, even where the file has others", read_switch, FIELD(flat)},
    {"--background", "L", "soft, none (transparent), or a radiance (soft)", .read = read_background, LIMITS(0, 1e6f)},
    {"--exposure", "X", "multiplies the radiance in the PNG (1)", read_number, FIELD(exposure), LIMITS(0, 1e6f)},
    {"-o", "FILE", "the picture, as PNG (teapot.png, metals.png or grazing.png)", read_text, FIELD(png)},
    {"--pfm", "FILE", "the linear radiance too, as PFM", read_text, FIELD(pfm)},
    {"--threads", "N", "to shade tiles on (one for each CPU that it may run on)", .read = read_threads},
    {"--time", "SECONDS", "how long to time each arch; 0: not (0.1)", read_number, FIELD(seconds), LIMITS(0, 60)},
    {"--list", NULL, "list every model, metal, light, arch, tier, rig and preset", read_switch, FIELD(list)},
    {"--help", NULL, "this", read_switch, FIELD(help)},
};

static void all_settings(options *o, settings groups[SHADING_GROUPS + 1])
{
    groups[0] = (settings){"Picture", table, sizeof table / sizeof *table, o};
    shading_settings(&o->shading, groups + 1);
}

/* ---- Reading --------------------------------------------------------------------------------------------------- */

static bool read_mesh(void *to, const char *text)
{
    options *o = to;
    if (o->mesh)
        return console_error("%.80s: one mesh is allowed, and it is %.80s", text, o->mesh);
    o->mesh = text;
    return true;
}

/* From the mesh's middle to before the eye. */
static void move_lights(options *o)
{
    for (size_t i = 0; i < o->shading.light_count; i++)
        o->shading.lights[i].position[2] -= o->distance;
}

bool options_read(options *o, int count, char **arguments)
{
    settings groups[SHADING_GROUPS + 1];
    all_settings(o, groups);
    if (!start_from(o, find_scenery(count, arguments)) ||
        !command_line_read(groups, SHADING_GROUPS + 1, count, arguments, read_mesh, o))
        return false;
    if (o->help || o->list)
        return true;
    if (o->mesh && ball_count(o->layout))
        return console_error("%.80s: --metals and --grazing have balls of their own", o->mesh);
    o->mesh = ball_count(o->layout) ? "balls" : o->mesh ? o->mesh : "teapot";
    if (!o->shading.light_count)
        rig_add(&o->shading, o->rig);
    move_lights(o);
    return shading_complete(&o->shading);
}

/* ---- Help and lists -------------------------------------------------------------------------------------------- */

void options_help(void)
{
    options o;
    settings groups[SHADING_GROUPS + 1];
    all_settings(&o, groups);
    printf("usage: facet-demo [options] [teapot | sphere | FILE.obj]\n\n"
           "Rasterizes a mesh, shades it with facet %s, writes a picture, and prints how fast each arch shades.\n"
           "Radiance and irradiance are linear. Lights are in the picture's axes, x right, y up, z to the eye, around\n"
           "the mesh's middle, in its radii.\n\n", facet_version());
    command_line_help(groups, SHADING_GROUPS + 1);
}

void options_list(void)
{
    shading_list();
    for (int i = 0; rig_word(i); i++)
        printf("%-10s %-23s %s\n", "rig", rig_word(i), rig_note(i));
    for (int i = 0; i < PRESETS; i++)
        printf("%-10s %-23s %s: %s\n", "preset", presets[i].name, presets[i].note, presets[i].material);
}
