/* Where pieces of surface run through each other. Most faces are nowhere near another piece: boxes of pieces that
 * overlap mark the cells of a coarse grid, only faces in marked cells are sorted into a tree of boxes, and only
 * those whose boxes meet are compared. */
#include "stroke/stroke_private.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "stroke/hubs.h"
#include "stroke/solid.h"

enum { MARK_SIDE = 64, TICKS = 65536 };
/* Where more boxes of pieces overlap, it takes longer to say where than to look at all faces. */
enum { OVERLAPS_A_PIECE = 8, OVERLAPS_LEAST = 4096 };
/* Faces of one surface that two pieces have turn against each other by no more than the first, radians, whatever the
 * second is; they lie no farther apart than this fraction of the smaller piece. */
#define TURN_MOST  0.44
#define TURN_LEAST 0.03
#define AWAY_MOST  6e-3

/* A face that may cross another one. */
typedef struct near_face {
    uint32_t item, face;
} near_face;

/* A face that comes to another one's plane with an edge, and stays on one side of it. Where the face beyond the edge is
 * on the other side, the surfaces cross along the edge: a wall that ends in the middle of a round tower. */
typedef struct face_touch {
    uint32_t      item, vertices[2]; /* of the edge, ascending */
    uint32_t      other;             /* the near face whose plane it is */
    int32_t       side;
    face_crossing crossing;
} face_touch;

typedef struct crossing_search {
    const stroke_scene *scene;
    uint32_t           *first_piece; /* per item */
    bool               *still;       /* per item: the world's axes are its own */
    box3               *piece_boxes; /* world axes */
    uint8_t            *piece_meets; /* another one's box */
    const bool         *parts;       /* that have such lines, a flag each; NULL: all */
    uint8_t            *piece_asks;  /* is of such a part */
    const uint8_t      *hidden;      /* pieces that have none with each other; NULL: no piece is such */
    uint32_t           *bodies;      /* per piece: its number, or one that all these have; NULL likewise */
    uint32_t           *piece_items;
    uint32_t            piece_count;
    box3                region; /* of all overlaps */
    uint64_t           *marks;  /* MARK_SIDE² words: cells where boxes overlap */
    near_face          *faces;
    box3               *boxes;
    uint32_t           *pieces, *planes; /* per near face, of all items */
    uint32_t           *face_bodies;     /* likewise; NULL: they are the pieces */
    uint32_t (*corners)[3];              /* likewise: vertices */
    uint32_t       *hubs;
    bool            unnumbered; /* there are more vertices than numbers: no hubs are looked for */
    size_t          face_count, face_capacity, box_capacity, kin_capacity, plane_capacity, corner_capacity;
    size_t          overlaps; /* pairs of pieces whose boxes do */
    bool            crowded;  /* these are so many that all faces are looked at instead */
    double          same;     /* of the two faces that are compared */
    float         **turns;    /* per mesh: of each face, by how much they turn; NULL: not needed yet */
    face_touch     *touches;
    size_t          touch_count, touch_capacity;
    solid_trimmer **trimmers; /* per item that is a solid; NULL: not needed yet */
    crossing_list  *out;
    lmn_progress_fn progress;
    void           *user;
    uint32_t        ticks;
    bool            failed, cancelled;
} crossing_search;

/* fminf and fmaxf are calls. */
static float smaller(float a, float b)
{
    return a < b ? a : b;
}

static float larger(float a, float b)
{
    return a > b ? a : b;
}

/* --- candidates ----------------------------------------------------------------------------------------- */

static bool is_identity(const mat4 *m)
{
    mat4 identity = mat4_identity();
    return memcmp(m, &identity, sizeof *m) == 0;
}

