/* From a scene, through a camera, onto a small stage before the page's viewer. With the camera's depth z, its focus f
 * and the panel's scale k, a place that it sees at x/z lies k·x/z across the panel and k·(1 − f/z) behind it: at the
 * focus as deep as it is broad. The viewer sees the stage through a perspective of his own, undone in the same way.
 * Both are projective maps, so that triangles stay triangles. */
#include <stdlib.h>
#include <string.h>

#include "base/error.h"
#include "base/memory.h"
#include "depict/inset.h"

/* A stage is at most so deep, in distances from the viewer, or in half heights of the panel where rays are parallel. */
static const double deepest = 0.35, deepest_parallel = 4;

/* --- the camera's own axes ------------------------------------------------------------------------------------------
 */

/* Right, up, and how deep. */
static void own_axes(const inset_stage *s, const vec3 *at, double out[3])
{
    const double *v = s->view.m, p[3] = {(double)at->x, (double)at->y, (double)at->z};
    for (int k = 0; k < 3; k++)
        out[k] = v[k] * p[0] + v[4 + k] * p[1] + v[8 + k] * p[2] + v[12 + k];
    out[2] = -out[2];
}

enum { PLANES = 6 };

/* How far inside a side of what is seen. */
static double inside(const inset_stage *s, int plane, const double p[3])
{
    const double reach = s->parallel ? 1 : p[2];
    switch (plane) {
    case 0: return p[2] - s->near;
    case 1: return s->slope[0] * reach - p[0];
    case 2: return s->slope[0] * reach + p[0];
    case 3: return s->slope[1] * reach - p[1];
    case 4: return s->slope[1] * reach + p[1];
    default: return s->far > 0 ? s->far - p[2] : 1;
    }
}

static bool is_inside(const inset_stage *s, const double p[3])
{
    for (int k = 0; k < PLANES; k++)
        if (inside(s, k, p) < 0)
            return false;
    return true;
}

/* Across and up in halves of the panel, and how far behind the focus in half heights of it. */
static void on_stage(const inset_stage *s, const double p[3], double out[3])
{
    const double reach = s->parallel ? 1 : p[2];
    out[0] = p[0] / (s->slope[0] * reach);
    out[1] = p[1] / (s->slope[1] * reach);
    out[2] = s->squeeze * (s->parallel ? p[2] - s->focus : 1 - s->focus / p[2]) / s->slope[1];
}

/* --- the stage
 * --------------------------------------------------------------------------------------------------------
 */

static int compare_depths(const void *a, const void *b)
{
    const float x = *(const float *)a, y = *(const float *)b;
    return (x > y) - (x < y);
}

/* Depths of all vertices that it sees; mem_free. */
static lmn_status seen_depths(float **out, size_t *count, const inset_stage *s, const depict_job *j, const pose *posed,
                              lmn_error *error)
{
    size_t capacity = 0;
    *out = NULL;
    *count = 0;
    for (size_t i = 0; i < j->scene->part_count; i++) {
        const int32_t mesh_index = j->scene->nodes[j->scene->parts[i].node].mesh;
        const mesh   *m = mesh_index == NONE ? NULL : &j->scene->meshes[mesh_index];
        const mat4    world = pose_instance(posed, i, 0);
        for (size_t k = 0; m && k < m->primitive_count; k++) {
            const primitive *from = &m->primitives[k];
            vec3            *positions = mem_alloc((from->vertex_count + 1) * sizeof *positions);
            if (!positions || !mem_grow((void **)out, &capacity, *count + from->vertex_count + 1, sizeof **out)) {
                mem_free(positions);
                return error_memory(error);
            }
            pose_vertices(&posed->parts[i], from, NULL, NULL, from->vertex_count, positions, NULL);
            for (uint32_t v = 0; v < from->vertex_count; v++) {
                double     p[3];
                const vec3 at = mat4_transform_point(&world, positions[v]);
                own_axes(s, &at, p);
                if (is_inside(s, p))
                    (*out)[(*count)++] = (float)p[2];
            }
            mem_free(positions);
        }
    }
    return LMN_OK;
}

/* The middle one of all depths is what it looks at. */
static lmn_status find_focus(inset_stage *s, const depict_job *j, const pose *posed, lmn_error *error)
{
    float     *depths;
    size_t     count;
    lmn_status status = seen_depths(&depths, &count, s, j, posed, error);
    s->focus = j->size;
    s->near = fmax(s->near, 1e-4 * j->size);
    if (status == LMN_OK && count > 0) {
        qsort(depths, count, sizeof *depths, compare_depths);
        s->focus = (double)depths[count / 2];
        s->near = fmax(s->near, s->focus / 20);
    }
    mem_free(depths);
    return status;
}

