/* Scenes and cameras for tests of strokes. */
#ifndef TESTS_STROKE_SHAPES_H
#define TESTS_STROKE_SHAPES_H

#include "import_support.h"

#include <math.h>

#include "stroke/stroke.h"

static const double stroke_pi = 3.14159265358979323846;

/* 0 … 1, the same for the same number. */
static inline double stroke_random(uint32_t n)
{
    n = (n ^ n >> 16) * 0x7FEB352Du;
    n = (n ^ n >> 15) * 0x846CA68Bu;
    return (n ^ n >> 16) / 4294967296.0;
}

/* Adds a part of triangles. */
static inline void add_part(lmn_scene *s, const vec3 *positions, uint32_t position_count, const uint32_t *corners,
                            uint32_t corner_count)
{
    primitive p = {.vertex_count = position_count, .index_count = corner_count, .material = NONE};
    p.positions = mem_copy(positions, position_count * sizeof *positions);
    p.indices = mem_copy(corners, corner_count * sizeof *corners);
    mesh *m = scene_append_mesh(s);
    assert_non_null(m);
    assert_true(mesh_set_primitives(m, &p, 1));
    node *n = scene_append_node(s);
    n->mesh = (int32_t)s->mesh_count - 1;
}

static inline void add_box(lmn_scene *s, double x0, double y0, double z0, double x1, double y1, double z1)
{
    vec3 positions[8];
    for (int k = 0; k < 8; k++)
        positions[k] = (vec3){(float)(k & 1 ? x1 : x0), (float)(k & 2 ? y1 : y0), (float)(k & 4 ? z1 : z0)};
    const uint32_t corners[36] = {0, 2, 3, 0, 3, 1, 4, 5, 7, 4, 7, 6, 0, 1, 5, 0, 5, 4,
                                  2, 6, 7, 2, 7, 3, 0, 4, 6, 0, 6, 2, 1, 3, 7, 1, 7, 5};
    add_part(s, positions, 8, corners, 36);
}

/* An open plate at a height, its face up. */
static inline void add_plate(lmn_scene *s, double x0, double y0, double x1, double y1, double z)
{
    vec3           positions[4] = {{(float)x0, (float)y0, (float)z},
                                   {(float)x1, (float)y0, (float)z},
                                   {(float)x1, (float)y1, (float)z},
                                   {(float)x0, (float)y1, (float)z}};
    const uint32_t corners[6] = {0, 1, 2, 0, 2, 3};
    add_part(s, positions, 4, corners, 6);
}

/* A ball of rings and columns; poles are fans. */
static inline void add_ball(lmn_scene *s, double x, double y, double z, double radius, uint32_t columns, uint32_t rings)
{
    uint32_t  count = columns * (rings - 1) + 2, k = 0;
    vec3     *positions = mem_alloc(count * sizeof *positions);
    uint32_t *corners = mem_alloc((size_t)columns * (rings - 1) * 6 * sizeof *corners);
    positions[0] = (vec3){(float)x, (float)y, (float)(z - radius)};
    positions[count - 1] = (vec3){(float)x, (float)y, (float)(z + radius)};
    for (uint32_t r = 1; r < rings; r++)
        for (uint32_t c = 0; c < columns; c++) {
            double polar = stroke_pi * r / rings - stroke_pi / 2, turn = 2 * stroke_pi * c / columns;
            positions[1 + (r - 1) * columns + c] =
                (vec3){(float)(x + radius * cos(polar) * cos(turn)), (float)(y + radius * cos(polar) * sin(turn)),
                       (float)(z + radius * sin(polar))};
        }
    for (uint32_t c = 0; c < columns; c++) {
        uint32_t       d = (c + 1) % columns, top = 1 + (rings - 2) * columns;
        const uint32_t ends[6] = {0, 1 + d, 1 + c, count - 1, top + c, top + d};
        memcpy(corners + k, ends, sizeof ends);
        k += 6;
        for (uint32_t r = 0; r + 2 < rings; r++) {
            uint32_t       a = 1 + r * columns;
            const uint32_t quad[6] = {a + c, a + d, a + columns + d, a + c, a + columns + d, a + columns + c};
            memcpy(corners + k, quad, sizeof quad);
            k += 6;
        }
    }
    add_part(s, positions, count, corners, k);
    mem_free(positions);
    mem_free(corners);
}

static inline lmn_scene *stroke_scene_begin(void)
{
    lmn_scene *s = scene_new();
    assert_non_null(s);
    s->up = 'z';
    return s;
}

/* A camera that looks along a direction at a point; half of what it sees upwards in parallel projection, tangent of
 * half the angle otherwise. */
