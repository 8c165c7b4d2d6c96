/* Lines along a field that keep their distance, level by level, each among those that were there before (after Jobard
 * and Lefer 1997). New lines begin in gaps: beside each line, as many of them as make
 * the gap to the next one come nearest to what it shall be. So lines are as even as the field allows, and no level
 * moves those before it. */
#include <math.h>
#include <string.h>

#include "base/limits.h"
#include "base/memory.h"
#include "base/random.h"
#include "base/threads.h"
#include "base/work.h"
#include "marks/streamlines.h"

enum { STEPS_MAX = 200000 /* of a line */, STUCK = 12 /* steps that come to nothing */ };

/* In distances of the level. */
static const double STEP = 0.3;  /* of samples and steps */
static const double STOP = 0.68; /* nearer to another line lines end, more or less, so that ends do not line up */
static const double STOP_UNEVEN = 0.08;
static const double BEYOND = 1;          /* so far they go on there, */
static const double MEET = 0.4;          /* unless they meet the other line before; */
static const double ACROSS = 0.6;        /* where the field's arms change, straight on */
static const double FREE = 0.76;         /* nearer to another line none begins */
static const double TWO_FROM = 1.6;      /* a gap this wide takes a line */
static const double LEAST = 5;           /* length of a line that ends at others */
static const double LONELY = 1.15;       /* where nothing is nearer, */
static const double LEAST_LONELY = 3;    /* a shorter one is better than unevenly wide neighbours, */
static const double HOLE = 1.5;          /* and where nothing is that near, */
static const double LEAST_IN_HOLE = 2;   /* a still shorter one is better than a hole */
static const double LEAST_BOUNDED = 0.7; /* and of one that runs from edge to edge, */
static const double LEAST_NARROW = 0.3;  /* and of one across a face that is narrower than lines are apart */
static const double HUG = 0.3;           /* nearer to an edge no line begins */
static const double FADED = 1.2;         /* of an end that runs out, the room is its neighbours' */
static const double REACH = 3.4;         /* how far gaps are looked for */
static const double WIDEST = 2.4;        /* gap that its two lines share; beyond, a line has its own room */

typedef struct flow_maker {
    flow_lines         *out;
    const flow_surface *f;
    flow_grid           grid;
    double              turn, apart; /* of the level */
    bool                measures;    /* strips are asked for */
    bool                crosses;     /* another set, which draws tone already */
    int                 level;
    random_source       random;
    flow_point         *points; /* of the line that is being walked: backwards from the seed, then forwards */
    size_t              count, capacity;
    lmn_error          *error;
} flow_maker;

void flow_lines_release(flow_lines *l)
{
    mem_free(l->points);
    mem_free(l->lines);
    memset(l, 0, sizeof *l);
}

static vec3 rounded(d3 v)
{
    return (vec3){(float)v.x, (float)v.y, (float)v.z};
}

static flow_sample sample_of(const flow_maker *m, const flow_position *p, d3 normal, uint32_t line, double arc)
{
    return (flow_sample){.at = rounded(p->at),
                         .normal = rounded(normal),
                         .direction = rounded(p->direction),
                         .arc = (float)arc,
                         .line = line,
                         .body = m->f->bodies[p->triangle]};
}

/* --- one line ------------------------------------------------------------------------------------------- */

typedef enum line_end { END_OTHER, END_EDGE, END_LOOP, END_MEMORY } line_end;

static bool add_point(flow_maker *m, const flow_position *p, d3 normal, double arc)
{
    if (!mem_grow((void **)&m->points, &m->capacity, m->count + 1, sizeof *m->points))
        return false;
    m->points[m->count++] =
        (flow_point){.at = rounded(p->at), .normal = rounded(normal), .arc = (float)arc, .triangle = p->triangle};
    return true;
}

/* Has a walk come round to where it began? */
static bool comes_round(const flow_maker *m, const flow_position *p, const flow_position *seed, double arc)
{
    d3     to = minus(seed->at, p->at);
    double reach = 0.5 * m->apart;
    return fabs(arc) > 4 * m->apart && dot(to, to) < reach * reach && dot(p->direction, seed->direction) > 0.8;
}

