/* The shadow that a model throws on the ground beneath it: sharp and dark where it touches, nothing where it floats.
 *
 * What stands over a place from height a to b takes e^(−a / reach) of its light. What each height dh between takes,
 * e^(−h / reach) dh / reach, is spread over a Gaussian of standard deviation h / 2; what remains, e^(−b / reach), over
 * one of a / 2, so that what is thin darkens, too. The model is looked at from below and from above; slabs of height
 * are spread from the highest down, each in a picture half as fine as the one below it. */
#include "frame/frame_private.h"

#include <math.h>
#include <string.h>

#include "light/light.h"

enum { SLABS = 6 };
static const double SPREAD = 0.5;             /* standard deviation over height */
static const double MARGIN = 1.5;             /* reaches beyond the model in which something of the shadow may lie; */
static const double DRAWN_MARGIN = 0.8;       /* of what is dark enough for strokes */
static const double BLUR_VARIANCE = 0.5;      /* of light/ground_blur.frag */
static const double READ_VARIANCE = 3.0 / 16; /* of reading a picture half as fine, in its texels */

static const scene_values *values_of(const frame *f)
{
    return f->plan->look->wide[KIND_SCENE].values;
}

void ground_range(box3 box, int axis, double out[2])
{
    const float low[3] = {box.min.x, box.min.y, box.min.z}, high[3] = {box.max.x, box.max.y, box.max.z};
    out[0] = (double)low[axis];
    out[1] = (double)high[axis];
}

static ground_square square_of(const ground_plane *ground)
{
    ground_square s = {.axes = {0, 3 - ground->up}};
    for (int k = 0; k < 2; k++) {
        double range[2];
        ground_range(ground->box, s.axes[k], range);
        s.middle[k] = (range[0] + range[1]) / 2;
        s.half = fmax(s.half, (range[1] - range[0]) / 2);
    }
    double upward[2];
    ground_range(ground->box, ground->up, upward);
    s.height = fmax(upward[1] - ground->level, 1e-3 * ground->size);
    s.half += MARGIN * ground->reach;
    return s;
}

view_camera ground_camera(const ground_plane *ground, const ground_square *s, bool below)
{
    view_camera c = {.orthographic = true, .aspect = 1, .half_height = s->half, .view = mat4_identity()};
    double      right[3] = {1, 0, 0}, back[3] = {0, 0, 0}, up[3] = {0, 0, 0};
    back[ground->up] = below ? -1 : 1;
    up[3 - ground->up] = (ground->up == 1) == below ? 1 : -1;
    for (int k = 0; k < 2; k++)
        c.eye[s->axes[k]] = s->middle[k];
    c.eye[ground->up] = ground->level + (below ? -1 : 2) * s->height;
    const double *axes[3] = {right, up, back};
    for (int row = 0; row < 3; row++) {
        c.view.m[12 + row] = 0;
        for (int k = 0; k < 3; k++) {
            c.view.m[4 * k + row] = axes[row][k];
            c.view.m[12 + row] -= axes[row][k] * c.eye[k];
        }
    }
    camera_set_range(&c, s->height, 2 * s->height);
    return c;
}

/* What the slabs' spreads come to, in texels of the finest. The mean over squares, the blur, and reading what is
 * coarser add their variances. */
static void spread_of_slabs(double out[SLABS])
{
    double before = 0;
    for (int k = 0; k < SLABS; k++) {
        double area = ldexp(1, 2 * k);
        before += (k ? READ_VARIANCE * area : 0) + BLUR_VARIANCE * area;
        out[k] = (area - 1) / 12 + before;
    }
}

/* Pictures of what is drawn, seen along the upright. */
typedef struct ground_depths {
    view_camera  below;
    double       height; /* of the eye below the ground, and of the other one above what is highest */
    gpu_texture *from_below, *from_above;
} ground_depths;

