/* The field of uncertainty: what the surfaces say, and beside them what their surroundings say. */
layout(location = 0) out vec4 out_0;
#if OUTWARD == 0
#include "perturb/spread.glsl"
#endif

void main()
{
    vec4 own = texelFetch(t_traces, ivec2(gl_FragCoord.xy), 0);
#if OUTWARD == 0
    /* Its own say counts once more, so that where it is doubtful the surroundings decide. */
    own = own * own.a * 0.5 + spread_along(t_traces_row, gl_FragCoord.xy, vec2(0.0, 1.0));
    out_0 = vec4(own.rgb / (own.a + 1e-9), 1.0);
#else
    /* Nienhaus 2005, section 6.7: outside the enlarged model there is no uncertainty. */
    out_0 = vec4(own.rgb, 1.0);
#endif
}
