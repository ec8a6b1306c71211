/* Memory between two pages that may not be touched, and calls that outlive a fault. */
#ifndef GUARDED_H
#define GUARDED_H

#include <stddef.h>

/* Whole pages: the bytes from `first` up to `end` can be used, those right before and right behind fault. */
typedef struct { unsigned char *first, *end; } guarded;

/* At least `bytes`; ends the program where there is no memory. Where the machine has no pages that can be guarded,
 * the memory is malloc's, which a sanitizer guards. */
guarded guarded_allocate(size_t bytes);
void guarded_free(guarded *);

/* Calls f(argument). NULL, or how it faulted: a signal's name, or that it came to no end. */
const char *fault_of(void (*f)(void *), void *argument);

#endif
