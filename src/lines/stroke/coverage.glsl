/* How much of a pixel lies on one side of a straight edge: exact for the pixel as a square. `distance` is that of the pixel's middle from the edge, above 0 inside; `normal` is the edge's, of length 1.
 * What is between the corners that the edge passes first and last is a triangle, a trapezium, or the rest of one. The usual ramp clamp(distance + 0.5) is off by up to 4.4 %, for lines of a
 * pixel by 8.6 %. */
float half_plane_fraction(float distance, vec2 normal)
{
    vec2 size = abs(normal);
    float a = max(size.x, size.y), b = min(size.x, size.y), away = abs(distance);
    float inner = 0.5 * (a - b), outer = 0.5 * (a + b), left = outer - away;
    float corner = left * left / max(2.0 * a * b, 1e-12);
    float less = away <= inner ? 0.5 - away / a : left <= 0.0 ? 0.0 : corner;
    return distance < 0.0 ? less : 1.0 - less;
}

/* The same of a band around an axis: lines thinner than a pixel keep their area. */
float band_fraction(float distance, float half_width, vec2 normal)
{
    return clamp(half_plane_fraction(half_width - distance, normal) - half_plane_fraction(-half_width - distance, normal), 0.0, 1.0);
}
