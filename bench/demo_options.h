/* The demo's command line. */
#ifndef DEMO_OPTIONS_H
#define DEMO_OPTIONS_H

#include "shading_options.h"

typedef enum layout {
    LAYOUT_ONE,       /* one panel */
    LAYOUT_COMPARE,   /* Lambert beside Oren-Nayar */
    LAYOUT_GRID,      /* alpha to the right, sigma downwards */
    LAYOUT_METALS,    /* a ball of every metal */
    LAYOUT_GRAZING    /* balls lit from behind: metals downwards, Fresnel models to the right */
} layout;

typedef enum rig {
    RIG_STUDIO,       /* key, fill, two rims and the floor's glow */
    RIG_BOXES,        /* soft boxes of point lights */
    RIG_RIM           /* rings of lights from behind, and a weak one from the front */
} rig;

typedef enum backdrop {
    BACKDROP_SOFT,    /* a gradient */
    BACKDROP_NONE,    /* transparent */
    BACKDROP_COLOUR
} backdrop;

typedef struct options {
    shading shading;           /* the lights before an eye at the origin, as the mesh is */
    const char *mesh, *png, *pfm;
    size_t width, height;      /* of a panel, pixels */
    float azimuth, elevation, distance, fov, exposure;
    rig rig;
    layout layout;
    backdrop backdrop;
    float backdrop_colour[3];
    size_t samples;            /* a pixel's edge, in samples */
    float seconds;             /* to time each arch; 0: none */
    int threads;
    bool two_sided, flat, help, list;
} options;

/* Fills *o from the defaults and the command line. Says what is wrong. */
bool options_read(options *o, int count, char **arguments);

void options_help(void);

/* Every model, metal, arch, tier, rig and preset, one a line. */
void options_list(void);

#endif
