/* What moves in a scene, and how much: what proposals are made of. */
#ifndef LIMNER_DEPICT_MOVERS_H
#define LIMNER_DEPICT_MOVERS_H

#include "depict/depict_private.h"

/* A piece of time. */
typedef struct span {
    double from, to;
} span;

/* So many hits of one thing are seen, the strongest ones. */
enum { MOVER_HITS = 12 };

/* Something that moves by itself: nothing above it does. */
typedef struct mover {
    int32_t node;
    bool    camera, light; /* that, and nothing with a surface */
    bool    figure;        /* has limbs: a skin, or joints that move by themselves */
    bool    morphs;        /* its shape changes */
    double  length;        /* of its middle's way */
    double  radius, reach; /* of a ball as wide as it is in the mean; half of its longest side */
    bool    doubles;       /* its way goes back where it came from */
    double  turned;        /* radians, all in all */
    double  scaled;        /* largest by smallest size */
    double  growth; /* its size behind the piece around now in which it only grows or shrinks, by that before it */
    span    grows;  /* that piece */
    double  shaped; /* how far its vertices go without its middle, at most */
    double  zoomed; /* a camera's largest by smallest picture */
    size_t  hits;   /* of something */
    int32_t hit;    /* of what, always the same; NONE: several */
    double  hit_times[MOVER_HITS];
    int32_t hit_whom[MOVER_HITS]; /* of these, whose surface it hits */
    double  origin;               /* way of its own origin, about which it turns */
    bool    spins;                /* about its way */
    bool    followed;             /* by a camera */
    bool    grouped;              /* told with others */
    bool    collides;             /* its hits are told */
    double  weight;               /* how much it matters */
} mover;

typedef struct mover_list {
    mover *items; /* those that matter most first */
    size_t count, capacity;
} mover_list;

/* All within an interval. Errors: LMN_MEMORY, LMN_CANCELLED. Release it also after one. */
lmn_status movers_find(mover_list *out, const depict_job *j, double from, double to, double now, lmn_error *error);
void       movers_release(mover_list *l);

/* Of what has limbs, the one whose end goes farthest between two times, and how far: skins and parts are seen, by what
 * rigs move them is not. NONE: no end moves. Errors: LMN_MEMORY. */
lmn_status mover_limb(int32_t *out, double *length, const depict_job *j, int32_t node, double from, double to,
                      lmn_error *error);

#endif
