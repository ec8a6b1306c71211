#include "rigs.h"
#include "vector.h"

#define PI 3.14159265358979323846

static const struct { const char *word, *note; } words[] = {
    [RIG_STUDIO] = {"studio", "key, fill, two rims and the floor's glow"},
    [RIG_BOXES] = {"boxes", "soft boxes of point lights"},
    [RIG_RIM] = {"rim", "rings of lights from behind, and a weak one from the front"},
};

enum { RIGS = sizeof words / sizeof *words };

const char *rig_word(int value)
{
    return value >= 0 && value < RIGS ? words[value].word : NULL;
}

const char *rig_note(int value)
{
    return value >= 0 && value < RIGS ? words[value].note : NULL;
}

static void add(shading *s, const facet_light *light)
{
    double unit[3];
    if (s->light_count == LIGHT_LIMIT)
        return;
    facet_light *added = &s->lights[s->light_count++];
    *added = *light;
    vector_widen(unit, light->direction);
    vector_normalise(unit);
    vector_narrow(added->direction, unit);
}

/* ---- Studio ---------------------------------------------------------------------------------------------------- */

static const facet_light studio[] = {
    {.direction = {-0.62f, 0.66f, 0.42f}, .irradiance = {3.0f, 2.85f, 2.6f}},
    {.direction = {0.78f, 0.22f, 0.59f}, .irradiance = {0.40f, 0.48f, 0.62f}},
    {.direction = {0.66f, 0.46f, -0.59f}, .irradiance = {2.0f, 2.2f, 2.6f}},
    {.direction = {-0.80f, 0.15f, -0.58f}, .irradiance = {1.4f, 1.3f, 1.2f}},
    {.direction = {0.20f, -0.87f, 0.45f}, .irradiance = {0.22f, 0.20f, 0.19f}},
};

/* ---- Boxes ----------------------------------------------------------------------------------------------------- */

/* A parallelogram of point lights around `centre`, half of it along `u` and `v`, which together radiate `intensity`. */
typedef struct box {
    float centre[3], u[3], v[3];
    int columns, rows;
    float intensity[3];
} box;

/* Over the mesh, to its left and right, behind it on both sides, the floor, and a little from the front. */
static const box boxes[] = {
    {{-0.3f, 2.3f, 1.0f}, {1.5f, 0, 0}, {0, 0.35f, -0.7f}, 5, 3, {11.2f, 11.1f, 10.9f}},
    {{-2.7f, 0.2f, 1.1f}, {0.25f, 0, 0.45f}, {0, 1.1f, 0}, 2, 5, {5.4f, 5.6f, 6.0f}},
    {{2.7f, 0.2f, 0.7f}, {0.2f, 0, -0.45f}, {0, 1.1f, 0}, 2, 5, {7.3f, 6.9f, 6.4f}},
    {{-2.0f, 0.3f, -1.7f}, {0, 0.9f, 0}, {0.4f, 0, -0.2f}, 6, 1, {4.0f, 4.1f, 4.4f}},
    {{2.0f, 0.3f, -1.7f}, {0, 0.9f, 0}, {0.4f, 0, 0.2f}, 6, 1, {4.0f, 4.1f, 4.4f}},
    {{0, -2.6f, 0.9f}, {1.6f, 0, 0}, {0, 0, 0.7f}, 5, 2, {3.0f, 2.9f, 2.7f}},
    {{-0.4f, 0.9f, 3.2f}, {1.6f, 0, 0}, {0, 0.8f, 0}, 3, 2, {1.8f, 1.8f, 1.8f}},
};

static void add_box(shading *s, const box *b)
{
    for (int i = 0; i < b->columns * b->rows; i++) {
        float along_u = (float)(2 * (i % b->columns) + 1) / (float)b->columns - 1;
        float along_v = (float)(2 * (i / b->columns) + 1) / (float)b->rows - 1;
        facet_light light = {.kind = FACET_LIGHT_POINT};
        for (int c = 0; c < 3; c++) {
            light.position[c] = b->centre[c] + along_u * b->u[c] + along_v * b->v[c];
            light.irradiance[c] = b->intensity[c] / (float)(b->columns * b->rows);
        }
        add(s, &light);
    }
}

/* ---- Rim ------------------------------------------------------------------------------------------------------- */

/* Rings around the view axis: the angle from the direction to the eye, degrees, and the irradiance of their sum. */
static const struct { double angle; float irradiance; } rings[] = {{138, 2.2f}, {150, 1.8f}, {163, 1.4f}};

enum { RINGS = sizeof rings / sizeof *rings, RING_LIGHTS = 20 };

static void add_ring_light(shading *s, double angle, double turn, float irradiance)
{
    double polar = angle * (PI / 180), around = turn * 2 * PI;
    facet_light light = {.irradiance = {irradiance, irradiance, irradiance}};
    vector_narrow(light.direction, (const double[3]){sin(polar) * cos(around), sin(polar) * sin(around), cos(polar)});
    add(s, &light);
}

void rig_add(shading *s, rig which)
{
    if (which == RIG_STUDIO)
        for (size_t i = 0; i < sizeof studio / sizeof *studio; i++)
            add(s, &studio[i]);
    if (which == RIG_BOXES)
        for (size_t i = 0; i < sizeof boxes / sizeof *boxes; i++)
            add_box(s, &boxes[i]);
    if (which == RIG_RIM)
        for (int i = 0; i < RINGS * RING_LIGHTS; i++)
            add_ring_light(s, rings[i / RING_LIGHTS].angle, (double)(i % RING_LIGHTS) / (double)RING_LIGHTS,
                           rings[i / RING_LIGHTS].irradiance / (float)RING_LIGHTS);
    if (which == RIG_RIM)
        add_ring_light(s, 40, 0.35, 1);
}
