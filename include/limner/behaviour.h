/* What happens in a scene, made by a program: activities, which last, and events, which do not, in groups that say how
 * they follow one another, with modifiers that rewrite their time and constraints that tie a map of time to a property
 * of a node. Nienhaus 2005, section 7.3. Scripts (docs/SCRIPTS.md) make the same graphs, and go through the same
 * checks.
 *
 * Activities have numbers from 1 on, in the scene; 0 is none. A group names those that are there already, as many times
 * as it likes: each is then one more lifetime. Once lmn_behaviour_play has said which begin at 0, the scene has an
 * animation called "behaviour", which all that plays animations plays (where no clip is named it plays instead of those
 * of files that move the same nodes); when an activity that plays is changed, it is written anew at once.
 *
 * Times are in seconds, 0 … 1e9; lengths in the scene's unit, angles in degrees, rotations unit quaternions x y z w,
 * colours sRGB; all numbers finite and within ±1e18. Arrays and texts are copied during the call. On any error the
 * scene is unchanged. Every function can fail with LMN_USAGE (a NULL, a number that is not there, a
 * value that is not finite or not in its range, an activity that contains itself, has nothing in it or lasts no time;
 * the message names it), LMN_LIMIT (more than 256 levels, a million lifetimes, four million keys), LMN_MEMORY and
 * LMN_CANCELLED. A scene is changed by one thread at a time and never while it is drawn; different scenes by different
 * threads. No GL context needed. All since 0.1. */
#ifndef LIMNER_BEHAVIOUR_H
#define LIMNER_BEHAVIOUR_H

#include "limner/scene.h"

