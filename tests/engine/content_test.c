/* Content of scenes from memory: drawn as if a file had brought it, and after each change as if it had been so from
 * the beginning; what is refused, and that the scene is as it was then. */
#include "checked.h"

#include <math.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { SIDE = 160, PIXELS = SIDE * SIDE };

static lmn_renderer *renderer;
#define EYE_X 9.0
static double eye_x = EYE_X; /* where drawings are seen from */

static const char *const looks[] = {
    "{\"surface\": \"lit\", \"lines\": \"discontinuity\"}",
    "{\"surface\": \"lambert\", \"lines\": {\"operator\": \"strokes\"}}",
    "{\"surface\": \"hatch\", \"lines\": \"discontinuity\", \"layers\": \"peel\", \"compose\": \"xray\"}",
};
enum { LOOKS = sizeof looks / sizeof *looks };

static int set_up(void **state)
{
    (void)state;
    lmn_renderer_desc desc = LMN_RENDERER_DESC_INIT;
    DO(lmn_renderer_create(&renderer, &desc, &error));
    return 0;
}

static int tear_down(void **state)
{
    (void)state;
    lmn_renderer_destroy(&renderer);
    return 0;
}

static lmn_status try_draw(const lmn_scene *s, const char *rules, uint8_t *out)
{
    char          json[1024];
    lmn_look     *look = NULL;
    lmn_drawing  *drawing = NULL;
    lmn_draw_desc desc = LMN_DRAW_DESC_INIT;
    const double  eye[3] = {eye_x, 7, 11}, target[3] = {0.4, 0.2, 0}, up[3] = {0, 1, 0};
    snprintf(json, sizeof json, "{\"version\": 2, \"rules\": [%s]}", rules);
    DO(lmn_look_parse(&look, json, "test", &error));
    desc.width = desc.height = SIDE;
    desc.dpi = 96;
    desc.eye_given = true;
    memcpy(desc.eye, eye, sizeof eye);
    memcpy(desc.target, target, sizeof target);
    memcpy(desc.up, up, sizeof up);
    lmn_status status = lmn_draw(&drawing, renderer, s, look, &desc, &error);
    if (status == LMN_OK)
        memcpy(out, lmn_drawing_pixels(drawing, NULL, NULL), 4 * PIXELS);
    lmn_drawing_destroy(&drawing);
    lmn_look_destroy(&look);
    return status;
}

static void draw(const lmn_scene *s, const char *rules, uint8_t *out)
{
    DO(try_draw(s, rules, out));
}

static size_t differing(const lmn_scene *a, const lmn_scene *b, const char *rules)
{
    static uint8_t one[4 * PIXELS], other[4 * PIXELS];
    size_t         count = 0;
    draw(a, rules, one);
    draw(b, rules, other);
    for (size_t i = 0; i < PIXELS; i++)
        count += memcmp(&one[4 * i], &other[4 * i], 4) != 0;
    return count;
}

static void assert_alike(const lmn_scene *a, const lmn_scene *b)
{
    for (int i = 0; i < LOOKS; i++)
        assert_int_equal(differing(a, b, looks[i]), 0);
}

/* --- things --------------------------------------------------------------------------------------------- */

enum { CORNERS = 8 };

static const uint32_t faces[] = {0, 3, 1, 0, 2, 3, 4, 5, 7, 4, 7, 6, 0, 1, 5, 0, 5, 4,
                                 2, 7, 3, 2, 6, 7, 0, 6, 2, 0, 4, 6, 1, 3, 7, 1, 7, 5};

/* A cube from −1 to 1, its upper corners moved by `lean` along x. */
static void cube_corners(float lean, float out[CORNERS][3])
{
    for (int i = 0; i < CORNERS; i++) {
        out[i][1] = i & 2 ? 1 : -1;
        out[i][0] = (i & 1 ? 1.0f : -1.0f) + (i & 2 ? lean : 0);
        out[i][2] = i & 4 ? 1 : -1;
    }
}

