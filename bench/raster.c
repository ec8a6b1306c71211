#include "raster.h"
#include "facet.h"
#include "vector.h"

#include <stdlib.h>
#include <string.h>

bool raster_init(raster *r, size_t width, size_t height, double fov)
{
    *r = (raster){.width = width, .height = height};
    r->focal = (double)height / 2 / tan(fov / 2 * (3.14159265358979323846 / 180));
    if (height && width <= SIZE_MAX / sizeof(float) / height) {
        r->depth = calloc(width * height, sizeof *r->depth);
        r->triangle = calloc(width * height, sizeof *r->triangle);
    }
    return r->depth && r->triangle;
}

void raster_free(raster *r)
{
    free(r->depth);
    free(r->triangle);
    *r = (raster){0};
}

/* ---- Clipping -------------------------------------------------------------------------------------------------- */

/* x/w and y/w are samples from the picture's middle, right and up; w is the distance along the view axis. */
typedef struct corner {
    double x, y, w;
} corner;

/* Beside the near plane a guard band of twice the picture's size, which keeps fixed-point coordinates in range. */
enum { PLANES = 5, POLYGON = 3 + PLANES };

#define NEAR 0.001

static double inside(const raster *r, corner c, int plane)
{
    double w = (double)r->width * c.w, h = (double)r->height * c.w;
    switch (plane) {
    case 0: return c.w - NEAR;
    case 1: return w - c.x;
    case 2: return w + c.x;
    case 3: return h - c.y;
    default: return h + c.y;
    }
}

/* Always from the inner to the outer end: triangles that share the edge get the same point. */
static corner cut(corner in, corner out, double d_in, double d_out)
{
    double t = d_in / (d_in - d_out);
    return (corner){in.x + t * (out.x - in.x), in.y + t * (out.y - in.y), in.w + t * (out.w - in.w)};
}

static int clip(const raster *r, corner polygon[POLYGON], int count, int plane)
{
    corner kept[POLYGON];
    int kept_count = 0;
    for (int i = 0; i < count; i++) {
        corner a = polygon[i], b = polygon[(i + 1) % count];
        double da = inside(r, a, plane), db = inside(r, b, plane);
        if (da >= 0)
            kept[kept_count++] = a;
        if ((da >= 0) != (db >= 0))
            kept[kept_count++] = da >= 0 ? cut(a, b, da, db) : cut(b, a, db, da);
    }
    memcpy(polygon, kept, (size_t)kept_count * sizeof *kept);
    return kept_count;
}

/* ---- Filling --------------------------------------------------------------------------------------------------- */

#define SUBSAMPLE 256

/* In 1/SUBSAMPLE of a sample, x to the right and y down from the picture's corner. */
typedef struct vertex {
    int64_t x, y;
    double depth;
} vertex;

static vertex project(const raster *r, corner c)
{
    return (vertex){llrint(((double)r->width / 2 + c.x / c.w) * SUBSAMPLE),
                    llrint(((double)r->height / 2 - c.y / c.w) * SUBSAMPLE), 1 / c.w};
}

/* Twice the area of a, b and the point: > 0 where the point lies to the right of a -> b as one sees it. */
static int64_t edge(const vertex *a, const vertex *b, int64_t x, int64_t y)
{
    return (b->x - a->x) * (y - a->y) - (b->y - a->y) * (x - a->x);
}

/* Samples on an edge belong to the triangle below it or to its right. */
static int64_t least_inside(const vertex *a, const vertex *b)
{
    return b->y < a->y || (b->y == a->y && b->x > a->x) ? 0 : 1;
}

static int64_t least3(int64_t a, int64_t b, int64_t c)
{
    int64_t m = a < b ? a : b;
    return m < c ? m : c;
}

/* The first sample whose middle is at or after a coordinate. */
static int64_t sample_from(int64_t at, size_t limit)
{
    int64_t i = at <= SUBSAMPLE / 2 ? 0 : (at + SUBSAMPLE / 2 - 1) / SUBSAMPLE;
    return i < (int64_t)limit ? i : (int64_t)limit;
}

