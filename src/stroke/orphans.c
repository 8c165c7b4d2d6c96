/* Lines that belong to nothing. Short lines inside an outline that end in the open, with no other line near, say
 * nothing of the form: creases that a mesh has there by chance, which a draughtsman leaves out. Lines that meet or come
 * near each other are judged together, by their length. What closes, like the rim of a small hole, stays, and so does
 * what a part has no other lines than. However much detail there is, lines that belong to nothing are as long as a few
 * that may just be drawn; so short, outlines go, too: dents that a surface has by chance turn away from the eye. */
#include <math.h>
#include <string.h>

#include "base/memory.h"
#include "stroke/pieces.h"

#define MM      PAPER_UNITS_PER_MM
#define NEAR    (0.6 * MM)
#define STEP    (0.5 * MM)
#define ROUND   (2 * MM)  /* what is shorter is not closed where its ends are near each other */
#define LONGEST (28 * MM) /* with little detail */
#define STEEP   3         /* how much less with more: of the square of what detail lacks */
#define LEAST   4         /* with all of it: lengths that whole chains have at least */

typedef struct orphan_search {
    const stroke_set *set;
    uint8_t          *gone;
    page_pieces       drawn;
    double            longest, outline; /* that lines go with; the same of outlines, and of what is near them */
    uint32_t         *group;            /* per stroke: another one of its group, the first at last */
    float            *length;           /* per stroke; of the first of a group then all of it */
    uint8_t          *ends;             /* the same: does one end in the open? */
    uint8_t          *kept;             /* the same: whatever its length */
    uint8_t          *outlines;         /* the same: is it one? */
} orphan_search;

static bool is_drawn(const orphan_search *o, size_t i)
{
    return !o->gone[i] && o->set->strokes[i].hidden_by == 0 && o->set->strokes[i].count > 1;
}

/* What ends a surface and what files bring means something, however short; outlines where they are long. */
static bool is_inner(const orphan_search *o, uint32_t i)
{
    const stroke_class kind = o->set->strokes[i].kind;
    return kind != STROKE_BORDER && kind != STROKE_DRAWN && kind != STROKE_SPEED && kind != STROKE_PAST &&
           (kind != STROKE_CONTOUR || (double)o->length[i] < o->outline);
}

static uint32_t group_of(orphan_search *o, uint32_t i)
{
    while (o->group[i] != i)
        i = o->group[i] = o->group[o->group[i]];
    return i;
}

/* Puts all that is near a place into one group with the stroke; is there anything? */
static bool unite_near(orphan_search *o, uint32_t own, const stroke_point *at)
{
    pieces_walk walk = pieces_around(&o->drawn, at);
    bool        found = false;
    for (const piece *of = pieces_walk_next(&walk); of; of = pieces_walk_next(&walk)) {
        if (of->stroke == own || !piece_is_near(at, &o->set->points[of->point], NEAR))
            continue;
        found = true;
        o->group[group_of(o, of->stroke)] = group_of(o, own);
    }
    return found;
}

static double length_of(const orphan_search *o, const stroke *s)
{
    double length = 0;
    for (uint32_t k = 1; k < s->count; k++) {
        const stroke_point *q = &o->set->points[s->first + k];
        length += hypot((double)q->x - q[-1].x, (double)q->y - q[-1].y);
    }
    return length;
}

/* A stroke that is short enough may also be crossed or run along by others between its ends. */
static void unite_along(orphan_search *o, uint32_t own)
{
    const stroke *s = &o->set->strokes[own];
    for (uint32_t k = 0; k + 1 < s->count; k++) {
        const stroke_point *a = &o->set->points[s->first + k], *b = a + 1;
        const int           steps = (int)(hypot((double)b->x - a->x, (double)b->y - a->y) / STEP) + 1;
        for (int i = 1; i < steps; i++) {
            const float t = (float)i / (float)steps;
            unite_near(o, own, &(stroke_point){.x = a->x + t * (b->x - a->x), .y = a->y + t * (b->y - a->y)});
        }
    }
}

static bool is_closed(const orphan_search *o, uint32_t i)
{
    const stroke       *s = &o->set->strokes[i];
    const stroke_point *a = &o->set->points[s->first], *b = &o->set->points[s->first + s->count - 1];
    return s->closed || ((double)o->length[i] > ROUND && hypot((double)b->x - a->x, (double)b->y - a->y) <= NEAR);
}

