#include "console.h"

#include <ctype.h>
#include <stdarg.h>
#include <stdio.h>
#include <time.h>
#include <unistd.h>

static struct {
    double start, shown;
    int width;
} progress;

double console_seconds(void)
{
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

bool console_error(const char *format, ...)
{
    char line[1024];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(line, sizeof line, format, arguments);
    va_end(arguments);
    for (char *c = line; *c; c++)
        if (iscntrl((unsigned char)*c))
            *c = '?';
    console_clear();
    fprintf(stderr, "%s: %s\n", console_program, line);
    return false;
}

void console_start(void)
{
    progress.start = progress.shown = console_seconds();
}

void console_progress(const char *step, size_t done, size_t total)
{
    double now = console_seconds();
    if (now < progress.start + 1 || now < progress.shown + 0.1 || !isatty(STDERR_FILENO))
        return;
    progress.shown = now;
    int width = fprintf(stderr, "\r%s %.0f %%", step, 100 * (double)done / (double)total) - 1;
    if (width < progress.width)
        fprintf(stderr, "%*s", progress.width - width, "");
    progress.width = width > progress.width ? width : progress.width;
}

void console_clear(void)
{
    if (progress.width)
        fprintf(stderr, "\r%*s\r", progress.width, "");
    progress.width = 0;
}
