/* Scenes of balls, each of its own material. */
#ifndef BALLS_H
#define BALLS_H

#include "demo_options.h"
#include "mesh.h"

enum { BALL_LIMIT = 32 };

/* How many balls a layout has; 0: it has a mesh. */
size_t ball_count(layout which);

/* Their mesh, a part each, in the unit sphere. Says what is wrong. */
bool ball_mesh(mesh *m, layout which);

/* A ball's material: the command line's, with a metal's indices, and in LAYOUT_GRAZING with a Fresnel model. */
facet_material ball_material(const options *o, size_t ball);

/* Prints which metals are where, and their indices. */
void ball_report(layout which);

#endif
