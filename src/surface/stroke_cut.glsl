/* How lines are cut into strokes. */
#include "surface/halftone/noise.glsl"

/* Fraction of a stroke's width that is left at this position along its line: strokes end in tips, and are cut in two when they get too long. `along`: pixels a
 * unit; `grown`: fraction of its length that a stroke has yet. */
float stroke_fraction(float at, float along, uint key, float grown)
{
    float scale = 0.7 + 0.6 * number_of(key ^ 0x5bd1e995u);
    float pixels = along / scale;
    /* Cut in two at positions that are even over the octave, strokes are shorter than this by 1.75 in the mean. */
    float wanted = max(pixels / (1.75 * u_length) * power_of_rest(number_of(key * 2654435761u)), 1e-30);
    float cells = power_below(wanted), fraction = log_of_rest(wanted / cells - 1.0);
    /* A shift that halves of strokes inherit: its binary digits repeat after 32 octaves. */
    int turns = (floatBitsToInt(cells) >> 23) + 1 & 31;
    uint digits = key << turns | key >> (32 - turns & 31);
    float inside = fract(at * scale * cells + number_of(digits)), size = pixels / cells;
    float to_old = min(inside, 1.0 - inside) * size, to_new = abs(inside - 0.5) * size;
    float to_end = min(to_old - 0.5 * u_gap, mix(size, to_new - 0.5 * u_gap, smoothstep(0.0, 0.5, fraction)));
    to_end -= (1.0 - grown) * size * mix(0.5, 0.25, fraction);
    return clamp(to_end / max(u_taper, 0.75), 0.0, 1.0);
}
