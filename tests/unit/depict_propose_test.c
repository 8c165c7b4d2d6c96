/* What is told where nobody says what, and what is said where little can be told: of scenes whose motion is known, with
 * what looks alike beside each. */
#include <jansson.h>

#include "behaviour/inspect.h"
#include "depict_support.h"
#include "info/info.h"
#include "scene/behaviour.h"

static lmn_scene *scene_of(const char *nodes, const char *behaviour)
{
    static char text[8192];
    snprintf(text, sizeof text, "{\"limner_script\": 1, \"nodes\": [%s]%s%s}", nodes,
             *behaviour ? ", \"behaviour\": " : "", behaviour);
    return load_or_fail(temp_file("proposed.json", text, strlen(text)));
}

/* What is told of a scene at a time; free with json_decref. */
static json_t *told_of(lmn_scene *s, const char *clip, double seconds)
{
    char         *json = NULL;
    lmn_draw_desc draw = seen_at(seconds);
    draw.clip = clip;
    draw.orthographic = false;
    tell_as(s, &draw, NULL, &json);
    json_t *root = json_loads(json, 0, NULL);
    lmn_text_free(json);
    assert_non_null(root);
    return root;
}

/* The first expression of a characteristic and target (NULL: any); NULL: there is none. */
static const json_t *expression_of(const json_t *told, const char *depict, const char *target)
{
    size_t        i;
    const json_t *e;
    json_array_foreach(json_object_get(told, "expressions"), i, e)
    {
        if (strcmp(json_string_value(json_object_get(e, "depict")), depict) == 0 &&
            (!target || strcmp(json_string_value(json_object_get(e, "target")), target) == 0))
            return e;
    }
    return NULL;
}

static double number_of(const json_t *e, const char *key)
{
    return json_number_value(json_object_get(e, key));
}

static bool warnings_say(const json_t *told, const char *words)
{
    size_t        i;
    const json_t *text;
    json_array_foreach(json_object_get(told, "warnings"), i, text)
    {
        if (strstr(json_string_value(text), words))
            return true;
    }
    return false;
}

#define CRATE(NAME) "{\"name\": \"" NAME "\", \"box\": {\"size\": [1, 1, 1]}}"

/* --- size and shape ----------------------------------------------------------------------------------------------- */

/* A pulse grows, shrinks, grows: what it does at the moment is told, as far as it does that. */
static void pulses_grow_or_shrink_as_they_do_now(void **state)
{
    (void)state;
    static const struct {
        double      now, from, to;
        const char *told, *other;
    } rows[] = {
        {0.5, 0, 1, "expand", "collapse"}, {1.5, 1, 2, "collapse", "expand"}, {2.7, 2, 3, "expand", "collapse"}};
    lmn_scene *s =
        scene_of(CRATE("pulse"), "{\"target\": \"pulse\", \"property\": \"scale\", \"linear\": [[1, 1, 1], [2, 2, 2], "
                                 "[1, 1, 1], [2, 2, 2]], \"duration\": 3}");
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        json_t       *told = told_of(s, NULL, rows[i].now);
        const json_t *e = expression_of(told, rows[i].told, "pulse");
        assert_non_null(e);
        assert_null(expression_of(told, rows[i].other, NULL));
        assert_near(number_of(e, "from"), rows[i].from, 0.07);
        assert_near(number_of(e, "to"), rows[i].to, 0.07);
        json_decref(told);
    }
    lmn_scene_destroy(&s);
}

/* A reason names the time of what it tells of: now, or when. */
static void reasons_name_their_time(void **state)
{
    (void)state;
    static const struct {
        double      now;
        const char *because;
    } rows[] = {{0.5, "its size changes from 1 to 2 s; behind that by before"},
                {1.5, "its size changes now; behind that by before"}};
    lmn_scene *s =
        scene_of(CRATE("late"), "{\"target\": \"late\", \"property\": \"scale\", \"linear\": [[1, 1, 1], [1, 1, 1], "
                                "[2, 2, 2]], \"duration\": 2}");
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        json_t *told = told_of(s, NULL, rows[i].now);
        assert_string_equal(
            json_string_value(json_object_get(json_array_get(json_object_get(told, "reasons"), 0), "because")),
            rows[i].because);
        json_decref(told);
    }
    lmn_scene_destroy(&s);
}

