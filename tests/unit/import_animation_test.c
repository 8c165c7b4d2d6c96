/* What glTF files bring to animations, each in a GLB built here: pointers, matrices of animated nodes, keys that are
 * wrong, skins at their limits. */
#include "import_support.h"

#include <math.h>

#include "pose/pose.h"

#define ASSET "\"asset\":{\"version\":\"2.0\"}"

enum { BYTE = 5120, UBYTE = 5121, SHORT = 5122, USHORT = 5123, FLOAT = 5126 };

static glb    g;
static char   views[4096], accessors[4096];
static size_t accessor_count;

/* Adds an accessor over these bytes; returns its index. */
static size_t put(const void *bytes, size_t size, size_t count, int component, bool normalized, const char *type)
{
    size_t at = glb_put(&g, bytes, size), v = strlen(views), a = strlen(accessors);
    snprintf(views + v, sizeof views - v, "%s{\"buffer\":0,\"byteOffset\":%zu,\"byteLength\":%zu}", v ? "," : "", at,
             size);
    snprintf(accessors + a, sizeof accessors - a,
             "%s{\"bufferView\":%zu,\"count\":%zu,\"componentType\":%d,\"normalized\":%s,\"type\":\"%s\"}",
             a ? "," : "", accessor_count, count, component, normalized ? "true" : "false", type);
    return accessor_count++;
}

#define PUT_FLOATS(values, count, type) put(values, sizeof values, count, FLOAT, false, type)

static const float triangle[3][3] = {{0, 0, 0}, {1, 0, 0}, {0, 2, 0}};

/* A triangle is accessor 0. */
static void begin(void)
{
    memset(&g, 0, sizeof g);
    views[0] = accessors[0] = '\0';
    accessor_count = 0;
    PUT_FLOATS(triangle, 3, "VEC3");
}

#define MESH      "\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0}}]}]"
#define ONE_MESH  MESH ",\"nodes\":[{\"mesh\":0,\"name\":\"thing\"}]"
#define MOVES(p)  "{\"sampler\":0,\"target\":{\"node\":0,\"path\":\"" p "\"}}"
#define POINTS(p) "{\"path\":\"pointer\",\"extensions\":{\"KHR_animation_pointer\":{\"pointer\":\"" p "\"}}}"

/* The file's own members stand behind the ones that follow from the accessors. */
static void write_json(const char *members)
{
    int size = snprintf(g.json, sizeof g.json,
                        "{" ASSET ",\"buffers\":[{\"byteLength\":%zu}],\"bufferViews\":[%s],\"accessors\":[%s],%s}",
                        g.bin_size, views, accessors, members);
    assert_true(size > 0 && (size_t)size < sizeof g.json);
}

static lmn_scene *load(const char *members)
{
    write_json(members);
    return load_or_fail(glb_file(&g, "built.glb"));
}

static lmn_status refused(const char *members, lmn_error *error)
{
    write_json(members);
    return load_status(glb_file(&g, "built.glb"), error);
}

static size_t warnings_of(const lmn_scene *s, const char *words)
{
    size_t count = 0;
    for (size_t i = 0; i < s->warnings.count; i++)
        if (strstr(s->warnings.items[i].text, words))
            count += s->warnings.items[i].count;
    return count;
}

/* The channel of the first animation that moves this; NULL when there is none. */
static const animation_channel *channel_of(const lmn_scene *s, animation_path path)
{
    for (size_t i = 0; i < s->animations[0].channel_count; i++)
        if (s->animations[0].channels[i].path == path)
            return &s->animations[0].channels[i];
    return NULL;
}

/* One channel of path `path` with these floats. */
static lmn_scene *load_channel(const char *path, const char *interpolation, const float *times, size_t keys,
                               const float *values, size_t value_count, const char *type, size_t components)
{
    char members[1024];
    begin();
    size_t input = put(times, keys * sizeof *times, keys, FLOAT, false, "SCALAR");
    size_t output = put(values, value_count * components * sizeof *values, value_count, FLOAT, false, type);
    snprintf(members, sizeof members,
             ONE_MESH ",\"animations\":[{\"samplers\":[{\"input\":%zu,\"output\":%zu,\"interpolation\":\"%s\"}],"
                      "\"channels\":[{\"sampler\":0,\"target\":{\"node\":0,\"path\":\"%s\"}}]}]",
             input, output, interpolation, path);
    return load(members);
}

/* --- pointers ------------------------------------------------------------------------------------------- */

#define LIGHTS "\"extensions\":{\"KHR_lights_punctual\":{\"lights\":[{\"type\":\"point\"},{\"type\":\"spot\"}]}}"
#define CAMERAS                                                                                                        \
    "\"cameras\":[{\"type\":\"perspective\",\"perspective\":{\"yfov\":0.7,\"znear\":0.1}},"                            \
    "{\"type\":\"orthographic\",\"orthographic\":{\"xmag\":2,\"ymag\":3,\"znear\":0.5,\"zfar\":9}}]"

