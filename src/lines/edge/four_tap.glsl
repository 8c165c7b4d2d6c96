/* I_Z = (1 − ½|A−H|)² (1 − ½|C−F|)², I_N = ½ (n(A)·n(H) + n(C)·n(F)). Samples lie half the width off centre: whole offsets
 * need one texel each, others are bilinear, which is what smooths the line. */
#define OWN_WIDTH
#define FINDS_MEETINGS
#include "lines/edge/edge.glsl"

vec4 tap(vec2 off)
{
    vec4 value = vec4(0.0);
    /* Loops instead of branches: software drivers skip these, and the bilinear sample costs four texels. */
    int whole = fract(off.x) == 0.0 ? 1 : 0;
    for (int once = 0; once < whole; once++)
        value = texel(t_normal_depth, ivec2(gl_FragCoord.xy + off));
    for (int once = whole; once < 1; once++)
        value = bilinear(t_normal_depth, gl_FragCoord.xy + off);
    return value;
}

void detect_edges()
{
    float off = 0.5 * min(u_line_width, 2.0);
    vec4 a = tap(vec2(-off, off)), c = tap(vec2(off, off)), f = tap(vec2(-off, -off)), h = tap(vec2(off, -off));
    float ah = 1.0 - 0.5 * abs(normalised(a.w) - normalised(h.w));
    float cf = 1.0 - 0.5 * abs(normalised(c.w) - normalised(f.w));
    float profile = ah * cf;
#if SQUARED
    profile *= profile;
#endif
    float inner = 0.5 * (dot(normalize(a.xyz), normalize(h.xyz)) + dot(normalize(c.xyz), normalize(f.xyz)));
    write_edges(profile, inner, 1.0);
}
