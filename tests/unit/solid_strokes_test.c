/* Lines of solids: what bounds the result of set operations, against lengths that are known, and what hides them. */
#include "stroke_shapes.h"

#include "csg_support.h"
#include "cut/cut.h"
#include "stroke/hatch.h"
#include "stroke/solid.h"
#include "stroke/stroke_private.h"

typedef struct lengths {
    double crease, candidate, border, material, hollow;
} lengths;

static stroke_scene scene_of(lmn_scene *s)
{
    pose         at_rest;
    stroke_scene out;
    lmn_error    error = {0};
    assert_int_equal(pose_create(&at_rest, s, &(moment){.seconds = 0}, &error), LMN_OK);
    assert_int_equal(stroke_scene_create(&out, &at_rest, NULL, 0.5, NULL, NULL, &error), LMN_OK);
    pose_release(&at_rest);
    return out;
}

static lengths measure(const edge_mesh *m)
{
    lengths out = {0, 0, 0, 0, 0};
    for (uint32_t i = 0; i < m->edge_count; i++) {
        vec3     p = m->positions[m->edges[i].vertex[0]], q = m->positions[m->edges[i].vertex[1]];
        double   length = sqrt(pow((double)q.x - (double)p.x, 2) + pow((double)q.y - (double)p.y, 2) +
                               pow((double)q.z - (double)p.z, 2));
        uint32_t flags = m->edges[i].flags;
        out.crease += flags & EDGE_CREASE ? length : 0;
        out.candidate += flags & EDGE_CANDIDATE && !(flags & EDGE_HOLLOW) ? length : 0;
        out.hollow += flags & EDGE_HOLLOW ? length : 0;
        out.border += flags & EDGE_BORDER ? length : 0;
        out.material += flags & EDGE_MATERIAL ? length : 0;
    }
    return out;
}

static void check_lengths(const char *text, double crease, double candidate, double border, double material,
                          double hollow)
{
    lmn_scene   *s = load_text(text);
    stroke_scene scene = scene_of(s);
    assert_int_equal(scene.item_count, 1);
    assert_non_null(scene.meshes[0].solid);
    lengths      got = measure(&scene.meshes[0]);
    const double wanted[5] = {crease, candidate, border, material, hollow},
                 found[5] = {got.crease, got.candidate, got.border, got.material, got.hollow};
    for (int k = 0; k < 5; k++)
        if (fabs(found[k] - wanted[k]) > 1e-3)
            print_error("%s: kind %d: %.6f, expected %.6f\n", text, k, found[k], wanted[k]);
    for (int k = 0; k < 5; k++)
        assert_true(fabs(found[k] - wanted[k]) <= 1e-3);
    stroke_scene_release(&scene);
    lmn_scene_destroy(&s);
}

#define BOX(x, y, z, w, d, h)                                                                                          \
    "multmatrix([[1,0,0," #x "],[0,1,0," #y "],[0,0,1," #z "],[0,0,0,1]]){cube(size=[" #w "," #d "," #h                \
    "],center=false);}"
#define ROD(x, y, z, r, h)                                                                                             \
    "multmatrix([[1,0,0," #x "],[0,1,0," #y "],[0,0,1," #z "],[0,0,0,1]]){cylinder($fn=24,$fa=12,$fs=2,h=" #h          \
    ",r1=" #r ",r2=" #r ",center=false);}"

/* --- lines ---------------------------------------------------------------------------------------------- */

static void flush_faces_leave_no_lines(void **state)
{
    (void)state;
    check_lengths("union(){" BOX(0, 0, 0, 10, 10, 10) BOX(10, 0, 0, 10, 10, 10) "}", 160, 0, 0, 0, 0);
    check_lengths("union(){" BOX(0, 0, 0, 10, 10, 10) BOX(5, 0, 0, 15, 10, 10) "}", 160, 0, 0, 0, 0);
    check_lengths("union(){" BOX(0, 0, 0, 10, 10, 10) BOX(0, 0, 0, 10, 10, 10) "}", 120, 0, 0, 0, 0);
    check_lengths("intersection(){" BOX(0, 0, 0, 10, 10, 10) BOX(5, 0, 0, 15, 10, 10) "}", 100, 0, 0, 0, 0);
    /* An L of two boxes that are flush on three sides: its outline twice, and six edges between. */
    check_lengths("union(){" BOX(0, 0, 0, 10, 10, 10) BOX(10, 0, 0, 10, 10, 4) "}", 2 * 60 + 6 * 10, 0, 0, 0, 0);
}

