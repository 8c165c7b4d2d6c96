/* PDF of a sheet, through cairo; texts through pango, so that every script finds a font. The dates are fixed, so
 * that equal sheets are equal files. */
#include "export/export.h"

#include <cairo-pdf.h>
#include <math.h>
#include <pango/pangocairo.h>
#include <string.h>

#include "base/memory.h"
#include "base/paper.h"
#include "base/work.h"

static const double points_per_mm = POINTS_PER_INCH / MM_PER_INCH;
static const char   fixed_date[] = "2000-01-01T00:00:00Z";

typedef struct pdf_writer {
    const sheet *s;
    cairo_t     *context;
    export_bytes bytes;
    size_t       capacity;
    bool         failed; /* memory is gone */
} pdf_writer;

static cairo_status_t take_bytes(void *user, const unsigned char *data, unsigned int size)
{
    pdf_writer *w = user;
    if (w->failed || !mem_grow((void **)&w->bytes.data, &w->capacity, w->bytes.size + size, 1)) {
        w->failed = true;
        return CAIRO_STATUS_NO_MEMORY;
    }
    memcpy(w->bytes.data + w->bytes.size, data, size);
    w->bytes.size += size;
    return CAIRO_STATUS_SUCCESS;
}

typedef struct png_reader {
    const unsigned char *data;
    size_t               left;
} png_reader;

static cairo_status_t give_bytes(void *user, unsigned char *to, unsigned int size)
{
    png_reader *r = user;
    if (size > r->left)
        return CAIRO_STATUS_READ_ERROR;
    memcpy(to, r->data, size);
    r->data += size;
    r->left -= size;
    return CAIRO_STATUS_SUCCESS;
}

static void set_ink(cairo_t *c, colour ink)
{
    double alpha = ink.a < 1 ? fmax((double)ink.a, 0) : 1;
    cairo_set_source_rgba(c, (double)ink.r, (double)ink.g, (double)ink.b, alpha);
}

/* Text that pango takes: UTF-8 without control characters. NULL when memory is gone. */
static char *clean_text(const char *words)
{
    char *valid = g_utf8_make_valid(words, -1), *copy = mem_copy_text(valid);
    g_free(valid);
    for (char *at = copy; at && *at; at++)
        if ((unsigned char)*at < 0x20 || *at == 0x7F)
            *at = ' ';
    return copy;
}

static void set_metadata(pdf_writer *w, cairo_surface_t *surface)
{
    char *title = clean_text(w->s->title ? w->s->title : ""),
         *subject = clean_text(w->s->description ? w->s->description : "");
    w->failed = w->failed || !title || !subject;
    if (title && *title)
        cairo_pdf_surface_set_metadata(surface, CAIRO_PDF_METADATA_TITLE, title);
    if (subject && *subject)
        cairo_pdf_surface_set_metadata(surface, CAIRO_PDF_METADATA_SUBJECT, subject);
    cairo_pdf_surface_set_metadata(surface, CAIRO_PDF_METADATA_CREATOR, "Limner");
    cairo_pdf_surface_set_metadata(surface, CAIRO_PDF_METADATA_CREATE_DATE, fixed_date);
    cairo_pdf_surface_set_metadata(surface, CAIRO_PDF_METADATA_MOD_DATE, fixed_date);
    mem_free(title);
    mem_free(subject);
}

/* --- items ---------------------------------------------------------------------------------------------- */

static void add_path(pdf_writer *w, const sheet_path *path, bool dots)
{
    cairo_t *c = w->context;
    for (uint32_t i = 0; i < path->count; i++) {
        const float *p = w->s->points[path->first + i];
        if (i == 0 || dots)
            cairo_move_to(c, (double)p[0], (double)p[1]);
        if (i > 0 || dots)
            cairo_line_to(c, (double)p[0], (double)p[1]);
    }
    if (path->closed && !dots)
        cairo_close_path(c);
}

static bool same_pen(const sheet_path *a, const sheet_path *b)
{
    bool dashes = a->dash > 0 ? a->dash == b->dash && a->gap == b->gap && a->phase == b->phase : !(b->dash > 0);
    return a->filled == b->filled && a->width == b->width && a->cap == b->cap && dashes;
}

static void draw_paths(pdf_writer *w, const sheet_item *item)
{
    cairo_t *c = w->context;
    bool     dots = item->kind == SHEET_DOTS;
    set_ink(c, item->ink);
    for (uint32_t k = 0; k < item->count;) {
        const sheet_path *first = &w->s->paths[item->first + k];
        for (; k < item->count && same_pen(first, &w->s->paths[item->first + k]); k++)
            add_path(w, &w->s->paths[item->first + k], dots);
        if (first->filled && !dots) {
            cairo_fill(c);
            continue;
        }
        const double dashes[2] = {(double)first->dash, (double)first->gap};
        cairo_set_dash(c, dashes, first->dash > 0 && !dots ? 2 : 0, first->dash > 0 ? (double)first->phase : 0);
        cairo_set_line_cap(c, dots || first->cap == SHEET_CAP_ROUND ? CAIRO_LINE_CAP_ROUND : CAIRO_LINE_CAP_BUTT);
        cairo_set_line_width(c, (double)first->width);
        cairo_stroke(c);
    }
}

