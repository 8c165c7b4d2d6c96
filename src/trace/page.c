#include "trace/trace_private.h"

#include <math.h>

#include "base/memory.h"

enum { SAMPLES_A_UNIT = 2 };
/* The near plane lies before what is there now; what was nearer once counts, too, up to this fraction of it. */
#define NEARER 0.01

bool page_project(const stroke_camera *c, vec3 world, double out[3])
{
    double        eye[3];
    const double *v = c->view.m, *p = c->projection.m;
    for (int k = 0; k < 3; k++)
        eye[k] = v[k] * (double)world.x + v[4 + k] * (double)world.y + v[8 + k] * (double)world.z + v[12 + k];
    double w = c->orthographic ? 1 : -eye[2];
    if (!(-eye[2] > (c->orthographic ? -INFINITY : NEARER * c->near)))
        return false;
    out[0] = 0.5 * c->width * (1 + (p[0] * eye[0] + p[8] * eye[2]) / w);
    out[1] = 0.5 * c->height * (1 - (p[5] * eye[1] + p[9] * eye[2]) / w);
    out[2] = -eye[2];
    return true;
}

void page_unproject(const stroke_camera *c, const double page[3], double out[3])
{
    mat4          back = mat4_inverse(&c->view);
    const double *p = c->projection.m, *m = back.m;
    double        w = c->orthographic ? 1 : page[2];
    double        x = ((2 * page[0] / c->width - 1) * w + p[8] * page[2]) / p[0],
           y = ((1 - 2 * page[1] / c->height) * w + p[9] * page[2]) / p[5], z = -page[2];
    for (int k = 0; k < 3; k++)
        out[k] = m[k] * x + m[4 + k] * y + m[8 + k] * z + m[12 + k];
}

stroke_camera page_camera_of_the_past(const stroke_camera *c)
{
    stroke_camera past = *c;
    past.near *= c->orthographic ? 1 : NEARER;
    return past;
}

bool page_mask_open(page_mask *m, const stroke_camera *c)
{
    m->columns = c->width * SAMPLES_A_UNIT;
    m->rows = c->height * SAMPLES_A_UNIT;
    m->covered = mem_calloc((size_t)m->columns * (size_t)m->rows + 1, 1);
    return m->covered != NULL;
}

void page_mask_close(page_mask *m)
{
    mem_free(m->covered);
    m->covered = NULL;
}

/* Where the edge from p to q crosses a row of samples widens the span. */
static void cross_row(const double *p, const double *q, double y, double span[2])
{
    if ((p[1] < y) == (q[1] < y))
        return;
    double x = p[0] + (y - p[1]) / (q[1] - p[1]) * (q[0] - p[0]);
    span[0] = fmin(span[0], x);
    span[1] = fmax(span[1], x);
}

void page_mask_add(page_mask *m, const double *a, const double *b, const double *c)
{
    const double step = 1.0 / SAMPLES_A_UNIT;
    double       low = fmin(a[1], fmin(b[1], c[1])), high = fmax(a[1], fmax(b[1], c[1]));
    if (!(low <= high) || !isfinite(low) || !isfinite(high))
        return;
    int first = (int)fmax(ceil(low / step - 0.5), 0), last = (int)fmin(floor(high / step - 0.5), m->rows - 1);
    for (int row = first; row <= last; row++) {
        double span[2] = {INFINITY, -INFINITY}, y = (row + 0.5) * step;
        cross_row(a, b, y, span);
        cross_row(b, c, y, span);
        cross_row(c, a, y, span);
        int from = (int)fmax(ceil(fmax(span[0], -1) / step - 0.5), 0),
            to = (int)fmin(floor(fmin(span[1], m->columns * step + 1) / step - 0.5), m->columns - 1);
        for (int column = from; span[0] <= span[1] && column <= to; column++)
            m->covered[(size_t)row * (size_t)m->columns + (size_t)column] = 1;
    }
}

