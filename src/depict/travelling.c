/* What a camera follows: the background is streaks along its way, the target sharp before them. Nienhaus 2005, section
 * 7.10, figure 7-10. */
#include "base/error.h"
#include "base/memory.h"
#include "depict/page.h"

typedef struct travelling_values {
    int32_t count;
    float   width, length, reach, gap;
    colour  colour;
} travelling_values;

static const param travelling_params[] = {
    PARAM_INT_ROW(travelling_values, count, .def = 30, .min = 1, .max = 400, .soft_max = 80, .unit = UNIT_COUNT,
                  .doc = "How many streaks."),
    PARAM_FLOAT_ROW(travelling_values, width, .def = 0.05, .min = 0.001, .max = 2, .soft_max = 0.3,
                    .unit = UNIT_FRACTION, .doc = "Breadth where they begin, fraction of the target's radius."),
    PARAM_FLOAT_ROW(travelling_values, length, .def = 5, .min = 0.01, .max = 100, .soft_max = 10, .unit = UNIT_FRACTION,
                    .doc = "The longest ones' length, in radii."),
    PARAM_FLOAT_ROW(travelling_values, reach, .def = 4, .min = 0.1, .max = 100, .soft_max = 10, .unit = UNIT_FRACTION,
                    .doc = "How far from the target's middle there are streaks, in radii."),
    PARAM_FLOAT_ROW(travelling_values, gap, .def = 1.5, .min = 0, .max = 100, .soft_max = 10, .unit = UNIT_FRACTION,
                    .doc = "How far behind the target they lie, in radii."),
    PARAM_COLOUR_ROW(travelling_values, colour, .def_colour = {0.55f, 0.57f, 0.62f, 1}, .doc = "Of the streaks."),
};

/* In rows of the page, so that none lies on another; each somewhere along its row. */
static void put_streak(glyph_mesh *m, const depict_job *j, const expression *e, const page_place *place,
                       const double along[2], double radius, uint32_t which)
{
    const travelling_values *v = e->values;
    const double             reach = (double)v->reach * radius,
                 row = (which + 0.15 + 0.7 * depict_random(j, e, which, 0)) / v->count,
                 up = (2 * row - 1) * reach * 0.8,
                 length = (double)v->length * radius * (0.35 + 0.65 * depict_random(j, e, which, 1)),
                 begin = (2 * depict_random(j, e, which, 2) - 1) * reach + length / 2;
    double points[3][3], widths[3] = {0, (double)v->width * radius, 0};
    /* Thickest near the front, thin where it trails. */
    for (int i = 0; i < 3; i++) {
        const double at = begin - length * (i == 0 ? 0 : i == 1 ? 0.2 : 1);
        page_point(place, at * along[0] - up * along[1], at * along[1] + up * along[0], points[i]);
    }
    glyph_put_ribbon(m, j, &(glyph_ribbon){(const double(*)[3])points, widths, 3});
}

static lmn_status travelling_depict(depict_job *j, const expression *e, lmn_error *error)
{
    const travelling_values *v = e->values;
    depict_target            t;
    glyph_mesh               m = {0};
    page_place               place;
    double                   velocity[3], at[3], along[2];
    lmn_status               status = target_open(&t, j, e->target, error);
    if (status == LMN_OK) {
        way_point(&t.way, t.centre, e->now, at);
        way_velocity(&t.way, t.centre, e->now, 1.0 / 30, velocity);
        page_place_at(&place, j, at, -(double)v->gap * t.radius);
        along[0] = vector3_dot(velocity, place.right);
        along[1] = vector3_dot(velocity, place.up);
        const double speed = hypot(along[0], along[1]);
        along[0] /= speed > 0 ? speed : 1;
        along[1] /= speed > 0 ? speed : 1;
        for (int i = 0; i < v->count && speed > 1e-9 * t.radius; i++)
            put_streak(&m, j, e, &place, along, t.radius, (uint32_t)i);
        status = glyph_put(j, &m, &(glyph_label){"streaks", e->target, GLYPH_PRESENT, v->colour}, error);
    }
    glyph_mesh_release(&m);
    target_release(&t);
    return status;
}

const depiction depiction_travelling = {
    "travelling",
    NULL,
    "Streaks behind the target, in depth, along its way: it stays where it is on the page, what is behind it passes.",
    travelling_params,
    PARAM_COUNT(travelling_params),
    sizeof(travelling_values),
    false,
    travelling_depict,
};
