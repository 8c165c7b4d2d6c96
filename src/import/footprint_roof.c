/* Roofs with slopes over all edges of any outline: its straight skeleton, lifted. At the ends of ridges the slope may
 * be moved out until it stands upright; a knee makes it steep below and gentle, or level, above. */
#include <math.h>

#include "base/memory.h"
#include "import/footprint_raiser.h"
#include "import/skeleton.h"

enum { NOT_PUT = UINT32_MAX };

#define JOINED        1e-3 /* m: nodes that are so near are one */
#define OPPOSITE      -0.8 /* cosine between the normals of the slopes beside a gable */
#define GABLE_RISE    1.25 /* as much higher than the hip a gable may be */
#define KNEE          0.3  /* of the way in */
#define KNEE_HEIGHT   0.7  /* of the roof's height */
#define KNEE_DISTANCE 4e-3 /* of the way: so far is no node from a knee */

/* A point where the knee crosses the arc between two nodes. */
typedef struct knee_point {
    uint32_t a, b, point;
} knee_point;

typedef struct sloper {
    raiser     *r;
    skeleton    s;
    uint32_t   *points; /* of nodes */
    knee_point *knees;
    uint32_t   *next; /* a knee point: the one behind it around the level top; numbers in `knees` */
    size_t      knee_count, knee_capacity, next_capacity;
    double      knee; /* time; INFINITY: none */
    double      knee_height, height;
    bool        level_top;
} sloper;

/* --- gables --------------------------------------------------------------------------------------------- */

typedef struct line {
    double nx, ny, offset; /* unit, inwards */
} line;

static line line_of(const skeleton *s, uint32_t edge)
{
    const skeleton_node *a = &s->nodes[edge], *b = &s->nodes[s->ends[edge]];
    double               length = hypot(b->x - a->x, b->y - a->y);
    line                 l = {-(b->y - a->y) / length, (b->x - a->x) / length, 0};
    l.offset = l.nx * a->x + l.ny * a->y;
    return l;
}

/* Where on an edge the slopes beside it are equally high; false where that is no place for a gable. */
static bool find_gable(const skeleton *s, uint32_t edge, uint32_t before, skeleton_node *out)
{
    const skeleton_node *a = &s->nodes[edge], *b = &s->nodes[s->ends[edge]];
    line                 l = line_of(s, before), r = line_of(s, s->ends[edge]);
    if (l.nx * r.nx + l.ny * r.ny > OPPOSITE)
        return false;
    double left = l.nx * a->x + l.ny * a->y - l.offset, right = r.nx * a->x + r.ny * a->y - r.offset;
    double rate = (l.nx - r.nx) * (b->x - a->x) + (l.ny - r.ny) * (b->y - a->y), t = (right - left) / rate;
    if (!(t > 0.02 && t < 0.98))
        return false;
    *out = (skeleton_node){a->x + t * (b->x - a->x), a->y + t * (b->y - a->y), 0};
    out->time = l.nx * out->x + l.ny * out->y - l.offset;
    return out->time > 0;
}

/* Faces with one node above their edge are moved out, if the slopes on both sides meet there: on the line of the ridge
 * that leaves the node, and on the other side of it, for the face is a triangle. The skeleton's nodes are
 * not joined yet, so that three faces meet in each. Returns how many. */
static size_t raise_gables(sloper *p)
{
    skeleton *s = &p->s;
    size_t    count = 0;
    for (uint32_t edge = 0; edge < s->corner_count; edge++)
        p->points[s->ends[edge]] = edge; /* the edge before; points are put later */
    for (uint32_t edge = 0; edge < s->corner_count; edge++) {
        uint32_t first = skeleton_face_first(s, edge), before = p->points[edge];
        if (s->face_ends[edge] != first + 1 || before == s->ends[s->ends[edge]] || s->upright[before])
            continue;
        skeleton_node *top = &s->nodes[s->face_nodes[first]], gable;
        if (!find_gable(s, edge, before, &gable) || gable.time > GABLE_RISE * top->time)
            continue;
        *top = gable;
        s->upright[edge] = true;
        count++;
    }
    s->top = 0;
    for (size_t i = 0; i < s->node_count; i++)
        s->top = fmax(s->top, s->nodes[i].time);
    return count;
}

/* --- heights -------------------------------------------------------------------------------------------- */

static double height_at(const sloper *p, double time)
{
    double eaves = p->r->how->eaves;
    if (time <= p->knee)
        return isfinite(p->knee) ? eaves + p->knee_height * time / p->knee : eaves + p->height * time / p->s.top;
    return eaves + p->knee_height + (p->height - p->knee_height) * (time - p->knee) / (p->s.top - p->knee);
}

