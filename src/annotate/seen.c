#include "annotate/seen.h"

#include <math.h>

#include "base/memory.h"
#include "base/work.h"

enum { LONG_SIDE = 1000, CORNERS_MOST = 4 };

/* A corner in eye space: right, up, away. */
typedef struct corner {
    double at[3];
} corner;

/* A part on its way to the map. */
typedef struct tracer {
    seen_map             *map;
    const annotated_view *view;
    double                scale[2]; /* of the projection, to pixels */
    double                nearest;  /* away from the eye, nothing is seen before it */
    int32_t               part;
    bool                  cut; /* something of the part may be cut away */
} tracer;

/* A triangle on the page. */
typedef struct face {
    double x[3], y[3], depth[3], area;
    corner corners[3];
} face;

/* Is a place of the face, by shares of its corners on the page, cut away? */
static bool is_cut_away(const tracer *t, const face *f, const double shares[3])
{
    const cut    *c = &t->view->plan->section.cut;
    const double *m = t->view->camera->view.m;
    bool          flat = t->view->camera->orthographic;
    double        eye[3] = {0, 0, 0}, sum = 0, world[3];
    for (int i = 0; i < 3; i++) {
        double share = flat ? shares[i] : shares[i] / f->corners[i].at[2];
        sum += share;
        for (int k = 0; k < 3; k++)
            eye[k] += share * f->corners[i].at[k];
    }
    for (int k = 0; k < 3; k++)
        world[k] = m[4 * k] * (eye[0] / sum - m[12]) + m[4 * k + 1] * (eye[1] / sum - m[13]) +
                   m[4 * k + 2] * (-eye[2] / sum - m[14]);
    for (int i = 0; i < c->cell_count; i++) {
        bool inside = true;
        for (int k = 0; k < c->cells[i].count && inside; k++) {
            const cut_face  *side = &c->cells[i].faces[k];
            const cut_plane *p = &c->planes[side->plane];
            double off = p->normal[0] * world[0] + p->normal[1] * world[1] + p->normal[2] * world[2] - p->offset;
            inside = side->positive ? off > 0 : off < 0;
        }
        if (inside)
            return true;
    }
    return false;
}

static void fill_row(const tracer *t, const face *f, int y, int left, int right)
{
    seen_map *map = t->map;
    for (int x = left; x <= right; x++) {
        double at[2] = {x + 0.5, y + 0.5}, shares[3];
        bool   inside = true;
        for (int i = 0; i < 3; i++) {
            int a = (i + 1) % 3, b = (i + 2) % 3;
            shares[i] = ((f->x[a] - at[0]) * (f->y[b] - at[1]) - (f->x[b] - at[0]) * (f->y[a] - at[1])) / f->area;
            inside = inside && shares[i] >= 0;
        }
        size_t pixel = (size_t)y * (size_t)map->width + (size_t)x;
        float  depth = (float)(shares[0] * f->depth[0] + shares[1] * f->depth[1] + shares[2] * f->depth[2]);
        if (!inside || depth <= map->depths[pixel] || (t->cut && is_cut_away(t, f, shares)))
            continue;
        map->depths[pixel] = depth;
        map->parts[pixel] = t->part;
    }
}

static void fill(const tracer *t, const corner *a, const corner *b, const corner *c)
{
    const seen_map *map = t->map;
    const bool      flat = t->view->camera->orthographic;
    face            f = {.corners = {*a, *b, *c}};
    double          low[2] = {INFINITY, INFINITY}, high[2] = {-INFINITY, -INFINITY};
    for (int i = 0; i < 3; i++) {
        const double *at = f.corners[i].at, away = flat ? 1 : at[2];
        f.x[i] = map->width / 2.0 + t->scale[0] * at[0] / away;
        f.y[i] = map->height / 2.0 - t->scale[1] * at[1] / away;
        f.depth[i] = flat ? -at[2] : 1 / at[2];
        low[0] = fmin(low[0], f.x[i]);
        low[1] = fmin(low[1], f.y[i]);
        high[0] = fmax(high[0], f.x[i]);
        high[1] = fmax(high[1], f.y[i]);
    }
    f.area = (f.x[1] - f.x[0]) * (f.y[2] - f.y[0]) - (f.x[2] - f.x[0]) * (f.y[1] - f.y[0]);
    if (f.area == 0 || !isfinite(f.area) || high[0] < 0 || high[1] < 0 || low[0] > map->width || low[1] > map->height)
        return;
    int left = (int)fmax(ceil(low[0] - 0.5), 0), right = (int)fmin(floor(high[0] - 0.5), map->width - 1);
    int top = (int)fmax(ceil(low[1] - 0.5), 0), bottom = (int)fmin(floor(high[1] - 0.5), map->height - 1);
    for (int y = top; y <= bottom; y++)
        fill_row(t, &f, y, left, right);
}

