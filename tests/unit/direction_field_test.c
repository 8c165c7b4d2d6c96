/* Fields of directions against surfaces whose curvature is known, and on meshes that are barely meshes. Row P26 of
 * the notes on pencils. */
#include "field_shapes.h"

#include "field/direction_field_private.h"

#include "field/direction_field.h"

static direction_field make_field(const primitive *p)
{
    direction_field f;
    assert_int_equal(direction_field_make(&f, p, 0.8, 0, 0, NULL), LMN_OK);
    return f;
}

/* The direction's unit vector and how sure it is, from a tensor: its axis is the row of T + s·(I − n nᵀ) that is
 * longest, (T + s P) = 2 s d dᵀ. */
static place3 axis_of(const float *t, place3 n, double *sure)
{
    double sum = 0, best = 0;
    for (int k = 0; k < 6; k++)
        sum += (k < 3 ? 1 : 2) * (double)t[k] * t[k];
    double       s = *sure = sqrt(sum / 2);
    const double m[3][3] = {{t[0] + s * (1 - n.x * n.x), t[3] - s * n.x * n.y, t[5] - s * n.z * n.x},
                            {t[3] - s * n.x * n.y, t[1] + s * (1 - n.y * n.y), t[4] - s * n.y * n.z},
                            {t[5] - s * n.z * n.x, t[4] - s * n.y * n.z, t[2] + s * (1 - n.z * n.z)}};
    place3       out = {1, 0, 0};
    for (int k = 0; k < 3; k++) {
        double l = sqrt(m[k][0] * m[k][0] + m[k][1] * m[k][1] + m[k][2] * m[k][2]);
        if (l > best) {
            best = l;
            out = (place3){m[k][0] / l, m[k][1] / l, m[k][2] / l};
        }
    }
    return out;
}

/* What is right at a position: normal and direction of the greatest absolute curvature; false where that is no
 * direction. */
typedef bool (*truth_fn)(place3 at, place3 *normal, place3 *direction);

static int by_size(const void *a, const void *b)
{
    double x = *(const double *)a, y = *(const double *)b;
    return x < y ? -1 : x > y;
}

/* Median and 95th percentile of the angles between the field, or its crosses, and the truth, degrees. */
static void measure_field(const primitive *p, const direction_field *f, truth_fn truth, bool crosses, bool rotated,
                          double *median, double *most)
{
    double *angles = mem_alloc(p->vertex_count * sizeof *angles);
    size_t  count = 0;
    assert_int_equal(f->count, p->vertex_count);
    for (uint32_t v = 0; v < p->vertex_count; v++) {
        place3 at = {p->positions[v].x, p->positions[v].y, p->positions[v].z}, n, d;
        if (rotated)
            at = turned_back(at);
        if (!truth(at, &n, &d))
            continue;
        if (rotated) {
            n = turned(n);
            d = turned(d);
        }
        double sure;
        place3 own = axis_of(f->tensors[v], n, &sure);
        double cosine = fabs(own.x * d.x + own.y * d.y + own.z * d.z),
               angle = acos(cosine > 1 ? 1 : cosine) * 180 / field_pi;
        angles[count++] = crosses ? fmin(angle, 90 - angle) : angle;
    }
    qsort(angles, count, sizeof *angles, by_size);
    *median = angles[count / 2];
    *most = angles[count * 95 / 100];
    mem_free(angles);
}

static void unit(place3 *p)
{
    double l = sqrt(p->x * p->x + p->y * p->y + p->z * p->z);
    *p = (place3){p->x / l, p->y / l, p->z / l};
}

static bool torus_truth(place3 p, place3 *n, place3 *d)
{
    double r = hypot(p.x, p.y), c = p.x / r, s = p.y / r;
    *n = (place3){(r - 3) * c, (r - 3) * s, p.z};
    unit(n);
    double ring = n->x * c + n->y * s;
    *d = (place3){-n->z * c, -n->z * s, ring}; /* around the tube */
    return true;
}

static bool cylinder_truth(place3 p, place3 *n, place3 *d)
{
    *n = (place3){p.x, p.y, 0};
    unit(n);
    *d = (place3){-n->y, n->x, 0};
    return true;
}

/* From gradient and second derivatives of an implicit function. */
static bool implicit_truth(place3 g, const double h[6], place3 *n, place3 *d)
{
    place3 u, v;
    *n = g;
    unit(n);
    u = fabs(n->x) < 0.6 ? (place3){0, n->z, -n->y} : (place3){-n->z, 0, n->x};
    unit(&u);
    v = (place3){n->y * u.z - n->z * u.y, n->z * u.x - n->x * u.z, n->x * u.y - n->y * u.x};
    double uu = h[0] * u.x * u.x + h[1] * u.y * u.y + h[2] * u.z * u.z,
           vv = h[0] * v.x * v.x + h[1] * v.y * v.y + h[2] * v.z * v.z;
    double uv = h[0] * u.x * v.x + h[1] * u.y * v.y + h[2] * u.z * v.z;
    double mean = (uu + vv) / 2, half = hypot((uu - vv) / 2, uv), angle = atan2(uv, (uu - vv) / 2) / 2;
    if (mean < 0)
        angle += field_pi / 2;
    *d = (place3){u.x * cos(angle) + v.x * sin(angle), u.y * cos(angle) + v.y * sin(angle),
                  u.z * cos(angle) + v.z * sin(angle)};
    double less = fmin(fabs(mean), half), greater = fmax(fabs(mean), half);
    return less > 0.1 * greater;
}

static bool ellipsoid_truth(place3 p, place3 *n, place3 *d)
{
    const double h[6] = {1.0 / 9, 1.0 / 4, 1};
    return implicit_truth((place3){p.x / 9, p.y / 4, p.z}, h, n, d);
}

static bool saddle_truth(place3 p, place3 *n, place3 *d)
{
    const double h[6] = {-2, 1, 0};
    return implicit_truth((place3){-2 * p.x, p.y, 1}, h, n, d);
}

static void check_crosses(const char *name, primitive p, truth_fn truth, bool crosses)
{
    for (int rotated = 0; rotated < 2; rotated++) {
        double median, most;
        if (rotated)
            turn_primitive(&p);
        direction_field f = make_field(&p);
        measure_field(&p, &f, truth, crosses, rotated, &median, &most);
        printf("%-28s %s %6u triangles: median %.2f, 95 %% %.2f degrees\n", name, rotated ? "turned" : "      ",
               p.index_count / 3, median, most);
        direction_field_release(&f);
        assert_true(median <= 5 && most <= 15);
    }
    primitive_release(&p);
}

