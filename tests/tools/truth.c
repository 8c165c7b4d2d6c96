/* Holds line drawings against the lines that a mesh truly has:
 *
 *     truth [--up y|z] [--angle DEG] [--width PX] [--show OUT.png] MODEL REPORT.json PICTURE.png …
 *
 * True lines are borders, edges between a face that is seen from the front and one that is seen from behind, edges that
 * turn by more than DEG (45), and where different pieces run through each other. Each is looked at along its length, by
 * rays against all triangles in doubles. The report, of any drawing with this view, has the camera; pictures are ink on
 * a light ground, of any size. Lines of pictures are WIDTH pixels wide at most, at 1024 pixels.
 *
 * What must be drawn and what may be are two things: edges that turn less, and what surfaces hide by so little that
 * numbers cannot tell, may be. Prints for each picture: the share of what must be there that has ink beside it, the
 * share of ink that is beside nothing that may be there, gaps and the longest of them, and the share of the page in
 * components of ink of less than 6 pixels. */
#include <jansson.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "limner/scene.h"
#include "picture.h"
#include "scene/scene.h"
#include "trace.h"
#include "vec.h"

#define DEGREE 0.017453292519943295
/* Edges that turn less are never lines. */
#define ANGLE_LEAST (12 * DEGREE)
/* Pieces that run through each other at less need not show it. */
#define MEET_LEAST (30 * DEGREE)
/* Fractions of the model's size: what is the same position; what is in front by so little that it may be either. */
#define SAME  2e-6
#define CLOSE 3e-4
/* Ink, 0 … 1. */
#define INK_LEAST   0.12
#define SPECK_LEAST 0.12F
enum { SPECK = 6, NOBODY = -1, GAP_LEAST = 2 };

typedef struct face {
    uint32_t v[3];
    dvec     normal; /* unit, by winding */
    double   facing; /* cosine to the viewer: above 0 from the front */
    uint32_t part, piece;
} face;

typedef struct half {
    uint32_t low, high, face;
    bool     forward;
} half;

/* A straight line that the model has. */
typedef struct line {
    dvec    ends[2];
    int64_t faces[2];
    bool    must, border;
} line;

/* A place on a line that is seen, in clip space. */
typedef struct place {
    float x, y, length; /* length: of the page's height */
    bool  must;
} place;

typedef struct truth {
    dvec   *points;
    face   *faces;
    line   *lines;
    place  *places;
    tracer *rays;
    size_t  point_count, face_count, line_count, line_capacity, place_count, place_capacity;
    double  size, angle;
    double  view[16], projection[16];
    bool    parallel;
    dvec    eye; /* direction to it in parallel projection */
} truth;

static void *grown(void *list, size_t count, size_t *capacity, size_t size)
{
    if (count < *capacity)
        return list;
    *capacity = *capacity ? 2 * *capacity : 1024;
    list = realloc(list, *capacity * size);
    if (!list)
        abort();
    return list;
}

/* --- the model ------------------------------------------------------------------------------------------- */

typedef struct corner {
    dvec     at;
    uint32_t part, index;
} corner;

static int compare_corners(const void *a, const void *b)
{
    const corner *p = a, *q = b;
    if (p->part != q->part)
        return p->part < q->part ? -1 : 1;
    if (p->at.x != q->at.x)
        return p->at.x < q->at.x ? -1 : 1;
    if (p->at.y != q->at.y)
        return p->at.y < q->at.y ? -1 : 1;
    return p->at.z != q->at.z ? (p->at.z < q->at.z ? -1 : 1) : 0;
}

static int compare_faces(const void *a, const void *b)
{
    uint32_t p[3], q[3];
    memcpy(p, ((const face *)a)->v, sizeof p);
    memcpy(q, ((const face *)b)->v, sizeof q);
    for (int i = 0; i < 2; i++)
        for (int k = 0; k < 2; k++) {
            uint32_t t;
            if (p[k] > p[k + 1])
                t = p[k], p[k] = p[k + 1], p[k + 1] = t;
            if (q[k] > q[k + 1])
                t = q[k], q[k] = q[k + 1], q[k + 1] = t;
        }
    return memcmp(p, q, sizeof p);
}

