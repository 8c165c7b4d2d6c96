/* Where a picture within the picture covers least. */
#include <string.h>

#include "base/error.h"
#include "base/memory.h"
#include "scene/content.h"
#include "depict/inset.h"

/* The page in cells, which know how much is seen in them. */
enum { CELLS = 48 };
typedef struct ink {
    const depict_job *job;
    float             weight; /* of what is put next */
    float             cells[CELLS][CELLS];
} ink;

/* --- what is seen where ---------------------------------------------------------------------------------------------
 */

static void mark(ink *i, int x, int y)
{
    if (x >= 0 && x < CELLS && y >= 0 && y < CELLS)
        i->cells[y][x] = fmaxf(i->cells[y][x], i->weight);
}

/* On which side of an edge a cell's middle lies. */
static double side(const double a[2], const double b[2], double x, double y)
{
    return (b[0] - a[0]) * (y - a[1]) - (b[1] - a[1]) * (x - a[0]);
}

static void mark_triangle(ink *i, const double p[3][2])
{
    double low[2] = {INFINITY, INFINITY}, high[2] = {-INFINITY, -INFINITY};
    for (int k = 0; k < 3; k++) {
        mark(i, (int)floor(p[k][0]), (int)floor(p[k][1]));
        for (int a = 0; a < 2; a++) {
            low[a] = fmin(low[a], p[k][a]);
            high[a] = fmax(high[a], p[k][a]);
        }
    }
    for (int y = (int)fmax(floor(low[1]), 0); y <= (int)fmin(high[1], CELLS - 1); y++)
        for (int x = (int)fmax(floor(low[0]), 0); x <= (int)fmin(high[0], CELLS - 1); x++) {
            double s[3];
            for (int k = 0; k < 3; k++)
                s[k] = side(p[k], p[(k + 1) % 3], x + 0.5, y + 0.5);
            if ((s[0] >= 0 && s[1] >= 0 && s[2] >= 0) || (s[0] <= 0 && s[1] <= 0 && s[2] <= 0))
                mark(i, x, y);
        }
}

static void mark_mesh(ink *i, const vec3 *positions, const uint32_t *indices, size_t count, const mat4 *world)
{
    for (size_t t = 0; t + 2 < count; t += 3) {
        double p[3][2];
        bool   before = true;
        for (size_t k = 0; k < 3 && before; k++) {
            vec3         moved = mat4_transform_point(world, positions[indices[t + k]]);
            const double at[3] = {(double)moved.x, (double)moved.y, (double)moved.z};
            before = page_seen_at(i->job, at, p[k]);
            p[k][0] = fmin(fmax((p[k][0] / i->job->camera.aspect + 1) / 2, -9), 9) * CELLS;
            p[k][1] = fmin(fmax((p[k][1] + 1) / 2, -9), 9) * CELLS;
        }
        if (before)
            mark_triangle(i, (const double(*)[2])p);
    }
}

/* What things stand on may be covered rather than things. */
static float weight_of(const lmn_scene *s, int32_t n)
{
    const char *what = depict_semantics(s, n);
    return what && strcmp(what, "ground") == 0 ? 0.2f : 1;
}

static lmn_status mark_scene(ink *i, lmn_error *error)
{
    const depict_job *j = i->job;
    const pose       *p = NULL;
    lmn_status        status = depict_pose(&p, j, j->when.seconds, error);
    for (size_t k = 0; k < j->scene->part_count && status == LMN_OK; k++) {
        const int32_t own = j->scene->parts[k].node, mesh_index = j->scene->nodes[own].mesh;
        const mesh   *m = mesh_index == NONE || scene_is_hidden(j->scene, own) ? NULL : &j->scene->meshes[mesh_index];
        i->weight = weight_of(j->scene, own);
        for (size_t n = 0; m && n < m->primitive_count && status == LMN_OK; n++) {
            const primitive *from = &m->primitives[n];
            const mat4       world = pose_instance(p, k, 0);
            vec3            *positions = mem_alloc((from->vertex_count + 1) * sizeof *positions);
            if (!positions)
                return error_memory(error);
            pose_vertices(&p->parts[k], from, NULL, NULL, from->vertex_count, positions, NULL);
            mark_mesh(i, positions, from->indices, from->index_count, &world);
            mem_free(positions);
        }
    }
    return status;
}

static double covered(const ink *i, const inset_panel *p)
{
    const double aspect = i->job->camera.aspect;
    double       sum = 0;
    for (int y = 0; y < CELLS; y++)
        for (int x = 0; x < CELLS; x++) {
            const double across = ((x + 0.5) / CELLS * 2 - 1) * aspect, up = (y + 0.5) / CELLS * 2 - 1;
            if (fabs(across - p->middle[0]) <= p->half[0] && fabs(up - p->middle[1]) <= p->half[1])
                sum += (double)i->cells[y][x];
        }
    return sum;
}

lmn_status inset_place(inset_panel *p, const depict_job *j, inset_corner corner, double rim, lmn_error *error)
{
    static const double sides[][2] = {[CORNER_TOP_LEFT] = {-1, 1},
                                      [CORNER_TOP_RIGHT] = {1, 1},
                                      [CORNER_BOTTOM_LEFT] = {-1, -1},
                                      [CORNER_BOTTOM_RIGHT] = {1, -1}};
    /* Of corners as good as each other the first one of these. */
    static const inset_corner order[] = {CORNER_TOP_RIGHT, CORNER_TOP_LEFT, CORNER_BOTTOM_RIGHT, CORNER_BOTTOM_LEFT};
    ink                       seen = {.job = j};
    lmn_status                status = corner == CORNER_AUTO ? mark_scene(&seen, error) : LMN_OK;
    double                    best = INFINITY;
    inset_panel               now = *p;
    seen.weight = 1;
    for (size_t i = 0; i < j->glyph_count && corner == CORNER_AUTO; i++) {
        const glyph_mesh *m = &j->glyphs[i].mesh;
        mark_mesh(&seen, m->positions, m->indices, m->index_count, &j->glyphs[i].world);
    }
    for (int k = 0; k < 4 && status == LMN_OK; k++) {
        const double *to = sides[corner == CORNER_AUTO ? order[k] : corner];
        now.middle[0] = to[0] * (j->camera.aspect - rim - p->half[0]);
        now.middle[1] = to[1] * (1 - rim - p->half[1]);
        const double cost = covered(&seen, &now);
        if (cost < best) {
            best = cost;
            *p = now;
        }
    }
    return status;
}