static void check_accuracy(const char *name, primitive p, truth_fn truth)
{
    check_crosses(name, p, truth, false);
}

static void directions_agree_with_known_surfaces(void **state)
{
    (void)state;
    const place3 axes = {3, 2, 1};
    check_accuracy("ellipsoid", ball(24, 0, axes), ellipsoid_truth);
    check_accuracy("ellipsoid, jittered", ball(24, 0.6, axes), ellipsoid_truth);
    check_accuracy("ellipsoid, dense, jittered", ball(80, 0.9, axes), ellipsoid_truth);
    check_accuracy("torus", grid_surface(torus_at, 64, 24, true, true, 0), torus_truth);
    check_accuracy("torus, jittered", grid_surface(torus_at, 64, 24, true, true, 0.7), torus_truth);
    check_accuracy("torus, coarse", grid_surface(torus_at, 24, 10, true, true, 0), torus_truth);
    check_accuracy("cylinder", grid_surface(cylinder_at, 32, 24, true, false, 0), cylinder_truth);
    check_accuracy("cylinder, slivers", grid_surface(cylinder_at, 32, 1, true, false, 0), cylinder_truth);
    check_accuracy("cylinder, irregular", grid_surface(cylinder_at, 32, 24, true, false, 0.8), cylinder_truth);
    check_accuracy("cylinder, very irregular", grid_surface(cylinder_at, 60, 12, true, false, 1), cylinder_truth);
    /* Towards its corners a saddle bends nearly as much one way as the other, and which is more changes: arms go on
     * there, so only crosses are compared; which arm is meant in the middle is looked at below. */
    check_crosses("saddle", grid_surface(saddle_at, 24, 24, false, false, 0), saddle_truth, true);
    check_crosses("saddle, jittered", grid_surface(saddle_at, 24, 24, false, false, 0.7), saddle_truth, true);
}

/* --- what always holds ---------------------------------------------------------------------------------- */

/* Finite, no trace, within 1; in the plane of each triangle that has the corner, when `flat` says that these agree. */
static void check_tensors(const primitive *p, const direction_field *f, bool flat)
{
    assert_int_equal(f->count, p->vertex_count);
    assert_true(f->tensor_count >= f->count && f->tensors);
    for (uint32_t k = 0; k < f->tensor_count; k++) {
        const float *t = f->tensors[k];
        double       sum = 0;
        for (int i = 0; i < 6; i++) {
            assert_true(isfinite(t[i]));
            sum += (i < 3 ? 1 : 2) * (double)t[i] * t[i];
        }
        assert_true(sqrt(sum / 2) <= 1 + 1e-4);
        assert_true(fabs((double)t[0] + t[1] + t[2]) <= 1e-4);
        /* T n = 0 for some n: no third direction. */
        double determinant = t[0] * ((double)t[1] * t[2] - (double)t[4] * t[4]) -
                             t[3] * ((double)t[3] * t[2] - (double)t[4] * t[5]) +
                             t[5] * ((double)t[3] * t[4] - (double)t[1] * t[5]);
        assert_true(fabs(determinant) <= 1e-4);
    }
    for (uint32_t c = 0; c < p->index_count; c++) {
        const uint32_t *k = p->indices + c / 3 * 3;
        const float    *t = direction_field_at(f, p, c);
        vec3            a = p->positions[k[0]], b = p->positions[k[1]], d = p->positions[k[2]];
        double          u[3] = {(double)b.x - a.x, (double)b.y - a.y, (double)b.z - a.z},
               v[3] = {(double)d.x - a.x, (double)d.y - a.y, (double)d.z - a.z};
        place3 n = {u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]};
        double l = sqrt(n.x * n.x + n.y * n.y + n.z * n.z);
        assert_true(c == 0 || direction_field_at(f, p, c) >= f->tensors[0]);
        if (!flat || !(l > 0))
            continue;
        assert_true(fabs(t[0] * n.x + t[3] * n.y + t[5] * n.z) <= 1e-4 * l);
        assert_true(fabs(t[3] * n.x + t[1] * n.y + t[4] * n.z) <= 1e-4 * l);
        assert_true(fabs(t[5] * n.x + t[4] * n.y + t[2] * n.z) <= 1e-4 * l);
    }
}

static void check_anything(primitive p)
{
    for (int i = 0; i < 3; i++) {
        const double    features[3] = {0, 0.8, 4}, radii[3] = {0, 1e9, 1e-9};
        direction_field f;
        assert_int_equal(direction_field_make(&f, &p, features[i], radii[i], 0, NULL), LMN_OK);
        check_tensors(&p, &f, false);
        direction_field_release(&f);
    }
    primitive_release(&p);
}

static double sureness_of(const float *t)
{
    double sum = 0;
    for (int i = 0; i < 6; i++)
        sum += (i < 3 ? 1 : 2) * (double)t[i] * t[i];
    return sqrt(sum / 2);
}

/* l·T·l: 1 along d, −1 across, times the sureness. */
static double along(const float *t, place3 l)
{
    return t[0] * l.x * l.x + t[1] * l.y * l.y + t[2] * l.z * l.z +
           2 * (t[3] * l.x * l.y + t[4] * l.y * l.z + t[5] * l.z * l.x);
}

static void the_greater_curvature_is_meant(void **state)
{
    (void)state;
    /* The sum of edges bent points along a cylinder's axis; the field must not. */
    primitive       p = grid_surface(cylinder_at, 32, 24, true, false, 0.5);
    direction_field f = make_field(&p);
    for (uint32_t v = 0; v < p.vertex_count; v++) {
        assert_true(along(f.tensors[v], (place3){0, 0, 1}) < -0.9);
        place3 ring = {-p.positions[v].y, p.positions[v].x, 0};
        assert_true(along(f.tensors[v], ring) > 0.9);
    }
    direction_field_release(&f);
    primitive_release(&p);
    /* A saddle bends 2 along x and 1, the other way, along y: the sureness is 1/3 in its middle. Without signs
     * nothing could be told. */
    p = grid_surface(saddle_at, 40, 40, false, false, 0);
    f = make_field(&p);
    double sure = along(f.tensors[20 * 41 + 20], (place3){1, 0, 0});
    printf("saddle: %.3f along x\n", sure);
    assert_true(fabs(sure - 1.0 / 3) < 0.05);
    direction_field_release(&f);
    primitive_release(&p);
}

