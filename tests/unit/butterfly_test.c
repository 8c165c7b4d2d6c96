/* Modified butterfly subdivision against stencils written out by hand, and what must not change: given vertices,
 * sharp edges, flat faces. Row OE-09. */
#include "field_shapes.h"

#include "stroke/butterfly.h"

typedef uint32_t corners3[3];

static butterfly refine(const primitive *p, const uint8_t *sharp, int steps)
{
    butterfly b;
    assert_int_equal(butterfly_refine(&b, p->positions, p->vertex_count, (const corners3 *)p->indices,
                                      p->index_count / 3, sharp, steps, NULL),
                     LMN_OK);
    return b;
}

static bool same_position(vec3 a, vec3 b)
{
    return a.x == b.x && a.y == b.y && a.z == b.z;
}

/* The vertex in the middle of an edge of the first level. */
static vec3 middle_of(const butterfly *b, uint32_t from, uint32_t to)
{
    for (uint32_t h = 0; h < 3 * b->levels[0].face_count; h++) {
        uint32_t p = b->levels[0].faces[h / 3][h % 3], q = b->levels[0].faces[h / 3][(h + 1) % 3];
        if ((p == from && q == to) || (p == to && q == from)) {
            uint32_t               first = half_edge_first(h), second = half_edge_second(h);
            const butterfly_level *l = &b->levels[1];
            assert_int_equal(l->faces[first / 3][first % 3], p);
            assert_int_equal(l->faces[second / 3][(second + 1) % 3], q);
            assert_int_equal(l->faces[first / 3][(first + 1) % 3], l->faces[second / 3][second % 3]);
            return b->positions[l->faces[first / 3][(first + 1) % 3]];
        }
    }
    fail();
    return (vec3){0, 0, 0};
}

enum { SIDE = 8 };

static vec3 lattice(const primitive *p, int i, int j)
{
    return p->positions[((j % SIDE + SIDE) % SIDE) * SIDE + (i % SIDE + SIDE) % SIDE];
}

static uint32_t lattice_number(int i, int j)
{
    return (uint32_t)(((j % SIDE + SIDE) % SIDE) * SIDE + (i % SIDE + SIDE) % SIDE);
}

static place3 flat_at(double u, double v)
{
    return (place3){u, v, 0};
}

/* All vertices of a torus of triangles have six neighbours. Whole numbers as positions: the fractions are sixteenths,
 * so that all sums are exact. */
static void the_regular_stencil_is_exact(void **state)
{
    (void)state;
    primitive p = grid_surface(flat_at, SIDE, SIDE, true, true, 0);
    for (uint32_t v = 0; v < p.vertex_count; v++)
        p.positions[v] = (vec3){floorf((float)(1000 * hashed(3 * v))), floorf((float)(1000 * hashed(3 * v + 1))),
                                floorf((float)(1000 * hashed(3 * v + 2)))};
    butterfly        b = refine(&p, NULL, 1);
    static const int directions[3][4] = {
        {1, 0, 1, 1}, {1, 1, 0, 1}, {0, 1, -1, 0}}; /* an edge and the next one to its left */
    for (int j = 0; j < SIDE; j++)
        for (int i = 0; i < SIDE; i++)
            for (int w = 0; w < 3; w++) {
                int  ux = directions[w][0], uy = directions[w][1], wx = directions[w][2], wy = directions[w][3];
                vec3 ends[2] = {lattice(&p, i, j), lattice(&p, i + ux, j + uy)};
                vec3 sides[2] = {lattice(&p, i + wx, j + wy), lattice(&p, i + ux - wx, j + uy - wy)};
                vec3 wings[4] = {lattice(&p, i + wx - ux, j + wy - uy), lattice(&p, i + wx + ux, j + wy + uy),
                                 lattice(&p, i - wx, j - wy), lattice(&p, i + 2 * ux - wx, j + 2 * uy - wy)};
                vec3 wanted = {(8 * (ends[0].x + ends[1].x) + 2 * (sides[0].x + sides[1].x) -
                                (wings[0].x + wings[1].x + wings[2].x + wings[3].x)) /
                                   16,
                               (8 * (ends[0].y + ends[1].y) + 2 * (sides[0].y + sides[1].y) -
                                (wings[0].y + wings[1].y + wings[2].y + wings[3].y)) /
                                   16,
                               (8 * (ends[0].z + ends[1].z) + 2 * (sides[0].z + sides[1].z) -
                                (wings[0].z + wings[1].z + wings[2].z + wings[3].z)) /
                                   16};
                assert_true(same_position(middle_of(&b, lattice_number(i, j), lattice_number(i + ux, j + uy)), wanted));
            }
    butterfly_release(&b);
    primitive_release(&p);
}

