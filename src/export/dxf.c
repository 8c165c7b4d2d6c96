/* DXF of a sheet: release 12 in ASCII, which everything reads. Millimetres, the sheet's lower left corner at the
 * origin, y up. A layer for each class of lines and for what is hidden; lines of two points are LINE, others
 * POLYLINE, dots are CIRCLE, texts TEXT. Pictures have no position in it; areas are their borders. */
#include "export/export.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "base/memory.h"
#include "base/text.h"

enum { LAYER_NAME_CAPACITY = 32 }; /* what release 12 allows is 31 letters */

typedef struct dxf_layer {
    char name[LAYER_NAME_CAPACITY];
    int  ink;
} dxf_layer;

typedef struct dxf_writer {
    text         out;
    const sheet *s;
    dxf_layer   *layers;
    size_t       layer_count, layer_capacity;
    uint32_t    *layer_of; /* of each group */
} dxf_writer;

/* The colours of AutoCAD's palette that have names; 7 is black on paper. */
static const float palette[][3] = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0},          {0, 1, 1},
                                   {0, 0, 1}, {1, 0, 1}, {0, 0, 0}, {0.5f, 0.5f, 0.5f}, {0.75f, 0.75f, 0.75f}};

static int palette_index(colour ink)
{
    float own[3] = {ink.r, ink.g, ink.b}, nearest = INFINITY;
    int   index = 7;
    for (int i = 1; i <= 9; i++) {
        float distance = 0;
        for (int k = 0; k < 3; k++)
            distance += (own[k] - palette[i][k]) * (own[k] - palette[i][k]);
        if (distance < nearest) {
            nearest = distance;
            index = i;
        }
    }
    return index;
}

/* --- what a file is made of: pairs of a code and a value ------------------------------------------------ */

static void put(dxf_writer *w, int code, const char *value)
{
    char digits[16];
    int  size = snprintf(digits, sizeof digits, "%d\n", code);
    text_append_bytes(&w->out, digits, (size_t)size);
    text_append_bytes(&w->out, value, strlen(value));
    text_append_bytes(&w->out, "\n", 1);
}

static void put_whole(dxf_writer *w, int code, int value)
{
    text_append(&w->out, "%d\n%d\n", code, value);
}

/* Four decimals: a tenth of a thousandth of a millimetre. */
static void put_number(dxf_writer *w, int code, double value)
{
    char               digits[48];
    long long          scaled = isfinite(value) ? llround(value * 10000) : 0;
    unsigned long long left = scaled < 0 ? (unsigned long long)-scaled : (unsigned long long)scaled;
    int                size =
        snprintf(digits, sizeof digits, "%d\n%s%llu.%04llu\n", code, scaled < 0 ? "-" : "", left / 10000, left % 10000);
    text_append_bytes(&w->out, digits, (size_t)size);
}

static void put_position(dxf_writer *w, int code, double x, double y)
{
    put_number(w, code, x);
    put_number(w, code + 10, w->s->height - y);
    put_number(w, code + 20, 0);
}

/* --- layers --------------------------------------------------------------------------------------------- */

/* A group's layer: its classes, "HIDDEN-CREASE"; "SHEET" where it has none. */
static void layer_name(const sheet_group *g, char out[LAYER_NAME_CAPACITY])
{
    const char *name = g->css_class && *g->css_class ? g->css_class : "sheet";
    int         size = snprintf(out, LAYER_NAME_CAPACITY, "%s", name);
    for (int i = 0; i < size && i < LAYER_NAME_CAPACITY - 1; i++) {
        bool letter = (out[i] >= 'a' && out[i] <= 'z') || (out[i] >= 'A' && out[i] <= 'Z');
        out[i] = letter ? (char)(out[i] & ~0x20) : out[i] >= '0' && out[i] <= '9' ? out[i] : '-';
    }
}

