/* Pictures of scenes at times. A posed scene is drawn as if it had been modelled so; what is tied to the model goes
 * with it, also where joints move it; and a picture does not hang on what was drawn before. */
#include "checked.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "pose/animate.h"
#include "pose/pose.h"
#include "scene/mesh.h"

enum { SIDE = 160 };

typedef struct picture {
    uint8_t pixels[SIDE * SIDE * 4];
} picture;

static lmn_scene *load(const char *name)
{
    char       path[512];
    lmn_scene *s = NULL;
    snprintf(path, sizeof path, EXAMPLES "/%s.glb", name);
    DO(lmn_scene_create(&s, &error));
    DO(lmn_scene_add_file(s, path, NULL, &error));
    return s;
}

static void draw(picture *out, lmn_renderer *renderer, const lmn_scene *s, const char *look_name,
                 const char *const (*settings)[2], const lmn_draw_desc *wanted)
{
    lmn_draw_desc desc = *wanted;
    lmn_drawing  *drawing = NULL;
    lmn_look     *look = NULL;
    DO(lmn_look_load(&look, look_name, &error));
    for (size_t i = 0; settings && settings[i][0]; i++)
        DO(lmn_look_set(look, settings[i][0], settings[i][1], &error));
    desc.width = desc.height = SIDE;
    desc.dpi = 96;
    DO(lmn_draw(&drawing, renderer, s, look, &desc, &error));
    memcpy(out->pixels, lmn_drawing_pixels(drawing, NULL, NULL), sizeof out->pixels);
    lmn_drawing_destroy(&drawing);
    lmn_look_destroy(&look);
}

/* Pixels that differ by more than this much in a channel. */
static int difference(const picture *a, const picture *b, int tolerance)
{
    int count = 0;
    for (int i = 0; i < SIDE * SIDE; i++) {
        int most = 0;
        for (int k = 0; k < 4; k++) {
            int off = abs(a->pixels[4 * i + k] - b->pixels[4 * i + k]);
            most = off > most ? off : most;
        }
        count += most > tolerance;
    }
    return count;
}

static int covered(const picture *p)
{
    int count = 0;
    for (int i = 0; i < SIDE * SIDE; i++)
        count += memcmp(&p->pixels[4 * i], p->pixels, 4) != 0;
    return count;
}

static int set_up(void **state)
{
    lmn_renderer_desc desc = LMN_RENDERER_DESC_INIT;
    return lmn_renderer_create((lmn_renderer **)state, &desc, &error) != LMN_OK;
}

static int tear_down(void **state)
{
    lmn_renderer_destroy((lmn_renderer **)state);
    return 0;
}

/* Films of a sketch: strokes of a hand are drawn anew with each step of what boils, and stand still in between. */
static void films_of_a_sketch_boil(void **state)
{
    /* Next to nothing is displaced in the picture: what moves is the hand. */
    static const char *const boiling[][2] = {{"perturb.amount", "0.05"}, {"perturb.boil", "12"}, {NULL, NULL}};
    static const char *const still[][2] = {{"perturb.amount", "0.05"}, {NULL, NULL}};
    static const double      times[] = {0, 0.02, 0.07, 0.1};
    lmn_scene               *s = load("box");
    picture                  boils[4], stands[2];
    for (size_t i = 0; i < 4; i++) {
        lmn_draw_desc desc = LMN_DRAW_DESC_INIT;
        desc.time_s = times[i];
        draw(&boils[i], *state, s, "redraw", boiling, &desc);
        desc.lenient = true;
        if (i % 3 == 0)
            draw(&stands[i / 3], *state, s, "redraw", still, &desc);
    }
    int inked = covered(&boils[0]);
    assert_true(inked > 500);
    assert_int_equal(difference(&boils[0], &boils[1], 0), 0);
    assert_int_equal(difference(&boils[1], &boils[2], 0), 0);
    assert_true(difference(&boils[2], &boils[3], 32) > inked / 5);
    assert_int_equal(difference(&stands[0], &stands[1], 0), 0);
    assert_int_equal(difference(&stands[0], &boils[0], 0), 0);
    lmn_scene_destroy(&s);
}

/* --- as if it had been modelled so ---------------------------------------------------------------------- */

/* Writes vertices where joints and morphs put them, and takes these away. Nodes above skinned ones must be at the
 * origin. */
