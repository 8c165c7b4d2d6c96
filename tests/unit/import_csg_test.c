/* OpenSCAD's evaluated files: syntax, what each word means, and what is refused. */
#include "csg_support.h"

#include "base/limits.h"

/* --- syntax --------------------------------------------------------------------------------------------- */

static void errors_tell_line_and_column(void **state)
{
    (void)state;
    static const struct {
        const char *text;
        int         line, column;
    } cases[] = {
        {"cube(size = 1)", 1, 15},
        {"cube(\n  size = 1 2);", 2, 12},
        {"cube(size = [1, 2);", 1, 18},
        {"cube(size = [1, , 2]);", 1, 17},
        {"\n\n  }", 3, 3},
        {"cube(size = 1);\n  =", 2, 3},
        {"text(text = \"open\n, size = 3;", 1, 13},
        {"group() {\n  cube(size = 12x);\n}", 2, 15},
        {"cube size", 1, 6},
        {"cube(size = word);", 1, 13},
        {"/* comment\n*/ \x01", 2, 4},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        lmn_error error;
        assert_int_equal(status_of(cases[i].text, &error), LMN_FORMAT);
        if (error.line != cases[i].line || error.column != cases[i].column)
            print_error("%s\n -> %d:%d %s\n", cases[i].text, error.line, error.column, error.message);
        assert_int_equal(error.line, cases[i].line);
        assert_int_equal(error.column, cases[i].column);
    }
    lmn_error error;
    assert_int_equal(status_of("group() {\n union() {\n cube();\n }\n", &error), LMN_FORMAT);
    assert_non_null(strstr(error.message, "group in line 1 is never closed"));
}

static size_t repeat(char *text, size_t size, const char *word, int count)
{
    for (int i = 0; i < count; i++, size += strlen(word))
        memcpy(text + size, word, strlen(word));
    return size;
}

static void nesting_has_a_limit(void **state)
{
    (void)state;
    enum { DEEP = 10000 };
    static char text[DEEP * 10 + 64];
    static const struct {
        const char *open, *middle, *close;
        int         depth;
        lmn_status  expected;
    } cases[] = {
        {"group(){", "cube();", "}", DEEP, LMN_LIMIT},
        {"group(){", "cube();", "}", LIMIT_CSG_DEPTH, LMN_OK},
        {"hull(){", "cube();", "}", LIMIT_CSG_DEPTH - 1, LMN_OK},
        {"cube(", "", "", 1, LMN_FORMAT},
        {"[", "", "]", DEEP, LMN_LIMIT},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        size_t size = repeat(text, 0, *cases[i].open == '[' ? "cube(" : "", 1);
        size = repeat(text, size, cases[i].open, cases[i].depth);
        size = repeat(text, size, cases[i].middle, 1);
        size = repeat(text, size, cases[i].close, cases[i].depth);
        lmn_error  error;
        lmn_status status = load_status(temp_file("deep.csg", text, size), &error);
        if (status != cases[i].expected)
            print_error("%s: %d %s\n", cases[i].open, status, error.message);
        assert_int_equal(status, cases[i].expected);
    }
}

static void every_cut_is_an_error_or_a_model(void **state)
{
    (void)state;
    const char *text =
        "multmatrix([[1,0,0,2],[0,1,0,0],[0,0,1,0],[0,0,0,1]]){difference(){cube(size=[1,2,3],center=true);"
        "cylinder(h=4,r1=0.2,r2=1e-1,$fn=8);}}#color(\"red\"){sphere(r=1,$fn=6);}";
    for (size_t size = 1; size < strlen(text); size++) {
        lmn_error  error;
        lmn_status status = load_status(temp_file("cut.csg", text, size), &error);
        assert_true(status == LMN_OK || status == LMN_FORMAT);
    }
}

static void memory_that_runs_out_is_an_error(void **state)
{
    (void)state;
    const char *text =
        "color([1,0,0]){difference(){cube(size=2);hull(){sphere(r=1);cube(size=1);}cylinder(r=1);}}cube(size=2);";
    const char *path = temp_file("memory.csg", text, strlen(text));
    lmn_status  status = LMN_MEMORY;
    for (long n = 1; status != LMN_OK; n++) {
        lmn_scene *s = NULL;
        assert_int_equal(lmn_scene_create(&s, NULL), LMN_OK);
        mem_fail_at(n);
        status = lmn_scene_add_file(s, path, NULL, NULL);
        mem_fail_at(0);
        assert_true(status == LMN_OK || status == LMN_MEMORY);
        lmn_scene_destroy(&s);
        assert_true(n < 10000);
    }
}