/* All corners of all parts, three a triangle, in the world. */
static corner *corners_of(const lmn_scene *scene, size_t *count)
{
    mat4   *worlds = scene_world_matrices(scene, NULL);
    corner *out = NULL;
    size_t  capacity = 0;
    *count = 0;
    for (size_t p = 0; p < scene->part_count; p++) {
        int32_t     n = scene->parts[p].node;
        const mesh *m = scene->nodes[n].mesh >= 0 ? &scene->meshes[scene->nodes[n].mesh] : NULL;
        for (size_t i = 0; m && i < m->primitive_count; i++)
            for (uint32_t k = 0; k < m->primitives[i].index_count; k++) {
                vec3 v = m->primitives[i].positions[m->primitives[i].indices[k]];
                out = grown(out, *count, &capacity, sizeof *out);
                out[*count] =
                    (corner){dmat_apply(worlds[n].m, dvec_of(v.x, v.y, v.z), 1, NULL), (uint32_t)p, (uint32_t)*count};
                (*count)++;
            }
    }
    mem_free(worlds);
    return out;
}

/* Corners of a part at one position are one; triangles without area and those that are there twice go. */
static void weld(truth *t, corner *corners, size_t count)
{
    uint32_t *number = malloc((count + 1) * sizeof *number);
    t->points = malloc((count + 1) * sizeof *t->points);
    t->faces = calloc(count / 3 + 1, sizeof *t->faces);
    uint32_t *parts = malloc((count + 1) * sizeof *parts);
    qsort(corners, count, sizeof *corners, compare_corners);
    for (size_t i = 0; i < count; i++) {
        if (i == 0 || compare_corners(&corners[i - 1], &corners[i]) != 0)
            t->points[t->point_count++] = corners[i].at;
        number[corners[i].index] = (uint32_t)t->point_count - 1;
        parts[corners[i].index] = corners[i].part;
    }
    for (size_t i = 0; i + 2 < count; i += 3) {
        face f = {.v = {number[i], number[i + 1], number[i + 2]}, .part = parts[i]};
        dvec a = t->points[f.v[0]];
        dvec c = dvec_cross(dvec_sub(t->points[f.v[1]], a), dvec_sub(t->points[f.v[2]], a));
        f.normal = dvec_unit(c);
        if (dvec_length(c) > 0)
            t->faces[t->face_count++] = f;
    }
    qsort(t->faces, t->face_count, sizeof *t->faces, compare_faces);
    size_t kept = 0;
    for (size_t i = 0; i < t->face_count; i++)
        if (kept == 0 || compare_faces(&t->faces[kept - 1], &t->faces[i]) != 0)
            t->faces[kept++] = t->faces[i];
    t->face_count = kept;
    free(number);
    free(parts);
}

static dvec to_viewer(const truth *t, dvec at)
{
    return t->parallel ? t->eye : dvec_sub(t->eye, at);
}

static void face_viewer(truth *t)
{
    dvec low = t->points[0], high = low;
    for (size_t i = 0; i < t->point_count; i++) {
        dvec p = t->points[i];
        low = dvec_of(fmin(low.x, p.x), fmin(low.y, p.y), fmin(low.z, p.z));
        high = dvec_of(fmax(high.x, p.x), fmax(high.y, p.y), fmax(high.z, p.z));
    }
    t->size = dvec_length(dvec_sub(high, low));
    for (size_t i = 0; i < t->face_count; i++) {
        face *f = &t->faces[i];
        f->facing = dvec_dot(f->normal, dvec_unit(to_viewer(t, t->points[f->v[0]])));
    }
}

/* --- lines ----------------------------------------------------------------------------------------------- */

static void put_line(truth *t, line l)
{
    t->lines = grown(t->lines, t->line_count, &t->line_capacity, sizeof *t->lines);
    t->lines[t->line_count++] = l;
}

static int compare_halves(const void *a, const void *b)
{
    const half *p = a, *q = b;
    if (p->low != q->low)
        return p->low < q->low ? -1 : 1;
    if (p->high != q->high)
        return p->high < q->high ? -1 : 1;
    return p->face < q->face ? -1 : p->face > q->face;
}

