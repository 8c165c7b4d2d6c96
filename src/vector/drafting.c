/* Sheets as draughtsmen make them: centre lines, widths of lines, sections and details with their marks. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "base/memory.h"
#include "base/vector3.h"
#include "contact/surface.h"
#include "draft/marks.h"
#include "light/light.h"
#include "plan/refuse.h"
#include "vector/vector_job.h"

static const double usual_narrow = 0.25; /* mm, beside lines whose widths are the look's */

double vector_wide(const vector_job *j)
{
    return j->wanted->line_group > 0 ? j->wanted->line_group : 2 * usual_narrow;
}

double vector_narrow(const vector_job *j)
{
    return vector_wide(j) / 2;
}

/* Reference letters are ten times as high as wide lines are wide (ISO 3098), and no smaller than can be read. */
static double letter_height(const vector_job *j)
{
    return fmin(fmax(10 * vector_wide(j), 3.5), 7);
}

draft_view vector_drafting_view(const vector_job *j, const vector_view *v, uint32_t group)
{
    colour     ground = j->out->page.ground;
    draft_view d = {.page = &j->out->page,
                    .group = group,
                    .camera = &v->camera,
                    .ink = vector_frame_ink(ground),
                    .narrow = vector_narrow(j),
                    .wide = vector_wide(j)};
    memcpy(d.box, v->box, sizeof d.box);
    return d;
}

/* --- sections ------------------------------------------------------------------------------------------- */

void vector_cut_text(const vector_job *j, const draft_extra *extra, char *out, size_t size)
{
    const char *own = ((const scene_values *)j->look->wide[KIND_SCENE].values)->cut.text;
    snprintf(out, size, "%s%s%s", own, own[0] ? ";" : "", extra->cut);
}

lmn_status vector_section(section *out, const vector_job *j, const draft_extra *extra, lmn_error *error)
{
    const scene_values *v = j->look->wide[KIND_SCENE].values;
    char                text[VECTOR_CUT_TEXT_SIZE];
    lmn_status          status = section_find(out, &j->pose, j->look, j->desc->select, error);
    if (status != LMN_OK)
        return status;
    vector_cut_text(j, extra, text, sizeof text);
    status = cut_parse(&out->cut, text, j->plan.fit.box, error);
    bool spares = status == LMN_OK && v->cut_keep.text[0] && !out->spared;
    return spares ? section_spare(out, j->scene, v->cut_keep.text, error) : status;
}

static const edge_cap *cap_of(const edge_mesh *m, uint32_t face)
{
    if (face == EDGE_NO_FACE || !m->materials || m->materials[face] > -2)
        return NULL;
    uint32_t cap = (uint32_t)(-2 - m->materials[face]);
    return cap < m->cap_count ? &m->caps[cap] : NULL;
}

/* Does an edge lie in a plane in which the section turns? */
static bool lies_in_turn(const edge_mesh *m, const mat4 *world, const mesh_edge *e, const draft_extra *extra,
                         double near)
{
    const int axis = fabs(extra->axes[0][0]) > 0.5 ? 0 : fabs(extra->axes[0][1]) > 0.5 ? 1 : 2;
    for (size_t i = 0; i + 1 < extra->depth_count + extra->half; i++) {
        bool lies = true;
        for (int k = 0; k < 2; k++) {
            vec3 p = mat4_transform_point(world, m->positions[e->vertex[k]]);
            lies = lies && fabs((double)*(&p.x + axis) - extra->turns[i]) < near;
        }
        if (lies)
            return true;
    }
    return false;
}

void vector_hide_turns(stroke_scene *scene, const draft_extra *extra)
{
    for (size_t i = 0; i < scene->item_count; i++) {
        edge_mesh *m = &scene->meshes[scene->items[i].mesh];
        for (uint32_t k = 0; k < m->edge_count && m->cap_count; k++) {
            mesh_edge      *e = &m->edges[k];
            const edge_cap *caps[2] = {cap_of(m, e->face[0]), cap_of(m, e->face[1])};
            bool            turns = false, edge_on[2];
            for (int side = 0; side < 2; side++) {
                edge_on[side] = caps[side] && fabs(vector3_dot(caps[side]->normal, extra->axes[2])) < 0.01;
                turns = turns || edge_on[side];
            }
            /* Where a cut face and what it cuts have other corners, each has a border. */
            bool border = e->face[0] == EDGE_NO_FACE || e->face[1] == EDGE_NO_FACE;
            if (!turns && !((caps[0] || caps[1] || border) && lies_in_turn(m, &scene->items[i].world, e, extra,
                                                                           1e-6 * fmax(scene->reach, scene->extent))))
                continue;
            e->flags = EDGE_QUIET;
            /* Nor an outline: whether what is seen edge-on faces the eye, is a matter of rounding. */
            if (edge_on[0] && e->face[1] != EDGE_NO_FACE)
                e->face[0] = e->face[1];
            if (edge_on[1] || e->face[1] == EDGE_NO_FACE)
                e->face[1] = e->face[0];
        }
    }
}