static void draw_slab(frame *f, const ground_depths *d, gpu_texture *higher, int level, gpu_texture *out)
{
    text   prelude = {0};
    double spreads[SLABS], texel = 2 * d->below.half_height / GROUND_SIDE, reach = f->ground_plane.reach;
    double heights[SLABS + 2] = {0};
    spread_of_slabs(spreads);
    for (int k = 0; k < SLABS; k++)
        heights[k + 1] = sqrt(spreads[k]) * texel / SPREAD;
    heights[0] = -1;                      /* all that is lower belongs to the first slab, */
    heights[SLABS + 1] = 1e6 * d->height; /* and what is higher to the last */
    if (higher)
        text_append(&prelude, "#define HAS_HIGHER\n");
    gpu_program *p = program_of(f, GPU_FLOOR, "gpu/screen.vert", "light/ground_slab.frag", &prelude);
    if (!p || gpu_failed(f->g))
        return;
    gpu_pass_begin(f->g, &(gpu_pass){.colours = {out}, .colour_count = 1});
    gpu_use(f->g, p, (gpu_state){0});
    gpu_set_texture(f->g, "t_below", d->from_below, false);
    gpu_set_texture(f->g, "t_above", d->from_above, false);
    if (higher)
        gpu_set_texture(f->g, "t_higher", higher, true);
    gpu_set_int(f->g, "u_side", 1 << level);
    gpu_set_vec4(f->g, "u_slab",
                 (float[]){(float)((d->below.near - d->height) / reach),
                           (float)((d->below.far - d->below.near) / reach),
                           (float)((2 * d->height - d->below.near) / reach), 0});
    gpu_set_vec3(f->g, "u_slabs",
                 (float[]){(float)(heights[level] / reach), (float)(heights[level + 1] / reach),
                           (float)(heights[level + 2] / reach)});
    gpu_set_vec2(f->g, "u_ends", level == 0 ? 1 : 0, level == SLABS - 1 ? 1 : 0);
    gpu_draw_screen(f->g);
}

static void blur_slab(frame *f, gpu_texture *slab, gpu_texture *out)
{
    text         prelude = {0};
    gpu_program *p = program_of(f, GPU_FLOOR, "gpu/screen.vert", "light/ground_blur.frag", &prelude);
    if (!p || gpu_failed(f->g))
        return;
    gpu_pass_begin(f->g, &(gpu_pass){.colours = {out}, .colour_count = 1});
    gpu_use(f->g, p, (gpu_state){0});
    gpu_set_texture(f->g, "t_slab", slab, true);
    gpu_draw_screen(f->g);
}

gpu_texture *ground_depth(frame *f, const view_camera *camera)
{
    frame from = *f;
    from.camera = *camera;
    from.width = from.height = GROUND_SIDE;
    from.maps = NULL;
    from.shadow = NULL;
    from.page_depth =
        gpu_target_acquire(f->g, GROUND_SIDE, GROUND_SIDE, GPU_DEPTH32F); /* what solids are gathered in */
    if (!gpu_failed(f->g))
        raster_depth(&from, from.page_depth);
    return from.page_depth;
}

/* How dark the ground is where. The caller gives it back. */
static gpu_texture *draw_map(frame *f, const ground_square *square, const view_camera *below)
{
    stopwatch     w = watch_start(&f->profile);
    gpu_texture  *higher = NULL;
    view_camera   above = ground_camera(&f->ground_plane, square, false);
    ground_depths d = {*below, square->height, ground_depth(f, below), NULL};
    d.from_above = gpu_failed(f->g) ? NULL : ground_depth(f, &above);
    watch_stop(&f->profile, w, "scene", "depth along the upright");
    w = watch_start(&f->profile);
    for (int level = SLABS - 1; level >= 0 && !gpu_failed(f->g); level--) {
        int          side = GROUND_SIDE >> level;
        gpu_texture *slab = gpu_target_acquire(f->g, side, side, GPU_RG16F),
                    *spread = gpu_target_acquire(f->g, side, side, GPU_RG16F);
        if (!gpu_failed(f->g)) {
            draw_slab(f, &d, higher, level, slab);
            blur_slab(f, slab, spread);
        }
        gpu_target_release(f->g, slab);
        gpu_target_release(f->g, higher);
        higher = spread;
    }
    gpu_target_release(f->g, d.from_below);
    gpu_target_release(f->g, d.from_above);
    watch_stop(&f->profile, w, "scene", "ground");
    return higher;
}

mat4 ground_map_from_eye(const frame *f, const view_camera *below)
{
    const double origin[3] = {0, 0, 0};
    mat4         world = mat4_identity();
    view_world_from_eye(&f->camera, origin, world.m);
    mat4 clip = mat4_multiply(&below->view, &world);
    clip = mat4_multiply(&below->projection, &clip);
    for (int column = 0; column < 4; column++)
        for (int row = 0; row < 4; row++) {
            double last = column == 3 ? 1 : 0;
            clip.m[4 * column + row] = row == 3 ? last : 0.5 * clip.m[4 * column + row] + 0.5 * last;
        }
    return clip;
}

/* From pixels, through their rays, to the map; the third number is what to divide by, above 0 where the ray meets the
 * ground, whose plane is given in eye space. */
