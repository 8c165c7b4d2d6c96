/* Which triangles of a view lie inside of a surface: seen from the same side, another one goes on beyond each of their
 * edges. Where such a triangle ends in front of a line, the next one begins at the very same place, so that the number
 * of surfaces in front changes at rims alone (Appel 1967). */
#include "stroke/stroke_private.h"

#include <string.h>

#include "base/memory.h"

/* Does a triangle pass the edge from p to q from q to p? */
static bool passes_back(const window_triangle *t, uint32_t p, uint32_t q)
{
    return (t->v[0] == q && t->v[1] == p) | (t->v[1] == q && t->v[2] == p) | (t->v[2] == q && t->v[0] == p);
}

/* Is it a face as it is, and not what the window has left of one? */
static bool is_whole(const stroke_view *v, const window_triangle *t)
{
    return t->v[0] < v->vertex_count && t->v[1] < v->vertex_count && t->v[2] < v->vertex_count;
}

/* Of an item's triangles from `first` to `end`; `of_faces`, a number for each of the mesh's faces, is used up. */
static void find_beyond(stroke_view *v, size_t item, size_t first, size_t end, uint32_t *of_faces)
{
    const edge_mesh *m = &v->scene->meshes[v->scene->items[item].mesh];
    const uint32_t   first_face = v->items[item].first_face;
    memset(of_faces, 0xFF, (size_t)m->face_count * sizeof *of_faces); /* NO_TRIANGLE */
    for (size_t i = first; i < end; i++)
        if (is_whole(v, &v->triangles[i]))
            of_faces[v->triangles[i].face - first_face] = (uint32_t)i;
    for (size_t i = first; i < end; i++) {
        const window_triangle *t = &v->triangles[i];
        for (uint32_t k = 0; k < 3 && is_whole(v, t); k++) {
            const uint32_t half = 3 * (t->face - first_face) + k, other = m->opposite[half],
                           beyond = other == EDGE_NO_FACE ? NO_TRIANGLE : of_faces[other / 3];
            if (beyond != NO_TRIANGLE && view_is_front(v, v->triangles[beyond].face) == view_is_front(v, t->face) &&
                passes_back(&v->triangles[beyond], t->v[k], t->v[k == 2 ? 0 : k + 1]))
                v->beyond[i][k] = beyond;
        }
    }
}

bool inner_find(stroke_view *v)
{
    size_t most = 0, at = 0;
    for (size_t i = 0; i < v->scene->item_count; i++) {
        const size_t faces = v->scene->meshes[v->scene->items[i].mesh].face_count;
        most = faces > most ? faces : most;
    }
    uint32_t *of_faces = mem_alloc((most + 1) * sizeof *of_faces);
    v->beyond = mem_alloc((v->triangle_count + 1) * sizeof *v->beyond);
    if (v->beyond)
        memset(v->beyond, 0xFF, v->triangle_count * sizeof *v->beyond);          /* NO_TRIANGLE */
    for (size_t i = 0; i < v->scene->item_count && of_faces && v->beyond; i++) { /* whose triangles are in order */
        const size_t     first = at;
        const edge_mesh *m = &v->scene->meshes[v->scene->items[i].mesh];
        while (at < v->triangle_count && v->triangles[at].face < v->items[i].first_face + m->face_count)
            at++;
        if (m->opposite && !m->solid)
            find_beyond(v, i, first, at, of_faces);
    }
    mem_free(of_faces);
    return of_faces && v->beyond;
}
