#include "solid.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { LOOP_MAX = 2400 };

static const struct {
    int u, v, t; /* axes */
    int sign;    /* of t */
} systems[] = {
    [RIGHT] = {1, 2, 0, 1}, [LEFT] = {2, 1, 0, -1}, [UP] = {2, 0, 1, 1},
    [DOWN] = {0, 2, 1, -1}, [FRONT] = {0, 1, 2, 1}, [BACK] = {1, 0, 2, -1},
};

_Noreturn void give_up(void)
{
    exit(EXIT_FAILURE);
}

static void *grow(void *array, uint32_t count, uint32_t *space, size_t size)
{
    if (count < *space)
        return array;
    *space = *space ? *space * 2 : 1024;
    void *bigger = realloc(array, *space * size);
    if (!bigger)
        give_up();
    return bigger;
}

uint32_t put_point(mesh *m, const frame *f, double u, double v, double t)
{
    m->points = grow(m->points, m->point_count, &m->point_space, sizeof *m->points);
    point *p = &m->points[m->point_count];
    double at[3] = {f->origin[0], f->origin[1], f->origin[2]};
    at[systems[f->along].u] += u;
    at[systems[f->along].v] += v;
    at[systems[f->along].t] += systems[f->along].sign * t;
    for (int k = 0; k < 3; k++)
        p->at[k] = (int32_t)lround(at[k] * GRID);
    return m->point_count++;
}

void put_triangle(mesh *m, uint32_t a, uint32_t b, uint32_t c)
{
    const uint32_t corners[3] = {a, b, c};
    for (int k = 0; k < 3; k++) {
        m->indices = grow(m->indices, m->index_count, &m->index_space, sizeof *m->indices);
        m->indices[m->index_count++] = corners[k];
    }
}

ring put_ring(mesh *m, const frame *f, const outline *o, double t)
{
    ring r = {.count = o->count};
    for (int i = 0; i < o->count; i++)
        r.at[i] = put_point(m, f, o->at[i][0], o->at[i][1], t + o->at[i][2]);
    return r;
}

void sew_columns(mesh *m, const ring *a, const ring *b, int first, int count)
{
    if (a->count != b->count)
        give_up();
    for (int k = first; k < first + count; k++) {
        int i = k % a->count, j = (k + 1) % a->count;
        put_triangle(m, a->at[i], a->at[j], b->at[j]);
        put_triangle(m, a->at[i], b->at[j], b->at[i]);
    }
}

void sew(mesh *m, const ring *a, const ring *b)
{
    sew_columns(m, a, b, 0, a->count);
}

/* --- flat faces ----------------------------------------------------------------------------------------- */

typedef struct corner {
    int64_t  u, v;
    uint32_t index;
} corner;

typedef struct loop {
    int    count;
    corner at[LOOP_MAX];
} loop;

/* Twice the area of a triangle; exact. */
static int64_t turn(corner a, corner b, corner c)
{
    return (b.u - a.u) * (c.v - a.v) - (b.v - a.v) * (c.u - a.u);
}

static int64_t distance_squared(corner a, corner b)
{
    return (b.u - a.u) * (b.u - a.u) + (b.v - a.v) * (b.v - a.v);
}

static bool same(corner a, corner b)
{
    return a.u == b.u && a.v == b.v;
}

static bool opposite(int64_t a, int64_t b)
{
    return (a <= 0 && b >= 0) || (a >= 0 && b <= 0);
}

static bool apart(corner p, corner q, corner a, corner b)
{
    return (a.u > p.u && a.u > q.u && b.u > p.u && b.u > q.u) || (a.u < p.u && a.u < q.u && b.u < p.u && b.u < q.u) ||
           (a.v > p.v && a.v > q.v && b.v > p.v && b.v > q.v) || (a.v < p.v && a.v < q.v && b.v < p.v && b.v < q.v);
}

/* Whether edge a–b stands in the way of the segment p–q. Meeting at an end does not, running along it does. */
static bool blocks(corner p, corner q, corner a, corner b)
{
    if (apart(p, q, a, b))
        return false;
    bool at_a = same(a, p) || same(a, q), at_b = same(b, p) || same(b, q);
    if (at_a && at_b)
        return false;
    if (at_a || at_b) {
        corner  shared = at_a ? a : b, other = at_a ? b : a, far = same(shared, p) ? q : p;
        int64_t ahead = (far.u - shared.u) * (other.u - shared.u) + (far.v - shared.v) * (other.v - shared.v);
        return turn(p, q, other) == 0 && ahead > 0;
    }
    return opposite(turn(p, q, a), turn(p, q, b)) && opposite(turn(a, b, p), turn(a, b, q));
}

