/* Spreads what surfaces say, along rows. */
#include "perturb/spread.glsl"
layout(location = 0) out vec4 out_0;

void main()
{
    out_0 = spread_along(t_traces, ivec2(gl_FragCoord.xy), ivec2(1, 0));
}
