/* Motion capture that moves a model's skin. What the joints should do is worked out here with matrices. */
#include "import_support.h"
#include "turns.h"

/* A skinned triangle over five joints whose rest is turned every way; "Twist" has no counterpart. */
static const char model_nodes[] =
    "\"nodes\":[{\"mesh\":0,\"skin\":0,\"name\":\"body\"},"
    "{\"name\":\"armature\",\"translation\":[1,0,2],\"rotation\":[0,0.6,0,0.8],\"scale\":[2,2,2],\"children\":[2]},"
    "{\"name\":\"mixamorig:hips\",\"matrix\":[0,1,0,0, -1,0,0,0, 0,0,1,0, 0,5,0,1],\"children\":[3,6]},"
    "{\"name\":\"Twist\",\"rotation\":[0.6,0,0,0.8],\"translation\":[0,1,0],\"children\":[4]},"
    "{\"name\":\"mixamorig:Arm\",\"rotation\":[0,0,0.28,0.96],\"translation\":[0,1,0],\"children\":[5]},"
    "{\"name\":\"mixamorig:Hand\",\"translation\":[1,0,0]},"
    "{\"name\":\"mixamorig:Leg\",\"translation\":[-5,0,0]}],"
    "\"skins\":[{\"joints\":[2,3,4,5,6]}]";

static const char motion_head[] = "HIERARCHY\nROOT Hips\n{\nOFFSET 0 0 0\n"
                                  "CHANNELS 6 Xposition Yposition Zposition Zrotation Xrotation Yrotation\n"
                                  "JOINT Arm { OFFSET 0 3 0 CHANNELS 3 Xrotation Yrotation Zrotation\n"
                                  "JOINT Hand { OFFSET 2 0 0 CHANNELS 1 Yrotation\n"
                                  "End Site { OFFSET 1 0 0 } } }\n"
                                  "JOINT LEG { OFFSET 0 -20 0 CHANNELS 3 Zrotation Xrotation Yrotation\n"
                                  "End Site { OFFSET 0 -1 0 } }\n}\n"
                                  "MOTION\nFrames: 3\nFrame Time: 0.5\n";

/* Of each frame: where the hips are, and the angles in the order of the file. */
static const double frames[3][13] = {{3, 21, -4, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0},
                                     {4, 23, -2, 20, -30, 70, 45, 10, -80, 60, 5, 6, 7},
                                     {3, 19, 5, 170, 80, -100, -45, 100, 33, -60, 90, 0, 200}};

static const char *write_motion(const char *head)
{
    char text[4096];
    int  at = snprintf(text, sizeof text, "%s", head);
    for (int f = 0; f < 3; f++) {
        for (int i = 0; i < 13; i++)
            at += snprintf(text + at, sizeof text - (size_t)at, "%g ", frames[f][i]);
        at += snprintf(text + at, sizeof text - (size_t)at, "\n");
    }
    return temp_file("dance.bvh", text, (size_t)at);
}

/* The inverse bind matrices of five joints are accessor 3. */
static float binds[5][16];

