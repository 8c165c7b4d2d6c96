/* What lies on a page of PDF, item by item: operators of ISO 32000-1, annex A. */
#include <math.h>
#include <png.h>
#include <string.h>

#include "base/memory.h"
#include "base/work.h"
#include "export/cairo_sheet.h"
#include "export/pdf_private.h"
#include "sheet/fit.h"

static const double blank_width = 0.278; /* of Helvetica, of its size */

/* What was set last, so that it is not set again. */
typedef struct pen_state {
    colour            ink; /* NaN red: none yet */
    bool              filling;
    double            opacity, width;
    const sheet_path *dashed;
    int               cap; /* −1: none yet */
} pen_state;

typedef struct page_writer {
    pdf_writer *w;
    text       *out;
    int32_t     open; /* the innermost group that is open, −1: none */
    pen_state   pen;
} page_writer;

static void put_numbers(page_writer *p, const double *values, size_t count, const char *operation)
{
    for (size_t i = 0; i < count; i++)
        pdf_put_number(p->out, values[i]);
    pdf_put(p->out, operation);
    pdf_put(p->out, "\n");
}

static void forget_pen(page_writer *p)
{
    p->pen = (pen_state){.ink = {NAN, 0, 0, 0}, .opacity = 1, .width = -1, .cap = -1};
}

/* --- groups --------------------------------------------------------------------------------------------- */

static void open_group(page_writer *p, int32_t index)
{
    const sheet_group *g = &p->w->s->groups[index];
    if (p->w->layers[index])
        text_append(p->out, "/OC /L%d BDC\n", (int)index);
    if (g->clip[2] > 0) {
        pdf_put(p->out, "q\n");
        put_numbers(p, g->clip, 4, "re W n");
    }
    p->open = index;
}

static void close_group(page_writer *p)
{
    const sheet_group *g = &p->w->s->groups[p->open];
    if (g->clip[2] > 0) {
        pdf_put(p->out, "Q\n");
        forget_pen(p);
        pdf_put(p->out, "/A0 gs []0 d\n");
    }
    if (p->w->layers[p->open])
        pdf_put(p->out, "EMC\n");
    p->open = g->parent;
}

/* Closes what the group does not lie in, and opens what it lies in. */
static void go_to_group(page_writer *p, int32_t group)
{
    const sheet *s = p->w->s;
    for (;;) {
        int32_t above = group;
        while (above > p->open)
            above = s->groups[above].parent;
        if (above == p->open)
            break;
        close_group(p);
    }
    while (p->open != group) {
        int32_t next = group;
        while (s->groups[next].parent != p->open)
            next = s->groups[next].parent;
        open_group(p, next);
    }
}

/* --- pens ----------------------------------------------------------------------------------------------- */

static void set_opacity(page_writer *p, double opacity)
{
    pdf_writer *w = p->w;
    size_t      at = 0;
    opacity = opacity < 1 ? fmax(round(opacity * 1000) / 1000, 0) : 1;
    if (opacity == p->pen.opacity)
        return;
    while (at < w->opacity_count && w->opacities[at] != opacity)
        at++;
    if (at == w->opacity_count) {
        if (!mem_grow((void **)&w->opacities, &w->opacity_capacity, at + 1, sizeof *w->opacities)) {
            p->out->failed = true;
            return;
        }
        w->opacities[w->opacity_count++] = opacity;
    }
    text_append(p->out, "/A%zu gs\n", at);
    p->pen.opacity = opacity;
}

static void set_ink(page_writer *p, colour ink, bool filling)
{
    const double values[3] = {(double)ink.r, (double)ink.g, (double)ink.b};
    set_opacity(p, (double)ink.a);
    if (p->pen.filling == filling && p->pen.ink.r == ink.r && p->pen.ink.g == ink.g && p->pen.ink.b == ink.b)
        return;
    put_numbers(p, values, 3, filling ? "rg" : "RG");
    p->pen.ink = ink;
    p->pen.filling = filling;
}

static void set_dashes(page_writer *p, const sheet_path *path)
{
    if (!path && !p->pen.dashed)
        return;
    pdf_put(p->out, "[");
    for (uint32_t i = 0; path && i < path->dash_count; i++)
        pdf_put_number(p->out, (double)p->w->s->dashes[path->first_dash + i]);
    pdf_put(p->out, "]");
    pdf_put_number(p->out, path ? (double)path->phase : 0);
    pdf_put(p->out, "d\n");
    p->pen.dashed = path;
}

static void set_pen(page_writer *p, const sheet_item *item, const sheet_path *path)
{
    bool   dots = item->kind == SHEET_DOTS;
    int    cap = dots || path->cap == SHEET_CAP_ROUND ? 1 : 0;
    double width = (double)path->width;
    set_ink(p, item->ink, false);
    set_dashes(p, path->dash_count && !dots ? path : NULL);
    if (width != p->pen.width)
        put_numbers(p, &width, 1, "w");
    if (cap != p->pen.cap)
        text_append(p->out, "%d J\n", cap);
    p->pen.width = width;
    p->pen.cap = cap;
}

