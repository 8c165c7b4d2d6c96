/* Half-edges are sorted into buckets by their lower vertex, so that those of one edge lie side by side; each edge
 * is then judged once. */
#include "stroke/edges.h"

#include <math.h>
#include <stdatomic.h>
#include <stdlib.h>
#include <string.h>

#include "base/groups.h"
#include "base/memory.h"
#include "base/threads.h"
#include "scene/mesh.h"
#include "stroke/butterfly_mesh.h"
#include "stroke/creases.h"
#include "stroke/drawn.h"
#include "stroke/form_surface.h"

/* A face leans out of its neighbour's plane when the corner that they do not share is farther from it than this
 * fraction of its distance. */
#define FLAT 1e-6f
/* Nor does it when it is as near to the plane as rounding alone may take it, fraction of its largest coordinate. */
#define ROUNDED 3e-7f

enum { SHORT_BUCKET = 24 };

typedef struct half_edge {
    uint32_t high, corner; /* corner: 3 · face + number of the corner that it begins at */
} half_edge;

/* Ranges of vertices whose edges are taken side by side. */
enum { RANGES = 16, RANGES_LEAST = 4096 };

struct edge_topology {
    uint64_t    revision;
    uint32_t    range_edges[RANGES + 1]; /* per range: how many edges those before it have */
    edge_mesh   mesh;                    /* at rest */
    uint32_t   *welded;                  /* per vertex of the mesh: its number */
    double      near;                    /* so far apart those of one number may lie */
    size_t      vertex_count;
    uint32_t   *starts; /* of `mesh`, as below */
    half_edge  *halves;
    uint32_t   *opposite; /* of crease_facts, as are these */
    uint8_t    *shading;
    bool        mixed;
    bool        has_flat; /* faces without area were left out */
    form_knots *knots;
};

typedef struct builder {
    edge_mesh     *mesh;
    edge_topology *keeps;  /* NULL: nobody asks */
    uint32_t      *starts; /* per vertex, and one more */
    half_edge     *halves;
    uint8_t       *dropped;  /* per face: 1: the same as another one */
    uint32_t      *origins;  /* per face: its number before any were dropped; NULL: nobody asks */
    uint32_t      *pieces;   /* per face: another one of its piece, itself at the root */
    uint32_t      *normals;  /* per corner: the file's, packed; NULL: it has none */
    uint32_t      *opposite; /* per half-edge, of crease_facts */
    size_t         edge_capacity;
    float          crease; /* cosine of … */
    double         angle;
    bool           has_flat; /* faces without area were left out */
    bool has_twins; /* there may be faces that are there twice: edges have more than two, or both of an edge are the
                       same, or lie on each other */
} builder;

static vec3 minus(vec3 a, vec3 b)
{
    return (vec3){a.x - b.x, a.y - b.y, a.z - b.z};
}

static float dot(vec3 a, vec3 b)
{
    return a.x * b.x + a.y * b.y + a.z * b.z;
}

/* In double precision: slivers on large coordinates would lose their direction. */
static vec3 face_normal(const vec3 *positions, const uint32_t corners[3])
{
    vec3   p = positions[corners[0]], q = positions[corners[1]], r = positions[corners[2]];
    double ax = (double)q.x - p.x, ay = (double)q.y - p.y, az = (double)q.z - p.z;
    double bx = (double)r.x - p.x, by = (double)r.y - p.y, bz = (double)r.z - p.z;
    double x = ay * bz - az * by, y = az * bx - ax * bz, z = ax * by - ay * bx;
    double length = sqrt(x * x + y * y + z * z);
    if (!(length > 0))
        return (vec3){0, 0, 0};
    return (vec3){(float)(x / length), (float)(y / length), (float)(z / length)};
}

/* --- faces ---------------------------------------------------------------------------------------------- */

