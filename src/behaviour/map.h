/* Maps of time to values. */
#ifndef LIMNER_BEHAVIOUR_MAP_H
#define LIMNER_BEHAVIOUR_MAP_H

#include "behaviour/schedule.h"

/* What maps have where nobody says it: gravity of 9.81 downward, a turn a second about what is up, models that look
 * along +z (-y where z is up), restitution 0.7. */
void map_defaults(behaviour_map *m, const lmn_scene *scene);
/* What a constraint's map needs by itself, seconds; below 0: it has to be told. */
double map_requirement(const behaviour_map *m);
/* Is it one that the property can have? The reason why not, or NULL. */
const char *map_fault(const lmn_scene *scene, const behaviour_node *n);

/* The value at a local time within 0 … length (a constraint's own time, seconds). Followers are schedule_value's. */
void map_value(const behaviour_node *n, const curve_table *table, double local, double length, double *out);
/* Local times within the activity where the value or its direction may jump, or beyond which it turns a lot; calls
 * `found` for each until it returns false. */
void map_breaks(const behaviour_node *n, const curve_table *table, double length,
                bool (*found)(double local, void *user), void *user);

/* A point of a curve and its derivative, both of `components` numbers and either may be NULL; the parameter is 0 … 1.
 */
void curve_at(const behaviour_map *m, double parameter, double *out, double *derivative);
/* Where, as a parameter, a curve is that has gone a share of its length. */
double curve_parameter(const curve_table *table, const behaviour_map *m, double share);
/* False when memory is gone. */
bool   curve_measure(curve_table *out, const behaviour_map *m);
size_t curve_pieces(const behaviour_map *m);

/* Motion under gravity with a floor: position after some seconds; when it lies still (infinity: never); when it meets
 * the floor the n-th time, from 0 on, infinity: never. */
void   bounce_at(const behaviour_map *m, double seconds, double out[3]);
double bounce_rest(const behaviour_map *m);
double bounce_impact(const behaviour_map *m, int n);
/* How fast it arrives there. */
double bounce_speed(const behaviour_map *m, int n);

#endif