static void look_around(orphan_search *o, uint32_t i)
{
    const stroke *s = &o->set->strokes[i];
    o->length[i] = (float)length_of(o, s);
    const bool first = unite_near(o, i, &o->set->points[s->first]),
               last = unite_near(o, i, &o->set->points[s->first + s->count - 1]);
    o->ends[i] = !is_closed(o, i) && !(first && last);
    o->kept[i] = !is_inner(o, i) || is_closed(o, i);
    o->outlines[i] = s->kind == STROKE_CONTOUR;
    if (is_inner(o, i) && (double)o->length[i] < o->longest)
        unite_along(o, i);
}

static void add_up(orphan_search *o)
{
    for (uint32_t i = 0; i < o->set->stroke_count; i++) {
        const uint32_t first = group_of(o, i);
        if (first == i || !is_drawn(o, i))
            continue;
        o->length[first] += o->length[i];
        o->ends[first] |= o->ends[i];
        o->kept[first] |= o->kept[i];
        o->outlines[first] |= o->outlines[i];
    }
}

static bool is_orphan(orphan_search *o, uint32_t i)
{
    const uint32_t first = group_of(o, i);
    const double   longest = o->outlines[first] ? o->outline : o->longest;
    return is_drawn(o, i) && !o->kept[first] && o->ends[first] && (double)o->length[first] < longest;
}

/* Flags parts that have other lines. False: out of memory. */
static bool leave_out_orphans(orphan_search *o)
{
    uint32_t parts = 0;
    for (size_t i = 0; i < o->set->stroke_count; i++)
        parts = o->set->strokes[i].part > parts ? o->set->strokes[i].part : parts;
    uint8_t *others = mem_calloc((size_t)parts + 1, 1);
    for (uint32_t i = 0; i < o->set->stroke_count && others; i++)
        if (is_drawn(o, i) && !is_orphan(o, i))
            others[o->set->strokes[i].part] = 1;
    uint8_t *goes = others ? mem_calloc(o->set->stroke_count, 1) : NULL;
    for (uint32_t i = 0; i < o->set->stroke_count && goes; i++)
        goes[i] = is_orphan(o, i) && others[o->set->strokes[i].part];
    for (uint32_t i = 0; i < o->set->stroke_count && goes; i++)
        o->gone[i] |= goes[i];
    const bool good = goes != NULL;
    mem_free(others);
    mem_free(goes);
    return good;
}

/* `least`: what is shorter goes with all detail. */
static double longest_of(float detail, double least)
{
    const double lacks = 1 - (double)detail;
    return fmax(LONGEST * fmin(STEEP * lacks * lacks, 1), least);
}

static bool orphans_open(orphan_search *o)
{
    const size_t count = o->set->stroke_count;
    o->group = mem_alloc(count * sizeof *o->group);
    o->length = mem_calloc(count, sizeof *o->length);
    o->ends = mem_calloc(count, 1);
    o->kept = mem_calloc(count, 1);
    o->outlines = mem_calloc(count, 1);
    bool good = page_pieces_open(&o->drawn, o->set) && o->group && o->length && o->ends && o->kept && o->outlines;
    for (uint32_t i = 0; i < count && good; i++) {
        o->group[i] = i;
        good = !is_drawn(o, i) || page_pieces_put(&o->drawn, i);
    }
    return good;
}

static void orphans_close(orphan_search *o)
{
    page_pieces_close(&o->drawn);
    mem_free(o->group);
    mem_free(o->length);
    mem_free(o->ends);
    mem_free(o->kept);
    mem_free(o->outlines);
}

bool strokes_drop_orphans(const stroke_set *set, float detail, float shortest, uint8_t *gone)
{
    const double  least = fmin(LEAST * (double)shortest, LONGEST);
    const double  longest = longest_of(detail, least);
    orphan_search o = {.set = set, .gone = gone, .longest = longest, .outline = least};
    if (!(o.longest > 0) || set->stroke_count == 0)
        return true;
    bool good = orphans_open(&o);
    for (uint32_t i = 0; i < set->stroke_count && good; i++)
        if (is_drawn(&o, i))
            look_around(&o, i);
    if (good) {
        add_up(&o);
        good = leave_out_orphans(&o);
    }
    orphans_close(&o);
    return good;
}
