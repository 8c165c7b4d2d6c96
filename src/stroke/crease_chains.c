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
/* Where normals are smooth, chains between other lines turn so many times as much as their surroundings, and those with
 * free ends so many times: of a coarse mesh all edges turn. */
#define STANDS_OUT  2.0
#define STANDS_FREE 2.5
/* Round things have five sides or more: a chain that turns by as much as those is a corner. */
#define CORNER (72 * DEGREE)
/* Faces around a chain that are more than this fraction of what hangs together with them tell nothing. */
#define AROUND_MOST 0.5
/* There lines that lie in the middle of a surface, with two free ends, are longer than so many mean edges. */
#define ISLAND_EDGES 3
enum { ROUNDS = 16, CROWD_MOST = 16, AROUND_RINGS = 2 };
#define NO_EDGE UINT32_MAX

typedef struct chain_net {
    edge_mesh            *m;
    const crease_facts   *facts;
    const crease_measure *measured;
    uint32_t             *starts, *lines; /* per vertex, and one more: the lines that meet there */
    uint32_t (*links)[2];                 /* per edge and end: the edge that it goes on as */
    uint32_t *chain;                      /* edges of the chain that is walked along */
    uint8_t  *seen;
    uint32_t *around, *stamps, stamp; /* faces around a chain; per face: the last chain that it was found for */
    uint32_t *pieces, *sizes;         /* per face: its piece, by the piece's first face; per such: how many faces */
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

/* Radians, from one face to another one. */
static double turn_between(const edge_mesh *m, uint32_t face, uint32_t other)
{
    vec3   n = m->normals[face], o = m->normals[other];
    double x = (double)n.y * o.z - (double)n.z * o.y, y = (double)n.z * o.x - (double)n.x * o.z,
           z = (double)n.x * o.y - (double)n.y * o.x,
           cosine = (double)n.x * o.x + (double)n.y * o.y + (double)n.z * o.z;
    return atan2(sqrt(x * x + y * y + z * z), cosine);
}

static double turn_of(const edge_mesh *m, const mesh_edge *e)
{
    double turn = turn_between(m, e->face[0], e->face[1]);
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

/* --- the surface around a chain -------------------------------------------------------------------------- */

/* Do the file's normals go on over all of a chain? */
static bool is_smooth(const chain_net *n, size_t count)
{
    const edge_mesh *m = n->m;
    if (!n->facts->shading)
        return false;
    for (size_t i = 0; i < count; i++) {
        const mesh_edge *e = &m->edges[n->chain[i]];
        const uint32_t  *corners = m->faces[e->face[0]];
        uint32_t         k = corners[0] == e->vertex[0] ? 0 : corners[1] == e->vertex[0] ? 1 : 2;
        if (n->facts->shading[3 * e->face[0] + k] != SHADED_SMOOTH)
            return false;
    }
    return true;
}

static void find_face(chain_net *n, uint32_t face, uint32_t *count)
{
    if (n->stamps[face] == n->stamp)
        return;
    n->stamps[face] = n->stamp;
    n->around[(*count)++] = face;
}

/* From the faces that were found so many rings on. */
static void find_rings(chain_net *n, uint32_t *count, uint32_t rings)
{
    uint32_t next = 0;
    for (uint32_t ring = 0; ring < rings && next < *count; ring++)
        for (uint32_t end = *count; next < end; next++)
            for (uint32_t k = 0; k < 3; k++) {
                uint32_t other = n->facts->opposite[3 * n->around[next] + k];
                if (other != EDGE_NO_FACE)
                    find_face(n, other / 3, count);
            }
}

/* What hangs together. */
static void find_pieces(chain_net *n)
{
    n->stamp++;
    for (uint32_t f = 0; f < n->m->face_count; f++) {
        uint32_t count = 0;
        find_face(n, f, &count);
        find_rings(n, &count, UINT32_MAX);
        for (uint32_t i = 0; i < count; i++)
            n->pieces[n->around[i]] = f;
        if (count > 0)
            n->sizes[f] = count;
    }
}

/* The faces beside a chain, and those around them; how many. */
static uint32_t find_around(chain_net *n, size_t edges)
{
    uint32_t count = 0;
    n->stamp++;
    for (size_t i = 0; i < edges; i++)
        for (int k = 0; k < 2; k++)
            find_face(n, n->m->edges[n->chain[i]].face[k], &count);
    find_rings(n, &count, AROUND_RINGS);
    return count;
}

/* By how much the edges of faces around a chain turn, its own left out: the mean by length, of every face's edges. 0
 * where the chain is about all that there is. */
static double turn_around(chain_net *n, const chain_facts *f)
{
    const edge_mesh *m = n->m;
    const uint32_t   count = find_around(n, f->count);
    double           turn = -2 * f->turn * f->length, whole = -2 * f->length, way[3]; /* both its faces are there */
    if (count > AROUND_MOST * n->sizes[n->pieces[n->around[0]]])
        return 0;
    for (uint32_t i = 0; i < count; i++)
        for (uint32_t k = 0; k < 3; k++) {
            const uint32_t *corners = m->faces[n->around[i]], other = n->facts->opposite[3 * n->around[i] + k];
            if (other == EDGE_NO_FACE)
                continue;
            mesh_edge e = {.vertex = {corners[k], corners[(k + 1) % 3]}};
            double    length = direction_of(m, &e, e.vertex[0], way);
            turn += length * turn_between(m, n->around[i], other / 3);
            whole += length;
        }
    return whole > 0 ? turn / whole : 0;
}

/* Is a chain one of the edges that a coarse mesh of a curved surface has everywhere? */
static bool is_of_mesh(chain_net *n, const chain_facts *f)
{
    if (!is_smooth(n, f->count) || f->turn >= CORNER)
        return false;
    return (f->free_ends == 2 && f->length < ISLAND_EDGES * n->measured->mean_edge) ||
           f->turn < (f->free_ends > 0 ? STANDS_FREE : STANDS_OUT) * turn_around(n, f);
}

/* --- all ------------------------------------------------------------------------------------------------- */

/* One round; whether chains went. */
static bool judge_chains(chain_net *n, double weak_turn)
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
        bool        may_go = weak_turn > 0 && f.length < SHORT * n->measured->size;
        bool        goes = may_go && ((f.turn < weak_turn && f.free_ends > 0) || is_of_mesh(n, &f));
        for (size_t k = 0; k < f.count; k++) {
            mesh_edge *e = &m->edges[n->chain[k]];
            bool       said = n->m->said && e->turn > 0; /* faces of what was made round turn less */
            e->turn = goes ? 0 : said ? e->turn : (float)f.turn;
            e->flags = goes ? (e->flags & ~(uint32_t)EDGE_CREASE) | EDGE_CANDIDATE | EDGE_QUIET : e->flags;
        }
        gone = gone || goes;
    }
    return gone;
}

