/* The moving outline is simulated event by event: an edge has no length any more, or a corner that points inwards
 * reaches an edge and splits what is there. Towns are full of right angles, where many events happen in one place at
 * one time. They are not told apart by rules but kept from happening: corners are first moved by some ten millionths of
 * the size, by chance that depends on nothing but their numbers, so that each event is alone. What comes out is checked
 * as a whole (skeleton_check.c), and tried again with other chance where it is not right. */
#include "import/skeleton.h"

#include <math.h>
#include <stdlib.h>

#include "base/memory.h"

enum { NOBODY = UINT32_MAX, TRIES = 6 };

/* An edge of the outline, and the line it lies on at time 0. */
typedef struct wall {
    double dx, dy; /* unit, along it */
    double offset; /* of its line along the inward normal (−dy, dx) */
} wall;

/* A corner of the moving outline, between two edges, from when it came into being. */
typedef struct walker {
    uint32_t prev, next;
    uint32_t before, behind; /* the edges that arrive and leave */
    uint32_t start;          /* node */
    double   x, y, time, vx, vy;
    bool     alive, reflex;
    double   shrink_time; /* when the edge that leaves has no length; INFINITY */
    double   split_time;  /* when it reaches the edge that leaves `target` */
    uint32_t target;
} walker;

typedef struct arc {
    uint32_t from, to, left, right;
} arc;

typedef struct simulation {
    skeleton *out;
    wall     *walls;
    walker   *walkers;
    arc      *arcs;
    size_t    walker_count, walker_capacity, arc_count, arc_capacity, node_capacity, alive;
    double    now;
    bool      failed, no_memory;
} simulation;

/* --- motion --------------------------------------------------------------------------------------------- */

static double cross(double ax, double ay, double bx, double by)
{
    return ax * by - ay * bx;
}

/* The point that stays on both edges: its component along each normal is 1. Two forms, for nearly the same direction
 * and for nearly opposite ones. */
static void set_velocity(simulation *m, walker *w)
{
    const wall *a = &m->walls[w->before], *b = &m->walls[w->behind];
    double      dot = a->dx * b->dx + a->dy * b->dy, turn = cross(a->dx, a->dy, b->dx, b->dy);
    if (dot > 0) {
        w->vx = -(a->dy + b->dy) / (1 + dot);
        w->vy = (a->dx + b->dx) / (1 + dot);
    } else {
        w->vx = (b->dx - a->dx) / turn;
        w->vy = (b->dy - a->dy) / turn;
    }
    w->reflex = turn < 0;
    m->failed = m->failed || !isfinite(w->vx) || !isfinite(w->vy);
}

static double along(const wall *e, const walker *w, double time)
{
    return e->dx * (w->x + w->vx * (time - w->time)) + e->dy * (w->y + w->vy * (time - w->time));
}

static void find_shrink(simulation *m, uint32_t u)
{
    walker       *a = &m->walkers[u];
    const walker *b = &m->walkers[a->next];
    const wall   *e = &m->walls[a->behind];
    double        length = along(e, b, m->now) - along(e, a, m->now);
    double        rate = e->dx * (b->vx - a->vx) + e->dy * (b->vy - a->vy);
    a->shrink_time = rate < 0 ? m->now + fmax(length, 0) / -rate : INFINITY;
}

/* Does the corner v reach the edge that leaves u, and sooner than what it is known to reach? An edge of its own, or one
 * behind its neighbour, which it meets only when the edge between them is gone, is none. */
static void try_split(simulation *m, uint32_t v, uint32_t u)
{
    walker       *w = &m->walkers[v];
    const walker *a = &m->walkers[u];
    uint32_t      c = a->next;
    if (u == v || c == v || u == w->next || c == w->prev)
        return;
    const wall *e = &m->walls[a->behind];
    double      approach = 1 + e->dy * w->vx - e->dx * w->vy;
    if (!(approach > 1e-9))
        return;
    double height = -e->dy * w->x + e->dx * w->y - e->offset - w->time; /* over the edge, when it came into being */
    double time = w->time + height / approach;
    if (time < m->now - 1e-12 || time >= w->split_time)
        return;
    double at = along(e, w, time);
    if (at < along(e, a, time) || at > along(e, &m->walkers[c], time))
        return;
    w->split_time = fmax(time, m->now);
    w->target = u;
}

