/* Automatic exposure: which of the tones that a figure has are drawn as paper, and which as the darkest that a medium
 * can. */
#ifndef LIMNER_PLAN_TONE_RANGE_H
#define LIMNER_PLAN_TONE_RANGE_H

#include "plan/camera.h"
#include "plan/plan.h"

/* A tone t is drawn as ((t − low) · gain)^gamma, within 0 … 1. */
typedef struct tone_range {
    bool  automatic;
    float low, gain, gamma;
} tone_range;

/* Of tones that look like this: `count` of each of TONE_BINS from 0 to 1. Where there are none all stays. */
enum { TONE_BINS = 256 };
tone_range tone_range_of(const uint32_t counts[TONE_BINS]);

/* From what light and the model's own colours do on the surfaces that the view shows, on the CPU. The model counts at
 * rest and the view by its direction alone, so that nothing flickers while things move. Shadows do not count: they may
 * be as dark as the medium goes. Errors: LMN_MEMORY, and that of work that is to stop. */
lmn_status tone_range_find(tone_range *out, const plan *p, const view_camera *camera, lmn_error *error);

#endif
