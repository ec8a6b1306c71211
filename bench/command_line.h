/* Command lines as tables of options, for facet-demo and tests/relight: --NAME VALUE, --NAME=VALUE, or a switch. */
#ifndef COMMAND_LINE_H
#define COMMAND_LINE_H

#include "facet.h"

/* Of a number, or of each part of a colour. */
typedef struct limits {
    float least, most;
} limits;

/* An option. `read` stores what `text` says (NULL: a switch), or says what is wrong. */
typedef struct setting {
    const char *name, *value, *help;      /* no value: a switch. Help is a line or more */
    bool (*read)(void *options, const struct setting *s, const char *text);
    size_t offset;                        /* in `options`, of what read_number and those after it set */
    limits limits;
    facet_kind kind;                      /* of a word */
} setting;

/* Options that set the fields of one struct. */
typedef struct settings {
    const char *title;                    /* in the help */
    const setting *table;
    int count;
    void *options;
} settings;

/* Reads a command line into the structs of `groups`; what is no option goes to `operand`. Says what is wrong. */
bool command_line_read(const settings *groups, int group_count, int count, char **arguments,
                       bool (*operand)(void *context, const char *text), void *context);

/* Prints the options, group by group. */
void command_line_help(const settings *groups, int group_count);

/* Says that `text` is not a value of the option, and what is. Returns false. */
bool setting_refuse(const setting *s, const char *text, const char *allowed);

/* Readers for tables: a float; three floats, r,g,b or one number; a word of `kind` that this build and this CPU have;
 * a file's name; a bool. */
bool read_number(void *options, const setting *s, const char *text);
bool read_colour(void *options, const setting *s, const char *text);
bool read_word(void *options, const setting *s, const char *text);
bool read_text(void *options, const setting *s, const char *text);
bool read_switch(void *options, const setting *s, const char *text);

/* `count` finite numbers with commas between them. Returns what follows them, or NULL. */
const char *parse_numbers(const char *text, int count, float *out);

/* The same, or one number for all. */
const char *parse_parts(const char *text, int count, float *out);

bool within(const float *values, int count, limits l);

/* The enumerator of the first `length` characters where this build and this CPU have it, or -1. */
int parse_word(facet_kind kind, const char *text, size_t length);

/* Appends a word to a list with commas, as far as it has room. */
void list_word(char *list, size_t size, const char *word);

/* The words of a kind that this build and this CPU have, as such a list. */
void list_words(char *list, size_t size, facet_kind kind);

#endif
