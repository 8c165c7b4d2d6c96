/* examples/pump.glb is what it says: closed parts that stand for solids, none of which cuts into another or is
 * inside of its material. Looks that see through, and sections even more, show every mistake in that. */
#include <math.h>

#include "closed_parts.h"

typedef struct corner3 {
    double x, y, z;
} corner3;

/* A part's triangles in the pump's position. */
typedef struct solid {
    const char *name;
    size_t      count; /* of triangles */
    corner3 (*triangles)[3];
    double low[3], high[3];
} solid;

static lmn_scene *scene;
static solid     *solids;

static void position_of(int32_t at, double offset[3])
{
    for (; at != NONE; at = scene->nodes[at].parent)
        for (int k = 0; k < 3; k++)
            offset[k] += node_place_of(&scene->nodes[at])->translation[k];
}

static solid solid_of_part(const part *p)
{
    const primitive *shape = scene->meshes[scene->nodes[p->node].mesh].primitives;
    solid            s = {p->name, shape->index_count / 3, NULL, {1, 1, 1}, {-1, -1, -1}};
    double           offset[3] = {0};
    position_of(p->node, offset);
    s.triangles = mem_alloc(s.count * sizeof *s.triangles);
    assert_non_null(s.triangles);
    for (uint32_t i = 0; i < shape->index_count; i++) {
        vec3   v = shape->positions[shape->indices[i]];
        double at[3] = {(double)v.x + offset[0], (double)v.y + offset[1], (double)v.z + offset[2]};
        s.triangles[i / 3][i % 3] = (corner3){at[0], at[1], at[2]};
        for (int k = 0; k < 3; k++) {
            s.low[k] = fmin(s.low[k], at[k]);
            s.high[k] = fmax(s.high[k], at[k]);
        }
    }
    return s;
}

static int load_pump(void **state)
{
    (void)state;
    scene = load_or_fail(LIMNER_SOURCE_DIR "/examples/pump.glb");
    solids = mem_calloc(scene->part_count, sizeof *solids);
    assert_non_null(solids);
    for (size_t i = 0; i < scene->part_count; i++)
        solids[i] = solid_of_part(&scene->parts[i]);
    return 0;
}

static int unload_pump(void **state)
{
    (void)state;
    for (size_t i = 0; i < scene->part_count; i++)
        mem_free(solids[i].triangles);
    mem_free(solids);
    lmn_scene_destroy(&scene);
    return 0;
}

static void has_its_parts(void **state)
{
    static const char *const names[] = {"Housing",    "Gasket",       "Cover",        "Drive shaft", "Drive gear",
                                        "Gear key",   "Coupling",     "Coupling key", "Idler shaft", "Idler gear",
                                        "Seal",       "Bush 1",       "Bush 4",       "Bolt 1",      "Bolt 6",
                                        "Valve ball", "Valve spring", "Valve plug"};
    (void)state;
    assert_int_equal(scene->part_count, 24);
    assert_int_equal(scene->warnings.count, 0);
    assert_int_equal(scene->animation_count, 1);
    for (size_t n = 0; n < sizeof names / sizeof *names; n++)
        assert_one_part(scene, names[n]);
    lmn_scene_info      info = lmn_scene_info_of(scene);
    static const double low[3] = {-0.056, -0.066, -0.0305}, high[3] = {0.056, 0.0565, 0.098};
    for (int k = 0; k < 3; k++) {
        assert_float_equal(info.bounds_min[k], low[k], 1e-5);
        assert_float_equal(info.bounds_max[k], high[k], 1e-5);
    }
    assert_in_range(info.triangles, 15000, 60000);
}

static void parts_are_closed(void **state)
{
    (void)state;
    assert_closed(scene);
}

static corner3 minus(corner3 a, corner3 b)
{
    return (corner3){a.x - b.x, a.y - b.y, a.z - b.z};
}

static double triple(corner3 a, corner3 b, corner3 c)
{
    return a.x * (b.y * c.z - b.z * c.y) + a.y * (b.z * c.x - b.x * c.z) + a.z * (b.x * c.y - b.y * c.x);
}

