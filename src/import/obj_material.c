/* MTL: colours, opacity and the diffuse texture of OBJ files. */
#include "import/obj.h"

#include <string.h>

#include "base/colour.h"
#include "base/error.h"
#include "base/memory.h"
#include "import/build.h"

static float encoded_to_linear(double value)
{
    return colour_to_linear(value > 0 ? value < 1 ? (float)value : 1.0f : 0.0f);
}

static bool read_colour(obj_text *t, float out[3])
{
    double v[3];
    if (!obj_number(t, &v[0]))
        return false;
    /* One number stands for grey. */
    v[1] = v[2] = v[0];
    if (obj_number(t, &v[1]))
        obj_number(t, &v[2]);
    for (int i = 0; i < 3; i++)
        out[i] = encoded_to_linear(v[i]);
    return true;
}

static bool find_loaded(const lmn_scene *s, const char *name, int32_t *out)
{
    for (size_t i = 0; i < s->image_count; i++)
        if (s->images[i].name && strcmp(s->images[i].name, name) == 0) {
            *out = (int32_t)i;
            return true;
        }
    return false;
}

/* "map_Kd [-option value …] name": with options the last word is the name, without the name may have blanks. */
static lmn_status read_texture(const import_job *job, obj_text *t, size_t material_index, lmn_error *error)
{
    char *rest = obj_rest(t);
    if (!rest)
        return error_memory(error);
    char *name = rest;
    if (rest[0] == '-') {
        char *blank = strrchr(rest, ' ');
        name = blank ? blank + 1 : rest;
    }
    obj_slash_path(name);
    int32_t    found = NONE;
    lmn_status status = LMN_OK;
    if (name[0] && !find_loaded(job->scene, name, &found))
        status = build_image_file(job, name, &found, error);
    material *m = &job->scene->materials[material_index];
    m->base_texture.image = found;
    if (rest[0] == '-' && strstr(rest, "-clamp on"))
        m->base_texture.wrap_u = m->base_texture.wrap_v = WRAP_CLAMP;
    mem_free(rest);
    return status;
}

static void set_opacity(material *m, double opacity)
{
    m->base_colour.w = opacity > 0 ? opacity < 1 ? (float)opacity : 1 : 0;
    m->alpha = m->base_colour.w < 1 ? ALPHA_BLEND : ALPHA_OPAQUE;
}

static lmn_status read_property(const import_job *job, obj_text *t, const char *word, size_t length, size_t index,
                                lmn_error *error)
{
    material *m = &job->scene->materials[index];
    float     rgb[3];
    double    value;
    if (obj_is(word, length, "Kd")) {
        if (read_colour(t, rgb))
            m->base_colour = (vec4){rgb[0], rgb[1], rgb[2], m->base_colour.w};
    } else if (obj_is(word, length, "Ke")) {
        if (read_colour(t, rgb))
            memcpy(m->emissive, rgb, sizeof rgb);
    } else if (obj_is(word, length, "d")) {
        if (obj_number(t, &value))
            set_opacity(m, value);
    } else if (obj_is(word, length, "Tr")) {
        if (obj_number(t, &value))
            set_opacity(m, 1 - value);
    } else if (obj_is(word, length, "Ns")) {
        if (obj_number(t, &value) && value > 0 && value < 1e6)
            m->shininess = (float)value;
    } else if (obj_is(word, length, "map_Kd")) {
        return read_texture(job, t, index, error);
    }
    return LMN_OK;
}

/* Programs write Kd 0 for materials whose colour is all in the texture. */
static void brighten_textured(lmn_scene *s, size_t from)
{
    for (size_t i = from; i < s->material_count; i++) {
        vec4 *c = &s->materials[i].base_colour;
        if (s->materials[i].base_texture.image != NONE && c->x == 0 && c->y == 0 && c->z == 0)
            *c = (vec4){1, 1, 1, c->w};
    }
}

static lmn_status read_lines(const import_job *job, obj_text *t, lmn_error *error)
{
    size_t      first = job->scene->material_count;
    const char *word;
    size_t      length;
    lmn_status  status = LMN_OK;
    for (; t->at < t->end && status == LMN_OK; obj_next_line(t)) {
        if (!obj_word(t, &word, &length))
            continue;
        if (obj_is(word, length, "newmtl")) {
            material *m = scene_append_material(job->scene);
            if (!m || !(m->name = obj_rest(t)))
                return error_memory(error);
            /* Without Kd: the grey of all formats. */
            m->base_colour = (vec4){BUILD_PLAIN_GREY, BUILD_PLAIN_GREY, BUILD_PLAIN_GREY, 1};
        } else if (job->scene->material_count > first) {
            status = read_property(job, t, word, length, job->scene->material_count - 1, error);
        }
    }
    brighten_textured(job->scene, first);
    return status;
}

lmn_status obj_read_library(const import_job *job, const char *name, lmn_error *error)
{
    file_data  file;
    lmn_status status = build_side_file(job, "material library", name, &file, error);
    if (status != LMN_OK || !file.data)
        return status;
    const char *begin = (const char *)file.data;
    obj_text    t = {begin, begin, begin + file.size};
    status = read_lines(job, &t, error);
    file_data_release(&file);
    return status;
}
