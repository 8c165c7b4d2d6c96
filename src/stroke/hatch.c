/* Lines of the page are laid over every triangle of a cut face, cut to where a solid ends, joined from triangle to
 * triangle, and hidden like all lines. */
#include "stroke/hatch.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "base/work.h"
#include "stroke/solid.h"
#include "stroke/stroke_private.h"

#define RADIANS (3.14159265358979323846 / 180)
/* Stretches that are no farther apart are one, units. */
#define SAME_END 1e-3

/* How a cut face is hatched: lines at multiples of `apart` across. x to the right, y upwards from the bottom. */
typedef struct hatching {
    double along[2], across[2], apart, offset;
} hatching;

/* A stretch of one line on one triangle. */
typedef struct stretch {
    uint32_t item, cap;
    int64_t  line;
    double   from, to; /* along */
    uint32_t triangle; /* of the view, where it begins */
    uint32_t last;     /* and where it ends: depths are those of triangles there, as needles know none elsewhere */
} stretch;

/* A triangle of a cut face. */
typedef struct cap_triangle {
    uint32_t item, cap, triangle;
} cap_triangle;

typedef struct hatcher {
    const stroke_view *v;
    const bool        *parts;
    double             apart, angle;
    mat4               to_world; /* from eye space */
    stretch           *items;
    size_t             count, capacity;
    cap_triangle      *faces; /* all that are hatched, where areas are wanted */
    size_t             face_count, face_capacity;
    bool               wants_areas;
    solid_trimmer     *trimmer; /* of the solid at hand */
    uint32_t           trimmed; /* its item */
} hatcher;

double hatch_turn(int axis)
{
    static const double turns[3] = {0, 90, 50};
    return axis >= 0 && axis < 3 ? turns[axis] : 0;
}

/* As draughtsmen do, each part and body turns its lines, and what has the same angle has another distance; planes that
 * meet in a corner differ as well. The numbers are those of light/cut.glsl. */
static hatching hatching_of(const hatcher *h, uint32_t item, const edge_cap *cap)
{
    static const double turns[6] = {0, 90, -15, 105, 15, 75}, scales[3] = {1, 0.8, 1.25};
    uint32_t            index = h->v->scene->items[item].part_index + cap->body;
    double              angle = h->angle + (turns[index % 6] + hatch_turn(cap->axis)) * RADIANS;
    return (hatching){
        {cos(angle), sin(angle)}, {-sin(angle), cos(angle)}, h->apart * scales[index / 2 % 3], 0.37 * index};
}

/* --- positions ------------------------------------------------------------------------------------------ */

static void on_page(const stroke_view *v, window_point p, double out[2])
{
    out[0] = p.x / v->units + 0.5 * v->camera.width;
    out[1] = 0.5 * v->camera.height - p.y / v->units;
}

static void position_on_line(const hatching *g, int64_t line, double along, double out[2])
{
    double across = ((double)line + 0.5) * g->apart - g->offset;
    for (int k = 0; k < 2; k++)
        out[k] = along * g->along[k] + across * g->across[k];
}

/* A position of the page on a triangle's plane. */
static window_point on_plane(const stroke_view *v, uint32_t triangle, const double at[2])
{
    const uint32_t *t = v->triangles[triangle].v;
    window_point    p = v->points[t[0]], q = v->points[t[1]], r = v->points[t[2]];
    window_point    out = {(int32_t)lrint((at[0] - 0.5 * v->camera.width) * v->units),
                           (int32_t)lrint((0.5 * v->camera.height - at[1]) * v->units), 0};
    double          area = window_side(p, q, r), a = window_side(q, r, out) / area, b = window_side(r, p, out) / area;
    out.z = a * p.z + b * q.z + (1 - a - b) * r.z;
    return out;
}

/* Where that is in the world. */
static double3 in_world(const hatcher *h, window_point p)
{
    const stroke_camera *c = &h->v->camera;
    const double        *m = h->to_world.m, *e = c->projection.m;
    double               depth = view_depth(h->v, p.z), at[2];
    at[0] = 2 * p.x / (h->v->units * c->width) + (c->orthographic ? -e[12] : e[8]);
    at[1] = -2 * p.y / (h->v->units * c->height) + (c->orthographic ? -e[13] : e[9]);
    double scale = c->orthographic ? 1 : depth, x = at[0] / e[0] * scale, y = at[1] / e[5] * scale, z = -depth;
    return (double3){m[0] * x + m[4] * y + m[8] * z + m[12], m[1] * x + m[5] * y + m[9] * z + m[13],
                     m[2] * x + m[6] * y + m[10] * z + m[14]};
}