static void pointers_move_what_they_point_at(void **state)
{
    (void)state;
    static const float times[2] = {0, 2}, one[2] = {0.5f, 0.25f}, three[6] = {1, 2, 3, 4, 5, 6},
                       four[8] = {0, 0, 0, 1, 0, 1, 0, 0};
    begin();
    PUT_FLOATS(times, 2, "SCALAR"); /* 1 */
    PUT_FLOATS(one, 2, "SCALAR");   /* 2 */
    PUT_FLOATS(three, 2, "VEC3");   /* 3 */
    PUT_FLOATS(four, 2, "VEC4");    /* 4 */
    lmn_scene *s = load(
        "\"extensionsRequired\":[\"KHR_animation_pointer\",\"KHR_lights_punctual\"]," LIGHTS "," CAMERAS ","
        "\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0},\"targets\":[{\"POSITION\":0}]}]}],"
        "\"scenes\":[{\"nodes\":[2,1]}],\"nodes\":[{\"name\":\"outside\"},{\"mesh\":0},{\"name\":"
        "\"first\"}],"
        "\"animations\":[{\"samplers\":[{\"input\":1,\"output\":2},{\"input\":1,\"output\":3},{\"input\":"
        "1,"
        "\"output\":"
        "4}],"
        "\"channels\":[{\"sampler\":1,\"target\":" POINTS(
            "/nodes/2/translation") "},"
                                    "{\"sampler\":2,\"target\":" POINTS(
                                        "/nodes/1/rotation") "},{\"sampler\":1,"
                                                             "\"target\":" POINTS(
                                                                 "/nod"
                                                                 "es/"
                                                                 "2/"
                                                                 "scal"
                                                                 "e") "},{\"sampler\":0,"
                                                                      "\"target\":" POINTS(
                                                                          "/nodes/1/"
                                                                          "weights") "},"
                                                                                     "{\""
                                                                                     "sa"
                                                                                     "mpl"
                                                                                     "er"
                                                                                     "\":"
                                                                                     "0,"
                                                                                     "\"t"
                                                                                     "ar"
                                                                                     "get"
                                                                                     "\""
                                                                                     ":" POINTS(
                                                                                         "/"
                                                                                         "c"
                                                                                         "a"
                                                                                         "m"
                                                                                         "e"
                                                                                         "r"
                                                                                         "a"
                                                                                         "s"
                                                                                         "/"
                                                                                         "0"
                                                                                         "/"
                                                                                         "p"
                                                                                         "e"
                                                                                         "r"
                                                                                         "s"
                                                                                         "p"
                                                                                         "e"
                                                                                         "c"
                                                                                         "t"
                                                                                         "i"
                                                                                         "v"
                                                                                         "e"
                                                                                         "/"
                                                                                         "y"
                                                                                         "f"
                                                                                         "o"
                                                                                         "v") "}"
                                                                                              ","
                                                                                              "{"
                                                                                              "\"sampler\":0,"
                                                                                              "\"target\":" POINTS(
                                                                                                  "/cameras/1/"
                                                                                                  "orthographic/"
                                                                                                  "ymag") "},"
                                                                                                          "{\"sampl"
                                                                                                          "er\":1,"
                                                                                                          "\"target"
                                                                                                          "\""
                                                                                                          ":" POINTS(
                                                                                                              "/ext"
                                                                                                              "ensi"
                                                                                                              "ons/"
                                                                                                              "KHR_"
                                                                                                              "ligh"
                                                                                                              "ts_"
                                                                                                              "punc"
                                                                                                              "tual"
                                                                                                              "/lig"
                                                                                                              "hts/"
                                                                                                              "1/"
                                                                                                              "colo"
                                                                                                              "r") "},"
                                                                                                                   "{\""
                                                                                                                   "sam"
                                                                                                                   "ple"
                                                                                                                   "r\""
                                                                                                                   ":0,"
                                                                                                                   "\"t"
                                                                                                                   "arg"
                                                                                                                   "et"
                                                                                                                   "\""
                                                                                                                   ":" POINTS(
                                                                                                                       "/extensions/KHR_lights_punctual/lights/0/intensity") "},"
                                                                                                                                                                             "{\"sampler\":1,\"target\":" POINTS(
                                                                                                                                                                                 "/nodes/0/translation") "}]}]");
    assert_int_equal(s->warnings.count, 0); /* a node outside of the scene is nobody's mistake */
    assert_int_equal(s->animations[0].channel_count, 8);
    static const struct {
        animation_path path;
        int32_t        target;
        size_t         components;
    } expected[8] = {{PATH_TRANSLATION, 1, 3},  {PATH_ROTATION, 2, 4},       {PATH_SCALE, 1, 3},
                     {PATH_WEIGHTS, 2, 1},      {PATH_CAMERA_FOV, 0, 1},     {PATH_CAMERA_HALF_HEIGHT, 1, 1},
                     {PATH_LIGHT_COLOUR, 1, 3}, {PATH_LIGHT_INTENSITY, 0, 1}};
    /* Behind the file's root the nodes stand in the order of the scene: 2, then 1. */
    for (size_t i = 0; i < 8; i++) {
        const animation_channel *c = &s->animations[0].channels[i];
        assert_int_equal(c->path, expected[i].path);
        assert_int_equal(c->target, expected[i].target);
        assert_int_equal(c->components, expected[i].components);
        assert_int_equal(c->key_count, 2);
    }
    assert_true(s->animations[0].channels[6].values[5] == 6 && s->animations[0].channels[4].values[0] == 0.5f);
    assert_true(s->animations[0].duration == 2);
    /* Node 2 moves in two ways and is one node. */
    char *info = lmn_scene_info_json(s);
    assert_non_null(
        strstr(info, "\"nodes\": 2,\n        \"weights\": 1,\n        \"cameras\": 2,\n        \"lights\": 2"));
    lmn_text_free(info);
    lmn_scene_destroy(&s);
}

