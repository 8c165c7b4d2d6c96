/* Inside the import folder: what the OBJ reader and its material library share. */
#ifndef LIMNER_IMPORT_OBJ_H
#define LIMNER_IMPORT_OBJ_H

#include "import/import.h"

/* A cursor over the lines of a text file. */
typedef struct obj_text {
    const char *begin, *at, *end;
} obj_text;

/* Skips blanks within the line; a backslash at its end joins the next one. */
void obj_skip_blanks(obj_text *t);
bool obj_is_blank(char c); /* blanks and line ends */
bool obj_at_line_end(obj_text *t);
void obj_next_line(obj_text *t);
/* The next word of the line, false at its end. */
bool obj_word(obj_text *t, const char **word, size_t *length);
/* A number; what follows it up to the next blank is skipped. False when there is none. */
bool obj_number(obj_text *t, double *out);
/* What is left of the line without blanks around it, cleaned; NULL when memory is gone. */
char *obj_rest(obj_text *t);
bool  obj_is(const char *word, size_t length, const char *expected);

/* Turns the backslashes of a path into slashes. */
void obj_slash_path(char *path);

/* Adds the library's materials to the scene. A missing one is a warning. Errors: LMN_MEMORY, LMN_LIMIT. */
lmn_status obj_read_library(const import_job *job, const char *name, lmn_error *error);

#endif
