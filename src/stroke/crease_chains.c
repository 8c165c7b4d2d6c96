/* Edges are linked at their vertices: two that meet alone, and of more the pairs that go on straightest, each the
 * other's best. Dropping a chain may leave another one with a free end, so there are a few rounds. */
#include "stroke/crease_chains.h"

#include <math.h>

#include "base/memory.h"

#define DEGREE 0.017453292519943295
/* A chain with a free end is weak when its mean turn is less than this, and than the angle times … */
#define WEAK       (59 * DEGREE)
#define WEAK_TIMES 2.25
/* … and short when it is shorter than this fraction of the mesh. */
#define SHORT 0.6
/* Beside other lines edges go on as one another when they turn by less: cosine. */
#define STRAIGHT 0.7
enum { ROUNDS = 4, CROWD_MOST = 16 };
#define NO_EDGE UINT32_MAX

typedef struct chain_net {
    edge_mesh *m;
    uint32_t  *starts, *lines; /* per vertex, and one more: the lines that meet there */
    uint32_t (*links)[2];      /* per edge and end: the edge that it goes on as */
    uint32_t *chain;           /* edges of the chain that is walked along */
    uint8_t  *seen;
} chain_net;

typedef struct chain_facts {
    double length, turn; /* turn: mean, radians */
    size_t count;
    int    free_ends;
} chain_facts;

static bool is_line(const mesh_edge *e)
{
    return (e->flags & (EDGE_BORDER | EDGE_CREASE | EDGE_MATERIAL)) != 0;
}

/* Lines that have a chain: what else is a line stays one. */
static bool is_chained(const mesh_edge *e)
{
    return (e->flags & (EDGE_BORDER | EDGE_CREASE | EDGE_MATERIAL | EDGE_ROUNDED)) == EDGE_CREASE;
}

static double direction_of(const edge_mesh *m, const mesh_edge *e, uint32_t from, double out[3])
{
    bool   forward = e->vertex[0] == from;
    vec3   a = m->positions[e->vertex[forward ? 0 : 1]], b = m->positions[e->vertex[forward ? 1 : 0]];
    double length = 0;
    out[0] = (double)b.x - a.x;
    out[1] = (double)b.y - a.y;
    out[2] = (double)b.z - a.z;
    for (int k = 0; k < 3; k++)
        length += out[k] * out[k];
    length = sqrt(length);
    for (int k = 0; k < 3 && length > 0; k++)
        out[k] /= length;
    return length;
}

/* Radians, over the faces of an edge. */
static double turn_of(const edge_mesh *m, const mesh_edge *e)
{
    vec3   n = m->normals[e->face[0]], o = m->normals[e->face[1]];
    double x = (double)n.y * o.z - (double)n.z * o.y, y = (double)n.z * o.x - (double)n.x * o.z,
           z = (double)n.x * o.y - (double)n.y * o.x,
           cosine = (double)n.x * o.x + (double)n.y * o.y + (double)n.z * o.z;
    double turn = atan2(sqrt(x * x + y * y + z * z), cosine);
    return e->flags & EDGE_TWISTED ? 180 * DEGREE - turn : turn;
}

static void fill_net(chain_net *n)
{
    const edge_mesh *m = n->m;
    for (uint32_t v = 0; v < m->vertex_count + 2; v++)
        n->starts[v] = 0;
    for (uint32_t i = 0; i < m->edge_count; i++)
        for (int k = 0; k < 2 && is_line(&m->edges[i]); k++)
            n->starts[m->edges[i].vertex[k] + 2]++;
    for (uint32_t v = 0; v < m->vertex_count; v++)
        n->starts[v + 2] += n->starts[v + 1];
    for (uint32_t i = 0; i < m->edge_count; i++) {
        n->links[i][0] = n->links[i][1] = NO_EDGE;
        n->seen[i] = 0;
        for (int k = 0; k < 2 && is_line(&m->edges[i]); k++)
            n->lines[n->starts[m->edges[i].vertex[k] + 1]++] = i;
    }
}

/* The edge that another one at a vertex goes on as most nearly straight. */
static uint32_t straightest(const chain_net *n, uint32_t vertex, uint32_t edge)
{
    const edge_mesh *m = n->m;
    double           own[3], least = -STRAIGHT;
    uint32_t         found = NO_EDGE;
    direction_of(m, &m->edges[edge], vertex, own);
    for (uint32_t i = n->starts[vertex]; i < n->starts[vertex + 1]; i++) {
        uint32_t other = n->lines[i];
        double   way[3];
        if (other == edge || !is_chained(&m->edges[other]))
            continue;
        direction_of(m, &m->edges[other], vertex, way);
        double cosine = own[0] * way[0] + own[1] * way[1] + own[2] * way[2];
        if (cosine < least) {
            least = cosine;
            found = other;
        }
    }
    return found;
}

