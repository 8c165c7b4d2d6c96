/* Stroke textures: checks arguments and forwards. */
#include "limner/strokes.h"

#include <math.h>
#include <string.h>

#include "api/complete.h"
#include "base/error.h"
#include "base/file.h"
#include "base/file_store.h"
#include "base/limits.h"
#include "base/memory.h"
#include "base/work.h"
#include "export/export.h"
#include "stroke_texture/strokes.h"

enum { SIDE_MOST = 8192, WIDTH_MOST = 256 };

struct lmn_strokes {
    strokes list;
};

_Static_assert((int)LMN_PATTERN_RANDOM == (int)PATTERN_RANDOM && (int)LMN_ORDER_EVEN == (int)ORDER_EVEN &&
                   (int)LMN_FRACTION_AREA == (int)FRACTION_AREA &&
                   (int)LMN_PERSPECTIVE_LAYERS == (int)PERSPECTIVE_LAYERS,
               "public and internal names follow each other in the same order");

static lmn_status missing(const char *caller, const char *what, lmn_error *error)
{
    return error_set(error, LMN_USAGE, "%s: `%s` is NULL", caller, what);
}

static lmn_strokes *allocate(void)
{
    lmn_strokes *made = mem_calloc(1, sizeof *made);
    if (made)
        made->list.width = 1;
    return made;
}

static lmn_status check_pattern(const lmn_pattern_desc *d, lmn_error *error)
{
    if ((int)d->pattern < 0 || (int)d->pattern >= PATTERN_COUNT)
        return error_set(error, LMN_USAGE, "lmn_strokes_create: there is no pattern %d", (int)d->pattern);
    if (!(d->length >= 0 && d->length <= 4))
        return error_set(error, LMN_USAGE, "lmn_strokes_create: length is %g; allowed is 0 to 4", d->length);
    if (!(d->uneven >= 0 && d->uneven <= 1))
        return error_set(error, LMN_USAGE, "lmn_strokes_create: uneven is %g; allowed is 0 to 1", d->uneven);
    return LMN_OK;
}

lmn_status lmn_strokes_create(lmn_strokes **out, const lmn_pattern_desc *desc, lmn_error *error)
{
    lmn_pattern_desc full = LMN_PATTERN_DESC_INIT;
    if (!out)
        return missing("lmn_strokes_create", "out", error);
    *out = NULL;
    lmn_status status = desc_complete_given(&full, sizeof full, desc, "LMN_PATTERN_DESC_INIT", error);
    if (status == LMN_OK)
        status = check_pattern(&full, error);
    if (status != LMN_OK)
        return status;
    lmn_strokes *made = allocate();
    if (!made)
        return error_memory(error);
    pattern_options options = {(stroke_pattern)full.pattern, full.count, (float)full.length, (float)full.uneven,
                               full.seed};
    work            w;
    work_begin(&w, NULL, NULL);
    if (desc)
        status = strokes_generate(&made->list, &options, error);
    status = work_end(&w, status, error);
    if (status == LMN_OK)
        *out = made;
    else
        lmn_strokes_destroy(&made);
    return status;
}

lmn_status lmn_strokes_load(lmn_strokes **out, const char *path, lmn_error *error)
{
    if (!out || !path)
        return missing("lmn_strokes_load", out ? "path" : "out", error);
    *out = NULL;
    lmn_strokes *made = allocate();
    if (!made)
        return error_memory(error);
    work w;
    work_begin(&w, NULL, NULL);
    lmn_status status = work_end(&w, strokes_load(&made->list, path, error), error);
    if (status == LMN_OK)
        *out = made;
    else
        lmn_strokes_destroy(&made);
    return status;
}

void lmn_strokes_destroy(lmn_strokes **handle)
{
    if (!handle || !*handle)
        return;
    strokes_release(&(*handle)->list);
    mem_free(*handle);
    *handle = NULL;
}