static const char *write_model(const char *nodes)
{
    static glb            g;
    static const float    triangle[3][3] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, weights[3][4] = {{1}, {1}, {1}};
    static const uint16_t joints[3][4] = {{0}, {2}, {4}};
    memset(&g, 0, sizeof g);
    size_t a = glb_put(&g, triangle, sizeof triangle), b = glb_put(&g, joints, sizeof joints),
           c = glb_put(&g, weights, sizeof weights), d = glb_put(&g, binds, sizeof binds);
    snprintf(g.json, sizeof g.json,
             "{\"asset\":{\"version\":\"2.0\"},\"buffers\":[{\"byteLength\":%zu}],\"bufferViews\":[{\"buffer\":0,"
             "\"byteOffset\":%zu,\"byteLength\":36},{\"buffer\":0,\"byteOffset\":%zu,\"byteLength\":24},{\"buffer\":0,"
             "\"byteOffset\":%zu,\"byteLength\":48},{\"buffer\":0,\"byteOffset\":%zu,\"byteLength\":320}],"
             "\"accessors\":[{\"bufferView\":0,\"count\":3,\"componentType\":"
             "5126,\"type\":\"VEC3\"},{\"bufferView\":1,\"count\":3,\"componentType\":5123,\"type\":\"VEC4\"},"
             "{\"bufferView\":2,\"count\":3,\"componentType\":5126,\"type\":\"VEC4\"},{\"bufferView\":3,\"count\":5,"
             "\"componentType\":5126,\"type\":\"MAT4\"}],\"meshes\":[{\"primitives\":[{"
             "\"attributes\":{\"POSITION\":0,\"JOINTS_0\":1,\"WEIGHTS_0\":2}}]}],%s}",
             g.bin_size, a, b, c, d, nodes);
    return glb_file(&g, "model.glb");
}

static int32_t node_called(const lmn_scene *s, const char *name)
{
    for (size_t i = 0; i < s->node_count; i++)
        if (s->nodes[i].name && strcmp(s->nodes[i].name, name) == 0)
            return (int32_t)i;
    return NONE;
}

static const animation_channel *channel_of(const lmn_scene *s, int32_t node_index, animation_path path)
{
    const animation *a = &s->animations[s->animation_count - 1];
    for (size_t i = 0; i < a->channel_count; i++)
        if (a->channels[i].target == node_index && a->channels[i].path == path)
            return &a->channels[i];
    return NULL;
}

static void add_file(lmn_scene *s, const char *path, lmn_up_axis up)
{
    lmn_load_desc desc = LMN_LOAD_DESC_INIT;
    lmn_error     error = {0};
    desc.up_axis = up;
    lmn_status status = lmn_scene_add_file(s, path, &desc, &error);
    if (status != LMN_OK)
        print_error("%s\n", error.message);
    assert_int_equal(status, LMN_OK);
}

/* --- what is expected ----------------------------------------------------------------------------------- */

enum { HIPS, ARM, HAND, LEG, FOLLOWED };
static const char *const followed[FOLLOWED] = {"mixamorig:hips", "mixamorig:Arm", "mixamorig:Hand", "mixamorig:Leg"};

static turn three(const char *order, const double *angles)
{
    return times(times(about(order[0], angles[0]), about(order[1], angles[1])), about(order[2], angles[2]));
}

/* How a joint of the motion is turned in the world of the motion. */
static turn motion_turn(int joint, int frame)
{
    turn hips = three("ZXY", &frames[frame][3]);
    if (joint == HIPS)
        return hips;
    if (joint == LEG)
        return times(hips, three("ZXY", &frames[frame][10]));
    turn arm = times(hips, three("XYZ", &frames[frame][6]));
    return joint == ARM ? arm : times(arm, about('Y', frames[frame][9]));
}

/* How a node is turned in the world: its channel in a frame (−1: none, the rest) below its parents'. */
static turn world_turn(const lmn_scene *s, int32_t node_index, int frame)
{
    const node              *n = &s->nodes[node_index];
    const animation_channel *c = channel_of(s, node_index, PATH_ROTATION);
    float                    q[4];
    for (int k = 0; k < 4; k++)
        q[k] = frame >= 0 && c ? c->values[4 * frame + k] : (float)node_place_of(n)->rotation[k];
    turn own = of_quaternion(q);
    if (n->has_matrix) /* the file's root, of which only a quarter turn can be */
        for (int row = 0; row < 3; row++)
            for (int column = 0; column < 3; column++)
                own.m[row][column] = n->place->matrix.m[4 * column + row];
    return n->parent == NONE ? own : times(world_turn(s, n->parent, frame), own);
}

