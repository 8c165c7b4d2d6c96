#include "sheet/sheet.h"

#include <math.h>
#include <string.h>

#include "base/memory.h"

/* Farther from the sheet than anything that is drawn; numbers stay short and integers do not overflow. */
static const float farthest = 1e6f;

void sheet_begin(sheet *s, double width, double height, double pixels_per_mm)
{
    memset(s, 0, sizeof *s);
    s->width = width > 0 && isfinite(width) ? width : 1;
    s->height = height > 0 && isfinite(height) ? height : 1;
    s->pixels_per_mm = pixels_per_mm > 0 && isfinite(pixels_per_mm) ? pixels_per_mm : 1;
}

void sheet_release(sheet *s)
{
    for (size_t i = 0; i < s->group_count; i++) {
        mem_free(s->groups[i].name);
        mem_free(s->groups[i].css_class);
    }
    for (size_t i = 0; i < s->item_count; i++) {
        mem_free(s->items[i].png);
        mem_free(s->items[i].text);
    }
    mem_free(s->title);
    mem_free(s->description);
    mem_free(s->groups);
    mem_free(s->items);
    mem_free(s->paths);
    mem_free(s->points);
    mem_free(s->dashes);
    mem_free(s->pieces);
    memset(s, 0, sizeof *s);
}

/* A copy of the text; NULL stays NULL. */
static char *keep(sheet *s, const char *words)
{
    char *copy = mem_copy_text(words);
    if (words && !copy)
        s->failed = true;
    return copy;
}

void sheet_set_title(sheet *s, const char *title, const char *description)
{
    mem_free(s->title);
    mem_free(s->description);
    s->title = keep(s, title);
    s->description = keep(s, description);
}

uint32_t sheet_add_group(sheet *s, int32_t parent, const char *name, const char *css_class, uint32_t part)
{
    if (s->failed || s->group_count >= INT32_MAX ||
        !mem_grow((void **)&s->groups, &s->group_capacity, s->group_count + 1, sizeof *s->groups)) {
        s->failed = true;
        return 0;
    }
    sheet_group *g = &s->groups[s->group_count];
    *g = (sheet_group){.parent = parent >= 0 && (size_t)parent < s->group_count ? parent : -1, .part = part};
    g->name = keep(s, name);
    g->css_class = keep(s, css_class);
    return (uint32_t)s->group_count++;
}

void sheet_clip_group(sheet *s, uint32_t group, double x, double y, double width, double height)
{
    if (group >= s->group_count)
        return;
    const double clip[4] = {x, y, width, height};
    memcpy(s->groups[group].clip, clip, sizeof clip);
}

static sheet_item *add_item(sheet *s, sheet_kind kind, uint32_t group, colour ink, uint64_t id)
{
    if (s->failed || !mem_grow((void **)&s->items, &s->item_capacity, s->item_count + 1, sizeof *s->items)) {
        s->failed = true;
        return NULL;
    }
    sheet_item *item = &s->items[s->item_count++];
    *item = (sheet_item){.kind = kind, .group = group, .ink = ink, .id = id, .first = (uint32_t)s->path_count};
    return item;
}

void sheet_add_item(sheet *s, sheet_kind kind, uint32_t group, colour ink, uint64_t id)
{
    add_item(s, kind, group, ink, id);
}

void sheet_add_hatch(sheet *s, uint32_t group, colour ink, const sheet_hatch *hatch)
{
    sheet_item *item = add_item(s, SHEET_PATH, group, ink, 0);
    bool        finite = isfinite(hatch->angle + hatch->origin[0] + hatch->origin[1] + hatch->width + hatch->apart);
    if (item && finite && hatch->apart > 0.01 && hatch->width > 0)
        item->hatch = *hatch;
}

static float within(float value)
{
    return fminf(fmaxf(value, -farthest), farthest);
}

/* Points that are all finite. */
static void add_run(sheet *s, const sheet_path *style, const float (*points)[2], size_t count, bool whole)
{
    size_t least = s->items[s->item_count - 1].kind == SHEET_DOTS ? 1 : style->filled ? 3 : 2;
    if (s->failed || count < least)
        return;
    if (s->point_count + count > UINT32_MAX || s->path_count >= UINT32_MAX ||
        !mem_grow((void **)&s->paths, &s->path_capacity, s->path_count + 1, sizeof *s->paths) ||
        !mem_grow((void **)&s->points, &s->point_capacity, s->point_count + count, sizeof *s->points)) {
        s->failed = true;
        return;
    }
    sheet_path *path = &s->paths[s->path_count++];
    *path = *style;
    path->first = (uint32_t)s->point_count;
    path->count = (uint32_t)count;
    path->closed = style->closed && whole;
    path->width = style->width > 0 && isfinite(style->width) ? style->width : 0;
    path->first_dash = path->dash_count = path->first_piece = path->piece_count = 0;
    path->phase = 0;
    for (size_t i = 0; i < count; i++) {
        float *to = s->points[s->point_count++];
        to[0] = within(points[i][0]);
        to[1] = within(points[i][1]);
    }
    s->items[s->item_count - 1].count++;
}

