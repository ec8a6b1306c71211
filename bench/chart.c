/* facet-chart: draws what facet-bench --tsv and tests/model_errors.c measured, as SVG files and one page. */
#include "chart.h"
#include "console.h"
#include "tsv.h"

#include <errno.h>
#include <string.h>

const char console_program[] = "facet-chart";

static const char usage[] =
    "usage: facet-chart [--errors FILE] -o DIR TSV...\n"
    "  TSV            what facet-bench --tsv wrote: a file a machine\n"
    "  --errors FILE  what model-errors printed: models against models, and where textbook forms fail\n"
    "  -o DIR         writes DIR/NAME.svg, DIR/NAME-narrow.svg for phones, and DIR/index.html\n";

static const chart charts[] = {
    { "rounding", draw_rounding },
    { "models", draw_models },
    { "kernels", draw_kernels },
    { "arches", draw_arches },
    { "failures", draw_failures },
};
enum { CHARTS = sizeof charts / sizeof charts[0] };

/* ---- Files ----------------------------------------------------------------------------------------------------- */

static FILE *open_file(const char *directory, const char *name, const char *ending, char *path, size_t size)
{
    snprintf(path, size, "%s/%s%s", directory, name, ending);
    FILE *file = fopen(path, "w");
    if (!file)
        console_error("%s: %s", path, strerror(errno));
    return file;
}

static bool close_file(FILE *file, const char *path)
{
    const bool failed = ferror(file);
    if (fclose(file) || failed)
        return console_error("%s: %s", path, strerror(errno));
    return true;
}

static bool write_svg(const svg *s, const char *directory, const char *name)
{
    char path[4096];
    FILE *file = open_file(directory, name, s->narrow ? "-narrow.svg" : ".svg", path, sizeof path);
    if (!file)
        return false;
    svg_write(s, file, true);
    return close_file(file, path);
}

static bool write_page(const drawing *drawings, int count, const chart_data *d, const char *directory)
{
    char path[4096];
    FILE *file = open_file(directory, "index", ".html", path, sizeof path);
    if (!file)
        return false;
    page_write(file, drawings, count, d);
    return close_file(file, path);
}

static bool draw(svg *s, bool narrow, const chart *c, const chart_data *d)
{
    svg_begin(s, narrow);
    const bool drawn = c->draw(s, d);
    svg_end(s);
    return drawn;
}

static bool draw_all(const chart_data *d, const char *directory)
{
    drawing drawings[CHARTS];
    int count = 0;
    for (int i = 0; i < CHARTS; i++) {
        drawing *a = &drawings[count];
        a->name = charts[i].name;
        if (!draw(&a->wide, false, &charts[i], d) || !draw(&a->narrow, true, &charts[i], d)) {
            printf("no %s chart: nothing was measured for it\n", charts[i].name);
            continue;
        }
        if (!write_svg(&a->wide, directory, a->name) || !write_svg(&a->narrow, directory, a->name))
            return false;
        count++;
    }
    return write_page(drawings, count, d, directory);
}

/* ---- The command line ------------------------------------------------------------------------------------------ */

static bool is_value_of(const char *option, int count, char **words, int *at)
{
    return !strcmp(words[*at], option) && *at + 1 < count && (*at)++ > 0;
}

int main(int count, char **words)
{
    chart_data d = { 0 };
    const char *directory = NULL;
    if (count == 2 && !strcmp(words[1], "--help"))
        return fputs(usage, stdout) == EOF;
    for (int i = 1; i < count; i++) {
        if (is_value_of("-o", count, words, &i))
            directory = words[i];
        else if (is_value_of("--errors", count, words, &i)) {
            if (!chart_read_errors(&d, words[i]))
                return 2;
        } else if (*words[i] == '-') {
            console_error("%.80s: no such option, or no value; --help lists them", words[i]);
            return 2;
        } else if (!chart_read_bench(&d, words[i]))
            return 2;
    }
    if (!directory || !d.machine_count) {
        console_error("needs -o DIR and what facet-bench --tsv wrote; --help says more");
        return 2;
    }
    chart_name_machines(&d);
    return !draw_all(&d, directory);
}
