#define _GNU_SOURCE
#include "base/file_store.h"

#include <ctype.h>
#include <errno.h>
#include <fcntl.h>
#include <limits.h>
#include <poll.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <time.h>
#include <unistd.h>

#include "base/file.h"
#include "base/file_temporary.h"
#include "base/memory.h"
#include "base/work.h"

enum { WAIT_MS = 20, PIECE_MOST = 1 << 26, PIPE_PIECE_MOST = 4096, LINKS_MOST = 40, TRIES = 100, COPY_PIECE = 1 << 16 };

/* Asked between waits, so each time. */
static bool is_stopped(void)
{
    return work_check(NULL) != LMN_OK;
}

/* --- signals -------------------------------------------------------------------------------------------- */

static const int write_signals[] = {SIGXFSZ, SIGPIPE};

enum { WRITE_SIGNALS = sizeof write_signals / sizeof *write_signals };

/* Both are sent to the thread that writes: it alone blocks them, and takes back what came meanwhile. */
typedef struct signal_guard {
    sigset_t before;
    bool     was_pending[WRITE_SIGNALS];
} signal_guard;

static void guard_begin(signal_guard *g)
{
    sigset_t blocked, pending;
    sigemptyset(&blocked);
    sigemptyset(&pending);
    sigpending(&pending);
    for (int i = 0; i < WRITE_SIGNALS; i++) {
        g->was_pending[i] = sigismember(&pending, write_signals[i]) == 1;
        sigaddset(&blocked, write_signals[i]);
    }
    pthread_sigmask(SIG_BLOCK, &blocked, &g->before);
}

static void guard_end(const signal_guard *g)
{
    const struct timespec at_once = {0, 0};
    for (int i = 0; i < WRITE_SIGNALS; i++) {
        sigset_t one;
        sigemptyset(&one);
        sigaddset(&one, write_signals[i]);
        while (!g->was_pending[i] && sigtimedwait(&one, NULL, &at_once) < 0 && errno == EINTR)
            ;
    }
    pthread_sigmask(SIG_SETMASK, &g->before, NULL);
}

/* --- bytes: functions here return 0 or what errno says -------------------------------------------------- */

/* May a write last until somebody reads? */
static bool may_wait(int descriptor)
{
    struct stat facts;
    return fstat(descriptor, &facts) == 0 && !S_ISREG(facts.st_mode) && !S_ISBLK(facts.st_mode);
}

static int wait_for_room(int descriptor)
{
    struct pollfd wait = {.fd = descriptor, .events = POLLOUT};
    while (!is_stopped()) {
        int ready = poll(&wait, 1, WAIT_MS);
        if (ready > 0)
            return 0;
        if (ready < 0 && errno != EINTR)
            return errno;
    }
    return ECANCELED;
}

/* A pipe that has room takes this much without waiting, whether or not it was opened to wait. */
static int write_pieces(int descriptor, const unsigned char *bytes, size_t size)
{
    bool   waits = may_wait(descriptor);
    size_t most = waits ? PIPE_PIECE_MOST : PIECE_MOST;
    while (size > 0) {
        int problem = waits ? wait_for_room(descriptor) : is_stopped() ? ECANCELED : 0;
        if (problem)
            return problem;
        ssize_t put = write(descriptor, bytes, size < most ? size : most);
        if (put < 0 && (errno == EINTR || errno == EAGAIN))
            continue;
        if (put <= 0)
            return put < 0 ? errno : EIO;
        bytes += put;
        size -= (size_t)put;
    }
    return 0;
}

static int write_all(int descriptor, const void *data, size_t size)
{
    signal_guard guard;
    guard_begin(&guard);
    int problem = write_pieces(descriptor, data, size);
    guard_end(&guard);
    return problem;
}

/* Some file systems cannot wait for their disk, and need not. */
static int sync_file(int descriptor)
{
    while (fsync(descriptor) != 0) {
        if (errno == EINVAL || errno == ENOTSUP || errno == ENOSYS)
            return 0;
        if (errno != EINTR)
            return errno;
    }
    return 0;
}

/* --- straight to where it goes -------------------------------------------------------------------------- */

