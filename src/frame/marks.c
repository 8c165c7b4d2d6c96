/* Marks of figures, drawn over their shade, each frame anew decided which. */
#include <math.h>
#include <string.h>

#include "base/memory.h"
#include "frame/frame_private.h"
#include "stage/mark_sets.h"
#include "surface/marks.h"

/* The least rank of marks that are not drawn anywhere in a cluster: what its position that is as near and as much
 * towards the eye as can be asks for. */
static double rank_needed(const mark_set *set, const mark_cluster *c, const mark_style *style, const cluster_view *view)
{
    const double SPARE = 1.01, size = (double)style->diameter, scale = mark_cluster_scale(c, view, !set->lines);
    double       fraction = scale / (c->density * (double)style->scale);
    if (!set->lines)
        fraction = (double)mark_ink_of_cover(1, 1 / (style->diameter * style->diameter)) / (0.78539816 * size * size) *
                   scale / c->density;
    return fraction * (1 + (double)style->fade) * SPARE;
}

/* Is all of the figure's surface there, and before the eye? */
static bool is_whole(const frame *f, const figure *fig)
{
    double nearest = INFINITY, farthest = -INFINITY;
    camera_depth_range(&f->camera, fig->box, &nearest, &farthest);
    return !fig->layered && !f->mirror && f->up->section.cut.cell_count == 0 && nearest > f->camera.near;
}

/* How far marks reach beyond where they are, pixels; lines that flow fill the way to their neighbours, which is wide
 * where even the closest lines are far apart. */
static double reach_of(const frame *f, const figure *fig, const mark_set *set, const mark_style *style)
{
    const double WIDEST = 2.56, SPARE = 4; /* distances that strips have at most (stage/mark_sets.c); pixels */
    if (!set->levels)
        return (double)style->diameter * sqrt((double)style->most) + SPARE;
    const double *p = f->camera.projection.m;
    double        nearest = INFINITY, farthest = -INFINITY, focal = p[5] * f->height / 2;
    camera_depth_range(&f->camera, fig->box, &nearest, &farthest);
    /* Beside the middle of the picture things are seen larger. */
    if (!f->camera.orthographic)
        focal *= (1 + 1 / (p[0] * p[0]) + 1 / (p[5] * p[5])) / fmax(nearest, f->camera.near);
    double closest = ldexp(set->apart, 1 - set->levels) * focal, distance = fmax(2 * (double)style->scale, closest);
    double widest = style->widest < FLOW_ANY_WIDTH ? (double)style->widest * (double)style->scale : WIDEST * distance;
    return widest + 2 * (double)style->stray * (double)style->scale + SPARE;
}

static cluster_view view_of(const frame *f, const figure *fig, const mark_set *set, const mark_style *style)
{
    cluster_view v = {.projection = f->camera.projection,
                      .orthographic = f->camera.orthographic,
                      .near = f->camera.near,
                      .focal = f->camera.projection.m[5] * f->height / 2,
                      .width = f->width,
                      .height = f->height,
                      .reach = reach_of(f, fig, set, style),
                      .outside = is_whole(f, fig)};
    mat4         world = mat4_identity();
    memcpy(&world.m[12], set->origin, sizeof set->origin);
    v.model_view = mat4_multiply(&f->camera.view, &world);
    return v;
}

/* The marks that are looked at, cluster by cluster: runs of them. What is left out is told. Returns how many runs. */
static size_t choose_runs(const frame *f, const figure *fig, const mark_set *set, const technique_use *surface,
                          uint32_t (*runs)[2], mark_facts *facts)
{
    const mark_clusters *c = &set->clusters;
    mark_style           style = {.diameter = 1};
    surface_mark_style(&style, surface);
    const cluster_view view = view_of(f, fig, set, &style);
    const bool         culls = ((const mark_values *)surface->values)->cull;
    size_t             count = 0;
    for (size_t i = 0; i < c->count; i++) {
        const mark_cluster *one = &c->clusters[i];
        const cluster_fate  fate = culls ? mark_cluster_fate(c, one, &view) : CLUSTER_SEEN;
        size_t              drawn = fate == CLUSTER_SEEN ? one->count : 0;
        if (fate == CLUSTER_SEEN && culls)
            drawn = mark_cluster_prefix(c, one, rank_needed(set, one, &style, &view));
        if (drawn)
            memcpy(runs[count++], (uint32_t[]){one->first, (uint32_t)drawn}, sizeof *runs);
        facts->drawn += drawn;
        facts->clusters_drawn += drawn > 0;
        *(fate == CLUSTER_BESIDE        ? &facts->beside
          : fate == CLUSTER_TURNED_AWAY ? &facts->turned_away
                                        : &facts->too_dense) += one->count - drawn;
    }
    facts->clusters += c->count;
    facts->there += set->count;
    facts->bytes += gpu_marks_bytes(set->marks);
    return count;
}

