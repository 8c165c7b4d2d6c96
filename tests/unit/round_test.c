/* Coarse meshes made round, against the surfaces that they are samples of; and what must not change: flat faces, boxes,
 * bevels, vertices that were there. Every mesh stays whole: each edge of a closed one has two triangles. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "base/memory.h"
#include "scene/mesh.h"
#include "scene/round.h"

#define PI 3.14159265358979323846

/* --- meshes ---------------------------------------------------------------------------------------------- */

enum { VERTICES = 512, CORNERS = 3072 };

/* A primitive in arrays of its own; `mesh_of` lends them. */
typedef struct coarse {
    vec3      positions[VERTICES], normals[VERTICES];
    vec2      uvs[VERTICES];
    uint16_t  joints[2 * VERTICES];
    float     weights[2 * VERTICES];
    uint32_t  indices[CORNERS];
    primitive p;
    mesh      m;
} coarse;

static void finish(coarse *c, bool normals)
{
    c->p.positions = c->positions;
    c->p.normals = normals ? c->normals : NULL;
    c->p.indices = c->indices;
    c->p.bounds = box3_empty();
    for (uint32_t i = 0; i < c->p.vertex_count; i++)
        c->p.bounds = box3_with_point(c->p.bounds, c->positions[i]);
    c->m.primitives = &c->p;
    c->m.primitive_count = 1;
}

static uint32_t put(coarse *c, double x, double y, double z, double nx, double ny, double nz)
{
    uint32_t i = c->p.vertex_count++;
    double   l = sqrt(nx * nx + ny * ny + nz * nz);
    assert_true(i < VERTICES);
    c->positions[i] = (vec3){(float)x, (float)y, (float)z};
    c->normals[i] = l > 0 ? (vec3){(float)(nx / l), (float)(ny / l), (float)(nz / l)} : (vec3){0, 0, 1};
    return i;
}

static void triangle(coarse *c, uint32_t a, uint32_t b, uint32_t d)
{
    const uint32_t corners[3] = {a, b, d};
    assert_true(c->p.index_count + 3 <= CORNERS);
    memcpy(&c->indices[c->p.index_count], corners, sizeof corners);
    c->p.index_count += 3;
}

/* Four corners anticlockwise. */
static void quad(coarse *c, uint32_t a, uint32_t b, uint32_t d, uint32_t e)
{
    triangle(c, a, b, d);
    triangle(c, a, d, e);
}

/* Of latitudes and longitudes, radius 1. */
static coarse *ball(int rows, int columns)
{
    coarse *c = calloc(1, sizeof *c);
    put(c, 0, 0, 1, 0, 0, 1);
    for (int i = 1; i < rows; i++)
        for (int k = 0; k < columns; k++) {
            double a = PI * i / rows, b = 2 * PI * k / columns;
            put(c, sin(a) * cos(b), sin(a) * sin(b), cos(a), sin(a) * cos(b), sin(a) * sin(b), cos(a));
        }
    uint32_t last = put(c, 0, 0, -1, 0, 0, -1), n = (uint32_t)columns;
    for (uint32_t k = 0; k < n; k++) {
        triangle(c, 0, 1 + k, 1 + (k + 1) % n);
        triangle(c, last, last - n + (k + 1) % n, last - n + k);
        for (uint32_t i = 0; i + 2 < (uint32_t)rows; i++)
            quad(c, 1 + i * n + k, 1 + (i + 1) * n + k, 1 + (i + 1) * n + (k + 1) % n, 1 + i * n + (k + 1) % n);
    }
    finish(c, true);
    return c;
}

/* Radius 1, z from 0 to 2, with flat ends that have normals of their own. */
static coarse *drum(int sides, bool normals)
{
    coarse *c = calloc(1, sizeof *c);
    for (int end = 0; end < 2; end++)
        for (int k = 0; k < sides; k++) {
            double a = 2 * PI * k / sides;
            put(c, cos(a), sin(a), 2 * end, cos(a), sin(a), 0);
        }
    uint32_t n = (uint32_t)sides;
    for (uint32_t k = 0; k < n; k++)
        quad(c, k, (k + 1) % n, n + (k + 1) % n, n + k);
    for (int end = 0; end < 2; end++) {
        uint32_t first = c->p.vertex_count;
        for (int k = 0; k < sides; k++)
            put(c, cos(2 * PI * k / sides), sin(2 * PI * k / sides), 2 * end, 0, 0, end ? 1 : -1);
        for (uint32_t k = 1; k + 1 < n; k++)
            triangle(c, first, first + k + (end ? 0 : 1), first + k + (end ? 1 : 0));
    }
    finish(c, normals);
    return c;
}