static lmn_status refuse(lmn_error *error, const char *path, int problem)
{
    if (problem == ECANCELED)
        return error_in_file(error, LMN_CANCELLED, path, 0, "cancelled while it was written");
    if (problem == ENOMEM)
        return error_memory(error);
    if (problem == ESPIPE)
        return error_in_file(error, LMN_WRITE, path, 0, "this is a pipe or a device, and a file is needed");
    lmn_status status = error_in_file(error, LMN_WRITE, path, 0, "cannot write: %s", strerror(problem));
    if (problem == ENOENT || problem == ENOTDIR || problem == EACCES || problem == EROFS)
        error_hint(error, "give a path in a folder that exists and may be written");
    return status;
}

static lmn_status report(lmn_error *error, const char *path, int problem)
{
    return problem ? refuse(error, path, problem) : LMN_OK;
}

/* The descriptor that a path means, as /dev/stdout does; −1: none. It belongs to whoever opened it: opened anew it
 * would be written from its beginning. */
static int descriptor_of(const char *path)
{
    static const char *const folders[] = {"/dev/fd/", "/proc/self/fd/"};
    if (strcmp(path, "/dev/stdout") == 0)
        return STDOUT_FILENO;
    if (strcmp(path, "/dev/stderr") == 0)
        return STDERR_FILENO;
    for (size_t i = 0; i < sizeof folders / sizeof *folders; i++) {
        const char *number = path + strlen(folders[i]);
        if (strncmp(path, folders[i], strlen(folders[i])) == 0 && isdigit((unsigned char)*number) &&
            strlen(number) <= 6 && number[strspn(number, "0123456789")] == '\0')
            return (int)strtol(number, NULL, 10);
    }
    return -1;
}

/* A pipe cannot be opened before somebody reads it: that is waited for here, where the wait can be ended. */
static int open_straight(const char *path, bool pipe, int *descriptor)
{
    for (;;) {
        *descriptor = open(path, O_WRONLY | O_NONBLOCK | O_NOCTTY | O_CLOEXEC);
        if (*descriptor >= 0)
            return 0;
        if (errno != EINTR && !(pipe && errno == ENXIO))
            return errno;
        if (is_stopped())
            return ECANCELED;
        poll(NULL, 0, WAIT_MS);
    }
}

static int store_straight(const char *path, bool pipe, const void *data, size_t size)
{
    int descriptor, problem = open_straight(path, pipe, &descriptor);
    if (problem)
        return problem;
    problem = write_all(descriptor, data, size);
    return close(descriptor) != 0 && !problem && errno != EINTR ? errno : problem;
}

/* --- under a name that it gets when it is whole --------------------------------------------------------- */

typedef struct arrival {
    int         folder, descriptor;              /* open */
    const char *name;                            /* of the file in its folder */
    char        beside[TEMPORARY_NAME_CAPACITY]; /* the name that it has until then; empty: none */
    bool        replaces;                        /* something has the name already */
    mode_t      mode;                            /* what that allows; else of new files, less the process's mask */
    bool        lasting;                         /* on the disk before it gets its name */
} arrival;

static int open_beside(arrival *a)
{
    char stem[TEMPORARY_NAME_CAPACITY];
    snprintf(stem, sizeof stem, ".%.190s.", a->name);
    for (int i = 0; i < TRIES; i++) {
        temporary_name(a->beside, stem);
        a->descriptor = openat(a->folder, a->beside, O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, a->mode);
        if (a->descriptor >= 0)
            return 0;
        if (errno != EEXIST)
            break;
    }
    a->beside[0] = '\0';
    return errno;
}

static int fill(const arrival *a, const void *data, size_t size)
{
    int problem = write_all(a->descriptor, data, size);
    /* The process's mask took from it what the file before allowed. Where that cannot be given back, less is
     * allowed, not more. */
    if (!problem && a->replaces && fchmod(a->descriptor, a->mode) != 0)
        problem = errno == EPERM || errno == ENOTSUP ? 0 : errno;
    return !problem && a->lasting ? sync_file(a->descriptor) : problem;
}

