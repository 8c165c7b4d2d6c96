/* A cylinder or cone through points, by least squares. */
#ifndef LIMNER_DRAFT_CYLINDER_FIT_H
#define LIMNER_DRAFT_CYLINDER_FIT_H

#include <stdbool.h>
#include <stddef.h>

typedef struct cylinder_fit {
    double axis[3], centre[3], radius; /* centre: any place on the axis */
    double across[2][3];               /* unit, at right angles to the axis and each other */
    double slope; /* of a cone: by how much the radius, which is that at the centre, grows along the axis; else 0 */
} cylinder_fit;

/* Sets `across` from the axis, the same for axes that are nearly the same. */
void cylinder_frame(cylinder_fit *c);
/* How far a point is from the axis; `angle` (may be NULL) gets where around it, −π … π, `along` where along it. */
double cylinder_distance(const cylinder_fit *c, const double p[3], double *angle, double *along);
/* Centre and radius from the points, for the axis that is there (Kåsa). False: they lie on no circle. */
bool cylinder_start(cylinder_fit *c, const double (*points)[3], size_t count);
/* Comes nearer: axis, centre, radius, and of cones (slope not 0) slope, in a few rounds of Gauss and Newton. */
bool cylinder_refine(cylinder_fit *c, const double (*points)[3], size_t count);
/* Axis, slope, centre and radius of a cone from unit normals of its faces, and points of it. False: they are of no
 * cone, or of one that is nearly a cylinder or a plane. */
bool cone_start(cylinder_fit *c, const double (*normals)[3], size_t normal_count, const double (*points)[3],
                size_t count);
/* What its radius is at a place along the axis. */
static inline double cylinder_radius(const cylinder_fit *c, double along)
{
    return c->radius + c->slope * along;
}
/* The direction that these unit normals are most at right angles to. */
void cylinder_axis_of_normals(double out[3], const double (*normals)[3], size_t count);

#endif
