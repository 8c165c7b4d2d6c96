#include "scene/clean.h"

#include <math.h>
#include <string.h>

#include "base/memory.h"

typedef struct dvec3 {
    double x, y, z;
} dvec3;

static dvec3 face_cross(vec3 a, vec3 b, vec3 c)
{
    double ux = (double)b.x - a.x, uy = (double)b.y - a.y, uz = (double)b.z - a.z;
    double vx = (double)c.x - a.x, vy = (double)c.y - a.y, vz = (double)c.z - a.z;
    return (dvec3){uy * vz - uz * vy, uz * vx - ux * vz, ux * vy - uy * vx};
}

static bool is_finite_point(vec3 p)
{
    return isfinite(p.x) && isfinite(p.y) && isfinite(p.z);
}

/* A triangle that has no area at rest may open when morphs or joints move it; then only repeated corners count. */
static bool has_no_area(const primitive *p, const uint32_t *t, bool keep_closed)
{
    if (t[0] == t[1] || t[1] == t[2] || t[0] == t[2])
        return true;
    if (p->morph_count || p->joints || keep_closed)
        return false;
    dvec3 cross = face_cross(p->positions[t[0]], p->positions[t[1]], p->positions[t[2]]);
    return cross.x == 0 && cross.y == 0 && cross.z == 0;
}

static void drop_triangles(primitive *p, bool keep_closed, clean_counts *counts)
{
    uint32_t kept = 0;
    counts->triangles += p->index_count / 3;
    for (uint32_t i = 0; i < p->index_count; i += 3) {
        const uint32_t *t = p->indices + i;
        if (!is_finite_point(p->positions[t[0]]) || !is_finite_point(p->positions[t[1]]) ||
            !is_finite_point(p->positions[t[2]])) {
            counts->not_finite++;
            continue;
        }
        if (has_no_area(p, t, keep_closed)) {
            counts->degenerate++;
            continue;
        }
        if (kept != i) {
            memmove(p->indices + kept, t, 3 * sizeof *t);
            if (p->edges.values)
                memmove(p->edges.values + kept, p->edges.values + i, 3);
        }
        kept += 3;
    }
    p->index_count = kept;
}

/* Lines without length at rest may open like triangles. */
static bool has_no_length(const primitive *p, const uint32_t *l)
{
    vec3 a = p->positions[l[0]], b = p->positions[l[1]];
    return l[0] == l[1] || (!p->morph_count && !p->joints && a.x == b.x && a.y == b.y && a.z == b.z);
}

static void drop_lines(primitive *p, clean_counts *counts)
{
    uint32_t kept = 0;
    counts->lines += p->line_count;
    for (uint32_t i = 0; i < p->line_count; i++) {
        const uint32_t l[2] = {p->lines[2 * i], p->lines[2 * i + 1]};
        bool           finite = is_finite_point(p->positions[l[0]]) && is_finite_point(p->positions[l[1]]);
        if (!finite)
            counts->lines_not_finite++;
        else if (has_no_length(p, l))
            counts->lines_short++;
        else
            memcpy(p->lines + 2 * kept++, l, sizeof l);
    }
    p->line_count = kept;
}

/* Moves each kept element to its new position; new positions never lie behind old ones. */
static void compact(void *array, size_t element, const uint32_t *positions, uint32_t count)
{
    char *bytes = array;
    for (uint32_t i = 0; bytes && i < count; i++)
        if (positions[i] != UINT32_MAX && positions[i] != i)
            memcpy(bytes + positions[i] * element, bytes + i * element, element);
}

static bool drop_vertices(primitive *p)
{
    uint32_t *positions = mem_alloc((size_t)p->vertex_count * sizeof *positions);
    if (!positions)
        return false;
    memset(positions, 0xFF, (size_t)p->vertex_count * sizeof *positions);
    for (uint32_t i = 0; i < p->index_count; i++)
        positions[p->indices[i]] = 0;
    for (uint32_t i = 0; i < 2 * p->line_count; i++)
        positions[p->lines[i]] = 0;
    uint32_t kept = 0;
    for (uint32_t i = 0; i < p->vertex_count; i++)
        if (positions[i] == 0)
            positions[i] = kept++;
    if (kept < p->vertex_count) {
        compact(p->positions, sizeof *p->positions, positions, p->vertex_count);
        compact(p->normals, sizeof *p->normals, positions, p->vertex_count);
        compact(p->straight, sizeof *p->straight, positions, p->vertex_count);
        for (int i = 0; i < UV_SETS; i++)
            compact(p->uvs[i], sizeof *p->uvs[i], positions, p->vertex_count);
        compact(p->colours, sizeof *p->colours, positions, p->vertex_count);
        compact(p->joints, p->influences * sizeof *p->joints, positions, p->vertex_count);
        compact(p->weights, p->influences * sizeof *p->weights, positions, p->vertex_count);
        for (size_t i = 0; i < p->morph_count; i++) {
            compact(p->morphs[i].positions, sizeof(vec3), positions, p->vertex_count);
            compact(p->morphs[i].normals, sizeof(vec3), positions, p->vertex_count);
        }
        for (uint32_t i = 0; i < p->index_count; i++)
            p->indices[i] = positions[p->indices[i]];
        for (uint32_t i = 0; i < 2 * p->line_count; i++)
            p->lines[i] = positions[p->lines[i]];
        p->vertex_count = kept;
    }
    mem_free(positions);
    return true;
}

