/* A piece of an engraved line. Whether it is hidden is asked at its axis, so that its own surface does not cut its sides off. Pieces end straight across, so that where two meet nothing is inked twice. */

flat in vec3 v_normal;
flat in vec4 v_ends, v_depths;
in float v_half_width;

layout(location = 0) out vec4 out_shade;

vec3 ray_of(vec2 pixel)
{
    return vec3((2.0 * pixel / u_size - 1.0) * u_unproject, -1.0);
}

/* Depth of the line's surface, which has this depth at its axis, in the middle of a pixel beside it. */
float depth_beside(float depth, vec2 axis, vec2 middle)
{
    vec3 ray = ray_of(axis), beside = ray_of(middle);
    if (u_perspective > 0.5)
        return depth * clamp(dot(v_normal, ray) / min(dot(v_normal, beside), -1e-3), 0.5, 2.0);
    return depth + dot(v_normal.xy, beside.xy - ray.xy) / max(v_normal.z, 0.02);
}

void main()
{
    vec2 chord = v_ends.zw - v_ends.xy, from = gl_FragCoord.xy - v_ends.xy;
    float size = max(length(chord), 1e-3), along = dot(from, chord) / size, off = abs(from.x * chord.y - from.y * chord.x) / size;
    float at = clamp(along / size, 0.0, 1.0), depth = mix(v_depths.x, v_depths.y, at), tolerance = v_depths.z;
    if (u_perspective > 0.5) {
        depth = 1.0 / depth;
        tolerance *= depth;
    }
    vec2 axis = v_ends.xy + at * chord, pixel = clamp(floor(axis), vec2(0.0), u_size - 1.0); /* of lines whose axis is off the page, the nearest one on it */
    vec4 seen = texelFetch(t_normal_depth, ivec2(pixel), 0);
    depth = depth_beside(depth, axis, pixel + 0.5);
    float half_width = max(v_half_width, 0.0);
    float reach = clamp(half_width - 0.25, 0.0, 0.5); /* where two wide pieces meet no seam is left, where thin ones do nothing is inked twice */
    float cover = clamp(min(along, size - along) + reach + 0.5, 0.0, 1.0) * clamp(half_width + 0.5 - off, 0.0, min(2.0 * half_width, 1.0));
    /* Far from its own depth only what is turned as it is can be its surface. */
    float like = dot(seen.xyz, v_normal);
    cover *= step(abs(seen.w - depth), tolerance * clamp(2.0 * like, 0.15, 1.0));
    out_shade = vec4(u_ink.rgb, 1.0) * (u_ink.a * cover);
}
