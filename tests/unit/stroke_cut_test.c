/* Strokes of sections: lines and what hides them end where the section does, and cut faces have rims. */
#include "stroke_shapes.h"

#include "base/memory.h"
#include "cut/cut.h"
#include "pose/pose.h"
#include "stroke/form_surface.h"
#include "stroke/hatch.h"

/* A box and a ball, a half of both cut away. */
static stroke_scene make(const char *spec, bool spare)
{
    lmn_scene *s = stroke_scene_begin();
    add_box(s, -1, -1, -1, 1, 1, 1);
    add_ball(s, 0, 3, 0, 0.5, 24, 12);
    assert_int_equal(scene_finish(s, "test", NULL), LMN_OK);
    pose              at_rest;
    cut               c;
    bool              spared[2] = {spare, spare};
    stroke_scene      out;
    stroke_topologies kept = {NULL};
    assert_int_equal(pose_create(&at_rest, s, &(moment){.seconds = 0}, NULL), LMN_OK);
    assert_int_equal(cut_parse(&c, spec, (box3){{-1, -1, -1}, {1, 3.5f, 1}}, NULL), LMN_OK);
    stroke_section section = {&c, spared};
    assert_int_equal(stroke_scene_create_keeping(&out, &at_rest, NULL, 0.5, 0, &kept, &section, NULL), LMN_OK);
    stroke_topologies_release(&kept);
    pose_release(&at_rest);
    lmn_scene_destroy(&s);
    return out;
}

static void sections_leave_rims(void **state)
{
    (void)state;
    stroke_scene s = make("x=0.13", false);
    assert_int_equal(s.item_count, 2);
    for (size_t i = 0; i < s.item_count; i++) {
        const edge_mesh *m = &s.meshes[s.items[i].mesh];
        uint32_t         rims = 0;
        for (uint32_t e = 0; e < m->edge_count; e++)
            rims += (m->edges[e].flags & (EDGE_MATERIAL | EDGE_BORDER)) != 0;
        assert_true(rims >= 4); /* around the cut face */
        for (uint32_t e = 0; e < m->edge_count; e++)
            for (int k = 0; k < 2; k++) {
                float x = m->positions[m->edges[e].vertex[k]].x;
                assert_true(x < 0.131f);
                assert_true(!(m->edges[e].flags & EDGE_BORDER) || x > 0.129f); /* open at most along the rim */
            }
    }
    stroke_scene_release(&s);
}

static void what_is_gone_or_spared(void **state)
{
    (void)state;
    stroke_scene s = make("y=1.5", false); /* the ball is gone, the box whole */
    assert_int_equal(s.item_count, 1);
    assert_int_equal(s.meshes[s.items[0].mesh].vertex_count, 8);
    stroke_scene_release(&s);
    s = make("x=0.13", true);
    assert_int_equal(s.item_count, 2);
    assert_int_equal(s.meshes[s.items[0].mesh].vertex_count, 8);
    stroke_scene_release(&s);
}

/* Is a position in what loops run around? How often a ray to the right is crossed. */
static bool is_within(const hatch_areas *a, const hatch_area *area, double x, double y)
{
    bool in = false;
    for (uint32_t l = area->first; l < area->first + area->count; l++)
        for (uint32_t i = a->loops[l]; i < a->loops[l + 1]; i++) {
            const float *p = a->points[i], *q = a->points[i + 1 < a->loops[l + 1] ? i + 1 : a->loops[l]];
            if (((double)p[1] > y) != ((double)q[1] > y) &&
                x < (double)p[0] + (y - (double)p[1]) / ((double)q[1] - (double)p[1]) * ((double)q[0] - (double)p[0]))
                in = !in;
        }
    return in;
}

static double size_of(const hatch_areas *a, const hatch_area *area)
{
    double sum = 0;
    for (uint32_t l = area->first; l < area->first + area->count; l++)
        for (uint32_t i = a->loops[l]; i < a->loops[l + 1]; i++) {
            const float *p = a->points[i], *q = a->points[i + 1 < a->loops[l + 1] ? i + 1 : a->loops[l]];
            sum += 0.5 * ((double)p[0] * (double)q[1] - (double)q[0] * (double)p[1]);
        }
    return fabs(sum);
}

/* Filled with the area's lines, an area looks as its lines do one by one: each of these is one of those, and ends where
 * the area does. What is hidden in part is none. */
