/* The public functions for solids: every one of them, what they refuse, ids after removal, memory that is gone,
 * reading trees. */
#include "import_support.h"

#include <math.h>

#include "base/text.h"
#include "limner/limner.h"
#include "scene/solid.h"

#define ROOT LMN_SOLID_ROOT

static lmn_error error;

static lmn_scene *fresh(void)
{
    lmn_scene *s = NULL;
    assert_int_equal(lmn_scene_create(&s, &error), LMN_OK);
    return s;
}

/* A scene with one empty solid. */
static lmn_scene *with_solid(uint32_t *solid, lmn_operation root)
{
    lmn_scene *s = fresh();
    assert_int_equal(lmn_scene_add_solid(s, "thing", root, solid, &error), LMN_OK);
    return s;
}

static uint32_t add(lmn_scene *s, uint32_t solid, uint32_t parent, lmn_shape shape)
{
    uint32_t   id = 0;
    lmn_status status = lmn_solid_add_shape(s, solid, parent, &shape, &id, &error);
    if (status != LMN_OK)
        print_error("%s %s\n", error.message, error.hint);
    assert_int_equal(status, LMN_OK);
    return id;
}

static uint32_t operation(lmn_scene *s, uint32_t solid, uint32_t parent, lmn_operation kind)
{
    uint32_t id = 0;
    assert_int_equal(lmn_solid_add_operation(s, solid, parent, kind, &id, &error), LMN_OK);
    return id;
}

static lmn_solid_info info_of(const lmn_scene *s, uint32_t solid, uint32_t node)
{
    lmn_solid_info info;
    assert_true(lmn_solid_info_of(s, solid, node, &info));
    return info;
}

static lmn_shape box(double size)
{
    return lmn_shape_box(size, size, size);
}

static void move_to(lmn_scene *s, uint32_t solid, uint32_t node, double x, double y, double z)
{
    const double m[16] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, x, y, z, 1};
    assert_int_equal(lmn_solid_set_matrix(s, solid, node, m, &error), LMN_OK);
}

static void expect_bounds(const lmn_scene *s, uint32_t solid, uint32_t node, const double low[3], const double high[3])
{
    lmn_solid_info info = info_of(s, solid, node);
    assert_false(info.is_empty);
    for (int i = 0; i < 3; i++) {
        assert_true(fabs(info.bounds_min[i] - low[i]) < 1e-5);
        assert_true(fabs(info.bounds_max[i] - high[i]) < 1e-5);
    }
}

#define BOUNDS(s, solid, node, x0, y0, z0, x1, y1, z1)                                                                 \
    expect_bounds(s, solid, node, (const double[3]){x0, y0, z0}, (const double[3]){x1, y1, z1})

/* What a refused call must not change. */
typedef struct memory {
    uint64_t revision;
    size_t   nodes, meshes, parts;
    char    *json;
} memory;

static memory remember(const lmn_scene *s)
{
    lmn_scene_info i = lmn_scene_info_of(s);
    return (memory){s->revision, i.nodes, i.meshes, i.parts, lmn_scene_info_json(s)};
}

static void expect_unchanged(const lmn_scene *s, memory *before)
{
    memory now = remember(s);
    assert_int_equal(now.revision, before->revision);
    assert_int_equal(now.nodes, before->nodes);
    assert_int_equal(now.meshes, before->meshes);
    assert_int_equal(now.parts, before->parts);
    assert_string_equal(now.json, before->json);
    lmn_text_free(now.json);
    lmn_text_free(before->json);
}

static void expect_refusal(const lmn_scene *s, memory before, lmn_status status, lmn_status wanted, bool hinted)
{
    if (status != wanted)
        print_error("status %d, expected %d: %s\n", (int)status, (int)wanted, error.message);
    assert_int_equal(status, wanted);
    assert_int_equal(error.status, wanted);
    assert_true(error.message[0]);
    assert_true(!hinted || error.hint[0]);
    expect_unchanged(s, &before);
    memset(&error, 0, sizeof error);
}

#define REFUSED(s, call)         expect_refusal(s, remember(s), call, LMN_USAGE, true)
#define REFUSED_PLAINLY(s, call) expect_refusal(s, remember(s), call, LMN_USAGE, false)
#define LIMITED(s, call)         expect_refusal(s, remember(s), call, LMN_LIMIT, false)

/* --- building and parts --------------------------------------------------------------------------------- */

static void parts_follow_triangles(void **state)
{
    (void)state;
    uint32_t   a, b;
    lmn_scene *s = with_solid(&a, LMN_UNION);
    assert_int_equal(lmn_scene_add_solid(s, "other", LMN_DIFFERENCE, &b, &error), LMN_OK);
    lmn_part_info part;
    assert_int_equal(lmn_scene_info_of(s).parts, 0);
    assert_int_equal(lmn_scene_info_of(s).up, 'z');
    assert_int_equal(info_of(s, a, ROOT).part, 0);
    assert_true(info_of(s, a, ROOT).is_empty);
    uint32_t in_b = add(s, b, ROOT, box(2));
    assert_int_equal(lmn_scene_info_of(s).parts, 1);
    assert_true(lmn_scene_part_at(s, 0, &part));
    assert_string_equal(part.name, "other");
    assert_int_equal(part.triangles, 12);
    uint32_t in_a = add(s, a, ROOT, box(1));
    assert_int_equal(lmn_scene_info_of(s).parts, 2);
    assert_true(lmn_scene_part_at(s, 0, &part));
    assert_string_equal(part.name, "thing");
    assert_int_equal(info_of(s, b, ROOT).part, 2);
    move_to(s, b, in_b, 5, 0, 0);
    assert_true(lmn_scene_part_at(s, 1, &part));
    assert_true(part.bounds_min[0] == 5 && part.bounds_max[0] == 7);
    assert_int_equal(lmn_solid_remove(s, a, in_a, &error), LMN_OK);
    assert_int_equal(lmn_scene_info_of(s).parts, 1);
    assert_int_equal(info_of(s, b, ROOT).part, 1);
    add(s, a, ROOT, box(3));
    assert_int_equal(info_of(s, b, ROOT).part, 2);
    assert_int_equal(lmn_scene_info_of(s).triangles, 24);
    assert_int_equal(lmn_scene_info_of(s).meshes, 2);
    lmn_scene_destroy(&s);
}