static bool loop_blocks(const loop *l, corner p, corner q)
{
    for (int i = 0; i < l->count; i++)
        if (blocks(p, q, l->at[i], l->at[(i + 1) % l->count]))
            return true;
    return false;
}

/* Whether the way from corner i to a point begins inside the loop, which has its inside at the left. */
static bool begins_inside(const loop *l, int i, corner to)
{
    corner at = l->at[i], before = l->at[(i + l->count - 1) % l->count], after = l->at[(i + 1) % l->count];
    if (turn(before, at, after) >= 0)
        return turn(at, to, before) > 0 && turn(to, at, after) > 0;
    return !(turn(at, to, after) >= 0 && turn(to, at, before) >= 0);
}

static void loop_of_ring(loop *l, const mesh *m, const ring *r, direction facing, bool hole)
{
    int64_t area = 0;
    l->count = r->count;
    for (int i = 0; i < r->count; i++) {
        const int32_t *at = m->points[r->at[i]].at;
        l->at[i] = (corner){at[systems[facing].u], at[systems[facing].v], r->at[i]};
    }
    for (int i = 0; i < l->count; i++) {
        corner a = l->at[i], b = l->at[(i + 1) % l->count];
        area += a.u * b.v - a.v * b.u;
    }
    if ((area < 0) != hole)
        for (int i = 0, j = l->count - 1; i < j; i++, j--) {
            corner kept = l->at[i];
            l->at[i] = l->at[j];
            l->at[j] = kept;
        }
}

static bool hidden(const loop *main, const loop *holes, int hole_count, corner p, corner q)
{
    bool blocked = loop_blocks(main, p, q);
    for (int h = 0; h < hole_count && !blocked; h++)
        blocked = loop_blocks(&holes[h], p, q);
    return blocked;
}

/* Joins the hole that is nearest to the main loop by a bridge to and fro, and drops it from the list. */
static void bridge_hole(loop *main, loop *holes, int hole_count)
{
    int64_t best = INT64_MAX;
    int     hole = -1, from = 0, to = 0;
    for (int h = 0; h < hole_count; h++)
        for (int i = 0; i < main->count; i++)
            for (int j = 0; j < holes[h].count; j++) {
                corner  p = main->at[i], q = holes[h].at[j];
                int64_t length = distance_squared(p, q);
                if (length >= best || !begins_inside(main, i, q) || !begins_inside(&holes[h], j, p) ||
                    hidden(main, holes, hole_count, p, q))
                    continue;
                best = length;
                hole = h;
                from = i;
                to = j;
            }
    if (hole < 0 || main->count + holes[hole].count + 2 > LOOP_MAX)
        give_up();
    int more = holes[hole].count + 2;
    memmove(&main->at[from + more], &main->at[from], (size_t)(main->count - from) * sizeof *main->at);
    for (int k = 0; k <= holes[hole].count; k++)
        main->at[from + 1 + k] = holes[hole].at[(to + k) % holes[hole].count];
    main->count += more;
    holes[hole] = holes[hole_count - 1];
}

/* Cuts off the ear with the shortest diagonal, which keeps the triangles compact. */
static void clip_ear(mesh *m, loop *l)
{
    int64_t best = INT64_MAX;
    int     ear = -1;
    for (int i = 0; i < l->count; i++) {
        int     h = (i + l->count - 1) % l->count, j = (i + 1) % l->count;
        corner  a = l->at[h], b = l->at[i], c = l->at[j];
        int64_t length = distance_squared(a, c);
        if (length >= best || turn(a, b, c) <= 0)
            continue;
        if (l->count > 3 && (!begins_inside(l, h, c) || !begins_inside(l, j, a) || loop_blocks(l, a, c)))
            continue;
        best = length;
        ear = i;
    }
    if (ear < 0)
        give_up();
    put_triangle(m, l->at[(ear + l->count - 1) % l->count].index, l->at[ear].index, l->at[(ear + 1) % l->count].index);
    l->count--;
    memmove(&l->at[ear], &l->at[ear + 1], (size_t)(l->count - ear) * sizeof *l->at);
}

