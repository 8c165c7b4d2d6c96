/* Free forms: coarse cages whose file says that they are smooth all over, as a modeller shapes heads, figures and
 * cloth. Their normals are means of faces that turn by right angles, and no curve through them is fair; what was meant
 * is the surface that subdivision makes of the cage (Loop 1987). So that limbs do not become thinner, the cage is first
 * widened by what the surface would lose, as far as neighbours lose the same (after Vollmer et al. 1999). Weights
 * depend on triangles alone, so that morphs and places before a projection go along. */
#include <math.h>

#include "base/groups.h"
#include "base/memory.h"
#include "base/smooth_step.h"
#include "base/vector3.h"
#include "scene/round_private.h"

#define DEGREE 0.017453292519943295
/* Normals of two sides that differ by less are one: cosine. */
#define ONE_NORMAL 0.98
/* Of a free form's triangles less than a share lies in the plane of a neighbour: hands do not shape planes. Few edges
 * are borders, few that are bent are split, and few turn as those of boxes do. */
#define RIM_SHARE   0.1
#define IN_PLANE    (1 * DEGREE)
#define PLANE_SHARE 0.45
#define BENT        (2 * DEGREE)
#define SPLIT_SHARE 0.1
#define STEEP       (80 * DEGREE)
#define STEEP_SHARE 0.15
/* It is coarse where so many of its edges lie too far off the arc that they stand for; how many may in the end. */
#define COARSE_SHARE 0.5
#define ROUGH_SHARE  0.01
/* Vertices whose neighbours' mean is so far away, measured by their distances, are tips: ears, toes. */
#define TIP      0.65
#define TIP_SURE 0.9
enum { WIDENINGS = 2 };

/* What is known of what hangs together. */
typedef struct component {
    size_t triangles, in_plane, edges, rims, bent, split, steep, far_off[FORM_ROUNDS];
    bool   no; /* without normals of its own, or with triangles in a plane of flat pieces */
} component;

/* Sums over what lies around each position: along smooth edges all, along creases and borders those alone. */
typedef struct around {
    double smooth[3], sharp[3], length; /* of all edges */
    size_t smooth_count, sharp_count;
} around;

/* One place for each position, that triangles alone make others of: of vertices, or of a morph. */
typedef struct places {
    double (*at)[3];
    around *around;
} places;

static uint32_t *plane_of(const rounding *r, const half_edge *h)
{
    return &r->parts[h->primitive].planes[h->corner / 3];
}

static size_t group_at(const rounding *r, size_t first)
{
    size_t count = 1;
    while (first + count < r->half_count && r->halves[first + count].ends == r->halves[first].ends)
        count++;
    return count;
}

static uint32_t low_of(const half_edge *h)
{
    return (uint32_t)(h->ends >> 32);
}

static uint32_t high_of(const half_edge *h)
{
    return (uint32_t)h->ends;
}

/* The vertices of a half-edge, that of the lower position first. */
static void vertices_of(const rounding *r, const half_edge *h, uint32_t out[2])
{
    const growing *g = &r->parts[h->primitive];
    uint32_t       a = g->made.indices[h->corner], b = g->made.indices[next_corner(h->corner)];
    bool           turned = g->positions[a] != low_of(h);
    out[0] = turned ? b : a;
    out[1] = turned ? a : b;
}

static bool is_turned(const rounding *r, const half_edge *h)
{
    const growing *g = &r->parts[h->primitive];
    return g->positions[g->made.indices[h->corner]] != low_of(h);
}

/* Does the surface go on over the edge of these halves? */
static bool is_smooth(const rounding *r, const half_edge *halves, size_t count)
{
    uint32_t one[2], other[2];
    if (count != 2 || is_turned(r, &halves[0]) == is_turned(r, &halves[1]))
        return false;
    vertices_of(r, &halves[0], one);
    vertices_of(r, &halves[1], other);
    for (int k = 0; k < 2; k++) {
        double a[3], b[3];
        point_of(a, r->parts[halves[0].primitive].made.normals[one[k]]);
        point_of(b, r->parts[halves[1].primitive].made.normals[other[k]]);
        if (vector3_dot(a, b) < ONE_NORMAL)
            return false;
    }
    return true;
}

