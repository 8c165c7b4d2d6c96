/* Curvature as the change of normals: over a triangle, the gradient of the normals that its corners have, times its
 * area, needs no division and is therefore as good on slivers as elsewhere. Summed over a disc only the disc's
 * border remains, so what irregular triangles do to single ones cancels out. The sum of bent edges (Alliez et al.
 * 2003), tried on the same discs, is as good on regular triangles, and far worse on irregular ones: on a dense
 * ellipsoid with jittered vertices 95 % of its directions are within 13.5 degrees, of these within 2.2. */
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "base/threads.h"
#include "base/work.h"
#include "field/direction_field_private.h"

enum {
    PIECE = 8192,       /* per thread at least */
    STEPS_OF_THREE = 7, /* steps of smoothing that spread as far as a disc of three edges does */
    STEPS_MAX = 64,
    STEPS_OF_DIRECTION = 3,
    STEPS_OF_NORMALS = 8,
    ROUGH_LEAST = 2000, /* elements: what has fewer is no scan */
    SCALES = 3, /* discs over which rough surfaces are measured: each three times as many steps as the one before */
};

/* What is left of bends after the first steps: single triangles of scans bend more than twice as much as discs of them
 * do, those of what was modelled, whatever triangles it has, less than half as much again. */
static const double rough_from = 1.9;

static const double DIRECTED = 0.2; /* difference of curvatures over their mean from which one is the greater */
static const double UNLIKE = 0.2; /* fraction of directions that lie another way over wider discs, of uneven surfaces */

/* Curvature times the model's diagonal: below the first number the surface counts as flat, from ten times that on
 * as bent. */
static const double flat_below = 0.02;

/* Of a surface while its field is made. */
typedef struct field_values {
    tensor *tensors, *flow; /* per element; room for one a triangle */
    bool   *flat;           /* per element */
    bool    rough;
} field_values;

typedef struct curvature_job {
    const field_surface *surface;
    tensor              *triangles, *elements;
    const bool          *fixed;
    bool                *flat;
    double               flat_below;
} curvature_job;

/* The change of normals over a triangle times its area. */
static tensor triangle_bend(const field_surface *s, size_t t)
{
    point3 u, v, n = s->directions[t];
    double uu = 0, uv = 0, vv = 0;
    if (point_dot(n, n) == 0)
        return (tensor){{0}};
    tangents(n, &u, &v);
    for (size_t k = 0; k < 3; k++) {
        uint32_t a = s->corners[3 * t + k], b = s->corners[3 * t + (k + 1) % 3], c = s->corners[3 * t + (k + 2) % 3];
        point3   rise = point_scale(point_cross(n, point_sub(s->positions[c], s->positions[b])), 0.5);
        point3   normal = s->normals[a];
        uu += point_dot(normal, u) * point_dot(rise, u);
        vv += point_dot(normal, v) * point_dot(rise, v);
        uv += (point_dot(normal, u) * point_dot(rise, v) + point_dot(normal, v) * point_dot(rise, u)) / 2;
    }
    return tensor_of(u, v, (uu - vv) / 2, uv, (uu + vv) / 2);
}

static void bend_triangles(size_t begin, size_t end, void *user)
{
    curvature_job *job = user;
    for (size_t t = begin; t < end; t++)
        job->triangles[t] = triangle_bend(job->surface, t);
}

/* The first step of smoothing, from areas times curvatures to curvatures. */
static void bend_elements(size_t begin, size_t end, void *user)
{
    curvature_job       *job = user;
    const field_surface *s = job->surface;
    for (size_t e = begin; e < end; e++) {
        double sums[6] = {0}, area = 0;
        for (uint32_t i = s->starts[e]; i < s->starts[e + 1]; i++) {
            uint32_t t = s->around[i] / 3;
            for (int k = 0; k < 6; k++)
                sums[k] += (double)job->triangles[t].v[k];
            area += s->areas[t];
        }
        for (int k = 0; k < 6; k++)
            job->elements[e].v[k] = area > 0 ? (float)(sums[k] / area) : 0;
    }
}

