/* limner/behaviour.h: graphs that a program makes are those of scripts, and mistakes are told in the same words. */
#include <math.h>

#include "import_support.h"
#include "limner/behaviour.h"
#include "limner/content.h"
#include "limner/draw.h"
#include "scene/behaviour.h"

static lmn_scene *scene_of_nodes(uint32_t count)
{
    lmn_scene *s = NULL;
    assert_int_equal(lmn_scene_create(&s, NULL), LMN_OK);
    for (uint32_t i = 0; i < count; i++) {
        lmn_node_desc desc = LMN_NODE_DESC_INIT;
        assert_int_equal(lmn_scene_add_node(s, &desc, NULL, NULL), LMN_OK);
    }
    return s;
}

static uint32_t add_constraint(lmn_scene *s, const lmn_constraint_desc *desc)
{
    uint32_t   out = 0;
    lmn_error  error = {0};
    lmn_status status = lmn_behaviour_add_constraint(s, desc, &out, &error);
    if (status != LMN_OK)
        fail_msg("%s", error.message);
    return out;
}

static uint32_t add_group(lmn_scene *s, lmn_activity_kind kind, const uint32_t *children, size_t count)
{
    lmn_activity_child list[16] = {{0}};
    lmn_activity_desc  desc = LMN_ACTIVITY_DESC_INIT;
    uint32_t           out = 0;
    lmn_error          error = {0};
    for (size_t i = 0; i < count; i++)
        list[i].activity = children[i];
    desc.kind = kind;
    desc.children = list;
    desc.child_count = count;
    lmn_status status = lmn_behaviour_add(s, &desc, &out, &error);
    if (status != LMN_OK)
        fail_msg("%s", error.message);
    return out;
}

static void play(lmn_scene *s, uint32_t activity)
{
    lmn_error  error = {0};
    lmn_status status = lmn_behaviour_play(s, &activity, 1, &error);
    if (status != LMN_OK)
        fail_msg("%s", error.message);
}

static lmn_dynamics *dynamics_of(const lmn_scene *s)
{
    lmn_dynamics *d = NULL;
    lmn_error     error = {0};
    if (lmn_dynamics_create(s, NULL, &d, &error) != LMN_OK)
        fail_msg("%s", error.message);
    return d;
}

static lmn_point_state point_at(const lmn_dynamics *d, uint32_t node, double seconds)
{
    lmn_point_state out;
    assert_int_equal(lmn_dynamics_point(d, node, NULL, seconds, &out, NULL), LMN_OK);
    return out;
}

static uint32_t node_called(const lmn_scene *s, const char *name)
{
    for (size_t i = 0; i < s->node_count; i++)
        if (s->nodes[i].name && strcmp(s->nodes[i].name, name) == 0)
            return (uint32_t)i + 1;
    fail_msg("no node %s", name);
    return 0;
}

/* --- the three balls of the script, by calls ----------------------------------------------------------------- */

static uint32_t falling_ball(lmn_scene *s, uint32_t node, double duration)
{
    lmn_constraint_desc desc = LMN_CONSTRAINT_DESC_INIT;
    desc.node = node;
    desc.map = LMN_TIME_MAP_BOUNCE;
    desc.floor_height = 0.5;
    desc.velocity[0] = 2;
    desc.duration_s = duration;
    return add_constraint(s, &desc);
}

static uint32_t hop(lmn_scene *s, uint32_t node, const double *points)
{
    lmn_constraint_desc desc = LMN_CONSTRAINT_DESC_INIT;
    desc.node = node;
    desc.map = LMN_TIME_MAP_CURVE;
    desc.curve = LMN_CURVE_BEZIER;
    desc.values = points;
    desc.value_count = 4;
    desc.duration_s = 1;
    return add_constraint(s, &desc);
}

