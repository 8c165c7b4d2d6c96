/* What is written beside a drawing: labels of parts with leaders that keep clear of each other, the legend of a datum,
 * a north arrow, a scale bar. Nienhaus 2005, section 4.8 (textual references in the bird's-eye view); rows C10, C12.
 * It lies on a sheet, so that pictures and vector drawings have the same. */
#ifndef LIMNER_ANNOTATE_ANNOTATE_H
#define LIMNER_ANNOTATE_ANNOTATE_H

#include "plan/plan.h"
#include "sheet/sheet.h"

/* A view of the scene on a sheet. All is lent. */
typedef struct annotated_view {
    const plan        *plan;
    const view_camera *camera;
    double             box[4];  /* where it lies: x, y, width, height, mm */
    const uint64_t    *visible; /* per part without triangles, how much of it is seen, in any unit; NULL: all */
    double             unit_mm; /* of the scene's unit; 0: unknown */
    colour             ground;  /* of the page */
} annotated_view;

/* Does the look want anything of this? */
bool annotate_wanted(const lmn_look *look);
/* Does it want to know which parts are seen? Of triangles it finds that out itself. */
bool annotate_wants_visible(const lmn_look *look, const lmn_scene *scene);

/* Adds a group "annotations" below `parent` (−1: none). Warns of what cannot be told. Errors: LMN_MEMORY. */
lmn_status annotate(sheet *page, int32_t parent, const annotated_view *view, warnings *warnings, lmn_error *error);

#endif
