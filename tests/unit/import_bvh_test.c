/* BVH: the hierarchy, what channels become, bones, and files that are wrong. Expected positions come from matrices that
 * are multiplied here. */
#include "import_support.h"
#include "turns.h"

#include <math.h>

#define END(x, y, z) "End Site { OFFSET " #x " " #y " " #z " }"

static lmn_scene *load_text(const char *text)
{
    return load_or_fail(temp_file("motion.bvh", text, strlen(text)));
}

static int32_t node_called(const lmn_scene *s, const char *name)
{
    for (size_t i = 0; i < s->node_count; i++)
        if (s->nodes[i].mesh == NONE && s->nodes[i].name && strcmp(s->nodes[i].name, name) == 0)
            return (int32_t)i;
    return NONE;
}

static const animation_channel *channel_of(const lmn_scene *s, int32_t node_index, animation_path path)
{
    for (size_t i = 0; i < s->animations[0].channel_count; i++)
        if (s->animations[0].channels[i].target == node_index && s->animations[0].channels[i].path == path)
            return &s->animations[0].channels[i];
    return NULL;
}

static size_t warnings_of(const lmn_scene *s, const char *words)
{
    size_t count = 0;
    for (size_t i = 0; i < s->warnings.count; i++)
        if (strstr(s->warnings.items[i].text, words))
            count += s->warnings.items[i].count;
    return count;
}

/* --- what is read --------------------------------------------------------------------------------------- */

static void rotations_are_done_in_the_order_of_the_file(void **state)
{
    (void)state;
    static const char *const orders[] = {"XYZ", "XZY", "YXZ", "YZX", "ZXY", "ZYX", "ZXZ", "XY", "Z"};
    static const double      angles[][3] = {{30, -70, 100}, {-179, 12.5, 300}, {0, 0, 90}, {400, -720, 33}};
    for (size_t o = 0; o < sizeof orders / sizeof *orders; o++) {
        size_t count = strlen(orders[o]);
        char   text[2048];
        int    at = snprintf(text, sizeof text, "HIERARCHY\nROOT a\n{\nOFFSET 0 0 0\nCHANNELS %zu", count);
        for (size_t k = 0; k < count; k++)
            at += snprintf(text + at, sizeof text - (size_t)at, " %crotation", orders[o][k]);
        at += snprintf(text + at, sizeof text - (size_t)at,
                       "\n" END(0, 1, 0) "\n}\nMOTION\nFrames: 4\nFrame Time: 0.25\n");
        for (size_t f = 0; f < 4; f++) {
            for (size_t k = 0; k < count; k++)
                at += snprintf(text + at, sizeof text - (size_t)at, " %g", angles[f][k]);
            at += snprintf(text + at, sizeof text - (size_t)at, "\n");
        }
        lmn_scene               *s = load_text(text);
        const animation_channel *c = channel_of(s, node_called(s, "a"), PATH_ROTATION);
        assert_true(s->animations[0].channel_count == 1 && c->key_count == 4 && c->components == 4);
        for (size_t f = 0; f < 4; f++) {
            turn expected = about(orders[o][0], angles[f][0]);
            for (size_t k = 1; k < count; k++)
                expected = times(expected, about(orders[o][k], angles[f][k]));
            assert_true(difference(expected, of_quaternion(&c->values[4 * f])) < 1e-6);
            assert_true(c->times[f] == 0.25f * (float)f);
        }
        lmn_scene_destroy(&s);
    }
}

static const char figure[] =
    "HIERARCHY\nROOT Hips\n{\n\tOFFSET 1 2 3\n"
    "\tCHANNELS 6 Zposition Yposition Xposition Zrotation Xrotation Yrotation\n"
    "\tJOINT my:Left Arm \n\t{\n\t\tOFFSET 0 4 0\n\t\tCHANNELS 3 Zrotation Xrotation Yrotation\n"
    "\t\tEnd Site\n\t\t{\n\t\t\tOFFSET 3 0 0\n\t\t}\n\t}\n"
    "\tJOINT Leg { OFFSET 0 0 -5 CHANNELS 2 Yposition Xrotation\r\n" END(0, 0, 0) "\n\t}\n}\n"
                                                                                  "MOTION\nFrames:\t2\nFrame Time: .5\n"
                                                                                  "10 20 30  0 0 0  0 0 0  7 0\n"
                                                                                  "11 21 31  90 0 0  0 0 45  8 -30\n";

