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

/* Around the figure and what stands on it. */
static box3 box_of(const figure *fig)
{
    box3        box = fig->box;
    const float by = (float)figure_marks_stand(fig);
    if (by > 0 && !box3_is_empty(box)) {
        box.min = (vec3){box.min.x - by, box.min.y - by, box.min.z - by};
        box.max = (vec3){box.max.x + by, box.max.y + by, box.max.z + by};
    }
    return box;
}

bool figure_open(frame *f, figure_state *s, const figure *fig)
{
    *s = (figure_state){.figure = fig, .near = f->camera.near, .far = f->camera.far};
    double     nearest = INFINITY, farthest = -INFINITY;
    const box3 own = box_of(fig);
    box3       box = fig->complement ? f->plan->box : own;
    camera_depth_range(&f->camera, box, &nearest, &farthest);
    double margin = fmax((farthest - nearest) * 1e-3, farthest * 1e-6);
    s->near = fmax(nearest - margin, f->camera.near);
    s->far = fmin(farthest + margin, f->camera.far);
    if (!(s->far > s->near))
        s->far = s->near + 1;
    camera_pixels(&f->camera, own, f->width, f->height, figure_reach(fig), s->pixels);
    if (f->maps && f->maps->part)
        keep_box(f->maps, s);
    else if (!f->maps) /* maps are read back whole */
        camera_pixels(&f->camera, own, f->width, f->height, 2 * figure_reach(fig) + 2, s->around);
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

/* Where a triangle's edge from a to b is inside of the rows between low and high: what it adds to a range of columns.
 */
static void widen_columns(double range[2], const double a[2], const double b[2], double low, double high)
{
    for (int end = 0; end < 2; end++) {
        const double *p = end ? b : a, row = end ? high : low;
        if (p[1] >= low && p[1] <= high) {
            range[0] = fmin(range[0], p[0]);
            range[1] = fmax(range[1], p[0]);
        }
        if ((a[1] < row) != (b[1] < row)) {
            const double x = a[0] + (row - a[1]) / (b[1] - a[1]) * (b[0] - a[0]);
            range[0] = fmin(range[0], x);
            range[1] = fmax(range[1], x);
        }
    }
}

/* The tiles that a triangle on the page, and its lines, can reach: row after row of tiles. */
static void mark_triangle(tile_grid *t, double corners[3][2], int reach)
{
    double lowest = INFINITY, highest = -INFINITY, left = INFINITY, right = -INFINITY;
    for (int k = 0; k < 3; k++) {
        lowest = fmin(lowest, corners[k][1] - reach);
        highest = fmax(highest, corners[k][1] + reach);
        left = fmin(left, corners[k][0] - reach);
        right = fmax(right, corners[k][0] + reach);
    }
    /* Of a small one its box is as good. */
    if (highest - lowest <= t->size && right - left <= t->size && left > t->band[0] && lowest > t->band[1] &&
        right < t->band[0] + t->band[2] && highest < t->band[1] + t->band[3]) {
        tiles_mark(t, (int[]){(int)left, (int)lowest, (int)right + 2 - (int)left, (int)highest + 2 - (int)lowest},
                   true);
        return;
    }
    const int first = (int)fmin(fmax((lowest - t->band[1]) / t->size, 0), t->rows),
              end = (int)fmin(fmax((highest - t->band[1]) / t->size + 1, 0), t->rows);
    for (int row = first; row < end; row++) {
        const double low = t->band[1] + row * t->size, high = low + t->size;
        double       range[2] = {INFINITY, -INFINITY};
        for (int k = 0; k < 3; k++)
            widen_columns(range, corners[k], corners[(k + 1) % 3], low - reach, high + reach);
        if (range[1] >= range[0]) {
            const double from = fmax(floor(range[0]) - reach, t->band[0] - 1.0),
                         to = fmin(ceil(range[1]) + reach + 1, t->band[0] + t->band[2] + 1.0);
            if (to > from)
                tiles_mark(t, (int[]){(int)from, t->band[1] + row * t->size, (int)(to - from), t->size}, true);
        }
    }
}

/* The same of each triangle of a mesh that is long and thin, as an arrow is. False: it has lines, lies behind the eye,
 * or there is no memory. */
static bool mark_triangles(const frame *f, tile_grid *t, const primitive *from, const part_pose *posed,
                           const mat4 *world, int reach)
{
    mat4  seen = mat4_multiply(&f->camera.view, world), clip = mat4_multiply(&f->camera.projection, &seen);
    vec3 *at = from->line_count ? NULL : mem_alloc((from->vertex_count + 1) * sizeof *at);
    double(*pixels)[2] = at ? mem_alloc((from->vertex_count + 1) * sizeof *pixels) : NULL;
    bool good = pixels != NULL;
    if (good)
        pose_vertices(posed, from, NULL, NULL, from->vertex_count, at, NULL);
    for (uint32_t i = 0; i < from->vertex_count && good; i++) {
        const double *m = clip.m, p[3] = {(double)at[i].x, (double)at[i].y, (double)at[i].z};
        const double  w = m[3] * p[0] + m[7] * p[1] + m[11] * p[2] + m[15];
        good = w > 0;
        for (int k = 0; k < 2 && good; k++)
            pixels[i][k] = ((m[k] * p[0] + m[4 + k] * p[1] + m[8 + k] * p[2] + m[12 + k]) / w * 0.5 + 0.5) *
                           (k ? f->height : f->width);
    }
    for (uint32_t i = 0; i + 2 < from->index_count && good; i += 3) {
        double corners[3][2];
        for (uint32_t k = 0; k < 3; k++)
            memcpy(corners[k], pixels[from->indices[i + k]], sizeof corners[k]);
        mark_triangle(t, corners, reach);
    }
    mem_free(pixels);
    mem_free(at);
    return good;
}

static void mark_part(const frame *f, tile_grid *t, size_t part, int reach)
{
    enum { TILES_FEW = 48, TRIANGLES_A_TILE = 2 }; /* of more, all tiles have some */
    const pose *now = f->up->pose;
    const node *n = &f->plan->scene->nodes[f->plan->scene->parts[part].node];
    const mesh *m = n->mesh == NONE ? NULL : &f->plan->scene->meshes[n->mesh];
    if (m && m->primitive_count == 1 && node_draw_count(n) == 1 && n->solid == NONE &&
        !pose_part_deforms(&now->parts[part])) {
        const int  tiles = mark_box(f, t, now->part_boxes[part], reach, false);
        const mat4 world = pose_instance(now, part, 0);
        if (tiles > TILES_FEW && m->primitives[0].index_count <= 3 * TRIANGLES_A_TILE * (uint32_t)tiles &&
            mark_triangles(f, t, &m->primitives[0], &now->parts[part], &world, reach))
            return;
    }
    mark_box(f, t, now->part_boxes[part], reach, true);
}

/* The tiles that what is small on the page can reach, by a ball around it: towns have hundreds of thousands of such
 * parts. False: it is not small, or near the eye. `clip`: projection · view. */
static bool mark_small(const frame *f, tile_grid *t, const mat4 *clip, box3 box, int reach)
{
    const view_camera *c = &f->camera;
    const double      *m = clip->m, *p = c->projection.m, radius = box3_diagonal(box) / 2;
    double             middle[3], at[4];
    box3_middle(box, middle);
    for (int k = 0; k < 4; k++)
        at[k] = m[k] * middle[0] + m[4 + k] * middle[1] + m[8 + k] * middle[2] + m[12 + k];
    const double depth = c->orthographic ? 1 : at[3] - radius; /* its nearest */
    if (!(depth > radius || c->orthographic))
        return false;
    /* Away from the middle of a perspective balls are drawn out, by as much as this at most. */
    const double across = at[0] / (at[3] * p[0]), up = at[1] / (at[3] * p[5]);
    const double drawn_out = c->orthographic ? 1 : 1 + across * across + up * up;
    const double size = fmax(p[0] * f->width, p[5] * f->height) / 2 * radius * drawn_out / depth;
    if (!(size < t->size))
        return false;
    const int sides[2] = {f->width, f->height}, around = (int)ceil(size) + reach + 1;
    int       pixels[4];
    for (int k = 0; k < 2; k++) {
        const double pixel = (at[k] / at[3] * 0.5 + 0.5) * sides[k];
        pixels[k] = (int)fmin(fmax(pixel, -1e6), 1e6) - around;
        pixels[2 + k] = 2 * around + 1;
    }
    tiles_mark(t, pixels, true);
    return true;
}

static bool all_full(const tile_grid *t)
{
    bool full = true;
    for (int y = 0; y < t->rows; y++)
        for (int x = 0; x < t->columns; x++)
            full = full && t->full[y][x];
    return full;
}

/* False: all tiles have something. */
static bool mark_parts(const frame *f, tile_grid *t, const figure *fig, int reach)
{
    enum { LOOK_EVERY = 4096 };
    const plan *p = f->plan;
    const mat4  clip = mat4_multiply(&f->camera.projection, &f->camera.view);
    for (size_t i = 0; i < p->part_count; i++) {
        if (i % LOOK_EVERY == LOOK_EVERY - 1 && all_full(t))
            return false;
        if (fig->designated[i] && !mark_small(f, t, &clip, f->up->pose->part_boxes[i], reach))
            mark_part(f, t, i, reach);
    }
    return true;
}

/* Passes over a figure of things that lie apart are drawn where these are. */
void figure_find_boxes(frame *f, figure_state *s)
{
    if (f->maps || figure_marks_stand(s->figure) > 0)
        return;
    tile_grid *t = mem_alloc(sizeof *t);
    s->boxes = mem_alloc(TILE_BOXES_MAX * sizeof *s->boxes);
    if (t && s->boxes) {
        tiles_start(t, s->pixels);
        tiles_clear(t);
        if (mark_parts(f, t, s->figure, figure_reach(s->figure))) {
            s->box_count = tiles_boxes(t, 0, s->pixels, s->boxes);
        } else {
            mem_free(s->boxes);
            s->boxes = NULL;
        }
    } else {
        gpu_fail(f->g, LMN_MEMORY, "out of memory");
    }
    mem_free(t);
}