static turn transposed(turn a)
{
    turn out;
    for (int i = 0; i < 3; i++)
        for (int k = 0; k < 3; k++)
            out.m[i][k] = a.m[k][i];
    return out;
}

static lmn_scene *load_both(lmn_up_axis model_up, lmn_up_axis motion_up)
{
    lmn_scene *s = NULL;
    assert_int_equal(lmn_scene_create(&s, NULL), LMN_OK);
    add_file(s, write_model(model_nodes), model_up);
    add_file(s, write_motion(motion_head), motion_up);
    return s;
}

/* `axes` takes the axes of the motion's file to those of the scene. */
static void check_turns(const lmn_scene *s, turn axes)
{
    for (int f = 0; f < 3; f++)
        for (int j = 0; j < FOLLOWED; j++) {
            int32_t n = node_called(s, followed[j]);
            turn    delta = times(times(axes, motion_turn(j, f)), transposed(axes));
            assert_true(difference(world_turn(s, n, f), times(delta, world_turn(s, n, -1))) < 2e-6);
        }
}

static void joints_turn_as_those_of_the_motion(void **state)
{
    (void)state;
    lmn_scene *s = load_both(LMN_UP_AUTO, LMN_UP_AUTO);
    check_turns(s, about('X', 0));
    lmn_scene_destroy(&s);
    /* A scene with another axis up: the motion is brought to it. */
    s = load_both(LMN_UP_Z, LMN_UP_Y);
    check_turns(s, about('X', 90));
    lmn_scene_destroy(&s);
    s = load_both(LMN_UP_Y, LMN_UP_Z);
    check_turns(s, about('X', -90));
    lmn_scene_destroy(&s);
}

static void nothing_but_the_animation_is_added(void **state)
{
    (void)state;
    lmn_scene *s = load_both(LMN_UP_AUTO, LMN_UP_AUTO);
    assert_true(s->part_count == 1 && s->node_count == 8 && s->file_count == 2 && s->animation_count == 1);
    assert_string_equal(s->animations[0].name, "dance");
    assert_true(s->animations[0].duration == 1 && s->animations[0].channel_count == FOLLOWED + 1);
    assert_null(channel_of(s, node_called(s, "Twist"), PATH_ROTATION));
    /* What moves has no matrix. */
    assert_false(s->nodes[node_called(s, "mixamorig:hips")].has_matrix);
    assert_true(has_warning(s, WARNING_BAD_VALUE));
    for (size_t i = 0; i < s->animations[0].channel_count; i++) {
        const animation_channel *c = &s->animations[0].channels[i];
        assert_true(c->key_count == 3 && c->times[2] == 1 && c->interpolation == INTERPOLATION_LINEAR);
        for (size_t k = 1; k < 3 && c->path == PATH_ROTATION; k++) {
            double along = 0;
            for (size_t e = 0; e < 4; e++)
                along += (double)c->values[4 * k + e] * (double)c->values[4 * k - 4 + e];
            assert_true(along >= 0);
        }
    }
    lmn_scene_destroy(&s);
}

/* The hips' place in the world: armature · translation, the armature being turned about y and twice as large. */
static void hips_in_world(const lmn_scene *s, int frame, double out[3])
{
    const float *t = channel_of(s, node_called(s, "mixamorig:hips"), PATH_TRANSLATION)->values + 3 * frame;
    turn         armature = of_quaternion((float[4]){0, 0.6f, 0, 0.8f});
    const double from[3] = {1, 0, 2};
    for (int i = 0; i < 3; i++)
        out[i] = from[i] + 2 * (armature.m[i][0] * (double)t[0] + armature.m[i][1] * (double)t[1] +
                                armature.m[i][2] * (double)t[2]);
}

/* The model's hips are 10 above its leg joint, the motion's 20: steps are half as long. The motion stands with its
 * hips 21 above the ground, the model with its own at (1, 10, 2). */
