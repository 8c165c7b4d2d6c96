#include "plan/facts.h"

#include <string.h>

#include "base/memory.h"
#include "info/city_info.h"
#include "limner/version.h"
#include "plan/report_json.h"

/* Clips without a name are told by their number. */
static json_t *time_of(const pose *p)
{
    json_t *clips = json_array();
    for (size_t i = 0; i < p->when.clip_count; i++) {
        const char *name = p->scene->animations[p->when.clips[i]].name;
        json_array_append_new(clips, name ? json_string(name) : json_integer((json_int_t)p->when.clips[i] + 1));
    }
    return json_pack("{s:f, s:o}", "seconds", p->when.seconds, "clips", clips);
}

lmn_status facts_take(report_facts *out, const pose *pose, const lmn_look *look, size_t part_count, uint32_t seed,
                      lmn_error *error)
{
    const lmn_scene *scene = pose->scene;
    *out = (report_facts){.seed = seed, .bounds = box3_empty(), .load_ms = scene->load_ms};
    out->look = mem_copy_text(look->name ? look->name : "");
    out->part_names = mem_calloc(part_count, sizeof *out->part_names);
    out->time = pose->when.clip_count ? time_of(pose) : NULL;
    if (!out->look || !out->part_names || (pose->when.clip_count && !out->time))
        return error_memory(error);
    out->part_count = part_count;
    for (size_t i = 0; i < part_count; i++)
        if (!(out->part_names[i] = mem_copy_text(scene->parts[i].name)))
            return error_memory(error);
    out->city = city_info_json(scene);
    return LMN_OK;
}

void facts_release(report_facts *f)
{
    mem_free(f->look);
    for (size_t i = 0; i < f->part_count; i++)
        mem_free(f->part_names[i]);
    mem_free(f->part_names);
    json_decref(f->time);
    json_decref(f->city);
    memset(f, 0, sizeof *f);
}

json_t *facts_begin_json(const report_facts *f, int width, int height)
{
    json_t *root = json_object();
    json_object_set_new(root, "limner", json_string(LMN_VERSION));
    json_object_set_new(root, "look", json_string(f->look));
    json_object_set_new(root, "size", json_pack("[i, i]", width, height));
    json_object_set_new(root, "seed", json_integer((json_int_t)f->seed));
    if (f->time)
        json_object_set(root, "time", f->time);
    return root;
}

json_t *facts_scene_json(const report_facts *f)
{
    json_t *root = json_pack("{s:I, s:I, s:o}", "parts", (json_int_t)f->part_count, "triangles",
                             (json_int_t)f->triangles, "bounds", report_box_json(f->bounds));
    if (root && f->city && !json_is_null(f->city))
        json_object_set(root, "city", f->city);
    return root;
}