static void joints_become_nodes_and_channels(void **state)
{
    (void)state;
    lmn_scene *s = load_text(figure);
    int32_t    hips = node_called(s, "Hips"), arm = node_called(s, "my:Left Arm"), leg = node_called(s, "Leg");
    assert_true(hips != NONE && arm != NONE && leg != NONE);
    assert_true(s->nodes[arm].parent == hips && s->nodes[leg].parent == hips && s->nodes[hips].parent == 0);
    assert_true(node_place_of(&s->nodes[hips])->translation[2] == 3 &&
                node_place_of(&s->nodes[leg])->translation[2] == -5);
    assert_true(s->up == 'y' && s->animation_count == 1 && s->warnings.count == 0);
    const animation *a = &s->animations[0];
    assert_string_equal(a->name, "motion");
    assert_true(a->duration == 0.5 && a->channel_count == 5);
    /* Positions are where the joint is, not how far from its offset; an axis without a channel keeps the offset. */
    const float *p = channel_of(s, hips, PATH_TRANSLATION)->values, *q = channel_of(s, leg, PATH_TRANSLATION)->values;
    assert_true(p[0] == 30 && p[1] == 20 && p[2] == 10 && p[3] == 31 && p[5] == 11);
    assert_true(q[0] == 0 && q[1] == 7 && q[2] == -5 && q[4] == 8);
    assert_null(channel_of(s, arm, PATH_TRANSLATION));
    assert_true(difference(of_quaternion(channel_of(s, arm, PATH_ROTATION)->values + 4), about('Y', 45)) < 1e-6);
    assert_true(difference(of_quaternion(channel_of(s, leg, PATH_ROTATION)->values + 4), about('X', -30)) < 1e-6);
    for (size_t i = 0; i < a->channel_count; i++)
        assert_int_equal(a->channels[i].interpolation, INTERPOLATION_LINEAR);
    lmn_scene_destroy(&s);
}

/* Linear interpolation of neighbours must not go the long way round. */
static void quaternions_keep_their_sign(void **state)
{
    (void)state;
    char text[8192];
    int  at = snprintf(text, sizeof text,
                       "HIERARCHY ROOT a { OFFSET 0 0 0 CHANNELS 3 Zrotation Xrotation Yrotation\n" END(
                           0, 1, 0) "}\nMOTION\nFrames: 100\nFrame Time: 0.01\n");
    for (int i = 0; i < 100; i++) /* as files have angles: within half a turn */
        at += snprintf(text + at, sizeof text - (size_t)at, "%d 20 %d\n", (i * 17 + 180) % 360 - 180, i * 3 % 360);
    lmn_scene               *s = load_text(text);
    const animation_channel *c = channel_of(s, node_called(s, "a"), PATH_ROTATION);
    bool                     wraps = false;
    for (int i = 1; i < 100; i++) {
        const float *a = &c->values[4 * (i - 1)], *b = a + 4;
        assert_true(a[0] * b[0] + a[1] * b[1] + a[2] * b[2] + a[3] * b[3] > 0.9f);
        wraps = wraps || b[3] < 0;
    }
    assert_true(wraps);
    lmn_scene_destroy(&s);
}

/* --- bones ---------------------------------------------------------------------------------------------- */

/* The volume of a closed mesh, negative when it is wound inside out. */
static double volume_of(const primitive *p)
{
    double volume = 0;
    for (uint32_t i = 0; i < p->index_count; i += 3) {
        vec3 a = p->positions[p->indices[i]], b = p->positions[p->indices[i + 1]], c = p->positions[p->indices[i + 2]];
        volume +=
            (double)(a.x * (b.y * c.z - b.z * c.y) + a.y * (b.z * c.x - b.x * c.z) + a.z * (b.x * c.y - b.y * c.x));
    }
    return volume / 6;
}

