/* Only what has a border can be cut: edges that no other triangle has the other way round. Their ends, sorted along the
 * longest axis, are looked for on the other ones. */
#include "import/stitch.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "base/vector3.h"
#include "base/work.h"
#include "import/build.h"
#include "scene/mesh.h"

enum { CUTS_MOST = 256 }; /* of an edge */

typedef struct place {
    double   along;
    uint32_t vertex;
} place;

typedef struct side {
    uint32_t low, high, corner;
    bool     back; /* it runs from high to low */
} side;

typedef struct stitcher {
    primitive *p;
    double     near;
    int        axis;
    place     *places;
    size_t     place_count;
    uint8_t   *open; /* per corner: the edge that begins there has no other one */
    uint32_t  *out;
    size_t     out_count, out_capacity;
    bool       failed;
} stitcher;

static double along_axis(const stitcher *s, uint32_t v)
{
    return (double)(&s->p->positions[v].x)[s->axis];
}

static void position(const stitcher *s, uint32_t v, double out[3])
{
    vec3 p = s->p->positions[v];
    vector3_set(out, (double)p.x, (double)p.y, (double)p.z);
}

static int compare_places(const void *a, const void *b)
{
    const place *x = a, *y = b;
    return x->along < y->along ? -1 : x->along > y->along ? 1 : x->vertex < y->vertex ? -1 : x->vertex > y->vertex;
}

static void sort_places(stitcher *s)
{
    for (size_t i = 0; i < s->place_count; i++)
        s->places[i].along = along_axis(s, s->places[i].vertex);
    if (s->place_count)
        qsort(s->places, s->place_count, sizeof *s->places, compare_places);
}

/* Vertices go to the first of those that are near. */
static void snap(stitcher *s)
{
    for (size_t i = 0; i < s->place_count && !work_stopped(); i++) {
        double at[3], other[3];
        position(s, s->places[i].vertex, at);
        for (size_t k = i; k-- > 0 && s->places[i].along - s->places[k].along <= s->near;) {
            position(s, s->places[k].vertex, other);
            if (vector3_distance(at, other) <= s->near) {
                s->p->positions[s->places[i].vertex] = s->p->positions[s->places[k].vertex];
                break;
            }
        }
    }
}

static int compare_sides(const void *a, const void *b)
{
    const side *x = a, *y = b;
    if (x->low != y->low)
        return x->low < y->low ? -1 : 1;
    if (x->high != y->high)
        return x->high < y->high ? -1 : 1;
    return x->corner < y->corner ? -1 : x->corner > y->corner;
}

static bool find_open(stitcher *s, const uint32_t *ids)
{
    const primitive *p = s->p;
    side            *sides = mem_alloc(((size_t)p->index_count + 1) * sizeof *sides);
    if (!sides)
        return false;
    for (uint32_t i = 0; i < p->index_count; i++) {
        uint32_t a = ids[p->indices[i]], b = ids[p->indices[i % 3 == 2 ? i - 2 : i + 1]];
        sides[i] = (side){a < b ? a : b, a < b ? b : a, i, a > b};
    }
    if (p->index_count)
        qsort(sides, p->index_count, sizeof *sides, compare_sides);
    for (size_t i = 0, end; i < p->index_count; i = end) {
        int balance = 0;
        for (end = i; end < p->index_count && sides[end].low == sides[i].low && sides[end].high == sides[i].high; end++)
            balance += sides[end].back ? -1 : 1;
        for (size_t k = i; k < end; k++)
            s->open[sides[k].corner] = balance != 0 && sides[i].low != sides[i].high;
    }
    mem_free(sides);
    return true;
}

typedef struct cut_place {
    double   t;
    uint32_t vertex;
} cut_place;

static int compare_cuts(const void *a, const void *b)
{
    const cut_place *x = a, *y = b;
    return x->t < y->t ? -1 : x->t > y->t;
}

