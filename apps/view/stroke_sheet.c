#include "stroke_sheet.h"

#include <math.h>

enum { STEPS_MAX = 200 };

static void array_unref(void *array)
{
    g_array_unref(array);
}

stroke_sheet *stroke_sheet_make(void)
{
    stroke_sheet *s = g_new0(stroke_sheet, 1);
    s->strokes = g_array_new(FALSE, FALSE, sizeof(lmn_stroke));
    s->before = g_ptr_array_new_with_free_func(array_unref);
    return s;
}

void stroke_sheet_free(stroke_sheet *s)
{
    g_array_unref(s->strokes);
    g_ptr_array_unref(s->before);
    g_free(s);
}

void stroke_sheet_step(stroke_sheet *s)
{
    if (s->before->len >= STEPS_MAX)
        g_ptr_array_remove_index(s->before, 0);
    g_ptr_array_add(s->before, g_array_copy(s->strokes));
}

bool stroke_sheet_undo(stroke_sheet *s)
{
    if (s->before->len == 0)
        return false;
    g_array_unref(s->strokes);
    s->strokes = g_array_ref(g_ptr_array_index(s->before, s->before->len - 1));
    g_ptr_array_remove_index(s->before, s->before->len - 1);
    return true;
}

static lmn_stroke *at(const stroke_sheet *s, guint index)
{
    return &g_array_index(s->strokes, lmn_stroke, index);
}

void stroke_sheet_add(stroke_sheet *s, double u0, double v0, double u1, double v1, int layer)
{
    /* Its start lies in the square. */
    double     du = floor(u0), dv = floor(v0);
    lmn_stroke stroke = {(float)(u0 - du), (float)(v0 - dv), (float)(u1 - du), (float)(v1 - dv), 1, 1, layer};
    g_array_append_val(s->strokes, stroke);
}

/* How far two positions are apart in a square that repeats. */
static double distance(double u0, double v0, double u1, double v1)
{
    return hypot(remainder(u0 - u1, 1), remainder(v0 - v1, 1));
}

int stroke_sheet_pick(const stroke_sheet *s, double u, double v, double reach, bool *second)
{
    int found = -1;
    for (guint i = 0; i < s->strokes->len; i++) {
        const lmn_stroke *k = at(s, i);
        for (int end = 0; end < 2; end++) {
            double apart = distance(u, v, (double)(end ? k->u1 : k->u0), (double)(end ? k->v1 : k->v0));
            if (apart >= reach)
                continue;
            reach = apart;
            found = (int)i;
            *second = end;
        }
    }
    return found;
}

void stroke_sheet_move_end(stroke_sheet *s, int index, bool second, double u, double v)
{
    lmn_stroke *k = at(s, (guint)index);
    double      du = u - (double)(second ? k->u1 : k->u0), dv = v - (double)(second ? k->v1 : k->v0);
    /* The nearest of the positions that are the same in a square that repeats. */
    du -= round(du);
    dv -= round(dv);
    *(second ? &k->u1 : &k->u0) += (float)du;
    *(second ? &k->v1 : &k->v0) += (float)dv;
    float whole_u = floorf(k->u0), whole_v = floorf(k->v0);
    k->u0 -= whole_u;
    k->u1 -= whole_u;
    k->v0 -= whole_v;
    k->v1 -= whole_v;
}

void stroke_sheet_set_layer(stroke_sheet *s, int index, int layer)
{
    at(s, (guint)index)->layer = layer;
}

void stroke_sheet_remove(stroke_sheet *s, int index)
{
    g_array_remove_index(s->strokes, (guint)index);
}

bool stroke_is_seen(const lmn_stroke *k, double light, double far)
{
    return (double)k->light >= light && (double)k->perspective >= far;
}

/* --- by the library -------------------------------------------------------------------------------------- */

static lmn_status to_library(const stroke_sheet *s, lmn_strokes **out, lmn_error *error)
{
    lmn_status status = lmn_strokes_create(out, NULL, error);
    for (guint i = 0; i < s->strokes->len && status == LMN_OK; i++)
        status = lmn_strokes_set(*out, i, at(s, i), error);
    return status;
}

static lmn_status from_library(stroke_sheet *s, const lmn_strokes *strokes, lmn_error *error)
{
    GArray    *read = g_array_new(FALSE, FALSE, sizeof(lmn_stroke));
    lmn_status status = LMN_OK;
    for (size_t i = 0; i < lmn_strokes_count(strokes) && status == LMN_OK; i++) {
        lmn_stroke stroke;
        status = lmn_strokes_get(strokes, i, &stroke, error);
        g_array_append_val(read, stroke);
    }
    if (status == LMN_OK) {
        g_array_unref(s->strokes);
        s->strokes = g_array_ref(read);
    }
    g_array_unref(read);
    return status;
}

lmn_status stroke_sheet_order(stroke_sheet *s, lmn_stroke_order order, lmn_stroke_perspective perspective,
                              uint32_t seed, lmn_error *error)
{
    lmn_strokes *strokes = NULL;
    lmn_status   status = to_library(s, &strokes, error);
    if (status == LMN_OK)
        status = lmn_strokes_set_light(strokes, order, LMN_FRACTION_COUNT, 1.0 / 170, seed, error);
    if (status == LMN_OK)
        status = lmn_strokes_set_perspective(strokes, perspective, seed, error);
    if (status == LMN_OK)
        status = from_library(s, strokes, error);
    lmn_strokes_destroy(&strokes);
    return status;
}

lmn_status stroke_sheet_load(stroke_sheet *s, const char *path, lmn_error *error)
{
    lmn_strokes *strokes = NULL;
    lmn_status   status = lmn_strokes_load(&strokes, path, error);
    if (status == LMN_OK)
        status = from_library(s, strokes, error);
    lmn_strokes_destroy(&strokes);
    return status;
}

lmn_status stroke_sheet_save(const stroke_sheet *s, const char *path, lmn_error *error)
{
    lmn_strokes *strokes = NULL;
    lmn_status   status = to_library(s, &strokes, error);
    if (status == LMN_OK)
        status = lmn_strokes_write(strokes, path, NULL, NULL, error);
    lmn_strokes_destroy(&strokes);
    return status;
}
