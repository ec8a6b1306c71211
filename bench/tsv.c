#include "tsv.h"
#include "console.h"

#include <errno.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { LARGEST = 1 << 26 };

void *grow(void *elements, int count, size_t size)
{
    /* Doubles at every power of two. */
    if (count & (count - 1))
        return elements;
    void *larger = realloc(elements, (count ? (size_t)count * 2 : 1) * size);
    if (!larger) {
        console_error("out of memory");
        exit(1);
    }
    return larger;
}

bool tsv_open(tsv *t, const char *path)
{
    *t = (tsv){ .path = path };
    FILE *file = fopen(path, "rb");
    if (!file)
        return console_error("%s: %s", path, strerror(errno));
    size_t size = 0, room = 0, got = 1;
    while (got && size < LARGEST) {
        if (room - size < 2) {
            room = room ? 2 * room : 1 << 16;
            t->text = realloc(t->text, room);
            if (!t->text) {
                fclose(file);
                return console_error("%s: out of memory", path);
            }
        }
        got = fread(t->text + size, 1, room - size - 1, file);
        size += got;
    }
    const int failed = ferror(file) ? errno : 0;
    fclose(file);
    if (failed)
        return console_error("%s: %s", path, strerror(failed));
    if (size >= LARGEST)
        return console_error("%s: more than %d MB", path, LARGEST >> 20);
    t->text[size] = 0;
    t->next = t->text;
    if (strlen(t->text) != size)
        return console_error("%s: a zero byte: not a text file", path);
    return true;
}

bool tsv_refuse(const tsv *t, const char *format, ...)
{
    char what[512];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(what, sizeof what, format, arguments);
    va_end(arguments);
    return console_error("%s:%d: %s", t->path, t->line, what);
}

/* Ends the line and returns where the next one starts. */
static char *end_line(char *line)
{
    char *end = line + strcspn(line, "\n"), *next = *end ? end + 1 : end;
    if (end > line && end[-1] == '\r')
        end--;
    *end = 0;
    return next;
}

int tsv_next(tsv *t)
{
    char *at;
    do {
        if (!*t->next)
            return 0;
        at = t->next;
        t->next = end_line(at);
        t->line++;
    } while (!*at);
    for (t->count = 0; at; t->count++) {
        if (t->count == TSV_FIELDS)
            return tsv_refuse(t, "more than %d fields", TSV_FIELDS), -1;
        t->fields[t->count] = strsep(&at, "\t");
        if (strlen(t->fields[t->count]) > TSV_LONGEST)
            return tsv_refuse(t, "field %d is longer than %d bytes", t->count + 1, TSV_LONGEST), -1;
    }
    return t->count;
}

bool tsv_number(const tsv *t, int field, const char *name, double least, double most, double *out)
{
    const char *text = t->fields[field];
    char *end;
    if (!strcmp(text, "-")) {
        *out = NAN;
        return true;
    }
    double value = strtod(text, &end);
    if (isnan(value))
        value = INFINITY;
    if (end == text || *end || !(value >= least && value <= most))
        return tsv_refuse(t, "%s is '%.40s', which is neither - nor a number from %g to %g", name, text, least, most);
    *out = value;
    return true;
}