static void bones_reach_from_joint_to_joint(void **state)
{
    (void)state;
    static const double tips[][3] = {{0, 4, 0}, {0, -4, 0}, {3, 0, 0},  {-3, 0, 0},
                                     {0, 0, 2}, {0, 0, -2}, {1, 2, -3}, {1e-5, -5, 0}};
    enum { TIPS = sizeof tips / sizeof *tips };
    char text[2048];
    int  at = snprintf(text, sizeof text, "HIERARCHY\nROOT hub {\nOFFSET 10 20 30\n");
    for (int i = 0; i < TIPS; i++)
        at += snprintf(text + at, sizeof text - (size_t)at, "JOINT j%d { OFFSET %g %g %g }\n", i, tips[i][0],
                       tips[i][1], tips[i][2]);
    snprintf(text + at, sizeof text - (size_t)at, "}\n");
    lmn_scene *s = load_text(text);
    assert_int_equal(s->part_count, TIPS);
    assert_int_equal(warnings_of(s, "no motion"), 1);
    for (int i = 0; i < TIPS; i++) {
        const part      *p = &s->parts[i];
        const mesh      *m = &s->meshes[s->nodes[p->node].mesh];
        const primitive *shape = &m->primitives[0];
        mat4             world = scene_world_matrix(s, p->node);
        double           length = sqrt(tips[i][0] * tips[i][0] + tips[i][1] * tips[i][1] + tips[i][2] * tips[i][2]);
        double           reach = 0, least = 1e9, farthest = 0;
        assert_string_equal(p->name, "hub");
        assert_true(shape->index_count == 24 && volume_of(shape) > 0);
        for (uint32_t v = 0; v < shape->vertex_count; v++) {
            vec3   at_world = mat4_transform_point(&world, shape->positions[v]);
            double along = 0, square = 0, from[3] = {at_world.x - 10.0, at_world.y - 20.0, at_world.z - 30.0};
            for (int k = 0; k < 3; k++) {
                along += from[k] * tips[i][k] / length;
                square += from[k] * from[k];
            }
            reach = fmax(reach, along);
            least = fmin(least, along);
            farthest = fmax(farthest, sqrt(fmax(square - along * along, 0)));
        }
        assert_true(fabs(reach - length) < 1e-5 * length + 1e-5 && fabs(least) < 1e-5);
        assert_true(farthest > 0.04 * length && farthest < 0.12 * length);
    }
    lmn_scene_destroy(&s);
}

static void skeletons_without_length_are_empty(void **state)
{
    (void)state;
    lmn_scene *s = load_text(
        "HIERARCHY ROOT a { OFFSET 0 5 0 CHANNELS 1 Xrotation " END(0, 0, 0) " } MOTION Frames: 1 Frame Time: 0\n7\n");
    assert_true(s->part_count == 0 && s->animation_count == 1 && s->animations[0].duration == 0);
    assert_int_equal(warnings_of(s, "nothing to draw"), 1);
    lmn_scene_destroy(&s);
}

static void the_walker_walks(void **state)
{
    (void)state;
    lmn_scene       *s = load_or_fail(LIMNER_SOURCE_DIR "/examples/walker.bvh");
    const animation *a = &s->animations[0];
    assert_true(s->animation_count == 1 && strcmp(a->name, "walker") == 0 && fabs(a->duration - 2) < 1e-4);
    assert_int_equal(a->channel_count, 20); /* 19 joints turn, the hips move too */
    const animation_channel *hips = channel_of(s, node_called(s, "Hips"), PATH_TRANSLATION);
    for (size_t i = 1; i < hips->key_count; i++)
        assert_true(hips->values[3 * i + 2] > hips->values[3 * i - 1]);
    assert_int_equal(s->warnings.count, 0);
    assert_int_equal(s->part_count, 23);
    lmn_scene_destroy(&s);
}

/* --- what is wrong -------------------------------------------------------------------------------------- */

#define HEAD   "HIERARCHY\nROOT a\n{\nOFFSET 0 0 0\nCHANNELS 3 Xrotation Yrotation Zrotation\n" END(0, 1, 0) "\n}\n"
#define MOTION "MOTION\nFrames: 2\nFrame Time: 0.1\n"