void sheet_add_path(sheet *s, const sheet_path *style, const float (*points)[2], size_t count)
{
    if (s->failed || s->item_count == 0)
        return;
    size_t begin = 0;
    for (size_t i = 0; i <= count; i++) {
        if (i < count && isfinite(points[i][0]) && isfinite(points[i][1]))
            continue;
        add_run(s, style, points + begin, i - begin, begin == 0 && i == count);
        begin = i + 1;
    }
}

void sheet_dash_path(sheet *s, const float *lengths, size_t count, float phase)
{
    const sheet_item *item = s->item_count ? &s->items[s->item_count - 1] : NULL;
    sheet_path       *path = s->path_count ? &s->paths[s->path_count - 1] : NULL;
    float             sums[2] = {0, 0};
    for (size_t i = 0; i < count; i++)
        sums[i % 2] += lengths[i] >= 0 ? lengths[i] : INFINITY;
    if (s->failed || !item || !item->count || !path || item->kind != SHEET_PATH || path->filled || count % 2 ||
        !(sums[0] > 0) || !(sums[1] > 0) || !isfinite(sums[0] + sums[1] + phase))
        return;
    if (s->dash_count + count > UINT32_MAX ||
        !mem_grow((void **)&s->dashes, &s->dash_capacity, s->dash_count + count, sizeof *s->dashes)) {
        s->failed = true;
        return;
    }
    memcpy(s->dashes + s->dash_count, lengths, count * sizeof *lengths);
    path->first_dash = (uint32_t)s->dash_count;
    path->dash_count = (uint32_t)count;
    path->phase = phase;
    s->dash_count += count;
}

static bool fits(const double *values, size_t count)
{
    for (size_t i = 0; i < count; i++)
        if (!(fabs(values[i]) <= (double)farthest))
            return false;
    return true;
}

void sheet_add_image(sheet *s, uint32_t group, const unsigned char *png, size_t size, double x, double y, double width,
                     double height)
{
    const double box[4] = {x, y, width, height};
    if (!fits(box, 4) || !(width > 0) || !(height > 0))
        return;
    sheet_item *item = add_item(s, SHEET_IMAGE, group, (colour){0, 0, 0, 1}, 0);
    if (!item)
        return;
    memcpy(item->box, box, sizeof box);
    item->png = mem_copy(png, size);
    item->png_size = size;
    s->failed = s->failed || !item->png;
}

void sheet_add_text(sheet *s, uint32_t group, colour ink, const char *utf8, double x, double y, double size, int anchor)
{
    const double box[4] = {x, y, 0, size};
    if (!utf8 || !*utf8 || !fits(box, 4) || !(size > 0))
        return;
    sheet_item *item = add_item(s, SHEET_TEXT, group, ink, 0);
    if (!item)
        return;
    memcpy(item->box, box, sizeof box);
    item->text = keep(s, utf8);
    item->anchor = anchor;
}

void sheet_add_rectangle(sheet *s, uint32_t group, colour ink, double x, double y, double width, double height,
                         double line_width)
{
    const float left = (float)x, top = (float)y, right = (float)(x + width), bottom = (float)(y + height);
    const float corners[4][2] = {{left, top}, {right, top}, {right, bottom}, {left, bottom}};
    sheet_add_item(s, SHEET_PATH, group, ink, 0);
    sheet_add_path(s, &(sheet_path){.closed = true, .width = (float)line_width, .cap = SHEET_CAP_BUTT}, corners, 4);
}

void sheet_add_line(sheet *s, uint32_t group, colour ink, const double a[2], const double b[2], double line_width)
{
    const float ends[2][2] = {{(float)a[0], (float)a[1]}, {(float)b[0], (float)b[1]}};
    sheet_add_item(s, SHEET_PATH, group, ink, 0);
    sheet_add_path(s, &(sheet_path){.width = (float)line_width, .cap = SHEET_CAP_BUTT}, ends, 2);
}
