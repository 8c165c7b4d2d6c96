/* How much room a hand has beside a line. Where lines run side by side, as in grilles and façades, a hand that drew
 * each several times would make one grey of them: it draws them nearer to the true line, fewer times, and stops at
 * corners, where their ends would make a hedge.
 */
#include <math.h>

#include "stroke/ribbon_private.h"

enum { SAMPLES_MOST = 24 };
static const float samples_apart = 6; /* on paper */
static const float alongside = 0.85f; /* cosine: lines that turn by more cross */
/* So many times as far as copies lie apart, and as lines run on, a hand looks for lines beside its own: those that are
 * nearer than a fraction of it leave no room. */
static const float copies_reach = 4, near_least = 0.12f, beyond_reach = 2, far_least = 0.2f;

/* The distance to a segment that runs along a direction beside a position; INFINITY: it does not. */
static float distance_beside(const stroke_point *a, const stroke_point *b, float x, float y, const float way[2])
{
    float dx = b->x - a->x, dy = b->y - a->y, square = dx * dx + dy * dy;
    float length = sqrtf(square), t = square > 0 ? ((x - a->x) * dx + (y - a->y) * dy) / square : -1;
    if (!(t >= 0 && t <= 1) || fabsf(dx * way[0] + dy * way[1]) < alongside * length)
        return INFINITY;
    return fabsf((x - a->x) * dy - (y - a->y) * dx) / length;
}

static float nearest_beside(const ribbon_job *job, const segment_grid *g, uint32_t own, const stroke_point *at,
                            const float way[2], float reach)
{
    float nearest = reach;
    int   cells[4];
    if (!segment_grid_box(g, at, at, reach, cells))
        return reach;
    for (int row = cells[1]; row <= cells[3]; row++)
        for (int column = cells[0]; column <= cells[2]; column++) {
            size_t cell = (size_t)row * (size_t)g->columns + (size_t)column;
            for (uint32_t i = g->starts[cell]; i < g->starts[cell + 1]; i++) {
                const stroke_point *a = &job->strokes->points[g->items[i].point];
                if (g->items[i].stroke != own)
                    nearest = fminf(nearest, distance_beside(a, a + 1, at->x, at->y, way));
            }
        }
    return nearest;
}

/* What there is of a distance, 0 … 1. */
static float share_of(float mean, float reach, float least)
{
    return reach > 0 ? fminf(fmaxf((mean / reach - least) / (1 - least), 0), 1) : 1;
}

hand_space hand_space_beside(const ribbon_job *job, const segment_grid *grid, uint32_t own, const stroke_point *points,
                             uint32_t count)
{
    const stroke_style *style = job->style;
    float               near = copies_reach * style->repeat_apart, far = beyond_reach * style->overshoot;
    float               length = count > 1 ? points[count - 1].arc - points[0].arc : 0, reach = fmaxf(near, far);
    float               near_sum = 0, far_sum = 0;
    int                 samples = (int)fminf(fmaxf(length / samples_apart, 1), SAMPLES_MOST);
    if (!grid->items || !(reach > 0) || !(length > 0) || !isfinite(length))
        return (hand_space){1, 1};
    for (int i = 0, k = 0; i < samples; i++) {
        float arc = points[0].arc + length * ((float)i + 0.5f) / (float)samples;
        while ((uint32_t)k + 2 < count && points[k + 1].arc < arc)
            k++;
        const stroke_point *a = &points[k], *b = a + 1;
        float               piece = hypotf(b->x - a->x, b->y - a->y),
              t = b->arc > a->arc ? fminf(fmaxf((arc - a->arc) / (b->arc - a->arc), 0), 1) : 0;
        stroke_point at = {.x = a->x + t * (b->x - a->x), .y = a->y + t * (b->y - a->y)};
        float        way[2] = {piece > 0 ? (b->x - a->x) / piece : 0, piece > 0 ? (b->y - a->y) / piece : 0};
        float        nearest = nearest_beside(job, grid, own, &at, way, reach);
        near_sum += fminf(nearest, near);
        far_sum += fminf(nearest, far);
    }
    return (hand_space){share_of(near_sum / (float)samples, near, near_least),
                        share_of(far_sum / (float)samples, far, far_least)};
}