static void cuts_leave_rims(void **state)
{
    (void)state;
    check_lengths("difference(){" BOX(0, 0, 0, 10, 10, 10) BOX(5, 0, 0, 5, 10, 10) "}", 100, 0, 0, 0, 0);
    check_lengths("difference(){" BOX(0, 0, 0, 10, 10, 10) BOX(4, -1, 5, 2, 12, 6) "}", 180, 0, 0, 0, 0);
    /* The same, cut flush at both ends and at the top. */
    check_lengths("difference(){" BOX(0, 0, 0, 10, 10, 10) BOX(4, 0, 5, 2, 10, 5) "}", 180, 0, 0, 0, 0);
    /* Nothing is left, and nothing is taken away. */
    lmn_scene   *s = load_text("difference(){" BOX(0, 0, 0, 1, 1, 1) BOX(-1, -1, -1, 3, 3, 3) "}");
    stroke_scene scene = scene_of(s);
    for (size_t i = 0; i < scene.mesh_count; i++)
        assert_int_equal(scene.meshes[i].edge_count, 0);
    stroke_scene_release(&scene);
    lmn_scene_destroy(&s);
    check_lengths("difference(){" BOX(0, 0, 0, 10, 10, 10) BOX(10, 0, 0, 5, 5, 5) "}", 120, 0, 0, 0, 0);
}

static void round_operands_have_rims_and_outlines(void **state)
{
    (void)state;
    double rim = 24 * 2 * 2 * sin(stroke_pi / 24);
    check_lengths("difference(){" BOX(0, 0, 0, 10, 10, 10) ROD(5, 5, -1, 2, 12) "}", 120 + 2 * rim, 0, 0, 0, 24 * 10);
    check_lengths("difference(){" BOX(0, 0, 0, 10, 10, 10) ROD(5, 5, 4, 2, 6) "}", 120 + 2 * rim, 0, 0, 0, 24 * 6);
    check_lengths("union(){" BOX(0, 0, 0, 10, 10, 10) ROD(5, 5, 10, 2, 5) "}", 120 + 2 * rim, 24 * 5, 0, 0, 0);
    check_lengths("union(){" BOX(0, 0, 0, 10, 10, 10) ROD(5, 5, 3, 2, 12) "}", 120 + 2 * rim, 24 * 5, 0, 0, 0);
}

/* Sides of a bore are outlines that are always hidden: seen from the side, two lines. */
static void bores_have_hidden_sides(void **state)
{
    (void)state;
    lmn_scene   *s = load_text("difference(){" BOX(0, 0, 0, 10, 10, 10) ROD(5, 5, -1, 2, 12) "}");
    stroke_scene scene = scene_of(s);
    assert_true(fabs(measure(&scene.meshes[0]).hollow - 24 * 10) < 1e-3);
    stroke_scene_release(&scene);
    stroke_options options = STROKE_OPTIONS_INIT;
    options.hidden = true;
    options.detail = 0.8f; /* the rims, seen from the edge, lie on other lines; the sides stay all the same */
    stroke_shot shot = shoot(s, look_along(0, 1, 0, (const double[3]){5, 5, 5}, 40, 8, true, 800, 800), options);
    double      length;
    count_strokes(&shot.set, STROKE_CONTOUR, 1, &length);
    assert_true(fabs(length - 2 * 10 * 50) < 10);
    shot_release(&shot);
}

static void several_meet_at_an_edge(void **state)
{
    (void)state;
    check_lengths("union(){" BOX(0, 0, 0, 10, 10, 10) BOX(10, 10, 0, 10, 10, 10) "}", 220, 0, 10, 0, 0);
}

static void colours_have_borders(void **state)
{
    (void)state;
    check_lengths(
        "union(){color([1,0,0,1]){" BOX(0, 0, 0, 10, 10, 10) "}color([0,0,1,1]){" BOX(10, 0, 0, 10, 10, 10) "}}", 160,
        0, 0, 40, 0);
}

