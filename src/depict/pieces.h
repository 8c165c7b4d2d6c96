/* Things below one node that move each by itself. */
#ifndef LIMNER_DEPICT_PIECES_H
#define LIMNER_DEPICT_PIECES_H

#include "depict/depict_private.h"

enum { PIECES_MOST = 64 };

typedef struct pieces {
    depict_target items[PIECES_MOST];
    size_t        count;
} pieces;

/* The nodes right below one that have parts and that something moves; where that node has but one such child, those
 * below it. Errors: LMN_MEMORY. Release it also after one. */
lmn_status pieces_open(pieces *out, const depict_job *j, int32_t node, lmn_error *error);
void       pieces_release(pieces *p);
/* Where the middle of one is. */
void piece_at(const pieces *p, size_t i, double seconds, double out[3]);
/* How far, at a time, any two are from where they would be if they went together since `from`. */
double pieces_spread(const pieces *p, double from, double seconds);
/* When they part: the last time at which the spread is at most `apart`. */
double pieces_parting(const pieces *p, double from, double to, double apart);

#endif
