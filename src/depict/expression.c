/* Expressions: read, written, kept. Nienhaus 2005, section 7.7. */
#include <stdio.h>
#include <string.h>

#include "base/error.h"
#include "base/locate.h"
#include "base/memory.h"
#include "base/text.h"
#include "depict/depict.h"
#include "look/value.h"

static const char *const own_keys[] = {"target", "depict", "from", "to", "now", "partner"};

const depiction *depiction_find(const char *characteristic, const char *semantics)
{
    const depiction *any = NULL;
    for (size_t i = 0; depictions[i]; i++) {
        const depiction *d = depictions[i];
        if (strcmp(d->characteristic, characteristic) != 0)
            continue;
        if (d->semantics && semantics && strcmp(d->semantics, semantics) == 0)
            return d;
        any = d->semantics ? any : d;
    }
    return any;
}

void expression_list_release(expression_list *l)
{
    for (size_t i = 0; i < l->count; i++)
        mem_free(l->items[i].values);
    mem_free(l->items);
    memset(l, 0, sizeof *l);
}

expression *expression_add(expression_list *l, const depiction *row, int32_t target, double from, double to, double now)
{
    void *values = mem_calloc(1, row->values_size);
    if (!values || !mem_grow((void **)&l->items, &l->capacity, l->count + 1, sizeof *l->items)) {
        mem_free(values);
        return NULL;
    }
    params_set_defaults(row->params, row->param_count, values);
    l->items[l->count] = (expression){row, target, NONE, from, to, now, (uint32_t)l->count, 0, 0, {1, 1}, values};
    return &l->items[l->count++];
}

/* --- names -----------------------------------------------------------------------------------------------------------
 */

const char *depict_name_of(const lmn_scene *scene, int32_t node_index, char numbered[DEPICT_NAME_SIZE])
{
    if (scene->nodes[node_index].name && depict_find_node(scene, scene->nodes[node_index].name) == node_index)
        return scene->nodes[node_index].name;
    snprintf(numbered, DEPICT_NAME_SIZE, "#%d", (int)node_index + 1);
    return numbered;
}

int32_t depict_find_node(const lmn_scene *scene, const char *name)
{
    long long number;
    if (name[0] == '#' && text_is_int(name + 1, &number) && number > 0 && (size_t)number <= scene->node_count &&
        !scene->nodes[number - 1].removed)
        return (int32_t)number - 1;
    /* A file's own node, which has the file's name, comes behind what lies in it. */
    for (size_t i = 0; i < scene->node_count; i++) {
        const node *n = &scene->nodes[i];
        if (n->name && !n->removed && n->parent != NONE && strcmp(name, n->name) == 0)
            return (int32_t)i;
    }
    for (int pass = 0; pass < 2; pass++) {
        for (size_t i = 0; i < scene->node_count; i++) {
            const node *n = &scene->nodes[i];
            if (n->name && !n->removed && (pass ? text_glob(name, n->name) : strcmp(name, n->name) == 0))
                return (int32_t)i;
        }
        for (size_t i = 0; i < scene->part_count; i++)
            if (pass ? text_glob(name, scene->parts[i].path) : strcmp(name, scene->parts[i].path) == 0)
                return scene->parts[i].node;
    }
    return NONE;
}

static bool is_named(const node *n, const char *name)
{
    return n->name && !n->removed && text_glob(name, n->name);
}

/* How many things a name means, of which depict_find_node takes the first: more than one only of patterns. */
static size_t count_meant(const lmn_scene *scene, const char *name)
{
    size_t count = 0;
    if (!strpbrk(name, "*?"))
        return 1;
    for (size_t i = 0; i < scene->node_count; i++)
        count += is_named(&scene->nodes[i], name);
    for (size_t i = 0; i < scene->part_count; i++)
        count += !is_named(&scene->nodes[scene->parts[i].node], name) && text_glob(name, scene->parts[i].path);
    return count;
}

const char *depict_semantics(const lmn_scene *scene, int32_t node_index)
{
    const node *n = &scene->nodes[node_index];
    for (size_t i = 0; i < n->attribute_count; i++)
        if (strcmp(n->attributes[i].key, "semantics") == 0)
            return n->attributes[i].value;
    return n->camera != NONE ? "camera" : NULL;
}

/* --- reading ---------------------------------------------------------------------------------------------------------
 */

static lmn_status read_node(int32_t *out, size_t *meant, const json_t *one, const char *key, const lmn_scene *scene,
                            lmn_error *error)
{
    const char *name = json_string_value(json_object_get(one, key));
    if (!name)
        return error_set(error, LMN_USAGE, "an expression needs \"%s\", the name of a node", key);
    *out = depict_find_node(scene, name);
    *meant = count_meant(scene, name);
    if (*out != NONE)
        return LMN_OK;
    error_set(error, LMN_USAGE, "\"%s\" is '%.120s'; there is no such node", key, name);
    error_hint(error, "`limner info` lists parts");
    return LMN_USAGE;
}

