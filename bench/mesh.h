/* Triangle meshes: the Utah teapot, spheres, OBJ files. */
#ifndef MESH_H
#define MESH_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* The most positions, normals and triangles that a file may hold: a mesh takes up to 0.7 gigabytes. */
#define MESH_LIMIT ((size_t)8 << 20)

#define MESH_NO_NORMAL UINT32_MAX

typedef struct mesh_triangle {
    uint32_t position[3], normal[3];
} mesh_triangle;

typedef struct mesh {
    float (*positions)[3], (*normals)[3], (*tangents)[3];   /* a tangent for each normal */
    mesh_triangle *triangles;
    size_t position_count, normal_count, tangent_count, triangle_count;
    size_t position_room, normal_room, tangent_room, triangle_room;
    size_t parts;              /* materials: every part has as many triangles, one part's after another's */
} mesh;

/* "teapot", "sphere" or the path of an OBJ file, moved and scaled into the unit sphere, y up. Normals have unit length,
 * or none where the surface has none. Triangles that come without normals get smooth ones: at each position the mean
 * over its triangles, weighted by their angles there. With `flat` every triangle has its own normal instead. Tangents
 * are dP/du of the teapot's patches and of the sphere, where u goes around it; those of files and flat triangles go
 * around the y axis too. Says what is wrong. */
bool mesh_open(mesh *m, const char *name, bool flat);

/* Spheres of one radius, a part each, as they stand. Says what is wrong. */
bool mesh_spheres(mesh *m, const double (*centres)[3], size_t count, double radius);

/* Turns and moves the mesh before an eye at the origin that looks along -z, up y: as if the eye stood at the azimuth
 * and elevation (degrees; 0, 0 is +z) and the distance from the middle. */
void mesh_orbit(mesh *m, double azimuth, double elevation, double distance);

void mesh_free(mesh *m);

/* Each of these is false where memory ends. */
bool mesh_add_position(mesh *m, const double position[3]);
bool mesh_add_normal(mesh *m, const double normal[3]);
bool mesh_add_tangent(mesh *m, const double tangent[3]);
bool mesh_add_triangle(mesh *m, const mesh_triangle *t);

/* obj.c: adds an OBJ file's faces, as fans, to an empty mesh. Says what is wrong. */
bool obj_read(mesh *m, const char *path);

/* teapot.c */
#define TEAPOT_PATCHES 32
extern const double teapot_patches[TEAPOT_PATCHES][4][4][3];

#endif