static bool count_mesh(const mesh *m, size_t *vertices, size_t *corners, bool *said, bool *shaded)
{
    *vertices = *corners = 0;
    *said = *shaded = false;
    for (size_t i = 0; i < m->primitive_count; i++) {
        *vertices += m->primitives[i].vertex_count;
        *corners += m->primitives[i].index_count;
        *said = *said || m->primitives[i].edges.values;
        *shaded = *shaded || m->primitives[i].normals;
    }
    return *vertices < UINT32_MAX / 4 && *corners < UINT32_MAX / 4;
}

/* All primitives' positions, one after the other. */
static vec3 *gather_positions(const mesh *m, const vec3 *posed, size_t count)
{
    vec3  *positions = mem_alloc(count * sizeof *positions);
    size_t at = 0;
    for (size_t i = 0; i < m->primitive_count && positions; at += m->primitives[i++].vertex_count)
        memcpy(positions + at, posed ? posed + at : m->primitives[i].positions,
               m->primitives[i].vertex_count * sizeof *positions);
    return positions;
}

/* Keeps one vertex a position, in order of appearance; ids[v] becomes its new number. */
static void weld(edge_mesh *out, uint32_t *ids, uint32_t count)
{
    uint32_t kept = 0;
    for (uint32_t i = 0; i < count; i++) {
        if (ids[i] != i) {
            ids[i] = ids[ids[i]];
            continue;
        }
        out->positions[kept] = out->positions[i];
        ids[i] = kept++;
    }
    out->vertex_count = kept;
}

/* Faces with three corners and an area. */
static void gather_faces(builder *b, const mesh *m, const uint32_t *ids)
{
    edge_mesh *out = b->mesh;
    uint32_t   base = 0;
    for (size_t i = 0; i < m->primitive_count; base += m->primitives[i++].vertex_count) {
        const primitive *p = &m->primitives[i];
        for (uint32_t k = 0; k + 2 < p->index_count; k += 3) {
            uint32_t corners[3];
            for (int c = 0; c < 3; c++)
                corners[c] = ids[base + p->indices[k + (uint32_t)c]];
            vec3 normal = face_normal(out->positions, corners);
            if (corners[0] == corners[1] || corners[1] == corners[2] || corners[0] == corners[2])
                continue;
            if (dot(normal, normal) == 0) {
                b->has_flat = true;
                continue;
            }
            uint32_t f = out->face_count++;
            memcpy(out->faces[f], corners, sizeof corners);
            out->normals[f] = normal;
            if (out->materials)
                out->materials[f] = p->material;
            for (uint32_t c = 0; c < 3 && out->said; c++)
                out->said[3 * f + c] = p->edges.values ? p->edges.values[k + c] : SAID_NOTHING;
            for (uint32_t c = 0; c < 3 && b->normals; c++)
                b->normals[3 * f + c] = p->normals ? shading_pack(p->normals[p->indices[k + c]]) : SHADING_NONE;
        }
    }
}

/* Faces that are there already, without those that have no area. */
static lmn_status take_faces(builder *b, const edge_faces *in, lmn_error *error)
{
    edge_mesh *out = b->mesh;
    size_t     count = in->face_count;
    out->vertex_count = in->vertex_count;
    out->positions = mem_copy(in->positions, (size_t)in->vertex_count * sizeof *out->positions);
    out->faces = mem_alloc(count * sizeof *out->faces);
    out->normals = mem_alloc(count * sizeof *out->normals);
    out->materials = in->materials ? mem_alloc(count * sizeof *out->materials) : NULL;
    out->said = in->said ? mem_alloc(3 * count) : NULL;
    b->origins = mem_alloc(count * sizeof *b->origins);
    if (!out->positions || !out->faces || !out->normals || (in->materials && !out->materials) ||
        (in->said && !out->said) || !b->origins)
        return error_memory(error);
    for (uint32_t i = 0; i < in->face_count; i++) {
        uint32_t f = out->face_count;
        vec3     normal = face_normal(out->positions, in->faces[i]);
        if (dot(normal, normal) == 0)
            continue;
        out->face_count++;
        memcpy(out->faces[f], in->faces[i], sizeof in->faces[i]);
        out->normals[f] = normal;
        b->origins[f] = i;
        if (out->materials)
            out->materials[f] = in->materials[i];
        if (out->said)
            memcpy(&out->said[3 * f], &in->said[3 * i], 3);
    }
    return LMN_OK;
}