static void find_split(simulation *m, uint32_t v)
{
    walker *w = &m->walkers[v];
    w->split_time = INFINITY;
    w->target = NOBODY;
    for (uint32_t u = 0; w->reflex && u < m->walker_count; u++)
        if (m->walkers[u].alive)
            try_split(m, v, u);
}

/* --- what comes into being ------------------------------------------------------------------------------ */

static uint32_t add_node(simulation *m, double x, double y, double time)
{
    skeleton *s = m->out;
    if (!mem_grow((void **)&s->nodes, &m->node_capacity, s->node_count + 1, sizeof *s->nodes)) {
        m->no_memory = true;
        return 0;
    }
    s->nodes[s->node_count] = (skeleton_node){x, y, time};
    return (uint32_t)s->node_count++;
}

static void add_arc(simulation *m, uint32_t from, uint32_t to, uint32_t left, uint32_t right)
{
    if (!mem_grow((void **)&m->arcs, &m->arc_capacity, m->arc_count + 1, sizeof *m->arcs))
        m->no_memory = true;
    else
        m->arcs[m->arc_count++] = (arc){from, to, left, right};
}

static uint32_t add_walker(simulation *m, uint32_t node, uint32_t before, uint32_t behind)
{
    if (!mem_grow((void **)&m->walkers, &m->walker_capacity, m->walker_count + 1, sizeof *m->walkers)) {
        m->no_memory = true;
        return NOBODY;
    }
    const skeleton_node *at = &m->out->nodes[node];
    walker               w = {.before = before, .behind = behind, .start = node, .alive = true, .target = NOBODY};
    w.x = at->x;
    w.y = at->y;
    w.time = at->time;
    set_velocity(m, &w);
    m->walkers[m->walker_count] = w;
    m->alive++;
    return (uint32_t)m->walker_count++;
}

static void end_walker(simulation *m, uint32_t v, uint32_t node)
{
    walker *w = &m->walkers[v];
    add_arc(m, w->start, node, w->before, w->behind);
    w->alive = false;
    m->alive--;
}

static void join(simulation *m, uint32_t a, uint32_t b)
{
    m->walkers[a].next = b;
    m->walkers[b].prev = a;
}

/* A loop of two corners has no area: what is left of it is an arc between the two faces. */
static bool end_pair(simulation *m, uint32_t v)
{
    uint32_t u = m->walkers[v].next;
    if (m->walkers[u].next != v)
        return false;
    const walker *a = &m->walkers[v], *b = &m->walkers[u];
    uint32_t      before = a->before, behind = a->behind;
    double        x = b->x + b->vx * (m->now - b->time), y = b->y + b->vy * (m->now - b->time);
    uint32_t      here = a->start, there = add_node(m, x, y, m->now);
    end_walker(m, u, there);
    m->walkers[v].alive = false;
    m->alive--;
    add_arc(m, here, there, before, behind);
    return true;
}

/* After an event: the edges that leave these walkers, and the one before each, are not what they were. */
static void look_again(simulation *m, const uint32_t *changed, size_t count)
{
    uint32_t edges[4];
    size_t   n = 0;
    for (size_t i = 0; i < count; i++) {
        if (!m->walkers[changed[i]].alive)
            continue;
        edges[n++] = changed[i];
        edges[n++] = m->walkers[changed[i]].prev;
    }
    for (size_t i = 0; i < n; i++)
        find_shrink(m, edges[i]);
    for (uint32_t v = 0; v < m->walker_count; v++) {
        walker *w = &m->walkers[v];
        if (!w->alive || !w->reflex)
            continue;
        bool stale = w->target != NOBODY && !m->walkers[w->target].alive;
        for (size_t i = 0; i < n && !stale; i++)
            stale = w->target == edges[i] || v == edges[i];
        if (stale)
            find_split(m, v);
        for (size_t i = 0; i < n && !stale; i++)
            try_split(m, v, edges[i]);
    }
}

