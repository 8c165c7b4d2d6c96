/* The plane of the ground: src/frame/ground.c. */
uniform vec4 u_ground_plane; /* eye space: unit normal to the viewer's side, distance along it */

/* Where the pixel's ray meets the ground; w: 1, or 0 where it does not. */
vec4 on_ground(vec2 pixel)
{
    vec2 ndc = 2.0 * pixel / u_size - 1.0;
    vec3 origin = u_perspective > 0.5 ? vec3(0.0) : vec3(ndc * u_unproject, 0.0), ray = u_perspective > 0.5 ? vec3(ndc * u_unproject, -1.0) : vec3(0.0, 0.0, -1.0);
    float falls = dot(u_ground_plane.xyz, ray);
    float along = (u_ground_plane.w - dot(u_ground_plane.xyz, origin)) / min(falls, -1e-6);
    return vec4(origin + ray * along, falls < 0.0 && (along > 0.0 || u_perspective < 0.5) ? 1.0 : 0.0);
}