static void shapes_have_their_sizes(void **state)
{
    (void)state;
    uint32_t   solid;
    lmn_scene *s = with_solid(&solid, LMN_UNION);
    lmn_shape  shape = lmn_shape_box(1, 2, 3);
    uint32_t   id = add(s, solid, ROOT, shape);
    BOUNDS(s, solid, id, 0, 0, 0, 1, 2, 3);
    shape.centred = true;
    id = add(s, solid, ROOT, shape);
    BOUNDS(s, solid, id, -0.5, -1, -1.5, 0.5, 1, 1.5);
    shape = lmn_shape_sphere(2);
    assert_true(shape.facets.fn == 0 && shape.facets.fa == 12 && shape.facets.fs == 2);
    id = add(s, solid, ROOT, shape);
    uint64_t coarse = info_of(s, solid, id).triangles;
    shape.facets.fn = 40;
    id = add(s, solid, ROOT, shape);
    assert_true(info_of(s, solid, id).triangles > coarse);
    shape = lmn_shape_cylinder(4, 2, 0);
    shape.facets.fn = 32;
    id = add(s, solid, ROOT, shape);
    BOUNDS(s, solid, id, -2, -2, 0, 2, 2, 4);
    shape.radius = 0;
    shape.top_radius = 3;
    shape.centred = true;
    id = add(s, solid, ROOT, shape);
    BOUNDS(s, solid, id, -3, -3, -2, 3, 3, 2);
    static const double   outline[8][2] = {{0, 0}, {4, 0}, {4, 4}, {0, 4}, {1, 1}, {1, 3}, {3, 3}, {3, 1}};
    static const uint32_t sizes[2] = {4, 4};
    shape = lmn_shape_extrusion(outline, 8, 5);
    shape.contour_sizes = sizes;
    shape.contour_count = 2;
    id = add(s, solid, ROOT, shape);
    BOUNDS(s, solid, id, 0, 0, 0, 4, 4, 5);
    assert_int_equal(info_of(s, solid, id).triangles, 32); /* eight sides, two frames of eight triangles */
    shape.twist = 90;
    shape.slices = 9;
    assert_true(info_of(s, solid, add(s, solid, ROOT, shape)).triangles > 100);
    shape = lmn_shape_extrusion(outline, 4, 5);
    shape.scale[0] = shape.scale[1] = 0;
    assert_int_equal(info_of(s, solid, add(s, solid, ROOT, shape)).triangles, 6); /* a pyramid */
    static const double profile[4][2] = {{2, 0}, {3, 0}, {3, 1}, {2, 1}};
    shape = lmn_shape_revolution(profile, 4, 360);
    shape.facets.fn = 64;
    id = add(s, solid, ROOT, shape);
    BOUNDS(s, solid, id, -3, -3, 0, 3, 3, 1);
    shape.angle = 90;
    id = add(s, solid, ROOT, shape);
    BOUNDS(s, solid, id, 0, 0, 0, 3, 3, 1);
    lmn_scene_destroy(&s);
}

static const double   corners[4][3] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
static const uint32_t outward[12] = {0, 2, 1, 0, 1, 3, 1, 2, 3, 2, 0, 3},
                      inward[12] = {0, 1, 2, 0, 3, 1, 1, 3, 2, 2, 3, 0};
static const uint32_t threes[4] = {3, 3, 3, 3};