static void test_calls_make_what_the_script_makes(void **state)
{
    (void)state;
    static const double first[] = {0, 0.5, -1, 0.6, 2.5, -1, 1.4, 2.5, -1, 2, 0.5, -1},
                        second[] = {2, 0.5, -1, 2.6, 1.7, -1, 3.4, 1.7, -1, 4, 0.5, -1},
                        places[][3] = {{0, 4, 1}, {0, 4, 0}, {0, 0.5, -1}};
    lmn_scene *s = scene_of_nodes(0), *script = load_or_fail(LIMNER_SOURCE_DIR "/examples/scripts/balls.json");
    uint32_t   balls[3];
    for (int i = 0; i < 3; i++) {
        lmn_node_desc desc = LMN_NODE_DESC_INIT;
        memcpy(desc.matrix + 12, places[i], sizeof places[i]);
        assert_int_equal(lmn_scene_add_node(s, &desc, &balls[i], NULL), LMN_OK);
    }
    lmn_activity_desc event = LMN_ACTIVITY_DESC_INIT, table = LMN_ACTIVITY_DESC_INIT;
    uint32_t          jump[3] = {hop(s, balls[2], first), 0, hop(s, balls[2], second)}, whole = 0;
    event.kind = LMN_ACTIVITY_EVENT;
    event.name = "bounce";
    event.node = balls[2];
    assert_int_equal(lmn_behaviour_add(s, &event, &jump[1], NULL), LMN_OK);
    const lmn_activity_child rows[] = {{falling_ball(s, balls[0], 4), 0, 0},
                                       {falling_ball(s, balls[1], 3), 1, 0},
                                       {add_group(s, LMN_ACTIVITY_SEQUENCE, jump, 3), 2, 0}};
    table.kind = LMN_ACTIVITY_TABLE;
    table.children = rows;
    table.child_count = 3;
    assert_int_equal(lmn_behaviour_add(s, &table, &whole, NULL), LMN_OK);
    play(s, whole);
    assert_int_equal(lmn_behaviour_root_at(s, 0), whole);
    lmn_dynamics  *ours = dynamics_of(s), *theirs = dynamics_of(script);
    const uint32_t named[] = {node_called(script, "green"), node_called(script, "red"), node_called(script, "blue")};
    assert_true(lmn_dynamics_duration(ours) == lmn_dynamics_duration(theirs));
    for (int i = 0; i < 3; i++)
        for (double t = 0; t <= 4; t += 0.03125) {
            lmn_point_state a = point_at(ours, balls[i], t), b = point_at(theirs, named[i], t);
            for (int k = 0; k < 3; k++)
                assert_true(a.position[k] == b.position[k] && a.velocity[k] == b.velocity[k]);
        }
    lmn_lifetime last;
    assert_true(lmn_dynamics_lifetime_at(ours, 3, &last) && last.is_event && last.from_s == 3 && last.to_s == 3);
    assert_int_equal(last.node, balls[2]);
    assert_int_equal(last.activity, jump[1]);
    lmn_dynamics_destroy(&ours);
    lmn_dynamics_destroy(&theirs);
    lmn_scene_destroy(&s);
    lmn_scene_destroy(&script);
}

/* --- time ---------------------------------------------------------------------------------------------------- */

static const double UNIT_WAY[] = {0, 0, 0, 1, 0, 0};

/* Along x from 0 to 1. */
static uint32_t along(lmn_scene *s, uint32_t node, double duration)
{
    lmn_constraint_desc desc = LMN_CONSTRAINT_DESC_INIT;
    desc.node = node;
    desc.map = LMN_TIME_MAP_LINEAR;
    desc.values = UNIT_WAY;
    desc.value_count = 2;
    desc.duration_s = duration;
    return add_constraint(s, &desc);
}

static double x_at(lmn_scene *s, uint32_t node, double seconds)
{
    lmn_dynamics *d = dynamics_of(s);
    double        x = point_at(d, node, seconds).position[0];
    lmn_dynamics_destroy(&d);
    return x;
}

