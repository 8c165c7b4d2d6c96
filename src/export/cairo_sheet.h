/* What draws sheets through cairo, and what of it writers of PDF take. */
#ifndef LIMNER_EXPORT_CAIRO_SHEET_H
#define LIMNER_EXPORT_CAIRO_SHEET_H

#include <cairo.h>

#include "export/export.h"

/* Draws a sheet in a context whose unit is the millimetre. False when memory was gone or the work is to stop; the
 * context has its own status beside it. */
bool cairo_sheet_draw(cairo_t *context, const sheet *s);

/* An arc as cubics, as few as are off by no more than this, mm: two control points and the end of each. Returns how
 * many. */
#define CAIRO_ARC_ERROR 0.001
enum { CAIRO_CUBICS_MOST = 24 };
int cairo_arc_cubics(const sheet_piece *arc, double out[CAIRO_CUBICS_MOST][6]);

/* Are they drawn in one go? Dashed lines are drawn one by one. */
bool cairo_same_pen(const sheet_path *a, const sheet_path *b);

/* One step of the outlines of letters, as PDF has it: 'm', 'l', 'c' or 'h'. */
typedef struct cairo_step {
    char   kind;
    double at[6];
} cairo_step;
/* One word of a line: bytes of its text, and from where to where it stands. */
typedef struct cairo_word {
    size_t first, size;
    double left, right;
} cairo_word;
typedef struct cairo_letters {
    cairo_step *steps;
    size_t      count, capacity;
    cairo_word *words;
    size_t      word_count, word_capacity;
    double      width; /* of the line */
} cairo_letters;
/* The outlines of one line of clean text of this size, whose baseline begins at 0, 0, y down. False when
 * memory was gone. End it with cairo_letters_release either way. */
bool cairo_find_letters(cairo_letters *out, const char *words, double size);
void cairo_letters_release(cairo_letters *l);

/* Text that pango and cairo take: UTF-8 without control characters. Free with mem_free; NULL when memory is gone. */
char *cairo_clean_text(const char *words);

#endif
