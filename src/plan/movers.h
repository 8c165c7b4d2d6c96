/* Movers: what of a plan's figures moves on the page, each object by itself, so that techniques of motion can fade and
 * smear it without what stands beside it. */
#ifndef LIMNER_PLAN_MOVERS_H
#define LIMNER_PLAN_MOVERS_H

#include "plan/camera.h"
#include "plan/plan.h"

/* The camera now and at the steps of the pose's past, and the page. */
typedef struct movers_view {
    const view_camera *now, *past; /* past: as many as the pose has */
    int                width, height;
    double             least; /* pixels: what moves less far is at rest */
} movers_view;

/* How many steps of the past the look's techniques read; 0: none draws movers. */
int movers_steps(const lmn_look *look);

/* Takes the parts that move out of figures whose rules draw movers, and adds a figure for each object: the parts below
 * the uppermost node that moves; what only the camera moves together is one. Figures without parts end. Errors:
 * LMN_MEMORY. */
lmn_status plan_split_movers(plan *p, const movers_view *view, warnings *warnings, lmn_error *error);

#endif