static uint32_t find_layer(dxf_writer *w, const char *name)
{
    for (size_t i = 0; i < w->layer_count; i++)
        if (strcmp(w->layers[i].name, name) == 0)
            return (uint32_t)i;
    if (!mem_grow((void **)&w->layers, &w->layer_capacity, w->layer_count + 1, sizeof *w->layers)) {
        w->out.failed = true;
        return 0;
    }
    dxf_layer *layer = &w->layers[w->layer_count];
    *layer = (dxf_layer){.ink = 7};
    snprintf(layer->name, sizeof layer->name, "%s", name);
    return (uint32_t)w->layer_count++;
}

static void find_layers(dxf_writer *w)
{
    w->layer_of = mem_calloc(w->s->group_count + 1, sizeof *w->layer_of);
    if (!w->layer_of) {
        w->out.failed = true;
        return;
    }
    find_layer(w, "0");
    for (size_t i = 0; i < w->s->item_count && !w->out.failed; i++) {
        uint32_t group = w->s->items[i].group;
        if (group >= w->s->group_count || w->layer_of[group])
            continue;
        char name[LAYER_NAME_CAPACITY];
        layer_name(&w->s->groups[group], name);
        w->layer_of[group] = find_layer(w, name);
        w->layers[w->layer_of[group]].ink = palette_index(w->s->items[i].ink);
    }
}

static const dxf_layer *layer_of(const dxf_writer *w, const sheet_item *item)
{
    return &w->layers[item->group < w->s->group_count ? w->layer_of[item->group] : 0];
}

/* --- sections ------------------------------------------------------------------------------------------- */

static void put_header(dxf_writer *w)
{
    put(w, 0, "SECTION");
    put(w, 2, "HEADER");
    put(w, 9, "$ACADVER");
    put(w, 1, "AC1009");
    put(w, 9, "$INSUNITS");
    put_whole(w, 70, 4); /* millimetres */
    put(w, 9, "$MEASUREMENT");
    put_whole(w, 70, 1); /* metric */
    put(w, 9, "$EXTMIN");
    put_position(w, 10, 0, w->s->height);
    put(w, 9, "$EXTMAX");
    put_position(w, 10, w->s->width, 0);
    put(w, 0, "ENDSEC");
}

static void put_line_type(dxf_writer *w, const char *name, const char *words, double dash, double gap)
{
    put(w, 0, "LTYPE");
    put(w, 2, name);
    put_whole(w, 70, 0);
    put(w, 3, words);
    put_whole(w, 72, 65);
    put_whole(w, 73, dash > 0 ? 2 : 0);
    put_number(w, 40, dash + gap);
    if (dash > 0) {
        put_number(w, 49, dash);
        put_number(w, 49, -gap);
    }
}

/* Lines that are dashed are dashes already. */
static void put_tables(dxf_writer *w)
{
    put(w, 0, "SECTION");
    put(w, 2, "TABLES");
    put(w, 0, "TABLE");
    put(w, 2, "LTYPE");
    put_whole(w, 70, 1);
    put_line_type(w, "CONTINUOUS", "Solid line", 0, 0);
    put(w, 0, "ENDTAB");
    put(w, 0, "TABLE");
    put(w, 2, "LAYER");
    put_whole(w, 70, (int)w->layer_count);
    for (size_t i = 0; i < w->layer_count; i++) {
        put(w, 0, "LAYER");
        put(w, 2, w->layers[i].name);
        put_whole(w, 70, 0);
        put_whole(w, 62, w->layers[i].ink);
        put(w, 6, "CONTINUOUS");
    }
    put(w, 0, "ENDTAB");
    put(w, 0, "ENDSEC");
}

static void begin_entity(dxf_writer *w, const char *type, const sheet_item *item)
{
    const dxf_layer *layer = layer_of(w, item);
    int              ink = palette_index(item->ink);
    put(w, 0, type);
    put(w, 8, layer->name);
    if (ink != layer->ink)
        put_whole(w, 62, ink);
}

static void put_dots(dxf_writer *w, const sheet_item *item, const sheet_path *path)
{
    for (uint32_t i = 0; i < path->count; i++) {
        const float *p = w->s->points[path->first + i];
        begin_entity(w, path->width > 0 ? "CIRCLE" : "POINT", item);
        put_position(w, 10, (double)p[0], (double)p[1]);
        if (path->width > 0)
            put_number(w, 40, (double)path->width / 2);
    }
}