/* The curve in which two balls meet is closed and lies on both. */
static void balls_meet_in_a_ring(void **state)
{
    (void)state;
    lmn_scene *s =
        load_text("difference(){sphere($fn=48,$fa=12,$fs=2,r=10);multmatrix([[1,0,0,9],[0,1,0,2],[0,0,1,1],[0,0,0,"
                  "1]]){sphere($fn=40,$fa=12,$fs=2,r=7);}}");
    stroke_scene     scene = scene_of(s);
    const edge_mesh *m = &scene.meshes[0];
    uint8_t         *degree = mem_calloc(m->vertex_count, 1);
    size_t           count = 0;
    for (uint32_t i = 0; i < m->edge_count; i++) {
        const mesh_edge *e = &m->edges[i];
        if (m->solid->operands[e->face[0]] == m->solid->operands[e->face[1]])
            continue;
        for (int k = 0; k < 2; k++) {
            vec3   p = m->positions[e->vertex[k]];
            double a = sqrt(pow((double)p.x, 2) + pow((double)p.y, 2) + pow((double)p.z, 2)),
                   b = sqrt(pow((double)p.x - 9, 2) + pow((double)p.y - 2, 2) + pow((double)p.z - 1, 2));
            assert_true(a > 9.9 && a < 10.001 && b > 6.9 && b < 7.001);
            degree[e->vertex[k]]++;
        }
        count++;
    }
    assert_true(count > 40);
    for (uint32_t v = 0; v < m->vertex_count; v++)
        assert_true(degree[v] == 0 || degree[v] == 2);
    mem_free(degree);
    stroke_scene_release(&scene);
    lmn_scene_destroy(&s);
}

/* Lines in which a solid and another part run through each other end where the solid does: a bar in a hole crosses
 * nothing, one beside it crosses both faces of the plate. */
static void parts_cross_what_is_left(void **state)
{
    (void)state;
    static const char *const texts[2] = {"difference(){" BOX(-10, 0, -10, 20, 1, 20) BOX(-2, -1, -2, 4, 3, 4) "}",
                                         "difference(){union(){" BOX(-1, -5, -1, 2, 10, 2)
                                             BOX(5, -5, 5, 2, 10, 2) "}" BOX(6, -6, 0, 3, 12, 9) "}"};
    lmn_scene               *s;
    lmn_error                error = {0};
    lmn_load_desc            load = LMN_LOAD_DESC_INIT;
    assert_int_equal(lmn_scene_create(&s, &error), LMN_OK);
    for (int k = 0; k < 2; k++)
        assert_int_equal(lmn_scene_add_file(s, temp_file("part.csg", texts[k], strlen(texts[k])), &load, &error),
                         LMN_OK);
    stroke_scene scene = scene_of(s);
    double       length = 0;
    assert_int_equal(scene.item_count, 2);
    assert_int_equal(stroke_scene_cross(&scene, NULL, 0, NULL, NULL, &error), LMN_OK);
    for (size_t i = 0; i < stroke_scene_crossing_count(&scene); i++) {
        double ends[2][3];
        vec3   outward[2];
        stroke_scene_crossing(&scene, i, ends, outward);
        length +=
            sqrt(pow(ends[1][0] - ends[0][0], 2) + pow(ends[1][1] - ends[0][1], 2) + pow(ends[1][2] - ends[0][2], 2));
    }
    assert_true(fabs(length - 2 * 2 * (1 + 2)) < 1e-3);
    stroke_scene_release(&scene);
    lmn_scene_destroy(&s);
}

static stroke_scene cut_scene_of(lmn_scene *s, const char *spec, box3 bounds)
{
    pose         at_rest;
    cut          c;
    stroke_scene out;
    lmn_error    error = {0};
    assert_int_equal(pose_create(&at_rest, s, &(moment){.seconds = 0}, &error), LMN_OK);
    assert_int_equal(cut_parse(&c, spec, bounds, &error), LMN_OK);
    stroke_section section = {&c, NULL};
    assert_int_equal(stroke_scene_create_cut(&out, &at_rest, NULL, 0.5, 0, &section, NULL, NULL, &error), LMN_OK);
    pose_release(&at_rest);
    return out;
}

