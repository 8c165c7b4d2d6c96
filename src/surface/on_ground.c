#include "surface/on_ground.h"

#include <string.h>

#include "surface/halftone/halftone.h"

static float luminance(colour c)
{
    return 0.2126f * c.r + 0.7152f * c.g + 0.0722f * c.b;
}

bool draws_ground(const void *values, colour ground)
{
    const halftone_values *v = values;
    /* What is transparent will lie on white. */
    float paper = luminance(ground) * ground.a + 1 - ground.a;
    return memcmp(&v->paper, &ground, sizeof ground) == 0 && luminance(v->ink) < paper;
}
