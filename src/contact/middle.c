/* The middle of where two things touch: of the area between all places, of the line, of the point. */
#include <stdlib.h>

#include "base/error.h"
#include "base/memory.h"
#include "base/vector3.h"
#include "contact/touch_private.h"

/* In the plane that the normal is square to. */
typedef struct corner {
    double x, y;
} corner;

static int compare_corners(const void *a, const void *b)
{
    const corner *p = a, *q = b;
    return p->x != q->x ? (p->x > q->x) - (p->x < q->x) : (p->y > q->y) - (p->y < q->y);
}

static double turn(const corner *a, const corner *b, const corner *c)
{
    return (b->x - a->x) * (c->y - a->y) - (b->y - a->y) * (c->x - a->x);
}

/* Adds a corner to a convex chain that has `least` or more: those before it that it makes hollow go. */
static size_t add_to_chain(corner *chain, size_t count, size_t least, const corner *c)
{
    while (count > least && turn(&chain[count - 2], &chain[count - 1], c) <= 0)
        count--;
    chain[count] = *c;
    return count + 1;
}

/* The convex hull of sorted corners (Andrew 1979), its first one again at its end; `out` holds two for each. */
static size_t hull_of(const corner *sorted, size_t count, corner *out)
{
    size_t kept = 0;
    for (size_t i = 0; i < count; i++)
        kept = add_to_chain(out, kept, 1, &sorted[i]);
    const size_t below = kept;
    for (size_t i = count - 1; i-- > 0;)
        kept = add_to_chain(out, kept, below, &sorted[i]);
    return kept;
}

/* The corner that is farthest from one of them. */
static corner farthest_from(const corner *all, size_t count, corner from)
{
    double most = -1;
    corner best = from;
    for (size_t i = 0; i < count; i++) {
        const double far = (all[i].x - from.x) * (all[i].x - from.x) + (all[i].y - from.y) * (all[i].y - from.y);
        if (far > most) {
            most = far;
            best = all[i];
        }
    }
    return best;
}

/* Of a closed polygon, or of the line between two corners, as far apart as any, where it has no area. */
static corner middle_of(const corner *hull, size_t count, corner first, corner last)
{
    double area = 0, x = 0, y = 0;
    for (size_t i = 0; i + 1 < count; i++) {
        const double part = turn(&first, &hull[i], &hull[i + 1]);
        area += part;
        x += part * (first.x + hull[i].x + hull[i + 1].x) / 3;
        y += part * (first.y + hull[i].y + hull[i + 1].y) / 3;
    }
    const double wide = (last.x - first.x) * (last.x - first.x) + (last.y - first.y) * (last.y - first.y);
    return area > 1e-6 * wide ? (corner){x / area, y / area} : (corner){(first.x + last.x) / 2, (first.y + last.y) / 2};
}

static void axes_in_plane(const double normal[3], double x[3], double y[3])
{
    double least[3] = {0, 0, 0};
    int    k = fabs(normal[0]) < fabs(normal[1]) ? 0 : 1;
    k = fabs(normal[2]) < fabs(normal[k]) ? 2 : k;
    least[k] = 1;
    vector3_cross(x, normal, least);
    vector3_normalise(x);
    vector3_cross(y, normal, x);
}

lmn_status touch_middle(const touch_places *all, const double normal[3], double out[3], lmn_error *error)
{
    double  x[3], y[3], height = 0;
    size_t  count = 0;
    corner *corners = mem_alloc(3 * (all->count + 1) * sizeof *corners), *hull = corners + all->count + 1;
    if (!corners)
        return error_memory(error);
    axes_in_plane(normal, x, y);
    for (size_t i = 0; i < all->count; i++) {
        const touch_place *p = &all->items[i];
        if (vector3_dot(p->normal, normal) < 0.9999)
            continue;
        height += vector3_dot(p->own, normal);
        corners[count++] = (corner){vector3_dot(p->own, x), vector3_dot(p->own, y)};
    }
    qsort(corners, count, sizeof *corners, compare_corners);
    const corner first = farthest_from(corners, count, corners[0]), last = farthest_from(corners, count, first),
                 at = middle_of(hull, hull_of(corners, count, hull), first, last);
    for (int k = 0; k < 3; k++)
        out[k] = at.x * x[k] + at.y * y[k] + height / (double)count * normal[k];
    mem_free(corners);
    return LMN_OK;
}