static void hips_go_in_steps_as_long_as_the_legs(void **state)
{
    (void)state;
    lmn_scene *s = load_both(LMN_UP_AUTO, LMN_UP_AUTO);
    for (int f = 0; f < 3; f++) {
        double at[3],
            expected[3] = {1 + 0.5 * (frames[f][0] - 3), 10 + 0.5 * (frames[f][1] - 21), 2 + 0.5 * (frames[f][2] + 4)};
        hips_in_world(s, f, at);
        for (int k = 0; k < 3; k++)
            assert_true(fabs(at[k] - expected[k]) < 1e-5);
    }
    lmn_scene_destroy(&s);
}

/* When heights are not those above the ground, they count from the first frame on. */
static void heights_may_count_from_anywhere(void **state)
{
    (void)state;
    char text[2048];
    snprintf(text, sizeof text, "%s%s", motion_head,
             "0 -1 0 0 0 0 0 0 0 0 0 0 0\n0 1 0 0 0 0 0 0 0 0 0 0 0\n0 -2 0 0 0 0 0 0 0 0 0 0 0\n");
    lmn_scene *s = NULL;
    double     at[3];
    assert_int_equal(lmn_scene_create(&s, NULL), LMN_OK);
    add_file(s, write_model(model_nodes), LMN_UP_AUTO);
    add_file(s, temp_file("floating.bvh", text, strlen(text)), LMN_UP_AUTO);
    hips_in_world(s, 0, at);
    assert_true(fabs(at[1] - 10) < 1e-5);
    hips_in_world(s, 1, at);
    assert_true(fabs(at[1] - 11) < 1e-5);
    lmn_scene_destroy(&s);
}

/* The nodes of a file may show the figure in the middle of a movement; the pose that counts is the one that the skin
 * was bound in, which its matrices tell. Where the mesh's node is, here a quarter turn, it was bound. */
static void the_pose_that_counts_is_the_bound_one(void **state)
{
    (void)state;
    static const char nodes[] =
        "\"nodes\":[{\"mesh\":0,\"skin\":0,\"rotation\":[0,0.70710678118,0,0.70710678118]},"
        "{\"name\":\"hips\",\"translation\":[0,9,0],\"rotation\":[0.6,0,0,0.8],\"children\":[2,5]},"
        "{\"name\":\"Twist\",\"rotation\":[0.6,0,0,0.8],\"translation\":[0,1,0],\"children\":[3]},"
        "{\"name\":\"Arm\",\"rotation\":[0,0,0.28,0.96],\"translation\":[0,1,0],\"children\":[4]},"
        "{\"name\":\"Hand\",\"translation\":[1,0,0]},{\"name\":\"Leg\",\"translation\":[-5,0,0]}],"
        "\"skins\":[{\"joints\":[1,2,3,4,5],\"inverseBindMatrices\":3}]";
    const turn   turns[5] = {about('Z', 40), about('X', 0), about('X', -20), about('Y', 75), about('Z', 180)};
    const double places[5][3] = {{0, 6, 0}, {0, 7, 0}, {0, 8, 0}, {1, 8, 0}, {0, 1, 0}};
    /* joint⁻¹ · mesh, the mesh being turned about y. */
    for (int j = 0; j < 5; j++) {
        turn back = transposed(turns[j]), both = times(back, about('Y', 90));
        for (int row = 0; row < 3; row++) {
            for (int column = 0; column < 3; column++) {
                binds[j][4 * column + row] = (float)both.m[row][column];
                binds[j][12 + row] -= (float)(back.m[row][column] * places[j][column]);
            }
        }
        binds[j][15] = 1;
    }
    lmn_scene *s = NULL;
    assert_int_equal(lmn_scene_create(&s, NULL), LMN_OK);
    add_file(s, write_model(nodes), LMN_UP_AUTO);
    add_file(s, write_motion(motion_head), LMN_UP_AUTO);
    static const struct {
        const char *name;
        int         motion, skin;
    } joints[4] = {{"hips", HIPS, 0}, {"Arm", ARM, 2}, {"Hand", HAND, 3}, {"Leg", LEG, 4}};
    for (int f = 0; f < 3; f++)
        for (int j = 0; j < 4; j++)
            assert_true(difference(world_turn(s, node_called(s, joints[j].name), f),
                                   times(motion_turn(joints[j].motion, f), turns[joints[j].skin])) < 2e-6);
    /* Bound, the hips are 5 above the leg joint and stand 6 high. */
    const float *at = channel_of(s, node_called(s, "hips"), PATH_TRANSLATION)->values;
    for (int f = 0; f < 3; f++)
        assert_true(fabs((double)at[3 * f + 1] - (6 + 0.25 * (frames[f][1] - 21))) < 1e-5);
    lmn_scene_destroy(&s);
    memset(binds, 0, sizeof binds);
}

