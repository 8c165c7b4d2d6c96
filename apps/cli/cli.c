/* The table of subcommands, and what several of them need. */
#include "cli.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

const command *const commands[] = {
    &command_draw,    &command_tiles, &command_depict, &command_simulate, &command_info, &command_looks,
    &command_strokes, &command_bench, &command_doctor, &command_view,     NULL};

const char *const up_axis_choices[] = {"y", "z", NULL};

lmn_up_axis up_axis_of(int choice)
{
    return choice < 0 ? LMN_UP_AUTO : choice == 0 ? LMN_UP_Y : LMN_UP_Z;
}

static bool is_program(const char *path)
{
    size_t length = strlen(path);
    return length >= 5 && strcasecmp(path + length - 5, ".scad") == 0;
}

int check_programs(const word_list *inputs, const program_options *programs)
{
    bool any = false;
    for (size_t i = 0; i < inputs->count; i++)
        any = any || is_program(inputs->items[i]);
    if (any || (!programs->defines->count && !programs->strict))
        return EXIT_DONE;
    return message_usage(NULL, "--%s goes with OpenSCAD programs (.scad); '%s' is none",
                         programs->strict ? "strict" : "define", inputs->items[0]);
}

int scene_of_files(lmn_scene **out, const char *const *paths, size_t count, lmn_up_axis up, progress *p)
{
    const word_list none = {0};
    return scene_of_programs(out, paths, count, up, &(program_options){&none, false, NULL, NULL, 0, 0}, p);
}

int scene_of_programs(lmn_scene **out, const char *const *paths, size_t count, lmn_up_axis up,
                      const program_options *programs, progress *p)
{
    lmn_error     error = {0};
    lmn_load_desc desc = LMN_LOAD_DESC_INIT;
    desc.up_axis = up;
    desc.progress = progress_report;
    desc.progress_user = p;
    lmn_status status = lmn_scene_create(out, &error);
    for (size_t i = 0; i < count && status == LMN_OK; i++) {
        bool program = is_program(paths[i]);
        p->label = paths[i];
        desc.defines = programs->defines->items;
        desc.define_count = program ? programs->defines->count : 0;
        desc.strict = program && programs->strict;
        desc.lod = programs->lod;
        desc.terrain = programs->terrain;
        desc.populate = programs->populate;
        desc.deflection = programs->deflection;
        status = lmn_scene_add_file(*out, paths[i], &desc, &error);
    }
    progress_erase(p);
    if (status == LMN_OK)
        return EXIT_DONE;
    lmn_scene_destroy(out);
    error.status = status;
    return message_error(&error);
}

int store_text(const char *path, const char *text)
{
    lmn_error error = {0};
    fflush(stdout);
    return lmn_text_write(text, path, &error) == LMN_OK ? EXIT_DONE : message_error(&error);
}

int print_and_free(char *text)
{
    if (!text)
        return message_out_of_memory();
    int    status = store_text("-", text);
    size_t length = strlen(text);
    if (status == EXIT_DONE && (length == 0 || text[length - 1] != '\n'))
        status = store_text("-", "\n");
    lmn_text_free(text);
    return status;
}

json_t *parse_and_free(char *text)
{
    json_t *json = text ? json_loads(text, 0, NULL) : NULL;
    lmn_text_free(text);
    if (!json)
        message_out_of_memory();
    return json;
}

double number_at(const json_t *object, const char *key, double fallback)
{
    const json_t *value = json_object_get(object, key);
    return json_is_number(value) ? json_number_value(value) : fallback;
}

const char *text_at(const json_t *object, const char *key, const char *fallback)
{
    const json_t *value = json_object_get(object, key);
    return json_is_string(value) ? json_string_value(value) : fallback;
}
