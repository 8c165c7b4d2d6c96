/* OpenSCAD's evaluated files: figures in the plane and what is made from them, hulls, sums, cuts, files beside the
 * model; and the collection of real files against OpenSCAD's own results. */
#include "csg_support.h"

#include <dirent.h>
#include <sys/stat.h>

#include <jansson.h>

#include "construct/construct.h"
#include "small_input.h"

/* Volume of all operands, mirrored ones counted as they are. */
static double operand_volume(const lmn_scene *s)
{
    solid_operand *o;
    size_t         count;
    double         volume = 0;
    assert_true(solid_operands(&s->solids[0], &o, &count));
    for (size_t i = 0; i < count; i++) {
        const primitive *p = &s->meshes[o[i].mesh].primitives[0];
        for (uint32_t k = 0; k < p->index_count; k += 3) {
            vec3 a = mat4_transform_point(&o[i].matrix, p->positions[p->indices[k]]);
            vec3 b = mat4_transform_point(&o[i].matrix, p->positions[p->indices[k + 1]]);
            vec3 c = mat4_transform_point(&o[i].matrix, p->positions[p->indices[k + 2]]);
            volume += (double)(a.x * (b.y * c.z - b.z * c.y) + a.y * (b.z * c.x - b.x * c.z) +
                               a.z * (b.x * c.y - b.y * c.x)) /
                      6;
        }
    }
    mem_free(o);
    return volume;
}

static void expect_volume(const char *text, double expected)
{
    lmn_scene *s = load_text(text);
    for (size_t i = 0; i < s->warnings.count; i++)
        print_error("%s: %s\n", text, s->warnings.items[i].text);
    assert_int_equal(s->warnings.count, 0);
    double volume = operand_volume(s);
    if (fabs(volume - expected) > 1e-4 * fabs(expected))
        print_error("%s: volume %.9g, expected %.9g\n", text, volume, expected);
    assert_true(fabs(volume - expected) <= 1e-4 * fabs(expected));
    lmn_scene_destroy(&s);
}

/* --- extrusions and figures ----------------------------------------------------------------------------- */

/* In a prism of height 1 the volume is the figure's area. */
static void expect_area(const char *figures, double expected)
{
    char text[1024];
    snprintf(text, sizeof text, "linear_extrude(height = 1) {%s}", figures);
    expect_volume(text, expected);
}

static void figures_have_their_areas(void **state)
{
    (void)state;
    expect_area("square();", 1);
    expect_area("square([2, 3], true);", 6);
    expect_area("circle(2, $fn = 4);", 8);
    expect_area("circle(d = 4, $fn = 4);", 8);
    expect_area("polygon(points = [[0,0],[4,0],[0,3]], paths = undef, convexity = 1);", 6);
    expect_area("polygon([[0,0],[4,0],[4,4],[0,4],[1,1],[2,1],[2,2],[1,2]], [[0,1,2,3],[4,5,6,7]]);", 15);
    expect_area("polygon([[0,0],[4,0],[4,4],[0,4],[9,9]], [0,1,2,3]);", 16);
    expect_area("difference() {square(size = 4); square(size = 1); "
                "multmatrix([[1,0,0,2],[0,1,0,2],[0,0,1,0],[0,0,0,1]]) {square();}}",
                14);
    expect_area("intersection() {square(size = 4); square(size = [2, 9]);}", 8);
    expect_area("union() {square(size = 4); square(size = [2, 9]);} group() {color([1,0,0,1]) {square();}}", 26);
    expect_area("multmatrix([[-2,0,0,0],[0,1,0,0],[0,0,1,0],[0,0,0,1]]) {square(size = 2);}", 8);
    expect_area("offset(delta = 1) {square(size = 2);}", 16);
    expect_area("offset(delta = 1, chamfer = true) {square(size = 2);}", 16 - 4 * pow(2 - sqrt(2), 2) / 2);
    expect_area("offset(r = -0.5) {square(size = 2);}", 1);
    expect_area("hull() {square(); multmatrix([[1,0,0,2],[0,1,0,2],[0,0,1,0],[0,0,0,1]]) {square();}}", 5);
    expect_area("minkowski() {square(size = 2); square(size = [1, 3]);}", 15);
    expect_area("resize(newsize = [4, 0], auto = [0, 1]) {square(size = [2, 3]);}", 24);
    expect_area("intersection() {square(); group();} square();", 1);
    expect_area("render(convexity = 2) {square();}", 1);
}