/* Corners of others that lie in the edge from a to b, in order. */
static size_t cuts_of(const stitcher *s, uint32_t a, uint32_t b, cut_place *out)
{
    double from[3], to[3], way[3], at[3], d[3];
    position(s, a, from);
    position(s, b, to);
    vector3_add(way, to, -1, from);
    double length = vector3_length(way), low = fmin(along_axis(s, a), along_axis(s, b)) - s->near,
           high = fmax(along_axis(s, a), along_axis(s, b)) + s->near;
    size_t first = 0, last = s->place_count, count = 0;
    while (first < last) {
        size_t middle = first + (last - first) / 2;
        if (s->places[middle].along < low)
            first = middle + 1;
        else
            last = middle;
    }
    for (size_t i = first; i < s->place_count && s->places[i].along <= high && length > 0; i++) {
        position(s, s->places[i].vertex, at);
        vector3_add(d, at, -1, from);
        double t = vector3_dot(d, way) / length;
        if (!(t > s->near && t < length - s->near))
            continue;
        vector3_add(d, d, -t / length, way);
        if (vector3_length(d) <= s->near && count < CUTS_MOST)
            out[count++] = (cut_place){t, s->places[i].vertex};
    }
    qsort(out, count, sizeof *out, compare_cuts);
    size_t kept = 0;
    for (size_t i = 0; i < count; i++)
        if (kept == 0 || out[i].t > out[kept - 1].t + s->near)
            out[kept++] = out[i];
    return kept;
}

static void put_triangle(stitcher *s, uint32_t a, uint32_t b, uint32_t c)
{
    if (s->failed || !mem_grow((void **)&s->out, &s->out_capacity, s->out_count + 3, sizeof *s->out)) {
        s->failed = true;
        return;
    }
    s->out[s->out_count++] = a;
    s->out[s->out_count++] = b;
    s->out[s->out_count++] = c;
}

/* A triangle with places in its edges: from the opposite corner through all of one edge; the outermost two pieces have
 * those of the other two, and are cut in their turn. */
static void cut_triangle(stitcher *s, const uint32_t corners[3], cut_place *const cuts[3], const size_t counts[3])
{
    int edge = counts[0] ? 0 : counts[1] ? 1 : 2;
    if (!counts[edge]) {
        put_triangle(s, corners[0], corners[1], corners[2]);
        return;
    }
    uint32_t a = corners[edge], b = corners[(edge + 1) % 3], c = corners[(edge + 2) % 3], before = a;
    for (size_t i = 0; i <= counts[edge]; i++) {
        const bool     last = i == counts[edge];
        const uint32_t next = last ? b : cuts[edge][i].vertex, piece[3] = {before, next, c};
        cut_place     *of[3] = {NULL, cuts[(edge + 1) % 3], cuts[(edge + 2) % 3]};
        const size_t   many[3] = {0, last ? counts[(edge + 1) % 3] : 0, i == 0 ? counts[(edge + 2) % 3] : 0};
        cut_triangle(s, piece, of, many);
        before = next;
    }
}

static void cut_all(stitcher *s)
{
    cut_place lists[3][CUTS_MOST];
    for (uint32_t i = 0; i < s->p->index_count && !s->failed; i += 3) {
        const uint32_t *corners = &s->p->indices[i];
        cut_place      *cuts[3] = {lists[0], lists[1], lists[2]};
        size_t          counts[3];
        for (uint32_t k = 0; k < 3; k++)
            counts[k] = s->open[i + k] ? cuts_of(s, corners[k], corners[(k + 1) % 3], lists[k]) : 0;
        cut_triangle(s, corners, cuts, counts);
        s->failed = s->failed || (i % 3072 == 0 && work_stopped());
    }
}

