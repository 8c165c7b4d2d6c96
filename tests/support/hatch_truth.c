#include "hatch_truth.h"

#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "check.h"
#include "picture.h"

/* --- formulas ------------------------------------------------------------------------------------------- */

/* By number lines are `width` wide, so that darkness asks for a distance of width / darkness, and the old ones
 * stand as close or up to twice as far apart; by width from scale/√2 to scale·√2. What they leave of the tone is
 * given by new ones halfway between. */
hatch_octave hatch_octave_of(const hatch_rule *r, double rate, double darkness)
{
    hatch_octave o = {0};
    /* By number they come no closer than three pixels: what is darker has wider ones. */
    double spread = r->by_width ? darkness : fmin(darkness, r->width / 3);
    double most = r->by_width ? r->scale * sqrt(2)
                              : 2 * r->width / spread; /* the old lines' distance is below, and at least half of it */
    double period = 1 / rate;                          /* of octave 0 */
    for (; period >= most; o.octave++)
        period /= 2;
    for (; 2 * period < most; o.octave--)
        period *= 2;
    o.period = period;
    double ink = darkness * period;
    if (r->by_width) {
        /* New lines grow while the distance of the old ones goes from scale/√2 to scale·√2: from nothing to their
         * width. */
        double grown = log2(period * sqrt(2) / r->scale);
        o.old_width = ink / (1 + grown);
        o.new_width = ink - o.old_width;
    } else {
        o.old_width = r->width * darkness / spread;
        o.new_width = ink - o.old_width;
    }
    return o;
}

static double overlap(double low_a, double high_a, double low_b, double high_b)
{
    return fmax(0, fmin(high_a, high_b) - fmax(low_a, low_b));
}

double hatch_cover(const hatch_rule *r, double coordinate, double rate, double darkness)
{
    if (darkness <= 0)
        return 0;
    hatch_octave o = hatch_octave_of(r, rate, darkness);
    double       at = coordinate / rate, sum = 0; /* px */
    double       first = floor(at / o.period);
    for (double i = first - 3; i <= first + 4; i++) {
        double old_line = i * o.period, new_line = (i + 0.5) * o.period;
        sum += overlap(at - 0.5, at + 0.5, old_line - o.old_width / 2, old_line + o.old_width / 2);
        sum += overlap(at - 0.5, at + 0.5, new_line - o.new_width / 2, new_line + o.new_width / 2);
    }
    return fmin(sum, 1);
}

/* --- looks and scenes ----------------------------------------------------------------------------------- */

const char *hatch_look(const char *light, const char *rule, const char *settings, ...)
{
    static char texts[4][1600];
    static int  next;
    char       *text = texts[next], own[800];
    va_list     arguments;
    next = (next + 1) % 4;
    va_start(arguments, settings);
    vsnprintf(own, sizeof own, settings, arguments);
    va_end(arguments);
    snprintf(text, sizeof texts[0],
             "{\"version\":1,\"name\":\"t\",\"finish\":{\"ground\":\"#ffffff\"},\"scene\":{\"light_direction\":\"%s\","
             "\"fill\":0},"
             "\"rules\":[{%s\"surface\":{\"technique\":\"hatch\",%s%s%s%s}}]}",
             light, rule, strstr(own, "\"ink\"") ? "" : "\"ink\":\"#000000\",",
             strstr(own, "\"paper\"") ? "" : "\"paper\":\"#ffffff\",",
             strstr(own, "\"texture\"") ? "" : "\"texture\":0,", own);
    return text;
}

void hatch_wall(shape *s, double half, double degrees)
{
    shape_quad(s, "wall", half, 0);
    if (degrees != 0)
        shape_place(s, dvec_of(0, 1, 0), degrees, dvec_of(0, 0, 0));
}

