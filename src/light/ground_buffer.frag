/* The shadow on the ground as something to be shaded: position, normal, a part of its own, and beside the colour of paper the light that is left. */
#include "light/ground.glsl"

uniform uint u_ground_part;
const float  FAINTEST = 0.03; /* less is not drawn: a screen's least dots would end at a border */
layout(location = 0) out vec4  out_normal_depth;
layout(location = 1) out uvec4 out_id;
layout(location = 2) out vec4  out_albedo;

void main()
{
    vec4 eye = on_ground(gl_FragCoord.xy);
    float shade = ground_darkness(eye);
    shade = max(shade - FAINTEST, 0.0) / (1.0 - FAINTEST);
    if (shade <= 0.0)
        discard;
    out_normal_depth = vec4(u_ground_plane.xyz, -eye.z);
    out_id = uvec4(u_ground_part, 0u, 0u, 0u);
    out_albedo = vec4(1.0, 1.0, 1.0, 1.0 - shade);
}
