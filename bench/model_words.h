/* Models by their words, and the numbers that stand behind a word: WORD:NUMBERS. The numbers of one quantity stand with
 * commas, one quantity after another with slashes: conductor:0.2,0.4,1.4/3.1,2.4,1.8. Which quantities a model has
 * follows from what it reads in models.def. */
#ifndef MODEL_WORDS_H
#define MODEL_WORDS_H

#include "command_line.h"

/* Of a light. */
typedef struct light_numbers {
    float place[3], axis[3], cone[2], irradiance[3], range;   /* cone: degrees from the axis, inner and outer */
} light_numbers;

/* A row of models.def, a convention, or a kind of light. */
typedef struct model {
    facet_kind kind;
    int value;
    uint32_t reads;                /* FACET_STREAM_* */
    int properties;
    float sigma_max;
    const char *title;
} model;

/* Without a row, a model reads nothing. */
model model_of(facet_kind kind, int value);

/* FACET_STREAM_*: what stands behind words of a kind, in this or that model; and clears their numbers. */
uint32_t model_streams(facet_kind kind);
void model_forget(facet_kind kind, facet_material *material);

/* FACET_STREAM_*: what a convention's numbers stand in for. */
uint32_t convention_replaces(facet_convention convention);

/* Whether a metal's name may stand for its numbers; and gives a material a metal's indices, and reflectances that
 * follow from them. */
bool model_takes_metal(const model *m);
void model_set_metal(facet_material *material, facet_metal metal);

/* Whether it needs a reflectance at 82 degrees, or indices to compute it from. */
bool model_takes_f82(const model *m);

/* Writes the word and its numbers as one types them, or with METAL in their place. */
void model_form(const model *m, bool metal, char *text, size_t size);

/* Reads the numbers behind the word (NULL: there are none) into a facet_material, or into light_numbers. Says what is
 * wrong with the value `whole` of the option. */
bool model_read(const model *m, const char *text, void *into, const setting *s, const char *whole);

#endif
