/* How many surfaces lie in front of each stretch of a line: every triangle that crosses it in the window covers it from
 * one crossing to the other, as far as it is nearer.
 *
 * What makes this hold together where triangles meet: on which side of the line a corner lies is exact, and a corner on
 * the line counts as being on the positive side, as if the line were shifted a little to the other one. So a line that
 * runs along the edge between two triangles is covered by one of them, not by both or neither, and where a line leaves
 * one triangle for the next the two numbers are the same, because both come from the edge that they share. Where the
 * edges of two bodies meet, as of parts that touch, they share none, and roundings leave gaps that are no width at all:
 * a line that runs along such an edge is hidden, too, where it would be a little to either side of it. */
#include "stroke/stroke_private.h"

#include <math.h>
#include <stdatomic.h>
#include <string.h>

#include "base/memory.h"
#include "base/threads.h"
#include "stroke/line_filter.h"
#include "stroke/solid_cover.h"

/* Stretches shorter than this are not told apart, pixels. */
#define CRUMB 0.02
enum { BLOCK = 512, RUN_MOST = 256 };
/* Corners of the grid's entries are put together where it has no more of them for each segment. */
enum { ENTRIES_A_SEGMENT = 48 };

/* Spans of the segments of a block, which is what a thread takes at a time. */
typedef struct span_block {
    visibility_span *spans;
    size_t           count, capacity;
    uint64_t         pairs, entries;
} span_block;

typedef struct span_job {
    const stroke_view    *v;
    const window_segment *segments;
    const uint32_t       *order;   /* segments as they are looked at: those side by side ask for the same triangles */
    size_t                count;   /* of these */
    grid_corners          corners; /* where there are many segments */
    span_block           *blocks;
    uint32_t             *lengths; /* spans per segment */
    atomic_bool           failed;
} span_job;

/* A position of the segment and by how many surfaces its cover grows there. Most positions are edges between two
 * triangles, where one cover ends and another one begins at the very same number, so that nothing is left of them. */
typedef struct position_step {
    double  at;
    int32_t step;
} position_step;

typedef struct position_slot {
    double   at;
    int32_t  step;
    uint32_t stamp; /* the segment that it was filled for */
} position_slot;

/* One thread's work on one segment. */
typedef struct worker {
    const stroke_view    *v;
    const window_segment *segment;
    double                same;    /* of the segment's piece, where these differ */
    const grid_corners   *corners; /* NULL: they do not lie together */
    line_test             line;
    bool                  wide;      /* the processor has wide registers */
    uint32_t              planes[2]; /* that the segment lies in, ascending; 0: not known */
    uint32_t              wheels[2]; /* that it begins and ends in the middle of; 0: none */
    uint32_t             *stamps;    /* per triangle: the last segment that it was compared with */
    uint32_t              stamp;
    position_slot        *table; /* of places where covers begin or end, found by their bits */
    size_t                table_size;
    uint32_t             *filled; /* slots of this segment */
    size_t                filled_count, filled_capacity;
    int64_t               begins; /* inner triangles in front that the segment begins behind */
    position_step        *steps;
    size_t                step_capacity;
    solid_covers          covers; /* of faces of solids */
    uint64_t              pairs, entries;
    double                gap;    /* GAP by the segment's length: sides of corners so near are none, window units */
    double                beside; /* by how many units the segment was moved aside; 0: it is where it is */
    bool                  grazed; /* an edge of another body's face runs along it */
    span_block            sides[2], merged; /* spans to either side of it; those that go into the block */
    bool                  failed;
} worker;

static bool has_corner(const window_triangle *t, uint32_t point)
{
    return (point != NO_VERTEX) & ((t->v[0] == point) | (t->v[1] == point) | (t->v[2] == point));
}

static size_t slot_of(const worker *w, double at)
{
    uint64_t bits;
    memcpy(&bits, &at, sizeof bits);
    size_t slot = (bits * UINT64_C(0x9E3779B97F4A7C15)) >> 32 & (w->table_size - 1);
    while (w->table[slot].stamp == w->stamp && w->table[slot].at != at)
        slot = (slot + 1) & (w->table_size - 1);
    return slot;
}

static bool grow_table(worker *w)
{
    size_t size = w->table_size ? 4 * w->table_size : 1024;
    worker bigger = *w;
    bigger.table_size = size;
    bigger.table = mem_calloc(size, sizeof *bigger.table);
    if (!bigger.table)
        return false;
    for (size_t i = 0; i < w->filled_count; i++) {
        position_slot *from = &w->table[w->filled[i]];
        size_t         slot = slot_of(&bigger, from->at);
        bigger.table[slot] = *from;
        w->filled[i] = (uint32_t)slot;
    }
    mem_free(w->table);
    w->table = bigger.table;
    w->table_size = size;
    return true;
}

