/* plan + batch -> radiance: checks the arguments, then calls the plan's kernel. */
#include "internal.h"

#include "../arch/environment.h"

static facet_status check_vector(const float *a, const char *field, int index, facet_error *error)
{
    return finite(a[0]) && finite(a[1]) && finite(a[2]) ? FACET_OK : refuse(error, FACET_ERROR_VALUE, field, index);
}

/* A light's uniform vector: finite and not zero. */
static facet_status check_light_vector(const float *a, const char *field, int index, facet_error *error)
{
    if (a[0] == 0.0f && a[1] == 0.0f && a[2] == 0.0f) return refuse(error, FACET_ERROR_VALUE, field, index);
    return check_vector(a, field, index, error);
}

static bool none_given(const float *const *stream) { return !stream[0] && !stream[1] && !stream[2]; }

static facet_status check_stream(const float *const *stream, int components, const char *field, int index,
                                 facet_error *error)
{
    for (int c = 0; c < components; c++)
        if (!stream[c]) return refuse(error, FACET_ERROR_NULL, field, index);
    return FACET_OK;
}

/* Raises *special where the light needs more of the kernel than a plain one. */
static facet_status check_light(const facet_light *light, int index, bool *special, facet_error *error)
{
    if (light->kind != FACET_LIGHT_DIRECTIONAL) return refuse(error, FACET_ERROR_ENUM, "light.kind", index);

    const float *E = light->irradiance;
    if (light->kind != FACET_LIGHT_DIRECTIONAL || light->direction_of[0] || light->irradiance_of[0] || light->visibility
        || E[0] < 0.0f || E[1] < 0.0f || E[2] < 0.0f)
        *special = true;

    facet_status status;
    if (none_given(light->direction_of))
        status = check_light_vector(light->direction, "light.direction", index, error);
    else
        status = check_stream(light->direction_of, 3, "light.direction_of", index, error);
    if (status) return status;

    if (none_given(light->irradiance_of))
        return check_light_vector(light->irradiance, "light.irradiance", index, error);
    return check_stream(light->irradiance_of, 3, "light.irradiance_of", index, error);
}

/* Finds the streams that the plan reads, or the plan's numbers in their place; names the first that is not there. */
static facet_status gather_streams(job *j, const facet_batch *b, facet_error *error)
{
    const plan_fields *p = j->plan;
    const bool view_needed = p->needs_view || b->flags & FACET_TWO_SIDED;
    const uint32_t read = p->needed | FACET_STREAM_NORMAL | FACET_STREAM_VIEW;
    uint32_t streams = FACET_STREAM_NORMAL | p->promised, uniform = b->uniform;
    if (view_needed || !none_given(b->view)) streams |= FACET_STREAM_VIEW;

#define BATCH_1(field) &b->field
#define BATCH_3(field) b->field
#define PLAN_1(field) &p->field
#define PLAN_3(field) p->field
#define INSTEAD_GEOMETRY(id, field, components)                                                                       \
    for (int c = 0; c < components; c++) j->component[COMPONENT_##id + c] = 0;                                       \
    uniform &= ~(uint32_t)FACET_STREAM_##id;
#define INSTEAD_MATERIAL(id, field, components)                                                                       \
    for (int c = 0; c < components; c++) j->component[COMPONENT_##id + c] = PLAN_##components(field) + c;            \
    uniform |= FACET_STREAM_##id;
#define FACET_STREAM(id, field, components, owner, ...)                                                               \
    if (streams & FACET_STREAM_##id) {                                                                               \
        for (int c = 0; c < components; c++) {                                                                       \
            const float *component = (BATCH_##components(field))[c];                                                 \
            if (!component) return refuse(error, FACET_ERROR_NULL, #field, -1);                                      \
            j->component[COMPONENT_##id + c] = component;                                                            \
        }                                                                                                            \
    }                                                                                                                \
    if (!(streams & read & FACET_STREAM_##id)) {                                                                     \
        INSTEAD_##owner(id, field, components)                                                                       \
    }
#include "streams.def"
    j->streams = streams & read;
    j->uniform = uniform;
    return FACET_OK;
}

static facet_status check_batch(job *j, const facet_batch *b, facet_error *error)
{
    const uint32_t known_flags = FACET_ACCUMULATE | FACET_TWO_SIDED, known_streams = 0
#define FACET_STREAM(id, field, components, owner, ...) | FACET_STREAM_##id
#include "streams.def"
        ;
    if (b->flags & ~known_flags) return refuse(error, FACET_ERROR_ENUM, "flags", -1);
    if (b->uniform & ~known_streams) return refuse(error, FACET_ERROR_ENUM, "uniform", -1);
    facet_status status = gather_streams(j, b, error);
    if (status) return status;
    for (int c = 0; c < 3; c++)
        if (!b->radiance[c]) return refuse(error, FACET_ERROR_NULL, "radiance", c);

    status = check_vector(b->ambient, "ambient", -1, error);
    if (!status && b->light_count && !b->lights) status = refuse(error, FACET_ERROR_NULL, "lights", -1);
    j->check_lights = false;
    for (size_t i = 0; !status && i < b->light_count; i++)
        status = check_light(&b->lights[i], (int)i, &j->check_lights, error);
    return status;
}

/* Not inlined: its arithmetic stays between environment_enter and environment_leave. */
static __attribute__((noinline)) facet_status shade(const plan_fields *p, const facet_batch *b, facet_error *error)
{
    job j;
    j.plan = p;
    facet_status status = check_batch(&j, b, error);
    if (status) return status;

    j.count = b->count;
    j.lights = b->lights;
    j.light_count = b->light_count;
    j.coverage = b->coverage;
    j.flags = b->flags;
    j.invalid = b->invalid;
    j.constant_radiance = false;
    for (int c = 0; c < 3; c++) {
        j.ambient[c] = b->ambient[c] > 0.0f ? b->ambient[c] * INV_PI : 0.0f;
        j.radiance[c] = b->radiance[c];
        if (j.ambient[c] > 0.0f || p->emission[c] > 0.0f) j.constant_radiance = true;
    }
    facet_kernel((facet_arch)p->arch, (facet_tier)p->tier)(&j);
    return FACET_OK;
}

facet_status facet_shade_sized(const facet_plan *plan, const facet_batch *batch, size_t batch_size, size_t light_size,
                               facet_error *error)
{
    const plan_fields *p = (const plan_fields *)plan;
    facet_batch own;
    refuse(error, FACET_OK, 0, -1);
    if (!p) return refuse(error, FACET_ERROR_NULL, "plan", -1);
    if (!plan_valid(p)) return refuse(error, FACET_ERROR_PLAN, "plan", -1);
    if (!batch) return refuse(error, FACET_ERROR_NULL, "batch", -1);
    if (batch_size != sizeof own) {
        if (!adopt(&own, sizeof own, batch, batch_size)) return refuse(error, FACET_ERROR_SIZE, "batch", -1);
        batch = &own;
    }
    if (light_size != sizeof(facet_light) && batch->light_count) return refuse(error, FACET_ERROR_SIZE, "lights", -1);

    environment callers = environment_enter();
    facet_status status = shade(p, batch, error);
    environment_leave(callers);
    return status;
}