/* What a section leaves of a solid is bounded like any solid. */
static void sections_cut_solids(void **state)
{
    (void)state;
    const box3   bounds = {{0, 0, 0}, {10, 10, 10}};
    lmn_scene   *s = load_text("difference(){" BOX(0, 0, 0, 10, 10, 10) BOX(4, -1, 5, 2, 12, 6) "}");
    stroke_scene scene = cut_scene_of(s, "y=5", bounds);
    assert_int_equal(scene.item_count, 1);
    assert_int_equal(scene.meshes[0].cap_count, 1);
    assert_true(fabs(measure(&scene.meshes[0]).crease - (180 - 4 * 5 - 4 * 5)) < 1e-3);
    stroke_scene_release(&scene);
    scene = cut_scene_of(s, "y=11", bounds);
    assert_true(fabs(measure(&scene.meshes[0]).crease - 180) < 1e-3);
    stroke_scene_release(&scene);
    scene = cut_scene_of(s, "-y=11", bounds);
    assert_int_equal(scene.item_count, 0);
    stroke_scene_release(&scene);
    lmn_scene_destroy(&s);
}

static double hatched(const stroke_scene *scene, double apart, bool flat)
{
    stroke_camera camera =
        look_along(0, 0, -1, (const double[3]){5, 5, 5}, 200, flat ? 10 : 10.0 / 200, flat, 800, 800);
    stroke_view *v;
    hatch_lines  lines;
    double       length = 0;
    assert_int_equal(stroke_view_create(&v, scene, &camera, NULL, NULL, NULL), LMN_OK);
    assert_int_equal(hatch_find(&lines, NULL, v, apart, 0.7, NULL, NULL), LMN_OK);
    for (size_t i = 0; i < lines.count; i++) {
        const hatch_line *l = &lines.items[i];
        assert_int_equal(l->part, 1);
        length += hypot((double)l->ends[1][0] - (double)l->ends[0][0], (double)l->ends[1][1] - (double)l->ends[0][1]);
    }
    stroke_check check;
    assert_int_equal(hatch_verify(&check, &lines, v, 2, NULL), LMN_OK);
    assert_int_equal(check.wrong, 0);
    assert_true(check.samples > length / 4 || length == 0);
    mem_free(lines.items);
    stroke_view_destroy(&v);
    return length * apart / (40 * 40); /* that many units are 1 */
}

/* The area of a mesh's cut faces as it is seen along a direction. */
static double cap_area(const stroke_scene *scene, const double way[3])
{
    const edge_mesh *m = &scene->meshes[0];
    double           sum = 0;
    for (uint32_t i = 0; i < m->face_count; i++) {
        double3 p[3];
        if (!m->materials || m->materials[i] > EDGE_CAP_MATERIAL(0))
            continue;
        for (int k = 0; k < 3; k++)
            p[k] = item_position(&scene->items[0], m->positions[m->faces[i][k]]);
        const double a[3] = {p[1].x - p[0].x, p[1].y - p[0].y, p[1].z - p[0].z},
                     b[3] = {p[2].x - p[0].x, p[2].y - p[0].y, p[2].z - p[0].z};
        for (int k = 0; k < 3; k++)
            sum -= 0.5 * way[k] * (a[(k + 1) % 3] * b[(k + 2) % 3] - a[(k + 2) % 3] * b[(k + 1) % 3]);
    }
    return sum;
}

