/* Areas of parts: their triangles on the page, in one colour each, the farthest part first. What is seen of a part that reaches both before and behind another one is not told apart: parts
 * lie over each other as wholes.
 *
 * The triangles are not united. With all of them anticlockwise, edges that two triangles pass in opposite directions drop out; what is left runs in loops, and how often these run around a
 * place is how many triangles cover it. An area is what is run around at all, so the loops are its border. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "draw/vector_private.h"

static const double smallest_area = 1e-9; /* of a triangle, square mm */

/* A part as it lies on the page. */
typedef struct filled_part {
    size_t part_index;
    double depth; /* of the middle of its box */
} filled_part;

/* A triangle's edge, by its ends in order; `turned` where it runs from the higher one. */
typedef struct border_edge {
    uint32_t low, high;
    bool     turned;
} border_edge;

typedef struct fill_job {
    const vector_ink   *ink;
    const vector_view  *view;
    const stroke_scene *strokes;
    mat4                both;   /* projection · view */
    float             (*places)[2]; /* of the item's vertices on the page, NaN behind the eye */
    size_t              place_capacity;
    border_edge        *edges;
    size_t              edge_count, edge_capacity;
    uint32_t           *next, *heads; /* edges that leave a vertex, + 1 */
    size_t              next_capacity, head_capacity;
    float             (*loop)[2];
    size_t              loop_count, loop_capacity;
} fill_job;

static int compare_depths(const void *a, const void *b)
{
    const filled_part *one = a, *other = b;
    if (one->depth != other->depth)
        return one->depth > other->depth ? -1 : 1;
    return one->part_index < other->part_index ? -1 : one->part_index > other->part_index;
}

/* Places of an item's vertices on the page; NaN for those behind the eye. */
static bool project(fill_job *j, const stroke_item *item)
{
    const edge_mesh *m = &j->strokes->meshes[item->mesh];
    mat4             all = mat4_multiply(&j->both, &item->world);
    if (!mem_grow((void **)&j->places, &j->place_capacity, m->vertex_count, sizeof *j->places))
        return false;
    for (uint32_t i = 0; i < m->vertex_count; i++) {
        const double from[4] = {(double)m->places[i].x, (double)m->places[i].y, (double)m->places[i].z, 1};
        double       clip[4] = {0};
        for (int k = 0; k < 4; k++)
            for (int n = 0; n < 4; n++)
                clip[k] += all.m[4 * n + k] * from[n];
        bool there = clip[3] > 1e-12;
        j->places[i][0] = there ? (float)(j->ink->origin[0] + (clip[0] / clip[3] + 1) / 2 * j->view->box[2]) : NAN;
        j->places[i][1] = there ? (float)(j->ink->origin[1] + (1 - clip[1] / clip[3]) / 2 * j->view->box[3]) : NAN;
    }
    return true;
}

static void add_edge(fill_job *j, uint32_t from, uint32_t to)
{
    j->edges[j->edge_count++] = from < to ? (border_edge){from, to, false} : (border_edge){to, from, true};
}

/* The edges of all triangles that are needed: of closed pieces those that face the viewer, which lie over all others. */
static bool gather(fill_job *j, const stroke_item *item)
{
    const edge_mesh *m = &j->strokes->meshes[item->mesh];
    double           cofactors[9];
    bool             mirrored = mat4_cofactors(&item->world, cofactors) < 0;
    j->edge_count = 0;
    if (!mem_grow((void **)&j->edges, &j->edge_capacity, 3 * (size_t)m->face_count, sizeof *j->edges))
        return false;
    for (uint32_t f = 0; f < m->face_count; f++) {
        const uint32_t *v = m->faces[f];
        const float    *p = j->places[v[0]], *q = j->places[v[1]], *r = j->places[v[2]];
        /* Above 0 where the triangle is clockwise as it is seen, since y goes down. */
        double area = ((double)q[0] - (double)p[0]) * ((double)r[1] - (double)p[1]) - ((double)r[0] - (double)p[0]) * ((double)q[1] - (double)p[1]);
        if (!(fabs(area) > smallest_area) || (m->closed[m->pieces[f]] && (area > 0) != mirrored))
            continue;
        for (int k = 0; k < 3; k++)
            add_edge(j, v[area < 0 ? k : (k + 1) % 3], v[area < 0 ? (k + 1) % 3 : k]);
    }
    return true;
}

