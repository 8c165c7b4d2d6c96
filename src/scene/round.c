/* See round.h. In rounds: each halves the edges that lie too far off, at all triangles that have them, so that the mesh
 * stays whole; triangles with one, two or three halved edges become two, three or four. */
#include "scene/round.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "base/vector3.h"
#include "scene/mesh.h"
#include "scene/round_private.h"

enum { ROUNDS = 4, WHOLE = -1, SILHOUETTE = ROUND_SILHOUETTE };

static vec3 vec_of(const double p[3])
{
    return (vec3){(float)p[0], (float)p[1], (float)p[2]};
}

/* --- copies --------------------------------------------------------------------------------------------- */

/* An array's elements as `source` lists them, NULL: as they are. */
static bool copy_listed(void **out, const void *from, size_t size, const uint32_t *source, size_t count)
{
    *out = NULL;
    if (!from)
        return true;
    char *made = mem_alloc(count * size + 1);
    for (size_t i = 0; made && i < count; i++)
        memcpy(made + i * size, (const char *)from + (source ? source[i] : i) * size, size);
    *out = made;
    return made != NULL;
}

static bool copy_morphs(primitive *out, const primitive *p, const uint32_t *source)
{
    if (!p->morph_count)
        return true;
    out->morphs = mem_calloc(p->morph_count, sizeof *out->morphs);
    bool good = out->morphs != NULL;
    for (size_t i = 0; i < p->morph_count && good; i++) {
        out->morph_count = i + 1;
        good = copy_listed((void **)&out->morphs[i].positions, p->morphs[i].positions, sizeof(vec3), source,
                           out->vertex_count) &&
               copy_listed((void **)&out->morphs[i].normals, p->morphs[i].normals, sizeof(vec3), source,
                           out->vertex_count);
    }
    return good;
}

/* With normals, which are made where there are none. */
static lmn_status copy_primitive(primitive *out, const primitive *p, double crease_angle, lmn_error *error)
{
    render_vertices v = {.vertex_count = p->vertex_count};
    if (!p->normals && p->indices) {
        lmn_status status = mesh_make_normals(&v, p, crease_angle, error);
        if (status != LMN_OK)
            return status;
    }
    const uint32_t *source = v.source;
    size_t          count = v.vertex_count;
    *out = (primitive){.vertex_count = v.vertex_count,
                       .index_count = p->index_count,
                       .influences = p->influences,
                       .line_count = p->line_count,
                       .edge_lines = p->edge_lines,
                       .material = p->material,
                       .bounds = p->bounds};
    bool good = copy_listed((void **)&out->positions, p->positions, sizeof(vec3), source, count) &&
                copy_listed((void **)&out->normals, p->normals ? p->normals : v.normals, sizeof(vec3), NULL, count) &&
                copy_listed((void **)&out->straight, p->straight, sizeof(vec3), source, count) &&
                copy_listed((void **)&out->colours, p->colours, sizeof(vec4), source, count) &&
                copy_listed((void **)&out->joints, p->joints, p->influences * sizeof(uint16_t), source, count) &&
                copy_listed((void **)&out->weights, p->weights, p->influences * sizeof(float), source, count) &&
                copy_listed((void **)&out->indices, v.indices ? v.indices : p->indices, sizeof(uint32_t), NULL,
                            p->index_count) &&
                copy_listed((void **)&out->lines, p->lines, 2 * sizeof(uint32_t), NULL, p->line_count) &&
                copy_listed((void **)&out->edges.values, p->edges.values, 1, NULL, p->index_count) &&
                copy_morphs(out, p, source);
    for (int i = 0; i < UV_SETS && good; i++)
        good = copy_listed((void **)&out->uvs[i], p->uvs[i], sizeof(vec2), source, count);
    render_vertices_release(&v);
    return good ? LMN_OK : error_memory(error);
}

