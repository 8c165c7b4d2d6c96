/* Inside the import folder: which joint of a model follows which of a motion, and how it stands when nothing moves. */
#ifndef LIMNER_IMPORT_RETARGET_PAIRS_H
#define LIMNER_IMPORT_RETARGET_PAIRS_H

#include "scene/scene.h"

/* A joint of the model and the one of the motion that it follows. What is at rest is so in the pose that the skin was
 * bound in, or in that of the file's nodes where the two are one or nothing tells. */
typedef struct pair {
    int32_t model, motion; /* nodes */
    int32_t above;         /* the pair of the nearest joint above it in the model, NONE of an uppermost one */
    int32_t skin;
    size_t  joint;          /* of the skin */
    double  rest[4];        /* rotation in the world at rest */
    double  parent_rest[4]; /* of what it hangs on, when the pair above is at rest */
    double  place[3];       /* in the world at rest */
    mat4    from_world;     /* of an uppermost one: takes the world to its parent; zeros when that is flat */
} pair;

typedef struct pair_list {
    pair  *items;
    size_t count, uppermost;
} pair_list;

/* Fills the list, which the caller frees also after an error; it stays empty when the two are not the same kind of
 * figure: half of the names of one must be among those of the other. Then *alike is how many are. Errors:
 * LMN_MEMORY. */
bool pairs_find(pair_list *out, const lmn_scene *scene, const lmn_scene *motion, size_t *alike);

/* --- quaternions: x y z w; `out` may be an argument --- */

void quaternion_multiply(const double a[4], const double b[4], double out[4]);
void quaternion_invert(const double q[4], double out[4]);                       /* of a unit one */
void quaternion_conjugate(const double a[4], const double b[4], double out[4]); /* a · b · a⁻¹ */
void quaternion_turn(const double q[4], const double v[3], double out[3]);
void quaternion_of(const mat4 *m, double out[4]);

#endif