static void smooth_to_triangles(size_t begin, size_t end, void *user)
{
    curvature_job  *job = user;
    const uint32_t *corners = job->surface->corners;
    for (size_t t = begin; t < end; t++)
        for (int k = 0; k < 6; k++)
            job->triangles[t].v[k] = (job->elements[corners[3 * t]].v[k] + job->elements[corners[3 * t + 1]].v[k] +
                                      job->elements[corners[3 * t + 2]].v[k]) /
                                     3;
}

static void smooth_to_elements(size_t begin, size_t end, void *user)
{
    curvature_job       *job = user;
    const field_surface *s = job->surface;
    for (size_t e = begin; e < end; e++) {
        float sums[6] = {0}, area = 0;
        if (job->fixed && job->fixed[e])
            continue;
        for (uint32_t i = s->starts[e]; i < s->starts[e + 1]; i++) {
            uint32_t t = s->around[i] / 3;
            float    weight = (float)s->areas[t];
            for (int k = 0; k < 6; k++)
                sums[k] += weight * job->triangles[t].v[k];
            area += weight;
        }
        for (int k = 0; k < 6 && area > 0; k++)
            job->elements[e].v[k] = sums[k] / area;
    }
}

void field_smooth(const field_surface *s, tensor *values, tensor *flow, const bool *fixed)
{
    curvature_job job = {.surface = s, .elements = values, .triangles = flow, .fixed = fixed};
    threads_for(s->triangle_count, PIECE, smooth_to_triangles, &job);
    threads_for(s->element_count, PIECE, smooth_to_elements, &job);
}

/* From curvatures to T; also finds where the surface is flat. */
static void make_directions(size_t begin, size_t end, void *user)
{
    curvature_job *job = user;
    for (size_t e = begin; e < end; e++) {
        const tensor *bend = &job->elements[e];
        point3        u, v;
        double        a, b;
        tangents(job->surface->normals[e], &u, &v);
        tensor_traceless(bend, u, v, &a, &b);
        double mean = (tensor_apply(bend, u, u) + tensor_apply(bend, v, v)) / 2, difference = hypot(a, b);
        double greater = fmax(fabs(mean), difference), less = fmin(fabs(mean), difference);
        double known = smooth_step(job->flat_below, 10 * job->flat_below, fabs(mean) + difference);
        /* (|k1| − |k2|) / (|k1| + |k2|), whatever the signs are. */
        double sure = greater > 0 ? known * less / greater : 0;
        double factor = difference > 0 ? (mean < 0 ? -sure : sure) / difference : 0;
        job->flat[e] = known < 0.05;
        job->elements[e] = tensor_of(u, v, a * factor, b * factor, 0);
    }
}

static void flatten(const field_surface *s, tensor *values)
{
    for (uint32_t e = 0; e < s->element_count; e++) {
        point3 u, v;
        double a, b;
        tangents(s->normals[e], &u, &v);
        tensor_traceless(&values[e], u, v, &a, &b);
        double sure = hypot(a, b), factor = sure > 1 ? 1 / sure : 1;
        values[e] = tensor_of(u, v, a * factor, b * factor, 0);
    }
}

static int smoothing_steps(const field_surface *s, double radius)
{
    double edges = radius > 0 && isfinite(radius) ? radius / (s->size * s->mean_edge) : 3;
    double steps = STEPS_OF_THREE * (edges / 3) * (edges / 3);
    return steps < 1 ? 1 : steps > STEPS_MAX ? STEPS_MAX : (int)(steps + 0.5);
}

static int by_size(const void *a, const void *b)
{
    float x = *(const float *)a, y = *(const float *)b;
    return x < y ? -1 : x > y;
}

