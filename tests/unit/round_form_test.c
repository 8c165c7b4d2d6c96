/* Coarse cages that are shaded smooth all over become the surface that they are cages of: smooth, as large as the cage,
 * with the tips that it has. What is no such cage stays what it was. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "base/memory.h"
#include "base/vector3.h"
#include "scene/mesh.h"
#include "scene/round.h"

#define PI     3.14159265358979323846
#define DEGREE (PI / 180)

enum { ROWS = 9, COLUMNS = 12, VERTICES = 2 + (ROWS - 1) * COLUMNS, CORNERS = 6 * (ROWS - 1) * COLUMNS };

typedef struct cage {
    vec3      positions[VERTICES], normals[VERTICES], offsets[VERTICES];
    uint32_t  indices[CORNERS];
    primitive p;
    mesh      m;
} cage;

static void point_of(double out[3], vec3 v)
{
    vector3_set(out, (double)v.x, (double)v.y, (double)v.z);
}

/* Twice as long as the triangle is large. */
static void face_of(double out[3], const primitive *p, uint32_t corner)
{
    double at[3][3], one[3], two[3];
    for (uint32_t k = 0; k < 3; k++)
        point_of(at[k], p->positions[p->indices[corner - corner % 3 + k]]);
    vector3_add(one, at[1], -1, at[0]);
    vector3_add(two, at[2], -1, at[0]);
    vector3_cross(out, one, two);
}

/* As programs make normals: the mean of the faces, weighted by their areas. */
static void shade(cage *c)
{
    double sums[VERTICES][3] = {{0}};
    for (uint32_t i = 0; i < c->p.index_count; i++) {
        double n[3];
        face_of(n, &c->p, i);
        vector3_add(sums[c->indices[i]], sums[c->indices[i]], 1, n);
    }
    for (uint32_t v = 0; v < VERTICES; v++) {
        assert_true(vector3_normalise(sums[v]));
        c->normals[v] = (vec3){(float)sums[v][0], (float)sums[v][1], (float)sums[v][2]};
    }
}

/* The same number for the same place, from −1 to 1. */
static double shake(uint32_t i)
{
    i = (i + 1) * 2654435761u;
    i = (i ^ i >> 15) * 2246822519u;
    return (double)((i ^ i >> 13) & 0xffff) / 32767.5 - 1;
}

/* A flat ear, bent, shaken as hands shake, with a tip of one vertex. Its rim turns by more than a right angle. */
static cage *ear(double shaken, double tip)
{
    cage    *c = calloc(1, sizeof *c);
    uint32_t v = 0, at = 0;
    for (int i = 0; i <= ROWS; i++)
        for (int k = 0; k < (i % ROWS ? COLUMNS : 1); k++, v++) {
            double a = PI * i / ROWS, b = 2 * PI * k / COLUMNS, x = sin(a) * cos(b), y = 0.75 * sin(a) * sin(b),
                   z = 0.2 * cos(a);
            x += shaken * shake(3 * v), y += shaken * shake(3 * v + 1), z += 0.3 * shaken * shake(3 * v + 2);
            c->positions[v] = (vec3){(float)x, (float)y, (float)(z + 0.25 * x * x)};
        }
    assert_int_equal(v, VERTICES);
    for (uint32_t k = 0; k < COLUMNS; k++) {
        const uint32_t next = (k + 1) % COLUMNS,
                       ends[6] = {
                           0, 1 + k, 1 + next, VERTICES - 1, VERTICES - 1 - COLUMNS + next, VERTICES - 1 - COLUMNS + k};
        memcpy(c->indices + at, ends, sizeof ends);
        at += 6;
        for (uint32_t i = 0; i + 2 < ROWS; i++, at += 6) {
            const uint32_t a = 1 + i * COLUMNS, b = a + COLUMNS,
                           quad[6] = {a + k, b + k, b + next, a + k, b + next, a + next};
            memcpy(c->indices + at, quad, sizeof quad);
        }
    }
    assert_int_equal(at, CORNERS);
    c->positions[0].z += (float)tip;
    for (uint32_t i = 0; i < VERTICES; i++)
        c->offsets[i] = (vec3){c->positions[i].y, 0, -2 * c->positions[i].x};
    c->p = (primitive){.vertex_count = VERTICES,
                       .index_count = CORNERS,
                       .positions = c->positions,
                       .normals = c->normals,
                       .indices = c->indices,
                       .bounds = box3_empty()};
    for (uint32_t i = 0; i < VERTICES; i++)
        c->p.bounds = box3_with_point(c->p.bounds, c->positions[i]);
    shade(c);
    c->m = (mesh){.primitives = &c->p, .primitive_count = 1};
    return c;
}

