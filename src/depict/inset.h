/* Pictures within the picture: what their files share. */
#ifndef LIMNER_DEPICT_INSET_H
#define LIMNER_DEPICT_INSET_H

#include "depict/page.h"

/* A panel on the page: its middle and half its size, in half heights of the page; y goes up. */
typedef struct inset_panel {
    double middle[2], half[2];
} inset_panel;

typedef enum inset_corner {
    CORNER_AUTO,
    CORNER_TOP_LEFT,
    CORNER_TOP_RIGHT,
    CORNER_BOTTOM_LEFT,
    CORNER_BOTTOM_RIGHT
} inset_corner;

/* --- inset_room.c: where it covers least ----------------------------------------------------------------------------
 */

/* The panel, whose size is known, in a corner of the page, `rim` from the border; CORNER_AUTO: the one where least of
 * scene and signs is seen. Errors: LMN_MEMORY, those of poses. */
lmn_status inset_place(inset_panel *p, const depict_job *j, inset_corner corner, double rim, lmn_error *error);
/* --- inset_stage.c: from the scene onto the panel
 * ---------------------------------------------------------------------- */

/* What a camera sees, brought into a thin stage behind the panel, by one projective map: planes stay planes, and what
 * hides what stays so. At the distance of what it mainly sees, shapes keep their angles. */
typedef struct inset_stage {
    inset_panel panel;
    mat4        view;      /* of the camera: from the world to its axes, without scale */
    bool        parallel;  /* its rays */
    double      slope[2];  /* of the view's sides; parallel: half its size */
    double      near, far; /* far 0: none */
    double      focus;     /* depth of what it mainly sees */
    double      squeeze;   /* of depths in the stage, 1 at most */
    double      depth;     /* of the focus before the viewer of the page */
    double      span[2];   /* of depths in the stage, before it is placed: nearest, farthest */
} inset_stage;

/* A stage for the camera of a node, in a pose; `focus` and `span` are measured by what it sees. Errors: LMN_MEMORY. */
lmn_status inset_open(inset_stage *out, const depict_job *j, const pose *p, int32_t camera_node,
                      const inset_panel *panel, lmn_error *error);
/* Before the viewer of the page, at depths below `back`. */
void inset_set_depth(inset_stage *s, const depict_job *j, double back);
/* A position of the panel: across and up from its middle in halves of it, `behind` the focus in units of span. */
void inset_point(const inset_stage *s, const depict_job *j, double x, double y, double behind, double out[3]);
/* All of a part that is seen, as a glyph's mesh. `m->failed` says whether memory is gone. */
void inset_copy(glyph_mesh *m, const inset_stage *s, const depict_job *j, const primitive *from, const vec3 *positions,
                const mat4 *world);

#endif
