#include "plan/project_mesh.h"

#include <math.h>
#include <string.h>

#include "base/error.h"
#include "base/limits.h"
#include "base/memory.h"
#include "base/work.h"

/* A corner before it is bent, in the world. */
typedef struct corner {
    double at[3];
    float  normal[3], uvs[UV_SETS][2], colour[4];
} corner;

typedef struct projecting {
    projected_primitive  *to;
    const projection_map *map;
    lmn_error            *error;
    lmn_status            status;
} projecting;

/* A corner in a piece of space. */
typedef struct placed {
    corner           c;
    double           frame[3];
    int              piece;
    projection_where where;
    unsigned         edges; /* of the face: bits of those that it lies on */
    bool             axis;  /* of a round map: on all planes */
} placed;

/* By the cofactors of how its surroundings are bent, from differences. */
static void bend_normal(const projection_map *m, const placed *p, float out[3])
{
    const double SHARE = 1e-4;
    double       step = SHARE * (fabs(p->frame[0]) + fabs(p->frame[1]) + 1), columns[3][3], normal[3];
    double       turned[3] = {0}, length = 0;
    for (int k = 0; k < 3; k++) {
        double ends[2][3];
        for (int s = 0; s < 2; s++) {
            double near[3] = {p->frame[0], p->frame[1], p->frame[2]};
            near[k] += s ? step : -step;
            m->row->bend(m, p->piece, PROJECTION_BETWEEN, near, ends[s]);
        }
        normal[k] = 0;
        for (int r = 0; r < 3; r++) {
            columns[k][r] = (ends[1][r] - ends[0][r]) / (2 * step);
            normal[k] += m->axes[k][r] * (double)p->c.normal[r];
        }
    }
    for (int k = 0; k < 3; k++) {
        const double *a = columns[(k + 1) % 3], *b = columns[(k + 2) % 3];
        for (int r = 0; r < 3; r++)
            turned[r] += normal[k] * (a[(r + 1) % 3] * b[(r + 2) % 3] - a[(r + 2) % 3] * b[(r + 1) % 3]);
    }
    for (int r = 0; r < 3; r++)
        length += turned[r] * turned[r];
    length = sqrt(length);
    for (int r = 0; r < 3; r++) {
        double world = 0;
        for (int k = 0; k < 3; k++)
            world += m->axes[k][r] * turned[k];
        out[r] = length > 0 ? (float)(world / length) : p->c.normal[r];
    }
}

/* --- vertices ------------------------------------------------------------------------------------------- */

typedef struct vertex {
    vec3 at, straight, normal;
    vec2 uvs[UV_SETS];
    vec4 colour;
} vertex;

static vertex vertex_of(const projecting *p, const placed *from)
{
    const primitive *o = &p->to->out;
    const corner    *c = &from->c;
    vertex           v;
    double           at[3], world[3];
    float            normal[3] = {0};
    memset(&v, 0, sizeof v);
    p->map->row->bend(p->map, from->piece, from->where, from->frame, at);
    projection_to_world(p->map, at, world);
    v.at = (vec3){(float)world[0], (float)world[1], (float)world[2]};
    v.straight = (vec3){(float)c->at[0], (float)c->at[1], (float)c->at[2]};
    if (o->normals)
        bend_normal(p->map, from, normal);
    v.normal = (vec3){normal[0], normal[1], normal[2]};
    for (int i = 0; i < UV_SETS; i++)
        v.uvs[i] = (vec2){c->uvs[i][0], c->uvs[i][1]};
    v.colour = (vec4){c->colour[0], c->colour[1], c->colour[2], c->colour[3]};
    return v;
}

static bool is_vertex(const primitive *o, uint32_t i, const vertex *v)
{
    bool same = memcmp(&o->positions[i], &v->at, sizeof v->at) == 0 &&
                memcmp(&o->straight[i], &v->straight, sizeof v->straight) == 0 &&
                (!o->normals || memcmp(&o->normals[i], &v->normal, sizeof v->normal) == 0) &&
                (!o->colours || memcmp(&o->colours[i], &v->colour, sizeof v->colour) == 0);
    for (int k = 0; k < UV_SETS && same; k++)
        same = !o->uvs[k] || memcmp(&o->uvs[k][i], &v->uvs[k], sizeof v->uvs[k]) == 0;
    return same;
}

static size_t hash_of(const vec3 *at)
{
    uint32_t words[3];
    uint64_t h = UINT64_C(1469598103934665603);
    memcpy(words, at, sizeof words);
    for (int k = 0; k < 3; k++)
        h = (h ^ words[k]) * UINT64_C(1099511628211);
    return (size_t)(h ^ h >> 29);
}

