/* Flat faces laid on terrain: each is cut along the lines of the grid and the diagonals of its cells. */
#include <math.h>

#include "base/memory.h"
#include "import/terrain.h"

/* A triangle that is cut by four sides of a cell and its diagonal has at most this many corners. */
enum { PIECE_MAX = 12, NOBODY = UINT32_MAX };

#define MILLIMETRE 1e-3 /* points that are nearer are one */

typedef struct piece {
    double p[PIECE_MAX][2];
    int    count;
} piece;

typedef struct draper {
    const terrain    *t;
    city_shape       *out;
    footprint_points *points;
    double            above;
    uint32_t         *table; /* points by their place */
    size_t            table_size, first;
    bool              good;
} draper;

/* The part of a piece where a · x + b · y >= c. */
static void cut(piece *out, const piece *in, double a, double b, double c)
{
    out->count = 0;
    for (int i = 0; i < in->count; i++) {
        const double *p = in->p[i], *q = in->p[(i + 1) % in->count];
        double        s = a * p[0] + b * p[1] - c, e = a * q[0] + b * q[1] - c;
        if (s >= 0 && out->count < PIECE_MAX) {
            out->p[out->count][0] = p[0];
            out->p[out->count++][1] = p[1];
        }
        if ((s < 0) != (e < 0) && out->count < PIECE_MAX) {
            out->p[out->count][0] = p[0] + (q[0] - p[0]) * s / (s - e);
            out->p[out->count++][1] = p[1] + (q[1] - p[1]) * s / (s - e);
        }
    }
}

static size_t slot_of(const draper *d, int64_t x, int64_t y)
{
    uint64_t h = (uint64_t)x * 0x9E3779B97F4A7C15u ^ ((uint64_t)y * 0xC2B2AE3D27D4EB4Fu + 0x165667B19E3779F9u);
    h ^= h >> 29;
    return (size_t)(h & (d->table_size - 1));
}

static int64_t rounded(double v)
{
    return (int64_t)llround(v / MILLIMETRE);
}

/* A whole number of millimetres. */
static double snapped(double v)
{
    return round(v / MILLIMETRE) * MILLIMETRE;
}

static bool grow_table(draper *d)
{
    size_t    size = d->table_size ? 2 * d->table_size : 256;
    uint32_t *table = mem_calloc(size, sizeof *table);
    if (!table)
        return false;
    mem_free(d->table);
    d->table = table;
    d->table_size = size;
    for (size_t i = 0; i < size; i++)
        table[i] = NOBODY;
    for (size_t i = d->first; i < d->points->count; i++) {
        const vec3 *p = &d->points->items[i];
        size_t      slot = slot_of(d, rounded((double)p->x), rounded((double)p->y));
        while (table[slot] != NOBODY)
            slot = (slot + 1) & (size - 1);
        table[slot] = (uint32_t)i;
    }
    return true;
}

/* The point at a place; as float as it is kept, so that it is found again. */
static uint32_t point_at(draper *d, double x, double y)
{
    double height = terrain_height(d->t, x, y) + d->above;
    if (2 * (d->points->count - d->first + 1) > d->table_size && !grow_table(d)) {
        d->good = false;
        return 0;
    }
    int64_t kept_x = rounded((double)(float)snapped(x)), kept_y = rounded((double)(float)snapped(y));
    size_t  slot = slot_of(d, kept_x, kept_y);
    for (; d->table[slot] != NOBODY; slot = (slot + 1) & (d->table_size - 1)) {
        const vec3 *p = &d->points->items[d->table[slot]];
        if (rounded((double)p->x) == kept_x && rounded((double)p->y) == kept_y)
            return d->table[slot];
    }
    d->good = d->good && footprint_add_point(d->points, snapped(x), snapped(y), height);
    d->table[slot] = (uint32_t)d->points->count - 1;
    return d->table[slot];
}

