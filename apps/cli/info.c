/* limner info: what is in a model. */
#include "cli.h"

#include <stdio.h>
#include <string.h>

typedef struct info_values {
    bool json;
    int  up_axis;
} info_values;

static const option options[] = {
    {"json", 0, OPTION_FLAG, offsetof(info_values, json), NULL, "Write JSON (docs/reference/info.md)."},
    {"up-axis", 0, OPTION_CHOICE, offsetof(info_values, up_axis), "y|z", "Which of the file's axes points up.",
     .choices = up_axis_choices},
};

static void print_bounds(const json_t *bounds, const char *indent)
{
    const json_t *low = json_object_get(bounds, "min"), *high = json_object_get(bounds, "max");
    if (json_array_size(low) != 3 || json_array_size(high) != 3)
        return;
    double l[3], h[3];
    for (size_t i = 0; i < 3; i++) {
        l[i] = json_number_value(json_array_get(low, i));
        h[i] = json_number_value(json_array_get(high, i));
    }
    printf("%sbounds      %.6g %.6g %.6g  to  %.6g %.6g %.6g  (%.6g x %.6g x %.6g)\n", indent, l[0], l[1], l[2], h[0], h[1], h[2],
           h[0] - l[0], h[1] - l[1], h[2] - l[2]);
}

/* "animations  2: walk (1.5 s), run" */
static void print_names(const json_t *root, const char *key)
{
    const json_t *list = json_object_get(root, key), *item;
    size_t i;
    if (json_array_size(list) == 0)
        return;
    printf("%-11s %zu: ", key, json_array_size(list));
    json_array_foreach ((json_t *)list, i, item) {
        printf("%s%s", i ? ", " : "", text_at(item, "name", "(no name)"));
        if (json_object_get(item, "duration"))
            printf(" (%.3g s)", number_at(item, "duration", 0));
    }
    printf("\n");
}

static void print_part(const json_t *part)
{
    const json_t *materials = json_object_get(part, "materials"), *item;
    size_t i;
    printf("%5.0f  %9.0f  %9.0f  %s", number_at(part, "id", 0), number_at(part, "triangles", 0), number_at(part, "instances", 1),
           text_at(part, "path", text_at(part, "name", "")));
    json_array_foreach ((json_t *)materials, i, item)
        printf("%s%s", i ? ", " : "  [", json_is_string(item) ? json_string_value(item) : "(no name)");
    printf("%s\n", json_array_size(materials) ? "]" : "");
    const char *key;
    json_t *value;
    json_object_foreach (json_object_get(part, "attributes"), key, value)
        printf("%29s%s = %s\n", "", key, json_is_string(value) ? json_string_value(value) : "");
}

static void print_table(const json_t *root)
{
    const json_t *parts = json_object_get(root, "parts"), *item;
    size_t i;
    printf("up axis     %s\n", text_at(root, "up", "y"));
    printf("parts       %zu\n", json_array_size(parts));
    printf("triangles   %.0f\n", number_at(root, "triangles", 0));
    print_bounds(json_object_get(root, "bounds"), "");
    print_names(root, "animations");
    print_names(root, "materials");
    print_names(root, "textures");
    print_names(root, "cameras");
    print_names(root, "lights");
    print_names(root, "skins");
    printf("\n   id  triangles  instances  part\n");
    json_array_foreach ((json_t *)parts, i, item)
        print_part(item);
    json_array_foreach (json_object_get(root, "warnings"), i, item)
        message_warning(text_at(item, "text", ""), (size_t)number_at(item, "count", 1));
}

static int run(const word_list *inputs, const void *values)
{
    const info_values *v = values;
    lmn_scene *scene = NULL;
    progress bar;
    progress_begin(&bar, v->json);
    int status = scene_of_files(&scene, inputs->items, inputs->count, up_axis_of(v->up_axis), &bar);
    if (status != EXIT_DONE)
        return status;
    char *text = lmn_scene_info_json(scene);
    if (v->json) {
        status = print_and_free(text);
    } else {
        json_t *root = parse_and_free(text);
        status = root ? EXIT_DONE : EXIT_INTERNAL;
        if (root)
            print_table(root);
        json_decref(root);
    }
    lmn_scene_destroy(&scene);
    return status;
}

const command command_info = {
    .name = "info", .inputs = "INPUT…", .summary = "Tell what is in a model: parts, triangles, bounds, animations.",
    .options = options, .option_count = OPTION_COUNT(options), .values_size = sizeof(info_values),
    .inputs_min = 1, .inputs_max = (size_t)-1, .run = run,
};
