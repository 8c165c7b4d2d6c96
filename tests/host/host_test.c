/* What renderers do in contexts of EGL without a window: which context is current, what is refused, threads, and
 * depth among a host's. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>
#include <math.h>
#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "context.h"
#include "limner/limner.h"
#include "plane.h"
#include "state.h"

enum { SIDE = 128 };

static lmn_error error;

static void check(lmn_status status, const char *what)
{
    if (status != LMN_OK)
        fail_msg("%s: %s (%s)", what, error.message, error.hint);
}
#define DO(call) check(call, #call)

static lmn_scene *load(const char *name)
{
    lmn_scene *scene;
    char       path[512];
    snprintf(path, sizeof path, EXAMPLES "/%s", name);
    DO(lmn_scene_create(&scene, &error));
    DO(lmn_scene_add_file(scene, path, NULL, &error));
    return scene;
}

static lmn_look *look(const char *name)
{
    lmn_look *out;
    DO(lmn_look_load(&out, name, &error));
    return out;
}

static lmn_draw_desc description(void)
{
    lmn_draw_desc desc = LMN_DRAW_DESC_INIT;
    desc.width = desc.height = SIDE;
    desc.samples = 1;
    return desc;
}

static lmn_renderer *adopt(void)
{
    lmn_renderer     *out;
    lmn_renderer_desc desc = LMN_RENDERER_DESC_INIT;
    desc.adopt = desc.debug = true;
    DO(lmn_renderer_create(&out, &desc, &error));
    return out;
}

static lmn_target target_of(const picture *p)
{
    lmn_target target = LMN_TARGET_INIT;
    target.framebuffer = p->framebuffer;
    target.width = p->width;
    target.height = p->height;
    return target;
}

static void read_picture(const picture *p, uint8_t *out)
{
    glBindFramebuffer(GL_FRAMEBUFFER, p->framebuffer);
    glPixelStorei(GL_PACK_ALIGNMENT, 1);
    glReadPixels(0, 0, p->width, p->height, GL_RGBA, GL_UNSIGNED_BYTE, out);
}

static void clear(const picture *p)
{
    glBindFramebuffer(GL_FRAMEBUFFER, p->framebuffer);
    glViewport(0, 0, p->width, p->height);
    glClearColor(0, 0, 1, 1);
    glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
}

/* --- which context is current --- */

static void nothing_is_left_current(void **unused)
{
    (void)unused;
    context_release();
    eglBindAPI(EGL_OPENGL_ES_API);
    lmn_renderer *r;
    lmn_scene    *scene = load("box.glb");
    lmn_look     *plain = look("plain");
    lmn_drawing  *drawing;
    lmn_draw_desc desc = description();
    DO(lmn_renderer_create(&r, NULL, &error));
    assert_null(eglGetCurrentContext());
    assert_int_equal(eglQueryAPI(), EGL_OPENGL_ES_API);
    DO(lmn_draw(&drawing, r, scene, plain, &desc, &error));
    assert_null(eglGetCurrentContext());
    assert_int_equal(eglQueryAPI(), EGL_OPENGL_ES_API);
    lmn_drawing_destroy(&drawing);
    desc.width = 0; /* refused */
    assert_int_equal(lmn_draw(&drawing, r, scene, plain, &desc, &error), LMN_USAGE);
    desc.width = SIDE;
    desc.select = "no such part";
    assert_int_not_equal(lmn_draw(&drawing, r, scene, plain, &desc, &error), LMN_OK);
    assert_null(eglGetCurrentContext());
    lmn_renderer_destroy(&r);
    assert_null(eglGetCurrentContext());
    lmn_look_destroy(&plain);
    lmn_scene_destroy(&scene);
}

static void a_hosts_context_is_current_again(void **unused)
{
    (void)unused;
    context       c;
    lmn_renderer *r;
    lmn_scene    *scene = load("box.glb");
    lmn_look     *plain = look("plain");
    lmn_draw_desc desc = description();
    char         *json = NULL;
    for (int kind = CONTEXT_CORE; kind <= CONTEXT_ES; kind++) {
        assert_true(context_open(&c, (context_kind)kind, 3, kind == CONTEXT_ES ? 0 : 3));
        DO(lmn_renderer_create(&r, NULL, &error));
        assert_ptr_equal(eglGetCurrentContext(), c.context);
        DO(lmn_bench_json(&json, r, scene, (const char *const[]){"line"}, 1, &desc, 1, &error));
        lmn_text_free(json);
        assert_ptr_equal(eglGetCurrentContext(), c.context);
        assert_int_equal(eglQueryAPI(), c.api);
        lmn_renderer_destroy(&r);
        assert_ptr_equal(eglGetCurrentContext(), c.context);
        context_close(&c);
    }
    lmn_look_destroy(&plain);
    lmn_scene_destroy(&scene);
}

static void only_what_is_current_can_be_adopted(void **unused)
{
    (void)unused;
    context_release();
    lmn_renderer     *r = (lmn_renderer *)1;
    lmn_renderer_desc desc = LMN_RENDERER_DESC_INIT;
    desc.adopt = true;
    assert_int_equal(lmn_renderer_create(&r, &desc, &error), LMN_USAGE);
    assert_null(r);
    assert_non_null(strstr(error.hint, "glfwMakeContextCurrent"));
}