static void draw_image(pdf_writer *w, const sheet_item *item)
{
    cairo_t         *c = w->context;
    cairo_surface_t *image =
        cairo_image_surface_create_from_png_stream(give_bytes, &(png_reader){item->png, item->png_size});
    if (cairo_surface_status(image) == CAIRO_STATUS_SUCCESS) {
        cairo_save(c);
        cairo_translate(c, item->box[0], item->box[1]);
        cairo_scale(c, item->box[2] / cairo_image_surface_get_width(image),
                    item->box[3] / cairo_image_surface_get_height(image));
        cairo_set_source_surface(c, image, 0, 0);
        cairo_paint(c);
        cairo_restore(c);
    }
    cairo_surface_destroy(image);
}

/* Letters stand where the font has them, not on whole units: these are millimetres. */
static void set_true_metrics(PangoLayout *layout)
{
    PangoContext         *context = pango_layout_get_context(layout);
    cairo_font_options_t *options = cairo_font_options_create();
    cairo_font_options_set_hint_style(options, CAIRO_HINT_STYLE_NONE);
    cairo_font_options_set_hint_metrics(options, CAIRO_HINT_METRICS_OFF);
    pango_cairo_context_set_font_options(context, options);
    pango_context_set_round_glyph_positions(context, FALSE);
    cairo_font_options_destroy(options);
    pango_layout_context_changed(layout);
}

static void draw_text(pdf_writer *w, const sheet_item *item)
{
    cairo_t *c = w->context;
    char    *words = clean_text(item->text);
    if (!words) {
        w->failed = true;
        return;
    }
    PangoLayout *layout = pango_cairo_create_layout(c);
    set_true_metrics(layout);
    PangoFontDescription *font = pango_font_description_from_string("Liberation Sans, Arial, Helvetica, sans-serif");
    int                   width, height;
    pango_font_description_set_absolute_size(font, item->box[3] * PANGO_SCALE);
    pango_layout_set_font_description(layout, font);
    pango_layout_set_text(layout, words, -1);
    pango_layout_get_size(layout, &width, &height);
    double fraction = item->anchor < 0 ? 0 : item->anchor == 0 ? 0.5 : 1;
    set_ink(c, item->ink);
    cairo_move_to(c, item->box[0] - fraction * width / PANGO_SCALE,
                  item->box[1] - (double)pango_layout_get_baseline(layout) / PANGO_SCALE);
    pango_cairo_show_layout(c, layout);
    pango_font_description_free(font);
    g_object_unref(layout);
    mem_free(words);
}

static void clip_to_groups(pdf_writer *w, uint32_t group)
{
    if (group >= w->s->group_count)
        return;
    for (int32_t at = (int32_t)group; at >= 0; at = w->s->groups[at].parent) {
        const double *clip = w->s->groups[at].clip;
        if (!(clip[2] > 0))
            continue;
        cairo_rectangle(w->context, clip[0], clip[1], clip[2], clip[3]);
        cairo_clip(w->context);
    }
}

static void draw_item(pdf_writer *w, const sheet_item *item)
{
    cairo_save(w->context);
    clip_to_groups(w, item->group);
    switch (item->kind) {
    case SHEET_PATH:
    case SHEET_DOTS: draw_paths(w, item); break;
    case SHEET_IMAGE: draw_image(w, item); break;
    case SHEET_TEXT: draw_text(w, item); break;
    }
    cairo_restore(w->context);
}

static void draw_sheet(pdf_writer *w)
{
    cairo_t *c = w->context;
    cairo_scale(c, points_per_mm, points_per_mm);
    cairo_set_line_join(c, CAIRO_LINE_JOIN_ROUND);
    if (w->s->ground.a > 0) {
        set_ink(c, w->s->ground);
        cairo_paint(c);
    }
    for (size_t i = 0; i < w->s->item_count && !w->failed && !work_stopped() && cairo_status(c) == CAIRO_STATUS_SUCCESS;
         i++)
        draw_item(w, &w->s->items[i]);
    w->failed = w->failed || work_stopped();
    cairo_show_page(c);
}

lmn_status export_pdf(export_bytes *out, const sheet *s, lmn_error *error)
{
    pdf_writer w = {.s = s, .failed = s->failed};
    *out = (export_bytes){NULL, 0};
    cairo_surface_t *surface =
        cairo_pdf_surface_create_for_stream(take_bytes, &w, s->width * points_per_mm, s->height * points_per_mm);
    set_metadata(&w, surface);
    w.context = cairo_create(surface);
    draw_sheet(&w);
    cairo_status_t drawn = cairo_status(w.context);
    cairo_destroy(w.context);
    cairo_surface_finish(surface);
    if (drawn == CAIRO_STATUS_SUCCESS)
        drawn = cairo_surface_status(surface);
    cairo_surface_destroy(surface);
    if (!w.failed && drawn == CAIRO_STATUS_SUCCESS) {
        *out = w.bytes;
        return LMN_OK;
    }
    mem_free(w.bytes.data);
    if (w.failed || drawn == CAIRO_STATUS_NO_MEMORY)
        return error_memory(error);
    return error_set(error, LMN_INTERNAL, "cairo cannot write the PDF: %s", cairo_status_to_string(drawn));
}
