/* How many surfaces of solids lie in front of a line: the faces of operands that cover it, each from one position to
 * another at depths that change evenly, evaluated by the solid's tree. */
#ifndef LIMNER_STROKE_SOLID_COVER_H
#define LIMNER_STROKE_SOLID_COVER_H

#include "stroke/solid.h"
#include "stroke/stroke_private.h"

typedef struct solid_cover {
    double   from, to; /* of the segment */
    double   z[2];     /* there */
    uint32_t item, operand, plane;
    bool     nearer; /* than the segment */
} solid_cover;

typedef struct solid_covers {
    solid_cover *items;
    size_t       count, capacity;
    double      *stops;
    size_t       stop_capacity;
    size_t      *active;
    size_t       active_count, active_capacity;
    solid_hit   *hits;
    size_t       hit_capacity;
    solid_state *states; /* per item of the view; opened when needed */
    size_t       state_count;
} solid_covers;

solid_cover solid_cover_of(const stroke_view *v, uint32_t item, uint32_t face, double from, double to, double z_from,
                           double z_to);
bool        solid_covers_put(solid_covers *c, const solid_cover *cover);

/* Calls `step` for each position at which the number of surfaces in front changes, and by how much; at the end of what
 * is covered it is 0 again. Sorts the covers. False when memory is gone. */
typedef void (*solid_step)(void *user, double at, int32_t step);
bool solid_covers_count(solid_covers *c, const stroke_view *v, solid_step step, void *user);
void solid_covers_release(solid_covers *c);

#endif
