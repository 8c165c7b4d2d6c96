/* Shadows of the first light: the scene's depth as the light sees it. */
#include "frame/frame_private.h"

#include <math.h>

#include "light/light.h"

enum { SHADOW_SIDE_MOST = 2048, SHADOW_SIDE_LEAST = 256 };

/* Twice as fine as the picture, about; half of that is enough for soft borders. */
static int side_of(const frame *f, bool soft)
{
    int longest = f->width > f->height ? f->width : f->height, side = SHADOW_SIDE_LEAST;
    while (side < SHADOW_SIDE_MOST && side < 2 * longest)
        side *= 2;
    return soft ? side / 2 : side;
}

static double dot(const double a[3], const double b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static void cross(const double a[3], const double b[3], double out[3])
{
    for (int k = 0; k < 3; k++)
        out[k] = a[(k + 1) % 3] * b[(k + 2) % 3] - a[(k + 2) % 3] * b[(k + 1) % 3];
}

static void scale_to(double v[3], double length)
{
    double own = sqrt(dot(v, v));
    for (int k = 0; k < 3; k++)
        v[k] *= length / (own > 0 ? own : 1);
}

/* An eye that looks along the light, with parallel rays, at the whole box. `back`: world axes, towards the light. */
static view_camera camera_of_light(box3 box, const double back[3])
{
    double seed[3] = {0, 0, 0}, right[3], up[3];
    seed[fabs(back[0]) < 0.6 ? 0 : 1] = 1;
    cross(seed, back, right);
    scale_to(right, 1);
    cross(back, right, up);
    double middle[3];
    box3_middle(box, middle);
    double        half[3] = {((double)box.max.x - (double)box.min.x) / 2, ((double)box.max.y - (double)box.min.y) / 2,
                             ((double)box.max.z - (double)box.min.z) / 2};
    double        reach = sqrt(dot(half, half)), side = 0;
    const double *axes[2] = {right, up};
    for (int i = 0; i < 2; i++)
        side = fmax(side, half[0] * fabs(axes[i][0]) + half[1] * fabs(axes[i][1]) + half[2] * fabs(axes[i][2]));
    view_camera c = {
        .orthographic = true, .aspect = 1, .half_height = side > 0 ? side * 1.01 : 1, .view = mat4_identity()};
    for (int k = 0; k < 3; k++) {
        c.eye[k] = middle[k] + back[k] * 2 * reach;
        c.target[k] = middle[k];
        c.up[k] = up[k];
        c.view.m[4 * k] = right[k];
        c.view.m[4 * k + 1] = up[k];
        c.view.m[4 * k + 2] = back[k];
    }
    c.view.m[12] = -dot(right, c.eye);
    c.view.m[13] = -dot(up, c.eye);
    c.view.m[14] = -dot(back, c.eye);
    camera_set_range(&c, reach > 0 ? reach * 0.99 : 0.5, reach > 0 ? reach * 3.01 : 2);
    return c;
}

static bool rule_reads_shadow(const rule *r)
{
    for (int k = 0; r && k < KIND_COUNT; k++)
        for (size_t i = 0; i < r->use_counts[k]; i++) {
            const technique_use *use = &r->uses[k][i];
            for (size_t p = 0; p < use->technique->pass_count; p++)
                for (int n = 0; n < PASS_READS_MAX && use->technique->passes[p].reads[n]; n++)
                    if (use->technique->passes[p].reads[n] == TARGET_SHADOW &&
                        pass_applies((kind_id)k, &use->technique->passes[p], use))
                        return true;
        }
    return false;
}

/* Does some pass look at shadows whether or not they are drawn? */
static bool is_read(const frame *f)
{
    for (size_t i = 0; i < f->plan->figure_count; i++)
        if (rule_reads_shadow(f->plan->figures[i].rule) || rule_reads_shadow(f->plan->figures[i].hidden))
            return true;
    return false;
}

void shadow_draw(frame *f)
{
    const scene_values *v = f->plan->look->wide[KIND_SCENE].values;
    double              towards[3], back[3];
    bool                read = is_read(f);
    if ((!v->shadows && !read) || box3_is_empty(f->plan->box) || !lights_first_direction(f, towards))
        return;
    for (int k = 0; k < 3; k++) /* the view's rotation, backwards */
        back[k] = dot(&f->camera.view.m[4 * k], towards);
    scale_to(back, 1);
    stopwatch w = watch_start(&f->profile);
    frame     light = *f;
    light.camera = f->shadow_camera = camera_of_light(f->plan->box, back);
    light.width = light.height = side_of(f, !read && v->shadow_softness > 0);
    light.maps = NULL;
    gpu_texture *depth = frame_acquire_sized(f, TARGET_SHADOW, light.width, light.height);
    light.page_depth = depth; /* what solids are gathered in must be as large */
    if (!gpu_failed(f->g))
        raster_depth_of(&light, depth, f->plan->throws);
    f->shadow = depth;
    if (v->shadows)
        movers_throw_shadows(f);
    watch_stop(&f->profile, w, "scene", "shadow");
}
