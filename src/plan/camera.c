#include "plan/camera.h"

#include <math.h>
#include <string.h>

#include "base/text.h"
#include "plan/lights.h"
#include "plan/refuse.h"

static double dot3(const double a[3], const double b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static void cross3(const double a[3], const double b[3], double out[3])
{
    out[0] = a[1] * b[2] - a[2] * b[1];
    out[1] = a[2] * b[0] - a[0] * b[2];
    out[2] = a[0] * b[1] - a[1] * b[0];
}

static bool normalise3(double v[3])
{
    double length = sqrt(dot3(v, v));
    if (!(length > 0) || !isfinite(length))
        return false;
    for (int i = 0; i < 3; i++)
        v[i] /= length;
    return true;
}

/* Direction to the eye and up vector of the named views. Front looks along −Z (Y-up) or +Y (Z-up); top and bottom
 * have the front at the picture's bottom and top. */
static void named_view(lmn_view view, char up, double to_eye[3], double up_axis[3])
{
    /* In Y-up axes; Z-up turns (x, y, z) into (x, −z, y). */
    static const double directions[][2][3] = {
        [LMN_VIEW_ISO] = {{1, 1, 1}, {0, 1, 0}},     [LMN_VIEW_FRONT] = {{0, 0, 1}, {0, 1, 0}},
        [LMN_VIEW_BACK] = {{0, 0, -1}, {0, 1, 0}},   [LMN_VIEW_LEFT] = {{-1, 0, 0}, {0, 1, 0}},
        [LMN_VIEW_RIGHT] = {{1, 0, 0}, {0, 1, 0}},   [LMN_VIEW_TOP] = {{0, 1, 0}, {0, 0, -1}},
        [LMN_VIEW_BOTTOM] = {{0, -1, 0}, {0, 0, 1}},
    };
    for (int which = 0; which < 2; which++) {
        const double *v = directions[view][which];
        double       *out = which ? up_axis : to_eye;
        out[0] = v[0];
        out[1] = up == 'z' ? -v[2] : v[1];
        out[2] = up == 'z' ? v[1] : v[2];
    }
}

void camera_view_axes(lmn_view view, char up_axis, double out[3][3])
{
    named_view(view, up_axis, out[2], out[1]);
    normalise3(out[2]);
    cross3(out[1], out[2], out[0]);
    normalise3(out[0]);
    cross3(out[2], out[0], out[1]);
}

static void corners_of(box3 box, double out[8][3])
{
    for (int i = 0; i < 8; i++) {
        out[i][0] = i & 1 ? box.max.x : box.min.x;
        out[i][1] = i & 2 ? box.max.y : box.min.y;
        out[i][2] = i & 4 ? box.max.z : box.min.z;
    }
}

/* How far what is fitted reaches beyond rays of slope t through depth `eye_z`, to the plus and to the minus side. */
static double overreach(const fit_reach *r, double eye_z, double t, double most, double *centre)
{
    double plus = fit_plus(r, t, most) + t * eye_z, minus = fit_minus(r, t, most) + t * eye_z;
    *centre = (plus - minus) / 2;
    return plus + minus;
}

/* The farthest eye depth at which it fits between rays of slope ±t. */
static double fitting_depth(const fit_reach *r, double t)
{
    double centre;
    return -overreach(r, 0.0, t, t, &centre) / (2 * t);
}

/* The eye's position across, so that it reaches equally far to both sides on the picture. */
static double fitting_centre(const fit_reach *r, double eye_z, double t)
{
    double low = 0, high = t, centre = 0;
    for (int i = 0; i < 100; i++) {
        double middle = (low + high) / 2;
        if (overreach(r, eye_z, middle, t, &centre) > 0)
            low = middle;
        else
            high = middle;
    }
    overreach(r, eye_z, high, t, &centre);
    return centre;
}

static double half_diagonal(box3 box)
{
    double x = (double)box.max.x - (double)box.min.x, y = (double)box.max.y - (double)box.min.y,
           z = (double)box.max.z - (double)box.min.z, half = sqrt(x * x + y * y + z * z) / 2;
    return half > 0 && isfinite(half) ? half : 1;
}

/* The eye's position across, up and in depth, measured from the middle. */
static void fit_rays(view_camera *c, const fit_view *view, const fit_reach reach[2], double extent, double fit,
                     double out[3])
{
    if (c->orthographic) {
        for (int k = 0; k < 2; k++) {
            out[k] = (reach[k].plus[0] - reach[k].minus[0]) / 2;
            c->half_size[k] = (reach[k].plus[0] + reach[k].minus[0]) / 2;
        }
        c->half_height = fmax(c->half_size[1], c->half_size[0] / c->aspect) / fit;
        if (!(c->half_height > 0))
            c->half_height = extent;
        out[2] = -3 * extent;
    } else {
        out[2] = fmin(fitting_depth(&reach[0], view->slope[0]), fitting_depth(&reach[1], view->slope[1]));
        if (!(out[2] < 0))
            out[2] = -3 * extent;
        for (int k = 0; k < 2; k++)
            out[k] = fitting_centre(&reach[k], out[2], view->slope[k]);
    }
}

/* A shadow that is longer than what throws it is high by more than this counts up to it: the figure would shrink for a
 * low light. */
static const double LONGEST_SHADOW = 1.5;

/* What takes a position to its shadow on the ground. False: none is drawn, or it is not seen. */
static bool find_shadow(mat4 *out, const fit_body *body, const fit_view *view)
{
    const fit_ground *g = &body->ground;
    if (!g->shadowed || !(-view->forward[g->up] > GROUND_EDGE_ON))
        return false;
    mat4 turn = mat4_identity();
    for (int k = 0; k < 3; k++) {
        turn.m[4 * k] = view->right[k];
        turn.m[4 * k + 1] = view->up[k];
        turn.m[4 * k + 2] = -view->forward[k];
    }
    const light_conditions conditions = {.look = body->look, .pose = body->pose, .view = &turn};
    const light_list       lights = lights_list(&conditions);
    const float           *first = lights.positions[0];
    double                 towards[3], across = 0;
    for (int k = 0; k < 3; k++) {
        towards[k] =
            view->right[k] * (double)first[0] + view->up[k] * (double)first[1] - view->forward[k] * (double)first[2];
        across += k == g->up ? 0 : towards[k] * towards[k];
    }
    double rise = fmax(towards[g->up], sqrt(across) / LONGEST_SHADOW);
    if (first[3] != 0 || !(towards[g->up] > 0))
        return false;
    *out = mat4_identity();
    for (int k = 0; k < 3; k++) {
        double run = k == g->up ? 1 : towards[k] / rise;
        out->m[4 * g->up + k] -= run;
        out->m[12 + k] += run * g->level;
    }
    return true;
}

/* Moves the eye so that what is drawn fills the fraction `fit` of the frame. */
static void fit_to(view_camera *c, const fit_body *body, double fit, const double right[3], const double up[3],
                   const double forward[3])
{
    bool      empty = box3_is_empty(body->box);
    box3      box = empty ? (box3){{0, 0, 0}, {0, 0, 0}} : body->box;
    double    extent = half_diagonal(box), at[3] = {0, 0, -3 * extent}, t = tan(c->fov_y / 2) * fit;
    fit_view  view = {.middle = {((double)box.min.x + (double)box.max.x) / 2,
                                 ((double)box.min.y + (double)box.max.y) / 2,
                                 ((double)box.min.z + (double)box.max.z) / 2}};
    fit_reach reach[2];
    memcpy(view.right, right, sizeof view.right);
    memcpy(view.up, up, sizeof view.up);
    memcpy(view.forward, forward, sizeof view.forward);
    view.slope[0] = c->orthographic ? 0 : t * c->aspect;
    view.slope[1] = c->orthographic ? 0 : t;
    c->half_height = extent;
    mat4 shadow;
    view.shadow = find_shadow(&shadow, body, &view) ? &shadow : NULL;
    fit_measure(reach, body, &view);
    if (isfinite(reach[0].plus[0]))
        fit_rays(c, &view, reach, extent, fit, at);
    for (int k = 0; k < 3; k++) {
        c->eye[k] = view.middle[k] + at[0] * right[k] + at[1] * up[k] + at[2] * forward[k];
        c->target[k] = c->eye[k] - at[2] * forward[k];
        c->up[k] = up[k];
    }
}

static void set_view(view_camera *c, const double right[3], const double up[3], const double forward[3])
{
    double *m = c->view.m;
    for (int k = 0; k < 3; k++) {
        m[4 * k] = right[k];
        m[4 * k + 1] = up[k];
        m[4 * k + 2] = -forward[k];
        m[4 * k + 3] = 0;
    }
    m[12] = -dot3(right, c->eye);
    m[13] = -dot3(up, c->eye);
    m[14] = dot3(forward, c->eye);
    m[15] = 1;
}

/* Makes a right-handed frame; an up vector along the view is replaced by another axis. */
static void frame_of(const double forward[3], const double wanted_up[3], double right[3], double up[3])
{
    double candidates[3][3] = {{wanted_up[0], wanted_up[1], wanted_up[2]}, {0, 1, 0}, {0, 0, 1}};
    for (int i = 0; i < 3; i++) {
        cross3(forward, candidates[i], right);
        double scale = sqrt(dot3(candidates[i], candidates[i]));
        if (sqrt(dot3(right, right)) > 1e-9 * scale && normalise3(right))
            break;
    }
    cross3(right, forward, up);
}

static lmn_status place_file_camera(view_camera *c, const lmn_draw_desc *desc, const pose *pose, lmn_error *error)
{
    const lmn_scene *scene = pose->scene;
    const char      *names[64];
    char             numbered[64][CAMERA_NAME_CAPACITY], capacity[CAMERA_NAME_CAPACITY];
    size_t           name_count = 0;
    for (size_t i = 0; i < scene->node_count; i++) {
        const node *n = &scene->nodes[i];
        if (n->camera < 0)
            continue;
        const camera *file = &pose->cameras[n->camera];
        const char   *name =
            scene_camera_name(scene, (size_t)n->camera, n->name, name_count < 64 ? numbered[name_count] : capacity);
        if (name_count < 64)
            names[name_count++] = name;
        if (strcmp(name, desc->camera) != 0 && !(n->name && strcmp(n->name, desc->camera) == 0))
            continue;
        const double *m = pose->worlds[i].m;
        double        right[3] = {m[0], m[1], m[2]}, up[3] = {m[4], m[5], m[6]}, forward[3] = {-m[8], -m[9], -m[10]};
        normalise3(forward);
        frame_of(forward, up, right, up);
        c->orthographic = file->orthographic;
        c->fov_y = file->fov_y > 0 ? file->fov_y : c->fov_y;
        c->half_height = file->half_height > 0 ? file->half_height : 1;
        for (int k = 0; k < 3; k++) {
            c->eye[k] = m[12 + k];
            c->target[k] = c->eye[k] + forward[k];
            c->up[k] = up[k];
        }
        set_view(c, right, up, forward);
        return LMN_OK;
    }
    lmn_status status =
        error_in_file(error, LMN_USAGE, refuse_file(scene), 0, "the scene has no camera '%s'", desc->camera);
    const char *nearest = text_nearest(desc->camera, names, name_count);
    if (nearest)
        error_hint(error, "did you mean '%s'?", nearest);
    else
        error_hint(error, name_count ? "`limner info` lists the cameras" : "the scene has no cameras at all");
    return status;
}

static lmn_status refuse_matrix(lmn_error *error, const char *which, const char *what)
{
    return error_set(error, LMN_USAGE, "the %s matrix %s", which, what);
}

/* Rows of length 1 at right angles, right-handed, and nothing but a shift beside them. */
static bool is_rigid(const double m[16])
{
    const double TOLERANCE = 1e-5;
    double       rows[3][3], across[3];
    for (int i = 0; i < 3; i++)
        for (int k = 0; k < 3; k++)
            rows[i][k] = m[4 * k + i];
    cross3(rows[0], rows[1], across);
    for (int i = 0; i < 3; i++)
        if (fabs(across[i] - rows[2][i]) > TOLERANCE || fabs(dot3(rows[i], rows[i]) - 1) > TOLERANCE)
            return false;
    return fabs(dot3(rows[0], rows[1])) <= TOLERANCE && m[3] == 0 && m[7] == 0 && m[11] == 0 && m[15] == 1;
}

/* The depths at which the projection puts −1 and 1, the smaller one first. */
static void set_limits(view_camera *c, const double p[16])
{
    double ends[2];
    for (int i = 0; i < 2; i++) {
        double ndc = i ? 1 : -1, rise = p[10] - p[11] * ndc;
        ends[i] = rise != 0 ? (p[14] - p[15] * ndc) / rise : INFINITY;
        if (!c->orthographic && !(ends[i] > 0))
            ends[i] = INFINITY;
    }
    c->limited = true;
    c->limits[0] = fmin(ends[0], ends[1]);
    c->limits[1] = fmax(ends[0], ends[1]);
}

static lmn_status place_projection(view_camera *c, const double given[16], lmn_error *error)
{
    double p[16], by = given[11] != 0 ? -given[11] : given[15];
    for (int i = 0; i < 16; i++)
        p[i] = by != 0 ? given[i] / by : 0;
    c->orthographic = given[11] == 0;
    if (!(by > 0) || p[1] != 0 || p[2] != 0 || p[3] != 0 || p[4] != 0 || p[6] != 0 || p[7] != 0 || p[10] == 0 ||
        !(p[0] > 0) || !(p[5] > 0) || (!c->orthographic && (p[12] != 0 || p[13] != 0 || p[15] != 0 || p[14] == 0)))
        return refuse_matrix(error, "projection", "is neither that of a perspective nor of parallel rays");
    if (p[8] != 0 || p[9] != 0) {
        error_set(error, LMN_UNSUPPORTED, "the projection matrix has its middle beside the picture's");
        error_hint(error, "draw a larger picture whose middle it is, of which the target shows a part");
        return LMN_UNSUPPORTED;
    }
    c->fov_y = 2 * atan(1 / p[5]);
    c->half_height = 1 / p[5];
    c->aspect = p[5] / p[0];
    set_limits(c, p);
    /* Parallel rays beside the middle are those of an eye that stands there. */
    c->view.m[12] += p[12] / p[0];
    c->view.m[13] += p[13] / p[5];
    return LMN_OK;
}

static lmn_status place_matrices(view_camera *c, const lmn_draw_desc *desc, lmn_error *error)
{
    memcpy(c->view.m, desc->view_matrix, sizeof c->view.m);
    const double *m = c->view.m;
    if (!is_rigid(m))
        return refuse_matrix(error, "view", "does more than turn and shift");
    lmn_status status = place_projection(c, desc->projection_matrix, error);
    for (int k = 0; k < 3; k++) {
        c->eye[k] = -(m[4 * k] * m[12] + m[4 * k + 1] * m[13] + m[4 * k + 2] * m[14]);
        c->up[k] = m[4 * k + 1];
        c->target[k] = c->eye[k] - m[4 * k + 2];
    }
    return status;
}

lmn_status camera_place(view_camera *c, const lmn_draw_desc *desc, const pose *pose, const fit_body *body,
                        lmn_error *error)
{
    memset(c, 0, sizeof *c);
    c->aspect = (double)desc->width / desc->height;
    c->fov_y = desc->fov_deg * (3.14159265358979323846 / 180);
    c->orthographic = desc->orthographic;
    if (desc->matrices_given)
        return place_matrices(c, desc, error);
    if (desc->camera)
        return place_file_camera(c, desc, pose, error);
    double forward[3], right[3], up[3];
    if (desc->eye_given) {
        for (int k = 0; k < 3; k++) {
            c->eye[k] = desc->eye[k];
            c->target[k] = desc->target[k];
            forward[k] = desc->target[k] - desc->eye[k];
        }
        double distance = sqrt(dot3(forward, forward));
        if (!normalise3(forward))
            return error_set(error, LMN_USAGE, "the eye and the target are at the same place");
        double wanted[3] = {desc->up[0], desc->up[1], desc->up[2]};
        if (dot3(wanted, wanted) == 0)
            wanted[pose->scene->up == 'z' ? 2 : 1] = 1;
        frame_of(forward, wanted, right, up);
        memcpy(c->up, up, sizeof up);
        /* Parallel rays show at the target what a perspective of the same angle would. */
        c->half_height = distance * tan(c->fov_y / 2);
        if (desc->fit_direction)
            fit_to(c, body, desc->fit, right, up, forward);
    } else {
        double to_eye[3], wanted[3];
        named_view(desc->view, pose->scene->up, to_eye, wanted);
        normalise3(to_eye);
        for (int k = 0; k < 3; k++)
            forward[k] = -to_eye[k];
        frame_of(forward, wanted, right, up);
        fit_to(c, body, desc->fit, right, up, forward);
    }
    set_view(c, right, up, forward);
    return LMN_OK;
}

void camera_depth_range(const view_camera *c, box3 box, double *nearest, double *farthest)
{
    double corner[8][3];
    corners_of(box, corner);
    for (int i = 0; i < 8; i++) {
        const double *m = c->view.m;
        double        depth = -(m[2] * corner[i][0] + m[6] * corner[i][1] + m[10] * corner[i][2] + m[14]);
        *nearest = fmin(*nearest, depth);
        *farthest = fmax(*farthest, depth);
    }
}

double camera_size_of(const view_camera *c, box3 box, int height)
{
    double        middle[3], eye[3], radius = box3_diagonal(box) / 2;
    const double *m = c->view.m, *p = c->projection.m;
    box3_middle(box, middle);
    for (int k = 0; k < 3; k++)
        eye[k] = m[k] * middle[0] + m[4 + k] * middle[1] + m[8 + k] * middle[2] + m[12 + k];
    double depth = -eye[2];
    /* Planes through the eye lean by 1 / projection: what lies beyond them by more than the radius is not seen. */
    for (int k = 0; k < 2; k++) {
        double scale = p[5 * k];
        double beyond = c->orthographic ? fabs(eye[k] * scale) - 1 : fabs(eye[k]) * scale - depth;
        double reach = c->orthographic ? radius * scale : radius * sqrt(scale * scale + 1);
        if (beyond > reach)
            return 0;
    }
    if (c->orthographic)
        return radius * p[5] * height;
    return depth > radius ? radius * p[5] * height / depth : depth < -radius ? 0 : INFINITY;
}

void camera_set_range(view_camera *c, double nearest, double farthest)
{
    double range = farthest - nearest, size = fmax(fabs(nearest), fabs(farthest));
    double margin = fmax(range * 1e-3, size * 1e-6);
    c->near = nearest - margin;
    c->far = farthest + margin;
    if (!c->orthographic) {
        if (!(c->far > 0) || !isfinite(c->far))
            c->far = 1; /* everything is behind the viewer */
        c->near = fmax(c->near, c->far * 1e-4);
    }
    if (c->limited) {
        c->near = fmax(c->near, c->limits[0]);
        c->far = fmin(c->far, c->limits[1]);
    }
    if (!(c->far > c->near))
        c->far = c->near + 1;
    double *m = c->projection.m;
    memset(m, 0, sizeof c->projection.m);
    if (c->orthographic) {
        m[0] = 1 / (c->half_height * c->aspect);
        m[5] = 1 / c->half_height;
        m[10] = -2 / (c->far - c->near);
        m[14] = -(c->far + c->near) / (c->far - c->near);
        m[15] = 1;
    } else {
        double t = tan(c->fov_y / 2);
        m[0] = 1 / (t * c->aspect);
        m[5] = 1 / t;
        m[10] = -(c->far + c->near) / (c->far - c->near);
        m[11] = -1;
        m[14] = -2 * c->far * c->near / (c->far - c->near);
    }
}

void camera_pixels(const view_camera *c, box3 box, int width, int height, int margin, int out[4])
{
    double corner[8][3], low[2] = {INFINITY, INFINITY}, high[2] = {-INFINITY, -INFINITY};
    corners_of(box, corner);
    mat4 both = mat4_multiply(&c->projection, &c->view);
    for (int i = 0; i < 8; i++) {
        const double *m = both.m, *p = corner[i];
        double        clip[4];
        for (int k = 0; k < 4; k++)
            clip[k] = m[k] * p[0] + m[4 + k] * p[1] + m[8 + k] * p[2] + m[12 + k];
        if (!(clip[3] > 0)) {
            out[0] = out[1] = 0;
            out[2] = width;
            out[3] = height;
            return;
        }
        for (int k = 0; k < 2; k++) {
            low[k] = fmin(low[k], clip[k] / clip[3]);
            high[k] = fmax(high[k], clip[k] / clip[3]);
        }
    }
    int size[2] = {width, height};
    for (int k = 0; k < 2; k++) {
        double first = floor((low[k] * 0.5 + 0.5) * size[k]) - margin,
               last = ceil((high[k] * 0.5 + 0.5) * size[k]) + margin;
        first = fmin(fmax(first, 0), size[k]);
        last = fmin(fmax(last, first), size[k]);
        out[k] = (int)first;
        out[2 + k] = (int)last - (int)first;
    }
}

camera_bounds camera_bounds_of(const view_camera *c, int width, int height, const int pixels[4])
{
    enum { MORE = 2 };
    const mat4    both = mat4_multiply(&c->projection, &c->view);
    const int     size[2] = {width, height};
    camera_bounds out;
    for (int k = 0; k < 2; k++) {
        bool   whole = pixels[2] <= 0;
        double low = whole ? 0 : pixels[k], high = whole ? size[k] : pixels[k] + pixels[2 + k];
        double ends[2] = {2 * (low - MORE) / size[k] - 1, 2 * (high + MORE) / size[k] - 1};
        for (int i = 0; i < 4; i++) {
            double across = both.m[4 * i + k], along = both.m[4 * i + 3];
            out.planes[2 * k][i] = across - ends[0] * along;
            out.planes[2 * k + 1][i] = ends[1] * along - across;
        }
    }
    return out;
}

bool camera_bounds_meet(const camera_bounds *b, box3 box)
{
    for (int i = 0; i < 4; i++) {
        const double *p = b->planes[i];
        double        most = p[3] + p[0] * (double)(p[0] > 0 ? box.max.x : box.min.x) +
                      p[1] * (double)(p[1] > 0 ? box.max.y : box.min.y) +
                      p[2] * (double)(p[2] > 0 ? box.max.z : box.min.z);
        if (most < 0)
            return false;
    }
    return true;
}

void camera_widen_pixels(int box[4], const int other[4])
{
    for (int k = 0; k < 2; k++) {
        int low = other[k] < box[k] ? other[k] : box[k], high = other[k] + other[2 + k], own = box[k] + box[2 + k];
        box[2 + k] = (high > own ? high : own) - low;
        box[k] = low;
    }
}