static void areas_have_the_same_lines(void **state)
{
    (void)state;
    for (int k = 0; k < 3; k++) {
        const bool    flat = k != 1;
        stroke_scene  scene = make("x=0.13", false);
        stroke_camera camera = look_along(-1, k == 2 ? -0.8 : 0.3, 0.2, (const double[3]){0.13, 1.5, 0}, 20,
                                          flat ? 3 : 0.15, flat, 900, 900);
        stroke_view  *v;
        hatch_lines   lines;
        hatch_areas   areas;
        double        sizes[3] = {0}, lengths[3] = {0};
        assert_int_equal(stroke_view_create(&v, &scene, &camera, NULL, NULL, NULL), LMN_OK);
        assert_int_equal(hatch_find(&lines, &areas, v, 5, 0.7, NULL, NULL), LMN_OK);
        assert_int_equal(areas.count, 2);
        for (size_t i = 0; i < areas.count; i++)
            sizes[areas.items[i].part] = size_of(&areas, &areas.items[i]);
        for (size_t i = 0; i < lines.count; i++) {
            const hatch_line *l = &lines.items[i];
            const hatch_area *a = &areas.items[l->area - 1];
            double            x = (double)l->ends[0][0], y = (double)l->ends[0][1], dx = (double)l->ends[1][0] - x,
                   dy = (double)l->ends[1][1] - y, length = hypot(dx, dy);
            assert_true(l->area > 0 && a->part == l->part);
            if (length < 1)
                continue;
            double across = ((x - a->origin[0]) * -sin(a->angle) + (y - a->origin[1]) * cos(a->angle)) / a->apart;
            assert_true(fabs(across - round(across)) < 2e-3);
            assert_true(fabs(dx * sin(a->angle) - dy * cos(a->angle)) < 2e-3 * length);
            for (int n = 0; n < 20; n++)
                assert_true(is_within(&areas, a, x + dx * (n + 0.5) / 20, y + dy * (n + 0.5) / 20));
            for (int end = 0; end < 2; end++) {
                double beyond = end ? 1 + 0.2 / length : -0.2 / length;
                assert_false(is_within(&areas, a, x + dx * beyond, y + dy * beyond));
            }
            lengths[l->part] += length * a->apart;
        }
        for (int part = 1; part <= 2; part++)
            assert_true(fabs(lengths[part] - sizes[part]) < 0.01 * sizes[part]);
        mem_free(lines.items);
        hatch_areas_release(&areas);
        stroke_view_destroy(&v);
        stroke_scene_release(&scene);
    }
}

/* Where something that stays whole is in front of a part of a cut face, its lines are no area's. */
static void what_is_hidden_has_lines(void **state)
{
    (void)state;
    lmn_scene *s = stroke_scene_begin();
    add_box(s, -1, -1, -1, 1, 1, 1);
    add_ball(s, 0.4, 0.3, 0, 0.5, 24, 12);
    assert_int_equal(scene_finish(s, "test", NULL), LMN_OK);
    pose              at_rest;
    cut               c;
    const bool        spared[2] = {false, true};
    stroke_scene      scene;
    stroke_topologies kept = {NULL};
    assert_int_equal(pose_create(&at_rest, s, &(moment){.seconds = 0}, NULL), LMN_OK);
    assert_int_equal(cut_parse(&c, "x=0.13", (box3){{-1, -1, -1}, {2.5f, 1, 1}}, NULL), LMN_OK);
    stroke_section section = {&c, spared};
    assert_int_equal(stroke_scene_create_keeping(&scene, &at_rest, NULL, 0.5, 0, &kept, &section, NULL), LMN_OK);
    stroke_camera camera = look_along(-1, 0, 0, (const double[3]){0.13, 0, 0}, 20, 3, true, 900, 900);
    stroke_view  *v;
    hatch_lines   lines;
    hatch_areas   areas;
    assert_int_equal(stroke_view_create(&v, &scene, &camera, NULL, NULL, NULL), LMN_OK);
    assert_int_equal(hatch_find(&lines, &areas, v, 5, 0.7, NULL, NULL), LMN_OK);
    assert_true(lines.count > 50 && areas.count == 0);
    for (size_t i = 0; i < lines.count; i++)
        assert_int_equal(lines.items[i].area, 0);
    mem_free(lines.items);
    hatch_areas_release(&areas);
    stroke_view_destroy(&v);
    stroke_scene_release(&scene);
    stroke_topologies_release(&kept);
    pose_release(&at_rest);
    lmn_scene_destroy(&s);
}

/* A cut face is no piece of a surface that is sampled: with normals that lean over to its rim it had outlines. */
static void cut_faces_of_samplings_are_flat(void **state)
{
    (void)state;
    lmn_scene *s = stroke_scene_begin();
    add_ball(s, 0, 0, 0, 1, 240, 120);
    assert_int_equal(scene_finish(s, "test", NULL), LMN_OK);
    pose              at_rest;
    cut               c;
    const bool        spared[1] = {false};
    stroke_scene      scene;
    stroke_topologies kept = {NULL};
    form_surface      surface;
    uint32_t          caps = 0;
    assert_int_equal(pose_create(&at_rest, s, &(moment){.seconds = 0}, NULL), LMN_OK);
    assert_int_equal(cut_parse(&c, "x=0.13", (box3){{-1, -1, -1}, {1, 1, 1}}, NULL), LMN_OK);
    stroke_section section = {&c, spared};
    assert_int_equal(stroke_scene_create_keeping(&scene, &at_rest, NULL, 0.5, 0, &kept, &section, NULL), LMN_OK);
    edge_mesh *m = &scene.meshes[0];
    assert_non_null(m->materials);
    m->sampling = (edge_sampling){true, 0.05f, 0.02f}; /* the ball's quads are too even to pass for one */
    assert_int_equal(form_surface_make(&surface, m, false, NULL), LMN_OK);
    for (uint32_t f = 0; f < m->face_count; f++) {
        if (m->materials[f] > EDGE_CAP_MATERIAL(0))
            continue;
        caps++;
        for (int k = 0; k < 3; k++)
            assert_true(surface.calm_normals[surface.corners[f][k]].x > 0.999f);
    }
    assert_true(caps > 100);
    form_surface_release(&surface);
    stroke_scene_release(&scene);
    stroke_topologies_release(&kept);
    pose_release(&at_rest);
    lmn_scene_destroy(&s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(sections_leave_rims), cmocka_unit_test(what_is_gone_or_spared),
                                       cmocka_unit_test(areas_have_the_same_lines),
                                       cmocka_unit_test(what_is_hidden_has_lines),
                                       cmocka_unit_test(cut_faces_of_samplings_are_flat)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
