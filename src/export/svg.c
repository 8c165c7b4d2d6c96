/* SVG of a sheet: millimetres, a group for each of the sheet's groups, styles as classes, of a whole group where all
 * that lies in it is drawn alike. Numbers have three decimals at most, so that files are small; between points of a
 * path it is their rounded differences that are written, which add up without drift. */
#include "export/export.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "base/text.h"
#include "export/svg_private.h"
#include "sheet/fit.h"
#include "sheet/sheet.h"

#define PI 3.14159265358979323846

/* How a path is drawn: what becomes a class. */
typedef struct svg_style {
    colour    ink;
    bool      filled, dots;
    float     width;
    sheet_cap cap;
    double    hatch[5]; /* distance, angle, origin, width; of areas that are hatched */
} svg_style;

typedef struct svg_writer {
    text         out;
    const sheet *s;
    char       **ids;          /* of groups */
    bool        *opened;       /* groups whose id is out */
    uint32_t    *group_styles; /* of each group: style + 1, 0: of its items, or of none */
    uint32_t    *id_slots;     /* hash of ids: group + 1 */
    size_t       slot_count;
    svg_style   *styles;
    size_t       style_count, style_capacity;
    uint32_t    *style_slots; /* hash of styles: style + 1 */
    size_t       style_slot_count;
    svg_dashes   dashes;
    int32_t      open; /* the innermost group that is open, −1: none */
} svg_writer;

/* --- text and numbers ----------------------------------------------------------------------------------- */

static void put(svg_writer *w, const char *words)
{
    text_append_bytes(&w->out, words, strlen(words));
}

static void put_number(svg_writer *w, double value)
{
    char digits[32];
    text_append_bytes(&w->out, digits, svg_print_thousandths(digits, svg_thousandths(value)));
}

/* The length of a UTF-8 sequence that XML allows, 0 when there is none here. */
static size_t xml_sequence(const unsigned char *at)
{
    if (at[0] < 0x80)
        return at[0] >= 0x20 && at[0] != 0x7F;
    size_t length = at[0] >= 0xF0 ? 4 : at[0] >= 0xE0 ? 3 : 2;
    if (at[0] < 0xC2 || at[0] > 0xF4)
        return 0;
    for (size_t i = 1; i < length; i++)
        if ((at[i] & 0xC0) != 0x80)
            return 0;
    uint32_t low = at[1];
    bool     beyond = (at[0] == 0xE0 && low < 0xA0) || (at[0] == 0xED && low > 0x9F) || (at[0] == 0xF0 && low < 0x90) ||
                  (at[0] == 0xF4 && low > 0x8F);
    bool none = at[0] == 0xEF && low == 0xBF && at[2] >= 0xBE; /* U+FFFE, U+FFFF */
    return beyond || none || (at[0] == 0xC2 && low < 0xA0) ? 0 : length;
}

/* Text with what is special escaped; bytes that XML cannot hold become U+FFFD, control characters blanks. */
static void put_escaped(svg_writer *w, const char *words)
{
    for (const unsigned char *at = (const unsigned char *)words; *at;) {
        size_t length = xml_sequence(at);
        switch (*at) {
        case '<': put(w, "&lt;"); break;
        case '>': put(w, "&gt;"); break;
        case '&': put(w, "&amp;"); break;
        case '"': put(w, "&quot;"); break;
        default:
            if (length)
                text_append_bytes(&w->out, (const char *)at, length);
            else
                put(w, *at < 0x80 ? " " : "\xEF\xBF\xBD");
        }
        at += length ? length : 1;
    }
}

static void put_element(svg_writer *w, const char *name, const char *words)
{
    if (!words || !*words)
        return;
    text_append(&w->out, "<%s>", name);
    put_escaped(w, words);
    text_append(&w->out, "</%s>\n", name);
}

