/* Where cylinders and cones meet something, against what is known of these shapes: to 1e-4, as spheres are. */
#include <math.h>
#include <string.h>

#include "base/vector3.h"
#include "contact/contact.h"
#include "contact/sphere.h"
#include "import_support.h"

static const double PI = 3.141592653589793;

/* One thing, `what`, that is at a place at 1 s, and has come there as fast as `before` and goes off as `after` says;
 * another one, `met`, that rests. */
typedef struct fall {
    const char *what, *met;
    double      place[3], before[3], after[3];
} fall;

static void expect_touch(const char *name, const fall *f, const double place[3], const double normal[3])
{
    static char   text[4096];
    const double *p = f->place, *b = f->before, *a = f->after;
    schedule      laid;
    moment        clips;
    contact      *found = NULL;
    size_t        count = 0;
    lmn_error     error = {0};
    snprintf(text, sizeof text,
             "{\"limner_script\": 1, \"nodes\": [{\"name\": \"met\", %s}, {\"name\": \"what\", %s}], \"behaviour\": "
             "{\"target\": \"what\", \"linear\": [[%.17g, %.17g, %.17g], [%.17g, %.17g, %.17g], [%.17g, %.17g, "
             "%.17g]], \"duration\": 2}}",
             f->met, f->what, p[0] - b[0], p[1] - b[1], p[2] - b[2], p[0], p[1], p[2], p[0] + a[0], p[1] + a[1],
             p[2] + a[2]);
    lmn_scene *s = load_or_fail(temp_file("round.json", text, strlen(text)));
    assert_int_equal(schedule_of_moment(&laid, &clips, s, NULL, NULL), LMN_OK);
    if (contacts_find(&found, &count, &laid, &clips, (int32_t)s->node_count - 1, 0, 2, 0.1, &error) != LMN_OK)
        fail_msg("%s: %s", name, error.message);
    if (count != 1 || found[0].other == NONE)
        fail_msg("%s: %zu contacts, or nothing is met", name, count);
    assert_true(fabs(found[0].hit.seconds - 1) < 1e-4);
    if (vector3_distance(found[0].hit.place, place) > 1e-4 || vector3_distance(found[0].hit.normal, normal) > 2e-3 ||
        found[0].distance > 1e-4)
        fail_msg("%s: it touches at %.6f %.6f %.6f instead of %.6f %.6f %.6f, normal %.4f %.4f %.4f instead of %.4f "
                 "%.4f %.4f, %.2g apart",
                 name, found[0].hit.place[0], found[0].hit.place[1], found[0].hit.place[2], place[0], place[1],
                 place[2], found[0].hit.normal[0], found[0].hit.normal[1], found[0].hit.normal[2], normal[0], normal[1],
                 normal[2], found[0].distance);
    mem_free(found);
    schedule_release(&laid);
    lmn_scene_destroy(&s);
}

enum { SHAPE_TEXT = 300 };
static const double UP[] = {0, 1, 0};
#define FLOOR    "\"plane\": {\"size\": [20, 20]}"
#define CYLINDER "\"cylinder\": {\"radius\": 0.5, \"height\": 2}"
#define CONE     "\"cone\": {\"radius\": 0.5, \"height\": 1}"

/* `shape` turned around an axis. */
static const char *turned_by(char *out, const char *shape, const double axis[3], double degrees)
{
    snprintf(out, SHAPE_TEXT, "%s, \"rotation\": {\"axis\": [%.17g, %.17g, %.17g], \"angle\": %.17g}", shape, axis[0],
             axis[1], axis[2], degrees);
    return out;
}

/* Two turns: of a cylinder to lie along an angle in the ground, degrees. */
static const char *lying(char *out, const char *shape, double degrees)
{
    const double half = degrees * PI / 360, c = sqrt(0.5);
    /* First 90 degrees about z, then these about y. */
    snprintf(out, SHAPE_TEXT, "%s, \"rotation\": [%.17g, %.17g, %.17g, %.17g]", shape, sin(half) * c, sin(half) * c,
             cos(half) * c, cos(half) * c);
    return out;
}

