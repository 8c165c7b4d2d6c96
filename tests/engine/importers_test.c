/* Importers of the host: OFF files, read by calls, against the same scene made without a file. */
#include "checked.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { SIDE = 64 };

static const char tetrahedron[] = "OFF\n4 4 6\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 2 1\n3 0 1 3\n3 0 3 2\n3 1 2 3\n";

static int asked; /* of the probe */

static bool is_off(const void *bytes, size_t size, void *user)
{
    asked++;
    return user && size > 4 && memcmp(bytes, "OFF\n", 4) == 0;
}

/* Enough of the format for this test. */
static lmn_status read_off(lmn_scene *scene, const char *path, const void *bytes, size_t size, void *user, lmn_error *e)
{
    float         positions[3 * 16];
    uint32_t      indices[3 * 16];
    int           vertices, faces, used;
    char          text[512];
    lmn_mesh_desc mesh = LMN_MESH_DESC_INIT;
    lmn_node_desc node = LMN_NODE_DESC_INIT;
    assert_non_null(strstr(path, "importers_model."));
    assert_true(size < sizeof text);
    memcpy(text, bytes, size);
    text[size] = 0;
    const char *at = text;
    if (sscanf(at, "OFF %d %d %*d%n", &vertices, &faces, &used) != 2 || vertices > 16 || faces > 16) {
        e->line = 2;
        snprintf(e->message, sizeof e->message, "the counts are wrong");
        snprintf(e->hint, sizeof e->hint, "count again");
        return LMN_FORMAT;
    }
    at += used;
    for (int i = 0; i < vertices; i++, at += used)
        assert_int_equal(
            sscanf(at, "%f %f %f%n", &positions[3 * i], &positions[3 * i + 1], &positions[3 * i + 2], &used), 3);
    for (int i = 0; i < faces; i++, at += used)
        assert_int_equal(sscanf(at, "%*d %u %u %u%n", &indices[3 * i], &indices[3 * i + 1], &indices[3 * i + 2], &used),
                         3);
    mesh.positions = positions;
    mesh.vertex_count = (size_t)vertices;
    mesh.indices = indices;
    mesh.index_count = 3 * (size_t)faces;
    node.name = user ? (const char *)user : "tetrahedron";
    lmn_status status = lmn_scene_add_mesh(scene, &mesh, &node.mesh, e);
    return status == LMN_OK ? lmn_scene_add_node(scene, &node, NULL, e) : status;
}

static lmn_status fails_silently(lmn_scene *scene, const char *path, const void *bytes, size_t size, void *user,
                                 lmn_error *e)
{
    (void)scene, (void)path, (void)bytes, (void)size, (void)user, (void)e;
    return LMN_UNSUPPORTED;
}

static lmn_status leaves_changes_open(lmn_scene *scene, const char *path, const void *bytes, size_t size, void *user,
                                      lmn_error *e)
{
    (void)path, (void)bytes, (void)size, (void)user;
    return lmn_scene_begin_changes(scene, e);
}

/* --- files ---------------------------------------------------------------------------------------------- */

static void write_file(const char *path, const char *text)
{
    FILE *file = fopen(path, "wb");
    assert_non_null(file);
    assert_true(fwrite(text, 1, strlen(text), file) == strlen(text));
    assert_int_equal(fclose(file), 0);
}

static lmn_status add(lmn_scene *scene, const char *path, const lmn_importer *by)
{
    const lmn_importer *const list[] = {by};
    lmn_load_desc             desc = LMN_LOAD_DESC_INIT;
    desc.importers = list;
    desc.importer_count = 1;
    memset(&error, 0, sizeof error);
    return lmn_scene_add_file(scene, path, &desc, &error);
}

static lmn_importer describe(lmn_import_fn read)
{
    lmn_importer of = LMN_IMPORTER_INIT;
    of.name = "OFF";
    of.endings = ".coff .off";
    of.read = read;
    return of;
}

static uint8_t *picture_of(const lmn_scene *scene)
{
    lmn_renderer *renderer = NULL;
    lmn_look     *look = NULL;
    lmn_drawing  *drawing = NULL;
    lmn_draw_desc desc = LMN_DRAW_DESC_INIT;
    uint8_t      *copy = malloc(4 * SIDE * SIDE);
    desc.width = desc.height = SIDE;
    DO(lmn_renderer_create(&renderer, NULL, &error));
    DO(lmn_look_load(&look, "technical", &error));
    DO(lmn_draw(&drawing, renderer, scene, look, &desc, &error));
    assert_non_null(copy);
    memcpy(copy, lmn_drawing_pixels(drawing, NULL, NULL), 4 * SIDE * SIDE);
    lmn_drawing_destroy(&drawing);
    lmn_look_destroy(&look);
    lmn_renderer_destroy(&renderer);
    return copy;
}

