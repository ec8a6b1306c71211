/* relight: shades a G-buffer's EXR file with the library and compares the result with a renderer's. */
#include "../bench/console.h"
#include "../bench/shading_options.h"
#include "exr.h"

#include <errno.h>
#include <float.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Pixels with a smaller cosine are not compared. */
#define COSINE_MIN 0.02

const char console_program[] = "relight";

typedef struct options {
    shading shading;
    const char *in, *out, *against;
    float eye[3], tangent[3], floor;
    bool has_eye, has_tangent, help, list;
} options;

static const options defaults = {
    .shading = {.material = {.diffuse = {.model = FACET_DIFFUSE_LAMBERT, .albedo = {1, 1, 1}},
                             .fresnel = {.model = FACET_FRESNEL_ONE}},
                .given = FACET_STREAM_ALBEDO},
};

/* ---- The command line -------------------------------------------------------------------------------------------- */

static bool read_vector(const setting *s, const char *text, float out[3])
{
    const char *end = parse_numbers(text, 3, out);
    return (end && !*end) || setting_refuse(s, text, "X,Y,Z");
}

static bool read_eye(void *to, const setting *s, const char *text)
{
    options *o = to;
    return o->has_eye = read_vector(s, text, o->eye);
}

static bool read_tangent(void *to, const setting *s, const char *text)
{
    options *o = to;
    if (!read_vector(s, text, o->tangent))
        return false;
    o->has_tangent = o->tangent[0] != 0 || o->tangent[1] != 0 || o->tangent[2] != 0;
    return o->has_tangent || setting_refuse(s, text, "X,Y,Z, not all 0");
}

#define FIELD(name) .offset = offsetof(options, name)

static const setting table[] = {
    {"--eye", "X,Y,Z", "where the eye is, in the coordinates of Position (needed)", .read = read_eye},
    {"--tangent", "X,Y,Z", "for anisotropic models (they need it): the tangent is perpendicular to the normal, in the\n"
     "plane of the normal and this axis", .read = read_tangent},
    {"--against", "LAYER", "compares with the channels that end in LAYER.R, LAYER.G, LAYER.B", read_text,
     FIELD(against)},
    {"--floor", "RADIANCE", "leaves out what the layer has below it (0)", read_number, FIELD(floor),
     .limits = {0, FLT_MAX}},
    {"--list", NULL, "lists the words, and whether this build and this CPU have them", read_switch, FIELD(list)},
    {"--help", NULL, "shows this", read_switch, FIELD(help)},
};

static void all_settings(options *o, settings groups[SHADING_GROUPS + 1])
{
    groups[0] = (settings){"Files", table, sizeof table / sizeof *table, o};
    shading_settings(&o->shading, groups + 1);
}

static bool read_path(void *to, const char *text)
{
    options *o = to;
    const char **path = !o->in ? &o->in : &o->out;
    if (*path || !*text)
        return console_error("'%.80s': one IN.exr and one OUT.exr are allowed", text);
    *path = text;
    return true;
}

static bool is_anisotropic(const options *o)
{
    return shading_reads(&o->shading.material) & FACET_STREAM_TANGENT;
}

static bool has_light(const shading *s)
{
    bool light = s->light_count;
    for (int c = 0; c < 3; c++)
        light = light || s->ambient[c] > 0 || s->sh[0][c] > 0;
    return light;
}

static bool read_options(options *o, int count, char **arguments)
{
    settings groups[SHADING_GROUPS + 1];
    all_settings(o, groups);
    if (!command_line_read(groups, SHADING_GROUPS + 1, count, arguments, read_path, o))
        return false;
    if (o->help || o->list)
        return true;
    const char *missing = !o->in ? "IN.exr" : !o->out ? "OUT.exr" : !o->has_eye ? "--eye X,Y,Z" :
                          !has_light(&o->shading) ? "--light X,Y,Z/E" :
                          is_anisotropic(o) && !o->has_tangent ? "--tangent X,Y,Z" : NULL;
    if (missing)
        return console_error("%s is missing; --help says more", missing);
    return shading_complete(&o->shading);
}

