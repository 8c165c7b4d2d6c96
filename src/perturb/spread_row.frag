/* Spreads what surfaces say, along rows. */
#include "perturb/spread.glsl"
layout(location = 0) out vec4 out_0;

void main()
{
    out_0 = spread_along(t_traces, gl_FragCoord.xy, vec2(1.0, 0.0));
}
