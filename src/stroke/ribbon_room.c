/* Lines yield where they crowd. The share of the page that is inked around a position, if lines kept their widths, is
 * known from a grid over the page; where it is more than the style allows, all lines there get finer by the same
 * factor. So façades and vents stay tones of lines and do not fuse to black. Pictures have the same law for lines
 * found in pixels (lines/edge/crowd_blur.frag).
 *
 * Around is a Gaussian with a deviation of two widths: one line alone has a share of 0.2 in its middle, and three that
 * meet in a corner 0.3. Lines whose width varies anyway yield along them; those of one width keep one all along, so
 * that they stay lines for plotters and CAD programs.
 */
#include "stroke/ribbon_private.h"

#include <math.h>

#include "base/memory.h"

enum { CELLS_MOST = 2048, REACH = 5 /* cells */, PENS_AN_OCTAVE = 4, PENS = 24 };
static const float  deviation_cells = 2; /* of one width each */
static const float  hidden_share = 0.5f; /* of hidden lines: most are dashed */
static const double least_ink = 1e-6;

static bool is_usable(const stroke_point *p, const stroke_point *q)
{
    return isfinite(p->x + p->y + q->x + q->y) && fabsf(p->x) < 1e6f && fabsf(p->y) < 1e6f && fabsf(q->x) < 1e6f &&
           fabsf(q->y) < 1e6f;
}

/* The box around all points; false where there is none. */
static bool find_box(const stroke_set *set, float box[4])
{
    box[0] = box[1] = INFINITY;
    box[2] = box[3] = -INFINITY;
    for (size_t i = 0; i < set->point_count; i++) {
        const stroke_point *p = &set->points[i];
        if (!is_usable(p, p))
            continue;
        box[0] = fminf(box[0], p->x);
        box[1] = fminf(box[1], p->y);
        box[2] = fmaxf(box[2], p->x);
        box[3] = fmaxf(box[3], p->y);
    }
    return box[2] >= box[0];
}

/* Ink of a segment, area, into the cells that it runs through. */
static void lay_segment(line_room *room, const stroke_point *p, const stroke_point *q, float width)
{
    float length = hypotf(q->x - p->x, q->y - p->y);
    int   steps = (int)(2 * length / room->cell) + 1;
    for (int i = 0; i < steps; i++) {
        float t = ((float)i + 0.5f) / (float)steps;
        int   column = (int)((p->x + t * (q->x - p->x) - room->left) / room->cell),
            row = (int)((p->y + t * (q->y - p->y) - room->top) / room->cell);
        if (column >= 0 && row >= 0 && column < room->columns && row < room->rows)
            room->ink[(size_t)row * (size_t)room->columns + (size_t)column] += length / (float)steps * width;
    }
}

static void lay(line_room *room, const ribbon_job *job)
{
    const stroke_set *set = job->strokes;
    for (size_t i = 0; i < set->stroke_count; i++) {
        const stroke *s = &set->strokes[i];
        float         width = ribbon_width(job, s) * (s->hidden_by > 0 ? hidden_share : 1);
        for (uint32_t k = 0; job->drawn[i] && k + 1 < s->count; k++)
            if (is_usable(&set->points[s->first + k], &set->points[s->first + k + 1]))
                lay_segment(room, &set->points[s->first + k], &set->points[s->first + k + 1], width);
    }
}

/* One row or column, `apart` items from one another. Most of a page has no lines: only what is near ink changes. `line`
 * has room for REACH more on both sides, and zeros there. */
static void blur_line(float *items, size_t apart, int count, const float *weights, float *line)
{
    int inked = -1; /* up to here there is ink within reach */
    for (int i = 0; i < count; i++)
        line[i] = items[(size_t)i * apart];
    for (int i = 0; i < REACH; i++)
        line[count + i] = 0;
    for (int i = 0; i < REACH && i < count; i++)
        inked = line[i] != 0 ? i + REACH : inked;
    for (int i = 0; i < count; i++) {
        inked = line[i + REACH] != 0 ? i + 2 * REACH : inked;
        if (i > inked)
            continue;
        float sum = 0;
        for (int k = -REACH; k <= REACH; k++)
            sum += weights[k + REACH] * line[i + k];
        items[(size_t)i * apart] = sum;
    }
}

