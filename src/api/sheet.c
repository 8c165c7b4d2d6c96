/* Sheets: checks arguments and forwards. */
#include "limner/sheet.h"

#include "api/check_desc.h"
#include "api/complete.h"
#include "base/error.h"
#include "base/file.h"
#include "base/file_store.h"
#include "base/memory.h"
#include "base/work.h"
#include "draft/draw.h"
#include "draw/sheet.h"
#include "export/export.h"

static lmn_status missing(const char *caller, const char *what, lmn_error *error)
{
    return error_set(error, LMN_USAGE, "%s: `%s` is NULL", caller, what);
}

/* Whatever went wrong, it was this file that could not be written. */
static lmn_status name_file(lmn_status status, const char *path, lmn_error *error)
{
    if (status != LMN_OK && error && !error->file[0])
        error_file(error, path);
    return status;
}

bool lmn_look_needs_pixels(const lmn_look *look)
{
    return look && vector_needs_pixels(look);
}

static lmn_status complete(lmn_sheet_desc *full, const lmn_sheet_desc *given, lmn_error *error)
{
    lmn_status status = desc_complete_given(full, sizeof *full, given, "LMN_SHEET_DESC_INIT", error);
    if (status == LMN_OK && ((int)full->angle < 0 || full->angle > LMN_FIRST_ANGLE))
        return error_set(error, LMN_USAGE, "lmn_draw_sheet: there is no angle %d", (int)full->angle);
    if (status == LMN_OK && !(full->smooth >= 0 && full->smooth <= 10))
        return error_set(error, LMN_USAGE, "lmn_draw_sheet: smooth is %g mm; it is 0 to 10", full->smooth);
    if (status == LMN_OK && full->line_group != 0 && !draft_group_is_known(full->line_group))
        return error_set(
            error, LMN_USAGE,
            "lmn_draw_sheet: line_group is %g mm; it is 0.25, 0.35, 0.5 or 0.7, or 0 for widths of the look",
            full->line_group);
    return status;
}

lmn_status lmn_page_size(const char *page, double *width_mm, double *height_mm, lmn_error *error)
{
    double size[2] = {0, 0};
    if (!page || !width_mm || !height_mm)
        return missing("lmn_page_size", !page ? "page" : !width_mm ? "width_mm" : "height_mm", error);
    lmn_status status = vector_parse_page(page, size, error);
    *width_mm = size[0];
    *height_mm = size[1];
    return status;
}

lmn_status lmn_draw_sheet(lmn_sheet **out, lmn_renderer *renderer, const lmn_scene *scene, const lmn_look *look,
                          const lmn_draw_desc *desc, const lmn_sheet_desc *sheet, lmn_error *error)
{
    lmn_sheet_desc full = LMN_SHEET_DESC_INIT;
    lmn_draw_desc  wanted;
    if (!out)
        return missing("lmn_draw_sheet", "out", error);
    *out = NULL;
    if (!scene || !look)
        return missing("lmn_draw_sheet", scene ? "look" : "scene", error);
    lmn_status status = check_draw_desc(&wanted, desc, error);
    if (status == LMN_OK && wanted.textures)
        return error_set(error, LMN_USAGE, "a sheet has no textures; lmn_draw keeps some (`textures`)");
    if (status == LMN_OK)
        status = complete(&full, sheet, error);
    if (status == LMN_OK && wanted.window[2])
        return error_set(error, LMN_USAGE, "a sheet is drawn whole; lmn_draw draws windows of pictures (`window`)");
    if (status == LMN_OK && wanted.matrices_given)
        status = error_set(error, LMN_UNSUPPORTED, "a sheet's camera is given by eye and target, not by matrices");
    if (status != LMN_OK)
        return status;
    work w;
    work_begin(&w, wanted.progress, wanted.progress_user);
    status = work_end(&w, sheet_draw(out, renderer, scene, look, &wanted, &full, error), error);
    if (status != LMN_OK)
        vector_destroy(out);
    return status;
}

bool lmn_format_at(size_t index, lmn_format_info *out)
{
    if (index >= export_format_count || !out)
        return false;
    const export_format *f = &export_formats[index];
    *out = (lmn_format_info){.ending = f->ending,
                             .doc = f->doc,
                             .vectors = f->write_sheet != NULL,
                             .ground = f->ground,
                             .pictures = f->pictures,
                             .areas = f->areas,
                             .title = f->title};
    return true;
}

lmn_status lmn_sheet_write(const lmn_sheet *s, const char *path, const char *format, uint64_t *bytes, lmn_error *error)
{
    const export_format *chosen = NULL;
    if (!s || !path || !*path)
        return missing("lmn_sheet_write", s ? "path" : "sheet", error);
    lmn_status status = export_choose(&chosen, path, format, true, error);
    if (status != LMN_OK)
        return name_file(status, path, error);
    work w;
    work_begin(&w, NULL, NULL);
    export_bytes data = {0};
    status = chosen->write_sheet(&data, &s->page, error);
    if (status == LMN_OK)
        status = file_store(path, data.data, data.size, error);
    if (bytes)
        *bytes = data.size;
    mem_free(data.data);
    return status == LMN_OK ? work_end_done(&w) : name_file(work_end(&w, status, error), path, error);
}

lmn_status lmn_sheet_encode(const lmn_sheet *s, const char *format, uint8_t **bytes, size_t *size, lmn_error *error)
{
    const export_format *chosen = NULL;
    export_bytes         data = {0};
    if (bytes)
        *bytes = NULL;
    if (!s || !format || !bytes || !size)
        return missing("lmn_sheet_encode", !s ? "sheet" : !format ? "format" : !bytes ? "bytes" : "size", error);
    lmn_status status = export_choose(&chosen, "-", format, true, error);
    if (status != LMN_OK)
        return status;
    work w;
    work_begin(&w, NULL, NULL);
    status = chosen->write_sheet(&data, &s->page, error);
    if (status != LMN_OK) {
        mem_free(data.data);
        return work_end(&w, status, error);
    }
    *bytes = data.data;
    *size = data.size;
    return work_end_done(&w);
}

char *lmn_sheet_report_json(const lmn_sheet *s)
{
    return s ? vector_report_json(s) : NULL;
}

size_t lmn_sheet_warning_count(const lmn_sheet *s)
{
    return s ? s->warnings.count : 0;
}

const char *lmn_sheet_warning_at(const lmn_sheet *s, size_t index, const char **code, size_t *count)
{
    if (!s || index >= s->warnings.count)
        return NULL;
    const warning *w = &s->warnings.items[index];
    if (code)
        *code = warning_code_text(w->code);
    if (count)
        *count = w->count;
    return w->text;
}

void lmn_sheet_destroy(lmn_sheet **s)
{
    vector_destroy(s);
}
