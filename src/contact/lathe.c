/* Cylinders and cones that meet something. Whatever is met first is met at few angles around their axis: where their
 * side faces a face of the other thing, or an edge, where a rim comes to an edge, where a corner comes to the side.
 * With a vertex at each of these the mesh meets what the shape itself does, as the sweep of meshes finds it. */
#include <stdlib.h>
#include <string.h>

#include "base/error.h"
#include "base/memory.h"
#include "base/vector3.h"
#include "contact/touch_private.h"

static const double TURN = 6.283185307179586;

enum {
    EVENLY = 48,         /* angles that it has anyway */
    TRIANGLES_MOST = 400 /* that are near; among more it is met as the mesh that it is */
};

/* A flat face between two angles is met by what comes to the side between them: so far apart are they. */
static const double FLAT = 1e-3;

typedef struct angle_list {
    double *items;
    size_t  count, capacity;
    bool    failed;
} angle_list;

typedef struct lathe {
    const touch_piece *own, *other;
    mat4               back;     /* from the world to the shape's mesh */
    double             along[3]; /* in its own axes: the way that the other comes on, or goes */
    double             slope;    /* of its side's normal */
    angle_list        *angles;
} lathe;

static void add_angle(lathe *l, double angle)
{
    angle_list *a = l->angles;
    if (!isfinite(angle) || a->failed)
        return;
    a->failed = !mem_grow((void **)&a->items, &a->capacity, a->count + 1, sizeof *a->items);
    if (!a->failed)
        a->items[a->count++] = angle - TURN * floor(angle / TURN);
}

/* What comes to it there meets a face. */
static void add_flat(lathe *l, double angle)
{
    add_angle(l, angle - FLAT);
    add_angle(l, angle + FLAT);
}

/* Where it faces a direction, and where it faces away. */
static void add_facing(lathe *l, double x, double y)
{
    if (x * x + y * y > 0) {
        add_angle(l, atan2(y, x));
        add_angle(l, atan2(-y, -x));
    }
}

/* Where a line across the side lies in its tangent plane: n · e = 0 for n = (cos, sin, slope). */
static void add_tangent(lathe *l, const double e[3])
{
    const double across = sqrt(e[0] * e[0] + e[1] * e[1]), c = -l->slope * e[2];
    if (across > fabs(c)) {
        const double middle = atan2(e[1], e[0]), apart = acos(c / across);
        add_angle(l, middle + apart);
        add_angle(l, middle - apart);
    }
}

/* Where a point that goes along the motion comes to the side, or leaves it: |(x, y)| = r0 − slope z. */
static void add_reached(lathe *l, const double at[3])
{
    const turned *t = &l->own->turned;
    const double *d = l->along, k = l->slope, r = t->radii[0] - k * at[2], dr = -k * d[2];
    const double  a = d[0] * d[0] + d[1] * d[1] - dr * dr, b = at[0] * d[0] + at[1] * d[1] - r * dr,
                 c = at[0] * at[0] + at[1] * at[1] - r * r, root = b * b - a * c;
    for (int sign = -1; sign <= 1 && root >= 0 && a != 0; sign += 2) {
        const double s = (-b + sign * sqrt(root)) / a, z = at[2] + s * d[2];
        if (z >= 0 && z <= t->height) {
            add_flat(l, atan2(at[1] + s * d[1], at[0] + s * d[0]));
        }
    }
}

static void own_direction(const lathe *l, const double world[3], double out[3])
{
    const int axis = l->own->turned.axis;
    for (int k = 0; k < 3; k++) {
        const int row = (axis + 1 + k) % 3;
        out[k] = l->back.m[row] * world[0] + l->back.m[4 + row] * world[1] + l->back.m[8 + row] * world[2];
    }
}

static void own_place(const lathe *l, const double world[3], double out[3])
{
    double local[3];
    for (int k = 0; k < 3; k++)
        local[k] =
            l->back.m[k] * world[0] + l->back.m[4 + k] * world[1] + l->back.m[8 + k] * world[2] + l->back.m[12 + k];
    turned_own(&l->own->turned, local, out);
}

static void add_triangle(lathe *l, uint32_t first)
{
    double c[3][3], edges[3][3], normal[3], swept[3];
    for (uint32_t k = 0; k < 3; k++)
        own_place(l, l->other->vertices[l->other->indices[first + k]], c[k]);
    for (int k = 0; k < 3; k++) {
        vector3_add(edges[k], c[(k + 1) % 3], -1, c[k]);
        vector3_cross(swept, edges[k], l->along);
        add_facing(l, swept[0], swept[1]); /* a rim comes to the edge */
        add_tangent(l, edges[k]);
        add_reached(l, c[k]);
    }
    vector3_cross(normal, edges[0], edges[1]);
    add_facing(l, normal[0], normal[1]);
}

