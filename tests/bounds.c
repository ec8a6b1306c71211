/* The table of error bounds: reading, writing, and what it promises. */
#include "bounds.h"

#include "harness.h"

#include <errno.h>
#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

const char *const goal_words[GOALS] = { "rel", "grazing", "peak", "plain" };

enum { WITNESS_FLOATS = 24, MOST_ROWS = 512 };

/* ---- The promise ------------------------------------------------------------------------------------------------- */

static double dot(const float *a, const float *b)
{
    return (double)a[0] * b[0] + (double)a[1] * b[1] + (double)a[2] * b[2];
}

static bool is_unit(const float *a)
{
    return fabs(dot(a, a) - 1) <= 0x1p-21;
}

/* Where there is one. */
static bool is_tangent(const float *a, const float *n)
{
    return dot(a, a) == 0 || (is_unit(a) && fabs(dot(a, n)) <= 0x1p-21);
}

bool in_domain(const sample *s, cosines c)
{
    return c.nl >= 0x1p-22 && c.nv >= 0x1p-22 && is_unit(s->n) && is_unit(s->v) && is_tangent(s->tangent, s->n)
        && (s->light ? c.vh >= 0x1p-6 : is_unit(s->l));
}

static bool is_anisotropic(facet_distribution model)
{
    return model == FACET_DISTRIBUTION_GGX_ANISOTROPIC || model == FACET_DISTRIBUTION_BECKMANN_ANISOTROPIC;
}

static bool is_lobe(facet_distribution model)
{
    return model == FACET_DISTRIBUTION_PHONG || model == FACET_DISTRIBUTION_PHONG_MODIFIED
        || model == FACET_DISTRIBUTION_BLINN_PHONG || model == FACET_DISTRIBUTION_BLINN_PHONG_NORMALISED;
}

/* The width of what peaks. */
static double alpha_of(facet_distribution model, const sample *s)
{
    const double exponent = fmin(fmax(s->exponent, FACET_EXPONENT_MIN), FACET_EXPONENT_MAX);
    const double alpha = fmin(fmax(s->alpha, FACET_ALPHA_FLOOR), 1), alpha_y = fmax(s->alpha_y, FACET_ALPHA_FLOOR);
    return is_lobe(model) ? sqrt(2 / (exponent + 2)) : is_anisotropic(model) ? fmin(alpha, alpha_y) : alpha;
}

bool in_plain_domain(const error_bound *b, const sample *s, cosines c)
{
    return in_domain(s, c) && c.nl > 5e-4 && c.nv > 5e-4 && alpha_of(b->distribution, s) >= 0.01;
}

double bound_at(const error_bound *b, const sample *s, cosines c, int *goal)
{
    const double alpha = alpha_of(b->distribution, s), nl = is_anisotropic(b->distribution) ? fmin(c.nl, c.nv) : c.nl;
    const double terms[] = { b->limit[GOAL_REL], b->limit[GOAL_GRAZING] / nl, b->limit[GOAL_PEAK] / alpha };
    double sum = 0;
    int largest = GOAL_REL;
    for (int i = GOAL_REL; i <= GOAL_PEAK; i++) {
        sum += terms[i];
        if (terms[i] > terms[largest]) largest = i;
    }
    if (goal) *goal = largest;
    return 0x1p-24 * sum;
}

double error_over_magnitude(float got, double want, double magnitude, float irradiance)
{
    const double tiny = 1e-30 * fmax(1, irradiance), error = fmax(0, fabs(got - want) - tiny);
    if (!isfinite(got) || !isfinite(want) || !(magnitude >= 0)) return INFINITY;
    return error > 0 ? error / magnitude : 0;
}

void make_grey(sample *s, int channel)
{
    float *const colours[] = { s->albedo, s->f0, s->eta, s->k, s->irradiance };
    for (int i = 0; i < 5; i++) {
        const float value = colours[i][channel];
        for (int c = 0; c < 3; c++) colours[i][c] = value;
    }
}

