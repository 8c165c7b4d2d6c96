/* Signs against what they tell, which is known in closed form: where things meet, turn, grow, speak, part. Nienhaus
 * 2005, sections 7.6 to 7.10; rows D12, D19, D20, D22 to D26, D29, D30. */
#include "depict_support.h"

#include "../support/moving_scene.h"
#include "depict/depict.h"
#include "depict/depict_private.h"
#include "pose/face.h"
#include "limner/content.h"
#include "limner/depict.h"

static const double red[3] = {0.8, 0.1, 0.1}, grey[3] = {0.5, 0.5, 0.5}, pi = 3.14159265358979;

/* --- scenes ------------------------------------------------------------------------------------------------------- */

static lmn_scene *finish(moving_scene *m, const char *name)
{
    char path[256];
    snprintf(path, sizeof path, "%s/%s.glb", temp_folder(), name);
    moving_scene_write(m, path);
    return load_or_fail(path);
}

static void turn_keys(moving_scene *m, int node, const double axis[3], double degrees, double seconds)
{
    enum { KEYS = 33 };
    double times[KEYS], values[4 * KEYS];
    for (int i = 0; i < KEYS; i++) {
        const double half = degrees * pi / 360 * i / (KEYS - 1);
        times[i] = seconds * i / (KEYS - 1);
        for (int k = 0; k < 3; k++)
            values[4 * i + k] = sin(half) * axis[k];
        values[4 * i + 3] = cos(half);
    }
    moving_scene_keys(m, node, "rotation", KEYS, times, values);
}

/* A ball falls straight down upon a plate, which it touches at (2, 0, 0) after a second, and goes on as fast. `gap`:
 * the plate lies so much lower. A wall is far away. */
static lmn_scene *bounce_scene(double gap)
{
    moving_scene m;
    moving_scene_begin(&m);
    int ground = moving_scene_box(&m, 0, -0.1 - gap, 0, (double[]){5, 0.1, 3}, grey),
        ball = moving_scene_sphere(&m, 2, 3, 0, 0.5, red),
        wall = moving_scene_box(&m, -4.5, 1, 0, (double[]){0.1, 1, 3}, grey);
    moving_scene_name(&m, ground, "ground");
    moving_scene_name(&m, ball, "ball");
    moving_scene_name(&m, wall, "wall");
    moving_scene_keys(&m, ball, "translation", 3, (double[]){0, 1, 2}, (double[]){2, 3, 0, 2, 0.5, 0, 2, 3, 0});
    return finish(&m, "bounce");
}

static void name_and_keys(moving_scene *m, int node, const char *name, const double values[6])
{
    moving_scene_name(m, node, name);
    moving_scene_keys(m, node, "translation", 2, (double[]){0, 2}, values);
}

typedef enum crate_way { ALL_SIDES, ONE_SIDE, FAN } crate_way;

/* Pieces in a crate: they stay for half a second, then fly to all sides; or as one; or to one side, all apart. */
static lmn_scene *crate_scene(crate_way how)
{
    moving_scene m;
    moving_scene_begin(&m);
    int crate = moving_scene_joint(&m, 1, 1, 0);
    moving_scene_name(&m, crate, "crate");
    for (int i = 0; i < 8; i++) {
        double at[3] = {i & 1 ? 0.3 : -0.3, i & 2 ? 0.3 : -0.3, i & 4 ? 0.3 : -0.3}, far = 8;
        int    piece = moving_scene_box(&m, at[0], at[1], at[2], (double[]){0.25, 0.25, 0.25}, red);
        moving_scene_put_in(&m, piece, crate);
        double values[9];
        for (int k = 0; k < 3; k++) {
            values[k] = values[3 + k] = at[k];
            values[6 + k] = how == ALL_SIDES ? far * at[k] : at[k] * (how == FAN ? 4 : 1) + (k == 0 ? 9 : 0);
        }
        moving_scene_keys(&m, piece, "translation", 3, (double[]){0, 0.5, 2}, values);
    }
    return finish(&m, "crate");
}

/* Three balls fly along x together; after a second two of them bend away, 2·s² upwards and downwards. */
static lmn_scene *jets_scene(bool parts)
{
    enum { KEYS = 41 };
    moving_scene m;
    moving_scene_begin(&m);
    int jets = moving_scene_joint(&m, 0, 0, 0);
    moving_scene_name(&m, jets, "jets");
    for (int i = -1; i <= 1; i++) {
        double times[KEYS], values[3 * KEYS];
        int    jet = moving_scene_sphere(&m, 0, i, 0, 0.3, red);
        moving_scene_put_in(&m, jet, jets);
        for (int k = 0; k < KEYS; k++) {
            const double late = parts ? fmax(0, k / 20.0 - 1) : 0;
            times[k] = k / 20.0;
            values[3 * k] = 5 * times[k];
            values[3 * k + 1] = i + 2 * i * late * late;
            values[3 * k + 2] = 0;
        }
        moving_scene_keys(&m, jet, "translation", KEYS, times, values);
    }
    return finish(&m, "jets");
}

/* Something that goes 6 along x in two seconds, and turns about an axis. */
static lmn_scene *spin_scene(const double axis[3], double turns)
{
    moving_scene m;
    moving_scene_begin(&m);
    int plane = moving_scene_box(&m, 0, 1, 0, (double[]){0.5, 0.1, 1}, red);
    name_and_keys(&m, plane, "plane", (double[]){0, 1, 0, 6, 1, 0});
    turn_keys(&m, plane, axis, 360 * turns, 2);
    return finish(&m, "spin");
}

/* A car goes along x; the camera with it, or the other way. */
static lmn_scene *drive_scene(bool together)
{
    moving_scene m;
    moving_scene_begin(&m);
    int car = moving_scene_box(&m, 0, 0.5, 0, (double[]){1, 0.5, 0.5}, red);
    name_and_keys(&m, car, "car", (double[]){0, 0.5, 0, 9, 0.5, 0});
    int eye = moving_scene_camera(&m, 0, 1, 8, false, 40);
    moving_scene_keys(&m, eye, "translation", 2, (double[]){0, 2},
                      together ? (double[]){0, 1, 8, 9, 1, 8} : (double[]){9, 1, 8, 0, 1, 8});
    return finish(&m, "drive");
}

static lmn_scene *growth_scene(double from, double to, double way)
{
    moving_scene m;
    moving_scene_begin(&m);
    int box = moving_scene_box(&m, 1, 1, 0, (double[]){1, 1, 1}, red);
    name_and_keys(&m, box, "box", (double[]){1, 1, 0, 1 + way, 1, 0});
    moving_scene_keys(&m, box, "scale", 2, (double[]){0, 2}, (double[]){from, from, from, to, to, to});
    return finish(&m, "growth");
}

/* A foot comes to a ball after a second, or rests beside it, which flies off then, and rises. */
static lmn_scene *kick_scene(bool comes)
{
    moving_scene m;
    moving_scene_begin(&m);
    int foot = moving_scene_box(&m, -1, 0, 0, (double[]){0.3, 0.3, 0.3}, grey),
        ball = moving_scene_sphere(&m, 0, 0, 0, 0.3, red);
    moving_scene_name(&m, foot, "foot");
    moving_scene_name(&m, ball, "ball");
    if (comes)
        moving_scene_keys(&m, foot, "translation", 3, (double[]){0, 1, 2}, (double[]){-4, 0, 0, -1, 0, 0, -1, 3, 0});
    moving_scene_keys(&m, ball, "translation", 3, (double[]){0, 1, 2}, (double[]){0, 0, 0, 0, 0, 0, 5, 2, 0});
    return finish(&m, "kick");
}

