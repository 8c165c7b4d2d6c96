#include "frames.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const struct {
    const char *model, *look;
} cases[FRAME_CASES] = {
    {EXAMPLES "/box.glb", "plain"},        {EXAMPLES "/knot.glb", "pencil"},  {EXAMPLES "/blocks.glb", "xray"},
    {EXAMPLES "/csg/widget.csg", "draft"}, {EXAMPLES "/spot.obj", "stipple"}, {EXAMPLES "/box.glb", "sketch"},
};

void must(lmn_status status, const lmn_error *error, const char *what)
{
    if (status == LMN_OK)
        return;
    printf("%s: %s (%s)\n", what, error->message, error->hint);
    exit(1);
}

void must_be(bool good, const char *what)
{
    if (good)
        return;
    printf("failed: %s\n", what);
    exit(1);
}

int frames_wanted(void)
{
    const char *given = getenv("LIMNER_HOST_FRAMES");
    return given ? (int)strtol(given, NULL, 10) : 100;
}

static lmn_draw_desc description(void)
{
    lmn_draw_desc desc = LMN_DRAW_DESC_INIT;
    desc.width = FRAME_HALF;
    desc.height = FRAME_HEIGHT;
    desc.samples = 1;
    desc.background = "#fdf6e3";
    return desc;
}

void frames_open(frames *f)
{
    lmn_error         error = {0};
    lmn_renderer     *own;
    lmn_renderer_desc adopting = LMN_RENDERER_DESC_INIT, owning = LMN_RENDERER_DESC_INIT;
    lmn_draw_desc     desc = description();
    state             before, after;
    adopting.adopt = true;
    adopting.debug = owning.debug = true;
    owning.es = !epoxy_is_desktop_gl();
    memset(f, 0, sizeof *f);
    state_objects_create(&f->objects);
    glUseProgram(f->objects.program);
    state_upset(&f->objects, STATE_LIVELY);
    state_take(&before);
    must(lmn_renderer_create(&own, &owning, &error), &error, "a renderer with its own context");
    must(lmn_renderer_create(&f->renderer, &adopting, &error), &error, "a renderer in the context");
    for (int i = 0; i < FRAME_CASES; i++) {
        must(lmn_scene_create(&f->scenes[i], &error), &error, "a scene");
        must(lmn_scene_add_file(f->scenes[i], cases[i].model, NULL, &error), &error, cases[i].model);
        must(lmn_look_load(&f->looks[i], cases[i].look, &error), &error, cases[i].look);
        must(lmn_draw(&f->expected[i], own, f->scenes[i], f->looks[i], &desc, &error), &error, "lmn_draw");
    }
    lmn_renderer_destroy(&own);
    state_take(&after);
    must_be(state_same(&before, &after), "renderers come and go, and the state stays");
}

void frames_close(frames *f)
{
    lmn_renderer_destroy(&f->renderer);
    for (int i = 0; i < FRAME_CASES; i++) {
        lmn_drawing_destroy(&f->expected[i]);
        lmn_look_destroy(&f->looks[i]);
        lmn_scene_destroy(&f->scenes[i]);
    }
    state_objects_destroy(&f->objects);
}

static void draw_triangles(const frames *f, float shift)
{
    glUniform1f(glGetUniformLocation(f->objects.program, "u_shift"), shift);
    glDrawArrays(GL_TRIANGLES, 0, 9);
}

static void begin(const frames *f, GLuint framebuffer, state_preset preset)
{
    state_calm();
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
    glClearColor(0.25f, 0.5f, 0.75f, 1);
    glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT | GL_STENCIL_BUFFER_BIT);
    glUseProgram(f->objects.program);
    state_upset(&f->objects, preset);
}

static void read_half(GLuint framebuffer, int x, unsigned char *out)
{
    state_calm();
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
    glReadPixels(x, 0, FRAME_HALF, FRAME_HEIGHT, GL_RGBA, GL_UNSIGNED_BYTE, out);
}

/* The framebuffer's rows begin below. */
static bool same_picture(const unsigned char *read, const lmn_drawing *expected)
{
    size_t         stride = FRAME_HALF * 4, wrong = 0;
    const uint8_t *pixels = lmn_drawing_pixels(expected, NULL, NULL);
    for (size_t y = 0; y < FRAME_HEIGHT; y++)
        for (size_t i = 0; i < stride; i++)
            wrong += read[y * stride + i] != pixels[(FRAME_HEIGHT - 1 - y) * stride + i];
    if (wrong)
        printf("%zu bytes differ\n", wrong);
    return wrong == 0;
}

static void draw_beside(frames *f, GLuint framebuffer, int which)
{
    lmn_error     error = {0};
    lmn_draw_desc desc = description();
    lmn_target    target = LMN_TARGET_INIT;
    target.framebuffer = framebuffer;
    target.x = FRAME_HALF;
    target.width = FRAME_HALF;
    target.height = FRAME_HEIGHT;
    must(lmn_draw_into(f->renderer, f->scenes[which], f->looks[which], &desc, &target, &error), &error,
         "lmn_draw_into");
}

static void draw_picture(frames *f, int which)
{
    lmn_error     error = {0};
    lmn_draw_desc desc = description();
    lmn_drawing  *drawing;
    size_t        bytes = (size_t)FRAME_HALF * FRAME_HEIGHT * 4;
    must(lmn_draw(&drawing, f->renderer, f->scenes[which], f->looks[which], &desc, &error), &error, "lmn_draw");
    must_be(
        memcmp(lmn_drawing_pixels(drawing, NULL, NULL), lmn_drawing_pixels(f->expected[which], NULL, NULL), bytes) == 0,
        "the picture in the host's context is that in an own one");
    lmn_drawing_destroy(&drawing);
}

void frames_step(frames *f, GLuint framebuffer, int i)
{
    static unsigned char alone[FRAME_HALF * FRAME_HEIGHT * 4], beside[FRAME_HALF * FRAME_HEIGHT * 4];
    static state         before, after;
    int                  which = i % FRAME_CASES;
    state_preset         preset = i % 3 == 2 ? STATE_DEADLY : STATE_LIVELY;
    begin(f, framebuffer, preset);
    if (preset == STATE_LIVELY) {
        draw_triangles(f, 0);
        draw_triangles(f, 0.15f);
        read_half(framebuffer, 0, alone);
        begin(f, framebuffer, preset);
        draw_triangles(f, 0);
    }
    state_take(&before);
    draw_beside(f, framebuffer, which);
    if (i % 4 == 3)
        draw_picture(f, which);
    state_take(&after);
    if (!state_same(&before, &after)) {
        printf("frame %d\n", i);
        must_be(false, "the state is as before");
    }
    if (preset == STATE_LIVELY) {
        draw_triangles(f, 0.15f);
        read_half(framebuffer, 0, beside);
        must_be(memcmp(alone, beside, sizeof alone) == 0, "the host's picture is the same with Limner and without");
    }
    read_half(framebuffer, FRAME_HALF, beside);
    if (!same_picture(beside, f->expected[which])) {
        printf("frame %d, look %s, %s\n", i, cases[which].look, preset == STATE_DEADLY ? "deadly" : "lively");
        must_be(false, "the drawing is that of lmn_draw");
    }
    must_be(glGetError() == GL_NO_ERROR, "no error is left");
}