/* A position of the page on a cut face: its depth is that of the cutting plane, since faces of caps may be needles,
 * which know none. */
static window_point on_cap(const hatcher *h, const stretch *s, uint32_t triangle, const double page[2])
{
    const stroke_view   *v = h->v;
    const stroke_camera *c = &v->camera;
    const edge_cap      *cap = &v->scene->meshes[v->scene->items[s->item].mesh].caps[s->cap];
    const double        *m = h->to_world.m, *e = c->projection.m;
    window_point         out = on_plane(v, triangle, page);
    double               x = (2 * out.x / (v->units * c->width) + (c->orthographic ? -e[12] : e[8])) / e[0],
           y = (-2 * out.y / (v->units * c->height) + (c->orthographic ? -e[13] : e[9])) / e[5], away = cap->offset,
           nearer = 0;
    for (int k = 0; k < 3; k++) { /* from the page, or from the eye, on to the plane */
        double begin = m[12 + k] + (c->orthographic ? m[k] * x + m[4 + k] * y : 0),
               way = (c->orthographic ? 0 : m[k] * x + m[4 + k] * y) - m[8 + k];
        away -= cap->normal[k] * begin;
        nearer += cap->normal[k] * way;
    }
    double depth = away / nearer;
    if (fabs(nearer) > 1e-4 && isfinite(depth) && (c->orthographic || depth > 0))
        out.z = c->orthographic ? depth : -1 / depth;
    return out;
}

/* --- stretches ------------------------------------------------------------------------------------------ */

static bool put_stretch(hatcher *h, const stretch *s)
{
    if (!mem_grow((void **)&h->items, &h->capacity, h->count + 1, sizeof *h->items))
        return false;
    h->items[h->count++] = *s;
    return true;
}

/* As far as the solid ends with the face. */
static bool put_trimmed(hatcher *h, const hatching *g, const stretch *s)
{
    const stroke_view *v = h->v;
    const stroke_item *item = &v->scene->items[s->item];
    const mat4         inverse = mat4_inverse(&item->world);
    const solid_share *shares;
    size_t             count;
    double             ends[2][3];
    if (!h->trimmer || h->trimmed != s->item) {
        solid_trimmer_destroy(&h->trimmer);
        h->trimmer = solid_trimmer_create(v->scene->meshes[item->mesh].solid);
        h->trimmed = s->item;
    }
    for (int k = 0; k < 2; k++) {
        double page[2];
        position_on_line(g, s->line, k ? s->to : s->from, page);
        double3 p = in_world(h, on_plane(v, s->triangle, page));
        for (int row = 0; row < 3; row++)
            ends[k][row] =
                inverse.m[row] * p.x + inverse.m[4 + row] * p.y + inverse.m[8 + row] * p.z + inverse.m[12 + row];
    }
    if (!h->trimmer || !solid_trim(h->trimmer, v->triangles[s->triangle].face - v->items[s->item].first_face, ends[0],
                                   ends[1], &shares, &count))
        return false;
    for (size_t i = 0; i < count; i++) {
        stretch part = *s;
        double  share[2] = {shares[i].from, shares[i].to};
        if (!v->camera.orthographic) { /* even in the world is not even on the page */
            for (int k = 0; k < 2; k++) {
                double       page[2][2], at[3];
                window_point q;
                position_on_line(g, s->line, 0, page[0]);
                for (int row = 0; row < 3; row++)
                    at[row] = ends[0][row] + share[k] * (ends[1][row] - ends[0][row]);
                if (!view_position(v, item_position(item, (vec3){(float)at[0], (float)at[1], (float)at[2]}), &q))
                    return true;
                on_page(v, q, page[1]);
                double along = (page[1][0] - page[0][0]) * g->along[0] + (page[1][1] - page[0][1]) * g->along[1];
                share[k] = (along - s->from) / (s->to - s->from);
            }
        }
        part.from = s->from + share[0] * (s->to - s->from);
        part.to = s->from + share[1] * (s->to - s->from);
        if (part.from < part.to && !put_stretch(h, &part))
            return false;
    }
    return true;
}

