/* Scenes at times: against a second reading of glTF in double precision, for every animated model of the collection;
 * and what a moment, its clips and the boxes over time are. */
#include "import_support.h"

#include <dirent.h>
#include <math.h>

#include "../support/gltf_truth.h"
#include "pose/animate.h"
#include "scene/channel.h"
#include "pose/pose.h"
#include "pose/posed_mesh.h"

/* --- against the second reading ------------------------------------------------------------------------- */

/* World positions of all corners, in the order of parts; free with free. */
static size_t corners_of(const pose *p, double (**out)[3])
{
    const lmn_scene *s = p->scene;
    size_t           count = 0;
    *out = NULL;
    for (size_t i = 0; i < s->part_count; i++) {
        const mesh *m = &s->meshes[s->nodes[s->parts[i].node].mesh];
        mat4        world = pose_instance(p, i, 0);
        for (size_t k = 0; k < m->primitive_count; k++) {
            posed_mesh posed;
            lmn_error  error = {0};
            assert_int_equal(posed_make(&posed, &m->primitives[k], 0.5, &p->parts[i], &error), LMN_OK);
            *out = realloc(*out, (count + posed.data.index_count) * sizeof **out);
            for (uint32_t c = 0; c < posed.data.index_count; c++, count++) {
                const float *v = &posed.data.positions[3 * (size_t)posed.data.indices[c]];
                for (int r = 0; r < 3; r++)
                    (*out)[count][r] = world.m[r] * (double)v[0] + world.m[4 + r] * (double)v[1] +
                                       world.m[8 + r] * (double)v[2] + world.m[12 + r];
            }
            posed_release(&posed);
        }
    }
    return count;
}

static double diagonal_of(double (*corners)[3], size_t count)
{
    double square = 0;
    for (int k = 0; k < 3; k++) {
        double low = INFINITY, high = -INFINITY;
        for (size_t i = 0; i < count; i++) {
            low = fmin(low, corners[i][k]);
            high = fmax(high, corners[i][k]);
        }
        square += (high - low) * (high - low);
    }
    return sqrt(square);
}

/* The largest distance of corners, as a fraction of the bounds. */
static double difference(const lmn_scene *s, const gltf_truth *t, const moment *when, size_t clip)
{
    pose      p;
    lmn_error error = {0};
    double(*ours)[3], (*theirs)[3], worst = 0;
    assert_int_equal(pose_create(&p, s, when, &error), LMN_OK);
    size_t count = corners_of(&p, &ours), expected = gltf_truth_corners(t, clip, when->seconds, &theirs);
    assert_int_equal(count, expected);
    for (size_t i = 0; i < count; i++) {
        double square = 0;
        for (int k = 0; k < 3; k++)
            square += (ours[i][k] - theirs[i][k]) * (ours[i][k] - theirs[i][k]);
        worst = fmax(worst, sqrt(square));
    }
    worst /= diagonal_of(theirs, count);
    free(ours);
    free(theirs);
    pose_release(&p);
    return worst;
}

static int compare_file(const char *path)
{
    enum { TIMES = 10 };
    gltf_truth *t = gltf_truth_load(path);
    lmn_scene  *s = load_or_fail(path);
    assert_non_null(t);
    int compared = 0;
    assert_int_equal(s->animation_count, gltf_truth_clip_count(t));
    moment at_rest = moment_at_rest();
    assert_true(difference(s, t, &at_rest, SIZE_MAX) <= 1e-5);
    for (size_t clip = 0; clip < s->animation_count; clip++)
        for (int k = 0; k < TIMES; k++, compared++) {
            moment when = moment_at_rest();
            when.clips[when.clip_count++] = (uint32_t)clip;
            when.seconds = gltf_truth_duration(t, clip) * (k + 0.37) / TIMES;
            double off = difference(s, t, &when, clip);
            if (!(off <= 1e-5))
                fail_msg("%s, clip %zu at %g s: off by %g of the bounds", path, clip, when.seconds, off);
        }
    lmn_scene_destroy(&s);
    gltf_truth_destroy(t);
    return compared;
}

static bool ends_with(const char *name, const char *ending)
{
    size_t a = strlen(name), b = strlen(ending);
    return a > b && strcmp(name + a - b, ending) == 0;
}

static int compare_folder(const char *folder)
{
    char path[2048];
    int  compared = 0;
    DIR *d = opendir(folder);
    for (struct dirent *e = d ? readdir(d) : NULL; e; e = readdir(d)) {
        snprintf(path, sizeof path, "%s/%s", folder, e->d_name);
        if (ends_with(e->d_name, ".glb") || ends_with(e->d_name, ".gltf"))
            compared += compare_file(path);
        else if (!strchr(e->d_name, '.'))
            compared += compare_folder(path);
    }
    if (d)
        closedir(d);
    return compared;
}

