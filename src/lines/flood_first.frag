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
#ifdef HAS_FEET
    float least = 0.004;
#else
    float least = 0.4; /* what is fainter would hide what is not */
#endif
    out_0 = uvec4(ink.x > least ? 0u : NO_SEED, ink.y > least ? 0u : NO_SEED, ink.z > least ? 0u : NO_SEED, 0u);
}
