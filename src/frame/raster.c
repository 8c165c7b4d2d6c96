/* The geometry pass: a figure's parts into its G-buffer or onto the page. */
#include "frame/raster_material.h"
#include "base/memory.h"
#include "layer/layer.h"
#include "plan/meetings.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

static bool is_drawn(const frame *f, const figure *fig, const draw_item *item)
{
    if (f->mirror && f->mirror->designated[item->part_index])
        return false; /* a mirror does not see itself */
    return fig->designated[item->part_index] || (fig->complement && f->plan->opaque[item->part_index]);
}

/* What the geometry pass writes and where. */
typedef struct outputs {
    int normal_depth, id, albedo, shade, rest, velocity, detail; /* attachment, −1 = not */
    int between[POSE_PAST_MAX - 1]; /* of the steps of the past before the last one, which is the velocity */
} outputs;

#define NO_STEPS                                                                                                       \
    {                                                                                                                  \
        -1, -1, -1                                                                                                     \
    }
static const outputs no_outputs = {-1, -1, -1, -1, -1, -1, -1, NO_STEPS};

/* One run over the parts. */
typedef struct raster_job {
    const gpu_pass     *pass;   /* that is drawn into */
    const figure_state *state;  /* of the only figure; NULL: whose part it is of several, or in the stack */
    const figure_state *states; /* several opaque figures at once; others' parts are the complement of the first */
    int                 state_count;
    solid_layers       *solids; /* the surfaces of solids, found when first needed */
    const solid_view   *view;   /* that they are found for */
    const layer_stack  *stack;
    outputs             at;
    const pass         *inking;       /* lines on top and no complement */
    const bool         *only;         /* per part: all others are left out */
    camera_bounds       seen;         /* what its pixels show */
    float               enlarge;      /* not 0: surfaces are moved outwards by this many pixels */
    bool                shell;        /* enlarged: no complement, no solids, and only faces that look away */
    bool                peeled;       /* nothing that the layer before had */
    int                 node_vectors; /* not 0: into lists, nodes of this size */
    unsigned            node_limit;
} raster_job;

/* How many steps of the past are written. */
static int steps_of(const outputs *at)
{
    int steps = at->velocity >= 0;
    for (int k = 0; k < POSE_PAST_MAX - 1; k++)
        steps += at->between[k] >= 0;
    return steps;
}

/* Which of the pose's steps is the k-th of these: the last one is the whole past. */
static int step_of(const frame *f, int k, int steps)
{
    return (k + 1) * f->up->past_count / steps - 1;
}

/* The vertices of bent meshes at these steps. */
static void declare_past(text *prelude, const frame *f, const outputs *at)
{
    text_append(prelude, "#define HAS_PAST\n");
    for (int steps = steps_of(at), k = 0; k < steps; k++)
        text_append(prelude, "#define PAST_%d_LOCATION %d\n", k + 1, 10 + step_of(f, k, steps));
}

/* Where an item was at each of them. */
static void set_past(frame *f, const outputs *at, const draw_item *item)
{
    for (int steps = steps_of(at), k = 0; k < steps; k++) {
        int which = step_of(f, k, steps);
        if (item->is_solid)
            view_set_past_of_eye(f->g, k + 1, &f->camera_past[which], &item->past[which], &f->camera, &item->world);
        else
            view_set_past(f->g, k + 1, &f->camera_past[which], &item->past[which]);
    }
}

static void declare_outputs(text *prelude, const raster_job *job)
{
    const struct {
        const char *name;
        int         at;
    } rows[] = {{"NORMAL_DEPTH", job->at.normal_depth},
                {"ID", job->at.id},
                {"ALBEDO", job->at.albedo},
                {"SHADE", job->at.shade},
                {"REST", job->at.rest},
                {"VELOCITY", job->at.velocity},
                {"DETAIL", job->at.detail},
                {"PAST_1", job->at.between[0]},
                {"PAST_2", job->at.between[1]},
                {"PAST_3", job->at.between[2]}};
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++)
        if (rows[i].at >= 0)
            text_append(prelude, "#define AT_%s %d\n", rows[i].name, rows[i].at);
    if (job->at.velocity >= 0)
        text_append(prelude, "#define PAST_STEPS %d\n", steps_of(&job->at));
    if (job->at.shade < 0 && !job->stack)
        text_append(prelude, "#define DEFERRED\n");
    if (job->stack)
        text_append(prelude, "#define LAYERED\n");
    if (job->peeled)
        text_append(prelude, "#define PEELED\n");
    if (job->enlarge > 0)
        text_append(prelude, "#define ENLARGED\n%s", job->shell ? "#define SHELL\n" : "");
    if (job->node_vectors)
        text_append(prelude, "#define INTO_LISTS\n#define NODE_VECTORS %d\n", job->node_vectors);
}

