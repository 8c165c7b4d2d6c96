/* Takes the ink of lines that run on into the edge map, so that it grows and is dashed as theirs. See lines/overshoot.h. */
#include "lines/lines.glsl"
layout(location = 0) out vec4 out_0;

void main()
{
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    vec4 edge = texelFetch(t_lines, pixel, 0);
    uint packed_ink = texelFetch(t_overshoot, pixel, 0).r;
    vec3 left = 1.0 - vec3(uvec3(packed_ink, packed_ink >> 8, packed_ink >> 16) & 255u) / 255.0;
    out_0 = min(edge, vec4(left.r, left.g, left.r * left.g, left.b));
}
