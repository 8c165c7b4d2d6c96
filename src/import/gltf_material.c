/* Images, textures and materials. */
#include <stdio.h>
#include <string.h>

#include "base/memory.h"
#include "import/build.h"
#include "import/gltf.h"

enum { FILTER_NEAREST = 9728, WRAP_CLAMP_TO_EDGE = 33071, WRAP_MIRRORED = 33648 };

/* The image's bytes: in a view, a data URI or a file. */
static void load_image(gltf_reader *r, json_t *object, size_t index, int32_t *out)
{
    char   where[GLTF_WHERE], label[GLTF_WHERE];
    size_t view_index;
    snprintf(where, sizeof where, "images[%zu]", index);
    const char *name = json_string_value(json_object_get(object, "name"));
    snprintf(label, sizeof label, "%.100s", name && name[0] ? name : where);
    json_t *uri = gltf_member(r, object, "uri", JSON_STRING, where);
    if (gltf_index(r, object, "bufferView", r->view_count, "bufferViews", where, &view_index)) {
        const gltf_view *v = gltf_get_view(r, view_index, where);
        if (v)
            r->status = build_image_bytes(r->job, label, v->data, v->size, out, r->error);
        return;
    }
    if (r->status != LMN_OK || !uri)
        return;
    unsigned char *owned;
    char          *file_name;
    file_data      file;
    if (gltf_load_uri(r, json_string_value(uri), "texture", &owned, &file, &file_name))
        r->status = build_image_bytes(r->job, file_name ? file_name : label, file.data, file.size, out, r->error);
    mem_free(file_name);
    if (owned)
        mem_free(owned);
    else
        file_data_release(&file);
}

/* Decoded at its first use; NONE when it cannot be had. */
static int32_t get_image(gltf_reader *r, size_t index)
{
    json_t       *object = gltf_item(r, "images", index);
    const int32_t failed = -2;
    if (!object)
        return NONE;
    if (r->image_map[index] == NONE) {
        int32_t loaded = NONE;
        load_image(r, object, index, &loaded);
        r->image_map[index] = loaded == NONE ? failed : loaded;
    }
    return r->image_map[index] == failed ? NONE : r->image_map[index];
}

static wrap_mode wrap_of(double value)
{
    return value == WRAP_CLAMP_TO_EDGE ? WRAP_CLAMP : value == WRAP_MIRRORED ? WRAP_MIRROR : WRAP_REPEAT;
}

static void read_sampler(gltf_reader *r, json_t *texture, const char *where, texture_use *use)
{
    size_t index;
    if (!gltf_index(r, texture, "sampler", gltf_count(r, "samplers"), "samplers", where, &index))
        return;
    json_t *sampler = gltf_item(r, "samplers", index);
    use->wrap_u = wrap_of(gltf_number(sampler, "wrapS", 0));
    use->wrap_v = wrap_of(gltf_number(sampler, "wrapT", 0));
    use->nearest = gltf_number(sampler, "magFilter", 0) == FILTER_NEAREST;
}

static void read_transform(json_t *info, texture_use *use, double *uv_set)
{
    json_t *transform = gltf_extension(info, "KHR_texture_transform");
    double  pair[2];
    if (gltf_numbers(transform, "offset", pair, 2)) {
        use->offset[0] = (float)pair[0];
        use->offset[1] = (float)pair[1];
    }
    if (gltf_numbers(transform, "scale", pair, 2)) {
        use->scale[0] = (float)pair[0];
        use->scale[1] = (float)pair[1];
    }
    use->rotation = (float)gltf_number(transform, "rotation", 0);
    *uv_set = gltf_number(transform, "texCoord", *uv_set);
}