/* Adds what a geometry pass with ink needs: the lines' parameters, the maps that the pass reads, and their files. */
static void declare_ink(text *prelude, char *path, size_t size, const frame *f, const figure_state *s,
                        const pass *inking)
{
    const technique_use *lines = rule_inked_lines(s->figure->rule);
    const pass          *merged = rule_merged_detection(s->figure->rule);
    uniforms_declare(prelude, use_common_set(KIND_LINES, lines));
    text_append(prelude, "#define INKED\n%s", merged ? "#define MERGED\n" : "");
    if (merged || lines->technique->lines->own_ink)
        uniforms_declare(prelude, use_own_set(KIND_LINES, lines));
    reads_declare(prelude, f, s, inking, merged);
    char joined[320];
    snprintf(joined, sizeof joined, "%s%s%s+%s", merged ? lines->technique->lines->detect : "", merged ? "+" : "",
             inking->shader, path);
    snprintf(path, size, "%s", joined);
}

/* `prelude` says what the material needs; it is used up. */
static gpu_program *raster_program(frame *f, const figure_state *s, const char *vertex, text prelude,
                                   const raster_job *job)
{
    const technique_use *surface = rule_use(s->figure->rule, KIND_SURFACE);
    declare_outputs(&prelude, job);
    if (f->mirror)
        text_append(&prelude, "#define CLIPPED\n");
    if (s->targets[TARGET_REFLECTION])
        target_declare(&prelude, &target_rows[TARGET_REFLECTION]);
    char path[320] = "layer/raster.frag";
    if (job->at.shade >= 0) {
        lights_declare(&prelude, f);
        uniforms_declare(&prelude, use_own_set(KIND_SURFACE, surface));
        used_textures_declare(&prelude, surface, &s->figure->textures->surface);
        snprintf(path, sizeof path, "%s+layer/raster.frag", surface->technique->surface->shader);
    } else if (job->at.detail >= 0) {
        uniforms_declare(&prelude, use_own_set(KIND_SURFACE, surface));
        snprintf(path, sizeof path, "%s+layer/raster.frag", surface->technique->surface->detail);
    }
    if (job->inking)
        declare_ink(&prelude, path, sizeof path, f, s, job->inking);
    return program_of(f, job->node_vectors ? GPU_FAST : GPU_FLOOR, vertex, path, &prelude);
}

static void set_ink(frame *f, const figure_state *s, const pass *inking)
{
    const technique_use *lines = rule_inked_lines(s->figure->rule);
    uniforms_set(f->g, use_common_set(KIND_LINES, lines));
    uniforms_set(f->g, use_own_set(KIND_LINES, lines));
    reads_set(f, s, inking, rule_merged_detection(s->figure->rule));
}

static void set_layers(frame *f, const raster_job *job)
{
    if (job->peeled) {
        gpu_set_texture(f->g, "t_before_depth", job->stack->before_depth, false);
        gpu_set_texture(f->g, "t_before_id", job->stack->before_id, false);
    }
    if (job->node_vectors) {
        const int *box = job->stack->around;
        gpu_set_vec4(f->g, "u_list_box", (float[]){(float)box[0], (float)box[1], (float)box[2], (float)box[3]});
        gpu_set_uint(f->g, "u_node_limit", job->node_limit);
    }
}

/* What the last drawn item needed; most items in a row need the same. */
typedef struct raster_setup {
    const figure_state *owner;
    int32_t             material;
    bool has_uvs, has_uv1, has_colours, is_cut, has_field, has_patches, has_walls, has_rest, has_past, has_datum,
        has_facts, ready;
    uint32_t         triangles; /* drawn so far: orders what coincides */
    const draw_item *first;     /* of the items that are gathered for one draw call; NULL: there are none */
    gpu_mesh       **run;       /* their meshes */
    size_t           run_count, run_capacity;
} raster_setup;

/* What programs of the geometry pass get, wherever their surfaces come from. */
static void set_pass(frame *f, const raster_job *job, const figure_state *s, int32_t material)
{
    if (gpu_has_uniform(f->g, "u_rest"))
        upload_part_frames(f->up, f->g); /* before the pass's textures: making it takes the place of one of them */
    frame_set_common(f, s);
    if (job->at.shade >= 0) {
        const technique_use *surface = rule_use(s->figure->rule, KIND_SURFACE);
        uniforms_set(f->g, use_own_set(KIND_SURFACE, surface));
        used_textures_set(f->g, surface, material_made(s->figure, material));
        frame_set_numbers(f, surface);
    } else if (job->at.detail >= 0) {
        uniforms_set(f->g, use_own_set(KIND_SURFACE, rule_use(s->figure->rule, KIND_SURFACE)));
    }
    if (job->inking)
        set_ink(f, s, job->inking);
    set_layers(f, job);
    if (f->mirror)
        gpu_set_vec4(f->g, "u_clip_plane", f->clip_plane);
    if (s->targets[TARGET_REFLECTION])
        gpu_set_texture(f->g, target_rows[TARGET_REFLECTION].name, s->targets[TARGET_REFLECTION],
                        target_rows[TARGET_REFLECTION].filtered);
}

static gpu_state state_of(const raster_job *job)
{
    return (gpu_state){.depth_test = !job->node_vectors,
                       .depth_write = !job->node_vectors,
                       .depth_compare = job->stack ? GPU_LESS : GPU_LESS_EQUAL};
}

/* Does the surface lay strokes along the direction in which the item bends? */
static bool uses_field(const figure_state *s, const draw_item *item)
{
    const technique_use *surface = rule_use(s->figure->rule, KIND_SURFACE);
    return surface && surface->technique->surface->needs && surface->technique->surface->needs(surface->values).field &&
           gpu_mesh_has_tensors(item->mesh);
}

