/* DXF of a sheet: release 2000 in ASCII, which has what curves and dashes need and everything reads. Millimetres, the
 * sheet's lower left corner at the origin, y up. A layer for each class of lines of each part, a line type for each
 * pattern of dashes. Entities are in dxf_entities.c. Codes are those of Autodesk's DXF reference. */
#include "export/export.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "export/dxf_private.h"

enum { LAYER_NAME_MOST = 200 }; /* letters; what the release allows is 255 */
/* Dashes whose gap is so alike a fraction of them are stretched copies of each other. */
static const double alike_pattern = 0.05;
enum { CERTAIN_DASHES = 8, DASHES_LOOKED_AT = 33 }; /* lengths of a path whose pattern is certain; most of a kind */

/* The colours of AutoCAD's palette that have names; 7 is black on paper. */
static const float palette[][3] = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0},          {0, 1, 1},
                                   {0, 0, 1}, {1, 0, 1}, {0, 0, 0}, {0.5f, 0.5f, 0.5f}, {0.75f, 0.75f, 0.75f}};

int dxf_palette_index(colour ink)
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

/* --- pairs ---------------------------------------------------------------------------------------------- */

void dxf_put(dxf_writer *w, int code, const char *value)
{
    char digits[16];
    int  size = snprintf(digits, sizeof digits, "%d\n", code);
    text_append_bytes(&w->out, digits, (size_t)size);
    text_append_bytes(&w->out, value, strlen(value));
    text_append_bytes(&w->out, "\n", 1);
}

void dxf_put_whole(dxf_writer *w, int code, int value)
{
    text_append(&w->out, "%d\n%d\n", code, value);
}

void dxf_put_handle(dxf_writer *w, int code, unsigned handle)
{
    text_append(&w->out, "%d\n%X\n", code, handle);
}

void dxf_put_number(dxf_writer *w, int code, double value)
{
    char               digits[48];
    long long          scaled = isfinite(value) ? llround(value * 10000) : 0;
    unsigned long long left = scaled < 0 ? (unsigned long long)-scaled : (unsigned long long)scaled;
    int                size =
        snprintf(digits, sizeof digits, "%d\n%s%llu.%04llu", code, scaled < 0 ? "-" : "", left / 10000, left % 10000);
    for (int least = size - 3; size > least && digits[size - 1] == '0';) /* reals have a point and a digit behind it */
        size--;
    digits[size++] = '\n';
    text_append_bytes(&w->out, digits, (size_t)size);
}

void dxf_put_position(dxf_writer *w, int code, double x, double y)
{
    dxf_put_number(w, code, x);
    dxf_put_number(w, code + 10, w->s->height - y);
    dxf_put_number(w, code + 20, 0);
}

static void append_words(text *out, const char *words)
{
    for (const unsigned char *at = (const unsigned char *)words; *at;) {
        size_t   length = *at >= 0xF0 ? 4 : *at >= 0xE0 ? 3 : *at >= 0xC0 ? 2 : 1, seen = 1;
        uint32_t code = length == 1 ? *at : *at & (0xFFu >> (length + 1));
        for (; seen < length && (at[seen] & 0xC0) == 0x80; seen++)
            code = code << 6 | (at[seen] & 0x3F);
        /* Fonts of CAD programs have few letters: a dash that LibreCAD's lack is the one that all have. */
        if (code == 0x2013)
            text_append_bytes(out, "-", 1);
        else if (*at >= 0x20 && *at < 0x7F)
            text_append_bytes(out, (const char *)at, 1);
        else
            text_append(out, *at >= 0x80 ? "\\U+%04X" : " ",
                        (unsigned)(seen < length || (length == 1 && *at >= 0x80) || code > 0xFFFF ? 0xFFFD : code));
        at += seen;
    }
}

void dxf_put_words(dxf_writer *w, int code, const char *words)
{
    text_append(&w->out, "%d\n", code);
    append_words(&w->out, words);
    text_append_bytes(&w->out, "\n", 1);
}