static uint32_t root_of(uint32_t *parents, uint32_t i)
{
    while (parents[i] != i)
        i = parents[i] = parents[parents[i]];
    return i;
}

/* What an edge with these half-edges is; false: no line. */
static bool judge_edge(const truth *t, const half *h, size_t count, line *out)
{
    const face *a = &t->faces[h[0].face], *b = &t->faces[h[count > 1].face];
    out->ends[0] = t->points[h[0].low];
    out->ends[1] = t->points[h[0].high];
    out->faces[0] = h[0].face;
    out->faces[1] = count > 1 ? (int64_t)h[1].face : NOBODY;
    out->border = count == 1;
    out->must = count == 1;
    if (count != 2 || h[0].forward == h[1].forward)
        return true;
    double turn = atan2(dvec_length(dvec_cross(a->normal, b->normal)), dvec_dot(a->normal, b->normal));
    bool   outline = (a->facing > 0) != (b->facing > 0), plain = fabs(a->facing) > 1e-3 && fabs(b->facing) > 1e-3;
    out->must = turn > t->angle || (outline && plain);
    return outline || turn > ANGLE_LEAST;
}

static void find_edges(truth *t)
{
    size_t    count = 3 * t->face_count;
    half     *halves = malloc((count + 1) * sizeof *halves);
    uint32_t *pieces = malloc((t->face_count + 1) * sizeof *pieces);
    for (uint32_t f = 0; f < t->face_count; f++) {
        pieces[f] = f;
        for (uint32_t k = 0; k < 3; k++) {
            uint32_t a = t->faces[f].v[k], b = t->faces[f].v[(k + 1) % 3];
            halves[3 * f + k] = (half){a < b ? a : b, a < b ? b : a, f, a < b};
        }
    }
    qsort(halves, count, sizeof *halves, compare_halves);
    for (size_t i = 0, end; i < count; i = end) {
        line l;
        for (end = i + 1; end < count && halves[end].low == halves[i].low && halves[end].high == halves[i].high; end++)
            pieces[root_of(pieces, halves[end].face)] = root_of(pieces, halves[i].face);
        if (judge_edge(t, &halves[i], end - i, &l))
            put_line(t, l);
    }
    for (uint32_t f = 0; f < t->face_count; f++)
        t->faces[f].piece = root_of(pieces, f);
    free(halves);
    free(pieces);
}

/* --- where pieces run through each other ----------------------------------------------------------------- */

/* Where the line from a to b passes a face, within it. */
static bool passes(const truth *t, const face *f, dvec a, dvec b, dvec *at)
{
    const dvec p = t->points[f->v[0]];
    double     from = dvec_dot(dvec_sub(a, p), f->normal), to = dvec_dot(dvec_sub(b, p), f->normal);
    if ((from > 0) == (to > 0))
        return false;
    *at = dvec_mix(a, b, from / (from - to));
    for (int k = 0; k < 3; k++) {
        dvec q = t->points[f->v[k]], side = dvec_sub(t->points[f->v[(k + 1) % 3]], q);
        if (dvec_dot(dvec_cross(side, dvec_sub(*at, q)), f->normal) < 0)
            return false;
    }
    return true;
}

static void cross_faces(truth *t, uint32_t one, uint32_t other)
{
    const face *pair[2] = {&t->faces[one], &t->faces[other]};
    dvec        found[6];
    int         count = 0;
    double      turn = atan2(dvec_length(dvec_cross(pair[0]->normal, pair[1]->normal)),
                             fabs(dvec_dot(pair[0]->normal, pair[1]->normal)));
    for (int which = 0; which < 2; which++)
        for (int k = 0; k < 3; k++) {
            const face *f = pair[which];
            count += passes(t, pair[!which], t->points[f->v[k]], t->points[f->v[(k + 1) % 3]], &found[count]);
        }
    if (count < 2 || dvec_length(dvec_sub(found[0], found[count - 1])) < SAME * t->size)
        return;
    put_line(t, (line){{found[0], found[count - 1]}, {one, other}, turn > MEET_LEAST, false});
}

typedef struct interval {
    double   low, high;
    uint32_t face;
    dvec     least, most;
} interval;

