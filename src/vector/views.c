/* Where the views of a sheet lie, at which scale, and what their cameras see. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "base/limits.h"
#include "base/vector3.h"
#include "vector/vector_job.h"

static const double gap_between_views = 12, gap_with_letters = 26; /* mm */

/* The description that a view's camera is placed by. */
lmn_draw_desc vector_view_desc(const vector_job *j, const vector_view *v)
{
    lmn_draw_desc d = *j->desc;
    d.width = v->width;
    d.height = v->height;
    if (j->wanted->views) {
        d.view = v->direction;
        d.eye_given = false;
        d.camera = NULL;
        d.orthographic = true;
    }
    if (v->extra && v->extra->kind == DRAFT_AUXILIARY) {
        const bool upright = fabs(v->extra->eye[j->scene->up == 'z' ? 2 : 1]) < 0.999;
        box3_middle(j->plan.fit.box, d.target);
        vector3_add(d.eye, d.target, fmax(box3_diagonal(j->plan.fit.box), 1e-9), v->extra->eye);
        vector3_set(d.up, 0, !upright && j->scene->up == 'z', !upright && j->scene->up != 'z' ? -1 : 0);
        d.eye_given = d.fit_direction = true;
    }
    d.orthographic = d.orthographic || j->scale > 0;
    return d;
}

/* Width and height of the model as a view shows it, its unit. */
lmn_status vector_measure_view(const vector_job *j, const vector_view *v, double out[2], lmn_error *error)
{
    vector_view square = *v;
    view_camera c;
    if (v->extra && v->extra->kind == DRAFT_DETAIL) {
        out[0] = out[1] = 2 * v->extra->radius;
        return LMN_OK;
    }
    square.width = square.height = 64;
    lmn_draw_desc d = vector_view_desc(j, &square);
    lmn_status    status = camera_place(&c, &d, &j->pose, &j->plan.fit, error);
    out[0] = 2 * c.half_size[0];
    out[1] = 2 * c.half_size[1];
    bool fitted = out[0] > 0 || out[1] > 0;
    for (int i = 0; i < 8 && status == LMN_OK && !fitted && !box3_is_empty(j->plan.fit.box); i++) {
        const double *m = c.view.m,
                     corner[3] = {(double)(i & 1 ? j->plan.fit.box.max.x : j->plan.fit.box.min.x),
                                  (double)(i & 2 ? j->plan.fit.box.max.y : j->plan.fit.box.min.y),
                                  (double)(i & 4 ? j->plan.fit.box.max.z : j->plan.fit.box.min.z)},
                     middle[3] = {c.target[0], c.target[1], c.target[2]};
        for (int k = 0; k < 2; k++) {
            double from_middle = 0;
            for (int n = 0; n < 3; n++)
                from_middle += m[4 * n + k] * (corner[n] - middle[n]);
            out[k] = fmax(out[k], 2 * fabs(from_middle));
        }
    }
    return status;
}

/* Whole pixels around the same middle; far more than the page has is of no use. */
static lmn_status settle_box(vector_view *v, const sheet *page, lmn_error *error)
{
    int *sides[2] = {&v->width, &v->height};
    for (int k = 0; k < 2; k++) {
        double most = 2 * (k ? page->height : page->width), over = fmax(v->box[2 + k] - most, 0);
        v->box[k] += over / 2;
        v->box[2 + k] -= over;
        double pixels = fmax(round(v->box[2 + k] * VECTOR_PIXELS_PER_MM), 1);
        if (!(pixels <= LIMIT_PICTURE_SIDE))
            return error_set(error, LMN_LIMIT, "a view is %.0f mm wide or high on the sheet, the limit is %.0f mm",
                             v->box[2 + k], LIMIT_PICTURE_SIDE / VECTOR_PIXELS_PER_MM);
        *sides[k] = (int)pixels;
        double size = pixels / VECTOR_PIXELS_PER_MM;
        v->box[k] += (v->box[2 + k] - size) / 2;
        v->box[2 + k] = size;
    }
    return LMN_OK;
}