static void put_step(worker *w, double at, int32_t step)
{
    if ((2 * w->filled_count >= w->table_size && !grow_table(w)) ||
        !mem_grow((void **)&w->filled, &w->filled_capacity, w->filled_count + 1, sizeof *w->filled)) {
        w->failed = true;
        return;
    }
    position_slot *slot = &w->table[slot_of(w, at)];
    const bool     is_new = slot->stamp != w->stamp; /* every other one, without a pattern: no branch */
    w->filled[w->filled_count] = (uint32_t)(slot - w->table);
    w->filled_count += is_new;
    *slot = (position_slot){at, (is_new ? 0 : slot->step) + step, w->stamp};
}

/* Between two positions of the segment the triangle lies nearer by before … after; what differs by less than `same` is
 * the same. False where it is nowhere nearer; else the positions are where it is. */
static bool find_nearer(double *from, double *to, double before, double after, double same)
{
    bool begins = before > same, ends = after > same;
    if (begins && !ends && after < -same)
        *to = *from + (*to - *from) * (before / (before - after));
    else if (ends && !begins && before < -same)
        *from = *from + (*to - *from) * (before / (before - after));
    return begins || ends;
}

static void cover_nearer(worker *w, double from, double to, double before, double after, double same)
{
    if (!find_nearer(&from, &to, before, after, same))
        return;
    put_step(w, from, 1);
    put_step(w, to, -1);
}

/* The face of a solid from one position to another, with its depths there. Where the eye may be in the solid, what lies
 * behind the segment counts too. */
static void cover_of_solid(worker *w, solid_cover c, double before, double after, double same)
{
    double from = c.from, to = c.to, rise = (c.z[1] - c.z[0]) / (to - from), z = c.z[0];
    bool   nearer = find_nearer(&from, &to, before, after, same), around = w->v->around[c.item];
    double stops[4] = {c.from, nearer ? from : c.to, nearer ? to : c.to, c.to};
    for (int k = 0; k < 3; k++) {
        solid_cover part = c;
        part.from = stops[k];
        part.to = stops[k + 1];
        part.z[0] = z + (part.from - c.from) * rise;
        part.z[1] = z + (part.to - c.from) * rise;
        part.nearer = nearer && k == 1;
        if (part.from < part.to && (part.nearer || around) && !solid_covers_put(&w->covers, &part))
            w->failed = true;
    }
}

static bool is_ignored(const window_segment *s, uint32_t face)
{
    uint32_t low = 0, high = s->ignored_count;
    while (low < high) {
        uint32_t middle = (low + high) / 2;
        if (s->ignored[middle] < face)
            low = middle + 1;
        else
            high = middle;
    }
    return low < s->ignored_count && s->ignored[low] == face;
}

/* How much nearer a triangle may be at a depth, so that a position behind it is no farther than `lift` from its
 * plane. In perspective z is −1 / depth, and a plane that passes the eye at a distance c is z(x, y) with
 * 1 / c² = |gradient|² + z(0, 0)², lengths of the window in units of the focal length; at depth z a difference of z
 * is one of c / |z| in the direction of the normal. */
static double depth_of_lift(const stroke_view *v, const window_point p[3], double z, double lift)
{
    double ax = (double)p[1].x - p[0].x, ay = (double)p[1].y - p[0].y, az = p[1].z - p[0].z;
    double bx = (double)p[2].x - p[0].x, by = (double)p[2].y - p[0].y, bz = p[2].z - p[0].z;
    double area = ax * by - ay * bx, x = (az * by - bz * ay) / area, y = (ax * bz - bx * az) / area;
    double focal = 0.5 * v->camera.height * fabs(v->camera.projection.m[5]) * v->units;
    double steep = focal * focal * (x * x + y * y);
    if (v->camera.orthographic)
        return lift * sqrt(1 + steep);
    double middle = p[0].z - x * p[0].x - y * p[0].y;
    return lift * fabs(z) * sqrt(steep + middle * middle);
}

/* Is the triangle of a piece that changes places with the segment's own? */
static bool is_beside(const worker *w, uint32_t face)
{
    const window_segment *s = w->segment;
    uint32_t              low = 0, high = s->beside_count, piece = s->beside_count ? w->v->face_pieces[face] : 0;
    while (low < high) {
        uint32_t middle = (low + high) / 2;
        if (s->beside[middle] < piece)
            low = middle + 1;
        else
            high = middle;
    }
    return low < s->beside_count && s->beside[low] == piece;
}

/* Is the face one of a solid that may be around the eye? Then it counts wherever it is met. */
static bool is_around(const stroke_view *v, uint32_t face)
{
    uint32_t solid = view_solid(v, face);
    return solid && v->around[solid - 1];
}

/* A triangle's corners on the page, as exact as they are, and on which side of the segment's line each lies. */
typedef struct flat_triangle {
    double x[3], y[3], sides[3];
} flat_triangle;

