/* Lapped patches: every point is covered, places are hardly stretched and run along the field, and nothing about it is left to chance. */
#include "field_shapes.h"

#include "scene/lapped.h"

/* Per triangle of the primitive the triangles of the lapped mesh that are it: list[starts[t]] … */
typedef struct origins {
    uint32_t *of, *starts, *list;
} origins;

static uint32_t *triangles_around(const primitive *p, uint32_t **list)
{
    uint32_t *starts = mem_calloc((size_t)p->vertex_count + 2, sizeof *starts);
    *list = mem_alloc(p->index_count * sizeof **list);
    for (uint32_t i = 0; i < p->index_count; i++)
        starts[p->indices[i] + 2]++;
    for (uint32_t v = 0; v < p->vertex_count; v++)
        starts[v + 2] += starts[v + 1];
    for (uint32_t i = 0; i < p->index_count; i++)
        (*list)[starts[p->indices[i] + 1]++] = i / 3;
    return starts;
}

static origins find_origins(const primitive *p, const lapped_mesh *m)
{
    uint32_t *around, *at = triangles_around(p, &around), count = m->index_count / 3, triangles = p->index_count / 3;
    origins o = {mem_alloc(count * sizeof *o.of), mem_calloc((size_t)triangles + 2, sizeof *o.starts), mem_alloc(count * sizeof *o.list)};
    for (uint32_t k = 0; k < count; k++) {
        uint32_t key[3];
        for (uint32_t c = 0; c < 3; c++)
            key[c] = m->source[m->indices[3 * k + c]];
        o.of[k] = UINT32_MAX;
        for (uint32_t i = at[key[0]]; i < at[key[0] + 1]; i++)
            if (memcmp(p->indices + 3 * (size_t)around[i], key, sizeof key) == 0)
                o.of[k] = around[i];
        assert_true(o.of[k] != UINT32_MAX);
        o.starts[o.of[k] + 2]++;
    }
    for (uint32_t t = 0; t < triangles; t++)
        o.starts[t + 2] += o.starts[t + 1];
    for (uint32_t k = 0; k < count; k++)
        o.list[o.starts[o.of[k] + 1]++] = k;
    mem_free(around);
    mem_free(at);
    return o;
}

static void origins_release(origins *o)
{
    mem_free(o->of);
    mem_free(o->starts);
    mem_free(o->list);
}

static bool is_inside(const lapped_mesh *m, uint32_t k, double a, double b, double radius)
{
    const float *p = m->places[m->indices[3 * k]], *q = m->places[m->indices[3 * k + 1]], *r = m->places[m->indices[3 * k + 2]];
    if (p[2] == 1.0f)
        return true;
    double x = (double)p[0] + a * ((double)q[0] - (double)p[0]) + b * ((double)r[0] - (double)p[0]);
    double y = (double)p[1] + a * ((double)q[1] - (double)p[1]) + b * ((double)r[1] - (double)p[1]);
    return hypot(x, y) < lapped_outline((uint32_t)p[3], atan2(y, x)) * radius;
}

/* Samples of all triangles; how many nothing covers. */
static size_t uncovered(const primitive *p, const lapped_mesh *m, const origins *o, double radius, size_t *samples)
{
    enum { SIDE = 12 };
    size_t missing = 0;
    for (uint32_t t = 0; t < p->index_count / 3; t++)
        for (int i = 0; i <= SIDE; i++)
            for (int j = 0; i + j <= SIDE; j++) {
                bool found = false;
                for (uint32_t k = o->starts[t]; !found && k < o->starts[t + 1]; k++)
                    found = is_inside(m, o->list[k], (double)i / SIDE, (double)j / SIDE, radius);
                missing += !found;
                ++*samples;
            }
    return missing;
}

