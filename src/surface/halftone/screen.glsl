/* Looking screens up so that their strokes are as wide and as dense on the page at any distance: mip levels by rates of change, and beyond the last ones the same screen
 * again at double and half size. Freudenberg 2003, section 6.1. */

/* One of the sizes in which a screen is laid. */
struct screen_octave {
    float scale;  /* texture coordinates to a unit of the plane's */
    float level;  /* of the mip chain */
    float weight; /* both sizes' add up to 1 */
};

/* `texels`: side of the finest picture; `texel`: pixels on the page that one shall take; `least`: the smallest power of two by which the screen may be repeated. */
float screen_level(stroke_plane s, float texels, float texel)
{
    float area = abs(s.right.x * s.up.y - s.right.y * s.up.x);
    float longest = max(dot(s.right, s.right), dot(s.up, s.up));
    /* By area, so that as much ink stays where a surface tilts; but not finer than a quarter of the longer side. */
    return 0.5 * log2(max(max(area, longest / 16.0) * texels * texels * texel * texel, 1e-30));
}

/* `similar`: a level is the one before, half as large, so that sizes hand over without anything to be seen. */
screen_octave octave_of(stroke_plane s, float level, int which, float least, bool similar)
{
    float low = max(-floor(level), least);
    float rest = level + low; /* 0 … 1, or more where the screen may not be larger */
    float over = low > least && !similar ? smoothstep(0.25, 1.0, rest) : 0.0;
    return which == 0 ? screen_octave(exp2(low), rest, 1.0 - over)
                      : screen_octave(exp2(low - 1.0), max(rest - 1.0, 0.0), over);
}
