/* Measured optical constants from a file: lines "wavelength_um,n,k", and what is read of them. */
#ifndef SPECTRA_H
#define SPECTRA_H

#include <stdbool.h>
#include <stddef.h>

enum { MOST_ROWS_OF_SPECTRUM = 128 };

typedef struct {
    size_t count;
    float wavelength[MOST_ROWS_OF_SPECTRUM], n[MOST_ROWS_OF_SPECTRUM], k[MOST_ROWS_OF_SPECTRUM];   /* in nm */
    char source[1024];           /* the second line, without "# | " */
} spectrum;

/* False where the file is not there, or has a line that is neither a comment, the head nor three numbers. */
bool read_spectrum(const char *path, spectrum *s);

#endif
