/* STL and PLY, built by hand. */
#include "import_support.h"

static size_t build_stl(unsigned char *out, uint32_t count, const float (*corners)[9])
{
    memset(out, 0, 84);
    put_u32(out + 80, count);
    for (uint32_t i = 0; i < count; i++) {
        memset(out + 84 + 50 * i, 0, 50);
        memcpy(out + 84 + 50 * i + 12, corners[i], 36);
    }
    return 84 + (size_t)50 * count;
}

static const float two_triangles[2][9] = {{0, 0, 0, 1, 0, 0, 0, 1, 0}, {1, 0, 0, 1, 1, 0, 0, 1, -0.0f}};

static void binary_stl_is_welded(void **state)
{
    (void)state;
    unsigned char bytes[512];
    size_t        size = build_stl(bytes, 2, two_triangles);
    memcpy(bytes, "solid pretends to be text", 25);
    lmn_scene *s = load_or_fail(temp_file("two.stl", bytes, size));
    assert_int_equal(s->part_count, 1);
    assert_int_equal(s->meshes[0].primitives[0].vertex_count, 4);
    assert_int_equal(s->up, 'z');
    lmn_part_info part_info;
    assert_true(lmn_scene_part_at(s, 0, &part_info));
    assert_int_equal(part_info.id, 1);
    assert_int_equal(part_info.triangles, 2);
    assert_string_equal(part_info.name, "pretends to be text");
    assert_string_equal(part_info.path, "two/pretends to be text");
    assert_true(part_info.bounds_max[0] == 1);
    assert_false(lmn_scene_part_at(s, 1, &part_info));
    lmn_scene_destroy(&s);
}

static void wrong_stl_counts_are_explained(void **state)
{
    (void)state;
    unsigned char bytes[512];
    lmn_error     error;
    size_t        size = build_stl(bytes, 2, two_triangles);
    put_u32(bytes + 80, 0xFFFFFFFF);
    assert_int_equal(load_status(temp_file("absurd.stl", bytes, size), &error), LMN_FORMAT);
    assert_non_null(strstr(error.message, "4294967295"));
    assert_non_null(strstr(error.message, "byte 80"));
    put_u32(bytes + 80, 0);
    assert_int_equal(load_status(temp_file("none.stl", bytes, 84), &error), LMN_FORMAT);
    assert_non_null(strstr(error.message, "no triangles"));
    assert_int_equal(load_status(temp_file("short.stl", bytes, 83), &error), LMN_FORMAT);
    assert_int_equal(load_status(temp_file("empty.stl", bytes, 0), &error), LMN_FORMAT);
    assert_non_null(strstr(error.message, "empty"));
    assert_int_equal(load_status(temp_folder(), &error), LMN_READ);
    assert_int_equal(load_status("/nowhere/at/all.stl", &error), LMN_READ);
    assert_true(error.hint[0] != '\0');
}

static void bad_triangles_are_left_out(void **state)
{
    (void)state;
    unsigned char bytes[512];
    float         nan_value, inf_value;
    uint32_t      nan_bits = 0x7FC00000, inf_bits = 0x7F800000;
    memcpy(&nan_value, &nan_bits, 4);
    memcpy(&inf_value, &inf_bits, 4);
    const float triangles[4][9] = {{0, 0, 0, 1, 0, 0, 0, 1, 0},
                                   {0, 0, 0, 1, 0, 0, 2, 0, 0},
                                   {0, 0, 0, nan_value, 0, 0, 0, 1, 0},
                                   {0, 0, 0, 1, inf_value, 0, 0, 1, 0}};
    lmn_scene  *s = load_or_fail(temp_file("bad.stl", bytes, build_stl(bytes, 4, triangles)));
    assert_int_equal(lmn_scene_info_of(s).triangles, 1);
    assert_int_equal(s->meshes[0].primitives[0].vertex_count, 3);
    assert_true(has_warning(s, WARNING_BAD_GEOMETRY));
    assert_true(lmn_scene_info_of(s).bounds_max[0] == 1);
    lmn_scene_destroy(&s);
    lmn_error error;
    assert_int_equal(load_status(temp_file("worse.stl", bytes, build_stl(bytes, 3, triangles + 1)), &error),
                     LMN_FORMAT);
    assert_non_null(strstr(error.message, "none of the 3 triangles"));
}

