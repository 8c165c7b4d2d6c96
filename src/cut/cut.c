#include "cut/cut.h"

#include <math.h>
#include <string.h>

#include "base/memory.h"
#include "cut/cut_private.h"
#include "scene/mesh.h"

cut_verdict cut_judge_box(const cut *c, box3 box)
{
    uint32_t positive = 0, negative = 0; /* planes that all of the box is on these sides of */
    for (int i = 0; i < c->plane_count; i++) {
        const cut_plane *p = &c->planes[i];
        double           low = -p->offset, high = -p->offset;
        const float     *least = &box.min.x, *most = &box.max.x;
        for (int k = 0; k < 3; k++) {
            double a = p->normal[k] * (double)least[k], b = p->normal[k] * (double)most[k];
            low += fmin(a, b);
            high += fmax(a, b);
        }
        /* The box's numbers are rounded. */
        positive |= (uint32_t)(low > 2 * c->snap) << i;
        negative |= (uint32_t)(high < -2 * c->snap) << i;
    }
    if (cut_is_inside(c, positive, negative))
        return CUT_GONE;
    for (int i = 0; i < c->cell_count; i++) {
        bool outside = false;
        for (int k = 0; k < c->cells[i].count; k++)
            outside =
                outside || ((c->cells[i].faces[k].positive ? negative : positive) >> c->cells[i].faces[k].plane & 1);
        if (!outside)
            return CUT_CROSSED;
    }
    return CUT_WHOLE;
}

/* --- the part's vertices -------------------------------------------------------------------------------- */

/* One number for each position, however many primitives and corners share it: `numbers` for all vertices, one
 * primitive's behind the other's. */
static uint32_t *number_positions(cut_job *j, size_t input_count)
{
    size_t total = 0;
    for (size_t i = 0; i < input_count; i++)
        total += j->inputs[i].vertex_count;
    if (total >= UINT32_MAX)
        return NULL;
    primitive all = {.vertex_count = (uint32_t)total, .positions = mem_alloc(total * sizeof(vec3))};
    uint32_t *numbers = NULL;
    size_t    at = 0;
    for (size_t i = 0; all.positions && i < input_count; i++) {
        memcpy(all.positions + at, j->inputs[i].positions, j->inputs[i].vertex_count * sizeof(vec3));
        at += j->inputs[i].vertex_count;
    }
    if (all.positions)
        numbers = mesh_position_ids(&all);
    for (size_t i = 0; numbers && i < total && !j->failed; i++) {
        if (numbers[i] != i) {
            numbers[i] = numbers[numbers[i]]; /* the first at a position comes before the others */
            continue;
        }
        vec3          p = all.positions[i];
        const double *e = j->world->m;
        cut_vertex    v = {.local = {p.x, p.y, p.z}};
        for (int k = 0; k < 3; k++)
            v.world[k] = e[k] * v.local[0] + e[4 + k] * v.local[1] + e[8 + k] * v.local[2] + e[12 + k];
        for (int k = 0; k < j->cut->plane_count; k++) {
            const cut_plane *c = &j->cut->planes[k];
            double h = c->normal[0] * v.world[0] + c->normal[1] * v.world[1] + c->normal[2] * v.world[2] - c->offset;
            v.positive |= (uint32_t)(h > j->cut->snap) << k;
            v.negative |= (uint32_t)(h < -j->cut->snap) << k;
        }
        numbers[i] = job_add_vertex(j, &v);
    }
    mem_free(all.positions);
    return numbers;
}

/* --- shells --------------------------------------------------------------------------------------------- */

static uint32_t root_of(cut_vertex *v, uint32_t i)
{
    while (v[i].shell != i) {
        v[i].shell = v[v[i].shell].shell;
        i = v[i].shell;
    }
    return i;
}

/* Calls the vertices of a triangle. */
static void corners_of(const cut_input *in, const uint32_t *numbers, uint32_t triangle, uint32_t out[3])
{
    for (int k = 0; k < 3; k++)
        out[k] = numbers[in->indices[3 * triangle + (uint32_t)k]];
}

