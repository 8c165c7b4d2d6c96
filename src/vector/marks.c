/* Dots and strokes that lie on surfaces, on the sheet: dots as dots of a few sizes, strokes as outlines, since they
 * run out at their ends, or for plotters by their axis. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "plan/plan.h"
#include "vector/vector_private.h"
#include "surface/marks.h"
#include "surface/surface.h"

enum { SIZE_STEPS = 20 /* to the pixel: dots of few sizes are few paths */ };
static const float bend_most =
    0.08f; /* pixels by which points of a stroke may be moved, and its width changed, for fewer of them */
static const float surely_there = 0.001f; /* least fraction over which marks come and go */
static const float blunt_end = 0.2f;      /* pixels: half a width from which ends are round */

/* A dot or line in the order of the sheet. */
typedef struct placed {
    uint32_t part;
    int32_t  size;
    size_t   index; /* in the page of marks */
} placed;

typedef struct mark_writer {
    const vector_ink *ink;
    const marks_page *page;
    float             pen_width; /* of plotters, pixels; 0: each mark has its own */
    const char       *name;      /* of groups: "dots", "marks" */
    int32_t           group;     /* of them all; −1: not there yet */
    uint32_t          own;       /* of the part */
    vector_pen        pen;
    ribbon_point     *points;
    size_t            capacity;
} mark_writer;

const technique_use *vector_rule_marks(const rule *r)
{
    const technique_use *surface = rule_use(r, KIND_SURFACE);
    return surface && surface->technique->surface->marks && !rule_shades_again(r) ? surface : NULL;
}

static int compare_placed(const void *a, const void *b)
{
    const placed *one = a, *other = b;
    if (one->part != other->part)
        return one->part < other->part ? -1 : 1;
    if (one->size != other->size)
        return one->size > other->size ? -1 : 1;
    return one->index < other->index ? -1 : one->index > other->index;
}

static void open_part(mark_writer *w, uint32_t part)
{
    const vector_ink *ink = w->ink;
    if (w->group < 0)
        w->group = (int32_t)sheet_add_group(ink->page, (int32_t)ink->group, w->name, NULL, 0);
    bool known = part > 0 && part <= ink->scene->part_count;
    w->own = sheet_add_group(ink->page, w->group, known ? ink->scene->parts[part - 1].name : w->name, w->name, part);
}

/* --- dots ----------------------------------------------------------------------------------------------- */

static bool put_dots_of_size(mark_writer *w, const placed *dots, size_t count)
{
    vector_pen *pen = &w->pen;
    if (!mem_grow((void **)&pen->points, &pen->capacity, count, sizeof *pen->points))
        return false;
    for (size_t i = 0; i < count; i++) {
        const marks_page_point *d = &w->page->dots[dots[i].index];
        pen->points[i][0] = (float)(w->ink->origin[0] + (double)d->x / VECTOR_PIXELS_PER_MM);
        pen->points[i][1] = (float)(w->ink->origin[1] + (double)d->y / VECTOR_PIXELS_PER_MM);
    }
    sheet_path style = {.width = (float)((double)dots->size / SIZE_STEPS / VECTOR_PIXELS_PER_MM)};
    sheet_add_item(w->ink->page, SHEET_DOTS, w->own, w->page->ink, 0);
    size_t step = w->pen_width > 0 ? 1 : count;
    for (size_t i = 0; i < count; i += step)
        sheet_add_path(w->ink->page, &style, (const float(*)[2])pen->points + i, step);
    return true;
}

static bool put_dots(mark_writer *w)
{
    size_t  count = w->page->dot_count;
    placed *dots = mem_calloc(count, sizeof *dots);
    bool    good = dots != NULL;
    for (size_t i = 0; good && i < count; i++) {
        const marks_page_point *d = &w->page->dots[i];
        dots[i] =
            (placed){d->part, (int32_t)fmaxf(roundf((w->pen_width > 0 ? w->pen_width : d->width) * SIZE_STEPS), 1), i};
    }
    if (good && count)
        qsort(dots, count, sizeof *dots, compare_placed);
    for (size_t first = 0, end; good && first < count; first = end) {
        for (end = first + 1; end < count && dots[end].part == dots[first].part && dots[end].size == dots[first].size;)
            end++;
        if (first == 0 || dots[first].part != dots[first - 1].part)
            open_part(w, dots[first].part);
        good = put_dots_of_size(w, &dots[first], end - first);
    }
    mem_free(dots);
    return good;
}

/* --- strokes -------------------------------------------------------------------------------------------- */

/* Do the points between two of a line lie where the straight one between these has them, as wide? */
static bool is_straight(const marks_page_point *a, size_t count)
{
    const marks_page_point *b = &a[count - 1];
    float                   dx = b->x - a->x, dy = b->y - a->y, square = dx * dx + dy * dy;
    for (size_t i = 1; i + 1 < count; i++) {
        float along = square > 0 ? ((a[i].x - a->x) * dx + (a[i].y - a->y) * dy) / square : 0;
        along = fminf(fmaxf(along, 0), 1);
        if (hypotf(a->x + along * dx - a[i].x, a->y + along * dy - a[i].y) > bend_most ||
            fabsf(a->width + along * (b->width - a->width) - a[i].width) > bend_most)
            return false;
    }
    return true;
}