/* Half-sizes 1 with a bevel of this width; 0: none. Normals are the means of the faces around, which is what a
 * modelling program gives a box that is shaded smooth. */
static coarse *box(double bevel)
{
    coarse          *c = calloc(1, sizeof *c);
    double           in = 1 - bevel;
    static const int sides[6][3] = {{0, 1, 1}, {0, 1, -1}, {1, 2, 1}, {1, 2, -1}, {2, 0, 1}, {2, 0, -1}};
    uint32_t         faces[3][2][2][2]; /* vertex by axis of its face, sign, and signs of the other two axes */
    for (int f = 0; f < 6; f++) {
        int axis = (sides[f][1] + 1) % 3, sign = sides[f][2];
        for (int u = 0; u < 2; u++)
            for (int v = 0; v < 2; v++) {
                double p[3], n[3];
                p[axis] = sign;
                p[(axis + 1) % 3] = (u ? 1 : -1) * in;
                p[(axis + 2) % 3] = (v ? 1 : -1) * in;
                n[axis] = sign;
                n[(axis + 1) % 3] = (u ? 1 : -1) * (bevel > 0 ? 0.35 : 1);
                n[(axis + 2) % 3] = (v ? 1 : -1) * (bevel > 0 ? 0.35 : 1);
                faces[axis][sign > 0][u][v] = put(c, p[0], p[1], p[2], n[0], n[1], n[2]);
            }
        uint32_t(*q)[2] = faces[axis][sign > 0];
        if (sign > 0)
            quad(c, q[0][0], q[1][0], q[1][1], q[0][1]);
        else
            quad(c, q[0][0], q[0][1], q[1][1], q[1][0]);
    }
    for (int axis = 0; axis < 3 && bevel > 0; axis++) /* bevels along the third axis, between this and the next one */
        for (int s = 0; s < 2; s++)
            for (int t = 0; t < 2; t++) {
                int      next = (axis + 1) % 3;
                uint32_t a = faces[axis][s][t][0], b = faces[axis][s][t][1], d = faces[next][t][0][s],
                         e = faces[next][t][1][s];
                if ((s ^ t) == 0)
                    quad(c, a, d, e, b);
                else
                    quad(c, a, b, e, d);
            }
    for (int i = 0; i < 8 && bevel > 0; i++) {
        int      x = i & 1, y = i >> 1 & 1, z = i >> 2;
        uint32_t a = faces[0][x][y][z], b = faces[1][y][z][x], d = faces[2][z][x][y];
        if ((x ^ y ^ z) != 0)
            triangle(c, a, b, d);
        else
            triangle(c, a, d, b);
    }
    finish(c, true);
    return c;
}

/* --- what is measured ------------------------------------------------------------------------------------ */

static mesh rounded(const mesh *m, double tolerance, size_t most)
{
    mesh          out;
    lmn_error     error;
    round_options options = {.crease_angle = PI / 6, .tolerance = tolerance, .most_vertices = most};
    if (mesh_round(&out, m, &options, &error) != LMN_OK)
        fail_msg("%s", error.message);
    return out;
}

/* Corners of all primitives in one, so that what parts them shows. */
static primitive joined(const mesh *m)
{
    primitive all = {.vertex_count = 0};
    for (size_t i = 0; i < m->primitive_count; i++) {
        all.vertex_count += m->primitives[i].vertex_count;
        all.index_count += m->primitives[i].index_count;
    }
    all.positions = malloc(all.vertex_count * sizeof *all.positions);
    all.indices = malloc(all.index_count * sizeof *all.indices);
    uint32_t v = 0, c = 0;
    for (size_t i = 0; i < m->primitive_count; i++) {
        const primitive *p = &m->primitives[i];
        for (uint32_t k = 0; k < p->index_count; k++)
            all.indices[c++] = v + p->indices[k];
        memcpy(all.positions + v, p->positions, p->vertex_count * sizeof *p->positions);
        v += p->vertex_count;
    }
    return all;
}

/* Edges without a triangle on their other side. */
static size_t open_edges(const mesh *m)
{
    primitive all = joined(m);
    uint32_t *beside = mesh_adjacency(&all);
    size_t    count = 0;
    assert_non_null(beside);
    for (uint32_t i = 0; i < all.index_count; i++)
        count += beside[i] == UINT32_MAX;
    mem_free(beside);
    free(all.positions);
    free(all.indices);
    return count;
}

