#include "light_truth.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "check.h"
#include "picture.h"

static const double pi = 3.14159265358979323846;

enum { STRONG = 40 }; /* sRGB; darker pixels say too little */

/* The light as the viewer sees it. */
dvec light_seen_from(const shot_view *view, dvec direction)
{
    dvec back = dvec_unit(dvec_sub(view->eye, view->target)), right = dvec_unit(dvec_cross(view->up, back)),
         up = dvec_cross(back, right);
    return dvec_of(dvec_dot(right, direction), dvec_dot(up, direction), dvec_dot(back, direction));
}

bool light_shot(shot *out, const light_scene *l, bool kept_off)
{
    char look[1024];
    dvec eye = light_seen_from(&l->view, l->towards);
    snprintf(look, sizeof look,
             "{\"version\":1,\"name\":\"t\",\"scene\":{\"fill\":%g,\"rim\":%g,\"light_scale\":0.99,\"light_direction\":"
             "\"%.9f,%."
             "9f,%.9f\",\"shadows\":%s,\"shadow_softness\":%g,\"occlusion\":%g,"
             "\"occlusion_radius\":%g},\"rules\":[{\"surface\":{\"technique\":\"lambert\",\"ambient\":0}%s}]}",
             l->fill, l->rim, eye.x, eye.y, eye.z, kept_off && l->softness >= 0 ? "true" : "false",
             l->softness > 0 && kept_off ? l->softness : 0, kept_off ? l->occlusion : 0,
             l->radius > 0 ? l->radius : 0.1, l->layers ? l->layers : "");
    if (strstr(l->file, ".csg"))
        return shot_take(out, l->file, look, NULL, &l->view);
    return shot_of_shape(out, &l->s, l->file, look, NULL, &l->view);
}

void light_map_drawn(light_map *out, const shot *with, const shot *without)
{
    size_t count = (size_t)with->width * (size_t)with->height;
    *out = (light_map){.width = with->width,
                       .height = with->height,
                       .drawn = check_alloc(count, sizeof(float)),
                       .truth = check_alloc(count, sizeof(float))};
    for (size_t i = 0; i < count; i++) {
        bool tells = without->depth[i] < INFINITY && without->picture[4 * i] >= STRONG && without->picture[4 * i] < 255;
        out->drawn[i] =
            tells ? (float)(picture_linear(with->picture[4 * i]) / picture_linear(without->picture[4 * i])) : -1;
        out->truth[i] = -1;
    }
}

/* Points spread evenly over the unit disc; the caller's. */
static double (*disc_points(int count))[2]
{
    double(*points)[2] = check_alloc((size_t)count, sizeof *points);
    for (int i = 0; i < count; i++) {
        double radius = sqrt((i + 0.5) / count), angle = 2.399963229728653 * i;
        points[i][0] = radius * cos(angle);
        points[i][1] = radius * sin(angle);
    }
    return points;
}

static void axes_of(dvec along, dvec *a, dvec *b)
{
    *a = dvec_unit(dvec_cross(along, fabs(along.x) < 0.6 ? dvec_of(1, 0, 0) : dvec_of(0, 1, 0)));
    *b = dvec_cross(along, *a);
}

static double disc_of(const tracer *t, dvec position, dvec normal, dvec towards, double degrees,
                      const double (*points)[2], int rays)
{
    dvec     along = dvec_unit(towards), a, b, origin = dvec_add(position, dvec_scale(normal, 1e-5));
    int      seen = 0;
    uint32_t last = UINT32_MAX;
    double   half = tan(degrees / 2 * pi / 180);
    axes_of(along, &a, &b);
    for (int i = 0; i < rays; i++) {
        dvec ray = dvec_add(along, dvec_add(dvec_scale(a, points[i][0] * half), dvec_scale(b, points[i][1] * half)));
        seen += !tracer_blocked(t, origin, ray, 0, INFINITY, &last);
    }
    return (double)seen / rays;
}

double light_of_disc(const tracer *t, dvec position, dvec normal, dvec towards, double degrees, int rays)
{
    double(*points)[2] = disc_points(rays),
    light = disc_of(t, position, normal, towards, degrees, (const double(*)[2])points, rays);
    free(points);
    return light;
}

static double sky_of(const tracer *t, dvec position, dvec normal, double radius, const double (*points)[2], int rays)
{
    dvec      a, b, origin = dvec_add(position, dvec_scale(normal, 1e-5));
    double    hidden = 0;
    trace_hit hit;
    axes_of(normal, &a, &b);
    for (int i = 0; i < rays; i++) {
        double x = points[i][0], y = points[i][1]; /* on the disc evenly: on the hemisphere by the cosine */
        dvec ray = dvec_add(dvec_scale(normal, sqrt(1 - x * x - y * y)), dvec_add(dvec_scale(a, x), dvec_scale(b, y)));
        if (tracer_hit(t, origin, ray, 0, radius, NULL, &hit)) {
            double near = 1 - hit.t * hit.t / (radius * radius);
            hidden += near * near;
        }
    }
    return 1 - hidden / rays;
}

