/* What strokes on a surface take, by how they are drawn: marks MODEL SIZE COUNT draws MODEL again and again with the
 * technique `strokes`, and prints a row a way: least and median CPU milliseconds of a frame beyond those of the same
 * frame without strokes, pieces of strokes that were drawn, megabytes on the GPU. Rows EX-11, EX-13, EX-29, EX-30. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "measure.h"

enum { FRAMES = 15, WARM = 2, SETTINGS = 4 };

typedef struct way {
    const char *name, *settings[SETTINGS][2];
} way;

/* What is left out by the ways of row EX-13 is never left out before it is drawn. */
static const way ways[] = {
    {"no strokes", {{"surface.count", "1"}}},
    {"quads, cull", {{NULL}}},
    {"quads, no cull", {{"surface.cull", "false"}}},
    {"packed", {{"surface.layout", "packed"}, {"surface.cull", "false"}}},
    {"instances", {{"surface.layout", "instances"}, {"surface.cull", "false"}}},
    {"lines", {{"surface.primitive", "lines"}, {"surface.cull", "false"}}},
    {"lines, packed", {{"surface.primitive", "lines"}, {"surface.layout", "packed"}, {"surface.cull", "false"}}},
    {"lines, instances", {{"surface.primitive", "lines"}, {"surface.layout", "instances"}, {"surface.cull", "false"}}},
    {"hiding: outside", {{"surface.hiding", "outside"}, {"surface.cull", "false"}}},
    {"hiding: winding", {{"surface.hiding", "winding"}, {"surface.cull", "false"}}},
    {"hiding: width", {{"surface.hiding", "width"}, {"surface.cull", "false"}}},
    {"hiding: depth", {{"surface.hiding", "depth"}, {"surface.cull", "false"}}},
    {"hiding: discard", {{"surface.hiding", "discard"}, {"surface.cull", "false"}}},
    {"hiding: alpha", {{"surface.hiding", "alpha"}, {"surface.cull", "false"}}},
};

/* The first number behind a key in what the report says of marks. */
static double number_of(const char *json, const char *key)
{
    const char *marks = strstr(json, "\"surface_marks\""), *at = marks ? strstr(marks, key) : NULL;
    return at ? strtod(at + strlen(key), NULL) : 0;
}

/* Returns the least CPU milliseconds. */
static double measure(lmn_scene *scene, lmn_renderer *renderer, const way *w, int size, const char *count,
                      double without)
{
    lmn_error     error = {0};
    lmn_look     *look;
    lmn_draw_desc desc = LMN_DRAW_DESC_INIT;
    double        cpu[FRAMES], drawn = 0, bytes = 0;
    const char   *json =
        "{\"version\":2,\"name\":\"marks\",\"doc\":\"Marks.\",\"rules\":[{\"select\":\"*\",\"surface\":"
        "{\"technique\":\"strokes\",\"placed\":\"planes\",\"width\":1,\"length\":0.02},\"lines\":\"none\"}]}";
    must(lmn_look_parse(&look, json, "marks", &error), &error);
    must(lmn_look_set(look, "surface.count", count, &error), &error);
    for (int i = 0; i < SETTINGS && w->settings[i][0]; i++)
        must(lmn_look_set(look, w->settings[i][0], w->settings[i][1], &error), &error);
    desc.width = desc.height = size;
    desc.samples = 1;
    for (int i = -WARM; i < FRAMES; i++) {
        lmn_drawing *drawing = NULL;
        double       before = measure_ms(CLOCK_PROCESS_CPUTIME_ID);
        must(lmn_draw(&drawing, renderer, scene, look, &desc, &error), &error);
        if (i >= 0)
            cpu[i] = measure_ms(CLOCK_PROCESS_CPUTIME_ID) - before;
        char *report = lmn_drawing_report_json(drawing);
        drawn = number_of(report, "\"drawn\":");
        bytes = number_of(report, "\"bytes\":");
        lmn_text_free(report);
        lmn_drawing_destroy(&drawing);
    }
    qsort(cpu, FRAMES, sizeof *cpu, measure_compare);
    printf("  %-18s %7.1f %7.1f %9.0f %7.1f\n", w->name, cpu[0] - without, cpu[FRAMES / 2] - without, drawn,
           1e-6 * bytes);
    lmn_look_destroy(&look);
    return cpu[0];
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
    printf("%s, %s strokes asked for\n", argv[1], argv[3]);
    double without = 0;
    for (size_t i = 0; i < sizeof ways / sizeof *ways; i++) {
        double least = measure(scene, renderer, &ways[i], atoi(argv[2]), argv[3], without);
        without = i == 0 ? least : without;
    }
    lmn_renderer_destroy(&renderer);
    lmn_scene_destroy(&scene);
    return 0;
}