/* --- plain solids --------------------------------------------------------------------------------------- */

static void defaults_and_positions(void **state)
{
    (void)state;
    expect_box("cube();", 0, 0, 0, 1, 1, 1);
    expect_box("cube(2);", 0, 0, 0, 2, 2, 2);
    expect_box("cube([1, 2, 3], true);", -0.5, -1, -1.5, 0.5, 1, 1.5);
    expect_box("cube(center = true, size = [1, 2]);", -0.5, -1, -0.5, 0.5, 1, 0.5);
    expect_box("cube(size = undef, center = undef);", 0, 0, 0, 1, 1, 1);
    expect_box("cylinder($fn = 4);", -1, -1, 0, 1, 1, 1);
    expect_box("cylinder(3, 2, 1, true, $fn = 4);", -2, -2, -1.5, 2, 2, 1.5);
    expect_box("cylinder(h = 2, d = 3, $fn = 4);", -1.5, -1.5, 0, 1.5, 1.5, 2);
    expect_box("cylinder(h = 2, r = 3, d2 = 2, $fn = 4);", -3, -3, 0, 3, 3, 2);
    expect_box("// a comment\ncube(size = +2e0,); /* another */;", 0, 0, 0, 2, 2, 2);
    expect_box("\xEF\xBB\xBF"
               "cube(2);",
               0, 0, 0, 2, 2, 2);
    lmn_scene     *s = load_text("sphere(d = 4, $fn = 8);");
    lmn_scene_info info = lmn_scene_info_of(s);
    assert_true(fabs(info.bounds_max[0] - 2 * cos(M_PI / 8)) < 1e-5);
    lmn_scene_destroy(&s);
}

static void polyhedra_are_kept_when_flawed(void **state)
{
    (void)state;
    const char *points = "polyhedron(points = [[0,0,0],[1,0,0],[0,1,0],[0,0,1]], ";
    char        text[256];
    snprintf(text, sizeof text, "%sfaces = [[0,1,2],[0,3,1],[0,2,3],[1,3,2]], convexity = 1);", points);
    expect_box(text, 0, 0, 0, 1, 1, 1);
    snprintf(text, sizeof text, "%striangles = [[0,1,2],[0,3,1],[0,2,3],[1,3,2]]);", points);
    expect_box(text, 0, 0, 0, 1, 1, 1);
    snprintf(text, sizeof text, "%sfaces = [[0,1,2],[0,3,1],[0,2,3]]);", points);
    lmn_scene *s = load_text(text);
    assert_int_equal(warnings_of(s, WARNING_BAD_GEOMETRY), 1);
    assert_int_equal(s->part_count, 1);
    lmn_scene_destroy(&s);
    static const char *const wrong[] = {"[[0,1,4]]", "[[0,1,-1]]", "[0,1,2]", "[[0,1,\"a\"]]", "7", "undef"};
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++) {
        snprintf(text, sizeof text, "%sfaces = %s);cube();", points, wrong[i]);
        s = load_text(text);
        assert_int_equal(warnings_of(s, WARNING_BAD_VALUE), 1);
        CHECK_BOX(s, 0, 0, 0, 1, 1, 1);
        lmn_scene_destroy(&s);
    }
}

/* --- the tree ------------------------------------------------------------------------------------------- */

static void operations_become_a_tree(void **state)
{
    (void)state;
    lmn_scene *s = load_text(
        "group() {\n difference() {\n  group() { cube(size = 2); }\n  union() { cylinder(); sphere(); }\n }\n}\n"
        "intersection() {\n cube(size = 2);\n cube(size = 3);\n}\n");
    const solid *tree = only_solid(s);
    assert_string_equal(s->parts[0].name, "model");
    assert_int_equal(tree->nodes[0].kind, SOLID_UNION);
    const solid_node *difference = &tree->nodes[tree->nodes[0].first_child];
    assert_int_equal(difference->kind, SOLID_DIFFERENCE);
    assert_int_equal(difference->line, 2);
    assert_string_equal(difference->name, "difference");
    const solid_node *cube = &tree->nodes[difference->first_child];
    assert_int_equal(cube->kind, SOLID_OPERAND); /* its group had it alone */
    assert_string_equal(cube->name, "cube");
    assert_int_equal(cube->line, 3);
    const solid_node *both = &tree->nodes[cube->next_sibling];
    assert_int_equal(both->kind, SOLID_UNION);
    assert_string_equal(both->name, "union");
    const solid_node *intersection = &tree->nodes[difference->next_sibling];
    assert_int_equal(intersection->kind, SOLID_INTERSECTION);
    assert_int_equal(tree->nodes[intersection->first_child].mesh, cube->mesh); /* the same cube */
    assert_int_equal(s->mesh_count, 4);
    const primitive *p = &s->meshes[cube->mesh].primitives[0];
    assert_null(p->normals);
    assert_int_equal(p->material, NONE);
    assert_int_equal(s->up, 'z');
    lmn_scene_destroy(&s);
}