static void extrusions_take_their_parameters(void **state)
{
    (void)state;
    expect_box("linear_extrude(height = 4, center = true) {square(size = 2);}", 0, 0, -2, 2, 2, 2);
    expect_box("linear_extrude() {square(size = 2);}", 0, 0, 0, 2, 2, 100);
    expect_box("linear_extrude(height = 4, slices = -1e300) {square(size = 2);}", 0, 0, 0, 2, 2,
               4); /* as if none were said */
    expect_box("linear_extrude(height = 4, scale = [2, 3]) {square(size = 2);}", 0, 0, 0, 4, 6, 4);
    expect_box("linear_extrude(height = 4, scale = 0) {square(size = 2);}", 0, 0, 0, 2, 2, 4);
    expect_box("linear_extrude(height = 4, twist = -90, slices = 3) {square(size = [2, 1]);}", -1, 0, 0, 2,
               sqrt(5) * sin(atan(0.5) + M_PI / 3), 4);
    expect_box("rotate_extrude($fn = 4) {multmatrix([[1,0,0,2],[0,1,0,0],[0,0,1,0],[0,0,0,1]]) {square();}}", -3, -3, 0,
               3, 3, 1);
    expect_box("rotate_extrude(angle = 90, $fn = 4) {square(size = [2, 1]);}", 0, 0, 0, 2, 2, 1);
    expect_box("rotate_extrude(angle = 90, start = 90, $fn = 4) {square(size = [2, 1]);}", -2, 0, 0, 0, 2, 1);
    expect_box("rotate_extrude(angle = 360, start = 180, $fn = 3) {square(size = [2, 1]);}", -2, -sqrt(3), 0, 1,
               sqrt(3), 1);
}

static void figures_alone_are_plates(void **state)
{
    (void)state;
    expect_box("square(size = [2, 3]);", 0, 0, -0.5, 2, 3, 0.5);
    lmn_scene *s =
        load_text("group() {\n color(\"red\") {square(size = 2);}\n "
                  "multmatrix([[1,0,0,5],[0,1,0,0],[0,0,1,0],[0,0,0,1]]) {color(\"blue\") {square(size = 2);}}\n}\n"
                  "difference() {color(\"lime\") {square(size = 9);} square(size = 3);}\ncube(size = 20);");
    CHECK_BOX(s, 0, 0, -0.5, 9, 9, 0.5);
    assert_int_equal(warnings_of(s, WARNING_IGNORED), 1); /* the cube: the first object is flat */
    solid_operand *o;
    size_t         count;
    assert_true(solid_operands(only_solid(s), &o, &count));
    assert_int_equal(count, 3);
    assert_true(o[0].mesh == o[1].mesh && o[0].colour.x == 1 && o[1].colour.z == 1 && o[2].colour.y == 1);
    mem_free(o);
    lmn_scene_destroy(&s);
    /* Colours of solids stay with solids; a flat object among them is left out. */
    s = load_text("cube();\nsquare(size = 9);\nlinear_extrude(height = 2) {cube(size = 7); square();}");
    CHECK_BOX(s, 0, 0, 0, 1, 1, 2);
    assert_int_equal(warnings_of(s, WARNING_IGNORED), 2);
    lmn_scene_destroy(&s);
}

/* --- hulls, sums, cuts, sizes --------------------------------------------------------------------------- */

static void hulls_take_placed_points(void **state)
{
    (void)state;
    expect_volume("hull() {cube(); multmatrix([[1,0,0,3],[0,1,0,0],[0,0,1,0],[0,0,0,1]]) {group() {cube(); cube();}}}",
                  4);
    lmn_scene *s =
        load_text("hull() {\n difference() {cube(size = 2); cube();}\n intersection() {cube(); cube(size = 5);}\n}");
    CHECK_BOX(s, 0, 0, 0, 2, 2, 2);
    assert_int_equal(warnings_of(s, WARNING_APPROXIMATE), 2);
    lmn_scene_destroy(&s);
}

static void sums_of_solids(void **state)
{
    (void)state;
    expect_volume("minkowski() {cube(); cube(size = 2);}", 27);
    expect_volume("minkowski() {cube(); cube(size = 2); group(); cube();}", 64);
    expect_box("minkowski() {group() {cube(); multmatrix([[1,0,0,4],[0,1,0,0],[0,0,1,0],[0,0,0,1]]) {cube();}} "
               "cube(size = 2);}",
               0, 0, 0, 7, 3, 3);
    const char *angle = "linear_extrude(height = 1) {polygon([[0,0],[9,0],[9,1],[1,1],[1,5],[0,5]]);}";
    char        text[512];
    snprintf(text, sizeof text, "minkowski() {%s cube(size = 2, center = true);}", angle);
    expect_box(text, -1, -1, -1, 10, 6, 2);
    snprintf(text, sizeof text, "minkowski() {%s %s}", angle, angle);
    lmn_scene *s = load_text(text);
    assert_int_equal(warnings_of(s, WARNING_APPROXIMATE), 1);
    CHECK_BOX(s, 0, 0, 0, 9, 5, 1);
    lmn_scene_destroy(&s);
    s = load_text("minkowski() {\n difference() {cube(size = 4); cube();}\n sphere();\n}");
    assert_int_equal(warnings_of(s, WARNING_APPROXIMATE), 1);
    assert_non_null(strstr(s->warnings.items[0].text, "line 1"));
    CHECK_BOX(s, 0, 0, 0, 4, 4, 4);
    lmn_scene_destroy(&s);
}