static lmn_status read_time(double *out, const json_t *one, const char *key, lmn_error *error)
{
    const json_t *value = json_object_get(one, key);
    if (!value)
        return LMN_OK;
    if (!json_is_number(value))
        return error_set(error, LMN_USAGE, "\"%s\" is no number of seconds", key);
    *out = json_number_value(value);
    return *out >= 0 && *out <= 1e9 ? LMN_OK
                                    : error_set(error, LMN_USAGE, "\"%s\" is %g; allowed is 0 to 1e9", key, *out);
}

static lmn_status read_row(const depiction **out, const json_t *one, const lmn_scene *scene, int32_t target,
                           lmn_error *error)
{
    enum { ROWS = 64 };
    const char *token = json_string_value(json_object_get(one, "depict")), *names[ROWS];
    size_t      count = 0;
    if (!token)
        return error_set(error, LMN_USAGE, "an expression needs \"depict\", for example \"path\"");
    *out = depiction_find(token, depict_semantics(scene, target));
    if (*out)
        return LMN_OK;
    for (size_t i = 0; depictions[i] && count < ROWS; i++)
        names[count++] = depictions[i]->characteristic;
    const char *near = text_nearest(token, names, count);
    error_set(error, LMN_USAGE, "there is no way to depict '%.80s'", token);
    error_hint(error, "%s%s%s", near ? "did you mean '" : "`limner looks --depictions` lists them", near ? near : "",
               near ? "'?" : "");
    return LMN_USAGE;
}

/* What is read, and where in it. */
typedef struct reading {
    const char      *text;
    size_t           size;
    const lmn_scene *scene;
    const moment    *when;
    locate_step      steps[3]; /* "expressions", where it is one of an object's; which; its member */
    size_t           step_count;
} reading;

static void find_place(const reading *r, const char *key, int *line, int *column)
{
    reading here = *r;
    if (key)
        here.steps[here.step_count++] = (locate_step){key, 0};
    locate(r->text, r->size, here.steps, here.step_count, line, column);
}

/* Of an error that was set: where it is, and that the text is wrong. */
static lmn_status wrong_at(const reading *r, const char *key, lmn_status status, lmn_error *error)
{
    int line = 0, column = 0;
    if (status == LMN_OK || status == LMN_MEMORY)
        return status;
    find_place(r, key, &line, &column);
    if (error) {
        error->status = LMN_FORMAT;
        error->line = line;
        error->column = column;
    }
    return LMN_FORMAT;
}

static lmn_status read_values(expression *e, const reading *r, const json_t *one, lmn_error *error)
{
    const char *key;
    json_t     *value;
    json_object_foreach((json_t *)one, key, value)
    {
        const param *p = NULL;
        bool         own = false;
        for (size_t i = 0; i < PARAM_COUNT(own_keys); i++)
            own = own || strcmp(key, own_keys[i]) == 0;
        for (size_t i = 0; i < e->row->param_count; i++)
            p = strcmp(key, e->row->params[i].key) == 0 ? &e->row->params[i] : p;
        lmn_status status = LMN_OK;
        if (p)
            status = value_set_json(p, e->values, value, error);
        else if (!own)
            status = error_set(error, LMN_USAGE, "'%.60s' has no parameter '%.60s'", e->row->characteristic, key);
        if (status != LMN_OK)
            return wrong_at(r, key, status, error);
    }
    return LMN_OK;
}

/* An interval has a length, and something of the motion in it. A scene without any has the moment 0 alone. */
static lmn_status check_interval(double from, double to, double end, lmn_error *error)
{
    if (from > to || (from == to && (from > 0 || end > 0)))
        return error_set(error, LMN_USAGE, "the interval is empty: from %g to %g", from, to);
    if (end > 0 && from >= end)
        return error_set(error, LMN_USAGE, "the interval, from %g to %g, lies behind the end of all motion, %g s", from,
                         to, end);
    return LMN_OK;
}

static lmn_status read_times(double *from, double *to, double *now, const char **bad, const reading *r,
                             const json_t *one, lmn_error *error)
{
    static const char *const keys[] = {"from", "to", "now"};
    double *const            times[] = {from, to, now};
    const double             end = moment_duration(r->when, r->scene);
    *from = 0;
    *to = end;
    *now = r->when->seconds;
    for (int i = 0; i < 3; i++) {
        lmn_status status = read_time(times[i], one, keys[i], error);
        *bad = keys[i];
        if (status != LMN_OK)
            return status;
    }
    *bad = json_object_get(one, "from") ? "from" : "to";
    return check_interval(*from, *to, end, error);
}

