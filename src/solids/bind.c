/* What programs that draw operands, or surfaces of solids, get. */
#include "solids/solids_private.h"

void solids_set_depth(const solid_view *v, const solid_layers *s)
{
    const double *m = v->camera->projection.m;
    gpu_set_vec4(v->g, "u_solid_depth", (float[]){(float)m[10], (float)m[14], (float)m[11], (float)m[15]});
    gpu_set_float(v->g, "u_solid_near", (float)s->near);
}

void solids_set_operands(const solid_view *v, const solid_layers *s, const draw_item *item)
{
    view_set_projection(v->g, v->camera);
    const double *m = v->camera->projection.m;
    gpu_set_vec2(v->g, "u_size", (float)v->width, (float)v->height);
    gpu_set_float(v->g, "u_perspective", v->camera->orthographic ? 0 : 1);
    gpu_set_vec2(v->g, "u_unproject", (float)(1 / m[0]), (float)(1 / m[5]));
    solids_set_depth(v, s);
    gpu_set_texture(v->g, "t_planes", s->planes, false);
    view_set_transform(v->g, v->camera, &item->world);
    gpu_set_float(v->g, "u_solid_step", 1 + (float)((item - v->up->items) % 16) * 2.4e-7f);
    gpu_set_uint(v->g, "u_first_operand", item->first_operand);
    gpu_set_uint(v->g, "u_first_plane", s->first_planes[item - v->up->items]);
}
