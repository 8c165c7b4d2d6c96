/* Ribbons on the sheet. An even ribbon is a line with a width; an uneven one is its outline, in pieces from one
 * sharp corner to the next that overlap there. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "vector/vector_private.h"

static const float sharp_cosine = 0.6f; /* outlines are cut at corners that turn by more */
static const float miter_most = 1.25f;
static const float dash_slack = 0.01f; /* units of the page by which dashes that are alike differ */
enum { CAP_PIECES = 6, OPACITY_STEPS = 32, WIDTH_STEPS = 20 /* to the pixel */ };

/* A ribbon in the order of the sheet. */
typedef struct inked {
    const ribbon_set *set;
    const ribbon     *r;
    size_t            order;
} inked;

typedef struct ink_writer {
    const vector_ink *how;
    vector_pen        pen;
    int32_t           groups[2]; /* what is hidden, what is visible; −1: not there yet */
    int32_t           part_group, class_group;
    const ribbon     *before;         /* of the group and item that are open */
    float             width, opacity; /* of the item */
} ink_writer;

static int compare_inked(const void *a, const void *b)
{
    const inked *one = a, *other = b;
    bool         one_hidden = one->r->hidden_by > 0, other_hidden = other->r->hidden_by > 0;
    if (one_hidden != other_hidden)
        return one_hidden ? -1 : 1;
    if (one->r->part != other->r->part)
        return one->r->part < other->r->part ? -1 : 1;
    if (one->r->kind != other->r->kind)
        return one->r->kind > other->r->kind ? -1 : 1; /* outlines lie on creases */
    return one->order < other->order ? -1 : one->order > other->order;
}

/* --- points --------------------------------------------------------------------------------------------- */

static void add_point(vector_pen *w, float x, float y)
{
    if (w->failed || !mem_grow((void **)&w->points, &w->capacity, w->count + 1, sizeof *w->points)) {
        w->failed = true;
        return;
    }
    float *to = w->points[w->count++];
    to[0] = (float)(w->how->origin[0] + (double)x / VECTOR_PIXELS_PER_MM);
    to[1] = (float)(w->how->origin[1] + (double)y / VECTOR_PIXELS_PER_MM);
}

static bool direction_between(const ribbon_point *a, const ribbon_point *b, float out[2])
{
    float dx = b->x - a->x, dy = b->y - a->y, length = hypotf(dx, dy);
    if (!(length > 1e-6f))
        return false;
    out[0] = dx / length;
    out[1] = dy / length;
    return true;
}

/* The direction that offsets are made from at a point of a piece, and by how much they grow where it bends. */
static float bisect(const ribbon_point *points, size_t count, size_t i, float out[2])
{
    float before[2] = {0, 0}, after[2] = {0, 0};
    for (size_t k = i; k-- > 0 && !direction_between(&points[k], &points[i], before);)
        ;
    for (size_t k = i + 1; k < count && !direction_between(&points[i], &points[k], after); k++)
        ;
    float sum[2] = {before[0] + after[0], before[1] + after[1]}, length = hypotf(sum[0], sum[1]);
    if (!(length > 1e-6f)) {
        out[0] = before[0];
        out[1] = before[1];
        return 1;
    }
    out[0] = sum[0] / length;
    out[1] = sum[1] / length;
    bool both = hypotf(before[0], before[1]) > 0.5f && hypotf(after[0], after[1]) > 0.5f;
    return both ? fminf(2 / length, miter_most) : 1;
}

/* Half a circle from the left of `direction` round its tip to the right. */
static void add_cap(vector_pen *w, const ribbon_point *p, const float direction[2])
{
    for (int i = 1; i < CAP_PIECES; i++) {
        float angle = (float)i * 3.14159265f / CAP_PIECES, along = sinf(angle) * p->half,
              across = cosf(angle) * p->half;
        add_point(w, p->x + along * direction[0] + across * direction[1],
                  p->y + along * direction[1] - across * direction[0]);
    }
}

/* One side of a piece, from `from` to `to` either way. */
static void add_side(vector_pen *w, const ribbon_point *points, size_t count, bool back)
{
    for (size_t n = 0; n < count; n++) {
        size_t i = back ? count - 1 - n : n;
        float  direction[2], grown = bisect(points, count, i, direction),
                            offset = points[i].half * grown * (back ? -1 : 1);
        add_point(w, points[i].x + offset * direction[1], points[i].y - offset * direction[0]);
    }
}

