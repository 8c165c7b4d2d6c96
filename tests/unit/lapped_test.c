/* Lapped patches: every point is covered, positions are hardly stretched and run along the field, and nothing about it
 * is left to chance. */
#include "field_shapes.h"

#include "field/lapped.h"

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
    origins   o = {mem_alloc(count * sizeof *o.of), mem_calloc((size_t)triangles + 2, sizeof *o.starts),
                   mem_alloc(count * sizeof *o.list)};
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
    const float *p = m->positions[m->indices[3 * k]], *q = m->positions[m->indices[3 * k + 1]],
                *r = m->positions[m->indices[3 * k + 2]];
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
        const float *q = m->positions[i];
        assert_true(m->source[i] < p->vertex_count);
        assert_true(isfinite(q[0]) && isfinite(q[1]) && (q[2] == 0.0f || q[2] == 1.0f));
        assert_true(q[3] >= 0 && q[3] < (float)m->patch_count);
    }
    for (uint32_t k = 0; k < m->index_count; k += 3) {
        const float *a = m->positions[m->indices[k]], *b = m->positions[m->indices[k + 1]],
                    *c = m->positions[m->indices[k + 2]];
        assert_true(a[2] == b[2] && b[2] == c[2] && a[3] == b[3] && b[3] == c[3]);
        patches = patches || a[2] == 0.0f;
        assert_true(!patches || a[2] == 0.0f); /* what ignores outlines comes first */
    }
}

/* The greater of the greatest stretch and the inverse of the least. */
static double stretch_of(const primitive *p, const lapped_mesh *m, uint32_t k)
{
    const uint32_t *n = m->indices + 3 * (size_t)k;
    const float    *a = m->positions[n[0]], *b = m->positions[n[1]], *c = m->positions[n[2]];
    vec3 o = p->positions[m->source[n[0]]], q = p->positions[m->source[n[1]]], r = p->positions[m->source[n[2]]];
    const double u[3] = {(double)q.x - o.x, (double)q.y - o.y, (double)q.z - o.z},
                 v[3] = {(double)r.x - o.x, (double)r.y - o.y, (double)r.z - o.z};
    double uu = u[0] * u[0] + u[1] * u[1] + u[2] * u[2], uv = u[0] * v[0] + u[1] * v[1] + u[2] * v[2],
           vv = v[0] * v[0] + v[1] * v[1] + v[2] * v[2];
    double x = (double)b[0] - a[0], y = (double)b[1] - a[1], z = (double)c[0] - a[0], w = (double)c[1] - a[1];
    double xx = x * x + y * y, xz = x * z + y * w, zz = z * z + w * w, det = uu * vv - uv * uv;
    if (!(det > 1e-6 * uu * vv))
        return 1; /* a sliver: floats do not tell */
    /* Eigenvalues of the inverse of the surface's metric times that of the positions. */
    double trace = (vv * xx - 2 * uv * xz + uu * zz) / det, product = (xx * zz - xz * xz) / det;
    double most = trace / 2 + sqrt(fmax(0, trace * trace / 4 - product)), least = product / most;
    return fmax(sqrt(most), 1 / sqrt(least));
}

static int by_size(const void *a, const void *b)
{
    double x = *(const double *)a, y = *(const double *)b;
    return x < y ? -1 : x > y;
}

static void check_stretch(const primitive *p, const lapped_mesh *m, double *mean)
{
    uint32_t count = m->index_count / 3;
    double  *all = mem_alloc(count * sizeof *all);
    *mean = 0;
    for (uint32_t k = 0; k < count; k++) {
        all[k] = stretch_of(p, m, k);
        *mean += all[k] / count;
    }
    qsort(all, count, sizeof *all, by_size);
    assert_true(all[count - 1] < 1.51);
    assert_true(fabs(all[count * 95 / 100] - m->stretch) < 0.01);
    mem_free(all);
}

static lapped_mesh lap(const primitive *p, double radius, uint32_t seed)
{
    direction_field f;
    lapped_mesh     m;
    assert_int_equal(direction_field_make(&f, p, 0.8, 0, 0, NULL), LMN_OK);
    assert_int_equal(lapped_make(&m, p, &f, radius, seed, NULL), LMN_OK);
    direction_field_release(&f);
    return m;
}

