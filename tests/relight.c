/* relight: shades a G-buffer's EXR file with the library and compares the result with a renderer's. */
#include "exr.h"
#include "facet.h"

#include <ctype.h>
#include <errno.h>
#include <float.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Pixels with a smaller cosine are not compared. */
#define COSINE_MIN 0.02

typedef struct options {
    const char *in, *out, *against;
    double eye[3];
    bool has_eye, help, list;
    facet_material material;
    facet_target target;
    facet_light *lights;
    size_t light_count;
    uint32_t given;                /* bit facet_kind: the kind's word came with a parameter */
} options;

static const options defaults = {
    .material = {.diffuse = {.model = FACET_DIFFUSE_LAMBERT, .albedo = {1, 1, 1}},
                 .fresnel = {.model = FACET_FRESNEL_ONE}},
};

/* One line, whatever a file name holds. */
static bool __attribute__((format(printf, 1, 2))) complain(const char *format, ...)
{
    char line[1024];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(line, sizeof line, format, arguments);
    va_end(arguments);
    for (char *c = line; *c; c++)
        if (iscntrl((unsigned char)*c))
            *c = '?';
    fprintf(stderr, "relight: %s\n", line);
    return false;
}

/* ---- Values ------------------------------------------------------------------------------------------------------ */

typedef struct setting {
    const char *name, *value, *help;      /* no value: a switch */
    bool (*read)(options *o, const struct setting *s, const char *text);
    facet_kind kind;                      /* of a word, with the word's and its parameter's places in options */
    size_t word, parameter;
    int parts;                            /* floats of the parameter; 0: there is none */
} setting;

static bool refuse(const setting *s, const char *text, const char *allowed)
{
    return complain("%s '%.80s': allowed is %s", s->name, text, allowed);
}

/* `count` numbers with `separator` between them. Returns what follows, or NULL. */
static const char *numbers(const char *text, char separator, int count, double *out)
{
    for (int i = 0; i < count; i++) {
        char *end;
        if (i && *text++ != separator)
            return NULL;
        out[i] = strtod(text, &end);
        if (end == text || isspace((unsigned char)*text) || !(fabs(out[i]) <= FLT_MAX))
            return NULL;
        text = end;
    }
    return text;
}

/* Three numbers, or one for all three, from 0 to `most`. */
static bool colour(const char *text, char separator, double most, float out[3])
{
    double value[3];
    int count = strchr(text, separator) ? 3 : 1;
    const char *end = numbers(text, separator, count, value);
    if (!end || *end)
        return false;
    for (int c = 0; c < 3; c++) {
        double channel = value[count == 3 ? c : 0];
        if (!(channel >= 0 && channel <= most))
            return false;
        out[c] = (float)channel;
    }
    return true;
}

static bool normalise(const double from[3], float to[3])
{
    double largest = fmax(fmax(fabs(from[0]), fabs(from[1])), fabs(from[2]));
    if (!(largest > 0 && largest <= DBL_MAX))
        return false;
    double x = from[0] / largest, y = from[1] / largest, z = from[2] / largest, length = sqrt(x * x + y * y + z * z);
    to[0] = (float)(x / length);
    to[1] = (float)(y / length);
    to[2] = (float)(z / length);
    return true;
}

/* The enumerator of the first `length` characters, or -1 and has said what is allowed. */
static int find_word(const setting *s, const char *text, size_t length)
{
    char word[80] = "", allowed[512] = "";
    if (length < sizeof word)
        memcpy(word, text, length);
    int value = facet_value(s->kind, word);
    if (value >= 0 && facet_has(s->kind, value))
        return value;
    for (int i = 0; facet_word(s->kind, i); i++) {
        size_t used = strlen(allowed);
        if (facet_has(s->kind, i))
            snprintf(allowed + used, sizeof allowed - used, "%s%s", used ? ", " : "", facet_word(s->kind, i));
    }
    refuse(s, text, allowed);
    return -1;
}

