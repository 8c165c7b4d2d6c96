#include "plan/ground.h"

#include <math.h>

#include "light/light.h"

/* Rays that rise or fall by less than this see the plane edge on: 1 degree. */
static const double EDGE_ON = 0.0175;

static bool is_seen_from_above(const view_camera *c, int up, double level, double size)
{
    double forward = -c->view.m[4 * up + 2];
    return c->orthographic ? forward < -EDGE_ON : c->eye[up] - level > EDGE_ON * size;
}

/* Of the vertices, which boxes of turned parts would lie below. */
static double lowest_of(const fit_body *body, int up)
{
    fit_view  view = {.slope = {0, 0}};
    fit_reach reach[2];
    box3_middle(body->box, view.middle);
    view.right[0] = 1;
    view.up[up] = 1;
    view.forward[3 - up] = up == 1 ? -1 : 1;
    fit_measure(reach, body, &view);
    return view.middle[up] - reach[1].minus[0];
}

ground_plane ground_find(const plan *p, const view_camera *camera)
{
    const scene_values *v = p->look->wide[KIND_SCENE].values;
    ground_plane        out = {.up = p->scene->up == 'z' ? 2 : 1, .box = p->fit.box};
    if (v->ground == GROUND_NONE || p->has_cut || box3_is_empty(p->fit.box))
        return out;
    out.size = box3_diagonal(p->fit.box);
    out.level = lowest_of(&p->fit, out.up);
    out.reach = (double)v->ground_reach * out.size;
    out.there = isfinite(out.level) && out.size > 0 && is_seen_from_above(camera, out.up, out.level, out.size);
    return out;
}
