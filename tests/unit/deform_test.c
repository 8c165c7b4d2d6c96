/* What moves is deformed by how it moves: against the laws of Großmann 2011, section 3.3.1, evaluated here once more
 * from motion that is known in closed form; rows 14, 27, 32 and 77i. */
#include "import_support.h"

#include <math.h>

#include "../support/moving_scene.h"
#include "limner/look.h"
#include "plan/deformation.h"
#include "pose/pose.h"
#include "pose/posed_mesh.h"

enum { POINTS_MOST = 8192 };
static const double pi = 3.14159265358979323846, grey[3] = {0.5, 0.5, 0.5};

#define assert_near(VALUE, EXPECTED, OFF) near_or_fail(VALUE, EXPECTED, OFF, #VALUE, __LINE__)

static void near_or_fail(double value, double expected, double off, const char *what, int line)
{
    if (!(fabs(value - expected) <= off))
        fail_msg("line %d: %s is %.6g instead of %.6g", line, what, value, expected);
}

/* Where vertices are, and what they enclose. */
typedef struct shape {
    double points[POINTS_MOST][3], low[3], high[3], volume;
    size_t count;
} shape;

static void measure(shape *out, const pose *p, size_t part)
{
    const primitive *q = &p->scene->meshes[p->scene->nodes[p->scene->parts[part].node].mesh].primitives[0];
    vec3            *at = malloc(q->vertex_count * sizeof *at);
    mat4             world = pose_instance(p, part, 0);
    pose_vertices(&p->parts[part], q, NULL, NULL, q->vertex_count, at, NULL);
    memset(out, 0, sizeof *out);
    assert_true(q->vertex_count <= POINTS_MOST);
    for (uint32_t i = 0; i < q->vertex_count; i++) {
        const double v[3] = {(double)at[i].x, (double)at[i].y, (double)at[i].z};
        for (int k = 0; k < 3; k++) {
            double x = world.m[k] * v[0] + world.m[4 + k] * v[1] + world.m[8 + k] * v[2] + world.m[12 + k];
            out->points[i][k] = x;
            out->low[k] = i ? fmin(out->low[k], x) : x;
            out->high[k] = i ? fmax(out->high[k], x) : x;
        }
    }
    out->count = q->vertex_count;
    for (uint32_t t = 0; t + 2 < q->index_count; t += 3) {
        double(*c)[3] = out->points, *a = c[q->indices[t]], *b = c[q->indices[t + 1]], *d = c[q->indices[t + 2]];
        out->volume += (a[0] * (b[1] * d[2] - b[2] * d[1]) + a[1] * (b[2] * d[0] - b[0] * d[2]) +
                        a[2] * (b[0] * d[1] - b[1] * d[0])) /
                       6;
    }
    free(at);
}

static lmn_scene *scene_of(moving_scene *m, const char *name)
{
    char path[256];
    snprintf(path, sizeof path, "%s/%s", temp_folder(), name);
    moving_scene_write(m, path);
    return load_or_fail(path);
}

/* The same deformation for all parts. */
typedef struct setting {
    part_deformation parts[8];
    pose_deformation all;
} setting;

static void set_all(setting *s, const lmn_scene *scene, const part_deformation *how)
{
    static uint64_t number;
    assert_true(scene->part_count <= 8);
    for (size_t i = 0; i < scene->part_count; i++)
        s->parts[i] = *how;
    s->all = (pose_deformation){s->parts, scene->part_count, 0.04, ++number};
}

static moment moment_of(const setting *s, double seconds)
{
    moment when = moment_at_rest();
    when.clips[when.clip_count++] = 0;
    when.seconds = seconds;
    when.deformation = s ? &s->all : NULL;
    when.deformation_hash = s ? s->all.hash : 0;
    return when;
}

static void shape_at(shape *out, const lmn_scene *scene, const setting *s, double seconds, size_t part)
{
    pose      p;
    lmn_error error = {0};
    moment    when = moment_of(s, seconds);
    assert_int_equal(pose_create(&p, scene, &when, &error), LMN_OK);
    measure(out, &p, part);
    box3 box = p.part_boxes[part];
    assert_near((double)box.min.x, out->low[0], 1e-4);
    assert_near((double)box.max.y, out->high[1], 1e-4);
    pose_release(&p);
}

/* --- a ball that bounces ---------------------------------------------------------------------------------- */

static const double radius = 0.5, drop = 3, gravity = 9.81;

