/* Silhouettes found level by level against all faces tested: nothing wrong is found, hardly anything is missed, few
 * faces are asked for. Row OE-10. */
#include "field_shapes.h"

#include "stroke/butterfly_mesh.h"
#include "stroke/stroke.h"

typedef uint32_t corners3[3];

typedef struct eye_test {
    const butterfly *b;
    place3           eye;
} eye_test;

/* In double precision, from the positions alone. */
static bool sees_front(void *user, uint32_t level, uint32_t face)
{
    const eye_test *t = user;
    const uint32_t *c = t->b->levels[level].faces[face];
    vec3            p = t->b->positions[c[0]], q = t->b->positions[c[1]], r = t->b->positions[c[2]];
    double          ax = (double)q.x - p.x, ay = (double)q.y - p.y, az = (double)q.z - p.z, bx = (double)r.x - p.x,
           by = (double)r.y - p.y, bz = (double)r.z - p.z;
    return (ay * bz - az * by) * (t->eye.x - p.x) + (az * bx - ax * bz) * (t->eye.y - p.y) +
               (ax * by - ay * bx) * (t->eye.z - p.z) >
           0;
}

static place3 eye_number(uint32_t i)
{
    double z = 2 * hashed(3 * i) - 1, a = 2 * field_pi * hashed(3 * i + 1), r = 12 + 40 * hashed(3 * i + 2),
           s = sqrt(1 - z * z);
    return (place3){r * s * cos(a), r * s * sin(a), r * z};
}

typedef struct score {
    uint64_t found, wrong, missed, there, tested, faces;
} score;

/* Every vertex has as many silhouette edges leaving as arriving: loops stay closed. */
static void loops_are_closed(const butterfly *b, const silhouette *s)
{
    const butterfly_level *l = &b->levels[b->level_count - 1];
    int32_t               *balance = mem_calloc(l->vertex_count, sizeof *balance);
    for (size_t i = 0; i < s->count; i++) {
        uint32_t h = s->halves[i];
        balance[l->faces[h / 3][h % 3]]++;
        balance[l->faces[h / 3][(h + 1) % 3]]--;
    }
    for (uint32_t v = 0; v < l->vertex_count; v++)
        assert_int_equal(balance[v], 0);
    mem_free(balance);
}

static void compare(const butterfly *b, uint32_t all_of, place3 eye, bool closed, score *out)
{
    silhouette s;
    eye_test   test = {b, eye};
    assert_int_equal(silhouette_propagate(&s, b, all_of, sees_front, &test, NULL), LMN_OK);
    const butterfly_level *l = &b->levels[b->level_count - 1];
    uint8_t               *found = mem_calloc((size_t)l->face_count * 3, 1);
    for (size_t i = 0; i < s.count; i++)
        found[s.halves[i]] = 1;
    for (uint32_t h = 0; h < 3 * l->face_count; h++) {
        uint32_t o = l->opposite[h];
        bool     is = o != BUTTERFLY_NONE && sees_front(&test, b->level_count - 1, h / 3) &&
                  !sees_front(&test, b->level_count - 1, o / 3);
        out->there += is;
        out->found += found[h];
        out->wrong += found[h] && !is;
        out->missed += is && !found[h];
    }
    if (closed)
        loops_are_closed(b, &s);
    out->tested += s.tested[b->level_count - 1];
    out->faces += l->face_count;
    mem_free(found);
    silhouette_release(&s);
}

enum { VIEWS = 40 };

static score score_model(const char *name, const primitive *p, uint32_t all_of, int steps, bool closed)
{
    butterfly b;
    assert_int_equal(butterfly_refine(&b, p->positions, p->vertex_count, (const corners3 *)p->indices,
                                      p->index_count / 3, NULL, steps, NULL),
                     LMN_OK);
    score all = {0};
    for (uint32_t i = 0; i < VIEWS; i++)
        compare(&b, all_of, eye_number(i), closed, &all);
    printf("%-10s %d steps: recall %.2f %%, wrong %lu of %lu, %.2f %% of %u faces tested\n", name, steps,
           100.0 - 100.0 * (double)all.missed / (double)all.there, (unsigned long)all.wrong, (unsigned long)all.found,
           100.0 * (double)all.tested / (double)all.faces, b.levels[steps].face_count);
    butterfly_release(&b);
    return all;
}