static void wrong_files_are_explained(void **state)
{
    (void)state;
    static const struct {
        const char *text, *said;
        int         line;
    } cases[] = {
        {"HIERARCHY\nJOINT a", "expected \"ROOT\", found \"JOINT\"", 2},
        {"HIERARCHY\nROOT a\nOFFSET 0 0 0", "expected \"{\", found \"OFFSET\"", 3},
        {"HIERARCHY\nROOT a\n{\nCHANNELS 3", "expected \"OFFSET\", found \"CHANNELS\"", 4},
        {"HIERARCHY\nROOT a\n{\nOFFSET 0 0\n}", "three numbers after \"OFFSET\", found \"}\"", 5},
        {"HIERARCHY\nROOT a\n{\nOFFSET 0 0 nan\n}", "three numbers", 4},
        {"HIERARCHY\nROOT a\n{\nOFFSET 0 0 1e31\n}", "three numbers", 4},
        {"HIERARCHY\nROOT a\n{\nOFFSET 0 0 1,5\n}", "three numbers", 4},
        {"HIERARCHY\nROOT a\n{\nOFFSET 0 0 0\nCHANNELS 7 Xrotation", "from 0 to 6", 5},
        {"HIERARCHY\nROOT a\n{\nOFFSET 0 0 0\nCHANNELS -1", "from 0 to 6", 5},
        {"HIERARCHY\nROOT a\n{\nOFFSET 0 0 0\nCHANNELS 2 Xrotation Wrotation", "found \"Wrotation\"", 5},
        {"HIERARCHY\nROOT a\n{\nOFFSET 0 0 0\nCHANNELS 2 Xposition\nXposition", "position channel twice", 6},
        {"HIERARCHY\nROOT a\n{\nOFFSET 0 0 0\nLIMB b", "found \"LIMB\"", 5},
        {"HIERARCHY\nROOT a\n{\nOFFSET 0 0 0\n" END(0, 1, 0) "\n", "cut off", 6},
        {"HIERARCHY\nROOT a\n{\nOFFSET 0 0 0\nEnd Site\n{\nOFFSET 0 1 0\nJOINT b", "expected \"}\"", 8},
        {HEAD "MOTIONS", "\"ROOT\" or \"MOTION\"", 8},
        {HEAD "MOTION\nFrame Time: 1", "expected \"Frames:\"", 9},
        {HEAD "MOTION\nFrames: -1", "how many frames", 9},
        {HEAD "MOTION\nFrames: 2.5", "how many frames", 9},
        {HEAD "MOTION\nFrames: 2\nTime: 1", "\"Frame Time:\"", 10},
        {HEAD "MOTION\nFrames: 2\nFrame Time: 0\n1 2 3\n4 5 6", "seconds of a frame", 10},
        {HEAD "MOTION\nFrames: 2\nFrame Time: -1\n1 2 3\n4 5 6", "seconds of a frame", 10},
        {HEAD "MOTION\nFrames: 2\nFrame Time: 1e9\n1 2 3\n4 5 6", "seconds of a frame", 10},
        {HEAD MOTION "1 2 3\n\n4 5\n", "frame 1 has 2 numbers, the channels are 3", 13},
        {HEAD MOTION "1 2 3 4\n5 6\n", "frame 0 has more numbers than the 3 channels", 11},
        {HEAD MOTION "1 2 3\n4 x5 6", "expected a number, found \"x5\"", 12},
        {HEAD MOTION "1 2 3\n4 5e 6", "expected a number", 12},
        {HEAD MOTION "1 2 3\n4 inf 6", "expected a number", 12},
        {HEAD MOTION "1 2 33333\n", "the file is cut off: expected another frame", 12},
        {HEAD MOTION "1 2 3\n", "the file is cut off: 2 frames of 3 numbers", 10},
        {HEAD "MOTION\nFrames: 2147483647\nFrame Time: 1\n1 2 3\n", "the file is cut off", 10},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        lmn_error  error;
        lmn_status status = load_status(temp_file("wrong.bvh", cases[i].text, strlen(cases[i].text)), &error);
        if (status != LMN_FORMAT || !strstr(error.message, cases[i].said) || error.line != cases[i].line)
            print_error("case %zu: line %d: %s\n", i, error.line, error.message);
        assert_int_equal(status, LMN_FORMAT);
        assert_non_null(strstr(error.message, cases[i].said));
        assert_int_equal(error.line, cases[i].line);
    }
}

static void what_is_left_over_is_said(void **state)
{
    (void)state;
    lmn_scene *s = load_text(HEAD MOTION "1 2 3\n4 5 6\n7 8 9\n");
    assert_int_equal(warnings_of(s, "6 bytes behind the last frame"), 1);
    lmn_scene_destroy(&s);
    s = load_text(HEAD "MOTION\nFrames: 0\nFrame Time: 0.1\n");
    assert_true(s->animation_count == 0 && warnings_of(s, "no frames") == 1);
    lmn_scene_destroy(&s);
    s = load_text("HIERARCHY\nROOT a { OFFSET 0 0 0 " END(0, 1, 0) " } MOTION Frames: 9 Frame Time: 1\n");
    assert_true(s->animation_count == 0 && warnings_of(s, "no channels") == 1);
    lmn_scene_destroy(&s);
}