static void find_map_from_pixel(const frame *f, const mat4 *map, const double plane[4], float out[9])
{
    const double *p = f->camera.projection.m, *m = map->m;
    bool          meets = f->camera.orthographic ? plane[2] > 0 : plane[3] < 0;
    for (int column = 0; column < 3; column++) {
        double right = column == 0   ? 2.0 / f->width
                       : column == 2 ? -1
                                     : 0,
               up = column == 1   ? 2.0 / f->height
                    : column == 2 ? -1
                                  : 0,
               last = column == 2;
        double at[3] = {right / p[0], up / p[5], f->camera.orthographic ? 0 : -last}, divisor = last;
        double off = plane[0] * at[0] + plane[1] * at[1] + plane[2] * at[2];
        if (f->camera.orthographic)
            at[2] = (plane[3] * last - off) / fmax(plane[2], 1e-6);
        else {
            divisor = -off;
            for (int k = 0; k < 3; k++)
                at[k] *= -plane[3];
        }
        for (int row = 0; row < 2; row++)
            out[3 * column + row] =
                (float)(m[row] * at[0] + m[4 + row] * at[1] + m[8 + row] * at[2] + m[12 + row] * divisor);
        out[3 * column + 2] = (float)(meets ? divisor : -last);
    }
}

void ground_plane_set(frame *f, double out[4])
{
    const ground_plane *ground = &f->ground_plane;
    const double       *m = f->camera.view.m;
    out[3] = ground->level;
    for (int k = 0; k < 3; k++) {
        out[k] = m[4 * ground->up + k];
        out[3] += out[k] * m[12 + k];
    }
    gpu_set_vec4(f->g, "u_ground_plane", (float[]){(float)out[0], (float)out[1], (float)out[2], (float)out[3]});
}

/* Uniforms of light/ground.glsl. */
static void ground_set(frame *f, const view_camera *below, gpu_texture *map)
{
    const scene_values *v = values_of(f);
    double              plane[4];
    ground_plane_set(f, plane);
    gpu_set_vec2(f->g, "u_ground_tone", v->ground_strength, v->ground_flat ? 1 : 0);
    gpu_set_texture(f->g, "t_ground_map", map, true);
    mat4  position = ground_map_from_eye(f, below);
    float matrix[16], from_pixel[9];
    for (int k = 0; k < 16; k++)
        matrix[k] = (float)position.m[k];
    gpu_set_mat4(f->g, "u_ground_from_eye", matrix);
    find_map_from_pixel(f, &position, plane, from_pixel);
    gpu_set_mat3(f->g, "u_ground_from_pixel", from_pixel);
}

/* Where something of it can be seen: so many reaches around the model. */
static void find_pixels(const frame *f, const ground_square *s, double margin, int out[4])
{
    float low[3] = {0}, high[3] = {0};
    for (int k = 0; k < 2; k++) {
        double range[2];
        ground_range(f->ground_plane.box, s->axes[k], range);
        low[s->axes[k]] = (float)(range[0] - margin * f->ground_plane.reach);
        high[s->axes[k]] = (float)(range[1] + margin * f->ground_plane.reach);
    }
    low[f->ground_plane.up] = high[f->ground_plane.up] = (float)f->ground_plane.level;
    camera_pixels(&f->camera, (box3){{low[0], low[1], low[2]}, {high[0], high[1], high[2]}}, f->width, f->height, 2,
                  out);
}

static void lay_tone(frame *f, figure_state *s, const view_camera *below, gpu_texture *map)
{
    text         prelude = {0};
    const colour c = values_of(f)->ground_colour;
    gpu_program *p = program_of(f, GPU_FLOOR, "gpu/screen.vert", "light/ground_tone.frag", &prelude);
    gpu_pass     pass = {.colours = {f->page}, .colour_count = 1};
    if (!p || gpu_failed(f->g))
        return;
    memcpy(pass.scissor, s->pixels, sizeof pass.scissor);
    gpu_pass_begin(f->g, &pass);
    gpu_use(f->g, p, (gpu_state){.blend = GPU_BLEND_OVER});
    frame_set_common(f, s);
    ground_set(f, below, map);
    gpu_set_vec4(f->g, "u_ground_colour", (float[]){c.r, c.g, c.b, c.a});
    gpu_draw_screen(f->g);
}

