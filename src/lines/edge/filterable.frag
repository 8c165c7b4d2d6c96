/* Unit normals and normalised depth in 16-bit floats: 32-bit ones may have no filter. */
#include "lines/edge/edge.glsl"

void main()
{
    vec4 value = texel(t_normal_depth, ivec2(gl_FragCoord.xy));
    vec3 normal = value.xyz * inversesqrt(max(dot(value.xyz, value.xyz), 1e-12));
    out_edge = vec4(normal, normalised(value.w));
}
