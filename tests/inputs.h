/* Everything that a call reads per sample, or may: streams.def and the streams of lights. A new row is here by itself,
 * but for the names that facet_material or the reference have for it. */
#ifndef INPUTS_H
#define INPUTS_H

#include "recipes.h"
#include "reference.h"

/* The streams of a batch, and those of every light. */
enum { DIRECTION = BATCH_STREAMS, IRRADIANCE, VISIBILITY, INPUTS };

/* Their components: of the batch's streams, of every light's, then radiance. */
enum {
#define FACET_STREAM(id, field, components, ...) AT_##id, AT_##id##_LAST = AT_##id + components - 1,
#include "streams.def"
    LIGHT_AT, LIGHT_COMPONENTS = 7, MOST_LIGHTS = 64,
    RADIANCE_AT = LIGHT_AT + LIGHT_COMPONENTS * MOST_LIGHTS, COMPONENTS = RADIANCE_AT + 3
};
int component_of(int stream, int light);

/* Who brings it: streams.def's owners, or a light. */
enum { GEOMETRY, MATERIAL, SOURCE, OF_LIGHT };

/* Its first component, and where it is: in facet_batch; in facet_material, as a number; in a sample. */
typedef struct {
    const char *name;
    uint32_t bit;
    int components, owner, first;
    size_t batch, number, sample;
} input;
enum { NOT_OF_SAMPLE = sizeof(sample) };
extern const input inputs[INPUTS];

bool is_parameter(int stream);           /* a number of the material where it is no stream */
bool is_optional(int stream);            /* what may be NULL */

#endif
