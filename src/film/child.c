#define _GNU_SOURCE
#include "film/child.h"

#include <errno.h>
#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <spawn.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include "base/memory.h"
#include "base/work.h"

enum { POLL_MS = 20, SAID_MAX = 1000, SHOWN_MAX = 300, FIRST_FREE = CHILD_FILE + 1 };

struct child {
    char   name[64];
    pid_t  id;              /* 0: it is gone */
    int    input, messages; /* our ends; −1: closed */
    int    result;          /* as waitpid gives it, once it is gone */
    bool   lost;            /* somebody else took its result */
    char   said[SAID_MAX + 1];
    size_t said_size;
};

bool child_find(char out[CHILD_PATH_CAPACITY], const char *name)
{
    const char *at = getenv("PATH");
    while (at && *at) {
        size_t      length = strcspn(at, ":");
        struct stat facts;
        int         size = snprintf(out, CHILD_PATH_CAPACITY, "%.*s/%s", (int)length, at, name);
        if (length > 0 && size < CHILD_PATH_CAPACITY && *at == '/' && access(out, X_OK) == 0 &&
            stat(out, &facts) == 0 && S_ISREG(facts.st_mode))
            return true;
        at += length + (at[length] == ':');
    }
    return false;
}

/* --- start ---------------------------------------------------------------------------------------------- */

/* The child's ends, and the file: all above the numbers that they get there. */
typedef struct child_ends {
    int input, messages, file;
} child_ends;

static void close_end(int *descriptor)
{
    if (*descriptor >= 0)
        close(*descriptor);
    *descriptor = -1;
}

/* A number that the child's own do not overwrite. */
static bool lift(int *descriptor)
{
    int lifted = fcntl(*descriptor, F_DUPFD_CLOEXEC, FIRST_FREE);
    if (lifted < 0)
        return false;
    close(*descriptor);
    *descriptor = lifted;
    return true;
}

/* A socket instead of a pipe: it can be written to without SIGPIPE. */
static bool open_ends(child *c, child_ends *there, int file)
{
    int  input[2] = {-1, -1}, messages[2] = {-1, -1};
    bool good = socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, input) == 0 && pipe2(messages, O_CLOEXEC) == 0;
    c->input = input[0];
    c->messages = messages[0];
    there->input = input[1];
    there->messages = messages[1];
    there->file = good ? fcntl(file, F_DUPFD_CLOEXEC, FIRST_FREE) : -1;
    return good && there->file >= 0 && lift(&there->input) && lift(&there->messages) &&
           fcntl(c->messages, F_SETFL, O_NONBLOCK) == 0;
}

