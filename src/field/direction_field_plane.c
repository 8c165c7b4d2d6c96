/* Planes of a surface. Vertices at a plane's rim bend as what lies beside it does, so that what vertices know says
 * nothing about wide triangles; a hand sees that all between the rims is even. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "base/work.h"
#include "field/direction_field_private.h"
#include "scene/flat_pieces.h"

/* Pieces lie in one plane when their normals agree so far (sine), and their distances from the middle, diagonal 1. */
static const double same_slope = 0.02, same_offset = 0.01;

/* Planes whose normals are within 25 degrees are hatched as the largest of them. */
static const double same_side = 0.906;
enum { LEADERS_MOST = 64 };

typedef struct plane_finder {
    const field_surface *surface;
    const tensor        *tensors;
    const bool          *flat;
    flat_pieces          pieces;
} plane_finder;

static point3 edge_of(const field_surface *s, uint32_t h)
{
    return point_sub(s->positions[s->corners[field_next_half(h)]], s->positions[s->corners[h]]);
}

/* Is the half-edge on its piece's rim? *beside: the piece there, NOWHERE at creases and borders. */
static bool on_rim(const plane_finder *f, uint32_t h, uint32_t *beside)
{
    uint32_t o = f->surface->opposite[h];
    *beside = o == NOWHERE ? NOWHERE : f->pieces.of[o / 3];
    return *beside != f->pieces.of[h / 3];
}

static bool find_pieces(plane_finder *f)
{
    const field_surface *s = f->surface;
    double(*normals)[3] = mem_alloc(s->triangle_count * sizeof *normals + 1);
    double *lengths = mem_alloc(3 * (size_t)s->triangle_count * sizeof *lengths + 1);
    bool    good = normals && lengths;
    for (uint32_t t = 0; t < s->triangle_count && good; t++) {
        point3 n = point_scale(s->directions[t], s->turned[t] ? -1 : 1);
        normals[t][0] = n.x, normals[t][1] = n.y, normals[t][2] = n.z;
        for (uint32_t h = 3 * t; h < 3 * t + 3; h++)
            lengths[h] = point_length(edge_of(s, h));
    }
    good = good && flat_pieces_find(&f->pieces, &(flat_triangles){.count = s->triangle_count,
                                                                  .normals = (const double(*)[3])normals,
                                                                  .areas = s->areas,
                                                                  .lengths = lengths,
                                                                  .opposite = s->opposite});
    mem_free(normals);
    mem_free(lengths);
    return good;
}

/* --- directions ----------------------------------------------------------------------------------------- */

static point3 centre_of(const field_surface *s, uint32_t t)
{
    const uint32_t *k = s->corners + 3 * (size_t)t;
    return point_scale(point_add(point_add(s->positions[k[0]], s->positions[k[1]]), s->positions[k[2]]), 1.0 / 3);
}

static point3 normal_of(const flat_piece *piece)
{
    return (point3){piece->normal[0], piece->normal[1], piece->normal[2]};
}

static point3 middle_of(const plane_finder *f, const flat_piece *piece)
{
    point3 sum = {0, 0, 0};
    for (uint32_t i = piece->first; i < piece->first + piece->count; i++) {
        uint32_t t = f->pieces.members[i];
        sum = point_add(sum, point_scale(centre_of(f->surface, t), f->surface->areas[t]));
    }
    return point_scale(sum, 1 / piece->area);
}

/* How the surface bends over an edge of the rim, across it and by its angle. What vertices there know is of wide discs,
 * which on long triangles reach over the whole plane. */
static void add_bend(const plane_finder *f, flat_shape *out, uint32_t h, uint32_t beside)
{
    const field_surface *s = f->surface;
    tensor               unit, across;
    if (beside == NOWHERE || (f->flat[s->corners[h]] && f->flat[s->corners[field_next_half(h)]]))
        return;
    point3 edge = edge_of(s, h), away = point_unit_or(point_cross(edge, out->normal), (point3){0, 0, 0});
    across = tensor_of(away, point_cross(out->normal, away), 1, 0, 0);
    double angle = point_length(point_cross(out->normal, normal_of(&f->pieces.items[beside]))),
           weight = angle * point_length(edge);
    if (!(weight > 0) || !field_unit_in_plane(out->normal, &across, &unit))
        return;
    for (int k = 0; k < 6; k++)
        out->bend.v[k] += (float)weight * unit.v[k];
    out->bend_weight += weight;
}