/* Numbers of positions, over all primitives: two may meet where one ends. */
static lmn_status number_positions(rounding *r, lmn_error *error)
{
    size_t total = 0;
    for (size_t i = 0; i < r->part_count; i++)
        total += r->parts[i].made.vertex_count;
    if (total >= UINT32_MAX)
        return error_set(error, LMN_LIMIT, "a mesh with %zu vertices cannot be made round", total);
    primitive all = {.vertex_count = (uint32_t)total, .positions = mem_alloc(total * sizeof(vec3) + 1)};
    size_t    at = 0;
    for (size_t i = 0; all.positions && i < r->part_count; i++) {
        memcpy(all.positions + at, r->parts[i].made.positions, r->parts[i].made.vertex_count * sizeof(vec3));
        at += r->parts[i].made.vertex_count;
    }
    uint32_t *ids = all.positions ? mesh_position_ids(&all) : NULL;
    bool      good = ids && mesh_weld_near(all.positions, ids, total, mesh_near(all.positions, total));
    at = 0;
    for (size_t i = 0; i < r->part_count && good; i++) {
        growing *g = &r->parts[i];
        g->room = g->made.vertex_count;
        g->positions = mem_copy(ids + at, g->room * sizeof *ids);
        good = g->positions != NULL;
        at += g->room;
    }
    r->position_count = (uint32_t)total;
    mem_free(ids);
    mem_free(all.positions);
    return good ? LMN_OK : error_memory(error);
}

/* --- what edges are ------------------------------------------------------------------------------------- */

static int compare_places(const void *one, const void *other)
{
    return memcmp(((const round_crease *)one)->ends, ((const round_crease *)other)->ends, sizeof(vec3[2]));
}

/* One place, however zero is written; the same edge either way round. */
static round_crease place_of(vec3 a, vec3 b, float turn)
{
    vec3 from = {a.x + 0.0f, a.y + 0.0f, a.z + 0.0f}, to = {b.x + 0.0f, b.y + 0.0f, b.z + 0.0f};
    bool turned = memcmp(&from, &to, sizeof from) > 0;
    return (round_crease){{turned ? to : from, turned ? from : to}, turn};
}

/* Where free forms alone are round, all else is judged by whoever draws it. */
static uint8_t *say_edges(const primitive *p, const round_crease *places, size_t count, bool forms_only)
{
    uint8_t *out = mem_alloc((size_t)p->index_count + 1);
    if (out && forms_only)
        memset(out, ROUND_NOTHING, p->index_count);
    for (uint32_t c = 0; out && !forms_only && c < p->index_count; c++) {
        round_crease        own = place_of(p->positions[p->indices[c]], p->positions[p->indices[next_corner(c)]], 0);
        const round_crease *found = bsearch(&own, places, count, sizeof own, compare_places);
        out[c] = found ? edge_turned(found->turn) : SILHOUETTE;
    }
    return out;
}

/* Of primitives whose file does not. */
static lmn_status say_all_edges(rounding *r, const round_options *options, lmn_error *error)
{
    round_crease *places = mem_alloc(options->sharp_count * sizeof *places + 1);
    bool          good = places != NULL;
    for (size_t i = 0; i < options->sharp_count && good; i++)
        places[i] = place_of(options->sharp[i].ends[0], options->sharp[i].ends[1], options->sharp[i].turn);
    if (good)
        qsort(places, options->sharp_count, sizeof *places, compare_places);
    for (size_t i = 0; i < r->part_count && good; i++) {
        primitive *p = &r->parts[i].made;
        if (p->indices && !p->edges.values)
            good = (p->edges.values = say_edges(p, places, options->sharp_count, options->forms_only)) != NULL;
    }
    mem_free(places);
    return good ? LMN_OK : error_memory(error);
}

/* --- one round: which edges are halved ------------------------------------------------------------------ */

static int compare_halves(const void *one, const void *other)
{
    const half_edge *a = one, *b = other;
    if (a->ends != b->ends)
        return a->ends < b->ends ? -1 : 1;
    if (a->primitive != b->primitive)
        return a->primitive < b->primitive ? -1 : 1;
    return (a->corner > b->corner) - (a->corner < b->corner);
}