static void equal_leaves_share_a_mesh(void **state)
{
    (void)state;
    lmn_scene *s = load_text(
        "cube(size = 2);\nmultmatrix([[1,0,0,5],[0,1,0,0],[0,0,1,0],[0,0,0,1]]) {cube( size = 2 );}\n"
        "cube(size = 2, center = true);cube(size = 2.5);"
        "hull() {cube(size = 1); cylinder(h = 3, $fn = 5);} hull() {\n cube(size = 1);\n cylinder(h = 3, $fn = 5);\n}");
    const solid   *tree = only_solid(s);
    solid_operand *operands;
    size_t         count;
    assert_true(solid_operands(tree, &operands, &count));
    assert_int_equal(count, 6);
    assert_int_equal(s->mesh_count, 4);
    assert_int_equal(operands[0].mesh, operands[1].mesh);
    assert_int_equal(operands[4].mesh, operands[5].mesh);
    mem_free(operands);
    lmn_scene_destroy(&s);
}

static void empty_operands_count_as_openscad_says(void **state)
{
    (void)state;
    static const struct {
        const char *text;
        size_t      parts;
    } cases[] = {
        {"intersection() {cube(); group();}", 0},
        {"intersection() {cube(); cube(size = 0);}", 0},
        {"difference() {group(); cube();}", 0},
        {"difference() {cube(); group();}", 1},
        {"union() {group(); cube();}", 1},
        {"intersection() {cube(); %group();}", 1},
        {"intersection() {cube(); roof();}", 1},
        {"difference() {cube(); square(size = 2);}", 1},
        {"intersection() {cube(); square(size = 2);}", 0},
        {"group();", 0},
        {"linear_extrude(height = 2) {group();}", 0},
        {"hull() {group();}", 0},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        lmn_scene *s = load_text(cases[i].text);
        if (s->part_count != cases[i].parts)
            print_error("%s: %zu parts\n", cases[i].text, s->part_count);
        assert_int_equal(s->part_count, cases[i].parts);
        lmn_scene_destroy(&s);
    }
}

static void matrices_place_and_mirror(void **state)
{
    (void)state;
    expect_box("multmatrix([[2,0,0,1],[0,1,0,0],[0,0,1,0],[0,0,0,1]]) {cube();}", 1, 0, 0, 3, 1, 1);
    expect_box("multmatrix([[-1,0,0,0],[0,1,0,0],[0,0,1,0],[0,0,0,1]]) {cube(); cube(size = 2);}", -2, 0, 0, 0, 2, 2);
    expect_box("multmatrix([[1,0,0,5],[0,1,0,0],[0,0,1,0],[0,0,0,1]]) "
               "{multmatrix([[0,-1,0,0],[1,0,0,0],[0,0,1,0],[0,0,0,1]]) {cube(size = [1, 2, 3]);}}",
               3, 0, 0, 5, 1, 3);
    expect_box("multmatrix([[1,0,0,2],[0,1,0,0],[0,0,1,0],[0,0,0,2]]) {cube();}", 1, 0, 0, 1.5, 0.5, 0.5);
    static const char *const wrong[] = {
        "[[1,0,0,0],[0,1,0,0],[0,0,0,0],[0,0,0,1]]",   "[[1,0,0,nan],[0,1,0,0],[0,0,1,0],[0,0,0,1]]",
        "[[1,0,0,inf],[0,1,0,0],[0,0,1,0],[0,0,0,1]]", "[[1e30,0,0,0],[0,1,0,0],[0,0,1,0],[0,0,0,1]]",
        "[[1,0,0,0],[0,1,0,0],[0,0,1,0],[1,0,0,1]]",   "3"};
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++) {
        char text[256];
        snprintf(text, sizeof text, "cube();multmatrix(%s){cube(size = 2);}", wrong[i]);
        lmn_scene *s = load_text(text);
        assert_int_equal(warnings_of(s, WARNING_BAD_VALUE), 1);
        CHECK_BOX(s, 0, 0, 0, 1, 1, 1);
        lmn_scene_destroy(&s);
    }
}