/* From where a walk comes round, over the surface to where it began. */
static line_end go_home(flow_maker *m, flow_position p, const flow_position *seed, double side, double *arc)
{
    for (int i = 0; i < STUCK; i++) {
        d3     to = minus(seed->at, p.at), n = flow_face_normal(m->f, p.triangle);
        double left = d3_length(to), gone;
        if (p.triangle == seed->triangle || left < 1e-3 * m->apart)
            break;
        p.direction = d3_unit(d3_along(to, n, -dot(to, n)));
        if (flow_straight(m->f, &p, left, &gone) != FLOW_ON)
            break;
        *arc += side * gone;
        if (gone > 0 && !add_point(m, &p, flow_normal(m->f, &p), *arc))
            return END_MEMORY;
    }
    return END_LOOP;
}

/* How far a walk may go on beyond where the line runs out; INFINITY: it has not come to that. `straight`: there the
 * field's arms change. */
typedef struct beyond_end {
    double left;
    bool   straight;
} beyond_end;

/* Where a walk went over a border of the field. */
typedef struct border_crossed {
    size_t points, samples;
    double arc;
} border_crossed;

/* A line that other lines stop soon after it went over a border ends at the border. */
static line_end end_between(flow_maker *m, const border_crossed *border, double *arc, uint32_t *beyond)
{
    if (fabs(*arc - border->arc) >= LEAST * m->apart)
        return END_OTHER;
    m->count = border->points;
    flow_grid_shorten(&m->grid, border->samples);
    *arc = border->arc;
    *beyond = 0;
    return END_EDGE;
}

/* One step of a walk. */
static flow_step step_on(const flow_maker *m, flow_position *p, beyond_end *b, double *gone)
{
    double length = fmin(STEP * m->apart, b->left);
    if (b->straight)
        return flow_straight(m->f, p, length, gone);
    flow_step step = flow_along(m->f, p, m->turn, length, gone);
    if (step != FLOW_TURNED)
        return step;
    b->straight = true;
    b->left = fmin(b->left, ACROSS * m->apart);
    return FLOW_ON;
}

/* Walks one way from the seed; `arc` counts upwards forwards and downwards backwards. */
static line_end walk(flow_maker *m, flow_position p, uint32_t line, double side, double stop, double *arc,
                     uint32_t *beyond)
{
    flow_position  seed = p;
    beyond_end     b = {.left = INFINITY};
    double         since = 0;
    border_crossed border = {.arc = INFINITY};
    int            stuck = 0;
    *arc = 0;
    *beyond = 0;
    p.over = false;
    if (side < 0)
        p.direction = (d3){-p.direction.x, -p.direction.y, -p.direction.z};
    seed.direction = p.direction;
    for (int i = 0; i < STEPS_MAX && stuck < STUCK && b.left > 0; i++) {
        bool      within = isfinite(b.left);
        double    gone;
        flow_step step = step_on(m, &p, &b, &gone);
        *arc += side * gone;
        since += gone;
        b.left -= gone;
        stuck = gone < 1e-4 * m->apart ? stuck + 1 : 0;
        if (gone > 0 && !add_point(m, &p, flow_normal(m->f, &p), *arc))
            return END_MEMORY;
        *beyond += within && gone > 0;
        if (p.over)
            border = (border_crossed){m->count, m->grid.count, *arc};
        p.over = false;
        if (step == FLOW_EDGE)
            return within ? end_between(m, &border, arc, beyond) : END_EDGE;
        if (since < (within ? 0.3 : 1) * STEP * m->apart)
            continue;
        since = 0;
        flow_sample s = sample_of(m, &p, flow_normal(m->f, &p), line, *arc);
        if (!within && comes_round(m, &p, &seed, *arc))
            return go_home(m, p, &seed, side, arc);
        if (!isfinite(b.left) && flow_grid_is_near(&m->grid, &s, stop * m->apart, 3 * m->apart))
            b.left = BEYOND * m->apart;
        if (isfinite(b.left) && flow_grid_is_near(&m->grid, &s, MEET * m->apart, 3 * m->apart))
            return end_between(m, &border, arc, beyond);
        if (!isfinite(b.left) && !flow_grid_add(&m->grid, &s))
            return END_MEMORY;
    }
    return end_between(m, &border, arc, beyond);
}