/* ---- The table --------------------------------------------------------------------------------------------------- */

static accuracy_row rows[MOST_ROWS];
static int row_count = -1;

/* The witness's numbers in the table's order. */
static void witness_fields(sample *s, float *fields[WITNESS_FLOATS])
{
    float *const vectors[] = { s->n, s->v, s->l, s->tangent, s->position };
    float *const numbers[] = { s->albedo, &s->sigma, &s->alpha, &s->alpha_y, &s->exponent, s->f0, s->eta, s->k,
                               s->irradiance };
    int count = 0;
    for (int i = 0; i < 5; i++)
        for (int c = 0; c < 3; c++) fields[count++] = &vectors[i][c];
    for (int i = 0; i < 9; i++) fields[count++] = numbers[i];
}

/* The next field of a line, which is cut there; "" past the last. */
static char *next_field(char **line)
{
    char *field = strsep(line, "\t\n");
    return field ? field : "";
}

/* Whether the field before was there, and the last. */
static bool is_end(const char *line)
{
    return line && !*line;
}

static bool read_bound(accuracy_row *row, char *line)
{
    for (int goal = 0; goal < GOALS; goal++) row->bound.limit[goal] = strtod(next_field(&line), NULL);
    row->bound.p999 = strtod(next_field(&line), NULL);
    return is_end(line);
}

static bool read_witness(accuracy_row *row, char *line)
{
    const char *word = next_field(&line);
    int goal = 0;
    while (goal < GOALS && strcmp(goal_words[goal], word)) goal++;
    if (goal == GOALS) return false;
    witness *w = &row->worst[goal];
    w->reached = strtod(next_field(&line), NULL);
    const int arch = facet_value(FACET_KIND_ARCH, next_field(&line));
    if (arch < 0) return false;
    w->arch = (facet_arch)arch;
    float *fields[WITNESS_FLOATS];
    witness_fields(&w->s, fields);
    for (int i = 0; i < WITNESS_FLOATS; i++) *fields[i] = strtof(next_field(&line), NULL);
    make_grey(&w->s, 0);
    const kernel_case *kernel = find_case(row->name);
    w->s.light = kernel && kernel->light.kind != FACET_LIGHT_DIRECTIONAL ? &kernel->light : NULL;
    w->got = strtof(next_field(&line), NULL);
    w->want = strtod(next_field(&line), NULL);
    return is_end(line);
}

static accuracy_row *find_row(const char *name, facet_tier tier)
{
    for (int i = 0; i < row_count; i++)
        if (!strcmp(rows[i].name, name) && rows[i].tier == tier) return &rows[i];
    return NULL;
}

static accuracy_row *add_row(const char *name, facet_tier tier)
{
    if (row_count == MOST_ROWS || strlen(name) >= sizeof rows[0].name) return NULL;
    accuracy_row *row = &rows[row_count++];
    const kernel_case *kernel = find_case(name);
    strcpy(row->name, name);
    row->tier = tier;
    if (kernel) row->bound.distribution = kernel->material.specular.model;
    return row;
}

static bool read_line(char *line)
{
    if (line[0] == '#') return true;
    const char *kind = next_field(&line), *name = next_field(&line);
    const int tier = facet_value(FACET_KIND_TIER, next_field(&line));
    if (tier < 0) return false;
    accuracy_row *row = find_row(name, (facet_tier)tier);
    if (!row) row = add_row(name, (facet_tier)tier);
    if (!row || !line) return false;
    return !strcmp(kind, "witness") ? read_witness(row, line) : !strcmp(kind, "bound") && read_bound(row, line);
}

static void read_table(void)
{
    char path[4096], line[2048];
    row_count = 0;
    snprintf(path, sizeof path, "%s/accuracy.tsv", test_data);
    FILE *file = fopen(path, "r");
    if (!file) {
        fprintf(stderr, "facet-check: %s: %s\n", path, strerror(errno));
        return;
    }
    for (int number = 1; fgets(line, sizeof line, file); number++) {
        if (read_line(line)) continue;
        fprintf(stderr, "facet-check: %s:%d: not a row of the table\n", path, number);
        row_count = 0;
        break;
    }
    fclose(file);
}