/* A disc of k sectors: a middle, and rings of k, 2k and 3k vertices; ring r begins at 1 + k·r·(r − 1)/2. */
static uint32_t ring_vertex(uint32_t k, uint32_t r, uint32_t i)
{
    return r == 0 ? 0 : 1 + k * (r - 1) * r / 2 + i % (k * r);
}

static primitive disc(uint32_t k)
{
    primitive p = empty_primitive(1 + 6 * k, 3 * 9 * k);
    for (uint32_t v = 0; v < p.vertex_count; v++)
        p.positions[v] = (vec3){(float)hashed(5 * v), (float)hashed(5 * v + 1), (float)hashed(5 * v + 2)};
    uint32_t at = 0;
    for (uint32_t r = 0; r < 3; r++)
        for (uint32_t s = 0; s < k; s++)
            for (uint32_t i = 0; i <= r; i++) {
                uint32_t       inner = ring_vertex(k, r, s * r + i), out = s * (r + 1) + i;
                const uint32_t outward[3] = {inner, ring_vertex(k, r + 1, out), ring_vertex(k, r + 1, out + 1)};
                memcpy(&p.indices[at], outward, sizeof outward);
                at += 3;
                if (i == r)
                    continue;
                const uint32_t between[3] = {inner, ring_vertex(k, r + 1, out + 1), ring_vertex(k, r, s * r + i + 1)};
                memcpy(&p.indices[at], between, sizeof between);
                at += 3;
            }
    assert_int_equal(at, p.index_count);
    return p;
}

static void other_vertices_have_stencils_of_their_own(void **state)
{
    (void)state;
    static const double three[3] = {5, -1, -1}, four[4] = {3, 0, -1, 0};
    for (uint32_t k = 3; k <= 9; k++) {
        if (k == 6)
            continue;
        primitive p = disc(k);
        butterfly b = refine(&p, NULL, 1);
        for (uint32_t to = 0; to < k; to++) {
            double sum[3] = {0.75 * p.positions[0].x, 0.75 * p.positions[0].y, 0.75 * p.positions[0].z};
            for (uint32_t j = 0; j < k; j++) {
                vec3   q = p.positions[1 + (to + j) % k];
                double fraction = k == 3   ? three[j] / 12
                                  : k == 4 ? four[j] / 8
                                           : (0.25 + cos(2 * field_pi * j / k) + 0.5 * cos(4 * field_pi * j / k)) / k;
                sum[0] += fraction * q.x;
                sum[1] += fraction * q.y;
                sum[2] += fraction * q.z;
            }
            vec3 own = middle_of(&b, 0, 1 + to);
            assert_true(fabs(own.x - sum[0]) < 1e-6 && fabs(own.y - sum[1]) < 1e-6 && fabs(own.z - sum[2]) < 1e-6);
        }
        butterfly_release(&b);
        primitive_release(&p);
    }
}

static void given_vertices_stay(void **state)
{
    (void)state;
    primitive p = grid_surface(torus_at, 9, 7, true, true, 0.3);
    butterfly b = refine(&p, NULL, 3);
    assert_int_equal(b.level_count, 4);
    assert_memory_equal(b.positions, p.positions, p.vertex_count * sizeof *p.positions);
    for (uint32_t i = 0; i + 1 < b.level_count; i++) {
        const butterfly_level *l = &b.levels[i], *finer = l + 1;
        assert_int_equal(finer->face_count, 4 * l->face_count);
        assert_int_equal(finer->vertex_count, l->vertex_count + 3 * l->face_count / 2); /* Euler: closed */
        for (uint32_t f = 0; f < l->face_count; f++)
            for (int k = 0; k < 3; k++)
                assert_int_equal(finer->faces[4 * f + (uint32_t)k][k], l->faces[f][k]); /* a child at each corner */
        for (uint32_t h = 0; h < 3 * finer->face_count; h++) {
            assert_int_not_equal(finer->opposite[h], BUTTERFLY_NONE);
            assert_int_equal(finer->opposite[finer->opposite[h]], h);
            assert_int_equal(finer->sharp[h], 0);
        }
    }
    butterfly_release(&b);
    primitive_release(&p);
}

