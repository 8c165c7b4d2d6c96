/* Loaded before a program (LD_PRELOAD), this library makes one call to the system fail, chosen by the environment:
 *   FAULT=write:17          the 17th write that Limner itself makes fails
 *   FAULT=write:17+         that and all later ones
 *   FAULT=write:17:EINTR    with this error (EINTR, EIO, ENOSPC, ENOMEM, EAGAIN, or `short`: half of the bytes and no
 * error) FAULT_ALL=1             calls that libraries make count too FAULT_TRACE=1           where it was called from
 * goes to standard error FAULT_REPORT=FILE       when the program ends, how many calls of each there were, a line each
 * Calls from inside the C library itself (fwrite, getline) are not seen. Of OpenGL and EGL those fail that libepoxy
 * looks up: their names are theirs. */
#define _GNU_SOURCE
#include <dirent.h>
#include <dlfcn.h>
#include <errno.h>
#include <execinfo.h>
#include <fcntl.h>
#include <link.h>
#include <pthread.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <unistd.h>

#include "faults.h"

/* State of the process; everything here is called from everywhere. */
static struct {
    long        counts[CALLS];
    int         chosen;
    long        at;
    bool        later, all, halves, trace, ready;
    int         problem;
    pid_t       process;
    const char *report;
    uintptr_t   begin[2], end[2]; /* where the program's and the library's code lies */
} state = {.chosen = -1};

const char *const call_names[CALLS] = {
#define CALL(name) #name,
    ALL_CALLS
#undef CALL
};

static int note_code(struct dl_phdr_info *info, size_t size, void *user)
{
    (void)size;
    int *first = user;
    bool library = strstr(info->dlpi_name, "liblimner.so") != NULL;
    if (library || *first)
        for (int i = 0; i < info->dlpi_phnum; i++)
            if (info->dlpi_phdr[i].p_type == PT_LOAD && info->dlpi_phdr[i].p_flags & PF_X) {
                state.begin[library] = info->dlpi_addr + info->dlpi_phdr[i].p_vaddr;
                state.end[library] = state.begin[library] + info->dlpi_phdr[i].p_memsz;
            }
    *first = 0;
    return 0;
}

static int problem_of(const char *name)
{
    static const struct {
        const char *name;
        int         value;
    } problems[] = {{"EINTR", EINTR}, {"EIO", EIO}, {"ENOSPC", ENOSPC}, {"ENOMEM", ENOMEM}, {"EAGAIN", EAGAIN}};
    for (size_t i = 0; i < sizeof problems / sizeof *problems; i++)
        if (strcmp(name, problems[i].name) == 0)
            return problems[i].value;
    return 0;
}

__attribute__((constructor)) static void begin(void)
{
    int         first = 1;
    const char *fault = getenv("FAULT");
    dl_iterate_phdr(note_code, &first);
    state.process = getpid();
    state.all = getenv("FAULT_ALL") != NULL;
    state.trace = getenv("FAULT_TRACE") != NULL;
    state.report = getenv("FAULT_REPORT");
    const char *colon = fault ? strchr(fault, ':') : NULL;
    for (int i = 0; i < CALLS && colon; i++)
        if (strlen(call_names[i]) == (size_t)(colon - fault) &&
            strncmp(call_names[i], fault, (size_t)(colon - fault)) == 0)
            state.chosen = i;
    if (colon) {
        char *rest;
        state.at = strtol(colon + 1, &rest, 10);
        state.later = *rest == '+';
        rest += state.later;
        state.halves = strcmp(rest, ":short") == 0;
        state.problem = *rest == ':' ? problem_of(rest + 1) : 0;
    }
    state.ready = true;
}

__attribute__((destructor)) static void end(void)
{
    if (!state.report || getpid() != state.process)
        return;
    FILE *file = fopen(state.report, "w");
    if (!file)
        return;
    for (int i = 0; i < CALLS; i++)
        fprintf(file, "%s %ld\n", call_names[i], state.counts[i]);
    fclose(file);
}

