/* Planes of a coarse mesh. Where a bevel is joined smoothly with a wide face, normals at the rim lean over to the
 * bevel, and edges across the face would bulge with them. What such a face is can be seen by its neighbours: they are
 * small. */

#include "base/memory.h"
#include "scene/flat_pieces.h"
#include "scene/round_private.h"

/* All triangles of all primitives. */
typedef struct all_triangles {
    double (*normals)[3];
    double   *areas, *lengths;
    uint32_t *opposite, *firsts; /* per half-edge; per primitive: its first triangle */
} all_triangles;

static void measure_triangle(all_triangles *to, uint32_t t, const primitive *p, const uint32_t corners[3])
{
    double at[3][3], one[3], two[3];
    for (int k = 0; k < 3; k++)
        point_of(at[k], p->positions[corners[k]]);
    for (int k = 0; k < 3; k++)
        to->lengths[3 * (size_t)t + (size_t)k] = vector3_distance(at[k], at[(k + 1) % 3]);
    vector3_add(one, at[1], -1, at[0]);
    vector3_add(two, at[2], -1, at[0]);
    vector3_cross(to->normals[t], one, two);
    to->areas[t] = vector3_length(to->normals[t]) / 2;
    if (!vector3_normalise(to->normals[t]))
        vector3_set(to->normals[t], 0, 0, 0);
}

/* Do both sides have the same normals at both ends? */
static bool goes_on(const rounding *r, const half_edge *one, const half_edge *other)
{
    const double SAME = 0.98; /* as far as edges are creases for the rounding */
    for (int end = 0; end < 2; end++) {
        const half_edge *sides[2] = {one, other};
        double           normals[2][3];
        for (int k = 0; k < 2; k++) {
            const growing  *g = &r->parts[sides[k]->primitive];
            const uint32_t *i = g->made.indices, h = sides[k]->corner;
            bool            first = g->positions[i[h]] == (uint32_t)(end ? one->ends : one->ends >> 32);
            point_of(normals[k], g->made.normals[first ? i[h] : i[next_corner(h)]]);
        }
        if (vector3_dot(normals[0], normals[1]) < SAME)
            return false;
    }
    return true;
}

/* Edges of just two triangles. */
static void find_opposite(all_triangles *to, const rounding *r)
{
    for (size_t i = 0, count; i < r->half_count; i += count) {
        for (count = 1; i + count < r->half_count && r->halves[i + count].ends == r->halves[i].ends;)
            count++;
        if (count != 2 || !goes_on(r, &r->halves[i], &r->halves[i + 1]))
            continue;
        for (size_t k = 0; k < 2; k++) {
            const half_edge *own = &r->halves[i + k], *other = &r->halves[i + 1 - k];
            to->opposite[3 * (size_t)to->firsts[own->primitive] + own->corner] =
                3 * to->firsts[other->primitive] + other->corner;
        }
    }
}

/* Hands out which triangle lies in which plane; false when memory is gone. */
static bool hand_out(rounding *r, const flat_pieces *pieces, const all_triangles *all)
{
    r->planes = mem_alloc(pieces->count * sizeof *r->planes + 1);
    if (!r->planes)
        return false;
    for (size_t k = 0; k < pieces->count; k++)
        vector3_copy(r->planes[k], pieces->items[k].normal);
    for (size_t i = 0; i < r->part_count; i++) {
        growing *g = &r->parts[i];
        g->planes = mem_alloc(g->made.index_count / 3 * sizeof *g->planes + 1);
        if (!g->planes)
            return false;
        for (uint32_t t = 0; t < g->made.index_count / 3; t++) {
            uint32_t piece = pieces->of[all->firsts[i] + t];
            g->planes[t] = flat_piece_is_plane(&pieces->items[piece]) ? piece : NOWHERE;
        }
    }
    return true;
}

static bool find_planes(rounding *r, all_triangles *all, uint32_t count)
{
    for (uint32_t h = 0; h < 3 * count; h++)
        all->opposite[h] = UINT32_MAX;
    uint32_t next = 0;
    for (size_t i = 0; i < r->part_count; i++) {
        const primitive *p = &r->parts[i].made;
        all->firsts[i] = next;
        for (uint32_t c = 0; c < p->index_count; c += 3)
            measure_triangle(all, next++, p, &p->indices[c]);
    }
    find_opposite(all, r);
    flat_pieces pieces;
    bool        good = flat_pieces_find(&pieces, &(flat_triangles){.count = count,
                                                                   .normals = (const double(*)[3])all->normals,
                                                                   .areas = all->areas,
                                                                   .lengths = all->lengths,
                                                                   .opposite = all->opposite}) &&
                hand_out(r, &pieces, all);
    flat_pieces_release(&pieces);
    return good;
}

lmn_status round_planes_find(rounding *r, lmn_error *error)
{
    size_t count = 0;
    for (size_t i = 0; i < r->part_count; i++)
        count += r->parts[i].made.index_count / 3;
    if (count >= UINT32_MAX / 3)
        return error_set(error, LMN_LIMIT, "a mesh with %zu triangles cannot be made round", count);
    all_triangles all = {.normals = mem_alloc(count * sizeof *all.normals + 1),
                         .areas = mem_alloc(count * sizeof *all.areas + 1),
                         .lengths = mem_alloc(3 * count * sizeof *all.lengths + 1),
                         .opposite = mem_alloc(3 * count * sizeof *all.opposite + 1),
                         .firsts = mem_alloc(r->part_count * sizeof *all.firsts + 1)};
    bool          good =
        all.normals && all.areas && all.lengths && all.opposite && all.firsts && find_planes(r, &all, (uint32_t)count);
    void *const blocks[] = {all.normals, all.areas, all.lengths, all.opposite, all.firsts};
    for (size_t i = 0; i < sizeof blocks / sizeof *blocks; i++)
        mem_free(blocks[i]);
    return good ? LMN_OK : error_memory(error);
}