/* --- what openscad computes ------------------------------------------------------------------------------ */

static const char *real_path; /* all other tests run without openscad, whether it is installed or not */

/* Two frames, one in the hole of the other: x and y run from −4 to 4, but for the places where the small one lies in
 * the hole of the large one, |x|, |y| < 0.5; z from −2 to 2. */
static const char two_frames[] =
    "minkowski() {difference() {cube(size = [6,6,2], center = true); cube(size = [3,3,4], center = true);} "
    "difference() {cube(size = 2, center = true); cube(size = [1,1,4], center = true);}}";
static const char cut_hull[] =
    "hull() {difference() {cube(size = [6,6,2], center = true); multmatrix([[1,0,0,3],[0,1,0,0],"
    "[0,0,1,0],[0,0,0,1]]) {cube(size = [6,20,4], center = true);}}}";
static const char bored_shadow[] =
    "linear_extrude(height = 1) {projection(cut = false) {multmatrix([[1,0,0,2],[0,1,0,0],[0,0,1,"
    "9],[0,0,0,1]]) {difference() {sphere(r = 5, $fn = 40); cylinder(h = 20, r = 2, center = "
    "true, $fn = 40);}}}}";

/* A folder with a program that is called openscad. */
static const char *program_folder(const char *script)
{
    static char folder[300];
    char        path[320];
    snprintf(folder, sizeof folder, "%s", temp_file("openscad", script, strlen(script)));
    snprintf(path, sizeof path, "%s", folder);
    assert_int_equal(chmod(path, 0755), 0);
    *strrchr(folder, '/') = '\0';
    return folder;
}

static void openscad_computes_what_trees_cannot(void **state)
{
    (void)state;
    const double pi = 3.14159265358979323846, ring = 5 * sin(85.5 * pi / 180);
    setenv("PATH", real_path, 1);
    setenv("LIMNER_CACHE", "", 1);
    if (system("command -v openscad > /dev/null 2>&1") == 0) {
        expect_volume(two_frames, (64 - 1) * 4);
        expect_box(two_frames, -4, -4, -2, 4, 4, 2);
        expect_volume(cut_hull, 36);
        expect_volume(bored_shadow, 20 * sin(9 * pi / 180) * (ring * ring - 4));
    } else {
        printf("skipped: no openscad on the PATH\n");
    }
    setenv("PATH", "/nowhere", 1);
}

static void expect_plain_words(const char *text, const char *words)
{
    lmn_scene *s = load_text(text);
    assert_int_equal(warnings_of(s, WARNING_APPROXIMATE), 1);
    if (!strstr(s->warnings.items[0].text, words))
        print_error("%s\n", s->warnings.items[0].text);
    assert_non_null(strstr(s->warnings.items[0].text, words));
    lmn_scene_destroy(&s);
}

static const char not_there[] = "openscad, which is not on the PATH";

static void without_openscad_that_is_said(void **state)
{
    (void)state;
    expect_plain_words(two_frames, not_there);
    expect_plain_words(cut_hull, not_there);
    expect_plain_words(bored_shadow, not_there);
    setenv("PATH", program_folder("#!/bin/sh\nexit 1\n"), 1);
    expect_plain_words(two_frames, "openscad failed");
    setenv("PATH", program_folder("#!/bin/sh\necho 'OFF 4 1 0 0 0 0 1 0 0 0 1 0 0 0 1 3 0 1 7' > $2\n"), 1);
    expect_plain_words(two_frames, "openscad failed");
    /* It leaves out what it cannot work with, and ends as if all were well. */
    setenv("PATH",
           program_folder("#!/bin/sh\necho 'ERROR: CGAL error' >&2\necho 'Current top level object is empty.' >&2\n"),
           1);
    expect_plain_words(bored_shadow, "openscad failed");
    setenv("PATH", "/nowhere", 1);
}

