/* Exact values of what a behaviour drives, in double precision, at any time and in any order; the scene stays as it
 * is. */
#ifndef LIMNER_BEHAVIOUR_EVALUATE_H
#define LIMNER_BEHAVIOUR_EVALUATE_H

#include "behaviour/schedule.h"
#include "behaviour/trajectory.h"

/* The span that drives a property; NONE: it rests. */
int32_t schedule_driver(const schedule *s, const behaviour_property *p, double seconds, time_side side);
/* The value of a property, `components` numbers; rotations are unit. */
void schedule_value(const schedule *s, const behaviour_property *p, double seconds, time_side side, double *out);
/* The value that one span gives, whoever drives. */
void schedule_span_value(const schedule *s, const behaviour_span *span, double seconds, double *out);
/* What a property is at rest. */
void schedule_rest(const lmn_scene *scene, animation_path path, int32_t target, double *out);

/* A node's own matrix, and where it is in the world. */
mat4 schedule_local(const schedule *s, int32_t node_index, double seconds, time_side side);
mat4 schedule_world(const schedule *s, int32_t node_index, double seconds, time_side side);

/* The times in begin … end at which what drives the property changes, or its map has a corner, in order and each once.
 * Appends to an array that mem_grow grows. False when memory is gone. */
bool schedule_breaks(const schedule *s, const behaviour_property *p, double begin, double end, double **times,
                     size_t *count, size_t *capacity);

/* Does nothing follow itself? Errors: LMN_FORMAT, LMN_MEMORY. */
lmn_status schedule_check_followers(const schedule *s, lmn_error *error);

#endif