static void list_halves(rounding *r)
{
    size_t count = 0;
    for (size_t i = 0; i < r->part_count; i++) {
        const growing *g = &r->parts[i];
        for (uint32_t c = 0; c < g->made.index_count; c++) {
            uint32_t a = g->positions[g->made.indices[c]], b = g->positions[g->made.indices[next_corner(c)]];
            uint64_t low = a < b ? a : b, high = a < b ? b : a;
            if (a != b)
                r->halves[count++] = (half_edge){low << 32 | high, (uint32_t)i, c};
        }
    }
    r->half_count = count;
    qsort(r->halves, count, sizeof *r->halves, compare_halves);
}

/* Which corners lie at each position. */
static bool list_corners(rounding *r, size_t corner_count)
{
    mem_free(r->starts);
    mem_free(r->corners);
    r->starts = mem_calloc((size_t)r->position_count + 2, sizeof *r->starts);
    r->corners = mem_alloc(corner_count * sizeof *r->corners + 1);
    if (!r->starts || !r->corners)
        return false;
    uint32_t *ends = r->starts + 1; /* counts first, then where the next goes */
    for (int pass = 0; pass < 2; pass++) {
        for (size_t i = 0; i < r->part_count; i++) {
            const growing *g = &r->parts[i];
            for (uint32_t c = 0; c < g->made.index_count; c++) {
                uint32_t at = g->positions[g->made.indices[c]];
                if (pass)
                    r->corners[ends[at]++] = (half_edge){0, (uint32_t)i, c};
                else
                    r->starts[at + 2]++;
            }
        }
        for (uint32_t k = 0; !pass && k < r->position_count; k++)
            r->starts[k + 2] += r->starts[k + 1];
    }
    return true;
}

/* The vertices of a half-edge, that of the lower position first. */
static void vertices_of(const rounding *r, const half_edge *h, uint32_t out[2])
{
    const growing *g = &r->parts[h->primitive];
    uint32_t       a = g->made.indices[h->corner], b = g->made.indices[next_corner(h->corner)];
    bool           turned = g->positions[a] > g->positions[b];
    out[0] = turned ? b : a;
    out[1] = turned ? a : b;
}

/* From `from` to `to`, without what lies along the normal. */
static void flat_between(double out[3], vec3 from, vec3 to, const double normal[3])
{
    double begin[3];
    point_of(begin, from);
    point_of(out, to);
    vector3_add(out, out, -1, begin);
    vector3_add(out, out, -vector3_dot(out, normal), normal);
}

/* In how many lengths of the edge from vertex `end` to `far` the triangle at this corner ends on the other side of
 * `end`; INFINITY: it does not lie there. */
static double reach_over(const primitive *p, uint32_t end, uint32_t far, const primitive *other, uint32_t corner)
{
    const uint32_t *t = &other->indices[corner - corner % 3];
    double          n[3], back[3], one[3], two[3];
    point_of(n, p->normals[end]);
    flat_between(back, p->positions[far], p->positions[end], n);
    flat_between(one, p->positions[end], other->positions[t[(corner + 1) % 3]], n);
    flat_between(two, p->positions[end], other->positions[t[(corner + 2) % 3]], n);
    /* back = s · one + u · two, by least squares: all three lie in one plane. */
    double aa = vector3_dot(one, one), ab = vector3_dot(one, two), bb = vector3_dot(two, two);
    double ac = vector3_dot(one, back), bc = vector3_dot(two, back);
    double area = aa * bb - ab * ab;
    double s = ac * bb - bc * ab, u = bc * aa - ac * ab;
    return area > 0 && s >= 0 && u >= 0 && s + u > 0 ? area / (s + u) : INFINITY;
}

/* Of all triangles around, those that this side goes on into smoothly. */
static double beyond_of(const rounding *r, const primitive *p, uint32_t position, uint32_t end, uint32_t far)
{
    const float SAME = 0.99f;
    vec3        n = p->normals[end];
    double      least = INFINITY;
    for (uint32_t i = r->starts[position]; i < r->starts[position + 1]; i++) {
        const primitive *other = &r->parts[r->corners[i].primitive].made;
        vec3             is = other->normals[other->indices[r->corners[i].corner]];
        if (is.x * n.x + is.y * n.y + is.z * n.z > SAME)
            least = fmin(least, reach_over(p, end, far, other, r->corners[i].corner));
    }
    return least;
}

