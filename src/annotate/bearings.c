/* Where north is, and how long things are. */
#include <math.h>
#include <stdio.h>

#include "annotate/annotate_private.h"

/* On the page, seen from the scene's middle; false where it points along the view. North is +Y where Z is up, as
 * surveyors have it, and −Z where Y is. */
static bool find_north(const annotation *a, double out[2])
{
    const plan *p = a->view->plan;
    double      middle[3], ahead[3], from[2], to[2], step = 1e-3 * fmax(box3_diagonal(p->box), 1e-9);
    box3_middle(p->box, middle);
    for (int k = 0; k < 3; k++)
        ahead[k] = middle[k];
    ahead[p->scene->up == 'z' ? 1 : 2] += p->scene->up == 'z' ? step : -step;
    if (!annotation_project(a, middle, from) || !annotation_project(a, ahead, to))
        return false;
    double length = hypot(to[0] - from[0], to[1] - from[1]);
    for (int k = 0; k < 2; k++)
        out[k] = length > 0 ? (to[k] - from[k]) / length : 0;
    return length > 0;
}

void annotate_north(annotation *a)
{
    const double *page = a->view->box;
    double        north[2], size = 2.4 * a->letter;
    if (!find_north(a, north))
        return;
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
