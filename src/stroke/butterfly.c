/* New vertices lie at the middles of edges, moved by their neighbourhood. Where the neighbourhood would reach over
 * a sharp edge, a reflected vertex stands for what lies beyond, so that each side is refined as if the other one
 * were not there. */
#include "stroke/butterfly.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"

/* Two sharp edges that turn by more than this make a corner: cosine of 75°. */
#define CORNER_COSINE 0.25881904510252074
#define PI            3.14159265358979323846
enum { SHORT_BUCKET = 24, FACES_MAX = 1 << 27, FAN_MAX = 1 << 16 };

typedef struct position {
    double x, y, z;
} position;

/* A half-edge in the bucket of its lower vertex. */
typedef struct bucket_entry {
    uint32_t high, half;
} bucket_entry;

/* What is known while one level is refined. */
typedef struct refiner {
    const vec3      *positions;
    butterfly_level *level;
    uint32_t        *edges; /* per half-edge: the number of its edge */
    uint32_t         edge_count;
    uint32_t (*along)[2]; /* per vertex: those that sharp edges lead to */
    uint8_t *sharp_count; /* per vertex, 3 for more */
} refiner;

static position position_of(const refiner *r, uint32_t v)
{
    return (position){r->positions[v].x, r->positions[v].y, r->positions[v].z};
}

static position add(position sum, double fraction, position p)
{
    return (position){sum.x + fraction * p.x, sum.y + fraction * p.y, sum.z + fraction * p.z};
}

static uint32_t begin_of(const butterfly_level *l, uint32_t h)
{
    return l->faces[h / 3][h % 3];
}

static uint32_t end_of(const butterfly_level *l, uint32_t h)
{
    return begin_of(l, half_edge_next(h));
}

static uint32_t third_of(const butterfly_level *l, uint32_t h)
{
    return begin_of(l, half_edge_before(h));
}

/* --- edges ---------------------------------------------------------------------------------------------- */

static int compare_entries(const void *a, const void *b)
{
    const bucket_entry *p = a, *q = b;
    if (p->high != q->high)
        return p->high < q->high ? -1 : 1;
    return p->half < q->half ? -1 : p->half > q->half;
}

static void sort_bucket(bucket_entry *entries, size_t count)
{
    if (count > SHORT_BUCKET) {
        qsort(entries, count, sizeof *entries, compare_entries);
        return;
    }
    for (size_t i = 1; i < count; i++) {
        bucket_entry moved = entries[i];
        size_t       k = i;
        for (; k > 0 && entries[k - 1].high > moved.high; k--)
            entries[k] = entries[k - 1];
        entries[k] = moved;
    }
}

/* All half-edges of one edge: two in opposite directions belong together. */
static void take_edge(butterfly_level *l, const bucket_entry *group, size_t count)
{
    bool pair = count == 2 && begin_of(l, group[0].half) == end_of(l, group[1].half) &&
                begin_of(l, group[0].half) != begin_of(l, group[1].half);
    bool sharp = !pair;
    for (size_t i = 0; i < count; i++) {
        sharp = sharp || l->sharp[group[i].half];
        l->opposite[group[i].half] = pair ? group[1 - i].half : BUTTERFLY_NONE;
    }
    for (size_t i = 0; i < count; i++)
        l->sharp[group[i].half] = sharp;
}

static void take_edges(refiner *r, const uint32_t *starts, bucket_entry *entries)
{
    butterfly_level *l = r->level;
    for (uint32_t v = 0; v < l->vertex_count; v++) {
        bucket_entry *bucket = entries + starts[v];
        size_t        size = starts[v + 1] - starts[v];
        sort_bucket(bucket, size);
        for (size_t begin = 0, end = 0; begin < size; begin = end) {
            while (end < size && bucket[end].high == bucket[begin].high)
                r->edges[bucket[end++].half] = r->edge_count;
            take_edge(l, bucket + begin, end - begin);
            r->edge_count++;
        }
    }
}

