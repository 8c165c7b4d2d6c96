/* Revolved sections (ISO 128-3): the shape of a cut at right angles to a view, turned in its place into the plane of
 * the sheet, with a narrow outline. */
#include <math.h>
#include <string.h>

#include "base/memory.h"
#include "base/vector3.h"
#include "light/light.h"
#include "stroke/hatch.h"
#include "vector/vector_job.h"

/* The outline of cut faces: edges that only one of them has. */
typedef struct outline {
    uint32_t (*ends)[2]; /* vertices of the mesh */
    bool  *used;
    size_t count, capacity;
} outline;

static bool is_cap(const edge_mesh *m, uint32_t face)
{
    return face != EDGE_NO_FACE && m->materials && m->materials[face] <= -2;
}

static bool take_outline(outline *out, const edge_mesh *m)
{
    out->count = 0;
    for (uint32_t i = 0; i < m->edge_count && m->cap_count; i++) {
        const mesh_edge *e = &m->edges[i];
        if (is_cap(m, e->face[0]) == is_cap(m, e->face[1]))
            continue;
        if (!mem_grow((void **)&out->ends, &out->capacity, out->count + 1, sizeof *out->ends))
            return false;
        memcpy(out->ends[out->count++], e->vertex, sizeof e->vertex);
    }
    mem_free(out->used);
    out->used = mem_calloc(out->count + 1, sizeof *out->used);
    return out->used != NULL;
}

/* Where it is drawn: across is how far from the middle it lies away from the eye. */
typedef struct turned {
    const draft_extra *extra;
    double             middle[3], at[2], scale; /* the middle of the shape, and where that is on the sheet */
} turned;

static void place(const turned *t, const double p[3], float out[2])
{
    double d[3];
    vector3_add(d, p, -1, t->middle);
    out[0] = (float)(t->at[0] - t->scale * vector3_dot(d, t->extra->axes[2]));
    out[1] = (float)(t->at[1] - t->scale * vector3_dot(d, t->extra->axes[1]));
}

static void world_of(const stroke_item *item, const edge_mesh *m, uint32_t vertex, double out[3])
{
    vec3 p = mat4_transform_point(&item->world, m->positions[vertex]);
    vector3_set(out, (double)p.x, (double)p.y, (double)p.z);
}

/* One chain of the outline after the other; `points` has room for all edges and one more. */
static void put_outline(const turned *t, const draft_view *v, outline *o, const stroke_item *item, const edge_mesh *m,
                        float (*points)[2])
{
    for (size_t i = 0; i < o->count; i++) {
        if (o->used[i])
            continue;
        size_t   count = 0;
        uint32_t at = o->ends[i][1], first = o->ends[i][0];
        double   p[3];
        o->used[i] = true;
        for (int k = 0; k < 2; k++) {
            world_of(item, m, o->ends[i][k], p);
            place(t, p, points[count++]);
        }
        for (bool goes = true; goes && at != first;) {
            goes = false;
            for (size_t n = i + 1; n < o->count && !goes; n++) {
                if (o->used[n] || (o->ends[n][0] != at && o->ends[n][1] != at))
                    continue;
                at = o->ends[n][0] == at ? o->ends[n][1] : o->ends[n][0];
                o->used[n] = goes = true;
                world_of(item, m, at, p);
                place(t, p, points[count++]);
            }
        }
        sheet_add_item(v->page, SHEET_PATH, v->group, v->ink, 0);
        sheet_add_path(
            v->page,
            &(sheet_path){.closed = at == first, .curved = true, .width = (float)v->narrow, .cap = SHEET_CAP_ROUND},
            (const float(*)[2])points, count - (at == first));
    }
}

static lmn_status put_outlines(const turned *t, const draft_view *v, const stroke_scene *scene, lmn_error *error)
{
    outline    o = {.ends = NULL};
    lmn_status status = LMN_OK;
    for (size_t i = 0; i < scene->item_count && status == LMN_OK; i++) {
        const edge_mesh *m = &scene->meshes[scene->items[i].mesh];
        if (!take_outline(&o, m)) {
            status = error_memory(error);
            break;
        }
        float(*points)[2] = mem_alloc((o.count + 2) * sizeof *points);
        if (points)
            put_outline(t, v, &o, &scene->items[i], m, points);
        else
            status = error_memory(error);
        mem_free(points);
    }
    mem_free(o.ends);
    mem_free(o.used);
    return status;
}

