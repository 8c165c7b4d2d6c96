/* From the world to the window: points, triangles that can cover something, and which faces are seen from the
 * front. */
#include "stroke/stroke_private.h"

#include <math.h>
#include <string.h>

#include "base/memory.h"
#include "base/threads.h"
#include "stroke/line_filter.h"

/* Planes that a point can be outside of; in the order of `clip_distance`. */
enum { PLANE_NEAR, PLANE_LEFT, PLANE_RIGHT, PLANE_BOTTOM, PLANE_TOP, PLANE_COUNT, POLYGON_MAX = 3 + PLANE_COUNT };

typedef struct clip_point {
    double x, y, w, d; /* clip space; d: eye depth */
} clip_point;

double3 item_position(const stroke_item *item, vec3 p)
{
    const double *m = item->world.m;
    return (double3){m[0] * p.x + m[4] * p.y + m[8] * p.z + m[12], m[1] * p.x + m[5] * p.y + m[9] * p.z + m[13],
                     m[2] * p.x + m[6] * p.y + m[10] * p.z + m[14]};
}

static clip_point clip_of(const mat4 *whole, const mat4 *view, double3 p)
{
    const double *m = whole->m, *e = view->m;
    return (clip_point){m[0] * p.x + m[4] * p.y + m[8] * p.z + m[12], m[1] * p.x + m[5] * p.y + m[9] * p.z + m[13],
                        m[3] * p.x + m[7] * p.y + m[11] * p.z + m[15],
                        -(e[2] * p.x + e[6] * p.y + e[10] * p.z + e[14])};
}

static clip_point position_in_clip_space(const stroke_view *v, double3 p)
{
    return clip_of(&v->whole, &v->camera.view, p);
}

/* Half of what window coordinates can hold, as a multiple of half the page: what lies farther out is cut off. */
static void guard(const stroke_view *v, double out[2])
{
    out[0] = (WINDOW_LIMIT - 1) / (v->units * 0.5 * v->camera.width);
    out[1] = (WINDOW_LIMIT - 1) / (v->units * 0.5 * v->camera.height);
}

/* Above 0 inside the plane. */
static double clip_distance(const stroke_view *v, const double limits[2], clip_point p, int plane)
{
    switch (plane) {
    case PLANE_NEAR: return v->camera.orthographic ? 1 : p.d - v->camera.near;
    case PLANE_LEFT: return p.x + limits[0] * p.w;
    case PLANE_RIGHT: return limits[0] * p.w - p.x;
    case PLANE_BOTTOM: return p.y + limits[1] * p.w;
    default: return limits[1] * p.w - p.y;
    }
}

static uint8_t outside_of(const stroke_view *v, const double limits[2], clip_point p)
{
    unsigned out = 0;
    for (int k = 0; k < PLANE_COUNT; k++)
        out |= clip_distance(v, limits, p, k) < 0 ? 1u << k : 0;
    return (uint8_t)out;
}

static window_point window_of(const stroke_view *v, clip_point p)
{
    double x = p.x / p.w * (0.5 * v->camera.width * v->units), y = -p.y / p.w * (0.5 * v->camera.height * v->units);
    return (window_point){(int32_t)lrint(x), (int32_t)lrint(y), v->camera.orthographic ? p.d : -1 / p.d};
}

double view_depth(const stroke_view *v, double z)
{
    return v->camera.orthographic ? z : -1 / z;
}

double view_tolerance(const stroke_view *v, double same, double z)
{
    return v->camera.orthographic ? same : same * z * z;
}

bool view_position(const stroke_view *v, double3 world, window_point *out)
{
    double limits[2];
    guard(v, limits);
    clip_point p = position_in_clip_space(v, world);
    if (outside_of(v, limits, p))
        return false;
    *out = window_of(v, p);
    return true;
}

bool view_clip_line(const stroke_view *v, double3 a, double3 b, double cut[2])
{
    double limits[2];
    guard(v, limits);
    clip_point p = position_in_clip_space(v, a), q = position_in_clip_space(v, b);
    cut[0] = 0;
    cut[1] = 1;
    for (int k = 0; k < PLANE_COUNT; k++) {
        double from = clip_distance(v, limits, p, k), to = clip_distance(v, limits, q, k);
        if (from < 0 && to < 0)
            return false;
        if (from < 0)
            cut[0] = fmax(cut[0], from / (from - to));
        else if (to < 0)
            cut[1] = fmin(cut[1], from / (from - to));
    }
    return cut[0] < cut[1];
}