/* --- events --------------------------------------------------------------------------------------------- */

/* The edge that leaves u has no length. */
static void shrink(simulation *m, uint32_t u)
{
    const walker a = m->walkers[u], b = m->walkers[a.next];
    double       x = a.x + a.vx * (m->now - a.time), y = a.y + a.vy * (m->now - a.time);
    /* The slower one is more exact where the other one runs along a ridge. */
    if (hypot(b.vx, b.vy) < hypot(a.vx, a.vy)) {
        x = b.x + b.vx * (m->now - b.time);
        y = b.y + b.vy * (m->now - b.time);
    }
    uint32_t node = add_node(m, x, y, m->now);
    if (m->no_memory)
        return;
    end_walker(m, u, node);
    end_walker(m, a.next, node);
    if (a.prev == b.next) {
        end_walker(m, a.prev, node);
        return;
    }
    uint32_t w = add_walker(m, node, a.before, b.behind);
    if (m->no_memory)
        return;
    join(m, a.prev, w);
    join(m, w, b.next);
    if (!end_pair(m, w))
        look_again(m, &w, 1);
}

/* The corner v has reached the edge that leaves its target. */
static void split(simulation *m, uint32_t v)
{
    const walker w = m->walkers[v];
    uint32_t     u = w.target, c = m->walkers[u].next, edge = m->walkers[u].behind;
    uint32_t     node = add_node(m, w.x + w.vx * (m->now - w.time), w.y + w.vy * (m->now - w.time), m->now);
    if (m->no_memory)
        return;
    end_walker(m, v, node);
    uint32_t both[2] = {add_walker(m, node, w.before, edge), 0};
    if (!m->no_memory)
        both[1] = add_walker(m, node, edge, w.behind);
    if (m->no_memory)
        return;
    join(m, w.prev, both[0]);
    join(m, both[0], c);
    join(m, u, both[1]);
    join(m, both[1], w.next);
    for (int i = 0; i < 2; i++)
        end_pair(m, both[i]);
    look_again(m, both, 2);
}

static void run(simulation *m)
{
    /* A corner has at most one event that ends it, and each leaves at most one more than it ends. */
    size_t most = 8 * m->walker_count + 16;
    for (size_t step = 0; m->alive > 0 && !m->failed && !m->no_memory; step++) {
        double   first = INFINITY;
        uint32_t who = NOBODY;
        bool     splits = false;
        for (uint32_t v = 0; v < m->walker_count; v++) {
            const walker *w = &m->walkers[v];
            if (!w->alive)
                continue;
            if (w->shrink_time < first || (w->reflex && w->split_time < first)) {
                splits = w->reflex && w->split_time < w->shrink_time;
                first = splits ? w->split_time : w->shrink_time;
                who = v;
            }
        }
        m->failed = who == NOBODY || step > most;
        if (m->failed)
            return;
        m->now = fmax(m->now, first);
        if (splits)
            split(m, who);
        else
            shrink(m, who);
    }
}

/* --- before and after ----------------------------------------------------------------------------------- */

static double chance(uint32_t number, uint32_t seed)
{
    uint32_t h = number * 2654435761u + seed * 40503u + 0x9E3779B9u;
    h ^= h >> 16;
    h *= 0x85EBCA6Bu;
    h ^= h >> 13;
    h *= 0xC2B2AE35u;
    h ^= h >> 16;
    return h / 2147483648.0 - 1;
}

