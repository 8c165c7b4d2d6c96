/* A figure on the page: its range of depth and the pixels that it and its lines can reach. */
#include "frame/frame_private.h"

#include <math.h>
#include <string.h>

#include "base/memory.h"

/* The sum of the lengths that matter with these values. */
static float lengths_of(const param *params, size_t count, const void *values)
{
    float sum = 0;
    for (size_t i = 0; i < count; i++) {
        const param *p = &params[i];
        bool         widens = p->unit == UNIT_PT && p->type == PARAM_FLOAT && !p->along && !param_is_auto(p, values);
        if (widens && params_condition(p->only_if, params, count, values))
            sum += fabsf(*(const float *)param_field(p, values)) * (p->reach > 0 ? p->reach : 1);
    }
    return sum;
}

int figure_reach(const figure *fig)
{
    const rule *r = fig->rule;
    float       widest = 0;
    for (size_t i = 0; i < r->use_counts[KIND_LINES]; i++) {
        const technique_use *use = &r->uses[KIND_LINES][i];
        widest += lengths_of(kinds[KIND_LINES]->common, kinds[KIND_LINES]->common_count, use->values);
        widest += lengths_of(use->technique->params, use->technique->param_count, use->values);
    }
    const technique_use *compose = rule_use(r, KIND_COMPOSE);
    if (compose && fig->layered)
        widest += lengths_of(compose->technique->params, compose->technique->param_count, compose->values);
    const technique_use *perturb = rule_use(r, KIND_PERTURB);
    if (perturb)
        widest += perturb->technique->perturbs->reach(perturb->values);
    return (int)ceilf(widest) + 2;
}

/* Leaves the part of its pixels that is in the box which maps are of; empty where there is none. */
static void keep_box(const frame_maps *m, figure_state *s)
{
    const int box[4] = {m->x, m->y, m->width, m->height};
    for (int k = 0; k < 2; k++) {
        int low = s->pixels[k] > box[k] ? s->pixels[k] : box[k];
        int high = s->pixels[k] + s->pixels[2 + k], end = box[k] + box[2 + k];
        s->pixels[k] = low;
        s->pixels[2 + k] = (high < end ? high : end) - low;
        s->around[k] = box[k];
        s->around[2 + k] = box[2 + k];
    }
}

bool figure_open(frame *f, figure_state *s, const figure *fig)
{
    *s = (figure_state){.figure = fig, .near = f->camera.near, .far = f->camera.far};
    double nearest = INFINITY, farthest = -INFINITY;
    box3   box = fig->complement ? f->plan->box : fig->box;
    camera_depth_range(&f->camera, box, &nearest, &farthest);
    double margin = fmax((farthest - nearest) * 1e-3, farthest * 1e-6);
    s->near = fmax(nearest - margin, f->camera.near);
    s->far = fmin(farthest + margin, f->camera.far);
    if (!(s->far > s->near))
        s->far = s->near + 1;
    camera_pixels(&f->camera, fig->box, f->width, f->height, figure_reach(fig), s->pixels);
    if (f->maps && f->maps->part)
        keep_box(f->maps, s);
    else if (!f->maps) /* maps are read back whole */
        camera_pixels(&f->camera, fig->box, f->width, f->height, 2 * figure_reach(fig) + 2, s->around);
    memcpy(s->drawn[0], s->pixels, sizeof s->drawn[0]);
    memcpy(s->drawn[1], s->around, sizeof s->drawn[1]);
    if (!f->maps)
        window_figure(f, s);
    return s->pixels[2] > 0 && s->pixels[3] > 0 && !gpu_failed(f->g);
}

/* --- where passes are drawn --------------------------------------------------------------------------------------- */

/* The tiles that what lies in a box of the world, and its lines, can reach. Returns how many. */
static int mark_box(const frame *f, tile_grid *t, box3 in_world, int reach, bool full)
{
    int pixels[4];
    camera_pixels(&f->camera, in_world, f->width, f->height, reach, pixels);
    return tiles_mark(t, pixels, full);
}

/* The same of each triangle of a mesh that is long and thin, as an arrow is. False: it has lines, or no memory. */
static bool mark_triangles(const frame *f, tile_grid *t, const primitive *from, const part_pose *posed,
                           const mat4 *world, int reach)
{
    vec3 *at = from->line_count ? NULL : mem_alloc((from->vertex_count + 1) * sizeof *at);
    if (!at)
        return false;
    pose_vertices(posed, from, NULL, NULL, from->vertex_count, at, NULL);
    for (uint32_t i = 0; i < from->vertex_count; i++)
        at[i] = mat4_transform_point(world, at[i]);
    for (uint32_t i = 0; i + 2 < from->index_count; i += 3) {
        box3 box = box3_empty();
        for (uint32_t k = i; k < i + 3; k++)
            box = box3_with_point(box, at[from->indices[k]]);
        mark_box(f, t, box, reach, true);
    }
    mem_free(at);
    return true;
}

static void mark_part(const frame *f, tile_grid *t, size_t part, int reach)
{
    enum { TILES_FEW = 48, TRIANGLES_FEW = 2048 };
    const pose *now = f->up->pose;
    const node *n = &f->plan->scene->nodes[f->plan->scene->parts[part].node];
    const mesh *m = n->mesh == NONE ? NULL : &f->plan->scene->meshes[n->mesh];
    if (m && m->primitive_count == 1 && node_draw_count(n) == 1 && n->solid == NONE &&
        m->primitives[0].index_count <= 3 * TRIANGLES_FEW && !now->parts[part].primitive_count &&
        mark_box(f, t, now->part_boxes[part], reach, false) > TILES_FEW) {
        const mat4 world = pose_instance(now, part, 0);
        if (mark_triangles(f, t, &m->primitives[0], &now->parts[part], &world, reach))
            return;
    }
    mark_box(f, t, now->part_boxes[part], reach, true);
}

/* Passes over a figure of a few things that lie apart are drawn where these are. */
void figure_find_boxes(frame *f, figure_state *s)
{
    enum { PARTS_MOST = 4096 }; /* of more, some are everywhere */
    const plan *p = f->plan;
    if (f->maps || s->figure->part_count > PARTS_MOST)
        return;
    tile_grid *t = mem_alloc(sizeof *t);
    s->boxes = mem_alloc(TILE_BOXES_MAX * sizeof *s->boxes);
    if (t && s->boxes) {
        const int reach = figure_reach(s->figure);
        tiles_start(t, s->pixels);
        tiles_clear(t);
        for (size_t i = 0; i < p->part_count; i++)
            if (s->figure->designated[i])
                mark_part(f, t, i, reach);
        s->box_count = tiles_boxes(t, 0, s->pixels, s->boxes);
    } else {
        gpu_fail(f->g, LMN_MEMORY, "out of memory");
    }
    mem_free(t);
}