static void put_outline(vector_pen *w, const ribbon_point *points, size_t count, bool round)
{
    float direction[2];
    w->count = 0;
    add_side(w, points, count, false);
    bisect(points, count, count - 1, direction);
    if (round)
        add_cap(w, &points[count - 1], direction);
    add_side(w, points, count, true);
    bisect(points, count, 0, direction);
    if (round)
        add_cap(w, &points[0], (const float[2]){-direction[0], -direction[1]});
    if (!w->failed)
        sheet_add_path(w->how->page, &(sheet_path){.closed = true, .filled = true, .curved = true},
                       (const float(*)[2])w->points, w->count);
}

void vector_pen_uneven(vector_pen *w, const ribbon_point *points, size_t count, ribbon_end end)
{
    size_t begin = 0;
    for (size_t i = 1; i < count; i++) {
        float before[2], after[2];
        bool  sharp = i + 1 < count && direction_between(&points[i - 1], &points[i], before) &&
                     direction_between(&points[i], &points[i + 1], after) &&
                     before[0] * after[0] + before[1] * after[1] < sharp_cosine;
        if (!sharp && i + 1 < count)
            continue;
        put_outline(w, points + begin, i + 1 - begin, end == RIBBON_ROUND || begin > 0 || sharp);
        begin = i;
    }
}

void vector_pen_even(vector_pen *w, const ribbon_point *points, size_t count, const sheet_path *style)
{
    count -= style->closed && count > 2 ? 1 : 0;
    w->count = 0;
    for (size_t i = 0; i < count; i++)
        add_point(w, points[i].x, points[i].y);
    if (!w->failed)
        sheet_add_path(w->how->page, style, (const float(*)[2])w->points, w->count);
}

/* --- dashes --------------------------------------------------------------------------------------------- */

static bool is_near(float a, float b)
{
    return fabsf(a - b) <= dash_slack;
}

/* Are the dashes of a ribbon, page units, one dash and one gap again and again? Its first and its last dash may be
 * parts of one. `pattern` gets dash, gap and the phase. */
static bool is_regular(const float (*dashes)[2], size_t count, float pattern[3])
{
    if (count < 3)
        return false; /* two may be anything */
    float dash = dashes[1][1] - dashes[1][0], gap = dashes[1][0] - dashes[0][1], first = dashes[0][1],
          last = dashes[count - 1][1] - dashes[count - 1][0];
    for (size_t i = 1; i < count; i++)
        if (!is_near(dashes[i][0] - dashes[i - 1][1], gap) ||
            (i + 1 < count && !is_near(dashes[i][1] - dashes[i][0], dash)))
            return false;
    pattern[0] = dash;
    pattern[1] = gap;
    pattern[2] = fmaxf(dash - first, 0);
    return first <= dash + dash_slack && last <= dash + dash_slack;
}

/* The line that was added last, whose dashes are known by the arcs of its ribbon: as one pattern, or one by one. */
static void dash_line(vector_pen *w, const ribbon_set *set, const ribbon *r)
{
    const ribbon_point *points = &set->points[r->first];
    const float(*dashes)[2] = (const float(*)[2])set->dashes + r->first_dash;
    float  arc = points[r->count - 1].arc - points[0].arc, length = 0, pattern[3];
    size_t count = r->dash_count;
    for (uint32_t i = 1; i < r->count; i++)
        length += hypotf(points[i].x - points[i - 1].x, points[i].y - points[i - 1].y);
    float unit = arc > 0 ? (float)((double)(length / arc) / VECTOR_PIXELS_PER_MM) : 0;
    if (is_regular(dashes, count, pattern)) {
        const float lengths[2] = {pattern[0] * unit, pattern[1] * unit};
        sheet_dash_path(w->how->page, lengths, 2, pattern[2] * unit);
        return;
    }
    if (!mem_grow((void **)&w->dashes, &w->dash_capacity, 2 * count, sizeof *w->dashes)) {
        w->failed = true;
        return;
    }
    for (size_t i = 0; i < count; i++) {
        w->dashes[2 * i] = (dashes[i][1] - dashes[i][0]) * unit;
        w->dashes[2 * i + 1] = (i + 1 < count ? dashes[i + 1][0] - dashes[i][1] : 0) * unit;
    }
    w->dashes[2 * count - 1] = w->dashes[1];
    sheet_dash_path(w->how->page, w->dashes, 2 * count, 0);
}

/* --- groups and items ----------------------------------------------------------------------------------- */