static void a_ball_is_not_sure_of_anything(void **state)
{
    (void)state;
    const place3    round = {2, 2, 2};
    primitive       p = ball(24, 0.7, round);
    direction_field f = make_field(&p);
    double          most = 0, mean = 0;
    check_tensors(&p, &f, false);
    for (uint32_t v = 0; v < p.vertex_count; v++) {
        double s = sureness_of(f.tensors[v]);
        most = s > most ? s : most;
        mean += s / p.vertex_count;
    }
    printf("ball: sureness %.3f, at most %.3f\n", mean, most);
    assert_true(most < 0.1);
    direction_field_release(&f);
    primitive_release(&p);
}

static void a_plane_is_drawn_along_its_longer_side(void **state)
{
    (void)state;
    for (int rotated = 0; rotated < 2; rotated++) {
        primitive p = grid_surface(plane_at, 12, 4, false, false, rotated ? 0.6 : 0);
        place3    x = {1, 0, 0};
        if (rotated) {
            turn_primitive(&p);
            x = turned(x);
        }
        direction_field f = make_field(&p);
        check_tensors(&p, &f, true);
        for (uint32_t v = 0; v < p.vertex_count; v++)
            assert_true(fabs(along(f.tensors[v], x) - 0.05) < 1e-3);
        direction_field_release(&f);
        primitive_release(&p);
    }
}

/* A wall shaped like an L: how far it reaches is askew, its borders are not. */
static void a_facade_is_drawn_along_its_border(void **state)
{
    (void)state;
    static const vec3     corners[8] = {{0, 0, 0}, {4, 0, 0}, {4, 0, 1}, {1, 0, 1},
                                        {1, 0, 3}, {0, 0, 3}, {0, 0, 1}, {1, 0, 0}};
    static const uint32_t triangles[18] = {0, 7, 3, 0, 3, 6, 7, 1, 2, 7, 2, 3, 6, 3, 4, 6, 4, 5};
    primitive             p = empty_primitive(8, 18);
    memcpy(p.positions, corners, sizeof corners);
    memcpy(p.indices, triangles, sizeof triangles);
    turn_primitive(&p);
    direction_field f = make_field(&p);
    check_tensors(&p, &f, true);
    for (uint32_t v = 0; v < 8; v++)
        assert_true(along(f.tensors[v], turned((place3){1, 0, 0})) > 0.0499);
    direction_field_release(&f);
    primitive_release(&p);
}

static void faces_of_a_cube_have_one_direction_each(void **state)
{
    (void)state;
    primitive       p = shared_cube();
    direction_field f = make_field(&p);
    check_tensors(&p, &f, true);
    assert_non_null(f.corners);
    for (uint32_t c = 0; c < p.index_count; c += 6) {
        for (uint32_t k = 0; k < 6; k++)
            assert_true(memcmp(direction_field_at(&f, &p, c), direction_field_at(&f, &p, c + k), sizeof *f.tensors) ==
                        0);
        assert_true(fabs(sureness_of(direction_field_at(&f, &p, c)) - 0.05) < 1e-4);
        /* Along one of the cube's own edges. */
        const float *t = direction_field_at(&f, &p, c);
        assert_true(fabs(t[3]) + fabs(t[4]) + fabs(t[5]) < 1e-4);
        /* All are as long as they are wide: x before y before z. */
        assert_true(t[0] > 0.04f || (t[0] == 0 && t[1] > 0.04f));
    }
    direction_field_release(&f);
    primitive_release(&p);
}

/* A drum: its flat ends are as round as can be, and must still have one direction; its side is sure. */
static place3 bowl_at(double u, double v)
{
    double a = 2 * field_pi * u, r = v < 0.5 ? v * 4 : 2 + sin((v - 0.5) * field_pi),
           z = v < 0.5 ? 0 : 1 - cos((v - 0.5) * field_pi);
    return (place3){r * cos(a), r * sin(a), z};
}

/* Half a cylinder that goes on as a plane: the plane has the cylinder's direction, though it is longer the other
 * way. */
static place3 hook_at(double u, double v)
{
    double s = 8 * u;
    if (s < field_pi)
        return (place3){sin(s), 1 - cos(s), 12 * v};
    return (place3){-(s - field_pi), 2, 12 * v};
}

static void flat_positions_take_after_what_bends_beside_them(void **state)
{
    (void)state;
    primitive       p = grid_surface(hook_at, 80, 120, false, false, 0);
    direction_field f = make_field(&p);
    check_tensors(&p, &f, false);
    for (uint32_t v = 0; v < p.vertex_count; v++)
        if (p.positions[v].y > 1.9999f)
            assert_true(along(f.tensors[v], (place3){1, 0, 0}) > 0.04);
    direction_field_release(&f);
    primitive_release(&p);
    p = grid_surface(bowl_at, 48, 40, true, false, 0);
    f = make_field(&p);
    check_tensors(&p, &f, false);
    direction_field_release(&f);
    primitive_release(&p);
}

/* A larger plane beside the hook's that faces the same way: the hook keeps to its own cylinder, and does not follow. */
static void bent_walls_follow_no_other(void **state)
{
    (void)state;
    primitive      hook = grid_surface(hook_at, 80, 1, false, false, 0);
    primitive      p = empty_primitive(hook.vertex_count + 4, hook.index_count + 6);
    const uint32_t n = hook.vertex_count, two[6] = {n, n + 1, n + 2, n, n + 2, n + 3};
    const vec3     corners[4] = {{20, 4, 0}, {25, 4, 0}, {25, 4, 40}, {20, 4, 40}};
    memcpy(p.positions, hook.positions, n * sizeof *p.positions);
    memcpy(p.positions + n, corners, sizeof corners);
    memcpy(p.indices, hook.indices, hook.index_count * sizeof *p.indices);
    memcpy(p.indices + hook.index_count, two, sizeof two);
    direction_field f = make_field(&p);
    assert_true(along(direction_field_at(&f, &p, hook.index_count), (place3){0, 0, 1}) > 0.04);
    size_t count = 0;
    for (uint32_t c = 0; c < hook.index_count; c++)
        if (p.positions[p.indices[c]].x < -0.2f) {
            assert_true(along(direction_field_at(&f, &p, c), (place3){1, 0, 0}) > 0.04);
            count++;
        }
    assert_true(count > 100);
    direction_field_release(&f);
    primitive_release(&p);
    primitive_release(&hook);
}

