/* Lines along the form as marks: cut into strokes, and these into pieces that are as long as what bends and what is
 * decided at their ends allows. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/limits.h"
#include "base/memory.h"
#include "base/random.h"
#include "marks/streamlines.h"

enum { POINTS = 256 /* of a piece at most */ };

static const double BENT = 0.966; /* cosine of 15 degrees: normals of a piece differ by no more */
static const double PIECE = 5;    /* distances of the finest lines that a piece is long at most */
static const double BENDS = 3,
                    LOOSE = 0.15; /* distances of the finest lines, fraction of these that pieces may be off */
static const double TICK = 0.6;   /* of the length of a line from edge to edge */
static const double SHADE = 0.04; /* brightness, as the eye counts it, that pieces may be off */
/* Of groups, in lengths of strokes. */
static const double ASKED = 0.03;    /* how often along a line its group is asked for */
static const double SHORTEST = 0.35; /* of what a border cuts off */
static const double RAGGED = 0.06;   /* how far beginnings are from their common border */
static const double FIRM = 5;        /* so many times as fast as it ends, a stroke begins */

/* A point of a stroke, and how bright what it lies on is, as the eye counts it: before it and after it, since it may
 * lie where one material ends. */
typedef struct stroke_point {
    flow_point p;
    float      before, after;
    float      shades[2]; /* of its flat face, before and after */
    float      bend;      /* how broad the edge is that it goes round */
} stroke_point;

typedef struct flow_cutter {
    marks              *out;
    const flow_lines   *lines;
    const flow_options *options;
    const flow_surface *surface;
    int                 set;
    random_source       random;
    stroke_point       *points; /* of the stroke that is being cut */
    size_t              count, capacity;
} flow_cutter;

/* What a group makes of one of its strokes. */
typedef struct grouped_stroke {
    bool   grouped, forward; /* drawn the way the line goes */
    float  tone;
    double shifts[2]; /* off the line where it begins and ends, −1 … 1 */
    double share;     /* of the ink of its strip, as strokes overlap */
} grouped_stroke;

static double product(vec3 a, vec3 b)
{
    return (double)a.x * (double)b.x + (double)a.y * (double)b.y + (double)a.z * (double)b.z;
}

/* How far the points between two are from the chord, at most. */
static bool is_straight(const stroke_point *p, size_t first, size_t last, double most)
{
    d3     a = of(p[first].p.at), chord = minus(of(p[last].p.at), a);
    double square = dot(chord, chord);
    for (size_t i = first + 1; i < last; i++) {
        d3     to = minus(of(p[i].p.at), a);
        double part = square > 0 ? dot(to, chord) / square : 0;
        d3     away = minus(to, (d3){part * chord.x, part * chord.y, part * chord.z});
        if (dot(away, away) > most * most)
            return false;
    }
    return true;
}

/* 1 where a bend leaves as much room as it needs for `apart`, less where it is tighter. */
static double looseness(const stroke_point *p, double apart)
{
    return fmin((double)p->bend / (BENDS * apart), 1);
}

/* Do brightness, shade and bend change evenly from one point to another? */
static bool is_even(const stroke_point *p, size_t first, size_t last, double apart)
{
    double from = (double)p[first].after, to = (double)p[last].before, begin = (double)p[first].p.arc,
           length = (double)p[last].p.arc - begin;
    double loose = looseness(&p[first], apart), looser = looseness(&p[last], apart);
    for (size_t i = first + 1; i < last; i++) {
        double even = length > 0 ? from + (to - from) * ((double)p[i].p.arc - begin) / length : from;
        double part = length > 0 ? ((double)p[i].p.arc - begin) / length : 0;
        if (fabs(loose + part * (looser - loose) - looseness(&p[i], apart)) > LOOSE)
            return false;
        if (fabs((double)p[i].before - even) > SHADE || fabs((double)p[i].after - even) > SHADE ||
            fabs((double)p[i].shades[0] - (double)p[i].shades[1]) > SHADE)
            return false;
    }
    return true;
}

/* The last point that a piece from `first` may go to. What lies beyond where a line runs out (`ends`) are pieces of
 * their own. */
