/* Walls of a mesh, found by neighbourhood and unrolled. */
#include "field/walls.h"

#include <math.h>

#include "base/memory.h"
#include "base/vector3.h"

#define UPRIGHT 0.1 /* sine of the angle by which a wall may lean */

typedef struct walls {
    const primitive *p;
    int              up;
    double           base;
    double (*positions)[3]; /* per vertex, world */
    double (*normals)[3];   /* per triangle; 0 where it has no area */
    uint32_t *opposite;     /* per corner */
    uint32_t *wall;         /* per triangle, from 1 on; 0: none */
    double   *along;        /* per corner */
    uint32_t *queue;
    uint32_t  count;
} walls;

typedef struct wall_extent {
    double begin, end, eaves;
} wall_extent;

static uint32_t next_corner(uint32_t corner)
{
    return corner % 3 == 2 ? corner - 2 : corner + 1;
}

static void find_positions(walls *w, const mat4 *world)
{
    for (uint32_t i = 0; i < w->p->vertex_count; i++) {
        vec3 v = w->p->positions[i];
        for (int k = 0; k < 3; k++)
            w->positions[i][k] = world->m[k] * (double)v.x + world->m[4 + k] * (double)v.y +
                                 world->m[8 + k] * (double)v.z + world->m[12 + k];
    }
}

static void find_normals(walls *w)
{
    for (uint32_t t = 0; t < w->p->index_count / 3; t++) {
        const uint32_t *corner = &w->p->indices[3 * (size_t)t];
        double          a[3], b[3];
        vector3_add(a, w->positions[corner[1]], -1, w->positions[corner[0]]);
        vector3_add(b, w->positions[corner[2]], -1, w->positions[corner[0]]);
        vector3_cross(w->normals[t], a, b);
        if (!vector3_normalise(w->normals[t]))
            vector3_set(w->normals[t], 0, 0, 0);
    }
}

static bool is_upright(const walls *w, uint32_t triangle)
{
    const double *n = w->normals[triangle];
    return vector3_dot(n, n) > 0.5 && fabs(n[w->up]) < UPRIGHT;
}

/* Horizontal, to the right of whoever sees the triangle from outside. */
static void right_of(const walls *w, uint32_t triangle, double out[3])
{
    double up[3] = {0, 0, 0};
    up[w->up] = 1;
    vector3_cross(out, up, w->normals[triangle]);
    vector3_normalise(out);
}

/* Lays a triangle of which one corner is laid already. */
static void lay(walls *w, uint32_t triangle, uint32_t corner, double along)
{
    double right[3], away[3];
    right_of(w, triangle, right);
    for (uint32_t c = 3 * triangle; c < 3 * triangle + 3; c++) {
        vector3_add(away, w->positions[w->p->indices[c]], -1, w->positions[w->p->indices[corner]]);
        w->along[c] = along + vector3_dot(right, away);
    }
    w->wall[triangle] = w->count;
}

/* All that hangs together with a triangle. */
static void unroll_from(walls *w, uint32_t first)
{
    uint32_t head = 0, tail = 0;
    w->count++;
    lay(w, first, 3 * first, 0);
    w->queue[tail++] = first;
    while (head < tail) {
        uint32_t triangle = w->queue[head++];
        for (uint32_t c = 3 * triangle; c < 3 * triangle + 3; c++) {
            uint32_t other = w->opposite[c];
            if (other == UINT32_MAX || w->wall[other / 3] || !is_upright(w, other / 3) ||
                vector3_dot(w->normals[triangle], w->normals[other / 3]) < cos(WALL_TURN))
                continue;
            /* The other side runs the other way: its first corner is this one's second. */
            lay(w, other / 3, other, w->along[next_corner(c)]);
            w->queue[tail++] = other / 3;
        }
    }
}

static double height_of(const walls *w, uint32_t corner)
{
    return w->positions[w->p->indices[corner]][w->up] - w->base;
}

/* Widens a wall by a corner; its upper rim are edges to the left, below which the wall is. */
static void measure(const walls *w, wall_extent *extents)
{
    for (uint32_t i = 0; i < w->count; i++)
        extents[i] = (wall_extent){INFINITY, -INFINITY, INFINITY};
    for (uint32_t c = 0; c < w->p->index_count; c++) {
        uint32_t wall = w->wall[c / 3], other = w->opposite[c], next = next_corner(c);
        if (!wall)
            continue;
        wall_extent *e = &extents[wall - 1];
        e->begin = fmin(e->begin, w->along[c]);
        e->end = fmax(e->end, w->along[c]);
        double left = w->along[c] - w->along[next], rise = fabs(height_of(w, c) - height_of(w, next));
        if ((other == UINT32_MAX || w->wall[other / 3] != wall) && left > 1e-3 * (left + rise))
            e->eaves = fmin(e->eaves, fmin(height_of(w, c), height_of(w, next)));
    }
}

