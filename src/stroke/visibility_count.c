/* How many surfaces lie in front of single positions. */
#include <math.h>

#include "stroke/solid_cover.h"
#include "stroke/stroke_private.h"

typedef struct surface_count {
    const stroke_view *v;
    window_point       at;
    uint32_t           count;
    solid_covers       covers;
    bool               failed;
} surface_count;

/* A position on an edge belongs to the triangle that lies to its right, or below where the edge is level: so to one of
 * two. */
static bool is_inside(const window_point p[3], window_point at)
{
    double sign = window_side(p[0], p[1], p[2]) < 0 ? -1 : 1;
    for (int k = 0; k < 3; k++) {
        window_point from = p[k], to = p[k == 2 ? 0 : k + 1];
        double       side = sign * window_side(from, to, at);
        double       up = sign * ((double)from.y - to.y), right = sign * ((double)to.x - from.x);
        if (side < 0 || (side == 0 && !(up > 0 || (up == 0 && right > 0))))
            return false;
    }
    return true;
}

static void count_nearer(void *user, const uint32_t *entries, size_t corner, size_t count, bool alone)
{
    (void)corner;
    (void)alone;
    surface_count     *c = user;
    const stroke_view *v = c->v;
    for (size_t i = 0; i < count; i++) {
        const window_box *box = &v->boxes[entries[i]];
        if (box->low_x > c->at.x || box->high_x < c->at.x || box->low_y > c->at.y || box->high_y < c->at.y ||
            box->near_z > c->at.z)
            continue;
        const window_triangle *t = &v->triangles[entries[i]];
        const window_point     p[3] = {v->points[t->v[0]], v->points[t->v[1]], v->points[t->v[2]]};
        if (!is_inside(p, c->at))
            continue;
        double whole = window_side(p[0], p[1], p[2]), a = window_side(p[1], p[2], c->at) / whole,
               b = window_side(p[2], p[0], c->at) / whole;
        double   z = a * p[0].z + b * p[1].z + (1 - a - b) * p[2].z;
        bool     nearer = c->at.z - z > view_tolerance(v, v->same, z) + box->slope;
        uint32_t solid = view_solid(v, t->face);
        if (!solid) {
            c->count += nearer;
            continue;
        }
        solid_cover cover = solid_cover_of(v, solid - 1, t->face, 0, 1, z, z);
        cover.nearer = nearer;
        if ((nearer || v->around[solid - 1]) && !solid_covers_put(&c->covers, &cover))
            c->failed = true;
    }
}

static void add_entries(void *user, double at, int32_t step)
{
    surface_count *c = user;
    c->count += at < 1 ? (uint32_t)step : 0;
}

void stroke_view_count(const stroke_view *v, const double (*positions)[3], size_t count, uint32_t *out)
{
    double        half_x = 0.5 * v->camera.width * v->units, half_y = 0.5 * v->camera.height * v->units;
    surface_count c = {.v = v};
    for (size_t i = 0; i < count; i++) {
        out[i] = UINT32_MAX;
        c.count = 0;
        c.covers.count = 0;
        if (!view_position(v, (double3){positions[i][0], positions[i][1], positions[i][2]}, &c.at) ||
            fabs((double)c.at.x) > half_x || fabs((double)c.at.y) > half_y)
            continue;
        grid_walk(&v->grid, c.at, c.at, count_nearer, &c);
        if (c.covers.count && !c.failed)
            c.failed = !solid_covers_count(&c.covers, v, add_entries, &c);
        out[i] = c.failed ? UINT32_MAX : c.count;
    }
    solid_covers_release(&c.covers);
}
