/* OBJ files: v, vn and f with v, v/vt, v//vn or v/vt/vn corners, indices from 1 or back from -1. Faces of any size
 * become fans. A triangle of which a corner has no normal is taken to have none. vt lines are only counted; other
 * statements are ignored. Memory is bounded by the line buffer and MESH_LIMIT. */
#include "console.h"
#include "mesh.h"

#include <ctype.h>
#include <errno.h>
#include <float.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define LINE_LIMIT ((size_t)64 << 10)
#define FILE_LIMIT ((uint64_t)4 << 30)

typedef struct reader {
    FILE *file;
    const char *path;
    size_t line;
    uint64_t bytes;
    size_t texture_count;
    char text[LINE_LIMIT + 1];
} reader;

__attribute__((format(printf, 2, 3))) static bool refuse(const reader *r, const char *format, ...)
{
    char why[256];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(why, sizeof why, format, arguments);
    va_end(arguments);
    return console_error("%s:%zu: %s", r->path, r->line, why);
}

/* ---- Lines ----------------------------------------------------------------------------------------------------- */

/* Appends one byte to the line. */
static bool take(reader *r, size_t *length, int c)
{
    if (++r->bytes > FILE_LIMIT)
        return refuse(r, "the file is longer than %d GiB", (int)(FILE_LIMIT >> 30));
    if (c == 127 || (c < ' ' && !isspace(c)))
        return refuse(r, "byte 0x%02x: this is not a text file", (unsigned)c);
    if (*length == LINE_LIMIT)
        return refuse(r, "the line is longer than %d bytes", (int)LINE_LIMIT);
    if (c != '\r')
        r->text[(*length)++] = (char)c;
    return true;
}

/* A backslash at the end joins the next line. */
static bool continues(reader *r, size_t length)
{
    if (!length || r->text[length - 1] != '\\')
        return false;
    r->text[length - 1] = ' ';
    r->line++;
    return true;
}

/* Reads a line without its end or comment into `text`. False, with *end set, where there is none. */
static bool next_line(reader *r, bool *end)
{
    size_t length = 0;
    int c;
    r->line++;
    while ((c = getc(r->file)) != EOF && (c != '\n' || continues(r, length)))
        if (c != '\n' && !take(r, &length, c))
            return false;
    if (ferror(r->file))
        return refuse(r, "%s", strerror(errno));
    r->text[length] = 0;
    r->text[strcspn(r->text, "#")] = 0;
    *end = c == EOF && !length;
    return !*end;
}

static const char *skip_space(const char *at)
{
    while (isspace((unsigned char)*at))
        at++;
    return at;
}

/* ---- Statements ------------------------------------------------------------------------------------------------ */

static bool read_vector(const reader *r, const char *at, double out[3])
{
    for (int i = 0; i < 3; i++) {
        char *end;
        out[i] = strtod(at, &end);
        if (end == at || (*end && !isspace((unsigned char)*end)))
            return refuse(r, "three numbers should stand here");
        if (!(fabs(out[i]) <= (double)FLT_MAX))
            return refuse(r, "a coordinate is not a finite number");
        at = end;
    }
    return true;
}

static bool read_position(const reader *r, mesh *m, const char *at)
{
    double position[3];
    if (!read_vector(r, at, position))
        return false;
    if (m->position_count == MESH_LIMIT)
        return refuse(r, "more than %zu vertices", MESH_LIMIT);
    return mesh_add_position(m, position) || refuse(r, "not enough memory");
}

static bool read_normal(const reader *r, mesh *m, const char *at)
{
    double normal[3];
    if (!read_vector(r, at, normal))
        return false;
    if (m->normal_count == MESH_LIMIT)
        return refuse(r, "more than %zu normals", MESH_LIMIT);
    return mesh_add_normal(m, normal) || refuse(r, "not enough memory");
}

static const char corner_forms[] = "a face's corner should be v, v/vt, v//vn or v/vt/vn";

static bool read_index(const reader *r, const char **at, const char *what, size_t count, uint32_t *index)
{
    char *end;
    long number = strtol(*at, &end, 10);
    if (end == *at || isspace((unsigned char)**at))
        return refuse(r, "%s", corner_forms);
    *at = end;
    long long from_zero = number < 0 ? (long long)count + number : (long long)number - 1;
    if (number == 0 || from_zero < 0 || from_zero >= (long long)count)
        return refuse(r, "%s %ld is not one of the %zu so far", what, number, count);
    *index = (uint32_t)from_zero;
    return true;
}

static bool read_corner(const reader *r, const mesh *m, const char **at, uint32_t *position, uint32_t *normal)
{
    uint32_t texture;
    *normal = MESH_NO_NORMAL;
    if (!read_index(r, at, "vertex", m->position_count, position))
        return false;
    if (**at == '/' && *++*at != '/' && !read_index(r, at, "texture coordinate", r->texture_count, &texture))
        return false;
    if (**at == '/' && (++*at, !read_index(r, at, "normal", m->normal_count, normal)))
        return false;
    return !**at || isspace((unsigned char)**at) || refuse(r, "%s", corner_forms);
}

static bool read_face(const reader *r, mesh *m, const char *at)
{
    mesh_triangle t = {0};
    size_t corners = 0;
    for (at = skip_space(at); *at; at = skip_space(at)) {
        if (corners >= 3) {
            t.position[1] = t.position[2];
            t.normal[1] = t.normal[2];
        }
        size_t slot = corners < 3 ? corners : 2;
        if (!read_corner(r, m, &at, &t.position[slot], &t.normal[slot]))
            return false;
        if (++corners < 3)
            continue;
        if (m->triangle_count == MESH_LIMIT)
            return refuse(r, "more than %zu triangles", MESH_LIMIT);
        if (!mesh_add_triangle(m, &t))
            return refuse(r, "not enough memory");
    }
    return corners >= 3 || refuse(r, "a face needs three corners");
}

static bool read_statement(reader *r, mesh *m)
{
    const char *word = skip_space(r->text), *rest = word + strcspn(word, " \t\v\f");
    size_t length = (size_t)(rest - word);
    if (length == 1 && *word == 'v')
        return read_position(r, m, rest);
    if (length == 1 && *word == 'f')
        return read_face(r, m, rest);
    if (length == 2 && word[0] == 'v' && word[1] == 'n')
        return read_normal(r, m, rest);
    if (length == 2 && word[0] == 'v' && word[1] == 't')
        r->texture_count++;
    return true;
}

static bool read_file(reader *r, mesh *m)
{
    bool end = false;
    while (next_line(r, &end))
        if (!read_statement(r, m))
            return false;
    return end && (m->triangle_count || refuse(r, "the file ends without a face"));
}

bool obj_read(mesh *m, const char *path)
{
    reader *r = calloc(1, sizeof *r);
    if (!r)
        return console_error("%s: not enough memory", path);
    r->path = path;
    r->file = fopen(path, "rb");
    bool read = r->file ? read_file(r, m) : console_error("%s: %s", path, strerror(errno));
    if (r->file)
        fclose(r->file);
    free(r);
    return read;
}
