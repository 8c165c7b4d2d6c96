/* Colours: sRGB with straight alpha wherever people write them and on pages; light, which is linear, where something is
 * lit. */
#ifndef LIMNER_BASE_COLOUR_H
#define LIMNER_BASE_COLOUR_H

#include <stdbool.h>

/* sRGB-encoded, straight alpha, 0 … 1. */
typedef struct colour {
    float r, g, b, a;
} colour;

/* Parses "#rgb", "#rgba", "#rrggbb", "#rrggbbaa", a CSS basic colour name, or "none" (transparent black). */
bool colour_parse(const char *text, colour *out);
/* "#rrggbb", or "#rrggbbaa" when not opaque; `out` holds 10 characters. */
void  colour_print(colour c, char out[10]);
float colour_to_linear(float encoded);
float colour_from_linear(float linear);

#endif
