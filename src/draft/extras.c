#include "draft/extras.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "base/text.h"
#include "base/vector3.h"
#include "plan/camera.h"

static const char letters[] = "ABCDEFGHJKLMNPRSTUVWXYZ"; /* without I, O and Q (ISO 128-3) */

typedef struct reader {
    const char *at, *end, *what, *form; /* end: of this one of the list */
    box3        bounds;
    lmn_error  *error;
} reader;

static lmn_status wrong(const reader *r, const char *why)
{
    error_set(r->error, LMN_USAGE, "the %s is '%.*s'; %s", r->what, (int)(r->end - r->at > 60 ? 60 : r->end - r->at),
              r->at, why);
    error_hint(r->error, "%s", r->form);
    return LMN_USAGE;
}

static double side(const reader *r, int axis, bool high)
{
    return (double)*((high ? &r->bounds.max.x : &r->bounds.min.x) + axis);
}

/* A number, or a percentage of the model along an axis; the end of it, NULL: neither. */
static const char *read_place(const reader *r, const char *at, int axis, double *out)
{
    at = text_parse_double(at, r->end, out);
    if (!at || !isfinite(*out))
        return NULL;
    if (at < r->end && *at == '%') {
        *out = side(r, axis, false) + *out / 100 * (side(r, axis, true) - side(r, axis, false));
        at++;
    }
    return at;
}

static int axis_of(const double a[3])
{
    return fabs(a[0]) > 0.5 ? 0 : fabs(a[1]) > 0.5 ? 1 : 2;
}

int draft_section_axis(const draft_extra *e)
{
    return axis_of(e->axes[e->kind == DRAFT_REVOLVED ? 0 : 2]);
}

/* The view that a text begins with; the end of its name. */
static const char *read_view(const reader *r, const char *at, lmn_view *out)
{
    static const struct {
        const char *name;
        lmn_view    view;
    } views[] = {{"front", LMN_VIEW_FRONT}, {"back", LMN_VIEW_BACK}, {"left", LMN_VIEW_LEFT},
                 {"right", LMN_VIEW_RIGHT}, {"top", LMN_VIEW_TOP},   {"bottom", LMN_VIEW_BOTTOM}};
    for (size_t i = 0; i < sizeof views / sizeof *views; i++) {
        size_t length = strlen(views[i].name);
        if ((size_t)(r->end - at) >= length && strncmp(at, views[i].name, length) == 0 &&
            (at + length == r->end || at[length] == '@')) {
            *out = views[i].view;
            return at + length;
        }
    }
    return NULL;
}

/* --- what lies beside the model --------------------------------------------------------------------------- */

/* A plane of a section that cuts nothing: the drawing would lack what it was asked for. */
static lmn_status check_plane(const reader *r, int axis, double place)
{
    double low = side(r, axis, false), high = side(r, axis, true);
    if (box3_is_empty(r->bounds) || (place > low && place < high))
        return LMN_OK;
    error_set(r->error, LMN_USAGE, "section '%.*s': nothing is cut by the plane %c = %g",
              (int)(r->end - r->at > 60 ? 60 : r->end - r->at), r->at, 'x' + axis, place);
    error_hint(r->error, "the model reaches from %g to %g along %c; percentages of that are places, too (50%%)", low,
               high, 'x' + axis);
    return LMN_USAGE;
}

/* The circle of a detail in which there is nothing: the box of the model, seen along the view, is farther away. */
static lmn_status check_circle(const reader *r, const draft_extra *e)
{
    double away = 0;
    for (int k = 0; k < 3; k++) {
        double beside = fmax(fmax(side(r, k, false) - e->at[k], e->at[k] - side(r, k, true)), 0);
        away = k == axis_of(e->axes[2]) ? away : hypot(away, beside);
    }
    if (box3_is_empty(r->bounds) || away < e->radius)
        return LMN_OK;
    error_set(r->error, LMN_USAGE, "detail '%.*s': nothing of the model lies in the circle",
              (int)(r->end - r->at > 60 ? 60 : r->end - r->at), r->at);
    error_hint(r->error, "the model reaches x from %g to %g, y from %g to %g, z from %g to %g", side(r, 0, false),
               side(r, 0, true), side(r, 1, false), side(r, 1, true), side(r, 2, false), side(r, 2, true));
    return LMN_USAGE;
}

/* --- sections ------------------------------------------------------------------------------------------- */

