/* What is wrong with behaviours, in scripts and in calls alike: both are refused, in the same words. */
#include <math.h>

#include "import_support.h"
#include "limner/behaviour.h"
#include "limner/content.h"
#include "scene/behaviour.h"

static lmn_status script_status(const char *behaviour, lmn_error *error, lmn_scene **out)
{
    static char text[4 << 20];
    snprintf(text, sizeof text,
             "{\"limner_script\": 1, \"nodes\": [{\"name\": \"ball\", \"sphere\": {\"radius\": 1}}],\n%s}", behaviour);
    const char *path = temp_file("s.json", text, strlen(text));
    lmn_status  status = lmn_scene_create(out, NULL);
    return status == LMN_OK ? lmn_scene_add_file(*out, path, NULL, error) : status;
}

/* --- calls --------------------------------------------------------------------------------------------------- */

static lmn_constraint_desc constant(void)
{
    static const double place[] = {0, 1, 0, 2, 2, 2};
    lmn_constraint_desc desc = LMN_CONSTRAINT_DESC_INIT;
    desc.node = 1;
    desc.values = place;
    desc.value_count = 1;
    desc.duration_s = 1;
    return desc;
}

static lmn_status group(lmn_scene *s, lmn_activity_kind kind, const lmn_activity_child *children, size_t count,
                        double duration, uint32_t *out, lmn_error *error)
{
    lmn_activity_desc desc = LMN_ACTIVITY_DESC_INIT;
    desc.kind = kind;
    desc.children = children;
    desc.child_count = count;
    desc.duration_s = duration;
    return lmn_behaviour_add(s, &desc, out, error);
}

/* Adds the constraint and plays it. */
static lmn_status play_one(lmn_scene *s, const lmn_constraint_desc *desc, lmn_error *error)
{
    uint32_t   one = 0;
    lmn_status status = lmn_behaviour_add_constraint(s, desc, &one, error);
    return status == LMN_OK ? lmn_behaviour_play(s, &one, 1, error) : status;
}

static lmn_status in_group(lmn_scene *s, lmn_activity_kind kind, double start, double row, double duration,
                           lmn_error *error)
{
    lmn_constraint_desc desc = constant();
    lmn_activity_child  child = {0, start, row};
    uint32_t            whole = 0;
    lmn_status          status = lmn_behaviour_add_constraint(s, &desc, &child.activity, error);
    if (status == LMN_OK)
        status = group(s, kind, &child, 1, duration, &whole, error);
    return status == LMN_OK ? lmn_behaviour_play(s, &whole, 1, error) : status;
}

static lmn_status cycle(lmn_scene *s, lmn_error *error)
{
    lmn_constraint_desc desc = constant();
    uint32_t            one = 0, a = 0, b = 0;
    lmn_behaviour_add_constraint(s, &desc, &one, NULL);
    lmn_activity_child child = {one, 0, 0};
    group(s, LMN_ACTIVITY_REVERSE, &child, 1, 0, &a, NULL);
    child.activity = a;
    group(s, LMN_ACTIVITY_SEQUENCE, &child, 1, 0, &b, NULL);
    lmn_activity_desc again = LMN_ACTIVITY_DESC_INIT;
    child.activity = b;
    again.kind = LMN_ACTIVITY_REVERSE;
    again.children = &child;
    again.child_count = 1;
    lmn_behaviour_set(s, a, &again, NULL);
    return lmn_behaviour_play(s, &b, 1, error);
}

static lmn_status unknown_target(lmn_scene *s, lmn_error *error)
{
    lmn_constraint_desc desc = constant();
    desc.node = 7;
    return play_one(s, &desc, error);
}

static lmn_status no_duration(lmn_scene *s, lmn_error *error)
{
    lmn_constraint_desc desc = constant();
    desc.duration_s = 0;
    return play_one(s, &desc, error);
}

static lmn_status negative_duration(lmn_scene *s, lmn_error *error)
{
    lmn_constraint_desc desc = constant();
    desc.duration_s = -2;
    return play_one(s, &desc, error);
}

static lmn_status endless(lmn_scene *s, lmn_error *error)
{
    lmn_constraint_desc desc = constant();
    desc.duration_s = 1e12;
    return play_one(s, &desc, error);
}

static lmn_status negative_start(lmn_scene *s, lmn_error *error)
{
    return in_group(s, LMN_ACTIVITY_TABLE, -1, 0, 0, error);
}

