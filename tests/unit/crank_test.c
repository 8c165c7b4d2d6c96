/* examples/crank.glb and examples/knot.glb are what they say: closed parts, wound the right way round, that are
 * where a crank drive has them; a tube without a seam whose normals and texture coordinates follow it. */
#include <math.h>

#include "closed_parts.h"

static lmn_scene *crank, *knot;

static int load_models(void **state)
{
    (void)state;
    crank = load_or_fail(LIMNER_SOURCE_DIR "/examples/crank.glb");
    knot = load_or_fail(LIMNER_SOURCE_DIR "/examples/knot.glb");
    return 0;
}

static int unload_models(void **state)
{
    (void)state;
    lmn_scene_destroy(&crank);
    lmn_scene_destroy(&knot);
    return 0;
}

static void crank_has_its_parts(void **state)
{
    static const char *const names[] = {"Crankshaft",
                                        "Flywheel",
                                        "Flywheel bolts",
                                        "Timing gear",
                                        "Pulley",
                                        "Nose bolt",
                                        "Bed",
                                        "Pedestal 1",
                                        "Pedestal 5",
                                        "Bearing cap 1",
                                        "Bearing cap 5",
                                        "Connecting rod 1",
                                        "Connecting rod 4",
                                        "Rod cap 4",
                                        "Piston 1",
                                        "Piston 4",
                                        "Piston rings 2",
                                        "Gudgeon pin 3"};
    (void)state;
    assert_int_equal(crank->part_count, 37);
    assert_int_equal(crank->warnings.count, 0);
    assert_in_range(lmn_scene_info_of(crank).triangles, 20000, 60000);
    for (size_t n = 0; n < sizeof names / sizeof *names; n++)
        assert_one_part(crank, names[n]);
    assert_closed(crank);
}

static double volume_of(const primitive *p)
{
    double volume = 0;
    for (uint32_t i = 0; i < p->index_count; i += 3) {
        vec3 a = p->positions[p->indices[i]], b = p->positions[p->indices[i + 1]], c = p->positions[p->indices[i + 2]];
        volume += ((double)a.x * (b.y * c.z - b.z * c.y) + (double)a.y * (b.z * c.x - b.x * c.z) +
                   (double)a.z * (b.x * c.y - b.y * c.x)) /
                  6;
    }
    return volume;
}

/* What encloses too little, or is wound the wrong way round, would weigh nothing. */
static void crank_parts_enclose_material(void **state)
{
    (void)state;
    for (size_t i = 0; i < crank->mesh_count; i++) {
        double volume = volume_of(crank->meshes[i].primitives);
        if (volume < 2e-6 || volume > 8e-3)
            print_error("mesh %zu: %g m³\n", i, volume);
        assert_true(volume > 2e-6 && volume < 8e-3);
    }
}

/* Pistons of one throw are equally high, and no piston touches the bed. */
static void pistons_follow_the_cranks(void **state)
{
    double height[4] = {0};
    (void)state;
    for (size_t i = 0; i < crank->part_count; i++)
        for (int k = 0; k < 4; k++) {
            char name[16];
            snprintf(name, sizeof name, "Piston %d", k + 1);
            if (strcmp(crank->parts[i].name, name) == 0)
                height[k] = node_place_of(&crank->nodes[crank->parts[i].node])->translation[1];
        }
    assert_float_equal(height[0], height[3], 1e-9);
    assert_float_equal(height[1], height[2], 1e-9);
    assert_true(height[0] - height[1] > 0.05 && height[0] - height[1] < 0.084);
}

static int compare_positions(const void *a, const void *b)
{
    return memcmp(a, b, 6 * sizeof(float));
}

static void knot_is_one_smooth_tube(void **state)
{
    const primitive *p = knot->meshes[0].primitives;
    (void)state;
    assert_int_equal(knot->part_count, 1);
    assert_int_equal(knot->warnings.count, 0);
    assert_int_equal(p->index_count / 3, 560 * 32 * 2);
    /* In the mesh's own unit, 1.75 times the scene's: the section's area times the length of its middle. */
    double volume = volume_of(p) * 1.75 * 1.75 * 1.75, wanted = 3.14159 * 0.215 * 0.2 * 14.99;
    assert_true(fabs(volume / wanted - 1) < 0.01);
    assert_non_null(p->normals);
    for (uint32_t i = 0; i < p->vertex_count; i++) {
        vec3 n = p->normals[i];
        assert_float_equal(sqrt((double)n.x * n.x + (double)n.y * n.y + (double)n.z * n.z), 1, 1e-3);
    }
    for (uint32_t i = 0; i < p->index_count; i += 3) { /* normals are those of the triangles, roughly */
        vec3 a = p->positions[p->indices[i]], b = p->positions[p->indices[i + 1]], c = p->positions[p->indices[i + 2]],
             n = p->normals[p->indices[i]];
        double u[3] = {b.x - a.x, b.y - a.y, b.z - a.z}, v[3] = {c.x - a.x, c.y - a.y, c.z - a.z};
        double f[3] = {u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]};
        double length = sqrt(f[0] * f[0] + f[1] * f[1] + f[2] * f[2]);
        assert_true(f[0] * n.x + f[1] * n.y + f[2] * n.z > 0.95 * length);
    }
}

/* Each position of the seams is there with both ends of the texture coordinate, and with one normal. */
static void knot_comes_round_to_itself(void **state)
{
    const primitive *p = knot->meshes[0].primitives;
    size_t           doubles = 0;
    (void)state;
    float(*positions)[6] = mem_alloc(p->vertex_count * sizeof *positions);
    assert_non_null(positions);
    for (uint32_t i = 0; i < p->vertex_count; i++) {
        memcpy(positions[i], &p->positions[i], 3 * sizeof(float));
        memcpy(positions[i] + 3, &p->normals[i], 3 * sizeof(float));
    }
    qsort(positions, p->vertex_count, sizeof *positions, compare_positions);
    for (uint32_t i = 1; i < p->vertex_count; i++)
        doubles += compare_positions(positions[i - 1], positions[i]) == 0;
    mem_free(positions);
    assert_int_equal(doubles, 560 + 32 + 1);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(crank_has_its_parts),        cmocka_unit_test(crank_parts_enclose_material),
        cmocka_unit_test(pistons_follow_the_cranks),  cmocka_unit_test(knot_is_one_smooth_tube),
        cmocka_unit_test(knot_comes_round_to_itself),
    };
    return cmocka_run_group_tests(tests, load_models, unload_models);
}