static int compare_edges(const void *a, const void *b)
{
    const border_edge *one = a, *other = b;
    if (one->low != other->low)
        return one->low < other->low ? -1 : 1;
    return one->high < other->high ? -1 : one->high > other->high;
}

/* Leaves of each edge as many copies as it is passed more often one way than the other. */
static void cancel(fill_job *j)
{
    size_t left = 0;
    if (j->edge_count)
        qsort(j->edges, j->edge_count, sizeof *j->edges, compare_edges);
    for (size_t i = 0; i < j->edge_count;) {
        border_edge edge = j->edges[i];
        long        more = 0;
        for (; i < j->edge_count && compare_edges(&edge, &j->edges[i]) == 0; i++)
            more += j->edges[i].turned ? -1 : 1;
        edge.turned = more < 0;
        for (long n = labs(more); n > 0; n--)
            j->edges[left++] = edge;
    }
    j->edge_count = left;
}

/* Lists of the edges that leave each vertex. */
static bool link_edges(fill_job *j, uint32_t vertex_count)
{
    if (!mem_grow((void **)&j->next, &j->next_capacity, j->edge_count, sizeof *j->next) ||
        !mem_grow((void **)&j->heads, &j->head_capacity, vertex_count, sizeof *j->heads))
        return false;
    memset(j->heads, 0, vertex_count * sizeof *j->heads);
    for (size_t i = j->edge_count; i-- > 0;) {
        uint32_t from = j->edges[i].turned ? j->edges[i].high : j->edges[i].low;
        j->next[i] = j->heads[from];
        j->heads[from] = (uint32_t)i + 1;
    }
    return true;
}

/* Walks on from a vertex until no edge leaves: as many come to each vertex as leave it, so that this is where the walk began. */
static bool put_loop(fill_job *j, sheet *s, uint32_t vertex)
{
    j->loop_count = 0;
    while (j->heads[vertex]) {
        const border_edge *edge = &j->edges[j->heads[vertex] - 1];
        if (!mem_grow((void **)&j->loop, &j->loop_capacity, j->loop_count + 1, sizeof *j->loop))
            return false;
        memcpy(j->loop[j->loop_count++], j->places[vertex], sizeof *j->loop);
        j->heads[vertex] = j->next[j->heads[vertex] - 1];
        vertex = edge->turned ? edge->low : edge->high;
    }
    sheet_add_path(s, &(sheet_path){.closed = true, .filled = true}, (const float (*)[2])j->loop, j->loop_count);
    return true;
}

/* The area of one item into the sheet's last item. */
static bool put_area(fill_job *j, sheet *s, const stroke_item *item)
{
    uint32_t count = j->strokes->meshes[item->mesh].vertex_count;
    if (!project(j, item) || !gather(j, item))
        return false;
    cancel(j);
    if (!link_edges(j, count))
        return false;
    for (uint32_t i = 0; i < count; i++)
        while (j->heads[i])
            if (!put_loop(j, s, i))
                return false;
    return true;
}

static lmn_status fill_part(sheet *s, fill_job *j, size_t part_index, uint32_t group, const rule *r, lmn_error *error)
{
    const lmn_scene *scene = j->ink->scene;
    uint32_t         own = sheet_add_group(s, (int32_t)group, scene->parts[part_index].name, "part fill", (uint32_t)part_index + 1);
    sheet_add_item(s, SHEET_PATH, own, vector_fill_colour(r, scene, part_index), 0);
    for (size_t i = 0; i < j->strokes->item_count; i++)
        if (j->strokes->items[i].part_index == part_index && !put_area(j, s, &j->strokes->items[i]))
            return error_memory(error);
    return LMN_OK;
}

lmn_status vector_put_fills(sheet *s, const vector_ink *ink, const vector_view *view, const stroke_scene *strokes, const rule *const *rules, const mat4 *worlds,
                            lmn_progress_fn progress, void *user, lmn_error *error)
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
    uint32_t group = sheet_add_group(s, (int32_t)ink->group, "fills", "fills", 0);
    sheet_clip_group(s, group, view->box[0], view->box[1], view->box[2], view->box[3]);
    for (size_t i = 0; i < count && status == LMN_OK; i++) {
        if (progress && !progress(0, "filling", user))
            status = error_set(error, LMN_CANCELLED, "cancelled");
        else
            status = fill_part(s, &j, parts[i].part_index, group, rules[parts[i].part_index], error);
    }
    mem_free(parts);
    mem_free(j.places);
    mem_free(j.edges);
    mem_free(j.next);
    mem_free(j.heads);
    mem_free(j.loop);
    return status;
}