static void close_net(chain_net *n)
{
    mem_free(n->starts);
    mem_free(n->lines);
    mem_free(n->links);
    mem_free(n->chain);
    mem_free(n->seen);
    mem_free(n->around);
    mem_free(n->stamps);
    mem_free(n->pieces);
    mem_free(n->sizes);
}

bool crease_chains_judge(edge_mesh *m, const crease_facts *facts, const crease_measure *measured, bool hand_made)
{
    const double weak_turn = hand_made && !m->said ? fmin(WEAK, WEAK_TIMES * facts->angle) : 0;
    size_t       edges = (size_t)m->edge_count + 1, faces = (size_t)m->face_count + 1;
    chain_net    n = {.m = m, .facts = facts, .measured = measured};
    n.starts = mem_alloc(((size_t)m->vertex_count + 2) * sizeof *n.starts);
    n.lines = mem_alloc(2 * edges * sizeof *n.lines);
    n.links = mem_alloc(edges * sizeof *n.links);
    n.chain = mem_alloc(edges * sizeof *n.chain);
    n.seen = mem_alloc(edges);
    n.around = mem_alloc(faces * sizeof *n.around);
    n.stamps = mem_calloc(faces, sizeof *n.stamps);
    n.pieces = mem_alloc(faces * sizeof *n.pieces);
    n.sizes = mem_alloc(faces * sizeof *n.sizes);
    bool good = n.starts && n.lines && n.links && n.chain && n.seen && n.around && n.stamps && n.pieces && n.sizes;
    if (good && weak_turn > 0)
        find_pieces(&n);
    for (int round = 0; good && round < ROUNDS; round++)
        if (!judge_chains(&n, weak_turn))
            break;
    close_net(&n);
    return good;
}
