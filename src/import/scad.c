/* OpenSCAD programs (.scad): the program `openscad`, when it is on the PATH, evaluates them to .csg in a process
 * group of its own, with a limit on time; a .scad file is a program, and only OpenSCAD knows its language. */
#define _GNU_SOURCE
#include <ctype.h>
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
#include "base/text.h"
#include "import/csg.h"

enum { POLL_MS = 20, SAID_MAX = 1 << 16, PATH_CAPACITY = 4096 };

typedef struct evaluation {
    const import_job *job;
    char              program[PATH_CAPACITY], folder[PATH_CAPACITY], output[PATH_CAPACITY + 16];
    pid_t             id;
    int               pipe;
    char              said[SAID_MAX + 1]; /* what openscad prints */
    size_t            said_size;
    int               status; /* as waitpid gives it */
    bool              timed_out;
    lmn_error        *error;
} evaluation;

/* The first executable file of this name in the PATH. */
static bool find_program(char out[PATH_CAPACITY])
{
    const char *at = getenv("PATH");
    while (at && *at) {
        size_t      length = strcspn(at, ":");
        struct stat facts;
        int         size = snprintf(out, PATH_CAPACITY, "%.*s/openscad", (int)length, at);
        if (length > 0 && size < PATH_CAPACITY && *at == '/' && access(out, X_OK) == 0 && stat(out, &facts) == 0 &&
            S_ISREG(facts.st_mode))
            return true;
        at += length + (at[length] == ':');
    }
    return false;
}

static lmn_status make_folder(evaluation *e)
{
    if (!temporary_folder_make(e->folder, sizeof e->folder))
        return error_in_file(e->error, LMN_WRITE, e->job->path, 0, "no temporary folder can be made: %s",
                             strerror(errno));
    snprintf(e->output, sizeof e->output, "%s/model.csg", e->folder);
    return LMN_OK;
}

/* --- what the program is given -------------------------------------------------------------------------- */

static size_t define_count(const evaluation *e)
{
    return e->job->desc ? e->job->desc->define_count : 0;
}

/* How long the name before '=' is; 0: this is no definition. */
static size_t name_length(const char *define)
{
    size_t length = 0;
    while (isalnum((unsigned char)define[length]) || define[length] == '_' || (length == 0 && define[0] == '$'))
        length++;
    bool named = length > (define[0] == '$') && !isdigit((unsigned char)define[0]);
    return named && define[length] == '=' && define[length + 1] ? length : 0;
}

/* Has the program's own text this word? What it includes is not looked at. */
static bool has_word(const file_data *file, const char *word, size_t length)
{
    const char *begin = (const char *)file->data, *end = begin + file->size;
    for (const char *at = begin; (at = memmem(at, (size_t)(end - at), word, length)) != NULL; at++) {
        char before = at > begin ? at[-1] : ' ', after = at + length < end ? at[length] : ' ';
        if (!isalnum((unsigned char)before) && before != '_' && !isalnum((unsigned char)after) && after != '_')
            return true;
    }
    return false;
}

static lmn_status check_defines(evaluation *e)
{
    const file_data *file = e->job->file;
    bool             alone = !has_word(file, "include", 7) && !has_word(file, "use", 3);
    for (size_t i = 0; i < define_count(e); i++) {
        const char *define = e->job->desc->defines[i];
        size_t      length = define ? name_length(define) : 0;
        if (!length) {
            error_in_file(
                e->error, LMN_USAGE, e->job->path, 0,
                "the definition is '%.80s'; allowed is NAME=VALUE, where the name has letters, digits and '_'",
                define ? define : "");
            error_hint(e->error, "for example -D width=20 or -D 'name=\"lid\"'");
            return LMN_USAGE;
        }
        if (alone && define[0] != '$' && !has_word(file, define, length))
            warnings_add(&e->job->scene->warnings, WARNING_NO_MATCH,
                         "the program has no variable '%.*s' that the definition could change", (int)length, define);
    }
    return LMN_OK;
}