/* WORD or, where the setting has parameters, WORD:PARAMETER. */
static bool read_word(options *o, const setting *s, const char *text)
{
    size_t length = s->parts ? strcspn(text, ":") : strlen(text);
    int value = find_word(s, text, length);
    if (value < 0)
        return false;
    memcpy((char *)o + s->word, &value, sizeof value);
    o->given &= ~(1u << s->kind);
    if (!text[length])
        return true;
    o->given |= 1u << s->kind;
    float *parameter = (float *)((char *)o + s->parameter);
    if (s->parts == 3)
        return colour(text + length + 1, ',', 1, parameter) ||
               refuse(s, text, "WORD:F0, F0 being r,g,b or one number, from 0 to 1");
    double number;
    const char *end = numbers(text + length + 1, 0, 1, &number);
    if (!end || *end)
        return refuse(s, text, s->value);
    *parameter = (float)number;
    return true;
}

static bool read_albedo(options *o, const setting *s, const char *text)
{
    return colour(text, ',', FLT_MAX, o->material.diffuse.albedo) ||
           refuse(s, text, "r,g,b or one number, not negative");
}

static bool read_eye(options *o, const setting *s, const char *text)
{
    const char *end = numbers(text, ',', 3, o->eye);
    o->has_eye = end && !*end;
    return o->has_eye || refuse(s, text, s->value);
}

static bool read_light(options *o, const setting *s, const char *text)
{
    double direction[3];
    facet_light light = {.kind = FACET_LIGHT_DIRECTIONAL};
    const char *end = numbers(text, ',', 3, direction);
    if (!end || *end != ',' || !colour(end + 1, ':', FLT_MAX, light.irradiance) ||
        !normalise(direction, light.direction))
        return refuse(s, text, "X,Y,Z,E: a direction that is not 0 and an irradiance, not negative, E or r:g:b");
    o->lights[o->light_count++] = light;
    return true;
}

static bool read_against(options *o, const setting *s, const char *text)
{
    o->against = text;
    return *text ? true : refuse(s, text, "a layer's name");
}

static bool read_switch(options *o, const setting *s, const char *text)
{
    (void)text;
    *(!strcmp(s->name, "--help") ? &o->help : &o->list) = true;
    return true;
}

#define WORD(kind, field) FACET_KIND_##kind, offsetof(options, field)
#define PARAMETER(field, parts) offsetof(options, field), parts

static const setting table[] = {
    {"--eye", "X,Y,Z", "where the eye is, in the coordinates of Position (needed)", .read = read_eye},
    {"--light", "X,Y,Z,E", "direction from the surface to the light, of any length, and irradiance, one number\n"
     "or r:g:b (needed; may repeat)", .read = read_light},
    {"--diffuse", "WORD[:SIGMA]", "diffuse model; of fujii, SIGMA is its r (lambert)", read_word,
     WORD(DIFFUSE, material.diffuse.model), PARAMETER(material.diffuse.sigma, 1)},
    {"--albedo", "r,g,b", "diffuse albedo, or one number (1,1,1)", .read = read_albedo},
    {"--specular", "WORD[:ALPHA]", "microfacet distribution; ALPHA is the square of perceptual roughness (none)",
     read_word, WORD(DISTRIBUTION, material.specular.model), PARAMETER(material.specular.alpha, 1)},
    {"--masking", "WORD", "masking and shadowing (smith-correlated)", read_word,
     WORD(MASKING, material.specular.masking), 0, 0},
    {"--fresnel", "WORD[:F0]", "Fresnel; F0 is r,g,b or one number (one)", read_word,
     WORD(FRESNEL, material.fresnel.model), PARAMETER(material.fresnel.f0, 3)},
    {"--arch", "WORD", "architecture (best)", read_word, WORD(ARCH, target.arch), 0, 0},
    {"--tier", "WORD", "tier (fast)", read_word, WORD(TIER, target.tier), 0, 0},
    {"--against", "LAYER", "compares with the channels that end in LAYER.R, LAYER.G, LAYER.B", .read = read_against},
    {"--list", NULL, "lists the words, and whether this build and this CPU have them", .read = read_switch},
    {"--help", NULL, "shows this", .read = read_switch},
};

