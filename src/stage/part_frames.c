/* Frames of parts: where a part is at rest, whatever its node does with it. What is tied to an object is computed
 * in its frame. Parts that always move together share one, so that what is drawn runs on from part to part. */
#include "stage/upload_private.h"

#include <math.h>

#include "base/memory.h"
#include "scene/solid.h"

enum { PARTS_A_ROW = 1024, TEXELS_A_PART = 5, POLAR_STEPS = 12 };

/* The inverse transpose of a 3×3 matrix (columns); false when it has none. */
static bool inverse_transpose(const double m[9], double out[9])
{
    const double *a = m, *b = m + 3, *c = m + 6;
    const double *columns[3][2] = {{b, c}, {c, a}, {a, b}};
    double        determinant = 0;
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

/* The rotation (or reflection) of a matrix: what is left without scale and shear. Newton's iteration for the polar
 * decomposition, on a matrix of unit size. */
static void rotation_of(const mat4 *world, double out[9])
{
    static const double identity[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1};
    double              size = 0;
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
    box3 box = n->solid != NONE ? solid_bounds(&scene->solids[n->solid]) : box3_empty();
    for (size_t i = 0; n->mesh != NONE && i < scene->meshes[n->mesh].primitive_count; i++)
        box = box3_union(box, scene->meshes[n->mesh].primitives[i].bounds);
    if (box3_is_empty(box))
        return (vec3){0, 0, 0};
    return (vec3){(box.min.x + box.max.x) / 2, (box.min.y + box.max.y) / 2, (box.min.z + box.max.z) / 2};
}

/* Whom a node moves with: the lowest node above all that has no animated node between. So a model that is turned as
 * a whole is followed, and so is whatever is animated. */
typedef struct mover {
    double turn[9]; /* columns; its rotation */
    box3   box;     /* of its parts' middles, in its axes and the scene's unit */
    bool   ready;
} mover;

static int32_t mover_of(const lmn_scene *scene, const bool *animated, int32_t index)
{
    while (!animated[index] && scene->nodes[index].parent != NONE)
        index = scene->nodes[index].parent;
    for (const node *n = &scene->nodes[index]; n->mesh == NONE && n->solid == NONE && n->first_child != NONE &&
                                               n->first_child == n->last_child && !animated[n->first_child];
         n = &scene->nodes[index])
        index = n->first_child;
    return index;
}

static void mark_animated(const lmn_scene *scene, bool *animated)
{
    for (size_t i = 0; i < scene->animation_count; i++)
        for (size_t k = 0; k < scene->animations[i].channel_count; k++)
            if (animation_thing_of(scene->animations[i].channels[k].path) == ANIMATED_NODE)
                animated[scene->animations[i].channels[k].target] = true;
}

/* A part's middle in its mover's axes, which stays where it is when the mover moves and turns. */
static vec3 middle_in(const pose *p, const lmn_scene *scene, const mover *m, int32_t mover_index, size_t part_index)
{
    const mat4  *own = &p->worlds[mover_index], *world = &p->worlds[scene->parts[part_index].node];
    vec3         local = middle_of(scene, &scene->nodes[scene->parts[part_index].node]);
    const double middle[3] = {(double)local.x, (double)local.y, (double)local.z};
    double       offset[3], out[3];
    for (int k = 0; k < 3; k++) {
        offset[k] = world->m[12 + k] - own->m[12 + k];
        for (int c = 0; c < 3; c++)
            offset[k] += world->m[4 * c + k] * middle[c];
    }
    for (int row = 0; row < 3; row++)
        out[row] = m->turn[3 * row] * offset[0] + m->turn[3 * row + 1] * offset[1] + m->turn[3 * row + 2] * offset[2];
    return (vec3){(float)out[0], (float)out[1], (float)out[2]};
}

/* The part's own first axis that is not upright, level, in the world's axes: how a house is turned. */
static void level_axis(const mat4 *world, int up, double out[3])
{
    double most = -1;
    for (int axis = 0; axis < 3; axis++) {
        double level[3], length = 0, whole = 0;
        for (int k = 0; k < 3; k++) {
            level[k] = k == up ? 0 : world->m[4 * axis + k];
            length += level[k] * level[k];
            whole += world->m[4 * axis + k] * world->m[4 * axis + k];
        }
        double fraction = whole > 0 ? sqrt(length / whole) : 0;
        if (fraction <= most + 0.01) /* of axes that are alike the first one */
            continue;
        most = fraction;
        for (int k = 0; k < 3; k++)
            out[k] = length > 0 ? level[k] / sqrt(length) : k == (up == 0 ? 1 : 0);
    }
}

/* Three rows that take a position in the world, measured from `origin`, into the mover's frame, the mover's number,
 * and which way is up in it. */
static void write_frame(const pose *p, const mover *m, int32_t mover_index, bool up_is_y, const double origin[3],
                        float *rows)
{
    const float middle[3] = {(m->box.min.x + m->box.max.x) / 2, (m->box.min.y + m->box.max.y) / 2,
                             (m->box.min.z + m->box.max.z) / 2};
    for (int row = 0; row < 3; row++) {
        double moved = -(double)middle[row];
        for (int k = 0; k < 3; k++) {
            rows[4 * row + k] = (float)m->turn[3 * row + k];
            moved += m->turn[3 * row + k] * (origin[k] - p->worlds[mover_index].m[12 + k]);
        }
        rows[4 * row + 3] = (float)moved;
    }
    rows[12] = (float)mover_index;
    for (int row = 0; row < 3; row++)
        rows[13 + row] = (float)m->turn[3 * row + (up_is_y ? 1 : 2)];
}

static void write_frames(const upload *u, const pose *p, mover *movers, const bool *animated, float *values)
{
    const lmn_scene *scene = p->scene;
    for (size_t i = 0; i < u->part_count; i++) {
        int32_t index = mover_of(scene, animated, scene->parts[i].node);
        mover  *m = &movers[index];
        if (!m->ready) {
            rotation_of(&p->worlds[index], m->turn);
            m->box = box3_empty();
            m->ready = true;
        }
        vec3 middle = middle_in(p, scene, m, index, i);
        m->box = box3_union(m->box, (box3){middle, middle});
    }
    for (size_t i = 0; i < u->part_count; i++) {
        int32_t index = mover_of(scene, animated, scene->parts[i].node);
        float  *rows = &values[4 * TEXELS_A_PART * i];
        write_frame(p, &movers[index], index, scene->up == 'y', u->frame_origin, rows);
        double level[3] = {0, 0, 0};
        level_axis(&p->worlds[scene->parts[i].node], scene->up == 'y' ? 1 : 2, level);
        for (int row = 0; row < 3; row++) {
            const double *turn = &movers[index].turn[3 * row];
            rows[16 + row] = (float)(turn[0] * level[0] + turn[1] * level[1] + turn[2] * level[2]);
        }
    }
}

/* Behind all parts, for the ground they stand on: the world's own frame. */
static void write_ground(const upload *u, bool up_is_y, float *values)
{
    float *rows = &values[4 * TEXELS_A_PART * u->part_count];
    for (int k = 0; k < 3; k++)
        rows[4 * k + k] = 1;
    rows[13 + (up_is_y ? 1 : 2)] = 1;
    rows[16] = 1;
}

static void set_origin(upload *u)
{
    box3 box = box3_empty();
    for (size_t i = 0; i < u->part_count; i++)
        box = box3_union(box, u->pose->part_boxes[i]);
    if (!box3_is_empty(box))
        box3_middle(box, u->frame_origin);
}

/* The rows of all parts in a pose, filled up to whole rows of a texture; NULL when memory is gone. */
static float *frames_of(upload *u, const pose *p)
{
    const lmn_scene *scene = p->scene;
    size_t           rows = u->part_count / PARTS_A_ROW + 1;
    float           *values = mem_calloc(rows * TEXELS_A_PART * PARTS_A_ROW, 4 * sizeof *values);
    mover           *movers = mem_calloc(scene->node_count, sizeof *movers);
    bool            *animated = mem_calloc(scene->node_count, sizeof *animated);
    bool             done = values && movers && animated;
    set_origin(u);
    if (done) {
        mark_animated(scene, animated);
        write_frames(u, p, movers, animated, values);
        write_ground(u, scene->up == 'y', values);
    } else {
        mem_free(values);
    }
    mem_free(movers);
    mem_free(animated);
    return done ? values : NULL;
}

gpu_texture *upload_part_frames(upload *u, gpu *g)
{
    if (u->part_frames || gpu_failed(g))
        return u->part_frames;
    int rows = (int)(u->part_count / PARTS_A_ROW) + 1, width = TEXELS_A_PART * PARTS_A_ROW;
    mem_free(u->part_frame_values);
    u->part_frame_values = frames_of(u, u->pose);
    if (u->part_frame_values) {
        u->part_frames = gpu_target_acquire(g, width, rows, GPU_RGBA32F);
        gpu_target_write(g, u->part_frames, (int[]){0, 0, width, rows}, u->part_frame_values);
    } else {
        gpu_fail(g, LMN_MEMORY, "out of memory");
    }
    return u->part_frames;
}

vec3 *upload_rest_positions(upload *u, size_t part_index, const vec3 *at_rest, uint32_t count)
{
    if (!u->rest_frame_values && !(u->rest_frame_values = frames_of(u, u->pose->at_rest)))
        return NULL;
    const float *rows = &u->rest_frame_values[PART_FRAME_FLOATS * part_index];
    mat4         world = pose_instance(u->pose->at_rest, part_index, 0);
    vec3        *out = mem_alloc(count * sizeof *out);
    for (uint32_t i = 0; out && i < count; i++) {
        vec3   p = at_rest[i];
        double from[3], to[3];
        for (int k = 0; k < 3; k++)
            from[k] = world.m[k] * (double)p.x + world.m[4 + k] * (double)p.y + world.m[8 + k] * (double)p.z +
                      world.m[12 + k] - u->frame_origin[k];
        for (int k = 0; k < 3; k++)
            to[k] = (double)rows[4 * k] * from[0] + (double)rows[4 * k + 1] * from[1] +
                    (double)rows[4 * k + 2] * from[2] + (double)rows[4 * k + 3];
        out[i] = (vec3){(float)to[0], (float)to[1], (float)to[2]};
    }
    return out;
}
