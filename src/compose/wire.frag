#include "compose/layered.glsl"

vec4 layer_fill(vec2 position)
{
    return vec4(0.0);
}

#ifdef HAS_LINES
vec4 layer_ink(vec4 ink)
{
    float fraction = u_softness > 0.0 ? clamp((ink.a - u_threshold) / u_softness + 0.5, 0.0, 1.0) : step(u_threshold, ink.a) * step(1e-6, ink.a);
    return ink.a > 0.0 ? ink * (fraction / ink.a) : ink;
}
#endif