static void an_adopted_context_must_be_current(void **unused)
{
    (void)unused;
    context       c, other;
    lmn_scene    *scene = load("box.glb");
    lmn_look     *plain = look("plain");
    lmn_draw_desc desc = description();
    lmn_drawing  *drawing;
    assert_true(context_open(&c, CONTEXT_CORE, 3, 3));
    lmn_renderer *r = adopt();
    context_release();
    assert_int_equal(lmn_draw(&drawing, r, scene, plain, &desc, &error), LMN_USAGE);
    assert_non_null(strstr(error.message, "not current"));
    assert_true(context_open(&other, CONTEXT_CORE, 3, 3));
    assert_int_equal(lmn_draw(&drawing, r, scene, plain, &desc, &error), LMN_USAGE);
    assert_ptr_equal(eglGetCurrentContext(), other.context);
    context_make_current(&c);
    DO(lmn_draw(&drawing, r, scene, plain, &desc, &error));
    lmn_drawing_destroy(&drawing);
    context_close(&other);
    context_close(&c); /* before its renderer */
    lmn_renderer_destroy(&r);
    assert_null(r);
    lmn_look_destroy(&plain);
    lmn_scene_destroy(&scene);
}

/* --- what is refused --- */

typedef struct arguments {
    context       context;
    picture       picture;
    lmn_renderer *renderer;
    lmn_scene    *scene;
    lmn_look     *look;
} arguments;

static void refused(const arguments *a, const lmn_draw_desc *desc, const lmn_target *target, lmn_status expected,
                    const char *word)
{
    lmn_status status = lmn_draw_into(a->renderer, a->scene, a->look, desc, target, &error);
    if (status != expected || !strstr(error.message, word))
        fail_msg("status %d, '%s', expected %d with '%s'", (int)status, error.message, (int)expected, word);
    assert_int_equal(glGetError(), GL_NO_ERROR);
}

static void open_arguments_in(arguments *a, context_kind kind)
{
    assert_true(context_open(&a->context, kind, 3, kind == CONTEXT_ES ? 0 : 3));
    picture_open(&a->picture, SIDE, SIDE, PICTURE_DEPTH_24);
    a->renderer = adopt();
    a->scene = load("box.glb");
    a->look = look("plain");
}

static void open_arguments(arguments *a)
{
    open_arguments_in(a, CONTEXT_CORE);
}

static void close_arguments(arguments *a)
{
    lmn_renderer_destroy(&a->renderer);
    lmn_look_destroy(&a->look);
    lmn_scene_destroy(&a->scene);
    picture_close(&a->picture);
    context_close(&a->context);
}

static void targets_are_checked(void **unused)
{
    (void)unused;
    arguments a;
    plane     p;
    picture   flat;
    open_arguments(&a);
    lmn_draw_desc desc = description();
    lmn_target    good = target_of(&a.picture), bad = good;
    refused(&a, &desc, NULL, LMN_USAGE, "LMN_TARGET_INIT");
    refused(&a, NULL, &good, LMN_USAGE, "description");
    bad.struct_size = 1;
    refused(&a, &desc, &bad, LMN_USAGE, "LMN_TARGET_INIT");
    bad = good, bad.depth = (lmn_target_depth)7;
    refused(&a, &desc, &bad, LMN_USAGE, "depth");
    bad = good, bad.width = 0;
    refused(&a, &desc, &bad, LMN_USAGE, "width");
    bad = good, bad.framebuffer = 4711;
    refused(&a, &desc, &bad, LMN_USAGE, "4711");
    bad = good, bad.framebuffer = 0; /* there is no window */
    refused(&a, &desc, &bad, LMN_USAGE, "complete");
    bad = good, bad.depth = LMN_TARGET_DEPTH_TEST_AND_WRITE;
    refused(&a, &desc, &bad, LMN_USAGE, "camera");
    plane_open(&p, PLANE_USUAL, false, 0);
    desc.matrices_given = true;
    memcpy(desc.view_matrix, p.view, sizeof p.view);
    memcpy(desc.projection_matrix, p.projection, sizeof p.projection);
    picture_open(&flat, SIDE, SIDE, PICTURE_DEPTH_NONE);
    bad.framebuffer = flat.framebuffer;
    refused(&a, &desc, &bad, LMN_USAGE, "no depth");
    desc.projection_matrix[8] = 0.1;
    refused(&a, &desc, &good, LMN_UNSUPPORTED, "middle");
    desc.projection_matrix[8] = 0;
    desc.projection_matrix[5] = -desc.projection_matrix[5];
    refused(&a, &desc, &good, LMN_USAGE, "projection");
    memcpy(desc.projection_matrix, p.projection, sizeof p.projection);
    desc.view_matrix[0] *= 2;
    refused(&a, &desc, &good, LMN_USAGE, "view");
    desc.view_matrix[0] = NAN;
    refused(&a, &desc, &good, LMN_USAGE, "finite");
    desc = description();
    desc.maps = true;
    refused(&a, &desc, &good, LMN_USAGE, "maps");
    desc = description();
    desc.struct_size++;
    refused(&a, &desc, &good, LMN_USAGE, "LMN_DRAW_DESC_INIT");
    desc = description();
    DO(lmn_draw_into(a.renderer, a.scene, a.look, &desc, &good, &error));
    assert_int_equal(lmn_draw_into(NULL, a.scene, a.look, &desc, &good, &error), LMN_USAGE);
    assert_int_equal(lmn_draw_into(a.renderer, NULL, a.look, &desc, &good, &error), LMN_USAGE);
    assert_int_equal(lmn_draw_into(a.renderer, a.scene, NULL, &desc, &good, NULL), LMN_USAGE);
    plane_close(&p);
    picture_close(&flat);
    close_arguments(&a);
}

