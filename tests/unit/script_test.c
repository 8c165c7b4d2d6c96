/* Scripts: what they make, and where they say that something is wrong. */
#include <math.h>

#include "behaviour/evaluate.h"
#include "import_support.h"
#include "scene/behaviour.h"

static const char *script_file_of(const char *name, const char *rest)
{
    static char text[8192];
    snprintf(text, sizeof text,
             "{\"limner_script\": 1,\n\"nodes\": [{\"name\": \"ball\", \"sphere\": {\"radius\": 1}, \"semantics\": "
             "\"ball\"}],\n%s}\n",
             rest);
    return temp_file(name, text, strlen(text));
}

static void test_examples_are_read(void **state)
{
    (void)state;
    lmn_scene *s = load_or_fail(LIMNER_SOURCE_DIR "/examples/scripts/balls.json");
    assert_non_null(s->behaviour);
    assert_int_equal(s->behaviour->written, 0);
    assert_true(fabs(s->animations[0].duration - 4) < 1e-9);
    schedule c;
    assert_int_equal(schedule_create(&c, s, NULL), LMN_OK);
    size_t events = 0;
    for (size_t i = 0; i < c.span_count; i++)
        if (c.nodes[c.spans[i].node].kind == BEHAVIOUR_EVENT) {
            events++;
            assert_true(c.spans[i].from == 3 && c.spans[i].to == 3);
            assert_string_equal(s->nodes[c.nodes[c.spans[i].node].target].name, "blue");
        }
    assert_int_equal(events, 1);
    for (size_t i = 0; i < s->node_count; i++)
        if (s->nodes[i].name && strcmp(s->nodes[i].name, "green") == 0) {
            mat4 world = schedule_world(&c, (int32_t)i, 0.5, SIDE_AT); /* has fallen for half a second */
            assert_true(fabs(world.m[13] - (4 - 9.81 / 8)) < 1e-9 && fabs(world.m[12] - 1) < 1e-9);
        }
    schedule_release(&c);
    lmn_scene_destroy(&s);
    s = load_or_fail(LIMNER_SOURCE_DIR "/examples/scripts/door.json");
    assert_true(fabs(s->animations[0].duration - 2.6) < 1e-6);
    lmn_scene_destroy(&s);
    s = load_or_fail(LIMNER_SOURCE_DIR "/examples/scripts/car.json");
    assert_int_equal(s->animation_count, 4);
    lmn_scene_destroy(&s);
}

/* Sizes are along the script's own axes, whichever of these points up; round things stand on that one. */
static void test_shapes_lie_in_the_axes_of_the_script(void **state)
{
    (void)state;
    static const struct {
        const char *shape, *up;
        double      size[3];
    } rows[] = {
        {"\"box\": {\"size\": [1, 2, 3]}", "y", {1, 2, 3}},
        {"\"box\": {\"size\": [1, 2, 3]}", "z", {1, 2, 3}},
        {"\"plane\": {\"size\": [1, 2]}", "y", {1, 0, 2}},
        {"\"plane\": {\"size\": [1, 2]}", "z", {1, 2, 0}},
        {"\"cylinder\": {\"radius\": 1, \"height\": 5}", "y", {2, 5, 2}},
        {"\"cylinder\": {\"radius\": 1, \"height\": 5}", "z", {2, 2, 5}},
    };
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        char text[512];
        snprintf(text, sizeof text, "{\"limner_script\": 1, \"up\": \"%s\", \"nodes\": [{\"name\": \"it\", %s}]}",
                 rows[i].up, rows[i].shape);
        lmn_scene   *s = load_or_fail(temp_file("axes.json", text, strlen(text)));
        const box3   b = s->meshes[0].primitives[0].bounds;
        const double size[3] = {(double)(b.max.x - b.min.x), (double)(b.max.y - b.min.y), (double)(b.max.z - b.min.z)};
        for (int k = 0; k < 3; k++)
            if (fabs(size[k] - rows[i].size[k]) > 1e-6)
                fail_msg("%s, up %s: %g along axis %d", rows[i].shape, rows[i].up, size[k], k);
        lmn_scene_destroy(&s);
    }
}

/* Two scripts in one scene: each keeps its own nodes. */
static void test_scripts_merge(void **state)
{
    (void)state;
    lmn_scene *s = load_or_fail(LIMNER_SOURCE_DIR "/examples/scripts/balls.json");
    size_t     nodes = s->node_count, activities = s->behaviour->node_count;
    assert_int_equal(lmn_scene_add_file(s, LIMNER_SOURCE_DIR "/examples/scripts/door.json", NULL, NULL), LMN_OK);
    assert_true(s->behaviour->node_count > activities);
    for (size_t i = activities; i < s->behaviour->node_count; i++)
        if (s->behaviour->nodes[i].target != NONE)
            assert_true((size_t)s->behaviour->nodes[i].target >= nodes);
    schedule c;
    assert_int_equal(schedule_create(&c, s, NULL), LMN_OK);
    assert_int_equal(c.property_count, 4);
    schedule_release(&c);
    lmn_scene_destroy(&s);
}