static void bake_mesh(lmn_scene *s, const pose *p, size_t part_index)
{
    node            *n = &s->nodes[s->parts[part_index].node];
    mesh            *m = &s->meshes[n->mesh];
    const part_pose *pose = &p->parts[part_index];
    for (size_t k = 0; k < m->primitive_count; k++) {
        primitive *q = &m->primitives[k];
        vec3      *positions = malloc(q->vertex_count * sizeof *positions),
             *normals = malloc(q->vertex_count * sizeof *normals);
        mesh_pose(q, pose->weights, pose->weight_count, pose->joints, pose->joint_count, q->normals, NULL,
                  q->vertex_count, positions, normals);
        memcpy(q->positions, positions, q->vertex_count * sizeof *positions);
        if (q->normals)
            memcpy(q->normals, normals, q->vertex_count * sizeof *normals);
        q->bounds = box3_empty();
        for (uint32_t i = 0; i < q->vertex_count; i++)
            q->bounds = box3_with_point(q->bounds, positions[i]);
        for (size_t i = 0; i < q->morph_count; i++) {
            mem_free(q->morphs[i].positions);
            mem_free(q->morphs[i].normals);
            q->morphs[i] = (morph_target){NULL, NULL};
        }
        q->morph_count = 0;
        free(positions);
        free(normals);
    }
    if (n->skin != NONE) {
        n->skin = NONE;
        const mat4 identity = mat4_identity();
        assert_true(node_set_matrix(n, &identity));
    }
}

/* The scene as it is at a moment, without anything that moves. */
static lmn_scene *bake(const char *name, const moment *when)
{
    lmn_scene     *s = load(name);
    pose           p;
    animated_state moved;
    DO(pose_create(&p, s, when, &error));
    DO(animate(&moved, s, when, &error));
    for (size_t i = 0; i < s->node_count; i++)
        assert_true(node_set_matrix(&s->nodes[i], &moved.locals[i]));
    for (size_t i = 0; i < s->part_count; i++) {
        s->parts[i].bounds = p.part_boxes[i];
        bake_mesh(s, &p, i);
    }
    pose_release(&p);
    animated_state_release(&moved);
    s->revision = scene_next_revision();
    return s;
}

static void poses_are_drawn_as_models(void **state)
{
    static const struct {
        const char *name, *clip;
        double      seconds;
    } models[] = {{"fox", "Run", 0.31}, {"box-animated", NULL, 1.9}, {"morph-cube", NULL, 0.7}};
    static const char *const looks[] = {"edges", "toon", "technical", "xray", "comic", "line"};
    for (size_t m = 0; m < sizeof models / sizeof *models; m++) {
        lmn_scene *s = load(models[m].name);
        moment     when;
        DO(moment_find(&when, s, models[m].clip, models[m].seconds, NULL, &error));
        lmn_scene *model = bake(models[m].name, &when);
        for (size_t l = 0; l < sizeof looks / sizeof *looks; l++) {
            picture       moving, still, rest;
            lmn_draw_desc desc = LMN_DRAW_DESC_INIT, at = desc;
            at.clip = models[m].clip;
            at.time_given = true;
            at.time_s = models[m].seconds;
            draw(&moving, *state, s, looks[l], NULL, &at);
            draw(&still, *state, model, looks[l], NULL, &desc);
            draw(&rest, *state, s, looks[l], NULL, &desc);
            int off = difference(&moving, &still, 8), ink = covered(&still);
            if (off > ink / 100 || ink < SIDE || difference(&moving, &rest, 8) < ink / 20)
                fail_msg("%s, %s: %d pixels differ from the model, %d of %d from rest", models[m].name, looks[l], off,
                         difference(&moving, &rest, 8), ink);
        }
        lmn_scene_destroy(&s);
        lmn_scene_destroy(&model);
    }
}

/* --- what is tied to the model -------------------------------------------------------------------------- */

/* A quarter turn about the y axis, and then on by `shift`. Multiples of powers of two, so that rounding does not turn
 * pixels over. */
static const double shift[3] = {64, -32, 48};

static void turned(const double p[3], double out[3])
{
    out[0] = p[2] + shift[0];
    out[1] = p[1] + shift[1];
    out[2] = -p[0] + shift[2];
}

static void set_channel(animation_channel *c, int32_t target, animation_path path, const double *values, size_t count)
{
    *c = (animation_channel){.target = target,
                             .path = path,
                             .interpolation = INTERPOLATION_STEP,
                             .key_count = 1,
                             .components = count,
                             .times = mem_calloc(1, sizeof(float)),
                             .values = mem_calloc(count, sizeof(float))};
    for (size_t i = 0; i < count; i++)
        c->values[i] = (float)values[i];
}

/* A clip that does nothing but turn and shift everything that hangs on a skin's joints; nodes above them are at the
 * origin. */
