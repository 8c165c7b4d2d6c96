/* limner info: what is in a model. */
#include "cli.h"
#include "task.h"

#include <stdio.h>
#include <string.h>

typedef struct info_values {
    bool          json, dynamics, strict;
    const char   *lod, *terrain;
    option_number populate, deflection;
    int           up_axis;
    word_list     defines;
    task_values   task;
} info_values;

static const option options[] = {
    {"json", 0, OPTION_FLAG, offsetof(info_values, json), NULL, "Write JSON (docs/reference/info.md)."},
    {"dynamics", 0, OPTION_FLAG, offsetof(info_values, dynamics), NULL,
     "Tell what happens instead: what drives what, when, and where it goes."},
    TASK_OPTIONS(info_values),
    {"up-axis", 0, OPTION_CHOICE, offsetof(info_values, up_axis), "y|z", "Which of the file's axes points up.",
     .choices = up_axis_choices},
    LOD_OPTION(offsetof(info_values, lod)),
    TERRAIN_OPTION(offsetof(info_values, terrain)),
    POPULATE_OPTION(offsetof(info_values, populate)),
    DEFLECTION_OPTION(offsetof(info_values, deflection)),
    {"define", 'D', OPTION_LIST, offsetof(info_values, defines), "NAME=VALUE",
     "Of OpenSCAD programs (.scad): a variable's value instead of the program's. May be repeated."},
    {"strict", 0, OPTION_FLAG, offsetof(info_values, strict), NULL, "Of OpenSCAD programs: warnings are errors."},
};

/* Of city data: where it lies, what there is, what is left out. */
static void print_city(const json_t *city)
{
    static const char *const groups[] = {"objects", "lods", "surfaces", "skipped", "repaired"};
    const json_t            *origin = json_object_get(city, "origin");
    if (json_array_size(origin) == 3)
        printf("origin      %.9g %.9g %.9g  %s\n", json_number_value(json_array_get(origin, 0)),
               json_number_value(json_array_get(origin, 1)), json_number_value(json_array_get(origin, 2)),
               text_at(city, "crs", "(no coordinate system)"));
    for (size_t i = 0; i < sizeof groups / sizeof *groups; i++) {
        json_t     *group = json_object_get(city, groups[i]), *count;
        const char *name, *between = "";
        if (json_object_size(group) == 0)
            continue;
        printf("%-12s", groups[i]);
        json_object_foreach(group, name, count)
        {
            printf("%s%s %.0f", between, name, json_number_value(count));
            between = ", ";
        }
        printf("\n");
    }
}

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
    printf("%sbounds      %.6g %.6g %.6g  to  %.6g %.6g %.6g  (%.6g x %.6g x %.6g)\n", indent, l[0], l[1], l[2], h[0],
           h[1], h[2], h[0] - l[0], h[1] - l[1], h[2] - l[2]);
}

/* "materials   2: steel, glass" */
static void print_names(const json_t *root, const char *key)
{
    const json_t *list = json_object_get(root, key), *item;
    size_t        i;
    if (json_array_size(list) == 0)
        return;
    printf("%-11s %zu: ", key, json_array_size(list));
    json_array_foreach((json_t *)list, i, item) printf("%s%s", i ? ", " : "", text_at(item, "name", "(no name)"));
    printf("\n");
}

/* "animations  2: 1 walk (1.5 s, 19 nodes), 2 zoom (3 s, 1 camera)" */
static void print_animations(const json_t *list)
{
    static const char *const things[][3] = {{"nodes", "node", "nodes"},
                                            {"weights", "node's weights", "nodes' weights"},
                                            {"cameras", "camera", "cameras"},
                                            {"lights", "light", "lights"}};
    const json_t            *item;
    size_t                   i;
    if (json_array_size(list) > 0)
        printf("%-11s %zu: ", "animations", json_array_size(list));
    json_array_foreach((json_t *)list, i, item)
    {
        const json_t *moves = json_object_get(item, "moves");
        printf("%s%.0f %s (%.3g s", i ? ", " : "", number_at(item, "id", 0), text_at(item, "name", "(no name)"),
               number_at(item, "duration", 0));
        for (size_t k = 0; k < sizeof things / sizeof *things; k++) {
            double count = number_at(moves, things[k][0], 0);
            if (count > 0)
                printf(", %.0f %s", count, things[k][count == 1 ? 1 : 2]);
        }
        printf(")");
    }
    if (json_array_size(list) > 0)
        printf("\n");
}

