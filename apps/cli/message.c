#include "message.h"

#include <pthread.h>
#include <semaphore.h>
#include <signal.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

enum { CANCEL_NS = 150000000 };

/* What a signal handler may write: that there was a signal, and who waits for one. */
static volatile sig_atomic_t interrupted;
static sem_t                 wake;
static pthread_t             guard_thread;
static bool                  guarded;

int message_exit_status(lmn_status status)
{
    switch (status) {
    case LMN_OK: return EXIT_DONE;
    case LMN_USAGE: return EXIT_USAGE;
    case LMN_READ:
    case LMN_FORMAT:
    case LMN_LIMIT:
    case LMN_UNSUPPORTED: return EXIT_INPUT;
    case LMN_GL: return EXIT_GL;
    case LMN_WRITE: return EXIT_OUTPUT;
    case LMN_CANCELLED: return EXIT_CANCELLED;
    case LMN_MEMORY:
    case LMN_INTERNAL: break;
    }
    return EXIT_INTERNAL;
}

static void print_hint(const char *hint)
{
    if (hint && *hint)
        fprintf(stderr, "hint: %s\n", hint);
}

int message_error(const lmn_error *error)
{
    fputs("limner: ", stderr);
    if (error->file[0]) {
        fputs(error->file, stderr);
        if (error->line > 0)
            fprintf(stderr, ":%d", error->line);
        if (error->line > 0 && error->column > 0)
            fprintf(stderr, ":%d", error->column);
        fputs(": ", stderr);
    }
    fprintf(stderr, "%s\n", error->message[0] ? error->message : lmn_status_text(error->status));
    print_hint(error->hint);
    return message_exit_status(error->status);
}

static void print_line(const char *format, va_list arguments)
{
    fputs("limner: ", stderr);
    vfprintf(stderr, format, arguments);
    fputc('\n', stderr);
}

int message_usage(const char *hint, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    print_line(format, arguments);
    va_end(arguments);
    print_hint(hint);
    return EXIT_USAGE;
}

int message_output(const char *path, const char *what)
{
    fprintf(stderr, "limner: %s: %s\n", path, what);
    return EXIT_OUTPUT;
}

int message_out_of_memory(void)
{
    fputs("limner: out of memory\n", stderr);
    return EXIT_INTERNAL;
}

void message_warning(const char *text, size_t count)
{
    if (count > 1)
        fprintf(stderr, "limner: warning: %s (%zu times)\n", text, count);
    else
        fprintf(stderr, "limner: warning: %s\n", text);
}

void message_note(const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    print_line(format, arguments);
    va_end(arguments);
}

static void on_interrupt(int signal_number)
{
    (void)signal_number;
    interrupted = 1;
    sem_post(&wake);
}

/* Ends the process where the work does not listen. Only calls that are safe whatever the other threads are doing. */
static void *guard(void *unused)
{
    static const char line[] = "\r\033[Klimner: cancelled\n";
    struct timespec   left = {0, CANCEL_NS};
    (void)unused;
    while (sem_wait(&wake) != 0)
        ;
    if (!interrupted)
        return NULL; /* the command is done */
    while (nanosleep(&left, &left) != 0)
        ;
    bool   terminal = isatty(STDERR_FILENO) != 0;
    size_t skip = terminal ? 0 : strlen("\r\033[K");
    if (write(STDERR_FILENO, line + skip, sizeof line - 1 - skip) < 0)
        _exit(EXIT_CANCELLED);
    _exit(EXIT_CANCELLED);
    return NULL;
}

void progress_begin(progress *p, bool quiet)
{
    static const int signals[] = {SIGINT, SIGTERM, SIGHUP};
    struct sigaction action = {.sa_handler = on_interrupt, .sa_flags = SA_RESTART}, before;
    sigemptyset(&action.sa_mask);
    *p = (progress){.shown = !quiet && isatty(STDERR_FILENO), .label = "", .last_permille = -1};
    if (guarded)
        return; /* one guard watches the whole command, however many works it has */
    guarded = sem_init(&wake, 0, 0) == 0 && pthread_create(&guard_thread, NULL, guard, NULL) == 0;
    if (!guarded)
        action.sa_flags |= (int)SA_RESETHAND; /* a second signal ends the command at once then */
    /* nohup sets SIGHUP aside, and it stays so; shells do it with SIGINT for what runs in the background, where
     * somebody who sends it means it. */
    for (size_t i = 0; i < sizeof signals / sizeof *signals; i++)
        if (sigaction(signals[i], NULL, &before) == 0 && (signals[i] != SIGHUP || before.sa_handler != SIG_IGN))
            sigaction(signals[i], &action, NULL);
}

void progress_end(void)
{
    if (!guarded || interrupted)
        return; /* with a signal on its way, the thread ends the process or is ended with it */
    guarded = false;
    sem_post(&wake);
    pthread_join(guard_thread, NULL);
}

bool progress_poll(double fraction, const char *stage, void *user)
{
    (void)fraction, (void)stage, (void)user;
    return !interrupted;
}

bool progress_report(double fraction, const char *stage, void *user)
{
    enum { WIDTH = 30 };
    progress *p = user;
    int       permille = (int)(fraction * 1000.0 + 0.5);
    permille = permille < 0 ? 0 : permille > 1000 ? 1000 : permille;
    if (p->shown && permille != p->last_permille) {
        char bar[WIDTH + 1];
        int  filled = permille * WIDTH / 1000;
        memset(bar, '#', (size_t)filled);
        memset(bar + filled, '.', (size_t)(WIDTH - filled));
        bar[WIDTH] = '\0';
        fprintf(stderr, "\r\033[K[%s] %3d%% %.40s %.24s", bar, permille / 10, p->label, stage ? stage : "");
        fflush(stderr);
        p->visible = true;
        p->last_permille = permille;
    }
    return !interrupted;
}

void progress_erase(progress *p)
{
    if (p->visible) {
        fputs("\r\033[K", stderr);
        fflush(stderr);
    }
    p->visible = false;
    p->last_permille = -1;
}

bool progress_cancelled(void)
{
    return interrupted != 0;
}
