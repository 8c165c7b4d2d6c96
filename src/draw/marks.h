/* Marks of figures: dots and strokes on the surfaces of their parts, made once a scene and look, drawn each frame. Needs no GPU but for marks_draw. */
#ifndef LIMNER_DRAW_MARKS_H
#define LIMNER_DRAW_MARKS_H

#include "halftone/marks.h"
#include "technique/technique.h"

/* The triangles of some parts as one surface, in the world's axes, measured from `origin`. */
typedef struct mark_ground {
    mark_surface surface;
    double       origin[3];
    double       extent;      /* diagonal of it all */
    vec3        *places, *normals;
    vec2        *uvs;         /* v upwards; NULL unless all parts have texture coordinates */
    uint32_t    *indices;
    uint32_t    *parts;       /* per triangle: index of its part */
    float       *brightness;  /* per corner of each triangle: of its material, linear, 0 … 1 */
} mark_ground;

/* Of the parts with `parts[index]` (NULL: all) in their pose; solids have no triangles. Errors: LMN_MEMORY. */
lmn_status mark_ground_create(mark_ground *out, const lmn_scene *scene, const mat4 *worlds, const bool *parts, size_t part_count, double crease_angle, lmn_error *error);
void       mark_ground_release(mark_ground *g);

/* The marks that a surface technique puts there, with the brightness of what they lie on. Errors: those of the technique. */
lmn_status mark_ground_marks(marks *out, const mark_ground *g, const technique_use *surface, lmn_error *error);

#endif
