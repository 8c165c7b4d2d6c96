/* What a frame takes after an edit: edits MODEL.csg SIZE LOOK... moves the first leaf of the first solid a little from
 * frame to frame and draws; prints a row a look: least and median CPU milliseconds, median wall milliseconds, frames a
 * second. The time of an edit itself is in it. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "measure.h"

enum { FRAMES = 12, WARM = 2 };

static uint32_t first_leaf(const lmn_scene *scene, uint32_t solid, lmn_solid_info *info)
{
    uint32_t node = LMN_SOLID_ROOT;
    while (lmn_solid_info_of(scene, solid, node, info) && info->child_count > 0)
        node = info->first_child;
    return node;
}

static void measure(lmn_scene *scene, lmn_renderer *renderer, const char *name, int size)
{
    lmn_error      error = {0};
    lmn_look      *look;
    lmn_solid_info info;
    lmn_draw_desc  desc = LMN_DRAW_DESC_INIT;
    double         cpu[FRAMES], wall[FRAMES];
    uint32_t       solid = lmn_scene_solid_at(scene, 0), leaf = first_leaf(scene, solid, &info);
    must(lmn_look_load(&look, name, &error), &error);
    desc.width = desc.height = size;
    desc.samples = 1;
    for (int i = -WARM; i < FRAMES; i++) {
        lmn_drawing *drawing = NULL;
        double matrix[16], cpu_before = measure_ms(CLOCK_PROCESS_CPUTIME_ID), before = measure_ms(CLOCK_MONOTONIC);
        for (int k = 0; k < 16; k++)
            matrix[k] = info.matrix[k];
        matrix[12] += 2 * sin(0.4 * i);
        must(lmn_solid_set_matrix(scene, solid, leaf, matrix, &error), &error);
        must(lmn_draw(&drawing, renderer, scene, look, &desc, &error), &error);
        if (i >= 0) {
            cpu[i] = measure_ms(CLOCK_PROCESS_CPUTIME_ID) - cpu_before;
            wall[i] = measure_ms(CLOCK_MONOTONIC) - before;
        }
        lmn_drawing_destroy(&drawing);
    }
    must(lmn_solid_set_matrix(scene, solid, leaf, info.matrix, &error), &error);
    qsort(cpu, FRAMES, sizeof *cpu, measure_compare);
    qsort(wall, FRAMES, sizeof *wall, measure_compare);
    printf("  %-18s %7.1f %7.1f %7.1f %7.1f\n", name, cpu[0], cpu[FRAMES / 2], wall[FRAMES / 2],
           1e3 / wall[FRAMES / 2]);
    lmn_look_destroy(&look);
}

int main(int argc, char **argv)
{
    lmn_error     error = {0};
    lmn_scene    *scene;
    lmn_renderer *renderer;
    if (argc < 4)
        return 1;
    must(lmn_scene_create(&scene, &error), &error);
    must(lmn_scene_add_file(scene, argv[1], NULL, &error), &error);
    must(lmn_renderer_create(&renderer, NULL, &error), &error);
    setvbuf(stdout, NULL, _IOLBF, 0);
    printf("%s\n", argv[1]);
    for (int i = 3; i < argc; i++)
        measure(scene, renderer, argv[i], atoi(argv[2]));
    lmn_renderer_destroy(&renderer);
    lmn_scene_destroy(&scene);
    return 0;
}