static void other_names_keep_their_own_skeleton(void **state)
{
    (void)state;
    lmn_scene *s = NULL;
    assert_int_equal(lmn_scene_create(&s, NULL), LMN_OK);
    add_file(s,
             write_model("\"nodes\":[{\"mesh\":0,\"skin\":0,\"children\":[1,2,3,4,5]},{\"name\":\"Hips\"},"
                         "{\"name\":\"b\"},{\"name\":\"c\"},{\"name\":\"d\"},{}],\"skins\":[{\"joints\":[1,2,3,4,5]}]"),
             LMN_UP_AUTO);
    add_file(s, write_motion(motion_head), LMN_UP_AUTO);
    assert_true(s->part_count == 6 && s->animation_count == 1);
    assert_true(has_warning(s, WARNING_NO_MATCH));
    /* The motion moves what came with it. */
    int32_t target = s->animations[0].channels[0].target;
    assert_string_equal(s->nodes[target].name, "Hips");
    assert_true(target > node_called(s, "dance"));
    lmn_scene_destroy(&s);
    /* Without a skin nobody asks for one. */
    assert_int_equal(lmn_scene_create(&s, NULL), LMN_OK);
    add_file(s, write_motion(motion_head), LMN_UP_AUTO);
    add_file(s, write_motion(motion_head), LMN_UP_AUTO);
    assert_true(s->animation_count == 2 && s->warnings.count == 0 && s->part_count == 10);
    lmn_scene_destroy(&s);
}

static void memory_may_run_out(void **state)
{
    (void)state;
    lmn_scene *s = NULL;
    assert_int_equal(lmn_scene_create(&s, NULL), LMN_OK);
    add_file(s, write_model(model_nodes), LMN_UP_AUTO);
    const char *path = write_motion(motion_head);
    lmn_status  status = LMN_MEMORY;
    for (long n = 1; status != LMN_OK && n < 10000; n++) {
        lmn_error error;
        mem_fail_at(n);
        status = lmn_scene_add_file(s, path, NULL, &error);
        mem_fail_at(0);
        if (status != LMN_OK) {
            assert_int_equal(status, LMN_MEMORY);
            assert_true(s->animation_count == 0 && s->file_count == 1 && s->node_count == 8);
            assert_true(s->nodes[node_called(s, "mixamorig:hips")].has_matrix);
        }
    }
    assert_int_equal(status, LMN_OK);
    assert_int_equal(s->animation_count, 1);
    lmn_scene_destroy(&s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(joints_turn_as_those_of_the_motion),
        cmocka_unit_test(nothing_but_the_animation_is_added),
        cmocka_unit_test(hips_go_in_steps_as_long_as_the_legs),
        cmocka_unit_test(heights_may_count_from_anywhere),
        cmocka_unit_test(the_pose_that_counts_is_the_bound_one),
        cmocka_unit_test(other_names_keep_their_own_skeleton),
        cmocka_unit_test(memory_may_run_out),
    };
    return cmocka_run_group_tests(tests, NULL, remove_temp_folder);
}