static double diagonal_of(const shape *s)
{
    dvec low = {INFINITY, INFINITY, INFINITY}, high = {-INFINITY, -INFINITY, -INFINITY};
    for (size_t i = 0; i < s->count; i++)
        for (uint32_t k = 0; k < s->parts[i].vertex_count; k++) {
            dvec p = shape_point(&s->parts[i], k);
            low = dvec_of(fmin(low.x, p.x), fmin(low.y, p.y), fmin(low.z, p.z));
            high = dvec_of(fmax(high.x, p.x), fmax(high.y, p.y), fmax(high.z, p.z));
        }
    return dvec_length(dvec_sub(high, low));
}

static void fill(light_map *m, const light_scene *l, const shot *s, int rays, int step, bool sky)
{
    tracer   *t = tracer_create(&l->s);
    trace_map seen;
    double    w, radius = l->radius * diagonal_of(&l->s), (*points)[2] = disc_points(rays);
    trace_map_make(&seen, t, s);
    size_t                count;
    const trace_triangle *triangles = tracer_triangles(t, &count);
    dvec                  viewer = shot_viewer(s, &w);
    for (int y = 0; y < m->height; y++)
        for (int x = 2 * y % step; x < m->width;
             x += step) { /* shifted from row to row, so that odd positions come up as often as even ones */
            dvec      origin, direction;
            trace_hit hit;
            size_t    at = (size_t)y * (size_t)m->width + (size_t)x;
            if (m->drawn[at] < 0 || trace_map_border(&seen, x, y, 0.02))
                continue;
            shot_ray(s, x + 0.5, y + 0.5, &origin, &direction);
            if (!tracer_hit(t, origin, direction, s->orthographic ? -INFINITY : 0, INFINITY, NULL, &hit))
                continue;
            dvec position = dvec_add(origin, dvec_scale(direction, hit.t)), normal = triangles[hit.triangle].flat;
            if (dvec_dot(normal, w > 0 ? dvec_sub(viewer, position) : viewer) < 0)
                normal = dvec_scale(normal, -1);
            if (!sky && dvec_dot(normal, dvec_unit(l->towards)) < 0.12)
                continue;
            m->truth[at] =
                (float)(sky ? sky_of(t, position, normal, radius, (const double(*)[2])points, rays)
                            : disc_of(t, position, normal, l->towards, l->softness, (const double(*)[2])points, rays));
        }
    free(points);
    trace_map_release(&seen);
    tracer_destroy(t);
}

void light_map_shadows(light_map *m, const light_scene *l, const shot *s, int rays, int step)
{
    fill(m, l, s, rays, step, false);
}

void light_map_occlusion(light_map *m, const light_scene *l, const shot *s, int rays, int step)
{
    fill(m, l, s, rays, step, true);
}

void light_map_release(light_map *m)
{
    free(m->drawn);
    free(m->truth);
    *m = (light_map){0};
}

light_score light_compare(const light_map *m)
{
    light_score score = {0};
    for (size_t i = 0; i < (size_t)m->width * (size_t)m->height; i++) {
        if (m->drawn[i] < 0 || m->truth[i] < 0)
            continue;
        double off = fabs((double)m->drawn[i] - (double)m->truth[i]);
        score.mean += off;
        score.worst = fmax(score.worst, off);
        score.far += off > 0.25;
        score.wrong += off > 0.5;
        score.positions++;
    }
    if (score.positions) {
        score.mean /= score.positions;
        score.far /= score.positions;
        score.wrong /= score.positions;
    }
    return score;
}

void light_map_write(const light_map *m, const char *name)
{
    size_t   row = (size_t)m->width;
    uint8_t *rgba = check_alloc(4 * 2 * row * (size_t)m->height, 1);
    for (size_t y = 0; y < (size_t)m->height; y++)
        for (size_t x = 0; x < 2 * row; x++) {
            float    value = x < row ? m->drawn[y * row + x] : m->truth[y * row + x - row];
            uint8_t *out = &rgba[4 * (y * 2 * row + x)];
            memset(out, value < 0 ? 0 : (int)lrintf(255 * fminf(value, 1)), 3);
            out[2] = value < 0 ? 90 : out[2];
            out[3] = 255;
        }
    picture_write_rgba(check_path("%s", name), rgba, 2 * m->width, m->height);
    free(rgba);
}