/* A shaft's cut face has needles for triangles, along its length. */
static void needles_are_hatched(void **state)
{
    (void)state;
    enum { SHAFT = 14 };
    bool       parts[64] = {[SHAFT] = true};
    lmn_scene *s = NULL;
    pose       at_rest;
    cut        c;
    assert_int_equal(lmn_scene_create(&s, NULL), LMN_OK);
    assert_int_equal(lmn_scene_add_file(s, LIMNER_SOURCE_DIR "/examples/pump.glb", NULL, NULL), LMN_OK);
    assert_string_equal(s->parts[SHAFT].name, "Idler shaft");
    const box3 bounds = s->parts[SHAFT].bounds;
    assert_int_equal(pose_create(&at_rest, s, &(moment){.seconds = 0}, NULL), LMN_OK);
    assert_int_equal(cut_parse(&c, "x", bounds, NULL), LMN_OK);
    stroke_section section = {&c, NULL};
    for (int k = 0; k < 3; k++) {
        static const double ways[3][3] = {{-0.6, -0.64, -0.48}, {-0.57735, -0.57735, -0.57735}, {-0.6, -0.48, 0.64}};
        const double        middle[3] = {0.5 * (double)(bounds.min.x + bounds.max.x),
                                         0.5 * (double)(bounds.min.y + bounds.max.y),
                                         0.5 * (double)(bounds.min.z + bounds.max.z)};
        const double        half = box3_diagonal(bounds), units = 400 / half;
        stroke_scene        scene;
        stroke_view        *v;
        hatch_lines         lines;
        double              length = 0;
        stroke_camera camera = look_along(ways[k][0], ways[k][1], ways[k][2], middle, 10 * half, half, true, 800, 800);
        assert_int_equal(stroke_scene_create_cut(&scene, &at_rest, parts, 0.5, 0, &section, NULL, NULL, NULL), LMN_OK);
        assert_int_equal(scene.item_count, 1);
        assert_int_equal(stroke_view_create(&v, &scene, &camera, NULL, NULL, NULL), LMN_OK);
        assert_int_equal(hatch_find(&lines, NULL, v, 4, 0.7, NULL, NULL), LMN_OK);
        for (size_t i = 0; i < lines.count; i++)
            length += hypot((double)lines.items[i].ends[1][0] - (double)lines.items[i].ends[0][0],
                            (double)lines.items[i].ends[1][1] - (double)lines.items[i].ends[0][1]);
        double wanted = cap_area(&scene, ways[k]) * units * units;
        assert_true(wanted > 1000);
        assert_true(fabs(length * 4 * 0.8 / wanted - 1) < 0.01); /* this part's lines lie closer */
        mem_free(lines.items);
        stroke_view_destroy(&v);
        stroke_scene_release(&scene);
    }
    pose_release(&at_rest);
    lmn_scene_destroy(&s);
}

/* Lines on cut faces take their area, of solids and of meshes, and of nothing else. */
static void cut_faces_are_hatched(void **state)
{
    (void)state;
    const box3   bounds = {{0, 0, 0}, {10, 10, 10}};
    lmn_scene   *s = load_text("difference(){" BOX(0, 0, 0, 10, 10, 10) BOX(3, 3, -1, 4, 4, 12) "}");
    stroke_scene scene = cut_scene_of(s, "z=5", bounds);
    assert_true(fabs(hatched(&scene, 4, true) - 84) < 0.5);
    assert_true(fabs(hatched(&scene, 4, false) - 84) < 0.5);
    stroke_scene_release(&scene);
    scene = cut_scene_of(s, "-z=5", bounds); /* seen from behind */
    assert_true(hatched(&scene, 4, true) == 0);
    stroke_scene_release(&scene);
    lmn_scene_destroy(&s);
    /* What lies in the plane is not cut. */
    s = load_text("union(){" BOX(0, 0, 0, 10, 10, 5) BOX(1, 1, 0, 2, 2, 10) "}");
    scene = cut_scene_of(s, "z=5", bounds);
    assert_true(fabs(hatched(&scene, 1, true) - 4) < 0.1);
    stroke_scene_release(&scene);
    lmn_scene_destroy(&s);
    /* A mesh, and what lies over the cut face of another one. */
    s = stroke_scene_begin();
    add_box(s, 0, 0, 0, 10, 10, 10);
    assert_int_equal(scene_finish(s, "test", NULL), LMN_OK);
    scene = cut_scene_of(s, "z=5", bounds);
    assert_true(fabs(hatched(&scene, 4, true) - 100) < 0.5);
    stroke_scene_release(&scene);
    scene = cut_scene_of(s, "box=2,2,5:8,8,20", bounds); /* a pocket */
    assert_true(fabs(hatched(&scene, 1, true) - 36) < 0.3);
    stroke_scene_release(&scene);
    scene_free(s);
}

/* --- bad operands --------------------------------------------------------------------------------------- */