static void turn_around(flow_point *points, size_t count)
{
    for (size_t i = 0, k = count; i + 1 < k; i++, k--) {
        flow_point kept = points[i];
        points[i] = points[k - 1];
        points[k - 1] = kept;
    }
}

/* A level's lines come while the one before it is whole, and are all there before it ends. */
static float rank_of(flow_maker *m)
{
    double unit = random_unit(&m->random);
    return m->level == 0 ? 0 : (float)(m->level - 0.9 + FLOW_UNEVEN * unit);
}

/* Keeps what was walked as a line; false when memory is gone. */
static bool keep_line(flow_maker *m, double from, bool closed, const bool bounded[2], const uint32_t beyond[2])
{
    flow_lines *l = m->out;
    if (!mem_grow((void **)&l->lines, &l->line_capacity, l->line_count + 1, sizeof *l->lines) ||
        !mem_grow((void **)&l->points, &l->point_capacity, l->point_count + m->count + 1, sizeof *l->points))
        return false;
    flow_line *line = &l->lines[l->line_count++];
    *line = (flow_line){.first = (uint32_t)l->point_count,
                        .count = (uint32_t)m->count,
                        .level = (uint8_t)m->level,
                        .closed = closed,
                        .bounded = {bounded[0], bounded[1]},
                        .ends = {beyond[0], (uint32_t)m->count - 1 - beyond[1]},
                        .rank = rank_of(m)};
    for (size_t i = 0; i < m->count; i++) {
        m->points[i].arc -= (float)from;
        l->points[l->point_count++] = m->points[i];
    }
    return true;
}

static double length_within(const flow_maker *m, const uint32_t beyond[2])
{
    return m->count ? (double)m->points[m->count - 1 - beyond[1]].arc - (double)m->points[beyond[0]].arc : 0;
}

/* Walks both ways from a seed. A line that is too short is none, and leaves nothing in the grid: `free_end`: the least
 * of one that ends at others. */
static bool trace_line(flow_maker *m, const flow_position *seed, double free_end)
{
    size_t   samples = m->grid.count;
    uint32_t line = (uint32_t)m->out->line_count;
    double   stop = STOP + STOP_UNEVEN * random_signed(&m->random), back = 0, on = 0;
    uint32_t beyond[2] = {0, 0}; /* points */
    d3       normal = flow_normal(m->f, seed);
    m->count = 0;
    flow_sample s = sample_of(m, seed, normal, line, 0);
    if (!flow_grid_add(&m->grid, &s))
        return false;
    line_end first = walk(m, *seed, line, -1, stop, &back, &beyond[0]), second = END_LOOP;
    turn_around(m->points, m->count);
    if (first == END_MEMORY || !add_point(m, seed, normal, 0))
        return false;
    if (first == END_LOOP) {
        /* Ends where it begins. */
        m->points[0].at = m->points[m->count - 1].at;
        m->points[0].normal = m->points[m->count - 1].normal;
        m->points[0].triangle = seed->triangle;
    } else {
        second = walk(m, *seed, line, 1, stop, &on, &beyond[1]);
        if (second == END_MEMORY)
            return false;
    }
    bool   closed = first == END_LOOP, bounded[2] = {first == END_EDGE, second == END_EDGE};
    double across = (double)m->f->rooms[seed->triangle] < m->apart ? LEAST_NARROW : LEAST_BOUNDED;
    double length = length_within(m, beyond);
    double least = closed ? 2 : bounded[0] && bounded[1] ? across : free_end;
    if (m->count < 2 || length < least * m->apart) {
        flow_grid_shorten(&m->grid, samples);
        return true;
    }
    for (size_t i = samples; i < m->grid.count; i++) {
        m->grid.samples[i].arc -= (float)back;
        m->grid.samples[i].loop = closed ? (float)(on - back) : 0;
    }
    return keep_line(m, back, closed, bounded, beyond);
}

/* Goes straight on over the surface; *stuck: it got no farther. False where the surface ends before. */
static bool go_aside(const flow_maker *m, flow_position *p, double distance, bool *stuck)
{
    int short_steps = 0;
    for (double left = distance; left > 1e-6 * distance && short_steps < STUCK;) {
        double gone;
        if (flow_straight(m->f, p, left, &gone) != FLOW_ON)
            return false;
        left -= gone;
        short_steps = gone < 1e-4 * distance ? short_steps + 1 : 0;
    }
    *stuck = short_steps >= STUCK;
    return true;
}

