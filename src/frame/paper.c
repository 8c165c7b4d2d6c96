/* The paper under the drawing: how the model stands to the viewer, and where that puts the paper. */
#include "frame/frame_private.h"

#include <math.h>
#include <string.h>

#include "finish/finish.h"

/* A ball's points move by their depth when it turns; half of those that are seen are deeper than this fraction of its
 * radius. */
static const double BALL_FRACTION = 0.7071;

/* The middle of the model never counts as nearer than this fraction of its size: there is no page at the eye. */
static const double NEAREST_FRACTION = 0.1;

static const technique_use *sheet_of(const frame *f)
{
    return &f->plan->look->wide[KIND_FINISH];
}

static bool has_paper(const frame *f)
{
    return f->sheet->textures[0] != NULL;
}

static double dot3(const double a[3], const double b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/* Sets azimuth, elevation and roll from the direction to the viewer. The front is where the azimuth is 0. */
static void find_angles(sheet_view *out, const frame *f, double to_viewer[3])
{
    const double *m = f->camera.view.m;
    double        right[3] = {m[0], m[4], m[8]}, up[3] = {m[1], m[5], m[9]}, length = sqrt(dot3(to_viewer, to_viewer));
    bool          z_up = f->plan->scene->up == 'z';
    double        upright[3] = {0, !z_up, z_up}, front[3] = {0, -(double)z_up, !z_up}, side[3] = {1, 0, 0};
    double        height = dot3(to_viewer, upright) / length, aside = dot3(to_viewer, side) / length,
           ahead = dot3(to_viewer, front) / length;
    out->elevation = asin(fmin(fmax(height, -1), 1));
    out->azimuth = 0;
    if (hypot(aside, ahead) > 1e-6) {
        out->azimuth = atan2(aside, ahead);
    } else { /* from above the back is upright, from below the front */
        for (int k = 0; k < 3; k++)
            upright[k] = height > 0 ? -front[k] : front[k];
    }
    out->roll = atan2(-dot3(upright, right), dot3(upright, up));
}

static sheet_view view_of(const frame *f)
{
    const view_camera *c = &f->camera;
    const double      *m = c->view.m;
    box3               box = f->plan->box;
    double             width = (double)f->width / f->samples, height = (double)f->height / f->samples;
    double middle[3] = {(box.min.x + box.max.x) / 2, (box.min.y + box.max.y) / 2, (box.min.z + box.max.z) / 2};
    double half[3] = {(box.max.x - box.min.x) / 2, (box.max.y - box.min.y) / 2, (box.max.z - box.min.z) / 2};
    double size = sqrt(dot3(half, half)), eye[3], to_viewer[3];
    if (!(size > 0))
        size = 1;
    for (int k = 0; k < 3; k++) {
        eye[k] = m[k] * middle[0] + m[4 + k] * middle[1] + m[8 + k] * middle[2] + m[12 + k];
        to_viewer[k] = c->orthographic ? m[4 * k + 2] : c->eye[k] - middle[k];
    }
    for (int k = 0; !(dot3(to_viewer, to_viewer) > 1e-12 * size * size) && k < 3; k++)
        to_viewer[k] = m[4 * k + 2];
    double     shown = c->orthographic
                           ? c->half_height
                           : tan(c->fov_y / 2) * fmax(-eye[2], NEAREST_FRACTION * size); /* half the page's height, units */
    sheet_view out = {.scale = height / 2 / shown,
                      .fitted = fmin(width, height) / 2 / size,
                      .radius = BALL_FRACTION * cbrt(half[0] * half[1] * half[2])};
    out.anchor[0] = width / 2 + eye[0] * out.scale;
    out.anchor[1] = height / 2 + eye[1] * out.scale;
    find_angles(&out, f, to_viewer);
    return out;
}

void paper_declare(text *prelude, const frame *f)
{
    if (!has_paper(f))
        return;
    uniforms_declare(prelude, use_own_set(KIND_FINISH, sheet_of(f)));
    used_textures_declare(prelude, sheet_of(f), f->sheet);
}

static void set_position(gpu *g, const char *name, sheet_position position)
{
    gpu_set_vec4(g, name, (float[]){position.a, position.b, position.u, position.v});
}

/* The texture's level at which a texel is as large as a pixel: the same all over the page, so that nobody has to
 * find it there. */
static float level_of(sheet_position position, float side)
{
    return (float)fmax(log2(fmax(hypot((double)position.a, (double)position.b) * (double)side, 1e-30)), 0);
}

void frame_ground(const frame *f, float out[4])
{
    const colour c = f->ground;
    memcpy(out, (float[]){c.r * c.a, c.g * c.a, c.b * c.a, c.a}, 4 * sizeof *out);
}

void paper_set(frame *f)
{
    if (!has_paper(f))
        return;
    const technique_use *sheet = sheet_of(f);
    sheet_view           view = view_of(f);
    sheet_values         seen = *(const sheet_values *)sheet->values;
    seen.grain_size /= (float)f->samples; /* samples are averaged before they meet the paper */
    sheet_lie lie = sheet_lay(&seen, &view);
    float     ground[4], less[4], more[4];
    frame_ground(f, ground);
    uniforms_set(f->g, use_own_set(KIND_FINISH, sheet));
    used_textures_set(f->g, sheet, f->sheet);
    sheet_range(sheet->values, ground, less, more);
    gpu_set_vec4(f->g, "u_sheet", ground);
    gpu_set_vec4(f->g, "u_range_below", less);
    gpu_set_vec4(f->g, "u_range_above", more);
    set_position(f->g, "u_paper_position", lie.octaves[0]);
    set_position(f->g, "u_paper_finer", lie.octaves[1]);
    set_position(f->g, "u_paper_pieces", lie.pieces);
    const float          side = f->sheet->facts[0][0];
    const sheet_position positions[3] = {lie.octaves[0], lie.octaves[1], lie.pieces};
    float                levels[3];
    for (int k = 0; k < 3; k++)
        levels[k] = level_of(positions[k], side);
    gpu_set_vec3(f->g, "u_paper_levels", levels);
    gpu_set_vec4(f->g, "u_paper_fractions", (float[]){lie.finer, lie.begun, lie.begin[0], lie.begin[1]});
}
