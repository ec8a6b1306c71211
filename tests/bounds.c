/* The table of error bounds: reading, writing, and what it promises. */
#include "bounds.h"

#include "harness.h"

#include <errno.h>
#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

const char *const goal_words[GOALS] = { "rel", "grazing", "peak", "plain" };

enum { WITNESS_FLOATS = 14, MOST_ROWS = 512 };

/* ---- The promise ------------------------------------------------------------------------------------------------- */

static bool is_unit(const float *a)
{
    const double length2 = (double)a[0] * a[0] + (double)a[1] * a[1] + (double)a[2] * a[2];
    return fabs(length2 - 1) <= 0x1p-21;
}

bool in_domain(const sample *s, cosines c)
{
    return c.nl >= 0x1p-22 && c.nv >= 0x1p-22 && is_unit(s->n) && is_unit(s->v) && is_unit(s->l);
}

bool in_plain_domain(const sample *s, cosines c)
{
    return in_domain(s, c) && c.nl > 5e-4 && c.nv > 5e-4 && s->alpha >= 0.01f;
}

double bound_at(const error_bound *b, const sample *s, cosines c, int *goal)
{
    const double alpha = fmin(fmax(s->alpha, FACET_ALPHA_FLOOR), 1);
    const double terms[] = { b->limit[GOAL_REL], b->limit[GOAL_GRAZING] / c.nl, b->limit[GOAL_PEAK] / alpha };
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

/* ---- The table --------------------------------------------------------------------------------------------------- */

static accuracy_row rows[MOST_ROWS];
static int row_count = -1;

/* The witness's numbers in the table's order. */
static void witness_fields(sample *s, float *fields[WITNESS_FLOATS])
{
    int count = 0;
    for (int c = 0; c < 3; c++) {
        fields[c] = &s->n[c];
        fields[3 + c] = &s->v[c];
        fields[6 + c] = &s->l[c];
        count += 3;
    }
    fields[count++] = s->albedo;
    fields[count++] = &s->sigma;
    fields[count++] = &s->alpha;
    fields[count++] = s->f0;
    fields[count++] = s->irradiance;
}

/* The next field of a line, which is cut there; "" past the last. */
static char *next_field(char **line)
{
    char *field = strsep(line, "\t\n");
    return field ? field : "";
}

static void read_bound(accuracy_row *row, char *line)
{
    for (int goal = 0; goal < GOALS; goal++) row->bound.limit[goal] = strtod(next_field(&line), NULL);
    row->bound.p999 = strtod(next_field(&line), NULL);
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
    for (int c = 1; c < 3; c++) {
        w->s.albedo[c] = w->s.albedo[0];
        w->s.f0[c] = w->s.f0[0];
        w->s.irradiance[c] = w->s.irradiance[0];
    }
    w->got = strtof(next_field(&line), NULL);
    w->want = strtod(next_field(&line), NULL);
    return true;
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
    strcpy(row->name, name);
    row->tier = tier;
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
    if (!strcmp(kind, "witness")) return read_witness(row, line);
    read_bound(row, line);
    return !strcmp(kind, "bound");
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

void write_accuracy_head(FILE *file)
{
    fputs("# Error bounds of the kernels, and the worst inputs found: written by `facet-check --update accuracy`.\n"
          "# |got - want| <= 2^-24 magnitude (rel + grazing/nl + peak/alpha)\n"
          "#     for unit vectors, nl, nv >= 2^-22, alpha >= 1e-4;\n"
          "# |got - want| <= plain magnitude for nl, nv > 5e-4, alpha >= 0.01;\n"
          "#     <= p99.9 magnitude for 99.9 % of samples, half uniform, half in the lobe, alpha >= 0.01.\n"
          "# magnitude: the radiance, but for terms that cancel: 1 - F of `coupled` counts as 1, Fujii's s0 as |s0|,\n"
          "#     Schlick's (1 - vh)^5 as (1 - vh)^4.\n"
          "# reached: the error over the bound. got: on arch; in the strict tier, on every architecture.\n"
          "# bound\tcase\ttier\trel\tgrazing\tpeak\tplain\tp99.9\n"
          "# witness\tcase\ttier\tgoal\treached\tarch\tnx\tny\tnz\tvx\tvy\tvz\tlx\tly\tlz\talbedo\tsigma\talpha\tf0"
          "\tirradiance\tgot\twant\n", file);
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