/* Falls from a height, hits the floor, and rises to it again; cubic keys say so exactly. */
static lmn_scene *ball(double *contact, double sideways)
{
    moving_scene m;
    double       t = *contact = sqrt(2 * drop / gravity), v = gravity * t;
    double       times[] = {0, t, t + 1e-6, 2 * t}, high = radius + drop;
    double       values[] = {0,
                             0,
                             0,
                             0,
                             high,
                             0,
                             sideways,
                             0,
                             0, /* the tangent before, the value, the one after */
                             sideways,
                             -v,
                             0,
                             sideways * t,
                             radius,
                             0,
                             0,
                             0,
                             0,
                             0,
                             0,
                             0,
                             sideways * t,
                             radius,
                             0,
                             sideways,
                             v,
                             0,
                             sideways,
                             0,
                             0,
                             2 * sideways * t,
                             high,
                             0,
                             0,
                             0,
                             0};
    moving_scene_begin(&m);
    int node = moving_scene_sphere(&m, 0, 0, 0, radius, grey);
    moving_scene_cubic_keys(&m, node, "translation", 4, times, values);
    return scene_of(&m, "ball.glb");
}

static const part_deformation squashes = {.stretch = 0.6, .squash = 0.5, .full_speed = 6, .full_acceleration = 12};

static double length_of_ball(void)
{
    return 2 * radius * sqrt(3);
}

/* In free fall the ball is longer along its way by what it moves with, by the speed that it gains besides, and its
 * sides thinner by the root of that. */
static void balls_stretch_as_they_fall(void **state)
{
    double     contact;
    lmn_scene *scene = ball(&contact, 0);
    setting    s;
    shape      now, plain;
    (void)state;
    set_all(&s, scene, &squashes);
    for (double t = 0.1; t < contact - 0.05; t += 0.083) {
        double full = squashes.full_speed * length_of_ball(), speed = gravity * t, gain = gravity * 0.04 / 2;
        double f = (1 + squashes.stretch * fmin(speed / full, 1)) * (1 + squashes.stretch * gain / full);
        shape_at(&now, scene, &s, t, 0);
        shape_at(&plain, scene, NULL, t, 0);
        assert_near((now.high[1] - now.low[1]) / (2 * radius), f, 1e-3 * f);
        assert_near((now.high[0] - now.low[0]) / (2 * radius), sqrt(1 / f), 1e-3 * f);
        assert_near((now.high[1] - now.low[1]) / (now.high[0] - now.low[0]), f / sqrt(1 / f), 1e-3 * f);
        assert_near(now.volume / plain.volume, 1, 1e-3);
    }
    lmn_scene_destroy(&scene);
}

/* On the floor it is wider than tall and stays on it; at no time does it reach below it; and what it encloses stays. */
static void balls_are_squashed_on_the_floor(void **state)
{
    double     contact, deepest = 0;
    setting    s;
    shape      now, plain;
    lmn_scene *scene;
    (void)state;
    for (int sideways = 0; sideways < 2; sideways++) {
        scene = ball(&contact, sideways * 2.5);
        set_all(&s, scene, &squashes);
        shape_at(&now, scene, &s, contact, 0);
        double f = 1 - squashes.squash * fmin(gravity * (contact - 0.02) / (squashes.full_speed * length_of_ball()), 1);
        if (!sideways)
            assert_near((now.high[1] - now.low[1]) / (2 * radius), f, 2e-3);
        assert_true(now.high[0] - now.low[0] > 1.3 * (now.high[1] - now.low[1]));
        assert_near(now.low[1], 0, 1e-3);
        for (double t = 0; t <= 2 * contact; t += 0.01) {
            shape_at(&now, scene, &s, t, 0);
            shape_at(&plain, scene, NULL, t, 0);
            deepest = fmin(deepest, now.low[1]);
            assert_near(now.volume / plain.volume, 1, 1e-3);
        }
        lmn_scene_destroy(&scene);
    }
    printf("deepest below the floor: %.4f of a ball of 1\n", -deepest);
    assert_true(deepest > -0.02);
}

/* Where a pose was earlier, it was deformed as it moved then. */
static void the_past_has_its_own_shape(void **state)
{
    double     contact;
    lmn_scene *scene = ball(&contact, 1);
    lmn_error  error = {0};
    setting    s;
    shape      was, then, now;
    pose       p;
    (void)state;
    set_all(&s, scene, &squashes);
    moment when = moment_of(&s, contact);
    assert_int_equal(pose_create(&p, scene, &when, &error), LMN_OK);
    assert_int_equal(pose_add_past(&p, 0.1, 2, &error), LMN_OK);
    measure(&now, &p, 0);
    measure(&was, p.past[1], 0);
    shape_at(&then, scene, &s, contact - 0.1, 0);
    assert_memory_equal(was.points, then.points, sizeof was.points);
    assert_true(was.high[1] - was.low[1] > 1.3 * (now.high[1] - now.low[1]));
    pose_release(&p);
    lmn_scene_destroy(&scene);
}