static round_side side_of(const rounding *r, const half_edge *h)
{
    const primitive *p = &r->parts[h->primitive].made;
    const uint32_t  *t = &p->indices[h->corner - h->corner % 3];
    round_side       side;
    double           at[3][3], one[3], two[3];
    uint32_t         v[2];
    for (int k = 0; k < 3; k++)
        point_of(at[k], p->positions[t[k]]);
    vector3_add(one, at[1], -1, at[0]);
    vector3_add(two, at[2], -1, at[0]);
    vector3_cross(side.face, one, two);
    vector3_normalise(side.face);
    vertices_of(r, h, v);
    uint32_t plane = r->parts[h->primitive].planes[h->corner / 3];
    side.plane = is_plane(plane);
    if (side.plane)
        vector3_copy(side.face, r->planes[plane]);
    for (int k = 0; k < 2; k++) {
        if (side.plane)
            vector3_copy(side.normals[k], side.face);
        else
            point_of(side.normals[k], p->normals[v[k]]);
        side.beyond[k] = beyond_of(r, p, r->parts[h->primitive].positions[v[k]], v[k], v[1 - k]);
    }
    return side;
}

/* The edge of which halves[0] … halves[count − 1] are the sides; more than two are none that one surface has, and the
 * first two say what becomes of it. */
static round_edge edge_of(const rounding *r, const half_edge *halves, size_t count)
{
    const primitive *p = &r->parts[halves[0].primitive].made;
    uint32_t         v[2];
    double           ends[2][3];
    vertices_of(r, &halves[0], v);
    for (int k = 0; k < 2; k++)
        point_of(ends[k], p->positions[v[k]]);
    round_side one = side_of(r, &halves[0]), other = side_of(r, &halves[count > 1]);
    return round_edge_of((const double(*)[3])ends, &one, count > 1 ? &other : NULL);
}

/* Is the edge halved, and where? Free forms say themselves for how many rounds; where, comes later. */
static bool is_halved(const rounding *r, const half_edge *halves, size_t count, round_edge *edge)
{
    uint32_t plane = r->parts[halves->primitive].planes[halves->corner / 3];
    vector3_set(edge->middle, 0, 0, 0);
    if (is_form(plane) || r->forms_only)
        return is_form_to_halve(plane);
    *edge = edge_of(r, halves, count);
    return edge->distance > r->tolerance;
}

static size_t sides_at(const rounding *r, size_t first)
{
    size_t count = 1;
    while (first + count < r->half_count && r->halves[first + count].ends == r->halves[first].ends)
        count++;
    return count;
}

/* --- one round: new vertices ---------------------------------------------------------------------------- */

#define HALF_WAY(array, to, a, b, member) (array)[to].member = 0.5f * ((array)[a].member + (array)[b].member)

static void halve_vec3(vec3 *array, uint32_t to, uint32_t a, uint32_t b)
{
    if (!array)
        return;
    HALF_WAY(array, to, a, b, x);
    HALF_WAY(array, to, a, b, y);
    HALF_WAY(array, to, a, b, z);
}