static void turn_to(moving_scene *m, int node, int axis, const double degrees[3])
{
    double values[12] = {0};
    for (int i = 0; i < 3; i++) {
        values[4 * i + axis] = sin(degrees[i] * pi / 360);
        values[4 * i + 3] = cos(degrees[i] * pi / 360);
    }
    moving_scene_keys(m, node, "rotation", 3, (double[]){0, 1, 2}, values);
}

static const double lever_turn = 20;

/* Where the lower edge of a lever's left end is when it is turned. */
static void lever_end(double out[2])
{
    const double a = lever_turn * pi / 180;
    out[0] = -2 * cos(a) + 0.1 * sin(a);
    out[1] = 1 - 2 * sin(a) - 0.1 * cos(a);
}

/* A lever on an axle, about which it turns there and back; its left end comes to a block after a second, or stops so
 * much above it. A post carries it, and touches it all the time. */
static lmn_scene *lever_scene(double gap)
{
    moving_scene m;
    double       end[2];
    lever_end(end);
    moving_scene_begin(&m);
    int lever = moving_scene_box(&m, 0, 1, 0, (double[]){2, 0.1, 0.3}, red),
        block = moving_scene_box(&m, -1.75, end[1] - gap - 0.5, 0, (double[]){0.75, 0.5, 1}, grey),
        post = moving_scene_box(&m, 0, 0.4, 0, (double[]){0.05, 0.5, 0.3}, grey);
    moving_scene_name(&m, lever, "lever");
    moving_scene_name(&m, block, "block");
    moving_scene_name(&m, post, "post");
    turn_to(&m, lever, 2, (double[]){0, lever_turn, 0});
    return finish(&m, "lever");
}

/* A door of 2 by 3, 0.1 thick, whose square knuckle lies against a wall, into which its edges turn; it opens a bit and
 * stays, or falls to, against a jamb behind its other edge. */
static lmn_scene *door_scene(bool closes)
{
    moving_scene m;
    moving_scene_begin(&m);
    int wall = moving_scene_box(&m, -1.05, 1.5, 0, (double[]){1, 1.5, 0.2}, grey),
        jamb = moving_scene_box(&m, 2, 1.5, -0.1, (double[]){0.2, 1.5, 0.05}, grey),
        hinge = moving_scene_joint(&m, 0, 1.5, 0), leaf = moving_scene_box(&m, 1, 0, 0, (double[]){1, 1.5, 0.05}, red),
        knuckle = moving_scene_box(&m, 0, 0, 0, (double[]){0.05, 1.5, 0.05}, red);
    moving_scene_name(&m, wall, "wall");
    moving_scene_name(&m, jamb, "jamb");
    moving_scene_name(&m, hinge, "hinge");
    moving_scene_put_in(&m, leaf, hinge);
    moving_scene_put_in(&m, knuckle, hinge);
    turn_to(&m, hinge, 1, closes ? (double[]){-90, 0, 0} : (double[]){0, -30, -30});
    return finish(&m, "door");
}

/* A body with a head, and in this a mouth where it is wanted. */
static lmn_scene *speaker_scene(bool with_head, bool with_mouth)
{
    moving_scene m;
    moving_scene_begin(&m);
    int body = moving_scene_box(&m, 0, 1, 0, (double[]){0.4, 1, 0.2}, grey);
    moving_scene_name(&m, body, "somebody");
    if (with_head) {
        int head = moving_scene_sphere(&m, 0, 1.4, 0, 0.4, red);
        moving_scene_name(&m, head, "Head");
        moving_scene_put_in(&m, head, body);
        if (with_mouth) {
            int mouth = moving_scene_joint(&m, 0.1, -0.15, 0.35);
            moving_scene_name(&m, mouth, "the Mouth");
            moving_scene_put_in(&m, mouth, head);
        }
    }
    return finish(&m, "speaker");
}

/* --- tests -------------------------------------------------------------------------------------------------------- */

static void stars_are_where_things_meet(void **state)
{
    (void)state;
    lmn_scene *scene = bounce_scene(0);
    double     at[3];
    tell_at(scene, 1.5, "[{\"target\": \"ball\", \"depict\": \"collision\"}]");
    position(sign_at(scene, "star", 0), 0, at);
    assert_near(at[0], 2, 1e-4);
    assert_near(at[1], 0, 1e-4);
    assert_true(at[2] > 3); /* before the plate, which reaches as far */
    assert_int_equal(count_of(scene, "star"), 2);
    assert_int_equal(count_of(scene, "noise"), 1);
    tell_at(scene, 1.5, "[{\"target\": \"ball\", \"depict\": \"collision\", \"text\": \"\"}]");
    assert_int_equal(count_of(scene, "noise"), 0);
    tell_at(scene, 0.5, "[{\"target\": \"ball\", \"depict\": \"collision\"}]");
    assert_null(sign_at(scene, "star", 0)); /* it is still to come */
    tell_at(scene, 0.5, "[{\"target\": \"ball\", \"depict\": \"collision\", \"all\": true}]");
    assert_non_null(sign_at(scene, "star", 0));
    tell_at(scene, 1.5, "[{\"target\": \"ball\", \"depict\": \"collision\", \"partner\": \"wall\"}]");
    assert_null(sign_at(scene, "star", 0)); /* it hits something else */
    lmn_scene_destroy(&scene);
    scene = bounce_scene(0.2);
    tell_at(scene, 1.5, "[{\"target\": \"ball\", \"depict\": \"collision\", \"partner\": \"ground\"}]");
    position(sign_at(scene, "star", 0), 0, at);
    assert_near(at[0], 2, 1e-4);
    assert_near(at[1], -0.1, 1e-4); /* between both */
    lmn_scene_destroy(&scene);
}

/* Nobody has said what is hit: it is whatever is near. */
static void stars_find_what_is_hit(void **state)
{
    (void)state;
    static const double gaps[][2] = {{0, 0}, {0.04, -0.02}, {0.2, 0}}; /* too far away: the ball's own place */
    for (int i = 0; i < 3; i++) {
        lmn_scene *scene = bounce_scene(gaps[i][0]);
        double     at[3];
        tell_at(scene, 1.5, "[{\"target\": \"ball\", \"depict\": \"collision\"}]");
        position(sign_at(scene, "star", 0), 0, at);
        assert_near(at[0], 2, 1e-4);
        assert_near(at[1], gaps[i][1], 1e-4);
        lmn_scene_destroy(&scene);
    }
}

/* What turns about its middle, which stays where it is, hits with its end. */
static void stars_are_where_what_turns_hits(void **state)
{
    (void)state;
    double     end[2], at[3];
    lmn_scene *scene = lever_scene(0);
    lever_end(end);
    for (int named = 0; named < 2; named++) {
        tell_at(scene, 1.5,
                named ? "[{\"target\": \"lever\", \"depict\": \"collision\", \"partner\": \"block\"}]"
                      : "[{\"target\": \"lever\", \"depict\": \"collision\"}]");
        assert_int_equal(count_of(scene, "star"), 2);
        position(sign_at(scene, "star", 0), 0, at);
        assert_near(at[0], end[0], 1e-4);
        assert_near(at[1], end[1], 1e-4);
    }
    tell_at(scene, 1.5, "[{\"target\": \"lever\", \"depict\": \"collision\", \"partner\": \"post\"}]");
    assert_null(sign_at(scene, "star", 0)); /* it lies on that */
    lmn_scene_destroy(&scene);
    scene = door_scene(true);
    tell_at(scene, 1.5, "[{\"target\": \"hinge\", \"depict\": \"collision\"}]");
    position(sign_at(scene, "star", 0), 0, at);
    assert_near(at[0], 1.9, 1e-4); /* the middle of what of the leaf lies on the jamb: from 1.8 to 2 */
    assert_near(at[1], 1.5, 1e-4);
    lmn_scene_destroy(&scene);
}

