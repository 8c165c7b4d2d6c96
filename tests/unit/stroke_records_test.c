/* Records of edges and ribbons: what the GPU is told about them. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#include "base/memory.h"
#include "lines/stroke/strokes.h"
#include "scene/scene.h"
#include "stroke_shapes.h"

static const float positions[8][3] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0},
                                      {0, 0, 1}, {1, 0, 1}, {0, 1, 1}, {1, 1, 1}};
/* Each side of the cube as two triangles, anticlockwise from outside. */
static const uint32_t sides[36] = {0, 2, 3, 0, 3, 1, 4, 5, 7, 4, 7, 6, 0, 1, 5, 0, 5, 4,
                                   2, 6, 7, 2, 7, 3, 0, 4, 6, 0, 6, 2, 1, 3, 7, 1, 7, 5};

static void make_edges(edge_mesh *out, uint32_t corners, bool turned)
{
    uint32_t  indices[36];
    lmn_error error = {0};
    memcpy(indices, sides, sizeof indices);
    for (uint32_t i = 0; i < corners && turned; i += 3) {
        uint32_t kept = indices[i + 1];
        indices[i + 1] = indices[i + 2];
        indices[i + 2] = kept;
    }
    primitive p = {.vertex_count = 8,
                   .positions = (vec3 *)(uintptr_t)positions,
                   .index_count = corners,
                   .indices = indices,
                   .material = NONE};
    mesh      m = {.primitives = &p, .primitive_count = 1};
    assert_int_equal(edge_mesh_create(out, &m, NULL, 0.5, &error), LMN_OK);
}

/* Away from the middle of the cube? */
static bool is_outward(const float *record, const float *normal)
{
    float sum = 0;
    for (int k = 0; k < 3; k++)
        sum += normal[k] * (0.5f * (record[k] + record[4 + k]) - 0.5f);
    return sum > 0;
}

static void test_cube(void **state)
{
    (void)state;
    for (int turned = 0; turned < 2; turned++) {
        edge_mesh m;
        make_edges(&m, 36, turned);
        float *records = strokes_edge_records(&m);
        assert_non_null(records);
        assert_int_equal(m.edge_count, 12);
        for (uint32_t i = 0; i < m.edge_count; i++) {
            const float *r = &records[EDGE_RECORD_FLOATS * i];
            assert_int_equal((int)r[3], RECORD_CREASE | RECORD_PAIR | RECORD_CLOSED);
            assert_true(is_outward(r, r + 8) && is_outward(r, r + 12)); /* also of what is inside out */
        }
        mem_free(records);
        edge_mesh_release(&m);
    }
}

static void test_triangle(void **state)
{
    (void)state;
    edge_mesh m;
    make_edges(&m, 3, false);
    float *records = strokes_edge_records(&m);
    assert_int_equal(m.edge_count, 3);
    for (uint32_t i = 0; i < m.edge_count; i++) {
        const float *r = &records[EDGE_RECORD_FLOATS * i];
        assert_int_equal((int)r[3], RECORD_BORDER);
        for (int k = 0; k < 3; k++) /* a border: always between front and back */
            assert_true(r[8 + k] == -r[12 + k]);
    }
    mem_free(records);
    edge_mesh_release(&m);
}

static void test_creases_come_first(void **state)
{
    (void)state;
    mesh_edge edges[3] = {
        {{0, 1}, {0, 1}, EDGE_CANDIDATE}, {{1, 2}, {0, 1}, EDGE_CREASE}, {{2, 3}, {0, 1}, EDGE_CANDIDATE}};
    vec3      normals[2] = {{0, 0, 1}, {0, 1, 0}};
    uint32_t  faces[2][3] = {{0, 1, 2}, {1, 2, 3}}, pieces[2] = {0, 0};
    bool      closed = false, inward = false;
    box3      box = {.min = {0, 0, 0}, .max = {1, 1, 1}};
    edge_mesh m = {.vertex_count = 8,
                   .face_count = 2,
                   .edge_count = 3,
                   .piece_count = 1,
                   .positions = (vec3 *)(uintptr_t)positions,
                   .faces = faces,
                   .normals = normals,
                   .edges = edges,
                   .pieces = pieces,
                   .closed = &closed,
                   .inward = &inward,
                   .boxes = &box};
    float    *records = strokes_edge_records(&m);
    assert_int_equal((int)records[3], RECORD_CREASE | RECORD_PAIR);
    assert_int_equal((int)records[EDGE_RECORD_FLOATS + 3], RECORD_PAIR);
    assert_int_equal((int)records[2 * EDGE_RECORD_FLOATS + 3], RECORD_PAIR);
    mem_free(records);
}