/* --- points --------------------------------------------------------------------------------------------- */

typedef struct point_job {
    stroke_view *v;
    size_t       item;
} point_job;

static void project_points(size_t begin, size_t end, void *user)
{
    const point_job   *job = user;
    stroke_view       *v = job->v;
    const stroke_item *item = &v->scene->items[job->item];
    const edge_mesh   *m = &v->scene->meshes[item->mesh];
    mat4   whole = mat4_multiply(&v->whole, &item->world), view = mat4_multiply(&v->camera.view, &item->world);
    double limits[2];
    guard(v, limits);
    uint32_t first = v->items[job->item].first_point;
    for (size_t i = begin; i < end; i++) {
        vec3       p = m->positions[i];
        clip_point c = clip_of(&whole, &view, (double3){p.x, p.y, p.z});
        uint8_t    outside = outside_of(v, limits, c);
        v->outside[first + i] = outside;
        v->points[first + i] = outside ? (window_point){0, 0, 0} : window_of(v, c);
    }
}

/* --- triangles ------------------------------------------------------------------------------------------ */

static bool put_triangle(stroke_view *v, uint32_t a, uint32_t b, uint32_t c, uint32_t face)
{
    if (v->triangle_count == v->triangle_capacity &&
        !mem_grow((void **)&v->triangles, &v->triangle_capacity, v->triangle_count + 1, sizeof *v->triangles))
        return false;
    v->triangles[v->triangle_count++] = (window_triangle){{a, b, c}, face};
    return true;
}

/* A polygon without what lies outside a plane. */
static int clip_polygon(const stroke_view *v, const double limits[2], int plane, const clip_point *in, int count,
                        clip_point *out)
{
    int kept = 0;
    for (int i = 0; i < count; i++) {
        clip_point p = in[i], q = in[i + 1 == count ? 0 : i + 1];
        double     from = clip_distance(v, limits, p, plane), to = clip_distance(v, limits, q, plane);
        if (from >= 0)
            out[kept++] = p;
        if ((from < 0) != (to < 0)) {
            double s = from / (from - to);
            out[kept++] = (clip_point){p.x + s * (q.x - p.x), p.y + s * (q.y - p.y), p.w + s * (q.w - p.w),
                                       p.d + s * (q.d - p.d)};
        }
    }
    return kept;
}

static bool put_clipped(stroke_view *v, clip_point corners[3], uint32_t face)
{
    double limits[2];
    guard(v, limits);
    clip_point pattern_rows[2][POLYGON_MAX];
    memcpy(pattern_rows[0], corners, 3 * sizeof *corners);
    int count = 3, now = 0;
    for (int k = 0; k < PLANE_COUNT && count >= 3; k++, now = 1 - now)
        count = clip_polygon(v, limits, k, pattern_rows[now], count, pattern_rows[1 - now]);
    if (count < 3)
        return true;
    if (!mem_grow((void **)&v->points, &v->point_capacity, v->point_count + (size_t)count, sizeof *v->points))
        return false;
    uint32_t first = (uint32_t)v->point_count;
    for (int i = 0; i < count; i++)
        v->points[v->point_count++] = window_of(v, pattern_rows[now][i]);
    for (int i = 1; i + 1 < count; i++)
        if (!put_triangle(v, first, first + (uint32_t)i, first + (uint32_t)i + 1, face))
            return false;
    return true;
}

/* Is a face that reaches beyond the window seen from the front? By the sign of the volume that it spans with the
 * eye. */
static bool faces_eye(const clip_point p[3])
{
    return p[0].x * (p[1].y * p[2].w - p[2].y * p[1].w) - p[0].y * (p[1].x * p[2].w - p[2].x * p[1].w) +
               p[0].w * (p[1].x * p[2].y - p[2].x * p[1].y) >
           0;
}

bool view_shows_front(const stroke_view *v, double3 a, double3 b, double3 c)
{
    const clip_point p[3] = {position_in_clip_space(v, a), position_in_clip_space(v, b), position_in_clip_space(v, c)};
    return faces_eye(p);
}

