#include "draw/into.h"

#include <stdio.h>

#include "draw/drawing.h"
#include "base/memory.h"
#include "base/text.h"
#include "draw/exposure.h"

/* The host's depth of what has a depth on the page: a factor, a summand, and what is farthest. Both projections put
 * depth in the same way (as its inverse, or as it is), so that one is a linear function of the other. */
typedef struct depth_line {
    double factor, summand, farthest;
    bool   reversed; /* nearer is more */
} depth_line;

/* From −1 … 1 of both, which m[10] and m[14] of the projections give; `h` is the host's. */
static depth_line line_of(const view_camera *own, const double h[16], const double range[2])
{
    const double *m = own->projection.m;
    double        by = own->orthographic ? h[15] : -h[11], slope = h[14] / by / m[14], shift;
    if (own->orthographic) {
        slope = h[10] / by / m[10];
        shift = h[14] / by - slope * m[14];
    } else {
        shift = slope * m[10] - h[10] / by;
    }
    /* ndc of the host = slope · own ndc + shift; own ndc = 2 · own depth − 1 */
    double     half = (range[1] - range[0]) / 2;
    depth_line out = {.factor = 2 * half * slope};
    out.summand = range[0] + half * (shift - slope + 1);
    out.reversed = out.factor < 0;
    out.farthest = slope < 0 ? range[0] : range[1];
    return out;
}

/* The session's finished picture, onto the target. */
static void put_on_target(session *s, const gpu_host_target *host, const lmn_target *target,
                          const double projection[16])
{
    gpu       *g = s->renderer->g;
    frame     *f = &s->frame;
    bool       deep = target->depth == LMN_TARGET_DEPTH_TEST_AND_WRITE;
    depth_line line = {.factor = 1};
    text       prelude = {0};
    const int  box[4] = {target->x, target->y, target->width, target->height};
    text_append(&prelude, "%s%s%s%s", deep ? "#define WITH_DEPTH\n" : "", f->seen_depth ? "#define HAS_SEEN\n" : "",
                f->moved_depth ? "#define HAS_MOVED\n" : "", host->encodes ? "#define DECODES\n" : "");
    char *defines = text_take(&prelude);
    if (!defines)
        gpu_fail(g, LMN_MEMORY, "out of memory");
    if (deep)
        line = line_of(&f->camera, projection, host->range);
    gpu_program *p = defines ? gpu_program_of(g, GPU_FLOOR, "gpu/screen.vert", "draw/into.frag", defines) : NULL;
    mem_free(defines);
    if (!p || gpu_failed(g))
        return;
    gpu_host_begin(g, host, box);
    gpu_use(g, p,
            (gpu_state){.depth_test = deep,
                        .depth_write = deep,
                        .depth_compare = line.reversed ? GPU_GREATER_EQUAL : GPU_LESS_EQUAL,
                        .blend = GPU_BLEND_OVER});
    gpu_set_texture(g, "t_out", s->out, false);
    gpu_set_ivec2(g, "u_origin", target->x, target->y);
    if (deep) {
        gpu_set_texture(g, "t_depth", f->kept_depth, false);
        if (f->seen_depth)
            gpu_set_texture(g, "t_seen", f->seen_depth, false);
        if (f->moved_depth)
            gpu_set_texture(g, "t_moved", f->moved_depth, false);
        gpu_set_int(g, "u_samples", f->samples);
        gpu_set_int(g, "u_beside", f->seen_depth && f->ground.a <= 0 ? f->seen_reach : 0);
        gpu_set_vec3(g, "u_depth_line", (float[]){(float)line.factor, (float)line.summand, (float)line.farthest});
    }
    gpu_draw_screen(g);
    gpu_host_end(g);
}

/* Everything has its picture in s->out. */
static lmn_status drawn(session *s, void *user, lmn_error *error)
{
    (void)user;
    return gpu_check(s->renderer->g, error);
}

static lmn_status draw_session(session *s, const lmn_look *look, const draw_options *options, lmn_error *error)
{
    exposure   e;
    lmn_status status = exposure_find(&e, &s->plan, error);
    if (status == LMN_OK && e.technique) {
        status = exposure_draw(&e, s, look, options, drawn, NULL, error);
    } else if (status == LMN_OK) {
        frame_draw(&s->frame, s->out);
        status = gpu_check(s->renderer->g, error);
    }
    exposure_release(&e);
    return status;
}

static lmn_status draw_into(lmn_renderer *r, const lmn_scene *scene, const lmn_look *look, const draw_options *options,
                            const lmn_target *target, lmn_error *error)
{
    gpu_host_target host;
    session         s = {.renderer = NULL};
    warnings        said = {0};
    lmn_draw_desc   desc = *options->desc;
    draw_options    own = *options;
    lmn_status      status = gpu_host_open(r->g, target->framebuffer, options->keeps_depth, &host, error);
    own.desc = &desc;
    if (status == LMN_OK && host.zero_to_one && desc.matrices_given)
        for (int k = 0; k < 4; k++) /* the same with depths from −1 on */
            desc.projection_matrix[4 * k + 2] =
                2 * desc.projection_matrix[4 * k + 2] - desc.projection_matrix[4 * k + 3];
    if (status == LMN_OK)
        status = session_open(&s, r, scene, look, &own, &said, error);
    if (status == LMN_OK)
        status = drawing_refuse(&s, scene, look, &desc, &said, error);
    if (status == LMN_OK)
        status = draw_session(&s, look, &own, error);
    if (status == LMN_OK) {
        put_on_target(&s, &host, target, desc.projection_matrix);
        status = gpu_check(r->g, error);
    }
    session_close(&s);
    warnings_release(&said);
    return status;
}

lmn_status renderer_draw_into(lmn_renderer *r, const lmn_scene *scene, const lmn_look *look, const lmn_draw_desc *desc,
                              const lmn_target *target, lmn_error *error)
{
    draw_options options = {.desc = desc, .keeps_depth = target->depth == LMN_TARGET_DEPTH_TEST_AND_WRITE};
    lmn_status   status = gpu_enter(r->g, error);
    if (status != LMN_OK)
        return status;
    return gpu_leave(r->g, draw_into(r, scene, look, &options, target, error), error);
}
