/* The report of a sheet, as JSON. Keys are documented in docs/reference/report.md. */
#include <jansson.h>

#include "plan/report_json.h"
#include "vector/vector.h"

static json_t *numbers(const double *values, size_t count)
{
    json_t *array = json_array();
    for (size_t i = 0; i < count; i++)
        json_array_append_new(array, json_real(values[i]));
    return array;
}

static json_t *sheet_json(const lmn_sheet *s)
{
    json_t *views = json_array(), *out = json_object();
    for (size_t i = 0; i < s->view_count; i++)
        json_array_append_new(views,
                              json_pack("{s:s, s:o, s:o}", "name", s->views[i].name, "box", numbers(s->views[i].box, 4),
                                        "camera", report_camera_json(&s->views[i].camera)));
    json_object_set_new(out, "width_mm", json_real(s->page.width));
    json_object_set_new(out, "height_mm", json_real(s->page.height));
    json_object_set_new(out, "scale", *s->scale_text ? json_string(s->scale_text) : json_null());
    json_object_set_new(out, "unit", json_string(s->unit));
    json_object_set_new(out, "views", views);
    return out;
}

static json_t *parts_json(const lmn_sheet *s)
{
    json_t *array = json_array();
    for (size_t i = 0; i < s->facts.part_count; i++)
        if (s->part_strokes[i] || s->part_marks[i]) {
            json_t *part = json_pack("{s:I, s:s, s:I}", "id", (json_int_t)(i + 1), "name", s->facts.part_names[i],
                                     "strokes", (json_int_t)s->part_strokes[i]);
            if (s->part_marks[i])
                json_object_set_new(part, "marks", json_integer((json_int_t)s->part_marks[i]));
            json_array_append_new(array, part);
        }
    return array;
}

static json_t *strokes_json(const lmn_sheet *s)
{
    json_t *out = report_strokes_json(s->counts);
    if (s->dots)
        json_object_set_new(out, "dots", json_integer((json_int_t)s->dots));
    if (s->hatches)
        json_object_set_new(out, "hatch_lines", json_integer((json_int_t)s->hatches));
    if (s->centres)
        json_object_set_new(out, "centre_lines", json_integer((json_int_t)s->centres));
    if (s->threads)
        json_object_set_new(out, "thread_lines", json_integer((json_int_t)s->threads));
    if (s->marks)
        json_object_set_new(out, "marks", json_integer((json_int_t)s->marks));
    return out;
}

char *vector_report_json(const lmn_sheet *s)
{
    json_t *root = facts_begin_json(&s->facts, s->views[0].width, s->views[0].height);
    json_object_set_new(root, "scene", facts_scene_json(&s->facts));
    json_object_set_new(root, "camera", report_camera_json(&s->views[0].camera));
    json_object_set_new(root, "sheet", sheet_json(s));
    json_object_set_new(root, "load_ms", json_real(s->facts.load_ms));
    json_object_set_new(root, "frame_ms", json_real(s->frame_ms));
    json_object_set_new(root, "strokes", strokes_json(s));
    report_search(root, s->search);
    if (s->has_traces)
        json_object_set_new(root, "motion", trace_facts_json(&s->traces));
    json_object_set_new(root, "hidden_strokes", json_integer((json_int_t)s->hidden));
    if (s->verified)
        json_object_set_new(
            root, "verify",
            json_pack("{s:I, s:I}", "samples", (json_int_t)s->check.samples, "wrong", (json_int_t)s->check.wrong));
    json_object_set_new(root, "parts_visible", parts_json(s));
    json_object_set_new(root, "warnings", report_warnings_json(&s->warnings));
    return report_dump(root);
}
