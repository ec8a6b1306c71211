#define _GNU_SOURCE   /* sched_getaffinity */
#include "workers.h"

#include <pthread.h>
#include <sched.h>
#include <stdatomic.h>
#include <unistd.h>

int worker_default(void)
{
    long cpus = sysconf(_SC_NPROCESSORS_ONLN);
#ifdef CPU_COUNT
    cpu_set_t allowed;
    if (!sched_getaffinity(0, sizeof allowed, &allowed))
        cpus = CPU_COUNT(&allowed);
#endif
    return cpus < 1 ? 1 : cpus > WORKER_LIMIT ? WORKER_LIMIT : (int)cpus;
}

typedef struct crew {
    atomic_size_t next;
    atomic_bool stopped;
    size_t count;
    worker_task *task;
    void *context;
} crew;

typedef struct member {
    crew *crew;
    int worker;
    pthread_t thread;
} member;

static void *take_numbers(void *argument)
{
    const member *m = argument;
    crew *c = m->crew;
    size_t i;
    while (!atomic_load(&c->stopped) && (i = atomic_fetch_add(&c->next, 1)) < c->count)
        if (!c->task(c->context, m->worker, i))
            atomic_store(&c->stopped, true);
    return NULL;
}

/* Address space is the limit where many threads start: a tile's buffers take a twentieth of this stack. */
static bool start(member *m)
{
    pthread_attr_t attributes;
    if (pthread_attr_init(&attributes))
        return false;
    bool started = !pthread_attr_setstacksize(&attributes, (size_t)1 << 20) &&
                   !pthread_create(&m->thread, &attributes, take_numbers, m);
    pthread_attr_destroy(&attributes);
    return started;
}

int workers_run(int threads, size_t count, worker_task *task, void *context)
{
    crew c = {.count = count, .task = task, .context = context};
    member members[WORKER_LIMIT] = {{.crew = &c}};
    int started = 1;
    while (started < threads && started < WORKER_LIMIT && (size_t)started < count) {
        members[started] = (member){.crew = &c, .worker = started};
        if (!start(&members[started]))
            break;
        started++;
    }
    take_numbers(&members[0]);
    for (int i = 1; i < started; i++)
        pthread_join(members[i].thread, NULL);
    return atomic_load(&c.stopped) ? 0 : started;
}
