#include "mesh.h"
#include "console.h"
#include "vector.h"

#include <float.h>
#include <stdlib.h>
#include <string.h>

#define PI 3.14159265358979323846

/* ---- Storage --------------------------------------------------------------------------------------------------- */

/* The array with room for one more element, or NULL. */
static void *with_room(void *array, size_t *room, size_t count, size_t element)
{
    if (count < *room)
        return array;
    size_t wanted = *room ? 2 * *room : 1024;
    void *grown = wanted <= SIZE_MAX / element ? realloc(array, wanted * element) : NULL;
    if (grown)
        *room = wanted;
    return grown;
}

bool mesh_add_position(mesh *m, const double position[3])
{
    void *array = with_room(m->positions, &m->position_room, m->position_count, sizeof *m->positions);
    if (!array)
        return false;
    m->positions = array;
    vector_narrow(m->positions[m->position_count++], position);
    return true;
}

/* Appends a vector made unit. */
static bool add_direction(float (**array)[3], size_t *room, size_t *count, const double direction[3])
{
    void *grown = with_room(*array, room, *count, sizeof **array);
    if (!grown)
        return false;
    *array = grown;
    double unit[3] = {direction[0], direction[1], direction[2]};
    vector_normalise(unit);
    vector_narrow((*array)[(*count)++], unit);
    return true;
}

bool mesh_add_normal(mesh *m, const double normal[3])
{
    return add_direction(&m->normals, &m->normal_room, &m->normal_count, normal);
}

bool mesh_add_tangent(mesh *m, const double tangent[3])
{
    return add_direction(&m->tangents, &m->tangent_room, &m->tangent_count, tangent);
}

bool mesh_add_triangle(mesh *m, const mesh_triangle *t)
{
    void *array = with_room(m->triangles, &m->triangle_room, m->triangle_count, sizeof *m->triangles);
    if (!array)
        return false;
    m->triangles = array;
    m->triangles[m->triangle_count++] = *t;
    return true;
}

void mesh_free(mesh *m)
{
    free(m->positions);
    free(m->normals);
    free(m->tangents);
    free(m->triangles);
    *m = (mesh){0};
}

/* ---- Parametric surfaces --------------------------------------------------------------------------------------- */

/* A point, a normal and the tangent along u, of any length, at (u, v) in the unit square. */
typedef void surface(const void *context, double u, double v, double position[3], double normal[3],
                     double tangent[3]);

static bool add_cell(mesh *m, size_t corner, size_t stride)
{
    uint32_t a = (uint32_t)corner, b = a + 1, c = (uint32_t)(corner + stride), d = c + 1;
    mesh_triangle halves[2] = {{{a, b, d}, {a, b, d}}, {{a, d, c}, {a, d, c}}};
    return mesh_add_triangle(m, &halves[0]) && mesh_add_triangle(m, &halves[1]);
}

/* Positions, normals and tangents are added together, so that one index serves all. */
static bool add_surface(mesh *m, size_t columns, size_t rows, surface *at, const void *context)
{
    size_t first = m->position_count, stride = columns + 1;
    for (size_t i = 0; i < stride * (rows + 1); i++) {
        double position[3], normal[3], tangent[3];
        at(context, (double)(i % stride) / (double)columns, (double)(i / stride) / (double)rows, position, normal,
           tangent);
        if (!mesh_add_position(m, position) || !mesh_add_normal(m, normal) || !mesh_add_tangent(m, tangent))
            return false;
    }
    for (size_t i = 0; i < columns * rows; i++)
        if (!add_cell(m, first + i / columns * stride + i % columns, stride))
            return false;
    return true;
}

typedef struct sphere {
    double centre[3], radius;
} sphere;

enum { SPHERE_COLUMNS = 128, SPHERE_ROWS = 64 };

static void sphere_at(const void *context, double u, double v, double position[3], double normal[3],
                      double tangent[3])
{
    const sphere *s = context;
    normal[0] = sin(PI * v) * cos(2 * PI * u);
    normal[1] = cos(PI * v);
    normal[2] = -sin(PI * v) * sin(2 * PI * u);
    tangent[0] = -sin(2 * PI * u), tangent[1] = 0, tangent[2] = -cos(2 * PI * u);
    memcpy(position, s->centre, 3 * sizeof *position);
    vector_add_scaled(position, s->radius, normal);
}

static bool add_sphere(mesh *m, const double centre[3], double radius)
{
    const sphere s = {{centre[0], centre[1], centre[2]}, radius};
    return add_surface(m, SPHERE_COLUMNS, SPHERE_ROWS, sphere_at, &s);
}

