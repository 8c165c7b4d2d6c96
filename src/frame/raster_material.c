/* Materials of items, and what of them programs of the geometry pass get. */
#include "frame/raster_material.h"

#include <math.h>

/* Has its part another colour than its own, for what is known about it? */
bool material_is_datum(const frame *f, const draw_item *item)
{
    return !item->is_cut && plan_datum_colour(f->plan, item->part_index);
}

void material_set_datum(frame *f, const draw_item *item)
{
    float light[4];
    uniforms_light(*plan_datum_colour(f->plan, item->part_index), light);
    gpu_set_vec4(f->g, "u_base_colour", light);
}

/* The item's material; `capacity` holds it when it is painted in the figure's highlight, a datum's colour, or that of
 * which a ghost image is a paler form. */
const material *material_of_item(const frame *f, const figure *fig, const draw_item *item, material *capacity)
{
    static const material standard = {.base_colour = RASTER_STANDARD_COLOUR,
                                      .base_texture = TEXTURE_USE_NONE,
                                      .normal_texture = TEXTURE_USE_NONE,
                                      .normal_scale = 1,
                                      .alpha_cutoff = 0.5f};
    const material       *own = item->material >= 0 ? &f->plan->scene->materials[item->material] : &standard;
    const colour         *datum = material_is_datum(f, item) ? plan_datum_colour(f->plan, item->part_index) : NULL;
    colour                tint = {0};
    const bool            ghost = fig->rule->pale > 0 && item->part_index < f->plan->scene->part_count &&
                       node_tint(&f->plan->scene->nodes[f->plan->scene->parts[item->part_index].node], &tint);
    if (!(fig->highlight.a > 0) && !datum && !ghost)
        return own;
    float light[4];
    uniforms_light(fig->highlight.a > 0 ? fig->highlight : datum ? *datum : tint, light);
    *capacity = *own;
    capacity->base_texture = standard.base_texture;
    capacity->base_colour = (vec4){light[0], light[1], light[2], light[3]};
    return capacity;
}

item_textures material_textures(frame *f, const draw_item *item, const material *m)
{
    item_textures t = {NULL, NULL};
    if (!item->has_uvs)
        return t;
    t.base = upload_texture(f->up, f->g, &m->base_texture, false);
    t.normal = upload_texture(f->up, f->g, &m->normal_texture, true);
    return t;
}

void material_declare(text *prelude, const figure_state *s, const draw_item *item, const material *m, item_textures t,
                      bool datum)
{
    const technique_use *surface = rule_use(s->figure->rule, KIND_SURFACE);
    if (t.base || t.normal || (item->has_uvs && surface && shades_with_geometry(surface)))
        text_append(prelude, "#define HAS_UV\n");
    if (item->has_colours && !datum)
        text_append(prelude, "#define HAS_COLOURS\n");
    if (item->has_uv1)
        text_append(prelude, "#define HAS_UV1\n");
    if (t.base)
        text_append(prelude, "#define HAS_BASE_TEXTURE\n");
    if (t.normal)
        text_append(prelude, "#define HAS_NORMAL_TEXTURE\n");
    if (item->is_cut)
        text_append(prelude, "#define CUT_FACE\n");
    else if (m->alpha != ALPHA_OPAQUE)
        text_append(prelude, "#define CUT_OUT\n");
}

static void set_texture_matrix(gpu *g, const char *matrix, const char *offset, const texture_use *use, float strength)
{
    float c = cosf(use->rotation), s = sinf(use->rotation);
    gpu_set_vec4(g, matrix, (float[]){c * use->scale[0], -s * use->scale[0], s * use->scale[1], c * use->scale[1]});
    gpu_set_vec4(g, offset, (float[]){use->offset[0], use->offset[1], (float)use->uv_set, strength});
}

void material_set(gpu *g, const material *m, item_textures t, bool layered)
{
    const vec4 *c = &m->base_colour;
    gpu_set_vec4(g, "u_base_colour", (float[]){c->x, c->y, c->z, c->w});
    /* Where nothing is seen through, blended surfaces are cut-outs: what is mostly there is there. */
    gpu_set_float(g, "u_alpha_cutoff", m->alpha != ALPHA_BLEND ? m->alpha_cutoff : layered ? 0.004f : 0.1f);
    gpu_set_int(g, "u_unlit", m->unlit);
    if (t.base) {
        gpu_set_texture(g, "t_base", t.base, true);
        set_texture_matrix(g, "u_base_matrix", "u_base_offset", &m->base_texture, 0);
    }
    if (t.normal) {
        gpu_set_texture(g, "t_normal", t.normal, true);
        set_texture_matrix(g, "u_normal_uv_matrix", "u_normal_uv_offset", &m->normal_texture, m->normal_scale);
    }
}

/* What the surface technique made, for a material (NONE: without one). */
const used_textures *material_made(const figure *fig, int32_t material)
{
    return fig->textures->by_material && material >= 0 ? &fig->textures->by_material[material]
                                                       : &fig->textures->surface;
}
