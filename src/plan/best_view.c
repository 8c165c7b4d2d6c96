/* From where a scene shows most.
 *
 * Some two dozen directions are tried, each by a small picture of the depths, parts and normals that it shows. What is
 * wanted of a view are measures that people's choices were found to follow (Secord, Lu, Finkelstein, Singh and Nealen
 * 2011, "Perceptual models of viewpoint preference"): much area, much silhouette, much of what there is, from a little
 * above. How evenly a view shows what there is, is its entropy (Vázquez, Feixas, Sbert and Heidrich 2001), here over
 * the parts and the ways that their surfaces face instead of over triangles, so that it does not depend on how finely
 * shapes are cut. Measures are told as fractions of the most, and their sum decides. */
#include "plan/best_view.h"

#include <math.h>
#include <string.h>

#include "base/memory.h"
#include "base/vector3.h"
#include "base/work.h"
#include "look/selector.h"
#include "plan/time.h"
#include "pose/pose.h"
#include "scene/content.h"

enum {
    SIDE = 128,              /* pixels of a try */
    AZIMUTHS = 12,           /* around the scene */
    HEIGHTS = 2,             /* above it */
    TRIANGLES_MOST = 300000, /* of more, every so many are looked at */
    FACINGS = 6,             /* bins of normals: towards the axes */
    GROUP_BINS = 4096        /* of parts and facings together */
};

typedef struct facet {
    float    corners[3][3]; /* around the middle of all, the radius of all is 1 */
    uint32_t group;         /* which part, facing where */
    uint32_t part;
} facet;

typedef struct facets {
    facet *items;
    size_t count, capacity, seen, step;
    double middle[3], radius;
} facets;

/* One direction's picture. */
typedef struct try_picture {
    float    depth[SIDE][SIDE]; /* from the eye; INFINITY: nothing */
    uint32_t group[SIDE][SIDE], part[SIDE][SIDE];
} try_picture;

/* What one direction shows. */
typedef struct view_measures {
    double area, silhouette, entropy, parts;
} view_measures;

/* --- what there is ------------------------------------------------------------------------------------------------ */

static uint32_t facing_of(const double normal[3])
{
    int axis = 0;
    for (int k = 1; k < 3; k++)
        if (fabs(normal[k]) > fabs(normal[axis]))
            axis = k;
    return (uint32_t)(2 * axis + (normal[axis] < 0));
}

static void add_facet(facets *f, uint32_t part, double corners[3][3])
{
    double a[3], b[3], normal[3];
    if (f->seen++ % f->step != 0 || f->count == f->capacity)
        return;
    vector3_add(a, corners[1], -1, corners[0]);
    vector3_add(b, corners[2], -1, corners[0]);
    vector3_cross(normal, a, b);
    facet *out = &f->items[f->count++];
    out->part = part;
    out->group = (part * FACINGS + facing_of(normal)) % GROUP_BINS;
    for (int c = 0; c < 3; c++)
        for (int k = 0; k < 3; k++)
            out->corners[c][k] = (float)((corners[c][k] - f->middle[k]) / f->radius);
}

static void add_box(facets *f, uint32_t part, box3 box)
{
    /* Corners by their bits x, y, z. */
    static const int sides[12][3] = {{0, 2, 6}, {0, 6, 4}, {1, 5, 7}, {1, 7, 3}, {0, 4, 5}, {0, 5, 1},
                                     {2, 3, 7}, {2, 7, 6}, {0, 1, 3}, {0, 3, 2}, {4, 6, 7}, {4, 7, 5}};
    for (int t = 0; t < 12 && !box3_is_empty(box); t++) {
        double corners[3][3];
        for (int c = 0; c < 3; c++) {
            const int i = sides[t][c];
            vector3_set(corners[c], (double)(i & 1 ? box.max.x : box.min.x), (double)(i & 2 ? box.max.y : box.min.y),
                        (double)(i & 4 ? box.max.z : box.min.z));
        }
        add_facet(f, part, corners);
    }
}