/* The heaviest of the joints of both, as many as a vertex has. */
static void halve_joints(primitive *p, uint32_t to, uint32_t a, uint32_t b)
{
    const uint32_t own = p->influences;
    const uint32_t from[2] = {a, b};
    uint16_t      *joints = p->joints + (size_t)to * own;
    float         *weights = p->weights + (size_t)to * own, total = 0;
    for (uint32_t k = 0; k < own; k++)
        joints[k] = 0, weights[k] = 0;
    for (uint32_t i = 0; i < 2 * own; i++) {
        const uint16_t *of = p->joints + (size_t)from[i / own] * own;
        const float    *is = p->weights + (size_t)from[i / own] * own;
        const uint32_t  k = i % own;
        float           weight = is[k];
        for (uint32_t m = 0; m < own; m++)
            weight += i / own == 0 && p->joints[(size_t)b * own + m] == of[k] ? p->weights[(size_t)b * own + m] : 0;
        bool twice = false;
        for (uint32_t m = 0; m < own && i / own; m++)
            twice = twice || p->joints[(size_t)a * own + m] == of[k];
        for (uint32_t m = 0; m < own && !twice && weight > 0; m++) {
            if (weight <= weights[m])
                continue;
            for (uint32_t n = own - 1; n > m; n--)
                joints[n] = joints[n - 1], weights[n] = weights[n - 1];
            joints[m] = of[k], weights[m] = weight;
            break;
        }
    }
    for (uint32_t k = 0; k < own; k++)
        total += weights[k];
    for (uint32_t k = 0; k < own && total > 0; k++)
        weights[k] /= total;
}

/* What is half-way between two vertices, but for its place and normal. */
static void halve_rest(primitive *p, uint32_t to, uint32_t a, uint32_t b)
{
    halve_vec3(p->straight, to, a, b);
    for (int i = 0; i < UV_SETS; i++)
        if (p->uvs[i]) {
            HALF_WAY(p->uvs[i], to, a, b, x);
            HALF_WAY(p->uvs[i], to, a, b, y);
        }
    if (p->colours) {
        HALF_WAY(p->colours, to, a, b, x);
        HALF_WAY(p->colours, to, a, b, y);
        HALF_WAY(p->colours, to, a, b, z);
        HALF_WAY(p->colours, to, a, b, w);
    }
    if (p->joints)
        halve_joints(p, to, a, b);
    for (size_t i = 0; i < p->morph_count; i++) {
        halve_vec3(p->morphs[i].positions, to, a, b);
        halve_vec3(p->morphs[i].normals, to, a, b);
    }
}

static bool enlarge(void **array, size_t size, size_t room)
{
    void *larger = *array ? mem_realloc(*array, room * size) : NULL;
    if (*array && !larger)
        return false;
    *array = larger;
    return true;
}

static bool make_room(growing *g, size_t more)
{
    primitive *p = &g->made;
    size_t     room = p->vertex_count + more;
    if (room >= UINT32_MAX)
        return false;
    bool good =
        enlarge((void **)&p->positions, sizeof(vec3), room) && enlarge((void **)&p->normals, sizeof(vec3), room) &&
        enlarge((void **)&p->straight, sizeof(vec3), room) && enlarge((void **)&p->colours, sizeof(vec4), room) &&
        enlarge((void **)&p->joints, p->influences * sizeof(uint16_t), room) &&
        enlarge((void **)&p->weights, p->influences * sizeof(float), room) &&
        enlarge((void **)&g->positions, sizeof(uint32_t), room);
    for (int i = 0; i < UV_SETS && good; i++)
        good = enlarge((void **)&p->uvs[i], sizeof(vec2), room);
    for (size_t i = 0; i < p->morph_count && good; i++)
        good = enlarge((void **)&p->morphs[i].positions, sizeof(vec3), room) &&
               enlarge((void **)&p->morphs[i].normals, sizeof(vec3), room);
    return good;
}

static vec3 mean_normal(vec3 a, vec3 b)
{
    double sum[3], own[3];
    point_of(own, a);
    point_of(sum, b);
    vector3_add(sum, sum, 1, own);
    return vector3_normalise(sum) ? vec_of(sum) : a;
}

/* The vertex half-way on this side; another side with the same two vertices has it already. */
static void halve_side(rounding *r, const half_edge *halves, size_t at, const round_edge *edge)
{
    growing *g = &r->parts[halves[at].primitive];
    uint32_t own[2], theirs[2];
    vertices_of(r, &halves[at], own);
    for (size_t i = 0; i < at; i++) {
        vertices_of(r, &halves[i], theirs);
        if (halves[i].primitive == halves[at].primitive && own[0] == theirs[0] && own[1] == theirs[1]) {
            g->middles[halves[at].corner] = g->middles[halves[i].corner];
            return;
        }
    }
    uint32_t made = g->made.vertex_count++;
    g->made.positions[made] = vec_of(edge->middle);
    g->made.normals[made] = mean_normal(g->made.normals[own[0]], g->made.normals[own[1]]);
    g->positions[made] = r->position_count;
    halve_rest(&g->made, made, own[0], own[1]);
    g->middles[halves[at].corner] = made;
}

