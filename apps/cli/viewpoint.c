#include "viewpoint.h"

#include "message.h"

const char *const viewpoint_names[] = {"iso", "front", "back", "left", "right", "top", "bottom", "best", NULL};

bool viewpoint_given(const viewpoint_values *v)
{
    return v->view >= 0 || v->camera || v->eye.given;
}

int viewpoint_check(const viewpoint_values *v)
{
    if (v->orthographic && v->fov.given)
        return message_usage(NULL, "--ortho and --fov exclude each other");
    if (v->camera && (v->eye.given || v->view >= 0))
        return message_usage(NULL, "--camera excludes --eye and --view");
    if (v->camera && v->fit.given)
        return message_usage(NULL, "--fit does not go with --camera, which says how near the model is");
    if (v->camera && v->orthographic)
        return message_usage(NULL, "--ortho does not go with --camera, which has a projection of its own");
    if (v->eye.given && v->view >= 0)
        return message_usage(NULL, "--eye and --view exclude each other");
    if (!v->eye.given && (v->target.given || v->up.given))
        return message_usage("add --eye X,Y,Z", "--%s needs --eye", v->target.given ? "target" : "up");
    return EXIT_DONE;
}

int viewpoint_fill(lmn_draw_desc *desc, const viewpoint_values *v, const lmn_scene *scene)
{
    const lmn_scene_info info = lmn_scene_info_of(scene);
    lmn_error            error = {0};
    if (v->view >= 0 && v->view <= LMN_VIEW_BOTTOM)
        desc->view = (lmn_view)v->view;
    desc->camera = v->camera;
    desc->orthographic = v->orthographic;
    desc->fov_deg = v->fov.given ? v->fov.value : desc->fov_deg;
    desc->fit = v->fit.given ? v->fit.value : desc->fit;
    desc->eye_given = v->eye.given;
    desc->fit_direction = v->eye.given && v->fit.given;
    for (int i = 0; i < 3; i++) {
        desc->eye[i] = v->eye.value[i];
        desc->target[i] = v->target.given ? v->target.value[i] : (info.bounds_min[i] + info.bounds_max[i]) / 2;
        desc->up[i] = v->up.given ? v->up.value[i] : i == (info.up == 'z' ? 2 : 1) ? 1 : 0;
    }
    if (v->view > LMN_VIEW_BOTTOM && lmn_scene_best_view(scene, desc, &error) != LMN_OK)
        return message_error(&error);
    return EXIT_DONE;
}
