/* What telling takes, as library calls: a scene of 100 balls whose 1,000 activities are made and laid out by calls, and
 * 100 expressions of them, without texts, with 25 noises that are set for the first time, and told again with these.
 * Then, of models that are named, a drawing alone and a still, each of a scene that no one has drawn before, by a
 * renderer that has its programs: without the start of process and driver, with all that a picture needs.
 * depict [REPEAT [LOOK MODEL:SECONDS...]] prints the least CPU milliseconds of each, of all threads. */
#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "limner/limner.h"

enum { BALLS = 100, HOPS = 10, RINGS = 8, SIDES = 12 };

static double now_ms(void)
{
    struct timespec t;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t); /* others may be at work */
    return 1e3 * (double)t.tv_sec + 1e-6 * (double)t.tv_nsec;
}

static void check(lmn_status status, const lmn_error *error)
{
    if (status == LMN_OK)
        return;
    fprintf(stderr, "depict: %s\n", error->message);
    exit(1);
}

static uint32_t add_ball(lmn_scene *scene)
{
    static float    positions[(RINGS + 1) * SIDES * 3];
    static uint32_t indices[RINGS * SIDES * 6];
    const double    pi = acos(-1);
    for (int i = 0; i < (RINGS + 1) * SIDES; i++) {
        double up = pi * (i / SIDES) / RINGS, around = 2 * pi * (i % SIDES) / SIDES;
        positions[3 * i] = (float)(0.3 * sin(up) * cos(around));
        positions[3 * i + 1] = (float)(0.3 * cos(up));
        positions[3 * i + 2] = (float)(0.3 * sin(up) * sin(around));
    }
    for (uint32_t i = 0; i < RINGS * SIDES; i++) {
        uint32_t       next = i % SIDES == SIDES - 1 ? i + 1 - SIDES : i + 1;
        const uint32_t two[] = {i, next, next + SIDES, i, next + SIDES, i + SIDES};
        for (uint32_t k = 0; k < 6; k++)
            indices[6 * i + k] = two[k];
    }
    lmn_error     error = {0};
    uint32_t      mesh = 0;
    lmn_mesh_desc desc = LMN_MESH_DESC_INIT;
    desc.positions = positions;
    desc.vertex_count = (RINGS + 1) * SIDES;
    desc.indices = indices;
    desc.index_count = RINGS * SIDES * 6;
    check(lmn_scene_add_mesh(scene, &desc, &mesh, &error), &error);
    return mesh;
}

/* Ten hops, one after the other, each a fall that is thrown back. */
static uint32_t add_hops(lmn_scene *scene, uint32_t node, int which)
{
    lmn_error          error = {0};
    lmn_activity_child hops[HOPS] = {{0, 0, 0}};
    for (int i = 0; i < HOPS; i++) {
        lmn_constraint_desc hop = LMN_CONSTRAINT_DESC_INIT;
        hop.node = node;
        hop.map = LMN_TIME_MAP_BOUNCE;
        hop.start_given = true;
        hop.start[0] = 0.5 * i + 0.01 * which;
        hop.start[1] = 1;
        hop.start[2] = which;
        hop.velocity[0] = 1;
        hop.floor_height = 0.3;
        hop.duration_s = 0.5;
        check(lmn_behaviour_add_constraint(scene, &hop, &hops[i].activity, &error), &error);
    }
    lmn_activity_desc all = LMN_ACTIVITY_DESC_INIT;
    uint32_t          whole = 0;
    all.children = hops;
    all.child_count = HOPS;
    check(lmn_behaviour_add(scene, &all, &whole, &error), &error);
    return whole;
}

static double make(lmn_scene *scene)
{
    lmn_error error = {0};
    uint32_t  roots[BALLS], mesh = add_ball(scene);
    double    begin = now_ms();
    for (int i = 0; i < BALLS; i++) {
        char          name[16];
        uint32_t      node = 0;
        lmn_node_desc desc = LMN_NODE_DESC_INIT;
        snprintf(name, sizeof name, "ball %d", i);
        desc.name = name;
        desc.mesh = mesh;
        check(lmn_scene_add_node(scene, &desc, &node, &error), &error);
        roots[i] = add_hops(scene, node, i);
    }
    check(lmn_behaviour_play(scene, roots, BALLS, &error), &error);
    return now_ms() - begin;
}

static void write_expressions(char *out, size_t size, bool texts)
{
    static const char *const kinds[] = {"path", "motion", "still", "collision"};
    size_t                   used = 0;
    for (int i = 0; i < BALLS; i++) {
        char text[32] = "";
        if (i % 4 == 3)
            snprintf(text, sizeof text, texts ? ", \"text\": \"POW %d\"" : ", \"text\": \"\"", i);
        used +=
            (size_t)snprintf(out + used, size - used,
                             "%s{\"target\": \"ball %d\", \"depict\": \"%s\", \"from\": 1, \"to\": 2, \"now\": 1.6%s}",
                             i ? "," : "[", i, kinds[i % 4], text);
    }
    snprintf(out + used, size - used, "]");
}

