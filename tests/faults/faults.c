/* Runs the command again and again, each time with another call to the system failing, and holds what it does against
 * its contract: an exit status of the right class, a message, no signal, no hang, and the output whole or as it was
 * before, with nothing beside it. faults short|long PROGRAM LIBRARY EXAMPLES FOLDER short: few calls of each; long: all
 * of them. LIBRARY is fail.c. */
#define _GNU_SOURCE
#include <dirent.h>
#include <errno.h>
#include <fcntl.h>
#include <signal.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

#include "faults.h"

enum { SECONDS_MOST = 20, WORDS_MOST = 16, SHORT_TRIES = 3 };

static const char *const call_names[CALLS] = {
#define CALL(name) #name,
    ALL_CALLS
#undef CALL
};

typedef struct scenario {
    const char *name, *output; /* NULL: it writes no file */
    bool        draws, large;  /* large: the short form tries nothing but the driver's memory, where it draws */
    const char *words[WORDS_MOST];
} scenario;

static const scenario scenarios[] = {
    {"picture", "out.png", true, false, {"draw", "box.glb", "--size", "48x48", "-o", "out.png"}},
    {"maps",
     "out.png",
     true,
     true,
     {"draw", "box.glb", "--size", "48x48", "-o", "out.png", "--look", "sketch", "--aov", "maps"}},
    {"solid",
     "out.png",
     true,
     true,
     {"draw", "widget.csg", "--size", "48x48", "-o", "out.png", "--report", "out.json"}},
    {"svg", "out.svg", false, false, {"draw", "box.glb", "--size", "48x48", "--look", "line", "-o", "out.svg"}},
    {"pdf",
     "out.pdf",
     false,
     true,
     {"draw", "gearbox.stl", "--size", "48x48", "--look", "technical", "-o", "out.pdf", "--views", "front,top",
      "--frame"}},
    {"dxf",
     "out.dxf",
     false,
     true,
     {"draw", "box.glb", "--size", "48x48", "--look", "line", "-o", "out.dxf", "--plotter"}},
    {"film",
     "out.webp",
     true,
     false,
     {"draw", "box.glb", "--size", "48x48", "--look", "sketch", "--set", "perturb.boil=12", "--frames", "1:1:24", "-o",
      "out.webp"}},
    {"info", NULL, false, false, {"info", "fox.glb", "--json"}},
    {"foreign", NULL, false, false, {"info", "plate.off"}},
    {"looks", NULL, false, false, {"looks", "hatch"}},
};
enum { SCENARIOS = sizeof scenarios / sizeof *scenarios };

typedef struct runner {
    const char *program, *library, *folder;
    bool        every;
    long        runs, bad;
} runner;

typedef struct result {
    int  status; /* of the exit; −1: a signal, −2: a hang */
    int  signal;
    char said[256];
} result;

static void write_text(const char *path, const char *text)
{
    FILE *file = fopen(path, "w");
    if (!file || fputs(text, file) < 0 || fclose(file) != 0) {
        fprintf(stderr, "cannot write %s\n", path);
        exit(2);
    }
}

static void start(const runner *r, const scenario *s, const char *fault)
{
    char *words[WORDS_MOST + 1] = {(char *)r->program};
    for (int i = 0; s->words[i]; i++)
        words[i + 1] = (char *)s->words[i];
    setenv("LD_PRELOAD", r->library, 1);
    setenv("FAULT_REPORT", "../report", 1);
    if (fault)
        setenv("FAULT", fault, 1);
    int out = open("/dev/null", O_WRONLY), said = open("../said", O_WRONLY | O_CREAT | O_TRUNC, 0644);
    dup2(out, STDOUT_FILENO);
    dup2(said, STDERR_FILENO);
    execv(r->program, words);
    _exit(127);
}

static void read_said(result *out)
{
    FILE  *file = fopen("../said", "r");
    size_t count = file ? fread(out->said, 1, sizeof out->said - 1, file) : 0;
    out->said[count] = '\0';
    if (file)
        fclose(file);
}

static result run(runner *r, const scenario *s, const char *fault)
{
    result result = {.status = -2};
    int    how = 0;
    remove("../report");
    r->runs++;
    const pid_t child = fork();
    if (child == 0)
        start(r, s, fault);
    for (int waited = 0; waited < SECONDS_MOST * 500 && waitpid(child, &how, WNOHANG) == 0; waited++) {
        nanosleep(&(struct timespec){0, 2000000}, NULL);
        if (waited == SECONDS_MOST * 500 - 1) {
            kill(child, SIGKILL);
            waitpid(child, &how, 0);
            read_said(&result);
            return result;
        }
    }
    result.signal = WIFSIGNALED(how) ? WTERMSIG(how) : 0;
    result.status = WIFEXITED(how) ? WEXITSTATUS(how) : -1;
    read_said(&result);
    return result;
}