static lmn_status number_pieces(crossing_search *s, lmn_error *error)
{
    const stroke_scene *scene = s->scene;
    s->first_piece = mem_alloc((scene->item_count + 1) * sizeof *s->first_piece);
    s->still = mem_alloc(scene->item_count + 1);
    if (!s->first_piece || !s->still)
        return error_memory(error);
    for (size_t i = 0; i < scene->item_count; i++) {
        s->first_piece[i] = s->piece_count;
        s->still[i] = is_identity(&scene->items[i].world);
        s->piece_count += scene->meshes[scene->items[i].mesh].piece_count;
    }
    s->piece_boxes = mem_alloc((s->piece_count + 1) * sizeof *s->piece_boxes);
    s->piece_meets = mem_calloc(s->piece_count + 1, 1);
    s->piece_asks = mem_calloc(s->piece_count + 1, 1);
    s->piece_items = mem_alloc((s->piece_count + 1) * sizeof *s->piece_items);
    s->marks = mem_calloc(MARK_SIDE * MARK_SIDE, sizeof *s->marks);
    s->bodies = s->hidden ? mem_alloc((s->piece_count + 1) * sizeof *s->bodies) : NULL;
    if (!s->piece_boxes || !s->piece_meets || !s->piece_asks || !s->piece_items || !s->marks ||
        (s->hidden && !s->bodies))
        return error_memory(error);
    for (uint32_t k = 0; k < s->piece_count && s->hidden; k++)
        s->bodies[k] = s->hidden[k] ? s->piece_count : k;
    for (size_t i = 0; i < scene->item_count; i++) {
        const edge_mesh *m = &scene->meshes[scene->items[i].mesh];
        const bool       asks = !s->parts || s->parts[scene->items[i].part_index];
        for (uint32_t k = 0; k < m->piece_count; k++) {
            s->piece_boxes[s->first_piece[i] + k] = box3_transform(m->boxes[k], &scene->items[i].world);
            s->piece_asks[s->first_piece[i] + k] = asks;
            s->piece_items[s->first_piece[i] + k] = (uint32_t)i;
        }
    }
    return LMN_OK;
}

/* Bodies run through each other, and pieces of one image of some. Nothing runs through what was or will be there. */
static bool may_cross(const stroke_item *a, const stroke_item *b)
{
    return a->is_sign ? b->is_sign && a->image > 0 && a->image == b->image : !b->is_sign;
}

/* Would anybody draw the line where two pieces cross? */
static bool asks_for(const crossing_search *s, uint32_t a, uint32_t b)
{
    return (s->piece_asks[a] || s->piece_asks[b]) && !(s->hidden && s->hidden[a] && s->hidden[b]) &&
           may_cross(&s->scene->items[s->piece_items[a]], &s->scene->items[s->piece_items[b]]);
}

static bool widen_region(void *user, uint32_t a, uint32_t b)
{
    crossing_search *s = user;
    const box3      *p = &s->piece_boxes[a], *q = &s->piece_boxes[b];
    if (++s->overlaps > (size_t)OVERLAPS_A_PIECE * s->piece_count + OVERLAPS_LEAST) {
        s->crowded = true;
        return false;
    }
    if (!asks_for(s, a, b))
        return true;
    s->piece_meets[a] = s->piece_meets[b] = 1;
    box3 both = {{larger(p->min.x, q->min.x), larger(p->min.y, q->min.y), larger(p->min.z, q->min.z)},
                 {smaller(p->max.x, q->max.x), smaller(p->max.y, q->max.y), smaller(p->max.z, q->max.z)}};
    s->region = box3_union(s->region, both);
    return true;
}

static int mark_of(float at, float low, float high)
{
    float step = high > low ? (at - low) / (high - low) * MARK_SIDE : 0;
    return step > 0 ? step < MARK_SIDE - 1 ? (int)step : MARK_SIDE - 1 : 0;
}

typedef struct mark_range {
    int low[3], high[3];
} mark_range;

static mark_range marks_of(const crossing_search *s, const box3 *b)
{
    const box3 *r = &s->region;
    return (mark_range){{mark_of(b->min.x, r->min.x, r->max.x), mark_of(b->min.y, r->min.y, r->max.y),
                         mark_of(b->min.z, r->min.z, r->max.z)},
                        {mark_of(b->max.x, r->min.x, r->max.x), mark_of(b->max.y, r->min.y, r->max.y),
                         mark_of(b->max.z, r->min.z, r->max.z)}};
}

static uint64_t bits_between(int low, int high)
{
    uint64_t upto = high >= 63 ? UINT64_MAX : (UINT64_C(1) << (high + 1)) - 1;
    return upto & ~((UINT64_C(1) << low) - 1);
}

static bool mark_region(void *user, uint32_t a, uint32_t b)
{
    crossing_search *s = user;
    const box3      *p = &s->piece_boxes[a], *q = &s->piece_boxes[b];
    box3             both = {{larger(p->min.x, q->min.x), larger(p->min.y, q->min.y), larger(p->min.z, q->min.z)},
                             {smaller(p->max.x, q->max.x), smaller(p->max.y, q->max.y), smaller(p->max.z, q->max.z)}};
    mark_range       r = marks_of(s, &both);
    if (!asks_for(s, a, b))
        return true;
    for (int z = r.low[2]; z <= r.high[2]; z++)
        for (int y = r.low[1]; y <= r.high[1]; y++)
            s->marks[z * MARK_SIDE + y] |= bits_between(r.low[0], r.high[0]);
    return true;
}