#ifdef __cplusplus
extern "C" {
#endif

/* --- activities ------------------------------------------------------------------------------------------ */

typedef enum lmn_activity_kind {
    LMN_ACTIVITY_SEQUENCE = 0, /* one child after the other; needs their sum */
    LMN_ACTIVITY_SIMULTANEITY, /* all at once; needs the longest */
    LMN_ACTIVITY_TABLE,        /* each at its own start; needs up to the last end */
    LMN_ACTIVITY_REVERSE,      /* its one child from the end to the begin */
    LMN_ACTIVITY_REPEAT,       /* its one child `times` times */
    LMN_ACTIVITY_CREEP,        /* its one child slow at first, fast at last: of time τ, 0 … 1, it sees τ^exponent */
    LMN_ACTIVITY_CONSTRAINT,   /* made by lmn_behaviour_add_constraint */
    LMN_ACTIVITY_CLIP,         /* an animation of the scene */
    LMN_ACTIVITY_EVENT         /* something happens, without duration */
} lmn_activity_kind;

/* What a simultaneity does with children that need less time than it has; with LMN_FIT_SHRINK it needs as much as the
 * shortest that lasts, and all others are sped up to that. */
typedef enum lmn_activity_fit {
    LMN_FIT_START = 0,
    LMN_FIT_CENTRE,
    LMN_FIT_END,
    LMN_FIT_STRETCH,
    LMN_FIT_SHRINK
} lmn_activity_fit;

typedef struct lmn_activity_child {
    uint32_t activity;
    double start_s, duration_s; /* in tables alone; a duration of 0: what it needs. Those that drive one property at one
                                   time may overlap: the later one in the graph wins */
} lmn_activity_child;

/* A group, modifier, clip or event. Initialise with LMN_ACTIVITY_DESC_INIT. */
typedef struct lmn_activity_desc {
    size_t                    struct_size;
    lmn_activity_kind         kind;       /* all but LMN_ACTIVITY_CONSTRAINT */
    const char               *name;       /* for messages, and what happens at an event; NULL: none */
    double                    duration_s; /* what is in it is sped up or slowed down to this; 0: what it needs */
    const lmn_activity_child *children;   /* of groups one or more, of modifiers one */
    size_t                    child_count;
    lmn_activity_fit          fit;      /* of a simultaneity */
    uint32_t                  times;    /* of a repeat, 1 … 1e6 */
    double                    exponent; /* of a creep, 1 … 64 */
    const char               *clip;     /* of a clip: its name, or a number from 1 on */
    uint32_t                  node;     /* of an event: whom it happens to; 0: nobody in particular */
} lmn_activity_desc;
#define LMN_ACTIVITY_DESC_INIT                                                                                         \
    {                                                                                                                  \
        sizeof(lmn_activity_desc), LMN_ACTIVITY_SEQUENCE, NULL, 0, NULL, 0, LMN_FIT_START, 1, 2, NULL, 0               \
    }

/* Adds an activity; nothing plays yet. *activity (may be NULL) gets its number. */
LMN_API lmn_status lmn_behaviour_add(lmn_scene *scene, const lmn_activity_desc *desc, uint32_t *activity,
                                     lmn_error *error);

/* Exchanges all of an activity, whatever it was. */
LMN_API lmn_status lmn_behaviour_set(lmn_scene *scene, uint32_t activity, const lmn_activity_desc *desc,
                                     lmn_error *error);

/* --- constraints ------------------------------------------------------------------------------------------ */

/* A property of a node, or of the camera or the light that it has, and the numbers of a value. */
typedef enum lmn_property {
    LMN_PROPERTY_TRANSLATION = 0,    /* 3 */
    LMN_PROPERTY_ROTATION,           /* 4, or 1 about an axis */
    LMN_PROPERTY_SCALE,              /* 3 */
    LMN_PROPERTY_WEIGHTS,            /* of morph targets, as many as the mesh has */
    LMN_PROPERTY_CAMERA_FOV,         /* 1, vertical, degrees */
    LMN_PROPERTY_CAMERA_HALF_HEIGHT, /* 1 */
    LMN_PROPERTY_LIGHT_COLOUR,       /* 3 */
    LMN_PROPERTY_LIGHT_INTENSITY     /* 1 */
} lmn_property;

/* Maps of time to values. */
typedef enum lmn_time_map {
    LMN_TIME_MAP_CONSTANT = 0, /* values: one */
    LMN_TIME_MAP_LINEAR,       /* values, straight from one to the next, rotations by slerp; evenly or at `times_s` */
    LMN_TIME_MAP_CURVE,        /* values: points of a curve */
    LMN_TIME_MAP_TANGENT, /* of a rotation: turns `forward` along such a curve of places, and `up` as near as may be */
    LMN_TIME_MAP_FALL,    /* start + velocity t + gravity t²/2 */
    LMN_TIME_MAP_BOUNCE,  /* the same, thrown back where it comes down to `floor` */
    LMN_TIME_MAP_OSCILLATE, /* start + amplitude sin(2π (frequency t + phase)); up to three numbers */
    LMN_TIME_MAP_SPIN,      /* of a rotation: about `axis`, `rate_deg` a second from `phase_deg` on */
    LMN_TIME_MAP_FOLLOW,    /* of a translation: where `follows` was `delay_s` ago, plus `offset` in the world */
    LMN_TIME_MAP_CALLBACK   /* what `function` says */
} lmn_time_map;

typedef enum lmn_curve_kind {
    LMN_CURVE_CATMULL_ROM = 0, /* through all points, two or more */
    LMN_CURVE_BEZIER           /* cubic, 3 n + 1 points */
} lmn_curve_kind;

/* The value at a time of the constraint's own, 0 … its duration, as many numbers as the property has. The same for the
 * same time; asked at any time, in any order, several times, during calls that lay out or inspect the scene's
 * behaviour, by their threads. Numbers that are not finite are refused. */
typedef void (*lmn_behaviour_fn)(double seconds, double *out, void *user);
typedef void (*lmn_behaviour_release_fn)(void *user);

/* A map drives a property. Initialise with LMN_CONSTRAINT_DESC_INIT. */
typedef struct lmn_constraint_desc {
    size_t      struct_size;
    const char *name;       /* NULL: none */
    double      duration_s; /* 0: what it needs: a linear one up to its last time, a bounce until it lies still; others
                               have to be told */
    uint32_t         node;
    lmn_property     property;
    lmn_time_map     map;
    bool             about_axis; /* of a rotation: values are angles about `axis` */
    double           axis[3];    /* of such and of a spin; 0 0 0: up */
    const double    *values;     /* value_count times the numbers of the property */
    size_t           value_count;
    const double    *times_s; /* of a linear one, increasing from 0 on, value_count of them; NULL: evenly */
    lmn_curve_kind   curve;
    bool             closed;            /* Catmull-Rom: the last point is joined with the first */
    bool             by_length;         /* equal times are equal lengths, for values of up to four numbers */
    double           forward[3], up[3]; /* of a tangent; 0 0 0: the front of models (+Z, or −Y where Z is up), up */
    bool             start_given;       /* else falls and bounces begin where the node is at rest */
    double           start[3];
    double           velocity[3], gravity[3];        /* a second; gravity 0 0 0: 9.81 downward */
    double           floor_height, restitution;      /* height of the node's origin along −gravity; 0 … 1 */
    double           amplitude[3], frequency, phase; /* of an oscillation: frequency in Hz, phase in turns */
    double           rate_deg, phase_deg;
    uint32_t         follows; /* a node that does not follow this one */
    double           delay_s, offset[3];
    lmn_behaviour_fn function;
    void            *function_user;
    lmn_behaviour_release_fn release; /* called with function_user when the scene has done with it, not after an error
                                    of the call that brought it; NULL: nothing is */
} lmn_constraint_desc;
#define LMN_CONSTRAINT_DESC_INIT                                                                                       \
    {                                                                                                                  \
        sizeof(lmn_constraint_desc), NULL, 0, 0, LMN_PROPERTY_TRANSLATION, LMN_TIME_MAP_CONSTANT, false, {0, 0, 0},    \
            NULL, 0, NULL, LMN_CURVE_CATMULL_ROM, false, false, {0, 0, 0}, {0, 0, 0}, false, {0, 0, 0}, {0, 0, 0},     \
            {0, 0, 0}, 0, 0.7, {0, 0, 0}, 1, 0, 360, 0, 0, 0, {0, 0, 0}, NULL, NULL, NULL                              \
    }

/* Adds a constraint; nothing plays yet. *activity (may be NULL) gets its number. */
LMN_API lmn_status lmn_behaviour_add_constraint(lmn_scene *scene, const lmn_constraint_desc *desc, uint32_t *activity,
                                                lmn_error *error);

/* Exchanges all of an activity by a constraint, whatever it was. */
LMN_API lmn_status lmn_behaviour_set_constraint(lmn_scene *scene, uint32_t activity, const lmn_constraint_desc *desc,
                                                lmn_error *error);

/* --- what plays -------------------------------------------------------------------------------------------- */

/* Says which activities begin at 0, one or more, in place of those that did, and writes the animation "behaviour". What
 * moves loses its matrix: it has translation, rotation and scale from then on. */
LMN_API lmn_status lmn_behaviour_play(lmn_scene *scene, const uint32_t *activities, size_t count, lmn_error *error);

/* Takes back what lmn_behaviour_play, or a script, has said: nothing of the behaviour plays any longer, and the
 * animation "behaviour" is no longer there, so that those behind it in the scene have numbers that are smaller by one.
 * Activities stay, and can be played again. Where nothing plays nothing happens. */
LMN_API lmn_status lmn_behaviour_stop(lmn_scene *scene, lmn_error *error);

/* How many activities a scene has, its scripts' too, and those that begin at 0 (index from 0 on; 0 beyond them). */
LMN_API size_t   lmn_behaviour_count(const lmn_scene *scene);
LMN_API uint32_t lmn_behaviour_root_at(const lmn_scene *scene, size_t index);

/* --- inspection ---------------------------------------------------------------------------------------------- */

/* What happens in a scene, laid out in time; nothing is run and the scene stays as it is. It is lent the scene, which
 * must neither change nor end before it. Calls may come from several threads. Nienhaus 2005, section 7.4. */
typedef struct lmn_dynamics lmn_dynamics;

/* Of a clip, by name or number from 1 on, or several, separated by commas; NULL: of the behaviour, or without one of
 * what plays where no clip is named. End it with lmn_dynamics_destroy. */
LMN_API lmn_status lmn_dynamics_create(const lmn_scene *scene, const char *clips, lmn_dynamics **out, lmn_error *error);
/* NULL and a pointer to NULL are accepted. */
LMN_API void lmn_dynamics_destroy(lmn_dynamics **dynamics);

/* Of all that happens; 0 when nothing does. */
LMN_API double lmn_dynamics_duration(const lmn_dynamics *dynamics);

/* One lifetime of a constraint, of what a clip drives, or of an event, whose two ends are one. What is repeated or
 * shared has several. */
typedef struct lmn_lifetime {
    uint32_t     activity; /* 0: a clip that no activity plays */
    bool         is_event;
    uint32_t     node;               /* whose property it drives, or what it happens to; 0: nobody in particular */
    lmn_property property;           /* not of events */
    double       from_s, to_s;       /* global time */
    bool         open_from, open_to; /* does another one own that instant? */
} lmn_lifetime;

/* All of them, in the order of the graph, by index from 0 on; false beyond them. */
LMN_API bool lmn_dynamics_lifetime_at(const lmn_dynamics *dynamics, size_t index, lmn_lifetime *out);

/* D of a node and an interval: its path, the nodes from the root to it, all of which may move it, and by their indices
 * the lifetimes of what drives one of them, or happens to one, within from_s … to_s (ends belong to it; ±INFINITY:
 * all). At most `path_capacity` and `lifetime_capacity` are written; *path_count and *lifetime_count get how many there
 * are. An array may be NULL with a capacity of 0. */
LMN_API lmn_status lmn_dynamics_of_node(const lmn_dynamics *dynamics, uint32_t node, double from_s, double to_s,
                                        uint32_t *path, size_t path_capacity, size_t *path_count, size_t *lifetimes,
                                        size_t lifetime_capacity, size_t *lifetime_count, lmn_error *error);

/* Where a point is in the world, a second's way, and how that changes a second. */
typedef struct lmn_point_state {
    double time_s, position[3], velocity[3], acceleration[3];
} lmn_point_state;

/* A point of a node's axes (NULL: its origin) at a time. Where two motions meet it is on the later one. */
LMN_API lmn_status lmn_dynamics_point(const lmn_dynamics *dynamics, uint32_t node, const double point[3], double time_s,
                                      lmn_point_state *out, lmn_error *error);

/* Its trajectory within from_s … to_s, finite: so many states that straight lines between them are nowhere farther than
 * `tolerance`, above 0, from it; two, before and behind, where motions meet. At most `capacity` are written, and *count
 * gets how many there are; `states` may be NULL with 0. */
LMN_API lmn_status lmn_dynamics_trajectory(const lmn_dynamics *dynamics, uint32_t node, const double point[3],
                                           double from_s, double to_s, double tolerance, lmn_point_state *states,
                                           size_t capacity, size_t *count, lmn_error *error);

/* Where something that moves hits something: it comes on towards a surface, and its velocity changes at once so that it
 * does not go through. */
typedef struct lmn_contact {
    double   time_s;
    double   place[3];  /* where it touches, in the world */
    double   normal[3]; /* of the surface that is met there, towards the node, unit; without one the way it is pushed */
    double   impulse;   /* of a unit mass: how much its velocity changes, lengths a second */
    uint32_t other;     /* the node whose surface it meets there; 0: nothing is there */
    double   distance;  /* how far that surface is from `place`; 0 without one */
} lmn_contact;

/* Contacts of a node, with all below it, whose impulse is `least` or more, 0 or above, in order of time: whose surface
 * is met is looked for among all parts that are not its own, as they are then. Place and normal are those of the
 * features that meet first, a corner and a face or two edges, in the middle of all of them; meshes that stand for
 * spheres, cylinders or cones (cut off or not, too), all of one and drawn smooth, are met as these, however they are
 * scaled. Who leaves a closed surface does not meet
 * it. Where no surface is, there is a contact only where it is thrown back while one pull draws it on before and
 * behind, as by a floor that is not in the scene: corners of sampled curves are none. What has no surface has no
 * contacts. At most `capacity` are written, and *count gets how many there are; `contacts` may be NULL with 0. Errors
 * also: LMN_FORMAT (nothing can be where the animation puts it).
 */
LMN_API lmn_status lmn_dynamics_contacts(const lmn_dynamics *dynamics, uint32_t node, double from_s, double to_s,
                                         double least, lmn_contact *contacts, size_t capacity, size_t *count,
                                         lmn_error *error);

#ifdef __cplusplus
}
#endif
#endif