static bool grow_slots(projected_primitive *p)
{
    size_t    count = p->slot_count ? 2 * p->slot_count : 64;
    uint32_t *slots = mem_alloc(count * sizeof *slots);
    if (!slots)
        return false;
    memset(slots, 0xFF, count * sizeof *slots);
    for (uint32_t i = 0; i < p->out.vertex_count; i++) {
        size_t at = hash_of(&p->out.positions[i]) & (count - 1);
        while (slots[at] != UINT32_MAX)
            at = (at + 1) & (count - 1);
        slots[at] = i;
    }
    mem_free(p->slots);
    p->slots = slots;
    p->slot_count = count;
    return true;
}

static bool grow_vertices(projected_primitive *p)
{
    primitive *o = &p->out;
    size_t     needed = (size_t)o->vertex_count + 1, capacity = p->vertex_capacity;
    if (needed <= capacity)
        return true;
    bool good = mem_grow((void **)&o->positions, &capacity, needed, sizeof *o->positions);
    for (int i = 0; i < UV_SETS + 3 && good; i++) {
        void **arrays[] = {(void **)&o->straight, (void **)&o->normals, (void **)&o->colours, (void **)&o->uvs[0],
                           (void **)&o->uvs[1]};
        size_t sizes[] = {sizeof(vec3), sizeof(vec3), sizeof(vec4), sizeof(vec2), sizeof(vec2)},
               own = p->vertex_capacity;
        good = !*arrays[i] || mem_grow(arrays[i], &own, needed, sizes[i]);
    }
    if (good)
        p->vertex_capacity = capacity;
    return good;
}

static uint32_t add_vertex(projecting *p, const placed *from)
{
    projected_primitive *to = p->to;
    primitive           *o = &to->out;
    vertex               v = vertex_of(p, from);
    if ((size_t)o->vertex_count * 2 >= to->slot_count && !grow_slots(to)) {
        p->status = error_memory(p->error);
        return 0;
    }
    size_t at = hash_of(&v.at) & (to->slot_count - 1);
    while (to->slots[at] != UINT32_MAX && !is_vertex(o, to->slots[at], &v))
        at = (at + 1) & (to->slot_count - 1);
    if (to->slots[at] != UINT32_MAX)
        return to->slots[at];
    if (!grow_vertices(to)) {
        p->status = error_memory(p->error);
        return 0;
    }
    uint32_t i = o->vertex_count++;
    to->slots[at] = i;
    o->positions[i] = v.at;
    o->straight[i] = v.straight;
    if (o->normals)
        o->normals[i] = v.normal;
    if (o->colours)
        o->colours[i] = v.colour;
    for (int k = 0; k < UV_SETS; k++)
        if (o->uvs[k])
            o->uvs[k][i] = v.uvs[k];
    return i;
}

/* --- cutting -------------------------------------------------------------------------------------------- */

static corner between(const corner *a, const corner *b, double share)
{
    corner out;
    float  part = (float)share, rest = 1 - part;
    for (int k = 0; k < 3; k++) {
        out.at[k] = a->at[k] + share * (b->at[k] - a->at[k]);
        out.normal[k] = rest * a->normal[k] + part * b->normal[k];
    }
    for (int i = 0; i < UV_SETS; i++)
        for (int k = 0; k < 2; k++)
            out.uvs[i][k] = rest * a->uvs[i][k] + part * b->uvs[i][k];
    for (int k = 0; k < 4; k++)
        out.colour[k] = rest * a->colour[k] + part * b->colour[k];
    return out;
}

/* A face, or of two corners a line, and where it meets the axis of a round map. */
typedef struct cut_face {
    const corner  *corners;
    int            count;
    double         frames[3][3];
    corner         axis;
    bool           has_axis;
    const uint8_t *said; /* of its edges: what the file wants shown; NULL: it does not say */
} cut_face;

/* Of edges that a cut makes: what edge_visibility says of those of which nothing is said. */
enum { SAID_NOTHING = 4 };

enum { CUT_CORNERS_MOST = 8 };
typedef struct cut_polygon {
    placed corners[CUT_CORNERS_MOST];
    int    count;
} cut_polygon;

static double behind(const projecting *p, const placed *c, int plane)
{
    const double ON = 1e-12;
    double       off = projection_behind(p->map, plane, c->frame);
    double       size = fabs(c->frame[0]) + fabs(c->frame[1]) + fabs(p->map->planes[plane][2]);
    return c->axis || fabs(off) <= ON * size ? 0 : off;
}

