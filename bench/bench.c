/* facet-bench: times the library's kernels and the baselines, interleaved in one process. */
#include "bench_errors.h"
#include "bench_options.h"
#include "bench_report.h"
#include "bench_rounds.h"
#include "console.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

const char console_program[] = "facet-bench";


/* The words as they were typed. */
static void join(char *line, size_t size, int count, char **words)
{
    *line = 0;
    for (int i = 0; i < count; i++) {
        const size_t used = strlen(line);
        snprintf(line + used, size - used, "%s%s", i ? " " : "", words[i]);
    }
}

/* A run; its results. What cannot be written is refused before it. */
static bool run(const bench_options *o, const char *command, results *r)
{
    contenders c = { 0 };
    console_start();
    if (o->tsv && !results_writable(o->tsv)) return false;
    if (!errors_read(o->errors) || !contenders_list(&c, o) || !rounds_run(&c, (double)o->seconds)) return false;
    console_clear();
    *r = results_of(&c);
    report_print(&c, r);
    return !o->tsv || results_write(r, o->tsv, command);
}

int main(int count, char **arguments)
{
    bench_options o;
    results old = { 0 }, fresh = { 0 };
    char command[1024];
    if (!bench_options_read(&o, count, arguments)) return 2;
    if (o.help) {
        bench_options_help();
        return EXIT_SUCCESS;
    }
    join(command, sizeof command, count, arguments);
    if (o.old && !results_read(&old, o.old)) return EXIT_FAILURE;
    if (!(o.fresh ? results_read(&fresh, o.fresh) : run(&o, command, &fresh))) return EXIT_FAILURE;
    if (o.old) {
        printf("%scompared with %s\n", o.fresh ? "" : "\n", o.old);
        results_compare(&old, &fresh);
    }
    return EXIT_SUCCESS;
}
