/* The shadow on the ground as a tone. */
#include "light/ground.glsl"

uniform vec4 u_ground_colour;
layout(location = 0) out vec4 out_0;

void main()
{
    out_0 = vec4(u_ground_colour.rgb, 1.0) * (u_ground_colour.a * ground_darkness(on_ground(gl_FragCoord.xy)));
}
