/* Welding, adjacency, normals and poses against answers worked out by hand or by brute force. */
#include "import_support.h"

#include <math.h>

static const vec3 cube_corners[8] = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0},
                                     {0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}};
/* Two triangles a face: −z, +z, −y, +x, +y, −x. */
static const uint32_t cube_triangles[36] = {0, 3, 2, 0, 2, 1, 4, 5, 6, 4, 6, 7, 0, 1, 5, 0, 5, 4,
                                            1, 2, 6, 1, 6, 5, 2, 3, 7, 2, 7, 6, 3, 0, 4, 3, 4, 7};
static const double   pi = 3.14159265358979323846;

static primitive make_primitive(const vec3 *positions, uint32_t vertices, const uint32_t *indices, uint32_t count)
{
    primitive p = {.vertex_count = vertices, .index_count = count, .material = NONE};
    p.positions = mem_copy(positions, vertices * sizeof *positions);
    p.indices = indices ? mem_copy(indices, count * sizeof *indices) : NULL;
    return p;
}

/* Three own corners a triangle, as STL has them. */
static primitive unshared_cube(void)
{
    vec3 corners[36];
    for (int i = 0; i < 36; i++)
        corners[i] = cube_corners[cube_triangles[i]];
    return make_primitive(corners, 36, NULL, 0);
}

static void welding_gives_shared_corners(void **state)
{
    (void)state;
    primitive p = unshared_cube();
    p.positions[0].x = -0.0f; /* the same position as +0 */
    assert_int_equal(mesh_weld_positions(&p, NULL), LMN_OK);
    assert_int_equal(p.vertex_count, 8);
    assert_int_equal(p.index_count, 36);
    /* First appearance: corners 0, 3, 2, then 1. */
    assert_int_equal(p.indices[0], 0);
    assert_int_equal(p.indices[3], 0);
    assert_int_equal(p.indices[5], 3);
    for (int i = 0; i < 36; i++) {
        vec3 a = p.positions[p.indices[i]], b = cube_corners[cube_triangles[i]];
        assert_true(a.x == b.x && a.y == b.y && a.z == b.z);
    }
    primitive_release(&p);
}

static void welding_large_sets_finds_the_first(void **state)
{
    (void)state;
    enum { SIDE = 40, POINTS = SIDE * SIDE * SIDE, COUNT = POINTS * 4 };
    primitive p = {.vertex_count = COUNT};
    p.positions = mem_alloc(COUNT * sizeof *p.positions);
    static uint32_t first[POINTS];
    memset(first, 0xFF, sizeof first);
    for (uint32_t i = 0; i < COUNT; i++) {
        uint32_t n = (uint32_t)((uint64_t)i * 48271 % COUNT) % POINTS;
        p.positions[i] = (vec3){(float)(n % SIDE), (float)(n / SIDE % SIDE) * 0.37f, (float)(n / SIDE / SIDE) * 1e-3f};
    }
    uint32_t *ids = mesh_position_ids(&p);
    for (uint32_t i = 0; i < COUNT; i++) {
        uint32_t n = (uint32_t)((uint64_t)i * 48271 % COUNT) % POINTS;
        if (first[n] == UINT32_MAX)
            first[n] = i;
        assert_true(ids[i] == first[n]);
    }
    mem_free(ids);
    mem_free(p.positions);
}

static void adjacency_of_a_cube_is_closed(void **state)
{
    (void)state;
    primitive p = unshared_cube();
    uint32_t  identity[36];
    for (uint32_t i = 0; i < 36; i++)
        identity[i] = i;
    p.indices = mem_copy(identity, sizeof identity);
    p.index_count = 36;
    uint32_t *opposite = mesh_adjacency(&p);
    for (uint32_t h = 0; h < 36; h++) {
        uint32_t o = opposite[h];
        assert_true(o < 36 && o != h);
        assert_int_equal(opposite[o], h);
        uint32_t next_h = h % 3 == 2 ? h - 2 : h + 1, next_o = o % 3 == 2 ? o - 2 : o + 1;
        /* The other side runs the other way. */
        assert_memory_equal(&p.positions[h], &p.positions[next_o], sizeof(vec3));
        assert_memory_equal(&p.positions[next_h], &p.positions[o], sizeof(vec3));
    }
    mem_free(opposite);
    primitive_release(&p);
}

