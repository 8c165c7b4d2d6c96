/* Materials and textures of CityJSON. */
#include <math.h>
#include <string.h>

#include "base/colour.h"
#include "base/memory.h"
#include "import/build.h"
#include "import/cityjson.h"

enum { APPEARANCES_MAX = 1 << 20 };

bool cityjson_find_theme(json_span themes, json_span wanted, json_span *out)
{
    bool found = false;
    if (!themes.at || themes.at[0] != '{')
        return false;
    json_scan s = scan_of(themes);
    for (bool more = scan_open(&s, '{'); more; more = scan_next(&s, '}')) {
        json_span key = scan_key(&s), value = scan_skip(&s);
        bool      right = wanted.at && key.size == wanted.size && memcmp(key.at, wanted.at, key.size) == 0;
        if ((right || !found) && value.size && value.at[0] == '{')
            *out = value;
        found = found || (value.size && value.at[0] == '{');
        if (right)
            break;
    }
    return found;
}

static float clamp_unit(double value)
{
    return value > 0 ? value < 1 ? (float)value : 1.0f : 0.0f;
}

static void read_colour(json_scan *s, vec4 *out)
{
    float rgb[3] = {1, 1, 1};
    int   k = 0;
    for (bool more = scan_open(s, '['); more; more = scan_next(s, ']'), k++) {
        double value = 0;
        scan_number(s, &value);
        if (k < 3)
            rgb[k] = colour_to_linear(clamp_unit(value));
    }
    *out = (vec4){rgb[0], rgb[1], rgb[2], out->w};
}

static void read_material(cityjson_reader *r, json_scan *s)
{
    int32_t  *grown = mem_realloc(r->materials, (r->material_count + 1) * sizeof *grown);
    material *m = grown ? scene_append_material(r->scene) : NULL;
    if (grown)
        r->materials = grown;
    if (!m) {
        cityjson_no_memory(r);
        return;
    }
    r->materials[r->material_count++] = (int32_t)r->scene->material_count - 1;
    for (bool more = scan_open(s, '{'); more; more = scan_next(s, '}')) {
        json_span key = scan_key(s);
        double    value = 0;
        if (span_is(key, "name") && scan_peek(s) == '"') {
            mem_free(m->name);
            m->name = span_decode(scan_string(s));
        } else if (span_is(key, "diffuseColor") && scan_peek(s) == '[') {
            read_colour(s, &m->base_colour);
        } else if (span_is(key, "transparency") && scan_number(s, &value)) {
            m->base_colour.w = 1 - clamp_unit(value);
            m->alpha = value > 0 ? ALPHA_BLEND : ALPHA_OPAQUE;
        } else if (!span_is(key, "transparency")) {
            scan_skip(s);
        }
    }
}

static void read_textures(cityjson_reader *r, json_scan *s)
{
    for (bool more = scan_open(s, '['); more; more = scan_next(s, ']')) {
        json_span  span = scan_skip(s);
        json_span *spans = mem_realloc(r->texture_spans, (r->texture_count + 1) * sizeof *spans);
        int32_t   *list = mem_realloc(r->textures, (r->texture_count + 1) * sizeof *list);
        r->texture_spans = spans ? spans : r->texture_spans;
        r->textures = list ? list : r->textures;
        if (!spans || !list || r->texture_count == APPEARANCES_MAX) {
            cityjson_no_memory(r);
            return;
        }
        r->texture_spans[r->texture_count] = span;
        r->textures[r->texture_count++] = NONE;
    }
}

