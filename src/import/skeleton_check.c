/* What a skeleton is made of, and whether it is one. */
#include <math.h>

#include "base/memory.h"
#include "import/ring.h"
#include "import/skeleton.h"

static double turn(const double a[2], const double b[2], const double c[2])
{
    return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
}

static bool boxes_apart(const double a[2], const double b[2], const double c[2], const double d[2])
{
    for (int k = 0; k < 2; k++)
        if (fmax(a[k], b[k]) < fmin(c[k], d[k]) || fmax(c[k], d[k]) < fmin(a[k], b[k]))
            return true;
    return false;
}

/* Of a → b and c → d, which share no corner. */
static bool touch(const double a[2], const double b[2], const double c[2], const double d[2])
{
    if (boxes_apart(a, b, c, d))
        return false;
    double t1 = turn(a, b, c), t2 = turn(a, b, d), t3 = turn(c, d, a), t4 = turn(c, d, b);
    return t1 * t2 <= 0 && t3 * t4 <= 0;
}

/* Edge k, and the next one, run back on themselves. */
static bool is_spike(const double (*p)[2], const uint32_t *ends, uint32_t k)
{
    const double *a = p[k], *b = p[ends[k]], *c = p[ends[ends[k]]];
    double        dot = (b[0] - a[0]) * (c[0] - b[0]) + (b[1] - a[1]) * (c[1] - b[1]);
    return dot < 0 && fabs(turn(a, b, c)) <= -1e-7 * dot;
}

static double area_of(const double (*p)[2], size_t count)
{
    double area = 0;
    for (size_t i = 1; i + 1 < count; i++)
        area += turn(p[0], p[i], p[i + 1]) / 2;
    return area;
}

/* The outline runs anticlockwise, holes run clockwise and lie in it and not in each other. */
static bool are_nested(const double (*p)[2], const size_t *counts, size_t rings)
{
    size_t first = 0;
    for (size_t k = 0; k < rings; first += counts[k], k++) {
        double area = area_of(p + first, counts[k]);
        if (k == 0 ? !(area > 0) : !(area < 0))
            return false;
        size_t other = 0;
        for (size_t j = 0; j < rings && k > 0; other += counts[j], j++)
            if (j != k && ring_has(p + other, counts[j], p[first]) != (j == 0))
                return false;
    }
    return true;
}

bool skeleton_is_simple(const double (*positions)[2], const uint32_t *ends, const size_t *counts, size_t rings)
{
    uint32_t total = 0;
    for (size_t k = 0; k < rings; k++)
        total += (uint32_t)counts[k];
    for (uint32_t i = 0; i < total; i++) {
        if (is_spike(positions, ends, i) ||
            hypot(positions[i][0] - positions[ends[i]][0], positions[i][1] - positions[ends[i]][1]) == 0)
            return false;
        for (uint32_t k = i + 1; k < total; k++)
            if (ends[i] != k && ends[k] != i &&
                touch(positions[i], positions[ends[i]], positions[k], positions[ends[k]]))
                return false;
    }
    return are_nested(positions, counts, rings);
}

/* --- the result ----------------------------------------------------------------------------------------- */

typedef struct coverage {
    const skeleton *s;
    double          tolerance;
} coverage;

static double part(const skeleton_node *a, const skeleton_node *b)
{
    return (a->x * b->y - b->x * a->y) / 2;
}

/* Twice something must not be covered less elsewhere: no face has a negative area, and none leaves its plane. */
static bool face_fits(const coverage *c, uint32_t edge, double *area)
{
    const skeleton      *s = c->s;
    const skeleton_node *a = &s->nodes[edge], *b = &s->nodes[s->ends[edge]], *last = b;
    double               x = b->x - a->x, y = b->y - a->y, length = hypot(x, y);
    *area = part(a, b);
    for (uint32_t i = skeleton_face_first(s, edge); i < s->face_ends[edge]; i++) {
        const skeleton_node *n = &s->nodes[s->face_nodes[i]];
        double               height = (x * (n->y - a->y) - y * (n->x - a->x)) / length;
        if (!s->upright[edge] && !(fabs(height - n->time) <= c->tolerance * (1 + s->size / length * 0.01)))
            return false;
        *area += part(last, n);
        last = n;
    }
    *area += part(last, a);
    return *area > -c->tolerance * s->size;
}

bool skeleton_covers(const skeleton *s)
{
    coverage c = {s, 2e-4 * s->size};
    double   outline = 0, faces = 0;
    for (uint32_t i = 0; i < s->corner_count; i++) {
        double area;
        if (!face_fits(&c, i, &area))
            return false;
        outline += part(&s->nodes[i], &s->nodes[s->ends[i]]);
        faces += fabs(area);
    }
    return fabs(faces - outline) <= 1e-5 * outline + 1e-9 * s->size * s->size;
}
