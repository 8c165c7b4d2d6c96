/* See discontinuity.c. A pixel is ink when visibility, orientation or part changes between it and one of its four neighbours. */
#include "lines/edge/edge.glsl"

uniform vec2  u_unproject;
uniform float u_perspective;

/* Part of the step `across` that the slopes before and behind it do not explain. */
float unexplained(float before, float across, float behind)
{
    float low = min(before, behind), high = max(before, behind);
    float excess = max(low - across, across - high);
    return excess - 0.5 * min(abs(before), abs(behind));
}

vec3 towards_eye(vec3 normal, vec2 pixel)
{
    vec2 ndc = 2.0 * pixel / u_size - 1.0;
    vec3 ray = vec3(ndc * u_unproject * u_perspective, -1.0);
    return dot(normal, ray) > 0.0 ? -normal : normal;
}

/* x: profile ink, y: inner ink, z: id ink of the pair of this pixel and the neighbour at `step`. */
vec3 pair(ivec2 pixel, ivec2 side, vec3 normal, float depth, float tolerance, uint id, float crease_weight, float far_weight)
{
    float next = texel(t_depth, pixel + side).r;
    bool empty = depth >= 1.0, next_empty = next >= 1.0;
    if (empty != next_empty)
        return vec3(empty ? far_weight : 1.0, 0.0, 0.0);
    float behind_next = texel(t_depth, pixel + 2 * side).r;
    float before = texel(t_depth, pixel - side).r;
    float across = next - depth;
    float slope_before = depth - before, slope_behind = behind_next - next;
    if (before >= 1.0)
        slope_before = slope_behind;
    if (behind_next >= 1.0)
        slope_behind = slope_before;
    float excess = unexplained(slope_before, across, slope_behind);
    float profile = smoothstep(0.5, 1.0, excess / tolerance) * (across > 0.0 ? 1.0 : far_weight);
    vec3 other = towards_eye(texel(t_normal_depth, pixel + side).xyz, vec2(pixel + side) + 0.5);
    float inner = smoothstep(u_crease_range.x, u_crease_range.y, dot(normal, other)) * crease_weight;
    float between = 0.0;
#if PARTS
    uint other_id = texelFetch(t_id, clamp(pixel + side, ivec2(0), ivec2(u_size) - 1), 0).r;
    between = other_id != id ? (across > 0.0 ? 1.0 : far_weight) : 0.0;
#endif
    return vec3(profile, inner, between);
}

void main()
{
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    float depth = texel(t_depth, pixel).r;
    vec3 ink = vec3(0.0);
    /* A loop that runs once or not at all: software drivers skip loops, not branches, and most pixels are empty. */
    float around = min(min(texel(t_depth, pixel + ivec2(1, 0)).r, texel(t_depth, pixel - ivec2(1, 0)).r),
                       min(texel(t_depth, pixel + ivec2(0, 1)).r, texel(t_depth, pixel - ivec2(0, 1)).r));
    int busy = min(depth, around) < 1.0 ? 1 : 0;
    for (int once = 0; once < busy; once++) {
        vec4 normal_depth = texel(t_normal_depth, pixel);
        vec3 normal = towards_eye(normal_depth.xyz, gl_FragCoord.xy);
        float z = normal_depth.w;
        float tolerance = u_step * (u_perspective > 0.5 ? u_near * u_far / (z * z) : 1.0);
        uint id = texelFetch(t_id, pixel, 0).r;
        float second = clamp(u_width - 1.0, 0.0, 1.0);
        ink = max(ink, pair(pixel, ivec2(1, 0), normal, depth, tolerance, id, 1.0, second));
        ink = max(ink, pair(pixel, ivec2(-1, 0), normal, depth, tolerance, id, second, second));
        ink = max(ink, pair(pixel, ivec2(0, 1), normal, depth, tolerance, id, 1.0, second));
        ink = max(ink, pair(pixel, ivec2(0, -1), normal, depth, tolerance, id, second, second));
    }
    write_edges(1.0 - ink.x, 1.0 - ink.y, 1.0 - ink.z);
}
