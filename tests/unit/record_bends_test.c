/* How edges that stand for curves leave their chords: over balls and rings, whose curves are known. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#include "lines/stroke/record_bends.h"
#include "scene/scene.h"

enum { VERTICES_MOST = 600, CORNERS_MOST = 3600, ROUND = 24 };

typedef struct drafted {
    vec3     positions[VERTICES_MOST];
    uint32_t indices[CORNERS_MOST], vertex_count, corner_count;
} drafted;

/* A turn about an axis that is none of the three, so that all components count. */
static vec3 turned(double x, double y, double z)
{
    const double c = cos(0.7), s = sin(0.7), C = cos(1.1), S = sin(1.1);
    double       u = c * x - s * y, v = s * x + c * y;
    return (vec3){(float)u, (float)(C * v - S * z), (float)(S * v + C * z)};
}

static uint32_t add(drafted *d, vec3 p)
{
    for (uint32_t i = 0; i < d->vertex_count; i++)
        if (fabsf(d->positions[i].x - p.x) + fabsf(d->positions[i].y - p.y) + fabsf(d->positions[i].z - p.z) < 1e-4f)
            return i;
    assert_true(d->vertex_count < VERTICES_MOST);
    d->positions[d->vertex_count] = p;
    return d->vertex_count++;
}

static void add_triangle(drafted *d, vec3 a, vec3 b, vec3 c)
{
    assert_true(d->corner_count + 3 <= CORNERS_MOST);
    d->indices[d->corner_count++] = add(d, a);
    d->indices[d->corner_count++] = add(d, b);
    d->indices[d->corner_count++] = add(d, c);
}

/* A point of a face of the octahedron, on the unit ball. */
static vec3 on_ball(int face, double i, double j, int parts)
{
    double x = i, y = j, z = parts - i - j, length = sqrt(x * x + y * y + z * z);
    return turned((face & 1 ? -x : x) / length, (face & 2 ? -y : y) / length, (face & 4 ? -z : z) / length);
}

static void draft_ball(drafted *d, int parts)
{
    for (int face = 0; face < 8; face++)
        for (int i = 0; i < parts; i++)
            for (int j = 0; i + j < parts; j++) {
                bool mirrored = (face & 1) ^ (face >> 1 & 1) ^ (face >> 2 & 1);
                vec3 a = on_ball(face, i, j, parts), b = on_ball(face, i + 1, j, parts),
                     c = on_ball(face, i, j + 1, parts);
                add_triangle(d, a, mirrored ? c : b, mirrored ? b : c);
                if (i + j + 1 < parts) {
                    vec3 e = on_ball(face, i + 1, j + 1, parts);
                    add_triangle(d, b, mirrored ? c : e, mirrored ? e : c);
                }
            }
}

/* A prism about an ellipse with half axes 1 and `narrow`. */
static void draft_prism(drafted *d, int sides, double narrow)
{
    const double turn = 6.283185307179586 / sides;
    vec3         low = turned(0, 0, 0), high = turned(0, 0, 1);
    for (int k = 0; k < sides; k++) {
        vec3 a = turned(cos(k * turn), narrow * sin(k * turn), 0),
             b = turned(cos((k + 1) * turn), narrow * sin((k + 1) * turn), 0);
        vec3 c = turned(cos(k * turn), narrow * sin(k * turn), 1),
             e = turned(cos((k + 1) * turn), narrow * sin((k + 1) * turn), 1);
        add_triangle(d, low, b, a);
        add_triangle(d, high, c, e);
        add_triangle(d, a, b, e);
        add_triangle(d, a, e, c);
    }
}

static void open_mesh(edge_mesh *out, const drafted *d)
{
    primitive p = {.vertex_count = d->vertex_count,
                   .positions = (vec3 *)(uintptr_t)d->positions,
                   .index_count = d->corner_count,
                   .indices = (uint32_t *)(uintptr_t)d->indices,
                   .material = NONE};
    mesh      m = {.primitives = &p, .primitive_count = 1};
    lmn_error error = {0};
    assert_int_equal(edge_mesh_create(out, &m, NULL, 0.5, &error), LMN_OK);
}

/* What is packed: three numbers −1 … 1 of eight bits. */
static vec3 unpacked(float packed)
{
    int bits = (int)packed;
    return packed > 0 ? (vec3){(float)((bits >> 16) - 127) / 127, (float)((bits >> 8 & 255) - 127) / 127,
                               (float)((bits & 255) - 127) / 127}
                      : (vec3){0, 0, 0};
}