/* What rests keeps every bit, and that nothing moves is said. */
static void rest_is_left_alone(void **state)
{
    moving_scene m;
    setting      s;
    shape        now, plain;
    pose         p;
    warnings     warned = {0};
    lmn_error    error = {0};
    const double half[3] = {0.3, 0.4, 0.5};
    (void)state;
    moving_scene_begin(&m);
    int node = moving_scene_box(&m, 0.1, 0.2, 0.3, half, grey);
    moving_scene_keys(&m, node, "translation", 3, (double[]){0, 1, 2}, (double[]){0, 0, 0, 0, 0, 0, 3, 0, 0});
    lmn_scene *scene = scene_of(&m, "rest.glb");
    set_all(&s, scene, &(part_deformation){1, 0.5, 0.5, 0.5, 6, 12, 0.1, 0, 4});
    shape_at(&now, scene, &s, 0.5, 0);
    shape_at(&plain, scene, NULL, 0.5, 0);
    assert_memory_equal(&now, &plain, sizeof now);
    for (int moving = 0; moving < 2; moving++) {
        moment when = moment_of(&s, 0.5 + moving);
        assert_int_equal(pose_create(&p, scene, &when, &error), LMN_OK);
        pose_warn_of_rigid(&p, &warned);
        assert_int_equal(warned.count, 1);
        pose_release(&p);
    }
    assert_non_null(strstr(warned.items[0].text, "nothing is deformed"));
    warnings_release(&warned);
    lmn_scene_destroy(&scene);
}

/* --- a box that starts and stops -------------------------------------------------------------------------- */

static const double box_half[3] = {0.6, 0.8, 0.4}, pull = 8;

/* Gets faster by `pull` for a second, keeps its speed for another, and stops within a third. */
static lmn_scene *tram(void)
{
    moving_scene m;
    double       times[] = {0, 1, 2, 3}, x[] = {0, pull / 2, 1.5 * pull, 2 * pull}, v[] = {0, pull, pull, 0},
           values[36] = {0};
    for (int i = 0; i < 4; i++) {
        values[9 * i] = values[9 * i + 6] = v[i];
        values[9 * i + 3] = x[i];
        values[9 * i + 4] = 2;
    }
    moving_scene_begin(&m);
    int node = moving_scene_box(&m, 0, 0, 0, box_half, grey);
    moving_scene_cubic_keys(&m, node, "translation", 4, times, values);
    return scene_of(&m, "tram.glb");
}

/* The shear of a box, radians, forward along x; its floor must be where it is. */
static double leaning(const lmn_scene *scene, const part_deformation *how, double seconds)
{
    setting s;
    shape   now, plain;
    double  top = 0;
    set_all(&s, scene, how);
    shape_at(&now, scene, &s, seconds, 0);
    shape_at(&plain, scene, NULL, seconds, 0);
    for (size_t i = 0; i < now.count; i++) {
        assert_near(now.points[i][1], plain.points[i][1], 1e-5);
        assert_near(now.points[i][2], plain.points[i][2], 1e-5);
        if (plain.points[i][1] > 2)
            top = now.points[i][0] - plain.points[i][0];
        else
            assert_near(now.points[i][0], plain.points[i][0], 1e-5);
    }
    assert_near(now.volume / plain.volume, 1, 1e-3);
    return atan(top / (2 * box_half[1]));
}

static void what_is_fast_leans(void **state)
{
    lmn_scene *scene = tram();
    double     length = 2 * sqrt(0.36 + 0.64 + 0.16), degree = pi / 180, before = 0;
    (void)state;
    part_deformation forward = {.lean = 30 * degree, .full_speed = 6, .full_acceleration = 12},
                     back = {.inertia = 25 * degree, .full_speed = 6, .full_acceleration = 6};
    for (double t = 0.1; t < 0.95; t += 0.2) { /* by the speed, whatever its sign */
        double angle = leaning(scene, &forward, t);
        assert_near(angle, 30 * degree * fmin(pull * t / length / 6, 1), 1e-3);
        assert_true(angle > before);
        before = angle;
    }
    assert_near(leaning(scene, &forward, 1.5), 30 * degree * fmin(pull / length / 6, 1), 1e-3);
    /* Against the pull; forward when it stops; not at all while nothing pulls. */
    assert_near(leaning(scene, &back, 0.5), -25 * degree * pull / length / 6, 1e-3);
    assert_near(leaning(scene, &back, 1.5), 0, 1e-4);
    assert_near(leaning(scene, &back, 2.5), 25 * degree * pull / length / 6, 1e-3);
    lmn_scene_destroy(&scene);
}

