/* OBJ and MTL, built by hand, and the stream that foreign formats come through. */
#include "import_support.h"

#include <math.h>

#include "import/assimp_stream.h"

static const char *const square_lines = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";

static lmn_scene *load_text(const char *name, const char *lines)
{
    char text[4096];
    snprintf(text, sizeof text, "%s%s", square_lines, lines);
    return load_or_fail(temp_file(name, text, strlen(text)));
}

static void sharing_stays_as_it_is(void **state)
{
    (void)state;
    lmn_scene       *s = load_text("shared.obj",
                                   "vt 0 0\nvt 1 0\nvt 1 1\nvn 0 0 2\nf 1/1/1 2/2/1 3/3/1\nf -4/1/-1 -2/3/-1 \\\r\n -1/2/-1");
    const primitive *p = &s->meshes[0].primitives[0];
    const uint32_t   expected[6] = {0, 1, 2, 0, 2, 3};
    assert_int_equal(p->vertex_count, 4);
    assert_memory_equal(p->indices, expected, sizeof expected);
    assert_true(p->uvs[0][2].x == 1 && p->uvs[0][2].y == 0);
    assert_true(p->normals[0].z == 1);
    assert_int_equal(s->up, 'y');
    assert_string_equal(s->parts[0].path, "shared/shared");
    lmn_scene_destroy(&s);
    /* Another texture coordinate at the same position is another vertex. */
    s = load_text("split.obj", "vt 0 0\nvt 1 0\nf 1/1 2/1 3/1\nf 1/2 3/1 4/1\n");
    assert_int_equal(s->meshes[0].primitives[0].vertex_count, 5);
    assert_null(s->meshes[0].primitives[0].normals);
    lmn_scene_destroy(&s);
}

static void objects_and_groups_are_parts(void **state)
{
    (void)state;
    lmn_scene *s = load_text("groups.obj", "g one\nf 1 2 3\ng two words\nf 1 3 4\ng one\nf 2 3 4\n");
    assert_int_equal(s->part_count, 2);
    assert_string_equal(s->parts[0].name, "one");
    assert_int_equal(s->parts[0].triangles, 2);
    assert_string_equal(s->parts[1].path, "groups/two words");
    lmn_scene_destroy(&s);
    s = load_text("objects.obj", "o a\ng x\nf 1 2 3\ng y\nf 1 3 4\no empty\no b\nf 2 3 4\n");
    assert_int_equal(s->part_count, 2);
    assert_string_equal(s->parts[1].name, "b");
    lmn_scene_destroy(&s);
}

static void materials_come_from_the_library(void **state)
{
    (void)state;
    const char *library = "# made by hand\nnewmtl red\nKd 1 0 0\nKe 0 1 0\nNs 30\nd 0.5\nnewmtl two words\n  Tr 0.25\n"
                          "newmtl lost\nmap_Kd -s 1 1 1 -clamp on textures\\lost.png\n";
    temp_file("lib one.mtl", library, strlen(library));
    lmn_scene *s =
        load_text("materials.obj", "mtllib lib one.mtl\r\nmtllib none.mtl\nusemtl red\nf 1 2 3\nusemtl two words\n"
                                   "f 1 3 4\nusemtl unknown\nf 2 3 4\nusemtl red\nf 1 2 4\n");
    const mesh *m = &s->meshes[0];
    assert_int_equal(m->primitive_count, 3);
    assert_int_equal(m->primitives[0].index_count, 6);
    const material *red = &s->materials[m->primitives[0].material];
    assert_string_equal(red->name, "red");
    assert_true(red->base_colour.x == 1 && red->base_colour.y == 0 && red->base_colour.w == 0.5f);
    assert_true(red->alpha == ALPHA_BLEND && red->emissive[1] == 1 && red->shininess == 30);
    const material *second = &s->materials[m->primitives[1].material];
    assert_string_equal(second->name, "two words");
    assert_float_equal(second->base_colour.x, 0.6038f, 1e-6f);
    assert_float_equal(second->base_colour.w, 0.75f, 1e-6f);
    assert_string_equal(s->materials[m->primitives[2].material].name, "unknown");
    assert_true(has_warning(s, WARNING_MISSING_FILE));
    lmn_scene_destroy(&s);
}

