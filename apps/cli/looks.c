/* limner looks: the looks that ship and what can be set in them. */
#include "cli.h"

#include <stdio.h>
#include <string.h>

typedef struct looks_values {
    bool json, markdown, depictions;
} looks_values;

static const option options[] = {
    {"json", 0, OPTION_FLAG, offsetof(looks_values, json), NULL, "Write JSON (docs/reference/looks.md)."},
    {"markdown", 0, OPTION_FLAG, offsetof(looks_values, markdown), NULL,
     "Write the reference page of all looks and techniques."},
    {"depictions", 0, OPTION_FLAG, offsetof(looks_values, depictions), NULL,
     "Write the reference page of all ways to depict what happens (`limner depict`)."},
};

enum { TEXT_SIZE = 256 };

/* A value as people write it after --set: without quotes and brackets. */
static void print_value(const json_t *value, const char *separator, char out[TEXT_SIZE])
{
    size_t  length = 0, i;
    json_t *item;
    out[0] = '\0';
    if (json_is_string(value)) {
        snprintf(out, TEXT_SIZE, "%s", json_string_value(value));
    } else if (json_is_boolean(value)) {
        snprintf(out, TEXT_SIZE, "%s", json_is_true(value) ? "true" : "false");
    } else if (json_is_number(value)) {
        snprintf(out, TEXT_SIZE, "%.6g", json_number_value(value));
    }
    json_array_foreach(value, i, item)
    {
        char one[TEXT_SIZE];
        print_value(item, separator, one);
        int written = snprintf(out + length, TEXT_SIZE - length, "%s%s", i ? separator : "", one);
        if (written < 0 || (size_t)written >= TEXT_SIZE - length)
            return;
        length += (size_t)written;
    }
}

/* "0.5 to 32 px", "none, double", "true, false", "a colour" … */
static void print_allowed(const json_t *p, char out[TEXT_SIZE])
{
    const char *type = text_at(p, "type", "");
    const char *unit = text_at(p, "unit", ""), *or_auto = json_is_true(json_object_get(p, "auto")) ? ", auto" : "";
    bool        shown = strcmp(unit, "pt") == 0 || strcmp(unit, "deg") == 0;
    const char *form = strcmp(type, "bool") == 0        ? "true, false"
                       : strcmp(type, "direction") == 0 ? "X,Y,Z"
                       : strcmp(type, "palette") == 0   ? "colours with commas"
                                                        : type;
    if (json_object_get(p, "min"))
        snprintf(out, TEXT_SIZE, "%.6g to %.6g%s%s%s", number_at(p, "min", 0), number_at(p, "max", 0), shown ? " " : "",
                 shown ? unit : "", or_auto);
    else if (json_object_get(p, "values"))
        print_value(json_object_get(p, "values"), ", ", out);
    else
        snprintf(out, TEXT_SIZE, "%s%s", form, or_auto);
}

static void print_use(const json_t *use)
{
    size_t  i;
    json_t *p;
    printf("\n  %s: %s. %s\n", text_at(use, "kind", ""), text_at(use, "technique", ""), text_at(use, "doc", ""));
    json_array_foreach(json_object_get(use, "parameters"), i, p)
    {
        char value[TEXT_SIZE], allowed[TEXT_SIZE], standard[TEXT_SIZE];
        print_value(json_object_get(p, "value"), ",", value);
        print_value(json_object_get(p, "default"), ",", standard);
        print_allowed(p, allowed);
        bool changed = strcmp(value, standard) != 0;
        printf("    %-26s = %-10s  (%s%s%s)\n%33s%s\n", text_at(p, "name", ""), value, allowed,
               changed ? "; default " : "", changed ? standard : "", "", text_at(p, "doc", ""));
    }
}

static void print_controls(const json_t *controls)
{
    size_t  i, k;
    json_t *control, *map;
    if (json_array_size(controls))
        printf("\n  controls: -1 to 1, 0 is the look as it is. --set weight=0.5\n");
    json_array_foreach(controls, i, control)
    {
        printf("    %-26s = %-10g  (", text_at(control, "name", ""), number_at(control, "value", 0));
        json_array_foreach(json_object_get(control, "maps"), k, map)
            printf("%s%s %s", k ? "; " : "", text_at(map, "param", ""), text_at(map, "change", ""));
        printf(")\n%33s%s\n", "", text_at(control, "doc", ""));
    }
}

static void print_look(const json_t *root)
{
    size_t  i, k;
    json_t *rule, *use;
    printf("%s: %s\n", text_at(root, "name", ""), text_at(root, "doc", ""));
    print_controls(json_object_get(root, "controls"));
    json_array_foreach(json_object_get(root, "uses"), k, use) print_use(use);
    json_array_foreach(json_object_get(root, "rules"), i, rule)
    {
        if (json_array_size(json_object_get(root, "rules")) > 1)
            printf("\n  rule %s for %s\n", text_at(rule, "name", "without name"), text_at(rule, "select", "*"));
        json_array_foreach(json_object_get(rule, "uses"), k, use) print_use(use);
    }
}

