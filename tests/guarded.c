#include "guarded.h"

#include <setjmp.h>
#include <signal.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>

#ifdef _POSIX_MAPPED_FILES
#include <sys/mman.h>
#endif

static void *checked(void *memory, bool got)
{
    if (!got) {
        fprintf(stderr, "facet-check: out of memory\n");
        exit(2);
    }
    return memory;
}

#ifdef _POSIX_MAPPED_FILES

static size_t page_bytes(void)
{
    return (size_t)sysconf(_SC_PAGESIZE);
}

guarded guarded_allocate(size_t bytes)
{
    const size_t page = page_bytes(), inside = (bytes + page - 1) / page * page;
    unsigned char *all = mmap(NULL, inside + 2 * page, PROT_NONE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    checked(all, all != MAP_FAILED && !mprotect(all + page, inside, PROT_READ | PROT_WRITE));
    return (guarded){ all + page, all + page + inside };
}

void guarded_free(guarded *g)
{
    const size_t page = page_bytes();
    munmap(g->first - page, (size_t)(g->end - g->first) + 2 * page);
    *g = (guarded){ NULL, NULL };
}

#else

guarded guarded_allocate(size_t bytes)
{
    unsigned char *all = malloc(bytes);
    checked(all, all != NULL);
    return (guarded){ all, all + bytes };
}

void guarded_free(guarded *g)
{
    free(g->first);
    *g = (guarded){ NULL, NULL };
}

#endif

/* ---- Faults ------------------------------------------------------------------------------------------------------ */

static const struct { int signal; const char *word; } faults[] = {
    { SIGSEGV, "SIGSEGV" }, { SIGBUS, "SIGBUS" }, { SIGFPE, "SIGFPE" }, { SIGILL, "SIGILL" },
    { SIGALRM, "no end" },
};
enum { FAULTS = sizeof faults / sizeof faults[0], SECONDS = 30 };

static sigjmp_buf place;
static volatile sig_atomic_t last_fault;

static void on_fault(int signal)
{
    last_fault = signal;
    siglongjmp(place, 1);
}

static const char *fault_word(void)
{
    for (int i = 0; i < FAULTS; i++)
        if (faults[i].signal == last_fault) return faults[i].word;
    return "unknown";
}

const char *fault_of(void (*f)(void *), void *argument)
{
    struct sigaction callers[FAULTS], ours = { .sa_handler = on_fault };
    const char *volatile fault = NULL;
    for (int i = 0; i < FAULTS; i++) sigaction(faults[i].signal, &ours, &callers[i]);
    if (sigsetjmp(place, 1) == 0) {
        alarm(SECONDS);
        f(argument);
    } else {
        fault = fault_word();
    }
    alarm(0);
    for (int i = 0; i < FAULTS; i++) sigaction(faults[i].signal, &callers[i], NULL);
    return fault;
}