/* Where the edge from corner `e` meets a plane: from the edge's own ends in one order, whichever face asks and whatever
 * is left of it. */
static placed on_edge(const projecting *p, const cut_face *f, int e, int plane, int piece, projection_where where)
{
    int first = e, second = (e + 1) % f->count;
    if (memcmp(f->corners[first].at, f->corners[second].at, sizeof f->corners[first].at) > 0) {
        first = second;
        second = e;
    }
    double a = projection_behind(p->map, plane, f->frames[first]),
           b = projection_behind(p->map, plane, f->frames[second]);
    placed out = {.piece = piece, .where = where, .edges = 1u << e};
    out.c = between(&f->corners[first], &f->corners[second], a / (a - b));
    projection_to_frame(p->map, out.c.at, out.frame);
    return out;
}

static placed crossing_of(const projecting *p, const cut_face *f, const placed *a, const placed *b, int plane,
                          projection_where where)
{
    unsigned shared = a->edges & b->edges;
    for (int e = 0; e < 3; e++)
        if (shared & 1u << e)
            return on_edge(p, f, e, plane, a->piece, where);
    /* Along the other plane there is but the axis. */
    placed out = {.piece = a->piece, .where = where, .c = f->axis, .axis = true};
    projection_to_frame(p->map, out.c.at, out.frame);
    out.frame[0] = out.frame[1] = 0;
    return out;
}

/* Keeps what lies behind a plane (`sign` 1), or before it (−1). */
static void clip(const projecting *p, const cut_face *f, cut_polygon *polygon, int plane, int sign,
                 projection_where where)
{
    cut_polygon out = {.count = 0};
    double      off[CUT_CORNERS_MOST];
    for (int k = 0; k < polygon->count; k++)
        off[k] = sign * behind(p, &polygon->corners[k], plane);
    int edges = polygon->count > 2 ? polygon->count : polygon->count - 1; /* a line is not closed */
    for (int k = 0; k < polygon->count; k++) {
        int next = (k + 1) % polygon->count;
        if (off[k] >= 0 && out.count < CUT_CORNERS_MOST) {
            placed kept = polygon->corners[k];
            if (off[k] == 0)
                kept.where = where;
            out.corners[out.count++] = kept;
        }
        if (k < edges && ((off[k] > 0 && off[next] < 0) || (off[k] < 0 && off[next] > 0)) &&
            out.count < CUT_CORNERS_MOST)
            out.corners[out.count++] = crossing_of(p, f, &polygon->corners[k], &polygon->corners[next], plane, where);
    }
    *polygon = out;
}

static void put_triangle(projecting *p, const uint32_t numbers[3], const uint8_t said[3])
{
    projected_primitive *to = p->to;
    if (numbers[0] == numbers[1] || numbers[1] == numbers[2] || numbers[2] == numbers[0])
        return;
    if (to->out.index_count / 3 >= LIMIT_TRIANGLES)
        p->status = error_set(p->error, LMN_LIMIT, "bent, the scene has more than %zu triangles", LIMIT_TRIANGLES);
    else if (!mem_grow((void **)&to->out.indices, &to->index_capacity, (size_t)to->out.index_count + 3,
                       sizeof *to->out.indices))
        p->status = error_memory(p->error);
    if (p->status == LMN_OK && said &&
        !mem_grow((void **)&to->out.edges.values, &to->said_capacity, (size_t)to->out.index_count + 3, 1))
        p->status = error_memory(p->error);
    if (p->status != LMN_OK)
        return;
    if (said)
        memcpy(&to->out.edges.values[to->out.index_count], said, 3);
    memcpy(&to->out.indices[to->out.index_count], numbers, 3 * sizeof *numbers);
    to->out.index_count += 3;
}

static void put_line(projecting *p, const uint32_t numbers[2])
{
    projected_primitive *to = p->to;
    if (numbers[0] == numbers[1])
        return;
    if (!mem_grow((void **)&to->out.lines, &to->line_capacity, 2 * (size_t)to->out.line_count + 2,
                  sizeof *to->out.lines)) {
        p->status = error_memory(p->error);
        return;
    }
    memcpy(&to->out.lines[2 * (size_t)to->out.line_count], numbers, 2 * sizeof *numbers);
    to->out.line_count++;
}