/* Cubic Bernstein polynomials and their derivatives. */
static void bernstein(double t, double b[4], double d[4])
{
    double s = 1 - t;
    b[0] = s * s * s, b[1] = 3 * (s * s) * t, b[2] = 3 * (t * t) * s, b[3] = t * t * t;
    d[0] = -3 * s * s, d[1] = 3 * s * (s - 2 * t), d[2] = 3 * t * (2 * s - t), d[3] = 3 * t * t;
}

/* Summed from the ends to the middle: the same bits when the curve runs the other way, where t and 1 - t are exact. */
static double blend(const double w[4], double p0, double p1, double p2, double p3)
{
    return (w[0] * p0 + w[3] * p3) + (w[1] * p1 + w[2] * p2);
}

/* The tensor product, with the patch's z up turned into y up. */
static void patch_sum(const double patch[4][4][3], const double u[4], const double v[4], double out[3])
{
    double sum[3];
    for (int c = 0; c < 3; c++) {
        double row[4];
        for (int i = 0; i < 4; i++)
            row[i] = blend(u, patch[i][0][c], patch[i][1][c], patch[i][2][c], patch[i][3][c]);
        sum[c] = blend(v, row[0], row[1], row[2], row[3]);
    }
    out[0] = sum[0], out[1] = sum[2], out[2] = -sum[1];
}

/* On the lid's tip and in the middle of the bottom the row v = 0 is a point and d/du vanishes: near it, d/du is
 * v d2/dudv, so the latter stands for it. */
static void patch_at(const void *context, double u, double v, double position[3], double normal[3],
                     double along_u[3])
{
    const double(*patch)[4][3] = context;
    double bu[4], du[4], bv[4], dv[4], along_v[3];
    bernstein(u, bu, du);
    bernstein(v, bv, dv);
    patch_sum(patch, bu, bv, position);
    patch_sum(patch, bu, dv, along_v);
    patch_sum(patch, du, bv, along_u);
    if (vector_dot(along_u, along_u) < 1e-12)
        patch_sum(patch, du, dv, along_u);
    vector_cross(normal, along_u, along_v);
}

/* A power of two: i/32 and 1 - i/32 are exact, and patches meet in the same bits. */
enum { TEAPOT_STEPS = 32 };

static bool add_teapot(mesh *m)
{
    for (int i = 0; i < TEAPOT_PATCHES; i++)
        if (!add_surface(m, TEAPOT_STEPS, TEAPOT_STEPS, patch_at, teapot_patches[i]))
            return false;
    return true;
}

/* ---- Fit and normals ------------------------------------------------------------------------------------------- */

/* The box around the triangles; positions that no triangle uses do not count. */
static void bounds(const mesh *m, double least[3], double most[3])
{
    for (int c = 0; c < 3; c++) {
        least[c] = DBL_MAX;
        most[c] = -DBL_MAX;
    }
    for (size_t i = 0; i < 3 * m->triangle_count; i++) {
        const float *p = m->positions[m->triangles[i / 3].position[i % 3]];
        for (int c = 0; c < 3; c++) {
            least[c] = fmin(least[c], p[c]);
            most[c] = fmax(most[c], p[c]);
        }
    }
}

static void to_middle(double out[3], const float position[3], const double middle[3])
{
    vector_widen(out, position);
    vector_subtract(out, out, middle);
}

/* Into the unit sphere around the box's middle. False where the mesh is one point. */
static bool fit(mesh *m)
{
    double least[3], most[3], middle[3], p[3], radius = 0;
    bounds(m, least, most);
    for (int c = 0; c < 3; c++)
        middle[c] = (least[c] + most[c]) / 2;
    for (size_t i = 0; i < 3 * m->triangle_count; i++) {
        to_middle(p, m->positions[m->triangles[i / 3].position[i % 3]], middle);
        radius = fmax(radius, sqrt(vector_dot(p, p)));
    }
    for (size_t i = 0; i < m->position_count && radius > 0; i++) {
        to_middle(p, m->positions[i], middle);
        for (int c = 0; c < 3; c++)
            p[c] = fmax(-1e6, fmin(1e6, p[c] / radius));
        vector_narrow(m->positions[i], p);
    }
    return radius > 0;
}

/* The normal of any length at corner i, and the angle there. */
static double corner_normal(const mesh *m, const mesh_triangle *t, int i, double normal[3])
{
    double p[3][3], a[3], b[3];
    for (int k = 0; k < 3; k++)
        vector_widen(p[k], m->positions[t->position[(i + k) % 3]]);
    vector_subtract(a, p[1], p[0]);
    vector_subtract(b, p[2], p[0]);
    vector_cross(normal, a, b);
    return atan2(sqrt(vector_dot(normal, normal)), vector_dot(a, b));
}

