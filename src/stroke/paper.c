/* Paper and pixels. A line that is there at one resolution is there at every other one: everything that decides which
 * lines there are sees the page as paper, in units of 1/96 inch, and what was found is laid out in pixels at the end.
 */
#include <math.h>

#include "stroke/stroke_private.h"

static double pixels_per_unit(const stroke_camera *page)
{
    double pixels = page->pixels_per_mm;
    return pixels > 0 && isfinite(pixels) ? pixels / PAPER_UNITS_PER_MM : 1;
}

/* Sides are whole numbers of units; what rounding them does to the aspect, paper_to_page takes back. */
static int units_of(int pixels, double scale)
{
    return (int)fmin(fmax(round(pixels / scale), 1), WINDOW_LIMIT / 4);
}

stroke_camera paper_camera(const stroke_camera *page)
{
    stroke_camera out = *page;
    double        scale = pixels_per_unit(page);
    out.width = units_of(page->width, scale);
    out.height = units_of(page->height, scale);
    out.pixels_per_mm = PAPER_UNITS_PER_MM;
    return out;
}

double paper_units_per_pixel(const stroke_view *v)
{
    return 1 / pixels_per_unit(&v->page);
}

stroke_options paper_options(const stroke_view *v, const stroke_options *options)
{
    stroke_options out = *options;
    float          units = (float)paper_units_per_pixel(v);
    out.simplify *= units;
    out.shortest *= units;
    out.crowd *= units;
    out.width *= units;
    return out;
}

void paper_to_page(stroke_set *set, const stroke_view *v)
{
    double x = (double)v->page.width / v->camera.width, y = (double)v->page.height / v->camera.height,
           arc = pixels_per_unit(&v->page);
    set->pixels_per_mm = arc * PAPER_UNITS_PER_MM;
    if (x == 1 && y == 1 && arc == 1)
        return;
    for (size_t i = 0; i < set->point_count; i++) {
        stroke_point *p = &set->points[i];
        p->x = (float)(p->x * x);
        p->y = (float)(p->y * y);
        p->arc = (float)(p->arc * arc);
    }
    for (size_t i = 0; i < set->stroke_count; i++) {
        set->strokes[i].phase = (float)(set->strokes[i].phase * arc);
        set->strokes[i].chain_length = (float)(set->strokes[i].chain_length * arc);
        set->strokes[i].size = (float)(set->strokes[i].size * arc);
    }
    for (size_t i = 0; i < set->mark_count; i++)
        set->marks[i].arc = (float)(set->marks[i].arc * arc);
}