bool page_mask_has(const page_mask *m, double x, double y)
{
    double column = floor(x * SAMPLES_A_UNIT), row = floor(y * SAMPLES_A_UNIT);
    return column >= 0 && row >= 0 && column < m->columns && row < m->rows &&
           m->covered[(size_t)row * (size_t)m->columns + (size_t)column];
}

static bool project_corners(const stroke_camera *camera, const vec3 *world, const primitive *p, size_t first,
                            double out[3][3])
{
    for (int k = 0; k < 3; k++) {
        uint32_t vertex = p->indices[first + (size_t)k];
        if (vertex >= p->vertex_count || !page_project(camera, world[vertex], out[k]))
            return false;
    }
    return true;
}

/* Where segments from a to b and from c to d cross. */
static bool find_crossing(const double *a, const double *b, const double *c, const double *d, double out[2])
{
    double ux = b[0] - a[0], uy = b[1] - a[1], vx = d[0] - c[0], vy = d[1] - c[1], area = ux * vy - uy * vx;
    if (area == 0)
        return false;
    double s = ((c[0] - a[0]) * vy - (c[1] - a[1]) * vx) / area, t = ((c[0] - a[0]) * uy - (c[1] - a[1]) * ux) / area;
    out[0] = a[0] + s * ux;
    out[1] = a[1] + s * uy;
    return s > 0 && s < 1 && t > 0 && t < 1;
}

/* What an edge covers that goes from a, b to c, d: between both places, or what turns about a position of its own, two
 * triangles that meet there. */
static void sweep_edge(page_mask *m, const double *a, const double *b, const double *c, const double *d)
{
    double crossing[2];
    bool   turns = find_crossing(a, b, c, d, crossing);
    page_mask_add(m, a, turns ? crossing : b, turns ? c : d);
    page_mask_add(m, turns ? b : a, turns ? crossing : d, turns ? d : c);
}

/* All that a triangle covers on its straight way from `from`. */
static void sweep_triangle(page_mask *m, const double from[3][3], const double to[3][3])
{
    double farthest = 0;
    for (int k = 0; k < 3; k++)
        farthest = fmax(farthest, hypot(to[k][0] - from[k][0], to[k][1] - from[k][1]));
    for (int k = 0; k < 3 && farthest * SAMPLES_A_UNIT > 0.25; k++)
        sweep_edge(m, from[k], from[(k + 1) % 3], to[k], to[(k + 1) % 3]);
}

static bool add_mesh(page_mask *m, const pose *p, const pose *before, const trace_mesh *mesh,
                     const stroke_camera *camera)
{
    vec3 *world = trace_positions(p, mesh), *earlier = before ? trace_positions(before, mesh) : NULL;
    bool  good = world && (earlier || !before);
    for (size_t i = 0; good && i + 2 < mesh->primitive->index_count; i += 3) {
        double corners[3][3], were[3][3];
        if (!project_corners(camera, world, mesh->primitive, i, corners))
            continue;
        page_mask_add(m, corners[0], corners[1], corners[2]);
        if (earlier && project_corners(camera, earlier, mesh->primitive, i, were))
            sweep_triangle(m, (const double(*)[3])were, (const double(*)[3])corners);
    }
    mem_free(world);
    mem_free(earlier);
    return good;
}

bool page_mask_add_parts(page_mask *m, const pose *p, const pose *before, const bool *parts,
                         const stroke_camera *camera)
{
    const lmn_scene *s = p->scene;
    for (size_t part = 0; part < p->part_count; part++) {
        const node *n = &s->nodes[s->parts[part].node];
        if (!parts[part] || n->mesh == NONE)
            continue;
        for (uint32_t i = 0; i < node_draw_count(n); i++)
            for (size_t k = 0; k < s->meshes[n->mesh].primitive_count; k++) {
                const trace_mesh mesh = {(uint32_t)part, i, 0, &s->meshes[n->mesh].primitives[k]};
                if (!add_mesh(m, p, before, &mesh, camera))
                    return false;
            }
    }
    return true;
}