static lmn_mesh_desc cube_desc(float positions[CORNERS][3])
{
    lmn_mesh_desc desc = LMN_MESH_DESC_INIT;
    desc.positions = positions[0];
    desc.vertex_count = CORNERS;
    desc.indices = faces;
    desc.index_count = sizeof faces / sizeof *faces;
    return desc;
}

static lmn_scene *fresh(void)
{
    lmn_scene *s = NULL;
    DO(lmn_scene_create(&s, &error));
    return s;
}

static uint32_t add_cube(lmn_scene *s, float lean, uint32_t material)
{
    float         positions[CORNERS][3];
    uint32_t      mesh = 0;
    lmn_mesh_desc desc;
    cube_corners(lean, positions);
    desc = cube_desc(positions);
    desc.material = material;
    DO(lmn_scene_add_mesh(s, &desc, &mesh, &error));
    return mesh;
}

static uint32_t add_node(lmn_scene *s, const char *name, uint32_t parent, uint32_t mesh, double x, double y)
{
    lmn_node_desc desc = LMN_NODE_DESC_INIT;
    uint32_t      node = 0;
    desc.name = name;
    desc.parent = parent;
    desc.mesh = mesh;
    desc.matrix[12] = x;
    desc.matrix[13] = y;
    DO(lmn_scene_add_node(s, &desc, &node, &error));
    return node;
}

static void matrix_at(double m[16], double x, double y)
{
    lmn_node_desc standard = LMN_NODE_DESC_INIT;
    memcpy(m, standard.matrix, sizeof standard.matrix);
    m[12] = x;
    m[13] = y;
}

/* Two cubes, the second leaning. */
static lmn_scene *pair(float lean, double x)
{
    lmn_scene *s = fresh();
    add_node(s, "one", 0, add_cube(s, 0, 0), -1.5, 0);
    add_node(s, "two", 0, add_cube(s, lean, 0), x, 0.5);
    return s;
}

/* --- tests ---------------------------------------------------------------------------------------------- */

static void is_drawn_like_a_file(void **state)
{
    (void)state;
    float      positions[CORNERS][3];
    lmn_scene *read = fresh(), *made = fresh();
    FILE      *colours = fopen("content_cube.mtl", "w"), *file = fopen("content_cube.obj", "w");
    assert_true(colours && file);
    fprintf(colours, "newmtl brown\nKd 0.5 0.4 0.3\n");
    fclose(colours);
    fprintf(file, "mtllib content_cube.mtl\nusemtl brown\n");
    cube_corners(0.5f, positions);
    for (int i = 0; i < CORNERS; i++)
        fprintf(file, "v %g %g %g\n", (double)positions[i][0], (double)positions[i][1], (double)positions[i][2]);
    for (size_t i = 0; i < sizeof faces / sizeof *faces; i += 3)
        fprintf(file, "f %u %u %u\n", faces[i] + 1, faces[i + 1] + 1, faces[i + 2] + 1);
    fclose(file);
    DO(lmn_scene_add_file(read, "content_cube.obj", NULL, &error));
    lmn_material_desc brown = LMN_MATERIAL_DESC_INIT;
    uint32_t          material = 0;
    brown.colour[0] = 0.5f;
    brown.colour[1] = 0.4f;
    brown.colour[2] = 0.3f;
    DO(lmn_scene_add_material(made, &brown, &material, &error));
    add_node(made, "cube", 0, add_cube(made, 0.5f, material), 0, 0);
    lmn_scene_info a = lmn_scene_info_of(read), b = lmn_scene_info_of(made);
    assert_int_equal(a.triangles, b.triangles);
    assert_int_equal(a.parts, b.parts);
    assert_memory_equal(a.bounds_max, b.bounds_max, sizeof a.bounds_max);
    assert_alike(read, made);
    lmn_scene_destroy(&read);
    lmn_scene_destroy(&made);
}

