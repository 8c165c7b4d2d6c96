/* What marks lie on: the triangles of parts as one surface, and the marks that a technique puts there; what of them a
 * view shows, for files of vectors (mark_page.c). On the CPU; mark_sets.h has them on the GPU. */
#ifndef LIMNER_STAGE_MARK_GROUND_H
#define LIMNER_STAGE_MARK_GROUND_H

#include "plan/camera.h"
#include "marks/marks.h"
#include "look/look.h"
#include "pose/pose.h"
#include "technique/technique.h"

/* The triangles of some parts as one surface, in the world's axes, measured from `origin`. */
typedef struct mark_ground {
    mark_surface     surface;
    double           origin[3];
    double           extent; /* diagonal of it all */
    vec3            *positions, *normals;
    vec2            *uvs; /* v upwards; 0 in parts that have none */
    uint32_t        *indices;
    uint32_t        *parts;       /* per triangle: index of its part */
    bool             holed;       /* some material has transparent places */
    vec2            *picture_uvs; /* per vertex: where the picture of its material is looked up */
    float           *tints;       /* per vertex: how bright its own colour is, linear */
    int32_t         *pictured;    /* per triangle: the material whose picture lies on it; NONE */
    const lmn_scene *scene;       /* whose materials these are; borrowed */
} mark_ground;

/* Of the parts with `parts[index]` (NULL: all) in their pose; solids have no triangles. Errors: LMN_MEMORY. */
lmn_status mark_ground_create(mark_ground *out, const pose *pose, const bool *parts, size_t part_count,
                              double crease_angle, lmn_error *error);
void       mark_ground_release(mark_ground *g);

/* The marks that a surface technique puts there, with the brightness of what they lie on. Errors: those of the
 * technique. */
lmn_status mark_ground_marks(marks *out, const mark_ground *g, const technique_use *surface, lmn_error *error);

/* Of which parts, and which marks. */
typedef struct mark_ground_options {
    const pose          *pose;
    const bool          *parts; /* NULL: all */
    size_t               part_count;
    double               crease_angle;
    const technique_use *surface;
} mark_ground_options;

/* The ground and its marks in a pose. Marks are put there at rest, and stay where they are on their triangles whatever
 * moves and bends them. Release both, also after an error. Errors: those of mark_ground_marks. */
lmn_status mark_ground_posed(mark_ground *out, marks *marks_out, const mark_ground_options *options, lmn_error *error);

/* The same, of a ground and marks that were made at rest and stay as they are: what is drawn does not hang on what was
 * drawn before. Release both, also after an error. Errors: LMN_MEMORY. */
lmn_status mark_ground_move(mark_ground *now, marks *moved, const mark_ground *at_rest, const marks *made,
                            const mark_ground_options *options, lmn_error *error);

/* What is drawn of them in a view, in pixels of a page of this size, for files of vectors: adds to `out`, with the
 * look's lights (no shadows) and the technique's ink. `surface` must have marks (technique->surface->marks), its
 * lengths in pixels of this page. `hidden` (may be NULL) gets positions in the world's axes: stroke_view_count. Needs
 * no GPU. Errors: LMN_MEMORY, those of the technique. */
typedef struct mark_page_options {
    const pose          *pose;
    const lmn_look      *look;
    const bool          *parts; /* NULL: all */
    size_t               part_count;
    double               crease_angle;
    const technique_use *surface;
    const view_camera   *camera;
    int                  width, height;
    mark_hidden_fn       hidden;
    void                *user;
} mark_page_options;
lmn_status marks_on_page(marks_page *out, const mark_page_options *options, lmn_error *error);

#endif
