/* What marks lie on: triangles of parts, all in one surface, so that marks are as dense on each of them. */
#include <math.h>
#include <string.h>

#include "base/memory.h"
#include "stage/mark_brightness.h"
#include "stage/mark_ground.h"
#include "pose/posed_mesh.h"

typedef struct ground_job {
    mark_ground     *out;
    const pose      *pose;
    const lmn_scene *scene;
    double           crease_angle;
    size_t           vertex_capacity, normal_capacity, uv_capacity, index_capacity, part_capacity, picture_capacity,
        tint_capacity, pictured_capacity;
    bool laid_out; /* some part has texture coordinates */
} ground_job;

void mark_ground_release(mark_ground *g)
{
    mem_free(g->positions);
    mem_free(g->normals);
    mem_free(g->uvs);
    mem_free(g->indices);
    mem_free(g->parts);
    mem_free(g->picture_uvs);
    mem_free(g->tints);
    mem_free(g->pictured);
    memset(g, 0, sizeof *g);
}

static bool make_room(ground_job *j, size_t vertices, size_t triangles)
{
    mark_ground *g = j->out;
    size_t       v = g->surface.vertex_count + vertices, t = g->surface.triangle_count + triangles;
    return v < UINT32_MAX && t < UINT32_MAX / 3 &&
           mem_grow((void **)&g->positions, &j->vertex_capacity, v, sizeof *g->positions) &&
           mem_grow((void **)&g->normals, &j->normal_capacity, v, sizeof *g->normals) &&
           mem_grow((void **)&g->uvs, &j->uv_capacity, v, sizeof *g->uvs) &&
           mem_grow((void **)&g->indices, &j->index_capacity, 3 * t, sizeof *g->indices) &&
           mem_grow((void **)&g->parts, &j->part_capacity, t, sizeof *g->parts) &&
           mem_grow((void **)&g->picture_uvs, &j->picture_capacity, v, sizeof *g->picture_uvs) &&
           mem_grow((void **)&g->tints, &j->tint_capacity, v, sizeof *g->tints) &&
           mem_grow((void **)&g->pictured, &j->pictured_capacity, t, sizeof *g->pictured);
}

static double luminance(double r, double g, double b)
{
    return 0.2126 * r + 0.7152 * g + 0.0722 * b;
}

/* How bright each vertex is but for pictures, and where these are looked up; formats without materials are a light
 * neutral grey. Returns whether a picture lies on them. */
static bool add_colours(ground_job *j, const primitive *p, const vertex_arrays *data, uint32_t first)
{
    const material    *m = p->material >= 0 ? &j->scene->materials[p->material] : NULL;
    const texture_use *use = m && m->base_texture.image >= 0 ? &m->base_texture : NULL;
    const float       *uvs = use ? data->uvs[use->uv_set ? 1 : 0] : NULL;
    double own = m ? luminance((double)m->base_colour.x, (double)m->base_colour.y, (double)m->base_colour.z) : 0.6;
    for (uint32_t i = 0; i < data->vertex_count; i++) {
        const float *c = data->colours ? &data->colours[4 * (size_t)i] : NULL;
        double       tint = c ? own * luminance((double)c[0], (double)c[1], (double)c[2]) : own;
        j->out->tints[first + i] = (float)fmin(fmax(tint, 0), 1);
        j->out->picture_uvs[first + i] = uvs ? (vec2){uvs[2 * (size_t)i], uvs[2 * (size_t)i + 1]} : (vec2){0, 0};
    }
    return uvs != NULL;
}