#define CORNERS(x, y, z, u, v, w)                                                                                      \
    "[" #x "," #y "," #z "],[" #u "," #y "," #z "],[" #u "," #v "," #z "],[" #x "," #v "," #z "],[" #x "," #y "," #w   \
    "],[" #u "," #y "," #w "],[" #u "," #v "," #w "],[" #x "," #v "," #w "]"

/* What two shells enclose together is outside, as in pictures. */
static void shells_that_cross_are_decided(void **state)
{
    (void)state;
    check_lengths("polyhedron(points=[" CORNERS(0, 0, 0, 10, 10, 10) "," CORNERS(
                      5, 2, 2, 15, 8,
                      8) "],faces=["
                         "[0,1,2,3],[7,6,5,4],[0,4,5,1],[1,5,6,2],[2,6,7,3],[3,7,4,0],"
                         "[8,9,10,11],[15,14,13,12],[8,12,13,9],[9,13,14,10],[10,14,15,11],[11,15,12,8]],convexity=2);",
                  120 + 88, 0, 24, 0, 0);
}

/* Walls that lie on each other enclose nothing: two boxes side by side in one operand are one. */
static void walls_that_meet_cancel(void **state)
{
    (void)state;
    check_lengths(
        "polyhedron(points=[" CORNERS(0, 0, 0, 10, 10, 10) "," CORNERS(
            10, 0, 0, 20, 10,
            10) "],faces=["
                "[0,1,2,3],[7,6,5,4],[0,4,5,1],[1,5,6],[1,6,2],[2,6,7,3],[3,7,4,0],"
                "[8,9,10,11],[15,14,13,12],[8,12,13,9],[9,13,14,10],[10,14,15,11],[8,15,12],[8,11,15]],convexity=2);",
        160, 0, 0, 0, 0);
}

static void open_operands_are_counted(void **state)
{
    (void)state;
    lmn_scene   *s = load_text("difference(){" BOX(-5, -5, -5, 1, 1, 1) "polyhedron(points=[" CORNERS(
          0, 0, 0, 10, 10, 10) "],faces=[[0,1,2,3],[0,4,5,1],[1,5,6,2],[2,6,7,3],[3,7,4,0]],convexity=2);}");
    stroke_scene scene = scene_of(s);
    assert_true(scene.item_count == 1);
    stroke_scene_release(&scene);
    lmn_scene_destroy(&s);
    s = load_text("union(){" BOX(0, 0, 0, 1, 1, 1) "polyhedron(points=[" CORNERS(
        0, 0, 0, 10, 10, 10) "],faces=[[0,1,2,3],[0,4,5,1],[1,5,6,2],[2,6,7,3],[3,7,4,0]],convexity=2);}");
    scene = scene_of(s);
    assert_int_equal(scene.meshes[0].solid->open_operands, 1);
    assert_int_equal(scene.open_operands, 1);
    stroke_scene_release(&scene);
    lmn_scene_destroy(&s);
}

/* --- what hides ----------------------------------------------------------------------------------------- */

static void what_is_taken_away_hides_nothing(void **state)
{
    (void)state;
    /* A bar behind a plate with a hole in it; the eye looks along y. */
    lmn_scene   *s = load_text("union(){difference(){" BOX(-10, 0, -10, 20, 1, 20)
                                   BOX(-2, -1, -2, 4, 3, 4) "}" BOX(-5, 5, -1, 10, 1, 2) "}");
    stroke_scene scene = scene_of(s);
    for (int flat = 0; flat < 2; flat++) {
        stroke_camera camera = look_along(0, 1, 0, (const double[3]){0, 0, 0}, 60, flat ? 12 : 0.3, flat, 600, 600);
        stroke_view  *v;
        assert_int_equal(stroke_view_create(&v, &scene, &camera, NULL, NULL, NULL), LMN_OK);
        const double at[5][3] = {{0, 5, 1}, {4, 5, 1}, {0.5, 6, 0}, {4, 6, 0.5}, {-9, 0, -9}};
        uint32_t     counts[5];
        stroke_view_count(v, at, 5, counts);
        assert_int_equal(counts[0], 0); /* through the hole */
        assert_int_equal(counts[1], 1); /* behind the plate */
        assert_int_equal(counts[2], 1); /* behind the bar */
        assert_int_equal(counts[3], 2);
        assert_int_equal(counts[4], 0);
        stroke_view_destroy(&v);
    }
    stroke_scene_release(&scene);
    lmn_scene_destroy(&s);
}