static lmn_status negative_row(lmn_scene *s, lmn_error *error)
{
    return in_group(s, LMN_ACTIVITY_TABLE, 0, -1, 0, error);
}

static lmn_status empty(lmn_scene *s, lmn_error *error)
{
    uint32_t whole = 0;
    return group(s, LMN_ACTIVITY_SEQUENCE, NULL, 0, 0, &whole, error);
}

static lmn_status event_alone_lasts(lmn_scene *s, lmn_error *error)
{
    lmn_activity_desc event = LMN_ACTIVITY_DESC_INIT;
    uint32_t          whole = 0;
    event.kind = LMN_ACTIVITY_EVENT;
    lmn_activity_child child = {0, 0, 0};
    lmn_status         status = lmn_behaviour_add(s, &event, &child.activity, error);
    if (status == LMN_OK)
        status = group(s, LMN_ACTIVITY_SEQUENCE, &child, 1, 2, &whole, error);
    return status == LMN_OK ? lmn_behaviour_play(s, &whole, 1, error) : status;
}

static lmn_status no_camera(lmn_scene *s, lmn_error *error)
{
    lmn_constraint_desc desc = constant();
    desc.property = LMN_PROPERTY_CAMERA_FOV;
    return play_one(s, &desc, error);
}

static lmn_status no_weights(lmn_scene *s, lmn_error *error)
{
    lmn_constraint_desc desc = constant();
    desc.property = LMN_PROPERTY_WEIGHTS;
    return play_one(s, &desc, error);
}

static lmn_status no_property(lmn_scene *s, lmn_error *error)
{
    lmn_constraint_desc desc = constant();
    desc.property = (lmn_property)99;
    return play_one(s, &desc, error);
}

static lmn_status not_finite(lmn_scene *s, lmn_error *error)
{
    const double        values[] = {0, NAN, 0};
    lmn_constraint_desc desc = constant();
    desc.values = values;
    return play_one(s, &desc, error);
}

static lmn_status curve_of(lmn_scene *s, lmn_curve_kind kind, bool closed, size_t count, lmn_error *error)
{
    static const double points[30];
    lmn_constraint_desc desc = constant();
    desc.map = LMN_TIME_MAP_CURVE;
    desc.curve = kind;
    desc.closed = closed;
    desc.values = points;
    desc.value_count = count;
    return play_one(s, &desc, error);
}

static lmn_status five_bezier(lmn_scene *s, lmn_error *error)
{
    return curve_of(s, LMN_CURVE_BEZIER, false, 5, error);
}

static lmn_status closed_pair(lmn_scene *s, lmn_error *error)
{
    return curve_of(s, LMN_CURVE_CATMULL_ROM, true, 2, error);
}

static lmn_status times_back(lmn_scene *s, lmn_error *error)
{
    static const double times[] = {0, 0};
    lmn_constraint_desc desc = constant();
    desc.map = LMN_TIME_MAP_LINEAR;
    desc.value_count = 2;
    desc.times_s = times;
    return play_one(s, &desc, error);
}

static lmn_status restitution(lmn_scene *s, lmn_error *error)
{
    lmn_constraint_desc desc = constant();
    desc.map = LMN_TIME_MAP_BOUNCE;
    desc.restitution = 2;
    return play_one(s, &desc, error);
}

static lmn_status never_at_rest(lmn_scene *s, lmn_error *error)
{
    lmn_constraint_desc desc = constant();
    desc.map = LMN_TIME_MAP_BOUNCE;
    desc.restitution = 0.999999;
    desc.duration_s = 0;
    return play_one(s, &desc, error);
}

static lmn_status spin_of_place(lmn_scene *s, lmn_error *error)
{
    lmn_constraint_desc desc = constant();
    desc.map = LMN_TIME_MAP_SPIN;
    return play_one(s, &desc, error);
}

static lmn_status follows_itself(lmn_scene *s, lmn_error *error)
{
    lmn_constraint_desc desc = constant();
    desc.map = LMN_TIME_MAP_FOLLOW;
    desc.follows = 1;
    return play_one(s, &desc, error);
}