enum { SETTINGS = sizeof table / sizeof *table };

/* ---- The command line -------------------------------------------------------------------------------------------- */

static const setting *find_setting(const char *name, size_t length)
{
    for (int i = 0; i < SETTINGS; i++)
        if (strlen(table[i].name) == length && !strncmp(table[i].name, name, length))
            return &table[i];
    return NULL;
}

/* --NAME VALUE, --NAME=VALUE, or a switch. */
static bool read_option(options *o, int count, char **arguments, int *at)
{
    const char *text = arguments[(*at)++], *value = NULL;
    size_t length = strcspn(text, "=");
    const setting *s = find_setting(text, length);
    if (!s)
        return complain("%.80s: no such option; --help lists them", text);
    if (!s->value)
        return text[length] ? complain("%s takes no value", s->name) : s->read(o, s, NULL);
    if (text[length])
        value = text + length + 1;
    else if (*at < count)
        value = arguments[(*at)++];
    return value ? s->read(o, s, value) : complain("%s needs a value: %s", s->name, s->value);
}

static bool read_path(options *o, const char *text)
{
    const char **path = !o->in ? &o->in : &o->out;
    if (*path || !*text)
        return complain("'%.80s': one IN.exr and one OUT.exr are allowed", text);
    *path = text;
    return true;
}

static bool read_options(options *o, int count, char **arguments)
{
    for (int at = 1; at < count;) {
        bool read = arguments[at][0] == '-' ? read_option(o, count, arguments, &at) : read_path(o, arguments[at++]);
        if (!read)
            return false;
    }
    if (o->help || o->list)
        return true;
    const char *missing = !o->in ? "IN.exr" : !o->out ? "OUT.exr" : !o->has_eye ? "--eye X,Y,Z" :
                          !o->light_count ? "--light X,Y,Z,E" : NULL;
    return !missing || complain("%s is missing; --help says more", missing);
}

static void show_help(void)
{
    printf("usage: relight IN.exr OUT.exr --eye X,Y,Z --light X,Y,Z,E [options]\n\n"
           "Shades a G-buffer with facet %s and writes radiance. IN.exr has channels that end in Normal.X, Normal.Y,\n"
           "Normal.Z (unit) and Position.X, Position.Y, Position.Z: those of the first part that has them all, under\n"
           "the first prefix that they share, or where each is the only one of its name. OUT.exr gets float R, G, B.\n"
           "A pixel with a zero normal, or with a value that is not finite, is black.\n\n", facet_version());
    for (int i = 0; i < SETTINGS; i++) {
        char left[40];
        const char *help = table[i].help, *second = strchr(help, '\n');
        snprintf(left, sizeof left, "%s %s", table[i].name, table[i].value ? table[i].value : "");
        printf("  %-24s %.*s\n", left, second ? (int)(second - help) : (int)strlen(help), help);
        if (second)
            printf("  %-24s %s\n", "", second + 1);
    }
    printf("\n--against prints p50, p99, p99.9 and max of |got - want|/|want|, a line each, over the three channels\n"
           "of all pixels with nv > %g, and nl > %g for every light. A percentile p is the least error that p %% of\n"
           "the errors do not exceed; where want is 0, the error is 0 or inf.\n", COSINE_MIN, COSINE_MIN);
}

static void show_list(void)
{
    for (int s = 0; s < SETTINGS; s++)
        for (int i = 0; table[s].read == read_word && facet_word(table[s].kind, i); i++) {
            bool other_cpu = table[s].kind == FACET_KIND_ARCH && facet_arch_lanes((facet_arch)i);
            printf("%-9s %-18s %s\n", table[s].name + 2, facet_word(table[s].kind, i),
                   facet_has(table[s].kind, i) ? "available" : other_cpu ? "not on this CPU" : "not in this build");
        }
}

