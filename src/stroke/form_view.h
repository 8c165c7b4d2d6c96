/* A smooth surface as one view sees it, and lines across its faces. All in the axes of the model, to which the eye
 * is brought. */
#ifndef LIMNER_STROKE_FORM_VIEW_H
#define LIMNER_STROKE_FORM_VIEW_H

#include "stroke/form_surface.h"
#include "stroke/stroke_private.h"

typedef struct form_view {
    view_lines         *out;
    const stroke_view  *v;
    const stroke_item  *item;
    const edge_mesh    *m;
    const form_surface *s;
    uint32_t            index;    /* of the item */
    double3             eye;      /* of the eye; in parallel projection the direction towards it */
    double             *facing;   /* per knot: cosine between normal and direction to the eye */
    bool                mirrored; /* its world turns left into right */
    uint32_t           *numbers;  /* per half-edge: what lines end with that cross it; NO_VERTEX: none yet */
} form_view;

/* An end of a line across a face. */
typedef struct form_end {
    double3  position;
    uint32_t number;
    float    weight; /* at most 1; what is below 0 is cut off */
} form_end;

/* Errors: false when memory is gone. `*seen` is false where the item is so squeezed that nothing can be seen of it.
 * End with form_view_close. */
bool form_view_open(form_view *f, view_lines *out, const stroke_view *v, uint32_t item, const form_surface *s,
                    bool *seen);
void form_view_close(form_view *f);

double3 form_direction(const form_view *f, double3 position); /* unit vector to the eye */
double3 form_position(const form_view *f, uint32_t face, uint32_t corner);
/* 1 when the face is seen from its outside, −1 from its inside, 0 when it is the inside of a closed body or seen
 * edge-on: nobody sees it. */
int form_side(const form_view *f, uint32_t face);

/* Where a half-edge is crossed by what is `begin` at its begin and `end` at its end: the same position and number from
 * either side. Also the fraction from its begin. */
form_end form_cross(form_view *f, uint32_t half, double begin, double end, double *fraction);
/* Adds a line across a face; `turned` as in view_line. False when memory is gone. */
double3 form_to_world(const form_view *f, double3 p);
bool    form_put(form_view *f, stroke_class kind, uint32_t face, form_end a, form_end b, bool turned);

/* --- smooth.c --- */
/* Outlines by normals. */
bool smooth_collect(form_view *f);
/* The same of samplings, by normals without noise. */
bool calm_collect(form_view *f);
/* Is the surface hollow along the view around a face? */
bool form_is_hollow(const form_view *f, uint32_t face, double3 position);
/* Where a face is crossed by the outline, by `facing`: from where the winding passes from the front to the back to
 * where it comes again, so that what is in front lies to the left. False when it is not. */
bool form_outline(form_view *f, uint32_t face, form_end ends[2]);
/* --- form_ridges.c --- */
/* Ridges, valleys and apparent ridges; strengths as in stroke_options. */
bool ridges_collect(form_view *f, stroke_class kind, double strength);

/* Lengths and curvatures are measured against this fraction of the size of a mesh. */
#define FORM_UNIT 0.1
/* 0 at the limit, 1 at twice of it, below 0 where there is no line. */
float form_fade(double measure, double limit);

#endif