static void read_texture(gltf_reader *r, json_t *parent, const char *key, const char *where, texture_use *use)
{
    char    here[GLTF_WHERE];
    size_t  index, source, images = r->image_count;
    json_t *info = gltf_member(r, parent, key, JSON_OBJECT, where);
    if (!info || !gltf_index(r, info, "index", gltf_count(r, "textures"), "textures", where, &index))
        return;
    json_t *texture = gltf_item(r, "textures", index);
    snprintf(here, sizeof here, "textures[%zu]", index);
    json_t *webp = gltf_extension(texture, "EXT_texture_webp");
    bool    found = (webp && gltf_index(r, webp, "source", images, "images", here, &source)) ||
                 gltf_index(r, texture, "source", images, "images", here, &source);
    if (!found) {
        if (r->status == LMN_OK)
            gltf_warn(r, WARNING_IGNORED, "%s: no image that limner reads", here);
        return;
    }
    double uv_set = gltf_number(info, "texCoord", 0);
    read_sampler(r, texture, here, use);
    read_transform(info, use, &uv_set);
    /* Files may have any number there, also ones that no integer can hold. */
    if (uv_set >= 0 && uv_set < UV_SETS)
        use->uv_set = (int32_t)uv_set;
    else
        gltf_warn(r, WARNING_IGNORED, "texture coordinate set %.15g of %s; set 0 is used", uv_set, where);
    use->image = get_image(r, source);
}

static void read_colour(json_t *object, const char *key, vec4 *out)
{
    double rgba[4];
    if (gltf_numbers(object, key, rgba, 4))
        *out = (vec4){(float)rgba[0], (float)rgba[1], (float)rgba[2], (float)rgba[3]};
}

static void read_emissive(json_t *object, material *m)
{
    double rgb[3];
    double strength = gltf_number(gltf_extension(object, "KHR_materials_emissive_strength"), "emissiveStrength", 1);
    if (!gltf_numbers(object, "emissiveFactor", rgb, 3))
        return;
    for (int i = 0; i < 3; i++)
        m->emissive[i] = (float)(rgb[i] * strength);
}

static void read_material(gltf_reader *r, size_t index)
{
    char    where[GLTF_WHERE];
    json_t *object = gltf_item(r, "materials", index);
    if (!object)
        return;
    if (!scene_append_material(r->scene)) {
        gltf_out_of_memory(r);
        return;
    }
    material *m = &r->scene->materials[r->scene->material_count - 1];
    snprintf(where, sizeof where, "materials[%zu]", index);
    m->name = gltf_name(r, object);
    json_t *metal = gltf_member(r, object, "pbrMetallicRoughness", JSON_OBJECT, where);
    json_t *gloss = gltf_extension(object, "KHR_materials_pbrSpecularGlossiness");
    read_colour(metal, "baseColorFactor", &m->base_colour);
    read_texture(r, metal, "baseColorTexture", where, &m->base_texture);
    if (gloss && !metal) {
        read_colour(gloss, "diffuseFactor", &m->base_colour);
        read_texture(r, gloss, "diffuseTexture", where, &m->base_texture);
    }
    read_texture(r, object, "normalTexture", where, &m->normal_texture);
    m->normal_scale = (float)gltf_number(json_object_get(object, "normalTexture"), "scale", 1);
    read_emissive(object, m);
    const char *alpha = json_string_value(json_object_get(object, "alphaMode"));
    m->alpha = !alpha || strcmp(alpha, "OPAQUE") == 0 ? ALPHA_OPAQUE
               : strcmp(alpha, "MASK") == 0           ? ALPHA_MASK
                                                      : ALPHA_BLEND;
    m->alpha_cutoff = (float)gltf_number(object, "alphaCutoff", 0.5);
    m->double_sided = gltf_true(object, "doubleSided");
    m->unlit = gltf_extension(object, "KHR_materials_unlit") != NULL;
}

void gltf_read_materials(gltf_reader *r)
{
    size_t count = gltf_count(r, "materials");
    for (size_t i = 0; i < count && r->status == LMN_OK; i++)
        read_material(r, i);
}