/* --- parts that are late ---------------------------------------------------------------------------------- */

/* A ball that goes along x, ever faster. */
static lmn_scene *comet(void)
{
    moving_scene m;
    moving_scene_begin(&m);
    int node = moving_scene_sphere(&m, 0, 0, 0, radius, grey);
    moving_scene_cubic_keys(&m, node, "translation", 2, (double[]){0, 2},
                            (double[]){0, 0, 0, 0, 1, 0, 0, 0, 0, 4 * 2, 0, 0, 8, 1, 0, 0, 0, 0});
    return scene_of(&m, "comet.glb");
}

/* A point of a part that is late is where it was that much earlier. */
static void rears_are_late(void **state)
{
    const double t = 1.5, lag = 0.2;
    lmn_scene   *scene = comet();
    setting      s;
    shape        now, plain;
    (void)state;
    set_all(&s, scene, &(part_deformation){.lag = lag, .full_speed = 6, .full_acceleration = 12});
    shape_at(&now, scene, &s, t, 0);
    shape_at(&plain, scene, NULL, t, 0);
    for (size_t i = 0; i < now.count; i++) {
        double rear = (plain.high[0] - plain.points[i][0]) / (2 * radius), then = t - lag * rear;
        assert_near(now.points[i][0] - plain.points[i][0], 2 * (then * then - t * t), 2e-3);
        assert_near(now.points[i][1], plain.points[i][1], 1e-6);
    }
    lmn_scene_destroy(&scene);
}

/* What is dragged: its rear keeps its velocity for so long while the rest is accelerated, so that it falls behind by
 * a·drag²/2, and all before it by the square of its distance; behind along the way, ahead when it brakes, and outwards
 * in a curve. */
static void rears_are_dragged(void **state)
{
    enum { KEYS = 257 };
    const double t = 1.5, drag = 0.2, round = 3, speed = 2;
    lmn_scene   *scene = comet();
    setting      s;
    shape        now, plain;
    double       times[KEYS], places[3 * KEYS], outwards = 0;
    moving_scene m;
    (void)state;
    set_all(&s, scene, &(part_deformation){.drag = drag, .full_speed = 6, .full_acceleration = 12});
    shape_at(&now, scene, &s, t, 0);
    shape_at(&plain, scene, NULL, t, 0);
    for (size_t i = 0; i < now.count; i++) {
        double rear = (plain.high[0] - plain.points[i][0]) / (2 * radius);
        assert_near(now.points[i][0] - plain.points[i][0], -0.5 * 4 * pow(drag * rear, 2), 2e-3); /* x = 2t² */
        assert_near(now.points[i][1], plain.points[i][1], 1e-6);
    }
    lmn_scene_destroy(&scene);
    for (int i = 0; i < KEYS; i++) {
        double angle = speed * (times[i] = 2.0 * i / (KEYS - 1));
        memcpy(places + 3 * i, (double[]){round * cos(angle), 0, round * sin(angle)}, 3 * sizeof *places);
    }
    moving_scene_begin(&m);
    moving_scene_keys(&m, moving_scene_sphere(&m, 0, 0, 0, radius, grey), "translation", KEYS, times, places);
    scene = scene_of(&m, "round.glb");
    set_all(&s, scene, &(part_deformation){.drag = drag, .full_speed = 6, .full_acceleration = 12});
    shape_at(&now, scene, &s, 1, 0);
    shape_at(&plain, scene, NULL, 1, 0);
    const double out[2] = {cos(speed), sin(speed)}, way[2] = {-sin(speed), cos(speed)},
                 middle[2] = {round * cos(speed), round * sin(speed)};
    for (size_t i = 0; i < now.count; i++) {
        double ahead = (plain.points[i][0] - middle[0]) * way[0] + (plain.points[i][2] - middle[1]) * way[1],
               rear = (radius - ahead) / (2 * radius), far = 0.5 * speed * speed * round * pow(drag * rear, 2);
        assert_near(now.points[i][0] - plain.points[i][0], far * out[0], 5e-3);
        assert_near(now.points[i][2] - plain.points[i][2], far * out[1], 5e-3);
        outwards = fmax(outwards, far);
    }
    assert_near(outwards, 0.24, 0.01);
    lmn_scene_destroy(&scene);
}