/* Corners that are moved a little; the skeleton's own nodes stay where they are. */
static void begin(simulation *m, uint32_t seed, double (*moved)[2])
{
    skeleton *s = m->out;
    double    reach = s->size * 2e-7;
    for (uint32_t i = 0; i < s->corner_count; i++) {
        moved[i][0] = s->nodes[i].x + reach * chance(2 * i, seed);
        moved[i][1] = s->nodes[i].y + reach * chance(2 * i + 1, seed);
    }
    for (uint32_t i = 0; i < s->corner_count; i++) {
        const double *a = moved[i], *b = moved[s->ends[i]];
        double        x = b[0] - a[0], y = b[1] - a[1], length = hypot(x, y);
        m->walls[i] = (wall){.dx = x / length, .dy = y / length};
        m->walls[i].offset = -m->walls[i].dy * a[0] + m->walls[i].dx * a[1];
        m->failed = m->failed || !(length > 0);
    }
    for (uint32_t i = 0; i < s->corner_count; i++)
        s->face_ends[s->ends[i]] = i; /* the edge that arrives there */
    for (uint32_t i = 0; i < s->corner_count && !m->no_memory; i++)
        add_walker(m, i, s->face_ends[i], i);
    for (uint32_t i = 0; i < s->corner_count && !m->no_memory; i++) {
        m->walkers[i].x = moved[i][0];
        m->walkers[i].y = moved[i][1];
        join(m, i, s->ends[i]);
    }
    for (uint32_t i = 0; i < s->corner_count && !m->no_memory; i++)
        find_shrink(m, i);
    for (uint32_t i = 0; i < s->corner_count && !m->no_memory; i++)
        find_split(m, i);
}

/* The arcs around each face, one behind the other. */
static bool chain_faces(simulation *m)
{
    skeleton *s = m->out;
    size_t    total = 2 * m->arc_count;
    uint32_t *ends = mem_calloc(s->corner_count + 1, sizeof *ends), *of = mem_calloc(total + 1, sizeof *of);
    uint32_t *next = mem_calloc(s->node_count, sizeof *next), put = 0;
    bool      good = ends && of && next;
    mem_free(s->face_nodes);
    s->face_nodes = mem_calloc(total + 1, sizeof *s->face_nodes);
    m->no_memory = !good || !s->face_nodes;
    for (size_t i = 0; i < m->arc_count && !m->no_memory; i++) {
        ends[m->arcs[i].left + 1]++;
        ends[m->arcs[i].right + 1]++;
    }
    for (size_t i = 0; i < s->corner_count && !m->no_memory; i++)
        ends[i + 1] += ends[i];
    for (size_t i = 0; i < m->arc_count && !m->no_memory; i++) {
        of[ends[m->arcs[i].left]++] = (uint32_t)i;
        of[ends[m->arcs[i].right]++] = (uint32_t)i;
    }
    for (uint32_t edge = 0; edge < s->corner_count && !m->no_memory && good; edge++) {
        uint32_t first = edge ? ends[edge - 1] : 0, at = s->ends[edge], steps = 0;
        for (uint32_t i = first; i < ends[edge]; i++)
            next[m->arcs[of[i]].from] = next[m->arcs[of[i]].to] = NOBODY;
        for (uint32_t i = first; i < ends[edge]; i++) {
            const arc *a = &m->arcs[of[i]];
            next[a->left == edge ? a->from : a->to] = a->left == edge ? a->to : a->from;
        }
        good = ends[edge] >= first + 2;
        for (; good && at != edge && steps < ends[edge] - first; steps++) {
            if (steps)
                s->face_nodes[put++] = at;
            at = next[at];
            good = at != NOBODY;
        }
        good = good && at == edge && steps == ends[edge] - first;
        s->face_ends[edge] = put;
    }
    mem_free(ends);
    mem_free(of);
    mem_free(next);
    return good && !m->no_memory;
}

