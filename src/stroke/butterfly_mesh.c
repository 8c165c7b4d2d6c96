#include "stroke/butterfly_mesh.h"

#include "stroke/drawn.h"

#include <math.h>
#include <string.h>

#include "base/memory.h"

/* Levels of so few faces are searched whole. */
enum { ALL_FACES_OF = 16384 };

void edge_refinement_destroy(edge_refinement **r)
{
    if (!*r)
        return;
    butterfly_release(&(*r)->surface);
    mem_free((*r)->faces);
    mem_free((*r)->edges);
    mem_free(*r);
    *r = NULL;
}

static uint8_t said_of(const edge_mesh *m, uint32_t h)
{
    return m->said ? m->said[h] : SAID_NOTHING;
}

/* Which edges stay sharp: creases, and what the file says of others. Half-edges are paired for it first. */
static lmn_status find_sharp(const edge_mesh *m, uint8_t *sharp, lmn_error *error)
{
    butterfly  coarse;
    lmn_status status = butterfly_refine(&coarse, m->positions, m->vertex_count, (const uint32_t(*)[3])m->faces,
                                         m->face_count, NULL, 0, error);
    if (status != LMN_OK)
        return status;
    for (uint32_t h = 0; h < 3 * m->face_count; h++) {
        uint8_t said = said_of(m, h);
        sharp[h] = said == SAID_HARD || said == SAID_REPEATED || said >= EDGE_TURNED;
    }
    for (uint32_t i = 0; i < m->edge_count; i++) {
        const mesh_edge *e = &m->edges[i];
        for (uint32_t h = 3 * e->face[0]; (e->flags & EDGE_CREASE) && h < 3 * e->face[0] + 3; h++) {
            if (m->faces[e->face[0]][h % 3] != e->vertex[0])
                continue;
            sharp[h] = 1;
            if (coarse.levels[0].opposite[h] != BUTTERFLY_NONE)
                sharp[coarse.levels[0].opposite[h]] = 1;
        }
    }
    butterfly_release(&coarse);
    return LMN_OK;
}

/* What is said of the last level's edges: halves take over from whole ones, and what stays sharp is hard; of edges
 * inside old faces nothing is said. */
static uint8_t *carry_sayings(const edge_mesh *m, const butterfly *b)
{
    uint8_t *said = mem_alloc((size_t)m->face_count * 3);
    for (uint32_t h = 0; said && h < 3 * m->face_count; h++) {
        bool is_crease = b->levels[0].sharp[h] && b->levels[0].opposite[h] != BUTTERFLY_NONE;
        said[h] = said_of(m, h);
        if (is_crease && said[h] == SAID_NOTHING)
            said[h] = SAID_HARD;
    }
    for (uint32_t i = 0; said && i + 1 < b->level_count; i++) {
        size_t   halves = (size_t)b->levels[i].face_count * 3;
        uint8_t *finer = mem_alloc(4 * halves);
        if (finer)
            memset(finer, SAID_NOTHING, 4 * halves);
        for (uint32_t h = 0; finer && h < halves; h++)
            finer[half_edge_first(h)] = finer[half_edge_second(h)] = said[h];
        mem_free(said);
        said = finer;
    }
    return said;
}

static int32_t *carry_materials(const edge_mesh *m, const butterfly *b)
{
    const butterfly_level *last = &b->levels[b->level_count - 1];
    int32_t               *out = mem_alloc(last->face_count * sizeof *out);
    for (uint32_t f = 0; out && f < last->face_count; f++)
        out[f] = m->materials[f >> 2 * (b->level_count - 1)];
    return out;
}

