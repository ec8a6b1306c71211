/* What a program says on stderr, and its clock. */
#ifndef CONSOLE_H
#define CONSOLE_H

#include <stdbool.h>
#include <stddef.h>

/* The program's name: each defines its own. */
extern const char console_program[];

/* One line, "PROGRAM: ...", with control characters shown as '?'. Returns false, for callers to return. */
bool console_error(const char *format, ...) __attribute__((format(printf, 1, 2)));

/* Starts the time after which console_progress may speak. */
void console_start(void);

/* Shows how much of a step is done; silent in the first second and where stderr is no terminal. */
void console_progress(const char *step, size_t done, size_t total);

/* Erases what console_progress left. */
void console_clear(void);

double console_seconds(void);

#endif
