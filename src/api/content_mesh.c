#include "api/content_mesh.h"

#include <math.h>
#include <string.h>

#include "base/colour.h"
#include "base/error.h"
#include "base/limits.h"
#include "base/memory.h"

enum { INFLUENCES = 4 };

typedef struct numbers {
    const float *values;
    size_t       count, components;
    const char  *what;
    float        least, most;
} numbers;

static lmn_status check_numbers(const numbers *n, const char *caller, lmn_error *error)
{
    for (size_t i = 0; n->values && i < n->count * n->components; i++)
        if (!(n->values[i] >= n->least && n->values[i] <= n->most))
            return error_set(error, LMN_USAGE, "%s: %s %zu of vertex %zu is %g", caller, n->what, i % n->components,
                             i / n->components, (double)n->values[i]);
    return LMN_OK;
}

static lmn_status check_indices(const uint32_t *indices, size_t count, size_t corners, size_t vertices,
                                const char *what, const char *caller, lmn_error *error)
{
    if (count % corners != 0)
        return error_set(error, LMN_USAGE, "%s: %zu indices are no whole number of %ss", caller, count, what);
    for (size_t i = 0; i < count; i++)
        if (indices[i] >= vertices)
            return error_set(error, LMN_USAGE, "%s: index %u of %s %zu is out of range, there are %zu vertices", caller,
                             (unsigned)indices[i], what, i / corners, vertices);
    return LMN_OK;
}

static lmn_status check_weights(const lmn_mesh_desc *d, const char *caller, lmn_error *error)
{
    for (size_t i = 0; d->weights && i < d->vertex_count; i++) {
        const float *w = &d->weights[INFLUENCES * i];
        if (!(w[0] + w[1] + w[2] + w[3] > 0))
            return error_set(error, LMN_USAGE, "%s: all weights of vertex %zu are 0", caller, i);
    }
    return LMN_OK;
}

static lmn_status check_counts(const lmn_mesh_desc *d, const char *caller, lmn_error *error)
{
    if (!d->positions || d->vertex_count == 0)
        return error_set(error, LMN_USAGE, "%s: the mesh has no positions", caller);
    if (d->vertex_count > LIMIT_VERTICES)
        return error_set(error, LMN_LIMIT, "%s: %zu vertices, more than %zu", caller, d->vertex_count, LIMIT_VERTICES);
    if (d->index_count > 3 * LIMIT_TRIANGLES || d->line_index_count > 2 * LIMIT_LINES)
        return error_set(error, LMN_LIMIT, "%s: more than %zu triangles or %zu lines", caller, LIMIT_TRIANGLES,
                         LIMIT_LINES);
    if (d->lines ? d->line_index_count == 0 || d->indices || d->index_count : d->line_index_count > 0)
        return error_set(error, LMN_USAGE, "%s: a mesh has either triangles or lines", caller);
    if ((d->index_count > 0) != (d->indices != NULL))
        return error_set(error, LMN_USAGE, "%s: `indices` and `index_count` do not fit", caller);
    if ((d->joints != NULL) != (d->weights != NULL))
        return error_set(error, LMN_USAGE, "%s: joints and weights belong together", caller);
    return LMN_OK;
}

static lmn_status check_mesh(const lmn_scene *scene, const lmn_mesh_desc *d, const char *caller, lmn_error *error)
{
    lmn_status status = check_counts(d, caller, error);
    numbers    all[] = {{d->uvs, d->vertex_count, 2, "texture coordinate", -1e9f, 1e9f},
                        {d->colours, d->vertex_count, 4, "colour channel", 0, 1},
                        {d->weights, d->vertex_count, INFLUENCES, "weight", 0, 1e9f}};
    for (size_t i = 0; i < sizeof all / sizeof *all && status == LMN_OK; i++)
        status = check_numbers(&all[i], caller, error);
    if (status == LMN_OK)
        status = check_weights(d, caller, error);
    if (status == LMN_OK && d->indices)
        status = check_indices(d->indices, d->index_count, 3, d->vertex_count, "triangle", caller, error);
    if (status == LMN_OK && d->lines)
        status = check_indices(d->lines, d->line_index_count, 2, d->vertex_count, "line", caller, error);
    if (status == LMN_OK && !d->indices && !d->lines && d->vertex_count % 3 != 0)
        status =
            error_set(error, LMN_USAGE, "%s: %zu vertices are no whole number of triangles", caller, d->vertex_count);
    if (status == LMN_OK && d->material > scene->material_count)
        status = error_set(error, LMN_USAGE, "%s: the scene has no material %u", caller, (unsigned)d->material);
    return status;
}

