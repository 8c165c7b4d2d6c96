/* What finding the lines of a vector drawing takes, as a library call: CPU and wall seconds of lmn_draw_sheet with
 * the look `technical`, the scene loaded. strokes REPEAT MODEL... prints a row a model: triangles, least CPU and
 * wall seconds, visible and hidden strokes, samples that --verify found wrong. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "limner/limner.h"

static double seconds(clockid_t clock)
{
    struct timespec t;
    clock_gettime(clock, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

static void fail(const lmn_error *error)
{
    fprintf(stderr, "strokes: %s %s\n", error->file, error->message);
    exit(1);
}

/* The first number behind a key of the report. */
static double number_of(const char *json, const char *key)
{
    const char *at = strstr(json, key);
    return at ? strtod(at + strlen(key), NULL) : -1;
}

int main(int argc, char **argv)
{
    lmn_error error = {0};
    lmn_look *look;
    if (argc < 3 || lmn_look_load(&look, "technical", &error) != LMN_OK)
        return 1;
    for (int i = 2; i < argc; i++) {
        lmn_scene     *scene;
        lmn_sheet     *sheet = NULL;
        lmn_load_desc  load = LMN_LOAD_DESC_INIT;
        lmn_draw_desc  draw = LMN_DRAW_DESC_INIT;
        lmn_sheet_desc desc = LMN_SHEET_DESC_INIT;
        if (lmn_scene_create(&scene, &error) != LMN_OK || lmn_scene_add_file(scene, argv[i], &load, &error) != LMN_OK)
            fail(&error);
        draw.orthographic = true;
        double cpu = 1e9, wall = 1e9;
        for (int k = 0; k < atoi(argv[1]); k++) {
            double cpu_before = seconds(CLOCK_PROCESS_CPUTIME_ID), wall_before = seconds(CLOCK_MONOTONIC);
            if (lmn_draw_sheet(&sheet, NULL, scene, look, &draw, &desc, &error) != LMN_OK)
                fail(&error);
            double cpu_now = seconds(CLOCK_PROCESS_CPUTIME_ID) - cpu_before,
                   wall_now = seconds(CLOCK_MONOTONIC) - wall_before;
            cpu = cpu_now < cpu ? cpu_now : cpu;
            wall = wall_now < wall ? wall_now : wall;
            lmn_sheet_destroy(&sheet);
        }
        desc.verify = true;
        if (lmn_draw_sheet(&sheet, NULL, scene, look, &draw, &desc, &error) != LMN_OK)
            fail(&error);
        char       *report = lmn_sheet_report_json(sheet);
        const char *name = strrchr(argv[i], '/') ? strrchr(argv[i], '/') + 1 : argv[i];
        double      all = number_of(report, "\"contour\":") + number_of(report, "\"crease\":");
        printf("%-22s %9llu triangles  %.3f CPU s  %.3f wall s  %.0f contours and creases  %.0f hidden  %.0f of %.0f "
               "samples wrong\n",
               name, (unsigned long long)lmn_scene_info_of(scene).triangles, cpu, wall, all,
               number_of(report, "\"hidden_strokes\":"), number_of(report, "\"wrong\":"),
               number_of(report, "\"samples\":"));
        lmn_text_free(report);
        lmn_sheet_destroy(&sheet);
        lmn_scene_destroy(&scene);
    }
    lmn_look_destroy(&look);
    return 0;
}
