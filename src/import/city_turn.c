/* Which way faces look. Files of city models say that faces run anticlockwise seen from outside, and many do not hold
 * to it. Two faces that share an edge agree when they pass it in opposite directions; so all faces that hang together
 * are either right or wrong together (a union-find whose links say whether two agree). What is closed is right when
 * its volume is positive. What is open looks up if it is a roof or terrain, and down if it is a ground. */
#include <math.h>
#include <string.h>

#include "base/memory.h"
#include "import/city.h"

typedef struct turn_edge {
    uint32_t low, high; /* points */
    uint32_t face;      /* that passes it first */
    uint32_t used;      /* the round in which the slot was filled */
    uint16_t count;
    bool     upwards; /* that face passes it from low to high */
} turn_edge;

/* A set of faces that hang together, at its root. */
typedef struct turn_group {
    uint32_t parent;
    bool     against; /* it looks the other way than its parent */
    bool     open;
    double   volume, upright, votes, area; /* with all faces as the root has them */
} turn_group;

struct city_turner {
    turn_edge  *edges;
    size_t      edge_capacity; /* a power of two */
    uint32_t    round;
    turn_group *groups;
    size_t      group_capacity;
};

city_turner *city_turner_new(void)
{
    return mem_calloc(1, sizeof(city_turner));
}

void city_turner_free(city_turner *t)
{
    if (!t)
        return;
    mem_free(t->edges);
    mem_free(t->groups);
    mem_free(t);
}

static bool make_room(city_turner *t, const city_shape *shape)
{
    size_t slots = 256;
    while (slots < shape->corner_count * 2)
        slots *= 2;
    if (slots > t->edge_capacity) {
        mem_free(t->edges);
        t->edges = mem_calloc(slots, sizeof *t->edges);
        t->edge_capacity = t->edges ? slots : 0;
        t->round = 0;
    }
    if (++t->round == 0) { /* it has wrapped round: old marks would count again */
        memset(t->edges, 0, t->edge_capacity * sizeof *t->edges);
        t->round = 1;
    }
    return t->edges && mem_grow((void **)&t->groups, &t->group_capacity, shape->face_count, sizeof *t->groups);
}

/* The root of a face's set; *against: it looks the other way than that. Halves the path on the way. */
static uint32_t find_root(turn_group *g, uint32_t face, bool *against)
{
    *against = false;
    while (g[face].parent != face) {
        uint32_t above = g[face].parent;
        if (g[above].parent != above) {
            g[face].against = g[face].against != g[above].against;
            g[face].parent = g[above].parent;
        }
        *against = *against != g[face].against;
        face = g[face].parent;
    }
    return face;
}

static void unite(turn_group *g, uint32_t a, uint32_t b, bool differ)
{
    bool     against_a, against_b;
    uint32_t ra = find_root(g, a, &against_a), rb = find_root(g, b, &against_b);
    if (ra == rb)
        return;
    g[rb].parent = ra;
    g[rb].against = differ != (against_a != against_b);
}

static turn_edge *find_edge(city_turner *t, uint32_t low, uint32_t high)
{
    uint64_t h = (low | (uint64_t)high << 32) * UINT64_C(0x9E3779B97F4A7C15);
    size_t   mask = t->edge_capacity - 1, slot = (h >> 32) & mask;
    while (t->edges[slot].used == t->round && (t->edges[slot].low != low || t->edges[slot].high != high))
        slot = (slot + 1) & mask;
    return &t->edges[slot];
}

static void pass_edge(city_turner *t, uint32_t face, uint32_t from, uint32_t to)
{
    uint32_t   low = from < to ? from : to, high = from < to ? to : from;
    turn_edge *e = find_edge(t, low, high);
    bool       upwards = from == low;
    if (e->used != t->round) {
        *e = (turn_edge){low, high, face, t->round, 1, upwards};
        return;
    }
    /* Where more than two meet, nobody knows who belongs to whom. */
    if (e->count == 1 && e->face != face)
        unite(t->groups, e->face, face, e->upwards == upwards);
    if (e->count < 3)
        e->count++;
}