static void other_pointers_are_named(void **state)
{
    (void)state;
    static const char *const pointers[] = {"/materials/0/pbrMetallicRoughness/baseColorFactor",
                                           "/nodes/7/translation",
                                           "/nodes/00/translation",
                                           "/nodes/0/weights/0",
                                           "/nodes//scale",
                                           "/nodes/0",
                                           "/nodes/4294967296/scale",
                                           "/cameras/0/orthographic/ymag",
                                           "/cameras/1/perspective/yfov",
                                           "/cameras/2/perspective/yfov",
                                           "/extensions/KHR_lights_punctual/lights/2/color",
                                           "/extensions/KHR_lights_punctual/lights/0/range",
                                           ""};
    static const float       times[2] = {0, 1}, values[2] = {1, 2};
    for (size_t i = 0; i < sizeof pointers / sizeof *pointers; i++) {
        char members[2048];
        begin();
        PUT_FLOATS(times, 2, "SCALAR");
        PUT_FLOATS(values, 2, "SCALAR");
        snprintf(members, sizeof members,
                 ONE_MESH "," LIGHTS "," CAMERAS ",\"animations\":[{\"samplers\":[{\"input\":1,\"output\":2}],"
                          "\"channels\":[{\"sampler\":0,\"target\":" POINTS("%s") "}]}]",
                 pointers[i]);
        lmn_scene *s = load(members);
        char       words[128];
        snprintf(words, sizeof words, "animation of %s", pointers[i]);
        assert_int_equal(warnings_of(s, words), 1);
        assert_true(s->animation_count == 1 && s->animations[0].channel_count == 0);
        lmn_scene_destroy(&s);
    }
    begin();
    lmn_scene *s = load(ONE_MESH ",\"animations\":[{\"samplers\":[{\"input\":0,\"output\":0}],"
                                 "\"channels\":[{\"sampler\":0,\"target\":{\"path\":\"pointer\"}}]}]");
    assert_int_equal(warnings_of(s, "animations[0].channels[0]: no pointer"), 1);
    lmn_scene_destroy(&s);
}

static void cameras_and_lights_cannot_be_set_to_anything(void **state)
{
    (void)state;
    static const struct {
        const char *pointer;
        float       values[2];
        bool        good;
    } cases[] = {{"/cameras/0/perspective/yfov", {0.1f, 3.1f}, true},
                 {"/cameras/0/perspective/yfov", {0.1f, 0}, false},
                 {"/cameras/0/perspective/yfov", {3.2f, 1}, false},
                 {"/cameras/1/orthographic/ymag", {0.1f, 20}, true},
                 {"/cameras/1/orthographic/ymag", {-1, 1}, false},
                 {"/extensions/KHR_lights_punctual/lights/0/intensity", {0, 900}, true},
                 {"/extensions/KHR_lights_punctual/lights/0/intensity", {1, -0.5f}, false}};
    static const float times[2] = {0, 1};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        char members[2048];
        begin();
        PUT_FLOATS(times, 2, "SCALAR");
        PUT_FLOATS(cases[i].values, 2, "SCALAR");
        snprintf(members, sizeof members,
                 ONE_MESH "," LIGHTS "," CAMERAS ",\"animations\":[{\"samplers\":[{\"input\":1,\"output\":2}],"
                          "\"channels\":[{\"sampler\":0,\"target\":" POINTS("%s") "}]}]",
                 cases[i].pointer);
        lmn_scene *s = load(members);
        assert_int_equal(s->animations[0].channel_count, cases[i].good);
        assert_int_equal(warnings_of(s, "animations[0].channels[0]: values are out of range"), !cases[i].good);
        lmn_scene_destroy(&s);
    }
}

/* --- matrices of animated nodes ------------------------------------------------------------------------- */

/* A rotation about an axis that is unit, row by row, from Rodrigues' formula. */
static void turn_about(const double axis[3], double angle, double out[3][3])
{
    double       s = sin(angle), c = cos(angle);
    const double skew[3][3] = {{0, -axis[2], axis[1]}, {axis[2], 0, -axis[0]}, {-axis[1], axis[0], 0}};
    for (int i = 0; i < 3; i++)
        for (int k = 0; k < 3; k++)
            out[i][k] = (i == k ? c : 0) + s * skew[i][k] + (1 - c) * axis[i] * axis[k];
}

/* A node with the matrix T·R·S, animated in `path`; `shear` is added to the second column's x. */
static lmn_scene *load_matrix(const double t[3], double r[3][3], const double s[3], double shear, const char *path)
{
    static const float times[2] = {0, 1}, three[6] = {1, 1, 1, 1, 1, 1};
    char               members[2048], matrix[600] = "";
    begin();
    PUT_FLOATS(times, 2, "SCALAR");
    PUT_FLOATS(three, 2, "VEC3");
    for (int column = 0; column < 4; column++)
        for (int row = 0; row < 4; row++) {
            double value = column == 3 ? (row == 3 ? 1 : t[row]) : row == 3 ? 0 : r[row][column] * s[column];
            if (column == 1 && row == 0)
                value += shear;
            size_t at = strlen(matrix);
            snprintf(matrix + at, sizeof matrix - at, "%s%.17g", at ? "," : "", value);
        }
    snprintf(members, sizeof members,
             MESH ",\"nodes\":[{\"mesh\":0,\"name\":\"thing\",\"matrix\":[%s]}],\"animations\":[{"
                  "\"samplers\":[{\"input\":1,\"output\":2}],\"channels\":[{\"sampler\":0,\"target\":{\"node\":0,"
                  "\"path\":\"%s\"}}]}]",
             matrix, path);
    return load(members);
}

