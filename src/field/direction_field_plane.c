/* Planes of a surface. Vertices at a plane's rim bend as what lies beside it does, so that what vertices know says
 * nothing about wide triangles; a hand sees that all between the rims is even. Triangles are collected into pieces by
 * their normals. A piece is a plane when what lies beside it without a crease is small, as roundings are: facets of
 * what is round have neighbours like themselves. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "base/work.h"
#include "field/direction_field_private.h"

static const double even = 0.99998; /* cosine of 0.36 degrees: normals of a piece differ from the first by no more */
/* A neighbour of more than this share of a piece's area is like it; a piece with such ones along more than this share
 * of its rim is a facet. */
static const double alike = 1.0 / 6, beside_alike = 0.35;
/* A single triangle or quadrangle, as coarse round things consist of, only if there are hardly any. */
static const double beside_alike_small = 0.05;
enum { SMALL_PIECE = 2 };
/* Pieces lie in one plane when their normals agree so far (sine), and their distances from the middle, diagonal 1. */
static const double same_slope = 0.02, same_offset = 0.01;

/* Planes whose normals are within 25 degrees are hatched as the largest of them. */
static const double same_side = 0.906;
enum { LEADERS_MOST = 64 };

typedef struct plane_piece {
    point3   normal, middle;
    double   area, rim, beside; /* beside: of the rim, beside neighbours that are alike */
    uint32_t first, count;      /* triangles, in the order that they were collected in */
} plane_piece;

typedef struct plane_finder {
    const field_surface *surface;
    const tensor        *tensors;
    const bool          *flat;
    uint32_t            *order, *queue, *pieces; /* triangles by area; as they are collected; per triangle: its piece */
    plane_piece         *items;
    size_t               count, capacity;
} plane_finder;

static point3 normal_of(const field_surface *s, uint32_t t)
{
    return point_scale(s->directions[t], s->turned[t] ? -1 : 1);
}

typedef struct sized_triangle {
    double   area;
    uint32_t triangle;
} sized_triangle;

static int by_area(const void *a, const void *b)
{
    const sized_triangle *one = a, *other = b;
    if (one->area != other->area)
        return one->area > other->area ? -1 : 1;
    return one->triangle < other->triangle ? -1 : one->triangle > other->triangle;
}

static bool sort_triangles(plane_finder *f)
{
    const field_surface *s = f->surface;
    sized_triangle      *sizes = mem_alloc(s->triangle_count * sizeof *sizes);
    for (uint32_t t = 0; sizes && t < s->triangle_count; t++)
        sizes[t] = (sized_triangle){s->areas[t], t};
    if (sizes && s->triangle_count)
        qsort(sizes, s->triangle_count, sizeof *sizes, by_area);
    for (uint32_t t = 0; sizes && t < s->triangle_count; t++)
        f->order[t] = sizes[t].triangle;
    bool done = sizes != NULL;
    mem_free(sizes);
    return done;
}

/* From the largest triangle that is left: all that hang together with it and lie as it does. What has no normal goes
 * along with any. */
static void collect(plane_finder *f, uint32_t seed, plane_piece *out, uint32_t begin)
{
    const field_surface *s = f->surface;
    uint32_t             number = (uint32_t)f->count, end = begin;
    *out = (plane_piece){.normal = normal_of(s, seed), .first = begin};
    f->pieces[seed] = number;
    f->queue[end++] = seed;
    for (uint32_t i = begin; i < end; i++) {
        uint32_t t = f->queue[i];
        out->area += s->areas[t];
        for (uint32_t h = 3 * t; h < 3 * t + 3; h++) {
            uint32_t o = s->opposite[h] == NOWHERE ? NOWHERE : s->opposite[h] / 3;
            if (o == NOWHERE || f->pieces[o] != NOWHERE)
                continue;
            point3 n = normal_of(s, o);
            if (point_dot(n, n) > 0 && point_dot(n, out->normal) < even)
                continue;
            f->pieces[o] = number;
            f->queue[end++] = o;
        }
    }
    out->count = end - begin;
}

