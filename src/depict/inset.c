/* Inset views: what a camera sees at a time, as a small framed picture in a corner of the page, with a line to the
 * camera. Nienhaus 2005, section 7.9, figure 7-8. */
#include <string.h>

#include "base/error.h"
#include "base/memory.h"
#include "depict/inset.h"
#include "scene/content.h"
#include "depict/camera_shot.h"

typedef struct inset_values {
    int32_t corner;
    float   size, aspect, bar;
    bool    leader;
    colour  colour, paper;
} inset_values;

static const char *const corners[] = {"auto", "top-left", "top-right", "bottom-left", "bottom-right", NULL};

static const param inset_params[] = {
    PARAM_ENUM_ROW(inset_values, corner, .names = corners, .def = CORNER_AUTO,
                   .doc = "Of the page; auto: where it covers least."),
    PARAM_FLOAT_ROW(inset_values, size, .def = 0.34, .min = 0.02, .max = 1, .soft_max = 0.6, .unit = UNIT_FRACTION,
                    .doc = "Height of the panel, share of the page's."),
    PARAM_FLOAT_ROW(inset_values, aspect, .def = 1, .min = 0.1, .max = 10, .can_auto = true, .def_auto = true,
                    .doc = "Breadth by height; auto: the page's."),
    PARAM_FLOAT_ROW(inset_values, bar, .def = 0.02, .min = 0.001, .max = 0.5, .soft_max = 0.1, .unit = UNIT_FRACTION,
                    .doc = "Breadth of the frame, share of the panel's height."),
    PARAM_BOOL_ROW(inset_values, leader, .def = 1,
                   .doc = "A line from the panel to the frame of what the camera sees then."),
    PARAM_COLOUR_ROW(inset_values, colour, .def_colour = {0, 0, 0, 0},
                     .doc = "Of frame and line; none: grey for the past, orange for now, red for the future."),
    PARAM_COLOUR_ROW(inset_values, paper, .def_colour = {1, 1, 1, 1}, .doc = "Behind what the camera sees."),
};

typedef struct inset {
    depict_job       *job;
    const expression *e;
    inset_stage       stage;
    camera_shot       shot;
    double            seconds;
    glyph_tense       when;
} inset;

/* --- what is before all else ----------------------------------------------------------------------------------------
 */

/* Before the scene, wherever it goes, and all signs. */
static double back_of_panel(const depict_job *j)
{
    double nearest = INFINITY;
    for (int i = 0; i < 8 && !box3_is_empty(j->box); i++) {
        const double at[3] = {(double)(i & 1 ? j->box.max.x : j->box.min.x),
                              (double)(i & 2 ? j->box.max.y : j->box.min.y),
                              (double)(i & 4 ? j->box.max.z : j->box.min.z)};
        nearest = fmin(nearest, page_depth_of(j, at));
    }
    for (size_t i = 0; i < j->glyph_count; i++)
        for (size_t k = 0; k < j->glyphs[i].mesh.position_count; k++) {
            const vec3   v = glyph_position(&j->glyphs[i], k);
            const double at[3] = {(double)v.x, (double)v.y, (double)v.z};
            nearest = fmin(nearest, page_depth_of(j, at));
        }
    const double far = vector3_distance(j->camera.eye, j->camera.target), least = fmax(0.1 * j->size, 0.1 * far);
    if (!isfinite(nearest))
        nearest = far;
    nearest -= 0.02 * j->size;
    return j->camera.orthographic ? nearest : fmax(nearest, least);
}

/* --- glyphs ---------------------------------------------------------------------------------------------------------
 */

static lmn_status put(inset *i, glyph_mesh *m, const char *glyph, colour tint, lmn_error *error)
{
    lmn_status status = glyph_put(
        i->job, m,
        &(glyph_label){.glyph = glyph, .of = i->e->target, .when = i->when, .tint = tint, .overlay = true, .image = 1},
        error);
    glyph_mesh_release(m);
    return status;
}