/* How many vertices a round adds at most; counts them per primitive in `more`. */
static size_t count_middles(const rounding *r, size_t *more)
{
    size_t     total = 0;
    round_edge edge;
    memset(more, 0, r->part_count * sizeof *more);
    for (size_t i = 0, sides; i < r->half_count; i += sides) {
        sides = sides_at(r, i);
        if (!is_halved(r, &r->halves[i], sides, &edge))
            continue;
        for (size_t k = 0; k < sides; k++)
            more[r->halves[i + k].primitive]++;
        total += sides;
    }
    return total;
}

static lmn_status put_middles(rounding *r, const size_t *more, lmn_error *error)
{
    for (size_t i = 0; i < r->part_count; i++) {
        growing *g = &r->parts[i];
        g->middles = mem_alloc(((size_t)g->made.index_count + 1) * sizeof *g->middles);
        if (!g->middles || !make_room(g, more[i]))
            return error_memory(error);
        for (uint32_t c = 0; c < g->made.index_count; c++)
            g->middles[c] = WHOLE;
    }
    for (size_t i = 0, sides; i < r->half_count; i += sides) {
        sides = sides_at(r, i);
        round_edge edge;
        if (!is_halved(r, &r->halves[i], sides, &edge))
            continue;
        for (size_t k = 0; k < sides; k++)
            halve_side(r, &r->halves[i], k, &edge);
        r->position_count++;
    }
    return LMN_OK;
}

/* --- one round: new triangles --------------------------------------------------------------------------- */

typedef struct triangles {
    uint32_t *indices;
    uint8_t  *edges;
    uint32_t *planes;
    uint32_t  count, plane; /* corners; the plane of those that come */
} triangles;

static void put_triangle(triangles *to, const uint32_t corners[3], const uint8_t edges[3])
{
    to->planes[to->count / 3] = to->plane;
    for (int k = 0; k < 3; k++) {
        to->indices[to->count] = corners[k];
        to->edges[to->count] = edges[k];
        to->count++;
    }
}

static double apart(const primitive *p, uint32_t a, uint32_t b)
{
    double x = (double)p->positions[a].x - p->positions[b].x, y = (double)p->positions[a].y - p->positions[b].y,
           z = (double)p->positions[a].z - p->positions[b].z;
    return x * x + y * y + z * z;
}

/* Corners v[0 … 2], seen from the corner where the first of its halved edges begins, and the vertices between. */
static void cut_triangle(triangles *to, const primitive *p, const uint32_t v[3], const int64_t middles[3],
                         const uint8_t e[3])
{
    int halved = (middles[0] >= 0) + (middles[1] >= 0) + (middles[2] >= 0), first = 0;
    if (halved == 0) {
        put_triangle(to, v, e);
        return;
    }
    while (halved < 3 && (middles[first] < 0 || (halved == 2 && middles[(first + 1) % 3] < 0)))
        first++;
    const uint32_t a = v[first], b = v[(first + 1) % 3], c = v[(first + 2) % 3];
    const uint8_t  ab = e[first], bc = e[(first + 1) % 3], ca = e[(first + 2) % 3];
    const uint32_t m = (uint32_t)middles[first], n = halved > 1 ? (uint32_t)middles[(first + 1) % 3] : 0;
    if (halved == 1) {
        put_triangle(to, (uint32_t[]){a, m, c}, (uint8_t[]){ab, SILHOUETTE, ca});
        put_triangle(to, (uint32_t[]){m, b, c}, (uint8_t[]){ab, bc, SILHOUETTE});
        return;
    }
    put_triangle(to, (uint32_t[]){m, b, n}, (uint8_t[]){ab, bc, SILHOUETTE});
    if (halved == 3) {
        const uint32_t o = (uint32_t)middles[(first + 2) % 3];
        put_triangle(to, (uint32_t[]){a, m, o}, (uint8_t[]){ab, SILHOUETTE, ca});
        put_triangle(to, (uint32_t[]){o, n, c}, (uint8_t[]){SILHOUETTE, bc, ca});
        put_triangle(to, (uint32_t[]){m, n, o}, (uint8_t[]){SILHOUETTE, SILHOUETTE, SILHOUETTE});
    } else if (apart(p, a, n) < apart(p, m, c)) {
        put_triangle(to, (uint32_t[]){a, m, n}, (uint8_t[]){ab, SILHOUETTE, SILHOUETTE});
        put_triangle(to, (uint32_t[]){a, n, c}, (uint8_t[]){SILHOUETTE, bc, ca});
    } else {
        put_triangle(to, (uint32_t[]){a, m, c}, (uint8_t[]){ab, SILHOUETTE, ca});
        put_triangle(to, (uint32_t[]){m, n, c}, (uint8_t[]){SILHOUETTE, bc, SILHOUETTE});
    }
}

