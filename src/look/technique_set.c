#include "look/technique_set.h"

#include <ctype.h>
#include <math.h>
#include <stdatomic.h>
#include <stdio.h>
#include <string.h>

#include "base/embedded.h"
#include "base/error.h"
#include "base/memory.h"
#include "base/text.h"
#include "look/look.h"
#include "scene/scene.h"

enum { NAME_MAX_LENGTH = 40, PARAMS_MAX = 64, LINES_MAX = 1999, PATH_SIZE = 128, ALIGNMENT = 8 };

/* A technique with all that its rows point at. */
typedef struct own_technique {
    technique   technique;
    surface_row surface;
    param      *params;
    void      **kept; /* what was allocated for it */
    size_t      kept_count, kept_capacity;
} own_technique;

struct lmn_techniques {
    atomic_int      holders;
    own_technique **items;
    size_t          count, capacity;
};

/* --- the set -------------------------------------------------------------------------------------------- */

lmn_status techniques_create(lmn_techniques **out, lmn_error *error)
{
    *out = mem_calloc(1, sizeof **out);
    if (!*out)
        return error_memory(error);
    atomic_init(&(*out)->holders, 1);
    return LMN_OK;
}

lmn_techniques *techniques_hold(lmn_techniques *set)
{
    if (set)
        atomic_fetch_add(&set->holders, 1);
    return set;
}

static void own_release(own_technique *own)
{
    for (size_t i = 0; own && i < own->kept_count; i++)
        mem_free(own->kept[i]);
    if (own)
        mem_free(own->kept);
    mem_free(own);
}

void techniques_release(lmn_techniques *set)
{
    if (!set || atomic_fetch_sub(&set->holders, 1) > 1)
        return;
    for (size_t i = 0; i < set->count; i++)
        own_release(set->items[i]);
    mem_free(set->items);
    mem_free(set);
}

size_t techniques_count(const lmn_techniques *set, const kind *k)
{
    return set && k->id == KIND_SURFACE ? set->count : 0;
}

const technique *techniques_at(const lmn_techniques *set, const kind *k, size_t index)
{
    return index < techniques_count(set, k) ? &set->items[index]->technique : NULL;
}

const technique *techniques_find(const lmn_techniques *set, const kind *k, const char *name)
{
    const technique *found = kind_find_technique(k, name);
    for (size_t i = 0; !found && i < techniques_count(set, k); i++)
        if (strcmp(set->items[i]->technique.name, name) == 0)
            found = &set->items[i]->technique;
    return found;
}

/* --- names ---------------------------------------------------------------------------------------------- */

static bool is_word(char c)
{
    return isalnum((unsigned char)c) || c == '_';
}

static bool is_name(const char *name, const char *others)
{
    size_t length = 0;
    for (; name[length]; length++)
        if (!strchr("abcdefghijklmnopqrstuvwxyz", name[length]) &&
            (length == 0 || !strchr("0123456789", name[length])) && (length == 0 || !strchr(others, name[length])))
            return false;
    return length > 0 && length <= NAME_MAX_LENGTH && !strstr(name, "__"); /* which GLSL keeps for itself */
}

/* Does the word stand in the text? */
static bool has_word(const char *text, const char *word)
{
    size_t length = strlen(word);
    for (const char *at = strstr(text, word); at; at = strstr(at + 1, word))
        if ((at == text || !is_word(at[-1])) && !is_word(at[length]))
            return true;
    return false;
}

/* Is there such a uniform in a file that may stand before or behind the text? */
static bool is_taken(const char *uniform)
{
    static const char *const folders[] = {"technique/", "light/", "layer/"};
    for (size_t i = 0; i < embedded_shaders_count; i++)
        for (size_t f = 0; f < sizeof folders / sizeof *folders; f++)
            if (strncmp(embedded_shaders[i].path, folders[f], strlen(folders[f])) == 0 &&
                has_word(embedded_shaders[i].data, uniform))
                return true;
    return false;
}

/* --- parameters ----------------------------------------------------------------------------------------- */

static void *keep(own_technique *own, void *block)
{
    if (!block || !mem_grow((void **)&own->kept, &own->kept_capacity, own->kept_count + 1, sizeof *own->kept)) {
        mem_free(block);
        return NULL;
    }
    own->kept[own->kept_count++] = block;
    return block;
}

