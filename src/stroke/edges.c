/* Half-edges are sorted into buckets by their lower vertex, so that those of one edge lie side by side; each edge
 * is then judged once. */
#include "stroke/edge_builder.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/groups.h"
#include "base/memory.h"
#include "stroke/butterfly_mesh.h"
#include "stroke/drawn.h"
#include "stroke/solid.h"

/* A face leans out of its neighbour's plane when the corner that they do not share is farther from it than this
 * fraction of its distance. */
#define FLAT 1e-6f
/* Nor does it when it is as near to the plane as rounding alone may take it, fraction of its largest coordinate. */
#define ROUNDED 3e-7f
enum { SHORT_BUCKET = 24 };

/* --- buckets -------------------------------------------------------------------------------------------- */

static uint32_t corner_vertex(const edge_mesh *m, uint32_t corner)
{
    return m->faces[corner / 3][corner % 3];
}

static uint32_t next_corner(uint32_t corner)
{
    return corner % 3 == 2 ? corner - 2 : corner + 1;
}

static int compare_halves(const void *a, const void *b)
{
    const half_edge *p = a, *q = b;
    if (p->high != q->high)
        return p->high < q->high ? -1 : 1;
    return p->corner < q->corner ? -1 : p->corner > q->corner;
}

static void sort_bucket(half_edge *halves, size_t count)
{
    if (count > SHORT_BUCKET) {
        qsort(halves, count, sizeof *halves, compare_halves);
        return;
    }
    for (size_t i = 1; i < count; i++) {
        half_edge moved = halves[i];
        size_t    k = i;
        for (; k > 0 && halves[k - 1].high > moved.high; k--)
            halves[k] = halves[k - 1];
        halves[k] = moved;
    }
}

static void fill_buckets(edge_builder *b)
{
    const edge_mesh *m = b->mesh;
    memset(b->starts, 0, ((size_t)m->vertex_count + 2) * sizeof *b->starts);
    for (uint32_t f = 0; f < m->face_count; f++)
        for (int k = 0; k < 3; k++) {
            uint32_t p = m->faces[f][k], q = m->faces[f][k == 2 ? 0 : k + 1];
            b->starts[(p < q ? p : q) + 2]++;
        }
    for (uint32_t v = 0; v < m->vertex_count; v++)
        b->starts[v + 2] += b->starts[v + 1];
    /* Counted two positions on, so that filling, which moves each start to its end, leaves them right. */
    for (uint32_t f = 0; f < m->face_count; f++)
        for (uint32_t k = 0; k < 3; k++) {
            uint32_t p = m->faces[f][k], q = m->faces[f][k == 2 ? 0 : k + 1];
            b->halves[b->starts[(p < q ? p : q) + 1]++] = (half_edge){p < q ? q : p, 3 * f + k};
        }
}

/* --- pieces --------------------------------------------------------------------------------------------- */

/* Six times the volume that a face closes off towards a point near it. */
static double volume_of(const edge_mesh *m, uint32_t f, vec3 from)
{
    vec3 p = minus(m->positions[m->faces[f][0]], from), q = minus(m->positions[m->faces[f][1]], from),
         r = minus(m->positions[m->faces[f][2]], from);
    return (double)p.x * ((double)q.y * r.z - (double)q.z * r.y) +
           (double)p.y * ((double)q.z * r.x - (double)q.x * r.z) +
           (double)p.z * ((double)q.x * r.y - (double)q.y * r.x);
}

static void widen(box3 *box, vec3 p)
{
    box->min = (vec3){p.x < box->min.x ? p.x : box->min.x, p.y < box->min.y ? p.y : box->min.y,
                      p.z < box->min.z ? p.z : box->min.z};
    box->max = (vec3){p.x > box->max.x ? p.x : box->max.x, p.y > box->max.y ? p.y : box->max.y,
                      p.z > box->max.z ? p.z : box->max.z};
}

/* A root comes before all others of its piece. */
static void number_pieces(edge_builder *b)
{
    edge_mesh *m = b->mesh;
    m->pieces = b->pieces;
    b->pieces = NULL;
    for (uint32_t f = 0; f < m->face_count; f++)
        m->pieces[f] = m->pieces[f] == f ? m->piece_count++ : m->pieces[m->pieces[f]];
}

