/* PDF of a sheet, through cairo. The dates are fixed, so
 * that equal sheets are equal files. */
#include "export/cairo_sheet.h"

#include <cairo-pdf.h>
#include <string.h>

#include "base/memory.h"
#include "base/paper.h"

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

static void set_metadata(pdf_writer *w, cairo_surface_t *surface)
{
    char *title = cairo_clean_text(w->s->title ? w->s->title : ""),
         *subject = cairo_clean_text(w->s->description ? w->s->description : "");
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

static void draw_sheet(pdf_writer *w)
{
    cairo_scale(w->context, points_per_mm, points_per_mm);
    w->failed = !cairo_sheet_draw(w->context, w->s) || w->failed;
    cairo_show_page(w->context);
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
