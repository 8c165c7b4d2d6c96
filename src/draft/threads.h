/* Screw threads that are modelled: helical grooves around what is round, found in the faces of meshes. Drawn by the
 * symbol of ISO 6410-1: as the cylinder that the crests lie on, with a narrow line where the roots lie. */
#ifndef LIMNER_DRAFT_THREADS_H
#define LIMNER_DRAFT_THREADS_H

#include "draft/draw.h"
#include "draft/cylinders.h"

/* In the axes of its mesh, or the world. */
typedef struct draft_thread {
    double   axis[3];    /* unit */
    double   ends[2][3]; /* on the axis, ends[1] on the side of `axis` */
    double   crest, root;
    double   flat[2];    /* between which its crests lie on their cylinder, from ends[0] on: else it is chamfered */
    double   tip[2];     /* what the crests' radius is at the ends */
    bool     hollow;     /* of a bore: its crests lie inside its roots */
    bool     goes_on[2]; /* beyond that end there is more of a round surface, without a thread */
    double   lead;       /* along the axis for a turn; 0: not known */
    uint32_t part;       /* id */
} draft_thread;

typedef struct draft_threads {
    draft_thread *items;
    size_t        count, capacity;
} draft_threads;

/* A scene whose threads are smooth: their crests' cylinders stand for them, with the chamfers that they end in. */
typedef struct draft_thread_scene {
    lmn_scene     scene; /* all but nodes and meshes is borrowed */
    mesh         *made;  /* behind the scene's own meshes */
    size_t        made_count;
    size_t        borrowed; /* of its meshes */
    draft_threads threads;  /* of parts, in the axes of their meshes */
} draft_thread_scene;

/* Looks at the parts with `parts[index]`, of meshes that bend in no pose, not at solids. `out` is what is drawn of the
 * scene then: itself, or t->scene, as long as it is as it was. Errors: LMN_MEMORY, LMN_CANCELLED. */
lmn_status draft_threads_smooth(const lmn_scene **out, draft_thread_scene *t, const lmn_scene *scene, const bool *parts,
                                double crease_angle, lmn_error *error);
void       draft_thread_scene_release(draft_thread_scene *t);

/* The threads of an edge mesh, `part` 0; `region` (one per vertex) gets 1 + the number of the thread that a vertex is
 * of. Errors: LMN_MEMORY. */
lmn_status draft_threads_find(draft_threads *out, uint32_t *region, const edge_mesh *m, lmn_error *error);
/* Where the threads of parts are in the world. */
lmn_status draft_threads_place(draft_threads *out, const draft_threads *of_parts, const stroke_scene *scene,
                               lmn_error *error);
/* Threads that only names tell: of parts called M8, "Screw M10x1" and the like, whose cylinders have that diameter, or
 * bores the core of it (ISO 261, 724). `mm`: of a unit of the world. `parts[index]`: which parts. */
lmn_status draft_threads_named(draft_threads *out, const draft_cylinders *cylinders, const lmn_scene *scene,
                               const bool *parts, double mm, lmn_error *error);
void       draft_threads_release(draft_threads *t);

#endif
