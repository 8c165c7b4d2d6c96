/* The ground that the model stands on, and how dark it is: src/frame/ground.c. */
#include "light/ground_plane.glsl"
uniform sampler2D t_ground_map;
uniform mat4      u_ground_from_eye; /* to 0 … 1 over the map */
uniform vec2      u_ground_tone;     /* darkness where it is touched; 1: flat, with a border */

const float BORDER = 0.3; /* of a flat shadow */

/* At a position of the map; `there`: 1, or 0 where the ray does not meet the ground. */
float ground_darkness_at(vec2 at, float there)
{
    vec2 edge = abs(2.0 * at - 1.0);
    float inside = there * (1.0 - smoothstep(0.9, 1.0, max(edge.x, edge.y)));
    float shade = min(textureLod(t_ground_map, at, 0.0).r, 1.0) * inside;
    if (u_ground_tone.y > 0.5)
        shade = clamp((shade - BORDER) / max(fwidth(shade), 1e-5) + 0.5, 0.0, 1.0);
    return shade * u_ground_tone.x;
}

float ground_darkness(vec4 eye)
{
    return ground_darkness_at((u_ground_from_eye * vec4(eye.xyz, 1.0)).xy, eye.w);
}