/* ---- The plan ---------------------------------------------------------------------------------------------------- */

/* Whether the material reads a parameter: whether its plan changes with it. */
static bool reads(const options *o, const setting *s)
{
    facet_plan plans[2];
    for (int i = 0; i < 2; i++) {
        options probe = *o;
        for (int c = 0; c < s->parts; c++)
            ((float *)((char *)&probe + s->parameter))[c] = i ? 0.25f : 0.5f;
        if (facet_plan_init(&plans[i], &probe.material, probe.target, NULL))
            return false;
    }
    return memcmp(&plans[0], &plans[1], sizeof plans[0]) != 0;
}

static bool check_parameters(const options *o)
{
    for (const setting *s = table; s < table + SETTINGS; s++) {
        bool given = o->given >> s->kind & 1;
        bool unused = s->kind == FACET_KIND_FRESNEL && o->material.specular.model == FACET_DISTRIBUTION_NONE;
        if (!s->parts || unused || reads(o, s) == given)
            continue;
        int value;
        memcpy(&value, (const char *)o + s->word, sizeof value);
        const char *word = facet_word(s->kind, value);
        return given ? complain("%s %s takes no parameter", s->name, word)
                     : complain("%s %s needs its parameter: %s", s->name, word, s->value);
    }
    return true;
}

static bool make_plan(const options *o, facet_plan *plan)
{
    facet_error error;
    char text[200];
    if (!facet_plan_init(plan, &o->material, o->target, &error))
        return check_parameters(o);
    facet_error_describe(&error, text, sizeof text);
    return complain("%s", text);
}

/* ---- Shading ----------------------------------------------------------------------------------------------------- */

enum { NORMAL, POSITION, AGAINST };

/* Turns positions into view vectors; there is none at the eye itself. */
static void look(float *const position[3], size_t count, const double eye[3])
{
    for (size_t i = 0; i < count; i++) {
        double to_eye[3];
        float view[3] = {0, 0, 0};
        for (int c = 0; c < 3; c++)
            to_eye[c] = eye[c] - (double)position[c][i];
        normalise(to_eye, view);
        for (int c = 0; c < 3; c++)
            position[c][i] = view[c];
    }
}

static bool shade(const options *o, const facet_plan *plan, float *const normal[3], float *const view[3], size_t count,
                  float *const radiance[3])
{
    facet_batch batch = {.count = count, .lights = o->lights, .light_count = o->light_count};
    facet_error error;
    char text[200];
    for (int c = 0; c < 3; c++) {
        batch.normal[c] = normal[c];
        batch.view[c] = view[c];
        batch.radiance[c] = radiance[c];
    }
    if (!facet_shade(plan, &batch, &error))
        return true;
    facet_error_describe(&error, text, sizeof text);
    return complain("%s", text);
}

/* ---- Comparing --------------------------------------------------------------------------------------------------- */

static double dot_at(float *const a[3], size_t i, const double b[3])
{
    return (double)a[0][i] * b[0] + (double)a[1][i] * b[1] + (double)a[2][i] * b[2];
}

static bool compared(const options *o, float *const normal[3], float *const view[3], size_t i)
{
    const double v[3] = {(double)view[0][i], (double)view[1][i], (double)view[2][i]};
    bool lit = dot_at(normal, i, v) > COSINE_MIN;
    for (size_t k = 0; lit && k < o->light_count; k++) {
        const float *l = o->lights[k].direction;
        lit = dot_at(normal, i, (const double[3]){(double)l[0], (double)l[1], (double)l[2]}) > COSINE_MIN;
    }
    return lit;
}