static void the_outermost_colour_decides(void **state)
{
    (void)state;
    lmn_scene     *s = load_text("color([1, 0.5, 0, 0.25]) {group() {cube(); color(\"blue\") {cylinder();}}}\n"
                                     "color(\"lime\", alpha = 0.5) {cube();}\ncolor([-1, -1, -1, 1]) {cube();}\n"
                                     "color(\"red\") {color(\"blue\") {cube();}}");
    solid_operand *o;
    size_t         count;
    assert_true(solid_operands(only_solid(s), &o, &count));
    assert_int_equal(count, 5);
    for (int i = 0; i < 2; i++) {
        assert_true(o[i].has_colour);
        assert_float_equal(o[i].colour.x, 1, 1e-6);
        assert_float_equal(o[i].colour.y, 0.2140411f, 1e-5);
        assert_float_equal(o[i].colour.w, 0.25, 1e-6);
    }
    assert_true(o[2].colour.y == 1 && o[2].colour.x == 0 && o[2].colour.w == 0.5f);
    assert_false(o[3].has_colour);
    assert_true(o[4].colour.x == 1 && o[4].colour.z == 0);
    mem_free(o);
    lmn_scene_destroy(&s);
}

static void modifiers_choose(void **state)
{
    (void)state;
    lmn_scene *s = load_text(
        "cube();\n%cube(size = 5);\n*cube(size = 6);\n#cube(size = 2);\n% group() {cube(size = 9); nosuch();}");
    CHECK_BOX(s, 0, 0, 0, 2, 2, 2);
    assert_int_equal(warnings_of(s, WARNING_BACKGROUND), 2);
    assert_int_equal(s->warnings.count, 2);
    assert_non_null(strstr(s->warnings.items[0].text, "model.csg, line 2: cube()"));
    lmn_scene_destroy(&s);
    expect_box("cube(size = 9); group() {multmatrix([[1,0,0,5],[0,1,0,0],[0,0,1,0],[0,0,0,1]]) {!cube();}}", 0, 0, 0, 1,
               1, 1);
    s = load_text("roof(method = \"voronoi\") {\n square();\n}\ncube();\nnosuch(a = [1, \"x\"]);");
    assert_int_equal(warnings_of(s, WARNING_IGNORED), 2);
    assert_non_null(strstr(s->warnings.items[1].text, "line 5: nosuch()"));
    lmn_scene_destroy(&s);
}

static void bad_numbers_leave_their_object_out(void **state)
{
    (void)state;
    static const char *const wrong[] = {"cube(size = [nan, 1, 1]);", "sphere(r = inf);",   "cylinder(h = -inf);",
                                        "cube(size = 1e30);",        "sphere(r = 1e308);", "cube(size = 1e999);"};
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++) {
        char text[256];
        snprintf(text, sizeof text, "cube();\n%s", wrong[i]);
        lmn_scene *s = load_text(text);
        if (warnings_of(s, WARNING_BAD_VALUE) != 1)
            print_error("%s\n", wrong[i]);
        assert_int_equal(warnings_of(s, WARNING_BAD_VALUE), 1);
        assert_non_null(strstr(s->warnings.items[0].text, "line 2"));
        CHECK_BOX(s, 0, 0, 0, 1, 1, 1);
        lmn_scene_destroy(&s);
    }
    expect_box("cube(); cube(size = [-1, 2, 3]); sphere(r = 0); cylinder(h = 0);", 0, 0, 0, 1, 1, 1);
    lmn_error error;
    assert_int_equal(status_of("cube();\nsphere(r = 1, $fn = 1e9);", &error), LMN_LIMIT);
    assert_int_equal(error.line, 2);
}