static void text_stl_has_solids(void **state)
{
    (void)state;
    const char *text =
        "\xEF\xBB\xBFSOLID first one\r\n  facet normal 0 0 1\r\n outer loop\r\n vertex 0 0 0\r\n"
        " vertex 1e0 0 0\r\n vertex 0 +1.0 0\r\n endloop\r\n endfacet\r\nendsolid first one\r\n"
        "solid empty\nendsolid\n"
        "solid\nfacet normal 0 0 1 outer loop vertex 0 0 0 vertex 1 0 0 vertex 1 1 0 vertex 0 1 0 endloop\n"
        "endfacet endsolid";
    lmn_scene *s = load_or_fail(temp_file("text.stl", text, strlen(text)));
    assert_int_equal(s->part_count, 2);
    assert_string_equal(s->parts[0].name, "first one");
    assert_int_equal(s->parts[0].triangles, 1);
    assert_int_equal(s->parts[1].triangles, 2);
    lmn_scene_destroy(&s);
    lmn_error   error;
    const char *wrong = "solid x\nfacet normal 0 0 1\nouter loop\nvertex 0 0 zero\n";
    assert_int_equal(load_status(temp_file("wrong.stl", wrong, strlen(wrong)), &error), LMN_FORMAT);
    assert_int_equal(error.line, 4);
    assert_non_null(strstr(error.message, "three numbers"));
}

static void endings_and_content_must_agree(void **state)
{
    (void)state;
    unsigned char bytes[512];
    lmn_error     error;
    size_t        size = build_stl(bytes, 2, two_triangles);
    assert_int_equal(load_status(temp_file("two.ply", bytes, size), &error), LMN_FORMAT);
    assert_non_null(strstr(error.message, "STL"));
    assert_non_null(strstr(error.message, ".ply"));
    lmn_scene *s = load_or_fail(temp_file("two.anything", bytes, size));
    assert_int_equal(s->part_count, 1);
    lmn_scene_destroy(&s);
    assert_int_equal(load_status(temp_file("words.txt", "some words", 10), &error), LMN_UNSUPPORTED);
    assert_int_equal(load_status(temp_file("words.stl", "some words", 10), &error), LMN_FORMAT);
}

static void ply_text_reads_everything(void **state)
{
    (void)state;
    const char *text =
        "ply\nformat ascii 1.0\ncomment made by hand\nelement vertex 4\nproperty uchar red\nproperty float z\n"
        "property double x\nproperty uchar green\nproperty float y\nproperty uchar blue\nproperty float s\n"
        "property float t\nproperty float quality\nelement note 2\nproperty list uchar short words\n"
        "element face 1\nproperty list uchar uint vertex_index\nproperty uchar flags\nend_header\n"
        "255 5 0 0 0 128 0 0 9\n0 5 1 0 0 0 1 0 9\n0 5 1 0 1 0 1 1 9\n0 5 0 255 1 0 0 1 9\n"
        "3 1 2 3\n0\n4 0 1 2 3 7\n";
    lmn_scene       *s = load_or_fail(temp_file("all.ply", text, strlen(text)));
    const primitive *p = &s->meshes[0].primitives[0];
    assert_int_equal(p->vertex_count, 4);
    assert_int_equal(p->index_count, 6);
    assert_true(p->positions[2].x == 1 && p->positions[2].y == 1 && p->positions[2].z == 5);
    assert_float_equal(p->colours[0].x, 1, 1e-6f);
    assert_float_equal(p->colours[0].z, 0.2158605f, 1e-5f); /* sRGB 128/255, by the standard's formula */
    assert_float_equal(p->colours[0].w, 1, 1e-6f);
    assert_float_equal(p->uvs[0][2].x, 1, 1e-6f);
    assert_float_equal(p->uvs[0][2].y, 0, 1e-6f); /* counted from the top */
    assert_null(p->normals);
    assert_int_equal(s->up, 'y');
    assert_true(has_warning(s, WARNING_IGNORED));
    lmn_scene_destroy(&s);
}

/* Writes one number, the most significant byte first when `big`. */
static size_t put_number(unsigned char *to, const void *value, size_t size, bool big)
{
    const unsigned char *from = value;
    for (size_t i = 0; i < size; i++)
        to[i] = from[big ? size - 1 - i : i];
    return size;
}