/* Does the surface end nearer than this sideways? */
static bool ends_beside(const flow_maker *m, const flow_position *from, d3 aside, double distance)
{
    flow_position p = *from;
    bool          stuck;
    p.direction = aside;
    return !go_aside(m, &p, distance, &stuck);
}

/* Lines that hug an edge only make it thicker; between two edges there is no other place. */
static bool hugs_an_edge(const flow_maker *m, const flow_position *p)
{
    d3 left = d3_unit(cross(flow_face_normal(m->f, p->triangle), p->direction));
    return ends_beside(m, p, left, HUG * m->apart) !=
           ends_beside(m, p, (d3){-left.x, -left.y, -left.z}, HUG * m->apart);
}

/* The least length of a line that ends at others: where there is room for it, shorter ones are better than none, most
 * so in the set that has to draw tone alone. Whole strokes have a tone of their own, and short ones would be hair. */
static double least_at(const flow_maker *m, const flow_sample *s)
{
    bool hole = m->measures && !flow_grid_is_near(&m->grid, s, HOLE * m->apart, 0);
    if (hole)
        return m->crosses ? LEAST_LONELY : LEAST_IN_HOLE;
    bool lonely = m->measures && !m->crosses && !flow_grid_is_near(&m->grid, s, LONELY * m->apart, 0);
    return lonely ? LEAST_LONELY : LEAST;
}

/* A seed, if nothing is near. */
static bool try_seed(flow_maker *m, flow_position *p, d3 like)
{
    p->direction = like;
    flow_sample s = sample_of(m, p, flow_face_normal(m->f, p->triangle), UINT32_MAX, 0);
    if (flow_grid_is_near(&m->grid, &s, FREE * m->apart, 0) || !flow_direction(m->f, p, m->turn, like, &p->direction) ||
        hugs_an_edge(m, p))
        return true;
    return trace_line(m, p, least_at(m, &s));
}

/* --- gaps beside a line --------------------------------------------------------------------------------- */

/* From a position on a line, sideways over the surface. */
static bool seed_beside(flow_maker *m, const flow_position *from, d3 aside, double distance)
{
    flow_position p = *from;
    bool          stuck;
    p.direction = aside;
    return !go_aside(m, &p, distance, &stuck) || stuck || try_seed(m, &p, from->direction);
}

static flow_position position_on(const flow_lines *l, const flow_line *line, uint32_t i, d3 *normal)
{
    const flow_point *points = &l->points[line->first], *before = &points[i > 0 ? i - 1 : 0],
                     *after = &points[i + 1 < line->count ? i + 1 : i];
    *normal = of(points[i].normal);
    return (flow_position){of(points[i].at), d3_unit(minus(of(after->at), of(before->at))), points[i].triangle};
}

/* Is a point nearer than this to where a line runs out between others, or beyond it? */
static bool runs_out(const flow_lines *l, const flow_line *line, uint32_t i, double distance)
{
    const flow_point *p = &l->points[line->first];
    double            arc = (double)p[i].arc;
    return !line->closed && ((!line->bounded[0] && arc < distance + (double)p[line->ends[0]].arc) ||
                             (!line->bounded[1] && arc > (double)p[line->ends[1]].arc - distance));
}

