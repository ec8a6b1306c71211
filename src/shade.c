/* plan + batch -> radiance: checks the arguments, then calls the plan's kernel. */
#include "internal.h"

#include "../arch/environment.h"

/* By their bits, two at once: fewer instructions than floats' comparisons. */
static bool all_zero(const float *a, int count)
{
    bits64 any = 0;
    for (int i = 0; i + 1 < count; i += 2) any |= *(const bits64 *)(const void *)(a + i);
    if (count % 2) any |= ((const bits32 *)a)[count - 1];
    return !(any & UINT64_C(0x7fffffff7fffffff));
}

static facet_status check_vector(const float *a, const char *field, int index, facet_error *error)
{
    const float sum = (a[0] - a[0]) + (a[1] - a[1]) + (a[2] - a[2]);
    return sum == 0.0f ? FACET_OK : refuse(error, FACET_ERROR_VALUE, field, index);
}

/* A light's uniform vector: finite and not zero, which nearly every one's square shows. */
static inline facet_status check_light_vector(const float *a, const char *field, int index, facet_error *error)
{
    const float square = a[0] * a[0] + a[1] * a[1] + a[2] * a[2];
    if (__builtin_expect(square > 0.0f && square <= FLT_MAX, 1)) return FACET_OK;
    if (all_zero(a, 3)) return refuse(error, FACET_ERROR_VALUE, field, index);
    return check_vector(a, field, index, error);
}

/* Bits of three pointers, none where all are NULL: without a branch for each. */
static uintptr_t given_of_3(const float *const *stream)
{
    return (uintptr_t)stream[0] | (uintptr_t)stream[1] | (uintptr_t)stream[2];
}
static bool none_given(const float *const *stream) { return !given_of_3(stream); }

/* Whether a stream of one component, of three, is there. */
static inline bool whole_1(const float *given) { return given; }
static inline bool whole_3(const float *const *given) { return given[0] && given[1] && given[2]; }

static facet_status check_stream(const float *const *stream, const char *field, int index, facet_error *error)
{
    return whole_3(stream) ? FACET_OK : refuse(error, FACET_ERROR_NULL, field, index);
}

/* A cone's cosines: -1 <= cos_outer <= cos_inner <= 1; NaN is neither. */
static facet_status check_spot(const facet_light *light, int index, facet_error *error)
{
    if (!(light->cos_outer >= -1.0f && light->cos_outer <= 1.0f))
        return refuse(error, FACET_ERROR_VALUE, "light.cos_outer", index);
    if (!(light->cos_inner >= light->cos_outer && light->cos_inner <= 1.0f))
        return refuse(error, FACET_ERROR_VALUE, "light.cos_inner", index);
    return check_light_vector(light->axis, "light.axis", index, error);
}

static facet_status check_place(const facet_light *light, int index, facet_error *error)
{
    facet_status status = check_vector(light->position, "light.position", index, error);
    if (!status && !(light->range >= 0.0f && light->range <= FLT_MAX))
        status = refuse(error, FACET_ERROR_VALUE, "light.range", index);
    return status || light->kind != FACET_LIGHT_SPOT ? status : check_spot(light, index, error);
}

static __attribute__((noinline)) facet_status check_light(const facet_light *light, int index, facet_error *error)
{
    facet_status status;
    if ((unsigned)light->kind > FACET_LIGHT_SPOT) return refuse(error, FACET_ERROR_ENUM, "light.kind", index);
    if (light->kind != FACET_LIGHT_DIRECTIONAL)
        status = check_place(light, index, error);
    else if (none_given(light->direction_of))
        status = check_light_vector(light->direction, "light.direction", index, error);
    else
        status = check_stream(light->direction_of, "light.direction_of", index, error);
    if (status) return status;

    if (none_given(light->irradiance_of))
        return check_light_vector(light->irradiance, "light.irradiance", index, error);
    return check_stream(light->irradiance_of, "light.irradiance_of", index, error);
}

/* A directional light without streams, which nearly every one is. */
static inline bool is_plain(const facet_light *light)
{
    return !((uintptr_t)light->kind | given_of_3(light->direction_of) | given_of_3(light->irradiance_of)
             | (uintptr_t)light->visibility);
}

static facet_status check_plain_light(const facet_light *light, int index, facet_error *error)
{
    facet_status status = check_light_vector(light->direction, "light.direction", index, error);
    return status ? status : check_light_vector(light->irradiance, "light.irradiance", index, error);
}