static void print_list(const json_t *root)
{
    size_t  i;
    json_t *look;
    json_array_foreach(json_object_get(root, "looks"), i, look)
        printf("%-18s %s\n", text_at(look, "name", ""), text_at(look, "doc", ""));
    printf("\n`limner looks NAME` lists the parameters of one.\n");
}

/* '|' would end a table's cell. */
static void print_cell(const char *text)
{
    for (; *text; text++)
        printf(*text == '|' ? "\\|" : "%c", *text);
}

static void print_parameters(const json_t *list)
{
    size_t  i;
    json_t *p;
    if (json_array_size(list) == 0)
        return;
    printf("\n| parameter | type | allowed | default | |\n|---|---|---|---|---|\n");
    json_array_foreach(list, i, p)
    {
        char allowed[TEXT_SIZE], standard[TEXT_SIZE];
        print_allowed(p, allowed);
        print_value(json_object_get(p, "default"), ",", standard);
        printf("| `%s` | %s | %s | %s | ", text_at(p, "name", ""), text_at(p, "type", ""), allowed, standard);
        print_cell(text_at(p, "doc", ""));
        if (json_object_get(p, "only_if"))
            printf(" Matters only if `%s`.", text_at(p, "only_if", ""));
        printf(" |\n");
    }
}

static void print_kind(const json_t *kind)
{
    size_t      i;
    json_t     *t;
    const char *name = text_at(kind, "name", "");
    printf("\n## %s\n\n%s", name, text_at(kind, "doc", ""));
    if (json_is_true(json_object_get(kind, "look_wide")))
        printf(" One for the whole look.");
    if (json_is_true(json_object_get(kind, "array")))
        printf(" A rule may have several, drawn in order.");
    printf(" The technique is named by `%s`; ", text_at(kind, "key", ""));
    if (json_is_string(json_object_get(kind, "standard")))
        printf("without it, it is `%s`.\n", text_at(kind, "standard", ""));
    else
        printf("without it there is none.\n");
    if (json_array_size(json_object_get(kind, "common")))
        printf("\nAll techniques of this kind have:\n");
    print_parameters(json_object_get(kind, "common"));
    json_array_foreach(json_object_get(kind, "techniques"), i, t)
    {
        printf("\n### %s: %s\n\n%s\n", name, text_at(t, "name", ""), text_at(t, "doc", ""));
        print_parameters(json_object_get(t, "parameters"));
        if (json_object_get(t, "example"))
            printf("\nExample rule: `%s`\n", text_at(t, "example", ""));
    }
}

static void print_markdown(const json_t *root)
{
    size_t  i;
    json_t *item;
    printf("# Looks and techniques\n\n"
           "This page is made by `limner looks --markdown` from the tables in the code; a test holds it against them.\n"
           "A look is a JSON file; its rules give sets of parts one technique of each kind. `limner draw --look NAME` "
           "takes a look\n"
           "that ships, `--look FILE.json` your own, `--set KIND.PARAM=VALUE` changes a parameter.\n\n"
           "| look | |\n|---|---|\n");
    json_array_foreach(json_object_get(root, "looks"), i, item)
        printf("| `%s` | %s |\n", text_at(item, "name", ""), text_at(item, "doc", ""));
    printf(
        "\n## Controls\n\nNumbers from -1 to 1; 0 is the look as it is. `--set weight=0.5` sets one; what it changes, "
        "`limner looks NAME` says first.\n\n| control | |\n|---|---|\n");
    json_array_foreach(json_object_get(root, "controls"), i, item)
        printf("| `%s` | %s |\n", text_at(item, "name", ""), text_at(item, "doc", ""));
    json_array_foreach(json_object_get(root, "kinds"), i, item) print_kind(item);
}

static int run(const word_list *inputs, const void *values)
{
    const looks_values *v = values;
    const char         *name = inputs->count ? inputs->items[0] : NULL;
    lmn_error           error = {0};
    char               *text = NULL;
    if (v->markdown && (name || v->json))
        return message_usage(NULL, "--markdown goes with neither a NAME nor --json");
    if (v->depictions && (name || v->json || v->markdown))
        return message_usage(NULL, "--depictions goes with neither a NAME nor --json nor --markdown");
    if (v->depictions)
        return print_and_free(lmn_depiction_reference());
    if (lmn_look_reference_json(&text, name, &error) != LMN_OK)
        return message_error(&error);
    if (v->json)
        return print_and_free(text);
    json_t *root = parse_and_free(text);
    if (!root)
        return EXIT_INTERNAL;
    if (v->markdown)
        print_markdown(root);
    else if (name)
        print_look(root);
    else
        print_list(root);
    json_decref(root);
    return EXIT_DONE;
}

const command command_looks = {
    .name = "looks",
    .inputs = "[NAME]",
    .summary = "List looks, or the parameters of one.",
    .options = options,
    .option_count = OPTION_COUNT(options),
    .values_size = sizeof(looks_values),
    .inputs_min = 0,
    .inputs_max = 1,
    .run = run,
};
