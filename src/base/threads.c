/* For pthread_timedjoin_np. */
#define _GNU_SOURCE
#include "base/threads.h"

#include <errno.h>
#include <pthread.h>
#include <stdbool.h>
#include <time.h>
#include <unistd.h>

#include "base/work.h"

enum { THREADS_MAX = 8, WAIT_NS = 20000000 };

typedef struct piece {
    pthread_t  thread;
    bool       started;
    threads_fn fn;
    void      *user;
    work      *work; /* that the thread adopts */
    size_t     begin, end;
} piece;

static void *run(void *argument)
{
    piece *p = argument;
    work_adopt(p->work);
    p->fn(p->begin, p->end, p->user);
    work_adopt(NULL);
    return NULL;
}

/* The calling thread is the one that hears of cancelling, so it does not sleep for long. */
static void join(pthread_t thread)
{
    struct timespec until;
    do {
        work_check(NULL);
        clock_gettime(CLOCK_REALTIME, &until);
        until.tv_nsec += WAIT_NS;
        until.tv_sec += until.tv_nsec / 1000000000;
        until.tv_nsec %= 1000000000;
    } while (pthread_timedjoin_np(thread, NULL, &until) == ETIMEDOUT);
}

/* How many pieces there is work for. Asking for processors opens a file each time, so small work does not ask. */
static size_t pieces_for(size_t count, size_t smallest)
{
    size_t most = count / (smallest ? smallest : 1);
    if (most <= 1)
        return 1;
    long   processors = sysconf(_SC_NPROCESSORS_ONLN);
    size_t pieces = processors < 1 ? 1 : processors > THREADS_MAX ? THREADS_MAX : (size_t)processors;
    return pieces < most ? pieces : most;
}

void threads_for(size_t count, size_t smallest, threads_fn fn, void *user)
{
    size_t pieces = pieces_for(count, smallest);
    piece  list[THREADS_MAX];
    for (size_t i = 0; i < pieces; i++) {
        size_t begin = count / pieces * i, end = i + 1 == pieces ? count : count / pieces * (i + 1);
        list[i] = (piece){.fn = fn, .user = user, .work = work_current(), .begin = begin, .end = end};
    }
    for (size_t i = 1; i < pieces; i++)
        list[i].started = pthread_create(&list[i].thread, NULL, run, &list[i]) == 0;
    fn(list[0].begin, list[0].end, user);
    for (size_t i = 1; i < pieces; i++) {
        if (list[i].started)
            join(list[i].thread);
        else
            fn(list[i].begin, list[i].end, user);
    }
}