static bool is_marked(const crossing_search *s, const box3 *b)
{
    const box3 *r = &s->region;
    if (b->min.x > r->max.x || b->max.x < r->min.x || b->min.y > r->max.y || b->max.y < r->min.y ||
        b->min.z > r->max.z || b->max.z < r->min.z)
        return false;
    mark_range m = marks_of(s, b);
    uint64_t   bits = bits_between(m.low[0], m.high[0]);
    for (int z = m.low[2]; z <= m.high[2]; z++)
        for (int y = m.low[1]; y <= m.high[1]; y++)
            if (s->marks[z * MARK_SIDE + y] & bits)
                return true;
    return false;
}

static box3 face_box(const edge_mesh *m, const stroke_item *item, bool still, uint32_t face)
{
    vec3 p[3];
    for (int k = 0; k < 3; k++) {
        p[k] = m->positions[m->faces[face][k]];
        p[k] = still ? p[k] : mat4_transform_point(&item->world, p[k]);
    }
    return (box3){{smaller(p[0].x, smaller(p[1].x, p[2].x)), smaller(p[0].y, smaller(p[1].y, p[2].y)),
                   smaller(p[0].z, smaller(p[1].z, p[2].z))},
                  {larger(p[0].x, larger(p[1].x, p[2].x)), larger(p[0].y, larger(p[1].y, p[2].y)),
                   larger(p[0].z, larger(p[1].z, p[2].z))}};
}

static bool put_near_face(crossing_search *s, near_face n, box3 box, uint32_t piece, uint32_t plane,
                          uint32_t first_vertex)
{
    const uint32_t *corners = s->scene->meshes[s->scene->items[n.item].mesh].faces[n.face];
    if (!mem_grow((void **)&s->faces, &s->face_capacity, s->face_count + 1, sizeof *s->faces) ||
        !mem_grow((void **)&s->boxes, &s->box_capacity, s->face_count + 1, sizeof *s->boxes) ||
        !mem_grow((void **)&s->pieces, &s->kin_capacity, s->face_count + 1, sizeof *s->pieces) ||
        !mem_grow((void **)&s->planes, &s->plane_capacity, s->face_count + 1, sizeof *s->planes) ||
        !mem_grow((void **)&s->corners, &s->corner_capacity, s->face_count + 1, sizeof *s->corners))
        return false;
    for (int k = 0; k < 3; k++)
        s->corners[s->face_count][k] = first_vertex + corners[k];
    s->faces[s->face_count] = n;
    s->boxes[s->face_count] = box;
    s->pieces[s->face_count] = piece;
    s->planes[s->face_count++] = plane;
    return true;
}

static lmn_status gather_faces(crossing_search *s, lmn_error *error)
{
    uint32_t first_plane = 0, first_vertex = 0;
    for (uint32_t i = 0; i < s->scene->item_count; i++) {
        const stroke_item *item = &s->scene->items[i];
        const edge_mesh   *m = &s->scene->meshes[item->mesh];
        bool               still = s->still[i];
        s->unnumbered = s->unnumbered || m->vertex_count > UINT32_MAX - first_vertex;
        for (uint32_t f = 0; f < m->face_count; f++) {
            uint32_t piece = s->first_piece[i] + m->pieces[f];
            if (!s->crowded && !s->piece_meets[piece])
                continue;
            box3 box = face_box(m, item, still, f);
            if (!s->crowded && !is_marked(s, &box))
                continue;
            if (!put_near_face(s, (near_face){i, f}, box, piece,
                               m->planes && m->planes[f] ? first_plane + m->planes[f] : KIN_MIXED, first_vertex))
                return error_memory(error);
        }
        first_plane += m->plane_count;
        first_vertex += m->vertex_count;
    }
    return LMN_OK;
}

/* --- two faces ------------------------------------------------------------------------------------------ */

typedef struct world_face {
    double3  p[3], normal; /* unit */
    uint32_t vertices[3];
    double   heights[3]; /* over the other one's plane */
} world_face;

