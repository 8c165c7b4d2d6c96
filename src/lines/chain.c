/* Tracing: thinned ink is followed from node to node, then closed loops; chains part at corners; points are moved
 * into the middle of the ink and smoothed before they are measured, since steps from pixel to pixel overrate
 * slanted lines by up to 8 %. */
#include "lines/chain.h"

#include <math.h>
#include <string.h>

#include "base/memory.h"
#include "lines/thin.h"

enum {
    CELL_NODE = 8, /* an end, a junction, or a pixel alone */
    CELL_TRACED = 16,
    CORNER_REACH = 6, /* points on either side between which a corner is looked for … */
    CORNER_LEAST = 4, /* … and at least, near ends */
    SMOOTH_REACH = 5,
    SPUR_ROUNDS = 2,
    BROAD = 4 /* ink this far on all sides is no line */
};

/* A turn of 50 degrees is a corner. */
static const float corner_turn = 0.873f;

/* A smaller one is, too, when it hardly grows as it is measured over twice the way; that of an arc would double. */
static const struct {
    size_t reach;
    float  turn, growth; /* radians: 35 and 20 degrees */
} faint_corners[] = {{CORNER_REACH, 0.611f, 1.4f}, {2 * CORNER_REACH, 0.349f, 1.3f}};

/* A line between nodes as it was found, before it is parted at corners. */
typedef struct raw_line {
    size_t first, count;
    bool   closed;
    bool   joined[2];
} raw_line;

typedef struct tracing {
    thin_grid grid;
    uint32_t *cells; /* of all lines */
    raw_line *lines;
    size_t    cell_count, cell_capacity, line_count, line_capacity;
    bool      failed;
} tracing;

static void add_cell(tracing *t, uint32_t cell)
{
    if (!mem_grow((void **)&t->cells, &t->cell_capacity, t->cell_count + 1, sizeof *t->cells)) {
        t->failed = true;
        return;
    }
    t->cells[t->cell_count++] = cell;
    t->grid.cells[cell] |= CELL_TRACED;
}

static void add_line(tracing *t, raw_line line)
{
    if (!mem_grow((void **)&t->lines, &t->line_capacity, t->line_count + 1, sizeof *t->lines)) {
        t->failed = true;
        return;
    }
    line.count = t->cell_count - line.first;
    t->lines[t->line_count++] = line;
}

/* The neighbour behind `cell` when coming from `before`; `cell` itself when there is none. */
static uint32_t next_of(const tracing *t, uint32_t before, uint32_t cell)
{
    for (int k = 0; k < 8; k++) {
        uint32_t next = (uint32_t)((int64_t)cell + t->grid.around[k]);
        if (next != before && t->grid.cells[next] & CELL_THIN)
            return next;
    }
    return cell;
}

static bool is_node(const tracing *t, uint32_t cell)
{
    return (t->grid.cells[cell] & CELL_NODE) != 0;
}

/* From a node through `second` to the next node. */
static void follow(tracing *t, uint32_t node, uint32_t second)
{
    raw_line line = {.first = t->cell_count, .joined = {thin_degree(&t->grid, node) > 1, false}};
    uint32_t before = node, cell = second;
    add_cell(t, node);
    while (!t->failed) {
        add_cell(t, cell);
        if (is_node(t, cell))
            break;
        uint32_t next = next_of(t, before, cell);
        before = cell;
        cell = next;
    }
    line.joined[1] = thin_degree(&t->grid, cell) > 1;
    add_line(t, line);
}

static void follow_loop(tracing *t, uint32_t start)
{
    raw_line line = {.first = t->cell_count, .closed = true};
    uint32_t before = start, cell = next_of(t, start, start);
    add_cell(t, start);
    while (cell != start && !t->failed) {
        add_cell(t, cell);
        uint32_t next = next_of(t, before, cell);
        before = cell;
        cell = next;
    }
    add_line(t, line);
}

static void follow_from(tracing *t, uint32_t node)
{
    for (int k = 0; k < 8; k++) {
        uint32_t second = (uint32_t)((int64_t)node + t->grid.around[k]);
        if (!(t->grid.cells[second] & CELL_THIN))
            continue;
        if (!is_node(t, second)) {
            if (!(t->grid.cells[second] & CELL_TRACED))
                follow(t, node, second);
        } else if (second > node && (thin_degree(&t->grid, node) == 1 || thin_degree(&t->grid, second) == 1)) {
            follow(t, node, second); /* two nodes side by side; those of one junction are no line */
        }
    }
}

