/* Designs of experiments in which every two levels of any two factors meet, unless they exclude each other. */
#ifndef PAIRWISE_H
#define PAIRWISE_H

#include <stdbool.h>
#include <stdint.h>

enum { MOST_FACTORS = 80, MOST_LEVELS = 128 };

/* A set of levels. */
typedef struct { uint64_t bits[MOST_LEVELS / 64]; } level_set;

static inline bool has_level(const level_set *s, int level) { return s->bits[level / 64] >> level % 64 & 1; }
static inline void add_level(level_set *s, int level) { s->bits[level / 64] |= UINT64_C(1) << level % 64; }
static inline void remove_level(level_set *s, int level) { s->bits[level / 64] &= ~(UINT64_C(1) << level % 64); }

static inline void keep_levels(level_set *s, level_set of)
{
    for (int i = 0; i < MOST_LEVELS / 64; i++) s->bits[i] &= of.bits[i];
}

static inline bool no_levels(const level_set *s)
{
    uint64_t any = 0;
    for (int i = 0; i < MOST_LEVELS / 64; i++) any |= s->bits[i];
    return !any;
}

/* Factors in the order in which levels are chosen: those that exclude levels of others come first. */
typedef struct {
    int factors, levels[MOST_FACTORS];
    /* Removes from `allowed`, a set for every factor, the levels that do not go with this one. */
    void (*require)(int factor, int level, level_set *allowed);
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