static void what_changes_its_shape_is_seen_before_and_behind(void **state)
{
    (void)state;
    lmn_scene *s = load_or_fail(LIMNER_SOURCE_DIR "/examples/morph-cube.glb");
    json_t    *told = told_of(s, NULL, 1.2);
    assert_near(number_of(expression_of(told, "still", NULL), "count"), 3, 0);
    assert_true(count_of(s, "still") > 1);
    json_decref(told);
    lmn_scene_destroy(&s);
}

/* --- limbs -------------------------------------------------------------------------------------------------------- */

#define LIMB(NAME, PARENT, X)                                                                                          \
    ", {\"name\": \"" NAME "\", \"parent\": \"" PARENT "\", \"box\": {\"size\": [0.3, 2, 0.3]}, \"translation\": [" X  \
    ", 1, 0]}"
#define SWINGS(NAME, ANGLE)                                                                                            \
    "{\"target\": \"" NAME "\", \"property\": \"rotation\", \"axis\": [0, 0, 1], \"linear\": [0, " ANGLE               \
    "], \"duration\": 2}"

/* The helper goes farthest and is nothing; the blade's tip goes farther than the hand that holds it. */
static void limbs_are_what_is_seen(void **state)
{
    (void)state;
    lmn_scene *s = scene_of(
        "{\"name\": \"body\", \"box\": {\"size\": [1, 3, 1]}}" LIMB("arm_l", "body", "-1") LIMB("arm_r", "body", "1")
            LIMB("leg_l", "body", "-0.5") LIMB("leg_r", "body", "0.5") LIMB(
                "blade", "arm_r", "0") ", {\"name\": \"hand_ik_r\", \"parent\": \"body\", \"translation\": [5, 0, 0]}",
        "[" SWINGS("body", "1") "," SWINGS("arm_l", "20") "," SWINGS("arm_r", "25") "," SWINGS(
            "leg_l", "10") "," SWINGS("leg_r", "10") "," SWINGS("blade", "30") ", {\"target\": \"hand_ik_r\", "
                                                                               "\"linear\": [[5, 0, 0], [5, 90, 0]], "
                                                                               "\"duration\": 2}]");
    json_t       *told = told_of(s, NULL, 1);
    const json_t *e = expression_of(told, "path", NULL);
    assert_non_null(e);
    assert_string_equal(json_string_value(json_object_get(e, "target")), "blade");
    assert_true(json_is_true(json_object_get(e, "tip")) && json_is_true(json_object_get(e, "before")));
    json_decref(told);
    lmn_scene_destroy(&s);
}

#define TIP_FAR 2.00249843945 /* of (0.1, 2) */

/* Of a blade that turns about its grip, 2 below its tip; and before all that the scene has where it is wanted. */
static void tips_go_farther_than_middles(void **state)
{
    (void)state;
    lmn_scene *s =
        scene_of("{\"name\": \"grip\"}, {\"name\": \"blade\", \"parent\": \"grip\", \"box\": {\"size\": [0.2, 2, "
                 "0.2]}, \"translation\": [0, 1, 0]}, {\"name\": \"wall\", \"box\": {\"size\": [9, 9, 1]}, "
                 "\"translation\": [0, 0, 3]}",
                 SWINGS("grip", "90"));
    static const struct {
        const char *said;
        double      far, front; /* from the grip; towards the viewer */
    } rows[] = {{"", 1, 0}, {", \"tip\": true", TIP_FAR, 0.1}, {", \"tip\": true, \"before\": true", TIP_FAR, 3.5}};
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        char   text[200];
        double at[3];
        snprintf(text, sizeof text, "[{\"target\": \"grip\", \"depict\": \"path\", \"now\": 2%s}]", rows[i].said);
        tell_at(s, 2, text);
        ribbon_point(glyph_at(s, "arrow", "past", 0), 0, at);
        assert_near(hypot(at[0], at[1]), rows[i].far, 0.01);
        assert_true(i < 2 ? fabs(fabs(at[2]) - rows[i].front) < 0.01 : at[2] > rows[i].front);
    }
    lmn_scene_destroy(&s);
}

static void the_knight_swings_his_sword(void **state)
{
    (void)state;
    const char *data = data_folder();
    char        path[1200];
    if (!data)
        return;
    snprintf(path, sizeof path, "%s/gltf/animated/knight/knight.gltf", data);
    lmn_scene *s = load_or_fail(path);
    json_t    *told = told_of(s, NULL, 1.2);
    assert_non_null(expression_of(told, "path", "sword"));
    json_decref(told);
    for (size_t i = 0; i < s->node_count; i++)
        if (s->nodes[i].name &&
            (strstr(s->nodes[i].name, "_ctrl") || strstr(s->nodes[i].name, "_ik") ||
             strstr(s->nodes[i].name, "_pole")) &&
            semantics_of(s, (int32_t)i))
            fail_msg("%s is a %s", s->nodes[i].name, semantics_of(s, (int32_t)i));
    lmn_scene_destroy(&s);
}