static void test_modifiers_rewrite_time(void **state)
{
    (void)state;
    lmn_scene         *s = scene_of_nodes(1);
    uint32_t           way = along(s, 1, 2), whole = 0;
    lmn_activity_desc  desc = LMN_ACTIVITY_DESC_INIT;
    lmn_activity_child child = {way, 0, 0};
    desc.children = &child;
    desc.child_count = 1;
    desc.kind = LMN_ACTIVITY_REVERSE;
    assert_int_equal(lmn_behaviour_add(s, &desc, &whole, NULL), LMN_OK);
    play(s, whole);
    assert_true(fabs(x_at(s, 1, 0.5) - 0.75) < 1e-12);
    /* The same activity, exchanged: what plays follows at once. */
    desc.kind = LMN_ACTIVITY_REPEAT;
    desc.times = 3;
    assert_int_equal(lmn_behaviour_set(s, whole, &desc, NULL), LMN_OK);
    assert_true(fabs(x_at(s, 1, 4.5) - 0.25) < 1e-12);
    assert_true(fabs(s->animations[0].duration - 6) < 1e-12);
    desc.kind = LMN_ACTIVITY_CREEP;
    desc.exponent = 3;
    assert_int_equal(lmn_behaviour_set(s, whole, &desc, NULL), LMN_OK);
    assert_true(fabs(x_at(s, 1, 1) - 0.125) < 1e-12);
    desc.kind = LMN_ACTIVITY_SEQUENCE;
    desc.duration_s = 4; /* slower */
    assert_int_equal(lmn_behaviour_set(s, whole, &desc, NULL), LMN_OK);
    assert_true(fabs(x_at(s, 1, 1) - 0.25) < 1e-12);
    assert_string_equal(s->animations[0].name, "behaviour");
    lmn_scene_destroy(&s);
}

static void test_fits_are_those_asked_for(void **state)
{
    (void)state;
    static const struct {
        lmn_activity_fit fit;
        double           from, to, long_to;
    } rows[] = {{LMN_FIT_START, 0, 1, 4},
                {LMN_FIT_CENTRE, 1.5, 2.5, 4},
                {LMN_FIT_END, 3, 4, 4},
                {LMN_FIT_STRETCH, 0, 4, 4},
                {LMN_FIT_SHRINK, 0, 1, 1}};
    lmn_scene               *s = scene_of_nodes(2);
    const lmn_activity_child both[] = {{along(s, 1, 4), 0, 0}, {along(s, 2, 1), 0, 0}};
    uint32_t                 whole = 0;
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        lmn_activity_desc desc = LMN_ACTIVITY_DESC_INIT;
        desc.kind = LMN_ACTIVITY_SIMULTANEITY;
        desc.children = both;
        desc.child_count = 2;
        desc.fit = rows[i].fit;
        assert_int_equal(lmn_behaviour_add(s, &desc, &whole, NULL), LMN_OK);
        play(s, whole);
        lmn_dynamics *d = dynamics_of(s);
        lmn_lifetime  of;
        assert_true(lmn_dynamics_lifetime_at(d, 1, &of));
        assert_true(of.node == 2 && of.from_s == rows[i].from && of.to_s == rows[i].to);
        assert_int_equal(of.activity, both[1].activity);
        assert_true(lmn_dynamics_lifetime_at(d, 0, &of));
        assert_true(of.node == 1 && of.from_s == 0 && of.to_s == rows[i].long_to);
        lmn_dynamics_destroy(&d);
    }
    lmn_scene_destroy(&s);
}

/* As if nobody had played anything: the file's clip is seen again, and what is played again plays. */
static void test_playing_can_be_taken_back(void **state)
{
    (void)state;
    lmn_scene        *s = load_or_fail(LIMNER_SOURCE_DIR "/examples/box-animated.glb");
    lmn_activity_desc desc = LMN_ACTIVITY_DESC_INIT;
    uint32_t          clip = 0;
    const double      half = s->animations[0].duration / 4;
    const uint32_t    moved = (uint32_t)s->animations[0].channels[0].target + 1;
    assert_int_equal(lmn_behaviour_stop(s, NULL), LMN_OK); /* nothing plays */
    lmn_dynamics   *d = dynamics_of(s);
    lmn_point_state before = point_at(d, moved, half), after;
    lmn_dynamics_destroy(&d);
    desc.kind = LMN_ACTIVITY_CLIP;
    desc.clip = "1";
    assert_int_equal(lmn_behaviour_add(s, &desc, &clip, NULL), LMN_OK);
    const uint32_t turned = add_group(s, LMN_ACTIVITY_REVERSE, &clip, 1);
    for (int i = 0; i < 2; i++) {
        play(s, turned);
        d = dynamics_of(s);
        after = point_at(d, moved, half);
        assert_true(fabs(after.position[1] - before.position[1]) > 1e-3 || fabs(after.velocity[1]) > 1e-3);
        assert_int_equal(s->animation_count, 2);
        lmn_dynamics_destroy(&d);
        assert_int_equal(lmn_behaviour_stop(s, NULL), LMN_OK);
        assert_int_equal(s->animation_count, 1);
        assert_int_equal(lmn_behaviour_root_at(s, 0), 0);
        assert_int_equal(lmn_behaviour_count(s), 2);
        d = dynamics_of(s);
        after = point_at(d, moved, half);
        assert_memory_equal(&after, &before, sizeof after);
        lmn_dynamics_destroy(&d);
    }
    lmn_scene_destroy(&s);
}

