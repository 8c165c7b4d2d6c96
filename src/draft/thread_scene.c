/* Threads become smooth where they are: every corner goes out (of a bore in) to the hull of the profile, which is the
 * cylinder of the crests between the chamfers that the thread ends in. Faces stay what they are, so that closed bodies
 * are closed, and whatever is made of them, lines and sections, knows no difference. */
#include "draft/threads.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "base/vector3.h"
#include "scene/mesh.h"

static const double same_place = 1e-5;  /* of the crests' radius: corners of the mesh that were welded */
static const double crest_near = 0.03;  /* of the depth: what is nearer to the crests' cylinder lies on it */
static const double across_most = 0.9;  /* cosine: steeper faces are those that cut a thread off */
static const double same_height = 1e-4; /* of the crests' radius: faces at the ends are not exactly across the axis */

/* A corner of a thread, as seen from its axis; `out`: from the axis, of a bore towards it. */
typedef struct place {
    double along, out, p[3]; /* `along` in steps of the hull */
} place;

typedef struct hull {
    place  *places; /* by `along` */
    size_t  count;
    size_t *tops; /* those of them that the hull goes over */
    size_t  top_count;
    double  step; /* along the axis: what differs by less is at one height */
} hull;

static void around(const draft_thread *t, const double p[3], double *along, double radius[3], double *away)
{
    double d[3];
    vector3_add(d, p, -1, t->ends[0]);
    *along = vector3_dot(d, t->axis);
    vector3_add(radius, d, -*along, t->axis);
    *away = vector3_length(radius);
    for (int k = 0; k < 3 && *away > 0; k++)
        radius[k] /= *away;
}

static double height_of(const hull *h, double along)
{
    return round(along / h->step) * h->step;
}

static int compare_places(const void *a, const void *b)
{
    const place *p = a, *q = b;
    if (p->along != q->along)
        return p->along < q->along ? -1 : 1;
    return (p->out > q->out) - (p->out < q->out);
}

static void hull_release(hull *h)
{
    mem_free(h->places);
    mem_free(h->tops);
    *h = (hull){.places = NULL};
}

/* Does the middle one of three lie on or below the line between the others? */
static bool is_below(const place *a, const place *b, const place *c)
{
    return (b->along - a->along) * (c->out - a->out) - (b->out - a->out) * (c->along - a->along) >= 0;
}

static bool hull_make(hull *h, const draft_thread *t, const edge_mesh *m, const uint32_t *region, uint32_t own)
{
    *h = (hull){.places = mem_alloc(((size_t)m->vertex_count + 1) * sizeof *h->places),
                .tops = mem_alloc(((size_t)m->vertex_count + 1) * sizeof *h->tops)};
    if (!h->places || !h->tops)
        return false;
    const double near = crest_near * fabs(t->crest - t->root), length = vector3_distance(t->ends[0], t->ends[1]);
    h->step = length / fmax(round(length / (same_height * t->crest)), 1);
    for (uint32_t i = 0; i < m->vertex_count; i++) {
        if (region[i] != own)
            continue;
        place *p = &h->places[h->count++];
        double radius[3], away;
        vector3_set(p->p, (double)m->positions[i].x, (double)m->positions[i].y, (double)m->positions[i].z);
        around(t, p->p, &p->along, radius, &away);
        p->along = height_of(h, p->along);
        p->out = (t->hollow ? -1 : 1) * (fabs(away - t->crest) < near ? t->crest : away);
    }
    if (h->count)
        qsort(h->places, h->count, sizeof *h->places, compare_places);
    for (size_t i = 0; i < h->count; i++) {
        while (h->top_count >= 2 &&
               is_below(&h->places[h->tops[h->top_count - 2]], &h->places[h->tops[h->top_count - 1]], &h->places[i]))
            h->top_count--;
        if (h->top_count == 1 && h->places[h->tops[0]].along == h->places[i].along)
            h->top_count--;
        h->tops[h->top_count++] = i;
    }
    return true;
}

static double hull_at(const hull *h, double along)
{
    size_t low = 0, high = h->top_count - 1;
    while (low + 1 < high) {
        size_t middle = (low + high) / 2;
        *(h->places[h->tops[middle]].along <= along ? &low : &high) = middle;
    }
    const place *a = &h->places[h->tops[low]], *b = &h->places[h->tops[high]];
    double       width = b->along - a->along, f = width > 0 ? fmin(fmax((along - a->along) / width, 0), 1) : 0;
    return a->out + f * (b->out - a->out);
}