/* What is said of the edge of the face that two corners lie on. */
static uint8_t said_between(const cut_face *f, const placed *a, const placed *b)
{
    unsigned shared = a->edges & b->edges;
    for (int e = 0; e < 3; e++)
        if (shared & 1u << e)
            return f->said[e];
    return SAID_NOTHING;
}

static void put_polygon(projecting *p, const cut_face *f, const cut_polygon *polygon)
{
    uint32_t numbers[CUT_CORNERS_MOST];
    for (int k = 0; k < polygon->count && p->status == LMN_OK; k++)
        numbers[k] = add_vertex(p, &polygon->corners[k]);
    if (polygon->count == 2 && p->status == LMN_OK)
        put_line(p, numbers);
    for (int k = 2; k < polygon->count && p->status == LMN_OK; k++) {
        const placed *c = polygon->corners;
        uint8_t       said[3] = {SAID_NOTHING, SAID_NOTHING, SAID_NOTHING};
        if (f->said) {
            said[0] = k == 2 ? said_between(f, &c[0], &c[1]) : SAID_NOTHING;
            said[1] = said_between(f, &c[k - 1], &c[k]);
            said[2] = k == polygon->count - 1 ? said_between(f, &c[k], &c[0]) : SAID_NOTHING;
        }
        put_triangle(p, (uint32_t[]){numbers[0], numbers[k - 1], numbers[k]}, f->said ? said : NULL);
    }
}

/* Which piece a corner lies in. */
static int piece_at(const projection_map *m, const double at[3])
{
    int low = 0, high = m->pieces - 1;
    if (m->row->round) {
        double turn = (atan2(at[0], at[1]) / 3.14159265358979323846 + 1) / 2;
        return (int)fmin(fmax(floor(turn * m->pieces), 0), high);
    }
    while (low < high) { /* the first one whose high plane is not before it */
        int middle = (low + high) / 2;
        if (projection_behind(m, middle, at) > 0)
            low = middle + 1;
        else
            high = middle;
    }
    return low;
}

/* Where the axis of a round map meets a face. */
static void find_axis(const projecting *p, cut_face *f)
{
    double areas[3], sum = 0;
    for (int k = 0; k < 3; k++) {
        const double *a = f->frames[(k + 1) % 3], *b = f->frames[(k + 2) % 3];
        areas[k] = a[0] * b[1] - a[1] * b[0];
        sum += areas[k];
    }
    f->has_axis =
        p->map->row->round && f->count == 3 &&
        ((areas[0] >= 0 && areas[1] >= 0 && areas[2] >= 0) || (areas[0] <= 0 && areas[1] <= 0 && areas[2] <= 0)) &&
        sum != 0;
    if (!f->has_axis)
        return;
    corner half =
        between(&f->corners[0], &f->corners[1], areas[0] + areas[1] != 0 ? areas[1] / (areas[0] + areas[1]) : 0);
    f->axis = between(&half, &f->corners[2], areas[2] / sum);
}

/* Does it lie on both sides of what is behind the eye? */
static bool is_parted(const cut_face *f)
{
    bool right = false, left = false, back = false;
    for (int k = 0; k < f->count; k++) {
        right = right || f->frames[k][0] >= 0;
        left = left || f->frames[k][0] <= 0;
        back = back || f->frames[k][1] < 0;
    }
    return right && left && back;
}

/* The parts of a face in all pieces that it lies in. */
static void cut_face_into(projecting *p, const corner *corners, int count, const uint8_t *said)
{
    cut_face f = {.corners = corners, .count = count, .said = said};
    int      first = p->map->pieces, last = -1;
    for (int k = 0; k < count; k++) {
        projection_to_frame(p->map, corners[k].at, f.frames[k]);
        int piece = piece_at(p->map, f.frames[k]);
        first = piece < first ? piece : first;
        last = piece > last ? piece : last;
    }
    if (count == 3)
        find_axis(p, &f);
    if (p->map->row->round && (f.has_axis || is_parted(&f))) {
        first = 0;
        last = p->map->pieces - 1;
    }
    for (int piece = first; piece <= last && p->status == LMN_OK; piece++) {
        cut_polygon polygon = {.count = count};
        int         low, high;
        for (int k = 0; k < count; k++) {
            placed *c = &polygon.corners[k];
            *c = (placed){.c = corners[k], .piece = piece, .where = PROJECTION_BETWEEN};
            c->edges = count == 2 ? 1u : 1u << k | 1u << (k + count - 1) % count;
            memcpy(c->frame, f.frames[k], sizeof c->frame);
        }
        projection_planes(p->map, piece, &low, &high);
        if (low != PROJECTION_NO_PLANE)
            clip(p, &f, &polygon, low, 1, PROJECTION_ON_LOW);
        if (high != PROJECTION_NO_PLANE)
            clip(p, &f, &polygon, high, -1, PROJECTION_ON_HIGH);
        if (polygon.count >= count)
            put_polygon(p, &f, &polygon);
    }
}

