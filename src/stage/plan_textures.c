#include "stage/plan_textures.h"

#include <string.h>

#include "base/memory.h"

/* Where materials have strokes of their own, each gets its textures. */
static lmn_status make_by_material(struct figure_textures *out, made_textures *all, gpu *g,
                                   const technique_use *surface, const lmn_scene *scene, lmn_error *error)
{
    void *values = mem_copy(surface->values, surface->technique->params_size);
    out->by_material = mem_calloc(scene->material_count, sizeof *out->by_material);
    lmn_status status = values && out->by_material ? LMN_OK : error_memory(error);
    for (size_t i = 0; i < scene->material_count && status == LMN_OK; i++) {
        int32_t index = scene->materials[i].base_texture.image;
        memcpy(values, surface->values, surface->technique->params_size);
        surface->technique->surface->by_material(values, index >= 0 ? scene->images[index].strokes : NULL);
        status = made_textures_find(all, g, &(technique_use){surface->technique, values}, &out->by_material[i], error);
    }
    mem_free(values);
    return status;
}

/* What was asked for and gives no ink. */
static void warn_of_textures(const struct figure_textures *t, const technique_use *surface, const plan *p,
                             warnings *warnings)
{
    bool none = t->by_material != NULL;
    for (size_t i = 0; i < p->scene->image_count; i++)
        none = none && !p->scene->images[i].strokes;
    if (none)
        warnings_add(warnings, WARNING_UNUSED,
                     "no material has strokes beside its picture (.stx): all are drawn with the standard ones");
    for (size_t i = 0; surface && i < surface->technique->texture_count; i++)
        if (t->surface.textures[i] && t->surface.blank[i])
            warnings_add(warnings, WARNING_UNUSED, "the %s of surface '%s' has no ink anywhere",
                         surface->technique->textures[i].name, surface->technique->name);
}

static lmn_status make_of_figure(struct figure_textures *out, made_textures *all, gpu *g, const figure *fig,
                                 const plan *p, warnings *warnings, lmn_error *error)
{
    const technique_use *surface = rule_use(fig->rule, KIND_SURFACE);
    technique_use        plain = {surface ? surface->technique : NULL, NULL};
    bool                 differ = surface && surface->technique->surface->by_material &&
                  (plain.values = mem_copy(surface->values, surface->technique->params_size)) &&
                  surface->technique->surface->by_material(plain.values, NULL);
    lmn_status status = made_textures_find(all, g, differ ? &plain : surface, &out->surface, error);
    if (status == LMN_OK && differ)
        status = make_by_material(out, all, g, surface, p->scene, error);
    if (status == LMN_OK)
        warn_of_textures(out, surface, p, warnings);
    if (status == LMN_OK)
        status = made_textures_find(all, g, rule_use(fig->rule, KIND_PERTURB), &out->perturb, error);
    if (status == LMN_OK && fig->mover)
        status = made_textures_find(all, g, rule_use(fig->rule, KIND_MOTION), &out->motion, error);
    mem_free(plain.values);
    return status;
}

lmn_status plan_textures_make(plan_textures *out, made_textures *all, gpu *g, plan *p, bool with_sheet,
                              warnings *warnings, lmn_error *error)
{
    *out = (plan_textures){.figures = mem_calloc(p->figure_count, sizeof *out->figures), .count = p->figure_count};
    if (!out->figures)
        return error_memory(error);
    made_textures_trim(all, g);
    lmn_status status = made_textures_find(all, g, with_sheet ? &p->look->wide[KIND_FINISH] : NULL, &out->sheet, error);
    for (size_t i = 0; i < p->figure_count && status == LMN_OK; i++) {
        status = make_of_figure(&out->figures[i], all, g, &p->figures[i], p, warnings, error);
        p->figures[i].textures = &out->figures[i];
    }
    return status;
}

void plan_textures_release(plan_textures *t)
{
    for (size_t i = 0; t->figures && i < t->count; i++)
        mem_free(t->figures[i].by_material);
    mem_free(t->figures);
    *t = (plan_textures){.figures = NULL};
}