/* --- things, cameras, lights -------------------------------------------------------------------------------------- */

static void cameras_on_things_leave_them_things(void **state)
{
    (void)state;
    lmn_scene *s = load_or_fail(LIMNER_SOURCE_DIR "/examples/buggy.glb");
    json_t    *told = told_of(s, NULL, 1.2);
    assert_non_null(expression_of(told, "path", "buggy"));
    assert_null(expression_of(told, "camera-path", NULL));
    json_decref(told);
    lmn_scene_destroy(&s);
}

#define STAGE CRATE("stage") ", {\"name\": \"eye\", \"translation\": [0, 1, 8], \"camera\": {\"fov\": 60}}"

static void cameras_that_zoom_or_turn_are_told(void **state)
{
    (void)state;
    lmn_scene *s =
        scene_of(STAGE, "{\"target\": \"eye\", \"property\": \"fov\", \"linear\": [60, 20], \"duration\": 2}");
    json_t *told = told_of(s, NULL, 1);
    assert_non_null(expression_of(told, "shot-flow", "eye"));
    json_decref(told);
    /* The frames are as large as the view is then: at its ends tan 30° and tan 10°. */
    tell_at(s, 1, "[{\"target\": \"eye\", \"depict\": \"shot-flow\", \"count\": 2, \"focus\": 2}]");
    double a[3], b[3];
    for (size_t i = 0; i < 2; i++) {
        position(sign_at(s, "frame", i), 0, a);
        position(sign_at(s, "frame", i), 3, b);
        assert_near(fabs(b[1] - a[1]), 2 * 2 * tan((i ? 10 : 30) * acos(-1) / 180), 1e-4);
    }
    lmn_scene_destroy(&s);
    s = scene_of(STAGE, "{\"target\": \"stage\", \"linear\": [[0, 0, 0], [0.001, 0, 0]], \"duration\": 2}");
    told = told_of(s, NULL, 1);
    assert_null(expression_of(told, "shot-flow", NULL));
    assert_null(expression_of(told, "camera-path", NULL));
    json_decref(told);
    lmn_scene_destroy(&s);
}

static void lights_that_move_have_ways(void **state)
{
    (void)state;
    static const char nodes[] =
        CRATE("stage") ", {\"name\": \"lamp\", \"translation\": [0, 3, 0], \"light\": {\"type\": \"point\"}}";
    lmn_scene *s = scene_of(nodes, "{\"target\": \"lamp\", \"linear\": [[-3, 3, 0], [3, 3, 0]], \"duration\": 2}");
    json_t    *told = told_of(s, NULL, 1);
    assert_non_null(expression_of(told, "path", "lamp"));
    assert_int_equal(json_array_size(json_object_get(told, "warnings")), 0);
    json_decref(told);
    lmn_scene_destroy(&s);
    s = scene_of(nodes, "{\"target\": \"lamp\", \"property\": \"intensity\", \"linear\": [1, 9], \"duration\": 2}");
    told = told_of(s, NULL, 1);
    assert_int_equal(json_array_size(json_object_get(told, "expressions")), 0);
    assert_true(warnings_say(told, "'lamp', a light, changes"));
    json_decref(told);
    lmn_scene_destroy(&s);
}

/* Up and down again: both ways are seen beside each other, and what goes one way lies in the middle. */
static void ways_that_go_back_lie_beside_each_other(void **state)
{
    (void)state;
    lmn_scene *s = scene_of(CRATE("lift"),
                            "{\"target\": \"lift\", \"linear\": [[0, 0, 0], [0, 6, 0], [0, 0, 0]], \"duration\": 4}");
    json_t    *told = told_of(s, NULL, 2);
    assert_near(number_of(expression_of(told, "path", "lift"), "aside"), 0.6, 1e-6);
    double past[3], future[3];
    ribbon_point(glyph_at(s, "arrow", "past", 0), 0, past);
    ribbon_point(glyph_at(s, "arrow", "future", 0), 0, future);
    assert_true(past[0] < -0.2 && future[0] > 0.2);
    json_decref(told);
    lmn_scene_destroy(&s);
    s = scene_of(CRATE("lift"), "{\"target\": \"lift\", \"linear\": [[0, 0, 0], [0, 6, 0]], \"duration\": 4}");
    told = told_of(s, NULL, 2);
    assert_null(json_object_get(expression_of(told, "path", "lift"), "aside"));
    json_decref(told);
    lmn_scene_destroy(&s);
    /* What sways for long where it waits goes on all the same: lengths count, not times. */
    s = scene_of(CRATE("lift"),
                 "{\"target\": \"lift\", \"linear\": [[0, 0, 0], [0.1, 0, 0], [0, 0, 0], [0.1, 0, 0], [0, 0, 0], "
                 "[0.1, 0, 0], [0, 0, 0], [0.1, 0, 0], [0, 0, 0], [6, 0, 0]], \"duration\": 4}");
    told = told_of(s, NULL, 2);
    assert_null(json_object_get(expression_of(told, "path", "lift"), "aside"));
    json_decref(told);
    lmn_scene_destroy(&s);
}