static void models_are_where_gltf_says(void **state)
{
    (void)state;
    static const char *const own[] = {"box-animated", "fox", "morph-cube"};
    char                     path[2048];
    for (size_t i = 0; i < sizeof own / sizeof *own; i++) {
        snprintf(path, sizeof path, LIMNER_SOURCE_DIR "/examples/%s.glb", own[i]);
        assert_true(compare_file(path) >= 10);
    }
    if (!data_folder())
        skip();
    snprintf(path, sizeof path, "%s/gltf/animated", data_folder());
    int compared = compare_folder(path);
    printf("%d poses\n", compared);
    assert_true(compared >= 10 * 9);
}

/* --- channels by hand ----------------------------------------------------------------------------------- */

static animation_channel channel(animation_path path, interpolation how, float *times, float *values, size_t keys,
                                 size_t components)
{
    return (animation_channel){.path = path,
                               .interpolation = how,
                               .key_count = keys,
                               .components = components,
                               .times = times,
                               .values = values};
}

static void values_between_keys(void **state)
{
    (void)state;
    float             times[] = {1, 3}, values[] = {0, 10, 20, 4, 10, 0};
    animation_channel c = channel(PATH_TRANSLATION, INTERPOLATION_LINEAR, times, values, 2, 3);
    double            out[4];
    animation_channel_at(&c, 1.5, out);
    assert_true(out[0] == 1 && out[1] == 10 && out[2] == 15);
    animation_channel_at(&c, -7, out);
    assert_true(out[0] == 0 && out[2] == 20);
    animation_channel_at(&c, 99, out);
    assert_true(out[0] == 4 && out[2] == 0);
    c.interpolation = INTERPOLATION_STEP;
    animation_channel_at(&c, 2.999, out);
    assert_true(out[0] == 0);
    animation_channel_at(&c, 3, out);
    assert_true(out[0] == 4);
}

/* x = t³ − t over two seconds has slope −1 and 11 at its ends. */
static void cubics_are_hermite(void **state)
{
    (void)state;
    float             times[] = {0, 2}, values[] = {0, 0, -1, 11, 6, 0};
    animation_channel c = channel(PATH_CAMERA_FOV, INTERPOLATION_CUBIC, times, values, 2, 1);
    for (double t = 0; t <= 2; t += 0.25) {
        double out;
        animation_channel_at(&c, t, &out);
        assert_true(fabs(out - (t * t * t - t)) < 1e-12);
    }
}

/* A quarter turn about z and its negative, which is the same turn: no detour. */
static void turns_take_the_short_way(void **state)
{
    (void)state;
    float             half = sqrtf(0.5f), times[] = {0, 1}, values[] = {0, 0, 0, 1, 0, 0, -half, -half};
    double            out[4];
    animation_channel c = channel(PATH_ROTATION, INTERPOLATION_LINEAR, times, values, 2, 4);
    for (double t = 0; t <= 1; t += 0.125) {
        animation_channel_at(&c, t, out);
        double sign = out[3] < 0 ? -1 : 1, angle = 3.14159265358979 / 4 * t;
        assert_true(fabs(sign * out[2] - sin(angle)) < 1e-6 && fabs(sign * out[3] - cos(angle)) < 1e-6);
    }
}

/* --- moments -------------------------------------------------------------------------------------------- */

static lmn_scene *fox(void)
{
    return load_or_fail(LIMNER_SOURCE_DIR "/examples/fox.glb");
}

static void clips_are_found(void **state)
{
    (void)state;
    lmn_scene *s = fox();
    lmn_error  error = {0};
    warnings   warned = {0};
    moment     m;
    assert_int_equal(moment_find(&m, s, NULL, 0.25, &warned, &error), LMN_OK);
    assert_true(m.clip_count == 1 && m.clips[0] == 0 && m.seconds == 0.25 && warned.count == 0);
    assert_int_equal(moment_find(&m, s, "Run,2", 0.5, &warned, &error), LMN_OK);
    assert_true(m.clip_count == 2 && m.clips[0] == 2 && m.clips[1] == 1);
    assert_int_equal(moment_find(&m, s, "3", 99, &warned, &error), LMN_OK);
    assert_true(m.seconds == moment_duration(&m, s) && warned.count == 1);
    assert_int_equal(moment_find(&m, s, "Run", -1, &warned, &error), LMN_OK);
    assert_true(m.seconds == 0 && warned.count == 2);
    assert_int_equal(moment_find(&m, s, "Ran", 0, &warned, &error), LMN_USAGE);
    assert_non_null(strstr(error.hint, "Run"));
    assert_int_equal(moment_find(&m, s, "4", 0, &warned, &error), LMN_USAGE);
    assert_int_equal(moment_find(&m, s, "", 0, &warned, &error), LMN_USAGE);
    warnings_release(&warned);
    lmn_scene_destroy(&s);
    s = load_or_fail(LIMNER_SOURCE_DIR "/examples/box.glb");
    assert_int_equal(moment_find(&m, s, "Run", 0, NULL, &error), LMN_USAGE);
    assert_int_equal(moment_find(&m, s, NULL, 5, NULL, &error), LMN_OK);
    assert_true(m.clip_count == 0 && m.seconds == 0);
    lmn_scene_destroy(&s);
}

