/* Speech and thought: a balloon beside the head whose tail ends at the mouth, or a cloud with circles towards it.
 * Nienhaus 2005, section 7.9, figures 7-6 and 7-10. */
#include "base/error.h"
#include "base/memory.h"
#include "depict/page.h"
#include "pose/face.h"

typedef struct balloon_values {
    param_words text;
    int32_t     side, letters;
    float       size, distance;
    colour      colour, ink;
} balloon_values;

static const char *const sides[] = {"auto", "left", "right", NULL};
enum { SIDE_AUTO, SIDE_LEFT };

static const param balloon_params[] = {
    PARAM_TEXT_ROW(balloon_values, text, .def_text = "…", .example = "Look!|There it goes.",
                   .doc = "What is said or thought; \"|\" begins a line."),
    PARAM_ENUM_ROW(balloon_values, side, .names = sides, .def = SIDE_AUTO,
                   .doc =
                       "Of the head on which it lies; auto: where the target looks, right if it looks at the viewer."),
    PARAM_INT_ROW(balloon_values, letters, .def = 14, .min = 0, .max = 200, .soft_max = 40, .unit = UNIT_COUNT,
                  .doc = "A longer line is broken between words; 0: none is."),
    PARAM_FLOAT_ROW(
        balloon_values, size, .def = 0.035, .min = 0.001, .max = 10, .soft_max = 0.2, .unit = UNIT_FRACTION,
        .doc = "Height of a capital, share of the scene's size; where the viewer stays where it is, of the page's "
               "height at the head."),
    PARAM_FLOAT_ROW(balloon_values, distance, .def = 1, .min = 0, .max = 20, .soft_max = 4, .unit = UNIT_FRACTION,
                    .doc = "From the head, in its radii."),
    PARAM_COLOUR_ROW(balloon_values, colour, .def_colour = {1, 1, 1, 1}, .doc = "Of the balloon."),
    PARAM_COLOUR_ROW(balloon_values, ink, .def_colour = {0.1f, 0.11f, 0.14f, 1}, .doc = "Of letters."),
};

enum { RIM_POINTS = 96, TAIL_HALF = 3 };
static const double full_turn = 6.283185307179586;

/* Rounder than a box, fuller than an ellipse. */
static void rim_point(double half_width, double half_height, double angle, double out[2])
{
    const double c = cos(angle), s = sin(angle), full = pow(pow(fabs(c), 2.6) + pow(fabs(s), 2.6), -1 / 2.6);
    out[0] = half_width * full * c;
    out[1] = half_height * full * s;
}

/* The rim, with a tail drawn out of it to a place: one polygon. The tail is star-shaped around the middle. */
static void put_speech(glyph_mesh *m, const page_place *p, double half_width, double half_height, const double tip[2])
{
    double points[RIM_POINTS][2], toward = atan2(tip[1] / half_height, tip[0] / half_width);
    size_t count = 0;
    for (int i = TAIL_HALF; i <= RIM_POINTS - TAIL_HALF; i++)
        rim_point(half_width, half_height, toward + full_turn * i / RIM_POINTS, points[count++]);
    points[count][0] = tip[0];
    points[count++][1] = tip[1];
    glyph_put_polygon(m, p, (const double(*)[2])points, count);
}

/* Smaller and smaller from the cloud's rim to the head. */
static void put_thought(glyph_mesh *m, const page_place *p, double half_width, double half_height, const double tip[2])
{
    const double angle = atan2(tip[1] / half_height, tip[0] / half_width), small = 0.22 * half_height;
    double       rim[2], points[32][2];
    glyph_put_cloud(m, p, half_width * 1.12, half_height * 1.2, 11);
    rim_point(half_width * 1.2, half_height * 1.3, angle, rim);
    for (int k = 0; k < 3; k++) {
        const double f = (k + 0.6) / 3, radius = small * (1 - 0.28 * k);
        page_place   own = *p;
        page_point(p, rim[0] + (tip[0] - rim[0]) * f, rim[1] + (tip[1] - rim[1]) * f, own.at);
        for (int i = 0; i < 32; i++) {
            points[i][0] = 1.2 * radius * cos(full_turn * i / 32);
            points[i][1] = radius * sin(full_turn * i / 32);
        }
        glyph_put_polygon(m, &own, (const double(*)[2])points, 32);
    }
}

/* To the left of the page: −1, to the right: 1. */
static double side_of(const depict_job *j, const expression *e, const face *where)
{
    const balloon_values *v = e->values;
    double                right[3], up[3];
    depict_page_axes(j, right, up);
    if (v->side != SIDE_AUTO)
        return v->side == SIDE_LEFT ? -1 : 1;
    return vector3_dot(where->gaze, right) < -0.3 ? -1 : 1;
}

