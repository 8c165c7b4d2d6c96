#include "draft/faces.h"

#include <math.h>
#include <stdlib.h>

#include "base/memory.h"
#include "base/vector3.h"

static const double turn_most = 0.7; /* radians, 40°: a step of nine to the circle; six are a prism */

typedef struct half {
    uint32_t low, high, corner; /* corner: 3 · face + number of the corner */
} half;

static int compare_halves(const void *a, const void *b)
{
    const half *x = a, *y = b;
    if (x->low != y->low)
        return x->low < y->low ? -1 : 1;
    if (x->high != y->high)
        return x->high < y->high ? -1 : 1;
    return x->corner < y->corner ? -1 : x->corner > y->corner;
}

/* In double precision: of flat cylinders with many sides neighbours hardly differ. */
static void find_normal(double out[3], const edge_mesh *m, uint32_t face)
{
    double p[3][3], a[3], b[3];
    for (int k = 0; k < 3; k++) {
        vec3 v = m->positions[m->faces[face][k]];
        vector3_set(p[k], (double)v.x, (double)v.y, (double)v.z);
    }
    vector3_add(a, p[1], -1, p[0]);
    vector3_add(b, p[2], -1, p[0]);
    vector3_cross(out, a, b);
    if (!vector3_normalise(out))
        vector3_set(out, 0, 0, 0);
    /* Faces of solids are turned to look outwards of the solid. */
    vec3 known = m->normals[face];
    if ((double)known.x * out[0] + (double)known.y * out[1] + (double)known.z * out[2] < 0)
        for (int k = 0; k < 3; k++)
            out[k] = -out[k];
}

double draft_faces_turn(const draft_faces *f, uint32_t a, uint32_t b)
{
    return acos(fmin(fmax(vector3_dot(f->normals[a], f->normals[b]), -1), 1));
}

/* Edges that are lines of their own part what is beside them. */
static void part_at_lines(draft_faces *f, const edge_mesh *m)
{
    for (uint32_t e = 0; e < m->edge_count; e++) {
        const mesh_edge *edge = &m->edges[e];
        if (!(edge->flags & (EDGE_CREASE | EDGE_BORDER)))
            continue;
        for (int side = 0; side < 2; side++)
            for (size_t k = 0; k < 3 && edge->face[side] != EDGE_NO_FACE; k++) {
                const uint32_t *v = m->faces[edge->face[side]];
                uint32_t        a = v[k], b = v[(k + 1) % 3];
                if ((a == edge->vertex[0] && b == edge->vertex[1]) || (a == edge->vertex[1] && b == edge->vertex[0]))
                    f->beside[3 * (size_t)edge->face[side] + k] = EDGE_NO_FACE;
            }
    }
}

lmn_status draft_faces_make(draft_faces *out, const edge_mesh *m, lmn_error *error)
{
    size_t count = 3 * (size_t)m->face_count;
    half  *halves = mem_alloc((count + 1) * sizeof *halves);
    out->normals = mem_alloc(((size_t)m->face_count + 1) * sizeof *out->normals);
    out->beside = mem_alloc((count + 1) * sizeof *out->beside);
    if (!halves || !out->normals || !out->beside) {
        mem_free(halves);
        return error_memory(error);
    }
    for (uint32_t i = 0; i < m->face_count; i++) {
        find_normal(out->normals[i], m, i);
        for (uint32_t k = 0; k < 3; k++) {
            uint32_t a = m->faces[i][k], b = m->faces[i][(k + 1) % 3];
            halves[3 * (size_t)i + k] = (half){a < b ? a : b, a < b ? b : a, 3 * i + k};
            out->beside[3 * (size_t)i + k] = EDGE_NO_FACE;
        }
    }
    if (count)
        qsort(halves, count, sizeof *halves, compare_halves);
    for (size_t i = 0, end; i < count; i = end) {
        for (end = i + 1; end < count && halves[end].low == halves[i].low && halves[end].high == halves[i].high; end++)
            ;
        uint32_t a = halves[i].corner, b = end - i == 2 ? halves[i + 1].corner : a;
        if (a == b || draft_faces_turn(out, a / 3, b / 3) > turn_most)
            continue;
        out->beside[a] = b / 3;
        out->beside[b] = a / 3;
    }
    part_at_lines(out, m);
    mem_free(halves);
    return LMN_OK;
}

void draft_faces_release(draft_faces *f)
{
    mem_free(f->normals);
    mem_free(f->beside);
    *f = (draft_faces){NULL, NULL};
}