static void own_contexts_have_no_targets(void **unused)
{
    (void)unused;
    arguments     a;
    lmn_renderer *own;
    open_arguments(&a);
    lmn_draw_desc desc = description();
    lmn_target    target = target_of(&a.picture);
    DO(lmn_renderer_create(&own, NULL, &error));
    assert_int_equal(lmn_draw_into(own, a.scene, a.look, &desc, &target, &error), LMN_USAGE);
    assert_non_null(strstr(error.hint, "adopt"));
    lmn_renderer_desc wrong = LMN_RENDERER_DESC_INIT;
    wrong.struct_size = 1;
    lmn_renderer_destroy(&own);
    assert_int_equal(lmn_renderer_create(&own, &wrong, &error), LMN_USAGE);
    close_arguments(&a);
}

static void running_queries_are_in_the_way(void **unused)
{
    (void)unused;
    arguments a;
    GLuint    query;
    open_arguments(&a);
    lmn_draw_desc desc = description();
    lmn_target    target = target_of(&a.picture);
    glGenQueries(1, &query);
    glBeginQuery(GL_SAMPLES_PASSED, query);
    refused(&a, &desc, &target, LMN_USAGE, "GL_SAMPLES_PASSED");
    glEndQuery(GL_SAMPLES_PASSED);
    DO(lmn_draw_into(a.renderer, a.scene, a.look, &desc, &target, &error));
    glDeleteQueries(1, &query);
    close_arguments(&a);
}

/* Feedback that a host has begun goes on after the call, into the same place. */
static void feedback_waits(void **unused)
{
    (void)unused;
    arguments     a;
    state_objects o;
    GLuint        buffer;
    GLint         active = 0, paused = 1;
    float         got[4][4] = {{0}};
    open_arguments(&a);
    lmn_draw_desc desc = description();
    lmn_target    target = target_of(&a.picture);
    state_objects_create(&o);
    glTransformFeedbackVaryings(o.program, 1, (const char *const[]){"gl_Position"}, GL_INTERLEAVED_ATTRIBS);
    glLinkProgram(o.program);
    glGenBuffers(1, &buffer);
    glBindBuffer(GL_TRANSFORM_FEEDBACK_BUFFER, buffer);
    glBufferData(GL_TRANSFORM_FEEDBACK_BUFFER, sizeof got, NULL, GL_STATIC_READ);
    glBindBufferBase(GL_TRANSFORM_FEEDBACK_BUFFER, 0, buffer);
    glUseProgram(o.program);
    glBindVertexArray(o.array);
    glBindFramebuffer(GL_FRAMEBUFFER, a.picture.framebuffer);
    glBeginTransformFeedback(GL_POINTS);
    glDrawArrays(GL_POINTS, 0, 2);
    DO(lmn_draw_into(a.renderer, a.scene, a.look, &desc, &target, &error));
    glGetIntegerv(GL_TRANSFORM_FEEDBACK_ACTIVE, &active);
    glGetIntegerv(GL_TRANSFORM_FEEDBACK_PAUSED, &paused);
    assert_true(active && !paused);
    glDrawArrays(GL_POINTS, 2, 2);
    glEndTransformFeedback();
    assert_int_equal(glGetError(), GL_NO_ERROR);
    glGetBufferSubData(GL_TRANSFORM_FEEDBACK_BUFFER, 0, sizeof got, got);
    const float expected[4][2] = {{-0.9f, -0.9f}, {0.7f, -0.6f}, {-0.2f, 0.9f}, {0.9f, 0.9f}};
    for (int i = 0; i < 4; i++)
        assert_memory_equal(got[i], expected[i], sizeof expected[i]);
    glDeleteBuffers(1, &buffer);
    state_objects_destroy(&o);
    close_arguments(&a);
}

typedef struct again {
    arguments *a;
    int        asked;
    lmn_status status;
} again;

static bool draw_again(double fraction, const char *stage, void *user)
{
    (void)fraction, (void)stage;
    again        *g = user;
    lmn_draw_desc desc = description();
    lmn_drawing  *drawing = NULL;
    if (g->asked++ == 0)
        g->status = lmn_draw(&drawing, g->a->renderer, g->a->scene, g->a->look, &desc, NULL);
    return true;
}

