/* Moments that tell most of a motion, against motions whose turns and rebounds are known. Row 77j. */
#include <math.h>
#include <string.h>

#include "base/memory.h"
#include "check.h"
#include "limner/scene.h"
#include "moving_scene.h"
#include "scene/scene.h"
#include "trace/telling.h"

static const double pi = 3.14159265358979323846, grey[3] = {0.5, 0.5, 0.5};
/* The page: 10 units of the world are 800 of paper, seen along −z in parallel. A frame is a 24th of a second. */
enum { PAGE = 800, KEYS = 241 };
static const double frame = 1.0 / 24;

typedef struct told {
    lmn_scene      *scene;
    pose            pose;
    bool           *parts;
    telling_options options;
    telling_moments moments;
} told;

static bool open_scene(told *t, const char *path, const char *clip, double seconds)
{
    lmn_error error = {0};
    moment    when;
    memset(t, 0, sizeof *t);
    bool good = lmn_scene_create(&t->scene, &error) == LMN_OK &&
                lmn_scene_add_file(t->scene, path, NULL, &error) == LMN_OK &&
                moment_find(&when, t->scene, clip, seconds, NULL, &error) == LMN_OK &&
                pose_create(&t->pose, t->scene, &when, &error) == LMN_OK;
    t->parts = check_alloc(t->scene->part_count + 1, sizeof *t->parts);
    memset(t->parts, true, t->scene->part_count);
    t->options = (telling_options){.pose = &t->pose, .parts = t->parts, .seconds = 60, .cover = 1};
    stroke_camera *c = &t->options.camera;
    c->view = mat4_identity();
    c->view.m[14] = -20;
    c->orthographic = true;
    c->width = c->height = PAGE;
    c->near = 0.1;
    c->projection.m[0] = c->projection.m[5] = 0.2;
    c->projection.m[10] = -0.02;
    c->projection.m[14] = -1;
    c->projection.m[15] = 1;
    return check_that("77j", good, "%s is read: %s", path, error.message);
}

static lmn_status tell(told *t)
{
    lmn_error error = {0};
    return telling_find(&t->moments, &t->options, &error);
}

static void close_scene(told *t)
{
    pose_release(&t->pose);
    lmn_scene_destroy(&t->scene);
    free(t->parts);
}

/* Is each of these times among the moments, with this reason? And how many others are there? */
static void expect(const told *t, const double *times, size_t count, telling_reason reason, const char *what)
{
    size_t others = 0;
    for (size_t i = 0; i < count; i++) {
        double off = INFINITY;
        bool   right = false;
        for (size_t k = 0; k < t->moments.count; k++) {
            double d = fabs(t->moments.now - t->moments.at[k].ago - times[i]);
            right = d < off ? t->moments.at[k].reason == reason : right;
            off = fmin(off, d);
        }
        check_at_most("77j", off, frame, "%s at %g s is found, seconds off", what, times[i]);
        check_that("77j", right, "%s at %g s is told as such", what, times[i]);
    }
    for (size_t k = 0; k < t->moments.count; k++) {
        double off = INFINITY;
        for (size_t i = 0; i < count; i++)
            off = fmin(off, fabs(t->moments.now - t->moments.at[k].ago - times[i]));
        others += t->moments.at[k].reason == reason && off > frame;
    }
    check_that("77j", others == 0, "%s: %zu others", what, others);
}

/* A pendulum of period 1, hanging at time 0: it turns back at a quarter and at three quarters of each second. */
static void pendulums_turn(void)
{
    moving_scene m;
    told         t;
    double       times[KEYS], turns[4 * KEYS];
    const double turning[4] = {0.25, 0.75, 1.25, 1.75};
    moving_scene_begin(&m);
    int joint = moving_scene_joint(&m, 0, 3, 0), rod = moving_scene_box(&m, 0, -2, 0, (double[]){0.1, 2, 0.1}, grey);
    moving_scene_put_in(&m, rod, joint);
    for (int i = 0; i < KEYS; i++) {
        times[i] = 2.0 * i / (KEYS - 1);
        double half = 0.5 * sin(2 * pi * times[i]);
        memcpy(&turns[4 * i], (double[]){0, 0, sin(half), cos(half)}, 4 * sizeof(double));
    }
    moving_scene_keys(&m, joint, "rotation", KEYS, times, turns);
    const char *path = check_path("pendulum.glb");
    moving_scene_write(&m, path);
    if (open_scene(&t, path, NULL, 2) && check_that("77j", tell(&t) == LMN_OK, "told"))
        expect(&t, turning, 4, TELLING_TURN, "a turn");
    close_scene(&t);
}

