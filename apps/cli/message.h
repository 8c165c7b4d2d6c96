/* What the command says on standard error, and its exit status. */
#ifndef LIMNER_CLI_MESSAGE_H
#define LIMNER_CLI_MESSAGE_H

#include <stdbool.h>

#include "limner/limner.h"

/* docs/reference/draw.md: these numbers are contract. */
enum {
    EXIT_DONE = 0,
    EXIT_USAGE = 1,
    EXIT_INPUT = 2,
    EXIT_GL = 3,
    EXIT_OUTPUT = 4,
    EXIT_CANCELLED = 5,
    EXIT_INTERNAL = 6
};

int message_exit_status(lmn_status status);

/* Prints "limner: FILE[:LINE[:COL]]: message" and the hint; returns the exit status. */
int message_error(const lmn_error *error);

/* The same for a wrong argument; hint may be NULL. */
int message_usage(const char *hint, const char *format, ...) __attribute__((format(printf, 2, 3)));

/* An output that cannot be written. */
int message_output(const char *path, const char *what);

int message_out_of_memory(void);

void message_warning(const char *text, size_t count);

/* A line for --verbose. */
void message_note(const char *format, ...) __attribute__((format(printf, 1, 2)));

/* The progress callback's state: a bar when standard error is a terminal, and cancelling by Ctrl-C in any case. */
typedef struct progress {
    bool        shown;   /* draw a bar */
    bool        visible; /* a bar stands on the terminal */
    const char *label;   /* what is worked on; borrowed */
    int         last_permille;
} progress;

/* From here on SIGINT, SIGTERM and SIGHUP cancel. What does not end by itself within 0.15 s, such as a driver that
 * compiles, or a pipe that nobody reads, ends with the process; files are whole or not there in any case. */
void progress_begin(progress *p, bool quiet);
/* Before the process ends: nobody waits for signals any more. */
void progress_end(void);
bool progress_report(double fraction, const char *stage, void *user);
/* The same for who only asks whether to go on. */
bool progress_poll(double fraction, const char *stage, void *user);
void progress_erase(progress *p);

/* Was Ctrl-C pressed since progress_begin? */
bool progress_cancelled(void);

#endif
