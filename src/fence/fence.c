/* The parent's side: starting the child, asking it, and telling why it did not answer. */
#define _GNU_SOURCE
#include "fence/fence.h"

#include <errno.h>
#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <stdio.h>
#include <string.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include "base/clock.h"
#include "base/limits.h"
#include "base/memory.h"
#include "base/work.h"
#include "fence/fence_private.h"

enum { POLL_MS = 20, AT_ONCE = 1 << 20, LEAVE_MS = 200, READY_MS = 2000, PREPARED_MS = 20000, TRIES = 3 };

static const char READY = 'R';

struct fence {
    pid_t child;
    int   channel;
};

/* What goes over first in each direction. Both ends are one program, so that addresses are the same. */
typedef struct question {
    fence_fn fn;
    size_t   size;
} question;

typedef struct reply {
    lmn_status status;
    lmn_error  error;
    size_t     size;
} reply;

/* --- the child ------------------------------------------------------------------------------------------ */

static bool receive_all(void *out, size_t size)
{
    unsigned char *at = out;
    while (size > 0) {
        ssize_t got = recv(FENCE_CHANNEL, at, size, 0);
        if (got < 0 && errno == EINTR)
            continue;
        if (got <= 0)
            return false;
        at += got;
        size -= (size_t)got;
    }
    return true;
}

static bool skip_all(size_t size)
{
    unsigned char nothing[4096];
    for (size_t some; size > 0; size -= some) {
        some = size < sizeof nothing ? size : sizeof nothing;
        if (!receive_all(nothing, some))
            return false;
    }
    return true;
}

static bool send_all(const void *bytes, size_t size)
{
    const unsigned char *at = bytes;
    while (size > 0) {
        ssize_t put = send(FENCE_CHANNEL, at, size, MSG_NOSIGNAL);
        if (put < 0 && errno == EINTR)
            continue;
        if (put <= 0)
            return false;
        at += put;
        size -= (size_t)put;
    }
    return true;
}

static bool answer_one(void)
{
    question q;
    if (!receive_all(&q, sizeof q))
        return false;
    unsigned char *request = mem_alloc(q.size + 1);
    if (request ? !receive_all(request, q.size) : !skip_all(q.size))
        return false;
    fence_bytes answer = {0};
    reply       r = {0};
    if (request)
        request[q.size] = '\0';
    r.status = request ? q.fn(request, q.size, &answer, &r.error) : error_memory(&r.error);
    if (r.status == LMN_OK && answer.failed)
        r.status = error_memory(&r.error);
    r.size = r.status == LMN_OK ? answer.size : 0;
    mem_free(request);
    bool sent = send_all(&r, sizeof r) && send_all(answer.bytes, r.size);
    mem_free(answer.bytes);
    return sent;
}

/* Another thread of the parent may have held a lock when the child was made, which then nobody gives back; whoever
 * waits for it is told apart by not saying that it is ready. */
static bool has_memory(void)
{
    bool good = true;
    for (size_t size = 16; size < (1 << 22) && good; size *= 4) {
        void *block = mem_alloc(size);
        good = block != NULL;
        mem_free(block);
    }
    return good;
}

/* Never returns. The work around it is the parent's, with callbacks that are not meant for this process; so are
 * allocations that tests make fail: the child serves those after it, too. */
static void run_child(int channel, size_t address_space, fence_prepare prepare)
{
    work_adopt(NULL);
    mem_fail_at(0);
    mem_enter_child();
    if (fence_lock(channel, address_space, prepare) && has_memory() && send_all(&READY, sizeof READY))
        while (answer_one())
            ;
    _exit(0);
}

/* --- the parent ----------------------------------------------------------------------------------------- */

