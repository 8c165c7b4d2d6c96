/* Marks for files of vectors: what the GPU would draw of them, worked out on the CPU. */
#include <string.h>

#include "base/memory.h"
#include "plan/lights.h"
#include "stage/mark_ground.h"
#include "surface/marks.h"

/* Marks are measured from the ground's origin; who knows what hides them is asked in the world's axes. */
typedef struct asked {
    const mark_page_options *options;
    const double            *origin;
    bool                     full; /* memory was gone: nothing is known to be hidden */
} asked;

static void ask(void *user, const double (*positions)[3], size_t count, uint32_t *out)
{
    asked *a = user;
    double(*moved)[3] = mem_alloc(count * sizeof *moved);
    for (size_t i = 0; moved && i < count; i++)
        for (int k = 0; k < 3; k++)
            moved[i][k] = positions[i][k] + a->origin[k];
    if (moved)
        a->options->hidden(a->options->user, (const double(*)[3])moved, count, out);
    a->full = a->full || !moved;
    mem_free(moved);
}

static mark_view view_of(const mark_page_options *w, const double origin[3])
{
    mark_view v = {.projection = w->camera->projection,
                   .orthographic = w->camera->orthographic,
                   .width = w->width,
                   .height = w->height};
    mat4      world = mat4_identity();
    memcpy(&world.m[12], origin, 3 * sizeof *origin);
    v.model_view = mat4_multiply(&w->camera->view, &world);
    _Static_assert((int)MARK_LIGHTS_MAX == (int)LIGHTS_MAX, "all lights fit");
    light_list l = lights_list(&(light_conditions){.look = w->look, .pose = w->pose, .view = &w->camera->view});
    v.light_count = l.count;
    memcpy(v.lights, l.positions, sizeof v.lights);
    memcpy(v.colours, l.colours, sizeof v.colours);
    return v;
}

lmn_status marks_on_page(marks_page *out, const mark_page_options *w, lmn_error *error)
{
    mark_ground ground;
    marks       made = {.dots = NULL};
    mark_style  style;
    surface_mark_style(&style, w->surface);
    lmn_status status = mark_ground_posed(
        &ground, &made, &(mark_ground_options){w->pose, w->parts, w->part_count, w->crease_angle, w->surface}, error);
    made.parts = ground.parts;
    if (status == LMN_OK) {
        mark_view view = view_of(w, ground.origin);
        asked     a = {.options = w, .origin = ground.origin};
        status = marks_visible(out, &made, &view, &style, w->hidden ? ask : NULL, &a, error);
        if (a.full)
            status = error_memory(error);
    }
    surface_marks_release(&made);
    mark_ground_release(&ground);
    return status;
}
