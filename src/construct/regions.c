/* Regions of the plane: the plain ones, growing them, transforms, hulls and sums. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "construct/construct_private.h"

void region_release(region *r)
{
    for (size_t i = 0; i < r->count; i++)
        mem_free(r->contours[i].points);
    mem_free(r->contours);
    *r = (region){0};
}

double grid_position(double value)
{
    return trunc(value / GRID) * GRID + 0.0;
}

double contour_area2(const point2 *points, size_t count)
{
    double sum = 0;
    for (size_t i = 0; i < count; i++) {
        const point2 *a = &points[i], *b = &points[(i + 1) % count], *o = &points[0];
        sum += (a->x - o->x) * (b->y - o->y) - (a->y - o->y) * (b->x - o->x);
    }
    return sum;
}

size_t region_point_count(const region *r)
{
    size_t count = 0;
    for (size_t i = 0; i < r->count; i++)
        count += r->contours[i].count;
    return count;
}

lmn_status check_region(const char *shape, const region *r, lmn_error *error)
{
    lmn_status status = check_point_count(shape, (double)region_point_count(r), error);
    for (size_t i = 0; status == LMN_OK && i < r->count; i++)
        if (r->contours[i].count > 0)
            status = check_numbers(shape, &r->contours[i].points->x, r->contours[i].count * 2, error);
    return status;
}

bool region_bounds(const region *r, double low[2], double high[2])
{
    low[0] = low[1] = INFINITY;
    high[0] = high[1] = -INFINITY;
    for (size_t i = 0; i < r->count; i++)
        for (size_t k = 0; k < r->contours[i].count; k++) {
            point2 p = r->contours[i].points[k];
            low[0] = fmin(low[0], p.x);
            low[1] = fmin(low[1], p.y);
            high[0] = fmax(high[0], p.x);
            high[1] = fmax(high[1], p.y);
        }
    return low[0] <= high[0];
}

/* --- growing -------------------------------------------------------------------------------------------- */

void builder_contour(region_builder *b)
{
    if (b->failed || !mem_grow((void **)&b->contours, &b->capacity, b->count + 1, sizeof *b->contours)) {
        b->failed = true;
        return;
    }
    b->contours[b->count++] = (contour){0};
    b->point_capacity = 0;
}

void builder_set_position(region_builder *b, double x, double y)
{
    if (b->failed)
        return;
    contour *c = &b->contours[b->count - 1];
    if (!mem_grow((void **)&c->points, &b->point_capacity, c->count + 1, sizeof *c->points)) {
        b->failed = true;
        return;
    }
    c->points[c->count++] = (point2){x + 0.0, y + 0.0};
}

void builder_end_contour(region_builder *b)
{
    if (!b->failed && b->contours[b->count - 1].count < 3)
        mem_free(b->contours[--b->count].points);
}

void region_builder_release(region_builder *b)
{
    region r = {b->contours, b->count};
    region_release(&r);
    *b = (region_builder){0};
}

lmn_status region_builder_finish(region_builder *b, region *out, lmn_error *error)
{
    *out = (region){0};
    if (b->failed || b->count == 0) {
        bool failed = b->failed;
        region_builder_release(b);
        return failed ? error_memory(error) : LMN_OK;
    }
    *out = (region){b->contours, b->count};
    *b = (region_builder){0};
    return LMN_OK;
}

lmn_status region_copy(region *out, const region *r, lmn_error *error)
{
    return region_transform(out, r, (const double[]){1, 0, 0, 1, 0, 0}, error);
}

/* --- plain regions -------------------------------------------------------------------------------------- */

lmn_status construct_square(region *out, const double size[2], bool centre, lmn_error *error)
{
    *out = (region){0};
    lmn_status status = check_numbers("square", size, 2, error);
    if (status != LMN_OK || !(size[0] > 0 && size[1] > 0))
        return status;
    double         x1 = centre ? -size[0] / 2 : 0, x2 = centre ? size[0] / 2 : size[0];
    double         y1 = centre ? -size[1] / 2 : 0, y2 = centre ? size[1] / 2 : size[1];
    region_builder b = {0};
    builder_contour(&b);
    builder_set_position(&b, x1, y1);
    builder_set_position(&b, x2, y1);
    builder_set_position(&b, x2, y2);
    builder_set_position(&b, x1, y2);
    builder_end_contour(&b);
    return region_builder_finish(&b, out, error);
}