/* Twice as long as the triangle is large. */
static void area_normal(double out[3], const primitive *p, uint32_t corner)
{
    const uint32_t *t = &p->indices[corner - corner % 3];
    double          at[3][3], one[3], two[3];
    for (int k = 0; k < 3; k++)
        point_of(at[k], p->positions[t[k]]);
    vector3_add(one, at[1], -1, at[0]);
    vector3_add(two, at[2], -1, at[0]);
    vector3_cross(out, one, two);
}

/* --- what is a free form --------------------------------------------------------------------------------- */

static uint32_t *find_components(const rounding *r)
{
    uint32_t *links = mem_alloc(((size_t)r->position_count + 1) * sizeof *links);
    for (uint32_t i = 0; links && i < r->position_count; i++)
        links[i] = i;
    for (size_t i = 0; links && i < r->half_count; i++)
        group_join(links, low_of(&r->halves[i]), high_of(&r->halves[i]));
    for (uint32_t i = 0; links && i < r->position_count; i++)
        links[i] = group_root(links, i);
    return links;
}

/* `flat`: per triangle of all primitives, whether it is counted as one that lies in a neighbour's plane. */
static void measure_edge(component *to, const rounding *r, const half_edge *halves, size_t count, uint8_t *flat,
                         const size_t *firsts)
{
    double normals[2][3], turn, length;
    for (size_t k = 0; k < count; k++)
        to->no = to->no || !r->parts[halves[k].primitive].own_normals || *plane_of(r, &halves[k]) != NOWHERE;
    to->rims += count != 2;
    if (count != 2)
        return;
    for (int k = 0; k < 2; k++) {
        area_normal(normals[k], &r->parts[halves[k].primitive].made, halves[k].corner);
        if (!vector3_normalise(normals[k]))
            return;
    }
    uint32_t v[2];
    double   ends[2][3];
    vertices_of(r, &halves[0], v);
    for (int k = 0; k < 2; k++)
        point_of(ends[k], r->parts[halves[0].primitive].made.positions[v[k]]);
    length = vector3_distance(ends[0], ends[1]);
    turn = acos(fmax(-1, fmin(1, vector3_dot(normals[0], normals[1]))));
    for (size_t k = 0; k < 2 && turn < IN_PLANE; k++) {
        uint8_t *is = &flat[firsts[halves[k].primitive] + halves[k].corner / 3];
        to->in_plane += !*is;
        *is = 1;
    }
    to->edges++;
    to->steep += turn > STEEP;
    to->bent += turn > BENT;
    to->split += turn > BENT && !is_smooth(r, halves, count);
    /* Of an arc as long as the edge that turns as the surface does over it: how far it lies off; a round makes that a
     * quarter. */
    double off = length / 2 * tan(turn / 4);
    for (int k = 0; k < FORM_ROUNDS; k++, off /= 4)
        to->far_off[k] += off > r->tolerance;
}

static uint32_t rounds_of(const component *c)
{
    if (c->no || c->triangles < FORM_TRIANGLES_LEAST || (double)c->in_plane > PLANE_SHARE * (double)c->triangles ||
        (double)c->rims > RIM_SHARE * (double)c->edges || (double)c->split > SPLIT_SHARE * (double)c->bent ||
        (double)c->steep > STEEP_SHARE * (double)c->edges)
        return 0;
    uint32_t rounds = 0;
    while (rounds < FORM_ROUNDS &&
           (double)c->far_off[rounds] > (rounds ? ROUGH_SHARE : COARSE_SHARE) * (double)c->edges)
        rounds++;
    return rounds;
}

static void measure(component *all, const rounding *r, const uint32_t *links, uint8_t *flat, const size_t *firsts)
{
    for (size_t i = 0; i < r->part_count; i++) {
        const growing *g = &r->parts[i];
        for (uint32_t c = 0; c < g->made.index_count; c += 3)
            all[links[g->positions[g->made.indices[c]]]].triangles++;
    }
    for (size_t i = 0, count; i < r->half_count; i += count) {
        count = group_at(r, i);
        measure_edge(&all[links[low_of(&r->halves[i])]], r, &r->halves[i], count, flat, firsts);
    }
}

static bool mark(rounding *r, const component *all, const uint32_t *links)
{
    bool any = false;
    for (size_t i = 0; i < r->part_count; i++) {
        growing *g = &r->parts[i];
        for (uint32_t t = 0; t < g->made.index_count / 3; t++) {
            uint32_t rounds = rounds_of(&all[links[g->positions[g->made.indices[3 * t]]]]);
            if (rounds > 0)
                g->planes[t] = FORM_DONE - rounds;
            any = any || rounds > 0;
        }
    }
    return any;
}