static const char *keep_text(own_technique *own, const char *text)
{
    return text ? keep(own, mem_copy_text(text)) : NULL;
}

static bool find_type(lmn_param_type type, param_type *out)
{
    switch (type) {
    case LMN_PARAM_BOOL: *out = PARAM_BOOL; return true;
    case LMN_PARAM_INT: *out = PARAM_INT; return true;
    case LMN_PARAM_FLOAT: *out = PARAM_FLOAT; return true;
    case LMN_PARAM_ENUM: *out = PARAM_ENUM; return true;
    case LMN_PARAM_COLOUR: *out = PARAM_COLOUR; return true;
    case LMN_PARAM_PALETTE: *out = PARAM_PALETTE; return true;
    case LMN_PARAM_DIRECTION: *out = PARAM_DIRECTION; return true;
    case LMN_PARAM_TEXT: break;
    }
    return false;
}

static bool find_unit(lmn_param_unit unit, param_unit *out)
{
    switch (unit) {
    case LMN_UNIT_NONE: *out = UNIT_NONE; return true;
    case LMN_UNIT_POINTS: *out = UNIT_PT; return true;
    case LMN_UNIT_DEGREES: *out = UNIT_DEGREES; return true;
    case LMN_UNIT_COUNT: *out = UNIT_COUNT; return true;
    case LMN_UNIT_FRACTION: *out = UNIT_FRACTION; return true;
    }
    return false;
}

static lmn_status check_key(const own_technique *own, const char *key, lmn_error *error)
{
    char uniform[NAME_MAX_LENGTH + 16];
    if (!key || !is_name(key, "_")) {
        error_set(error, LMN_USAGE, "a parameter cannot be called '%.60s'", key ? key : "");
        error_hint(error, "a-z, 0-9 and single _, beginning with a letter, at most %d", NAME_MAX_LENGTH);
        return LMN_USAGE;
    }
    for (size_t i = 0; i < own->technique.param_count; i++)
        if (strcmp(own->params[i].key, key) == 0)
            return error_set(error, LMN_USAGE, "%s is there twice", key);
    snprintf(uniform, sizeof uniform, "u_%s", key);
    /* Lines and perturbations that are drawn by the same program have theirs behind these words. */
    if (strcmp(key, "technique") == 0 || strncmp(key, "line_", 5) == 0 || strncmp(key, "perturb_", 8) == 0 ||
        is_taken(uniform))
        return error_set(error, LMN_USAGE, "%s is a name that Limner has itself", key);
    return LMN_OK;
}

static lmn_status check_range(const lmn_param_desc *row, lmn_error *error)
{
    bool   ranged = row->type == LMN_PARAM_INT || row->type == LMN_PARAM_FLOAT;
    double most = row->type == LMN_PARAM_INT ? INT32_MAX : 1e30;
    if (ranged && !(row->min < row->max && row->min >= -most && row->max <= most))
        return error_set(error, LMN_USAGE, "%s: the range %g to %g holds nothing", row->key, row->min, row->max);
    if (!isfinite(row->soft_min) || !isfinite(row->soft_max) || row->soft_min > row->soft_max)
        return error_set(error, LMN_USAGE, "%s: the slider's range %g to %g holds nothing", row->key, row->soft_min,
                         row->soft_max);
    if (row->unit == LMN_UNIT_POINTS && row->type != LMN_PARAM_FLOAT)
        return error_set(error, LMN_USAGE, "%s: points are a unit of FLOAT alone", row->key);
    return LMN_OK;
}

static lmn_status keep_names(own_technique *own, param *p, const lmn_param_desc *row, lmn_error *error)
{
    if (p->type != PARAM_ENUM)
        return LMN_OK;
    if (!row->names || row->name_count < 2)
        return error_set(error, LMN_USAGE, "%s: an ENUM needs two names at least", row->key);
    const char **names = keep(own, mem_calloc(row->name_count + 1, sizeof *names));
    if (!names)
        return error_memory(error);
    p->names = names;
    for (size_t i = 0; i < row->name_count; i++) {
        if (!row->names[i] || !is_name(row->names[i], "_-"))
            return error_set(error, LMN_USAGE, "%s cannot be '%.60s'; names are a-z, 0-9, _ and -", row->key,
                             row->names[i] ? row->names[i] : "");
        for (size_t k = 0; k < i; k++)
            if (strcmp(names[k], row->names[i]) == 0)
                return error_set(error, LMN_USAGE, "%s has the name '%s' twice", row->key, names[k]);
        names[i] = keep_text(own, row->names[i]);
        if (!names[i])
            return error_memory(error);
    }
    return LMN_OK;
}