/* A line with no more points than it needs; 0: memory is gone. */
static size_t take_points(mark_writer *w, const marks_page_line *l)
{
    const marks_page_point *from = &w->page->points[l->first];
    size_t                  count = 0;
    if (!mem_grow((void **)&w->points, &w->capacity, l->count, sizeof *w->points))
        return 0;
    for (size_t i = 0, next; i < l->count; i = next) {
        w->points[count++] = (ribbon_point){.x = from[i].x, .y = from[i].y, .half = from[i].width / 2, .alpha = 1};
        for (next = i + 1; next + 1 < l->count && is_straight(&from[i], next + 2 - i);)
            next++;
    }
    return count;
}

/* The width of what is drawn by its axis: one with the same ink. */
static float mean_width(const ribbon_point *points, size_t count)
{
    float area = 0, length = 0;
    for (size_t i = 1; i < count; i++) {
        float step = hypotf(points[i].x - points[i - 1].x, points[i].y - points[i - 1].y);
        area += step * (points[i].half + points[i - 1].half);
        length += step;
    }
    return length > 0 ? area / length : 2 * points->half;
}

static bool put_line(mark_writer *w, const marks_page_line *l)
{
    size_t count = take_points(w, l);
    if (count == 0)
        return false;
    if (w->ink->lines_only) {
        float width =
            w->pen_width > 0 ? w->pen_width : fmaxf(roundf(mean_width(w->points, count) * SIZE_STEPS), 1) / SIZE_STEPS;
        vector_pen_even(&w->pen, w->points, count,
                        &(sheet_path){.width = (float)((double)width / VECTOR_PIXELS_PER_MM), .cap = SHEET_CAP_ROUND});
    } else {
        bool blunt = w->points[0].half > blunt_end || w->points[count - 1].half > blunt_end;
        vector_pen_uneven(&w->pen, w->points, count, blunt ? RIBBON_ROUND : RIBBON_BUTT);
    }
    return !w->pen.failed;
}

static bool put_lines(mark_writer *w)
{
    size_t  count = w->page->line_count;
    placed *lines = mem_calloc(count, sizeof *lines);
    bool    good = lines != NULL;
    for (size_t i = 0; good && i < count; i++)
        lines[i] = (placed){w->page->lines[i].part, 0, i};
    if (good && count)
        qsort(lines, count, sizeof *lines, compare_placed);
    for (size_t i = 0; good && i < count; i++) {
        if (i == 0 || lines[i].part != lines[i - 1].part) {
            open_part(w, lines[i].part);
            sheet_add_item(w->ink->page, SHEET_PATH, w->own, w->page->ink, 0);
        }
        good = put_line(w, &w->page->lines[lines[i].index]);
    }
    mem_free(lines);
    return good;
}

/* --- both ----------------------------------------------------------------------------------------------- */

static void count_marks(vector_marks *m, const marks_page *page, size_t part_count)
{
    m->dots += page->dot_count;
    m->lines += page->line_count;
    for (size_t i = 0; i < page->dot_count + page->line_count; i++) {
        uint32_t part = i < page->dot_count ? page->dots[i].part : page->lines[i - page->dot_count].part;
        if (part > 0 && part <= part_count)
            m->part_marks[part - 1]++;
    }
}

/* What is cut away hides itself. */
static void count_in_front(void *user, const double (*positions)[3], size_t count, uint32_t *out)
{
    const vector_marks *m = user;
    stroke_view_count(m->view, positions, count, out);
    for (size_t i = 0; i < count && m->cut; i++)
        if (out[i] == 0 && vector_is_cut_away(m->cut, positions[i]))
            out[i] = 1;
}

/* One pen draws all marks alike: none comes or goes by its size. */
static float settle_pen(technique_use *surface)
{
    mark_style   style = {.diameter = 1};
    mark_values *common = surface->values;
    common->fade = surely_there;
    if (surface->technique->surface->as_marks)
        surface->technique->surface->as_marks(surface->values);
    surface_mark_style(&style, surface);
    return style.diameter;
}

lmn_status vector_put_marks(const vector_ink *ink, vector_marks *m, lmn_error *error)
{
    const technique_use *asked = m->options.surface;
    technique_use        surface = {asked->technique, mem_copy(asked->values, asked->technique->params_size)};
    mark_page_options    options = m->options;
    marks_page           page = {.dots = NULL};
    mark_values         *common = surface.values;
    if (!common)
        return error_memory(error);
    if (isnan(common->paper.r))
        common->paper = m->ground;
    float pen_width = m->one_pen ? settle_pen(&surface) : 0;
    options.surface = &surface;
    options.hidden = count_in_front;
    options.user = m;
    lmn_status  status = marks_on_page(&page, &options, error);
    mark_writer w = {
        .ink = ink, .page = &page, .pen_width = pen_width, .name = "dots", .group = -1, .pen = {.how = ink}};
    bool good = status != LMN_OK || put_dots(&w);
    w.name = "marks";
    w.group = -1;
    good = good && (status != LMN_OK || put_lines(&w));
    if (status == LMN_OK)
        count_marks(m, &page, ink->scene->part_count);
    mem_free(w.pen.points);
    mem_free(w.points);
    marks_page_release(&page);
    mem_free(surface.values);
    return good && !ink->page->failed ? status : error_memory(error);
}