static double volume_of(const cut_job *j, const uint32_t t[3])
{
    double p[3][3];
    for (int i = 0; i < 3; i++)
        for (int k = 0; k < 3; k++)
            p[i][k] = (j->vertices[t[i]].world[k] - j->centre[k]) * j->scale;
    return p[0][0] * (p[1][1] * p[2][2] - p[1][2] * p[2][1]) + p[0][1] * (p[1][2] * p[2][0] - p[1][0] * p[2][2]) +
           p[0][2] * (p[1][0] * p[2][1] - p[1][1] * p[2][0]);
}

/* Connected pieces, numbered in the order of their first vertices, and whether all is inside out. */
static void find_shells(cut_job *j, const uint32_t *numbers, size_t input_count)
{
    for (uint32_t i = 0; i < j->vertex_count; i++)
        j->vertices[i].shell = i;
    const uint32_t *own = numbers;
    for (size_t i = 0; i < input_count; own += j->inputs[i++].vertex_count)
        for (uint32_t t = 0; t < j->inputs[i].index_count / 3; t++) {
            uint32_t c[3];
            corners_of(&j->inputs[i], own, t, c);
            for (int k = 1; k < 3; k++) {
                uint32_t a = root_of(j->vertices, c[0]), b = root_of(j->vertices, c[k]);
                if (a != b) /* the lower one is the root, so that roots are first vertices */
                    j->vertices[a > b ? a : b].shell = a > b ? b : a;
            }
        }
    for (uint32_t i = 0; i < j->vertex_count; i++)
        j->vertices[i].shell =
            j->vertices[i].shell == i ? (uint32_t)j->shell_count++ : j->vertices[j->vertices[i].shell].shell;
    double total = 0;
    own = numbers;
    for (size_t i = 0; i < input_count; own += j->inputs[i++].vertex_count)
        for (uint32_t t = 0; t < j->inputs[i].index_count / 3; t++) {
            uint32_t c[3];
            corners_of(&j->inputs[i], own, t, c);
            total += volume_of(j, c);
        }
    j->inside_out = total < 0;
}

static void measure(cut_job *j)
{
    double low[3] = {INFINITY, INFINITY, INFINITY}, high[3] = {-INFINITY, -INFINITY, -INFINITY}, extent = 0;
    for (size_t i = 0; i < j->vertex_count; i++)
        for (int k = 0; k < 3; k++) {
            low[k] = fmin(low[k], j->vertices[i].world[k]);
            high[k] = fmax(high[k], j->vertices[i].world[k]);
        }
    for (int k = 0; k < 3; k++) {
        j->centre[k] = low[k] / 2 + high[k] / 2;
        extent = fmax(extent, high[k] - low[k]);
    }
    j->scale = extent > 0 && isfinite(extent) ? 1 / extent : 1;
}

/* --- surfaces ------------------------------------------------------------------------------------------- */

/* Triangles that no plane touches with more than a corner are settled at once, the others become pieces. */
static void sort_triangles(cut_job *j, const uint32_t *numbers, size_t input_count)
{
    uint32_t        all = j->cut->plane_count == 32 ? UINT32_MAX : (UINT32_C(1) << j->cut->plane_count) - 1;
    const uint32_t *own = numbers;
    for (size_t i = 0; i < input_count && !j->failed; own += j->inputs[i++].vertex_count) {
        cut_surface *s = &j->out->surfaces[i];
        for (uint32_t t = 0; t < j->inputs[i].index_count / 3 && !j->failed; t++) {
            uint32_t c[3], positive = 0, negative = 0, in[3];
            corners_of(&j->inputs[i], own, t, c);
            for (int k = 0; k < 3; k++) {
                positive |= j->vertices[c[k]].positive;
                negative |= j->vertices[c[k]].negative;
                in[k] = all & ~(j->vertices[c[k]].positive | j->vertices[c[k]].negative);
            }
            if ((positive & negative) | (in[0] & in[1]) | (in[1] & in[2]) | (in[2] & in[0])) {
                cut_piece *p = job_add_piece(j, (cut_point[]){{c[0], {1, 0, 0}}, {c[1], {0, 1, 0}}, {c[2], {0, 0, 1}}},
                                             3, (uint32_t)i, t);
                if (p)
                    p->whole = true;
            } else if (!cut_is_inside(j->cut, positive, negative)) {
                if (!mem_grow((void **)&s->whole, &s->whole_capacity, s->whole_count + 1, sizeof *s->whole))
                    j->failed = true;
                else
                    s->whole[s->whole_count++] = t;
            }
        }
    }
}

