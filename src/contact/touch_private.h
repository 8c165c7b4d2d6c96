/* What the files of touch share: surfaces in pieces, and what has been found of their meeting. */
#ifndef LIMNER_CONTACT_TOUCH_PRIVATE_H
#define LIMNER_CONTACT_TOUCH_PRIVATE_H

#include "contact/touch.h"

/* An instance of a primitive as it is in a pose. */
typedef struct touch_piece {
    size_t part;
    double (*vertices)[3];   /* in the world; owned */
    const uint32_t *indices; /* 3 a triangle; lent */
    uint32_t        vertex_count, index_count;
    int    outward; /* by winding: 1 or -1 where its triangles close, so that one side of them is outside; else 0 */
    bool   is_sphere;
    double centre[3], radii[3][3]; /* then: where the unit sphere's axes go */
} touch_piece;

/* A place at which two pieces can touch first. */
typedef struct touch_place {
    double own[3], normal[3], gap; /* as in `touch` */
    bool   of_face;                /* else of two edges */
} touch_place;

typedef struct touch_places {
    touch_place *items;
    size_t       count, capacity;
    double       first; /* how far it goes on before it meets the first one of them */
} touch_places;

/* One piece comes on towards another one. */
typedef struct touch_pair {
    const touch_piece *own, *other;
    double             along[3]; /* unit: the way that it comes */
    double             within;   /* how far it goes, and how far it may have gone too far */
    double             tie;      /* lengths that differ by less are the same */
} touch_pair;

/* A surface along which something glides is not met by it: the sine of the least angle. */
static const double TOUCH_STEEP = 0.05;

/* Puts a place there, and takes out those that are met later. Errors: LMN_MEMORY. */
lmn_status touch_keep(touch_places *all, const touch_place *one, double gone, double tie, lmn_error *error);

/* sweep.c: of two meshes. round.c: of a sphere, which is the pair's own piece, and a mesh or a sphere; `flips`: it is
 * the other thing that comes on. Errors: LMN_MEMORY, LMN_CANCELLED. */
lmn_status touch_sweep(touch_places *all, const touch_pair *pair, lmn_error *error);
lmn_status touch_round(touch_places *all, const touch_pair *pair, bool flips, lmn_error *error);

/* The middle of the places, one at least, that have this normal, unit: of the area between them, of a line, of a point.
 * Errors: LMN_MEMORY. */
lmn_status touch_middle(const touch_places *all, const double normal[3], double out[3], lmn_error *error);

#endif
