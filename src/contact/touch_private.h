/* What the files of touch share: surfaces in pieces, and what has been found of their meeting. */
#ifndef LIMNER_CONTACT_TOUCH_PRIVATE_H
#define LIMNER_CONTACT_TOUCH_PRIVATE_H

#include "contact/touch.h"
#include "contact/turned.h"

/* An instance of a primitive as it is in a pose. */
typedef struct touch_piece {
    size_t part;
    double (*vertices)[3];   /* in the world; owned */
    const uint32_t *indices; /* 3 a triangle; lent */
    uint32_t        vertex_count, index_count;
    int       outward; /* by winding: 1 or -1 where its triangles close, so that one side of them is outside; else 0 */
    bool      is_sphere;
    double    centre[3], radii[3][3]; /* then: where the unit sphere's axes go */
    bool      is_turned;
    turned    turned; /* then, in the axes of its mesh */
    mat4      world;  /* and where that is */
    uint32_t *made;   /* indices that are its own */
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

/* Where a piece is met, and the way from it to what it meets there, unit. */
typedef struct touch_met {
    double place[3], facing[3];
} touch_met;

/* lathe.c: a cylinder or cone that something comes to along a direction, or that comes to it, with vertices at all
 * angles at which both can meet first; with `met` (or NULL) at that angle alone, and evenly away from it. Empty where
 * it is to be met as the mesh that it is. Release with touch_lathe_release. Errors: LMN_MEMORY. */
lmn_status touch_lathe(touch_piece *out, const touch_piece *own, const touch_piece *other, const double along[3],
                       double within, const touch_met *met, lmn_error *error);
void       touch_lathe_release(touch_piece *p);

/* The middle of the places, one at least, that have this normal, unit: of the area between them, of a line, of a point.
 * Errors: LMN_MEMORY. */
lmn_status touch_middle(const touch_places *all, const double normal[3], double out[3], lmn_error *error);

#endif