/* Fills the gaps on both sides of a line. */
static bool fill_beside(flow_maker *m, uint32_t number)
{
    /* A short line has its say in the middle. */
    const flow_line *own = &m->out->lines[number];
    double           length = (double)m->out->points[own->first + own->count - 1].arc;
    double           since = length < 1.5 * m->apart ? 1.5 * m->apart - length / 2 : INFINITY;
    for (uint32_t i = 0; i < m->out->lines[number].count; i++) {
        const flow_line  *line = &m->out->lines[number];
        const flow_point *points = &m->out->points[line->first];
        since += i > 0 ? (double)points[i].arc - (double)points[i - 1].arc : 0;
        if (since < 1.5 * m->apart || runs_out(m->out, line, i, 0))
            continue;
        since = 0;
        d3            normal;
        flow_position p = position_on(m->out, line, i, &normal);
        flow_sample   s = sample_of(m, &p, normal, number, (double)points[i].arc);
        s.loop = line->closed ? points[line->count - 1].arc : 0;
        double gaps[2];
        flow_grid_gaps(&m->grid, &s, REACH * m->apart, gaps);
        d3 left = d3_unit(cross(flow_face_normal(m->f, p.triangle), p.direction));
        for (int side = 0; side < 2; side++) {
            double gap = gaps[side], lines = isfinite(gap) ? floor(gap / m->apart + 1 - (TWO_FROM - 1)) - 1 : 1;
            d3     aside = side ? (d3){-left.x, -left.y, -left.z} : left;
            if (isfinite(gap) && lines < 1)
                continue;
            if (!seed_beside(m, &p, aside, isfinite(gap) ? gap / (lines + 1) : m->apart))
                return false;
        }
        if (work_stopped())
            return false;
    }
    return true;
}

/* --- levels --------------------------------------------------------------------------------------------- */

/* Samples of the lines that there are, for the grid of a level, but for ends that run out. */
static bool add_samples(flow_maker *m, double without_ends)
{
    const flow_lines *l = m->out;
    for (uint32_t k = 0; k < l->line_count; k++) {
        const flow_line *line = &l->lines[k];
        double           next = 0;
        for (uint32_t i = 0; i < line->count; i++) {
            const flow_point *q = &l->points[line->first + i];
            d3                normal;
            if ((double)q->arc < next && i + 1 < line->count)
                continue;
            next = (double)q->arc + STEP * m->apart;
            if (runs_out(l, line, i, without_ends * m->apart))
                continue;
            flow_position p = position_on(l, line, i, &normal);
            flow_sample   s = sample_of(m, &p, normal, k, (double)q->arc);
            s.point = i;
            s.loop = line->closed ? l->points[line->first + line->count - 1].arc : 0;
            if (!flow_grid_add(&m->grid, &s))
                return false;
        }
    }
    return true;
}

/* What is not reached from other lines: seeds strewn over the surface. */
static bool fill_rest(flow_maker *m)
{
    const mark_surface *s = m->f->surface;
    double              area = mark_surface_area(s), wanted = area / (m->apart * m->apart), left = 0;
    for (uint32_t t = 0; t < s->triangle_count; t++) {
        const uint32_t *i = &s->indices[3 * (size_t)t];
        d3 a = of(s->positions[i[0]]), b = minus(of(s->positions[i[1]]), a), c = minus(of(s->positions[i[2]]), a);
        left += wanted * 0.5 * d3_length(cross(b, c)) / area;
        for (; left > 0; left -= 1) {
            double        u = random_unit(&m->random), v = random_unit(&m->random);
            bool          beyond = u + v > 1;
            flow_position p = {.triangle = t};
            size_t        before = m->out->line_count;
            p.at = d3_along(d3_along(a, b, beyond ? 1 - u : u), c, beyond ? 1 - v : v);
            if (!try_seed(m, &p, b))
                return false;
            for (size_t k = before; k < m->out->line_count; k++)
                if (!fill_beside(m, (uint32_t)k))
                    return false;
        }
        if (work_stopped() || m->out->point_count > FLOW_POINTS_MAX)
            return false;
    }
    return true;
}

/* How wide the strip of each sample is. */
typedef struct space_job {
    flow_maker *maker;
    int         level;
} space_job;

static void measure_spaces(size_t begin, size_t end, void *user)
{
    const space_job *job = user;
    flow_maker      *m = job->maker;
    for (size_t i = begin; i < end; i++) {
        const flow_sample *s = &m->grid.samples[i];
        flow_line         *line = &m->out->lines[s->line];
        int                after = m->level - line->level;
        double             gaps[2], space = 0;
        /* Every second one will do: what lies between is interpolated. */
        if (after >= FLOW_SPACES || (i & 1))
            continue;
        flow_grid_gaps(&m->grid, s, WIDEST * m->apart, gaps);
        for (int k = 0; k < 2; k++)
            space += 0.5 * (isfinite(gaps[k]) ? gaps[k] : m->apart);
        m->out->points[line->first + s->point].spaces[after] = (float)space;
    }
}