static colour own_colour(const lmn_scene *s, const primitive *p)
{
    if (p->material == NONE)
        return (colour){0.75f, 0.75f, 0.75f, 1};
    const vec4 *own = &s->materials[p->material].base_colour;
    return (colour){colour_from_linear(own->x), colour_from_linear(own->y), colour_from_linear(own->z), 1};
}

static lmn_status put_part(inset *i, const pose *p, size_t part, lmn_error *error)
{
    const lmn_scene *s = i->job->scene;
    const node      *n = &s->nodes[s->parts[part].node];
    const mesh      *own = n->mesh == NONE ? NULL : &s->meshes[n->mesh];
    lmn_status       status = LMN_OK;
    for (size_t k = 0; own && k < own->primitive_count && status == LMN_OK; k++) {
        const primitive *from = &own->primitives[k];
        glyph_mesh       m = {0};
        vec3            *positions = mem_alloc((from->vertex_count + 1) * sizeof *positions);
        if (!positions)
            return error_memory(error);
        pose_vertices(&p->parts[part], from, NULL, NULL, from->vertex_count, positions, NULL);
        for (size_t d = 0; d < node_draw_count(n); d++) {
            const mat4 world = pose_instance(p, part, d);
            inset_copy(&m, &i->stage, i->job, from, positions, &world);
        }
        mem_free(positions);
        status = put(i, &m, "inset", own_colour(s, from), error);
    }
    return status;
}

static lmn_status put_paper(inset *i, lmn_error *error)
{
    const inset_values *v = i->e->values;
    glyph_mesh          m = {0};
    uint32_t            c[4];
    for (int k = 0; k < 4; k++) {
        double at[3];
        inset_point(&i->stage, i->job, k == 1 || k == 2 ? 1 : -1, k > 1 ? 1 : -1, 1, at);
        c[k] = glyph_vertex(&m, at);
    }
    glyph_triangle(&m, c[0], c[1], c[2]);
    glyph_triangle(&m, c[0], c[2], c[3]);
    return put(i, &m, "inset-paper", v->paper, error);
}

static lmn_status put_bars(inset *i, colour tint, lmn_error *error)
{
    const inset_values *v = i->e->values;
    const inset_panel  *p = &i->stage.panel;
    const double        bar = 2 * (double)v->bar, aspect = p->half[0] / p->half[1];
    glyph_mesh          m = {0};
    uint32_t            c[8];
    for (int k = 0; k < 8; k++) {
        const double x = k % 4 == 1 || k % 4 == 2 ? 1 : -1, y = k % 4 > 1 ? 1 : -1, out = k < 4 ? 0 : bar;
        double       at[3];
        inset_point(&i->stage, i->job, x * (1 + out / aspect), y * (1 + out), -1, at);
        c[k] = glyph_vertex(&m, at);
    }
    for (int k = 0; k < 4; k++) {
        const int next = (k + 1) % 4;
        glyph_triangle(&m, c[k], c[4 + k], c[4 + next]);
        glyph_triangle(&m, c[k], c[4 + next], c[next]);
    }
    return put(i, &m, "inset-frame", tint, error);
}

/* How far before the camera its frames stand, where another expression tells of them. */
static double focus_of_frames(const depict_job *j, const expression *e)
{
    for (size_t i = 0; j->expressions && i < j->expressions->count; i++) {
        const expression *other = &j->expressions->items[i];
        for (size_t k = 0; k < other->row->param_count && other != e && other->target == e->target; k++)
            if (strcmp(other->row->params[k].key, "focus") == 0)
                return (double)*(const float *)((const char *)other->values + other->row->params[k].offset);
    }
    return 0;
}

