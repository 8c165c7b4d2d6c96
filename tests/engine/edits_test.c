/* What an edit makes anew on the GPU, and what stays there. Row K09. */
#include "checked.h"

#include <string.h>

#include "draw/drawing.h"

typedef struct fixture {
    lmn_scene    *scene;
    lmn_renderer *renderer;
    lmn_look     *look;
    uint32_t      solids[2], shapes[2];
} fixture;

static int set_up(void **state)
{
    static fixture    f;
    lmn_renderer_desc desc = LMN_RENDERER_DESC_INIT;
    f = (fixture){.scene = NULL};
    DO(lmn_renderer_create(&f.renderer, &desc, &error));
    DO(lmn_look_load(&f.look, "edges", &error));
    DO(lmn_scene_create(&f.scene, &error));
    DO(lmn_scene_add_file(f.scene, TEST_DATA "/two-parts.gltf", NULL, &error));
    for (int i = 0; i < 2; i++) {
        lmn_shape box = lmn_shape_box(2, 2, 2), ball = lmn_shape_sphere(1);
        DO(lmn_scene_add_solid(f.scene, "solid", LMN_DIFFERENCE, &f.solids[i], &error));
        DO(lmn_solid_add_shape(f.scene, f.solids[i], LMN_SOLID_ROOT, &box, NULL, &error));
        DO(lmn_solid_add_shape(f.scene, f.solids[i], LMN_SOLID_ROOT, &ball, &f.shapes[i], &error));
    }
    *state = &f;
    return 0;
}

static int tear_down(void **state)
{
    fixture *f = *state;
    lmn_look_destroy(&f->look);
    lmn_scene_destroy(&f->scene);
    lmn_renderer_destroy(&f->renderer);
    return 0;
}

static void draw(const fixture *f)
{
    lmn_draw_desc desc = LMN_DRAW_DESC_INIT;
    lmn_drawing  *drawing = NULL;
    desc.width = desc.height = 48;
    desc.dpi = 96;
    DO(lmn_draw(&drawing, f->renderer, f->scene, f->look, &desc, &error));
    lmn_drawing_destroy(&drawing);
}

/* Where things were. A new one is made before the old one goes, so that it never lies in the same position. */
typedef struct positions {
    const void *parts[2], *solids[2], *normals[4];
    size_t      solid_count;
} positions;

static positions positions_of(const fixture *f)
{
    const upload *u = &f->renderer->up;
    positions     p = {.solid_count = u->solid_count};
    for (size_t i = 0; i < 2; i++) {
        p.parts[i] = u->meshes[f->scene->nodes[f->scene->parts[i].node].mesh].primitives[0];
        p.solids[i] = i < u->solid_count ? u->solids[i].mesh : NULL;
    }
    for (size_t i = 0; i < 4; i++)
        p.normals[i] = u->mesh_count >= 4 ? u->shapes[u->mesh_count - 4 + i].vertices : NULL;
    return p;
}

static void one_solid_is_made_anew(void **state)
{
    fixture     *f = *state;
    const double aside[16] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0.5, 0, 0, 1};
    const float  red[4] = {1, 0, 0, 1};
    draw(f);
    positions before = positions_of(f);
    assert_int_equal(before.solid_count, 2);
    for (int i = 0; i < 4; i++)
        assert_non_null(before.normals[i]);
    for (int step = 0; step < 3; step++) {
        if (step == 0)
            DO(lmn_solid_set_matrix(f->scene, f->solids[1], f->shapes[1], aside, &error));
        else if (step == 1)
            DO(lmn_solid_set_operation(f->scene, f->solids[1], LMN_SOLID_ROOT, LMN_UNION, &error));
        else
            DO(lmn_solid_set_colour(f->scene, f->solids[1], f->shapes[1], red, &error));
        draw(f);
        positions after = positions_of(f);
        assert_memory_equal(after.parts, before.parts, sizeof after.parts);
        assert_memory_equal(after.normals, before.normals, sizeof after.normals);
        assert_ptr_equal(after.solids[0], before.solids[0]);
        assert_ptr_not_equal(after.solids[1], before.solids[1]);
        before = after;
    }
}

static void another_shape_makes_its_normals_alone(void **state)
{
    fixture  *f = *state;
    lmn_shape cone = lmn_shape_cylinder(2, 1, 0);
    draw(f);
    positions before = positions_of(f);
    DO(lmn_solid_set_shape(f->scene, f->solids[0], f->shapes[0], &cone, &error));
    DO(lmn_solid_set_name(f->scene, f->solids[1], LMN_SOLID_ROOT, "another", &error));
    draw(f);
    positions after = positions_of(f);
    assert_memory_equal(after.parts, before.parts, sizeof after.parts);
    assert_ptr_not_equal(after.solids[0], before.solids[0]);
    assert_ptr_equal(after.solids[1], before.solids[1]);
    size_t kept = 0;
    for (int i = 0; i < 4; i++)
        for (int k = 0; k < 4; k++)
            kept += after.normals[i] && after.normals[i] == before.normals[k];
    assert_true(kept >= 2);
}

/* Parts are numbered anew when a solid has nothing left; what they are drawn from stays. */
static void emptied_solids_leave_the_rest(void **state)
{
    fixture *f = *state;
    draw(f);
    positions before = positions_of(f);
    DO(lmn_solid_remove(f->scene, f->solids[0], LMN_SOLID_ROOT, &error));
    draw(f);
    positions after = positions_of(f);
    assert_int_equal(after.solid_count, 1);
    assert_memory_equal(after.parts, before.parts, sizeof after.parts);
    assert_ptr_equal(after.solids[0], before.solids[1]);
}

/* A file that comes later leaves what is there. */
static void files_come_later(void **state)
{
    fixture *f = *state;
    draw(f);
    positions before = positions_of(f);
    DO(lmn_scene_add_file(f->scene, TEST_DATA "/two-parts.gltf", NULL, &error));
    draw(f);
    positions after = positions_of(f);
    assert_memory_equal(after.parts, before.parts, sizeof after.parts);
    assert_memory_equal(after.solids, before.solids, sizeof after.solids);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(one_solid_is_made_anew, set_up, tear_down),
        cmocka_unit_test_setup_teardown(another_shape_makes_its_normals_alone, set_up, tear_down),
        cmocka_unit_test_setup_teardown(emptied_solids_leave_the_rest, set_up, tear_down),
        cmocka_unit_test_setup_teardown(files_come_later, set_up, tear_down),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
