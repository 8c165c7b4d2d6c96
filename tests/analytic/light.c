/* Soft shadows and ambient occlusion against counted rays; lines around hard shadows. Rows P30, P31, P15, P21. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "check.h"
#include "light_truth.h"
#include "picture.h"

static const double pi = 3.14159265358979323846;

static const dvec lights[3] = {{-1, 1.2, 0.5}, {0.4, 1, 1}, {1, 2, -0.6}};

static shot_view view_of(double degrees, bool orthographic)
{
    double angle = degrees * pi / 180;
    return (shot_view){.width = 400, .height = 320, .eye = {8 * sin(angle), 5, 8 * cos(angle)}, .up = {0, 1, 0}, .orthographic = orthographic};
}

/* --- the width of penumbras ------------------------------------------------------------------------------------- */

enum { PLATES = 3, EDGE = 240 };
static const double heights[PLATES] = {0.3, 0.6, 1.2};

/* Plates above a floor, in lanes; their shadows fall to the right. */
static void plates(shape *s)
{
    shape_box(s, "floor", dvec_of(-3, -0.1, -3.6), dvec_of(3, 0, 3.6));
    for (int k = 0; k < PLATES; k++)
        shape_box(s, "plate", dvec_of(-2.5, heights[k] - 0.002, -3.4 + 2.6 * k), dvec_of(-1.5, heights[k], -1.8 + 2.6 * k));
}

/* Between the places, in pixels, where a share grows beyond 0.1 and 0.9. */
static double width_of(const double *shares, int count)
{
    double at[2] = {-1, -1};
    for (int i = 1; i < count; i++)
        for (int k = 0; k < 2; k++) {
            double level = k ? 0.9 : 0.1;
            if (at[k] < 0 && shares[i - 1] < level && shares[i] >= level)
                at[k] = i - 1 + (level - shares[i - 1]) / (shares[i] - shares[i - 1]);
        }
    return at[0] < 0 || at[1] < 0 ? -1 : at[1] - at[0];
}

/* Along the middle of a lane, across the border of the plate's shadow. */
static double plate_width(const light_scene *l, const shot *s, const light_map *m, const tracer *t, int plate, double *truth)
{
    double drawn[EDGE], counted[EDGE];
    double z = -2.6 + 2.6 * plate, border = -1.5 + heights[plate], half = 0.3 * heights[plate] + 0.1;
    dvec   first = shot_project(s, dvec_of(border - half, 0, z)), end = shot_project(s, dvec_of(border + half, 0, z));
    int    y = (int)first.y, low = (int)first.x, count = (int)end.x - low;
    count = count < EDGE ? count : EDGE;
    for (int i = 0; i < count; i++) {
        dvec      origin, direction;
        trace_hit hit;
        shot_ray(s, low + i + 0.5, y + 0.5, &origin, &direction);
        drawn[i] = (double)m->drawn[y * m->width + low + i];
        counted[i] = tracer_hit(t, origin, direction, -INFINITY, INFINITY, NULL, &hit)
                         ? light_of_disc(t, dvec_add(origin, dvec_scale(direction, hit.t)), dvec_of(0, 1, 0), l->towards, l->softness, 4000) : 1;
    }
    *truth = width_of(counted, count);
    return width_of(drawn, count);
}

static void penumbras_grow(void)
{
    static const double angles[] = {4, 10, 20};
    light_scene l = {.file = "plates.glb", .towards = {-1, 1, 0}, .view = {.width = 960, .height = 640, .eye = {0, 14, 0}, .up = {0, 0, -1}, .orthographic = true}};
    plates(&l.s);
    tracer *t = tracer_create(&l.s);
    for (size_t a = 0; a < sizeof angles / sizeof *angles; a++) {
        shot      with, without;
        light_map m;
        l.softness = angles[a];
        if (!light_shot(&with, &l, true))
            break;
        if (light_shot(&without, &l, false)) {
            double widths[PLATES], truth[PLATES];
            light_map_drawn(&m, &with, &without);
            for (int k = 0; k < PLATES; k++) {
                widths[k] = plate_width(&l, &with, &m, t, k, &truth[k]);
                check_near("P30", widths[k], truth[k], fmax(1.5, 0.1 * truth[k]), "light of %g degrees, height %g: pixels from 0.1 to 0.9 (counted %.2f)", angles[a], heights[k], truth[k]);
            }
            if (angles[a] >= 10)
                check_near("P30", widths[2] / widths[1], heights[2] / heights[1], 0.2, "%g degrees: twice as high, twice as wide", angles[a]);
            light_map_release(&m);
            shot_release(&without);
        }
        shot_release(&with);
    }
    tracer_destroy(t);
    shape_release(&l.s);
}

/* --- whole pictures --------------------------------------------------------------------------------------------- */

static void court(shape *s)
{
    shape_box(s, "floor", dvec_of(-3, -0.1, -2.5), dvec_of(3, 0, 2.5));
    shape_box(s, "wall", dvec_of(-2.6, 0, -2.2), dvec_of(2, 1.3, -2));
    shape_box(s, "block", dvec_of(-1.6, 0, -0.8), dvec_of(-0.6, 0.9, 0.2));
    shape_sphere(s, "ball", dvec_of(0.9, 0.7, 0.1), 0.7, 48, 96, true);
    shape_box(s, "step", dvec_of(-0.2, 0, 1.2), dvec_of(1.4, 0.25, 1.8));
    shape_box(s, "pole", dvec_of(-2.2, 0, 1.3), dvec_of(-2.14, 1.6, 1.36));
    shape_box(s, "beam", dvec_of(1.9, 1.1, -1.5), dvec_of(2.6, 1.25, 1.8));
}

/* The score of one drawing. */
static bool score_of(const light_scene *l, bool sky, int rays, int step, const char *picture, light_score *out)
{
    shot      with, without;
    light_map m;
    bool      ok = light_shot(&with, l, true);
    if (ok && (ok = light_shot(&without, l, false))) {
        light_map_drawn(&m, &with, &without);
        if (sky)
            light_map_occlusion(&m, l, &with, rays, step);
        else
            light_map_shadows(&m, l, &with, rays, step);
        *out = light_compare(&m);
        light_map_write(&m, picture);
        light_map_release(&m);
        shot_release(&without);
    }
    if (ok)
        shot_release(&with);
    return ok;
}

static void shadows_are_a_discs(void)
{
    static const double angles[] = {3, 8, 20};
    for (int k = 0; k < 6; k++) {
        light_scene l = {.file = "court.glb", .towards = lights[k % 3], .view = view_of(k < 3 ? 25 : -35, k >= 3), .softness = angles[k % 3]};
        light_score score;
        court(&l.s);
        char name[32];
        snprintf(name, sizeof name, "shadows-%d.png", k);
        if (score_of(&l, false, 96, 1, name, &score)) {
            check_at_least("P30", score.places, 8000, "places compared, %s, %g degrees", l.view.orthographic ? "parallel rays" : "perspective", l.softness);
            check_at_most("P30", score.mean, 0.03, "mean difference of the light that arrives");
            check_at_most("P30", score.far, 0.015, "share of places that are off by more than 0.25 (worst %.2f)", score.worst);
        }
        shape_release(&l.s);
    }
}

int main(int argc, char **argv)
{
    static const check_case cases[] = {
        {"penumbra", penumbras_grow}, {"shadows", shadows_are_a_discs},
    };
    int status = check_main(argc, argv, "light", cases, sizeof cases / sizeof *cases);
    shot_end();
    return status;
}