/* In perspective what is nearer to the viewer is seen elsewhere unless it lies on the line of sight. */
static void stars_are_seen_where_things_meet(void **state)
{
    (void)state;
    lmn_scene    *scene = bounce_scene(0);
    lmn_draw_desc draw = seen_at(1.5);
    double        at[3], to_contact[3], across[3];
    const double  eye[3] = {6, 5, 14}, contact[3] = {2, 0, 0};
    draw.orthographic = false;
    draw.eye_given = true;
    vector3_copy(draw.eye, eye);
    vector3_set(draw.target, 0, 1, 0);
    vector3_set(draw.up, 0, 1, 0);
    tell_as(scene, &draw, "[{\"target\": \"ball\", \"depict\": \"collision\"}]", NULL);
    position(sign_at(scene, "star", 0), 0, at);
    vector3_add(to_contact, contact, -1, eye);
    vector3_normalise(to_contact);
    vector3_add(at, at, -1, eye);
    vector3_cross(across, at, to_contact);
    assert_near(vector3_length(across), 0, 1e-4);
    assert_true(vector3_length(at) < vector3_distance(contact, eye) - 1);
    lmn_scene_destroy(&scene);
}

static void check_bend(double degrees, double expected)
{
    moving_scene m;
    double       axis[3] = {0.2, 0.9, 0.4}, first[3] = {0}, tip[3], off[3], side[3];
    const double pivot[3] = {1, 2, 0};
    vector3_normalise(axis);
    moving_scene_begin(&m);
    int arm = moving_scene_joint(&m, pivot[0], pivot[1], pivot[2]),
        hand = moving_scene_box(&m, 1, 0, 0, (double[]){0.2, 0.2, 0.2}, red);
    moving_scene_name(&m, arm, "limb");
    moving_scene_put_in(&m, hand, arm);
    turn_keys(&m, arm, axis, degrees, 2);
    lmn_scene *scene = finish(&m, "arm");
    tell_at(scene, 2, "[{\"target\": \"limb\", \"depict\": \"turnaround\"}]");
    const primitive *bend = sign_at(scene, "bent-arrow", 0);
    assert_non_null(bend);
    uint32_t pairs = (bend->vertex_count - 1) / 2;
    double   level = NAN, far = 0;
    for (int i = 0; i < 8; i++) { /* the hand's corner that goes around farthest */
        double corner[3] = {i & 1 ? 1.2 : 0.8, i & 2 ? 0.2 : -0.2, i & 4 ? 0.2 : -0.2};
        vector3_add(corner, corner, -vector3_dot(corner, axis), axis);
        far = fmax(far, vector3_length(corner));
    }
    for (uint32_t k = 0; k < pairs; k++) {
        ribbon_point(bend, k, off);
        vector3_add(off, off, -1, pivot);
        double along = vector3_dot(off, axis);
        level = isnan(level) ? along : level;
        assert_near(along, level, 1e-4);
        vector3_add(off, off, -along, axis);
        assert_near(vector3_length(off), 1.25 * far, 2e-3);
        if (k == 0)
            vector3_copy(first, off);
    }
    position(bend, bend->vertex_count - 1, tip);
    vector3_add(tip, tip, -1, pivot);
    vector3_add(tip, tip, -vector3_dot(tip, axis), axis);
    vector3_cross(side, first, tip);
    double angle = atan2(vector3_dot(side, axis), vector3_dot(first, tip)) * 180 / pi;
    assert_near(fmod(angle - expected + 900, 360) - 180, 0, 0.05);
    lmn_scene_destroy(&scene);
}

static void bent_arrows_turn_as_things_do(void **state)
{
    (void)state;
    check_bend(100, 100);
    check_bend(-70, -70);
    check_bend(250, 250);
    check_bend(800, 0.94 * 360); /* no more than almost once */
}

static void helices_turn_as_often(void **state)
{
    (void)state;
    lmn_scene *scene = spin_scene((double[]){1, 0, 0}, 3);
    double     turned = 0, last = NAN, radius = NAN;
    tell_at(scene, 2, "[{\"target\": \"plane\", \"depict\": \"tailspin\", \"head\": 0}]");
    const primitive *helix = sign_at(scene, "helix", 0);
    for (uint32_t k = 0; k < helix->vertex_count / 2; k++) {
        double at[3];
        ribbon_point(helix, k, at);
        const double angle = atan2(at[2], at[1] - 1), off = hypot(at[2], at[1] - 1);
        radius = isnan(radius) ? off : radius;
        assert_near(off, radius, 0.01 * radius); /* chords of the sampled way */
        if (!isnan(last))
            turned += remainder(angle - last, 2 * pi);
        last = angle;
    }
    assert_near(fabs(turned), 6 * pi, 1e-3);
    assert_near(radius, sqrt(0.25 + 0.01 + 1) / sqrt(3), 0.01); /* that of the box */
    lmn_scene_destroy(&scene);
}

/* Each arrow is a ribbon of two pairs and a head of three vertices, the last one its tip. */
static void arrows_end_at_the_outline(void **state)
{
    (void)state;
    static const struct {
        const char *depict;
        double      from, to, way, middle;
    } rows[] = {{"expand", 1, 2, 0, 1}, {"collapse", 2, 1, 0, 1}, {"expand", 1, 2, 4, 3}};
    for (size_t r = 0; r < sizeof rows / sizeof *rows; r++) {
        lmn_scene *scene = growth_scene(rows[r].from, rows[r].to, rows[r].way);
        char       text[128];
        snprintf(text, sizeof text, "[{\"target\": \"box\", \"depict\": \"%s\"}]", rows[r].depict);
        tell_at(scene, 1, text);
        const primitive *arrows = sign_at(scene, rows[r].depict, 0);
        assert_int_equal(arrows->vertex_count, 8 * 7);
        for (uint32_t i = 0; i < 8; i++) {
            double tip[3], tail[3], neck[3], a[3], b[3];
            position(arrows, 7 * i + 6, tip);
            ribbon_point(arrows, 0, tail);
            position(arrows, 7 * i, a);
            position(arrows, 7 * i + 1, b);
            vector3_mix(tail, a, b, 0.5);
            const double tail_breadth = vector3_distance(a, b);
            position(arrows, 7 * i + 2, a);
            position(arrows, 7 * i + 3, b);
            vector3_mix(neck, a, b, 0.5);
            assert_true(vector3_distance(a, b) > 3 * tail_breadth);
            const double tip_far = fmax(fabs(tip[0] - rows[r].middle), fabs(tip[1] - 1)),
                         tail_far = fmax(fabs(tail[0] - rows[r].middle), fabs(tail[1] - 1));
            const bool outward = strcmp(rows[r].depict, "expand") == 0;
            assert_near(outward ? tip_far : tail_far, 2, 2e-3); /* the larger outline */
            assert_near(outward ? tail_far : tip_far, 0.35, 2e-3);
        }
        lmn_scene_destroy(&scene);
    }
}