static void check_coverage(const char *name, primitive p, double radius)
{
    double      before = seconds_now();
    lapped_mesh m = lap(&p, radius, 5);
    double      after = seconds_now();
    check_form(&p, &m);
    origins o = find_origins(&p, &m);
    double  mean;
    check_stretch(&p, &m, &mean);
    size_t samples = 0, missing = uncovered(&p, &m, &o, radius, &samples), base = 0;
    for (uint32_t k = 0; k < m.index_count; k += 3)
        base += m.positions[m.indices[k]][2] == 1.0f;
    printf("%-16s radius %-6g %7u triangles %6u patches %5.2f times, %6zu without outline, stretch %.3f (mean %.3f), "
           "%zu of %zu uncovered, %.2f s\n",
           name, radius, p.index_count / 3, m.patch_count, (double)m.index_count / p.index_count, base, m.stretch, mean,
           missing, samples, after - before);
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
        double      radius;
    } models[] = {{"mesh/suzanne.obj", 0.3},
                  {"mesh/spot.obj", 0.2},
                  {"mesh/teapot.obj", 0.5},
                  {"mesh/scifihelmet-binary.ply", 0.3},
                  {"mesh/gearbox-100k.stl", 8}};
    for (size_t i = 0; i < sizeof models / sizeof *models; i++) {
        primitive p;
        if (!model_primitive(models[i].name, &p))
            skip();
        check_coverage(strchr(models[i].name, '/') + 1, p, models[i].radius);
    }
}

/* cos 2θ times sureness for how the x axis of positions runs on a triangle: the surface's direction in which x grows
 * and y does not, as fractions of the edges from the first corner. */
static double along_field(const primitive *p, const lapped_mesh *m, const direction_field *f, uint32_t k,
                          uint32_t origin, double *sure)
{
    const float *a = m->positions[m->indices[3 * k]], *b = m->positions[m->indices[3 * k + 1]],
                *c = m->positions[m->indices[3 * k + 2]];
    double ux = (double)b[0] - a[0], uy = (double)b[1] - a[1], vx = (double)c[0] - a[0], vy = (double)c[1] - a[1],
           det = ux * vy - uy * vx;
    double s = vy / det, t = -uy / det;
    vec3   o = p->positions[p->indices[3 * origin]], q = p->positions[p->indices[3 * origin + 1]],
         r = p->positions[p->indices[3 * origin + 2]];
    double l[3] = {s * (q.x - o.x) + t * (r.x - o.x), s * (q.y - o.y) + t * (r.y - o.y),
                   s * (q.z - o.z) + t * (r.z - o.z)};
    double length = sqrt(l[0] * l[0] + l[1] * l[1] + l[2] * l[2]), sum[6] = {0}, size = 0;
    if (!(length > 0) || !isfinite(length))
        return 0;
    for (uint32_t i = 0; i < 3; i++)
        for (int j = 0; j < 6; j++)
            sum[j] += (double)direction_field_at(f, p, 3 * origin + i)[j];
    for (int j = 0; j < 6; j++)
        size += (j < 3 ? 1 : 2) * sum[j] * sum[j];
    *sure += sqrt(size / 2) / 3;
    for (int j = 0; j < 3; j++)
        l[j] /= length;
    return (sum[0] * l[0] * l[0] + sum[1] * l[1] * l[1] + sum[2] * l[2] * l[2] +
            2 * (sum[3] * l[0] * l[1] + sum[4] * l[1] * l[2] + sum[5] * l[2] * l[0])) /
           3;
}

static void check_direction(const char *name, primitive p, double radius, double least)
{
    direction_field f;
    lapped_mesh     m;
    assert_int_equal(direction_field_make(&f, &p, 0.8, 0, 0, NULL), LMN_OK);
    assert_int_equal(lapped_make(&m, &p, &f, radius, 3, NULL), LMN_OK);
    origins o = find_origins(&p, &m);
    double  sum = 0, sure = 0;
    for (uint32_t k = 0; k < m.index_count / 3; k++)
        sum += along_field(&p, &m, &f, k, o.of[k], &sure);
    printf("%s: cos 2θ between x and the field is %.3f on average\n", name, sum / sure);
    assert_true(sum / sure > least);
    origins_release(&o);
    lapped_release(&m);
    direction_field_release(&f);
    primitive_release(&p);
}

static place3 cone_at(double u, double v)
{
    double a = 2 * field_pi * u, r = 0.2 + v;
    return (place3){r * cos(a), r * sin(a), 0.5 * v};
}

