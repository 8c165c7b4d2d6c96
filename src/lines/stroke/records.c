/* Records of edges and ribbons, as the GPU takes them. */
#include <math.h>
#include <string.h>

#include "base/memory.h"
#include "base/threads.h"
#include "lines/stroke/record_bends.h"
#include "lines/stroke/strokes.h"

static void put_vector(float *out, vec3 v, float fourth, float sign)
{
    out[0] = v.x * sign;
    out[1] = v.y * sign;
    out[2] = v.z * sign;
    out[3] = fourth;
}

/* Edges of solids lie on what is no mesh: their faces tell less than they do. Of meshes faces say all. */
static bool is_hollow_of_solid(const edge_mesh *m, const mesh_edge *e)
{
    return m->solid && (e->flags & EDGE_HOLLOW);
}

static void put_edge(float *out, const record_bends *bends, uint32_t edge)
{
    const edge_mesh *m = bends->m;
    const mesh_edge *e = &m->edges[edge];
    bool pair = e->face[1] != EDGE_NO_FACE && !is_hollow_of_solid(m, e), closed = m->closed[m->pieces[e->face[0]]];
    int  bits = (e->flags & EDGE_BORDER ? RECORD_BORDER : 0) | (e->flags & EDGE_CREASE ? RECORD_CREASE : 0) |
               (e->flags & EDGE_MATERIAL ? RECORD_MATERIAL : 0) | (pair ? RECORD_PAIR : 0) |
               (closed ? RECORD_CLOSED : 0) | (e->flags & EDGE_ROUNDED ? RECORD_ROUNDED : 0) |
               (e->flags & EDGE_QUIET ? RECORD_QUIET : 0);
    /* Of faces that pass the edge in the same direction one is inside out. */
    float outward = m->inward[m->pieces[e->face[0]]] ? -1 : 1, twist = e->flags & EDGE_TWISTED ? -1 : 1;
    put_vector(out, m->positions[e->vertex[0]], (float)bits, 1);
    float begin, end;
    record_bend(bends, edge, &begin, &end);
    put_vector(out + 4, m->positions[e->vertex[1]], -end, 1);
    put_vector(out + 8, m->normals[e->face[0]], e->turn, outward);
    put_vector(out + 12, m->normals[e->face[pair]], begin, pair ? outward * twist : -outward);
}

/* What is hidden has exact lines alone. */
static bool is_never_seen(const edge_mesh *m, const mesh_edge *e)
{
    return !m->solid && (e->flags & ~(uint32_t)EDGE_TWISTED) == (EDGE_CANDIDATE | EDGE_HOLLOW);
}

static bool is_always_line(const mesh_edge *e)
{
    return (e->flags & (EDGE_BORDER | EDGE_CREASE | EDGE_MATERIAL)) != 0;
}

/* Faces in one plane are seen from the same side, wherever the viewer is: such edges are never lines. */
static bool is_ever_line(const edge_mesh *m, const mesh_edge *e)
{
    const float turned = 1e-10f; /* squared, radians */
    if (is_never_seen(m, e))
        return false;
    if (is_always_line(e) || (e->flags & (EDGE_QUIET | EDGE_TWISTED)) || e->face[1] == EDGE_NO_FACE)
        return true;
    vec3  n = m->normals[e->face[0]], o = m->normals[e->face[1]];
    float x = n.x - o.x, y = n.y - o.y, z = n.z - o.z;
    return x * x + y * y + z * z > turned;
}

size_t strokes_edge_record_count(const edge_mesh *m)
{
    size_t count = m->line_count;
    for (uint32_t i = 0; i < m->edge_count; i++)
        count += is_ever_line(m, &m->edges[i]);
    return count;
}

double strokes_gentlest_turn(const edge_mesh *m)
{
    const double flat = 1 - 1e-5; /* faces in one plane: seen from the same side */
    double       least = 3.14159265358979323846;
    for (uint32_t i = 0; i < m->edge_count && least > 0; i++) {
        const mesh_edge *e = &m->edges[i];
        if (e->face[1] == EDGE_NO_FACE || is_hollow_of_solid(m, e) || is_never_seen(m, e) ||
            (e->flags & (EDGE_BORDER | EDGE_ROUNDED)))
            continue;
        vec3   n = m->normals[e->face[0]], o = m->normals[e->face[1]];
        double cosine = (e->flags & EDGE_TWISTED ? -1 : 1) * (double)(n.x * o.x + n.y * o.y + n.z * o.z);
        if (cosine < flat)
            least = fmin(least, !(e->flags & EDGE_CREASE) ? 0 : e->turn > 0 ? (double)e->turn : acos(fmax(cosine, -1)));
    }
    return least;
}