static void trace_lines(tracing *t)
{
    thin_grid *g = &t->grid;
    t->cell_count = t->line_count = 0;
    for (size_t i = 0; i < g->count; i++)
        g->cells[g->pixels[i]] = (uint8_t)(g->cells[g->pixels[i]] & ~(CELL_NODE | CELL_TRACED));
    for (size_t i = 0; i < g->count; i++)
        if (thin_degree(g, g->pixels[i]) != 2)
            g->cells[g->pixels[i]] |= CELL_NODE;
    for (size_t i = 0; i < g->count && !t->failed; i++)
        if (is_node(t, g->pixels[i]))
            follow_from(t, g->pixels[i]);
    for (size_t i = 0; i < g->count && !t->failed; i++) {
        uint32_t cell = g->pixels[i];
        if (g->cells[cell] & CELL_TRACED)
            continue;
        if (is_node(t, cell)) {
            raw_line alone = {.first = t->cell_count};
            add_cell(t, cell);
            add_line(t, alone);
        } else {
            follow_loop(t, cell);
        }
    }
}

static float steps_length(const tracing *t, const raw_line *line)
{
    float length = 0;
    for (size_t i = 1; i < line->count; i++) {
        int64_t step = (int64_t)t->cells[line->first + i] - (int64_t)t->cells[line->first + i - 1];
        bool    straight = step == 1 || step == -1 || step == t->grid.stride || step == -t->grid.stride;
        length += straight ? 1.0f : 1.41421356f;
    }
    return length;
}

/* Takes short side branches off; true when there were any. */
static bool remove_spurs(tracing *t, float spur)
{
    bool removed = false;
    for (size_t i = 0; i < t->line_count; i++) {
        const raw_line *line = &t->lines[i];
        if (line->closed || line->joined[0] == line->joined[1] || steps_length(t, line) > spur)
            continue;
        size_t keep = line->joined[0] ? 0 : line->count - 1; /* the junction */
        for (size_t k = 0; k < line->count; k++)
            if (k != keep) {
                uint8_t *cell = &t->grid.cells[t->cells[line->first + k]];
                *cell = (uint8_t)(*cell & ~CELL_THIN);
            }
        removed = true;
    }
    return removed;
}

/* --- points --------------------------------------------------------------------------------------------- */

/* The middle of the ink around a pixel: thin lines of an even width have theirs between two. */
static trace_point point_of(const tracing *t, uint32_t cell)
{
    const thin_grid *g = &t->grid;
    int              sum_x = 0, sum_y = 0, count = 0;
    for (int y = -1; y <= 1; y++)
        for (int x = -1; x <= 1; x++) {
            int ink = g->cells[(int64_t)cell + y * g->stride + x] & CELL_INK;
            sum_x += ink * x;
            sum_y += ink * y;
            count += ink;
        }
    int   column = (int)(cell % (uint32_t)g->stride) - 1, row = (int)(cell / (uint32_t)g->stride) - 1;
    float fraction = 1 / (float)(count ? count : 1);
    return (trace_point){(float)column + (float)sum_x * fraction, (float)row + (float)sum_y * fraction, 0,
                         (uint32_t)row * (uint32_t)g->width + (uint32_t)column};
}

/* How much of `reach` the line has on both sides of point i. */
static size_t reach_at(size_t n, size_t i, bool closed, size_t reach)
{
    size_t before = closed ? n / 3 : i, behind = closed ? n / 3 : n - 1 - i;
    reach = before < reach ? before : reach;
    return behind < reach ? behind : reach;
}

/* Angle between the directions from and to the points at this distance, without sign. */
static float turn_at(const trace_point *p, size_t n, size_t i, size_t reach)
{
    const trace_point *a = &p[(i + n - reach) % n], *b = &p[i], *c = &p[(i + reach) % n];
    float              ux = b->x - a->x, uy = b->y - a->y, vx = c->x - b->x, vy = c->y - b->y;
    return fabsf(atan2f(ux * vy - uy * vx, ux * vx + uy * vy));
}