/* Counts a call; true when it is the one to fail. `caller` NULL: of OpenGL, which only Limner calls. */
static bool fails(int call, const void *caller, int usual)
{
    const uintptr_t position = (uintptr_t)caller;
    const bool      ours = !caller || (position >= state.begin[0] && position < state.end[0]) ||
                      (position >= state.begin[1] && position < state.end[1]);
    if (!state.ready || (!ours && !state.all))
        return false;
    const long n = __atomic_add_fetch(&state.counts[call], 1, __ATOMIC_RELAXED);
    if (call != state.chosen || (state.later ? n < state.at : n != state.at))
        return false;
    if (state.trace) {
        void *frames[24];
        state.ready = false;
        backtrace_symbols_fd(frames, backtrace(frames, 24), STDERR_FILENO);
        state.ready = true;
    }
    errno = state.problem ? state.problem : usual;
    return true;
}

#define CALLER     __builtin_return_address(0)
#define REAL(name) ((__typeof__(&name))next(#name))

/* dlsym is among what is replaced below. */
static void *next(const char *name)
{
    static void *(*look_up)(void *, const char *);
    if (!look_up)
        look_up = (void *(*)(void *, const char *))dlvsym(RTLD_NEXT, "dlsym", "GLIBC_2.2.5");
    return look_up(RTLD_NEXT, name);
}

/* --- memory: the C library has other names for its own -------------------------------------------------- */

extern void *__libc_malloc(size_t size);
extern void *__libc_calloc(size_t count, size_t size);
extern void *__libc_realloc(void *block, size_t size);

void *malloc(size_t size)
{
    return fails(CALL_malloc, CALLER, ENOMEM) ? NULL : __libc_malloc(size);
}

void *calloc(size_t count, size_t size)
{
    return fails(CALL_malloc, CALLER, ENOMEM) ? NULL : __libc_calloc(count, size);
}

void *realloc(void *block, size_t size)
{
    return fails(CALL_malloc, CALLER, ENOMEM) ? NULL : __libc_realloc(block, size);
}

/* --- files ---------------------------------------------------------------------------------------------- */

ssize_t read(int descriptor, void *out, size_t size)
{
    if (fails(CALL_read, CALLER, EIO)) {
        if (!state.halves)
            return -1;
        size = size / 2 + size % 2;
    }
    return REAL(read)(descriptor, out, size);
}

ssize_t write(int descriptor, const void *bytes, size_t size)
{
    if (fails(CALL_write, CALLER, ENOSPC)) {
        if (!state.halves)
            return -1;
        size = size / 2 + size % 2;
    }
    return REAL(write)(descriptor, bytes, size);
}

ssize_t send(int channel, const void *bytes, size_t size, int flags)
{
    if (fails(CALL_send, CALLER, EPIPE)) {
        if (!state.halves)
            return -1;
        size = size / 2 + size % 2;
    }
    return REAL(send)(channel, bytes, size, flags);
}

ssize_t recv(int channel, void *out, size_t size, int flags)
{
    if (fails(CALL_recv, CALLER, ECONNRESET)) {
        if (!state.halves)
            return -1;
        size = size / 2 + size % 2;
    }
    return REAL(recv)(channel, out, size, flags);
}

#define OPEN(name)                                                                                                     \
    int name(const char *path, int flags, ...)                                                                         \
    {                                                                                                                  \
        va_list more;                                                                                                  \
        va_start(more, flags);                                                                                         \
        const mode_t mode = va_arg(more, mode_t);                                                                      \
        va_end(more);                                                                                                  \
        return fails(CALL_open, CALLER, EMFILE) ? -1 : REAL(name)(path, flags, mode);                                  \
    }
OPEN(open)
OPEN(open64)

int openat(int folder, const char *path, int flags, ...)
{
    va_list more;
    va_start(more, flags);
    const mode_t mode = va_arg(more, mode_t);
    va_end(more);
    return fails(CALL_open, CALLER, EMFILE) ? -1 : REAL(openat)(folder, path, flags, mode);
}