/* A rod that turns about its end bends: each point is where it was so much earlier as it is far from the hinge. */
static void rods_bend(void **state)
{
    enum { KEYS = 33 };
    moving_scene m;
    setting      s;
    shape        now, plain;
    double       times[KEYS], turns[4 * KEYS];
    const double half[3] = {1, 0.05, 0.05}, speed = 3, lag = 0.25;
    (void)state;
    for (int i = 0; i < KEYS; i++) {
        times[i] = 2.0 * i / (KEYS - 1);
        const double q[4] = {0, 0, sin(speed * times[i] / 2), cos(speed * times[i] / 2)};
        memcpy(turns + 4 * i, q, sizeof q);
    }
    moving_scene_begin(&m);
    int hinge = moving_scene_joint(&m, 0, 0, 0), rod = moving_scene_box(&m, 1, 0, 0, half, grey);
    moving_scene_put_in(&m, rod, hinge);
    moving_scene_keys(&m, hinge, "rotation", KEYS, times, turns);
    lmn_scene *scene = scene_of(&m, "rod.glb");
    set_all(&s, scene, &(part_deformation){.lag = lag, .full_speed = 6, .full_acceleration = 12});
    shape_at(&now, scene, &s, 1, 0);
    shape_at(&plain, scene, NULL, 1, 0);
    double farthest = hypot(2, hypot(0.05, 0.05));
    for (size_t i = 0; i < now.count; i++) {
        double far = sqrt(pow(plain.points[i][0], 2) + pow(plain.points[i][1], 2) + pow(plain.points[i][2], 2)),
               back = -speed * lag * far / farthest;
        assert_near(now.points[i][0], cos(back) * plain.points[i][0] - sin(back) * plain.points[i][1], 2e-3);
        assert_near(now.points[i][1], sin(back) * plain.points[i][0] + cos(back) * plain.points[i][1], 2e-3);
    }
    lmn_scene_destroy(&scene);
}

/* What turns on the spot is stretched by nothing, squashed by nothing and leans nowhere; and its rim lags. */
static void wheels_keep_their_shape(void **state)
{
    moving_scene m;
    setting      s;
    shape        now, plain;
    double       worst = 0;
    const double turns[] = {0, 0, 0, 1, 0, 0, sqrt(0.5), sqrt(0.5), 0, 0, 1, 0};
    (void)state;
    moving_scene_begin(&m);
    int node = moving_scene_cylinder(&m, 1, 2, 3, 0.8, 0.2, grey);
    moving_scene_keys(&m, node, "rotation", 3, (double[]){0, 0.5, 1}, turns);
    lmn_scene *scene = scene_of(&m, "wheel.glb");
    set_all(&s, scene, &(part_deformation){1, 0.5, 0.5, 0.5, 6, 12, 0, 0, 4});
    shape_at(&now, scene, &s, 0.6, 0);
    shape_at(&plain, scene, NULL, 0.6, 0);
    assert_memory_equal(&now, &plain, sizeof now);
    set_all(&s, scene, &(part_deformation){.lag = 0.1, .full_speed = 6, .full_acceleration = 12});
    shape_at(&now, scene, &s, 0.6, 0);
    for (size_t i = 0; i < now.count; i++) {
        double x = plain.points[i][0] - 1, y = plain.points[i][1] - 2, back = -pi * 0.1;
        if (hypot(x, y) < 0.79)
            continue;
        worst = fmax(worst, hypot(now.points[i][0] - 1 - cos(back) * x + sin(back) * y,
                                  now.points[i][1] - 2 - sin(back) * x - cos(back) * y));
    }
    assert_true(worst < 0.005);
    lmn_scene_destroy(&scene);
}

/* Rounding moves the middle of what turns by itself, and that is no motion. */
static void rounding_is_no_motion(void **state)
{
    enum { KEYS = 9 };
    moving_scene m;
    setting      s;
    shape        now, plain;
    double       times[KEYS], turns[4 * KEYS];
    const double half[3] = {0.2, 0.1, 0.1};
    (void)state;
    for (int i = 0; i < KEYS; i++) {
        times[i] = i / (KEYS - 1.0);
        const double q[4] = {0, 0, sin(3 * times[i]), cos(3 * times[i])};
        memcpy(turns + 4 * i, q, sizeof q);
    }
    moving_scene_begin(&m);
    int axle = moving_scene_joint(&m, 0.1, 0.2, 0.3);
    for (int side = -1; side <= 1; side += 2)
        moving_scene_put_in(&m, moving_scene_box(&m, 0.7 * side, 0.3 * side, 0.1, half, grey), axle);
    moving_scene_keys(&m, axle, "rotation", KEYS, times, turns);
    lmn_scene *scene = scene_of(&m, "axle.glb");
    set_all(&s, scene, &(part_deformation){1, 0.5, 0.5, 0.5, 6, 12, 0, 0, 4});
    for (double t = 0.21; t < 0.9; t += 0.07) {
        shape_at(&now, scene, &s, t, 1);
        shape_at(&plain, scene, NULL, t, 1);
        assert_memory_equal(&now, &plain, sizeof now);
    }
    lmn_scene_destroy(&scene);
}