static void put_path(dxf_writer *w, const sheet_item *item, const sheet_path *path)
{
    const float(*points)[2] = (const float(*)[2])w->s->points + path->first;
    bool closed = path->closed || path->filled;
    if (path->count == 2 && !closed) {
        begin_entity(w, "LINE", item);
        put_position(w, 10, (double)points[0][0], (double)points[0][1]);
        put_position(w, 11, (double)points[1][0], (double)points[1][1]);
        return;
    }
    begin_entity(w, "POLYLINE", item);
    put_whole(w, 66, 1);
    put_position(w, 10, 0, w->s->height);
    put_whole(w, 70, closed ? 1 : 0);
    for (uint32_t i = 0; i < path->count; i++) {
        put(w, 0, "VERTEX");
        put(w, 8, layer_of(w, item)->name);
        put_position(w, 10, (double)points[i][0], (double)points[i][1]);
    }
    put(w, 0, "SEQEND");
    put(w, 8, layer_of(w, item)->name);
}

/* One line; what is not ASCII by its code, "\U+00E9". */
static void put_words(dxf_writer *w, const char *words)
{
    text_append_bytes(&w->out, "1\n", 2);
    for (const unsigned char *at = (const unsigned char *)words; *at;) {
        size_t   length = *at >= 0xF0 ? 4 : *at >= 0xE0 ? 3 : *at >= 0xC0 ? 2 : 1, seen = 1;
        uint32_t code = length == 1 ? *at : *at & (0xFFu >> (length + 1));
        for (; seen < length && (at[seen] & 0xC0) == 0x80; seen++)
            code = code << 6 | (at[seen] & 0x3F);
        if (*at >= 0x20 && *at < 0x7F)
            text_append_bytes(&w->out, (const char *)at, 1);
        else
            text_append(&w->out, *at >= 0x80 ? "\\U+%04X" : " ",
                        (unsigned)(seen < length || (length == 1 && *at >= 0x80) || code > 0xFFFF ? 0xFFFD : code));
        at += seen;
    }
    text_append_bytes(&w->out, "\n", 1);
}

static void put_text(dxf_writer *w, const sheet_item *item)
{
    /* The height of capitals is what DXF calls a text's height. */
    begin_entity(w, "TEXT", item);
    put_position(w, 10, item->box[0], item->box[1]);
    put_number(w, 40, 0.716 * item->box[3]);
    put_words(w, item->text);
    if (item->anchor >= 0) {
        put_whole(w, 72, item->anchor == 0 ? 1 : 2);
        put_position(w, 11, item->box[0], item->box[1]);
    }
}

static void put_entities(dxf_writer *w)
{
    put(w, 0, "SECTION");
    put(w, 2, "ENTITIES");
    for (size_t i = 0; i < w->s->item_count && !w->out.failed; i++) {
        const sheet_item *item = &w->s->items[i];
        if (item->kind == SHEET_TEXT && item->text)
            put_text(w, item);
        for (uint32_t k = 0; k < item->count; k++) {
            if (item->kind == SHEET_DOTS)
                put_dots(w, item, &w->s->paths[item->first + k]);
            else if (item->kind == SHEET_PATH)
                put_path(w, item, &w->s->paths[item->first + k]);
        }
    }
    put(w, 0, "ENDSEC");
    put(w, 0, "EOF");
}

lmn_status export_dxf(export_bytes *out, const sheet *s, lmn_error *error)
{
    dxf_writer w = {.s = s};
    *out = (export_bytes){NULL, 0};
    w.out.failed = s->failed;
    find_layers(&w);
    if (!w.out.failed) {
        put_header(&w);
        put_tables(&w);
        put_entities(&w);
    }
    mem_free(w.layers);
    mem_free(w.layer_of);
    out->size = w.out.size;
    out->data = (unsigned char *)text_take(&w.out);
    return out->data ? LMN_OK : error_memory(error);
}