static void add_vertices(ground_job *j, const vertex_arrays *data, const mat4 *world)
{
    mark_ground *g = j->out;
    uint32_t     first = g->surface.vertex_count;
    double       cofactors[9], side = mat4_cofactors(world, cofactors) < 0 ? -1 : 1;
    for (uint32_t i = 0; i < data->vertex_count; i++) {
        const float *p = &data->positions[3 * (size_t)i], *n = &data->normals[3 * (size_t)i];
        double       position[3], normal[3], length = 0;
        for (int k = 0; k < 3; k++) {
            position[k] = world->m[k] * (double)p[0] + world->m[4 + k] * (double)p[1] + world->m[8 + k] * (double)p[2] +
                          world->m[12 + k] - g->origin[k];
            normal[k] = side * (cofactors[k] * (double)n[0] + cofactors[3 + k] * (double)n[1] +
                                cofactors[6 + k] * (double)n[2]);
            length += normal[k] * normal[k];
        }
        length = length > 0 ? sqrt(length) : 1;
        g->positions[first + i] = (vec3){(float)position[0], (float)position[1], (float)position[2]};
        g->normals[first + i] =
            (vec3){(float)(normal[0] / length), (float)(normal[1] / length), (float)(normal[2] / length)};
        g->uvs[first + i] =
            data->uvs[0] ? (vec2){data->uvs[0][2 * (size_t)i], -data->uvs[0][2 * (size_t)i + 1]} : (vec2){0, 0};
    }
    g->surface.vertex_count += data->vertex_count;
}

/* A primitive at one position. What is mirrored has its triangles turned around. */
static bool add_primitive(ground_job *j, const primitive *p, const vertex_arrays *data, const mat4 *world,
                          uint32_t part)
{
    uint32_t first = j->out->surface.vertex_count, triangle = j->out->surface.triangle_count,
             count = data->index_count / 3;
    if (!make_room(j, data->vertex_count, count))
        return false;
    mark_ground *g = j->out;
    double       cofactors[9];
    bool         mirrored = mat4_cofactors(world, cofactors) < 0;
    bool         pictured = add_colours(j, p, data, first);
    add_vertices(j, data, world);
    for (uint32_t t = 0; t < count; t++, triangle++) {
        g->parts[triangle] = part;
        g->pictured[triangle] = pictured ? p->material : NONE;
        for (uint32_t c = 0; c < 3; c++) {
            uint32_t vertex = data->indices[3 * (size_t)t + (mirrored && c > 0 ? 3 - c : c)];
            g->indices[3 * (size_t)triangle + c] = first + vertex;
        }
    }
    g->surface.triangle_count = triangle;
    j->laid_out = j->laid_out || data->uvs[0];
    g->holed = g->holed || (p->material >= 0 && j->scene->materials[p->material].alpha != ALPHA_OPAQUE);
    return true;
}

static lmn_status add_part(ground_job *j, size_t part, lmn_error *error)
{
    const node *n = &j->scene->nodes[j->scene->parts[part].node];
    if (n->mesh < 0)
        return LMN_OK;
    const mesh *m = &j->scene->meshes[n->mesh];
    lmn_status  status = LMN_OK;
    for (size_t i = 0; i < m->primitive_count && status == LMN_OK; i++) {
        posed_mesh posed;
        if (m->primitives[i].index_count == 0)
            continue;
        status = posed_make(&posed, &m->primitives[i], j->crease_angle, &j->pose->parts[part], error);
        for (size_t k = 0; k < node_draw_count(n) && status == LMN_OK; k++) {
            mat4 world = pose_instance(j->pose, part, k);
            if (!add_primitive(j, &m->primitives[i], &posed.data, &world, (uint32_t)part))
                status = error_memory(error);
        }
        posed_release(&posed);
    }
    return status;
}

lmn_status mark_ground_create(mark_ground *out, const pose *pose, const bool *parts, size_t part_count,
                              double crease_angle, lmn_error *error)
{
    *out = (mark_ground){.scene = pose->scene};
    ground_job j = {.out = out, .pose = pose, .scene = pose->scene, .crease_angle = crease_angle};
    box3       box = box3_empty();
    for (size_t i = 0; i < part_count; i++)
        if (!parts || parts[i])
            box = box3_union(box, pose->part_boxes[i]);
    if (!box3_is_empty(box)) {
        box3_middle(box, out->origin);
        out->extent = box3_diagonal(box);
    }
    lmn_status status = LMN_OK;
    for (size_t i = 0; i < part_count && status == LMN_OK; i++)
        if (!parts || parts[i])
            status = add_part(&j, i, error);
    out->surface.positions = out->positions;
    out->surface.normals = out->normals;
    out->surface.uvs = j.laid_out ? out->uvs : NULL;
    out->surface.indices = out->indices;
    out->surface.up = pose->scene->up == 'z' ? (vec3){0, 0, 1} : (vec3){0, 1, 0};
    if (status != LMN_OK)
        mark_ground_release(out);
    return status;
}

