/* What happens in a script's scene: activities and events. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "behaviour/schedule.h"
#include "import/script.h"

static const char *const KEYS[] = {"sequence", "simultaneity", "table", "reverse", "repeat",
                                   "creep",    "target",       "clip",  "event"};

static behaviour_node *at(script_reader *r, int32_t index)
{
    return &r->scene->behaviour->nodes[index];
}

static void refuse(script_reader *r, const char *fault)
{
    if (fault)
        script_fail(r, LMN_FORMAT, "%s", fault);
}

static void add_child(script_reader *r, int32_t parent, json_t *value, double start, double duration)
{
    int32_t child = script_activity_of(r, value);
    if (child != NONE && !behaviour_append_child(r->scene, parent, child, start, duration))
        script_out_of_memory(r);
}

static void read_children(script_reader *r, json_t *list, int32_t index)
{
    for (size_t i = 0; i < json_array_size(list) && script_enter(r, NULL, i); i++) {
        add_child(r, index, json_array_get(list, i), 0, -1);
        script_leave(r);
    }
}

static void read_row(script_reader *r, json_t *row, int32_t index)
{
    double  start = 0, duration = -1;
    json_t *activity = json_object_get(row, "activity");
    if (!json_is_object(row) || !activity) {
        script_fail(r, LMN_FORMAT, "a row of a table has a start, an activity and perhaps a duration");
        return;
    }
    script_check_keys(r, row, "start duration activity");
    script_number(r, row, "start", r->file->time, &start);
    if (script_number(r, row, "duration", r->file->time, &duration))
        refuse(r, behaviour_duration_fault(duration));
    refuse(r, behaviour_start_fault(start));
    if (script_enter(r, "activity", 0)) {
        add_child(r, index, activity, start, duration);
        script_leave(r);
    }
}

static void read_table(script_reader *r, json_t *list, int32_t index)
{
    for (size_t i = 0; i < json_array_size(list) && script_enter(r, NULL, i); i++) {
        read_row(r, json_array_get(list, i), index);
        script_leave(r);
    }
}

/* --- constraints ------------------------------------------------------------------------------------------ */

static void read_constraint(script_reader *r, json_t *object, int32_t index)
{
    static const char *const properties[] = {"translation", "rotation", "scale",     "weights", "fov",
                                             "half_height", "colour",   "intensity", NULL};
    const char              *name = script_text(r, object, "target");
    int32_t                  target = NONE;
    animation_path           path = (animation_path)script_choice(r, object, "property", properties, PATH_TRANSLATION);
    if (name && script_enter(r, "target", 0)) {
        target = script_find_node(r, name);
        if (target != NONE)
            target = behaviour_target_of(r->scene, path, target);
        if (target == NONE)
            script_fail(r, LMN_FORMAT, "'%.100s' is no %s", name,
                        animation_thing_of(path) == ANIMATED_CAMERA ? "camera" : "light");
        script_leave(r);
    }
    if (r->status != LMN_OK)
        return;
    at(r, index)->path = path;
    at(r, index)->target = target;
    script_read_map(r, object, index);
}

/* --- clips ------------------------------------------------------------------------------------------------ */

static void read_clip(script_reader *r, json_t *object, int32_t index)
{
    const char        *of = script_text(r, object, "of");
    json_t            *clip = json_object_get(object, "clip");
    const script_node *model = of ? script_find_declared(r, of) : NULL;
    int32_t            first = model ? model->first_clip : 1, found = NONE; /* clip 0 is the script's own */
    int32_t            behind = model ? first + model->clip_count : (int32_t)r->scene->animation_count;
    if (of && !model)
        script_fail(r, LMN_FORMAT, "there is no model '%.100s'", of);
    for (int32_t i = first; i < behind && json_is_string(clip); i++)
        if (found == NONE && r->scene->animations[i].name &&
            strcmp(r->scene->animations[i].name, json_string_value(clip)) == 0)
            found = i;
    if (json_is_integer(clip) && json_integer_value(clip) >= 1 && json_integer_value(clip) <= behind - first)
        found = first + (int32_t)json_integer_value(clip) - 1;
    if (found == NONE)
        script_fail(r, LMN_FORMAT, "there is no such clip; a clip is a name or a number from 1 to %d", behind - first);
    at(r, index)->clip = found;
}

/* --- any of them ------------------------------------------------------------------------------------------ */

static void read_modifier(script_reader *r, json_t *object, int32_t index, behaviour_kind kind)
{
    double times = 1, exponent = 2;
    if (kind == BEHAVIOUR_REPEAT && script_number(r, object, "times", 1, &times) &&
        !(times >= 0 && times <= UINT32_MAX && floor(times) == times))
        script_fail(r, LMN_FORMAT, "'times' has to be a whole number from 1 to %d", BEHAVIOUR_TIMES_MAX);
    if (kind == BEHAVIOUR_CREEP)
        script_number(r, object, "exponent", 1, &exponent);
    if (r->status != LMN_OK)
        return;
    at(r, index)->times = (uint32_t)times;
    at(r, index)->exponent = kind == BEHAVIOUR_CREEP ? exponent : 1;
    if (script_enter(r, KEYS[kind], 0)) {
        add_child(r, index, json_object_get(object, KEYS[kind]), 0, -1);
        script_leave(r);
    }
}

