/* Outlines of the surface that a mesh stands for: where the interpolated normal is at right angles to the view (Hertzmann and Zorin 2000). Across each face that has knots facing the eye and knots facing
 * away runs one straight piece, so that outlines of closed surfaces are closed and never run back and forth.
 *
 * Such an outline lies beside the mesh's own, on faces that may look away from the eye, and is covered by the very fold of the mesh that it is the edge of. That fold is told from all other surfaces by
 * lying next to it on the mesh: faces around it do not count. Where the surface is hollow along the view, as beyond the end of a fold, an outline of a body is always hidden, if only by its own neighbours. */
#include "stroke/form_view.h"

#include <math.h>
#include <stdlib.h>

#include "base/memory.h"

/* The fold: so many rings of faces around a face, as far as they come near it, in lengths of its longest edge. */
#define FOLD_REACH 2.0
enum { FOLD_RINGS = 3 };

typedef struct smoother {
    form_view *f;
    uint32_t  *stamps;   /* per face: the last one in whose fold it was found */
    size_t     capacity; /* of the ignored faces */
    size_t     count;
} smoother;

static double square_apart(double3 a, double3 b)
{
    return (a.x - b.x) * (a.x - b.x) + (a.y - b.y) * (a.y - b.y) + (a.z - b.z) * (a.z - b.z);
}

static bool is_near(const form_view *f, uint32_t face, double3 place, double square)
{
    for (uint32_t k = 0; k < 3; k++)
        if (square_apart(form_place(f, face, k), place) <= square)
            return true;
    return false;
}

static int compare_numbers(const void *a, const void *b)
{
    uint32_t p = *(const uint32_t *)a, q = *(const uint32_t *)b;
    return p < q ? -1 : p > q;
}

static bool put_ignored(smoother *w, uint32_t face)
{
    if (!mem_grow((void **)&w->f->out->ignored, &w->capacity, w->count + 1, sizeof *w->f->out->ignored))
        return false;
    w->f->out->ignored[w->count++] = face;
    return true;
}

/* Lists the faces of the fold behind those that are listed already. */
static bool put_fold(smoother *w, uint32_t face, double3 place)
{
    const form_view *f = w->f;
    size_t first = w->count, ring = first;
    double longest = 0;
    for (uint32_t k = 0; k < 3; k++)
        longest = fmax(longest, square_apart(form_place(f, face, k), form_place(f, face, k + 1)));
    w->stamps[face] = face + 1;
    if (!put_ignored(w, face))
        return false;
    for (int r = 0; r < FOLD_RINGS; r++) {
        size_t end = w->count;
        for (; ring < end; ring++)
            for (uint32_t k = 0; k < 3; k++) {
                uint32_t vertex = f->m->faces[f->out->ignored[ring]][k];
                for (uint32_t i = f->s->fan_starts[vertex]; i < f->s->fan_starts[vertex + 1]; i++) {
                    uint32_t other = f->s->fan_faces[i];
                    if (w->stamps[other] == face + 1)
                        continue;
                    w->stamps[other] = face + 1;
                    if (is_near(f, other, place, FOLD_REACH * FOLD_REACH * longest) && !put_ignored(w, other))
                        return false;
                }
            }
    }
    qsort(f->out->ignored + first, w->count - first, sizeof *f->out->ignored, compare_numbers);
    for (size_t i = first; i < w->count; i++)
        f->out->ignored[i] += f->v->items[f->index].first_face;
    return true;
}

/* Is the surface hollow along the view? By how the cosine grows towards the eye, over the plane of the face. */
static bool is_hollow(const form_view *f, uint32_t face, double3 place)
{
    double3 d = form_direction(f, place), p[3];
    for (uint32_t k = 0; k < 3; k++)
        p[k] = form_place(f, face, k);
    double ux = p[1].x - p[0].x, uy = p[1].y - p[0].y, uz = p[1].z - p[0].z, vx = p[2].x - p[0].x, vy = p[2].y - p[0].y, vz = p[2].z - p[0].z;
    double uu = ux * ux + uy * uy + uz * uz, uv = ux * vx + uy * vy + uz * vz, vv = vx * vx + vy * vy + vz * vz, ud = ux * d.x + uy * d.y + uz * d.z,
           vd = vx * d.x + vy * d.y + vz * d.z;
    const uint32_t *knots = f->s->corners[face];
    double du = f->facing[knots[1]] - f->facing[knots[0]], dv = f->facing[knots[2]] - f->facing[knots[0]];
    return du * (ud * vv - vd * uv) + dv * (vd * uu - ud * uv) < 0;
}

static bool put_piece(smoother *w, uint32_t face, form_end a, form_end b)
{
    form_view *f = w->f;
    size_t before = f->out->count, listed = w->count;
    uint32_t piece = f->m->pieces[face];
    if (!form_put(f, STROKE_CONTOUR, face, a, b, f->mirrored != (f->m->closed[piece] && f->m->inward[piece])))
        return false;
    if (f->out->count == before)
        return true;
    double3 middle = {0.5 * (a.place.x + b.place.x), 0.5 * (a.place.y + b.place.y), 0.5 * (a.place.z + b.place.z)};
    if (!put_fold(w, face, middle))
        return false;
    window_segment *s = &f->out->segments[before];
    s->ignored_count = (uint32_t)(w->count - listed);
    s->least = f->m->closed[piece] && is_hollow(f, face, middle);
    return true;
}

bool smooth_collect(form_view *f)
{
    smoother w = {.f = f, .stamps = mem_calloc((size_t)f->s->face_count + 1, sizeof *w.stamps)};
    for (size_t i = 0; i < f->out->count; i++)
        w.count += f->out->segments[i].ignored_count;
    w.capacity = w.count;
    bool good = w.stamps != NULL;
    for (uint32_t face = 0; face < f->s->face_count && good; face++) {
        const uint32_t *knots = f->s->corners[face];
        bool front[3];
        for (int k = 0; k < 3; k++)
            front[k] = f->facing[knots[k]] >= 0;
        if (front[0] == front[1] && front[1] == front[2])
            continue;
        form_end ends[2]; /* from where the winding passes from the front to the back to where it comes again: what is in front lies to the left */
        double share;
        for (uint32_t k = 0; k < 3; k++)
            if (front[k] != front[(k + 1) % 3])
                ends[front[k] ? 0 : 1] = form_cross(f, 3 * face + k, f->facing[knots[k]], f->facing[knots[(k + 1) % 3]], &share);
        good = put_piece(&w, face, ends[0], ends[1]);
    }
    mem_free(w.stamps);
    return good;
}
