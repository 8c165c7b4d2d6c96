/* Chains made whole before anything is decided by their length. The outline of a polygon mesh jumps from one row of
 * edges to the next over edges that no one ever sees, roofs come part by part, vertices are split, and bars thinner
 * than the pen lie in front; on the page the pieces follow each other, and a hand would draw them in one go.
 *
 * Ends that lie close together are linked, the cheapest pair first, each end once:
 *
 *     cost = gap / τ + 2 (1 − cos turn₁) + 2 (1 − cos turn₂) + depth gap / scale + ½ where kinds or parts differ
 *
 * Linked strokes that are alike and almost touch become one stroke; those with a wider gap follow each other in one
 * chain, and whoever draws them closes gaps that the pen would not leave. What differs in kind stays apart but counts
 * as one chain for rules of length. After Blender's Line Art, which links the nearest ends, with tangents. */
#include "stroke/stroke_private.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "stroke/join_pairs.h"

/* All lengths are on paper, in units of 1/96 inch. Ends this far apart may be linked (τ, half a millimetre); those
 * closer than OVERLAP even where one runs past the other. */
#define REACH_OF_LINKS (0.5 * PAPER_UNITS_PER_MM)
#define OVERLAP        0.7f
/* Strokes that are alike and as close become one. */
#define GAP 1.0f
/* Ends that are farther apart come as near in the middle, each at its own depth, and the lines bend to it over so much:
 * a long straight line that leant as a whole would not lie where it was found any more. */
#define MEET_LEAST 0.05f
#define BEND       5.0f
/* Sharp lines whose ends are closer than this have been ended there, at a corner. */
#define TOUCH 0.02f
/* How much of a stroke says which way its end points. */
#define REACH 2.5f
/* A link costs less than MOST; this much deeper, and it costs 1 more; this much deeper there is none. */
#define MOST        2.0f
#define DEPTH_SCALE 12.0f
#define DEPTH_MOST  12.0f
#define OTHER_KIND  0.5f
/* What is drawn over anything thinner than this, in widths. */
#define BRIDGED_WIDTHS 1.5f
/* Lines of form must be longer than others by this factor, but no longer than this fraction of the page. */
#define FORM_SHORTEST 16.0
#define FORM_FRACTION (1.0 / 64)
/* What overlaps is joined, and may overlap with others then: so often. */
enum { TRIMS = 3 };

/* An end of a stroke: number 2 · stroke, + 1 for its last point. */
typedef struct stroke_end {
    float   x, y, depth;
    float   out_x, out_y; /* unit: away from the stroke */
    int32_t column, row;
} stroke_end;

typedef struct joiner {
    stroke_set           *set;
    double                focal;
    bool                  orthographic;
    stroke_end           *ends;
    uint32_t             *partners;    /* per end; NO_VERTEX: none */
    uint8_t              *rings;       /* per chain that is made of links: has it come full circle over a gap? */
    uint32_t              first_chain; /* that is made of links */
    uint32_t             *first_marks; /* per chain, and one more */
    const stroke_options *options;
    float                 bridged; /* hidden stretches of a chain up to here are thinner than the pen */
    uint32_t             *wholes;  /* per chain: another one of the same whole, or itself */
} joiner;

static int32_t cell_of(float at)
{
    return (int32_t)floor((double)at / REACH_OF_LINKS);
}

static stroke_end end_of(const joiner *j, uint32_t number)
{
    const stroke       *s = &j->set->strokes[number / 2];
    const stroke_point *p = &j->set->points[s->first], *from = number & 1 ? p + s->count - 1 : p, *to = from;
    float               x = 0, y = 0;
    for (uint32_t i = 1; i < s->count && x * x + y * y < REACH * REACH; i++) {
        to = number & 1 ? from - i : from + i;
        x = from->x - to->x;
        y = from->y - to->y;
    }
    float length = sqrtf(x * x + y * y);
    float fraction = length > 0 ? 1 / length : 0;
    return (stroke_end){from->x, from->y, from->depth, x * fraction, y * fraction, cell_of(from->x), cell_of(from->y)};
}

