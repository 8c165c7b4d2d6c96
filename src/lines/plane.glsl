/* Window depth grows by this from pixel to pixel, on the plane with this normal. */
vec2 slope_of(vec4 normal_depth, vec2 at)
{
    vec4 m = u_window_depth;
    float depth = normal_depth.w, scale = m.w - m.z * depth;
    float window_of_eye = 0.5 * abs(m.z * m.y - m.x * m.w) / (scale * scale);
    vec3 ray = vec3((2.0 * at * u_texel - 1.0) * u_unproject * u_perspective, -1.0);
    vec2 pixel = 2.0 * u_unproject * u_texel * mix(1.0, depth, u_perspective);
    float facing = dot(normal_depth.xyz, ray);
    return -normal_depth.xy * pixel * window_of_eye / (abs(facing) < 1e-4 ? 1e-4 : facing);
}
