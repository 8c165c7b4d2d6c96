/* Fields of directions against surfaces whose curvature is known, and on meshes that are barely meshes. */
#include "field_shapes.h"

#include "scene/direction_field.h"

static direction_field make_field(const primitive *p)
{
    direction_field f;
    assert_int_equal(direction_field_make(&f, p, 0.8, 0, NULL), LMN_OK);
    return f;
}

/* The direction's unit vector and how sure it is, from a tensor: its axis is the row of T + s·(I − n nᵀ) that is longest, (T + s P) = 2 s d dᵀ. */
static place3 axis_of(const float *t, place3 n, double *sure)
{
    double sum = 0, best = 0;
    for (int k = 0; k < 6; k++)
        sum += (k < 3 ? 1 : 2) * (double)t[k] * t[k];
    double s = *sure = sqrt(sum / 2);
    const double m[3][3] = {{t[0] + s * (1 - n.x * n.x), t[3] - s * n.x * n.y, t[5] - s * n.z * n.x},
                            {t[3] - s * n.x * n.y, t[1] + s * (1 - n.y * n.y), t[4] - s * n.y * n.z},
                            {t[5] - s * n.z * n.x, t[4] - s * n.y * n.z, t[2] + s * (1 - n.z * n.z)}};
    place3 out = {1, 0, 0};
    for (int k = 0; k < 3; k++) {
        double l = sqrt(m[k][0] * m[k][0] + m[k][1] * m[k][1] + m[k][2] * m[k][2]);
        if (l > best) {
            best = l;
            out = (place3){m[k][0] / l, m[k][1] / l, m[k][2] / l};
        }
    }
    return out;
}

/* What is right at a place: normal and direction of the greatest absolute curvature; false where that is no direction. */
typedef bool (*truth_fn)(place3 at, place3 *normal, place3 *direction);

static int by_size(const void *a, const void *b)
{
    double x = *(const double *)a, y = *(const double *)b;
    return x < y ? -1 : x > y;
}

/* Median and 95th percentile of the angles between the field and the truth, degrees. */
static void measure_field(const primitive *p, const direction_field *f, truth_fn truth, bool rotated, double *median, double *most)
{
    double *angles = mem_alloc(p->vertex_count * sizeof *angles);
    size_t count = 0;
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
        double cosine = fabs(own.x * d.x + own.y * d.y + own.z * d.z);
        angles[count++] = acos(cosine > 1 ? 1 : cosine) * 180 / field_pi;
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
    double uu = h[0] * u.x * u.x + h[1] * u.y * u.y + h[2] * u.z * u.z, vv = h[0] * v.x * v.x + h[1] * v.y * v.y + h[2] * v.z * v.z;
    double uv = h[0] * u.x * v.x + h[1] * u.y * v.y + h[2] * u.z * v.z;
    double mean = (uu + vv) / 2, half = hypot((uu - vv) / 2, uv), angle = atan2(uv, (uu - vv) / 2) / 2;
    if (mean < 0)
        angle += field_pi / 2;
    *d = (place3){u.x * cos(angle) + v.x * sin(angle), u.y * cos(angle) + v.y * sin(angle), u.z * cos(angle) + v.z * sin(angle)};
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

static void check_accuracy(const char *name, primitive p, truth_fn truth)
{
    for (int rotated = 0; rotated < 2; rotated++) {
        double median, most;
        if (rotated)
            turn_primitive(&p);
        direction_field f = make_field(&p);
        measure_field(&p, &f, truth, rotated, &median, &most);
        printf("%-28s %s %6u triangles: median %.2f, 95 %% %.2f degrees\n", name, rotated ? "turned" : "      ", p.index_count / 3, median, most);
        direction_field_release(&f);
        assert_true(median <= 5 && most <= 15);
    }
    primitive_release(&p);
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
    check_accuracy("saddle", grid_surface(saddle_at, 24, 24, false, false, 0), saddle_truth);
    check_accuracy("saddle, jittered", grid_surface(saddle_at, 24, 24, false, false, 0.7), saddle_truth);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(directions_agree_with_known_surfaces),
    };
    return cmocka_run_group_tests(tests, NULL, remove_temp_folder);
}