static void put_base64(svg_writer *w, const unsigned char *data, size_t size)
{
    static const char digits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    for (size_t i = 0; i < size; i += 3) {
        uint32_t bits = (uint32_t)data[i] << 16 | (uint32_t)(i + 1 < size ? data[i + 1] : 0) << 8 |
                        (i + 2 < size ? data[i + 2] : 0);
        char four[4] = {digits[bits >> 18], digits[bits >> 12 & 63], digits[bits >> 6 & 63], digits[bits & 63]};
        if (i + 2 >= size)
            four[3] = '=';
        if (i + 1 >= size)
            four[2] = '=';
        text_append_bytes(&w->out, four, 4);
    }
}

/* "#rrggbb". */
static void print_colour(char out[10], colour ink)
{
    colour_print((colour){ink.r, ink.g, ink.b, 1}, out);
}

/* Opaque unless it says otherwise; what is no number is opaque too. */
static double opacity_of(colour ink)
{
    return ink.a < 1 ? fmax((double)ink.a, 0) : 1;
}

/* --- styles --------------------------------------------------------------------------------------------- */

static uint64_t hash_bytes(const void *bytes, size_t size)
{
    uint64_t hash = UINT64_C(0xCBF29CE484222325);
    for (size_t i = 0; i < size; i++)
        hash = (hash ^ ((const unsigned char *)bytes)[i]) * UINT64_C(0x100000001B3);
    return hash ^ hash >> 29;
}

/* Padding is zero, so that bytes can be compared. */
static void style_of(svg_style *out, const sheet_item *item, const sheet_path *path)
{
    memset(out, 0, sizeof *out);
    out->ink = item->ink;
    out->dots = item->kind == SHEET_DOTS;
    out->filled = path->filled && !out->dots;
    if (out->filled && item->hatch.apart > 0) {
        const double hatch[5] = {item->hatch.apart, item->hatch.angle, item->hatch.origin[0], item->hatch.origin[1],
                                 item->hatch.width};
        memcpy(out->hatch, hatch, sizeof hatch);
    }
    if (out->filled)
        return;
    out->width = path->width;
    out->cap = out->dots ? SHEET_CAP_ROUND : path->cap;
}

static bool grow_style_slots(svg_writer *w)
{
    size_t    count = w->style_slot_count ? 4 * w->style_slot_count : 256;
    uint32_t *slots = mem_calloc(count, sizeof *slots);
    if (!slots)
        return false;
    for (size_t i = 0; i < w->style_count; i++) {
        size_t at = hash_bytes(&w->styles[i], sizeof w->styles[i]) & (count - 1);
        while (slots[at])
            at = (at + 1) & (count - 1);
        slots[at] = (uint32_t)i + 1;
    }
    mem_free(w->style_slots);
    w->style_slots = slots;
    w->style_slot_count = count;
    return true;
}

/* The number of a style, which is added when it is new. */
static size_t find_style(svg_writer *w, const svg_style *style)
{
    if (2 * w->style_count >= w->style_slot_count && !grow_style_slots(w)) {
        w->out.failed = true;
        return 0;
    }
    size_t at = hash_bytes(style, sizeof *style) & (w->style_slot_count - 1);
    for (; w->style_slots[at]; at = (at + 1) & (w->style_slot_count - 1))
        if (memcmp(&w->styles[w->style_slots[at] - 1], style, sizeof *style) == 0)
            return w->style_slots[at] - 1;
    if (!mem_grow((void **)&w->styles, &w->style_capacity, w->style_count + 1, sizeof *w->styles)) {
        w->out.failed = true;
        return 0;
    }
    w->styles[w->style_count] = *style;
    w->style_slots[at] = (uint32_t)++w->style_count;
    return w->style_count - 1;
}

enum { STYLE_NONE = 0, STYLE_SEVERAL = UINT32_MAX };

/* A group that has one style has it for all of its items; groups around others, and such as have texts, which would
 * take it, have none. */
static void note_style(svg_writer *w, uint32_t group, size_t style)
{
    if (group >= w->s->group_count)
        return;
    uint32_t *own = &w->group_styles[group];
    *own = *own == STYLE_NONE || *own == style + 1 ? (uint32_t)style + 1 : STYLE_SEVERAL;
}