/* Moved, vertex by vertex and whole, to and fro. */
static void changes_are_drawn(void **state)
{
    (void)state;
    float      positions[CORNERS][3];
    double     matrix[16];
    lmn_scene *s = pair(0.2f, 1.5), *wanted = pair(0.9f, 1.5), *farther = pair(0.9f, 2);
    assert_true(differing(s, wanted, looks[0]) > 20);
    cube_corners(0.9f, positions);
    DO(lmn_scene_set_positions(s, 2, positions[0], NULL, CORNERS, &error));
    assert_alike(s, wanted);
    matrix_at(matrix, 2, 0.5);
    DO(lmn_scene_set_matrix(s, 2, matrix, &error));
    assert_alike(s, farther);
    assert_float_equal(lmn_scene_info_of(s).bounds_max[0], lmn_scene_info_of(farther).bounds_max[0], 0);
    matrix_at(matrix, 1.5, 0.5);
    cube_corners(0.2f, positions);
    DO(lmn_scene_set_matrix(s, 2, matrix, &error));
    DO(lmn_scene_set_positions(s, 2, positions[0], NULL, CORNERS, &error));
    lmn_scene *again = pair(0.2f, 1.5);
    assert_alike(s, again);
    lmn_scene *all[] = {s, wanted, farther, again};
    for (int i = 0; i < 4; i++)
        lmn_scene_destroy(&all[i]);
}

/* A ring of so many vertices along it, waves running over it. */
enum { ALONG_MOST = 160, AROUND_MOST = 80 };

typedef struct ring {
    int      along, around;
    float    positions[ALONG_MOST * AROUND_MOST][3];
    uint32_t faces[ALONG_MOST * AROUND_MOST * 6];
} ring;

static lmn_mesh_desc ring_desc(ring *r, double phase)
{
    const double  turn = 6.283185307179586;
    lmn_mesh_desc desc = LMN_MESH_DESC_INIT;
    for (int i = 0; i < r->along * r->around; i++) {
        double u = turn * (i / r->around) / r->along, v = turn * (i % r->around) / r->around,
               tube = 1 + 0.15 * sin(5 * u + 3 * v + phase);
        r->positions[i][0] = (float)((2.6 + tube * cos(v)) * cos(u));
        r->positions[i][1] = (float)(tube * sin(v));
        r->positions[i][2] = (float)((2.6 + tube * cos(v)) * sin(u));
        int after = (i + r->around) % (r->along * r->around), row = i - i % r->around, past = after - i % r->around,
            above = (i + 1) % r->around;
        memcpy(&r->faces[6 * i],
               (uint32_t[]){(uint32_t)i, (uint32_t)(row + above), (uint32_t)(past + above), (uint32_t)i,
                            (uint32_t)(past + above), (uint32_t)after},
               6 * sizeof *r->faces);
    }
    desc.positions = r->positions[0];
    desc.indices = r->faces;
    desc.vertex_count = (size_t)r->along * (size_t)r->around;
    desc.index_count = 6 * desc.vertex_count;
    return desc;
}

static lmn_scene *ring_scene(ring *r, double phase)
{
    lmn_scene    *s = fresh();
    uint32_t      mesh;
    lmn_mesh_desc desc = ring_desc(r, phase);
    DO(lmn_scene_add_mesh(s, &desc, &mesh, &error));
    add_node(s, "ring", 0, mesh, 0, 0);
    return s;
}

/* Smooth meshes, coarse and as dense as scans, in the looks whose lines come from their edges: moved step by step they
 * are drawn as if they had been so from the beginning, and seen from elsewhere. */
