/* Sobel magnitude of the unlit colour, largest over its channels, in sRGB-like units so that dark tones count as the eye sees them. */
#include "lines/edge/edge.glsl"

vec3 painted(int x, int y)
{
    return sqrt(max(texel(t_albedo, ivec2(gl_FragCoord.xy) + ivec2(x, y)).rgb, vec3(0.0)));
}

void detect_edges()
{
    vec3 a = painted(-1, 1), b = painted(0, 1), c = painted(1, 1);
    vec3 d = painted(-1, 0), e = painted(1, 0);
    vec3 f = painted(-1, -1), g = painted(0, -1), h = painted(1, -1);
    vec3 across = c + 2.0 * e + h - a - 2.0 * d - f;
    vec3 up = a + 2.0 * b + c - f - 2.0 * g - h;
    vec3 size = 0.25 * sqrt(across * across + up * up);
    float ink = max(size.r, max(size.g, size.b)) * u_line_contour_contrast;
    write_edges(1.0, 1.0 - ink, 1.0);
}