/* From the rim of the panel to what the line leads to, thin. */
static lmn_status put_leader(inset *i, colour tint, lmn_error *error)
{
    const inset_values *v = i->e->values;
    const depict_job   *j = i->job;
    const inset_panel  *p = &i->stage.panel;
    double              at[3], to[2], from[2], points[2][3], widths[2];
    glyph_mesh          m = {0};
    camera_shot_point(&i->shot, i->seconds, 0, 0, at);
    if (!v->leader || !page_seen_at(j, at, to) ||
        (fabs(to[0] - p->middle[0]) < p->half[0] && fabs(to[1] - p->middle[1]) < p->half[1]))
        return LMN_OK;
    for (int k = 0; k < 2; k++) {
        const double rim = p->half[k] + 2 * (double)v->bar * p->half[1];
        from[k] = fmin(fmax(to[k], p->middle[k] - rim), p->middle[k] + rim);
    }
    const double depth = page_depth_of(j, at), back = i->stage.depth;
    /* Before all, but behind the panel's frame. */
    page_position(j, from, back, points[0]);
    page_position(j, to, depth < back ? depth : back, points[1]);
    const double half = j->camera.orthographic ? j->camera.half_height : back * tan(j->camera.fov_y / 2);
    widths[0] = widths[1] = 1.2 * (double)v->bar * p->half[1] * half;
    glyph_put_ribbon(&m, j, &(glyph_ribbon){(const double(*)[3])points, widths, 2});
    return put(i, &m, "leader", tint, error);
}

static lmn_status put_all(inset *i, const pose *p, lmn_error *error)
{
    const inset_values *v = i->e->values;
    const colour        tint = depict_tint(i->when, v->colour);
    lmn_status          status = put_paper(i, error);
    for (size_t k = 0; k < i->job->scene->part_count && status == LMN_OK; k++)
        if (!scene_is_hidden(i->job->scene, i->job->scene->parts[k].node))
            status = put_part(i, p, k, error);
    if (status == LMN_OK)
        status = put_bars(i, tint, error);
    return status == LMN_OK ? put_leader(i, tint, error) : status;
}

static lmn_status inset_depict(depict_job *j, const expression *e, lmn_error *error)
{
    const inset_values *v = e->values;
    const double        half = (double)v->size, aspect = isnan(v->aspect) ? j->camera.aspect : (double)v->aspect;
    inset_panel         panel = {.half = {half * aspect, half}};
    inset               i = {.job = j, .e = e, .seconds = fmin(fmax(e->now, e->from), e->to)};
    const pose         *p = NULL;
    const double        rim = 0.04 + 2 * (double)v->bar * half;
    const double        room = j->camera.aspect - 0.04;
    if (panel.half[0] > room / 2) { /* never more than half the page */
        panel.half[1] *= room / 2 / panel.half[0];
        panel.half[0] = room / 2;
    }
    const double apart = i.seconds - j->when.seconds;
    i.when = fabs(apart) < 1e-6 ? GLYPH_PRESENT : apart < 0 ? GLYPH_PAST : GLYPH_FUTURE;
    lmn_status status = camera_shot_open(&i.shot, j, e, focus_of_frames(j, e), error);
    if (status == LMN_OK)
        status = inset_place(&panel, j, (inset_corner)v->corner, rim, error);
    if (status == LMN_OK)
        status = depict_pose(&p, j, i.seconds, error);
    if (status == LMN_OK)
        status = inset_open(&i.stage, j, p, i.shot.node, &panel, error);
    if (status == LMN_OK) {
        inset_set_depth(&i.stage, j, back_of_panel(j));
        status = put_all(&i, p, error);
    }
    camera_shot_release(&i.shot);
    return status;
}

const depiction depiction_inset = {
    .characteristic = "inset",
    .doc =
        "A small picture in a corner of the page: the scene as a camera sees it at \"now\", in a frame, with a line to "
        "the camera. It is made when all other signs are there.",
    .params = inset_params,
    .param_count = PARAM_COUNT(inset_params),
    .values_size = sizeof(inset_values),
    .depict = inset_depict,
    .last = true,
};