/* Wound the right way round: what a part encloses is positive, and a steel one of it has a believable weight. */
static void parts_enclose_material(void **state)
{
    double all = 0;
    (void)state;
    for (size_t i = 0; i < scene->part_count; i++) {
        double volume = 0;
        for (size_t t = 0; t < solids[i].count; t++)
            volume += triple(solids[i].triangles[t][0], solids[i].triangles[t][1], solids[i].triangles[t][2]) / 6;
        assert_true(volume > 1e-7 && volume < 3e-4); /* m³ */
        all += volume;
    }
    assert_true(all > 4e-4 && all < 8e-4);
}

/* Does the line from p along d pass the triangle before its end? Ends at p + d; `reach` lengthens it. */
static bool passes(corner3 p, corner3 d, double reach, const corner3 t[3])
{
    corner3 a = minus(t[0], p), b = minus(t[1], p), c = minus(t[2], p);
    double  u = triple(d, b, c), v = triple(d, c, a), w = triple(d, a, b);
    if ((u < 0 || v < 0 || w < 0) && (u > 0 || v > 0 || w > 0))
        return false;
    double sum = u + v + w, at = triple(a, b, c);
    return sum != 0 && at / sum >= 0 && at / sum <= reach;
}

static bool triangle_outside(const corner3 t[3], const double low[3], const double high[3])
{
    return (t[0].x < low[0] && t[1].x < low[0] && t[2].x < low[0]) ||
           (t[0].x > high[0] && t[1].x > high[0] && t[2].x > high[0]) ||
           (t[0].y < low[1] && t[1].y < low[1] && t[2].y < low[1]) ||
           (t[0].y > high[1] && t[1].y > high[1] && t[2].y > high[1]) ||
           (t[0].z < low[2] && t[1].z < low[2] && t[2].z < low[2]) ||
           (t[0].z > high[2] && t[1].z > high[2] && t[2].z > high[2]);
}

static size_t edges_through(const solid *a, const solid *b)
{
    size_t found = 0;
    for (size_t i = 0; i < a->count; i++) {
        const corner3 *edges = a->triangles[i];
        if (triangle_outside(edges, b->low, b->high))
            continue;
        double low[3] = {fmin(fmin(edges[0].x, edges[1].x), edges[2].x), fmin(fmin(edges[0].y, edges[1].y), edges[2].y),
                         fmin(fmin(edges[0].z, edges[1].z), edges[2].z)};
        double high[3] = {fmax(fmax(edges[0].x, edges[1].x), edges[2].x),
                          fmax(fmax(edges[0].y, edges[1].y), edges[2].y),
                          fmax(fmax(edges[0].z, edges[1].z), edges[2].z)};
        for (size_t k = 0; k < b->count; k++)
            if (!triangle_outside(b->triangles[k], low, high))
                for (int e = 0; e < 3; e++)
                    found += passes(edges[e], minus(edges[(e + 1) % 3], edges[e]), 1, b->triangles[k]);
    }
    return found;
}

static bool begins_inside(const solid *a, const solid *b)
{
    const corner3 oblique = {0.3141, 0.8765, 0.4567};
    size_t        crossed = 0;
    for (size_t k = 0; k < b->count; k++)
        crossed += passes(a->triangles[0][0], oblique, 10, b->triangles[k]);
    return crossed % 2 == 1;
}

static void parts_keep_clear(void **state)
{
    size_t wrong = 0;
    (void)state;
    for (size_t i = 0; i < scene->part_count; i++)
        for (size_t k = 0; k < scene->part_count; k++) {
            size_t through = i == k ? 0 : edges_through(&solids[i], &solids[k]);
            bool   inside = i != k && begins_inside(&solids[i], &solids[k]);
            if (through || inside)
                print_error("%s, %s: %zu edges go through%s\n", solids[i].name, solids[k].name, through,
                            inside ? ", inside" : "");
            wrong += through || inside;
        }
    assert_int_equal(wrong, 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(has_its_parts),
        cmocka_unit_test(parts_are_closed),
        cmocka_unit_test(parts_enclose_material),
        cmocka_unit_test(parts_keep_clear),
    };
    return cmocka_run_group_tests(tests, load_pump, unload_pump);
}
