/* Formats of drawings, as the library lists them. */
#ifndef LIMNER_CLI_FORMATS_H
#define LIMNER_CLI_FORMATS_H

#include "limner/limner.h"

/* The format of an ending (".svg"), or false. */
bool format_find(lmn_format_info *out, const char *ending);
/* The first of pixels, or of vectors: what is drawn where nothing says the format. */
const char *format_standard(bool vectors);

enum { FORMAT_LIST_SIZE = 128 };

typedef enum format_sort { FORMATS_ALL, FORMATS_PIXELS, FORMATS_VECTORS } format_sort;

/* ".svg, .pdf or .dxf", or without the dots "svg, pdf or dxf". Returns `out`. */
const char *format_list(char out[FORMAT_LIST_SIZE], format_sort sort, bool dots);

#endif