/* Where the eye is, in the world: the view matrix turns and moves. */
static vec3 eye_of(const stroke_view *v)
{
    const double *m = v->camera.view.m;
    double        e[3];
    for (int k = 0; k < 3; k++)
        e[k] = -(m[4 * k] * m[12] + m[4 * k + 1] * m[13] + m[4 * k + 2] * m[14]);
    return (vec3){(float)e[0], (float)e[1], (float)e[2]};
}

uint8_t *view_unseen(const stroke_view *v, size_t index)
{
    const stroke_item *item = &v->scene->items[index];
    const edge_mesh   *m = &v->scene->meshes[item->mesh];
    uint8_t           *out = mem_calloc((size_t)m->piece_count + 1, 1);
    double             cofactors[9];
    bool               mirrored = mat4_cofactors(&item->world, cofactors) < 0;
    vec3               eye = eye_of(v);
    for (uint32_t i = 0; i < m->piece_count && out; i++) {
        box3  box = box3_transform(m->boxes[i], &item->world);
        float margin = (float)(v->camera.near + v->same);
        bool  inside = !v->camera.orthographic && eye.x >= box.min.x - margin && eye.x <= box.max.x + margin &&
                      eye.y >= box.min.y - margin && eye.y <= box.max.y + margin && eye.z >= box.min.z - margin &&
                      eye.z <= box.max.z + margin;
        if (m->closed[i] && !inside && !m->solid)
            out[i] = m->inward[i] == mirrored ? 1 : 2;
    }
    return out;
}

static bool put_faces(stroke_view *v, size_t index, const uint8_t *unseen)
{
    const stroke_item *item = &v->scene->items[index];
    const edge_mesh   *m = &v->scene->meshes[item->mesh];
    uint32_t           base = v->items[index].first_point, first = v->items[index].first_face;
    for (uint32_t f = 0; f < m->face_count; f++) {
        const uint32_t *corners = m->faces[f];
        uint32_t        a = base + corners[0], b = base + corners[1], c = base + corners[2], face = first + f;
        bool            front;
        if (v->outside[a] | v->outside[b] | v->outside[c]) {
            clip_point p[3];
            for (int k = 0; k < 3; k++)
                p[k] = position_in_clip_space(v, item_position(item, m->positions[corners[k]]));
            front = faces_eye(p);
            if (m->solid && ((v->outside[a] | v->outside[b] | v->outside[c]) >> PLANE_NEAR & 1))
                v->around[index] = true;
            if (unseen[m->pieces[f]] != (front ? 2 : 1) && !(v->outside[a] & v->outside[b] & v->outside[c]) &&
                !put_clipped(v, p, face))
                return false;
        } else {
            double side = window_side(v->points[a], v->points[b], v->points[c]);
            front = side < 0;
            if (side != 0 && unseen[m->pieces[f]] != (front ? 2 : 1) && !put_triangle(v, a, b, c, face))
                return false;
        }
        v->fronts[face >> 3] = (uint8_t)(v->fronts[face >> 3] | (unsigned)front << (face & 7));
    }
    return true;
}

/* What rounding positions may change of a depth at most, pixels: faces seen from the edge are steeper than any number.
 */
#define STEEPEST 0.02

static float slope_of(window_point a, window_point b, window_point c)
{
    double rise_b = b.z - a.z, rise_c = c.z - a.z;
    double x = rise_b * ((double)c.y - a.y) - rise_c * ((double)b.y - a.y),
           y = rise_c * ((double)b.x - a.x) - rise_b * ((double)c.x - a.x);
    return (float)((fabs(x) + fabs(y)) / fabs(window_side(a, b, c)));
}

/* Behind which depth a line is behind all of a triangle, whatever rounding has done to both. */
static float far_of(const stroke_view *v, window_point a, window_point b, window_point c, const window_box *box)
{
    const double far_z = a.z > b.z ? (a.z > c.z ? a.z : c.z) : (b.z > c.z ? b.z : c.z), largest = fabs(box->near_z),
                 tolerance = view_tolerance(v, v->same, largest > fabs(far_z) ? largest : fabs(far_z));
    return nextafterf((float)(far_z + tolerance + (1 + GAP * v->units) * box->slope), INFINITY);
}

static bool is_inner(const uint32_t beyond[3])
{
    return beyond[0] != NO_TRIANGLE && beyond[1] != NO_TRIANGLE && beyond[2] != NO_TRIANGLE;
}

