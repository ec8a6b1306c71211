/* What a material's parameters follow from: each kernel with its parameters as they are, and again with some made of
 * others, the ways to do so in turn. */
#ifndef RECIPES_H
#define RECIPES_H

#include "cases.h"

/* The streams by their place in streams.def. */
enum {
#define FACET_STREAM(id, ...) STREAM_##id,
#include "streams.def"
    BATCH_STREAMS
};

typedef struct {
    const kernel_case *kernel;
    facet_convention convention;
    bool from_others;        /* a dielectric's eta follows from f0, another's f0 from eta and k, alpha_y from alpha */
    uint32_t reads;          /* FACET_STREAM_*: what a material takes as numbers or promises; tangents */
} recipe;

int recipe_count(void);
const recipe *recipe_at(int index);

/* Whether some of the kernel's parameters are made of others. */
bool is_derived(const recipe *r);

#endif
