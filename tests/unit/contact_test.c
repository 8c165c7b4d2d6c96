/* Contacts: when, where and how hard something meets something, against what is known of it, and what that is. */
#include <math.h>

#include <jansson.h>

#include "base/vector3.h"
#include "contact/contact.h"
#include "contact/surface.h"
#include "import_support.h"
#include "info/info.h"

static lmn_scene *scene_of(const char *nodes, const char *behaviour)
{
    static char text[8192];
    snprintf(text, sizeof text, "{\"limner_script\": 1, \"nodes\": [%s], \"behaviour\": %s}", nodes, behaviour);
    return load_or_fail(temp_file("s.json", text, strlen(text)));
}

static int32_t node_called(const lmn_scene *s, const char *name)
{
    for (size_t i = 0; i < s->node_count; i++)
        if (s->nodes[i].name && strcmp(s->nodes[i].name, name) == 0)
            return (int32_t)i;
    fail_msg("no node %s", name);
    return NONE;
}

static contact *contacts_of(const lmn_scene *s, const char *name, double least, size_t *count)
{
    schedule  laid;
    moment    clips;
    contact  *found = NULL;
    lmn_error error = {0};
    assert_int_equal(schedule_of_moment(&laid, &clips, s, NULL, NULL), LMN_OK);
    if (contacts_find(&found, count, &laid, &clips, node_called(s, name), 0, laid.duration, least, &error) != LMN_OK)
        fail_msg("%s", error.message);
    schedule_release(&laid);
    return found;
}

static void expect(const lmn_scene *s, const contact *c, double seconds, const double place[3], const double normal[3],
                   double speed, const char *other)
{
    assert_true(fabs(c->hit.seconds - seconds) < 1e-6);
    assert_true(fabs(c->hit.speed - speed) < 1e-4 * speed);
    for (int k = 0; k < 3; k++) {
        if (fabs(c->hit.place[k] - place[k]) > 1e-4)
            fail_msg("place %d: %g, not %g", k, c->hit.place[k], place[k]);
        assert_true(fabs(c->hit.normal[k] - normal[k]) < 1e-6);
    }
    assert_int_equal(c->other, other ? node_called(s, other) : NONE);
    assert_true(other ? c->distance < 1e-4 : c->distance == 0);
}

static const double UP[] = {0, 1, 0};

static void test_bounces_are_those_of_the_formulas(void **state)
{
    (void)state;
    lmn_scene *s = load_or_fail(LIMNER_SOURCE_DIR "/examples/scripts/balls.json");
    size_t     count;
    contact   *found = contacts_of(s, "green", 1, &count);
    double     speed = sqrt(2 * 9.81 * 3.5), seconds = speed / 9.81;
    assert_true(count >= 5);
    for (size_t i = 0; i < 5; i++) {
        const double place[] = {2 * seconds, 0, 1};
        expect(s, &found[i], seconds, place, UP, 1.7 * speed, "ground");
        speed *= 0.7;
        seconds += 2 * speed / 9.81;
    }
    mem_free(found);
    /* Another one is set off by nobody at 1 s: no contact. */
    found = contacts_of(s, "red", 0.1, &count);
    assert_true(count > 0 && fabs(found[0].hit.seconds - 1 - sqrt(2 * 3.5 / 9.81)) < 1e-6);
    mem_free(found);
    lmn_scene_destroy(&s);
}

#define WALL(name, x, height, y)                                                                                       \
    "{\"name\": \"" name "\", \"box\": {\"size\": [0.2, " height ", 4]}, \"translation\": [" x ", " y ", 0]},"

/* Flies over the first wall, against the second, and back; the third one is never reached. */
static void test_the_second_of_three_walls_is_hit(void **state)
{
    (void)state;
    lmn_scene *s =
        scene_of(WALL("first", "2", "1", "0.5") WALL("second", "4", "4", "2")
                     WALL("third", "6", "4",
                          "2") "{\"name\": \"ball\", \"sphere\": {\"radius\": 0.5}, \"translation\": [0, 2, 0]}",
                 "{\"target\": \"ball\", \"linear\": [[0, 2, 0], [3.4, 2, 0], [1.7, 2, 0]], "
                 "\"times\": [0, 1, 2]}");
    size_t   count;
    contact *found = contacts_of(s, "ball", 0.1, &count);
    assert_int_equal(count, 1);
    expect(s, &found[0], 1, (const double[]){3.9, 2, 0}, (const double[]){-1, 0, 0}, 5.1, "second");
    mem_free(found);
    /* What is hit moves itself: not away, and then away before it is reached. */
    lmn_scene_destroy(&s);
    s = scene_of(
        WALL("wall", "9", "4", "2") "{\"name\": \"ball\", \"sphere\": {\"radius\": 0.5}, \"translation\": [0, 2, 0]}",
        "[{\"target\": \"ball\", \"linear\": [[0, 2, 0], [3.4, 2, 0], [1.7, 2, 0]], \"times\": [0, 1, 2]},"
        "{\"target\": \"wall\", \"linear\": [[6, 2, 0], [2, 2, 0]], \"duration\": 2}]");
    found = contacts_of(s, "ball", 0.1, &count);
    assert_int_equal(count, 1);
    expect(s, &found[0], 1, (const double[]){3.9, 2, 0}, (const double[]){-1, 0, 0}, 5.1, "wall");
    mem_free(found);
    lmn_scene_destroy(&s);
}

