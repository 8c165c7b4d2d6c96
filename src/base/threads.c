#include "base/threads.h"

#include <pthread.h>
#include <stdbool.h>
#include <unistd.h>

enum { THREADS_MAX = 8 };

typedef struct piece {
    pthread_t  thread;
    bool       started;
    threads_fn fn;
    void      *user;
    size_t     begin, end;
} piece;

static void *work(void *argument)
{
    piece *p = argument;
    p->fn(p->begin, p->end, p->user);
    return NULL;
}

void threads_for(size_t count, size_t smallest, threads_fn fn, void *user)
{
    long processors = sysconf(_SC_NPROCESSORS_ONLN);
    size_t pieces = processors < 1 ? 1 : processors > THREADS_MAX ? THREADS_MAX : (size_t)processors;
    if (smallest == 0)
        smallest = 1;
    if (pieces > count / smallest)
        pieces = count / smallest ? count / smallest : 1;
    piece list[THREADS_MAX];
    for (size_t i = 0; i < pieces; i++) {
        size_t begin = count / pieces * i, end = i + 1 == pieces ? count : count / pieces * (i + 1);
        list[i] = (piece){.fn = fn, .user = user, .begin = begin, .end = end};
    }
    for (size_t i = 1; i < pieces; i++)
        list[i].started = pthread_create(&list[i].thread, NULL, work, &list[i]) == 0;
    work(&list[0]);
    for (size_t i = 1; i < pieces; i++) {
        if (list[i].started)
            pthread_join(list[i].thread, NULL);
        else
            work(&list[i]);
    }
}
