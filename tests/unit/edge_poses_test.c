/* Edges of poses: judged anew on the topology of the mesh at rest they are those of the mesh that was sorted anew. */
#include "import_support.h"

#include "pose/pose.h"
#include "stroke/edges.h"
#include "stroke/stroke.h"

#define CREASE 0.6

static void assert_same_edges(const edge_mesh *a, const edge_mesh *b)
{
    assert_int_equal(a->vertex_count, b->vertex_count);
    assert_int_equal(a->face_count, b->face_count);
    assert_int_equal(a->edge_count, b->edge_count);
    assert_int_equal(a->piece_count, b->piece_count);
    assert_int_equal(a->all_edges, b->all_edges);
    assert_int_equal(a->loose_edges, b->loose_edges);
    assert_memory_equal(a->positions, b->positions, a->vertex_count * sizeof *a->positions);
    assert_memory_equal(a->faces, b->faces, a->face_count * sizeof *a->faces);
    assert_memory_equal(a->normals, b->normals, a->face_count * sizeof *a->normals);
    assert_memory_equal(a->edges, b->edges, a->edge_count * sizeof *a->edges);
    assert_memory_equal(a->pieces, b->pieces, a->face_count * sizeof *a->pieces);
    assert_memory_equal(a->closed, b->closed, a->piece_count * sizeof *a->closed);
    assert_memory_equal(a->inward, b->inward, a->piece_count * sizeof *a->inward);
    assert_memory_equal(a->boxes, b->boxes, a->piece_count * sizeof *a->boxes);
    assert_true((a->materials != NULL) == (b->materials != NULL) && (a->said != NULL) == (b->said != NULL));
}

static void poses_have_the_edges_of_models(void **state)
{
    (void)state;
    lmn_scene     *s = load_or_fail(LIMNER_SOURCE_DIR "/examples/fox.glb");
    const mesh    *m = &s->meshes[0];
    lmn_error      error = {0};
    edge_topology *t = NULL;
    assert_int_equal(edge_topology_create(&t, m, &error), LMN_OK);
    assert_true(edge_topology_revision(t) == m->revision);
    for (int k = 0; k < 5; k++) {
        moment    when;
        pose      p;
        edge_mesh posed, sorted;
        bool      fits;
        assert_int_equal(moment_find(&when, s, k % 2 ? "Walk" : "Run", 0.13 * k, NULL, &error), LMN_OK);
        assert_int_equal(pose_create(&p, s, &when, &error), LMN_OK);
        const vec3 *positions = pose_vertices_of(&p.parts[0], &m->primitives[0])->positions;
        assert_int_equal(edge_mesh_pose(&posed, t, positions, CREASE, &fits, &error), LMN_OK);
        assert_true(fits);
        assert_int_equal(edge_mesh_create(&sorted, m, positions, CREASE, &error), LMN_OK);
        assert_true(sorted.edge_count > 100);
        assert_same_edges(&posed, &sorted);
        edge_mesh_release(&posed);
        edge_mesh_release(&sorted);
        pose_release(&p);
    }
    edge_topology_destroy(&t);
    lmn_scene_destroy(&s);
}

/* Two triangles with a common edge, whose vertices are there twice. */
static vec3     corners[6] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
static uint32_t triangles[6] = {0, 1, 2, 3, 4, 5};

static bool fits_after(size_t vertex, vec3 position, bool at_rest)
{
    lmn_error      error = {0};
    vec3           moved[6], rest[6];
    edge_topology *t = NULL;
    edge_mesh      out;
    bool           fits = false;
    memcpy(moved, corners, sizeof moved);
    memcpy(rest, corners, sizeof rest);
    (at_rest ? rest : moved)[vertex] = position;
    primitive p = {.vertex_count = 6, .index_count = 6, .positions = rest, .indices = triangles, .material = NONE};
    mesh      m = {.primitives = &p, .primitive_count = 1};
    assert_int_equal(edge_topology_create(&t, &m, &error), LMN_OK);
    assert_int_equal(edge_mesh_pose(&out, t, moved, CREASE, &fits, &error), LMN_OK);
    if (fits) {
        edge_mesh sorted;
        assert_int_equal(edge_mesh_create(&sorted, &m, moved, CREASE, &error), LMN_OK);
        assert_same_edges(&out, &sorted);
        edge_mesh_release(&sorted);
    }
    edge_mesh_release(&out);
    edge_topology_destroy(&t);
    return fits;
}

static void other_topologies_do_not_fit(void **state)
{
    (void)state;
    assert_true(fits_after(0, (vec3){0, 0, 1}, false));       /* bends */
    assert_false(fits_after(1, (vec3){1, 0, 1}, false));      /* tears */
    assert_false(fits_after(0, (vec3){2, -1, 0}, false));     /* loses its area */
    assert_false(fits_after(0, (vec3){0.5f, 0.5f, 0}, true)); /* has none at rest */
}

static void failing_memory_is_reported(void **state)
{
    (void)state;
    lmn_error error = {0};
    primitive p = {.vertex_count = 6, .index_count = 6, .positions = corners, .indices = triangles, .material = NONE};
    mesh      m = {.primitives = &p, .primitive_count = 1};
    for (long n = 1;; n++) {
        edge_topology *t = NULL;
        edge_mesh      out = {.positions = NULL};
        bool           fits = false;
        mem_fail_at(n);
        lmn_status status = edge_topology_create(&t, &m, &error);
        if (status == LMN_OK)
            status = edge_mesh_pose(&out, t, corners, CREASE, &fits, &error);
        mem_fail_at(0);
        edge_mesh_release(&out);
        edge_topology_destroy(&t);
        if (status == LMN_OK)
            break;
        assert_int_equal(status, LMN_MEMORY);
        assert_true(n < 100);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(poses_have_the_edges_of_models),
        cmocka_unit_test(other_topologies_do_not_fit),
        cmocka_unit_test(failing_memory_is_reported),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
