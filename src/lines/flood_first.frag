/* Pixels that have ink are their own nearest. */
#include "lines/seed.glsl"
layout(location = 0) out uvec4 out_0;

void main()
{
    vec3 ink = 1.0 - texelFetch(t_edge, ivec2(gl_FragCoord.xy), 0).rga;
    out_0 = uvec4(ink.x > 0.004 ? 0u : NO_SEED, ink.y > 0.004 ? 0u : NO_SEED, ink.z > 0.004 ? 0u : NO_SEED, 0u);
}