/* A knee near 0.3 that goes through no node. */
static void set_knee(sloper *p, roof_form form)
{
    double top = p->s.top;
    p->height = p->r->how->ridge - p->r->how->eaves;
    p->level_top = form == ROOF_MANSARD_FLAT;
    p->knee = INFINITY;
    if (form != ROOF_MANSARD && form != ROOF_MANSARD_FLAT && form != ROOF_GAMBREL)
        return;
    p->knee_height = p->level_top ? p->height : KNEE_HEIGHT * p->height;
    double best = 0;
    for (int i = 0; i < 16; i++) {
        double share = KNEE + 0.01 * i, nearest = INFINITY;
        for (size_t n = 0; n < p->s.node_count; n++)
            nearest = fmin(nearest, fabs(p->s.nodes[n].time / top - share));
        if (nearest > best) {
            best = nearest;
            p->knee = share * top;
        }
        if (nearest > KNEE_DISTANCE)
            return;
    }
}

static uint32_t point_of(sloper *p, uint32_t node)
{
    const skeleton_node *n = &p->s.nodes[node];
    if (node < p->s.corner_count)
        return p->r->eaves + node;
    if (p->points[node] == NOT_PUT)
        p->points[node] = raiser_put(p->r, n->x, n->y, height_at(p, n->time));
    return p->points[node];
}

static bool is_above(const sloper *p, uint32_t node)
{
    return p->s.nodes[node].time > p->knee;
}

/* The knee between two nodes, one of them above it. Each arc is asked for twice. Returns its number in `knees`. */
static size_t knee_between(sloper *p, uint32_t a, uint32_t b)
{
    uint32_t low = a < b ? a : b, high = a < b ? b : a;
    for (size_t i = p->knee_count; i-- > 0;)
        if (p->knees[i].a == low && p->knees[i].b == high)
            return i;
    if (!mem_grow((void **)&p->knees, &p->knee_capacity, p->knee_count + 1, sizeof *p->knees) ||
        !mem_grow((void **)&p->next, &p->next_capacity, p->knee_count + 1, sizeof *p->next)) {
        p->r->good = false;
        return 0;
    }
    const skeleton_node *m = &p->s.nodes[low], *n = &p->s.nodes[high];
    double               t = (p->knee - m->time) / (n->time - m->time);
    uint32_t             point =
        raiser_put(p->r, m->x + t * (n->x - m->x), m->y + t * (n->y - m->y), p->r->how->eaves + p->knee_height);
    p->knees[p->knee_count] = (knee_point){low, high, point};
    p->next[p->knee_count] = NOT_PUT;
    return p->knee_count++;
}

/* --- faces ---------------------------------------------------------------------------------------------- */

/* From the end of an edge over its face's nodes back to its beginning. */
static uint32_t node_at(const sloper *p, uint32_t edge, uint32_t i)
{
    uint32_t first = skeleton_face_first(&p->s, edge), count = p->s.face_ends[edge] - first;
    return i == 0 ? p->s.ends[edge] : i <= count ? p->s.face_nodes[first + i - 1] : edge;
}

/* What lies above the knee of an edge's face: pieces between where it goes up and comes down again. */
static void upper_pieces(sloper *p, uint32_t edge, uint32_t count)
{
    size_t in = 0;
    for (uint32_t i = 1; i < count && p->r->good; i++) {
        uint32_t last = node_at(p, edge, i - 1), node = node_at(p, edge, i);
        bool     up = !is_above(p, last) && is_above(p, node), down = is_above(p, last) && !is_above(p, node);
        if (up) {
            in = knee_between(p, last, node);
            if (!p->level_top && p->r->good)
                raiser_corner(p->r, p->knees[in].point);
        }
        if (down) {
            size_t out = knee_between(p, last, node);
            if (p->r->good && p->level_top) {
                p->next[out] = (uint32_t)in;
            } else if (p->r->good) {
                raiser_corner(p->r, p->knees[out].point);
                raiser_end_ring(p->r);
                raiser_end_face(p->r, p->r->roof);
            }
        }
        if (is_above(p, node) && !p->level_top)
            raiser_corner(p->r, point_of(p, node));
    }
}