static bool put_ends(joiner *j)
{
    size_t count = 2 * j->set->stroke_count;
    j->ends = mem_alloc((count + 1) * sizeof *j->ends);
    for (uint32_t i = 0; i < count && j->ends; i++)
        j->ends[i] = end_of(j, i);
    return j->ends != NULL;
}

static const stroke_point *point_at_end(const stroke_set *set, uint32_t number)
{
    const stroke *s = &set->strokes[number / 2];
    return &set->points[s->first + (number & 1 ? s->count - 1 : 0)];
}

static bool are_alike(const stroke *s, const stroke *t)
{
    return s->kind == t->kind && s->part == t->part && s->smooth == t->smooth;
}

static float gap_between(const joiner *j, uint32_t a, uint32_t b)
{
    return hypotf(j->ends[b].x - j->ends[a].x, j->ends[b].y - j->ends[a].y);
}

/* Has a corner ended both? */
static bool meet_at_corner(const joiner *j, uint32_t a, uint32_t b)
{
    stroke_class kind = j->set->strokes[a / 2].kind;
    return gap_between(j, a, b) < TOUCH &&
           (kind == STROKE_CREASE || kind == STROKE_BORDER || kind == STROKE_MATERIAL || kind == STROKE_DRAWN);
}

/* Are both stretches of one chain, with nothing but what is thinner than the pen between them? */
static bool is_bridge(const joiner *j, uint32_t a, uint32_t b)
{
    const stroke *s = &j->set->strokes[a / 2], *t = &j->set->strokes[b / 2];
    if (s->chain != t->chain || s->hidden_by != t->hidden_by || s == t || s->closed || (a & 1) == (b & 1))
        return false;
    const stroke *first = a & 1 ? s : t, *second = a & 1 ? t : s;
    float         from = j->set->points[first->first + first->count - 1].arc, to = j->set->points[second->first].arc;
    return to >= from && to - from <= j->bridged;
}

/* The cosines of the turns from one end into the gap and out of it; where there is hardly a gap, both are half of the
 * whole turn. */
static void turns_between(const stroke_end *p, const stroke_end *q, float out[2])
{
    float x = q->x - p->x, y = q->y - p->y, length = hypotf(x, y);
    float whole = -(p->out_x * q->out_x + p->out_y * q->out_y);
    if (length < OVERLAP) {
        out[0] = out[1] = sqrtf(fmaxf(0.5f + 0.5f * whole, 0));
        return;
    }
    out[0] = (x * p->out_x + y * p->out_y) / length;
    out[1] = -(x * q->out_x + y * q->out_y) / length;
}

/* What linking two ends costs; below 0: they are not linked. */
static float cost_of(const joiner *j, uint32_t a, uint32_t b)
{
    const stroke     *s = &j->set->strokes[a / 2], *t = &j->set->strokes[b / 2];
    const stroke_end *p = &j->ends[a], *q = &j->ends[b];
    if (s->hidden_by != t->hidden_by || s->closed || t->closed || (s == t && s->count < 4))
        return -1;
    if (is_bridge(j, a, b))
        return 0;
    float  gap = gap_between(j, a, b), turns[2];
    double deeper = fabs((double)p->depth - q->depth) * j->focal / (j->orthographic ? 1 : p->depth);
    if ((double)gap > REACH_OF_LINKS || deeper > DEPTH_MOST)
        return -1;
    turns_between(p, q, turns);
    float cost = gap / (float)REACH_OF_LINKS + 2 * (1 - turns[0]) + 2 * (1 - turns[1]) + (float)deeper / DEPTH_SCALE +
                 (are_alike(s, t) ? 0 : OTHER_KIND);
    return cost < MOST ? cost : -1;
}

/* The same for ends of cells that touch each other; of two chains, for those that are near enough whatever is rounded.
 */