/* A gear in its housing is told before it; one beside it where it is. */
static void what_turns_inside_is_told_before_all(void **state)
{
    (void)state;
    static const char *const places[] = {"0", "5"};
    for (int i = 0; i < 2; i++) {
        char nodes[512];
        snprintf(
            nodes, sizeof nodes,
            "{\"name\": \"housing\", \"box\": {\"size\": [4, 4, 4]}}, {\"name\": \"gear\", \"translation\": [%s, 0, "
            "0], \"box\": {\"size\": [2, 2, 1]}}",
            places[i]);
        lmn_scene    *s = scene_of(nodes, "{\"target\": \"gear\", \"property\": \"rotation\", \"axis\": [0, 0, 1], "
                                             "\"linear\": [0, 90], \"duration\": 2}");
        json_t       *told = told_of(s, NULL, 1);
        const json_t *e = expression_of(told, "turnaround", "gear");
        assert_non_null(e);
        assert_int_equal(json_is_true(json_object_get(e, "before")), i == 0);
        json_decref(told);
        lmn_scene_destroy(&s);
    }
}

/* Stars of several things are smaller than that of one. */
static void stars_of_several_leave_each_other_room(void **state)
{
    (void)state;
    static const char one[] = "{\"target\": \"a\", \"linear\": [[0, 3, 0], [0, 0.5, 0], [0, 3, 0]], \"duration\": 2}",
                      other[] = "{\"target\": \"b\", \"linear\": [[3, 3, 0], [3, 0.5, 0], [3, 3, 0]], \"duration\": 2}";
    for (int i = 0; i < 2; i++) {
        char behaviour[512];
        snprintf(behaviour, sizeof behaviour, i ? "[%s, %s]" : "[%s]", one, other);
        lmn_scene *s =
            scene_of("{\"name\": \"ground\", \"box\": {\"size\": [20, 1, 9]}, \"translation\": [0, -0.5, 0]}, " CRATE(
                         "a") ", " CRATE("b"),
                     behaviour);
        json_t       *told = told_of(s, NULL, 1.5);
        const json_t *e = expression_of(told, "collision", "a"), *size = json_object_get(e, "size");
        assert_non_null(e);
        assert_true(i ? size && json_number_value(size) < 1.7 && expression_of(told, "collision", "b") : !size);
        json_decref(told);
        lmn_scene_destroy(&s);
    }
}

/* --- warnings --------------------------------------------------------------------------------------------------------
 */

static void what_is_not_told_is_said(void **state)
{
    (void)state;
    lmn_scene *s = scene_of(CRATE("stage"), "");
    json_t    *told = told_of(s, NULL, 0);
    assert_true(warnings_say(told, "nothing in the scene is animated"));
    assert_true(json_is_array(json_object_get(told, "reasons")));
    json_decref(told);
    lmn_scene_destroy(&s);
    s = scene_of(CRATE("stage"), "{\"target\": \"stage\", \"linear\": [[0, 0, 0], [0.01, 0, 0]], \"duration\": 2}");
    told = told_of(s, NULL, 1);
    assert_true(warnings_say(told, "'stage' hardly moves"));
    json_decref(told);
    lmn_scene_destroy(&s);
    s = scene_of(CRATE("stage"), "{\"target\": \"stage\", \"linear\": [[0, 0, 0], [9, 0, 0]], \"duration\": 2}");
    told = told_of(s, NULL, 1);
    assert_int_equal(json_array_size(json_object_get(told, "warnings")), 0);
    json_decref(told);
    /* Where expressions are given there are no reasons, and the list of them is empty. */
    char         *json = NULL;
    lmn_draw_desc draw = seen_at(1);
    tell_as(s, &draw, "[{\"target\": \"stage\", \"depict\": \"path\"}]", &json);
    told = json_loads(json, 0, NULL);
    assert_true(json_is_array(json_object_get(told, "reasons")));
    lmn_text_free(json);
    json_decref(told);
    lmn_scene_destroy(&s);
}