static void find_styles(svg_writer *w)
{
    const sheet *s = w->s;
    for (size_t i = 0; i < s->group_count; i++)
        if (s->groups[i].parent >= 0)
            w->group_styles[s->groups[i].parent] = STYLE_SEVERAL;
    for (size_t i = 0; i < s->item_count; i++) {
        const sheet_item *item = &s->items[i];
        if (item->kind == SHEET_TEXT && item->group < s->group_count)
            w->group_styles[item->group] = STYLE_SEVERAL;
        for (uint32_t k = 0; k < item->count; k++) {
            svg_style style;
            style_of(&style, item, &s->paths[item->first + k]);
            note_style(w, item->group, find_style(w, &style));
            if (s->paths[item->first + k].dash_count && !svg_dashes_note(&w->dashes, s, &s->paths[item->first + k]))
                w->out.failed = true;
        }
    }
    svg_dashes_name(&w->dashes);
    for (size_t i = 0; i < s->group_count; i++)
        if (w->group_styles[i] == STYLE_SEVERAL)
            w->group_styles[i] = STYLE_NONE;
}

static void put_style(svg_writer *w, size_t index)
{
    const svg_style *style = &w->styles[index];
    char             ink[10];
    print_colour(ink, style->ink);
    text_append(&w->out, ".s%zu{", index);
    if (style->hatch[0] > 0) {
        text_append(&w->out, "fill:url(#hatch.%zu)", index);
    } else if (style->filled) {
        text_append(&w->out, "fill:%s", ink);
        if (opacity_of(style->ink) < 1) {
            put(w, ";fill-opacity:");
            put_number(w, opacity_of(style->ink));
        }
    } else {
        text_append(&w->out, "stroke:%s;stroke-width:", ink);
        put_number(w, (double)style->width);
        if (opacity_of(style->ink) < 1) {
            put(w, ";stroke-opacity:");
            put_number(w, opacity_of(style->ink));
        }
        if (style->cap == SHEET_CAP_BUTT)
            put(w, ";stroke-linecap:butt");
    }
    put(w, "}\n");
}

static void put_styles(svg_writer *w)
{
    put(w, "<style>\nsvg{fill:none;stroke-linecap:round;stroke-linejoin:round}\ntext{font-family:'Liberation "
           "Sans',Arial,Helvetica,sans-serif}\n");
    for (size_t i = 0; i < w->style_count && !w->out.failed; i++)
        put_style(w, i);
    for (size_t i = 0; i < w->dashes.count; i++)
        if (w->dashes.patterns[i].name >= 0)
            text_append(&w->out, ".d%d{stroke-dasharray:%s}\n", w->dashes.patterns[i].name,
                        w->dashes.patterns[i].lengths);
    put(w, "</style>\n");
}

/* --- groups --------------------------------------------------------------------------------------------- */

/* Letters that every reader of ids takes. */
static void append_id(text *id, const char *name)
{
    for (const char *at = name ? name : ""; *at; at++) {
        bool plain = (*at >= 'a' && *at <= 'z') || (*at >= 'A' && *at <= 'Z') || (*at >= '0' && *at <= '9') ||
                     *at == '-' || *at == '_';
        text_append_bytes(id, plain ? at : "_", 1);
    }
}

/* The slot of an id: of the group that has it, or a free one. */
static size_t id_slot(const svg_writer *w, const char *id)
{
    size_t at = hash_bytes(id, strlen(id)) & (w->slot_count - 1);
    while (w->id_slots[at] && strcmp(w->ids[w->id_slots[at] - 1], id) != 0)
        at = (at + 1) & (w->slot_count - 1);
    return at;
}

/* The parent's id and the group's own name; where another group has it already a number is added until none has. */
static bool name_group(svg_writer *w, size_t index)
{
    const sheet_group *g = &w->s->groups[index];
    text               id = {0};
    if (g->parent >= 0)
        text_append(&id, "%s-", w->ids[g->parent]);
    if (g->part)
        text_append(&id, "part-%u", g->part);
    else
        append_id(&id, g->name && *g->name ? g->name : "group");
    if (id.data && !((*id.data | 0x20) >= 'a' && (*id.data | 0x20) <= 'z') && *id.data != '_') {
        text lettered = {0};
        text_append(&lettered, "g%s", id.data);
        text_release(&id);
        id = lettered;
    }
    if (id.failed || !id.data) {
        text_release(&id);
        return false;
    }
    size_t length = id.size;
    for (size_t again = 2; w->id_slots[id_slot(w, id.data)]; again++) {
        id.size = length;
        text_append(&id, "-%zu", again);
        if (id.failed) {
            text_release(&id);
            return false;
        }
    }
    w->id_slots[id_slot(w, id.data)] = (uint32_t)index + 1;
    w->ids[index] = text_take(&id);
    return w->ids[index] != NULL;
}

