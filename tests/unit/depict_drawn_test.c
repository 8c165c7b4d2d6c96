/* How stills are drawn: what signs and ghost images do to the lines of a picture. */
#include "depict_support.h"

#include "pose/pose.h"
#include "scene/content.h"
#include "stroke/stroke.h"

/* Along how many pieces of line surfaces run through each other now. */
static size_t crossings_of(const lmn_scene *s, double seconds)
{
    moment       when;
    pose         p;
    stroke_scene strokes;
    lmn_error    error = {0};
    assert_int_equal(moment_find(&when, s, NULL, seconds, NULL, &error), LMN_OK);
    assert_int_equal(pose_create(&p, s, &when, &error), LMN_OK);
    bool *shown = calloc(s->part_count + 1, sizeof *shown);
    for (size_t i = 0; i < s->part_count; i++)
        shown[i] = !scene_is_hidden(s, s->parts[i].node);
    assert_int_equal(stroke_scene_create(&strokes, &p, shown, 0.7, NULL, NULL, &error), LMN_OK);
    assert_int_equal(stroke_scene_cross(&strokes, NULL, 0, NULL, NULL, &error), LMN_OK);
    const size_t count = stroke_scene_crossing_count(&strokes);
    stroke_scene_release(&strokes);
    pose_release(&p);
    free(shown);
    return count;
}

/* A bar through a block: both go on by less than their size, so that images of them overlap. */
static const char PIERCED[] =
    "{\"limner_script\": 1, \"nodes\": [{\"name\": \"both\"},"
    "{\"name\": \"block\", \"parent\": \"both\", \"box\": {\"size\": [2, 2, 2]}},"
    "{\"name\": \"bar\", \"parent\": \"both\", \"box\": {\"size\": [5, 0.5, 0.5]}, \"rotation\": {\"axis\": [0, 1, 1], "
    "\"angle\": 20}}],"
    "\"behaviour\": {\"target\": \"both\", \"linear\": [[0, 0, 0], [1.3, 0.7, 0.9]], \"duration\": 2}}";

/* Bodies run through each other, images of them at one time do as they did; images of other times, and arrows, run
 * through nothing. */
static void nothing_runs_through_other_times(void **state)
{
    (void)state;
    lmn_scene   *s = load_or_fail(temp_file("pierced.json", PIERCED, strlen(PIERCED)));
    const size_t alone = crossings_of(s, 1);
    assert_true(alone > 0);
    tell_at(s, 1,
            "[{\"target\": \"both\", \"depict\": \"still\", \"count\": 3}, {\"target\": \"both\", \"depict\": "
            "\"path\"}]");
    assert_int_equal(count_of(s, "still"), 6);
    assert_true(count_of(s, "arrow") > 0);
    assert_int_equal(crossings_of(s, 1), 3 * alone);
    lmn_scene_destroy(&s);
}

static size_t images_of(const lmn_scene *s, const char *when, size_t *triangles)
{
    size_t count = 0;
    for (const primitive *p; (p = glyph_at(s, "still", when, count)) != NULL; count++)
        *triangles = p->index_count / 3;
    return count;
}

/* A pendulum is told with all of it, though what lies at its hinge has gone less far than its tip. */
static void what_keeps_its_form_is_not_torn(void **state)
{
    (void)state;
    static const char text[] =
        "{\"limner_script\": 1, \"nodes\": [{\"name\": \"hinge\"}, {\"name\": \"bar\", \"parent\": \"hinge\", "
        "\"box\": {\"size\": [4, 0.3, 0.3]}, \"translation\": [2, 0, 0]}, {\"name\": \"stub\", \"parent\": \"hinge\", "
        "\"box\": {\"size\": [0.5, 0.5, 0.5]}}], \"behaviour\": {\"target\": \"hinge\", \"property\": "
        "\"rotation\", \"axis\": [0, 0, 1], \"linear\": [0, 120], \"duration\": 2}}";
    lmn_scene *s = load_or_fail(temp_file("pendulum.json", text, strlen(text)));
    tell_at(s, 1, "[{\"target\": \"hinge\", \"depict\": \"still\", \"count\": 3, \"least\": 0.6}]");
    size_t triangles = 0;
    assert_int_equal(images_of(s, "past", &triangles), 1); /* the stub stays */
    assert_int_equal(triangles, 12);
    tell_at(s, 1, "[{\"target\": \"hinge\", \"depict\": \"still\", \"count\": 3}]");
    assert_int_equal(images_of(s, "past", &triangles), 2);
    lmn_scene_destroy(&s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(nothing_runs_through_other_times),
        cmocka_unit_test(what_keeps_its_form_is_not_torn),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