static bool is_negative(const float *E) { return E[0] < 0.0f || E[1] < 0.0f || E[2] < 0.0f; }

static facet_status check_lights(job *j, const facet_batch *b, facet_error *error)
{
    facet_status status = FACET_OK;
    if (b->light_count && !b->lights) return refuse(error, FACET_ERROR_NULL, "lights", -1);
    for (size_t i = 0; !status && i < b->light_count; i++) {
        const facet_light *light = &b->lights[i];
        const bool plain = is_plain(light);
        status = plain ? check_plain_light(light, (int)i, error) : check_light(light, (int)i, error);
        if (!plain || is_negative(light->irradiance)) j->check_lights = true;
        if (light->kind != FACET_LIGHT_DIRECTIONAL) j->streams |= FACET_STREAM_POSITION;
    }
    return status;
}

/* Real spherical harmonics of order 0 and 1, times pi and 2 pi/3 (Ramamoorthi and Hanrahan 2001), over pi. */
#define SH_0 0.282094792f
#define SH_1 0.325735008f

static facet_status take_sh(job *j, const facet_batch *b, facet_error *error)
{
    j->has_sh = !all_zero(b->sh[0], 12);
    if (!j->has_sh) return FACET_OK;
    for (int i = 0; i < 4; i++) {
        facet_status status = check_vector(b->sh[i], "sh", i, error);
        if (status) return status;
        for (int c = 0; c < 3; c++) j->sh[i][c] = b->sh[i][c] * (i ? SH_1 : SH_0);
    }
    return FACET_OK;
}

static facet_status take_ambient(job *j, const facet_batch *b, facet_error *error)
{
    facet_status status = check_vector(b->ambient, "ambient", -1, error);
    if (!status) status = take_sh(j, b, error);
    if (status) return status;
    for (int c = 0; c < 3; c++) j->ambient[c] = b->ambient[c] > 0.0f ? b->ambient[c] * INV_PI : 0.0f;
    j->has_ambient = j->plan->needed & FACET_STREAM_ALBEDO && (j->has_sh || !all_zero(j->ambient, 3));
    if (j->has_ambient && b->occlusion) j->streams |= FACET_STREAM_OCCLUSION;
    return FACET_OK;
}