static float cost_near(void *user, uint32_t a, uint32_t b)
{
    const joiner     *j = user;
    const stroke_end *p = &j->ends[a], *q = &j->ends[b];
    double            x = (double)q->x - p->x, y = (double)q->y - p->y;
    if (abs(p->column - q->column) > 1 || abs(p->row - q->row) > 1)
        return -1;
    if (x * x + y * y > REACH_OF_LINKS * REACH_OF_LINKS && j->set->strokes[a / 2].chain != j->set->strokes[b / 2].chain)
        return -1;
    return cost_of(j, a, b);
}

/* Ends of the same chain with next to nothing between, which follow each other, wherever they point. */
static void offer_bridges(void *user, uint32_t end, end_search *search)
{
    const joiner     *j = user;
    const stroke_set *set = j->set;
    const bool        last = end & 1;
    const float       arc = point_at_end(set, end)->arc;
    const uint32_t    chain = set->strokes[end / 2].chain;
    for (size_t i = end / 2; last ? ++i < set->stroke_count : i-- > 0;) {
        const uint32_t other = 2 * (uint32_t)i + !last;
        if (set->strokes[i].chain != chain || fabsf(point_at_end(set, other)->arc - arc) > j->bridged)
            return;
        if (is_bridge(j, end, other))
            end_search_offer(search, other);
    }
}

static end_place place_of(const joiner *j, uint32_t end)
{
    const stroke     *s = &j->set->strokes[end / 2];
    const stroke_end *e = &j->ends[end];
    const bool        points = e->out_x != 0 || e->out_y != 0;
    return (end_place){e->x, e->y, points ? atan2f(e->out_y, e->out_x) : NAN, s->closed ? END_OF_NONE : s->hidden_by};
}

/* The chain that stands for all of a whole. */
static uint32_t whole_of(joiner *j, uint32_t chain)
{
    while (j->wholes[chain] != chain)
        chain = j->wholes[chain] = j->wholes[j->wholes[chain]];
    return chain;
}

static void link_ends(joiner *j, uint32_t a, uint32_t b)
{
    const stroke *s = &j->set->strokes[a / 2], *t = &j->set->strokes[b / 2];
    j->wholes[whole_of(j, s->chain)] = whole_of(j, t->chain);
    if (are_alike(s, t) && !meet_at_corner(j, a, b)) {
        j->partners[a] = b;
        j->partners[b] = a;
    }
}

/* The best ones first, each end once. */
static bool match_ends(joiner *j)
{
    const size_t    count = 2 * j->set->stroke_count;
    const end_rules rules = {(float)REACH_OF_LINKS, MOST, cost_near, offer_bridges, j};
    end_place      *places = mem_alloc((count + 1) * sizeof *places);
    uint32_t       *pairs = mem_alloc((count + 1) * sizeof *pairs);
    j->wholes = mem_alloc((j->set->chain_count + 1) * sizeof *j->wholes);
    bool good = places && pairs && j->wholes;
    for (uint32_t i = 0; i < count && good; i++)
        places[i] = place_of(j, i);
    for (uint32_t i = 0; i < j->set->chain_count && good; i++)
        j->wholes[i] = i;
    good = good && ends_pair(pairs, places, count, &rules, &j->set->ends_compared);
    for (uint32_t i = 0; i < count && good; i++)
        if (pairs[i] != END_OF_NONE && pairs[i] > i)
            link_ends(j, i, pairs[i]);
    mem_free(places);
    mem_free(pairs);
    return good;
}

/* --- rules of length ------------------------------------------------------------------------------------ */

/* What counts of a whole: its length on the page, hidden or not, and of lines of form the length that is inked, each
 * point by its weight. */
typedef struct whole_facts {
    double length, ink;
    bool   counted; /* of a chain: its length is in its whole */
} whole_facts;

