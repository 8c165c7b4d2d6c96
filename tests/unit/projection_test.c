/* Scenes that are bent by a projection, against what the projection is: ways along the ground whose direction turns,
 * and pictures on a cylinder. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>

#include <cmocka.h>

#include <math.h>
#include <string.h>

#include "limner/limner.h"
#include "scene/scene.h"

#define COUNT(array) (sizeof(array) / sizeof *(array))

static const double PI = 3.14159265358979323846;

typedef struct edge {
    vec3 low, high;
} edge;

static int by_place(const void *a, const void *b)
{
    return memcmp(a, b, sizeof(edge));
}

/* Edges that only one triangle has. */
static size_t borders_of(const primitive *p)
{
    edge  *edges = malloc(p->index_count * sizeof *edges);
    size_t borders = 0;
    for (uint32_t i = 0; i < p->index_count; i++) {
        vec3 a = p->positions[p->indices[i]], b = p->positions[p->indices[i % 3 == 2 ? i - 2 : i + 1]];
        bool turned = memcmp(&a, &b, sizeof a) > 0;
        edges[i] = turned ? (edge){b, a} : (edge){a, b};
    }
    qsort(edges, p->index_count, sizeof *edges, by_place);
    for (uint32_t i = 0, end; i < p->index_count; i = end) {
        for (end = i + 1; end < p->index_count && by_place(&edges[i], &edges[end]) == 0;)
            end++;
        borders += (end - i) % 2;
    }
    free(edges);
    return borders;
}

/* Of its faces before they were bent: what is missing or twice there shows. */
static double area_of(const primitive *p)
{
    double sum = 0;
    for (uint32_t i = 0; i < p->index_count; i += 3) {
        double u[3], v[3];
        for (int c = 0; c < 3; c++) {
            u[c] = (double)(&p->straight[p->indices[i + 1]].x)[c] - (double)(&p->straight[p->indices[i]].x)[c];
            v[c] = (double)(&p->straight[p->indices[i + 2]].x)[c] - (double)(&p->straight[p->indices[i]].x)[c];
        }
        double x = u[1] * v[2] - u[2] * v[1], y = u[2] * v[0] - u[0] * v[2], z = u[0] * v[1] - u[1] * v[0];
        sum += sqrt(x * x + y * y + z * z) / 2;
    }
    return sum;
}

/* y is up; the view looks along −z. A slab of ground and a tower near its far end. */
static lmn_scene *make_scene(float far, float tall)
{
    const float ground[] = {-50, 0, 0, 50, 0, 0, 50, 0, -far, -50, 0, -far - 0.37f};
    const float tower[] = {-5, 0, 5, 5, 0, 5, 5, 0, -5, -5, 0, -5, -5, tall, 5, 5, tall, 5, 5, tall, -5, -5, tall, -5};
    const uint32_t ground_faces[] = {0, 1, 2, 0, 2, 3};
    const uint32_t tower_faces[] = {0, 2, 1, 0, 3, 2, 4, 5, 6, 4, 6, 7, 0, 1, 5, 0, 5, 4,
                                    1, 2, 6, 1, 6, 5, 2, 3, 7, 2, 7, 6, 3, 0, 4, 3, 4, 7};
    lmn_scene     *scene = NULL;
    lmn_error      error = {0};
    uint32_t       mesh = 0;
    lmn_mesh_desc  g = LMN_MESH_DESC_INIT, t = LMN_MESH_DESC_INIT;
    lmn_node_desc  n = LMN_NODE_DESC_INIT;
    g.positions = ground, g.vertex_count = 4, g.indices = ground_faces, g.index_count = 6;
    t.positions = tower, t.vertex_count = 8, t.indices = tower_faces, t.index_count = 36;
    assert_int_equal(lmn_scene_create(&scene, &error), LMN_OK);
    assert_int_equal(lmn_scene_add_mesh(scene, &g, &mesh, &error), LMN_OK);
    n.name = "ground", n.mesh = mesh;
    assert_int_equal(lmn_scene_add_node(scene, &n, NULL, &error), LMN_OK);
    assert_int_equal(lmn_scene_add_mesh(scene, &t, &mesh, &error), LMN_OK);
    n.name = "tower", n.mesh = mesh;
    n.matrix[14] = 20 - (double)far;
    assert_int_equal(lmn_scene_add_node(scene, &n, NULL, &error), LMN_OK);
    return scene;
}

static lmn_draw_desc along_the_ground(void)
{
    lmn_draw_desc d = LMN_DRAW_DESC_INIT;
    d.eye_given = true;
    d.eye[1] = 20, d.eye[2] = 50;
    d.target[1] = 0, d.target[2] = -50;
    d.up[1] = 1;
    return d;
}

static lmn_scene *project(const lmn_scene *scene, lmn_draw_desc *d, lmn_projection_desc *how)
{
    lmn_scene *out = NULL;
    lmn_error  error = {0};
    if (lmn_scene_project(&out, scene, d, how, &error) != LMN_OK)
        fail_msg("%s", error.message);
    return out;
}