static void add_triangles(facets *f, uint32_t part, const primitive *p, const vec3 *at, const mat4 *world)
{
    for (uint32_t i = 0; i + 2 < p->index_count; i += 3) {
        double corners[3][3];
        for (uint32_t c = 0; c < 3; c++) {
            const vec3 v = mat4_transform_point(world, at[p->indices[i + c]]);
            vector3_set(corners[c], (double)v.x, (double)v.y, (double)v.z);
        }
        add_facet(f, part, corners);
    }
}

/* All instances of a part, as they are posed. */
static lmn_status add_part(facets *f, const pose *p, size_t part, lmn_error *error)
{
    const node  *n = &p->scene->nodes[p->scene->parts[part].node];
    const mesh  *m = n->mesh == NONE ? NULL : &p->scene->meshes[n->mesh];
    const size_t instances = node_draw_count(n);
    if (!m || n->solid != NONE)
        add_box(f, (uint32_t)part, p->part_boxes[part]);
    for (size_t k = 0; m && n->solid == NONE && k < m->primitive_count; k++) {
        const primitive *of = &m->primitives[k];
        vec3            *at = mem_alloc((of->vertex_count + 1) * sizeof *at);
        if (!at)
            return error_memory(error);
        pose_vertices(&p->parts[part], of, NULL, NULL, of->vertex_count, at, NULL);
        for (size_t i = 0; i < instances; i++) {
            const mat4 world = pose_instance(p, part, i);
            add_triangles(f, (uint32_t)part, of, at, &world);
        }
        mem_free(at);
    }
    return LMN_OK;
}

static size_t count_triangles(const lmn_scene *scene, size_t part)
{
    const node *n = &scene->nodes[scene->parts[part].node];
    const mesh *m = n->mesh == NONE || n->solid != NONE ? NULL : &scene->meshes[n->mesh];
    size_t      count = m ? 0 : 12;
    for (size_t k = 0; m && k < m->primitive_count; k++)
        count += m->primitives[k].index_count / 3;
    return count * (m ? node_draw_count(n) : 1);
}

static bool is_shown(const lmn_scene *scene, const selector *wanted, size_t part)
{
    return !scene_is_hidden(scene, scene->parts[part].node) && (!wanted || selector_matches(wanted, scene, part));
}

/* Items are the caller's to free, after an error too. */
static lmn_status collect(facets *out, const pose *p, const selector *wanted, lmn_error *error)
{
    size_t all = 0;
    box3   box = box3_empty();
    *out = (facets){.radius = 1};
    for (size_t i = 0; i < p->part_count; i++)
        if (is_shown(p->scene, wanted, i)) {
            all += count_triangles(p->scene, i);
            box = box3_union(box, p->part_boxes[i]);
        }
    if (box3_is_empty(box))
        return LMN_OK;
    box3_middle(box, out->middle);
    out->radius = fmax(box3_diagonal(box) / 2, 1e-30);
    out->step = all / TRIANGLES_MOST + 1;
    out->capacity = all / out->step + 1;
    out->items = mem_alloc(out->capacity * sizeof *out->items);
    lmn_status status = out->items ? LMN_OK : error_memory(error);
    for (size_t i = 0; i < p->part_count && status == LMN_OK; i++)
        if (is_shown(p->scene, wanted, i))
            status = add_part(out, p, i, error);
    return status;
}

/* --- what a direction shows --------------------------------------------------------------------------------------- */

static void put_pixel(try_picture *t, const facet *f, int x, int y, float depth)
{
    if (x < 0 || y < 0 || x >= SIDE || y >= SIDE || !(depth < t->depth[y][x]))
        return;
    t->depth[y][x] = depth;
    t->group[y][x] = f->group;
    t->part[y][x] = f->part;
}

