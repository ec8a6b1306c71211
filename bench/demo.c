/* facet-demo: a small software rasterizer that shades its tiles with facet, on threads, as a backend would. */
#include "balls.h"
#include "console.h"
#include "demo_options.h"
#include "image.h"
#include "raster.h"
#include "shading_rate.h"
#include "workers.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* ---- Panels ---------------------------------------------------------------------------------------------------- */

static const float grid_alpha[] = {0.05f, 0.1f, 0.2f, 0.35f, 0.6f, 1.0f};
static const float grid_sigma[] = {0.0f, 0.3f, 0.6f, 1.0f};

enum {
    GRID_COLUMNS = sizeof grid_alpha / sizeof *grid_alpha,
    GRID_ROWS = sizeof grid_sigma / sizeof *grid_sigma,
    GRID = GRID_COLUMNS * GRID_ROWS,
    PLAN_LIMIT = GRID > BALL_LIMIT ? GRID : BALL_LIMIT
};

const char console_program[] = "facet-demo";

/* What a thread did. */
typedef struct share {
    double raster_seconds, shade_seconds, encode_seconds;
    size_t covered;
    facet_error error;
} share;

/* What one run renders: the same view in every panel, each with its own plan; or one panel, a plan for every part of
 * the mesh. */
typedef struct scene {
    const options *options;
    mesh mesh;
    raster raster;
    facet_plan plans[PLAN_LIMIT];
    size_t plan_count;
    uint32_t streams;                    /* FACET_STREAM_*: of the G-buffer, beside normals and views */
    size_t columns, rows;                /* of panels */
    size_t width, height;                /* of the picture, pixels */
    uint8_t *rgba;
    float *rgb;                          /* linear radiance where a PFM is wanted, or NULL */
    share shares[WORKER_LIMIT];          /* by thread */
    int threads;                         /* how many there were */
    double seconds;                      /* from triangles to pixels, by the clock on the wall */
} scene;

/* Rough, whatever the model was. */
static void roughen(facet_material *m, float sigma)
{
    bool smooth = !(shading_reads(m) & FACET_STREAM_SIGMA);
    if (smooth)
        m->diffuse.model = FACET_DIFFUSE_OREN_NAYAR;
    if (smooth || !(m->diffuse.sigma > 0))
        m->diffuse.sigma = sigma;
}

static facet_material panel_material(const options *o, size_t column, size_t row)
{
    facet_material m = o->shading.material;
    if (o->layout == LAYOUT_COMPARE && column == 0)
        m.diffuse.model = FACET_DIFFUSE_LAMBERT;
    if (o->layout == LAYOUT_COMPARE && column == 1)
        roughen(&m, 0.7f);
    if (o->layout == LAYOUT_GRID) {
        roughen(&m, 0);
        m.diffuse.sigma = grid_sigma[row];
        m.specular.model = FACET_DISTRIBUTION_GGX;
        m.specular.alpha = grid_alpha[column];
        m.convention.roughness = facet_roughness_from_alpha(grid_alpha[column]);
        m.convention.glossiness = 1 - m.convention.roughness;
    }
    return m;
}

static facet_material plan_material(const scene *s, size_t plan)
{
    const options *o = s->options;
    return ball_count(o->layout) ? ball_material(o, plan) : panel_material(o, plan % s->columns, plan / s->columns);
}

static bool facet_refused(const facet_error *error)
{
    char text[256];
    facet_error_describe(error, text, sizeof text);
    return console_error("%s", text);
}

static bool make_plans(scene *s)
{
    const options *o = s->options;
    facet_target target = o->shading.target;
    target.arches = facet_arches();
    s->columns = o->layout == LAYOUT_GRID ? GRID_COLUMNS : o->layout == LAYOUT_COMPARE ? 2 : 1;
    s->rows = o->layout == LAYOUT_GRID ? GRID_ROWS : 1;
    s->plan_count = s->columns * s->rows * s->mesh.parts;
    for (size_t i = 0; i < s->plan_count; i++) {
        facet_material material = plan_material(s, i);
        facet_error error;
        if (facet_plan_init(&s->plans[i], &material, target, &error) != FACET_OK)
            return facet_refused(&error);
        s->streams |= shading_reads(&material) & FACET_STREAM_TANGENT;
    }
    for (size_t i = 0; i < o->shading.light_count; i++)
        s->streams |= light_has_position(&o->shading.lights[i]) ? FACET_STREAM_POSITION : 0u;
    return true;
}