static void check_balloon(lmn_scene *scene, double x, double y, const char *text)
{
    double middle[3], at[3], low[2] = {INFINITY, INFINITY}, high[2] = {-INFINITY, -INFINITY};
    int    tips = 0;
    tell_at(scene, 0, text);
    const primitive *balloon = sign_at(scene, "balloon", 0), *words = sign_at(scene, "words", 0);
    position(balloon, 0, middle);
    for (uint32_t i = 1; i < balloon->vertex_count; i++) {
        position(balloon, i, at);
        if (hypot(at[0] - x, at[1] - y) < 1e-4) {
            tips++;
            continue;
        }
        assert_true(hypot(at[0], at[1] - 2.4) > 0.4 || y < 2.1); /* off the face */
        for (int k = 0; k < 2; k++) {
            low[k] = fmin(low[k], at[k]);
            high[k] = fmax(high[k], at[k]);
        }
    }
    assert_int_equal(tips, 1);
    for (uint32_t i = 0; i < words->vertex_count; i++) {
        position(words, i, at);
        for (int k = 0; k < 2; k++)
            assert_true(at[k] > low[k] && at[k] < high[k]);
        assert_true(at[2] > middle[2]); /* before the balloon */
    }
}

static double words_height(lmn_scene *scene, const char *text)
{
    char   all[160];
    double low = INFINITY, high = -INFINITY, at[3];
    snprintf(all, sizeof all, "[{\"target\": \"somebody\", \"depict\": \"speech\", %s}]", text);
    tell_at(scene, 0, all);
    const primitive *words = sign_at(scene, "words", 0);
    for (uint32_t i = 0; i < words->vertex_count; i++) {
        position(words, i, at);
        low = fmin(low, at[1]);
        high = fmax(high, at[1]);
    }
    return high - low;
}

/* Lines are one and a half sizes apart, which is about a capital in most fonts. */
static void words_stand_in_lines(void **state)
{
    (void)state;
    lmn_scene   *scene = speaker_scene(true, true);
    const double one = words_height(scene, "\"text\": \"H\"");
    assert_near(words_height(scene, "\"text\": \"H|H|H\"") / one, 4, 0.06);
    assert_near(words_height(scene, "\"text\": \"HHH HHH HHH\", \"letters\": 7") / one, 2.5, 0.03);
    assert_near(words_height(scene, "\"text\": \"HHH HHH HHH\", \"letters\": 0") / one, 1, 0.01);
    lmn_scene_destroy(&scene);
}

/* Letters lie before their star, and its two halves before each other, even where the scene reaches behind the eye. */
static void layers_keep_their_order(void **state)
{
    (void)state;
    for (int near = 0; near < 2; near++) {
        lmn_scene    *scene = bounce_scene(0);
        lmn_draw_desc draw = seen_at(1.5);
        draw.orthographic = false;
        draw.eye_given = true;
        vector3_copy(draw.eye, (const double[]){2, 1, near ? 1.2 : 30});
        vector3_copy(draw.target, (const double[]){2, 1, 0});
        vector3_set(draw.up, 0, 1, 0);
        tell_as(scene, &draw, "[{\"target\": \"ball\", \"depict\": \"collision\"}]", NULL);
        double star[3], inner[3], noise[3];
        position(sign_at(scene, "star", 0), 0, star);
        position(sign_at(scene, "star", 1), 0, inner);
        position(sign_at(scene, "noise", 0), 0, noise);
        if (!(inner[2] > star[2] + 1e-4 && noise[2] > inner[2] + 1e-4))
            fail_msg("%s: star %g, inner %g, noise %g", near ? "near" : "far", star[2], inner[2], noise[2]);
        lmn_scene_destroy(&scene);
    }
}

/* Lines are kept with the scene: what is told again sets no letters, and draws the same. */
static void letters_are_set_once(void **state)
{
    (void)state;
    lmn_scene *scene = speaker_scene(true, true), *other = speaker_scene(true, true);
    words_height(scene, "\"text\": \"once|twice|once\"");
    assert_int_equal(scene->letterings.count, 2);
    assert_int_equal(other->letterings.count, 0);
    const lettering_line *line = scene->letterings.lines;
    const uint32_t       *set = line->triangles;
    const double          height = words_height(scene, "\"text\": \"once|twice|once\"");
    assert_ptr_equal(scene->letterings.lines[0].triangles, set);
    assert_int_equal(scene->letterings.count, 2);
    assert_near(words_height(other, "\"text\": \"once|twice|once\""), height, 0);
    words_height(scene, "\"text\": \"Thrice\"");
    assert_int_equal(scene->letterings.count, 3);
    /* Who never writes the same again does not fill the memory. */
    for (int i = 0; i < 40; i++) {
        char text[200] = "\"text\": \"";
        for (int k = 0; k < 20; k++)
            snprintf(text + strlen(text), sizeof text - strlen(text), "%d|", i * 20 + k);
        snprintf(text + strlen(text), sizeof text - strlen(text), ".\"");
        if (i == 0 || i > 37) /* between them lines are put in as they would be */
            words_height(scene, text);
        else
            for (int k = 0; k < 20; k++) {
                lettering_line own = {.text = mem_copy_text("own")};
                assert_true(letterings_add(&scene->letterings, &own) != LETTERING_NONE);
            }
        assert_true(scene->letterings.count <= 800);
    }
    assert_true(scene->letterings.count < 100);
    lmn_scene_destroy(&scene);
    lmn_scene_destroy(&other);
}

static void balloons_end_at_the_mouth(void **state)
{
    (void)state;
    const char *says = "[{\"target\": \"somebody\", \"depict\": \"speech\", \"text\": \"Here I am!\"}]";
    lmn_scene  *scene = speaker_scene(true, true);
    check_balloon(scene, 0.1, 2.25, says);
    /* A longer text has more lines, and a balloon with more room. */
    double before[3], after[3];
    position(sign_at(scene, "balloon", 0), 0, before);
    tell_at(scene, 0, "[{\"target\": \"somebody\", \"depict\": \"speech\", \"text\": \"Here|I|am|again!\"}]");
    position(sign_at(scene, "balloon", 0), 0, after);
    assert_true(after[1] > before[1] + 0.05);
    lmn_scene_destroy(&scene);
    scene = speaker_scene(true, false); /* at the front of the head, below its middle */
    check_balloon(scene, 0, 2.4 - 0.8 * 0.17, says);
    lmn_scene_destroy(&scene);
    scene = speaker_scene(false, false); /* on top */
    check_balloon(scene, 0, 2, says);
    lmn_scene_destroy(&scene);
}

static void look_for_face(face *out, const lmn_scene *scene)
{
    depict_poses  poses = {.count = 0};
    depict_job    job = {.scene = scene, .poses = &poses, .size = 3};
    depict_target t;
    lmn_error     error = {0};
    assert_int_equal(target_open(&t, &job, depict_find_node(scene, "somebody"), &error), LMN_OK);
    const pose *p = NULL;
    double      middle[3];
    way_point(&t.way, t.centre, 0, middle);
    assert_int_equal(depict_pose(&p, &job, 0, &error), LMN_OK);
    assert_int_equal(face_find(out, p, t.node, middle, t.radius, &error), LMN_OK);
    target_release(&t);
    depict_poses_release(&poses);
}