/* The median of how much elements bend; −1: memory is gone. */
static double middle_bend(const field_surface *s, const tensor *values)
{
    float *sizes = mem_alloc(s->element_count * sizeof *sizes);
    if (!sizes)
        return -1;
    for (size_t e = 0; e < s->element_count; e++) {
        sizes[e] = 0;
        for (int k = 0; k < 6; k++)
            sizes[e] += (k < 3 ? 1.0f : 2.0f) * values[e].v[k] * values[e].v[k];
    }
    qsort(sizes, s->element_count, sizeof *sizes, by_size);
    double middle = s->element_count ? sqrt((double)sizes[s->element_count / 2]) : 0;
    mem_free(sizes);
    return middle;
}

/* Do two bends lie the same way, but for a right angle, within 15 degrees? */
static bool same_cross(const field_surface *s, size_t e, const tensor *one, const tensor *other)
{
    point3 u, v;
    double a[2], b[2];
    tangents(s->normals[e], &u, &v);
    tensor_traceless(one, u, v, &a[0], &a[1]);
    tensor_traceless(other, u, v, &b[0], &b[1]);
    double along = a[0] * b[0] + a[1] * b[1], both = (a[0] * a[0] + a[1] * a[1]) * (b[0] * b[0] + b[1] * b[1]);
    return 2 * along * along >= 1.5 * both;
}

/* Each element takes the smallest disc that the next wider one agrees with. */
static bool choose_scales(const field_surface *s, tensor *values, tensor *flow, int steps)
{
    size_t  count = s->element_count;
    tensor *chosen = mem_copy(values, count * sizeof *values), *last = mem_copy(values, count * sizeof *values);
    bool   *settled = mem_calloc(count, sizeof *settled), good = chosen && last && settled;
    for (int k = 1, more = 2 * steps; k < SCALES && good; k++, more *= 3) {
        for (int i = 0; i < more && good; i++) {
            field_smooth(s, values, flow, NULL);
            good = !work_stopped();
        }
        for (size_t e = 0; e < count && good; e++) {
            if (!settled[e] && same_cross(s, e, &last[e], &values[e]))
                settled[e] = true;
            else if (!settled[e])
                chosen[e] = values[e];
            last[e] = values[e];
        }
    }
    if (good && count)
        memcpy(values, chosen, count * sizeof *values);
    mem_free(chosen);
    mem_free(last);
    mem_free(settled);
    return good;
}

/* Does a bend have a direction at all: is it not the same all around? */
static bool has_direction(const field_surface *s, size_t e, const tensor *bend)
{
    point3 u, v;
    double a, b;
    tangents(s->normals[e], &u, &v);
    tensor_traceless(bend, u, v, &a, &b);
    return hypot(a, b) > DIRECTED * fabs(tensor_apply(bend, u, u) + tensor_apply(bend, v, v)) / 2;
}

/* Facets that were rounded and dents turn directions, too: where so many lie another way over a wider disc, the wider
 * ones are taken everywhere, so that there is no seam between both. */
static bool calm_down(const field_surface *s, tensor *values, tensor *flow, int more)
{
    size_t  count = s->element_count, directed = 0, unlike = 0;
    tensor *narrow = mem_copy(values, count * sizeof *values);
    for (int i = 0; i < more && narrow && !work_stopped(); i++)
        field_smooth(s, values, flow, NULL);
    for (size_t e = 0; e < count && narrow; e++) {
        bool counts = has_direction(s, e, &narrow[e]);
        directed += counts;
        unlike += counts && !same_cross(s, e, &narrow[e], &values[e]);
    }
    if (narrow && count && (double)unlike <= UNLIKE * (double)directed)
        memcpy(values, narrow, count * sizeof *values);
    mem_free(narrow);
    return narrow && !work_stopped();
}

/* Curvature over discs; *rough: the surface is a scan, or as uneven as one. False when memory is gone. */
static bool make_bends(const field_surface *s, curvature_job *job, int steps, bool *rough)
{
    threads_for(s->triangle_count, PIECE, bend_triangles, job);
    threads_for(s->element_count, PIECE, bend_elements, job);
    double first = middle_bend(s, job->elements);
    for (int i = steps; i > 1; i--)
        field_smooth(s, job->elements, job->triangles, NULL);
    double left = middle_bend(s, job->elements);
    *rough = steps >= STEPS_OF_THREE && s->element_count >= ROUGH_LEAST && first > rough_from * left;
    return first >= 0 && left >= 0;
}

