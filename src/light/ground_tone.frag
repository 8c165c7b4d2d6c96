/* The shadow on the ground as a tone. */
#include "light/ground.glsl"

uniform vec4 u_ground_colour;
uniform mat3 u_ground_from_pixel; /* to the map, times what is divided by: above 0 where the ray meets the ground */
layout(location = 0) out vec4 out_0;

void main()
{
    vec3 at = u_ground_from_pixel * vec3(gl_FragCoord.xy, 1.0);
    out_0 = vec4(u_ground_colour.rgb, 1.0) * (u_ground_colour.a * ground_darkness_at(at.xy / max(at.z, 1e-20), at.z > 0.0 ? 1.0 : 0.0));
}