static lmn_status repeats(lmn_scene *s, uint32_t times, lmn_error *error)
{
    lmn_constraint_desc desc = constant();
    lmn_activity_child  child = {0, 0, 0};
    lmn_activity_desc   repeat = LMN_ACTIVITY_DESC_INIT;
    uint32_t            whole = 0;
    lmn_behaviour_add_constraint(s, &desc, &child.activity, NULL);
    repeat.kind = LMN_ACTIVITY_REPEAT;
    repeat.times = times;
    repeat.children = &child;
    repeat.child_count = 1;
    return lmn_behaviour_add(s, &repeat, &whole, error);
}

static lmn_status never(lmn_scene *s, lmn_error *error)
{
    return repeats(s, 0, error);
}

static lmn_status too_often(lmn_scene *s, lmn_error *error)
{
    return repeats(s, 2000000, error);
}

static lmn_status no_clip(lmn_scene *s, lmn_error *error)
{
    lmn_activity_desc desc = LMN_ACTIVITY_DESC_INIT;
    desc.kind = LMN_ACTIVITY_CLIP;
    desc.clip = "walk";
    return lmn_behaviour_add(s, &desc, NULL, error);
}

static lmn_status unknown_activity(lmn_scene *s, lmn_error *error)
{
    const uint32_t none = 5;
    return lmn_behaviour_play(s, &none, 1, error);
}

/* --- both ways ----------------------------------------------------------------------------------------------- */

#define BALL "\"behaviour\": {\"target\": \"ball\", "

static void test_both_ways_refuse_the_same(void **state)
{
    (void)state;
    static const struct {
        const char *script;
        lmn_status (*call)(lmn_scene *s, lmn_error *error);
        const char *words, *other; /* of both; or of calls alone, where a number stands for a name */
    } rows[] = {
        {"\"activities\": {\"a\": {\"reverse\": \"b\"}, \"b\": {\"sequence\": [\"a\"]}}, \"behaviour\": \"b\"", cycle,
         "contains itself", NULL},
        {"\"behaviour\": {\"target\": \"bell\", \"constant\": [0, 1, 0], \"duration\": 1}", unknown_target, "ball",
         "no node 7"},
        {BALL "\"constant\": [0, 1, 0]}", no_duration, "has to be told its duration", NULL},
        {BALL "\"constant\": [0, 1, 0], \"duration\": -2}", negative_duration, "a duration has to be above 0", NULL},
        {BALL "\"constant\": [0, 1, 0], \"duration\": 1e12}", endless, "at most 1e9", NULL},
        {"\"behaviour\": {\"table\": [{\"start\": -1, \"activity\": {\"event\": \"e\"}}]}", negative_start,
         "a start must not be below 0", NULL},
        {"\"behaviour\": {\"table\": [{\"start\": 0, \"duration\": -1, \"activity\": {\"event\": \"e\"}}]}",
         negative_row, "a duration has to be above 0", NULL},
        {"\"behaviour\": {\"sequence\": []}", empty, "is empty", NULL},
        {"\"behaviour\": {\"sequence\": [{\"event\": \"e\"}], \"duration\": 2}", event_alone_lasts,
         "nothing in it that lasts", NULL},
        {BALL "\"property\": \"fov\", \"constant\": 3, \"duration\": 1}", no_camera, "no camera", NULL},
        {BALL "\"property\": \"weights\", \"constant\": [], \"duration\": 1}", no_weights, "morph weights", NULL},
        {BALL "\"property\": \"size\", \"constant\": [1, 1, 1], \"duration\": 1}", no_property, "property", NULL},
        {BALL "\"constant\": [0, 1e19, 0], \"duration\": 1}", not_finite, "not finite, or beyond 1e18", NULL},
        {BALL "\"curve\": {\"kind\": \"bezier\", \"points\": [[0,0,0],[0,0,0],[0,0,0],[0,0,0],[0,0,0]]}, "
              "\"duration\": 1}",
         five_bezier, "needs 4, 7, 10", NULL},
        {BALL "\"curve\": {\"closed\": true, \"points\": [[0,0,0],[1,0,0]]}, \"duration\": 1}", closed_pair,
         "three points or more", NULL},
        {BALL "\"linear\": [[0,1,0],[2,2,2]], \"times\": [0, 0], \"duration\": 1}", times_back,
         "do not begin at 0 and increase", NULL},
        {BALL "\"function\": \"bounce\", \"restitution\": 2, \"duration\": 1}", restitution, "outside 0 to 1", NULL},
        {BALL "\"function\": \"bounce\", \"start\": [0, 5, 0], \"restitution\": 0.999999}", never_at_rest,
         "told its duration", NULL},
        {BALL "\"function\": \"spin\", \"duration\": 1}", spin_of_place, "property", NULL},
        {BALL "\"function\": \"follow\", \"node\": \"ball\", \"duration\": 1}", follows_itself, "follow itself", NULL},
        {"\"behaviour\": {\"repeat\": {"
         "\"target\": \"ball\", \"constant\": [0, 1, 0], \"duration\": 1}, \"times\": 0}",
         never, "repeats 0 times", NULL},
        {"\"behaviour\": {\"repeat\": {"
         "\"target\": \"ball\", \"constant\": [0, 1, 0], \"duration\": 1}, "
         "\"times\": 2000000}",
         too_often, "repeats 2000000 times", NULL},
        {"\"behaviour\": {\"clip\": \"walk\"}", no_clip, "no such clip", "no animation"},
        {"\"behaviour\": \"walk\"", unknown_activity, "no activity", NULL},
    };
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        lmn_scene    *s = NULL;
        lmn_error     error = {0};
        lmn_node_desc node = LMN_NODE_DESC_INIT;
        lmn_status    status = script_status(rows[i].script, &error, &s);
        if (status != LMN_FORMAT || !strstr(error.message, rows[i].words) || error.line != 2)
            fail_msg("script %zu: status %d, line %d: %s", i, status, error.line, error.message);
        lmn_scene_destroy(&s);
        memset(&error, 0, sizeof error);
        assert_int_equal(lmn_scene_create(&s, NULL), LMN_OK);
        assert_int_equal(lmn_scene_add_node(s, &node, NULL, NULL), LMN_OK);
        status = rows[i].call(s, &error);
        if (status != LMN_USAGE || error.status != LMN_USAGE ||
            !strstr(error.message, rows[i].other ? rows[i].other : rows[i].words))
            fail_msg("call %zu: status %d: %s", i, status, error.message);
        assert_int_equal(s->animation_count, 0); /* nothing plays */
        lmn_scene_destroy(&s);
    }
}

