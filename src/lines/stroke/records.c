/* Records of edges and ribbons, as the GPU takes them. */
#include <string.h>

#include "base/memory.h"
#include "lines/stroke/strokes.h"

/* Six times the volume of each piece, which says which way round it is: measured from a corner of its own box,
 * where numbers are small. */
static double *find_volumes(const edge_mesh *m)
{
    double *volumes = mem_calloc((size_t)m->piece_count + 1, sizeof *volumes);
    for (uint32_t f = 0; f < m->face_count && volumes; f++) {
        vec3   from = m->boxes[m->pieces[f]].min;
        double p[3][3];
        for (int k = 0; k < 3; k++) {
            vec3 at = m->positions[m->faces[f][k]];
            p[k][0] = (double)at.x - from.x;
            p[k][1] = (double)at.y - from.y;
            p[k][2] = (double)at.z - from.z;
        }
        volumes[m->pieces[f]] += p[0][0] * (p[1][1] * p[2][2] - p[1][2] * p[2][1]) +
                                 p[0][1] * (p[1][2] * p[2][0] - p[1][0] * p[2][2]) +
                                 p[0][2] * (p[1][0] * p[2][1] - p[1][1] * p[2][0]);
    }
    return volumes;
}

static void put_vector(float *out, vec3 v, float fourth, float sign)
{
    out[0] = v.x * sign;
    out[1] = v.y * sign;
    out[2] = v.z * sign;
    out[3] = fourth;
}

static void put_edge(float *out, const edge_mesh *m, const mesh_edge *e, double volume)
{
    bool pair = e->face[1] != EDGE_NO_FACE, closed = m->closed[m->pieces[e->face[0]]];
    int  bits = (e->flags & EDGE_BORDER ? RECORD_BORDER : 0) | (e->flags & EDGE_CREASE ? RECORD_CREASE : 0) |
               (e->flags & EDGE_MATERIAL ? RECORD_MATERIAL : 0) | (pair ? RECORD_PAIR : 0) |
               (closed ? RECORD_CLOSED : 0);
    /* Of faces that pass the edge in the same direction one is inside out. */
    float outward = volume < 0 ? -1 : 1, twist = e->flags & EDGE_TWISTED ? -1 : 1;
    put_vector(out, m->positions[e->vertex[0]], (float)bits, 1);
    put_vector(out + 4, m->positions[e->vertex[1]], 0, 1);
    put_vector(out + 8, m->normals[e->face[0]], 0, outward);
    put_vector(out + 12, m->normals[e->face[pair]], 0, pair ? outward * twist : -outward);
}

static bool is_always_line(const mesh_edge *e)
{
    return (e->flags & (EDGE_BORDER | EDGE_CREASE | EDGE_MATERIAL)) != 0;
}

size_t strokes_edge_record_count(const edge_mesh *m)
{
    return (size_t)m->edge_count + m->line_count;
}

float *strokes_edge_records(const edge_mesh *m)
{
    float  *records = mem_calloc(strokes_edge_record_count(m) + 1, EDGE_RECORD_FLOATS * sizeof *records);
    double *volumes = find_volumes(m);
    float  *at = records;
    for (int pass = 0; pass < 2;
         pass++) /* always first, then maybe: neighbours decide alike, which wide processors like */
        for (uint32_t i = 0; i < m->edge_count && records && volumes; i++)
            if (is_always_line(&m->edges[i]) == (pass == 0)) {
                put_edge(at, m, &m->edges[i], volumes[m->pieces[m->edges[i].face[0]]]);
                at += EDGE_RECORD_FLOATS;
            }
    for (uint32_t i = 0; i < m->line_count && records; i++, at += EDGE_RECORD_FLOATS) {
        put_vector(at, m->positions[m->lines[i].vertex[0]], RECORD_DRAWN, 1);
        put_vector(at + 4, m->positions[m->lines[i].vertex[1]], m->lines[i].lift, 1);
    }
    if (!volumes) {
        mem_free(records);
        records = NULL;
    }
    mem_free(volumes);
    return records;
}

float *strokes_crossing_records(const stroke_scene *s, uint32_t item, size_t *count)
{
    size_t all = stroke_scene_crossing_count(s), own = 0;
    double ends[2][3];
    vec3   outward[2];
    for (size_t i = 0; i < all; i++)
        own += stroke_scene_crossing(s, i, ends, outward) == item;
    float *records = mem_calloc(own + 1, EDGE_RECORD_FLOATS * sizeof *records), *at = records;
    for (size_t i = 0; i < all && records; i++) {
        if (stroke_scene_crossing(s, i, ends, outward) != item)
            continue;
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