static void moved_meshes_have_their_lines(void **state)
{
    (void)state;
    static ring              r;
    static const char *const rules[] = {
        "{\"surface\": \"lit\", \"lines\": \"discontinuity\"}",
        "{\"surface\": \"flat\", \"lines\": {\"operator\": \"strokes\", \"taper\": 13.5}}",
        "{\"surface\": \"flat\", \"lines\": {\"operator\": \"strokes\", \"visibility\": \"sampled\"}}",
        "{\"surface\": \"hatch\", \"layers\": {\"technique\": \"front\", \"shading\": \"deferred\"}, "
        "\"lines\": \"discontinuity\"}"};
    for (int dense = 0; dense < 2; dense++) {
        r.along = dense ? ALONG_MOST : 24;
        r.around = dense ? AROUND_MOST : 12;
        for (size_t i = 0; i < sizeof rules / sizeof *rules; i++) {
            static uint8_t before[4 * PIXELS], after[4 * PIXELS];
            lmn_scene     *s = ring_scene(&r, 0);
            draw(s, rules[i], before);
            for (int step = 1; step <= 3; step++) {
                lmn_mesh_desc desc = ring_desc(&r, 0.7 * step);
                DO(lmn_scene_set_positions(s, 1, desc.positions, NULL, desc.vertex_count, &error));
                lmn_scene *wanted = ring_scene(&r, 0.7 * step);
                assert_int_equal(differing(s, wanted, rules[i]), 0);
                draw(s, rules[i], after);
                assert_memory_not_equal(before, after, sizeof before);
                draw(s, rules[i], after); /* what was brought for one view is not shown in another one */
                eye_x = -7;
                assert_int_equal(differing(s, wanted, rules[i]), 0);
                eye_x = EYE_X;
                lmn_scene_destroy(&wanted);
            }
            lmn_scene_destroy(&s);
        }
    }
}

static void meshes_are_exchanged(void **state)
{
    (void)state;
    float         positions[CORNERS][3];
    lmn_scene    *s = pair(0.2f, 1.5), *wanted = fresh();
    lmn_mesh_desc half;
    cube_corners(0.2f, positions);
    half = cube_desc(positions);
    half.index_count /= 2;
    add_node(wanted, "one", 0, add_cube(wanted, 0, 0), -1.5, 0);
    uint32_t mesh = 0;
    DO(lmn_scene_add_mesh(wanted, &half, &mesh, &error));
    add_node(wanted, "two", 0, mesh, 1.5, 0.5);
    draw(s, looks[0], (uint8_t[4 * PIXELS]){0});
    DO(lmn_scene_set_mesh(s, 2, &half, &error));
    assert_int_equal(lmn_scene_info_of(s).triangles, 18);
    assert_alike(s, wanted);
    lmn_scene_destroy(&s);
    lmn_scene_destroy(&wanted);
}

/* Hidden, shown, removed, multiplied. */
static void nodes_come_and_go(void **state)
{
    (void)state;
    double     at[2][16];
    lmn_scene *s = pair(0.2f, 1.5), *whole = pair(0.2f, 1.5), *one = fresh(), *many = fresh();
    add_node(one, "one", 0, add_cube(one, 0, 0), -1.5, 0);
    DO(lmn_scene_set_visible(s, 2, false, &error));
    assert_int_equal(lmn_scene_info_of(s).parts, 2);
    assert_alike(s, one);
    DO(lmn_scene_set_visible(s, 2, true, &error));
    assert_alike(s, whole);
    DO(lmn_scene_remove_node(s, 2, &error));
    assert_int_equal(lmn_scene_info_of(s).parts, 1);
    assert_int_equal(lmn_scene_info_of(s).nodes, 1);
    assert_alike(s, one);
    assert_int_equal(lmn_scene_set_visible(s, 2, true, &error), LMN_USAGE);

    matrix_at(at[0], 0, 0);
    matrix_at(at[1], 3, 0.5);
    DO(lmn_scene_set_instances(s, 1, at[0], 2, &error));
    uint32_t both = add_node(many, "one", 0, add_cube(many, 0, 0), -1.5, 0);
    add_node(many, "below", both, 1, 3, 0.5);
    assert_int_equal(lmn_scene_part_at(s, 0, &(lmn_part_info){0}), true);
    assert_int_equal(lmn_scene_info_of(s).triangles, 24);
    assert_int_equal(differing(s, many, "{\"surface\": \"lambert\"}"), 0);
    DO(lmn_scene_set_instances(s, 1, NULL, 0, &error));
    assert_alike(s, one);
    lmn_scene *all[] = {s, whole, one, many};
    for (int i = 0; i < 4; i++)
        lmn_scene_destroy(&all[i]);
}