static size_t end_of_piece(const flow_cutter *c, const double ends[2], size_t first)
{
    const stroke_point *p = c->points;
    size_t              last = first + 1;
    double              most = c->options->whole ? INFINITY : PIECE * c->options->apart;
    while (last + 1 < c->count && last - first < POINTS && (double)p[last].p.arc != ends[0] &&
           (double)p[last].p.arc != ends[1] && (double)p[last + 1].p.arc - (double)p[first].p.arc < most &&
           (c->options->whole || product(p[first].p.normal, p[last + 1].p.normal) > BENT) &&
           is_straight(p, first, last + 1, c->options->sag) &&
           (c->options->whole || is_even(p, first, last + 1, c->options->apart)))
        last++;
    return last;
}

/* As the eye counts it, about. */
static float seen_brightness(const flow_cutter *c, uint32_t triangle, vec3 at)
{
    const mark_surface *s = c->surface->surface;
    return s->brightness ? (float)sqrt(fmax(s->brightness(s->brightness_of, triangle, at, c->options->apart), 0)) : 1;
}

static vec3 mixed(vec3 a, vec3 b, float part)
{
    return (vec3){a.x + part * (b.x - a.x), a.y + part * (b.y - a.y), a.z + part * (b.z - a.z)};
}

static float bend_at(const flow_cutter *c, const flow_line *line, double arc)
{
    return c->options->whole
               ? INFINITY
               : (float)flow_bend_room(&c->lines->points[line->first], line->count, arc, c->options->apart);
}

static bool add_stroke_point(flow_cutter *c, const flow_line *line, const flow_point *p, uint32_t triangle)
{
    if (!mem_grow((void **)&c->points, &c->capacity, c->count + 1, sizeof *c->points))
        return false;
    float before = c->count ? seen_brightness(c, triangle, p->at) : 1,
          shade = (float)flow_shade_at(c->surface, triangle, p->at, c->options->apart);
    c->points[c->count++] = (stroke_point){*p, before, before, {shade, shade}, bend_at(c, line, (double)p->arc)};
    return true;
}

/* The points of a stroke, with so many in between that lines that are far from each other, whose own points are, too,
 * know the brightness and the light of what they go over. */
static bool lay_points(flow_cutter *c, const flow_line *line, uint32_t first, uint32_t last)
{
    const flow_point   *p = &c->lines->points[line->first];
    const mark_surface *s = c->surface->surface;
    double              apart = c->options->apart * (s->brightness ? 1 : PIECE);
    c->count = 0;
    if (!add_stroke_point(c, line, &p[first], p[first].triangle))
        return false;
    for (uint32_t i = first; i < last; i++) {
        const flow_point *a = &p[i], *b = &p[i + 1];
        uint32_t          triangle = flow_triangle_between(c->surface, a, b);
        double            steps = c->options->whole ? 1 : ceil(((double)b->arc - (double)a->arc) / apart);
        c->points[c->count - 1].after = seen_brightness(c, triangle, a->at);
        c->points[c->count - 1].shades[1] = (float)flow_shade_at(c->surface, triangle, a->at, c->options->apart);
        for (double k = 1; k <= steps; k++) {
            float      part = (float)(k / steps);
            flow_point q = *b;
            if (k < steps) {
                q.at = mixed(a->at, b->at, part);
                q.normal = mixed(a->normal, b->normal, part);
                q.arc = a->arc + part * (b->arc - a->arc);
                q.triangle = triangle;
                for (int n = 0; n < FLOW_SPACES; n++)
                    q.spaces[n] = a->spaces[n] + part * (b->spaces[n] - a->spaces[n]);
            }
            if (!add_stroke_point(c, line, &q, triangle))
                return false;
        }
    }
    return true;
}

/* An end of a piece at a point, after which the piece lies, or before which. */
static flow_end end_at(const flow_cutter *c, const flow_line *line, const stroke_point *q, double to_end, bool after)
{
    const flow_point *p = &q->p;
    float             seen = after ? q->after : q->before;
    flow_end          e = {
                 .normal = p->normal, .to_end = (float)to_end, .drawn = 0.5f, .bright = seen * seen, .shade = q->shades[after]};
    for (int k = 0; k < FLOW_SPACES; k++)
        e.spaces[k] = (float)((double)p->spaces[k] / ldexp(c->lines->apart, -line->level - k));
    return e;
}

/* How far a point is from the nearer end of its line at which there is no other line in the way; never 0 where the face
 * goes on, though its field does not, so that nothing is drawn beyond. */
static double to_edge_of(const flow_cutter *c, const flow_line *line, const flow_point *p, double arc)
{
    const flow_point *ends[2] = {&p[0], &p[line->count - 1]};
    double            away = (double)FLOW_ENDLESS;
    for (int k = 0; k < 2; k++) {
        double to_end = fabs((double)ends[k]->arc - arc);
        if (line->bounded[k] && !line->closed)
            away = fmin(away, to_end > 0 || flow_is_at_crease(c->surface, ends[k]) ? to_end : 0.01 * c->options->apart);
    }
    return away;
}