/* It is asked once: what it answers is kept by what it was asked. A program that knows one solid stands for it. */
static void answers_are_kept(void **state)
{
    (void)state;
    static const char tetrahedron[] = "#!/bin/sh\nprintf 'OFF 4 4 0\\n\\n0 0 0\\n6 0 0\\n0 1 0\\n0 0 1\\n3 0 2 1\\n3 0 "
                                      "1 3\\n3 0 3 2\\n3 1 2 3\\n' > $2\n";
    char              folder[300];
    snprintf(folder, sizeof folder, "%s", program_folder(tetrahedron));
    setenv("LIMNER_CACHE", folder, 1);
    setenv("PATH", folder, 1);
    expect_volume(two_frames, 1);
    setenv("PATH", "/nowhere", 1);
    expect_volume(two_frames, 1);
    expect_plain_words(cut_hull, not_there); /* another question */
    setenv("LIMNER_CACHE", "", 1);
    expect_plain_words(two_frames, not_there);
}

/* Where files are the caller's, no program is run. */
static void safe_reading_runs_nothing(void **state)
{
    (void)state;
    static const char cube[] =
        "#!/bin/sh\nprintf 'OFF 4 4 0\\n0 0 0\\n6 0 0\\n0 1 0\\n0 0 1\\n3 0 2 1\\n3 0 1 3\\n3 0 3 2\\n3 1 2 "
        "3\\n' > $2\n";
    lmn_task_desc conditions = lmn_task_desc_standard();
    lmn_task     *task;
    lmn_error     error;
    setenv("PATH", program_folder(cube), 1);
    conditions.files = LMN_FILES_FOLDER;
    assert_int_equal(lmn_task_begin(&task, &conditions, &error), LMN_OK);
    expect_plain_words(two_frames, "--safe runs no programs");
    lmn_task_end(&task);
    setenv("PATH", "/nowhere", 1);
}

static bool stop_at_openscad(double fraction, const char *stage, void *user)
{
    (void)fraction;
    (void)user;
    return strcmp(stage, "openscad") != 0;
}

static void openscad_can_be_cancelled(void **state)
{
    (void)state;
    lmn_scene    *s;
    lmn_error     error;
    lmn_load_desc desc = LMN_LOAD_DESC_INIT;
    desc.progress = stop_at_openscad;
    setenv("PATH", program_folder("#!/bin/sh\nexec /bin/sleep 30\n"), 1);
    assert_int_equal(lmn_scene_create(&s, &error), LMN_OK);
    const char *path = temp_file("frames.csg", two_frames, strlen(two_frames));
    assert_int_equal(lmn_scene_add_file(s, path, &desc, &error), LMN_CANCELLED);
    assert_int_equal(lmn_scene_info_of(s).parts, 0);
    lmn_scene_destroy(&s);
    setenv("PATH", "/nowhere", 1);
}

static void cuts_follow_the_tree(void **state)
{
    (void)state;
    expect_area("projection(cut = true) {cube(size = [2, 3, 4], center = true);}", 6);
    expect_area(
        "projection(cut = true) {difference() {cube(size = 4, center = true); cube(size = [2, 2, 9], center = true);}}",
        12);
    expect_area("projection(cut = true) {intersection() {cube(size = 4, center = true); "
                "multmatrix([[1,0,0,1],[0,1,0,0],[0,0,1,0],[0,0,0,1]]) {cube(size = 4, center = true);}}}",
                12);
    expect_area("projection() {cube(size = [2, 3, 4]); multmatrix([[1,0,0,0],[0,1,0,0],[0,0,1,9],[0,0,0,1]]) "
                "{cube(size = [3, 2, 1]);}}",
                8);
    lmn_scene *s = load_text("linear_extrude(height = 1) {projection(cut = false) {difference() {cube(size = 4); "
                             "multmatrix([[1,0,0,1],[0,1,0,1],[0,0,1,1],[0,0,0,1]]) {cube(size = 2);}"
                             "multmatrix([[1,0,0,3.5],[0,1,0,-1],[0,0,1,-1],[0,0,0,1]]) {cube(size = 9);}}}}");
    assert_int_equal(warnings_of(s, WARNING_APPROXIMATE), 1);
    assert_true(fabs(operand_volume(s) - 14) < 1e-3); /* the hollow is not seen, the part cut off is */
    lmn_scene_destroy(&s);
}

static void sizes_are_set(void **state)
{
    (void)state;
    expect_box("resize(newsize = [10, 0, 20], auto = [0, 1, 0]) {cube(size = [2, 3, 4]);}", 0, 0, 0, 10, 15, 20);
    expect_box("resize(newsize = [10, 0, 0], auto = [1, 1, 1]) {cube(size = [2, 3, 4]);}", 0, 0, 0, 10, 15, 20);
    expect_box("resize(newsize = [10, 0, 0], auto = true) {cube(size = [2, 3, 4]);}", 0, 0, 0, 10, 15, 20);
    expect_box("resize(newsize = [10, 0, 0]) {group() {cube(size = 2); "
               "multmatrix([[1,0,0,3],[0,1,0,0],[0,0,1,0],[0,0,0,1]]) {cube(size = 2);}}}",
               0, 0, 0, 10, 2, 2);
}