static void matrices_of_animated_nodes_are_split(void **state)
{
    (void)state;
    static const double axes[][3] = {{0, 0, 1}, {1, 0, 0}, {0, 1, 0}, {2 / 3.0, -1 / 3.0, 2 / 3.0}};
    static const double t[3] = {4, -5, 6}, scales[][3] = {{1, 1, 1}, {2, 3, 0.5}, {1, 1, -2}};
    for (size_t i = 0; i < 4; i++)
        for (int step = -7; step <= 7; step++)
            for (size_t k = 0; k < 3; k++) {
                double r[3][3], half = step * 0.44 / 2;
                turn_about(axes[i], 2 * half, r);
                lmn_scene *s = load_matrix(t, r, scales[k], 0, "translation");
                assert_false(s->nodes[1].has_matrix);
                const node_place *n = node_place_of(&s->nodes[1]);
                /* The quaternion is (axis · sin, cos) of the half angle, or its negative. */
                double sign = n->rotation[3] * cos(half) < 0 ? -1 : 1;
                for (int e = 0; e < 3; e++) {
                    assert_true(fabs(n->translation[e] - t[e]) < 1e-12);
                    assert_true(fabs(n->scale[e] - scales[k][e]) < 1e-12);
                    assert_true(fabs(n->rotation[e] - sign * axes[i][e] * sin(half)) < 1e-12);
                }
                assert_true(fabs(n->rotation[3] - sign * cos(half)) < 1e-12);
                assert_int_equal(warnings_of(s, "'thing' has a matrix"), 1);
                assert_int_equal(warnings_of(s, "shear"), 0);
                lmn_scene_destroy(&s);
            }
}

static void shear_is_lost_and_said(void **state)
{
    (void)state;
    static const double t[3] = {0, 0, 0}, s[3] = {1, 1, 1}, z[3] = {0, 0, 1};
    double              r[3][3];
    turn_about(z, 0, r);
    lmn_scene *scene = load_matrix(t, r, s, 0.5, "scale");
    assert_int_equal(warnings_of(scene, "its shear is lost"), 1);
    /* The x axis keeps its direction; what is left of y is what lies across it. */
    assert_true(fabs(node_place_of(&scene->nodes[1])->scale[1] - 1) < 1e-12 &&
                fabs(fabs(node_place_of(&scene->nodes[1])->rotation[3]) - 1) < 1e-12);
    lmn_scene_destroy(&scene);
}

static void flat_matrices_stay_flat(void **state)
{
    (void)state;
    static const double t[3] = {1, 2, 3}, axis[3] = {0.6, 0, 0.8};
    double              r[3][3];
    turn_about(axis, 1, r);
    for (int flat = 0; flat < 8; flat++) {
        const double s[3] = {flat & 1 ? 0 : 2, flat & 2 ? 0 : 3, flat & 4 ? 0 : 4};
        lmn_scene   *scene = load_matrix(t, r, s, 0, "translation");
        const node  *n = &scene->nodes[1];
        mat4         m = node_local_matrix(n);
        for (int column = 0; column < 3; column++)
            for (int row = 0; row < 3; row++)
                assert_true(fabs(m.m[4 * column + row] - r[row][column] * s[column]) < 1e-9);
        assert_int_equal(warnings_of(scene, "shear"), 0);
        lmn_scene_destroy(&scene);
    }
}

static void matrices_stay_where_only_weights_move(void **state)
{
    (void)state;
    static const float times[2] = {0, 1}, weights[2] = {0, 1};
    begin();
    PUT_FLOATS(times, 2, "SCALAR");
    PUT_FLOATS(weights, 2, "SCALAR");
    lmn_scene *s =
        load("\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0},\"targets\":[{\"POSITION\":0}]}]}],"
             "\"nodes\":[{\"mesh\":0,\"matrix\":[1,0,0,0,0.5,1,0,0,0,0,1,0,0,0,0,1]}],\"animations\":[{\"samplers\":[{"
             "\"input\":1,\"output\":2}],\"channels\":[" MOVES("weights") "]}]");
    assert_true(s->nodes[1].has_matrix && s->nodes[1].place->matrix.m[4] == 0.5);
    assert_int_equal(s->warnings.count, 0);
    lmn_scene_destroy(&s);
}

/* --- keys ----------------------------------------------------------------------------------------------- */

static void wrong_times_are_left_out(void **state)
{
    (void)state;
    static const struct {
        float       times[3];
        size_t      keys;
        const char *said; /* NULL: right */
    } cases[] = {{{0, 1, 2}, 3, NULL},
                 {{1.5f}, 1, NULL},
                 {{0}, 1, NULL},
                 {{0}, 0, "it has no keys"},
                 {{0, 2, 1}, 3, "its times are not in order"},
                 {{0, NAN, 1}, 3, "its times are not finite"},
                 {{0, 1, INFINITY}, 3, "its times are not finite"}};
    static const float values[9] = {0, 1, 2, 3, 4, 5, 6, 7, 8};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        lmn_scene *s =
            load_channel("translation", "LINEAR", cases[i].times, cases[i].keys, values, cases[i].keys, "VEC3", 3);
        assert_int_equal(s->animations[0].channel_count, cases[i].said == NULL);
        assert_int_equal(s->warnings.count, cases[i].said ? 2 : 0);
        if (cases[i].said) {
            char words[128];
            snprintf(words, sizeof words, "animations[0].channels[0]: %s", cases[i].said);
            assert_int_equal(warnings_of(s, words), 1);
            assert_int_equal(warnings_of(s, "moves nothing"), 1);
        }
        /* A clip of one key is a clip of that length: the pose stands from there on. */
        assert_true(s->animations[0].duration == (cases[i].said ? 0 : (double)cases[i].times[cases[i].keys - 1]));
        lmn_scene_destroy(&s);
    }
}