/* Lines swell and thin slowly: where a neighbour ends, its strip is taken over little by little. */
static void smooth_spaces(flow_point *p, uint32_t count, int after, double over)
{
    for (int way = 0; way < 2; way++)
        for (uint32_t k = 1; k < count; k++) {
            uint32_t i = way ? count - 1 - k : k, before = way ? i + 1 : i - 1;
            double   step = fabs((double)p[i].arc - (double)p[before].arc), own = 1 - exp(-step / over);
            p[i].spaces[after] =
                (float)(own * (double)p[i].spaces[after] + (1 - own) * (double)p[before].spaces[after]);
        }
}

/* Points between samples get what lies between these; and levels that do not come, half of the one before. */
static void spread_spaces(flow_lines *l)
{
    for (size_t k = 0; k < l->line_count; k++) {
        const flow_line *line = &l->lines[k];
        flow_point      *p = &l->points[line->first];
        double           usual = ldexp(l->apart, -line->level);
        for (int after = 0; after < FLOW_SPACES; after++) {
            bool     comes = line->level + after < l->levels;
            uint32_t last = UINT32_MAX;
            for (uint32_t i = 0; i < line->count && comes; i++) {
                if (!(p[i].spaces[after] > 0))
                    continue;
                for (uint32_t j = last == UINT32_MAX ? 0 : last + 1; j < i; j++) {
                    float run = last == UINT32_MAX ? 0 : p[i].arc - p[last].arc,
                          t = run > 0 ? (p[j].arc - p[last].arc) / run : 1;
                    p[j].spaces[after] = last == UINT32_MAX
                                             ? p[i].spaces[after]
                                             : p[last].spaces[after] + t * (p[i].spaces[after] - p[last].spaces[after]);
                }
                last = i;
            }
            for (uint32_t i = last == UINT32_MAX ? 0 : last + 1; i < line->count; i++)
                p[i].spaces[after] = last != UINT32_MAX && comes ? p[last].spaces[after]
                                     : after > 0                 ? p[i].spaces[after - 1] / 2
                                                                 : (float)usual;
            smooth_spaces(p, line->count, after, ldexp(l->apart, -line->level - after));
        }
    }
}

static bool make_level(flow_maker *m, size_t expected)
{
    size_t old = m->out->line_count;
    if (!flow_grid_open(&m->grid, m->apart, expected) || !add_samples(m, 0))
        return false;
    for (uint32_t k = 0; k < old; k++)
        if (!fill_beside(m, k))
            return false;
    /* Those that came fill what lies beside themselves. */
    for (uint32_t k = (uint32_t)old; k < m->out->line_count; k++)
        if (!fill_beside(m, k) || m->out->point_count > FLOW_POINTS_MAX)
            return false;
    if (!fill_rest(m))
        return false;
    if (!m->measures)
        return true;
    if (!flow_grid_open(&m->grid, m->apart, expected) || !add_samples(m, FADED))
        return false;
    space_job job = {m, m->level};
    threads_for(m->grid.count, 4096, measure_spaces, &job);
    return !work_stopped();
}

lmn_status flow_lines_make(flow_lines *out, const flow_surface *f, const flow_options *w, int set, lmn_error *error)
{
    memset(out, 0, sizeof *out);
    out->apart = ldexp(w->apart, w->levels - 1);
    out->levels = w->levels;
    flow_maker m = {.out = out,
                    .f = f,
                    .turn = set * (double)w->turn,
                    .measures = !w->whole,
                    .crosses = set > 0,
                    .random = random_start(w->seed + (uint32_t)set * 7919u, 0xF10E)};
    double     area = mark_surface_area(f->surface);
    bool       done = area > 0;
    for (m.level = 0; m.level < w->levels && done; m.level++) {
        m.apart = ldexp(out->apart, -m.level);
        done = make_level(&m, (size_t)fmin(area / (m.apart * m.apart * STEP), 1e8));
    }
    flow_grid_release(&m.grid);
    mem_free(m.points);
    spread_spaces(out);
    if (out->point_count > FLOW_POINTS_MAX)
        return error_set(error, LMN_LIMIT, "lines that follow this surface have more than %d points", FLOW_POINTS_MAX);
    return done || !(area > 0) ? LMN_OK : error_memory(error);
}