static void test_clips_are_activities(void **state)
{
    (void)state;
    lmn_scene        *s = load_or_fail(LIMNER_SOURCE_DIR "/examples/box-animated.glb");
    lmn_activity_desc desc = LMN_ACTIVITY_DESC_INIT;
    uint32_t          clip = 0;
    double            length = s->animations[0].duration;
    desc.kind = LMN_ACTIVITY_CLIP;
    desc.clip = "1";
    assert_int_equal(lmn_behaviour_add(s, &desc, &clip, NULL), LMN_OK);
    play(s, add_group(s, LMN_ACTIVITY_REVERSE, &clip, 1));
    lmn_dynamics   *ours = dynamics_of(s), *theirs = NULL;
    lmn_point_state a, b;
    assert_int_equal(lmn_dynamics_create(s, "1", &theirs, NULL), LMN_OK);
    uint32_t moved = (uint32_t)s->animations[0].channels[0].target + 1;
    for (double t = 0.1; t < length; t += 0.1) {
        a = point_at(ours, moved, t);
        b = point_at(theirs, moved, length - t);
        for (int k = 0; k < 3; k++)
            assert_true(fabs(a.position[k] - b.position[k]) < 1e-9);
    }
    lmn_dynamics_destroy(&ours);
    lmn_dynamics_destroy(&theirs);
    /* What is written cannot be in what it is written from. */
    lmn_error error = {0};
    desc.clip = "behaviour";
    assert_int_equal(lmn_behaviour_add(s, &desc, NULL, &error), LMN_USAGE);
    assert_non_null(strstr(error.message, "behaviour itself"));
    lmn_scene_destroy(&s);
}

/* --- maps ------------------------------------------------------------------------------------------------------ */

static void test_maps_are_in_the_units_of_the_header(void **state)
{
    (void)state;
    lmn_scene          *s = scene_of_nodes(2);
    lmn_constraint_desc spin = LMN_CONSTRAINT_DESC_INIT, angle = LMN_CONSTRAINT_DESC_INIT,
                        swing = LMN_CONSTRAINT_DESC_INIT, follow = LMN_CONSTRAINT_DESC_INIT,
                        fall = LMN_CONSTRAINT_DESC_INIT;
    spin.node = 1;
    spin.property = LMN_PROPERTY_ROTATION;
    spin.map = LMN_TIME_MAP_SPIN;
    spin.rate_deg = 90;
    spin.duration_s = 4;
    play(s, add_constraint(s, &spin));
    lmn_dynamics   *d = dynamics_of(s);
    lmn_point_state at;
    assert_int_equal(lmn_dynamics_point(d, 1, (double[3]){1, 0, 0}, 1, &at, NULL), LMN_OK);
    assert_true(fabs(at.position[0]) < 1e-9 && fabs(at.position[2] + 1) < 1e-9); /* +y: x to −z */
    assert_true(fabs(at.velocity[0] + 1.5707963) < 1e-4);
    lmn_dynamics_destroy(&d);
    angle.node = 1;
    angle.property = LMN_PROPERTY_ROTATION;
    angle.about_axis = true;
    angle.axis[2] = 2;
    angle.map = LMN_TIME_MAP_LINEAR;
    angle.values = (const double[]){0, 180};
    angle.value_count = 2;
    angle.duration_s = 2;
    play(s, add_constraint(s, &angle));
    d = dynamics_of(s);
    assert_int_equal(lmn_dynamics_point(d, 1, (double[3]){1, 0, 0}, 1, &at, NULL), LMN_OK);
    assert_true(fabs(at.position[1] - 1) < 1e-9);
    lmn_dynamics_destroy(&d);
    swing.node = 1;
    swing.map = LMN_TIME_MAP_OSCILLATE;
    swing.amplitude[1] = 3;
    swing.frequency = 0.25;
    swing.duration_s = 4;
    follow.node = 2;
    follow.map = LMN_TIME_MAP_FOLLOW;
    follow.follows = 1;
    follow.delay_s = 1;
    follow.offset[0] = 5;
    follow.duration_s = 4;
    const uint32_t both[] = {add_constraint(s, &swing), add_constraint(s, &follow)};
    play(s, add_group(s, LMN_ACTIVITY_SIMULTANEITY, both, 2));
    d = dynamics_of(s);
    assert_true(fabs(point_at(d, 1, 1).position[1] - 3) < 1e-9);
    assert_true(fabs(point_at(d, 2, 2).position[1] - 3) < 1e-9 && fabs(point_at(d, 2, 2).position[0] - 5) < 1e-9);
    lmn_dynamics_destroy(&d);
    fall.node = 1;
    fall.map = LMN_TIME_MAP_FALL;
    fall.start_given = true;
    fall.start[1] = 10;
    fall.duration_s = 1;
    play(s, add_constraint(s, &fall));
    d = dynamics_of(s);
    assert_true(fabs(point_at(d, 1, 0.5).position[1] - (10 - 9.81 / 8)) < 1e-9);
    assert_true(fabs(point_at(d, 1, 0.5).acceleration[1] + 9.81) < 1e-4);
    lmn_dynamics_destroy(&d);
    lmn_scene_destroy(&s);
}