static mesh rounded(const mesh *m)
{
    mesh          out;
    lmn_error     error;
    round_options options = {.crease_angle = PI / 6, .tolerance = 1.0 / 2000, .most_vertices = 100000};
    if (mesh_round(&out, m, &options, &error) != LMN_OK)
        fail_msg("%s", error.message);
    return out;
}

static double angle_between(const double a[3], const double b[3])
{
    double c[3];
    vector3_cross(c, a, b);
    return atan2(vector3_length(c), vector3_dot(a, b));
}

static int compare_numbers(const void *one, const void *other)
{
    double a = *(const double *)one, b = *(const double *)other;
    return (a > b) - (a < b);
}

/* How far normals lean from their triangles: what 95 of 100 corners keep to. */
static double lean_of(const primitive *p)
{
    double *all = malloc(p->index_count * sizeof *all);
    for (uint32_t c = 0; c < p->index_count; c++) {
        double face[3], own[3];
        face_of(face, p, c);
        point_of(own, p->normals[p->indices[c]]);
        all[c] = angle_between(face, own);
    }
    qsort(all, p->index_count, sizeof *all, compare_numbers);
    double out = all[p->index_count * 95 / 100];
    free(all);
    return out;
}

/* By how much the surface turns over its edges at most, and how many are open. */
static double turn_of(const primitive *p, size_t *open)
{
    uint32_t *beside = mesh_adjacency(p);
    double    most = 0;
    assert_non_null(beside);
    *open = 0;
    for (uint32_t c = 0; c < p->index_count; c++) {
        double one[3], other[3];
        if (beside[c] == UINT32_MAX) {
            ++*open;
            continue;
        }
        face_of(one, p, c);
        face_of(other, p, beside[c]);
        most = fmax(most, angle_between(one, other));
    }
    mem_free(beside);
    return most;
}

/* Seen along z: by how much the outline turns between two of its edges at most, where what is left of it is seen. */
static double turn_of_outline(const primitive *p)
{
    enum { WAYS = 720 };
    double far[WAYS], most = 0;
    for (int i = 0; i < WAYS;
         i++) { /* the hull's reach in each direction tells its edges: normals jump where it turns */
        double a = 2 * PI * i / WAYS;
        far[i] = -INFINITY;
        for (uint32_t v = 0; v < p->vertex_count; v++)
            far[i] = fmax(far[i], p->positions[v].x * cos(a) + p->positions[v].y * sin(a));
    }
    for (int i = 0, run = 0; i < 2 * WAYS;
         i++) { /* at a corner the reach is a cosine: it bends by what the corner is */
        double a = far[i % WAYS], b = far[(i + 1) % WAYS], c = far[(i + 2) % WAYS];
        bool   corner = fabs(a + c - 2 * cos(2 * PI / WAYS) * b) < 1e-6;
        run = corner ? run + 1 : 0;
        most = fmax(most, (run + 1) * 2 * PI / WAYS);
    }
    return most;
}

static void cages_become_smooth(void **state)
{
    (void)state;
    cage            *c = ear(0.03, 0);
    mesh             m = rounded(&c->m);
    const primitive *p = &m.primitives[0];
    size_t           open, open_before;
    assert_int_equal(m.primitive_count, 1);
    printf("turn %.1f -> %.1f, normals %.1f -> %.1f, outline %.1f -> %.1f degrees\n",
           turn_of(&c->p, &open_before) / DEGREE, turn_of(p, &open) / DEGREE, lean_of(&c->p) / DEGREE,
           lean_of(p) / DEGREE, turn_of_outline(&c->p) / DEGREE, turn_of_outline(p) / DEGREE);
    assert_int_equal(open_before, 0);
    assert_int_equal(open, 0);
    assert_int_equal(p->vertex_count, p->index_count / 6 + 2); /* Euler: none is there twice */
    assert_true(turn_of(&c->p, &open) > 80 * DEGREE);
    assert_true(turn_of(p, &open) < 35 * DEGREE);
    assert_true(lean_of(p) < 6 * DEGREE);
    assert_true(turn_of_outline(p) < 8 * DEGREE);
    mesh_release(&m);
    free(c);
}