/* Or on patches? Layers and enlarged figures draw each triangle once. */
static bool uses_patches(const raster_job *job, const figure_state *s, const draw_item *item)
{
    const technique_use *surface = rule_use(s->figure->rule, KIND_SURFACE);
    return item->lapped && !job->stack && job->enlarge <= 0 && surface && surface->technique->surface->needs &&
           surface->technique->surface->needs(surface->values).patch > 0;
}

/* Does the surface lay out facades on the item's walls? */
static bool uses_walls(const raster_job *job, const figure_state *s, const draw_item *item)
{
    const technique_use *surface = rule_use(s->figure->rule, KIND_SURFACE);
    return (job->at.shade >= 0 || job->at.detail >= 0) && !item->is_cut && surface &&
           surface->technique->surface->needs && surface->technique->surface->needs(surface->values).walls &&
           gpu_mesh_has_walls(item->mesh);
}

/* Is anything tied to where the item is when nothing has moved? */
static bool uses_rest(const raster_job *job, const figure_state *s, const draw_item *item)
{
    const technique_use *surface = rule_use(s->figure->rule, KIND_SURFACE);
    bool                 shaded = job->at.shade >= 0 && surface && surface->technique->surface->needs &&
                  surface->technique->surface->needs(surface->values).rest;
    return (shaded || job->at.rest >= 0) && gpu_mesh_has_rest(item->mesh);
}

/* Does the surface look light up in a map of the item's? */
static bool wants_light_map(const raster_job *job, const figure_state *s, const draw_item *item)
{
    const technique_use *surface = rule_use(s->figure->rule, KIND_SURFACE);
    return job->at.shade >= 0 && !job->stack && item->has_uvs && !item->is_cut && surface &&
           surface->technique->surface->light_map_when &&
           params_condition(surface->technique->surface->light_map_when, surface->technique->params,
                            surface->technique->param_count, surface->values);
}

/* Are colour, part and building looked up? Where only depth is drawn, nobody asks. */
static bool uses_facts(const frame *f, const raster_job *job, const figure_state *s, const draw_item *item)
{
    return f->facts && item->has_key && !(s->figure->highlight.a > 0) && (job->pass->colour_count || job->node_vectors);
}

static void set_up(frame *f, const raster_job *job, const figure_state *s, const draw_item *item, raster_setup *last)
{
    bool field = uses_field(s, item), patches = uses_patches(job, s, item), rest = uses_rest(job, s, item);
    bool past = job->at.velocity >= 0 && gpu_mesh_has_past(item->mesh), walls = uses_walls(job, s, item);
    bool datum = material_is_datum(f, item), facts = uses_facts(f, job, s, item);
    if (last->ready && last->owner == s && item->material == last->material && item->has_uvs == last->has_uvs &&
        item->has_uv1 == last->has_uv1 && item->has_colours == last->has_colours && item->is_cut == last->is_cut &&
        field == last->has_field && patches == last->has_patches && walls == last->has_walls &&
        datum == last->has_datum && facts == last->has_facts && rest == last->has_rest && past == last->has_past)
        return;
    material        tinted;
    const material *m = material_of_item(f, s->figure, item, &tinted);
    item_textures   t = material_textures(f, item, m);
    text            prelude = {0};
    material_declare(&prelude, s, item, m, t, datum);
    text_append(&prelude, "%s%s", patches ? "#define HAS_PATCHES\n" : "",
                field && !patches ? "#define HAS_FIELD\n" : "");
    if (walls)
        text_append(&prelude, "#define HAS_WALLS\n");
    if (rest)
        text_append(&prelude, "#define HAS_REST\n");
    if (facts)
        text_append(&prelude, "#define HAS_FACTS\n");
    if (past)
        declare_past(&prelude, f, &job->at);
    if (wants_light_map(job, s, item))
        text_append(&prelude, "#define HAS_LIGHT_MAP\n");
    gpu_use(f->g, raster_program(f, s, "layer/raster.vert", prelude, job), state_of(job));
    if (gpu_failed(f->g))
        return;
    set_pass(f, job, s, item->material);
    view_set_projection(f->g, &f->camera);
    material_set(f->g, m, t, job->stack != NULL);
    if (facts)
        gpu_set_texture(f->g, "t_facts", f->facts, false);
    last->owner = s;
    last->material = item->material;
    last->has_uvs = item->has_uvs;
    last->has_uv1 = item->has_uv1;
    last->has_colours = item->has_colours;
    last->is_cut = item->is_cut;
    last->has_field = field;
    last->has_patches = patches;
    last->has_walls = walls;
    last->has_datum = datum;
    last->has_facts = facts;
    last->has_rest = rest;
    last->has_past = past;
    last->ready = true;
}

/* The figure among those of the stack that draws a part; NULL: none. */
static const figure_state *layer_owner(const layer_stack *stack, size_t part_index)
{
    for (int i = 0; i < stack->count; i++)
        if (stack->states[i].figure->designated[part_index])
            return &stack->states[i];
    return NULL;
}