static void check_form(const primitive *p, const lapped_mesh *m)
{
    bool patches = false;
    assert_true(m->index_count % 3 == 0 && (m->index_count <= 16 * p->index_count || m->index_count <= 3 * 65536));
    for (uint32_t i = 0; i < m->vertex_count; i++) {
        const float *q = m->places[i];
        assert_true(m->source[i] < p->vertex_count);
        assert_true(isfinite(q[0]) && isfinite(q[1]) && (q[2] == 0.0f || q[2] == 1.0f));
        assert_true(q[3] >= 0 && q[3] < (float)m->patch_count);
    }
    for (uint32_t k = 0; k < m->index_count; k += 3) {
        const float *a = m->places[m->indices[k]], *b = m->places[m->indices[k + 1]], *c = m->places[m->indices[k + 2]];
        assert_true(a[2] == b[2] && b[2] == c[2] && a[3] == b[3] && b[3] == c[3]);
        patches = patches || a[2] == 0.0f;
        assert_true(!patches || a[2] == 0.0f); /* what ignores outlines comes first */
    }
}

static lapped_mesh lap(const primitive *p, double radius, uint32_t seed)
{
    direction_field f;
    lapped_mesh m;
    assert_int_equal(direction_field_make(&f, p, 0.8, 0, NULL), LMN_OK);
    assert_int_equal(lapped_make(&m, p, &f, radius, seed, NULL), LMN_OK);
    direction_field_release(&f);
    return m;
}

static void check_coverage(const char *name, primitive p, double radius)
{
    double before = seconds_now();
    lapped_mesh m = lap(&p, radius, 5);
    double after = seconds_now();
    check_form(&p, &m);
    origins o = find_origins(&p, &m);
    size_t samples = 0, missing = uncovered(&p, &m, &o, radius, &samples), base = 0;
    for (uint32_t k = 0; k < m.index_count; k += 3)
        base += m.places[m.indices[k]][2] == 1.0f;
    printf("%-16s radius %-6g %7u triangles %6u patches %5.2f times, %6zu without outline, stretch %.3f, %zu of %zu uncovered, %.2f s\n", name, radius,
           p.index_count / 3, m.patch_count, (double)m.index_count / p.index_count, base, m.stretch, missing, samples, after - before);
    assert_int_equal(missing, 0);
    assert_true(m.stretch >= 1 && m.stretch <= 1.5);
    origins_release(&o);
    lapped_release(&m);
    primitive_release(&p);
}

static void everything_is_covered(void **state)
{
    (void)state;
    const place3 round = {1, 1, 1}, long_one = {3, 2, 1};
    check_coverage("sphere", ball(24, 0.5, round), 0.4);
    check_coverage("sphere", ball(24, 0, round), 0.1);
    check_coverage("sphere", ball(24, 0, round), 0.03);
    check_coverage("sphere", ball(24, 0, round), 10);
    check_coverage("ellipsoid", ball(40, 0, long_one), 0.5);
    check_coverage("torus", grid_surface(torus_at, 96, 32, true, true, 0.5), 0.9);
    check_coverage("torus", grid_surface(torus_at, 96, 32, true, true, 0), 3);
    check_coverage("plane", grid_surface(plane_at, 60, 20, false, false, 0), 0.3);
    check_coverage("cylinder", grid_surface(cylinder_at, 32, 1, true, false, 0), 0.7);
    check_coverage("cube", shared_cube(), 0.3);
    check_coverage("cube", shared_cube(), 0.1);
    check_coverage("cube", shared_cube(), 0.01);
    check_coverage("cube", shared_cube(), 3);
}

static void models_are_covered(void **state)
{
    (void)state;
    static const struct {
        const char *name;
        double radius;
    } models[] = {{"mesh/suzanne.obj", 0.3}, {"mesh/spot.obj", 0.2}, {"mesh/teapot.obj", 0.5}, {"mesh/scifihelmet-binary.ply", 0.3}, {"mesh/gearbox-100k.stl", 8}};
    for (size_t i = 0; i < sizeof models / sizeof *models; i++) {
        primitive p;
        if (!model_primitive(models[i].name, &p))
            skip();
        check_coverage(strchr(models[i].name, '/') + 1, p, models[i].radius);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(everything_is_covered),
        cmocka_unit_test(models_are_covered),
    };
    return cmocka_run_group_tests(tests, NULL, remove_temp_folder);
}
