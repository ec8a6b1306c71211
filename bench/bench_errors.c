#include "bench_errors.h"
#include "console.h"

#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { MOST_ROWS = 1024, MOST_FIELDS = 40, PATH = 4096 };

/* `searched`: a kernel of tests/accuracy.tsv, of its worst architecture, whose worst is its bound times what the
 * witness reached. */
typedef struct {
    char name[64], who[16], arch[16];
    bool searched;
    double bound;
    found_error found;
} row;

static row rows[MOST_ROWS];
static int row_count;

static row *find_row(const char *name, const char *who, const char *arch, bool searched)
{
    for (int i = 0; i < row_count; i++)
        if (!strcmp(rows[i].name, name) && !strcmp(rows[i].who, who) && !strcmp(rows[i].arch, arch)
            && rows[i].searched == searched)
            return &rows[i];
    return NULL;
}

static row *make_row(const char *name, const char *who, const char *arch, bool searched)
{
    row *r = find_row(name, who, arch, searched);
    if (r) return r;
    if (row_count == MOST_ROWS || strlen(name) >= sizeof r->name || strlen(who) >= sizeof r->who
        || strlen(arch) >= sizeof r->arch)
        return NULL;
    r = &rows[row_count++];
    *r = (row){ .searched = searched, .found = { NAN, NAN } };
    strcpy(r->name, name);
    strcpy(r->who, who);
    strcpy(r->arch, arch);
    return r;
}

static bool read_number_of(const char *text, double *value)
{
    char *end;
    *value = strtod(text, &end);
    return end != text && !*end && *value >= 0;
}

/* tests/accuracy.tsv has `bound` and `witness` (tests/bounds.c writes them), tests/baselines.c writes the others. */
static bool read_fields(char **field, int count)
{
    if (count < 5) return false;
    const bool bound = !strcmp(field[0], "bound"), witness = !strcmp(field[0], "witness");
    const bool kernel = !strcmp(field[0], "kernel"), measured = kernel || !strcmp(field[0], "baseline");
    row *r = make_row(field[1], field[2], kernel ? field[3] : "", !measured);
    if (!r) return false;
    if (bound) return count == 8 && read_number_of(field[6], &r->bound) && read_number_of(field[7], &r->found.p999);
    if (measured)
        return count == 5 + kernel && read_number_of(field[3 + kernel], &r->found.worst)
               && read_number_of(field[4 + kernel], &r->found.p999);
    if (!witness || strcmp(field[3], "plain")) return witness;
    double reached;
    if (!read_number_of(field[4], &reached)) return false;
    r->found.worst = reached * r->bound;
    return true;
}

static bool read_line(char *line)
{
    char *field[MOST_FIELDS];
    int count = 0;
    line[strcspn(line, "\n")] = 0;
    if (line[0] == '#') return true;
    for (char *at = line; at && count < MOST_FIELDS;) field[count++] = strsep(&at, "\t");
    return read_fields(field, count);
}

static bool read_table(const char *path)
{
    char line[4096];
    FILE *file = fopen(path, "r");
    if (!file) {
        console_error("%s: %s: its errors are not known", path, strerror(errno));
        return true;
    }
    bool good = true;
    for (int number = 1; good && fgets(line, sizeof line, file); number++)
        good = read_line(line) || console_error("%s:%d: not a row of a table of errors", path, number);
    fclose(file);
    return good;
}

bool errors_read(const char *files)
{
    char path[PATH];
    for (const char *at = files; *at; at += strcspn(at, ","), at += *at == ',') {
        snprintf(path, sizeof path, "%.*s", (int)strcspn(at, ","), at);
        if (*path && !read_table(path)) return false;
    }
    return true;
}

found_error errors_of(const work *w, const char *who, const char *arch)
{
    const char *name = w->shade == SHADE_TILE ? "tile" : w->format != FLOATS ? "packed" : w->name;
    const row *measured = find_row(name, who, arch, false);
    const row *searched = w->kernel ? find_row(w->kernel, who, "", true) : NULL;
    return measured ? measured->found : searched ? searched->found : (found_error){ NAN, NAN };
}