static bool flatten(mesh *m)
{
    m->normal_count = m->tangent_count = 0;
    for (size_t i = 0; i < m->triangle_count; i++) {
        mesh_triangle *t = &m->triangles[i];
        double normal[3];
        corner_normal(m, t, 0, normal);
        t->normal[0] = t->normal[1] = t->normal[2] = (uint32_t)i;
        if (!mesh_add_normal(m, normal))
            return false;
    }
    return true;
}

static bool lacks_normal(const mesh_triangle *t)
{
    return t->normal[0] == MESH_NO_NORMAL || t->normal[1] == MESH_NO_NORMAL || t->normal[2] == MESH_NO_NORMAL;
}

/* Adds the triangle's normal to those of its positions, which begin at `first`, by its angle at each. */
static void smooth_triangle(mesh *m, const mesh_triangle *t, size_t first)
{
    for (int i = 0; i < 3; i++) {
        double normal[3], sum[3];
        double angle = corner_normal(m, t, i, normal);
        vector_normalise(normal);
        float *smooth = m->normals[first + t->position[i]];
        vector_widen(sum, smooth);
        vector_add_scaled(sum, angle, normal);
        vector_narrow(smooth, sum);
    }
}

/* Gives every position a normal behind those of the file. */
static bool add_smooth_normals(mesh *m)
{
    size_t first = m->normal_count;
    for (size_t i = 0; i < m->position_count; i++)
        if (!mesh_add_normal(m, (const double[3]){0, 0, 0}))
            return false;
    for (size_t i = 0; i < m->triangle_count; i++)
        smooth_triangle(m, &m->triangles[i], first);
    for (size_t i = first; i < m->normal_count; i++) {
        double unit[3];
        vector_widen(unit, m->normals[i]);
        vector_normalise(unit);
        vector_narrow(m->normals[i], unit);
    }
    return true;
}

static bool complete_normals(mesh *m)
{
    size_t first = m->normal_count, lacking = 0;
    for (size_t i = 0; i < m->triangle_count; i++)
        lacking += lacks_normal(&m->triangles[i]);
    if (lacking && !add_smooth_normals(m))
        return false;
    for (size_t i = 0; i < m->triangle_count; i++)
        if (lacks_normal(&m->triangles[i]))
            for (int k = 0; k < 3; k++)
                m->triangles[i].normal[k] = (uint32_t)(first + m->triangles[i].position[k]);
    return true;
}

/* To every normal that has none, the tangent y x n, or x where n is along y. */
static bool complete_tangents(mesh *m)
{
    for (size_t i = m->tangent_count; i < m->normal_count; i++) {
        const float *n = m->normals[i];
        double around[3] = {(double)n[2], 0, -(double)n[0]};
        if (!mesh_add_tangent(m, vector_dot(around, around) > 0 ? around : (const double[3]){1, 0, 0}))
            return false;
    }
    return true;
}

/* ---- Opening and turning --------------------------------------------------------------------------------------- */

bool mesh_open(mesh *m, const char *name, bool flat)
{
    *m = (mesh){.parts = 1};
    if (!strcmp(name, "teapot") ? !add_teapot(m)
        : !strcmp(name, "sphere") ? !add_sphere(m, (const double[3]){0, 0, 0}, 1) : false)
        return console_error("not enough memory for the %s", name);
    if (!m->triangle_count && !obj_read(m, name))
        return false;
    if (!fit(m))
        return console_error("%s: all faces lie in one point", name);
    if (!(flat ? flatten(m) : complete_normals(m)) || !complete_tangents(m))
        return console_error("%s: not enough memory for normals", name);
    return true;
}

bool mesh_spheres(mesh *m, const double (*centres)[3], size_t count, double radius)
{
    *m = (mesh){.parts = count};
    for (size_t i = 0; i < count; i++)
        if (!add_sphere(m, centres[i], radius))
            return console_error("not enough memory for %zu spheres", count);
    return true;
}

static void turn(float vector[3], int x, int y, double cosine, double sine)
{
    double a = vector[x], b = vector[y];
    vector[x] = (float)(a * cosine - b * sine);
    vector[y] = (float)(a * sine + b * cosine);
}

static void turn_all(float (*vectors)[3], size_t count, double azimuth, double elevation)
{
    double a = azimuth * PI / 180, e = elevation * PI / 180;
    for (size_t i = 0; i < count; i++) {
        turn(vectors[i], 0, 2, cos(a), sin(a));
        turn(vectors[i], 1, 2, cos(e), sin(e));
    }
}

void mesh_orbit(mesh *m, double azimuth, double elevation, double distance)
{
    turn_all(m->positions, m->position_count, azimuth, elevation);
    turn_all(m->normals, m->normal_count, azimuth, elevation);
    turn_all(m->tangents, m->tangent_count, azimuth, elevation);
    for (size_t i = 0; i < m->position_count; i++)
        m->positions[i][2] -= (float)distance;
}