static void polyhedra_run_either_way(void **state)
{
    (void)state;
    uint32_t          solid;
    lmn_scene        *s = with_solid(&solid, LMN_UNION);
    uint32_t          a = add(s, solid, ROOT, lmn_shape_polyhedron(corners, 4, outward, threes, 4));
    uint32_t          b = add(s, solid, ROOT, lmn_shape_polyhedron(corners, 4, inward, threes, 4));
    const solid_node *nodes = s->solids[0].nodes;
    for (uint32_t i = 0; i < 12; i += 3) {
        const primitive *p = &s->meshes[nodes[a - 1].mesh].primitives[0],
                        *q = &s->meshes[nodes[b - 1].mesh].primitives[0];
        for (int k = 0; k < 2; k++) {
            const primitive *m = k ? q : p;
            vec3             o = m->positions[m->indices[i]], u = m->positions[m->indices[i + 1]],
                 v = m->positions[m->indices[i + 2]];
            double x[3] = {u.x - o.x, u.y - o.y, u.z - o.z}, y[3] = {v.x - o.x, v.y - o.y, v.z - o.z};
            double away[3] = {o.x - 0.2, o.y - 0.2, o.z - 0.2};
            assert_true(away[0] * (x[1] * y[2] - x[2] * y[1]) + away[1] * (x[2] * y[0] - x[0] * y[2]) +
                            away[2] * (x[0] * y[1] - x[1] * y[0]) >
                        0);
        }
    }
    lmn_shape open = lmn_shape_polyhedron(corners, 4, outward, threes, 3);
    REFUSED(s, lmn_solid_add_shape(s, solid, ROOT, &open, NULL, &error));
    uint32_t mixed[15];
    memcpy(mixed, outward, sizeof outward);
    mixed[1] = 1, mixed[2] = 2;
    lmn_shape wrong = lmn_shape_polyhedron(corners, 4, mixed, threes, 4);
    REFUSED(s, lmn_solid_add_shape(s, solid, ROOT, &wrong, NULL, &error));
    mixed[0] = 4;
    REFUSED(s, lmn_solid_add_shape(s, solid, ROOT, &wrong, NULL, &error));
    static const uint32_t two[4] = {3, 3, 2, 4};
    wrong = lmn_shape_polyhedron(corners, 4, outward, two, 4);
    REFUSED(s, lmn_solid_add_shape(s, solid, ROOT, &wrong, NULL, &error));
    const double far[4][3] = {{NAN, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    wrong = lmn_shape_polyhedron(far, 4, outward, threes, 4);
    REFUSED(s, lmn_solid_add_shape(s, solid, ROOT, &wrong, NULL, &error));
    wrong = lmn_shape_polyhedron(NULL, 4, outward, threes, 4);
    REFUSED(s, lmn_solid_add_shape(s, solid, ROOT, &wrong, NULL, &error));
    lmn_scene_destroy(&s);
}

/* --- refusals ------------------------------------------------------------------------------------------- */

static void wrong_sizes_are_refused(void **state)
{
    (void)state;
    uint32_t            solid;
    lmn_scene          *s = with_solid(&solid, LMN_UNION);
    uint32_t            kept = add(s, solid, ROOT, box(1));
    static const double square[4][2] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}}, line[3][2] = {{0, 0}, {1, 1}, {2, 2}},
                        wide[3][2] = {{-1, 0}, {1, 0}, {0, 1}};
    static const double   bad_point[3][2] = {{0, 0}, {INFINITY, 0}, {0, 1}};
    static const uint32_t few[2] = {2, 2}, too_few[1] = {3};
    const double          bad[] = {0, -1, NAN, INFINITY, -INFINITY};
    lmn_shape             shapes[64];
    size_t                count = 0;
    for (size_t i = 0; i < 5; i++) {
        shapes[count++] = lmn_shape_box(1, bad[i], 1);
        shapes[count++] = lmn_shape_sphere(bad[i]);
        shapes[count++] = lmn_shape_cylinder(bad[i], 1, 1);
        shapes[count++] = lmn_shape_cylinder(1, bad[i], 0);
        shapes[count++] = lmn_shape_extrusion(square, 4, bad[i]);
        shapes[count] = lmn_shape_sphere(1);
        shapes[count++].facets.fs = bad[i];
        shapes[count] = lmn_shape_sphere(1);
        shapes[count++].facets.fa = bad[i];
    }
    shapes[count] = lmn_shape_sphere(1);
    shapes[count++].facets.fn = -1;
    shapes[count] = lmn_shape_extrusion(square, 4, 1);
    shapes[count++].scale[1] = -1;
    shapes[count] = lmn_shape_extrusion(square, 4, 1);
    shapes[count++].twist = NAN;
    shapes[count] = lmn_shape_extrusion(square, 4, 1);
    shapes[count++].slices = 1000001;
    shapes[count++] = lmn_shape_extrusion(line, 3, 1);
    shapes[count++] = lmn_shape_extrusion(bad_point, 3, 1);
    shapes[count++] = lmn_shape_extrusion(square, 2, 1);
    shapes[count++] = lmn_shape_extrusion(NULL, 4, 1);
    shapes[count] = lmn_shape_extrusion(square, 4, 1);
    shapes[count].contour_sizes = few;
    shapes[count++].contour_count = 2;
    shapes[count] = lmn_shape_extrusion(square, 4, 1);
    shapes[count].contour_sizes = too_few;
    shapes[count++].contour_count = 1;
    shapes[count++] = lmn_shape_revolution(square, 4, 0);
    shapes[count++] = lmn_shape_revolution(square, 4, 361);
    shapes[count++] = lmn_shape_revolution(wide, 3, 360);
    shapes[count++] = box(1e-60); /* nothing is left of it in single precision */
    shapes[count++] = box(1e20);
    shapes[count] = box(1);
    shapes[count++].struct_size = 0;
    shapes[count] = box(1);
    shapes[count++].kind = (lmn_shape_kind)77;
    for (size_t i = 0; i < count; i++) {
        REFUSED(s, lmn_solid_add_shape(s, solid, ROOT, &shapes[i], NULL, &error));
        REFUSED(s, lmn_solid_set_shape(s, solid, kept, &shapes[i], &error));
    }
    lmn_shape fine = lmn_shape_sphere(1);
    fine.facets.fn = 1e7;
    LIMITED(s, lmn_solid_add_shape(s, solid, ROOT, &fine, NULL, &error));
    REFUSED_PLAINLY(s, lmn_solid_add_shape(s, solid, ROOT, NULL, NULL, &error));
    lmn_scene_destroy(&s);
}

