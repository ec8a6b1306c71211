#include "pairwise.h"

#include "harness.h"

#include <stdlib.h>
#include <string.h>

enum { UNSEEN = 0, SEEN, EXCLUDED };

/* A level of a factor has a place, from first[factor] on; `met` tells of two places. */
typedef struct {
    const factor_space *space;
    int first[MOST_FACTORS + 1];
    unsigned char *met;
    test_random random;
} designer;

typedef struct { level_set allowed[MOST_FACTORS]; } constraint;

static unsigned char *meeting(designer *d, int f, int level_f, int g, int level_g)
{
    const size_t a = (size_t)(d->first[f] + level_f), b = (size_t)(d->first[g] + level_g);
    const size_t places = (size_t)d->first[d->space->factors];
    return a < b ? &d->met[a * places + b] : &d->met[b * places + a];
}

/* The constraint with one more level chosen. False where nothing is left of some factor that counts: a level that asks
 * for it cannot be had. */
static bool choose(const designer *d, constraint *c, int factor, int level)
{
    if (!has_level(&c->allowed[factor], level)) return false;
    c->allowed[factor] = (level_set){ { 0 } };
    add_level(&c->allowed[factor], level);
    d->space->require(factor, level, c->allowed);
    for (int f = 0; f < d->space->factors; f++)
        if (no_levels(&c->allowed[f])) return false;
    return true;
}

static constraint anything(const designer *d)
{
    constraint c = { 0 };
    for (int f = 0; f < d->space->factors; f++)
        for (int level = 0; level < d->space->levels[f]; level++) add_level(&c.allowed[f], level);
    return c;
}

static int new_pairs(designer *d, const design *chosen, int factor, int level)
{
    int count = 0;
    for (int f = 0; f < d->space->factors; f++)
        if (f != factor && chosen->level[f] >= 0) count += *meeting(d, f, chosen->level[f], factor, level) == UNSEEN;
    return count;
}

/* The level that brings most new pairs with those chosen; -1 where none goes with them. */
static int best_level(designer *d, const constraint *c, const design *chosen, int factor)
{
    const int levels = d->space->levels[factor], from = (int)(random_u64(&d->random) % (uint64_t)levels);
    int best = -1, most = -1;
    for (int i = 0; i < levels; i++) {
        const int level = (from + i) % levels;
        constraint with = *c;
        if (!choose(d, &with, factor, level)) continue;
        const int count = new_pairs(d, chosen, factor, level);
        if (count > most) most = count, best = level;
    }
    return best;
}

/* Around two levels that have not met; false where they exclude each other. */
static bool complete(designer *d, int f, int level_f, int g, int level_g, design *result)
{
    constraint c = anything(d);
    if (!choose(d, &c, f, level_f) || !choose(d, &c, g, level_g)) return false;
    for (int i = 0; i < d->space->factors; i++) result->level[i] = i == f ? level_f : i == g ? level_g : -1;
    for (int i = 0; i < d->space->factors; i++) {
        if (i == f || i == g) continue;
        result->level[i] = best_level(d, &c, result, i);
        if (result->level[i] >= 0) choose(d, &c, i, result->level[i]);
    }
    return true;
}

static void mark(designer *d, const design *chosen, design_set *set)
{
    for (int f = 0; f < d->space->factors; f++)
        for (int g = 0; g < f; g++) {
            if (chosen->level[f] < 0 || chosen->level[g] < 0) continue;
            unsigned char *met = meeting(d, f, chosen->level[f], g, chosen->level[g]);
            set->pairs += *met == UNSEEN;
            *met = SEEN;
        }
}

static void meet(designer *d, int f, int level_f, int g, int level_g, design_set *set)
{
    unsigned char *met = meeting(d, f, level_f, g, level_g);
    if (*met != UNSEEN) return;
    set->designs = realloc(set->designs, (size_t)(set->count + 1) * sizeof *set->designs);
    if (!set->designs) abort();
    if (complete(d, f, level_f, g, level_g, &set->designs[set->count])) {
        mark(d, &set->designs[set->count++], set);
    } else {
        *met = EXCLUDED;
        set->excluded++;
    }
}

design_set design_pairs(const factor_space *space, uint64_t seed)
{
    designer d = { .space = space, .random = { seed } };
    design_set set = { NULL, 0, 0, 0 };
    for (int f = 0; f < space->factors; f++) d.first[f + 1] = d.first[f] + space->levels[f];
    const size_t places = (size_t)d.first[space->factors];
    d.met = calloc(places, places);
    if (!d.met) abort();
    for (int f = 0; f < space->factors; f++)
        for (int g = 0; g < f; g++)
            for (int i = 0; i < space->levels[f]; i++)
                for (int k = 0; k < space->levels[g]; k++) meet(&d, f, i, g, k, &set);
    free(d.met);
    return set;
}
