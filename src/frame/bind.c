/* What programs of all passes get: pictures, parameters, and the facts of the frame. */
#include "frame/frame_private.h"

#include <math.h>
#include <string.h>

#include "base/memory.h"
#include "layer/layer.h"
#include "light/light.h"

/* How cut faces are hatched. */
static void set_cut(frame *f)
{
    const scene_values *v = f->plan->look->wide[KIND_SCENE].values;
    const colour        lines = v->cut_colour, fill = isnan(v->cut_fill.r) ? (colour){1, 1, 1, -1} : v->cut_fill;
    gpu_set_vec4(f->g, "u_cut_lines", (float[]){v->cut_hatch, v->cut_width, v->cut_angle * (3.14159265f / 180), 0});
    gpu_set_vec4(f->g, "u_cut_colour", (float[]){lines.r, lines.g, lines.b, lines.a});
    gpu_set_vec4(f->g, "u_cut_fill", (float[]){fill.r, fill.g, fill.b, fill.a});
}

solid_view frame_solid_view(frame *f)
{
    return (solid_view){f->g, f->up, &f->camera, f->width, f->height, f->page_depth, &f->profile};
}

void frame_set_rest(frame *f, size_t part_index)
{
    if (!gpu_has_uniform(f->g, "u_rest") || !upload_part_frames(f->up, f->g))
        return;
    const float *rows = &f->up->part_frame_values[PART_FRAME_FLOATS * part_index];
    double       world[16];
    float        out[12];
    view_world_from_eye(&f->camera, f->up->frame_origin, world);
    for (int row = 0; row < 3; row++)
        for (int column = 0; column < 4; column++) {
            double sum = 0;
            for (int k = 0; k < 4; k++)
                sum += (double)rows[4 * row + k] * world[4 * column + k];
            out[4 * row + column] = (float)sum;
        }
    gpu_set_vec4_array(f->g, "u_rest", out, 3);
    gpu_set_vec3(f->g, "u_upward", &rows[13]);
    gpu_set_vec3(f->g, "u_level", &rows[16]);
}

static void set_part_frames(frame *f, const figure_state *s)
{
    gpu_texture *frames = upload_part_frames(f->up, f->g);
    double       exact[16];
    float        world[16];
    view_world_from_eye(&f->camera, f->up->frame_origin, exact);
    for (int i = 0; i < 16; i++)
        world[i] = (float)exact[i];
    gpu_set_mat4(f->g, "u_world_from_eye", world);
    gpu_set_texture(f->g, "t_part_frames", frames, false);
    int only = 0; /* where there are no ids there is one part */
    for (size_t i = 0; i < f->up->part_count; i++)
        if (s->figure->designated[i])
            only = (int)i;
    gpu_set_int(f->g, "u_only_part", only);
}

void frame_set_numbers(frame *f, const technique_use *use)
{
    if (!use->technique->numbers || !gpu_has_uniform(f->g, "u_numbers"))
        return;
    float  numbers[NUMBERS_MAX][4];
    size_t count = use->technique->numbers(use->values, f->seed, f->width, f->height, numbers);
    gpu_set_vec4_array(f->g, "u_numbers", numbers[0], (int)count);
}

/* What the coarse pictures of a perturbation are measured in. */
static void set_field(frame *f, const figure_state *s)
{
    const technique_use *use = rule_use(s->figure->rule, KIND_PERTURB);
    const perturbation  *p = use->technique->perturbs;
    if (p->cell) {
        int size[2];
        target_size(f, s, SCALE_CELL, size);
        gpu_set_float(f->g, "u_cell", p->cell(use->values));
        gpu_set_vec2(f->g, "u_grid", (float)size[0], (float)size[1]);
    }
    gpu_set_float(f->g, "u_reach", fmaxf(p->reach(use->values), 1));
    gpu_set_uint(f->g, "u_seed", p->seed(use->values, f->seed, f->time_s));
    /* What the pictures of normals and depth were cleared to. */
    gpu_set_float(f->g, "u_empty", (float)(s->figure->layered ? f->camera.far : s->far));
}

