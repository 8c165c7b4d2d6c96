/* The lights of a frame: the studio's two or the file's own. */
#include "draw/frame_private.h"

#include <math.h>
#include <string.h>

#include "light/light.h"

static const scene_values *scene_of(const frame *f)
{
    return f->plan->look->wide[KIND_SCENE].values;
}

static void add_light(float positions[][4], float colours[][4], int *count, const double direction[3], double w, const float rgb[3],
                      float strength)
{
    if (*count >= LIGHTS_MAX)
        return;
    double length = w > 0 ? 1 : sqrt(direction[0] * direction[0] + direction[1] * direction[1] + direction[2] * direction[2]);
    for (int k = 0; k < 3; k++) {
        positions[*count][k] = (float)(direction[k] / (length > 0 ? length : 1));
        colours[*count][k] = rgb[k] * strength;
    }
    positions[*count][3] = (float)w;
    colours[*count][3] = 1;
    ++*count;
}

static void add_file_lights(const frame *f, float positions[][4], float colours[][4], int *count, float scale)
{
    const lmn_scene *scene = f->plan->scene;
    for (size_t i = 0; i < scene->node_count; i++) {
        if (scene->nodes[i].light < 0)
            continue;
        const light *l = &scene->lights[scene->nodes[i].light];
        mat4 eye = mat4_multiply(&f->camera.view, &f->up->worlds[i]);
        /* Lights shine along their node's −Z. Physical units are not used: every light counts as fully bright. */
        double back[3] = {eye.m[8], eye.m[9], eye.m[10]}, place[3] = {eye.m[12], eye.m[13], eye.m[14]};
        bool placed = l->type != LIGHT_DIRECTIONAL;
        add_light(positions, colours, count, placed ? place : back, placed ? 1 : 0, l->colour, scale);
    }
}

typedef struct light_list {
    float positions[LIGHTS_MAX][4], colours[LIGHTS_MAX][4];
    int   count; /* at least 1 */
} light_list;

static light_list list_lights(const frame *f)
{
    light_list l = {.count = 0};
    const scene_values *v = scene_of(f);
    if (v->lights == LIGHTS_FILE)
        add_file_lights(f, l.positions, l.colours, &l.count, v->light_scale);
    if (l.count > 0)
        return l;
    static const float white[3] = {1, 1, 1};
    double key[3] = {v->light_direction.x, v->light_direction.y, v->light_direction.z};
    if (key[0] == 0 && key[1] == 0 && key[2] == 0)
        key[2] = 1;
    /* The light goes with the viewer, but what a mirror shows is lit as the scene itself is. */
    double along = 0;
    for (int k = 0; k < 3 && f->mirror; k++)
        along += key[k] * (double)f->clip_plane[k];
    for (int k = 0; k < 3 && f->mirror; k++)
        key[k] -= 2 * along * (double)f->clip_plane[k];
    double fill[3] = {-key[0], -0.3 * key[1], fabs(key[2]) + 0.2};
    add_light(l.positions, l.colours, &l.count, key, 0, white, v->light_scale);
    if (v->fill > 0)
        add_light(l.positions, l.colours, &l.count, fill, 0, white, v->light_scale * v->fill);
    return l;
}

bool shadow_is_soft(const frame *f)
{
    return f->shadow && scene_of(f)->shadows && scene_of(f)->shadow_softness > 0;
}

static void visibility_declare(text *prelude, const frame *f)
{
    if (!f->visibility || f->mirror) /* a mirror sees what the page does not */
        return;
    text_append(prelude, "%s%s", shadow_is_soft(f) ? "#define HAS_SOFT_SHADOW\n" : "", scene_of(f)->occlusion > 0 ? "#define HAS_OCCLUSION\n" : "");
}

void lights_declare(text *prelude, const frame *f)
{
    light_list l = list_lights(f);
    bool shadows = f->shadow && scene_of(f)->shadows;
    text_append(prelude, "#define LIGHT_COUNT %d\n%s", l.count, shadows ? "#define LIT_WITH_SHADOW\n" : "");
    if (shadows)
        target_declare(prelude, &target_rows[TARGET_SHADOW]);
    visibility_declare(prelude, f);
}

/* From eye space of this frame to the shadow map. */
void shadow_set(frame *f)
{
    /* World from eye: the view is a rotation and a shift. */
    mat4 world = mat4_identity();
    const double *view = f->camera.view.m;
    for (int row = 0; row < 3; row++) {
        world.m[12 + row] = 0;
        for (int k = 0; k < 3; k++) {
            world.m[4 * k + row] = view[4 * row + k];
            world.m[12 + row] -= view[4 * row + k] * view[12 + k];
        }
    }
    mat4 clip = mat4_multiply(&f->shadow_camera.view, &world);
    clip = mat4_multiply(&f->shadow_camera.projection, &clip);
    float matrix[16];
    for (int column = 0; column < 4; column++)
        for (int row = 0; row < 4; row++) {
            double last = column == 3 ? 1 : 0; /* w, for parallel rays */
            matrix[4 * column + row] = (float)(row == 3 ? last : 0.5 * clip.m[4 * column + row] + 0.5 * last);
        }
    gpu_set_mat4(f->g, "u_shadow_from_eye", matrix);
    double side = gpu_texture_width(f->shadow);
    gpu_set_vec2(f->g, "u_shadow_texel", (float)(1 / side), (float)(2 * f->shadow_camera.half_height / side));
    gpu_set_texture(f->g, "t_shadow", f->shadow, false);
    double towards[3], depth = f->shadow_camera.far - f->shadow_camera.near;
    lights_first_direction(f, towards);
    gpu_set_vec3(f->g, "u_shadow_light", (float[]){(float)towards[0], (float)towards[1], (float)towards[2]});
    gpu_set_float(f->g, "u_shadow_depth", (float)depth);
    double nearest = INFINITY, farthest = -INFINITY;
    camera_depth_range(&f->shadow_camera, f->plan->box, &nearest, &farthest);
    gpu_set_float(f->g, "u_shadow_nearest", (float)((nearest - f->shadow_camera.near) / depth));
    double half = (double)scene_of(f)->shadow_softness * (3.14159265358979 / 360);
    gpu_set_float(f->g, "u_cone", (float)(tan(half) * depth / (2 * f->shadow_camera.half_height)));
}

void lights_set(frame *f)
{
    light_list l = list_lights(f);
    gpu_set_vec4_array(f->g, "u_light_position", l.positions[0], l.count);
    gpu_set_vec4_array(f->g, "u_light_colour", l.colours[0], l.count);
}

int lights_list(const frame *f, float positions[][4], float colours[][4])
{
    light_list l = list_lights(f);
    memcpy(positions, l.positions, (size_t)l.count * sizeof *positions);
    memcpy(colours, l.colours, (size_t)l.count * sizeof *colours);
    return l.count;
}

bool lights_first_direction(const frame *f, double out[3])
{
    light_list l = list_lights(f);
    for (int k = 0; k < 3; k++)
        out[k] = (double)l.positions[0][k];
    return l.positions[0][3] < 0.5f;
}

void visibility_set(frame *f)
{
    if (!gpu_has_uniform(f->g, "t_visibility") || !f->visibility)
        return;
    gpu_set_texture(f->g, "t_visibility", f->visibility, false);
    gpu_set_float(f->g, "u_occlusion", scene_of(f)->occlusion);
    gpu_set_vec2(f->g, "u_pixel", (float)(2 / (f->camera.projection.m[0] * gpu_texture_width(f->visibility))),
                 (float)(2 / (f->camera.projection.m[5] * gpu_texture_height(f->visibility))));
}
