/* Dashes lie along whole chains, fitted so that these begin and end with ink; where a stretch of a chain begins or
 * ends elsewhere, ink is added there, so that dashes meet corners and what hides them. So dashes stay where they
 * are on the model while what hides them moves. */
#include <math.h>

#include "stroke/ribbon_private.h"

/* Dashes that are all gap or cannot be told apart. */
static const float shortest_period = 0.5f;
/* Gaps shorter than this fraction of a whole one are closed. */
static const float least_gap = 0.5f;
/* Dashes of one stroke; a line that had more would be longer than any page. */
static const float dashes_most = 1e6f;

typedef struct dash_pattern {
    float dash, gap, begin; /* arc at which a dash begins */
} dash_pattern;

/* Stretches the pattern so that a whole number of dashes fits. */
static dash_pattern fit_pattern(const chain_facts *chain, float dash, float gap, float phase)
{
    dash_pattern p = {dash, gap, -phase};
    float        length = chain->length, used = chain->closed ? length : length + gap;
    float        count = fmaxf(roundf(used / (dash + gap)), 1);
    /* An open chain that was not followed from an earlier frame begins and ends with ink. */
    float natural = count * (dash + gap) - (chain->closed ? 0 : gap);
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

void ribbon_dash(span_list *out, const ribbon_job *job, const stroke *s, const chain_facts *chain, float from, float to)
{
    const stroke_style *style = job->style;
    bool                hidden = s->hidden_by > 0;
    float               dash = hidden ? style->hidden == HIDDEN_DASHED ? style->hidden_dash : 0 : style->dash;
    float               gap = hidden ? style->hidden_gap : style->gap;
    bool                plain =
        !(dash > 0) || !(gap > 0) || !(dash + gap >= shortest_period) || !isfinite(dash + gap) || !isfinite(s->phase);
    out->count = 0;
    if (plain || to - from <= dash + gap * least_gap || !((to - from) / (dash + gap) < dashes_most)) {
        add_ink(out, from, to, 0);
        return;
    }
    dash_pattern p = fit_pattern(chain, dash, gap, s->phase);
    float        period = p.dash + p.gap, least = p.gap * least_gap, end = p.dash / 2;
    /* Where a closed chain begins and ends nothing does. */
    if (!chain->closed || from > 0)
        add_ink(out, from, from + end, least);
    for (double k = floor((from - p.begin) / period); p.begin + k * period < to - end; k++) {
        double begin = p.begin + k * period, stop = begin + p.dash;
        add_ink(out, fmaxf((float)begin, from), fminf((float)stop, to), least);
    }
    if (!chain->closed || to < chain->length)
        add_ink(out, to - end, to, least);
}