static primitive cube(void)
{
    static const uint32_t faces[12][3] = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                                          {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
    primitive             p = empty_primitive(8, 36);
    for (uint32_t v = 0; v < 8; v++)
        p.positions[v] = (vec3){v & 1 ? 1 : -1, v & 2 ? 1 : -1, v & 4 ? 1 : -1};
    memcpy(p.indices, faces, sizeof faces);
    return p;
}

/* Sharp where two corners of a cube differ in one coordinate only: all edges but the diagonals. */
static void a_cube_with_sharp_edges_stays_a_cube(void **state)
{
    (void)state;
    primitive p = cube();
    uint8_t   sharp[36];
    for (uint32_t h = 0; h < 36; h++) {
        uint32_t differ = p.indices[h] ^ p.indices[h % 3 == 2 ? h - 2 : h + 1];
        sharp[h] = (differ & (differ - 1)) == 0;
    }
    butterfly              b = refine(&p, sharp, 3);
    const butterfly_level *l = &b.levels[3];
    for (uint32_t v = 0; v < l->vertex_count; v++) {
        vec3 q = b.positions[v];
        assert_true(fmaxf(fmaxf(fabsf(q.x), fabsf(q.y)), fabsf(q.z)) == 1);
    }
    uint32_t sharp_edges = 0;
    for (uint32_t h = 0; h < 3 * l->face_count; h++) {
        vec3 a = b.positions[l->faces[h / 3][h % 3]], c = b.positions[l->faces[h / 3][(h + 1) % 3]];
        int  shared =
            (fabsf(a.x) == 1 && a.x == c.x) + (fabsf(a.y) == 1 && a.y == c.y) + (fabsf(a.z) == 1 && a.z == c.z);
        assert_int_equal(l->sharp[h], shared == 2); /* sharp edges are those that lie on two sides of the cube */
        sharp_edges += l->sharp[h];
    }
    assert_int_equal(sharp_edges, 2 * 12 * 8);
    butterfly_release(&b);
    primitive_release(&p);
}

enum { SLICES = 12 };

/* A cylinder: a ring at the bottom, one in the middle, one at the top, and the middles of both caps. */
static primitive cylinder(uint8_t *sharp)
{
    primitive p = empty_primitive(3 * SLICES + 2, 3 * 6 * SLICES);
    uint32_t  at = 0;
    for (uint32_t i = 0; i < 3 * SLICES; i++)
        p.positions[i] =
            (vec3){(float)cos(2 * field_pi * i / SLICES), (float)sin(2 * field_pi * i / SLICES), (float)(i / SLICES)};
    p.positions[3 * SLICES] = (vec3){0, 0, 0};
    p.positions[3 * SLICES + 1] = (vec3){0, 0, 2};
    for (uint32_t i = 0; i < SLICES; i++) {
        uint32_t       a = i, c = (i + 1) % SLICES, s = SLICES;
        const uint32_t faces[6][3] = {{3 * s, c, a},
                                      {a, c, c + s},
                                      {a, c + s, a + s},
                                      {a + s, c + s, c + 2 * s},
                                      {a + s, c + 2 * s, a + 2 * s},
                                      {3 * s + 1, a + 2 * s, c + 2 * s}};
        memcpy(&p.indices[at], faces, sizeof faces);
        at += 18;
    }
    for (uint32_t h = 0; h < p.index_count; h++) {
        uint32_t m = p.indices[h] / SLICES, n = p.indices[h % 3 == 2 ? h - 2 : h + 1] / SLICES;
        sharp[h] = m == n && (m == 0 || m == 2);
    }
    return p;
}

static void a_rim_becomes_round_and_caps_stay_flat(void **state)
{
    (void)state;
    uint8_t                sharp[18 * SLICES];
    primitive              p = cylinder(sharp);
    butterfly              b = refine(&p, sharp, 3);
    const butterfly_level *l = &b.levels[3];
    uint32_t               rim = 0;
    double                 most = 0;
    for (uint32_t h = 0; h < 3 * l->face_count; h++) {
        if (!l->sharp[h])
            continue;
        vec3 q = b.positions[l->faces[h / 3][h % 3]];
        assert_true(q.z == 0 || q.z == 2); /* the curve of a flat rim lies in its plane */
        most = fmax(most, fabs(hypot(q.x, q.y) - 1));
        rim++;
    }
    assert_int_equal(rim, 2 * 2 * SLICES * 8);
    assert_true(most < 0.003); /* the polygon's own sides are off by 0.034 */
    for (uint32_t v = 0; v < l->vertex_count; v++)
        assert_true(b.positions[v].z >= -1e-3 && b.positions[v].z <= 2 + 1e-3); /* nothing bulges over the rims */
    butterfly_release(&b);
    primitive_release(&p);
}

/* What is beyond a sharp edge must not be seen: the caps may go anywhere. */
static void sides_of_sharp_edges_do_not_know_each_other(void **state)
{
    (void)state;
    uint8_t   sharp[18 * SLICES];
    primitive p = cylinder(sharp);
    butterfly before = refine(&p, sharp, 2);
    p.positions[3 * SLICES].z = -7;
    p.positions[3 * SLICES + 1].x = 3;
    butterfly              after = refine(&p, sharp, 2);
    const butterfly_level *l = &before.levels[2];
    uint32_t               same = 0;
    for (uint32_t f = 0; f < l->face_count; f++) {
        uint32_t k = f / 16 % 6;
        for (int c = 0; c < 3 && k >= 1 && k <= 4; c++, same++)
            assert_true(same_position(before.positions[l->faces[f][c]], after.positions[l->faces[f][c]]));
    }
    assert_int_equal(same, SLICES * 4 * 16 * 3);
    butterfly_release(&before);
    butterfly_release(&after);
    primitive_release(&p);
}

static place3 sheet_at(double u, double v)
{
    return (place3){4 * u, 4 * v, u};
}

static void a_flat_sheet_stays_flat_and_keeps_its_corners(void **state)
{
    (void)state;
    primitive p = grid_surface(sheet_at, 4, 4, false, false, 0);
    butterfly b = refine(&p, NULL, 3);
    for (uint32_t v = 0; v < b.levels[3].vertex_count; v++) {
        vec3 q = b.positions[v];
        assert_true(fabsf(q.z - q.x / 4) < 1e-6f && q.x >= 0 && q.x <= 4 && q.y >= 0 && q.y <= 4);
    }
    double                 area = 0;
    const butterfly_level *l = &b.levels[3];
    for (uint32_t f = 0; f < l->face_count; f++) {
        vec3 a = b.positions[l->faces[f][0]], c = b.positions[l->faces[f][1]], d = b.positions[l->faces[f][2]];
        area += 0.5 * ((double)(c.x - a.x) * (d.y - a.y) - (double)(c.y - a.y) * (d.x - a.x));
    }
    assert_true(fabs(area - 16) < 1e-4);
    butterfly_release(&b);
    primitive_release(&p);
}

/* An octahedron's edges have their middles at 5/8: 3/4 and 1/2 from one end's ring, 1/2 and 3/4 from the other's.
 * What comes of it is rounder than it was. */
static void a_coarse_sphere_becomes_rounder(void **state)
{
    (void)state;
    primitive             p = empty_primitive(6, 24);
    static const float    at[6][3] = {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
    static const uint32_t faces[8][3] = {{0, 2, 4}, {2, 1, 4}, {1, 3, 4}, {3, 0, 4},
                                         {2, 0, 5}, {1, 2, 5}, {3, 1, 5}, {0, 3, 5}};
    memcpy(p.positions, at, sizeof at);
    memcpy(p.indices, faces, sizeof faces);
    butterfly b = refine(&p, NULL, 4);
    for (uint32_t v = 6; v < 18; v++) {
        vec3 q = b.positions[v];
        assert_true(fmaxf(fmaxf(fabsf(q.x), fabsf(q.y)), fabsf(q.z)) == 0.625f &&
                    fabsf(q.x) + fabsf(q.y) + fabsf(q.z) == 1.25f);
    }
    double most = 0;
    for (uint32_t v = 0; v < b.levels[4].vertex_count; v++)
        most = fmax(
            most, fabs(sqrt((double)b.positions[v].x * b.positions[v].x + (double)b.positions[v].y * b.positions[v].y +
                            (double)b.positions[v].z * b.positions[v].z) -
                       1));
    printf("an octahedron after 4 steps: within %.3f of its sphere\n", most);
    assert_true(most < 0.21); /* its own faces are off by 0.42 */
    butterfly_release(&b);
    primitive_release(&p);
}

/* Three faces at one edge, one the other way round, a face alone: no crack, no number out of range. */
static void barely_meshes_have_no_cracks(void **state)
{
    (void)state;
    primitive             p = empty_primitive(9, 15);
    static const uint32_t faces[5][3] = {{0, 1, 2}, {1, 0, 3}, {0, 1, 4}, {1, 2, 5}, {6, 7, 8}};
    memcpy(p.indices, faces, sizeof faces);
    for (uint32_t v = 0; v < 9; v++)
        p.positions[v] = (vec3){(float)hashed(v), (float)hashed(v + 100), (float)hashed(v + 200)};
    butterfly b = refine(&p, NULL, 2);
    assert_int_equal(b.levels[1].vertex_count, 9 + 12); /* edges: 3 + 2 + 2 + 2 + 3 */
    for (uint32_t h = 0; h < 3 * b.levels[2].face_count; h++) {
        assert_true(b.levels[2].faces[h / 3][h % 3] < b.levels[2].vertex_count);
        assert_true(b.levels[2].sharp[h] == 1 || b.levels[2].opposite[h] != BUTTERFLY_NONE);
    }
    for (uint32_t v = 0; v < b.levels[2].vertex_count; v++)
        assert_true(isfinite(b.positions[v].x) && isfinite(b.positions[v].y) && isfinite(b.positions[v].z));
    butterfly_release(&b);
    b = refine(&(primitive){.positions = p.positions, .indices = p.indices}, NULL, 2); /* nothing */
    butterfly_release(&b);
    primitive_release(&p);
}

static void too_much_is_refused(void **state)
{
    (void)state;
    butterfly b;
    lmn_error e = {0};
    assert_int_equal(butterfly_refine(&b, NULL, 0, NULL, 1u << 26, NULL, 1, &e), LMN_LIMIT);
    assert_non_null(strstr(e.message, "cannot be refined"));
    assert_int_equal(butterfly_refine(&b, NULL, 0, NULL, 1, NULL, BUTTERFLY_STEPS_MAX + 1, &e), LMN_LIMIT);
}

static void memory_may_run_out(void **state)
{
    (void)state;
    primitive  p = cube();
    butterfly  b;
    lmn_status status = LMN_MEMORY;
    long       n = 1;
    for (; status != LMN_OK && n < 100; n++) {
        mem_fail_at(n);
        status = butterfly_refine(&b, p.positions, p.vertex_count, (const corners3 *)p.indices, 12, NULL, 2, NULL);
        mem_fail_at(0);
        assert_true(status == LMN_OK || (status == LMN_MEMORY && b.positions == NULL));
    }
    assert_true(n > 10 && status == LMN_OK);
    butterfly_release(&b);
    primitive_release(&p);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_regular_stencil_is_exact),
        cmocka_unit_test(other_vertices_have_stencils_of_their_own),
        cmocka_unit_test(given_vertices_stay),
        cmocka_unit_test(a_cube_with_sharp_edges_stays_a_cube),
        cmocka_unit_test(a_rim_becomes_round_and_caps_stay_flat),
        cmocka_unit_test(sides_of_sharp_edges_do_not_know_each_other),
        cmocka_unit_test(a_flat_sheet_stays_flat_and_keeps_its_corners),
        cmocka_unit_test(a_coarse_sphere_becomes_rounder),
        cmocka_unit_test(barely_meshes_have_no_cracks),
        cmocka_unit_test(too_much_is_refused),
        cmocka_unit_test(memory_may_run_out),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