static void one_call_at_a_time(void **unused)
{
    (void)unused;
    arguments a;
    again     g = {&a, 0, LMN_OK};
    open_arguments(&a);
    lmn_draw_desc desc = description();
    lmn_target    target = target_of(&a.picture);
    desc.progress = draw_again;
    desc.progress_user = &g;
    DO(lmn_draw_into(a.renderer, a.scene, a.look, &desc, &target, &error));
    assert_true(g.asked > 0);
    assert_int_equal(g.status, LMN_USAGE);
    close_arguments(&a);
}

static bool cancel_later(double fraction, const char *stage, void *user)
{
    (void)fraction, (void)stage;
    int *left = user;
    return --*left > 0;
}

/* Wherever a call ends, the state is as before, and the next call is a good one. */
static void cancelled_calls_give_back(void **unused)
{
    (void)unused;
    arguments     a;
    state_objects o;
    static state  before, after;
    int           cancelled = 0;
    open_arguments(&a);
    lmn_look_destroy(&a.look);
    a.look = look("pencil");
    state_objects_create(&o);
    lmn_target target = target_of(&a.picture);
    for (int k = 1; k <= 4; k++) {
        lmn_draw_desc desc = description();
        int           left = k;
        desc.progress = cancel_later;
        desc.progress_user = &left;
        state_upset(&o, STATE_DEADLY);
        state_take(&before);
        lmn_status status = lmn_draw_into(a.renderer, a.scene, a.look, &desc, &target, &error);
        state_take(&after);
        assert_true(status == LMN_OK || status == LMN_CANCELLED);
        cancelled += status == LMN_CANCELLED;
        assert_true(state_same(&before, &after));
        desc.progress = NULL;
        DO(lmn_draw_into(a.renderer, a.scene, a.look, &desc, &target, &error));
    }
    assert_true(cancelled > 0);
    state_calm();
    state_objects_destroy(&o);
    close_arguments(&a);
}

/* --- threads --- */

typedef struct thread_job {
    const lmn_scene *scene;
    lmn_renderer    *renderer; /* NULL: its own */
    const uint8_t   *expected;
    int              wrong;
} thread_job;

static void *draw_often(void *user)
{
    thread_job   *j = user;
    lmn_error     own_error;
    lmn_renderer *r = j->renderer;
    lmn_look     *pencil = NULL;
    lmn_draw_desc desc = description();
    j->wrong += !r && lmn_renderer_create(&r, NULL, &own_error) != LMN_OK;
    j->wrong += lmn_look_load(&pencil, "pencil", &own_error) != LMN_OK;
    for (int i = 0; i < 8 && !j->wrong; i++) {
        lmn_drawing *drawing = NULL;
        j->wrong += lmn_draw(&drawing, r, j->scene, pencil, &desc, &own_error) != LMN_OK ||
                    memcmp(lmn_drawing_pixels(drawing, NULL, NULL), j->expected, SIDE * SIDE * 4) != 0 ||
                    eglGetCurrentContext() != NULL;
        lmn_drawing_destroy(&drawing);
    }
    if (!j->renderer)
        lmn_renderer_destroy(&r);
    lmn_look_destroy(&pencil);
    return NULL;
}

static void renderers_on_two_threads(void **unused)
{
    (void)unused;
    context_release();
    pthread_t     threads[2];
    lmn_renderer *r;
    lmn_scene    *scenes[2] = {load("knot.glb"), load("knot.glb")};
    lmn_look     *pencil = look("pencil");
    lmn_draw_desc desc = description();
    lmn_drawing  *drawing;
    DO(lmn_renderer_create(&r, NULL, &error));
    DO(lmn_draw(&drawing, r, scenes[0], pencil, &desc, &error));
    thread_job jobs[2];
    for (int i = 0; i < 2; i++) {
        jobs[i] = (thread_job){scenes[i], NULL, lmn_drawing_pixels(drawing, NULL, NULL), 0};
        assert_int_equal(pthread_create(&threads[i], NULL, draw_often, &jobs[i]), 0);
    }
    for (int i = 0; i < 2; i++)
        pthread_join(threads[i], NULL);
    assert_int_equal(jobs[0].wrong + jobs[1].wrong, 0);
    /* The same renderer, from one thread to the next. */
    jobs[0].renderer = r;
    for (int i = 0; i < 2; i++) {
        assert_int_equal(pthread_create(&threads[0], NULL, draw_often, &jobs[0]), 0);
        pthread_join(threads[0], NULL);
    }
    assert_int_equal(jobs[0].wrong, 0);
    lmn_drawing_destroy(&drawing);
    lmn_renderer_destroy(&r);
    lmn_look_destroy(&pencil);
    lmn_scene_destroy(&scenes[0]);
    lmn_scene_destroy(&scenes[1]);
}

/* --- cameras --- */

static lmn_draw_desc with_camera(const plane *p)
{
    lmn_draw_desc desc = description();
    desc.matrices_given = true;
    desc.background = "none";
    memcpy(desc.view_matrix, p->view, sizeof p->view);
    memcpy(desc.projection_matrix, p->projection, sizeof p->projection);
    return desc;
}