static void show_help(options *o)
{
    settings groups[SHADING_GROUPS + 1];
    all_settings(o, groups);
    printf("usage: relight IN.exr OUT.exr --eye X,Y,Z --light X,Y,Z/E [options]\n\n"
           "Shades a G-buffer with facet %s and writes radiance. IN.exr has channels that end in Normal.X, Normal.Y,\n"
           "Normal.Z (unit) and Position.X, Position.Y, Position.Z: those of the first part that has them all, under\n"
           "the first prefix that they share, or where each is the only one of its name. OUT.exr gets float R, G, B.\n"
           "A pixel with a zero normal, or with a value that is not finite, is black. Without options the material\n"
           "is white and Lambertian, and Fresnel is one.\n\n", facet_version());
    command_line_help(groups, SHADING_GROUPS + 1);
    printf("\n--against prints how many values it compared, and p50, p99, p99.9 and max of |got - want|/|want|, a\n"
           "line each: of the three channels of all pixels with nv > %g, and nl > %g for every light, where want is\n"
           "at least --floor, which is for pictures whose tails are so dark that the other renderer's own rounding\n"
           "is all there is to see. A percentile p is the least error that p %% of the errors do not exceed; where\n"
           "want is 0, the error is 0 or inf.\n", COSINE_MIN, COSINE_MIN);
}

/* ---- The plan ---------------------------------------------------------------------------------------------------- */

static bool refused(const facet_error *error)
{
    char text[200];
    facet_error_describe(error, text, sizeof text);
    return console_error("%s", text);
}

static bool make_plan(const options *o, facet_plan *plan)
{
    facet_error error;
    return !facet_plan_init(plan, &o->shading.material, o->shading.target, &error) || refused(&error);
}

/* ---- Geometry ---------------------------------------------------------------------------------------------------- */

enum { NORMAL, POSITION, AGAINST };

/* The planes that are computed. */
typedef struct planes {
    float *radiance[3], *view[3], *tangent[3];
    float *errors;                 /* room for three a pixel */
} planes;