void hatch_model(shape *s)
{
    shape_sphere(s, "head", dvec_of(0, 0, 0), 1, 40, 80, false);
    shape_part *p = &s->parts[s->count - 1];
    for (uint32_t i = 0; i < p->vertex_count; i++) {
        float *v = p->positions[i], bump = 1 + 0.1f * sinf(4 * v[0] + 1) * sinf(5 * v[1]) * cosf(3 * v[2]);
        for (int k = 0; k < 3; k++)
            v[k] *= bump;
    }
    shape_torus(s, "ring", 1.35, 0.16, 64, 20);
    shape_place(s, dvec_of(1, 0.2, 0), 25, dvec_of(0, -0.1, 0));
    shape_box(s, "crate", dvec_of(-1.9, -0.6, 0.2), dvec_of(-1.2, 0.5, 0.9));
    shape_box(s, "bar", dvec_of(0.9, -1.1, -0.2), dvec_of(1.3, 1.2, 0.2));
}

shot_view hatch_front(int side, double half)
{
    return (shot_view){.width = side,
                       .height = side,
                       .eye = {0, 0, 2 * half},
                       .up = {0, 1, 0},
                       .orthographic = true,
                       .fov_deg = 53.13010235415598,
                       .without_maps = true};
}

/* --- measuring ------------------------------------------------------------------------------------------ */

double hatch_ink(const shot *s, int x, int y)
{
    return 1 - picture_shown(s->picture[4 * ((size_t)y * (size_t)s->width + (size_t)x)]);
}

double hatch_mean(const shot *s, int x0, int y0, int x1, int y1)
{
    double sum = 0;
    for (int y = y0; y < y1; y++)
        for (int x = x0; x < x1; x++)
            sum += hatch_ink(s, x, y);
    return sum / ((double)(x1 - x0) * (y1 - y0));
}

double hatch_mean_inside(const shot *s)
{
    double sum = 0;
    int    count = 0;
    for (int y = 0; y < s->height; y++)
        for (int x = 0; x < s->width; x++)
            if (!isinf(s->depth[y * s->width + x])) {
                sum += hatch_ink(s, x, y);
                count++;
            }
    return count ? sum / count : 0;
}

int hatch_odd_pixels(const shot *s)
{
    int odd = 0;
    for (int i = 0; i < s->width * s->height; i++) {
        const uint8_t *p = &s->picture[4 * i];
        odd += p[0] != p[1] || p[1] != p[2] || p[3] != 255;
    }
    return odd;
}

static double pixel(const shot *s, bool turned, int along, int row)
{
    return turned ? hatch_ink(s, row, along) : hatch_ink(s, along, row);
}