/* The way along the ground as the integral of its direction, which turns evenly between two places. */
static void walk(double along, double from, double to, double angle, double *level, double *raised, double *turned)
{
    enum { STEPS = 20000 };
    *level = fmin(along, 0), *raised = 0, *turned = 0;
    for (int i = 0; i < STEPS && along > 0; i++) {
        double at = along * (i + 0.5) / STEPS;
        *turned = angle * fmin(fmax((at - from) / (to - from), 0), 1);
        *level += cos(*turned) * along / STEPS;
        *raised += sin(*turned) * along / STEPS;
    }
    *turned = angle * fmin(fmax((along - from) / (to - from), 0), 1);
}

static void ground_rises_in_the_distance(void **state)
{
    (void)state;
    const float         far = 400;
    lmn_scene          *scene = make_scene(far, 30);
    lmn_draw_desc       d = along_the_ground();
    lmn_projection_desc how = LMN_PROJECTION_DESC_INIT;
    how.angle_deg = 50, how.from = 0.2, how.to = 0.8;
    lmn_scene *bent = project(scene, &d, &how);
    assert_int_equal(bent->part_count, 2);
    assert_string_equal(bent->parts[1].path, scene->parts[1].path);
    /* From the near side of the scene, 50 before the eye. */
    double from = 0.2 * ((double)far + 0.37), to = 0.8 * ((double)far + 0.37), worst = 0, cut = 0;
    for (size_t part = 0; part < 2; part++) {
        const primitive *p = &bent->meshes[bent->nodes[bent->parts[part].node].mesh].primitives[0];
        for (uint32_t i = 0; i < p->vertex_count; i++) {
            double level, raised, turned, height = (double)p->straight[i].y;
            walk(-(double)p->straight[i].z, from, to, 50 * PI / 180, &level, &raised, &turned);
            worst = fmax(worst, fabs((double)p->positions[i].x - (double)p->straight[i].x));
            worst = fmax(worst, fabs(-(double)p->positions[i].z - (level - height * sin(turned))));
            worst = fmax(worst, fabs((double)p->positions[i].y - (raised + height * cos(turned))));
        }
        /* Pieces lie on the bent face: their middles do. */
        for (uint32_t i = 0; i < p->index_count; i += 3) {
            double at[3] = {0}, straight[3] = {0}, level, raised, turned;
            for (uint32_t k = 0; k < 3; k++)
                for (int c = 0; c < 3; c++) {
                    at[c] += (double)(&p->positions[p->indices[i + k]].x)[c] / 3;
                    straight[c] += (double)(&p->straight[p->indices[i + k]].x)[c] / 3;
                }
            walk(-straight[2], from, to, 50 * PI / 180, &level, &raised, &turned);
            cut = fmax(
                cut, hypot(-at[2] - (level - straight[1] * sin(turned)), at[1] - (raised + straight[1] * cos(turned))));
        }
        if (part == 1) /* what was closed is */
            assert_int_equal(borders_of(p), 0);
    }
    assert_true(worst < 2e-4);
    assert_true(cut < 1e-4 * (double)far);
    lmn_scene_destroy(&bent);
    lmn_scene_destroy(&scene);
}

/* The two triangles of the ground meet along their diagonal, into however many pieces it is cut. */
static void faces_stay_together(void **state)
{
    (void)state;
    lmn_scene          *scene = make_scene(400, 30);
    lmn_draw_desc       d = along_the_ground();
    lmn_projection_desc how = LMN_PROJECTION_DESC_INIT;
    for (int kind = 0; kind < 2; kind++) {
        how.projection = (lmn_projection)kind;
        lmn_scene       *bent = project(scene, &d, &how);
        const primitive *p = &bent->meshes[bent->nodes[bent->parts[0].node].mesh].primitives[0];
        size_t           inner = 0;
        assert_true(fabs(area_of(p) - (40000 + 50 * 0.37)) < 0.5);
        assert_true(p->index_count > 60);
        for (uint32_t i = 0; i < p->index_count; i++) {
            vec3 a = p->straight[p->indices[i]], b = p->straight[p->indices[i % 3 == 2 ? i - 2 : i + 1]];
            bool rim = (a.x == b.x && fabsf(a.x) == 50) || (a.z == 0 && b.z == 0) || (a.z < -399.99f && b.z < -399.99f);
            size_t same = 0;
            for (uint32_t k = 0; k < p->index_count && !rim; k++) {
                uint32_t from = p->indices[k], to = p->indices[k % 3 == 2 ? k - 2 : k + 1];
                same +=
                    memcmp(&p->positions[from], &p->positions[p->indices[i % 3 == 2 ? i - 2 : i + 1]], sizeof a) == 0 &&
                    memcmp(&p->positions[to], &p->positions[p->indices[i]], sizeof a) == 0;
            }
            inner += !rim && same != 1;
        }
        assert_int_equal(inner, 0);
        lmn_scene_destroy(&bent);
    }
    lmn_scene_destroy(&scene);
}