static double dot(const double a[3], const double b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static void get(float *const from[3], size_t i, double to[3])
{
    for (int c = 0; c < 3; c++)
        to[c] = (double)from[c][i];
}

/* Unit; zero stays zero. */
static void put_unit(float *const to[3], size_t i, const double v[3])
{
    double length = sqrt(dot(v, v));
    for (int c = 0; c < 3; c++)
        to[c][i] = length > 0 ? (float)(v[c] / length) : 0;
}

/* There is no view vector at the eye itself. */
static void look(const options *o, float *const position[3], size_t count, float *const view[3])
{
    for (size_t i = 0; i < count; i++) {
        double to_eye[3];
        get(position, i, to_eye);
        for (int c = 0; c < 3; c++)
            to_eye[c] = (double)o->eye[c] - to_eye[c];
        put_unit(view, i, to_eye);
    }
}

/* The axis without its part along the normal; where it is along the normal, any tangent will do: the coordinate axis
 * that is least along it, in place of the given one. */
static void tangent_at(const double axis[3], const double n[3], double tangent[3])
{
    double nn = dot(n, n), along = nn > 0 ? dot(axis, n) / nn : 0;
    for (int c = 0; c < 3; c++)
        tangent[c] = axis[c] - along * n[c];
}

static void lay_tangents(const options *o, float *const normal[3], size_t count, float *const tangent[3])
{
    const double axis[3] = {(double)o->tangent[0], (double)o->tangent[1], (double)o->tangent[2]};
    for (size_t i = 0; i < count; i++) {
        double n[3], t[3], other[3] = {0, 0, 0};
        get(normal, i, n);
        tangent_at(axis, n, t);
        if (dot(t, t) <= 1e-12 * dot(axis, axis)) {
            int least = fabs(n[0]) < fabs(n[1]) ? 0 : 1;
            other[fabs(n[2]) < fabs(n[least]) ? 2 : least] = 1;
            tangent_at(other, n, t);
        }
        put_unit(tangent, i, t);
    }
}

/* ---- Shading ----------------------------------------------------------------------------------------------------- */

static bool shade(const options *o, const facet_plan *plan, const exr_layer *layers, const planes *p, size_t count)
{
    const shading *s = &o->shading;
    facet_batch batch = {.count = count, .lights = s->lights, .light_count = s->light_count};
    facet_error error;
    memcpy(batch.ambient, s->ambient, sizeof batch.ambient);
    memcpy(batch.sh, s->sh, sizeof batch.sh);
    for (int c = 0; c < 3; c++) {
        batch.normal[c] = layers[NORMAL].plane[c];
        batch.position[c] = layers[POSITION].plane[c];
        batch.view[c] = p->view[c];
        batch.tangent[c] = is_anisotropic(o) ? p->tangent[c] : NULL;
        batch.radiance[c] = p->radiance[c];
    }
    return !facet_shade(plan, &batch, &error) || refused(&error);
}

/* ---- Comparing --------------------------------------------------------------------------------------------------- */

/* Cosine of the angle between the normal and the light. */
static double light_cosine(const facet_light *light, const double normal[3], const double position[3])
{
    double l[3];
    for (int c = 0; c < 3; c++)
        l[c] = light_has_position(light) ? (double)light->position[c] - position[c] : (double)light->direction[c];
    double length = sqrt(dot(l, l));
    return length > 0 ? dot(normal, l) / length : 0;
}

static bool compared(const options *o, const exr_layer *layers, float *const view[3], size_t i)
{
    double n[3], v[3], position[3];
    get(layers[NORMAL].plane, i, n);
    get(layers[POSITION].plane, i, position);
    get(view, i, v);
    bool lit = dot(n, v) > COSINE_MIN;
    for (size_t k = 0; lit && k < o->shading.light_count; k++)
        lit = light_cosine(&o->shading.lights[k], n, position) > COSINE_MIN;
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

/* Sorts the errors of all compared values into the plane of errors; returns how many. */
static size_t compare(const options *o, const exr_layer *layers, const planes *p, size_t count)
{
    size_t found = 0;
    for (size_t i = 0; i < count; i++)
        for (int c = 0; c < 3 && compared(o, layers, p->view, i); c++) {
            float want = layers[AGAINST].plane[c][i];
            if (!(want < o->floor))
                p->errors[found++] = relative_error((double)p->radiance[c][i], (double)want);
        }
    qsort(p->errors, found, sizeof *p->errors, ascending);
    return found;
}

static bool print_errors(const float *errors, size_t count)
{
    printf("compared %zu\np50 %.3e\np99 %.3e\np99.9 %.3e\nmax %.3e\n", count,
           (double)percentile(errors, count, 50), (double)percentile(errors, count, 99),
           (double)percentile(errors, count, 99.9), (double)percentile(errors, count, 100));
    return !fflush(stdout) || console_error("standard output: %s", strerror(errno));
}

/* ---- The whole --------------------------------------------------------------------------------------------------- */

static bool write_image(const options *o, const exr_frame *frame, float *const radiance[3])
{
    char why[EXR_WHY];
    return exr_save(o->out, frame, radiance, why) || console_error("%.200s: %s", o->out, why);
}

static bool relight_planes(const options *o, const facet_plan *plan, const exr_frame *frame, const exr_layer *layers,
                           const planes *p)
{
    size_t count = frame->width * frame->height, found = 0;
    look(o, layers[POSITION].plane, count, p->view);
    if (is_anisotropic(o))
        lay_tangents(o, layers[NORMAL].plane, count, p->tangent);
    if (!shade(o, plan, layers, p, count))
        return false;
    if (o->against && !(found = compare(o, layers, p, count)))
        return console_error("%.200s: no pixel to compare: none has nv > %g, nl > %g and a value of %g or more", o->in,
                             COSINE_MIN, COSINE_MIN, (double)o->floor);
    return write_image(o, frame, p->radiance) && (!o->against || print_errors(p->errors, found));
}

/* Radiance and views, then tangents or errors or both, as far as they are wanted. */
static planes divide(const options *o, float *space, size_t count)
{
    planes p = {.errors = space + (is_anisotropic(o) ? 9 : 6) * count};
    for (size_t c = 0; c < 3; c++) {
        p.radiance[c] = space + c * count;
        p.view[c] = space + (3 + c) * count;
        p.tangent[c] = is_anisotropic(o) ? space + (6 + c) * count : NULL;
    }
    return p;
}

static bool relight(const options *o)
{
    facet_plan plan;
    exr_frame frame;
    exr_layer layers[] = {[NORMAL] = {"Normal", "XYZ", {0}}, [POSITION] = {"Position", "XYZ", {0}},
                          [AGAINST] = {o->against, "RGB", {0}}};
    int count = o->against ? 3 : 2;
    size_t wanted = 6 + (is_anisotropic(o) ? 3u : 0u) + (o->against ? 3u : 0u);
    char why[EXR_WHY];
    if (!make_plan(o, &plan))
        return false;
    if (!exr_load(o->in, &frame, layers, count, why))
        return console_error("%.200s: %s", o->in, why);
    float *space = calloc(frame.width * frame.height, wanted * sizeof(float));
    planes p = space ? divide(o, space, frame.width * frame.height) : (planes){0};
    bool done = space ? relight_planes(o, &plan, &frame, layers, &p)
                      : console_error("not enough memory for %zu x %zu pixels", frame.width, frame.height);
    free(space);
    exr_free(layers, count);
    return done;
}

int main(int count, char **arguments)
{
    options o = defaults;
    bool done = read_options(&o, count, arguments);
    if (done && o.help)
        show_help(&o);
    else if (done && o.list)
        shading_list();
    else if (done)
        done = relight(&o);
    return done ? EXIT_SUCCESS : EXIT_FAILURE;
}