static void test_balls_name_each_other(void **state)
{
    (void)state;
    lmn_scene *s =
        scene_of("{\"name\": \"a\", \"sphere\": {\"radius\": 0.5}}, {\"name\": \"b\", \"sphere\": {\"radius\": 1}}",
                 "[{\"target\": \"a\", \"linear\": [[-4, 0, 0], [-0.5, 0, 0], [-2, 0, 0]]"
                 ", \"times\": [0, 1, 2]},"
                 "{\"target\": \"b\", \"linear\": [[4, 0, 0], [1, 0, 0], [2, 0, 0]], \"times\": [0, 1, 2]}]");
    size_t       count;
    contact     *found = contacts_of(s, "a", 0.1, &count);
    const double middle[3] = {0, 0, 0};
    assert_int_equal(count, 1);
    expect(s, &found[0], 1, middle, (const double[]){-1, 0, 0}, 5, "b");
    mem_free(found);
    found = contacts_of(s, "b", 0.1, &count);
    assert_int_equal(count, 1);
    expect(s, &found[0], 1, middle, (const double[]){1, 0, 0}, 4, "a");
    mem_free(found);
    lmn_scene_destroy(&s);
}

/* In mid-air, and by a body that is larger then than it is at rest. */
static void test_bodies_are_as_they_are_then(void **state)
{
    (void)state;
    static const char ball[] = "{\"name\": \"ground\", \"box\": {\"size\": [9, 1, 9]}, \"translation\": [0, -0.5, 0]},"
                               "{\"name\": \"ball\", \"sphere\": {\"radius\": 0.5}}",
                      flight[] =
                          "{\"target\": \"ball\", \"linear\": [[0, 4, 0], [0, 1, 0], [0, 2, 0]], \"times\": [0, 1, 2]}";
    char       both[1024];
    lmn_scene *s = scene_of(ball, flight);
    size_t     count;
    contact   *found = contacts_of(s, "ball", 0.1, &count);
    assert_int_equal(count, 0); /* who turns round in mid-air meets nothing */
    mem_free(found);
    lmn_scene_destroy(&s);
    snprintf(
        both, sizeof both,
        "[%s, {\"target\": \"ball\", \"property\": \"scale\", \"linear\": [[1, 1, 1], [3, 3, 3]], \"duration\": 2}]",
        flight);
    s = scene_of(ball, both);
    found = contacts_of(s, "ball", 0.1, &count);
    assert_int_equal(count, 1);
    expect(s, &found[0], 1, (const double[]){0, 0, 0}, UP, 4, "ground");
    mem_free(found);
    lmn_scene_destroy(&s);
}

#define BALL   "{\"name\": \"ball\", \"sphere\": {\"radius\": 0.5}, \"translation\": [0, 3, 0]}"
#define GROUND "{\"name\": \"ground\", \"box\": {\"size\": [9, 1, 9]}, \"translation\": [0, -0.5, 0]}"
static const char GRAVITY[] = "{\"target\": \"ball\", \"function\": \"bounce\", \"start\": [0, 3, 0], \"floor\": 0.5, "
                              "\"restitution\": 0.8, \"duration\": 2}";

/* As by a floor that nobody has put into the scene. */
static void test_what_falls_and_is_thrown_back_has_met_a_floor(void **state)
{
    (void)state;
    lmn_scene *s = scene_of(BALL, GRAVITY);
    size_t     count;
    contact   *found = contacts_of(s, "ball", 0.1, &count);
    double     speed = sqrt(2 * 9.81 * 2.5), seconds = speed / 9.81;
    assert_int_equal(count, 2);
    expect(s, &found[0], seconds, (const double[]){0, 0, 0}, UP, 1.8 * speed, NULL);
    mem_free(found);
    lmn_scene_destroy(&s);
}