static void the_last_of_equal_times_counts(void **state)
{
    (void)state;
    static const float       times[5] = {0, 1, 1, 1, 2}, values[15] = {0, 0, 0, 1, 1, 1, 2, 2, 2, 3, 3, 3, 4, 4, 4};
    lmn_scene               *s = load_channel("translation", "STEP", times, 5, values, 5, "VEC3", 3);
    const animation_channel *c = channel_of(s, PATH_TRANSLATION);
    assert_int_equal(c->key_count, 3);
    assert_true(c->times[0] == 0 && c->times[1] == 1 && c->times[2] == 2);
    assert_true(c->values[0] == 0 && c->values[3] == 3 && c->values[5] == 3 && c->values[6] == 4);
    assert_int_equal(warnings_of(s, "2 animation keys at the time of the next one"), 1);
    lmn_scene_destroy(&s);
    /* Of cubic keys the tangents go with them. */
    static const float three[3] = {0, 1, 1};
    float              cubic[27];
    for (int i = 0; i < 27; i++)
        cubic[i] = (float)i;
    s = load_channel("scale", "CUBICSPLINE", three, 3, cubic, 9, "VEC3", 3);
    c = channel_of(s, PATH_SCALE);
    assert_true(c->key_count == 2 && c->values[8] == 8 && c->values[9] == 18 && c->values[17] == 26);
    assert_true(s->animations[0].duration == 1);
    lmn_scene_destroy(&s);
}

static void keys_before_zero_are_kept_and_said(void **state)
{
    (void)state;
    static const float times[2] = {-1, 1}, values[6] = {0, 0, 0, 2, 2, 2};
    lmn_scene         *s = load_channel("translation", "LINEAR", times, 2, values, 2, "VEC3", 3);
    assert_true(channel_of(s, PATH_TRANSLATION)->key_count == 2 && s->animations[0].duration == 1);
    assert_int_equal(warnings_of(s, "1 animation channels begin before 0 s"), 1);
    lmn_scene_destroy(&s);
    static const float before[2] = {-3, -2};
    s = load_channel("translation", "LINEAR", before, 2, values, 2, "VEC3", 3);
    assert_true(s->animations[0].duration == 0);
    lmn_scene_destroy(&s);
}

static void wrong_values_are_left_out(void **state)
{
    (void)state;
    static const float times[2] = {0, 1}, nan[6] = {0, 0, NAN, 0, 0, 0}, three[9] = {0};
    lmn_scene         *s = load_channel("translation", "LINEAR", times, 2, nan, 2, "VEC3", 3);
    assert_int_equal(warnings_of(s, "animations[0].channels[0]: values are not finite"), 1);
    lmn_scene_destroy(&s);
    s = load_channel("translation", "LINEAR", times, 2, three, 3, "VEC3", 3);
    assert_int_equal(warnings_of(s, "the numbers of times and values do not fit"), 1);
    lmn_scene_destroy(&s);
    s = load_channel("rotation", "LINEAR", times, 2, three, 2, "VEC3", 3);
    assert_int_equal(warnings_of(s, "no usable output values"), 1);
    lmn_scene_destroy(&s);
    /* The triangle has no morph targets. */
    s = load_channel("weights", "LINEAR", times, 2, three, 2, "SCALAR", 1);
    assert_int_equal(warnings_of(s, "the numbers of weights and morph targets do not fit"), 1);
    lmn_scene_destroy(&s);
    s = load_channel("translation", "BEZIER", times, 2, three, 2, "VEC3", 3);
    assert_int_equal(warnings_of(s, "the interpolation BEZIER is none of glTF's"), 1);
    assert_int_equal(channel_of(s, PATH_TRANSLATION)->interpolation, INTERPOLATION_LINEAR);
    lmn_scene_destroy(&s);
}

static void rotations_become_unit(void **state)
{
    (void)state;
    static const float times[3] = {0, 1, 2};
    static const float values[12] = {0, 3, 0, 4, 0, 0, 0, 0, 0.6f, 0, 0, 0.8f};
    lmn_scene         *s = load_channel("rotation", "LINEAR", times, 3, values, 3, "VEC4", 4);
    const float       *v = channel_of(s, PATH_ROTATION)->values;
    assert_true(fabsf(v[1] - 0.6f) < 1e-7f && fabsf(v[3] - 0.8f) < 1e-7f && v[0] == 0);
    assert_true(v[4] == 0 && v[5] == 0 && v[6] == 0 && v[7] == 1);
    assert_memory_equal(v + 8, values + 8, 4 * sizeof *v);
    assert_int_equal(warnings_of(s, "1 animation keys with rotations that are not unit"), 1);
    assert_int_equal(warnings_of(s, "1 animation keys with rotations of length 0"), 1);
    lmn_scene_destroy(&s);
    /* In-tangent, value, out-tangent: the value becomes unit, and the tangents shrink with it. */
    static const float one[1] = {0}, cubic[12] = {10, 0, 0, 0, 0, 0, 5, 0, 0, 15, 0, 0};
    s = load_channel("rotation", "CUBICSPLINE", one, 1, cubic, 3, "VEC4", 4);
    v = channel_of(s, PATH_ROTATION)->values;
    assert_true(v[0] == 2 && v[6] == 1 && v[9] == 3);
    lmn_scene_destroy(&s);
}