const char *lmn_stroke_pattern_name(int pattern)
{
    return pattern >= 0 && pattern < PATTERN_COUNT ? stroke_pattern_names[pattern] : NULL;
}

size_t lmn_strokes_count(const lmn_strokes *s)
{
    return s ? s->list.count : 0;
}

lmn_status lmn_strokes_get(const lmn_strokes *s, size_t index, lmn_stroke *out, lmn_error *error)
{
    if (!s || !out)
        return missing("lmn_strokes_get", s ? "out" : "strokes", error);
    if (index >= s->list.count)
        return error_set(error, LMN_USAGE, "lmn_strokes_get: index is %zu; there are %zu strokes", index,
                         s->list.count);
    const texture_stroke *t = &s->list.items[index];
    *out = (lmn_stroke){t->u0, t->v0, t->u1, t->v1, t->light, t->perspective, t->layer};
    return LMN_OK;
}

static lmn_status check_stroke(const lmn_stroke *t, lmn_error *error)
{
    const float positions[4] = {t->u0, t->v0, t->u1, t->v1};
    for (int i = 0; i < 4; i++)
        if (!(fabsf(positions[i]) <= LIMIT_STROKE_REACH))
            return error_set(error, LMN_USAGE, "lmn_strokes_set: a place is %g; allowed is -16 to 16",
                             (double)positions[i]);
    if (!isfinite(t->light) || !isfinite(t->perspective))
        return error_set(error, LMN_USAGE, "lmn_strokes_set: a priority is not finite");
    if (t->layer < 0 || t->layer >= LIMIT_STROKE_LAYERS)
        return error_set(error, LMN_USAGE, "lmn_strokes_set: layer is %d; allowed is 0 to 65535", (int)t->layer);
    return LMN_OK;
}

lmn_status lmn_strokes_set(lmn_strokes *s, size_t index, const lmn_stroke *given, lmn_error *error)
{
    if (!s || !given)
        return missing("lmn_strokes_set", s ? "stroke" : "strokes", error);
    if (index > s->list.count)
        return error_set(error, LMN_USAGE, "lmn_strokes_set: index is %zu; there are %zu strokes", index,
                         s->list.count);
    lmn_status status = check_stroke(given, error);
    if (status != LMN_OK)
        return status;
    if (index >= LIMIT_STROKES)
        return error_set(error, LMN_LIMIT, "lmn_strokes_set: more than %d strokes", LIMIT_STROKES);
    texture_stroke t = {given->u0, given->v0, given->u1, given->v1, given->light, given->perspective, given->layer};
    strokes        one = {&t, 1, 1, 1};
    strokes_wrap(&one);
    if (index < s->list.count)
        s->list.items[index] = t;
    else if (!strokes_add(&s->list, t))
        return error_memory(error);
    return LMN_OK;
}

lmn_status lmn_strokes_set_light(lmn_strokes *s, lmn_stroke_order order, lmn_stroke_fraction fraction, double width,
                                 uint32_t seed, lmn_error *error)
{
    if (!s)
        return missing("lmn_strokes_set_light", "strokes", error);
    if ((int)order < 0 || order > LMN_ORDER_EVEN || (int)fraction < 0 || fraction > LMN_FRACTION_AREA)
        return error_set(error, LMN_USAGE, "lmn_strokes_set_light: there is no order %d or no share %d", (int)order,
                         (int)fraction);
    if (fraction == LMN_FRACTION_AREA && !(width > 0 && width <= 1))
        return error_set(error, LMN_USAGE, "lmn_strokes_set_light: width is %g; allowed is above 0, at most 1", width);
    return strokes_set_light(&s->list, (priority_order)order, (priority_fraction)fraction, width, seed, error);
}