/* A wall between two rounded edges, in two triangles that share their vertices with the roundings; beside it, in the
 * same plane, a strip of its own that stands upright. What bends at the rims must not be drawn into the wall, and the
 * strip goes along with the wall. */
static void planes_have_one_direction_whatever_bends_beside_them(void **state)
{
    (void)state;
    enum { STEPS = 4, RINGS = STEPS + 1, ROWS = 2 * RINGS };
    primitive p = empty_primitive(3 * ROWS + 4, 12 * (ROWS - 1) + 6);
    for (uint32_t r = 0; r < ROWS; r++) {
        /* A quarter of a round, the wall from y = 0 to 4, and a quarter again; the wall is askew at one end. */
        bool   after = r >= RINGS;
        double a = (after ? r - RINGS : STEPS - r) * field_pi / 2 / STEPS, y = 0.3 * sin(a), z = 0.3 * cos(a) - 0.3;
        for (uint32_t k = 0; k < 3; k++)
            p.positions[3 * r + k] =
                (vec3){(float)(k == 2 ? 9 + (after ? 2 : 0) : 3.0 * k), (float)(after ? 4 + y : -y), (float)z};
    }
    uint32_t *to = p.indices;
    for (uint32_t r = 0; r + 1 < ROWS; r++)
        for (uint32_t k = 0; k < 2; k++) {
            uint32_t       a = 3 * r + k;
            const uint32_t two[6] = {a, a + 1, a + 4, a, a + 4, a + 3};
            memcpy(to, two, sizeof two);
            to += 6;
        }
    static const vec3 strip[4] = {{12, 0, 0}, {12.5f, 0, 0}, {12.5f, 4, 0}, {12, 4, 0}};
    const uint32_t    first = 3 * ROWS, two[6] = {first, first + 1, first + 2, first, first + 2, first + 3};
    memcpy(&p.positions[first], strip, sizeof strip);
    memcpy(to, two, sizeof two);
    turn_primitive(&p);
    direction_field f = make_field(&p);
    check_tensors(&p, &f, false);
    uint32_t     wall = 12 * (RINGS - 1), count = 0;
    const float *one = direction_field_at(&f, &p, wall);
    assert_true(fabs(fabs(along(one, turned((place3){0, 1, 0}))) - 0.05) < 1e-3);
    for (uint32_t c = wall; c < p.index_count; c++)
        if (c < wall + 12 || c >= p.index_count - 6) {
            assert_memory_equal(direction_field_at(&f, &p, c), one, sizeof *f.tensors);
            count++;
        }
    assert_int_equal(count, 18);
    /* The roundings keep what they know: they bend across. */
    for (uint32_t c = 12; c < wall - 12; c++)
        assert_true(along(direction_field_at(&f, &p, c), turned((place3){1, 0, 0})) < -0.5);
    direction_field_release(&f);
    primitive_release(&p);
}

/* A wide wall, and a tall one that turns a little from it: they are drawn one way. One that turns by more has its own.
 */
static void walls_that_turn_a_little_are_drawn_one_way(void **state)
{
    (void)state;
    for (int more = 0; more < 2; more++) {
        double         angle = (more ? 40 : 15) * field_pi / 180, x = cos(angle), z = -sin(angle);
        const uint32_t corners[12] = {0, 1, 2, 0, 2, 3, 4, 5, 6, 4, 6, 7};
        const vec3     positions[8] = {{0, 0, 0},
                                       {6, 0, 0},
                                       {6, 2, 0},
                                       {0, 2, 0},
                                       {8, 0, 0},
                                       {(float)(8 + 0.5 * x), 0, (float)(0.5 * z)},
                                       {(float)(8 + 0.5 * x), 3, (float)(0.5 * z)},
                                       {8, 3, 0}};
        primitive      p = empty_primitive(8, 12);
        memcpy(p.positions, positions, sizeof positions);
        memcpy(p.indices, corners, sizeof corners);
        direction_field f = make_field(&p);
        assert_true(fabs(along(direction_field_at(&f, &p, 0), (place3){1, 0, 0}) - 0.05) < 1e-3);
        place3 wanted = more ? (place3){0, 1, 0} : (place3){x, 0, z};
        assert_true(fabs(along(direction_field_at(&f, &p, 6), wanted) - 0.05) < 1e-3);
        direction_field_release(&f);
        primitive_release(&p);
    }
}

/* --- crosses -------------------------------------------------------------------------------------------- */

typedef struct corner_frame {
    place3 u, v;
} corner_frame;

static corner_frame frame_of_triangle(const primitive *p, uint32_t t)
{
    const uint32_t *k = p->indices + 3 * t;
    vec3            a = p->positions[k[0]], b = p->positions[k[1]], c = p->positions[k[2]];
    place3          x = {(double)b.x - a.x, (double)b.y - a.y, (double)b.z - a.z},
           y = {(double)c.x - a.x, (double)c.y - a.y, (double)c.z - a.z};
    place3 n = {x.y * y.z - x.z * y.y, x.z * y.x - x.x * y.z, x.x * y.y - x.y * y.x};
    unit(&x);
    unit(&n);
    return (corner_frame){x, {n.y * x.z - n.z * x.y, n.z * x.x - n.x * x.z, n.x * x.y - n.y * x.x}};
}

/* The angle of the line that a corner has in its triangle. */
static double angle_in(const primitive *p, const direction_field *f, uint32_t corner)
{
    const float *t = direction_field_at(f, p, corner);
    corner_frame q = frame_of_triangle(p, corner / 3);
    place3       one = {q.u.x + q.v.x, q.u.y + q.v.y, q.u.z + q.v.z};
    double       uu = along(t, q.u), vv = along(t, q.v), both = along(t, one);
    return atan2(both - uu - vv, uu - vv) / 2;
}

