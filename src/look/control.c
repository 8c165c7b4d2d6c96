#include "look/control.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "base/limits.h"
#include "base/memory.h"
#include "base/text.h"
#include "look/look.h"
#include "look/look_edit.h"

static void control_release(control *c)
{
    for (size_t m = 0; m < c->map_count; m++)
        mem_free(c->maps[m].key);
    mem_free(c->maps);
    *c = (control){0};
}

const control_row control_rows[CONTROL_COUNT] = {
    {"weight", "How heavy lines and strokes are."},
    {"darkness", "How dark the tones are."},
    {"detail", "How much is drawn: small edges, crowded lines, textures."},
    {"looseness", "How freely it is drawn: wavering, uneven, overrun."},
    {"scale", "How large the marks are: distance of strokes, dots, dashes, waves."},
};

lmn_status control_find(size_t *out, const char *name, lmn_error *error)
{
    const char *names[CONTROL_COUNT];
    for (*out = 0; *out < CONTROL_COUNT; ++*out) {
        names[*out] = control_rows[*out].name;
        if (strcmp(name, names[*out]) == 0)
            return LMN_OK;
    }
    lmn_status  status = error_set(error, LMN_USAGE, "there is no control '%.60s'", name);
    const char *near = text_nearest(name, names, CONTROL_COUNT);
    if (near)
        error_hint(error, "did you mean '%s'?", near);
    else
        error_hint(error, "controls are weight, darkness, detail, looseness and scale");
    return status;
}

static lmn_status missing(const lmn_look *look, size_t index, lmn_error *error)
{
    char   has[96] = "";
    size_t length = 0;
    for (size_t i = 0; i < CONTROL_COUNT; i++)
        if (look->controls[i].map_count)
            length +=
                (size_t)snprintf(has + length, sizeof has - length, "%s%s", length ? ", " : "", control_rows[i].name);
    lmn_status status =
        error_set(error, LMN_USAGE, "look '%.60s' has no control '%s'", look->name, control_rows[index].name);
    if (length)
        error_hint(error, "it has %s", has);
    else
        error_hint(error, "a look file says under \"controls\" what its controls change");
    return status;
}

lmn_status look_set_control(lmn_look *look, size_t index, double value, lmn_error *error)
{
    if (!look->controls[index].map_count)
        return missing(look, index, error);
    if (!(value >= -1 && value <= 1))
        return error_set(error, LMN_USAGE, "%s is %g; allowed is -1 to 1, and 0 is the look as it is",
                         control_rows[index].name, value);
    look->controls[index].value = value;
    return LMN_OK;
}

lmn_status control_check_key(const lmn_look *look, const char *key, lmn_error *error)
{
    const param *p;
    lmn_status   status = look_param_of_key(&p, look, key, error);
    if (status == LMN_OK && p->type != PARAM_INT && p->type != PARAM_FLOAT)
        return error_set(error, LMN_USAGE, "'%.120s' is no number, so no control can change it", key);
    return status;
}

static lmn_status set_map(control_map *out, const lmn_look *look, const lmn_control_map *map, lmn_error *error)
{
    if (!map->param)
        return error_set(error, LMN_USAGE, "param is NULL");
    lmn_status status = control_check_key(look, map->param, error);
    if (status != LMN_OK)
        return status;
    if (!isfinite(map->low) || !isfinite(map->high) || (map->times && (map->low <= 0 || map->high <= 0)))
        return error_set(error, LMN_USAGE, "'%.120s': %s", map->param,
                         map->times ? "factors must be above 0" : "what is added must be finite");
    *out = (control_map){mem_copy_text(map->param), map->times, map->low, map->high};
    return out->key ? LMN_OK : error_memory(error);
}

lmn_status look_set_control_maps(lmn_look *look, size_t index, const lmn_control_map *maps, size_t count,
                                 lmn_error *error)
{
    control *c = &look->controls[index];
    if (count > LIMIT_LOOK_TECHNIQUES)
        return error_set(error, LMN_LIMIT, "%s has %zu maps; the limit is %d", control_rows[index].name, count,
                         LIMIT_LOOK_TECHNIQUES);
    control_release(c);
    c->maps = count ? mem_calloc(count, sizeof *c->maps) : NULL;
    if (count && !c->maps)
        return error_memory(error);
    lmn_status status = LMN_OK;
    for (; c->map_count < count && status == LMN_OK; c->map_count += status == LMN_OK)
        status = set_map(&c->maps[c->map_count], look, &maps[c->map_count], error);
    return status;
}

bool look_controls_are_set(const lmn_look *look)
{
    for (size_t i = 0; i < CONTROL_COUNT; i++)
        if (look->controls[i].value != 0)
            return true;
    return false;
}

bool look_controls_are_alike(const lmn_look *a, const lmn_look *b)
{
    for (size_t i = 0; i < CONTROL_COUNT; i++) {
        const control *one = &a->controls[i], *other = &b->controls[i];
        if (one->value != other->value || one->map_count != other->map_count)
            return false;
        for (size_t m = 0; m < one->map_count; m++)
            if (strcmp(one->maps[m].key, other->maps[m].key) != 0 || one->maps[m].times != other->maps[m].times ||
                one->maps[m].low != other->maps[m].low || one->maps[m].high != other->maps[m].high)
                return false;
    }
    return true;
}

/* --- what they do --------------------------------------------------------------------------------------- */

typedef struct push {
    const control_map *map;
    double             value;
} push;

static double pushed(const push *by, double number, double min, double max)
{
    double end = by->value < 0 ? by->map->low : by->map->high, way = fabs(by->value);
    double moved = by->map->times ? number * pow(end, way) : number + end * way;
    /* A parameter that somebody set beyond what the control reaches is never drawn back. */
    return fmin(fmax(moved, fmin(min, number)), fmax(max, number));
}

static void push_param(const param *p, void *values, void *user)
{
    void *field = (char *)values + p->offset;
    if (p->type == PARAM_INT)
        *(int32_t *)field = (int32_t)lround(pushed(user, *(int32_t *)field, p->min, p->max));
    else if (p->type == PARAM_FLOAT && !isnan(*(float *)field))
        *(float *)field = (float)pushed(user, (double)*(float *)field, p->min, p->max);
}

void look_apply_controls(lmn_look *look)
{
    for (size_t i = 0; i < CONTROL_COUNT; i++)
        for (size_t m = 0; m < look->controls[i].map_count && look->controls[i].value != 0; m++) {
            push by = {&look->controls[i].maps[m], look->controls[i].value};
            look_visit_params(look, by.map->key, push_param, &by);
        }
}

/* --- memory --------------------------------------------------------------------------------------------- */

bool controls_copy(control out[CONTROL_COUNT], const control from[CONTROL_COUNT])
{
    for (size_t i = 0; i < CONTROL_COUNT; i++) {
        out[i] = (control){.value = from[i].value};
        if (!from[i].map_count)
            continue;
        out[i].maps = mem_calloc(from[i].map_count, sizeof *out[i].maps);
        if (!out[i].maps)
            return false;
        for (; out[i].map_count < from[i].map_count; out[i].map_count++) {
            control_map *map = &out[i].maps[out[i].map_count];
            *map = from[i].maps[out[i].map_count];
            map->key = mem_copy_text(map->key);
            if (!map->key)
                return false;
        }
    }
    return true;
}

void controls_release(control controls[CONTROL_COUNT])
{
    for (size_t i = 0; i < CONTROL_COUNT; i++)
        control_release(&controls[i]);
}
