/* Where north is, and how long things are. */
#include <math.h>
#include <stdio.h>

#include "annotate/annotate_private.h"

static double dot(const double a[3], const double b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/* North and up in the middle of what is seen. North is +Y where Z is up, as surveyors have it, and −Z where Y is. */
static void find_directions(const lmn_scene *scene, double north[3], double zenith[3])
{
    bool z = scene->up == 'z', bent = dot(scene->zenith, scene->zenith) > 0;
    for (int k = 0; k < 3; k++) {
        north[k] = bent ? scene->north[k] : z ? k == 1 : -(k == 2);
        zenith[k] = bent ? scene->zenith[k] : k == (z ? 2 : 1);
    }
}

/* Is the ground in the middle of the view seen from below? */
static bool is_from_below(const annotation *a, double falls)
{
    const view_camera *c = a->view->camera;
    const plan        *p = a->view->plan;
    bool               z = p->scene->up == 'z';
    double             lowest = (double)(z ? p->box.min.z : p->box.min.y);
    return c->orthographic ? falls < -1e-3 : c->eye[z ? 2 : 1] < lowest;
}

/* On the page, in its middle: right and up; false where it points along the view. Ground on which the view hardly
 * falls, or above which it looks, is tilted towards the viewer around the page's level, so that ahead is up. */
static bool find_north(const annotation *a, double out[2])
{
    const double  TILT = 10 * 0.017453292519943295, LEVEL = 1e-3;
    const double *m = a->view->camera->view.m;
    double        north[3], zenith[3], axes[3][3], seen[3], length = 0;
    find_directions(a->view->plan->scene, north, zenith);
    for (int k = 0; k < 3; k++)
        for (int c = 0; c < 3; c++)
            axes[k][c] = m[4 * c + k]; /* right, up, back */
    for (int k = 0; k < 3; k++)
        seen[k] = dot(axes[k], north);
    double falls = dot(axes[2], zenith), up[2] = {dot(axes[0], zenith), dot(axes[1], zenith)},
           wide = hypot(up[0], up[1]);
    if (falls < sin(TILT) && wide > LEVEL && !is_from_below(a, falls)) {
        /* The page's upright, and what of north lies along and across it. */
        double angle = TILT - atan2(falls, wide);
        double along = (seen[0] * up[0] + seen[1] * up[1]) / wide, across = (seen[0] * up[1] - seen[1] * up[0]) / wide;
        along = along * cos(angle) - seen[2] * sin(angle);
        seen[0] = (along * up[0] + across * up[1]) / wide;
        seen[1] = (along * up[1] - across * up[0]) / wide;
    }
    length = hypot(seen[0], seen[1]);
    for (int k = 0; k < 2; k++)
        out[k] = length > 0 ? seen[k] / length : 0;
    out[1] = -out[1]; /* down the page, as sheets have it */
    return length > 1e-9;
}

void annotate_north(annotation *a)
{
    const double *page = a->view->box;
    double        north[2], size = 2.4 * a->letter;
    if (!find_north(a, north)) {
        warnings_add(a->warnings, WARNING_UNUSED,
                     "north lies along the view, which no needle can tell (finish.north_arrow)");
        return;
    }
    double middle[2] = {page[0] + page[2] - 2.2 * size, page[1] + 2.2 * size};
    double right[2] = {-north[1], north[0]};
    float  half[2][4][2];
    /* A needle, one half of it filled. */
    for (int i = 0; i < 2; i++) {
        const double side = i ? 0.34 : -0.34;
        const double at[4][2] = {{1, 0}, {-1, side}, {-0.65, 0}, {1, 0}};
        for (int k = 0; k < 4; k++)
            for (int c = 0; c < 2; c++)
                half[i][k][c] = (float)(middle[c] + size * (at[k][0] * north[c] + at[k][1] * right[c]));
        sheet_add_item(a->page, SHEET_PATH, a->group, i ? a->ink : a->paper, 0);
        sheet_add_path(a->page, &(sheet_path){.closed = true, .filled = true}, (const float(*)[2])half[i], 3);
        sheet_add_item(a->page, SHEET_PATH, a->group, a->ink, 0);
        sheet_add_path(a->page, &(sheet_path){.closed = true, .width = (float)(0.06 * a->letter)},
                       (const float(*)[2])half[i], 3);
    }
    sheet_add_text(a->page, a->group, a->ink, "N", middle[0] + 1.55 * size * north[0],
                   middle[1] + 1.55 * size * north[1] + 0.4 * a->letter, 1.2 * a->letter, 0);
    double reach = 2 * size;
    annotation_take(a, (const double[4]){middle[0] - reach, middle[1] - reach, middle[0] + reach, middle[1] + reach});
}

/* 1, 2 or 5 times a power of ten, no more than this. */
static double round_length(double most)
{
    double power = pow(10, floor(log10(most)));
    return (most >= 5 * power ? 5 : most >= 2 * power ? 2 : 1) * power;
}

static void print_length(char out[48], double length, double unit_mm)
{
    double metres = length * unit_mm / 1000;
    if (!(unit_mm > 0))
        snprintf(out, 48, "%.6g", length);
    else if (metres >= 1000)
        snprintf(out, 48, "%.6g km", metres / 1000);
    else if (metres >= 1)
        snprintf(out, 48, "%.6g m", metres);
    else
        snprintf(out, 48, "%.6g mm", metres * 1000);
}

void annotate_scale_bar(annotation *a)
{
    const annotated_view *v = a->view;
    char                  words[48];
    if (!v->camera->orthographic) {
        warnings_add(a->warnings, WARNING_UNUSED, "a scale bar needs a parallel projection (finish.scale_bar)");
        return;
    }
    /* Of a unit on the page, mm; lengths are round in metres where the unit is known. */
    double per_unit = v->camera->projection.m[0] / 2 * v->box[2], known = v->unit_mm > 0 ? v->unit_mm / 1000 : 1;
    double length = round_length(v->box[2] / 5 / per_unit * known) / known, wide = length * per_unit;
    double right = v->box[0] + v->box[2] - 2 * a->letter, bottom = v->box[1] + v->box[3] - 2 * a->letter;
    double high = 0.5 * a->letter, line = 0.06 * a->letter;
    print_length(words, length, v->unit_mm);
    for (int i = 0; i < 4; i++)
        annotation_fill(a, i % 2 ? a->paper : a->ink, right - wide + wide * i / 4, bottom - high,
                        right - wide + wide * (i + 1) / 4, bottom);
    sheet_add_rectangle(a->page, a->group, a->ink, right - wide, bottom - high, wide, high, line);
    sheet_add_text(a->page, a->group, a->ink, "0", right - wide, bottom - 1.6 * high, a->letter, 0);
    sheet_add_text(a->page, a->group, a->ink, words, right, bottom - 1.6 * high, a->letter, 1);
    annotation_take(a,
                    (const double[4]){right - wide - a->letter, bottom - 2.6 * a->letter, right + a->letter, bottom});
}