static void wrong_matrices_and_colours_are_refused(void **state)
{
    (void)state;
    uint32_t     solid;
    lmn_scene   *s = with_solid(&solid, LMN_UNION);
    uint32_t     id = add(s, solid, ROOT, box(1));
    const double good[16] = {2, 0, 0, 0, 0, -3, 0, 0, 0, 0, 1, 0, 5, 6, 7, 1};
    assert_int_equal(lmn_solid_set_matrix(s, solid, id, good, &error), LMN_OK);
    BOUNDS(s, solid, id, 5, 3, 7, 7, 6, 8);
    assert_memory_equal(info_of(s, solid, id).matrix, good, sizeof good);
    for (int i = 0; i < 16; i++) {
        double m[16];
        memcpy(m, good, sizeof m);
        m[i] = NAN;
        REFUSED_PLAINLY(s, lmn_solid_set_matrix(s, solid, id, m, &error));
        m[i] = -INFINITY;
        REFUSED_PLAINLY(s, lmn_solid_set_matrix(s, solid, id, m, &error));
    }
    const double flat[16] = {1, 0, 0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 0, 0, 0, 1}, zero[16] = {[15] = 1};
    const double row_major[16] = {1, 0, 0, 5, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1},
                 far[16] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 2e18, 0, 0, 1};
    const double huge[16] = {1e200, 0, 0, 0, 0, 1e200, 0, 0, 0, 0, 1e200, 0, 0, 0, 0, 1},
                 tiny[16] = {1e-9, 0, 0, 0, 0, 1e-9, 0, 0, 0, 0, 1e-9, 0, 0, 0, 0, 1};
    REFUSED(s, lmn_solid_set_matrix(s, solid, id, flat, &error));
    REFUSED(s, lmn_solid_set_matrix(s, solid, id, zero, &error));
    REFUSED(s, lmn_solid_set_matrix(s, solid, id, row_major, &error));
    REFUSED(s, lmn_solid_set_matrix(s, solid, id, far, &error));
    REFUSED(s, lmn_solid_set_matrix(s, solid, ROOT, huge, &error));
    REFUSED_PLAINLY(s, lmn_solid_set_matrix(s, solid, id, NULL, &error));
    assert_int_equal(lmn_solid_set_matrix(s, solid, ROOT, tiny, &error), LMN_OK);
    const float colour[4] = {0.5f, 0, 1, 0.25f}, wrong[3][4] = {{0, 0, 2, 1}, {-0.1f, 0, 0, 1}, {0, NAN, 0, 1}};
    assert_int_equal(lmn_solid_set_colour(s, solid, id, colour, &error), LMN_OK);
    lmn_solid_info info = info_of(s, solid, id);
    assert_true(info.has_colour);
    for (int i = 0; i < 4; i++)
        assert_true(fabsf(info.colour[i] - colour[i]) < 1e-5f);
    for (int i = 0; i < 3; i++)
        REFUSED(s, lmn_solid_set_colour(s, solid, id, wrong[i], &error));
    assert_int_equal(lmn_solid_set_colour(s, solid, id, NULL, &error), LMN_OK);
    assert_false(info_of(s, solid, id).has_colour);
    lmn_scene_destroy(&s);
}

static void wrong_ids_are_refused(void **state)
{
    (void)state;
    uint32_t       solid;
    lmn_scene     *s = with_solid(&solid, LMN_UNION);
    uint32_t       shape = add(s, solid, ROOT, box(1)), inner = operation(s, solid, ROOT, LMN_UNION);
    const double   m[16] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
    lmn_shape      b = box(1);
    const uint32_t solids[] = {0, solid + 1, UINT32_MAX}, nodes[] = {0, inner + 1, UINT32_MAX};
    for (int i = 0; i < 6; i++) {
        uint32_t a = i < 3 ? solids[i] : solid, n = i < 3 ? ROOT : nodes[i - 3];
        REFUSED(s, lmn_solid_add_operation(s, a, n, LMN_UNION, NULL, &error));
        REFUSED(s, lmn_solid_add_shape(s, a, n, &b, NULL, &error));
        REFUSED(s, lmn_solid_add_file(s, a, n, "x.stl", NULL, NULL, &error));
        REFUSED(s, lmn_solid_add_copy(s, a, n, shape, NULL, &error));
        REFUSED(s, lmn_solid_set_matrix(s, a, n, m, &error));
        REFUSED(s, lmn_solid_set_colour(s, a, n, NULL, &error));
        REFUSED(s, lmn_solid_set_operation(s, a, n, LMN_UNION, &error));
        REFUSED(s, lmn_solid_set_shown(s, a, n, false, &error));
        assert_false(lmn_solid_is_shown(s, a, n));
        REFUSED(s, lmn_solid_set_shape(s, a, n, &b, &error));
        REFUSED(s, lmn_solid_set_name(s, a, n, "x", &error));
        REFUSED(s, lmn_solid_remove(s, a, n, &error));
        REFUSED(s, lmn_solid_move(s, a, n, ROOT, 0, &error));
        lmn_solid_info info;
        assert_false(lmn_solid_info_of(s, a, n, &info));
    }
    REFUSED(s, lmn_solid_add_copy(s, solid, ROOT, 99, NULL, &error));
    REFUSED(s, lmn_solid_move(s, solid, shape, 99, 0, &error));
    REFUSED(s, lmn_solid_move(s, solid, shape, inner, 99, &error));
    REFUSED(s, lmn_solid_move(s, solid, shape, inner, shape, &error)); /* no operand of the new parent */
    REFUSED_PLAINLY(s, lmn_solid_move(s, solid, ROOT, inner, 0, &error));
    REFUSED(s, lmn_solid_move(s, solid, inner, inner, 0, &error));
    REFUSED(s, lmn_solid_add_shape(s, solid, shape, &b, NULL, &error)); /* shapes have no operands */
    REFUSED(s, lmn_solid_add_operation(s, solid, shape, LMN_UNION, NULL, &error));
    REFUSED(s, lmn_solid_set_operation(s, solid, shape, LMN_UNION, &error));
    REFUSED(s, lmn_solid_set_operation(s, solid, inner, LMN_SHAPE, &error));
    REFUSED(s, lmn_solid_set_operation(s, solid, inner, (lmn_operation)9, &error));
    REFUSED(s, lmn_solid_set_shape(s, solid, inner, &b, &error));
    REFUSED(s, lmn_solid_add_operation(s, solid, inner, LMN_SHAPE, NULL, &error));
    REFUSED(s, lmn_scene_add_solid(s, "x", LMN_SHAPE, NULL, &error));
    assert_int_equal(lmn_scene_add_solid(NULL, "x", LMN_UNION, NULL, &error), LMN_USAGE);
    assert_int_equal(lmn_solid_remove(NULL, solid, ROOT, &error), LMN_USAGE);
    assert_int_equal(lmn_scene_solid_count(NULL), 0);
    assert_int_equal(lmn_scene_solid_at(NULL, 0), 0);
    assert_false(lmn_solid_info_of(s, solid, ROOT, NULL));
    assert_int_equal(lmn_solid_remove(s, solid, 1234, NULL), LMN_USAGE); /* no error wanted */
    lmn_scene_destroy(&s);
}