static void matrices_are_a_camera(void **unused)
{
    (void)unused;
    context_release();
    lmn_renderer *r;
    lmn_scene    *scene = load("box.glb");
    lmn_look     *line = look("line");
    lmn_drawing  *drawings[2];
    DO(lmn_renderer_create(&r, NULL, &error));
    for (int parallel = 0; parallel < 2; parallel++) {
        lmn_draw_desc by_eye = description(), by_matrix = description();
        const double  eye[3] = {0, 0, 4}, t = tan(15 * 3.14159265358979323846 / 180);
        by_eye.eye_given = by_matrix.matrices_given = true;
        by_eye.orthographic = parallel;
        memcpy(by_eye.eye, eye, sizeof eye);
        for (int i = 0; i < 16; i += 5)
            by_matrix.view_matrix[i] = 1;
        by_matrix.view_matrix[14] = -4;
        by_matrix.projection_matrix[0] = by_matrix.projection_matrix[5] = parallel ? 1 / (4 * t) : 1 / t;
        by_matrix.projection_matrix[10] = parallel ? -2 / 99.0 : -101 / 99.0;
        by_matrix.projection_matrix[parallel ? 15 : 11] = parallel ? 1 : -1;
        by_matrix.projection_matrix[14] = parallel ? -101 / 99.0 : -200 / 99.0;
        DO(lmn_draw(&drawings[0], r, scene, line, &by_eye, &error));
        DO(lmn_draw(&drawings[1], r, scene, line, &by_matrix, &error));
        assert_memory_equal(lmn_drawing_pixels(drawings[0], NULL, NULL), lmn_drawing_pixels(drawings[1], NULL, NULL),
                            SIDE * SIDE * 4);
        lmn_drawing_destroy(&drawings[0]);
        lmn_drawing_destroy(&drawings[1]);
    }
    lmn_renderer_destroy(&r);
    lmn_look_destroy(&line);
    lmn_scene_destroy(&scene);
}

/* --- among a host's --- */

/* Draws the plane and the cube, in this order or the other one. */
static void draw_both(arguments *a, const plane *p, bool plane_first, uint8_t *out)
{
    lmn_draw_desc desc = with_camera(p);
    lmn_target    target = target_of(&a->picture);
    target.depth = LMN_TARGET_DEPTH_TEST_AND_WRITE;
    plane_set_depth(p);
    clear(&a->picture);
    if (plane_first)
        plane_draw(p);
    DO(lmn_draw_into(a->renderer, a->scene, a->look, &desc, &target, &error));
    if (!plane_first)
        plane_draw(p);
    read_picture(&a->picture, out);
    state_calm();
}

static plane_seen seen_at(const uint8_t *pixel)
{
    return pixel[0] == 0 && pixel[1] == 255 ? SEEN_PLANE : pixel[0] == 0 && pixel[2] == 255 ? SEEN_NOTHING : SEEN_CUBE;
}

/* Pixels where rays around the middle do not all agree lie on a border, which drivers may round either way. */
static bool is_sure(const plane *p, int x, int y)
{
    const double AROUND = 0.01;
    plane_seen   middle = plane_ray(p, x + 0.5, y + 0.5, SIDE, SIDE);
    for (int i = 0; i < 4; i++)
        if (plane_ray(p, x + 0.5 + (i & 1 ? AROUND : -AROUND), y + 0.5 + (i & 2 ? AROUND : -AROUND), SIDE, SIDE) !=
            middle)
            return false;
    return true;
}

static void check_rays(const plane *p, const uint8_t *pixels)
{
    int counts[3] = {0}, unsure = 0, wrong = 0;
    for (int y = 0; y < SIDE; y++)
        for (int x = 0; x < SIDE; x++) {
            plane_seen expected = plane_ray(p, x + 0.5, y + 0.5, SIDE, SIDE);
            counts[expected]++;
            if (!is_sure(p, x, y))
                unsure++;
            else if (seen_at(pixels + 4 * (y * SIDE + x)) != expected)
                wrong++;
        }
    assert_true(counts[SEEN_PLANE] > 500 && counts[SEEN_CUBE] > 500);
    if (wrong || unsure > SIDE / 8)
        fail_msg("%d of %d pixels are not what rays meet, %d lie on borders", wrong, SIDE * SIDE, unsure);
}

static void check_depth(arguments *a, plane_depth depth, picture_depth kind, bool parallel)
{
    static uint8_t pixels[2][SIDE * SIDE * 4];
    plane          p;
    picture        before = a->picture;
    picture_open(&a->picture, SIDE, SIDE, kind);
    plane_open(&p, depth, parallel, 0.05);
    draw_both(a, &p, true, pixels[0]);
    check_rays(&p, pixels[0]);
    draw_both(a, &p, false, pixels[1]);
    check_rays(&p, pixels[1]);
    assert_memory_equal(pixels[0], pixels[1], sizeof pixels[0]);
    plane_close(&p);
    picture_close(&a->picture);
    a->picture = before;
}