/* The same fall as clips have it: straight from key to key, 30 a second, which makes 60 corners. */
static void test_sampled_falls_meet_the_ground_alone(void **state)
{
    (void)state;
    enum { KEYS = 61 };
    char   keys[KEYS * 32], times[KEYS * 16], behaviour[8192];
    size_t used = 0, told = 0, count;
    double speed = sqrt(2 * 9.81 * 2.5), first = speed / 9.81, second = first + 1.6 * speed / 9.81;
    for (int i = 0; i < KEYS; i++) {
        const double t = i / 30.0, up = 0.8 * speed, since = t - first, again = t - second,
                     height = t < first    ? 3 - 9.81 * t * t / 2
                              : t < second ? 0.5 + up * since - 9.81 * since * since / 2
                                           : 0.5 + 0.8 * up * again - 9.81 * again * again / 2;
        used += (size_t)snprintf(keys + used, sizeof keys - used, "%s[%.4f, %.7f, 0]", i ? ", " : "", 0.5 * t, height);
        told += (size_t)snprintf(times + told, sizeof times - told, "%s%.7f", i ? ", " : "", t);
    }
    snprintf(behaviour, sizeof behaviour, "{\"target\": \"ball\", \"linear\": [%s], \"times\": [%s]}", keys, times);
    lmn_scene *s = scene_of(GROUND ", " BALL, behaviour), *alone = scene_of(BALL, behaviour);
    contact   *found = contacts_of(s, "ball", 0, &count);
    assert_int_equal(count, 2);
    for (size_t i = 0; i < 2; i++) {
        assert_true(fabs(found[i].hit.seconds - (i ? second : first)) < 1.0 / 30);
        assert_int_equal(found[i].other, node_called(s, "ground"));
    }
    mem_free(found);
    found = contacts_of(alone, "ball", 0, &count);
    assert_int_equal(count, 0);
    mem_free(found);
    lmn_scene_destroy(&s);
    lmn_scene_destroy(&alone);
}

/* All contacts of all nodes in each clip of a model. */
static size_t contacts_in_clips(const char *path)
{
    lmn_scene *s = load_or_fail(path);
    size_t     sum = 0;
    for (size_t clip = 0; clip < s->animation_count; clip++) {
        char     number[24];
        schedule laid;
        moment   clips;
        snprintf(number, sizeof number, "%zu", clip + 1);
        assert_int_equal(schedule_of_moment(&laid, &clips, s, number, NULL), LMN_OK);
        for (size_t i = 0; i < s->node_count; i++) {
            contact *found = NULL;
            size_t   count = 0;
            assert_int_equal(contacts_find(&found, &count, &laid, &clips, (int32_t)i, 0, laid.duration, 0, NULL),
                             LMN_OK);
            sum += count;
            mem_free(found);
        }
        schedule_release(&laid);
    }
    lmn_scene_destroy(&s);
    return sum;
}

/* Their curves have thousands of corners, and nothing in them hits anything. */
static void test_clips_that_hit_nothing_have_no_contacts(void **state)
{
    (void)state;
    static const char *const        examples[] = {"fox.glb",        "walker.bvh", "box-animated.glb",
                                                  "morph-cube.glb", "pump.glb",   "buggy.glb"},
                             *const models[] = {"BoxAnimated.glb",     "RiggedSimple.glb",      "InterpolationTest.glb",
                                                "CesiumMilkTruck.glb", "AnimatedMorphCube.glb", "knight/knight.gltf"};
    const char                     *data = data_folder();
    char                            path[1200];
    for (size_t i = 0; i < sizeof examples / sizeof *examples; i++) {
        snprintf(path, sizeof path, LIMNER_SOURCE_DIR "/examples/%s", examples[i]);
        if (contacts_in_clips(path))
            fail_msg("%s has %zu contacts", examples[i], contacts_in_clips(path));
    }
    for (size_t i = 0; data && i < sizeof models / sizeof *models; i++) {
        snprintf(path, sizeof path, "%s/gltf/animated/%s", data, models[i]);
        if (contacts_in_clips(path))
            fail_msg("%s has %zu contacts", models[i], contacts_in_clips(path));
    }
}

