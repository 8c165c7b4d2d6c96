#include "stage/made_textures.h"

#include <stdio.h>
#include <string.h>

#include "base/memory.h"
#include "stage/uniforms.h"
#include "base/store.h"

enum { DRAWINGS_KEPT = 8, NAME_SIZE = 48 };

static void release_item(made_texture *item, gpu *g)
{
    gpu_texture_destroy(g, &item->texture);
    mem_free(item->description);
}

void made_textures_release(made_textures *all, gpu *g)
{
    for (size_t i = 0; i < all->count; i++)
        release_item(&all->items[i], g);
    mem_free(all->items);
    memset(all, 0, sizeof *all);
}

void made_textures_trim(made_textures *all, gpu *g)
{
    size_t kept = 0;
    all->clock++;
    for (size_t i = 0; i < all->count; i++) {
        if (all->items[i].used + DRAWINGS_KEPT >= all->clock)
            all->items[kept++] = all->items[i];
        else
            release_item(&all->items[i], g);
    }
    all->count = kept;
}

/* From the disk, or made and kept there. */
static lmn_status bring(mip_chain *out, const texture_source *source, const void *values, const char *description,
                        lmn_error *error)
{
    if (source->kept && store_find(out, description))
        return LMN_OK;
    lmn_status status = source->make(out, values, error);
    if (status == LMN_OK && source->kept)
        store_keep(out, description);
    return status;
}

static gpu_texture *put_up(gpu *g, const mip_chain *chain)
{
    static const gpu_format formats[] = {[MIP_R8] = GPU_R8, [MIP_RG8] = GPU_RG8, [MIP_RG16F] = GPU_RG16F};
    const void             *data[MIP_LEVELS_MAX];
    for (int k = 0; k < chain->levels; k++)
        data[k] = chain->data[k];
    return gpu_texture_of_levels(g, &(gpu_levels){.width = chain->width,
                                                  .height = chain->height,
                                                  .layers = chain->layers,
                                                  .levels = chain->levels,
                                                  .format = formats[chain->format],
                                                  .nearest = chain->nearest,
                                                  .stepped = chain->stepped,
                                                  .clamped = chain->clamped,
                                                  .data = data});
}

static bool is_blank(const mip_chain *chain)
{
    const uint8_t *bytes = chain->data[0];
    size_t         count = chain->format == MIP_R8 ? mip_level_bytes(chain, 0) : 0;
    for (size_t i = 0; i < count; i++)
        if (bytes[i] != 255)
            return false;
    return count > 0;
}

/* Takes over the description. */
static lmn_status add(made_textures *all, gpu *g, const texture_source *source, const void *values, char *description,
                      lmn_error *error)
{
    mip_chain  chain = {0};
    lmn_status status = bring(&chain, source, values, description, error);
    if (status == LMN_OK && !mem_grow((void **)&all->items, &all->capacity, all->count + 1, sizeof *all->items))
        status = error_memory(error);
    made_texture item = {.description = description};
    if (status == LMN_OK) {
        item.texture = put_up(g, &chain);
        const float facts[4] = {(float)(chain.width > chain.height ? chain.width : chain.height), (float)chain.layers,
                                (float)chain.levels, chain.fact};
        memcpy(item.facts, facts, sizeof facts);
        item.similar = chain.similar;
        item.nearest = chain.nearest;
        item.blank = is_blank(&chain);
        status = gpu_check(g, error);
    }
    mip_chain_release(&chain);
    if (status == LMN_OK)
        all->items[all->count++] = item;
    else
        release_item(&item, g);
    return status;
}

static made_texture *known(const made_textures *all, const char *description)
{
    for (size_t i = 0; i < all->count; i++)
        if (strcmp(all->items[i].description, description) == 0)
            return &all->items[i];
    return NULL;
}

static bool applies(const texture_source *source, const technique_use *use)
{
    return params_condition(source->when, use->technique->params, use->technique->param_count, use->values);
}

lmn_status made_textures_find(made_textures *all, gpu *g, const technique_use *use, used_textures *out,
                              lmn_error *error)
{
    *out = (used_textures){.textures = {NULL}};
    for (size_t i = 0; use && i < use->technique->texture_count; i++) {
        const texture_source *source = &use->technique->textures[i];
        if (!applies(source, use))
            continue;
        text written = {0};
        text_append(&written, "%s.%s ", use->technique->name, source->name);
        source->describe(&written, use->values);
        char *description = text_take(&written);
        if (!description)
            return error_memory(error);
        made_texture *found = known(all, description);
        if (found)
            mem_free(description);
        lmn_status status = found ? LMN_OK : add(all, g, source, use->values, description, error);
        if (status != LMN_OK)
            return status;
        if (!found)
            found = &all->items[all->count - 1];
        found->used = all->clock;
        out->textures[i] = found->texture;
        memcpy(out->facts[i], found->facts, sizeof found->facts);
        out->similar[i] = found->similar;
        out->nearest[i] = found->nearest;
        out->blank[i] = found->blank;
    }
    return LMN_OK;
}

void used_textures_declare(text *prelude, const technique_use *use, const used_textures *used)
{
    for (size_t i = 0; i < use->technique->texture_count; i++) {
        const char *name = use->technique->textures[i].name;
        if (!used->textures[i])
            continue;
        char capitals[CAPITALS_SIZE];
        uniforms_capitals(name, capitals);
        text_append(prelude, "#define HAS_%s\nuniform sampler2DArray t_%s;\nuniform vec4 u_%s_facts;\n", capitals, name,
                    name);
        if (used->similar[i])
            text_append(prelude, "#define SIMILAR_%s\n", capitals);
        if (used->nearest[i])
            text_append(prelude, "#define NEAREST_%s\n", capitals);
    }
}

void used_textures_set(gpu *g, const technique_use *use, const used_textures *used)
{
    for (size_t i = 0; i < use->technique->texture_count; i++) {
        if (!used->textures[i])
            continue;
        char name[NAME_SIZE];
        snprintf(name, sizeof name, "t_%s", use->technique->textures[i].name);
        gpu_set_texture(g, name, used->textures[i], true);
        snprintf(name, sizeof name, "u_%s_facts", use->technique->textures[i].name);
        gpu_set_vec4(g, name, used->facts[i]);
    }
}