static void test_cameras_and_lights_are_driven(void **state)
{
    (void)state;
    lmn_scene      *s = scene_of_nodes(0);
    lmn_camera_desc camera = LMN_CAMERA_DESC_INIT;
    lmn_light_desc  light = LMN_LIGHT_DESC_INIT;
    lmn_node_desc   node = LMN_NODE_DESC_INIT;
    assert_int_equal(lmn_scene_add_camera(s, &camera, &node.camera, NULL), LMN_OK);
    assert_int_equal(lmn_scene_add_light(s, &light, &node.light, NULL), LMN_OK);
    assert_int_equal(lmn_scene_add_node(s, &node, NULL, NULL), LMN_OK);
    lmn_constraint_desc fov = LMN_CONSTRAINT_DESC_INIT, colour = LMN_CONSTRAINT_DESC_INIT;
    fov.node = colour.node = 1;
    fov.property = LMN_PROPERTY_CAMERA_FOV;
    fov.values = (const double[]){60};
    fov.value_count = 1;
    fov.duration_s = colour.duration_s = 1;
    colour.property = LMN_PROPERTY_LIGHT_COLOUR;
    colour.values = (const double[]){1, 0.5, 0};
    colour.value_count = 1;
    const uint32_t both[] = {add_constraint(s, &fov), add_constraint(s, &colour)};
    play(s, add_group(s, LMN_ACTIVITY_SIMULTANEITY, both, 2));
    const animation *a = &s->animations[0];
    assert_int_equal(a->channel_count, 2);
    for (size_t i = 0; i < 2; i++) {
        const float *v = a->channels[i].values + a->channels[i].components; /* of the first key, behind its slope */
        if (a->channels[i].path == PATH_CAMERA_FOV)
            assert_true(fabsf(v[0] - 1.0471976f) < 1e-5f);
        else
            assert_true(fabsf(v[0] - 1) < 1e-6f && fabsf(v[1] - 0.21404114f) < 1e-5f);
    }
    lmn_dynamics *d = dynamics_of(s);
    lmn_lifetime  of;
    assert_true(lmn_dynamics_lifetime_at(d, 0, &of) && of.node == 1 && of.property == LMN_PROPERTY_CAMERA_FOV);
    lmn_dynamics_destroy(&d);
    lmn_scene_destroy(&s);
}

typedef struct told {
    int    calls, released;
    double from; /* from here on it answers what is none */
} told;

static void circle(double seconds, double *out, void *user)
{
    told *t = user;
    t->calls++;
    out[0] = cos(seconds);
    out[1] = seconds >= t->from ? NAN : sin(seconds);
    out[2] = 0;
}

static void release(void *user)
{
    ((told *)user)->released++;
}