static double volume_of(const mesh *m)
{
    double sum = 0;
    for (size_t i = 0; i < m->primitive_count; i++)
        for (uint32_t c = 0; c < m->primitives[i].index_count; c += 3) {
            const primitive *p = &m->primitives[i];
            vec3             a = p->positions[p->indices[c]], b = p->positions[p->indices[c + 1]],
                 d = p->positions[p->indices[c + 2]];
            sum += (double)a.x * ((double)b.y * d.z - (double)b.z * d.y) -
                   (double)a.y * ((double)b.x * d.z - (double)b.z * d.x) +
                   (double)a.z * ((double)b.x * d.y - (double)b.y * d.x);
        }
    return sum / 6;
}

static double radius_of(vec3 p, bool flat)
{
    return sqrt((double)p.x * p.x + (double)p.y * p.y + (flat ? 0 : (double)p.z * p.z));
}

/* --- tests ------------------------------------------------------------------------------------------------ */

static void balls_become_round(void **state)
{
    (void)state;
    coarse          *c = ball(6, 10);
    const double     full = 4 * PI / 3, before = volume_of(&c->m);
    mesh             m = rounded(&c->m, 1.0 / 2000, 100000);
    const primitive *p = &m.primitives[0];
    assert_int_equal(m.primitive_count, 1);
    assert_true(before < 0.9 * full);
    assert_true(fabs(volume_of(&m) / full - 1) < 0.012); /* 0.127 before */
    for (uint32_t i = 0; i < p->vertex_count; i++) {
        vec3   n = p->normals[i], v = p->positions[i];
        double r = radius_of(v, false);
        if (fabs(r - 1) > 0.012)
            printf("%u r %g  %g %g %g\n", i, r, v.x, v.y, v.z);
        assert_true(fabs(r - 1) < 0.012); /* the coarse one leaves it by 0.13 */
        assert_true((n.x * v.x + n.y * v.y + n.z * v.z) / (float)r > 0.999f);
    }
    assert_int_equal(open_edges(&m), 0);
    assert_int_equal(p->vertex_count, p->index_count / 6 + 2); /* Euler: none is there twice */
    for (uint32_t i = 0; i < c->p.vertex_count; i++)
        assert_memory_equal(&p->positions[i], &c->positions[i], sizeof(vec3));
    mesh again = rounded(&c->m, 1.0 / 2000, 100000);
    assert_int_equal(again.primitives[0].index_count, p->index_count);
    assert_memory_equal(again.primitives[0].indices, p->indices, p->index_count * sizeof *p->indices);
    assert_memory_equal(again.primitives[0].positions, p->positions, p->vertex_count * sizeof *p->positions);
    mesh_release(&again);
    mesh_release(&m);
    free(c);
}

/* Rims are circles and sharp, as sharp as they were said to be, ends flat; also when normals have to be made. */
static void drums_keep_their_rims(void **state)
{
    (void)state;
    for (int made = 0; made < 2; made++) {
        coarse       *c = drum(16, !made);
        round_options options = {PI / 6, 1.0 / 2000, 100000, false, NULL, 0};
        round_crease  rims[32];
        for (uint32_t k = 0; k < 32; k++)
            rims[k] = (round_crease){{c->positions[k], c->positions[k < 16 ? (k + 1) % 16 : 16 + (k + 1) % 16]}, 1.2f};
        options.sharp = rims;
        options.sharp_count = 32;
        /* Chords keep the tolerance; normals that are made lean towards the side with more triangles. */
        const double slack = made ? 0.008 : 0.0025;
        mesh         m;
        assert_int_equal(mesh_round(&m, &c->m, &options, NULL), LMN_OK);
        assert_int_equal(m.primitive_count, 1);
        const primitive *p = &m.primitives[0];
        assert_true(fabs(volume_of(&m) / (2 * PI) - 1) < slack); /* 0.026 before */
        assert_int_equal(open_edges(&m), 0);
        double rim = 0;
        size_t hard = 0;
        for (uint32_t i = 0; i < p->vertex_count; i++)
            if (fabsf(p->normals[i].z) < 0.5f)
                assert_true(fabs(radius_of(p->positions[i], true) - 1) < slack);
        for (uint32_t i = 0; i < p->index_count; i++) {
            vec3 a = p->positions[p->indices[i]], b = p->positions[p->indices[i % 3 == 2 ? i - 2 : i + 1]];
            assert_true(p->edges.values[i] == 1 || p->edges.values[i] >= EDGE_TURNED);
            if (p->edges.values[i] == 1)
                continue;
            assert_true(fabs((double)edge_turn(p->edges.values[i]) - 1.2) < 0.013);
            assert_true(a.z == b.z && (a.z == 0 || a.z == 2));
            rim += hypot((double)a.x - b.x, (double)a.y - b.y);
            hard++;
        }
        assert_true(fabs(rim / (8 * PI) - 1) < slack); /* two rims, from two sides */
        assert_true(hard >= 4 * 32);
        for (uint32_t i = 0; i < p->index_count; i += 3) /* ends are flat */
            if (fabsf(p->normals[p->indices[i]].z) > 0.5f)
                for (int k = 0; k < 3; k++)
                    assert_true(p->positions[p->indices[i + (uint32_t)k]].z ==
                                (p->normals[p->indices[i]].z > 0 ? 2 : 0));
        mesh_release(&m);
        free(c);
    }
}