/* Limbs lie on each other all the time; what comes to another limb of the same body touches it. */
static void test_limbs_meet_where_they_have_been_apart(void **state)
{
    (void)state;
    static const char nodes[] =
        "{\"name\": \"body\", \"box\": {\"size\": [1, 1, 1]}},"
        "{\"name\": \"arm\", \"parent\": \"body\", \"box\": {\"size\": [3, 0.4, 0.4]}, \"translation\": [1.9, 0, 0]},"
        "{\"name\": \"lid\", \"parent\": \"body\", \"box\": {\"size\": [1, 0.2, 1]}, \"translation\": [0, 2, 0]}";
    lmn_scene *s = scene_of(
        nodes, "[{\"target\": \"body\", \"linear\": [[0, 0, 0], [0, 1, 0], [0.5, 0.5, 0], [0.5, 1.5, 0]], \"times\": "
               "[0, 0.4, 0.7, 1]}, {\"target\": \"lid\", \"linear\": [[0, 2, 0], [0, 0.6, 0], [0, 2, 0]], \"times\": "
               "[0, 0.5, 1]}, {\"target\": \"arm\", \"linear\": [[1.9, 0, 0], [2, 0, 0], [1.9, 0, 0], [2, 0, 0]], "
               "\"times\": [0, 0.3, 0.6, 1]}]");
    size_t   count;
    contact *found = contacts_of(s, "arm", 0, &count);
    assert_int_equal(count, 0);
    mem_free(found);
    found = contacts_of(s, "lid", 0, &count);
    assert_int_equal(count, 1);
    assert_true(fabs(found[0].hit.seconds - 0.5) < 1e-6);
    assert_int_equal(found[0].other, node_called(s, "body"));
    mem_free(found);
    lmn_scene_destroy(&s);
}

/* Doors stop before walls, and thighs swing below a trunk: what comes near, and turns round there, has hit nothing. */
static void test_what_stops_short_hits_nothing(void **state)
{
    (void)state;
    static const char *const scripts[] = {"door", "runner", "turning"};
    for (size_t i = 0; i < sizeof scripts / sizeof *scripts; i++) {
        char path[1200];
        snprintf(path, sizeof path, LIMNER_SOURCE_DIR "/examples/scripts/%s.json", scripts[i]);
        lmn_scene *s = load_or_fail(path);
        for (size_t k = 0; k < s->node_count; k++) {
            size_t   count = 0;
            contact *found = s->nodes[k].name ? contacts_of(s, s->nodes[k].name, 0, &count) : NULL;
            if (count)
                fail_msg("%s: %s has %zu contacts, the first one %g away", scripts[i], s->nodes[k].name, count,
                         found[0].distance);
            mem_free(found);
        }
        lmn_scene_destroy(&s);
    }
}

/* A box that lands flat touches with all of a face. */
static void test_faces_touch_in_their_middle(void **state)
{
    (void)state;
    lmn_scene *s = scene_of("{\"name\": \"ground\", \"box\": {\"size\": [9, 1, 9]}, \"translation\": [0, -0.5, 0]},"
                            "{\"name\": \"crate\", \"box\": {\"size\": [1, 1, 1]}}",
                            "{\"target\": \"crate\", \"function\": \"bounce\", \"start\": [1, 2, 0], \"floor\": 0.5, "
                            "\"restitution\": 0.3, \"duration\": 1}");
    size_t     count;
    contact   *found = contacts_of(s, "crate", 1, &count);
    double     speed = sqrt(2 * 9.81 * 1.5);
    assert_true(count >= 1);
    expect(s, &found[0], speed / 9.81, (const double[]){1, 0, 0}, UP, 1.3 * speed, "ground");
    mem_free(found);
    lmn_scene_destroy(&s);
}

/* A ball of radius 0.5 that comes to a plate turned about z, at its face 1 s after it has begun, straight and as fast
 * as is said, and goes on as is said. */
static lmn_scene *ball_on_slope(double degrees, const double before[3], const double after[3])
{
    const double angle = degrees * acos(-1) / 180, n[3] = {-sin(angle), cos(angle), 0}, c[3] = {0.3, 2, -0.2};
    char         nodes[1024], behaviour[1024];
    snprintf(nodes, sizeof nodes,
             "{\"name\": \"slope\", \"box\": {\"size\": [20, 1, 20]}, \"translation\": [%.17g, %.17g, %.17g], "
             "\"rotation\": [0, 0, %.17g, %.17g]}, {\"name\": \"ball\", \"sphere\": {\"radius\": 0.5}}",
             c[0] - n[0], c[1] - n[1], c[2], sin(angle / 2), cos(angle / 2));
    snprintf(
        behaviour, sizeof behaviour,
        "{\"target\": \"ball\", \"linear\": [[%.17g, %.17g, %.17g], [%.17g, %.17g, %.17g], [%.17g, %.17g, %.17g]], "
        "\"times\": [0, 1, 2]}",
        c[0] - before[0], c[1] - before[1], c[2] - before[2], c[0], c[1], c[2], c[0] + after[0], c[1] + after[1],
        c[2] + after[2]);
    return scene_of(nodes, behaviour);
}