/* Bytes that a process has mapped (field 0 of its statm) or resident (field 1); 0 when that cannot be told. */
static size_t process_memory(pid_t id, int field)
{
    char path[64], numbers[128];
    snprintf(path, sizeof path, "/proc/%ld/statm", (long)id);
    int descriptor = open(path, O_RDONLY | O_CLOEXEC);
    if (descriptor < 0)
        return 0;
    ssize_t got = read(descriptor, numbers, sizeof numbers - 1);
    close(descriptor);
    numbers[got > 0 ? got : 0] = '\0';
    size_t pages[2] = {0, 0};
    if (sscanf(numbers, "%zu %zu", &pages[0], &pages[1]) != 2)
        return 0;
    long page = sysconf(_SC_PAGESIZE);
    return page > 0 ? pages[field] * (size_t)page : 0;
}

static size_t memory_limit(void)
{
    size_t limit = work_current()->memory;
    return limit < LIMIT_IMPORT_MEMORY ? limit : LIMIT_IMPORT_MEMORY;
}

static void end_fence(struct fence *f)
{
    close(f->channel);
    if (f->child > 0) {
        kill(f->child, SIGKILL);
        while (waitpid(f->child, NULL, 0) < 0 && errno == EINTR)
            ;
    }
    mem_free(f);
}

static lmn_status start_one(struct fence **out, fence_prepare prepare, lmn_error *error)
{
    int           ends[2];
    struct fence *f = mem_calloc(1, sizeof *f);
    if (!f)
        return error_memory(error);
    if (socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends) != 0) {
        mem_free(f);
        return error_set(error, LMN_MEMORY, "cannot start the process for decoders: %s", strerror(errno));
    }
    /* A GL driver may have mapped many gigabytes here, and the child starts with the same. */
    size_t space = 0;
#ifndef FENCE_SANITIZED
    size_add(process_memory(getpid(), 0), memory_limit(), &space);
#endif
    f->child = fork();
    if (f->child == 0)
        run_child(ends[1], space, prepare);
    int problem = errno;
    close(ends[1]);
    f->channel = ends[0];
    if (f->child < 0) {
        end_fence(f);
        return error_set(error, LMN_MEMORY, "cannot start the process for decoders: %s", strerror(problem));
    }
    fcntl(f->channel, F_SETFL, O_NONBLOCK);
    *out = f;
    return LMN_OK;
}

/* Is the child there? False also when the work is to stop. */
static bool is_ready(const struct fence *f, double patience_ms)
{
    double end = clock_ms() + patience_ms;
    while (clock_ms() < end && work_check(NULL) == LMN_OK) {
        struct pollfd wait = {.fd = f->channel, .events = POLLIN};
        char          byte = 0;
        if (poll(&wait, 1, POLL_MS) > 0)
            return recv(f->channel, &byte, 1, 0) == 1 && byte == READY;
    }
    return false;
}

static lmn_status start(struct fence **out, fence_prepare prepare, lmn_error *error)
{
    lmn_status status = LMN_OK;
    for (int i = 0; i < TRIES && status == LMN_OK; i++) {
        status = start_one(out, prepare, error);
        if (status != LMN_OK || is_ready(*out, prepare ? PREPARED_MS : READY_MS))
            return status;
        end_fence(*out);
        *out = NULL;
        status = work_check(error);
    }
    return status == LMN_OK ? error_set(error, LMN_MEMORY, "the process for decoders does not start") : status;
}

/* One request on its way. */
typedef struct exchange {
    struct fence *fence;
    const char   *what;
    double        end_ms;
    bool          timed_out, too_big, gone;
    lmn_error    *error;
} exchange;

/* Waits until the channel can be read or written; false when the exchange is over, for any reason. */
static bool wait_for(exchange *e, short events)
{
    for (;;) {
        struct pollfd wait = {.fd = e->fence->channel, .events = events};
        int           ready = poll(&wait, 1, POLL_MS);
        if (ready > 0)
            return true;
        if (work_check(NULL) != LMN_OK)
            return false;
        e->timed_out = clock_ms() > e->end_ms;
#ifdef FENCE_SANITIZED
        e->too_big = process_memory(e->fence->child, 1) >
                     memory_limit() / 4; /* what is touched, and not all that is asked for */
#endif
        if (e->timed_out || e->too_big)
            return false;
    }
}

