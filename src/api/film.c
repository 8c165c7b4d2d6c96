/* Films: checks arguments and forwards. */
#include "limner/film.h"

#include "api/complete.h"
#include "base/error.h"
#include "base/memory.h"
#include "base/work.h"
#include "film/film.h"

struct lmn_film {
    film *made;
};

bool lmn_film_format_at(size_t index, lmn_film_format_info *out)
{
    if (index >= film_format_count || !out)
        return false;
    const film_format *f = &film_formats[index];
    *out = (lmn_film_format_info){.ending = f->ending,
                                  .doc = f->doc,
                                  .program = f->writer->program,
                                  .package = f->writer->package,
                                  .usable = f->writer->check(NULL) == LMN_OK};
    return true;
}

/* What was given, as far as its caller knows the struct, and the format that it means. */
static lmn_status choose(lmn_film_desc *full, const film_format **format, const char *path, const lmn_film_desc *given,
                         lmn_error *error)
{
    *full = (lmn_film_desc)LMN_FILM_DESC_INIT;
    if (!path)
        return error_set(error, LMN_USAGE, "a film needs a path");
    lmn_status status = desc_complete_given(full, sizeof *full, given, "LMN_FILM_DESC_INIT", error);
    if (status == LMN_OK)
        status = film_choose(format, path, full->format, error);
    return status == LMN_OK ? film_check(*format, path, full, error) : status;
}

lmn_status lmn_film_check(const char *path, const lmn_film_desc *desc, lmn_error *error)
{
    lmn_film_desc      full;
    const film_format *format = NULL;
    return choose(&full, &format, path, desc, error);
}

lmn_status lmn_film_open(lmn_film **out, const char *path, const lmn_film_desc *desc, lmn_error *error)
{
    lmn_film_desc      full;
    const film_format *format = NULL;
    if (!out)
        return error_set(error, LMN_USAGE, "lmn_film_open: `out` is NULL");
    *out = NULL;
    lmn_status status = choose(&full, &format, path, desc, error);
    if (status != LMN_OK)
        return status;
    work w;
    work_begin(&w, full.progress, full.progress_user);
    lmn_film *f = mem_calloc(1, sizeof *f);
    status = f ? film_open(&f->made, format, path, &full, error) : error_memory(error);
    status = work_end(&w, status, error);
    if (status == LMN_OK)
        *out = f;
    else
        lmn_film_destroy(&f);
    return status;
}

lmn_status lmn_film_add(lmn_film *f, const uint8_t *rgba, lmn_error *error)
{
    if (!f || !rgba)
        return error_set(error, LMN_USAGE, "lmn_film_add: a film and a frame are needed");
    work w;
    work_begin(&w, f->made->progress, f->made->progress_user);
    lmn_status status = film_add(f->made, rgba, error);
    return status == LMN_OK ? work_end_done(&w) : work_end(&w, status, error);
}

lmn_status lmn_film_close(lmn_film **film, uint64_t *bytes, lmn_error *error)
{
    lmn_film *f = film ? *film : NULL;
    if (!f)
        return error_set(error, LMN_USAGE, "lmn_film_close: there is no film");
    work w;
    work_begin(&w, f->made->progress, f->made->progress_user);
    lmn_status status = film_close(&f->made, bytes, error);
    status = status == LMN_OK ? work_end_done(&w) : work_end(&w, status, error);
    lmn_film_destroy(film);
    return status;
}

void lmn_film_destroy(lmn_film **film)
{
    lmn_film *f = film ? *film : NULL;
    if (!f)
        return;
    film_destroy(&f->made);
    mem_free(f);
    *film = NULL;
}

size_t lmn_film_warning_count(const lmn_film *f)
{
    return f ? f->made->warnings.count : 0;
}

const char *lmn_film_warning_at(const lmn_film *f, size_t index, const char **code, size_t *count)
{
    if (!f || index >= f->made->warnings.count)
        return NULL;
    const warning *w = &f->made->warnings.items[index];
    if (code)
        *code = warning_code_text(w->code);
    if (count)
        *count = w->count;
    return w->text;
}

bool lmn_picture_is_whole(const char *path, int width, int height)
{
    return path && film_picture_is_whole(path, width, height);
}
