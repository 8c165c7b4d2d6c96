#include "plan/ground.h"

#include <math.h>

#include "base/groups.h"
#include "light/light.h"

static bool is_seen_from_above(const view_camera *c, int up, double level, double size)
{
    double forward = -c->view.m[4 * up + 2];
    return c->orthographic ? forward < -GROUND_EDGE_ON : c->eye[up] - level > GROUND_EDGE_ON * size;
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

static double bottom_of(box3 box, int up)
{
    return (double)(up == 2 ? box.min.z : box.min.y);
}

/* The surfaces of one building, as importers of cities name them, are one thing: a roof stands on its walls. */
static bool are_one(const lmn_scene *scene, size_t a, size_t b)
{
    const node *x = &scene->nodes[scene->parts[a].node], *y = &scene->nodes[scene->parts[b].node];
    return x->parent == y->parent && node_is_surface(x) && node_is_surface(y);
}

enum { TOUCHING_MOST = 256 /* things of which it is looked whether they touch */ };
static const double SEEN = 0.42; /* of its reach a shadow where the ground is touched is dark enough to be seen */
static const double NEARLY = 0.003, MOST = 0.7; /* of the diagonal; of all things */

/* What touches is one thing: wheels and what they carry. */
static void join_touching(uint32_t *links, const box3 *boxes, uint32_t count, float near)
{
    for (uint32_t i = 0; i < count; i++)
        for (uint32_t k = i + 1; k < count; k++) {
            box3 wide = {{boxes[i].min.x - near, boxes[i].min.y - near, boxes[i].min.z - near},
                         {boxes[i].max.x + near, boxes[i].max.y + near, boxes[i].max.z + near}};
            if (box3_overlap(wide, boxes[k]))
                group_join(links, i, k);
        }
}

/* How many of the groups of things there are, as a fraction, have one that stands. */
static double share_of_groups(uint32_t *links, const bool *stands, uint32_t count)
{
    bool     found[TOUCHING_MOST] = {false};
    uint32_t groups = 0, level = 0;
    for (uint32_t i = 0; i < count; i++) {
        uint32_t root = group_root(links, i);
        groups += root == i;
        level += stands[i] && !found[root];
        found[root] = found[root] || stands[i];
    }
    return groups ? (double)level / groups : 1;
}

/* Does most of what is drawn stand on the plane? */
static bool stands_level(const plan *p, const fit_ground *g)
{
    const double near = NEARLY * box3_diagonal(p->fit.box);
    size_t       count = p->scene->part_count, things = 0, level = 0;
    box3         boxes[TOUCHING_MOST];
    uint32_t     links[TOUCHING_MOST];
    bool         stands[TOUCHING_MOST];
    for (size_t i = 0, end; i < count; i = end) {
        box3 box = box3_empty();
        for (end = i + 1; end < count && are_one(p->scene, i, end);)
            end++;
        for (size_t k = i; k < end; k++)
            if (p->selected[k])
                box = box3_union(box, p->pose->part_boxes[k]);
        if (box3_is_empty(box))
            continue;
        bool stand = bottom_of(box, g->up) <= g->level + near;
        if (things < TOUCHING_MOST) {
            boxes[things] = box;
            links[things] = (uint32_t)things;
            stands[things] = stand;
        }
        things++;
        level += stand;
    }
    if (things > TOUCHING_MOST)
        return (double)level >= MOST * (double)things;
    join_touching(links, boxes, (uint32_t)things, (float)near);
    return share_of_groups(links, stands, (uint32_t)things) >= MOST;
}

void ground_settle(plan *p)
{
    const scene_values *v = p->look->wide[KIND_SCENE].values;
    fit_ground         *g = &p->fit.ground;
    *g = (fit_ground){.up = p->scene->up == 'z' ? 2 : 1};
    if (v->ground == GROUND_NONE || v->cut.text[0] || box3_is_empty(p->fit.box) || !(box3_diagonal(p->fit.box) > 0))
        return;
    g->level = lowest_of(&p->fit, g->up);
    g->there = isfinite(g->level) && (v->ground != GROUND_CAST || stands_level(p, g));
    g->shadowed = g->there && v->ground == GROUND_CAST;
    if (g->there && v->ground == GROUND_CONTACT)
        g->spread = SEEN * (double)v->ground_reach * box3_diagonal(p->fit.box);
}

ground_plane ground_find(const plan *p, const view_camera *camera)
{
    const scene_values *v = p->look->wide[KIND_SCENE].values;
    const fit_ground   *g = &p->fit.ground;
    ground_plane        out = {.up = g->up, .level = g->level, .box = p->fit.box};
    if (!g->there)
        return out;
    out.size = box3_diagonal(p->fit.box);
    out.reach = (double)v->ground_reach * out.size;
    out.there = is_seen_from_above(camera, out.up, out.level, out.size);
    return out;
}