/* Is a face seen exactly from the side? Then it is a matter of rounding whether it looks to the eye. */
static bool is_edge_on(const edge_mesh *m, const mat4 *world, uint32_t face, const double eye[3])
{
    const vec3 n = m->normals[face];
    double     out[3];
    for (int row = 0; row < 3; row++)
        out[row] = world->m[row] * (double)n.x + world->m[4 + row] * (double)n.y + world->m[8 + row] * (double)n.z;
    return fabs(vector3_dot(out, eye)) < 1e-4 * vector3_length(out);
}

void vector_settle_rims(stroke_scene *scene, const draft_extra *extra)
{
    for (size_t i = 0; i < scene->item_count; i++) {
        edge_mesh *m = &scene->meshes[scene->items[i].mesh];
        for (uint32_t k = 0; k < m->edge_count && m->cap_count; k++) {
            mesh_edge *e = &m->edges[k];
            for (int side = 0; side < 2; side++) {
                const uint32_t  wall = e->face[1 - side];
                const edge_cap *cap = cap_of(m, e->face[side]);
                if (!cap || cap_of(m, wall) || fabs(vector3_dot(cap->normal, extra->axes[2])) < 0.99)
                    continue;
                if (wall == EDGE_NO_FACE) { /* what is cut has more corners here, and a border of its own */
                    e->flags = EDGE_QUIET;
                    e->face[1 - side] = e->face[side];
                    break;
                }
                if (!is_edge_on(m, &scene->items[i].world, wall, extra->axes[2]))
                    continue;
                if (side) { /* the face that passes it forwards stands first */
                    const uint32_t first = e->vertex[0];
                    e->vertex[0] = e->vertex[1];
                    e->vertex[1] = first;
                }
                e->face[0] = e->face[side];
                e->face[1] = EDGE_NO_FACE;
                e->flags = EDGE_BORDER;
                break;
            }
        }
    }
}

static void nearest_face(const stroke_scene *scene, size_t item, const double at[3], double *least, double out[3])
{
    const edge_mesh *m = &scene->meshes[scene->items[item].mesh];
    const mat4      *world = &scene->items[item].world;
    for (uint32_t i = 0; i < m->face_count; i++) {
        double        corners[3][3], sides[2][3], normal[3], there[3], unused[3];
        const double *lent[3] = {corners[0], corners[1], corners[2]};
        for (int k = 0; k < 3; k++) {
            vec3 p = mat4_transform_point(world, m->positions[m->faces[i][k]]);
            vector3_set(corners[k], (double)p.x, (double)p.y, (double)p.z);
        }
        surface_nearest_on_triangle(at, lent, there, unused);
        double away = vector3_distance(at, there);
        if (!(away < *least))
            continue;
        for (int k = 0; k < 2; k++)
            vector3_add(sides[k], corners[k + 1], -1, corners[0]);
        vector3_cross(normal, sides[0], sides[1]);
        if (!vector3_normalise(normal))
            continue;
        /* Faces of solids are turned so that they look outwards. */
        vec3   own = m->normals[i];
        double known[3] = {0, 0, 0};
        for (int row = 0; row < 3; row++)
            known[row] =
                world->m[row] * (double)own.x + world->m[4 + row] * (double)own.y + world->m[8 + row] * (double)own.z;
        double sign = vector3_dot(known, normal) < 0 ? -1 : 1;
        *least = away;
        for (int k = 0; k < 3; k++)
            out[k] = sign * normal[k];
    }
}

lmn_status vector_face_normal(const vector_job *j, const double at[3], double out[3], lmn_error *error)
{
    stroke_scene scene = {0};
    double       least = INFINITY;
    lmn_status   status = stroke_scene_create(&scene, &j->pose, j->stroked, j->plan.crease_angle, NULL, NULL, error);
    for (size_t i = 0; i < scene.item_count && status == LMN_OK; i++)
        nearest_face(&scene, i, at, &least, out);
    stroke_scene_release(&scene);
    if (status == LMN_OK && !(least < INFINITY))
        return error_set(error, LMN_USAGE, "there is no face that an auxiliary view could look at");
    return status;
}

/* --- centre lines --------------------------------------------------------------------------------------- */

