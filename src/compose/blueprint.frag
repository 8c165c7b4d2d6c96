#include "compose/layered.glsl"

vec4 layer_fill(vec2 position)
{
    return vec4(u_tint.rgb, 1.0) * (u_tint.a * u_tint_opacity);
}

#ifdef HAS_LINES
vec4 layer_ink(vec4 ink)
{
    return ink;
}
#endif