static bool normals_make(vec3 *out, const float *from, size_t count, size_t *bad)
{
    for (size_t i = 0; i < count; i++) {
        double x = (double)from[3 * i], y = (double)from[3 * i + 1], z = (double)from[3 * i + 2],
               length = sqrt(x * x + y * y + z * z);
        *bad = i;
        if (!(length > 0) || !isfinite(length))
            return false;
        out[i] = (vec3){(float)(x / length), (float)(y / length), (float)(z / length)};
    }
    return true;
}

lmn_status content_positions_make(vec3 **positions, vec3 **normals, const float *from_positions,
                                  const float *from_normals, size_t count, const char *caller, lmn_error *error)
{
    size_t  bad = 0;
    numbers n = {from_positions, count, 3, "coordinate", -1e18f, 1e18f};
    *positions = *normals = NULL;
    lmn_status status = check_numbers(&n, caller, error);
    if (status != LMN_OK)
        return status;
    *positions = mem_copy(from_positions, count * sizeof **positions);
    *normals = from_normals ? mem_alloc(count * sizeof **normals) : NULL;
    if (!*positions || (from_normals && !*normals))
        status = error_memory(error);
    else if (from_normals && !normals_make(*normals, from_normals, count, &bad))
        status = error_set(error, LMN_USAGE, "%s: the normal of vertex %zu has no direction", caller, bad);
    if (status != LMN_OK) {
        mem_free(*positions);
        mem_free(*normals);
        *positions = *normals = NULL;
    }
    return status;
}

static bool copy_indices(primitive *out, const lmn_mesh_desc *d)
{
    if (d->lines) {
        out->lines = mem_copy(d->lines, d->line_index_count * sizeof *d->lines);
        out->line_count = (uint32_t)(d->line_index_count / 2);
        return out->lines != NULL;
    }
    size_t count = d->indices ? d->index_count : d->vertex_count;
    out->index_count = (uint32_t)count;
    out->indices = d->indices ? mem_copy(d->indices, count * sizeof *d->indices) : mem_alloc(count * sizeof(uint32_t));
    for (size_t i = 0; out->indices && !d->indices && i < count; i++)
        out->indices[i] = (uint32_t)i;
    return out->indices != NULL;
}

static bool copy_colours(primitive *out, const lmn_mesh_desc *d)
{
    out->colours = mem_alloc(d->vertex_count * sizeof *out->colours);
    for (size_t i = 0; out->colours && i < d->vertex_count; i++) {
        const float *c = &d->colours[4 * i];
        out->colours[i] = (vec4){colour_to_linear(c[0]), colour_to_linear(c[1]), colour_to_linear(c[2]), c[3]};
    }
    return out->colours != NULL;
}

static bool copy_influences(primitive *out, const lmn_mesh_desc *d)
{
    size_t count = INFLUENCES * d->vertex_count;
    out->influences = INFLUENCES;
    out->joints = mem_copy(d->joints, count * sizeof *d->joints);
    out->weights = mem_copy(d->weights, count * sizeof *d->weights);
    for (size_t i = 0; out->weights && i < count; i += INFLUENCES) {
        float *w = &out->weights[i], sum = w[0] + w[1] + w[2] + w[3];
        for (int k = 0; k < INFLUENCES; k++)
            w[k] /= sum;
    }
    return out->joints && out->weights;
}

lmn_status content_mesh_make(primitive *out, const lmn_scene *scene, const lmn_mesh_desc *desc, const char *caller,
                             lmn_error *error)
{
    *out = (primitive){.material = desc->material ? (int32_t)desc->material - 1 : NONE};
    lmn_status status = check_mesh(scene, desc, caller, error);
    if (status == LMN_OK)
        status = content_positions_make(&out->positions, &out->normals, desc->positions, desc->normals,
                                        desc->vertex_count, caller, error);
    if (status != LMN_OK)
        return status;
    out->vertex_count = (uint32_t)desc->vertex_count;
    bool good = copy_indices(out, desc) && (!desc->colours || copy_colours(out, desc)) &&
                (!desc->joints || copy_influences(out, desc));
    if (good && desc->uvs) {
        out->uvs[0] = mem_copy(desc->uvs, desc->vertex_count * sizeof *out->uvs[0]);
        good = out->uvs[0] != NULL;
    }
    if (good)
        return LMN_OK;
    primitive_release(out);
    return error_memory(error);
}