/* ---- A tile, from G-buffer to pixels --------------------------------------------------------------------------- */

typedef struct tile {
    gbuffer g;
    float radiance[3][TILE_SAMPLES];
    float pixel[3][TILE_SAMPLES], opacity[TILE_SAMPLES];   /* pixel x, y at y TILE_WIDTH + x */
    size_t x, y, width, height;                            /* in its panel, pixels */
} tile;

/* The studio's wall: brightest behind the mesh, darker to the corners and the floor. */
static void soft_backdrop(const options *o, size_t x, size_t y, float out[3])
{
    static const float centre[3] = {0.20f, 0.215f, 0.24f}, rim[3] = {0.021f, 0.023f, 0.027f};
    double u = ((double)x + 0.5) / (double)o->width - 0.5, v = ((double)y + 0.5) / (double)o->height - 0.42;
    double t = 1 / (1 + 5 * (u * u + v * v)) / (1 + 5 * (u * u + v * v));
    for (int c = 0; c < 3; c++)
        out[c] = rim[c] + (float)t * (centre[c] - rim[c]);
}

static void backdrop_at(const options *o, size_t x, size_t y, float out[3])
{
    if (o->backdrop == BACKDROP_SOFT)
        soft_backdrop(o, x, y, out);
    else
        memcpy(out, o->backdrop_colour, 3 * sizeof *out);
}

/* Averages pixel x, y of the tile over its samples: those not covered show the backdrop; with none behind it, the
 * covered ones alone make the colour, and their share the opacity. */
static void average(const options *o, tile *t, size_t x, size_t y)
{
    size_t edge = o->samples, to = y * TILE_WIDTH + x, covered = 0;
    float sum[3] = {0, 0, 0}, behind[3] = {0, 0, 0};
    for (size_t i = 0; i < edge * edge; i++) {
        size_t from = (y * edge + i / edge) * TILE_WIDTH + x * edge + i % edge;
        if (!(t->g.coverage[from / 8] >> from % 8 & 1))
            continue;
        covered++;
        for (int c = 0; c < 3; c++)
            sum[c] += t->radiance[c][from];
    }
    size_t shown = o->backdrop == BACKDROP_NONE ? covered : edge * edge;
    if (shown > covered)
        backdrop_at(o, t->x + x, t->y + y, behind);
    t->opacity[to] = (float)covered / (float)(edge * edge);
    for (int c = 0; c < 3; c++)
        t->pixel[c][to] = shown ? (sum[c] + (float)(shown - covered) * behind[c]) / (float)shown : 0;
}

static bool encode(const scene *s, const tile *t, size_t first, facet_error *error)
{
    bool transparent = s->options->backdrop == BACKDROP_NONE;
    facet_image image = {
        .width = t->width, .height = t->height, .stride = TILE_WIDTH,
        .radiance = {t->pixel[0], t->pixel[1], t->pixel[2]}, .exposure = s->options->exposure,
        .opacity_from = transparent ? FACET_OPACITY_STREAM : FACET_OPACITY_FULL, .opacity = t->opacity,
        .pixels = s->rgba + 4 * first, .pitch = (ptrdiff_t)(4 * s->width),
    };
    return facet_encode(&image, error) == FACET_OK;
}

static void keep_radiance(const scene *s, const tile *t, size_t first)
{
    for (size_t i = 0; i < t->width * t->height; i++)
        for (size_t c = 0; c < 3; c++)
            s->rgb[3 * (first + i / t->width * s->width + i % t->width) + c] =
                t->pixel[c][i / t->width * TILE_WIDTH + i % t->width];
}