static int compare_intervals(const void *a, const void *b)
{
    const interval *p = a, *q = b;
    return p->low < q->low ? -1 : p->low > q->low ? 1 : p->face < q->face ? -1 : p->face > q->face;
}

/* Faces of different pieces whose boxes meet: swept along x. */
static void find_crossings(truth *t)
{
    interval *all = malloc((t->face_count + 1) * sizeof *all);
    for (uint32_t f = 0; f < t->face_count; f++) {
        dvec low = t->points[t->faces[f].v[0]], high = low;
        for (int k = 1; k < 3; k++) {
            dvec p = t->points[t->faces[f].v[k]];
            low = dvec_of(fmin(low.x, p.x), fmin(low.y, p.y), fmin(low.z, p.z));
            high = dvec_of(fmax(high.x, p.x), fmax(high.y, p.y), fmax(high.z, p.z));
        }
        all[f] = (interval){low.x, high.x, f, low, high};
    }
    qsort(all, t->face_count, sizeof *all, compare_intervals);
    for (size_t i = 0; i < t->face_count; i++)
        for (size_t k = i + 1; k < t->face_count && all[k].low <= all[i].high; k++) {
            const interval *p = &all[i], *q = &all[k];
            if (p->least.y <= q->most.y && q->least.y <= p->most.y && p->least.z <= q->most.z &&
                q->least.z <= p->most.z && t->faces[p->face].piece != t->faces[q->face].piece)
                cross_faces(t, p->face, q->face);
        }
    free(all);
}

/* --- what is seen ---------------------------------------------------------------------------------------- */

static void make_rays(truth *t)
{
    trace_triangle *all = calloc(t->face_count + 1, sizeof *all);
    for (size_t i = 0; i < t->face_count; i++) {
        for (int k = 0; k < 3; k++) {
            all[i].p[k] = t->points[t->faces[i].v[k]];
            all[i].n[k] = t->faces[i].normal;
        }
        all[i].flat = t->faces[i].normal;
    }
    t->rays = tracer_of_triangles(all, t->face_count);
}

typedef enum sight { HIDDEN, PERHAPS, SEEN } sight;

static sight look(const truth *t, const line *l, dvec at)
{
    enum { MOST = 16 };
    trace_hit hits[MOST];
    dvec      way = to_viewer(t, at), unit = dvec_unit(way);
    double    far = t->parallel ? 4 * t->size : dvec_length(way);
    dvec      from = dvec_sub(at, dvec_scale(unit, CLOSE * t->size));
    size_t    count = tracer_hits(t->rays, from, unit, 0, far + CLOSE * t->size, hits, MOST);
    sight     out = SEEN;
    for (size_t i = 0; i < count && i < MOST; i++) {
        if (hits[i].triangle == l->faces[0] || hits[i].triangle == l->faces[1])
            continue;
        double nearer = hits[i].t - CLOSE * t->size;
        if (nearer > CLOSE * t->size)
            return HIDDEN;
        /* Faces that the line ends at pass it there. */
        const face *f = &t->faces[hits[i].triangle];
        double      touch = INFINITY;
        for (int k = 0; k < 3; k++)
            for (int e = 0; e < 2; e++)
                touch = fmin(touch, dvec_length(dvec_sub(t->points[f->v[k]], l->ends[e])));
        bool meets = touch < SAME * t->size;
        if (!meets || nearer > SAME * t->size)
            out = PERHAPS;
    }
    return out;
}

static bool to_page(const truth *t, dvec at, double page[2])
{
    double w;
    dvec   eye = dmat_apply(t->view, at, 1, NULL), clip = dmat_apply(t->projection, eye, 1, &w);
    page[0] = clip.x / w;
    page[1] = clip.y / w;
    return w > 0;
}