static lmn_constraint_desc called(told *t)
{
    lmn_constraint_desc desc = LMN_CONSTRAINT_DESC_INIT;
    desc.node = 1;
    desc.map = LMN_TIME_MAP_CALLBACK;
    desc.function = circle;
    desc.function_user = t;
    desc.release = release;
    desc.duration_s = 3;
    return desc;
}

static void test_callbacks_are_asked_and_let_go_once(void **state)
{
    (void)state;
    told                good = {0, 0, INFINITY}, bad = {0, 0, 1}, unplayed = {0, 0, INFINITY};
    lmn_scene          *s = scene_of_nodes(1);
    lmn_constraint_desc desc = called(&good);
    uint32_t            first = add_constraint(s, &desc);
    play(s, first);
    assert_true(good.calls > 10);
    assert_true(fabs(x_at(s, 1, 2) - cos(2)) < 1e-12);
    desc = called(&bad); /* refused: all is as it was, and `user` is the caller's */
    lmn_error error = {0};
    assert_int_equal(lmn_behaviour_set_constraint(s, first, &desc, &error), LMN_USAGE);
    assert_non_null(strstr(error.message, "not finite"));
    assert_true(bad.released == 0 && good.released == 0);
    assert_true(fabs(x_at(s, 1, 2) - cos(2)) < 1e-12);
    desc = called(&unplayed);
    assert_int_equal(lmn_behaviour_set_constraint(s, first, &desc, NULL), LMN_OK);
    assert_true(good.released == 1 && unplayed.released == 0);
    lmn_scene_destroy(&s);
    assert_true(good.released == 1 && unplayed.released == 1 && bad.released == 0);
}

/* --- inspection -------------------------------------------------------------------------------------------------- */

static void test_what_drives_a_node_is_told(void **state)
{
    (void)state;
    lmn_scene    *s = scene_of_nodes(1);
    lmn_node_desc below = LMN_NODE_DESC_INIT;
    uint32_t      child = 0, path[4];
    size_t        lifetimes[4], path_count, count;
    below.parent = 1;
    below.matrix[13] = 1;
    assert_int_equal(lmn_scene_add_node(s, &below, &child, NULL), LMN_OK);
    const uint32_t two[] = {along(s, 1, 1), along(s, child, 1)};
    play(s, add_group(s, LMN_ACTIVITY_SEQUENCE, two, 2));
    lmn_dynamics *d = dynamics_of(s);
    assert_int_equal(
        lmn_dynamics_of_node(d, child, -INFINITY, INFINITY, path, 4, &path_count, lifetimes, 4, &count, NULL), LMN_OK);
    assert_true(path_count == 2 && path[0] == 1 && path[1] == child && count == 2);
    assert_int_equal(lmn_dynamics_of_node(d, child, 0.25, 0.75, NULL, 0, &path_count, lifetimes, 1, &count, NULL),
                     LMN_OK);
    assert_true(path_count == 2 && count == 1 && lifetimes[0] == 0);
    assert_int_equal(lmn_dynamics_of_node(d, 1, 0, 2, NULL, 0, &path_count, NULL, 0, &count, NULL), LMN_OK);
    assert_true(path_count == 1 && count == 1);
    lmn_point_state states[8];
    assert_int_equal(lmn_dynamics_trajectory(d, child, NULL, 0, 2, 0.01, states, 8, &count, NULL), LMN_OK);
    assert_true(count == 4 && states[0].position[0] == 0 && fabs(states[3].position[0] - 2) < 1e-12);
    /* A NULL of counts is told apart from numbers that are not there. */
    lmn_error error = {0};
    assert_int_equal(lmn_dynamics_trajectory(d, 9, NULL, 0, 2, 0.01, states, 8, &count, &error), LMN_USAGE);
    assert_non_null(strstr(error.message, "no node 9"));
    assert_int_equal(lmn_dynamics_trajectory(d, 1, NULL, 0, 2, NAN, states, 8, &count, &error), LMN_USAGE);
    assert_int_equal(lmn_dynamics_trajectory(d, 1, NULL, 2, 1, 0.1, states, 8, &count, &error), LMN_USAGE);
    assert_int_equal(lmn_dynamics_point(d, 1, (double[3]){0, NAN, 0}, 1, states, &error), LMN_USAGE);
    assert_int_equal(lmn_dynamics_point(d, 1, NULL, INFINITY, states, &error), LMN_USAGE);
    lmn_dynamics_destroy(&d);
    lmn_scene_destroy(&s);
}