static double ink_of(const joiner *j, const stroke *s)
{
    const stroke_point *p = &j->set->points[s->first];
    double              ink = 0;
    for (uint32_t i = 0; i + 1 < s->count; i++)
        ink += ((double)p[i + 1].arc - p[i].arc) * 0.5 * ((double)p[i].weight + p[i + 1].weight);
    return ink;
}

/* Marks what is too short as a whole, and lines of form that are short for how faint they are: they say nothing. */
static bool leave_out(joiner *j, const stroke_view *v, uint8_t *used)
{
    whole_facts *facts = mem_calloc(j->set->chain_count + 1, sizeof *facts);
    int          side = v->camera.width > v->camera.height ? v->camera.width : v->camera.height;
    double       shortest = j->options->shortest, faint = fmin(FORM_SHORTEST * shortest, FORM_FRACTION * side);
    for (size_t i = 0; i < j->set->stroke_count && facts; i++) {
        const stroke *s = &j->set->strokes[i];
        whole_facts  *whole = &facts[whole_of(j, s->chain)];
        whole->length += facts[s->chain].counted ? 0 : (double)s->chain_length;
        whole->ink += s->kind >= STROKE_SUGGESTIVE ? ink_of(j, s) : 0;
        facts[s->chain].counted = true;
    }
    for (size_t i = 0; i < j->set->stroke_count && facts; i++) {
        const stroke      *s = &j->set->strokes[i];
        const whole_facts *whole = &facts[whole_of(j, s->chain)];
        used[i] = whole->length < shortest || (s->kind >= STROKE_SUGGESTIVE && whole->ink < faint);
    }
    mem_free(facts);
    return facts != NULL;
}

/* --- joined strokes ------------------------------------------------------------------------------------- */

typedef struct joined {
    stroke       *strokes;
    stroke_point *points;
    stroke_mark  *marks;
    size_t        stroke_count, point_count, mark_count, mark_capacity;
    bool          failed;
} joined;

/* Where the marks of each chain begin. */
static bool index_marks(joiner *j)
{
    const stroke_set *set = j->set;
    j->first_marks = mem_calloc(set->chain_count + 2, sizeof *j->first_marks);
    for (size_t i = 0; i < set->mark_count && j->first_marks; i++)
        j->first_marks[set->marks[i].chain + 1]++;
    for (size_t i = 0; i < set->chain_count && j->first_marks; i++)
        j->first_marks[i + 1] += j->first_marks[i];
    return j->first_marks != NULL;
}

/* Marks of a piece that goes into a joined stroke, which it enters at arc `from`. */
static void put_marks(joined *out, const joiner *j, uint32_t entry, float from, uint32_t chain)
{
    const stroke *s = &j->set->strokes[entry / 2];
    float         begin = j->set->points[s->first].arc, end = j->set->points[s->first + s->count - 1].arc;
    for (uint32_t i = j->first_marks[s->chain]; i < j->first_marks[s->chain + 1]; i++) {
        stroke_mark m = j->set->marks[i];
        if (m.arc < begin || m.arc > end)
            continue;
        if (!mem_grow((void **)&out->marks, &out->mark_capacity, out->mark_count + 1, sizeof *out->marks)) {
            out->failed = true;
            return;
        }
        out->marks[out->mark_count++] = (stroke_mark){m.id, chain, from + (entry & 1 ? end - m.arc : m.arc - begin)};
    }
}

static const stroke_point *point_from(const stroke_set *set, uint32_t entry, uint32_t i)
{
    const stroke *s = &set->strokes[entry / 2];
    return &set->points[s->first + (entry & 1 ? s->count - 1 - i : i)];
}

