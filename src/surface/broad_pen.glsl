/* Strokes of a broad pen over the page: side by side, each a little over the one before, in lengths that a hand draws at once. */
#include "gpu/hash.glsl"
#include "surface/halftone/noise.glsl"

const vec2  PEN_ALONG = vec2(0.7986, 0.6018);
const float PEN_APART = 0.9;  /* from stroke to stroke, in their width */
const float PEN_LENGTH = 9.0; /* of the longest, in their width */
const float PEN_SLANT = 0.9;   /* of its tip: along over across */
const float PEN_FIBRES = 6.0;  /* in its width */
const float PEN_RAGGED = 0.8;  /* how unevenly they end, in its width */
const float PEN_GROUPS = 0.2;  /* how far what a hand leaves out hangs together */
const float UNTINTED = 0.55;   /* how much less light must fall on light grey before it is laid over */
const float PEN_ONCE = 0.62;   /* of the colour, what one stroke lays */

vec2 of_pen(int row, int piece)
{
    return corner_noise(hash_of(uvec3(uint(row + 0x8000), uint(piece + 0x8000), 0u), 5u));
}

/* How much farther a fibre of the pen draws, in widths: the tip is cut aslant, and fibres run dry one after the other. */
float drawn_farther(int row, float across)
{
    float fibre = floor((across + 1.0) * PEN_FIBRES), last = of_pen(row, int(fibre) + 64).x, next = of_pen(row, int(fibre) + 65).x;
    return PEN_SLANT * across + PEN_RAGGED * mix(last, next, smoothstep(0.0, 1.0, fract((across + 1.0) * PEN_FIBRES)));
}

/* What one row of strokes leaves of the paper. A stroke is there where it is darker than its own bound; its sides sway. */
float left_by(int row, vec2 at, float dark)
{
    float width = u_paper_strokes, own = of_pen(row, 0).x, across = at.y / width - PEN_APART * (float(row) + 0.5);
    float along = (at.x / width + drawn_farther(row, across)) / PEN_LENGTH + 0.5 * own, sway = 0.06 * sin(9.0 * along + 6.28 * own) + 0.08 * of_pen(row, 0).y;
    int   piece = int(floor(along)) + 1;
    vec2  random = of_pen(row, piece);
    float side = 0.5 - abs(across - sway), bound = 0.5 * (0.5 + 0.5 * random.x) - 0.3 + PEN_GROUPS * plane_noise(at / (7.0 * width), 91u).x;
    return 1.0 - PEN_ONCE * clamp(side * width + 0.5, 0.0, 1.0) * clamp((dark - bound) * 12.0 + 0.5, 0.0, 1.0);
}

/* How much of the colour lies here: 0 paper … 1 all of it. */
float broad_strokes(float dark)
{
    vec2 from = gl_FragCoord.xy - u_anchor, at = vec2(dot(from, PEN_ALONG), dot(from, vec2(-PEN_ALONG.y, PEN_ALONG.x)));
    int row = int(floor(at.y / (u_paper_strokes * PEN_APART)));
    float left = left_by(row, at, dark) * left_by(row - 1, at, dark) * left_by(row + 1, at, dark);
    /* Where it is dark, gone over once more. */
    left *= mix(1.0, left_by(row + 40, at + vec2(0.37 * u_paper_strokes * PEN_LENGTH, u_paper_strokes * PEN_APART * 40.0), dark - 0.62), 0.8);
    return 1.0 - left;
}
