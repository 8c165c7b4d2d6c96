/* What solids take away: which subtrees, where, in which colours; that nothing else counts it. */
#include "csg_support.h"

#include <jansson.h>

#define CUBE             "cube(size = [10, 10, 10], center = true);"
#define ROD              "cylinder($fn = 8, h = 30, r1 = 2, r2 = 2, center = true);"
#define BALL             "sphere($fn = 8, r = 6);"
#define AT(x, what)      "multmatrix([[1, 0, 0, " #x "], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]]) { " what " }"
#define TURNED(what)     "multmatrix([[0, -1, 0, 1], [1, 0, 0, 2], [0, 0, 1, 3], [0, 0, 0, 1]]) { " what " }"
#define RED(what)        "color([1, 0, 0, 1]) { " what " }"
#define BLUE(what)       "color([0, 0, 1, 1]) { " what " }"
#define DIFFERENCE(what) "difference() { " what " }"

static const solid *removed_of(const lmn_scene *s)
{
    assert_int_equal(s->part_count, 1);
    assert_int_equal(s->ghost_count, 1);
    assert_int_equal(s->solid_count, 2);
    const part *ghost = &s->parts[1];
    const node *n = &s->nodes[ghost->node];
    assert_true(ghost->ghost && n->ghost && !s->parts[0].ghost);
    assert_string_equal(ghost->name, "removed");
    assert_int_equal(n->parent, s->parts[0].node);
    assert_int_equal(scene_part_of_ghost(s, 1), 0);
    assert_true(scene_part_of_ghost(s, 0) == SIZE_MAX);
    assert_int_equal(s->solids[n->solid].nodes[0].kind, SOLID_UNION);
    return &s->solids[n->solid];
}

/* Each operand of the ghost is one of the solid's: the same mesh in the same position and colour. Returns how many it
 * has. */
static size_t check_operands(const lmn_scene *s)
{
    solid_operand *whole, *gone;
    size_t         whole_count, gone_count;
    assert_true(solid_operands(&s->solids[0], &whole, &whole_count));
    assert_true(solid_operands(removed_of(s), &gone, &gone_count));
    size_t at = 0;
    for (size_t i = 0; i < gone_count; i++) {
        while (at < whole_count && (whole[at].mesh != gone[i].mesh ||
                                    memcmp(&whole[at].matrix, &gone[i].matrix, sizeof gone[i].matrix) != 0))
            at++;
        assert_true(at < whole_count);
        assert_int_equal(whole[at].has_colour, gone[i].has_colour);
        assert_memory_equal(&whole[at].colour, &gone[i].colour, sizeof gone[i].colour);
        at++;
    }
    mem_free(whole);
    mem_free(gone);
    return gone_count;
}

static void nothing_removed_has_no_companion(void **state)
{
    (void)state;
    static const char *const texts[] = {
        CUBE,
        "union() { " CUBE        ROD " }",
        "intersection() { " CUBE BALL " }",
        DIFFERENCE(CUBE),
        DIFFERENCE(CUBE "group();"),
        DIFFERENCE(CUBE "union() { intersection() { } }"),
        "linear_extrude(height = 2) { difference() { square(size = [4, 4], center = true); circle($fn = 8, r = 1); } }",
    };
    for (size_t i = 0; i < sizeof texts / sizeof *texts; i++) {
        lmn_scene *s = load_text(texts[i]);
        if (s->ghost_count)
            print_error("%s\n", texts[i]);
        assert_int_equal(s->ghost_count, 0);
        assert_int_equal(s->solid_count, 1);
        for (size_t k = 0; k < s->node_count; k++)
            assert_false(s->nodes[k].ghost);
        lmn_scene_destroy(&s);
    }
}

typedef struct tree_case {
    const char *text;
    size_t      operands, children; /* of the ghost, and of its root */
    double      low[3], high[3];    /* the ghost's bounds */
} tree_case;

static const tree_case trees[] = {
    {DIFFERENCE(CUBE ROD), 1, 1, {-2, -2, -15}, {2, 2, 15}},
    {DIFFERENCE(CUBE ROD AT(20, ROD)), 2, 2, {-2, -2, -15}, {22, 2, 15}},
    {DIFFERENCE(CUBE "union() { " ROD AT(4, ROD) " }"), 2, 1, {-2, -2, -15}, {6, 2, 15}},
    {TURNED(DIFFERENCE(CUBE AT(3, ROD))), 1, 1, {-1, 3, -12}, {3, 7, 18}},
    {AT(1, AT(2, DIFFERENCE(TURNED(CUBE) TURNED(AT(3, ROD))))), 1, 1, {2, 3, -12}, {6, 7, 18}},
    /* Both are taken away from the cube. */
    {DIFFERENCE(DIFFERENCE(CUBE ROD) AT(5, ROD)), 2, 2, {-2, -2, -15}, {7, 2, 15}},
    {"union() { " DIFFERENCE(CUBE ROD) DIFFERENCE(AT(30, CUBE) AT(30, ROD)) " }", 2, 2, {-2, -2, -15}, {32, 2, 15}},
    {"intersection() { " DIFFERENCE(CUBE ROD) BALL " }", 1, 1, {-2, -2, -15}, {2, 2, 15}},
    /* What is taken away from a cutter was never taken from the cube: the cutter alone, and as a whole. */
    {DIFFERENCE(CUBE DIFFERENCE(ROD AT(1, ROD))), 2, 1, {-2, -2, -15}, {2, 2, 15}},
    {DIFFERENCE(CUBE AT(1, DIFFERENCE(ROD DIFFERENCE(BALL ROD)))), 3, 1, {-1, -2, -15}, {3, 2, 15}},
};