/* Rays through the operands say the same as what was found in the window. */
static void rays_agree(void **state)
{
    (void)state;
    static const char *const texts[] = {
        "difference(){" BOX(0, 0, 0, 10, 10, 10) ROD(5, 5, -1, 3, 12) BOX(-1, 3, 6, 12, 4, 5) "}",
        "union(){difference(){" BOX(0, 0, 0, 10, 10, 10) BOX(5, 0, 5, 5, 10, 5) "}" ROD(7, 5, 5, 2, 8) "}",
        "intersection(){sphere($fn=32,$fa=12,$fs=2,r=8);" BOX(-5, -5, -5, 12, 10, 9) "}"};
    stroke_options options = STROKE_OPTIONS_INIT;
    options.hidden = true;
    for (size_t i = 0; i < sizeof texts / sizeof *texts; i++)
        for (int flat = 0; flat < 2; flat++) {
            stroke_camera camera =
                look_along(-0.6, 1, -0.55, (const double[3]){4, 4, 4}, 40, flat ? 12 : 0.3, flat, 500, 500);
            stroke_shot shot = shoot(load_text(texts[i]), camera, options);
            assert_true(shot.check.samples > 500);
            assert_int_equal(shot.check.wrong, 0);
            assert_true(count_strokes(&shot.set, STROKE_CLASS_COUNT, -2, NULL) > 0);
            shot_release(&shot);
        }
}

/* A bar that leans through a bored block goes into its faces: its edges are seen up to where they do, from either end.
 */
static void rays_agree_where_parts_go_through_solids(void **state)
{
    (void)state;
    static const char *const texts[2] = {
        "difference(){" BOX(0, 0, 0, 10, 10, 10) ROD(5, 5, -1, 3, 12) "}",
        "multmatrix([[0.8,0,0.6,-2],[0,1,0,2],[-0.6,0,0.8,9],[0,0,0,1]]){cube(size=[18,1.5,1.5],center=false);}"};
    stroke_options options = STROKE_OPTIONS_INIT;
    options.hidden = true;
    for (int flat = 0; flat < 4; flat++) {
        lmn_scene    *s;
        lmn_error     error = {0};
        lmn_load_desc load = LMN_LOAD_DESC_INIT;
        assert_int_equal(lmn_scene_create(&s, &error), LMN_OK);
        for (int k = 0; k < 2; k++)
            assert_int_equal(lmn_scene_add_file(s, temp_file("part.csg", texts[k], strlen(texts[k])), &load, &error),
                             LMN_OK);
        stroke_camera camera = look_along(flat < 2 ? -0.6 : 0.7, 1, -0.55, (const double[3]){4, 4, 4}, 40,
                                          flat % 2 ? 12 : 0.4, flat % 2, 500, 500);
        stroke_shot   shot = shoot(s, camera, options);
        assert_true(shot.check.samples > 300);
        assert_int_equal(shot.check.wrong, 0);
        shot_release(&shot);
    }
}

/* What a section takes away reaches up to the eye and around it. */
static void rays_agree_where_the_eye_is_in_what_is_cut(void **state)
{
    (void)state;
    const box3     bounds = {{0, 0, 0}, {10, 10, 10}};
    stroke_options options = STROKE_OPTIONS_INIT;
    options.hidden = true;
    lmn_scene    *s = load_text("difference(){" BOX(0, 0, 0, 10, 10, 10) ROD(5, 5, -1, 3, 12) "}");
    stroke_scene  scene = cut_scene_of(s, "-y=4", bounds);
    stroke_camera camera = look_along(-0.3, 1, -0.25, (const double[3]){5, 5, 5}, 16, 0.5, false, 500, 500);
    stroke_view  *v;
    stroke_set    set;
    stroke_check  check;
    double        seen;
    camera.near = 0.1;
    assert_int_equal(stroke_view_create(&v, &scene, &camera, NULL, NULL, NULL), LMN_OK);
    assert_int_equal(stroke_find(&set, v, &options, NULL, NULL, NULL, NULL), LMN_OK);
    assert_int_equal(stroke_verify(&check, &set, v, 1, NULL, NULL, NULL), LMN_OK);
    assert_true(check.samples > 500);
    assert_int_equal(check.wrong, 0);
    count_strokes(&set, STROKE_CLASS_COUNT, 0, &seen);
    assert_true(seen > 1000);
    stroke_set_release(&set);
    stroke_view_destroy(&v);
    stroke_scene_release(&scene);
    lmn_scene_destroy(&s);
}

