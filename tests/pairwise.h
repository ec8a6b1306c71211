/* Designs of experiments in which every two levels of any two factors meet, unless they exclude each other. */
#ifndef PAIRWISE_H
#define PAIRWISE_H

#include <stdint.h>

enum { MOST_FACTORS = 48, MOST_LEVELS = 64 };

/* Factors in the order in which levels are chosen: those that exclude levels of others come first. */
typedef struct {
    int factors, levels[MOST_FACTORS];
    /* Clears the bits of `allowed`, a mask for every factor, of the levels that do not go with this one. */
    void (*require)(int factor, int level, uint64_t *allowed);
} factor_space;

/* A level of every factor; -1: the factor means nothing beside the other levels. */
typedef struct { int level[MOST_FACTORS]; } design;

typedef struct {
    design *designs;             /* free() it */
    int count;
    int pairs, excluded;         /* of levels: that occur in the designs; that cannot occur */
} design_set;

/* The same designs for the same seed everywhere. */
design_set design_pairs(const factor_space *space, uint64_t seed);

#endif