static void limits_hold(void **state)
{
    (void)state;
    uint32_t   solid, id = 0;
    lmn_scene *s = with_solid(&solid, LMN_UNION);
    uint32_t   group = operation(s, solid, ROOT, LMN_UNION);
    add(s, solid, group, box(1));
    for (int i = 0; i < 13; i++) { /* 2 to the power of 13 */
        assert_int_equal(lmn_solid_add_copy(s, solid, ROOT, group, &id, &error), LMN_OK);
        assert_int_equal(lmn_solid_move(s, solid, id, group, 0, &error), LMN_OK);
    }
    assert_int_equal(s->solids[0].operand_count, 8192);
    assert_int_equal(lmn_scene_info_of(s).meshes, 1);
    LIMITED(s, lmn_solid_add_copy(s, solid, ROOT, group, NULL, &error)); /* 16384: one too many */
    lmn_scene_destroy(&s);
    s = with_solid(&solid, LMN_UNION);
    id = ROOT;
    for (int i = 1; i < SOLID_DEPTH_MAX; i++)
        id = operation(s, solid, id, LMN_UNION);
    LIMITED(s, lmn_solid_add_operation(s, solid, id, LMN_UNION, NULL, &error));
    lmn_shape b = box(1);
    LIMITED(s, lmn_solid_add_shape(s, solid, id, &b, NULL, &error));
    uint32_t beside = operation(s, solid, ROOT, LMN_UNION);
    operation(s, solid, beside, LMN_UNION);
    LIMITED(s, lmn_solid_move(s, solid, beside, info_of(s, solid, id).parent, 0, &error));
    LIMITED(s, lmn_solid_add_copy(s, solid, info_of(s, solid, id).parent, beside, NULL, &error));
    uint32_t first = info_of(s, solid, ROOT).first_child, leaf = operation(s, solid, beside, LMN_UNION);
    assert_int_equal(lmn_solid_remove(s, solid, id, &error), LMN_OK);
    assert_int_equal(lmn_solid_remove(s, solid, first, &error), LMN_OK);
    assert_int_equal(info_of(s, solid, leaf).parent, beside);
    lmn_scene_destroy(&s);
}

/* --- ids, trees, meshes --------------------------------------------------------------------------------- */

/* "root(a b(c))" by names. */
static void print_tree(const lmn_scene *s, uint32_t solid, uint32_t node, text *out)
{
    lmn_solid_info info = info_of(s, solid, node);
    text_append(out, "%s", info.name ? info.name : "?");
    size_t count = 0;
    for (uint32_t c = info.first_child; c; c = info_of(s, solid, c).next_sibling) {
        text_append(out, count++ ? " " : "(");
        assert_int_equal(info_of(s, solid, c).parent, node);
        print_tree(s, solid, c, out);
    }
    assert_int_equal(count, info.child_count);
    if (count)
        text_append(out, ")");
}

static void expect_tree(const lmn_scene *s, uint32_t solid, const char *wanted)
{
    text found = {0};
    print_tree(s, solid, ROOT, &found);
    assert_string_equal(found.data, wanted);
    text_release(&found);
    const solid_node *nodes = s->solids[solid - 1].nodes;
    for (size_t i = 0; i < s->solids[solid - 1].node_count; i++)
        assert_true(nodes[i].parent < (int32_t)i); /* parents come before their children */
}

static uint32_t named(lmn_scene *s, uint32_t solid, uint32_t parent, const char *name, bool shape)
{
    uint32_t id = shape ? add(s, solid, parent, box(1)) : operation(s, solid, parent, LMN_UNION);
    assert_int_equal(lmn_solid_set_name(s, solid, id, name, &error), LMN_OK);
    return id;
}

static void trees_are_edited(void **state)
{
    (void)state;
    uint32_t   solid;
    lmn_scene *s = with_solid(&solid, LMN_DIFFERENCE);
    assert_int_equal(lmn_solid_set_name(s, solid, ROOT, "r", &error), LMN_OK);
    uint32_t a = named(s, solid, ROOT, "a", true), g = named(s, solid, ROOT, "g", false),
             b = named(s, solid, g, "b", true);
    uint32_t c = named(s, solid, g, "c", true), h = named(s, solid, ROOT, "h", false);
    expect_tree(s, solid, "r(a g(b c) h)");
    assert_int_equal(lmn_solid_move(s, solid, g, h, 0, &error), LMN_OK); /* a parent that was made later */
    expect_tree(s, solid, "r(a h(g(b c)))");
    REFUSED(s, lmn_solid_move(s, solid, h, g, 0, &error));
    assert_int_equal(lmn_solid_move(s, solid, c, g, b, &error), LMN_OK);
    expect_tree(s, solid, "r(a h(g(c b)))");
    assert_int_equal(lmn_solid_move(s, solid, c, g, c, &error), LMN_OK); /* in front of itself: where it is */
    assert_int_equal(lmn_solid_move(s, solid, b, ROOT, a, &error), LMN_OK);
    expect_tree(s, solid, "r(b a h(g(c)))");
    assert_int_equal(lmn_solid_move(s, solid, a, ROOT, 0, &error), LMN_OK);
    expect_tree(s, solid, "r(b h(g(c)) a)");
    uint32_t copy = 0;
    assert_int_equal(lmn_solid_add_copy(s, solid, g, h, &copy, &error), LMN_OK); /* into what is copied */
    expect_tree(s, solid, "r(b h(g(c h(g(c)))) a)");
    assert_int_equal(lmn_solid_remove(s, solid, g, &error), LMN_OK);
    expect_tree(s, solid, "r(b h a)");
    lmn_solid_info info;
    assert_false(lmn_solid_info_of(s, solid, g, &info) || lmn_solid_info_of(s, solid, c, &info) ||
                 lmn_solid_info_of(s, solid, copy, &info));
    REFUSED(s, lmn_solid_remove(s, solid, g, &error));
    uint32_t later = named(s, solid, h, "l", true);
    assert_true(later > copy); /* ids are not given again */
    expect_tree(s, solid, "r(b h(l) a)");
    assert_int_equal(info_of(s, solid, a).operation, LMN_SHAPE);
    assert_int_equal(info_of(s, solid, ROOT).operation, LMN_DIFFERENCE);
    assert_int_equal(info_of(s, solid, ROOT).triangles, 36);
    assert_int_equal(lmn_solid_set_name(s, solid, h, NULL, &error), LMN_OK);
    expect_tree(s, solid, "r(b ?(l) a)");
    lmn_part_info part;
    assert_true(lmn_scene_part_at(s, 0, &part));
    assert_string_equal(part.name, "r");
    lmn_scene_destroy(&s);
}

