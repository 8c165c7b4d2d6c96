#include "base/work.h"

#include <stdarg.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

#include "base/clock.h"
#include "base/error.h"

/* The callback is asked this often, and the clock read once in so many questions. */
enum { POLL_MS = 20, ASK_EVERY = 32 };

/* Found without a call, since each allocation asks. */
#define OF_THREAD static _Thread_local __attribute__((tls_model("initial-exec")))

OF_THREAD work    *current;
OF_THREAD bool     adopted; /* by a thread that works for another */
OF_THREAD unsigned questions;

/* Bytes of memory of this machine; a number that never limits where that is not known. */
static size_t machine_memory(void)
{
    long pages = sysconf(_SC_PHYS_PAGES), page = sysconf(_SC_PAGESIZE);
    return pages > 0 && page > 0 ? (size_t)pages * (size_t)page : SIZE_MAX / 2;
}

static void begin(work *w, const lmn_task_desc *conditions, lmn_progress_fn progress, void *user)
{
    double now = clock_ms();
    work  *outer = current;
    *w = (work){.outer = outer,
                .conditions = conditions,
                .progress = progress,
                .user = user,
                .stage = "beginning",
                .poll_ms = now + POLL_MS};
    w->limits = conditions ? conditions->limits : lmn_limits_standard();
    w->memory = w->limits.memory ? (size_t)w->limits.memory : machine_memory() / 4 * 3;
    current = w;
    adopted = false;
}

void work_begin(work *w, lmn_progress_fn progress, void *user)
{
    begin(w, current ? current->conditions : NULL, progress, user);
    w->end_ms = w->limits.time_s > 0 ? clock_ms() + 1000 * w->limits.time_s : 0;
}

void work_begin_task(work *w, const lmn_task_desc *conditions)
{
    begin(w, conditions, conditions->progress, conditions->progress_user);
}

static lmn_status explain(const work *w, lmn_error *error)
{
    switch ((work_stop)atomic_load(&w->stop)) {
    case WORK_GOES_ON: return LMN_OK;
    case WORK_CANCELLED: return error_set(error, LMN_CANCELLED, "cancelled");
    case WORK_OUT_OF_TIME:
        return work_exceeded(error, "time", "this takes longer than %g s and was stopped", w->limits.time_s);
    case WORK_OUT_OF_MEMORY:
        return work_exceeded(error, "memory", "this takes more than %.1f GiB of memory and was stopped",
                             (double)w->memory / (1 << 30));
    }
    return LMN_OK;
}

lmn_status work_end(work *w, lmn_status status, lmn_error *error)
{
    if (w->fence)
        w->end_fence(w->fence);
    w->fence = NULL;
    current = w->outer;
    if (!atomic_load(&w->stop))
        return status;
    char file[sizeof error->file] = "";
    if (error && status != LMN_OK)
        memcpy(file, error->file, sizeof file);
    status = explain(w, error);
    if (error)
        memcpy(error->file, file, sizeof file);
    return status;
}

lmn_status work_end_done(work *w)
{
    work_end(w, LMN_OK, NULL);
    return LMN_OK;
}

work *work_current(void)
{
    return current;
}

work *work_outermost(void)
{
    work *w = current;
    while (w && w->outer)
        w = w->outer;
    return w;
}

void work_adopt(work *w)
{
    current = w;
    adopted = w != NULL;
}

static void stop(work *w, work_stop why)
{
    int before = WORK_GOES_ON;
    atomic_compare_exchange_strong(&w->stop, &before, (int)why);
}

/* The callback may call the library again; that is a work of its own, which does not ask again. */
static void ask(work *w)
{
    w->asking = true;
    if (!w->progress(w->fraction, w->stage, w->user))
        stop(w, WORK_CANCELLED);
    w->asking = false;
}

/* What stops the work around this one stops this one. */
static void poll_clock(work *w, double now)
{
    if (w->end_ms > 0 && now > w->end_ms)
        stop(w, WORK_OUT_OF_TIME);
    if (!adopted && w->progress && !w->asking && now >= w->poll_ms) {
        w->poll_ms = now + POLL_MS;
        ask(w);
    }
    if (!w->outer)
        return;
    poll_clock(w->outer, now);
    int why = atomic_load(&w->outer->stop);
    if (why)
        stop(w, (work_stop)why);
}

bool work_stopped(void)
{
    work *w = current;
    if (!w)
        return false;
    if (++questions % ASK_EVERY == 0)
        poll_clock(w, clock_ms());
    return atomic_load_explicit(&w->stop, memory_order_relaxed) != WORK_GOES_ON;
}

lmn_status work_check(lmn_error *error)
{
    if (!current)
        return LMN_OK;
    poll_clock(current, clock_ms());
    return explain(current, error);
}

lmn_status work_progress(double fraction, const char *stage, lmn_error *error)
{
    work *w = current;
    if (w && !adopted) {
        w->fraction = fraction;
        w->stage = stage;
        if (w->progress && !w->asking)
            ask(w);
    }
    return work_check(error);
}

lmn_limits work_limits(void)
{
    return current ? current->limits : lmn_limits_standard();
}

const lmn_task_desc *work_conditions(void)
{
    return current ? current->conditions : NULL;
}

static const lmn_task_desc *listener(void)
{
    for (const work *w = current; w && !adopted; w = w->outer)
        if (w->conditions && w->conditions->log)
            return w->conditions;
    return NULL;
}

bool work_listens(void)
{
    return listener() != NULL;
}

void work_log(lmn_log_kind kind, const char *code, const char *text)
{
    const lmn_task_desc *to = listener();
    if (to)
        to->log(kind, code, text, to->log_user);
}

lmn_status work_exceeded(lmn_error *error, const char *name, const char *format, ...)
{
    char    message[512];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(message, sizeof message, format, arguments);
    va_end(arguments);
    error_set(error, LMN_LIMIT, "%s", message);
    error_hint(error, "the limit '%s' can be raised: --limit %s=VALUE, or lmn_limits.%s", name, name,
               strcmp(name, "time") == 0 ? "time_s" : name);
    return LMN_LIMIT;
}

bool work_has_memory(size_t bytes)
{
    for (work *w = current; w; w = w->outer) {
        long long held = atomic_load_explicit(&w->held, memory_order_relaxed);
        if (bytes <= w->memory && held + (long long)bytes <= (long long)w->memory)
            continue;
        /* A task goes on: what this call gives back is there for the next. */
        stop(current, WORK_OUT_OF_MEMORY);
        return false;
    }
    return true;
}

void work_count(long long bytes)
{
    for (work *w = current; w; w = w->outer)
        atomic_fetch_add_explicit(&w->held, bytes, memory_order_relaxed);
}