/* The same among figures that share a geometry pass; the first one draws what belongs to none of them. */
static const figure_state *shared_owner(const frame *f, const raster_job *job, const draw_item *item)
{
    for (int i = 0; i < job->state_count; i++)
        if (job->states[i].figure->designated[item->part_index])
            return &job->states[i];
    return f->plan->opaque[item->part_index] ? &job->states[0] : NULL;
}

/* Whose item it is in this run; NULL: nobody's, it is not drawn. */
static const figure_state *owner_of(const frame *f, const raster_job *job, const draw_item *item)
{
    if (job->only && (!job->only[item->part_index] || (f->mirror && f->mirror->designated[item->part_index])))
        return NULL;
    if (job->states)
        return shared_owner(f, job, item);
    if (!job->state)
        return f->mirror && f->mirror->designated[item->part_index] ? NULL : layer_owner(job->stack, item->part_index);
    if (job->only)
        return job->state;
    if (!is_drawn(f, job->state->figure, item) ||
        ((job->inking || job->shell) && !job->state->figure->designated[item->part_index]))
        return NULL;
    return job->state;
}

static void set_ids(frame *f, const raster_job *job, const figure_state *s, const draw_item *item, uint32_t order)
{
    gpu_set_uint(f->g, "u_part_id", item->part_id);
    bool other = !job->stack && !job->only && !s->figure->designated[item->part_index];
    gpu_set_uint(f->g, "u_surface_id",
                 item->surface_id | (uint32_t)s->index << SURFACE_INDEX_BITS | (other ? SURFACE_COMPLEMENT : 0));
    gpu_set_uint(f->g, "u_order", order);
}

/* Draws what is gathered. */
static void draw_run(frame *f, raster_setup *last)
{
    if (!last->first)
        return;
    gpu_draw_meshes(f->g, last->run, last->run_count);
    for (size_t i = 0; i < last->run_count; i++)
        last->triangles += gpu_mesh_triangles(last->run[i]);
    last->run_count = 0;
    last->first = NULL;
}

static void gather(frame *f, const draw_item *item, gpu_mesh *drawn, raster_setup *last)
{
    if (!mem_grow((void **)&last->run, &last->run_capacity, last->run_count + 1, sizeof *last->run)) {
        gpu_fail(f->g, LMN_MEMORY, "out of memory");
        return;
    }
    last->run[last->run_count++] = drawn;
    if (!last->first)
        last->first = item;
}

/* Do two materials differ in nothing but a colour that is looked up? */
static bool are_alike(const frame *f, const figure_state *s, const raster_setup *last, int32_t a, int32_t b)
{
    if (a == b)
        return true;
    if (a < 0 || b < 0 || (s->figure->textures && s->figure->textures->by_material))
        return false;
    const material *x = &f->plan->scene->materials[a], *y = &f->plan->scene->materials[b];
    return x->base_texture.image < 0 && y->base_texture.image < 0 && x->normal_texture.image < 0 &&
           y->normal_texture.image < 0 && x->unlit == y->unlit && x->alpha == y->alpha &&
           (x->alpha == ALPHA_OPAQUE || (last->has_facts && x->alpha_cutoff == y->alpha_cutoff));
}

/* Is what the program ties to a part the same for two? */
static bool rest_alike(frame *f, const draw_item *a, const draw_item *b)
{
    const float *rows = f->up->part_frame_values;
    return !rows ||
           memcmp(&rows[PART_FRAME_FLOATS * a->part_index], &rows[PART_FRAME_FLOATS * b->part_index],
                  PART_FRAME_FLOATS * sizeof *rows) == 0 ||
           !gpu_has_uniform(f->g, "u_rest");
}

/* Is the item drawn by the same call as those that are gathered? Peeled layers are drawn part after part, front faces
 * before back faces; what moved has a past of its own, and some have a map of the light on them. */
static bool joins(frame *f, const raster_job *job, const figure_state *s, const draw_item *item,
                  const raster_setup *last)
{
    const draw_item *first = last->first;
    if (!first || !item->has_key || !first->has_key || last->owner != s || (job->stack && !job->node_vectors) ||
        job->at.velocity >= 0 || wants_light_map(job, s, item) || !gpu_meshes_together(first->mesh, item->mesh) ||
        first->surface_id != item->surface_id)
        return false;
    bool datum = material_is_datum(f, item), plain = !item->has_uvs && !item->has_colours;
    if (uses_facts(f, job, s, item) ? datum != last->has_datum && !plain : job->pass->colour_count || job->node_vectors)
        return false;
    return are_alike(f, s, last, first->material, item->material) &&
           memcmp(&first->world, &item->world, sizeof item->world) == 0 &&
           s->figure->designated[first->part_index] == s->figure->designated[item->part_index] &&
           rest_alike(f, first, item);
}