/* Boxes of the pieces, and volumes by their first corner, which says which way round they are. */
double *edges_measure_pieces(edge_mesh *m)
{
    m->boxes = mem_alloc(((size_t)m->piece_count + 1) * sizeof *m->boxes);
    m->closed = mem_alloc((size_t)m->piece_count + 1);
    m->inward = mem_alloc((size_t)m->piece_count + 1);
    double *volumes = mem_calloc((size_t)m->piece_count + 1, sizeof *volumes);
    vec3   *origins = mem_alloc(((size_t)m->piece_count + 1) * sizeof *origins);
    if (!m->boxes || !m->closed || !m->inward || !volumes || !origins) {
        mem_free(origins);
        mem_free(volumes);
        return NULL;
    }
    uint32_t seen = 0;
    for (uint32_t f = 0; f < m->face_count; f++) {
        uint32_t piece = m->pieces[f];
        if (piece == seen) {
            origins[piece] = m->positions[m->faces[f][0]];
            m->boxes[piece] = box3_empty();
            m->closed[piece] = true;
            seen++;
        }
        volumes[piece] += volume_of(m, f, origins[piece]);
        for (int k = 0; k < 3; k++)
            widen(&m->boxes[piece], m->positions[m->faces[f][k]]);
    }
    mem_free(origins);
    return volumes;
}

/* --- edges ---------------------------------------------------------------------------------------------- */

/* How far the neighbour's free corner lies above a face: below 0, the edge is convex; 0 when both lie in one plane. */
static float height_above(const edge_mesh *m, uint32_t face, uint32_t neighbour_corner)
{
    uint32_t beyond = next_corner(next_corner(neighbour_corner));
    vec3     free = m->positions[corner_vertex(m, beyond)],
         from_edge = minus(free, m->positions[corner_vertex(m, neighbour_corner)]);
    float height = dot(from_edge, m->normals[face]), x = fabsf(free.x), y = fabsf(free.y),
          z = fabsf(free.z), /* fmaxf is a call */
        rounding = ROUNDED * (x > y   ? x > z ? x : z
                              : y > z ? y
                                      : z);
    return fabsf(height) <= FLAT * sqrtf(dot(from_edge, from_edge)) || fabsf(height) <= rounding ? 0 : height;
}

/* The same, unless the face lies in the neighbour's plane: a narrow face does not know its own. */
static float height_between(const edge_mesh *m, uint32_t first, uint32_t second)
{
    return height_above(m, second / 3, first) == 0 ? 0 : height_above(m, first / 3, second);
}

/* Flags of an edge of two faces. `same_direction`: both pass it in one direction, so one of them is inside out. */
static uint32_t judge_pair(const edge_builder *b, uint32_t first, uint32_t second, bool same_direction)
{
    const edge_mesh *m = b->mesh;
    uint32_t         f = first / 3, g = second / 3, flags = 0;
    float            turn = dot(m->normals[f], m->normals[g]);
    float            height = height_between(m, first, second);
    turn = same_direction ? -turn : turn;
    if (turn < b->crease && (height != 0 || turn < 0)) /* a narrow face in its neighbour's plane points anywhere */
        flags |= EDGE_CREASE;
    if (m->materials && m->materials[f] != m->materials[g])
        flags |= EDGE_MATERIAL;
    if (!(flags & EDGE_CREASE) && height != 0)
        flags |= EDGE_CANDIDATE;
    if (flags && same_direction)
        flags |= EDGE_TWISTED;
    return height < 0 ? flags | EDGE_CONVEX : flags;
}

/* What the file says overrules the angle. */
static uint32_t obey(uint32_t flags, const uint8_t *said, const half_edge *group, size_t count)
{
    uint32_t loudest = SAID_HIDDEN;
    bool     any = false;
    for (size_t i = 0; i < count; i++) {
        uint8_t word = said[group[i].corner];
        any = any || word != SAID_NOTHING;
        if (word != SAID_NOTHING && word > loudest)
            loudest = word;
    }
    if (!any)
        return flags;
    if (loudest == SAID_HIDDEN)
        return 0;
    if (loudest == SAID_SILHOUETTE && flags & EDGE_BORDER) /* always a rim */
        return flags;
    if (loudest == SAID_SILHOUETTE)
        return EDGE_CANDIDATE | (flags & (EDGE_CONVEX | EDGE_TWISTED));
    return (flags & ~(uint32_t)EDGE_CANDIDATE) | EDGE_CREASE;
}