/* A clip that moves nothing to speak of names those that do. */
static void other_clips_are_named(void **state)
{
    (void)state;
    lmn_scene   *s = load_or_fail(LIMNER_SOURCE_DIR "/examples/fox.glb");
    animation   *first = &s->animations[0];
    const size_t channels = first->channel_count;
    first->channel_count = 0; /* nothing of it is left */
    json_t *told = told_of(s, "1", 0);
    assert_true(warnings_say(told, "moves nothing that can be seen"));
    assert_true(warnings_say(told, "'Survey'") && warnings_say(told, "--clip: 2 'Walk', 3 'Run'"));
    json_decref(told);
    told = told_of(s, "Run", 0.5);
    assert_false(warnings_say(told, "--clip"));
    json_decref(told);
    first->channel_count = channels;
    lmn_scene_destroy(&s);
}

static void controls_in_names_are_shown(void **state)
{
    (void)state;
    lmn_scene *s =
        scene_of(CRATE("stage"), "{\"target\": \"stage\", \"linear\": [[0, 0, 0], [9, 0, 0]], \"duration\": 2}");
    lmn_error       error = {0};
    lmn_depict_desc desc = LMN_DEPICT_DESC_INIT;
    lmn_draw_desc   draw = seen_at(1);
    desc.expressions = "[{\"target\": \"a\\u001b[31mb\\u0007\\u009b\", \"depict\": \"path\"}]";
    assert_int_equal(lmn_depict(s, &draw, &desc, NULL, &error), LMN_FORMAT);
    assert_non_null(strstr(error.message, "a\\x1b[31mb\\x07\\x9b"));
    lmn_scene_destroy(&s);
}

/* --- how much ----------------------------------------------------------------------------------------------------- */

/* Dashes are no more than a page could show. */
static void long_ways_have_few_dashes(void **state)
{
    (void)state;
    lmn_scene *s =
        scene_of(CRATE("stage"), "{\"target\": \"stage\", \"linear\": [[0, 0, 0], [1e15, 0, 0]], \"duration\": 2}");
    tell_at(s, 0.1, "[{\"target\": \"stage\", \"depict\": \"path\"}]");
    const primitive *future = glyph_at(s, "arrow", "future", 0);
    assert_non_null(future);
    assert_true(future->vertex_count > 4 && future->vertex_count < 20000);
    lmn_scene_destroy(&s);
}

/* --- faces -------------------------------------------------------------------------------------------------------- */

/* What `info` says of the face of a node called so, in a model. */
static void face_of(const char *path, const char *name, double gaze[3], double forward[2])
{
    lmn_scene    *s = load_or_fail(path);
    char         *text = scene_dynamics_json(s);
    json_t       *root = json_loads(text, 0, NULL);
    size_t        i;
    const json_t *n, *face = NULL;
    json_array_foreach(json_object_get(root, "nodes"), i, n)
    {
        const char *own = json_string_value(json_object_get(n, "node"));
        face = own && strcmp(own, name) == 0 ? json_object_get(n, "face") : face;
    }
    assert_non_null(face);
    double head[3], mouth[3], eyes[2][3];
    for (size_t k = 0; k < 3; k++) {
        gaze[k] = json_number_value(json_array_get(json_object_get(face, "gaze"), k));
        head[k] = json_number_value(json_array_get(json_object_get(face, "head"), k));
        mouth[k] = json_number_value(json_array_get(json_object_get(face, "mouth"), k));
        for (size_t e = 0; e < 2; e++)
            eyes[e][k] = json_number_value(json_array_get(json_array_get(json_object_get(face, "eyes"), e), k));
    }
    vector3_add(mouth, mouth, -1, head);
    vector3_mix(eyes[0], eyes[0], eyes[1], 0.5);
    vector3_add(eyes[0], eyes[0], -1, head);
    forward[0] = vector3_dot(mouth, gaze);
    forward[1] = vector3_dot(eyes[0], gaze);
    json_decref(root);
    mem_free(text);
    lmn_scene_destroy(&s);
}