/* Beside and above the head, `side` to the right of it. */
static void beside_head(const depict_job *j, const expression *e, const face *where, double side, const double half[2],
                        double out[3])
{
    const balloon_values *v = e->values;
    const double          away = where->radius * (1 + (double)v->distance);
    double                right[3], up[3];
    depict_page_axes(j, right, up);
    vector3_add(out, where->head, side * (away * 0.7 + half[0]), right);
    vector3_add(out, out, away * 0.9 + half[1], up);
}

/* Into the page, where the viewer does not step back for it; how far it was from that. */
static double bring_inside(const depict_job *j, double at[3], const double half[2])
{
    const double depth = page_depth_of(j, at), page = page_height(j, at) / 2,
                 size[2] = {half[0] / page, half[1] / page};
    double middle[2];
    if (!page_seen_at(j, at, middle))
        return INFINITY;
    const double moved = page_keep_inside(j, middle, size);
    page_position(j, middle, depth, at);
    return moved;
}

/* At the side that is wanted, or where it would leave the page, at the other one if it has more room there. */
static void place_balloon(const depict_job *j, const expression *e, const face *where, const double half[2],
                          double out[3])
{
    const balloon_values *v = e->values;
    const double          side = side_of(j, e, where);
    double                other[3];
    beside_head(j, e, where, side, half, out);
    beside_head(j, e, where, -side, half, other);
    if (bring_inside(j, out, half) > 2 * bring_inside(j, other, half) && v->side == SIDE_AUTO)
        vector3_copy(out, other);
}

static lmn_status put_balloon(depict_job *j, const expression *e, const face *where, bool thought, lmn_error *error)
{
    const balloon_values *v = e->values;
    const double          height = (double)v->size * (j->fixed_view ? page_height(j, where->head) : j->size),
                 lift = depict_front(j, where->head);
    const lettering_style words = {v->text.text, v->letters, height, 0};
    glyph_mesh            letters = {0}, balloon = {0};
    page_place            place, behind;
    double                size[2], middle[3], tip[2];
    /* How much room the words need, wherever they are. */
    page_place_at(&place, j, where->head, lift);
    lmn_status status = glyph_put_lettering(&letters, j, &place, &words, size, error);
    glyph_mesh_release(&letters);
    if (status != LMN_OK)
        return status;
    const double half[2] = {size[0] * 0.62 + height * 1.1, size[1] * 0.66 + height * 1.1};
    place_balloon(j, e, where, half, middle);
    page_place_at(&behind, j, middle, lift);
    page_place_at(&place, j, middle, lift + 0.2 * height);
    status = glyph_put_lettering(&letters, j, &place, &words, size, error);
    /* The tip is seen at the mouth. */
    page_place_at(&place, j, thought ? where->head : where->mouth, lift);
    page_offset(&behind, place.at, tip);
    if (thought) { /* outside the head */
        const double f = 1 - fmin(0.6, 1.3 * where->radius / fmax(hypot(tip[0], tip[1]), 1e-9));
        tip[0] *= f;
        tip[1] *= f;
        put_thought(&balloon, &behind, half[0], half[1], tip);
    } else
        put_speech(&balloon, &behind, half[0], half[1], tip);
    if (status == LMN_OK)
        status = glyph_put(j, &balloon, &(glyph_label){"balloon", e->target, GLYPH_PRESENT, v->colour}, error);
    if (status == LMN_OK)
        status = glyph_put(j, &letters, &(glyph_label){"words", e->target, GLYPH_PRESENT, v->ink}, error);
    glyph_mesh_release(&letters);
    glyph_mesh_release(&balloon);
    return status;
}

static lmn_status balloon_depict(depict_job *j, const expression *e, bool thought, lmn_error *error)
{
    depict_target t;
    face          where;
    const pose   *p = NULL;
    double        middle[3];
    lmn_status    status = target_open(&t, j, e->target, error);
    if (status == LMN_OK)
        status = depict_pose(&p, j, e->now, error);
    if (status == LMN_OK) {
        way_point(&t.way, t.centre, e->now, middle);
        status = face_find(&where, p, e->target, middle, t.radius, error);
    }
    if (status == LMN_OK)
        status = put_balloon(j, e, &where, thought, error);
    target_release(&t);
    return status;
}

static lmn_status speech_depict(depict_job *j, const expression *e, lmn_error *error)
{
    return balloon_depict(j, e, false, error);
}

static lmn_status thought_depict(depict_job *j, const expression *e, lmn_error *error)
{
    return balloon_depict(j, e, true, error);
}

const depiction depiction_speech = {
    "speech",
    NULL,
    "A balloon with what the target says, its tail at the mouth: at a node below it called mouth or jaw, else at the "
    "front of one called head, else on top of all.",
    balloon_params,
    PARAM_COUNT(balloon_params),
    sizeof(balloon_values),
    false,
    speech_depict,
};

const depiction depiction_thought = {
    "thought",
    NULL,
    "A cloud with what the target thinks, with smaller and smaller circles towards its head.",
    balloon_params,
    PARAM_COUNT(balloon_params),
    sizeof(balloon_values),
    false,
    thought_depict,
};