/* *bent: what goes on smoothly beside it says which way. */
static tensor direction_of(const plane_finder *f, const flat_piece *piece, bool *bent)
{
    const field_surface *s = f->surface;
    point3               normal = normal_of(piece);
    flat_shape           shape = {.normal = normal, .mean = middle_of(f, piece), .area = piece->area};
    point3               u, v;
    double               flat = 0;
    tensor               chosen = {{0}}, unit;
    tangents(normal, &u, &v);
    for (uint32_t i = piece->first; i < piece->first + piece->count; i++) {
        uint32_t t = f->pieces.members[i];
        for (uint32_t h = 3 * t; h < 3 * t + 3; h++) {
            uint32_t e = s->corners[h], beside;
            flat_shape_add(&shape, field_edge_middle(s, h), s->areas[t]);
            if (f->flat[e]) {
                flat += s->areas[t] / 3;
                for (int k = 0; k < 6; k++)
                    chosen.v[k] += (float)s->areas[t] * f->tensors[e].v[k];
            }
            if (!on_rim(f, h, &beside))
                continue;
            flat_shape_add_border(&shape, edge_of(s, h), u, v);
            add_bend(f, &shape, h, beside);
        }
    }
    *bent = flat_shape_bend(&shape, &unit);
    /* Most of it is known as flat: one direction has been found for that already. */
    if (flat > 0.5 * piece->area && field_unit_in_plane(normal, &chosen, &unit))
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
    bool     *bent;   /* per plane: does that take after what bends beside it? */
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

typedef struct sized_plane {
    double   area;
    uint32_t piece;
} sized_plane;

static int by_area(const void *a, const void *b)
{
    const sized_plane *one = a, *other = b;
    if (one->area != other->area)
        return one->area > other->area ? -1 : 1;
    return one->piece < other->piece ? -1 : one->piece > other->piece;
}

/* The pieces that are planes, the largest first. */
static size_t sort_planes(const plane_finder *f, sized_plane *out)
{
    size_t count = 0;
    for (uint32_t i = 0; i < f->pieces.count; i++)
        if (flat_piece_is_plane(&f->pieces.items[i]))
            out[count++] = (sized_plane){f->pieces.items[i].area, i};
    if (count)
        qsort(out, count, sizeof *out, by_area);
    return count;
}

/* `planes`: per piece, the plane in which it lies. */
static bool join_planes(plane_finder *f, plane_table *t, sized_plane *sorted, uint32_t *planes, field_planes *out)
{
    size_t count = sort_planes(f, sorted), size = 64;
    while (size < 2 * count)
        size *= 2;
    t->mask = size - 1;
    t->slots = mem_alloc(size * sizeof *t->slots);
    t->normals = mem_alloc(count * sizeof *t->normals);
    t->offsets = mem_alloc(count * sizeof *t->offsets);
    t->pieces = mem_alloc(count * sizeof *t->pieces);
    t->bent = mem_calloc(count, sizeof *t->bent);
    if (!t->slots || !t->normals || !t->offsets || !t->pieces || !t->bent)
        return false;
    memset(t->slots, 0xFF, size * sizeof *t->slots);
    for (size_t i = 0; i < count; i++) {
        const flat_piece *piece = &f->pieces.items[sorted[i].piece];
        point3            normal = canonical(normal_of(piece));
        double            offset = point_dot(normal, middle_of(f, piece));
        uint32_t          plane = find_plane(t, normal, offset);
        if (plane == NOWHERE)
            add_plane(t, plane = out->count++, sorted[i].piece, normal, offset);
        planes[sorted[i].piece] = plane;
        if (work_stopped())
            return false;
    }
    out->units = mem_alloc(out->count * sizeof *out->units);
    for (uint32_t k = 0; out->units && k < out->count; k++)
        out->units[k] = direction_of(f, &f->pieces.items[t->pieces[k]], &t->bent[k]);
    return out->units != NULL;
}

/* What lies nearly as a larger plane does is hatched the same way: a hand keeps its direction over a wall that turns a
 * little, and on all walls that face one way, unless it came there over a rounding. The largest planes come first. */
static void follow_larger(const plane_table *t, field_planes *out)
{
    uint32_t leaders[LEADERS_MOST], count = 0;
    for (uint32_t k = 0; k < out->count; k++) {
        bool follows = false;
        for (uint32_t i = 0; i < count && !follows && !t->bent[k]; i++) {
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
    plane_table  table = {0};
    uint32_t    *planes = mem_alloc(f->pieces.count * sizeof *planes);
    sized_plane *sorted = mem_alloc(f->pieces.count * sizeof *sorted);
    bool         good = planes && sorted;
    if (good) {
        memset(planes, 0xFF, f->pieces.count * sizeof *planes);
        good = join_planes(f, &table, sorted, planes, out);
        if (good)
            follow_larger(&table, out);
    }
    for (uint32_t t = 0; good && t < f->surface->triangle_count; t++)
        out->of[t] = planes[f->pieces.of[t]];
    void *const blocks[] = {planes, sorted, table.slots, table.normals, table.offsets, table.pieces, table.bent};
    for (size_t i = 0; i < sizeof blocks / sizeof *blocks; i++)
        mem_free(blocks[i]);
    return good;
}

bool field_planes_find(field_planes *out, const field_surface *s, const tensor *tensors, const bool *flat)
{
    plane_finder f = {.surface = s, .tensors = tensors, .flat = flat};
    out->of = mem_alloc(s->triangle_count * sizeof *out->of);
    bool good = out->of && find_pieces(&f) && find_planes(&f, out);
    flat_pieces_release(&f.pieces);
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