/* As the shader decides, of edges that are no creases. */
static bool is_outline(const float *r, const float viewer[4])
{
    bool front[2];
    for (int k = 0; k < 2; k++) {
        float sum = 0;
        for (int c = 0; c < 3; c++)
            sum += r[8 + 4 * k + c] * (viewer[c] - viewer[3] * 0.5f * (r[c] + r[4 + c]));
        front[k] = sum > 0;
    }
    return ((int)r[3] & RECORD_PAIR) && front[0] != front[1];
}

/* A ball in pieces of 12°: of all of its records those of one viewer are those that may be lines, as they are. */
static void test_seen_ones(void **state)
{
    (void)state;
    enum { ROUND = 30, RINGS = 15, VERTICES = ROUND * (RINGS + 1) };
    static vec3     ball[VERTICES];
    static uint32_t indices[ROUND * RINGS * 6];
    uint32_t        corners = 0;
    for (int i = 0; i < VERTICES; i++) {
        double turn = 6.283185307179586 * (i % ROUND) / ROUND, rise = 3.141592653589793 * (i / ROUND) / RINGS;
        ball[i] = (vec3){(float)(cos(turn) * sin(rise)), (float)cos(rise), (float)(sin(turn) * sin(rise))};
    }
    for (uint32_t i = 0; i < ROUND * RINGS; i++) {
        uint32_t a = i, b = i - i % ROUND + (i + 1) % ROUND, c = b + ROUND, d = a + ROUND;
        memcpy(indices + corners, (uint32_t[]){a, b, c, a, c, d}, 6 * sizeof *indices);
        corners += 6;
    }
    primitive p = {
        .vertex_count = VERTICES, .positions = ball, .index_count = corners, .indices = indices, .material = NONE};
    mesh        m = {.primitives = &p, .primitive_count = 1};
    edge_mesh   e;
    const float viewers[3][4] = {{3, 2, 1, 1}, {0, 0, 5, 1}, {0.3f, 0.9f, -0.3f, 0}};
    assert_int_equal(edge_mesh_create(&e, &m, NULL, 0.7, NULL), LMN_OK);
    float *all = strokes_edge_records(&e);
    for (int v = 0; v < 3; v++) {
        size_t count, at = 0, outlines = 0;
        float *seen = strokes_edge_records_seen(&e, viewers[v], &count);
        for (size_t i = 0; i < strokes_edge_record_count(&e); i++) {
            const float *r = &all[EDGE_RECORD_FLOATS * i];
            bool same = at < count && memcmp(r, &seen[EDGE_RECORD_FLOATS * at], EDGE_RECORD_FLOATS * sizeof *r) == 0;
            assert_true(same || !is_outline(r, viewers[v]));
            outlines += is_outline(r, viewers[v]);
            at += same;
        }
        assert_int_equal(at, count);
        assert_true(outlines > ROUND / 2 && count < strokes_edge_record_count(&e) / 4);
        mem_free(seen);
    }
    mem_free(all);
    edge_mesh_release(&e);
}