bool ground_buffers(frame *f, figure_state *s, const char *shader, text *prelude)
{
    static const target filled[] = {TARGET_NORMAL_DEPTH, TARGET_ID, TARGET_ALBEDO};
    gpu_pass            pass = {.colour_count = 3, .clear = true};
    for (int k = 0; k < 3; k++) {
        pass.colours[k] = s->targets[filled[k]] = frame_acquire(f, filled[k]);
        target_empty(&target_rows[filled[k]], s->far, pass.clear_values[k]);
    }
    gpu_program *p = program_of(f, GPU_FLOOR, "gpu/screen.vert", shader, prelude);
    if (!p || gpu_failed(f->g))
        return false;
    memcpy(pass.scissor, s->pixels, sizeof pass.scissor);
    memcpy(pass.clear_box, s->around, sizeof pass.clear_box);
    gpu_pass_begin(f->g, &pass);
    gpu_use(f->g, p, (gpu_state){0});
    frame_set_common(f, s);
    gpu_set_uint(f->g, "u_ground_part", (unsigned)f->up->part_count + 1); /* stage/part_frames.c has a row for it */
    return true;
}

static void fill_buffers(frame *f, figure_state *s, const view_camera *below, gpu_texture *map)
{
    text prelude = {0};
    if (!ground_buffers(f, s, "light/ground_buffer.frag", &prelude))
        return;
    ground_set(f, below, map);
    gpu_draw_screen(f->g);
}

static void lay_shaded(frame *f, const figure_state *s, bool over)
{
    text         prelude = {0};
    gpu_program *p = program_of(f, GPU_FLOOR, "gpu/screen.vert", "light/ground_lay.frag", &prelude);
    gpu_pass     pass = {.colours = {f->page}, .colour_count = 1};
    if (!p || gpu_failed(f->g))
        return;
    memcpy(pass.scissor, s->pixels, sizeof pass.scissor);
    gpu_pass_begin(f->g, &pass);
    gpu_use(f->g, p, (gpu_state){.blend = over ? GPU_BLEND_OVER : GPU_BLEND_NONE});
    gpu_set_texture(f->g, "t_shade", s->targets[TARGET_SHADE], false);
    gpu_set_texture(f->g, "t_id", s->targets[TARGET_ID], false);
    gpu_draw_screen(f->g);
}

void ground_shade(frame *f, figure_state *s, bool over)
{
    if (!gpu_failed(f->g))
        raster_shade_deferred(f, s);
    if (!gpu_failed(f->g))
        lay_shaded(f, s, over);
    for (int i = 0; i < TARGET_COUNT; i++)
        gpu_target_release(f->g, s->targets[i]);
}

static void draw_shaded(frame *f, figure_state *s, const view_camera *below, gpu_texture *map)
{
    fill_buffers(f, s, below, map);
    s->geometry = s->targets[TARGET_NORMAL_DEPTH];
    if (!gpu_failed(f->g))
        passes_prepare(f, s);
    ground_shade(f, s, false);
}

bool ground_is_drawn_by(const frame *f, const figure *fig)
{
    const technique_use *surface = rule_use(fig->rule, KIND_SURFACE);
    const surface_row   *row = surface ? surface->technique->surface : NULL;
    return row && row->on_ground && !fig->layered && !values_of(f)->ground_flat && !shades_with_geometry(surface) &&
           row->on_ground(surface->values, f->ground);
}

void ground_draw(frame *f)
{
    if (!f->ground_plane.there || f->maps || f->plan->figure_count == 0)
        return;
    if (values_of(f)->ground == GROUND_CAST) {
        ground_cast(f);
        return;
    }
    if (values_of(f)->ground_strength <= 0)
        return;
    figure        fig = f->plan->figures[0];
    ground_square square = square_of(&f->ground_plane);
    view_camera   below = ground_camera(&f->ground_plane, &square, true);
    figure_state  s = {.figure = &fig, .near = f->camera.near, .far = f->camera.far, .ground = true};
    bool          drawn = ground_is_drawn_by(f, &fig);
    find_pixels(f, &square, drawn ? DRAWN_MARGIN : MARGIN, s.pixels);
    window_clip(f, WINDOW_MARGIN, s.pixels);
    memcpy(s.around, s.pixels, sizeof s.around);
    if (s.pixels[2] <= 0 || s.pixels[3] <= 0)
        return;
    gpu_texture *map = draw_map(f, &square, &below);
    stopwatch    w = watch_start(&f->profile);
    if (map && !gpu_failed(f->g)) {
        if (drawn)
            draw_shaded(f, &s, &below, map);
        else
            lay_tone(f, &s, &below, map);
    }
    gpu_target_release(f->g, map);
    watch_stop(&f->profile, w, "scene", "ground on the page");
}