static uint32_t *count_up(uint32_t count)
{
    uint32_t *out = mem_alloc(count * sizeof *out);
    for (uint32_t i = 0; i < count && out; i++)
        out[i] = i;
    return out;
}

static lmn_status make_faces(builder *b, const mesh *m, const vec3 *posed, lmn_error *error)
{
    edge_mesh *out = b->mesh;
    size_t     vertices, corners;
    bool       said, shaded;
    if (!count_mesh(m, &vertices, &corners, &said, &shaded))
        return error_set(error, LMN_LIMIT,
                         "a mesh of %zu vertices and %zu corners is too large for its edges to be sorted", vertices,
                         corners);
    out->positions = gather_positions(m, posed, vertices);
    bool      welded = m->primitive_count == 1 && m->primitives[0].welded && !posed;
    uint32_t *ids =
        !out->positions ? NULL
        : welded        ? count_up((uint32_t)vertices)
                 : mesh_position_ids(&(primitive){.vertex_count = (uint32_t)vertices, .positions = out->positions});
    out->faces = mem_alloc(corners * sizeof **out->faces);
    out->normals = mem_alloc(corners / 3 * sizeof *out->normals);
    bool mixed = false;
    for (size_t i = 1; i < m->primitive_count; i++)
        mixed = mixed || m->primitives[i].material != m->primitives[0].material;
    out->materials = mixed ? mem_alloc(corners / 3 * sizeof *out->materials) : NULL;
    out->said = said ? mem_alloc(corners) : NULL;
    b->normals = shaded ? mem_alloc(corners * sizeof *b->normals) : NULL;
    double near = ids ? mesh_near(out->positions, vertices) : 0;
    bool   good = ids && mesh_weld_near(out->positions, ids, vertices, near) && out->faces && out->normals &&
                (out->materials || !mixed) && (out->said || !said) && (b->normals || !shaded);
    if (good) {
        weld(out, ids, (uint32_t)vertices);
        gather_faces(b, m, ids);
        good = drawn_take(out, m, ids);
    }
    if (b->keeps) {
        b->keeps->welded = ids;
        b->keeps->vertex_count = vertices;
        b->keeps->near = near;
        b->keeps->has_flat = b->has_flat;
        ids = NULL;
    }
    mem_free(ids);
    return good ? LMN_OK : error_memory(error);
}

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

static void fill_buckets(builder *b)
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
static void number_pieces(builder *b)
{
    edge_mesh *m = b->mesh;
    m->pieces = b->pieces;
    b->pieces = NULL;
    for (uint32_t f = 0; f < m->face_count; f++)
        m->pieces[f] = m->pieces[f] == f ? m->piece_count++ : m->pieces[m->pieces[f]];
}

/* Boxes of the pieces, and volumes by their first corner, which says which way round they are. */
static double *measure_pieces(edge_mesh *m)
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
    float height = dot(from_edge, m->normals[face]),
          rounding = ROUNDED * fmaxf(fmaxf(fabsf(free.x), fabsf(free.y)), fabsf(free.z));
    return fabsf(height) <= FLAT * sqrtf(dot(from_edge, from_edge)) || fabsf(height) <= rounding ? 0 : height;
}

/* The same, unless the face lies in the neighbour's plane: a narrow face does not know its own. */
static float height_between(const edge_mesh *m, uint32_t first, uint32_t second)
{
    return height_above(m, second / 3, first) == 0 ? 0 : height_above(m, first / 3, second);
}