/* Of the set, with the program and state that are in use. */
static void draw_chosen(frame *f, const figure *fig, const mark_set *set, const technique_use *surface, bool told)
{
    uint32_t(*runs)[2] = mem_alloc((set->clusters.count + 1) * sizeof *runs);
    mark_facts unused = {0};
    if (runs)
        gpu_draw_mark_runs(f->g, set->marks, runs, choose_runs(f, fig, set, surface, runs, told ? &f->marks : &unused));
    else
        gpu_fail(f->g, LMN_MEMORY, "out of memory");
    mem_free(runs);
}

bool figure_has_marks(const figure *fig)
{
    const technique_use *surface = rule_use(fig->rule, KIND_SURFACE);
    return surface && surface->technique->surface->marks && !fig->unmarked;
}

static gpu_program *program_of_marks(frame *f, const technique_use *surface, bool points)
{
    const mark_source *source = surface->technique->surface->marks;
    text               prelude = {0};
    lights_declare(&prelude, f);
    uniforms_declare(&prelude, use_own_set(KIND_SURFACE, surface));
    if (points)
        text_append(&prelude, "#define AS_POINTS\n");
    target_declare(&prelude, &target_rows[TARGET_NORMAL_DEPTH]);
    return program_of(f, GPU_FLOOR, source->vertex, source->fragment, &prelude);
}

static void set_uniforms(frame *f, figure_state *s, const mark_set *set, const technique_use *surface)
{
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
    gpu_set_float(f->g, "u_closed", set->clusters.solid && is_whole(f, s->figure) ? 1 : 0);
    gpu_set_texture(f->g, target_rows[TARGET_NORMAL_DEPTH].name, s->targets[TARGET_NORMAL_DEPTH], false);
}

double figure_marks_stand(const figure *fig)
{
    mark_style style = {.diameter = 1};
    return figure_has_marks(fig) && surface_mark_style(&style, rule_use(fig->rule, KIND_SURFACE))
               ? (double)style.stands * box3_diagonal(fig->box)
               : 0;
}

/* Draws over the picture; what is left out by depth or winding needs that to be tested. What stands on the surface is
 * hidden by what lies before it, pixel by pixel, and where nothing lies behind it its depth is that of the figure. */
static void draw_set(frame *f, figure_state *s, gpu_texture *onto, const mark_set *set, gpu_program *p)
{
    const technique_use *surface = rule_use(s->figure->rule, KIND_SURFACE);
    mark_style           style = {.diameter = 1};
    surface_mark_style(&style, surface);
    gpu_texture *empty = style.hiding == HIDE_DEPTH ? frame_acquire(f, TARGET_DEPTH) : NULL,
                *depth = style.stands > 0 ? s->targets[TARGET_DEPTH] : empty;
    gpu_pass  pass = {.colours = {onto}, .colour_count = 1, .depth = depth};
    gpu_state state = {.blend = GPU_BLEND_OVER, .depth_test = depth != NULL, .depth_compare = GPU_LESS};
    memcpy(pass.scissor, s->pixels, sizeof pass.scissor);
    if (empty)
        gpu_pass_begin(f->g, &(gpu_pass){.depth = empty, .clear = true});
    for (int alone = 0; alone < (style.stands > 0 && depth ? 2 : 1); alone++) {
        pass.colour_count = alone ? 0 : 1;
        pass.colours[0] = alone ? NULL : onto;
        state.depth_write = alone;
        gpu_pass_begin(f->g, &pass);
        gpu_use(f->g, p, state);
        gpu_cull_faces(f->g, style.hiding == HIDE_WINDING ? GPU_CULL_BACK : GPU_CULL_NONE);
        set_uniforms(f, s, set, surface);
        gpu_set_float(f->g, "u_depth_alone", (float)alone);
        gpu_settle(f->g);
        draw_chosen(f, s->figure, set, surface, !alone);
    }
    gpu_cull_faces(f->g, GPU_CULL_NONE);
    gpu_target_release(f->g, empty);
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
    gpu_program       *p = set && set->marks ? program_of_marks(f, surface, points) : NULL;
    if (p && !gpu_failed(f->g))
        draw_set(f, s, onto, set, p);
    watch_stop(&f->profile, w, "surface", "marks");
}