/* A batch's streams stand one after the other, as job.component wants them. */
#define FIRST_STREAM offsetof(facet_batch, normal)
#define FACET_STREAM(id, field, ...)                                                                                  \
    _Static_assert(offsetof(facet_batch, field) == FIRST_STREAM + COMPONENT_##id * sizeof(float *), #field);
#include "streams.def"

/* The batch's streams, and the material's numbers in the place of those that it does not promise. */
static void take_numbers(job *j, uint32_t numbers)
{
    const float *number = (const float *)(const void *)((const char *)j->plan + offsetof(plan_fields, albedo));
    for (int c = 0; c < COMPONENT_COUNT; c++) j->own[c] = j->component[c];
    for (; numbers; numbers &= numbers - 1) {
        const int stream = __builtin_ctz(numbers), first = places[stream].first;
        for (int c = first; c < first + places[stream].components; c++) j->own[c] = number + (c - COMPONENT_ALBEDO);
    }
    j->component = j->own;
}

/* They stand in a plan as a batch's streams do. */
#define NUMBER_GEOMETRY(id, field)
#define NUMBER_MATERIAL(id, field)                                                                                    \
    _Static_assert(offsetof(plan_fields, field)                                                                       \
                   == offsetof(plan_fields, albedo) + (COMPONENT_##id - COMPONENT_ALBEDO) * sizeof(float), #field);
#define NUMBER_SOURCE NUMBER_MATERIAL
#define FACET_STREAM(id, field, components, owner, ...) NUMBER_##owner(id, field)
#include "streams.def"

/* Those that a material has numbers of. */
enum {
#define MATERIAL_GEOMETRY(id) 0
#define MATERIAL_MATERIAL(id) FACET_STREAM_##id
#define MATERIAL_SOURCE       MATERIAL_MATERIAL
#define FACET_STREAM(id, field, components, owner, ...) MATERIAL_##owner(id) |
    NUMBERED =
#include "streams.def"
    0
};

static facet_status check_camera(const facet_camera *camera, size_t count, facet_error *error)
{
    facet_status status = check_vector(camera->corner, "packed.camera.corner", -1, error);
    if (!status) status = check_vector(camera->across, "packed.camera.across", -1, error);
    if (!status) status = check_vector(camera->down, "packed.camera.down", -1, error);
    if (status) return status;
    const size_t width = camera->width && camera->width < count ? camera->width : count;
    if (camera->width > PIXELS) return refuse(error, FACET_ERROR_VALUE, "packed.camera.width", -1);
    if (camera->x > PIXELS || width > PIXELS - camera->x)
        return refuse(error, FACET_ERROR_VALUE, "packed.camera.x", -1);
    if (camera->y > PIXELS || (count && (count - 1) / width >= PIXELS - camera->y))
        return refuse(error, FACET_ERROR_VALUE, "packed.camera.y", -1);
    return FACET_OK;
}

/* Bits of what comes packed; of what goes. */
static uintptr_t packed_in(const facet_packed *p)
{
    return (uintptr_t)p->normal | (uintptr_t)p->camera | (uintptr_t)p->albedo_roughness | (uintptr_t)p->f0_sigma;
}
static uintptr_t halves(const facet_packed *p)
{
    return (uintptr_t)p->half[0] | (uintptr_t)p->half[1] | (uintptr_t)p->half[2];
}
static uintptr_t packed_out(const facet_packed *p) { return halves(p) | (uintptr_t)p->pixels; }

static facet_status check_words(const void *packed, const char *field, facet_error *error)
{
    return (uintptr_t)packed % sizeof(bits32) ? refuse(error, FACET_ERROR_VALUE, field, -1) : FACET_OK;
}

static __attribute__((noinline, cold)) facet_status check_packed(const job *j, facet_error *error)
{
    const facet_packed *p = j->packed;
    facet_status status = check_words(p->normal, "packed.normal", error);
    if (!status) status = check_words(p->albedo_roughness, "packed.albedo_roughness", error);
    if (!status) status = check_words(p->f0_sigma, "packed.f0_sigma", error);
    if (!status) status = check_words(p->pixels, "packed.pixels", error);
    if (!status && p->camera) status = check_camera(p->camera, j->count, error);
    if (status || !j->packs) return status;
    for (int c = 0; c < 3 && halves(p); c++)
        if (!p->half[c]) return refuse(error, FACET_ERROR_NULL, "packed.half", c);
    if (!(p->exposure >= 0.0f && finite(p->exposure))) return refuse(error, FACET_ERROR_VALUE, "packed.exposure", -1);
    if (j->flags & FACET_ACCUMULATE) return refuse(error, FACET_ERROR_ENUM, "flags", -1);
    return FACET_OK;
}

/* The streams that come packed. */
static uint32_t packed_streams(const facet_packed *p, uint32_t promised)
{
    uint32_t streams = 0;
    if (p->normal) streams |= FACET_STREAM_NORMAL;
    if (p->camera) streams |= FACET_STREAM_VIEW;
    if (p->albedo_roughness) streams |= promised & PACKED_ALBEDO_ROUGHNESS;
    if (p->f0_sigma) streams |= promised & PACKED_F0_SIGMA;
    return streams;
}

/* Whether of the streams that most batches have those are there that are given. */
static inline bool common_given(const facet_batch *b, uint32_t given)
{
#define FACET_STREAM(id, field, components, ...)                                                                      \
    if (COMMON_STREAMS & given & FACET_STREAM_##id && !whole_##components(b->field)) return false;
#include "streams.def"
    return true;
}

/* Refuses the first that is given and not there. */
static __attribute__((noinline)) facet_status check_given(const float *const *component, uint32_t given,
                                                          facet_error *error)
{
    static const char names[STREAM_COUNT][16] = {
#define FACET_STREAM(id, field, ...) #field,
#include "streams.def"
    };
    for (; given; given &= given - 1) {
        const int stream = __builtin_ctz(given), first = places[stream].first;
        for (int c = first; c < first + places[stream].components; c++)
            if (!component[c]) return refuse(error, FACET_ERROR_NULL, names[stream], -1);
    }
    return FACET_OK;
}

/* Finds the streams that are read, or the plan's numbers in their place; names the first that is not there. What the
 * material promised and nothing reads must be there too. */
static facet_status gather_streams(job *j, const facet_batch *b, bool packed, facet_error *error)
{
    const plan_fields *p = j->plan;
    j->streams |= FACET_STREAM_NORMAL | ((p->needed | p->sources) & ~p->derived);
    if (b->flags & FACET_TWO_SIDED || !none_given(b->view)) j->streams |= FACET_STREAM_VIEW;
    j->unpacked = packed ? packed_streams(j->packed, p->promised) : 0;
    j->streams |= j->unpacked & FACET_STREAM_VIEW;
    const uint32_t taken = j->streams | p->promised, numbers = taken & NUMBERED & ~p->promised;
    const uint32_t given = taken & ~(numbers | j->unpacked);
    j->component = (const float *const *)(const void *)((const char *)b + FIRST_STREAM);
    if (given & ~COMMON_STREAMS || !common_given(b, given)) {
        facet_status status = check_given(j->component, given, error);
        if (status) return status;
    }
    if (numbers) take_numbers(j, numbers);
    j->uniform = ((b->uniform & ~j->unpacked) | numbers) & j->streams;
    j->given = (given | j->unpacked) & j->streams;
    j->dense = !(j->uniform | j->unpacked | p->derived);
    return FACET_OK;
}

static facet_status check_flags(const facet_batch *b, facet_error *error)
{
    const uint32_t known_flags = FACET_ACCUMULATE | FACET_TWO_SIDED, known_streams = ((uint32_t)1 << STREAM_COUNT) - 1;
    if (b->flags & ~known_flags) return refuse(error, FACET_ERROR_ENUM, "flags", -1);
    return b->uniform & ~known_streams ? refuse(error, FACET_ERROR_ENUM, "uniform", -1) : FACET_OK;
}

/* ambient and sh stand one after the other. */
_Static_assert(offsetof(facet_batch, sh) == offsetof(facet_batch, ambient) + 3 * sizeof(float), "sh");

/* Streams of floats and lights, and nothing else: as most batches are. */
static inline bool is_simple(const facet_batch *b)
{
    const float *ambient = (const float *)(const void *)((const char *)b + offsetof(facet_batch, ambient));
    return !(b->flags | b->uniform | packed_in(&b->packed) | packed_out(&b->packed)) && all_zero(ambient, 15);
}

static facet_status check_batch(job *j, const facet_batch *b, facet_error *error)
{
    const bool simple = is_simple(b);
    facet_status status = simple ? FACET_OK : check_flags(b, error);
    j->packs = !simple && packed_out(&b->packed);
    j->has_ambient = false;
    if (!status) status = check_lights(j, b, error);
    if (!status && !simple) status = take_ambient(j, b, error);
    if (!status) status = gather_streams(j, b, !simple && packed_in(&b->packed), error);
    if (!status && !simple && (packed_in(j->packed) || j->packs))
        status = FACET_HAS(packed) ? check_packed(j, error) : refuse(error, FACET_ERROR_MODEL, "packed", -1);
    for (int c = 0; c < 3 && !status && !j->packs; c++)
        if (!b->radiance[c]) status = refuse(error, FACET_ERROR_NULL, "radiance", c);
    return status;
}

/* Not inlined: its arithmetic stays between environment_enter and environment_leave. */
static __attribute__((noinline)) facet_status shade(const plan_fields *p, kernel *run, const facet_batch *b,
                                                    facet_error *error)
{
    job j;
    j.plan = p;
    j.streams = 0;
    j.check_lights = false;
    j.count = b->count;
    j.flags = b->flags;
    j.packed = &b->packed;
    facet_status status = check_batch(&j, b, error);
    if (status) return status;

    j.lights = b->lights;
    j.light_count = b->light_count;
    j.coverage = b->coverage;
    j.invalid = b->invalid;
    j.radiance = b->radiance;
    run(&j);
    return FACET_OK;
}

facet_status facet_shade_sized(const facet_plan *plan, const facet_batch *batch, size_t batch_size, size_t light_size,
                               facet_error *error)
{
    const plan_fields *p = (const plan_fields *)plan;
    facet_batch own;
    refuse(error, FACET_OK, 0, -1);
    if (!p) return refuse(error, FACET_ERROR_NULL, "plan", -1);
    kernel *run = plan_kernel(p);
    if (!run) return refuse(error, FACET_ERROR_PLAN, "plan", -1);
    if (!batch) return refuse(error, FACET_ERROR_NULL, "batch", -1);
    if (batch_size != sizeof own) {
        if (!adopt(&own, sizeof own, batch, batch_size)) return refuse(error, FACET_ERROR_SIZE, "batch", -1);
        batch = &own;
    }
    if (light_size != sizeof(facet_light) && batch->light_count) return refuse(error, FACET_ERROR_SIZE, "lights", -1);

    environment callers = environment_enter();
    facet_status status = shade(p, run, batch, error);
    environment_leave(callers);
    return status;
}