/* Moves a camera aside until it has this in its middle. */
static void look_at(view_camera *c, const double at[3])
{
    for (int k = 0; k < 2; k++) {
        const double *m = c->view.m, row[3] = {m[k], m[4 + k], m[8 + k]};
        double        aside = vector3_dot(row, at) + m[12 + k];
        vector3_add(c->eye, c->eye, aside, row);
        vector3_add(c->target, c->target, aside, row);
        c->view.m[12 + k] -= aside;
    }
}

static lmn_status place_camera(vector_job *j, vector_view *v, lmn_error *error)
{
    lmn_draw_desc d = vector_view_desc(j, v);
    lmn_status    status = camera_place(&v->camera, &d, &j->pose, &j->plan.fit, error);
    if (status != LMN_OK)
        return status;
    double scale = v->scale > 0 ? v->scale : j->out->scale; /* paper over model */
    if (scale > 0 && !v->camera.orthographic) {
        error_set(error, LMN_USAGE, "a scale needs parallel projection, and the camera '%s' has perspective",
                  d.camera ? d.camera : "");
        return LMN_USAGE;
    }
    if (scale > 0)
        v->camera.half_height = v->height / (2 * scale * j->unit_mm * VECTOR_PIXELS_PER_MM);
    else if (v->camera.orthographic && j->unit_mm > 0)
        j->out->scale = v->height / (2 * v->camera.half_height * j->unit_mm * VECTOR_PIXELS_PER_MM);
    if (v->extra && v->extra->kind == DRAFT_DETAIL)
        look_at(&v->camera, v->extra->at);
    plan_camera_range(&j->plan, &v->camera, &j->out->warnings);
    return LMN_OK;
}

/* Where there are letters and arrows, views lie farther apart. */
static double gap_of(const vector_job *j, const double area[4])
{
    return fmin(j->out->extras.count ? gap_with_letters : gap_between_views,
                fmin(area[2], area[3]) / (j->out->extras.count ? 8 : 12));
}

/* Several views on one sheet, or one at a scale of its own. */
static lmn_status arrange_views(vector_job *j, const double area[4], lmn_error *error)
{
    lmn_sheet *s = j->out;
    double     sizes[SHEET_VIEWS_MOST][2];
    lmn_status status = LMN_OK;
    for (size_t i = 0; i < s->view_count && status == LMN_OK; i++) {
        status = vector_measure_view(j, &s->views[i], sizes[i], error);
        sizes[i][0] *= j->unit_mm;
        sizes[i][1] *= j->unit_mm;
    }
    if (status != LMN_OK)
        return status;
    vector_layout how = {
        .gap = gap_of(j, area), .angle = j->wanted->angle, .scale = j->scale, .usual = j->usual_scale, .fit = 1};
    memcpy(how.area, area, sizeof how.area);
    s->scale = vector_place_views(&how, s->views, s->view_count, (const double(*)[2])sizes);
    for (size_t i = 0; i < s->view_count; i++) {
        const double *box = s->views[i].box;
        if (box[0] < area[0] - how.gap || box[1] < area[1] - how.gap || box[0] + box[2] > area[0] + area[2] + how.gap ||
            box[1] + box[3] > area[1] + area[3] + how.gap) {
            char scale[32];
            vector_print_scale(scale, s->scale);
            warnings_add(&s->warnings, WARNING_PAGE, "at %s the views do not fit on the page", scale);
            break;
        }
    }
    return LMN_OK;
}

