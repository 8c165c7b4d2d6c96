#include "stroke/form_surface.h"

#include <math.h>
#include <string.h>

#include "base/groups.h"
#include "base/memory.h"
#include "base/threads.h"
#include "stroke/butterfly.h"
#include "stroke/form_bend.h"

/* --- knots ---------------------------------------------------------------------------------------------- */

static void part_edge(form_knots *s, uint32_t h)
{
    uint32_t other = s->opposite[h];
    s->opposite[h] = NO_HALF;
    if (other != NO_HALF)
        s->opposite[other] = NO_HALF;
}

static bool is_sampled(const edge_mesh *m)
{
    return m->sampling.sampled && !m->refinement;
}

static bool is_cap(const edge_mesh *m, uint32_t face)
{
    return m->cap_count && m->materials && m->materials[face] <= EDGE_CAP_MATERIAL(0);
}

/* Half-edges over which the surface goes on smoothly. */
static lmn_status pair_smooth(form_knots *s, const edge_mesh *m, lmn_error *error)
{
    butterfly  flat;
    lmn_status status = butterfly_refine(&flat, m->positions, m->vertex_count, (const uint32_t(*)[3])m->faces,
                                         m->face_count, NULL, 0, error);
    if (status != LMN_OK)
        return status;
    s->opposite = flat.levels[0].opposite;
    flat.levels[0].opposite = NULL;
    butterfly_release(&flat);
    bool     sampled = is_sampled(m);
    uint32_t ends =
        EDGE_BORDER | EDGE_TWISTED | (sampled ? 0 : EDGE_CREASE); /* normals of samplings are means anyway */
    for (uint32_t h = 0; h < 3 * m->face_count; h++)
        if (s->opposite[h] != NO_HALF && is_cap(m, h / 3) != is_cap(m, s->opposite[h] / 3)) {
            part_edge(s, h); /* a section is no surface that was sampled */
        } else if (s->opposite[h] != NO_HALF &&
                   !sampled) { /* sharper than a right angle is no surface that goes on, whatever the file says */
            vec3 a = m->normals[h / 3], b = m->normals[s->opposite[h] / 3];
            if (a.x * b.x + a.y * b.y + a.z * b.z < 0)
                part_edge(s, h);
        }
    for (uint32_t i = 0; i < m->edge_count; i++) {
        const mesh_edge *e = &m->edges[i];
        if (!(e->flags & ends))
            continue;
        for (uint32_t k = 0; k < 3; k++) {
            uint32_t h = 3 * e->face[0] + k;
            if (m->faces[e->face[0]][k] == e->vertex[0] && m->faces[e->face[0]][(k + 1) % 3] == e->vertex[1])
                part_edge(s, h);
        }
    }
    return LMN_OK;
}

/* Corners at one vertex that smooth edges connect share a knot. */
static bool number_knots(form_knots *s, const edge_mesh *m)
{
    uint32_t  count = 3 * m->face_count;
    uint32_t *links = mem_alloc(((size_t)count + 1) * sizeof *links);
    s->corners = mem_alloc(((size_t)m->face_count + 1) * sizeof *s->corners);
    s->vertices = mem_alloc(((size_t)count + 1) * sizeof *s->vertices);
    if (!links || !s->corners || !s->vertices) {
        mem_free(links);
        return false;
    }
    for (uint32_t c = 0; c < count; c++)
        links[c] = c;
    for (uint32_t h = 0; h < count; h++)
        if (s->opposite[h] != NO_HALF)
            group_join(links, h, half_edge_next(s->opposite[h]));
    for (uint32_t c = 0; c < count; c++) { /* a root comes before all that hang on it */
        uint32_t root = group_root(links, c);
        if (root == c)
            s->vertices[s->knot_count] = m->faces[c / 3][c % 3];
        s->corners[c / 3][c % 3] = root == c ? s->knot_count++ : s->corners[root / 3][root % 3];
    }
    mem_free(links);
    uint32_t *smaller = mem_realloc(s->vertices, ((size_t)s->knot_count + 1) * sizeof *smaller);
    s->vertices = smaller ? smaller : s->vertices;
    return true;
}

