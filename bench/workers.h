/* POSIX threads that take numbers from one counter. */
#ifndef WORKERS_H
#define WORKERS_H

#include <stdbool.h>
#include <stddef.h>

enum { WORKER_LIMIT = 256 };

/* How many CPUs this process may run on, at most WORKER_LIMIT. */
int worker_default(void);

/* Does the work of number i on the thread `worker`, which counts from 0, the caller. False: all threads stop. */
typedef bool worker_task(void *context, int worker, size_t i);

/* Has every i < count done once, on up to `threads` threads, this one among them: whoever is free takes the
 * next. Returns how many threads there were, fewer where no more could be started or were needed; 0 where one of them
 * stopped. */
int workers_run(int threads, size_t count, worker_task *task, void *context);

#endif