static void adjacency_knows_borders_and_crowded_edges(void **state)
{
    (void)state;
    const vec3     points[] = {{0, 0, 0},  {0, 0, 1}, {1, 0, 0}, {0, 1, 0}, {-1, 0, 0},
                               {0, -1, 0}, {5, 5, 5}, {6, 5, 5}, {5, 6, 5}};
    const uint32_t triangles[] = {0, 1, 2, 0, 1, 3, 0, 1, 4, 0, 1, 5, 6, 7, 8};
    primitive      p = make_primitive(points, 9, triangles, 15);
    uint32_t      *opposite = mesh_adjacency(&p);
    assert_int_equal(opposite[0], 3); /* the first with the second, the third with the fourth */
    assert_int_equal(opposite[3], 0);
    assert_int_equal(opposite[6], 9);
    assert_int_equal(opposite[9], 6);
    assert_true(opposite[1] == UINT32_MAX);
    for (int h = 12; h < 15; h++)
        assert_true(opposite[h] == UINT32_MAX);
    mem_free(opposite);
    primitive_release(&p);
}

static void cube_normals_split_at_the_crease(void **state)
{
    (void)state;
    static const vec3 faces[6] = {{0, 0, -1}, {0, 0, 1}, {0, -1, 0}, {1, 0, 0}, {0, 1, 0}, {-1, 0, 0}};
    primitive         p = make_primitive(cube_corners, 8, cube_triangles, 36);
    render_vertices   r;
    assert_int_equal(mesh_make_normals(&r, &p, 0.5, NULL), LMN_OK);
    assert_int_equal(r.vertex_count, 24);
    for (int i = 0; i < 36; i++) {
        uint32_t v = r.indices[i];
        assert_int_equal(r.source[v], p.indices[i]);
        assert_float_equal(r.normals[v].x, faces[i / 6].x, 1e-6f);
        assert_float_equal(r.normals[v].y, faces[i / 6].y, 1e-6f);
        assert_float_equal(r.normals[v].z, faces[i / 6].z, 1e-6f);
    }
    render_vertices_release(&r);
    /* Wider than a right angle: all corners are smooth. */
    assert_int_equal(mesh_make_normals(&r, &p, 1.7, NULL), LMN_OK);
    assert_int_equal(r.vertex_count, 8);
    assert_null(r.indices);
    for (int v = 0; v < 8; v++) {
        vec3 c = p.positions[v], n = r.normals[v];
        assert_true(n.x * (c.x - 0.5f) > 0 && n.y * (c.y - 0.5f) > 0 && n.z * (c.z - 0.5f) > 0);
    }
    render_vertices_release(&r);
    primitive_release(&p);
}

/* A sphere's normals are its positions. The seam repeats positions exactly, as files do. */
static void sphere_normals_are_radial(void **state)
{
    (void)state;
    enum { ROWS = 64, COLUMNS = 128 };
    primitive p = {.vertex_count = (ROWS + 1) * (COLUMNS + 1), .index_count = ROWS * COLUMNS * 6};
    p.positions = mem_alloc(p.vertex_count * sizeof(vec3));
    p.indices = mem_alloc(p.index_count * sizeof(uint32_t));
    for (int i = 0; i <= ROWS; i++)
        for (int k = 0; k <= COLUMNS; k++) {
            double a = pi * i / ROWS, b = 2 * pi * (k % COLUMNS) / COLUMNS, s = i == 0 || i == ROWS ? 0 : sin(a);
            p.positions[i * (COLUMNS + 1) + k] = (vec3){(float)(s * cos(b)), (float)(s * sin(b)), (float)cos(a)};
        }
    uint32_t *out = p.indices;
    for (uint32_t i = 0; i < ROWS; i++)
        for (uint32_t k = 0; k < COLUMNS; k++, out += 6) {
            uint32_t       a = i * (COLUMNS + 1) + k, b = a + COLUMNS + 1;
            const uint32_t quad[6] = {a, b, b + 1, a, b + 1, a + 1};
            memcpy(out, quad, sizeof quad);
        }
    render_vertices r;
    assert_int_equal(mesh_make_normals(&r, &p, 0.7, NULL), LMN_OK);
    double worst = 1;
    for (uint32_t i = 0; i < p.index_count; i++) {
        vec3   n = r.normals[r.indices ? r.indices[i] : p.indices[i]], c = p.positions[p.indices[i]];
        double d = (double)n.x * c.x + (double)n.y * c.y + (double)n.z * c.z;
        worst = d < worst ? d : worst;
    }
    if (worst <= 0.9995)
        print_error("worst: %g\n", worst);
    assert_true(worst > 0.9995);
    render_vertices_release(&r);
    primitive_release(&p);
}