/* A copy of a corner's vertex for its wall, made unless there is one. `next`: copies of one vertex, chained. */
static uint32_t copy_of(const walls *w, wall_mesh *out, uint32_t *first, uint32_t *next, uint32_t corner,
                        const wall_extent *extents)
{
    uint32_t vertex = w->p->indices[corner], wall = w->wall[corner / 3];
    float    at[2] = {0, 0}, extent[2] = {0, 0};
    if (wall) {
        const wall_extent *e = &extents[wall - 1];
        double             length = e->end - e->begin;
        if (length > 0 && e->eaves > 0 && isfinite(e->eaves)) {
            at[0] = (float)((w->along[corner] - e->begin) / length);
            at[1] = (float)(height_of(w, corner) / e->eaves);
            extent[0] = (float)length;
            extent[1] = (float)e->eaves;
        }
    }
    for (uint32_t i = first[vertex]; i != UINT32_MAX; i = next[i])
        if (fabsf(out->at[i][0] - at[0]) < 1e-5f && out->extent[i][0] == extent[0] && out->extent[i][1] == extent[1])
            return i;
    uint32_t made = out->vertex_count++;
    out->source[made] = vertex;
    for (int k = 0; k < 2; k++) {
        out->at[made][k] = at[k];
        out->extent[made][k] = extent[k];
    }
    next[made] = first[vertex];
    first[vertex] = made;
    return made;
}

static lmn_status gather(const walls *w, wall_mesh *out, lmn_error *error)
{
    size_t       corners = w->p->index_count;
    wall_extent *extents = mem_calloc(w->count + 1, sizeof *extents);
    uint32_t    *first = mem_calloc(w->p->vertex_count, sizeof *first), *next = mem_calloc(corners, sizeof *next);
    out->source = mem_calloc(corners, sizeof *out->source);
    out->at = mem_calloc(corners, sizeof *out->at);
    out->extent = mem_calloc(corners, sizeof *out->extent);
    out->indices = mem_calloc(corners, sizeof *out->indices);
    bool done = extents && first && next && out->source && out->at && out->extent && out->indices;
    if (done) {
        measure(w, extents);
        for (uint32_t v = 0; v < w->p->vertex_count; v++)
            first[v] = UINT32_MAX;
        for (uint32_t c = 0; c < corners; c++)
            out->indices[c] = copy_of(w, out, first, next, c, extents);
        out->index_count = (uint32_t)corners;
        out->wall_count = w->count;
    }
    mem_free(extents);
    mem_free(first);
    mem_free(next);
    return done ? LMN_OK : error_memory(error);
}

lmn_status wall_mesh_make(wall_mesh *out, const primitive *p, const mat4 *world, int up, double base, lmn_error *error)
{
    size_t triangles = p->index_count / 3;
    walls  w = {.p = p, .up = up, .base = base};
    w.positions = mem_calloc(p->vertex_count, sizeof *w.positions);
    w.normals = mem_calloc(triangles, sizeof *w.normals);
    w.opposite = mesh_adjacency(p);
    w.wall = mem_calloc(triangles, sizeof *w.wall);
    w.along = mem_calloc(p->index_count, sizeof *w.along);
    w.queue = mem_calloc(triangles, sizeof *w.queue);
    *out = (wall_mesh){.vertex_count = 0};
    lmn_status status =
        w.positions && w.normals && w.opposite && w.wall && w.along && w.queue ? LMN_OK : error_memory(error);
    if (status == LMN_OK) {
        find_positions(&w, world);
        find_normals(&w);
        for (uint32_t t = 0; t < triangles; t++)
            if (!w.wall[t] && is_upright(&w, t))
                unroll_from(&w, t);
        status = gather(&w, out, error);
    }
    mem_free(w.positions);
    mem_free(w.normals);
    mem_free(w.opposite);
    mem_free(w.wall);
    mem_free(w.along);
    mem_free(w.queue);
    return status;
}

void wall_mesh_release(wall_mesh *m)
{
    mem_free(m->source);
    mem_free(m->at);
    mem_free(m->extent);
    mem_free(m->indices);
    *m = (wall_mesh){.vertex_count = 0};
}
