/* Appearances of CityGML: materials and textures, and what they are of. */
#include <math.h>
#include <string.h>

#include "base/colour.h"
#include "base/memory.h"
#include "import/build.h"
#include "import/citygml.h"

static bool next_number(const char **at, double *out)
{
    while (**at && strchr(" \t\r\n,", **at))
        ++*at;
    const char *behind = text_parse_double(*at, *at + strlen(*at), out);
    if (!behind || !isfinite(*out))
        return false;
    *at = behind;
    return true;
}

static float clamp_unit(double value)
{
    return value > 0 ? value < 1 ? (float)value : 1.0f : 0.0f;
}

static gml_id target_of(const char *uri)
{
    return uri[0] == '#' && uri[1] ? gml_id_of(uri + 1, strlen(uri + 1)) : 0;
}

static void open_material(citygml_reader *r)
{
    material *m = scene_append_material(r->scene);
    r->in_material = true;
    r->in_texture = false;
    r->material = m ? (int32_t)r->scene->material_count - 1 : NONE;
    if (m)
        m->name = mem_copy_text("material");
    if (!m || !m->name)
        citygml_no_memory(r);
}

bool citygml_open_appearance(citygml_reader *r, const char *name, const char *uri, const char *ring)
{
    if (strcmp(name, "X3DMaterial") == 0) {
        open_material(r);
        return false;
    }
    if (strcmp(name, "ParameterizedTexture") == 0 || strcmp(name, "GeoreferencedTexture") == 0) {
        r->in_texture = true;
        r->in_material = false;
        r->material = NONE;
        r->wrap = WRAP_REPEAT;
        r->foreign += name[0] == 'G';
        return false;
    }
    if (r->in_material)
        return strcmp(name, "diffuseColor") == 0 || strcmp(name, "transparency") == 0 || strcmp(name, "target") == 0;
    if (!r->in_texture)
        return false;
    if (strcmp(name, "textureCoordinates") == 0)
        r->target = target_of(ring);
    (void)uri; /* of the polygon; places name its rings */
    return strcmp(name, "imageURI") == 0 || strcmp(name, "wrapMode") == 0 || strcmp(name, "textureCoordinates") == 0 ||
           strcmp(name, "ring") == 0;
}

static void put_colour(material *m, const char *words)
{
    double rgb[3];
    for (int k = 0; k < 3; k++)
        if (!next_number(&words, &rgb[k]))
            return;
    m->base_colour.x = colour_to_linear(clamp_unit(rgb[0]));
    m->base_colour.y = colour_to_linear(clamp_unit(rgb[1]));
    m->base_colour.z = colour_to_linear(clamp_unit(rgb[2]));
}

static void close_in_material(citygml_reader *r, const char *name, const char *words)
{
    material *m = &r->scene->materials[r->material];
    double    value;
    if (strcmp(name, "diffuseColor") == 0) {
        put_colour(m, words);
    } else if (strcmp(name, "transparency") == 0 && next_number(&words, &value)) {
        m->base_colour.w = 1 - clamp_unit(value);
        m->alpha = value > 0 ? ALPHA_BLEND : ALPHA_OPAQUE;
    } else if (strcmp(name, "target") == 0 && target_of(words)) {
        gml_paint *p = GML_APPEND(r, paints);
        if (p)
            *p = (gml_paint){target_of(words), r->material};
    }
}

static void load_texture(citygml_reader *r, const char *name)
{
    int32_t picture = NONE;
    if (!name[0])
        return;
    r->status = build_image_file(r->job, name, &picture, r->error);
    material *m = r->status == LMN_OK && picture != NONE ? scene_append_material(r->scene) : NULL;
    if (!m) {
        if (r->status == LMN_OK && picture != NONE)
            citygml_no_memory(r);
        return;
    }
    m->base_texture.image = picture;
    m->name = mem_copy_text(name);
    r->material = (int32_t)r->scene->material_count - 1;
    if (!m->name)
        citygml_no_memory(r);
}

static void set_wrap(citygml_reader *r, const char *words)
{
    wrap_mode wrap = strcmp(words, "mirror") == 0                           ? WRAP_MIRROR
                     : strcmp(words, "wrap") == 0 || strcmp(words, "") == 0 ? WRAP_REPEAT
                                                                            : WRAP_CLAMP;
    if (r->material == NONE)
        return;
    r->scene->materials[r->material].base_texture.wrap_u = wrap;
    r->scene->materials[r->material].base_texture.wrap_v = wrap;
}

static void read_places(citygml_reader *r, const char *words)
{
    double      uv[2];
    gml_places *p = r->material == NONE ? NULL : GML_APPEND(r, places);
    if (!p)
        return;
    *p = (gml_places){.ring = r->target, .material = r->material, .first = (uint32_t)r->uvs_count};
    while (r->status == LMN_OK && next_number(&words, &uv[0]) && next_number(&words, &uv[1])) {
        vec2 *to = GML_APPEND(r, uvs);
        if (to)
            *to = (vec2){(float)uv[0], (float)(1 - uv[1])};
        p->count++;
    }
}

static void close_in_texture(citygml_reader *r, const char *name, const char *words)
{
    if (strcmp(name, "imageURI") == 0)
        load_texture(r, words);
    else if (strcmp(name, "wrapMode") == 0)
        set_wrap(r, words);
    else if (strcmp(name, "textureCoordinates") == 0)
        read_places(r, words);
    else if (strcmp(name, "ring") == 0 && r->places_count &&
             target_of(words)) /* version 3.0 has it behind the places */
        r->places[r->places_count - 1].ring = target_of(words);
}

bool citygml_close_appearance(citygml_reader *r, const char *name, const char *text)
{
    if (strcmp(name, "X3DMaterial") == 0 || strcmp(name, "ParameterizedTexture") == 0 ||
        strcmp(name, "GeoreferencedTexture") == 0) {
        r->in_material = r->in_texture = false;
        r->material = NONE;
        return true;
    }
    if (!text[0] || r->status != LMN_OK)
        return false;
    if (r->in_material && r->material != NONE)
        close_in_material(r, name, text);
    else if (r->in_texture)
        close_in_texture(r, name, text);
    return r->in_material || r->in_texture;
}
