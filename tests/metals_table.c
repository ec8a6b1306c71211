/* metals-table DIR: prints src/metals.def with its numbers made anew from DIR/NAME.csv. A new metal is an enumerator, a
 * row of zeros, and its file. */
#include "spectra.h"

#include "facet.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const struct { const char *id, *name, *word, *source; } rows[] = {
#define FACET_METAL(id, name, word, eta_r, eta_g, eta_b, k_r, k_g, k_b, source) { #id, #name, word, source },
#include "../src/metals.def"
};

static const char head[] =
    "/* Metals, a row each: FACET_METAL(ID, name, word, eta_r, eta_g, eta_b, k_r, k_g, k_b, source): index and\n"
    " * extinction for red, green and blue. `make metals` writes this file: its numbers are facet_index_of_spectrum\n"
    " * of the tables that were measured, tests/data/metals/NAME.csv. */\n";

/* The shortest decimal that is this float. */
static void put(float x, const char *after)
{
    char text[32];
    for (int digits = 1; digits <= 9; digits++) {
        snprintf(text, sizeof text, "%.*g", digits, (double)x);
        if (strtof(text, NULL) == x) break;
    }
    printf("%s%sf,%s", text, strpbrk(text, ".e") ? "" : ".0", after);
}

int main(int count, char **words)
{
    fputs(head, stdout);
    for (size_t i = 0; i < sizeof rows / sizeof rows[0]; i++) {
        spectrum s;
        char path[4096];
        float eta[3], k[3];
        facet_error error = { .field = "no table" };
        snprintf(path, sizeof path, "%s/%s.csv", count > 1 ? words[1] : ".", rows[i].name);
        if (!read_spectrum(path, &s) || facet_index_of_spectrum(s.wavelength, s.n, s.k, s.count, eta, k, &error)) {
            fprintf(stderr, "metals-table: %s: %s, row %d\n", path, error.field, error.index);
            return 1;
        }
        printf("FACET_METAL(%s, %s, \"%s\", ", rows[i].id, rows[i].name, rows[i].word);
        for (int c = 0; c < 3; c++) put(eta[c], c < 2 ? " " : "\n            ");
        for (int c = 0; c < 3; c++) put(k[c], " ");
        printf("\"%s\")\n", rows[i].source);
    }
    puts("#undef FACET_METAL");
    return ferror(stdout) != 0;
}