/* `part`: of the stroke, along the line. */
static void draw_in_group(flow_end *e, const grouped_stroke *g, double part)
{
    double along = fmin(fmax(part, 0), 1), drawn = g->forward ? along : 1 - along;
    e->drawn = (float)drawn;
    e->shift = (float)(g->shifts[0] + drawn * (g->shifts[1] - g->shifts[0]));
    for (int k = 0; k < FLOW_SPACES; k++)
        e->spaces[k] *= (float)g->share;
}

/* How far a point of a stroke is from its nearer end that runs out. */
static double to_end_of(const flow_line *line, const flow_point *p, double arc, double from, double to,
                        const bool cut[2], const grouped_stroke *g)
{
    double away = (double)FLOW_ENDLESS, first = g->grouped && g->forward ? FIRM : 1,
           second = g->grouped && !g->forward ? FIRM : 1;
    if (cut[0] || !(line->closed || line->bounded[0]))
        away = fmin(away, first * fmax(arc - (cut[0] ? from : (double)p[line->ends[0]].arc), 0));
    if (cut[1] || !(line->closed || line->bounded[1]))
        away = fmin(away, second * fmax((cut[1] ? to : (double)p[line->ends[1]].arc) - arc, 0));
    return away;
}

/* How broad the face is; and a line from edge to edge has no more room than it is long, less where it would be a tick.
 * Not where the field alone ends: that is no face. */
static float room_of(const flow_cutter *c, const flow_line *line, const flow_point *p, uint32_t at)
{
    float room = c->surface->rooms[p[at].triangle];
    bool  across = line->bounded[0] && line->bounded[1] && !line->closed && flow_is_at_crease(c->surface, &p[0]) &&
                  flow_is_at_crease(c->surface, &p[line->count - 1]);
    return across ? fminf(room, (float)TICK * p[line->count - 1].arc) : room;
}

/* A stroke: the points first … last of a line. */
static bool add_stroke(flow_cutter *c, const flow_line *line, uint32_t first, uint32_t last, const bool cut[2],
                       const grouped_stroke *g)
{
    marks            *m = c->out;
    const flow_point *p = &c->lines->points[line->first];
    double            from = (double)p[first].arc, to = (double)p[last].arc;
    if (!(to > from))
        return true;
    uint32_t middle = first;
    while (middle < last && (double)p[middle].arc < 0.5 * (from + to))
        middle++;
    double    finest = c->options->levels - 1, u = random_unit(&c->random);
    bool      own_rank = c->options->whole && line->level > 0;
    double    rank = own_rank ? line->level - 1 + log2(1 + u) : (double)line->rank;
    mark_line l = {.middle = p[middle].at,
                   .middle_normal = p[middle].normal,
                   .light = 1 - (float)c->set / (float)c->options->series,
                   .span = 1.0f / (float)c->options->series,
                   .length = (float)(to - from),
                   .density = (float)(1 / c->options->apart),
                   .bright = 1,
                   .rank = (float)rank,
                   .group = g->tone,
                   .level = line->level,
                   .set = (uint8_t)c->set,
                   .stroke = (uint32_t)m->stroke_count++};
    /* Of those that flow, enough must be looked at for the ones that grow; whole ones get their share later. */
    l.perspective = (float)(1 - exp2(rank - finest - 0.2));
    float        room = room_of(c, line, p, middle);
    size_t       begun = m->line_count;
    const double ends[2] = {(double)p[line->ends[0]].arc, (double)p[line->ends[1]].arc};
    if (!lay_points(c, line, first, last))
        return false;
    for (size_t i = 0, end; i + 1 < c->count; i = end) {
        end = end_of_piece(c, ends, i);
        if (!mem_grow((void **)&m->lines, &m->line_capacity, m->line_count + 1, sizeof *m->lines))
            return false;
        const stroke_point *q = c->points, *between = &q[(i + end + 1) / 2];
        l.a = q[i].p.at;
        l.b = q[end].p.at;
        l.triangle = between->p.triangle;
        l.normal = between->p.normal;
        l.from = q[i].p.arc - (float)from;
        l.to = q[end].p.arc - (float)from;
        for (int k = 0; k < 2; k++) {
            const stroke_point *at = &q[k ? end : i];
            l.ends[k] = end_at(c, line, at, to_end_of(line, p, (double)at->p.arc, from, to, cut, g), k == 0);
            l.ends[k].room = fminf(room, at->bend);
            l.ends[k].to_edge = (float)to_edge_of(c, line, p, (double)at->p.arc);
        }
        for (int k = 0; k < 2 && g->grouped; k++)
            draw_in_group(&l.ends[k], g, (double)(k ? l.to : l.from) / (to - from));
        m->lines[m->line_count++] = l;
        m->line_length += (double)l.to - (double)l.from;
    }
    if (c->options->whole)
        mark_stroke_middle(&m->lines[begun], m->line_count - begun);
    return true;
}