static float *put_drawn_lines(float *at, const edge_mesh *m)
{
    for (uint32_t i = 0; i < m->line_count; i++, at += EDGE_RECORD_FLOATS) {
        put_vector(at, m->positions[m->lines[i].vertex[0]], RECORD_DRAWN, 1);
        put_vector(at + 4, m->positions[m->lines[i].vertex[1]], m->lines[i].lift, 1);
    }
    return at;
}

float *strokes_edge_records(const edge_mesh *m)
{
    float       *records = mem_calloc(strokes_edge_record_count(m) + 1, EDGE_RECORD_FLOATS * sizeof *records);
    float       *at = records;
    record_bends bends;
    if (!records || !record_bends_open(&bends, m)) {
        mem_free(records);
        return NULL;
    }
    for (int pass = 0; pass < 2;
         pass++) /* always first, then maybe: neighbours decide alike, which wide processors like */
        for (uint32_t i = 0; i < m->edge_count; i++)
            if (is_always_line(&m->edges[i]) == (pass == 0) && is_ever_line(m, &m->edges[i])) {
                put_edge(at, &bends, i);
                at += EDGE_RECORD_FLOATS;
            }
    put_drawn_lines(at, m);
    record_bends_close(&bends);
    return records;
}

/* --- of what one viewer sees ----------------------------------------------------------------------------- */

/* Where rounding decides on which side of a face the eye is, the shader decides: of the distance from the edge to the
 * eye, and of how far both are from the origin. */
#define UNSURE         1e-4f
#define UNSURE_ROUNDED 4e-6f

/* Edges that may be lines, in steps of this many. */
enum { SIFT_STEP = 8192 };

typedef struct sieve {
    const edge_mesh *m;
    const float     *viewer;
    uint32_t        *kept;   /* numbers of edges; a step's own begin where the step does */
    uint32_t        *counts; /* per step */
} sieve;

static float largest_of(float x, float y, float z)
{
    return fmaxf(fmaxf(fabsf(x), fabsf(y)), fabsf(z));
}

/* May one of the edge's faces be seen from the front and the other not? */
static bool may_be_outline(const edge_mesh *m, const mesh_edge *e, const float viewer[4])
{
    if (e->face[1] == EDGE_NO_FACE)
        return false;
    vec3 a = m->positions[e->vertex[0]], b = m->positions[e->vertex[1]], n = m->normals[e->face[0]],
         o = m->normals[e->face[1]];
    float share = 0.5f * viewer[3], x = share * (a.x + b.x), y = share * (a.y + b.y), z = share * (a.z + b.z);
    float to_x = viewer[0] - x, to_y = viewer[1] - y, to_z = viewer[2] - z;
    float unsure = UNSURE * largest_of(to_x, to_y, to_z) +
                   UNSURE_ROUNDED * (largest_of(viewer[0], viewer[1], viewer[2]) + largest_of(x, y, z));
    float first = n.x * to_x + n.y * to_y + n.z * to_z, second = o.x * to_x + o.y * to_y + o.z * to_z;
    second = e->flags & EDGE_TWISTED ? -second : second;
    return !((first > unsure && second > unsure) || (first < -unsure && second < -unsure));
}

static void sift(size_t begin, size_t end, void *user)
{
    sieve *s = user;
    for (size_t step = begin; step < end; step++) {
        uint32_t first = (uint32_t)step * SIFT_STEP, count = 0;
        for (uint32_t i = first; i < s->m->edge_count && i < first + SIFT_STEP; i++) {
            const mesh_edge *e = &s->m->edges[i];
            s->kept[first + count] = i;
            count += !is_never_seen(s->m, e) &&
                     (is_always_line(e) || (e->flags & EDGE_QUIET) || may_be_outline(s->m, e, s->viewer));
        }
        s->counts[step] = count;
    }
}

/* In the order of strokes_edge_records. */
static float *put_sifted(const sieve *s, size_t steps, size_t *count)
{
    const edge_mesh *m = s->m;
    *count = m->line_count;
    for (size_t i = 0; i < steps; i++)
        *count += s->counts[i];
    float       *records = mem_calloc(*count + 1, EDGE_RECORD_FLOATS * sizeof *records), *at = records;
    record_bends bends;
    if (!records || !record_bends_open(&bends, m)) {
        mem_free(records);
        return NULL;
    }
    for (int pass = 0; pass < 2; pass++)
        for (size_t i = 0; i < steps; i++)
            for (uint32_t k = 0; k < s->counts[i]; k++) {
                const mesh_edge *e = &m->edges[s->kept[i * SIFT_STEP + k]];
                if (is_always_line(e) != (pass == 0))
                    continue;
                put_edge(at, &bends, s->kept[i * SIFT_STEP + k]);
                at += EDGE_RECORD_FLOATS;
            }
    put_drawn_lines(at, m);
    record_bends_close(&bends);
    return records;
}