/* Where nodes say so; else at the front of the head, whose middle is at (0, 2.4, 0), 0.4 from there. */
static void eyes_are_found(void **state)
{
    (void)state;
    face       found;
    lmn_scene *scene = speaker_scene(true, false);
    look_for_face(&found, scene);
    assert_false(found.named_eyes);
    for (int i = 0; i < 2; i++) {
        assert_near(found.eyes[i][0], i ? -0.16 : 0.16, 0.01);
        assert_near(found.eyes[i][1], 2.4, 0.01);
        assert_near(found.eyes[i][2], 0.4, 0.01);
    }
    assert_near(found.gaze[2], 1, 1e-9);
    lmn_scene_destroy(&scene);
    moving_scene m;
    moving_scene_begin(&m);
    moving_scene_name(&m, moving_scene_box(&m, 0, 1, 0, (double[]){0.4, 1, 0.2}, grey), "somebody");
    const char  *names[] = {"Head", "RightEye", "LeftEye", "LeftEyebrow"};
    const double places[][3] = {{0, 2.4, 0}, {-0.12, 2.5, 0.35}, {0.12, 2.5, 0.35}, {0.3, 2.6, 0.35}};
    for (int i = 0; i < 4; i++) {
        int joint = moving_scene_joint(&m, places[i][0], places[i][1] - 1, places[i][2]);
        moving_scene_name(&m, joint, names[i]);
        moving_scene_put_in(&m, joint, 0);
    }
    scene = finish(&m, "eyes");
    look_for_face(&found, scene);
    assert_true(found.named_eyes);
    for (int i = 0; i < 2; i++)
        assert_near(vector3_distance(found.eyes[i], places[2 - i]), 0, 1e-6);
    lmn_scene_destroy(&scene);
}

static void thoughts_shrink_towards_the_head(void **state)
{
    (void)state;
    lmn_scene *scene = speaker_scene(true, true);
    tell_at(scene, 0, "[{\"target\": \"somebody\", \"depict\": \"thought\", \"text\": \"Am I?\"}]");
    const primitive *cloud = sign_at(scene, "balloon", 0);
    assert_int_equal(cloud->vertex_count, 241 + 3 * 33); /* the cloud, and three circles */
    double last_size = INFINITY, last_far = INFINITY;
    for (uint32_t k = 0; k < 3; k++) {
        double middle[3], rim[3];
        position(cloud, 241 + 33 * k, middle);
        position(cloud, 242 + 33 * k, rim);
        double size = vector3_distance(middle, rim), far = hypot(middle[0], middle[1] - 2.4);
        assert_true(size < last_size && far < last_far && far - size > 0.4);
        last_size = size;
        last_far = far;
    }
    lmn_scene_destroy(&scene);
}

/* A camera that goes along x and turns from −z to −x; its view is computed anew. */
static void frames_are_what_the_camera_sees(void **state)
{
    (void)state;
    moving_scene m;
    moving_scene_begin(&m);
    moving_scene_name(&m, moving_scene_box(&m, 0, 0, -5, (double[]){1, 1, 1}, red), "box");
    int eye = moving_scene_camera(&m, 0, 0, 0, false, 50);
    moving_scene_keys(&m, eye, "translation", 2, (double[]){0, 2}, (double[]){0, 1, 0, 4, 1, 0});
    turn_keys(&m, eye, (double[]){0, 1, 0}, 90, 2);
    lmn_scene    *scene = finish(&m, "crane");
    lmn_draw_desc draw = seen_at(1);
    draw.width = 800;
    draw.height = 400;
    tell_as(scene, &draw, "[{\"target\": \"eye\", \"depict\": \"camera-path\", \"count\": 3, \"focus\": 2}]", NULL);
    const double high = 2 * tan(25 * pi / 180), wide = 2 * high;
    for (int f = 0; f < 3; f++) {
        const primitive *frame = sign_at(scene, "frame", (size_t)f);
        const double     angle = pi / 4 * f, forward[3] = {-sin(angle), 0, -cos(angle)},
                     right[3] = {cos(angle), 0, -sin(angle)};
        static const double corners[4][2] = {{-1, -1}, {1, -1}, {1, 1}, {-1, 1}};
        for (uint32_t c = 0; c < 4; c++) {
            double at[3], expected[3] = {2.0 * f, 1 + high * corners[c][1], 0};
            vector3_add(expected, expected, 2, forward);
            vector3_add(expected, expected, wide * corners[c][0], right);
            position(frame, c, at);
            assert_near(vector3_distance(at, expected), 0, 1e-4);
        }
    }
    assert_int_equal(count_of(scene, "frame"), 3);
    assert_int_equal(count_of(scene, "rails"), 2); /* past and future */
    double corner[3], rail[3];
    position(sign_at(scene, "frame", 0), 0, corner);
    ribbon_point(sign_at(scene, "rails", 0), 0, rail);
    assert_near(vector3_distance(corner, rail), 0, 1e-4);
    tell_as(scene, &draw, "[{\"target\": \"eye\", \"depict\": \"shot-flow\", \"count\": 4, \"now\": 0}]", NULL);
    assert_int_equal(count_of(scene, "frame"), 4);
    assert_int_equal(count_of(scene, "flow-arrow"), 3);
    lmn_error       error = {0};
    lmn_depict_desc desc = LMN_DEPICT_DESC_INIT;
    desc.expressions = "[{\"target\": \"box\", \"depict\": \"shot-flow\"}]";
    assert_int_equal(lmn_depict(scene, &draw, &desc, NULL, &error), LMN_FORMAT);
    assert_non_null(strstr(error.message, "camera"));
    lmn_scene_destroy(&scene);
}

/* A place of the page in half heights, by a camera given by its own parts. */
static void seen(const double at[3], const double eye[3], double slope, double out[3])
{
    for (int k = 0; k < 2; k++)
        out[k] = (at[k] - eye[k]) / ((eye[2] - at[2]) * slope);
    out[2] = eye[2] - at[2];
}

/* The viewer stands at (0, 0, 20), the other camera at (1, 0.5, 4): each vertex that it sees has one in the panel, at
 * the same place of that; nearer ones stay nearer. Nothing is outside, and the picture is not fitted to it. */
static void insets_are_what_the_camera_sees(void **state)
{
    (void)state;
    const double eye[3] = {0, 0, 20}, other[3] = {1, 0.5, 4}, slope = tan(15 * pi / 180), own = tan(20 * pi / 180);
    moving_scene m;
    moving_scene_begin(&m);
    moving_scene_name(&m, moving_scene_box(&m, 0.8, 0.2, 0, (double[]){0.6, 0.4, 0.5}, red), "box");
    moving_scene_name(&m, moving_scene_box(&m, 0, -1, -4, (double[]){9, 0.1, 6}, grey), "ground");
    int camera = moving_scene_camera(&m, 0, 9, 4, false, 40);
    moving_scene_keys(&m, camera, "translation", 2, (double[]){0, 2}, (double[]){0, 9, 4, 1, 0.5, 4});
    lmn_scene    *scene = finish(&m, "inset");
    lmn_draw_desc draw = LMN_DRAW_DESC_INIT;
    draw.eye_given = true;
    memcpy(draw.eye, eye, sizeof draw.eye);
    draw.fov_deg = 30;
    draw.time_given = true;
    draw.width = 800;
    draw.height = 600;
    tell_as(scene, &draw,
            "[{\"target\": \"eye\", \"depict\": \"inset\", \"now\": 2, \"corner\": \"bottom-left\", \"size\": 0.3, "
            "\"aspect\": 1.25}]",
            NULL);
    const primitive *frame = sign_at(scene, "inset-frame", 0), *box = sign_at(scene, "inset", 0),
                    *ground = sign_at(scene, "inset", 1);
    assert_int_equal(count_of(scene, "inset"), 2);
    double low[3], high[3], at[3];
    position(frame, 0, at);
    seen(at, eye, slope, low);
    position(frame, 2, at);
    seen(at, eye, slope, high);
    assert_near((high[1] - low[1]) / 2, 0.3, 1e-4);
    assert_near((high[0] - low[0]) / (high[1] - low[1]), 1.25, 1e-4);
    assert_true(low[0] < -1 && low[1] < -0.9 && high[1] < 0);
    double depths[8];
    for (int c = 0; c < 8; c++) { /* all corners of the box are seen */
        const double corner[3] = {0.8 + (c & 1 ? 0.6 : -0.6), 0.2 + (c & 2 ? 0.4 : -0.4), c & 4 ? 0.5 : -0.5};
        double       there[3], best = INFINITY;
        seen(corner, other, own, there);
        const double x = low[0] + (there[0] / 1.25 + 1) / 2 * (high[0] - low[0]),
                     y = low[1] + (there[1] + 1) / 2 * (high[1] - low[1]);
        for (uint32_t i = 0; i < box->vertex_count; i++) {
            double page[3];
            position(box, i, at);
            seen(at, eye, slope, page);
            const double off = hypot(page[0] - x, page[1] - y);
            depths[c] = off < best ? page[2] : depths[c];
            best = fmin(best, off);
        }
        assert_near(best, 0, 1e-4);
    }
    for (int c = 0; c < 4; c++)
        assert_true(depths[c] > depths[c + 4] + 0.01);
    for (uint32_t i = 0; i < ground->vertex_count; i++) { /* cut at the frame */
        double page[3];
        position(ground, i, at);
        seen(at, eye, slope, page);
        assert_true(page[0] > low[0] - 1e-4 && page[0] < high[0] + 1e-4 && page[1] > low[1] - 1e-4 &&
                    page[1] < high[1] + 1e-4);
        assert_true(at[2] > 2); /* before all that the scene has */
    }
    assert_true(ground->vertex_count >= 4);
    assert_string_equal(value_of(&scene->nodes[scene->node_count - 1], "overlay"), "true");
    lmn_scene_destroy(&scene);
}