static bool collect_pieces(plane_finder *f)
{
    const field_surface *s = f->surface;
    uint32_t             end = 0;
    memset(f->pieces, 0xFF, s->triangle_count * sizeof *f->pieces);
    for (uint32_t i = 0; i < s->triangle_count; i++) {
        if (f->pieces[f->order[i]] != NOWHERE)
            continue;
        if (work_stopped() || !mem_grow((void **)&f->items, &f->capacity, f->count + 1, sizeof *f->items))
            return false;
        collect(f, f->order[i], &f->items[f->count], end);
        end += f->items[f->count++].count;
    }
    return true;
}

static point3 edge_of(const field_surface *s, uint32_t h)
{
    uint32_t next = h % 3 == 2 ? h - 2 : h + 1;
    return point_sub(s->positions[s->corners[next]], s->positions[s->corners[h]]);
}

/* Is the half-edge on its piece's rim? *beside: the piece there, NOWHERE at creases and borders. */
static bool on_rim(const plane_finder *f, uint32_t h, uint32_t *beside)
{
    uint32_t o = f->surface->opposite[h];
    *beside = o == NOWHERE ? NOWHERE : f->pieces[o / 3];
    return *beside != f->pieces[h / 3];
}

static void measure_rims(plane_finder *f)
{
    const field_surface *s = f->surface;
    for (uint32_t h = 0; h < 3 * s->triangle_count; h++) {
        plane_piece *piece = &f->items[f->pieces[h / 3]];
        uint32_t     beside;
        if (!on_rim(f, h, &beside))
            continue;
        double length = point_length(edge_of(s, h));
        piece->rim += length;
        if (beside != NOWHERE && f->items[beside].area > alike * piece->area)
            piece->beside += length;
    }
}

static bool is_plane(const plane_piece *piece)
{
    double most = piece->count <= SMALL_PIECE ? beside_alike_small : beside_alike;
    return piece->area > 0 && point_dot(piece->normal, piece->normal) > 0 && piece->beside <= most * piece->rim &&
           piece->rim > 0;
}

/* --- directions ----------------------------------------------------------------------------------------- */

static point3 centre_of(const field_surface *s, uint32_t t)
{
    const uint32_t *k = s->corners + 3 * (size_t)t;
    return point_scale(point_add(point_add(s->positions[k[0]], s->positions[k[1]]), s->positions[k[2]]), 1.0 / 3);
}

static void find_middle(const plane_finder *f, plane_piece *piece)
{
    for (uint32_t i = piece->first; i < piece->first + piece->count; i++) {
        uint32_t t = f->queue[i];
        piece->middle = point_add(piece->middle, point_scale(centre_of(f->surface, t), f->surface->areas[t]));
    }
    piece->middle = point_scale(piece->middle, 1 / piece->area);
}

/* What an element at the rim knows of how the surface bends there. */
static void add_bend(const plane_finder *f, flat_shape *out, uint32_t e, double weight)
{
    tensor unit;
    if (f->flat[e] || !field_unit_in_plane(out->normal, &f->tensors[e], &unit))
        return;
    for (int k = 0; k < 6; k++)
        out->bend.v[k] += (float)weight * unit.v[k];
    out->bend_weight += weight;
}

static tensor direction_of(const plane_finder *f, const plane_piece *piece)
{
    const field_surface *s = f->surface;
    flat_shape           shape = {.normal = piece->normal, .mean = piece->middle, .area = piece->area};
    point3               u, v;
    double               flat = 0;
    tensor               chosen = {{0}}, unit;
    tangents(piece->normal, &u, &v);
    for (uint32_t i = piece->first; i < piece->first + piece->count; i++) {
        uint32_t t = f->queue[i];
        for (uint32_t h = 3 * t; h < 3 * t + 3; h++) {
            uint32_t e = s->corners[h], beside;
            flat_shape_add(&shape, s->positions[e], s->areas[t]);
            if (f->flat[e]) {
                flat += s->areas[t] / 3;
                for (int k = 0; k < 6; k++)
                    chosen.v[k] += (float)s->areas[t] * f->tensors[e].v[k];
            }
            if (!on_rim(f, h, &beside))
                continue;
            point3 edge = edge_of(s, h);
            flat_shape_add_border(&shape, edge, u, v);
            add_bend(f, &shape, e, point_length(edge));
        }
    }
    /* Most of it is known as flat: one direction has been found for that already. */
    if (flat > 0.5 * piece->area && field_unit_in_plane(piece->normal, &chosen, &unit))
        return unit;
    flat_shape_settle(&shape);
    return flat_shape_direction(&shape);
}