/* The functions of posix_spawn return what errno says. */
static int set_actions(posix_spawn_file_actions_t *actions, const child_ends *there)
{
    int problem = posix_spawn_file_actions_adddup2(actions, there->input, STDIN_FILENO);
    if (!problem)
        problem = posix_spawn_file_actions_addopen(actions, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
    if (!problem)
        problem = posix_spawn_file_actions_adddup2(actions, there->messages, STDERR_FILENO);
    if (!problem)
        problem = posix_spawn_file_actions_adddup2(actions, there->file, CHILD_FILE);
#if __GLIBC_PREREQ(2, 34)
    if (!problem)
        problem = posix_spawn_file_actions_addclosefrom_np(actions, FIRST_FREE);
#endif
    return problem;
}

static int set_attributes(posix_spawnattr_t *attributes)
{
    sigset_t none, all;
    sigemptyset(&none);
    sigfillset(&all);
    int problem = posix_spawnattr_setsigmask(attributes, &none);
    if (!problem)
        problem = posix_spawnattr_setsigdefault(attributes, &all);
    if (!problem)
        problem = posix_spawnattr_setpgroup(attributes, 0);
    if (!problem)
        problem = posix_spawnattr_setflags(attributes,
                                           POSIX_SPAWN_SETSIGMASK | POSIX_SPAWN_SETSIGDEF | POSIX_SPAWN_SETPGROUP);
    return problem;
}

static int spawn(child *c, const char *program, const char *const *arguments, const child_ends *there)
{
    posix_spawn_file_actions_t actions;
    posix_spawnattr_t          attributes;
    int                        problem = posix_spawn_file_actions_init(&actions);
    if (problem)
        return problem;
    problem = posix_spawnattr_init(&attributes);
    if (!problem) {
        problem = set_actions(&actions, there);
        if (!problem)
            problem = set_attributes(&attributes);
        if (!problem)
            problem = posix_spawn(&c->id, program, &actions, &attributes, (char *const *)arguments, environ);
        posix_spawnattr_destroy(&attributes);
    }
    posix_spawn_file_actions_destroy(&actions);
    if (problem)
        c->id = 0;
    return problem;
}

lmn_status child_start(child **out, const char *program, const char *const *arguments, int file, lmn_error *error)
{
    child_ends there = {-1, -1, -1};
    child     *c = *out = mem_calloc(1, sizeof *c);
    if (!c)
        return error_memory(error);
    snprintf(c->name, sizeof c->name, "%s", arguments[0]);
    int problem = open_ends(c, &there, file) ? spawn(c, program, arguments, &there) : errno;
    close_end(&there.input);
    close_end(&there.messages);
    close_end(&there.file);
    if (!problem)
        return LMN_OK;
    child_kill(out);
    return error_set(error, LMN_WRITE, "%s cannot be started: %s", program, strerror(problem));
}

/* --- what it says --------------------------------------------------------------------------------------- */

/* Of much, the last is kept. */
static void keep_said(child *c, const char *bytes, size_t size)
{
    if (size > SAID_MAX) {
        bytes += size - SAID_MAX;
        size = SAID_MAX;
    }
    size_t over = c->said_size + size > SAID_MAX ? c->said_size + size - SAID_MAX : 0;
    memmove(c->said, c->said + over, c->said_size - over);
    memcpy(c->said + c->said_size - over, bytes, size);
    c->said_size += size - over;
}

/* What is there to read; its end closes ours. */
static void listen_to(child *c)
{
    char bytes[SAID_MAX];
    while (c->messages >= 0) {
        ssize_t got = read(c->messages, bytes, sizeof bytes);
        if (got > 0)
            keep_said(c, bytes, (size_t)got);
        else if (got == 0 || (errno != EINTR && errno != EAGAIN))
            close_end(&c->messages);
        else if (errno == EAGAIN)
            return;
    }
}

/* The last lines as one, without what a terminal would not show. */
static void last_words(const child *c, char out[SHOWN_MAX + 1])
{
    size_t begin = c->said_size > SHOWN_MAX ? c->said_size - SHOWN_MAX : 0, size = 0;
    if (begin > 0) /* whole lines, where there are any */
        for (size_t i = begin; i < c->said_size; i++)
            if (c->said[i] == '\n' && i + 1 < c->said_size) {
                begin = i + 1;
                break;
            }
    for (size_t i = begin; i < c->said_size; i++) {
        char one = c->said[i];
        bool blank = one == '\n' || one == '\r' || one == '\t' || one == ' ';
        if (blank && size > 0 && out[size - 1] != ' ')
            out[size++] = ' ';
        else if (!blank && (unsigned char)one >= ' ' && one != 127)
            out[size++] = one;
    }
    while (size > 0 && out[size - 1] == ' ')
        size--;
    out[size] = '\0';
}

/* --- how it ends ---------------------------------------------------------------------------------------- */

/* Is it gone? `wait`: not before. */
static bool is_gone(child *c, bool wait)
{
    while (c->id > 0) {
        pid_t gone = waitpid(c->id, &c->result, wait ? 0 : WNOHANG);
        if (gone == 0)
            return false;
        if (gone < 0 && errno == EINTR)
            continue;
        c->lost = gone < 0;
        c->id = 0;
    }
    return true;
}

static lmn_status explain(const child *c, lmn_error *error)
{
    char words[SHOWN_MAX + 1], how[96];
    last_words(c, words);
    if (c->lost)
        snprintf(how, sizeof how, "ended, and its result is lost, since this process ignores SIGCHLD");
    else if (WIFSIGNALED(c->result))
        snprintf(how, sizeof how, "was ended by signal %d (%.60s)", WTERMSIG(c->result),
                 strsignal(WTERMSIG(c->result)));
    else if (WEXITSTATUS(c->result) != 0)
        snprintf(how, sizeof how, "failed with exit status %d", WEXITSTATUS(c->result));
    else
        snprintf(how, sizeof how, "did not do all");
    return error_set(error, LMN_WRITE, "%s %s%s%s", c->name, how, *words ? ": " : "", words);
}

/* It takes no more, or wrote that something went wrong: what was it? */
static lmn_status wait_for_end(child *c, lmn_error *error)
{
    lmn_status status = LMN_OK;
    while (!is_gone(c, false)) {
        struct pollfd wait = {.fd = c->messages, .events = POLLIN};
        poll(&wait, 1, POLL_MS);
        listen_to(c);
        status = work_check(error);
        if (status != LMN_OK)
            return status;
    }
    listen_to(c);
    return LMN_OK;
}

lmn_status child_write(child *c, const void *bytes, size_t size, lmn_error *error)
{
    const unsigned char *at = bytes;
    lmn_status           status = LMN_OK;
    while (size > 0 && (status = work_check(error)) == LMN_OK) {
        struct pollfd wait[2] = {{.fd = c->input, .events = POLLOUT}, {.fd = c->messages, .events = POLLIN}};
        if (poll(wait, 2, POLL_MS) <= 0)
            continue;
        if (wait[1].revents)
            listen_to(c);
        if (!wait[0].revents)
            continue;
        ssize_t put = send(c->input, at, size, MSG_NOSIGNAL | MSG_DONTWAIT);
        if (put > 0) {
            at += put;
            size -= (size_t)put;
        } else if (put < 0 && errno != EINTR && errno != EAGAIN) {
            close_end(&c->input);
            status = wait_for_end(c, error);
            return status == LMN_OK ? explain(c, error) : status;
        }
    }
    return status;
}

lmn_status child_end(child *c, lmn_error *error)
{
    close_end(&c->input);
    lmn_status status = wait_for_end(c, error);
    if (status != LMN_OK)
        return status;
    /* ffmpeg 5 is content when the disk is full at the last moment, and says so. */
    c->said[c->said_size] = '\0';
    return !strstr(c->said, "Error ") && !c->lost && WIFEXITED(c->result) && WEXITSTATUS(c->result) == 0
               ? LMN_OK
               : explain(c, error);
}

void child_kill(child **handle)
{
    child *c = handle ? *handle : NULL;
    if (!c)
        return;
    if (c->id > 0)
        kill(-c->id, SIGKILL); /* and what it has started itself */
    is_gone(c, true);
    close_end(&c->input);
    close_end(&c->messages);
    mem_free(c);
    *handle = NULL;
}