static void draw_item_of(frame *f, const raster_job *job, const draw_item *item, raster_setup *last)
{
    const figure_state *s = item->is_solid ? NULL : owner_of(f, job, item);
    if (!s || !(job->enlarge > 0 || camera_bounds_meet(&job->seen, f->up->pose->part_boxes[item->part_index])))
        return;
    if (joins(f, job, s, item, last)) {
        gather(f, item, item->mesh, last);
        return;
    }
    draw_run(f, last);
    gpu_texture *light_map = wants_light_map(job, s, item) ? light_map_draw(f, s, item) : NULL;
    if (light_map) {
        gpu_pass again = *job->pass;
        again.clear = false;
        gpu_pass_begin(f->g, &again);
        last->ready = false;
    }
    set_up(f, job, s, item, last);
    gpu_target_release(f->g, light_map);
    if (gpu_failed(f->g))
        return;
    gpu_set_texture(f->g, "t_light_map", light_map, true);
    view_set_transform(f->g, &f->camera, &item->world);
    frame_set_rest(f, item->part_index);
    if (job->at.velocity >= 0)
        set_past(f, &job->at, item);
    set_ids(f, job, s, item, last->triangles);
    if (job->enlarge > 0) /* in clip space at distance 1: two are the picture's height */
        gpu_set_float(f->g, "u_enlarge", 2 * job->enlarge / (float)f->height / (float)f->camera.projection.m[5]);
    if (item->is_cut)
        gpu_set_float(f->g, "u_nearer", 2 * item->nearer);
    if (last->has_patches)
        gpu_set_float(f->g, "u_patch_radius", item->patch_radius);
    if (last->has_walls)
        gpu_set_ivec2(f->g, "u_building", item->building.storeys, (int)item->building.use);
    if (last->has_datum)
        material_set_datum(f, item);
    gather(f, item, last->has_patches ? item->lapped : item->mesh, last);
}

/* The current surfaces of a solid part, as a sprite. */
static void draw_solid(frame *f, const raster_job *job, const draw_item *item)
{
    const figure_state *s = owner_of(f, job, item);
    text                prelude = {0};
    text_append(&prelude, "#define SOLID\n%s", f->plan->has_cut ? "#define HAS_CUT\n" : "");
    gpu_use(f->g, raster_program(f, s, "gpu/boxes.vert", prelude, job), state_of(job));
    if (gpu_failed(f->g))
        return;
    set_pass(f, job, s, NONE);
    gpu_set_texture(f->g, "t_surfaces", job->solids->surfaces, false);
    gpu_set_texture(f->g, "t_operands", f->up->operand_table, false);
    solids_set_depth(job->view, job->solids);
    gpu_set_vec2(f->g, "u_solid_size", (float)f->width, (float)f->height);
    float highlight[4] = {0, 0, 0, 0};
    if (s->figure->highlight.a > 0)
        uniforms_light(s->figure->highlight, highlight);
    gpu_set_vec4(f->g, "u_solid_highlight", highlight);
    gpu_set_float(f->g, "u_alpha_cutoff", 0);
    gpu_set_int(f->g, "u_unlit", 0);
    frame_set_rest(f, item->part_index);
    set_past(f, &job->at, item);
    set_ids(f, job, s, item, 0);
    int box[1][4];
    camera_pixels(&f->camera, f->up->pose->part_boxes[item->part_index], f->width, f->height, 2, box[0]);
    gpu_set_vec2(f->g, "u_target", (float)f->width, (float)f->height);
    gpu_draw_boxes(f->g, box, 1);
}

/* The solids that this run draws, one flag an item; NULL when there are none. The caller frees it. */
static bool *solids_wanted(frame *f, const raster_job *job)
{
    const upload *up = f->up;
    bool         *wanted = NULL;
    for (size_t i = 0; i < up->item_count && !job->shell && !gpu_failed(f->g); i++) {
        if (!up->items[i].is_solid || !owner_of(f, job, &up->items[i]))
            continue;
        if (!wanted && !(wanted = mem_calloc(up->item_count, sizeof *wanted)))
            gpu_fail(f->g, LMN_MEMORY, "out of memory");
        if (wanted)
            wanted[i] = true;
    }
    return wanted;
}

/* How the figure wants its solids evaluated; of several figures the first that says so decides. */
static int32_t evaluation_of(const raster_job *job)
{
    int     count = job->state ? 1 : job->states ? job->state_count : job->stack->count;
    int32_t evaluation = EVALUATION_AUTO;
    for (int i = 0; i < count && evaluation == EVALUATION_AUTO; i++) {
        const figure_state *s = job->state ? job->state : job->states ? &job->states[i] : &job->stack->states[i];
        evaluation = s->figure->layering.evaluation;
    }
    return evaluation;
}

/* Layer after layer; in front of what follows them only the nearest is needed. */
static void draw_solids(frame *f, const gpu_pass *pass, const raster_job *job, const bool *wanted)
{
    const upload *up = f->up;
    gpu_pass      again = *pass;
    again.clear = false;
    int count = job->solids->count;
    int needed = job->node_vectors ? job->stack->limit : job->peeled ? count : 1;
    count = count < needed ? count : needed;
    for (int layer = 0; layer < count && !gpu_failed(f->g); layer++) {
        if (layer != job->solids->index) {
            solids_select(job->view, job->solids, layer);
            gpu_pass_begin(f->g, &again);
        }
        for (size_t i = 0; i < up->item_count && !gpu_failed(f->g); i++)
            if (wanted[i] && !(i > 0 && wanted[i - 1] && up->items[i - 1].part_index == up->items[i].part_index))
                draw_solid(f, job, &up->items[i]);
    }
}