static bool send_bytes(exchange *e, const void *bytes, size_t size)
{
    const unsigned char *at = bytes;
    while (size > 0) {
        ssize_t put = send(e->fence->channel, at, size < AT_ONCE ? size : AT_ONCE, MSG_NOSIGNAL);
        if (put < 0 && errno == EINTR)
            continue;
        if (put < 0 && errno == EAGAIN) {
            if (!wait_for(e, POLLOUT))
                return false;
            continue;
        }
        if (put <= 0) {
            e->gone = true;
            return false;
        }
        at += put;
        size -= (size_t)put;
    }
    return true;
}

static bool receive_bytes(exchange *e, void *out, size_t size)
{
    unsigned char *at = out;
    while (size > 0) {
        ssize_t got = recv(e->fence->channel, at, size < AT_ONCE ? size : AT_ONCE, 0);
        if (got < 0 && errno == EINTR)
            continue;
        if (got < 0 && errno == EAGAIN) {
            if (!wait_for(e, POLLIN))
                return false;
            continue;
        }
        if (got <= 0) {
            e->gone = true;
            return false;
        }
        at += got;
        size -= (size_t)got;
    }
    return true;
}

/* How the child ended: it is gone, or about to be. */
static int reap(struct fence *f)
{
    int    status = 0;
    double until = clock_ms() + LEAVE_MS;
    pid_t  got;
    while ((got = waitpid(f->child, &status, WNOHANG)) == 0 && clock_ms() < until)
        poll(NULL, 0, 1);
    if (got == f->child)
        f->child = 0;
    return got == f->child || got > 0 ? status : 0;
}

static lmn_status explain(const exchange *e, int status)
{
    lmn_status stopped = work_check(e->error);
    if (stopped != LMN_OK)
        return stopped;
    if (e->timed_out)
        return error_set(e->error, LMN_LIMIT, "%s took longer than %d s and was stopped", e->what,
                         LIMIT_IMPORT_SECONDS);
    bool aborted = WIFSIGNALED(status) && (WTERMSIG(status) == SIGABRT || WTERMSIG(status) == SIGKILL);
    if (e->too_big || aborted || (WIFEXITED(status) && WEXITSTATUS(status) == 0))
        return work_exceeded(e->error, "memory", "%s gave up: the data is damaged or needs more than %.1f GiB", e->what,
                             (double)memory_limit() / (1 << 30));
    return error_set(e->error, LMN_FORMAT, "the data is damaged: %s crashed on it", e->what);
}

/* An answer that is too large for this process is an error like any other. */
static lmn_status receive_answer(exchange *e, fence_bytes *answer, bool *whole)
{
    reply r;
    *whole = receive_bytes(e, &r, sizeof r);
    if (!*whole)
        return LMN_OK;
    if (r.status != LMN_OK) {
        r.error.message[sizeof r.error.message - 1] = r.error.hint[sizeof r.error.hint - 1] =
            r.error.file[sizeof r.error.file - 1] = '\0';
        r.error.status = r.status > LMN_OK && r.status <= LMN_INTERNAL ? r.status : LMN_INTERNAL;
        if (e->error)
            *e->error = r.error;
        return r.error.status;
    }
    /* So much that no byte can be added does not come from the decoder. */
    size_t capacity;
    if (!size_add(r.size, 1, &capacity)) {
        *whole = false;
        return error_set(e->error, LMN_FORMAT, "%s gave a wrong answer", e->what);
    }
    *answer = (fence_bytes){.bytes = mem_alloc(capacity), .size = r.size, .capacity = capacity};
    *whole = answer->bytes && receive_bytes(e, answer->bytes, r.size);
    return answer->bytes ? LMN_OK : error_memory(e->error);
}

