/* What a look's rule says of traces. */
#include <math.h>

#include "lines/stroke/strokes.h"
#include "trace/trace.h"

const traces_values *traces_of_rule(const rule *r)
{
    const technique_use *use = rule_use(r, KIND_MOTION);
    return use && use->technique->motion->traces ? use->values : NULL;
}

void traces_take_lines(traces_options *options, const rule *r)
{
    const traces_values *v = traces_of_rule(r);
    const technique_use *lines = rule_use(r, KIND_LINES);
    options->ink = (colour){0.09f, 0.10f, 0.12f, 1};
    options->brush = BRUSH_PEN;
    if (lines)
        options->ink = ((const lines_common *)lines->values)->colour;
    if (v && !isnan(v->colour.r))
        options->ink = v->colour;
    for (size_t i = 0; i < r->use_counts[KIND_LINES]; i++)
        if (technique_draws_strokes(r->uses[KIND_LINES][i].technique))
            options->brush = ((const strokes_values *)r->uses[KIND_LINES][i].values)->style.brush;
}

void traces_scale(traces_values *v, double factor)
{
    params_scale_lengths(motion_traces.params, motion_traces.param_count, v, factor);
}