static world_face load_face(const crossing_search *s, const near_face *n)
{
    const stroke_item *item = &s->scene->items[n->item];
    const edge_mesh   *m = &s->scene->meshes[item->mesh];
    world_face         out = {.vertices = {m->faces[n->face][0], m->faces[n->face][1], m->faces[n->face][2]}};
    for (int k = 0; k < 3; k++) {
        vec3 p = m->positions[out.vertices[k]];
        out.p[k] = s->still[n->item] ? (double3){p.x, p.y, p.z} : item_position(item, p);
    }
    if (s->still[n->item]) { /* rounded, but the same each time */
        out.normal = (double3){m->normals[n->face].x, m->normals[n->face].y, m->normals[n->face].z};
        return out;
    }
    double3 normal = double3_cross(double3_minus(out.p[1], out.p[0]), double3_minus(out.p[2], out.p[0]));
    double  length = sqrt(double3_dot(normal, normal));
    out.normal = length > 0 ? (double3){normal.x / length, normal.y / length, normal.z / length} : (double3){0, 0, 0};
    return out;
}

/* Heights of a's corners over b's plane; what is as good as on it is on it. False when a lies on one side. */
static bool find_heights(const crossing_search *s, world_face *a, const world_face *b)
{
    bool above = false, below = false;
    for (int k = 0; k < 3; k++) {
        double height = double3_dot(double3_minus(a->p[k], b->p[0]), b->normal);
        a->heights[k] = fabs(height) <= s->same ? 0 : height;
        above = above || a->heights[k] > 0;
        below = below || a->heights[k] < 0;
    }
    return above && below;
}

/* Where an edge passes the other face's plane: the same number for both faces of the edge. */
static double3 edge_at_plane(const world_face *f, int from, int to)
{
    if (f->vertices[from] > f->vertices[to]) {
        int other = from;
        from = to;
        to = other;
    }
    if (f->heights[from] == 0)
        return f->p[from];
    if (f->heights[to] == 0)
        return f->p[to];
    double  fraction = f->heights[from] / (f->heights[from] - f->heights[to]);
    double3 p = f->p[from], q = f->p[to];
    return (double3){p.x + fraction * (q.x - p.x), p.y + fraction * (q.y - p.y), p.z + fraction * (q.z - p.z)};
}

/* The two places where a face's rim passes the other one's plane. */
static void rim_at_plane(const world_face *f, double3 out[2])
{
    int found = 0;
    for (int k = 0; k < 3 && found < 2; k++) {
        int next = k == 2 ? 0 : k + 1;
        if ((f->heights[k] > 0 && f->heights[next] < 0) || (f->heights[k] < 0 && f->heights[next] > 0))
            out[found++] = edge_at_plane(f, k, next);
        else if (f->heights[k] == 0)
            out[found++] = f->p[k];
    }
}

/* Does one face lie clear of the other one's plane? A first look for faces of one mesh that is not moved, with less
 * arithmetic. */
static bool is_clear(const crossing_search *s, const edge_mesh *m, uint32_t face, uint32_t plane)
{
    vec3  normal = m->normals[plane], origin = m->positions[m->faces[plane][0]];
    float least = INFINITY, most = -INFINITY, margin = (float)(4 * s->same);
    for (int k = 0; k < 3; k++) {
        vec3  p = m->positions[m->faces[face][k]];
        float height = (p.x - origin.x) * normal.x + (p.y - origin.y) * normal.y + (p.z - origin.z) * normal.z;
        least = smaller(least, height);
        most = larger(most, height);
    }
    return least > margin || most < -margin;
}

/* By how much a mesh's surface turns beside each face, from one face to the next, where it is smooth; NULL when memory
 * is gone. */
static const float *turns_of(crossing_search *s, uint32_t mesh)
{
    const edge_mesh *m = &s->scene->meshes[mesh];
    if (!s->turns)
        s->turns = mem_calloc(s->scene->mesh_count + 1, sizeof *s->turns);
    if (!s->turns || s->turns[mesh])
        return s->turns ? s->turns[mesh] : NULL;
    float *out = s->turns[mesh] = mem_calloc((size_t)m->face_count + 1, sizeof *out);
    for (uint32_t i = 0; i < m->edge_count && out; i++) {
        const mesh_edge *e = &m->edges[i];
        if (e->flags & (EDGE_CREASE | EDGE_BORDER | EDGE_TWISTED))
            continue;
        vec3  p = m->normals[e->face[0]], q = m->normals[e->face[1]];
        float turn = acosf(smaller(1, larger(-1, p.x * q.x + p.y * q.y + p.z * q.z)));
        for (int k = 0; k < 2; k++)
            out[e->face[k]] = larger(out[e->face[k]], turn);
    }
    return out;
}

/* Are two faces that cross so nearly one surface, tessellated twice, that where they cross means nothing? They turn
 * against each other no more than each surface does from face to face, and lie close together all over. */
