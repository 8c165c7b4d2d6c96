/* Walls are found and unrolled: where a vertex lies on its wall, how long that is, and how high its eaves are. */
#include "field_shapes.h"

#include "field/walls.h"

enum { UP = 2 };

static primitive mesh_of(const float (*at)[3], uint32_t vertices, const uint32_t (*triangles)[3], uint32_t count)
{
    primitive p = empty_primitive(vertices, 3 * count);
    for (uint32_t v = 0; v < vertices; v++)
        p.positions[v] = (vec3){at[v][0], at[v][1], at[v][2]};
    memcpy(p.indices, triangles, 3 * count * sizeof *p.indices);
    return p;
}

/* A house of 8 by 6, eaves at 5, the ridge along x at 8: two long walls and two gables. */
static primitive house(void)
{
    static const float    at[10][3] = {{0, 0, 0}, {8, 0, 0}, {8, 6, 0}, {0, 6, 0}, {0, 0, 5},
                                       {8, 0, 5}, {8, 6, 5}, {0, 6, 5}, {0, 3, 8}, {8, 3, 8}};
    static const uint32_t faces[14][3] = {{0, 1, 5}, {0, 5, 4}, {1, 2, 6}, {1, 6, 5}, {5, 6, 9}, {2, 3, 7}, {2, 7, 6},
                                          {3, 0, 4}, {3, 4, 7}, {7, 4, 8}, {4, 5, 9}, {4, 9, 8}, {6, 7, 8}, {6, 8, 9}};
    return mesh_of(at, 10, faces, 14);
}

/* A drum of `sides` sides, radius 3, height 7. */
static primitive drum(uint32_t sides)
{
    primitive p = empty_primitive(2 * sides, 6 * sides);
    for (uint32_t i = 0; i < sides; i++) {
        double   a = 2 * field_pi * i / sides;
        uint32_t next = (i + 1) % sides, quad[6] = {i, next, sides + next, i, sides + next, sides + i};
        p.positions[i] = (vec3){(float)(3 * cos(a)), (float)(3 * sin(a)), 0};
        p.positions[sides + i] = (vec3){(float)(3 * cos(a)), (float)(3 * sin(a)), 7};
        memcpy(p.indices + 6 * (size_t)i, quad, sizeof quad);
    }
    return p;
}

static mat4 scaled(double s)
{
    mat4 m = {{s, 0, 0, 0, 0, s, 0, 0, 0, 0, s, 0, 10, 20, 30, 1}};
    return m;
}

static wall_mesh walls_of(const primitive *p, double scale, double base)
{
    wall_mesh m;
    mat4      world = scaled(scale);
    assert_int_equal(wall_mesh_make(&m, p, &world, UP, 30 + base, NULL), LMN_OK);
    assert_int_equal(m.index_count, p->index_count);
    for (uint32_t i = 0; i < m.index_count; i++)
        assert_int_equal(m.source[m.indices[i]], p->indices[i]);
    return m;
}

static void check_corner(const wall_mesh *m, uint32_t corner, double x, double y, double length, double eaves)
{
    uint32_t v = m->indices[corner];
    assert_float_equal(m->at[v][0], (float)x, 1e-5f);
    assert_float_equal(m->at[v][1], (float)y, 1e-5f);
    assert_float_equal(m->extent[v][0], (float)length, 1e-4f);
    assert_float_equal(m->extent[v][1], (float)eaves, 1e-4f);
}

static void a_house_has_four_walls(void **state)
{
    (void)state;
    primitive p = house();
    wall_mesh m = walls_of(&p, 2, 0);
    assert_int_equal(m.wall_count, 4);
    /* The long wall in front: left, right, right above; then its second triangle's third corner, left above. */
    check_corner(&m, 0, 0, 0, 16, 10);
    check_corner(&m, 1, 1, 0, 16, 10);
    check_corner(&m, 2, 1, 1, 16, 10);
    check_corner(&m, 5, 0, 1, 16, 10);
    /* The gable's ridge lies above its eaves: 16 over 10, in its middle. */
    check_corner(&m, 14, 0.5, 1.6, 12, 10);
    /* Roofs are no walls. */
    for (uint32_t c = 30; c < 42; c++)
        check_corner(&m, c, 0, 0, 0, 0);
    wall_mesh_release(&m);
    primitive_release(&p);
}