void inset_set_depth(inset_stage *s, const depict_job *j, double back)
{
    const double slope = j->camera.orthographic ? j->camera.half_height : tan(j->camera.fov_y / 2),
                 unit = s->panel.half[1] * slope, /* of the stage, in distances from the viewer */
        span = s->span[1] - s->span[0], most = j->camera.orthographic ? deepest_parallel : deepest / unit;
    const double squeeze = span > most ? most / span : 1;
    s->squeeze *= squeeze;
    s->span[0] *= squeeze;
    s->span[1] *= squeeze;
    s->depth = j->camera.orthographic ? back - s->span[1] * unit : back * (1 - s->span[1] * unit);
}

static void place(const inset_stage *s, const depict_job *j, const double at[3], double out[3])
{
    const double page[2] = {s->panel.middle[0] + at[0] * s->panel.half[0],
                            s->panel.middle[1] + at[1] * s->panel.half[1]};
    const double unit = s->panel.half[1] * (j->camera.orthographic ? j->camera.half_height : tan(j->camera.fov_y / 2));
    page_position(j, page, j->camera.orthographic ? s->depth + at[2] * unit : s->depth / (1 - at[2] * unit), out);
}

void inset_point(const inset_stage *s, const depict_job *j, double x, double y, double behind, double out[3])
{
    place(s, j, (const double[3]){x, y, behind < 0 ? -behind * s->span[0] : behind * s->span[1]}, out);
}

/* --- copies ---------------------------------------------------------------------------------------------------------
 */

enum { CORNERS_MOST = 12 };

typedef struct corner {
    double   at[3];
    uint32_t index; /* in the mesh that is copied; UINT32_MAX: it was cut */
} corner;

/* The same from both triangles of an edge, to the bit. */
static corner cut_between(const inset_stage *s, int plane, const corner *a, const corner *b)
{
    const bool    in_order = memcmp(a->at, b->at, sizeof a->at) < 0;
    const corner *first = in_order ? a : b, *second = in_order ? b : a;
    const double  from = inside(s, plane, first->at), to = inside(s, plane, second->at);
    corner        out = {.index = UINT32_MAX};
    vector3_mix(out.at, first->at, second->at, from / (from - to));
    return out;
}

static size_t cut_polygon(const inset_stage *s, int plane, const corner *in, size_t count, corner *out)
{
    size_t kept = 0;
    for (size_t i = 0; i < count; i++) {
        const corner *a = &in[i], *b = &in[(i + 1) % count];
        const double  at = inside(s, plane, a->at), next = inside(s, plane, b->at);
        if (at >= 0)
            out[kept++] = *a;
        if ((at >= 0) != (next >= 0))
            out[kept++] = cut_between(s, plane, a, b);
    }
    return kept;
}

typedef struct copier {
    glyph_mesh        *mesh;
    const inset_stage *stage;
    const depict_job  *job;
    double (*own)[3]; /* of all vertices, in the camera's axes */
    uint32_t *made;   /* their copies; UINT32_MAX: none yet */
    double   *depths; /* not NULL: nothing is made, but the nearest and the farthest depth of what is seen widened */
} copier;

static uint32_t copy_corner(const copier *c, const corner *of)
{
    double on[3], at[3];
    if (of->index != UINT32_MAX && c->made[of->index] != UINT32_MAX)
        return c->made[of->index];
    on_stage(c->stage, of->at, on);
    place(c->stage, c->job, on, at);
    const uint32_t added = glyph_vertex(c->mesh, at);
    if (of->index != UINT32_MAX)
        c->made[of->index] = added;
    return added;
}

static void copy_polygon(const copier *c, const uint32_t *indices, size_t corners)
{
    corner polygons[2][CORNERS_MOST];
    size_t count = corners;
    int    now = 0;
    for (size_t k = 0; k < corners; k++) {
        vector3_copy(polygons[0][k].at, c->own[indices[k]]);
        polygons[0][k].index = indices[k];
    }
    for (int plane = 0; plane < PLANES && count > 0; plane++, now = !now)
        count = cut_polygon(c->stage, plane, polygons[now], count, polygons[!now]);
    for (size_t k = 0; k < count && c->depths; k++) {
        c->depths[0] = fmin(c->depths[0], polygons[now][k].at[2]);
        c->depths[1] = fmax(c->depths[1], polygons[now][k].at[2]);
    }
    if (count < 2 || c->depths)
        return;
    const uint32_t first = copy_corner(c, &polygons[now][0]);
    uint32_t       last = copy_corner(c, &polygons[now][1]);
    if (corners == 2)
        glyph_line(c->mesh, first, last);
    for (size_t k = 2; k < count && corners > 2; k++) {
        const uint32_t next = copy_corner(c, &polygons[now][k]);
        glyph_triangle(c->mesh, first, last, next);
        last = next;
    }
}