static inline void put_corner(const worker *w, flat_triangle *out, int k, uint32_t number, size_t corner)
{
    const grid_corners   *c = w->corners;
    const window_point   *p = &w->v->points[w->v->triangles[number].v[k]];
    const window_segment *s = w->segment;
    const double          x = c ? (double)c->x[k][corner] : p->x, y = c ? (double)c->y[k][corner] : p->y;
    out->x[k] = x;
    out->y[k] = y;
    out->sides[k] = ((double)s->b.x - s->a.x) * (y - s->a.y) - ((double)s->b.y - s->a.y) * (x - s->a.x);
}

/* Does an edge of a triangle run along the segment, so near that it might as well lie on its other side? */
static bool runs_along(const worker *w, const flat_triangle *t)
{
    const window_segment *s = w->segment;
    double                from = INFINITY, to = -INFINITY, x = (double)s->b.x - s->a.x, y = (double)s->b.y - s->a.y;
    int                   near = 0;
    for (int k = 0; k < 3; k++) {
        if (fabs(t->sides[k]) > w->gap)
            continue;
        double at = x * (t->x[k] - s->a.x) + y * (t->y[k] - s->a.y);
        from = at < from ? at : from;
        to = at > to ? at : to;
        near++;
    }
    return near == 2 && to > 0 && from < x * x + y * y;
}

/* Does a face lie in a plane of the segment's? Then it hides nothing of it. */
static bool is_in_plane(const worker *w, uint32_t face)
{
    uint32_t plane = w->v->planes ? w->v->planes[face] : 0;
    return plane && (plane == w->planes[0] || plane == w->planes[1]);
}

static bool is_own(const worker *w, uint32_t face)
{
    return (face == w->segment->faces[0]) | (face == w->segment->faces[1]);
}

/* Where the segment crosses the edge between two corners: fraction of it. */
static double cross_edge(const worker *w, const flat_triangle *t, int p, int q)
{
    const window_segment *s = w->segment;
    double                x = t->x[q] - t->x[p], y = t->y[q] - t->y[p];
    double a = x * (s->a.y - t->y[p]) - y * (s->a.x - t->x[p]), b = x * (s->b.y - t->y[p]) - y * (s->b.x - t->x[p]);
    return a / (a - b);
}

/* Two crossings of a triangle's rim, in order along the segment, and depths there. */
typedef struct crossing_pair {
    double t[2], z[2];
} crossing_pair;

/* What of the segment a triangle covers that is crossed from one place to the other. */
static void cover_by(worker *w, uint32_t number, const crossing_pair *c)
{
    const stroke_view     *v = w->v;
    const window_box      *box = &v->boxes[number];
    const window_triangle *t = &v->triangles[number];
    const window_segment  *s = w->segment;
    const bool             own = is_own(w, t->face);
    double                 from = c->t[0] > 0 ? c->t[0] : 0, to = c->t[1] < 1 ? c->t[1] : 1, z0 = c->z[0],
           rise = (c->z[1] - z0) / (c->t[1] - c->t[0]), run = s->b.z - s->a.z;
    double before = s->a.z + from * run - (z0 + (from - c->t[0]) * rise),
           after = s->a.z + to * run - (z0 + (to - c->t[0]) * rise);
    const bool meets_first = own | ((from == 0) & has_corner(t, s->ends[0])),
               meets_last = own | ((to == 1) & has_corner(t, s->ends[1]));
    before = meets_first ? 0 : before;
    after = meets_last ? 0 : after;
    double lift = is_beside(w, t->face) ? fmax(s->lift, BESIDE_LIFT * v->scene->extent) : s->lift;
    double exact = v->sames ? fmax(w->same, v->sames[v->face_pieces[t->face]]) : v->same;
    double same = view_tolerance(v, exact, z0) + (1 + w->beside) * box->slope;
    if (lift > 0) {
        const window_point p[3] = {v->points[t->v[0]], v->points[t->v[1]], v->points[t->v[2]]};
        same += depth_of_lift(v, p, z0, lift);
    }
    if (s->ignored_count && is_ignored(s, t->face))
        return;
    uint32_t solid = view_solid(v, t->face);
    if (solid)
        cover_of_solid(
            w,
            solid_cover_of(v, solid - 1, t->face, from, to, z0 + (from - c->t[0]) * rise, z0 + (to - c->t[0]) * rise),
            before, after, same);
    else
        cover_nearer(w, from, to, before, after, same);
}

/* Does the triangle end in front of the segment? Then what it covers of it goes on in those beyond its edges, and what
 * counts is whether the segment begins behind it, and where it is at a rim. */
static inline bool is_in_front(const worker *w, uint32_t number)
{
    return w->v->boxes[number].far_z < w->line.front_z;
}

/* Where the segment crosses an edge of a triangle to what lies beyond it: at a rim, what is in front begins or ends;
 * and what goes on behind a triangle in front, or came from there, begins or ends for itself. */