static void colours_textures_and_sets(void **state)
{
    (void)state;
    static uint8_t    pixels[4 * PIXELS];
    const uint8_t     red[4] = {255, 0, 0, 255};
    lmn_scene        *s = fresh();
    lmn_material_desc desc = LMN_MATERIAL_DESC_INIT;
    uint32_t          material = 0, texture = 0;
    const char       *flat = "{\"surface\": {\"technique\": \"flat\", \"model_colour\": 1}}";
    desc.colour[0] = 0.2f;
    DO(lmn_scene_add_material(s, &desc, &material, &error));
    add_node(s, "cube", 0, add_cube(s, 0, material), 0, 0);
    draw(s, flat, pixels);
    const uint8_t *middle = &pixels[4 * (SIDE / 2 * SIDE + SIDE / 2)];
    assert_int_equal(middle[0], 51);
    assert_int_equal(middle[1], 255);
    DO(lmn_scene_add_texture(s, "red", 1, 1, red, &texture, &error));
    desc.colour[0] = 1;
    desc.texture = texture;
    DO(lmn_scene_set_material(s, material, &desc, &error));
    /* The mesh has no texture coordinates. */
    draw(s, flat, pixels);
    assert_int_equal(middle[1], 255);
    float         positions[CORNERS][3], uvs[CORNERS][2] = {{0}};
    lmn_mesh_desc with;
    cube_corners(0, positions);
    with = cube_desc(positions);
    with.uvs = uvs[0];
    with.material = material;
    DO(lmn_scene_set_mesh(s, 1, &with, &error));
    draw(s, flat, pixels);
    assert_int_equal(middle[0], 255);
    assert_int_equal(middle[1], 0);

    const char *chosen = "{\"select\": \"*\", \"surface\": \"flat\"}, {\"select\": \"[chosen=yes]\", \"surface\": "
                         "{\"technique\": \"flat\", \"colour\": \"#0000ff\"}}";
    DO(lmn_scene_set_attribute(s, 1, "chosen", "yes", &error));
    draw(s, chosen, pixels);
    assert_int_equal(middle[2], 255);
    assert_int_equal(middle[0], 0);
    DO(lmn_scene_set_attribute(s, 1, "chosen", NULL, &error));
    draw(s, chosen, pixels);
    assert_int_equal(middle[0], 255);
    lmn_scene_destroy(&s);
}

/* A skin of one joint that has moved is a mesh elsewhere. */
static void skins_hold_vertices(void **state)
{
    (void)state;
    float         positions[CORNERS][3], weights[CORNERS][4] = {{0}};
    uint16_t      joints[CORNERS][4] = {{0}};
    uint32_t      mesh = 0, skin = 0, node = 0;
    double        bind[16], matrix[16];
    lmn_scene    *s = fresh(), *wanted = fresh();
    lmn_mesh_desc desc;
    lmn_node_desc skinned = LMN_NODE_DESC_INIT;
    cube_corners(0, positions);
    desc = cube_desc(positions);
    for (int i = 0; i < CORNERS; i++)
        weights[i][0] = 2;
    desc.joints = joints[0];
    desc.weights = weights[0];
    uint32_t joint = add_node(s, "joint", 0, 0, 0, 0);
    DO(lmn_scene_add_mesh(s, &desc, &mesh, &error));
    matrix_at(bind, 0, 0);
    DO(lmn_scene_add_skin(s, &joint, bind, 1, &skin, &error));
    skinned.mesh = mesh;
    skinned.skin = skin;
    DO(lmn_scene_add_node(s, &skinned, &node, &error));
    add_node(wanted, NULL, 0, add_cube(wanted, 0, 0), 1.5, 1);
    assert_true(differing(s, wanted, looks[0]) > 20);
    matrix_at(matrix, 1.5, 1);
    DO(lmn_scene_set_matrix(s, joint, matrix, &error));
    for (int i = 0; i < 2;
         i++) /* hatching is tied to where the skin is at rest; a joint rounds otherwise than a node */
        assert_true(differing(s, wanted, looks[i]) <= 2);
    assert_float_equal(lmn_scene_info_of(s).bounds_max[0], 2.5, 1e-6);
    lmn_scene_destroy(&s);
    lmn_scene_destroy(&wanted);
}