/* The tip of a cone of many faces takes the crowd's path, which must not need quadratic time. */
static void a_huge_fan_ends(void **state)
{
    (void)state;
    enum { FACES = 200000 };
    primitive p = {.vertex_count = FACES + 1, .index_count = FACES * 3};
    p.positions = mem_alloc(p.vertex_count * sizeof(vec3));
    p.indices = mem_alloc(p.index_count * sizeof(uint32_t));
    p.positions[0] = (vec3){0, 0, 1};
    for (uint32_t i = 0; i < FACES; i++) {
        double a = 2 * pi * i / FACES;
        p.positions[i + 1] = (vec3){(float)cos(a), (float)sin(a), 0};
        const uint32_t t[3] = {0, i + 1, (i + 1) % FACES + 1};
        memcpy(p.indices + 3 * i, t, sizeof t);
    }
    render_vertices r;
    assert_int_equal(mesh_make_normals(&r, &p, 0.3, NULL), LMN_OK);
    for (uint32_t i = 0; i < FACES; i += 997) {
        vec3 n = r.normals[r.indices[3 * i]], c = p.positions[i + 1];
        assert_true((n.x * c.x + n.y * c.y) * 0.70710678f + n.z * 0.70710678f > 0.95f);
    }
    render_vertices_release(&r);
    primitive_release(&p);
}

static void poses_follow_morphs_and_joints(void **state)
{
    (void)state;
    const vec3     points[] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 0}};
    const uint32_t triangle[] = {0, 1, 2};
    primitive      p = make_primitive(points, 3, triangle, 3);
    vec3           offsets[] = {{0, 0, 2}, {0, 0, 0}, {0, 0, 0}};
    morph_target   morph = {.positions = offsets};
    uint16_t       joints[12] = {0, 1, 0, 0, 1, 0, 0, 0, 0, 0, 0, 0};
    float          weights[12] = {0.5f, 0.5f, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0};
    p.morphs = &morph;
    p.morph_count = 1;
    p.joints = joints;
    p.weights = weights;
    p.influences = 4;
    double      up[3] = {0, 10, 0}, zero[3] = {0, 0, 0}, one[3] = {1, 1, 1};
    double      still[4] = {0, 0, 0, 1}, quarter[4] = {0, 0, sqrt(0.5), sqrt(0.5)};
    mat4        matrices[2] = {mat4_from_trs(up, still, one), mat4_from_trs(zero, quarter, one)};
    vec3        out[3], normals[3] = {{0, 0, 1}, {1, 0, 0}, {0, 0, 1}}, turned[3];
    const float half = 0.5f;
    mesh_pose(&p, &half, 1, matrices, 2, normals, NULL, 3, out, turned);
    /* (1,0,1): half moved to (1,10,1), half turned to (0,1,1). */
    const vec3 expected[3] = {{0.5f, 5.5f, 1}, {-1, 0, 0}, {0, 10, 0}};
    for (int i = 0; i < 3; i++) {
        assert_float_equal(out[i].x, expected[i].x, 1e-6f);
        assert_float_equal(out[i].y, expected[i].y, 1e-6f);
        assert_float_equal(out[i].z, expected[i].z, 1e-6f);
    }
    assert_float_equal(turned[1].x, 0, 1e-6f);
    assert_float_equal(turned[1].y, 1, 1e-6f);
    mem_free(p.positions);
    mem_free(p.indices);
}

static void failing_memory_is_reported(void **state)
{
    (void)state;
    primitive p = make_primitive(cube_corners, 8, cube_triangles, 36);
    for (long n = 1; n < 40; n++) {
        render_vertices r;
        mem_fail_at(n);
        lmn_status status = mesh_make_normals(&r, &p, 0.5, NULL);
        mem_fail_at(0);
        assert_true(status == LMN_OK || status == LMN_MEMORY);
        if (status == LMN_OK)
            render_vertices_release(&r);
        mem_fail_at(n);
        uint32_t *opposite = mesh_adjacency(&p);
        mem_fail_at(0);
        mem_free(opposite);
    }
    primitive_release(&p);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(welding_gives_shared_corners),
        cmocka_unit_test(welding_large_sets_finds_the_first),
        cmocka_unit_test(adjacency_of_a_cube_is_closed),
        cmocka_unit_test(adjacency_knows_borders_and_crowded_edges),
        cmocka_unit_test(cube_normals_split_at_the_crease),
        cmocka_unit_test(sphere_normals_are_radial),
        cmocka_unit_test(a_huge_fan_ends),
        cmocka_unit_test(poses_follow_morphs_and_joints),
        cmocka_unit_test(failing_memory_is_reported),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