/* When its clip begins the fox has its head turned far to its right and somewhat down; its muzzle is 20 long. */
static void faces_are_told(void **state)
{
    (void)state;
    double gaze[3], forward[2];
    face_of(LIMNER_SOURCE_DIR "/examples/fox.glb", "fox", gaze, forward);
    assert_true(gaze[0] < -0.7 && gaze[1] < 0 && gaze[2] > 0.3);
    assert_true(forward[0] > 8 && forward[0] < 30 && forward[1] > 8);
    /* A figure of nodes, whose eyes are named; it leans forward a little. */
    face_of(LIMNER_SOURCE_DIR "/examples/scripts/runner.json", "figure", gaze, forward);
    assert_true(gaze[2] > 0.95 && forward[0] > 0.05);
    const char *data = data_folder();
    char        path[1200];
    if (!data)
        return;
    snprintf(path, sizeof path, "%s/gltf/animated/knight/knight.gltf", data);
    face_of(path, "knight", gaze, forward); /* on guard: he looks ahead, although his skull's bone does not */
    assert_true(gaze[2] > 0.98 && forward[0] > 0.1);
}

/* --- what things are ---------------------------------------------------------------------------------------------- */

static void shapes_are_told_by_their_shape(void **state)
{
    (void)state;
    static const struct {
        const char *node, *told;
    } rows[] = {
        {"{\"name\": \"thing\", \"box\": {\"size\": [1, 1, 1]}}", NULL}, /* all corners are as far from the middle */
        {"{\"name\": \"ball\", \"box\": {\"size\": [1, 1, 1]}}", NULL},
        {"{\"name\": \"thing\", \"sphere\": {\"radius\": 1}}", "ball"},
        {"{\"name\": \"ball\", \"sphere\": {\"radius\": 1}}", "ball"},
        {"{\"name\": \"ball_ctrl_l\", \"translation\": [1, 0, 0]}", NULL},
        {"{\"name\": \"ball_l\", \"translation\": [1, 0, 0]}", NULL}, /* of the foot */
        {"{\"name\": \"hand_ik_r\", \"translation\": [1, 0, 0]}", NULL},
        {"{\"name\": \"arm pole\", \"translation\": [1, 0, 0]}", NULL},
        {"{\"name\": \"hand_r\", \"translation\": [1, 0, 0]}", "hand"},
        {"{\"name\": \"hand control\", \"box\": {\"size\": [1, 1, 1]}}", "hand"},             /* it is seen */
        {"{\"name\": \"thing\", \"sphere\": {\"radius\": 1}, \"scale\": [1, 2, 0.7]}", NULL}, /* as a trunk */
        {"{\"name\": \"thing\", \"sphere\": {\"radius\": 1}, \"scale\": 3}", "ball"},
        {"{\"name\": \"door\", \"box\": {\"size\": [1, 2, 0.1]}}", "door"},
        {"{\"name\": \"Head Lamp\", \"box\": {\"size\": [1, 1, 1]}}", NULL},
        {"{\"name\": \"headLight_left\", \"box\": {\"size\": [1, 1, 1]}}", NULL},
        {"{\"name\": \"door_handle\", \"box\": {\"size\": [1, 1, 1]}}", NULL},
        {"{\"name\": \"head\", \"box\": {\"size\": [1, 1, 1]}}", "head"},
        {"{\"name\": \"armour\", \"box\": {\"size\": [1, 1, 1]}}",
         NULL}, /* a word of its own, not letters of another */
        {"{\"name\": \"alarm\", \"box\": {\"size\": [1, 1, 1]}}", NULL},
        {"{\"name\": \"Left Arm 2\", \"box\": {\"size\": [1, 1, 1]}}", "arm"},
        {"{\"name\": \"carDoor\", \"box\": {\"size\": [1, 1, 1]}}", "door"}, /* the last noun says what it is */
        {"{\"name\": \"truck_wheel_l\", \"box\": {\"size\": [1, 1, 1]}}", "wheel"},
        {"{\"name\": \"thing\", \"semantics\": \"ball\", \"box\": {\"size\": [1, 1, 1]}}", "ball"}, /* who says so */
    };
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        char nodes[300]; /* a scene has something to draw */
        snprintf(nodes, sizeof nodes, "%s, " CRATE("crate"), rows[i].node);
        lmn_scene *s = scene_of(nodes, "");
        int32_t    at = NONE;
        for (size_t k = 0; k < s->node_count && at == NONE; k++)
            at = s->nodes[k].parent != NONE ? (int32_t)k : NONE;
        const char *told = semantics_of(s, at == NONE ? 0 : at);
        if (rows[i].told ? !told || strcmp(told, rows[i].told) != 0 : told != NULL)
            fail_msg("%s is a %s", rows[i].node, told ? told : "thing");
        lmn_scene_destroy(&s);
    }
}