static void slope(sloper *p, uint32_t edge)
{
    raiser  *r = p->r;
    uint32_t count = p->s.face_ends[edge] - skeleton_face_first(&p->s, edge) + 2;
    bool     upright = p->s.upright[edge];
    raiser_begin_wall(r, edge, p->s.ends[edge]);
    if (!upright) {
        raiser_corner(r, r->eaves + edge);
        raiser_end_ring(r);
        raiser_end_face(r, r->wall);
        raiser_corner(r, r->eaves + edge);
        raiser_corner(r, r->eaves + p->s.ends[edge]);
    }
    for (uint32_t i = 1; i < count && r->good; i++) {
        uint32_t last = node_at(p, edge, i - 1), node = node_at(p, edge, i);
        if (is_above(p, last) != is_above(p, node)) {
            size_t knee = knee_between(p, last, node);
            if (r->good)
                raiser_corner(r, p->knees[knee].point);
        }
        if ((upright || !is_above(p, node)) && (upright || node != edge))
            raiser_corner(r, point_of(p, node));
    }
    raiser_end_ring(r);
    raiser_end_face(r, upright ? r->wall : r->roof);
    if (!upright && isfinite(p->knee))
        upper_pieces(p, edge, count);
}

/* --- the level top -------------------------------------------------------------------------------------- */

static double area_around(const sloper *p, uint32_t first)
{
    const vec3 *points = p->r->points->items;
    double      area = 0;
    uint32_t    i = first;
    do {
        vec3 a = points[p->knees[i].point], b = points[p->knees[p->next[i]].point];
        area += (double)a.x * b.y - (double)b.x * a.y;
        i = p->next[i];
    } while (i != first);
    return area;
}

static bool is_around(const sloper *p, uint32_t first, vec3 at)
{
    const vec3 *points = p->r->points->items;
    bool        inside = false;
    uint32_t    i = first;
    do {
        vec3 a = points[p->knees[i].point], b = points[p->knees[p->next[i]].point];
        if ((a.y > at.y) != (b.y > at.y) && at.x < (b.x - a.x) * (at.y - a.y) / (b.y - a.y) + a.x)
            inside = !inside;
        i = p->next[i];
    } while (i != first);
    return inside;
}

static void add_loop(sloper *p, uint32_t first)
{
    uint32_t i = first;
    do {
        raiser_corner(p->r, p->knees[i].point);
        i = p->next[i];
    } while (i != first);
    raiser_end_ring(p->r);
}

/* The knees' points are joined to loops: outlines, which run anticlockwise, each with the holes that lie in it. Levels
 * of one roof are never inside one another. */
static void level_top(sloper *p)
{
    size_t    count = 0;
    bool     *seen = mem_calloc(p->knee_count + 1, sizeof *seen);
    uint32_t *loops = mem_calloc(p->knee_count + 1, sizeof *loops);
    double   *areas = mem_calloc(p->knee_count + 1, sizeof *areas);
    p->r->good = p->r->good && seen && loops && areas;
    for (uint32_t i = 0; i < p->knee_count && p->r->good; i++) {
        if (seen[i] || p->next[i] == NOT_PUT)
            continue;
        for (uint32_t k = i; !seen[k]; k = p->next[k])
            seen[k] = true;
        areas[count] = area_around(p, i);
        loops[count++] = i;
    }
    for (size_t i = 0; i < count && p->r->good; i++) {
        if (areas[i] < 0)
            continue;
        add_loop(p, loops[i]);
        for (size_t k = 0; k < count; k++)
            if (areas[k] < 0 && is_around(p, loops[i], p->r->points->items[p->knees[loops[k]].point]))
                add_loop(p, loops[k]);
        raiser_end_face(p->r, p->r->roof);
    }
    mem_free(seen);
    mem_free(loops);
    mem_free(areas);
}

/* --- all of it ------------------------------------------------------------------------------------------ */

static roof_made build(sloper *p, roof_form form)
{
    bool      gables = form == ROOF_GABLED || form == ROOF_GAMBREL;
    roof_made made = ROOF_AS_ASKED;
    if (gables && raise_gables(p) == 0)
        made = ROOF_OTHERWISE;
    p->r->good = skeleton_join(&p->s, JOINED);
    for (size_t i = 0; i < p->s.node_count; i++)
        p->points[i] = NOT_PUT;
    set_knee(p, form);
    for (uint32_t edge = 0; edge < p->s.corner_count && p->r->good; edge++)
        slope(p, edge);
    if (p->level_top && p->r->good)
        level_top(p);
    return made;
}

roof_made footprint_slopes(raiser *r, roof_form form)
{
    sloper          p = {.r = r};
    roof_made       made = ROOF_MADE_FLAT;
    skeleton_status status = skeleton_make(&p.s, r->positions, r->counts, r->rings);
    r->good = r->good && status != SKELETON_NO_MEMORY;
    if (status == SKELETON_MADE && r->good) {
        p.points = mem_calloc(p.s.node_count, sizeof *p.points);
        r->good = p.points != NULL;
        if (r->good)
            made = build(&p, form);
    }
    skeleton_release(&p.s);
    mem_free(p.points);
    mem_free(p.knees);
    mem_free(p.next);
    return made;
}