/* A ball on parabolas: it is at the ground at 0.45, 1.15 and 1.75 s, and highest half way between. */
static void balls_rebound(void)
{
    const double hits[5] = {-0.45, 0.45, 1.15, 1.75, 2.25}, ground[3] = {0.45, 1.15, 1.75}, tops[2] = {0.8, 1.45};
    moving_scene m;
    told         t;
    double       times[KEYS], places[3 * KEYS];
    moving_scene_begin(&m);
    int ball = moving_scene_sphere(&m, 0, 0, 0, 0.3, grey);
    for (int i = 0; i < KEYS; i++) {
        double s = times[i] = 2.2 * i / (KEYS - 1);
        int    k = 0;
        while (k < 3 && s >= hits[k + 1])
            k++;
        places[3 * i] = -4 + 3.5 * s;
        places[3 * i + 1] = -3 + 25 * (s - hits[k]) * (hits[k + 1] - s);
        places[3 * i + 2] = 0;
    }
    moving_scene_keys(&m, ball, "translation", KEYS, times, places);
    const char *path = check_path("bouncing.glb");
    moving_scene_write(&m, path);
    if (open_scene(&t, path, NULL, 2.2) && check_that("77j", tell(&t) == LMN_OK, "told")) {
        expect(&t, ground, 3, TELLING_CONTACT, "a contact");
        expect(&t, tops, 2, TELLING_TURN, "a top");
    }
    close_scene(&t);
}

/* A ball of radius 1 that passes by evenly: of 6 units of way there is room for four balls side by side, and all of
 * them are told only when they may cover each other. */
static void figures_keep_apart(void)
{
    moving_scene m;
    told         t;
    moving_scene_begin(&m);
    int ball = moving_scene_sphere(&m, -3, 0, 0, 1, grey);
    moving_scene_keys(&m, ball, "translation", 2, (double[]){0, 1}, (double[]){-3, 0, 0, 3, 0, 0});
    const char *path = check_path("passing.glb");
    moving_scene_write(&m, path);
    if (open_scene(&t, path, NULL, 1)) {
        double nearest = INFINITY;
        t.options.count = 6;
        t.options.cover = 0;
        check_that("77j", tell(&t) == LMN_OK, "told");
        for (size_t i = 1; i < t.moments.count; i++)
            nearest = fmin(nearest, 6 * (t.moments.at[i].ago - t.moments.at[i - 1].ago));
        check_at_least("77j", (double)t.moments.count, 3, "balls");
        check_at_least("77j", nearest, 1.9, "units from one to the next");
        t.options.cover = 1;
        check_that("77j", tell(&t) == LMN_OK && t.moments.count == 6, "six that may cover each other");
        t.options.beside_now = true;
        t.options.cover = 0;
        check_that("77j", tell(&t) == LMN_OK && t.moments.count && 6 * t.moments.at[0].ago >= 1.9,
                   "none covers what is there now");
        t.options.count = 0;
        t.options.beside_now = false;
        t.options.cover = 1;
        check_that("77j", tell(&t) == LMN_OK, "told");
        check_that("77j", t.moments.count == 2, "by themselves the two ends alone tell something: %zu moments",
                   t.moments.count);
    }
    close_scene(&t);
}

/* "b_LeftForeArm_010" and "b_RightForeArm_07". */
static bool is_other_side(const char *left, const char *right)
{
    const char *a = strstr(left, "Left"), *b = strstr(right, "Right");
    if (!a || !b)
        return false;
    size_t length = strcspn(a + 4, "_");
    return length == strcspn(b + 5, "_") && strncmp(a + 4, b + 5, length) == 0;
}

static size_t find_other_side(const lmn_scene *s, const skin *k, size_t joint)
{
    const char *own = s->nodes[k->joints[joint]].name;
    for (size_t n = 0; n < k->joint_count; n++) {
        const char *other = s->nodes[k->joints[n]].name;
        if (is_other_side(own, other) || is_other_side(other, own))
            return n;
    }
    return joint;
}

