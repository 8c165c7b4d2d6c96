/* The report of a drawing and the facts of a renderer, as JSON. Keys are documented in docs/reference. */
#include <jansson.h>
#include <stdlib.h>

#include "base/limits.h"
#include "draw/drawing.h"
#include "plan/report_json.h"
#include "limner/version.h"

static json_t *passes_json(const gpu_pass_time *times, size_t count)
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
    for (size_t i = 0; i < d->facts.part_count && d->part_pixels; i++)
        if (d->part_pixels[i])
            json_array_append_new(array, json_pack("{s:I, s:s, s:I}", "id", (json_int_t)(i + 1), "name",
                                                   d->facts.part_names[i], "pixels", (json_int_t)d->part_pixels[i]));
    return array;
}

static json_t *gpu_json(const char *vendor, const char *renderer, const char *version)
{
    return json_pack("{s:s, s:s, s:s}", "vendor", vendor, "renderer", renderer, "version", version);
}

static json_t *marks_json(const mark_facts *m)
{
    return json_pack("{s:I, s:I, s:I, s:I, s:I, s:{s:I, s:I, s:I}}", "there", (json_int_t)m->there, "drawn",
                     (json_int_t)m->drawn, "bytes", (json_int_t)m->bytes, "clusters", (json_int_t)m->clusters,
                     "clusters_drawn", (json_int_t)m->clusters_drawn, "left_out", "off_page", (json_int_t)m->beside,
                     "turned_away", (json_int_t)m->turned_away, "too_dense", (json_int_t)m->too_dense);
}

char *drawing_report_json(const lmn_drawing *d)
{
    json_t *root = facts_begin_json(&d->facts, d->width, d->height);
    json_object_set_new(root, "gpu", gpu_json(d->vendor, d->renderer, d->version));
    json_object_set_new(root, "scene", facts_scene_json(&d->facts));
    json_object_set_new(root, "camera", report_camera_json(&d->camera));
    json_object_set_new(root, "layers", json_integer(d->layers));
    if (d->producer)
        json_object_set_new(root, "layer_producer", json_string(d->producer));
    json_object_set_new(root, "programs", json_integer((json_int_t)d->programs));
    json_object_set_new(root, "passes", passes_json(d->profile.times, d->profile.count));
    json_object_set_new(root, "load_ms", json_real(d->facts.load_ms));
    json_object_set_new(root, "frame_ms", json_real(d->frame_ms));
    json_object_set_new(root, "strokes", report_strokes_json(d->strokes));
    report_search(root, d->search);
    if (d->marks.there)
        json_object_set_new(root, "surface_marks", marks_json(&d->marks));
    if (d->has_traces || d->traces.telling.count)
        json_object_set_new(root, "motion", trace_facts_json(&d->traces));
    json_object_set_new(root, "parts_visible", parts_json(d));
    json_object_set_new(root, "warnings", report_warnings_json(&d->warnings));
    return report_dump(root);
}

char *renderer_json(const lmn_renderer *r)
{
    const gpu_capabilities *f = gpu_capabilities_of(r->g);
    json_t                 *root = json_object();
    json_object_set_new(root, "limner", json_string(LMN_VERSION));
    json_object_set_new(root, "gpu", gpu_json(f->vendor, f->renderer, f->version));
    json_object_set_new(root, "shading_language", json_string(f->shading));
    json_object_set_new(root, "api", json_string(f->es ? "OpenGL ES" : "OpenGL core"));
    json_object_set_new(root, "path", json_string(f->fast ? "fast" : "floor"));
    json_object_set_new(root, "limits",
                        json_pack("{s:i, s:i, s:i, s:i}", "texture_size", f->max_texture, "samples", f->max_samples,
                                  "colour_attachments", f->max_attachments, "storage_block_mib", f->max_storage_mib));
    json_object_set_new(
        root, "input_limits",
        json_pack("{s:I, s:I, s:I, s:I, s:I, s:I, s:i, s:i, s:i}", "file_bytes", (json_int_t)LIMIT_FILE_BYTES,
                  "vertices", (json_int_t)LIMIT_VERTICES, "triangles", (json_int_t)LIMIT_TRIANGLES, "lines",
                  (json_int_t)LIMIT_LINES, "nodes", (json_int_t)LIMIT_NODES, "instances", (json_int_t)LIMIT_INSTANCES,
                  "node_depth", LIMIT_NODE_DEPTH, "image_side", LIMIT_IMAGE_SIDE, "picture_side", LIMIT_PICTURE_SIDE));
    return report_dump(root);
}