static void lying_ones_touch_along_a_line(void **state)
{
    (void)state;
    char text[SHAPE_TEXT], slope[SHAPE_TEXT];
    for (int i = 0; i < 5; i++) {
        const fall f = {lying(text, CYLINDER, 13.7 * i), FLOOR, {0.3, 0.5, 0.2}, {0.4, -3, 0.1}, {0.2, 2, 0}};
        expect_touch("on a floor", &f, (const double[]){0.3, 0, 0.2}, UP);
    }
    /* Along a slope, whose face goes through the origin. */
    const double tilt = 17.3 * PI / 180, n[3] = {0, cos(tilt), sin(tilt)};
    snprintf(slope, sizeof slope,
             "\"box\": {\"size\": [20, 1, 20]}, \"translation\": [0, %.17g, %.17g], \"rotation\": {\"axis\": [1, 0, "
             "0], \"angle\": 17.3}",
             -0.5 * n[1], -0.5 * n[2]);
    const fall down = {lying(text, CYLINDER, 0), slope, {0, 0.5 * n[1], 0.5 * n[2]}, {0, -3, 0}, {0, 1, 1}};
    expect_touch("on a slope", &down, (const double[]){0, 0, 0}, n);
}

static void slanting_ones_touch_with_their_rim(void **state)
{
    (void)state;
    char text[SHAPE_TEXT];
    for (int i = 0; i < 6; i++) {
        const double way = 0.1 + 0.37 * i, degrees = 12 + 9 * i, lean = degrees * PI / 180;
        /* Turned about a horizontal axis, it leans to the side that is square to that. */
        const double axis[3] = {cos(way), 0, sin(way)},
                     along[3] = {-sin(lean) * sin(way), cos(lean), sin(lean) * cos(way)};
        /* The lowest place of the rim below lies across its axis, where that leans from. */
        double rim[3], across[3];
        vector3_cross(across, axis, along);
        if (across[1] > 0)
            vector3_set(across, -across[0], -across[1], -across[2]);
        for (int k = 0; k < 3; k++)
            rim[k] = -along[k] + 0.5 * across[k];
        const fall f = {turned_by(text, CYLINDER, axis, degrees), FLOOR, {0, -rim[1], 0}, {0.3, -2, 0.1}, {0, 1, 0}};
        expect_touch("with its rim", &f, (const double[]){rim[0], 0, rim[2]}, UP);
    }
}

static void upright_ones_touch_in_the_middle(void **state)
{
    (void)state;
    const fall f = {CYLINDER, FLOOR, {0.3, 1, 0.2}, {0, -3, 0}, {0, 2, 0}};
    expect_touch("upright", &f, (const double[]){0.3, 0, 0.2}, UP);
}

static void cones_touch_with_tip_and_side(void **state)
{
    (void)state;
    char       text[SHAPE_TEXT];
    const fall f = {
        turned_by(text, CONE, (const double[]){1, 0, 0}, 180), FLOOR, {0.3, 0.5, 0.2}, {0.2, -3, 0}, {0, 2, 0}};
    const double half = atan(0.5), side = sqrt(1.25);
    expect_touch("with its tip", &f, (const double[]){0.3, 0, 0.2}, UP);
    /* Lying: turned about x until a ruling is level: tip and rim are as low, half the ruling apart from its middle. */
    const double degrees = 90 + half * 180 / PI, turn = degrees * PI / 180;
    const double tip[2] = {0.5 * cos(turn), 0.5 * sin(turn)}; /* y, z */
    const fall   lies = {turned_by(text, CONE, (const double[]){1, 0, 0}, degrees),
                         FLOOR,
                         {0.3, -tip[0], 0.2},
                         {0.2, -3, 0.1},
                         {0, 2, 0}};
    expect_touch("with its side", &lies, (const double[]){0.3, 0, 0.2 + tip[1] - side / 2}, UP);
}

#define BAR "\"cylinder\": {\"radius\": 0.4, \"height\": 4}"
#define ROD "\"cylinder\": {\"radius\": 0.3, \"height\": 4}"