/* By how much an edge turned before the mesh was made round; 0: nobody says so. */
static float turn_said(const edge_mesh *m, const half_edge *group, size_t count)
{
    float turn = 0;
    for (size_t i = 0; m->said && i < count; i++)
        if (m->said[group[i].corner] >= EDGE_TURNED)
            turn = fmaxf(turn, edge_turn(m->said[group[i].corner]));
    return turn;
}

static bool put_edge(edge_builder *b, uint32_t low, uint32_t flags, const half_edge *group, size_t count)
{
    edge_mesh *m = b->mesh;
    if (!mem_grow((void **)&m->edges, &b->edge_capacity, (size_t)m->edge_count + 1, sizeof *m->edges))
        return false;
    uint32_t corner = group[0].corner, begin = corner_vertex(m, corner);
    m->edges[m->edge_count++] = (mesh_edge){{begin, begin == low ? group[0].high : low},
                                            {corner / 3, count > 1 ? group[1].corner / 3 : EDGE_NO_FACE},
                                            flags,
                                            flags & EDGE_CREASE ? turn_said(m, group, count) : 0};
    return true;
}

static bool have_same_corners(const uint32_t a[3], const uint32_t b[3])
{
    for (int k = 0; k < 3; k++)
        if (a[k] != b[0] && a[k] != b[1] && a[k] != b[2])
            return false;
    return true;
}

/* All half-edges of one edge. */
bool edges_take(edge_builder *b, uint32_t low, const half_edge *group, size_t count)
{
    edge_mesh *m = b->mesh;
    uint32_t   flags = EDGE_BORDER;
    m->all_edges++;
    m->loose_edges += count != 2;
    if (count == 2) {
        bool same_direction = (corner_vertex(m, group[0].corner) == low) == (corner_vertex(m, group[1].corner) == low);
        flags = judge_pair(b, group[0].corner, group[1].corner, same_direction);
    }
    if (count == 2 && b->pieces) { /* else these are known */
        group_join(b->pieces, group[0].corner / 3, group[1].corner / 3);
        b->has_twins = b->has_twins || have_same_corners(m->faces[group[0].corner / 3], m->faces[group[1].corner / 3]);
    }
    b->has_twins = b->has_twins || count > 2 || (flags & EDGE_TWISTED);
    if (m->said)
        flags = obey(flags, m->said, group, count);
    return flags == 0 || flags == EDGE_CONVEX || put_edge(b, low, flags, group, count);
}

/* Calls for all edges, once their buckets are sorted; false ends it. */

bool edges_visit(edge_builder *b, uint32_t first, uint32_t end_vertex, edge_visit visit)
{
    for (uint32_t v = first; v < end_vertex; v++) {
        const half_edge *bucket = b->halves + b->starts[v];
        size_t           size = b->starts[v + 1] - b->starts[v];
        for (size_t begin = 0, end = 0; begin < size; begin = end) {
            while (end < size && bucket[end].high == bucket[begin].high)
                end++;
            if (!visit(b, v, bucket + begin, end - begin))
                return false;
        }
    }
    return true;
}

static bool each_edge(edge_builder *b, edge_visit visit)
{
    return edges_visit(b, 0, b->mesh->vertex_count, visit);
}

static bool take_edges(edge_builder *b)
{
    edge_mesh *m = b->mesh;
    b->has_twins = false;
    m->edge_count = m->all_edges = m->loose_edges = 0;
    for (uint32_t f = 0; f < m->face_count; f++)
        b->pieces[f] = f;
    for (uint32_t v = 0; v < m->vertex_count; v++)
        sort_bucket(b->halves + b->starts[v], b->starts[v + 1] - b->starts[v]);
    return each_edge(b, edges_take);
}