/* Quarter turns that the cross makes around each triangle: those to the left and to the right. */
static void count_singularities(const primitive *p, const direction_field *f, const bool *left_out, int counts[2])
{
    counts[0] = counts[1] = 0;
    for (uint32_t t = 0; t < p->index_count / 3; t++) {
        double turn = 0, angles[3];
        for (uint32_t k = 0; k < 3; k++)
            angles[k] = angle_in(p, f, 3 * t + k);
        for (int k = 0; k < 3; k++)
            turn += remainder(angles[(k + 1) % 3] - angles[k], field_pi / 2);
        int quarters = (int)rint(turn / (field_pi / 2));
        if (!left_out || !left_out[t])
            counts[quarters < 0] += abs(quarters);
    }
}

/* As many as the surface must have, and no pair beside them: their sum is four times the Euler characteristic. */
static void crosses_turn_no_more_than_they_must(void **state)
{
    (void)state;
    const place3 round = {2, 2, 2};
    struct {
        const char *name;
        primitive   p;
        int         least;
    } shapes[] = {{"sphere", ball(24, 0, round), 8},
                  {"sphere, jittered", ball(40, 0.5, round), 8},
                  {"torus", grid_surface(torus_at, 64, 24, true, true, 0), 0},
                  {"torus, jittered", grid_surface(torus_at, 64, 24, true, true, 0.6), 0}};
    for (size_t i = 0; i < sizeof shapes / sizeof *shapes; i++) {
        direction_field f = make_field(&shapes[i].p);
        int             counts[2];
        count_singularities(&shapes[i].p, &f, NULL, counts);
        printf("%s: %d quarter turns to the left, %d to the right\n", shapes[i].name, counts[0], counts[1]);
        assert_int_equal(counts[0] - counts[1], shapes[i].least);
        assert_int_equal(counts[0] + counts[1], shapes[i].least);
        direction_field_release(&f);
        primitive_release(&shapes[i].p);
    }
}

/* Scans: each vertex moved in or out by up to this fraction of the model. */
static void noise_is_looked_through(void **state)
{
    (void)state;
    static const struct {
        double noise, median, most;
    } rows[] = {{0.005, 2, 6}, {0.01, 3, 10}, {0.02, 8, 25}};
    const place3 axes = {3, 2, 1};
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        primitive p = ball(60, 0, axes);
        double    median, most;
        for (uint32_t v = 0; v < p.vertex_count; v++) {
            float by = (float)(1 + rows[i].noise * (hashed(7 * v + 1) - 0.5));
            p.positions[v] = (vec3){by * p.positions[v].x, by * p.positions[v].y, by * p.positions[v].z};
        }
        direction_field f = make_field(&p);
        measure_field(&p, &f, ellipsoid_truth, false, false, &median, &most);
        printf("ellipsoid, noise %g: median %.2f, 95 %% %.2f degrees\n", rows[i].noise, median, most);
        assert_true(median <= rows[i].median && most <= rows[i].most);
        direction_field_release(&f);
        primitive_release(&p);
    }
}

/* Facets that were rounded, and dents: ripples eight edges long, as steep as the form itself bends. Over wide discs the
 * form is seen through them; and what has none stays as it is, to the last bit. */
static void ripples_are_looked_through(void **state)
{
    (void)state;
    const place3    axes = {3, 2, 1};
    primitive       p = ball(60, 0, axes);
    double          median[2], most[2];
    direction_field even[2];
    for (int i = 0; i < 2; i++)
        assert_int_equal(direction_field_make(&even[i], &p, 0.8, 0, i ? 1 : 0, NULL), LMN_OK);
    assert_memory_equal(even[0].tensors, even[1].tensors, even[0].tensor_count * sizeof *even[0].tensors);
    for (uint32_t v = 0; v < p.vertex_count; v++) {
        vec3  at = p.positions[v];
        float by = 1 + 0.015f * sinf(8 * at.x + 1) * sinf(8 * at.y + 2) * sinf(8 * at.z + 3);
        p.positions[v] = (vec3){by * at.x, by * at.y, by * at.z};
    }
    for (int i = 0; i < 2; i++) {
        direction_field f;
        assert_int_equal(direction_field_make(&f, &p, 0.8, 0, i ? 1 : 0, NULL), LMN_OK);
        measure_field(&p, &f, ellipsoid_truth, false, false, &median[i], &most[i]);
        direction_field_release(&f);
        direction_field_release(&even[i]);
    }
    printf("ellipsoid with ripples: median %.2f, 95 %% %.2f degrees; calm %.2f, %.2f\n", median[0], most[0], median[1],
           most[1]);
    assert_true(median[1] < 0.5 * median[0] && most[1] < 0.7 * most[0]);
    primitive_release(&p);
}

/* A bar of an L's section whose inner corner is rounded off, as machined parts are: columns around, then both ends. */
static primitive machined_bar(void)
{
    enum { ARC = 8, AROUND = 6 + ARC, ALONG = 12 };
    double outline[AROUND][2] = {{0, 0}, {4, 0}, {4, 1}};
    for (int i = 0; i <= ARC; i++) {
        double a = field_pi / 2 * i / ARC;
        outline[3 + i][0] = 2 - sin(a);
        outline[3 + i][1] = 2 - cos(a);
    }
    outline[4 + ARC][0] = 1;
    outline[4 + ARC][1] = 3;
    outline[5 + ARC][0] = 0;
    outline[5 + ARC][1] = 3;
    primitive p = empty_primitive(AROUND * (ALONG + 1), AROUND * ALONG * 6 + 2 * (AROUND - 2) * 3);
    uint32_t  n = 0;
    for (uint32_t j = 0; j <= ALONG; j++)
        for (uint32_t i = 0; i < AROUND; i++)
            p.positions[j * AROUND + i] = (vec3){(float)outline[i][0], (float)outline[i][1], 0.5f * (float)j};
    for (uint32_t j = 0; j < ALONG; j++)
        for (uint32_t i = 0; i < AROUND; i++) {
            uint32_t       a = j * AROUND + i, b = j * AROUND + (i + 1) % AROUND;
            const uint32_t q[6] = {a, b, b + AROUND, a, b + AROUND, a + AROUND};
            for (int k = 0; k < 6; k++)
                p.indices[n++] = q[k];
        }
    for (uint32_t end = 0; end < 2; end++)
        for (uint32_t i = 1; i + 1 < AROUND; i++) {
            uint32_t first = end * ALONG * AROUND;
            p.indices[n++] = first;
            p.indices[n++] = first + (end ? i : i + 1);
            p.indices[n++] = first + (end ? i + 1 : i);
        }
    return p;
}

