/* See discontinuity.c. A pixel is ink when visibility, orientation or part changes between it and one of its four neighbours. */
#include "lines/edge/edge.glsl"

#include "light/point.glsl"

uniform vec2 u_unproject;

/* Sixteen steps of a float below 1: what the rasteriser's rounding can add up to over the depths that are compared. Where the
 * near plane is close to the eye (a viewer inside the model), smaller differences of window depth are noise. */
const float DEPTH_NOISE = 16.0 * 5.96e-8;

/* Part of the step `across` that the slopes before and behind it do not explain. */
float unexplained(float before, float across, float behind)
{
    float low = min(before, behind), high = max(before, behind);
    float excess = max(low - across, across - high);
    return excess - u_line_slope * max(abs(before), abs(behind));
}

/* x: profile ink, y: inner ink, z: id ink of the pair of this pixel and the neighbour at `side`. */
vec3 pair(vec2 side, float before, float next, float behind_next, vec3 normal, vec3 ray, float depth, float tolerance, uint id,
          float crease_weight, float far_weight)
{
    if ((depth >= 1.0) != (next >= 1.0))
        return vec3(depth >= 1.0 ? far_weight : 1.0, 0.0, 0.0);
    float across = next - depth;
    float slope_before = before >= 1.0 ? behind_next - next : depth - before;
    float slope_behind = behind_next >= 1.0 ? depth - before : behind_next - next;
    float excess = unexplained(slope_before, across, slope_behind);
    float nearness = across > 0.0 ? 1.0 : far_weight;
    vec3 other = neighbour(t_normal_depth, side).xyz;
    float cosine = dot(normal, other) * (dot(other, ray) > 0.0 ? -1.0 : 1.0);
    float inner = clamp((u_line_faint - cosine) / max(u_line_faint - u_line_crease, 1e-4), 0.0, 1.0) * crease_weight;
    /* Where a crease is drawn anyway, a small step more is its own slope, not a second surface behind it: without this, lines
     * along such creases change class from pixel to pixel. */
    excess -= inner * 0.5 * max(abs(slope_before), abs(slope_behind));
    float profile = smoothstep(0.5, 1.0, excess / tolerance) * nearness;
    float between = 0.0;
#if PARTS && defined(HAS_ID)
    uint other_id = textureLod(t_id, (gl_FragCoord.xy + side) * u_texel, 0.0).r;
    between = other_id != id ? nearness : 0.0;
#endif
    return vec3(profile, inner, between);
}

float depth_at(float x, float y)
{
    return neighbour(t_depth, vec2(x, y)).r;
}

void detect_edges()
{
    float depth = depth_at(0.0, 0.0);
    float right = depth_at(1.0, 0.0), left = depth_at(-1.0, 0.0), up = depth_at(0.0, 1.0), down = depth_at(0.0, -1.0);
    vec3 ink = vec3(0.0);
    /* A loop that runs once or not at all: software drivers skip loops, not branches, and most pixels are empty. */
    int busy = min(depth, min(min(left, right), min(up, down))) < 1.0 ? 1 : 0;
    for (int once = 0; once < busy; once++) {
        vec4 normal_depth = neighbour(t_normal_depth, vec2(0.0));
        /* Normals count as turned to the viewer, so that models of mixed winding show no lines where only the winding changes. */
        vec3 ray = vec3((2.0 * gl_FragCoord.xy * u_texel - 1.0) * u_unproject * u_perspective, -1.0);
        vec3 normal = normal_depth.xyz * (dot(normal_depth.xyz, ray) > 0.0 ? -1.0 : 1.0);
        float z = normal_depth.w;
        float tolerance = u_line_step * (u_perspective > 0.5 ? u_near * u_far / (z * z) : 1.0);
        tolerance = max(tolerance, DEPTH_NOISE);
        uint id = 0u;
#if PARTS && defined(HAS_ID)
        id = textureLod(t_id, gl_FragCoord.xy * u_texel, 0.0).r;
#endif
        float second = clamp(u_line_width - 1.0, 0.0, 1.0);
        ink = pair(vec2(1.0, 0.0), left, right, depth_at(2.0, 0.0), normal, ray, depth, tolerance, id, 1.0, second);
        ink = max(ink, pair(vec2(-1.0, 0.0), right, left, depth_at(-2.0, 0.0), normal, ray, depth, tolerance, id, second, second));
        ink = max(ink, pair(vec2(0.0, 1.0), down, up, depth_at(0.0, 2.0), normal, ray, depth, tolerance, id, 1.0, second));
        ink = max(ink, pair(vec2(0.0, -1.0), up, down, depth_at(0.0, -2.0), normal, ray, depth, tolerance, id, second, second));
    }
    write_edges(1.0 - ink.x, 1.0 - ink.y, 1.0 - ink.z);
}
