/* The vector layer's operations as functions over arrays: what ops_arch.c exports and ops.c measures. */
#ifndef OPS_H
#define OPS_H

#include <stddef.h>

/* Applies one operation to every lane of arrays of `count` floats, a multiple of the lanes. A mask comes out as 1
 * and 0. */
typedef void operation(const float *a, const float *b, const float *c, float *out, size_t count);

/* The operations by their place in ops.def. */
enum {
#define OPERATION(name, ...) OPERATION_##name,
#include "ops.def"
    OPERATION_COUNT
};

typedef struct {
    int lanes;
    operation *operations[OPERATION_COUNT];
} ops_table;

/* What a lane holds where an operation has done more or less than it should: bits beyond the lanes, lanes that
 * differ. */
#define OPS_BROKEN -2.5f

#endif