/* The walls of a hole are where what was taken away ends. Both are found apart, so their depths differ by rounding,
 * of positions as fractions of the distance and of window depth: the ghost shall be in front, rather than in speckles.
 */
static float forward_of(const frame *f, const figure *fig)
{
    double far = f->camera.far, range = far - f->camera.near;
    return fig->ghostly && range > 0 ? (float)fmin(2e-6 + 5e-7 * far / range, 1e-3) : 0;
}

static void find_depths(const frame *f, double *nearest, double *farthest)
{
    *nearest = INFINITY;
    *farthest = -INFINITY;
    camera_depth_range(&f->camera, f->plan->box, nearest, farthest);
}

static void set_depths(frame *f)
{
    double nearest, farthest;
    find_depths(f, &nearest, &farthest);
    gpu_set_vec2(f->g, "u_depths", (float)fmax(nearest, f->camera.near), (float)fmax(farthest, f->camera.near));
}

/* Where it has a position instead: from above, as by the studio's. */
static void set_first_light(frame *f)
{
    double towards[3] = {-0.35, 0.7, 0.62};
    lights_first_direction(f, towards);
    double length = sqrt(towards[0] * towards[0] + towards[1] * towards[1] + towards[2] * towards[2]);
    float  out[3];
    for (int k = 0; k < 3; k++)
        out[k] = (float)(towards[k] / fmax(length, 1e-30));
    gpu_set_vec3(f->g, "u_first_light", out);
}

/* The range is that of all that is drawn, so that figures agree. */
static void set_focus(frame *f)
{
    const scene_values *v = f->plan->look->wide[KIND_SCENE].values;
    double              nearest, farthest;
    find_depths(f, &nearest, &farthest);
    double range = fmax(farthest - nearest, 1e-30);
    gpu_set_vec4(f->g, "u_focus",
                 (float[]){v->focus, (float)(nearest + (double)v->focus_at * range),
                           (float)(1 / ((double)v->focus_depth * range)), 0});
}

static void set_depth_cue(frame *f)
{
    double nearest, farthest;
    find_depths(f, &nearest, &farthest);
    nearest = fmax(nearest, f->camera.near);
    gpu_set_vec4(f->g, "u_depth_cue",
                 (float[]){((const scene_values *)f->plan->look->wide[KIND_SCENE].values)->depth_cue, (float)nearest,
                           (float)(1 / fmax(farthest - nearest, 1e-30)), 0});
}

/* Where the middle of all that is drawn lies on the page: strokes on the page move with it. */
static void set_anchor(frame *f)
{
    const double *view = f->camera.view.m, *projection = f->camera.projection.m;
    double        middle[3], eye[3];
    box3_middle(f->anchor, middle);
    for (int k = 0; k < 3; k++)
        eye[k] = view[k] * middle[0] + view[4 + k] * middle[1] + view[8 + k] * middle[2] + view[12 + k];
    double depth = f->camera.orthographic ? 1 : fmax(-eye[2], f->camera.near);
    gpu_set_vec2(f->g, "u_anchor", (float)((projection[0] * eye[0] / depth + 1) * f->width / 2),
                 (float)((projection[5] * eye[1] / depth + 1) * f->height / 2));
}

static void set_around(frame *f, const figure_state *s)
{
    const int *b = s->around;
    bool       whole = b[2] <= 0 || b[3] <= 0;
    gpu_set_vec4(f->g, "u_around",
                 (float[]){whole ? 0 : (float)b[0], whole ? 0 : (float)b[1], (float)(whole ? f->width : b[0] + b[2]),
                           (float)(whole ? f->height : b[1] + b[3])});
}