static void smooth_shapes_are_found_whole(void **state)
{
    (void)state;
    primitive torus = grid_surface(torus_at, 48, 24, true, true, 0.2), sphere = ball(8, 0, (place3){1, 1, 1});
    for (int steps = 1; steps <= 3; steps++) {
        score t = score_model("torus", &torus, 0, steps, true), s = score_model("sphere", &sphere, 0, steps, true);
        assert_int_equal(t.wrong + s.wrong, 0);
        assert_true((double)t.missed <= 0.01 * (double)t.there && (double)s.missed <= 0.01 * (double)s.there);
        assert_true(t.tested * 2 < t.faces && s.tested * 2 < s.faces);
    }
    primitive_release(&torus);
    primitive_release(&sphere);
}

static void welded(primitive *p)
{
    uint32_t *ids = mesh_position_ids(p);
    for (uint32_t i = 0; i < p->index_count; i++)
        p->indices[i] = ids[p->indices[i]];
    mem_free(ids);
}

/* Suzanne has 968 faces, too few for her shape: two levels are searched whole. */
static void models_are_found(void **state)
{
    (void)state;
    static const char *const names[] = {"mesh/spot.obj", "mesh/suzanne.obj"};
    static const uint32_t    all_of[] = {0, 16384};
    for (size_t i = 0; i < 2; i++) {
        primitive p;
        if (!model_primitive(names[i], &p))
            skip();
        welded(&p);
        for (int steps = i == 0 ? 1 : 3; steps <= 3; steps++) {
            score s = score_model(names[i] + 5, &p, all_of[i], steps, i == 0);
            assert_int_equal(s.wrong, 0);
            assert_true(s.tested * 2 < s.faces);
            assert_true((double)s.missed <= 0.01 * (double)s.there);
        }
        primitive_release(&p);
    }
}

/* A bump that only refining brings forth: nobody looks there, so it stays unknown, and nothing else suffers. */
static void what_refining_invents_is_not_asked_for(void **state)
{
    (void)state;
    primitive p = ball(4, 0, (place3){1, 1, 1});
    butterfly b;
    assert_int_equal(butterfly_refine(&b, p.positions, p.vertex_count, (const corners3 *)p.indices, p.index_count / 3,
                                      NULL, 2, NULL),
                     LMN_OK);
    uint32_t top = 0;
    for (uint32_t v = p.vertex_count; v < b.levels[2].vertex_count; v++)
        top = b.positions[v].z > b.positions[top].z ? v : top;
    b.positions[top].z += 5;
    score s = {0};
    compare(&b, 0, (place3){0, 0, 40}, true, &s);
    assert_int_equal(s.wrong, 0);
    assert_true(s.missed == 0 || s.missed < 20); /* the spike's own outline at most */
    butterfly_release(&b);
    primitive_release(&p);
}

static void meshes_with_borders_end_there(void **state)
{
    (void)state;
    primitive p = grid_surface(torus_at, 24, 12, false, false, 0);
    score     s = score_model("slit torus", &p, 0, 2, false);
    assert_int_equal(s.wrong, 0);
    assert_true((double)s.missed <= 0.01 * (double)s.there);
    primitive_release(&p);
}

/* --- refined edge meshes -------------------------------------------------------------------------------- */

static void refined_edge_meshes_know_where_they_come_from(void **state)
{
    (void)state;
    primitive p = ball(16, 0, (place3){1, 1, 1});
    mesh      m = {.primitives = &p, .primitive_count = 1};
    edge_mesh e;
    assert_int_equal(edge_mesh_create(&e, &m, NULL, 1.0, NULL), LMN_OK);
    uint32_t faces = e.face_count;
    assert_int_equal(edge_mesh_refine(&e, 2, NULL), LMN_OK);
    assert_int_equal(e.face_count, 16 * faces);
    assert_int_equal(e.vertex_count, 2 + e.face_count / 2);
    assert_int_equal(e.piece_count, 1);
    assert_true(e.closed[0] && !e.inward[0]);
    for (uint32_t i = 0; i < e.edge_count; i++)
        assert_int_equal(e.edges[i].flags & ~(uint32_t)EDGE_HOLLOW, EDGE_CANDIDATE); /* rounding dents some */
    eye_test test = {&e.refinement->surface, {3, 20, 7}};
    uint8_t *marks = mem_calloc(e.edge_count, 1);
    uint64_t tested;
    assert_int_equal(edge_mesh_silhouette(&e, sees_front, &test, marks, &tested, NULL), LMN_OK);
    uint32_t marked = 0;
    for (uint32_t i = 0; i < e.edge_count; i++) {
        bool a = sees_front(&test, 2, e.edges[i].face[0]), b = sees_front(&test, 2, e.edges[i].face[1]);
        assert_int_equal(marks[i], a != b);
        marked += marks[i];
    }
    assert_true(marked > 20 && tested < 16 * faces);
    mem_free(marks);
    edge_mesh_release(&e);
    primitive_release(&p);
}

