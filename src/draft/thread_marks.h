/* The symbol of threads (ISO 6410-1): a narrow line along the roots, three quarters of a circle where a thread is seen
 * along its axis, and a line across where it ends on what is round. */
#ifndef LIMNER_DRAFT_THREAD_MARKS_H
#define LIMNER_DRAFT_THREAD_MARKS_H

#include "draft/draw.h"
#include "draft/threads.h"

/* Asked of places on a view: how many surfaces lie in front of each; UINT32_MAX: it is not known. `away` says that a
 * place is cut away. */
typedef struct draft_sight {
    void (*count)(const void *user, const double (*places)[3], size_t count, uint32_t *out);
    bool (*away)(const void *user, const double place[3]);
    const void *user;
    bool        hidden; /* lines that are hidden are drawn, dashed */
} draft_sight;

/* Adds up how many lines. Threads that lean have none, as in pictorial views. */
void draft_thread_marks(const draft_view *v, const draft_thread *t, const draft_sight *sight, uint64_t *count);

#endif