/* openscad's arguments; the caller frees the array. NULL: memory is gone. */
static char **make_arguments(const evaluation *e, const char *input)
{
    size_t       count = 0, defines = define_count(e);
    const char **arguments = mem_calloc(2 * defines + 5, sizeof *arguments);
    if (!arguments)
        return NULL;
    arguments[count++] = "openscad";
    arguments[count++] = "-o";
    arguments[count++] = e->output;
    for (size_t i = 0; i < defines; i++) {
        arguments[count++] = "-D";
        arguments[count++] = e->job->desc->defines[i];
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
static void run_child(const evaluation *e, char *const *arguments, int pipe_end)
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

static lmn_status start(evaluation *e)
{
    /* A name must not be taken for an option. */
    char   input[PATH_CAPACITY];
    int    ends[2], size = snprintf(input, sizeof input, "%s%s", e->job->path[0] == '-' ? "./" : "", e->job->path);
    char **arguments = make_arguments(e, input);
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
static bool read_some(evaluation *e)
{
    char    bytes[4096];
    ssize_t got = read(e->pipe, bytes, sizeof bytes);
    if (got < 0)
        return errno != EINTR && errno != EAGAIN;
    size_t capacity = SAID_MAX - e->said_size, kept = (size_t)got < capacity ? (size_t)got : capacity;
    memcpy(e->said + e->said_size, bytes, kept);
    e->said_size += kept;
    return got == 0;
}

static lmn_status wait_for(evaluation *e)
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

/* --- what it says --------------------------------------------------------------------------------------- */

/* Hands each line that begins with the word to the function. */
static void each_line(const evaluation *e, const char *word, void (*use)(const evaluation *e, const char *line))
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

static void pass_warning(const evaluation *e, const char *line)
{
    warnings_add(&e->job->scene->warnings, WARNING_BAD_VALUE, "openscad: %s", line);
}

/* The program's line, where the message tells one: "… in file model.scad, line 3". What it includes has lines of
 * its own. */
static int line_of(const evaluation *e, const char *message)
{
    const char *own = strrchr(e->job->path, '/'), *at = NULL;
    own = own ? own + 1 : e->job->path;
    size_t length = strlen(own);
    for (const char *next = message; (next = strstr(next, "in file ")) != NULL; next++)
        at = next + 8; /* the last: an assertion's own text may have the words, too */
    const char *comma = at ? strstr(at, ", line ") : NULL;
    long long   number = 0;
    if (!comma || (size_t)(comma - at) < length || strncmp(comma - length, own, length) != 0 ||
        !text_parse_int(comma + 7, message + strlen(message), &number) || number < 0 || number > INT_MAX)
        return 0;
    return (int)number;
}

/* The first one stays. */
static void pass_error(const evaluation *e, const char *line)
{
    if (!e->error->message[0])
        error_in_file(e->error, LMN_FORMAT, e->job->path, line_of(e, line), "openscad: %.400s", line);
}

static lmn_status explain(evaluation *e)
{
    if (e->timed_out || (WIFSIGNALED(e->status) && WTERMSIG(e->status) == SIGXCPU)) {
        error_in_file(e->error, LMN_LIMIT, e->job->path, 0, "openscad took longer than %d s and was stopped",
                      LIMIT_SCAD_SECONDS);
        error_hint(e->error, "evaluate it yourself: openscad -o model.csg model.scad");
        return LMN_LIMIT;
    }
    /* Versions differ in whether a failed assertion fails the program; all of them write what came before it. */
    e->error->message[0] = '\0';
    each_line(e, "ERROR:", pass_error);
    if (!e->error->message[0] && e->job->desc && e->job->desc->strict)
        each_line(e, "WARNING:", pass_error);
    if (e->error->message[0])
        return LMN_FORMAT;
    if (WIFEXITED(e->status) && WEXITSTATUS(e->status) == 0)
        return LMN_OK;
    return error_in_file(e->error, LMN_FORMAT, e->job->path, 0, "openscad failed%s%.300s", e->said[0] ? ": " : "",
                         e->said);
}

/* --- the format ----------------------------------------------------------------------------------------- */

static lmn_status read_output(evaluation *e)
{
    file_data  file;
    lmn_status status = file_load(&file, e->output, e->error);
    if (status != LMN_OK)
        return error_in_file(e->error, LMN_FORMAT, e->job->path, 0, "openscad wrote no model");
    each_line(e, "WARNING:", pass_warning);
    import_job job = *e->job;
    job.file = &file;
    status = csg_read(&job, true, e->error);
    file_data_release(&file);
    return status;
}

static lmn_status read_scad(const import_job *job, lmn_error *error)
{
    lmn_error   own = {0};
    evaluation *e = mem_calloc(1, sizeof *e);
    if (!e)
        return error_memory(error);
    e->job = job;
    e->error = &own;
    lmn_status status;
    if (!find_program(e->program)) {
        status = error_in_file(&own, LMN_UNSUPPORTED, job->path, 0,
                               "a .scad file is a program that openscad must evaluate, and it is not on the PATH");
        error_hint(&own, "install OpenSCAD, or where it is: openscad -o model.csg model.scad");
    } else {
        status = check_defines(e);
    }
    if (status == LMN_OK)
        status = make_folder(e);
    if (status == LMN_OK)
        status = start(e);
    if (status == LMN_OK)
        status = wait_for(e);
    if (status == LMN_OK)
        status = explain(e);
    if (status == LMN_OK)
        status = read_output(e);
    if (e->folder[0])
        temporary_folder_remove(e->folder);
    mem_free(e);
    if (status != LMN_OK && error)
        *error = own;
    return status;
}

const import_format import_scad = {"OpenSCAD", ".scad", 'z', false, NULL, read_scad};
