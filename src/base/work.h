/* The work of one public call, or of a task around several: what it may use up, and whether it is to stop.
 *
 * A call that reads, draws or writes begins its work and ends it. In between, whatever runs on the calling thread, and
 * on threads that work for it (base/threads.h), can ask whether to go on. Work that is to stop gets no more memory
 * (base/memory.h): every path that copes with missing memory so copes with stopping, and gives back what it holds.
 * Loops that neither allocate nor end soon ask work_stopped().
 *
 * The current work is known by thread and not handed from function to function: like errno, it belongs to the call that
 * runs there. */
#ifndef LIMNER_BASE_WORK_H
#define LIMNER_BASE_WORK_H

#include <stdatomic.h>
#include <stdbool.h>
#include <stddef.h>

#include "limner/task.h"

typedef enum work_stop { WORK_GOES_ON = 0, WORK_CANCELLED, WORK_OUT_OF_TIME, WORK_OUT_OF_MEMORY } work_stop;

typedef struct work {
    struct work         *outer;      /* of the task around this call, or of a call whose callback made this one */
    const lmn_task_desc *conditions; /* of the innermost task; NULL: standard */
    lmn_limits           limits;
    lmn_progress_fn      progress; /* asked on the thread that began */
    void                *user;
    double               fraction; /* what was last told */
    const char          *stage;
    double               end_ms;  /* of the time limit; 0: none */
    double               poll_ms; /* when the callback is asked next */
    bool                 asking;  /* inside the callback */
    size_t               memory;  /* limit, bytes */
    atomic_int           stop;    /* work_stop */
    atomic_llong         held;    /* bytes more than at the beginning */
    struct fence        *fence;   /* the child process, kept by the outermost work (fence/fence.h); NULL: none yet */
    void (*end_fence)(struct fence *fence);
} work;

/* Makes `w` the work of this thread: of a call, under the conditions of the work around it. NULL progress never
 * cancels by itself. */
void work_begin(work *w, lmn_progress_fn progress, void *user);
/* The same for a task, whose conditions last as long as the work. Time is limited for each call, not for the task. */
void work_begin_task(work *w, const lmn_task_desc *conditions);
/* Ends it. Returns the call's status, or, when it was stopped, LMN_CANCELLED or LMN_LIMIT with an error that says
 * why. */
lmn_status work_end(work *w, lmn_status status, lmn_error *error);
/* The same for what cannot be taken back: a call that has done all is done, also when it was to stop at the last
 * moment. LMN_OK. */
lmn_status work_end_done(work *w);

/* The work of this thread, NULL outside of any; and the one around all others. A thread that works for another
 * adopts its work, and NULL when done. */
work *work_current(void);
work *work_outermost(void);
void  work_adopt(work *w);

/* Is the current work to stop? Cheap; asks the callback when that is due. False outside of any work. */
bool work_stopped(void);
/* The same as a status, with the error filled: LMN_OK, LMN_CANCELLED or LMN_LIMIT. */
lmn_status work_check(lmn_error *error);
/* Tells the callback how far the call is, 0 … 1; the name of the stage must last. Returns as work_check. */
lmn_status work_progress(double fraction, const char *stage, lmn_error *error);

/* The limits and conditions that hold now; the standard ones outside of any work. */
lmn_limits           work_limits(void);
const lmn_task_desc *work_conditions(void); /* NULL: standard */
/* Tells the innermost task that listens; nothing on threads that work for another. */
void work_log(lmn_log_kind kind, const char *code, const char *text);
bool work_listens(void); /* is there one? */
/* A limit is exceeded: fills the error, with the hint how to raise it. LMN_LIMIT. */
lmn_status work_exceeded(lmn_error *error, const char *name, const char *format, ...)
    __attribute__((format(printf, 3, 4)));

/* --- for base/memory.c --- */
/* May the current work hold so many bytes more? When not, it stops. */
bool work_has_memory(size_t bytes);
/* Counts the bytes of a block that came, or went (negative). */
void work_count(long long bytes);

#endif