static bool is_one_surface(crossing_search *s, uint32_t first, uint32_t second, const world_face *a,
                           const world_face *b)
{
    const near_face *n = &s->faces[first], *m = &s->faces[second];
    double           cosine = fabs(double3_dot(a->normal, b->normal)), away = 0;
    if (cosine < cos(TURN_MOST))
        return false;
    double size =
        fmin(box3_diagonal(s->piece_boxes[s->pieces[first]]), box3_diagonal(s->piece_boxes[s->pieces[second]]));
    for (int k = 0; k < 3; k++)
        away = fmax(away, fmax(fabs(a->heights[k]), fabs(b->heights[k])));
    if (away > AWAY_MOST * size)
        return false;
    const float *turns[2] = {turns_of(s, s->scene->items[n->item].mesh), turns_of(s, s->scene->items[m->item].mesh)};
    s->failed = s->failed || !turns[0] || !turns[1];
    if (s->failed)
        return false;
    return acos(fmin(cosine, 1)) <= fmax(TURN_LEAST, (double)turns[0][n->face] + turns[1][m->face]);
}

static bool keep_crossing(crossing_search *s, const face_crossing *c)
{
    if (!mem_grow((void **)&s->out->crossings, &s->out->capacity, s->out->count + 1, sizeof *s->out->crossings)) {
        s->failed = true;
        return false;
    }
    s->out->crossings[s->out->count++] = *c;
    return true;
}

static solid_trimmer *trimmer_of(crossing_search *s, uint32_t item)
{
    if (!s->trimmers)
        s->trimmers = mem_calloc(s->scene->item_count + 1, sizeof(solid_trimmer *));
    if (s->trimmers && !s->trimmers[item])
        s->trimmers[item] = solid_trimmer_create(s->scene->meshes[s->scene->items[item].mesh].solid);
    return s->trimmers ? s->trimmers[item] : NULL;
}

static bool put_from(crossing_search *s, const face_crossing *c, int side);

/* The stretches of a crossing at which its face bounds the solid. */
static bool put_trimmed(crossing_search *s, const face_crossing *c, int side)
{
    const stroke_item *item = &s->scene->items[c->items[side]];
    solid_trimmer     *t = trimmer_of(s, c->items[side]);
    const solid_share *found;
    size_t             count;
    const mat4         inverse = mat4_inverse(&item->world);
    double             ends[2][3];
    for (int k = 0; k < 2; k++)
        for (int row = 0; row < 3; row++)
            ends[k][row] = inverse.m[row] * c->ends[k].x + inverse.m[4 + row] * c->ends[k].y +
                           inverse.m[8 + row] * c->ends[k].z + inverse.m[12 + row];
    s->failed = !t || !solid_trim(t, c->faces[side], ends[0], ends[1], &found, &count);
    solid_share *shares =
        s->failed ? NULL : mem_copy(found, count * sizeof *shares); /* the other side may be its own */
    s->failed = s->failed || (count && !shares);
    for (size_t i = 0; !s->failed && i < count; i++) {
        face_crossing part = *c;
        double3       way = double3_minus(c->ends[1], c->ends[0]), from = c->ends[0];
        if (shares[i].from > 0)
            part.ends[0] = (double3){from.x + shares[i].from * way.x, from.y + shares[i].from * way.y,
                                     from.z + shares[i].from * way.z};
        if (shares[i].to < 1)
            part.ends[1] =
                (double3){from.x + shares[i].to * way.x, from.y + shares[i].to * way.y, from.z + shares[i].to * way.z};
        put_from(s, &part, side + 1);
    }
    mem_free(shares);
    return !s->failed;
}

static bool put_from(crossing_search *s, const face_crossing *c, int side)
{
    for (; side < 2; side++)
        if (s->scene->meshes[s->scene->items[c->items[side]].mesh].solid)
            return put_trimmed(s, c, side);
    return keep_crossing(s, c);
}

/* Adds a crossing, of faces of solids as far as they bound them. */
static bool put_crossing(crossing_search *s, const face_crossing *c)
{
    return put_from(s, c, 0);
}

/* On which side of the other plane a face is that has an edge on it: 1 or −1; 0 where it has none. */
static int touching_side(const world_face *f)
{
    int on = 0, side = 0;
    for (int k = 0; k < 3; k++) {
        on += f->heights[k] == 0;
        side = f->heights[k] == 0 ? side : f->heights[k] > 0 ? 1 : -1;
    }
    return on == 2 ? side : 0;
}