static bool blur(line_room *room)
{
    float     weights[2 * REACH + 1], sum = 0;
    const int longest = room->columns > room->rows ? room->columns : room->rows;
    float    *with_rims = mem_calloc((size_t)longest + 2 * REACH, sizeof *with_rims),
          *line = with_rims ? with_rims + REACH : NULL;
    for (int k = -REACH; k <= REACH; k++)
        sum += weights[k + REACH] = expf(-0.5f * (float)(k * k) / (deviation_cells * deviation_cells));
    for (int k = 0; k <= 2 * REACH; k++)
        weights[k] /= sum;
    for (int row = 0; line && row < room->rows; row++)
        blur_line(room->ink + (size_t)row * (size_t)room->columns, 1, room->columns, weights, line);
    for (int column = 0; line && column < room->columns; column++)
        blur_line(room->ink + column, (size_t)room->columns, room->rows, weights, line);
    mem_free(with_rims);
    return with_rims != NULL;
}

bool line_room_find(line_room *room, const ribbon_job *job)
{
    float box[4];
    *room = (line_room){.cover = job->style->cover};
    if (!(room->cover > 0 && room->cover < 1) || !(job->style->width > 0) || !find_box(job->strokes, box))
        return true;
    float extent = fmaxf(box[2] - box[0], box[3] - box[1]);
    room->cell = fmaxf(job->style->width, extent / (CELLS_MOST - 2 * REACH - 2));
    room->left = box[0] - REACH * room->cell;
    room->top = box[1] - REACH * room->cell;
    room->columns = (int)((box[2] - room->left) / room->cell) + REACH + 1;
    room->rows = (int)((box[3] - room->top) / room->cell) + REACH + 1;
    size_t cells = (size_t)room->columns * (size_t)room->rows;
    room->ink = mem_calloc(cells, sizeof *room->ink);
    if (!room->ink)
        return false;
    lay(room, job);
    for (size_t i = 0; i < cells; i++)
        room->ink[i] /= room->cell * room->cell;
    return blur(room);
}

void line_room_release(line_room *room)
{
    mem_free(room->ink);
    *room = (line_room){0};
}

static float ink_in(const line_room *room, int column, int row)
{
    column = column < 0 ? 0 : column >= room->columns ? room->columns - 1 : column;
    row = row < 0 ? 0 : row >= room->rows ? room->rows - 1 : row;
    return room->ink[(size_t)row * (size_t)room->columns + (size_t)column];
}

float line_room_at(const line_room *room, float x, float y)
{
    if (!room->ink || !isfinite(x + y))
        return 1;
    float column = fminf(fmaxf((x - room->left) / room->cell - 0.5f, -1), (float)room->columns),
          row = fminf(fmaxf((y - room->top) / room->cell - 0.5f, -1), (float)room->rows);
    int    i = (int)floorf(column), k = (int)floorf(row);
    float  s = column - (float)i, t = row - (float)k;
    double above = (1 - s) * ink_in(room, i, k) + s * ink_in(room, i + 1, k),
           below = (1 - s) * ink_in(room, i, k + 1) + s * ink_in(room, i + 1, k + 1);
    return (float)fmin((double)room->cover / fmax((1 - t) * above + t * below, least_ink), 1);
}

/* Pens from the whole width down: each finer than the last by the same factor. */
static float pen(int number)
{
    return exp2f(-(float)number / PENS_AN_OCTAVE);
}

static int pen_for(float share)
{
    int number = (int)roundf(-PENS_AN_OCTAVE * log2f(fmaxf(share, 1e-6f)));
    return number < PENS ? number : PENS - 1;
}

float line_room_pen(const line_room *room, const stroke_set *set, const stroke *s)
{
    size_t taken[PENS] = {0}, count = 0, so_far = 0;
    for (uint32_t k = 0; room->ink && k + 1 < s->count; k++) {
        const stroke_point *p = &set->points[s->first + k], *q = p + 1;
        int                 steps = is_usable(p, q) ? (int)(hypotf(q->x - p->x, q->y - p->y) / room->cell) + 1 : 0;
        for (int i = 0; i < steps; i++, count++) {
            float t = ((float)i + 0.5f) / (float)steps;
            taken[pen_for(line_room_at(room, p->x + t * (q->x - p->x), p->y + t * (q->y - p->y)))]++;
        }
    }
    for (int i = 0; i < PENS; i++) {
        so_far += taken[i];
        if (2 * so_far > count)
            return pen(i);
    }
    return 1;
}