static inline stroke_camera look_along(double x, double y, double z, const double at[3], double distance, double half,
                                       bool orthographic, int width, int height)
{
    double length = sqrt(x * x + y * y + z * z), back[3] = {-x / length, -y / length, -z / length};
    double up[3] = {0, fabs(back[2]) > 0.99 ? 1 : 0, fabs(back[2]) > 0.99 ? 0 : 1};
    double right[3] = {up[1] * back[2] - up[2] * back[1], up[2] * back[0] - up[0] * back[2],
                       up[0] * back[1] - up[1] * back[0]};
    double r = sqrt(right[0] * right[0] + right[1] * right[1] + right[2] * right[2]);
    for (int k = 0; k < 3; k++)
        right[k] /= r;
    double        over[3] = {back[1] * right[2] - back[2] * right[1], back[2] * right[0] - back[0] * right[2],
                             back[0] * right[1] - back[1] * right[0]};
    const double *rows[3] = {right, over, back};
    stroke_camera c = {.view = mat4_identity(),
                       .near = distance * 0.01,
                       .orthographic = orthographic,
                       .width = width,
                       .height = height};
    for (int i = 0; i < 3; i++) {
        double moved = 0;
        for (int k = 0; k < 3; k++) {
            c.view.m[4 * k + i] = rows[i][k];
            moved += rows[i][k] * (at[k] + distance * back[k]);
        }
        c.view.m[12 + i] = -moved;
    }
    memset(&c.projection, 0, sizeof c.projection);
    double aspect = (double)width / height, near = c.near, far = distance * 10;
    c.projection.m[0] = 1 / (half * aspect);
    c.projection.m[5] = 1 / half;
    if (orthographic) {
        c.projection.m[10] = -2 / (far - near);
        c.projection.m[14] = -(far + near) / (far - near);
        c.projection.m[15] = 1;
    } else {
        c.projection.m[10] = -(far + near) / (far - near);
        c.projection.m[11] = -1;
        c.projection.m[14] = -2 * far * near / (far - near);
    }
    return c;
}

/* A scene, what a camera sees of it, and its strokes. */
typedef struct stroke_shot {
    lmn_scene    *source;
    stroke_scene *scene;
    stroke_view  *view;
    stroke_set    set;
    stroke_check  check; /* of the set */
} stroke_shot;

/* Finds the strokes of a scene, which is freed with the shot, and holds them against rays. */
static inline stroke_shot shoot(lmn_scene *s, stroke_camera camera, stroke_options options)
{
    stroke_shot out = {.source = s};
    lmn_error   error = {0};
    if (!s->part_count)
        assert_int_equal(scene_finish(s, "test", &error), LMN_OK);
    pose at_rest;
    out.scene = mem_alloc(sizeof *out.scene);
    assert_int_equal(pose_create(&at_rest, s, &(moment){.seconds = 0}, &error), LMN_OK);
    assert_int_equal(stroke_scene_create(out.scene, &at_rest, NULL, 30 * stroke_pi / 180, NULL, NULL, &error), LMN_OK);
    pose_release(&at_rest);
    assert_int_equal(stroke_view_create(&out.view, out.scene, &camera, NULL, NULL, &error), LMN_OK);
    assert_int_equal(stroke_find(&out.set, out.view, &options, NULL, NULL, NULL, &error), LMN_OK);
    assert_int_equal(stroke_verify(&out.check, &out.set, out.view, 1, NULL, NULL, &error), LMN_OK);
    return out;
}

static inline void shot_release(stroke_shot *s)
{
    stroke_set_release(&s->set);
    stroke_view_destroy(&s->view);
    stroke_scene_release(s->scene);
    mem_free(s->scene);
    scene_free(s->source);
}

/* Strokes of a class (STROKE_CLASS_COUNT: any) with this many surfaces in front (−1: any number, −2: hidden); their
 * length in pixels. */
static inline size_t count_strokes(const stroke_set *set, int kind, int hidden_by, double *length)
{
    size_t count = 0;
    double sum = 0;
    for (size_t i = 0; i < set->stroke_count; i++) {
        const stroke *s = &set->strokes[i];
        bool fits = hidden_by == -1 || (hidden_by == -2 ? s->hidden_by > 0 : s->hidden_by == (uint32_t)hidden_by);
        if (!fits || (kind != STROKE_CLASS_COUNT && (int)s->kind != kind))
            continue;
        count++;
        for (uint32_t k = 1; k < s->count; k++) {
            const stroke_point *p = &set->points[s->first + k];
            sum += hypot((double)p->x - p[-1].x, (double)p->y - p[-1].y);
        }
    }
    if (length)
        *length = sum;
    return count;
}

#endif
