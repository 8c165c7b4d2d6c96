/* The scene and its public face: merging, paths, axes, info, arguments. */
#include "import_support.h"

#include <jansson.h>

static const char *const triangle_stl = "solid part\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\n"
                                        "vertex 0 2 3\nendloop\nendfacet\nendsolid\n";
static const char *const triangle_ply = "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
                                        "property float z\nelement face 1\nproperty list uchar int vertex_index\n"
                                        "end_header\n0 0 0\n1 0 0\n0 2 3\n3 0 1 2\n";

static lmn_status add(lmn_scene *s, const char *name, const char *text, const lmn_load_desc *desc)
{
    return lmn_scene_add_file(s, temp_file(name, text, strlen(text)), desc, NULL);
}

static void later_files_are_turned_to_the_first(void **state)
{
    (void)state;
    lmn_scene    *s = NULL;
    lmn_part_info info;
    assert_int_equal(lmn_scene_create(&s, NULL), LMN_OK);
    assert_int_equal(add(s, "a.stl", triangle_stl, NULL), LMN_OK);
    assert_int_equal(add(s, "b.ply", triangle_ply, NULL), LMN_OK);
    assert_int_equal(lmn_scene_info_of(s).up, 'z');
    assert_true(lmn_scene_part_at(s, 1, &info));
    assert_int_equal(info.id, 2);
    assert_string_equal(info.path, "b/b");
    /* +Y up becomes +Z up: (0, 2, 3) goes to (0, −3, 2). */
    assert_true(info.bounds_min[1] == -3 && info.bounds_max[2] == 2);
    lmn_scene_destroy(&s);
    lmn_load_desc desc = LMN_LOAD_DESC_INIT;
    desc.up_axis = LMN_UP_Y;
    assert_int_equal(lmn_scene_create(&s, NULL), LMN_OK);
    assert_int_equal(add(s, "a.stl", triangle_stl, &desc), LMN_OK);
    assert_int_equal(lmn_scene_info_of(s).up, 'y');
    desc.up_axis = LMN_UP_Z;
    assert_int_equal(add(s, "b.ply", triangle_ply, &desc), LMN_OK);
    assert_true(lmn_scene_part_at(s, 1, &info));
    /* +Z up becomes +Y up: (0, 2, 3) goes to (0, 3, −2). */
    assert_true(info.bounds_max[1] == 3 && info.bounds_min[2] == -2);
    mat4 *worlds = scene_world_matrices(s, NULL);
    box3  box = part_bounds(s, worlds, 1);
    assert_true(box.max.y == 3 && box.min.z == -2);
    mem_free(worlds);
    lmn_scene_destroy(&s);
}

static void revisions_tell_scenes_apart(void **state)
{
    (void)state;
    lmn_scene *a = NULL, *b = NULL;
    assert_int_equal(lmn_scene_create(&a, NULL), LMN_OK);
    assert_int_equal(add(a, "a.stl", triangle_stl, NULL), LMN_OK);
    uint64_t revision = a->revision;
    lmn_scene_destroy(&a); /* the next one may lie at the same address */
    assert_int_equal(lmn_scene_create(&b, NULL), LMN_OK);
    assert_int_equal(add(b, "a.stl", triangle_stl, NULL), LMN_OK);
    assert_true(b->revision != revision);
    lmn_scene_destroy(&b);
}

static void paths_are_unique(void **state)
{
    (void)state;
    lmn_scene *s = NULL;
    char       text[2048];
    snprintf(text, sizeof text, "%s%s%s", triangle_stl, triangle_stl, triangle_stl);
    assert_int_equal(lmn_scene_create(&s, NULL), LMN_OK);
    assert_int_equal(add(s, "same.stl", text, NULL), LMN_OK);
    uint64_t revision = s->revision;
    assert_int_equal(add(s, "same.stl", text, NULL), LMN_OK);
    assert_true(s->revision != revision);
    static const char *const expected[6] = {"same/part",   "same/part#2",   "same/part#3",
                                            "same#2/part", "same#2/part#2", "same#2/part#3"};
    assert_int_equal(s->part_count, 6);
    for (int i = 0; i < 6; i++) {
        assert_string_equal(s->parts[i].path, expected[i]);
        assert_string_equal(s->parts[i].name, "part");
    }
    lmn_scene_destroy(&s);
}

static bool stop(double fraction, const char *stage, void *user)
{
    int *calls = user;
    (void)stage;
    assert_true(fraction >= 0 && fraction <= 1);
    return ++*calls < 2;
}

static void failures_leave_the_scene_alone(void **state)
{
    (void)state;
    lmn_scene *s = NULL;
    int        calls = 0;
    assert_int_equal(lmn_scene_create(&s, NULL), LMN_OK);
    assert_int_equal(add(s, "a.stl", triangle_stl, NULL), LMN_OK);
    uint64_t revision = s->revision;
    assert_int_equal(add(s, "bad.stl", "solid\nfacet\n", NULL), LMN_FORMAT);
    lmn_load_desc desc = LMN_LOAD_DESC_INIT;
    desc.progress = stop;
    desc.progress_user = &calls;
    assert_int_equal(add(s, "a.stl", triangle_stl, &desc), LMN_CANCELLED);
    assert_int_equal(s->revision, revision);
    assert_int_equal(s->part_count, 1);
    lmn_scene_destroy(&s);
}

