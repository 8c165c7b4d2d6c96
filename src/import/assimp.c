/* Formats that are not read here: assimp does, in a child process of its own with limits on time and memory, because it
 * reads out of bounds on some damaged files and takes all memory on others. A child that dies is an error message. */
#define _GNU_SOURCE
#include <errno.h>
#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <stdio.h>
#include <string.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

#include "base/error.h"
#include "base/limits.h"
#include "base/memory.h"
#include "import/assimp_stream.h"
#include "import/build.h"

enum { POLL_MS = 20, READ_BYTES = 1 << 20 };

/* The address sanitizer maps terabytes, so that there the child's address space cannot be limited; its resident memory can. */
#if defined(__SANITIZE_ADDRESS__)
#define LIMIT_RESIDENT (LIMIT_IMPORT_MEMORY / 4)
#define LIMIT_SPACE    RLIM_INFINITY
#elif defined(__has_feature)
#if __has_feature(address_sanitizer)
#define LIMIT_RESIDENT (LIMIT_IMPORT_MEMORY / 4)
#define LIMIT_SPACE    RLIM_INFINITY
#endif
#endif
#ifndef LIMIT_RESIDENT
#define LIMIT_RESIDENT LIMIT_IMPORT_MEMORY
#define LIMIT_SPACE    memory
#endif

typedef struct child {
    pid_t          id;
    int            pipe;
    unsigned char *bytes;
    size_t         size, room;
    int            status; /* as waitpid gives it */
    bool           timed_out, too_big;
} child;

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

static void limit(__rlimit_resource_t what, size_t value)
{
    struct rlimit r = {value, value};
    setrlimit(what, &r);
}

/* Never returns. Signals are put back to what ends a process: the host's handlers are not meant for this copy. */
static void run_child(const char *path, int pipe_end, size_t memory)
{
    static const int signals[] = {SIGSEGV, SIGBUS, SIGABRT, SIGFPE, SIGILL, SIGTERM, SIGINT, SIGXCPU, SIGPIPE};
    for (size_t i = 0; i < sizeof signals / sizeof *signals; i++)
        signal(signals[i], SIG_DFL);
    prctl(PR_SET_PDEATHSIG, SIGKILL);
    int nowhere = open("/dev/null", O_RDWR | O_CLOEXEC);
    if (nowhere >= 0) {
        dup2(nowhere, STDIN_FILENO);
        dup2(nowhere, STDOUT_FILENO);
        dup2(nowhere, STDERR_FILENO);
    }
    limit(RLIMIT_CORE, 0);
    limit(RLIMIT_FSIZE, 0);
    limit(RLIMIT_CPU, LIMIT_IMPORT_SECONDS);
    (void)memory;
    limit(RLIMIT_AS, LIMIT_SPACE);
    assimp_child_write(path, pipe_end);
    _exit(0);
}

static lmn_status start(child *c, const char *path, lmn_error *error)
{
    int ends[2];
    size_t memory;
    /* A GL driver may have mapped many gigabytes here, and the child starts with the same. */
    if (!size_add(process_memory(getpid(), 0), LIMIT_IMPORT_MEMORY, &memory) || pipe2(ends, O_CLOEXEC) != 0)
        return error_in_file(error, LMN_INTERNAL, path, 0, "cannot start the reader: %s", strerror(errno));
    c->id = fork();
    if (c->id == 0)
        run_child(path, ends[1], memory);
    close(ends[1]);
    c->pipe = ends[0];
    if (c->id < 0) {
        close(ends[0]);
        return error_in_file(error, LMN_MEMORY, path, 0, "cannot start the reader: %s", strerror(errno));
    }
    fcntl(c->pipe, F_SETPIPE_SZ, READ_BYTES);
    return LMN_OK;
}

static double now_seconds(void)
{
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (double)t.tv_sec + (double)t.tv_nsec * 1e-9;
}