static void colours_and_polygons_are_read(void **state)
{
    (void)state;
    const char *text = "\xEF\xBB\xBFv 0 0 0\nv 2 0 0 1 0 0.5019608\nv 2 2 0 0 1 0\nv 1 0.5 0 0 0 1\nv 0 2 0 1 1 1\nf 1 "
                       "2 3 4 5 # concave\n"
                       "l 1 2\np 1\ns off\ncurv 1\nf 1 2\n";
    lmn_scene  *s = load_or_fail(temp_file("colours.obj", text, strlen(text)));
    const primitive *p = &s->meshes[0].primitives[0];
    assert_int_equal(p->index_count, 9);
    for (uint32_t i = 0; i < p->vertex_count; i++) {
        vec3 at = p->positions[i];
        if (at.x == 0 && at.y == 0) /* none given: white */
            assert_true(p->colours[i].x == 1 && p->colours[i].w == 1);
        if (at.x == 2 && at.y == 0)
            assert_float_equal(p->colours[i].z, 0.2158605f, 1e-4f);
    }
    double area = 0;
    for (uint32_t i = 0; i < p->index_count; i += 3) {
        vec3 a = p->positions[p->indices[i]], b = p->positions[p->indices[i + 1]], c = p->positions[p->indices[i + 2]];
        double twice = (double)(b.x - a.x) * (double)(c.y - a.y) - (double)(b.y - a.y) * (double)(c.x - a.x);
        assert_true(twice > 0);
        area += twice / 2;
    }
    assert_true(area == 2.5); /* 4 less a notch of base 2 and height 1.5 */
    assert_true(has_warning(s, WARNING_IGNORED) && has_warning(s, WARNING_BAD_GEOMETRY));
    lmn_scene_destroy(&s);
}

static void wrong_lines_are_told(void **state)
{
    (void)state;
    static const char *const cases[] = {
        "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 4\n",  "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 0 1 2\n",
        "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 -4\n", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1/1 2 3\n",
        "v 0 0 0\nv 1 0 0\n\nv 0 1\n",           "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 99999999999999999999\n"};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        lmn_error error;
        assert_int_equal(load_status(temp_file("wrong.obj", cases[i], strlen(cases[i])), &error), LMN_FORMAT);
        assert_int_equal(error.line, 4);
    }
}

/* What the child writes is believed in nothing: any cut and any changed byte ends in an error or a sane scene. */
static void broken_streams_are_refused(void **state)
{
    (void)state;
    unsigned char bytes[1024], changed[1024];
    size_t        size = 0;
    const float matrix[16] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1}, points[9] = {0, 0, 0, 1, 0, 0, 0, 1, 0};
    const uint32_t counts[] = {0, 0, 0, 1, 1}, mesh_facts[] = {0, 0, 3, 3, 0}, corners[3] = {0, 1, 2};
    const uint32_t node_count = 1, root = UINT32_MAX, name = 0, own[2] = {1, 0};
#define PUT(value) (memcpy(bytes + size, &(value), sizeof(value)), size += sizeof(value))
    bytes[size++] = 'M';
    PUT(counts);
    bytes[size++] = 'm';
    PUT(mesh_facts);
    PUT(points);
    PUT(corners);
    PUT(node_count);
    PUT(root);
    PUT(name);
    PUT(matrix);
    PUT(own);
    bytes[size++] = 'Z';
    for (size_t cut = 0; cut <= size; cut++) {
        lmn_scene *s = scene_new();
        import_job job = {.path = "stream", .scene = s};
        lmn_status status = assimp_stream_read(&job, bytes, cut, NULL);
        assert_int_equal(status == LMN_OK, cut == size);
        scene_free(s);
    }
    for (size_t at = 0; at < size; at++)
        for (int bit = 0; bit < 8; bit++) {
            memcpy(changed, bytes, size);
            changed[at] ^= (unsigned char)(1 << bit);
            lmn_scene *s = scene_new();
            import_job job = {.path = "stream", .scene = s};
            if (assimp_stream_read(&job, changed, size, NULL) == LMN_OK)
                scene_finish(s, "stream", NULL);
            scene_free(s);
        }
}

static void foreign_formats_come_through_the_child(void **state)
{
    (void)state;
    const char *text = "OFF\n4 2 0\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n3 0 1 2\n3 0 2 3\n";
    lmn_scene  *s = load_or_fail(temp_file("square.off", text, strlen(text)));
    assert_int_equal(lmn_scene_info_of(s).triangles, 2);
    assert_int_equal(s->meshes[0].primitives[0].vertex_count, 4); /* shared again */
    lmn_scene_destroy(&s);
    lmn_error error;
    assert_int_equal(load_status(temp_file("no.off", "OFF\nnonsense", 12), &error), LMN_FORMAT);
    assert_true(error.hint[0] != '\0');
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(sharing_stays_as_it_is),
        cmocka_unit_test(objects_and_groups_are_parts),
        cmocka_unit_test(materials_come_from_the_library),
        cmocka_unit_test(colours_and_polygons_are_read),
        cmocka_unit_test(wrong_lines_are_told),
        cmocka_unit_test(broken_streams_are_refused),
        cmocka_unit_test(foreign_formats_come_through_the_child),
    };
    return cmocka_run_group_tests(tests, NULL, remove_temp_folder);
}