/* Rotations as files keep them in fewer bits: a quarter turn about y is (0, sin 45°, 0, cos 45°). */
static void integers_stand_for_rotations_and_weights(void **state)
{
    (void)state;
    static const float    times[2] = {0, 1};
    static const int8_t   bytes[2][4] = {{0, 90, 0, 90}, {0, -90, 0, 90}};
    static const uint8_t  ubytes[2][4] = {{0, 180, 0, 180}, {0, 0, 0, 255}}, weights[2] = {51, 255};
    static const int16_t  shorts[2][4] = {{0, 23170, 0, 23170}, {0, -32767, 0, 0}};
    static const uint16_t ushorts[2][4] = {{0, 46340, 0, 46340}, {0, 65535, 0, 0}}, fine[2] = {13107, 65535};
    const double          half = sqrt(0.5);
    static const struct {
        const void *rotations, *weights;
        size_t      size;
        int         component, weight_component;
    } cases[4] = {{bytes, weights, 8, BYTE, UBYTE},
                  {ubytes, weights, 8, UBYTE, UBYTE},
                  {shorts, fine, 16, SHORT, USHORT},
                  {ushorts, fine, 16, USHORT, USHORT}};
    for (int i = 0; i < 4; i++) {
        begin();
        PUT_FLOATS(times, 2, "SCALAR");
        put(cases[i].rotations, cases[i].size, 2, cases[i].component, true, "VEC4");
        put(cases[i].weights, cases[i].size / 4, 2, cases[i].weight_component, true, "SCALAR");
        lmn_scene *s =
            load("\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0},\"targets\":[{\"POSITION\":0}]}]}],"
                 "\"nodes\":[{\"mesh\":0}],\"animations\":[{\"samplers\":[{\"input\":1,\"output\":2},{\"input\":1,"
                 "\"output\":3}],\"channels\":[" MOVES("rotation") ",{\"sampler\":1,\"target\":{\"node\":0,\"path\":"
                                                                   "\"weights\"}}]}]");
        const float *q = channel_of(s, PATH_ROTATION)->values, *w = channel_of(s, PATH_WEIGHTS)->values;
        assert_true(fabs(q[1] - half) < 1e-6 && fabs(q[3] - half) < 1e-6 && q[0] == 0 && q[2] == 0);
        for (int key = 0; key < 2; key++) {
            const float *k = q + 4 * key;
            assert_true(fabsf(k[0] * k[0] + k[1] * k[1] + k[2] * k[2] + k[3] * k[3] - 1) < 1e-6f);
        }
        if (i == 0)
            assert_true(q[5] < -0.7f);
        if (i == 2)
            assert_true(q[5] == -1);
        assert_true(fabsf(w[0] - 0.2f) < 1e-6f && w[1] == 1);
        assert_int_equal(s->warnings.count, 0);
        lmn_scene_destroy(&s);
    }
}

/* --- animations as a whole ------------------------------------------------------------------------------ */

static void the_later_of_two_channels_wins(void **state)
{
    (void)state;
    static const float times[2] = {0, 1}, late[2] = {0, 9}, a[6] = {1, 1, 1, 1, 1, 1}, b[6] = {2, 2, 2, 2, 2, 2};
    begin();
    PUT_FLOATS(times, 2, "SCALAR");
    PUT_FLOATS(late, 2, "SCALAR");
    PUT_FLOATS(a, 2, "VEC3");
    PUT_FLOATS(b, 2, "VEC3");
    lmn_scene *s =
        load(ONE_MESH ",\"animations\":[{\"samplers\":[{\"input\":2,\"output\":3},{\"input\":1,\"output\":4}"
                      "],\"channels\":[" MOVES("translation") "," MOVES(
                          "scale") ",{\"sampler\":1,"
                                   "\"target\":{\"node\":0,\"path\":\"translation\"}},{\"sampler\":1,\"target\":"
                                   "{\"node\":0,\"path\":\"scale\"}}]},{\"samplers\":[{\"input\":1,\"output\":3}],"
                                   "\"channels\":[" MOVES("translation") "]}]");
    assert_int_equal(s->animations[0].channel_count, 2);
    assert_true(channel_of(s, PATH_TRANSLATION)->values[0] == 2 && channel_of(s, PATH_SCALE)->values[0] == 2);
    assert_true(s->animations[0].duration == 1); /* the one of 9 s is gone */
    assert_int_equal(warnings_of(s, "2 animation channels that move what a later one"), 1);
    /* Another animation may move the same. */
    assert_int_equal(s->animations[1].channel_count, 1);
    lmn_scene_destroy(&s);
}