/* Places a pixel of 1024 apart. What is next to what is not quite seen need not be there. */
static void see_line(truth *t, const line *l)
{
    double a[2], b[2];
    if (!to_page(t, l->ends[0], a) || !to_page(t, l->ends[1], b))
        return;
    double length = 512 * hypot(b[0] - a[0], b[1] - a[1]);
    int    count = (int)ceil(length) + 1;
    sight *sights = malloc((size_t)count * sizeof *sights);
    for (int i = 0; i < count; i++)
        sights[i] = look(t, l, dvec_mix(l->ends[0], l->ends[1], (i + 0.5) / count));
    for (int i = 0; i < count; i++) {
        double p[2];
        bool sure = sights[i] == SEEN && (i == 0 || sights[i - 1] == SEEN) && (i + 1 == count || sights[i + 1] == SEEN);
        if (sights[i] == HIDDEN || !to_page(t, dvec_mix(l->ends[0], l->ends[1], (i + 0.5) / count), p))
            continue;
        t->places = grown(t->places, t->place_count, &t->place_capacity, sizeof *t->places);
        t->places[t->place_count++] =
            (place){(float)p[0], (float)p[1], (float)(length / count / 1024), sure && l->must};
    }
    free(sights);
}

/* --- pictures -------------------------------------------------------------------------------------------- */

typedef struct drawing {
    int      width, height;
    float   *ink; /* 0 … 1 */
    uint8_t *state;
} drawing;

typedef struct score {
    double covered, length, stray, ink, longest, specks, gap_at[2], stray_at[2];
    long   gaps;
} score;

static bool drawing_read(drawing *d, const char *path)
{
    uint8_t *rgba = picture_read_rgba(path, &d->width, &d->height);
    size_t   count = rgba ? (size_t)d->width * (size_t)d->height : 0;
    d->ink = calloc(count + 1, sizeof *d->ink);
    d->state = calloc(count + 1, 1);
    for (size_t i = 0; i < count; i++) {
        const uint8_t *p = &rgba[4 * i];
        double         alpha = p[3] / 255.0;
        d->ink[i] = (float)(alpha * (1 - (0.2126 * p[0] + 0.7152 * p[1] + 0.0722 * p[2]) / 255));
        d->ink[i] = d->ink[i] < 0.06F ? 0 : d->ink[i];
    }
    free(rgba);
    return count > 0;
}

static void page_to_pixel(const drawing *d, const place *p, double *x, double *y)
{
    *x = (p->x * 0.5 + 0.5) * d->width;
    *y = (0.5 - p->y * 0.5) * d->height;
}

/* The most ink of the pixels whose middles lie within a distance; `mark` (not 0) is put onto all of them. */
static double around(drawing *d, double x, double y, double reach, uint8_t mark)
{
    double most = 0;
    for (int v = (int)floor(y - reach); v <= (int)ceil(y + reach); v++)
        for (int u = (int)floor(x - reach); u <= (int)ceil(x + reach); u++) {
            if (u < 0 || v < 0 || u >= d->width || v >= d->height || hypot(u + 0.5 - x, v + 0.5 - y) > reach)
                continue;
            size_t i = (size_t)v * (size_t)d->width + (size_t)u;
            most = fmax(most, d->ink[i]);
            d->state[i] |= mark;
        }
    return most;
}

enum { TRUE_INK = 1, GAP = 2, VISITED = 4, SPECKLE = 8 };

/* Pixels that hang together over eight neighbours, from one on. Returns how many; `diagonal`: of their box. */
static long flood(drawing *d, size_t start, uint8_t wanted, float least, double *diagonal, size_t *stack)
{
    long   count = 0;
    size_t depth = 0;
    int    low[2] = {d->width, d->height}, high[2] = {0, 0};
    stack[depth++] = start;
    d->state[start] |= VISITED;
    while (depth > 0) {
        size_t i = stack[--depth];
        int    x = (int)(i % (size_t)d->width), y = (int)(i / (size_t)d->width);
        low[0] = x < low[0] ? x : low[0], low[1] = y < low[1] ? y : low[1];
        high[0] = x > high[0] ? x : high[0], high[1] = y > high[1] ? y : high[1];
        count++;
        for (int v = y - 1; v <= y + 1; v++)
            for (int u = x - 1; u <= x + 1; u++) {
                size_t k = (size_t)v * (size_t)d->width + (size_t)u;
                if (u < 0 || v < 0 || u >= d->width || v >= d->height || d->state[k] & VISITED ||
                    (wanted ? !(d->state[k] & wanted) : d->ink[k] < least))
                    continue;
                d->state[k] |= VISITED;
                stack[depth++] = k;
            }
    }
    *diagonal = hypot(high[0] - low[0] + 1, high[1] - low[1] + 1);
    return count;
}