static void pass_rings(city_turner *t, const city_shape *s, uint32_t face)
{
    for (size_t r = city_first_ring(s, face); r < s->faces[face].ring_end; r++) {
        size_t first = city_first_corner(s, r), end = s->rings[r];
        for (size_t i = first; i < end; i++)
            pass_edge(t, face, s->corners[i], s->corners[i + 1 < end ? i + 1 : first]);
    }
}

static void mark_open(city_turner *t, const city_shape *s)
{
    for (uint32_t f = 0; f < s->face_count; f++)
        for (size_t r = city_first_ring(s, f); r < s->faces[f].ring_end; r++) {
            size_t first = city_first_corner(s, r), end = s->rings[r];
            for (size_t i = first; i < end; i++) {
                uint32_t a = s->corners[i], b = s->corners[i + 1 < end ? i + 1 : first];
                bool     against;
                if (find_edge(t, a < b ? a : b, a < b ? b : a)->count != 2)
                    t->groups[find_root(t->groups, f, &against)].open = true;
            }
        }
}

static vec3 middle_of(const vec3 *points, const city_shape *s)
{
    box3 box = box3_empty();
    for (size_t i = 0; i < s->corner_count; i++)
        box = box3_with_point(box, points[s->corners[i]]);
    double middle[3];
    box3_middle(box, middle);
    return (vec3){(float)middle[0], (float)middle[1], (float)middle[2]};
}

static void measure(city_turner *t, const vec3 *points, const city_shape *s, vec3 middle)
{
    static const char *const up = "roof", *const down = "ground";
    for (uint32_t f = 0; f < s->face_count; f++) {
        bool        against;
        turn_group *g = &t->groups[find_root(t->groups, f, &against)];
        double      n[3], sign = against ? -1 : 1;
        vec3        p = points[s->corners[city_first_corner(s, city_first_ring(s, f))]];
        const char *word = s->faces[f].word == CITY_NO_WORD ? "" : city_words[s->faces[f].word];
        city_normal(points, s, f, n);
        for (int k = 0; k < 3; k++)
            n[k] *= sign;
        g->volume += ((double)p.x - (double)middle.x) * n[0] + ((double)p.y - (double)middle.y) * n[1] +
                     ((double)p.z - (double)middle.z) * n[2];
        g->area += sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
        g->upright += n[2];
        g->votes += strcmp(word, up) == 0 ? n[2] : strcmp(word, down) == 0 ? -n[2] : 0;
    }
}

/* Is a set, as its root has it, inside out? */
static bool is_wrong(const turn_group *g, bool building, double total)
{
    if (!g->open)
        return g->volume < 0;
    if (fabs(g->votes) > 0.05 * g->area)
        return g->votes < 0;
    if (!building)
        return g->upright < -0.2 * g->area;
    return g->area > 0.5 * total && g->volume < 0; /* what looks away from the middle */
}

static void turn_face(city_shape *s, size_t face)
{
    for (size_t r = city_first_ring(s, face); r < s->faces[face].ring_end; r++)
        for (size_t i = city_first_corner(s, r), k = s->rings[r] - 1; i < k; i++, k--) {
            uint32_t corner = s->corners[i];
            s->corners[i] = s->corners[k];
            s->corners[k] = corner;
            if (s->uv_count) {
                vec2 uv = s->uvs[i];
                s->uvs[i] = s->uvs[k];
                s->uvs[k] = uv;
            }
        }
}

bool city_turn(city_turner *t, const vec3 *points, city_shape *s, bool building, uint64_t *turned)
{
    if (!make_room(t, s))
        return false;
    for (uint32_t f = 0; f < s->face_count; f++)
        t->groups[f] = (turn_group){.parent = f};
    for (uint32_t f = 0; f < s->face_count; f++)
        pass_rings(t, s, f);
    mark_open(t, s);
    measure(t, points, s, middle_of(points, s));
    double total = 0;
    for (uint32_t f = 0; f < s->face_count; f++)
        total += t->groups[f].area;
    for (uint32_t f = 0; f < s->face_count; f++) {
        bool     against;
        uint32_t root = find_root(t->groups, f, &against);
        if (is_wrong(&t->groups[root], building, total) == against || (s->faces[f].flags & CITY_INNER))
            continue;
        turn_face(s, f);
        ++*turned;
    }
    return true;
}
