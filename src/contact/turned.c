#include "contact/turned.h"

#include "base/vector3.h"

static const double TURN = 6.283185307179586;

/* Lengths that differ by less, of the whole size, are the same. */
static const double EXACT = 1e-4;

void turned_rim(const turned *t, double angle, int end, double out[3])
{
    vector3_copy(out, t->base);
    out[(t->axis + 1) % 3] += t->radii[end] * cos(angle);
    out[(t->axis + 2) % 3] += t->radii[end] * sin(angle);
    out[t->axis] += end ? t->height : 0;
}

double turned_slope(const turned *t)
{
    return (t->radii[0] - t->radii[1]) / t->height;
}

void turned_own(const turned *t, const double at[3], double out[3])
{
    for (int k = 0; k < 3; k++)
        out[k] = at[(t->axis + 1 + k) % 3] - t->base[(t->axis + 1 + k) % 3];
}

static void position_of(const primitive *p, uint32_t i, double out[3])
{
    vector3_set(out, (double)p->positions[i].x, (double)p->positions[i].y, (double)p->positions[i].z);
}

/* The vertex that is farthest by a measure: across from a point, or from a line through two. */
static uint32_t farthest(const primitive *p, int axis, const double from[3], const double *to)
{
    const int u = (axis + 1) % 3, v = (axis + 2) % 3;
    double    most = -1;
    uint32_t  best = 0;
    for (uint32_t i = 0; i < p->vertex_count; i++) {
        double at[3];
        position_of(p, i, at);
        const double x = at[u] - from[u], y = at[v] - from[v],
                     far = to ? fabs(x * (to[v] - from[v]) - y * (to[u] - from[u])) : x * x + y * y;
        if (far > most) {
            most = far;
            best = i;
        }
    }
    return best;
}

/* The middle of the circle through three of its outermost vertices, across the axis; false: they are in a line. */
static bool find_middle(turned *t, const primitive *p)
{
    const int u = (t->axis + 1) % 3, v = (t->axis + 2) % 3;
    double    middle[3], a[3], b[3], c[3];
    box3_middle(p->bounds, middle);
    position_of(p, farthest(p, t->axis, middle, NULL), a);
    position_of(p, farthest(p, t->axis, a, NULL), b);
    position_of(p, farthest(p, t->axis, a, b), c);
    const double bx = b[u] - a[u], by = b[v] - a[v], cx = c[u] - a[u], cy = c[v] - a[v], area = 2 * (bx * cy - by * cx),
                 bb = bx * bx + by * by, cc = cx * cx + cy * cy;
    if (!(fabs(area) > 1e-3 * (bb + cc)))
        return false;
    t->base[u] = a[u] + (cy * bb - by * cc) / area;
    t->base[v] = a[v] + (bx * cc - cx * bb) / area;
    return true;
}

/* Which end a vertex lies at, and how far from the axis; false: at none. */
static bool end_of(const turned *t, const double own[3], int *end, double *far)
{
    const double same = EXACT * (t->height + t->radii[0] + t->radii[1]);
    *far = sqrt(own[0] * own[0] + own[1] * own[1]);
    *end = own[2] > t->height / 2;
    return fabs(own[2] - (*end ? t->height : 0)) <= same;
}

static bool find_radii(turned *t, const primitive *p)
{
    for (uint32_t i = 0; i < p->vertex_count; i++) {
        double at[3], own[3], far;
        int    end;
        position_of(p, i, at);
        turned_own(t, at, own);
        if (!end_of(t, own, &end, &far))
            return false;
        t->radii[end] = fmax(t->radii[end], far);
    }
    const double size = t->height + fmax(t->radii[0], t->radii[1]);
    for (int end = 0; end < 2; end++)
        t->radii[end] = t->radii[end] <= EXACT * size ? 0 : t->radii[end];
    return t->radii[0] > 0 || t->radii[1] > 0;
}

/* Is a normal that of an end, or of the side? */
static bool normal_fits(const turned *t, const double own[3], double far, const vec3 *given)
{
    const double n[3] = {(double)given->x, (double)given->y, (double)given->z}, k = turned_slope(t);
    const double along = n[t->axis],
                 across = (n[(t->axis + 1) % 3] * own[0] + n[(t->axis + 2) % 3] * own[1]) / fmax(far, 1e-300);
    return fabs(along) > 0.99 || (far <= 0 ? true : fabs(across + k * along) > 0.99 * sqrt(1 + k * k));
}

/* Do all vertices lie on the rims, all around, or in the middles, with normals that fit? */
static bool lies_on(const turned *t, const primitive *p)
{
    enum { SECTORS = 8 };
    bool         seen[2][SECTORS] = {{false}};
    const double same = EXACT * (t->height + t->radii[0] + t->radii[1]);
    for (uint32_t i = 0; i < p->vertex_count; i++) {
        double at[3], own[3], far;
        int    end;
        position_of(p, i, at);
        turned_own(t, at, own);
        end_of(t, own, &end, &far);
        const bool middle = far <= same;
        if (!middle && fabs(far - t->radii[end]) > same)
            return false;
        if (p->normals && !normal_fits(t, own, middle ? 0 : far, &p->normals[i]))
            return false;
        seen[end][(int)fmin((atan2(own[1], own[0]) / TURN + 0.5) * SECTORS, SECTORS - 1)] |= !middle;
    }
    for (int end = 0; end < 2; end++)
        for (int k = 0; k < SECTORS; k++)
            if (t->radii[end] > 0 && !seen[end][k])
                return false;
    return true;
}

/* Does it enclose what the shape does, but for what flat faces cut off? */
static bool encloses(const turned *t, const primitive *p)
{
    const double *r = t->radii, whole = TURN / 6 * t->height * (r[0] * r[0] + r[0] * r[1] + r[1] * r[1]);
    double        volume = 0;
    for (uint32_t i = 0; i + 2 < p->index_count; i += 3) {
        double c[3][3], cross[3];
        for (uint32_t k = 0; k < 3; k++) {
            double at[3];
            position_of(p, p->indices[i + k], at);
            turned_own(t, at, c[k]);
        }
        vector3_cross(cross, c[0], c[1]);
        volume += vector3_dot(cross, c[2]) / 6;
    }
    return fabs(volume) > 0.94 * whole && fabs(volume) < 1.001 * whole;
}

bool turned_of(turned *out, const primitive *p)
{
    const double low[3] = {(double)p->bounds.min.x, (double)p->bounds.min.y, (double)p->bounds.min.z},
                 high[3] = {(double)p->bounds.max.x, (double)p->bounds.max.y, (double)p->bounds.max.z};
    enum { VERTICES_MOST = 20000 }; /* of terrains and cities nobody asks */
    if (p->vertex_count < 12 || p->index_count < 60 || p->vertex_count > VERTICES_MOST)
        return false;
    for (int axis = 0; axis < 3; axis++) {
        const int    u = (axis + 1) % 3, v = (axis + 2) % 3;
        const double wide = high[u] - low[u], deep = high[v] - low[v];
        *out = (turned){.height = high[axis] - low[axis], .axis = axis};
        out->base[axis] = low[axis];
        if (out->height > 0 && fmin(wide, deep) > 0.9 * fmax(wide, deep) && find_middle(out, p) && find_radii(out, p) &&
            lies_on(out, p) && encloses(out, p))
            return true;
    }
    return false;
}
