/* The report of a drawing and the facts of a renderer, as JSON. Keys are documented in docs/reference. */
#include <jansson.h>
#include <math.h>
#include <stdlib.h>

#include "base/limits.h"
#include "draw/drawing.h"
#include "draw/report_json.h"
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
    json_object_set_new(out, "fov_deg", c->orthographic ? json_null() : json_real(c->fov_y * (180 / 3.14159265358979323846)));
    json_object_set_new(out, "near", json_real(c->near));
    json_object_set_new(out, "far", json_real(c->far));
    json_object_set_new(out, "view_matrix", numbers(c->view.m, 16));
    json_object_set_new(out, "projection_matrix", numbers(c->projection.m, 16));
    return out;
}

static json_t *passes_json(const pass_time *times, size_t count)
{
    json_t *array = json_array();
    for (size_t i = 0; i < count; i++)
        json_array_append_new(array, json_pack("{s:s, s:f, s:I}", "name", times[i].name, "ms", times[i].ms, "draws",
                                               (json_int_t)times[i].draws));
    return array;
}

static json_t *parts_json(const lmn_drawing *d)
{
    json_t *array = json_array();
    for (size_t i = 0; i < d->part_count && d->part_pixels; i++)
        if (d->part_pixels[i])
            json_array_append_new(array, json_pack("{s:I, s:s, s:I}", "id", (json_int_t)(i + 1), "name", d->part_names[i], "pixels",
                                                   (json_int_t)d->part_pixels[i]));
    return array;
}

json_t *report_warnings_json(const warnings *list)
{
    json_t *array = json_array();
    for (size_t i = 0; i < list->count; i++)
        json_array_append_new(array, json_pack("{s:s, s:s, s:I}", "code", warning_code_text(list->items[i].code), "text",
                                               list->items[i].text, "count", (json_int_t)list->items[i].count));
    return array;
}

static json_t *gpu_json(const char *vendor, const char *renderer, const char *version)
{
    return json_pack("{s:s, s:s, s:s}", "vendor", vendor, "renderer", renderer, "version", version);
}

json_t *report_strokes_json(const uint64_t counts[STROKE_CLASS_COUNT])
{
    json_t *out = json_object();
    for (int i = 0; i < STROKE_CLASS_COUNT; i++)
        if (counts[i])
            json_object_set_new(out, stroke_class_name((stroke_class)i), json_integer((json_int_t)counts[i]));
    return out;
}

char *report_dump(json_t *root)
{
    char *out = json_dumps(root, JSON_INDENT(2) | JSON_REAL_PRECISION(12));
    json_decref(root);
    return out;
}

char *drawing_report_json(const lmn_drawing *d)
{
    json_t *root = json_object();
    json_object_set_new(root, "limner", json_string(LMN_VERSION));
    json_object_set_new(root, "look", json_string(d->look));
    json_object_set_new(root, "size", json_pack("[i, i]", d->width, d->height));
    json_object_set_new(root, "seed", json_integer((json_int_t)d->seed));
    json_object_set_new(root, "gpu", gpu_json(d->vendor, d->renderer, d->version));
    json_object_set_new(root, "scene", json_pack("{s:I, s:I, s:o}", "parts", (json_int_t)d->part_count, "triangles",
                                                 (json_int_t)d->triangles, "bounds", report_box_json(d->bounds)));
    json_object_set_new(root, "camera", report_camera_json(&d->camera));
    json_object_set_new(root, "layers", json_integer(d->layers));
    if (d->producer)
        json_object_set_new(root, "layer_producer", json_string(d->producer));
    json_object_set_new(root, "programs", json_integer((json_int_t)d->programs));
    json_object_set_new(root, "passes", passes_json(d->times, d->time_count));
    json_object_set_new(root, "load_ms", json_real(d->load_ms));
    json_object_set_new(root, "frame_ms", json_real(d->frame_ms));
    json_object_set_new(root, "strokes", report_strokes_json(d->strokes));
    json_object_set_new(root, "parts_visible", parts_json(d));
    json_object_set_new(root, "warnings", report_warnings_json(&d->warnings));
    return report_dump(root);
}

char *renderer_json(const lmn_renderer *r)
{
    const gpu_facts *f = gpu_facts_of(r->g);
    json_t *root = json_object();
    json_object_set_new(root, "limner", json_string(LMN_VERSION));
    json_object_set_new(root, "gpu", gpu_json(f->vendor, f->renderer, f->version));
    json_object_set_new(root, "shading_language", json_string(f->shading));
    json_object_set_new(root, "api", json_string(f->es ? "OpenGL ES" : "OpenGL core"));
    json_object_set_new(root, "path", json_string(f->fast ? "fast" : "floor"));
    json_object_set_new(root, "limits", json_pack("{s:i, s:i, s:i, s:i}", "texture_size", f->max_texture, "samples", f->max_samples,
                                                  "colour_attachments", f->max_attachments, "storage_block_mib", f->max_storage_mib));
    json_object_set_new(root, "input_limits",
                        json_pack("{s:I, s:I, s:I, s:I, s:I, s:i, s:i, s:i}", "file_bytes", (json_int_t)LIMIT_FILE_BYTES, "vertices",
                                  (json_int_t)LIMIT_VERTICES, "triangles", (json_int_t)LIMIT_TRIANGLES, "nodes", (json_int_t)LIMIT_NODES,
                                  "instances", (json_int_t)LIMIT_INSTANCES, "node_depth", LIMIT_NODE_DEPTH, "image_side", LIMIT_IMAGE_SIDE,
                                  "picture_side", LIMIT_PICTURE_SIDE));
    return report_dump(root);
}