static void crossed_ones_touch_where_they_cross(void **state)
{
    (void)state;
    char bar[SHAPE_TEXT], rod[SHAPE_TEXT];
    lying(bar, BAR, 0);
    for (int i = 0; i < 4; i++) {
        const double turn = 27.0 + 31 * i, way = turn * PI / 180;
        /* Turned about y by an angle, x goes to (cos, 0, −sin). */
        const double x = 0.2 + 0.1 * cos(way) / sin(way);
        const fall   f = {lying(rod, ROD, turn), bar, {0.2, 0.7, 0.1}, {0.3, -2, 0.2}, {0, 1, 0}};
        expect_touch("crossed", &f, (const double[]){x, 0.4, 0}, UP);
    }
}

static void parallel_ones_touch_beside_each_other(void **state)
{
    (void)state;
    for (int i = 0; i < 4; i++) {
        const double way = 0.3 + 0.41 * i, n[3] = {cos(way), 0, sin(way)};
        const fall   f = {"\"cylinder\": {\"radius\": 0.3, \"height\": 1}",
                          "\"cylinder\": {\"radius\": 0.4, \"height\": 2}",
                          {0.7 * n[0], 0.3, 0.7 * n[2]},
                          {-2 * n[0] + 0.5 * n[2], 0, -2 * n[2] - 0.5 * n[0]},
                          {n[0], 0, n[2]}};
        expect_touch("parallel", &f, (const double[]){0.4 * n[0], 0.3, 0.4 * n[2]}, n);
    }
}

static void balls_corners_and_edges_touch_the_side(void **state)
{
    (void)state;
    char bar[SHAPE_TEXT], text[SHAPE_TEXT];
    lying(bar, BAR, 0);
    for (int i = 0; i < 4; i++) {
        const double way = 0.05 + 0.17 * i, n[3] = {0, cos(way), sin(way)}, place[3] = {0.1, 0.4 * n[1], 0.4 * n[2]};
        const fall ball = {"\"sphere\": {\"radius\": 0.3}", bar, {0.1, 0.7 * n[1], 0.7 * n[2]}, {0, -2, 0}, {0, 1, 1}};
        expect_touch("a ball", &ball, place, n);
        turned_by(text, CONE, (const double[]){1, 0, 0}, 180);
        const fall tip = {text, bar, {0.1, 0.5 + place[1], place[2]}, {0, -2, 0}, {0, 1, 1}};
        expect_touch("a tip", &tip, place, n);
        /* A box with an edge below: across the bar, at an angle. */
        const double turn = (20.0 + 30 * i) * PI / 360, e = 45 * PI / 360;
        snprintf(text, sizeof text, "\"box\": {\"size\": [3, 0.4, 0.4]}, \"rotation\": [%.17g, %.17g, %.17g, %.17g]",
                 sin(e) * cos(turn), cos(e) * sin(turn), -sin(e) * sin(turn), cos(e) * cos(turn));
        const fall edge = {text, bar, {0, 0.4 + 0.2 * sqrt(2), 0}, {0.1, -2, 0.1}, {0, 1, 0}};
        if (i > 0)
            expect_touch("an edge", &edge, (const double[]){0, 0.4, 0}, UP);
    }
}

/* Where nothing is there to be met, as by a floor that is not in the scene. */
static void what_is_thrown_back_touches_with_what_is_outermost(void **state)
{
    (void)state;
    char         text[SHAPE_TEXT];
    const double way = 0.47, lean = 31 * PI / 180, axis[3] = {cos(way), 0, sin(way)};
    schedule     laid;
    moment       clips;
    contact     *found = NULL;
    size_t       count = 0;
    double       along[3] = {-sin(lean) * sin(way), cos(lean), sin(lean) * cos(way)}, across[3];
    vector3_cross(across, axis, along);
    if (across[1] > 0)
        vector3_set(across, -across[0], -across[1], -across[2]);
    char whole[1000];
    snprintf(whole, sizeof whole,
             "{\"limner_script\": 1, \"nodes\": [{\"name\": \"what\", %s, \"translation\": [0, 5, 0]}], \"behaviour\": "
             "{\"target\": \"what\", \"function\": \"bounce\", \"start\": [0, 5, 0], \"floor\": 0, \"duration\": 1.5}}",
             turned_by(text, CYLINDER, axis, 31));
    lmn_scene *s = load_or_fail(temp_file("thrown.json", whole, strlen(whole)));
    assert_int_equal(schedule_of_moment(&laid, &clips, s, NULL, NULL), LMN_OK);
    assert_int_equal(contacts_find(&found, &count, &laid, &clips, (int32_t)s->node_count - 1, 0, 1.5, 0.1, NULL),
                     LMN_OK);
    assert_int_equal(count, 1);
    assert_true(fabs(found[0].hit.seconds - sqrt(2 * 5 / 9.81)) < 1e-4);
    for (int k = 0; k < 3; k++)
        if (fabs(found[0].hit.place[k] - (-along[k] + 0.5 * across[k])) > 1e-4)
            fail_msg("place %d is %.6f instead of %.6f", k, found[0].hit.place[k], -along[k] + 0.5 * across[k]);
    mem_free(found);
    schedule_release(&laid);
    lmn_scene_destroy(&s);
}