/* A facet whose corners are at these pixels and depths; one that is between pixels is at the nearest one. */
static void put_facet(try_picture *t, const facet *f, const float at[3][3])
{
    int low[2], high[2];
    for (int k = 0; k < 2; k++) {
        low[k] = (int)ceilf(fmaxf(fminf(at[0][k], fminf(at[1][k], at[2][k])), 0));
        high[k] = (int)floorf(fminf(fmaxf(at[0][k], fmaxf(at[1][k], at[2][k])), SIDE - 1));
    }
    const float area = (at[1][0] - at[0][0]) * (at[2][1] - at[0][1]) - (at[1][1] - at[0][1]) * (at[2][0] - at[0][0]);
    if (low[0] > high[0] || low[1] > high[1] || area == 0) {
        put_pixel(t, f, (int)lroundf(at[0][0]), (int)lroundf(at[0][1]), at[0][2]);
        return;
    }
    for (int y = low[1]; y <= high[1]; y++)
        for (int x = low[0]; x <= high[0]; x++) {
            float weights[3];
            for (int k = 0; k < 3; k++) {
                const float *a = at[(k + 1) % 3], *b = at[(k + 2) % 3];
                weights[k] = ((b[0] - a[0]) * ((float)y - a[1]) - (b[1] - a[1]) * ((float)x - a[0])) / area;
            }
            if (weights[0] >= 0 && weights[1] >= 0 && weights[2] >= 0)
                put_pixel(t, f, x, y, weights[0] * at[0][2] + weights[1] * at[1][2] + weights[2] * at[2][2]);
        }
}

static void draw_try(try_picture *t, const facets *all, const double axes[3][3])
{
    float turned[3][3];
    for (int a = 0; a < 3; a++)
        for (int k = 0; k < 3; k++)
            turned[a][k] = (float)axes[a][k];
    for (int i = 0; i < SIDE * SIDE; i++)
        t->depth[i / SIDE][i % SIDE] = INFINITY;
    for (size_t i = 0; i < all->count; i++) {
        float at[3][3];
        for (int c = 0; c < 3; c++) {
            const float *p = all->items[i].corners[c];
            for (int a = 0; a < 3; a++)
                at[c][a] = turned[a][0] * p[0] + turned[a][1] * p[1] + turned[a][2] * p[2];
            at[c][0] = (at[c][0] + 1) * (SIDE - 1) / 2;
            at[c][1] = (at[c][1] + 1) * (SIDE - 1) / 2;
            at[c][2] = -at[c][2];
        }
        put_facet(t, &all->items[i], (const float(*)[3])at);
    }
}

/* How much of an outline there is between two neighbours: at the ground all of it, between what is near and far half.
 */
static double outline_between(float a, float b)
{
    const float FAR_APART = 0.1f; /* of the radius of all */
    if (isinf(a) || isinf(b))
        return isinf(a) == isinf(b) ? 0 : 1;
    return fabsf(a - b) > FAR_APART ? 0.5 : 0;
}

/* `counts` has room for GROUP_BINS, `seen` for a flag a part. */
static view_measures measure(const try_picture *t, uint32_t *counts, bool *seen, size_t part_count)
{
    view_measures m = {0, 0, 0, 0};
    memset(counts, 0, GROUP_BINS * sizeof *counts);
    memset(seen, 0, part_count * sizeof *seen);
    for (int y = 0; y < SIDE; y++)
        for (int x = 0; x < SIDE; x++) {
            m.silhouette += x + 1 < SIDE ? outline_between(t->depth[y][x], t->depth[y][x + 1]) : 0;
            m.silhouette += y + 1 < SIDE ? outline_between(t->depth[y][x], t->depth[y + 1][x]) : 0;
            if (isinf(t->depth[y][x]))
                continue;
            m.area++;
            counts[t->group[y][x]]++;
            m.parts += !seen[t->part[y][x]];
            seen[t->part[y][x]] = true;
        }
    for (int i = 0; i < GROUP_BINS; i++)
        if (counts[i])
            m.entropy -= counts[i] / m.area * log(counts[i] / m.area);
    return m;
}

/* --- which one ---------------------------------------------------------------------------------------------------- */

/* Right, up and to the eye. The first direction is that of the view "iso"; front lies at azimuth 0. */
static void axes_of(double out[3][3], int index, char up_axis)
{
    static const double heights[HEIGHTS] = {35.264389682754654, 15};
    const double degree = 3.14159265358979323846 / 180, azimuth = (45 + index / HEIGHTS * 360.0 / AZIMUTHS) * degree,
                 height = heights[index % HEIGHTS] * degree;
    const double across = cos(height) * sin(azimuth), rise = sin(height), front = cos(height) * cos(azimuth);
    const double up[3] = {0, up_axis != 'z', up_axis == 'z'};
    if (up_axis == 'z')
        vector3_set(out[2], across, -front, rise);
    else
        vector3_set(out[2], across, rise, front);
    vector3_cross(out[0], up, out[2]);
    vector3_normalise(out[0]);
    vector3_cross(out[1], out[2], out[0]);
}