static void fill_row(raster *r, uint32_t id, const vertex v[3], double area, int64_t y, int64_t x, int64_t x_end)
{
    int64_t e[3], step[3], least[3];
    for (int i = 0; i < 3; i++) {
        const vertex *a = &v[(i + 1) % 3], *b = &v[(i + 2) % 3];
        e[i] = edge(a, b, x * SUBSAMPLE + SUBSAMPLE / 2, y * SUBSAMPLE + SUBSAMPLE / 2);
        step[i] = (a->y - b->y) * SUBSAMPLE;
        least[i] = least_inside(a, b);
    }
    for (size_t at = (size_t)y * r->width + (size_t)x; x < x_end; x++, at++) {
        if (e[0] >= least[0] && e[1] >= least[1] && e[2] >= least[2]) {
            double depth = (double)e[0] * v[0].depth + (double)e[1] * v[1].depth + (double)e[2] * v[2].depth;
            if ((float)(depth / area) > r->depth[at]) {
                r->depth[at] = (float)(depth / area);
                r->triangle[at] = id;
            }
        }
        for (int i = 0; i < 3; i++)
            e[i] += step[i];
    }
}

static void fill(raster *r, uint32_t id, vertex a, vertex b, vertex c)
{
    int64_t area = edge(&a, &b, c.x, c.y);
    if (area == 0)
        return;
    const vertex v[3] = {a, area > 0 ? b : c, area > 0 ? c : b};
    int64_t x = sample_from(least3(a.x, b.x, c.x), r->width);
    int64_t y = sample_from(least3(a.y, b.y, c.y), r->height);
    int64_t x_end = sample_from(-least3(-a.x, -b.x, -c.x) + 1, r->width);
    int64_t y_end = sample_from(-least3(-a.y, -b.y, -c.y) + 1, r->height);
    for (; y < y_end; y++)
        fill_row(r, id, v, (double)llabs(area), y, x, x_end);
}

void raster_draw(raster *r, const mesh *m, size_t first, size_t count)
{
    for (size_t id = first; id < first + count; id++) {
        corner polygon[POLYGON];
        int corners = 3;
        for (int i = 0; i < 3; i++) {
            const float *p = m->positions[m->triangles[id].position[i]];
            polygon[i] = (corner){r->focal * (double)p[0], r->focal * (double)p[1], -(double)p[2]};
        }
        for (int plane = 0; plane < PLANES && corners; plane++)
            corners = clip(r, polygon, corners, plane);
        for (int i = 2; i < corners; i++)
            fill(r, (uint32_t)id, project(r, polygon[0]), project(r, polygon[i - 1]), project(r, polygon[i]));
    }
}

/* ---- G-buffers ------------------------------------------------------------------------------------------------- */

/* Where a ray from the eye meets a triangle's plane: p0 + weight[0] e1 + weight[1] e2, held inside the triangle, as
 * the fixed-point outline may reach a little farther. */
static void intersect(const double ray[3], const double p0[3], const double e1[3], const double e2[3], double weight[2])
{
    double q[3], s[3], from[3] = {-p0[0], -p0[1], -p0[2]};
    vector_cross(q, ray, e2);
    vector_cross(s, from, e1);
    double determinant = vector_dot(e1, q);
    double a = vector_dot(from, q) / determinant, b = vector_dot(ray, s) / determinant;
    weight[0] = fmin(fmax(a, 0), 1);
    weight[1] = fmin(fmax(b, 0), 1 - weight[0]);
}

/* Near a silhouette the interpolated normal may face away from the eye on a triangle that does not, or the other way
 * round: it is turned just far enough to face as its triangle does. */
static void agree_with_facing(double normal[3], const double view[3], const double e1[3], const double e2[3])
{
    double face[3], nv = vector_dot(normal, view), least = 1e-3;
    vector_cross(face, e1, e2);
    bool front = vector_dot(face, view) * vector_dot(face, normal) >= 0;
    if (front && nv < least)
        vector_add_scaled(normal, least - nv, view);
    if (!front && nv > -least)
        vector_add_scaled(normal, -least - nv, view);
    vector_normalise(normal);
}

typedef struct surface_point {
    double normal[3], view[3], position[3], tangent[3];
} surface_point;

/* The mean of three vectors by a triangle's weights. */
static void blend(float (*const vectors)[3], const uint32_t index[3], const double weight[2], double out[3])
{
    double v[3][3];
    for (int i = 0; i < 3; i++)
        vector_widen(v[i], vectors[index[i]]);
    for (int c = 0; c < 3; c++)
        out[c] = v[0][c] + weight[0] * (v[1][c] - v[0][c]) + weight[1] * (v[2][c] - v[0][c]);
}