static inline void cross_rim(worker *w, bool front, uint32_t beyond, double at, int32_t step)
{
    if (at > 0 && at < 1 && (front ? beyond == NO_TRIANGLE : beyond != NO_TRIANGLE && is_in_front(w, beyond)))
        put_step(w, at, front ? step : -step);
}

/* Two edges that the segment crosses, which begin at the corner that lies alone and at the one before. */
static void cross_rims(worker *w, bool front, uint32_t number, const flat_triangle *t, int alone, const double at[2])
{
    const uint32_t *beyond = w->v->beyond[number];
    const double    area = (t->x[1] - t->x[0]) * (t->y[2] - t->y[0]) - (t->y[1] - t->y[0]) * (t->x[2] - t->x[0]);
    const int32_t   step = (area > 0) == (t->sides[alone] < 0) ? -1 : 1; /* it leaves by the first edge, or comes */
    cross_rim(w, front, beyond[alone], at[0], step);
    cross_rim(w, front, beyond[alone == 0 ? 2 : alone - 1], at[1], -step);
}

/* `corner`: of the triangle in the grid's corners, which lie together; what lies elsewhere is read only of triangles
 * that the segment crosses, or runs along. Which corner lies alone and which crossing comes first has no pattern that
 * could be foretold, so that numbers say it and not branches. */
static void compare(worker *w, uint32_t number, size_t corner)
{
    static const uint8_t   alone_of[8] = {0, 0, 1, 2, 2, 1, 0, 0}, after[3] = {1, 2, 0}, before[3] = {2, 0, 1};
    const stroke_view     *v = w->v;
    const window_triangle *t = &v->triangles[number];
    flat_triangle          flat;
    const double          *sides = flat.sides;
    put_corner(w, &flat, 0, number, corner);
    put_corner(w, &flat, 1, number, corner);
    put_corner(w, &flat, 2, number, corner);
    unsigned low = (unsigned)(sides[0] < 0) | (unsigned)(sides[1] < 0) << 1 | (unsigned)(sides[2] < 0) << 2;
    if (low == 0 || low == 7) {
        if (!w->grazed && !(w->v->boxes[number].inner_z < w->line.front_z) && runs_along(w, &flat))
            w->grazed = !is_own(w, t->face) && !is_in_plane(w, t->face);
        return;
    }
    const int    alone = alone_of[low], next = after[alone], last = before[alone];
    const double t0 = cross_edge(w, &flat, alone, next), t1 = cross_edge(w, &flat, last, alone);
    const double first = t1 < t0 ? t1 : t0, second = t1 < t0 ? t0 : t1;
    const bool   front = is_in_front(w, number);
    cross_rims(w, front, number, &flat, alone, (const double[2]){t0, t1});
    if (front) {
        w->begins += (first <= 0) & (second > 0);
        return;
    }
    if (!((first < 1) & (second > 0) & (first < second)) || is_in_plane(w, t->face))
        return;
    w->pairs++;
    if (is_own(w, t->face) && !is_around(v, t->face))
        return;
    const double z = v->points[t->v[alone]].z, z_next = v->points[t->v[next]].z, z_last = v->points[t->v[last]].z;
    const double z0 = z + sides[alone] / (sides[alone] - sides[next]) * (z_next - z),
                 z1 = z_last + sides[last] / (sides[last] - sides[alone]) * (z - z_last);
    const crossing_pair c = {{first, second}, {t1 < t0 ? z1 : z0, t1 < t0 ? z0 : z1}};
    cover_by(w, number, &c);
}

/* The same by boxes alone, where corners do not lie together. */
static size_t find_boxes(const worker *w, const uint32_t *entries, size_t count, uint16_t *out)
{
    const window_box *boxes = w->v->boxes;
    const line_test   t = w->line;
    size_t            found = 0;
    for (size_t i = 0; i < count; i++) {
        const window_box *box = &boxes[entries[i]];
        out[found] = (uint16_t)i;
        const bool begins = ((float)box->low_x <= t.x) & ((float)box->high_x >= t.x) & ((float)box->low_y <= t.y) &
                            ((float)box->high_y >= t.y);
        found += ((float)box->low_x <= t.high_x) & ((float)box->high_x >= t.low_x) & ((float)box->low_y <= t.high_y) &
                 ((float)box->high_y >= t.low_y) & (box->near_z <= t.far_z) & ((box->inner_z >= t.front_z) | begins);
    }
    return found;
}

/* Of entries those that the segment has not been compared with: whose triangle no other cell had. */
static size_t find_new(worker *w, const uint32_t *entries, uint16_t *offsets, size_t count)
{
    size_t found = 0;
    for (size_t i = 0; i < count; i++) {
        uint32_t *stamp = &w->stamps[entries[offsets[i]]];
        offsets[found] = offsets[i];
        found += *stamp != w->stamp;
        *stamp = w->stamp;
    }
    return found;
}