/* A second file has clips of its own, and is not left at rest. */
static void each_file_moves(void **state)
{
    (void)state;
    lmn_scene *s = fox();
    lmn_error  error = {0};
    moment     m;
    assert_int_equal(lmn_scene_add_file(s, LIMNER_SOURCE_DIR "/examples/box-animated.glb", NULL, &error), LMN_OK);
    assert_int_equal(moment_find(&m, s, NULL, 0.5, NULL, &error), LMN_OK);
    assert_true(m.clip_count == 2 && m.clips[0] == 0 && m.clips[1] == 3);
    lmn_scene_destroy(&s);
}

/* Motion between two keys that lie close together in a long clip is not missed. */
static void swept_boxes_hold_keys(void **state)
{
    (void)state;
    lmn_scene         *s = load_or_fail(LIMNER_SOURCE_DIR "/examples/box-animated.glb");
    lmn_error          error = {0};
    moment             m;
    box3              *swept;
    animation_channel *c = &s->animations[0].channels[0];
    static float       times[] = {0, 0.001f, 0.002f, 100}, values[] = {0, 0, 0, 500, 0, 0, 0, 0, 0, 0, 0, 0};
    mem_free(c->times);
    mem_free(c->values);
    *c = (animation_channel){.target = s->parts[0].node,
                             .path = PATH_TRANSLATION,
                             .key_count = 4,
                             .components = 3,
                             .times = mem_copy(times, sizeof times),
                             .values = mem_copy(values, sizeof values)};
    s->animations[0].duration = 100;
    assert_int_equal(moment_find(&m, s, NULL, 0, NULL, &error), LMN_OK);
    assert_int_equal(pose_swept_boxes(&swept, s, &m, &error), LMN_OK);
    assert_true(swept[0].max.x > 499);
    mem_free(swept);
    /* Where no camera can look it is an error, as at rest. */
    c->values[3] = 1e25f;
    pose p;
    m.seconds = 0.001;
    assert_int_equal(pose_create(&p, s, &m, &error), LMN_FORMAT);
    assert_non_null(strstr(error.message, "farther than 1e18"));
    pose_release(&p);
    lmn_scene_destroy(&s);
}

static bool holds(box3 outer, box3 inner)
{
    return outer.min.x <= inner.min.x && outer.min.y <= inner.min.y && outer.min.z <= inner.min.z &&
           outer.max.x >= inner.max.x && outer.max.y >= inner.max.y && outer.max.z >= inner.max.z;
}

static void swept_boxes_hold_all_times(void **state)
{
    (void)state;
    lmn_scene *s = fox();
    lmn_error  error = {0};
    moment     m;
    box3      *swept;
    assert_int_equal(moment_find(&m, s, "Run", 0, NULL, &error), LMN_OK);
    assert_int_equal(pose_swept_boxes(&swept, s, &m, &error), LMN_OK);
    for (int k = 0; k <= 12; k++) {
        pose p;
        m.seconds = moment_duration(&m, s) * k / 12;
        assert_int_equal(pose_create(&p, s, &m, &error), LMN_OK);
        assert_true(holds(swept[0], p.part_boxes[0]));
        assert_true(memcmp(&p.part_boxes[0], &s->parts[0].bounds, sizeof(box3)) != 0);
        pose_release(&p);
    }
    mem_free(swept);
    lmn_scene_destroy(&s);
}

static void failing_memory_is_reported(void **state)
{
    (void)state;
    lmn_scene *s = fox();
    lmn_error  error = {0};
    moment     m;
    assert_int_equal(moment_find(&m, s, "Walk", 0.3, NULL, &error), LMN_OK);
    for (long n = 1;; n++) {
        pose p;
        mem_fail_at(n);
        lmn_status status = pose_create(&p, s, &m, &error);
        mem_fail_at(0);
        pose_release(&p);
        if (status == LMN_OK)
            break;
        assert_int_equal(status, LMN_MEMORY);
        assert_true(n < 100);
    }
    lmn_scene_destroy(&s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(models_are_where_gltf_says),
        cmocka_unit_test(values_between_keys),
        cmocka_unit_test(cubics_are_hermite),
        cmocka_unit_test(turns_take_the_short_way),
        cmocka_unit_test(clips_are_found),
        cmocka_unit_test(swept_boxes_hold_all_times),
        cmocka_unit_test(failing_memory_is_reported),
        cmocka_unit_test(each_file_moves),
        cmocka_unit_test(swept_boxes_hold_keys),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