/* One vertex a place, only such as borders have. */
static void take_places(stitcher *s, const uint32_t *ids)
{
    uint8_t *seen = mem_calloc((size_t)s->p->vertex_count + 1, 1);
    s->failed = !seen;
    s->place_count = 0;
    for (uint32_t i = 0; seen && i < s->p->index_count; i++)
        for (uint32_t k = 0; s->open[i] && k < 2; k++) {
            uint32_t v = s->p->indices[k == 0 ? i : i % 3 == 2 ? i - 2 : i + 1];
            if (!seen[ids[v]])
                s->places[s->place_count++].vertex = v;
            seen[ids[v]] = 1;
        }
    mem_free(seen);
    sort_places(s);
}

bool stitch(primitive *p, double near)
{
    stitcher s = {.p = p, .near = near};
    vec3     low = p->positions[0], high = low;
    for (uint32_t i = 0; i < p->vertex_count; i++)
        for (int k = 0; k < 3; k++) {
            (&low.x)[k] = fminf((&low.x)[k], (&p->positions[i].x)[k]);
            (&high.x)[k] = fmaxf((&high.x)[k], (&p->positions[i].x)[k]);
        }
    for (int k = 1; k < 3; k++)
        if ((&high.x)[k] - (&low.x)[k] > (&high.x)[s.axis] - (&low.x)[s.axis])
            s.axis = k;
    s.places = mem_alloc(((size_t)p->vertex_count + 1) * sizeof *s.places);
    s.open = mem_calloc((size_t)p->index_count + 1, 1);
    s.failed = !s.places || !s.open;
    for (uint32_t i = 0; !s.failed && i < p->vertex_count; i++)
        s.places[s.place_count++].vertex = i;
    sort_places(&s);
    if (!s.failed)
        snap(&s);
    uint32_t *ids = s.failed ? NULL : mesh_position_ids(p);
    s.failed = !ids || !find_open(&s, ids);
    if (!s.failed)
        take_places(&s, ids);
    if (!s.failed)
        cut_all(&s);
    s.failed = s.failed || s.out_count > UINT32_MAX;
    if (!s.failed) {
        mem_free(p->indices);
        p->indices = s.out;
        p->index_count = (uint32_t)s.out_count;
        s.out = NULL;
    }
    mem_free(s.out);
    mem_free(ids);
    mem_free(s.places);
    mem_free(s.open);
    return !s.failed;
}

/* --- holes ---------------------------------------------------------------------------------------------- */

/* An edge without another one on the other side, as the hole beside it runs: from the end of it in its triangle. */
typedef struct rim {
    uint32_t from, to; /* vertices that stand for places */
    uint32_t face;
    bool     used;
} rim;

typedef struct holes {
    stitcher *s;
    rim      *rims;
    size_t    rim_count;
    uint32_t *loop, *faces;
} holes;

static int compare_rims(const void *a, const void *b)
{
    const rim *x = a, *y = b;
    if (x->from != y->from)
        return x->from < y->from ? -1 : 1;
    return x->to < y->to ? -1 : x->to > y->to;
}

static rim *rim_from(const holes *h, uint32_t from)
{
    size_t low = 0, high = h->rim_count;
    while (low < high) {
        size_t middle = low + (high - low) / 2;
        if (h->rims[middle].from < from)
            low = middle + 1;
        else
            high = middle;
    }
    for (; low < h->rim_count && h->rims[low].from == from; low++)
        if (!h->rims[low].used)
            return &h->rims[low];
    return NULL;
}

/* Around one hole; 0: its rim has an end. */
static size_t walk(const holes *h, rim *first)
{
    size_t count = 0;
    for (rim *at = first; at; at = rim_from(h, at->to)) {
        at->used = true;
        h->loop[count] = at->from;
        h->faces[count++] = at->face;
        if (at->to == first->from)
            return count;
    }
    return 0;
}