/* Numbers the edges, pairs half-edges and makes `sharp` the same on both sides. */
static bool find_edges(refiner *r)
{
    butterfly_level *l = r->level;
    uint32_t         halves = 3 * l->face_count;
    uint32_t        *starts = mem_calloc((size_t)l->vertex_count + 2, sizeof *starts);
    bucket_entry    *entries = mem_alloc((size_t)halves * sizeof *entries);
    bool             good = starts && entries;
    for (uint32_t h = 0; h < halves && good; h++) {
        uint32_t a = begin_of(l, h), b = end_of(l, h);
        starts[(a < b ? a : b) + 2]++;
    }
    for (uint32_t v = 0; v < l->vertex_count && good; v++)
        starts[v + 2] += starts[v + 1];
    /* Counted two positions on, so that filling, which moves each start to its end, leaves them right. */
    for (uint32_t h = 0; h < halves && good; h++) {
        uint32_t a = begin_of(l, h), b = end_of(l, h);
        entries[starts[(a < b ? a : b) + 1]++] = (bucket_entry){a < b ? b : a, h};
    }
    if (good)
        take_edges(r, starts, entries);
    mem_free(starts);
    mem_free(entries);
    return good;
}

/* --- sharp edges ---------------------------------------------------------------------------------------- */

static void note_sharp(refiner *r, uint32_t v, uint32_t to)
{
    uint8_t known = r->sharp_count[v];
    for (int i = 0; i < known && i < 2; i++)
        if (r->along[v][i] == to)
            return;
    if (known < 2)
        r->along[v][known] = to;
    if (known < 3)
        r->sharp_count[v]++;
}

static void find_sharp(refiner *r)
{
    const butterfly_level *l = r->level;
    for (uint32_t h = 0; h < 3 * l->face_count; h++)
        if (l->sharp[h]) {
            note_sharp(r, begin_of(l, h), end_of(l, h));
            note_sharp(r, end_of(l, h), begin_of(l, h));
        }
}

/* The vertex with which a sharp edge that comes from `from` goes on beyond `v`; `v` itself where it ends. */
static uint32_t goes_on(const refiner *r, uint32_t from, uint32_t v)
{
    if (r->sharp_count[v] != 2)
        return v;
    uint32_t to = r->along[v][0] == from ? r->along[v][1] : r->along[v][0];
    position p = position_of(r, v), in = add(p, -1, position_of(r, from)), out = add(position_of(r, to), -1, p);
    double   cosine = in.x * out.x + in.y * out.y + in.z * out.z;
    double lengths = sqrt((in.x * in.x + in.y * in.y + in.z * in.z) * (out.x * out.x + out.y * out.y + out.z * out.z));
    return cosine < CORNER_COSINE * lengths ? v : to;
}

/* Four points of the curve; an end counts twice. */
static position middle_of_sharp(const refiner *r, uint32_t a, uint32_t b)
{
    position sum = {0, 0, 0};
    sum = add(sum, 9.0 / 16, position_of(r, a));
    sum = add(sum, 9.0 / 16, position_of(r, b));
    sum = add(sum, -1.0 / 16, position_of(r, goes_on(r, b, a)));
    return add(sum, -1.0 / 16, position_of(r, goes_on(r, a, b)));
}

/* --- smooth edges --------------------------------------------------------------------------------------- */

/* The vertex beyond a half-edge of a triangle, seen from it; a reflected one where nothing is or counts. */
static position wing(const refiner *r, uint32_t h)
{
    const butterfly_level *l = r->level;
    if (!l->sharp[h])
        return position_of(r, third_of(l, l->opposite[h]));
    position ghost = position_of(r, begin_of(l, h));
    ghost = add(ghost, 1, position_of(r, end_of(l, h)));
    return add(ghost, -1, position_of(r, third_of(l, h)));
}

