/* What moving a mesh costs: `moved [-n ROUNDS] [-g] [-s] [LOOK…]`. A torus of 100,000 vertices is drawn in turns as it
 * was in the frame before and with all of its positions changed; prints the medians of both and how many times as long
 * the second takes. -g: a grid with a rim instead; -s: says of each frame what it took. */
#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "limner/limner.h"

enum {
    ALONG = 400,
    AROUND = 250,
    VERTICES = ALONG * AROUND,
    ROUNDS_MOST = 1000,
    WIDTH = 1024,
    HEIGHT = 768,
    WARM_UP = 3
};

typedef struct moved {
    lmn_renderer *renderer;
    lmn_scene    *scene;
    uint32_t      mesh;
    bool          grid, says;
    int           rounds;
    float         positions[VERTICES][3];
    uint32_t      indices[6 * VERTICES];
} moved;

static double now_ms(void)
{
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (double)t.tv_sec * 1e3 + (double)t.tv_nsec * 1e-6;
}

static void need(lmn_status status, const lmn_error *error)
{
    if (status == LMN_OK)
        return;
    fprintf(stderr, "moved: %s\n", error->message);
    exit(1);
}

/* Waves run over the surface. */
static void place(moved *m, double phase)
{
    const double turn = 6.283185307179586;
    for (int i = 0; i < ALONG; i++)
        for (int k = 0; k < AROUND; k++) {
            float *p = m->positions[i * AROUND + k];
            double u = turn * i / ALONG, v = turn * k / AROUND, wave = 0.08 * sin(5 * u + 3 * v + phase);
            double tube = 0.8 + wave;
            p[0] = (float)(m->grid ? 4.0 * i / ALONG - 2 : (2 + tube * cos(v)) * cos(u));
            p[1] = (float)(m->grid ? 2 * wave : tube * sin(v));
            p[2] = (float)(m->grid ? 4.0 * k / AROUND - 2 : (2 + tube * cos(v)) * sin(u));
        }
}

static size_t connect(moved *m)
{
    size_t count = 0;
    for (int i = 0; i < ALONG - m->grid; i++)
        for (int k = 0; k < AROUND - m->grid; k++) {
            int      after = (i + 1) % ALONG, above = (k + 1) % AROUND;
            uint32_t a = (uint32_t)(i * AROUND + k), b = (uint32_t)(after * AROUND + k),
                     c = (uint32_t)(after * AROUND + above), d = (uint32_t)(i * AROUND + above);
            const uint32_t faces[6] = {a, d, c, a, c, b};
            memcpy(m->indices + count, faces, sizeof faces);
            count += 6;
        }
    return count;
}

static void open_scene(moved *m)
{
    lmn_error         error;
    lmn_renderer_desc renderer = LMN_RENDERER_DESC_INIT;
    lmn_mesh_desc     mesh = LMN_MESH_DESC_INIT;
    lmn_node_desc     node = LMN_NODE_DESC_INIT;
    need(lmn_renderer_create(&m->renderer, &renderer, &error), &error);
    need(lmn_scene_create(&m->scene, &error), &error);
    place(m, 0);
    mesh.positions = m->positions[0];
    mesh.vertex_count = VERTICES;
    mesh.indices = m->indices;
    mesh.index_count = connect(m);
    need(lmn_scene_add_mesh(m->scene, &mesh, &m->mesh, &error), &error);
    node.mesh = m->mesh;
    need(lmn_scene_add_node(m->scene, &node, NULL, &error), &error);
}

/* One frame, with the call that moves what it shows. */
static double time_frame(moved *m, const lmn_look *look, bool moves, double phase)
{
    const double  eye[3] = {5, 4, 6}, target[3] = {0, 0, 0}, up[3] = {0, 1, 0};
    lmn_draw_desc desc = LMN_DRAW_DESC_INIT;
    lmn_drawing  *drawing = NULL;
    lmn_error     error;
    desc.width = WIDTH;
    desc.height = HEIGHT;
    desc.dpi = 96;
    desc.samples = 1;
    desc.eye_given = true;
    memcpy(desc.eye, eye, sizeof eye);
    memcpy(desc.target, target, sizeof target);
    memcpy(desc.up, up, sizeof up);
    if (moves)
        place(m, phase); /* the caller's own work */
    double start = now_ms(), set = start;
    if (moves)
        need(lmn_scene_set_positions(m->scene, m->mesh, m->positions[0], NULL, VERTICES, &error), &error);
    set = now_ms();
    need(lmn_draw(&drawing, m->renderer, m->scene, look, &desc, &error), &error);
    double end = now_ms();
    if (m->says)
        printf("  %s %7.1f ms, of which setting positions %.1f\n", moves ? "moved" : "rest ", end - start, set - start);
    lmn_drawing_destroy(&drawing);
    return end - start;
}

static int compare_times(const void *a, const void *b)
{
    double p = *(const double *)a, q = *(const double *)b;
    return (p > q) - (p < q);
}

static void time_look(moved *m, const char *name)
{
    double    times[2][ROUNDS_MOST];
    lmn_look *look = NULL;
    lmn_error error;
    need(lmn_look_load(&look, name, &error), &error);
    for (int i = -WARM_UP; i < m->rounds; i++)
        for (int k = 1; k >= 0; k--) {
            double ms = time_frame(m, look, k, 0.1 * (i + WARM_UP));
            if (i >= 0)
                times[k][i] = ms;
        }
    for (int k = 0; k < 2; k++)
        qsort(times[k], (size_t)m->rounds, sizeof **times, compare_times);
    double rest = times[0][m->rounds / 2], moving = times[1][m->rounds / 2];
    printf("%-12s rest %7.1f ms, moved %7.1f ms: %.2f\n", name, rest, moving, moving / rest);
    fflush(stdout);
    lmn_look_destroy(&look);
}

int main(int argc, char **argv)
{
    static moved             m = {.rounds = 15};
    static const char *const standard[] = {"plain", "hatch", "edges", "line"};
    int                      at = 1;
    for (; at < argc && argv[at][0] == '-'; at++) {
        m.grid = m.grid || strcmp(argv[at], "-g") == 0;
        m.says = m.says || strcmp(argv[at], "-s") == 0;
        if (strcmp(argv[at], "-n") == 0 && at + 1 < argc)
            m.rounds = (int)strtol(argv[++at], NULL, 10);
    }
    if (m.rounds < 1 || m.rounds > ROUNDS_MOST) {
        fprintf(stderr, "moved: from 1 to %d rounds\n", ROUNDS_MOST);
        return 1;
    }
    open_scene(&m);
    for (int i = at; i < argc; i++)
        time_look(&m, argv[i]);
    for (size_t i = 0; i < sizeof standard / sizeof *standard && at == argc; i++)
        time_look(&m, standard[i]);
    lmn_scene_destroy(&m.scene);
    lmn_renderer_destroy(&m.renderer);
    return 0;
}