/* In the corner where nothing is. */
static void insets_go_where_room_is(void **state)
{
    (void)state;
    static const double places[][2] = {{-1, 1}, {1, 1}, {-1, -1}, {1, -1}};
    for (int empty = 0; empty < 4; empty++) {
        moving_scene m;
        moving_scene_begin(&m);
        for (int k = 0; k < 4; k++)
            if (k != empty)
                moving_scene_box(&m, 4 * places[k][0], 4 * places[k][1], 0, (double[]){1, 1, 1}, red);
        int camera = moving_scene_camera(&m, 0, 0, 9, false, 40);
        moving_scene_keys(&m, camera, "translation", 2, (double[]){0, 2}, (double[]){0, 0, 9, 1, 0, 9});
        lmn_scene *scene = finish(&m, "room");
        double     at[3];
        tell_at(scene, 1, "[{\"target\": \"eye\", \"depict\": \"inset\"}]");
        position(sign_at(scene, "inset-frame", 0), 0, at);
        const double x = at[0];
        position(sign_at(scene, "inset-frame", 0), 2, at);
        assert_true((x + at[0]) * places[empty][0] > 0);
        assert_true(at[1] * places[empty][1] > 0 || places[empty][1] < 0);
        lmn_scene_destroy(&scene);
    }
}

static void bursts_go_outward(void **state)
{
    (void)state;
    lmn_scene   *scene = crate_scene(ALL_SIDES);
    const double middle[3] = {1, 1, 0};
    double       at[3], a[3], b[3];
    tell_at(scene, 1.2, "[{\"target\": \"crate\", \"depict\": \"explode\"}]");
    position(sign_at(scene, "star", 0), 0, at);
    assert_near(hypot(at[0] - 1, at[1] - 1), 0, 1e-4);
    assert_int_equal(count_of(scene, "noise"), 1);
    const primitive *arrows = sign_at(scene, "burst-arrows", 0);
    uint32_t         each = arrows->vertex_count / 8;
    assert_int_equal(arrows->vertex_count % 8, 0);
    for (uint32_t i = 0; i < 8; i++) {
        position(arrows, i * each, a);
        position(arrows, i * each + each - 1, b);
        assert_true(vector3_distance(b, middle) > vector3_distance(a, middle) + 0.5);
        vector3_add(a, a, -1, middle);
        vector3_add(b, b, -1, middle);
        vector3_normalise(b);
        assert_near(fabs(b[0]), 1 / sqrt(3), 1e-3); /* along its own diagonal */
        assert_near(fabs(b[1]), 1 / sqrt(3), 1e-3);
    }
    tell_at(scene, 1.2, "[{\"target\": \"crate\", \"depict\": \"explode\", \"form\": \"cloud\", \"arrows\": false}]");
    assert_null(sign_at(scene, "star", 0));
    assert_null(sign_at(scene, "burst-arrows", 0));
    assert_int_equal(count_of(scene, "cloud"), 2);
    lmn_scene_destroy(&scene);
}

static void stems_branch_smoothly(void **state)
{
    (void)state;
    lmn_scene *scene = jets_scene(true);
    double     end[3], a[3], b[3], straight[3];
    tell_at(scene, 1, "[{\"target\": \"jets\", \"depict\": \"split-path\", \"now\": 9}]");
    assert_int_equal(count_of(scene, "stem"), 1);
    assert_int_equal(count_of(scene, "branch"), 3);
    const primitive *stem = sign_at(scene, "stem", 0);
    uint32_t         pairs = stem->vertex_count / 2;
    for (uint32_t k = 0; k < pairs; k++) {
        ribbon_point(stem, k, a);
        assert_near(a[1], 0, 1e-4); /* the middle of all */
    }
    ribbon_point(stem, pairs - 1, end);
    assert_true(end[0] > 5 && end[0] < 5.6); /* they part after a second */
    ribbon_point(stem, pairs - 2, a);
    vector3_add(straight, end, -1, a);
    vector3_normalise(straight);
    double tips = 0;
    for (size_t i = 0; i < 3; i++) {
        const primitive *branch = sign_at(scene, "branch", i);
        ribbon_point(branch, 0, a);
        ribbon_point(branch, 1, b);
        assert_near(vector3_distance(a, end), 0, 1e-4);
        vector3_add(b, b, -1, a);
        vector3_normalise(b);
        assert_true(vector3_dot(b, straight) > 0.9985);
        position(branch, branch->vertex_count - 1, b);
        assert_near(b[0], 10, 0.5);
        assert_near(fabs(b[1] - (i == 0 ? -3 : i == 1 ? 0 : 3)), 0, 0.5);
        tips += b[1];
    }
    assert_near(tips, 0, 0.01);
    lmn_scene_destroy(&scene);
}

/* Ribbons that hang together: a solid arrow has one, and its head. */
static size_t ribbons_of(const primitive *p)
{
    size_t   count = 0;
    uint32_t end = 0;
    for (uint32_t i = 0; i + 2 < p->index_count; i += 3) {
        uint32_t low = p->indices[i], high = low;
        for (int k = 1; k < 3; k++) {
            low = p->indices[i + (uint32_t)k] < low ? p->indices[i + (uint32_t)k] : low;
            high = p->indices[i + (uint32_t)k] > high ? p->indices[i + (uint32_t)k] : high;
        }
        count += low >= end;
        end = high + 1 > end ? high + 1 : end;
    }
    return count;
}

static void check_tense(const lmn_scene *s, const char *glyph, const char *when, size_t count, bool dashed)
{
    for (size_t i = 0; i < count; i++) {
        const primitive *p = glyph_at(s, glyph, when, i);
        assert_non_null(p);
        assert_true(dashed ? ribbons_of(p) > 3 : ribbons_of(p) <= 2);
    }
    assert_null(glyph_at(s, glyph, when, count));
}