/* Draws parts into a pass. Layers order what coincides by part and then by facing; when peeling, whatever is drawn
 * first stays, so parts come in that order, front faces before back faces. Lists are sorted later. */
static void draw_parts(frame *f, const gpu_pass *pass, const raster_job *job)
{
    raster_setup  last = {0};
    const upload *up = f->up;
    raster_job    here = *job;
    solid_view    view = frame_solid_view(f);
    here.pass = pass;
    here.view = &view;
    here.seen = camera_bounds_of(&f->camera, f->width, f->height, pass->scissor);
    job = &here;
    bool *wanted = solids_wanted(f, job);
    if (wanted)
        solids_open(&view, job->solids, wanted,
                    &(solid_options){evaluation_of(job), job->stack ? job->stack->limit : 1, !job->stack});
    if (gpu_failed(f->g)) {
        mem_free(wanted);
        return;
    }
    gpu_pass_begin(f->g, pass);
    bool by_facing = job->stack && !job->node_vectors;
    for (size_t first = 0, end; first < up->item_count && !gpu_failed(f->g); first = end) {
        end = first + 1;
        while (end < up->item_count && up->items[end].part_index == up->items[first].part_index)
            end++;
        for (int round = 0; round < (by_facing ? 2 : 1); round++) {
            gpu_cull_faces(f->g, !by_facing ? GPU_CULL_NONE : round ? GPU_CULL_FRONT : GPU_CULL_BACK);
            for (size_t i = first; i < end && !gpu_failed(f->g); i++)
                draw_item_of(f, job, &up->items[i], &last);
            if (by_facing)
                draw_run(f, &last);
        }
    }
    draw_run(f, &last);
    mem_free(last.run);
    gpu_cull_faces(f->g, GPU_CULL_NONE);
    if (wanted)
        draw_solids(f, pass, job, wanted);
    mem_free(wanted);
}

/* Adds a channel to the geometry pass. */
static int add_output(frame *f, gpu_texture **targets, gpu_pass *pass, target t, double far)
{
    targets[t] = frame_acquire(f, t);
    target_empty(&target_rows[t], far, pass->clear_values[pass->colour_count]);
    pass->colours[pass->colour_count] = targets[t];
    return pass->colour_count++;
}

/* The pictures for these channels, cleared to emptiness, with a depth buffer. */
static outputs open_outputs(frame *f, unsigned channels, gpu_texture **targets, gpu_pass *pass, double far)
{
    outputs o = no_outputs;
    pass->clear = true;
    if (channels & CHANNEL_NORMAL_DEPTH)
        o.normal_depth = add_output(f, targets, pass, TARGET_NORMAL_DEPTH, far);
    if (channels & CHANNEL_ID)
        o.id = add_output(f, targets, pass, TARGET_ID, far);
    if (channels & CHANNEL_ALBEDO)
        o.albedo = add_output(f, targets, pass, TARGET_ALBEDO, far);
    if (channels & CHANNEL_SHADE)
        o.shade = add_output(f, targets, pass, TARGET_SHADE, far);
    if (channels & CHANNEL_REST)
        o.rest = add_output(f, targets, pass, TARGET_REST, far);
    if (channels & CHANNEL_DETAIL)
        o.detail = add_output(f, targets, pass, TARGET_DETAIL, far);
    if (channels & CHANNEL_VELOCITY)
        o.velocity = add_output(f, targets, pass, TARGET_VELOCITY, far);
    pass->depth = targets[TARGET_DEPTH] = frame_acquire(f, TARGET_DEPTH);
    return o;
}

void raster_figure(frame *f, figure_state *s)
{
    const figure *fig = s->figure;
    stopwatch     w = watch_start(&f->profile);
    gpu_pass      pass = {0};
    memcpy(pass.scissor, s->drawn[0], sizeof pass.scissor);
    memcpy(pass.clear_box, s->drawn[1], sizeof pass.clear_box);
    outputs o =
        open_outputs(f, fig->channels & ~(unsigned)(fig->deferred ? CHANNEL_SHADE : 0), s->targets, &pass, s->far);
    if (!gpu_failed(f->g)) {
        draw_parts(f, &pass, &(raster_job){.state = s, .solids = &s->solids, .at = o});
    }
    watch_stop(&f->profile, w, "", "geometry");
}

void raster_together(frame *f, const figure_state *states, int count, gpu_texture **targets)
{
    stopwatch    w = watch_start(&f->profile);
    unsigned     channels = 0;
    gpu_pass     pass = {0};
    solid_layers solids = {.ready = false};
    memcpy(pass.scissor, states[0].drawn[0], sizeof pass.scissor);
    memcpy(pass.clear_box, states[0].drawn[1], sizeof pass.clear_box);
    for (int i = 0; i < count; i++) {
        channels |= states[i].figure->channels & ~(unsigned)(states[i].figure->deferred ? CHANNEL_SHADE : 0);
        camera_widen_pixels(pass.scissor, states[i].drawn[0]);
        camera_widen_pixels(pass.clear_box, states[i].drawn[1]);
    }
    outputs o = open_outputs(f, channels, targets, &pass, states[0].far);
    if (!gpu_failed(f->g))
        draw_parts(f, &pass, &(raster_job){.states = states, .state_count = count, .solids = &solids, .at = o});
    solids_release(f->g, &solids);
    watch_stop(&f->profile, w, "", "geometry");
}

