/* Marks' ink for a darkness, and the darkness of their ink: marks/marks_law.c, whose results these are (tests/engine/twins_test.c). */

/* Fraction of its size that a mark of this rank has when `fraction` of all are wanted, and those that are there may grow to `most`; `fade`: ramp. */
float ink_of_rank(float rank, float fraction, float most, float fade)
{
    float ramp = fade * fraction, low = fraction - ramp, high = fraction + ramp;
    float own = ramp > 0.0 ? clamp((high - rank) / (2.0 * ramp), 0.0, 1.0) : 0.0;
    float all = low >= 1.0 ? 1.0 : high <= 1.0 ? fraction : low + (high * (1.0 - low) - 0.5 * (1.0 - low * low)) / (2.0 * ramp);
    return own * clamp(fraction / max(all, 1e-20), 1.0, most);
}

/* Sum of the areas of what is spread evenly and covers this fraction of the page, and of dots of this diameter, whose rims lie over each other. */
float ink_spread_evenly(float cover)
{
    float c = min(cover, 0.98), over = max(c - 0.311, 0.0);
    return c + 0.156 * over * over / (1.08 - c);
}

float ink_of_cover(float cover, float diameter)
{
    float c = min(cover, 0.98), ink = ink_spread_evenly(c);
    return ink + min(0.56 * c / (diameter * diameter), 1.0) * (-log(1.0 - c) - ink);
}

/* What strokes side by side with this ink cover; and the ink of all sets for a darkness, each as far as its own strokes go. `span`: of each set's priorities, 0: there are no sets; `crowded`: from side by side, 0, to strewn at random, 1. */
float cover_of_ink(float ink)
{
    float v = ink - 0.311, sum = v + 0.769;
    return v <= 0.0 ? ink : 0.311 + (sum - sqrt(sum * sum - 2.5961 * v)) / 1.688;
}

float ink_of_strokes(float darkness, float darkest, float span, float crowded)
{
    float wanted = max(1.0 - darkness, 1e-4), bare = 1.0, ink = 0.0, most = cover_of_ink(darkest * span);
    if (span <= 0.0)
        return -log(wanted);
    for (int set = 0; set < 4; set++) {
        float c = float(set) * span < 0.99 ? min(clamp(1.0 - wanted / bare, 0.0, 1.0), most) : 0.0, even = ink_spread_evenly(c);
        ink += even + crowded * (-log(max(1.0 - c, 1e-3)) - even);
        bare *= 1.0 - c;
    }
    return ink;
}