/* Noise turns normals too, and what is carried along the surface turns with them. */
static bool smooth_normals(field_surface *s)
{
    point3 *sums = mem_alloc(s->element_count * sizeof *sums);
    for (int i = 0; sums && i < STEPS_OF_NORMALS; i++) {
        for (uint32_t e = 0; e < s->element_count; e++) {
            sums[e] = (point3){0, 0, 0};
            for (uint32_t k = s->starts[e]; k < s->starts[e + 1]; k++)
                for (uint32_t c = s->around[k] / 3 * 3, end = c + 3; c < end; c++)
                    sums[e] = point_add(sums[e], s->normals[s->corners[c]]);
        }
        for (uint32_t e = 0; e < s->element_count; e++)
            s->normals[e] = point_unit_or(sums[e], s->normals[e]);
    }
    mem_free(sums);
    return sums != NULL;
}

static lmn_status make_tensors(field_surface *s, double radius, double calm, field_values *v, lmn_error *error)
{
    curvature_job job = {.surface = s, .triangles = v->flow, .elements = v->tensors, .flat = v->flat};
    int           steps = smoothing_steps(s, radius);
    /* Averaging over the disc leaves about a third of what rounding does to single triangles. */
    job.flat_below = fmax(flat_below, 0.3 * s->rounding / (s->mean_edge * s->mean_edge));
    if (!make_bends(s, &job, steps, &v->rough))
        return error_memory(error);
    if (v->rough && s->cut)
        return LMN_OK;
    if (v->rough && (!choose_scales(s, v->tensors, v->flow, steps) || !smooth_normals(s)))
        return error_memory(error);
    int more = calm > 0 ? smoothing_steps(s, calm) - steps : 0;
    if (!v->rough && more > 0 && !calm_down(s, v->tensors, v->flow, more))
        return error_memory(error);
    threads_for(s->element_count, PIECE, make_directions, &job);
    for (int i = 0; i < STEPS_OF_DIRECTION; i++)
        field_smooth(s, v->tensors, v->flow, NULL);
    flatten(s, v->tensors);
    return field_cross(s, v->tensors, v->flat, v->rough) ? LMN_OK : error_memory(error);
}

static const double of_planes = 0.05; /* how sure a plane's direction is: it was chosen, not found */

/* The plane in which all of an element lies; NOWHERE: not in one. */
static uint32_t plane_of(const field_surface *s, const field_planes *planes, size_t e)
{
    uint32_t first = s->starts[e], plane = first < s->starts[e + 1] ? planes->of[s->around[first] / 3] : NOWHERE;
    for (uint32_t i = first; i < s->starts[e + 1]; i++)
        if (planes->of[s->around[i] / 3] != plane)
            return NOWHERE;
    return plane;
}

/* What lies in a plane has its direction. */
static void keep_to_planes(const field_surface *s, field_planes *planes, tensor *values)
{
    if (!planes->count)
        return;
    for (uint32_t k = 0; k < planes->count; k++)
        for (int i = 0; i < 6; i++)
            planes->units[k].v[i] *= (float)of_planes;
    for (size_t e = 0; e < s->element_count; e++) {
        uint32_t plane = plane_of(s, planes, e);
        if (plane != NOWHERE)
            values[e] = planes->units[plane];
    }
}

/* Corners of planes that share their element with what is no plane, or with another one, get the plane's tensor. */
static void part_planes(uint32_t *corners, const primitive *p, const field_surface *s, const field_planes *planes,
                        uint32_t first)
{
    for (uint32_t c = 0; c < p->index_count; c++) {
        uint32_t t = s->kept[c / 3], e = field_surface_element(s, p, c);
        if (t != NOWHERE && e != NOWHERE && planes->of[t] != NOWHERE && plane_of(s, planes, e) == NOWHERE)
            corners[c] = first + planes->of[t];
    }
}

/* Gives each vertex the tensor of its first element, each further element of a vertex a tensor behind those, and each
 * plane one behind all. */