/* Over how many points on either side is there a corner at point i? 0: there is none. */
static size_t corner_reach_at(const trace_point *p, size_t n, size_t i, bool closed)
{
    size_t reach = reach_at(n, i, closed, CORNER_REACH);
    if (reach < CORNER_LEAST)
        return 0;
    if (turn_at(p, n, i, reach) > corner_turn)
        return reach;
    for (size_t k = 0; k < sizeof faint_corners / sizeof *faint_corners; k++) {
        reach = faint_corners[k].reach;
        if (reach_at(n, i, closed, 2 * reach) < 2 * reach)
            break;
        float turn = turn_at(p, n, i, reach);
        if (turn > faint_corners[k].turn && turn_at(p, n, i, 2 * reach) < faint_corners[k].growth * turn)
            return reach;
    }
    return 0;
}

/* 0 where the line goes on at point i of n, or an end is too near. At corners how far the point stands out from the
 * chord between its neighbours, as a fraction of their distance along the line; greatest at the very corner. */
static float sharpness_at(const trace_point *p, size_t n, size_t i, bool closed)
{
    size_t reach = corner_reach_at(p, n, i, closed);
    if (reach == 0)
        return 0;
    const trace_point *a = &p[(i + n - reach) % n], *b = &p[i], *c = &p[(i + reach) % n];
    float              dx = c->x - a->x, dy = c->y - a->y, chord = hypotf(dx, dy);
    float              height =
        chord > 0 ? fabsf((b->x - a->x) * dy - (b->y - a->y) * dx) / chord : hypotf(b->x - a->x, b->y - a->y);
    return height / (float)reach;
}

/* Is point i a corner, and the sharpest within reach? Of equals the first. */
static bool is_corner(const float *sharpness, size_t n, size_t i, bool closed)
{
    if (sharpness[i] <= 0)
        return false;
    for (size_t k = 1; k <= CORNER_REACH; k++) {
        if ((closed || i >= k) && sharpness[(i + n * CORNER_REACH - k) % n] >= sharpness[i])
            return false;
        if ((closed || i + k < n) && sharpness[(i + k) % n] > sharpness[i])
            return false;
    }
    return true;
}

/* The point `k` positions from `i`. Beyond an open end the line goes on as its mirror image in the end point, which
 * keeps ends in their place and straight lines straight. */
static void position_at(const trace_point *p, long n, long i, bool closed, float out[2])
{
    if (closed)
        i = ((i % n) + n) % n;
    long               inside = i < 0 ? -i : i >= n ? 2 * (n - 1) - i : i;
    const trace_point *end = i < 0 ? &p[0] : &p[n - 1];
    bool               mirrored = inside != i;
    inside = inside < 0 ? 0 : inside >= n ? n - 1 : inside;
    out[0] = mirrored ? 2 * end->x - p[inside].x : p[inside].x;
    out[1] = mirrored ? 2 * end->y - p[inside].y : p[inside].y;
}

static void smooth_point(trace_point *to, const trace_point *from, long n, long i, bool closed)
{
    static const float weights[SMOOTH_REACH + 1] = {0.2016f, 0.1774f, 0.1208f, 0.0637f, 0.0260f, 0.0113f};
    float              x = weights[0] * from[i].x, y = weights[0] * from[i].y;
    for (long k = 1; k <= SMOOTH_REACH; k++) {
        float before[2], behind[2];
        if (i >= k && i + k < n) {
            before[0] = from[i - k].x;
            before[1] = from[i - k].y;
            behind[0] = from[i + k].x;
            behind[1] = from[i + k].y;
        } else {
            position_at(from, n, i - k, closed, before);
            position_at(from, n, i + k, closed, behind);
        }
        x += weights[k] * (before[0] + behind[0]);
        y += weights[k] * (before[1] + behind[1]);
    }
    *to = from[i];
    to->x = x;
    to->y = y;
}

/* Adds points first … first + count - 1 of `p` (around its end where it is closed) as a chain, smoothed and
 * measured. */
static bool add_chain(chain_set *out, trace_point *p, size_t n, size_t first, chain c)
{
    if (!mem_grow((void **)&out->points, &out->point_capacity, out->point_count + 2 * c.count, sizeof *out->points) ||
        !mem_grow((void **)&out->chains, &out->chain_capacity, out->chain_count + 1, sizeof *out->chains))
        return false;
    c.first = out->point_count;
    trace_point *to = &out->points[c.first], *from = to + c.count; /* the room behind holds the rough ones meanwhile */
    for (size_t i = 0; i < c.count; i++)
        from[i] = p[(first + i) % n];
    for (size_t i = 0; i < c.count; i++)
        smooth_point(&to[i], from, (long)c.count, (long)i, c.closed);
    for (size_t i = 1; i < c.count; i++)
        to[i].along = to[i - 1].along + hypotf(to[i].x - to[i - 1].x, to[i].y - to[i - 1].y);
    c.length = to[c.count - 1].along;
    if (c.closed)
        c.length += hypotf(to[0].x - to[c.count - 1].x, to[0].y - to[c.count - 1].y);
    out->point_count += c.count;
    out->chains[out->chain_count++] = c;
    return true;
}

