#include "command_line.h"
#include "console.h"

#include <ctype.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* ---- Numbers and words ----------------------------------------------------------------------------------------- */

const char *parse_numbers(const char *text, int count, float *out)
{
    for (int i = 0; i < count; i++) {
        char *end;
        if (i && *text++ != ',')
            return NULL;
        out[i] = strtof(text, &end);
        if (end == text || isspace((unsigned char)*text) || !isfinite(out[i]))
            return NULL;
        text = end;
    }
    return text;
}

const char *parse_parts(const char *text, int count, float *out)
{
    const char *end = parse_numbers(text, 1, out);
    if (end && *end == ',')
        return parse_numbers(text, count, out);
    for (int i = 1; end && i < count; i++)
        out[i] = out[0];
    return end;
}

bool within(const float *values, int count, limits l)
{
    for (int i = 0; i < count; i++)
        if (!(values[i] >= l.least && values[i] <= l.most))
            return false;
    return true;
}

int parse_word(facet_kind kind, const char *text, size_t length)
{
    char word[64] = "";
    if (length >= sizeof word)
        return -1;
    memcpy(word, text, length);
    int value = facet_value(kind, word);
    return facet_has(kind, value) ? value : -1;
}

void list_word(char *list, size_t size, const char *word)
{
    size_t used = strlen(list);
    snprintf(list + used, size - used, "%s%s", used ? ", " : "", word);
}

void list_words(char *list, size_t size, facet_kind kind)
{
    *list = 0;
    for (int i = 0; facet_word(kind, i); i++)
        if (facet_has(kind, i))
            list_word(list, size, facet_word(kind, i));
}

/* ---- Readers --------------------------------------------------------------------------------------------------- */

static void *field(void *options, const setting *s)
{
    return (char *)options + s->offset;
}

bool setting_refuse(const setting *s, const char *text, const char *allowed)
{
    return console_error("%s '%.80s': allowed: %s", s->name, text, allowed);
}

static bool refuse_range(const setting *s, const char *text, const char *what)
{
    char allowed[120];
    snprintf(allowed, sizeof allowed, "%s from %.7g to %.7g", what, (double)s->limits.least, (double)s->limits.most);
    return setting_refuse(s, text, allowed);
}

bool read_number(void *options, const setting *s, const char *text)
{
    float value;
    const char *end = parse_numbers(text, 1, &value);
    if (!end || *end || !within(&value, 1, s->limits))
        return refuse_range(s, text, "a number");
    memcpy(field(options, s), &value, sizeof value);
    return true;
}

bool read_colour(void *options, const setting *s, const char *text)
{
    float value[3];
    const char *end = parse_parts(text, 3, value);
    if (!end || *end || !within(value, 3, s->limits))
        return refuse_range(s, text, "r,g,b or one number, each");
    memcpy(field(options, s), value, sizeof value);
    return true;
}

bool read_word(void *options, const setting *s, const char *text)
{
    int value = parse_word(s->kind, text, strlen(text));
    char allowed[512];
    list_words(allowed, sizeof allowed, s->kind);
    if (value < 0)
        return setting_refuse(s, text, allowed);
    memcpy(field(options, s), &value, sizeof value);
    return true;
}

bool read_text(void *options, const setting *s, const char *text)
{
    if (!*text)
        return setting_refuse(s, text, s->value);
    *(const char **)field(options, s) = text;
    return true;
}

bool read_switch(void *options, const setting *s, const char *text)
{
    (void)text;
    *(bool *)field(options, s) = true;
    return true;
}

/* ---- The command line ------------------------------------------------------------------------------------------ */

static const setting *find(const settings *groups, int group_count, const char *name, size_t length, void **options)
{
    for (int g = 0; g < group_count; g++)
        for (const setting *s = groups[g].table; s < groups[g].table + groups[g].count; s++)
            if (strlen(s->name) == length && !strncmp(s->name, name, length)) {
                *options = groups[g].options;
                return s;
            }
    return NULL;
}

/* Takes one option and its value, and moves *at behind them. */
static bool read_option(const settings *groups, int group_count, int count, char **arguments, int *at)
{
    const char *text = arguments[(*at)++];
    size_t length = !strncmp(text, "--", 2) ? strcspn(text, "=") : strlen(text);
    void *options = NULL;
    const setting *s = find(groups, group_count, text, length, &options);
    if (!s)
        return console_error("%.80s: no such option; --help lists them", text);
    if (!s->value)
        return text[length] ? console_error("%s takes no value", s->name) : s->read(options, s, NULL);
    const char *value = text[length] ? text + length + 1 : *at < count ? arguments[(*at)++] : NULL;
    return value ? s->read(options, s, value) : console_error("%s needs a value: %s", s->name, s->value);
}

bool command_line_read(const settings *groups, int group_count, int count, char **arguments,
                       bool (*operand)(void *context, const char *text), void *context)
{
    for (int at = 1; at < count;) {
        bool option = arguments[at][0] == '-' && arguments[at][1];
        if (!(option ? read_option(groups, group_count, count, arguments, &at) : operand(context, arguments[at++])))
            return false;
    }
    return true;
}

/* The help begins beside the option, or below where that is too long. */
static void print_help(const setting *s)
{
    enum { WIDTH = 24 };
    int used = printf("  %s%s%s", s->name, s->value ? " " : "", s->value ? s->value : "") - 2;
    printf("%s%*s ", used > WIDTH ? "\n  " : "", used > WIDTH ? WIDTH : WIDTH - used, "");
    for (const char *help = s->help; *help; help++) {
        putchar(*help);
        if (*help == '\n')
            printf("  %*s ", WIDTH, "");
    }
    printf("\n");
}

void command_line_help(const settings *groups, int group_count)
{
    for (int g = 0; g < group_count; g++) {
        printf("%s%s\n", g ? "\n" : "", groups[g].title);
        for (const setting *s = groups[g].table; s < groups[g].table + groups[g].count; s++)
            print_help(s);
    }
}
