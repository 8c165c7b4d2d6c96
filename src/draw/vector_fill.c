/* Areas of parts: the union of their triangles on the page, in one colour each, the farthest part first. What is seen of a part that reaches both before and behind another one is not told
 * apart: parts lie over each other as wholes. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "construct/construct.h"
#include "draw/vector_private.h"

static const double smallest_area = 1e-6; /* of a triangle, square mm */

/* A part as it lies on the page. */
typedef struct filled_part {
    size_t part_index;
    double depth; /* of the middle of its box */
} filled_part;

typedef struct fill_job {
    const vector_ink   *ink;
    const vector_view  *view;
    const stroke_scene *strokes;
    mat4                both; /* projection · view */
    region             *triangles;
    size_t              count, capacity;
    point2             *corners;
    contour            *contours;
    size_t              corner_capacity, contour_capacity;
} fill_job;

static int compare_depths(const void *a, const void *b)
{
    const filled_part *one = a, *other = b;
    if (one->depth != other->depth)
        return one->depth > other->depth ? -1 : 1;
    return one->part_index < other->part_index ? -1 : one->part_index > other->part_index;
}

/* A place on the page, y up so that regions are as they should; false behind the eye. */
static bool project(const fill_job *j, const mat4 *world, vec3 place, point2 *out)
{
    double from[4] = {(double)place.x, (double)place.y, (double)place.z, 1}, at[4], clip[4];
    for (int k = 0; k < 4; k++)
        at[k] = world->m[k] * from[0] + world->m[4 + k] * from[1] + world->m[8 + k] * from[2] + world->m[12 + k];
    for (int k = 0; k < 4; k++)
        clip[k] = j->both.m[k] * at[0] + j->both.m[4 + k] * at[1] + j->both.m[8 + k] * at[2] + j->both.m[12 + k] * at[3];
    if (!(clip[3] > 1e-12))
        return false;
    out->x = j->ink->origin[0] + (clip[0] / clip[3] + 1) / 2 * j->view->box[2];
    out->y = -(j->ink->origin[1] + (1 - clip[1] / clip[3]) / 2 * j->view->box[3]);
    return isfinite(out->x) && isfinite(out->y);
}

/* Faces of closed pieces that look away lie below those that do not. */
static bool is_needed(const edge_mesh *m, uint32_t face, double area, bool mirrored)
{
    return !m->closed[m->pieces[face]] || (area > 0) != mirrored;
}

static bool add_triangles(fill_job *j, const stroke_item *item, size_t most)
{
    const edge_mesh *m = &j->strokes->meshes[item->mesh];
    double           normal_matrix[9];
    bool             mirrored = mat4_cofactors(&item->world, normal_matrix) < 0;
    for (uint32_t f = 0; f < m->face_count && j->count < most; f++) {
        point2 p[3];
        bool   there = true;
        for (int k = 0; k < 3; k++)
            there = there && project(j, &item->world, m->places[m->faces[f][k]], &p[k]);
        double area = there ? ((p[1].x - p[0].x) * (p[2].y - p[0].y) - (p[2].x - p[0].x) * (p[1].y - p[0].y)) / 2 : 0;
        if (!(fabs(area) > smallest_area) || !is_needed(m, f, area, mirrored))
            continue;
        if (!mem_grow((void **)&j->corners, &j->corner_capacity, 3 * (j->count + 1), sizeof *j->corners))
            return false;
        j->corners[3 * j->count] = p[0];
        j->corners[3 * j->count + 1] = area > 0 ? p[1] : p[2];
        j->corners[3 * j->count + 2] = area > 0 ? p[2] : p[1];
        j->count++;
    }
    return true;
}