/* A tree in a table is a sketch of it; --json has more. */
enum { TREE_LEVELS = 6, TREE_SIBLINGS = 12 };

static bool is_same_operand(const json_t *a, const json_t *b)
{
    return strcmp(text_at(a, "kind", ""), "operand") == 0 && strcmp(text_at(b, "kind", ""), "operand") == 0 &&
           strcmp(text_at(a, "name", ""), text_at(b, "name", "")) == 0;
}

/* The tree as lines, indented by level; siblings that say the same are counted. */
static void print_tree(const json_t *node, int level, size_t count)
{
    const json_t *children = json_object_get(node, "children");
    const char   *kind = text_at(node, "kind", ""), *name = text_at(node, "name", "");
    double        line = number_at(node, "line", 0);
    printf("%29s%*s%s", "", 2 * level, "", kind);
    if (*name && strcmp(name, kind) != 0)
        printf(" %s", name);
    if (count > 1)
        printf(" x %zu", count);
    if (line > 0)
        printf("  (line %.0f)", line);
    printf("\n");
    if (level >= TREE_LEVELS && json_array_size(children) > 0) {
        printf("%29s%*s…\n", "", 2 * level + 2, "");
        return;
    }
    size_t i = 0, shown = 0, total = json_array_size(children);
    for (; i < total && shown < TREE_SIBLINGS; shown++) {
        const json_t *child = json_array_get(children, i);
        size_t        same = 1;
        while (i + same < total && is_same_operand(child, json_array_get(children, i + same)))
            same++;
        print_tree(child, level + 1, same);
        i += same;
    }
    if (i < total || number_at(node, "omitted", 0) > 0)
        printf("%29s%*s… %.0f more\n", "", 2 * level + 2, "", (double)(total - i) + number_at(node, "omitted", 0));
}

static void print_solid(const json_t *solid)
{
    const json_t *operations = json_object_get(solid, "operations");
    printf("%29ssolid: %.0f operands, %.0f unions, %.0f intersections, %.0f differences, %.0f levels, ", "",
           number_at(solid, "operands", 0), number_at(operations, "union", 0), number_at(operations, "intersection", 0),
           number_at(operations, "difference", 0), number_at(solid, "depth", 0));
    if (json_is_integer(json_object_get(solid, "products")))
        printf("%.0f products\n", number_at(solid, "products", 0));
    else
        printf("more than 4096 products\n");
    print_tree(json_object_get(solid, "tree"), 1, 1);
}

static void print_part(const json_t *part)
{
    const json_t *materials = json_object_get(part, "materials"), *item;
    size_t        i;
    printf("%5.0f  %9.0f  %9.0f  %s", number_at(part, "id", 0), number_at(part, "triangles", 0),
           number_at(part, "instances", 1), text_at(part, "path", text_at(part, "name", "")));
    json_array_foreach((json_t *)materials, i, item)
        printf("%s%s", i ? ", " : "  [", json_is_string(item) ? json_string_value(item) : "(no name)");
    printf("%s\n", json_array_size(materials) ? "]" : "");
    const char *key;
    json_t     *value;
    json_object_foreach(json_object_get(part, "attributes"), key, value)
        printf("%29s%s = %s\n", "", key, json_is_string(value) ? json_string_value(value) : "");
    if (json_object_get(part, "solid"))
        print_solid(json_object_get(part, "solid"));
}

