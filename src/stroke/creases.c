/* Edges that turn by more than the crease angle are looked at again: across the strips of faces beside them, and over
 * a few rings of faces to both sides. */
#include "stroke/creases.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "stroke/crease_chains.h"
#include "stroke/crease_rings.h"

#define DEGREE 0.017453292519943295
/* Steps of a rounding turn by less; more is a prism. */
#define STEP_MOST (40 * DEGREE)
/* Neighbouring steps are alike up to this factor, in angle and in width. Where a rounding ends in a face that it is
 * tangent to, its last step is half of the others. */
#define ALIKE     1.5
#define HALF_STEP 2.25
/* On the way to the next step, edges that turn by less than this fraction of the own are part of a face. */
#define FLAT_FRACTION 0.3
/* Edges that run across the way are no steps of it: cosine. */
#define ACROSS 0.7
/* The turn of an edge must be this fraction of what the surface turns over a few faces to either side. */
#define CONCENTRATED 0.45
/* Samplings of surfaces have so much of their edges in bent surroundings, and edges no longer than this fraction of
 * their size. */
#define SAMPLED_FRACTION 0.75
#define SAMPLED_EDGE     0.025
/* Those whose edges are even shorter have the outline of the surface, not of the edges. */
#define OUTLINE_EDGE 0.013
/* Of shapes that bend everywhere more edges turn than this fraction. */
#define BENT_FRACTION 0.8
/* Noise turns edges by less than this, and more than that. */
#define TORN (75 * DEGREE)
#define FLAT (0.05 * DEGREE)
/* A rounding no wider than this fraction of the mesh's size is one line, in its middle, if it turns by so much. */
#define NARROW       0.008
#define NARROW_LONG  0.03
#define NARROW_TURN  (35 * DEGREE)
#define NARROW_STEP  (8 * DEGREE)
#define MIDDLE_SLACK 0.05
/* Creases of samplings are at least so long: mean edges, and fraction of the size. */
#define LONG_EDGES    6.0
#define LONG_FRACTION 0.015
/* Normals of a file that differ by less are one. */
#define ONE_NORMAL (2 * DEGREE)
/* Where a file has no split normals at all, those that go on over such a turn are no shading that somebody meant;
 * beside such edges, over one like the second. */
#define NEVER_SMOOTH  (60 * DEGREE)
#define HARDLY_SMOOTH (45 * DEGREE)
/* A rounding ends in a face that is so many times as wide as its widest strip. */
#define ENDS_IN_FACE 1.75
/* Edges in smooth surroundings turn by this many times as much as those next to them. */
#define STANDS_ALONE 2.0
/* Rims of chamfers turn by more than this. */
#define RING_TURN (18 * DEGREE)
enum { SIDE_RINGS = 3, STEPS_MOST = 10, FACES_MOST = 24, SIDE_FACES_MOST = 64 };

typedef struct vector {
    double x, y, z;
} vector;

static vector vector_of(vec3 p)
{
    return (vector){p.x, p.y, p.z};
}

static vector minus(vector a, vector b)
{
    return (vector){a.x - b.x, a.y - b.y, a.z - b.z};
}

static vector along(vector a, double s, vector d)
{
    return (vector){a.x + s * d.x, a.y + s * d.y, a.z + s * d.z};
}