static void expect_on_slope(double degrees, const double before[3], const double after[3])
{
    const double angle = degrees * acos(-1) / 180, n[3] = {-sin(angle), cos(angle), 0};
    double       place[3] = {0.3, 2, -0.2}, change[3];
    size_t       count;
    lmn_scene   *s = ball_on_slope(degrees, before, after);
    contact     *found = contacts_of(s, "ball", 0.1, &count);
    vector3_add(place, place, -0.5, n);
    vector3_add(change, after, -1, before);
    if (count != 1)
        fail_msg("%g degrees: %zu contacts", degrees, count);
    expect(s, &found[0], 1, place, n, vector3_length(change), "slope");
    mem_free(found);
    lmn_scene_destroy(&s);
}

/* The normal is that of what is met, however the velocity changes, and the place that of the sphere. */
static void test_slopes_are_met_where_the_sphere_touches(void **state)
{
    (void)state;
    static const double degrees[] = {0, 5, 10, 17, 25, 37, 45, 60};
    for (size_t i = 0; i < sizeof degrees / sizeof *degrees; i++) {
        const double angle = degrees[i] * acos(-1) / 180, n[3] = {-sin(angle), cos(angle), 0}, down[3] = {0, -3, 0.4};
        double       thrown[3];
        vector3_add(thrown, down, -1.6 * vector3_dot(down, n), n);
        expect_on_slope(degrees[i], down, thrown); /* as by a spring */
        vector3_add(thrown, thrown, -0.7, down);
        vector3_add(thrown, thrown, fmax(0, -vector3_dot(thrown, n)), n);
        expect_on_slope(degrees[i], down, thrown);                       /* much slower along it */
        expect_on_slope(degrees[i], down, (const double[]){0, 0, 0});    /* it stays */
        expect_on_slope(degrees[i], down, (const double[]){-1, 4, 0.5}); /* it is thrown off aslant */
    }
    expect_on_slope(0, (const double[]){3, -3, 0}, (const double[]){0, 0, 0});
    expect_on_slope(0, (const double[]){3, -1, 0}, (const double[]){0, 1, 0});
}

/* What glides on a floor and stops has not met the floor. */
static void test_what_glides_meets_nothing(void **state)
{
    (void)state;
    size_t     count;
    lmn_scene *s = ball_on_slope(0, (const double[]){2, 0, 0.3}, (const double[]){0, 0, 0});
    contact   *found = contacts_of(s, "ball", 0, &count);
    assert_int_equal(count, 0);
    mem_free(found);
    lmn_scene_destroy(&s);
}

/* A crate of 1 on the face of a plate whose triangles meet along its diagonals, below the crate's front corners where
 * it stops; `turn`: of all of it about y, degrees, `sunk`: so deep does it glide in the plate, `wall`: there is
 * something to be met, at its face 0.5 before the crate's middle. */
static void expect_of_glide(double turn, double sunk, bool wall)
{
    const double half = turn * acos(-1) / 360, way[3] = {cos(2 * half), 0, -sin(2 * half)};
    char         nodes[1024], behaviour[512], walls[256] = "", rotation[128];
    size_t       count;
    snprintf(rotation, sizeof rotation, "\"rotation\": [0, %.17g, 0, %.17g]", sin(half), cos(half));
    if (wall)
        snprintf(walls, sizeof walls,
                 "{\"name\": \"wall\", \"box\": {\"size\": [1, 4, 4]}, \"translation\": [%.17g, 1, %.17g], %s},",
                 way[0], way[2], rotation);
    snprintf(nodes, sizeof nodes,
             "%s{\"name\": \"plate\", \"box\": {\"size\": [8, 1, 8]}, \"translation\": [0, -0.5, 0], %s}, "
             "{\"name\": \"crate\", \"box\": {\"size\": [1, 1, 1]}, %s}",
             walls, rotation, rotation);
    snprintf(
        behaviour, sizeof behaviour,
        "{\"target\": \"crate\", \"linear\": [[%.17g, %.17g, %.17g], [0, %.17g, 0], [0, %.17g, 0]], \"times\": [0, 1, "
        "2]}",
        -2 * way[0], 0.5 - sunk, -2 * way[2], 0.5 - sunk, 0.5 - sunk);
    lmn_scene *s = scene_of(nodes, behaviour);
    contact   *found = contacts_of(s, "crate", 0, &count);
    if (count != (wall ? 1 : 0))
        fail_msg("%g degrees, %g deep: %zu contacts", turn, sunk, count);
    if (wall)
        expect(s, &found[0], 1, (const double[]){0.5 * way[0], 0.5 - sunk, 0.5 * way[2]},
               (const double[]){-way[0], 0, -way[2]}, 2, "wall");
    mem_free(found);
    lmn_scene_destroy(&s);
}

