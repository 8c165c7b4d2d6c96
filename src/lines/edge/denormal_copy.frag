/* Normals, signed and of unit length, in a picture that can be filtered; with DEPTH the depth as the angle of a unit vector in
 * the plane of the blue and the alpha channel. */
#include "lines/edge/edge.glsl"

void main()
{
    vec4 value = texel(t_normal_depth, ivec2(gl_FragCoord.xy));
    vec3 normal = value.xyz * inversesqrt(max(dot(value.xyz, value.xyz), 1e-12));
    out_edge = vec4(normal, normalised(value.w));
}