/* Content decides, whatever the ending; words in any case; a byte order mark. */
static void motion_is_known_by_its_first_words(void **state)
{
    (void)state;
    const char text[] =
        "\xEF\xBB\xBFhierarchy\nroot a\n{\noffset 0 0 0\nchannels 1 xRotation\nend site\n{\noffset 0 1 0\n}\n}\n"
        "motion\nframes : 1\nframe time :1\n5";
    lmn_scene *s = load_or_fail(temp_file("nameless", text, sizeof text - 1));
    assert_int_equal(s->animations[0].channel_count, 1);
    lmn_scene_destroy(&s);
    lmn_error error;
    assert_int_equal(load_status(temp_file("motion.obj", text, sizeof text - 1), &error), LMN_FORMAT);
    assert_non_null(strstr(error.message, "the content is BVH"));
}

static void deep_skeletons_are_a_limit(void **state)
{
    (void)state;
    enum { DEEPEST = 1022 };
    static char text[200000];
    for (int depth = DEEPEST; depth <= DEEPEST + 1; depth++) {
        int at = snprintf(text, sizeof text, "HIERARCHY\nROOT r\n{\nOFFSET 0 0 0\n");
        for (int i = 1; i < depth; i++)
            at += snprintf(text + at, sizeof text - (size_t)at, "JOINT j\n{\nOFFSET 0 1 0\n");
        for (int i = 0; i < depth; i++)
            at += snprintf(text + at, sizeof text - (size_t)at, "}\n");
        lmn_error error;
        assert_int_equal(load_status(temp_file("deep.bvh", text, (size_t)at), &error),
                         depth == DEEPEST ? LMN_OK : LMN_LIMIT);
    }
}

static void memory_may_run_out(void **state)
{
    (void)state;
    char path[256];
    snprintf(path, sizeof path, "%s", temp_file("motion.bvh", figure, strlen(figure)));
    lmn_scene *scene = NULL;
    assert_int_equal(lmn_scene_create(&scene, NULL), LMN_OK);
    lmn_status status = LMN_MEMORY;
    for (long n = 1; status != LMN_OK && n < 10000; n++) {
        lmn_error error;
        mem_fail_at(n);
        status = lmn_scene_add_file(scene, path, NULL, &error);
        mem_fail_at(0);
        assert_true(status == LMN_OK || (status == LMN_MEMORY && scene->node_count == 0));
    }
    assert_int_equal(status, LMN_OK);
    lmn_scene_destroy(&scene);
}

/* Stops while frames are read, of which it is told several times. */
static bool stop_soon(double fraction, const char *stage, void *user)
{
    int *calls = user;
    *calls += strcmp(stage, "reading") == 0 && fraction > 0;
    return *calls < 3;
}

static void reading_can_be_stopped(void **state)
{
    (void)state;
    static char text[400000];
    int         at = snprintf(text, sizeof text, HEAD "MOTION\nFrames: 20000\nFrame Time: 0.1\n");
    for (int i = 0; i < 20000; i++)
        at += snprintf(text + at, sizeof text - (size_t)at, "1 2 3\n");
    lmn_load_desc desc = LMN_LOAD_DESC_INIT;
    lmn_scene    *scene = NULL;
    lmn_error     error;
    int           calls = 0;
    desc.progress = stop_soon;
    desc.progress_user = &calls;
    assert_int_equal(lmn_scene_create(&scene, NULL), LMN_OK);
    assert_int_equal(lmn_scene_add_file(scene, temp_file("long.bvh", text, (size_t)at), &desc, &error), LMN_CANCELLED);
    assert_int_equal(calls, 3);
    lmn_scene_destroy(&scene);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(rotations_are_done_in_the_order_of_the_file),
        cmocka_unit_test(joints_become_nodes_and_channels),
        cmocka_unit_test(quaternions_keep_their_sign),
        cmocka_unit_test(bones_reach_from_joint_to_joint),
        cmocka_unit_test(skeletons_without_length_are_empty),
        cmocka_unit_test(the_walker_walks),
        cmocka_unit_test(wrong_files_are_explained),
        cmocka_unit_test(what_is_left_over_is_said),
        cmocka_unit_test(motion_is_known_by_its_first_words),
        cmocka_unit_test(deep_skeletons_are_a_limit),
        cmocka_unit_test(memory_may_run_out),
        cmocka_unit_test(reading_can_be_stopped),
    };
    return cmocka_run_group_tests(tests, NULL, remove_temp_folder);
}