static float relative_error(double got, double want)
{
    double error = got == want ? 0 : fabs(got - want) / fabs(want);
    return isnan(error) ? INFINITY : (float)error;
}

static int ascending(const void *a, const void *b)
{
    float x = *(const float *)a, y = *(const float *)b;
    return (x > y) - (x < y);
}

static float percentile(const float *sorted, size_t count, double percent)
{
    size_t rank = (size_t)ceil(percent / 100 * (double)count);
    return sorted[rank > 1 ? rank - 1 : 0];
}

/* Sorts the errors of all compared pixels into `errors`, which has room for three a pixel; returns how many. */
static size_t compare(const options *o, const exr_layer layers[3], float *const radiance[3], size_t count,
                      float *errors)
{
    size_t found = 0;
    for (size_t i = 0; i < count; i++)
        for (int c = 0; c < 3 && compared(o, layers[NORMAL].plane, layers[POSITION].plane, i); c++)
            errors[found++] = relative_error((double)radiance[c][i], (double)layers[AGAINST].plane[c][i]);
    qsort(errors, found, sizeof *errors, ascending);
    return found;
}

static bool print_errors(const float *errors, size_t count)
{
    printf("p50 %.3e\np99 %.3e\np99.9 %.3e\nmax %.3e\n", (double)percentile(errors, count, 50),
           (double)percentile(errors, count, 99), (double)percentile(errors, count, 99.9),
           (double)percentile(errors, count, 100));
    return !fflush(stdout) || complain("standard output: %s", strerror(errno));
}

/* ---- The whole --------------------------------------------------------------------------------------------------- */

static bool write_image(const options *o, const exr_frame *frame, float *const radiance[3])
{
    char why[EXR_WHY];
    return exr_save(o->out, frame, radiance, why) || complain("%.200s: %s", o->out, why);
}

/* `space` has room for the radiance's three planes and, to compare, for as many errors. */
static bool relight_planes(const options *o, const facet_plan *plan, const exr_frame *frame, const exr_layer *layers,
                           float *space)
{
    size_t count = frame->width * frame->height, found = 0;
    float *const radiance[3] = {space, space + count, space + 2 * count}, *errors = space + 3 * count;
    look(layers[POSITION].plane, count, o->eye);
    if (!shade(o, plan, layers[NORMAL].plane, layers[POSITION].plane, count, radiance))
        return false;
    if (o->against && !(found = compare(o, layers, radiance, count, errors)))
        return complain("%.200s: no pixel to compare: none has nv > %g and nl > %g", o->in, COSINE_MIN, COSINE_MIN);
    return write_image(o, frame, radiance) && (!o->against || print_errors(errors, found));
}

static bool relight(const options *o)
{
    facet_plan plan;
    exr_frame frame;
    exr_layer layers[] = {[NORMAL] = {"Normal", "XYZ", {0}}, [POSITION] = {"Position", "XYZ", {0}},
                          [AGAINST] = {o->against, "RGB", {0}}};
    int count = o->against ? 3 : 2;
    char why[EXR_WHY];
    if (!make_plan(o, &plan))
        return false;
    if (!exr_load(o->in, &frame, layers, count, why))
        return complain("%.200s: %s", o->in, why);
    float *space = calloc(frame.width * frame.height, (o->against ? 6 : 3) * sizeof(float));
    bool done = space ? relight_planes(o, &plan, &frame, layers, space)
                      : complain("not enough memory for %zu x %zu pixels", frame.width, frame.height);
    free(space);
    exr_free(layers, count);
    return done;
}

int main(int count, char **arguments)
{
    options o = defaults;
    bool done = (o.lights = calloc((size_t)count, sizeof *o.lights)) || complain("not enough memory");
    done = done && read_options(&o, count, arguments);
    if (done && o.help)
        show_help();
    else if (done && o.list)
        show_list();
    else if (done)
        done = relight(&o);
    free(o.lights);
    return done ? EXIT_SUCCESS : EXIT_FAILURE;
}
