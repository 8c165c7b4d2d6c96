#include "draft/marks.h"

#include <math.h>
#include <stdio.h>

#include "base/vector3.h"

static const double capital = 0.72;    /* height of capitals, of the size of letters */
static const double seen_aside = 1e-3; /* cosine */
static const double thick_part = 2.2;  /* length of the wide ends of a cutting plane, letters */
static const double past = 1.5;        /* how far it reaches beyond the model, letters */
static const double shaft = 2.0;       /* of arrows, letters */

static void put_letters(const draft_view *v, const char *words, double x, double y, double letter)
{
    sheet_add_text(v->page, v->group, v->ink, words, x, y + letter / 2, letter / capital, 0);
}

bool draft_shows_plane(const draft_view *v, const draft_extra *e)
{
    double up[3], across[3];
    draft_turn(v, e->axes[1], up);
    draft_turn(v, e->axes[0], across);
    return fabs(up[2]) > 1 - seen_aside || (e->depth_count == 1 && !e->half && fabs(across[2]) > 1 - seen_aside);
}

/* The corners of a box as far as they reach along an axis. */
static void reach_of(box3 b, const double axis[3], double out[2])
{
    out[0] = INFINITY;
    out[1] = -INFINITY;
    for (int i = 0; i < 8; i++) {
        const double corner[3] = {(double)(i & 1 ? b.max.x : b.min.x), (double)(i & 2 ? b.max.y : b.min.y),
                                  (double)(i & 4 ? b.max.z : b.min.z)};
        double       along = vector3_dot(corner, axis);
        out[0] = fmin(out[0], along);
        out[1] = fmax(out[1], along);
    }
}

size_t draft_trace(const draft_view *v, const draft_extra *e, box3 bounds, double letter, double (*out)[2])
{
    double up[3], middle[3], reach[2], out_of_it[2], p[3], scale = draft_scale(v), beyond = past * letter;
    size_t count = 0;
    draft_turn(v, e->axes[1], up);
    const double *along = fabs(up[2]) > 1 - seen_aside ? e->axes[0] : e->axes[1];
    /* Depths and turns are coordinates, which may grow the other way. */
    double across_sign = vector3_dot(e->axes[0], (double[3]){1, 1, 1}) > 0 ? 1 : -1,
           depth_sign = vector3_dot(e->axes[2], (double[3]){1, 1, 1}) > 0 ? 1 : -1;
    box3_middle(bounds, middle);
    reach_of(bounds, along, reach);
    reach_of(bounds, e->axes[2], out_of_it);
    for (size_t i = 0; i < e->depth_count + e->half; i++)
        for (int k = 0; k < 2; k++) {
            double depth = depth_sign * e->depths[e->half ? 0 : i], at;
            if (e->half) {
                depth = i == 0 && k == 0 ? out_of_it[1] + beyond / scale : depth;
                at = i == 1 && k == 1 ? reach[1] + beyond / scale : across_sign * e->turns[0];
                if (i == 1 && k == 0)
                    continue;
            } else {
                at = k == 0 ? (i == 0 ? reach[0] - beyond / scale : across_sign * e->turns[i - 1])
                            : (i + 1 == e->depth_count ? reach[1] + beyond / scale : across_sign * e->turns[i]);
            }
            vector3_add(p, middle, at - vector3_dot(middle, along), along);
            vector3_add(p, p, depth - vector3_dot(p, e->axes[2]), e->axes[2]);
            draft_project(v, p, out[count++]);
        }
    return count;
}

static bool way(const double a[2], const double b[2], double out[2])
{
    double length = hypot(b[0] - a[0], b[1] - a[1]);
    if (!(length > 1e-9))
        return false;
    out[0] = (b[0] - a[0]) / length;
    out[1] = (b[1] - a[1]) / length;
    return true;
}

static void put_stub(const draft_view *v, const double from[2], const double along[2], double length)
{
    const double to[2] = {from[0] + length * along[0], from[1] + length * along[1]};
    draft_line(v, from, to, v->wide);
}

/* An arrow whose shaft ends at a place, and its letter at the other end of it. */
static void put_arrow(const draft_view *v, const char *word, const double at[2], const double look[2], double letter)
{
    const double tail[2] = {at[0] - shaft * letter * look[0], at[1] - shaft * letter * look[1]};
    draft_arrow(v, at, look, letter);
    draft_line(v, tail, (const double[2]){at[0] - 0.9 * letter * look[0], at[1] - 0.9 * letter * look[1]}, v->narrow);
    put_letters(v, word, tail[0] - 0.85 * letter * look[0], tail[1] - 0.85 * letter * look[1], letter);
}

void draft_cutting_plane(const draft_view *v, const draft_extra *e, box3 bounds, double letter)
{
    double     points[2 * DRAFT_DEPTHS_MOST][2], look[3], along[2];
    const char word[2] = {e->letter, '\0'};
    size_t     count = draft_trace(v, e, bounds, letter, points), last = count - 1;
    draft_turn(v, e->axes[2], look);
    const double towards[2] = {-look[0], -look[1]};
    draft_chain_line(v, (const double(*)[2])points, count, v->narrow, false);
    for (size_t i = 1; i < last; i++) /* where it turns */
        for (int k = -1; k <= 1; k += 2)
            if (way(points[i], points[k < 0 ? i - 1 : i + 1], along))
                put_stub(v, points[i], along, 0.8 * letter);
    for (int k = e->half ? 1 : 0; k < 2; k++)
        if (way(points[k ? last : 0], points[k ? last - 1 : 1], along)) {
            const double *end = points[k ? last : 0];
            put_stub(v, end, along, thick_part * letter);
            /* The arrow stands on the wide end and looks as the section does. */
            const double at[2] = {end[0] + 0.1 * letter * along[0], end[1] + 0.1 * letter * along[1]};
            put_arrow(v, word, at, towards, letter);
        }
}

void draft_detail_circle(const draft_view *v, const draft_extra *e, double letter)
{
    double       at[2], radius = e->radius * draft_scale(v);
    const char   word[2] = {e->letter, '\0'};
    const double slant = 0.70710678;
    draft_project(v, e->at, at);
    draft_arc(v, at, radius, 0, 6.283185307179586, v->narrow);
    double away = radius + 0.9 * letter;
    put_letters(v, word, at[0] + slant * away, at[1] - slant * away, letter);
}

void draft_detail_rim(const draft_view *v, const draft_extra *e)
{
    double at[2];
    draft_project(v, e->at, at);
    draft_arc(v, at, e->radius * draft_scale(v), 0, 6.283185307179586, v->narrow);
}

bool draft_view_arrow(const draft_view *v, const draft_extra *e, box3 bounds, double letter)
{
    double     eye[3], middle[3], tip[2], most = 0;
    const char word[2] = {e->letter, '\0'};
    draft_turn(v, e->eye, eye);
    if (fabs(eye[2]) > seen_aside)
        return false;
    box3_middle(bounds, middle);
    draft_project(v, middle, tip);
    double reach[2];
    reach_of(bounds, e->eye, reach);
    most = (reach[1] - vector3_dot(middle, e->eye)) * draft_scale(v) + 0.8 * letter;
    tip[0] += most * eye[0];
    tip[1] += most * eye[1];
    put_arrow(v, word, tip, (const double[2]){-eye[0], -eye[1]}, letter);
    return true;
}

void draft_title(const draft_view *v, const char *words, double top, double letter)
{
    put_letters(v, words, v->box[0] + v->box[2] / 2, top - letter, letter);
}