/* Cuts a line into strokes, whose ends lie anywhere. */
static bool cut_line(flow_cutter *c, const flow_line *line)
{
    const flow_point    *p = &c->lines->points[line->first];
    double               length = c->options->length, uneven = (double)c->options->uneven;
    const grouped_stroke alone = {.grouped = false};
    bool                 cut[2] = {false, false};
    if (!(length > 0))
        return add_stroke(c, line, 0, line->count - 1, cut, &alone);
    double next = length * random_unit(&c->random);
    for (uint32_t first = 0, i = 1; i < line->count; i++) {
        bool last = i + 1 == line->count;
        if ((double)p[i].arc < next && !last)
            continue;
        cut[0] = first > 0 || line->closed;
        cut[1] = !last || line->closed;
        if (!add_stroke(c, line, first, i, cut, &alone))
            return false;
        first = i;
        next = (double)p[i].arc + length * (1 + 0.6 * uneven * random_signed(&c->random));
    }
    return true;
}

/* --- groups --------------------------------------------------------------------------------------------- */

static d3 direction_on(const flow_line *line, const flow_point *p, uint32_t i)
{
    return d3_unit(minus(of(p[i + 1 < line->count ? i + 1 : i].at), of(p[i > 0 ? i - 1 : 0].at)));
}

static void group_at(const flow_cutter *c, const flow_line *line, uint32_t i, flow_group *out)
{
    const flow_point *p = &c->lines->points[line->first];
    flow_group_find(out, of(p[i].at), direction_on(line, p, i), c->options->length,
                    c->options->length * c->options->groups, c->options->seed * 4 + (uint32_t)c->set);
}

/* The point that is nearest to an arc. */
static uint32_t point_at(const flow_line *line, const flow_point *p, uint32_t from, double arc)
{
    uint32_t i = from;
    while (i + 1 < line->count && (double)p[i].arc < arc)
        i++;
    while (i > 0 && (double)p[i - 1].arc >= arc)
        i--;
    return i;
}

/* A stroke of a group, on points first … last but for what a hand makes of its ends: it begins nearly where the others
 * do, and runs on more or less far. */
static bool add_grouped(flow_cutter *c, const flow_line *line, uint32_t first, uint32_t last)
{
    const flow_point *p = &c->lines->points[line->first];
    double            length = c->options->length, from = (double)p[first].arc, to = (double)p[last].arc;
    grouped_stroke    g = {.grouped = true};
    flow_group        group = {.number = 0};
    uint32_t          middle = point_at(line, p, first, 0.5 * (from + to));
    group_at(c, line, middle, &group);
    g.forward = dot(direction_on(line, p, middle), group.toward) >= 0;
    g.tone = (float)(2 * group.tone - 1);
    double tilt = (g.forward ? 0.8 : -0.8) * group.tilt, own = 0.15 * random_signed(&c->random);
    g.shifts[0] = own - tilt;
    g.shifts[1] = own + tilt + 0.1 * random_signed(&c->random);
    double begins = RAGGED * (double)c->options->uneven * length * random_signed(&c->random),
           ends = fmin(c->options->overlap * length, to - from) *
                  (1 - (double)c->options->uneven * random_unit(&c->random));
    double   low = from - (g.forward ? begins : ends), high = to + (g.forward ? ends : begins);
    uint32_t start = point_at(line, p, first, low), stop = point_at(line, p, last, high);
    double   drawn = (double)p[stop].arc - (double)p[start].arc;
    g.share = drawn > 0 ? fmin((to - from) / drawn, 1) : 1;
    const bool cut[2] = {start > 0 || line->closed, stop + 1 < line->count || line->closed};
    return add_stroke(c, line, start, stop, cut, &g);
}