static lmn_status cut_triangles(growing *g, lmn_error *error)
{
    primitive *p = &g->made;
    size_t     room = p->index_count;
    for (uint32_t c = 0; c < p->index_count; c++)
        room += g->middles[c] >= 0 ? 3 : 0;
    if (room >= UINT32_MAX)
        return error_set(error, LMN_LIMIT, "a mesh with %zu corners cannot be drawn", room);
    triangles to = {.indices = mem_alloc(room * sizeof *to.indices + 1),
                    .edges = mem_alloc(room + 1),
                    .planes = mem_alloc(room / 3 * sizeof *to.planes + 1)};
    if (!to.indices || !to.edges || !to.planes) {
        mem_free(to.indices);
        mem_free(to.edges);
        mem_free(to.planes);
        return error_memory(error);
    }
    for (uint32_t c = 0; c < p->index_count; c += 3) {
        to.plane = plane_in_next_round(g->planes[c / 3]);
        cut_triangle(&to, p, &p->indices[c], &g->middles[c], &p->edges.values[c]);
    }
    mem_free(p->indices);
    mem_free(p->edges.values);
    mem_free(g->planes);
    g->planes = to.planes;
    p->indices = to.indices;
    p->edges.values = to.edges;
    p->index_count = to.count;
    return LMN_OK;
}

/* --- the whole ------------------------------------------------------------------------------------------ */

/* The edges and corners of the mesh as it is now. */
static lmn_status list_mesh(rounding *r, lmn_error *error)
{
    size_t corners = 0;
    for (size_t i = 0; i < r->part_count; i++)
        corners += r->parts[i].made.index_count;
    half_edge *halves = mem_realloc(r->halves, corners * sizeof *halves + 1);
    if (!halves)
        return error_memory(error);
    r->halves = halves;
    if (!list_corners(r, corners))
        return error_memory(error);
    list_halves(r);
    return LMN_OK;
}

/* Halves what lies too far off once; how many vertices that made. */
static lmn_status halve(rounding *r, size_t *left, size_t *added, lmn_error *error)
{
    size_t *more = mem_calloc(r->part_count + 1, sizeof *more);
    if (!more)
        return error_memory(error);
    lmn_status status = LMN_OK;
    *added = count_middles(r, more);
    *added = *added > *left || r->position_count + *added >= UINT32_MAX ? 0 : *added;
    if (*added) {
        *left -= *added;
        status = put_middles(r, more, error);
        if (status == LMN_OK && !round_form_halve(r))
            status = error_memory(error);
        for (size_t i = 0; i < r->part_count; i++) {
            if (status == LMN_OK)
                status = cut_triangles(&r->parts[i], error);
            mem_free(r->parts[i].middles);
            r->parts[i].middles = NULL;
        }
    }
    mem_free(more);
    return status;
}

