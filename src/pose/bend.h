/* Parts of a thing that are late: where each of its points was a little earlier. Großmann 2011, sections 3.3.3.2
 * (temporal offset of geometry, after Schmid et al.) and 3.3.4 (Cartoon Blur, after Kawagishi et al.). */
#ifndef LIMNER_POSE_BEND_H
#define LIMNER_POSE_BEND_H

#include "scene/scene.h"

enum { BEND_STEPS = 16 };

/* Of one part. Zero-initialised: nothing is late. */
typedef struct part_bend {
    bool  active;
    mat4 *joints; /* of a skin, of now and of as many steps: its points are where their own joints had them; NULL: all
                     go with what moves */
    size_t joint_count;             /* of each step */
    mat4   to_world, to_mesh;       /* from where its vertices are to the world, before it is deformed otherwise */
    mat4   earlier[BEND_STEPS + 1]; /* how what moves stood at equal steps of `seconds` ago, from how it stands now */
    double seconds, lag, comb;
    double way[3], front, length; /* along the motion: where what moves begins, and how far it reaches back */
    bool   around; /* what is `length` off the middle is the rear: of what turns about it, or moves on the spot */
    double middle[3];
    double push[3];               /* of the rear, by what it is dragged; in front of it by the square of the distance */
    double across[3], low, width; /* teeth stand side by side along this */
    double teeth;
} part_bend;

/* How late a point of the world is, seconds. */
double bend_delay(const part_bend *b, const double point[3]);

/* The tooth near whose tip a point of the world is; −1: none. */
int32_t bend_tooth(const part_bend *b, const double point[3]);

/* Where vertices that are posed as they are now come to, and unless NULL their normals. */
void bend_vertices(const part_bend *b, uint32_t count, vec3 *positions, vec3 *normals);

/* The same for a bend with joints. The rest as for mesh_pose. */
void bend_skin(const part_bend *b, const primitive *p, const float *weights, size_t weight_count, const vec3 *normals,
               const uint32_t *source, uint32_t count, vec3 *positions, vec3 *out_normals);

#endif