/* Gives a file without a name one beside its own. */
static int link_beside(arrival *a, const char *unnamed)
{
    char stem[TEMPORARY_NAME_CAPACITY];
    snprintf(stem, sizeof stem, ".%.190s.", a->name);
    for (int i = 0; i < TRIES; i++) {
        temporary_name(a->beside, stem);
        if (linkat(AT_FDCWD, unnamed, a->folder, a->beside, AT_SYMLINK_FOLLOW) == 0)
            return 0;
        if (errno != EEXIST)
            break;
    }
    a->beside[0] = '\0';
    return errno;
}

/* A link cannot take the place of what is there; a renamed file can. */
static int rename_beside(arrival *a)
{
    if (renameat(a->folder, a->beside, a->folder, a->name) != 0)
        return errno;
    a->beside[0] = '\0';
    return 0;
}

static int name_unnamed(arrival *a)
{
    char unnamed[48];
    snprintf(unnamed, sizeof unnamed, "/proc/self/fd/%d", a->descriptor);
    if (!a->replaces) {
        if (linkat(AT_FDCWD, unnamed, a->folder, a->name, AT_SYMLINK_FOLLOW) == 0)
            return 0;
        if (errno != EEXIST)
            return errno;
    }
    int problem = link_beside(a, unnamed);
    return problem ? problem : rename_beside(a);
}

/* A file without a name leaves nothing behind, however the process ends. `*cannot`: this file system has none, or
 * without /proc it gets none. */
static int arrive_unnamed(arrival *a, const void *data, size_t size, bool *cannot)
{
    a->descriptor = openat(a->folder, ".", O_WRONLY | O_TMPFILE | O_CLOEXEC, a->mode);
    *cannot = a->descriptor < 0;
    if (*cannot)
        return errno;
    int problem = fill(a, data, size);
    if (!problem) {
        problem = name_unnamed(a);
        *cannot = problem && !a->beside[0];
    }
    close(a->descriptor);
    return problem;
}

static int arrive_beside(arrival *a, const void *data, size_t size)
{
    int problem = open_beside(a);
    if (problem)
        return problem;
    problem = fill(a, data, size);
    if (close(a->descriptor) != 0 && !problem && errno != EINTR)
        problem = errno;
    return problem ? problem : rename_beside(a);
}

