/* readme-tables README [ARCH=FLAGS ...]: prints README with its tables made anew from models.def, streams.def and
 * arches.def. A table stands between the lines <!-- NAME --> and <!-- /NAME -->. FLAGS: the architecture's, of the
 * compiler. */
#include <stdbool.h>
#include <stdio.h>
#include <string.h>

static char **flags;
static int flag_count;

static void model(const char *word, const char *enumerator, const char *kind, const char *title, const char *parameters)
{
    printf("| `%s` | `%s` | %s | %s | %s |\n", word, enumerator, kind, title, parameters);
}

static const char *diffuse_parameters(const char *word, const char *sigma_max)
{
    if (!strcmp(word, "none")) return "";
    return strcmp(sigma_max, "0.0f") ? "`albedo`, `sigma`" : "`albedo`";
}

static const char *fresnel_parameters(const char *properties)
{
    if (!strstr(properties, "F0")) return "";
    return strstr(properties, "F90") ? "`f0` or `eta` and `k`, `f90`" : "`f0` or `eta` and `k`";
}

static void models(void)
{
    printf("| word | enumerator | kind | model | parameters |\n|---|---|---|---|---|\n");
#define FACET_DIFFUSE(id, name, word, sigma_max, properties, title)                                                   \
    model(word, "FACET_DIFFUSE_" #id, "diffuse", title, diffuse_parameters(word, #sigma_max));
#define FACET_DISTRIBUTION(id, name, word, properties, title)                                                         \
    model(word, "FACET_DISTRIBUTION_" #id, "distribution", title, strcmp(word, "none") ? "`alpha`" : "");
#define FACET_MASKING(id, name, word, title) model(word, "FACET_MASKING_" #id, "masking", title, "");
#define FACET_FRESNEL(id, name, word, properties, title)                                                              \
    model(word, "FACET_FRESNEL_" #id, "Fresnel", title, fresnel_parameters(#properties));
#include "../src/models.def"
}

static void streams(void)
{
    printf("| stream | components | meaning |\n|---|---|---|\n");
#define FACET_STREAM(id, field, components, owner, low, high, title)                                                  \
    printf("| `%s` | %d | %s |\n", #field, components, title);
#include "../src/streams.def"
}

/* "CPU_AVX2 | CPU_FMA" as "AVX2, FMA"; "0" as "any". */
static void put_needs(const char *needs)
{
    if (!strcmp(needs, "0")) printf("any");
    while (*needs && strcmp(needs, "0")) {
        if (!strncmp(needs, "CPU_", 4)) needs += 4;
        else if (!strncmp(needs, " | ", 3)) needs += 3, printf(", ");
        else putchar(*needs++);
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