static void ply_binary_reads_both_orders(void **state)
{
    (void)state;
    for (int big = 0; big < 2; big++) {
        unsigned char bytes[1024];
        size_t        at = (size_t)snprintf((char *)bytes, sizeof bytes,
                                            "ply\nformat binary_%s_endian 1.0\nelement vertex 4\nproperty double x\n"
                                                   "property short y\nproperty float z\nelement tristrips 1\n"
                                                   "property list int int vertex_indices\nend_header\n",
                                     big ? "big" : "little");
        const double  xs[4] = {0, 1, 0, 1};
        const int16_t ys[4] = {0, 0, 1, -300};
        const int32_t strip[8] = {7, 0, 1, 2, 3, -1, 1, 2};
        for (int i = 0; i < 4; i++) {
            float z = (float)i;
            at += put_number(bytes + at, &xs[i], 8, big);
            at += put_number(bytes + at, &ys[i], 2, big);
            at += put_number(bytes + at, &z, 4, big);
        }
        for (int i = 0; i < 8; i++)
            at += put_number(bytes + at, &strip[i], 4, big);
        lmn_scene       *s = load_or_fail(temp_file("binary.ply", bytes, at));
        const primitive *p = &s->meshes[0].primitives[0];
        const uint32_t   expected[6] = {0, 1, 2, 2, 1, 3};
        assert_int_equal(p->index_count, 6);
        assert_memory_equal(p->indices, expected, sizeof expected);
        assert_true(p->positions[3].y == -300 && p->positions[3].z == 3);
        lmn_scene_destroy(&s);
    }
}

static void concave_polygons_keep_their_area(void **state)
{
    (void)state;
    /* An L of area 3. */
    const char *text = "ply\nformat ascii 1.0\nelement vertex 6\nproperty float x\nproperty float y\nproperty float z\n"
                       "element face 1\nproperty list uchar int vertex_indices\nend_header\n"
                       "1 2 0\n0 2 0\n0 0 0\n2 0 0\n2 1 0\n1 1 0\n6 0 1 2 3 4 5\n";
    lmn_scene  *s = load_or_fail(temp_file("ell.ply", text, strlen(text)));
    const primitive *p = &s->meshes[0].primitives[0];
    assert_int_equal(p->index_count, 12);
    double area = 0;
    for (uint32_t i = 0; i < p->index_count; i += 3) {
        vec3 a = p->positions[p->indices[i]], b = p->positions[p->indices[i + 1]], c = p->positions[p->indices[i + 2]];
        double twice = (double)(b.x - a.x) * (double)(c.y - a.y) - (double)(b.y - a.y) * (double)(c.x - a.x);
        assert_true(twice > 0); /* no triangle is turned over */
        area += twice / 2;
    }
    assert_true(area == 3);
    lmn_scene_destroy(&s);
}

static void wrong_ply_is_explained(void **state)
{
    (void)state;
#define POINTS "element vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
#define FACES  "element face 1\nproperty list uchar int vertex_indices\nend_header\n"
    static const struct {
        const char *text, *said;
    } cases[] = {
        {"ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\n", "end_header"},
        {"ply\nformat ascii 1.0\nelement vertex 99999999999\nproperty float x\nproperty float y\nproperty float z\n"
         "end_header\n1 2 3\n",
         "99999999999"},
        {"ply\nformat ascii 1.0\nelement vertex 18446744073709551615\nend_header\n", "element NAME COUNT"},
        {"ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\nend_header\n1 2\n", "x, y, z"},
        {"ply\nformat ascii 1.0\n" POINTS FACES "0 0 0\n1 0 0\n0 1 0\n3 0 1 3\n", "out of range"},
        {"ply\nformat ascii 1.0\n" POINTS FACES "0 0 0\n1 0 0\n0 one 0\n3 0 1 2\n", "expected a number"},
        {"ply\nformat ascii 1.0\n" POINTS FACES "0 0 0\n1 0 0\n0 1 0\n200 0 1 2\n", "longer than the rest"},
        {"ply\nformat ascii 1.0\nelement face 1\nproperty list uchar int vertex_indices\n" POINTS "end_header\n"
         "3 0 1 2\n",
         "before element"},
        {"ply\nformat ascii 1.0\nelement vertex 1\nproperty quaternion x\nend_header\n", "unknown type"},
        {"ply\n" POINTS "end_header\n", "format"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        lmn_error  error;
        lmn_status status = load_status(temp_file("wrong.ply", cases[i].text, strlen(cases[i].text)), &error);
        if (status != LMN_FORMAT || !strstr(error.message, cases[i].said))
            print_error("case %zu says: %s\n", i, error.message);
        assert_int_equal(status, LMN_FORMAT);
        assert_non_null(strstr(error.message, cases[i].said));
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(binary_stl_is_welded),           cmocka_unit_test(wrong_stl_counts_are_explained),
        cmocka_unit_test(bad_triangles_are_left_out),     cmocka_unit_test(text_stl_has_solids),
        cmocka_unit_test(endings_and_content_must_agree), cmocka_unit_test(ply_text_reads_everything),
        cmocka_unit_test(ply_binary_reads_both_orders),   cmocka_unit_test(concave_polygons_keep_their_area),
        cmocka_unit_test(wrong_ply_is_explained),
    };
    return cmocka_run_group_tests(tests, NULL, remove_temp_folder);
}