/* Turned perpendicular to the normal. Where that leaves nothing, the axis that is least along the normal is. */
static void set_perpendicular(double tangent[3], const double normal[3])
{
    int least = fabs(normal[0]) < fabs(normal[1]) ? 0 : 1;
    least = fabs(normal[2]) < fabs(normal[least]) ? 2 : least;
    vector_add_scaled(tangent, -vector_dot(tangent, normal), normal);
    if (vector_dot(tangent, tangent) < 1e-12) {
        memset(tangent, 0, 3 * sizeof *tangent);
        tangent[least] = 1;
        vector_add_scaled(tangent, -normal[least], normal);
    }
    vector_normalise(tangent);
}

/* Where a ray meets a triangle. */
static void interpolate(const mesh *m, const mesh_triangle *t, const double ray[3], uint32_t streams,
                        surface_point *s)
{
    double p[3][3], e1[3], e2[3], weight[2];
    for (int i = 0; i < 3; i++)
        vector_widen(p[i], m->positions[t->position[i]]);
    vector_subtract(e1, p[1], p[0]);
    vector_subtract(e2, p[2], p[0]);
    intersect(ray, p[0], e1, e2, weight);
    for (int c = 0; c < 3; c++) {
        s->position[c] = p[0][c] + weight[0] * e1[c] + weight[1] * e2[c];
        s->view[c] = -s->position[c];
    }
    vector_normalise(s->view);
    blend(m->normals, t->normal, weight, s->normal);
    vector_normalise(s->normal);
    if (vector_dot(s->normal, s->normal) > 0)
        agree_with_facing(s->normal, s->view, e1, e2);
    if (streams & FACET_STREAM_TANGENT) {
        blend(m->tangents, t->normal, weight, s->tangent);
        set_perpendicular(s->tangent, s->normal);
    }
}

static void put(gbuffer *g, size_t i, const surface_point *s, uint32_t streams, size_t part)
{
    for (int c = 0; c < 3; c++) {
        g->normal[c][i] = (float)s->normal[c];
        g->view[c][i] = (float)s->view[c];
        if (streams & FACET_STREAM_POSITION)
            g->position[c][i] = (float)s->position[c];
        if (streams & FACET_STREAM_TANGENT)
            g->tangent[c][i] = (float)s->tangent[c];
    }
    g->part[i] = (uint8_t)part;
    g->coverage[i / 8] = (uint8_t)(g->coverage[i / 8] | 1u << i % 8);
    g->covered++;
}

size_t raster_tiles(const raster *r, size_t *columns)
{
    *columns = (r->width + TILE_WIDTH - 1) / TILE_WIDTH;
    return *columns * ((r->height + TILE_HEIGHT - 1) / TILE_HEIGHT);
}

void raster_tile(const raster *r, const mesh *m, size_t column, size_t row, uint32_t streams, gbuffer *g)
{
    memset(g, 0, sizeof *g);
    for (size_t i = 0; i < TILE_SAMPLES; i++) {
        size_t x = column * TILE_WIDTH + i % TILE_WIDTH, y = row * TILE_HEIGHT + i / TILE_WIDTH;
        if (x >= r->width || y >= r->height || !(r->depth[y * r->width + x] > 0))
            continue;
        uint32_t triangle = r->triangle[y * r->width + x];
        surface_point s;
        double ray[3] = {((double)x + 0.5 - (double)r->width / 2) / r->focal,
                         ((double)r->height / 2 - 0.5 - (double)y) / r->focal, -1};
        interpolate(m, &m->triangles[triangle], ray, streams, &s);
        put(g, i, &s, streams, triangle / (m->triangle_count / m->parts));
    }
}

size_t raster_part(const gbuffer *g, size_t part, uint8_t coverage[TILE_SAMPLES / 8])
{
    size_t count = 0;
    memset(coverage, 0, TILE_SAMPLES / 8);
    for (size_t i = 0; i < TILE_SAMPLES; i++)
        if (g->coverage[i / 8] >> i % 8 & 1 && g->part[i] == part) {
            coverage[i / 8] = (uint8_t)(coverage[i / 8] | 1u << i % 8);
            count++;
        }
    return count;
}