/* --- texts ---------------------------------------------------------------------------------------------- */

static void texts_may_hold_anything(void **state)
{
    (void)state;
    static const char *const fine[] = {
        "text(text = \"one \\\"two\\\" three\", size = 10, valign = \"default\");",
        "text(text = \"raw \"quotes\" \\c stay\n\there\", size = 10);",
        "text(text = \"\", size = 10);",
        "text(text = \"\\x41\\u00e9\\U01F600\\xzz\\uD800\");",
        "text(text = \"\xFF\xFE\");",
    };
    for (size_t i = 0; i < sizeof fine / sizeof *fine; i++) {
        lmn_scene *s = load_text(fine[i]);
        lmn_scene_destroy(&s);
    }
}

/* --- files beside the model ----------------------------------------------------------------------------- */

static const char *const drawing =
    "0\nSECTION\n2\nBLOCKS\n0\nBLOCK\n2\nunit\n0\nLINE\n8\n0\n10\n0\n20\n0\n11\n1\n21\n0\n0\nLINE\n8\n0\n10\n1\n20\n0\n"
    "11\n0\n21\n1\n"
    "0\nLINE\n8\n0\n10\n0\n20\n1\n11\n0\n21\n0\n0\nENDBLK\n0\nENDSEC\n0\nSECTION\n2\nENTITIES\n"
    "0\nLWPOLYLINE\n8\nplate\n70\n1\n10\n0\n20\n0\n10\n4\n20\n0\n10\n4\n20\n4\n10\n0\n20\n4\n"
    "0\nCIRCLE\n8\nplate\n10\n2\n20\n2\n40\n1\n"
    "0\nPOLYLINE\n8\nold\n70\n1\n10\n7\n20\n7\n0\nVERTEX\n8\nold\n10\n0\n20\n0\n0\nVERTEX\n8\nold\n10\n3\n20\n0\n0\nVER"
    "TEX\n8\nold\n10\n0\n20\n4\n0\nSEQEND\n"
    "0\nLINE\n8\nopen\n10\n0\n20\n0\n11\n5\n21\n0\n0\nLINE\n8\nopen\n10\n5.0001\n20\n0\n11\n5\n21\n2\n"
    "0\nARC\n8\narc\n10\n0\n20\n0\n40\n2\n50\n270\n51\n90\n0\nLINE\n8\narc\n10\n0\n20\n2\n11\n0\n21\n-2\n"
    "0\nINSERT\n8\nput\n2\nunit\n10\n5\n20\n5\n41\n2\n42\n3\n50\n90\n0\nINSERT\n8\nput\n2\nnosuch\n"
    "0\nELLIPSE\n8\noval\n10\n0\n20\n0\n11\n4\n21\n0\n40\n0.5\n41\n0\n42\n6.283185307\n0\nENDSEC\n0\nEOF\n";

static void drawings_are_joined_into_paths(void **state)
{
    (void)state;
    temp_file("drawing.dxf", drawing, strlen(drawing));
    expect_area("import(file = \"drawing.dxf\", layer = \"plate\", $fn = 4);", 14);
    expect_area("import(file = \"drawing.dxf\", layer = \"plate\", $fn = 4, scale = 2, origin = [1, 1]);", 56);
    expect_area("import(file = \"drawing.dxf\", layer = \"old\");", 6);
    expect_area("import(file = \"drawing.dxf\", layer = \"open\");", 5);
    expect_area("import(file = \"drawing.dxf\", layer = \"arc\", $fn = 4);", 4);
    expect_area("import(file = \"drawing.dxf\", layer = \"put\");", 3);
    expect_area("import(file = \"drawing.dxf\", layer = \"oval\", $fn = 4);", 16);
    expect_box("linear_extrude(height = 1) {import(file = \"drawing.dxf\", layer = \"put\");}", 2, 5, 0, 5, 7, 1);
    expect_box("linear_extrude(file = \"drawing.dxf\", layer = \"old\", height = 2, origin = [1, 0], scale = 1);", -1,
               0, 0, 2, 4, 2);
    lmn_error error;
    for (size_t size = 0; size < strlen(drawing); size += 7) {
        temp_file("cut.dxf", drawing, size);
        const char *text = "import(file = \"cut.dxf\"); square();";
        assert_int_equal(load_status(temp_file("cut.csg", text, strlen(text)), &error), LMN_OK);
    }
}

