/* The light on one item, laid out by its texture coordinates, for surfaces that look it up. */
#include "frame/raster_material.h"

#include <stdio.h>

/* About two texels to a pixel that the item's part can cover. */
static int light_map_side(const frame *f, const draw_item *item)
{
    enum { LEAST = 64, MOST = 1024 };
    int box[4], side = LEAST;
    camera_pixels(&f->camera, f->up->pose->part_boxes[item->part_index], f->width, f->height, 0, box);
    while (side < MOST && side < 2 * box[2] && side < 2 * box[3])
        side *= 2;
    while (side < MOST && (side < box[2] || side < box[3]))
        side *= 2;
    return side;
}

/* The light on one item, laid out by its texture coordinates. The caller gives it back. */
gpu_texture *light_map_draw(frame *f, const figure_state *s, const draw_item *item)
{
    enum { BORDER = 4 };
    const int            side = light_map_side(f, item);
    const technique_use *surface = rule_use(s->figure->rule, KIND_SURFACE);
    gpu_texture         *map = gpu_target_acquire(f->g, side, side, GPU_RGBA16F),
                *other = gpu_target_acquire(f->g, side, side, GPU_RGBA16F);
    material        tinted;
    const material *m = material_of_item(f, s->figure, item, &tinted);
    item_textures   t = material_textures(f, item, m);
    text            prelude = {0};
    material_declare(&prelude, s, item, m, t, material_is_datum(f, item));
    text_append(&prelude, "#define UNWRAPPED\n");
    lights_declare(&prelude, f);
    uniforms_declare(&prelude, use_own_set(KIND_SURFACE, surface));
    used_textures_declare(&prelude, surface, material_made(s->figure, item->material));
    char path[320];
    snprintf(path, sizeof path, "%s+layer/light_map.frag", surface->technique->surface->shader);
    gpu_program *lit = program_of(f, GPU_FLOOR, "layer/raster.vert", path, &prelude);
    gpu_pass_begin(f->g, &(gpu_pass){.colours = {map}, .colour_count = 1, .clear = true});
    gpu_use(f->g, lit, (gpu_state){0});
    frame_set_common(f, s);
    uniforms_set(f->g, use_own_set(KIND_SURFACE, surface));
    material_set(f->g, m, t, false);
    view_set_transform(f->g, &f->camera, &item->world);
    gpu_draw_mesh(f->g, item->mesh);
    for (int i = 0; i < BORDER && !gpu_failed(f->g); i++) {
        gpu_pass_begin(f->g, &(gpu_pass){.colours = {other}, .colour_count = 1});
        gpu_use(f->g, gpu_program_of(f->g, GPU_FLOOR, "gpu/screen.vert", "layer/light_map_pad.frag", ""),
                (gpu_state){0});
        gpu_set_texture(f->g, "t_light_map", map, false);
        gpu_draw_screen(f->g);
        gpu_texture *before = map;
        map = other;
        other = before;
    }
    gpu_target_release(f->g, other);
    return map;
}
