#include "plan/movers.h"

#include <math.h>
#include <string.h>

#include "base/memory.h"
#include "motion/motion.h"

/* Objects of one rule; what is more shares the last one's figure. */
enum { MOVERS_MAX = 2048 };

int movers_steps(const lmn_look *look)
{
    int most = 0;
    for (size_t i = 0; i < look->rule_count; i++) {
        const technique_use *use = rule_use(&look->rules[i], KIND_MOTION);
        int steps = use && use->technique->motion->steps ? use->technique->motion->steps(use->values) : 0;
        most = steps > most ? steps : most;
    }
    return most;
}

/* --- what moves ----------------------------------------------------------------------------------------- */

/* Where a point is on the page, pixels; false when it is behind the viewer. */
static bool page_position(const movers_view *v, const view_camera *c, vec3 p, double out[2])
{
    mat4          full = mat4_multiply(&c->projection, &c->view);
    const double *m = full.m;
    double        w = m[3] * (double)p.x + m[7] * (double)p.y + m[11] * (double)p.z + m[15];
    for (int k = 0; k < 2; k++)
        out[k] = (m[k] * (double)p.x + m[4 + k] * (double)p.y + m[8 + k] * (double)p.z + m[12 + k]) / w / 2 *
                 (k ? v->height : v->width);
    return w > 0;
}

static vec3 corner_of(box3 b, int which)
{
    return (vec3){which & 1 ? b.max.x : b.min.x, which & 2 ? b.max.y : b.min.y, which & 4 ? b.max.z : b.min.z};
}

/* Does any corner of the box come farther than is at rest when `now` becomes `then`? */
static bool box_moves(const movers_view *v, const view_camera *past, box3 box, const mat4 *now, const mat4 *then)
{
    for (int i = 0; i < 8; i++) {
        vec3   a = mat4_transform_point(now, corner_of(box, i)), b = mat4_transform_point(then, corner_of(box, i));
        double here[2], there[2];
        if (!page_position(v, v->now, a, here) || !page_position(v, past, b, there))
            return memcmp(now, then, sizeof *now) != 0 || memcmp(&v->now->view, &past->view, sizeof past->view) != 0;
        if (hypot(here[0] - there[0], here[1] - there[1]) > v->least)
            return true;
    }
    return false;
}

/* In the part's own axes; of solids and what has no mesh the box in the world at rest stands for it. */
static box3 own_box(const lmn_scene *s, size_t part_index)
{
    const node *n = &s->nodes[s->parts[part_index].node];
    box3        box = box3_empty();
    for (size_t i = 0; n->mesh != NONE && i < s->meshes[n->mesh].primitive_count; i++)
        box = box3_union(box, s->meshes[n->mesh].primitives[i].bounds);
    return box;
}

static bool weights_differ(const part_pose *a, const part_pose *b)
{
    return a->weight_count && memcmp(a->weights, b->weights, a->weight_count * sizeof *a->weights) != 0;
}

/* A solid's box is known in the world alone: it is taken back to where the node was by what moved it. */
static bool solid_moves(const movers_view *v, const view_camera *past, const pose *now, const pose *then, size_t part)
{
    int32_t node_index = now->scene->parts[part].node;
    mat4    back = mat4_inverse(&now->worlds[node_index]), moved = mat4_multiply(&then->worlds[node_index], &back),
         still = mat4_identity();
    return box_moves(v, past, now->part_boxes[part], &still, &moved);
}

static bool part_moves_since(const movers_view *v, int step, const pose *now, size_t part)
{
    const pose        *then = now->past[step];
    const view_camera *past = &v->past[step];
    const node        *n = &now->scene->nodes[now->scene->parts[part].node];
    if (part >= now->part_count || n->mesh == NONE)
        return solid_moves(v, past, now, then, part);
    const part_pose *a = &now->parts[part], *b = &then->parts[part];
    box3             box = own_box(now->scene, part);
    if (weights_differ(a, b))
        return true;
    for (size_t i = 0; i < a->joint_count; i++)
        if (box_moves(v, past, box, &a->joints[i], &b->joints[i]))
            return true;
    for (size_t i = 0; !a->joints && i < node_draw_count(n); i++) {
        mat4 here = pose_instance(now, part, i), there = pose_instance(then, part, i);
        if (box_moves(v, past, box, &here, &there))
            return true;
    }
    return false;
}

