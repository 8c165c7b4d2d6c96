/* Where a camera goes: frames that show how much it sees, joined along the ways of their corners, or with arrows from
 * one to the next. Nienhaus 2005, section 7.9, figure 7-8. */
#include "base/error.h"
#include "base/memory.h"
#include "depict/page.h"
#include "depict/camera_shot.h"

typedef struct camera_values {
    int32_t count;
    float   focus, width;
    colour  colour;
} camera_values;

#define CAMERA_ROWS(DEFAULT_COUNT)                                                                                     \
    PARAM_INT_ROW(camera_values, count, .def = DEFAULT_COUNT, .min = 2, .max = 64, .soft_max = 16, .unit = UNIT_COUNT, \
                  .doc = "How many frames, at equal times from the interval's begin to its end."),                     \
        PARAM_FLOAT_ROW(camera_values, focus, .def = 0, .min = 0, .max = 1e6, .soft_max = 100,                         \
                        .doc = "How far before the camera a frame stands, units; it is so large that the camera sees " \
                               "just all of it; 0: a fifth of the way to the middle of the scene."),                   \
        PARAM_FLOAT_ROW(camera_values, width, .def = 0.1, .min = 0.001, .max = 1, .soft_max = 0.3,                     \
                        .unit = UNIT_FRACTION, .doc = "Breadth of a frame's bars, share of its height."),              \
        PARAM_COLOUR_ROW(camera_values, colour, .def_colour = {0, 0, 0, 0},                                            \
                         .doc = "Of frames and lines; none: grey for the past, orange for now, red for the future.")

static const param path_params[] = {CAMERA_ROWS(5)};
static const param flow_params[] = {CAMERA_ROWS(3)};

static const double corners[4][2] = {{-1, -1}, {1, -1}, {1, 1}, {-1, 1}};

static glyph_tense tense_of(const expression *e, double seconds, double slack)
{
    return fabs(seconds - e->now) <= slack ? GLYPH_PRESENT : seconds < e->now ? GLYPH_PAST : GLYPH_FUTURE;
}

/* A frame right before a viewer who does not step back: none of its corners is on the page, only bars would be. */
static bool is_beyond_page(const depict_job *j, const camera_shot *s, double seconds)
{
    for (int i = 0; i < 4 && j->fixed_view; i++) {
        double at[3], page[2];
        camera_shot_point(s, seconds, corners[i][0], corners[i][1], at);
        if (page_seen_at(j, at, page) && fabs(page[0]) < j->camera.aspect && fabs(page[1]) < 1)
            return false;
    }
    return j->fixed_view;
}

/* Four bars around what is seen: the inner corners are those of the view. */
static lmn_status put_frame(depict_job *j, const expression *e, const camera_shot *s, double seconds, lmn_error *error)
{
    const camera_values *v = e->values;
    glyph_mesh           m = {0};
    const double         bar = 2 * (double)v->width;
    uint32_t             vertices[8];
    if (is_beyond_page(j, s, seconds))
        return LMN_OK;
    for (int i = 0; i < 8; i++) {
        const double *c = corners[i % 4], out = i < 4 ? 0 : bar;
        double        at[3];
        camera_shot_point(s, seconds, c[0] * (1 + out / s->aspect), c[1] * (1 + out), at);
        vertices[i] = glyph_vertex(&m, at);
    }
    for (int i = 0; i < 4; i++) {
        const int next = (i + 1) % 4;
        glyph_triangle(&m, vertices[i], vertices[4 + i], vertices[4 + next]);
        glyph_triangle(&m, vertices[i], vertices[4 + next], vertices[next]);
    }
    const glyph_tense when = tense_of(e, seconds, (e->to - e->from) / (2 * v->count));
    lmn_status status = glyph_put(j, &m, &(glyph_label){"frame", e->target, when, depict_tint(when, v->colour)}, error);
    glyph_mesh_release(&m);
    return status;
}

/* The ways of the corners of all frames. */
static lmn_status put_rails(depict_job *j, const expression *e, const camera_shot *s, double from, double to,
                            glyph_tense when, lmn_error *error)
{
    enum { STEPS = 96 };
    const camera_values *v = e->values;
    glyph_mesh           m = {0};
    double               points[STEPS + 1][3], widths[STEPS + 1];
    if (is_beyond_page(j, s, from) && is_beyond_page(j, s, to))
        return LMN_OK;
    for (int k = 0; k < 4; k++) {
        for (int i = 0; i <= STEPS; i++) {
            camera_shot_point(s, from + (to - from) * i / STEPS, corners[k][0], corners[k][1], points[i]);
            widths[i] = 0.4 * (double)v->width * camera_shot_height(s);
        }
        glyph_put_ribbon(&m, j, &(glyph_ribbon){(const double(*)[3])points, widths, STEPS + 1});
    }
    lmn_status status = glyph_put(j, &m, &(glyph_label){"rails", e->target, when, depict_tint(when, v->colour)}, error);
    glyph_mesh_release(&m);
    return status;
}