/* A face has no edges inside, whatever triangles it is made of. */
static void test_what_glides_along_a_face_meets_no_diagonal(void **state)
{
    (void)state;
    static const double turns[] = {0, 90, 180, 270, 30}, depths[] = {0, 1e-6, -1e-6, 1e-3};
    for (size_t i = 0; i < sizeof turns / sizeof *turns; i++)
        for (size_t k = 0; k < sizeof depths / sizeof *depths; k++) {
            expect_of_glide(turns[i], depths[k], false);
            expect_of_glide(turns[i], depths[k], true);
        }
}

/* A lever about its middle, of which the lower edge of the left end comes to a block; its post carries it all the time.
 */
static void test_what_turns_on_the_spot_hits_with_its_end(void **state)
{
    (void)state;
    const double a = 20 * acos(-1) / 180, place[3] = {-2 * cos(a) + 0.1 * sin(a), 1 - 2 * sin(a) - 0.1 * cos(a), 0};
    for (int i = 0; i < 2; i++) {
        char   nodes[1024];
        size_t count;
        snprintf(nodes, sizeof nodes,
                 "{\"name\": \"block\", \"box\": {\"size\": [1.5, 1, 2]}, \"translation\": [-1.75, %.17g, 0]}, "
                 "{\"name\": \"post\", \"box\": {\"size\": [0.1, 0.9, 0.5]}, \"translation\": [0, 0.45, 0]}, "
                 "{\"name\": \"lever\", \"box\": {\"size\": [4, 0.2, 0.6]}, \"translation\": [0, 1, 0]}",
                 place[1] - 0.5 - 0.2 * i);
        lmn_scene *s = scene_of(nodes, "{\"target\": \"lever\", \"property\": \"rotation\", \"axis\": [0, 0, 1], "
                                       "\"linear\": [0, 20, 0], \"times\": [0, 1, 2]}");
        contact   *found = contacts_of(s, "lever", 0.1, &count);
        assert_int_equal(count, i ? 0 : 1);
        if (count)
            expect(s, &found[0], 1, place, UP, 2 * a * hypot(2, 0.1), "block");
        mem_free(found);
        lmn_scene_destroy(&s);
    }
}

/* A door stops a bit open: the edges of its square knuckle have turned into the wall, which they touch all the time. */
static void test_hinges_are_no_contacts(void **state)
{
    (void)state;
    size_t     count;
    lmn_scene *s = scene_of("{\"name\": \"wall\", \"box\": {\"size\": [2, 3, 0.4]}, \"translation\": [-1.05, 1.5, 0]}, "
                            "{\"name\": \"hinge\", \"translation\": [0, 1.5, 0]}, "
                            "{\"name\": \"leaf\", \"parent\": \"hinge\", \"box\": {\"size\": [2, 3, 0.1]}, "
                            "\"translation\": [1, 0, 0]}, "
                            "{\"name\": \"knuckle\", \"parent\": \"hinge\", \"box\": {\"size\": [0.1, 3, 0.1]}}",
                            "{\"target\": \"hinge\", \"property\": \"rotation\", \"axis\": [0, 1, 0], "
                            "\"linear\": [0, -15, -15], \"times\": [0, 1, 2]}");
    contact   *found = contacts_of(s, "hinge", 0, &count);
    assert_int_equal(count, 0);
    mem_free(found);
    lmn_scene_destroy(&s);
}

/* An edge that is hit off its middle pushes towards the middle of the ball, a corner, too. */
static void test_edges_and_corners_push_along_the_ball(void **state)
{
    (void)state;
    static const double edge[3] = {2, 1, 0};
    for (int i = 0; i < 3; i++) {
        const double off = (19 + 20 * i) * acos(-1) / 180;
        const double n[3] = {-sin(off), cos(off), 0};
        char         behaviour[512];
        double       c[3];
        size_t       count;
        vector3_add(c, edge, 0.5, n);
        snprintf(behaviour, sizeof behaviour,
                 "{\"target\": \"ball\", \"linear\": [[%.17g, %.17g, 0.1], [%.17g, %.17g, 0.1], [%.17g, %.17g, 0.1]], "
                 "\"times\": [0, 1, 2]}",
                 c[0], c[1] + 4, c[0], c[1], c[0], c[1] + 2);
        lmn_scene *s = scene_of("{\"name\": \"table\", \"box\": {\"size\": [2, 1, 2]}, \"translation\": [3, 0.5, 0]}, "
                                "{\"name\": \"ball\", \"sphere\": {\"radius\": 0.5}}",
                                behaviour);
        contact   *found = contacts_of(s, "ball", 0.1, &count);
        assert_int_equal(count, 1);
        expect(s, &found[0], 1, (const double[]){2, 1, 0.1}, n, 6, "table");
        mem_free(found);
        lmn_scene_destroy(&s);
    }
}