/* An edge's curve at u. */
static vec3 curve_at(const record_bends *b, uint32_t edge, float u)
{
    const mesh_edge *e = &b->m->edges[edge];
    vec3             p = b->m->positions[e->vertex[0]], q = b->m->positions[e->vertex[1]];
    float from, to, length = sqrtf((q.x - p.x) * (q.x - p.x) + (q.y - p.y) * (q.y - p.y) + (q.z - p.z) * (q.z - p.z));
    record_bend(b, edge, &from, &to);
    vec3  begin = unpacked(from), end = unpacked(to);
    float first = u * (1 - u) * (1 - u) * length, second = u * u * (1 - u) * length;
    return (vec3){p.x + u * (q.x - p.x) + first * begin.x + second * end.x,
                  p.y + u * (q.y - p.y) + first * begin.y + second * end.y,
                  p.z + u * (q.z - p.z) + first * begin.z + second * end.z};
}

static float length_of(vec3 v)
{
    return sqrtf(v.x * v.x + v.y * v.y + v.z * v.z);
}

/* Edges of a coarse ball, none of which is a line, run along the ball: at their middle and at their quarters they are
 * within a third of what chords are off it. */
static void test_ball(void **state)
{
    (void)state;
    static drafted d;
    edge_mesh      m;
    record_bends   b;
    memset(&d, 0, sizeof d);
    draft_ball(&d, 4);
    open_mesh(&m, &d);
    assert_true(record_bends_open(&b, &m));
    float worst = 0;
    for (uint32_t i = 0; i < m.edge_count; i++)
        for (int k = 1; k < 4; k++) {
            vec3  p = m.positions[m.edges[i].vertex[0]], q = m.positions[m.edges[i].vertex[1]];
            float u = 0.25f * (float)k,
                  chord = 1 - length_of((vec3){p.x + u * (q.x - p.x), p.y + u * (q.y - p.y), p.z + u * (q.z - p.z)});
            worst = fmaxf(worst, fabsf(length_of(curve_at(&b, i, u)) - 1) / chord);
        }
    print_message("farthest from the ball: %.3f of chords'\n", (double)worst);
    assert_true(m.edge_count == 192);
    assert_true(worst < 0.33f);
    record_bends_close(&b);
    edge_mesh_release(&m);
}

/* Where an edge's ends both lie on the rim, how far its curve's middle is from the ellipse there, over how far its
 * chord's middle is; the worst of all, and how many there are. */
static float worst_on_rim(const record_bends *b, double narrow, int *count)
{
    float worst = 0;
    vec3  x = turned(1, 0, 0), y = turned(0, 1, 0);
    *count = 0;
    for (uint32_t i = 0; i < b->m->edge_count; i++) {
        const mesh_edge *e = &b->m->edges[i];
        if (!(e->flags & EDGE_CREASE))
            continue;
        vec3   p = b->m->positions[e->vertex[0]], q = b->m->positions[e->vertex[1]], middle = curve_at(b, i, 0.5f);
        double off[2];
        for (int k = 0; k < 2; k++) {
            vec3   at = k ? middle : (vec3){(p.x + q.x) / 2, (p.y + q.y) / 2, (p.z + q.z) / 2};
            double along = (double)(at.x * x.x + at.y * x.y + at.z * x.z),
                   aside = (double)(at.x * y.x + at.y * y.y + at.z * y.z) / narrow;
            off[k] = fabs(hypot(along, aside) - 1);
        }
        worst = fmaxf(worst, (float)(off[1] / off[0]));
        ++*count;
    }
    return worst;
}

/* Rims of a cylinder are circles, those of an elliptic one nearly ellipses. */
static void test_rims(void **state)
{
    (void)state;
    static drafted d;
    static const struct {
        double narrow;
        float  most;
    } rows[] = {{1, 0.08f}, {0.7, 0.3f}};
    for (int r = 0; r < 2; r++) {
        edge_mesh    m;
        record_bends b;
        int          count;
        memset(&d, 0, sizeof d);
        draft_prism(&d, ROUND, rows[r].narrow);
        open_mesh(&m, &d);
        assert_true(record_bends_open(&b, &m));
        float worst = worst_on_rim(&b, rows[r].narrow, &count);
        print_message("half axis %g: middles of curves off it, of chords' %.3f\n", rows[r].narrow, (double)worst);
        assert_int_equal(count, 2 * ROUND);
        assert_true(worst < rows[r].most);
        record_bends_close(&b);
        edge_mesh_release(&m);
    }
}

/* A cube has corners and no curves, and nothing bends. */
static void test_corners(void **state)
{
    (void)state;
    static drafted d;
    edge_mesh      m;
    record_bends   b;
    memset(&d, 0, sizeof d);
    draft_prism(&d, 4, 1);
    open_mesh(&m, &d);
    assert_true(record_bends_open(&b, &m));
    for (uint32_t i = 0; i < m.edge_count; i++) {
        float from, to;
        record_bend(&b, i, &from, &to);
        if (m.edges[i].flags & EDGE_CREASE) {
            assert_float_equal(from, 0, 0);
            assert_float_equal(to, 0, 0);
        }
    }
    record_bends_close(&b);
    edge_mesh_release(&m);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_ball), cmocka_unit_test(test_rims),
                                       cmocka_unit_test(test_corners)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