/* The least and the greatest of a direction on the page. */
static void range_of_page(const stroke_view *v, const double way[2], double out[2])
{
    out[0] = fmin(0, way[0] * v->camera.width) + fmin(0, way[1] * v->camera.height);
    out[1] = fmax(0, way[0] * v->camera.width) + fmax(0, way[1] * v->camera.height);
}

static bool lay_over(hatcher *h, uint32_t triangle, uint32_t item, uint32_t cap, const edge_mesh *m)
{
    const stroke_view *v = h->v;
    hatching           g = hatching_of(h, item, &m->caps[cap]);
    double             along[3], across[3], page[2], least = INFINITY, most = -INFINITY, lines[2], ends[2];
    for (int k = 0; k < 3; k++) {
        on_page(v, v->points[v->triangles[triangle].v[k]], page);
        along[k] = page[0] * g.along[0] + page[1] * g.along[1];
        across[k] = page[0] * g.across[0] + page[1] * g.across[1];
        least = fmin(least, across[k]);
        most = fmax(most, across[k]);
    }
    range_of_page(v, g.across, lines);
    range_of_page(v, g.along, ends);
    int64_t first = (int64_t)ceil((fmax(least, lines[0]) + g.offset) / g.apart - 0.5),
            last = (int64_t)floor((fmin(most, lines[1]) + g.offset) / g.apart - 0.5);
    for (int64_t n = first; n <= last; n++) {
        double  at = ((double)n + 0.5) * g.apart - g.offset;
        stretch s = {item, cap, n, INFINITY, -INFINITY, triangle, triangle};
        for (int k = 0; k < 3; k++) {
            int next = (k + 1) % 3;
            if ((across[k] <= at) == (across[next] <= at))
                continue;
            double where = along[k] + (at - across[k]) / (across[next] - across[k]) * (along[next] - along[k]);
            s.from = fmin(s.from, where);
            s.to = fmax(s.to, where);
        }
        s.from = fmax(s.from, ends[0]);
        s.to = fmin(s.to, ends[1]);
        if (s.from < s.to && !(m->solid ? put_trimmed(h, &g, &s) : put_stretch(h, &s)))
            return false;
    }
    return true;
}

/* Of a half-space's box only one side cuts. */
static bool is_in_plane(const hatcher *h, uint32_t item, const edge_mesh *m, uint32_t face, const edge_cap *cap)
{
    double most = 0;
    for (int k = 0; k < 3; k++) {
        double3 p = item_position(&h->v->scene->items[item], m->positions[m->faces[face][k]]);
        most = fmax(most, fabs(p.x * cap->normal[0] + p.y * cap->normal[1] + p.z * cap->normal[2] - cap->offset));
    }
    return most <= 1e-4 * h->v->scene->extent;
}

/* The item of a face of the view. */
static uint32_t item_of(const stroke_view *v, uint32_t face)
{
    uint32_t low = 0, high = (uint32_t)v->scene->item_count;
    while (high - low > 1) {
        uint32_t middle = low + (high - low) / 2;
        if (v->items[middle].first_face <= face)
            low = middle;
        else
            high = middle;
    }
    return low;
}

static bool note_face(hatcher *h, uint32_t triangle, uint32_t item, uint32_t cap, const edge_mesh *m)
{
    if (!h->wants_areas || m->solid)
        return true;
    if (!mem_grow((void **)&h->faces, &h->face_capacity, h->face_count + 1, sizeof *h->faces))
        return false;
    h->faces[h->face_count++] = (cap_triangle){item, cap, triangle};
    return true;
}

static lmn_status lay_all(hatcher *h, lmn_error *error)
{
    const stroke_view *v = h->v;
    for (uint32_t i = 0; i < v->triangle_count; i++) {
        uint32_t         face = v->triangles[i].face, item = item_of(v, face), own = face - v->items[item].first_face;
        const edge_mesh *m = &v->scene->meshes[v->scene->items[item].mesh];
        if (!m->cap_count || !m->materials || m->materials[own] > EDGE_CAP_MATERIAL(0) ||
            (h->parts && !h->parts[v->scene->items[item].part_index]))
            continue;
        uint32_t cap = (uint32_t)(EDGE_CAP_MATERIAL(0) - m->materials[own]);
        if (m->solid && (!view_is_front(v, face) || !is_in_plane(h, item, m, own, &m->caps[cap])))
            continue;
        if (work_stopped() || !lay_over(h, i, item, cap, m) || !note_face(h, i, item, cap, m))
            return error_memory(error);
    }
    return LMN_OK;
}