static void too_many_operands_are_a_limit(void **state)
{
    (void)state;
    size_t count = SOLID_OPERANDS_MAX + 1, size = 0;
    char  *text = mem_alloc(count * 8 + 1);
    for (size_t i = 0; i < count; i++, size += 7)
        memcpy(text + size, "cube();", 8);
    lmn_error error;
    assert_int_equal(load_status(temp_file("many.csg", text, size), &error), LMN_LIMIT);
    assert_int_equal(load_status(temp_file("many.csg", text, size - 7), &error), LMN_OK);
    mem_free(text);
}

/* --- programs ------------------------------------------------------------------------------------------- */

static bool has_openscad(void)
{
    return system("command -v openscad > /dev/null 2>&1") == 0;
}

static bool stop_at_openscad(double fraction, const char *stage, void *user)
{
    (void)fraction;
    (void)user;
    return strcmp(stage, "openscad") != 0;
}

static void programs_are_evaluated_by_openscad(void **state)
{
    (void)state;
    if (!has_openscad()) {
        printf("skipped: no openscad on the PATH\n");
        skip();
    }
    const char *text = "n = 3;\nfor (i = [0 : n - 1]) translate([2 * i, 0, 0]) cube(1);\n";
    lmn_scene  *s = load_or_fail(temp_file("-row.scad", text, strlen(text)));
    CHECK_BOX(s, 0, 0, 0, 5, 1, 1);
    assert_string_equal(s->parts[0].name, "-row");
    lmn_scene_destroy(&s);
    lmn_error error;
    text = "cube(1);\nsphere(\n";
    assert_int_equal(load_status(temp_file("wrong.scad", text, strlen(text)), &error), LMN_FORMAT);
    assert_non_null(strstr(error.message, "syntax error"));
    assert_true(error.line > 1);
    text = "cube(1); x = nosuch(3);\n";
    s = load_or_fail(temp_file("warned.scad", text, strlen(text)));
    assert_true(s->warnings.count > 0);
    lmn_scene_destroy(&s);
    assert_int_equal(lmn_scene_create(&s, NULL), LMN_OK);
    lmn_load_desc desc = LMN_LOAD_DESC_INIT;
    desc.progress = stop_at_openscad;
    text = "function f(n) = n < 2 ? 1 : f(n - 1) + f(n - 2); cube(f(60));\n"; /* takes for ever */
    assert_int_equal(lmn_scene_add_file(s, temp_file("slow.scad", text, strlen(text)), &desc, &error), LMN_CANCELLED);
    lmn_scene_destroy(&s);
}

static lmn_status load_program(const char *name, const char *text, const char *const *defines, size_t count,
                               bool strict, lmn_scene **out, lmn_error *error)
{
    lmn_load_desc desc = LMN_LOAD_DESC_INIT;
    desc.defines = defines;
    desc.define_count = count;
    desc.strict = strict;
    assert_int_equal(lmn_scene_create(out, NULL), LMN_OK);
    lmn_status status = lmn_scene_add_file(*out, temp_file(name, text, strlen(text)), &desc, error);
    if (status != LMN_OK)
        lmn_scene_destroy(out);
    return status;
}

static void what_programs_complain_of_is_passed_on(void **state)
{
    (void)state;
    if (!has_openscad())
        skip();
    lmn_error   error;
    lmn_scene  *s;
    const char *text = "cube(1);\nassert(1 > 5, \"too small in file x.scad, line 9\");\ncube(2);\n";
    assert_int_equal(load_program("asserted.scad", text, NULL, 0, false, &s, &error), LMN_FORMAT);
    assert_non_null(strstr(error.message, "too small"));
    assert_int_equal(error.line, 2);
    const char *warned[] = {"cube(1);\nnosuch(3);\n", "cube(1);\ncube(nosuch);\n", "cube(1);\ncube(nosuch(3));\n"};
    for (size_t i = 0; i < 3; i++) {
        assert_int_equal(load_program("warned.scad", warned[i], NULL, 0, false, &s, &error), LMN_OK);
        assert_int_equal(s->warnings.count, 1);
        lmn_scene_destroy(&s);
        assert_int_equal(load_program("warned.scad", warned[i], NULL, 0, true, &s, &error), LMN_FORMAT);
        assert_non_null(strstr(error.message, "nosuch"));
        assert_int_equal(error.line, 2);
    }
    assert_int_equal(load_program("good.scad", "cube(1);", NULL, 0, true, &s, &error), LMN_OK);
    lmn_scene_destroy(&s);
}

