/* include/limner/projection.h: checks arguments and forwards. */
#include "limner/projection.h"

#include <string.h>

#include "api/check_desc.h"
#include "api/complete.h"
#include "base/error.h"
#include "base/work.h"
#include "limner/scene.h"
#include "plan/project_scene.h"
#include "plan/projection.h"

static lmn_status check(const lmn_projection_desc *d, lmn_error *error)
{
    bool round = d->projection == LMN_PROJECTION_PANORAMA;
    if (!projection_row_of((int)d->projection))
        return error_set(error, LMN_USAGE, "there is no projection %d", (int)d->projection);
    double least = round ? 30 : 1, most = round ? 360 : 90;
    if (d->angle_deg != 0 && !(d->angle_deg >= least && d->angle_deg <= most))
        return error_set(error, LMN_USAGE, "the angle of the %s is %g, it must be between %g and %g degrees, or 0",
                         lmn_projection_name((int)d->projection), d->angle_deg, least, most);
    if (!(d->from >= 0 && d->from < d->to && d->to <= 1))
        return error_set(error, LMN_USAGE, "the ground cannot bend from %g to %g; the numbers go from 0 to 1", d->from,
                         d->to);
    return LMN_OK;
}

const char *lmn_projection_name(int projection)
{
    const projection_row *row = projection_row_of(projection);
    return row ? row->name : NULL;
}

lmn_status lmn_scene_project(lmn_scene **out, const lmn_scene *scene, lmn_draw_desc *desc,
                             const lmn_projection_desc *projection, lmn_error *error)
{
    lmn_projection_desc how = LMN_PROJECTION_DESC_INIT;
    lmn_draw_desc       full;
    if (!out || !scene || !desc)
        return error_set(error, LMN_USAGE, "lmn_scene_project: `%s` is NULL", !out ? "out" : !scene ? "scene" : "desc");
    *out = NULL;
    lmn_status status = desc_complete_given(&how, sizeof how, projection, "LMN_PROJECTION_DESC_INIT", error);
    if (status == LMN_OK)
        status = check(&how, error);
    if (status == LMN_OK)
        status = check_draw_desc(&full, desc, error);
    if (status != LMN_OK)
        return status;
    work w;
    work_begin(&w, full.progress, full.progress_user);
    status = project_scene(out, scene, &full, &how, error);
    status = work_end(&w, status, error);
    if (status == LMN_OK) { /* as much of it as the caller knows */
        size_t known = desc->struct_size;
        memcpy(desc, &full, known);
        desc->struct_size = known;
    } else {
        lmn_scene_destroy(out);
    }
    return status;
}
