/* Which way is up: models that are known, turned six ways. */
#include "import_support.h"

#include <math.h>

#include "import/import.h"
#include "import/up_axis.h"

/* One of the six directions becomes up: signed axes that +x, +y and +z of the model go to. */
static const int turns[6][3][3] = {
    {{0, -1, 0}, {1, 0, 0}, {0, 0, 1}},  /* +y to +x */
    {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}},   /* as it is */
    {{1, 0, 0}, {0, 0, 1}, {0, -1, 0}},  /* +y to +z */
    {{0, 1, 0}, {-1, 0, 0}, {0, 0, 1}},  /* +y to −x */
    {{1, 0, 0}, {0, -1, 0}, {0, 0, -1}}, /* +y to −y */
    {{1, 0, 0}, {0, 0, -1}, {0, 1, 0}},  /* +y to −z */
};

/* Writes the triangles of a scene as an OBJ file, turned. */
static const char *write_turned(const lmn_scene *s, int turn, const char *name)
{
    static char text[1 << 22];
    size_t      length = 0;
    uint32_t    first = 1;
    for (size_t m = 0; m < s->part_count; m++) {
        const node *n = &s->nodes[s->parts[m].node];
        const mat4  world = scene_world_matrix(s, s->parts[m].node);
        for (size_t k = 0; k < s->meshes[n->mesh].primitive_count; k++) {
            const primitive *p = &s->meshes[n->mesh].primitives[k];
            for (uint32_t i = 0; i < p->vertex_count; i++) {
                vec3         at = mat4_transform_point(&world, p->positions[i]);
                const double v[3] = {(double)at.x, (double)at.y, (double)at.z};
                double       out[3] = {0, 0, 0};
                for (int a = 0; a < 3; a++)
                    for (int b = 0; b < 3; b++)
                        out[b] += v[a] * turns[turn][a][b];
                length +=
                    (size_t)snprintf(text + length, sizeof text - length, "v %.7g %.7g %.7g\n", out[0], out[1], out[2]);
                assert_true(length < sizeof text);
            }
            for (uint32_t i = 0; i < p->index_count; i += 3)
                length += (size_t)snprintf(text + length, sizeof text - length, "f %u %u %u\n", first + p->indices[i],
                                           first + p->indices[i + 1], first + p->indices[i + 2]);
            assert_true(length < sizeof text);
            first += p->vertex_count;
        }
    }
    return temp_file(name, text, length);
}

static lmn_scene *load_with(const char *path, lmn_up_axis up)
{
    lmn_scene    *s = NULL;
    lmn_error     error = {0};
    lmn_load_desc desc = LMN_LOAD_DESC_INIT;
    desc.up_axis = up;
    assert_int_equal(lmn_scene_create(&s, &error), LMN_OK);
    if (lmn_scene_add_file(s, path, &desc, &error) != LMN_OK)
        fail_msg("%s", error.message);
    return s;
}

/* Which of the file's axes became the scene's up axis: 0 … 5. */
static int up_of(const lmn_scene *s)
{
    mat4 world = scene_world_matrix(s, s->parts[0].node);
    int  row = s->up == 'z' ? 2 : 1;
    for (int k = 0; k < 3; k++)
        if (fabs(world.m[4 * k + row]) > 0.5)
            return world.m[4 * k + row] > 0 ? k : 3 + k;
    return -1;
}

/* How many of the six ways are found. Y and Z must be; where another is not, the usual axis stays. */
static int found_of(const char *path)
{
    lmn_scene *s = load_with(path, LMN_UP_Y);
    int        found = 0;
    for (int turn = 0; turn < 6; turn++) {
        lmn_scene *turned = load_with(write_turned(s, turn, "turned.obj"), LMN_UP_AUTO);
        int        up = up_of(turned);
        up_measure measures[6];
        assert_int_equal(up_axis_measure(measures, turned, NULL), LMN_OK);
        found += up == turn;
        if (up != turn && (up != 1 || turn == 1))
            fail_msg("%s: %d is up, and %d was found", path, turn, up);
        if (up != turn)
            print_message("%s: %d is up, and the usual axis stayed\n", path, turn);
        assert_int_equal(has_warning(turned, WARNING_UP_AXIS), up != 1);
        lmn_scene_destroy(&turned);
    }
    lmn_scene_destroy(&s);
    return found;
}

