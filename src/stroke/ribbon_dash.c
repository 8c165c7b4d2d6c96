/* Dashes lie along whole chains from corner to corner, fitted so that each such section begins and ends with ink; where
 * a stretch of a chain begins or ends elsewhere, ink is added there, so that dashes meet corners and what hides them.
 * So dashes stay where they are on the model while what hides them moves. A dash is at least twice as long as the line
 * is wide, else it would be a dot; what is too short for two of them is solid. */
#include <math.h>

#include "base/memory.h"
#include "stroke/ribbon_hidden.h"

static const float dash_least = 2; /* widths */
/* A corner turns by more than 30° within half a millimetre; corners nearer than that are one. */
static const float corner_cosine = 0.866f, corner_reach = 0.95f;

/* Dashes that are all gap or cannot be told apart. */
static const float shortest_period = 0.5f;
/* Gaps shorter than this fraction of a whole one are closed. */
static const float least_gap = 0.5f;
/* Dashes of one stroke; a line that had more would be longer than any page. */
static const float dashes_most = 1e6f;

typedef struct dash_pattern {
    float dash, gap, begin; /* arc at which a dash begins */
} dash_pattern;

/* --- corners -------------------------------------------------------------------------------------------- */

/* The direction from a point to what lies `reach` away along the stroke, on one side of it. */
static bool direction_from(const stroke_point *points, uint32_t count, uint32_t at, int step, float reach, float out[2])
{
    uint32_t i = at;
    float    x = 0, y = 0;
    while ((step > 0 ? i + 1 < count : i > 0) && hypotf(x, y) < reach) {
        i += (uint32_t)step;
        x = points[i].x - points[at].x;
        y = points[i].y - points[at].y;
    }
    float length = hypotf(x, y);
    out[0] = length > 0 ? x / length : 0;
    out[1] = length > 0 ? y / length : 0;
    return length >= 0.5f * reach;
}

float ribbon_turn(const stroke_point *points, uint32_t count, uint32_t at, float reach)
{
    float back[2], ahead[2];
    if (!direction_from(points, count, at, -1, reach, back) || !direction_from(points, count, at, 1, reach, ahead))
        return 1;
    return -(back[0] * ahead[0] + back[1] * ahead[1]);
}

static bool is_corner(const stroke_point *points, uint32_t count, uint32_t at, float reach)
{
    return ribbon_turn(points, count, at, reach) < corner_cosine;
}

static bool add_corner(ribbon_job *job, chain_facts *chain, float arc)
{
    float reach = corner_reach;
    if (chain->corner_count && arc - job->corners[job->corner_count - 1] < 2 * reach)
        return true;
    if (!mem_grow((void **)&job->corners, &job->corner_capacity, job->corner_count + 1, sizeof *job->corners))
        return false;
    job->corners[job->corner_count++] = arc;
    chain->corner_count++;
    return true;
}

bool ribbon_find_corners(ribbon_job *job)
{
    const stroke_style *style = job->style;
    if (!(style->dash > 0) && style->hidden != HIDDEN_DASHED)
        return true;
    for (size_t c = 0; c < job->chain_count; c++) {
        chain_facts *chain = &job->chains[c];
        chain->first_corner = job->corner_count;
        for (uint32_t i = chain->first; i < chain->first + chain->count; i++) {
            const stroke       *s = &job->strokes->strokes[i];
            const stroke_point *p = &job->strokes->points[s->first];
            for (uint32_t k = 1; k + 1 < s->count; k++)
                if (is_corner(p, s->count, k, corner_reach) && !add_corner(job, chain, p[k].arc))
                    return false;
        }
    }
    return true;
}

/* --- patterns ------------------------------------------------------------------------------------------- */

/* Between two corners, or all along a chain that has none. */
typedef struct section {
    float from, to;
    bool  closed;
} section;

