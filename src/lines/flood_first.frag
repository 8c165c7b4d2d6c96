/* Pixels that have ink are their own nearest. */
#include "lines/seed.glsl"
#ifdef HAS_THIN
#define t_found t_thin
#else
#define t_found t_edge
#endif
layout(location = 0) out uvec4 out_0;

void main()
{
    vec3 ink = 1.0 - texelFetch(t_found, ivec2(gl_FragCoord.xy), 0).rga;
    out_0 = uvec4(ink.x > 0.004 ? 0u : NO_SEED, ink.y > 0.004 ? 0u : NO_SEED, ink.z > 0.004 ? 0u : NO_SEED, 0u);
}