/* What was is solid, what will be in dashes, wherever now lies: of ways that split, and of shots. */
static void all_ways_are_dashed_from_now_on(void **state)
{
    (void)state;
    static const struct {
        double now;
        size_t past_stems, future_stems, past_branches, future_branches;
    } rows[] = {{0, 0, 1, 0, 3}, {0.5, 1, 1, 0, 3}, {1.5, 1, 0, 3, 3}, {2, 1, 0, 3, 0}};
    lmn_scene *scene = jets_scene(true);
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        tell_at(scene, rows[i].now, "[{\"target\": \"jets\", \"depict\": \"split-path\"}]");
        check_tense(scene, "stem", "past", rows[i].past_stems, false);
        check_tense(scene, "stem", "future", rows[i].future_stems, true);
        check_tense(scene, "branch", "past", rows[i].past_branches, false);
        check_tense(scene, "branch", "future", rows[i].future_branches, true);
    }
    lmn_scene_destroy(&scene);
    scene = load_or_fail(LIMNER_SOURCE_DIR "/examples/scripts/closeup.json");
    tell_at(scene, 0.5, "[{\"target\": \"eye\", \"depict\": \"shot-flow\", \"count\": 3, \"focus\": 2}]");
    check_tense(scene, "flow-arrow", "past", 1, false);
    check_tense(scene, "flow-arrow", "future", 2, true);
    lmn_scene_destroy(&scene);
}

static void causes_are_shown(void **state)
{
    (void)state;
    lmn_scene *scene = kick_scene(true);
    double     tip[3], tail[3], low = INFINITY, high = -INFINITY;
    tell_at(scene, 1.6, "[{\"target\": \"ball\", \"depict\": \"cause\", \"partner\": \"foot\"}]");
    const primitive *arrow = sign_at(scene, "cause-arrow", 0), *ghost = sign_at(scene, "still", 0);
    ribbon_point(arrow, 0, tail);
    position(arrow, arrow->vertex_count - 1, tip);
    assert_near(tail[1], 0, 1e-3);
    assert_near(tip[1], 0, 1e-3);
    /* The foot's face, from half a second before on. */
    assert_near(tail[0], -2.2, 0.05);
    assert_true(fabs(tip[0] + 0.7) < 0.35);
    for (uint32_t i = 0; i < ghost->vertex_count; i++) {
        double at[3];
        position(ghost, i, at);
        low = fmin(low, at[0]);
        high = fmax(high, at[0]);
        assert_true(fabs(at[1]) < 0.32);
    }
    assert_near((low + high) / 2, -1, 0.02); /* where it was when the ball set off */
    lmn_error       error = {0};
    lmn_draw_desc   draw = seen_at(1);
    lmn_depict_desc desc = LMN_DEPICT_DESC_INIT;
    desc.expressions = "[{\"target\": \"ball\", \"depict\": \"cause\"}]";
    assert_int_equal(lmn_depict(scene, &draw, &desc, NULL, &error), LMN_FORMAT);
    assert_non_null(strstr(error.message, "partner"));
    lmn_scene_destroy(&scene);
    scene = kick_scene(false); /* from the surface of what rests to that of what sets off */
    tell_at(scene, 1.6, "[{\"target\": \"ball\", \"depict\": \"cause\", \"partner\": \"foot\"}]");
    arrow = sign_at(scene, "cause-arrow", 0);
    assert_non_null(arrow);
    ribbon_point(arrow, 0, tail);
    position(arrow, arrow->vertex_count - 1, tip);
    assert_near(tail[0], -0.7, 0.01);
    assert_near(tip[0], -0.15, 0.01);
    assert_near(tip[1], 0, 0.01);
    lmn_scene_destroy(&scene);
}

static void streaks_lie_behind(void **state)
{
    (void)state;
    lmn_scene *scene = drive_scene(true);
    tell_at(scene, 1, "[{\"target\": \"car\", \"depict\": \"travelling\", \"count\": 12}]");
    const primitive *streaks = sign_at(scene, "streaks", 0);
    assert_int_equal(streaks->vertex_count, 12 * 4); /* each a tip, a pair, a tip */
    for (uint32_t i = 0; i < 12; i++) {
        double front[3], back[3], a[3], b[3];
        position(streaks, 4 * i, front);
        position(streaks, 4 * i + 1, a);
        position(streaks, 4 * i + 2, b);
        position(streaks, 4 * i + 3, back);
        vector3_mix(a, a, b, 0.5);
        assert_true(front[2] < -0.5 && back[2] < -0.5); /* the car ends there */
        assert_near(front[1], back[1], 1e-4);           /* along its way */
        assert_true(front[0] - a[0] < a[0] - back[0]);  /* and they trail */
    }
    lmn_scene_destroy(&scene);
}

/* --- proposals ---------------------------------------------------------------------------------------------------- */

static void check_proposal(lmn_scene *scene, const char *characteristic, bool wanted, const char *what)
{
    lmn_draw_desc draw = seen_at(1.2);
    char         *json = NULL, quoted[64];
    snprintf(quoted, sizeof quoted, "\"%s\"", characteristic);
    tell_as(scene, &draw, NULL, &json);
    const char *found = strstr(json, quoted);
    if ((found != NULL) != wanted)
        fail_msg("%s: %s is %sproposed", what, characteristic, wanted ? "not " : "");
    lmn_text_free(json);
    lmn_scene_destroy(&scene);
}

static void proposals_tell_patterns_apart(void **state)
{
    (void)state;
    const double along[3] = {1, 0, 0}, across[3] = {0, 0, 1};
    check_proposal(crate_scene(ALL_SIDES), "explode", true, "all sides");
    check_proposal(crate_scene(ONE_SIDE), "explode", false, "one side");
    check_proposal(crate_scene(FAN), "explode", false, "fan");
    check_proposal(jets_scene(true), "explode", false, "jets");
    check_proposal(jets_scene(true), "split-path", true, "jets");
    check_proposal(jets_scene(false), "split-path", false, "jets in formation");
    check_proposal(spin_scene(along, 3), "tailspin", true, "spin");
    check_proposal(spin_scene(across, -3), "tailspin", false, "rolling");
    check_proposal(spin_scene(along, 0.2), "tailspin", false, "leaning");
    check_proposal(spin_scene(along, 3), "turnaround", false, "spin");
    check_proposal(drive_scene(true), "travelling", true, "camera beside");
    check_proposal(drive_scene(false), "travelling", false, "camera against");
    check_proposal(drive_scene(false), "camera-path", true, "camera against");
    check_proposal(bounce_scene(0), "camera-path", false, "no camera");
    check_proposal(bounce_scene(0), "collision", true, "bounce");
    check_proposal(drive_scene(false), "collision", false, "drive");
    check_proposal(lever_scene(0), "collision", true, "lever on a block");
    check_proposal(lever_scene(0), "turnaround", true, "lever on a block");
    check_proposal(lever_scene(0.3), "collision", false, "lever above a block");
    check_proposal(door_scene(true), "collision", true, "door falls to");
    check_proposal(door_scene(true), "turnaround", true, "door falls to");
    check_proposal(door_scene(false), "collision", false, "door opens");
    check_proposal(load_or_fail(LIMNER_SOURCE_DIR "/examples/scripts/door.json"), "collision", false, "door in a wall");
    check_proposal(growth_scene(1, 2, 0), "expand", true, "growing");
    check_proposal(growth_scene(1, 2, 0), "collapse", false, "growing");
    check_proposal(growth_scene(2, 1, 0), "collapse", true, "shrinking");
    check_proposal(growth_scene(1, 1, 4), "expand", false, "as large");
    check_proposal(growth_scene(1, 1, 4), "turnaround", false, "straight on");
}

/* --- all rows ----------------------------------------------------------------------------------------------------- */