/* Normals of boxes that are shaded smooth, with bevels and without, lean, and say nothing of how their faces bend. */
static void boxes_stay_boxes(void **state)
{
    (void)state;
    static const double bevels[] = {0, 0.03, 0.08};
    for (size_t i = 0; i < sizeof bevels / sizeof bevels[0]; i++) {
        coarse *c = box(bevels[i]);
        assert_int_equal(open_edges(&c->m), 0);
        double before = volume_of(&c->m);
        mesh   m = rounded(&c->m, 1.0 / 2000, 100000);
        assert_true(before > 7);
        if (m.primitive_count) {
            assert_true(fabs(volume_of(&m) / before - 1) < 0.002);
            for (uint32_t k = 0; k < m.primitives[0].vertex_count; k++) {
                vec3 p = m.primitives[0].positions[k];
                assert_true(fabsf(p.x) < 1.002f && fabsf(p.y) < 1.002f && fabsf(p.z) < 1.002f);
            }
        }
        mesh_release(&m);
        free(c);
    }
}

static void fine_meshes_are_left_alone(void **state)
{
    (void)state;
    coarse *c = ball(15, 30);
    mesh    m = rounded(&c->m, 1.0 / 100, 100000);
    assert_int_equal(m.primitive_count, 0);
    mesh_release(&m);
    free(c);
}

/* What does not fit is left out a round at a time: the mesh is whole whatever the limit. */
static void limits_leave_meshes_whole(void **state)
{
    (void)state;
    coarse  *c = ball(6, 10);
    uint32_t last = 0;
    for (size_t most = 0; most < 3000; most += 290) {
        mesh m = rounded(&c->m, 1.0 / 2000, most);
        if (m.primitive_count) {
            assert_true(m.primitives[0].vertex_count <= c->p.vertex_count + most);
            assert_true(m.primitives[0].vertex_count >= last);
            assert_int_equal(open_edges(&m), 0);
            last = m.primitives[0].vertex_count;
        }
        mesh_release(&m);
    }
    assert_true(last > 500);
    free(c);
}

/* Two materials: a ball in two primitives, with vertices of their own along the border. */
static void primitives_stay_together(void **state)
{
    (void)state;
    coarse   *c = ball(6, 10);
    primitive two[2] = {c->p, c->p};
    two[0].index_count = 3 * 4 * 10;
    two[1].indices += two[0].index_count;
    two[1].index_count -= two[0].index_count;
    two[1].material = 1;
    mesh m = {.primitives = two, .primitive_count = 2}, out = rounded(&m, 1.0 / 2000, 100000);
    assert_int_equal(out.primitive_count, 2);
    assert_int_equal(out.primitives[1].material, 1);
    assert_true(out.primitives[0].index_count > 2 * two[0].index_count);
    assert_true(out.primitives[1].index_count > 2 * two[1].index_count);
    assert_int_equal(open_edges(&out), 0);
    mesh_release(&out);
    free(c);
}