/* Cuts a line where groups end. */
static bool cut_in_groups(flow_cutter *c, const flow_line *line)
{
    const flow_point *p = &c->lines->points[line->first];
    double            length = c->options->length, asked = 0;
    flow_group        own, here;
    uint32_t          first = 0, end = line->count - 1;
    group_at(c, line, 0, &own);
    for (uint32_t i = 1; i < end; i++) {
        if ((double)p[i].arc < asked)
            continue;
        asked = (double)p[i].arc + ASKED * length;
        group_at(c, line, i, &here);
        bool long_enough = (double)p[i].arc - (double)p[first].arc > SHORTEST * length &&
                           (double)p[end].arc - (double)p[i].arc > SHORTEST * length;
        if (here.number == own.number || !long_enough)
            continue;
        if (!add_grouped(c, line, first, i))
            return false;
        first = i;
        own = here;
    }
    return add_grouped(c, line, first, end);
}

/* --- ranks ---------------------------------------------------------------------------------------------- */

typedef struct ranked_stroke {
    float  rank;
    size_t first; /* piece */
} ranked_stroke;

static int by_rank(const void *a, const void *b)
{
    const ranked_stroke *one = a, *other = b;
    if (one->rank != other->rank)
        return one->rank < other->rank ? -1 : 1;
    return one->first < other->first ? -1 : one->first > other->first;
}

/* Priorities of whole strokes, from the set's first piece on: the length of those of lower rank, fraction of all, so
 * that any fraction of the strokes has that fraction of the ink. */
static bool share_priorities(marks *m, size_t first)
{
    ranked_stroke *strokes = mem_alloc((m->line_count - first) * sizeof *strokes);
    size_t         count = 0;
    double         whole = 0, before = 0;
    for (size_t i = first; strokes && i < m->line_count; i++)
        if (i == first || m->lines[i].stroke != m->lines[i - 1].stroke) {
            strokes[count++] = (ranked_stroke){m->lines[i].rank, i};
            whole += (double)m->lines[i].length;
        }
    if (strokes && count)
        qsort(strokes, count, sizeof *strokes, by_rank);
    for (size_t k = 0; strokes && k < count; k++) {
        uint32_t stroke = m->lines[strokes[k].first].stroke;
        for (size_t i = strokes[k].first; i < m->line_count && m->lines[i].stroke == stroke; i++)
            m->lines[i].perspective = (float)(1 - before / whole);
        before += (double)m->lines[strokes[k].first].length;
    }
    bool done = strokes != NULL;
    mem_free(strokes);
    return done;
}

static lmn_status add_set(marks *out, const flow_surface *f, const flow_options *w, int set, lmn_error *error)
{
    flow_lines  lines;
    flow_cutter c = {.out = out, .lines = &lines, .options = w, .surface = f, .set = set};
    size_t      first = out->line_count;
    c.random = random_start(w->seed, (uint32_t)set + 0xC07);
    lmn_status status = flow_lines_make(&lines, f, w, set, error);
    for (size_t i = 0; i < lines.line_count && status == LMN_OK; i++) {
        bool grouped = w->length > 0 && w->groups > 0;
        if (!(grouped ? cut_in_groups(&c, &lines.lines[i]) : cut_line(&c, &lines.lines[i])))
            status = error_memory(error);
        else if (out->line_count > LIMIT_MARKS)
            status = error_set(error, LMN_LIMIT, "the strokes on this surface have more than %d pieces", LIMIT_MARKS);
    }
    if (status == LMN_OK && w->whole && !share_priorities(out, first))
        status = error_memory(error);
    mem_free(c.points);
    flow_lines_release(&lines);
    return status;
}

lmn_status marks_streamlines(marks *out, const mark_surface *s, const flow_options *w, lmn_error *error)
{
    flow_surface f;
    memset(out, 0, sizeof *out);
    out->area = mark_surface_area(s);
    out->flow = !w->whole;
    out->levels = w->levels;
    out->apart = ldexp(w->apart, w->levels - 1);
    out->sag = w->sag;
    if (!(out->area > 0) || !(w->apart > 0))
        return LMN_OK;
    lmn_status status = flow_surface_make(&f, s, w->whole ? 0 : out->apart, error);
    f.slant = (double)w->slant;
    for (int set = 0; set < w->series && status == LMN_OK; set++)
        status = add_set(out, &f, w, set, error);
    flow_surface_release(&f);
    for (size_t i = 0; i < out->line_count && w->whole; i++)
        out->lines[i].density = (float)(out->line_length / out->area);
    if (status != LMN_OK)
        surface_marks_release(out);
    return status;
}
