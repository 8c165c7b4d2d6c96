/* What the files of PDF share. */
#ifndef LIMNER_EXPORT_PDF_PRIVATE_H
#define LIMNER_EXPORT_PDF_PRIVATE_H

#include "base/text.h"
#include "export/export.h"

/* Objects by their number. */
enum { PDF_CATALOG = 1, PDF_PAGES, PDF_PAGE, PDF_CONTENTS, PDF_INFO, PDF_FONT, PDF_OTHERS };

typedef struct pdf_picture {
    size_t         object; /* of an opaque one; with alpha the next one is its mask */
    int            width, height;
    unsigned char *colours; /* 3 a pixel */
    unsigned char *alpha;   /* NULL: opaque */
} pdf_picture;

/* An object that lies in the stream of those that are none themselves. */
typedef struct pdf_packed {
    size_t number, place;
} pdf_packed;

/* A pattern of lines that areas are filled with. */
typedef struct pdf_pattern {
    size_t      object;
    sheet_hatch hatch;
    colour      ink;
} pdf_pattern;

enum { PDF_PLACE_BYTES = 5 }; /* of a place in the file */

typedef struct pdf_writer {
    text         out, content, packed;
    pdf_packed  *packed_objects;
    size_t       packed_count, packed_capacity;
    const sheet *s;
    size_t      *layers; /* object of each group; 0: no layer */
    size_t       layer_count, object_count;
    size_t      *offsets; /* of objects in the file */
    double      *opacities;
    size_t       opacity_count, opacity_capacity;
    pdf_picture *pictures;
    size_t       picture_count, picture_capacity;
    pdf_pattern *patterns;
    size_t       pattern_count, pattern_capacity;
} pdf_writer;

void pdf_put(text *out, const char *words);
void pdf_put_number(text *out, double value);
void pdf_put_text(text *out, const char *words);
void pdf_put_picture(pdf_writer *w, const pdf_picture *p);

/* The page's description, in millimetres with y down. */
void pdf_put_content(pdf_writer *w, double points_per_mm);

#endif
