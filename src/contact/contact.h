/* Where something that moves meets something, and what it meets: an instant at which its velocity changes at once
 * (behaviour/inspect.h), and the surface that is there then. Sampled curves have corners at all their keys, so that a
 * corner alone is none: both come together where the surface is, and no longer do so behind it. What is touched, where,
 * and along which normal follow from the surfaces (contact/touch.h). */
#ifndef LIMNER_CONTACT_CONTACT_H
#define LIMNER_CONTACT_CONTACT_H

#include "behaviour/inspect.h"
#include "pose/moment.h"

enum { BOX_SIDES = 6 };
/* The middles of a box's sides; its places are 0 where it is empty. */
void box_sides(box3 box, double out[BOX_SIDES][3]);

typedef struct contact {
    impact hit;       /* its place is where it touches, its normal that of what is met; where nothing is, its outermost
                         place against the change of its velocity, and the way of this */
    int32_t other;    /* the node whose surface is there; NONE: nothing is, and it is thrown back as from a plane */
    double  distance; /* of that surface from the place */
} contact;

/* How near a surface has to be to be met, in radii: round things that are no spheres have flat faces, whose middles lie
 * so far below them where they have 13 sides. */
#define CONTACT_REACH 0.03

/* The parts below a node, and all others that are shown: what it can meet. A flag a part each; free with mem_free.
 * Errors: LMN_MEMORY. */
typedef struct contact_sides {
    bool  *own, *others;
    double reach, radius;
    double outermost[BOX_SIDES][3]; /* of the own ones at rest, in the world: in the middles of their box's sides */
} contact_sides;
lmn_status contact_sides_find(contact_sides *out, const lmn_scene *scene, int32_t node_index, lmn_error *error);
void       contact_sides_release(contact_sides *s);

/* Is a change of velocity a hit? Velocities are of one thing against the other, the normal, unit, is that of the
 * surface which is met: it comes on, which is a good part of what changes, and does not go on through the surface. */
bool contact_is_hit(const double before[3], const double after[3], const double normal[3]);

/* Of what turns on the spot: is a place fast enough to hit something, against the farthest one? Near its hinge it only
 * comes close to what it hangs on. */
bool contact_is_off_hinge(const double place_velocity[3], const double farthest_velocity[3]);

/* How near a surface has to be to be met, where `reach` is for what is exact: corners of a curve that is sampled, 20 or
 * more times a second, lie up to a sample away from where it turns round. */
double contact_reach(double reach, const double before[3], double since, double until);

/* Those of a node and all below it in from … to whose speed is `least` or more, in order: hits of surfaces, and without
 * any where it is thrown back while it falls (impact.thrown_back). What has no surface has none. `clips` has what is
 * laid out in the schedule as clips of the scene. Free *out with mem_free. Errors: as of schedule_trajectory and
 * pose_create. */
lmn_status contacts_find(contact **out, size_t *count, const schedule *s, const moment *clips, int32_t node_index,
                         double from, double to, double least, lmn_error *error);

/* Lays out what happens: the clips that are named (as moment_find has it), or else the scene's behaviour, or without
 * one what plays by itself. `clips` gets them. Errors: of moment_find, schedule_create. Release `out` also after one.
 */
lmn_status schedule_of_moment(schedule *out, moment *clips, const lmn_scene *scene, const char *names,
                              lmn_error *error);

#endif