static void missing_files_are_told(void **state)
{
    (void)state;
    static const char *const texts[] = {
        "cube();\nimport(file = \"nosuch.stl\");",
        "cube();\nintersection() {cube(); import(file = \"nosuch.off\");}",
        "cube();\nlinear_extrude(height = 1) {import(file = \"nosuch.dxf\");}",
        "cube();\nsurface(file = \"nosuch.png\");",
        "cube();\nlinear_extrude(height = 1) {import(file = \"nosuch.svg\");}",
        "cube();\nimport(file = \"broken.stl\");",
        "cube();\nlinear_extrude(height = 1) {import(file = \"broken.dxf\");}",
        "cube();\nsurface(file = \"broken.png\");",
        "cube();\nsurface(file = \"broken.stl\");",
    };
    temp_file("broken.stl", "solid cut off\n", 14);
    temp_file("broken.dxf", "0\nSECTION\nnonsense\n", 19);
    temp_file("broken.png", "\x89PNG", 4);
    for (size_t i = 0; i < sizeof texts / sizeof *texts; i++) {
        lmn_scene *s = load_text(texts[i]);
        if (warnings_of(s, WARNING_MISSING_FILE) != 1)
            print_error("%s\n", texts[i]);
        assert_int_equal(warnings_of(s, WARNING_MISSING_FILE), 1);
        assert_non_null(strstr(s->warnings.items[0].text, "model.csg, line 2"));
        CHECK_BOX(s, 0, 0, 0, 1, 1, 1);
        lmn_scene_destroy(&s);
    }
}

static void meshes_and_heights_are_read(void **state)
{
    (void)state;
    const char *tetrahedron =
        "solid\nfacet outer loop\nvertex 0 0 0\nvertex 0 1 0\nvertex 1 0 0\nendloop\nendfacet\n"
        "facet outer loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 0 1\nendloop\nendfacet\n"
        "facet outer loop\nvertex 0 0 0\nvertex 0 0 1\nvertex 0 1 0\nendloop\nendfacet\n"
        "facet outer loop\nvertex 1 0 0\nvertex 0 1 0\nvertex 0 0 1\nendloop\nendfacet\nendsolid\n";
    temp_file("body.stl", tetrahedron, strlen(tetrahedron));
    expect_volume("import(file = \"body.stl\", layer = \"\", origin = [0, 0], scale = 1);", 1.0 / 6);
    const char *off = "OFF\n4 4 6\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 2 1\n3 0 1 3\n3 0 3 2\n3 1 2 3\n";
    temp_file("body.off", off, strlen(off));
    expect_volume("import(\"body.off\");", 1.0 / 6);
    const char *open = strstr(tetrahedron, "endfacet") + 9;
    char        text[1024];
    snprintf(text, sizeof text, "solid\n%s", open);
    temp_file("open.stl", text, strlen(text));
    lmn_scene *s = load_text("import(file = \"open.stl\");");
    assert_int_equal(warnings_of(s, WARNING_BAD_GEOMETRY), 1);
    lmn_scene_destroy(&s);
    temp_file("field.dat", "# heights\n1 2 3\n\n2 3 4\n", 23);
    expect_box("surface(file = \"field.dat\", center = false);", 0, 0, 0, 2, 1, 4);
    expect_box("surface(file = \"field.dat\", center = true);", -1, -0.5, 0, 1, 0.5, 4);
}

/* --- real files ----------------------------------------------------------------------------------------- */

typedef void (*each_file)(const char *path, void *user);

static void walk(const char *folder, each_file use, void *user)
{
    DIR           *d = opendir(folder);
    struct dirent *entry;
    while (d && (entry = readdir(d))) {
        char        path[2048];
        struct stat facts;
        snprintf(path, sizeof path, "%s/%s", folder, entry->d_name);
        if (entry->d_name[0] == '.' || stat(path, &facts) != 0)
            continue;
        if (S_ISDIR(facts.st_mode))
            walk(path, use, user);
        else if (strlen(path) > 4 && strcmp(path + strlen(path) - 4, ".csg") == 0)
            use(path, user);
    }
    if (d)
        closedir(d);
}

/* All leaves of the collection are closed. */
static void load_one(const char *path, void *user)
{
    lmn_scene *s = load_or_fail(path);
    for (size_t i = 0; i < s->mesh_count; i++) {
        const primitive *p = &s->meshes[i].primitives[0];
        uint32_t        *twins = mesh_adjacency(p), open = 0;
        for (uint32_t k = 0; k < p->index_count; k++)
            open += twins[k] == UINT32_MAX;
        if (open > 0)
            print_error("%s: mesh %zu of %u triangles has %u open edges\n", path, i, p->index_count / 3, open);
        assert_int_equal(open, 0);
        mem_free(twins);
    }
    ++*(int *)user;
    lmn_scene_destroy(&s);
}

