/* Which installed fonts a text is set in. */
#ifndef LIMNER_CONSTRUCT_TEXT_FONTS_H
#define LIMNER_CONSTRUCT_TEXT_FONTS_H

#include "base/error.h"

/* A piece of a text that one font has, and that runs in one direction. */
typedef struct text_run {
    char *words, *file; /* owned */
    int   face;         /* of the file */
} text_run;

/* As they stand from left to right. */
typedef struct text_runs {
    text_run *items;
    size_t    count, capacity;
} text_runs;

/* All of it in the font of this name (NULL: OpenSCAD's default). *missing: another one stands in for it. Errors:
 * LMN_FORMAT (a name too long), LMN_UNSUPPORTED (no font at all), LMN_MEMORY. */
lmn_status text_runs_whole(text_runs *out, const char *utf8, const char *font, bool *missing, lmn_error *error);
/* What that font lacks in the nearest fonts that have it. Errors: as above; LMN_UNSUPPORTED also where no font has some
 * of it, which the error names. */
lmn_status text_runs_find(text_runs *out, const char *utf8, const char *font, lmn_error *error);
void       text_runs_release(text_runs *r);

#endif