static void removed_solids_are_gone(void **state)
{
    (void)state;
    uint32_t   a, b, c;
    lmn_scene *s = with_solid(&a, LMN_UNION);
    assert_int_equal(lmn_scene_add_solid(s, NULL, LMN_UNION, &b, &error), LMN_OK);
    add(s, a, ROOT, box(1));
    add(s, b, ROOT, box(2));
    lmn_part_info part;
    assert_true(lmn_scene_part_at(s, 1, &part));
    assert_string_equal(part.name, "part-2");
    assert_int_equal(lmn_solid_remove(s, a, ROOT, &error), LMN_OK);
    assert_int_equal(lmn_scene_solid_count(s), 1);
    assert_int_equal(lmn_scene_solid_at(s, 0), b);
    assert_int_equal(lmn_scene_solid_at(s, 1), 0);
    assert_int_equal(lmn_scene_info_of(s).parts, 1);
    assert_int_equal(lmn_scene_info_of(s).meshes, 1);
    assert_true(lmn_scene_part_at(s, 0, &part));
    assert_string_equal(part.name, "part-1");
    REFUSED(s, lmn_solid_remove(s, a, ROOT, &error));
    assert_int_equal(lmn_scene_add_solid(s, "new", LMN_UNION, &c, &error), LMN_OK);
    assert_true(c != a && c != b);
    char *json = lmn_scene_info_json(s);
    assert_non_null(json);
    lmn_text_free(json);
    lmn_scene_destroy(&s);
}

static void meshes_are_shared_and_freed(void **state)
{
    (void)state;
    uint32_t   solid, copy;
    lmn_scene *s = with_solid(&solid, LMN_UNION);
    uint32_t   a = add(s, solid, ROOT, box(1));
    assert_int_equal(lmn_solid_add_copy(s, solid, ROOT, a, &copy, &error), LMN_OK);
    assert_int_equal(lmn_scene_info_of(s).meshes, 1);
    lmn_shape two = box(2);
    assert_int_equal(lmn_solid_set_shape(s, solid, a, &two, &error), LMN_OK);
    assert_int_equal(lmn_scene_info_of(s).meshes, 2);
    BOUNDS(s, solid, copy, 0, 0, 0, 1, 1, 1);
    BOUNDS(s, solid, a, 0, 0, 0, 2, 2, 2);
    for (int i = 0; i < 50; i++) {
        lmn_shape next = box(3 + i);
        assert_int_equal(lmn_solid_set_shape(s, solid, a, &next, &error), LMN_OK);
    }
    assert_int_equal(lmn_scene_info_of(s).meshes, 2);
    assert_true(s->mesh_count <= 3);
    assert_int_equal(lmn_solid_remove(s, solid, copy, &error), LMN_OK);
    assert_int_equal(lmn_scene_info_of(s).meshes, 1);
    add(s, solid, ROOT, box(1));
    assert_true(s->mesh_count <= 3);
    lmn_scene_destroy(&s);
}

static void bounds_follow_operations(void **state)
{
    (void)state;
    uint32_t   solid;
    lmn_scene *s = with_solid(&solid, LMN_UNION);
    uint32_t   a = add(s, solid, ROOT, box(2)), b = add(s, solid, ROOT, box(2));
    move_to(s, solid, b, 1, 0, 0);
    BOUNDS(s, solid, ROOT, 0, 0, 0, 3, 2, 2);
    assert_int_equal(lmn_solid_set_operation(s, solid, ROOT, LMN_INTERSECTION, &error), LMN_OK);
    BOUNDS(s, solid, ROOT, 1, 0, 0, 2, 2, 2);
    assert_int_equal(lmn_solid_set_operation(s, solid, ROOT, LMN_DIFFERENCE, &error), LMN_OK);
    BOUNDS(s, solid, ROOT, 0, 0, 0, 2, 2, 2);
    assert_int_equal(lmn_solid_move(s, solid, b, ROOT, a, &error), LMN_OK);
    BOUNDS(s, solid, ROOT, 1, 0, 0, 3, 2, 2);
    assert_int_equal(lmn_solid_set_operation(s, solid, ROOT, LMN_INTERSECTION, &error), LMN_OK);
    move_to(s, solid, b, 9, 0, 0);
    assert_true(info_of(s, solid, ROOT).is_empty);
    move_to(s, solid, ROOT, 0, 0, 10);
    move_to(s, solid, b, 1, 1, 1);
    BOUNDS(s, solid, ROOT, 1, 1, 11, 2, 2, 12);
    lmn_scene_info info = lmn_scene_info_of(s);
    assert_true(info.bounds_min[2] == 11 && info.bounds_max[2] == 12);
    lmn_scene_destroy(&s);
}

/* --- files ---------------------------------------------------------------------------------------------- */