lmn_status construct_circle(region *out, double radius, facets f, lmn_error *error)
{
    *out = (region){0};
    int        count = facets_of_circle(radius, f);
    lmn_status status = check_numbers("circle", &radius, 1, error);
    if (status == LMN_OK)
        status = check_point_count("circle", count, error);
    if (status != LMN_OK || !(radius > 0))
        return status;
    region_builder b = {0};
    builder_contour(&b);
    for (int i = 0; i < count; i++) {
        double angle = 360.0 * i / count;
        builder_set_position(&b, radius * cosine_of_degrees(angle), radius * sine_of_degrees(angle));
    }
    builder_end_contour(&b);
    return region_builder_finish(&b, out, error);
}

static lmn_status check_paths(size_t point_count, const uint32_t *corners, const uint32_t *path_sizes,
                              size_t path_count, lmn_error *error)
{
    double total = 0;
    for (size_t i = 0; i < path_count; i++)
        total += path_sizes[i];
    lmn_status status = check_point_count("polygon", total, error);
    for (size_t i = 0; status == LMN_OK && i < (size_t)total; i++)
        if (corners[i] >= point_count)
            return error_set(error, LMN_FORMAT, "polygon: a path has point %u, but there are only %zu", corners[i],
                             point_count);
    return status;
}

lmn_status construct_polygon(region *out, const point2 *points, size_t point_count, const uint32_t *corners,
                             const uint32_t *path_sizes, size_t path_count, lmn_error *error)
{
    *out = (region){0};
    lmn_status status = check_paths(point_count, corners, path_sizes, path_count, error);
    if (status == LMN_OK && point_count > 0)
        status = check_numbers("polygon", &points->x, point_count * 2, error);
    if (status != LMN_OK)
        return status;
    region_builder b = {0};
    for (size_t i = 0; i < path_count; corners += path_sizes[i++]) {
        builder_contour(&b);
        for (uint32_t k = 0; k < path_sizes[i]; k++)
            builder_set_position(&b, points[corners[k]].x, points[corners[k]].y);
        builder_end_contour(&b);
    }
    region paths;
    status = region_builder_finish(&b, &paths, error);
    if (status == LMN_OK)
        status = region_cover(out, &paths, 1, COVER_ODD, error);
    region_release(&paths);
    return status;
}

/* --- set operations and transforms ---------------------------------------------------------------------- */

lmn_status region_combine(region *out, const region *operands, size_t count, region_operation operation,
                          lmn_error *error)
{
    static const cover_rule rules[] = {COVER_UNION, COVER_INTERSECTION, COVER_DIFFERENCE};
    *out = (region){0};
    for (size_t i = 0; i < count; i++) {
        lmn_status status = check_region("region", &operands[i], error);
        if (status != LMN_OK)
            return status;
    }
    if (count == 0)
        return LMN_OK;
    /* One alone is left as it is, off the grid too. */
    return count == 1 ? region_copy(out, operands, error) : region_cover(out, operands, count, rules[operation], error);
}

lmn_status region_transform(region *out, const region *r, const double m[6], lmn_error *error)
{
    *out = (region){0};
    lmn_status status = check_numbers("multmatrix", m, 6, error);
    if (status != LMN_OK)
        return status;
    double         determinant = m[0] * m[3] - m[1] * m[2];
    region_builder b = {0};
    for (size_t i = 0; determinant != 0 && i < r->count; i++) {
        builder_contour(&b);
        for (size_t k = 0, n = r->contours[i].count; k < n; k++) {
            point2 p = r->contours[i].points[determinant < 0 ? n - 1 - k : k];
            builder_set_position(&b, m[0] * p.x + m[2] * p.y + m[4], m[1] * p.x + m[3] * p.y + m[5]);
        }
        builder_end_contour(&b);
    }
    return region_builder_finish(&b, out, error);
}