/* A turned part: a ball between two rims, which by itself bends no way more than another, and its ends. */
static primitive turned_part(void)
{
    enum { AROUND = 128, ALONG = 24 };
    primitive p = empty_primitive(AROUND * (ALONG + 1), AROUND * ALONG * 6 + 2 * (AROUND - 2) * 3);
    uint32_t  n = 0;
    for (uint32_t j = 0; j <= ALONG; j++)
        for (uint32_t i = 0; i < AROUND; i++) {
            double a = 2 * field_pi * i / AROUND, b = 0.6 * j / ALONG, r = 2 * cos(b);
            p.positions[j * AROUND + i] = (vec3){(float)(r * cos(a)), (float)(r * sin(a)), (float)(2 * sin(b))};
        }
    for (uint32_t j = 0; j < ALONG; j++)
        for (uint32_t i = 0; i < AROUND; i++) {
            uint32_t       a = j * AROUND + i, b = j * AROUND + (i + 1) % AROUND;
            const uint32_t q[6] = {a, b, b + AROUND, a, b + AROUND, a + AROUND};
            for (int k = 0; k < 6; k++)
                p.indices[n++] = q[k];
        }
    for (uint32_t end = 0; end < 2; end++)
        for (uint32_t i = 1; i + 1 < AROUND; i++) {
            uint32_t first = end * ALONG * AROUND;
            p.indices[n++] = first;
            p.indices[n++] = first + (end ? i : i + 1);
            p.indices[n++] = first + (end ? i + 1 : i);
        }
    return p;
}

/* Angles between crosses and the creases at which they stand, of triangles before `end`; and whether any turns. */
static void check_creases(const char *name, primitive p, uint32_t end)
{
    for (int rotated = 0; rotated < 2; rotated++) {
        if (rotated)
            turn_primitive(&p);
        direction_field f = make_field(&p);
        uint32_t       *across = mesh_adjacency(&p);
        double         *angles = mem_alloc(2 * (size_t)p.index_count * sizeof *angles);
        size_t          count = 0;
        int             counts[2];
        for (uint32_t h = 0; h < end; h++) {
            place3 m, o;
            if (across[h] == UINT32_MAX)
                continue;
            corner_frame a = frame_of_triangle(&p, h / 3), b = frame_of_triangle(&p, across[h] / 3);
            m = (place3){a.u.y * a.v.z - a.u.z * a.v.y, a.u.z * a.v.x - a.u.x * a.v.z, a.u.x * a.v.y - a.u.y * a.v.x};
            o = (place3){b.u.y * b.v.z - b.u.z * b.v.y, b.u.z * b.v.x - b.u.x * b.v.z, b.u.x * b.v.y - b.u.y * b.v.x};
            if (m.x * o.x + m.y * o.y + m.z * o.z > cos(0.8))
                continue;
            uint32_t next = h % 3 == 2 ? h - 2 : h + 1;
            vec3     from = p.positions[p.indices[h]], to = p.positions[p.indices[next]];
            place3   e = {(double)to.x - from.x, (double)to.y - from.y, (double)to.z - from.z};
            double   crease = atan2(e.x * a.v.x + e.y * a.v.y + e.z * a.v.z, e.x * a.u.x + e.y * a.u.y + e.z * a.u.z);
            angles[count++] = fabs(remainder(angle_in(&p, &f, h) - crease, field_pi / 2)) * 180 / field_pi;
            angles[count++] = fabs(remainder(angle_in(&p, &f, next) - crease, field_pi / 2)) * 180 / field_pi;
        }
        qsort(angles, count, sizeof *angles, by_size);
        count_singularities(&p, &f, NULL, counts);
        printf("%s: %zu at creases, median %.2f, 95 %% %.2f degrees; %d quarter turns\n", name, count,
               angles[count / 2], angles[count * 95 / 100], counts[0] + counts[1]);
        assert_true(count > 40 && angles[count / 2] <= 1 && angles[count * 95 / 100] <= 2);
        assert_int_equal(counts[0] + counts[1], 0);
        mem_free(angles);
        mem_free(across);
        direction_field_release(&f);
    }
    primitive_release(&p);
}

/* Creases part the surface, so that each side has its own crosses, and these stand along them: no turn is left that
 * corners do not take. */
static void crosses_stand_along_creases(void **state)
{
    (void)state;
    primitive bar = machined_bar(), part = turned_part();
    check_creases("machined bar", bar, 14 * 12 * 6);
    /* Flat ends have one direction, whatever their rims do. */
    check_creases("turned part", part, 128 * 24 * 6);
}

static primitive with_triangles(const uint32_t *triangles, uint32_t count)
{
    static const vec3 positions[7] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0.5f, 0.2f, 1},
                                      {2, 0, 0}, {3, 0, 0}, {0, 0, 0}};
    primitive         p = empty_primitive(7, count);
    memcpy(p.positions, positions, sizeof positions);
    memcpy(p.indices, triangles, count * sizeof *triangles);
    return p;
}

/* A coarse ball: its triangles meet at 42 degrees, a cube's faces at 90. */
static primitive icosahedron(vec3 normals[12])
{
    static const uint32_t faces[60] = {0, 11, 5,  0, 5,  1, 0, 1, 7, 0, 7,  10, 0, 10, 11, 1, 5, 9, 5, 11,
                                       4, 11, 10, 2, 10, 7, 6, 7, 1, 8, 3,  9,  4, 3,  4,  2, 3, 2, 6, 3,
                                       6, 8,  3,  8, 9,  4, 9, 5, 2, 4, 11, 6,  2, 10, 8,  6, 7, 9, 8, 1};
    const float           g = 1.618034f;
    const vec3            at[12] = {{-1, g, 0},  {1, g, 0},  {-1, -g, 0}, {1, -g, 0}, {0, -1, g},  {0, 1, g},
                                    {0, -1, -g}, {0, 1, -g}, {g, 0, -1},  {g, 0, 1},  {-g, 0, -1}, {-g, 0, 1}};
    primitive             p = empty_primitive(12, 60);
    for (int i = 0; i < 12; i++) {
        float length = sqrtf(at[i].x * at[i].x + at[i].y * at[i].y + at[i].z * at[i].z);
        p.positions[i] = at[i];
        normals[i] = (vec3){at[i].x / length, at[i].y / length, at[i].z / length};
    }
    memcpy(p.indices, faces, sizeof faces);
    return p;
}