static vector cross(vector a, vector b)
{
    return (vector){a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

static double dot(vector a, vector b)
{
    return a.x * b.x + a.y * b.y + a.z * b.z;
}

static vector unit(vector a)
{
    double length = sqrt(dot(a, a));
    return length > 0 ? (vector){a.x / length, a.y / length, a.z / length} : a;
}

static double angle_between(vector a, vector b)
{
    vector c = cross(a, b);
    return atan2(sqrt(dot(c, c)), dot(a, b));
}

static uint32_t half_next(uint32_t h)
{
    return h % 3 == 2 ? h - 2 : h + 1;
}

/* --- what the file's normals say ------------------------------------------------------------------------- */

enum { SHADING_BITS = 10, SHADING_TOP = (1 << SHADING_BITS) - 1 };

uint32_t shading_pack(vec3 n)
{
    const float from[3] = {n.x, n.y, n.z};
    uint32_t    out = 0;
    for (int k = 0; k < 3; k++) {
        float at = (from[k] * 0.5f + 0.5f) * SHADING_TOP + 0.5f;
        out = out << SHADING_BITS | (at > 0 ? at < SHADING_TOP ? (uint32_t)at : SHADING_TOP : 0);
    }
    return out;
}

static vector shading_unpack(uint32_t packed)
{
    double at[3];
    for (int k = 3; k-- > 0; packed >>= SHADING_BITS)
        at[k] = (double)(packed & SHADING_TOP) / SHADING_TOP * 2 - 1;
    return unit((vector){at[0], at[1], at[2]});
}

static bool is_one_normal(uint32_t a, uint32_t b)
{
    return a == b || angle_between(shading_unpack(a), shading_unpack(b)) < ONE_NORMAL;
}

static edge_shading shading_of(const uint32_t *packed, uint32_t half, uint32_t other)
{
    const uint32_t a = packed[half], b = packed[half_next(half)], c = packed[half_next(other)], d = packed[other];
    if (a == SHADING_NONE || b == SHADING_NONE || c == SHADING_NONE || d == SHADING_NONE)
        return SHADED_UNKNOWN;
    return is_one_normal(a, c) && is_one_normal(b, d) ? SHADED_SMOOTH : SHADED_SPLIT;
}

uint8_t *shading_judge(const edge_mesh *m, const uint32_t *opposite, const uint32_t *packed, bool *mixed)
{
    size_t   counts[3] = {0};
    uint8_t *out = mem_calloc((size_t)m->face_count * 3 + 1, 1);
    for (uint32_t h = 0; out && h < 3 * m->face_count; h++) {
        uint32_t other = opposite[h];
        if (other == EDGE_NO_FACE)
            continue;
        out[h] = (uint8_t)shading_of(packed, h, other);
        /* Within a plane normals are one whatever was meant. */
        if (angle_between(vector_of(m->normals[h / 3]), vector_of(m->normals[other / 3])) > ONE_NORMAL)
            counts[out[h]]++;
    }
    *mixed = counts[SHADED_SPLIT] * 200 > counts[SHADED_SMOOTH] && counts[SHADED_SMOOTH] * 50 > counts[SHADED_SPLIT];
    for (uint32_t h = 0; out && h < 3 * m->face_count; h++)
        if (out[h] == SHADED_SPLIT && !*mixed)
            out[h] = SHADED_UNKNOWN;
    return out;
}

/* --- the mesh around an edge ----------------------------------------------------------------------------- */

typedef enum crease_verdict { NO_CREASE, MAY_BELONG, IS_CREASE, IS_NARROW } crease_verdict;

typedef struct judge {
    edge_mesh          *m;
    const crease_facts *facts;
    uint8_t            *verdicts; /* per edge */
    uint32_t           *stamps;   /* per face: the last edge side that it was counted for; NULL: not needed */
    uint32_t            stamp;
    double              noise, mean_edge, size; /* radians; noise below 0: the mesh is no sampling */
} judge;

static vector position(const edge_mesh *m, uint32_t half)
{
    return vector_of(m->positions[m->faces[half / 3][half % 3]]);
}

static vector face_normal(const edge_mesh *m, uint32_t face)
{
    return vector_of(m->normals[face]);
}

/* By how much the surface turns over a half-edge, above 0 where the winding makes it convex. */
static double turn_over(const edge_mesh *m, uint32_t half, uint32_t other)
{
    vector n = face_normal(m, half / 3), o = face_normal(m, other / 3),
           edge = minus(position(m, half_next(half)), position(m, half));
    double turn = angle_between(n, o);
    return dot(cross(n, o), edge) < 0 ? -turn : turn;
}

/* The half-edge of an edge's first face, EDGE_NO_FACE where its faces do not pair. */
static uint32_t half_of(const judge *j, const mesh_edge *e)
{
    const uint32_t *corners = j->m->faces[e->face[0]];
    uint32_t        k = corners[0] == e->vertex[0] ? 0 : corners[1] == e->vertex[0] ? 1 : 2, half = 3 * e->face[0] + k;
    return j->facts->opposite[half] == EDGE_NO_FACE ? EDGE_NO_FACE : half;
}

/* --- roundings ------------------------------------------------------------------------------------------- */

typedef struct step {
    double width, turn;
} step;

/* Where a straight way through a face leaves it: the half-edge and the distance. */
static uint32_t leave_face(const edge_mesh *m, uint32_t entered, vector from, vector direction, double *distance)
{
    vector   normal = face_normal(m, entered / 3);
    uint32_t half = half_next(entered), found = EDGE_NO_FACE;
    *distance = INFINITY;
    for (int k = 0; k < 2; k++, half = half_next(half)) {
        vector a = position(m, half),
               side = cross(minus(position(m, half_next(half)), a), normal); /* out of the face */
        double speed = dot(direction, side), away = dot(minus(a, from), side);
        if (speed > 0 && away / speed < *distance) {
            *distance = fmax(away / speed, 0);
            found = half;
        }
    }
    return found;
}

/* A way straight on from an edge over the faces beside it. */
typedef struct strip_walk {
    uint32_t half; /* that was passed last */
    vector   at, direction;
    double   least; /* what turns by less is part of a face */
    int      faces;
} strip_walk;

static strip_walk walk_from(const edge_mesh *m, uint32_t half, double own)
{
    vector a = position(m, half), b = position(m, half_next(half)), edge = unit(minus(b, a));
    return (strip_walk){half, along(a, 0.5, minus(b, a)), cross(face_normal(m, half / 3), edge),
                        FLAT_FRACTION * fabs(own), 0};
}

/* Does the surface turn by less than that? As turn_over says, but most edges on the way do not need an arc. */
static bool is_flat(const edge_mesh *m, uint32_t half, uint32_t other, double least)
{
    vector n = face_normal(m, half / 3), o = face_normal(m, other / 3), c = cross(n, o);
    double cosine = dot(n, o), most = 0.999 * least * cosine; /* no arc is longer than its tangent */
    return cosine > 0 && dot(c, c) < most * most;
}

/* The next edge that turns, and how far away it is; false where the way ends before, or where it is farther away than
 * `most`. */
static bool next_step(const judge *j, strip_walk *w, double most, step *out)
{
    const edge_mesh *m = j->m;
    double           width = 0;
    for (; w->faces < FACES_MOST; w->faces++) {
        double   distance;
        uint32_t left = leave_face(m, w->half, w->at, w->direction, &distance);
        if (left == EDGE_NO_FACE || j->facts->opposite[left] == EDGE_NO_FACE)
            return false;
        width += distance;
        if (width > most)
            return false;
        vector rim = unit(minus(position(m, half_next(left)), position(m, left))),
               out_of = cross(rim, face_normal(m, left / 3));
        w->at = along(w->at, distance, w->direction);
        w->half = j->facts->opposite[left];
        double lengthways = dot(w->direction, rim), across = dot(w->direction, out_of),
               turn = is_flat(m, left, w->half, w->least) ? 0 : turn_over(m, left, w->half);
        bool turns = fabs(turn) >= w->least;
        if (turns && across < ACROSS) /* bent along the way, too: no strip */
            return false;
        vector into = cross(rim, face_normal(m, w->half / 3));
        w->direction = (vector){lengthways * rim.x + across * into.x, lengthways * rim.y + across * into.y,
                                lengthways * rim.z + across * into.z};
        if (turns) {
            w->faces++;
            *out = (step){width, turn};
            return true;
        }
    }
    return false;
}

/* The next edges that turn, at most so many. */
static int find_steps(const judge *j, uint32_t half, double own, step *out, int most)
{
    strip_walk w = walk_from(j->m, half, own);
    int        count = 0;
    while (count < most && next_step(j, &w, INFINITY, &out[count]))
        count++;
    return count;
}

static bool is_alike(double a, double b)
{
    return a <= ALIKE * b && b <= ALIKE * a;
}

/* Three steps in a row, with what lies between them. */
static bool is_run(const double turns[3], double first_width, double last_width)
{
    double size[3];
    for (int k = 0; k < 3; k++) {
        size[k] = fabs(turns[k]);
        if ((turns[k] < 0) != (turns[0] < 0) || size[k] >= STEP_MOST)
            return false;
    }
    if (!is_alike(first_width, last_width))
        return false;
    bool first = is_alike(size[0], size[1]), last = is_alike(size[1], size[2]);
    return (first && last) || (first && size[1] <= HALF_STEP * size[2] && size[2] <= size[1]) ||
           (last && size[1] <= HALF_STEP * size[0] && size[0] <= size[1]);
}

static bool is_rounding(const judge *j, uint32_t half, double own)
{
    step after[STEPS_MOST], before[STEPS_MOST];
    if (fabs(own) >= STEP_MOST)
        return false;
    int n = find_steps(j, half, own, after, 2), p = find_steps(j, j->facts->opposite[half], own, before, 2);
    if (n && p && is_run((const double[3]){before[0].turn, own, after[0].turn}, before[0].width, after[0].width))
        return true;
    if (n == 2 && is_run((const double[3]){own, after[0].turn, after[1].turn}, after[0].width, after[1].width))
        return true;
    return p == 2 && is_run((const double[3]){own, before[0].turn, before[1].turn}, before[0].width, before[1].width);
}

/* One side of a rounding: by how much it turns on the same way, over how many steps, its widest strip, and the strip of
 * the face that it ends in, infinite where that is so wide that it ends any rounding. */
typedef struct turning {
    double turn, widest, beyond;
    int    count;
} turning;

static turning turn_within(const judge *j, uint32_t half, double own, double width)
{
    strip_walk w = walk_from(j->m, half, own);
    turning    out = {0, 0, INFINITY, 0};
    step       next;
    /* No farther than is asked for: no strip is wider than `width`, so that what is wider than that by enough is. */
    const double enough = ENDS_IN_FACE * width;
    while (next_step(j, &w, enough, &next)) {
        width -= next.width;
        if (width < 0 || (next.turn < 0) != (own < 0)) {
            out.beyond = (next.turn < 0) != (own < 0) ? INFINITY : next.width;
            return out;
        }
        out.turn += fabs(next.turn);
        out.widest = fmax(out.widest, next.width);
        if (++out.count == STEPS_MOST) {
            out.beyond = 0;
            return out;
        }
    }
    return out;
}

/* Is the edge the middle of a rounding that is too narrow to be seen as one? It ends on both sides in faces that are
 * wider than its strips: thin rods do not. */
static bool is_narrow_middle(const judge *j, uint32_t half, double own)
{
    double  width = NARROW * j->size;
    turning before = turn_within(j, j->facts->opposite[half], own, width);
    if (!(before.beyond > ENDS_IN_FACE * before.widest)) /* whatever there is on the other side */
        return false;
    turning after = turn_within(j, half, own, width);
    double  whole = before.turn + fabs(own) + after.turn, middle = (0.5 + MIDDLE_SLACK) * whole,
           face = ENDS_IN_FACE * fmax(before.widest, after.widest);
    return before.count + after.count > 0 && whole > fmax(NARROW_TURN, j->facts->angle) && before.turn <= middle &&
           after.turn <= middle && before.beyond > face && after.beyond > face;
}

/* Does hardly anything beside the edge turn? */
static bool stands_alone(const judge *j, uint32_t half, double own)
{
    const uint32_t sides[2] = {half, j->facts->opposite[half]};
    for (int k = 0; k < 2; k++) {
        step next[STEPS_MOST];
        if (find_steps(j, sides[k], own, next, 1) && fabs(next[0].turn) * STANDS_ALONE > fabs(own))
            return false;
    }
    return true;
}

/* --- samplings ------------------------------------------------------------------------------------------- */

static int compare_floats(const void *a, const void *b)
{
    float p = *(const float *)a, q = *(const float *)b;
    return (p > q) - (p < q);
}

/* By how much the turn over a half-edge differs from the mean of the four edges beside it; below 0 where one of these
 * is flat, sharp or a rim. */
static float unrest_at(const judge *j, uint32_t half)
{
    const uint32_t *opposite = j->facts->opposite;
    const uint32_t  other = opposite[half], around[4] = {half_next(half), half_next(half_next(half)), half_next(other),
                                                         half_next(half_next(other))};
    double          own = turn_over(j->m, half, other), sum = 0;
    if (fabs(own) > TORN || fabs(own) < FLAT)
        return -1;
    for (int k = 0; k < 4; k++) {
        if (opposite[around[k]] == EDGE_NO_FACE)
            return -1;
        double turn = turn_over(j->m, around[k], opposite[around[k]]);
        if (fabs(turn) > TORN || fabs(turn) < FLAT)
            return -1;
        sum += turn;
    }
    return (float)fabs(own - 0.25 * sum);
}

/* How much neighbouring edges of a sampling differ, by a measure that features do not disturb. */
static bool measure_noise(judge *j)
{
    const edge_mesh *m = j->m;
    const size_t     halves = (size_t)m->face_count * 3, most = 20000, stride = halves / most + 1,
                 wanted = (size_t)(SAMPLED_FRACTION * (double)((halves + stride - 1) / stride));
    float *unrests = mem_alloc((halves / stride + 2) * sizeof *unrests);
    size_t count = 0, asked = 0;
    double length = 0;
    j->noise = -1;
    for (size_t h = 0; unrests && h < halves; h += stride) {
        vector edge = minus(position(m, half_next((uint32_t)h)), position(m, (uint32_t)h));
        length += sqrt(dot(edge, edge));
        asked++;
        bool  hopeless = count + (halves - h) / stride + 1 < wanted; /* too many had no rest already */
        float own = hopeless || j->facts->opposite[h] == EDGE_NO_FACE ? -1 : unrest_at(j, (uint32_t)h);
        if (own >= 0)
            unrests[count++] = own;
    }
    j->mean_edge = asked ? length / (double)asked : 0;
    if (count && (double)count > SAMPLED_FRACTION * (double)asked && j->mean_edge < SAMPLED_EDGE * j->size) {
        qsort(unrests, count, sizeof *unrests, compare_floats);
        j->noise = 1.4826 * unrests[count / 2];
    }
    bool good = unrests != NULL;
    mem_free(unrests);
    return good;
}

/* The mean normal of the faces that lie within a few rings to one side of an edge and not beyond other creases. */
static vector side_normal(judge *j, uint32_t half, double barrier, int *faces)
{
    const edge_mesh *m = j->m;
    uint32_t         queue[SIDE_FACES_MOST], count = 0, next = 0;
    vector           a = position(m, half), sum = {0, 0, 0},
           inwards = cross(face_normal(m, half / 3), minus(position(m, half_next(half)), a));
    queue[count++] = half / 3;
    j->stamps[half / 3] = ++j->stamp;
    for (int ring = 0; ring <= SIDE_RINGS; ring++)
        for (uint32_t end = count; next < end; next++) {
            uint32_t f = queue[next];
            vector   p = position(m, 3 * f),
                   area = cross(minus(position(m, 3 * f + 1), p), minus(position(m, 3 * f + 2), p));
            sum = along(sum, 1, area);
            for (uint32_t k = 0; k < 3 && ring < SIDE_RINGS; k++) {
                uint32_t other = j->facts->opposite[3 * f + k];
                if (other == EDGE_NO_FACE || j->stamps[other / 3] == j->stamp || count == SIDE_FACES_MOST)
                    continue;
                vector beyond = minus(position(m, half_next(half_next(other))), a);
                if (dot(beyond, inwards) <= 0 || fabs(turn_over(m, 3 * f + k, other)) > barrier)
                    continue;
                j->stamps[other / 3] = j->stamp;
                queue[count++] = other / 3;
            }
        }
    *faces = (int)count;
    return unit(sum);
}

/* Does the surface of a sampling turn here, and not just this edge of it, and not all around? */
static bool is_sampled_crease(judge *j, uint32_t half, double own)
{
    int    counts[2];
    double barrier = fmax(1.5 * j->facts->angle, 3 * j->noise);
    vector a = side_normal(j, half, barrier, &counts[0]),
           b = side_normal(j, j->facts->opposite[half], barrier, &counts[1]);
    double turn = angle_between(a, b), rings = sqrt(counts[0] < counts[1] ? counts[0] : counts[1]);
    return turn > fmax(0.67 * j->facts->angle, 3 * j->noise / rings) && fabs(own) > CONCENTRATED * turn;
}

/* Does hardly any edge lie in a plane, and do the file's normals not say which are sharp? So are animals and faces;
 * what is constructed has flat faces. */
static bool is_hand_made(const edge_mesh *m, const crease_facts *facts)
{
    return !facts->mixed && m->edge_count > BENT_FRACTION * m->all_edges;
}

/* --- chains ---------------------------------------------------------------------------------------------- */

/* Edges that may be creases, by their vertices. */
typedef struct crease_net {
    uint32_t *starts, *edges; /* per vertex, and one more */
    uint32_t *stack;
} crease_net;

static bool open_net(crease_net *n, const judge *j)
{
    const edge_mesh *m = j->m;
    n->starts = mem_calloc((size_t)m->vertex_count + 2, sizeof *n->starts);
    n->edges = mem_alloc(((size_t)m->edge_count * 2 + 1) * sizeof *n->edges);
    n->stack = mem_alloc(((size_t)m->edge_count + 1) * sizeof *n->stack);
    if (!n->starts || !n->edges || !n->stack)
        return false;
    for (uint32_t i = 0; i < m->edge_count; i++)
        for (int k = 0; k < 2 && j->verdicts[i] != NO_CREASE; k++)
            n->starts[m->edges[i].vertex[k] + 2]++;
    for (uint32_t v = 0; v < m->vertex_count; v++)
        n->starts[v + 2] += n->starts[v + 1];
    for (uint32_t i = 0; i < m->edge_count; i++)
        for (int k = 0; k < 2 && j->verdicts[i] != NO_CREASE; k++)
            n->edges[n->starts[m->edges[i].vertex[k] + 1]++] = i;
    return true;
}

static void close_net(crease_net *n)
{
    mem_free(n->starts);
    mem_free(n->edges);
    mem_free(n->stack);
}

static vector direction_of(const edge_mesh *m, const mesh_edge *e, uint32_t from)
{
    vector a = vector_of(m->positions[e->vertex[0]]), b = vector_of(m->positions[e->vertex[1]]);
    return unit(e->vertex[0] == from ? minus(b, a) : minus(a, b));
}

/* Creases go on along what turns half as much, straight on. */
static void go_on(judge *j, const crease_net *n)
{
    const edge_mesh *m = j->m;
    size_t           depth = 0;
    for (uint32_t i = 0; i < m->edge_count; i++)
        if (j->verdicts[i] == IS_CREASE)
            n->stack[depth++] = i;
    while (depth > 0) {
        const mesh_edge *e = &m->edges[n->stack[--depth]];
        for (int k = 0; k < 2; k++)
            for (uint32_t i = n->starts[e->vertex[k]]; i < n->starts[e->vertex[k] + 1]; i++) {
                const mesh_edge *other = &m->edges[n->edges[i]];
                if (j->verdicts[n->edges[i]] != MAY_BELONG ||
                    dot(direction_of(m, e, e->vertex[k]), direction_of(m, other, e->vertex[k])) > -ACROSS)
                    continue;
                j->verdicts[n->edges[i]] = IS_CREASE;
                n->stack[depth++] = n->edges[i];
            }
    }
}

/* Does one edge go on as another one, without turning back? */
static bool goes_on(const judge *j, uint32_t first, uint32_t second, uint32_t vertex)
{
    const edge_mesh *m = j->m;
    return dot(direction_of(m, &m->edges[first], vertex), direction_of(m, &m->edges[second], vertex)) < -0.5;
}

/* Lines of one verdict that hang together with an edge: when they are shorter than `least`, they are none. Narrow
 * roundings that go to and fro are none either. */
static void drop_short(judge *j, const crease_net *n, uint32_t start, uint8_t *seen, double least)
{
    const edge_mesh *m = j->m;
    const uint8_t    verdict = j->verdicts[start];
    size_t           depth = 0, end = 0;
    double           length = 0;
    n->stack[end++] = start;
    seen[start] = 1;
    for (; depth < end; depth++) {
        const mesh_edge *e = &m->edges[n->stack[depth]];
        vector           edge = minus(vector_of(m->positions[e->vertex[0]]), vector_of(m->positions[e->vertex[1]]));
        length += sqrt(dot(edge, edge));
        for (int k = 0; k < 2; k++)
            for (uint32_t i = n->starts[e->vertex[k]]; i < n->starts[e->vertex[k] + 1]; i++)
                if (!seen[n->edges[i]] && j->verdicts[n->edges[i]] == verdict &&
                    (verdict != IS_NARROW || goes_on(j, n->stack[depth], n->edges[i], e->vertex[k]))) {
                    seen[n->edges[i]] = 1;
                    n->stack[end++] = n->edges[i];
                }
    }
    for (size_t i = 0; i < end && length < least; i++)
        j->verdicts[n->stack[i]] = NO_CREASE;
}

/* The crease at a vertex that is not `from`, and how many there are, `from` among them. */
static uint32_t crease_at(const judge *j, const crease_net *n, uint32_t vertex, uint32_t from, int *count)
{
    uint32_t found = from;
    *count = 0;
    for (uint32_t i = n->starts[vertex]; i < n->starts[vertex + 1]; i++)
        if (j->verdicts[n->edges[i]] == IS_CREASE) {
            found = n->edges[i] != from ? n->edges[i] : found;
            ++*count;
        }
    return found;
}

/* Creases of samplings fray: a short one that begins anywhere and ends on a longer one is noise. */
static void drop_twig(judge *j, const crease_net *n, uint32_t vertex, double least)
{
    const edge_mesh *m = j->m;
    int              degree;
    size_t           count = 0;
    double           length = 0;
    uint32_t         edge = crease_at(j, n, vertex, EDGE_NO_FACE, &degree);
    if (degree != 1)
        return;
    do {
        const mesh_edge *e = &m->edges[edge];
        vector           way = minus(vector_of(m->positions[e->vertex[0]]), vector_of(m->positions[e->vertex[1]]));
        length += sqrt(dot(way, way));
        n->stack[count++] = edge;
        vertex = e->vertex[0] == vertex ? e->vertex[1] : e->vertex[0];
        edge = crease_at(j, n, vertex, edge, &degree);
    } while (degree == 2 && length < least && count < m->edge_count);
    for (size_t i = 0; degree > 2 && length < least && i < count; i++)
        j->verdicts[n->stack[i]] = NO_CREASE;
}

/* Does the surface go on turning beside an edge and end as the edge begins? So do roundings of two strips. */
static bool is_rim_of_rounding(const judge *j, uint32_t half, double own)
{
    const uint32_t sides[2] = {half, j->facts->opposite[half]};
    for (int k = 0; k < 2; k++) {
        step next[STEPS_MOST];
        if (find_steps(j, sides[k], own, next, 2) == 2 && (next[0].turn < 0) == (own < 0) &&
            (next[1].turn < 0) == (own < 0) && fabs(next[0].turn) * ALIKE > fabs(own) &&
            is_alike(fabs(next[1].turn), fabs(own)) && is_alike(next[0].width, next[1].width))
            return true;
    }
    return false;
}

/* Is an edge that turns by less than the crease angle sharp, if it is part of a ring? */
static bool may_be_ring(const judge *j, uint32_t edge)
{
    const mesh_edge *e = &j->m->edges[edge];
    uint32_t         half = e->flags & (EDGE_BORDER | EDGE_TWISTED) ? EDGE_NO_FACE : half_of(j, e);
    if (j->verdicts[edge] != MAY_BELONG || half == EDGE_NO_FACE)
        return false;
    double       own = turn_over(j->m, half, j->facts->opposite[half]);
    edge_shading shading = j->facts->shading ? (edge_shading)j->facts->shading[half] : SHADED_UNKNOWN;
    return fabs(own) > RING_TURN && shading != SHADED_SMOOTH &&
           (shading == SHADED_SPLIT || !is_rim_of_rounding(j, half, own));
}

/* Rims of chamfers are creases, though they turn by little. Not of samplings, and not of shapes that bend everywhere.
 */
static bool close_rings(judge *j, const crease_net *n)
{
    const edge_mesh *m = j->m;
    if (j->noise >= 0 || is_hand_made(m, j->facts))
        return true;
    uint8_t *states = mem_calloc((size_t)m->edge_count + 1, 1);
    bool     good = states != NULL;
    for (uint32_t i = 0; good && i < m->edge_count; i++)
        states[i] = j->verdicts[i] == IS_CREASE ? RING_LINE : may_be_ring(j, i) ? RING_MAY : RING_NONE;
    good = good && crease_rings_close(m, n->starts, n->edges, states);
    for (uint32_t i = 0; good && i < m->edge_count; i++)
        if (states[i] == RING_LINE)
            j->verdicts[i] = IS_CREASE;
    mem_free(states);
    return good;
}

static bool follow_chains(judge *j)
{
    crease_net n = {0};
    uint8_t   *seen = mem_calloc((size_t)j->m->edge_count + 1, 1);
    bool       good = seen && open_net(&n, j);
    if (good)
        go_on(j, &n);
    good = good && close_rings(j, &n);
    double least = fmax(LONG_EDGES * j->mean_edge, LONG_FRACTION * j->size);
    for (uint32_t i = 0; good && i < j->m->edge_count; i++) {
        bool narrow = j->verdicts[i] == IS_NARROW;
        if (!seen[i] && (narrow || (j->verdicts[i] == IS_CREASE && j->noise >= 0)))
            drop_short(j, &n, i, seen, narrow ? NARROW_LONG * j->size : least);
    }
    for (uint32_t v = 0; good && j->noise >= 0 && v < j->m->vertex_count; v++)
        drop_twig(j, &n, v, least);
    close_net(&n);
    mem_free(seen);
    return good;
}

/* --- all ------------------------------------------------------------------------------------------------- */

static bool is_said(const edge_mesh *m, uint32_t half, uint32_t other)
{
    return m->said && (m->said[half] != SAID_NOTHING || m->said[other] != SAID_NOTHING);
}

/* Does an edge turn where faces around it do not, in a file that tells nothing of which are sharp? */
static bool is_lone(const judge *j, uint32_t half, double own)
{
    return j->noise < 0 && !j->facts->mixed && fabs(own) > j->facts->angle && stands_alone(j, half, own);
}

/* Is it part of a rounding, by what the file says or else by its shape? */
static bool is_round(const judge *j, uint32_t half, double own)
{
    const crease_facts *f = j->facts;
    edge_shading        shading = f->shading ? (edge_shading)f->shading[half] : SHADED_UNKNOWN;
    if (shading == SHADED_SMOOTH && (f->mixed || fabs(own) < HARDLY_SMOOTH))
        return f->mixed || !is_lone(j, half, own);
    return shading != SHADED_SPLIT && is_rounding(j, half, own);
}

static crease_verdict judge_edge(judge *j, const mesh_edge *e, uint32_t half)
{
    bool sharp = (e->flags & EDGE_CREASE) != 0;
    if (!sharp && is_flat(j->m, half, j->facts->opposite[half], fmin(0.5 * j->facts->angle, NARROW_STEP)))
        return NO_CREASE;
    double own = turn_over(j->m, half, j->facts->opposite[half]);
    bool   weak = !sharp && fabs(own) < 0.5 * j->facts->angle;
    if (j->noise >= 0 && (weak || is_round(j, half, own) || !is_sampled_crease(j, half, own)))
        return NO_CREASE;
    if (j->noise < 0 && (weak || is_round(j, half, own)))
        return fabs(own) > NARROW_STEP && is_narrow_middle(j, half, own) ? IS_NARROW : NO_CREASE;
    bool smooth = j->facts->shading && j->facts->shading[half] == SHADED_SMOOTH && fabs(own) < NEVER_SMOOTH;
    bool meant = !smooth || (fabs(own) > STEP_MOST && is_lone(j, half, own));
    return sharp && meant ? IS_CREASE : MAY_BELONG;
}

/* Flags by verdict; what is no crease may be an outline. */
static void set_flags(judge *j)
{
    for (uint32_t i = 0; i < j->m->edge_count; i++) {
        mesh_edge *e = &j->m->edges[i];
        uint32_t   half = e->flags & (EDGE_BORDER | EDGE_TWISTED) ? EDGE_NO_FACE : half_of(j, e);
        if (half == EDGE_NO_FACE || is_said(j->m, half, j->facts->opposite[half]))
            continue;
        if (j->verdicts[i] >= IS_CREASE)
            e->flags =
                (e->flags & ~(uint32_t)EDGE_CANDIDATE) | EDGE_CREASE | (j->verdicts[i] == IS_NARROW ? EDGE_ROUNDED : 0);
        else if (e->flags & EDGE_CREASE)
            e->flags = (e->flags & ~(uint32_t)EDGE_CREASE) | EDGE_CANDIDATE | EDGE_QUIET;
    }
}

static bool has_creases(const edge_mesh *m)
{
    for (uint32_t i = 0; i < m->edge_count; i++)
        if (m->edges[i].flags & EDGE_CREASE)
            return true;
    return false;
}

static double size_of(const edge_mesh *m)
{
    box3 box = box3_empty();
    for (uint32_t i = 0; i < m->vertex_count; i++) { /* as box3_with_point, which would be called for each */
        vec3 p = m->positions[i];
        box.min = (vec3){box.min.x < p.x ? box.min.x : p.x, box.min.y < p.y ? box.min.y : p.y,
                         box.min.z < p.z ? box.min.z : p.z};
        box.max = (vec3){box.max.x > p.x ? box.max.x : p.x, box.max.y > p.y ? box.max.y : p.y,
                         box.max.z > p.z ? box.max.z : p.z};
    }
    return m->vertex_count ? box3_diagonal(box) : 0;
}

bool creases_measure(crease_measure *out, edge_mesh *m, const crease_facts *facts)
{
    judge j = {.m = m, .facts = facts, .size = size_of(m)};
    bool  good = measure_noise(&j);
    m->sampling = (edge_sampling){j.noise >= 0 && j.mean_edge < OUTLINE_EDGE * j.size, (float)fmax(j.noise, 0),
                                  (float)j.mean_edge, (float)j.size};
    *out = (crease_measure){j.noise, j.mean_edge, j.size};
    return good;
}

bool creases_judge(edge_mesh *m, const crease_facts *facts, const crease_measure *measured)
{
    judge j = {
        .m = m, .facts = facts, .noise = measured->noise, .mean_edge = measured->mean_edge, .size = measured->size};
    bool good;
    if (!has_creases(m))
        return true;
    j.verdicts = mem_calloc((size_t)m->edge_count + 1, 1);
    j.stamps = mem_calloc((size_t)m->face_count + 1, sizeof *j.stamps);
    good = j.verdicts && j.stamps;
    for (uint32_t i = 0; good && i < m->edge_count; i++) {
        const mesh_edge *e = &m->edges[i];
        uint32_t         half = e->flags & (EDGE_BORDER | EDGE_TWISTED) ? EDGE_NO_FACE : half_of(&j, e);
        if (half != EDGE_NO_FACE && is_said(m, half, facts->opposite[half]))
            j.verdicts[i] = e->flags & EDGE_CREASE ? IS_CREASE : NO_CREASE;
        else if (half != EDGE_NO_FACE)
            j.verdicts[i] = (uint8_t)judge_edge(&j, e, half);
    }
    good = good && follow_chains(&j);
    if (good) {
        set_flags(&j);
        good = crease_chains_judge(m, facts, measured, is_hand_made(m, facts));
    }
    mem_free(j.verdicts);
    mem_free(j.stamps);
    return good;
}
