/* The ground that the model stands on, and how dark it is: src/frame/ground.c. */
uniform sampler2D t_ground_map;
uniform mat4      u_ground_from_eye; /* to 0 … 1 over the map */
uniform vec4      u_ground_plane;    /* eye space: unit normal to the viewer's side, distance along it */
uniform vec2      u_ground_tone;     /* darkness where it is touched; 1: flat, with a border */

const float BORDER = 0.3; /* of a flat shadow */

/* Where the pixel's ray meets the ground; w: 1, or 0 where it does not. */
vec4 on_ground(vec2 pixel)
{
    vec2 ndc = 2.0 * pixel / u_size - 1.0;
    vec3 origin = u_perspective > 0.5 ? vec3(0.0) : vec3(ndc * u_unproject, 0.0), ray = u_perspective > 0.5 ? vec3(ndc * u_unproject, -1.0) : vec3(0.0, 0.0, -1.0);
    float falls = dot(u_ground_plane.xyz, ray);
    float along = (u_ground_plane.w - dot(u_ground_plane.xyz, origin)) / min(falls, -1e-6);
    return vec4(origin + ray * along, falls < 0.0 && (along > 0.0 || u_perspective < 0.5) ? 1.0 : 0.0);
}

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