static int compare_stretches(const void *a, const void *b)
{
    const stretch *p = a, *q = b;
    if (p->item != q->item)
        return p->item < q->item ? -1 : 1;
    if (p->cap != q->cap)
        return p->cap < q->cap ? -1 : 1;
    if (p->line != q->line)
        return p->line < q->line ? -1 : 1;
    return (p->from > q->from) - (p->from < q->from);
}

static void join_stretches(hatcher *h)
{
    size_t kept = 0;
    if (h->count)
        qsort(h->items, h->count, sizeof *h->items, compare_stretches);
    for (size_t i = 0; i < h->count; i++) {
        stretch *last = kept ? &h->items[kept - 1] : NULL, *s = &h->items[i];
        if (last && last->item == s->item && last->cap == s->cap && last->line == s->line &&
            s->from <= last->to + SAME_END)
            *last = (stretch){s->item,
                              s->cap,
                              s->line,
                              last->from,
                              fmax(last->to, s->to),
                              last->triangle,
                              s->to > last->to ? s->last : last->last};
        else
            h->items[kept++] = *s;
    }
    h->count = kept;
}

/* --- what is seen --------------------------------------------------------------------------------------- */

static bool put_line(hatch_lines *out, const stroke_view *v, const window_segment *s, double from, double to,
                     uint32_t part, uint32_t area)
{
    if (!mem_grow((void **)&out->items, &out->capacity, out->count + 1, sizeof *out->items))
        return false;
    hatch_line  *line = &out->items[out->count++];
    const double at[2] = {from, to};
    line->part = part;
    line->area = area;
    for (int k = 0; k < 2; k++) {
        double x = s->a.x + at[k] * ((double)s->b.x - s->a.x), y = s->a.y + at[k] * ((double)s->b.y - s->a.y);
        line->ends[k][0] = (float)(x / v->units + 0.5 * v->camera.width);
        line->ends[k][1] = (float)(y / v->units + 0.5 * v->camera.height);
        line->depths[k] = (float)view_depth(v, s->a.z + at[k] * (s->b.z - s->a.z));
    }
    return true;
}

/* --- areas ---------------------------------------------------------------------------------------------- */

void hatch_areas_release(hatch_areas *a)
{
    mem_free(a->items);
    mem_free(a->loops);
    mem_free(a->points);
    memset(a, 0, sizeof *a);
}

static int compare_faces(const void *a, const void *b)
{
    const cap_triangle *p = a, *q = b;
    if (p->item != q->item)
        return p->item < q->item ? -1 : 1;
    if (p->cap != q->cap)
        return p->cap < q->cap ? -1 : 1;
    return p->triangle < q->triangle ? -1 : p->triangle > q->triangle;
}

/* A side of a triangle, in the direction in which that is seen to run; one that another triangle has the other way
 * round is no rim. */
typedef struct rim {
    uint32_t from, to;
} rim;

static int compare_rims(const void *a, const void *b)
{
    const rim *p = a, *q = b;
    if (p->from != q->from)
        return p->from < q->from ? -1 : 1;
    return p->to < q->to ? -1 : p->to > q->to;
}

/* The first side that begins at a point, their number when there is none. */
static size_t first_rim(const rim *rims, size_t count, uint32_t from)
{
    size_t low = 0, high = count;
    while (low < high) {
        size_t middle = low + (high - low) / 2;
        if (rims[middle].from < from)
            low = middle + 1;
        else
            high = middle;
    }
    return low;
}

/* Sorts sides and gives those that do not run both ways, in order; returns how many. */
static size_t keep_rims(rim *rims, size_t count, rim *out)
{
    size_t kept = 0;
    qsort(rims, count, sizeof *rims, compare_rims);
    for (size_t i = 0; i < count; i++) {
        bool both = false;
        for (size_t k = first_rim(rims, count, rims[i].to); k < count && rims[k].from == rims[i].to && !both; k++)
            both = rims[k].to == rims[i].from;
        if (!both)
            out[kept++] = rims[i];
    }
    return kept;
}