/* Two whose axes are parallel meet between these: circles, seen along them. */
static void add_beside(lathe *l)
{
    const turned *own = &l->own->turned, *other = &l->other->turned;
    double        base[3], end[3], a[3], b[3];
    if (!l->other->is_turned || l->slope != 0 || turned_slope(other) != 0)
        return;
    memcpy(base, other->base, sizeof base);
    memcpy(end, other->base, sizeof end);
    end[other->axis] += other->height;
    for (int k = 0; k < 3; k++) {
        const mat4 *w = &l->other->world;
        a[k] = w->m[k] * base[0] + w->m[4 + k] * base[1] + w->m[8 + k] * base[2] + w->m[12 + k];
        b[k] = w->m[k] * end[0] + w->m[4 + k] * end[1] + w->m[8 + k] * end[2] + w->m[12 + k];
    }
    double from[3], to[3], rim[3], at_rim[3], over[3];
    own_place(l, a, from);
    own_place(l, b, to);
    if (hypot(to[0] - from[0], to[1] - from[1]) > 1e-6 * fabs(to[2] - from[2]))
        return;
    turned_rim(other, 0, 0, rim);
    for (int k = 0; k < 3; k++) {
        const mat4 *w = &l->other->world;
        at_rim[k] = w->m[k] * rim[0] + w->m[4 + k] * rim[1] + w->m[8 + k] * rim[2] + w->m[12 + k];
    }
    own_place(l, at_rim, over);
    const double r = own->radii[0] + hypot(over[0] - from[0], over[1] - from[1]), dx = l->along[0], dy = l->along[1],
                 aa = dx * dx + dy * dy, bb = from[0] * dx + from[1] * dy,
                 root = bb * bb - aa * (from[0] * from[0] + from[1] * from[1] - r * r);
    for (int sign = -1; sign <= 1 && root >= 0 && aa > 0; sign += 2) {
        const double s = (-bb + sign * sqrt(root)) / aa;
        add_flat(l, atan2(from[1] + s * dy, from[0] + s * dx));
    }
}

static bool is_near(const touch_piece *p, uint32_t first, const double low[3], const double high[3])
{
    for (int k = 0; k < 3; k++) {
        double least = INFINITY, most = -INFINITY;
        for (uint32_t i = 0; i < 3; i++) {
            least = fmin(least, p->vertices[p->indices[first + i]][k]);
            most = fmax(most, p->vertices[p->indices[first + i]][k]);
        }
        if (least > high[k] || most < low[k])
            return false;
    }
    return true;
}

/* The angles at which something can be met. False: it is met as a mesh. */
static bool find_angles(lathe *l, double within)
{
    double middle[3];
    if (l->other->is_sphere) {
        own_place(l, l->other->centre, middle);
        add_facing(l, middle[0], middle[1]);
        return !l->angles->failed;
    }
    double low[3] = {INFINITY, INFINITY, INFINITY}, high[3] = {-INFINITY, -INFINITY, -INFINITY};
    size_t near = 0;
    for (uint32_t i = 0; i < l->own->vertex_count; i++)
        for (int k = 0; k < 3; k++) {
            low[k] = fmin(low[k], l->own->vertices[i][k] - within);
            high[k] = fmax(high[k], l->own->vertices[i][k] + within);
        }
    for (uint32_t i = 0; i + 2 < l->other->index_count && near <= TRIANGLES_MOST; i += 3)
        if (is_near(l->other, i, low, high)) {
            near++;
            add_triangle(l, i);
        }
    add_beside(l);
    return near > 0 && near <= TRIANGLES_MOST && !l->angles->failed;
}