static void all_real_files_load(void **state)
{
    (void)state;
    char        path[1100];
    const char *folder = data_folder();
    int         count = 0;
    if (!folder)
        skip();
    snprintf(path, sizeof path, "%s/csg", folder);
    walk(path, load_one, &count);
    printf("%d files\n", count);
    assert_true(count >= 116);
}

/* What the tree says a solid can fill holds all that OpenSCAD found; where nothing is taken away or cut out, it is
 * the same. Its numbers have six digits, and shadows that are put together from cuts differ more. */
static void check_reference(const char *name, const lmn_scene *s, const json_t *entry)
{
    lmn_scene_info info = lmn_scene_info_of(s);
    bool           exact = true;
    double         within = has_warning(s, WARNING_APPROXIMATE) ? 0.1 : 5e-4;
    for (size_t i = 0; i < s->solids[0].node_count; i++)
        exact = exact && (s->solids[0].nodes[i].kind == SOLID_UNION || s->solids[0].nodes[i].kind == SOLID_OPERAND);
    for (size_t k = 0; k < 3; k++) {
        double low = json_number_value(json_array_get(json_object_get(entry, "bbox_min"), k)) - info.bounds_min[k];
        double high = info.bounds_max[k] - json_number_value(json_array_get(json_object_get(entry, "bbox_max"), k));
        bool   good = low >= -within && high >= -within && (!exact || (low <= within && high <= within));
        if (!good)
            print_error("%s: axis %zu reaches %g too low and %g too high\n", name, k, low, high);
        assert_true(good);
    }
}

/* --- volumes: vertical lines through the solid, and what of each lies inside ---------------------------- */

enum { LINES = 160 };

typedef struct crossing {
    int32_t line, node;
    double  z;
} crossing;

typedef struct crossings {
    crossing *items;
    size_t    count, capacity;
} crossings;

/* Off the middle, so that no line meets an edge. */
static double line_position(double low, double high, int i)
{
    return low + (high - low) * (i + 0.5137 + 0.1 * sin(i * 12.9898)) / LINES;
}

static void lines_over(double low, double high, double a, double b, double c, int *first, int *last)
{
    double step = (high - low) / LINES;
    *first = (int)fmax(0, floor((fmin(a, fmin(b, c)) - low) / step) - 1);
    *last = (int)fmin(LINES - 1, floor((fmax(a, fmax(b, c)) - low) / step) + 1);
}

static void cross_triangle(crossings *c, const lmn_scene_info *info, int32_t node, const vec3 corner[3])
{
    const double *low = info->bounds_min, *high = info->bounds_max;
    int           first[2], last[2];
    lines_over(low[0], high[0], (double)corner[0].x, (double)corner[1].x, (double)corner[2].x, &first[0], &last[0]);
    lines_over(low[1], high[1], (double)corner[0].y, (double)corner[1].y, (double)corner[2].y, &first[1], &last[1]);
    for (int i = first[0]; i <= last[0]; i++)
        for (int k = first[1]; k <= last[1]; k++) {
            double x = line_position(low[0], high[0], i), y = line_position(low[1], high[1], k), fraction[3], sum = 0,
                   z = 0;
            for (int e = 0; e < 3; e++) {
                vec3 a = corner[(e + 1) % 3], b = corner[(e + 2) % 3];
                fraction[e] =
                    ((double)b.x - (double)a.x) * (y - (double)a.y) - ((double)b.y - (double)a.y) * (x - (double)a.x);
                sum += fraction[e];
                z += fraction[e] * (double)corner[e].z;
            }
            if (!(fraction[0] > 0 && fraction[1] > 0 && fraction[2] > 0) &&
                !(fraction[0] < 0 && fraction[1] < 0 && fraction[2] < 0))
                continue;
            assert_true(mem_grow((void **)&c->items, &c->capacity, c->count + 1, sizeof *c->items));
            c->items[c->count++] = (crossing){i * LINES + k, node, z / sum};
        }
}

static int compare_crossings(const void *a, const void *b)
{
    const crossing *p = a, *q = b;
    return p->line != q->line ? (p->line > q->line) - (p->line < q->line) : (p->z > q->z) - (p->z < q->z);
}

static bool is_inside(const solid *s, bool *in)
{
    for (size_t i = s->node_count; i-- > 0;) {
        const solid_node *n = &s->nodes[i];
        if (n->kind == SOLID_OPERAND)
            continue;
        in[i] = n->first_child != NONE && (n->kind == SOLID_UNION ? false : in[n->first_child]);
        for (int32_t c = n->first_child; c != NONE; c = s->nodes[c].next_sibling)
            in[i] = n->kind == SOLID_UNION          ? in[i] || in[c]
                    : n->kind == SOLID_INTERSECTION ? in[i] && in[c]
                                                    : in[i] && (c == n->first_child || !in[c]);
    }
    return in[0];
}

