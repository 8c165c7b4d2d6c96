/* Meshes with the way their surfaces bend, and covered with patches: what strokes are laid along where a model has
 * no texture coordinates. */
#include "stage/upload_private.h"

#include <math.h>
#include <string.h>

#include "base/memory.h"
#include "field/lapped.h"

enum { PATCH_SEED = 1 };

float upload_patch_radius(const upload *u, box3 b)
{
    float x = b.max.x - b.min.x, y = b.max.y - b.min.y, z = b.max.z - b.min.z;
    return u->needs.patch * sqrtf(x * x + y * y + z * z);
}

/* As fields and patches are made of: of vertices as they are drawn, or where they are at rest. It borrows. */
static primitive primitive_of(const upload_vertices *v)
{
    const vertex_arrays *data = v->now;
    primitive            p = {.vertex_count = data->vertex_count,
                              .index_count = data->index_count,
                              .positions = v->at_rest ? (vec3 *)(uintptr_t)v->at_rest : (vec3 *)(uintptr_t)data->positions,
                              .indices = (uint32_t *)(uintptr_t)data->indices,
                              .bounds = box3_empty()};
    for (uint32_t i = 0; i < p.vertex_count; i++)
        p.bounds = box3_union(p.bounds, (box3){p.positions[i], p.positions[i]});
    return p;
}

/* One tensor a vertex: that of a corner. */
static float (*tensors_of(const direction_field *field, const primitive *p))[6]
{
    float(*out)[6] = mem_calloc(p->vertex_count, sizeof *out);
    for (uint32_t i = 0; out && i < p->index_count; i++)
        memcpy(out[p->indices[i]], direction_field_at(field, p, i), sizeof *out);
    return out;
}

typedef struct map3 {
    double m[9]; /* columns */
} map3;

static void cross_of(const double a[3], const double b[3], double out[3])
{
    for (int k = 0; k < 3; k++)
        out[k] = a[(k + 1) % 3] * b[(k + 2) % 3] - a[(k + 2) % 3] * b[(k + 1) % 3];
}

/* Two edges of a triangle and its unit normal; returns its doubled area. */
static double frame_of(const vec3 *positions, const uint32_t *corners, double out[9])
{
    for (int e = 0; e < 2; e++) {
        vec3 a = positions[corners[0]], b = positions[corners[e + 1]];
        out[3 * e] = (double)b.x - (double)a.x;
        out[3 * e + 1] = (double)b.y - (double)a.y;
        out[3 * e + 2] = (double)b.z - (double)a.z;
    }
    cross_of(out, out + 3, out + 6);
    double area = sqrt(out[6] * out[6] + out[7] * out[7] + out[8] * out[8]);
    for (int k = 6; k < 9; k++)
        out[k] /= area > 0 ? area : 1;
    return area;
}

/* What takes a triangle's directions at rest to those it has now; false when it has no area. */
static bool map_of(const vec3 *from, const vec3 *to, const uint32_t *corners, map3 *out, double *area)
{
    double a[9], b[9], dual[9];
    *area = frame_of(from, corners, a);
    if (!(*area > 0) || !(frame_of(to, corners, b) > 0))
        return false;
    cross_of(a + 3, a + 6, dual);
    cross_of(a + 6, a, dual + 3);
    cross_of(a, a + 3, dual + 6);
    for (int column = 0; column < 3; column++)
        for (int row = 0; row < 3; row++) {
            out->m[3 * column + row] = 0;
            for (int k = 0; k < 3; k++)
                out->m[3 * column + row] += b[3 * k + row] * dual[3 * k + column] / *area;
        }
    return true;
}

/* M T Mᵀ, as large as T was. */
static void carry_tensor(const map3 *m, float t[6])
{
    static const int at[3][3] = {{0, 3, 5}, {3, 1, 4}, {5, 4, 2}};
    double           half[3][3], full[3][3], before = 0, after = 0;
    for (int r = 0; r < 3; r++)
        for (int c = 0; c < 3; c++) {
            half[r][c] = 0;
            for (int k = 0; k < 3; k++)
                half[r][c] += m->m[3 * k + r] * (double)t[at[k][c]];
        }
    for (int r = 0; r < 3; r++)
        for (int c = 0; c < 3; c++) {
            full[r][c] = 0;
            for (int k = 0; k < 3; k++)
                full[r][c] += half[r][k] * m->m[3 * k + c];
            before += (double)t[at[r][c]] * (double)t[at[r][c]];
            after += full[r][c] * full[r][c];
        }
    double scale = after > 0 ? sqrt(before / after) : 0;
    for (int r = 0; r < 3; r++)
        for (int c = r; c < 3; c++)
            t[at[r][c]] = (float)(full[r][c] * scale);
}