const accuracy_row *accuracy_at(int index)
{
    if (row_count < 0) read_table();
    return index >= 0 && index < row_count ? &rows[index] : NULL;
}

const accuracy_row *find_accuracy(const char *name, facet_tier tier)
{
    if (row_count < 0) read_table();
    return find_row(name, tier);
}

void keep_accuracy(const accuracy_row *row)
{
    if (row_count < 0) read_table();
    accuracy_row *place = find_row(row->name, row->tier);
    if (!place) place = add_row(row->name, row->tier);
    if (place) *place = *row;
}

void write_accuracy_head(FILE *file)
{
    fputs("# Error bounds of the kernels, and the worst inputs found: written by `facet-check --update accuracy`.\n"
          "# |got - want| <= 2^-24 magnitude (rel + grazing/nl + peak/alpha)\n"
          "#     for unit vectors, nl, nv >= 2^-22, alpha >= 1e-4, and under a light with a position vh >= 2^-6; of\n"
          "#     an anisotropic distribution the smaller alpha, and the smaller of nl and nv; of a lobe alpha is\n"
          "#     sqrt(2/(exponent + 2));\n"
          "# |got - want| <= plain magnitude for nl, nv > 5e-4, alpha >= 0.01;\n"
          "#     <= p99.9 magnitude for 99.9 % of samples, half uniform, half in the lobe, alpha >= 0.01.\n"
          "# magnitude (tests/reference.h): the radiance, but terms that cancel count as their absolute values: s0 of\n"
          "#     Fujii and EON, the terms of the full Oren-Nayar and of F82, 1 - F of `coupled` as 1, Rp as Rs, |w|\n"
          "#     under a light with a position as |v| + |l|; one of Schlick's factors 1 - vh counts as 1; e^-x counts\n"
          "#     1 + x times, at least 2^-100; and where a small step turns much, f(x) counts as f(x) +\n"
          "#     max |f(x +- s) - f(x)|/s, s = 2^-21: Rs and Rp of vh, Phong's lobe of its angle, a light's range of\n"
          "#     the distance, its cone of the cosine.\n"
          "# reached: the error over the bound. got: on arch; in the strict tier, on every architecture.\n"
          "# bound\tcase\ttier\trel\tgrazing\tpeak\tplain\tp99.9\n"
          "# witness\tcase\ttier\tgoal\treached\tarch\tnx\tny\tnz\tvx\tvy\tvz\tlx\tly\tlz\ttx\tty\ttz"
          "\tpx\tpy\tpz\talbedo\tsigma\talpha\talpha_y\texponent\tf0\teta\tk\tirradiance\tgot\twant\n", file);
}

void write_accuracy(FILE *file, const accuracy_row *row)
{
    const char *tier = facet_word(FACET_KIND_TIER, (int)row->tier);
    const double *limit = row->bound.limit;
    fprintf(file, "bound\t%s\t%s\t%g\t%g\t%g\t%g\t%g\n", row->name, tier, limit[GOAL_REL], limit[GOAL_GRAZING],
            limit[GOAL_PEAK], limit[GOAL_PLAIN], row->bound.p999);
    for (int goal = 0; goal < GOALS; goal++) {
        witness w = row->worst[goal];
        float *fields[WITNESS_FLOATS];
        if (w.reached <= 0) continue;
        witness_fields(&w.s, fields);
        fprintf(file, "witness\t%s\t%s\t%s\t%.3f\t%s", row->name, tier, goal_words[goal], w.reached,
                facet_word(FACET_KIND_ARCH, (int)w.arch));
        for (int i = 0; i < WITNESS_FLOATS; i++) fprintf(file, "\t%a", (double)*fields[i]);
        fprintf(file, "\t%a\t%a\n", (double)w.got, w.want);
    }
}