static void box_triangles(size_t begin, size_t end, void *user)
{
    stroke_view *v = user;
    float        most = (float)(STEEPEST / (0.5 * v->camera.height * fabs(v->camera.projection.m[5])));
    for (size_t i = begin; i < end; i++) {
        window_point a = v->points[v->triangles[i].v[0]], b = v->points[v->triangles[i].v[1]],
                     c = v->points[v->triangles[i].v[2]];
        window_box *box = &v->boxes[i];
        box->low_x = a.x < b.x ? (a.x < c.x ? a.x : c.x) : (b.x < c.x ? b.x : c.x);
        box->low_y = a.y < b.y ? (a.y < c.y ? a.y : c.y) : (b.y < c.y ? b.y : c.y);
        box->high_x = a.x > b.x ? (a.x > c.x ? a.x : c.x) : (b.x > c.x ? b.x : c.x);
        box->high_y = a.y > b.y ? (a.y > c.y ? a.y : c.y) : (b.y > c.y ? b.y : c.y);
        uint32_t solid = view_solid(v, v->triangles[i].face);
        box->near_z = nextafterf((float)(a.z < b.z ? (a.z < c.z ? a.z : c.z) : (b.z < c.z ? b.z : c.z)), -INFINITY);
        box->slope = fminf(slope_of(a, b, c), most * (v->camera.orthographic ? 1 : fabsf(box->near_z)));
        box->far_z = solid ? INFINITY : far_of(v, a, b, c, box);
        box->inner_z = is_inner(v->beyond[i]) ? box->far_z : INFINITY;
        if (solid && v->around[solid - 1]) /* counts wherever it lies: the eye may be in what it encloses */
            box->near_z = -INFINITY;
    }
}

/* --- the view ------------------------------------------------------------------------------------------- */

static bool mark_solids(stroke_view *v)
{
    const stroke_scene *s = v->scene;
    v->around = mem_calloc(s->item_count + 1, sizeof *v->around);
    for (size_t i = 0; i < s->item_count && v->around; i++) {
        if (!s->meshes[s->items[i].mesh].solid)
            continue;
        if (!v->solids)
            v->solids = mem_calloc((size_t)v->piece_count + 1, sizeof *v->solids);
        if (!v->solids)
            return false;
        v->solids[v->items[i].first_piece] = (uint32_t)i + 1;
    }
    return v->around != NULL;
}

/* Numbers of all items' planes; 0 where they are not known. */
static bool mark_planes(stroke_view *v)
{
    const stroke_scene *s = v->scene;
    v->planes = mem_calloc((size_t)v->face_count + 1, sizeof *v->planes);
    for (size_t i = 0; i < s->item_count && v->planes; i++) {
        const edge_mesh *m = &s->meshes[s->items[i].mesh];
        for (uint32_t f = 0; m->planes && f < m->face_count; f++)
            v->planes[v->items[i].first_face + f] = m->planes[f] ? v->items[i].first_plane + m->planes[f] : 0;
    }
    return v->planes != NULL;
}

/* Items that reach about as far are alike: so are most. */
#define REACH_ALIKE 4

/* How exact positions are is each item's own matter. */
static bool mark_sames(stroke_view *v)
{
    const stroke_scene *s = v->scene;
    bool                alike = true;
    for (size_t i = 0; i < s->item_count; i++)
        alike = alike && REACH_ALIKE * s->items[i].reach >= s->reach;
    v->sames = alike ? NULL : mem_alloc((size_t)v->piece_count * sizeof *v->sames);
    for (size_t i = 0; i < s->item_count && v->sames; i++)
        for (uint32_t k = v->items[i].first_piece; k < v->items[i + 1].first_piece; k++)
            v->sames[k] = (float)(SAME_POSITION * s->items[i].reach);
    return alike || v->sames;
}

