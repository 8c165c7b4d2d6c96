/* Cutting what lies on a sheet at a box or a circle: lines and areas end there, dots outside go. Pictures and texts
 * stay. */
#include <math.h>
#include <string.h>

#include "base/memory.h"
#include "sheet/sheet.h"

enum { CIRCLE_SIDES = 72 }; /* of the polygon that areas are cut at */

typedef struct clipper {
    const sheet *from;
    sheet_path  *paths;
    float (*points)[2];
    size_t path_count, path_capacity, point_count, point_capacity;
    float  low[2], high[2];
    float  centre[2], radius; /* of a circle; 0: the box counts */
    bool   failed;
} clipper;

static void put_point(clipper *c, float x, float y)
{
    if (c->failed || !mem_grow((void **)&c->points, &c->point_capacity, c->point_count + 1, sizeof *c->points)) {
        c->failed = true;
        return;
    }
    c->points[c->point_count][0] = x;
    c->points[c->point_count++][1] = y;
}

/* Keeps the points put since `first` as a path like another one, unless there are too few. */
static void put_path(clipper *c, const sheet_path *like, size_t first, size_t least, bool closed)
{
    if (c->point_count - first < least) {
        c->point_count = first;
        return;
    }
    if (c->failed || !mem_grow((void **)&c->paths, &c->path_capacity, c->path_count + 1, sizeof *c->paths)) {
        c->failed = true;
        return;
    }
    sheet_path *p = &c->paths[c->path_count++];
    *p = *like;
    p->first = (uint32_t)first;
    p->count = (uint32_t)(c->point_count - first);
    p->closed = closed;
}

static bool is_inside(const clipper *c, const float p[2])
{
    if (c->radius > 0)
        return hypotf(p[0] - c->centre[0], p[1] - c->centre[1]) <= c->radius;
    return p[0] >= c->low[0] && p[0] <= c->high[0] && p[1] >= c->low[1] && p[1] <= c->high[1];
}

static void clip_dots(clipper *c, const sheet_path *path)
{
    size_t first = c->point_count;
    for (uint32_t i = 0; i < path->count; i++) {
        const float *p = c->from->points[path->first + i];
        if (is_inside(c, p))
            put_point(c, p[0], p[1]);
    }
    put_path(c, path, first, 1, false);
}

static bool cut_at_circle(const clipper *c, const float a[2], const float b[2], float cut[2])
{
    double x = (double)a[0] - (double)c->centre[0], y = (double)a[1] - (double)c->centre[1];
    double dx = (double)b[0] - (double)a[0], dy = (double)b[1] - (double)a[1], square = dx * dx + dy * dy;
    double half = x * dx + y * dy, rest = x * x + y * y - (double)c->radius * (double)c->radius;
    double under = half * half - square * rest;
    if (!(square > 0) || !(under > 0))
        return false;
    cut[0] = (float)fmax((-half - sqrt(under)) / square, 0);
    cut[1] = (float)fmin((-half + sqrt(under)) / square, 1);
    return cut[0] < cut[1];
}

/* The part of a straight piece that lies inside, as fractions; false: nothing. */
static bool cut_piece(const clipper *c, const float a[2], const float b[2], float cut[2])
{
    if (c->radius > 0)
        return cut_at_circle(c, a, b, cut);
    cut[0] = 0;
    cut[1] = 1;
    for (int k = 0; k < 2; k++) {
        float step = b[k] - a[k], low = c->low[k] - a[k], high = c->high[k] - a[k];
        if (step == 0 && (low > 0 || high < 0))
            return false;
        if (step == 0)
            continue;
        float enter = (step > 0 ? low : high) / step, leave = (step > 0 ? high : low) / step;
        cut[0] = enter > cut[0] ? enter : cut[0];
        cut[1] = leave < cut[1] ? leave : cut[1];
    }
    return cut[0] < cut[1];
}

static void clip_line(clipper *c, const sheet_path *path)
{
    size_t     first = c->point_count;
    uint32_t   pieces = path->closed ? path->count : path->count - 1;
    sheet_path like = *path; /* dashes go on behind what is cut off */
    float      arc = 0;
    for (uint32_t i = 0; i < pieces; i++) {
        const float *a = c->from->points[path->first + i], *b = c->from->points[path->first + (i + 1) % path->count];
        float        cut[2], length = hypotf(b[0] - a[0], b[1] - a[1]), begun = arc;
        arc += length;
        if (!cut_piece(c, a, b, cut)) {
            put_path(c, &like, first, 2, false);
            first = c->point_count;
            continue;
        }
        if (c->point_count == first) {
            like.phase = path->phase + begun + cut[0] * length;
            put_point(c, a[0] + cut[0] * (b[0] - a[0]), a[1] + cut[0] * (b[1] - a[1]));
        }
        put_point(c, a[0] + cut[1] * (b[0] - a[0]), a[1] + cut[1] * (b[1] - a[1]));
        if (cut[1] < 1) {
            put_path(c, &like, first, 2, false);
            first = c->point_count;
        }
    }
    put_path(c, &like, first, 2, false);
}

