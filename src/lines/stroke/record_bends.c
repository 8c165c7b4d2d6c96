/* Smooth outlines leave a vertex in the plane across the normal there (Vlachos, Peters, Boyd and Mitchell 2001), so
 * that outlines of any view are smooth where edges meet; creases and rims leave it as the circle through it and both
 * neighbours does, where turns in a row are alike: the law of curve_arcs.h, in space. */
#include "lines/stroke/record_bends.h"

#include <math.h>
#include <string.h>

#include "base/memory.h"

/* Radians: between sharp edges what turns further at a vertex is a corner; what turns less is straight. */
#define SHARPEST 0.7f
#define STRAIGHT 0.01f
/* Turns that follow each other are alike within this factor; edges that are so much longer than the next are straight.
 */
#define ALIKE 2.0f
#define LONG  2.2f
/* Smooth surfaces turn less over half an edge: sine. */
#define BENT_MOST 0.5f
enum { LEVELS = 127, BASE = 2 * LEVELS + 2 };

static vec3 minus(vec3 a, vec3 b)
{
    return (vec3){a.x - b.x, a.y - b.y, a.z - b.z};
}

static vec3 along(vec3 a, float s, vec3 d)
{
    return (vec3){a.x + s * d.x, a.y + s * d.y, a.z + s * d.z};
}

static float dot(vec3 a, vec3 b)
{
    return a.x * b.x + a.y * b.y + a.z * b.z;
}

static vec3 unit(vec3 a)
{
    float length = sqrtf(dot(a, a));
    return length > 0 ? (vec3){a.x / length, a.y / length, a.z / length} : a;
}

static bool is_line(const mesh_edge *e)
{
    return (e->flags & (EDGE_BORDER | EDGE_CREASE | EDGE_MATERIAL)) != 0;
}

static uint32_t other_end(const mesh_edge *e, uint32_t vertex)
{
    return e->vertex[0] == vertex ? e->vertex[1] : e->vertex[0];
}

static void find_lines(record_bends *b)
{
    const edge_mesh *m = b->m;
    for (uint32_t i = 0; i < m->edge_count; i++)
        for (int k = 0; k < 2 && is_line(&m->edges[i]); k++) {
            uint32_t v = m->edges[i].vertex[k];
            if (b->counts[v] < 2)
                b->lines[v][b->counts[v]] = i;
            b->counts[v] = b->counts[v] < 2 ? (uint8_t)(b->counts[v] + 1) : 3;
        }
    for (uint32_t v = 0; v < m->vertex_count; v++) {
        if (b->counts[v] != 2)
            continue;
        vec3 p = m->positions[v], q = m->positions[other_end(&m->edges[b->lines[v][0]], v)],
             r = m->positions[other_end(&m->edges[b->lines[v][1]], v)];
        float cosine = dot(unit(minus(p, q)), unit(minus(r, p))), turn = acosf(fminf(fmaxf(cosine, -1), 1));
        b->turns[v] = turn > STRAIGHT && turn < SHARPEST ? turn : 0;
    }
}

/* Means over faces, by their area. */
static void find_normals(record_bends *b)
{
    const edge_mesh *m = b->m;
    for (uint32_t f = 0; f < m->face_count; f++) {
        const uint32_t *c = m->faces[f];
        vec3 p = minus(m->positions[c[1]], m->positions[c[0]]), q = minus(m->positions[c[2]], m->positions[c[0]]);
        vec3 area = {p.y * q.z - p.z * q.y, p.z * q.x - p.x * q.z, p.x * q.y - p.y * q.x};
        for (int k = 0; k < 3; k++)
            b->normals[c[k]] = along(b->normals[c[k]], 1, area);
    }
    for (uint32_t v = 0; v < m->vertex_count; v++)
        b->normals[v] = b->counts[v] ? (vec3){0, 0, 0} : unit(b->normals[v]);
}

bool record_bends_open(record_bends *out, const edge_mesh *m)
{
    size_t count = (size_t)m->vertex_count + 1;
    *out = (record_bends){.m = m};
    out->normals = mem_calloc(count, sizeof *out->normals);
    out->lines = mem_calloc(count, sizeof *out->lines);
    out->counts = mem_calloc(count, sizeof *out->counts);
    out->turns = mem_calloc(count, sizeof *out->turns);
    if (!out->normals || !out->lines || !out->counts || !out->turns) {
        record_bends_close(out);
        return false;
    }
    find_lines(out);
    find_normals(out);
    return true;
}

void record_bends_close(record_bends *b)
{
    mem_free(b->normals);
    mem_free(b->lines);
    mem_free(b->counts);
    mem_free(b->turns);
    memset(b, 0, sizeof *b);
}

static bool are_alike(float a, float b)
{
    return a > 0 && b > 0 && a <= ALIKE * b && b <= ALIKE * a;
}

/* How the way from a vertex into an edge differs from its chord, which has length 1. */
static vec3 leave(const record_bends *b, uint32_t edge, uint32_t vertex)
{
    const edge_mesh *m = b->m;
    const mesh_edge *e = &m->edges[edge];
    vec3             p = m->positions[vertex], none = {0, 0, 0};
    uint32_t         far = other_end(e, vertex);
    vec3             way = minus(m->positions[far], p), chord = unit(way);
    if (!is_line(e)) {
        float sine = dot(chord, b->normals[vertex]);
        return fabsf(sine) < BENT_MOST ? along(none, -sine, b->normals[vertex]) : none;
    }
    if (b->counts[vertex] != 2 || b->turns[vertex] <= 0)
        return none;
    const mesh_edge *next = &m->edges[b->lines[vertex][b->lines[vertex][0] == edge]];
    uint32_t         beyond = other_end(next, vertex);
    if (!are_alike(b->turns[vertex], b->turns[far]) && !are_alike(b->turns[vertex], b->turns[beyond]))
        return none;
    vec3  before = minus(p, m->positions[beyond]);
    float own = sqrtf(dot(way, way)), other = sqrtf(dot(before, before));
    if (own > LONG * other)
        return none;
    vec3  tangent = other > LONG * own ? before : along(along(none, own, unit(before)), other, chord);
    float forward = dot(tangent, chord);
    return forward > 0 ? minus(along(none, 1 / forward, tangent), chord) : none;
}

static float pack(vec3 v)
{
    const float from[3] = {v.x, v.y, v.z};
    float       out = 0, most = 0;
    for (int k = 0; k < 3; k++) {
        float level = roundf(fminf(fmaxf(from[k], -1), 1) * LEVELS);
        most = fmaxf(most, fabsf(level));
        out = out * BASE + level + LEVELS;
    }
    return most > 0 ? out : 0;
}

void record_bend(const record_bends *b, uint32_t edge, float *begin, float *end)
{
    const mesh_edge *e = &b->m->edges[edge];
    *begin = pack(leave(b, edge, e->vertex[0]));
    *end = pack(leave(b, edge, e->vertex[1]));
}