/* What lies towards the eye of each depth, between the turns beside it. */
static void write_cut(draft_extra *e, const reader *r)
{
    int    depth = axis_of(e->axes[2]), across = axis_of(e->axes[0]);
    bool   forward = e->axes[2][depth] > 0, rightward = e->axes[0][across] > 0;
    double size = box3_diagonal(r->bounds);
    size_t used = 0;
    if (e->depth_count == 1 && !e->half) {
        snprintf(e->cut, sizeof e->cut, "%s%c=%.17g", forward ? "" : "-", 'x' + depth, e->depths[0]);
        return;
    }
    for (size_t i = e->half ? 1 : 0; i < e->depth_count + e->half; i++) {
        double low[3], high[3];
        for (int k = 0; k < 3; k++) {
            low[k] = side(r, k, false) - size;
            high[k] = side(r, k, true) + size;
        }
        *(forward ? &low[depth] : &high[depth]) = e->depths[e->half ? 0 : i];
        if (i > 0)
            *(rightward ? &low[across] : &high[across]) = e->turns[i - 1];
        if (i + 1 < e->depth_count)
            *(rightward ? &high[across] : &low[across]) = e->turns[i];
        int wrote = snprintf(e->cut + used, sizeof e->cut - used, "%sbox=%.17g,%.17g,%.17g:%.17g,%.17g,%.17g",
                             used ? ";" : "", low[0], low[1], low[2], high[0], high[1], high[2]);
        used += wrote > 0 && (size_t)wrote < sizeof e->cut - used ? (size_t)wrote : 0;
    }
}

/* Seen from the right, what is to the right of the plane is taken away. */
static lmn_status parse_revolved(draft_extra *e, const reader *r, const char *at)
{
    int across = axis_of(e->axes[0]);
    e->kind = DRAFT_REVOLVED;
    e->turns[0] = (side(r, across, false) + side(r, across, true)) / 2;
    if (at < r->end && *at == ',')
        at = read_place(r, at + 1, across, &e->turns[0]);
    if (at != r->end)
        return wrong(r, "behind revolved stands one place");
    snprintf(e->cut, sizeof e->cut, "%s%c=%.17g", e->axes[0][across] > 0 ? "" : "-", 'x' + across, e->turns[0]);
    return check_plane(r, across, e->turns[0]);
}

static lmn_status parse_section(draft_extra *e, reader *r, char up)
{
    const char *at = read_view(r, r->at, &e->view);
    if (!at)
        return wrong(r, "it begins with front, back, left, right, top or bottom");
    camera_view_axes(e->view, up, e->axes);
    if (r->end - at >= 9 && strncmp(at, "@revolved", 9) == 0)
        return parse_revolved(e, r, at + 9);
    int    depth = axis_of(e->axes[2]), across = axis_of(e->axes[0]);
    double values[2 * DRAFT_DEPTHS_MOST];
    size_t count = 0;
    for (bool more = at < r->end; more; more = at < r->end && *at == ',') {
        at++;
        if (r->end - at == 4 && strncmp(at, "half", 4) == 0) {
            e->half = true;
            at += 4;
        } else if (count == 2 * DRAFT_DEPTHS_MOST - 1 || e->half) {
            return wrong(r, "it has too many places: there are four planes at most, and nothing stands behind half");
        } else if (!(at = read_place(r, at, count % 2 ? across : depth, &values[count]))) {
            return wrong(r, "behind @ stand numbers or percentages");
        } else {
            count++;
        }
    }
    if (at < r->end || (count > 0 && count % 2 == 0) || (e->half && count > 1))
        return wrong(r, count % 2 ? "half has one plane" : "behind each turn stands where the plane goes on");
    if (count == 0)
        values[count++] = (side(r, depth, false) + side(r, depth, true)) / 2;
    for (size_t i = 0; i < count; i++)
        *(i % 2 ? &e->turns[i / 2] : &e->depths[i / 2]) = values[i];
    e->depth_count = (count + 1) / 2;
    for (size_t i = 0; i < count; i++)
        if (check_plane(r, i % 2 ? across : depth, values[i]) != LMN_OK)
            return LMN_USAGE;
    for (size_t i = 1; i + 1 < e->depth_count; i++)
        if ((e->turns[i] - e->turns[i - 1]) * e->axes[0][across] <= 0)
            return wrong(r, "its turns go from left to right");
    if (e->half)
        e->turns[0] = (side(r, across, false) + side(r, across, true)) / 2;
    write_cut(e, r);
    return LMN_OK;
}