static void read_counts(long counts[CALLS])
{
    char  name[64];
    long  count;
    FILE *file = fopen("../report", "r");
    memset(counts, 0, CALLS * sizeof *counts);
    while (file && fscanf(file, "%63s %ld", name, &count) == 2)
        for (int i = 0; i < CALLS; i++)
            if (strcmp(name, call_names[i]) == 0)
                counts[i] = count;
    if (file)
        fclose(file);
}

/* Which exit statuses this call may lead to, a bit each. What may be done without, caches and threads, leads to 0. */
static unsigned allowed(int call, const scenario *s)
{
    switch (call) {
    case CALL_malloc: return 1 << 0 | 1 << 6;
    case CALL_write:
    case CALL_fsync:
    case CALL_rename:
    case CALL_mkdir: return 1 << 0 | 1 << 4;
    case CALL_link: return 1 << 0;
    case CALL_read:
    case CALL_mmap: return 1 << 0 | 1 << 2;
    case CALL_stat:
    case CALL_open:
    case CALL_close: return 1 << 0 | 1 << 2 | (s->output ? 1 << 4 : 0);
    case CALL_fork:
    case CALL_send:
    case CALL_recv:
    case CALL_pipe: return 1 << 0 | 1 << 2 | 1 << 6;
    case CALL_pthread_create: return 1 << 0;
    case CALL_glTexImage2D:
    case CALL_glTexStorage2D:
    case CALL_glBufferData:
    case CALL_glRenderbufferStorage:
    case CALL_glMapBufferRange: return 1 << 0 | 1 << 3 | 1 << 6;
    default: return 1 << 0 | 1 << 3;
    }
}

static const char before[] = "what was there before\n";

/* Bytes of a file; NULL when there is none. */
static char *read_file(const char *path, size_t *size)
{
    FILE *file = fopen(path, "r");
    *size = 0;
    if (!file)
        return NULL;
    char *bytes = malloc(1 << 24);
    *size = bytes ? fread(bytes, 1, 1 << 24, file) : 0;
    fclose(file);
    return bytes;
}

/* Files that should not be there: those made beside an output and left. */
static bool leftover(char *name, size_t size)
{
    static const char *const known[] = {".",          "..",          "out.png",  "out.svg",  "out.pdf",
                                        "out.dxf",    "out.webp",    "out.json", "maps",     "box.glb",
                                        "widget.csg", "gearbox.stl", "fox.glb",  "plate.off"};
    DIR                     *folder = opendir(".");
    bool                     found = false;
    for (struct dirent *entry; folder && !found && (entry = readdir(folder));) {
        bool expected = false;
        for (size_t i = 0; i < sizeof known / sizeof *known; i++)
            expected = expected || strcmp(entry->d_name, known[i]) == 0;
        if (!expected) {
            snprintf(name, size, "%s", entry->d_name);
            remove(entry->d_name);
            found = true;
        }
    }
    if (folder)
        closedir(folder);
    return found;
}

static void complain(runner *r, const scenario *s, const char *fault, const result *result, const char *what)
{
    printf("%s with %s: %s (status %d, signal %d)\n    %s\n", s->name, fault, what, result->status, result->signal,
           result->said);
    r->bad++;
}

/* Runs once and checks all that is promised. `good`: the output without faults. */
static void try_fault(runner *r, const scenario *s, int call, const char *fault, const char *good, size_t good_size,
                      bool existed)
{
    char   name[256];
    size_t size = 0;
    if (s->output && existed)
        write_text(s->output, before);
    else if (s->output)
        remove(s->output);
    const result result = run(r, s, fault);
    char        *bytes = s->output ? read_file(s->output, &size) : NULL;
    if (result.status == -2)
        complain(r, s, fault, &result, "hangs");
    else if (result.status == -1)
        complain(r, s, fault, &result, "is ended by a signal");
    else if (result.status > 6 || !(allowed(call, s) & 1u << result.status))
        complain(r, s, fault, &result, "has a status of another class");
    else if (result.status != 0 && !strstr(result.said, "limner: "))
        complain(r, s, fault, &result, "fails without a message");
    else if (s->output && result.status == 0 && (!bytes || size != good_size || memcmp(bytes, good, size) != 0))
        complain(r, s, fault, &result,
                 bytes ? "writes another file than without the fault" : "writes nothing, yet says that all is well");
    else if (s->output && result.status != 0 && existed &&
             (!bytes || (size == sizeof before - 1 ? memcmp(bytes, before, size) != 0
                                                   : size != good_size || memcmp(bytes, good, size) != 0)))
        complain(r, s, fault, &result, "leaves half a file in place of what was there");
    else if (s->output && result.status != 0 && !existed && bytes &&
             (size != good_size || memcmp(bytes, good, size) != 0))
        complain(r, s, fault, &result, "leaves half a file");
    if (leftover(name, sizeof name)) {
        snprintf(name + strlen(name), sizeof name - strlen(name), " is left");
        complain(r, s, fault, &result, name);
    }
    free(bytes);
}