/* --- places that become others --------------------------------------------------------------------------- */

static void sum_around(const rounding *r, places *p)
{
    for (uint32_t i = 0; i < r->position_count; i++)
        p->around[i] = (around){.smooth_count = 0};
    for (size_t i = 0, count; i < r->half_count; i += count) {
        count = group_at(r, i);
        if (!is_form_to_halve(*plane_of(r, &r->halves[i])))
            continue;
        bool     smooth = is_smooth(r, &r->halves[i], count);
        uint32_t ends[2] = {low_of(&r->halves[i]), high_of(&r->halves[i])};
        for (int k = 0; k < 2; k++) {
            around *a = &p->around[ends[k]];
            vector3_add(a->smooth, a->smooth, 1, p->at[ends[1 - k]]);
            a->smooth_count++;
            a->length += vector3_distance(p->at[ends[0]], p->at[ends[1]]);
            if (!smooth) {
                vector3_add(a->sharp, a->sharp, 1, p->at[ends[1 - k]]);
                a->sharp_count++;
            }
        }
    }
}

/* Loop's weight of each of so many neighbours. */
static double weight_of(size_t count)
{
    double c = 3.0 / 8 + cos(2 * 3.14159265358979323846 / (double)count) / 4;
    return (5.0 / 8 - c * c) / (double)count;
}

/* Where a position goes in a round, or in all rounds there could be; how much of its own place is in that. */
static double put_moved(double out[3], const double at[3], const around *a, bool for_ever)
{
    double weight = 0, others = 0;
    if (a->sharp_count == 2) {
        weight = for_ever ? 1.0 / 6 : 1.0 / 8, others = 2;
    } else if (a->sharp_count < 2 && a->smooth_count > 2) {
        others = (double)a->smooth_count, weight = weight_of(a->smooth_count);
        weight = for_ever ? 1 / (3 / (8 * weight) + others) : weight;
    }
    for (int k = 0; k < 3; k++)
        out[k] = (1 - weight * others) * at[k] + weight * (a->sharp_count == 2 ? a->sharp[k] : a->smooth[k]);
    return 1 - weight * others;
}

/* How much of a tip a vertex is: its neighbours lie about in one direction from it, as their mean is far. */
static double tip_of(const double at[3], const around *a)
{
    double mean[3], count = (double)a->smooth_count;
    if (a->sharp_count > 0 || a->smooth_count < 3)
        return 0;
    for (int k = 0; k < 3; k++)
        mean[k] = a->smooth[k] / count;
    return smooth_step(TIP, TIP_SURE, count * vector3_distance(at, mean) / a->length);
}

/* What the surface would lose is given to the cage: at tips what they lose, elsewhere the mean of what the neighbours
 * do. `tips`: per position. */
static bool widen(const rounding *r, places *p, const double *tips)
{
    double(*cage)[3] = mem_copy(p->at, ((size_t)r->position_count + 1) * sizeof *cage);
    double(*wanted)[3] = mem_copy(p->at, ((size_t)r->position_count + 1) * sizeof *wanted);
    double *own = mem_alloc(((size_t)r->position_count + 1) * sizeof *own);
    for (int round = 0; cage && wanted && own && round < WIDENINGS; round++) {
        sum_around(r, p);
        for (uint32_t i = 0; i < r->position_count; i++) {
            double gone[3];
            vector3_copy(cage[i], p->at[i]);
            own[i] = put_moved(gone, cage[i], &p->around[i], true);
            vector3_add(p->at[i], wanted[i], -1, gone);
        }
        sum_around(r, p);
        for (uint32_t i = 0; i < r->position_count; i++) {
            const around *a = &p->around[i];
            double        lost[3];
            vector3_copy(lost, p->at[i]);
            vector3_add(p->at[i], cage[i], tips[i] / own[i], lost);
            if (a->smooth_count)
                vector3_add(p->at[i], p->at[i], (1 - tips[i]) / (double)a->smooth_count, a->smooth);
        }
    }
    bool good = cage && wanted && own;
    mem_free(own);
    mem_free(cage);
    mem_free(wanted);
    return good;
}

/* --- what moves: vertices, and all that is a place or goes to one ----------------------------------------- */