static double solid_volume(const lmn_scene *s)
{
    const solid   *tree = &s->solids[0];
    lmn_scene_info info = lmn_scene_info_of(s);
    crossings      all = {0};
    solid_operand *o;
    size_t         count;
    double         length = 0;
    bool          *in = mem_calloc(tree->node_count, sizeof *in);
    assert_true(in && solid_operands(tree, &o, &count));
    for (size_t i = 0; i < count; i++) {
        const primitive *p = &s->meshes[o[i].mesh].primitives[0];
        for (uint32_t k = 0; k < p->index_count; k += 3) {
            vec3 corner[3];
            for (uint32_t c = 0; c < 3; c++)
                corner[c] = mat4_transform_point(&o[i].matrix, p->positions[p->indices[k + c]]);
            cross_triangle(&all, &info, o[i].node, corner);
        }
    }
    qsort(all.items, all.count, sizeof *all.items, compare_crossings);
    for (size_t i = 0; i < all.count; i++) {
        if (i > 0 && all.items[i].line != all.items[i - 1].line)
            memset(in, 0, tree->node_count);
        else if (i > 0 && is_inside(tree, in))
            length += all.items[i].z - all.items[i - 1].z;
        in[all.items[i].node] = !in[all.items[i].node];
    }
    mem_free(all.items);
    mem_free(in);
    mem_free(o);
    return length * (info.bounds_max[0] - info.bounds_min[0]) * (info.bounds_max[1] - info.bounds_min[1]) /
           (LINES * LINES);
}

/* Thin walls between few lines are counted coarsely. */
static void check_volume(const char *name, const lmn_scene *s, const json_t *entry)
{
    double expected = json_number_value(json_object_get(entry, "volume")), found = solid_volume(s);
    bool   good = fabs(found - expected) < 0.02 * expected;
    if (!good)
        print_error("%s: volume %g, expected %g\n", name, found, expected);
    assert_true(good);
}

static void results_agree_with_openscad(void **state)
{
    (void)state;
    char        path[2048];
    const char *folder = data_folder(), *name;
    json_t     *entry;
    int         checked = 0, every = small_input() ? 8 : 1, files = 0;
    if (!folder)
        skip();
    snprintf(path, sizeof path, "%s/csg/ref/reference.json", folder);
    json_t *reference = json_load_file(path, 0, NULL);
    assert_non_null(reference);
    json_object_foreach(reference, name, entry)
    {
        if (strcmp(json_string_value(json_object_get(entry, "kind")), "3D") != 0 || files++ % every != 0)
            continue;
        snprintf(path, sizeof path, "%s/csg/%s", folder, name);
        lmn_scene *s = load_or_fail(path);
        assert_int_equal(s->part_count, 1);
        if (!has_warning(s, WARNING_MISSING_FILE)) { /* another font has other bounds */
            check_reference(name, s, entry);
            check_volume(name, s, entry);
            checked++;
        }
        lmn_scene_destroy(&s);
    }
    json_decref(reference);
    printf("%d files\n", checked);
    assert_true(checked >= 40 / every);
}

static int tidy(void **state)
{
    setenv("PATH", real_path, 1);
    return remove_temp_folder(state);
}

int main(void)
{
    real_path = mem_copy_text(getenv("PATH"));
    setenv("PATH", "/nowhere", 1);
    setenv("LIMNER_CACHE", "", 1);
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(figures_have_their_areas),
        cmocka_unit_test(extrusions_take_their_parameters),
        cmocka_unit_test(figures_alone_are_plates),
        cmocka_unit_test(hulls_take_placed_points),
        cmocka_unit_test(sums_of_solids),
        cmocka_unit_test(openscad_computes_what_trees_cannot),
        cmocka_unit_test(without_openscad_that_is_said),
        cmocka_unit_test(answers_are_kept),
        cmocka_unit_test(safe_reading_runs_nothing),
        cmocka_unit_test(openscad_can_be_cancelled),
        cmocka_unit_test(cuts_follow_the_tree),
        cmocka_unit_test(sizes_are_set),
        cmocka_unit_test(texts_may_hold_anything),
        cmocka_unit_test(drawings_are_joined_into_paths),
        cmocka_unit_test(missing_files_are_told),
        cmocka_unit_test(meshes_and_heights_are_read),
        cmocka_unit_test(all_real_files_load),
        cmocka_unit_test(results_agree_with_openscad),
    };
    return cmocka_run_group_tests(tests, NULL, tidy);
}
