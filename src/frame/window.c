/* Windows: a part of the page that is drawn as the whole page has it. All coordinates stay the page's, and so do
 * camera, strokes, paper and grain; only the boxes in which pixels are drawn get smaller. What lies in the window
 * depends on no pixel farther away than the margin, or the figure is drawn whole. */
#include <math.h>
#include <string.h>

#include "frame/frame_private.h"

void window_around(const frame *f, int margin, int out[4])
{
    const int limits[2] = {f->width, f->height};
    for (int k = 0; k < 2; k++) {
        bool whole = f->window[2] <= 0;
        int  low = whole ? 0 : f->window[k] - margin,
            high = whole ? limits[k] : f->window[k] + f->window[2 + k] + margin;
        low = low > 0 ? low : 0;
        high = high < limits[k] ? high : limits[k];
        out[k] = low;
        out[2 + k] = high - low;
    }
}

void window_clip(const frame *f, int margin, int box[4])
{
    int around[4];
    window_around(f, margin, around);
    for (int k = 0; k < 2 && f->window[2] > 0; k++) {
        int low = box[k] > around[k] ? box[k] : around[k], end = box[k] + box[2 + k], limit = around[k] + around[2 + k];
        box[k] = low;
        box[2 + k] = (end < limit ? end : limit) - low;
        box[2 + k] = box[2 + k] > 0 ? box[2 + k] : 0;
    }
}

/* Chains of lines run through the whole page; so do counts of what is covered, and what moves. */
static bool depends_on_page(const figure *fig)
{
    return fig->mover || rule_traces_lines(fig->rule) || (fig->hidden && rule_traces_lines(fig->hidden)) ||
           (fig->layered && (fig->layering.fraction > 0 || fig->focus || figure_has_marks(fig)));
}

static int margin_of(const figure *fig)
{
    return WINDOW_MARGIN + 2 * figure_reach(fig);
}

/* Edges of meshes are judged by how much of each is seen, however far it runs. */
static bool looks_along_edges(const figure *fig)
{
    const rule *r = fig->rule;
    for (size_t i = 0; i < r->use_counts[KIND_LINES]; i++) {
        const technique *t = r->uses[KIND_LINES][i].technique;
        for (size_t k = 0; k < t->pass_count; k++)
            if (t->passes[k].strokes || t->passes[k].records)
                return true;
    }
    return false;
}

static double squared_distance(const vec3 *a, const vec3 *b)
{
    double x = (double)a->x - (double)b->x, y = (double)a->y - (double)b->y, z = (double)a->z - (double)b->z;
    return x * x + y * y + z * z;
}

/* Of the mesh, in its own unit; lines that files bring are edges too. */
static double longest_edge(const mesh *m)
{
    double longest = 0;
    for (size_t i = 0; i < m->primitive_count; i++) {
        const primitive *p = &m->primitives[i];
        for (uint32_t k = 0; k + 2 < p->index_count; k += 3)
            for (int corner = 0; corner < 3; corner++)
                longest = fmax(longest, squared_distance(&p->positions[p->indices[k + (uint32_t)corner]],
                                                         &p->positions[p->indices[k + (uint32_t)(corner + 1) % 3]]));
        for (uint32_t k = 0; k < p->line_count; k++)
            longest = fmax(longest,
                           squared_distance(&p->positions[p->lines[2 * k]], &p->positions[p->lines[2 * k + 1]]));
    }
    return sqrt(longest);
}

/* How far edges of an item can run on the page, pixels; more than a page where that is not known. */
static double reach_of_edges(const frame *f, const draw_item *item)
{
    const pose      *now = f->up->pose;
    const part_pose *part = &now->parts[item->part_index];
    int32_t          m = f->plan->scene->nodes[f->plan->scene->parts[item->part_index].node].mesh;
    const double    *w = item->world.m, *p = f->camera.projection.m;
    double           nearest = INFINITY, farthest = -INFINITY, scale = 0, page = 4.0 * (f->width + f->height);
    if (m < 0 || part->joint_count || part->weight_count || part->bend || part->primitive_count)
        return page;
    for (int column = 0; column < 3; column++)
        for (int row = 0; row < 3; row++)
            scale += w[4 * column + row] * w[4 * column + row];
    camera_depth_range(&f->camera, now->part_boxes[item->part_index], &nearest, &farthest);
    double pixels = fmax(p[5] * f->height, p[0] * f->width) / 2;
    if (!f->camera.orthographic) /* beside the middle of the picture things are seen larger */
        pixels *= sqrt(1 + 1 / (p[0] * p[0]) + 1 / (p[5] * p[5])) / fmax(nearest, f->camera.near);
    return fmin(longest_edge(&f->plan->scene->meshes[m]) * sqrt(scale) * pixels, page);
}

/* The geometry that edges in the window are judged by: as far as those of parts run that have some there. */
static void widen_for_edges(const frame *f, figure_state *s)
{
    enum { BESIDE = 8 }; /* of a position on an edge, that is looked at */
    int whole[4], wide[4];
    memcpy(whole, s->drawn[0], sizeof whole);
    memcpy(s->drawn[0], s->pixels, sizeof s->drawn[0]);
    for (size_t i = 0; i < f->up->item_count; i++) {
        const draw_item *item = &f->up->items[i];
        if (item->is_solid || !s->figure->designated[item->part_index])
            continue;
        int reach = figure_reach(s->figure) + BESIDE, box[4], near[4];
        camera_pixels(&f->camera, f->up->pose->part_boxes[item->part_index], f->width, f->height, reach, box);
        memcpy(near, box, sizeof near);
        window_clip(f, margin_of(s->figure), near);
        if (near[2] <= 0 || near[3] <= 0)
            continue;
        window_clip(f, margin_of(s->figure) + BESIDE + (int)ceil(reach_of_edges(f, item)), box);
        camera_widen_pixels(s->drawn[0], box);
    }
    memcpy(wide, s->drawn[0], sizeof wide);
    for (int k = 0; k < 2; k++) { /* not beyond what a page draws */
        int low = wide[k] > whole[k] ? wide[k] : whole[k], end = wide[k] + wide[2 + k], limit = whole[k] + whole[2 + k];
        s->drawn[0][k] = low;
        s->drawn[0][2 + k] = (end < limit ? end : limit) - low;
    }
    memcpy(s->drawn[1], s->around, sizeof s->drawn[1]);
    camera_widen_pixels(s->drawn[1], s->drawn[0]);
}

void window_figure(const frame *f, figure_state *s)
{
    if (f->window[2] <= 0 || depends_on_page(s->figure))
        return;
    window_clip(f, margin_of(s->figure), s->pixels);
    window_clip(f, margin_of(s->figure) + figure_reach(s->figure) + 2, s->around);
    if (s->pixels[2] > 0 && s->pixels[3] > 0 && looks_along_edges(s->figure)) {
        widen_for_edges(f, s);
    } else {
        memcpy(s->drawn[0], s->pixels, sizeof s->drawn[0]);
        memcpy(s->drawn[1], s->around, sizeof s->drawn[1]);
    }
}

int window_margin(const frame *f)
{
    int most = WINDOW_MARGIN;
    for (size_t i = 0; i < f->plan->figure_count; i++) {
        int margin = margin_of(&f->plan->figures[i]);
        most = margin > most ? margin : most;
    }
    return most;
}