/* What is no cylinder is met as it is. */
static void boxes_are_no_cylinders(void **state)
{
    (void)state;
    char         box[SHAPE_TEXT];
    const double e = 30 * PI / 180;
    snprintf(box, sizeof box, "\"box\": {\"size\": [1, 1, 1]}, \"rotation\": {\"axis\": [0, 0, 1], \"angle\": 30}");
    const double low = 0.5 * (cos(e) + sin(e));
    const fall   f = {box, FLOOR, {0, low, 0}, {0, -2, 0}, {0, 1, 0}};
    expect_touch("a box", &f, (const double[]){0.5 * (sin(e) - cos(e)) + 0, 0, 0}, UP);
}

/* A ball whose rings crowd at one pole, and which leans: no sum over its vertices vanishes by symmetry. */
static void uneven_balls_are_found(void **state)
{
    (void)state;
    enum { RINGS = 14, SIDES = 20 };
    const double centre[3] = {3, -1, 2}, radius = 0.7, lean = 0.6;
    vec3         positions[(RINGS + 1) * SIDES];
    uint32_t     indices[6 * RINGS * SIDES];
    primitive    p = {.positions = positions, .indices = indices, .bounds = box3_empty()};
    for (uint32_t i = 0; i < (RINGS + 1) * SIDES; i++) {
        const double along = (double)(i / SIDES) / RINGS, down = PI * along * along,
                     around = 2 * PI * (i % SIDES) / SIDES;
        const double x = sin(down) * cos(around), y = cos(down), z = sin(down) * sin(around);
        positions[i] =
            (vec3){(float)(centre[0] + radius * (x * cos(lean) - y * sin(lean))),
                   (float)(centre[1] + radius * (x * sin(lean) + y * cos(lean))), (float)(centre[2] + radius * z)};
        p.bounds = box3_with_point(p.bounds, positions[i]);
    }
    for (uint32_t i = 0; i < RINGS * SIDES; i++) {
        const uint32_t next = i % SIDES == SIDES - 1 ? i + 1 - SIDES : i + 1;
        const uint32_t two[] = {i, next, next + SIDES, i, next + SIDES, i + SIDES};
        memcpy(indices + 6 * i, two, sizeof two);
    }
    p.vertex_count = (RINGS + 1) * SIDES;
    p.index_count = 6 * RINGS * SIDES;
    sphere found;
    assert_true(sphere_of(&found, &p));
    assert_true(fabs(found.radius - radius) < 1e-5);
    assert_true(vector3_distance(found.centre, centre) < 1e-5);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(lying_ones_touch_along_a_line),
        cmocka_unit_test(slanting_ones_touch_with_their_rim),
        cmocka_unit_test(upright_ones_touch_in_the_middle),
        cmocka_unit_test(cones_touch_with_tip_and_side),
        cmocka_unit_test(crossed_ones_touch_where_they_cross),
        cmocka_unit_test(parallel_ones_touch_beside_each_other),
        cmocka_unit_test(balls_corners_and_edges_touch_the_side),
        cmocka_unit_test(boxes_are_no_cylinders),
        cmocka_unit_test(uneven_balls_are_found),
        cmocka_unit_test(what_is_thrown_back_touches_with_what_is_outermost),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
