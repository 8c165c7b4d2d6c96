/* Handles of a section: where they are on the picture, and what dragging one makes of the look's `scene.cut`. Of what
 * that can say these are shown: one plane across an axis, and one box, by percentages of what is shown. No window. */
#ifndef LIMNER_VIEW_SECTION_H
#define LIMNER_VIEW_SECTION_H

#include "orbit.h"

typedef enum section_kind { SECTION_NONE = 0, SECTION_PLANE, SECTION_BOX, SECTION_OTHER } section_kind;

/* Percentages of the bounds. A plane has its place in high[axis]. */
typedef struct section {
    section_kind kind;
    int          axis;    /* of a plane: 0 … 2 */
    bool         flipped; /* it cuts away what lies on the side of falling coordinates */
    double       low[3], high[3];
} section;

enum { SECTION_HANDLES = 6, SECTION_TEXT_MAX = 160 };

section section_parse(const char *cut);

/* As scene.cut has it; "" for none. Not for SECTION_OTHER. */
void section_write(const section *s, char out[SECTION_TEXT_MAX]);

typedef struct section_handle {
    int    axis;
    bool   is_low;  /* moves low[axis], else high[axis] */
    double at[2];   /* on the picture */
    double step[2]; /* by how many pixels a percentage more moves it */
} section_handle;

/* How many handles there are on a picture of this size. */
int section_handles(const section *s, const double box_min[3], const double box_max[3], const orbit *view, int width,
                    int height, section_handle out[SECTION_HANDLES]);

/* Moves what a handle holds, from where it was when the drag began, by pixels; low stays below high. */
void section_drag(section *s, const section_handle *handle, const section *begin, double dx, double dy);

#endif