static void animations_without_channels_keep_their_number(void **state)
{
    (void)state;
    static const float times[1] = {3}, values[3] = {0};
    begin();
    PUT_FLOATS(times, 1, "SCALAR");
    PUT_FLOATS(values, 1, "VEC3");
    lmn_scene *s = load(ONE_MESH ",\"animations\":[{\"name\":\"still\",\"channels\":[],\"samplers\":[]},{\"samplers\":["
                                 "{\"input\":1,\"output\":2}],\"channels\":[" MOVES("translation") "]}]");
    assert_true(s->animation_count == 2 && s->animations[0].channel_count == 0 && s->animations[0].duration == 0);
    assert_int_equal(warnings_of(s, "the animation 'still' moves nothing"), 1);
    assert_true(s->animations[1].channel_count == 1 && s->animations[1].duration == 3);
    lmn_scene_destroy(&s);
}

/* --- skins ---------------------------------------------------------------------------------------------- */

#define SKINNED_MESH "\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0,\"JOINTS_0\":1,\"WEIGHTS_0\":2}}]}]"

static void put_skin(const uint16_t joints[3][4], const float weights[3][4])
{
    begin();
    put(joints, 24, 3, USHORT, false, "VEC4");
    put(weights, 48, 3, FLOAT, false, "VEC4");
}

static void joints_that_are_not_there_are_refused(void **state)
{
    (void)state;
    static const uint16_t joints[3][4] = {{0}, {1}, {2}};
    static const float    weights[3][4] = {{1}, {1}, {1}};
    lmn_error             error;
    put_skin(joints, weights);
    assert_int_equal(
        refused(SKINNED_MESH ",\"nodes\":[{\"mesh\":0,\"skin\":0},{},{}],\"skins\":[{\"joints\":[1,2]}]", &error),
        LMN_FORMAT);
    assert_non_null(strstr(error.message, "uses joint 2"));
    assert_int_equal(
        refused(SKINNED_MESH ",\"nodes\":[{\"mesh\":0,\"skin\":0},{},{}],\"skins\":[{\"joints\":[1,2,9]}]", &error),
        LMN_FORMAT);
    assert_non_null(strstr(error.message, "skins[0].joints[2]"));
}

static void vertices_without_weights_follow_their_first_joint(void **state)
{
    (void)state;
    static const uint16_t joints[3][4] = {{1, 0}, {0, 1}, {1, 0}};
    static const float    weights[3][4] = {{0, 0, 0, 0}, {-1, 3, 0, 0}, {NAN, 0, 0, 0}};
    put_skin(joints, weights);
    /* Without inverse bind matrices they are the identity: the vertices move as far as the joints are away. */
    lmn_scene       *s = load(SKINNED_MESH ",\"nodes\":[{\"mesh\":0,\"skin\":0},{},{\"translation\":[0,0,5]}],"
                                                 "\"skins\":[{\"joints\":[1,2]}]");
    const primitive *p = &s->meshes[0].primitives[0];
    assert_true(p->weights[0] == 1 && p->weights[4] == 0 && p->weights[5] == 1);
    assert_int_equal(warnings_of(s, "1 vertices that no joint has a weight for"), 0);
    assert_int_equal(warnings_of(s, "2 vertices that no joint has a weight for"), 1);
    lmn_scene_info info = lmn_scene_info_of(s);
    assert_true(info.bounds_max[2] == 5);
    lmn_scene_destroy(&s);
}

static void flat_bind_matrices_are_drawn(void **state)
{
    (void)state;
    static const uint16_t joints[3][4] = {{0}, {0}, {0}};
    static const float    weights[3][4] = {{1}, {1}, {1}};
    float                 binds[16] = {0};
    put_skin(joints, weights);
    binds[0] = binds[15] = 1; /* everything onto the x axis, and one number that is none */
    binds[5] = NAN;
    put(binds, sizeof binds, 1, FLOAT, false, "MAT4");
    lmn_scene *s = load(SKINNED_MESH ",\"nodes\":[{\"mesh\":0,\"skin\":0},{\"scale\":[2,0,0]}],\"skins\":[{\"joints\":["
                                     "1],\"inverseBindMatrices\":3}]");
    lmn_scene_info info = lmn_scene_info_of(s);
    assert_true(info.bounds_max[0] == 2 && info.bounds_max[1] == 0);
    assert_int_equal(warnings_of(s, "skins[0].inverseBindMatrices: 1 of 1 matrices are flat"), 1);
    lmn_scene_destroy(&s);
}

/* A matrix of zeros says nothing: the vertices stay where the mesh has them. */
static void empty_bind_matrices_are_replaced(void **state)
{
    (void)state;
    static const uint16_t joints[3][4] = {{0}, {1}, {1}};
    static const float    weights[3][4] = {{1}, {1}, {1}};
    float                 binds[2][16] = {{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1}};
    put_skin(joints, weights);
    put(binds, sizeof binds, 2, FLOAT, false, "MAT4");
    lmn_scene     *s = load(SKINNED_MESH ",\"nodes\":[{\"mesh\":0,\"skin\":0},{},{\"name\":\"elbow\",\"scale\":[2,2,2],"
                                             "\"translation\":[5,0,0]}],\"skins\":[{\"name\":\"arm\",\"joints\":[1,2],"
                                             "\"inverseBindMatrices\":3}]");
    lmn_scene_info info = lmn_scene_info_of(s);
    assert_true(info.bounds_max[0] == 1 && info.bounds_max[1] == 2);
    assert_int_equal(warnings_of(s, "1 of 2 matrices are flat, the first one that of joint 'elbow'"), 1);
    assert_int_equal(warnings_of(s, "1 of them are all zeros"), 1);
    lmn_scene_destroy(&s);
}