/* Equal angles are equal widths, heights are those over the distance; behind the eye faces are cut. */
static void panoramas_are_cylinders(void **state)
{
    (void)state;
    lmn_scene          *scene = make_scene(400, 30);
    lmn_draw_desc       d = along_the_ground();
    lmn_projection_desc how = LMN_PROJECTION_DESC_INIT;
    how.projection = LMN_PROJECTION_PANORAMA;
    how.angle_deg = 360;
    d.eye[0] = 10, d.eye[1] = 7, d.eye[2] = -150;
    d.target[0] = 10, d.target[1] = 3, d.target[2] = -100; /* looks back: the far end is behind */
    d.width = 1200, d.height = 400;
    lmn_scene *bent = project(scene, &d, &how);
    assert_true(fabs(tan(d.fov_deg * PI / 360) - PI / 3) < 1e-9);
    assert_true(d.target[1] == d.eye[1]);
    double worst = 0, widest = 0;
    for (size_t part = 0; part < 2; part++) {
        const primitive *p = &bent->meshes[bent->nodes[bent->parts[part].node].mesh].primitives[0];
        for (uint32_t i = 0; i < p->vertex_count; i++) {
            /* Looking along +z with y up, right is −x. */
            double right = d.eye[0] - (double)p->straight[i].x, ahead = (double)p->straight[i].z - d.eye[2];
            double deep = (double)p->positions[i].z - d.eye[2], off = d.eye[0] - (double)p->positions[i].x;
            double far = hypot(right, ahead), angle = atan2(right, ahead), seen = off / deep;
            if (far < 1)
                continue;
            angle = fabs(angle - seen) > PI ? angle + (seen > angle ? 2 : -2) * PI : angle; /* on the cut itself */
            worst = fmax(worst, fabs(seen - angle));
            worst = fmax(worst, fabs(((double)p->positions[i].y - d.eye[1]) / deep -
                                     ((double)p->straight[i].y - d.eye[1]) / far));
            widest = fmax(widest, fabs(seen));
        }
        assert_true(fabs(area_of(p) - (part == 0 ? 40000 + 50 * 0.37 : 4 * 300 + 2 * 100)) < 0.5);
        for (uint32_t i = 0; i < p->index_count; i += 3) { /* no piece reaches across the picture */
            double low = INFINITY, high = -INFINITY;
            for (uint32_t k = 0; k < 3; k++) {
                vec3   at = p->positions[p->indices[i + k]];
                double seen = (d.eye[0] - (double)at.x) / fmax((double)at.z - d.eye[2], 1e-9);
                low = fmin(low, seen), high = fmax(high, seen);
            }
            assert_true(high - low < PI + 1e-6);
        }
    }
    assert_true(worst < 1e-4);
    assert_true(widest > PI - 1e-4 && widest < PI + 1e-4);
    lmn_scene_destroy(&bent);
    lmn_scene_destroy(&scene);
}

static void what_cannot_be_bent_is_refused(void **state)
{
    (void)state;
    lmn_scene          *scene = make_scene(400, 300), *out = NULL;
    lmn_error           error = {0};
    lmn_draw_desc       d = LMN_DRAW_DESC_INIT, before;
    lmn_projection_desc how = LMN_PROJECTION_DESC_INIT, wrong = LMN_PROJECTION_DESC_INIT;
    d.view = LMN_VIEW_TOP;
    before = d;
    assert_int_equal(lmn_scene_project(&out, scene, &d, &how, &error), LMN_USAGE);
    assert_memory_equal(&d, &before, sizeof d);
    how.projection = LMN_PROJECTION_PANORAMA;
    d.view = LMN_VIEW_FRONT;
    assert_int_equal(lmn_scene_project(&out, scene, &d, &how, &error), LMN_USAGE);
    d = along_the_ground();
    how.projection = LMN_PROJECTION_MULTI_PERSPECTIVE;
    how.angle_deg = 60;
    assert_int_equal(lmn_scene_project(&out, scene, &d, &how, &error), LMN_UNSUPPORTED); /* 300 high */
    wrong.from = 0.8, wrong.to = 0.2;
    assert_int_equal(lmn_scene_project(&out, scene, &d, &wrong, &error), LMN_USAGE);
    wrong = how, wrong.angle_deg = 91;
    assert_int_equal(lmn_scene_project(&out, scene, &d, &wrong, &error), LMN_USAGE);
    d.matrices_given = true;
    assert_int_equal(lmn_scene_project(&out, scene, &d, &how, &error), LMN_UNSUPPORTED);
    assert_null(out);
    lmn_scene_destroy(&scene);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(ground_rises_in_the_distance),
        cmocka_unit_test(faces_stay_together),
        cmocka_unit_test(panoramas_are_cylinders),
        cmocka_unit_test(what_cannot_be_bent_is_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