/* Who asks for the crossings of some parts gets theirs, with whatever they run through, and no others. */
static void test_crossings_of_some_parts(void **state)
{
    (void)state;
    static const bool wanted[2][3] = {{false, false, true}, {true, false, true}};
    lmn_scene        *s = stroke_scene_begin();
    add_box(s, -1, -1, -1, 1, 1, 1);
    add_box(s, 0, 0, 0, 2, 2, 2);
    add_plate(s, -2, -2, 2, 2, 0.5);
    const double from[3] = {0, 0, 0};
    stroke_shot  shot =
        shoot(s, look_along(-1, -1, -1, from, 20, 3, true, 200, 200), (stroke_options){.contours = CONTOURS_EDGES});
    assert_int_equal(stroke_scene_cross(shot.scene, wanted[0], 3, NULL, NULL, NULL), LMN_OK);
    const size_t some = stroke_scene_crossing_count(shot.scene);
    assert_true(stroke_scene_has_crossings(shot.scene, wanted[0], 3));
    assert_false(stroke_scene_has_crossings(shot.scene, wanted[1], 3));
    assert_false(stroke_scene_has_crossings(shot.scene, NULL, 3));
    assert_int_equal(stroke_scene_cross(shot.scene, wanted[1], 3, NULL, NULL, NULL), LMN_OK);
    const size_t more = stroke_scene_crossing_count(shot.scene);
    assert_int_equal(stroke_scene_cross(shot.scene, NULL, 0, NULL, NULL, NULL), LMN_OK);
    assert_true(stroke_scene_has_crossings(shot.scene, wanted[0], 3));
    assert_true(some > 0 && some < more);                            /* both boxes without their own */
    assert_int_equal(stroke_scene_crossing_count(shot.scene), more); /* all have the first box, or the plate */
    shot_release(&shot);
}

/* Each crossing has one record, with its item's, and the normals of both surfaces. */
static void test_crossings(void **state)
{
    (void)state;
    lmn_scene *s = stroke_scene_begin();
    add_box(s, -1, -1, -1, 1, 1, 1);
    add_box(s, 0, 0, 0, 2, 2, 2);
    add_plate(s, -2, -2, 2, 2, 0.5);
    const double from[3] = {0, 0, 0};
    stroke_shot  shot =
        shoot(s, look_along(-1, -1, -1, from, 20, 3, true, 200, 200), (stroke_options){.contours = CONTOURS_EDGES});
    assert_int_equal(stroke_scene_cross(shot.scene, NULL, 0, NULL, NULL, NULL), LMN_OK);
    size_t all = stroke_scene_crossing_count(shot.scene), found = 0;
    assert_true(all > 10);
    for (uint32_t item = 0; item < 3; item++) {
        size_t count, at = 0;
        float *records = strokes_crossing_records(shot.scene, item, &count);
        for (size_t i = 0; i < all; i++) {
            double ends[2][3];
            vec3   outward[2];
            if (stroke_scene_crossing(shot.scene, i, ends, outward) != item)
                continue;
            const float *r = &records[EDGE_RECORD_FLOATS * at++];
            assert_int_equal((int)r[3], RECORD_CROSSING);
            assert_true(r[0] == (float)ends[0][0] && r[6] == (float)ends[1][2]);
            assert_true(r[8] == outward[0].x && r[9] == outward[0].y && r[10] == outward[0].z);
            assert_true(r[12] == outward[1].x && r[13] == outward[1].y && r[14] == outward[1].z);
        }
        assert_int_equal(at, count);
        found += count;
        mem_free(records);
    }
    assert_int_equal(found, all);
    shot_release(&shot);
}