static void link_at(chain_net *n, uint32_t vertex)
{
    const edge_mesh *m = n->m;
    uint32_t         first = n->starts[vertex], count = n->starts[vertex + 1] - first;
    for (uint32_t i = 0; i < count && count <= CROWD_MOST; i++) {
        uint32_t edge = n->lines[first + i];
        if (!is_chained(&m->edges[edge]))
            continue;
        uint32_t other = count == 2 ? n->lines[first + 1 - i] : straightest(n, vertex, edge);
        if (other == NO_EDGE || !is_chained(&m->edges[other]) || (count > 2 && straightest(n, vertex, other) != edge))
            continue;
        n->links[edge][m->edges[edge].vertex[0] == vertex ? 0 : 1] = other;
    }
}

/* Goes along a chain from an edge away from one of its ends; the last vertex. */
static uint32_t walk(chain_net *n, uint32_t edge, int end, size_t *count)
{
    const edge_mesh *m = n->m;
    uint32_t         vertex = m->edges[edge].vertex[end];
    for (;;) {
        uint32_t next = n->links[edge][m->edges[edge].vertex[0] == vertex ? 0 : 1];
        if (next == NO_EDGE || n->seen[next])
            return vertex;
        n->seen[next] = 1;
        n->chain[(*count)++] = edge = next;
        vertex = m->edges[edge].vertex[0] == vertex ? m->edges[edge].vertex[1] : m->edges[edge].vertex[0];
    }
}

static chain_facts follow(chain_net *n, uint32_t start)
{
    const edge_mesh *m = n->m;
    chain_facts      out = {.count = 1};
    double           turn = 0, way[3];
    n->seen[start] = 1;
    n->chain[0] = start;
    for (int end = 0; end < 2; end++) {
        uint32_t last = walk(n, start, end, &out.count);
        out.free_ends += n->starts[last + 1] - n->starts[last] == 1;
    }
    for (size_t i = 0; i < out.count; i++) {
        const mesh_edge *e = &m->edges[n->chain[i]];
        double           length = direction_of(m, e, e->vertex[0], way);
        out.length += length;
        turn += length * turn_of(m, e);
    }
    out.turn = out.length > 0 ? turn / out.length : 0;
    return out;
}

/* One round; whether chains went. */
static bool judge_chains(chain_net *n, double size, double weak_turn)
{
    edge_mesh *m = n->m;
    bool       gone = false;
    fill_net(n);
    for (uint32_t v = 0; v < m->vertex_count; v++)
        link_at(n, v);
    for (uint32_t i = 0; i < m->edge_count; i++) {
        if (n->seen[i] || !is_chained(&m->edges[i]))
            continue;
        chain_facts f = follow(n, i);
        bool        weak = f.turn < weak_turn && f.length < SHORT * size;
        bool        goes = weak && f.free_ends > 0;
        for (size_t k = 0; k < f.count; k++) {
            mesh_edge *e = &m->edges[n->chain[k]];
            e->turn = goes ? 0 : (float)f.turn;
            e->flags = goes ? (e->flags & ~(uint32_t)EDGE_CREASE) | EDGE_CANDIDATE | EDGE_QUIET : e->flags;
        }
        gone = gone || goes;
    }
    return gone;
}

bool crease_chains_judge(edge_mesh *m, double size, double angle, bool hand_made)
{
    const double weak_turn = hand_made && !m->said ? fmin(WEAK, WEAK_TIMES * angle) : 0;
    size_t       edges = (size_t)m->edge_count + 1;
    chain_net    n = {.m = m};
    n.starts = mem_alloc(((size_t)m->vertex_count + 2) * sizeof *n.starts);
    n.lines = mem_alloc(2 * edges * sizeof *n.lines);
    n.links = mem_alloc(edges * sizeof *n.links);
    n.chain = mem_alloc(edges * sizeof *n.chain);
    n.seen = mem_alloc(edges);
    bool good = n.starts && n.lines && n.links && n.chain && n.seen;
    for (int round = 0; good && round < ROUNDS; round++)
        if (!judge_chains(&n, size, weak_turn))
            break;
    mem_free(n.starts);
    mem_free(n.lines);
    mem_free(n.links);
    mem_free(n.chain);
    mem_free(n.seen);
    return good;
}
