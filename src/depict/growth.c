/* What grows or shrinks: arrows from its middle to the outline that it will have, or from the one that it has had.
 * Nienhaus 2005, section 7.10. */
#include "base/error.h"
#include "base/memory.h"
#include "depict/page.h"

typedef struct growth_values {
    int32_t count;
    float   width, inner;
    colour  colour;
} growth_values;

static const param growth_params[] = {
    PARAM_INT_ROW(growth_values, count, .def = 8, .min = 2, .max = 64, .soft_max = 16, .unit = UNIT_COUNT,
                  .doc = "How many arrows."),
    PARAM_FLOAT_ROW(
        growth_values, width, .def = 0.2, .min = 0.001, .max = 10, .soft_max = 1, .unit = UNIT_FRACTION,
        .doc = "Breadth of an arrow at its head, fraction of the target's radius; less where heads would touch."),
    PARAM_FLOAT_ROW(growth_values, inner, .def = 0.35, .min = 0, .max = 0.95, .unit = UNIT_FRACTION,
                    .doc = "Distance of the arrows' inner ends from the middle, share of the smaller outline."),
    PARAM_COLOUR_ROW(growth_values, colour, .def_colour = {0.2f, 0.5f, 0.78f, 1}, .doc = "Of the arrows."),
};

enum { DIRECTIONS = 180, ARROWS_MOST = 64 };
static const double full_turn = 6.283185307179586;

/* How far the outline, seen on the page, lies from the middle. */
typedef struct outline {
    double reach[DIRECTIONS]; /* of half planes that hold all of it */
} outline;

static lmn_status outline_find(outline *o, const depict_job *j, const depict_target *t, double seconds,
                               lmn_error *error)
{
    vec3      *vertices;
    size_t     count;
    page_place place;
    double     middle[3];
    lmn_status status = target_vertices(&vertices, &count, j, t, seconds, error);
    way_point(&t->way, t->centre, seconds, middle);
    page_place_at(&place, j, middle, 0);
    for (int k = 0; k < DIRECTIONS; k++)
        o->reach[k] = 0;
    for (size_t i = 0; i < count && status == LMN_OK; i++) {
        double at[3] = {(double)vertices[i].x, (double)vertices[i].y, (double)vertices[i].z}, p[2];
        page_offset(&place, at, p);
        for (int k = 0; k < DIRECTIONS; k++) {
            const double angle = full_turn * k / DIRECTIONS;
            o->reach[k] = fmax(o->reach[k], p[0] * cos(angle) + p[1] * sin(angle));
        }
    }
    mem_free(vertices);
    return status;
}

/* How far the distance of any vertex from the middle of all changes: what only moves and turns keeps these. */
static lmn_status deformation_find(double *out, const depict_job *j, const expression *e, const depict_target *t,
                                   lmn_error *error)
{
    const double times[2] = {e->from, e->to};
    vec3        *vertices[2] = {NULL, NULL};
    size_t       counts[2] = {0, 0};
    double       middles[2][3] = {{0}};
    lmn_status   status = LMN_OK;
    for (int i = 0; i < 2 && status == LMN_OK; i++)
        status = target_vertices(&vertices[i], &counts[i], j, t, times[i], error);
    for (int i = 0; i < 2; i++)
        for (size_t k = 0; k < counts[i]; k++) {
            const double at[3] = {(double)vertices[i][k].x, (double)vertices[i][k].y, (double)vertices[i][k].z};
            vector3_add(middles[i], middles[i], 1.0 / (double)counts[i], at);
        }
    *out = 0;
    for (size_t k = 0; k < counts[0] && k < counts[1]; k++) {
        double far[2];
        for (int i = 0; i < 2; i++) {
            const double at[3] = {(double)vertices[i][k].x, (double)vertices[i][k].y, (double)vertices[i][k].z};
            far[i] = vector3_distance(at, middles[i]);
        }
        *out = fmax(*out, fabs(far[1] - far[0]));
    }
    mem_free(vertices[0]);
    mem_free(vertices[1]);
    return status;
}

/* Along a ray from the middle: where the first half plane ends. */
static double outline_at(const outline *o, double angle)
{
    double nearest = INFINITY;
    for (int k = 0; k < DIRECTIONS; k++) {
        const double slant = cos(full_turn * k / DIRECTIONS - angle);
        if (slant > 1e-6)
            nearest = fmin(nearest, o->reach[k] / slant);
    }
    return isfinite(nearest) ? nearest : 0;
}

