#include "inputs.h"

/* The numbers of facet_material that MATERIAL streams stand for; those of SOURCE streams are under `convention`. */
#define NUMBER_albedo   diffuse.albedo
#define NUMBER_sigma    diffuse.sigma
#define NUMBER_alpha    specular.alpha
#define NUMBER_alpha_y  specular.alpha_y
#define NUMBER_exponent specular.exponent
#define NUMBER_f0       fresnel.f0
#define NUMBER_eta      fresnel.eta
#define NUMBER_k        fresnel.k

/* A sample has what models read of geometry, under these names. */
#define SAMPLE_normal   offsetof(sample, n)
#define SAMPLE_view     offsetof(sample, v)
#define SAMPLE_tangent  offsetof(sample, tangent)
#define SAMPLE_position offsetof(sample, position)
#define SAMPLE_occlusion NOT_OF_SAMPLE

#define PLACES_GEOMETRY(field) 0, SAMPLE_##field
#define PLACES_MATERIAL(field) offsetof(facet_material, NUMBER_##field), offsetof(sample, field)
#define PLACES_SOURCE(field)   offsetof(facet_material, convention.field), NOT_OF_SAMPLE

const input inputs[INPUTS] = {
#define FACET_STREAM(id, field, components, owner, ...)                                                               \
    { #field, FACET_STREAM_##id, components, owner, AT_##id, offsetof(facet_batch, field), PLACES_##owner(field) },
#include "streams.def"
    [DIRECTION] = { "direction", 0, 3, OF_LIGHT, LIGHT_AT, 0, 0, offsetof(sample, l) },
    [IRRADIANCE] = { "irradiance", 0, 3, OF_LIGHT, LIGHT_AT + 3, 0, 0, offsetof(sample, irradiance) },
    [VISIBILITY] = { "visibility", 0, 1, OF_LIGHT, LIGHT_AT + 6, 0, 0, NOT_OF_SAMPLE },
};

int component_of(int stream, int light)
{
    return inputs[stream].first + (stream >= DIRECTION ? LIGHT_COMPONENTS * light : 0);
}

bool is_parameter(int stream) { return inputs[stream].owner == MATERIAL || inputs[stream].owner == SOURCE; }
bool is_optional(int stream) { return stream == STREAM_VIEW || stream == STREAM_OCCLUSION || stream == VISIBILITY; }