/* How far inside of one side of the box, or of the polygon around the circle, a point is. */
static float inside_of_side(const clipper *c, int side, const float p[2])
{
    if (c->radius > 0) {
        float angle = 6.28318531f * (float)side / CIRCLE_SIDES;
        return c->radius - (p[0] - c->centre[0]) * cosf(angle) - (p[1] - c->centre[1]) * sinf(angle);
    }
    return side & 1 ? c->high[side / 2] - p[side / 2] : p[side / 2] - c->low[side / 2];
}

/* An area, cut at one side after the other (Sutherland and Hodgman). */
static void clip_area(clipper *c, const sheet_path *path)
{
    size_t begin = c->point_count;
    for (uint32_t i = 0; i < path->count; i++)
        put_point(c, c->from->points[path->first + i][0], c->from->points[path->first + i][1]);
    for (int side = 0; side < (c->radius > 0 ? CIRCLE_SIDES : 4) && !c->failed; side++) {
        size_t count = c->point_count - begin, next = c->point_count;
        for (size_t i = 0; i < count && !c->failed; i++) {
            const float a[2] = {c->points[begin + i][0], c->points[begin + i][1]};
            const float b[2] = {c->points[begin + (i + 1) % count][0], c->points[begin + (i + 1) % count][1]};
            float       before = inside_of_side(c, side, a), after = inside_of_side(c, side, b);
            if (before >= 0)
                put_point(c, a[0], a[1]);
            if ((before < 0) != (after < 0)) {
                float fraction = before / (before - after);
                put_point(c, a[0] + fraction * (b[0] - a[0]), a[1] + fraction * (b[1] - a[1]));
            }
        }
        if (c->failed)
            return;
        size_t left = c->point_count - next;
        memmove(c->points + begin, c->points + next, left * sizeof *c->points);
        c->point_count = begin + left;
    }
    put_path(c, path, begin, 3, true);
}

static bool reaches_out(const clipper *c, const sheet_path *path)
{
    for (uint32_t i = 0; i < path->count; i++)
        if (!is_inside(c, c->from->points[path->first + i]))
            return true;
    return false;
}

static void keep_path(clipper *c, const sheet_path *path)
{
    size_t begin = c->point_count;
    for (uint32_t n = 0; n < path->count; n++)
        put_point(c, c->from->points[path->first + n][0], c->from->points[path->first + n][1]);
    put_path(c, path, begin, 1, path->closed);
}

static bool clip_from(sheet *s, clipper c, size_t first_item)
{
    bool any = false;
    for (size_t i = first_item; i < s->item_count; i++)
        for (uint32_t k = 0; k < s->items[i].count && !any; k++)
            any = reaches_out(&c, &s->paths[s->items[i].first + k]);
    if (!any || s->failed)
        return false;
    size_t kept = 0;
    for (size_t i = 0; i < s->item_count; i++) {
        sheet_item item = s->items[i];
        size_t     first = c.path_count;
        bool       has_paths = item.kind == SHEET_PATH || item.kind == SHEET_DOTS;
        for (uint32_t k = 0; k < item.count && has_paths; k++) {
            const sheet_path *path = &s->paths[item.first + k];
            if (path->count == 0)
                continue;
            if (i < first_item || !reaches_out(&c, path))
                keep_path(&c, path);
            else if (item.kind == SHEET_DOTS)
                clip_dots(&c, path);
            else if (path->filled)
                clip_area(&c, path);
            else
                clip_line(&c, path);
        }
        if (has_paths) {
            item.first = (uint32_t)first;
            item.count = (uint32_t)(c.path_count - first);
        }
        if (!has_paths || item.count)
            s->items[kept++] = item;
    }
    s->item_count = kept;
    s->failed = s->failed || c.failed;
    mem_free(s->paths);
    mem_free(s->points);
    s->paths = c.paths;
    s->points = c.points;
    s->path_count = c.path_count;
    s->point_count = c.point_count;
    s->path_capacity = c.path_capacity;
    s->point_capacity = c.point_capacity;
    return true;
}

bool sheet_clip(sheet *s, double x, double y, double width, double height)
{
    return clip_from(
        s, (clipper){.from = s, .low = {(float)x, (float)y}, .high = {(float)(x + width), (float)(y + height)}}, 0);
}

bool sheet_clip_circle(sheet *s, size_t first_item, const double centre[2], double radius)
{
    return clip_from(s, (clipper){.from = s, .centre = {(float)centre[0], (float)centre[1]}, .radius = (float)radius},
                     first_item);
}
