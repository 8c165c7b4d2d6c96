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

void pick_unproject(const lmn_drawing *d, const double pixel[2], double depth, double point[3])
{
    const view_camera *c = &d->camera;
    double             by = half_height(c) * (c->orthographic ? 1 : depth);
    const double eye[3] = {(2 * pixel[0] / d->width - 1) * by * c->aspect, (1 - 2 * pixel[1] / d->height) * by, -depth};
    to_scene(c, eye, 1, point);
}

lmn_pick pick_at(const lmn_drawing *d, int x, int y)
{
    lmn_pick     out = {0};
    size_t       i = (size_t)(d->height - 1 - y) * (size_t)d->width + (size_t)x;
    const float *n = &d->maps.normal[3 * i];
    out.part = d->maps.id[i];
    if (!out.part)
        return out;
    out.depth = (double)d->maps.depth[i];
    pick_unproject(d, (const double[]){x + 0.5, y + 0.5}, out.depth, out.position);
    to_scene(&d->camera, (const double[]){(double)n[0], (double)n[1], (double)n[2]}, 0, out.normal);
    return out;
}
