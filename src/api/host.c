/* Drawing inside of a host: arguments are checked here, the work is done in src/draw. */
#include "limner/host.h"

#include "api/check_desc.h"
#include "api/complete.h"
#include "base/error.h"
#include "base/work.h"
#include "draw/drawing.h"
#include "draw/into.h"

static lmn_status check_target(const lmn_target *t, const lmn_draw_desc *d, lmn_error *error)
{
    if (t->depth != LMN_TARGET_DEPTH_IGNORE && t->depth != LMN_TARGET_DEPTH_TEST_AND_WRITE)
        return error_set(error, LMN_USAGE, "the target's depth is %d, which is nothing of lmn_target_depth",
                         (int)t->depth);
    if (t->depth == LMN_TARGET_DEPTH_TEST_AND_WRITE && !d->matrices_given) {
        error_set(error, LMN_USAGE, "depth can be compared only with the host's camera");
        error_hint(error, "set matrices_given, view_matrix and projection_matrix of the description");
        return LMN_USAGE;
    }
    if (d->maps || d->profile || d->textures)
        return error_set(error, LMN_USAGE,
                         "lmn_draw_into keeps neither maps nor a profile nor textures; lmn_draw does");
    return LMN_OK;
}

lmn_status lmn_draw_into(lmn_renderer *renderer, const lmn_scene *scene, const lmn_look *look,
                         const lmn_draw_desc *desc, const lmn_target *target, lmn_error *error)
{
    if (!renderer || !scene || !look || !desc)
        return error_set(error, LMN_USAGE, "a renderer, a scene, a look and a description are needed to draw");
    if (!gpu_is_adopted(renderer->g)) {
        error_set(error, LMN_USAGE, "the renderer has a context of its own, which has no framebuffer of a host's");
        error_hint(error, "set `adopt` of its description; lmn_draw draws a picture with any renderer");
        return LMN_USAGE;
    }
    lmn_draw_desc given = LMN_DRAW_DESC_INIT, sized;
    lmn_target    into = LMN_TARGET_INIT;
    lmn_status    status = desc_complete(&into, sizeof into, target, "LMN_TARGET_INIT", error);
    if (status == LMN_OK)
        status = desc_complete(&given, sizeof given, desc, "LMN_DRAW_DESC_INIT", error);
    if (status == LMN_OK)
        status = check_target(&into, &given, error);
    if (status != LMN_OK)
        return status;
    given.width = into.width;
    given.height = into.height;
    status = check_draw_desc(&sized, &given, error);
    if (status != LMN_OK)
        return status;
    work w;
    work_begin(&w, sized.progress, sized.progress_user);
    status = check_pixels(&sized, error);
    if (status == LMN_OK)
        status = renderer_draw_into(renderer, scene, look, &sized, &into, error);
    return work_end(&w, status, error);
}

/* Are its textures there? */
static lmn_status check_kept(const lmn_drawing *d, const char *caller, lmn_error *error)
{
    if (!d)
        return error_set(error, LMN_USAGE, "%s: `drawing` is NULL", caller);
    if (d->kept && d->kept->renderer)
        return LMN_OK;
    if (d->kept)
        return error_set(error, LMN_USAGE, "%s: the textures are gone: the renderer has drawn again or has ended",
                         caller);
    error_set(error, LMN_USAGE, "%s: the drawing was made without textures", caller);
    error_hint(error, "set `textures` in its description");
    return LMN_USAGE;
}

lmn_status lmn_drawing_texture(const lmn_drawing *drawing, uint32_t *name, lmn_error *error)
{
    lmn_status status = check_kept(drawing, "lmn_drawing_texture", error);
    if (status == LMN_OK && !name)
        return error_set(error, LMN_USAGE, "lmn_drawing_texture: `name` is NULL");
    if (status == LMN_OK)
        *name = gpu_texture_name(drawing->kept->picture);
    return status;
}

lmn_status lmn_drawing_map_texture(const lmn_drawing *drawing, lmn_map map, uint32_t *name, lmn_error *error)
{
    const char *caller = "lmn_drawing_map_texture";
    lmn_status  status = check_kept(drawing, caller, error);
    if (status != LMN_OK)
        return status;
    if (!name)
        return error_set(error, LMN_USAGE, "%s: `name` is NULL", caller);
    if (!lmn_map_components(map))
        return error_set(error, LMN_USAGE, "%s: %d is no map", caller, (int)map);
    if (!drawing->kept->maps.textures[map])
        return error_set(error, LMN_USAGE, "%s: the drawing does not have this map", caller);
    *name = gpu_texture_name(drawing->kept->maps.textures[map]);
    return LMN_OK;
}

lmn_status lmn_drawing_read_back(lmn_drawing *drawing, lmn_error *error)
{
    if (drawing && drawing->pixels)
        return LMN_OK;
    lmn_status status = check_kept(drawing, "lmn_drawing_read_back", error);
    if (status != LMN_OK)
        return status;
    work w;
    work_begin(&w, NULL, NULL);
    return work_end(&w, drawing_read_back(drawing, error), error);
}
