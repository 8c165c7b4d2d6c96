#include "draft/draw.h"

#include <math.h>
#include <string.h>

static const double pi = 3.14159265358979323846;
/* Of a long-dashed dotted line, in widths. */
static const double long_dash = 24, gap = 3, dot = 0.5;
static const double shortened_most = 0.4; /* short lines have shorter dashes, down to this, before they are unbroken */
enum { ARC_STEPS = 180, POINTS_MOST = 193 };

bool draft_group_is_known(double wide)
{
    static const double groups[] = {0.25, 0.35, 0.5, 0.7};
    for (size_t i = 0; i < sizeof groups / sizeof *groups; i++)
        if (fabs(wide - groups[i]) < 1e-9)
            return true;
    return false;
}

double draft_scale(const draft_view *v)
{
    return v->box[3] / (2 * v->camera->half_height);
}

void draft_turn(const draft_view *v, const double world[3], double out[3])
{
    const double *m = v->camera->view.m;
    for (int k = 0; k < 3; k++)
        out[k] = (k == 1 ? -1 : 1) * (m[k] * world[0] + m[4 + k] * world[1] + m[8 + k] * world[2]);
}

void draft_project(const draft_view *v, const double world[3], double out[2])
{
    double eye[3], scale = draft_scale(v);
    draft_turn(v, world, eye);
    for (int k = 0; k < 2; k++)
        out[k] = v->box[k] + v->box[2 + k] / 2 + scale * (eye[k] + (k ? -1 : 1) * v->camera->view.m[12 + k]);
}

static void put_line(const draft_view *v, const double (*points)[2], size_t count, double width, bool closed)
{
    float numbers[POINTS_MOST][2];
    for (size_t i = 0; i < count && i < POINTS_MOST; i++)
        for (int k = 0; k < 2; k++)
            numbers[i][k] = (float)points[i][k];
    sheet_add_item(v->page, SHEET_PATH, v->group, v->ink, 0);
    sheet_add_path(v->page,
                   &(sheet_path){.width = (float)width, .closed = closed, .curved = count > 8, .cap = SHEET_CAP_BUTT},
                   (const float(*)[2])numbers, count < POINTS_MOST ? count : POINTS_MOST);
}

static void dash_last(const draft_view *v, double width, double scale)
{
    const float lengths[4] = {(float)(long_dash * width * scale), (float)(gap * width * scale),
                              (float)(dot * width * scale), (float)(gap * width * scale)};
    sheet_dash_path(v->page, lengths, 4, 0);
}

void draft_chain_line(const draft_view *v, const double (*points)[2], size_t count, double width, bool middle)
{
    double length = 0, period = (long_dash + 2 * gap + dot) * width, dash = long_dash * width;
    for (size_t i = 1; i < count; i++)
        length += hypot(points[i][0] - points[i - 1][0], points[i][1] - points[i - 1][1]);
    put_line(v, points, count, width, false);
    double half = middle ? 2 : 1, times = half * fmax(round((length - dash) / period / half), 1);
    double scale = length / (times * period + dash);
    if (scale >= shortened_most)
        dash_last(v, width, scale);
}

static size_t arc_points(const double centre[2], double radius, double from, double sweep, double (*out)[2])
{
    size_t steps = (size_t)fmax(ceil(ARC_STEPS * fabs(sweep) / (2 * pi)), 8);
    for (size_t i = 0; i <= steps; i++) {
        double angle = from + sweep * (double)i / (double)steps;
        out[i][0] = centre[0] + radius * cos(angle);
        out[i][1] = centre[1] + radius * sin(angle);
    }
    return steps + 1;
}

void draft_chain_circle(const draft_view *v, const double centre[2], double radius, double width)
{
    double points[POINTS_MOST][2], period = (long_dash + 2 * gap + dot) * width;
    put_line(v, (const double(*)[2])points, arc_points(centre, radius, 0, 2 * pi, points) - 1, width, true);
    double times = fmax(round(2 * pi * radius / period), 2), scale = 2 * pi * radius / (times * period);
    if (scale >= shortened_most)
        dash_last(v, width, scale);
}

void draft_line(const draft_view *v, const double a[2], const double b[2], double width)
{
    const double points[2][2] = {{a[0], a[1]}, {b[0], b[1]}};
    put_line(v, points, 2, width, false);
}

void draft_polyline(const draft_view *v, const double (*points)[2], size_t count, double width, bool hidden)
{
    double length = 0, dash = DRAFT_HIDDEN_DASH * width, period = dash + DRAFT_HIDDEN_GAP * width;
    for (size_t i = 1; i < count; i++)
        length += hypot(points[i][0] - points[i - 1][0], points[i][1] - points[i - 1][1]);
    put_line(v, points, count, width, false);
    double times = fmax(round((length - dash) / period), 1), scale = length / (times * period + dash);
    if (hidden && scale >= shortened_most) {
        const float lengths[2] = {(float)(dash * scale), (float)(DRAFT_HIDDEN_GAP * width * scale)};
        sheet_dash_path(v->page, lengths, 2, 0);
    }
}

void draft_arc(const draft_view *v, const double centre[2], double radius, double from, double sweep, double width)
{
    double points[POINTS_MOST][2];
    bool   closed = fabs(sweep) > 2 * pi - 1e-9;
    size_t count = arc_points(centre, radius, from, sweep, points);
    put_line(v, (const double(*)[2])points, count - closed, width, closed);
}

void draft_arrow(const draft_view *v, const double tip[2], const double along[2], double length)
{
    double      half = length * tan(7.5 * pi / 180);
    const float corners[3][2] = {
        {(float)tip[0], (float)tip[1]},
        {(float)(tip[0] - length * along[0] - half * along[1]), (float)(tip[1] - length * along[1] + half * along[0])},
        {(float)(tip[0] - length * along[0] + half * along[1]), (float)(tip[1] - length * along[1] - half * along[0])}};
    sheet_add_item(v->page, SHEET_PATH, v->group, v->ink, 0);
    sheet_add_path(v->page, &(sheet_path){.closed = true, .filled = true}, corners, 3);
}
