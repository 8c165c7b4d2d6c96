/* Whose surface lies at the depth that was found. */
#include "csg/operand.glsl"
#ifdef SHARED_PLANES
#include "csg/window.glsl"
#endif

#ifdef AMONG_OTHERS
uniform sampler2D t_before; /* depth of the products before */
#endif
layout(location = 0) out uvec4 out_surface;

void main()
{
    float depth = gl_FragCoord.z;
#ifdef SHARED_PLANES
    depth = gl_FragDepth = window_depth();
#endif
    /* 1 says that nothing is there, and what lies behind the far plane is drawn at it. */
    if (depth >= 1.0)
        discard;
#ifdef AMONG_OTHERS
    if (depth >= texelFetch(t_before, ivec2(gl_FragCoord.xy), 0).r)
        discard;
#endif
    out_surface = uvec4(1u, stored_at(fragment_depth()), fragment_key(), packed_normal());
}
