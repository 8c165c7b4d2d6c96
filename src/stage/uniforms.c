#include "stage/uniforms.h"

#include <ctype.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

void uniforms_capitals(const char *key, char out[CAPITALS_SIZE])
{
    size_t i = 0;
    for (; key[i] && i + 1 < CAPITALS_SIZE; i++)
        out[i] = (char)toupper((unsigned char)key[i]);
    out[i] = '\0';
}

void target_declare(text *prelude, const target_row *row)
{
    char capitals[CAPITALS_SIZE];
    uniforms_capitals(row->name + 2, capitals);
    text_append(prelude, "#ifndef HAS_%s\n#define HAS_%s\nuniform %s %s;\n#endif\n", capitals, capitals,
                row->format == TEXEL_RG32UI || row->format == TEXEL_RGBA32UI ? "usampler2D" : "sampler2D", row->name);
}

static void declare_variant(text *prelude, const param *p, const void *values)
{
    char name[CAPITALS_SIZE];
    uniforms_capitals(p->key, name);
    const void *field = param_field(p, values);
    int         value = p->type == PARAM_BOOL ? *(const bool *)field : *(const int32_t *)field;
    text_append(prelude, "#define %s %d\n", name, value);
}

static void declare_toggle(text *prelude, const param *p, const void *values)
{
    char name[CAPITALS_SIZE];
    uniforms_capitals(p->key, name);
    if (*(const float *)param_field(p, values) != 0)
        text_append(prelude, "#define WITH_%s\n", name);
}

void uniforms_declare(text *prelude, param_set set)
{
    static const char *const types[] = {
        [PARAM_INT] = "int",     [PARAM_FLOAT] = "float",    [PARAM_BOOL] = "bool",    [PARAM_ENUM] = "int",
        [PARAM_COLOUR] = "vec4", [PARAM_DIRECTION] = "vec3", [PARAM_PALETTE] = "vec4", [PARAM_TEXT] = "int",
    };
    for (size_t i = 0; i < set.count; i++) {
        const param *p = &set.params[i];
        if (p->cpu_only)
            continue;
        if (p->toggles)
            declare_toggle(prelude, p, set.values);
        if (p->variant)
            declare_variant(prelude, p, set.values);
        else if (p->type == PARAM_PALETTE)
            text_append(prelude, "uniform vec4 %s%s[%d];\nuniform int %s%s_count;\n", set.prefix, p->key, PALETTE_MAX,
                        set.prefix, p->key);
        else
            text_append(prelude, "uniform %s %s%s;\n", p->as_turn ? "vec2" : types[p->type], set.prefix, p->key);
    }
}

void uniforms_light(colour c, float out[4])
{
    out[0] = colour_to_linear(c.r);
    out[1] = colour_to_linear(c.g);
    out[2] = colour_to_linear(c.b);
    out[3] = c.a;
}

static colour colour_of(param_set set, const param *p)
{
    colour c = *(const colour *)param_field(p, set.values);
    if (!isnan(c.r) || !p->auto_from)
        return c;
    for (size_t i = 0; i < set.count; i++)
        if (strcmp(set.params[i].key, p->auto_from) == 0)
            return *(const colour *)param_field(&set.params[i], set.values);
    return c;
}

static void colour_values(colour c, bool as_light, float out[4])
{
    if (as_light)
        uniforms_light(c, out);
    else
        memcpy(out, (float[]){c.r, c.g, c.b, c.a}, 4 * sizeof *out);
}

static void set_palette(gpu *g, const char *name, const palette *p, bool as_light)
{
    float values[PALETTE_MAX][4];
    memset(values, 0, sizeof values);
    for (int i = 0; i < p->count; i++)
        colour_values(p->colours[i], as_light, values[i]);
    char count_name[80];
    snprintf(count_name, sizeof count_name, "%s_count", name);
    gpu_set_int(g, count_name, p->count);
    gpu_set_vec4_array(g, name, values[0], PALETTE_MAX);
}

static float float_of(const param *p, float value)
{
    return p->as_cosine ? cosf(value * (3.14159265f / 180)) : value;
}

static void set_turn(gpu *g, const char *name, float degrees)
{
    double radians = (double)degrees * (3.14159265358979323846 / 180);
    gpu_set_vec2(g, name, (float)cos(radians), (float)sin(radians));
}

void uniforms_set(gpu *g, param_set set)
{
    for (size_t i = 0; i < set.count; i++) {
        const param *p = &set.params[i];
        if (p->cpu_only || p->variant)
            continue;
        char name[72];
        snprintf(name, sizeof name, "%s%s", set.prefix, p->key);
        const void *field = param_field(p, set.values);
        float       values[4];
        switch (p->type) {
        case PARAM_INT:
        case PARAM_ENUM: gpu_set_int(g, name, *(const int32_t *)field); break;
        case PARAM_BOOL: gpu_set_int(g, name, *(const bool *)field); break;
        case PARAM_FLOAT:
            if (p->as_turn)
                set_turn(g, name, *(const float *)field);
            else
                gpu_set_float(g, name, float_of(p, *(const float *)field));
            break;
        case PARAM_COLOUR:
            colour_values(colour_of(set, p), p->as_light, values);
            gpu_set_vec4(g, name, values);
            break;
        case PARAM_DIRECTION: gpu_set_vec3(g, name, (const float *)field); break;
        case PARAM_PALETTE: set_palette(g, name, field, p->as_light); break;
        case PARAM_TEXT: break;
        }
    }
}