/* Where the hull is the crests' cylinder. */
static void note_chamfers(draft_thread *t, const hull *h)
{
    const double depth = fabs(t->crest - t->root);
    bool         any = false;
    for (size_t i = 0; i < h->top_count; i++) {
        const place *p = &h->places[h->tops[i]];
        if (fabs(fabs(p->out) - t->crest) > crest_near * depth)
            continue;
        t->flat[0] = any ? t->flat[0] : p->along;
        t->flat[1] = p->along;
        any = true;
    }
    /* Chamfers may go on beyond the roots. */
    const double length = vector3_distance(t->ends[0], t->ends[1]);
    for (int k = 0; k < 2; k++) {
        const place *p = &h->places[h->tops[k ? h->top_count - 1 : 0]];
        double       width = fabs(t->flat[k] - p->along), whole = fabs(t->flat[k] - (k ? length : 0));
        t->tip[k] = width > h->step ? t->crest + (fabs(p->out) - t->crest) * whole / width : t->crest;
    }
}

/* Is there a corner of the thread at a place? */
static bool hull_has(const hull *h, const double p[3], double along, double near)
{
    size_t       low = 0, high = h->count;
    const double first = along - near - h->step, last = along + near + h->step;
    while (low < high) {
        size_t middle = (low + high) / 2;
        if (h->places[middle].along < first)
            low = middle + 1;
        else
            high = middle;
    }
    for (; low < h->count && h->places[low].along <= last; low++)
        if (vector3_distance(h->places[low].p, p) <= near)
            return true;
    return false;
}

/* True where it was moved, or is where it would be moved to. */
static bool smooth_corner(vec3 *v, const draft_thread *t, const hull *h)
{
    double p[3] = {(double)v->x, (double)v->y, (double)v->z}, along, radius[3], away;
    around(t, p, &along, radius, &away);
    if (!(away > 0) || !hull_has(h, p, along, same_place * t->crest))
        return false;
    double moved[3], out = fabs(hull_at(h, height_of(h, along)));
    vector3_add(moved, t->ends[0], along, t->axis);
    vector3_add(moved, moved, out, radius);
    *v = (vec3){(float)moved[0], (float)moved[1], (float)moved[2]};
    return true;
}

/* Lines that the file brings along the thread are its edges, which are none any more. */
static void drop_lines(primitive *p, const uint8_t *moved)
{
    uint32_t kept = 0;
    for (uint32_t i = 0; i < p->line_count; i++)
        if (!moved[p->lines[2 * i]] || !moved[p->lines[2 * i + 1]]) {
            p->lines[2 * kept] = p->lines[2 * i];
            p->lines[2 * kept + 1] = p->lines[2 * i + 1];
            kept++;
        }
    p->line_count = kept;
}

static bool is_of_thread(const primitive *p, const draft_thread *t, const uint8_t *moved, size_t triangle)
{
    double corners[3][3], a[3], b[3], normal[3];
    for (int k = 0; k < 3; k++) {
        uint32_t v = p->indices[3 * triangle + (size_t)k];
        if (!moved[v])
            return false;
        vector3_set(corners[k], (double)p->positions[v].x, (double)p->positions[v].y, (double)p->positions[v].z);
    }
    vector3_add(a, corners[1], -1, corners[0]);
    vector3_add(b, corners[2], -1, corners[0]);
    vector3_cross(normal, a, b);
    return !vector3_normalise(normal) || fabs(vector3_dot(normal, t->axis)) < across_most;
}

/* Edges between faces of the thread may be outlines and are nothing else. */
static bool say_edges(primitive *p, const draft_thread *t, const uint8_t *moved)
{
    const size_t count = p->index_count;
    uint32_t    *beside = mesh_adjacency(p);
    uint8_t     *said = mem_alloc(count + 1);
    if (beside && said) {
        memset(said, SAID_NOTHING, count);
        for (size_t i = 0; p->edges.values && i < count; i++)
            said[i] = p->edges.values[i];
        for (size_t i = 0; i < count; i++)
            if (beside[i] != UINT32_MAX && is_of_thread(p, t, moved, i / 3) && is_of_thread(p, t, moved, beside[i] / 3))
                said[i] = SAID_SILHOUETTE;
    }
    bool good = beside && said;
    mem_free(beside);
    if (good) {
        mem_free(p->edges.values);
        p->edges.values = said;
    } else {
        mem_free(said);
    }
    return good;
}