/* The point between two, a fraction of the way; nothing finer is known of what follows it. */
static stroke_point point_between(const joiner *j, const stroke_point *p, const stroke_point *q, float f)
{
    stroke_point out = *p;
    out.x += f * (q->x - p->x);
    out.y += f * (q->y - p->y);
    out.depth =
        j->orthographic ? p->depth + f * (q->depth - p->depth) : 1 / (1 / p->depth + f * (1 / q->depth - 1 / p->depth));
    out.weight += f * (q->weight - p->weight);
    for (int k = 0; k < 2; k++)
        out.aside[k] += f * (q->aside[k] - p->aside[k]);
    out.fine_count = 0;
    return out;
}

/* Puts the place at which a line that goes from `end` to `next` begins to bend, if it is long enough and straight. */
static bool put_bend(joined *out, const joiner *j, const stroke_point *end, const stroke_point *next)
{
    float length = hypotf(next->x - end->x, next->y - end->y);
    if (length < 2 * BEND || end->fine_count || next->fine_count)
        return false;
    out->points[out->point_count++] = point_between(j, end, next, BEND / length);
    return true;
}

/* What has been reached goes on at a stroke's first point, which is somewhere else. */
static void put_meeting(joined *out, const joiner *j, uint32_t entry, float gap)
{
    const stroke_point *own = point_from(j->set, entry, 0), *next = point_from(j->set, entry, 1);
    stroke_point        reached = out->points[--out->point_count], before = reached;
    if (hypotf(own->aside[0] - reached.aside[0], own->aside[1] - reached.aside[1]) > MEET_LEAST) {
        out->point_count++; /* each stands for a line of its own: both stay */
        out->points[out->point_count++] = *own;
        return;
    }
    if (out->point_count > out->strokes[out->stroke_count - 1].first) {
        before = out->points[out->point_count - 1];
        put_bend(out, j, &reached, &before);
    }
    float shift = 0.5f * (1 - MEET_LEAST / gap);
    for (int k = 0; k < 2; k++) {
        const stroke_point *from = k ? own : &reached, *to = k ? &reached : own;
        stroke_point       *met = &out->points[out->point_count++];
        *met = *from;
        met->x += shift * (to->x - from->x);
        met->y += shift * (to->y - from->y);
    }
    put_bend(out, j, own, next);
}

/* Appends a stroke's points, the last first when it is entered at its last end. `gap`: how far it begins from the
 * position that has been reached, if it goes on from there. */
static void put_points(joined *out, const joiner *j, uint32_t entry, bool goes_on, float gap)
{
    const stroke *s = &j->set->strokes[entry / 2];
    if (goes_on && gap > MEET_LEAST)
        put_meeting(out, j, entry, gap);
    for (uint32_t i = goes_on ? 1 : 0; i < s->count; i++)
        out->points[out->point_count++] = *point_from(j->set, entry, i);
}

/* Arcs of the strokes of a chain from `first` on, gaps counted. */
static void measure(joined *out, size_t first)
{
    const stroke_point *before = NULL;
    float               arc = 0;
    for (size_t i = first; i < out->stroke_count; i++)
        for (uint32_t k = 0; k < out->strokes[i].count; k++) {
            stroke_point *p = &out->points[out->strokes[i].first + k];
            if (before)
                arc += hypotf(p->x - before->x, p->y - before->y);
            p->arc = arc;
            before = p;
        }
    for (size_t i = first; i < out->stroke_count; i++)
        out->strokes[i].chain_length = arc;
}

/* As gap_between says, of ends as they are now. */
static float gap_of(const joiner *j, uint32_t a, uint32_t b)
{
    const stroke_point *p = point_at_end(j->set, a), *q = point_at_end(j->set, b);
    return hypotf(q->x - p->x, q->y - p->y);
}

/* All that is linked, in one chain: one stroke where pieces almost touch, the next one where they do not. `entry`: the
 * end that it begins with. */