static bool attempt(simulation *m, uint32_t seed, double (*moved)[2])
{
    skeleton *s = m->out;
    s->node_count = s->corner_count;
    m->walker_count = m->arc_count = m->alive = 0;
    m->now = 0;
    m->failed = false;
    begin(m, seed, moved);
    run(m);
    if (m->failed || m->no_memory || !chain_faces(m))
        return false;
    s->top = 0;
    for (size_t i = 0; i < s->node_count; i++)
        s->top = fmax(s->top, s->nodes[i].time);
    return skeleton_covers(s);
}

/* Around the middle of the outline, where numbers are short. */
static bool place(simulation *m, const double (*positions)[2], double middle[2])
{
    skeleton *s = m->out;
    double    low[2] = {INFINITY, INFINITY}, high[2] = {-INFINITY, -INFINITY};
    for (size_t i = 0; i < s->corner_count; i++)
        for (int k = 0; k < 2; k++) {
            low[k] = fmin(low[k], positions[i][k]);
            high[k] = fmax(high[k], positions[i][k]);
        }
    for (int k = 0; k < 2; k++)
        middle[k] = low[k] + (high[k] - low[k]) / 2;
    s->size = fmax(high[0] - low[0], high[1] - low[1]);
    for (size_t i = 0; i < s->corner_count && !m->no_memory; i++)
        add_node(m, positions[i][0] - middle[0], positions[i][1] - middle[1], 0);
    return s->size > 0 && isfinite(s->size);
}

static void find_ends(uint32_t *ends, const size_t *counts, size_t rings)
{
    uint32_t first = 0;
    for (size_t k = 0; k < rings; first += (uint32_t)counts[k], k++)
        for (uint32_t i = 0; i < counts[k]; i++)
            ends[first + i] = first + (i + 1) % (uint32_t)counts[k];
}

static skeleton_status make(simulation *m, const double (*positions)[2], const size_t *counts, size_t rings)
{
    skeleton *s = m->out;
    double    middle[2], (*moved)[2] = mem_calloc(s->corner_count, sizeof *moved);
    m->walls = mem_calloc(s->corner_count, sizeof *m->walls);
    s->ends = mem_calloc(s->corner_count, sizeof *s->ends);
    s->face_ends = mem_calloc(s->corner_count, sizeof *s->face_ends);
    s->upright = mem_calloc(s->corner_count, sizeof *s->upright);
    m->no_memory = !moved || !m->walls || !s->ends || !s->face_ends || !s->upright;
    bool simple = !m->no_memory && place(m, positions, middle), made = false;
    if (simple) {
        find_ends(s->ends, counts, rings);
        simple = skeleton_is_simple(positions, s->ends, counts, rings);
    }
    for (uint32_t seed = 0; seed < TRIES && simple && !made && !m->no_memory; seed++)
        made = attempt(m, seed, moved);
    for (size_t i = 0; i < s->node_count && made; i++) {
        s->nodes[i].x += middle[0];
        s->nodes[i].y += middle[1];
    }
    mem_free(moved);
    return m->no_memory ? SKELETON_NO_MEMORY : !simple ? SKELETON_NOT_SIMPLE : made ? SKELETON_MADE : SKELETON_FAILED;
}

skeleton_status skeleton_make(skeleton *out, const double (*positions)[2], const size_t *counts, size_t rings)
{
    simulation m = {.out = out};
    *out = (skeleton){0};
    for (size_t k = 0; k < rings; k++) {
        if (counts[k] < 3 || counts[k] > SKELETON_CORNERS_MAX)
            return SKELETON_NOT_SIMPLE;
        out->corner_count += counts[k];
    }
    if (rings == 0 || out->corner_count > SKELETON_CORNERS_MAX)
        return SKELETON_NOT_SIMPLE;
    skeleton_status status = make(&m, positions, counts, rings);
    mem_free(m.walls);
    mem_free(m.walkers);
    mem_free(m.arcs);
    return status;
}

void skeleton_release(skeleton *s)
{
    mem_free(s->nodes);
    mem_free(s->ends);
    mem_free(s->face_ends);
    mem_free(s->face_nodes);
    mem_free(s->upright);
    *s = (skeleton){0};
}