static position middle_of_regular(const refiner *r, uint32_t h)
{
    const butterfly_level *l = r->level;
    uint32_t               o = l->opposite[h];
    position               sum = {0, 0, 0};
    sum = add(sum, 0.5, position_of(r, begin_of(l, h)));
    sum = add(sum, 0.5, position_of(r, end_of(l, h)));
    sum = add(sum, 0.125, position_of(r, third_of(l, h)));
    sum = add(sum, 0.125, position_of(r, third_of(l, o)));
    sum = add(sum, -0.0625, wing(r, half_edge_next(h)));
    sum = add(sum, -0.0625, wing(r, half_edge_before(h)));
    sum = add(sum, -0.0625, wing(r, half_edge_next(o)));
    return add(sum, -0.0625, wing(r, half_edge_before(o)));
}

/* How many faces stand around the vertex that a half-edge begins at; 6 for those on sharp edges, which are taken as
 * regular. */
static uint32_t valence(const refiner *r, uint32_t h)
{
    const butterfly_level *l = r->level;
    if (r->sharp_count[begin_of(l, h)] > 0)
        return 6;
    uint32_t count = 0, at = h;
    do {
        at = l->opposite[half_edge_before(at)];
        count++;
    } while (at != h && at != BUTTERFLY_NONE && count < FAN_MAX);
    return at == h ? count : 6;
}

/* The fraction of the ring's vertex j of k, beginning with the one at the edge's other end. */
static double ring_fraction(uint32_t j, uint32_t k)
{
    static const double three[3] = {5.0 / 12, -1.0 / 12, -1.0 / 12}, four[4] = {3.0 / 8, 0, -1.0 / 8, 0};
    if (k == 3)
        return three[j];
    if (k == 4)
        return four[j];
    double turn = 2 * PI * j / k;
    return (0.25 + cos(turn) + 0.5 * cos(2 * turn)) / k;
}

/* From the ring around the vertex that the half-edge begins at. */
static position middle_from_ring(const refiner *r, uint32_t h, uint32_t count)
{
    const butterfly_level *l = r->level;
    position               sum = {0, 0, 0};
    double                 fractions = 0;
    uint32_t               at = h;
    for (uint32_t j = 0; j < count; j++) {
        double fraction = ring_fraction(j, count);
        sum = add(sum, fraction, position_of(r, end_of(l, at)));
        fractions += fraction;
        at = l->opposite[half_edge_before(at)];
    }
    return add(sum, 1 - fractions, position_of(r, begin_of(l, h)));
}

static position middle_of_smooth(const refiner *r, uint32_t h)
{
    uint32_t o = r->level->opposite[h], here = valence(r, h), there = valence(r, o);
    bool     odd_here = here != 6 && here >= 3, odd_there = there != 6 && there >= 3;
    if (!odd_here && !odd_there)
        return middle_of_regular(r, h);
    if (!odd_there)
        return middle_from_ring(r, h, here);
    if (!odd_here)
        return middle_from_ring(r, o, there);
    position sum = {0, 0, 0};
    sum = add(sum, 0.5, middle_from_ring(r, h, here));
    return add(sum, 0.5, middle_from_ring(r, o, there));
}

/* --- levels --------------------------------------------------------------------------------------------- */

static bool make_arrays(butterfly_level *l)
{
    l->faces = mem_alloc((size_t)l->face_count * sizeof *l->faces);
    l->opposite = mem_alloc((size_t)l->face_count * 3 * sizeof *l->opposite);
    l->sharp = mem_calloc((size_t)l->face_count * 3, 1);
    return l->faces && l->opposite && l->sharp;
}

static void put_middles(const refiner *r, vec3 *positions)
{
    const butterfly_level *l = r->level;
    for (uint32_t h = 0; h < 3 * l->face_count; h++) {
        uint32_t o = l->opposite[h];
        if (o != BUTTERFLY_NONE && o < h)
            continue;
        position p = l->sharp[h] ? middle_of_sharp(r, begin_of(l, h), end_of(l, h)) : middle_of_smooth(r, h);
        positions[l->vertex_count + r->edges[h]] = (vec3){(float)p.x, (float)p.y, (float)p.z};
    }
}