static int by_height(const void *a, const void *b)
{
    const double *l = a, *r = b;
    return l[1] < r[1] ? -1 : l[1] > r[1];
}

/* The trailing side has teeth, long ones and gaps by turns; what goes ahead keeps every bit. */
static void trailing_sides_have_teeth(void **state)
{
    enum { TEETH = 4 };
    lmn_scene *scene = comet();
    setting    s;
    shape      now, plain;
    double     back[POINTS_MOST][2];
    size_t     count = 0, leading = 0;
    int        turns = 0;
    (void)state;
    set_all(&s, scene, &(part_deformation){.comb = 0.2, .teeth = TEETH, .full_speed = 6, .full_acceleration = 12});
    shape_at(&now, scene, &s, 1.5, 0);
    shape_at(&plain, scene, NULL, 1.5, 0);
    double middle = (plain.low[0] + plain.high[0]) / 2;
    for (size_t i = 0; i < now.count; i++) {
        double moved = plain.points[i][0] - now.points[i][0], behind = (middle - plain.points[i][0]) / radius;
        if (behind <= 0) {
            assert_memory_equal(now.points[i], plain.points[i], sizeof now.points[i]);
            leading++;
            continue;
        }
        assert_true(moved >= -1e-6);
        assert_near(now.points[i][1], plain.points[i][1], 1e-6);
        if (fabs(plain.points[i][2]) > 1e-6)
            continue;
        back[count][0] = moved / behind; /* along the middle of the trailing side, upwards */
        back[count++][1] = plain.points[i][1];
    }
    assert_true(leading > 500 && count > 20);
    qsort(back, count, sizeof *back, by_height);
    for (size_t i = 1; i + 1 < count; i++)
        turns += (back[i][0] > back[i - 1][0] + 1e-6 && back[i][0] > back[i + 1][0] + 1e-6);
    assert_int_equal(turns, TEETH);
    assert_true(now.low[0] < plain.low[0] - 0.3);
    lmn_scene_destroy(&scene);
}

/* A box has no vertices to make teeth of, which is said; a fine ball has. */
static void coarse_meshes_have_no_teeth(void **state)
{
    (void)state;
    for (int fine = 0; fine < 2; fine++) {
        lmn_scene *scene = fine ? comet() : tram();
        lmn_error  error = {0};
        warnings   warned = {0};
        setting    s;
        pose       p;
        set_all(&s, scene, &(part_deformation){.comb = 0.2, .teeth = 6, .full_speed = 6, .full_acceleration = 12});
        moment when = moment_of(&s, 1.5);
        assert_int_equal(pose_create(&p, scene, &when, &error), LMN_OK);
        pose_warn_of_rigid(&p, &warned);
        assert_int_equal(warned.count, !fine);
        assert_true(fine || strstr(warned.items[0].text, "too few vertices"));
        warnings_release(&warned);
        pose_release(&p);
        lmn_scene_destroy(&scene);
    }
}

/* Each part is deformed as the last rule says that selects it; the same look keeps what there is. */
static void rules_deform_their_parts(void **state)
{
    static const char json[] =
        "{\"version\": 1, \"rules\": [{\"surface\": \"lit\"}, {\"select\": \"*soft*\", \"surface\": \"lit\", "
        "\"motion\": {\"technique\": \"traces\", \"stretch\": 0.5, \"lean\": 30}}]}";
    moving_scene     m;
    pose_deformation kept = {0};
    lmn_error        error = {0};
    lmn_look        *look = NULL;
    const double     half[3] = {1, 1, 1};
    (void)state;
    moving_scene_begin(&m);
    for (int i = 0; i < 2; i++) {
        int node = moving_scene_box(&m, 3 * i, 0, 0, half, grey);
        moving_scene_name(&m, node, i ? "soft" : "hard");
        moving_scene_keys(&m, node, "translation", 2, (double[]){0, 1}, (double[]){3 * i, 0, 0, 3 * i, 9, 0});
    }
    lmn_scene *scene = scene_of(&m, "two.glb");
    assert_int_equal(lmn_look_parse(&look, json, "two", &error), LMN_OK);
    moment when = moment_of(NULL, 0.5);
    assert_int_equal(deformation_find(&kept, &when, scene, look, NULL, &error), LMN_OK);
    assert_ptr_equal(when.deformation, &kept);
    assert_true(part_deformation_is_none(&kept.parts[0]));
    assert_near(kept.parts[1].stretch, 0.5, 0);
    assert_near(kept.parts[1].lean, pi / 6, 1e-12);
    const part_deformation *before = kept.parts;
    moment                  again = moment_of(NULL, 0.5);
    assert_int_equal(deformation_find(&kept, &again, scene, look, NULL, &error), LMN_OK);
    assert_ptr_equal(kept.parts, before);
    assert_true(moment_equal(&when, &again));
    shape   now, plain;
    setting s = {.all = kept};
    for (size_t i = 0; i < 2; i++) {
        shape_at(&now, scene, &s, 0.5, i);
        shape_at(&plain, scene, NULL, 0.5, i);
        assert_int_equal(memcmp(&now, &plain, sizeof now) == 0, i == 0);
    }
    assert_int_equal(lmn_look_set(look, "1:motion.stretch", "0.6", &error), LMN_OK);
    assert_int_equal(deformation_find(&kept, &again, scene, look, NULL, &error), LMN_OK);
    assert_false(moment_equal(&when, &again));
    moment rest = moment_at_rest();
    assert_int_equal(deformation_find(&kept, &rest, scene, look, NULL, &error), LMN_OK);
    assert_null(rest.deformation);
    pose_deformation_release(&kept);
    lmn_look_destroy(&look);
    lmn_scene_destroy(&scene);
}