static bool smooth_primitive(primitive *p, const draft_thread *t, const hull *h)
{
    uint8_t *moved = mem_calloc((size_t)p->vertex_count + 1, 1);
    bool     any = false;
    for (uint32_t i = 0; i < p->vertex_count && moved; i++) {
        moved[i] = smooth_corner(&p->positions[i], t, h);
        any = any || moved[i];
    }
    if (any) { /* normals of the file are those of the groove */
        p->normals = NULL;
        p->bounds = box3_empty();
        for (uint32_t i = 0; i < p->vertex_count; i++)
            p->bounds = box3_with_point(p->bounds, p->positions[i]);
        drop_lines(p, moved);
    }
    bool good = moved && (!any || say_edges(p, t, moved));
    mem_free(moved);
    return good;
}

/* Arrays are those of the mesh that it was made of, but for positions, lines and what is said of edges. */
static void release_made(mesh *made)
{
    for (size_t i = 0; i < made->primitive_count && made->primitives; i++) {
        mem_free(made->primitives[i].positions);
        mem_free(made->primitives[i].lines);
        mem_free(made->primitives[i].edges.values);
    }
    mem_free(made->primitives);
}

static bool make_mesh(mesh *made, const mesh *of, const edge_mesh *edges, draft_threads *threads,
                      const uint32_t *region)
{
    *made = *of;
    made->twin = 0;
    made->revision = made->topology = scene_next_revision();
    made->primitives = mem_copy(of->primitives, of->primitive_count * sizeof *made->primitives);
    bool good = made->primitives != NULL;
    for (size_t i = 0; i < of->primitive_count && made->primitives; i++) {
        primitive       *p = &made->primitives[i];
        const primitive *from = &of->primitives[i];
        p->positions = mem_copy(from->positions, from->vertex_count * sizeof *p->positions);
        p->lines = from->line_count ? mem_copy(from->lines, 2 * (size_t)from->line_count * sizeof *p->lines) : NULL;
        p->edges.values = from->edges.values ? mem_copy(from->edges.values, from->index_count) : NULL;
        good = good && p->positions && (p->lines || !from->line_count) && (p->edges.values || !from->edges.values);
    }
    for (size_t k = 0; k < threads->count && good; k++) {
        hull h;
        good = hull_make(&h, &threads->items[k], edges, region, (uint32_t)k + 1);
        if (good && h.top_count)
            note_chamfers(&threads->items[k], &h);
        for (size_t i = 0; i < made->primitive_count && good && h.top_count; i++)
            good = smooth_primitive(&made->primitives[i], &threads->items[k], &h);
        hull_release(&h);
    }
    return good;
}

/* Its bones and shapes would move what has been moved. */
static bool bends(const mesh *m)
{
    for (size_t i = 0; i < m->primitive_count; i++)
        if (m->primitives[i].joints || m->primitives[i].morph_count)
            return true;
    return false;
}

static bool note_threads(draft_threads *out, const draft_threads *of, uint32_t part)
{
    for (size_t i = 0; i < of->count; i++) {
        if (!mem_grow((void **)&out->items, &out->capacity, out->count + 1, sizeof *out->items))
            return false;
        out->items[out->count] = of->items[i];
        out->items[out->count++].part = part;
    }
    return true;
}

/* Which parts are of the mesh, and wanted. */
static bool is_of(const lmn_scene *scene, const bool *parts, size_t part, size_t mesh)
{
    const node *n = &scene->nodes[scene->parts[part].node];
    return parts[part] && n->solid == NONE && n->mesh == (int32_t)mesh;
}

static lmn_status smooth_mesh(draft_thread_scene *t, const lmn_scene *scene, const bool *parts, size_t index,
                              double crease_angle, lmn_error *error)
{
    const mesh   *m = &scene->meshes[index];
    draft_threads found = {NULL, 0, 0};
    edge_mesh     edges = {.vertex_count = 0};
    lmn_status    status = edge_mesh_create(&edges, m, NULL, crease_angle, error);
    uint32_t     *region = status == LMN_OK ? mem_alloc(((size_t)edges.vertex_count + 1) * sizeof *region) : NULL;
    if (status == LMN_OK)
        status = region ? draft_threads_find(&found, region, &edges, error) : error_memory(error);
    if (status == LMN_OK && found.count) {
        mesh *made = &t->made[t->made_count++];
        bool  good = make_mesh(made, m, &edges, &found, region);
        for (size_t i = 0; i < scene->part_count && good; i++)
            if (is_of(scene, parts, i, index)) {
                t->scene.nodes[scene->parts[i].node].mesh = (int32_t)(t->borrowed + t->made_count - 1);
                good = note_threads(&t->threads, &found, (uint32_t)i + 1);
            }
        status = good ? LMN_OK : error_memory(error);
    }
    edge_mesh_release(&edges);
    draft_threads_release(&found);
    mem_free(region);
    return status;
}