/* It is neither thinner, nor has it lost its tip. */
static void cages_keep_their_size(void **state)
{
    (void)state;
    cage            *c = ear(0.03, 0.9);
    mesh             m = rounded(&c->m);
    const primitive *p = &m.primitives[0];
    double           grown = 0, tip = (double)p->positions[0].z - c->positions[0].z;
    for (uint32_t v = 1; v < VERTICES; v++) { /* which are the first ones still */
        double from[3], to[3], n[3];
        point_of(from, c->positions[v]);
        point_of(to, p->positions[v]);
        point_of(n, c->normals[v]);
        vector3_add(to, to, -1, from);
        grown += vector3_dot(to, n) / (VERTICES - 1);
    }
    printf("grown by %.4f, the tip by %.4f\n", grown, tip);
    assert_true(fabs(grown) < 0.01);
    assert_true(fabs(tip) < 0.05);
    box3 box = box3_empty();
    for (uint32_t v = 0; v < p->vertex_count; v++)
        box = box3_with_point(box, p->positions[v]);
    assert_memory_equal(&box, &p->bounds, sizeof box); /* of what is drawn */
    mesh_release(&m);
    free(c);
}

/* However far a cage turns over its edges: where it is smooth no crease is. */
static void cages_have_no_creases(void **state)
{
    (void)state;
    cage         *c = ear(0.03, 0.9);
    round_crease *sharp = malloc(CORNERS * sizeof *sharp);
    for (uint32_t i = 0; i < CORNERS; i++)
        sharp[i] =
            (round_crease){{c->positions[c->indices[i]], c->positions[c->indices[i % 3 == 2 ? i - 2 : i + 1]]}, 0.8f};
    round_options options = {PI / 6, 1.0 / 2000, 100000, false, sharp, CORNERS};
    mesh          m;
    assert_int_equal(mesh_round(&m, &c->m, &options, NULL), LMN_OK);
    assert_int_equal(m.primitive_count, 1);
    for (uint32_t i = 0; i < m.primitives[0].index_count; i++)
        assert_int_equal(m.primitives[0].edges.values[i], 1);
    mesh_release(&m);
    free(sharp);
    free(c);
}

/* Offsets that are a linear map of places still are. */
/* Lines that lie beside a cage in its mesh have no normals, and get none. */
static void lines_stay_without_normals(void **state)
{
    (void)state;
    cage         *c = ear(0.03, 0.9);
    uint32_t      ends[2] = {0, 1};
    primitive     both[2] = {c->p, {.vertex_count = 2, .positions = c->positions, .lines = ends, .line_count = 1}};
    round_options options = {PI / 6, 1.0 / 2000, 100000, false, NULL, 0};
    mesh          m, with = {.primitives = both, .primitive_count = 2};
    both[1].bounds = c->p.bounds;
    assert_int_equal(mesh_round(&m, &with, &options, NULL), LMN_OK);
    assert_int_equal(m.primitive_count, 2);
    assert_true(m.primitives[0].vertex_count > VERTICES);
    assert_int_equal(m.primitives[1].vertex_count, 2);
    assert_null(m.primitives[1].normals);
    mesh_release(&m);
    free(c);
}

static void morphs_go_along(void **state)
{
    (void)state;
    cage *c = ear(0.03, 0.9);
    c->p.morphs = &(morph_target){c->offsets, NULL};
    c->p.morph_count = 1;
    mesh             m = rounded(&c->m);
    const primitive *p = &m.primitives[0];
    assert_int_equal(m.primitive_count, 1);
    for (uint32_t i = 0; i < p->vertex_count; i++) {
        assert_true(fabsf(p->morphs[0].positions[i].x - p->positions[i].y) < 1e-5f);
        assert_true(fabsf(p->morphs[0].positions[i].z + 2 * p->positions[i].x) < 1e-5f);
    }
    mesh_release(&m);
    free(c);
}

/* Without normals of its own, with planes, or boxy: vertices keep their places. */
static void others_keep_their_vertices(void **state)
{
    (void)state;
    for (int kind = 0; kind < 3; kind++) {
        cage *c = ear(kind == 1 ? 0 : 0.03, 0);
        if (kind == 0) {
            c->p.normals = NULL;
        } else if (kind == 1) { /* a drum with ends, shaded smooth */
            for (uint32_t v = 1; v + 1 < VERTICES; v++) {
                double b = 2 * PI * ((v - 1) % COLUMNS) / COLUMNS, z = 2.0 * ((v - 1) / COLUMNS) / (ROWS - 2) - 1;
                c->positions[v] = (vec3){(float)cos(b), (float)sin(b), (float)-z};
            }
            c->positions[0] = (vec3){0, 0, 1};
            c->positions[VERTICES - 1] = (vec3){0, 0, -1};
            shade(c);
        } else { /* steps */
            for (uint32_t v = 0; v < VERTICES; v++)
                c->positions[v].z += (float)((int)(v % 2) * 0.6);
            shade(c);
        }
        c->p.bounds = box3_empty();
        for (uint32_t v = 0; v < VERTICES; v++)
            c->p.bounds = box3_with_point(c->p.bounds, c->positions[v]);
        mesh m = rounded(&c->m);
        for (uint32_t v = 0; m.primitive_count && kind && v < VERTICES; v++)
            assert_memory_equal(&m.primitives[0].positions[v], &c->positions[v], sizeof(vec3));
        for (uint32_t v = 0; m.primitive_count && kind == 1 && v < m.primitives[0].vertex_count; v++)
            assert_true(fabsf(m.primitives[0].positions[v].z) < 1.0001f);
        if (m.primitive_count && kind == 0)
            for (uint32_t i = 0; i < VERTICES; i++) {
                bool kept = false;
                for (uint32_t v = 0; v < m.primitives[0].vertex_count && !kept; v++)
                    kept = memcmp(&m.primitives[0].positions[v], &c->positions[i], sizeof(vec3)) == 0;
                assert_true(kept);
            }
        mesh_release(&m);
        free(c);
    }
}