static bool name_groups(svg_writer *w)
{
    size_t count = w->s->group_count;
    w->slot_count = 16;
    while (w->slot_count < 2 * count)
        w->slot_count *= 2;
    w->ids = mem_calloc(count, sizeof *w->ids);
    w->opened = mem_calloc(count, sizeof *w->opened);
    w->id_slots = mem_calloc(w->slot_count, sizeof *w->id_slots);
    w->group_styles = mem_calloc(count, sizeof *w->group_styles);
    bool good = w->ids && w->opened && w->id_slots && w->group_styles;
    for (size_t i = 0; i < count && good; i++)
        good = name_group(w, i);
    return good;
}

static void open_group(svg_writer *w, uint32_t index)
{
    const sheet_group *g = &w->s->groups[index];
    put(w, "<g");
    if (!w->opened[index])
        text_append(&w->out, " id=\"%s\"", w->ids[index]);
    w->opened[index] = true;
    bool named = g->css_class && *g->css_class, styled = w->group_styles[index] != STYLE_NONE;
    if (named || styled) {
        put(w, " class=\"");
        put_escaped(w, named ? g->css_class : "");
        if (styled)
            text_append(&w->out, "%ss%u", named ? " " : "", w->group_styles[index] - 1);
        put(w, "\"");
    }
    if (g->part) {
        text_append(&w->out, " data-part=\"%u\" data-name=\"", g->part);
        put_escaped(w, g->name ? g->name : "");
        put(w, "\"");
    }
    put(w, " inkscape:groupmode=\"layer\" inkscape:label=\"");
    put_escaped(w, g->name && *g->name ? g->name : w->ids[index]);
    put(w, "\"");
    if (g->clip[2] > 0)
        text_append(&w->out, " clip-path=\"url(#%s.clip)\"", w->ids[index]);
    put(w, ">\n");
    w->open = (int32_t)index;
}

/* Is `above` the group or one that it lies in? */
static bool lies_in(const sheet *s, int32_t group, int32_t above)
{
    while (group > above)
        group = s->groups[group].parent;
    return group == above;
}

/* Closes what the group does not lie in, and opens what it lies in. */
static void go_to_group(svg_writer *w, int32_t group)
{
    while (w->open >= 0 && !lies_in(w->s, group, w->open)) {
        put(w, "</g>\n");
        w->open = w->s->groups[w->open].parent;
    }
    while (w->open != group) {
        int32_t next = group;
        while (w->s->groups[next].parent != w->open)
            next = w->s->groups[next].parent;
        open_group(w, (uint32_t)next);
    }
}

static void put_attribute(svg_writer *w, const char *name, double value)
{
    text_append(&w->out, " %s=\"", name);
    put_number(w, value);
    put(w, "\"");
}

/* One line a tile, which is so long that none ends on the page, since tiles that meet along a line show where; and no
 * longer, since renderers make pictures of tiles. It is laid around the page's middle. */
