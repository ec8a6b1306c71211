/* The kernels under directional lights: what lights there are is another matter. */
#include "recipes.h"

enum { MOST_RECIPES = 256, WAYS = 4 };

static recipe recipes[MOST_RECIPES];
static int recipes_found;

/* The ways to say the parameters that `kernel` reads. */
static const struct { facet_convention convention; bool from_others; } ways[WAYS] = {
    { FACET_CONVENTION_METALLIC_ROUGHNESS, false },
    { FACET_CONVENTION_SPECULAR_GLOSSINESS, false },
    { FACET_CONVENTION_DIRECT, true },
    { FACET_CONVENTION_METALLIC_ROUGHNESS, true },
};

/* In `set`, the streams `from` in place of `stream`. */
static void replace(uint32_t *set, uint32_t stream, uint32_t from)
{
    if (*set & stream) *set = (*set & ~stream) | from;
}

static uint32_t streams_of(const kernel_case *kernel, facet_convention convention, bool from_others)
{
    const bool dielectric = kernel->streams & FACET_STREAM_ETA && !(kernel->streams & FACET_STREAM_K);
    const bool metallic = convention == FACET_CONVENTION_METALLIC_ROUGHNESS;
    uint32_t set = kernel->streams;
    if (from_others) {
        replace(&set, FACET_STREAM_ALPHA_Y, FACET_STREAM_ALPHA);
        if (dielectric) replace(&set, FACET_STREAM_ETA, FACET_STREAM_F0);
        else if (!metallic) replace(&set, FACET_STREAM_F0, FACET_STREAM_ETA | FACET_STREAM_K);
    }
    if (metallic) {
        replace(&set, FACET_STREAM_ALBEDO, FACET_STREAM_BASE | FACET_STREAM_METALLIC);
        replace(&set, FACET_STREAM_F0, FACET_STREAM_BASE | FACET_STREAM_METALLIC | FACET_STREAM_SPECULAR_LEVEL);
        replace(&set, FACET_STREAM_ALPHA, FACET_STREAM_ROUGHNESS);
    }
    if (convention == FACET_CONVENTION_SPECULAR_GLOSSINESS)
        replace(&set, FACET_STREAM_ALPHA, FACET_STREAM_GLOSSINESS);
    return set;
}

static void add(const kernel_case *kernel, facet_convention convention, bool from_others)
{
    recipes[recipes_found++] = (recipe){ kernel, convention, from_others,
                                         streams_of(kernel, convention, from_others) };
}

/* Whether the way leads to streams that no way before it does. */
static bool is_new(const kernel_case *kernel, int way)
{
    const uint32_t set = streams_of(kernel, ways[way].convention, ways[way].from_others);
    bool found = set == kernel->streams;
    for (int i = 0; i < way; i++) found |= set == streams_of(kernel, ways[i].convention, ways[i].from_others);
    return !found;
}

/* Every way of a kernel that reads eta; of others one, the next from `first` on. */
static void add_derived(const kernel_case *kernel, int first)
{
    for (int i = 0; i < WAYS; i++) {
        const int way = (first + i) % WAYS;
        if (!is_new(kernel, way)) continue;
        add(kernel, ways[way].convention, ways[way].from_others);
        if (!(kernel->streams & FACET_STREAM_ETA)) return;
    }
}

static void find_recipes(void)
{
    for (int i = 0; i < case_count() && recipes_found + 1 + WAYS <= MOST_RECIPES; i++) {
        if (case_at(i)->light.kind != FACET_LIGHT_DIRECTIONAL) continue;
        add(case_at(i), FACET_CONVENTION_DIRECT, false);
        add_derived(case_at(i), i % WAYS);
    }
}

int recipe_count(void)
{
    if (!recipes_found) find_recipes();
    return recipes_found;
}

const recipe *recipe_at(int index)
{
    return index >= 0 && index < recipe_count() ? &recipes[index] : 0;
}

bool is_derived(const recipe *r) { return r->reads != r->kernel->streams; }