/* Shades the tile's G-buffer for one panel, part by part: a part is what the coverage leaves. */
static bool shade_parts(const scene *s, tile *t, size_t panel, facet_error *error)
{
    facet_batch batch = tile_batch(s->options, s->streams, &t->g, t->radiance);
    uint8_t coverage[TILE_SAMPLES / 8];
    for (size_t part = 0; part < s->mesh.parts; part++) {
        bool seen = t->g.covered;
        if (s->mesh.parts > 1) {
            seen = seen && raster_part(&t->g, part, coverage);
            batch.coverage = coverage;
        }
        if (seen && facet_shade(&s->plans[panel * s->mesh.parts + part], &batch, error) != FACET_OK)
            return false;
    }
    return true;
}

/* Shades and encodes the tile's G-buffer for one panel. */
static bool finish_tile(const scene *s, tile *t, size_t panel, share *mine)
{
    const options *o = s->options;
    size_t first = (panel / s->columns * o->height + t->y) * s->width + panel % s->columns * o->width + t->x;
    double start = console_seconds();
    if (!shade_parts(s, t, panel, &mine->error))
        return false;
    double shaded = console_seconds();
    mine->shade_seconds += shaded - start;
    mine->covered += t->g.covered;
    for (size_t i = 0; i < t->width * t->height; i++)
        average(o, t, i % t->width, i / t->width);
    if (s->rgb)
        keep_radiance(s, t, first);
    bool encoded = encode(s, t, first, &mine->error);
    mine->encode_seconds += console_seconds() - shaded;
    return encoded;
}

/* ---- A frame --------------------------------------------------------------------------------------------------- */

/* Finds the nearest triangle at every sample, on one thread: a fifth of what the teapot takes. */
static void draw(scene *s)
{
    enum { AT_ONCE = 256 };
    for (size_t i = 0; i < s->mesh.triangle_count; i += AT_ONCE) {
        size_t left = s->mesh.triangle_count - i;
        raster_draw(&s->raster, &s->mesh, i, left < AT_ONCE ? left : AT_ONCE);
        console_progress("rasterizing", i, s->mesh.triangle_count);
    }
}

/* From G-buffer to pixels. Tiles share nothing but the picture that they are parts of. */
static bool render_tile(void *context, int worker, size_t i)
{
    scene *s = context;
    share *mine = &s->shares[worker];
    const options *o = s->options;
    size_t columns, count = raster_tiles(&s->raster, &columns);
    size_t width = TILE_WIDTH / o->samples, height = TILE_HEIGHT / o->samples;
    tile t;
    t.x = i % columns * width;
    t.y = i / columns * height;
    t.width = o->width - t.x < width ? o->width - t.x : width;
    t.height = o->height - t.y < height ? o->height - t.y : height;
    double start = console_seconds();
    raster_tile(&s->raster, &s->mesh, i % columns, i / columns, s->streams, &t.g);
    mine->raster_seconds += console_seconds() - start;
    for (size_t panel = 0; panel < s->columns * s->rows; panel++)
        if (!finish_tile(s, &t, panel, mine))
            return false;
    if (!worker)
        console_progress("shading", i, count);
    return true;
}

static bool render_frame(scene *s)
{
    size_t columns, count = raster_tiles(&s->raster, &columns);
    double start = console_seconds();
    draw(s);
    s->shares[0].raster_seconds = console_seconds() - start;
    s->threads = workers_run(s->options->threads, count, render_tile, s);
    s->seconds = console_seconds() - start;
    for (int i = 0; i < WORKER_LIMIT; i++)
        if (s->shares[i].error.code != FACET_OK)
            return facet_refused(&s->shares[i].error);
    return true;
}

/* Samples and pixels are capped so that no size overflows and memory stays at about a gigabyte. */
static bool allocate(scene *s)
{
    enum { LIMIT = 1 << 25 };
    const options *o = s->options;
    s->width = o->width * s->columns;
    s->height = o->height * s->rows;
    if (o->width * o->samples > LIMIT / (o->height * o->samples) || s->width > LIMIT / s->height)
        return console_error("--size %zux%zu: the picture would have more than %d samples or pixels", o->width,
                             o->height, LIMIT);
    s->rgba = malloc(4 * s->width * s->height);
    s->rgb = o->pfm ? malloc(3 * sizeof *s->rgb * s->width * s->height) : NULL;
    bool room = raster_init(&s->raster, o->width * o->samples, o->height * o->samples, (double)o->fov);
    return (s->rgba && (s->rgb || !o->pfm) && room) || console_error("not enough memory for the picture");
}