/* Parts a line at its corners. */
static bool add_parted(chain_set *out, const raw_line *line, trace_point *p, float *sharpness)
{
    size_t n = line->count, start = 0, first_corner = n;
    bool   joined = line->joined[0], good = true;
    for (size_t i = 0; i < n; i++)
        sharpness[i] = sharpness_at(p, n, i, line->closed);
    for (size_t i = 0; i < n && good; i++) {
        if (!is_corner(sharpness, n, i, line->closed))
            continue;
        if (first_corner < n || !line->closed)
            good = add_chain(out, p, n, start, (chain){.count = i - start + 1, .joined = {joined, true}});
        if (first_corner == n)
            first_corner = i;
        start = i;
        joined = true;
    }
    if (!good)
        return false;
    if (!line->closed)
        return add_chain(out, p, n, start, (chain){.count = n - start, .joined = {joined, line->joined[1]}});
    if (first_corner == n)
        return add_chain(out, p, n, 0, (chain){.count = n, .closed = true});
    return add_chain(out, p, n, start, (chain){.count = n - start + first_corner + 1, .joined = {true, true}});
}

static bool make_chains(chain_set *out, const tracing *t)
{
    size_t longest = 0;
    for (size_t i = 0; i < t->line_count; i++)
        longest = t->lines[i].count > longest ? t->lines[i].count : longest;
    trace_point *points = mem_alloc(longest * sizeof *points);
    float       *sharpness = mem_alloc(longest * sizeof *sharpness);
    bool         good = points && sharpness;
    for (size_t i = 0; i < t->line_count && good; i++) {
        const raw_line *line = &t->lines[i];
        for (size_t k = 0; k < line->count; k++)
            points[k] = point_of(t, t->cells[line->first + k]);
        good = add_parted(out, line, points, sharpness);
    }
    mem_free(points);
    mem_free(sharpness);
    return good;
}

static bool is_within_ink(const uint8_t *ink, int width, int height, uint32_t pixel)
{
    int x = (int)(pixel % (uint32_t)width), y = (int)(pixel / (uint32_t)width);
    for (int k = 0; k < 9; k++) {
        int reach = k % 2 ? BROAD : BROAD - 1; /* the even ones are the diagonals */
        int nx = x + (k % 3 - 1) * reach, ny = y + (k / 3 - 1) * reach;
        if (nx >= 0 && ny >= 0 && nx < width && ny < height && !ink[(size_t)ny * (size_t)width + (size_t)nx])
            return false;
    }
    return true;
}

static void find_broad(chain_set *set, const uint8_t *ink, int width, int height)
{
    for (size_t i = 0; i < set->chain_count; i++) {
        chain *c = &set->chains[i];
        size_t within = 0;
        for (size_t k = 0; k < c->count; k++)
            within += is_within_ink(ink, width, height, set->points[c->first + k].pixel);
        c->broad = 2 * within > c->count;
    }
}

bool chains_trace(chain_set *out, const uint8_t *ink, int width, int height, float spur)
{
    tracing t = {0};
    *out = (chain_set){0};
    bool good = thin_create(&t.grid, ink, width, height) && thin_run(&t.grid);
    if (good) {
        trace_lines(&t);
        for (int round = 0; round < SPUR_ROUNDS && good && !t.failed && remove_spurs(&t, spur); round++) {
            good = thin_run(&t.grid);
            trace_lines(&t);
        }
        good = good && !t.failed && make_chains(out, &t);
    }
    thin_release(&t.grid);
    mem_free(t.cells);
    mem_free(t.lines);
    if (good)
        find_broad(out, ink, width, height);
    else
        chains_release(out);
    return good;
}

void chains_release(chain_set *c)
{
    mem_free(c->points);
    mem_free(c->chains);
    *c = (chain_set){0};
}
