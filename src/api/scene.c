/* include/limner/scene.h: checks arguments and forwards. */
#include "limner/scene.h"

#include <string.h>

#include "api/complete.h"
#include "api/load_desc.h"
#include "base/error.h"
#include "base/file_store.h"
#include "base/memory.h"
#include "base/text.h"
#include "base/work.h"
#include "import/import.h"
#include "import/step.h"
#include "info/info.h"
#include "import/retarget.h"
#include "scene/scene.h"

lmn_status lmn_scene_create(lmn_scene **out, lmn_error *error)
{
    if (!out)
        return error_set(error, LMN_USAGE, "lmn_scene_create: `out` is NULL");
    *out = scene_new();
    return *out ? LMN_OK : error_memory(error);
}

void lmn_scene_destroy(lmn_scene **scene)
{
    if (!scene)
        return;
    scene_free(*scene);
    *scene = NULL;
}

/* The pointers are what there has been from the first version on. */
static lmn_status check_importer(const lmn_importer *given, const char *caller, lmn_error *error)
{
    lmn_importer full = LMN_IMPORTER_INIT;
    lmn_status   status = desc_complete(&full, sizeof full, given, "LMN_IMPORTER_INIT", error);
    if (status != LMN_OK)
        return status;
    if (given->struct_size < sizeof full || !full.name || !full.read || (!full.probe && !full.endings))
        return error_set(error, LMN_USAGE, "%s: an importer needs a name, `read`, and `probe` or endings", caller);
    return LMN_OK;
}

/* A caller built against an older header hands over a shorter description; what it lacks keeps its default. */
lmn_status load_desc_complete(lmn_load_desc *full, const lmn_load_desc *given, const char *caller, lmn_error *error)
{
    *full = (lmn_load_desc)LMN_LOAD_DESC_INIT;
    lmn_status status = desc_complete_given(full, sizeof *full, given, "LMN_LOAD_DESC_INIT", error);
    if (status != LMN_OK)
        return status;
    if (full->up_axis != LMN_UP_AUTO && full->up_axis != LMN_UP_Y && full->up_axis != LMN_UP_Z)
        return error_set(error, LMN_USAGE, "%s: up_axis %d is none of AUTO, Y, Z", caller, (int)full->up_axis);
    for (size_t i = 0; i < full->importer_count; i++) {
        status = check_importer(full->importers ? full->importers[i] : NULL, caller, error);
        if (status != LMN_OK)
            return status;
    }
    double lod;
    if (full->lod && (!text_is_double(full->lod, &lod) || !(lod >= 0)))
        return error_set(error, LMN_USAGE, "%s: `lod` '%.40s' is no level of detail such as 2 or 2.2", caller,
                         full->lod);
    if (!(full->populate >= 0 && full->populate <= 4))
        return error_set(error, LMN_USAGE, "%s: `populate` %g is not between 0 and 4", caller, full->populate);
    if (!(full->deflection >= 0 && full->deflection <= 1e9))
        return error_set(error, LMN_USAGE, "%s: `deflection` %g is not between 0 and 1e9", caller, full->deflection);
    for (size_t i = 0; i < full->define_count; i++)
        if (!full->defines || !full->defines[i])
            return error_set(error, LMN_USAGE, "%s: `defines` has a NULL among the first %zu", caller,
                             full->define_count);
    return LMN_OK;
}

lmn_status lmn_scene_add_file(lmn_scene *scene, const char *path, const lmn_load_desc *desc, lmn_error *error)
{
    if (!scene)
        return error_set(error, LMN_USAGE, "lmn_scene_add_file: `scene` is NULL");
    if (!path || !path[0])
        return error_set(error, LMN_USAGE, "lmn_scene_add_file: the path is empty");
    lmn_load_desc full;
    lmn_status    status = load_desc_complete(&full, desc, "lmn_scene_add_file", error);
    if (status != LMN_OK)
        return status;
    work w;
    work_begin(&w, full.progress, full.progress_user);
    lmn_scene *loaded = NULL;
    bool       retargeted = false;
    status = import_file(&loaded, path, &full, error);
    if (status == LMN_OK)
        status = work_check(error);
    if (status == LMN_OK)
        status = retarget_motion(scene, loaded, path, &retargeted, error);
    if (status == LMN_OK && !retargeted)
        status = scene_merge(scene, loaded, path, error);
    scene_free(loaded);
    if (status == LMN_OK)
        return work_end_done(&w);
    status = work_end(&w, status, error);
    if (error && !error->file[0])
        error_file(error, path);
    return status;
}

static void put_bounds(box3 box, double min[3], double max[3])
{
    if (box3_is_empty(box))
        box = (box3){{0, 0, 0}, {0, 0, 0}};
    const double low[3] = {box.min.x, box.min.y, box.min.z}, high[3] = {box.max.x, box.max.y, box.max.z};
    memcpy(min, low, sizeof low);
    memcpy(max, high, sizeof high);
}

lmn_scene_info lmn_scene_info_of(const lmn_scene *scene)
{
    lmn_scene_info info = {.up = 'y'};
    if (!scene)
        return info;
    info.parts = scene->part_count;
    info.nodes = scene_plain_node_count(scene);
    info.meshes = scene->mesh_count - scene->spare_meshes;
    info.materials = scene->material_count;
    info.textures = scene->image_count;
    info.cameras = scene->camera_count;
    info.lights = scene->light_count;
    info.animations = scene->animation_count;
    info.skins = scene->skin_count;
    box3 box = box3_empty();
    for (size_t i = 0; i < scene->part_count; i++) {
        info.triangles += scene->parts[i].triangles * node_draw_count(&scene->nodes[scene->parts[i].node]);
        info.lines += scene->parts[i].lines * node_draw_count(&scene->nodes[scene->parts[i].node]);
        box = box3_union(box, scene->parts[i].bounds);
    }
    put_bounds(box, info.bounds_min, info.bounds_max);
    if (scene->up)
        info.up = scene->up;
    return info;
}

bool lmn_scene_part_at(const lmn_scene *scene, size_t index, lmn_part_info *out)
{
    if (!scene || !out || index >= scene->part_count)
        return false;
    const part *p = &scene->parts[index];
    *out = (lmn_part_info){.id = (uint32_t)index + 1, .name = p->name, .path = p->path};
    out->instances = node_draw_count(&scene->nodes[p->node]);
    out->triangles = p->triangles * out->instances;
    out->lines = p->lines * out->instances;
    put_bounds(p->bounds, out->bounds_min, out->bounds_max);
    return true;
}

char *lmn_scene_info_json(const lmn_scene *scene)
{
    return scene ? scene_info_json(scene) : NULL;
}

char *lmn_step_version(void)
{
    return step_version();
}

char *lmn_scene_dynamics_json(const lmn_scene *scene)
{
    return scene ? scene_dynamics_json(scene) : NULL;
}

void lmn_text_free(char *text)
{
    mem_free(text);
}

lmn_status lmn_text_write(const char *text, const char *path, lmn_error *error)
{
    if (!text || !path || !*path)
        return error_set(error, LMN_USAGE, "lmn_text_write: %s", text ? "the path is empty" : "`text` is NULL");
    return file_store(path, text, strlen(text), error);
}