void raster_moved(frame *f, figure_state *s, int steps, unsigned channels)
{
    static const target between[] = {TARGET_PAST_1, TARGET_PAST_2, TARGET_PAST_3};
    stopwatch           w = watch_start(&f->profile);
    gpu_pass            pass = {0};
    memcpy(pass.scissor, s->pixels, sizeof pass.scissor);
    memcpy(pass.clear_box, s->around, sizeof pass.clear_box);
    outputs o = open_outputs(f, channels | CHANNEL_VELOCITY, s->targets, &pass, s->far);
    for (int k = 0; k < steps - 1; k++)
        o.between[k] = add_output(f, s->targets, &pass, between[k], s->far);
    if (!gpu_failed(f->g))
        draw_parts(f, &pass, &(raster_job){.state = s, .solids = &s->solids, .at = o});
    watch_stop(&f->profile, w, "motion", "velocity");
}

void raster_enlarged(frame *f, figure_state *s, target into, float pixels)
{
    gpu_pass     pass = {.clear = true, .colour_count = 1};
    gpu_texture *depth = frame_acquire(f, TARGET_DEPTH);
    gpu_target_release(f->g, s->targets[into]);
    pass.colours[0] = s->targets[into] = frame_acquire_for(f, s, into);
    pass.depth = depth;
    if (!gpu_failed(f->g)) {
        /* The clip planes hug the model; the enlarged one comes nearer and goes farther. */
        frame  wide = *f;
        double more = 2.02 * (double)pixels / (f->height * f->camera.projection.m[5]);
        double near = f->camera.near, far = f->camera.far;
        camera_set_range(&wide.camera, f->camera.orthographic ? near - more : near * (1 - fmin(more, 0.9)),
                         f->camera.orthographic ? far + more : far * (1 + more));
        draw_parts(
            &wide, &pass,
            &(raster_job){
                .state = s, .solids = &s->solids, .at = {0, -1, -1, -1, -1, -1, -1, NO_STEPS}, .enlarge = pixels});
    }
    gpu_target_release(f->g, depth);
}

void raster_shell(frame *f, figure_state *s, target into, float pixels)
{
    gpu_target_release(f->g, s->targets[into]);
    gpu_pass pass = {.clear = true, .depth = s->targets[into] = frame_acquire_for(f, s, into)};
    memcpy(pass.scissor, s->pixels, sizeof pass.scissor);
    memcpy(pass.clear_box, s->around, sizeof pass.clear_box);
    if (!gpu_failed(f->g)) {
        draw_parts(f, &pass,
                   &(raster_job){.state = s, .solids = &s->solids, .at = no_outputs, .enlarge = pixels, .shell = true});
    }
}

/* What shading from the G-buffer reads. */
static const pass shading = {
    .reads = {TARGET_NORMAL_DEPTH, TARGET_ID, TARGET_ALBEDO, TARGET_FORM, TARGET_DIRECTION, TARGET_REST, TARGET_DETAIL},
    .writes = TARGET_SHADE};

void raster_shade_deferred(frame *f, figure_state *s)
{
    const technique_use *surface = rule_use(s->figure->rule, KIND_SURFACE);
    stopwatch            w = watch_start(&f->profile);
    text                 prelude = {0};
    lights_declare(&prelude, f);
    uniforms_declare(&prelude, use_own_set(KIND_SURFACE, surface));
    used_textures_declare(&prelude, surface, &s->figure->textures->surface);
    text_append(&prelude, "#define SHADED_LATER\n%s", s->ground ? "#define ON_GROUND\n" : "");
    reads_declare(&prelude, f, s, &shading, NULL);
    char path[160];
    snprintf(path, sizeof path, "%s+layer/deferred.frag", surface->technique->surface->shader);
    s->targets[TARGET_SHADE] = frame_acquire(f, TARGET_SHADE);
    gpu_program *p = program_of(f, GPU_FLOOR, "gpu/screen.vert", path, &prelude);
    if (p && !gpu_failed(f->g)) {
        /* What is there alone: software drivers skip blocks of pixels by the depth test. The ground has no depth. */
        gpu_texture *depth = s->targets[TARGET_DEPTH];
        gpu_pass     pass = {.colours = {s->targets[TARGET_SHADE]}, .colour_count = 1, .clear = true};
        memcpy(pass.scissor, s->pixels, sizeof pass.scissor);
        memcpy(pass.clear_box, s->around, sizeof pass.clear_box);
        gpu_pass_begin(f->g, &pass);
        if (depth) {
            pass.clear = false;
            pass.depth = depth;
            gpu_pass_begin(f->g, &pass);
        }
        gpu_use(f->g, p, (gpu_state){.depth_test = depth != NULL, .depth_compare = GPU_GREATER});
        frame_set_common(f, s);
        uniforms_set(f->g, use_own_set(KIND_SURFACE, surface));
        used_textures_set(f->g, surface, &s->figure->textures->surface);
        frame_set_numbers(f, surface);
        reads_set(f, s, &shading, NULL);
        gpu_draw_screen(f->g);
    }
    watch_stop(&f->profile, w, "", "deferred shading");
}

