/* Views beside those that look along the axes: sections, details, and views along any direction. What descriptions say
 * of them in words. */
#ifndef LIMNER_DRAFT_EXTRAS_H
#define LIMNER_DRAFT_EXTRAS_H

#include "limner/draw.h"
#include "scene/scene.h"

enum { DRAFT_EXTRAS_MOST = 12, DRAFT_DEPTHS_MOST = 4, DRAFT_CUT_SIZE = 1200 };

/* A revolved section is no view of its own: it lies in another one, turned into the plane of the sheet. */
typedef enum draft_kind { DRAFT_SECTION, DRAFT_DETAIL, DRAFT_AUXILIARY, DRAFT_REVOLVED } draft_kind;

typedef struct draft_extra {
    draft_kind kind;
    char       letter;
    lmn_view   view;       /* a section looks so, a detail is of this one */
    double     axes[3][3]; /* of that view: right, up, towards the eye */
    /* Sections: the plane lies at depths[0] up to turns[0], there steps to depths[1] … along the eye's and the right
     * axis, world */
    double depths[DRAFT_DEPTHS_MOST], turns[DRAFT_DEPTHS_MOST];
    size_t depth_count;
    bool   half;                 /* what is right of turns[0] is cut; revolved ones have turns[0] alone */
    char   cut[DRAFT_CUT_SIZE];  /* what is taken away, as cut_parse reads it */
    bool   of_face;              /* auxiliary: along the normal of the face nearest to `at` */
    double at[3], radius, scale; /* details: around what, world; scale 0: twice as large or more */
    double eye[3];               /* auxiliary: towards the eye, unit */
} draft_extra;

typedef struct draft_extras {
    draft_extra items[DRAFT_EXTRAS_MOST];
    size_t      count;
} draft_extras;

/* The world's axis that a section's plane is at right angles to. */
int draft_section_axis(const draft_extra *e);

/* Lists separated by ';', each of which may be NULL; letters go on from one list to the next. `bounds`: of the model,
 * world. Errors: LMN_USAGE. */
lmn_status draft_extras_parse(draft_extras *out, const char *sections, const char *details, const char *auxiliary,
                              char up, box3 bounds, lmn_error *error);

#endif