static void put_pattern(svg_writer *w, size_t index)
{
    const svg_style *style = &w->styles[index];
    const double    *h = style->hatch, middle[2] = {w->s->width / 2, w->s->height / 2},
                 across[2] = {-sin(h[1]), cos(h[1])};
    const double half = hypot(middle[0], middle[1]) + h[0];
    /* From the middle to the nearest line. */
    const double off = remainder((h[2] - middle[0]) * across[0] + (h[3] - middle[1]) * across[1], h[0]);
    char         ink[10];
    print_colour(ink, style->ink);
    text_append(&w->out, "<pattern id=\"hatch.%zu\" patternUnits=\"userSpaceOnUse\"", index);
    put_attribute(w, "width", 2 * half);
    put_attribute(w, "height", h[0]);
    put(w, " patternTransform=\"translate(");
    put_number(w, middle[0] + off * across[0]);
    put(w, " ");
    put_number(w, middle[1] + off * across[1]);
    put(w, ")rotate(");
    put_number(w, h[1] * (180 / PI));
    put(w, ")translate(");
    put_number(w, -half);
    put(w, " ");
    put_number(w, -h[0] / 2);
    put(w, ")\"><path d=\"M0 ");
    put_number(w, h[0] / 2);
    put(w, "H");
    put_number(w, 2 * half);
    text_append(&w->out, "\" stroke=\"%s\"", ink);
    put_attribute(w, "stroke-width", h[4]);
    if (opacity_of(style->ink) < 1)
        put_attribute(w, "stroke-opacity", opacity_of(style->ink));
    put(w, "/></pattern>\n");
}

static void put_definitions(svg_writer *w)
{
    bool any = false;
    for (size_t i = 0; i < w->style_count; i++) {
        if (!(w->styles[i].hatch[0] > 0))
            continue;
        put(w, any ? "" : "<defs>\n");
        any = true;
        put_pattern(w, i);
    }
    for (size_t i = 0; i < w->s->group_count; i++) {
        const sheet_group *g = &w->s->groups[i];
        if (!(g->clip[2] > 0))
            continue;
        put(w, any ? "" : "<defs>\n");
        any = true;
        text_append(&w->out, "<clipPath id=\"%s.clip\"><rect x=\"", w->ids[i]);
        put_number(w, g->clip[0]);
        put(w, "\" y=\"");
        put_number(w, g->clip[1]);
        put(w, "\" width=\"");
        put_number(w, g->clip[2]);
        put(w, "\" height=\"");
        put_number(w, g->clip[3]);
        put(w, "\"/></clipPath>\n");
    }
    put(w, any ? "</defs>\n" : "");
}

/* --- items ---------------------------------------------------------------------------------------------- */

/* A command letter and two numbers. */
static size_t print_pair(char *to, char letter, long long x, long long y)
{
    size_t at = 0;
    if (letter)
        to[at++] = letter;
    else if (x >= 0)
        to[at++] = ' ';
    at += svg_print_thousandths(to + at, x);
    if (y >= 0)
        to[at++] = ' ';
    return at + svg_print_thousandths(to + at, y);
}

/* Where the path data are: what is written are differences of rounded positions. */
typedef struct svg_pen {
    svg_writer *w;
    long long   at[2];
    char        letter; /* of the command that goes on without another letter */
} svg_pen;

/* A position, relative to where the pen is, behind a command or another position. */
static void put_pair(svg_pen *pen, char letter, const double position[2], long long rounded[2])
{
    char digits[64];
    for (int k = 0; k < 2; k++)
        rounded[k] = svg_thousandths(position[k]);
    size_t size =
        print_pair(digits, pen->letter == letter ? '\0' : letter, rounded[0] - pen->at[0], rounded[1] - pen->at[1]);
    text_append_bytes(&pen->w->out, digits, size);
    pen->letter = letter;
}

static void move_to(svg_pen *pen, const double position[2])
{
    long long rounded[2];
    pen->at[0] = pen->at[1] = 0;
    pen->letter = '\0';
    put_pair(pen, 'M', position, rounded);
    memcpy(pen->at, rounded, sizeof rounded);
}

/* A line: along an axis one number is enough. */
static void line_to(svg_pen *pen, const double position[2])
{
    long long rounded[2] = {svg_thousandths(position[0]), svg_thousandths(position[1])},
              way[2] = {rounded[0] - pen->at[0], rounded[1] - pen->at[1]};
    char letter = way[1] == 0 ? 'h' : 'v', digits[32];
    if (way[0] != 0 && way[1] != 0) {
        put_pair(pen, 'l', position, rounded);
    } else {
        size_t    size = 0;
        long long only = way[letter == 'v'];
        if (pen->letter != letter)
            digits[size++] = letter;
        else if (only >= 0)
            digits[size++] = ' ';
        size += svg_print_thousandths(digits + size, only);
        text_append_bytes(&pen->w->out, digits, size);
        pen->letter = letter;
    }
    memcpy(pen->at, rounded, sizeof rounded);
}