/* The fox's left and right joints, paired by their names instead of by their places. */
static double asymmetry_by_names(const pose *p)
{
    const lmn_scene *s = p->scene;
    const pose      *rest = p->at_rest;
    const skin      *k = &s->skins[0];
    mat4   back = mat4_inverse(&p->worlds[k->joints[0]]), home = mat4_multiply(&rest->worlds[k->joints[0]], &back);
    double sum = 0, size = 0, middle = 0;
    vec3   at[64], first = {0, 0, 0};
    for (size_t i = 0; i < k->joint_count; i++) {
        vec3 own = mat4_transform_point(&rest->worlds[k->joints[i]], (vec3){0, 0, 0});
        mat4 posed = mat4_multiply(&home, &p->worlds[k->joints[i]]);
        first = i ? first : own;
        size = fmax(size, sqrt(pow((double)(own.x - first.x), 2) + pow((double)(own.y - first.y), 2) +
                               pow((double)(own.z - first.z), 2)));
        at[i] = mat4_transform_point(&posed, (vec3){0, 0, 0});
        middle += (double)own.x / (double)k->joint_count;
    }
    for (size_t i = 0; i < k->joint_count; i++) {
        size_t other = find_other_side(s, k, i);
        double x = 2 * middle - (double)at[i].x - (double)at[other].x, y = (double)(at[i].y - at[other].y),
               z = (double)(at[i].z - at[other].z);
        sum += sqrt(x * x + y * y + z * z) / (double)k->joint_count;
    }
    return sum / size;
}

static void sides_differ(void)
{
    told t;
    if (open_scene(&t, LIMNER_EXAMPLES "/fox.glb", "Walk", 0.7)) {
        lmn_error error = {0};
        double    off = 0, most = 0, least = INFINITY;
        check_that("77j", tell(&t) == LMN_OK && t.moments.count > 1, "%zu moments of a walk", t.moments.count);
        for (size_t i = 0; i < t.moments.count; i++) {
            pose   p;
            moment when = t.pose.when;
            when.seconds -= t.moments.at[i].ago;
            if (pose_create(&p, t.scene, &when, &error) != LMN_OK)
                return;
            double known = asymmetry_by_names(&p);
            off = fmax(off, fabs(known - t.moments.at[i].asymmetry));
            most = fmax(most, known);
            least = fmin(least, known);
            pose_release(&p);
        }
        check_at_most("77j", off, 0.02, "asymmetry by places and by names differ");
        check_at_least("77j", most, 0.05, "asymmetry at most");
        check_note("asymmetry from %.3f to %.3f", least, most);
    }
    close_scene(&t);
}

static void odd_motions(void)
{
    moving_scene m;
    told         t;
    moving_scene_begin(&m);
    moving_scene_sphere(&m, 0, 0, 0, 1, grey);
    int joint = moving_scene_joint(&m, 0, 0, 0);
    moving_scene_keys(&m, joint, "translation", 2, (double[]){0, 1}, (double[]){0, 0, 0, 1, 0, 0});
    const char *path = check_path("resting.glb");
    moving_scene_write(&m, path);
    if (open_scene(&t, path, NULL, 1)) {
        t.options.count = 5;
        check_that("bad", tell(&t) == LMN_OK && t.moments.count == 0, "nothing that is seen moves: no moments");
    }
    close_scene(&t);
    if (open_scene(&t, LIMNER_EXAMPLES "/box-animated.glb", NULL, 0)) {
        t.options.count = 5;
        check_that("bad", tell(&t) == LMN_OK && t.moments.count == 0, "at the beginning: no moments");
    }
    close_scene(&t);
}

/* Every allocation may fail. */
static void memory_may_run_out(void)
{
    told t;
    if (open_scene(&t, LIMNER_EXAMPLES "/fox.glb", "Walk", 0.3)) {
        lmn_status status = LMN_MEMORY;
        long       n = 1, other = 0;
        t.options.count = 3;
        t.options.cover = 0.5;
        for (; status != LMN_OK && n < 200000; n += 1 + n / 20) {
            mem_fail_at(n);
            status = tell(&t);
            mem_fail_at(0);
            other += status != LMN_OK && status != LMN_MEMORY;
        }
        check_that("memory", status == LMN_OK && n > 40 && other == 0, "%ld allocations", n);
    }
    close_scene(&t);
}

int main(int argc, char **argv)
{
    static const check_case cases[] = {
        {"pendulum", pendulums_turn}, {"ball", balls_rebound}, {"apart", figures_keep_apart},
        {"sides", sides_differ},      {"odd", odd_motions},    {"memory", memory_may_run_out},
    };
    return check_main(argc, argv, "telling", cases, sizeof cases / sizeof *cases);
}
