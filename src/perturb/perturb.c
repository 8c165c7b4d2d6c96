/* The table of techniques that perturb. */
#include "perturb/perturb.h"

#include <math.h>

#include "stroke/ribbon.h"

static const technique *const techniques[] = {&perturb_uncertainty, &perturb_pencil};

const kind kind_perturb = {
    .id = KIND_PERTURB,
    .name = "perturb",
    .doc = "How exactly lines and fills are drawn.",
    .techniques = techniques,
    .technique_count = PARAM_COUNT(techniques),
    .standard = NULL,
    .selector_key = "technique",
};

uint32_t hand_seed(const perturbation *p, const void *values, uint32_t seed, double time_s)
{
    return p->seed ? seed ^ p->seed(values, 0, time_s) ^ p->seed(values, 0, 0) : seed;
}

void hand_draw(stroke_style *style, const hand *h)
{
    enum { COPIES_MOST = 3 };
    static const float taper_fraction = 8; /* how many widths a sketched line takes to thin out */
    style->wobble = h->sway;
    style->wobble_length = fmaxf(h->length, 4);
    style->pressure = fminf(h->pressure, 1);
    if (h->copies > 1) {
        style->repeats = h->copies < COPIES_MOST ? h->copies : COPIES_MOST;
        style->repeat_apart = h->jitter + 0.5f;
        style->brush = BRUSH_PENCIL;
    }
    if (style->wobble > 0)
        style->taper = style->width * taper_fraction;
}