static void put_children(const refiner *r, butterfly_level *finer)
{
    const butterfly_level *l = r->level;
    for (uint32_t f = 0; f < l->face_count; f++) {
        uint32_t middles[3];
        for (uint32_t k = 0; k < 3; k++)
            middles[k] = l->vertex_count + r->edges[3 * f + k];
        for (uint32_t k = 0; k < 3; k++) {
            uint32_t *child = finer->faces[4 * f + k];
            child[k] = l->faces[f][k];
            child[(k + 1) % 3] = middles[k];
            child[(k + 2) % 3] = middles[(k + 2) % 3];
            finer->faces[4 * f + 3][k] = middles[(k + 1) % 3];
            finer->sharp[half_edge_first(3 * f + k)] = finer->sharp[half_edge_second(3 * f + k)] = l->sharp[3 * f + k];
        }
    }
}

static void refiner_release(refiner *r)
{
    mem_free(r->edges);
    mem_free(r->along);
    mem_free(r->sharp_count);
}

static bool refiner_open(refiner *r, const vec3 *positions, butterfly_level *l)
{
    *r = (refiner){.positions = positions, .level = l};
    r->edges = mem_alloc((size_t)l->face_count * 3 * sizeof *r->edges);
    r->along = mem_alloc(((size_t)l->vertex_count + 1) * sizeof *r->along);
    r->sharp_count = mem_calloc((size_t)l->vertex_count + 1, 1);
    if (!r->edges || !r->along || !r->sharp_count || !find_edges(r))
        return false;
    find_sharp(r);
    return true;
}

/* Adds a level. */
static bool refine_once(butterfly *b)
{
    butterfly_level *l = &b->levels[b->level_count - 1], *finer = l + 1;
    refiner          r;
    bool             good = refiner_open(&r, b->positions, l);
    if (good) {
        *finer = (butterfly_level){.vertex_count = l->vertex_count + r.edge_count, .face_count = 4 * l->face_count};
        b->level_count++;
        vec3 *positions = mem_realloc(b->positions, ((size_t)finer->vertex_count + 1) * sizeof *positions);
        b->positions = positions ? positions : b->positions;
        r.positions = b->positions;
        good = positions && make_arrays(finer);
    }
    if (good) {
        put_middles(&r, b->positions);
        put_children(&r, finer);
    }
    refiner_release(&r);
    return good;
}

/* Opposites of the last level, which nothing comes after. */
static bool finish_last(butterfly *b)
{
    refiner r;
    bool    good = refiner_open(&r, b->positions, &b->levels[b->level_count - 1]);
    refiner_release(&r);
    return good;
}

lmn_status butterfly_refine(butterfly *out, const vec3 *positions, uint32_t vertex_count, const uint32_t (*faces)[3],
                            uint32_t face_count, const uint8_t *sharp, int steps, lmn_error *error)
{
    memset(out, 0, sizeof *out);
    if (steps < 0 || steps > BUTTERFLY_STEPS_MAX || (uint64_t)face_count << 2 * steps > FACES_MAX)
        return error_set(error, LMN_LIMIT,
                         "a mesh of %u triangles cannot be refined %d times: that would be more than %d", face_count,
                         steps, FACES_MAX);
    butterfly_level *first = &out->levels[0];
    *first = (butterfly_level){.vertex_count = vertex_count, .face_count = face_count};
    out->level_count = 1;
    out->positions = mem_alloc(((size_t)vertex_count + 1) * sizeof *out->positions);
    bool good = out->positions && make_arrays(first);
    if (good) {
        memcpy(out->positions, positions, vertex_count * sizeof *positions);
        memcpy(first->faces, faces, face_count * sizeof *faces);
        if (sharp)
            memcpy(first->sharp, sharp, (size_t)face_count * 3);
    }
    for (int i = 0; i < steps && good; i++)
        good = refine_once(out);
    good = good && finish_last(out);
    if (!good)
        butterfly_release(out);
    return good ? LMN_OK : error_memory(error);
}

void butterfly_release(butterfly *b)
{
    for (uint32_t i = 0; i < b->level_count; i++) {
        mem_free(b->levels[i].faces);
        mem_free(b->levels[i].opposite);
        mem_free(b->levels[i].sharp);
    }
    mem_free(b->positions);
    memset(b, 0, sizeof *b);
}