/* Of dots, and of strokes that are drawn whole: the mean along each. Lines that flow have theirs already. */
static void set_brightness(marks *m, const mark_surface *s)
{
    double around = m->dot_count ? sqrt(m->area / (double)m->dot_count) : 0;
    for (size_t i = 0; i < m->dot_count; i++)
        m->dots[i].bright = (float)s->brightness(s->brightness_of, m->dots[i].triangle, m->dots[i].position, around);
    for (size_t i = 0, end; i < m->line_count && !m->flow; i = end) {
        double sum = 0, length = 0;
        for (end = i; end < m->line_count && m->lines[end].stroke == m->lines[i].stroke; end++) {
            const mark_line *l = &m->lines[end];
            vec3             middle = {(l->a.x + l->b.x) / 2, (l->a.y + l->b.y) / 2, (l->a.z + l->b.z) / 2};
            double           own = fmax((double)l->to - (double)l->from, 1e-30);
            sum += own * s->brightness(s->brightness_of, l->triangle, middle, own);
            length += own;
        }
        for (size_t k = i; k < end; k++)
            m->lines[k].bright = (float)(sum / length);
    }
}

lmn_status mark_ground_marks(marks *out, const mark_ground *g, const technique_use *surface, lmn_error *error)
{
    mark_brightness b;
    mark_surface    s = g->surface;
    *out = (marks){.dots = NULL};
    lmn_status status = mark_brightness_make(&b, g, error);
    s.brightness = mark_brightness_at;
    s.brightness_of = &b;
    if (status == LMN_OK)
        status = surface->technique->surface->marks->make(out, &s, g->extent, surface->values, error);
    if (status == LMN_OK)
        set_brightness(out, &s);
    mark_brightness_release(&b);
    return status;
}

lmn_status mark_ground_move(mark_ground *now, marks *moved, const mark_ground *at_rest, const marks *made,
                            const mark_ground_options *w, lmn_error *error)
{
    *moved = *made;
    moved->line_capacity = made->line_count;
    moved->dots = made->dots ? mem_copy(made->dots, made->dot_count * sizeof *made->dots) : NULL;
    moved->lines = made->lines ? mem_copy(made->lines, made->line_count * sizeof *made->lines) : NULL;
    bool       copied = (moved->dots || !made->dots) && (moved->lines || !made->lines);
    lmn_status status = copied ? LMN_OK : error_memory(error);
    memset(now, 0, sizeof *now);
    if (status == LMN_OK)
        status = mark_ground_create(now, w->pose, w->parts, w->part_count, w->crease_angle, error);
    if (status == LMN_OK)
        marks_carry(moved, &at_rest->surface, &now->surface);
    return status;
}

static lmn_status move(mark_ground *g, marks *m, const mark_ground_options *w, lmn_error *error)
{
    mark_ground now;
    marks       moved;
    lmn_status  status = mark_ground_move(&now, &moved, g, m, w, error);
    if (status == LMN_OK) {
        mark_ground g_before = *g;
        marks       m_before = *m;
        *g = now;
        *m = moved;
        now = g_before;
        moved = m_before;
    }
    mark_ground_release(&now);
    surface_marks_release(&moved);
    return status;
}

lmn_status mark_ground_posed(mark_ground *out, marks *marks_out, const mark_ground_options *w, lmn_error *error)
{
    const pose *first = w->pose->at_rest ? w->pose->at_rest : w->pose;
    *marks_out = (marks){.dots = NULL};
    lmn_status status = mark_ground_create(out, first, w->parts, w->part_count, w->crease_angle, error);
    if (status == LMN_OK)
        status = mark_ground_marks(marks_out, out, w->surface, error);
    return status == LMN_OK && w->pose->at_rest ? move(out, marks_out, w, error) : status;
}
