/* Scripts: scenes with what happens in them, as JSON (docs/SCRIPTS.md, docs/reference/script.schema.json). */
#include "import/script.h"

#include <stdio.h>
#include <string.h>

#include "base/limits.h"
#include "base/memory.h"
#include "base/text.h"
#include "behaviour/clip.h"
#include "import/access.h"

/* Is it an object that says so near its beginning? */
static bool recognises(const file_data *file)
{
    size_t at = text_byte_order_mark((const char *)file->data, file->size),
           most = file->size < 65536 ? file->size : 65536;
    while (at < most && strchr(" \t\r\n", file->data[at]) && file->data[at])
        at++;
    static const char word[] = "\"limner_script\"";
    if (at >= most || file->data[at] != '{')
        return false;
    for (; at + sizeof word <= most; at++)
        if (memcmp(file->data + at, word, sizeof word - 1) == 0)
            return true;
    return false;
}

/* --- files ------------------------------------------------------------------------------------------------ */

static void read_units(script_reader *r, script_file *f)
{
    static const char *const lengths[] = {"m", "cm", "mm", "in", "ft", NULL}, *const angles[] = {"deg", "rad", NULL},
                             *const times[] = {"s", "ms", NULL};
    static const double             metres[] = {1, 0.01, 0.001, 0.0254, 0.3048}, radians[] = {0.017453292519943295, 1};
    json_t                         *units = script_member(r, f->root, "units", JSON_OBJECT);
    f->length = 1;
    f->angle = radians[0];
    f->time = 1;
    if (!units || !script_enter(r, "units", 0))
        return;
    script_check_keys(r, units, "length angle time");
    f->length = metres[script_choice(r, units, "length", lengths, 0)];
    f->angle = radians[script_choice(r, units, "angle", angles, 0)];
    f->time = script_choice(r, units, "time", times, 0) ? 0.001 : 1;
    script_leave(r);
}

static void check_version(script_reader *r, json_t *root)
{
    json_t *version = json_object_get(root, "limner_script");
    if (!json_is_integer(version) || json_integer_value(version) != 1) {
        if (script_enter(r, "limner_script", 0)) {
            script_fail(r, LMN_FORMAT, "this Limner reads scripts of version 1");
            script_leave(r);
        }
    }
    script_check_keys(r, root,
                      "limner_script $schema units up include nodes activities behaviour expressions depiction");
    script_member(r, root, "expressions", JSON_ARRAY);
    script_member(r, root, "depiction", JSON_OBJECT);
    script_text(r, root, "$schema");
}

/* Takes over path and bytes. */
static script_file *add_file(script_reader *r, char *path, file_data data, const script_file *by)
{
    script_file *f = r->file_count < SCRIPT_FILES_MAX ? mem_calloc(1, sizeof *f) : NULL;
    if (!f) {
        mem_free(path);
        file_data_release(&data);
        if (r->file_count < SCRIPT_FILES_MAX)
            script_out_of_memory(r);
        else
            script_fail(r, LMN_LIMIT, "more than %d files", SCRIPT_FILES_MAX);
        return NULL;
    }
    *f = (script_file){.path = path, .data = data, .by = by};
    r->files[r->file_count++] = f;
    return f;
}

static void parse(script_reader *r, script_file *f)
{
    json_error_t wrong;
    r->file = f;
    r->step_count = 0;
    if (f->data.size > LIMIT_LOOK_BYTES * 4) {
        script_fail(r, LMN_LIMIT, "a script has at most %zu bytes", (size_t)LIMIT_LOOK_BYTES * 4);
        return;
    }
    const size_t mark = text_byte_order_mark((const char *)f->data.data, f->data.size);
    f->root = json_loadb((const char *)f->data.data + mark, f->data.size - mark, JSON_REJECT_DUPLICATES, &wrong);
    if (f->root && json_is_object(f->root)) {
        check_version(r, f->root);
        read_units(r, f);
        return;
    }
    r->status = error_in_file(r->error, LMN_FORMAT, f->path, f->root ? 1 : wrong.line, "%s",
                              f->root ? "a script has to be an object" : wrong.text);
    if (r->error)
        r->error->column = f->root ? 1 : wrong.column;
}

static void read_file(script_reader *r, script_file *f);

static void include(script_reader *r, const script_file *by, const char *name)
{
    int       depth = 0;
    file_data data;
    char     *path = name ? file_beside(by->path, name) : NULL;
    if (!name) {
        script_fail(r, LMN_FORMAT, "an include is the name of a file");
        return;
    }
    if (!path) {
        script_out_of_memory(r);
        return;
    }
    for (const script_file *at = by; at; at = at->by, depth++)
        if (strcmp(at->path, path) == 0)
            script_fail(r, LMN_FORMAT, "'%.100s' includes itself", name);
    if (depth > SCRIPT_INCLUDES_MAX)
        script_fail(r, LMN_LIMIT, "includes lie deeper than %d files", SCRIPT_INCLUDES_MAX);
    if (r->status == LMN_OK)
        r->status = access_read(r->job, "script", path, &data, NULL, r->error);
    if (r->status != LMN_OK) {
        mem_free(path);
        return;
    }
    script_file *f = add_file(r, path, data, by);
    if (f)
        parse(r, f);
    if (f && r->status == LMN_OK)
        read_file(r, f);
}

static void add_activities(script_reader *r, script_file *f)
{
    const char *name;
    json_t     *value, *list = script_member(r, f->root, "activities", JSON_OBJECT);
    json_object_foreach(list, name, value)
    {
        for (size_t i = 0; i < r->activity_count; i++)
            if (strcmp(r->activities[i].name, name) == 0)
                script_fail(r, LMN_FORMAT, "there are two activities '%.100s'", name);
        if (!mem_grow((void **)&r->activities, &r->activity_capacity, r->activity_count + 1, sizeof *r->activities)) {
            script_out_of_memory(r);
            return;
        }
        r->activities[r->activity_count++] = (script_activity){f, name, value, NONE, false};
    }
}