static void read_kind(script_reader *r, json_t *object, int32_t index, behaviour_kind kind)
{
    static const char *const fits[] = {"stretch", "start", "centre", "end", "shrink", NULL};
    const char              *name;
    json_t                  *list;
    if (kind < BEHAVIOUR_REVERSE) {
        list = script_member(r, object, KEYS[kind], JSON_ARRAY);
        at(r, index)->fit = (behaviour_fit)script_choice(r, object, "fit", fits, FIT_START);
        if (list && script_enter(r, KEYS[kind], 0)) {
            (kind == BEHAVIOUR_TABLE ? read_table : read_children)(r, list, index);
            script_leave(r);
        }
    } else if (kind < BEHAVIOUR_CONSTRAINT) {
        read_modifier(r, object, index, kind);
    } else if (kind == BEHAVIOUR_CONSTRAINT) {
        read_constraint(r, object, index);
    } else if (kind == BEHAVIOUR_CLIP) {
        read_clip(r, object, index);
    } else if ((name = script_text(r, object, "of")) != NULL) {
        at(r, index)->target = script_find_node(r, name);
    }
}

static const char *keys_of(behaviour_kind kind)
{
    switch (kind) {
    case BEHAVIOUR_SEQUENCE: return "sequence name duration";
    case BEHAVIOUR_SIMULTANEITY: return "simultaneity fit name duration";
    case BEHAVIOUR_TABLE: return "table name duration";
    case BEHAVIOUR_REVERSE: return "reverse name duration";
    case BEHAVIOUR_REPEAT: return "repeat times name duration";
    case BEHAVIOUR_CREEP: return "creep exponent name duration";
    case BEHAVIOUR_CLIP: return "clip of name duration";
    case BEHAVIOUR_EVENT: return "event of";
    default:
        return "target property axis constant linear times curve function tangent start velocity gravity floor "
               "restitution amplitude frequency phase rate node delay offset name duration";
    }
}

static void read_own(script_reader *r, json_t *object, int32_t index, behaviour_kind kind)
{
    const char *name = script_text(r, object, kind == BEHAVIOUR_EVENT ? "event" : "name");
    double      duration = -1;
    int         line = 0, column = 0;
    if (kind != BEHAVIOUR_EVENT && script_number(r, object, "duration", r->file->time, &duration))
        refuse(r, behaviour_duration_fault(duration));
    if (r->memo_file != r->file)
        r->memo = (locate_memo){.counted = NULL};
    r->memo_file = r->file;
    locate_on(&r->memo, (const char *)r->file->data.data, r->file->data.size, r->steps, r->step_count, &line, &column);
    behaviour_node *n = at(r, index);
    n->line = (uint32_t)line;
    n->column = (uint32_t)column;
    n->duration = duration;
    n->name = name ? scene_clean_name(name, strlen(name)) : NULL;
    if (name && !n->name)
        script_out_of_memory(r);
}

static int32_t read_object(script_reader *r, json_t *object)
{
    int kind = -1;
    for (int i = 0; i < (int)(sizeof KEYS / sizeof *KEYS); i++)
        if (json_object_get(object, KEYS[i])) {
            if (kind >= 0)
                script_fail(r, LMN_FORMAT, "an activity cannot be both '%s' and '%s'", KEYS[kind], KEYS[i]);
            kind = i;
        }
    if (kind < 0)
        script_fail(r, LMN_FORMAT,
                    "an activity is one of sequence, simultaneity, table, reverse, repeat, creep, event, "
                    "clip, or it has a target");
    if (r->status == LMN_OK)
        script_check_keys(r, object, keys_of((behaviour_kind)kind));
    if (r->status != LMN_OK)
        return NONE;
    int32_t index = behaviour_append(r->scene, (behaviour_kind)kind);
    if (index == NONE) {
        script_out_of_memory(r);
        return NONE;
    }
    read_own(r, object, index, (behaviour_kind)kind);
    if (r->status == LMN_OK)
        read_kind(r, object, index, (behaviour_kind)kind);
    if (r->status == LMN_OK) {
        r->status = behaviour_check(r->scene, r->scene->behaviour, index, r->error);
        if (r->status != LMN_OK && r->error)
            error_file(r->error, r->file->path);
    }
    return r->status == LMN_OK ? index : NONE;
}

/* The activity of a name, read where it stands when it is asked for first. */
static int32_t read_reference(script_reader *r, const char *name)
{
    script_activity *a = NULL;
    for (size_t i = 0; i < r->activity_count && !a; i++)
        a = strcmp(r->activities[i].name, name) == 0 ? &r->activities[i] : NULL;
    if (!a || a->open) {
        script_fail(r, LMN_FORMAT, a ? "the activity '%.100s' contains itself" : "there is no activity '%.100s'", name);
        return NONE;
    }
    if (a->node != NONE)
        return a->node;
    /* Places are in its file from here on, and behind the steps that lead here, which come back. */
    const script_file *before = r->file;
    locate_step       *kept = mem_copy(r->steps, r->step_count * sizeof *kept);
    size_t             count = r->step_count;
    if (!kept || count + 2 > SCRIPT_STEPS_MAX) {
        mem_free(kept);
        script_out_of_memory(r);
        return NONE;
    }
    r->file = a->file;
    r->steps[0] = (locate_step){"activities", 0};
    r->steps[1] = (locate_step){a->name, 0};
    r->step_count = 2;
    a->open = true;
    a->node = script_activity_of(r, a->json);
    a->open = false;
    memcpy(r->steps, kept, count * sizeof *kept);
    r->step_count = count;
    r->file = before;
    mem_free(kept);
    return a->node;
}

int32_t script_activity_of(script_reader *r, json_t *value)
{
    if (r->status != LMN_OK)
        return NONE;
    if (++r->depth > 300)
        script_fail(r, LMN_LIMIT, "activities lie deeper than 256 levels");
    int32_t index = NONE;
    if (r->status == LMN_OK && json_is_string(value))
        index = read_reference(r, json_string_value(value));
    else if (r->status == LMN_OK && json_is_object(value))
        index = read_object(r, value);
    else
        script_fail(r, LMN_FORMAT, "an activity is an object, or the name of one");
    r->depth--;
    return index;
}