static bool put_touch(crossing_search *s, const world_face *f, uint32_t item, uint32_t other, const face_crossing *c)
{
    face_touch t = {.item = item, .other = other, .side = touching_side(f), .crossing = *c};
    int        count = 0;
    for (int k = 0; k < 3; k++)
        if (f->heights[k] == 0 && count < 2)
            t.vertices[count++] = f->vertices[k];
    if (t.vertices[0] > t.vertices[1]) {
        uint32_t first = t.vertices[0];
        t.vertices[0] = t.vertices[1];
        t.vertices[1] = first;
    }
    if (!mem_grow((void **)&s->touches, &s->touch_capacity, s->touch_count + 1, sizeof *s->touches)) {
        s->failed = true;
        return false;
    }
    s->touches[s->touch_count++] = t;
    return true;
}

/* What two faces have in common of the line in which their planes cross; false where that is nothing. */
static bool common_line(const crossing_search *s, const world_face *a, const world_face *b, double3 ends[2])
{
    double3 along = double3_cross(a->normal, b->normal), p[2], q[2];
    rim_at_plane(a, p);
    rim_at_plane(b, q);
    int p0 = double3_dot(along, p[0]) <= double3_dot(along, p[1]) ? 0 : 1,
        q0 = double3_dot(along, q[0]) <= double3_dot(along, q[1]) ? 0 : 1;
    ends[0] = double3_dot(along, p[p0]) >= double3_dot(along, q[q0]) ? p[p0] : q[q0];
    ends[1] = double3_dot(along, p[1 - p0]) <= double3_dot(along, q[1 - q0]) ? p[1 - p0] : q[1 - q0];
    double3 length = double3_minus(ends[1], ends[0]);
    return double3_dot(along, length) > 0 && double3_dot(length, length) > s->same * s->same;
}

static bool cross_faces(void *user, uint32_t first, uint32_t second)
{
    crossing_search *s = user;
    if (s->progress && ++s->ticks % TICKS == 0 && !s->progress(0.5, "finding intersections", s->user)) {
        s->cancelled = true;
        return false;
    }
    if (first > second) {
        uint32_t other = first;
        first = second;
        second = other;
    }
    const near_face *n = &s->faces[first], *m = &s->faces[second];
    if (!asks_for(s, s->pieces[first], s->pieces[second]))
        return true;
    s->out->compared++;
    s->same = SAME_POSITION * fmax(s->scene->items[n->item].reach, s->scene->items[m->item].reach);
    if (n->item == m->item && s->still[n->item]) {
        const edge_mesh *own = &s->scene->meshes[s->scene->items[n->item].mesh];
        if (is_clear(s, own, n->face, m->face) || is_clear(s, own, m->face, n->face))
            return true;
    }
    world_face a = load_face(s, n), b = load_face(s, m);
    bool       crosses = find_heights(s, &a, &b), crossed = find_heights(s, &b, &a);
    bool       touches = !crosses && crossed && touching_side(&a), touched = !crossed && crosses && touching_side(&b);
    if (!(crosses && crossed) && !touches && !touched)
        return true;
    face_crossing c = {.items = {n->item, m->item}, .faces = {n->face, m->face}};
    if (!common_line(s, &a, &b, c.ends))
        return true;
    c.pieces[0] = s->pieces[first];
    c.pieces[1] = s->pieces[second];
    c.one_surface = is_one_surface(s, first, second, &a, &b);
    return touches   ? put_touch(s, &a, n->item, second, &c)
           : touched ? put_touch(s, &b, m->item, first, &c)
                     : put_crossing(s, &c);
}

static int compare_touches(const void *a, const void *b)
{
    const face_touch *p = a, *q = b;
    const uint32_t    keys[2][4] = {{p->item, p->vertices[0], p->vertices[1], p->other},
                                    {q->item, q->vertices[0], q->vertices[1], q->other}};
    for (int k = 0; k < 4; k++)
        if (keys[0][k] != keys[1][k])
            return keys[0][k] < keys[1][k] ? -1 : 1;
    return p->side - q->side;
}

/* Edges that faces on both sides of a plane have on it. */
static bool cross_along_edges(crossing_search *s)
{
    if (s->touch_count)
        qsort(s->touches, s->touch_count, sizeof *s->touches, compare_touches);
    for (size_t i = 1; i < s->touch_count; i++) {
        const face_touch *p = &s->touches[i - 1], *q = &s->touches[i];
        bool same_edge = p->item == q->item && p->vertices[0] == q->vertices[0] && p->vertices[1] == q->vertices[1];
        if (same_edge && p->other == q->other && p->side < q->side && !put_crossing(s, &p->crossing))
            return false;
    }
    return true;
}

/* --- all ------------------------------------------------------------------------------------------------ */