static int compare_angles(const void *a, const void *b)
{
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

static void sort_angles(angle_list *a)
{
    size_t kept = 0;
    if (a->count > 1)
        qsort(a->items, a->count, sizeof *a->items, compare_angles);
    for (size_t i = 0; i < a->count; i++)
        if (kept == 0 || a->items[i] - a->items[kept - 1] > 1e-9)
            a->items[kept++] = a->items[i];
    if (kept > 1 && a->items[kept - 1] - a->items[0] > TURN - 1e-9) /* all around is where it begins */
        kept--;
    a->count = kept;
}

/* Its mesh with vertices at these angles: two rims, and the middles of both ends. False: out of memory. */
static bool make_piece(touch_piece *out, const touch_piece *from, const angle_list *angles)
{
    const turned  *t = &from->turned;
    const uint32_t n = (uint32_t)angles->count;
    *out = *from;
    out->vertex_count = 2 * n + 2;
    out->index_count = 12 * n;
    out->vertices = mem_alloc(out->vertex_count * sizeof *out->vertices);
    uint32_t *indices = mem_alloc(out->index_count * sizeof *indices);
    out->indices = out->made = indices;
    if (!out->vertices || !indices)
        return false;
    for (uint32_t i = 0; i < out->vertex_count; i++) {
        double at[3];
        if (i < 2 * n) {
            turned_rim(t, angles->items[i / 2], i % 2, at);
        } else {
            vector3_copy(at, t->base);
            at[t->axis] += i % 2 ? t->height : 0;
        }
        for (int k = 0; k < 3; k++)
            out->vertices[i][k] = from->world.m[k] * at[0] + from->world.m[4 + k] * at[1] +
                                  from->world.m[8 + k] * at[2] + from->world.m[12 + k];
    }
    for (uint32_t i = 0; i < n; i++) {
        const uint32_t a = 2 * i, b = 2 * ((i + 1) % n),
                       faces[12] = {a, b, a + 1, b, b + 1, a + 1, 2 * n, b, a, 2 * n + 1, a + 1, b + 1};
        memcpy(&indices[(size_t)12 * i], faces, sizeof faces);
    }
    out->outward = mat4_cofactors(&from->world, (double[9]){0}) < 0 ? -1 : 1;
    return true;
}

void touch_lathe_release(touch_piece *p)
{
    mem_free(p->vertices);
    mem_free(p->made);
    memset(p, 0, sizeof *p);
}

/* The angle at which it is met: where its side faces what it meets, or, of an end, where the place lies. */
static double angle_of(lathe *l, const touch_met *met)
{
    const mat4 *w = &l->own->world;
    const int   axis = l->own->turned.axis;
    double      own[3];
    for (int k = 0; k < 3; k++) /* normals go the other way as places do, by what is transposed */
        own[k] = vector3_dot(&w->m[4 * ((axis + 1 + k) % 3)], met->facing);
    if (sqrt(own[0] * own[0] + own[1] * own[1]) < 1e-4 * vector3_length(own))
        own_place(l, met->place, own);
    const double angle = atan2(own[1], own[0]);
    return angle - TURN * floor(angle / TURN);
}

/* Of these angles the nearest to one, and around it none but the even ones: so that what touches along it is one line,
 * and not those beside it, too. */
static void keep_nearest(angle_list *a, double angle)
{
    const double around = 0.03;
    double       nearest = INFINITY;
    size_t       kept = 0;
    for (size_t i = 0; i < a->count; i++)
        nearest = fmin(nearest, fabs(remainder(a->items[i] - angle, TURN)));
    for (size_t i = 0; i < a->count; i++)
        if (fabs(fabs(remainder(a->items[i] - angle, TURN)) - nearest) < 1e-7)
            a->items[kept++] = a->items[i];
    for (int i = 0; i < EVENLY; i++) {
        const double even = TURN * i / EVENLY;
        if (fabs(remainder(even - angle, TURN)) > around && kept < a->capacity)
            a->items[kept++] = even;
    }
    a->count = kept;
    sort_angles(a);
}

lmn_status touch_lathe(touch_piece *out, const touch_piece *own, const touch_piece *other, const double along[3],
                       double within, const touch_met *met, lmn_error *error)
{
    angle_list angles = {0};
    lathe      l = {.own = own, .other = other, .back = mat4_inverse(&own->world), .angles = &angles};
    memset(out, 0, sizeof *out);
    own_direction(&l, along, l.along);
    l.slope = turned_slope(&own->turned);
    for (int i = 0; i < EVENLY; i++)
        add_angle(&l, TURN * i / EVENLY);
    const bool finds = find_angles(&l, within);
    lmn_status status = angles.failed ? error_memory(error) : LMN_OK;
    sort_angles(&angles);
    if (status == LMN_OK && finds && met)
        keep_nearest(&angles, angle_of(&l, met));
    if (status == LMN_OK && finds && !make_piece(out, own, &angles)) {
        touch_lathe_release(out);
        status = error_memory(error);
    }
    mem_free(angles.items);
    return status;
}
