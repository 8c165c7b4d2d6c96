/* Marks of figures, drawn over their shade, each frame anew decided which. */
#include <math.h>
#include <string.h>

#include "base/memory.h"
#include "frame/frame_private.h"
#include "stage/mark_sets.h"
#include "surface/marks.h"

/* How many of the set, in its order, can be drawn at all: what a position of the figure that is as near and as much
 * towards the eye as can be asks for. */
static size_t count_to_draw(const frame *f, const figure *fig, const mark_set *set, const mark_style *style)
{
    const double *p = f->camera.projection.m, SPARE = 1.01;
    double        nearest = INFINITY, farthest = -INFINITY, focal = p[5] * f->height / 2;
    camera_depth_range(&f->camera, fig->box, &nearest, &farthest);
    /* Pixels to a unit there; beside the middle of the picture things are seen larger. */
    double scale = focal;
    if (!f->camera.orthographic)
        scale = focal * sqrt(1 + 1 / (p[0] * p[0]) + 1 / (p[5] * p[5])) / fmax(nearest, f->camera.near);
    double fraction, size = (double)style->diameter;
    if (set->lines)
        fraction = scale / (set->density * (double)style->scale);
    else
        fraction = (double)mark_ink_of_cover(1, 1 / (style->diameter * style->diameter)) / (0.78539816 * size * size) *
                   scale * scale / set->density;
    double most = fraction * (1 + (double)style->fade) * SPARE;
    if (!(most < 1))
        return set->count;
    if (!set->lines)
        return (size_t)ceil(most * (double)set->count);
    size_t low = 0, high = set->count;
    while (low < high) {
        size_t middle = low + (high - low) / 2;
        if ((double)set->ranks[middle] <= most)
            low = middle + 1;
        else
            high = middle;
    }
    return low;
}

bool figure_has_marks(const figure *fig)
{
    const technique_use *surface = rule_use(fig->rule, KIND_SURFACE);
    return surface && surface->technique->surface->marks && !fig->unmarked;
}

void marks_draw(frame *f, figure_state *s, gpu_texture *onto)
{
    const technique_use *surface = rule_use(s->figure->rule, KIND_SURFACE);
    if (!figure_has_marks(s->figure) || gpu_failed(f->g))
        return;
    stopwatch          w = watch_start(&f->profile);
    const mark_source *source = surface->technique->surface->marks;
    bool               points = source->point && source->point(surface->values) <= gpu_capabilities_of(f->g)->max_point;
    mark_set_options   options = {f->up->pose, s->figure->designated, f->plan->part_count, f->up->crease_angle, surface,
                                  points};
    const mark_set    *set = mark_sets_find(&f->up->marks, f->g, &options);
    text               prelude = {0};
    lights_declare(&prelude, f);
    uniforms_declare(&prelude, use_own_set(KIND_SURFACE, surface));
    if (points)
        text_append(&prelude, "#define AS_POINTS\n");
    target_declare(&prelude, &target_rows[TARGET_NORMAL_DEPTH]);
    gpu_program *p = set && set->marks ? program_of(f, GPU_FLOOR, source->vertex, source->fragment, &prelude) : NULL;
    if (p && !gpu_failed(f->g)) {
        gpu_pass pass = {.colours = {onto}, .colour_count = 1};
        memcpy(pass.scissor, s->pixels, sizeof pass.scissor);
        gpu_pass_begin(f->g, &pass);
        gpu_use(f->g, p, (gpu_state){.blend = GPU_BLEND_OVER});
        frame_set_common(f, s);
        uniforms_set(f->g, use_own_set(KIND_SURFACE, surface));
        mat4 world = mat4_identity();
        memcpy(&world.m[12], set->origin, sizeof set->origin);
        view_set_transform(f->g, &f->camera, &world);
        view_set_projection(f->g, &f->camera);
        gpu_set_float(f->g, "u_focal", (float)(f->camera.projection.m[5] * f->height / 2));
        gpu_set_float(f->g, "u_density", (float)set->density);
        gpu_set_float(f->g, "u_near_plane", (float)f->camera.near);
        gpu_set_float(f->g, "u_levels", (float)set->levels);
        gpu_set_float(f->g, "u_apart", (float)set->apart);
        gpu_set_float(f->g, "u_sag", (float)set->sag);
        gpu_set_texture(f->g, target_rows[TARGET_NORMAL_DEPTH].name, s->targets[TARGET_NORMAL_DEPTH], false);
        mark_style style = {.diameter = 1};
        surface_mark_style(&style, surface);
        gpu_settle(f->g);
        const size_t count = count_to_draw(f, s->figure, set, &style);
        gpu_draw_first_marks(f->g, set->marks, count);
        f->marks.there += set->count;
        f->marks.drawn += count;
        f->marks.bytes += gpu_marks_bytes(set->marks);
    }
    if (!p) {
        char *unused = text_take(&prelude);
        mem_free(unused);
    }
    watch_stop(&f->profile, w, "surface", "marks");
}