/* *whole: the child is as it was before and can be asked again. */
static lmn_status ask(struct fence *f, fence_bytes *answer, fence_fn fn, const char *what, const fence_bytes *request,
                      bool *whole, lmn_error *error)
{
    lmn_status     status = LMN_OK;
    exchange       e = {.fence = f, .what = what, .end_ms = clock_ms() + 1000.0 * LIMIT_IMPORT_SECONDS, .error = error};
    const question q = {fn, request->size};
    *whole = send_bytes(&e, &q, sizeof q) && send_bytes(&e, request->bytes, request->size);
    if (*whole)
        status = receive_answer(&e, answer, whole);
    /* Whatever it still does is of no interest. */
    if (!*whole && status == LMN_OK)
        status = explain(&e, e.gone ? reap(f) : 0);
    return status;
}

static lmn_status call_child(fence_bytes *answer, fence_fn fn, const char *what, const fence_bytes *request,
                             lmn_error *error)
{
    work      *around = work_outermost();
    bool       whole;
    lmn_status status = around->fence ? LMN_OK : start(&around->fence, NULL, error);
    if (status != LMN_OK)
        return status;
    around->end_fence = end_fence;
    /* A callback that is asked meanwhile may call the library: what that needs decoded goes to a child of its own. */
    struct fence *f = around->fence;
    around->fence = NULL;
    status = ask(f, answer, fn, what, request, &whole, error);
    if (whole && !around->fence)
        around->fence = f;
    else
        end_fence(f);
    return status;
}

static lmn_status call_own_child(fence_bytes *answer, fence_fn fn, fence_prepare prepare, const char *what,
                                 const fence_bytes *request, lmn_error *error)
{
    struct fence *f = NULL;
    bool          whole;
    lmn_status    status = start(&f, prepare, error);
    if (status != LMN_OK)
        return status;
    status = ask(f, answer, fn, what, request, &whole, error);
    end_fence(f);
    return status;
}

static lmn_status call_here(fence_bytes *answer, fence_fn fn, const fence_bytes *request, lmn_error *error)
{
    lmn_status status = fn(request->bytes, request->size, answer, error);
    return status == LMN_OK && answer->failed ? error_memory(error) : status;
}

typedef enum where { IN_THIS_PROCESS, IN_THE_CHILD, IN_ITS_OWN } where;

static lmn_status call(fence_bytes *answer, fence_fn fn, fence_prepare prepare, const char *what,
                       const fence_bytes *request, where runs, lmn_error *error)
{
    *answer = (fence_bytes){0};
    work own;
    bool alone = !work_current();
    if (request->failed)
        return error_memory(error);
    if (alone)
        work_begin(&own, NULL, NULL);
    lmn_status status = runs == IN_THIS_PROCESS ? call_here(answer, fn, request, error)
                        : runs == IN_THE_CHILD  ? call_child(answer, fn, what, request, error)
                                                : call_own_child(answer, fn, prepare, what, request, error);
    if (alone)
        status = work_end(&own, status, error);
    if (status != LMN_OK) {
        mem_free(answer->bytes);
        *answer = (fence_bytes){0};
    }
    return status;
}

lmn_status fence_call(fence_bytes *answer, fence_fn fn, const char *what, const fence_bytes *request, lmn_error *error)
{
    const lmn_task_desc *conditions = work_conditions();
    bool                 here = conditions && conditions->in_process;
    return call(answer, fn, NULL, what, request, here ? IN_THIS_PROCESS : IN_THE_CHILD, error);
}

lmn_status fence_call_always(fence_bytes *answer, fence_fn fn, const char *what, const fence_bytes *request,
                             lmn_error *error)
{
    return call(answer, fn, NULL, what, request, IN_THE_CHILD, error);
}

lmn_status fence_call_prepared(fence_bytes *answer, fence_fn fn, fence_prepare prepare, const char *what,
                               const fence_bytes *request, lmn_error *error)
{
    return call(answer, fn, prepare, what, request, IN_ITS_OWN, error);
}