/* --- hulls ---------------------------------------------------------------------------------------------- */

/* Does the way from a over b to c turn left? Nearly straight ones do not: such corners are rounding. */
static bool turns_left(point2 a, point2 b, point2 c)
{
    double left = (b.x - a.x) * (c.y - a.y), right = (b.y - a.y) * (c.x - a.x);
    return left - right > 1e-15 * (fabs(left) + fabs(right));
}

/* Andrew's monotone chains; sorts the points. The hull has room for one more than there are points. */
static size_t find_hull(point2 *points, size_t count, point2 *hull)
{
    qsort(points, count, sizeof *points, compare_positions);
    size_t size = 0;
    for (size_t i = 0; i < count; i++) {
        while (size >= 2 && !turns_left(hull[size - 2], hull[size - 1], points[i]))
            size--;
        hull[size++] = points[i];
    }
    size_t below = size + 1;
    for (size_t i = count - 1; i-- > 0;) {
        while (size >= below && !turns_left(hull[size - 2], hull[size - 1], points[i]))
            size--;
        hull[size++] = points[i];
    }
    return size - 1;
}

/* The hull of all these points, as a region; empty when they lie on a line. */
static lmn_status hull_of_points(region *out, point2 *points, size_t count, lmn_error *error)
{
    *out = (region){0};
    if (count < 3)
        return LMN_OK;
    point2 *hull = mem_calloc(count + 1, sizeof *hull);
    if (!hull)
        return error_memory(error);
    size_t         size = find_hull(points, count, hull);
    region_builder b = {0};
    if (size >= 3 && contour_area2(hull, size) > 0) {
        builder_contour(&b);
        for (size_t i = 0; i < size; i++)
            builder_set_position(&b, hull[i].x, hull[i].y);
        builder_end_contour(&b);
    }
    mem_free(hull);
    return region_builder_finish(&b, out, error);
}

lmn_status region_hull(region *out, const region *operands, size_t count, lmn_error *error)
{
    *out = (region){0};
    size_t     total = 0, at = 0;
    lmn_status status = LMN_OK;
    for (size_t i = 0; status == LMN_OK && i < count; i++) {
        status = check_region("hull", &operands[i], error);
        total += region_point_count(&operands[i]);
    }
    if (status == LMN_OK)
        status = check_point_count("hull", (double)total, error);
    if (status != LMN_OK)
        return status;
    point2 *points = mem_calloc(total, sizeof *points);
    if (!points)
        return error_memory(error);
    for (size_t i = 0; i < count; i++)
        for (size_t k = 0; k < operands[i].count; k++)
            for (size_t n = 0; n < operands[i].contours[k].count; n++)
                points[at++] = operands[i].contours[k].points[n];
    status = hull_of_points(out, points, total, error);
    mem_free(points);
    return status;
}

/* --- sums ----------------------------------------------------------------------------------------------- */

static bool is_convex(const region *r)
{
    if (r->count != 1)
        return false;
    const contour *c = r->contours;
    double         turned = 0;
    for (size_t i = 0; i < c->count; i++) {
        point2 p = c->points[i], q = c->points[(i + 1) % c->count], s = c->points[(i + 2) % c->count];
        double ux = q.x - p.x, uy = q.y - p.y, vx = s.x - q.x, vy = s.y - q.y, cross = ux * vy - uy * vx;
        if (cross < 0)
            return false;
        turned += atan2(cross, ux * vx + uy * vy);
    }
    return turned < 3 * PI; /* once round, not twice */
}

static lmn_status convex_sum(region *out, const contour *a, const contour *b, lmn_error *error)
{
    point2 *points = mem_calloc(a->count * b->count, sizeof *points);
    if (!points)
        return error_memory(error);
    for (size_t i = 0; i < a->count; i++)
        for (size_t k = 0; k < b->count; k++)
            points[i * b->count + k] = (point2){grid_position(a->points[i].x) + grid_position(b->points[k].x),
                                                grid_position(a->points[i].y) + grid_position(b->points[k].y)};
    lmn_status status = hull_of_points(out, points, a->count * b->count, error);
    mem_free(points);
    return status;
}