/* --- layers --------------------------------------------------------------------------------------------- */

/* A group's layer: its classes, and behind them the part that it is of, "HIDDEN-CREASE - shaft"; "SHEET" where it has
 * none. What no name may have becomes "-". */
static char *layer_name(const sheet *s, uint32_t group)
{
    const sheet_group *g = &s->groups[group];
    text               name = {0};
    for (const char *at = g->css_class && *g->css_class ? g->css_class : "sheet"; *at; at++) {
        bool letter = (*at >= 'a' && *at <= 'z') || (*at >= 'A' && *at <= 'Z');
        char own = letter ? (char)(*at & ~0x20) : *at >= '0' && *at <= '9' ? *at : '-';
        text_append_bytes(&name, &own, 1);
    }
    while (!g->part && g->parent >= 0)
        g = &s->groups[g->parent];
    if (g->part && g->name && *g->name) {
        char *own = mem_copy_text(g->name);
        for (char *at = own; at && *at; at++)
            if (strchr("<>/\\\":;?*|=`,'", *at) || (unsigned char)*at < 0x20 || *at == 0x7F)
                *at = '-';
        text_append_bytes(&name, " - ", 3);
        if (own)
            append_words(&name, own);
        name.failed = name.failed || !own;
        mem_free(own);
    }
    if (name.size > LAYER_NAME_MOST)
        name.data[LAYER_NAME_MOST] = '\0';
    return text_take(&name);
}

static uint64_t hash_name(const char *name)
{
    uint64_t hash = UINT64_C(0xCBF29CE484222325);
    for (; *name; name++)
        hash = (hash ^ (unsigned char)*name) * UINT64_C(0x100000001B3);
    return hash ^ hash >> 29;
}

/* Takes the name. */
static uint32_t find_layer(dxf_writer *w, char *name, int ink, int weight)
{
    size_t at = name ? hash_name(name) & (w->layer_slot_count - 1) : 0;
    for (; name && w->layer_slots[at]; at = (at + 1) & (w->layer_slot_count - 1))
        if (strcmp(w->layers[w->layer_slots[at] - 1].name, name) == 0) {
            mem_free(name);
            return w->layer_slots[at] - 1;
        }
    if (!name || !mem_grow((void **)&w->layers, &w->layer_capacity, w->layer_count + 1, sizeof *w->layers)) {
        mem_free(name);
        w->out.failed = true;
        return 0;
    }
    w->layers[w->layer_count] = (dxf_layer){name, ink, weight};
    w->layer_slots[at] = (uint32_t)++w->layer_count;
    return (uint32_t)w->layer_count - 1;
}

static void find_layers(dxf_writer *w)
{
    size_t groups = w->s->group_count;
    for (w->layer_slot_count = 16; w->layer_slot_count < 2 * groups + 4;)
        w->layer_slot_count *= 2;
    w->layer_of = mem_calloc(groups + 1, sizeof *w->layer_of);
    w->layer_slots = mem_calloc(w->layer_slot_count, sizeof *w->layer_slots);
    if (!w->layer_of || !w->layer_slots) {
        w->out.failed = true;
        return;
    }
    find_layer(w, mem_copy_text("0"), 7, DXF_NO_WEIGHT);
    for (size_t i = 0; i < w->s->item_count && !w->out.failed; i++) {
        uint32_t group = w->s->items[i].group;
        if (group < groups && !w->layer_of[group])
            w->layer_of[group] = find_layer(w, layer_name(w->s, group), dxf_palette_index(w->s->items[i].ink),
                                            dxf_weight_of(w->s, &w->s->items[i]));
    }
}

const dxf_layer *dxf_layer_of(const dxf_writer *w, const sheet_item *item)
{
    return &w->layers[item->group < w->s->group_count ? w->layer_of[item->group] : 0];
}

/* --- line types ----------------------------------------------------------------------------------------- */

static int compare_lengths(const void *a, const void *b)
{
    float one = *(const float *)a, other = *(const float *)b;
    return one < other ? -1 : one > other;
}