/* None where hardly anything of the change is. */
static void put_growth_arrow(glyph_mesh *m, const depict_job *j, const expression *e, const depict_target *t,
                             const page_place *place, const outline ends[2], double change, double angle, bool outward)
{
    const growth_values *v = e->values;
    const double         before = outline_at(&ends[0], angle), after = outline_at(&ends[1], angle);
    if ((after - before) * (outward ? 1 : -1) < 0.2 * change)
        return;
    const double outer = fmax(before, after);
    /* What comes from nothing, or vanishes, leaves room in the middle for the heads. */
    const double inner = fmax((double)v->inner * fmin(before, after), 0.15 * outer);
    /* Heads, 2.6 breadths across, must not lie on those beside them. */
    const double room = full_turn / v->count * (outward ? outer * 0.8 : inner * 1.4) / 2.6 * 0.8,
                 width = fmin((double)v->width * t->radius, room);
    double points[2][3];
    for (int i = 0; i < 2; i++) {
        const double far = (i == 0) == outward ? inner : outer;
        page_point(place, cos(angle) * far, sin(angle) * far, points[i]);
    }
    glyph_put_arrow(m, j, (const double(*)[3])points, 2, &(arrow_style){.width = width, .tail = 0.12, .head = 2.2});
}

/* How far the outline goes outward, or inward, where it does so most. */
static double largest_change(const outline ends[2], bool outward)
{
    double most = 0;
    for (int k = 0; k < DIRECTIONS; k++) {
        const double angle = full_turn * k / DIRECTIONS,
                     more = outline_at(&ends[1], angle) - outline_at(&ends[0], angle);
        most = fmax(most, outward ? more : -more);
    }
    return most;
}

/* What keeps its shape, or changes the other way. */
static void say_unchanged(depict_job *j, const expression *e, bool rigid, bool outward)
{
    if (rigid)
        depict_say_nothing(j, "it is as large at %g s as at %g s", e->to, e->from);
    else
        depict_say_nothing(j, "from %g to %g s it only %s, which is told by '%s'", e->from, e->to,
                           outward ? "shrinks" : "grows", outward ? "collapse" : "expand");
}

/* Arrows are where the target is now, of the outlines that it has at the interval's two ends. */
static lmn_status growth_depict(depict_job *j, const expression *e, bool outward, lmn_error *error)
{
    const growth_values *v = e->values;
    depict_target        t;
    outline              ends[2];
    page_place           place;
    double               middle[3];
    glyph_mesh           m = {0};
    lmn_status           status = target_open(&t, j, e->target, error);
    if (status == LMN_OK)
        status = outline_find(&ends[0], j, &t, e->from, error);
    if (status == LMN_OK)
        status = outline_find(&ends[1], j, &t, e->to, error);
    if (status == LMN_OK) {
        way_point(&t.way, t.centre, e->now, middle);
        page_place_at(&place, j, middle, depict_front(j, middle));
    }
    double deformed = 0;
    if (status == LMN_OK)
        status = deformation_find(&deformed, j, e, &t, error);
    const bool   rigid = deformed <= 1e-3 * t.radius;
    const double change = status == LMN_OK && !rigid ? largest_change(ends, outward) : 0,
                 least = 1e-3 * t.radius; /* nobody sees less */
    if (status == LMN_OK && change <= least)
        say_unchanged(j, e, rigid, outward);
    for (int i = 0; i < v->count && status == LMN_OK && change > least; i++)
        put_growth_arrow(&m, j, e, &t, &place, ends, change, full_turn * (i + 0.5) / v->count, outward);
    if (status == LMN_OK)
        status = glyph_put(j, &m, &(glyph_label){outward ? "expand" : "collapse", e->target, GLYPH_PRESENT, v->colour},
                           error);
    glyph_mesh_release(&m);
    target_release(&t);
    return status;
}

static lmn_status expand_depict(depict_job *j, const expression *e, lmn_error *error)
{
    return growth_depict(j, e, true, error);
}

static lmn_status collapse_depict(depict_job *j, const expression *e, lmn_error *error)
{
    return growth_depict(j, e, false, error);
}

const depiction depiction_expand = {
    "expand",
    NULL,
    "Arrows from the target's middle outward that widen and end at the outline that it has when the interval ends; of "
    "what moves on as well, carried along to where it is now.",
    growth_params,
    PARAM_COUNT(growth_params),
    sizeof(growth_values),
    false,
    expand_depict,
};

const depiction depiction_collapse = {
    "collapse",
    NULL,
    "Arrows inward from the outline that the target has when the interval begins.",
    growth_params,
    PARAM_COUNT(growth_params),
    sizeof(growth_values),
    false,
    collapse_depict,
};