/* The entropy of a view that showed all that there is, evenly. `counts` has room for GROUP_BINS. */
static double most_entropy(const facets *all, uint32_t *counts)
{
    int groups = 0;
    memset(counts, 0, GROUP_BINS * sizeof *counts);
    for (size_t i = 0; i < all->count; i++)
        groups += counts[all->items[i].group]++ == 0;
    return log(groups);
}

/* The measures' sum; all are fractions of the most that any view has, or could have. */
static double score_of(const view_measures *m, const view_measures *most, const double axes[3][3], char up_axis)
{
    const double front = up_axis == 'z' ? -axes[2][1] : axes[2][2], above = axes[2][up_axis == 'z' ? 2 : 1];
    const double values[] = {m->entropy, m->area, m->silhouette, m->parts},
                 mosts[] = {most->entropy, most->area, most->silhouette, most->parts};
    static const double weights[] = {1, 0.8, 0.5, 0.6};
    double              sum = 0.08 * front + 0.1 * above;
    for (size_t i = 0; i < sizeof weights / sizeof *weights; i++)
        sum += mosts[i] > 0 ? weights[i] * values[i] / mosts[i] : 0;
    return sum;
}

static lmn_status choose(double to_eye[3], const facets *all, size_t part_count, char up_axis, lmn_error *error)
{
    enum { TRIES = AZIMUTHS * HEIGHTS };
    const double  CLEARLY = 1e-6; /* of views that show as much, the first one */
    view_measures measures[TRIES], most = {0, 0, 0, 0};
    double        best = -INFINITY, axes[3][3];
    try_picture  *picture = mem_alloc(sizeof *picture);
    uint32_t     *counts = mem_alloc(GROUP_BINS * sizeof *counts);
    bool         *seen = mem_alloc(part_count + 1);
    lmn_status    status = picture && counts && seen ? LMN_OK : error_memory(error);
    if (status == LMN_OK)
        most.entropy = most_entropy(all, counts);
    for (int i = 0; i < TRIES && status == LMN_OK; i++) {
        axes_of(axes, i, up_axis);
        draw_try(picture, all, (const double(*)[3])axes);
        measures[i] = measure(picture, counts, seen, part_count);
        most.area = fmax(most.area, measures[i].area);
        most.silhouette = fmax(most.silhouette, measures[i].silhouette);
        most.parts = fmax(most.parts, measures[i].parts);
        status = work_progress((double)(i + 1) / TRIES, "view", error);
    }
    for (int i = 0; i < TRIES && status == LMN_OK; i++) {
        axes_of(axes, i, up_axis);
        const double score = score_of(&measures[i], &most, (const double(*)[3])axes, up_axis);
        if (score > best + CLEARLY) {
            best = score;
            vector3_copy(to_eye, axes[2]);
        }
    }
    mem_free(picture);
    mem_free(counts);
    mem_free(seen);
    return status;
}

lmn_status best_view_find(lmn_draw_desc *desc, const lmn_scene *scene, lmn_error *error)
{
    pose       p = {0};
    moment     when;
    facets     all = {0};
    selector  *wanted = NULL;
    double     to_eye[3] = {0, 0, 1};
    lmn_status status = time_moment(&when, scene, desc, NULL, error);
    if (status == LMN_OK && desc->select)
        status = selector_parse(&wanted, desc->select, error);
    if (status == LMN_OK)
        status = pose_create(&p, scene, &when, error);
    if (status == LMN_OK)
        status = collect(&all, &p, wanted, error);
    if (status == LMN_OK)
        status = choose(to_eye, &all, p.part_count, scene->up, error);
    if (status == LMN_OK) {
        desc->eye_given = desc->fit_direction = true;
        desc->camera = NULL;
        desc->matrices_given = false;
        for (int k = 0; k < 3; k++) {
            desc->target[k] = all.middle[k];
            desc->eye[k] = all.middle[k] + all.radius * to_eye[k];
            desc->up[k] = 0;
        }
    }
    mem_free(all.items);
    selector_destroy(&wanted);
    pose_release(&p);
    return status;
}