/* Their centre comes from both ends, and the nearer these are to half a turn, or to a whole one, the less exactly:
 * such arcs are several. */
static int pieces_of_arc(double sweep)
{
    double size = fabs(sweep);
    return size <= 2.6 ? 1 : size >= 3.7 && size <= 5.5 ? 1 : size <= 5.2 ? 2 : 3;
}

/* Radii have the digits that move the middle of an arc between two ends by no more than half a thousandth: arcs that
 * turn little need few. */
static double radius_of_arc(const sheet_piece *arc, int pieces)
{
    double half = fabs(arc->sweep) / (2 * pieces), moved = fabs(1 / cos(half) - 1), unit = 1000;
    if (arc->radii[0] != arc->radii[1] || half >= 0.49 * PI)
        return arc->radii[0];
    while (unit > 1 && 0.5 * unit / 1000 * moved > 0.0005)
        unit /= 10;
    return round(arc->radii[0] * 1000 / unit) * unit / 1000;
}

static void put_arc(svg_pen *pen, const sheet_piece *arc)
{
    int    pieces = pieces_of_arc(arc->sweep);
    bool   large = fabs(arc->sweep) > PI * pieces, circular = arc->radii[0] == arc->radii[1];
    double radius = radius_of_arc(arc, pieces);
    for (int i = 1; i <= pieces; i++) {
        double    end[2] = {arc->end[0], arc->end[1]};
        long long rounded[2];
        if (i < pieces)
            sheet_arc_at(arc, arc->from + arc->sweep * i / pieces, end);
        put(pen->w, pen->letter == 'a' ? " " : "a");
        put_number(pen->w, radius);
        put(pen->w, " ");
        put_number(pen->w, circular ? radius : arc->radii[1]);
        put(pen->w, " ");
        put_number(pen->w, circular ? 0 : arc->turn * (180 / PI));
        put(pen->w, large ? " 1" : " 0");
        put(pen->w, arc->sweep > 0 ? " 1" : " 0");
        pen->letter = 'a';
        put_pair(pen, 'a', end, rounded);
        memcpy(pen->at, rounded, sizeof rounded);
    }
}

static void put_cubic(svg_pen *pen, const sheet_piece *p)
{
    long long rounded[2];
    put_pair(pen, 'c', p->controls[0], rounded);
    put_pair(pen, 'c', p->controls[1], rounded);
    put_pair(pen, 'c', p->end, rounded);
    memcpy(pen->at, rounded, sizeof rounded);
}

static void put_pieces(svg_pen *pen, const sheet_path *path)
{
    const sheet_piece *pieces = pen->w->s->pieces + path->first_piece;
    for (uint32_t i = 0; i < path->piece_count; i++) {
        bool last = i + 1 == path->piece_count && (path->closed || path->filled);
        switch (pieces[i].kind) {
        case SHEET_ARC: put_arc(pen, &pieces[i]); break;
        case SHEET_CUBIC: put_cubic(pen, &pieces[i]); break;
        case SHEET_LINE:
            if (!last) /* z draws it */
                line_to(pen, pieces[i].end);
        }
    }
}

static void put_path_data(svg_writer *w, const sheet_path *path, bool dots)
{
    svg_pen pen = {.w = w};
    for (uint32_t i = 0; i < path->count; i++) {
        const float *p = w->s->points[path->first + i];
        const double at[2] = {(double)p[0], (double)p[1]};
        if (dots || i == 0)
            move_to(&pen, at);
        else if ((svg_thousandths(at[0]) == pen.at[0] && svg_thousandths(at[1]) == pen.at[1]) &&
                 !(i == 1 && path->count == 2))
            continue; /* nothing at this many decimals; a line of no length is a dot all the same */
        else
            line_to(&pen, at);
        put(w, dots ? "h0" : "");
        if (path->piece_count && !dots)
            break;
    }
    if (!dots)
        put_pieces(&pen, path);
    put(w, (path->closed || path->filled) && !dots ? "z" : "");
}