typedef struct knot_job {
    const form_surface *s;
    const form_knots   *k;
    const edge_mesh    *m;
    const vec3         *from; /* per knot */
    vec3               *to;
} knot_job;

enum { KNOTS_PER_THREAD = 4096 };

/* Means of the normals of the faces around, weighted so that those of a sphere are exact however it is divided (Max
 * 1999). */
static void find_normals(size_t begin, size_t end, void *user)
{
    const knot_job  *j = user;
    const edge_mesh *m = j->m;
    for (size_t i = begin; i < end; i++) {
        double sum[3] = {0, 0, 0};
        for (uint32_t at = j->k->corner_starts[i]; at < j->k->corner_starts[i + 1]; at++) {
            uint32_t f = j->k->corner_list[at] / 3, k = j->k->corner_list[at] % 3;
            double   sign = m->closed[m->pieces[f]] && m->inward[m->pieces[f]] ? -1 : 1;
            vec3     p = m->positions[m->faces[f][k]], q = m->positions[m->faces[f][(k + 1) % 3]],
                 r = m->positions[m->faces[f][(k + 2) % 3]];
            double ax = (double)q.x - p.x, ay = (double)q.y - p.y, az = (double)q.z - p.z, bx = (double)r.x - p.x,
                   by = (double)r.y - p.y, bz = (double)r.z - p.z;
            double weight = sign / ((ax * ax + ay * ay + az * az) * (bx * bx + by * by + bz * bz));
            sum[0] += weight * (ay * bz - az * by);
            sum[1] += weight * (az * bx - ax * bz);
            sum[2] += weight * (ax * by - ay * bx);
        }
        double length = sqrt(sum[0] * sum[0] + sum[1] * sum[1] + sum[2] * sum[2]);
        j->to[i] = length > 0 && isfinite(length)
                       ? (vec3){(float)(sum[0] / length), (float)(sum[1] / length), (float)(sum[2] / length)}
                       : (vec3){0, 0, 1};
    }
}

static bool make_normals(form_surface *s, const form_knots *k, const edge_mesh *m)
{
    s->normals = mem_alloc(((size_t)s->knot_count + 1) * sizeof *s->normals);
    knot_job job = {.s = s, .k = k, .m = m, .to = s->normals};
    if (s->normals)
        threads_for(s->knot_count, KNOTS_PER_THREAD, find_normals, &job);
    return s->normals;
}

/* Normals of samplings are means over an edge around, and more with the noise; of very fine ones over a fraction of
 * their size, which on a page that they fill is a third of a millimetre. More would round folds away. */
#define CALM_STEPS       4.0
#define CALM_NOISE_STEPS 6.0 /* a radian */
#define CALM_FRACTION    0.0015
/* Normals that differ by more belong to other sides of a fold: 1 − cosine. */
#define OTHER_SIDE 0.35
enum { CALM_STEPS_MOST = 48 };

/* A step that gives a knot half of what is around it spreads by half an edge; steps add as squares. */
static int calm_steps(const edge_sampling *e)
{
    double spread = CALM_FRACTION * e->size / e->mean_edge,
           steps = fmax(CALM_STEPS + CALM_NOISE_STEPS * e->noise, 4 * spread * spread);
    return steps < CALM_STEPS_MOST ? (int)steps : CALM_STEPS_MOST;
}

static vec3 unit_of(const double v[3], vec3 otherwise)
{
    double length = sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
    return length > 0 ? (vec3){(float)(v[0] / length), (float)(v[1] / length), (float)(v[2] / length)} : otherwise;
}

/* By Tukey's biweight of how much both differ: what lies around a fold of the surface does not count. Returns the
 * weight. */
