/* What is known of a node's dynamics: Nienhaus 2005, section 7.4. Nothing here runs or changes the scene. */
#ifndef LIMNER_BEHAVIOUR_INSPECT_H
#define LIMNER_BEHAVIOUR_INSPECT_H

#include "behaviour/evaluate.h"

/* D of a node and an interval: P, the nodes from the root to it, whose properties may move it, and C, the spans that
 * drive one of these within the interval, with the events that happen to one of them. */
typedef struct dynamics {
    int32_t *path;
    size_t   path_count;
    size_t  *spans; /* indices, in the order of the graph */
    size_t   span_count;
} dynamics;

/* From −INFINITY to INFINITY it is C(node), from t to t C_t(node). Errors: LMN_MEMORY. Release it also after one. */
lmn_status dynamics_create(dynamics *out, const schedule *s, int32_t node_index, double from, double to,
                           lmn_error *error);
void       dynamics_release(dynamics *d);
/* Does the span share an instant with the closed interval? Ends that others own count only by themselves. */
bool span_meets(const behaviour_span *span, double from, double to);

/* Where a point of a node, in the node's axes (NULL: its origin), goes, with its corners. Errors: as of
 * trajectory_create. Release it also after one. */
lmn_status schedule_trajectory(trajectory *out, const schedule *s, int32_t node_index, const double point[3],
                               double from, double to, double tolerance, lmn_error *error);
/* Where it is at one time, how fast and how it speeds up; at a break what lies on that side of it (SIDE_AT: behind it,
 * at the end of all before it). Errors: LMN_MEMORY. */
lmn_status schedule_point_at(trajectory_sample *out, const schedule *s, int32_t node_index, const double point[3],
                             double seconds, time_side side, lmn_error *error);

/* An impact: an instant at which a node's velocity jumps while its place does not. The normal is the way that it is
 * pushed, the speed how much its velocity changes (the impulse of a unit mass), the place that of the point. Read from
 * the motion alone: what it hits need not be in the scene (contact/contact.h looks for it). */
typedef struct impact {
    double seconds, place[3], normal[3], speed;
    double before[3], after[3]; /* its velocity */
    bool   sets_off, stops;     /* was it at rest before, is it behind */
    double since, until;        /* how long it has moved smoothly before, and does behind */
    bool   thrown_back;         /* it turns back from a plane to which the same pull draws it before and behind */
} impact;

/* Those of a node's point (in its axes; NULL: its origin) in from … to with a speed of `least` or more, in order; free
 * *out with mem_free. Errors: as of schedule_trajectory. */
lmn_status impacts_find(impact **out, size_t *count, const schedule *s, int32_t node_index, const double point[3],
                        double from, double to, double least, lmn_error *error);

/* What a node is: its attribute "semantics", or a guess from what it has and what it is called: "camera", "light",
 * "character", "vehicle", "plane", "door", "ball", "ground" …; NULL: nobody knows. */
const char *semantics_of(const lmn_scene *scene, int32_t node_index);

#endif