/* Coordinates of textures are linear, weights of joints sum to 1, and offsets of morphs are means. */
static void what_hangs_on_vertices_comes_along(void **state)
{
    (void)state;
    coarse *c = ball(6, 10);
    vec3   *offsets = calloc(VERTICES, sizeof *offsets);
    for (uint32_t i = 0; i < c->p.vertex_count; i++) {
        c->uvs[i] = (vec2){c->positions[i].x, 0.5f * c->positions[i].z};
        offsets[i] = (vec3){0, 0, c->positions[i].x};
        c->joints[2 * i] = (uint16_t)(i % 3);
        c->joints[2 * i + 1] = (uint16_t)(3 + i % 2);
        c->weights[2 * i] = 0.75f;
        c->weights[2 * i + 1] = 0.25f;
    }
    c->p.uvs[0] = c->uvs;
    c->p.joints = c->joints;
    c->p.weights = c->weights;
    c->p.influences = 2;
    c->p.morphs = &(morph_target){offsets, NULL};
    c->p.morph_count = 1;
    mesh             m = rounded(&c->m, 1.0 / 200, 100000);
    const primitive *p = &m.primitives[0];
    assert_true(m.primitive_count == 1 && p->vertex_count > c->p.vertex_count + 20);
    for (uint32_t i = 0; i < p->vertex_count; i++) {
        assert_true(fabsf(p->weights[2 * i] + p->weights[2 * i + 1] - 1) < 1e-6f);
        assert_true(p->weights[2 * i] >= p->weights[2 * i + 1]);
        assert_true(p->joints[2 * i] < 5 && p->joints[2 * i + 1] < 5);
        assert_true(fabsf(p->morphs[0].positions[i].z - p->uvs[0][i].x) < 1e-6f); /* both began as x */
        assert_true(fabsf(p->uvs[0][i].x - p->positions[i].x) < 0.2f);
    }
    mesh_release(&m);
    free(offsets);
    free(c);
}

/* An edge of a circle is its arc. */
static void arcs_are_arcs(void **state)
{
    (void)state;
    for (int degrees = 10; degrees <= 60; degrees += 10) {
        double       a = degrees * PI / 360;
        const double ends[2][3] = {{-sin(a), cos(a), 0}, {sin(a), cos(a), 0}};
        round_side   side = {
              .normals = {{-sin(a), cos(a), 0}, {sin(a), cos(a), 0}}, .face = {0, 1, 0}, .beyond = {1, INFINITY}};
        round_edge alone = round_edge_of(ends, &side, NULL), both = round_edge_of(ends, &side, &side);
        /* Of a cubic with these tangents; that of the circle is 1. */
        assert_true(fabs(alone.middle[1] - (cos(a) + sin(a) * sin(a) * cos(a) / 2)) < 1e-12);
        assert_true(fabs(alone.middle[1] - 1) < 0.4 * pow(a, 4));
        assert_true(fabs(both.middle[1] - alone.middle[1]) < 1e-12 && fabs(alone.middle[0]) < 1e-12);
        assert_true(fabs(alone.distance - sin(a) * sin(a) / 2 / sin(a) * 1) < 0.2);
        round_side cap = {.normals = {{0, 0, 1}, {0, 0, 1}}, .face = {0, 0, 1}, .beyond = {INFINITY, INFINITY}};
        round_edge rim = round_edge_of(ends, &side, &cap);
        assert_true(fabs(rim.middle[1] - alone.middle[1]) < 1e-12 && fabs(rim.middle[2]) < 1e-12);
        side.beyond[0] = 0.1; /* a narrow bevel: that end stays straight */
        assert_true(round_edge_of(ends, &side, NULL).middle[1] < alone.middle[1] - 0.2 * (alone.middle[1] - cos(a)));
    }
}

static void without_memory_it_says_so(void **state)
{
    (void)state;
    coarse *c = drum(16, false);
    long    n = 1;
    for (lmn_status status = LMN_MEMORY; status != LMN_OK; n++) {
        round_options options = {PI / 6, 1.0 / 2000, 100000, false, NULL, 0};
        mesh          m;
        mem_fail_at(n);
        status = mesh_round(&m, &c->m, &options, NULL);
        mem_fail_at(0);
        assert_true(status == LMN_OK || status == LMN_MEMORY);
        assert_true(status == LMN_OK || m.primitive_count == 0);
        mesh_release(&m);
    }
    assert_true(n > 10);
    free(c);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(arcs_are_arcs),
        cmocka_unit_test(balls_become_round),
        cmocka_unit_test(drums_keep_their_rims),
        cmocka_unit_test(boxes_stay_boxes),
        cmocka_unit_test(fine_meshes_are_left_alone),
        cmocka_unit_test(limits_leave_meshes_whole),
        cmocka_unit_test(primitives_stay_together),
        cmocka_unit_test(what_hangs_on_vertices_comes_along),
        cmocka_unit_test(without_memory_it_says_so),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