/* 48 bits of a name, in digits and letters. */
static void put_line_name(svg_writer *w, uint64_t id)
{
    static const char digits[] = "0123456789ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz-_";
    char              name[9];
    size_t            at = sizeof name - 1;
    name[at] = '\0';
    for (uint64_t left = (id ^ id >> 48) & UINT64_C(0xFFFFFFFFFFFF); left || at == sizeof name - 1; left >>= 6)
        name[--at] = digits[left & 63];
    text_append(&w->out, " data-line=\"%s\"", name + at);
}

static void begin_element(svg_writer *w, const char *name, const sheet_item *item, size_t style,
                          const svg_dash_pattern *dashes)
{
    bool own = item->group >= w->s->group_count || w->group_styles[item->group] != style + 1,
         dashed = dashes && dashes->name >= 0;
    put(w, "<");
    put(w, name);
    put(w, own || dashed ? " class=\"" : "");
    if (own)
        text_append(&w->out, "s%zu%s", style, dashed ? " " : "");
    if (dashed)
        text_append(&w->out, "d%d", dashes->name);
    put(w, own || dashed ? "\"" : "");
    if (item->id)
        put_line_name(w, item->id);
}

/* Begins an element of lines. */
static void begin_path(svg_writer *w, const sheet_item *item, const sheet_path *path, size_t style)
{
    const svg_dash_pattern *dashes = path->dash_count ? svg_dashes_find(&w->dashes, w->s, path) : NULL;
    w->out.failed = w->out.failed || (path->dash_count && !dashes);
    begin_element(w, "path", item, style, dashes);
    if (dashes && dashes->name < 0)
        text_append(&w->out, " stroke-dasharray=\"%s\"", dashes->lengths);
    if (dashes && svg_dash_offset(w->s, path) != 0)
        put_attribute(w, "stroke-dashoffset", (double)svg_dash_offset(w->s, path) / 1000);
    put(w, " d=\"");
}

/* The circle or ellipse that a path is, NULL: it is none. Dashes begin where a path does. */
static const sheet_piece *round_of(const svg_writer *w, const sheet_item *item, const sheet_path *path)
{
    const sheet_piece *p = path->piece_count == 1 ? &w->s->pieces[path->first_piece] : NULL;
    bool               whole = p && p->kind == SHEET_ARC && fabs(p->sweep) > 2 * PI - 1e-9;
    return whole && item->kind == SHEET_PATH && !path->filled && !path->dash_count ? p : NULL;
}

static void put_round(svg_writer *w, const sheet_item *item, size_t style, const sheet_piece *p)
{
    bool circle = svg_thousandths(p->radii[0]) == svg_thousandths(p->radii[1]),
         turned = !circle && svg_thousandths(p->turn) != 0;
    begin_element(w, circle ? "circle" : "ellipse", item, style, NULL);
    if (!turned) {
        put_attribute(w, "cx", p->centre[0]);
        put_attribute(w, "cy", p->centre[1]);
    }
    put_attribute(w, circle ? "r" : "rx", p->radii[0]);
    if (!circle)
        put_attribute(w, "ry", p->radii[1]);
    if (turned) {
        put(w, " transform=\"translate(");
        put_number(w, p->centre[0]);
        put(w, " ");
        put_number(w, p->centre[1]);
        put(w, ")rotate(");
        put_number(w, p->turn * (180 / PI));
        put(w, ")\"");
    }
    put(w, "/>\n");
}

/* Paths that follow each other in one style are one element; dashed and round ones have their own. */
static void put_paths(svg_writer *w, const sheet_item *item)
{
    size_t current = SIZE_MAX; /* the style of the element that is open */
    for (uint32_t k = 0; k < item->count; k++) {
        const sheet_path  *path = &w->s->paths[item->first + k];
        const sheet_piece *round = round_of(w, item, path);
        svg_style          style;
        style_of(&style, item, path);
        size_t index = find_style(w, &style);
        if (index != current || round || path->dash_count || (k && path[-1].dash_count)) {
            put(w, current == SIZE_MAX ? "" : "\"/>\n");
            current = round ? SIZE_MAX : index;
            if (round) {
                put_round(w, item, index, round);
                continue;
            }
            begin_path(w, item, path, index);
        }
        put_path_data(w, path, item->kind == SHEET_DOTS);
    }
    put(w, current == SIZE_MAX ? "" : "\"/>\n");
}