/* What an edge covers while it moves along another one. */
static void add_parallelogram(region_builder *sum, const point2 *a, const point2 *b, const point2 *c, const point2 *d)
{
    double ux = grid_position(b->x) - grid_position(a->x), uy = grid_position(b->y) - grid_position(a->y);
    double vx = grid_position(d->x) - grid_position(c->x), vy = grid_position(d->y) - grid_position(c->y),
           area = ux * vy - uy * vx;
    double x = grid_position(a->x) + grid_position(c->x), y = grid_position(a->y) + grid_position(c->y);
    if (area == 0)
        return;
    builder_contour(sum);
    builder_set_position(sum, x, y);
    if (area > 0)
        builder_set_position(sum, x + ux, y + uy);
    else
        builder_set_position(sum, x + vx, y + vy);
    builder_set_position(sum, x + ux + vx, y + uy + vy);
    if (area > 0)
        builder_set_position(sum, x + vx, y + vy);
    else
        builder_set_position(sum, x + ux, y + uy);
    builder_end_contour(sum);
}

static lmn_status sum_of_borders(region *out, const region *a, const region *b, lmn_error *error)
{
    region_builder sum = {0};
    for (size_t i = 0; i < a->count; i++)
        for (size_t k = 0; k < b->count; k++) {
            const contour *c = &a->contours[i], *d = &b->contours[k];
            for (size_t n = 0; n < c->count * d->count; n++) {
                size_t p = n / d->count, q = n % d->count;
                add_parallelogram(&sum, &c->points[p], &c->points[(p + 1) % c->count], &d->points[q],
                                  &d->points[(q + 1) % d->count]);
            }
        }
    region     borders;
    lmn_status status = region_builder_finish(&sum, &borders, error);
    if (status == LMN_OK)
        status = region_unite_polygons(out, &borders, error);
    region_release(&borders);
    return status;
}

/* Adds `a` moved to the first point of each outer contour of `b`. */
static lmn_status unite_moved(region *sum, const region *a, const region *b, lmn_error *error)
{
    lmn_status status = LMN_OK;
    for (size_t i = 0; status == LMN_OK && i < b->count; i++) {
        const contour *c = &b->contours[i];
        if (contour_area2(c->points, c->count) < 0)
            continue;
        region both[2] = {*sum, {0}}, united = {0};
        status = region_transform(&both[1], a, (double[]){1, 0, 0, 1, c->points[0].x, c->points[0].y}, error);
        if (status == LMN_OK)
            status = region_combine(&united, both, 2, REGION_UNION, error);
        region_release(&both[1]);
        if (status == LMN_OK) {
            region_release(sum);
            *sum = united;
        }
    }
    return status;
}

/* A position of the sum either has both borders meeting in it, or one of the two lies wholly within the other there. */
lmn_status region_minkowski(region *out, const region *a, const region *b, lmn_error *error)
{
    *out = (region){0};
    lmn_status status = check_region("minkowski", a, error);
    if (status == LMN_OK)
        status = check_region("minkowski", b, error);
    if (status == LMN_OK)
        status = check_point_count("minkowski", (double)region_point_count(a) * (double)region_point_count(b), error);
    if (status != LMN_OK || a->count == 0 || b->count == 0)
        return status;
    if (is_convex(a) && is_convex(b))
        return convex_sum(out, a->contours, b->contours, error);
    /* Uniting parallelograms takes far longer than making points. */
    region sum = {0};
    status =
        check_point_count("minkowski", 16.0 * (double)region_point_count(a) * (double)region_point_count(b), error);
    if (status == LMN_OK)
        status = sum_of_borders(&sum, a, b, error);
    if (status == LMN_OK)
        status = unite_moved(&sum, a, b, error);
    if (status == LMN_OK)
        status = unite_moved(&sum, b, a, error);
    if (status != LMN_OK)
        region_release(&sum);
    *out = sum;
    return status;
}
