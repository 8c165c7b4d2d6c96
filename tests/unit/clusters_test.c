/* Clusters of marks: which surfaces are solid, and that a cluster which a view leaves out has no mark that could be
 * seen by itself. Seed 001, section 5.4.6; row EX-30. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "marks/clusters.h"

enum { STACKS = 12, SLICES = 20, VERTICES = (STACKS + 1) * SLICES, TRIANGLES = 2 * STACKS * SLICES };

typedef struct ball {
    vec3         positions[VERTICES], normals[VERTICES];
    uint32_t     indices[3 * TRIANGLES];
    mark_surface surface;
} ball;

/* Poles are several vertices at one place, and triangles there without area. `inwards`: normals look in. */
static void make_ball(ball *b, bool inwards)
{
    uint32_t *at = b->indices;
    for (int i = 0; i <= STACKS; i++)
        for (int k = 0; k < SLICES; k++) {
            double polar = 3.14159265358979 * i / STACKS, around = 2 * 3.14159265358979 * k / SLICES;
            bool   pole = i == 0 || i == STACKS;
            vec3   n = {pole ? 0 : (float)(sin(polar) * cos(around)), (float)cos(polar),
                      pole ? 0 : (float)(sin(polar) * sin(around))};
            b->positions[i * SLICES + k] = n;
            b->normals[i * SLICES + k] = inwards ? (vec3){-n.x, -n.y, -n.z} : n;
            uint32_t a = (uint32_t)(i * SLICES + k), next = (uint32_t)(i * SLICES + (k + 1) % SLICES);
            if (i < STACKS) {
                memcpy(at, (uint32_t[]){a, next, a + SLICES, next, next + SLICES, a + SLICES}, 6 * sizeof *at);
                at += 6;
            }
        }
    b->surface = (mark_surface){b->positions, b->normals, NULL, b->indices, VERTICES, TRIANGLES};
}

static void test_solid(void **state)
{
    (void)state;
    ball b;
    make_ball(&b, false);
    assert_true(mark_surface_is_solid(&b.surface, NULL));
    b.surface.triangle_count -= 4 * SLICES; /* without a cap */
    assert_false(mark_surface_is_solid(&b.surface, NULL));
    make_ball(&b, true);
    assert_false(mark_surface_is_solid(&b.surface, NULL));
    /* The way round of corners does not count. */
    make_ball(&b, false);
    for (int t = 0; t < TRIANGLES; t += 3) {
        uint32_t kept = b.indices[3 * t];
        b.indices[3 * t] = b.indices[3 * t + 1];
        b.indices[3 * t + 1] = kept;
    }
    assert_true(mark_surface_is_solid(&b.surface, NULL));
    /* Half of it another part: both are open. */
    uint32_t parts[TRIANGLES] = {0};
    for (int t = TRIANGLES / 2; t < TRIANGLES; t++)
        parts[t] = 1;
    assert_false(mark_surface_is_solid(&b.surface, parts));
    /* A triangle twice. */
    memcpy(&b.indices[3 * (TRIANGLES / 2)], &b.indices[3 * (TRIANGLES / 2 + 1)], 3 * sizeof *b.indices);
    assert_false(mark_surface_is_solid(&b.surface, NULL));
}

/* Looking along −z from z = `distance`, a little beside. */
static cluster_view view_from(double distance, double beside)
{
    cluster_view v = {.model_view = mat4_identity(),
                      .near = 0.01,
                      .focal = 300,
                      .width = 200,
                      .height = 200,
                      .reach = 3,
                      .outside = true};
    v.model_view.m[12] = beside;
    v.model_view.m[14] = -distance;
    v.projection = (mat4){.m = {3, 0, 0, 0, 0, 3, 0, 0, 0, 0, -1, -1, 0, 0, -0.02, 0}};
    return v;
}

static void check_view(const mark_clusters *c, const marks *m, const cluster_view *v, int fates[3], size_t *fewer)
{
    for (size_t k = 0; k < c->count; k++) {
        const mark_cluster *one = &c->clusters[k];
        cluster_fate        fate = mark_cluster_fate(c, one, v);
        double              scale = mark_cluster_scale(one, v, true);
        fates[fate]++;
        for (uint32_t i = one->first; i < one->first + one->count; i++) {
            const mark_dot *d = &m->dots[c->order[i]];
            double          eye[3] = {(double)d->position.x + v->model_view.m[12], (double)d->position.y,
                                      (double)d->position.z + v->model_view.m[14]};
            double          length = sqrt(eye[0] * eye[0] + eye[1] * eye[1] + eye[2] * eye[2]), depth = -eye[2];
            double          facing =
                -((double)d->normal.x * eye[0] + (double)d->normal.y * eye[1] + (double)d->normal.z * eye[2]) / length;
            double x = 100 + 300 * eye[0] / depth, y = 100 + 300 * eye[1] / depth,
                   page = 300 * 300 * length / pow(depth, 3);
            assert_true(i == one->first || c->ranks[i] >= c->ranks[i - 1]);
            if (depth > v->near)
                assert_true(page <= scale * 1.000001);
            if (fate == CLUSTER_BESIDE)
                assert_true(depth < v->near || x < -3 || y < -3 || x > 203 || y > 203);
            if (fate == CLUSTER_TURNED_AWAY)
                assert_true(facing < -(double)c->leans[i]);
        }
        size_t prefix = mark_cluster_prefix(c, one, 0.25);
        assert_true(prefix == one->count || c->ranks[one->first + prefix] > 0.25f);
        assert_true(prefix == 0 || c->ranks[one->first + prefix - 1] <= 0.25f);
        *fewer += one->count - prefix;
    }
}

static void test_left_out(void **state)
{
    (void)state;
    ball          b;
    marks         m;
    mark_clusters c;
    lmn_error     error;
    int           fates[3] = {0, 0, 0};
    size_t        fewer = 0, all = 0;
    make_ball(&b, false);
    assert_int_equal(marks_stipple(&m, &b.surface, 9000, 1, &error), LMN_OK);
    assert_true(mark_clusters_make(&c, &m, &b.surface));
    assert_true(c.count >= 16);
    char *seen = calloc(m.dot_count, 1);
    for (size_t i = 0; i < c.mark_count; i++)
        all += !seen[c.order[i]]++;
    assert_int_equal(all, m.dot_count);
    free(seen);
    c.solid = true;
    const cluster_view views[] = {view_from(4, 0), view_from(1.3, 0.6), view_from(3, 1.5), view_from(0.2, 0)};
    for (int k = 0; k < 4; k++)
        check_view(&c, &m, &views[k], fates, &fewer);
    assert_true(fates[CLUSTER_SEEN] > 10 && fates[CLUSTER_BESIDE] > 10 && fates[CLUSTER_TURNED_AWAY] > 10);
    assert_true(fewer > 4 * m.dot_count / 2);
    c.solid = false;
    memset(fates, 0, sizeof fates);
    check_view(&c, &m, &views[0], fates, &fewer);
    assert_int_equal(fates[CLUSTER_TURNED_AWAY], 0);
    mark_clusters_release(&c);
    surface_marks_release(&m);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_solid), cmocka_unit_test(test_left_out)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