static double add_normal(double sum[3], vec3 own, vec3 n)
{
    double differ = (1 - ((double)own.x * n.x + (double)own.y * n.y + (double)own.z * n.z)) / OTHER_SIDE,
           weight = differ < 1 ? (1 - differ) * (1 - differ) : 0;
    sum[0] += weight * n.x;
    sum[1] += weight * n.y;
    sum[2] += weight * n.z;
    return weight;
}

/* Each knot gets half of what is around it. */
static void calm_once(size_t begin, size_t end, void *user)
{
    const knot_job *j = user;
    for (size_t i = begin; i < end; i++) {
        double sum[3] = {0, 0, 0}, weight = 0;
        vec3   n = j->from[i];
        for (uint32_t at = j->k->beside_starts[i]; at < j->k->beside_starts[i + 1]; at++)
            weight += add_normal(sum, n, j->from[j->k->beside_list[at]]);
        sum[0] += weight * n.x;
        sum[1] += weight * n.y;
        sum[2] += weight * n.z;
        j->to[i] = unit_of(sum, n);
    }
}

static bool make_calm_normals(form_surface *s, const form_knots *k, const edge_mesh *m)
{
    if (!is_sampled(m))
        return true;
    vec3 *now = mem_copy(s->normals, ((size_t)s->knot_count + 1) * sizeof *now),
         *next = mem_alloc(((size_t)s->knot_count + 1) * sizeof *next);
    bool good = now && next;
    for (int steps = good ? calm_steps(&m->sampling) : 0; steps > 0; steps--) {
        vec3    *swap = now;
        knot_job job = {.s = s, .k = k, .m = m, .from = now, .to = next};
        threads_for(s->knot_count, KNOTS_PER_THREAD, calm_once, &job);
        now = next;
        next = swap;
    }
    mem_free(next);
    s->calm_normals = now;
    return good;
}

static bool make_fans(form_knots *s, const edge_mesh *m)
{
    s->fan_starts = mem_calloc((size_t)m->vertex_count + 2, sizeof *s->fan_starts);
    s->fan_faces = mem_alloc(((size_t)m->face_count * 3 + 1) * sizeof *s->fan_faces);
    if (!s->fan_starts || !s->fan_faces)
        return false;
    for (uint32_t c = 0; c < 3 * m->face_count; c++)
        s->fan_starts[m->faces[c / 3][c % 3] + 2]++;
    for (uint32_t v = 0; v < m->vertex_count; v++)
        s->fan_starts[v + 2] += s->fan_starts[v + 1];
    /* Counted two positions on, so that filling, which moves each start to its end, leaves them right. */
    for (uint32_t c = 0; c < 3 * m->face_count; c++)
        s->fan_faces[s->fan_starts[m->faces[c / 3][c % 3] + 1]++] = c / 3;
    return true;
}

/* --- what is around knots -------------------------------------------------------------------------------- */

/* Counts turned into places: number v's are starts[v] … starts[v + 1] − 1. They were counted two positions on, so that
 * filling, which moves each start to its end, leaves them right. */
static void sum_up(uint32_t *starts, uint32_t count)
{
    for (uint32_t i = 0; i < count; i++)
        starts[i + 2] += starts[i + 1];
}

static bool list_corners(form_knots *k, const edge_mesh *m)
{
    uint32_t count = 3 * m->face_count;
    k->corner_starts = mem_calloc((size_t)k->knot_count + 2, sizeof *k->corner_starts);
    k->corner_list = mem_alloc(((size_t)count + 1) * sizeof *k->corner_list);
    if (!k->corner_starts || !k->corner_list)
        return false;
    for (uint32_t c = 0; c < count; c++)
        k->corner_starts[k->corners[c / 3][c % 3] + 2]++;
    sum_up(k->corner_starts, k->knot_count);
    for (uint32_t c = 0; c < count; c++)
        k->corner_list[k->corner_starts[k->corners[c / 3][c % 3] + 1]++] = c;
    return true;
}