static void subtrees_are_whole_and_in_place(void **state)
{
    (void)state;
    for (size_t i = 0; i < sizeof trees / sizeof *trees; i++) {
        const tree_case *c = &trees[i];
        lmn_scene       *s = load_text(c->text);
        const solid     *gone = removed_of(s);
        size_t           children = 0, operands = check_operands(s);
        for (int32_t k = gone->nodes[0].first_child; k != NONE; k = gone->nodes[k].next_sibling)
            children++;
        box3         b = s->parts[1].bounds;
        const double low[3] = {b.min.x, b.min.y, b.min.z}, high[3] = {b.max.x, b.max.y, b.max.z};
        bool         good = operands == c->operands && children == c->children;
        for (int k = 0; k < 3; k++)
            good = good && fabs(low[k] - c->low[k]) < 1e-5 && fabs(high[k] - c->high[k]) < 1e-5;
        if (!good)
            print_error("%s: %zu operands, %zu children, %g %g %g … %g %g %g\n", c->text, operands, children, low[0],
                        low[1], low[2], high[0], high[1], high[2]);
        assert_true(good);
        for (size_t k = 1; k < gone->node_count; k++)
            assert_true(gone->nodes[k].parent >= 0 && (size_t)gone->nodes[k].parent < k);
        lmn_scene_destroy(&s);
    }
}

static void colours_are_handed_down(void **state)
{
    (void)state;
    static const struct {
        const char *text;
        bool        has;
        float       red, blue;
    } cases[] = {
        {DIFFERENCE(RED(CUBE) ROD), false, 0, 0},
        {DIFFERENCE(CUBE RED(ROD)), true, 1, 0},
        {RED(DIFFERENCE(CUBE BLUE(ROD))), true, 1, 0},
        {DIFFERENCE(CUBE BLUE("union() { " RED(ROD) BALL " }")), true, 0, 1},
        {DIFFERENCE(CUBE "union() { " RED(ROD) RED(BALL) " }"), true, 1, 0},
        {RED("union() { " DIFFERENCE(CUBE "union() { " BLUE(ROD) BALL " }") " }"), true, 1, 0},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        lmn_scene     *s = load_text(cases[i].text);
        solid_operand *o;
        size_t         count;
        check_operands(s);
        assert_true(solid_operands(removed_of(s), &o, &count));
        for (size_t k = 0; k < count; k++) {
            assert_int_equal(o[k].has_colour, cases[i].has);
            if (o[k].has_colour && (o[k].colour.x != cases[i].red || o[k].colour.z != cases[i].blue))
                fail_msg("%s: %g %g", cases[i].text, (double)o[k].colour.x, (double)o[k].colour.z);
        }
        mem_free(o);
        lmn_scene_destroy(&s);
    }
}

static void meshes_are_shared(void **state)
{
    (void)state;
    lmn_scene *s = load_text(DIFFERENCE(CUBE ROD AT(4, ROD)));
    assert_int_equal(s->mesh_count, 2);
    assert_int_equal(check_operands(s), 2);
    const solid *gone = removed_of(s);
    assert_int_equal(gone->nodes[1].mesh, gone->nodes[2].mesh);
    assert_string_equal(gone->nodes[1].name, "cylinder");
    assert_int_equal(gone->nodes[1].line, 1);
    lmn_scene_destroy(&s);
}