static void turned_models_are_found(void **state)
{
    (void)state;
    static const struct {
        const char *name;
        int         least; /* of the six ways; in doubt the usual axis stays */
    } models[] = {
        {"examples/spot.obj", 4},
        {"examples/house.glb", 6},
        {"examples/buggy.glb", 6},
        {"examples/cloister.glb", 6},
        {"examples/store.glb", 6},
        {"examples/arm.glb", 6},
        {"../shared/data/mesh/teapot.obj", 5},
    };
    for (size_t i = 0; i < sizeof models / sizeof *models; i++) {
        char path[512];
        snprintf(path, sizeof path, "%s/%s", LIMNER_SOURCE_DIR, models[i].name);
        int found = found_of(path);
        print_message("%s: %d of 6\n", models[i].name, found);
        assert_true(found >= models[i].least);
    }
}

/* Models that stand as is usual stay, and so do those that stand no way. */
static void usual_ones_stay(void **state)
{
    (void)state;
    static const char *const models[] = {"apple.ply",     "cube.ply",   "dodecahedron.ply", "icosahedron.ply",
                                         "spot.obj",      "teapot.obj", "suzanne.obj",      "scifihelmet-binary.ply",
                                         "spot-ascii.ply"};
    for (size_t i = 0; i < sizeof models / sizeof *models; i++) {
        char path[512];
        snprintf(path, sizeof path, "%s/../shared/data/mesh/%s", LIMNER_SOURCE_DIR, models[i]);
        lmn_scene *s = load_with(path, LMN_UP_AUTO);
        if (up_of(s) != 1 || has_warning(s, WARNING_UP_AXIS))
            fail_msg("%s: %d is up", path, up_of(s));
        lmn_scene_destroy(&s);
    }
}

/* A lorry stands better on its roof, but it stands on its wheels. */
static void what_stands_stays(void **state)
{
    (void)state;
    lmn_scene *lorry = load_with(LIMNER_SOURCE_DIR "/../shared/data/gltf/animated/CesiumMilkTruck.glb", LMN_UP_AUTO);
    lmn_scene *s = load_with(write_turned(lorry, 1, "lorry.obj"), LMN_UP_AUTO);
    up_measure measures[6];
    assert_int_equal(up_axis_measure(measures, s, NULL), LMN_OK);
    assert_true(measures[1].stands && measures[4].score > measures[1].score + 0.7);
    assert_int_equal(up_of(s), 1);
    lmn_scene_destroy(&s);
    lmn_scene_destroy(&lorry);
}

/* Each axis goes to the other, by a turn and no mirror. */
static void turns_are_turns(void **state)
{
    (void)state;
    static const char axes[] = "xyzXYZ";
    for (int from = 0; from < 6; from++)
        for (int to = 1; to < 3; to++) {
            mat4          t = scene_up_rotation(axes[from], axes[to]);
            const double *m = t.m;
            double        determinant = m[0] * (m[5] * m[10] - m[6] * m[9]) - m[4] * (m[1] * m[10] - m[2] * m[9]) +
                                 m[8] * (m[1] * m[6] - m[2] * m[5]);
            assert_true(determinant == 1);
            assert_true(m[4 * (from % 3) + to] == (from < 3 ? 1 : -1));
        }
}

/* glTF and STL say it, and so does who asks. */
static void what_is_said_holds(void **state)
{
    (void)state;
    lmn_scene  *house = load_with(LIMNER_SOURCE_DIR "/examples/house.glb", LMN_UP_Y);
    const char *turned = write_turned(house, 2, "said.obj");
    lmn_scene  *s = load_with(turned, LMN_UP_AUTO);
    assert_int_equal(up_of(s), 2);
    lmn_scene_destroy(&s);
    s = load_with(turned, LMN_UP_Y);
    assert_int_equal(up_of(s), 1);
    assert_false(has_warning(s, WARNING_UP_AXIS));
    lmn_scene_destroy(&s);
    lmn_scene_destroy(&house);
    s = load_with(LIMNER_SOURCE_DIR "/../shared/data/mesh/spot-binary.stl", LMN_UP_AUTO); /* lies on its side */
    assert_int_equal(s->up, 'z');
    assert_false(has_warning(s, WARNING_UP_AXIS));
    lmn_scene_destroy(&s);
    s = load_with(LIMNER_SOURCE_DIR "/examples/pump.glb", LMN_UP_AUTO);
    assert_int_equal(s->up, 'y');
    assert_false(has_warning(s, WARNING_UP_AXIS));
    lmn_scene_destroy(&s);
}

