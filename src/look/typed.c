#include "look/typed.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "base/error.h"
#include "look/look_change.h"

_Static_assert((int)LMN_VALUE_TEXT_MAX == (int)PARAM_TEXT_MAX && (int)LMN_PALETTE_MAX == (int)PALETTE_MAX,
               "what the header promises");

enum { NUMBER_SIZE = 40 };

static bool is_number(const param *p)
{
    return p->type == PARAM_INT || p->type == PARAM_FLOAT || p->type == PARAM_BOOL || p->type == PARAM_ENUM;
}

static lmn_status other_type(const param *p, const char *wanted, lmn_error *error)
{
    return error_set(error, LMN_USAGE, "%s is no %s; its type is %s", p->key, wanted, param_type_text(p->type));
}

/* --- to text -------------------------------------------------------------------------------------------- */

/* printf writes the host's decimal point, whatever bytes that is. */
static void print_number(double value, char out[NUMBER_SIZE])
{
    char raw[NUMBER_SIZE];
    if (!isfinite(value)) {
        snprintf(out, NUMBER_SIZE, "%s", isnan(value) ? "nan" : value > 0 ? "inf" : "-inf");
        return;
    }
    for (int digits = 6; digits <= 17; digits++) { /* messages show it */
        double again;
        snprintf(raw, sizeof raw, "%.*g", digits, value);
        text_with_point(out, raw);
        if (text_is_double(out, &again) && again == value)
            return;
    }
}

lmn_status typed_print_number(const param *p, double value, char *out, lmn_error *error)
{
    char   number[NUMBER_SIZE];
    size_t names = 0;
    if (!is_number(p))
        return other_type(p, "number", error);
    print_number(value, number);
    if (p->type == PARAM_INT && fabs(value) < 1e15 && value == trunc(value))
        snprintf(number, sizeof number, "%.0f", value); /* not "1e+06" */
    if (p->type != PARAM_ENUM) {
        snprintf(out, LMN_VALUE_TEXT_MAX, "%s", number);
        return LMN_OK;
    }
    while (p->names[names])
        names++;
    if (!(value >= 0 && value < (double)names && value == trunc(value)))
        return error_set(error, LMN_USAGE, "%s is %s; allowed is a whole number from 0 to %zu", p->key, number,
                         names - 1);
    snprintf(out, LMN_VALUE_TEXT_MAX, "%s", p->names[(size_t)value]);
    return LMN_OK;
}

lmn_status typed_print_colours(const param *p, const float *rgba, size_t count, char *out, lmn_error *error)
{
    size_t most = p->type == PARAM_PALETTE ? PALETTE_MAX : 1, length = 0;
    if (p->type != PARAM_PALETTE && p->type != PARAM_COLOUR)
        return other_type(p, "colour", error);
    if (count == 0 || count > most)
        return error_set(error, LMN_USAGE, "%s has %zu colours; allowed is 1%s", p->key, count,
                         most > 1 ? " to 8" : "");
    for (size_t i = 0; i < 4 * count; i++) {
        if (!(rgba[i] >= 0 && rgba[i] <= 1))
            return error_set(error, LMN_USAGE, "%s: component %zu of colour %zu is %g; allowed is 0 to 1", p->key,
                             i % 4, i / 4, (double)rgba[i]);
        length += (size_t)snprintf(out + length, LMN_VALUE_TEXT_MAX - length, "%s%02x",
                                   i % 4   ? ""
                                   : i > 0 ? ",#"
                                           : "#",
                                   (unsigned)lroundf(rgba[i] * 255));
    }
    return LMN_OK;
}

lmn_status typed_print_direction(const param *p, const double value[3], char *out, lmn_error *error)
{
    char numbers[3][NUMBER_SIZE];
    if (p->type != PARAM_DIRECTION)
        return other_type(p, "direction", error);
    for (int i = 0; i < 3; i++)
        print_number(value[i], numbers[i]);
    snprintf(out, LMN_VALUE_TEXT_MAX, "%s,%s,%s", numbers[0], numbers[1], numbers[2]);
    return LMN_OK;
}

lmn_status typed_print_auto(const param *p, char *out, lmn_error *error)
{
    if (!p->can_auto)
        return error_set(error, LMN_USAGE, "%s cannot be auto", p->key);
    snprintf(out, LMN_VALUE_TEXT_MAX, "auto");
    return LMN_OK;
}

/* --- from values ---------------------------------------------------------------------------------------- */

static double number_of(const param *p, const void *values)
{
    const void *field = param_field(p, values);
    if (p->type == PARAM_FLOAT)
        return (double)*(const float *)field;
    return p->type == PARAM_BOOL ? *(const bool *)field : *(const int32_t *)field;
}

lmn_status typed_number(const param *p, const void *values, double *out, lmn_error *error)
{
    if (!is_number(p))
        return other_type(p, "number", error);
    *out = number_of(p, values);
    return LMN_OK;
}

lmn_status typed_colours(const param *p, const void *values, float *rgba, size_t *count, lmn_error *error)
{
    const void   *field = param_field(p, values);
    const colour *colours = field;
    if (p->type == PARAM_PALETTE) {
        colours = ((const palette *)field)->colours;
        *count = (size_t)((const palette *)field)->count;
    } else if (p->type == PARAM_COLOUR) {
        *count = !param_is_auto(p, values);
    } else {
        return other_type(p, "colour", error);
    }
    for (size_t i = 0; i < *count; i++)
        memcpy(rgba + 4 * i, (const float[]){colours[i].r, colours[i].g, colours[i].b, colours[i].a}, 4 * sizeof *rgba);
    return LMN_OK;
}