/* Of all dashes, or all gaps, but those at the ends: the one in the middle of them by length. */
static double middle_length(const float *lengths, uint32_t count)
{
    float    own[DASHES_LOOKED_AT];
    uint32_t taken = 0, ends = count >= CERTAIN_DASHES ? 2 : 0;
    for (uint32_t i = ends; i < count - ends && taken < DASHES_LOOKED_AT; i += 2)
        own[taken++] = lengths[i];
    qsort(own, taken, sizeof *own, compare_lengths);
    return (double)own[taken / 2];
}

/* Four lengths are a pattern where they come again: two dashes, told one by one, are as long as their line. */
static bool has_dots(const sheet *s, const sheet_path *path)
{
    const float *lengths = s->dashes + path->first_dash;
    double       period = 0, length = 0;
    if (path->dash_count != DXF_PATTERN_MOST)
        return false;
    for (int i = 0; i < DXF_PATTERN_MOST; i++)
        period += (double)lengths[i];
    for (uint32_t i = path->closed ? 0 : 1; i < path->count; i++) {
        const float *a = s->points[path->first + (i ? i : path->count) - 1], *b = s->points[path->first + i];
        length += hypot((double)(b[0] - a[0]), (double)(b[1] - a[1]));
    }
    return length > period;
}

dxf_line_type dxf_pattern_of(const sheet *s, const sheet_path *path)
{
    /* The ends of a line, and corners, may have dashes of their own; programs lay patterns out as they like. */
    const float  *lengths = s->dashes + path->first_dash;
    dxf_line_type own = {.count = 2};
    if (has_dots(s, path)) {
        own.count = DXF_PATTERN_MOST;
        for (int i = 0; i < DXF_PATTERN_MOST; i++)
            own.lengths[i] = (double)lengths[i];
        return own;
    }
    for (int i = 0; i < 2; i++)
        own.lengths[i] = middle_length(lengths + i, path->dash_count);
    return own;
}

const char *dxf_line_type_name(const dxf_writer *w, size_t index, char out[DXF_NAME_CAPACITY])
{
    /* LibreCAD has patterns of its own for these names and none for others; the first is nearest to what is usual. */
    enum { KNOWN = 4 };
    static const char *const dashed[KNOWN] = {"DASHEDTINY", "DASHED2", "DASHED", "DASHEDX2"}, *const dotted[KNOWN] = {
                                                                                                  "CENTERTINY",
                                                                                                  "CENTER2", "CENTER",
                                                                                                  "CENTERX2"};
    const bool with_dots = w->line_types[index].count == DXF_PATTERN_MOST;
    size_t     number = 0; /* among those that are like it */
    for (size_t i = 0; i < index; i++)
        number += w->line_types[i].count == w->line_types[index].count;
    if (number < KNOWN)
        return (with_dots ? dotted : dashed)[number];
    snprintf(out, DXF_NAME_CAPACITY, "%s-%zu", with_dots ? "CENTER" : "DASHED", number + 1);
    return out;
}

/* How much one is no stretched copy of the other. */
static double difference(const dxf_line_type *a, const dxf_line_type *b)
{
    double most = a->count == b->count ? 0 : INFINITY;
    for (int i = 1; i < a->count && a->count == b->count; i++)
        most = fmax(most, fabs(a->lengths[i] / a->lengths[0] - b->lengths[i] / b->lengths[0]));
    return most;
}

/* The line type that a pattern is a stretched copy of, or nearest to; `apart` is infinite where there is none. */
static size_t nearest_line_type(const dxf_writer *w, const dxf_line_type *own, double *apart)
{
    size_t best = 0;
    *apart = INFINITY;
    for (size_t i = 0; i < w->line_type_count; i++) {
        double there = difference(&w->line_types[i], own);
        best = there < *apart ? i : best;
        *apart = fmin(*apart, there);
    }
    return best;
}

