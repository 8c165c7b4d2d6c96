/* Lines that were left out of a crowd come back where what is left would have open corners: from the end of a line that
 * meets nothing else, the few short ones that lead to something that is drawn. Whatever is drawn then ends at a line,
 * as draughtsmen have it, or where it ended before anything was left out. */
#include <math.h>

#include "stroke/pieces.h"

#define MM      PAPER_UNITS_PER_MM
#define TOUCHES (0.06 * MM) /* shared corners are at one place; where one hides another, nearly so */
#define BESIDE  (0.25 * MM) /* about a pen: ink of lines so near runs together */
#define LONGEST (12 * MM)   /* what is longer is what made the crowd */
enum { WAY_MOST = 3 };      /* lines that come back for one end */

static const stroke_point *point_of(const stroke_set *set, const stroke *s, bool last)
{
    return &set->points[s->first + (last ? s->count - 1 : 0)];
}

static bool counts(const stroke_set *set, const uint8_t *gone, size_t i, bool wanted_gone)
{
    return (gone[i] != 0) == wanted_gone && set->strokes[i].hidden_by == 0 && set->strokes[i].count > 1;
}

static bool is_end(const stroke_set *set, const stroke *s, const stroke_point *at)
{
    for (int last = 0; last < 2 && !s->closed; last++) {
        const stroke_point *end = point_of(set, s, last);
        if (hypot((double)end->x - at->x, (double)end->y - at->y) <= TOUCHES)
            return true;
    }
    return false;
}

/* What is drawn at a place: nothing, the end of one line alone, or more. */
typedef enum meeting_kind { MEETS_NOTHING, MEETS_OPEN_END, MEETS_LINES } meeting_kind;

static meeting_kind meeting_at(const page_pieces *p, const stroke_point *at)
{
    pieces_walk walk = pieces_around(p, at);
    uint32_t    found = UINT32_MAX;
    for (const piece *of = pieces_walk_next(&walk); of; of = pieces_walk_next(&walk)) {
        if (of->stroke == found || !piece_is_near(at, &p->set->points[of->point], TOUCHES))
            continue;
        if (found != UINT32_MAX || !is_end(p->set, &p->set->strokes[of->stroke], at))
            return MEETS_LINES;
        found = of->stroke;
    }
    return found == UINT32_MAX ? MEETS_NOTHING : MEETS_OPEN_END;
}

static bool is_short(const stroke_set *set, const stroke *s)
{
    double length = 0;
    for (uint32_t k = 1; k < s->count && length <= LONGEST; k++) {
        const stroke_point *q = &set->points[s->first + k];
        length += hypot((double)q->x - q[-1].x, (double)q->y - q[-1].y);
    }
    return length <= LONGEST && !s->closed;
}

/* A way of strokes that are gone. */
typedef struct way {
    uint32_t strokes[WAY_MOST];
    int      count;
} way;

static bool is_on(const way *w, uint32_t stroke)
{
    bool on = false;
    for (int i = 0; i < w->count; i++)
        on = on || w->strokes[i] == stroke;
    return on;
}

/* Where a stroke leads that has an end here; NULL: it has none. */
static const stroke_point *leads_to(const stroke_set *set, const stroke *s, const stroke_point *at)
{
    for (int last = 0; last < 2; last++) {
        const stroke_point *end = point_of(set, s, last);
        if (hypot((double)end->x - at->x, (double)end->y - at->y) <= TOUCHES)
            return point_of(set, s, !last);
    }
    return NULL;
}

/* Finds a way from a place over strokes that are gone to one where something is drawn. The shortest in lines is found
 * first, since `most` grows. */
static bool find_way(way *w, const page_pieces *drawn, const page_pieces *left, const uint8_t *gone,
                     const stroke_point *at, int most)
{
    pieces_walk walk = pieces_around(left, at);
    for (const piece *of = pieces_walk_next(&walk); of; of = pieces_walk_next(&walk)) {
        const stroke_point *to =
            gone[of->stroke] && !is_on(w, of->stroke) ? leads_to(left->set, &left->set->strokes[of->stroke], at) : NULL;
        if (!to)
            continue;
        w->strokes[w->count++] = of->stroke;
        if (w->count < most ? find_way(w, drawn, left, gone, to, most) : meeting_at(drawn, to) != MEETS_NOTHING)
            return true;
        w->count--;
    }
    return false;
}

/* Finds a stroke that is gone, runs beside a place and ends at what is drawn on both sides. */
static bool find_beside(way *w, const page_pieces *drawn, const page_pieces *left, const uint8_t *gone,
                        const stroke_point *at)
{
    pieces_walk walk = pieces_around(left, at);
    for (const piece *of = pieces_walk_next(&walk); of; of = pieces_walk_next(&walk)) {
        const stroke *s = &left->set->strokes[of->stroke];
        if (gone[of->stroke] && piece_is_near(at, &left->set->points[of->point], BESIDE) &&
            meeting_at(drawn, point_of(left->set, s, false)) != MEETS_NOTHING &&
            meeting_at(drawn, point_of(left->set, s, true)) != MEETS_NOTHING) {
            *w = (way){.strokes = {of->stroke}, .count = 1};
            return true;
        }
    }
    return false;
}

/* What ends in the open is led on to the next line, or has one beside it. */
static bool close_end(page_pieces *drawn, const page_pieces *left, uint8_t *gone, const stroke_point *at)
{
    way  w = {.count = 0};
    bool found = false, good = true;
    if (meeting_at(drawn, at) != MEETS_OPEN_END)
        return true;
    for (int most = 1; most <= WAY_MOST && !found; most++)
        found = find_way(&w, drawn, left, gone, at, most);
    found = found || find_beside(&w, drawn, left, gone, at);
    for (int i = 0; i < w.count && found && good; i++) {
        gone[w.strokes[i]] = 0;
        good = page_pieces_put(drawn, w.strokes[i]);
    }
    return good;
}

bool strokes_close_corners(const stroke_set *set, uint8_t *gone)
{
    page_pieces drawn, left = {0};
    bool        good = page_pieces_open(&drawn, set) && page_pieces_open(&left, set);
    for (size_t i = 0; i < set->stroke_count && good; i++)
        if (counts(set, gone, i, false))
            good = page_pieces_put(&drawn, i);
        else if (counts(set, gone, i, true) && is_short(set, &set->strokes[i]))
            good = page_pieces_put(&left, i);
    for (size_t i = 0; i < set->stroke_count && good && left.count; i++)
        if (counts(set, gone, i, false) && !set->strokes[i].closed)
            good = close_end(&drawn, &left, gone, point_of(set, &set->strokes[i], false)) &&
                   close_end(&drawn, &left, gone, point_of(set, &set->strokes[i], true));
    page_pieces_close(&drawn);
    page_pieces_close(&left);
    return good;
}
