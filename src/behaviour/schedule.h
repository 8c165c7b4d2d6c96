/* A behaviour laid out in time, without running it: which constraint is alive when, and which time of its own it has
 * then. Nienhaus 2005, sections 7.3 and 7.4. */
#ifndef LIMNER_BEHAVIOUR_SCHEDULE_H
#define LIMNER_BEHAVIOUR_SCHEDULE_H

#include "scene/behaviour.h"

/* Beyond these a graph is refused with LMN_LIMIT: sharing and repeats can multiply without bound. */
enum { BEHAVIOUR_DEPTH_MAX = 256, BEHAVIOUR_SPANS_MAX = 1000000, BEHAVIOUR_STEPS_MAX = 4000000 };
enum { BEHAVIOUR_TIMES_MAX = 1000000, BEHAVIOUR_SECONDS_MAX = 1000000000 };

/* --- check.c: one way for scripts and calls ---------------------------------------------------------------- */

/* Is an activity in order by itself, whatever it is part of? Whoever makes one asks, and all that is laid out is asked
 * again, since scenes change. Errors, which name it and its line: LMN_FORMAT. */
lmn_status behaviour_check(const lmn_scene *scene, const struct behaviour *graph, int32_t index, lmn_error *error);
/* Why a duration or a start that somebody gives is none, or NULL. */
const char *behaviour_duration_fault(double seconds);
const char *behaviour_start_fault(double seconds);
/* "sequence 'walk'", and the line in the error. */
lmn_status behaviour_refuse(const behaviour_node *n, size_t index, lmn_status status, lmn_error *error,
                            const char *format, ...) __attribute__((format(printf, 5, 6)));

/* --- schedule.c -------------------------------------------------------------------------------------------- */

/* One step from global time towards local time: offset + scale · t, and then of a creep length · (t/length)^exponent.
 */
typedef struct time_step {
    double scale, offset, length, exponent; /* exponent 1: no creep */
} time_step;

/* One lifetime of a constraint, of a clip's channel or of an event, whose two ends are one. A constraint that is
 * repeated or that several groups share has several. */
typedef struct behaviour_span {
    int32_t node;    /* of the graph */
    int32_t channel; /* of a clip's animation; else NONE */
    double  from, to;
    bool    open_from, open_to; /* does another one own that instant? */
    double  length;             /* of its own time, which runs from 0 to here, or back */
    size_t  step, step_count;   /* of `steps` */
    int32_t property;           /* NONE of events */
} behaviour_span;

/* A property that something drives, and which span does at which time: slot 0 is before times[0], slot 2i + 1 at
 * times[i], slot 2i + 2 between it and the next. Of spans that are alive together the later one of the graph drives;
 * when none is, the last one's end stays; before all of them NONE, which is the rest value. */
typedef struct behaviour_property {
    animation_path path;
    int32_t        target;
    size_t         components;
    size_t         first_span, span_count; /* of `of_property`, in the order of the graph */
    double        *times;
    size_t         time_count;
    int32_t       *drivers; /* 2 · time_count + 1 */
} behaviour_property;

/* The lengths along a curve, for those that time follows by length. */
typedef struct curve_table {
    double *lengths; /* at equal steps of the parameter; NULL: not needed */
    size_t  count;
} curve_table;

typedef struct schedule {
    const lmn_scene      *scene;
    const behaviour_node *nodes; /* the scene's, or of its clips */
    size_t                node_count;
    struct behaviour     *own;   /* what stands for a graph where clips are all there is; NULL */
    behaviour_span       *spans; /* in the order of the graph */
    size_t                span_count, span_capacity;
    time_step            *steps;
    size_t                step_count, step_capacity;
    behaviour_property   *properties; /* by thing, target and path */
    size_t                property_count;
    size_t               *of_property; /* indices of spans */
    curve_table          *curves;      /* per node of the graph */
    double                duration;    /* of the longest root */
} schedule;

/* Lays out the scene's behaviour. The scene is lent and must not change meanwhile. Errors, which name the activity and
 * its line: LMN_FORMAT (a cycle, an activity without duration, an unknown target …), LMN_LIMIT, LMN_MEMORY. Release it
 * also after one. */
lmn_status schedule_create(schedule *out, const lmn_scene *scene, lmn_error *error);
/* The same of animations that run together from 0 on: each channel is a constraint that lives from 0, since its
 * first value holds before its first key, to its last key. */
lmn_status schedule_of_clips(schedule *out, const lmn_scene *scene, const uint32_t *clips, size_t count,
                             lmn_error *error);
void       schedule_release(schedule *s);

/* What a node needs, in seconds, per node of the graph; and how deep the graph is below each. */
typedef struct requirement {
    double   own, needed; /* without and with a duration that is given */
    uint32_t height, state;
    uint64_t leaves;
} requirement;
/* Errors as above; free *out with mem_free. */
lmn_status behaviour_requirements(requirement **out, const lmn_scene *scene, const struct behaviour *b,
                                  lmn_error *error);

/* Is the span alive at a time? Events are at their instant. */
bool span_is_alive(const behaviour_span *s, double seconds);
/* Its own time at a global one, 0 … length; and back. */
double span_local(const schedule *s, const behaviour_span *span, double seconds);
double span_global(const schedule *s, const behaviour_span *span, double local);
/* What a span drives: a constraint's property or a clip's channel. */
const animation_channel *span_channel(const schedule *s, const behaviour_span *span);

/* NONE when nothing drives it. */
int32_t schedule_property(const schedule *s, animation_path path, int32_t target);

/* Inside this folder: fills in properties and their slots once spans are there. Errors: LMN_MEMORY. */
lmn_status schedule_find_drivers(schedule *s, lmn_error *error);
#endif
