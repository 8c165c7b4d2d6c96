/* Where the views of a sheet lie: columns and rows around the front view, all at one scale, so that what belongs
 * together is in one line. */
#include <math.h>

#include "vector/vector_private.h"

enum { COLUMNS = 5, ROWS = 3, FRONT_COLUMN = 2, FRONT_ROW = 1 };

/* Column and row beside the front view, third angle. In first angle views lie on the other side; the pictorial one
 * stays where there is room. */
static void cell_of(lmn_view view, lmn_angle angle, int out[2])
{
    static const int third[VIEWS_MOST][2] = {
        [LMN_VIEW_ISO] = {1, -1},  [LMN_VIEW_FRONT] = {0, 0}, [LMN_VIEW_BACK] = {2, 0},  [LMN_VIEW_LEFT] = {-1, 0},
        [LMN_VIEW_RIGHT] = {1, 0}, [LMN_VIEW_TOP] = {0, -1},  [LMN_VIEW_BOTTOM] = {0, 1}};
    bool turned = angle == LMN_FIRST_ANGLE && view != LMN_VIEW_ISO && view != LMN_VIEW_BACK;
    out[0] = FRONT_COLUMN + (turned ? -third[view][0] : third[view][0]);
    out[1] = FRONT_ROW + (turned ? -third[view][1] : third[view][1]);
}

/* The room that columns or rows take: their sizes, and how many there are. */
static double total(const double *sizes, int count, int *used)
{
    double sum = 0;
    *used = 0;
    for (int i = 0; i < count; i++) {
        sum += fmax(sizes[i], 0);
        *used += sizes[i] >= 0;
    }
    return sum;
}

/* Where columns or rows begin, centred in the area; empty ones take no room. */
static void arrange(const double *sizes, int count, double scale, double gap, double from, double extent, double *out)
{
    int    used;
    double sum = total(sizes, count, &used) * scale + gap * used, at = from + (extent - sum) / 2;
    for (int i = 0; i < count; i++) {
        out[i] = at;
        if (sizes[i] >= 0)
            at += sizes[i] * scale + gap;
    }
}

double vector_place_views(const vector_layout *how, vector_view *views, size_t count, const double (*sizes)[2])
{
    double widths[COLUMNS] = {-1, -1, -1, -1, -1}, heights[ROWS] = {-1, -1, -1}, lefts[COLUMNS], tops[ROWS];
    int    columns, rows;
    for (size_t i = 0; i < count; i++) {
        int cell[2];
        cell_of(views[i].direction, how->angle, cell);
        widths[cell[0]] = fmax(widths[cell[0]], sizes[i][0]);
        heights[cell[1]] = fmax(heights[cell[1]], sizes[i][1]);
    }
    double width = total(widths, COLUMNS, &columns), height = total(heights, ROWS, &rows), scale = how->scale;
    if (!(scale > 0)) {
        double across = (how->area[2] * how->fit - how->gap * columns) / width,
               down = (how->area[3] * how->fit - how->gap * rows) / height;
        scale = fmin(width > 0 ? across : INFINITY, height > 0 ? down : INFINITY);
        if (!(scale > 0) || !isfinite(scale))
            scale = 1;
        if (how->usual)
            scale = vector_usual_scale(scale);
    }
    arrange(widths, COLUMNS, scale, how->gap, how->area[0], how->area[2], lefts);
    arrange(heights, ROWS, scale, how->gap, how->area[1], how->area[3], tops);
    for (size_t i = 0; i < count; i++) {
        int cell[2];
        cell_of(views[i].direction, how->angle, cell);
        views[i].box[0] = lefts[cell[0]];
        views[i].box[1] = tops[cell[1]];
        views[i].box[2] = widths[cell[0]] * scale + how->gap;
        views[i].box[3] = heights[cell[1]] * scale + how->gap;
    }
    return scale;
}
