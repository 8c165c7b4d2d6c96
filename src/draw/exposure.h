/* Pictures of several times, averaged: what the motion technique `accumulate` asks for. */
#ifndef LIMNER_DRAW_EXPOSURE_H
#define LIMNER_DRAW_EXPOSURE_H

#include "draw/session.h"

/* What is exposed in a plan. */
typedef struct exposure {
    const technique *technique; /* NULL: nothing, or nothing moves */
    void            *values;    /* of it */
    double           seconds;
    int              times;
    double          *ago;     /* how many seconds before the time that is drawn each picture is, oldest first */
    telling_moments  telling; /* where moments are chosen */
    bool            *moves;   /* per part, then per ghost */
    bool            *goes;    /* the same: what is elsewhere, or has another shape, at one of these times */
} exposure;

/* Errors: LMN_USAGE (rules that ask for different exposures), LMN_MEMORY. Release it also after one. */
lmn_status exposure_find(exposure *out, const plan *p, lmn_error *error);
void       exposure_release(exposure *e);

/* Settles the moments first. Draws instead of `s`, which is open for the last time of them and is closed. `finish` is
 * called with the session of that time once its picture is there. Errors: those of session_open, LMN_CANCELLED. */
typedef lmn_status (*exposure_finish_fn)(session *s, void *user, lmn_error *error);
lmn_status exposure_draw(exposure *e, session *s, const lmn_look *look, const draw_options *options,
                         exposure_finish_fn finish, void *user, lmn_error *error);

#endif