/* --- paths ---------------------------------------------------------------------------------------------- */

static void put_piece(page_writer *p, const sheet_piece *piece)
{
    double cubics[CAIRO_CUBICS_MOST][6];
    switch (piece->kind) {
    case SHEET_LINE: put_numbers(p, piece->end, 2, "l"); break;
    case SHEET_CUBIC:
        memcpy(cubics[0], piece->controls, sizeof piece->controls);
        memcpy(cubics[0] + 4, piece->end, sizeof piece->end);
        put_numbers(p, cubics[0], 6, "c");
        break;
    case SHEET_ARC:
        for (int i = 0, count = cairo_arc_cubics(piece, cubics); i < count; i++)
            put_numbers(p, cubics[i], 6, "c");
        break;
    }
}

static void put_path(page_writer *p, const sheet_path *path, bool dots)
{
    const sheet *s = p->w->s;
    for (uint32_t i = 0; i < path->count; i++) {
        const double at[2] = {(double)s->points[path->first + i][0], (double)s->points[path->first + i][1]};
        if (i == 0 || dots)
            put_numbers(p, at, 2, "m");
        if (path->piece_count && !dots)
            break;
        if (i > 0 || dots)
            put_numbers(p, at, 2, "l");
    }
    for (uint32_t i = 0; i < path->piece_count && !dots; i++)
        put_piece(p, &s->pieces[path->first_piece + i]);
    if ((path->closed || path->filled) && !dots)
        pdf_put(p->out, "h\n");
}

/* The pattern of an item's areas as what is filled with. */
static void set_pattern(page_writer *p, const sheet_item *item)
{
    pdf_writer *w = p->w;
    size_t      at = 0;
    while (at < w->pattern_count && (memcmp(&w->patterns[at].hatch, &item->hatch, sizeof item->hatch) != 0 ||
                                     memcmp(&w->patterns[at].ink, &item->ink, sizeof item->ink) != 0))
        at++;
    if (at == w->pattern_count) {
        if (!mem_grow((void **)&w->patterns, &w->pattern_capacity, at + 1, sizeof *w->patterns)) {
            p->out->failed = true;
            return;
        }
        w->patterns[w->pattern_count++] = (pdf_pattern){w->object_count++, item->hatch, item->ink};
    }
    set_opacity(p, (double)item->ink.a);
    text_append(p->out, "/Pattern cs /P%zu scn\n", at);
    p->pen.ink.r = NAN; /* none of ink any more */
}

static void put_paths(page_writer *p, const sheet_item *item)
{
    const sheet *s = p->w->s;
    bool         dots = item->kind == SHEET_DOTS;
    for (uint32_t k = 0; k < item->count;) {
        const sheet_path *first = &s->paths[item->first + k];
        bool              filled = first->filled && !dots;
        if (filled && item->hatch.apart > 0)
            set_pattern(p, item);
        else if (filled)
            set_ink(p, item->ink, true);
        else
            set_pen(p, item, first);
        for (; k < item->count && cairo_same_pen(first, &s->paths[item->first + k]); k++)
            put_path(p, &s->paths[item->first + k], dots);
        pdf_put(p->out, filled ? "f\n" : "S\n");
    }
}

/* --- pictures and texts --------------------------------------------------------------------------------- */

static bool split_picture(pdf_picture *picture, const unsigned char *rgba)
{
    size_t count = (size_t)picture->width * (size_t)picture->height;
    bool   opaque = true;
    for (size_t i = 0; i < count && opaque; i++)
        opaque = rgba[4 * i + 3] == 255;
    picture->colours = mem_alloc(3 * count);
    picture->alpha = opaque ? NULL : mem_alloc(count);
    if (!picture->colours || (!opaque && !picture->alpha))
        return false;
    for (size_t i = 0; i < count; i++) {
        memcpy(picture->colours + 3 * i, rgba + 4 * i, 3);
        if (!opaque)
            picture->alpha[i] = rgba[4 * i + 3];
    }
    return true;
}

