/* Sobel gradients from bilinear samples, magnitude over both directions: R depth, G normals. The sampler's filter
 * does the sums, on depth and the three normal components at once.
 * five:  means of 2x2 blocks at the corners; Gx = 4 (TR + BR − TL − BL), Gy = 4 (TL + TR − BL − BR) hold exactly.
 * eight: p' = 2 (t2 + t3 − t0 − t1) with samples between two texels, once for each direction. */
#define FINDS_MEETINGS
#include "lines/edge/edge.glsl"

vec4 at(vec2 off)
{
    return textureLod(t_filtered, (gl_FragCoord.xy + off) * u_texel, 0.0);
}

void main()
{
    vec4 across, up;
#if TAPS == 0
    vec4 top_left = at(vec2(-0.5, 0.5)), top_right = at(vec2(0.5, 0.5));
    vec4 bottom_left = at(vec2(-0.5, -0.5)), bottom_right = at(vec2(0.5, -0.5));
    across = 4.0 * (top_right + bottom_right - top_left - bottom_left);
    up = 4.0 * (top_left + top_right - bottom_left - bottom_right);
#else
    across = 2.0 * (at(vec2(1.0, -0.5)) + at(vec2(1.0, 0.5)) - at(vec2(-1.0, -0.5)) - at(vec2(-1.0, 0.5)));
    up = 2.0 * (at(vec2(-0.5, 1.0)) + at(vec2(0.5, 1.0)) - at(vec2(-0.5, -1.0)) - at(vec2(0.5, -1.0)));
#endif
    float depth = length(vec2(across.w, up.w));
    float normal = length(vec2(length(across.xyz), length(up.xyz)));
    write_edges(1.0 - 0.25 * depth, 1.0 - 0.25 * normal, 1.0);
}
