/* Outlines of the surface that a mesh stands for: where the interpolated normal is at right angles to the view
 * (Hertzmann and Zorin 2000). Across each face that has knots facing the eye and knots facing away runs one straight
 * piece, so that outlines of closed surfaces are closed and never run back and forth.
 *
 * Such an outline lies beside the mesh's own, on faces that may look away from the eye, and is covered by the very fold
 * of the mesh that it is the edge of. That fold is told from all other surfaces by lying next to it on the mesh: faces
 * around it do not count. Where the surface is hollow along the view, as beyond the end of a fold, an outline of a body
 * is always hidden, if only by its own neighbours; of what is open only the nearest faces do not count there. */
#include "stroke/form_view.h"

#include <math.h>
#include <stdlib.h>

#include "base/memory.h"

/* The fold reaches so far, in lengths of the longest edge of the face. */
#define FOLD_REACH 2.0
/* Cosine below which a knot may be an island. */
#define ISLAND 0.15
enum { FOLD_RINGS = 32 };

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

static bool is_near(const form_view *f, uint32_t face, double3 position, double square)
{
    for (uint32_t k = 0; k < 3; k++)
        if (square_apart(form_position(f, face, k), position) <= square)
            return true;
    return false;
}

/* Is the face at most as far from grazing, somewhere, as that? */
static bool is_grazed(const form_view *f, uint32_t face, double most)
{
    for (int k = 0; k < 3; k++)
        if (fabs(f->facing[f->s->corners[face][k]]) <= most)
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

/* Lists the faces of the fold behind those that are listed already: all that touch the face, and on from them those
 * that are seen as steeply as these. */
static bool put_fold(smoother *w, uint32_t face, double3 position, int rings)
{
    const form_view *f = w->f;
    size_t           first = w->count, ring = first;
    double           longest = 0, most = 0;
    for (uint32_t k = 0; k < 3; k++)
        longest = fmax(longest, square_apart(form_position(f, face, k), form_position(f, face, k + 1)));
    w->stamps[face] = face + 1;
    if (!put_ignored(w, face))
        return false;
    for (int r = 0; r < rings; r++) {
        size_t end = w->count;
        for (size_t i = first; i < end && r == 1; i++)
            for (int k = 0; k < 3; k++)
                most = fmax(most, fabs(f->facing[f->s->corners[f->out->ignored[i]][k]]));
        for (; ring < end; ring++)
            for (uint32_t k = 0; k < 3; k++) {
                uint32_t vertex = f->m->faces[f->out->ignored[ring]][k];
                for (uint32_t i = f->s->fan_starts[vertex]; i < f->s->fan_starts[vertex + 1]; i++) {
                    uint32_t other = f->s->fan_faces[i];
                    if (w->stamps[other] == face + 1)
                        continue;
                    w->stamps[other] = face + 1;
                    bool belongs = r == 0 || (is_grazed(f, other, most) &&
                                              is_near(f, other, position, FOLD_REACH * FOLD_REACH * longest));
                    if (belongs && !put_ignored(w, other))
                        return false;
                }
            }
    }
    qsort(f->out->ignored + first, w->count - first, sizeof *f->out->ignored, compare_numbers);
    for (size_t i = first; i < w->count; i++)
        f->out->ignored[i] += f->v->items[f->index].first_face;
    return true;
}

/* How the cosine between normal and view grows towards the eye over a face, times its area. */
static double growth_over(const form_view *f, uint32_t face, double3 d)
{
    double3 p[3];
    for (uint32_t k = 0; k < 3; k++)
        p[k] = form_position(f, face, k);
    double ux = p[1].x - p[0].x, uy = p[1].y - p[0].y, uz = p[1].z - p[0].z, vx = p[2].x - p[0].x, vy = p[2].y - p[0].y,
           vz = p[2].z - p[0].z;
    double uu = ux * ux + uy * uy + uz * uz, uv = ux * vx + uy * vy + uz * vz, vv = vx * vx + vy * vy + vz * vz,
           ud = ux * d.x + uy * d.y + uz * d.z, vd = vx * d.x + vy * d.y + vz * d.z, square = uu * vv - uv * uv;
    const uint32_t *knots = f->s->corners[face];
    double          du = f->facing[knots[1]] - f->facing[knots[0]], dv = f->facing[knots[2]] - f->facing[knots[0]];
    return square > 0 ? (du * (ud * vv - vd * uv) + dv * (vd * uu - ud * uv)) / sqrt(square) : 0;
}

/* Is the surface hollow along the view? There the cosine falls towards the eye. All faces around decide together,
 * because narrow ones are easily mistaken. */
bool form_is_hollow(const form_view *f, uint32_t face, double3 position)
{
    double3 d = form_direction(f, position);
    double  sum = 0;
    for (uint32_t k = 0; k < 3; k++) {
        uint32_t vertex = f->m->faces[face][k];
        for (uint32_t i = f->s->fan_starts[vertex]; i < f->s->fan_starts[vertex + 1]; i++)
            sum += growth_over(f, f->s->fan_faces[i], d);
    }
    return sum < 0;
}

static bool put_piece(smoother *w, uint32_t face, form_end a, form_end b)
{
    form_view *f = w->f;
    size_t     before = f->out->count, listed = w->count;
    uint32_t   piece = f->m->pieces[face];
    if (!form_put(f, STROKE_CONTOUR, face, a, b, f->mirrored != (f->m->closed[piece] && f->m->inward[piece])))
        return false;
    if (f->out->count == before)
        return true;
    double3 middle = {0.5 * (a.position.x + b.position.x), 0.5 * (a.position.y + b.position.y),
                      0.5 * (a.position.z + b.position.z)};
    bool    hollow = form_is_hollow(f, face, middle);
    if (!put_fold(w, face, middle, hollow ? 1 : FOLD_RINGS))
        return false;
    window_segment *s = &f->out->segments[before];
    s->ignored_count = (uint32_t)(w->count - listed);
    s->least = f->m->closed[piece] && hollow;
    return true;
}

/* A single knot that barely turns to the other side than all around it is noise: it is taken to turn as they do. */
static bool calm_islands(form_view *f)
{
    uint8_t *has_friend = mem_calloc((size_t)f->s->knot_count + 1, 1);
    for (uint32_t h = 0; has_friend && h < 3 * f->s->face_count; h++) {
        uint32_t a = f->s->corners[h / 3][h % 3], b = f->s->corners[h / 3][(h + 1) % 3];
        if ((f->facing[a] >= 0) == (f->facing[b] >= 0))
            has_friend[a] = has_friend[b] = 1;
    }
    for (uint32_t i = 0; has_friend && i < f->s->knot_count; i++)
        if (!has_friend[i] && fabs(f->facing[i]) < ISLAND)
            f->facing[i] *= -0.01;
    bool good = has_friend != NULL;
    mem_free(has_friend);
    return good;
}

bool form_outline(form_view *f, uint32_t face, form_end ends[2])
{
    const uint32_t *knots = f->s->corners[face];
    bool            front[3];
    double          fraction;
    for (int k = 0; k < 3; k++)
        front[k] = f->facing[knots[k]] >= 0;
    if (front[0] == front[1] && front[1] == front[2])
        return false;
    for (uint32_t k = 0; k < 3; k++)
        if (front[k] != front[(k + 1) % 3])
            ends[front[k] ? 0 : 1] =
                form_cross(f, 3 * face + k, f->facing[knots[k]], f->facing[knots[(k + 1) % 3]], &fraction);
    return true;
}

bool smooth_collect(form_view *f)
{
    smoother w = {.f = f, .stamps = mem_calloc((size_t)f->s->face_count + 1, sizeof *w.stamps)};
    for (size_t i = 0; i < f->out->count; i++)
        w.count += f->out->segments[i].ignored_count;
    w.capacity = w.count;
    bool good = w.stamps && calm_islands(f);
    for (uint32_t face = 0; face < f->s->face_count && good; face++) {
        form_end ends[2];
        good = !form_outline(f, face, ends) || put_piece(&w, face, ends[0], ends[1]);
    }
    mem_free(w.stamps);
    return good;
}