/* Of those that drive one thing at one time the later one wins, in both ways. */
static void test_times_may_overlap(void **state)
{
    (void)state;
    lmn_scene *script = NULL, *s = NULL;
    lmn_error  error = {0};
    if (script_status(
            "\"behaviour\": {\"table\": ["
            "{\"start\": 0, \"activity\": {\"target\": \"ball\", \"constant\": [0, 1, 0], \"duration\": 2}},"
            "{\"start\": 1, \"activity\": {\"target\": \"ball\", \"constant\": [0, 2, 0], \"duration\": 2}}]}",
            &error, &script) != LMN_OK)
        fail_msg("%s", error.message);
    static const double values[] = {0, 1, 0, 0, 2, 0};
    lmn_activity_child  rows[2] = {{0, 0, 0}, {0, 1, 0}};
    lmn_node_desc       node = LMN_NODE_DESC_INIT;
    uint32_t            whole = 0;
    assert_int_equal(lmn_scene_create(&s, NULL), LMN_OK);
    assert_int_equal(lmn_scene_add_node(s, &node, NULL, NULL), LMN_OK);
    for (int i = 0; i < 2; i++) {
        lmn_constraint_desc desc = constant();
        desc.values = values + 3 * i;
        desc.duration_s = 2;
        assert_int_equal(lmn_behaviour_add_constraint(s, &desc, &rows[i].activity, NULL), LMN_OK);
    }
    assert_int_equal(group(s, LMN_ACTIVITY_TABLE, rows, 2, 0, &whole, NULL), LMN_OK);
    assert_int_equal(lmn_behaviour_play(s, &whole, 1, NULL), LMN_OK);
    const uint32_t      ball = lmn_scene_node_of_part(script, 1);
    static const double times[] = {0, 0.5, 1, 1.5, 2, 2.5, 3}, heights[] = {1, 1, 2, 2, 2, 2, 2};
    for (int way = 0; way < 2; way++) {
        lmn_dynamics *d = NULL;
        assert_int_equal(lmn_dynamics_create(way ? s : script, NULL, &d, NULL), LMN_OK);
        for (int i = 0; i < 7; i++) {
            lmn_point_state at;
            assert_int_equal(lmn_dynamics_point(d, way ? 1 : ball, NULL, times[i], &at, NULL), LMN_OK);
            assert_true(at.position[1] == heights[i]);
        }
        lmn_dynamics_destroy(&d);
    }
    lmn_scene_destroy(&script);
    lmn_scene_destroy(&s);
}

