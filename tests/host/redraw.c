/* How long a host waits for a drawing when only its camera moves: redraw MODEL LOOK [WIDTH HEIGHT FRAMES].
 * Milliseconds, medians: the first drawing, further ones into a framebuffer, the same as pictures that are read back,
 * and what saving and restoring takes of it. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "context.h"
#include "frames.h"

static double now_ms(void)
{
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return 1e3 * (double)t.tv_sec + 1e-6 * (double)t.tv_nsec;
}

static int compare(const void *a, const void *b)
{
    double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

typedef struct job {
    lmn_renderer *renderer;
    lmn_scene    *scene;
    lmn_look     *look;
    lmn_draw_desc desc;
    lmn_target    target;
} job;

static void draw_once(job *j, bool into, int i)
{
    lmn_error      error = {0};
    lmn_drawing   *drawing = NULL;
    double         angle = 0.02 * i, distance = 3;
    lmn_scene_info info = lmn_scene_info_of(j->scene);
    double         size = 0;
    for (int k = 0; k < 3; k++) {
        j->desc.target[k] = (info.bounds_min[k] + info.bounds_max[k]) / 2;
        size = fmax(size, info.bounds_max[k] - info.bounds_min[k]);
    }
    j->desc.eye_given = true;
    j->desc.eye[0] = j->desc.target[0] + distance * size * cos(angle);
    j->desc.eye[1] = j->desc.target[1] + 0.4 * distance * size;
    j->desc.eye[2] = j->desc.target[2] + distance * size * sin(angle);
    if (into)
        must(lmn_draw_into(j->renderer, j->scene, j->look, &j->desc, &j->target, &error), &error, "lmn_draw_into");
    else
        must(lmn_draw(&drawing, j->renderer, j->scene, j->look, &j->desc, &error), &error, "lmn_draw");
    glFinish();
    lmn_drawing_destroy(&drawing);
}

static double median(job *j, bool into, int frames)
{
    double *ms = malloc(sizeof *ms * (size_t)frames);
    for (int i = 0; i < frames; i++) {
        double start = now_ms();
        draw_once(j, into, i);
        ms[i] = now_ms() - start;
    }
    qsort(ms, (size_t)frames, sizeof *ms, compare);
    double out = ms[frames / 2];
    free(ms);
    return out;
}

/* Refused once the state is saved and set. */
static double nothing(job *j)
{
    enum { CALLS = 2000 };
    lmn_target none = j->target;
    double     start = now_ms();
    none.framebuffer = 4711;
    for (int i = 0; i < CALLS; i++)
        must_be(lmn_draw_into(j->renderer, j->scene, j->look, &j->desc, &none, NULL) == LMN_USAGE, "refused");
    return (now_ms() - start) / CALLS;
}

int main(int count, char **arguments)
{
    job               j = {.desc = LMN_DRAW_DESC_INIT, .target = LMN_TARGET_INIT};
    lmn_error         error = {0};
    lmn_renderer_desc how = LMN_RENDERER_DESC_INIT;
    context           c;
    picture           p;
    int               frames = count > 5 ? (int)strtol(arguments[5], NULL, 10) : 30;
    if (count < 3 || !context_open(&c, CONTEXT_CORE, 3, 3))
        return 1;
    j.desc.samples = 1;
    j.target.width = j.desc.width = count > 4 ? (int)strtol(arguments[3], NULL, 10) : 640;
    j.target.height = j.desc.height = count > 4 ? (int)strtol(arguments[4], NULL, 10) : 450;
    picture_open(&p, j.target.width, j.target.height, PICTURE_DEPTH_24);
    j.target.framebuffer = p.framebuffer;
    how.adopt = true;
    must(lmn_renderer_create(&j.renderer, &how, &error), &error, "a renderer");
    must(lmn_scene_create(&j.scene, &error), &error, "a scene");
    must(lmn_scene_add_file(j.scene, arguments[1], NULL, &error), &error, arguments[1]);
    must(lmn_look_load(&j.look, arguments[2], &error), &error, arguments[2]);
    double start = now_ms();
    draw_once(&j, true, 0);
    double first = now_ms() - start, into = median(&j, true, frames), read = median(&j, false, frames),
           kept = nothing(&j);
    lmn_renderer_destroy(&j.renderer);
    how.no_restore = true;
    must(lmn_renderer_create(&j.renderer, &how, &error), &error, "a renderer");
    printf("%s %s %dx%d: first %.1f, again %.2f, read back %.2f, nothing %.4f, without restoring %.4f ms\n",
           arguments[1], arguments[2], j.target.width, j.target.height, first, into, read, kept, nothing(&j));
    lmn_renderer_destroy(&j.renderer);
    lmn_look_destroy(&j.look);
    lmn_scene_destroy(&j.scene);
    picture_close(&p);
    context_close(&c);
    return 0;
}