static double tell(lmn_scene *scene, const lmn_draw_desc *draw, const char *expressions, double least)
{
    lmn_error       error = {0};
    lmn_depict_desc desc = LMN_DEPICT_DESC_INIT;
    const double    begin = now_ms();
    desc.expressions = expressions;
    check(lmn_depict(scene, draw, &desc, NULL, &error), &error);
    return fmin(now_ms() - begin, least);
}

typedef struct still_cost {
    double alone, told, drawn; /* least ms */
} still_cost;

/* Of the time since `*from`, what is less than before. */
static void take_time(double *least, double *from)
{
    const double now = now_ms();
    *least = fmin(*least, now - *from);
    *from = now;
}

static void measure_once(still_cost *out, lmn_renderer *renderer, const lmn_look *look, const char *path,
                         const lmn_draw_desc *desc)
{
    lmn_error error = {0};
    for (int still = 0; still < 2; still++) {
        lmn_scene   *scene = NULL;
        lmn_drawing *drawing = NULL;
        check(lmn_scene_create(&scene, &error), &error);
        check(lmn_scene_add_file(scene, path, NULL, &error), &error);
        double begin = now_ms();
        if (still) {
            lmn_depict_desc told = LMN_DEPICT_DESC_INIT;
            check(lmn_depict(scene, desc, &told, NULL, &error), &error);
            take_time(&out->told, &begin);
        }
        check(lmn_draw(&drawing, renderer, scene, look, desc, &error), &error);
        take_time(still ? &out->drawn : &out->alone, &begin);
        lmn_drawing_destroy(&drawing);
        lmn_scene_destroy(&scene);
    }
}

/* `name` is MODEL:SECONDS. */
static void measure_still(lmn_renderer *renderer, const lmn_look *look, const char *name, int repeat)
{
    char          path[256];
    const char   *colon = strrchr(name, ':');
    still_cost    cost = {INFINITY, INFINITY, INFINITY};
    lmn_draw_desc desc = LMN_DRAW_DESC_INIT;
    snprintf(path, sizeof path, "%.*s", colon ? (int)(colon - name) : (int)strlen(name), name);
    desc.time_given = true;
    desc.time_s = colon ? atof(colon + 1) : 0;
    for (int i = -1; i < repeat; i++) { /* the first one makes the programs */
        measure_once(&cost, renderer, look, path, &desc);
        if (i < 0)
            cost = (still_cost){INFINITY, INFINITY, INFINITY};
    }
    printf("%-32s alone %6.1f ms, still %6.1f ms (told %.1f, drawn %.1f): %.2f times\n", path, cost.alone,
           cost.told + cost.drawn, cost.told, cost.drawn, (cost.told + cost.drawn) / cost.alone);
}

static void measure_stills(int count, char **arguments, int repeat)
{
    lmn_error     error = {0};
    lmn_renderer *renderer = NULL;
    lmn_look     *look = NULL;
    check(lmn_renderer_create(&renderer, NULL, &error), &error);
    check(lmn_look_load(&look, arguments[0], &error), &error);
    for (int i = 1; i < count; i++)
        measure_still(renderer, look, arguments[i], repeat);
    lmn_look_destroy(&look);
    lmn_renderer_destroy(&renderer);
}

static void measure_expressions(int repeat)
{
    static char   expressions[BALLS * 128], noisy[BALLS * 128];
    lmn_error     error = {0};
    lmn_draw_desc draw = LMN_DRAW_DESC_INIT;
    double        least = INFINITY, made = INFINITY, told = INFINITY, first = INFINITY, again = INFINITY;
    write_expressions(expressions, sizeof expressions, false);
    write_expressions(noisy, sizeof noisy, true);
    draw.time_given = true;
    draw.time_s = 1.6;
    for (int i = 0; i < repeat; i++) {
        lmn_scene *scene = NULL;
        check(lmn_scene_create(&scene, &error), &error);
        made = fmin(make(scene), made);
        least = tell(scene, &draw, expressions, least);
        first = tell(scene, &draw, noisy, first);
        again = tell(scene, &draw, noisy, again);
        const double begin = now_ms();
        lmn_text_free(lmn_scene_dynamics_json(scene));
        told = fmin(now_ms() - begin, told);
        lmn_scene_destroy(&scene);
    }
    printf("1,000 activities made and laid out: %.1f ms\n100 expressions of them:            %.1f ms\n"
           "  with 25 new noises:               %.1f ms\n  told again with these:            %.1f ms\n"
           "what happens as JSON:               %.1f ms\n",
           made, least, first, again, told);
}

int main(int count, char **arguments)
{
    const int repeat = count > 1 ? atoi(arguments[1]) : 10;
    if (count > 3)
        measure_stills(count - 2, arguments + 2, repeat);
    else
        measure_expressions(repeat);
    return 0;
}
