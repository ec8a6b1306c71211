/* readme-tables README [ARCH=FLAGS ...]: prints README with its tables made anew from models.def, streams.def and
 * arches.def. A table stands between the lines <!-- NAME --> and <!-- /NAME -->. FLAGS: the architecture's, of the
 * compiler. */
#include <ctype.h>
#include <stdbool.h>
#include <stdio.h>
#include <string.h>

static char **flags;
static int flag_count;

/* The next item of a cell, in small letters, after the `items` that are there. */
static void put_item(const char *item, size_t length, int *items)
{
    printf("%s`", (*items)++ ? ", " : "");
    for (size_t i = 0; i < length; i++) putchar(tolower(item[i]));
    putchar('`');
}

/* "FACET_STREAM_ALPHA | FACET_STREAM_ALPHA_Y" as alpha, alpha_y; "0" as nothing. */
static void put_streams(const char *reads, int *items)
{
    static const char prefix[] = "FACET_STREAM_";
    for (const char *at = reads; (at = strstr(at, prefix));) {
        at += strlen(prefix);
        put_item(at, strcspn(at, " |"), items);
    }
}

/* The numbers beside streams that a property of models.def stands for. */
static const struct { const char *property, *numbers[2]; } takes[] = {
    { "F90", { "f90" } }, { "F82", { "f82" } }, { "MEDIA", { "eta_outside", "polarisation" } },
};

static bool has_word(const char *words, const char *word)
{
    const size_t length = strlen(word);
    for (; *words; words += strcspn(words, " |"), words += strspn(words, " |"))
        if (strcspn(words, " |") == length && !strncmp(words, word, length)) return true;
    return false;
}

static void model(const char *word, const char *enumerator, const char *kind, const char *title, const char *reads,
                  const char *properties)
{
    int items = 0;
    printf("| `%s` | `%s` | %s | %s | ", word, enumerator, kind, title);
    put_streams(reads, &items);
    for (size_t i = 0; i < sizeof takes / sizeof takes[0]; i++)
        for (int k = 0; k < 2 && takes[i].numbers[k] && has_word(properties, takes[i].property); k++)
            put_item(takes[i].numbers[k], strlen(takes[i].numbers[k]), &items);
    printf(" |\n");
}

static void models(void)
{
    printf("| word | enumerator | kind | model | parameters |\n|---|---|---|---|---|\n");
#define FACET_DIFFUSE(id, name, word, reads, properties, sigma_max, title)                                            \
    model(word, "FACET_DIFFUSE_" #id, "diffuse", title, #reads, #properties);
#define FACET_DISTRIBUTION(id, name, word, reads, properties, title)                                                  \
    model(word, "FACET_DISTRIBUTION_" #id, "distribution", title, #reads, #properties);
#define FACET_MASKING(id, name, word, title) model(word, "FACET_MASKING_" #id, "masking", title, "0", "0");
#define FACET_FRESNEL(id, name, word, reads, properties, title)                                                       \
    model(word, "FACET_FRESNEL_" #id, "Fresnel", title, #reads, #properties);
#include "../src/models.def"
}

static void streams(void)
{
    printf("| stream | components | meaning |\n|---|---|---|\n");
#define FACET_STREAM(id, field, components, owner, low, high, title)                                                  \
    printf("| `%s` | %d | %s |\n", #field, components, title);
#include "../src/streams.def"
}

/* Features of a CPU as their makers write them, where that is not the bit's name. */
static const struct { const char *bit, *words; } features[] = {
    { "CPU_SSE41", "SSE4.1" }, { "CPU_FMA_F16C", "FMA, F16C" }, { "CPU_AVX512", "AVX-512 F, VL, DQ, BW" },
};

static void put_feature(const char *bit, size_t length)
{
    for (size_t i = 0; i < sizeof features / sizeof features[0]; i++)
        if (strlen(features[i].bit) == length && !strncmp(features[i].bit, bit, length)) {
            printf("%s", features[i].words);
            return;
        }
    printf("%.*s", (int)length - 4, bit + 4);
}

/* "CPU_AVX2 | CPU_FMA_F16C" as "AVX2, FMA, F16C"; "0" as "any". */
static void put_needs(const char *needs)
{
    if (!strcmp(needs, "0")) printf("any");
    for (const char *at = needs; (at = strstr(at, "CPU_")); at += strcspn(at, " |")) {
        if (at > needs) printf(", ");
        put_feature(at, strcspn(at, " |"));
    }
}

static void architecture(const char *name, const char *word, const char *needs, int lanes)
{
    const size_t length = strlen(name);
    printf("| `%s` | %d | ", word, lanes);
    for (int i = 0; i < flag_count; i++)
        if (!strncmp(flags[i], name, length) && flags[i][length] == '=' && flags[i][length + 1])
            printf("`%s`", flags[i] + length + 1);
    printf(" | ");
    put_needs(needs);
    printf(" |\n");
}

static void architectures(void)
{
    printf("| arch | lanes | compiler flags | CPU needed |\n|---|---|---|---|\n");
#define FACET_ARCH(id, name, word, needs, lanes) architecture(#name, word, #needs, lanes);
#include "../src/arches.def"
}

static const struct { const char *begin, *end; void (*print)(void); } tables[] = {
    { "<!-- models -->\n", "<!-- /models -->\n", models },
    { "<!-- streams -->\n", "<!-- /streams -->\n", streams },
    { "<!-- architectures -->\n", "<!-- /architectures -->\n", architectures },
};
enum { TABLES = sizeof tables / sizeof tables[0] };

/* Copies the file with new tables. False where a table's lines are not there, each once. */
static bool rewrite(FILE *file)
{
    char line[4096];
    int inside = -1, found[TABLES] = { 0 };
    while (fgets(line, sizeof line, file)) {
        if (inside >= 0 && !strcmp(line, tables[inside].end)) inside = -1;
        if (inside < 0) fputs(line, stdout);
        for (int i = 0; i < TABLES; i++) {
            if (strcmp(line, tables[i].begin)) continue;
            if (inside >= 0 || found[i]++) return false;
            inside = i;
            tables[i].print();
        }
    }
    for (int i = 0; i < TABLES; i++)
        if (!found[i]) return false;
    return inside < 0 && !ferror(file);
}

int main(int count, char **words)
{
    FILE *file = count > 1 ? fopen(words[1], "r") : NULL;
    if (!file) {
        fprintf(stderr, "readme-tables: cannot read %s\n", count > 1 ? words[1] : "README");
        return 2;
    }
    flags = words + 2;
    flag_count = count - 2;
    if (!rewrite(file)) {
        fprintf(stderr, "readme-tables: %s lacks a table's lines <!-- NAME -->, <!-- /NAME -->\n", words[1]);
        return 1;
    }
    return 0;
}
