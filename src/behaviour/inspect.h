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

/* Where a point of a node is, how fast and how it speeds up; `before` and behind a forced time there is a sample each,
 * so that corners stay corners. */
typedef struct trajectory_sample {
    double seconds, position[3], velocity[3], acceleration[3];
    bool   forced; /* a lifetime or a piece of a map begins or ends here */
} trajectory_sample;

typedef struct trajectory {
    trajectory_sample *samples; /* times do not decrease */
    size_t             count, capacity;
} trajectory;

/* Samples a point, in the node's axes (NULL: its origin), so closely that straight lines between samples are nowhere
 * farther than `tolerance` from it, and each turns by at most a tenth of a full turn. Errors: LMN_MEMORY, LMN_LIMIT,
 * LMN_CANCELLED. Release it also after one. */
lmn_status trajectory_create(trajectory *out, const schedule *s, int32_t node_index, const double point[3], double from,
                             double to, double tolerance, lmn_error *error);
void       trajectory_release(trajectory *t);

/* An impact: an instant at which a node's velocity jumps while its place does not. The normal is the way that it is
 * pushed, the speed how much its velocity changes (the impulse of a unit mass), the place its outermost vertex against
 * the normal, or its origin where it and all below it have no mesh. Read from the motion alone: what it hits need not
 * be in the scene. */
typedef struct impact {
    double seconds, place[3], normal[3], speed;
} impact;

/* Those of a node in from … to with a speed of `least` or more, in order; free *out with mem_free. Errors: as of
 * trajectory_create. */
lmn_status impacts_find(impact **out, size_t *count, const schedule *s, int32_t node_index, double from, double to,
                        double least, lmn_error *error);

/* What a node is: its attribute "semantics", or a guess from what it has and what it is called: "camera", "light",
 * "character", "vehicle", "plane", "door", "ball", "ground" …; NULL: nobody knows. */
const char *semantics_of(const lmn_scene *scene, int32_t node_index);

#endif
