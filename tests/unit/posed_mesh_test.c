/* Meshes as they are drawn: a mesh without normals that a pose bends has those of the mesh that it has become; and what
 * is kept from pose to pose changes nothing. */
#include "import_support.h"

#include <math.h>

#include "pose/pose.h"
#include "pose/posed_mesh.h"

#define CREASE 0.7

static bool same_floats(const float *a, const float *b, size_t count)
{
    for (size_t i = 0; i < count; i++)
        if (!(a[i] == b[i]))
            return false;
    return true;
}

static void assert_same(const vertex_arrays *a, const vertex_arrays *b)
{
    assert_int_equal(a->vertex_count, b->vertex_count);
    assert_int_equal(a->index_count, b->index_count);
    assert_memory_equal(a->indices, b->indices, a->index_count * sizeof *a->indices);
    assert_true(same_floats(a->positions, b->positions, 3 * (size_t)a->vertex_count));
    assert_true(same_floats(a->normals, b->normals, 3 * (size_t)a->vertex_count));
}

/* The primitive with the vertices of a pose, and nothing that bends it. Positions: free with free. */
static primitive bake(const primitive *p, const part_pose *pose)
{
    primitive out = *p;
    out.positions = malloc(p->vertex_count * sizeof *out.positions);
    mesh_pose(p, pose->weights, pose->weight_count, pose->joints, pose->joint_count, NULL, NULL, p->vertex_count,
              out.positions, NULL);
    out.morphs = NULL;
    out.morph_count = 0;
    out.joints = NULL;
    out.weights = NULL;
    return out;
}

/* Posed, posed again with what is kept, and modelled so, a primitive is drawn with the same vertices. */
static void compare_with_baked(const primitive *p, const part_pose *pose, corner_groups *kept)
{
    static const part_pose none = {.joints = NULL};
    lmn_error              error = {0};
    primitive              baked = bake(p, pose);
    posed_mesh             posed, again, model;
    assert_int_equal(posed_make(&posed, p, CREASE, pose, &error), LMN_OK);
    assert_int_equal(posed_make_keeping(&again, p, CREASE, pose, kept, &error), LMN_OK);
    assert_int_equal(posed_make(&model, &baked, CREASE, &none, &error), LMN_OK);
    assert_same(&posed.data, &model.data);
    assert_same(&again.data, &model.data);
    posed_release(&posed);
    posed_release(&again);
    posed_release(&model);
    free(baked.positions);
}

/* --- morphs --------------------------------------------------------------------------------------------- */

enum { ROWS = 9, VERTICES = ROWS * ROWS, CORNERS = 6 * (ROWS - 1) * (ROWS - 1) };

typedef struct sheet {
    vec3         positions[VERTICES], offsets[VERTICES];
    uint32_t     indices[CORNERS];
    morph_target morph;
    primitive    primitive;
} sheet;

/* A flat square, and a morph that folds its halves upwards. */
static void make_sheet(sheet *s)
{
    uint32_t n = 0;
    for (uint32_t i = 0; i < VERTICES; i++) {
        float x = (float)(i % ROWS) - (ROWS - 1) / 2.0f, y = (float)(i / ROWS);
        s->positions[i] = (vec3){x, y, 0};
        s->offsets[i] = (vec3){0, 0, fabsf(x)};
    }
    for (uint32_t y = 0; y + 1 < ROWS; y++)
        for (uint32_t x = 0; x + 1 < ROWS; x++) {
            uint32_t a = y * ROWS + x, quad[6] = {a, a + 1, a + ROWS, a + 1, a + ROWS + 1, a + ROWS};
            memcpy(&s->indices[n], quad, sizeof quad);
            n += 6;
        }
    s->morph = (morph_target){s->offsets, NULL};
    s->primitive = (primitive){.vertex_count = VERTICES,
                               .index_count = CORNERS,
                               .positions = s->positions,
                               .indices = s->indices,
                               .morphs = &s->morph,
                               .morph_count = 1};
}