static void positions_run_along_the_field(void **state)
{
    (void)state;
    primitive spot;
    check_direction("torus", grid_surface(torus_at, 96, 32, true, true, 0.4), 0.7, 0.98);
    check_direction("torus, wide patches", grid_surface(torus_at, 96, 32, true, true, 0.4), 2, 0.9);
    check_direction("cylinder", grid_surface(cylinder_at, 48, 40, true, false, 0.4), 0.7, 0.99);
    check_direction("cone", grid_surface(cone_at, 60, 40, true, false, 0.4), 0.4, 0.9);
    if (model_primitive("mesh/spot.obj", &spot))
        check_direction("spot", spot, 0.2, 0.9);
}

/* The plane is laid flat as it is. */
static void a_plane_is_not_stretched(void **state)
{
    (void)state;
    primitive   p = grid_surface(plane_at, 30, 10, false, false, 0.6);
    lapped_mesh m = lap(&p, 0.3, 1);
    for (uint32_t k = 0; k < m.index_count; k++) {
        uint32_t i = m.indices[k], j = m.indices[k % 3 == 2 ? k - 2 : k + 1];
        vec3     a = p.positions[m.source[i]], b = p.positions[m.source[j]];
        double   there = sqrt(pow((double)a.x - b.x, 2) + pow((double)a.y - b.y, 2) + pow((double)a.z - b.z, 2));
        double   here =
            hypot((double)m.positions[i][0] - m.positions[j][0], (double)m.positions[i][1] - m.positions[j][1]);
        assert_true(fabs(here - there) < 1e-4);
        /* x of positions is ±x of the plane. */
        assert_true(fabs(fabs((double)m.positions[i][0] - m.positions[j][0]) - fabs((double)a.x - b.x)) < 1e-3);
    }
    lapped_release(&m);
    primitive_release(&p);
}

/* Away from the middle the outline turns: no stretch of a tenth of the way around is as straight as a quad's side
 * would be. */
static void outlines_have_no_straight_sides(void **state)
{
    (void)state;
    for (uint32_t k = 0; k < 1000; k++) {
        double straightest = 1;
        for (int i = 0; i < 200; i++) {
            double off = 0, p[3][2];
            for (int j = 0; j < 3; j++) {
                double a = 2 * field_pi * (i / 200.0 + j / 20.0), r = lapped_outline(k, a);
                assert_true(r >= 0.4 - 1e-12 && r <= 1 + 1e-12);
                p[j][0] = r * cos(a);
                p[j][1] = r * sin(a);
            }
            for (int q = 1; q < 20; q++) {
                double a = 2 * field_pi * (i / 200.0 + q / 200.0), r = lapped_outline(k, a), dx = p[2][0] - p[0][0],
                       dy = p[2][1] - p[0][1];
                off = fmax(off, fabs((r * cos(a) - p[0][0]) * dy - (r * sin(a) - p[0][1]) * dx) / hypot(dx, dy));
            }
            straightest = fmin(straightest, off);
        }
        assert_true(straightest > 0.002);
    }
}

static void the_seed_decides_alone(void **state)
{
    (void)state;
    const place3 axes = {3, 2, 1};
    primitive    p = ball(20, 0.3, axes);
    lapped_mesh  a = lap(&p, 0.5, 7), b = lap(&p, 0.5, 7), c = lap(&p, 0.5, 8);
    assert_int_equal(a.vertex_count, b.vertex_count);
    assert_int_equal(a.index_count, b.index_count);
    assert_memory_equal(a.positions, b.positions, a.vertex_count * sizeof *a.positions);
    assert_memory_equal(a.source, b.source, a.vertex_count * sizeof *a.source);
    assert_memory_equal(a.indices, b.indices, a.index_count * sizeof *a.indices);
    assert_true(a.vertex_count != c.vertex_count ||
                memcmp(a.positions, c.positions, a.vertex_count * sizeof *a.positions) != 0);
    lapped_release(&a);
    lapped_release(&b);
    lapped_release(&c);
    primitive_release(&p);
}

/* A model that is a million times as large has patches that are. */
static void size_does_not_matter(void **state)
{
    (void)state;
    const double scales[2] = {1048576, 1.0 / 1048576};
    primitive    p = grid_surface(torus_at, 48, 20, true, true, 0.4);
    lapped_mesh  a = lap(&p, 0.8, 2);
    for (int i = 0; i < 2; i++) {
        primitive q = empty_primitive(p.vertex_count, p.index_count);
        memcpy(q.positions, p.positions, p.vertex_count * sizeof *p.positions);
        memcpy(q.indices, p.indices, p.index_count * sizeof *p.indices);
        scale_primitive(&q, scales[i], 0);
        lapped_mesh b = lap(&q, 0.8 * scales[i], 2);
        assert_int_equal(a.vertex_count, b.vertex_count);
        for (uint32_t v = 0; v < a.vertex_count; v++)
            assert_true(fabs((double)a.positions[v][0] - b.positions[v][0] / scales[i]) < 1e-5);
        lapped_release(&b);
        primitive_release(&q);
    }
    lapped_release(&a);
    primitive_release(&p);
}

