/* The api suite: its parts, and what they work with. */
#ifndef API_H
#define API_H

#include "samples.h"

/* What a material may promise. */
enum {
#define OF_GEOMETRY(id)
#define OF_MATERIAL(id) | FACET_STREAM_##id
#define OF_SOURCE(id)   | FACET_STREAM_##id
#define FACET_STREAM(id, field, components, owner, ...) OF_##owner(id)
    MATERIAL_STREAMS = 0
#include "streams.def"
};

static const facet_target strict_scalar = { .arch = FACET_ARCH_SCALAR, .tier = FACET_TIER_STRICT };

/* Every number has a value that is neither its default nor at an end of its domain. */
facet_material rich_material(void);
facet_plan make_plan(const facet_material *, facet_target);      /* a refusal fails the test */

/* Random samples with every stream; their radiance is 0. */
sample_batch random_batch(int count, uint64_t seed);
bool same_radiance(const facet_batch *, const facet_batch *);

/* Tests. */
void test_refused_plans(void);       /* refused_plans.c */
void test_refused_batches(void);     /* refused_batches.c */
void test_sizes(void);               /* sizes.c */

#endif
