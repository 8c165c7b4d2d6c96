/* From where scenes show most whose best sides are known. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "limner/limner.h"

/* A box as a part of its own; sides that are not wanted are left out: bits −x, +x, −y, +y, −z, +z. */
static void add_box(lmn_scene *scene, const char *name, const float low[3], const float high[3], unsigned without)
{
    float         positions[24];
    uint32_t      indices[36], count = 0, mesh = 0;
    lmn_error     error = {0};
    lmn_mesh_desc desc = LMN_MESH_DESC_INIT;
    lmn_node_desc node = LMN_NODE_DESC_INIT;
    for (int i = 0; i < 8; i++)
        for (int k = 0; k < 3; k++)
            positions[3 * i + k] = i >> k & 1 ? high[k] : low[k];
    for (uint32_t axis = 0; axis < 3; axis++)
        for (uint32_t side = 0; side < 2; side++) {
            const uint32_t a = 1U << (axis + 1) % 3, b = 1U << (axis + 2) % 3, at = side << axis;
            const uint32_t corners[] = {at, at + a, at + a + b, at, at + a + b, at + b};
            for (uint32_t k = 0; k < 6 && !(without >> (2 * axis + side) & 1); k++)
                indices[count++] = corners[side ? k : 5 - k];
        }
    desc.positions = positions;
    desc.vertex_count = 8;
    desc.indices = indices;
    desc.index_count = count;
    node.name = name;
    assert_int_equal(lmn_scene_add_mesh(scene, &desc, &mesh, &error), LMN_OK);
    node.mesh = mesh;
    assert_int_equal(lmn_scene_add_node(scene, &node, NULL, &error), LMN_OK);
}

/* Towards the eye, unit. */
static void best_of(const lmn_scene *scene, const char *select, double out[3])
{
    lmn_error     error = {0};
    lmn_draw_desc desc = LMN_DRAW_DESC_INIT;
    double        length = 0;
    desc.select = select;
    assert_int_equal(lmn_scene_best_view(scene, &desc, &error), LMN_OK);
    assert_true(desc.eye_given && desc.fit_direction);
    for (int k = 0; k < 3; k++) {
        out[k] = desc.eye[k] - desc.target[k];
        length += out[k] * out[k];
    }
    for (int k = 0; k < 3; k++)
        out[k] /= sqrt(length);
}

static lmn_scene *new_scene(void)
{
    lmn_scene *scene = NULL;
    lmn_error  error = {0};
    assert_int_equal(lmn_scene_create(&scene, &error), LMN_OK);
    return scene;
}

static const float LOW[3] = {-1, -1, -1}, HIGH[3] = {1, 1, 1};

static void test_boxes_show_three_sides(void **state)
{
    (void)state;
    lmn_scene *scene = new_scene();
    double     to_eye[3];
    add_box(scene, "box", LOW, HIGH, 0);
    best_of(scene, NULL, to_eye);
    for (int k = 0; k < 3; k++)
        assert_true(fabs(to_eye[k]) > 0.2);
    assert_true(to_eye[1] > 0 && to_eye[2] > 0); /* from above, and of equal sides the front */
    lmn_scene_destroy(&scene);
}

/* What is in a box that is open at one side is seen from there, whichever it is. */
static void test_open_sides_are_looked_into(void **state)
{
    (void)state;
    static const float low[3] = {-0.8F, -0.9F, -0.8F}, high[3] = {0.8F, 0.5F, 0.8F};
    for (unsigned side = 0; side < 6; side++) {
        if (side / 2 == 1)
            continue; /* from below nobody looks */
        lmn_scene *scene = new_scene();
        double     to_eye[3];
        add_box(scene, "box", LOW, HIGH, 1U << side);
        for (int i = 0; i < 4; i++) {
            float from[3], to[3];
            for (int k = 0; k < 3; k++) {
                from[k] = k == 0 ? low[k] + 0.4F * (float)i : low[k];
                to[k] = k == 0 ? from[k] + 0.25F : high[k];
            }
            add_box(scene, "inside", from, to, 0);
        }
        best_of(scene, NULL, to_eye);
        if (!(to_eye[side / 2] * (side % 2 ? 1 : -1) > 0.4))
            fail_msg("open at side %u, seen from %g, %g, %g", side, to_eye[0], to_eye[1], to_eye[2]);
        lmn_scene_destroy(&scene);
    }
}

/* A plate is not seen edge on, and what is not selected does not count. */
static void test_plates_are_seen_from_their_faces(void **state)
{
    (void)state;
    static const float thin_low[2][3] = {{-1, -1, -0.01F}, {-0.01F, -1, -1}},
                       thin_high[2][3] = {{1, 1, 0.01F}, {0.01F, 1, 1}};
    lmn_scene *scene = new_scene();
    double     to_eye[3];
    add_box(scene, "along x", thin_low[0], thin_high[0], 0);
    add_box(scene, "along z", thin_low[1], thin_high[1], 0);
    best_of(scene, "'along x'", to_eye);
    assert_true(fabs(to_eye[2]) > 0.6);
    best_of(scene, "'along z'", to_eye);
    assert_true(fabs(to_eye[0]) > 0.6);
    lmn_scene_destroy(&scene);
}

/* Where Z is up, the eye is above along it, and front is −Y. */
static void test_up_is_the_scenes(void **state)
{
    (void)state;
    lmn_scene *scene = new_scene();
    lmn_error  error = {0};
    double     to_eye[3];
    assert_int_equal(lmn_scene_set_up(scene, LMN_UP_Z, &error), LMN_OK);
    add_box(scene, "box", LOW, HIGH, 0);
    best_of(scene, NULL, to_eye);
    assert_true(to_eye[2] > 0.2 && to_eye[1] < -0.2);
    lmn_scene_destroy(&scene);
}

static void test_mistakes_are_told(void **state)
{
    (void)state;
    lmn_scene    *scene = new_scene();
    lmn_error     error = {0};
    lmn_draw_desc desc = LMN_DRAW_DESC_INIT;
    assert_int_equal(lmn_scene_best_view(scene, &desc, &error), LMN_OK); /* nothing is there: any view does */
    desc.select = "[";
    assert_int_equal(lmn_scene_best_view(scene, &desc, &error), LMN_USAGE);
    assert_int_equal(lmn_scene_best_view(scene, NULL, &error), LMN_USAGE);
    assert_int_equal(lmn_scene_best_view(NULL, &desc, &error), LMN_USAGE);
    lmn_scene_destroy(&scene);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_boxes_show_three_sides),
        cmocka_unit_test(test_open_sides_are_looked_into),
        cmocka_unit_test(test_plates_are_seen_from_their_faces),
        cmocka_unit_test(test_up_is_the_scenes),
        cmocka_unit_test(test_mistakes_are_told),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