/* What solids take away: one line each, since most of it stands in their trees. */
static void print_removed(const json_t *removed)
{
    const json_t *item;
    size_t        i;
    if (json_array_size(removed) > 0)
        printf("\nremoved (drawn where a look selects @removed)\n");
    json_array_foreach((json_t *)removed, i, item)
        printf("%5.0f  %9.0f  %9.0f  %s\n", number_at(item, "id", 0), number_at(item, "triangles", 0),
               number_at(item, "instances", 1), text_at(item, "path", ""));
}

static void print_table(const json_t *root)
{
    const json_t *parts = json_object_get(root, "parts"), *item;
    size_t        i;
    printf("up axis     %s\n", text_at(root, "up", "y"));
    printf("parts       %zu\n", json_array_size(parts));
    printf("triangles   %.0f\n", number_at(root, "triangles", 0));
    if (number_at(root, "lines", 0) > 0)
        printf("lines       %.0f\n", number_at(root, "lines", 0));
    print_bounds(json_object_get(root, "bounds"), "");
    print_city(json_object_get(root, "city"));
    print_animations(json_object_get(root, "animations"));
    print_names(root, "materials");
    print_names(root, "textures");
    print_names(root, "cameras");
    print_names(root, "lights");
    print_names(root, "skins");
    printf("\n   id  triangles  instances  part\n");
    json_array_foreach((json_t *)parts, i, item) print_part(item);
    print_removed(json_object_get(root, "removed"));
    json_array_foreach(json_object_get(root, "warnings"), i, item)
        message_warning(text_at(item, "text", ""), (size_t)number_at(item, "count", 1));
}

/* "ball  green  0 s to 4 s: translation (bounce)" */
static void print_dynamics(const json_t *root)
{
    const json_t *node, *one;
    size_t        i, k;
    printf("duration    %.6g s\n", number_at(root, "duration", 0));
    json_array_foreach(json_object_get(root, "nodes"), i, node)
    {
        printf("%-11s %s\n", text_at(node, "semantics", "-"), text_at(node, "node", "(no name)"));
        json_array_foreach(json_object_get(node, "constraints"), k, one)
            printf("%12s%.6g s to %.6g s: %s (%s)\n", "", number_at(one, "from", 0), number_at(one, "to", 0),
                   text_at(one, "property", text_at(one, "name", "event")), text_at(one, "map", "event"));
    }
}

static int tell(const word_list *inputs, const info_values *v, progress *bar)
{
    lmn_scene            *scene = NULL;
    const program_options programs = {&v->defines, v->strict,         v->lod,
                                      v->terrain,  v->populate.value, v->deflection.value};
    int                   status = check_programs(inputs, &programs);
    if (status == EXIT_DONE)
        status = scene_of_programs(&scene, inputs->items, inputs->count, up_axis_of(v->up_axis), &programs, bar);
    if (status != EXIT_DONE)
        return status;
    char *text = v->dynamics ? lmn_scene_dynamics_json(scene) : lmn_scene_info_json(scene);
    if (v->json) {
        status = print_and_free(text);
    } else {
        json_t *root = parse_and_free(text);
        status = root ? EXIT_DONE : EXIT_INTERNAL;
        if (root)
            (v->dynamics ? print_dynamics : print_table)(root);
        json_decref(root);
    }
    lmn_scene_destroy(&scene);
    return status;
}

static int run(const word_list *inputs, const void *values)
{
    const info_values *v = values;
    lmn_task          *task;
    progress           bar;
    progress_begin(&bar, v->json);
    int status = task_begin(&task, &v->task, &bar);
    if (status == EXIT_DONE)
        status = tell(inputs, v, &bar);
    lmn_task_end(&task);
    return status;
}

const command command_info = {
    .name = "info",
    .inputs = "INPUT…",
    .summary = "Tell what is in a model: parts, triangles, bounds, animations.",
    .options = options,
    .option_count = OPTION_COUNT(options),
    .values_size = sizeof(info_values),
    .inputs_min = 1,
    .inputs_max = (size_t)-1,
    .run = run,
};