/* However small it is: where one is missing, a pixel may show what is below. */
static void put_piece(draper *d, const piece *in)
{
    uint32_t corners[PIECE_MAX];
    int      count = 0;
    for (int i = 0; i < in->count && in->count >= 3 && d->good; i++) {
        uint32_t point = point_at(d, in->p[i][0], in->p[i][1]);
        if (count == 0 || (corners[count - 1] != point && corners[0] != point))
            corners[count++] = point;
    }
    double area = 0;
    for (int i = 1; i + 1 < count && d->good; i++) {
        vec3 o = d->points->items[corners[0]], p = d->points->items[corners[i]], q = d->points->items[corners[i + 1]];
        area += ((double)p.x - (double)o.x) * ((double)q.y - (double)o.y) -
                ((double)q.x - (double)o.x) * ((double)p.y - (double)o.y);
    }
    if (!(area > 0))
        return;
    for (int i = 0; i < count && d->good; i++)
        d->good = city_shape_corner(d->out, corners[i]);
    d->good = d->good && city_shape_end_ring(d->out) && city_shape_end_face(d->out, NONE, CITY_NO_WORD, 0);
}

/* What of a piece lies in the cells of one column. */
static void drape_column(draper *d, const piece *in, double left)
{
    const terrain *t = d->t;
    double         low = INFINITY, high = -INFINITY;
    for (int i = 0; i < in->count; i++) {
        low = fmin(low, in->p[i][1]);
        high = fmax(high, in->p[i][1]);
    }
    double first = floor((low - t->low[1]) / t->step), last = floor((high - t->low[1]) / t->step);
    for (double row = first; row <= last && in->count >= 3 && d->good; row++) {
        double bottom = t->low[1] + row * t->step;
        piece  above, cell, half;
        cut(&above, in, 0, 1, bottom);
        cut(&cell, &above, 0, -1, -(bottom + t->step));
        cut(&half, &cell, 1, -1, left - bottom);
        put_piece(d, &half);
        cut(&half, &cell, -1, 1, bottom - left);
        put_piece(d, &half);
    }
}

static void drape_triangle(draper *d, const piece *in)
{
    const terrain *t = d->t;
    double         low = INFINITY, high = -INFINITY;
    for (int i = 0; i < in->count; i++) {
        low = fmin(low, in->p[i][0]);
        high = fmax(high, in->p[i][0]);
    }
    double first = floor((low - t->low[0]) / t->step), last = floor((high - t->low[0]) / t->step);
    for (double column = first; column <= last && d->good; column++) {
        double left = t->low[0] + column * t->step;
        piece  right, strip;
        cut(&right, in, 1, 0, left);
        cut(&strip, &right, -1, 0, -(left + t->step));
        if (strip.count >= 3)
            drape_column(d, &strip, left);
    }
}

bool terrain_drape(const terrain *t, const city_shape *flat, const vec3 *flat_points, double above, city_shape *out,
                   footprint_points *points)
{
    draper         d = {t, out, points, above, NULL, 0, points->count, true};
    city_triangles triangles = {0};
    for (size_t f = 0; f < flat->face_count && d.good; f++) {
        triangles.count = 0;
        d.good = city_triangulate(&triangles, flat_points, flat, f) != CITY_CUT_NO_MEMORY;
        for (size_t i = 0; i + 2 < triangles.count && d.good; i += 3) {
            piece  in = {.count = 3};
            double area;
            for (int k = 0; k < 3; k++) {
                vec3 p = flat_points[flat->corners[triangles.corners[i + (size_t)k]]];
                in.p[k][0] = (double)p.x;
                in.p[k][1] = (double)p.y;
            }
            area = (in.p[1][0] - in.p[0][0]) * (in.p[2][1] - in.p[0][1]) -
                   (in.p[2][0] - in.p[0][0]) * (in.p[1][1] - in.p[0][1]);
            if (area < 0)
                for (int k = 0; k < 2; k++) {
                    double kept = in.p[1][k];
                    in.p[1][k] = in.p[2][k];
                    in.p[2][k] = kept;
                }
            drape_triangle(&d, &in);
        }
    }
    mem_free(triangles.corners);
    mem_free(d.table);
    return d.good;
}
