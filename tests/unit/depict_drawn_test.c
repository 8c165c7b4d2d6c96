/* How stills are drawn: what signs and ghost images do to the lines of a picture. */
#include "depict_support.h"

#include "pose/pose.h"
#include "scene/content.h"
#include "stroke/stroke.h"

/* Along how many pieces of line surfaces run through each other now. */
static size_t crossings_of(const lmn_scene *s, double seconds)
{
    moment       when;
    pose         p;
    stroke_scene strokes;
    lmn_error    error = {0};
    assert_int_equal(moment_find(&when, s, NULL, seconds, NULL, &error), LMN_OK);
    assert_int_equal(pose_create(&p, s, &when, &error), LMN_OK);
    bool *shown = calloc(s->part_count + 1, sizeof *shown);
    for (size_t i = 0; i < s->part_count; i++)
        shown[i] = !scene_is_hidden(s, s->parts[i].node);
    assert_int_equal(stroke_scene_create(&strokes, &p, shown, 0.7, NULL, NULL, &error), LMN_OK);
    assert_int_equal(stroke_scene_cross(&strokes, NULL, 0, NULL, NULL, &error), LMN_OK);
    const size_t count = stroke_scene_crossing_count(&strokes);
    stroke_scene_release(&strokes);
    pose_release(&p);
    free(shown);
    return count;
}

/* A bar through a block: both go on by less than their size, so that images of them overlap. */
static const char PIERCED[] =
    "{\"limner_script\": 1, \"nodes\": [{\"name\": \"both\"},"
    "{\"name\": \"block\", \"parent\": \"both\", \"box\": {\"size\": [2, 2, 2]}},"
    "{\"name\": \"bar\", \"parent\": \"both\", \"box\": {\"size\": [5, 0.5, 0.5]}, \"rotation\": {\"axis\": [0, 1, 1], "
    "\"angle\": 20}}],"
    "\"behaviour\": {\"target\": \"both\", \"linear\": [[0, 0, 0], [1.3, 0.7, 0.9]], \"duration\": 2}}";

/* Bodies run through each other, images of them at one time do as they did; images of other times, and arrows, run
 * through nothing. */
static void nothing_runs_through_other_times(void **state)
{
    (void)state;
    lmn_scene   *s = load_or_fail(temp_file("pierced.json", PIERCED, strlen(PIERCED)));
    const size_t alone = crossings_of(s, 1);
    assert_true(alone > 0);
    tell_at(s, 1,
            "[{\"target\": \"both\", \"depict\": \"still\", \"count\": 3}, {\"target\": \"both\", \"depict\": "
            "\"path\"}]");
    assert_int_equal(count_of(s, "still"), 6);
    assert_true(count_of(s, "arrow") > 0);
    assert_int_equal(crossings_of(s, 1), 3 * alone);
    lmn_scene_destroy(&s);
}

static size_t images_of(const lmn_scene *s, const char *when, size_t *triangles)
{
    size_t count = 0;
    for (const primitive *p; (p = glyph_at(s, "still", when, count)) != NULL; count++)
        *triangles = p->index_count / 3;
    return count;
}

/* A pendulum is told with all of it, though what lies at its hinge has gone less far than its tip. */
static void what_keeps_its_form_is_not_torn(void **state)
{
    (void)state;
    static const char text[] =
        "{\"limner_script\": 1, \"nodes\": [{\"name\": \"hinge\"}, {\"name\": \"bar\", \"parent\": \"hinge\", "
        "\"box\": {\"size\": [4, 0.3, 0.3]}, \"translation\": [2, 0, 0]}, {\"name\": \"stub\", \"parent\": \"hinge\", "
        "\"box\": {\"size\": [0.5, 0.5, 0.5]}}], \"behaviour\": {\"target\": \"hinge\", \"property\": "
        "\"rotation\", \"axis\": [0, 0, 1], \"linear\": [0, 120], \"duration\": 2}}";
    lmn_scene *s = load_or_fail(temp_file("pendulum.json", text, strlen(text)));
    tell_at(s, 1, "[{\"target\": \"hinge\", \"depict\": \"still\", \"count\": 3, \"least\": 0.6}]");
    size_t triangles = 0;
    assert_int_equal(images_of(s, "past", &triangles), 1); /* the stub stays */
    assert_int_equal(triangles, 12);
    tell_at(s, 1, "[{\"target\": \"hinge\", \"depict\": \"still\", \"count\": 3}]");
    assert_int_equal(images_of(s, "past", &triangles), 2);
    lmn_scene_destroy(&s);
}

