/* Tables of measured optical constants: tests/data/metals. */
#include "spectra.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static bool read_row(char *line, spectrum *s)
{
    double row[3];
    for (int i = 0; i < 3; i++) {
        char *end;
        row[i] = strtod(line, &end);
        if (end == line || *end != (i < 2 ? ',' : '\n')) return false;
        line = end + 1;
    }
    if (s->count == MOST_ROWS_OF_SPECTRUM) return false;
    s->wavelength[s->count] = (float)(row[0] * 1000);
    s->n[s->count] = (float)row[1];
    s->k[s->count++] = (float)row[2];
    return true;
}

bool read_spectrum(const char *path, spectrum *s)
{
    char line[1024];
    bool good = true;
    *s = (spectrum){ .count = 0 };
    FILE *file = fopen(path, "r");
    if (!file) return false;
    while (good && fgets(line, sizeof line, file)) {
        if (!strncmp(line, "# | ", 4)) snprintf(s->source, sizeof s->source, "%s", line + 4);
        else if (line[0] != '#' && strcmp(line, "wavelength_um,n,k\n")) good = read_row(line, s);
    }
    good = good && !ferror(file);
    fclose(file);
    return good;
}