static void count_gaps(score *s, drawing *d, size_t *stack)
{
    size_t count = (size_t)d->width * (size_t)d->height;
    for (size_t i = 0; i < count; i++)
        d->state[i] &= (uint8_t)~VISITED;
    for (size_t i = 0; i < count; i++) {
        double long_;
        if (!(d->state[i] & GAP) || d->state[i] & VISITED)
            continue;
        flood(d, i, GAP, 0, &long_, stack);
        s->gaps += long_ >= GAP_LEAST * M_SQRT2;
        if (long_ > s->longest) {
            s->longest = long_;
            s->gap_at[0] = (double)(i % (size_t)d->width), s->gap_at[1] = (double)(i / (size_t)d->width);
        }
    }
}

static void count_specks(score *s, drawing *d, size_t *stack)
{
    size_t count = (size_t)d->width * (size_t)d->height;
    for (size_t i = 0; i < count; i++)
        d->state[i] &= (uint8_t)~VISITED;
    for (size_t i = 0; i < count; i++) {
        double diagonal;
        if (d->ink[i] < SPECK_LEAST || d->state[i] & VISITED)
            continue;
        long pixels = flood(d, i, 0, SPECK_LEAST, &diagonal, stack);
        s->specks += pixels < SPECK ? (double)pixels : 0;
        d->state[i] |= pixels < SPECK ? SPECKLE : 0;
    }
    s->specks /= (double)count;
}

static void measure(score *s, const truth *t, drawing *d, double width)
{
    double  reach = fmax(1.5, 0.5 * width * d->width / 1024 + 1);
    size_t  count = (size_t)d->width * (size_t)d->height;
    size_t *stack = malloc((count + 1) * sizeof *stack);
    memset(s, 0, sizeof *s);
    for (size_t i = 0; i < t->place_count; i++) {
        double       x, y;
        const place *p = &t->places[i];
        page_to_pixel(d, p, &x, &y);
        if (x < 0 || y < 0 || x >= d->width || y >= d->height)
            continue;
        double ink = around(d, x, y, reach, TRUE_INK);
        if (!p->must)
            continue;
        s->length += p->length;
        s->covered += ink >= INK_LEAST ? p->length : 0;
        if (ink < INK_LEAST)
            around(d, x, y, 1.5, GAP);
    }
    for (size_t i = 0; i < count; i++) {
        s->ink += d->ink[i];
        if (d->state[i] & TRUE_INK || d->ink[i] <= 0)
            continue;
        s->stray += d->ink[i];
        s->stray_at[0] = (double)(i % (size_t)d->width), s->stray_at[1] = (double)(i / (size_t)d->width);
    }
    count_gaps(s, d, stack);
    count_specks(s, d, stack);
    free(stack);
}

/* Missing lines red, stray ink blue, specks magenta, the rest grey. */
static void show(const drawing *d, const char *path)
{
    size_t   count = (size_t)d->width * (size_t)d->height;
    uint8_t *rgba = malloc(4 * count + 4);
    for (size_t i = 0; i < count; i++) {
        uint8_t  g = (uint8_t)(255 - 150 * d->ink[i]);
        uint8_t *p = &rgba[4 * i];
        p[0] = p[1] = p[2] = g, p[3] = 255;
        if (d->ink[i] > 0 && !(d->state[i] & TRUE_INK))
            p[0] = p[1] = 0, p[2] = 255;
        if (d->state[i] & GAP)
            p[0] = 255, p[1] = p[2] = 0;
        if (d->state[i] & SPECKLE)
            p[0] = p[2] = 255, p[1] = 0;
    }
    picture_write_rgba(path, rgba, d->width, d->height);
    free(rgba);
}

/* --- the program ----------------------------------------------------------------------------------------- */