/* What it includes comes first. Behaviour waits until all nodes are there. */
static void read_file(script_reader *r, script_file *f)
{
    json_t *list = script_member(r, f->root, "include", JSON_ARRAY);
    for (size_t i = 0; i < json_array_size(list) && r->status == LMN_OK; i++) {
        r->file = f;
        r->step_count = 0;
        if (script_enter(r, "include", 0) && script_enter(r, NULL, i))
            include(r, f, json_string_value(json_array_get(list, i)));
    }
    if (r->status != LMN_OK)
        return;
    r->file = f;
    r->step_count = 0;
    add_activities(r, f);
    list = script_member(r, f->root, "nodes", JSON_ARRAY);
    if (list && script_enter(r, "nodes", 0)) {
        script_read_nodes(r, list);
        script_leave(r);
    }
}

/* --- behaviour -------------------------------------------------------------------------------------------- */

static void add_root(script_reader *r, json_t *value)
{
    int32_t root = script_activity_of(r, value);
    if (root != NONE && !behaviour_append_root(r->scene, root))
        script_out_of_memory(r);
}

/* One activity, or an array of them that all begin at 0. */
static void read_behaviour(script_reader *r, const script_file *f)
{
    json_t *value = json_object_get(f->root, "behaviour");
    r->file = f;
    r->step_count = 0;
    if (!value || !script_enter(r, "behaviour", 0))
        return;
    if (!json_is_array(value))
        add_root(r, value);
    for (size_t i = 0; i < json_array_size(value) && script_enter(r, NULL, i); i++) {
        add_root(r, json_array_get(value, i));
        script_leave(r);
    }
    script_leave(r);
}

static bool has_behaviour(const script_reader *r)
{
    for (size_t i = 0; i < r->file_count; i++)
        if (json_object_get(r->files[i]->root, "behaviour"))
            return true;
    return false;
}

/* The first animation is what happens, so that it is the one that plays. */
static void reserve_clip(script_reader *r)
{
    animation *a = scene_append_animation(r->scene);
    if (a)
        a->name = mem_copy_text("behaviour");
    if (!a || !a->name)
        script_out_of_memory(r);
}

static void write_clip(script_reader *r)
{
    if (r->status != LMN_OK)
        return;
    r->status = behaviour_write_clip(r->scene, 0, r->error);
    if (r->status != LMN_OK && r->error && !r->error->file[0])
        error_file(r->error, r->job->path);
}

/* An animation that nothing was written into would be a clip that moves nothing. */
static void drop_empty_clip(lmn_scene *s)
{
    if (s->animation_count == 0 || s->animations[0].channel_count > 0 || !s->animations[0].name ||
        strcmp(s->animations[0].name, "behaviour") != 0)
        return;
    mem_free(s->animations[0].name);
    s->animation_count--;
    memmove(s->animations, s->animations + 1, s->animation_count * sizeof *s->animations);
    for (size_t i = 0; s->behaviour && i < s->behaviour->node_count; i++)
        s->behaviour->nodes[i].clip -= s->behaviour->nodes[i].clip != NONE;
    if (s->behaviour)
        s->behaviour->written = NONE;
}

/* --- the whole -------------------------------------------------------------------------------------------- */

static void read_all(script_reader *r, script_file *f)
{
    static const char *const ups[] = {"y", "z", NULL};
    parse(r, f);
    if (r->status == LMN_OK)
        r->scene->up = script_choice(r, f->root, "up", ups, 0) ? 'z' : 'y';
    if (r->status == LMN_OK)
        reserve_clip(r);
    if (r->status == LMN_OK)
        read_file(r, f);
    for (size_t i = r->file_count; i-- > 0 && r->status == LMN_OK;)
        read_behaviour(r, r->files[i]);
    if (r->status == LMN_OK && has_behaviour(r))
        write_clip(r);
    if (r->status == LMN_OK)
        drop_empty_clip(r->scene);
    r->scene->may_be_empty = r->scene->camera_count + r->scene->light_count > 0;
}

static void release(script_reader *r)
{
    for (size_t i = 0; i < r->file_count; i++) {
        json_decref(r->files[i]->root);
        if (i > 0) /* the first one's bytes are the job's */
            file_data_release(&r->files[i]->data);
        mem_free(r->files[i]->path);
        mem_free(r->files[i]);
    }
    mem_free(r->activities);
    mem_free(r->nodes);
    mem_free(r);
}

static lmn_status read_script(const import_job *job, lmn_error *error)
{
    if (job->model && job->model != job->path) {
        error_in_file(error, LMN_UNSUPPORTED, job->path, 0, "a script cannot be a model of another file");
        error_hint(error, "name it in that script's \"include\"");
        return LMN_UNSUPPORTED;
    }
    script_reader *r = mem_calloc(1, sizeof *r);
    char          *path = mem_copy_text(job->path);
    if (!r || !path) {
        mem_free(r);
        mem_free(path);
        return error_memory(error);
    }
    r->job = job;
    r->scene = job->scene;
    r->error = error;
    script_file *f = mem_calloc(1, sizeof *f);
    if (f) {
        *f = (script_file){.path = path, .data = *job->file};
        r->files[r->file_count++] = f;
        read_all(r, f);
    } else {
        mem_free(path);
        script_out_of_memory(r);
    }
    lmn_status status = r->status;
    release(r);
    return status;
}

const import_format import_script = {
    .name = "a Limner script",
    .endings = ".json",
    .up = 'y',
    .recognises = recognises,
    .read = read_script,
};
