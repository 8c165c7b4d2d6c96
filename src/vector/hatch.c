/* Hatching of cut faces on the sheet, in groups of their parts: faces that are seen as a whole are areas that are
 * filled with lines, of others each line is one. */
#include "stroke/hatch.h"

#include "base/memory.h"
#include "vector/vector_private.h"

typedef struct hatch_writer {
    const vector_ink   *ink;
    const scene_values *values;
    const colour       *colours; /* per part */
    int32_t             all;     /* the group of them all; −1: not there yet */
    uint32_t            own, part;
} hatch_writer;

static void open_part(hatch_writer *w, uint32_t part)
{
    const vector_ink *ink = w->ink;
    if (w->all < 0)
        w->all = (int32_t)sheet_add_group(ink->page, (int32_t)ink->group, "hatch", "hatch", 0);
    if (part == w->part)
        return;
    w->part = part;
    w->own = sheet_add_group(ink->page, w->all, ink->scene->parts[part - 1].name, "hatch", part);
}

static void to_sheet(const vector_ink *ink, double x, double y, double out[2])
{
    out[0] = ink->origin[0] + x / VECTOR_PIXELS_PER_MM;
    out[1] = ink->origin[1] + y / VECTOR_PIXELS_PER_MM;
}

static double width_of(const hatch_writer *w)
{
    return (double)w->values->cut_width / VECTOR_PIXELS_PER_MM;
}

static void put_line(hatch_writer *w, const hatch_line *l)
{
    double ends[2][2];
    open_part(w, l->part);
    for (int k = 0; k < 2; k++)
        to_sheet(w->ink, (double)l->ends[k][0], (double)l->ends[k][1], ends[k]);
    sheet_add_line(w->ink->page, w->own, w->colours[l->part - 1], ends[0], ends[1], width_of(w));
}

static void put_area(hatch_writer *w, const hatch_areas *areas, const hatch_area *a)
{
    sheet_hatch h = {.apart = a->apart / VECTOR_PIXELS_PER_MM, .angle = a->angle, .width = width_of(w)};
    to_sheet(w->ink, a->origin[0], a->origin[1], h.origin);
    open_part(w, a->part);
    sheet_add_hatch(w->ink->page, w->own, w->colours[a->part - 1], &h);
    for (uint32_t i = a->first; i < a->first + a->count; i++) {
        float(*points)[2] = areas->points + areas->loops[i];
        size_t count = areas->loops[i + 1] - areas->loops[i];
        for (size_t k = 0; k < count; k++) {
            double at[2];
            to_sheet(w->ink, (double)points[k][0], (double)points[k][1], at);
            points[k][0] = (float)at[0];
            points[k][1] = (float)at[1];
        }
        sheet_add_path(w->ink->page, &(sheet_path){.closed = true, .filled = true}, (const float(*)[2])points, count);
    }
}

lmn_status vector_put_hatch(const vector_ink *ink, const stroke_view *view, const scene_values *v, const bool *parts,
                            const colour *colours, bool loose, uint64_t *count, stroke_check *check, lmn_error *error)
{
    hatch_lines  lines;
    hatch_areas  areas = {.items = NULL};
    hatch_writer w = {.ink = ink, .values = v, .colours = colours, .all = -1};
    lmn_status   status = hatch_find(&lines, loose ? NULL : &areas, view, (double)v->cut_hatch,
                                     (double)v->cut_angle * (3.14159265358979323846 / 180), parts, error);
    for (size_t i = 0, area = 0; i < lines.count && status == LMN_OK; i++) {
        if (lines.items[i].area == 0)
            put_line(&w, &lines.items[i]);
        if (lines.items[i].area <= area)
            continue;
        area = lines.items[i].area; /* in order */
        put_area(&w, &areas, &areas.items[area - 1]);
    }
    *count += lines.count;
    if (status == LMN_OK && check && lines.count)
        status = hatch_verify(check, &lines, view, VECTOR_VERIFY_APART, error);
    mem_free(lines.items);
    hatch_areas_release(&areas);
    return status;
}