static void is_drawn_as_if_made_by_calls(void **state)
{
    (void)state;
    const char   *path = "importers_model.off";
    lmn_scene    *loaded = NULL, *made = NULL;
    lmn_importer  of = describe(read_off);
    lmn_part_info part;
    write_file(path, tetrahedron);
    DO(lmn_scene_create(&loaded, &error));
    DO(lmn_scene_create(&made, &error));
    DO(add(loaded, path, &of));
    DO(read_off(made, path, tetrahedron, strlen(tetrahedron), NULL, &error));
    assert_true(lmn_scene_part_at(loaded, 0, &part) && part.triangles == 4);
    assert_string_equal(part.name, "tetrahedron");
    uint8_t *one = picture_of(loaded), *other = picture_of(made);
    assert_memory_equal(one, other, 4 * SIDE * SIDE);
    free(one);
    free(other);
    /* A second file joins it, and changes go on by calls. */
    DO(add(loaded, path, &of));
    assert_int_equal(lmn_scene_info_of(loaded).parts, 2);
    DO(lmn_scene_remove_node(loaded, lmn_scene_node_of_part(loaded, 1), &error));
    assert_int_equal(lmn_scene_info_of(loaded).parts, 1);
    lmn_scene_destroy(&loaded);
    lmn_scene_destroy(&made);
}

/* A probe decides by content, whatever the ending, and before Limner's own formats. */
static void probes_decide(void **state)
{
    (void)state;
    lmn_scene    *scene = NULL;
    lmn_importer  of = describe(read_off);
    lmn_part_info part;
    char          name[] = "by probe";
    of.probe = is_off;
    of.user = name;
    write_file("importers_model.stl", tetrahedron);
    DO(lmn_scene_create(&scene, &error));
    DO(add(scene, "importers_model.stl", &of));
    assert_int_equal(asked, 1);
    assert_true(lmn_scene_part_at(scene, 0, &part));
    assert_string_equal(part.name, "by probe");
    of.user = NULL; /* the probe says no: read as what it is */
    DO(add(scene, EXAMPLES "/box.glb", &of));
    assert_int_equal(asked, 2);
    assert_int_equal(lmn_scene_info_of(scene).parts, 2);
    lmn_scene_destroy(&scene);
}

static void refuses(const char *text, const lmn_importer *of, lmn_status expected, const char *word)
{
    lmn_scene *scene = NULL;
    write_file("importers_model.off", text);
    DO(lmn_scene_create(&scene, &error));
    assert_int_equal(add(scene, "importers_model.off", of), expected);
    if (!strstr(error.message, word))
        fail_msg("'%s' does not say '%s'", error.message, word);
    assert_int_equal(lmn_scene_info_of(scene).nodes, 0);
    lmn_scene_destroy(&scene);
}

static void errors_come_back(void **state)
{
    (void)state;
    lmn_importer of = describe(read_off), bad;
    refuses("OFF\nmany\n", &of, LMN_FORMAT, "counts are wrong");
    assert_string_equal(error.file, "importers_model.off");
    assert_string_equal(error.hint, "count again");
    assert_int_equal(error.line, 2);
    assert_int_equal(error.status, LMN_FORMAT);
    refuses(tetrahedron, (bad = of, bad.read = fails_silently, &bad), LMN_UNSUPPORTED, "does not say why");
    refuses(tetrahedron, (bad = of, bad.read = leaves_changes_open, &bad), LMN_USAGE, "open");
    refuses(tetrahedron, (bad = of, bad.read = NULL, &bad), LMN_USAGE, "read");
    refuses(tetrahedron, (bad = of, bad.endings = NULL, &bad), LMN_USAGE, "endings");
    refuses(tetrahedron, (bad = of, bad.name = NULL, &bad), LMN_USAGE, "name");
    refuses(tetrahedron, (bad = of, bad.struct_size = 0, &bad), LMN_USAGE, "LMN_IMPORTER_INIT");
    refuses(tetrahedron, (bad = of, bad.struct_size++, &bad), LMN_USAGE, "struct_size");
    refuses(tetrahedron, NULL, LMN_USAGE, "NULL");
    refuses("", &of, LMN_FORMAT, "empty");
    refuses("no model at all\n", (bad = of, bad.endings = ".of", &bad), LMN_FORMAT, "");
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(is_drawn_as_if_made_by_calls), cmocka_unit_test(probes_decide),
                                       cmocka_unit_test(errors_come_back)};
    return cmocka_run_group_tests_name("importers", tests, NULL, NULL);
}