/* The default is read as a look's value is, and so held against the range. */
static lmn_status read_standard(param *p, const char *given, lmn_error *error)
{
    param_value value;
    param       alone = *p;
    const char *text = given ? given : p->type == PARAM_BOOL ? "false" : p->type == PARAM_ENUM ? p->names[0] : "0";
    alone.offset = 0;
    memset(&value, 0, sizeof value);
    lmn_status status = param_set_text(&alone, &value, text, error);
    if (status != LMN_OK)
        return status;
    switch (p->type) {
    case PARAM_INT:
    case PARAM_ENUM: p->def = value.whole; break;
    case PARAM_FLOAT: p->def = (double)value.number; break;
    case PARAM_BOOL: p->def = value.flag; break;
    case PARAM_COLOUR: p->def_colour = value.tint; break;
    case PARAM_DIRECTION: p->def_direction = value.axis; break;
    case PARAM_PALETTE: p->def_palette = value.list; break;
    case PARAM_TEXT: break;
    }
    return LMN_OK;
}

static lmn_status add_param(own_technique *own, const lmn_param_desc *row, lmn_error *error)
{
    technique *t = &own->technique;
    param     *p = &own->params[t->param_count];
    lmn_status status = check_key(own, row->key, error);
    if (status != LMN_OK)
        return status;
    if (!find_type(row->type, &p->type) || !find_unit(row->unit, &p->unit))
        return error_set(error, LMN_USAGE, "%s: a shader's parameter cannot have the type %d or the unit %d", row->key,
                         (int)row->type, (int)row->unit);
    status = check_range(row, error);
    if (status == LMN_OK)
        status = keep_names(own, p, row, error);
    if (status != LMN_OK)
        return status;
    p->key = keep_text(own, row->key);
    p->doc = keep_text(own, row->doc ? row->doc : "");
    p->only_if = keep_text(own, row->only_if);
    if (!p->key || !p->doc || (row->only_if && !p->only_if))
        return error_memory(error);
    p->offset = t->params_size;
    p->min = row->min;
    p->max = row->max;
    p->soft_min = row->soft_min;
    p->soft_max = row->soft_max;
    p->logarithmic = row->logarithmic;
    p->as_light = row->as_light;
    t->params_size += (param_size(p->type) + ALIGNMENT - 1) / ALIGNMENT * ALIGNMENT;
    t->param_count++;
    return read_standard(p, row->standard, error);
}

static lmn_status add_params(own_technique *own, const lmn_param_desc *rows, size_t count, lmn_error *error)
{
    technique *t = &own->technique;
    lmn_status status = LMN_OK;
    own->params = keep(own, mem_calloc(count, sizeof *own->params));
    if (!own->params)
        return error_memory(error);
    t->params = own->params;
    t->params_size = ALIGNMENT; /* of none, too */
    for (size_t i = 0; i < count && status == LMN_OK; i++)
        status = add_param(own, &rows[i], error);
    for (size_t i = 0; i < count && status == LMN_OK; i++)
        status = params_condition_check(own->params[i].only_if, own->params, count, error);
    return status;
}

/* --- the shader ----------------------------------------------------------------------------------------- */

/* Is this line this directive? */
static bool is_directive(const char *line, const char *name)
{
    line += strspn(line, " \t");
    if (*line != '#')
        return false;
    line++;
    line += strspn(line, " \t");
    return strncmp(line, name, strlen(name)) == 0 && !is_word(line[strlen(name)]);
}

