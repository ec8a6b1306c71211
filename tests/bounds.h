/* The promised error bounds, tests/accuracy.tsv, and errors in their units. With u = 2^-24, a radiance `got` is held
 * against
 *
 *     |got - want| <= u magnitude (rel + grazing/nl + peak/alpha) + tiny
 *
 * for unit vectors (as near as float holds them), a tangent that is perpendicular to the normal (as near), nl, nv >=
 * 2^-22 and alpha as clamped; under a point or spot light, whose l is rounded, also vh >= 2^-6, so that v + l keeps its
 * direction. `want` and `magnitude` are reference_terms', and `tiny` is what underflow may cost. Of an anisotropic
 * distribution alpha is the smaller one, and nl the smaller of nl and nv: v may lie along the narrow axis and l along
 * the wide one. Of a lobe alpha is sqrt(2/(exponent + 2)). Where nl, nv > 5e-4, alpha >= 0.01, the same is at most
 * plain magnitude. */
#ifndef BOUNDS_H
#define BOUNDS_H

#include "cases.h"
#include "reference.h"

#include <stdio.h>

/* What a witness is the worst of: samples where this term is the largest of the bound; or the plain domain. */
enum { GOAL_REL, GOAL_GRAZING, GOAL_PEAK, GOAL_PLAIN, GOALS };
extern const char *const goal_words[GOALS];

typedef struct {
    double limit[GOALS];         /* rel, grazing, peak; plain. A term of 0 is none */
    double p999;                 /* of the error over magnitude, half of the samples uniform and half in the lobe */
    facet_distribution distribution;
} error_bound;

/* A witness is grey: one channel's albedo, f0, eta, k and irradiance stand in all three. */
typedef struct {
    sample s;
    facet_arch arch;
    float got;
    double want, reached;        /* error over bound */
} witness;

typedef struct {
    char name[64];
    facet_tier tier;
    error_bound bound;
    witness worst[GOALS];        /* reached is 0 where the goal has none */
} accuracy_row;

/* That channel in all three. */
void make_grey(sample *s, int channel);

/* The table: rows in its order, or NULL past the last; the row of a case. A table that cannot be read has no rows, and
 * a line on stderr says so. */
const accuracy_row *accuracy_at(int index);
const accuracy_row *find_accuracy(const char *name, facet_tier tier);

/* Puts a row in the place of its case's and tier's, or behind the last. */
void keep_accuracy(const accuracy_row *row);

/* Writes the table's head, and a row. */
void write_accuracy_head(FILE *file);
void write_accuracy(FILE *file, const accuracy_row *row);

/* Whether the bounds promise something for the sample: at all; in the plain domain. */
bool in_domain(const sample *s, cosines c);
bool in_plain_domain(const error_bound *b, const sample *s, cosines c);

/* The bound on error_over_magnitude, from the three terms; `goal`, where not NULL, is the largest of them. */
double bound_at(const error_bound *b, const sample *s, cosines c, int *goal);

/* |got - want| over magnitude, less what underflow may cost; infinite where it is not a number. */
double error_over_magnitude(float got, double want, double magnitude, float irradiance);

#endif