static void put_linked(joined *out, joiner *j, uint32_t entry, uint8_t *used)
{
    uint32_t chain = (uint32_t)j->set->chain_count++;
    size_t   first = out->stroke_count;
    uint64_t id = j->set->strokes[entry / 2].id;
    float    arc = 0, gap = 0;
    for (uint32_t at = entry, next;; at = next) {
        const stroke *piece = &j->set->strokes[at / 2];
        bool          goes_on = at != entry && gap <= GAP;
        if (!goes_on) {
            stroke s = *piece;
            s.chain = chain;
            s.first = (uint32_t)out->point_count;
            out->strokes[out->stroke_count++] = s;
        }
        id = piece->id < id ? piece->id : id;
        put_points(out, j, at, goes_on, gap);
        put_marks(out, j, at, arc + gap, chain);
        arc += gap + j->set->points[piece->first + piece->count - 1].arc - j->set->points[piece->first].arc;
        stroke *s = &out->strokes[out->stroke_count - 1];
        s->count = (uint32_t)(out->point_count - s->first);
        used[at / 2] = 1;
        next = j->partners[at ^ 1];
        gap = next == NO_VERTEX ? 0 : gap_of(j, at ^ 1, next);
        if (next == entry && out->stroke_count == first + 1 && gap <= GAP) {
            s->closed = true;
            out->points[out->point_count - 1] = out->points[s->first];
        }
        j->rings[chain - j->first_chain] = next == entry && !s->closed;
        if (next == NO_VERTEX || used[next / 2])
            break;
    }
    for (size_t i = first; i < out->stroke_count; i++)
        out->strokes[i].id = id;
    measure(out, first);
}

static void put_joined(joined *out, joiner *j, uint32_t entry, uint8_t *used)
{
    if (j->partners[entry ^ 1] != NO_VERTEX) {
        put_linked(out, j, entry, used);
        return;
    }
    stroke s = j->set->strokes[entry / 2];
    s.first = (uint32_t)out->point_count;
    put_points(out, j, entry & ~1u, false, 0);
    out->strokes[out->stroke_count++] = s;
    used[entry / 2] = 1;
}

static bool open_joined(joined *out, const stroke_set *set)
{
    /* Lines that bend to where they meet have points more. */
    *out = (joined){.strokes = mem_alloc((set->stroke_count + 1) * sizeof(stroke)),
                    .points = mem_alloc((set->point_count + 4 * set->stroke_count + 1) * sizeof(stroke_point))};
    return out->strokes && out->points;
}

/* The joined strokes take the place of those that they were made of. */
static bool take_joined(stroke_set *set, joined *out)
{
    if (!mem_grow((void **)&set->marks, &(size_t){set->mark_count}, set->mark_count + out->mark_count,
                  sizeof *set->marks))
        return false;
    if (out->mark_count)
        memcpy(set->marks + set->mark_count, out->marks, out->mark_count * sizeof *out->marks);
    set->mark_count += out->mark_count;
    mem_free(set->strokes);
    mem_free(set->points);
    set->strokes = out->strokes;
    set->points = out->points;
    set->stroke_count = out->stroke_count;
    set->point_count = out->point_count;
    out->strokes = NULL;
    out->points = NULL;
    return true;
}

static int compare_strokes(const void *a, const void *b)
{
    const stroke *p = a, *q = b;
    if (p->kind != q->kind)
        return p->kind < q->kind ? -1 : 1;
    if (p->chain != q->chain)
        return p->chain < q->chain ? -1 : 1;
    return p->first < q->first ? -1 : p->first > q->first;
}

/* All strokes but those that are used, joined with their partners. */
static bool put_all(joiner *j, uint8_t *used)
{
    stroke_set *set = j->set;
    joined      out;
    mem_free(j->rings);
    mem_free(j->first_marks);
    j->first_marks = NULL;
    j->first_chain = (uint32_t)set->chain_count;
    j->rings = mem_calloc(set->stroke_count + 1, 1);
    bool good = open_joined(&out, set) && index_marks(j) && j->rings;
    for (int rings = 0; rings < 2 && good; rings++) /* what has an end, then what has come full circle */
        for (uint32_t i = 0; i < set->stroke_count; i++) {
            bool first_free = j->partners[2 * i] == NO_VERTEX, last_free = j->partners[2 * i + 1] == NO_VERTEX;
            if (!used[i] && (rings || first_free || last_free))
                put_joined(&out, j, rings || first_free ? 2 * i : 2 * i + 1, used);
        }
    good = good && !out.failed && take_joined(set, &out);
    mem_free(out.strokes);
    mem_free(out.points);
    mem_free(out.marks);
    if (good && set->stroke_count)
        qsort(set->strokes, set->stroke_count, sizeof *set->strokes, compare_strokes);
    return good;
}

