/* The surface below a field: positions joined, split at feature edges. */
#include <string.h>

#include "base/groups.h"
#include "base/memory.h"
#include "base/threads.h"
#include "field/direction_field_private.h"

enum { ELEMENTS_PER_THREAD = 8192 };

static bool is_finite_point(vec3 p)
{
    return isfinite(p.x) && isfinite(p.y) && isfinite(p.z);
}

static uint64_t hash_triangle(const uint32_t sorted[3])
{
    uint64_t h = (sorted[0] | (uint64_t)sorted[1] << 32) * UINT64_C(0xBF58476D1CE4E5B9);
    h = ((h ^ h >> 32) + sorted[2]) * UINT64_C(0x94D049BB133111EB);
    return h ^ h >> 29;
}

static void sort_three(const uint32_t *in, uint32_t out[3])
{
    uint32_t a = in[0], b = in[1], c = in[2], low = a < b ? a : b, high = a < b ? b : a;
    out[0] = low < c ? low : c;
    out[2] = high > c ? high : c;
    out[1] = low < c ? (high < c ? high : c) : low;
}

/* Puts triangle number `next` into the table, unless one of the same corners is there: then gives that. */
static uint32_t find_copy(const uint32_t *indices, uint32_t *slots, size_t mask, uint32_t next)
{
    uint32_t key[3], other[3];
    sort_three(indices + 3 * (size_t)next, key);
    for (size_t slot = hash_triangle(key) & mask;; slot = (slot + 1) & mask) {
        if (slots[slot] == NOWHERE) {
            slots[slot] = next;
            return next;
        }
        sort_three(indices + 3 * (size_t)slots[slot], other);
        if (memcmp(key, other, sizeof key) == 0)
            return slots[slot];
    }
}

/* Fills kept, triangles, triangle_count and the reduced indices. */
static bool keep_triangles(field_surface *s, const primitive *p, uint32_t *indices)
{
    size_t count = p->index_count / 3, size = 64;
    while (size < count * 2)
        size *= 2;
    uint32_t *slots = mem_alloc(size * sizeof *slots);
    if (!slots)
        return false;
    memset(slots, 0xFF, size * sizeof *slots);
    for (size_t t = 0; t < count; t++) {
        uint32_t next = s->triangle_count, *to = indices + 3 * (size_t)next;
        bool     good = true;
        for (int k = 0; k < 3; k++) {
            to[k] = s->ids[p->indices[3 * t + (size_t)k]];
            good = good && is_finite_point(p->positions[to[k]]);
        }
        if (!good || to[0] == to[1] || to[1] == to[2] || to[2] == to[0]) {
            s->kept[t] = NOWHERE;
            continue;
        }
        s->kept[t] = find_copy(indices, slots, size - 1, next);
        if (s->kept[t] == next)
            s->triangles[s->triangle_count++] = (uint32_t)t;
    }
    mem_free(slots);
    return true;
}

static uint32_t next_corner(uint32_t h)
{
    return h % 3 == 2 ? h - 2 : h + 1;
}

/* Centres and scales: a model of any size and position gives the same numbers. */
static void find_scale(field_surface *s, const primitive *m, point3 *centre)
{
    point3 low = {INFINITY, INFINITY, INFINITY}, high = {-INFINITY, -INFINITY, -INFINITY};
    for (uint32_t i = 0; i < 3 * s->triangle_count; i++) {
        vec3 p = m->positions[m->indices[i]];
        low = (point3){fmin(low.x, p.x), fmin(low.y, p.y), fmin(low.z, p.z)};
        high = (point3){fmax(high.x, p.x), fmax(high.y, p.y), fmax(high.z, p.z)};
    }
    double size = s->triangle_count ? point_length(point_sub(high, low)) : 0;
    s->size = size > 0 && isfinite(size) ? size : 1;
    *centre = s->triangle_count ? point_scale(point_add(low, high), 0.5) : (point3){0, 0, 0};
    double far =
        fmax(fmax(fmax(fabs(low.x), fabs(high.x)), fmax(fabs(low.y), fabs(high.y))), fmax(fabs(low.z), fabs(high.z)));
    s->rounding = s->triangle_count ? 6e-8 * far / s->size : 0;
}

static point3 position(const field_surface *s, const primitive *m, point3 centre, uint32_t corner)
{
    vec3 p = m->positions[m->indices[corner]];
    return point_scale(point_sub((point3){p.x, p.y, p.z}, centre), 1 / s->size);
}

