/* Strokes of sections: lines and what hides them end where the section does, and cut faces have rims. */
#include "stroke_shapes.h"

#include "base/memory.h"
#include "cut/cut.h"
#include "pose/pose.h"

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

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(sections_leave_rims), cmocka_unit_test(what_is_gone_or_spared)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