/* Edges that are shaded round are none; unless they are sharp. */
static void shading_says_what_is_an_edge(void **state)
{
    (void)state;
    const vec3 any = {0.57735f, 0.57735f, 0.57735f};
    vec3       normals[12], same[8] = {any, any, any, any, any, any, any, any};
    for (int shaded = 0; shaded < 2; shaded++) {
        primitive       coarse = icosahedron(normals), cube = shared_cube();
        direction_field field;
        coarse.normals = shaded ? normals : NULL;
        assert_int_equal(direction_field_make(&field, &coarse, 0.7, 0, 0, NULL), LMN_OK);
        assert_true((field.corners == NULL) == shaded); /* not parted */
        direction_field_release(&field);
        cube.normals = shaded ? same : NULL;
        assert_int_equal(direction_field_make(&field, &cube, 0.7, 0, 0, NULL), LMN_OK);
        assert_true(field.corners != NULL);
        direction_field_release(&field);
        coarse.normals = cube.normals = NULL;
        primitive_release(&coarse);
        primitive_release(&cube);
    }
}

enum { ARMS_SIDE = 12 };

/* A square of nodes that all agree, but for those in a square in it, which lie across. */
static size_t arms_across(float wish)
{
    enum { COUNT = ARMS_SIDE * ARMS_SIDE };
    uint32_t        starts[COUNT + 1] = {0}, links = 0;
    connection_link all[4 * COUNT];
    float           hold[COUNT];
    complex_number  arms[COUNT], source[COUNT];
    size_t          across = 0;
    for (uint32_t i = 0; i < COUNT; i++) {
        int  x = (int)(i % ARMS_SIDE), y = (int)(i / ARMS_SIDE);
        bool island = x >= 3 && x < 6 && y >= 4 && y < 7;
        arms[i] = (complex_number){island ? -0.8f : 0.9f, 0};
        source[i] = (complex_number){island ? -wish : 0.1f, 0};
        hold[i] = 1;
        const int beside[4][2] = {{x - 1, y}, {x + 1, y}, {x, y - 1}, {x, y + 1}};
        for (int k = 0; k < 4; k++)
            if (beside[k][0] >= 0 && beside[k][0] < ARMS_SIDE && beside[k][1] >= 0 && beside[k][1] < ARMS_SIDE)
                all[links++] = (connection_link){(uint32_t)(beside[k][1] * ARMS_SIDE + beside[k][0]), {1, 0}};
        starts[i + 1] = links;
    }
    connection g = {.count = COUNT, .starts = starts, .links = all, .links_hold = hold, .hold = hold, .source = source};
    assert_true(field_join_arms(&g, arms));
    for (uint32_t i = 0; i < COUNT; i++)
        across += arms[i].re < 0;
    return across;
}

/* Nine nodes have twelve links to those around. */
static void islands_of_arms_join_what_surrounds_them(void **state)
{
    (void)state;
    assert_int_equal(arms_across(0), 0);
    assert_int_equal(arms_across(1.3f), 0);
    assert_int_equal(arms_across(1.4f), 9);
}

static void barely_meshes_are_finite(void **state)
{
    (void)state;
    const uint32_t one[3] = {0, 1, 2}, flat[3] = {0, 1, 4}, same[3] = {0, 0, 0}, position[3] = {0, 6, 1},
                   copies[9] = {0, 1, 2, 0, 1, 2, 2, 1, 0};
    const uint32_t book[9] = {0, 1, 2, 0, 1, 3, 1, 0, 5}, mixed[12] = {0, 1, 2, 1, 4, 5, 0, 4, 2, 0, 3, 2};
    check_anything(with_triangles(one, 3));
    check_anything(with_triangles(flat, 3));
    check_anything(with_triangles(same, 3));
    check_anything(with_triangles(position, 3));
    check_anything(with_triangles(copies, 9));
    check_anything(with_triangles(book, 9));
    check_anything(with_triangles(mixed, 12));
    check_anything(with_triangles(one, 0));
    check_anything(empty_primitive(3, 3));
    check_anything(empty_primitive(0, 0));
    primitive p = with_triangles(mixed, 12);
    p.positions[3] = (vec3){NAN, INFINITY, 0};
    check_anything(p);
    p = with_triangles(mixed, 12);
    p.positions[3] = (vec3){3e38f, -3e38f, 3e38f};
    check_anything(p);
    p = with_triangles(mixed, 12);
    scale_primitive(&p, 1e-42, 0);
    check_anything(p);
    /* Everything at once: random triangles between few positions, and a torus whose faces are turned at will. */
    p = empty_primitive(20, 900);
    for (uint32_t v = 0; v < 20; v++)
        p.positions[v] =
            (vec3){(float)rint(3 * hashed(v)), (float)rint(3 * hashed(v + 100)), (float)rint(2 * hashed(v + 200))};
    for (uint32_t i = 0; i < 900; i++)
        p.indices[i] = (uint32_t)(hashed(i + 1000) * 19.99);
    check_anything(p);
}

/* Windings that disagree and copies of triangles change nothing. */
static void windings_and_copies_do_not_matter(void **state)
{
    (void)state;
    primitive p = grid_surface(torus_at, 48, 20, true, true, 0.4),
              q = empty_primitive(p.vertex_count, 2 * p.index_count);
    memcpy(q.positions, p.positions, p.vertex_count * sizeof *p.positions);
    for (uint32_t t = 0; t < p.index_count / 3; t++)
        for (uint32_t k = 0; k < 3; k++) {
            q.indices[6 * t + k] = p.indices[3 * t + (hashed(t) < 0.5 ? k : 2 - k)];
            q.indices[6 * t + 3 + k] = p.indices[3 * t + (hashed(t + 9999) < 0.5 ? k : 2 - k)];
        }
    direction_field a = make_field(&p), b = make_field(&q);
    double          worst = 0;
    for (uint32_t v = 0; v < p.vertex_count; v++)
        for (int k = 0; k < 6; k++)
            worst = fmax(worst, fabs((double)a.tensors[v][k] - b.tensors[v][k]));
    printf("turned and doubled: off by %.2g\n", worst);
    assert_true(worst < 1e-4);
    direction_field_release(&a);
    direction_field_release(&b);
    primitive_release(&p);
    primitive_release(&q);
}