static void heights_count_from_the_base(void **state)
{
    (void)state;
    primitive p = house();
    wall_mesh m = walls_of(&p, 1, 1); /* the ground lies 1 above its lowest place */
    check_corner(&m, 0, 0, -0.25, 8, 4);
    check_corner(&m, 2, 1, 1, 8, 4);
    wall_mesh_release(&m);
    primitive_release(&p);
}

static void a_round_tower_is_one_wall(void **state)
{
    (void)state;
    primitive p = drum(24);
    wall_mesh m = walls_of(&p, 1, 0);
    double    side = 6 * sin(field_pi / 24), least = 1, most = 0;
    assert_int_equal(m.wall_count, 1);
    for (uint32_t c = 0; c < m.index_count; c++) {
        uint32_t v = m.indices[c];
        assert_float_equal(m.extent[v][0], (float)(24 * side), 1e-3f);
        least = fmin(least, (double)m.at[v][0]);
        most = fmax(most, (double)m.at[v][0]);
    }
    assert_float_equal((float)least, 0, 1e-6f);
    assert_float_equal((float)most, 1, 1e-6f);
    /* Unrolled: each side is as long as it is. */
    for (uint32_t t = 0; t < m.index_count; t += 6)
        assert_float_equal(fabsf(m.at[m.indices[t + 1]][0] - m.at[m.indices[t]][0]) * m.extent[m.indices[t]][0],
                           (float)side, 1e-3f);
    wall_mesh_release(&m);
    primitive_release(&p);
    p = drum(6); /* turns of 60 degrees are corners */
    m = walls_of(&p, 1, 0);
    assert_int_equal(m.wall_count, 6);
    wall_mesh_release(&m);
    primitive_release(&p);
}

static void barely_meshes_do_no_harm(void **state)
{
    (void)state;
    static const float    at[4][3] = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {0, 0, 1}};
    static const uint32_t faces[3][3] = {{0, 1, 2}, {0, 0, 0}, {0, 2, 3}};
    primitive             p = mesh_of(at, 4, faces, 3);
    wall_mesh             m = walls_of(&p, 1, 0);
    assert_int_equal(m.wall_count, 1); /* no triangle without an area */
    check_corner(&m, 8, 0, 0, 0, 0);   /* eaves at the base: there is no room for anything */
    wall_mesh_release(&m);
    p.index_count = 0;
    m = walls_of(&p, 1, 0);
    assert_int_equal(m.wall_count, 0);
    wall_mesh_release(&m);
    primitive_release(&p);
}

static void memory_may_run_out(void **state)
{
    (void)state;
    primitive p = house();
    mat4      world = scaled(1);
    long      n = 1;
    for (; n < 100; n++) {
        wall_mesh m;
        mem_fail_at(n);
        lmn_status status = wall_mesh_make(&m, &p, &world, UP, 0, NULL);
        mem_fail_at(0);
        wall_mesh_release(&m);
        if (status == LMN_OK)
            break;
        assert_int_equal(status, LMN_MEMORY);
    }
    assert_true(n > 8 && n < 100);
    primitive_release(&p);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_house_has_four_walls),    cmocka_unit_test(heights_count_from_the_base),
        cmocka_unit_test(a_round_tower_is_one_wall), cmocka_unit_test(barely_meshes_do_no_harm),
        cmocka_unit_test(memory_may_run_out),
    };
    return cmocka_run_group_tests(tests, NULL, remove_temp_folder);
}