/* Which of a primitive's arrays; NULL where it has none. */
static vec3 *array_of(const primitive *p, size_t which)
{
    if (which < 2)
        return which ? p->straight : p->positions;
    return which - 2 < p->morph_count ? p->morphs[which - 2].positions : NULL;
}

static size_t arrays_of(const rounding *r)
{
    size_t most = 0;
    for (size_t i = 0; i < r->part_count; i++)
        most = r->parts[i].made.morph_count > most ? r->parts[i].made.morph_count : most;
    return 2 + most;
}

/* What the corners of triangles that are halved have; false where none has any. */
static bool gather(const rounding *r, places *p, size_t which)
{
    bool any = false;
    for (uint32_t i = 0; i < r->position_count; i++)
        vector3_set(p->at[i], 0, 0, 0);
    for (size_t i = 0; i < r->part_count; i++) {
        const growing *g = &r->parts[i];
        const vec3    *from = array_of(&g->made, which);
        for (uint32_t c = 0; from && c < g->made.index_count; c++)
            if (is_form_to_halve(g->planes[c / 3])) {
                point_of(p->at[g->positions[g->made.indices[c]]], from[g->made.indices[c]]);
                any = true;
            }
    }
    return any;
}

static void hand_back(const rounding *r, const places *p, size_t which)
{
    for (size_t i = 0; i < r->part_count; i++) {
        const growing *g = &r->parts[i];
        vec3          *to = array_of(&g->made, which);
        for (uint32_t c = 0; to && c < g->made.index_count; c++)
            if (is_form_to_halve(g->planes[c / 3])) {
                const double *at = p->at[g->positions[g->made.indices[c]]];
                to[g->made.indices[c]] = (vec3){(float)at[0], (float)at[1], (float)at[2]};
            }
    }
}

static uint32_t third_of(const rounding *r, const half_edge *h)
{
    const growing *g = &r->parts[h->primitive];
    return g->positions[g->made.indices[next_corner(next_corner(h->corner))]];
}

/* The vertices between. */
static void put_between(const rounding *r, const places *p, size_t which)
{
    for (size_t i = 0, count; i < r->half_count; i += count) {
        count = group_at(r, i);
        const half_edge *halves = &r->halves[i];
        if (!is_form_to_halve(*plane_of(r, halves)))
            continue;
        double middle[3], own = is_smooth(r, halves, count) ? 3.0 / 8 : 1.0 / 2;
        vector3_set(middle, 0, 0, 0);
        vector3_add(middle, middle, own, p->at[low_of(halves)]);
        vector3_add(middle, middle, own, p->at[high_of(halves)]);
        for (size_t k = 0; k < 2 && own < 0.5; k++)
            vector3_add(middle, middle, 1.0 / 8, p->at[third_of(r, &halves[k])]);
        for (size_t k = 0; k < count; k++) {
            const growing *g = &r->parts[halves[k].primitive];
            vec3          *to = array_of(&g->made, which);
            if (to)
                to[g->middles[halves[k].corner]] = (vec3){(float)middle[0], (float)middle[1], (float)middle[2]};
        }
    }
}

static bool open_places(places *p, const rounding *r)
{
    p->at = mem_alloc(((size_t)r->position_count + 1) * sizeof *p->at);
    p->around = mem_alloc(((size_t)r->position_count + 1) * sizeof *p->around);
    return p->at && p->around;
}

static void close_places(places *p)
{
    mem_free(p->at);
    mem_free(p->around);
}

/* All cages, before the first round. */
static bool widen_all(rounding *r)
{
    places  p;
    double *tips = mem_calloc((size_t)r->position_count + 1, sizeof *tips);
    bool    good = open_places(&p, r) && tips;
    for (size_t which = 0; which < arrays_of(r) && good; which++) {
        if (!gather(r, &p, which))
            continue;
        if (which == 0) {
            sum_around(r, &p);
            for (uint32_t i = 0; i < r->position_count; i++)
                tips[i] = tip_of(p.at[i], &p.around[i]);
        }
        good = widen(r, &p, tips);
        if (good)
            hand_back(r, &p, which);
    }
    close_places(&p);
    mem_free(tips);
    return good;
}