static void compare_moved(primitive p, const char *name, double tolerance)
{
    static const struct {
        double scale, shift;
    } moves[] = {{1e-6, 0}, {1e6, 0}, {1, 0.1}, {1, 2}, {1e6, 3e5}};
    direction_field a = make_field(&p);
    for (size_t i = 0; i < sizeof moves / sizeof *moves; i++) {
        primitive q = empty_primitive(p.vertex_count, p.index_count);
        memcpy(q.positions, p.positions, p.vertex_count * sizeof *p.positions);
        memcpy(q.indices, p.indices, p.index_count * sizeof *p.indices);
        scale_primitive(&q, moves[i].scale, moves[i].shift);
        direction_field b = make_field(&q);
        double          worst = 0;
        for (uint32_t v = 0; v < p.vertex_count; v++)
            for (int k = 0; k < 6; k++)
                worst = fmax(worst, fabs((double)a.tensors[v][k] - b.tensors[v][k]));
        printf("%s times %g plus %g: off by %.2g\n", name, moves[i].scale, moves[i].shift, worst);
        assert_true(worst < tolerance);
        direction_field_release(&b);
        primitive_release(&q);
    }
    direction_field_release(&a);
    primitive_release(&p);
}

static void size_and_position_do_not_matter(void **state)
{
    (void)state;
    const place3 axes = {3, 2, 1};
    compare_moved(grid_surface(torus_at, 48, 20, true, true, 0.4), "torus", 1e-3);
    compare_moved(ball(16, 0.4, axes), "ellipsoid", 2e-2);
    compare_moved(shared_cube(), "cube", 1e-4);
}

static void the_same_twice(void **state)
{
    (void)state;
    primitive       p = grid_surface(torus_at, 200, 100, true, true, 0.4);
    direction_field a = make_field(&p), b = make_field(&p);
    assert_memory_equal(a.tensors, b.tensors, a.tensor_count * sizeof *a.tensors);
    direction_field_release(&a);
    direction_field_release(&b);
    primitive_release(&p);
}

static void memory_may_run_out(void **state)
{
    (void)state;
    primitive p = shared_cube();
    long      n = 1;
    for (; n < 1000; n++) {
        lmn_error       error = {0};
        direction_field f;
        mem_fail_at(n);
        lmn_status status = direction_field_make(&f, &p, 0.8, 0, 0, &error);
        mem_fail_at(0);
        if (status == LMN_OK) {
            direction_field_release(&f);
            break;
        }
        assert_int_equal(status, LMN_MEMORY);
        assert_int_equal(error.status, LMN_MEMORY);
        assert_null(f.tensors);
    }
    assert_true(n > 20 && n < 1000);
    primitive_release(&p);
}

static void a_million_triangles_do_not_take_long(void **state)
{
    (void)state;
    primitive       p = grid_surface(torus_at, 1000, 500, true, true, 0.5);
    double          before = seconds_now(), median, most;
    direction_field f = make_field(&p);
    double          taken = seconds_now() - before;
    measure_field(&p, &f, torus_truth, false, false, &median, &most);
    printf("torus of %u triangles: %.2f s; median %.2f, 95 %% %.2f degrees\n", p.index_count / 3, taken, median, most);
    assert_true(median <= 5 && most <= 15);
    direction_field_release(&f);
    primitive_release(&p);
}

static void models_have_fields(void **state)
{
    (void)state;
    static const char *const names[] = {
        "mesh/suzanne.obj",     "mesh/spot.obj", "mesh/teapot.obj", "mesh/cube.ply", "mesh/scifihelmet-binary.ply",
        "mesh/gearbox-100k.stl"};
    for (size_t i = 0; i < sizeof names / sizeof *names; i++) {
        primitive p;
        if (!model_primitive(names[i], &p))
            skip();
        double          before = seconds_now(), sure = 0;
        direction_field f = make_field(&p);
        double          taken = seconds_now() - before;
        check_tensors(&p, &f, false);
        for (uint32_t k = 0; k < f.tensor_count; k++)
            sure += sureness_of(f.tensors[k]) >= 0.1;
        printf("%-30s %6u triangles: %.3f s, sure at %.0f %%\n", names[i], p.index_count / 3, taken,
               100 * sure / f.tensor_count);
        direction_field_release(&f);
        primitive_release(&p);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(directions_agree_with_known_surfaces),
        cmocka_unit_test(the_greater_curvature_is_meant),
        cmocka_unit_test(a_ball_is_not_sure_of_anything),
        cmocka_unit_test(a_plane_is_drawn_along_its_longer_side),
        cmocka_unit_test(a_facade_is_drawn_along_its_border),
        cmocka_unit_test(faces_of_a_cube_have_one_direction_each),
        cmocka_unit_test(flat_positions_take_after_what_bends_beside_them),
        cmocka_unit_test(bent_walls_follow_no_other),
        cmocka_unit_test(planes_have_one_direction_whatever_bends_beside_them),
        cmocka_unit_test(walls_that_turn_a_little_are_drawn_one_way),
        cmocka_unit_test(crosses_turn_no_more_than_they_must),
        cmocka_unit_test(noise_is_looked_through),
        cmocka_unit_test(ripples_are_looked_through),
        cmocka_unit_test(crosses_stand_along_creases),
        cmocka_unit_test(shading_says_what_is_an_edge),
        cmocka_unit_test(islands_of_arms_join_what_surrounds_them),
        cmocka_unit_test(barely_meshes_are_finite),
        cmocka_unit_test(windings_and_copies_do_not_matter),
        cmocka_unit_test(size_and_position_do_not_matter),
        cmocka_unit_test(the_same_twice),
        cmocka_unit_test(memory_may_run_out),
        cmocka_unit_test(a_million_triangles_do_not_take_long),
        cmocka_unit_test(models_have_fields),
    };
    return cmocka_run_group_tests(tests, NULL, remove_temp_folder);
}