/* --- joining -------------------------------------------------------------------------------------------- */

static uint32_t root_of(uint32_t *parents, uint32_t n)
{
    while (parents[n] != n)
        n = parents[n] = parents[parents[n]];
    return n;
}

static int compare_edges(const void *a, const void *b)
{
    const uint32_t *x = a, *y = b;
    int             first = (x[0] > y[0]) - (x[0] < y[0]);
    return first ? first : (x[1] > y[1]) - (x[1] < y[1]);
}

/* Does no face run from one node to another as a second face does? */
static bool are_edges_single(const skeleton *s, uint32_t (*edges)[2])
{
    size_t count = 0;
    for (uint32_t edge = 0; edge < s->corner_count; edge++) {
        uint32_t last = s->ends[edge];
        for (uint32_t i = skeleton_face_first(s, edge); i <= s->face_ends[edge]; i++) {
            uint32_t n = i < s->face_ends[edge] ? s->face_nodes[i] : edge;
            edges[count][0] = last;
            edges[count++][1] = n;
            last = n;
        }
    }
    qsort(edges, count, sizeof *edges, compare_edges);
    for (size_t i = 1; i < count; i++)
        if (compare_edges(edges[i - 1], edges[i]) == 0)
            return false;
    return true;
}

/* The faces with one node for each that is its own parent; false where one is no polygon any more. */
static bool rename_nodes(const skeleton *s, skeleton *out, uint32_t *parents, uint32_t *seen)
{
    uint32_t put = 0;
    for (uint32_t edge = 0; edge < s->corner_count; edge++) {
        uint32_t begin = put;
        for (uint32_t i = skeleton_face_first(s, edge); i < s->face_ends[edge]; i++) {
            uint32_t n = root_of(parents, s->face_nodes[i]);
            if (put > begin && out->face_nodes[put - 1] == n)
                continue;
            if (seen[n] == edge + 1)
                return false;
            seen[n] = edge + 1;
            out->face_nodes[put++] = n;
        }
        out->face_ends[edge] = put;
        if (put == begin)
            return false;
    }
    return true;
}

bool skeleton_join(skeleton *s, double tolerance)
{
    size_t    last = s->face_ends[s->corner_count - 1];
    uint32_t *parents = mem_calloc(s->node_count, sizeof *parents), *seen = mem_calloc(s->node_count, sizeof *seen);
    skeleton  joined = *s;
    joined.face_ends = mem_calloc(s->corner_count, sizeof *joined.face_ends);
    joined.face_nodes = mem_calloc(last + 1, sizeof *joined.face_nodes);
    uint32_t(*edges)[2] = mem_calloc(last + s->corner_count, sizeof *edges);
    bool good = parents && seen && joined.face_ends && joined.face_nodes && edges;
    for (uint32_t i = 0; i < s->node_count && good; i++)
        parents[i] = i;
    for (uint32_t edge = 0; edge < s->corner_count && good; edge++)
        for (uint32_t i = skeleton_face_first(s, edge) + 1; i < s->face_ends[edge]; i++) {
            uint32_t             a = s->face_nodes[i - 1], b = s->face_nodes[i];
            const skeleton_node *p = &s->nodes[a], *q = &s->nodes[b];
            if (hypot(hypot(p->x - q->x, p->y - q->y), p->time - q->time) >= tolerance)
                continue;
            a = root_of(parents, a);
            b = root_of(parents, b);
            parents[a > b ? a : b] = a > b ? b : a;
        }
    if (good && rename_nodes(s, &joined, parents, seen) && are_edges_single(&joined, edges) &&
        skeleton_covers(&joined)) {
        mem_free(s->face_ends);
        mem_free(s->face_nodes);
        *s = joined;
    } else {
        mem_free(joined.face_ends);
        mem_free(joined.face_nodes);
    }
    mem_free(edges);
    mem_free(parents);
    mem_free(seen);
    return good;
}