static lmn_status number_items(stroke_view *v, lmn_error *error)
{
    const stroke_scene *s = v->scene;
    uint64_t            points = 0, faces = 0, pieces = 0, planes = 0;
    v->items = mem_alloc((s->item_count + 1) * sizeof *v->items);
    if (!v->items)
        return error_memory(error);
    for (size_t i = 0; i < s->item_count; i++) {
        const edge_mesh *m = &s->meshes[s->items[i].mesh];
        v->items[i] = (view_item){(uint32_t)points, (uint32_t)faces, (uint32_t)pieces, (uint32_t)planes};
        points += m->vertex_count;
        faces += m->face_count;
        pieces += m->piece_count;
        planes += m->plane_count;
        if (points >= UINT32_MAX / 4 || faces >= UINT32_MAX / 4)
            return error_set(error, LMN_LIMIT, "the scene has more than %u triangles, too many for strokes",
                             UINT32_MAX / 4);
    }
    v->face_count = (uint32_t)faces;
    v->piece_count = (uint32_t)pieces;
    v->vertex_count = (uint32_t)points;
    v->items[s->item_count] = (view_item){v->vertex_count, v->face_count, v->piece_count, (uint32_t)planes};
    v->point_count = v->point_capacity = points;
    v->triangle_capacity = faces;
    v->points = mem_alloc(points * sizeof *v->points);
    v->outside = mem_alloc(points + 1);
    v->fronts = mem_calloc(faces / 8 + 1, 1);
    v->face_pieces = mem_alloc((faces + 1) * sizeof *v->face_pieces);
    v->triangles = mem_alloc(faces * sizeof *v->triangles);
    if (!v->points || !v->outside || !v->fronts || !v->triangles || !v->face_pieces)
        return error_memory(error);
    for (size_t i = 0; i < s->item_count; i++) {
        const edge_mesh *m = &s->meshes[s->items[i].mesh];
        for (uint32_t f = 0; f < m->face_count; f++)
            v->face_pieces[v->items[i].first_face + f] = v->items[i].first_piece + m->pieces[f];
    }
    return mark_solids(v) && (!planes || mark_planes(v)) && mark_sames(v) ? LMN_OK : error_memory(error);
}

static double units_of(const stroke_camera *c)
{
    int side = c->width > c->height ? c->width : c->height;
    return exp2(floor(log2(WINDOW_LIMIT / (2.0 * side))));
}

static lmn_status fill_view(stroke_view *v, lmn_progress_fn progress, void *user, lmn_error *error)
{
    const stroke_scene *s = v->scene;
    lmn_status          status = number_items(v, error);
    for (size_t i = 0; i < s->item_count && status == LMN_OK; i++) {
        threads_for(s->meshes[s->items[i].mesh].vertex_count, 16384, project_points, &(point_job){v, i});
        if (progress && (i & 63) == 0 && !progress((double)i / (double)s->item_count, "projecting", user))
            status = error_set(error, LMN_CANCELLED, "cancelled while the model was projected");
        else {
            uint8_t *unseen = view_unseen(v, i);
            if (!unseen || !put_faces(v, i, unseen))
                status = error_memory(error);
            mem_free(unseen);
        }
    }
    v->boxes = status == LMN_OK ? mem_alloc(v->triangle_count * sizeof *v->boxes) : NULL;
    if (status == LMN_OK && (!v->boxes || !inner_find(v)))
        status = error_memory(error);
    if (status != LMN_OK)
        return status;
    threads_for(v->triangle_count, 16384, box_triangles, v);
    return grid_build(&v->grid, v, error);
}

lmn_status stroke_view_create(stroke_view **out, const stroke_scene *scene, const stroke_camera *camera,
                              lmn_progress_fn progress, void *user, lmn_error *error)
{
    *out = NULL;
    stroke_view *v = mem_calloc(1, sizeof *v);
    if (!v)
        return error_memory(error);
    v->scene = scene;
    v->camera = *camera;
    v->whole = mat4_multiply(&camera->projection, &camera->view);
    v->units = units_of(&v->camera);
    v->same = SAME_POSITION * scene->reach;
    lmn_status status = fill_view(v, progress, user, error);
    if (status != LMN_OK)
        stroke_view_destroy(&v);
    *out = v;
    return status;
}

void stroke_view_destroy(stroke_view **view)
{
    if (!view || !*view)
        return;
    stroke_view *v = *view;
    mem_free(v->items);
    mem_free(v->points);
    mem_free(v->outside);
    mem_free(v->fronts);
    mem_free(v->face_pieces);
    mem_free(v->planes);
    mem_free(v->sames);
    mem_free(v->solids);
    mem_free(v->around);
    mem_free(v->triangles);
    mem_free(v->boxes);
    mem_free(v->beyond);
    grid_release(&v->grid);
    mem_free(v);
    *view = NULL;
}
