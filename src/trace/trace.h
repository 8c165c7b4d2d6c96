/* What moved where, and the lines that tell it: speed lines and contours of the past, as ribbons on the page. Needs no
 * GPU. The way of a position is where the poses of earlier times put it; all lines come from these. Großmann 2011,
 * sections 3.3.2 and 3.3.3, after Masuch, Schlechtweg and Schulz 1999, Hanl and Schmid; rows 15, 16, 19, 23 to 25, 28
 * to 33. */
#ifndef LIMNER_TRACE_TRACE_H
#define LIMNER_TRACE_TRACE_H

#include <jansson.h>

#include "base/warnings.h"
#include "plan/plan.h"
#include "motion/traces.h"
#include "pose/pose.h"
#include "stroke/ribbon.h"
#include "trace/telling.h"

/* The requirements of speed lines, measured on what was drawn (Großmann 2011, section 3.3.3.1, after Schulz). */
typedef struct trace_measures {
    double extent;  /* A1: how far the outermost lines begin from the extremes of what moves and has not all of itself
                       behind these, units, at most */
    double salient; /* A2: share of lines that begin on its outline */
    size_t lines;   /* A3 */
    double uneven;  /* A4: deviation of the gaps between lines, fraction of their mean */
    double crowded; /* A5: most lines on a fifth of the extent, as a multiple of the mean */
    double inside;  /* A6: length of lines that lies on what moves, units */
    double length;  /* A7: mean length, fraction of the line's own way during the exposure */
} trace_measures;

/* What was drawn. */
typedef struct trace_facts {
    size_t          bodies;   /* that move on the page */
    size_t          towards;  /* of these, how many come nearer or go away rather than pass: their lines are rays */
    size_t          jumps;    /* ways that were cut where something jumps */
    size_t          leaps;    /* things that jump just now */
    size_t          contours; /* times at which contours were drawn */
    size_t          shaking;  /* bodies that swing to and fro within the exposure */
    bool            shakes_wanted;
    bool            bones_missing; /* figures are of bones, and none is called as was asked for */
    bool            lines_missing; /* lines were asked for, and none is seen */
    trace_measures  measures;
    telling_moments telling; /* those that were chosen; wanted 0 and none: nobody asked */
} trace_facts;

typedef struct traces_options {
    const pose          *pose;   /* now */
    const bool          *parts;  /* per part: what draws traces */
    const traces_values *values; /* lengths in units of the page */
    stroke_camera        camera;
    const stroke_view   *seen;    /* what may hide them */
    stroke_section       section; /* of what it cuts away nothing is drawn; cut NULL: nothing is */
    double               crease_angle;
    uint32_t             seed;
    colour               ink;
    int32_t              brush; /* stroke_brush */
} traces_options;

/* The rule's traces, lengths in pixels; NULL: it draws none. */
const traces_values *traces_of_rule(const rule *r);
/* The same with other lengths, as for units of the page. */
void traces_scale(traces_values *v, double factor);
/* Sets ink and brush: those of the rule's lines, unless its traces have a colour of their own. */
void traces_take_lines(traces_options *options, const rule *r);

/* Makes ribbons of classes STROKE_SPEED and STROKE_PAST, oldest first; none where nothing moves. Where something moves
 * along the line of sight, lines are rays from the middle of what moves. The same options, the same ribbons. Errors:
 * LMN_MEMORY, LMN_FORMAT, LMN_CANCELLED. */
lmn_status traces_make(ribbon_set *out, trace_facts *facts, const traces_options *options, lmn_error *error);

/* For reports: {"bodies", "contours", "A1" … "A7"}. */
json_t *trace_facts_json(const trace_facts *facts);
/* Says what traces could not tell: nothing moves, something comes towards the viewer, something jumps. */
void trace_warn(const trace_facts *facts, warnings *warnings);

/* Of several figures together: counts add up, of measures the worse one counts. */
void trace_facts_add(trace_facts *all, const trace_facts *one);

#endif