static void test_what_is_refused_changes_nothing(void **state)
{
    (void)state;
    lmn_scene     *s = scene_of_nodes(1);
    const uint32_t way = along(s, 1, 2), whole = add_group(s, LMN_ACTIVITY_SEQUENCE, &way, 1);
    play(s, whole);
    lmn_activity_child itself = {whole, 0, 0};
    lmn_activity_desc  desc = LMN_ACTIVITY_DESC_INIT;
    lmn_error          error = {0};
    size_t             count = lmn_behaviour_count(s);
    desc.children = &itself;
    desc.child_count = 1;
    assert_int_equal(lmn_behaviour_set(s, whole, &desc, &error), LMN_USAGE);
    assert_non_null(strstr(error.message, "contains itself"));
    assert_true(fabs(x_at(s, 1, 1) - 0.5) < 1e-12);
    desc.child_count = 0;
    assert_int_equal(lmn_behaviour_add(s, &desc, NULL, &error), LMN_USAGE);
    assert_int_equal(lmn_behaviour_count(s), count);
    const uint32_t none[] = {99};
    assert_int_equal(lmn_behaviour_play(s, none, 1, &error), LMN_USAGE);
    assert_int_equal(lmn_behaviour_play(s, none, 0, &error), LMN_USAGE);
    assert_int_equal(lmn_behaviour_root_at(s, 0), whole);
    assert_int_equal(s->animation_count, 1);
    lmn_scene_destroy(&s);
}

static void test_memory_may_end_anywhere(void **state)
{
    (void)state;
    for (long n = 1, done = 0; !done; n++) {
        lmn_scene          *s = scene_of_nodes(1);
        lmn_constraint_desc desc = LMN_CONSTRAINT_DESC_INIT;
        lmn_activity_desc   group = LMN_ACTIVITY_DESC_INIT;
        uint32_t            way = 0, whole = 0;
        lmn_dynamics       *d = NULL;
        lmn_contact         contacts[8];
        size_t              count = 0;
        lmn_status          status;
        assert_true(n < 10000);
        desc.name = "falls";
        desc.node = 1;
        desc.map = LMN_TIME_MAP_BOUNCE;
        desc.start_given = true;
        desc.start[1] = 1;
        mem_fail_at(n);
        status = lmn_behaviour_add_constraint(s, &desc, &way, NULL);
        lmn_activity_child child = {way, 0, 0};
        group.children = &child;
        group.child_count = 1;
        if (status == LMN_OK)
            status = lmn_behaviour_add(s, &group, &whole, NULL);
        if (status == LMN_OK)
            status = lmn_behaviour_play(s, &whole, 1, NULL);
        if (status == LMN_OK)
            status = lmn_behaviour_set(s, whole, &group, NULL);
        if (status == LMN_OK)
            status = lmn_dynamics_create(s, NULL, &d, NULL);
        if (status == LMN_OK)
            status = lmn_dynamics_contacts(d, 1, 0, 2, 0.1, contacts, 8, &count, NULL);
        mem_fail_at(0);
        assert_true(status == LMN_OK || status == LMN_MEMORY);
        done = status == LMN_OK;
        lmn_dynamics_destroy(&d);
        lmn_scene_destroy(&s);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_calls_make_what_the_script_makes),
        cmocka_unit_test(test_modifiers_rewrite_time),
        cmocka_unit_test(test_fits_are_those_asked_for),
        cmocka_unit_test(test_clips_are_activities),
        cmocka_unit_test(test_playing_can_be_taken_back),
        cmocka_unit_test(test_maps_are_in_the_units_of_the_header),
        cmocka_unit_test(test_cameras_and_lights_are_driven),
        cmocka_unit_test(test_callbacks_are_asked_and_let_go_once),
        cmocka_unit_test(test_what_drives_a_node_is_told),
        cmocka_unit_test(test_what_is_refused_changes_nothing),
        cmocka_unit_test(test_memory_may_end_anywhere),
    };
    return cmocka_run_group_tests(tests, NULL, remove_temp_folder);
}