/* What is called a plane flies, unless it is a sheet, whichever way that lies. */
static void sheets_do_not_fly(void **state)
{
    (void)state;
    for (int axis = -1; axis < 3; axis++) {
        lmn_scene *s = scene_of("{\"name\": \"plane\", \"box\": {\"size\": [3, 1, 2]}}, " CRATE("crate"), "");
        for (size_t i = 0; i < s->node_count; i++) {
            if (!s->nodes[i].name || strcmp(s->nodes[i].name, "plane") != 0 || s->nodes[i].mesh == NONE)
                continue;
            primitive *p = &s->meshes[s->nodes[i].mesh].primitives[0];
            float     *flattened[3][2] = {{&p->bounds.min.x, &p->bounds.max.x},
                                          {&p->bounds.min.y, &p->bounds.max.y},
                                          {&p->bounds.min.z, &p->bounds.max.z}};
            for (int k = 0; k < 2 && axis >= 0; k++)
                *flattened[axis][k] = 0;
            const char *told = semantics_of(s, (int32_t)i);
            if ((told && strcmp(told, "plane") == 0) != (axis < 0))
                fail_msg("flat along %d: %s", axis, told ? told : "nothing");
        }
        lmn_scene_destroy(&s);
    }
}

/* What is round of a figure is no ball: sleeves, caps, trunks. What somebody throws is one. */
static void round_limbs_are_no_balls(void **state)
{
    (void)state;
    size_t     balls = 0, named = 0;
    lmn_scene *s = load_or_fail(LIMNER_SOURCE_DIR "/examples/scripts/batting-hit.json");
    for (size_t i = 0; i < s->node_count; i++) {
        const char *told = semantics_of(s, (int32_t)i);
        if (!told || strcmp(told, "ball") != 0)
            continue;
        balls++;
        named += strstr(s->nodes[i].name, "ball") != NULL;
    }
    assert_true(balls > 0);
    assert_int_equal(balls, named);
    lmn_scene_destroy(&s);
    /* Nor is anything round of what has a skin. */
    s = scene_of("{\"name\": \"thing\", \"sphere\": {\"radius\": 1}}, " CRATE("crate"), "");
    for (size_t i = 0; i < s->node_count; i++)
        if (s->nodes[i].name && strcmp(s->nodes[i].name, "thing") == 0) {
            assert_string_equal(semantics_of(s, (int32_t)i), "ball");
            s->nodes[s->nodes[i].parent].skin = 0;
            assert_null(semantics_of(s, (int32_t)i));
            s->nodes[s->nodes[i].parent].skin = NONE;
        }
    lmn_scene_destroy(&s);
}

/* Two things that come together are hit both, and one star tells it; what one of them hits else has one of its own. */
static void one_hit_is_told_once(void **state)
{
    (void)state;
    lmn_scene *s = scene_of(
        "{\"name\": \"wall\", \"box\": {\"size\": [0.2, 4, 4]}, \"translation\": [6.6, 0, 0]}, "
        "{\"name\": \"a\", \"sphere\": {\"radius\": 0.5}}, {\"name\": \"b\", \"sphere\": {\"radius\": 0.5}}",
        "[{\"target\": \"a\", \"linear\": [[-6, 0, 0], [-0.5, 0, 0], [-6, 0, 0]], \"times\": [0, 1, 3]}, "
        "{\"target\": \"b\", \"linear\": [[4, 0, 0], [0.5, 0, 0], [6, 0, 0], [4, 0, 0]], \"times\": [0, 1, 2, 3]}]");
    json_t       *told = told_of(s, NULL, 2.5);
    size_t        i, both = 0, walls = 0;
    const json_t *e;
    json_array_foreach(json_object_get(told, "expressions"), i, e)
    {
        if (strcmp(json_string_value(json_object_get(e, "depict")), "collision") != 0)
            continue;
        const char *target = json_string_value(json_object_get(e, "target")),
                   *partner = json_string_value(json_object_get(e, "partner"));
        const bool wall = partner && strcmp(partner, "wall") == 0;
        walls += wall;
        both += !wall;
        assert_true(!wall || strcmp(target, "b") == 0);
    }
    json_decref(told);
    /* Whichever is told first has the hit of both, and the wall's is told of b. */
    assert_int_equal(both, 1);
    assert_true(walls <= 1);
    assert_int_equal(count_of(s, "star"), 2 * 2); /* rim and face of each */
    lmn_scene_destroy(&s);
}