/* Both half-edges of each edge of the mesh learn its number. */
static bool number_edges(edge_refinement *r, const edge_mesh *m)
{
    const butterfly_level *last = &r->surface.levels[r->surface.level_count - 1];
    uint32_t              *origins = mem_alloc((size_t)m->face_count * sizeof *origins);
    size_t                 halves = (size_t)last->face_count * 3;
    r->edges = mem_alloc(halves * sizeof *r->edges);
    bool good = origins && r->edges;
    if (good)
        memset(r->edges, 0xFF, halves * sizeof *r->edges);
    for (uint32_t f = 0; f < last->face_count && good; f++)
        if (r->faces[f] != EDGE_NO_FACE)
            origins[r->faces[f]] = f;
    for (uint32_t i = 0; i < m->edge_count && good; i++) {
        const mesh_edge *e = &m->edges[i];
        uint32_t         f = origins[e->face[0]], h = 3 * f;
        while (h < 3 * f + 2 && last->faces[f][h % 3] != e->vertex[0])
            h++;
        r->edges[h] = i;
        if (last->opposite[h] != BUTTERFLY_NONE)
            r->edges[last->opposite[h]] = i;
    }
    mem_free(origins);
    return good;
}

/* The mesh of the last level. */
static lmn_status make_finer(edge_mesh *finer, const edge_mesh *m, edge_refinement *r, lmn_error *error)
{
    const butterfly       *b = &r->surface;
    const butterfly_level *last = &b->levels[b->level_count - 1];
    uint8_t               *said = carry_sayings(m, b);
    int32_t               *materials = m->materials ? carry_materials(m, b) : NULL;
    r->faces = mem_alloc(last->face_count * sizeof *r->faces);
    lmn_status   status = said && r->faces && (materials || !m->materials) ? LMN_OK : error_memory(error);
    edge_faces   in = {b->positions,    (const uint32_t(*)[3])last->faces, materials, said, last->vertex_count,
                       last->face_count};
    const double none_by_angle = 3.14159265358979323846; /* what is sharp has been said */
    if (status == LMN_OK)
        status = edge_mesh_create_from(finer, &in, none_by_angle, r->faces, error);
    mem_free(said);
    mem_free(materials);
    if (status == LMN_OK && !number_edges(r, finer)) {
        edge_mesh_release(finer);
        status = error_memory(error);
    }
    return status;
}

lmn_status edge_mesh_refine(edge_mesh *m, int steps, lmn_error *error)
{
    if (steps <= 0 || m->face_count == 0)
        return LMN_OK;
    edge_refinement *r = mem_calloc(1, sizeof *r);
    uint8_t         *sharp = mem_alloc((size_t)m->face_count * 3);
    edge_mesh        finer = {0};
    lmn_status       status = r && sharp ? find_sharp(m, sharp, error) : error_memory(error);
    if (status == LMN_OK)
        status = butterfly_refine(&r->surface, m->positions, m->vertex_count, (const uint32_t(*)[3])m->faces,
                                  m->face_count, sharp, steps, error);
    if (status == LMN_OK)
        status = make_finer(&finer, m, r, error);
    if (status == LMN_OK && (!drawn_copy(&finer, m) || !drawn_close(&finer))) { /* vertices keep their numbers */
        edge_mesh_release(&finer);
        status = error_memory(error);
    }
    mem_free(sharp);
    if (status != LMN_OK) {
        if (r)
            edge_refinement_destroy(&r);
        return status;
    }
    edge_mesh_release(m);
    *m = finer;
    m->refinement = r;
    return LMN_OK;
}

lmn_status edge_mesh_silhouette(const edge_mesh *m, propagate_front is_front, void *user, uint8_t *marks,
                                uint64_t *tested, lmn_error *error)
{
    const edge_refinement *r = m->refinement;
    silhouette             s;
    lmn_status             status = silhouette_propagate(&s, &r->surface, ALL_FACES_OF, is_front, user, error);
    if (status != LMN_OK)
        return status;
    memset(marks, 0, m->edge_count);
    for (size_t i = 0; i < s.count; i++)
        if (r->edges[s.halves[i]] != BUTTERFLY_NONE)
            marks[r->edges[s.halves[i]]] = 1;
    for (uint32_t i = 0; i < r->surface.level_count && tested; i++)
        *tested = (i ? *tested : 0) + s.tested[i];
    silhouette_release(&s);
    return LMN_OK;
}
