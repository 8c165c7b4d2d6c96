/* What the files of DXF share. */
#ifndef LIMNER_EXPORT_DXF_PRIVATE_H
#define LIMNER_EXPORT_DXF_PRIVATE_H

#include "base/text.h"
#include "sheet/sheet.h"

typedef struct dxf_layer {
    char *name;        /* owned */
    int   ink, weight; /* of the first of its items; others say that theirs differ */
} dxf_layer;

/* Ink and gaps in turn, of lines whose pattern is this one, or this one stretched: a dash and a gap, or a dash, a gap,
 * a dot and a gap. */
enum { DXF_PATTERN_MOST = 4 };
typedef struct dxf_line_type {
    double lengths[DXF_PATTERN_MOST]; /* mm */
    int    count;                     /* 2, 4; 0: unbroken */
} dxf_line_type;

typedef struct dxf_writer {
    text           out;
    const sheet   *s;
    unsigned       handle; /* that was given last */
    dxf_layer     *layers;
    size_t         layer_count, layer_capacity;
    uint32_t      *layer_of;    /* of each group */
    uint32_t      *layer_slots; /* hash of names: layer + 1 */
    size_t         layer_slot_count;
    dxf_line_type *line_types;
    size_t         line_type_count, line_type_capacity;
    uint32_t      *line_type_of; /* of each path: line type + 1, 0: unbroken */
} dxf_writer;

/* Handles of what others refer to. */
enum { DXF_NO_WEIGHT = -3 /* the program's own */ };
enum { DXF_MODEL_SPACE = 0x20, DXF_PAPER_SPACE = 0x21, DXF_FIRST_HANDLE = 0x100, DXF_NAME_CAPACITY = 32 };

/* --- pairs of a code and a value --- */
void dxf_put(dxf_writer *w, int code, const char *value);
void dxf_put_whole(dxf_writer *w, int code, int value);
void dxf_put_handle(dxf_writer *w, int code, unsigned handle);
/* Four decimals at most: a tenth of a thousandth of a millimetre. */
void dxf_put_number(dxf_writer *w, int code, double value);
/* x, y from the sheet's coordinates; z is 0. */
void dxf_put_position(dxf_writer *w, int code, double x, double y);
/* One line; what is not ASCII by its code, "\U+00E9". */
void dxf_put_words(dxf_writer *w, int code, const char *words);

int dxf_palette_index(colour ink);
/* Of an item's lines, hundredths of a millimetre; DXF_NO_WEIGHT: it has none. */
int              dxf_weight_of(const sheet *s, const sheet_item *item);
const dxf_layer *dxf_layer_of(const dxf_writer *w, const sheet_item *item);
/* What the dashes of a path are again and again. */
dxf_line_type dxf_pattern_of(const sheet *s, const sheet_path *path);
/* The name of a line type of the file by its number; lent until the next call with the same buffer. */
const char *dxf_line_type_name(const dxf_writer *w, size_t index, char out[DXF_NAME_CAPACITY]);

void dxf_put_entities(dxf_writer *w);

#endif
