/* Shadows of the first light: the scene's depth as the light sees it. */
#include "frame/frame_private.h"

#include <math.h>
#include <string.h>

#include "base/memory.h"
#include "light/light.h"

/* Twice as fine as the picture, about; half of that is enough for soft borders. */
static int side_of(const frame *f, bool soft)
{
    enum { LEAST = 128, MOST = 1024, FINER = 4, MORE = 2 };
    int longest = f->width > f->height ? f->width : f->height, side = soft ? LEAST : LEAST * FINER;
    while (side < (soft ? MOST : MOST * FINER) && side < (soft ? longest : longest * MORE))
        side *= 2;
    return side;
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

/* A rectangle across the light: least and most along its two axes. */
typedef struct light_window {
    double least[2], most[2];
} light_window;

static void widen(light_window *w, const double *const axes[2], const double point[3])
{
    for (int i = 0; i < 2; i++) {
        w->least[i] = fmin(w->least[i], dot(axes[i], point));
        w->most[i] = fmax(w->most[i], dot(axes[i], point));
    }
}

/* Where what the viewer sees lies: no other place is asked for, whatever throws its shadow there. */
static light_window window_of_view(const view_camera *c, const double *const axes[2])
{
    light_window  out = {{INFINITY, INFINITY}, {-INFINITY, -INFINITY}};
    const double *m = c->view.m, *p = c->projection.m;
    for (int corner = 0; corner < 8; corner++) {
        double depth = corner & 4 ? c->far : c->near, away = c->orthographic ? 1 : depth;
        double eye[3] = {(corner & 1 ? 1 : -1) * away / p[0], (corner & 2 ? 1 : -1) * away / p[5], -depth}, world[3];
        for (int k = 0; k < 3; k++)
            eye[k] -= m[12 + k];
        for (int k = 0; k < 3; k++)
            world[k] = m[4 * k] * eye[0] + m[4 * k + 1] * eye[1] + m[4 * k + 2] * eye[2];
        widen(&out, axes, world);
    }
    return out;
}

static light_window window_of_box(box3 box, const double *const axes[2])
{
    light_window out = {{INFINITY, INFINITY}, {-INFINITY, -INFINITY}};
    for (int corner = 0; corner < 8; corner++) {
        const double point[3] = {(double)(corner & 1 ? box.max.x : box.min.x),
                                 (double)(corner & 2 ? box.max.y : box.min.y),
                                 (double)(corner & 4 ? box.max.z : box.min.z)};
        widen(&out, axes, point);
    }
    return out;
}

/* An eye that looks along the light, with parallel rays, at the whole box, or at what a viewer (may be NULL) sees of
 * it. `back`: world axes, towards the light. */
static view_camera camera_of_light(box3 box, const double back[3], const view_camera *viewer)
{
    double seed[3] = {0, 0, 0}, right[3], up[3];
    seed[fabs(back[0]) < 0.6 ? 0 : 1] = 1;
    cross(seed, back, right);
    scale_to(right, 1);
    cross(back, right, up);
    const double *axes[2] = {right, up};
    double        middle[3], reach = box3_diagonal(box) / 2, side = 0;
    box3_middle(box, middle);
    light_window w = window_of_box(box, axes), seen = viewer ? window_of_view(viewer, axes) : w;
    for (int i = 0; i < 2; i++) {
        double least = fmax(w.least[i], seen.least[i]), most = fmin(w.most[i], seen.most[i]);
        bool   any = most > least;
        double at = any ? (least + most) / 2 : (w.least[i] + w.most[i]) / 2, off = at - dot(axes[i], middle);
        side = fmax(side, (any ? most - least : w.most[i] - w.least[i]) / 2);
        for (int k = 0; k < 3; k++)
            middle[k] += off * axes[i][k];
    }
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

/* Is light asked for away from the page: in mirrors, or on surfaces laid out by their texture coordinates? */
static bool is_seen_elsewhere(const frame *f)
{
    for (size_t i = 0; i < f->plan->figure_count; i++) {
        const figure        *fig = &f->plan->figures[i];
        const technique_use *surface = rule_use(fig->rule, KIND_SURFACE);
        if (fig->reflects || fig->mover || (surface && surface->technique->surface->light_map_when))
            return true;
    }
    return false;
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

/* Would the light see what it saw last? */
static bool sees_the_same(const frame *f, const frame *light)
{
    const seen_by_light *k = &f->up->lit;
    return k->depth && gpu_texture_width(k->depth) == light->width &&
           memcmp(&k->view, &light->camera.view, sizeof k->view) == 0 &&
           memcmp(&k->projection, &light->camera.projection, sizeof k->projection) == 0 &&
           memcmp(k->parts, f->plan->throws, f->plan->part_count * sizeof *k->parts) == 0;
}

static void forget(frame *f)
{
    gpu_target_release(f->g, f->up->lit.depth);
    mem_free(f->up->lit.parts);
    f->up->lit = (seen_by_light){.depth = NULL};
}

/* Movers put shadows of their own into the picture. */
static bool has_movers(const plan *p)
{
    bool found = false;
    for (size_t i = 0; i < p->figure_count; i++)
        found = found || p->figures[i].mover;
    return found;
}

static void keep(frame *f, const frame *light)
{
    bool *parts =
        has_movers(f->plan) || gpu_failed(f->g) ? NULL : mem_copy(f->plan->throws, f->plan->part_count * sizeof *parts);
    if (parts)
        f->up->lit = (seen_by_light){f->shadow, light->camera.view, light->camera.projection, parts};
}

void shadow_release(frame *f)
{
    if (f->shadow != f->up->lit.depth)
        gpu_target_release(f->g, f->shadow);
}

void shadow_draw(frame *f)
{
    const scene_values *v = f->plan->look->wide[KIND_SCENE].values;
    double              towards[3], back[3];
    bool                read = is_read(f), cast = v->ground == GROUND_CAST && f->ground_plane.there;
    view_camera         viewer = f->camera;
    if ((!v->shadows && !read && !cast) || box3_is_empty(f->plan->box) || !lights_first_direction(f, towards))
        return;
    for (int k = 0; k < 3; k++) /* the view's rotation, backwards */
        back[k] = dot(&f->camera.view.m[4 * k], towards);
    scale_to(back, 1);
    /* The ground is seen before and behind the model, too. */
    if (cast)
        camera_set_range(&viewer, f->camera.near * (f->camera.orthographic ? 1 : 0.2), f->camera.far * 2);
    bool  hard = read || !(v->shadow_softness > 0);
    frame light = *f;
    light.camera = f->shadow_camera =
        camera_of_light(f->plan->box, back, hard && !is_seen_elsewhere(f) ? &viewer : NULL);
    light.width = light.height = side_of(f, !hard);
    light.maps = NULL;
    if (sees_the_same(f, &light)) {
        f->shadow = f->up->lit.depth;
        return;
    }
    stopwatch w = watch_start(&f->profile);
    forget(f);
    gpu_texture *depth = frame_acquire_sized(f, TARGET_SHADOW, light.width, light.height);
    light.page_depth = depth; /* what solids are gathered in must be as large */
    if (!gpu_failed(f->g))
        raster_depth_of(&light, depth, f->plan->throws);
    f->shadow = depth;
    if (v->shadows || cast)
        movers_throw_shadows(f);
    keep(f, &light);
    watch_stop(&f->profile, w, "scene", "shadow");
}