static void add_move(lmn_scene *s)
{
    animation  *a = scene_append_animation(s);
    const skin *k = &s->skins[0];
    assert_non_null(a);
    a->channels = mem_calloc(2 * k->joint_count, sizeof *a->channels);
    a->name = mem_copy_text("move");
    a->duration = 1;
    for (size_t i = 0; i < k->joint_count; i++) {
        const node *n = &s->nodes[k->joints[i]];
        bool        below = false;
        for (size_t other = 0; other < k->joint_count; other++)
            below = below || n->parent == k->joints[other];
        if (below)
            continue;
        const double *q = node_place_of(n)->rotation, h = sqrt(0.5);
        double        at[3], rotation[4] = {h * (q[0] + q[2]), h * (q[1] + q[3]), h * (q[2] - q[0]), h * (q[3] - q[1])};
        turned(node_place_of(n)->translation, at);
        set_channel(&a->channels[a->channel_count++], k->joints[i], PATH_TRANSLATION, at, 3);
        set_channel(&a->channels[a->channel_count++], k->joints[i], PATH_ROTATION, rotation, 4);
    }
    s->revision = scene_next_revision();
}

static void strokes_go_with_joints(void **state)
{
    /* The range of tones is found on the model at rest, which the turned camera sees from another side. */
#define AS_IT_IS                                                                                                       \
    {"scene.tone_range", "none"},                                                                                      \
    {                                                                                                                  \
        NULL, NULL                                                                                                     \
    }
    static const char *const none[][2] = {AS_IT_IS};
    static const char *const planes[][2] = {{"surface.coordinates", "triplanar"}, AS_IT_IS};
    static const char *const curvature[][2] = {{"surface.coordinates", "curvature"}, AS_IT_IS};
    static const char *const lapped[][2] = {{"surface.coordinates", "lapped"}, AS_IT_IS};
    /* Lines of a hand are drawn anew for each chain on the page, and are no part of the model. */
    static const char *const plain_lines[][2] = {
        {"lines.repeats", "1"}, {"lines.pull", "0"}, {"lines.overshoot", "0"}, {"lines.wobble", "0"}, AS_IT_IS};
    static const char *const later[][2] = {{"layers.technique", "front"}, {"layers.shading", "deferred"}, AS_IT_IS};
    static const struct {
        const char *look;
        const char *const (*settings)[2];
        double most; /* of pixels that are drawn, which differ */
    } rows[] = {{"hatch", none, 0.01},     {"hatch", planes, 0.01},       {"hatch", curvature, 0.02},
                {"engraving", none, 0.01}, {"hatch", later, 0.06},        {"stipple", none, 0.02},
                {"quill", none, 0.02},     {"sketch", plain_lines, 0.02}, {"halftone", planes, 0.02},
                {"hatch", lapped, 0.02},   {"pencil", none, 0.03}};
    lmn_scene *s = load("fox");
    add_move(s);
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        picture       moved, still;
        lmn_draw_desc desc = LMN_DRAW_DESC_INIT;
        desc.eye_given = true;
        const double eye[3] = {260, 140, 210}, target[3] = {0, 40, 0};
        memcpy(desc.eye, eye, sizeof eye);
        memcpy(desc.target, target, sizeof target);
        desc.up[1] = 1;
        draw(&still, *state, s, rows[i].look, rows[i].settings, &desc);
        turned(eye, desc.eye);
        turned(target, desc.target);
        desc.clip = "move";
        draw(&moved, *state, s, rows[i].look, rows[i].settings, &desc);
        int off = difference(&moved, &still, 64), ink = covered(&still);
        if (off > rows[i].most * ink || ink < 4 * SIDE)
            fail_msg("%s, row %zu: %d of %d pixels differ", rows[i].look, i, off, ink);
    }
    lmn_scene_destroy(&s);
}

/* --- one picture, whatever was drawn before ------------------------------------------------------------- */

static void pictures_do_not_hang_on_earlier_ones(void **state)
{
    static const char *const looks[] = {"edges", "hatch", "stipple", "quill", "sketch", "line", "xray"};
    lmn_scene               *s = load("fox");
    lmn_renderer_desc        fresh = LMN_RENDERER_DESC_INIT;
    for (size_t l = 0; l < sizeof looks / sizeof *looks; l++) {
        picture       after, alone;
        lmn_renderer *other = NULL;
        lmn_draw_desc desc = LMN_DRAW_DESC_INIT;
        desc.clip = "Walk";
        desc.fit_time = true;
        for (int k = 0; k < 3; k++) {
            desc.time_s = 0.1 + 0.17 * k;
            draw(&after, *state, s, looks[l], NULL, &desc);
        }
        DO(lmn_renderer_create(&other, &fresh, &error));
        draw(&alone, other, s, looks[l], NULL, &desc);
        lmn_renderer_destroy(&other);
        if (memcmp(&after, &alone, sizeof after) != 0)
            fail_msg("%s: %d pixels differ", looks[l], difference(&after, &alone, 0));
    }
    lmn_scene_destroy(&s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(poses_are_drawn_as_models, set_up, tear_down),
        cmocka_unit_test_setup_teardown(strokes_go_with_joints, set_up, tear_down),
        cmocka_unit_test_setup_teardown(films_of_a_sketch_boil, set_up, tear_down),
        cmocka_unit_test_setup_teardown(pictures_do_not_hang_on_earlier_ones, set_up, tear_down),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