/* A part that follows joints of no size alone is not seen, and that is said when it is drawn. */
static void parts_without_extent_are_said(void **state)
{
    (void)state;
    static const float weights[3][4] = {{1}, {0.5f, 0.5f}, {1}};
    static const struct {
        uint16_t    joints[3][4];
        const char *scale;
        size_t      said;
    } rows[] = {{{{0, 1}, {0, 1}, {0, 1}}, "[0,0,0]", 0},
                {{{1, 1}, {1, 1}, {1, 1}}, "[0,0,0]", 1},
                {{{1, 1}, {1, 1}, {1, 1}}, "[2,0,1]", 1},
                {{{1, 1}, {1, 1}, {1, 1}}, "[1e-9,1e-9,1e-9]", 0}};
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        char      members[2048];
        warnings  warned = {0};
        lmn_error error = {0};
        moment    m = moment_at_rest();
        pose      p;
        put_skin(rows[i].joints, weights);
        snprintf(members, sizeof members,
                 SKINNED_MESH
                 ",\"nodes\":[{\"name\":\"hand\",\"mesh\":0,\"skin\":0},{},{\"name\":\"wrist\",\"scale\":%s}],"
                 "\"skins\":[{\"name\":\"arm\",\"joints\":[1,2]}]",
                 rows[i].scale);
        lmn_scene *s = load(members);
        assert_int_equal(pose_create(&p, s, &m, &error), LMN_OK);
        pose_warn_of_flat(&p, &warned);
        assert_int_equal(warned.count, rows[i].said);
        if (rows[i].said) {
            assert_int_equal(warned.items[0].code, WARNING_BAD_GEOMETRY);
            assert_non_null(strstr(warned.items[0].text, "part 'hand' is flat"));
            assert_non_null(strstr(warned.items[0].text, "skin 'arm'"));
            assert_non_null(strstr(warned.items[0].text, "'wrist'"));
        }
        warnings_release(&warned);
        pose_release(&p);
        lmn_scene_destroy(&s);
    }
}

static void ten_thousand_joints_are_read(void **state)
{
    (void)state;
    enum { JOINTS = 10000 };
    static const uint16_t joints[3][4] = {{0}, {JOINTS - 1}, {JOINTS / 2}};
    static const float    weights[3][4] = {{1}, {1}, {1}};
    static char           file[400000];
    put_skin(joints, weights);
    /* The binary part goes beside the JSON, which is larger than what GLBs are built of here. */
    temp_file("many.bin", g.bin, g.bin_size);
    int at = snprintf(file, sizeof file,
                      "{" ASSET ",\"buffers\":[{\"byteLength\":%zu,\"uri\":\"many.bin\"}],\"bufferViews\":[%s],"
                      "\"accessors\":[%s]," SKINNED_MESH ",\"nodes\":[{\"mesh\":0,\"skin\":0}",
                      g.bin_size, views, accessors);
    for (int i = 0; i < JOINTS; i++)
        at += snprintf(file + at, sizeof file - (size_t)at, ",{\"translation\":[0,0,%d]}", i);
    at += snprintf(file + at, sizeof file - (size_t)at, "],\"skins\":[{\"joints\":[1");
    for (int i = 1; i < JOINTS; i++)
        at += snprintf(file + at, sizeof file - (size_t)at, ",%d", i + 1);
    at += snprintf(file + at, sizeof file - (size_t)at, "]}]}");
    lmn_scene     *s = load_or_fail(temp_file("many.gltf", file, (size_t)at));
    lmn_scene_info info = lmn_scene_info_of(s);
    assert_int_equal(s->skins[0].joint_count, JOINTS);
    assert_true(info.bounds_min[2] == 0 && info.bounds_max[2] == JOINTS - 1);
    lmn_scene_destroy(&s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(pointers_move_what_they_point_at),
        cmocka_unit_test(other_pointers_are_named),
        cmocka_unit_test(cameras_and_lights_cannot_be_set_to_anything),
        cmocka_unit_test(matrices_of_animated_nodes_are_split),
        cmocka_unit_test(shear_is_lost_and_said),
        cmocka_unit_test(flat_matrices_stay_flat),
        cmocka_unit_test(matrices_stay_where_only_weights_move),
        cmocka_unit_test(wrong_times_are_left_out),
        cmocka_unit_test(the_last_of_equal_times_counts),
        cmocka_unit_test(keys_before_zero_are_kept_and_said),
        cmocka_unit_test(wrong_values_are_left_out),
        cmocka_unit_test(rotations_become_unit),
        cmocka_unit_test(integers_stand_for_rotations_and_weights),
        cmocka_unit_test(the_later_of_two_channels_wins),
        cmocka_unit_test(animations_without_channels_keep_their_number),
        cmocka_unit_test(joints_that_are_not_there_are_refused),
        cmocka_unit_test(vertices_without_weights_follow_their_first_joint),
        cmocka_unit_test(flat_bind_matrices_are_drawn),
        cmocka_unit_test(empty_bind_matrices_are_replaced),
        cmocka_unit_test(parts_without_extent_are_said),
        cmocka_unit_test(ten_thousand_joints_are_read),
    };
    return cmocka_run_group_tests(tests, NULL, remove_temp_folder);
}
