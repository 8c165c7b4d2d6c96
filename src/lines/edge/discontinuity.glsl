/* See discontinuity.c. A pixel is ink when visibility, orientation or part changes between it and one of its four neighbours. */
#define OWN_WIDTH
#include "lines/edge/edge.glsl"

#include "light/piece.glsl"
#include "light/point.glsl"

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

#ifdef WRITES_TOO
#include "lines/edge/feet.glsl"
#endif
#ifdef HAS_RECORDS
#include "lines/record.glsl"
#endif

/* x: inner ink, y: id ink between this pixel and the neighbour at `side`, which is `across` deeper. */
vec2 inner_and_id(vec2 side, vec3 normal, vec3 ray, uvec2 id)
{
    vec3 other = neighbour(t_normal_depth, side).xyz;
    float cosine = dot(normal, other) * (dot(other, ray) > 0.0 ? -1.0 : 1.0);
    float between = 0.0, faint = u_line_faint, crease = u_line_crease;
#ifdef HAS_ID
    uvec2 other_id = textureLod(t_id, (gl_FragCoord.xy + side) * u_texel, 0.0).rg;
#if PARTS
    between = piece_of(other_id) != piece_of(id) ? 1.0 : 0.0;
#endif
    bool meet = ((id.g ^ other_id.g) & SURFACE_INDEX_MASK) != 0u && (id.g & other_id.g & SURFACE_OPERAND) != 0u;
    faint = meet ? mix(1.0, u_line_meet, 0.5) : faint;
    crease = meet ? u_line_meet : crease;
#endif
    float inner = clamp((faint - cosine) / max(faint - crease, 1e-4), 0.0, 1.0);
    return vec2(inner, between);
}

/* Profile ink between this pixel and its neighbour of depth `next`; `before` and `behind_next` lie on either side of the two. Where
 * one of the two is empty there is nothing but a profile, and `inks` is cleared. */
float profile_ink(float before, float depth, float next, float behind_next, float tolerance, inout vec2 inks)
{
    if ((depth >= 1.0) != (next >= 1.0)) {
        inks = vec2(0.0);
        return 1.0;
    }
    float across = next - depth;
    float slope_before = before >= 1.0 ? behind_next - next : depth - before;
    float slope_behind = behind_next >= 1.0 ? depth - before : behind_next - next;
    float excess = unexplained(slope_before, across, slope_behind);
    /* Where a crease is drawn anyway, a small step more is its own slope, not a second surface behind it: without this, lines
     * along such creases change class from pixel to pixel. */
    excess -= inks.x * 0.5 * max(abs(slope_before), abs(slope_behind));
    return smoothstep(0.5, 1.0, excess / tolerance);
}

float depth_at(float x, float y)
{
    return neighbour(t_depth, vec2(x, y)).r;
}

void detect_edges()
{
    float depth = depth_at(0.0, 0.0);
    float right = depth_at(1.0, 0.0), left = depth_at(-1.0, 0.0), up = depth_at(0.0, 1.0), down = depth_at(0.0, -1.0);
    float profile = 0.0;
    vec2 inks = vec2(0.0);
#ifdef WRITES_TOO
    vec4 foot = vec4(0.0);
#endif
    /* Loops that run once or not at all: software drivers skip loops, not branches, and most pixels are empty. */
    int busy = min(depth, min(min(left, right), min(up, down))) < 1.0 ? 1 : 0;
    for (int once = 0; once < busy; once++) {
        vec4 normal_depth = neighbour(t_normal_depth, vec2(0.0));
        /* Normals count as turned to the viewer, so that models of mixed winding show no lines where only the winding changes. */
        vec3 ray = vec3((2.0 * gl_FragCoord.xy * u_texel - 1.0) * u_unproject * u_perspective, -1.0);
        vec3 normal = normal_depth.xyz * (dot(normal_depth.xyz, ray) > 0.0 ? -1.0 : 1.0);
        float z = normal_depth.w;
        float tolerance = u_line_step * (u_perspective > 0.5 ? u_near * u_far / (z * z) : 1.0);
        tolerance = max(tolerance, DEPTH_NOISE);
        uvec2 id = uvec2(0u);
#ifdef HAS_ID
        id = textureLod(t_id, gl_FragCoord.xy * u_texel, 0.0).rg;
#endif
        vec2 to_right = inner_and_id(vec2(1.0, 0.0), normal, ray, id), to_left = inner_and_id(vec2(-1.0, 0.0), normal, ray, id);
        vec2 to_up = inner_and_id(vec2(0.0, 1.0), normal, ray, id), to_down = inner_and_id(vec2(0.0, -1.0), normal, ray, id);
        vec4 steps = vec4(0.0); /* to the right, left, up and down */
        /* A step exceeds the slope before it by the bend of depth at most: where depth hardly bends there is no profile. */
        float bend = max(abs(left + right - 2.0 * depth), abs(up + down - 2.0 * depth));
        float farthest = max(depth, max(max(left, right), max(up, down)));
        int bent = bend > 0.5 * tolerance || farthest >= 1.0 ? 1 : 0;
        for (int again = 0; again < bent; again++) {
            steps.x = profile_ink(left, depth, right, depth_at(2.0, 0.0), tolerance, to_right);
            steps.y = profile_ink(right, depth, left, depth_at(-2.0, 0.0), tolerance, to_left);
            steps.z = profile_ink(down, depth, up, depth_at(0.0, 2.0), tolerance, to_up);
            steps.w = profile_ink(up, depth, down, depth_at(0.0, -2.0), tolerance, to_down);
            profile = max(max(steps.x, steps.y), max(steps.z, steps.w));
        }
        inks = max(max(to_right, to_left), max(to_up, to_down));
#ifdef WRITES_TOO
        vec4 creases = vec4(to_right.x, to_left.x, to_up.x, to_down.x), borders = vec4(to_right.y, to_left.y, to_up.y, to_down.y);
        int unknown = profile + inks.x + inks.y > 0.0 ? 1 : 0;
#ifdef HAS_RECORDS
        vec4 record = texelFetch(t_records, ivec2(gl_FragCoord.xy), 0);
        float crease = max(record.w >= RECORDED_BORDER ? 0.0 : record.w - RECORDED_OUTLINE, -record.w);
        bool outline = record.w > 0.0 && (record.w >= RECORDED_BORDER || profile > 0.0);
        profile = record.w >= RECORDED_BORDER ? 1.0 : profile;
        inks.x = record.w != 0.0 && !outline ? crease : inks.x;
        foot = record.w != 0.0 && profile + inks.x + inks.y > 0.0 ? vec4(record.xyz, 1.0) : foot;
        unknown = foot.w > 0.0 ? 0 : unknown;
#endif
        for (int again = 0; again < unknown; again++)
            foot = foot_of(steps, creases, borders, depth, vec4(right, left, up, down), normal_depth, ray, id);
#endif
    }
    write_edges(1.0 - profile, 1.0 - inks.x, 1.0 - inks.y);
#ifdef WRITES_TOO
    out_feet = foot;
#endif
}