static void cameras_and_lights(void **state)
{
    (void)state;
    lmn_scene      *s = pair(0, 1.5);
    lmn_camera_desc camera = LMN_CAMERA_DESC_INIT;
    lmn_light_desc  light = LMN_LIGHT_DESC_INIT;
    lmn_node_desc   node = LMN_NODE_DESC_INIT;
    lmn_drawing    *drawing = NULL;
    lmn_look       *look = NULL;
    lmn_draw_desc   desc = LMN_DRAW_DESC_INIT;
    camera.name = "front";
    DO(lmn_scene_add_camera(s, &camera, &node.camera, &error));
    node.matrix[14] = 12;
    DO(lmn_scene_add_node(s, &node, NULL, &error));
    node.camera = 0;
    DO(lmn_scene_add_light(s, &light, &node.light, &error));
    DO(lmn_scene_add_node(s, &node, NULL, &error));
    DO(lmn_look_load(&look, "plain", &error));
    desc.camera = "front";
    desc.width = desc.height = SIDE;
    DO(lmn_draw(&drawing, renderer, s, look, &desc, &error));
    lmn_drawing_destroy(&drawing);
    desc.camera = "side";
    assert_int_equal(lmn_draw(&drawing, renderer, s, look, &desc, &error), LMN_USAGE);
    lmn_look_destroy(&look);
    lmn_scene_destroy(&s);
}

/* Parts are numbered once, at the end, as if each had been by itself. */
static void changes_together(void **state)
{
    (void)state;
    static uint8_t pixels[4 * PIXELS];
    lmn_scene     *s = fresh(), *wanted = pair(0.2f, 1.5);
    DO(lmn_scene_begin_changes(s, &error));
    DO(lmn_scene_begin_changes(s, &error));
    add_node(s, "one", 0, add_cube(s, 0, 0), -1.5, 0);
    DO(lmn_scene_end_changes(s, &error));
    assert_int_equal(lmn_scene_info_of(s).parts, 0);
    add_node(s, "two", 0, add_cube(s, 0.2f, 0), 1.5, 0.5);
    assert_int_equal(try_draw(s, looks[0], pixels), LMN_USAGE);
    DO(lmn_scene_end_changes(s, &error));
    assert_int_equal(lmn_scene_info_of(s).parts, 2);
    assert_alike(s, wanted);
    assert_int_equal(lmn_scene_end_changes(s, &error), LMN_USAGE);
    lmn_scene_destroy(&s);
    lmn_scene_destroy(&wanted);
}

/* A program that was built before a description grew: what it does not know has its standard value. */
static void older_programs(void **state)
{
    (void)state;
    lmn_scene    *s = pair(0, 1.5);
    lmn_drawing  *drawing = NULL;
    lmn_look     *look = NULL;
    lmn_draw_desc desc = LMN_DRAW_DESC_INIT;
    int           width = 0;
    DO(lmn_look_load(&look, "plain", &error));
    desc.width = desc.height = 64;
    desc.fov_deg = 500;
    desc.struct_size = offsetof(lmn_draw_desc, fov_deg);
    DO(lmn_draw(&drawing, renderer, s, look, &desc, &error));
    lmn_drawing_pixels(drawing, &width, NULL);
    assert_int_equal(width, 64);
    lmn_drawing_destroy(&drawing);
    for (int i = 0; i < 3; i++) {
        desc.struct_size = (const size_t[]){0, 7, sizeof desc + 8}[i];
        assert_int_equal(lmn_draw(&drawing, renderer, s, look, &desc, &error), LMN_USAGE);
        assert_true(error.hint[0] != 0);
    }
    lmn_look_destroy(&look);
    lmn_scene_destroy(&s);
}

/* --- what is refused ------------------------------------------------------------------------------------ */

