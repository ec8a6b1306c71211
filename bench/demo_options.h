/* The demo's command line. */
#ifndef DEMO_OPTIONS_H
#define DEMO_OPTIONS_H

#include "facet.h"

enum { LIGHT_LIMIT = 16 };

typedef enum layout {
    LAYOUT_ONE,       /* one panel */
    LAYOUT_COMPARE,   /* Lambert beside Oren-Nayar */
    LAYOUT_GRID       /* alpha to the right, sigma downwards */
} layout;

typedef enum backdrop {
    BACKDROP_SOFT,    /* a gradient */
    BACKDROP_NONE,    /* transparent */
    BACKDROP_COLOUR
} backdrop;

typedef struct options {
    const char *mesh, *png, *pfm;
    size_t width, height;      /* of a panel, pixels */
    float azimuth, elevation, distance, fov;
    facet_material material;
    facet_target target;
    facet_light lights[LIGHT_LIMIT];
    size_t light_count;
    float ambient[3], exposure;
    layout layout;
    backdrop backdrop;
    float backdrop_colour[3];
    size_t samples;            /* a pixel's edge, in samples: 1 or 2 */
    float seconds;             /* to time each arch; 0: none */
    bool two_sided, flat, help, list;
} options;

/* Fills *o from the defaults and the command line. Says what is wrong. */
bool options_read(options *o, int count, char **arguments);

void options_help(void);

/* Every model, arch, tier and preset, one a line. */
void options_list(void);

#endif