static bool is_of_wheel(const worker *w, uint32_t wheel)
{
    return wheel && (wheel == w->wheels[0] || wheel == w->wheels[1]);
}

/* Of entries those that are not of a wheel which is walked by itself. */
static size_t leave_wheels(const worker *w, const uint32_t *entries, uint16_t *offsets, size_t count)
{
    const uint32_t *wheels = w->v->grid.wheels.of_triangles;
    size_t          found = 0;
    for (size_t i = 0; i < count; i++) {
        offsets[found] = offsets[i];
        found += !is_of_wheel(w, wheels[entries[offsets[i]]]);
    }
    return found;
}

static void visit_run(worker *w, const uint32_t *entries, size_t corner, size_t count, bool alone)
{
    uint16_t offsets[RUN_MOST];
    w->entries += count;
    for (size_t begin = 0; begin < count; begin += RUN_MOST) {
        size_t length = count - begin < RUN_MOST ? count - begin : RUN_MOST;
        size_t found = !w->corners ? find_boxes(w, entries + begin, length, offsets)
                                   : line_filter(w->corners, &w->line, w->wide, corner + begin, length, offsets);
        if (w->wheels[0] || w->wheels[1])
            found = leave_wheels(w, entries + begin, offsets, found);
        if (!alone)
            found = find_new(w, entries + begin, offsets, found);
        for (size_t i = 0; i < found; i++)
            compare(w, entries[begin + offsets[i]], corner + begin + offsets[i]);
    }
}

/* The first entry of a crowd whose plane is this one, or behind it. */
static size_t first_in_plane(const stroke_view *v, const uint32_t *entries, size_t count, uint32_t plane)
{
    size_t low = 0, high = count;
    while (low < high) {
        size_t middle = low + (high - low) / 2;
        if (v->planes[v->triangles[entries[middle]].face] < plane)
            low = middle + 1;
        else
            high = middle;
    }
    return low;
}

/* Of a crowd, what lies in the segment's own planes is passed by. */
static void visit_planes(worker *w, const uint32_t *entries, size_t corner, size_t count, bool alone)
{
    size_t begin = 0;
    for (int k = 0; k < 2 && count > GRID_CROWD && w->v->planes; k++) {
        if (!w->planes[k])
            continue;
        size_t end = first_in_plane(w->v, entries, count, w->planes[k]);
        if (end > begin)
            visit_run(w, entries + begin, corner + begin, end - begin, alone);
        begin = first_in_plane(w->v, entries, count, w->planes[k] + 1);
    }
    visit_run(w, entries + begin, corner + begin, count - begin, alone);
}

/* The first entry of a crowd behind those of a wheel. */
static size_t end_of_wheel(const uint32_t *wheels, const uint32_t *entries, size_t count, uint32_t wheel)
{
    size_t low = 0, high = count;
    while (low < high) {
        size_t middle = low + (high - low) / 2;
        if (wheels[entries[middle]] <= wheel)
            low = middle + 1;
        else
            high = middle;
    }
    return low;
}

/* A crowd's wheels one after the other, but those which are walked by themselves. */
static void visit(void *user, const uint32_t *entries, size_t corner, size_t count, bool alone)
{
    worker         *w = user;
    const uint32_t *wheels = w->v->grid.wheels.of_triangles;
    if (!wheels || count <= GRID_CROWD) {
        visit_planes(w, entries, corner, count, alone);
        return;
    }
    for (size_t begin = 0, end; begin < count; begin = end) {
        const uint32_t wheel = wheels[entries[begin]];
        end = begin + end_of_wheel(wheels, entries + begin, count - begin, wheel);
        if (!is_of_wheel(w, wheel))
            visit_planes(w, entries + begin, corner + begin, end - begin, alone);
    }
}

static void visit_spoke(void *user, uint32_t triangle)
{
    worker *w = user;
    w->entries++;
    if (w->v->boxes[triangle].near_z <= w->line.far_z)
        compare(w, triangle, 0);
}

/* The wheel in whose middle an end is. */
static uint32_t wheel_at(const worker *w, int end)
{
    const window_segment *s = w->segment;
    const window_wheels  *wheels = &w->v->grid.wheels;
    const uint32_t        point = s->ends[end];
    if (!wheels->of_points || point >= w->v->point_count)
        return 0;
    const window_point p = w->v->points[point], at = end ? s->b : s->a;
    return p.x == at.x && p.y == at.y ? wheels->of_points[point] : 0;
}

/* Wheels that the segment begins or ends in the middle of. */
static void walk_wheels(worker *w)
{
    const window_segment *s = w->segment;
    const double          x = (double)s->b.x - s->a.x, y = (double)s->b.y - s->a.y;
    const grid_corners   *corners = w->corners;
    w->corners = NULL; /* those of triangles that are found without the grid lie elsewhere */
    for (int k = 0; k < 2; k++)
        if (w->wheels[k] && (k == 0 || w->wheels[1] != w->wheels[0]))
            wheel_walk(&w->v->grid.wheels, w->wheels[k], k ? -x : x, k ? -y : y, visit_spoke, w);
    w->corners = corners;
}