/* A piece that lies in a plane counts to the side on which its material is. */
static void settle_flat(cut_job *j, cut_piece *p)
{
    uint32_t touching = p->positive | p->negative;
    for (int k = 0; k < j->cut->plane_count; k++) {
        if (touching >> k & 1)
            continue;
        double        sum = 0;
        const double *a = j->vertices[j->points[p->first].vertex].world;
        for (uint32_t i = 1; i + 1 < p->count; i++) {
            const double *b = j->vertices[j->points[p->first + i].vertex].world,
                         *c = j->vertices[j->points[p->first + i + 1].vertex].world;
            const double *n = j->cut->planes[k].normal;
            double u[3] = {b[0] - a[0], b[1] - a[1], b[2] - a[2]}, v[3] = {c[0] - a[0], c[1] - a[1], c[2] - a[2]};
            sum += n[0] * (u[1] * v[2] - u[2] * v[1]) + n[1] * (u[2] * v[0] - u[0] * v[2]) +
                   n[2] * (u[0] * v[1] - u[1] * v[0]);
        }
        if ((sum > 0) != j->inside_out)
            p->negative |= UINT32_C(1) << k;
        else
            p->positive |= UINT32_C(1) << k;
    }
}

static void make_surfaces(cut_job *j)
{
    for (int k = 0; k < j->cut->plane_count; k++)
        job_slice(j, 0, k);
    for (size_t i = 0; i < j->piece_count && !j->failed; i++) {
        cut_piece *p = &j->pieces[i];
        if (!p->count)
            continue;
        settle_flat(j, p);
        p->kept = !cut_is_inside(j->cut, p->positive, p->negative);
    }
    j->surface_pieces = j->piece_count;
}

/* Which sides of its planes the cells use. */
static void make_caps(cut_job *j)
{
    uint32_t done[2] = {0, 0};
    for (int i = 0; i < j->cut->cell_count; i++)
        for (int k = 0; k < j->cut->cells[i].count && !j->failed; k++) {
            const cut_face *f = &j->cut->cells[i].faces[k];
            uint32_t        bit = UINT32_C(1) << f->plane;
            if (!(done[f->positive] & bit))
                job_cap(j, f->plane, f->positive);
            done[f->positive] |= bit;
        }
}

/* --- what is left --------------------------------------------------------------------------------------- */

/* Corner k of a fan's triangle i. */
static const cut_point *fan_corner(const cut_job *j, const cut_piece *p, uint32_t start, uint32_t i, uint32_t k)
{
    return &j->points[p->first + (start + (k == 0 ? 0 : i + k - 1)) % p->count];
}

static vec3 position_of(const cut_job *j, const cut_point *p)
{
    const double *at = j->vertices[p->vertex].local;
    return (vec3){(float)at[0], (float)at[1], (float)at[2]};
}

static void write_surface(cut_job *j, const cut_piece *p)
{
    cut_surface *s = &j->out->surfaces[p->primitive];
    if (p->whole) {
        if (!mem_grow((void **)&s->whole, &s->whole_capacity, s->whole_count + 1, sizeof *s->whole))
            j->failed = true;
        else
            s->whole[s->whole_count++] = p->triangle;
        return;
    }
    size_t added = 3 * (size_t)(p->count - 2);
    if (!mem_grow((void **)&s->corners, &s->corner_capacity, s->corner_count + added, sizeof *s->corners)) {
        j->failed = true;
        return;
    }
    uint32_t start = job_fan_start(j, p);
    for (uint32_t i = 1; i + 1 < p->count; i++)
        for (uint32_t k = 0; k < 3; k++) {
            const cut_point *from = fan_corner(j, p, start, i, k);
            cut_corner      *c = &s->corners[s->corner_count++];
            *c = (cut_corner){.position = position_of(j, from), .triangle = p->triangle};
            memcpy(c->weights, from->weights, sizeof c->weights);
        }
}