static void measure_triangles(field_surface *s, const primitive *m, point3 centre)
{
    double sum = 0;
    for (uint32_t t = 0; t < s->triangle_count; t++) {
        point3 a = position(s, m, centre, 3 * t), b = position(s, m, centre, 3 * t + 1),
               c = position(s, m, centre, 3 * t + 2);
        point3 u = point_sub(b, a), v = point_sub(c, a), w = point_sub(c, b), n = point_cross(u, v);
        double longest = fmax(fmax(point_dot(u, u), point_dot(v, v)), point_dot(w, w)), length = point_length(n);
        /* Below what the positions' rounding can turn, a normal is noise. */
        bool thin = !(length > 1e-9 * longest) || !(length > 4 * s->rounding * sqrt(longest));
        s->areas[t] = length / 2;
        s->directions[t] = thin ? (point3){0, 0, 0} : point_scale(n, 1 / length);
        sum += point_length(u) + point_length(v) + point_length(w);
    }
    s->mean_edge = s->triangle_count ? sum / 3 / s->triangle_count : 1;
}

static bool same_direction(const primitive *m, uint32_t h, uint32_t o)
{
    return m->indices[h] == m->indices[o];
}

/* Turns neighbours until they agree. `queue` has room for all triangles. */
static void agree_on_windings(field_surface *s, const primitive *m, uint32_t *queue, bool *seen)
{
    for (uint32_t first = 0; first < s->triangle_count; first++) {
        uint32_t begin = 0, end = 0;
        if (seen[first])
            continue;
        seen[first] = true;
        queue[end++] = first;
        while (begin < end) {
            uint32_t t = queue[begin++];
            for (uint32_t h = 3 * t; h < 3 * t + 3; h++) {
                uint32_t o = s->opposite[h];
                if (o == NOWHERE || seen[o / 3])
                    continue;
                seen[o / 3] = true;
                s->turned[o / 3] = s->turned[t] != same_direction(m, h, o);
                queue[end++] = o / 3;
            }
        }
    }
}

/* Is an edge shaded as if it were round, though its triangles meet at an angle? Coarse meshes of round things are. */
static bool shaded_round(const field_surface *s, const primitive *p, const primitive *m, uint32_t h, uint32_t o)
{
    const float round_to = 0.985f; /* cosine of 10 degrees */
    bool        same = same_direction(m, h, o);
    uint32_t    ends[2][2] = {{h, same ? o : next_corner(o)}, {next_corner(h), same ? next_corner(o) : o}};
    for (int k = 0; k < 2 && p->normals; k++) {
        vec3 a = p->normals[p->indices[3 * s->triangles[ends[k][0] / 3] + ends[k][0] % 3]],
             b = p->normals[p->indices[3 * s->triangles[ends[k][1] / 3] + ends[k][1] % 3]];
        if (!(a.x * b.x + a.y * b.y + a.z * b.z > round_to))
            return false;
    }
    return p->normals != NULL;
}

/* Cuts the adjacency at features and joins corners over all other edges. */
static void join_corners(field_surface *s, const primitive *p, const primitive *m, uint32_t *parents,
                         double cos_feature)
{
    const double sharp = 0.5; /* cosine of an angle at which no shading hides an edge */
    for (uint32_t c = 0; c < 3 * s->triangle_count; c++)
        parents[c] = c;
    for (uint32_t h = 0; h < 3 * s->triangle_count; h++) {
        uint32_t o = s->opposite[h];
        if (o == NOWHERE || o < h)
            continue;
        point3 a = s->directions[h / 3], b = s->directions[o / 3];
        double cosine = point_dot(a, b) * (s->turned[h / 3] == s->turned[o / 3] ? 1 : -1);
        /* A triangle without a direction goes along with any. */
        if (cosine < cos_feature && point_dot(a, a) > 0 && point_dot(b, b) > 0 &&
            (cosine < sharp || !shaded_round(s, p, m, h, o))) {
            s->opposite[h] = s->opposite[o] = NOWHERE;
            s->features[h] = s->features[o] = s->cut = true;
            continue;
        }
        bool same = same_direction(m, h, o);
        group_join(parents, h, same ? o : next_corner(o));
        group_join(parents, next_corner(h), same ? next_corner(o) : o);
    }
}

/* Numbers the elements in the order of corners; needs parents that are never greater than their children. */
static void number_elements(field_surface *s, uint32_t *parents)
{
    for (uint32_t c = 0; c < 3 * s->triangle_count; c++) {
        uint32_t r = group_root(parents, c);
        s->corners[c] = r == c ? s->element_count++ : s->corners[r];
    }
}

static void list_corners(field_surface *s)
{
    for (uint32_t c = 0; c < 3 * s->triangle_count; c++)
        s->starts[s->corners[c] + 2]++;
    for (uint32_t e = 0; e < s->element_count; e++)
        s->starts[e + 2] += s->starts[e + 1];
    for (uint32_t c = 0; c < 3 * s->triangle_count; c++)
        s->around[s->starts[s->corners[c] + 1]++] = c;
}