static void programs_take_definitions(void **state)
{
    (void)state;
    if (!has_openscad())
        skip();
    lmn_error         error;
    lmn_scene        *s;
    const char       *text = "n = 2; name = \"a\"; cube(name == \"it's; b\" ? n : 1);\n";
    const char *const good[] = {"n=5", "name=\"it's; b\""};
    assert_int_equal(load_program("defined.scad", text, good, 2, true, &s, &error), LMN_OK);
    CHECK_BOX(s, 0, 0, 0, 5, 5, 5);
    assert_int_equal(s->warnings.count, 0);
    lmn_scene_destroy(&s);
    const char *const other[] = {"m=5"};
    assert_int_equal(load_program("defined.scad", text, other, 1, false, &s, &error), LMN_OK);
    assert_int_equal(s->warnings.count, 1); /* nothing of the program is called so */
    lmn_scene_destroy(&s);
    static const char *const wrong[] = {"n", "=5", "n=", "5=n", "n m=5", "-o=x", "cube(9);n=1", "", "$=3"};
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++) {
        assert_int_equal(load_program("defined.scad", text, &wrong[i], 1, false, &s, &error), LMN_USAGE);
        assert_non_null(strstr(error.message, "NAME=VALUE"));
    }
    assert_int_equal(load_program("plain.csg", "cube(size = 1);", good, 1, false, &s, &error), LMN_USAGE);
    assert_non_null(strstr(error.file, "plain.csg"));
    assert_int_equal(load_program("plain.csg", "cube(size = 1);", NULL, 0, true, &s, &error), LMN_USAGE);
}

/* What openscad writes lies in a folder that nothing is left of. */
static void programs_leave_nothing(void **state)
{
    (void)state;
    char here[] = "/tmp/limner-test-XXXXXX", left[64];
    if (!has_openscad())
        skip();
    assert_non_null(mkdtemp(here));
    char *before = mem_copy_text(getenv("TMPDIR"));
    setenv("TMPDIR", here, 1);
    lmn_error  error;
    lmn_scene *s;
    assert_int_equal(load_program("good.scad", "cube(1);", NULL, 0, false, &s, &error), LMN_OK);
    lmn_scene_destroy(&s);
    assert_int_equal(load_program("wrong.scad", "cube(1;", NULL, 0, false, &s, &error), LMN_FORMAT);
    setenv("TMPDIR", "/nosuch-folder", 1);
    assert_int_equal(load_program("good.scad", "cube(1);", NULL, 0, false, &s, &error), LMN_WRITE);
    snprintf(left, sizeof left, "%s", here);
    assert_int_equal(rmdir(left), 0);
    if (before)
        setenv("TMPDIR", before, 1);
    else
        unsetenv("TMPDIR");
    mem_free(before);
}

static void programs_need_openscad(void **state)
{
    (void)state;
    char *path = mem_copy_text(getenv("PATH"));
    setenv("PATH", "/nowhere::relative", 1);
    lmn_error  error;
    lmn_status status = load_status(temp_file("cube.scad", "cube();", 7), &error);
    setenv("PATH", path, 1);
    mem_free(path);
    assert_int_equal(status, LMN_UNSUPPORTED);
    assert_non_null(strstr(error.hint, "openscad -o"));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(errors_tell_line_and_column),
        cmocka_unit_test(nesting_has_a_limit),
        cmocka_unit_test(every_cut_is_an_error_or_a_model),
        cmocka_unit_test(memory_that_runs_out_is_an_error),
        cmocka_unit_test(defaults_and_positions),
        cmocka_unit_test(polyhedra_are_kept_when_flawed),
        cmocka_unit_test(operations_become_a_tree),
        cmocka_unit_test(equal_leaves_share_a_mesh),
        cmocka_unit_test(empty_operands_count_as_openscad_says),
        cmocka_unit_test(matrices_place_and_mirror),
        cmocka_unit_test(the_outermost_colour_decides),
        cmocka_unit_test(modifiers_choose),
        cmocka_unit_test(bad_numbers_leave_their_object_out),
        cmocka_unit_test(too_many_operands_are_a_limit),
        cmocka_unit_test(programs_are_evaluated_by_openscad),
        cmocka_unit_test(what_programs_complain_of_is_passed_on),
        cmocka_unit_test(programs_take_definitions),
        cmocka_unit_test(programs_leave_nothing),
        cmocka_unit_test(programs_need_openscad),
    };
    return cmocka_run_group_tests(tests, NULL, remove_temp_folder);
}