/* Its middle box is finely cut: corners and edges of a box are not as far from its middle as faces. */
static void boxes_are_no_balls(void **state)
{
    (void)state;
    lmn_scene *s = load_or_fail(LIMNER_SOURCE_DIR "/examples/box-animated.glb");
    for (size_t i = 0; i < s->node_count; i++)
        if (semantics_of(s, (int32_t)i))
            fail_msg("node %zu is a %s", i, semantics_of(s, (int32_t)i));
    lmn_scene_destroy(&s);
}

/* The page is fitted to what is told and to what of a huge ground lies there; a camera that is given, and another
 * depiction, leave nothing of that. */
static void grounds_do_not_fill_the_page(void **state)
{
    (void)state;
    static const char text[] =
        "{\"limner_script\": 1, \"nodes\": [{\"name\": \"ground\", \"box\": {\"size\": [400, 0.2, 400]}, "
        "\"translation\": [0, -0.1, 0]}, {\"name\": \"far\", \"box\": {}, \"translation\": [100, 0.5, 0]}, "
        "{\"name\": \"near\", \"box\": {}, \"translation\": [3, 0.5, 0]}, {\"name\": \"ball\", \"sphere\": "
        "{\"radius\": 0.3}, \"translation\": [0, 2, 0]}], \"behaviour\": {\"target\": \"ball\", \"function\": "
        "\"bounce\", \"floor\": 0.3, \"velocity\": [1, 0, 0], \"duration\": 2.5}}";
    lmn_scene    *s = load_or_fail(temp_file("ground.json", text, sizeof text - 1));
    lmn_draw_desc draw = seen_at(1.5);
    const box3    unit = {{2.5f, 0, -0.5f}, {3.5f, 1, 0.5f}}, away = {{99.5f, 0, -0.5f}, {100.5f, 1, 0.5f}},
               ground = {{-200, -0.2f, -200}, {200, 0, 200}};
    tell_as(s, &draw, NULL, NULL);
    assert_true(s->staged);
    assert_true(s->stage.min.x < -0.3f && s->stage.max.x > 2.8f && s->stage.max.y > 2.3f && s->stage.min.y < 0);
    assert_true(box3_diagonal(s->stage) < 6);
    assert_true(box3_diagonal(scene_fitted_box(s, 0, ground)) < 6);
    assert_true(box3_is_empty(scene_fitted_box(s, 1, away)));
    assert_near(box3_diagonal(scene_fitted_box(s, 2, unit)), box3_diagonal(unit), 0);
    draw.eye_given = true;
    vector3_set(draw.eye, 0, 3, 9);
    vector3_set(draw.up, 0, 1, 0);
    tell_as(s, &draw, NULL, NULL);
    assert_false(s->staged);
    tell_at(s, 1.5, NULL);
    assert_true(s->staged);
    assert_int_equal(lmn_depict_clear(s, NULL), LMN_OK);
    assert_false(s->staged);
    lmn_scene_destroy(&s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(pulses_grow_or_shrink_as_they_do_now),
        cmocka_unit_test(what_changes_its_shape_is_seen_before_and_behind),
        cmocka_unit_test(limbs_are_what_is_seen),
        cmocka_unit_test(tips_go_farther_than_middles),
        cmocka_unit_test(the_knight_swings_his_sword),
        cmocka_unit_test(cameras_on_things_leave_them_things),
        cmocka_unit_test(cameras_that_zoom_or_turn_are_told),
        cmocka_unit_test(lights_that_move_have_ways),
        cmocka_unit_test(ways_that_go_back_lie_beside_each_other),
        cmocka_unit_test(what_turns_inside_is_told_before_all),
        cmocka_unit_test(stars_of_several_leave_each_other_room),
        cmocka_unit_test(what_is_not_told_is_said),
        cmocka_unit_test(other_clips_are_named),
        cmocka_unit_test(controls_in_names_are_shown),
        cmocka_unit_test(long_ways_have_few_dashes),
        cmocka_unit_test(faces_are_told),
        cmocka_unit_test(shapes_are_told_by_their_shape),
        cmocka_unit_test(round_limbs_are_no_balls),
        cmocka_unit_test(sheets_do_not_fly),
        cmocka_unit_test(one_hit_is_told_once),
        cmocka_unit_test(boxes_are_no_balls),
        cmocka_unit_test(reasons_name_their_time),
        cmocka_unit_test(grounds_do_not_fill_the_page),
    };
    return cmocka_run_group_tests(tests, NULL, remove_temp_folder);
}