static bool put_area_point(hatch_areas *out, const stroke_view *v, uint32_t point)
{
    double page[2];
    if (!mem_grow((void **)&out->points, &out->point_capacity, out->point_count + 1, sizeof *out->points))
        return false;
    on_page(v, v->points[point], page);
    out->points[out->point_count][0] = (float)page[0];
    out->points[out->point_count++][1] = (float)(v->camera.height - page[1]);
    return true;
}

static bool begin_loop(hatch_areas *out)
{
    if (!mem_grow((void **)&out->loops, &out->loop_capacity, out->loop_count + 2, sizeof *out->loops))
        return false;
    out->loops[out->loop_count++] = (uint32_t)out->point_count;
    out->loops[out->loop_count] = (uint32_t)out->point_count;
    return true;
}

/* From each side on to one that begins where it ends, until one ends where the first began. */
static bool put_loops(hatch_areas *out, const stroke_view *v, const rim *rims, size_t count, uint8_t *used)
{
    for (size_t i = 0; i < count; i++) {
        if (used[i])
            continue;
        if (!begin_loop(out))
            return false;
        for (size_t at = i; at < count && rims[at].from != NO_VERTEX;) {
            used[at] = 1;
            if (!put_area_point(out, v, rims[at].from))
                return false;
            if (rims[at].to == rims[i].from)
                break;
            size_t next = first_rim(rims, count, rims[at].to);
            while (next < count && rims[next].from == rims[at].to && used[next])
                next++;
            at = next < count && rims[next].from == rims[at].to ? next : count;
        }
        out->loops[out->loop_count] = (uint32_t)out->point_count;
    }
    return true;
}

static bool put_area(hatch_areas *out, const hatcher *h, const cap_triangle *faces, size_t count)
{
    const stroke_view *v = h->v;
    rim               *rims = mem_alloc(3 * count * sizeof *rims), *kept = mem_alloc(3 * count * sizeof *rims);
    uint8_t           *used = mem_calloc(3 * count + 1, 1);
    bool               good =
        rims && kept && used && mem_grow((void **)&out->items, &out->capacity, out->count + 1, sizeof *out->items);
    for (size_t i = 0; good && i < 3 * count; i++) {
        const uint32_t *t = v->triangles[faces[i / 3].triangle].v;
        rims[i] = (rim){t[i % 3], t[(i % 3 + 1) % 3]};
    }
    if (good) {
        const hatching g =
            hatching_of(h, faces->item, &v->scene->meshes[v->scene->items[faces->item].mesh].caps[faces->cap]);
        double at[2];
        position_on_line(&g, 0, 0, at);
        out->items[out->count] = (hatch_area){.part = v->scene->items[faces->item].part_index + 1,
                                              .apart = g.apart,
                                              .angle = -atan2(g.along[1], g.along[0]),
                                              .origin = {at[0], v->camera.height - at[1]},
                                              .first = (uint32_t)out->loop_count};
        size_t left = keep_rims(rims, 3 * count, kept);
        good = put_loops(out, v, kept, left, used);
        out->items[out->count].count = (uint32_t)out->loop_count - out->items[out->count].first;
        out->count += good;
    }
    mem_free(rims);
    mem_free(kept);
    mem_free(used);
    return good;
}

/* Which stretches are seen from one end to the other with all others of their face? `wholes` gets 1 + the area of
 * each. */
static bool find_areas(hatch_areas *out, hatcher *h, const visibility *seen, uint32_t *wholes)
{
    if (h->face_count)
        qsort(h->faces, h->face_count, sizeof *h->faces, compare_faces);
    for (size_t i = 0, end, face = 0; i < h->count; i = end) {
        const stretch *s = &h->items[i];
        bool           whole = true;
        for (end = i; end < h->count && h->items[end].item == s->item && h->items[end].cap == s->cap; end++)
            whole =
                whole && seen->starts[end + 1] - seen->starts[end] == 1 && seen->spans[seen->starts[end]].count == 0;
        while (face < h->face_count &&
               (h->faces[face].item < s->item || (h->faces[face].item == s->item && h->faces[face].cap < s->cap)))
            face++;
        size_t last = face;
        while (last < h->face_count && h->faces[last].item == s->item && h->faces[last].cap == s->cap)
            last++;
        if (!whole || last == face)
            continue;
        if (!put_area(out, h, h->faces + face, last - face))
            return false;
        for (size_t k = i; k < end; k++)
            wholes[k] = (uint32_t)out->count;
    }
    return true;
}

/* --- all ------------------------------------------------------------------------------------------------ */