/* Low-poly on purpose: each face has a normal of its own. */
static void facets_that_are_meant_stay(void **state)
{
    (void)state;
    cage    *c = ear(0.03, 0);
    vec3    *positions = malloc(CORNERS * sizeof *positions), *normals = malloc(CORNERS * sizeof *normals);
    uint32_t indices[CORNERS];
    for (uint32_t i = 0; i < CORNERS; i++) {
        double n[3];
        face_of(n, &c->p, i);
        assert_true(vector3_normalise(n));
        positions[i] = c->positions[c->indices[i]];
        normals[i] = (vec3){(float)n[0], (float)n[1], (float)n[2]};
        indices[i] = i;
    }
    primitive p = {.vertex_count = CORNERS,
                   .index_count = CORNERS,
                   .positions = positions,
                   .normals = normals,
                   .indices = indices,
                   .bounds = c->p.bounds};
    mesh      from = {.primitives = &p, .primitive_count = 1}, m = rounded(&from);
    assert_int_equal(m.primitive_count, 0);
    free(normals);
    free(positions);
    free(c);
}

/* Cages are made round alone if nothing else is to be; where they are not coarse they are no cages. */
static void forms_are_made_alone(void **state)
{
    (void)state;
    cage         *c = ear(0.03, 0);
    round_options options = {PI / 6, 1.0 / 2000, 100000, true, NULL, 0};
    mesh          alone, m = rounded(&c->m);
    assert_int_equal(mesh_round(&alone, &c->m, &options, NULL), LMN_OK);
    assert_int_equal(alone.primitive_count, 1);
    assert_int_equal(alone.primitives[0].vertex_count, m.primitives[0].vertex_count);
    mesh_release(&alone);
    c->p.normals = NULL;
    assert_int_equal(mesh_round(&alone, &c->m, &options, NULL), LMN_OK);
    assert_int_equal(alone.primitive_count, 0);
    c->p.normals = c->normals;
    options.tolerance = 1.0 / 20;
    assert_int_equal(mesh_round(&alone, &c->m, &options, NULL), LMN_OK);
    assert_int_equal(alone.primitive_count, 0);
    mesh_release(&m);
    free(c);
}

/* A limit leaves whole rounds out, and with them that vertices move. */
static void limits_leave_cages_whole(void **state)
{
    (void)state;
    cage  *c = ear(0.03, 0.9);
    size_t open;
    for (size_t most = 0; most < 6000; most += 700) {
        round_options options = {.crease_angle = PI / 6, .tolerance = 1.0 / 2000, .most_vertices = most};
        mesh          m;
        assert_int_equal(mesh_round(&m, &c->m, &options, NULL), LMN_OK);
        if (m.primitive_count) {
            assert_true(m.primitives[0].vertex_count <= VERTICES + most);
            turn_of(&m.primitives[0], &open);
            assert_int_equal(open, 0);
        }
        mesh_release(&m);
    }
    free(c);
}

static void without_memory_it_says_so(void **state)
{
    (void)state;
    cage *c = ear(0.03, 0.9);
    long  n = 1;
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
    assert_true(n > 30);
    free(c);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(cages_become_smooth),      cmocka_unit_test(cages_keep_their_size),
        cmocka_unit_test(cages_have_no_creases),    cmocka_unit_test(lines_stay_without_normals),
        cmocka_unit_test(morphs_go_along),          cmocka_unit_test(others_keep_their_vertices),
        cmocka_unit_test(forms_are_made_alone),     cmocka_unit_test(facets_that_are_meant_stay),
        cmocka_unit_test(limits_leave_cages_whole), cmocka_unit_test(without_memory_it_says_so),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
