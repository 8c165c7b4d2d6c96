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

/* Columns and rows of views in line, and what lies apart: in columns to the right, or in rows below. */
typedef struct plan_of_page {
    double widths[COLUMNS], heights[ROWS]; /* of the model; −1: empty */
    bool   below;
} plan_of_page;

/* The scale of a detail: its own, or a usual one that enlarges it at least twice. */
static double detail_scale(const vector_view *v, double scale)
{
    static const double steps[] = {1, 2, 5, 10};
    double              least = 2 * scale, unit = pow(10, floor(log10(least) + 1e-9));
    if (v->extra->scale > 0)
        return v->extra->scale;
    for (size_t i = 0; i < sizeof steps / sizeof *steps; i++)
        if (unit * steps[i] >= least * (1 - 1e-9))
            return unit * steps[i];
    return least;
}

static double scale_of(const vector_view *v, double scale)
{
    return v->extra && v->extra->kind == DRAFT_DETAIL ? detail_scale(v, scale) : scale;
}

/* Puts what lies apart one behind the other, in as many lines as are needed; returns how deep they are. `place`: sets
 * their boxes, from the corner of the room. */
static double stack(const vector_layout *how, vector_view *views, size_t count, const double (*sizes)[2], double scale,
                    bool below, bool place, const double corner[2])
{
    int    along = below ? 0 : 1;
    double at = 0, depth = 0, line = 0;
    for (size_t i = 0; i < count; i++) {
        vector_view *v = &views[i];
        if (!v->apart)
            continue;
        double own = scale_of(v, scale), size[2] = {sizes[i][0] * own + how->gap, sizes[i][1] * own + how->gap};
        if (at > 0 && at + size[along] > how->area[2 + along]) {
            depth += line;
            at = line = 0;
        }
        if (place) {
            v->box[along] = corner[along] + at;
            v->box[1 - along] = corner[1 - along] + depth;
            v->box[2] = size[0];
            v->box[3] = size[1];
            v->scale = own;
        }
        at += size[along];
        line = fmax(line, size[1 - along]);
    }
    return depth + line;
}

static bool fits(const vector_layout *how, const plan_of_page *p, vector_view *views, size_t count,
                 const double (*sizes)[2], double scale, bool below)
{
    int    columns, rows;
    double width = total(p->widths, COLUMNS, &columns) * scale + how->gap * columns;
    double height = total(p->heights, ROWS, &rows) * scale + how->gap * rows;
    double depth = stack(how, views, count, sizes, scale, below, false, NULL);
    *(below ? &height : &width) += depth;
    return width <= how->area[2] * how->fit * (1 + 1e-9) && height <= how->area[3] * how->fit * (1 + 1e-9);
}

/* The largest scale at which all lies on the page, from one at which what is in line does. */
static double shrink(const vector_layout *how, const plan_of_page *p, vector_view *views, size_t count,
                     const double (*sizes)[2], double most, bool below)
{
    double low = most * 1e-3, high = most;
    if (fits(how, p, views, count, sizes, high, below))
        return high;
    for (int i = 0; i < 50; i++) {
        double middle = sqrt(low * high);
        *(fits(how, p, views, count, sizes, middle, below) ? &low : &high) = middle;
    }
    return low;
}

static double usual_that_fits(const vector_layout *how, const plan_of_page *p, vector_view *views, size_t count,
                              const double (*sizes)[2], double scale)
{
    double usual = vector_usual_scale(scale);
    for (int i = 0; i < 40 && !fits(how, p, views, count, sizes, usual, p->below); i++)
        usual = vector_usual_scale(usual * 0.97);
    return usual;
}