static bool unit_normal(vec3 *n)
{
    double square = (double)n->x * n->x + (double)n->y * n->y + (double)n->z * n->z;
    if (!(square > 1e-30 && isfinite(square)))
        return false;
    if (fabs(square - 1) > 1e-5) {
        double inverse = 1 / sqrt(square);
        *n = (vec3){(float)(n->x * inverse), (float)(n->y * inverse), (float)(n->z * inverse)};
    }
    return true;
}

/* Gives vertices without a usable normal that of their triangles, weighted by area. */
static bool repair_normals(primitive *p, clean_counts *counts)
{
    uint64_t bad = 0;
    for (uint32_t i = 0; i < p->vertex_count; i++)
        if (!unit_normal(&p->normals[i])) {
            p->normals[i] = (vec3){0, 0, 0};
            bad++;
        }
    if (bad == 0)
        return true;
    counts->normals += bad;
    dvec3 *sums = mem_calloc(p->vertex_count, sizeof *sums);
    if (!sums)
        return false;
    for (uint32_t i = 0; i < p->index_count; i += 3) {
        const uint32_t *t = p->indices + i;
        dvec3           cross = face_cross(p->positions[t[0]], p->positions[t[1]], p->positions[t[2]]);
        for (int k = 0; k < 3; k++) {
            sums[t[k]].x += cross.x;
            sums[t[k]].y += cross.y;
            sums[t[k]].z += cross.z;
        }
    }
    for (uint32_t i = 0; i < p->vertex_count; i++) {
        vec3 *n = &p->normals[i];
        if (n->x != 0 || n->y != 0 || n->z != 0)
            continue;
        double length = sqrt(sums[i].x * sums[i].x + sums[i].y * sums[i].y + sums[i].z * sums[i].z);
        *n = length > 0 && isfinite(length)
                 ? (vec3){(float)(sums[i].x / length), (float)(sums[i].y / length), (float)(sums[i].z / length)}
                 : (vec3){0, 0, 1};
    }
    mem_free(sums);
    return true;
}

static void make_finite(float *values, size_t count, clean_counts *counts)
{
    for (size_t i = 0; values && i < count; i++)
        if (!isfinite(values[i])) {
            values[i] = 0;
            counts->values++;
        }
}

/* Joint weights that do not sum to 1 would pull vertices to the origin, negative ones push them away from their joint;
 * without any weight the first joint holds. */
static void normalise_weights(primitive *p, clean_counts *counts)
{
    for (uint32_t i = 0; i < p->vertex_count; i++) {
        float *w = &p->weights[(size_t)i * p->influences], sum = 0;
        for (uint32_t k = 0; k < p->influences; k++) {
            w[k] = w[k] > 0 ? w[k] : 0;
            sum += w[k];
        }
        bool good = sum > 0 && isfinite(sum);
        counts->unheld += !good;
        for (uint32_t k = 0; k < p->influences; k++)
            if (!good)
                w[k] = k == 0;
            else if (fabsf(sum - 1) > 1e-6f)
                w[k] /= sum;
    }
}

static void set_bounds(primitive *p)
{
    box3 box = box3_empty();
    for (uint32_t i = 0; i < p->vertex_count; i++) {
        vec3 v = p->positions[i];
        box.min.x = v.x < box.min.x ? v.x : box.min.x;
        box.min.y = v.y < box.min.y ? v.y : box.min.y;
        box.min.z = v.z < box.min.z ? v.z : box.min.z;
        box.max.x = v.x > box.max.x ? v.x : box.max.x;
        box.max.y = v.y > box.max.y ? v.y : box.max.y;
        box.max.z = v.z > box.max.z ? v.z : box.max.z;
    }
    p->bounds = box;
}

bool primitive_clean(primitive *p, bool keep_closed, clean_counts *counts)
{
    drop_triangles(p, keep_closed, counts);
    drop_lines(p, counts);
    if (p->index_count == 0 && p->line_count == 0)
        return true;
    if (!drop_vertices(p))
        return false;
    size_t count = p->vertex_count;
    if (p->normals && !repair_normals(p, counts))
        return false;
    for (int i = 0; i < UV_SETS; i++)
        make_finite((float *)p->uvs[i], count * 2, counts);
    make_finite((float *)p->colours, count * 4, counts);
    make_finite(p->weights, count * p->influences, counts);
    for (size_t i = 0; i < p->morph_count; i++) {
        make_finite((float *)p->morphs[i].positions, count * 3, counts);
        make_finite((float *)p->morphs[i].normals, count * 3, counts);
    }
    if (p->joints && p->weights)
        normalise_weights(p, counts);
    set_bounds(p);
    return true;
}