static void read_places(cityjson_reader *r, json_scan *s)
{
    size_t capacity = r->uv_count;
    for (bool more = scan_open(s, '['); more; more = scan_next(s, ']')) {
        double uv[2] = {0, 0}, ignored;
        int    k = 0;
        for (bool next = scan_open(s, '['); next; next = scan_next(s, ']'), k++)
            scan_number(s, k < 2 ? &uv[k] : &ignored);
        if (!mem_grow((void **)&r->uvs, &capacity, r->uv_count + 1, sizeof *r->uvs)) {
            cityjson_no_memory(r);
            return;
        }
        bool finite = fabs(uv[0]) < 1e6 && fabs(uv[1]) < 1e6;
        r->uvs[r->uv_count++] = finite ? (vec2){(float)uv[0], (float)(1 - uv[1])} : (vec2){0, 0};
    }
}

void cityjson_read_appearance(cityjson_reader *r, json_span appearance)
{
    if (!appearance.at || appearance.at[0] != '{')
        return;
    json_scan s = scan_of(appearance);
    for (bool more = scan_open(&s, '{'); more && r->status == LMN_OK; more = scan_next(&s, '}')) {
        json_span key = scan_key(&s);
        char      opens = scan_peek(&s);
        if (span_is(key, "default-theme-material"))
            r->material_theme = scan_string(&s);
        else if (span_is(key, "default-theme-texture"))
            r->texture_theme = scan_string(&s);
        else if (span_is(key, "materials") && opens == '[')
            for (bool more_of = scan_open(&s, '['); more_of; more_of = scan_next(&s, ']'))
                read_material(r, &s);
        else if (span_is(key, "textures") && opens == '[')
            read_textures(r, &s);
        else if (span_is(key, "vertices-texture") && opens == '[')
            read_places(r, &s);
        else
            scan_skip(&s);
    }
    cityjson_good(r, &s);
}

void cityjson_end_appearance(cityjson_reader *r)
{
    mem_free(r->materials);
    mem_free(r->textures);
    mem_free(r->texture_spans);
    mem_free(r->uvs);
    r->materials = r->textures = NULL;
    r->texture_spans = NULL;
    r->uvs = NULL;
    r->material_count = r->texture_count = r->uv_count = 0;
    r->material_theme = r->texture_theme = (json_span){0};
}

static wrap_mode wrap_of(json_span name)
{
    return span_is(name, "mirror")                                                      ? WRAP_MIRROR
           : span_is(name, "clamp") || span_is(name, "border") || span_is(name, "none") ? WRAP_CLAMP
                                                                                        : WRAP_REPEAT;
}

static void make_texture(cityjson_reader *r, json_span span, int32_t *out)
{
    char     *name = NULL;
    wrap_mode wrap = WRAP_REPEAT;
    int32_t   picture = NONE;
    json_scan s = scan_of(span);
    for (bool more = scan_open(&s, '{'); more; more = scan_next(&s, '}')) {
        json_span key = scan_key(&s);
        if (span_is(key, "image") && scan_peek(&s) == '"' && !name)
            name = span_decode(scan_string(&s));
        else if (span_is(key, "wrapMode"))
            wrap = wrap_of(scan_string(&s));
        else
            scan_skip(&s);
    }
    if (cityjson_good(r, &s) && name && name[0])
        r->status = build_image_file(r->job, name, &picture, r->error);
    material *m = r->status == LMN_OK && picture != NONE ? scene_append_material(r->scene) : NULL;
    if (m) {
        m->name = name;
        name = NULL;
        m->base_texture.image = picture;
        m->base_texture.wrap_u = m->base_texture.wrap_v = wrap;
        *out = (int32_t)r->scene->material_count - 1;
    } else if (r->status == LMN_OK && picture != NONE) {
        cityjson_no_memory(r);
    }
    mem_free(name);
}

int32_t cityjson_texture(cityjson_reader *r, size_t index)
{
    enum { CANNOT = -2 };
    if (r->textures[index] == NONE && r->status == LMN_OK) {
        int32_t made = NONE;
        make_texture(r, r->texture_spans[index], &made);
        r->textures[index] = made == NONE ? CANNOT : made;
    }
    return r->textures[index] == CANNOT ? NONE : r->textures[index];
}