/* Those of few dashes take what others have. */
static void find_line_types(dxf_writer *w)
{
    w->line_type_of = mem_calloc(w->s->path_count + 1, sizeof *w->line_type_of);
    w->out.failed = w->out.failed || !w->line_type_of;
    for (int pass = 0; pass < 2; pass++)
        for (size_t i = 0; i < w->s->path_count && !w->out.failed; i++) {
            const sheet_path *path = &w->s->paths[i];
            dxf_line_type     own = path->dash_count ? dxf_pattern_of(w->s, path) : (dxf_line_type){.count = 0};
            bool              certain = path->dash_count == 2 || path->dash_count >= CERTAIN_DASHES || own.count > 2;
            if (!(own.lengths[0] > 0) || !(own.lengths[1] > 0) || certain != (pass == 0))
                continue;
            double apart;
            size_t at = nearest_line_type(w, &own, &apart);
            if (apart > alike_pattern && (certain || isinf(apart))) {
                at = w->line_type_count;
                if (!mem_grow((void **)&w->line_types, &w->line_type_capacity, at + 1, sizeof *w->line_types)) {
                    w->out.failed = true;
                    return;
                }
                w->line_types[w->line_type_count++] = own;
            }
            w->line_type_of[i] = (uint32_t)at + 1;
        }
}

/* --- sections ------------------------------------------------------------------------------------------- */

static void begin_section(dxf_writer *w, const char *name)
{
    dxf_put(w, 0, "SECTION");
    dxf_put(w, 2, name);
}

static void put_header(dxf_writer *w)
{
    begin_section(w, "HEADER");
    dxf_put(w, 9, "$ACADVER");
    dxf_put(w, 1, "AC1015");
    dxf_put(w, 9, "$DWGCODEPAGE");
    dxf_put(w, 3, "ANSI_1252");
    dxf_put(w, 9, "$INSUNITS");
    dxf_put_whole(w, 70, 4); /* millimetres */
    dxf_put(w, 9, "$MEASUREMENT");
    dxf_put_whole(w, 70, 1); /* metric */
    dxf_put(w, 9, "$LTSCALE");
    dxf_put_number(w, 40, 1);
    dxf_put(w, 9, "$PLINEGEN");
    dxf_put_whole(w, 70, 1); /* dashes go on round corners */
    dxf_put(w, 9, "$EXTMIN");
    dxf_put_position(w, 10, 0, w->s->height);
    dxf_put(w, 9, "$EXTMAX");
    dxf_put_position(w, 10, w->s->width, 0);
    dxf_put(w, 9, "$HANDSEED");
    dxf_put(w, 5, "FFFFFFF");
    dxf_put(w, 0, "ENDSEC");
}

static unsigned begin_table(dxf_writer *w, const char *name, size_t count)
{
    unsigned own = ++w->handle;
    dxf_put(w, 0, "TABLE");
    dxf_put(w, 2, name);
    dxf_put_handle(w, 5, own);
    dxf_put_whole(w, 330, 0);
    dxf_put(w, 100, "AcDbSymbolTable");
    dxf_put_whole(w, 70, (int)count);
    return own;
}

static void begin_record(dxf_writer *w, const char *type, const char *class_name, unsigned table, unsigned handle)
{
    dxf_put(w, 0, type);
    dxf_put_handle(w, strcmp(type, "DIMSTYLE") == 0 ? 105 : 5, handle ? handle : ++w->handle);
    dxf_put_handle(w, 330, table);
    dxf_put(w, 100, "AcDbSymbolTableRecord");
    dxf_put(w, 100, class_name);
}

static void put_line_type(dxf_writer *w, unsigned table, const char *name, const char *words, const dxf_line_type *t)
{
    double period = 0;
    for (int i = 0; i < t->count; i++)
        period += t->lengths[i];
    begin_record(w, "LTYPE", "AcDbLinetypeTableRecord", table, 0);
    dxf_put(w, 2, name);
    dxf_put_whole(w, 70, 0);
    dxf_put(w, 3, words);
    dxf_put_whole(w, 72, 65);
    dxf_put_whole(w, 73, t->count);
    dxf_put_number(w, 40, period);
    for (int i = 0; i < t->count; i++) {
        dxf_put_number(w, 49, i % 2 ? -t->lengths[i] : t->lengths[i]);
        dxf_put_whole(w, 74, 0);
    }
}