lmn_status lmn_strokes_set_perspective(lmn_strokes *s, lmn_stroke_perspective perspective, uint32_t seed,
                                       lmn_error *error)
{
    if (!s)
        return missing("lmn_strokes_set_perspective", "strokes", error);
    if ((int)perspective < 0 || perspective > LMN_PERSPECTIVE_LAYERS)
        return error_set(error, LMN_USAGE, "lmn_strokes_set_perspective: there is no order %d", (int)perspective);
    return strokes_set_perspective(&s->list, (perspective_order)perspective, seed, error);
}

/* --- writing --- */

static lmn_status check_view(lmn_strokes_view *v, lmn_error *error)
{
    if (v->size < 1 || v->size > SIDE_MOST)
        return error_set(error, LMN_USAGE, "lmn_strokes_write: size is %d; allowed is 1 to %d", v->size, SIDE_MOST);
    if (!(v->width >= 0 && v->width <= WIDTH_MOST))
        return error_set(error, LMN_USAGE, "lmn_strokes_write: width is %g; allowed is 0 to %d", v->width, WIDTH_MOST);
    if (!isfinite(v->light) || !isfinite(v->distance))
        return error_set(error, LMN_USAGE, "lmn_strokes_write: light or distance is not finite");
    if (v->width == 0)
        v->width = v->size / 170.0;
    return LMN_OK;
}

static lmn_status write_picture(const strokes *s, const char *path, const lmn_strokes_view *v, lmn_error *error)
{
    size_t       side = (size_t)v->size;
    uint8_t     *grey = mem_alloc(side * side), *rgba = mem_alloc(side * side * 4);
    export_bytes png = {0};
    lmn_status   status = grey && rgba ? LMN_OK : error_memory(error);
    if (status == LMN_OK) {
        strokes_draw(s, v->size, &(stroke_brush){.width = v->width}, (float)v->light, (float)v->distance, grey);
        for (size_t y = 0; y < side; y++)
            for (size_t x = 0; x < side; x++) {
                uint8_t value = grey[(side - 1 - y) * side + x], pixel[4] = {value, value, value, 255};
                memcpy(rgba + 4 * (y * side + x), pixel, sizeof pixel);
            }
        status = export_png(&png, rgba, v->size, v->size, error);
    }
    if (status == LMN_OK)
        status = file_store(path, png.data, png.size, error);
    mem_free(png.data);
    mem_free(grey);
    mem_free(rgba);
    return status;
}

static lmn_status write_text(const strokes *s, const char *path, bool svg, lmn_error *error)
{
    text out = {0};
    if (svg)
        strokes_write_svg(&out, s);
    else
        strokes_write(&out, s);
    lmn_status status = out.failed ? error_memory(error) : file_store(path, out.data, out.size, error);
    text_release(&out);
    return status;
}

lmn_status lmn_strokes_write(const lmn_strokes *s, const char *path, const char *format, const lmn_strokes_view *view,
                             lmn_error *error)
{
    char             ending[8];
    lmn_strokes_view full = LMN_STROKES_VIEW_INIT;
    if (!s || !path || !*path)
        return missing("lmn_strokes_write", s ? "path" : "strokes", error);
    file_ending(format ? format : path, ending, sizeof ending);
    bool png = strcmp(ending, ".png") == 0, svg = strcmp(ending, ".svg") == 0;
    if (!png && !svg && strcmp(ending, ".stx") != 0) {
        error_set(error, LMN_USAGE, "%s: cannot tell the format from '%s'", path, format ? format : ending);
        error_hint(error, "strokes are written as .stx, .svg or .png");
        return LMN_USAGE;
    }
    lmn_status status = desc_complete_given(&full, sizeof full, png ? view : NULL, "LMN_STROKES_VIEW_INIT", error);
    if (status == LMN_OK && png)
        status = check_view(&full, error);
    if (status != LMN_OK)
        return status;
    work w;
    work_begin(&w, NULL, NULL);
    status = png ? write_picture(&s->list, path, &full, error) : write_text(&s->list, path, svg, error);
    return status == LMN_OK ? work_end_done(&w) : work_end(&w, status, error);
}