lmn_status vector_find_axes(vector_job *j, lmn_error *error)
{
    if (!j->wanted->centre_lines && !j->threaded)
        return LMN_OK;
    stroke_scene whole = {0};
    lmn_status   status = LMN_OK;
    if (j->section.cut.cell_count)
        status = stroke_scene_create(&whole, &j->pose, j->stroked, j->plan.crease_angle, NULL, NULL, error);
    const stroke_scene *uncut = j->section.cut.cell_count ? &whole : &j->strokes;
    if (status == LMN_OK)
        status = draft_cylinders_find(&j->cylinders, uncut, error);
    if (status == LMN_OK && j->threaded)
        status = vector_find_threads(j, uncut, error);
    stroke_scene_release(&whole);
    return status == LMN_OK && j->wanted->centre_lines ? draft_pitches_find(&j->pitches, &j->cylinders, error) : status;
}

enum { AROUND = 12, ALONG = 3, SAMPLES = AROUND * ALONG };

/* Places on the surface of a cylinder or cone, from one end to the other. */
static void sample(const draft_cylinder *c, double (*out)[3])
{
    cylinder_fit f = {.radius = c->radius};
    vector3_copy(f.axis, c->axis);
    cylinder_frame(&f);
    for (int i = 0; i < SAMPLES; i++) {
        double angle = 2 * 3.14159265358979323846 * (i % AROUND) / AROUND, share = 0.02 + 0.48 * (i / AROUND);
        vector3_mix(out[i], c->ends[0], c->ends[1], share);
        double radius = c->radii[0] + share * (c->radii[1] - c->radii[0]);
        vector3_add(out[i], out[i], radius * cos(angle), f.across[0]);
        vector3_add(out[i], out[i], radius * sin(angle), f.across[1]);
    }
}

bool vector_is_cut_away(const cut *c, const double p[3])
{
    for (int32_t i = 0; i < c->cell_count; i++) {
        bool inside = true;
        for (int32_t k = 0; k < c->cells[i].count && inside; k++) {
            const cut_face *f = &c->cells[i].faces[k];
            double          side = vector3_dot(c->planes[f->plane].normal, p) - c->planes[f->plane].offset;
            inside = f->positive ? side > -c->snap : side < c->snap; /* on its border, too */
        }
        if (inside)
            return true;
    }
    return false;
}

/* Is some of it there, and seen, or drawn although it is hidden? `cut`: NULL: the part is whole. */
static bool is_shown(const draft_cylinder *c, const stroke_view *view, const cut *cut, bool hidden)
{
    double   places[SAMPLES][3];
    uint32_t before[SAMPLES];
    bool     any = false;
    sample(c, places);
    if (!hidden)
        stroke_view_count(view, (const double(*)[3])places, SAMPLES, before);
    for (int i = 0; i < SAMPLES && !any; i++)
        any = !(cut && vector_is_cut_away(cut, places[i])) && (hidden || before[i] == 0);
    return any;
}

bool vector_draws_hidden(const vector_job *j, uint32_t part)
{
    stroke_options options;
    stroke_style   style;
    const rule    *r = part > 0 && part <= j->scene->part_count ? plan_rule(&j->plan, part - 1) : NULL;
    return r && vector_rule_strokes(r, &options, &style) && style.hidden != HIDDEN_NONE;
}

/* The first view on which it can be told where a section is; NULL: there is none. */
static const vector_view *origin_of(const vector_job *j, const draft_extra *e)
{
    for (size_t i = 0; i < j->out->view_count; i++) {
        const vector_view *v = &j->out->views[i];
        draft_view         d = vector_drafting_view(j, v, 0);
        if (!v->apart && v->extra != e && v->direction != LMN_VIEW_ISO && draft_shows_plane(&d, e))
            return v;
    }
    return NULL;
}

enum { TRACE_MOST = DRAFT_EXTRAS_MOST * 2 * DRAFT_DEPTHS_MOST };

/* The traces of cutting planes on a view; `out` has room for all. */
static size_t traces_on(const vector_job *j, const vector_view *v, double (*out)[2][2])
{
    draft_view d = vector_drafting_view(j, v, 0);
    double     points[2 * DRAFT_DEPTHS_MOST][2];
    size_t     count = 0;
    for (size_t i = 0; i < j->out->view_count; i++) {
        const draft_extra *e = j->out->views[i].extra;
        if (!e || e->kind != DRAFT_SECTION || origin_of(j, e) != v)
            continue;
        size_t most = draft_trace(&d, e, j->plan.fit.box, letter_height(j), points);
        for (size_t k = 1; k < most && count < TRACE_MOST; k++, count++)
            memcpy(out[count], points[k - 1], sizeof out[count]);
    }
    return count;
}