static void put_line_types(dxf_writer *w)
{
    static const dxf_line_type unbroken = {.count = 0};
    unsigned                   table = begin_table(w, "LTYPE", w->line_type_count + 3);
    put_line_type(w, table, "ByBlock", "", &unbroken);
    put_line_type(w, table, "ByLayer", "", &unbroken);
    put_line_type(w, table, "Continuous", "Solid line", &unbroken);
    for (size_t i = 0; i < w->line_type_count; i++) {
        char                 name[DXF_NAME_CAPACITY];
        const dxf_line_type *t = &w->line_types[i];
        put_line_type(w, table, dxf_line_type_name(w, i, name),
                      t->count == DXF_PATTERN_MOST ? "Long dash dot ____ . ____" : "Dashed __ __ __", t);
    }
    dxf_put(w, 0, "ENDTAB");
}

static void put_layers(dxf_writer *w)
{
    unsigned table = begin_table(w, "LAYER", w->layer_count);
    for (size_t i = 0; i < w->layer_count; i++) {
        begin_record(w, "LAYER", "AcDbLayerTableRecord", table, 0);
        dxf_put(w, 2, w->layers[i].name);
        dxf_put_whole(w, 70, 0);
        dxf_put_whole(w, 62, w->layers[i].ink);
        dxf_put(w, 6, "Continuous");
        dxf_put_whole(w, 370, w->layers[i].weight);
    }
    dxf_put(w, 0, "ENDTAB");
}

static void put_view_port(dxf_writer *w)
{
    unsigned table = begin_table(w, "VPORT", 1);
    begin_record(w, "VPORT", "AcDbViewportTableRecord", table, 0);
    dxf_put(w, 2, "*Active");
    dxf_put_whole(w, 70, 0);
    const double corners[2][2] = {{0, 0}, {1, 1}};
    for (int i = 0; i < 2; i++) {
        dxf_put_number(w, 10 + i, corners[i][0]);
        dxf_put_number(w, 20 + i, corners[i][1]);
    }
    dxf_put_number(w, 12, w->s->width / 2);
    dxf_put_number(w, 22, w->s->height / 2);
    dxf_put_number(w, 40, w->s->height);
    dxf_put_number(w, 41, w->s->width / w->s->height);
    dxf_put(w, 0, "ENDTAB");
}

/* What every file has to have, however little it says. */
static void put_other_tables(dxf_writer *w)
{
    unsigned table = begin_table(w, "STYLE", 1);
    begin_record(w, "STYLE", "AcDbTextStyleTableRecord", table, 0);
    dxf_put(w, 2, "Standard");
    dxf_put_whole(w, 70, 0);
    dxf_put_number(w, 40, 0);
    dxf_put_number(w, 41, 1);
    dxf_put_number(w, 50, 0);
    dxf_put_whole(w, 71, 0);
    dxf_put_number(w, 42, 2.5);
    dxf_put(w, 3, "arial.ttf");
    dxf_put(w, 4, "");
    dxf_put(w, 0, "ENDTAB");
    for (int i = 0; i < 2; i++) {
        begin_table(w, i ? "UCS" : "VIEW", 0);
        dxf_put(w, 0, "ENDTAB");
    }
    table = begin_table(w, "APPID", 1);
    begin_record(w, "APPID", "AcDbRegAppTableRecord", table, 0);
    dxf_put(w, 2, "ACAD");
    dxf_put_whole(w, 70, 0);
    dxf_put(w, 0, "ENDTAB");
    table = begin_table(w, "DIMSTYLE", 1);
    dxf_put(w, 100, "AcDbDimStyleTable");
    begin_record(w, "DIMSTYLE", "AcDbDimStyleTableRecord", table, 0);
    dxf_put(w, 2, "Standard");
    dxf_put_whole(w, 70, 0);
    dxf_put(w, 0, "ENDTAB");
}