/* --- ends that are cut ---------------------------------------------------------------------------------- */

/* What is linked over gaps stays so: strokes of one chain of links, which follow each other. */
static void keep_links(joiner *j)
{
    const stroke *s = j->set->strokes;
    uint32_t      count = (uint32_t)j->set->stroke_count;
    memset(j->partners, 0xFF, 2 * (size_t)count * sizeof *j->partners);
    for (uint32_t first = 0, end = 0; first < count; first = end) {
        while (end < count && s[end].chain == s[first].chain)
            end++;
        if (s[first].chain < j->first_chain)
            continue;
        for (uint32_t i = first + 1; i < end; i++) {
            j->partners[2 * i - 1] = 2 * i;
            j->partners[2 * i] = 2 * i - 1;
        }
        if (j->rings[s[first].chain - j->first_chain]) {
            j->partners[2 * end - 1] = 2 * first;
            j->partners[2 * first] = 2 * end - 1;
        }
    }
}

static void link_cut(joiner *j, const uint32_t ends[2])
{
    for (int k = 0; k < 2; k++) {
        if (j->partners[ends[k]] != NO_VERTEX)
            j->partners[j->partners[ends[k]]] = NO_VERTEX;
        j->partners[ends[k]] = ends[1 - k];
    }
}

/* Cuts outlines that run past each other to where they meet, and joins them there; what is joined may overlap with
 * others then. */
static lmn_status join_overlaps(joiner *j, const stroke_view *v, lmn_error *error)
{
    for (int round = 0; round < TRIMS; round++) {
        uint32_t(*cut)[2];
        size_t     count;
        lmn_status status = strokes_trim(j->set, v, &cut, &count, error);
        if (status != LMN_OK || !count) {
            mem_free(cut);
            return status;
        }
        uint8_t *used = mem_calloc(j->set->stroke_count + 1, 1);
        keep_links(j);
        for (size_t i = 0; i < count; i++)
            link_cut(j, cut[i]);
        bool good = used && put_all(j, used);
        mem_free(used);
        mem_free(cut);
        if (!good)
            return error_memory(error);
    }
    return LMN_OK;
}

static bool join_all(joiner *j, const stroke_view *v)
{
    size_t   ends = 2 * j->set->stroke_count;
    uint8_t *used = mem_calloc(j->set->stroke_count + 1, 1);
    j->partners = mem_alloc((ends + 1) * sizeof *j->partners);
    bool good = used && j->partners;
    if (good)
        memset(j->partners, 0xFF, (ends + 1) * sizeof *j->partners);
    good = good && put_ends(j) && match_ends(j) && leave_out(j, v, used) && put_all(j, used);
    mem_free(used);
    return good;
}

lmn_status strokes_join(stroke_set *set, const stroke_view *v, const stroke_options *options, lmn_error *error)
{
    joiner     j = {.set = set,
                    .options = options,
                    .bridged = BRIDGED_WIDTHS * fmaxf(options->width, 0),
                    .focal = 0.5 * v->camera.height * fabs(v->camera.projection.m[5]),
                    .orthographic = v->camera.orthographic};
    lmn_status status = join_all(&j, v) ? join_overlaps(&j, v, error) : error_memory(error);
    mem_free(j.ends);
    mem_free(j.partners);
    mem_free(j.first_marks);
    mem_free(j.wholes);
    mem_free(j.rings);
    return status;
}