static void put_image(page_writer *p, const sheet_item *item)
{
    pdf_writer    *w = p->w;
    png_image      png = {.version = PNG_IMAGE_VERSION};
    unsigned char *rgba = NULL;
    if (!png_image_begin_read_from_memory(&png, item->png, item->png_size))
        return;
    png.format = PNG_FORMAT_RGBA;
    rgba = mem_alloc(PNG_IMAGE_SIZE(png));
    pdf_picture picture = {.object = w->object_count, .width = (int)png.width, .height = (int)png.height};
    bool        read = rgba && png_image_finish_read(&png, NULL, rgba, 0, NULL);
    png_image_free(&png);
    if (!rgba || (read && !split_picture(&picture, rgba)) ||
        !mem_grow((void **)&w->pictures, &w->picture_capacity, w->picture_count + 1, sizeof *w->pictures)) {
        mem_free(picture.colours);
        mem_free(picture.alpha);
        p->out->failed = true;
        read = false;
    }
    mem_free(rgba);
    if (!read)
        return;
    w->pictures[w->picture_count] = picture;
    w->object_count += picture.alpha ? 2 : 1;
    set_opacity(p, 1);
    const double place[6] = {item->box[2], 0, 0, -item->box[3], item->box[0], item->box[1] + item->box[3]};
    pdf_put(p->out, "q\n");
    put_numbers(p, place, 6, "cm");
    text_append(p->out, "/X%zu Do\nQ\n", w->picture_count++);
}

/* A blank that nobody sees lies over each word, as wide as it is: what is selected and searched is its text. */
static void put_words(page_writer *p, const sheet_item *item, char *words, const cairo_letters *letters, double left)
{
    const double size = item->box[3];
    for (size_t i = 0; i < letters->word_count; i++) {
        const cairo_word *w = &letters->words[i];
        char             *end = words + w->first + w->size, kept = *end;
        const double      place[6] = {1, 0, 0, -1, left + w->left, item->box[1]},
                     wide = 100 * fmax(w->right - w->left, 0.01) / (blank_width * size);
        *end = '\0';
        pdf_put(p->out, "/Span <</ActualText ");
        pdf_put_text(p->out, words + w->first);
        *end = kept;
        pdf_put(p->out, ">> BDC\nBT 3 Tr /F ");
        put_numbers(p, &size, 1, "Tf");
        put_numbers(p, &wide, 1, "Tz");
        put_numbers(p, place, 6, "Tm ( ) Tj ET\nEMC");
    }
}

static void put_text(page_writer *p, const sheet_item *item)
{
    cairo_letters letters = {.steps = NULL};
    char         *words = cairo_clean_text(item->text);
    if (!words || !cairo_find_letters(&letters, words, item->box[3])) {
        cairo_letters_release(&letters);
        mem_free(words);
        p->out->failed = true;
        return;
    }
    double left = item->box[0] - (item->anchor < 0 ? 0 : item->anchor == 0 ? 0.5 : 1) * letters.width;
    put_words(p, item, words, &letters, left);
    set_ink(p, item->ink, true);
    for (size_t i = 0; i < letters.count; i++) {
        double *at = letters.steps[i].at;
        int     numbers = letters.steps[i].kind == 'c' ? 6 : letters.steps[i].kind == 'h' ? 0 : 2;
        for (int k = 0; k < numbers; k++)
            at[k] += k % 2 ? item->box[1] : left;
        const char operation[2] = {letters.steps[i].kind, '\0'};
        put_numbers(p, at, (size_t)numbers, operation);
    }
    if (letters.count)
        pdf_put(p->out, "f\n");
    cairo_letters_release(&letters);
    mem_free(words);
}

static void put_item(page_writer *p, const sheet_item *item)
{
    bool empty = item->kind == SHEET_IMAGE  ? item->png == NULL
                 : item->kind == SHEET_TEXT ? item->text == NULL
                                            : item->count == 0;
    if (empty)
        return;
    if (item->group < p->w->s->group_count)
        go_to_group(p, (int32_t)item->group);
    switch (item->kind) {
    case SHEET_PATH:
    case SHEET_DOTS: put_paths(p, item); break;
    case SHEET_IMAGE: put_image(p, item); break;
    case SHEET_TEXT: put_text(p, item); break;
    }
}

void pdf_put_content(pdf_writer *w, double points_per_mm)
{
    const sheet *s = w->s;
    page_writer  p = {.w = w, .out = &w->content, .open = -1};
    const double flip[6] = {points_per_mm, 0, 0, -points_per_mm, 0, s->height * points_per_mm},
                 page[4] = {0, 0, s->width, s->height};
    forget_pen(&p);
    if (!mem_grow((void **)&w->opacities, &w->opacity_capacity, 1, sizeof *w->opacities)) {
        w->content.failed = true;
        return;
    }
    w->opacities[w->opacity_count++] = 1; /* /A0 */
    /* More decimals than lengths have: it scales them all. */
    text_append(p.out, "%.9f 0 0 -%.9f 0 %.6f cm 1 j\n", flip[0], flip[0], flip[5]);
    if (s->ground.a > 0) {
        set_ink(&p, s->ground, true);
        put_numbers(&p, page, 4, "re f");
    }
    for (size_t i = 0; i < s->item_count && !w->content.failed && !work_stopped(); i++)
        put_item(&p, &s->items[i]);
    go_to_group(&p, -1);
}