static void arguments_are_checked(void **state)
{
    (void)state;
    lmn_error     error;
    lmn_scene    *s = NULL;
    lmn_load_desc desc = {0};
    assert_int_equal(lmn_scene_create(NULL, &error), LMN_USAGE);
    assert_int_equal(lmn_scene_create(&s, NULL), LMN_OK);
    assert_int_equal(lmn_scene_add_file(NULL, "x.stl", NULL, &error), LMN_USAGE);
    assert_int_equal(lmn_scene_add_file(s, NULL, NULL, &error), LMN_USAGE);
    assert_int_equal(lmn_scene_add_file(s, "", NULL, &error), LMN_USAGE);
    assert_int_equal(lmn_scene_add_file(s, "x.stl", &desc, &error), LMN_USAGE);
    assert_non_null(strstr(error.hint, "LMN_LOAD_DESC_INIT"));
    desc = (lmn_load_desc)LMN_LOAD_DESC_INIT;
    desc.up_axis = (lmn_up_axis)7;
    assert_int_equal(lmn_scene_add_file(s, "x.stl", &desc, &error), LMN_USAGE);
    assert_false(lmn_scene_part_at(s, 0, NULL));
    assert_int_equal(lmn_scene_info_of(NULL).parts, 0);
    assert_null(lmn_scene_info_json(NULL));
    lmn_scene_destroy(&s);
    assert_null(s);
    lmn_scene_destroy(&s);
    lmn_scene_destroy(NULL);
    lmn_text_free(NULL);
}

static void info_is_json_with_its_keys(void **state)
{
    (void)state;
    static const char *const keys[] = {"files",    "triangles", "nodes",  "meshes",     "bounds",
                                       "up",       "load_ms",   "parts",  "animations", "materials",
                                       "textures", "cameras",   "lights", "skins",      "warnings"};
    lmn_scene               *s = NULL;
    assert_int_equal(lmn_scene_create(&s, NULL), LMN_OK);
    assert_int_equal(add(s, "quote\"d \xFF.stl", triangle_stl, NULL), LMN_OK);
    char        *text = lmn_scene_info_json(s);
    json_error_t problem;
    json_t      *root = json_loads(text, 0, &problem);
    assert_non_null(root);
    for (size_t i = 0; i < sizeof keys / sizeof *keys; i++)
        assert_non_null(json_object_get(root, keys[i]));
    json_t *part_json = json_array_get(json_object_get(root, "parts"), 0);
    assert_string_equal(json_string_value(json_object_get(part_json, "path")), "quote\"d \xEF\xBF\xBD/part");
    assert_int_equal(json_integer_value(json_object_get(part_json, "id")), 1);
    json_t *max = json_object_get(json_object_get(root, "bounds"), "max");
    assert_true(json_number_value(json_array_get(max, 1)) == 2);
    json_decref(root);
    lmn_text_free(text);
    lmn_scene_destroy(&s);
}

/* Four faces of a tetrahedron, one of them left out, one that stands on an edge, and a second tetrahedron. */
static void info_tells_of_edges(void **state)
{
    (void)state;
    static const char tetrahedra[] = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nv 5 0 0\nv 6 0 0\nv 5 1 0\nv 5 0 1\nv 1 1 1\n"
                                     "f 1 3 2\nf 1 2 4\nf 1 4 3\n%sf 5 7 6\nf 5 6 8\nf 5 8 7\nf 6 7 8\n%s";
    static const struct {
        const char *last, *fin;
        int         edges, borders, non_manifold, bodies, closed;
    } cases[] = {
        {"f 2 3 4\n", "", 12, 0, 0, 2, 2}, {"", "", 12, 3, 0, 2, 1}, {"f 2 3 4\n", "f 1 2 9\n", 14, 2, 1, 3, 1}};
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        char       text[400];
        lmn_scene *s = NULL;
        snprintf(text, sizeof text, tetrahedra, cases[k].last, cases[k].fin);
        assert_int_equal(lmn_scene_create(&s, NULL), LMN_OK);
        assert_int_equal(add(s, "tetrahedra.obj", text, NULL), LMN_OK);
        char   *json = lmn_scene_info_json(s);
        json_t *root = json_loads(json, 0, NULL);
        json_t *mesh = json_object_get(json_array_get(json_object_get(root, "parts"), 0), "mesh");
        assert_int_equal(json_integer_value(json_object_get(mesh, "edges")), cases[k].edges);
        assert_int_equal(json_integer_value(json_object_get(mesh, "borders")), cases[k].borders);
        assert_int_equal(json_integer_value(json_object_get(mesh, "non_manifold")), cases[k].non_manifold);
        assert_int_equal(json_integer_value(json_object_get(mesh, "bodies")), cases[k].bodies);
        assert_int_equal(json_integer_value(json_object_get(mesh, "closed_bodies")), cases[k].closed);
        json_decref(root);
        lmn_text_free(json);
        lmn_scene_destroy(&s);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(later_files_are_turned_to_the_first),
        cmocka_unit_test(revisions_tell_scenes_apart),
        cmocka_unit_test(paths_are_unique),
        cmocka_unit_test(failures_leave_the_scene_alone),
        cmocka_unit_test(arguments_are_checked),
        cmocka_unit_test(info_is_json_with_its_keys),
        cmocka_unit_test(info_tells_of_edges),
    };
    return cmocka_run_group_tests(tests, NULL, remove_temp_folder);
}