/* --- a primitive ---------------------------------------------------------------------------------------- */

static corner corner_of(const primitive *from, const vec3 *positions, const vec3 *normals, const mat4 *world,
                        const double cofactors[9], double sign, uint32_t i)
{
    const double  local[3] = {(double)positions[i].x, (double)positions[i].y, (double)positions[i].z};
    const double *m = world->m;
    corner        c;
    memset(&c, 0, sizeof c);
    for (int k = 0; k < 3; k++)
        c.at[k] = m[k] * local[0] + m[4 + k] * local[1] + m[8 + k] * local[2] + m[12 + k];
    if (normals)
        for (int k = 0; k < 3; k++)
            c.normal[k] =
                (float)(sign * (cofactors[k] * (double)normals[i].x + cofactors[3 + k] * (double)normals[i].y +
                                cofactors[6 + k] * (double)normals[i].z));
    for (int k = 0; k < UV_SETS; k++)
        if (from->uvs[k]) {
            c.uvs[k][0] = from->uvs[k][i].x;
            c.uvs[k][1] = from->uvs[k][i].y;
        }
    if (from->colours)
        memcpy(c.colour, &from->colours[i], sizeof c.colour);
    return c;
}

/* Arrays that the primitive has, so that vertices get them. */
static bool open(projected_primitive *to, const primitive *from, bool normals)
{
    primitive *o = &to->out;
    if (o->positions)
        return true;
    enum { FIRST = 64 };
    to->vertex_capacity = FIRST;
    o->material = from->material;
    o->positions = mem_alloc(FIRST * sizeof *o->positions);
    o->straight = mem_alloc(FIRST * sizeof *o->straight);
    o->normals = normals ? mem_alloc(FIRST * sizeof *o->normals) : NULL;
    o->colours = from->colours ? mem_alloc(FIRST * sizeof *o->colours) : NULL;
    bool good = o->positions && o->straight && (o->normals || !normals) && (o->colours || !from->colours);
    for (int k = 0; k < UV_SETS; k++) {
        o->uvs[k] = from->uvs[k] ? mem_alloc(FIRST * sizeof *o->uvs[k]) : NULL;
        good = good && (o->uvs[k] || !from->uvs[k]);
    }
    return good;
}

lmn_status project_primitive(projected_primitive *to, const projection_map *m, const primitive *from,
                             const vec3 *positions, const vec3 *normals, const mat4 *world, lmn_error *error)
{
    projecting p = {to, m, error, LMN_OK};
    double     cofactors[9], sign = mat4_cofactors(world, cofactors) < 0 ? -1 : 1;
    if (!open(to, from, normals != NULL))
        return error_memory(error);
    for (uint32_t i = 0; i < from->index_count && p.status == LMN_OK; i += 3) {
        corner c[3];
        for (uint32_t k = 0; k < 3; k++) /* mirrored parts are turned round again */
            c[k] =
                corner_of(from, positions, normals, world, cofactors, sign, from->indices[i + (sign < 0 ? 2 - k : k)]);
        uint8_t said[3];
        for (int k = 0; k < 3 && from->edges.values; k++) /* those of a face that is turned round, too */
            said[k] = from->edges.values[i + (sign < 0 ? (uint32_t)(4 - k) % 3 : (uint32_t)k)];
        cut_face_into(&p, c, 3, from->edges.values ? said : NULL);
        if (i % 3072 == 0 && p.status == LMN_OK)
            p.status = work_check(error);
    }
    for (uint32_t i = 0; i < from->line_count && p.status == LMN_OK; i++) {
        corner ends[2];
        for (int k = 0; k < 2; k++)
            ends[k] = corner_of(from, positions, normals, world, cofactors, sign, from->lines[2 * i + (uint32_t)k]);
        cut_face_into(&p, ends, 2, NULL);
    }
    return p.status;
}

void project_finish(projected_primitive *p, primitive *out)
{
    *out = p->out;
    p->out = (primitive){.positions = NULL};
    project_release(p);
}

void project_release(projected_primitive *p)
{
    primitive_release(&p->out);
    mem_free(p->slots);
    *p = (projected_primitive){.slots = NULL};
}