/* The eye in a room that was cut out: walls hide what is behind them, and nothing is around the eye. */
static void the_eye_may_be_inside(void **state)
{
    (void)state;
    lmn_scene    *s = load_text("union(){difference(){" BOX(-10, -10, -10, 20, 20, 20)
                                    BOX(-8, -8, -8, 16, 16, 16) "}" BOX(-1, 4, -8, 2, 2, 6) BOX(-1, 14, -1, 2, 2, 2) "}");
    stroke_scene  scene = scene_of(s);
    stroke_camera camera = look_along(0, 1, 0, (const double[3]){0, 0, 0}, 5, 0.6, false, 600, 600);
    stroke_view  *v;
    assert_int_equal(stroke_view_create(&v, &scene, &camera, NULL, NULL, NULL), LMN_OK);
    const double at[4][3] = {{-2, 8, 3}, {0, 6, -4}, {0, 10, 4}, {0, 14, 1}};
    uint32_t     counts[4];
    stroke_view_count(v, at, 4, counts);
    assert_int_equal(counts[0], 0); /* the wall */
    assert_int_equal(counts[1], 1); /* the back of a post */
    assert_int_equal(counts[2], 1); /* the outside, beyond the wall */
    assert_int_equal(counts[3], 1); /* another box behind */
    stroke_view_destroy(&v);
    stroke_scene_release(&scene);
    lmn_scene_destroy(&s);
}

static void memory_may_end(void **state)
{
    (void)state;
    lmn_scene *s = load_text("difference(){" BOX(0, 0, 0, 10, 10, 10) ROD(5, 5, -1, 3, 12) "}");
    pose       at_rest;
    bool       done = false;
    assert_int_equal(pose_create(&at_rest, s, &(moment){.seconds = 0}, NULL), LMN_OK);
    for (long n = 1; !done && n < 2000; n++) {
        stroke_scene out;
        lmn_error    error = {0};
        mem_fail_at(n);
        lmn_status status = stroke_scene_create(&out, &at_rest, NULL, 0.5, NULL, NULL, &error);
        mem_fail_at(0);
        done = status == LMN_OK;
        if (done)
            stroke_scene_release(&out);
        else
            assert_int_equal(status, LMN_MEMORY);
    }
    assert_true(done);
    pose_release(&at_rest);
    lmn_scene_destroy(&s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(flush_faces_leave_no_lines),
        cmocka_unit_test(cuts_leave_rims),
        cmocka_unit_test(round_operands_have_rims_and_outlines),
        cmocka_unit_test(bores_have_hidden_sides),
        cmocka_unit_test(several_meet_at_an_edge),
        cmocka_unit_test(colours_have_borders),
        cmocka_unit_test(balls_meet_in_a_ring),
        cmocka_unit_test(parts_cross_what_is_left),
        cmocka_unit_test(sections_cut_solids),
        cmocka_unit_test(cut_faces_are_hatched),
        cmocka_unit_test(needles_are_hatched),
        cmocka_unit_test(shells_that_cross_are_decided),
        cmocka_unit_test(walls_that_meet_cancel),
        cmocka_unit_test(open_operands_are_counted),
        cmocka_unit_test(what_is_taken_away_hides_nothing),
        cmocka_unit_test(rays_agree),
        cmocka_unit_test(rays_agree_where_parts_go_through_solids),
        cmocka_unit_test(rays_agree_where_the_eye_is_in_what_is_cut),
        cmocka_unit_test(the_eye_may_be_inside),
        cmocka_unit_test(memory_may_end),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
