/* Tab-separated files, a line at a time. */
#ifndef TSV_H
#define TSV_H

#include <stdbool.h>
#include <stddef.h>

enum { TSV_FIELDS = 24, TSV_LONGEST = 200 };

typedef struct tsv {
    const char *path;
    char *text, *next;           /* the file; what is not read yet */
    int line;                    /* of the fields */
    int count;
    char *fields[TSV_FIELDS];    /* strings in `text`, which stays */
} tsv;

/* Reads a file into memory, or says what is wrong. */
bool tsv_open(tsv *t, const char *path);

/* The fields of the next line that is not empty; 0 at the end, -1 where something is wrong, which was said. */
int tsv_next(tsv *t);

/* Says "PATH:LINE: ...". Returns false. */
bool tsv_refuse(const tsv *t, const char *format, ...) __attribute__((format(printf, 2, 3)));

/* A field as a number within [least, most]; "-" is NaN, and "nan" counts as infinite. Or says what is wrong. */
bool tsv_number(const tsv *t, int field, const char *name, double least, double most, double *out);

/* Memory that grows by one element at a time: room for element `count`. Ends the program where there is none. */
void *grow(void *elements, int count, size_t size);

#endif