static lmn_status read_one(expression_list *out, const reading *r, const json_t *one, lmn_error *error)
{
    int32_t          target = NONE, partner = NONE;
    double           from, to, now;
    const depiction *row = NULL;
    const char      *bad = NULL;
    size_t           choice[2] = {1, 1};
    if (!json_is_object(one))
        return wrong_at(r, NULL, error_set(error, LMN_USAGE, "an expression is an object"), error);
    lmn_status status = read_node(&target, &choice[0], one, "target", r->scene, error);
    if (status != LMN_OK)
        return wrong_at(r, "target", status, error);
    if (json_object_get(one, "partner"))
        status = read_node(&partner, &choice[1], one, "partner", r->scene, error);
    if (status == LMN_OK && partner == target)
        status = error_set(error, LMN_USAGE, "the partner is the target itself: nothing happens between them");
    if (status != LMN_OK)
        return wrong_at(r, "partner", status, error);
    status = read_row(&row, one, r->scene, target, error);
    if (status != LMN_OK)
        return wrong_at(r, "depict", status, error);
    status = read_times(&from, &to, &now, &bad, r, one, error);
    if (status != LMN_OK)
        return wrong_at(r, bad, status, error);
    expression *e = expression_add(out, row, target, from, to, now);
    if (!e)
        return error_memory(error);
    e->partner = partner;
    memcpy(e->choice, choice, sizeof choice);
    find_place(r, NULL, &e->line, &e->column);
    return read_values(e, r, one, error);
}

/* The message names the expression by its number; line and column are there already. */
static void name_number(size_t number, lmn_error *error)
{
    lmn_error was = *error;
    error_set(error, was.status, "expression %zu: %.400s", number, was.message);
    error->line = was.line;
    error->column = was.column;
    if (was.hint[0])
        error_hint(error, "%s", was.hint);
}

static lmn_status read_all(expression_list *out, reading *r, const json_t *array, lmn_error *error)
{
    const size_t depth = r->step_count++;
    for (size_t i = 0; i < json_array_size(array); i++) {
        r->steps[depth] = (locate_step){NULL, i};
        lmn_status status = read_one(out, r, json_array_get(array, i), error);
        if (status == LMN_FORMAT && error)
            name_number(i + 1, error);
        if (status != LMN_OK)
            return status;
    }
    return LMN_OK;
}

lmn_status expressions_read(expression_list *out, const char *text, const lmn_scene *scene, const moment *when,
                            lmn_error *error)
{
    json_error_t wrong;
    text += text_byte_order_mark(text, strlen(text));
    reading    r = {.text = text, .size = strlen(text), .scene = scene, .when = when};
    json_t    *root = json_loads(text, JSON_REJECT_DUPLICATES, &wrong), *array = root;
    lmn_status status;
    if (json_is_object(root)) {
        array = json_object_get(root, "expressions");
        r.steps[r.step_count++] = (locate_step){"expressions", 0};
    }
    if (!root) {
        status = error_in_file(error, LMN_FORMAT, NULL, wrong.line, "expressions: %s", wrong.text);
        if (error)
            error->column = wrong.column;
    } else if (!json_is_array(array)) {
        status = error_in_file(error, LMN_FORMAT, NULL, 1, "there are no expressions in it");
        if (error)
            error->column = 1;
        error_hint(error, "an array of objects, or an object with \"expressions\"");
    } else
        status = read_all(out, &r, array, error);
    json_decref(root);
    return status;
}

lmn_status expression_blame(const expression *e, const lmn_scene *scene, lmn_status status, lmn_error *error)
{
    char numbered[DEPICT_NAME_SIZE];
    if (status == LMN_OK || status == LMN_MEMORY || status == LMN_CANCELLED || status == LMN_LIMIT || !error)
        return status;
    lmn_error was = *error;
    error_set(error, status == LMN_USAGE ? LMN_FORMAT : status, "expression %u, '%s' of '%.60s': %.300s", e->number + 1,
              e->row->characteristic, depict_name_of(scene, e->target, numbered), was.message);
    error->line = e->line;
    error->column = e->column;
    if (was.hint[0])
        error_hint(error, "%s", was.hint);
    return error->status;
}

/* --- writing ---------------------------------------------------------------------------------------------------------
 */

json_t *expressions_json(const expression_list *l, const lmn_scene *scene)
{
    json_t *array = json_array();
    char    target[DEPICT_NAME_SIZE], partner[DEPICT_NAME_SIZE];
    for (size_t i = 0; i < l->count; i++) {
        const expression *e = &l->items[i];
        json_t *one = json_pack("{s:s,s:s,s:o,s:o,s:o}", "target", depict_name_of(scene, e->target, target), "depict",
                                e->row->characteristic, "from", value_number(e->from), "to", value_number(e->to), "now",
                                value_number(e->now));
        if (one && e->partner != NONE)
            json_object_set_new(one, "partner", json_string(depict_name_of(scene, e->partner, partner)));
        for (size_t k = 0; one && k < e->row->param_count; k++)
            if (!param_is_default(&e->row->params[k], e->values))
                json_object_set_new(one, e->row->params[k].key, value_json(&e->row->params[k], e->values));
        if (json_array_append_new(array, one) != 0) {
            json_decref(array);
            return NULL;
        }
    }
    return array;
}