lmn_status draft_threads_smooth(const lmn_scene **out, draft_thread_scene *t, const lmn_scene *scene, const bool *parts,
                                double crease_angle, lmn_error *error)
{
    lmn_status status = LMN_OK;
    *out = scene;
    *t = (draft_thread_scene){.borrowed = scene->mesh_count};
    t->scene = *scene;
    t->scene.nodes = mem_copy(scene->nodes, scene->node_count * sizeof *scene->nodes);
    t->made = mem_calloc(scene->mesh_count + 1, sizeof *t->made);
    if (!t->scene.nodes || !t->made)
        status = error_memory(error);
    for (size_t m = 0; m < scene->mesh_count && status == LMN_OK; m++) {
        bool wanted = false;
        for (size_t i = 0; i < scene->part_count && !wanted; i++)
            wanted = is_of(scene, parts, i, m);
        if (wanted && !bends(&scene->meshes[m]))
            status = smooth_mesh(t, scene, parts, m, crease_angle, error);
    }
    t->scene.meshes = status == LMN_OK && t->made_count
                          ? mem_alloc((scene->mesh_count + t->made_count) * sizeof *t->scene.meshes)
                          : NULL;
    if (status != LMN_OK || !t->made_count)
        return status;
    if (!t->scene.meshes)
        return error_memory(error);
    memcpy(t->scene.meshes, scene->meshes, scene->mesh_count * sizeof *scene->meshes);
    memcpy(t->scene.meshes + scene->mesh_count, t->made, t->made_count * sizeof *t->made);
    t->scene.mesh_count = scene->mesh_count + t->made_count;
    t->scene.revision = scene_next_revision(); /* nothing that was made of the scene fits this one */
    *out = &t->scene;
    return LMN_OK;
}

void draft_thread_scene_release(draft_thread_scene *t)
{
    for (size_t i = 0; i < t->made_count; i++)
        release_made(&t->made[i]);
    mem_free(t->made);
    mem_free(t->scene.nodes);
    mem_free(t->scene.meshes);
    draft_threads_release(&t->threads);
    *t = (draft_thread_scene){.made = NULL};
}

static void to_world(double out[3], const mat4 *m, const double p[3], double place)
{
    for (int row = 0; row < 3; row++)
        out[row] = m->m[row] * p[0] + m->m[4 + row] * p[1] + m->m[8 + row] * p[2] + place * m->m[12 + row];
}

lmn_status draft_threads_place(draft_threads *out, const draft_threads *of_parts, const stroke_scene *scene,
                               lmn_error *error)
{
    for (size_t i = 0; i < scene->item_count; i++)
        for (size_t k = 0; k < of_parts->count; k++) {
            draft_thread t = of_parts->items[k];
            const mat4  *world = &scene->items[i].world;
            double       axis[3], grown = 0;
            if (t.part != scene->items[i].part_index + 1)
                continue;
            for (int n = 0; n < 3; n++)
                grown = fmax(grown, vector3_length(&world->m[4 * n]));
            to_world(axis, world, t.axis, 0);
            vector3_copy(t.axis, axis);
            for (int n = 0; n < 2; n++) {
                double end[3];
                to_world(end, world, t.ends[n], 1);
                vector3_copy(t.ends[n], end);
            }
            t.crest *= grown;
            t.root *= grown;
            t.lead *= grown;
            for (int n = 0; n < 2; n++) {
                t.flat[n] *= grown;
                t.tip[n] *= grown;
            }
            if (!vector3_normalise(t.axis))
                continue;
            if (!mem_grow((void **)&out->items, &out->capacity, out->count + 1, sizeof *out->items))
                return error_memory(error);
            out->items[out->count++] = t;
        }
    return LMN_OK;
}