/* A box of two materials: sharp edges stay lines, flat faces stay flat, materials go along. */
static void refined_boxes_stay_boxes(void **state)
{
    (void)state;
    static const uint32_t faces[12][3] = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                                          {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
    primitive             halves[2];
    for (int i = 0; i < 2; i++) {
        halves[i] = empty_primitive(8, 18);
        halves[i].material = i;
        for (uint32_t v = 0; v < 8; v++)
            halves[i].positions[v] = (vec3){v & 1 ? 3 : -3, v & 2 ? 1 : -1, v & 4 ? 1 : -1};
        memcpy(halves[i].indices, faces[6 * i], sizeof faces / 2);
    }
    mesh      m = {.primitives = halves, .primitive_count = 2};
    edge_mesh e;
    assert_int_equal(edge_mesh_create(&e, &m, NULL, 0.5, NULL), LMN_OK);
    assert_int_equal(e.edge_count, 12);
    assert_int_equal(edge_mesh_refine(&e, 3, NULL), LMN_OK);
    assert_int_equal(e.edge_count, 12 * 8);
    double length = 0;
    for (uint32_t i = 0; i < e.edge_count; i++) {
        vec3 a = e.positions[e.edges[i].vertex[0]], b = e.positions[e.edges[i].vertex[1]];
        assert_true(e.edges[i].flags & EDGE_CREASE);
        assert_false(e.edges[i].flags & (EDGE_BORDER | EDGE_CANDIDATE));
        length += sqrt((double)(a.x - b.x) * (a.x - b.x) + (double)(a.y - b.y) * (a.y - b.y) +
                       (double)(a.z - b.z) * (a.z - b.z));
    }
    assert_true(fabs(length - (4 * 6 + 8 * 2)) < 1e-5);
    for (uint32_t f = 0; f < e.face_count; f++)
        assert_int_equal(e.materials[f], f / 64 >= 6);
    edge_mesh_release(&e);
    primitive_release(&halves[0]);
    primitive_release(&halves[1]);
}

static void memory_may_run_out(void **state)
{
    (void)state;
    primitive p = ball(2, 0, (place3){1, 1, 1});
    mesh      m = {.primitives = &p, .primitive_count = 1};
    edge_mesh e;
    assert_int_equal(edge_mesh_create(&e, &m, NULL, 1.0, NULL), LMN_OK);
    lmn_status status = LMN_MEMORY;
    long       n = 1;
    for (; status != LMN_OK && n < 200; n++) {
        mem_fail_at(n);
        status = edge_mesh_refine(&e, 2, NULL);
        mem_fail_at(0);
        assert_true(status == LMN_OK || (status == LMN_MEMORY && e.face_count == p.index_count / 3 && !e.refinement));
    }
    assert_true(n > 20 && status == LMN_OK);
    eye_test test = {&e.refinement->surface, {0, 0, 9}};
    uint8_t *marks = mem_calloc(e.edge_count, 1);
    status = LMN_MEMORY;
    for (n = 1; status != LMN_OK && n < 200; n++) {
        mem_fail_at(n);
        status = edge_mesh_silhouette(&e, sees_front, &test, marks, NULL, NULL);
        mem_fail_at(0);
    }
    assert_true(n > 5 && status == LMN_OK);
    mem_free(marks);
    edge_mesh_release(&e);
    primitive_release(&p);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(smooth_shapes_are_found_whole),
        cmocka_unit_test(models_are_found),
        cmocka_unit_test(what_refining_invents_is_not_asked_for),
        cmocka_unit_test(meshes_with_borders_end_there),
        cmocka_unit_test(refined_edge_meshes_know_where_they_come_from),
        cmocka_unit_test(refined_boxes_stay_boxes),
        cmocka_unit_test(memory_may_run_out),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