/* The middle of the shape. False: nothing is cut there. */
static bool find_middle(const stroke_scene *scene, double out[3])
{
    box3 box = box3_empty();
    for (size_t i = 0; i < scene->item_count; i++) {
        const edge_mesh *m = &scene->meshes[scene->items[i].mesh];
        for (uint32_t k = 0; k < m->edge_count && m->cap_count; k++)
            for (int n = 0; n < 2 && is_cap(m, m->edges[k].face[0]) != is_cap(m, m->edges[k].face[1]); n++) {
                vec3 p = mat4_transform_point(&scene->items[i].world, m->positions[m->edges[k].vertex[n]]);
                box = box3_union(box, (box3){p, p});
            }
    }
    if (box3_is_empty(box))
        return false;
    box3_middle(box, out);
    return true;
}

/* Looks at the shape from the right, as large as the view is, and hatches it where it is drawn. */
static lmn_status hatch(vector_job *j, const turned *t, const vector_view *v, uint32_t group, const stroke_scene *scene,
                        lmn_error *error)
{
    scene_values values = *(const scene_values *)j->look->wide[KIND_SCENE].values;
    vector_ink   ink = {
          &j->out->page, j->scene, group, {t->at[0] - v->box[2] / 2, t->at[1] - v->box[3] / 2}, j->lines_only};
    stroke_camera camera = {.view = mat4_identity(),
                            .projection = v->camera.projection,
                            .near = v->camera.near,
                            .orthographic = true,
                            .width = v->width,
                            .height = v->height};
    const double  back[3] = {-t->extra->axes[2][0], -t->extra->axes[2][1], -t->extra->axes[2][2]};
    const double *rows[3] = {back, t->extra->axes[1], t->extra->axes[0]};
    for (int k = 0; k < 3; k++) {
        for (int n = 0; n < 3; n++)
            camera.view.m[4 * n + k] = rows[k][n];
        camera.view.m[12 + k] = -vector3_dot(rows[k], t->middle) - (k == 2 ? 2 * scene->extent : 0);
    }
    values.cut_width = (float)(vector_narrow(j) * VECTOR_PIXELS_PER_MM);
    values.cut_angle -= (float)hatch_turn(draft_section_axis(t->extra));
    stroke_view *view = NULL;
    lmn_status   status = stroke_view_create(&view, scene, &camera, NULL, NULL, error);
    colour      *colours = mem_alloc((j->scene->part_count + 1) * sizeof *colours);
    for (size_t i = 0; colours && i < j->scene->part_count; i++)
        colours[i] = vector_frame_ink(j->out->page.ground);
    if (status == LMN_OK && !colours)
        status = error_memory(error);
    if (status == LMN_OK)
        status = vector_put_hatch(&ink, view, &values, j->stroked, colours,
                                  j->wanted->loose_hatch || j->wanted->plotter, &j->out->hatches, NULL, error);
    mem_free(colours);
    stroke_view_destroy(&view);
    return status;
}

static lmn_status put_one(vector_job *j, const draft_extra *e, const vector_view *v, uint32_t group, lmn_error *error)
{
    section      own = {.spared = NULL};
    stroke_scene scene = {0};
    turned       t = {.extra = e};
    memset(&own.cut, 0, sizeof own.cut);
    lmn_status           status = vector_section(&own, j, e, error);
    const stroke_section cut = {&own.cut, own.spared};
    if (status == LMN_OK)
        status =
            stroke_scene_create_cut(&scene, &j->pose, j->stroked, j->plan.crease_angle, 0, &cut, NULL, NULL, error);
    if (status == LMN_OK && find_middle(&scene, t.middle)) {
        uint32_t   all = sheet_add_group(&j->out->page, (int32_t)group, "revolved section", "revolved", 0);
        draft_view d = vector_drafting_view(j, v, all);
        t.scale = draft_scale(&d);
        draft_project(&d, t.middle, t.at);
        status = hatch(j, &t, v, all, &scene, error);
        if (status == LMN_OK)
            status = put_outlines(&t, &d, &scene, error);
    } else if (status == LMN_OK) {
        warnings_add(&j->out->warnings, WARNING_PAGE, "nothing is cut where a revolved section is");
    }
    stroke_scene_release(&scene);
    section_release(&own);
    return status;
}

lmn_status vector_put_revolved(vector_job *j, const vector_view *v, uint32_t group, lmn_error *error)
{
    lmn_status status = LMN_OK;
    for (size_t i = 0; i < j->out->extras.count && status == LMN_OK; i++) {
        const draft_extra *e = &j->out->extras.items[i];
        if (e->kind == DRAFT_REVOLVED && e->view == v->direction)
            status = put_one(j, e, v, group, error);
    }
    return status;
}