/* Where the vertices of the only part are at a time. */
static vec3 *placed_at(const lmn_scene *s, double seconds)
{
    const primitive *from = &s->meshes[s->nodes[s->parts[0].node].mesh].primitives[0];
    moment           when;
    pose             p;
    vec3            *out = calloc(from->vertex_count, sizeof *out);
    assert_int_equal(moment_find(&when, s, NULL, seconds, NULL, NULL), LMN_OK);
    assert_int_equal(pose_create(&p, s, &when, NULL), LMN_OK);
    const mat4 world = pose_instance(&p, 0, 0);
    pose_vertices(&p.parts[0], from, NULL, NULL, from->vertex_count, out, NULL);
    for (uint32_t i = 0; i < from->vertex_count; i++)
        out[i] = mat4_transform_point(&world, out[i]);
    pose_release(&p);
    return out;
}

/* Of what bends those triangles are told that follow a joint which leads something far enough, and none of others. */
static void skins_are_parted_at_their_joints(void **state)
{
    (void)state;
    lmn_scene       *s = load_or_fail(LIMNER_SOURCE_DIR "/examples/fox.glb");
    const primitive *from = &s->meshes[s->nodes[s->parts[0].node].mesh].primitives[0];
    const double     now = 1.2, least = 0.5;
    vec3            *then = placed_at(s, 0), *here = placed_at(s, now);
    double           gone[256] = {0}, farthest = 0;
    size_t           told = 0, follows = 0;
    uint8_t         *leads = calloc(from->vertex_count, 1);
    double          *away = calloc(from->vertex_count, sizeof *away);
    for (uint32_t v = 0; v < from->vertex_count; v++) {
        float most = -1;
        for (uint32_t k = 0; k < from->influences; k++)
            if (from->weights[v * from->influences + k] > most) {
                most = from->weights[v * from->influences + k];
                leads[v] = (uint8_t)from->joints[v * from->influences + k];
            }
        away[v] = fmax(fmax(fabs((double)then[v].x - (double)here[v].x), fabs((double)then[v].y - (double)here[v].y)),
                       fabs((double)then[v].z - (double)here[v].z));
        gone[leads[v]] = fmax(gone[leads[v]], away[v]);
        farthest = fmax(farthest, away[v]);
    }
    for (uint32_t i = 0; i + 2 < from->index_count; i += 3) {
        bool any = false, far = false;
        for (uint32_t k = i; k < i + 3; k++) {
            any = any || (gone[leads[from->indices[k]]] >= least * farthest && away[from->indices[k]] > 0);
            far = far || away[from->indices[k]] >= least * farthest;
        }
        follows += any;
        told += far;
    }
    tell_at(s, now, "[{\"target\": \"fox\", \"depict\": \"still\", \"count\": 2, \"from\": 0, \"least\": 0.5}]");
    const primitive *image = glyph_at(s, "still", "past", 0);
    assert_non_null(image);
    /* What has hardly moved of it is left out; what has gone far on its own is always there. */
    if (image->index_count / 3 > follows || image->index_count / 3 <= told + (follows - told) / 2)
        fail_msg("%u triangles are told; %zu follow what goes far, %zu go far themselves", image->index_count / 3,
                 follows, told);
    assert_true(follows < from->index_count / 6);
    free(then);
    free(here);
    free(leads);
    free(away);
    lmn_scene_destroy(&s);
}