/* Stretches the pattern so that a whole number of dashes fits. */
static dash_pattern fit_pattern(section all, float dash, float gap, float phase)
{
    dash_pattern p = {dash, gap, all.from - phase};
    float        length = all.to - all.from, used = all.closed ? length : length + gap;
    float        count = fmaxf(roundf(used / (dash + gap)), 1);
    /* An open chain that was not followed from an earlier frame begins and ends with ink. */
    float natural = count * (dash + gap) - (all.closed ? 0 : gap);
    float stretch = natural > 0 ? length / natural : 1;
    p.dash *= stretch;
    p.gap *= stretch;
    return p;
}

/* Adds ink; what is nearer than the least gap to the ink before is joined with it. */
static void add_ink(span_list *out, float from, float to, float least)
{
    if (!(to > from))
        return;
    if (out->count && from - out->items[out->count - 1].to < least)
        out->items[out->count - 1].to = fmaxf(out->items[out->count - 1].to, to);
    else
        span_list_add(out, from, to);
}

/* The dashes of what lies between `from` and `to` of one section. */
static void dash_section(span_list *out, section all, float from, float to, const dash_pattern *wanted, float phase,
                         float shortest)
{
    dash_pattern p = fit_pattern(all, wanted->dash, wanted->gap, phase);
    float        period = p.dash + p.gap, least = p.gap * least_gap, end = fmaxf(p.dash / 2, shortest);
    if (to - from <= 2 * end + least) {
        add_ink(out, from, to, least);
        return;
    }
    /* Where a closed chain begins and ends nothing does. */
    if (!all.closed || from > all.from)
        add_ink(out, from, from + end, least);
    for (double k = floor((from - p.begin) / period); p.begin + k * period < to - end; k++) {
        double begin = p.begin + k * period, stop = begin + p.dash;
        add_ink(out, fmaxf((float)begin, from), fminf((float)stop, to), least);
    }
    if (!all.closed || to < all.to)
        add_ink(out, to - end, to, least);
}

static float wanted_dash(const stroke_style *style, const stroke *s)
{
    return s->hidden_by == 0 ? style->dash : style->hidden == HIDDEN_DASHED ? style->hidden_dash : 0;
}

float ribbon_dash_length(const ribbon_job *job, const stroke *s)
{
    return fmaxf(wanted_dash(job->style, s), dash_least * ribbon_width(job, s));
}

void ribbon_dash(span_list *out, const ribbon_job *job, const stroke *s, const chain_facts *chain, float from, float to)
{
    const stroke_style *style = job->style;
    bool                hidden = s->hidden_by > 0;
    float               dash = wanted_dash(style, s);
    float               gap = hidden ? style->hidden_gap : style->gap, shortest = dash_least * ribbon_width(job, s);
    bool                plain =
        !(dash > 0) || !(gap > 0) || !(dash + gap >= shortest_period) || !isfinite(dash + gap) || !isfinite(s->phase);
    out->count = 0;
    dash = ribbon_dash_length(job, s);
    if (hidden && !plain) { /* one pattern for all that is hidden in a row; the caller takes this stroke's of it */
        span run = ribbon_hidden_run(job, (size_t)(s - job->strokes->strokes));
        from = run.from;
        to = run.to;
    }
    if (plain || to - from <= dash + gap * least_gap || !((to - from) / (dash + gap) < dashes_most)) {
        add_ink(out, from, to, 0);
        return;
    }
    const dash_pattern wanted = {dash, gap, 0};
    const float       *corners = job->corners ? job->corners + chain->first_corner : NULL;
    section            all = {0, chain->length, chain->closed};
    if (!chain->corner_count)
        dash_section(out, all, from, to, &wanted, s->phase, shortest);
    /* Corners stay on the model, and what lies between them with them. */
    for (size_t i = 0; i <= chain->corner_count && chain->corner_count; i++) {
        all = (section){i ? corners[i - 1] : 0, i < chain->corner_count ? corners[i] : chain->length, false};
        if (all.to > from && all.from < to)
            dash_section(out, all, fmaxf(from, all.from), fminf(to, all.to), &wanted, 0, shortest);
    }
}