/* --- details, and views along directions ---------------------------------------------------------------- */

static lmn_status parse_detail(draft_extra *e, reader *r, char up)
{
    const char *at = read_view(r, r->at, &e->view);
    double      paper = 0, model = 0;
    if (!at)
        return wrong(r, "it begins with front, back, left, right, top or bottom");
    camera_view_axes(e->view, up, e->axes);
    for (int k = 0; k < 3 && at; k++)
        at = at < r->end && *at == (k ? ',' : '@') ? read_place(r, at + 1, k, &e->at[k]) : NULL;
    at = at && at < r->end && *at == '/' ? text_parse_double(at + 1, r->end, &e->radius) : NULL;
    if (!at || !(e->radius > 0) || !isfinite(e->radius))
        return wrong(r, "it says where and how far around");
    if (at == r->end)
        return check_circle(r, e);
    at = *at == '/' ? text_parse_double(at + 1, r->end, &paper) : NULL;
    at = at && at < r->end && *at == ':' ? text_parse_double(at + 1, r->end, &model) : NULL;
    e->scale = paper / model;
    return at == r->end && paper > 0 && model > 0 && e->scale >= 1e-9 && e->scale <= 1e9
               ? check_circle(r, e)
               : wrong(r, "its scale is PAPER:MODEL");
}

static lmn_status parse_auxiliary(draft_extra *e, reader *r, char up)
{
    const char *at = r->at;
    (void)up;
    if (r->end - at > 5 && strncmp(at, "face@", 5) == 0) {
        at += 5;
        for (int k = 0; k < 3 && at; k++) {
            at = k == 0 ? at : at < r->end && *at == ',' ? at + 1 : NULL;
            at = at ? read_place(r, at, k, &e->at[k]) : NULL;
        }
        e->of_face = true;
        return at == r->end ? LMN_OK : wrong(r, "behind face@ stands a position on it");
    }
    for (int k = 0; k < 3 && at; k++) {
        at = k == 0 ? at : at < r->end && *at == ',' ? at + 1 : NULL;
        at = at ? text_parse_double(at, r->end, &e->eye[k]) : NULL;
    }
    if (at != r->end || !vector3_normalise(e->eye))
        return wrong(r, "it is a direction X,Y,Z towards the eye");
    return LMN_OK;
}

/* --- lists ---------------------------------------------------------------------------------------------- */

typedef lmn_status (*parse_fn)(draft_extra *e, reader *r, char up);

static lmn_status parse_list(draft_extras *out, draft_kind kind, const char *text, parse_fn parse, char up, reader *r)
{
    lmn_status status = LMN_OK;
    for (const char *at = text; at && *at && status == LMN_OK;) {
        r->at = at;
        r->end = at + strcspn(at, ";");
        if (out->count == DRAFT_EXTRAS_MOST)
            return wrong(r, "there are 12 sections, details and auxiliary views at most");
        draft_extra *e = &out->items[out->count];
        *e = (draft_extra){.kind = kind, .letter = letters[out->count]};
        status = parse(e, r, up);
        out->count++;
        at = r->end + (*r->end == ';');
    }
    return status;
}

lmn_status draft_extras_parse(draft_extras *out, const char *sections, const char *details, const char *auxiliary,
                              char up, box3 bounds, lmn_error *error)
{
    reader r = {.bounds = bounds,
                .error = error,
                .what = "section",
                .form =
                    "VIEW, VIEW@DEPTH, VIEW@DEPTH,TURN,DEPTH…, VIEW@half, VIEW@DEPTH,half or VIEW@revolved,WHERE; for "
                    "example front@40%"};
    *out = (draft_extras){.count = 0};
    lmn_status status = parse_list(out, DRAFT_SECTION, sections, parse_section, up, &r);
    r.what = "detail";
    r.form = "VIEW@X,Y,Z/RADIUS or VIEW@X,Y,Z/RADIUS/SCALE; for example front@10,0,25/4/5:1";
    if (status == LMN_OK)
        status = parse_list(out, DRAFT_DETAIL, details, parse_detail, up, &r);
    r.what = "auxiliary view";
    r.form = "for example 1,0,1, or face@X,Y,Z, which looks straight at the face nearest to there";
    return status == LMN_OK ? parse_list(out, DRAFT_AUXILIARY, auxiliary, parse_auxiliary, up, &r) : status;
}
