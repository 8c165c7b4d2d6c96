/* What is known about each part whose mesh lies in a pack, so that one draw call draws many of them: its number, its
 * colour, and what is known of the building. Vertices have the key by which it is looked up. */
#include "frame/frame_private.h"

#include <string.h>

#include "base/memory.h"

/* Two texels a key: the colour, light, and part, storeys, use. */
enum { KEYS_A_ROW = 1024, TEXELS_A_KEY = 2 };

static void base_colour(const frame *f, const draw_item *item, float out[4])
{
    const colour *datum = plan_datum_colour(f->plan, item->part_index);
    if (datum) {
        uniforms_light(*datum, out);
        return;
    }
    const vec4 standard = RASTER_STANDARD_COLOUR;
    const vec4 c = item->material >= 0 ? f->plan->scene->materials[item->material].base_colour : standard;
    memcpy(out, (float[]){c.x, c.y, c.z, c.w}, 4 * sizeof *out);
}

void facts_open(frame *f)
{
    const upload *up = f->up;
    int           rows = (int)(up->key_count / KEYS_A_ROW) + 1, width = KEYS_A_ROW * TEXELS_A_KEY;
    f->facts = NULL;
    if (up->key_count == 0 || gpu_failed(f->g))
        return;
    float(*values)[4] = mem_calloc((size_t)rows * (size_t)width, sizeof *values);
    if (!values) {
        gpu_fail(f->g, LMN_MEMORY, "out of memory");
        return;
    }
    for (size_t i = 0; i < up->item_count; i++) {
        const draw_item *item = &up->items[i];
        if (!item->has_key)
            continue;
        float(*own)[4] = &values[(size_t)item->key * TEXELS_A_KEY];
        base_colour(f, item, own[0]);
        own[1][0] = (float)item->part_id;
        own[1][1] = (float)item->building.storeys;
        own[1][2] = (float)(int)item->building.use;
    }
    f->facts = gpu_target_acquire(f->g, width, rows, GPU_RGBA32F);
    gpu_target_write(f->g, f->facts, (int[]){0, 0, width, rows}, values);
    mem_free(values);
}