void raster_direct(frame *f, figure_state *s)
{
    stopwatch w = watch_start(&f->profile);
    gpu_pass  pass = {.colours = {f->page}, .colour_count = 1, .depth = f->page_depth};
    memcpy(pass.scissor, s->pixels, sizeof pass.scissor);
    draw_parts(f, &pass, &(raster_job){.state = s, .solids = &s->solids, .at = {-1, -1, -1, 0, -1, -1, -1, NO_STEPS}});
    watch_stop(&f->profile, w, "", "geometry");
}

/* The third pass of edge enhancement (Nienhaus 2005, section 4.4): the parts once more, with the edge map projected
 * on them. */
void raster_inked(frame *f, figure_state *s, const pass *inking)
{
    gpu_pass onto = {.colours = {f->page}, .colour_count = 1, .depth = f->page_depth};
    memcpy(onto.scissor, s->pixels, sizeof onto.scissor);
    draw_parts(f, &onto,
               &(raster_job){.state = s,
                             .solids = &s->solids,
                             .at = {-1, -1, -1, 0, -1, -1, -1, NO_STEPS},
                             .inking = rule_inked_lines(s->figure->rule) ? inking : NULL});
}

void layer_outputs_open(frame *f, layer_stack *stack, gpu_pass *pass, text *prelude)
{
    memcpy(pass->scissor, stack->around, sizeof pass->scissor);
    memcpy(pass->clear_box, stack->around, sizeof pass->clear_box);
    outputs at = open_outputs(f, stack->channels, stack->targets, pass, f->camera.far);
    declare_outputs(prelude, &(raster_job){.stack = stack, .at = at});
}

void raster_layer(frame *f, layer_stack *stack, bool first)
{
    stopwatch w = watch_start(&f->profile);
    gpu_pass  pass = {0};
    memcpy(pass.scissor, stack->around, sizeof pass.scissor);
    memcpy(pass.clear_box, stack->around, sizeof pass.clear_box);
    /* Part and facing order what coincides. */
    outputs o = open_outputs(f, stack->channels | CHANNEL_ID, stack->targets, &pass, f->camera.far);
    if (!gpu_failed(f->g)) {
        draw_parts(f, &pass, &(raster_job){.stack = stack, .solids = &stack->solids, .at = o, .peeled = !first});
    }
    watch_stop(&f->profile, w, "layers", "peel");
}

void raster_lists(frame *f, layer_stack *stack, int node_vectors, unsigned node_limit)
{
    /* Nothing is written but the lists; a framebuffer needs a picture all the same. */
    gpu_pass pass = {.depth = f->page_depth};
    memcpy(pass.scissor, stack->around, sizeof pass.scissor);
    outputs o = no_outputs;
    if (stack->channels & CHANNEL_SHADE)
        o.shade = 0;
    if (stack->channels & CHANNEL_ALBEDO)
        o.albedo = 0;
    draw_parts(
        f, &pass,
        &(raster_job){
            .stack = stack, .solids = &stack->solids, .at = o, .node_vectors = node_vectors, .node_limit = node_limit});
}

void raster_depth(frame *f, gpu_texture *depth)
{
    raster_depth_of(f, depth, f->plan->selected);
}

void raster_depth_of(frame *f, gpu_texture *depth, bool *parts)
{
    gpu_pass pass = {.depth = depth, .clear = true};
    figure   all = {.rule = f->plan->figures[0].rule, .layering = f->plan->figures[0].layering, .designated = parts};
    figure_state s = {.figure = &all, .near = f->camera.near, .far = f->camera.far};
    solid_layers solids = {.ready = false};
    draw_parts(f, &pass, &(raster_job){.state = &s, .solids = &solids, .at = no_outputs, .only = parts});
    solids_release(f->g, &solids);
}

void raster_meeting(frame *f, figure_state *s)
{
    bool any = false, *parts = s->figure->meets ? mem_calloc(f->plan->part_count + 1, sizeof *parts) : NULL;
    if (s->figure->meets && (!parts || !plan_find_meetings(f->plan, s->figure, parts, &any)))
        gpu_fail(f->g, LMN_MEMORY, "out of memory");
    if (any && !gpu_failed(f->g)) {
        stopwatch w = watch_start(&f->profile);
        s->targets[TARGET_MEETING] = frame_acquire(f, TARGET_MEETING);
        if (!gpu_failed(f->g))
            raster_depth_of(f, s->targets[TARGET_MEETING], parts);
        watch_stop(&f->profile, w, "", "meetings");
    }
    mem_free(parts);
}

void raster_mask(frame *f, layer_stack *stack, const bool *parts)
{
    stopwatch w = watch_start(&f->profile);
    stack->mask = frame_acquire(f, TARGET_DEPTH);
    gpu_pass pass = {.depth = stack->mask, .clear = true};
    if (!gpu_failed(f->g)) {
        solid_layers solids = {.ready = false};
        draw_parts(f, &pass,
                   &(raster_job){.state = &stack->states[0], .solids = &solids, .at = no_outputs, .only = parts});
        solids_release(f->g, &solids);
    }
    watch_stop(&f->profile, w, "layers", "mask");
}