static const char *part_name(const vector_ink *how, uint32_t part)
{
    return part > 0 && part <= how->scene->part_count ? how->scene->parts[part - 1].name : NULL;
}

static void open_groups(ink_writer *w, const ribbon *r)
{
    sheet      *page = w->how->page;
    bool        visible = r->hidden_by == 0, first = !w->before;
    const char *state = visible ? "visible" : "hidden";
    bool        other_state = first || (w->before->hidden_by == 0) != visible,
         other_part = other_state || w->before->part != r->part;
    if (w->groups[visible] < 0)
        w->groups[visible] = (int32_t)sheet_add_group(page, (int32_t)w->how->group, state, state, 0);
    if (other_part)
        w->part_group = (int32_t)sheet_add_group(page, w->groups[visible], part_name(w->how, r->part), "part", r->part);
    if (other_part || w->before->kind != r->kind) {
        char        classes[64];
        const char *name = stroke_class_name(r->kind);
        snprintf(classes, sizeof classes, "%s %s", state, name);
        w->class_group = (int32_t)sheet_add_group(page, w->part_group, name, classes, 0);
    }
}

/* Opacities and widths are few, so that the file has few styles. */
static float quantised(float value, int steps)
{
    return roundf(value * (float)steps) / (float)steps;
}

static void mean_of(const ribbon_point *points, size_t count, float *half, float *alpha)
{
    double halves = 0, alphas = 0;
    for (size_t i = 0; i < count; i++) {
        halves += (double)points[i].half;
        alphas += (double)points[i].alpha;
    }
    *half = (float)(halves / (double)count);
    *alpha = (float)(alphas / (double)count);
}

static void put_ribbon(ink_writer *w, const inked *what)
{
    const ribbon       *r = what->r;
    const ribbon_point *points = &what->set->points[r->first];
    float               half, alpha;
    mean_of(points, r->count, &half, &alpha);
    float opacity = quantised(alpha, OPACITY_STEPS), width = 2 * half;
    if (!(opacity > 0) || !(width > 0))
        return;
    if (!r->even)
        width = fmaxf(quantised(width, WIDTH_STEPS), 1.0f / WIDTH_STEPS);
    open_groups(w, r);
    bool same = w->before && w->before->chain == r->chain && w->before->part == r->part && w->before->kind == r->kind &&
                w->before->even == r->even && (w->before->hidden_by > 0) == (r->hidden_by > 0) &&
                memcmp(&w->before->ink, &r->ink, sizeof r->ink) == 0 && opacity == w->opacity && r->id == w->before->id;
    if (!same) {
        colour ink = r->ink;
        ink.a *= opacity;
        sheet_add_item(w->how->page, SHEET_PATH, (uint32_t)w->class_group, ink, r->id);
    }
    if (r->even || w->how->lines_only)
        vector_pen_even(&w->pen, points, r->count,
                        &(sheet_path){.closed = r->closed,
                                      .curved = true,
                                      .width = (float)((double)width / VECTOR_PIXELS_PER_MM),
                                      .cap = r->end == RIBBON_BUTT ? SHEET_CAP_BUTT : SHEET_CAP_ROUND});
    else
        vector_pen_uneven(&w->pen, points, r->count, r->end);
    if (r->dash_count && !w->pen.failed)
        dash_line(&w->pen, what->set, r);
    w->before = r;
    w->opacity = opacity;
}

lmn_status vector_put_ribbons(const vector_ink *ink, const ribbon_set *sets, size_t set_count, lmn_error *error)
{
    size_t count = 0, at = 0;
    for (size_t i = 0; i < set_count; i++)
        count += sets[i].ribbon_count;
    ink_writer w = {.how = ink, .pen = {.how = ink}, .groups = {-1, -1}, .part_group = -1, .class_group = -1};
    inked     *all = mem_calloc(count, sizeof *all);
    if (!all)
        return error_memory(error);
    for (size_t i = 0; i < set_count; i++)
        for (size_t k = 0; k < sets[i].ribbon_count; k++, at++)
            all[at] = (inked){&sets[i], &sets[i].ribbons[k], at};
    if (count)
        qsort(all, count, sizeof *all, compare_inked);
    for (size_t i = 0; i < count && !w.pen.failed && !ink->page->failed; i++)
        put_ribbon(&w, &all[i]);
    mem_free(all);
    mem_free(w.pen.points);
    mem_free(w.pen.dashes);
    return w.pen.failed || ink->page->failed ? error_memory(error) : LMN_OK;
}
