/* Papers as height fields that repeat without a seam, and what a pencil that is rubbed over them finds. Müller,
 * section 2.3; row P28. */
#ifndef LIMNER_HALFTONE_PAPER_H
#define LIMNER_HALFTONE_PAPER_H

#include "base/mip_chain.h"

typedef enum paper_kind {
    PAPER_NONE,
    PAPER_SMOOTH,  /* pressed hot: hardly any tooth */
    PAPER_DRAWING, /* the fine tooth of felted fibres */
    PAPER_ROUGH,   /* pressed cold: pits and hills with a finer tooth on them */
    PAPER_LAID,    /* ribs of the mould's wires, and chain lines across them */
    PAPER_CANVAS,  /* threads over and under each other */
    PAPER_COUNT
} paper_kind;
extern const char *const paper_names[PAPER_COUNT + 1]; /* NULL-terminated */

enum {
    PAPER_SIDE = 1024,       /* texels of a sheet's side */
    PAPER_TEXELS_A_GRAIN = 4 /* hardly anything is finer than one of these, so that sheets of small grain may be looked
                                up a few texels apart */
};

/* A sheet: heights 0 … 1, of which each tenth covers a tenth of the sheet; the steepness of its flanks goes with
 * its relief. */
typedef struct paper {
    paper_kind kind;
    uint32_t   seed;
    float     *heights; /* PAPER_SIDE², row 0 at the bottom; owned */
} paper;

/* The same kind and seed give the same sheet. Errors: LMN_MEMORY. `kind` is not PAPER_NONE. */
lmn_status paper_create(paper *out, paper_kind kind, uint32_t seed, lmn_error *error);
void       paper_release(paper *p);

/* The unit normal of a texel, normalise(−k ∂h/∂x, −k ∂h/∂y, 1); k is the paper's own. */
void paper_normal(const paper *p, int x, int y, float out[3]);

/* What shaders need, RG8, one level. Red, contact: how early a pencil touches the position, from its height and from
 * how far its normal leans towards the stroke; again each tenth of it covers a tenth of the sheet. Green: light of
 * the bare sheet from the upper left, 1/2 where it is level. The fact is the paper's depth, 0 … 1: how much of its
 * valleys a pencil leaves out. Errors: LMN_MEMORY. */
lmn_status paper_texture(mip_chain *out, const paper *p, lmn_error *error);

#endif