static void test_mistakes_have_places(void **state)
{
    (void)state;
    static const struct {
        const char *text, *words;
        int         line, column;
    } rows[] = {
        {"\"behaviour\": {\"target\": \"bal\",\n \"constant\": [0, 0, 0], \"duration\": 1}", "mean 'ball'", 3, 15},
        {"\"behaviour\": {\"target\": \"ball\",\n \"constant\": [0, 0], \"duration\": 1}", "3 numbers", 4, 2},
        {"\"behaviour\": {\"target\": \"ball\", \"constant\": [0, 0, 0]}", "duration", 3, 1},
        {"\"behaviour\": {\"target\": \"ball\", \"constant\": [0, 0, 0], \"duration\": 0}", "above 0", 3, 1},
        {"\"activities\": {\"a\": {\"reverse\": \"a\"}},\n\"behaviour\": \"a\"", "contains itself", 3, 22},
        {"\"behaviour\": \"b\"", "no activity 'b'", 3, 1},
        {"\"behaviour\": {\"sequence\": []}", "is empty", 3, 1},
        {"\"behaviour\": {\"sequence\": [{\"spin\": 1}]}", "one of sequence", 3, 28},
        {"\"behaviuor\": {}", "not known", 3, 1},
        {"\"behaviour\": {\"clip\": \"walk\"}", "no such clip", 3, 1},
        {"\"behaviour\": {\"target\": \"ball\", \"constant\": [0, 0, 1e999], \"duration\": 1}", "", 3, 0},
        {"\"expressions\": {}", "array", 3, 1},
        {"\"include\": [\"s.json\"]", "includes itself", 3, 13},
        {"\"behaviour\": {\"target\": \"ball\", \"property\": \"fov\", \"constant\": 3, \"duration\": 1}", "no camera",
         3, 15},
        {"\"behaviour\": {\"target\": \"ball\", \"linear\": [[0,0,0],[1,0,0]], \"times\": [0, 0]}", "increase", 3, 1},
        {"\"behaviour\": {\"table\": [{\"start\": -1, \"activity\": {\"event\": \"e\"}}]}", "below 0", 3, 25},
    };
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        lmn_error  error;
        lmn_status status = load_status(script_file_of("s.json", rows[i].text), &error);
        if (status != LMN_FORMAT || !strstr(error.message, rows[i].words) || error.line != rows[i].line ||
            (rows[i].column && error.column != rows[i].column))
            fail_msg("%zu: status %d, %d:%d: %s", i, status, error.line, error.column, error.message);
    }
}

static void test_deep_activities_are_refused(void **state)
{
    (void)state;
    static char whole[40000];
    size_t      used = (size_t)snprintf(whole, sizeof whole, "{\"limner_script\": 1, \"behaviour\": ");
    for (int i = 0; i < 1000; i++)
        used += (size_t)snprintf(whole + used, sizeof whole - used, "{\"reverse\": ");
    used += (size_t)snprintf(whole + used, sizeof whole - used, "{\"event\": \"e\"}");
    for (int i = 0; i < 1001; i++)
        used += (size_t)snprintf(whole + used, sizeof whole - used, "}");
    lmn_error error;
    assert_int_equal(load_status(temp_file("deep.json", whole, strlen(whole)), &error), LMN_LIMIT);
}

static void test_memory_may_end_anywhere(void **state)
{
    (void)state;
    char path[256];
    snprintf(path, sizeof path, "%s", LIMNER_SOURCE_DIR "/examples/scripts/door.json");
    lmn_status status = LMN_MEMORY;
    for (long n = 1; status != LMN_OK; n++) {
        lmn_scene *s = NULL;
        lmn_error  error = {0};
        assert_true(n < 100000);
        assert_int_equal(lmn_scene_create(&s, NULL), LMN_OK);
        mem_fail_at(n);
        status = lmn_scene_add_file(s, path, NULL, &error);
        mem_fail_at(0);
        assert_true(status == LMN_OK || status == LMN_MEMORY);
        lmn_scene_destroy(&s);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_examples_are_read),
        cmocka_unit_test(test_shapes_lie_in_the_axes_of_the_script),
        cmocka_unit_test(test_scripts_merge),
        cmocka_unit_test(test_mistakes_have_places),
        cmocka_unit_test(test_deep_activities_are_refused),
        cmocka_unit_test(test_memory_may_end_anywhere),
    };
    return cmocka_run_group_tests(tests, NULL, remove_temp_folder);
}