/* The union of the triangles that were gathered. */
static lmn_status unite(fill_job *j, region *out, lmn_error *error)
{
    if (!mem_grow((void **)&j->contours, &j->contour_capacity, j->count, sizeof *j->contours) ||
        !mem_grow((void **)&j->triangles, &j->capacity, j->count, sizeof *j->triangles))
        return error_memory(error);
    for (size_t i = 0; i < j->count; i++) {
        j->contours[i] = (contour){&j->corners[3 * i], 3};
        j->triangles[i] = (region){&j->contours[i], 1};
    }
    return region_combine(out, j->triangles, j->count, REGION_UNION, error);
}

static lmn_status put_region(sheet *s, uint32_t group, colour ink, const region *r, lmn_error *error)
{
    float (*points)[2] = NULL;
    size_t capacity = 0;
    sheet_add_item(s, SHEET_PATH, group, ink, 0);
    for (size_t i = 0; i < r->count; i++) {
        const contour *c = &r->contours[i];
        if (!mem_grow((void **)&points, &capacity, c->count, sizeof *points)) {
            mem_free(points);
            return error_memory(error);
        }
        for (size_t k = 0; k < c->count; k++) {
            points[k][0] = (float)c->points[k].x;
            points[k][1] = (float)-c->points[k].y;
        }
        sheet_add_path(s, &(sheet_path){.closed = true, .filled = true}, (const float (*)[2])points, c->count);
    }
    mem_free(points);
    return LMN_OK;
}

static lmn_status fill_part(lmn_sheet *s, fill_job *j, size_t part_index, uint32_t group, const rule *r, lmn_error *error)
{
    const part *p = &j->ink->scene->parts[part_index];
    region      area = {0};
    j->count = 0;
    for (size_t i = 0; i < j->strokes->item_count; i++)
        if (j->strokes->items[i].part_index == part_index && !add_triangles(j, &j->strokes->items[i], FILL_TRIANGLES_MOST))
            return error_memory(error);
    if (j->count == 0)
        return LMN_OK;
    if (j->count >= FILL_TRIANGLES_MOST) {
        warnings_add(&s->warnings, WARNING_NO_STROKES, "areas of parts with %d triangles or more are not filled", FILL_TRIANGLES_MOST);
        return LMN_OK;
    }
    lmn_status status = unite(j, &area, error);
    if (status == LMN_OK) {
        uint32_t own = sheet_add_group(&s->page, (int32_t)group, p->name, "part fill", (uint32_t)part_index + 1);
        status = put_region(&s->page, own, vector_fill_colour(r, j->ink->scene, part_index), &area, error);
    }
    region_release(&area);
    return status;
}

lmn_status vector_put_fills(lmn_sheet *s, const vector_ink *ink, const vector_view *view, const stroke_scene *strokes, const rule *const *rules, const mat4 *worlds,
                            lmn_error *error)
{
    fill_job     j = {.ink = ink, .view = view, .strokes = strokes, .both = mat4_multiply(&view->camera.projection, &view->camera.view)};
    size_t       count = 0;
    filled_part *parts = mem_calloc(ink->scene->part_count, sizeof *parts);
    lmn_status   status = parts ? LMN_OK : error_memory(error);
    for (size_t i = 0; parts && i < ink->scene->part_count; i++) {
        double nearest = INFINITY, farthest = -INFINITY;
        box3   box = rules[i] ? part_bounds(ink->scene, worlds, i) : box3_empty();
        if (box3_is_empty(box))
            continue;
        camera_depth_range(&view->camera, box, &nearest, &farthest);
        parts[count++] = (filled_part){i, (nearest + farthest) / 2};
    }
    if (count)
        qsort(parts, count, sizeof *parts, compare_depths);
    uint32_t group = sheet_add_group(&s->page, (int32_t)ink->group, "fills", "fills", 0);
    sheet_clip_group(&s->page, group, view->box[0], view->box[1], view->box[2], view->box[3]);
    for (size_t i = 0; i < count && status == LMN_OK; i++)
        status = fill_part(s, &j, parts[i].part_index, group, rules[parts[i].part_index], error);
    mem_free(parts);
    mem_free(j.triangles);
    mem_free(j.contours);
    mem_free(j.corners);
    return status;
}