void cap(mesh *m, direction facing, const ring *outer, const ring *holes, int hole_count)
{
    static loop main, inner[HOLES_MAX];
    loop_of_ring(&main, m, outer, facing, false);
    for (int h = 0; h < hole_count; h++)
        loop_of_ring(&inner[h], m, &holes[h], facing, true);
    for (; hole_count > 0; hole_count--)
        bridge_hole(&main, inner, hole_count);
    while (main.count >= 3)
        clip_ear(m, &main);
}

/* --- outlines and solids of revolution ------------------------------------------------------------------ */

void add_point(outline *o, double u, double v)
{
    if (o->count == RING_MAX)
        give_up();
    o->at[o->count][0] = u;
    o->at[o->count][1] = v;
    o->at[o->count++][2] = 0;
}

void add_arc(outline *o, double u, double v, double radius, double from, double to, int segments)
{
    for (int i = 0; i <= segments; i++) {
        double angle = (from + (to - from) * i / segments) * PI / 180;
        add_point(o, u + radius * cos(angle), v + radius * sin(angle));
    }
}

outline circle(double u, double v, double radius, int segments)
{
    outline o = {0};
    add_arc(&o, u, v, radius, 0, 360, segments);
    o.count--; /* the end is the start */
    return o;
}

outline double_round(double half_distance, double radius, double from, int segments)
{
    outline o = {0};
    add_arc(&o, 0, half_distance, radius, -from, 180 + from, segments);
    add_arc(&o, 0, -half_distance, radius, 180 - from, 360 + from, segments);
    return o;
}

outline rectangle(double left, double bottom, double right, double top)
{
    outline o = {0};
    add_point(&o, left, bottom);
    add_point(&o, right, bottom);
    add_point(&o, right, top);
    add_point(&o, left, top);
    return o;
}

void lathe(mesh *m, const frame *f, const double (*profile)[2], int count, int segments, ring *first, ring *last)
{
    ring before = {0};
    for (int k = 0; k < count; k++) {
        double  t = profile[k][0], radius = profile[k][1];
        outline o = circle(0, 0, radius, segments);
        ring    here = {.count = segments};
        if (radius > 0) {
            here = put_ring(m, f, &o, t);
        } else {
            uint32_t tip = put_point(m, f, 0, 0, t);
            for (int i = 0; i < segments; i++)
                here.at[i] = tip;
        }
        for (int i = 0; k > 0 && i < segments; i++) {
            int j = (i + 1) % segments;
            if (before.at[i] != before.at[j])
                put_triangle(m, before.at[i], before.at[j], here.at[j]);
            if (here.at[i] != here.at[j])
                put_triangle(m, before.at[i], here.at[j], here.at[i]);
        }
        if (k == 0 && first)
            *first = here;
        before = here;
    }
    if (last)
        *last = before;
}

void extrude_along(mesh *m, const frame *f, const outline *outer, const outline *holes, int hole_count, double from,
                   double to)
{
    static const direction opposites[] = {
        [RIGHT] = LEFT, [LEFT] = RIGHT, [UP] = DOWN, [DOWN] = UP, [FRONT] = BACK, [BACK] = FRONT,
    };
    ring low = put_ring(m, f, outer, from), high = put_ring(m, f, outer, to), low_holes[HOLES_MAX],
         high_holes[HOLES_MAX];
    sew(m, &low, &high);
    for (int h = 0; h < hole_count; h++) {
        low_holes[h] = put_ring(m, f, &holes[h], from);
        high_holes[h] = put_ring(m, f, &holes[h], to);
        sew(m, &high_holes[h], &low_holes[h]);
    }
    cap(m, opposites[f->along], &low, low_holes, hole_count);
    cap(m, f->along, &high, high_holes, hole_count);
}

void extrude(mesh *m, const outline *outer, const outline *holes, int hole_count, double from, double to)
{
    extrude_along(m, &(frame){.along = FRONT}, outer, holes, hole_count, from, to);
}

void drop_unused(mesh *m)
{
    uint32_t *positions = calloc(m->point_count, sizeof *positions), kept = 0;
    if (!positions)
        give_up();
    for (uint32_t i = 0; i < m->index_count; i++)
        positions[m->indices[i]] = 1;
    for (uint32_t i = 0; i < m->point_count; i++)
        if (positions[i]) {
            m->points[kept] = m->points[i];
            positions[i] = kept++;
        }
    for (uint32_t i = 0; i < m->index_count; i++)
        m->indices[i] = positions[m->indices[i]];
    m->point_count = kept;
    free(positions);
}