static void folds_have_their_own_normals(void **state)
{
    (void)state;
    static const float weights[] = {0, 0.2f, 1, 0.6f, 0};
    sheet              s;
    corner_groups      kept = {NULL};
    make_sheet(&s);
    for (size_t i = 0; i < sizeof weights / sizeof *weights; i++) {
        part_pose pose = {.weights = &weights[i], .weight_count = 1};
        compare_with_baked(&s.primitive, &pose, &kept);
    }
    /* Folded by 45 degrees on either side, the middle is a crease, and both of its sides lean. */
    lmn_error  error = {0};
    posed_mesh posed;
    part_pose  pose = {.weights = &weights[2], .weight_count = 1};
    assert_int_equal(posed_make(&posed, &s.primitive, CREASE, &pose, &error), LMN_OK);
    assert_int_equal(posed.data.vertex_count, VERTICES + ROWS);
    for (uint32_t i = 0; i < posed.data.vertex_count; i++)
        assert_true(fabs((double)posed.data.normals[3 * (size_t)i + 2] - sqrt(0.5)) < 1e-6);
    posed_release(&posed);
    corner_groups_release(&kept);
}

/* What is one point at rest may be far apart: corners belong together where they are. */
static void what_opens_is_grouped_anew(void **state)
{
    (void)state;
    const float   all = 1;
    sheet         s;
    corner_groups kept = {NULL};
    make_sheet(&s);
    for (uint32_t i = 0; i < VERTICES; i++) {
        float x = s.positions[i].x; /* a gutter, so that faces near each other differ less than faces far apart */
        s.offsets[i] = (vec3){x, s.positions[i].y, 0.05f * x * x};
        s.positions[i] = (vec3){0, 0, 0};
    }
    compare_with_baked(&s.primitive, &(part_pose){.weights = &all, .weight_count = 1}, &kept);
    corner_groups_release(&kept);
}

/* --- files ---------------------------------------------------------------------------------------------- */

static lmn_scene *fox(void)
{
    return load_or_fail(LIMNER_SOURCE_DIR "/examples/fox.glb");
}

static void skins_have_their_own_normals(void **state)
{
    (void)state;
    lmn_scene    *s = fox();
    lmn_error     error = {0};
    corner_groups kept = {NULL};
    assert_null(s->meshes[0].primitives[0].normals);
    for (int k = 0; k < 4; k++) {
        moment m;
        pose   p;
        assert_int_equal(moment_find(&m, s, "Run", 0.05 + 0.2 * k, NULL, &error), LMN_OK);
        assert_int_equal(pose_create(&p, s, &m, &error), LMN_OK);
        compare_with_baked(&s->meshes[0].primitives[0], &p.parts[0], &kept);
        pose_release(&p);
    }
    corner_groups_release(&kept);
    lmn_scene_destroy(&s);
}

static void add_normals(primitive *p)
{
    p->normals = mem_calloc(p->vertex_count, sizeof *p->normals);
    for (uint32_t i = 0; i < p->vertex_count; i++)
        p->normals[i] = i % 2 ? (vec3){0, 1, 0} : (vec3){0, 0, 1};
}

/* The vertices of a pose with what it has kept, and without. */
static void compare_with_unkept(const primitive *p, const part_pose *pose, bool expect_known)
{
    lmn_error  error = {0};
    part_pose  bare = *pose;
    posed_mesh kept, made;
    bare.posed = NULL;
    bare.primitive_count = 0;
    assert_true((pose_vertices_of(pose, p) != NULL) == expect_known);
    assert_int_equal(posed_make(&kept, p, CREASE, pose, &error), LMN_OK);
    assert_int_equal(posed_make(&made, p, CREASE, &bare, &error), LMN_OK);
    assert_same(&kept.data, &made.data);
    vec3 *positions = posed_positions(p, pose, &kept.split);
    assert_true(same_floats((const float *)positions, made.data.positions, 3 * (size_t)made.data.vertex_count));
    mem_free(positions);
    posed_release(&kept);
    posed_release(&made);
}

