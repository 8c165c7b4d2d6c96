/* What programs that ask for light get. */
#include "frame/frame_private.h"

#include <math.h>
#include <string.h>

#include "light/light.h"
#include "plan/lights.h"

static const scene_values *scene_of(const frame *f)
{
    return f->plan->look->wide[KIND_SCENE].values;
}

static light_list list_lights(const frame *f)
{
    return lights_list(
        &(light_conditions){f->plan->look, f->up->pose, &f->camera.view, f->mirror ? f->clip_plane : NULL});
}

bool shadow_is_soft(const frame *f)
{
    return f->shadow && scene_of(f)->shadows && scene_of(f)->shadow_softness > 0;
}

static void visibility_declare(text *prelude, const frame *f)
{
    if (!f->visibility || f->mirror) /* a mirror sees what the page does not */
        return;
    text_append(prelude, "%s%s", shadow_is_soft(f) ? "#define HAS_SOFT_SHADOW\n" : "",
                scene_of(f)->occlusion > 0 ? "#define HAS_OCCLUSION\n" : "");
}

void lights_declare(text *prelude, const frame *f)
{
    light_list l = list_lights(f);
    bool       shadows = f->shadow && scene_of(f)->shadows;
    text_append(prelude, "#define LIGHT_COUNT %d\n#define RIM_LIGHT %d\n%s", l.count, l.rim,
                shadows ? "#define LIT_WITH_SHADOW\n" : "");
    if (shadows)
        target_declare(prelude, &target_rows[TARGET_SHADOW]);
    visibility_declare(prelude, f);
}

/* From eye space of this frame to the shadow map. */
void shadow_set(frame *f)
{
    /* World from eye: the view is a rotation and a shift. */
    mat4          world = mat4_identity();
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
    gpu_set_float(f->g, "u_shadow_pixel",
                  (float)(side / (f->camera.projection.m[5] * f->shadow_camera.half_height * f->height)));
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
