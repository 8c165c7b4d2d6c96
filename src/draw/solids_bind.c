/* What programs that draw operands, or surfaces of solids, get. */
#include "draw/frame_private.h"

void solids_set_depth(frame *f, const solid_layers *s)
{
    const double *m = f->camera.projection.m;
    gpu_set_vec4(f->g, "u_solid_depth", (float[]){(float)m[10], (float)m[14], (float)m[11], (float)m[15]});
    gpu_set_float(f->g, "u_solid_near", (float)s->near);
}

void solids_set_operands(frame *f, const solid_layers *s, const draw_item *item)
{
    frame_set_projection(f);
    const double *m = f->camera.projection.m;
    gpu_set_vec2(f->g, "u_size", (float)f->width, (float)f->height);
    gpu_set_float(f->g, "u_perspective", f->camera.orthographic ? 0 : 1);
    gpu_set_vec2(f->g, "u_unproject", (float)(1 / m[0]), (float)(1 / m[5]));
    solids_set_depth(f, s);
    gpu_set_texture(f->g, "t_planes", s->planes, false);
    frame_set_transform(f, &item->world);
    gpu_set_float(f->g, "u_solid_step", 1 + (float)((item - f->up->items) % 16) * 2.4e-7f);
    gpu_set_uint(f->g, "u_first_operand", item->first_operand);
    gpu_set_uint(f->g, "u_first_plane", s->first_planes[item - f->up->items]);
}