static bool hand_out(direction_field *out, const primitive *p, const field_surface *s, const tensor *values,
                     const field_planes *planes)
{
    uint32_t *first = mem_alloc((size_t)p->vertex_count * sizeof *first);
    uint32_t *further = mem_alloc((size_t)s->element_count * sizeof *further);
    uint32_t *corners = mem_alloc((size_t)p->index_count * sizeof *corners);
    bool      good = first && further && corners, split = false;
    uint32_t  count = p->vertex_count;
    if (good) {
        memset(first, 0xFF, (size_t)p->vertex_count * sizeof *first);
        memset(further, 0xFF, (size_t)s->element_count * sizeof *further);
    }
    for (uint32_t c = 0; good && c < p->index_count; c++) {
        uint32_t v = p->indices[c], e = field_surface_element(s, p, c);
        corners[c] = v;
        if (first[v] == NOWHERE)
            first[v] = e;
        if (e == NOWHERE || first[v] == e)
            continue;
        if (further[e] == NOWHERE)
            further[e] = count++;
        corners[c] = further[e];
        split = true;
    }
    uint32_t first_plane = count;
    if (good && planes->count) {
        part_planes(corners, p, s, planes, first_plane);
        count += planes->count;
        split = true;
    }
    out->tensors = good ? mem_calloc(count, sizeof *out->tensors) : NULL;
    if (out->tensors) {
        for (uint32_t v = 0; v < p->vertex_count; v++)
            if (first[v] != NOWHERE)
                memcpy(out->tensors[v], values[first[v]].v, sizeof values->v);
        for (uint32_t e = 0; e < s->element_count; e++)
            if (further[e] != NOWHERE)
                memcpy(out->tensors[further[e]], values[e].v, sizeof values->v);
        for (uint32_t k = 0; k < planes->count; k++)
            memcpy(out->tensors[first_plane + k], planes->units[k].v, sizeof values->v);
        out->count = p->vertex_count;
        out->tensor_count = count;
        out->corners = split ? corners : NULL;
    }
    mem_free(first);
    mem_free(further);
    if (!out->corners)
        mem_free(corners);
    return out->tensors != NULL;
}

static lmn_status make_field(direction_field *out, const primitive *p, double feature_angle, double radius, double calm,
                             bool *again, lmn_error *error)
{
    field_surface s;
    lmn_status    status = field_surface_make(&s, p, feature_angle, error);
    *again = false;
    if (status != LMN_OK)
        return status;
    field_values v = {.tensors = mem_alloc(s.element_count * sizeof *v.tensors),
                      .flow = mem_alloc(s.triangle_count * sizeof *v.flow),
                      .flat = mem_calloc(s.element_count, sizeof *v.flat)};
    status = v.tensors && v.flow && v.flat ? make_tensors(&s, radius, calm, &v, error) : error_memory(error);
    *again = status == LMN_OK && v.rough && s.cut;
    field_planes planes = {0};
    if (status == LMN_OK && !*again) {
        bool good = v.rough || field_planes_find(&planes, &s, v.tensors, v.flat);
        keep_to_planes(&s, &planes, v.tensors);
        if (!good || !hand_out(out, p, &s, v.tensors, &planes))
            status = error_memory(error);
    }
    field_planes_release(&planes);
    mem_free(v.tensors);
    mem_free(v.flow);
    mem_free(v.flat);
    field_surface_release(&s);
    return status;
}

lmn_status direction_field_make(direction_field *out, const primitive *p, double feature_angle, double radius,
                                double calm, lmn_error *error)
{
    const double none = 4; /* radians */
    bool         again;
    memset(out, 0, sizeof *out);
    lmn_status status = make_field(out, p, feature_angle, radius, calm, &again, error);
    /* What look like features of a scan is noise. */
    if (again)
        status = make_field(out, p, none, radius, calm, &again, error);
    return status;
}

void direction_field_release(direction_field *f)
{
    mem_free(f->tensors);
    mem_free(f->corners);
    memset(f, 0, sizeof *f);
}
