#include "stroke/curve_path.h"

#include <math.h>
#include <string.h>

#include "base/memory.h"
#include "stroke/curve.h"

/* Cosine of 75°. */
#define CORNER_COSINE 0.25881904510252074

/* Counts, for each vertex, the sharp edges of its mesh, whether they are drawn or not. */
static void count_sharp(curve_path *c)
{
    const stroke_scene *s = c->v->scene;
    for (size_t i = 0; i < s->item_count; i++) {
        const edge_mesh *m = &s->meshes[s->items[i].mesh];
        uint8_t         *sharp = c->sharp + c->v->items[i].first_point;
        for (uint32_t e = 0; e < m->edge_count; e++)
            for (int k = 0; k < 2 && m->edges[e].flags & (EDGE_CREASE | EDGE_BORDER); k++)
                if (sharp[m->edges[e].vertex[k]] < 3)
                    sharp[m->edges[e].vertex[k]]++;
    }
}

bool curve_path_open(curve_path *c, const stroke_view *v, const view_lines *lines, int steps)
{
    *c = (curve_path){.v = v, .lines = lines, .steps = steps < CURVE_STEPS_MAX ? steps : CURVE_STEPS_MAX};
    if (steps <= 0) {
        c->steps = 0;
        return true;
    }
    c->sharp = mem_calloc((size_t)v->vertex_count + 1, 1);
    if (c->sharp)
        count_sharp(c);
    return c->sharp != NULL;
}

void curve_path_close(curve_path *c)
{
    mem_free(c->sharp);
    mem_free(c->positions);
    mem_free(c->coarse);
    memset(c, 0, sizeof *c);
}

bool curve_path_bends(const curve_path *c, stroke_class kind)
{
    return c->steps > 0 && (kind == STROKE_CONTOUR || kind == STROKE_BORDER || kind == STROKE_CREASE);
}

static const window_point *position_of(const curve_path *c, uint32_t half)
{
    const window_segment *s = &c->lines->segments[half / 2];
    return half & 1 ? &s->b : &s->a;
}

static uint32_t number_of(const curve_path *c, uint32_t half)
{
    return c->lines->lines[half / 2].ends[half & 1];
}

static double3 world_of(const curve_path *c, const view_line *line, uint32_t number)
{
    const stroke_scene *s = c->v->scene;
    const stroke_item  *item = &s->items[line->item];
    return item_position(item, s->meshes[item->mesh].positions[number - c->v->items[line->item].first_point]);
}

/* Do two lines that meet turn too far, in space, to be one curve? Where ends are no vertices, lines are smooth. */
static bool turns_sharply(const curve_path *c, uint32_t in, uint32_t out)
{
    uint32_t before = number_of(c, in), here = number_of(c, out), after = number_of(c, out ^ 1);
    if (before >= c->v->vertex_count || after >= c->v->vertex_count)
        return false;
    double3 p = world_of(c, &c->lines->lines[in / 2], before), q = world_of(c, &c->lines->lines[out / 2], here),
            r = world_of(c, &c->lines->lines[out / 2], after);
    double ax = q.x - p.x, ay = q.y - p.y, az = q.z - p.z, bx = r.x - q.x, by = r.y - q.y, bz = r.z - q.z;
    double lengths = sqrt((ax * ax + ay * ay + az * az) * (bx * bx + by * by + bz * bz));
    return ax * bx + ay * by + az * bz < CORNER_COSINE * lengths;
}

/* Does the curve end where one half-line leads to the next? */
static bool is_corner(const curve_path *c, uint32_t in, uint32_t out)
{
    uint32_t here = number_of(c, out);
    if (here >= c->v->vertex_count || c->sharp[here] == 0)
        return false;
    bool sharp_in = c->lines->lines[in / 2].sharp, sharp_out = c->lines->lines[out / 2].sharp;
    return c->sharp[here] != 2 || sharp_in != sharp_out || (sharp_in && turns_sharply(c, in, out));
}

/* Points first … last of the chain, as they are. */
static void fill_coarse(curve_path *c, const uint32_t *path, size_t count, size_t first, size_t last)
{
    for (size_t i = first; i <= last; i++) {
        const window_point *p = i < count ? position_of(c, path[i]) : position_of(c, path[count - 1] ^ 1);
        c->coarse[i - first][0] = p->x;
        c->coarse[i - first][1] = p->y;
        c->coarse[i - first][2] = p->z;
    }
}

/* Refines what is in `coarse` and puts it from `at` on. */
static void refine(curve_path *c, size_t count, bool closed, size_t at)
{
    double(*from)[3] = c->coarse, (*to)[3] = c->positions + at;
    if (c->steps % 2 == 0) { /* so that the last step ends where it is wanted */
        memcpy(to, from, count * sizeof *to);
        double(*other)[3] = from;
        from = to;
        to = other;
    }
    for (int i = 0; i < c->steps; i++) {
        curve_refine(to[0], from[0], count, 3, closed);
        count = curve_count(count, closed);
        double(*other)[3] = from;
        from = to;
        to = other;
    }
}

bool curve_path_take(curve_path *c, const uint32_t *path, size_t count, bool closed)
{
    size_t pieces = (size_t)1 << c->steps, needed = count * pieces + 2, start = 0;
    if (!mem_grow((void **)&c->positions, &c->position_capacity, needed, sizeof *c->positions) ||
        !mem_grow((void **)&c->coarse, &c->coarse_capacity, needed, sizeof *c->coarse))
        return false;
    c->position_count = count * pieces + 1;
    bool whole = closed && count > 2 && !is_corner(c, path[count - 1], path[0]);
    for (size_t i = 1; i < count && whole; i++)
        whole = !is_corner(c, path[i - 1], path[i]);
    if (whole) {
        fill_coarse(c, path, count, 0, count - 1);
        refine(c, count, true, 0);
        memcpy(c->positions[c->position_count - 1], c->positions[0], sizeof *c->positions);
        return true;
    }
    for (size_t i = 1; i <= count; i++) {
        if (i < count && !is_corner(c, path[i - 1], path[i]))
            continue;
        fill_coarse(c, path, count, start, i);
        refine(c, i - start + 1, false, start * pieces);
        start = i;
    }
    return true;
}

void curve_path_at(const curve_path *c, size_t i, double fraction, double out[3])
{
    double at = ((double)i + fraction) * (double)((size_t)1 << c->steps),
           low = fmin(floor(at), (double)(c->position_count - 2));
    const double *p = c->positions[(size_t)low], *q = c->positions[(size_t)low + 1];
    for (int k = 0; k < 3; k++)
        out[k] = p[k] + (at - low) * (q[k] - p[k]);
}
