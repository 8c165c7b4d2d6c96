/* A camera on its way. */
#include "depict/camera_shot.h"

#include <string.h>

#include "base/error.h"
#include "scene/channel.h"

/* What moves its field of view. */
static void take_zoom(camera_shot *s, const depict_job *j)
{
    const int32_t        index = j->scene->nodes[s->node].camera;
    const animation_path path = s->camera->orthographic ? PATH_CAMERA_HALF_HEIGHT : PATH_CAMERA_FOV;
    for (size_t k = 0; k < j->when.clip_count; k++) {
        const animation *a = &j->scene->animations[j->when.clips[k]];
        for (size_t c = 0; c < a->channel_count; c++)
            if (a->channels[c].path == path && a->channels[c].target == index && a->channels[c].key_count > 0)
                s->zoom = &a->channels[c];
    }
}

lmn_status camera_shot_open(camera_shot *out, const depict_job *j, const expression *e, double focus, lmn_error *error)
{
    const lmn_scene *s = j->scene;
    int32_t          own = e->target;
    memset(out, 0, sizeof *out);
    while (own != NONE && s->nodes[own].camera == NONE)
        own = scene_next_node(s, e->target, own);
    if (own == NONE)
        return error_set(error, LMN_USAGE, "'%s' is for cameras; '%.80s' has none", e->row->characteristic,
                         s->nodes[e->target].name ? s->nodes[e->target].name : "the target");
    out->node = own;
    out->camera = &s->cameras[s->nodes[own].camera];
    out->aspect = j->camera.aspect;
    lmn_status status = way_open(&out->way, s, own, &j->when, error);
    if (status != LMN_OK)
        return status;
    take_zoom(out, j);
    mat4 world = way_world(&out->way, fmin(fmax(e->now, e->from), e->to));
    out->focus = focus > 0 ? focus : vector3_distance(&world.m[12], j->camera.target) / 5;
    if (!(out->focus > 0))
        out->focus = j->size / 5;
    return LMN_OK;
}

/* Half the height of what it sees at the focus. */
static double half_height(const camera_shot *s, double seconds)
{
    double value = s->camera->orthographic ? s->camera->half_height : s->camera->fov_y;
    if (s->zoom)
        animation_channel_at(s->zoom, seconds, &value);
    return s->camera->orthographic ? value : tan(value / 2) * s->focus;
}

void camera_shot_release(camera_shot *s)
{
    way_release(&s->way);
}

void camera_shot_point(const camera_shot *s, double seconds, double x, double y, double out[3])
{
    const mat4   world = way_world(&s->way, seconds);
    const double half = half_height(s, seconds);
    double       axes[3][3];
    for (int k = 0; k < 3; k++) {
        vector3_copy(axes[k], &world.m[4 * k]);
        vector3_normalise(axes[k]);
    }
    vector3_add(out, &world.m[12], x * half * s->aspect, axes[0]);
    vector3_add(out, out, y * half, axes[1]);
    vector3_add(out, out, -s->focus, axes[2]);
}

double camera_shot_height(const camera_shot *s)
{
    return 2 * (s->camera->orthographic ? s->camera->half_height : tan(s->camera->fov_y / 2) * s->focus);
}