/* Which calls are tried: all, or the first, the last and some between; the beginning of a run is where it is most
 * diverse. */
static bool is_tried(const runner *r, long n, long count)
{
    if (r->every || count <= SHORT_TRIES)
        return true;
    return n == 1 || n == count || n == count / 2;
}

static void try_call(runner *r, const scenario *s, int call, long count, const char *good, size_t good_size)
{
    char       fault[64];
    const bool driver = call >= CALL_glTexImage2D && call <= CALL_glMapBufferRange;
    if (s->large && !r->every && !driver)
        return;
    for (long n = 1; n <= count; n++) {
        if (!driver && !is_tried(r, n, count))
            continue;
        snprintf(fault, sizeof fault, "%s:%ld", call_names[call], n);
        try_fault(r, s, call, fault, good, good_size, n % 2);
        if ((r->every || n == 1) && call != CALL_malloc) {
            snprintf(fault, sizeof fault, "%s:%ld+", call_names[call], n);
            try_fault(r, s, call, fault, good, good_size, !(n % 2));
        }
    }
    if (s->large && !r->every)
        return;
    /* A call that is interrupted or does half of its work is no failure. */
    const bool moves = call == CALL_read || call == CALL_write || call == CALL_send || call == CALL_recv;
    for (int half = 0; half < 2 && moves && count > 0; half++) {
        snprintf(fault, sizeof fault, "%s:1:%s", call_names[call], half ? "short" : "EINTR");
        try_fault(r, s, CALL_pthread_create, fault, good, good_size, false); /* only 0 is allowed */
    }
}

static void try_scenario(runner *r, const scenario *s)
{
    long   counts[CALLS];
    size_t size = 0;
    run(r, s, NULL); /* fills the cache */
    const result result = run(r, s, NULL);
    char        *good = s->output ? read_file(s->output, &size) : NULL;
    if (result.status != 0 || (s->output && !good)) {
        complain(r, s, "no fault", &result, "does not work");
        free(good);
        return;
    }
    read_counts(counts);
    if (counts[CALL_malloc] == 0 || (s->output && counts[CALL_write] == 0) ||
        (s->draws && counts[CALL_glCreateShader] == 0))
        complain(r, s, "no fault", &result,
                 "makes no calls that could fail: the library that counts them does not see them");
    const long earlier = r->runs;
    for (int call = 0; call < CALLS; call++)
        try_call(r, s, call, counts[call], good, size);
    printf("%-8s %6ld faults\n", s->name, r->runs - earlier);
    fflush(stdout);
    free(good);
}

static void link_example(const char *examples, const char *name)
{
    char        path[4096];
    const char *slash = strrchr(name, '/');
    snprintf(path, sizeof path, "%s/%s", examples, name);
    remove(slash ? slash + 1 : name);
    if (symlink(path, slash ? slash + 1 : name) != 0)
        perror(path);
}

int main(int count, char **words)
{
    if (count < 6 || count > 7) {
        fprintf(stderr, "usage: faults short|long PROGRAM LIBRARY EXAMPLES FOLDER [SCENARIO]\n");
        return 2;
    }
    runner r = {.every = strcmp(words[1], "long") == 0, .program = words[2], .library = words[3], .folder = words[5]};
    char   inside[4096];
    snprintf(inside, sizeof inside, "%s/files", r.folder);
    mkdir(r.folder, 0777);
    mkdir(inside, 0777);
    if (chdir(inside) != 0) {
        perror(inside);
        return 2;
    }
    static const char *const examples[] = {"box.glb", "csg/widget.csg", "gearbox.stl", "fox.glb"};
    for (size_t i = 0; i < sizeof examples / sizeof *examples; i++)
        link_example(words[4], examples[i]);
    write_text("plate.off", "OFF\n4 2 0\n0 0 0\n1 0 0\n0 1 0\n1 1 0\n3 0 1 2\n3 1 3 2\n");
    for (int i = 0; i < SCENARIOS; i++)
        if ((count < 7 && (r.every || !scenarios[i].large || scenarios[i].draws)) ||
            (count == 7 && strcmp(words[6], scenarios[i].name) == 0))
            try_scenario(&r, &scenarios[i]);
    printf("%ld runs, %ld bad\n", r.runs, r.bad);
    return r.bad > 0;
}