/* A section takes the place of the view that it replaces; all else, and what finds its place taken, lies apart. */
static lmn_status add_extras(vector_job *j, lmn_error *error)
{
    static const char *const kinds[] = {"section", "detail", "auxiliary"};
    lmn_sheet               *s = j->out;
    lmn_status status = draft_extras_parse(&s->extras, j->wanted->sections, j->wanted->details, j->wanted->auxiliary,
                                           j->scene->up, j->plan.fit.box, error);
    for (size_t i = 0; i < s->extras.count && status == LMN_OK; i++)
        if (s->extras.items[i].of_face)
            status = vector_face_normal(j, s->extras.items[i].at, s->extras.items[i].eye, error);
    for (size_t i = 0; i < s->extras.count && status == LMN_OK; i++) {
        draft_extra *e = &s->extras.items[i];
        vector_view *v = &s->views[s->view_count];
        if (e->kind == DRAFT_REVOLVED)
            continue;
        if (j->unit_mm > 0 && e->kind == DRAFT_DETAIL && e->scale > 0 && !(e->scale * e->radius * j->unit_mm < 1e4))
            return error_set(error, LMN_LIMIT, "detail %c is more than 10 m large on the sheet", e->letter);
        *v = (vector_view){.direction = e->view, .extra = e, .apart = e->kind != DRAFT_SECTION};
        for (size_t k = 0; k < s->view_count; k++)
            v->apart = v->apart || (!s->views[k].apart && s->views[k].direction == e->view);
        snprintf(v->name, sizeof v->name, "%s-%c", kinds[e->kind], e->letter);
        s->view_count++;
    }
    return status;
}

lmn_status vector_place_all(vector_job *j, lmn_error *error)
{
    lmn_sheet *s = j->out;
    double     area[4];
    lmn_status status = LMN_OK;
    vector_inside_frame(j->wanted, s->page.width, s->page.height, area);
    if (j->wanted->views) {
        status = vector_parse_views(j->wanted->views, s->views, &s->view_count, error);
        if (status == LMN_OK)
            status = add_extras(j, error);
        if (status == LMN_OK)
            status = arrange_views(j, area, error);
    } else if (j->wanted->sections || j->wanted->details || j->wanted->auxiliary) {
        error_set(error, LMN_USAGE, "sections, details and auxiliary views stand beside other views");
        error_hint(error, "say which (`views`, --views), for example front,top");
        return LMN_USAGE;
    } else {
        bool eye = j->desc->eye_given || j->desc->camera;
        s->views[0] = (vector_view){.direction = j->desc->view};
        snprintf(s->views[0].name, sizeof s->views[0].name, "%s", eye ? "view" : vector_view_name(j->desc->view));
        memcpy(s->views[0].box, area, sizeof area);
        s->view_count = 1;
        s->scale = j->scale;
    }
    for (size_t i = 0; i < s->view_count && status == LMN_OK; i++) {
        status = settle_box(&s->views[i], &s->page, error);
        if (status == LMN_OK)
            status = place_camera(j, &s->views[i], error);
    }
    if (status == LMN_OK && s->scale > 0)
        vector_print_scale(s->scale_text, s->scale);
    return status;
}

/* The largest usual scale at which all views lie on the page; 0: there is none. */
double vector_scale_that_fits(const vector_job *j, lmn_error *error)
{
    const lmn_sheet *s = j->out;
    double           area[4], sizes[SHEET_VIEWS_MOST][2];
    vector_view      views[SHEET_VIEWS_MOST];
    vector_inside_frame(j->wanted, s->page.width, s->page.height, area);
    memcpy(views, s->views, sizeof views);
    for (size_t i = 0; i < s->view_count; i++) {
        if (vector_measure_view(j, &views[i], sizes[i], error) != LMN_OK)
            return 0;
        sizes[i][0] *= j->unit_mm;
        sizes[i][1] *= j->unit_mm;
        if (!(sizes[i][0] > 0 || sizes[i][1] > 0))
            return 0;
    }
    vector_layout how = {.gap = gap_of(j, area), .angle = j->wanted->angle, .usual = true, .fit = 1};
    memcpy(how.area, area, sizeof how.area);
    return vector_place_views(&how, views, s->view_count, (const double(*)[2])sizes);
}