static void fill_segments(const hatcher *h, window_segment *segments)
{
    const stroke_view *v = h->v;
    for (size_t i = 0; i < h->count; i++) {
        const stretch *s = &h->items[i];
        hatching       g = hatching_of(h, s->item, &v->scene->meshes[v->scene->items[s->item].mesh].caps[s->cap]);
        double         ends[2][2];
        position_on_line(&g, s->line, s->from, ends[0]);
        position_on_line(&g, s->line, s->to, ends[1]);
        segments[i] = (window_segment){.a = on_cap(h, s, s->triangle, ends[0]),
                                       .b = on_cap(h, s, s->last, ends[1]),
                                       .ends = {NO_VERTEX, NO_VERTEX},
                                       .faces = {v->triangles[s->triangle].face, EDGE_NO_FACE}};
    }
}

static lmn_status keep_seen(hatch_lines *out, hatch_areas *areas, hatcher *h, lmn_error *error)
{
    const stroke_view *v = h->v;
    window_segment    *segments = mem_calloc(h->count + 1, sizeof *segments);
    uint32_t          *wholes = mem_calloc(h->count + 1, sizeof *wholes);
    visibility         seen = {.spans = NULL};
    lmn_status         status = segments && wholes ? LMN_OK : error_memory(error);
    if (status == LMN_OK) {
        fill_segments(h, segments);
        status = visibility_find(&seen, v, segments, h->count, NULL, NULL, error);
    }
    if (status == LMN_OK && areas && !find_areas(areas, h, &seen, wholes))
        status = error_memory(error);
    for (size_t i = 0; i < h->count && status == LMN_OK; i++)
        for (uint32_t k = seen.starts[i]; k < seen.starts[i + 1] && status == LMN_OK; k++) {
            double to = k + 1 < seen.starts[i + 1] ? (double)seen.spans[k + 1].from : 1;
            if (seen.spans[k].count == 0 && !put_line(out, v, &segments[i], (double)seen.spans[k].from, to,
                                                      v->scene->items[h->items[i].item].part_index + 1, wholes[i]))
                status = error_memory(error);
        }
    visibility_release(&seen);
    mem_free(segments);
    mem_free(wholes);
    return status;
}

lmn_status hatch_find(hatch_lines *out, hatch_areas *areas, const stroke_view *v, double apart, double angle,
                      const bool *parts, lmn_error *error)
{
    hatcher h = {.v = v,
                 .parts = parts,
                 .apart = apart,
                 .angle = angle,
                 .to_world = mat4_inverse(&v->camera.view),
                 .wants_areas = areas != NULL};
    memset(out, 0, sizeof *out);
    if (areas)
        memset(areas, 0, sizeof *areas);
    lmn_status status = apart > 0 ? lay_all(&h, error) : LMN_OK;
    join_stretches(&h);
    if (status == LMN_OK && h.count)
        status = keep_seen(out, areas, &h, error);
    solid_trimmer_destroy(&h.trimmer);
    mem_free(h.items);
    mem_free(h.faces);
    if (status != LMN_OK) {
        mem_free(out->items);
        memset(out, 0, sizeof *out);
        if (areas)
            hatch_areas_release(areas);
    }
    return status;
}

lmn_status hatch_verify(stroke_check *out, const hatch_lines *lines, const stroke_view *v, float apart,
                        lmn_error *error)
{
    stroke_set set = {.strokes = mem_calloc(lines->count + 1, sizeof *set.strokes),
                      .points = mem_calloc(2 * lines->count + 1, sizeof *set.points),
                      .stroke_count = lines->count,
                      .point_count = 2 * lines->count};
    lmn_status status = set.strokes && set.points ? LMN_OK : error_memory(error);
    for (size_t i = 0; i < lines->count && status == LMN_OK; i++) {
        const hatch_line *l = &lines->items[i];
        set.strokes[i] = (stroke){.part = l->part, .first = (uint32_t)(2 * i), .count = 2};
        for (int k = 0; k < 2; k++)
            set.points[2 * i + (size_t)k] =
                (stroke_point){.x = l->ends[k][0], .y = l->ends[k][1], .depth = l->depths[k]};
    }
    if (status == LMN_OK)
        status = stroke_verify(out, &set, v, apart, NULL, NULL, error);
    mem_free(set.strokes);
    mem_free(set.points);
    return status;
}