/* What is cut off at a plane stands on its open rim; a sheet with a border all around does not. */
static void rims_are_bases(void **state)
{
    (void)state;
    enum { AROUND = 24, RINGS = 9 };
    char   text[1 << 16];
    size_t length = 0;
    for (int i = 0; i < RINGS; i++) /* half a ball with a top that leans over, open below, +z up */
        for (int k = 0; k < AROUND; k++) {
            double across = 1.5708 * i / RINGS, angle = 6.283185 * k / AROUND;
            length += (size_t)snprintf(text + length, sizeof text - length, "v %.6f %.6f %.6f\n",
                                       cos(across) * cos(angle) + 0.2 * sin(across), 0.8 * cos(across) * sin(angle),
                                       1.6 * sin(across));
        }
    for (int i = 0; i + 1 < RINGS; i++)
        for (int k = 0; k < AROUND; k++) {
            int a = 1 + i * AROUND + k, b = 1 + i * AROUND + (k + 1) % AROUND;
            length +=
                (size_t)snprintf(text + length, sizeof text - length, "f %d %d %d %d\n", a, b, b + AROUND, a + AROUND);
        }
    length += (size_t)snprintf(text + length, sizeof text - length, "f");
    for (int k = 0; k < AROUND; k++)
        length += (size_t)snprintf(text + length, sizeof text - length, " %d", 1 + (RINGS - 1) * AROUND + k);
    length += (size_t)snprintf(text + length, sizeof text - length, "\n");
    lmn_scene *s = load_with(temp_file("bust.obj", text, length), LMN_UP_AUTO);
    up_measure measures[6];
    assert_int_equal(up_axis_measure(measures, s, NULL), LMN_OK);
    assert_true(measures[2].support > 0.6 && measures[2].support < 0.9); /* π/4 of its box */
    assert_int_equal(up_of(s), 2);
    assert_true(has_warning(s, WARNING_UP_AXIS));
    lmn_scene_destroy(&s);
}

/* Nothing, and what has no size: the usual axis. */
static void nothing_says_nothing(void **state)
{
    (void)state;
    up_measure measures[6];
    lmn_scene *empty = NULL;
    lmn_error  error = {0};
    assert_int_equal(lmn_scene_create(&empty, &error), LMN_OK);
    char up = 0;
    assert_int_equal(up_axis_measure(measures, empty, &error), LMN_OK);
    assert_false(measures[1].stands);
    assert_int_equal(up_axis_guess(&up, empty, 'y', "OBJ", &error), LMN_OK);
    assert_int_equal(up, 'y');
    lmn_scene_destroy(&empty);
    const char flat[] = "v 0 0 0\nv 1 0 0\nv 0 0 1\nf 1 2 3\n";
    lmn_scene *s = load_with(temp_file("flat.obj", flat, sizeof flat - 1), LMN_UP_AUTO);
    assert_int_equal(up_of(s), 1);
    lmn_scene_destroy(&s);
    const char sheet[] = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\n"; /* a picture on the wall */
    s = load_with(temp_file("sheet.obj", sheet, sizeof sheet - 1), LMN_UP_AUTO);
    assert_int_equal(up_of(s), 1);
    lmn_scene_destroy(&s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(turned_models_are_found), cmocka_unit_test(usual_ones_stay),
        cmocka_unit_test(what_stands_stays),       cmocka_unit_test(turns_are_turns),
        cmocka_unit_test(what_is_said_holds),      cmocka_unit_test(rims_are_bases),
        cmocka_unit_test(nothing_says_nothing),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
