#include "stroke/curve_path.h"

#include <math.h>
#include <string.h>

#include "base/memory.h"
#include "stroke/curve.h"

/* Cosines of 75° and 40°: a subdivided curve, one of arcs ends where sharp edges turn further. */
#define CORNER_COSINE 0.25881904510252074
#define STEP_COSINE   0.76604444311897801
/* Arcs are drawn in pieces that are so close to them, window units of paper. */
#define ARC_ERROR 0.03
enum { ARC_PIECES_MAX = 16 };

static void count_sharp_at(uint8_t *sharp, const uint32_t vertices[2])
{
    for (int k = 0; k < 2; k++)
        if (sharp[vertices[k]] < 3)
            sharp[vertices[k]]++;
}

/* Counts, for each vertex, the sharp edges of its mesh, whether they are drawn or not, and lines that the file brings
 * where no such edge is: CAD programs draw them along the edges of faces that they have split into straight pieces. */
static void count_sharp(curve_path *c, bool drawn)
{
    const stroke_scene *s = c->v->scene;
    for (size_t i = 0; i < s->item_count; i++) {
        const edge_mesh *m = &s->meshes[s->items[i].mesh];
        uint8_t         *sharp = c->sharp + c->v->items[i].first_point;
        for (uint32_t e = 0; e < m->edge_count; e++)
            if (m->edges[e].flags & (EDGE_CREASE | EDGE_BORDER))
                count_sharp_at(sharp, m->edges[e].vertex);
        for (uint32_t l = 0; l < m->line_count && drawn; l++)
            if (m->lines[l].edge == EDGE_NO_FACE || !(m->edges[m->lines[l].edge].flags & (EDGE_CREASE | EDGE_BORDER)))
                count_sharp_at(sharp, m->lines[l].vertex);
    }
}

bool curve_path_open(curve_path *c, const stroke_view *v, const view_lines *lines, const stroke_options *options)
{
    int steps = options->curve < CURVE_STEPS_MAX ? options->curve : CURVE_STEPS_MAX;
    *c = (curve_path){.v = v, .lines = lines, .steps = steps > 0 ? steps : 0, .most = options->round * v->units};
    if (c->steps == 0 && c->most <= 0)
        return true;
    c->sharp = mem_calloc((size_t)v->vertex_count + 1, 1);
    if (c->sharp)
        count_sharp(c, options->drawn);
    return c->sharp != NULL;
}

void curve_path_close(curve_path *c)
{
    mem_free(c->sharp);
    mem_free(c->positions);
    mem_free(c->coarse);
    mem_free(c->points);
    mem_free(c->arcs);
    memset(c, 0, sizeof *c);
}