static bool part_moves(const movers_view *v, const pose *now, size_t part)
{
    bool moves = false;
    for (int k = 0; k < now->past_count && !moves; k++)
        moves = part_moves_since(v, k, now, part);
    return moves;
}

/* --- which object --------------------------------------------------------------------------------------- */

/* The uppermost node above a part, or above its skeleton, that is elsewhere than it was; NONE: the camera moves. */
static int32_t object_of(const pose *now, size_t part)
{
    const lmn_scene *s = now->scene;
    const node      *n = &s->nodes[s->parts[part].node];
    int32_t          found = NONE;
    bool             skinned = n->mesh != NONE && n->skin != NONE && s->skins[n->skin].joint_count > 0;
    for (int32_t i = skinned ? s->skins[n->skin].joints[0] : s->parts[part].node; i != NONE; i = s->nodes[i].parent)
        for (int k = 0; k < now->past_count; k++)
            if (memcmp(&now->worlds[i], &now->past[k]->worlds[i], sizeof *now->worlds) != 0)
                found = i;
    return found;
}

/* --- figures -------------------------------------------------------------------------------------------- */

static bool draws_movers(const figure *f)
{
    const technique_use *use = rule_use(f->rule, KIND_MOTION);
    return use && use->technique->motion->steps;
}

/* A figure like another one, without parts; it is the plan's last. NULL when memory is gone. */
static figure *add_mover(plan *p, size_t like)
{
    figure *grown = mem_realloc(p->figures, (p->figure_count + 1) * sizeof *grown);
    if (!grown)
        return NULL;
    p->figures = grown;
    figure *f = &p->figures[p->figure_count], *from = &p->figures[like];
    *f = *from;
    f->designated = mem_calloc(p->part_count, sizeof *f->designated);
    f->focus = from->focus ? mem_copy(from->focus, p->part_count * sizeof *f->focus) : NULL;
    f->part_count = 0;
    f->box = box3_empty();
    f->mover = true;
    p->figure_count++;
    return f->designated && (f->focus || !from->focus) ? f : NULL;
}

static void move_part(plan *p, size_t from, size_t to, size_t part)
{
    p->figures[from].designated[part] = false;
    p->figures[from].part_count--;
    p->figures[to].designated[part] = true;
    p->figures[to].part_count++;
    p->figures[to].box = box3_union(p->figures[to].box, p->pose->part_boxes[part]);
}

static lmn_status split_figure(plan *p, size_t index, const movers_view *view, warnings *warnings, lmn_error *error)
{
    int32_t objects[MOVERS_MAX];
    size_t  first = p->figure_count, count = 0, shared = 0;
    for (size_t part = 0; part < p->part_count; part++) {
        if (!p->figures[index].designated[part] || !part_moves(view, p->pose, part))
            continue;
        int32_t object = object_of(p->pose, part);
        size_t  k = 0;
        while (k < count && k < MOVERS_MAX - 1 && objects[k] != object)
            k++;
        if (k == count) {
            objects[count++] = object;
            if (!add_mover(p, index))
                return error_memory(error);
        }
        shared += objects[k] != object;
        move_part(p, index, first + k, part);
    }
    if (shared)
        warnings_add(warnings, WARNING_REDUCED,
                     "motion: more than %d objects of a rule move; %zu parts are drawn as one object", MOVERS_MAX,
                     shared);
    p->figures[index].box = box3_empty();
    for (size_t part = 0; part < p->part_count; part++)
        if (p->figures[index].designated[part])
            p->figures[index].box = box3_union(p->figures[index].box, p->pose->part_boxes[part]);
    return LMN_OK;
}

static void drop_empty(plan *p)
{
    size_t kept = 0;
    for (size_t i = 0; i < p->figure_count; i++) {
        if (p->figures[i].part_count) {
            p->figures[kept++] = p->figures[i];
            continue;
        }
        mem_free(p->figures[i].designated);
        mem_free(p->figures[i].focus);
    }
    p->figure_count = kept;
}

lmn_status plan_split_movers(plan *p, const movers_view *view, warnings *warnings, lmn_error *error)
{
    size_t count = p->figure_count;
    if (!p->pose->past_count)
        return LMN_OK;
    for (size_t i = 0; i < count; i++) {
        lmn_status status = draws_movers(&p->figures[i]) ? split_figure(p, i, view, warnings, error) : LMN_OK;
        if (status != LMN_OK)
            return status;
    }
    if (p->figure_count == count)
        return LMN_OK;
    drop_empty(p);
    plan_settle(p, false);
    return LMN_OK;
}
