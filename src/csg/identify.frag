/* Whose surface lies at the depth that was found. */
#include "csg/operand.glsl"

layout(location = 0) out uvec4 out_surface;

void main()
{
    float depth = gl_FragCoord.z;
#ifdef SHARED_PLANES
    depth = fragment_depth();
    gl_FragDepth = depth;
#endif
    out_surface = uvec4(1u, floatBitsToUint(depth), fragment_key(), packed_normal());
}