/* A row with a scene in which it says something. */
static lmn_scene *scene_for(const char *row, char text[160])
{
    const char *target = "ball", *more = "";
    lmn_scene  *scene = NULL;
    if (strcmp(row, "collision") == 0)
        scene = bounce_scene(0);
    else if (strcmp(row, "cause") == 0) {
        scene = kick_scene(true);
        more = ", \"partner\": \"foot\"";
    } else if (strcmp(row, "turnaround") == 0 || strcmp(row, "tailspin") == 0) {
        scene = spin_scene((double[]){1, 0, 0}, 0.7);
        target = "plane";
    } else if (strcmp(row, "expand") == 0 || strcmp(row, "collapse") == 0) {
        scene = growth_scene(strcmp(row, "expand") == 0 ? 1 : 2, strcmp(row, "expand") == 0 ? 2 : 1, 0);
        target = "box";
    } else if (strcmp(row, "speech") == 0 || strcmp(row, "thought") == 0) {
        scene = speaker_scene(true, true);
        target = "somebody";
        more = ", \"text\": \"Here I am again!\"";
    } else if (strcmp(row, "camera-path") == 0 || strcmp(row, "shot-flow") == 0 || strcmp(row, "inset") == 0) {
        scene = drive_scene(false);
        target = "eye";
    } else if (strcmp(row, "explode") == 0) {
        scene = crate_scene(ALL_SIDES);
        target = "crate";
    } else if (strcmp(row, "split-path") == 0) {
        scene = jets_scene(true);
        target = "jets";
    } else if (strcmp(row, "travelling") == 0) {
        scene = drive_scene(true);
        target = "car";
    }
    snprintf(text, 160, "[{\"target\": \"%s\", \"depict\": \"%s\"%s", target, row, more);
    return scene;
}

static uint64_t signs_hash(const lmn_scene *s)
{
    uint64_t hash = 1469598103934665603u;
    for (size_t i = 0; i < s->part_count; i++) {
        const node *n = &s->nodes[s->parts[i].node];
        if (n->mesh == NONE || !*value_of(n, "glyph"))
            continue;
        const primitive     *p = placed_glyph(s, n);
        const unsigned char *bytes = (const unsigned char *)p->positions,
                            *tint = (const unsigned char *)&s->materials[p->material].base_colour;
        for (size_t k = 0; k < p->vertex_count * sizeof *p->positions; k++)
            hash = (hash ^ bytes[k]) * 1099511628211u;
        for (size_t k = 0; k < sizeof(vec4); k++)
            hash = (hash ^ tint[k]) * 1099511628211u;
    }
    return hash;
}

/* Another value than that of the row. */
static void other_value(const param *p, char *out, size_t size)
{
    double most = p->soft_max != 0 ? p->soft_max : p->max;
    if (p->type == PARAM_BOOL)
        snprintf(out, size, "%s", p->def != 0 ? "false" : "true");
    else if (p->type == PARAM_COLOUR)
        snprintf(out, size, "\"#123456\"");
    else if (p->type == PARAM_TEXT)
        snprintf(out, size, "\"Other\"");
    else if (p->type == PARAM_ENUM)
        snprintf(out, size, "\"%s\"", p->names[1]);
    else if (strcmp(p->key, "letters") == 0)
        snprintf(out, size, "5");
    else if (strcmp(p->key, "width") == 0)
        snprintf(out, size, "0.01"); /* there may be no room for more */
    else if (strcmp(p->key, "at") == 0)
        snprintf(out, size, "0.5");
    else
        snprintf(out, size, p->type == PARAM_INT ? "%.0f" : "%g", p->def == most ? p->min : most);
}

static void every_option_changes_its_signs(void **state)
{
    (void)state;
    size_t rows = 0;
    for (size_t d = 0; depictions[d]; d++) {
        const depiction *row = depictions[d];
        char             text[160], plain[200], set[300], value[64];
        lmn_scene       *scene = scene_for(row->characteristic, text);
        if (!scene)
            continue;
        rows++;
        for (size_t k = 0; k < row->param_count; k++) {
            const bool early = strcmp(row->params[k].key, "all") == 0;
            if (strcmp(row->characteristic, "collision") == 0 && strcmp(row->params[k].key, "count") == 0)
                continue;
            other_value(&row->params[k], value, sizeof value);
            snprintf(plain, sizeof plain, "%s}]", text);
            snprintf(set, sizeof set, "%s, \"%s\": %s}]", text, row->params[k].key, value);
            if (strcmp(row->params[k].key, "text") == 0 && strstr(text, "\"text\""))
                continue; /* it is set in all */
            tell_at(scene, early ? 0.5 : 1.2, plain);
            uint64_t before = signs_hash(scene);
            tell_at(scene, early ? 0.5 : 1.2, set);
            if (signs_hash(scene) == before)
                fail_msg("%s.%s changes nothing", row->characteristic, row->params[k].key);
        }
        lmn_scene_destroy(&scene);
    }
    assert_int_equal(rows, 14);
}

static void missing_memory_is_said_by_all(void **state)
{
    (void)state;
    for (size_t d = 0; depictions[d]; d++) {
        char       text[160], all[200];
        lmn_scene *scene = scene_for(depictions[d]->characteristic, text);
        lmn_status status = LMN_MEMORY;
        if (!scene)
            continue;
        snprintf(all, sizeof all, "%s}]", text);
        tell_at(scene, 1.2, all); /* fonts are found once */
        for (long n = 1; status != LMN_OK && n < 100000; n += 1 + n / 40) {
            lmn_draw_desc   draw = seen_at(1.2);
            lmn_depict_desc desc = LMN_DEPICT_DESC_INIT;
            lmn_error       error = {0};
            desc.expressions = n % 2 ? all : NULL;
            letterings_release(&scene->letterings); /* letters are set anew */
            mem_fail_at(n);
            status = lmn_depict(scene, &draw, &desc, NULL, &error);
            mem_fail_at(0);
            if (status != LMN_OK && status != LMN_MEMORY)
                fail_msg("%s, allocation %ld: %d, %s", all, n, (int)status, error.message);
            if (scene->changes_open)
                assert_int_equal(lmn_scene_end_changes(scene, NULL), LMN_OK);
        }
        assert_int_equal(status, LMN_OK);
        lmn_scene_destroy(&scene);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(stars_are_where_things_meet),
        cmocka_unit_test(stars_find_what_is_hit),
        cmocka_unit_test(stars_are_where_what_turns_hits),
        cmocka_unit_test(stars_are_seen_where_things_meet),
        cmocka_unit_test(bent_arrows_turn_as_things_do),
        cmocka_unit_test(helices_turn_as_often),
        cmocka_unit_test(arrows_end_at_the_outline),
        cmocka_unit_test(balloons_end_at_the_mouth),
        cmocka_unit_test(words_stand_in_lines),
        cmocka_unit_test(layers_keep_their_order),
        cmocka_unit_test(letters_are_set_once),
        cmocka_unit_test(thoughts_shrink_towards_the_head),
        cmocka_unit_test(frames_are_what_the_camera_sees),
        cmocka_unit_test(eyes_are_found),
        cmocka_unit_test(insets_are_what_the_camera_sees),
        cmocka_unit_test(insets_go_where_room_is),
        cmocka_unit_test(bursts_go_outward),
        cmocka_unit_test(stems_branch_smoothly),
        cmocka_unit_test(all_ways_are_dashed_from_now_on),
        cmocka_unit_test(causes_are_shown),
        cmocka_unit_test(streaks_lie_behind),
        cmocka_unit_test(proposals_tell_patterns_apart),
        cmocka_unit_test(every_option_changes_its_signs),
        cmocka_unit_test(missing_memory_is_said_by_all),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