/* A ribbon of three points, a dot, and a hidden one. */
static void test_ribbons(void **state)
{
    (void)state;
    ribbon_point points[6] = {{10, 20, 0.5f, 7, 1, 1}, {20, 20, 0.6f, 17, 2, 0.5f}, {20, 30, 0.7f, 27, 1, 0},
                              {5, 6, 0.1f, 0, 3, 1},   {0, 0, 0, 0, 1, 1},          {1, 0, 0, 1, 1, 1}};
    ribbon     ribbons[3] = {{.kind = STROKE_CREASE, .first = 0, .count = 3, .end = RIBBON_BUTT, .brush = BRUSH_PENCIL},
                             {.kind = STROKE_CONTOUR, .first = 3, .count = 1},
                             {.kind = STROKE_CONTOUR, .first = 4, .count = 2, .hidden_by = 1}};
    ribbon_set set = {.ribbons = ribbons, .points = points, .ribbon_count = 3, .point_count = 6};
    size_t     count;
    float     *records = strokes_ribbon_records(&set, 100, &count);
    assert_int_equal(count, 4);
    const float first[RIBBON_RECORD_FLOATS - 1] = {10, 80, 0.5f, 1, 20, 80, 0.6f, 2, 1, 0.5f, 1, 1 + 4 * BRUSH_PENCIL,
                                                   0,  10, 20};
    assert_memory_equal(records, first, sizeof first);
    assert_true(records[RIBBON_RECORD_FLOATS + 11] == 2 + 4 * BRUSH_PENCIL && records[RIBBON_RECORD_FLOATS + 13] == 20);
    const float *dot = records + 2 * RIBBON_RECORD_FLOATS, *hidden = records + 3 * RIBBON_RECORD_FLOATS;
    assert_true(dot[0] == 5 && dot[4] == 5 && dot[1] == 94 && dot[10] == 0);
    assert_true(hidden[10] == CHANNEL_HIDDEN);
    mem_free(records);
}

static void test_without_memory(void **state)
{
    (void)state;
    edge_mesh  m;
    ribbon_set none = {0};
    size_t     count;
    make_edges(&m, 36, false);
    mem_fail_at(1);
    assert_null(strokes_edge_records(&m));
    for (long n = 1; n <= 3; n++) {
        mem_fail_at(n);
        assert_null(strokes_edge_records_seen(&m, (const float[4]){3, 2, 1, 1}, &count));
    }
    mem_fail_at(1);
    assert_null(strokes_ribbon_records(&none, 10, &count));
    mem_fail_at(0);
    edge_mesh_release(&m);
}

static void test_what_needs_chains(void **state)
{
    (void)state;
    strokes_values v = {.options = STROKE_OPTIONS_INIT, .style = {.repeats = 1}};
    assert_false(strokes_need_chains(&v));
    strokes_values changed[] = {v, v, v, v, v, v};
    changed[0].style.taper = 1;
    changed[1].common.dash = 1;
    changed[2].options.contours = CONTOURS_SMOOTH;
    changed[3].style.hidden = HIDDEN_SOLID;
    changed[4].style.repeats = 2;
    changed[5].common.halo = 1;
    for (size_t i = 0; i < sizeof changed / sizeof *changed; i++)
        assert_true(strokes_need_chains(&changed[i]));
}

static void test_style(void **state)
{
    (void)state;
    strokes_values v = {.common = {.colour = {1, 0, 0, 1},
                                   .inner_colour = {0, 1, 0, 1},
                                   .id_colour = {0, 0, 1, 1},
                                   .width = 3,
                                   .dash = 4,
                                   .gap = 5,
                                   .overshoot = 6,
                                   .halo = 7},
                        .style = {.hidden = HIDDEN_DASHED}};
    stroke_style   s = strokes_style_of(&v);
    assert_true(s.width == 3 && s.dash == 4 && s.gap == 5 && s.overshoot == 6 && s.halo == 7);
    assert_true(s.colours[STROKE_CONTOUR].r == 1 && s.colours[STROKE_BORDER].r == 1 &&
                s.colours[STROKE_CREASE].g == 1 && s.colours[STROKE_VALLEY].g == 1 &&
                s.colours[STROKE_INTERSECTION].b == 1 && s.colours[STROKE_MATERIAL].b == 1);
    assert_true(strokes_options_of(&v).hidden);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_cube),
        cmocka_unit_test(test_triangle),
        cmocka_unit_test(test_seen_ones),
        cmocka_unit_test(test_crossings),
        cmocka_unit_test(test_crossings_of_some_parts),
        cmocka_unit_test(test_creases_come_first),
        cmocka_unit_test(test_ribbons),
        cmocka_unit_test(test_without_memory),
        cmocka_unit_test(test_what_needs_chains),
        cmocka_unit_test(test_style),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