static bool list_beside(form_knots *k, const edge_mesh *m)
{
    uint32_t count = 3 * m->face_count;
    if (!is_sampled(m))
        return true;
    k->beside_starts = mem_calloc((size_t)k->knot_count + 2, sizeof *k->beside_starts);
    k->beside_list = mem_alloc((2 * (size_t)count + 1) * sizeof *k->beside_list);
    if (!k->beside_starts || !k->beside_list)
        return false;
    for (uint32_t h = 0; h < count; h++) {
        k->beside_starts[k->corners[h / 3][h % 3] + 2]++;
        if (k->opposite[h] == NO_HALF) /* nobody comes back along this edge */
            k->beside_starts[k->corners[h / 3][(h + 1) % 3] + 2]++;
    }
    sum_up(k->beside_starts, k->knot_count);
    for (uint32_t h = 0; h < count; h++) {
        uint32_t p = k->corners[h / 3][h % 3], q = k->corners[h / 3][(h + 1) % 3];
        k->beside_list[k->beside_starts[p + 1]++] = q;
        if (k->opposite[h] == NO_HALF)
            k->beside_list[k->beside_starts[q + 1]++] = p;
    }
    return true;
}

static lmn_status make_knots(form_knots **out, const edge_mesh *m, lmn_error *error)
{
    form_knots *k = *out = mem_calloc(1, sizeof *k);
    lmn_status  status = k ? pair_smooth(k, m, error) : error_memory(error);
    if (status == LMN_OK && (!number_knots(k, m) || !make_fans(k, m) || !list_corners(k, m) || !list_beside(k, m)))
        status = error_memory(error);
    if (status != LMN_OK)
        form_knots_destroy(out);
    return status;
}

void form_knots_destroy(form_knots **knots)
{
    form_knots *k = *knots;
    if (!k)
        return;
    mem_free(k->corners);
    mem_free(k->opposite);
    mem_free(k->vertices);
    mem_free(k->fan_starts);
    mem_free(k->fan_faces);
    mem_free(k->corner_starts);
    mem_free(k->corner_list);
    mem_free(k->beside_starts);
    mem_free(k->beside_list);
    mem_free(k);
    *knots = NULL;
}

/* Those of a sampling are the same wherever its vertices are: only edges without a second face end its surface. */
static lmn_status find_knots(form_surface *s, const edge_mesh *m, form_knots **found, lmn_error *error)
{
    form_knots **kept = m->topology && is_sampled(m) ? edge_topology_knots(m->topology) : &s->own;
    lmn_status   status = *kept ? LMN_OK : make_knots(kept, m, error);
    form_knots  *k = *found = *kept;
    if (status != LMN_OK)
        return status;
    s->knot_count = k->knot_count;
    s->corners = k->corners;
    s->opposite = k->opposite;
    s->vertices = k->vertices;
    s->fan_starts = k->fan_starts;
    s->fan_faces = k->fan_faces;
    return LMN_OK;
}

/* --- all ------------------------------------------------------------------------------------------------- */

lmn_status form_surface_make(form_surface *out, const edge_mesh *m, bool bends, lmn_error *error)
{
    memset(out, 0, sizeof *out);
    out->face_count = m->face_count;
    box3 box = box3_empty();
    for (uint32_t i = 0; i < m->piece_count; i++)
        box = box3_union(box, m->boxes[i]);
    out->size = box3_is_empty(box) ? 0 : box3_diagonal(box);
    form_knots *knots;
    lmn_status  status = find_knots(out, m, &knots, error);
    if (status == LMN_OK &&
        (!make_normals(out, knots, m) || !make_calm_normals(out, knots, m) || (bends && !form_bend_make(out, m))))
        status = error_memory(error);
    if (status != LMN_OK)
        form_surface_release(out);
    return status;
}

void form_surface_release(form_surface *s)
{
    form_knots_destroy(&s->own);
    mem_free(s->normals);
    mem_free(s->calm_normals);
    mem_free(s->bends);
    memset(s, 0, sizeof *s);
}