static void wrong_meshes(void **state)
{
    (void)state;
    float          positions[CORNERS][3], bad[CORNERS][3], zero[CORNERS][3] = {{0}};
    const uint32_t far[3] = {0, 1, 8};
    uint32_t       mesh = 77;
    lmn_scene     *s = pair(0, 1.5), *wanted = pair(0, 1.5);
    cube_corners(0, positions);
    memcpy(bad, positions, sizeof bad);
    bad[3][1] = NAN;
    lmn_mesh_desc right = cube_desc(positions), wrong[12];
    for (int i = 0; i < 12; i++)
        wrong[i] = right;
    wrong[0].struct_size = 0;
    wrong[1].struct_size = sizeof right + 8;
    wrong[2].positions = NULL;
    wrong[3].positions = bad[0];
    wrong[4].normals = zero[0];
    wrong[5].index_count = 4;
    wrong[6].indices = far;
    wrong[6].index_count = 3;
    wrong[7].indices = NULL;
    wrong[8].lines = faces;
    wrong[8].line_index_count = 2;
    wrong[9].material = 1;
    wrong[10].weights = zero[0];
    wrong[11].vertex_count = 0;
    for (int i = 0; i < 12; i++) {
        assert_int_equal(lmn_scene_add_mesh(s, &wrong[i], &mesh, &error), LMN_USAGE);
        assert_int_equal(lmn_scene_set_mesh(s, 1, &wrong[i], &error), LMN_USAGE);
        assert_true(error.message[0] != 0);
    }
    assert_int_equal(mesh, 77);
    assert_int_equal(lmn_scene_add_mesh(NULL, &right, &mesh, &error), LMN_USAGE);
    assert_int_equal(lmn_scene_add_mesh(s, NULL, &mesh, &error), LMN_USAGE);
    assert_int_equal(lmn_scene_set_mesh(s, 0, &right, &error), LMN_USAGE);
    assert_int_equal(lmn_scene_set_mesh(s, 3, &right, &error), LMN_USAGE);
    assert_int_equal(lmn_scene_set_positions(s, 1, positions[0], NULL, 7, &error), LMN_USAGE);
    assert_int_equal(lmn_scene_set_positions(s, 1, NULL, NULL, CORNERS, &error), LMN_USAGE);
    assert_int_equal(lmn_scene_set_positions(s, 1, bad[0], NULL, CORNERS, &error), LMN_USAGE);
    assert_int_equal(lmn_scene_set_positions(s, 1, positions[0], zero[0], CORNERS, &error), LMN_USAGE);
    assert_int_equal(lmn_scene_info_of(s).meshes, 2);
    assert_alike(s, wanted);
    lmn_scene_destroy(&s);
    lmn_scene_destroy(&wanted);
}

static void wrong_nodes(void **state)
{
    (void)state;
    lmn_scene    *s = pair(0, 1.5), *wanted = pair(0, 1.5);
    lmn_node_desc right = LMN_NODE_DESC_INIT, wrong[8];
    double        m[16];
    for (int i = 0; i < 8; i++)
        wrong[i] = right;
    wrong[0].struct_size = 3;
    wrong[1].parent = 3;
    wrong[2].mesh = 3;
    wrong[3].camera = 1;
    wrong[4].light = 1;
    wrong[5].skin = 1;
    wrong[6].matrix[5] = INFINITY;
    wrong[7].matrix[3] = 1;
    for (int i = 0; i < 8; i++)
        assert_int_equal(lmn_scene_add_node(s, &wrong[i], NULL, &error), LMN_USAGE);
    right.mesh = 1;
    right.matrix[12] = 1e30;
    assert_int_equal(lmn_scene_add_node(s, &right, NULL, &error), LMN_FORMAT);
    matrix_at(m, 1e30, 0);
    assert_int_equal(lmn_scene_set_matrix(s, 1, m, &error), LMN_FORMAT);
    assert_int_equal(lmn_scene_set_matrix(s, 0, m, &error), LMN_USAGE);
    assert_int_equal(lmn_scene_set_matrix(s, 1, NULL, &error), LMN_USAGE);
    assert_int_equal(lmn_scene_set_instances(s, 1, NULL, 2, &error), LMN_USAGE);
    assert_int_equal(lmn_scene_set_instances(s, 1, m, 1, &error), LMN_FORMAT);
    assert_int_equal(lmn_scene_set_attribute(s, 1, "", "x", &error), LMN_USAGE);
    assert_int_equal(lmn_scene_remove_node(s, 9, &error), LMN_USAGE);
    assert_int_equal(lmn_scene_set_up(s, LMN_UP_Z, &error), LMN_USAGE);
    assert_int_equal(lmn_scene_node_of_part(s, 3), 0);
    assert_int_equal(lmn_scene_node_of_part(NULL, 1), 0);
    assert_int_equal(lmn_scene_info_of(s).nodes, 2);
    assert_alike(s, wanted);
    lmn_scene_destroy(&s);
    lmn_scene_destroy(&wanted);
}