static const char *cube_file(const char *name, bool whole)
{
    static const char text[] = "v 0 0 0\nv 1 0 0\nv 1 2 0\nv 0 2 0\nv 0 0 3\nv 1 0 3\nv 1 2 3\nv 0 2 3\n"
                               "f 4 3 2 1\nf 5 6 7 8\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n";
    return temp_file(name, text, sizeof text - (whole ? 1 : 11));
}

static void files_become_nodes(void **state)
{
    (void)state;
    static const char csg[] =
        "difference() { cube(size = [4, 4, 4], center = true); multmatrix([[1,0,0,1],[0,1,0,0],[0,0,1,0],[0,0,0,1]]) "
        "{ sphere($fn = 12, r = 2); } color([1, 0, 0, 1]) { sphere($fn = 12, r = 2); } }";
    uint32_t   solid, id;
    lmn_scene *s = with_solid(&solid, LMN_UNION);
    assert_int_equal(lmn_solid_add_file(s, solid, ROOT, cube_file("cube.obj", true), NULL, &id, &error), LMN_OK);
    assert_string_equal(info_of(s, solid, id).name, "cube");
    assert_int_equal(info_of(s, solid, id).triangles, 12);
    BOUNDS(s, solid, id, 0, -3, 0, 1, 0, 2); /* OBJ has y up, the scene z */
    assert_int_equal(s->warnings.count, 0);
    lmn_load_desc as_is = LMN_LOAD_DESC_INIT;
    as_is.up_axis = LMN_UP_Z;
    assert_int_equal(lmn_solid_add_file(s, solid, ROOT, cube_file("cube.obj", true), &as_is, &id, &error), LMN_OK);
    BOUNDS(s, solid, id, 0, 0, 0, 1, 2, 3);
    assert_int_equal(lmn_solid_add_file(s, solid, ROOT, cube_file("open.obj", false), NULL, &id, &error), LMN_OK);
    assert_int_equal(s->warnings.count, 1);
    assert_int_equal(s->warnings.items[0].code, WARNING_BAD_GEOMETRY);
    assert_int_equal(lmn_solid_add_file(s, solid, ROOT, temp_file("tree.csg", csg, sizeof csg - 1), NULL, &id, &error),
                     LMN_OK);
    BOUNDS(s, solid, id, -2, -2, -2, 2, 2, 2);
    lmn_solid_info top = info_of(s, solid, id), root = info_of(s, solid, top.first_child);
    assert_int_equal(top.operation, LMN_UNION);
    assert_string_equal(top.name, "tree");
    assert_int_equal(info_of(s, solid, root.first_child).operation, LMN_DIFFERENCE);
    assert_int_equal(lmn_scene_info_of(s).parts, 1);
    size_t meshes = lmn_scene_info_of(s).meshes;
    assert_int_equal(lmn_solid_remove(s, solid, id, &error), LMN_OK);
    assert_int_equal(lmn_scene_info_of(s).meshes, meshes - 2); /* both spheres are one */
    expect_refusal(s, remember(s), lmn_solid_add_file(s, solid, ROOT, "/nowhere/x.stl", NULL, NULL, &error), LMN_READ,
                   false);
    REFUSED_PLAINLY(s, lmn_solid_add_file(s, solid, ROOT, "", NULL, NULL, &error));
    lmn_load_desc wrong = LMN_LOAD_DESC_INIT;
    wrong.struct_size = 0;
    REFUSED(s, lmn_solid_add_file(s, solid, ROOT, "x.stl", &wrong, NULL, &error));
    lmn_scene_destroy(&s);
}

/* Solids of files are like any other, and files may come later. */
static void solids_of_files_are_edited(void **state)
{
    (void)state;
    static const char csg[] =
        "union() { cube(size = [1, 1, 1], center = false); cube(size = [2, 1, 1], center = false); }";
    uint32_t   solid;
    lmn_scene *s = with_solid(&solid, LMN_UNION);
    add(s, solid, ROOT, box(1));
    assert_int_equal(lmn_scene_add_file(s, temp_file("later.csg", csg, sizeof csg - 1), NULL, &error), LMN_OK);
    assert_int_equal(lmn_scene_add_file(s, cube_file("mesh.obj", true), NULL, &error), LMN_OK);
    assert_int_equal(lmn_scene_solid_count(s), 2);
    uint32_t other = lmn_scene_solid_at(s, 1);
    uint32_t first = info_of(s, other, ROOT).first_child;
    assert_int_equal(info_of(s, other, ROOT).part, 2);
    assert_int_equal(lmn_scene_info_of(s).parts, 3);
    move_to(s, other, info_of(s, other, first).next_sibling ? first : ROOT, 0, 0, 7);
    lmn_part_info part;
    assert_true(lmn_scene_part_at(s, 1, &part));
    assert_true(part.bounds_max[2] == 8);
    assert_int_equal(lmn_solid_remove(s, other, ROOT, &error), LMN_OK);
    assert_int_equal(lmn_scene_info_of(s).parts, 2);
    assert_true(lmn_scene_part_at(s, 1, &part));
    assert_string_equal(part.name, "mesh");
    assert_true(part.bounds_min[1] == -3); /* turned to the scene's up axis */
    lmn_scene_destroy(&s);
}

/* --- memory --------------------------------------------------------------------------------------------- */

typedef lmn_status (*edit)(lmn_scene *s, uint32_t solid, const uint32_t *ids);

static lmn_status edit_add(lmn_scene *s, uint32_t solid, const uint32_t *ids)
{
    lmn_shape shape = lmn_shape_sphere(2);
    (void)ids;
    return lmn_solid_add_shape(s, solid, ROOT, &shape, NULL, &error);
}

static lmn_status edit_fill(lmn_scene *s, uint32_t solid, const uint32_t *ids)
{
    lmn_shape shape = box(2);
    (void)ids;
    return lmn_solid_add_shape(s, solid + 1, ROOT, &shape, NULL, &error); /* the empty one becomes a part */
}

