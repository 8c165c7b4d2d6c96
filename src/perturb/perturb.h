/* The kind "perturb": how exactly things are drawn. A technique moves the places where a figure's maps are looked
 * up. */
#ifndef LIMNER_PERTURB_PERTURB_H
#define LIMNER_PERTURB_PERTURB_H

#include "technique/technique.h"

extern const kind kind_perturb;

extern const technique perturb_uncertainty, perturb_pencil;

/* A hand that sways, restates lines and presses unevenly, as strokes are drawn by it. Lengths are pixels. */
typedef struct hand {
    float   sway, length; /* how far lines leave their way; of its waves */
    float   pressure;     /* 0 … 1: how much the weight varies */
    int32_t copies;       /* of each line */
    float   jitter;       /* how far they lie apart */
} hand;
void hand_draw(struct stroke_style *style, const hand *h);

/* The drawing's seed for strokes: what boils is drawn anew with each of its steps. */
uint32_t hand_seed(const perturbation *p, const void *values, uint32_t seed, double time_s);

#endif