lmn_status typed_direction(const param *p, const void *values, double out[3], lmn_error *error)
{
    if (p->type != PARAM_DIRECTION)
        return other_type(p, "direction", error);
    const direction *d = param_field(p, values);
    bool             is_auto = param_is_auto(p, values);
    out[0] = is_auto ? NAN : (double)d->x;
    out[1] = is_auto ? NAN : (double)d->y;
    out[2] = is_auto ? NAN : (double)d->z;
    return LMN_OK;
}

/* --- what there is to know ------------------------------------------------------------------------------ */

static lmn_param_type type_of(param_type type)
{
    switch (type) {
    case PARAM_BOOL: return LMN_PARAM_BOOL;
    case PARAM_INT: return LMN_PARAM_INT;
    case PARAM_FLOAT: return LMN_PARAM_FLOAT;
    case PARAM_ENUM: return LMN_PARAM_ENUM;
    case PARAM_COLOUR: return LMN_PARAM_COLOUR;
    case PARAM_PALETTE: return LMN_PARAM_PALETTE;
    case PARAM_DIRECTION: return LMN_PARAM_DIRECTION;
    case PARAM_TEXT: break;
    }
    return LMN_PARAM_TEXT;
}

static lmn_param_unit unit_of(param_unit unit)
{
    switch (unit) {
    case UNIT_PT: return LMN_UNIT_POINTS;
    case UNIT_DEGREES: return LMN_UNIT_DEGREES;
    case UNIT_COUNT: return LMN_UNIT_COUNT;
    case UNIT_FRACTION: return LMN_UNIT_FRACTION;
    case UNIT_NONE: break;
    }
    return LMN_UNIT_NONE;
}

/* Fields of the table's own struct are anywhere: the default is made at the beginning of one that is large enough. */
static void put_default(lmn_param_info *out, const param *p)
{
    param       alone = *p;
    param_value value;
    alone.offset = 0;
    memset(&value, 0, sizeof value);
    params_set_defaults(&alone, 1, &value);
    param_print(&alone, &value, out->default_text, sizeof out->default_text);
    out->default_auto = param_is_auto(&alone, &value);
    if (is_number(p))
        out->default_number = number_of(&alone, &value);
}

/* A row on which a condition of the same table stands. */
static bool decides(const param *p, const char *condition)
{
    size_t length = strlen(p->key);
    for (const char *at = condition; at && *at; at += strcspn(at, "&"), at += *at == '&') {
        const char *key = at + (*at == '!');
        if (strncmp(key, p->key, length) == 0 && strchr("=<>&", key[length]))
            return true;
    }
    return false;
}

static bool decides_passes(const param *p, const kind *k, const technique *t)
{
    bool does = t->surface && (decides(p, t->surface->forward_when) || decides(p, t->surface->deferred_when) ||
                               decides(p, t->surface->light_map_when));
    for (size_t i = 0; i < t->pass_count; i++)
        does = does || decides(p, t->passes[i].when);
    for (size_t i = 0; i < t->texture_count; i++)
        does = does || decides(p, t->textures[i].when);
    for (size_t i = 0; k->id == KIND_LINES && i < kinds[KIND_COMPOSE]->technique_count; i++)
        does = does || decides(p, kinds[KIND_COMPOSE]->techniques[i]->compose->merges_when);
    return does || (t->compose && decides(p, t->compose->map_when));
}

/* A row may leave one end at 0 although that is out of its range. */
static void put_slider(lmn_param_info *out, const param *p)
{
    bool soft = p->soft_min != 0 || p->soft_max != 0;
    out->soft_min = soft && p->soft_min > p->min ? p->soft_min : p->min;
    out->soft_max = soft && p->soft_max < p->max ? p->soft_max : p->max;
}

void typed_info(lmn_param_info *out, const kind *k, const technique *t, const param *p)
{
    bool ranged = p->type == PARAM_INT || p->type == PARAM_FLOAT;
    *out = (lmn_param_info){.key = p->key,
                            .doc = p->doc ? p->doc : "",
                            .type = type_of(p->type),
                            .unit = unit_of(p->unit),
                            .min = ranged ? p->min : 0,
                            .max = ranged ? p->max : 0,
                            .logarithmic = p->logarithmic,
                            .can_auto = p->can_auto,
                            .names = p->type == PARAM_ENUM ? p->names : NULL,
                            .only_if = p->only_if,
                            .auto_from = p->auto_from,
                            .common = k && k->common_count && p >= k->common && p < k->common + k->common_count,
                            .is_file = p->is_file,
                            .is_selector = p->is_selector,
                            .compiles = k && (param_compiles(p) || decides_passes(p, k, t))};
    if (ranged)
        put_slider(out, p);
    while (out->names && out->names[out->name_count])
        out->name_count++;
    put_default(out, p);
}

bool typed_applies(const kind *k, const technique_use *use, const param *p)
{
    const technique *t = use->technique;
    return params_condition(p->only_if, t->params, t->param_count, use->values) ||
           params_condition(p->only_if, k->common, k->common_count, use->values);
}