/* Weights after Max: exact on spheres however irregular the triangles are. */
static void make_normals(size_t begin, size_t end, void *user)
{
    field_surface *s = user;
    for (size_t e = begin; e < end; e++) {
        point3 sum = {0, 0, 0}, any = {0, 0, 0};
        for (uint32_t i = s->starts[e]; i < s->starts[e + 1]; i++) {
            uint32_t c = s->around[i], b = next_corner(c), d = next_corner(b);
            point3   u = point_sub(s->positions[s->corners[b]], s->positions[e]);
            point3   v = point_sub(s->positions[s->corners[d]], s->positions[e]);
            double   weight = 2 * s->areas[c / 3] / (point_dot(u, u) * point_dot(v, v)) * (s->turned[c / 3] ? -1 : 1);
            if (isfinite(weight))
                sum = point_add(sum, point_scale(s->directions[c / 3], weight));
            if (point_dot(any, any) == 0)
                any = s->directions[c / 3];
        }
        s->normals[e] = point_unit_or(sum, point_unit_or(any, (point3){0, 0, 1}));
    }
}

static bool make_elements(field_surface *s, const primitive *p, const primitive *m, point3 centre, double feature_angle)
{
    size_t    corner_count = 3 * (size_t)s->triangle_count;
    uint32_t *parents = mem_alloc(corner_count * sizeof *parents);
    bool     *seen = mem_calloc(s->triangle_count, sizeof *seen);
    bool      good = parents && seen;
    if (good) {
        agree_on_windings(s, m, parents, seen);
        join_corners(s, p, m, parents, feature_angle >= 3.14159 ? -2 : cos(feature_angle) - 1e-6);
        number_elements(s, parents);
    }
    mem_free(parents);
    mem_free(seen);
    s->starts = good ? mem_calloc((size_t)s->element_count + 2, sizeof *s->starts) : NULL;
    s->positions = mem_alloc(s->element_count * sizeof *s->positions);
    s->normals = mem_alloc(s->element_count * sizeof *s->normals);
    if (!good || !s->starts || !s->positions || !s->normals)
        return false;
    list_corners(s);
    for (uint32_t c = 0; c < corner_count; c++)
        s->positions[s->corners[c]] = position(s, m, centre, c);
    threads_for(s->element_count, ELEMENTS_PER_THREAD, make_normals, s);
    return true;
}

static bool make_surface(field_surface *s, const primitive *p, uint32_t *indices, double feature_angle)
{
    primitive m = {.vertex_count = p->vertex_count, .positions = p->positions, .indices = indices};
    point3    centre;
    if (!keep_triangles(s, p, indices))
        return false;
    m.index_count = 3 * s->triangle_count;
    s->opposite = mesh_adjacency(&m);
    s->corners = mem_alloc((size_t)m.index_count * sizeof *s->corners);
    s->around = mem_alloc((size_t)m.index_count * sizeof *s->around);
    s->directions = mem_alloc(s->triangle_count * sizeof *s->directions);
    s->areas = mem_alloc(s->triangle_count * sizeof *s->areas);
    s->turned = mem_calloc(s->triangle_count, sizeof *s->turned);
    s->features = mem_calloc(m.index_count, sizeof *s->features);
    if (!s->opposite || !s->corners || !s->around || !s->directions || !s->areas || !s->turned || !s->features)
        return false;
    find_scale(s, &m, &centre);
    measure_triangles(s, &m, centre);
    return make_elements(s, p, &m, centre, feature_angle);
}

lmn_status field_surface_make(field_surface *out, const primitive *p, double feature_angle, lmn_error *error)
{
    memset(out, 0, sizeof *out);
    size_t    corner_count = p->index_count / 3 * 3;
    uint32_t *indices = mem_alloc(corner_count * sizeof *indices + 3 * sizeof *indices);
    out->triangles = mem_alloc(corner_count / 3 * sizeof *out->triangles);
    out->kept = mem_alloc(corner_count / 3 * sizeof *out->kept);
    out->ids = mesh_position_ids(p);
    bool good = indices && out->triangles && out->kept && out->ids && make_surface(out, p, indices, feature_angle);
    mem_free(indices);
    if (good)
        return LMN_OK;
    field_surface_release(out);
    return error_memory(error);
}

void field_surface_release(field_surface *s)
{
    void *const blocks[] = {s->triangles, s->kept,    s->ids,        s->corners, s->opposite, s->starts,  s->around,
                            s->positions, s->normals, s->directions, s->areas,   s->turned,   s->features};
    for (size_t i = 0; i < sizeof blocks / sizeof *blocks; i++)
        mem_free(blocks[i]);
    memset(s, 0, sizeof *s);
}

uint32_t field_surface_element(const field_surface *s, const primitive *p, uint32_t corner)
{
    uint32_t t = s->kept[corner / 3];
    if (t == NOWHERE)
        return NOWHERE;
    uint32_t own = s->triangles[t];
    for (uint32_t k = 0; k < 3; k++)
        if (s->ids[p->indices[3 * own + k]] == s->ids[p->indices[corner]])
            return s->corners[3 * t + k];
    return NOWHERE;
}
