/* What a person did to the solids of a scene: which nodes stand elsewhere or are hidden. A list of edits never changes
 * once it is there; states share it. No window. */
#ifndef LIMNER_VIEW_SOLID_EDITS_H
#define LIMNER_VIEW_SOLID_EDITS_H

#include <glib.h>

#include "limner/limner.h"

typedef struct solid_edit {
    uint32_t solid, node;
    double   matrix[16], original[16];
    bool     hidden;
} solid_edit;

/* The same list with this edit of a node, or without any when it leaves the node as it was; `edits` may be NULL. The
 * new list is the caller's. */
GArray *solid_edits_with(const GArray *edits, const solid_edit *edit);

/* The edit of a node, or NULL. */
const solid_edit *solid_edits_find(const GArray *edits, uint32_t solid, uint32_t node);

/* Makes the scene as `wanted` has it where it is as `applied`; both may be NULL. On an error as much as went. */
lmn_status solid_edits_apply(lmn_scene *scene, const GArray *applied, const GArray *wanted, lmn_error *error);

/* A node moved by `shift`, in the axes of the scene: its matrix, when `above` is the product of the matrices above it.
 */
void solid_shift(const double matrix[16], const double above[16], const double shift[3], double out[16]);

/* Turned by an angle around an axis of the scene (0 … 2) through a point. */
void solid_turn(const double matrix[16], const double above[16], const double point[3], int axis, double angle,
                double out[16]);

/* Products and points of matrices, column after column. */
void matrix_multiply(const double a[16], const double b[16], double out[16]);
void matrix_move_point(const double m[16], const double p[3], double out[3]);
/* The point that the matrix moves to p; false when it is flat. */
bool matrix_solve_point(const double m[16], const double p[3], double out[3]);

#endif