static void depth_interleaves(void **unused)
{
    (void)unused;
    for (int api = CONTEXT_CORE; api <= CONTEXT_ES; api++) {
        arguments a;
        open_arguments_in(&a, (context_kind)api);
        for (int depth = 0; depth < PLANE_DEPTHS; depth++)
            for (int kind = PICTURE_DEPTH_24; kind <= PICTURE_DEPTH_32F; kind++)
                for (int parallel = 0; parallel < 2; parallel++)
                    if (api != CONTEXT_ES || depth != PLANE_REVERSED) /* which ES has by an extension alone */
                        check_depth(&a, (plane_depth)depth, (picture_depth)kind, parallel);
        close_arguments(&a);
    }
}

/* Seen through, the cube shows what is behind it and is hidden by what is in front of it. */
static void see_through_has_depth(void **unused)
{
    (void)unused;
    arguments      a;
    static uint8_t pixels[3][SIDE * SIDE * 4];
    open_arguments(&a);
    lmn_look_destroy(&a.look);
    a.look = look("xray");
    for (int k = 0; k < 3; k++) {
        plane p;
        plane_open(&p, PLANE_USUAL, false, k == 0 ? -1.2 : 1.2); /* behind, in front */
        if (k < 2) {
            draw_both(&a, &p, true, pixels[k]);
        } else {
            plane_set_depth(&p);
            clear(&a.picture);
            plane_draw(&p);
            read_picture(&a.picture, pixels[k]);
            state_calm();
        }
        plane_close(&p);
    }
    int mixed = 0, covered = 0;
    for (int i = 0; i < SIDE * SIDE; i++) {
        const uint8_t *behind = &pixels[0][4 * i], *front = &pixels[1][4 * i], *alone = &pixels[2][4 * i];
        mixed += behind[1] > 40 && behind[1] < 250 && behind[0] > 0;
        if (seen_at(alone) == SEEN_PLANE) {
            covered++;
            assert_int_equal(seen_at(front), SEEN_PLANE);
        }
    }
    assert_true(mixed > 500 && covered > 500);
    close_arguments(&a);
}

/* The eye depth at a pixel of a map, row 0 at the bottom. */
static double depth_in(const float *map, int x, int y)
{
    x = x < 0 ? 0 : x >= SIDE ? SIDE - 1 : x;
    y = y < 0 ? 0 : y >= SIDE ? SIDE - 1 : y;
    return (double)map[(SIDE - 1 - y) * SIDE + x];
}

/* A sketch is as deep as the nearer of what its lines and its fill show there, which both lie beside the pixel: what
 * the host's depth buffer holds, against the maps and the field of a drawing of its own. `rest` is of the rule;
 * `mixed`: fill between pixels is as deep as the nearest of those it mixes. Rows csg C18, C20. */
static void check_nearer_depth(const char *rest, bool mixed)
{
    static const char format[] =
        "{\"version\":1,\"name\":\"t\",\"rules\":[{\"surface\":{\"technique\":\"flat\",\"colour\":\"#d03020\"},"
        "\"lines\":"
        "{\"operator\":\"discontinuity\",\"colour\":\"#000000\"},\"perturb\":{\"technique\":\"uncertainty\",\"amount\":"
        "9,"
        "\"scale\":40,\"fallback\":\"#ff00ff\",\"edges_xx\":0,\"edges_xy\":1,\"edges_yx\":-1,\"edges_yy\":0,\"shades_"
        "xx\":0.6,\"shades_xy\":0.4,"
        "\"shades_yx\":0,\"shades_yy\":-1}%s}]}";
    char           json[1024];
    static float   depth[SIDE * SIDE], field[3 * SIDE * SIDE], read[SIDE * SIDE];
    static uint8_t pixels[SIDE * SIDE * 4];
    arguments      a;
    plane          p;
    lmn_renderer  *own;
    lmn_drawing   *drawing;
    open_arguments(&a);
    lmn_look_destroy(&a.look);
    snprintf(json, sizeof json, format, rest);
    DO(lmn_look_parse(&a.look, json, "t", &error));
    plane_open(&p, PLANE_USUAL, false, 0);
    lmn_draw_desc desc = with_camera(&p);
    desc.dpi = 96; /* lengths are in pixels */
    lmn_draw_desc with_maps = desc;
    with_maps.maps = true;
    lmn_target target = target_of(&a.picture);
    target.depth = LMN_TARGET_DEPTH_TEST_AND_WRITE;
    plane_set_depth(&p);
    clear(&a.picture);
    DO(lmn_draw_into(a.renderer, a.scene, a.look, &desc, &target, &error));
    glBindFramebuffer(GL_FRAMEBUFFER, a.picture.framebuffer);
    glReadPixels(0, 0, SIDE, SIDE, GL_DEPTH_COMPONENT, GL_FLOAT, read);
    read_picture(&a.picture, pixels);
    context_release();
    DO(lmn_renderer_create(&own, NULL, &error));
    DO(lmn_draw(&drawing, own, a.scene, a.look, &with_maps, &error));
    DO(lmn_drawing_copy_map(drawing, LMN_MAP_DEPTH, depth, SIDE * SIDE, &error));
    DO(lmn_drawing_copy_map(drawing, LMN_MAP_UNCERTAINTY, field, 3 * SIDE * SIDE, &error));
    int both = 0, fill_alone = 0, line_alone = 0, wrong = 0, deeper = 0;
    for (int y = 12; y < SIDE - 12; y++)
        for (int x = 12; x < SIDE - 12; x++) {
            const float *u = &field[3 * ((SIDE - 1 - y) * SIDE + x)];
            double fx = x + 9 * (0.6 * (double)u[0] + 0.4 * (double)u[1]), fy = y - 9 * (double)u[1], fill = INFINITY;
            double line =
                depth_in(depth, (int)floor(x + 9 * (double)u[1] + 0.5), (int)floor(y - 9 * (double)u[0] + 0.5));
            if (!mixed)
                fill = depth_in(depth, (int)floor(fx + 0.5), (int)floor(fy + 0.5));
            for (int i = 0; i < 4 && mixed; i++)
                fill = fmin(fill, depth_in(depth, (int)floor(fx) + i % 2, (int)floor(fy) + i / 2));
            double ndc = 2 * (double)read[y * SIDE + x] - 1, got = p.projection[14] / (ndc + p.projection[10]);
            if (isinf(fill) && (isinf(line) || seen_at(&pixels[4 * (y * SIDE + x)]) == SEEN_NOTHING))
                continue; /* empty, or ink beside an outline */
            both += isfinite(fill) && isfinite(line);
            fill_alone += isinf(line);
            line_alone += isinf(fill);
            deeper += fabs(fill - line) > 0.01;
            /* Ink beside an outline is as deep as what it surrounds. */
            bool nearer = isinf(line) && got < fill;
            wrong += !nearer && !(fabs(got - fmin(fill, line)) < 0.004);
        }
    print_message(
        "%d places of lines and fill, %d of fill alone, %d of lines alone; %d where one is deeper, %d wrong\n", both,
        fill_alone, line_alone, deeper, wrong);
    assert_true(both > 1500 && fill_alone > 50 && line_alone > 50 && deeper > 1000);
    assert_true(wrong <= (both + fill_alone + line_alone) / 200); /* rounded to the other pixel */
    lmn_drawing_destroy(&drawing);
    lmn_renderer_destroy(&own);
    context_make_current(&a.context);
    plane_close(&p);
    close_arguments(&a);
}