static void test_ten_thousand_activities_are_taken(void **state)
{
    (void)state;
    enum { MANY = 10000 };
    static char text[3 << 20];
    lmn_scene  *script = NULL, *s = NULL;
    lmn_error   error = {0};
    size_t      used = (size_t)snprintf(text, sizeof text, "\"behaviour\": {\"sequence\": [");
    for (int i = 0; i < MANY; i++)
        used += (size_t)snprintf(text + used, sizeof text - used,
                                 "%s{\"target\": \"ball\", \"constant\": [0, %d, 0], \"duration\": 0.01}\n",
                                 i ? "," : "", i);
    snprintf(text + used, sizeof text - used, "]}");
    if (script_status(text, &error, &script) != LMN_OK)
        fail_msg("%s", error.message);
    static lmn_activity_child children[MANY];
    lmn_node_desc             node = LMN_NODE_DESC_INIT;
    uint32_t                  whole = 0;
    assert_int_equal(lmn_scene_create(&s, NULL), LMN_OK);
    assert_int_equal(lmn_scene_add_node(s, &node, NULL, NULL), LMN_OK);
    for (int i = 0; i < MANY; i++) {
        const double        value[] = {0, i, 0};
        lmn_constraint_desc desc = constant();
        desc.values = value;
        desc.duration_s = 0.01;
        assert_int_equal(lmn_behaviour_add_constraint(s, &desc, &children[i].activity, NULL), LMN_OK);
    }
    assert_int_equal(group(s, LMN_ACTIVITY_SEQUENCE, children, MANY, 0, &whole, NULL), LMN_OK);
    assert_int_equal(lmn_behaviour_play(s, &whole, 1, NULL), LMN_OK);
    assert_int_equal(lmn_behaviour_count(s), MANY + 1);
    assert_int_equal(lmn_behaviour_count(script), MANY + 1);
    assert_true(fabs(s->animations[0].duration - script->animations[0].duration) < 1e-6); /* keys are floats */
    lmn_scene_destroy(&script);
    lmn_scene_destroy(&s);
}

static void test_a_thousand_levels_are_too_many(void **state)
{
    (void)state;
    enum { LEVELS = 1000 };
    static char text[LEVELS * 16];
    lmn_scene  *s = NULL;
    lmn_error   error = {0};
    size_t      used = (size_t)snprintf(text, sizeof text, "\"behaviour\": ");
    for (int i = 0; i < LEVELS; i++)
        used += (size_t)snprintf(text + used, sizeof text - used, "{\"reverse\":");
    used += (size_t)snprintf(text + used, sizeof text - used, "{\"event\": \"e\"}");
    for (int i = 0; i < LEVELS; i++)
        used += (size_t)snprintf(text + used, sizeof text - used, "}");
    assert_int_equal(script_status(text, &error, &s), LMN_LIMIT);
    assert_non_null(strstr(error.message, "256 levels"));
    lmn_scene_destroy(&s);
    lmn_node_desc node = LMN_NODE_DESC_INIT;
    assert_int_equal(lmn_scene_create(&s, NULL), LMN_OK);
    assert_int_equal(lmn_scene_add_node(s, &node, NULL, NULL), LMN_OK);
    lmn_constraint_desc desc = constant();
    lmn_activity_child  child = {0, 0, 0};
    assert_int_equal(lmn_behaviour_add_constraint(s, &desc, &child.activity, NULL), LMN_OK);
    for (int i = 0; i < LEVELS; i++)
        assert_int_equal(group(s, LMN_ACTIVITY_REVERSE, &child, 1, 0, &child.activity, NULL), LMN_OK);
    assert_int_equal(lmn_behaviour_play(s, &child.activity, 1, &error), LMN_LIMIT);
    assert_non_null(strstr(error.message, "256 levels"));
    assert_int_equal(s->animation_count, 0);
    lmn_scene_destroy(&s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_both_ways_refuse_the_same),
        cmocka_unit_test(test_times_may_overlap),
        cmocka_unit_test(test_ten_thousand_activities_are_taken),
        cmocka_unit_test(test_a_thousand_levels_are_too_many),
    };
    return cmocka_run_group_tests(tests, NULL, remove_temp_folder);
}