/* Boxes turned so that a corner, an edge or a face comes first, on a face, and two edges crossed. */
static void test_boxes_meet_with_what_comes_first(void **state)
{
    (void)state;
    static const struct {
        const char *ground, *turn;
        double      rise, place[3], normal[3];
    } cases[] = {
        {"[0, 0, 0, 1]", "[0, 0, 0.3826834323650898, 0.9238795325112867]", 0.7071067811865476, {0, 0, 0}, {0, 1, 0}},
        {"[0, 0, 0.13052619222005157, 0.9914448613738104]", /* 15 degrees about z, and the box with it */
         "[0, 0, 0.13052619222005157, 0.9914448613738104]",
         0.5176380902050415,
         {0, 0.0, 0},
         {-0.25881904510252074, 0.9659258262890683, 0}},
        {"[0.3826834323650898, 0, 0, 0.9238795325112867]", /* an edge along x below one along z */
         "[0, 0, 0.3826834323650898, 0.9238795325112867]",
         0,
         {0, 0, 0},
         {0, 1, 0}},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        /* A ground of 8, its upper face, or for the last one its edge, through the origin. */
        const bool   edge = i == 2;
        const double down = edge ? 4 * sqrt(2) : 4, rise = edge ? sqrt(0.5) : cases[i].rise;
        char         nodes[1024], behaviour[512];
        const double n[3] = {cases[i].normal[0], cases[i].normal[1], 0};
        snprintf(nodes, sizeof nodes,
                 "{\"name\": \"ground\", \"box\": {\"size\": [8, 8, 8]}, \"rotation\": %s, \"translation\": [%.17g, "
                 "%.17g, 0]}, {\"name\": \"crate\", \"box\": {\"size\": [1, 1, 1]}, \"rotation\": %s}",
                 cases[i].ground, -down * n[0], -down * n[1], cases[i].turn);
        snprintf(behaviour, sizeof behaviour,
                 "{\"target\": \"crate\", \"linear\": [[0.7, %.17g, 0], [0, %.17g, 0], [0, %.17g, 0]], \"times\": "
                 "[0, 1, 2]}",
                 rise + 3, rise, rise + 1);
        lmn_scene *s = scene_of(nodes, behaviour);
        size_t     count;
        contact   *found = contacts_of(s, "crate", 0.1, &count);
        if (count != 1)
            fail_msg("case %zu: %zu contacts", i, count);
        double place[3] = {0, rise, 0};
        vector3_add(place, place, i == 1 ? -0.5 : -rise, n);
        expect(s, &found[0], 1, place, n, sqrt(0.49 + 16), "ground");
        mem_free(found);
        lmn_scene_destroy(&s);
    }
}

/* Along the line between the middles of two balls, of which none has a vertex there; a squashed one has a normal of its
 * own at each place: of x²/a² + y²/b² + z²/a² = 1 it is (x/a², y/b², z/a²). */
static void test_balls_of_all_shapes_are_met_exactly(void **state)
{
    (void)state;
    const double n[3] = {0.36, 0.48, 0.8}, a = 0.5, b = 0.2, slope[3] = {-sin(0.4), cos(0.4), 0};
    char         nodes[1024], behaviour[512];
    size_t       count;
    snprintf(behaviour, sizeof behaviour,
             "{\"target\": \"ball\", \"linear\": [[%.17g, %.17g, 3], [%.17g, %.17g, %.17g], [1, 0.9, 3]], \"times\": "
             "[0, 1, 2]}",
             1.5 * n[0], 1.5 * n[1], 1.5 * n[0], 1.5 * n[1], 1.5 * n[2]);
    lmn_scene *s = scene_of("{\"name\": \"big\", \"sphere\": {\"radius\": 1}}, "
                            "{\"name\": \"ball\", \"sphere\": {\"radius\": 0.5}}",
                            behaviour);
    contact   *found = contacts_of(s, "ball", 0.1, &count);
    assert_int_equal(count, 1);
    expect(s, &found[0], 1, n, n, found[0].hit.speed, "big");
    mem_free(found);
    lmn_scene_destroy(&s);
    /* Where the outward normal is `slope` downwards; the support of the ellipsoid along it. */
    const double reach = sqrt(a * a * slope[0] * slope[0] + b * b * slope[1] * slope[1]),
                 place[3] = {-a * a * slope[0] / reach, -b * b * slope[1] / reach, 0};
    snprintf(
        nodes, sizeof nodes,
        "{\"name\": \"slope\", \"box\": {\"size\": [20, 1, 20]}, \"translation\": [%.17g, %.17g, 0], \"rotation\": "
        "[0, 0, %.17g, %.17g]}, {\"name\": \"ball\", \"sphere\": {\"radius\": 1}, \"scale\": [%.17g, %.17g, %.17g]}",
        -(reach + 0.5) * slope[0], -(reach + 0.5) * slope[1], sin(0.2), cos(0.2), a, b, a);
    s = scene_of(nodes, "{\"target\": \"ball\", \"linear\": [[0, 3, 0], [0, 0, 0], [0, 1, 0]], \"times\": [0, 1, 2]}");
    found = contacts_of(s, "ball", 0.1, &count);
    assert_int_equal(count, 1);
    expect(s, &found[0], 1, place, slope, 4, "slope");
    mem_free(found);
    lmn_scene_destroy(&s);
}

