/* Along which way a surface bends: a field of directions without sign, one symmetric tensor a vertex, which may be
 * interpolated where directions may not. Großmann 2011, section 3.2.3.2; Müller, section 4.1; rows Großmann 6, P26
 * (Alliez et al. 2003, with the printed traps there mended). Where the surface is not sure of itself the direction is
 * an arm of a field of crosses (Hertzmann and Zorin 2000; solved after Knöppel et al. 2013 and Jakob et al. 2015). */
#ifndef LIMNER_FIELD_DIRECTION_FIELD_H
#define LIMNER_FIELD_DIRECTION_FIELD_H

#include "scene/mesh.h"

/* T = s · (d dᵀ − e eᵀ): d and e are unit tangents along the greatest and the least absolute curvature, s in 0 … 1
 * how sure that is (0: flat or as round as a ball). For a unit tangent l at angle θ to d, l·T·l = s · cos 2θ. */
typedef struct direction_field {
    uint32_t count;        /* the primitive's vertices */
    uint32_t tensor_count; /* at least as many: vertices that lie on a feature have more than one, behind all others */
    float (*tensors)[6]; /* xx, yy, zz, xy, yz, zx; model axes. The first of a vertex on a feature is that of the first
                            triangle there */
    uint32_t *corners;   /* per index of the primitive: its tensor. NULL: the tensor of its vertex */
} direction_field;

/* Of a primitive's vertices (not of render vertices; the corners at one position get the same unless edges sharper
 * than `feature_angle` (radians) lie between; up to 60 degrees these only count where the primitive's normals, if it
 * has any, differ on their two sides). Curvature is measured over discs of about `radius` (model units; 0: three edges,
 * wherever they are short or long; at most about nine mean edges); of scans, which are rough as far as their noise
 * goes, over the smallest of three discs that the next one agrees with, and without features; and of surfaces on which
 * more than a fifth of all directions lie another way over discs of `calm` (0: nobody asks) over these, everywhere.
 * Over the whole surface crosses are laid that are as smooth as what is sure allows, turn no more often than they must,
 * and stand along features; of the two arms that of the greater bend is taken, else the level one (y is up). Where
 * nothing is sure, the sureness stays below 0.1. A flat piece has one direction: that of what bends around it, else
 * that of its border, along its longer side. Robust on open, non-manifold, degenerate and tiny meshes: never a NaN;
 * vertices that no triangle uses have zeros. Size and position of the model do not matter. One million triangles take
 * less than 3 s on two cores. Errors: LMN_MEMORY. Free with direction_field_release. */
lmn_status direction_field_make(direction_field *out, const primitive *p, double feature_angle, double radius,
                                double calm, lmn_error *error);
void       direction_field_release(direction_field *f);

/* The tensor of a corner (an index of the primitive's indices). */
static inline const float *direction_field_at(const direction_field *f, const primitive *p, uint32_t corner)
{
    return f->tensors[f->corners ? f->corners[corner] : p->indices[corner]];
}

#endif
