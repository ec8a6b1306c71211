/* filtered [WORD ...]: this build holds the models of these words, and packed streams where "packed" is one, and
 * refuses the others (no words: it holds all).
 * Prints a line for every material that it shades: the models, and a hash of the strict results. */
#include "facet.h"
#include "models.def"                /* the properties of its rows */

#include <stdio.h>
#include <string.h>

enum { COUNT = 37, KINDS = FACET_KIND_FRESNEL + 1 };

static char **words;
static int word_count, failures;

/* Lobes, and the maskings that go with a distribution, by models.def. */
static bool is_lobe(int distribution)
{
    switch (distribution) {
#define FACET_DISTRIBUTION(id, name, word, reads, properties, title)                                                  \
    case FACET_DISTRIBUTION_##id: return (properties) & LOBE;
#include "models.def"
    }
    return false;
}

enum {
#define FACET_DISTRIBUTION(id, name, ...) DISTRIBUTION_##name = FACET_DISTRIBUTION_##id,
#define FACET_MASKING(id, name, ...) MASKING_##name = FACET_MASKING_##id,
#include "models.def"
};

static bool go_together(int masking, int distribution)
{
#define FACET_VISIBILITY(masking_, distribution_, properties)                                                         \
    if (masking == MASKING_##masking_ && distribution == DISTRIBUTION_##distribution_) return true;
#include "models.def"
    return false;
}

static bool named(const char *word)
{
    bool found = !word_count;
    for (int i = 0; i < word_count; i++) found |= !strcmp(word, words[i]);
    return found;
}

static bool expected(facet_kind kind, int value)
{
    const char *word = facet_word(kind, value);
    return named(word) || !strcmp(word, "none");
}

static void complain(const int *value, const char *what)
{
    printf("%s %s %s %s: %s\n", facet_word(FACET_KIND_DIFFUSE, value[0]), facet_word(FACET_KIND_DISTRIBUTION, value[1]),
           facet_word(FACET_KIND_MASKING, value[2]), facet_word(FACET_KIND_FRESNEL, value[3]), what);
    failures++;
}

/* FNV-1a of the bits, not the bytes: the same on any byte order. */
static uint32_t hash_of(const float *a, int count)
{
    uint32_t hash = 2166136261u, bits;
    for (int i = 0; i < count; i++) {
        memcpy(&bits, &a[i], sizeof bits);
        for (int shift = 0; shift < 32; shift += 8) hash = (hash ^ (bits >> shift & 0xff)) * 16777619u;
    }
    return hash;
}

static uint32_t shaded(const facet_plan *plan)
{
    static float stream[6][COUNT], radiance[3][COUNT];
    const float zero = 0.0f, one = 1.0f;
    const facet_light light = { .direction = { 0.6f, 0.0f, 0.8f }, .irradiance = { 3.0f, 2.0f, 1.0f } };
    const facet_batch batch = {
        .count = COUNT,
        .normal = { &zero, &zero, &one },
        .view = { stream[0], stream[1], stream[2] },
        .tangent = { &one, &zero, &zero },
        .uniform = FACET_STREAM_NORMAL | FACET_STREAM_TANGENT,
        .lights = &light,
        .light_count = 1,
        .radiance = { radiance[0], radiance[1], radiance[2] },
    };
    for (int i = 0; i < COUNT; i++) {      /* 2t/(1 + t2), (1 - t2)/(1 + t2): on the unit circle */
        const float t = (float)(i - COUNT / 2) / 20.0f;
        stream[0][i] = 2.0f * t / (1.0f + t * t);
        stream[1][i] = 0.0f;
        stream[2][i] = (1.0f - t * t) / (1.0f + t * t);
    }
    return facet_shade(plan, &batch, NULL) ? 0 : hash_of(radiance[0], 3 * COUNT);
}

static void try_material(const int *value)
{
    const facet_target target = { .arch = FACET_ARCH_SCALAR, .tier = FACET_TIER_STRICT };
    const facet_material material = {
        .diffuse = { (facet_diffuse)value[0], { 0.5f, 0.25f, 0.75f }, 0.3f },
        .specular = { .model = (facet_distribution)value[1], .masking = (facet_masking)value[2],
                      .alpha = 0.3f, .alpha_y = 0.15f, .exponent = 20.0f },
        .fresnel = { .model = (facet_fresnel)value[3], .f0 = { 0.04f, 0.5f, 0.9f }, .f82 = { 0.1f, 0.4f, 0.8f },
                     .eta = { 1.5f, 0.2f, 0.9f }, .k = { 0.0f, 3.0f, 6.0f } },
    };
    bool has = expected(FACET_KIND_DIFFUSE, value[0]) && expected(FACET_KIND_DISTRIBUTION, value[1]);
    if (value[1] != FACET_DISTRIBUTION_NONE) has = has && expected(FACET_KIND_FRESNEL, value[3]);
    if (value[1] != FACET_DISTRIBUTION_NONE && !is_lobe(value[1]))
        has = has && expected(FACET_KIND_MASKING, value[2]) && go_together(value[2], value[1]);

    facet_plan plan;
    facet_status status = facet_plan_init(&plan, &material, target, NULL);
    if (status != (has ? FACET_OK : FACET_ERROR_MODEL)) complain(value, facet_word(FACET_KIND_STATUS, (int)status));
    if (status) return;
    uint32_t hash = shaded(&plan);
    if (!hash) complain(value, "does not shade");
    printf("%d %d %d %d %08x\n", value[0], value[1], value[2], value[3], hash);
}

/* Packed streams are a word of their own; emission needs no model. */
static void try_packed(void)
{
    const facet_target target = { .arch = FACET_ARCH_SCALAR, .tier = FACET_TIER_STRICT };
    const facet_material material = { .emission = { 0.5f, 0.25f, 0.75f } };
    static const uint32_t normal[COUNT];
    static uint16_t half[3][COUNT];
    const facet_batch batch = {
        .count = COUNT,
        .packed = { .normal = (const int16_t *)(const void *)normal, .half = { half[0], half[1], half[2] } },
    };
    facet_plan plan;
    facet_error error;
    facet_status status = facet_plan_init(&plan, &material, target, NULL);
    if (!status) status = facet_shade(&plan, &batch, &error);
    const bool right = named("packed") ? !status && half[0][0] == 0x3800 && half[2][COUNT - 1] == 0x3a00
                                       : status == FACET_ERROR_MODEL && !strcmp(error.field, "packed") && !half[0][0];
    if (right) return;
    printf("packed streams: %s\n", facet_word(FACET_KIND_STATUS, (int)status));
    failures++;
}

int main(int count, char **arguments)
{
    int value[KINDS] = { 0 };
    words = arguments + 1;
    word_count = count - 1;

    for (int kind = 0; kind < KINDS; kind++)
        for (int i = 0; facet_word((facet_kind)kind, i); i++)
            if (facet_has((facet_kind)kind, i) != expected((facet_kind)kind, i)) {
                printf("facet_has is wrong about %s\n", facet_word((facet_kind)kind, i));
                failures++;
            }
    for (value[0] = 0; facet_word(FACET_KIND_DIFFUSE, value[0]); value[0]++)
        for (value[1] = 0; facet_word(FACET_KIND_DISTRIBUTION, value[1]); value[1]++)
            for (value[2] = 0; facet_word(FACET_KIND_MASKING, value[2]); value[2]++)
                for (value[3] = 0; facet_word(FACET_KIND_FRESNEL, value[3]); value[3]++) try_material(value);
    try_packed();
    return failures > 0;
}