/* Ids of parts are those without ghosts, whatever the order of the files; bounds and counts too. */
static void ghosts_stand_behind_all_parts(void **state)
{
    (void)state;
    static const char *const texts[] = {DIFFERENCE(CUBE AT(100, ROD)), CUBE, DIFFERENCE(AT(30, CUBE) ROD ROD)};
    static const char *const paths[] = {"file0/file0", "file1/file1", "file2/file2", "file0/file0/removed",
                                        "file2/file2/removed"};
    static const int32_t     owners[] = {-1, -1, -1, 0, 2};
    lmn_scene               *s = NULL;
    assert_int_equal(lmn_scene_create(&s, NULL), LMN_OK);
    for (size_t i = 0; i < 3; i++) {
        char name[16];
        snprintf(name, sizeof name, "file%zu.csg", i);
        assert_int_equal(lmn_scene_add_file(s, temp_file(name, texts[i], strlen(texts[i])), NULL, NULL), LMN_OK);
    }
    assert_int_equal(s->part_count, 3);
    assert_int_equal(s->ghost_count, 2);
    for (size_t i = 0; i < 5; i++) {
        assert_string_equal(s->parts[i].path, paths[i]);
        assert_int_equal(s->parts[i].ghost, i >= 3);
        assert_int_equal(s->nodes[s->parts[i].node].ghost, i >= 3);
        assert_true(scene_part_of_ghost(s, i) == (owners[i] < 0 ? SIZE_MAX : (size_t)owners[i]));
    }
    lmn_scene_info info = lmn_scene_info_of(s);
    assert_int_equal(info.parts, 3);
    assert_int_equal(info.nodes, 6); /* a root and a solid each */
    CHECK_BOX(s, -5, -5, -5, 35, 5, 5);
    lmn_part_info part_info;
    assert_true(lmn_scene_part_at(s, 2, &part_info));
    assert_false(lmn_scene_part_at(s, 3, &part_info));
    lmn_scene_destroy(&s);
}

static void info_lists_them_apart(void **state)
{
    (void)state;
    lmn_scene     *s = load_text(DIFFERENCE(CUBE AT(100, ROD)));
    lmn_scene_info info = lmn_scene_info_of(s);
    char          *text = lmn_scene_info_json(s);
    json_t        *root = json_loads(text, 0, NULL);
    assert_non_null(root);
    const json_t *parts = json_object_get(root, "parts"), *removed = json_object_get(root, "removed"),
                 *gone = json_array_get(removed, 0);
    assert_int_equal(json_array_size(parts), 1);
    assert_int_equal(json_array_size(removed), 1);
    assert_int_equal(json_integer_value(json_object_get(root, "triangles")), info.triangles);
    assert_int_equal(json_integer_value(json_object_get(root, "nodes")), 2);
    assert_int_equal(json_integer_value(json_object_get(gone, "id")), 2);
    assert_string_equal(json_string_value(json_object_get(gone, "path")), "model/model/removed");
    const json_t *tree = json_object_get(gone, "solid");
    assert_int_equal(json_integer_value(json_object_get(tree, "operands")), 1);
    const json_t *low = json_object_get(json_object_get(gone, "bounds"), "min");
    assert_true(fabs(json_number_value(json_array_get(low, 0)) - 98) < 1e-5);
    json_decref(root);
    lmn_text_free(text);
    lmn_scene_destroy(&s);

    s = load_text(CUBE);
    text = lmn_scene_info_json(s);
    root = json_loads(text, 0, NULL);
    assert_int_equal(json_array_size(json_object_get(root, "removed")), 0);
    json_decref(root);
    lmn_text_free(text);
    lmn_scene_destroy(&s);
}

/* A cutter may lie where no part may: the solid is drawn without it. */
static void cutters_beyond_all_bounds_are_no_error(void **state)
{
    (void)state;
    lmn_scene *s = load_text(DIFFERENCE(
        CUBE "multmatrix([[1e20, 0, 0, 0], [0, 1e20, 0, 0], [0, 0, 1e20, 2e20], [0, 0, 0, 1]]) { " CUBE " }"));
    assert_int_equal(s->part_count, 1);
    assert_int_equal(s->ghost_count, 0);
    lmn_scene_destroy(&s);
}

static void memory_may_run_out(void **state)
{
    (void)state;
    static const char text[] = RED(DIFFERENCE(CUBE AT(1, DIFFERENCE(ROD BALL))));
    const char       *path = temp_file("memory.csg", text, sizeof text - 1);
    lmn_status        status = LMN_MEMORY;
    for (long n = 1; status != LMN_OK; n++) {
        lmn_scene *s = NULL;
        assert_int_equal(lmn_scene_create(&s, NULL), LMN_OK);
        lmn_error error = {0};
        mem_fail_at(n);
        status = lmn_scene_add_file(s, path, NULL, &error);
        mem_fail_at(0);
        assert_int_equal(s->ghost_count, status == LMN_OK ? 1 : 0);
        assert_true(status == LMN_OK || status == LMN_MEMORY);
        lmn_scene_destroy(&s);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(nothing_removed_has_no_companion),
        cmocka_unit_test(subtrees_are_whole_and_in_place),
        cmocka_unit_test(colours_are_handed_down),
        cmocka_unit_test(meshes_are_shared),
        cmocka_unit_test(ghosts_stand_behind_all_parts),
        cmocka_unit_test(info_lists_them_apart),
        cmocka_unit_test(cutters_beyond_all_bounds_are_no_error),
        cmocka_unit_test(memory_may_run_out),
    };
    return cmocka_run_group_tests(tests, NULL, remove_temp_folder);
}
