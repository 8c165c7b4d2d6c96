#include "boxes.h"

#include <math.h>

#include "moving_scene.h"

static int add_box(moving_scene *m, const moving_box *b)
{
    const double *at = b->middle, times[] = {0, 1}, half_turn = b->turn * (3.14159265358979323846 / 360);
    double        way[6], turned[8] = {0, 0, sin(half_turn), cos(half_turn), 0, 0, sin(half_turn), cos(half_turn)};
    int           node = b->open ? moving_scene_plate(m, at[0], at[1], at[2], b->half, b->colour)
                                 : moving_scene_box(m, at[0], at[1], at[2], b->half, b->colour);
    for (int k = 0; k < 3; k++) {
        way[k] = at[k] - b->moved[k];
        way[3 + k] = at[k];
    }
    moving_scene_keys(m, node, "translation", 2, times, way);
    if (b->turn != 0)
        moving_scene_keys(m, node, "rotation", 2, times, turned);
    moving_scene_name(m, node, b->name);
    return node;
}

void boxes_write(const char *path, const moving_box *boxes, int count)
{
    moving_scene m;
    moving_scene_begin(&m);
    for (int i = 0; i < count; i++) {
        int node = add_box(&m, &boxes[i]);
        if (boxes[i].parent >= 0)
            moving_scene_put_in(&m, node, boxes[i].parent);
    }
    moving_scene_write(&m, path);
}

void boxes_view(lmn_draw_desc *desc, int side)
{
    desc->width = desc->height = side;
    desc->dpi = 96; /* lengths in px are pixels */
    desc->eye_given = true;
    desc->eye[0] = desc->eye[1] = 0;
    desc->eye[2] = 1000;
    desc->target[0] = desc->target[1] = desc->target[2] = 0;
    desc->up[0] = desc->up[2] = 0;
    desc->up[1] = 1;
    desc->fov_deg = 2 * atan(0.01) * (180 / 3.14159265358979323846);
}
