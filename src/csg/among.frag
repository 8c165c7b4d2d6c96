/* Surfaces among those that are there: their depth, or only whether there are any. */
#include "csg/depth.glsl"

uniform usampler2D t_surfaces;
#ifndef COUNTED
layout(location = 0) out uvec4 out_surface;
#endif

void main()
{
    uvec4 surface = texelFetch(t_surfaces, ivec2(gl_FragCoord.xy), 0);
    if (surface.z == 0u)
        discard;
#ifndef COUNTED
    gl_FragDepth = clamp(window_depth_at(eye_depth_of(surface.y)), 0.0, 1.0);
    out_surface = surface;
#endif
}