/* Moves tensors along with the surface they belong to: by the mean of what its triangles around a vertex undergo. */
static bool carry_tensors(float (*tensors)[6], const primitive *rest, const vertex_arrays *now)
{
    map3 *sums = mem_calloc(rest->vertex_count, sizeof *sums);
    for (uint32_t i = 0; sums && i + 2 < rest->index_count; i += 3) {
        map3   m;
        double area;
        if (!map_of(rest->positions, (const vec3 *)(const void *)now->positions, &rest->indices[i], &m, &area))
            continue;
        for (int c = 0; c < 3; c++)
            for (int k = 0; k < 9; k++)
                sums[rest->indices[i + (uint32_t)c]].m[k] += area * m.m[k];
    }
    for (uint32_t v = 0; sums && v < rest->vertex_count; v++)
        carry_tensor(&sums[v], tensors[v]);
    bool done = sums;
    mem_free(sums);
    return done;
}

static lmn_status upload_lapped_mesh(gpu *g, gpu_mesh **out, const lapped_mesh *l, const vertex_arrays *data,
                                     lmn_error *error)
{
    float *positions = posed_gather(data->positions, l->source, l->vertex_count, 3 * sizeof(float)),
          *normals = posed_gather(data->normals, l->source, l->vertex_count, 3 * sizeof(float));
    float *colours = posed_gather(data->colours, l->source, l->vertex_count, 4 * sizeof(float)), *uvs[2];
    for (int i = 0; i < 2; i++)
        uvs[i] = posed_gather(data->uvs[i], l->source, l->vertex_count, 2 * sizeof(float));
    bool done =
        positions && normals && (colours || !data->colours) && (uvs[0] || !data->uvs[0]) && (uvs[1] || !data->uvs[1]);
    if (done)
        *out = gpu_mesh_create(g, &(gpu_mesh_data){.vertex_count = l->vertex_count,
                                                   .index_count = l->index_count,
                                                   .positions = positions,
                                                   .normals = normals,
                                                   .colours = colours,
                                                   .uvs = {uvs[0], uvs[1]},
                                                   .patches = (const float *)l->positions,
                                                   .indices = l->indices});
    mem_free(positions);
    mem_free(normals);
    mem_free(colours);
    mem_free(uvs[0]);
    mem_free(uvs[1]);
    return done ? LMN_OK : error_memory(error);
}

lmn_status upload_with_field(const upload *u, gpu *g, const upload_part_job *job, size_t primitive_index,
                             const upload_vertices *v, lmn_error *error)
{
    primitive       p = primitive_of(v);
    direction_field field = {0};
    lapped_mesh     patches = {0};
    lmn_status      status = direction_field_make(&field, &p, u->crease_angle > 0 ? u->crease_angle : 0.5, 0, 0, error);
    float(*tensors)[6] = status == LMN_OK ? tensors_of(&field, &p) : NULL;
    if (status == LMN_OK && (!tensors || (v->at_rest && !carry_tensors(tensors, &p, v->now))))
        status = error_memory(error);
    if (status == LMN_OK) {
        gpu_mesh_data with = upload_data_over_time(v);
        with.tensors = (const float *)tensors;
        status = upload_glue(u, &with, error);
        if (status == LMN_OK)
            job->meshes[primitive_index] = upload_mesh_make(g, job, primitive_index, &with);
        mem_free((void *)(uintptr_t)with.glue);
    }
    if (status == LMN_OK && u->needs.patch > 0) {
        status = lapped_make(&patches, &p, &field, (double)upload_patch_radius(u, p.bounds), PATCH_SEED, error);
        if (status == LMN_OK)
            status = upload_lapped_mesh(g, &job->lapped[primitive_index], &patches, v->now, error);
    }
    mem_free(tensors);
    lapped_release(&patches);
    direction_field_release(&field);
    return status;
}