static void assert_same_pose(const pose *a, const pose *b)
{
    assert_true(moment_equal(&a->when, &b->when));
    assert_memory_equal(a->worlds, b->worlds, a->scene->node_count * sizeof *a->worlds);
    assert_memory_equal(a->part_boxes, b->part_boxes, a->part_count * sizeof *a->part_boxes);
    assert_true((a->at_rest != NULL) == (b->at_rest != NULL));
}

/* With normals and without, moved on from another moment or made for this one. */
static void kept_vertices_are_those_of_the_pose(void **state)
{
    (void)state;
    for (int with = 0; with < 2; with++) {
        lmn_scene *s = fox();
        primitive *p = &s->meshes[0].primitives[0];
        lmn_error  error = {0};
        pose       moving, fresh;
        moment     m = moment_at_rest();
        if (with)
            add_normals(p);
        assert_int_equal(pose_create(&moving, s, &m, &error), LMN_OK);
        compare_with_unkept(p, &moving.parts[0], false);
        for (int k = 0; k < 3; k++) {
            assert_int_equal(moment_find(&m, s, k == 1 ? "Walk" : "Run", 0.1 + 0.1 * k, NULL, &error), LMN_OK);
            assert_int_equal(pose_move(&moving, &m, &error), LMN_OK);
            assert_int_equal(pose_create(&fresh, s, &m, &error), LMN_OK);
            assert_same_pose(&moving, &fresh);
            compare_with_unkept(p, &moving.parts[0], true);
            pose_release(&fresh);
        }
        /* Where a clip moves nothing, nothing is posed for boxes: what was kept of the moment before does not count. */
        size_t channels = s->animations[1].channel_count;
        s->animations[1].channel_count = 0;
        assert_int_equal(moment_find(&m, s, "Walk", 0.1, NULL, &error), LMN_OK);
        assert_int_equal(pose_move(&moving, &m, &error), LMN_OK);
        compare_with_unkept(p, &moving.parts[0], false);
        s->animations[1].channel_count = channels;
        m = moment_at_rest();
        assert_int_equal(pose_move(&moving, &m, &error), LMN_OK);
        compare_with_unkept(p, &moving.parts[0], false);
        pose_release(&moving);
        lmn_scene_destroy(&s);
    }
}

/* A part that is brought back to another pose has that one's vertices. */
static void held_parts_forget(void **state)
{
    (void)state;
    lmn_scene *s = fox();
    primitive *p = &s->meshes[0].primitives[0];
    lmn_error  error = {0};
    pose       held, moving;
    moment     m;
    bool       moves[1] = {false};
    assert_int_equal(s->part_count, 1);
    assert_int_equal(moment_find(&m, s, "Run", 0.1, NULL, &error), LMN_OK);
    assert_int_equal(pose_create(&held, s, &m, &error), LMN_OK);
    m.seconds = 0.3;
    assert_int_equal(pose_create(&moving, s, &m, &error), LMN_OK);
    pose_hold(&moving, &held, moves);
    compare_with_unkept(p, &moving.parts[0], false);
    pose_release(&moving);
    pose_release(&held);
    lmn_scene_destroy(&s);
}

static void failing_memory_is_reported(void **state)
{
    (void)state;
    static const float half = 0.5f;
    sheet              s;
    lmn_error          error = {0};
    part_pose          pose = {.weights = &half, .weight_count = 1};
    make_sheet(&s);
    for (long n = 1;; n++) {
        posed_mesh    posed;
        corner_groups kept = {NULL};
        mem_fail_at(n);
        lmn_status status = posed_make_keeping(&posed, &s.primitive, CREASE, &pose, &kept, &error);
        mem_fail_at(0);
        posed_release(&posed);
        corner_groups_release(&kept);
        if (status == LMN_OK)
            break;
        assert_int_equal(status, LMN_MEMORY);
        assert_true(n < 100);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(folds_have_their_own_normals),
        cmocka_unit_test(what_opens_is_grouped_anew),
        cmocka_unit_test(skins_have_their_own_normals),
        cmocka_unit_test(kept_vertices_are_those_of_the_pose),
        cmocka_unit_test(held_parts_forget),
        cmocka_unit_test(failing_memory_is_reported),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