static void put_image(svg_writer *w, const sheet_item *item)
{
    static const char *const names[4] = {"x", "y", "width", "height"};
    put(w, "<image");
    for (int i = 0; i < 4; i++)
        put_attribute(w, names[i], item->box[i]);
    put(w, " preserveAspectRatio=\"none\" href=\"data:image/png;base64,");
    put_base64(w, item->png, item->png_size);
    put(w, "\"/>\n");
}

static void put_text(svg_writer *w, const sheet_item *item)
{
    char ink[10];
    print_colour(ink, item->ink);
    put(w, "<text");
    put_attribute(w, "x", item->box[0]);
    put_attribute(w, "y", item->box[1]);
    put_attribute(w, "font-size", item->box[3]);
    text_append(&w->out, " fill=\"%s\"", ink);
    if (opacity_of(item->ink) < 1)
        put_attribute(w, "fill-opacity", opacity_of(item->ink));
    if (item->anchor >= 0)
        text_append(&w->out, " text-anchor=\"%s\"", item->anchor == 0 ? "middle" : "end");
    put(w, ">");
    put_escaped(w, item->text);
    put(w, "</text>\n");
}

static void put_item(svg_writer *w, const sheet_item *item)
{
    if (item->kind == SHEET_IMAGE  ? item->png == NULL
        : item->kind == SHEET_TEXT ? item->text == NULL
                                   : item->count == 0)
        return;
    if (item->group < w->s->group_count)
        go_to_group(w, (int32_t)item->group);
    switch (item->kind) {
    case SHEET_PATH:
    case SHEET_DOTS: put_paths(w, item); break;
    case SHEET_IMAGE: put_image(w, item); break;
    case SHEET_TEXT: put_text(w, item); break;
    }
}

static void put_head(svg_writer *w)
{
    const sheet *s = w->s;
    put(w, "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"");
    put_number(w, s->width);
    put(w, "mm\" height=\"");
    put_number(w, s->height);
    put(w, "mm\" viewBox=\"0 0 ");
    put_number(w, s->width);
    put(w, " ");
    put_number(w, s->height);
    put(w, "\" xmlns:inkscape=\"http://www.inkscape.org/namespaces/inkscape\">\n");
    put_element(w, "title", s->title);
    put_element(w, "desc", s->description);
    put_styles(w);
    put_definitions(w);
    if (!(s->ground.a > 0))
        return;
    char ground[10];
    print_colour(ground, s->ground);
    text_append(&w->out, "<rect class=\"ground\" width=\"100%%\" height=\"100%%\" fill=\"%s\"", ground);
    if (opacity_of(s->ground) < 1)
        put_attribute(w, "fill-opacity", opacity_of(s->ground));
    put(w, "/>\n");
}

lmn_status export_svg(export_bytes *out, const sheet *s, lmn_error *error)
{
    svg_writer w = {.s = s, .open = -1};
    *out = (export_bytes){NULL, 0};
    if (name_groups(&w)) {
        find_styles(&w);
        put_head(&w);
        for (size_t i = 0; i < s->item_count && !w.out.failed; i++)
            put_item(&w, &s->items[i]);
        go_to_group(&w, -1);
        put(&w, "</svg>\n");
    } else {
        w.out.failed = true;
    }
    for (size_t i = 0; w.ids && i < s->group_count; i++)
        mem_free(w.ids[i]);
    mem_free(w.ids);
    mem_free(w.opened);
    mem_free(w.id_slots);
    mem_free(w.group_styles);
    mem_free(w.styles);
    mem_free(w.style_slots);
    svg_dashes_release(&w.dashes);
    out->size = w.out.size;
    out->data = s->failed ? NULL : (unsigned char *)text_take(&w.out);
    text_release(&w.out);
    return out->data ? LMN_OK : error_memory(error);
}