/* Where heights are counted from, in eye space: of all of the figure. */
static void set_heights(frame *f, const figure_state *s)
{
    const lmn_scene  *scene = f->plan->scene;
    const city_facts *city = &scene->city;
    const double     *m = f->camera.view.m;
    const int         axis = scene->up == 'z' ? 2 : 1;
    box3              box = s->figure->box;
    double low = (double)(axis == 2 ? box.min.z : box.min.y), high = (double)(axis == 2 ? box.max.z : box.max.y);
    double up[4] = {m[4 * axis], m[4 * axis + 1], m[4 * axis + 2], -low};
    for (int k = 0; k < 3; k++) /* of the eye, less that of the lowest */
        up[3] -= up[k] * m[12 + k];
    double origin = city->known ? city->origin[2] * (city->metres[1] > 0 ? city->metres[1] : 1) : 0;
    gpu_set_vec4(f->g, "u_height", (float[]){(float)up[0], (float)up[1], (float)up[2], (float)up[3]});
    gpu_set_vec2(f->g, "u_height_range", (float)(low + origin), (float)fmax(high - low, 1e-30));
}

/* What ghost images are mixed with: the page's ground, or white paper where it has none. */
static void set_pale(frame *f, const figure_state *s)
{
    float paper[4];
    frame_ground(f, paper);
    for (int k = 0; k < 3; k++)
        paper[k] = paper[3] > 0 ? paper[k] / paper[3] : 1;
    paper[3] = s->figure->rule->pale;
    gpu_set_vec4(f->g, "u_ghost", paper);
}

void frame_set_common(frame *f, const figure_state *s)
{
    gpu *g = f->g;
    /* Before any texture is bound: making this one binds it in place of another. */
    bool of_parts = gpu_has_uniform(g, "u_world_from_eye") || gpu_has_uniform(g, "t_part_frames");
    if (gpu_has_uniform(g, "u_rest") || of_parts)
        upload_part_frames(f->up, g);
    gpu_set_vec2(g, "u_size", (float)f->width, (float)f->height);
    gpu_set_float(g, "u_pixels_per_mm", (float)f->pixels_per_mm);
    gpu_set_vec2(g, "u_texel", 1 / (float)f->width, 1 / (float)f->height);
    gpu_set_float(g, "u_perspective", f->camera.orthographic ? 0 : 1);
    gpu_set_vec2(g, "u_unproject", (float)(1 / f->camera.projection.m[0]), (float)(1 / f->camera.projection.m[5]));
    const double *m = f->camera.projection.m;
    gpu_set_vec4(g, "u_window_depth", (float[]){(float)m[10], (float)m[14], (float)m[11], (float)m[15]});
    set_around(f, s);
    gpu_set_float(g, "u_near", (float)s->near);
    gpu_set_float(g, "u_far", (float)s->far);
    gpu_set_int(g, "u_layer", s->layer);
    gpu_set_int(g, "u_figure", s->index);
    gpu_set_float(g, "u_rear", s->rear);
    gpu_set_float(g, "u_forward", forward_of(f, s->figure));
    gpu_set_int(g, "u_filled", s->filled);
    set_pale(f, s);
    gpu_set_float(g, "u_time", (float)f->time_s);
    if (rule_use(s->figure->rule, KIND_PERTURB))
        set_field(f, s);
    if (of_parts)
        set_part_frames(f, s);
    if (gpu_has_uniform(g, "u_light_position"))
        lights_set(f);
    if (f->shadow && gpu_has_uniform(g, "u_shadow_from_eye"))
        shadow_set(f);
    visibility_set(f);
    if (gpu_has_uniform(g, "u_cut_lines"))
        set_cut(f);
    if (gpu_has_uniform(g, "u_focus"))
        set_focus(f);
    if (gpu_has_uniform(g, "u_depth_cue"))
        set_depth_cue(f);
    if (gpu_has_uniform(g, "u_anchor"))
        set_anchor(f);
    if (gpu_has_uniform(g, "u_tone_range"))
        gpu_set_vec3(g, "u_tone_range", (float[]){f->tone_range.low, f->tone_range.gain, f->tone_range.gamma});
    if (gpu_has_uniform(g, "u_first_light"))
        set_first_light(f);
    if (gpu_has_uniform(g, "u_depths"))
        set_depths(f);
    if (gpu_has_uniform(g, "u_height"))
        set_heights(f, s);
}

/* The normal matrix in single precision is scaled so that it neither over- nor underflows. */
static const char *prefix_of(kind_id id)
{
    return id == KIND_LINES ? "u_line_" : id == KIND_PERTURB ? "u_perturb_" : "u_";
}