static lmn_status check_shader(const char *glsl, const char *file, lmn_error *error)
{
    static const char *const refused[] = {"include", "line", "version"};
    int                      number = 1;
    for (const char *line = glsl; *line; number++) {
        for (size_t i = 0; i < sizeof refused / sizeof *refused; i++)
            if (is_directive(line, refused[i])) {
                error_in_file(error, LMN_USAGE, file, number, "#%s has no place in a technique's shader", refused[i]);
                error_hint(error, "leave it out; light and the page are there without it (limner/techniques.h)");
                return LMN_USAGE;
            }
        line += strcspn(line, "\n");
        line += *line == '\n';
    }
    if (number > LINES_MAX + 1)
        return error_in_file(error, LMN_LIMIT, file, 0, "the shader has %d lines; the limit is %d", number - 1,
                             LINES_MAX);
    if (!has_word(glsl, "surface_colour")) {
        error_in_file(error, LMN_USAGE, file, 0, "the shader has no function surface_colour");
        error_hint(error, "write vec4 surface_colour(surface_point p)");
        return LMN_USAGE;
    }
    return LMN_OK;
}

/* Paths of programs tell texts apart: no two techniques of a process share one. The text ends in a newline, so that
 * what follows begins a line. */
static lmn_status put_shader(own_technique *own, const lmn_technique_desc *desc, lmn_error *error)
{
    char       path[PATH_SIZE];
    text       body = {0};
    lmn_status status = check_shader(desc->glsl, desc->file ? desc->file : desc->name, error);
    if (status != LMN_OK)
        return status;
    snprintf(path, sizeof path, "light/light.glsl+outside/%s@%llu", desc->name,
             (unsigned long long)scene_next_revision());
    text_append(&body, "%s\n", desc->glsl);
    own->surface = (surface_row){.shader = keep_text(own, path),
                                 .outside = keep(own, text_take(&body)),
                                 .label = keep_text(own, desc->file ? desc->file : desc->name),
                                 .direct = true};
    own->technique.surface = &own->surface;
    return own->surface.shader && own->surface.outside && own->surface.label ? LMN_OK : error_memory(error);
}

/* --- adding --------------------------------------------------------------------------------------------- */

static lmn_status check_desc(const lmn_techniques *set, const lmn_technique_desc *desc, lmn_error *error)
{
    if (!desc->name || !desc->glsl || (!desc->params && desc->param_count))
        return error_set(error, LMN_USAGE, "a technique needs a %s",
                         !desc->name   ? "name"
                         : !desc->glsl ? "shader (`glsl`)"
                                       : "table of parameters");
    const kind *k = kind_find(desc->kind ? desc->kind : "surface");
    if (!k)
        return kind_unknown(desc->kind, NULL, error);
    if (k->id != KIND_SURFACE)
        return error_set(error, LMN_UNSUPPORTED, "techniques of the kind '%s' cannot be added; those of 'surface' can",
                         k->name);
    if (!is_name(desc->name, "_-") || strcmp(desc->name, "none") == 0) {
        error_set(error, LMN_USAGE, "a technique cannot be called '%.60s'", desc->name);
        error_hint(error, "a-z, 0-9, _ and -, beginning with a letter, at most %d", NAME_MAX_LENGTH);
        return LMN_USAGE;
    }
    if (techniques_find(set, k, desc->name))
        return error_set(error, LMN_USAGE, "there is a %s technique '%s' already", k->name, desc->name);
    if (desc->param_count > PARAMS_MAX)
        return error_set(error, LMN_LIMIT, "'%s' has %zu parameters; the limit is %d", desc->name, desc->param_count,
                         PARAMS_MAX);
    return LMN_OK;
}

static lmn_status fill(own_technique *own, const lmn_technique_desc *desc, const lmn_param_desc *rows, lmn_error *error)
{
    own->technique.name = keep_text(own, desc->name);
    own->technique.doc = keep_text(own, desc->doc ? desc->doc : "");
    if (!own->technique.name || !own->technique.doc)
        return error_memory(error);
    lmn_status status = add_params(own, rows, desc->param_count, error);
    return status == LMN_OK ? put_shader(own, desc, error) : status;
}

lmn_status techniques_add(lmn_techniques *set, const lmn_technique_desc *desc, const lmn_param_desc *rows,
                          lmn_error *error)
{
    lmn_status status = check_desc(set, desc, error);
    if (status != LMN_OK)
        return status;
    own_technique *own = mem_calloc(1, sizeof *own);
    status = own ? fill(own, desc, rows, error) : error_memory(error);
    if (status == LMN_OK && !mem_grow((void **)&set->items, &set->capacity, set->count + 1, sizeof *set->items))
        status = error_memory(error);
    if (status == LMN_OK)
        set->items[set->count++] = own;
    else
        own_release(own);
    return status;
}