static void face_normal(const stitcher *s, uint32_t face, double out[3])
{
    double p[3][3], a[3], b[3];
    for (int k = 0; k < 3; k++)
        position(s, s->p->indices[3 * (size_t)face + (size_t)k], p[k]);
    vector3_add(a, p[1], -1, p[0]);
    vector3_add(b, p[2], -1, p[0]);
    vector3_cross(out, a, b);
    if (!vector3_normalise(out))
        vector3_set(out, 0, 0, 0);
}

static bool belongs_to_face(const holes *h, size_t count)
{
    double normal[3] = {0}, first[3], at[3], next[3], part[3];
    position(h->s, h->loop[0], first);
    for (size_t i = 0; i < count; i++) {
        position(h->s, h->loop[i], at);
        position(h->s, h->loop[(i + 1) % count], next);
        vector3_add(at, at, -1, first);
        vector3_add(next, next, -1, first);
        vector3_cross(part, at, next);
        vector3_add(normal, normal, 1, part);
    }
    if (!vector3_normalise(normal))
        return false;
    bool beside = false, across = false;
    for (size_t i = 0; i < count; i++) {
        position(h->s, h->loop[i], at);
        vector3_add(at, at, -1, first);
        if (fabs(vector3_dot(at, normal)) > 2 * h->s->near)
            return false;
        face_normal(h->s, h->faces[i], part);
        beside = beside || vector3_dot(part, normal) > 0.9999;
        across = across || fabs(vector3_dot(part, normal)) < 0.99;
    }
    return beside && across;
}

static bool find_rims(holes *h, const uint32_t *ids)
{
    const primitive *p = h->s->p;
    for (uint32_t i = 0; i < p->index_count; i++)
        if (h->s->open[i])
            h->rims[h->rim_count++] =
                (rim){ids[p->indices[i % 3 == 2 ? i - 2 : i + 1]], ids[p->indices[i]], i / 3, false};
    if (h->rim_count)
        qsort(h->rims, h->rim_count, sizeof *h->rims, compare_rims);
    for (size_t i = 0; i < h->rim_count && !work_stopped(); i++) {
        size_t count = h->rims[i].used ? 0 : walk(h, &h->rims[i]);
        if (count < 3 || !belongs_to_face(h, count))
            continue;
        size_t at = h->s->out_count;
        if (!mem_grow((void **)&h->s->out, &h->s->out_capacity, at + 3 * (count - 2), sizeof *h->s->out))
            return false;
        build_triangulate(p->positions, h->loop, (uint32_t)count, h->s->out + at);
        h->s->out_count += 3 * (count - 2);
    }
    return !work_stopped();
}

static bool append(stitcher *s)
{
    primitive *p = s->p;
    size_t     count = p->index_count + s->out_count;
    uint32_t  *all = s->out_count && count <= UINT32_MAX ? mem_alloc(count * sizeof *all) : NULL;
    if (!s->out_count)
        return true;
    if (!all)
        return false;
    memcpy(all, p->indices, p->index_count * sizeof *all);
    memcpy(all + p->index_count, s->out, s->out_count * sizeof *all);
    mem_free(p->indices);
    p->indices = all;
    p->index_count = (uint32_t)count;
    return true;
}

bool stitch_holes(primitive *p, double near)
{
    stitcher  s = {.p = p, .near = near};
    holes     h = {.s = &s};
    size_t    count = (size_t)p->index_count + 1;
    uint32_t *ids = mesh_position_ids(p);
    s.open = mem_calloc(count, 1);
    h.rims = mem_alloc(count * sizeof *h.rims);
    h.loop = mem_alloc(count * sizeof *h.loop);
    h.faces = mem_alloc(count * sizeof *h.faces);
    bool good = ids && s.open && h.rims && h.loop && h.faces && find_open(&s, ids) && find_rims(&h, ids) && append(&s);
    mem_free(s.out);
    mem_free(s.open);
    mem_free(ids);
    mem_free(h.rims);
    mem_free(h.loop);
    mem_free(h.faces);
    return good;
}