static const char *const spaces[2] = {"*Model_Space", "*Paper_Space"};
static const unsigned    space_handles[2] = {DXF_MODEL_SPACE, DXF_PAPER_SPACE};

static void put_tables(dxf_writer *w)
{
    begin_section(w, "TABLES");
    put_view_port(w);
    put_line_types(w);
    put_layers(w);
    put_other_tables(w);
    unsigned table = begin_table(w, "BLOCK_RECORD", 2);
    for (int i = 0; i < 2; i++) {
        begin_record(w, "BLOCK_RECORD", "AcDbBlockTableRecord", table, space_handles[i]);
        dxf_put(w, 2, spaces[i]);
    }
    dxf_put(w, 0, "ENDTAB");
    dxf_put(w, 0, "ENDSEC");
}

static void put_blocks(dxf_writer *w)
{
    begin_section(w, "BLOCKS");
    for (int i = 0; i < 2; i++) {
        dxf_put(w, 0, "BLOCK");
        dxf_put_handle(w, 5, ++w->handle);
        dxf_put_handle(w, 330, space_handles[i]);
        dxf_put(w, 100, "AcDbEntity");
        dxf_put(w, 8, "0");
        dxf_put(w, 100, "AcDbBlockBegin");
        dxf_put(w, 2, spaces[i]);
        dxf_put_whole(w, 70, 0);
        dxf_put_position(w, 10, 0, w->s->height);
        dxf_put(w, 3, spaces[i]);
        dxf_put(w, 1, "");
        dxf_put(w, 0, "ENDBLK");
        dxf_put_handle(w, 5, ++w->handle);
        dxf_put_handle(w, 330, space_handles[i]);
        dxf_put(w, 100, "AcDbEntity");
        dxf_put(w, 8, "0");
        dxf_put(w, 100, "AcDbBlockEnd");
    }
    dxf_put(w, 0, "ENDSEC");
}

static void put_objects(dxf_writer *w)
{
    unsigned root = ++w->handle, groups = ++w->handle;
    begin_section(w, "OBJECTS");
    dxf_put(w, 0, "DICTIONARY");
    dxf_put_handle(w, 5, root);
    dxf_put_whole(w, 330, 0);
    dxf_put(w, 100, "AcDbDictionary");
    dxf_put_whole(w, 281, 1);
    dxf_put(w, 3, "ACAD_GROUP");
    dxf_put_handle(w, 350, groups);
    dxf_put(w, 0, "DICTIONARY");
    dxf_put_handle(w, 5, groups);
    dxf_put_handle(w, 330, root);
    dxf_put(w, 100, "AcDbDictionary");
    dxf_put_whole(w, 281, 1);
    dxf_put(w, 0, "ENDSEC");
}

lmn_status export_dxf(export_bytes *out, const sheet *s, lmn_error *error)
{
    dxf_writer w = {.s = s, .handle = DXF_FIRST_HANDLE};
    *out = (export_bytes){NULL, 0};
    w.out.failed = s->failed;
    find_layers(&w);
    find_line_types(&w);
    if (!w.out.failed) {
        put_header(&w);
        put_tables(&w);
        put_blocks(&w);
        dxf_put_entities(&w);
        put_objects(&w);
        dxf_put(&w, 0, "EOF");
    }
    for (size_t i = 0; i < w.layer_count; i++)
        mem_free(w.layers[i].name);
    mem_free(w.layers);
    mem_free(w.layer_of);
    mem_free(w.layer_slots);
    mem_free(w.line_types);
    mem_free(w.line_type_of);
    out->size = w.out.size;
    out->data = (unsigned char *)text_take(&w.out);
    return out->data ? LMN_OK : error_memory(error);
}