lmn_status vector_put_centres(vector_job *j, const vector_view *v, const stroke_view *view, const cut *cut,
                              uint32_t group, lmn_error *error)
{
    size_t count = j->cylinders.count;
    if (!count || !v->camera.orthographic || !j->wanted->centre_lines)
        return LMN_OK;
    bool *shown = mem_calloc(count, sizeof *shown);
    if (!shown)
        return error_memory(error);
    for (size_t i = 0; i < count; i++) {
        const draft_cylinder *c = &j->cylinders.items[i];
        bool                  whole = j->spared && c->part > 0 && j->spared[c->part - 1];
        shown[i] = is_shown(c, view, whole ? NULL : cut, !j->cut_open && vector_draws_hidden(j, c->part));
    }
    draft_view d =
        vector_drafting_view(j, v, sheet_add_group(&j->out->page, (int32_t)group, "centre lines", "centre", 0));
    double         traces[TRACE_MOST][2][2];
    draft_segments before = {(const double(*)[2][2])traces, traces_on(j, v, traces)};
    lmn_status     status = draft_centres(&d, &j->cylinders, &j->pitches, shown, before, &j->out->centres, error);
    mem_free(shown);
    return status;
}

/* --- marks of views ------------------------------------------------------------------------------------- */

/* How far what is drawn in a view reaches up, mm from the top of the sheet. */
static double top_of(const vector_view *v, double gap)
{
    return v->box[1] + gap / 2;
}

static void put_title(const vector_job *j, const vector_view *v, double letter)
{
    const draft_extra *e = v->extra;
    char               words[64], scale[32];
    draft_view d = vector_drafting_view(j, v, sheet_add_group(&j->out->page, -1, "view titles", "view-title", 0));
    if (e->kind == DRAFT_SECTION)
        snprintf(words, sizeof words, "%c\xE2\x80\x93%c", e->letter, e->letter);
    else if (e->kind == DRAFT_AUXILIARY)
        snprintf(words, sizeof words, "%c", e->letter);
    else {
        vector_print_scale(scale, v->scale);
        snprintf(words, sizeof words, "%c (%s)", e->letter, scale);
    }
    if (e->kind == DRAFT_DETAIL)
        draft_detail_rim(&d, e);
    double    model = 0, size[2];
    lmn_error ignored = {0};
    if (vector_measure_view(j, v, size, &ignored) == LMN_OK)
        model = size[1] * j->unit_mm * (v->scale > 0 ? v->scale : j->out->scale);
    draft_title(&d, words, top_of(v, v->box[3] - model), letter);
}

/* On the first view on which it can be told. */
static void put_origin(vector_job *j, const draft_extra *e, double letter)
{
    for (size_t i = 0; i < j->out->view_count; i++) {
        const vector_view *v = &j->out->views[i];
        if (v->apart || v->extra == e || (e->kind == DRAFT_DETAIL && (v->direction != e->view)))
            continue;
        draft_view d = vector_drafting_view(j, v, 0);
        if (v->direction == LMN_VIEW_ISO || (e->kind == DRAFT_SECTION && !draft_shows_plane(&d, e)))
            continue;
        d.group = sheet_add_group(&j->out->page, -1, "marks of views", "view-mark", 0);
        if (e->kind == DRAFT_SECTION)
            draft_cutting_plane(&d, e, j->plan.fit.box, letter);
        else if (e->kind == DRAFT_DETAIL)
            draft_detail_circle(&d, e, letter);
        else if (!draft_view_arrow(&d, e, j->plan.fit.box, letter))
            continue;
        return;
    }
    if (e->kind != DRAFT_SECTION || !e->half)
        warnings_add(&j->out->warnings, WARNING_PAGE, "none of the views shows where %c is; another one would",
                     e->letter);
}

void vector_put_marks_of_views(vector_job *j)
{
    double letter = letter_height(j);
    for (size_t i = 0; i < j->out->extras.count; i++) {
        const draft_extra *e = &j->out->extras.items[i];
        bool               there = e->kind != DRAFT_REVOLVED;
        for (size_t k = 0; k < j->out->view_count; k++)
            there = there || (!j->out->views[k].extra && j->out->views[k].direction == e->view);
        if (!there)
            warnings_add(&j->out->warnings, WARNING_PAGE,
                         "a revolved section lies in a view that is not on the sheet; it is left out");
    }
    for (size_t i = 0; i < j->out->view_count; i++)
        if (j->out->views[i].extra) {
            put_origin(j, j->out->views[i].extra, letter);
            put_title(j, &j->out->views[i], letter);
        }
}
