/* What is shaded, as options that facet-demo and tests/relight share: the material, its light, and the target. */
#ifndef SHADING_OPTIONS_H
#define SHADING_OPTIONS_H

#include "command_line.h"

enum { LIGHT_LIMIT = 64 };

typedef struct shading {
    facet_material material;
    uint32_t given;                /* FACET_STREAM_*: whose numbers in `material` were given */
    facet_target target;
    facet_light lights[LIGHT_LIMIT];
    size_t light_count;
    float ambient[3], sh[4][3];    /* as facet_batch has them */
} shading;

/* The options that set *s: material, light, target. */
enum { SHADING_GROUPS = 3 };
void shading_settings(shading *s, settings groups[SHADING_GROUPS]);

/* Sets the material from a list of such options, "--NAME VALUE ...", which may name models that this build lacks. Says
 * what is wrong. */
bool shading_read_material(shading *s, const char *list);

/* Whether the material's models have their numbers, none of them twice, and go together. Says what is wrong. */
bool shading_complete(const shading *s);

/* FACET_STREAM_*: what the material's models read. */
uint32_t shading_reads(const facet_material *material);

/* Whether a light stands somewhere, and not infinitely far. */
bool light_has_position(const facet_light *light);

/* Every model, metal, kind of light, arch and tier, one a line. */
void shading_list(void);

#endif
