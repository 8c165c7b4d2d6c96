/* Frames of parts: where a part is at rest, whatever its node does with it. What is tied to an object is computed in its frame. */
#include "draw/upload.h"

#include <math.h>

#include "base/memory.h"

enum { PARTS_A_ROW = 1024, TEXELS_A_PART = 3, POLAR_STEPS = 12 };

/* The inverse transpose of a 3×3 matrix (columns); false when it has none. */
static bool inverse_transpose(const double m[9], double out[9])
{
    const double *a = m, *b = m + 3, *c = m + 6;
    const double *columns[3][2] = {{b, c}, {c, a}, {a, b}};
    double determinant = 0;
    for (int i = 0; i < 3; i++) {
        const double *p = columns[i][0], *q = columns[i][1];
        for (int k = 0; k < 3; k++)
            out[3 * i + k] = p[(k + 1) % 3] * q[(k + 2) % 3] - p[(k + 2) % 3] * q[(k + 1) % 3];
    }
    for (int k = 0; k < 3; k++)
        determinant += a[k] * out[k];
    if (!(fabs(determinant) > 1e-300))
        return false;
    for (int i = 0; i < 9; i++)
        out[i] /= determinant;
    return true;
}

/* The rotation (or reflection) of a matrix: what is left without scale and shear. Newton's iteration for the polar decomposition,
 * on a matrix of unit size. */
static void rotation_of(const mat4 *world, double out[9])
{
    static const double identity[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1};
    double size = 0;
    for (int column = 0; column < 3; column++)
        for (int row = 0; row < 3; row++) {
            out[3 * column + row] = world->m[4 * column + row];
            size = fmax(size, fabs(out[3 * column + row]));
        }
    bool good = size > 0 && isfinite(size);
    for (int i = 0; good && i < 9; i++)
        out[i] /= size;
    for (int step = 0; good && step < POLAR_STEPS; step++) {
        double other[9];
        good = inverse_transpose(out, other);
        for (int i = 0; good && i < 9; i++)
            out[i] = (out[i] + other[i]) / 2;
    }
    for (int i = 0; !good && i < 9; i++)
        out[i] = identity[i];
}

/* The middle of a part's mesh in its own axes. */
static vec3 middle_of(const lmn_scene *scene, const node *n)
{
    const mesh *m = &scene->meshes[n->mesh];
    box3 box = box3_empty();
    for (size_t i = 0; i < m->primitive_count; i++)
        box = box3_union(box, m->primitives[i].bounds);
    if (box3_is_empty(box))
        return (vec3){0, 0, 0};
    return (vec3){(box.min.x + box.max.x) / 2, (box.min.y + box.max.y) / 2, (box.min.z + box.max.z) / 2};
}

/* Three rows that take a place in the world, measured from `origin`, into the part's frame. */
static void write_frame(const upload *u, const lmn_scene *scene, size_t part_index, const double origin[3], float *rows)
{
    const node *n = &scene->nodes[scene->parts[part_index].node];
    const mat4 *world = &u->worlds[scene->parts[part_index].node];
    vec3 local = middle_of(scene, n);
    const double middle[3] = {(double)local.x, (double)local.y, (double)local.z};
    double turn[9];
    rotation_of(world, turn);
    for (int row = 0; row < 3; row++) {
        double moved = 0;
        for (int k = 0; k < 3; k++) {
            double centre = world->m[12 + k];
            for (int c = 0; c < 3; c++)
                centre += world->m[4 * c + k] * middle[c];
            rows[4 * row + k] = (float)turn[3 * row + k];
            moved += turn[3 * row + k] * (origin[k] - centre);
        }
        rows[4 * row + 3] = (float)moved;
    }
}

gpu_texture *upload_part_frames(upload *u, gpu *g, const lmn_scene *scene)
{
    if (u->part_frames || gpu_failed(g))
        return u->part_frames;
    int rows = (int)((scene->part_count + PARTS_A_ROW - 1) / PARTS_A_ROW), width = TEXELS_A_PART * PARTS_A_ROW;
    float *values = mem_calloc((size_t)rows * (size_t)width, 4 * sizeof *values);
    if (!values) {
        gpu_fail(g, LMN_MEMORY, "out of memory");
        return NULL;
    }
    box3 box = box3_empty();
    for (size_t i = 0; i < scene->part_count; i++)
        box = box3_union(box, u->part_boxes[i]);
    if (!box3_is_empty(box)) {
        u->frame_origin[0] = ((double)box.min.x + (double)box.max.x) / 2;
        u->frame_origin[1] = ((double)box.min.y + (double)box.max.y) / 2;
        u->frame_origin[2] = ((double)box.min.z + (double)box.max.z) / 2;
    }
    for (size_t i = 0; i < scene->part_count; i++)
        write_frame(u, scene, i, u->frame_origin, &values[4 * TEXELS_A_PART * i]);
    u->part_frames = gpu_target_acquire(g, width, rows, GPU_RGBA32F);
    gpu_target_write(g, u->part_frames, (int[]){0, 0, width, rows}, values);
    mem_free(values);
    return u->part_frames;
}