param_set use_own_set(kind_id id, const technique_use *use)
{
    return (param_set){prefix_of(id), use->technique->params, use->technique->param_count, use->values};
}

param_set use_common_set(kind_id id, const technique_use *use)
{
    return (param_set){prefix_of(id), kinds[id]->common, kinds[id]->common_count, use->values};
}

/* The line technique that a composition inks; NULL when the rule has none. */
const technique_use *rule_inked_lines(const rule *r)
{
    size_t count = r->use_counts[KIND_LINES];
    return count ? &r->uses[KIND_LINES][count - 1] : NULL;
}

static const gpu_format formats[TEXEL_FORMAT_COUNT] = {
    [TEXEL_R8] = GPU_R8,
    [TEXEL_RGBA8] = GPU_RGBA8,
    [TEXEL_RGBA16F] = GPU_RGBA16F,
    [TEXEL_RGBA32F] = GPU_RGBA32F,
    [TEXEL_RG32UI] = GPU_RG32UI,
    [TEXEL_DEPTH32F] = GPU_DEPTH32F,
    [TEXEL_RGBA32UI] = GPU_RGBA32UI,
};

const target_row *target_row_of(const figure_state *s, target t)
{
    return t < TARGET_COUNT ? &target_rows[t] : &s->own_targets[t - TARGET_COUNT];
}

gpu_texture *frame_acquire_sized(frame *f, target t, int width, int height)
{
    return gpu_target_acquire(f->g, width, height, formats[target_rows[t].format]);
}

gpu_texture *frame_acquire(frame *f, target t)
{
    return frame_acquire_sized(f, t, f->width, f->height);
}

static void size_in_squares(const frame *f, int side, int out[2])
{
    out[0] = (f->width + side - 1) / side;
    out[1] = (f->height + side - 1) / side;
}

static void size_in_cells(const frame *f, const figure_state *s, int out[2])
{
    const technique_use *use = rule_use(s->figure->rule, KIND_PERTURB);
    float                cell = use->technique->perturbs->cell(use->values);
    /* One more, so that every pixel lies between two texels. */
    out[0] = (int)ceilf((float)f->width / cell) + 1;
    out[1] = (int)ceilf((float)f->height / cell) + 1;
}

void target_size(const frame *f, const figure_state *s, target_scale scale, int out[2])
{
    out[0] = f->width;
    out[1] = f->height;
    if (scale == SCALE_HALF)
        size_in_squares(f, 2, out);
    else if (scale == SCALE_APART)
        size_in_squares(f, DIRECTION_APART, out);
    else if (scale == SCALE_TILE)
        size_in_squares(f, TILE_PIXELS, out);
    else if (scale == SCALE_CELL)
        size_in_cells(f, s, out);
}

gpu_texture *frame_acquire_for(frame *f, const figure_state *s, target t)
{
    const target_row *row = target_row_of(s, t);
    int               size[2];
    target_size(f, s, row->scale, size);
    return gpu_target_acquire(f->g, size[0], size[1], formats[row->format]);
}

gpu_texture *target_of(const frame *f, const figure_state *s, target t)
{
    return t == TARGET_PAGE ? f->page : t == TARGET_SHADOW ? f->shadow : s->targets[t];
}

bool pass_applies(kind_id id, const pass *p, const technique_use *use)
{
    const technique *t = use->technique;
    const kind      *k = kinds[id];
    if (!p->when)
        return true;
    char   key[32];
    size_t length = strcspn(p->when, "=<>&");
    if (length >= sizeof key)
        return false;
    memcpy(key, p->when, length);
    key[length] = '\0';
    for (size_t i = 0; i < k->common_count; i++)
        if (strcmp(k->common[i].key, key) == 0)
            return params_condition(p->when, k->common, k->common_count, use->values);
    return params_condition(p->when, t->params, t->param_count, use->values);
}

bool rule_traces_lines(const rule *r)
{
    for (size_t i = 0; i < r->use_counts[KIND_LINES]; i++) {
        const technique_use *use = &r->uses[KIND_LINES][i];
        for (size_t k = 0; k < use->technique->pass_count; k++)
            if (use->technique->passes[k].process && pass_applies(KIND_LINES, &use->technique->passes[k], use))
                return true;
    }
    return false;
}