static void wrong_others(void **state)
{
    (void)state;
    lmn_scene        *s = fresh();
    lmn_material_desc material = LMN_MATERIAL_DESC_INIT;
    lmn_camera_desc   camera = LMN_CAMERA_DESC_INIT;
    lmn_light_desc    light = LMN_LIGHT_DESC_INIT;
    const uint8_t     pixel[4] = {0};
    const double      bind[16] = {0};
    const uint32_t    joint = 1;
    material.colour[1] = 1.5f;
    assert_int_equal(lmn_scene_add_material(s, &material, NULL, &error), LMN_USAGE);
    material = (lmn_material_desc)LMN_MATERIAL_DESC_INIT;
    material.texture = 1;
    assert_int_equal(lmn_scene_add_material(s, &material, NULL, &error), LMN_USAGE);
    assert_int_equal(lmn_scene_set_material(s, 1, &material, &error), LMN_USAGE);
    assert_int_equal(lmn_scene_add_texture(s, NULL, 0, 1, pixel, NULL, &error), LMN_USAGE);
    assert_int_equal(lmn_scene_add_texture(s, NULL, 1, 1, NULL, NULL, &error), LMN_USAGE);
    assert_int_equal(lmn_scene_add_texture(s, NULL, 20000, 1, pixel, NULL, &error), LMN_USAGE);
    camera.fov_deg = 0;
    assert_int_equal(lmn_scene_add_camera(s, &camera, NULL, &error), LMN_USAGE);
    light.type = LMN_LIGHT_SPOT;
    light.inner_cone = 50;
    assert_int_equal(lmn_scene_add_light(s, &light, NULL, &error), LMN_USAGE);
    assert_int_equal(lmn_scene_add_skin(s, &joint, bind, 1, NULL, &error), LMN_USAGE);
    assert_int_equal(lmn_scene_add_skin(s, NULL, bind, 1, NULL, &error), LMN_USAGE);
    assert_int_equal(lmn_scene_set_up(s, LMN_UP_AUTO, &error), LMN_USAGE);
    DO(lmn_scene_set_up(s, LMN_UP_Z, &error));
    assert_int_equal(lmn_scene_info_of(s).up, 'z');
    lmn_scene_destroy(&s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(is_drawn_like_a_file),
                                       cmocka_unit_test(changes_are_drawn),
                                       cmocka_unit_test(moved_meshes_have_their_lines),
                                       cmocka_unit_test(meshes_are_exchanged),
                                       cmocka_unit_test(nodes_come_and_go),
                                       cmocka_unit_test(colours_textures_and_sets),
                                       cmocka_unit_test(skins_hold_vertices),
                                       cmocka_unit_test(cameras_and_lights),
                                       cmocka_unit_test(changes_together),
                                       cmocka_unit_test(wrong_meshes),
                                       cmocka_unit_test(wrong_nodes),
                                       cmocka_unit_test(wrong_others),
                                       cmocka_unit_test(older_programs)};
    return cmocka_run_group_tests(tests, set_up, tear_down);
}