/* False: out of memory. */
static bool walk(copier *c, const primitive *from, const vec3 *positions, const mat4 *world)
{
    c->own = mem_alloc((from->vertex_count + 1) * sizeof *c->own);
    c->made = mem_alloc((from->vertex_count + 1) * sizeof *c->made);
    const bool whole = c->own && c->made;
    for (uint32_t i = 0; i < from->vertex_count && whole; i++) {
        const vec3 at = mat4_transform_point(world, positions[i]);
        own_axes(c->stage, &at, c->own[i]);
        c->made[i] = UINT32_MAX;
    }
    for (size_t i = 0; i + 2 < from->index_count && whole; i += 3)
        copy_polygon(c, &from->indices[i], 3);
    for (size_t i = 0; i < from->line_count && from->index_count == 0 && whole; i++)
        copy_polygon(c, &from->lines[2 * i], 2);
    mem_free(c->own);
    mem_free(c->made);
    return whole;
}

void inset_copy(glyph_mesh *m, const inset_stage *s, const depict_job *j, const primitive *from, const vec3 *positions,
                const mat4 *world)
{
    copier c = {.mesh = m, .stage = s, .job = j};
    m->failed = m->failed || !walk(&c, from, positions, world);
}

/* --- opening --------------------------------------------------------------------------------------------------------
 */

/* How deep the stage has to be: for all that is seen, and the paper behind it. */
static lmn_status find_span(inset_stage *s, const depict_job *j, const pose *posed, lmn_error *error)
{
    double depths[2] = {INFINITY, -INFINITY}, at[3], p[3] = {0, 0, 0};
    copier c = {.stage = s, .job = j, .depths = depths};
    for (size_t i = 0; i < j->scene->part_count; i++) {
        const node *n = &j->scene->nodes[j->scene->parts[i].node];
        const mesh *m = n->mesh == NONE ? NULL : &j->scene->meshes[n->mesh];
        for (size_t k = 0; m && k < m->primitive_count; k++) {
            const primitive *from = &m->primitives[k];
            vec3            *positions = mem_alloc((from->vertex_count + 1) * sizeof *positions);
            bool             whole = positions != NULL;
            if (whole)
                pose_vertices(&posed->parts[i], from, NULL, NULL, from->vertex_count, positions, NULL);
            for (size_t d = 0; d < node_draw_count(n) && whole; d++) {
                const mat4 world = pose_instance(posed, i, d);
                whole = walk(&c, from, positions, &world);
            }
            mem_free(positions);
            if (!whole)
                return error_memory(error);
        }
    }
    s->squeeze = 1;
    for (int k = 0; k < 2; k++) {
        p[2] = k ? fmax(depths[1], s->focus) : fmin(depths[0], s->focus);
        on_stage(s, p, at);
        s->span[k] = at[2];
    }
    s->span[1] += 0.02 * (s->span[1] - s->span[0]) + 0.02;
    return LMN_OK;
}

lmn_status inset_open(inset_stage *out, const depict_job *j, const pose *p, int32_t camera_node,
                      const inset_panel *panel, lmn_error *error)
{
    const mat4   *world = &p->worlds[camera_node];
    const camera *c = &p->cameras[j->scene->nodes[camera_node].camera];
    const double  half =
        c->orthographic ? (c->half_height > 0 ? c->half_height : 1) : tan((c->fov_y > 0 ? c->fov_y : 0.8) / 2);
    double axes[3][3];
    *out = (inset_stage){.panel = *panel, .parallel = c->orthographic, .near = c->near, .far = c->far};
    out->slope[0] = half * panel->half[0] / panel->half[1];
    out->slope[1] = half;
    for (int k = 0; k < 3; k++) {
        vector3_copy(axes[k], &world->m[4 * k]);
        vector3_normalise(axes[k]);
    }
    out->view = mat4_identity();
    for (int k = 0; k < 3; k++) {
        for (int a = 0; a < 3; a++)
            out->view.m[4 * a + k] = axes[k][a];
        out->view.m[12 + k] = -vector3_dot(axes[k], &world->m[12]);
    }
    lmn_status status = find_focus(out, j, p, error);
    return status == LMN_OK ? find_span(out, j, p, error) : status;
}
