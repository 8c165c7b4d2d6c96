/* Mirrors: the scene once more as a plane shows it. Nienhaus 2005, section 4.6; row E14. */
#include "frame/frame_private.h"

#include <math.h>

#include "base/memory.h"

/* Triangles added up: their normals times their areas, and their middles times their areas. */
typedef struct plane_sum {
    double normal[3], centre[3], area;
} plane_sum;

static void add_triangles(plane_sum *sum, const primitive *p, const vec3 *positions, const mat4 *to_eye)
{
    for (uint32_t t = 0; t + 2 < p->index_count; t += 3) {
        vec3 v[3];
        for (int k = 0; k < 3; k++)
            v[k] = mat4_transform_point(to_eye, positions[p->indices[t + (uint32_t)k]]);
        double a[3] = {v[1].x - v[0].x, v[1].y - v[0].y, v[1].z - v[0].z};
        double b[3] = {v[2].x - v[0].x, v[2].y - v[0].y, v[2].z - v[0].z};
        double c[3] = {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
        double size = sqrt(c[0] * c[0] + c[1] * c[1] + c[2] * c[2]);
        double all[3] = {(double)v[0].x + v[1].x + v[2].x, (double)v[0].y + v[1].y + v[2].y,
                         (double)v[0].z + v[1].z + v[2].z};
        for (int k = 0; k < 3; k++) {
            sum->normal[k] += c[k];
            sum->centre[k] += size * all[k] / 3;
        }
        sum->area += size;
    }
}

/* Of a mesh as it is posed. */
static void add_item(plane_sum *sum, const frame *f, const draw_item *item)
{
    const lmn_scene *scene = f->plan->scene;
    const node      *n = &scene->nodes[scene->parts[item->part_index].node];
    const primitive *p = &scene->meshes[n->mesh].primitives[item->surface_id - 1];
    const part_pose *pose = &f->up->pose->parts[item->part_index];
    mat4             eye = mat4_multiply(&f->camera.view, &item->world);
    if (!pose_deforms(pose, p)) {
        add_triangles(sum, p, p->positions, &eye);
        return;
    }
    vec3 *moved = mem_alloc(p->vertex_count * sizeof *moved);
    if (moved) {
        pose_vertices(pose, p, NULL, NULL, p->vertex_count, moved, NULL);
        add_triangles(sum, p, moved, &eye);
    } else {
        gpu_fail(f->g, LMN_MEMORY, "out of memory");
    }
    mem_free(moved);
}

/* The plane of a figure's parts in eye space: area-weighted normal through the centre. False when there is no area. */
static bool mirror_plane(const frame *f, const figure *fig, double plane[4])
{
    plane_sum sum = {.area = 0};
    for (size_t i = 0; i < f->up->item_count; i++) {
        const draw_item *item = &f->up->items[i];
        /* A cut face is its part's inside, and a solid has no triangles. */
        if (!item->is_cut && !item->is_solid && fig->designated[item->part_index])
            add_item(&sum, f, item);
    }
    double length = sqrt(sum.normal[0] * sum.normal[0] + sum.normal[1] * sum.normal[1] + sum.normal[2] * sum.normal[2]);
    if (!(length > 0) || !(sum.area > 0))
        return false;
    plane[3] = 0;
    for (int k = 0; k < 3; k++) {
        plane[k] = sum.normal[k] / length;
        plane[3] -= plane[k] * sum.centre[k] / sum.area;
    }
    return true;
}

bool mirror_prepare(const frame *f, const figure *mirror, frame *inner)
{
    double p[4];
    if (!mirror_plane(f, mirror, p))
        return false;
    /* The viewer is on one side of the plane; only what is on his side is reflected. */
    double side = f->camera.orthographic ? p[2] : p[3];
    if (side < 0)
        for (int k = 0; k < 4; k++)
            p[k] = -p[k];
    mat4 reflect = mat4_identity();
    for (int column = 0; column < 3; column++)
        for (int row = 0; row < 3; row++)
            reflect.m[4 * column + row] -= 2 * p[column] * p[row];
    for (int row = 0; row < 3; row++)
        reflect.m[12 + row] = -2 * p[3] * p[row];
    *inner = *f;
    inner->camera.view = mat4_multiply(&reflect, &f->camera.view);
    inner->mirror = mirror;
    inner->maps = NULL;
    inner->profile.on = false;
    inner->ground = (colour){0, 0, 0, 0};
    /* Reflected eye space lies beyond the plane, where dot(p, eye) + p.w is negative. */
    for (int k = 0; k < 4; k++)
        inner->clip_plane[k] = (float)-p[k];
    double nearest = INFINITY, farthest = -INFINITY;
    camera_depth_range(&inner->camera, f->plan->box, &nearest, &farthest);
    camera_set_range(&inner->camera, fmax(nearest, f->camera.orthographic ? nearest : 0), farthest);
    return true;
}