static void write_cap(cut_job *j, const cut_piece *p)
{
    cut_cap *cap = &j->out->caps[p->cap];
    if (!mem_grow((void **)&cap->positions, &cap->capacity, cap->count + 3 * (size_t)(p->count - 2),
                  sizeof *cap->positions)) {
        j->failed = true;
        return;
    }
    uint32_t start = job_fan_start(j, p);
    for (uint32_t i = 1; i + 1 < p->count; i++)
        for (uint32_t k = 0; k < 3; k++)
            cap->positions[cap->count++] = position_of(j, fan_corner(j, p, start, i, j->inside_out && k ? 3 - k : k));
}

static void write_pieces(cut_job *j)
{
    for (size_t i = 0; i < j->piece_count && !j->failed; i++) {
        const cut_piece *p = &j->pieces[i];
        if (p->count && p->kept && p->cap >= 0)
            write_cap(j, p);
        else if (p->count && p->kept)
            write_surface(j, p);
    }
    cut_result *r = j->out;
    size_t      kept = 0;
    for (size_t i = 0; i < r->cap_count; i++)
        if (r->caps[i].count)
            r->caps[kept++] = r->caps[i];
    r->cap_count = kept;
}

/* --- the part ------------------------------------------------------------------------------------------- */

static cut_verdict judge_vertices(const cut_job *j)
{
    uint32_t positive = UINT32_MAX, negative = UINT32_MAX, some_positive = 0, some_negative = 0;
    for (size_t i = 0; i < j->vertex_count; i++) {
        positive &= j->vertices[i].positive;
        negative &= j->vertices[i].negative;
        some_positive |= j->vertices[i].positive;
        some_negative |= j->vertices[i].negative;
    }
    if (cut_is_inside(j->cut, positive, negative))
        return CUT_GONE;
    for (int i = 0; i < j->cut->cell_count; i++) {
        bool outside = false;
        for (int k = 0; k < j->cut->cells[i].count; k++)
            outside = outside || !((j->cut->cells[i].faces[k].positive ? some_positive : some_negative) >>
                                       j->cut->cells[i].faces[k].plane &
                                   1);
        if (!outside)
            return CUT_CROSSED;
    }
    return CUT_WHOLE;
}

static void job_release(cut_job *j)
{
    mem_free(j->vertices);
    mem_free(j->points);
    mem_free(j->pieces);
    mem_free(j->edges);
}

lmn_status cut_part(cut_result *out, const cut *c, const mat4 *world, const cut_input *inputs, size_t input_count,
                    lmn_error *error)
{
    memset(out, 0, sizeof *out);
    cut_job   j = {.cut = c, .inputs = inputs, .world = world, .out = out};
    uint32_t *numbers = number_positions(&j, input_count);
    out->surfaces = mem_calloc(input_count, sizeof *out->surfaces);
    out->surface_count = out->surfaces ? input_count : 0;
    j.failed = j.failed || !numbers || !out->surfaces;
    if (!j.failed)
        out->verdict = judge_vertices(&j);
    if (!j.failed && out->verdict == CUT_CROSSED) {
        measure(&j);
        find_shells(&j, numbers, input_count);
        if (!j.failed)
            sort_triangles(&j, numbers, input_count);
        size_t originals = j.piece_count;
        if (!j.failed)
            make_surfaces(&j);
        if (!j.failed)
            make_caps(&j);
        if (!j.failed)
            job_mend(&j, originals);
        if (!j.failed)
            job_stitch(&j);
        if (!j.failed)
            write_pieces(&j);
    }
    mem_free(numbers);
    job_release(&j);
    return j.failed ? error_memory(error) : LMN_OK;
}

void cut_result_release(cut_result *r)
{
    for (size_t i = 0; i < r->surface_count; i++) {
        mem_free(r->surfaces[i].whole);
        mem_free(r->surfaces[i].corners);
    }
    for (size_t i = 0; i < r->cap_count; i++)
        mem_free(r->caps[i].positions);
    mem_free(r->surfaces);
    mem_free(r->caps);
    memset(r, 0, sizeof *r);
}