/* By insertion with gaps: few are left where the segment is short. */
static void sort_steps(position_step *steps, size_t count)
{
    size_t gap = 1;
    while (gap < count / 6)
        gap = 3 * gap + 1;
    for (; gap > 0; gap /= 3)
        for (size_t i = gap; i < count; i++) {
            position_step moved = steps[i];
            size_t        k = i;
            for (; k >= gap && steps[k - gap].at > moved.at; k -= gap)
                steps[k] = steps[k - gap];
            steps[k] = moved;
        }
}

/* What is left of the table, in order. */
static bool gather_steps(worker *w, size_t *count)
{
    *count = 0;
    if (!mem_grow((void **)&w->steps, &w->step_capacity, w->filled_count + 1, sizeof *w->steps))
        return false;
    for (size_t i = 0; i < w->filled_count; i++) {
        const position_slot *slot = &w->table[w->filled[i]];
        if (slot->step != 0)
            w->steps[(*count)++] = (position_step){slot->at, slot->step};
    }
    sort_steps(w->steps, *count);
    return true;
}

static bool put_span(span_block *block, double from, int64_t count, uint32_t least, size_t first)
{
    uint32_t number = count > (int64_t)least ? (uint32_t)count : least;
    if (block->count > first && block->spans[block->count - 1].count == number)
        return true;
    if (!mem_grow((void **)&block->spans, &block->capacity, block->count + 1, sizeof *block->spans))
        return false;
    block->spans[block->count++] = (visibility_span){(float)from, number};
    return true;
}

/* Adds up what covers the segment. Positions closer together than a crumb are one; a segment that is no more than a
 * speck is as it is in its middle. */
static bool put_spans(worker *w, span_block *block)
{
    size_t                first = block->count, steps, next = 0;
    const window_segment *s = w->segment;
    double x = (double)s->b.x - s->a.x, y = (double)s->b.y - s->a.y, length = sqrt(x * x + y * y) / w->v->units,
           crumb = CRUMB / fmax(length, CRUMB), at = 0;
    int64_t count = w->begins;
    if (!gather_steps(w, &steps))
        return false;
    if (crumb > 0.4)
        crumb = 0.5;
    for (;;) {
        while (next < steps && w->steps[next].at <= at + crumb)
            count += w->steps[next++].step;
        if (!put_span(block, at, count, s->least, first))
            return false;
        if (next == steps || crumb == 0.5 || w->steps[next].at >= 1 - crumb)
            return true;
        at = w->steps[next].at;
    }
}

static void put_solid_step(void *user, double at, int32_t step)
{
    put_step(user, at, step);
}

/* What is known of the segment by its faces. */
static void take_faces(worker *w)
{
    const window_segment *s = w->segment;
    if (w->v->sames)
        w->same = s->faces[0] == EDGE_NO_FACE ? w->v->same : w->v->sames[w->v->face_pieces[s->faces[0]]];
    for (int k = 0; k < 2 && w->v->planes; k++)
        w->planes[k] = s->faces[k] == EDGE_NO_FACE ? 0 : w->v->planes[s->faces[k]];
    if (w->planes[0] > w->planes[1]) {
        uint32_t other = w->planes[0];
        w->planes[0] = w->planes[1];
        w->planes[1] = other;
    }
}

static bool is_on_page(const stroke_view *v, window_point p)
{
    return fabs((double)p.x) <= 0.5 * v->camera.width * v->units &&
           fabs((double)p.y) <= 0.5 * v->camera.height * v->units;
}

/* Is all that lies in front of the segment known by its rims? Only the page is searched, and what is in front has to
 * count everywhere. */
static bool counts_rims(const stroke_view *v, const window_segment *s)
{
    return s->ignored_count == 0 && s->beside_count == 0 && !(s->lift > 0) && is_on_page(v, s->a) &&
           is_on_page(v, s->b);
}

static void find_spans(worker *w, span_block *block, const window_segment *s)
{
    double x = (double)s->b.x - s->a.x, y = (double)s->b.y - s->a.y;
    w->segment = s;
    w->gap = GAP * w->v->units * sqrt(x * x + y * y);
    w->grazed = false;
    w->stamp++;
    w->filled_count = 0;
    w->begins = 0;
    w->line = line_test_of(s, w->v->units);
    if (!counts_rims(w->v, s))
        w->line.front_z = -INFINITY;
    w->covers.count = 0;
    take_faces(w);
    const bool is_point = s->a.x == s->b.x && s->a.y == s->b.y;
    for (int k = 0; k < 2; k++)
        w->wheels[k] = is_point ? 0 : wheel_at(w, k);
    grid_walk(&w->v->grid, s->a, s->b, visit, w);
    walk_wheels(w);
    if (!w->failed && w->covers.count)
        w->failed = !solid_covers_count(&w->covers, w->v, put_solid_step, w);
    if (!w->failed)
        w->failed = !put_spans(w, block);
}

