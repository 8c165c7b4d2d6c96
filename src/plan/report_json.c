#include "plan/report_json.h"

#include <math.h>
#include <stdlib.h>

#include "base/memory.h"
#include "limner/version.h"

static json_t *numbers(const double *values, size_t count)
{
    json_t *array = json_array();
    for (size_t i = 0; i < count; i++)
        json_array_append_new(array, json_real(isfinite(values[i]) ? values[i] : 0.0));
    return array;
}

json_t *report_box_json(box3 b)
{
    if (box3_is_empty(b))
        b = (box3){{0, 0, 0}, {0, 0, 0}};
    double low[3] = {b.min.x, b.min.y, b.min.z}, high[3] = {b.max.x, b.max.y, b.max.z};
    return json_pack("{s:o, s:o}", "min", numbers(low, 3), "max", numbers(high, 3));
}

json_t *report_camera_json(const view_camera *c)
{
    json_t *out = json_object();
    json_object_set_new(out, "eye", numbers(c->eye, 3));
    json_object_set_new(out, "target", numbers(c->target, 3));
    json_object_set_new(out, "up", numbers(c->up, 3));
    json_object_set_new(out, "projection", json_string(c->orthographic ? "orthographic" : "perspective"));
    json_object_set_new(out, "fov_deg",
                        c->orthographic ? json_null() : json_real(c->fov_y * (180 / 3.14159265358979323846)));
    json_object_set_new(out, "near", json_real(c->near));
    json_object_set_new(out, "far", json_real(c->far));
    json_object_set_new(out, "view_matrix", numbers(c->view.m, 16));
    json_object_set_new(out, "projection_matrix", numbers(c->projection.m, 16));
    return out;
}

json_t *report_warnings_json(const warnings *list)
{
    json_t *array = json_array();
    for (size_t i = 0; i < list->count; i++)
        json_array_append_new(array, json_pack("{s:s, s:s, s:I}", "code", warning_code_text(list->items[i].code),
                                               "text", list->items[i].text, "count", (json_int_t)list->items[i].count));
    return array;
}

json_t *report_strokes_json(const uint64_t counts[STROKE_CLASS_COUNT])
{
    json_t *out = json_object();
    for (int i = 0; i < STROKE_CLASS_COUNT; i++)
        if (counts[i])
            json_object_set_new(out, stroke_class_name((stroke_class)i), json_integer((json_int_t)counts[i]));
    return out;
}

void report_search(json_t *root, outline_search search)
{
    if (search.faces)
        json_object_set_new(
            root, "outline_search",
            json_pack("{s:I, s:I}", "faces", (json_int_t)search.faces, "tested", (json_int_t)search.tested));
}

char *report_dump(json_t *root)
{
    char *dumped = json_dumps(root, JSON_INDENT(2) | JSON_REAL_PRECISION(12));
    json_decref(root);
    char *copy = mem_copy_text(dumped); /* callers free it like all of the library's texts */
    free(dumped);
    return copy;
}