float *strokes_edge_records_seen(const edge_mesh *m, const float viewer[4], size_t *count)
{
    size_t steps = ((size_t)m->edge_count + SIFT_STEP - 1) / SIFT_STEP;
    sieve  s = {.m = m, .viewer = viewer};
    s.kept = mem_alloc(((size_t)m->edge_count + 1) * sizeof *s.kept);
    s.counts = mem_calloc(steps + 1, sizeof *s.counts);
    float *records = NULL;
    if (s.kept && s.counts) {
        threads_for(steps, 4, sift, &s);
        records = put_sifted(&s, steps, count);
    }
    mem_free(s.kept);
    mem_free(s.counts);
    return records;
}

float *strokes_crossing_records(const stroke_scene *s, uint32_t item, size_t *count)
{
    size_t        own;
    double        ends[2][3];
    vec3          outward[2];
    const size_t *indices = stroke_scene_crossings_of(s, item, &own);
    float        *records = mem_calloc(own + 1, EDGE_RECORD_FLOATS * sizeof *records), *at = records;
    for (size_t i = 0; i < own && records; i++) {
        stroke_scene_crossing(s, indices[i], ends, outward);
        for (int k = 0; k < 3; k++) {
            at[k] = (float)ends[0][k];
            at[4 + k] = (float)ends[1][k];
        }
        at[3] = RECORD_CROSSING;
        put_vector(at + 8, outward[0], 0, 1);
        put_vector(at + 12, outward[1], 0, 1);
        at += EDGE_RECORD_FLOATS;
    }
    *count = own;
    return records;
}

/* --- ribbons -------------------------------------------------------------------------------------------- */

int strokes_channel(stroke_class c)
{
    return c == STROKE_CONTOUR || c == STROKE_BORDER ? 0 : c >= STROKE_INTERSECTION && c <= STROKE_DRAWN ? 3 : 1;
}

/* Bits of the twelfth number of a record; the shader has the same. */
enum { BUTT_BEGIN = 1, BUTT_END = 2, BRUSH_SHIFT = 2 };

static void put_piece(float *out, const ribbon *r, const ribbon_point *points, uint32_t i, int height)
{
    const ribbon_point *p = &points[i], *q = &points[i + 1];
    bool                butt = r->end == RIBBON_BUTT && !r->closed;
    int bits = (butt && i == 0 ? BUTT_BEGIN : 0) | (butt && i + 2 == r->count ? BUTT_END : 0) | r->brush << BRUSH_SHIFT;
    int channel = r->hidden_by ? CHANNEL_HIDDEN : strokes_channel(r->kind);
    const float record[RIBBON_RECORD_FLOATS] = {
        p->x,
        (float)height - p->y,
        p->depth,
        p->half,
        q->x,
        (float)height - q->y,
        q->depth,
        q->half,
        p->alpha,
        q->alpha,
        (float)channel,
        (float)bits,
        p->arc - points[0].arc,
        q->arc - points[0].arc,
        points[r->count - 1].arc - points[0].arc,
        (float)((r->id ^ r->id >> 23) % 65521),
    };
    memcpy(out, record, sizeof record);
}

/* A ribbon of one point is a dot: a piece without length. */
static size_t pieces_of(const ribbon *r)
{
    return r->count > 1 ? r->count - 1 : r->count;
}

float *strokes_ribbon_records(const ribbon_set *set, int height, size_t *count)
{
    *count = 0;
    for (size_t i = 0; i < set->ribbon_count; i++)
        *count += pieces_of(&set->ribbons[i]);
    float *records = mem_alloc((*count + 1) * RIBBON_RECORD_FLOATS * sizeof *records), *at = records;
    for (size_t i = 0; i < set->ribbon_count && records; i++) {
        const ribbon       *r = &set->ribbons[i];
        ribbon_point        twice[2];
        const ribbon_point *points = &set->points[r->first];
        ribbon              dot = *r;
        if (r->count == 1) {
            twice[0] = twice[1] = points[0];
            points = twice;
            dot.count = 2;
        }
        for (uint32_t k = 0; k < pieces_of(r); k++, at += RIBBON_RECORD_FLOATS)
            put_piece(at, &dot, points, k, height);
    }
    return records;
}