/* --- along edges ---------------------------------------------------------------------------------------- */

/* The segment a little to its left, or to its right. */
static bool move_aside(window_segment *s, double by, double length)
{
    double x = (double)s->b.x - s->a.x, y = (double)s->b.y - s->a.y;
    if (!(length > 0))
        return false;
    int32_t aside[2] = {(int32_t)lrint(-y / length * by), (int32_t)lrint(x / length * by)};
    s->a.x += aside[0];
    s->b.x += aside[0];
    s->a.y += aside[1];
    s->b.y += aside[1];
    return true;
}

/* The number of surfaces at a place; `at` goes on to the span that the place is in. */
static uint32_t count_at(const visibility_span *spans, size_t count, size_t *at, float place)
{
    while (*at + 1 < count && spans[*at + 1].from <= place)
        ++*at;
    return spans[*at].count;
}

/* As many surfaces are in front as there are to both sides, and no fewer than were found. */
static bool merge_sides(worker *w, const span_block *block, size_t first)
{
    const visibility_span *lists[3] = {block->spans + first, w->sides[0].spans, w->sides[1].spans};
    const size_t           counts[3] = {block->count - first, w->sides[0].count, w->sides[1].count};
    size_t                 at[3] = {0, 0, 0};
    float                  place = 0;
    w->merged.count = 0;
    for (;;) {
        uint32_t own[3];
        float    next = INFINITY;
        for (int k = 0; k < 3; k++) {
            own[k] = count_at(lists[k], counts[k], &at[k], place);
            if (at[k] + 1 < counts[k])
                next = fminf(next, lists[k][at[k] + 1].from);
        }
        uint32_t both = own[1] < own[2] ? own[1] : own[2];
        if (!put_span(&w->merged, (double)place, both > own[0] ? both : own[0], 0, 0))
            return false;
        if (!(next < INFINITY))
            return true;
        place = next;
    }
}

static bool is_seen(const span_block *block, size_t first)
{
    for (size_t i = first; i < block->count; i++)
        if (block->spans[i].count == 0)
            return true;
    return false;
}

/* What is seen along the edge of another body may be seen through a gap that is none. */
static void look_beside(worker *w, span_block *block, const window_segment *s, size_t first)
{
    double length = w->gap / (GAP * w->v->units), by = GAP * w->v->units;
    bool   moved = true;
    for (int k = 0; k < 2 && !w->failed && moved; k++) {
        window_segment aside = *s;
        moved = move_aside(&aside, k ? by : -by, length);
        w->sides[k].count = 0;
        w->beside = by;
        if (moved)
            find_spans(w, &w->sides[k], &aside);
        w->beside = 0;
    }
    if (w->failed || !moved)
        return;
    w->failed = !merge_sides(w, block, first) ||
                !mem_grow((void **)&block->spans, &block->capacity, first + w->merged.count, sizeof *block->spans);
    if (w->failed)
        return;
    memcpy(block->spans + first, w->merged.spans, w->merged.count * sizeof *block->spans);
    block->count = first + w->merged.count;
}

static void find_blocks(size_t begin, size_t end, void *user)
{
    span_job *job = user;
    worker    w = {.v = job->v,
                   .corners = job->corners.memory ? &job->corners : NULL,
                   .wide = line_filter_is_wide(),
                   .stamps = mem_calloc(job->v->triangle_count + 1, sizeof *w.stamps)};
    w.failed = !w.stamps;
    for (size_t b = begin; b < end && !w.failed; b++) {
        span_block *block = &job->blocks[b];
        size_t      last = (b + 1) * BLOCK < job->count ? (b + 1) * BLOCK : job->count;
        for (size_t i = b * BLOCK; i < last && !w.failed; i++) {
            size_t                before = block->count;
            const window_segment *s = &job->segments[job->order[i]];
            find_spans(&w, block, s);
            if (w.grazed && !w.failed && is_seen(block, before))
                look_beside(&w, block, s, before);
            job->lengths[job->order[i]] = (uint32_t)(block->count - before);
        }
        block->pairs = w.pairs;
        block->entries = w.entries;
        w.pairs = w.entries = 0;
    }
    if (w.failed)
        atomic_store(&job->failed, true);
    mem_free(w.stamps);
    mem_free(w.table);
    mem_free(w.filled);
    mem_free(w.steps);
    solid_covers_release(&w.covers);
    mem_free(w.sides[0].spans);
    mem_free(w.sides[1].spans);
    mem_free(w.merged.spans);
}

enum { ORDER_SIDE = 128 };