/* A floor that is not in the scene is touched with the sphere, too: here down is aslant. */
static void test_floors_that_are_not_there_touch_the_sphere(void **state)
{
    (void)state;
    size_t       count;
    lmn_scene   *s = scene_of("{\"name\": \"ball\", \"sphere\": {\"radius\": 0.5}}",
                              "{\"target\": \"ball\", \"function\": \"bounce\", \"start\": [-1.2, 1.6, 0], \"gravity\": "
                                "[6, -8, 0], \"floor\": 0.5, \"restitution\": 0.8, \"duration\": 1}");
    contact     *found = contacts_of(s, "ball", 0.1, &count);
    const double seconds = sqrt(2 * 1.5 / 10);
    assert_int_equal(count, 1);
    expect(s, &found[0], seconds, (const double[]){0, 0, 0}, (const double[]){-0.6, 0.8, 0}, 1.8 * 10 * seconds, NULL);
    mem_free(found);
    lmn_scene_destroy(&s);
}

static void test_the_document_is_whole_or_none(void **state)
{
    (void)state;
    lmn_scene *s = scene_of(
        WALL("wall", "4", "4", "2") "{\"name\": \"ball\", \"sphere\": {\"radius\": 0.5}, \"translation\": [0, 2, 0]}",
        "{\"target\": \"ball\", \"linear\": [[0, 2, 0], [3.4, 2, 0], [1.7, 2, 0]], "
        "\"times\": [0, 1, 2]}");
    char *whole = scene_dynamics_json(s), *again = NULL;
    assert_non_null(whole);
    json_t *root = json_loads(whole, 0, NULL), *node, *hit;
    size_t  i, k, hits = 0;
    json_array_foreach(json_object_get(root, "nodes"), i, node)
    {
        json_array_foreach(json_object_get(node, "contacts"), k, hit)
        {
            assert_string_equal(json_string_value(json_object_get(hit, "other")), "wall");
            assert_int_equal(json_integer_value(json_object_get(hit, "other_node")), node_called(s, "wall") + 1);
            hits++;
        }
    }
    assert_int_equal(hits, 1);
    json_decref(root);
    for (long n = 1; !again; n++) {
        assert_true(n < 10000);
        mem_fail_at(n);
        again = scene_dynamics_json(s);
        mem_fail_at(0);
    }
    assert_string_equal(again, whole);
    mem_free(again);
    mem_free(whole);
    lmn_scene_destroy(&s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_bounces_are_those_of_the_formulas),
        cmocka_unit_test(test_the_second_of_three_walls_is_hit),
        cmocka_unit_test(test_balls_name_each_other),
        cmocka_unit_test(test_bodies_are_as_they_are_then),
        cmocka_unit_test(test_faces_touch_in_their_middle),
        cmocka_unit_test(test_what_stops_short_hits_nothing),
        cmocka_unit_test(test_what_falls_and_is_thrown_back_has_met_a_floor),
        cmocka_unit_test(test_sampled_falls_meet_the_ground_alone),
        cmocka_unit_test(test_clips_that_hit_nothing_have_no_contacts),
        cmocka_unit_test(test_limbs_meet_where_they_have_been_apart),
        cmocka_unit_test(test_slopes_are_met_where_the_sphere_touches),
        cmocka_unit_test(test_balls_of_all_shapes_are_met_exactly),
        cmocka_unit_test(test_floors_that_are_not_there_touch_the_sphere),
        cmocka_unit_test(test_what_glides_meets_nothing),
        cmocka_unit_test(test_what_glides_along_a_face_meets_no_diagonal),
        cmocka_unit_test(test_what_turns_on_the_spot_hits_with_its_end),
        cmocka_unit_test(test_hinges_are_no_contacts),
        cmocka_unit_test(test_edges_and_corners_push_along_the_ball),
        cmocka_unit_test(test_boxes_meet_with_what_comes_first),
        cmocka_unit_test(test_the_document_is_whole_or_none),
    };
    return cmocka_run_group_tests(tests, NULL, remove_temp_folder);
}