/* As large as fits. */
static double choose_scale(const vector_layout *how, plan_of_page *p, vector_view *views, size_t count,
                           const double (*sizes)[2])
{
    int    columns, rows;
    double width = total(p->widths, COLUMNS, &columns), height = total(p->heights, ROWS, &rows);
    double across = (how->area[2] * how->fit - how->gap * columns) / width,
           down = (how->area[3] * how->fit - how->gap * rows) / height;
    double scale = fmin(width > 0 ? across : INFINITY, height > 0 ? down : INFINITY);
    bool   any = false;
    if (!(scale > 0) || !isfinite(scale))
        scale = 1;
    for (size_t i = 0; i < count; i++)
        any = any || views[i].apart;
    if (!any)
        return how->usual ? vector_usual_scale(scale) : scale;
    double beside = shrink(how, p, views, count, sizes, scale, false),
           below = shrink(how, p, views, count, sizes, scale, true);
    p->below = below > beside * 1.001;
    scale = p->below ? below : beside;
    return how->usual ? usual_that_fits(how, p, views, count, sizes, scale) : scale;
}

static void place_apart(const vector_layout *how, const plan_of_page *p, vector_view *views, size_t count,
                        const double (*sizes)[2], double scale, vector_layout *left)
{
    int    columns, rows, across = p->below ? 1 : 0;
    double depth = stack(how, views, count, sizes, scale, p->below, false, NULL), corner[2], low = INFINITY, high = 0;
    double used = across ? total(p->heights, ROWS, &rows) * scale : total(p->widths, COLUMNS, &columns) * scale;
    used += how->gap * (across ? rows : columns);
    *left = *how;
    if (!(depth > 0))
        return;
    /* What is empty is shared: before, between and behind. */
    double room = fmax(how->area[2 + across] - used - depth, 0) / 3;
    left->area[across] += room;
    left->area[2 + across] = used;
    corner[across] = how->area[across] + how->area[2 + across] - depth - room;
    corner[1 - across] = how->area[1 - across];
    stack(how, views, count, sizes, scale, p->below, true, corner);
    for (size_t i = 0; i < count; i++)
        if (views[i].apart) {
            low = fmin(low, views[i].box[1 - across]);
            high = fmax(high, views[i].box[1 - across] + views[i].box[3 - across]);
        }
    for (size_t i = 0; i < count; i++)
        if (views[i].apart)
            views[i].box[1 - across] += fmax(how->area[1 - across] + how->area[3 - across] / 2 - (low + high) / 2, 0);
}

double vector_place_views(const vector_layout *how, vector_view *views, size_t count, const double (*sizes)[2])
{
    plan_of_page  p = {{-1, -1, -1, -1, -1}, {-1, -1, -1}, false};
    double        lefts[COLUMNS], tops[ROWS];
    vector_layout left;
    for (size_t i = 0; i < count; i++) {
        int cell[2];
        if (views[i].apart)
            continue;
        cell_of(views[i].direction, how->angle, cell);
        p.widths[cell[0]] = fmax(p.widths[cell[0]], sizes[i][0]);
        p.heights[cell[1]] = fmax(p.heights[cell[1]], sizes[i][1]);
    }
    double scale = how->scale > 0 ? how->scale : choose_scale(how, &p, views, count, sizes);
    if (how->scale > 0)
        p.below = !fits(how, &p, views, count, sizes, scale, false) && fits(how, &p, views, count, sizes, scale, true);
    place_apart(how, &p, views, count, sizes, scale, &left);
    arrange(p.widths, COLUMNS, scale, how->gap, left.area[0], left.area[2], lefts);
    arrange(p.heights, ROWS, scale, how->gap, left.area[1], left.area[3], tops);
    for (size_t i = 0; i < count; i++) {
        int cell[2];
        if (views[i].apart)
            continue;
        cell_of(views[i].direction, how->angle, cell);
        views[i].box[0] = lefts[cell[0]];
        views[i].box[1] = tops[cell[1]];
        views[i].box[2] = p.widths[cell[0]] * scale + how->gap;
        views[i].box[3] = p.heights[cell[1]] * scale + how->gap;
    }
    return scale;
}