/* What lies before the nearest plane is cut off. */
static void clip_and_fill(const tracer *t, const corner corners[3])
{
    corner kept[CORNERS_MOST];
    int    count = 0;
    for (int i = 0; i < 3; i++) {
        const corner *a = &corners[i], *b = &corners[(i + 1) % 3];
        double        from = a->at[2] - t->nearest, to = b->at[2] - t->nearest;
        if (from >= 0)
            kept[count++] = *a;
        if ((from >= 0) == (to >= 0))
            continue;
        for (int k = 0; k < 3; k++)
            kept[count].at[k] = a->at[k] + from / (from - to) * (b->at[k] - a->at[k]);
        count++;
    }
    for (int i = 2; i < count; i++)
        fill(t, &kept[0], &kept[i - 1], &kept[i]);
}

static corner corner_of(const mat4 *m, vec3 p)
{
    corner c;
    for (int k = 0; k < 3; k++)
        c.at[k] = m->m[k] * (double)p.x + m->m[4 + k] * (double)p.y + m->m[8 + k] * (double)p.z + m->m[12 + k];
    c.at[2] = -c.at[2];
    return c;
}

static bool trace_primitive(const tracer *t, size_t part, const primitive *p)
{
    const pose      *posed = t->view->plan->pose;
    const part_pose *own = &posed->parts[part];
    const node      *n = &posed->scene->nodes[posed->scene->parts[part].node];
    const vec3      *positions = p->positions;
    vec3            *moved = NULL;
    if (pose_deforms(own, p)) {
        moved = mem_alloc((size_t)p->vertex_count * sizeof *moved);
        if (!moved)
            return false;
        pose_vertices(own, p, NULL, NULL, p->vertex_count, moved, NULL);
        positions = moved;
    }
    for (size_t k = 0; k < node_draw_count(n); k++) {
        mat4 world = pose_instance(posed, part, k), m = mat4_multiply(&t->view->camera->view, &world);
        for (uint32_t i = 0; i + 2 < p->index_count; i += 3) {
            const corner corners[3] = {corner_of(&m, positions[p->indices[i]]),
                                       corner_of(&m, positions[p->indices[i + 1]]),
                                       corner_of(&m, positions[p->indices[i + 2]])};
            clip_and_fill(t, corners);
        }
    }
    mem_free(moved);
    return !work_stopped();
}

static bool trace_part(tracer *t, size_t part)
{
    const plan *p = t->view->plan;
    const node *n = &p->scene->nodes[p->scene->parts[part].node];
    t->part = (int32_t)part;
    t->cut = p->section.cut.cell_count > 0 && !(p->section.spared && p->section.spared[part]) &&
             cut_judge_box(&p->section.cut, p->pose->part_boxes[part]) != CUT_WHOLE;
    for (size_t k = 0; n->mesh != NONE && k < p->scene->meshes[n->mesh].primitive_count; k++)
        if (!trace_primitive(t, part, &p->scene->meshes[n->mesh].primitives[k]))
            return false;
    return true;
}

lmn_status seen_make(seen_map *out, const annotated_view *view, lmn_error *error)
{
    const view_camera *c = view->camera;
    const plan        *p = view->plan;
    double             long_side = fmax(view->box[2], view->box[3]);
    out->width = (int)fmax(ceil(LONG_SIDE * view->box[2] / long_side), 1);
    out->height = (int)fmax(ceil(LONG_SIDE * view->box[3] / long_side), 1);
    size_t pixels = (size_t)out->width * (size_t)out->height;
    out->parts = mem_alloc(pixels * sizeof *out->parts);
    out->depths = mem_alloc(pixels * sizeof *out->depths);
    if (!out->parts || !out->depths)
        return error_memory(error);
    for (size_t i = 0; i < pixels; i++) {
        out->parts[i] = NONE;
        out->depths[i] = -INFINITY;
    }
    tracer t = {.map = out,
                .view = view,
                .scale = {c->projection.m[0] / 2 * out->width, c->projection.m[5] / 2 * out->height},
                .nearest = c->orthographic ? -INFINITY : fmax(c->near, 1e-6)};
    for (size_t i = 0; i < p->part_count && i < p->pose->part_count; i++)
        if (p->selected[i] && !box3_is_empty(p->pose->part_boxes[i]) && !trace_part(&t, i))
            return error_memory(error);
    return LMN_OK;
}

void seen_release(seen_map *m)
{
    mem_free(m->parts);
    mem_free(m->depths);
    *m = (seen_map){.parts = NULL};
}