/* --- pieces in one plane -------------------------------------------------------------------------------- */

typedef struct plane_table {
    uint32_t *slots; /* planes, NOWHERE: free */
    size_t    mask;
    point3   *normals; /* per plane, turned so that opposite ones agree */
    double   *offsets;
    uint32_t *pieces; /* per plane: the largest one in it */
} plane_table;

static size_t hash_cell(const int64_t cell[4])
{
    uint64_t h = 0;
    for (int k = 0; k < 4; k++) {
        h = (h ^ (uint64_t)cell[k]) * UINT64_C(0x9E3779B97F4A7C15);
        h ^= h >> 29;
    }
    return (size_t)h;
}

/* The first of the normal's coordinates that is no rounding error is positive. */
static point3 canonical(point3 n)
{
    double sign = fabs(n.x) > same_slope ? n.x : fabs(n.y) > same_slope ? n.y : n.z;
    return sign < 0 ? point_scale(n, -1) : n;
}

static void cell_of(point3 normal, double offset, int64_t cell[4])
{
    cell[0] = (int64_t)floor(normal.x / same_slope);
    cell[1] = (int64_t)floor(normal.y / same_slope);
    cell[2] = (int64_t)floor(normal.z / same_slope);
    cell[3] = (int64_t)floor(offset / same_offset);
}

static uint32_t look_up(const plane_table *t, const int64_t cell[4], point3 normal, double offset)
{
    for (size_t slot = hash_cell(cell) & t->mask; t->slots[slot] != NOWHERE; slot = (slot + 1) & t->mask) {
        uint32_t plane = t->slots[slot];
        point3   apart = point_sub(t->normals[plane], normal);
        if (point_dot(apart, apart) <= same_slope * same_slope && fabs(t->offsets[plane] - offset) <= same_offset)
            return plane;
    }
    return NOWHERE;
}

/* The plane in which a piece lies, among those that there are. */
static uint32_t find_plane(const plane_table *t, point3 normal, double offset)
{
    int64_t middle[4];
    cell_of(normal, offset, middle);
    for (int around = 0; around < 81; around++) {
        int64_t  cell[4] = {middle[0] + around % 3 - 1, middle[1] + around / 3 % 3 - 1, middle[2] + around / 9 % 3 - 1,
                            middle[3] + around / 27 - 1};
        uint32_t found = look_up(t, cell, normal, offset);
        if (found != NOWHERE)
            return found;
    }
    return NOWHERE;
}

static void add_plane(plane_table *t, uint32_t plane, uint32_t piece, point3 normal, double offset)
{
    int64_t cell[4];
    cell_of(normal, offset, cell);
    size_t slot = hash_cell(cell) & t->mask;
    while (t->slots[slot] != NOWHERE)
        slot = (slot + 1) & t->mask;
    t->slots[slot] = plane;
    t->normals[plane] = normal;
    t->offsets[plane] = offset;
    t->pieces[plane] = piece;
}

static int by_area_of_piece(const void *a, const void *b)
{
    return by_area(a, b);
}

/* The pieces that are planes, the largest first. */
static size_t sort_planes(const plane_finder *f, sized_triangle *out)
{
    size_t count = 0;
    for (uint32_t i = 0; i < f->count; i++)
        if (is_plane(&f->items[i]))
            out[count++] = (sized_triangle){f->items[i].area, i};
    if (count)
        qsort(out, count, sizeof *out, by_area_of_piece);
    return count;
}

