/* A piece of an engraved line. Whether it is hidden is asked at its axis, so that its own surface does not cut its sides off. Pieces end straight across, so that where two meet nothing is inked twice. */

flat in vec3 v_normal;
flat in vec4 v_ends, v_depths; /* as in marks_lines.vert */
in float v_half_width;

const float AROUND = 1.25; /* pixels */
const float ANOTHER_FACE = 0.5; /* cosine between normals, of either side, below which it is one */

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

float depth_at(float at)
{
    float depth = mix(v_depths.x, v_depths.y, at);
    return u_perspective > 0.5 ? 1.0 / depth : depth;
}

/* Is the line's surface what is seen at its axis? */
float axis_seen(float at)
{
    vec2 axis = mix(v_ends.xy, v_ends.zw, at), pixel = clamp(floor(axis), vec2(0.0), u_size - 1.0); /* of lines whose axis is off the page, the nearest one on it */
    float depth = depth_at(at), tolerance = v_depths.z * (u_perspective > 0.5 ? depth : 1.0);
    vec4 seen = texelFetch(t_normal_depth, ivec2(pixel), 0);
    /* Far from its own depth only what is turned as it is can be its surface. */
    return step(abs(seen.w - depth_beside(depth, axis, pixel + 0.5)), tolerance * clamp(2.0 * dot(seen.xyz, v_normal), 0.15, 1.0));
}

/* Is it seen there, as most of the axis around says? Where two surfaces lie nearly at one depth single pixels would be specks, and holes. Its sides end where something else begins, and `at_edge` where its face does. */
float seen_of(float at, float around, float half_width, bool at_edge)
{
    vec2 axis = mix(v_ends.xy, v_ends.zw, at);
    float depth = depth_at(at), tolerance = v_depths.z * (u_perspective > 0.5 ? depth : 1.0);
    float there = step(2.5, axis_seen(at) + axis_seen(at - around) + axis_seen(at + around) + axis_seen(at - 2.0 * around) + axis_seen(at + 2.0 * around));
    vec4 here = texelFetch(t_normal_depth, ivec2(gl_FragCoord.xy), 0);
    float beside = step(abs(here.w - depth_beside(depth, axis, gl_FragCoord.xy)), (2.0 + half_width) * tolerance);
    return there * beside * (at_edge ? step(ANOTHER_FACE, abs(dot(here.xyz, v_normal))) : 1.0);
}

void main()
{
    vec2 chord = v_ends.zw - v_ends.xy, from = gl_FragCoord.xy - v_ends.xy;
    float size = max(length(chord), 1e-3), along = dot(from, chord) / size, off = abs(from.x * chord.y - from.y * chord.x) / size;
    float half_width = max(v_half_width, 0.0);
    float reach = clamp(half_width - 0.25, 0.0, 0.5); /* where two wide pieces meet no seam is left, where thin ones do nothing is inked twice */
    /* A line that ends at an edge goes on as far as the edge, which the pixels tell: its axis is asked a little before. */
    vec2 edges = vec2(mod(v_depths.w, 2.0), step(1.5, v_depths.w)), before = edges * min(0.75 / size, 0.5);
    vec2 ends = vec2(along, size - along) + mix(vec2(reach), vec2(half_width + 0.5), edges);
    float cover = clamp(min(ends.x, ends.y) + 0.5, 0.0, 1.0) * clamp(half_width + 0.5 - off, 0.0, min(2.0 * half_width, 1.0));
    int wanted = cover > 0.0 ? 1 : 0; /* looking things up takes most of the time */
    for (int once = 0; once < wanted; once++)
        cover *= seen_of(clamp(along / size, before.x, 1.0 - before.y), AROUND / size, half_width, edges.x * (half_width - along) > 0.0 || edges.y * (half_width - size + along) > 0.0);
    out_shade = vec4(u_ink.rgb, 1.0) * (u_ink.a * cover);
}