/* True at the end of the stream. */
static bool read_some(child *c, lmn_status *status, lmn_error *error)
{
    if (c->size > LIMIT_IMPORT_MEMORY || !mem_grow((void **)&c->bytes, &c->room, c->size + READ_BYTES, 1)) {
        *status = error_memory(error);
        return true;
    }
    ssize_t got = read(c->pipe, c->bytes + c->size, READ_BYTES);
    if (got < 0)
        return errno != EINTR && errno != EAGAIN;
    c->size += (size_t)got;
    return got == 0;
}

static lmn_status receive(child *c, const import_job *job, lmn_error *error)
{
    double end = now_seconds() + LIMIT_IMPORT_SECONDS;
    lmn_status status = LMN_OK;
    for (;;) {
        struct pollfd wait = {.fd = c->pipe, .events = POLLIN};
        int ready = poll(&wait, 1, POLL_MS);
        if (ready > 0 && read_some(c, &status, error))
            break;
        if (ready == 0)
            status = import_progress(job, 0.1, "reading", error);
        if (status != LMN_OK)
            break;
        c->timed_out = now_seconds() > end;
        c->too_big = ready == 0 && process_memory(c->id, 1) > LIMIT_RESIDENT;
        if (c->timed_out || c->too_big)
            break;
    }
    return status;
}

/* The child may have closed its end and hang on the way out; whatever it still does is of no interest. */
static void end_child(child *c)
{
    close(c->pipe);
    bool stopped = c->timed_out || c->too_big;
    if (c->size == 0 || c->bytes[c->size - 1] != STREAM_END || stopped) {
        /* A child that crashed is gone already and keeps its status. */
        struct timespec moment = {0, 20000000};
        if (!stopped && waitpid(c->id, &c->status, WNOHANG) == c->id)
            return;
        if (!stopped)
            nanosleep(&moment, NULL);
        if (!stopped && waitpid(c->id, &c->status, WNOHANG) == c->id)
            return;
    }
    kill(c->id, SIGKILL);
    while (waitpid(c->id, &c->status, 0) < 0 && errno == EINTR)
        ;
}

static lmn_status explain(const child *c, const char *path, lmn_error *error)
{
    lmn_status status;
    if (c->too_big)
        status = error_in_file(error, LMN_LIMIT, path, 0, "reading the file takes more than %zu GiB of memory",
                               LIMIT_RESIDENT >> 30);
    else if (c->timed_out || (WIFSIGNALED(c->status) && WTERMSIG(c->status) == SIGXCPU))
        status = error_in_file(error, LMN_LIMIT, path, 0, "reading took longer than %d s and was stopped",
                               LIMIT_IMPORT_SECONDS);
    else if (WIFSIGNALED(c->status) && WTERMSIG(c->status) == SIGABRT)
        status = error_in_file(error, LMN_LIMIT, path, 0,
                               "the reader of this format gave up: the file is damaged or needs more than %zu GiB",
                               LIMIT_IMPORT_MEMORY >> 30);
    else
        status = error_in_file(error, LMN_FORMAT, path, 0, "the file is damaged: the reader of this format crashed on it");
    error_hint(error, "convert the model to glTF, for example with Blender");
    return status;
}

static lmn_status read_assimp(const import_job *job, lmn_error *error)
{
    child c = {.pipe = -1};
    lmn_status status = start(&c, job->path, error);
    if (status != LMN_OK)
        return status;
    status = receive(&c, job, error);
    end_child(&c);
    bool whole = c.size > 0 && (c.bytes[0] == STREAM_ERROR || c.bytes[c.size - 1] == STREAM_END);
    if (status == LMN_OK)
        status = whole && !c.timed_out && !c.too_big ? assimp_stream_read(job, c.bytes, c.size, error) : explain(&c, job->path, error);
    mem_free(c.bytes);
    return status;
}

const import_format import_assimp = {
    "a format that assimp reads",
    ".fbx .dae .3ds .off .3mf .blend .x .ase .ac .lwo .dxf .ifc .b3d .md2 .md3 .md5mesh .ms3d .x3d .cob .amf .assbin",
    'y', NULL, read_assimp};