static lmn_status put_frames(depict_job *j, const expression *e, const camera_shot *s, lmn_error *error)
{
    const camera_values *v = e->values;
    lmn_status           status = LMN_OK;
    for (int i = 0; i < v->count && status == LMN_OK; i++)
        status = put_frame(j, e, s, e->from + (e->to - e->from) * i / (v->count - 1), error);
    return status;
}

static lmn_status camera_path_depict(depict_job *j, const expression *e, lmn_error *error)
{
    const camera_values *v = e->values;
    camera_shot          s;
    lmn_status           status = camera_shot_open(&s, j, e, (double)v->focus, error);
    const double         split = fmin(fmax(e->now, e->from), e->to);
    if (status == LMN_OK)
        status = put_frames(j, e, &s, error);
    if (status == LMN_OK && split > e->from)
        status = put_rails(j, e, &s, e->from, split, GLYPH_PAST, error);
    if (status == LMN_OK && split < e->to)
        status = put_rails(j, e, &s, split, e->to, GLYPH_FUTURE, error);
    camera_shot_release(&s);
    return status;
}

/* What of the way from the middle of one frame to that of the next lies within a time: dashed where it is to come; a
 * head where it ends. */
static lmn_status put_flow_part(depict_job *j, const expression *e, const camera_shot *s, double from, double to,
                                glyph_tense when, bool ends, lmn_error *error)
{
    enum { STEPS = 32 };
    const camera_values *v = e->values;
    const double         width = 1.2 * (double)v->width * camera_shot_height(s);
    glyph_mesh           m = {0};
    double               points[STEPS + 1][3];
    for (int i = 0; i <= STEPS; i++)
        camera_shot_point(s, from + (to - from) * i / STEPS, 0, 0, points[i]);
    glyph_put_arrow(&m, j, (const double(*)[3])points, STEPS + 1,
                    &(arrow_style){.width = width,
                                   .dash = when == GLYPH_FUTURE ? 1.2 * width : 0,
                                   .gap = 0.7 * width,
                                   .tail = when == GLYPH_FUTURE ? 1 : 0.5,
                                   .head = ends ? 2.4 : 0});
    lmn_status status =
        glyph_put(j, &m, &(glyph_label){"flow-arrow", e->target, when, depict_tint(when, v->colour)}, error);
    glyph_mesh_release(&m);
    return status;
}

static lmn_status put_flow(depict_job *j, const expression *e, const camera_shot *s, double from, double to,
                           lmn_error *error)
{
    const double now = fmin(fmax(e->now, from), to);
    lmn_status   status = LMN_OK;
    if (now > from)
        status = put_flow_part(j, e, s, from, now, GLYPH_PAST, now >= to, error);
    if (now < to && status == LMN_OK)
        status = put_flow_part(j, e, s, now, to, GLYPH_FUTURE, true, error);
    return status;
}

static lmn_status shot_flow_depict(depict_job *j, const expression *e, lmn_error *error)
{
    const camera_values *v = e->values;
    camera_shot          s;
    lmn_status           status = camera_shot_open(&s, j, e, (double)v->focus, error);
    const double         step = (e->to - e->from) / (v->count - 1);
    if (status == LMN_OK)
        status = put_frames(j, e, &s, error);
    for (int i = 0; i + 1 < v->count && status == LMN_OK; i++)
        status = put_flow(j, e, &s, e->from + step * i, e->from + step * (i + 1), error);
    camera_shot_release(&s);
    return status;
}

const depiction depiction_camera_path = {
    "camera-path",
    NULL,
    "Frames of what a camera sees at several times, joined along the ways of their corners.",
    path_params,
    PARAM_COUNT(path_params),
    sizeof(camera_values),
    false,
    camera_path_depict,
};

const depiction depiction_shot_flow = {
    "shot-flow",
    NULL,
    "Frames of what a camera sees at several times, with arrows from one to the next.",
    flow_params,
    PARAM_COUNT(flow_params),
    sizeof(camera_values),
    false,
    shot_flow_depict,
};