static bool read_camera(truth *t, const char *path)
{
    json_t *report = json_load_file(path, 0, NULL), *camera = json_object_get(report, "camera");
    json_t *view = json_object_get(camera, "view_matrix"), *projection = json_object_get(camera, "projection_matrix");
    const char *kind = json_string_value(json_object_get(camera, "projection"));
    bool        good = kind && json_array_size(view) == 16 && json_array_size(projection) == 16;
    for (size_t i = 0; i < 16 && good; i++) {
        t->view[i] = json_number_value(json_array_get(view, i));
        t->projection[i] = json_number_value(json_array_get(projection, i));
    }
    t->parallel = good && strcmp(kind, "orthographic") == 0;
    const double *m = t->view;
    t->eye = t->parallel
                 ? dvec_of(m[2], m[6], m[10])
                 : dvec_of(-(m[0] * m[12] + m[1] * m[13] + m[2] * m[14]), -(m[4] * m[12] + m[5] * m[13] + m[6] * m[14]),
                           -(m[8] * m[12] + m[9] * m[13] + m[10] * m[14]));
    json_decref(report);
    return good;
}

static bool read_model(truth *t, const char *path, char up)
{
    lmn_scene    *scene = NULL;
    lmn_error     error = {0};
    lmn_load_desc desc = LMN_LOAD_DESC_INIT;
    desc.up_axis = up == 'y' ? LMN_UP_Y : up == 'z' ? LMN_UP_Z : LMN_UP_AUTO;
    if (lmn_scene_create(&scene, &error) != LMN_OK || lmn_scene_add_file(scene, path, &desc, &error) != LMN_OK) {
        fprintf(stderr, "truth: %s\n", error.message);
        lmn_scene_destroy(&scene);
        return false;
    }
    size_t  count;
    corner *corners = corners_of(scene, &count);
    weld(t, corners, count);
    free(corners);
    lmn_scene_destroy(&scene);
    return t->face_count > 0;
}

static void truth_release(truth *t)
{
    tracer_destroy(t->rays);
    free(t->points);
    free(t->faces);
    free(t->lines);
    free(t->places);
}

static void compare(const truth *t, const char *path, double width, const char *shown)
{
    drawing d = {0};
    score   s;
    if (drawing_read(&d, path)) {
        measure(&s, t, &d, width);
        printf("%5d covered %6.2f %% stray %5.2f %% gaps %4ld longest %6.1f at %4.0f,%4.0f specks %.4f %% stray at "
               "%4.0f,%4.0f %s\n",
               d.width, s.length > 0 ? 100 * s.covered / s.length : 100, s.ink > 0 ? 100 * s.stray / s.ink : 0, s.gaps,
               s.longest, s.gap_at[0], s.gap_at[1], 100 * s.specks, s.stray_at[0], s.stray_at[1], path);
        if (shown)
            show(&d, shown);
    } else
        fprintf(stderr, "truth: cannot read %s\n", path);
    free(d.ink);
    free(d.state);
}

int main(int argc, char **argv)
{
    truth       t = {.angle = 45 * DEGREE};
    double      width = 2;
    char        up = 0;
    const char *shown = NULL;
    int         i = 1;
    for (; i + 1 < argc && strncmp(argv[i], "--", 2) == 0; i += 2) {
        if (strcmp(argv[i], "--up") == 0)
            up = argv[i + 1][0];
        else if (strcmp(argv[i], "--angle") == 0)
            t.angle = atof(argv[i + 1]) * DEGREE;
        else if (strcmp(argv[i], "--width") == 0)
            width = atof(argv[i + 1]);
        else if (strcmp(argv[i], "--show") == 0)
            shown = argv[i + 1];
    }
    if (argc - i < 3) {
        fprintf(
            stderr,
            "usage: truth [--up y|z] [--angle DEG] [--width PX] [--show OUT.png] MODEL REPORT.json PICTURE.png …\n");
        return 1;
    }
    if (!read_camera(&t, argv[i + 1]) || !read_model(&t, argv[i], up)) {
        truth_release(&t);
        return 2;
    }
    face_viewer(&t);
    find_edges(&t);
    find_crossings(&t);
    make_rays(&t);
    for (size_t k = 0; k < t.line_count; k++)
        see_line(&t, &t.lines[k]);
    for (i += 2; i < argc; i++)
        compare(&t, argv[i], width, shown);
    truth_release(&t);
    return 0;
}