static double3 corner_position(void *user, uint32_t face, int corner)
{
    const crossing_search *s = user;
    const near_face       *n = &s->faces[face];
    const stroke_item     *item = &s->scene->items[n->item];
    const edge_mesh       *m = &s->scene->meshes[item->mesh];
    return item_position(item, m->positions[m->faces[n->face][corner]]);
}

/* Those that share a hub by directions, all others by boxes. */
static lmn_status compare_faces(crossing_search *s, lmn_error *error)
{
    const hub_faces faces = {(const uint32_t(*)[3])s->corners, s->pieces,      s->planes, s->face_count,
                             SAME_POSITION * s->scene->reach,  corner_position};
    hierarchy       tree;
    s->hubs = s->unnumbered ? NULL : mem_alloc((s->face_count + 1) * sizeof *s->hubs);
    if (!s->unnumbered && (!s->hubs || !hubs_find(s->hubs, &faces)))
        return error_memory(error);
    s->face_bodies = s->hidden ? mem_alloc((s->face_count + 1) * sizeof *s->face_bodies) : NULL;
    if (s->hidden && !s->face_bodies)
        return error_memory(error);
    for (size_t i = 0; i < s->face_count && s->hidden; i++)
        s->face_bodies[i] = s->bodies[s->pieces[i]];
    const hierarchy_kin kin = {{s->hidden ? s->face_bodies : s->pieces, s->planes, s->hubs}};
    lmn_status          status = hierarchy_build(&tree, s->boxes, kin, (uint32_t)s->face_count, error);
    if (status != LMN_OK)
        return status;
    bool going = hierarchy_pairs(&tree, s->boxes, kin, cross_faces, s);
    hierarchy_release(&tree);
    return going && s->hubs ? hubs_pairs(s->hubs, &faces, cross_faces, s, &going, error) : LMN_OK;
}

/* Of pieces that are single faces it takes as long to say where they overlap. */
static size_t faces_of(const stroke_scene *scene)
{
    size_t count = 0;
    for (size_t i = 0; i < scene->item_count; i++)
        count += scene->meshes[scene->items[i].mesh].face_count;
    return count;
}

static lmn_status search(crossing_search *s, lmn_error *error)
{
    hierarchy           tree;
    lmn_status          status = number_pieces(s, error);
    const hierarchy_kin kin = {{s->bodies}};
    if (status != LMN_OK)
        return status;
    s->crowded = s->hidden && 2 * (size_t)s->piece_count > faces_of(s->scene);
    if (!s->crowded) {
        status = hierarchy_build(&tree, s->piece_boxes, kin, s->piece_count, error);
        if (status != LMN_OK)
            return status;
        hierarchy_pairs(&tree, s->piece_boxes, kin, widen_region, s);
        if (!s->crowded && !box3_is_empty(s->region))
            hierarchy_pairs(&tree, s->piece_boxes, kin, mark_region, s);
        hierarchy_release(&tree);
    }
    if (!s->crowded && box3_is_empty(s->region))
        return LMN_OK;
    status = gather_faces(s, error);
    if (status == LMN_OK)
        status = compare_faces(s, error);
    if (status != LMN_OK)
        return status;
    s->failed = s->failed || (!s->cancelled && !cross_along_edges(s));
    if (s->cancelled)
        return error_set(error, LMN_CANCELLED, "cancelled while intersections were found");
    return s->failed ? error_memory(error) : LMN_OK;
}

/* Sorts them by the item that has the line, each item's in the order in which they were found. */
static bool crossings_sort(crossing_list *c, size_t item_count)
{
    c->first = mem_calloc(item_count + 2, sizeof *c->first);
    c->order = mem_alloc((c->count + 1) * sizeof *c->order);
    if (!c->first || !c->order)
        return false;
    for (size_t i = 0; i < c->count; i++)
        c->first[c->crossings[i].items[0] + 2]++;
    for (size_t i = 2; i < item_count + 2; i++)
        c->first[i] += c->first[i - 1];
    for (size_t i = 0; i < c->count; i++)
        c->order[c->first[c->crossings[i].items[0] + 1]++] = i;
    return true;
}