/* Flags of an edge of two faces. `same_direction`: both pass it in one direction, so one of them is inside out. */
static uint32_t judge_pair(const builder *b, uint32_t first, uint32_t second, bool same_direction)
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

static bool put_edge(builder *b, uint32_t low, uint32_t flags, const half_edge *group, size_t count)
{
    edge_mesh *m = b->mesh;
    if (!mem_grow((void **)&m->edges, &b->edge_capacity, (size_t)m->edge_count + 1, sizeof *m->edges))
        return false;
    uint32_t corner = group[0].corner, begin = corner_vertex(m, corner);
    m->edges[m->edge_count++] = (mesh_edge){{begin, begin == low ? group[0].high : low},
                                            {corner / 3, count > 1 ? group[1].corner / 3 : EDGE_NO_FACE},
                                            flags,
                                            0};
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
static bool take_edge(builder *b, uint32_t low, const half_edge *group, size_t count)
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
typedef bool (*edge_visit)(builder *b, uint32_t low, const half_edge *group, size_t count);

static bool each_edge_of(builder *b, uint32_t first, uint32_t end_vertex, edge_visit visit)
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

static bool each_edge(builder *b, edge_visit visit)
{
    return each_edge_of(b, 0, b->mesh->vertex_count, visit);
}

static bool take_edges(builder *b)
{
    edge_mesh *m = b->mesh;
    b->has_twins = false;
    m->edge_count = m->all_edges = m->loose_edges = 0;
    for (uint32_t f = 0; f < m->face_count; f++)
        b->pieces[f] = f;
    for (uint32_t v = 0; v < m->vertex_count; v++)
        sort_bucket(b->halves + b->starts[v], b->starts[v + 1] - b->starts[v]);
    return each_edge(b, take_edge);
}

static bool mark_twins(builder *b, uint32_t low, const half_edge *group, size_t count)
{
    (void)low;
    for (size_t i = 0; i < count && count <= SHORT_BUCKET; i++)
        for (size_t k = i + 1; k < count; k++)
            if (have_same_corners(b->mesh->faces[group[i].corner / 3], b->mesh->faces[group[k].corner / 3]))
                b->dropped[group[k].corner / 3] = 1;
    return true;
}

/* The half-edges between two vertices. */
static const half_edge *find_group(const builder *b, uint32_t p, uint32_t q, size_t *count)
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
static bool is_covered(const builder *b, uint32_t face, uint32_t u, uint32_t v)
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

static bool mark_covered(builder *b, uint32_t low, const half_edge *group, size_t count)
{
    uint32_t face = group[0].corner / 3;
    if (count == 1 && !b->dropped[face] && is_covered(b, face, low, group[0].high))
        b->dropped[face] = 1;
    return true;
}

/* Drops faces that are there twice, whichever way round, or covered by others. Returns how many. */
static uint32_t drop_twins(builder *b)
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
static bool open_pieces(builder *b, uint32_t low, const half_edge *group, size_t count)
{
    edge_mesh *m = b->mesh;
    bool fits = count == 2 && (corner_vertex(m, group[0].corner) == low) != (corner_vertex(m, group[1].corner) == low);
    for (size_t i = 0; i < count && !fits; i++)
        m->closed[m->pieces[group[i].corner / 3]] = false;
    return true;
}

/* Concave edges of closed pieces never are outlines. Which way round a piece is says its volume. */
static void drop_concave(edge_mesh *m, const double *volumes)
{
    for (uint32_t i = 0; i < m->piece_count; i++)
        m->inward[i] = volumes[i] < 0;
    uint32_t kept = 0;
    for (uint32_t i = 0; i < m->edge_count; i++) {
        mesh_edge e = m->edges[i];
        uint32_t  piece = m->pieces[e.face[0]];
        bool      convex = ((e.flags & EDGE_CONVEX) != 0) != m->inward[piece];
        if (m->closed[piece] && !convex)
            e.flags &= ~(uint32_t)EDGE_CANDIDATE;
        e.flags &= ~(uint32_t)EDGE_CONVEX;
        if (e.flags & ~(uint32_t)EDGE_TWISTED)
            m->edges[kept++] = e;
    }
    m->edge_count = kept;
    mesh_edge *smaller = mem_realloc(m->edges, (size_t)kept * sizeof *smaller);
    m->edges = smaller || kept == 0 ? smaller : m->edges;
}

static bool pair_halves(builder *b, uint32_t low, const half_edge *group, size_t count)
{
    const edge_mesh *m = b->mesh;
    if (count == 2 && (corner_vertex(m, group[0].corner) == low) != (corner_vertex(m, group[1].corner) == low)) {
        b->opposite[group[0].corner] = group[1].corner;
        b->opposite[group[1].corner] = group[0].corner;
    }
    return true;
}

/* Creases by feature, where edges are sorted by angle. */
static lmn_status judge_creases(builder *b, lmn_error *error)
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

static lmn_status sort_edges(builder *b, lmn_error *error)
{
    edge_mesh *m = b->mesh;
    fill_buckets(b);
    if (!take_edges(b))
        return error_memory(error);
    if (b->has_twins) {
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
    double *volumes = measure_pieces(m);
    if (!volumes)
        return error_memory(error);
    each_edge(b, open_pieces);
    drop_concave(m, volumes);
    mem_free(volumes);
    return drawn_close(m) ? LMN_OK : error_memory(error);
}

/* Sorts the edges of the faces that are there, unless making them failed. */
static lmn_status finish(builder *b, lmn_status status, lmn_error *error)
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
    mem_free(b->opposite);
    if (status != LMN_OK)
        edge_mesh_release(out);
    return status;
}

lmn_status edge_mesh_create(edge_mesh *out, const mesh *m, const vec3 *positions, double crease_angle, lmn_error *error)
{
    memset(out, 0, sizeof *out);
    builder b = {.mesh = out, .crease = (float)cos(crease_angle), .angle = crease_angle};
    return finish(&b, make_faces(&b, m, positions, error), error);
}

/* --- poses ---------------------------------------------------------------------------------------------- */

void edge_topology_destroy(edge_topology **topology)
{
    edge_topology *t = *topology;
    if (!t)
        return;
    edge_mesh_release(&t->mesh);
    mem_free(t->welded);
    mem_free(t->starts);
    mem_free(t->halves);
    mem_free(t->opposite);
    mem_free(t->shading);
    form_knots_destroy(&t->knots);
    mem_free(t);
    *topology = NULL;
}

struct form_knots **edge_topology_knots(edge_topology *t)
{
    return &t->knots;
}

uint64_t edge_topology_revision(const edge_topology *t)
{
    return t->revision;
}

/* Numbers were given in the order of appearance. False when vertices that were one have come apart. */
static bool weld_again(edge_mesh *out, const edge_topology *t, const vec3 *positions)
{
    uint32_t seen = 0;
    double   apart = 2 * t->near; /* a pose may stretch */
    for (size_t i = 0; i < t->vertex_count; i++) {
        uint32_t number = t->welded[i];
        if (number == seen)
            out->positions[seen++] = positions[i];
        vec3 p = out->positions[number];
        if (!(fabs((double)p.x - positions[i].x) <= apart && fabs((double)p.y - positions[i].y) <= apart &&
              fabs((double)p.z - positions[i].z) <= apart))
            return false;
    }
    return true;
}

static void find_normals(size_t begin, size_t end, void *user)
{
    edge_mesh *m = user;
    for (size_t f = begin; f < end; f++)
        m->normals[f] = face_normal(m->positions, m->faces[f]);
}

/* Copies of what no pose changes, and room for the rest. */
static bool copy_topology(edge_mesh *out, const edge_topology *t)
{
    const edge_mesh *from = &t->mesh;
    size_t           faces = from->face_count;
    out->vertex_count = from->vertex_count;
    out->face_count = from->face_count;
    out->piece_count = drawn_face_pieces(from);
    out->positions = mem_alloc((size_t)from->vertex_count * sizeof *out->positions);
    out->normals = mem_alloc(faces * sizeof *out->normals);
    out->faces = mem_copy(from->faces, faces * sizeof *out->faces);
    out->pieces = mem_copy(from->pieces, faces * sizeof *out->pieces);
    out->materials = from->materials ? mem_copy(from->materials, faces * sizeof *out->materials) : NULL;
    out->said = from->said ? mem_copy(from->said, 3 * faces) : NULL;
    return out->positions && out->normals && out->faces && out->pieces && (out->materials || !from->materials) &&
           (out->said || !from->said) && drawn_copy(out, from);
}

/* Edges of a range of vertices: of a copy of the mesh, which has no other ones. */
typedef struct edge_range {
    edge_mesh mesh;
    builder   b;
    uint32_t  first, end;
    bool      done;
} edge_range;

/* What is judged of a pose side by side: whoever has nothing to do takes the next one, the longest first. */
enum { JUDGE_NOISE, JUDGE_PIECES, JUDGE_RANGES };

typedef struct pose_judge {
    edge_mesh     *mesh;
    crease_facts   facts;
    crease_measure measured;
    bool           has_measured;
    double        *volumes; /* of the pieces; NULL: memory was gone */
    edge_range     ranges[RANGES];
    uint32_t       range_count;
    atomic_uint    next;
} pose_judge;

static void judge_next(size_t begin, size_t end, void *user)
{
    pose_judge *j = user;
    (void)begin;
    (void)end;
    for (unsigned i; (i = atomic_fetch_add(&j->next, 1)) < JUDGE_RANGES + j->range_count;) {
        edge_range *r = i < JUDGE_RANGES ? NULL : &j->ranges[i - JUDGE_RANGES];
        if (i == JUDGE_NOISE)
            j->has_measured = creases_measure(&j->measured, j->mesh, &j->facts);
        else if (i == JUDGE_PIECES)
            j->volumes = measure_pieces(j->mesh);
        else
            r->done = each_edge_of(&r->b, r->first, r->end, take_edge);
    }
}

static uint32_t range_count(const edge_mesh *m)
{
    return m->vertex_count < RANGES_LEAST ? 1 : RANGES;
}

/* The first vertex of a range. */
static uint32_t range_start(const edge_mesh *m, uint32_t range)
{
    return (uint32_t)((uint64_t)m->vertex_count * range / range_count(m));
}

static bool count_edge(builder *b, uint32_t low, const half_edge *group, size_t count)
{
    (void)low;
    (void)group;
    (void)count;
    b->keeps->mesh.all_edges++;
    return true;
}

static void count_ranges(edge_topology *t)
{
    builder b = {.mesh = &t->mesh, .keeps = t, .starts = t->starts, .halves = t->halves};
    t->mesh.all_edges = 0;
    for (uint32_t i = 0; i < range_count(&t->mesh); i++) {
        t->range_edges[i] = t->mesh.all_edges;
        each_edge_of(&b, range_start(&t->mesh, i), range_start(&t->mesh, i + 1), count_edge);
    }
}

/* Each range puts its edges where there is room for all that it may have. */
static void open_ranges(pose_judge *j, const builder *b, const edge_topology *t)
{
    j->range_count = range_count(b->mesh);
    for (uint32_t i = 0; i < j->range_count; i++) {
        edge_range *r = &j->ranges[i];
        *r = (edge_range){
            .mesh = *b->mesh, .b = *b, .first = range_start(b->mesh, i), .end = range_start(b->mesh, i + 1)};
        r->b.mesh = &r->mesh;
        r->b.edge_capacity = SIZE_MAX;
        r->mesh.edges += t->range_edges[i];
    }
}

/* Ranges side by side, put one behind the other: as each_edge has them. */
static bool close_ranges(pose_judge *j)
{
    edge_mesh *m = j->mesh;
    bool       done = true;
    for (uint32_t i = 0; i < j->range_count; i++) {
        const edge_mesh *from = &j->ranges[i].mesh;
        memmove(m->edges + m->edge_count, from->edges, from->edge_count * sizeof *m->edges);
        m->edge_count += from->edge_count;
        m->all_edges += from->all_edges;
        m->loose_edges += from->loose_edges;
        done = done && j->ranges[i].done;
    }
    return done;
}

/* Edges, with faces and half-edges that are there. */
static lmn_status judge_again(builder *b, const edge_topology *t, lmn_error *error)
{
    edge_mesh *m = b->mesh;
    pose_judge j = {.mesh = m, .facts = {t->opposite, t->shading, t->mixed, b->angle}};
    m->edges = mem_alloc(((size_t)t->mesh.all_edges + 1) * sizeof *m->edges);
    if (!m->edges)
        return error_memory(error);
    open_ranges(&j, b, t);
    threads_for(j.range_count, 1, judge_next, &j);
    bool good = close_ranges(&j) && j.has_measured && j.volumes && creases_judge(m, &j.facts, &j.measured);
    if (good) {
        memcpy(m->closed, t->mesh.closed, m->piece_count * sizeof *m->closed);
        drop_concave(m, j.volumes);
    }
    mem_free(j.volumes);
    return good && drawn_close(m) ? LMN_OK : error_memory(error);
}

lmn_status edge_topology_create(edge_topology **out, const mesh *m, lmn_error *error)
{
    edge_topology *t = *out = mem_calloc(1, sizeof *t);
    if (!t)
        return error_memory(error);
    builder b = {.mesh = &t->mesh, .keeps = t, .crease = 0, .angle = 1.5};
    t->revision = m->topology;
    lmn_status status = finish(&b, make_faces(&b, m, NULL, error), error);
    mem_free(t->mesh.positions); /* every pose has its own */
    mem_free(t->mesh.normals);
    mem_free(t->mesh.edges);
    t->mesh.positions = t->mesh.normals = NULL;
    t->mesh.edges = NULL;
    if (status == LMN_OK)
        count_ranges(t);
    else
        edge_topology_destroy(out);
    return status;
}

lmn_status edge_mesh_pose(edge_mesh *out, const edge_topology *t, const vec3 *positions, double crease_angle,
                          bool *fits, lmn_error *error)
{
    enum { FACES_PER_THREAD = 16384 };
    memset(out, 0, sizeof *out);
    *fits = !t->has_flat;
    if (!*fits)
        return LMN_OK;
    builder    b = {.mesh = out,
                    .starts = t->starts,
                    .halves = t->halves,
                    .crease = (float)cos(crease_angle),
                    .angle = crease_angle};
    lmn_status status = copy_topology(out, t) ? LMN_OK : error_memory(error);
    if (status == LMN_OK)
        *fits = weld_again(out, t, positions);
    if (status == LMN_OK && *fits)
        threads_for(out->face_count, FACES_PER_THREAD, find_normals, out);
    for (uint32_t f = 0; f < out->face_count && status == LMN_OK && *fits; f++)
        *fits = dot(out->normals[f], out->normals[f]) != 0;
    if (status == LMN_OK && *fits)
        status = judge_again(&b, t, error);
    if (status != LMN_OK || !*fits)
        edge_mesh_release(out);
    return status;
}

lmn_status edge_mesh_create_from(edge_mesh *out, const edge_faces *faces, double crease_angle, uint32_t *numbers,
                                 lmn_error *error)
{
    memset(out, 0, sizeof *out);
    builder    b = {.mesh = out, .crease = (float)cos(crease_angle), .angle = crease_angle};
    lmn_status status = finish(&b, take_faces(&b, faces, error), error);
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
    mem_free(m->said);
    edge_refinement_destroy(&m->refinement);
    memset(m, 0, sizeof *m);
}
