/* Behaviour: what happens when. A directed graph of activities, which last, and events, which do not; groups say how
 * their children follow one another, modifiers rewrite their time, and constraints tie a map of time to a property of
 * the scene. Nienhaus 2005, section 7.3, after Döllner and Hinrichs. Here is only what the scene keeps; what it means
 * is in src/behaviour. */
#ifndef LIMNER_SCENE_BEHAVIOUR_H
#define LIMNER_SCENE_BEHAVIOUR_H

#include "scene/scene.h"

typedef enum behaviour_kind {
    BEHAVIOUR_SEQUENCE,     /* one child after the other */
    BEHAVIOUR_SIMULTANEITY, /* all at once */
    BEHAVIOUR_TABLE,        /* each at its own time */
    BEHAVIOUR_REVERSE,      /* its child from the end to the begin */
    BEHAVIOUR_REPEAT,       /* its child `times` times */
    BEHAVIOUR_CREEP,        /* its child slow at first and fast at last: τ becomes τ^exponent */
    BEHAVIOUR_CONSTRAINT,   /* a map drives a property */
    BEHAVIOUR_CLIP,         /* an animation of the scene */
    BEHAVIOUR_EVENT         /* something happens, without duration */
} behaviour_kind;

/* What a simultaneity does with children that need less time than it has. */
typedef enum behaviour_fit { FIT_STRETCH, FIT_START, FIT_CENTRE, FIT_END, FIT_SHRINK } behaviour_fit;

/* A time to value map. Numbers are in the units of the property. */
typedef enum map_kind {
    MAP_CONSTANT,  /* one value */
    MAP_LINEAR,    /* values in between which it goes straight, rotations by slerp; evenly, or at `times` */
    MAP_CURVE,     /* through points; time is its parameter or its arc length */
    MAP_TANGENT,   /* rotations that turn `forward` along the tangent of such a curve, and `up` as near as may be */
    MAP_FALL,      /* start + velocity t + gravity t²/2 */
    MAP_BOUNCE,    /* the same, thrown back by a floor */
    MAP_OSCILLATE, /* start + amplitude sin(2π (frequency t + phase)) */
    MAP_SPIN,      /* rotations about `axis`, `rate` radians a second from `phase` radians on */
    MAP_FOLLOW,    /* where another node was `delay` ago, plus `offset`, as a translation */
    MAP_CALLBACK   /* whatever the host says */
} map_kind;

typedef enum curve_kind { CURVE_BEZIER, CURVE_CATMULL_ROM } curve_kind;

/* Seconds of the activity's own time to a value. Called at any time, in any order, several times. */
typedef void (*behaviour_function)(double seconds, double *out, void *user);
typedef void (*behaviour_release)(void *user);

typedef struct behaviour_map {
    map_kind   kind;
    size_t     components; /* of each value */
    double    *values;     /* value_count · components; of curves the points, Bezier's 3 n + 1 */
    size_t     value_count;
    double    *times; /* of linear ones, increasing, as many as values; NULL: evenly */
    curve_kind curve;
    bool       closed;    /* Catmull-Rom: the last point is joined with the first */
    bool       by_length; /* equal times are equal lengths */
    double     start[3], velocity[3], gravity[3], offset[3], axis[3], forward[3], up[3];
    double     floor, restitution;     /* height along −gravity; 0 … 1 */
    double     frequency, phase, rate; /* of an oscillation `velocity` is the amplitude */
    double     delay;
    int32_t    other; /* whom it follows; else NONE */

    behaviour_function function;
    void              *user;
    behaviour_release  release; /* of `user`, when nobody asks any more; may be NULL */
} behaviour_map;

typedef struct behaviour_child {
    int32_t node;
    double  start, duration; /* in tables; duration below 0: what it needs */
} behaviour_child;

typedef struct behaviour_node {
    behaviour_kind   kind;
    char            *name;     /* may be NULL */
    double           duration; /* below 0: what it needs by itself */
    behaviour_child *children;
    size_t           child_count, child_capacity;
    behaviour_fit    fit;
    uint32_t         times;    /* of a repeat, from 1 on */
    double           exponent; /* of a creep, from 1 on */
    animation_path   path;     /* what a constraint drives */
    int32_t          target;   /* whose; of an event, what it happens to, or NONE */
    bool             about;    /* a rotation given as one angle about `axis` */
    double           axis[3];
    behaviour_map    map;
    int32_t          clip;         /* of the scene's animations; else NONE */
    uint32_t         line, column; /* of the file; 0: unknown */
} behaviour_node;

struct behaviour {
    behaviour_node *nodes;
    size_t          node_count, node_capacity;
    int32_t        *roots; /* each begins at 0 */
    size_t          root_count, root_capacity;
    int32_t         written; /* the animation that was made of it (behaviour/clip.h), NONE: none yet */
};

/* Appends a node without children, which is no root yet: it needs what it needs, nothing is its target. Makes the
 * scene's behaviour when there is none. Its index; NONE when memory is gone. */
int32_t behaviour_append(lmn_scene *scene, behaviour_kind kind);
/* What it is before anything is known of it. */
behaviour_node behaviour_blank(behaviour_kind kind);
void           behaviour_node_release(behaviour_node *n);
/* Takes back what was appended last, which nothing refers to. */
void behaviour_take_back(lmn_scene *scene);
bool behaviour_append_child(lmn_scene *scene, int32_t parent, int32_t child, double start, double duration);
bool behaviour_append_root(lmn_scene *scene, int32_t root);

/* How many numbers a property has; weights: those of the mesh, 0 where it has none. */
size_t behaviour_components(const lmn_scene *scene, animation_path path, int32_t target);
/* The camera or light of a node that a property is of, or the node itself; NONE: it has none. */
int32_t behaviour_target_of(const lmn_scene *scene, animation_path path, int32_t node_index);
/* Is there such a thing in the scene? */
bool behaviour_target_exists(const lmn_scene *scene, animation_path path, int32_t target);

void behaviour_free(struct behaviour *b);

/* Where the elements of another scene begin in one that takes them over. */
typedef struct behaviour_offsets {
    int32_t nodes, cameras, lights, animations;
} behaviour_offsets;
/* Room for what behaviour_take will do, in `into`; false when memory is gone. */
bool behaviour_reserve(lmn_scene *into, const lmn_scene *from);
/* Moves the behaviour of `from` behind that of `into`. Cannot fail after behaviour_reserve. */
void behaviour_take(lmn_scene *into, lmn_scene *from, const behaviour_offsets *by);

#endif
