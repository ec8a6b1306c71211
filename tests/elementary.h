/* The elementary functions of src/elementary.tmpl.h over arrays: what elementary_arch.c exports and elementary.c
 * measures. */
#ifndef ELEMENTARY_H
#define ELEMENTARY_H

#include <stddef.h>

/* Every function of elementary.tmpl.h: of one variable, of two. */
#define ELEMENTARY_FUNCTIONS(ONE, TWO)                                                                                \
    ONE(exp_minus, EXP_MINUS_WORST)                                                                                   \
    TWO(log1p_ratio, LOG1P_RATIO_WORST)                                                                               \
    ONE(arccos, ARCCOS_WORST)                                                                                         \
    ONE(ierfc_half, IERFC_HALF_WORST)

enum {
#define PLACE(name, worst) ELEMENTARY_##name,
    ELEMENTARY_FUNCTIONS(PLACE, PLACE)
#undef PLACE
    ELEMENTARY_COUNT
};

/* Over arrays of `count` floats, a multiple of the lanes. */
typedef void elementary_function(const float *a, const float *b, float *out, size_t count);

/* A bound, and an input near it. */
typedef struct { double bound; float at[2]; } elementary_worst;

typedef struct {
    elementary_function *functions[ELEMENTARY_COUNT];
    elementary_worst worst[ELEMENTARY_COUNT][2];   /* where vf_mad rounds once, where it rounds twice */
    int (*roundings)(void);
} elementary_table;

#endif