/* Windings that disagree, copies, faces on edges of three, triangles that are none. */
static void barely_meshes_are_covered(void **state)
{
    (void)state;
    primitive torus = grid_surface(torus_at, 48, 20, true, true, 0.4),
              p = empty_primitive(torus.vertex_count, torus.index_count + 60);
    memcpy(p.positions, torus.positions, torus.vertex_count * sizeof *torus.positions);
    for (uint32_t t = 0; t < torus.index_count / 3; t++)
        for (uint32_t k = 0; k < 3; k++)
            p.indices[3 * t + k] = torus.indices[3 * t + (hashed(t) < 0.3 ? k : 2 - k)];
    for (uint32_t i = 0; i < 60; i++)
        p.indices[torus.index_count + i] =
            i < 30 ? torus.indices[i / 3 * 3 + (i + 1) % 3] : (uint32_t)(hashed(i) * torus.vertex_count * 0.999);
    check_coverage("disagreeing", p, 0.8);
    primitive_release(&torus);
    p = empty_primitive(3, 3);
    lapped_mesh m = lap(&p, 1, 0);
    assert_int_equal(m.index_count, 0);
    assert_true(m.stretch >= 1 && m.stretch <= 1.5);
    lapped_release(&m);
    primitive_release(&p);
    p = empty_primitive(0, 0);
    m = lap(&p, -1, 0);
    lapped_release(&m);
    primitive_release(&p);
    p = empty_primitive(12, 120);
    for (uint32_t v = 0; v < 12; v++)
        p.positions[v] =
            (vec3){(float)rint(3 * hashed(v)), (float)rint(3 * hashed(v + 100)), (float)rint(2 * hashed(v + 200))};
    for (uint32_t i = 0; i < 120; i++)
        p.indices[i] = (uint32_t)(hashed(i + 1000) * 11.99);
    m = lap(&p, 0.5, 0);
    check_form(&p, &m);
    lapped_release(&m);
    primitive_release(&p);
}

static void memory_may_run_out(void **state)
{
    (void)state;
    primitive       p = grid_surface(torus_at, 12, 8, true, true, 0);
    direction_field f;
    assert_int_equal(direction_field_make(&f, &p, 0.8, 0, 0, NULL), LMN_OK);
    long n = 1;
    for (; n < 100000; n++) {
        lmn_error   error = {0};
        lapped_mesh m;
        mem_fail_at(n);
        lmn_status status = lapped_make(&m, &p, &f, 1.5, 1, &error);
        mem_fail_at(0);
        if (status == LMN_OK) {
            lapped_release(&m);
            break;
        }
        assert_int_equal(status, LMN_MEMORY);
        assert_null(m.positions);
    }
    assert_true(n > 30 && n < 100000);
    direction_field_release(&f);
    primitive_release(&p);
}

/* No limit is asked of large models; the figure is for comparison. */
static void large_surfaces(void **state)
{
    (void)state;
    primitive       p = grid_surface(torus_at, 500, 200, true, true, 0.4);
    direction_field f;
    lapped_mesh     m;
    assert_int_equal(direction_field_make(&f, &p, 0.8, 0, 0, NULL), LMN_OK);
    double before = seconds_now();
    assert_int_equal(lapped_make(&m, &p, &f, 0.7, 1, NULL), LMN_OK);
    printf("torus of %u triangles: %.2f s, %u patches, %.2f times, stretch %.3f\n", p.index_count / 3,
           seconds_now() - before, m.patch_count, (double)m.index_count / p.index_count, m.stretch);
    check_form(&p, &m);
    lapped_release(&m);
    direction_field_release(&f);
    primitive_release(&p);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(everything_is_covered),
        cmocka_unit_test(models_are_covered),
        cmocka_unit_test(positions_run_along_the_field),
        cmocka_unit_test(a_plane_is_not_stretched),
        cmocka_unit_test(outlines_have_no_straight_sides),
        cmocka_unit_test(the_seed_decides_alone),
        cmocka_unit_test(size_does_not_matter),
        cmocka_unit_test(barely_meshes_are_covered),
        cmocka_unit_test(memory_may_run_out),
        cmocka_unit_test(large_surfaces),
    };
    return cmocka_run_group_tests(tests, NULL, remove_temp_folder);
}