static int open_folder(const char *path, const char *name)
{
    char *folder = path == name ? mem_copy_text(".") : mem_copy_text(path);
    if (!folder) {
        errno = ENOMEM;
        return -1;
    }
    if (path != name)
        folder[name - path] = '\0';
    int descriptor = open(folder, O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    if (descriptor < 0 && errno == EACCES) /* one that may be written and not listed */
        descriptor = open(folder, O_PATH | O_DIRECTORY | O_CLOEXEC);
    int problem = errno;
    mem_free(folder);
    errno = problem;
    return descriptor;
}

/* `facts`: of what is replaced, or NULL. */
static int store_named(const char *path, const struct stat *facts, bool lasting, const void *data, size_t size)
{
    const char *slash = strrchr(path, '/');
    arrival     a = {.name = slash ? slash + 1 : path,
                     .replaces = facts != NULL,
                     .mode = facts && S_ISREG(facts->st_mode) ? facts->st_mode & 0777 : 0666,
                     .lasting = lasting};
    if (!*a.name)
        return *path ? EISDIR : ENOENT;
    a.folder = open_folder(path, a.name);
    if (a.folder < 0)
        return errno;
    temporary_sweep(a.folder);
    bool cannot = false;
    int  problem = arrive_unnamed(&a, data, size, &cannot);
    if (cannot)
        problem = arrive_beside(&a, data, size);
    if (a.beside[0])
        unlinkat(a.folder, a.beside, 0);
    /* The name itself; when that fails the file is as good as one that was written without. */
    if (!problem && lasting)
        sync_file(a.folder);
    close(a.folder);
    return problem;
}

/* --- links ---------------------------------------------------------------------------------------------- */

/* May this link be followed? Not one that somebody else laid into a folder where anybody may (as the kernel has it
 * for links that lead somewhere). */
static bool is_trusted(const char *path, const struct stat *link)
{
    struct stat folder;
    char       *around = file_beside(path, ".");
    bool        known = around && stat(around, &folder) == 0;
    mem_free(around);
    return known && (link->st_uid == geteuid() || link->st_uid == folder.st_uid || !(folder.st_mode & S_ISVTX) ||
                     !(folder.st_mode & S_IWOTH));
}

/* Where a path leads at last, whether or not anything is there. A link stays a link: what it names is what is
 * written. */
static int follow_links(char **out, const char *path)
{
    struct stat facts;
    char        target[PATH_MAX];
    *out = mem_copy_text(path);
    for (int i = 0; *out && descriptor_of(*out) < 0 && lstat(*out, &facts) == 0 && S_ISLNK(facts.st_mode); i++) {
        ssize_t length = i < LINKS_MOST ? readlink(*out, target, sizeof target - 1) : -1;
        if (length < 0)
            return i < LINKS_MOST ? errno : ELOOP;
        if (!is_trusted(*out, &facts))
            return EACCES;
        target[length] = '\0';
        char *next = file_beside(*out, target);
        mem_free(*out);
        *out = next;
    }
    return *out ? 0 : ENOMEM;
}

static int store_at(const char *path, const void *data, size_t size)
{
    struct stat facts;
    int         descriptor = descriptor_of(path);
    if (descriptor >= 0)
        return write_all(descriptor, data, size);
    bool exists = stat(path, &facts) == 0;
    if (exists && S_ISDIR(facts.st_mode))
        return EISDIR;
    if (exists && !S_ISREG(facts.st_mode))
        return store_straight(path, S_ISFIFO(facts.st_mode), data, size);
    return store_named(path, exists ? &facts : NULL, true, data, size);
}

lmn_status file_store(const char *path, const void *data, size_t size, lmn_error *error)
{
    if (strcmp(path, "-") == 0)
        return report(error, "standard output", write_all(STDOUT_FILENO, data, size));
    char *end = NULL;
    int   problem = follow_links(&end, path);
    if (!problem)
        problem = store_at(end, data, size);
    mem_free(end);
    return report(error, path, problem);
}

lmn_status file_replace(const char *path, const void *data, size_t size, lmn_error *error)
{
    struct stat facts;
    bool        exists = lstat(path, &facts) == 0;
    return report(error, path, store_named(path, exists ? &facts : NULL, false, data, size));
}

/* --- piece by piece ------------------------------------------------------------------------------------- */

struct file_arrival {
    char   *given, *end; /* the path as it was said, and where it leads */
    arrival at;          /* its name lies in `end` */
};

/* A file system may have no files without a name, and without /proc they get none later. Until the end its owner can
 * read and write it, whatever the file before allowed, since a child process opens it anew. */
static int open_arrival(arrival *a)
{
    char   unnamed[48];
    mode_t mode = a->mode;
    a->mode |= S_IRUSR | S_IWUSR;
    a->descriptor = openat(a->folder, ".", O_RDWR | O_TMPFILE | O_CLOEXEC, a->mode);
    snprintf(unnamed, sizeof unnamed, "/proc/self/fd/%d", a->descriptor);
    if (a->descriptor >= 0 && access(unnamed, F_OK) != 0) {
        close(a->descriptor);
        a->descriptor = -1;
    }
    int problem = a->descriptor >= 0 ? 0 : open_beside(a);
    a->mode = mode;
    return problem;
}

static int begin_arrival(file_arrival *a)
{
    struct stat facts;
    int         problem = follow_links(&a->end, a->given);
    if (problem)
        return problem;
    bool exists = stat(a->end, &facts) == 0;
    if (descriptor_of(a->end) >= 0 || (exists && !S_ISREG(facts.st_mode)))
        return exists && S_ISDIR(facts.st_mode) ? EISDIR : ESPIPE;
    const char *slash = strrchr(a->end, '/');
    a->at.name = slash ? slash + 1 : a->end;
    a->at.replaces = exists;
    a->at.mode = exists ? facts.st_mode & 0777 : 0666;
    if (!*a->at.name)
        return *a->end ? EISDIR : ENOENT;
    a->at.folder = open_folder(a->end, a->at.name);
    if (a->at.folder < 0)
        return errno;
    temporary_sweep(a->at.folder);
    return open_arrival(&a->at);
}

lmn_status file_arrival_begin(file_arrival **out, const char *path, lmn_error *error)
{
    file_arrival *a = *out = mem_calloc(1, sizeof *a);
    if (!a)
        return error_memory(error);
    a->at = (arrival){.folder = -1, .descriptor = -1, .lasting = true};
    a->given = mem_copy_text(path);
    int problem = a->given ? begin_arrival(a) : ENOMEM;
    if (!problem)
        return LMN_OK;
    file_arrival_drop(out);
    return refuse(error, path, problem);
}

int file_arrival_descriptor(const file_arrival *a)
{
    return a->at.descriptor;
}

lmn_status file_arrival_write(file_arrival *a, const void *data, size_t size, lmn_error *error)
{
    return report(error, a->given, write_all(a->at.descriptor, data, size));
}

static int copy_all(int from, int to)
{
    unsigned char *piece = mem_alloc(COPY_PIECE);
    int            problem = piece ? 0 : ENOMEM;
    for (off_t at = 0; !problem;) {
        ssize_t got = pread(from, piece, COPY_PIECE, at);
        if (got == 0)
            break;
        if (got < 0 && errno == EINTR)
            continue;
        problem = got < 0 ? errno : write_all(to, piece, (size_t)got);
        at += got;
    }
    mem_free(piece);
    return problem;
}

/* Not every file system that has files without a name gives them one. */
static int name_copy(arrival *a)
{
    int unnamed = a->descriptor, problem = open_beside(a);
    if (problem) {
        a->descriptor = unnamed;
        return problem;
    }
    problem = copy_all(unnamed, a->descriptor);
    close(unnamed);
    if (!problem)
        problem = fill(a, "", 0);
    return problem ? problem : rename_beside(a);
}

static int name_arrival(arrival *a)
{
    if (a->beside[0])
        return rename_beside(a);
    int problem = name_unnamed(a);
    return problem && !a->beside[0] ? name_copy(a) : problem;
}

lmn_status file_arrival_end(file_arrival **handle, uint64_t *bytes, lmn_error *error)
{
    file_arrival *a = *handle;
    struct stat   facts;
    int           problem = fill(&a->at, "", 0);
    if (!problem && fstat(a->at.descriptor, &facts) == 0 && bytes)
        *bytes = (uint64_t)facts.st_size;
    if (!problem)
        problem = name_arrival(&a->at);
    if (!problem)
        sync_file(a->at.folder);
    lmn_status status = report(error, a->given, problem);
    file_arrival_drop(handle);
    return status;
}

void file_arrival_drop(file_arrival **handle)
{
    file_arrival *a = handle ? *handle : NULL;
    if (!a)
        return;
    if (a->at.beside[0])
        unlinkat(a->at.folder, a->at.beside, 0);
    if (a->at.descriptor >= 0)
        close(a->at.descriptor);
    if (a->at.folder >= 0)
        close(a->at.folder);
    mem_free(a->end);
    mem_free(a->given);
    mem_free(a);
    *handle = NULL;
}

lmn_status file_make_folder(const char *path, lmn_error *error)
{
    char *part = mem_copy_text(path);
    if (!part)
        return error_memory(error);
    for (char *at = part + 1;; at++) {
        if (*at != '/' && *at != '\0')
            continue;
        char kept = *at;
        *at = '\0';
        if (mkdir(part, 0777) != 0 && errno != EEXIST) {
            lmn_status status = error_in_file(error, LMN_WRITE, part, 0, "cannot make the folder: %s", strerror(errno));
            mem_free(part);
            return status;
        }
        *at = kept;
        if (kept == '\0')
            break;
    }
    mem_free(part);
    struct stat facts;
    if (stat(path, &facts) != 0 || !S_ISDIR(facts.st_mode))
        return error_in_file(error, LMN_WRITE, path, 0, "this is not a folder");
    return LMN_OK;
}