static bool use_condition(const technique_use *use, const char *condition)
{
    return params_condition(condition, use->technique->params, use->technique->param_count, use->values);
}

static bool needs_map(const technique_use *compose)
{
    const technique *t = compose->technique;
    if (t->compose->map_when && use_condition(compose, t->compose->map_when))
        return true;
    for (size_t i = 0; i < t->pass_count; i++) {
        const pass *p = &t->passes[i];
        if (p->writes == TARGET_PAGE || p->writes == TARGET_LAYERS || !pass_applies(KIND_COMPOSE, p, compose))
            continue;
        for (int k = 0; k < PASS_READS_MAX && p->reads[k]; k++)
            if (p->reads[k] == TARGET_EDGE)
                return true;
    }
    return false;
}

const pass *rule_merged_detection(const rule *r)
{
    const technique_use *compose = rule_use(r, KIND_COMPOSE), *lines = rule_inked_lines(r);
    if (!compose || !compose->technique->compose->merges_when || needs_map(compose) || rule_use(r, KIND_PERTURB) ||
        r->use_counts[KIND_LINES] != 1 || !lines->technique->lines->detect ||
        !params_condition(compose->technique->compose->merges_when, kinds[KIND_LINES]->common,
                          kinds[KIND_LINES]->common_count, lines->values))
        return NULL;
    const pass *only = NULL;
    for (size_t i = 0; i < lines->technique->pass_count; i++) {
        const pass *p = &lines->technique->passes[i];
        if (!pass_applies(KIND_LINES, p, lines))
            continue;
        if (only)
            return NULL;
        only = p;
    }
    return only;
}

gpu_program *program_of(frame *f, gpu_dialect dialect, const char *vertex, const char *fragment, text *prelude)
{
    text_append(prelude, "#define DIRECTION_APART %d\n#define TILE_PIXELS %d\n", DIRECTION_APART, TILE_PIXELS);
    const scene_values *scene = f->plan->look->wide[KIND_SCENE].values;
    if (scene->focus > 0)
        text_append(prelude, "#define HAS_FOCUS\n");
    if (scene->depth_cue > 0)
        text_append(prelude, "#define HAS_DEPTH_CUE\n");
    if (f->tone_range.automatic)
        text_append(prelude, "#define RANGED\n");
    return view_program(f->g, dialect, vertex, fragment, prelude);
}

/* The pictures of both passes, each once. Returns how many. */
static int union_of_reads(const pass *a, const pass *b, target out[2 * PASS_READS_MAX])
{
    int count = 0;
    for (int which = 0; which < 2; which++) {
        const pass *p = which ? b : a;
        for (int i = 0; p && i < PASS_READS_MAX && p->reads[i]; i++) {
            bool known = false;
            for (int k = 0; k < count; k++)
                known = known || out[k] == p->reads[i];
            if (!known)
                out[count++] = p->reads[i];
        }
    }
    return count;
}

void reads_declare(text *prelude, const frame *f, const figure_state *s, const pass *a, const pass *b)
{
    target reads[2 * PASS_READS_MAX];
    int    count = union_of_reads(a, b, reads);
    for (int i = 0; i < count; i++) {
        if (!target_of(f, s, reads[i]))
            continue;
        target_declare(prelude, target_row_of(s, reads[i]));
        if (reads[i] == TARGET_ID && f->plan->has_cut)
            text_append(prelude, "#define HAS_CUT\n");
    }
    if (s->shared)
        text_append(prelude, "#define SHARED_LAYERS\n");
}

void reads_set(frame *f, const figure_state *s, const pass *a, const pass *b)
{
    target reads[2 * PASS_READS_MAX];
    int    count = union_of_reads(a, b, reads);
    for (int i = 0; i < count; i++) {
        const target_row *row = target_row_of(s, reads[i]);
        gpu_set_texture(f->g, row->name, target_of(f, s, reads[i]), row->filtered);
    }
}