lmn_status crossings_find(crossing_list *out, const stroke_scene *scene, const bool *parts, const uint8_t *hidden,
                          lmn_progress_fn progress, void *user, lmn_error *error)
{
    memset(out, 0, sizeof *out);
    crossing_search s = {.scene = scene,
                         .out = out,
                         .parts = parts,
                         .hidden = hidden,
                         .region = box3_empty(),
                         .progress = progress,
                         .user = user};
    lmn_status      status = search(&s, error);
    mem_free(s.first_piece);
    mem_free(s.still);
    mem_free(s.piece_boxes);
    mem_free(s.piece_meets);
    mem_free(s.piece_asks);
    mem_free(s.piece_items);
    mem_free(s.bodies);
    mem_free(s.face_bodies);
    mem_free(s.marks);
    mem_free(s.faces);
    mem_free(s.boxes);
    mem_free(s.pieces);
    mem_free(s.planes);
    mem_free(s.corners);
    mem_free(s.hubs);
    mem_free(s.touches);
    for (size_t i = 0; i < scene->mesh_count && s.turns; i++)
        mem_free(s.turns[i]);
    mem_free(s.turns);
    for (size_t i = 0; i < scene->item_count && s.trimmers; i++)
        solid_trimmer_destroy(&s.trimmers[i]);
    mem_free(s.trimmers);
    if (status == LMN_OK && !(crossings_settle(out) && crossings_sort(out, scene->item_count)))
        status = error_memory(error);
    if (status != LMN_OK)
        crossings_release(out);
    return status;
}

void crossings_release(crossing_list *c)
{
    mem_free(c->crossings);
    mem_free(c->beside);
    mem_free(c->first);
    mem_free(c->order);
    mem_free(c->parts);
    memset(c, 0, sizeof *c);
}

/* Are all that are asked for among those that were? */
static bool has_all(const crossing_list *c, const bool *parts, size_t part_count)
{
    for (size_t i = 0; i < part_count && c->parts; i++)
        if (!(i < c->part_count && c->parts[i]) && (!parts || parts[i]))
            return false;
    return true;
}

bool stroke_scene_has_crossings(const stroke_scene *s, const bool *parts, size_t part_count)
{
    return s->crossings && has_all(s->crossings, parts, part_count);
}

lmn_status stroke_scene_cross(stroke_scene *s, const bool *parts, size_t part_count, lmn_progress_fn progress,
                              void *user, lmn_error *error)
{
    if (stroke_scene_has_crossings(s, parts, part_count))
        return LMN_OK;
    if (s->crossings)
        crossings_release(s->crossings);
    else
        s->crossings = mem_calloc(1, sizeof *s->crossings);
    if (!s->crossings)
        return error_memory(error);
    lmn_status status = crossings_find(s->crossings, s, parts, NULL, progress, user, error);
    if (status == LMN_OK && parts) {
        s->crossings->part_count = part_count;
        s->crossings->parts = mem_copy(parts, part_count * sizeof *parts);
        status = s->crossings->parts ? LMN_OK : error_memory(error);
    }
    if (status != LMN_OK) {
        crossings_release(s->crossings);
        mem_free(s->crossings);
        s->crossings = NULL;
    }
    return status;
}

size_t stroke_scene_crossing_count(const stroke_scene *s)
{
    return s->crossings ? s->crossings->count : 0;
}

const size_t *stroke_scene_crossings_of(const stroke_scene *s, uint32_t item, size_t *count)
{
    *count = s->crossings ? s->crossings->first[item + 1] - s->crossings->first[item] : 0;
    return s->crossings ? s->crossings->order + s->crossings->first[item] : NULL;
}

/* Of a face, world axes; 0, 0, 0 where its piece is open. */
static vec3 outward_normal(const stroke_scene *s, uint32_t item, uint32_t face)
{
    const stroke_item *at = &s->items[item];
    const edge_mesh   *m = &s->meshes[at->mesh];
    uint32_t           piece = m->pieces[face];
    double             cofactors[9], determinant = mat4_cofactors(&at->world, cofactors), n[3];
    vec3               own = m->normals[face];
    for (int k = 0; k < 3; k++)
        n[k] = (double)own.x * cofactors[k] + (double)own.y * cofactors[3 + k] + (double)own.z * cofactors[6 + k];
    double length = sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
    double scale = m->closed[piece] && length > 0 ? (m->inward[piece] == (determinant < 0) ? 1 : -1) / length : 0;
    return (vec3){(float)(n[0] * scale), (float)(n[1] * scale), (float)(n[2] * scale)};
}

uint32_t stroke_scene_crossing(const stroke_scene *s, size_t index, double ends[2][3], vec3 outward[2])
{
    const face_crossing *c = &s->crossings->crossings[index];
    for (int i = 0; i < 2; i++) {
        memcpy(ends[i], (double[]){c->ends[i].x, c->ends[i].y, c->ends[i].z}, sizeof ends[i]);
        outward[i] = outward_normal(s, c->items[i], c->faces[i]);
    }
    return c->items[0];
}
