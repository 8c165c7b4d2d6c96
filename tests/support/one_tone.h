/* What makes a look draw one tone on all surfaces, whatever their colour, and nothing else: changes as shot_of_shape
 * takes them. */
#ifndef TRUTH_ONE_TONE_H
#define TRUTH_ONE_TONE_H

#include <stdio.h>

typedef struct one_tone {
    char        text[32];
    const char *changes[17];
} one_tone;

/* `without`: a parameter that shall be 0, too, or NULL. */
static inline void one_tone_set(one_tone *out, double tone, const char *without)
{
    static const char *const rest[] = {"surface.texture", "0",    "scene.ground",      "none",
                                       "lines.operator",  "none", "perturb.technique", "none"};
    const char             **at = out->changes;
    snprintf(out->text, sizeof out->text, "%.9g", tone);
    *at++ = "surface.shadow";
    *at++ = out->text;
    *at++ = "surface.light";
    *at++ = out->text;
    for (size_t i = 0; i < sizeof rest / sizeof *rest; i++)
        *at++ = rest[i];
    *at++ = without;
    *at++ = "0";
    *at = NULL;
}

#endif
