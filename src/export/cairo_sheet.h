/* What writes sheets through cairo shares. */
#ifndef LIMNER_EXPORT_CAIRO_SHEET_H
#define LIMNER_EXPORT_CAIRO_SHEET_H

#include <cairo.h>

#include "export/export.h"

/* Draws a sheet in a context whose unit is the millimetre. False when memory was gone or the work is to stop; the
 * context has its own status beside it. */
bool cairo_sheet_draw(cairo_t *context, const sheet *s);

/* Text that pango and cairo take: UTF-8 without control characters. Free with mem_free; NULL when memory is gone. */
char *cairo_clean_text(const char *words);

#endif