static void sketches_have_the_nearer_depth(void **unused)
{
    (void)unused;
    check_nearer_depth("", true);
}

/* What is seen through has the depth of its nearest surface, where the sketch has that. */
static void sketched_layers_have_the_nearer_depth(void **unused)
{
    (void)unused;
    static const char layers[] = ",\"layers\":{\"technique\":\"peel\",\"count\":0},\"compose\":";
    char              rest[256];
    snprintf(rest, sizeof rest, "%s{\"technique\":\"blueprint\",\"tint_opacity\":0.3}", layers);
    check_nearer_depth(rest, false);
    snprintf(rest, sizeof rest, "%s{\"technique\":\"xray\",\"opacity\":0.5}", layers);
    check_nearer_depth(rest, false);
}

static void what_is_not_opaque_mixes(void **unused)
{
    (void)unused;
    arguments      a;
    static uint8_t pixels[SIDE * SIDE * 4];
    lmn_drawing   *drawing;
    open_arguments(&a);
    lmn_look_destroy(&a.look);
    a.look = look("pencil");
    lmn_draw_desc desc = description();
    desc.background = "none";
    desc.samples = 4;
    lmn_target target = target_of(&a.picture);
    DO(lmn_draw(&drawing, a.renderer, a.scene, a.look, &desc, &error));
    clear(&a.picture);
    DO(lmn_draw_into(a.renderer, a.scene, a.look, &desc, &target, &error));
    read_picture(&a.picture, pixels);
    const uint8_t *own = lmn_drawing_pixels(drawing, NULL, NULL);
    for (int y = 0; y < SIDE; y++)
        for (int x = 0; x < SIDE * 4; x++) {
            const uint8_t *pixel = own + 4 * ((SIDE - 1 - y) * SIDE + x / 4);
            double         alpha = pixel[3] / 255.0, ground = x % 4 >= 2 ? 255 : 0,
                   expected = x % 4 == 3 ? 255 : pixel[x % 4] * alpha + ground * (1 - alpha);
            if (fabs(expected - pixels[y * SIDE * 4 + x]) > 1)
                fail_msg("%d %d: %d, expected %g", x, y, pixels[y * SIDE * 4 + x], expected);
        }
    lmn_drawing_destroy(&drawing);
    close_arguments(&a);
}

