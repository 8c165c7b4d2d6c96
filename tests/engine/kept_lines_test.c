/* Lines of a view are found once, also where layers or rules with pens of their own ask for unlike ones by turns. */
#include "checked.h"

#include "draw/session.h"
#include "stage/stroke_store.h"

/* Where the points of what was found lie. Returns how many were found. */
static int found_in(const lmn_renderer *r, int slot, const void *points[STROKES_FOUND_MOST])
{
    int                 count = 0;
    const stroke_store *s = r->up.strokes[slot];
    assert_non_null(s);
    for (int i = 0; i < STROKES_FOUND_MOST; i++) {
        points[i] = s->found[i].lines.points;
        count += s->found[i].parts != NULL;
    }
    return count;
}

static void draw(lmn_renderer *r, const lmn_scene *s, const lmn_look *look, double eye)
{
    lmn_drawing  *drawing = NULL;
    lmn_draw_desc desc = LMN_DRAW_DESC_INIT;
    desc.width = desc.height = 120;
    desc.eye_given = true;
    desc.fit_direction = true;
    desc.eye[0] = eye;
    desc.eye[1] = desc.eye[2] = 1;
    DO(lmn_draw(&drawing, r, s, look, &desc, &error));
    lmn_drawing_destroy(&drawing);
}

static void unlike_lines_are_kept_beside_each_other(void **state)
{
    (void)state;
    const void   *first[STROKES_FOUND_MOST], *second[STROKES_FOUND_MOST];
    lmn_renderer *r = NULL;
    lmn_scene    *s = NULL;
    lmn_look     *look = NULL;
    DO(lmn_renderer_create(&r, NULL, &error));
    DO(lmn_scene_create(&s, &error));
    DO(lmn_scene_add_file(s, EXAMPLES "/pump.glb", NULL, &error));
    DO(lmn_look_load(&look, "blueprint", &error)); /* hidden lines have a finer pen */
    draw(r, s, look, 1);
    assert_int_equal(found_in(r, STROKES_SEEN_THROUGH, first), 2);
    draw(r, s, look, 1);
    assert_int_equal(found_in(r, STROKES_SEEN_THROUGH, second), 2);
    assert_memory_equal(first, second, sizeof first);
    draw(r, s, look, 2);
    assert_int_equal(found_in(r, STROKES_SEEN_THROUGH, second), 2); /* of this view alone */
    lmn_look_destroy(&look);
    lmn_scene_destroy(&s);
    lmn_renderer_destroy(&r);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(unlike_lines_are_kept_beside_each_other)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