static bool render(scene *s)
{
    const options *o = s->options;
    bool opened = ball_count(o->layout) ? ball_mesh(&s->mesh, o->layout) : mesh_open(&s->mesh, o->mesh, o->flat);
    if (!opened || !make_plans(s) || !allocate(s))
        return false;
    mesh_orbit(&s->mesh, (double)o->azimuth, (double)o->elevation, (double)o->distance);
    return render_frame(s);
}

static bool write_files(const scene *s)
{
    const options *o = s->options;
    return image_write_png(o->png, s->rgba, s->width, s->height, o->backdrop != BACKDROP_NONE) &&
           (!o->pfm || image_write_pfm(o->pfm, s->rgb, s->width, s->height));
}

/* ---- The report ------------------------------------------------------------------------------------------------ */

static void report_values(const char *name, const float *values, int count)
{
    printf("%s", name);
    for (int i = 0; i < count; i++)
        printf(" %g", (double)values[i]);
    printf("\n");
}

static void report_plan(const facet_plan *plan, const char *title)
{
    char text[2048];
    facet_plan_describe(plan, text, sizeof text);
    printf("\n%s\n", title);
    for (char *line = strtok(text, "\n"); line; line = strtok(NULL, "\n"))
        printf("  %s\n", line);
}

static share sum_shares(const scene *s)
{
    share sum = {0};
    for (int i = 0; i < WORKER_LIMIT; i++) {
        sum.raster_seconds += s->shares[i].raster_seconds;
        sum.shade_seconds += s->shares[i].shade_seconds;
        sum.encode_seconds += s->shares[i].encode_seconds;
        sum.covered += s->shares[i].covered;
    }
    return sum;
}

static void report(const scene *s, double write_seconds)
{
    const options *o = s->options;
    const share sum = sum_shares(s);
    printf("%s: %zux%zu, %s, %zu triangles, %zu samples covered\n", o->png, s->width, s->height, o->mesh,
           s->mesh.triangle_count, sum.covered);
    if (o->layout == LAYOUT_GRID) {
        report_values("alpha, left to right:", grid_alpha, GRID_COLUMNS);
        report_values("sigma, top to bottom:", grid_sigma, GRID_ROWS);
    }
    printf("rasterize %.1f ms, shade %.1f ms, average and encode %.1f ms: %.1f ms on %d thread%s; write %.1f ms\n",
           1e3 * sum.raster_seconds, 1e3 * sum.shade_seconds, 1e3 * sum.encode_seconds, 1e3 * s->seconds, s->threads,
           s->threads == 1 ? "" : "s", 1e3 * write_seconds);
    if (s->mesh.parts > 1)
        ball_report(o->layout);
    report_plan(&s->plans[0], s->plan_count == 1 ? "plan" : "first plan");
    if (s->plan_count > 1)
        report_plan(&s->plans[s->plan_count - 1], "last plan");
}

static bool run(scene *s)
{
    console_start();
    if (!render(s))
        return false;
    double start = console_seconds();
    if (!write_files(s))
        return false;
    console_clear();
    report(s, console_seconds() - start);
    facet_material material = plan_material(s, 0);
    return !(s->options->seconds > 0) || shading_rate(s->options, &material, s->streams, &s->mesh, &s->raster);
}

int main(int count, char **arguments)
{
    static scene s;
    options o;
    if (!options_read(&o, count, arguments))
        return EXIT_FAILURE;
    if (o.help || o.list) {
        o.help ? options_help() : options_list();
        return EXIT_SUCCESS;
    }
    s.options = &o;
    bool done = run(&s);
    mesh_free(&s.mesh);
    raster_free(&s.raster);
    free(s.rgba);
    free(s.rgb);
    return done ? EXIT_SUCCESS : EXIT_FAILURE;
}