static bool mark_twins(edge_builder *b, uint32_t low, const half_edge *group, size_t count)
{
    (void)low;
    for (size_t i = 0; i < count && count <= SHORT_BUCKET; i++)
        for (size_t k = i + 1; k < count; k++)
            if (have_same_corners(b->mesh->faces[group[i].corner / 3], b->mesh->faces[group[k].corner / 3]))
                b->dropped[group[k].corner / 3] = 1;
    return true;
}

/* The half-edges between two vertices. */
static const half_edge *find_group(const edge_builder *b, uint32_t p, uint32_t q, size_t *count)
{
    uint32_t         low = p < q ? p : q, high = p < q ? q : p;
    const half_edge *at = b->halves + b->starts[low], *end = b->halves + b->starts[low + 1];
    while (at < end && at->high < high)
        at++;
    for (*count = 0; at + *count < end && at[*count].high == high;)
        ++*count;
    return at;
}

static uint32_t third_corner(const uint32_t face[3], uint32_t p, uint32_t q)
{
    return face[0] != p && face[0] != q ? face[0] : face[1] != p && face[1] != q ? face[1] : face[2];
}

static vec3 cross(vec3 a, vec3 b)
{
    return (vec3){a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

/* Do p and q lie to different sides of the line through a and b? */
static bool are_parted(const edge_mesh *m, uint32_t a, uint32_t b, uint32_t p, uint32_t q)
{
    vec3 from = m->positions[a], way = minus(m->positions[b], from);
    return dot(cross(way, minus(m->positions[p], from)), cross(way, minus(m->positions[q], from))) < 0;
}

/* Is a face with a border from u to v half of a quad that two other faces in its plane make, divided the other way? */
static bool is_covered(const edge_builder *b, uint32_t face, uint32_t u, uint32_t v)
{
    const edge_mesh *m = b->mesh;
    const float      in_plane = 1 - 1e-5f;
    uint32_t         a = third_corner(m->faces[face], u, v);
    size_t           count, others;
    const half_edge *group = find_group(b, a, u, &count), *second = find_group(b, a, v, &others);
    for (size_t i = 0; i < count && count <= SHORT_BUCKET && others <= SHORT_BUCKET; i++) {
        uint32_t one = group[i].corner / 3, c = third_corner(m->faces[one], a, u);
        if (one == face || fabsf(dot(m->normals[one], m->normals[face])) < in_plane)
            continue;
        for (size_t k = 0; k < others; k++) {
            uint32_t other = second[k].corner / 3;
            if (other != face && other != one && third_corner(m->faces[other], a, v) == c &&
                fabsf(dot(m->normals[other], m->normals[face])) >= in_plane && are_parted(m, u, v, a, c) &&
                are_parted(m, a, c, u, v))
                return true;
        }
    }
    return false;
}

static bool mark_covered(edge_builder *b, uint32_t low, const half_edge *group, size_t count)
{
    uint32_t face = group[0].corner / 3;
    if (count == 1 && !b->dropped[face] && is_covered(b, face, low, group[0].high))
        b->dropped[face] = 1;
    return true;
}

/* Drops faces that are there twice, whichever way round, or covered by others. Returns how many. */
static uint32_t drop_twins(edge_builder *b)
{
    edge_mesh *m = b->mesh;
    each_edge(b, mark_twins);
    each_edge(b, mark_covered);
    uint32_t kept = 0;
    for (uint32_t f = 0; f < m->face_count; f++) {
        if (b->dropped[f])
            continue;
        memmove(m->faces[kept], m->faces[f], sizeof m->faces[f]);
        m->normals[kept] = m->normals[f];
        if (m->materials)
            m->materials[kept] = m->materials[f];
        if (m->said)
            memmove(&m->said[3 * kept], &m->said[3 * f], 3);
        if (b->normals)
            memmove(&b->normals[3 * kept], &b->normals[3 * f], 3 * sizeof *b->normals);
        if (b->origins)
            b->origins[kept] = b->origins[f];
        kept++;
    }
    uint32_t gone = m->face_count - kept;
    m->face_count = kept;
    return gone;
}

/* A piece is closed when none of its edges is loose or passed the same way twice. */
static bool open_pieces(edge_builder *b, uint32_t low, const half_edge *group, size_t count)
{
    edge_mesh *m = b->mesh;
    bool fits = count == 2 && (corner_vertex(m, group[0].corner) == low) != (corner_vertex(m, group[1].corner) == low);
    for (size_t i = 0; i < count && !fits; i++)
        m->closed[m->pieces[group[i].corner / 3]] = false;
    return true;
}

/* Is it nothing but an outline that is always hidden? */
static bool is_hollow_alone(const mesh_edge *e)
{
    return (e->flags & ~(uint32_t)EDGE_TWISTED) == (EDGE_CANDIDATE | EDGE_HOLLOW);
}

/* Outlines along concave edges of closed pieces are always hidden. Which way round a piece is says its volume. Those
 * that are nothing else come last: what is seen has the same numbers with them and without. */
bool edges_mark_hollow(edge_mesh *m, const double *volumes)
{
    uint32_t   kept = 0, apart = 0;
    mesh_edge *hollow = mem_alloc(((size_t)m->edge_count + 1) * sizeof *hollow);
    for (uint32_t i = 0; i < m->piece_count; i++)
        m->inward[i] = volumes[i] < 0;
    for (uint32_t i = 0; i < m->edge_count && hollow; i++) {
        mesh_edge e = m->edges[i];
        uint32_t  piece = m->pieces[e.face[0]];
        bool      convex = ((e.flags & EDGE_CONVEX) != 0) != m->inward[piece];
        if (m->closed[piece] && !convex && e.flags & EDGE_CANDIDATE)
            e.flags |= EDGE_HOLLOW;
        e.flags &= ~(uint32_t)EDGE_CONVEX;
        if (is_hollow_alone(&e))
            hollow[apart++] = e;
        else if (e.flags & ~(uint32_t)EDGE_TWISTED)
            m->edges[kept++] = e;
    }
    if (!hollow)
        return false;
    if (apart)
        memcpy(m->edges + kept, hollow, apart * sizeof *hollow);
    mem_free(hollow);
    m->edge_count = kept + apart;
    mesh_edge *smaller = mem_realloc(m->edges, (size_t)m->edge_count * sizeof *smaller);
    m->edges = smaller || m->edge_count == 0 ? smaller : m->edges;
    return true;
}

static bool pair_halves(edge_builder *b, uint32_t low, const half_edge *group, size_t count)
{
    const edge_mesh *m = b->mesh;
    if (count == 2 && (corner_vertex(m, group[0].corner) == low) != (corner_vertex(m, group[1].corner) == low)) {
        b->opposite[group[0].corner] = group[1].corner;
        b->opposite[group[1].corner] = group[0].corner;
    }
    return true;
}

/* Creases by feature, where edges are sorted by angle. */
static lmn_status judge_creases(edge_builder *b, lmn_error *error)
{
    edge_mesh *m = b->mesh;
    size_t     halves = (size_t)m->face_count * 3;
    bool       mixed = false;
    b->opposite = mem_alloc((halves + 1) * sizeof *b->opposite);
    if (!b->opposite)
        return error_memory(error);
    memset(b->opposite, 0xFF, halves * sizeof *b->opposite); /* EDGE_NO_FACE */
    each_edge(b, pair_halves);
    uint8_t     *shading = b->normals ? shading_judge(m, b->opposite, b->normals, &mixed) : NULL;
    crease_facts facts = {b->opposite, shading, mixed, b->angle};
    bool         good = shading || !b->normals;
    if (good && !b->keeps) { /* poses judge anew */
        crease_measure measured;
        good = creases_measure(&measured, m, &facts) && creases_judge(m, &facts, &measured);
    }
    if (b->keeps && good) {
        b->keeps->opposite = b->opposite;
        b->keeps->shading = shading;
        b->keeps->mixed = mixed;
        b->opposite = NULL;
    } else {
        mem_free(shading);
    }
    return good ? LMN_OK : error_memory(error);
}

static lmn_status sort_edges(edge_builder *b, lmn_error *error)
{
    edge_mesh *m = b->mesh;
    fill_buckets(b);
    if (!take_edges(b))
        return error_memory(error);
    if (b->has_twins && !b->whole) {
        b->dropped = mem_calloc(m->face_count, 1);
        if (!b->dropped)
            return error_memory(error);
        uint32_t gone = drop_twins(b);
        mem_free(b->dropped);
        if (gone) {
            fill_buckets(b);
            if (!take_edges(b))
                return error_memory(error);
        }
    }
    lmn_status status = judge_creases(b, error);
    if (status != LMN_OK)
        return status;
    for (uint32_t f = 0; f < m->face_count; f++)
        b->pieces[f] = group_root(b->pieces, f);
    number_pieces(b);
    double *volumes = edges_measure_pieces(m);
    if (!volumes)
        return error_memory(error);
    each_edge(b, open_pieces);
    bool marked = edges_mark_hollow(m, volumes);
    mem_free(volumes);
    return marked && drawn_close(m) ? LMN_OK : error_memory(error);
}

/* Sorts the edges of the faces that are there, unless making them failed. */
lmn_status edges_finish(edge_builder *b, lmn_status status, lmn_error *error)
{
    edge_mesh *out = b->mesh;
    if (status == LMN_OK) {
        b->starts = mem_alloc(((size_t)out->vertex_count + 2) * sizeof *b->starts);
        b->halves = mem_alloc((size_t)out->face_count * 3 * sizeof *b->halves);
        b->pieces = mem_alloc((size_t)out->face_count * sizeof *b->pieces);
        status = b->starts && b->halves && b->pieces ? sort_edges(b, error) : error_memory(error);
    }
    if (b->keeps) {
        b->keeps->starts = b->starts;
        b->keeps->halves = b->halves;
    } else {
        mem_free(b->starts);
        mem_free(b->halves);
    }
    mem_free(b->pieces);
    mem_free(b->normals);
    out->opposite = b->opposite;
    b->opposite = NULL;
    if (status != LMN_OK)
        edge_mesh_release(out);
    return status;
}

lmn_status edge_mesh_create(edge_mesh *out, const mesh *m, const vec3 *positions, double crease_angle, lmn_error *error)
{
    memset(out, 0, sizeof *out);
    edge_builder b = {.mesh = out, .crease = (float)cos(crease_angle), .angle = crease_angle};
    return edges_finish(&b, edge_faces_make(&b, m, positions, error), error);
}

lmn_status edge_mesh_create_whole(edge_mesh *out, const mesh *m, const vec3 *positions, double crease_angle,
                                  lmn_error *error)
{
    memset(out, 0, sizeof *out);
    edge_builder b = {.mesh = out, .crease = (float)cos(crease_angle), .angle = crease_angle, .whole = true};
    return edges_finish(&b, edge_faces_make(&b, m, positions, error), error);
}

lmn_status edge_mesh_create_from(edge_mesh *out, const edge_faces *faces, double crease_angle, uint32_t *numbers,
                                 lmn_error *error)
{
    memset(out, 0, sizeof *out);
    edge_builder b = {.mesh = out, .crease = (float)cos(crease_angle), .angle = crease_angle};
    lmn_status   status = edges_finish(&b, edge_faces_take(&b, faces, error), error);
    if (status == LMN_OK) {
        memset(numbers, 0xFF, faces->face_count * sizeof *numbers); /* EDGE_NO_FACE */
        for (uint32_t f = 0; f < out->face_count; f++)
            numbers[b.origins[f]] = f;
    }
    mem_free(b.origins);
    return status;
}

void edge_mesh_release(edge_mesh *m)
{
    mem_free(m->positions);
    mem_free(m->faces);
    mem_free(m->normals);
    mem_free(m->materials);
    mem_free(m->edges);
    mem_free(m->lines);
    mem_free(m->pieces);
    mem_free(m->closed);
    mem_free(m->inward);
    mem_free(m->boxes);
    mem_free(m->planes);
    mem_free(m->opposite);
    mem_free(m->said);
    mem_free(m->caps);
    edge_refinement_destroy(&m->refinement);
    edge_solid_destroy(&m->solid);
    memset(m, 0, sizeof *m);
}