/* The field of the page that the middle of a segment lies in; every second row of fields runs back. */
static size_t field_of(const stroke_view *v, const window_segment *s)
{
    double  width = v->camera.width * v->units, height = v->camera.height * v->units;
    int32_t at[2] = {(int32_t)((0.5 * ((double)s->a.x + s->b.x) / width + 0.5) * ORDER_SIDE),
                     (int32_t)((0.5 * ((double)s->a.y + s->b.y) / height + 0.5) * ORDER_SIDE)};
    for (int k = 0; k < 2; k++)
        at[k] = at[k] < 0 ? 0 : at[k] < ORDER_SIDE ? at[k] : ORDER_SIDE - 1;
    return (size_t)(at[1] * ORDER_SIDE + (at[1] & 1 ? ORDER_SIDE - 1 - at[0] : at[0]));
}

/* All segments, field by field; NULL when memory is gone. */
static uint32_t *order_segments(const stroke_view *v, const window_segment *segments, size_t count)
{
    uint32_t *order = mem_alloc((count + 1) * sizeof *order), *starts = mem_calloc(ORDER_SIDE * ORDER_SIDE + 1, 4);
    for (size_t i = 0; i < count && order && starts; i++)
        starts[field_of(v, &segments[i]) + 1]++;
    for (size_t k = 0; k < ORDER_SIDE * ORDER_SIDE && starts; k++)
        starts[k + 1] += starts[k];
    for (size_t i = 0; i < count && order && starts; i++)
        order[starts[field_of(v, &segments[i])]++] = (uint32_t)i;
    bool good = order && starts;
    mem_free(starts);
    if (!good)
        mem_free(order);
    return good ? order : NULL;
}

/* The blocks' spans, each segment's where it belongs. */
static lmn_status join_blocks(visibility *out, const span_job *job, size_t block_count, lmn_error *error)
{
    size_t total = 0;
    for (size_t b = 0; b < block_count; b++)
        total += job->blocks[b].count;
    out->spans = mem_alloc((total + 1) * sizeof *out->spans);
    out->starts = mem_alloc((job->count + 1) * sizeof *out->starts);
    if (!out->spans || !out->starts)
        return error_memory(error);
    out->starts[0] = 0;
    for (size_t i = 0; i < job->count; i++)
        out->starts[i + 1] = out->starts[i] + job->lengths[i];
    for (size_t b = 0; b < block_count; b++) {
        const visibility_span *from = job->blocks[b].spans;
        size_t                 last = (b + 1) * BLOCK < job->count ? (b + 1) * BLOCK : job->count;
        for (size_t i = b * BLOCK; i < last; i++) {
            uint32_t segment = job->order[i], length = job->lengths[segment];
            memcpy(out->spans + out->starts[segment], from, length * sizeof *from); /* one at least */
            from += length;
        }
        out->pairs += job->blocks[b].pairs;
        out->entries += job->blocks[b].entries;
    }
    return LMN_OK;
}

lmn_status visibility_find(visibility *out, const stroke_view *v, const window_segment *segments, size_t count,
                           lmn_progress_fn progress, void *user, lmn_error *error)
{
    memset(out, 0, sizeof *out);
    size_t    block_count = (count + BLOCK - 1) / BLOCK, portion = 64;
    uint32_t *order = order_segments(v, segments, count);
    span_job  job = {.v = v, .segments = segments, .order = order, .count = count};
    job.blocks = mem_calloc(block_count + 1, sizeof *job.blocks);
    job.lengths = mem_alloc((count + 1) * sizeof *job.lengths);
    const size_t entries = v->grid.entry_count + v->grid.sub_entry_count;
    bool         good = job.blocks && job.lengths && order &&
                (count * ENTRIES_A_SEGMENT < entries || grid_corners_make(&job.corners, v));
    lmn_status status = good ? LMN_OK : error_memory(error);
    span_job   part = job;
    for (size_t b = 0; b < block_count && status == LMN_OK; b += portion) {
        if (progress && !progress((double)b / (double)block_count, "finding what is hidden", user)) {
            status = error_set(error, LMN_CANCELLED, "cancelled while hidden lines were found");
            break;
        }
        size_t blocks = block_count - b < portion || !progress ? block_count - b : portion;
        part.blocks = job.blocks + b;
        part.order = order + b * BLOCK;
        part.count = count - b * BLOCK;
        threads_for(blocks, 1, find_blocks, &part);
        if (atomic_load(&part.failed))
            status = error_memory(error);
        if (!progress)
            break;
    }
    if (status == LMN_OK)
        status = join_blocks(out, &job, block_count, error);
    for (size_t b = 0; b < block_count && job.blocks; b++)
        mem_free(job.blocks[b].spans);
    mem_free(job.blocks);
    mem_free(job.lengths);
    mem_free(order);
    grid_corners_release(&job.corners);
    if (status != LMN_OK)
        visibility_release(out);
    return status;
}

void visibility_release(visibility *out)
{
    mem_free(out->spans);
    mem_free(out->starts);
    memset(out, 0, sizeof *out);
}