/* Limbs of a character that runs on the spot are where their own joints had them so much earlier as they are far from
 * its middle; and who draws gets the very same vertices. */
static void limbs_are_late(void **state)
{
    enum { STEP = 97 };
    const double lag = 0.1, t = 0.5;
    lmn_scene   *scene = load_or_fail(LIMNER_SOURCE_DIR "/examples/fox.glb");
    lmn_error    error = {0};
    setting      s;
    shape        now, plain, then;
    pose         p;
    posed_mesh   drawn;
    double       latest = 0, farthest = 0;
    (void)state;
    set_all(&s, scene, &(part_deformation){.lag = lag, .full_speed = 6, .full_acceleration = 12});
    moment when = moment_of(&s, t);
    when.clips[0] = 2; /* Run */
    assert_int_equal(pose_create(&p, scene, &when, &error), LMN_OK);
    measure(&now, &p, 0);
    assert_int_equal(posed_make(&drawn, &scene->meshes[0].primitives[0], 0.5, &p.parts[0], &error), LMN_OK);
    for (uint32_t i = 0; i < drawn.data.vertex_count; i++) {
        uint32_t from = drawn.split.source ? drawn.split.source[i] : i;
        for (int k = 0; k < 3; k++)
            assert_near((double)drawn.data.positions[3 * i + (uint32_t)k], now.points[from][k], 0);
    }
    moment still = moment_of(NULL, t);
    still.clips[0] = 2;
    pose rigid;
    assert_int_equal(pose_create(&rigid, scene, &still, &error), LMN_OK);
    measure(&plain, &rigid, 0);
    pose_release(&rigid);
    for (size_t i = 0; i < now.count; i += STEP) {
        double delay = bend_delay(p.parts[0].bend, plain.points[i]);
        still.seconds = t - delay;
        assert_int_equal(pose_create(&rigid, scene, &still, &error), LMN_OK);
        measure(&then, &rigid, 0);
        pose_release(&rigid);
        for (int k = 0; k < 3; k++)
            assert_near(now.points[i][k], then.points[i][k], 0.05); /* of a fox 160 long: chords between steps */
        latest = fmax(latest, delay);
        farthest = fmax(farthest, fabs(now.points[i][1] - plain.points[i][1]));
    }
    assert_true(latest > lag / 2 && latest <= lag && farthest > 5);
    posed_release(&drawn);
    pose_release(&p);
    lmn_scene_destroy(&scene);
}

/* What is held keeps the shape that it had then, also when the pose it was taken from is gone. */
static void what_is_held_keeps_its_shape(void **state)
{
    lmn_scene *scene = load_or_fail(LIMNER_SOURCE_DIR "/examples/fox.glb");
    lmn_error  error = {0};
    setting    s;
    shape      now, then, held;
    pose       p, earlier;
    const bool moves[] = {false};
    (void)state;
    set_all(&s, scene, &(part_deformation){0.5, 0.5, 0.3, 0.3, 0.1, 1, 0.1, 0.05, 4});
    moment when = moment_of(&s, 0.5), before = moment_of(&s, 0.3);
    when.clips[0] = before.clips[0] = 2;
    assert_int_equal(pose_create(&p, scene, &when, &error), LMN_OK);
    assert_int_equal(pose_create(&earlier, scene, &before, &error), LMN_OK);
    measure(&now, &p, 0);
    measure(&then, &earlier, 0);
    pose_hold(&p, &earlier, moves);
    pose_release(&earlier);
    measure(&held, &p, 0);
    assert_memory_equal(&held, &then, sizeof then);
    assert_memory_not_equal(&now, &then, sizeof then);
    pose_release(&p);
    lmn_scene_destroy(&scene);
}