bool round_form_halve(rounding *r)
{
    places p;
    bool   good = open_places(&p, r);
    for (size_t which = 0; which < arrays_of(r) && good; which++)
        if (gather(r, &p, which)) {
            put_between(r, &p, which);
            sum_around(r, &p);
            for (uint32_t i = 0; i < r->position_count; i++) {
                double at[3];
                vector3_copy(at, p.at[i]);
                put_moved(p.at[i], at, &p.around[i], false);
            }
            hand_back(r, &p, which);
        }
    close_places(&p);
    return good;
}

/* --- normals --------------------------------------------------------------------------------------------- */

/* The mean by angles of the triangles at a vertex's position on its side of creases. */
static void normal_at(double out[3], const rounding *r, uint32_t position, const double own[3])
{
    vector3_set(out, 0, 0, 0);
    for (uint32_t i = r->starts[position]; i < r->starts[position + 1]; i++) {
        const half_edge *h = &r->corners[i];
        const primitive *p = &r->parts[h->primitive].made;
        const uint32_t   c = h->corner, a = p->indices[c], b = p->indices[next_corner(c)],
                       d = p->indices[next_corner(next_corner(c))];
        double theirs[3], at[3], one[3], two[3], cross[3];
        point_of(theirs, p->normals[a]);
        if (vector3_dot(theirs, own) < ONE_NORMAL)
            continue;
        point_of(at, p->positions[a]);
        point_of(one, p->positions[b]);
        point_of(two, p->positions[d]);
        vector3_add(one, one, -1, at);
        vector3_add(two, two, -1, at);
        vector3_cross(cross, one, two);
        double angle = atan2(vector3_length(cross), vector3_dot(one, two));
        if (vector3_normalise(cross))
            vector3_add(out, out, angle, cross);
    }
    if (!vector3_normalise(out))
        vector3_copy(out, own);
}

bool round_form_shade(rounding *r)
{
    bool   good = true;
    vec3 **all = mem_calloc(r->part_count + 1, sizeof *all);
    for (size_t i = 0; i < r->part_count && all && good; i++) {
        const growing *g = &r->parts[i];
        if (!g->made.normals) /* lines */
            continue;
        all[i] = mem_copy(g->made.normals, (size_t)g->made.vertex_count * sizeof **all);
        good = all[i] != NULL;
        for (uint32_t c = 0; good && c < g->made.index_count; c++) {
            uint32_t v = g->made.indices[c];
            double   own[3], made[3];
            if (!is_form(g->planes[c / 3]))
                continue;
            point_of(own, g->made.normals[v]);
            normal_at(made, r, g->positions[v], own);
            all[i][v] = (vec3){(float)made[0], (float)made[1], (float)made[2]};
        }
    }
    for (size_t i = 0; i < r->part_count && all; i++) {
        if (good && all[i]) {
            mem_free(r->parts[i].made.normals);
            r->parts[i].made.normals = all[i];
        } else {
            mem_free(all[i]);
        }
    }
    good = good && all;
    mem_free(all);
    return good;
}

/* --- the whole ------------------------------------------------------------------------------------------- */

/* Over what is smooth there are no creases, however far a coarse cage turns. */
static void say_smooth(rounding *r)
{
    for (size_t i = 0, count; i < r->half_count; i += count) {
        count = group_at(r, i);
        if (!is_form_to_halve(*plane_of(r, &r->halves[i])) || !is_smooth(r, &r->halves[i], count))
            continue;
        for (size_t k = 0; k < count; k++) {
            growing *g = &r->parts[r->halves[i + k].primitive];
            if (!g->own_edges)
                g->made.edges.values[r->halves[i + k].corner] = ROUND_SILHOUETTE;
        }
    }
}

lmn_status round_form_find(rounding *r, lmn_error *error)
{
    size_t    count = 0;
    size_t   *firsts = mem_alloc((r->part_count + 1) * sizeof *firsts);
    uint32_t *links = find_components(r);
    for (size_t i = 0; firsts && i < r->part_count; i++) {
        firsts[i] = count;
        count += r->parts[i].made.index_count / 3;
    }
    component *all = mem_calloc((size_t)r->position_count + 1, sizeof *all);
    uint8_t   *flat = mem_calloc(count + 1, 1);
    bool       good = firsts && links && all && flat;
    if (good) {
        measure(all, r, links, flat, firsts);
        if (mark(r, all, links)) {
            say_smooth(r);
            good = widen_all(r);
        }
    }
    mem_free(flat);
    mem_free(all);
    mem_free(links);
    mem_free(firsts);
    return good ? LMN_OK : error_memory(error);
}