/* A flat wing of 2 across goes along z, 10 a second, and rises by t³/2: it is pushed up by 3 t, across its way by less.
 */
static lmn_scene *glider_scene(const char *semantics)
{
    static char text[16384];
    size_t      used = (size_t)snprintf(text, sizeof text,
                                        "{\"limner_script\": 1, \"nodes\": [{\"name\": \"glider\", \"semantics\": \"%s\", "
                                             "\"box\": {\"size\": [2, 0.04, 0.6]}}], \"behaviour\": {\"target\": \"glider\", "
                                             "\"duration\": 2, \"linear\": [",
                                        semantics);
    for (int i = 0; i <= 240; i++)
        used += (size_t)snprintf(text + used, sizeof text - used, "%s[0, %.9g, %.9g]", i ? ", " : "",
                                 pow(i / 120.0, 3) / 2, i / 12.0);
    used += (size_t)snprintf(text + used, sizeof text - used, "]}}");
    return load_or_fail(temp_file("glider.json", text, used));
}

/* Across the way at a time. */
static void push_at(double t, double out[3])
{
    double way[3] = {0, 1.5 * t * t, 10};
    vector3_normalise(way);
    vector3_set(out, 0, 3 * t, 0);
    vector3_add(out, out, -vector3_dot(out, way), way);
}

/* How far the wings' tips lie above the middle. */
static double tips_above(const primitive *p, double t)
{
    double sum = 0;
    int    count = 0;
    assert_non_null(p);
    for (uint32_t i = 0; i < p->vertex_count; i++)
        if (fabs((double)p->positions[i].x) > 0.9) {
            sum += (double)p->positions[i].y - pow(t, 3) / 2;
            count++;
        }
    assert_true(count > 0);
    return sum / count;
}

/* Wings lag behind, by what pushes the plane; of what is no paper plane nothing bends, and nobody may ask for it. */
static void wings_bend_as_they_are_pushed(void **state)
{
    (void)state;
    const double half[3] = {1, 0.02, 0.3}, radius = vector3_length(half) / sqrt(3), bend = 0.5;
    double       most[3], push[3];
    lmn_scene   *plane = glider_scene("paper-plane"), *other = glider_scene("ball");
    push_at(2, most);
    push_at(1, push);
    tell_at(plane, 1, "[{\"target\": \"glider\", \"depict\": \"still\", \"count\": 3, \"bend\": 0.5}]");
    const double first = tips_above(glyph_at(plane, "still", "past", 0), 0),
                 second = tips_above(glyph_at(plane, "still", "present", 0), 1),
                 expected = -bend / radius * push[1] / vector3_length(most);
    assert_near(first, 0, 0.04); /* told a fifteenth of a second behind the beginning */
    assert_near(second / expected, 1, 0.15);
    assert_true(tips_above(glyph_at(plane, "still", "future", 0), 2) < 1.4 * second);
    tell_at(other, 1, "[{\"target\": \"glider\", \"depict\": \"still\", \"count\": 3}]");
    assert_near(tips_above(glyph_at(other, "still", "present", 0), 1), 0, 1e-4);
    lmn_error       error = {0};
    lmn_draw_desc   draw = seen_at(1);
    lmn_depict_desc desc = LMN_DEPICT_DESC_INIT;
    desc.expressions = "[{\"target\": \"glider\", \"depict\": \"still\", \"bend\": 0.5}]";
    assert_int_equal(lmn_depict(other, &draw, &desc, NULL, &error), LMN_FORMAT);
    assert_non_null(strstr(error.message, "bend"));
    lmn_scene_destroy(&plane);
    lmn_scene_destroy(&other);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(nothing_runs_through_other_times),
        cmocka_unit_test(what_keeps_its_form_is_not_torn),
        cmocka_unit_test(skins_are_parted_at_their_joints),
        cmocka_unit_test(wings_bend_as_they_are_pushed),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
