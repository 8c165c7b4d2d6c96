/* limner bench: how long looks take, measured against `plain` in the same process. */
#include "cli.h"
#include "task.h"

#include <stdio.h>
#include <string.h>

typedef struct bench_values {
    word_list     looks;
    option_size   size;
    option_number repeat, time, deflection;
    const char   *clip, *lod;
    option_vector eye, target;
    int           view, up_axis;
    bool          orthographic, json, quiet;
    task_values   task;
} bench_values;

static const char *const views[] = {"iso", "front", "back", "left", "right", "top", "bottom", NULL};

#define AT(field) offsetof(bench_values, field)

static const option options[] = {
    {"look", 'l', OPTION_LIST, AT(looks), "NAME|FILE", "Look to measure; may be repeated. Default: all that ship."},
    {"size", 0, OPTION_SIZE, AT(size), "WxH", "Picture size in pixels. Default: 1024x1024.", 1, 16384},
    {"repeat", 0, OPTION_WHOLE, AT(repeat), "N", "Frames of each look; the median counts. Default: 9.", 1, 100000},
    {"view", 0, OPTION_CHOICE, AT(view), "VIEW", "iso, front, back, left, right, top or bottom. Default: iso.",
     .choices = views},
    {"eye", 0, OPTION_VECTOR, AT(eye), "X,Y,Z", "Where the viewer is, in the scene's unit."},
    {"target", 0, OPTION_VECTOR, AT(target), "X,Y,Z", "What the viewer looks at. Default: the scene's middle."},
    {"ortho", 0, OPTION_FLAG, AT(orthographic), NULL, "Parallel projection."},
    {"time", 0, OPTION_NUMBER, AT(time), "SECONDS", "The model as it is then.", 0, 1e6},
    {"clip", 0, OPTION_TEXT, AT(clip), "NAME|N", "Which animation. Default: the first of each file."},
    {"up-axis", 0, OPTION_CHOICE, AT(up_axis), "y|z", "Which of the file's axes points up.",
     .choices = up_axis_choices},
    LOD_OPTION(AT(lod)),
    DEFLECTION_OPTION(AT(deflection)),
    {"json", 0, OPTION_FLAG, AT(json), NULL, "Write JSON (docs/reference/bench.md)."},
    TASK_OPTIONS(bench_values),
    {"quiet", 'q', OPTION_FLAG, AT(quiet), NULL, "No progress."},
};

static void print_table(const json_t *root)
{
    const char   *name;
    json_t       *look, *pass;
    size_t        i;
    const json_t *size = json_object_get(root, "size");
    printf("%s, %.0f triangles, %.0f x %.0f pixels\n",
           text_at(json_object_get(root, "gpu"), "renderer", "unknown driver"), number_at(root, "triangles", 0),
           json_number_value(json_array_get(size, 0)), json_number_value(json_array_get(size, 1)));
    printf("\n%-20s %10s %8s %10s %8s  passes (CPU ms)\n%-20s %10.2f %8s %10.2f %8s\n", "look", "ms", "ratio", "CPU ms",
           "ratio", "plain", number_at(root, "plain_ms", 0), "1.00", number_at(root, "plain_cpu_ms", 0), "1.00");
    json_object_foreach(json_object_get(root, "looks"), name, look)
    {
        printf("%-20s %10.2f %8.2f %10.2f %8.2f ", name, number_at(look, "ms", 0), number_at(look, "ratio", 0),
               number_at(look, "cpu_ms", 0), number_at(look, "cpu_ratio", 0));
        json_array_foreach(json_object_get(look, "passes"), i, pass)
            printf(" %s %.2f", text_at(pass, "name", ""), number_at(pass, "cpu_ms", 0));
        printf("\n");
    }
}

static void place_view(const bench_values *v, const lmn_scene *scene, lmn_draw_desc *desc)
{
    lmn_scene_info info = lmn_scene_info_of(scene);
    if (v->view >= 0)
        desc->view = (lmn_view)v->view;
    desc->orthographic = v->orthographic;
    desc->clip = v->clip;
    desc->time_given = v->time.given;
    desc->time_s = v->time.given ? v->time.value : 0;
    desc->eye_given = v->eye.given;
    for (int i = 0; i < 3; i++) {
        desc->eye[i] = v->eye.value[i];
        desc->target[i] = v->target.given ? v->target.value[i] : (info.bounds_min[i] + info.bounds_max[i]) / 2;
    }
}

static int measure(const bench_values *v, const lmn_scene *scene, progress *bar, char **out)
{
    lmn_error         error = {0};
    lmn_renderer     *renderer = NULL;
    lmn_renderer_desc renderer_desc = LMN_RENDERER_DESC_INIT;
    lmn_draw_desc     desc = LMN_DRAW_DESC_INIT;
    word_list         all = {0};
    int               status = EXIT_DONE;
    for (size_t i = 0; i < lmn_look_count() && v->looks.count == 0 && status == EXIT_DONE; i++)
        if (!word_list_add(&all, lmn_look_name_at(i)))
            status = message_out_of_memory();
    const word_list *looks = v->looks.count ? &v->looks : &all;
    if (v->size.given) {
        desc.width = v->size.width;
        desc.height = v->size.height;
    }
    place_view(v, scene, &desc);
    desc.progress = progress_report;
    desc.progress_user = bar;
    bar->label = "measuring";
    if (status == EXIT_DONE) {
        lmn_status done = lmn_renderer_create(&renderer, &renderer_desc, &error);
        if (done == LMN_OK)
            done = lmn_bench_json(out, renderer, scene, looks->items, looks->count, &desc,
                                  v->repeat.given ? (int)v->repeat.value : 9, &error);
        progress_erase(bar);
        if (done != LMN_OK)
            status = message_error(&error);
    }
    lmn_renderer_destroy(&renderer);
    word_list_release(&all);
    return status;
}

static int run(const word_list *inputs, const void *values)
{
    const bench_values *v = values;
    const word_list     none = {0};
    lmn_scene          *scene = NULL;
    lmn_task           *task;
    char               *text = NULL;
    progress            bar;
    progress_begin(&bar, v->quiet);
    int status = task_begin(&task, &v->task, &bar);
    if (status == EXIT_DONE)
        status = scene_of_programs(&scene, inputs->items, inputs->count, up_axis_of(v->up_axis),
                                   &(program_options){&none, false, v->lod, NULL, 0, v->deflection.value}, &bar);
    if (status == EXIT_DONE)
        status = measure(v, scene, &bar, &text);
    lmn_scene_destroy(&scene);
    lmn_task_end(&task);
    if (status != EXIT_DONE)
        return status;
    if (v->json)
        return print_and_free(text);
    json_t *root = parse_and_free(text);
    if (!root)
        return EXIT_INTERNAL;
    print_table(root);
    json_decref(root);
    return EXIT_DONE;
}

const command command_bench = {
    .name = "bench",
    .inputs = "INPUT",
    .summary = "Measure looks against the plain one.",
    .options = options,
    .option_count = OPTION_COUNT(options),
    .values_size = sizeof(bench_values),
    .inputs_min = 1,
    .inputs_max = 1,
    .run = run,
};