bool curve_path_bends(const curve_path *c, stroke_class kind)
{
    return c->sharp &&
           (kind == STROKE_CONTOUR || kind == STROKE_BORDER || kind == STROKE_CREASE || kind == STROKE_DRAWN);
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
static bool turns_sharply(const curve_path *c, uint32_t in, uint32_t out, double cosine)
{
    uint32_t before = number_of(c, in), here = number_of(c, out), after = number_of(c, out ^ 1);
    if (before >= c->v->vertex_count || after >= c->v->vertex_count)
        return false;
    double3 p = world_of(c, &c->lines->lines[in / 2], before), q = world_of(c, &c->lines->lines[out / 2], here),
            r = world_of(c, &c->lines->lines[out / 2], after);
    double ax = q.x - p.x, ay = q.y - p.y, az = q.z - p.z, bx = r.x - q.x, by = r.y - q.y, bz = r.z - q.z;
    double lengths = sqrt((ax * ax + ay * ay + az * az) * (bx * bx + by * by + bz * bz));
    return ax * bx + ay * by + az * bz < cosine * lengths;
}

static bool is_sharp(const curve_path *c, uint32_t half)
{
    const view_line *line = &c->lines->lines[half / 2];
    return line->sharp || line->kind == STROKE_DRAWN;
}

/* What is where one half-line leads to the next, and two that turn further than that are none of a curve? */
static arc_point_kind judge(const curve_path *c, uint32_t in, uint32_t out, double cosine)
{
    uint32_t here = number_of(c, out);
    if (here >= c->v->vertex_count || c->sharp[here] == 0)
        return ARC_POINT_SMOOTH;
    bool sharp_in = is_sharp(c, in), sharp_out = is_sharp(c, out);
    if (c->sharp[here] != 2 || sharp_in != sharp_out || (sharp_in && turns_sharply(c, in, out, cosine)))
        return ARC_POINT_CORNER;
    return sharp_in ? ARC_POINT_STEP : ARC_POINT_SMOOTH;
}

static bool is_corner(const curve_path *c, uint32_t in, uint32_t out)
{
    return judge(c, in, out, CORNER_COSINE) == ARC_POINT_CORNER;
}

/* Where the chain's i-th line begins; at their number, where the last one ends. */
static const window_point *point_of(const curve_path *c, size_t i)
{
    return i < c->count ? position_of(c, c->path[i]) : position_of(c, c->path[c->count - 1] ^ 1);
}

/* Points first … last of the chain, as they are. */
static void fill_coarse(curve_path *c, size_t first, size_t last)
{
    for (size_t i = first; i <= last; i++) {
        const window_point *p = point_of(c, i);
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

static bool subdivide(curve_path *c, bool closed)
{
    size_t pieces = (size_t)1 << c->steps, count = c->count, needed = count * pieces + 2, start = 0;
    if (!mem_grow((void **)&c->positions, &c->position_capacity, needed, sizeof *c->positions) ||
        !mem_grow((void **)&c->coarse, &c->coarse_capacity, needed, sizeof *c->coarse))
        return false;
    bool whole = closed && count > 2 && !is_corner(c, c->path[count - 1], c->path[0]);
    for (size_t i = 1; i < count && whole; i++)
        whole = !is_corner(c, c->path[i - 1], c->path[i]);
    if (whole) {
        fill_coarse(c, 0, count - 1);
        refine(c, count, true, 0);
        memcpy(c->positions[count * pieces], c->positions[0], sizeof *c->positions);
        return true;
    }
    for (size_t i = 1; i <= count; i++) {
        if (i < count && !is_corner(c, c->path[i - 1], c->path[i]))
            continue;
        fill_coarse(c, start, i);
        refine(c, i - start + 1, false, start * pieces);
        start = i;
    }
    return true;
}

static bool make_arcs(curve_path *c, bool closed)
{
    if (!mem_grow((void **)&c->points, &c->point_capacity, c->count + 1, sizeof *c->points) ||
        !mem_grow((void **)&c->arcs, &c->arc_capacity, c->count, sizeof *c->arcs))
        return false;
    for (size_t i = 0; i <= c->count; i++) {
        const window_point *p = point_of(c, i);
        bool                between = (i > 0 && i < c->count) || (i == 0 && closed);
        c->points[i] = (arc_point){.x = p->x, .y = p->y, .kind = ARC_POINT_CORNER};
        if (between)
            c->points[i].kind = (int)judge(c, c->path[i > 0 ? i - 1 : c->count - 1], c->path[i], STEP_COSINE);
    }
    closed = closed && c->count > 2;
    curve_arcs(c->arcs, c->points, closed ? c->count : c->count + 1, closed, c->most);
    if (closed)
        c->points[c->count] = c->points[0];
    return true;
}

bool curve_path_take(curve_path *c, const uint32_t *path, size_t count, bool closed)
{
    c->path = path;
    c->count = count;
    return c->steps > 0 ? subdivide(c, closed) : make_arcs(c, closed);
}

size_t curve_path_pieces(const curve_path *c, size_t i)
{
    if (c->steps > 0)
        return (size_t)1 << c->steps;
    /* A parabola over a chord is off by a quarter of its height from two straight pieces, and so on. */
    double height = 0.125 * (fabs(c->arcs[i].begin) + fabs(c->arcs[i].end)) * c->points[i].length / c->v->units;
    double pieces = ceil(sqrt(height / ARC_ERROR));
    return pieces < 1 ? 1 : pieces > ARC_PIECES_MAX ? ARC_PIECES_MAX : (size_t)pieces;
}

double curve_path_stop(const curve_path *c, size_t i, size_t k)
{
    size_t pieces = curve_path_pieces(c, i);
    if (k == 0 || k >= pieces)
        return k == 0 ? 0 : 1;
    if (c->steps == 0)
        return (double)k / (double)pieces;
    const double *a = c->positions[i * pieces], *b = c->positions[(i + 1) * pieces], *p = c->positions[i * pieces + k];
    double        x = b[0] - a[0], y = b[1] - a[1], length = x * x + y * y;
    double        fraction = length > 0 ? ((p[0] - a[0]) * x + (p[1] - a[1]) * y) / length : (double)k / (double)pieces;
    /* Strongly bent curves overhang their lines; those keep their order and nothing else. */
    return fmin(fmax(fraction, (double)k / (double)(4 * pieces)), 1 - (double)(pieces - k) / (double)(4 * pieces));
}

/* Beside a fraction of the i-th line, on its arc. */
static void arc_at(const curve_path *c, size_t i, double fraction, double out[3])
{
    const window_point *a = point_of(c, i), *b = position_of(c, c->path[i] ^ 1);
    const arc_point    *p = &c->points[i], *q = p + 1;
    double              x = q->x - p->x, y = q->y - p->y, away = arc_height(c->arcs[i], fraction);
    out[0] = p->x + fraction * x - away * y;
    out[1] = p->y + fraction * y + away * x;
    out[2] = a->z + fraction * (b->z - a->z);
}

void curve_path_at(const curve_path *c, size_t i, double fraction, double out[3])
{
    if (c->steps == 0) {
        arc_at(c, i, fraction, out);
        return;
    }
    size_t pieces = curve_path_pieces(c, i), k = 0;
    while (k + 1 < pieces && curve_path_stop(c, i, k + 1) <= fraction)
        k++;
    double        from = curve_path_stop(c, i, k), to = curve_path_stop(c, i, k + 1);
    double        share = to > from ? fmin(fmax((fraction - from) / (to - from), 0), 1) : 0;
    const double *p = c->positions[i * pieces + k], *q = c->positions[i * pieces + k + 1];
    for (int j = 0; j < 3; j++)
        out[j] = p[j] + share * (q[j] - p[j]);
}