FILE *fopen(const char *path, const char *mode)
{
    return fails(CALL_open, CALLER, EMFILE) ? NULL : REAL(fopen)(path, mode);
}

int mkstemp(char *path)
{
    return fails(CALL_open, CALLER, EMFILE) ? -1 : REAL(mkstemp)(path);
}

/* The descriptor is closed all the same, as Linux does. */
int close(int descriptor)
{
    const bool bad = fails(CALL_close, CALLER, EIO);
    const int  problem = errno;
    const int  result = REAL(close)(descriptor);
    if (bad)
        errno = problem;
    return bad ? -1 : result;
}

#define SIMPLE(kind, name, usual, parameters, arguments)                                                               \
    int name parameters                                                                                                \
    {                                                                                                                  \
        return fails(CALL_##kind, CALLER, usual) ? -1 : REAL(name) arguments;                                          \
    }
SIMPLE(fsync, fsync, EIO, (int descriptor), (descriptor))
SIMPLE(fsync, fdatasync, EIO, (int descriptor), (descriptor))
SIMPLE(fsync, fchmod, EPERM, (int descriptor, mode_t mode), (descriptor, mode))
SIMPLE(rename, rename, EXDEV, (const char *from, const char *to), (from, to))
SIMPLE(link, link, EPERM, (const char *from, const char *to), (from, to))
SIMPLE(link, linkat, EPERM, (int a, const char *from, int b, const char *to, int flags), (a, from, b, to, flags))
SIMPLE(mkdir, mkdir, ENOSPC, (const char *path, mode_t mode), (path, mode))
SIMPLE(stat, stat, EIO, (const char *path, struct stat *out), (path, out))
SIMPLE(stat, fstat, EIO, (int descriptor, struct stat *out), (descriptor, out))
SIMPLE(pipe, pipe, EMFILE, (int ends[2]), (ends))
SIMPLE(pipe, pipe2, EMFILE, (int ends[2], int flags), (ends, flags))

void *mmap(void *at, size_t size, int protection, int flags, int descriptor, off_t offset)
{
    return fails(CALL_mmap, CALLER, ENOMEM) ? MAP_FAILED : REAL(mmap)(at, size, protection, flags, descriptor, offset);
}

/* --- processes and threads ------------------------------------------------------------------------------ */

pid_t fork(void)
{
    return fails(CALL_fork, CALLER, EAGAIN) ? -1 : REAL(fork)();
}

int pthread_create(pthread_t *thread, const pthread_attr_t *attributes, void *(*run)(void *), void *user)
{
    return fails(CALL_pthread_create, CALLER, EAGAIN) ? EAGAIN : REAL(pthread_create)(thread, attributes, run, user);
}

/* --- OpenGL: what libepoxy finds is replaced on its way there ------------------------------------------- */

enum { GL_OUT_OF_MEMORY_CODE = 0x0505, GL_UNSUPPORTED = 0x8CDD, GL_COMPILE = 0x8B81, GL_LINK = 0x8B82 };

static void *real[CALLS];
static bool  memory_gone; /* glGetError says so once */

static void *gl_nothing(int call)
{
    return fails(call, NULL, 0) ? NULL : real[call];
}

#define GL_ALLOCATES(name, parameters, arguments)                                                                      \
    static void fail_##name parameters                                                                                 \
    {                                                                                                                  \
        if (gl_nothing(CALL_##name))                                                                                   \
            ((void(*) parameters)real[CALL_##name]) arguments;                                                         \
        else                                                                                                           \
            memory_gone = true;                                                                                        \
    }
GL_ALLOCATES(glTexImage2D, (unsigned a, int b, int c, int d, int e, int f, unsigned g, unsigned h, const void *i),
             (a, b, c, d, e, f, g, h, i))
GL_ALLOCATES(glTexStorage2D, (unsigned a, int b, unsigned c, int d, int e), (a, b, c, d, e))
GL_ALLOCATES(glBufferData, (unsigned a, long b, const void *c, unsigned d), (a, b, c, d))
GL_ALLOCATES(glRenderbufferStorage, (unsigned a, unsigned b, int c, int d), (a, b, c, d))

#define GL_ANSWERS(type, name, wrong, parameters, arguments)                                                           \
    static type fail_##name parameters                                                                                 \
    {                                                                                                                  \
        return gl_nothing(CALL_##name) ? ((type(*) parameters)real[CALL_##name])arguments : wrong;                     \
    }
GL_ANSWERS(unsigned, glCheckFramebufferStatus, GL_UNSUPPORTED, (unsigned a), (a))
GL_ANSWERS(unsigned, glCreateShader, 0, (unsigned a), (a))
GL_ANSWERS(unsigned, glCreateProgram, 0, (void), ())
GL_ANSWERS(void *, glMapBufferRange, NULL, (unsigned a, long b, long c, unsigned d), (a, b, c, d))
GL_ANSWERS(void *, eglCreateContext, NULL, (void *a, void *b, void *c, const int *d), (a, b, c, d))
GL_ANSWERS(unsigned, eglInitialize, 0, (void *a, int *b, int *c), (a, b, c))
GL_ANSWERS(unsigned, eglMakeCurrent, 0, (void *a, void *b, void *c, void *d), (a, b, c, d))
GL_ANSWERS(unsigned, eglBindAPI, 0, (unsigned a), (a))

#define GL_STATUS(name, asked)                                                                                         \
    static void fail_##name(unsigned object, unsigned what, int *out)                                                  \
    {                                                                                                                  \
        const bool bad = what == asked && !gl_nothing(CALL_##name);                                                    \
        ((void (*)(unsigned, unsigned, int *))real[CALL_##name])(object, what, out);                                   \
        if (bad)                                                                                                       \
            *out = 0;                                                                                                  \
    }
GL_STATUS(glGetShaderiv, GL_COMPILE)
GL_STATUS(glGetProgramiv, GL_LINK)

static unsigned fail_glGetError(void)
{
    const bool gone = memory_gone;
    memory_gone = false;
    return gone ? GL_OUT_OF_MEMORY_CODE : ((unsigned (*)(void))real[CALL_glGetError])();
}

static void *replace(const char *name, void *found);

static void *fail_eglGetProcAddress(const char *name)
{
    return replace(name, ((void *(*)(const char *))real[CALL_eglGetProcAddress])(name));
}

static void *replace(const char *name, void *found)
{
    static const struct {
        int   call;
        void *ours;
    } rows[] = {
#define ROW(name) {CALL_##name, (void *)fail_##name}
        ROW(glTexImage2D),          ROW(glTexStorage2D),           ROW(glBufferData),
        ROW(glRenderbufferStorage), ROW(glCheckFramebufferStatus), ROW(glCreateShader),
        ROW(glCreateProgram),       ROW(glMapBufferRange),         ROW(eglCreateContext),
        ROW(eglInitialize),         ROW(eglMakeCurrent),           ROW(eglBindAPI),
        ROW(glGetShaderiv),         ROW(glGetProgramiv),           ROW(glGetError),
        ROW(eglGetProcAddress),
#undef ROW
    };
    for (size_t i = 0; found && i < sizeof rows / sizeof *rows; i++)
        if (strcmp(name, call_names[rows[i].call]) == 0) {
            if (found != rows[i].ours)
                real[rows[i].call] = found;
            return rows[i].ours;
        }
    return found;
}

void *dlsym(void *handle, const char *name)
{
    static void *(*look_up)(void *, const char *);
    if (!look_up)
        look_up = (void *(*)(void *, const char *))dlvsym(RTLD_NEXT, "dlsym", "GLIBC_2.2.5");
    void *found = look_up(handle, name);
    /* Libraries of the driver look each other up too; only libepoxy gets the replacements. */
    Dl_info    caller;
    const bool epoxy = (strncmp(name, "gl", 2) == 0 || strncmp(name, "egl", 3) == 0) && dladdr(CALLER, &caller) &&
                       strstr(caller.dli_fname, "libepoxy");
    return epoxy ? replace(name, found) : found;
}
