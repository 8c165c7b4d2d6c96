/* Lapped textures: patches that overlap and cover a surface, each laid flat along a field of directions, so that
 * patterns can be drawn on models without texture coordinates. Großmann 2011, section 3.2.3.3; row Großmann 7;
 * after Praun 2000. */
#ifndef LIMNER_FIELD_LAPPED_H
#define LIMNER_FIELD_LAPPED_H

#include "field/direction_field.h"

/* Triangles again, once for each patch that they belong to, in the order in which they are drawn: later ones lie on
 * top where their patch's outline has them. The outline of patch k: a position (x, y) is inside when its distance from
 * 0 is less than lapped_outline(k, its angle) × radius. First come triangles that the outlines together do not have
 * all of: each once, with the flag to ignore the outline. */
typedef struct lapped_mesh {
    uint32_t  vertex_count, index_count, patch_count;
    uint32_t *source;      /* per vertex: the primitive's vertex */
    float (*positions)[4]; /* per vertex: x and y in the patch's plane (model units, x along the field's d), 1 where the
                           outline must be ignored since nothing else covers the triangle there, else 0; number of the
                           patch */
    uint32_t *indices;
    double    stretch; /* worst stretch of 95 % of all triangles in their patches: 1 is none; none is above 1.5 */
} lapped_mesh;

/* radius: of a patch, model units; one that is no positive number is taken as an eighth of the model. Every point
 * of the surface is inside the outline of some patch (with a fiftieth of the radius to spare) or in a triangle that
 * ignores it. Patches end at edges sharper than 60 degrees. Where copies of a triangle lie on each other, each is
 * in the patch; triangles without an area whose corners coincide are left out. Seeded, deterministic. Errors:
 * LMN_MEMORY, LMN_LIMIT (more vertices or indices than 32 bits count; there are never more than 16 times the
 * triangles or 65536: if that does not do, what remains ignores the outline). Free with lapped_release. */
lmn_status lapped_make(lapped_mesh *out, const primitive *p, const direction_field *field, double radius, uint32_t seed,
                       lmn_error *error);
void       lapped_release(lapped_mesh *m);

/* Radius of an outline at an angle, fraction of the patch's: 0.7 + 0.2 sin(3a + 2.4k) + 0.1 sin(7a + 1.7k), so that
 * edges look torn. */
double lapped_outline(uint32_t patch, double angle);

#endif