static lmn_status edit_shape(lmn_scene *s, uint32_t solid, const uint32_t *ids)
{
    lmn_shape shape = box(2);
    return lmn_solid_set_shape(s, solid, ids[0], &shape, &error);
}

static lmn_status edit_copy(lmn_scene *s, uint32_t solid, const uint32_t *ids)
{
    return lmn_solid_add_copy(s, solid, ROOT, ids[1], NULL, &error);
}

static lmn_status edit_move(lmn_scene *s, uint32_t solid, const uint32_t *ids)
{
    return lmn_solid_move(s, solid, ids[1], ids[2], 0, &error);
}

static lmn_status edit_remove(lmn_scene *s, uint32_t solid, const uint32_t *ids)
{
    return lmn_solid_remove(s, solid, ids[1], &error);
}

static lmn_status edit_remove_all(lmn_scene *s, uint32_t solid, const uint32_t *ids)
{
    (void)ids;
    return lmn_solid_remove(s, solid, ROOT, &error);
}

static lmn_status edit_name(lmn_scene *s, uint32_t solid, const uint32_t *ids)
{
    (void)ids;
    return lmn_solid_set_name(s, solid, ROOT, "another", &error);
}

static lmn_status edit_create(lmn_scene *s, uint32_t solid, const uint32_t *ids)
{
    (void)solid, (void)ids;
    return lmn_scene_add_solid(s, "third", LMN_UNION, NULL, &error);
}

static lmn_status edit_file(lmn_scene *s, uint32_t solid, const uint32_t *ids)
{
    char path[256];
    (void)ids;
    snprintf(path, sizeof path, "%s/small.csg", temp_folder());
    return lmn_solid_add_file(s, solid, ROOT, path, NULL, NULL, &error);
}

static void failing_edits_change_nothing(void **state)
{
    (void)state;
    static const edit edits[] = {edit_add,    edit_fill,       edit_shape, edit_copy,   edit_move,
                                 edit_remove, edit_remove_all, edit_name,  edit_create, edit_file};
    static const char csg[] = "union() { cube(size = [1, 1, 1], center = false); sphere($fn = 6, r = 2); }";
    temp_file("small.csg", csg, sizeof csg - 1);
    for (size_t e = 0; e < sizeof edits / sizeof *edits; e++) {
        uint32_t   solid, other, ids[3];
        lmn_scene *s = with_solid(&solid, LMN_UNION);
        assert_int_equal(lmn_scene_add_solid(s, "empty", LMN_UNION, &other, &error), LMN_OK);
        ids[0] = add(s, solid, ROOT, box(1));
        ids[1] = operation(s, solid, ROOT, LMN_DIFFERENCE);
        add(s, solid, ids[1], box(3));
        ids[2] = operation(s, solid, ROOT, LMN_UNION);
        lmn_status status = LMN_MEMORY;
        int        failures = 0;
        for (long n = 1; status != LMN_OK && n < 5000; n += n < 60 ? 1 : 7) {
            memory before = remember(s);
            mem_fail_at(n);
            status = edits[e](s, solid, ids);
            mem_fail_at(0);
            if (status == LMN_OK) {
                lmn_text_free(before.json);
                break;
            }
            assert_int_equal(status, LMN_MEMORY);
            expect_unchanged(s, &before);
            failures++;
        }
        assert_int_equal(status, LMN_OK);
        assert_true(failures > 0);
        lmn_scene_destroy(&s);
    }
}

/* What is taken away is a companion that no function shows, and it follows the edits. */
static void ghosts_follow_edits(void **state)
{
    (void)state;
    uint32_t   solid;
    lmn_scene *s = with_solid(&solid, LMN_DIFFERENCE);
    add(s, solid, ROOT, box(4));
    assert_int_equal(s->ghost_count, 0);
    uint32_t bore = add(s, solid, ROOT, box(2));
    assert_int_equal(s->ghost_count, 1);
    assert_int_equal(s->parts[1].triangles, 12);
    move_to(s, solid, bore, 1, 0, 0);
    assert_true(s->parts[1].bounds.max.x > s->parts[1].bounds.max.y);
    assert_int_equal(lmn_scene_solid_count(s), 1);
    assert_int_equal(lmn_scene_info_of(s).parts, 1);
    assert_int_equal(lmn_solid_set_operation(s, solid, ROOT, LMN_UNION, &error), LMN_OK);
    assert_int_equal(s->ghost_count, 0);
    assert_int_equal(lmn_solid_set_operation(s, solid, ROOT, LMN_DIFFERENCE, &error), LMN_OK);
    assert_int_equal(s->ghost_count, 1);
    assert_int_equal(lmn_solid_remove(s, solid, ROOT, &error), LMN_OK);
    assert_int_equal(s->ghost_count, 0);
    assert_int_equal(s->part_count, 0);
    lmn_scene_destroy(&s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(parts_follow_triangles),
        cmocka_unit_test(shapes_have_their_sizes),
        cmocka_unit_test(polyhedra_run_either_way),
        cmocka_unit_test(wrong_sizes_are_refused),
        cmocka_unit_test(wrong_matrices_and_colours_are_refused),
        cmocka_unit_test(wrong_ids_are_refused),
        cmocka_unit_test(limits_hold),
        cmocka_unit_test(trees_are_edited),
        cmocka_unit_test(removed_solids_are_gone),
        cmocka_unit_test(meshes_are_shared_and_freed),
        cmocka_unit_test(bounds_follow_operations),
        cmocka_unit_test(files_become_nodes),
        cmocka_unit_test(solids_of_files_are_edited),
        cmocka_unit_test(failing_edits_change_nothing),
        cmocka_unit_test(ghosts_follow_edits),
    };
    return cmocka_run_group_tests(tests, NULL, remove_temp_folder);
}
