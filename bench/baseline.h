/* What the library is timed against: the same functions, written and compiled as one would otherwise. */
#ifndef BASELINE_H
#define BASELINE_H

#include "facet.h"

/* What a baseline shades: the workloads of bench_workloads.c. */
enum { SHADE_TILE, SHADE_DIFFUSE, SHADE_METAL, SHADE_PLASTIC, SHADE_LIGHTS, SHADE_FULL, SHADE_COUNT };

enum { SHADE_MOST_LIGHTS = 4 };

/* Shades the batch: its streams, directional lights (as many as the workload has), and of the material eta and k. */
typedef void baseline_shader(const facet_material *material, const facet_batch *batch);

typedef enum { TEXTBOOK, AUTOVECTORIZED, EXPLICIT } baseline_kind;

typedef struct {
    const char *name;
    baseline_kind kind;
    int bits;                                  /* of its vectors; 0: it has none */
    baseline_shader *shade[SHADE_COUNT];       /* NULL: not written for it */
} baseline;

#endif
