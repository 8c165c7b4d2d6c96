/* Inside the import folder: the program `openscad`, when it is on the PATH, in a process group of its own, with limits
 * on time and memory. */
#ifndef LIMNER_IMPORT_OPENSCAD_H
#define LIMNER_IMPORT_OPENSCAD_H

#include <sys/types.h>

#include "import/import.h"

enum { OPENSCAD_SAID_MAX = 1 << 16, OPENSCAD_PATH_CAPACITY = 4096 };

typedef struct openscad_run {
    const import_job *job; /* whose progress it reports */
    char              program[OPENSCAD_PATH_CAPACITY], folder[OPENSCAD_PATH_CAPACITY];
    char              output[OPENSCAD_PATH_CAPACITY + 16];
    pid_t             id;
    int               pipe;
    char              said[OPENSCAD_SAID_MAX + 1]; /* what it prints */
    size_t            said_size;
    int               status; /* as waitpid gives it */
    bool              timed_out;
    lmn_error        *error;
} openscad_run;

/* The first executable file of this name in the PATH: into out->program. */
bool openscad_find(openscad_run *out);
/* May a program be run at all? Not where files are limited to a folder, or come from the caller. */
bool openscad_is_allowed(void);
/* An empty folder for what it is given and what it writes, into e->output, which is named so. Remove it with
 * temporary_folder_remove, also after an error. */
lmn_status openscad_make_folder(openscad_run *e, const char *name);
/* Runs it on a file, with definitions, until it ends, is cancelled, or takes too long. Errors: LMN_MEMORY,
 * LMN_INTERNAL, LMN_CANCELLED; whether it did what it was to do is in e->status, e->timed_out and e->said. */
lmn_status openscad_evaluate(openscad_run *e, const char *input, const char *const *defines, size_t define_count);
/* Took it too long? */
bool openscad_was_stopped(const openscad_run *e);
/* Hands each line that it said and that begins with the word to the function. */
void openscad_each_line(const openscad_run *e, const char *word, void (*use)(const openscad_run *e, const char *line));

#endif