static int by_value(const void *a, const void *b)
{
    double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

static double quantile(double *values, int count, double fraction)
{
    qsort(values, (size_t)count, sizeof *values, by_value);
    return count ? values[(int)(fraction * (count - 1) + 0.5)] : 0;
}

/* Do lines cross columns more than rows, and by which cosine is a way along those longer than across the lines? */
static bool crossed_by(const shot *s, double *cosine)
{
    double xx = 0, yy = 0, xy = 0;
    for (int y = 1; y + 1 < s->height; y++)
        for (int x = 1; x + 1 < s->width; x++) {
            double dx = hatch_ink(s, x + 1, y) - hatch_ink(s, x - 1, y),
                   dy = hatch_ink(s, x, y + 1) - hatch_ink(s, x, y - 1);
            xx += dx * dx;
            yy += dy * dy;
            xy += dx * dy;
        }
    double angle = 0.5 * atan2(2 * xy, xx - yy); /* of the way across lines */
    bool   turned = fabs(sin(angle)) > fabs(cos(angle));
    *cosine = turned ? fabs(sin(angle)) : fabs(cos(angle));
    return turned;
}

/* Lines of this fraction of the greatest width are full ones. */
static const double FULL = 0.96;

enum { LINES_MAX = 1 << 16, ROWS_BETWEEN = 5 };

typedef struct found_lines {
    double *centre, *width;
    int    *row;
    int     count;
} found_lines;

/* Runs of ink along one row; those at its ends are left out. */
static void find_lines(found_lines *f, const shot *s, bool turned, int row, double cosine)
{
    int    length = turned ? s->height : s->width;
    double ink = 0, moment = 0;
    bool   whole = false;
    for (int i = 0; i < length && f->count < LINES_MAX; i++) {
        double here = pixel(s, turned, i, row);
        if (here > 0.004) {
            ink += here;
            moment += here * i;
            continue;
        }
        if (ink > 0.02 && whole) {
            f->centre[f->count] = moment / ink * cosine;
            f->width[f->count] = ink * cosine;
            f->row[f->count++] = row;
        }
        ink = moment = 0;
        whole = true;
    }
}

hatch_count hatch_count_lines(const shot *s)
{
    hatch_count out = {.mean = hatch_mean(s, 0, 0, s->width, s->height)};
    double      cosine = 1;
    bool        turned = crossed_by(s, &cosine);
    found_lines f = {check_alloc(LINES_MAX, sizeof(double)), check_alloc(LINES_MAX, sizeof(double)),
                     check_alloc(LINES_MAX, sizeof(int)), 0};
    for (int row = 2; row < (turned ? s->width : s->height); row += ROWS_BETWEEN)
        find_lines(&f, s, turned, row, cosine);
    double *values = check_alloc(LINES_MAX, sizeof *values), sum = 0, squares = 0;
    memcpy(values, f.width, (size_t)f.count * sizeof *values);
    double widest = quantile(values, f.count, 0.9), last = 0;
    int    count = 0, last_row = -1, all = 0;
    for (int i = 0; i < f.count; i++)
        if (i && f.row[i] == f.row[i - 1]) {
            out.all_period += f.centre[i] - f.centre[i - 1];
            all++;
        }
    out.all_period /= all ? all : 1;
    for (int i = 0; i < f.count; i++) {
        if (f.width[i] < FULL * widest)
            continue;
        if (f.row[i] == last_row)
            values[count++] = f.centre[i] - last;
        last = f.centre[i];
        last_row = f.row[i];
    }
    out.lines = f.count;
    out.period = quantile(values, count, 0.5);
    count = 0;
    for (int i = 0; i < f.count; i++)
        if (f.width[i] >= 0.5 * widest) {
            values[count++] = f.width[i];
            sum += f.width[i];
            squares += f.width[i] * f.width[i];
        }
    sum /= count ? count : 1;
    out.deviation = count ? sqrt(fmax(0, squares / count - sum * sum)) : 0;
    count = 0;
    for (int i = 0; i < f.count; i++)
        if (f.width[i] >= FULL * widest)
            values[count++] = f.width[i];
    out.width = quantile(values, count, 0.5);
    out.width_low = quantile(values, count, 0.05);
    out.width_high = quantile(values, count, 0.95);
    free(values);
    free(f.centre);
    free(f.width);
    free(f.row);
    return out;
}

void hatch_add_edges(const shot *s, int x0, int y0, int x1, int y1, hatch_edges *sum)
{
    for (int y = y0; y + 1 < y1; y++)
        for (int x = x0; x + 1 < x1; x++) {
            double here = hatch_ink(s, x, y), right = hatch_ink(s, x + 1, y) - here,
                   down = hatch_ink(s, x, y + 1) - here;
            sum->area += here > 0.1 && here < 0.9;
            sum->variation += hypot(right, down);
        }
}

double hatch_edge_width(const shot *s, int x0, int y0, int x1, int y1)
{
    hatch_edges sum = {0, 0};
    hatch_add_edges(s, x0, y0, x1, y1, &sum);
    return sum.variation > 0 ? sum.area / sum.variation : 0;
}

/* --- from frame to frame -------------------------------------------------------------------------------- */

static double depth_at(const shot *s, int x, int y)
{
    return (double)s->depth[y * s->width + x];
}

bool hatch_was_at(const shot *to, const shot *from, int x, int y, double *from_x, double *from_y)
{
    double depth = depth_at(to, x, y);
    dvec   origin, direction;
    if (isinf(depth))
        return false;
    shot_ray(to, x + 0.5, y + 0.5, &origin, &direction);
    dvec point = dvec_add(origin, dvec_scale(direction, depth)), position = shot_project(from, point);
    *from_x = position.x - 0.5;
    *from_y = position.y - 0.5;
    int left = (int)floor(*from_x), top = (int)floor(*from_y);
    if (left < 0 || top < 0 || left + 1 >= from->width || top + 1 >= from->height)
        return false;
    double wanted = -shot_to_eye(from, point, 1).z;
    for (int k = 0; k < 4; k++)
        if (!(fabs(depth_at(from, left + k % 2, top + k / 2) - wanted) < 0.02 * fabs(wanted)))
            return false;
    return true;
}

/* Ink smoothed with weights 1 2 1 both ways: edges of a pixel's width cannot be read between pixels, these can. */
static double *smoothed(const shot *s)
{
    double *out = check_alloc((size_t)s->width * (size_t)s->height, sizeof *out);
    for (int y = 1; y + 1 < s->height; y++)
        for (int x = 1; x + 1 < s->width; x++) {
            double sum = 0;
            for (int k = 0; k < 9; k++)
                sum += (2 - abs(k % 3 - 1)) * (2 - abs(k / 3 - 1)) * hatch_ink(s, x + k % 3 - 1, y + k / 3 - 1);
            out[y * s->width + x] = sum / 16;
        }
    return out;
}

static double between(const double *values, int width, double x, double y)
{
    int           left = (int)floor(x), top = (int)floor(y);
    double        u = x - left, v = y - top;
    const double *at = &values[top * width + left];
    return (1 - v) * ((1 - u) * at[0] + u * at[1]) + v * ((1 - u) * at[width] + u * at[width + 1]);
}

/* Is the surface around a pixel whole and not too steep? */
static bool in_the_open(const shot *s, int x, int y)
{
    if (x < 2 || y < 2 || x + 2 >= s->width || y + 2 >= s->height)
        return false;
    double depth = depth_at(s, x, y);
    for (int k = 0; k < 25; k++)
        if (!(fabs(depth_at(s, x + k % 5 - 2, y + k / 5 - 2) - depth) < 0.03 * depth))
            return false;
    return s->normal[y * s->width + x][2] > 0.4f;
}

static void compare_block(hatch_change *out, double sums[5], const shot *to, const shot *from, const double *now,
                          const double *then, int left, int top)
{
    double block = 0;
    int    whole = 0;
    for (int k = 0; k < 256; k++) {
        int    x = left + k % 16, y = top + k / 16;
        double fx, fy;
        if (!in_the_open(to, x, y) || !hatch_was_at(to, from, x, y, &fx, &fy) ||
            !in_the_open(from, (int)(fx + 0.5), (int)(fy + 0.5)))
            continue;
        double a = now[y * to->width + x], b = between(then, from->width, fx, fy);
        out->changed += fabs(a - b) > 0.25;
        out->mean += fabs(a - b);
        out->pixels++;
        block += a - b;
        whole++;
        sums[0] += a, sums[1] += b, sums[2] += a * a, sums[3] += b * b, sums[4] += a * b;
    }
    if (whole == 256)
        out->block = fmax(out->block, fabs(block / 256));
}

hatch_change hatch_compare(const shot *to, const shot *from)
{
    hatch_change out = {0};
    double       sums[5] = {0}, *now = smoothed(to), *then = smoothed(from);
    for (int y = 0; y < to->height; y += 16)
        for (int x = 0; x < to->width; x += 16)
            compare_block(&out, sums, to, from, now, then, x, y);
    double n = out.pixels ? out.pixels : 1;
    out.changed /= n;
    out.mean /= n;
    out.correlation = (sums[4] - sums[0] * sums[1] / n) /
                      sqrt(fmax((sums[2] - sums[0] * sums[0] / n) * (sums[3] - sums[1] * sums[1] / n), 1e-12));
    free(now);
    free(then);
    return out;
}
