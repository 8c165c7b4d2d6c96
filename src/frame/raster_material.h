/* What programs of the geometry pass get of an item's material; and maps of the light on it. */
#ifndef LIMNER_FRAME_RASTER_MATERIAL_H
#define LIMNER_FRAME_RASTER_MATERIAL_H

#include "frame/frame_private.h"

typedef struct item_textures {
    gpu_texture *base, *normal;
} item_textures;

/* Has its part another colour than its own, for what is known about it? */
bool material_is_datum(const frame *f, const draw_item *item);
void material_set_datum(frame *f, const draw_item *item);

/* The item's material; `capacity` holds it when it is painted in the figure's highlight or a datum's colour. */
const material *material_of_item(const frame *f, const figure *fig, const draw_item *item, material *capacity);
item_textures   material_textures(frame *f, const draw_item *item, const material *m);

/* `datum`: what material_is_datum says. */
void material_declare(text *prelude, const figure_state *s, const draw_item *item, const material *m, item_textures t,
                      bool datum);
void material_set(gpu *g, const material *m, item_textures t, bool layered);

/* What the surface technique made, for a material (NONE: without one). */
const used_textures *material_made(const figure *fig, int32_t material);

/* The light on one item, laid out by its texture coordinates. The caller gives it back. */
gpu_texture *light_map_draw(frame *f, const figure_state *s, const draw_item *item);

#endif