/* The bytes stay in framebuffers that could encode, and further buffers are left alone. */
static void framebuffers_with_more(void **unused)
{
    (void)unused;
    arguments      a;
    GLuint         textures[2];
    static uint8_t pixels[2][SIDE * SIDE * 4];
    lmn_drawing   *drawing;
    open_arguments(&a);
    lmn_draw_desc desc = description();
    lmn_target    target = target_of(&a.picture);
    glGenTextures(2, textures);
    glBindFramebuffer(GL_FRAMEBUFFER, a.picture.framebuffer);
    for (GLenum i = 0; i < 2; i++) {
        glBindTexture(GL_TEXTURE_2D, textures[i]);
        glTexImage2D(GL_TEXTURE_2D, 0, i ? GL_RGBA8 : GL_SRGB8_ALPHA8, SIDE, SIDE, 0, GL_RGBA, GL_UNSIGNED_BYTE, NULL);
        glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0 + i, GL_TEXTURE_2D, textures[i], 0);
    }
    glDrawBuffers(2, (GLenum[]){GL_COLOR_ATTACHMENT0, GL_COLOR_ATTACHMENT1});
    glEnable(GL_FRAMEBUFFER_SRGB);
    clear(&a.picture);
    DO(lmn_draw_into(a.renderer, a.scene, a.look, &desc, &target, &error));
    assert_true(glIsEnabled(GL_FRAMEBUFFER_SRGB));
    DO(lmn_draw(&drawing, a.renderer, a.scene, a.look, &desc, &error));
    const uint8_t *own = lmn_drawing_pixels(drawing, NULL, NULL);
    for (GLenum i = 0; i < 2; i++) {
        glBindFramebuffer(GL_FRAMEBUFFER, a.picture.framebuffer);
        glReadBuffer(GL_COLOR_ATTACHMENT0 + i);
        read_picture(&a.picture, pixels[i]);
    }
    for (int y = 0; y < SIDE; y++)
        assert_memory_equal(&pixels[0][y * SIDE * 4], own + (SIDE - 1 - y) * SIDE * 4, SIDE * 4);
    for (int i = 0; i < SIDE * SIDE; i++)
        assert_memory_equal(&pixels[1][4 * i], ((const uint8_t[]){0, 0, 255, 255}), 4);
    lmn_drawing_destroy(&drawing);
    glDeleteTextures(2, textures);
    close_arguments(&a);
}

/* Without restoring, pictures are right and the state is not what it was. */
static void state_may_be_left(void **unused)
{
    (void)unused;
    arguments         a;
    state_objects     o;
    static state      before, after;
    lmn_renderer_desc how = LMN_RENDERER_DESC_INIT;
    lmn_drawing      *drawings[2];
    lmn_draw_desc     desc = description();
    open_arguments(&a);
    DO(lmn_draw(&drawings[0], a.renderer, a.scene, a.look, &desc, &error));
    lmn_renderer_destroy(&a.renderer);
    how.adopt = how.no_restore = true;
    DO(lmn_renderer_create(&a.renderer, &how, &error));
    state_objects_create(&o);
    state_upset(&o, STATE_DEADLY);
    state_take(&before);
    DO(lmn_draw(&drawings[1], a.renderer, a.scene, a.look, &desc, &error));
    state_take(&after);
    int changed = 0;
    for (int i = 0; i < before.count; i++)
        changed += before.values[i].value != after.values[i].value;
    assert_true(changed > 50);
    assert_memory_equal(lmn_drawing_pixels(drawings[0], NULL, NULL), lmn_drawing_pixels(drawings[1], NULL, NULL),
                        SIDE * SIDE * 4);
    lmn_drawing_destroy(&drawings[0]);
    lmn_drawing_destroy(&drawings[1]);
    state_objects_destroy(&o);
    close_arguments(&a);
}

/* --- contexts that will not do; the driver is told to be old --- */

static int old_contexts(void)
{
    context           c;
    lmn_renderer     *r;
    lmn_renderer_desc desc = LMN_RENDERER_DESC_INIT;
    desc.adopt = true;
    if (!context_open(&c, CONTEXT_COMPATIBILITY, 2, 1) || epoxy_gl_version() >= 33) {
        printf("skipped: the driver has no old context\n");
        return 77;
    }
    lmn_status status = lmn_renderer_create(&r, &desc, &error);
    printf("%s\n%s\n", error.message, error.hint);
    return status != LMN_GL || !strstr(error.message, "2.1") || r != NULL || eglGetCurrentContext() != c.context;
}

int main(int count, char **arguments)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(nothing_is_left_current),
        cmocka_unit_test(a_hosts_context_is_current_again),
        cmocka_unit_test(only_what_is_current_can_be_adopted),
        cmocka_unit_test(an_adopted_context_must_be_current),
        cmocka_unit_test(targets_are_checked),
        cmocka_unit_test(own_contexts_have_no_targets),
        cmocka_unit_test(running_queries_are_in_the_way),
        cmocka_unit_test(feedback_waits),
        cmocka_unit_test(one_call_at_a_time),
        cmocka_unit_test(cancelled_calls_give_back),
        cmocka_unit_test(renderers_on_two_threads),
        cmocka_unit_test(matrices_are_a_camera),
        cmocka_unit_test(depth_interleaves),
        cmocka_unit_test(see_through_has_depth),
        cmocka_unit_test(sketches_have_the_nearer_depth),
        cmocka_unit_test(sketched_layers_have_the_nearer_depth),
        cmocka_unit_test(what_is_not_opaque_mixes),
        cmocka_unit_test(framebuffers_with_more),
        cmocka_unit_test(state_may_be_left),
    };
    if (count > 1 && strcmp(arguments[1], "old") == 0)
        return old_contexts();
    return cmocka_run_group_tests(tests, NULL, NULL);
}
