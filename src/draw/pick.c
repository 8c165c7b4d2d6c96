#include "draw/pick.h"

#include <math.h>

const void *pick_map(const lmn_drawing *d, lmn_map map)
{
    const frame_maps *m = &d->maps;
    switch (map) {
    case LMN_MAP_DEPTH: return m->depth;
    case LMN_MAP_NORMAL: return m->normal;
    case LMN_MAP_ID: return m->id;
    case LMN_MAP_EDGE: return m->edge;
    case LMN_MAP_SHADE: return m->shade;
    case LMN_MAP_UNCERTAINTY: return m->uncertainty;
    case LMN_MAP_VELOCITY: return m->velocity;
    case LMN_MAP_DIRECTION: return m->direction;
    }
    return NULL;
}

/* Half the picture's height at depth 1, or at any with parallel rays. */
static double half_height(const view_camera *c)
{
    return c->orthographic ? c->half_height : tan(c->fov_y / 2);
}

bool pick_project(const lmn_drawing *d, const double point[3], double pixel[2], double *depth)
{
    const view_camera *c = &d->camera;
    const double      *m = c->view.m;
    double             eye[3];
    for (int k = 0; k < 3; k++)
        eye[k] = m[k] * point[0] + m[4 + k] * point[1] + m[8 + k] * point[2] + m[12 + k];
    double by = half_height(c) * (c->orthographic ? 1 : -eye[2]);
    *depth = -eye[2];
    if (!(by > 0))
        return false;
    pixel[0] = d->width * (0.5 + 0.5 * eye[0] / (by * c->aspect));
    pixel[1] = d->height * (0.5 - 0.5 * eye[1] / by);
    return true;
}

/* A rigid view's inverse is its transpose. */
static void to_scene(const view_camera *c, const double eye[3], double w, double out[3])
{
    const double *m = c->view.m;
    double        moved[3];
    for (int k = 0; k < 3; k++)
        moved[k] = eye[k] - w * m[12 + k];
    for (int k = 0; k < 3; k++)
        out[k] = m[4 * k] * moved[0] + m[4 * k + 1] * moved[1] + m[4 * k + 2] * moved[2];
}

/* The same of a picture's camera. */
static void unproject(const view_camera *c, int width, int height, const double pixel[2], double depth, double point[3])
{
    double       by = half_height(c) * (c->orthographic ? 1 : depth);
    const double eye[3] = {(2 * pixel[0] / width - 1) * by * c->aspect, (1 - 2 * pixel[1] / height) * by, -depth};
    to_scene(c, eye, 1, point);
}

void pick_unproject(const lmn_drawing *d, const double pixel[2], double depth, double point[3])
{
    unproject(&d->camera, d->width, d->height, pixel, depth, point);
}

/* A picture's pixel and where the maps have it. */
typedef struct picked {
    const view_camera *camera;
    const frame_maps  *maps;
    int                width, height, x, y; /* of the picture */
    size_t             index;
} picked;

static lmn_pick pick_of(const picked *p)
{
    lmn_pick     out = {.part = p->maps->id[p->index]};
    const float *n = &p->maps->normal[3 * p->index];
    if (!out.part)
        return out;
    out.depth = (double)p->maps->depth[p->index];
    unproject(p->camera, p->width, p->height, (const double[]){p->x + 0.5, p->y + 0.5}, out.depth, out.position);
    to_scene(p->camera, (const double[]){(double)n[0], (double)n[1], (double)n[2]}, 0, out.normal);
    return out;
}

lmn_pick pick_at(const lmn_drawing *d, int x, int y)
{
    size_t index = (size_t)(d->height - 1 - y) * (size_t)d->width + (size_t)x;
    return pick_of(&(picked){&d->camera, &d->maps, d->width, d->height, x, y, index});
}

/* The frame of maps, cut down to the pixel. */
static lmn_status draw_pixel(session *s, int x, int y, lmn_pick *out, lmn_error *error)
{
    frame     *f = &s->frame;
    frame_maps maps;
    lmn_status status = frame_maps_create_pixel(&maps, x, f->height - 1 - y, error);
    if (status != LMN_OK)
        return status;
    f->maps = &maps;
    frame_draw(f, NULL);
    status = gpu_check(f->g, error);
    if (status == LMN_OK)
        *out = pick_of(&(picked){&f->camera, &maps, f->width, f->height, x, y, 0});
    frame_maps_release(&maps);
    return status;
}

static lmn_status pick_pixel(lmn_renderer *r, const lmn_scene *scene, const lmn_look *look, const lmn_draw_desc *desc,
                             int x, int y, lmn_pick *out, lmn_error *error)
{
    session    s;
    warnings   said = {0};
    lmn_status status = session_open(&s, r, scene, look, &(draw_options){.desc = desc, .maps = true}, &said, error);
    if (status == LMN_OK)
        status = drawing_refuse(&s, scene, look, desc, &said, error);
    if (status == LMN_OK && x >= 0 && y >= 0 && x < desc->width && y < desc->height)
        status = draw_pixel(&s, x, y, out, error);
    session_close(&s);
    warnings_release(&said);
    return status;
}

lmn_status renderer_pick(lmn_renderer *r, const lmn_scene *scene, const lmn_look *look, const lmn_draw_desc *desc,
                         int x, int y, lmn_pick *out, lmn_error *error)
{
    lmn_status status = gpu_enter(r->g, error);
    if (status != LMN_OK)
        return status;
    return gpu_leave(r->g, pick_pixel(r, scene, look, desc, x, y, out, error), error);
}
