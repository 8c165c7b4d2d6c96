/* The nearest fragment behind the one that was taken last, by depth and then by key; pixels that have found their surface wait. Depths are
 * fractions of the range between the clip planes, the same numbers in the picture and in the depth buffer. */
#include "csg/operand.glsl"

uniform usampler2D t_state; /* depth and key of the last fragment; owner */
uniform usampler2D t_found;
uniform float u_solid_range; /* from the near to the far plane */
layout(location = 0) out uvec4 out_fragment;

void main()
{
    ivec2 at = ivec2(gl_FragCoord.xy);
#ifdef AROUND_EYE
    /* From the eye to infinity, and none like another: every fragment counts. */
    float depth_here = max(fragment_depth(), 0.0), fraction = depth_here / (depth_here + u_solid_range);
#else
    float fraction = max(fragment_depth() - u_solid_near, 0.0) / u_solid_range;
    if (fraction >= 1.0)
        discard;
#endif
    uint depth = floatBitsToUint(fraction), key = fragment_key();
    uvec4 last = texelFetch(t_state, at, 0);
    bool behind = depth > last.x || (depth == last.x && key > last.y);
    if (!behind || texelFetch(t_found, at, 0).z != 0u)
        discard;
    gl_FragDepth = fraction;
    out_fragment = uvec4(1u, depth, key, packed_normal());
}
