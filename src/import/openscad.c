#define _GNU_SOURCE
#include "import/openscad.h"

#include <errno.h>
#include <fcntl.h>
#include <limits.h>
#include <poll.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include "base/clock.h"
#include "base/error.h"
#include "base/file_temporary.h"
#include "base/limits.h"
#include "base/memory.h"
#include "base/work.h"

enum { POLL_MS = 20 };

bool openscad_is_allowed(void)
{
    const lmn_task_desc *conditions = work_conditions();
    return !conditions || (conditions->files != LMN_FILES_FOLDER && !conditions->read_file);
}

bool openscad_find(openscad_run *e)
{
    char       *out = e->program;
    const char *at = getenv("PATH");
    while (at && *at) {
        size_t      length = strcspn(at, ":");
        struct stat facts;
        int         size = snprintf(out, OPENSCAD_PATH_CAPACITY, "%.*s/openscad", (int)length, at);
        if (length > 0 && size < OPENSCAD_PATH_CAPACITY && *at == '/' && access(out, X_OK) == 0 &&
            stat(out, &facts) == 0 && S_ISREG(facts.st_mode))
            return true;
        at += length + (at[length] == ':');
    }
    return false;
}

lmn_status openscad_make_folder(openscad_run *e, const char *name)
{
    if (!temporary_folder_make(e->folder, sizeof e->folder))
        return error_in_file(e->error, LMN_WRITE, e->job->path, 0, "no temporary folder can be made: %s",
                             strerror(errno));
    snprintf(e->output, sizeof e->output, "%.*s/%.11s", OPENSCAD_PATH_CAPACITY - 1, e->folder, name);
    return LMN_OK;
}

/* openscad's arguments; the caller frees the array. NULL: memory is gone. */
static char **make_arguments(const openscad_run *e, const char *input, const char *const *defines, size_t define_count)
{
    size_t       count = 0;
    const char **arguments = mem_calloc(2 * define_count + 5, sizeof *arguments);
    if (!arguments)
        return NULL;
    arguments[count++] = "openscad";
    arguments[count++] = "-o";
    arguments[count++] = e->output;
    for (size_t i = 0; i < define_count; i++) {
        arguments[count++] = "-D";
        arguments[count++] = defines[i];
    }
    arguments[count] = input;
    return (char **)arguments;
}

/* --- the process ---------------------------------------------------------------------------------------- */

static void limit(__rlimit_resource_t what, size_t value)
{
    struct rlimit r = {value, value};
    setrlimit(what, &r);
}

/* Never returns. Only calls that are safe between fork and exec. */
static void run_child(const openscad_run *e, char *const *arguments, int pipe_end)
{
    static const int signals[] = {SIGTERM, SIGINT, SIGXCPU, SIGPIPE, SIGQUIT, SIGHUP};
    for (size_t i = 0; i < sizeof signals / sizeof *signals; i++)
        signal(signals[i], SIG_DFL);
    sigset_t none;
    sigemptyset(&none);
    sigprocmask(SIG_SETMASK, &none, NULL);
    setpgid(0, 0);
    prctl(PR_SET_PDEATHSIG, SIGKILL);
    int nowhere = open("/dev/null", O_RDONLY | O_CLOEXEC);
    if (nowhere >= 0)
        dup2(nowhere, STDIN_FILENO);
    dup2(pipe_end, STDOUT_FILENO);
    dup2(pipe_end, STDERR_FILENO);
    limit(RLIMIT_CORE, 0);
    limit(RLIMIT_CPU, LIMIT_SCAD_SECONDS);
    limit(RLIMIT_AS, LIMIT_IMPORT_MEMORY);
    execv(e->program, arguments);
    _exit(127);
}

static lmn_status start(openscad_run *e, const char *path, const char *const *defines, size_t define_count)
{
    /* A name must not be taken for an option. */
    char   input[OPENSCAD_PATH_CAPACITY];
    int    ends[2], size = snprintf(input, sizeof input, "%s%s", path[0] == '-' ? "./" : "", path);
    char **arguments = make_arguments(e, input, defines, define_count);
    if (!arguments)
        return error_memory(e->error);
    if (size >= (int)sizeof input || pipe2(ends, O_CLOEXEC) != 0) {
        mem_free(arguments);
        return error_in_file(e->error, LMN_INTERNAL, e->job->path, 0, "openscad cannot be started");
    }
    e->id = fork();
    if (e->id == 0)
        run_child(e, arguments, ends[1]);
    mem_free(arguments);
    close(ends[1]);
    e->pipe = ends[0];
    if (e->id > 0) {
        setpgid(e->id, e->id); /* whichever of the two comes first */
        return LMN_OK;
    }
    close(ends[0]);
    return error_in_file(e->error, LMN_MEMORY, e->job->path, 0, "openscad cannot be started: %s", strerror(errno));
}

/* Text beyond the room is read and forgotten. True at the end. */
static bool read_some(openscad_run *e)
{
    char    bytes[4096];
    ssize_t got = read(e->pipe, bytes, sizeof bytes);
    if (got < 0)
        return errno != EINTR && errno != EAGAIN;
    size_t capacity = OPENSCAD_SAID_MAX - e->said_size, kept = (size_t)got < capacity ? (size_t)got : capacity;
    memcpy(e->said + e->said_size, bytes, kept);
    e->said_size += kept;
    return got == 0;
}

static lmn_status wait_for(openscad_run *e)
{
    double     end = clock_ms() + 1000.0 * LIMIT_SCAD_SECONDS;
    bool       ended = false;
    lmn_status status = LMN_OK;
    while (status == LMN_OK && !ended && !e->timed_out) {
        struct pollfd wait = {.fd = e->pipe, .events = POLLIN};
        if (poll(&wait, 1, POLL_MS) > 0)
            ended = read_some(e);
        status = import_progress(e->job, 0.05, "openscad", e->error);
        e->timed_out = clock_ms() > end;
    }
    /* It may close its output and go on. */
    while (ended && status == LMN_OK && !e->timed_out) {
        pid_t gone = waitpid(e->id, &e->status, WNOHANG);
        if (gone == e->id || (gone < 0 && errno != EINTR))
            break;
        poll(NULL, 0, POLL_MS);
        status = import_progress(e->job, 0.05, "openscad", e->error);
        e->timed_out = clock_ms() > end;
        ended = !e->timed_out && status == LMN_OK;
    }
    close(e->pipe);
    if (!ended) {
        kill(-e->id, SIGKILL);
        while (waitpid(e->id, &e->status, 0) < 0 && errno == EINTR)
            ;
    }
    return status;
}

lmn_status openscad_evaluate(openscad_run *e, const char *input, const char *const *defines, size_t define_count)
{
    lmn_status status = start(e, input, defines, define_count);
    return status == LMN_OK ? wait_for(e) : status;
}

/* --- what it says --------------------------------------------------------------------------------------- */

void openscad_each_line(const openscad_run *e, const char *word, void (*use)(const openscad_run *e, const char *line))
{
    const char *at = e->said;
    while (*at) {
        size_t length = strcspn(at, "\n");
        if (strncmp(at, word, strlen(word)) == 0) {
            char *line = scene_clean_name(at, length);
            if (line)
                use(e, line);
            mem_free(line);
        }
        at += length + (at[length] == '\n');
    }
}

bool openscad_was_stopped(const openscad_run *e)
{
    return e->timed_out || (WIFSIGNALED(e->status) && WTERMSIG(e->status) == SIGXCPU);
}
