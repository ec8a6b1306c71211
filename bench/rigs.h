/* Lights of the demo. */
#ifndef RIGS_H
#define RIGS_H

#include "demo_options.h"

/* A rig's word, and what it is; NULL past the last. */
const char *rig_word(int value);
const char *rig_note(int value);

/* Adds a rig's lights, in the picture's axes: x right, y up, z to the eye; the mesh is in the unit sphere. */
void rig_add(shading *s, rig which);

#endif