/* `*changed`: anything was halved. */
static lmn_status halve_in_rounds(rounding *r, size_t left, bool *changed, lmn_error *error)
{
    size_t     added = 1;
    lmn_status status = list_mesh(r, error);
    if (status == LMN_OK)
        status = round_planes_find(r, error);
    if (status == LMN_OK)
        status = round_form_find(r, error);
    for (int k = 0; k < ROUNDS && status == LMN_OK && added; k++) {
        status = halve(r, &left, &added, error);
        *changed = *changed || added;
        if (status == LMN_OK && added && k + 1 < ROUNDS)
            status = list_mesh(r, error);
        if (status == LMN_OK && added && k < FORM_ROUNDS && !round_form_shade(r))
            status = error_memory(error);
    }
    return status;
}

static lmn_status give(mesh *out, const mesh *m, rounding *r, lmn_error *error)
{
    primitive *all = mem_calloc(r->part_count + 1, sizeof *all);
    *out = (mesh){.name = mem_copy_text(m->name), .topology = 0, .moved = m->moved};
    out->morph_weights =
        m->morph_weight_count ? mem_copy(m->morph_weights, m->morph_weight_count * sizeof *m->morph_weights) : NULL;
    if (!all || (m->name && !out->name) || (m->morph_weight_count && !out->morph_weights)) {
        mem_free(all);
        mesh_release(out);
        return error_memory(error);
    }
    out->morph_weight_count = m->morph_weight_count;
    for (size_t i = 0; i < r->part_count; i++) {
        primitive *p = &r->parts[i].made;
        p->bounds = box3_empty();
        for (uint32_t v = 0; v < p->vertex_count; v++)
            p->bounds = box3_with_point(p->bounds, p->positions[v]);
        all[i] = *p;
        *p = (primitive){.positions = NULL};
    }
    out->primitives = all;
    out->primitive_count = r->part_count;
    return LMN_OK;
}

/* Free forms are shaded by their file, and are no handful of triangles. */
static bool may_have_forms(const mesh *m)
{
    size_t corners = 0;
    for (size_t i = 0; i < m->primitive_count; i++)
        corners += m->primitives[i].normals ? m->primitives[i].index_count : 0;
    return corners / 3 >= FORM_TRIANGLES_LEAST;
}

lmn_status mesh_round(mesh *out, const mesh *m, const round_options *options, lmn_error *error)
{
    rounding   r = {.part_count = m->primitive_count, .forms_only = options->forms_only};
    box3       box = box3_empty();
    lmn_status status = LMN_OK;
    *out = (mesh){.name = NULL};
    if (options->forms_only && !may_have_forms(m))
        return LMN_OK;
    r.parts = mem_calloc(m->primitive_count + 1, sizeof *r.parts);
    if (!r.parts)
        status = error_memory(error);
    for (size_t i = 0; i < m->primitive_count && status == LMN_OK; i++) {
        box = box3_union(box, m->primitives[i].bounds);
        status = copy_primitive(&r.parts[i].made, &m->primitives[i], options->crease_angle, error);
        r.parts[i].own_normals = m->primitives[i].normals != NULL;
        r.parts[i].own_edges = m->primitives[i].edges.values != NULL;
    }
    r.tolerance = options->tolerance * (m->primitive_count ? box3_diagonal(box) : 0);
    if (status == LMN_OK)
        status = number_positions(&r, error);
    if (status == LMN_OK)
        status = say_all_edges(&r, options, error);
    bool changed = false;
    if (status == LMN_OK && r.tolerance > 0)
        status = halve_in_rounds(&r, options->most_vertices, &changed, error);
    if (status == LMN_OK && changed)
        status = give(out, m, &r, error);
    for (size_t i = 0; r.parts && i < r.part_count; i++) {
        primitive_release(&r.parts[i].made);
        mem_free(r.parts[i].positions);
        mem_free(r.parts[i].middles);
        mem_free(r.parts[i].planes);
    }
    mem_free(r.planes);
    mem_free(r.parts);
    mem_free(r.halves);
    mem_free(r.starts);
    mem_free(r.corners);
    return status;
}