/* Whichever allocation fails, that is said, and nothing is left. */
static void missing_memory_is_said(void **state)
{
    lmn_scene *scene = load_or_fail(LIMNER_SOURCE_DIR "/examples/fox.glb");
    setting    s;
    long       n = 0;
    (void)state;
    set_all(&s, scene, &(part_deformation){0.5, 0.5, 0.5, 0.5, 6, 12, 0.1, 0.1, 4});
    moment when = moment_of(&s, 0.5);
    for (lmn_status status = LMN_MEMORY; status != LMN_OK;) {
        pose      p;
        lmn_error error = {0};
        mem_fail_at(++n);
        status = pose_create(&p, scene, &when, &error);
        mem_fail_at(0);
        assert_true(status == LMN_OK || (status == LMN_MEMORY && error.message[0]));
        pose_release(&p);
        assert_true(n < 5000);
    }
    printf("%ld allocations\n", n - 1);
    assert_true(n > 50);
    lmn_scene_destroy(&scene);
}

/* --- slit shutters ---------------------------------------------------------------------------------------- */

/* How far a box's top has gone sideways against its bottom, a unit of height. */
static double slant_of(const shape *s)
{
    double top = 0, bottom = 0, tops = 0, bottoms = 0, middle = 0.5 * (s->low[1] + s->high[1]);
    for (size_t i = 0; i < s->count; i++) {
        bool upper = s->points[i][1] > middle;
        top += upper ? s->points[i][0] : 0;
        bottom += upper ? 0 : s->points[i][0];
        tops += upper;
        bottoms += !upper;
    }
    return (top / tops - bottom / bottoms) / (s->high[1] - s->low[1]);
}

/* Row 77f: a car of 5 units a second and a post that stands, in a scene that is 4 high, at rest. A camera that follows
 * half of the car's speed sees both lean by the same, to opposite sides; one that follows it wholly, the post alone. */
static void slits_shear_opposite_ways(void **state)
{
    const double speed = 5, height = 4, slit = 0.2;
    moving_scene m;
    shape        car, post;
    (void)state;
    moving_scene_begin(&m);
    int node = moving_scene_box(&m, 0, 1, 0, (double[]){2, 1, 1}, grey);
    moving_scene_box(&m, 0, 2, -5, (double[]){0.2, 2, 0.2}, grey);
    moving_scene_keys(&m, node, "translation", 2, (double[]){0, 2}, (double[]){0, 1, 0, 2 * speed, 1, 0});
    lmn_scene *scene = scene_of(&m, "slit.glb");
    for (int i = 0; i <= 4; i++) {
        part_deformation how = {.slit = slit, .pan = i / 4.0, .full_speed = 6, .full_acceleration = 12};
        setting          s;
        set_all(&s, scene, &how);
        shape_at(&car, scene, &s, 1, 0);
        shape_at(&post, scene, &s, 1, 1);
        assert_near(slant_of(&car), (1 - how.pan) * speed * slit / height, 1e-4);
        assert_near(slant_of(&post), -how.pan * speed * slit / height, 1e-4);
        assert_near(car.low[1], 0, 1e-5); /* they stand where they stood */
        assert_near(car.volume, 16, 1e-3);
    }
    lmn_scene_destroy(&scene);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(balls_stretch_as_they_fall), cmocka_unit_test(balls_are_squashed_on_the_floor),
        cmocka_unit_test(the_past_has_its_own_shape), cmocka_unit_test(rest_is_left_alone),
        cmocka_unit_test(what_is_fast_leans),         cmocka_unit_test(rears_are_late),
        cmocka_unit_test(rears_are_dragged),          cmocka_unit_test(rods_bend),
        cmocka_unit_test(wheels_keep_their_shape),    cmocka_unit_test(rounding_is_no_motion),
        cmocka_unit_test(trailing_sides_have_teeth),  cmocka_unit_test(limbs_are_late),
        cmocka_unit_test(slits_shear_opposite_ways),  cmocka_unit_test(coarse_meshes_have_no_teeth),
        cmocka_unit_test(rules_deform_their_parts),   cmocka_unit_test(what_is_held_keeps_its_shape),
        cmocka_unit_test(missing_memory_is_said),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