/* `planes`: per piece, the plane in which it lies. */
static bool join_planes(plane_finder *f, plane_table *t, sized_triangle *sorted, uint32_t *planes, field_planes *out)
{
    size_t count = sort_planes(f, sorted), size = 64;
    while (size < 2 * count)
        size *= 2;
    t->mask = size - 1;
    t->slots = mem_alloc(size * sizeof *t->slots);
    t->normals = mem_alloc(count * sizeof *t->normals);
    t->offsets = mem_alloc(count * sizeof *t->offsets);
    t->pieces = mem_alloc(count * sizeof *t->pieces);
    if (!t->slots || !t->normals || !t->offsets || !t->pieces)
        return false;
    memset(t->slots, 0xFF, size * sizeof *t->slots);
    for (size_t i = 0; i < count; i++) {
        plane_piece *piece = &f->items[sorted[i].triangle];
        find_middle(f, piece);
        point3   normal = canonical(piece->normal);
        double   offset = point_dot(normal, piece->middle);
        uint32_t plane = find_plane(t, normal, offset);
        if (plane == NOWHERE)
            add_plane(t, plane = out->count++, sorted[i].triangle, normal, offset);
        planes[sorted[i].triangle] = plane;
        if (work_stopped())
            return false;
    }
    out->units = mem_alloc(out->count * sizeof *out->units);
    for (uint32_t k = 0; out->units && k < out->count; k++)
        out->units[k] = direction_of(f, &f->items[t->pieces[k]]);
    return out->units != NULL;
}

/* What lies nearly as a larger plane does is hatched the same way: a hand keeps its direction over a wall that turns a
 * little, and on all walls that face one way. The largest planes come first. */
static void follow_larger(const plane_table *t, field_planes *out)
{
    uint32_t leaders[LEADERS_MOST], count = 0;
    for (uint32_t k = 0; k < out->count; k++) {
        bool follows = false;
        for (uint32_t i = 0; i < count && !follows; i++) {
            tensor unit;
            if (fabs(point_dot(t->normals[k], t->normals[leaders[i]])) < same_side ||
                !field_unit_in_plane(t->normals[k], &out->units[leaders[i]], &unit))
                continue;
            out->units[k] = unit;
            follows = true;
        }
        if (!follows && count < LEADERS_MOST)
            leaders[count++] = k;
    }
}

static bool find_planes(plane_finder *f, field_planes *out)
{
    plane_table     table = {0};
    uint32_t       *planes = mem_alloc(f->count * sizeof *planes);
    sized_triangle *sorted = mem_alloc(f->count * sizeof *sorted);
    bool            good = planes && sorted;
    if (good) {
        memset(planes, 0xFF, f->count * sizeof *planes);
        good = join_planes(f, &table, sorted, planes, out);
        if (good)
            follow_larger(&table, out);
    }
    for (uint32_t t = 0; good && t < f->surface->triangle_count; t++)
        out->of[t] = planes[f->pieces[t]];
    void *const blocks[] = {planes, sorted, table.slots, table.normals, table.offsets, table.pieces};
    for (size_t i = 0; i < sizeof blocks / sizeof *blocks; i++)
        mem_free(blocks[i]);
    return good;
}

bool field_planes_find(field_planes *out, const field_surface *s, const tensor *tensors, const bool *flat)
{
    size_t       count = s->triangle_count;
    plane_finder f = {.surface = s, .tensors = tensors, .flat = flat};
    f.order = mem_alloc(count * sizeof *f.order);
    f.queue = mem_alloc(count * sizeof *f.queue);
    f.pieces = mem_alloc(count * sizeof *f.pieces);
    out->of = mem_alloc(count * sizeof *out->of);
    bool good = f.order && f.queue && f.pieces && out->of && sort_triangles(&f) && collect_pieces(&f);
    if (good) {
        measure_rims(&f);
        good = find_planes(&f, out);
    }
    void *const blocks[] = {f.order, f.queue, f.pieces, f.items};
    for (size_t i = 0; i < sizeof blocks / sizeof *blocks; i++)
        mem_free(blocks[i]);
    if (!good)
        out->count = 0;
    return good;
}

void field_planes_release(field_planes *p)
{
    mem_free(p->of);
    mem_free(p->units);
    *p = (field_planes){0};
}
