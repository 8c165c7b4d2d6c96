/* How much of a pixel lies on one side of a straight edge, and inside a line. Exact for the pixel's square: a ramp across one pixel is wrong by up to 4.4 % at edges and by 8.6 %
 * at lines no wider than a pixel. */

/* Fraction of a pixel in the half-plane whose border is `d` before its middle (negative: behind it), with this unit normal. */
float half_plane(float d, vec2 normal)
{
    vec2 n = abs(normal);
    float a = max(n.x, n.y), b = min(n.x, n.y), e = abs(d), rim = 0.5 * (a + b) - e;
    float inside = rim <= 0.0 ? 1.0 : rim >= b ? 0.5 + e / a : 1.0 - rim * rim / (2.0 * a * b);
    return d < 0.0 ? 1.0 - inside : inside;
}

/* Fraction of a pixel in a line whose axis is `d` away. */
float line_cover(float d, vec2 normal, float half_width)
{
    return half_plane(d + half_width, normal) - half_plane(d - half_width, normal);
}
